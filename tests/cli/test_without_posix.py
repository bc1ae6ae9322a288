"""A campaign is run without what POSIX alone has, as on Windows, in folders with blanks and umlauts.

Paths, locks on files that are open, and line ends of another system are not tried so.
"""

import os
import subprocess
import sys

import pytest
from commandruns import ROOT
from shortcampaign import write_short

# the libraries are loaded first: they have code of their own for Windows
LACKING = """
import os, signal, sys, types
import fastexcel, h5py, jinja2, netCDF4, nptdms, numpy, pandas, pint, plotly, pyarrow, pydantic
import python_calamine, rich, scipy.stats, statsmodels.api, tomlkit, typer, xarray
import asyncio, concurrent.futures.process, http.server, multiprocessing, subprocess, tempfile
from typer.testing import CliRunner

for name in ("fcntl", "resource", "termios", "pwd", "grp", "syslog"):
    sys.modules[name] = None
lock = types.ModuleType("msvcrt")
lock.LK_NBLCK, lock.locking = 2, lambda *_: None
sys.modules["msvcrt"] = lock
for name in ("fork", "geteuid", "getuid", "sched_getaffinity", "mkfifo", "setsid", "killpg"):
    if hasattr(os, name):
        delattr(os, name)
for name in ("SIGHUP", "SIGKILL", "SIGALRM", "SIGUSR1", "pthread_sigmask", "setitimer"):
    if hasattr(signal, name):
        delattr(signal, name)
sys.platform = "win32"

import importlib, pkgutil
import reduction

for module in pkgutil.walk_packages(reduction.__path__, "reduction."):
    if not module.name.endswith(("__main__", "dask_cluster")):
        importlib.import_module(module.name)
from reduction.cli.main import app

for line in (
    ["run", "raw/campaign.toml"], ["verify", "processed/short", "--campaign", "raw/campaign.toml"],
    ["lookup", "processed/short/A.nc", "--list"], ["report", "processed/short"],
):
    done = CliRunner().invoke(app, line)
    print(done.exit_code, "internal error" in done.output)
"""


@pytest.mark.nightly
def test_a_campaign_needs_nothing_of_posix(tmp_path):
    folder = tmp_path / "Prüf stand ü"
    write_short(folder / "raw")
    done = subprocess.run(
        [sys.executable, "-c", LACKING], cwd=folder, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.stdout.splitlines() == ["0 False"] * 4, done.stdout + done.stderr

"""The commands of a user with the plain wheel: nothing can be imported that it does not ask for."""

import json
import subprocess
import sys

import pytest
from commandruns import answered
from hiddenpackages import environment_with, modules_hidden
from shortcampaign import write_short

pytestmark = pytest.mark.nightly

EVERY_MODULE = """
import importlib, json, pkgutil, reduction

lacking = {}
for module in pkgutil.walk_packages(reduction.__path__, "reduction."):
    if not module.name.endswith("__main__"):
        try:
            importlib.import_module(module.name)
        except ModuleNotFoundError as error:
            lacking[module.name] = error.name
print(json.dumps(lacking))
"""
# the workers of --scheduler are the one module that asks for an extra when it is imported
NEEDS_AN_EXTRA = {"reduction.batch.dask_cluster": "distributed"}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Run a line of Python's in a folder of its own, with no package but those of the wheel."""
    hidden = modules_hidden()
    assert {"dask", "distributed", "fsspec", "matplotlib", "pytest"} <= hidden
    assert {"numpy", "xarray", "typer"}.isdisjoint(hidden)
    folder = tmp_path_factory.mktemp("plain")
    environment = environment_with(folder / "site")

    def run(*words):
        return subprocess.run(
            [sys.executable, *map(str, words)], cwd=folder, capture_output=True, text=True,
            check=False, env=environment,
        )  # fmt: skip

    return folder, run


def test_what_an_extra_brings_cannot_be_imported(plain):
    _, run = plain
    done = run("-c", "import numpy, dask")
    assert done.returncode == 1
    assert "No module named 'dask'" in done.stderr


def test_every_module_but_that_of_the_workers_elsewhere_is_imported(plain):
    _, run = plain
    done = run("-c", EVERY_MODULE)
    assert answered(done) == NEEDS_AN_EXTRA


def test_a_campaign_is_run_looked_up_and_exported(plain):
    folder, run = plain
    campaign = write_short(folder / "raw")
    product = folder / "processed" / "short" / "A.nc"

    def say(*words):
        done = run("-m", "reduction", *words)
        assert done.returncode == 0, (words, done.stdout, done.stderr)
        return done.stdout

    assert "Reduces cyclic tension tests" in say("--help")
    say("run", campaign, "--quiet")
    assert (folder / "reports" / "short" / "index.html").exists()
    where = ("--strain", "70 %", "--branch", "ascending", "--json")
    found = json.loads(say("lookup", product, "--quantity", "tension", *where))
    # 60 eps + 12 eps^3 lbf, as the logs are made
    expected = 4.4482216152605 * (60 * 0.7 + 12 * 0.7**3)
    assert found["value"] == pytest.approx(expected, rel=2e-3)
    say("export", product, "--to", "csv", "--out", "A.csv")
    assert (folder / "A.csv").read_text(encoding="utf-8").startswith("strain [1],tension [N]")

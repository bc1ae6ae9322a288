"""The command in a process of its own, and a campaign of the project that it ran."""

import atexit
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from boundedruns import BoundedRuns
from manytests import wait_for

ROOT = Path(__file__).parents[1]
# what a command asks of its environment when it prints
READ_LATE = {"COLUMNS", "NO_COLOR", "TERM"}


def reduction(*arguments, cwd=ROOT, **environment):
    """Run the command as a user would, in a process of its own.

    It is forked from one that has loaded the package, which saves the start, unless something of
    the environment that is read at the start is another or the command starts processes itself.
    """
    words = [*map(str, arguments)]
    if environment.keys() - READ_LATE or {"--jobs", "--scheduler"} & set(words):
        return subprocess.run(
            [sys.executable, "-m", "reduction", *words], cwd=cwd, capture_output=True, text=True,
            check=False, env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
        )  # fmt: skip
    done = loaded_process().run(
        *words, cwd=cwd, seconds=900, environment=environment, is_bounded=False
    )
    return subprocess.CompletedProcess(words, done.status, done.out, done.errors)


def answered(done):
    """What a command that succeeded printed as one object."""
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@cache
def loaded_process():
    """The process from which commands are forked; it ends with that of the tests."""
    runs = BoundedRuns().__enter__()
    atexit.register(runs.__exit__)
    return runs


@dataclass(frozen=True)
class Run:
    processed: Path
    reports: Path
    done: subprocess.CompletedProcess

    @property
    def said(self):
        """What the run printed as one object."""
        return json.loads(self.done.stdout)


def run_campaign(name, folder, *options, **environment):
    done = reduction(
        "run", ROOT / "raw" / name / "campaign.toml", "--processed", folder / "processed",
        "--reports", folder / "reports", *options, **environment,
    )  # fmt: skip
    return Run(folder / "processed" / name, folder / "reports" / name, done)


def shared_by_processes(tmp_path_factory):
    """One folder for all processes of the tests."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


def made_once(folder, make):
    """Make a folder in the first process of the tests that needs it; the others wait for it."""
    try:
        folder.mkdir()
    except FileExistsError:
        wait_for((folder / "made").is_file, seconds=300)
    else:
        try:
            make(folder)
        finally:
            (folder / "made").touch()
    return folder


def run_once(name, shared):
    """A campaign of the project, run once for all tests that only read what it made."""

    def make(folder):
        done = run_campaign(name, folder, "--json").done
        said = [done.returncode, done.stdout, done.stderr]
        (folder / "said.json").write_text(json.dumps(said), encoding="utf-8")

    folder = made_once(shared / f"campaign-{name}", make)
    said = json.loads((folder / "said.json").read_text(encoding="utf-8"))
    done = subprocess.CompletedProcess(["reduction", "run", name], *said)
    return Run(folder / "processed" / name, folder / "reports" / name, done)

"""The campaigns of the project, run once by the command itself, and the command for small ones."""

import contextlib
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reduction.cli.main import app

ROOT = Path(__file__).parents[2]


def reduction(*arguments, cwd=ROOT, **environment):
    """Run the command as a user would, in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "reduction", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
    )


@dataclass(frozen=True)
class Ended:
    returncode: int
    stdout: str
    stderr: str


def invoke(*arguments, cwd=ROOT):
    """Run the command in this process: all of it but two seconds of imports."""
    with contextlib.chdir(cwd):
        done = CliRunner().invoke(app, [str(entry) for entry in arguments], catch_exceptions=False)
    return Ended(done.exit_code, done.stdout, done.stderr)


@dataclass(frozen=True)
class Run:
    processed: Path
    reports: Path
    done: subprocess.CompletedProcess


def run_campaign(name, folder, *options, **environment):
    done = reduction(
        "run", ROOT / "raw" / name / "campaign.toml", "--processed", folder / "processed",
        "--reports", folder / "reports", *options, **environment,
    )  # fmt: skip
    return Run(folder / "processed" / name, folder / "reports" / name, done)


@pytest.fixture(scope="session")
def command():
    return invoke


@pytest.fixture(scope="session")
def process():
    return reduction


@pytest.fixture(scope="session")
def synthetic(tmp_path_factory):
    return run_campaign("tmt-synthetic", tmp_path_factory.mktemp("synthetic"), "--json")


@pytest.fixture(scope="session")
def static(tmp_path_factory):
    return run_campaign("buoy-technology-1997", tmp_path_factory.mktemp("static"))

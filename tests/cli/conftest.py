"""The campaigns of the project, run once by the command itself, and the command for small ones."""

import contextlib
from dataclasses import dataclass

import pytest
from commandruns import ROOT, reduction, run_once, shared_by_processes
from typer.testing import CliRunner

from reduction.cli.main import app


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


@pytest.fixture(scope="session")
def command():
    return invoke


@pytest.fixture(scope="session")
def process():
    return reduction


@pytest.fixture(scope="session")
def synthetic(tmp_path_factory):
    return run_once("tmt-synthetic", shared_by_processes(tmp_path_factory))


@pytest.fixture(scope="session")
def static(tmp_path_factory):
    return run_once("buoy-technology-1997", shared_by_processes(tmp_path_factory))


@pytest.fixture(scope="session")
def nylon_campaign(tmp_path_factory):
    return run_once("nylon-synthetic", shared_by_processes(tmp_path_factory))


@pytest.fixture(scope="session")
def hose_campaign(tmp_path_factory):
    return run_once("hose-synthetic", shared_by_processes(tmp_path_factory))

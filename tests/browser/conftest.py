"""Campaigns whose pages are looked at, run once for all processes of the tests."""

from dataclasses import dataclass
from pathlib import Path

import pytest
from commandruns import made_once, reduction, run_once, shared_by_processes
from manytests import write_many


@dataclass(frozen=True)
class Products:
    """Where the archives and the page of a campaign are."""

    processed: Path
    reports: Path

    @property
    def page(self):
        return self.reports / "index.html"


@pytest.fixture(scope="session")
def campaigns(tmp_path_factory):
    """Every campaign of the project, run by the command: its name, and where its products are."""

    def run(name):
        ran = run_once(name, shared_by_processes(tmp_path_factory))
        assert ran.done.returncode == 0, ran.done.stderr
        return Products(ran.processed, ran.reports)

    return run


@pytest.fixture(scope="session")
def small(tmp_path_factory):
    """A campaign of three short tests, which is there in seconds."""

    def make(folder):
        campaign = write_many(folder / "raw", 2, n_cycles=12)
        places = ["--processed", folder / "processed", "--reports", folder / "reports"]
        done = reduction("run", campaign, *places)
        assert done.returncode == 0, done.stderr

    folder = made_once(shared_by_processes(tmp_path_factory) / "small", make)
    return Products(folder / "processed" / "many", folder / "reports" / "many")

"""The commands of a user with the plain wheel: nothing can be imported that it does not ask for.

What the extras of pyproject.toml bring is installed beside the tests; here it is hidden from a
process of its own and from those that it starts.
"""

import json
import os
import subprocess
import sys
import tomllib
from importlib import metadata

import pytest
from commandruns import ROOT
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from shortcampaign import write_short

pytestmark = pytest.mark.slow

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
# Python runs a module of this name at its start
HIDING = """
import sys
from importlib.machinery import PathFinder

HIDDEN = frozenset({hidden!r})


class Plain(PathFinder):
    @classmethod
    def find_spec(cls, name, path=None, target=None):
        is_hidden = name.partition(".")[0] in HIDDEN
        return None if is_hidden else PathFinder.find_spec(name, path, target)


sys.meta_path[:] = [Plain if one is PathFinder else one for one in sys.meta_path]
"""
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


def distributions_of_the_wheel():
    """Names of the distributions that an installation of the wheel without extras brings."""
    names, asked = set(), [Requirement(text) for text in PROJECT["dependencies"]]
    while asked:
        name = canonicalize_name(asked.pop().name)
        if name not in names:
            names.add(name)
            found = map(Requirement, metadata.requires(name) or ())
            asked += [one for one in found if not one.marker or one.marker.evaluate({"extra": ""})]
    return names


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Run a line of Python's in a folder of its own, with no package but those of the wheel."""
    there = distributions_of_the_wheel() | {canonicalize_name(PROJECT["name"])}
    hidden = {
        module
        for module, owners in metadata.packages_distributions().items()
        if there.isdisjoint(map(canonicalize_name, owners))
    }
    assert {"dask", "distributed", "fsspec", "matplotlib", "pytest"} <= hidden
    assert {"numpy", "xarray", "typer"}.isdisjoint(hidden)
    folder = tmp_path_factory.mktemp("plain")
    (folder / "site").mkdir()
    (folder / "site" / "sitecustomize.py").write_text(HIDING.format(hidden=sorted(hidden)))
    paths = os.pathsep.join([str(folder / "site"), str(ROOT)])

    def run(*words):
        return subprocess.run(
            [sys.executable, *map(str, words)], cwd=folder, capture_output=True, text=True,
            check=False, env=os.environ | {"PYTHONPATH": paths},
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
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == NEEDS_AN_EXTRA


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

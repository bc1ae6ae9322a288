"""An installation with some extras alone: what these do not bring is hidden from a process.

The tests have every extra installed beside them. Python runs a module called ``sitecustomize`` at its
start, which finds nothing of what is hidden; so do the processes that this one starts.
"""

import os
import tomllib
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
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


def distributions_of(*extras):
    """Names of the distributions that an installation of the wheel with these extras brings."""
    optional = PROJECT["optional-dependencies"]
    names = set()
    asked = [*PROJECT["dependencies"], *(text for extra in extras for text in optional[extra])]
    asked = [Requirement(text) for text in asked]
    while asked:
        one = asked.pop()
        if canonicalize_name(one.name) not in names:
            names.add(canonicalize_name(one.name))
            found = map(Requirement, metadata.requires(one.name) or ())
            wanted = ("", *one.extras)
            asked += [
                other for other in found
                if not other.marker or any(other.marker.evaluate({"extra": e}) for e in wanted)
            ]  # fmt: skip
    return names


def modules_hidden(*extras):
    """Modules of what is installed here and not brought by these extras."""
    there = distributions_of(*extras) | {canonicalize_name(PROJECT["name"])}
    return {
        module
        for module, owners in metadata.packages_distributions().items()
        if there.isdisjoint(map(canonicalize_name, owners))
    }


def environment_with(folder, *extras):
    """Variables of a process that sees these extras alone, for which a folder is made."""
    folder.mkdir()
    text = HIDING.format(hidden=sorted(modules_hidden(*extras)))
    (folder / "sitecustomize.py").write_text(text, encoding="utf-8")
    return os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)])}

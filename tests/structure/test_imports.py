"""Modules import downwards only, and only the edge modules touch files.

The table is the architecture; a new module fails here until it is given a room.
"""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "reduction"
LAYER = {
    "address": 0,
    "digits": 0,
    "errors": 0,
    "units": 0,
    "visible": 0,
    "vocabulary": 0,
    "laboratory": 0,
    "provenance": 0,
    "samples": 0,
    "workers": 0,
    "remote": 1,
    "record": 1,
    "settings": 1,
    "checks": 1,
    "notes": 1,
    "phases": 2,
    "strain": 2,
    "cycles": 2,
    "moduli": 2,
    "holds": 2,
    "line": 2,
    "surface": 2,
    "outcomes": 2,
    "predict": 2,
    "uncertainty": 2,
    "product": 3,
    "experiment": 3,
    "compare": 3,
    "prediction": 3,
    "lookup": 3,
    "pipeline": 4,
    "ingest": 4,
    "archive": 4,
    "published": 4,
    "campaign": 5,
    "tables": 5,
    "catalogue": 5,
    "report": 5,
    "export": 5,
    "reproduce": 5,
    "batch": 6,
    "designpage": 6,
    "explore": 7,
    "verify": 7,
    "cli": 8,
    "__main__": 9,
}
# data flow, left to right
STAGES = [
    "phases",
    "strain",
    "cycles",
    "moduli",
    "holds",
    "line",
    "surface",
    "outcomes",
    "uncertainty",
]
EDGES = {
    "remote",
    "ingest",
    "archive",
    "published",
    "campaign",
    "tables",
    "catalogue",
    "report",
    "reproduce",
    "export",
    "batch",
    "designpage",
    "explore",
    "verify",
    "cli",
    "__main__",
}
UNITS_AT = EDGES  # pint stands at the edges only
# numpy everywhere; scipy where the mathematics is
BELOW_THE_EDGE = {"numpy", "scipy", "reduction"}
MODULES = sorted(p for p in PACKAGE.rglob("*.py") if p != PACKAGE / "__init__.py")
PLAIN = {"open", "read_text", "write_text", "read_csv", "open_dataset", "to_netcdf", "print"}


def room(path):
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def imports(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name.split("."), node.lineno
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            yield (node.module or "").split("."), node.lineno


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_point_down(path):
    here = room(path)
    assert here in LAYER, f"{path}: give '{here}' a layer in {__file__}"
    for parts, line in imports(path):
        if parts[0] != "reduction" or len(parts) == 1:
            continue
        there = parts[1]
        if there == here:
            continue
        assert LAYER[there] <= LAYER[here], f"{path}:{line}: {here} may not import {there}"
        if here in STAGES and there in STAGES:
            assert STAGES.index(there) < STAGES.index(here), (
                f"{path}:{line}: {here} is upstream of {there}"
            )
        elif LAYER[there] == LAYER[here] and LAYER[here] >= 2:
            raise AssertionError(
                f"{path}:{line}: {here} and {there} are neighbours and may not meet"
            )
        if there == "units":
            assert here in UNITS_AT, f"{path}:{line}: units are for the edges"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_below_the_edge_are_numpy_and_scipy(path):
    if room(path) in EDGES or room(path) == "units":
        return
    standard = {
        "__future__", "collections", "dataclasses", "enum", "functools", "json", "math", "re",
        "typing", "pathlib", "itertools", "operator",
    }  # fmt: skip
    if room(path) == "workers":  # threads start in one place
        standard |= {"os", "concurrent"}
    if room(path) == "visible":  # and what steers a terminal is known in one
        standard |= {"unicodedata"}
    if room(path) == "samples":  # and scratch files are made in one
        standard |= {"ctypes", "os", "mmap", "tempfile"}
    for parts, line in imports(path):
        assert parts[0] in standard | BELOW_THE_EDGE, f"{path}:{line}: {parts[0]}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_only_edge_modules_touch_files(path):
    if room(path) in EDGES:
        return
    calls = {
        node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
    }
    assert not calls & PLAIN


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_stand_at_the_top_but_in_the_command_line(path):
    if room(path) == "cli":
        return
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for function in ast.walk(tree):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            inner = [
                node
                for node in ast.walk(function)
                if isinstance(node, (ast.Import, ast.ImportFrom))
            ]
            assert not inner, f"{path}:{inner[0].lineno}: import inside {function.name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_no_assert_and_no_bare_except(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        assert not isinstance(node, ast.Assert), f"{path}:{node.lineno}: assert"
        if isinstance(node, ast.ExceptHandler):
            assert node.type is not None, f"{path}:{node.lineno}: bare except"
            broad = isinstance(node.type, ast.Name) and node.type.id in (
                "Exception", "BaseException",
            )  # fmt: skip
            # the packages that speak to stores share no error of their own
            assert not broad or room(path) in ("batch", "cli", "explore", "remote"), (
                f"{path}:{node.lineno}: broad except"
            )

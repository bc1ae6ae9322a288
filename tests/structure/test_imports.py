"""Modules import downwards only, and only the edge modules touch files.

The table is the architecture; a new module fails here until it is given a room.
"""

import ast
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "reduction"
LAYER = {
    "address": 0,
    "digits": 0,
    "errors": 0,
    "units": 0,
    "visible": 0,
    "vocabulary": 0,
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
STANDARD = {
    "__future__", "collections", "dataclasses", "enum", "functools", "json", "math", "re",
    "typing", "pathlib", "itertools", "operator",
}  # fmt: skip
# threads start in one place, what steers a terminal is known in one, scratch files are made in one
STANDARD_OF = {
    "workers": {"os", "concurrent"}, "visible": {"unicodedata"},
    "samples": {"ctypes", "os", "mmap", "tempfile"},
    # the sum of the settings
    "provenance": {"hashlib"},
}  # fmt: skip
MODULES = sorted(p for p in PACKAGE.rglob("*.py") if p != PACKAGE / "__init__.py")
PLAIN = {"open", "read_text", "write_text", "read_csv", "open_dataset", "to_netcdf", "print"}


@cache
def tree(path):
    """A module as it is written, read once for all rules."""
    return ast.parse(path.read_text(encoding="utf-8"))


def room(path):
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def imports(path):
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name.split("."), node.lineno
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            yield (node.module or "").split("."), node.lineno


def against(rule):
    """What stands against a rule in each module: its line, and what is wrong."""
    return [
        f"{path.relative_to(PACKAGE)}:{line}: {wrong}"
        for path in MODULES
        for line, wrong in rule(path)
    ]


def not_downwards(path):
    here = room(path)
    if here not in LAYER:
        yield 1, f"give '{here}' a layer"
        return
    for parts, line in imports(path):
        if parts[0] != "reduction" or len(parts) == 1 or parts[1] == here:
            continue
        there = parts[1]
        if LAYER[there] > LAYER[here]:
            yield line, f"{here} may not import {there}"
        if here in STAGES and there in STAGES:
            if STAGES.index(there) >= STAGES.index(here):
                yield line, f"{here} is upstream of {there}"
        elif LAYER[there] == LAYER[here] and LAYER[here] >= 2:
            yield line, f"{here} and {there} are neighbours and may not meet"
        if there == "units" and here not in UNITS_AT:
            yield line, "units are for the edges"


def test_imports_point_down():
    found = against(not_downwards)
    assert not found, "\n".join(found)


def not_for_physics(path):
    if room(path) in EDGES or room(path) == "units":
        return
    allowed = STANDARD | BELOW_THE_EDGE | STANDARD_OF.get(room(path), set())
    for parts, line in imports(path):
        if parts[0] not in allowed:
            yield line, parts[0]


def test_imports_below_the_edge_are_numpy_and_scipy():
    found = against(not_for_physics)
    assert not found, "\n".join(found)


def touching_files(path):
    if room(path) in EDGES:
        return
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in PLAIN:
                yield node.lineno, name


def test_only_edge_modules_touch_files():
    found = against(touching_files)
    assert not found, "\n".join(found)


def inside_functions(path):
    if room(path) == "cli":
        return
    for function in ast.walk(tree(path)):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            for node in ast.walk(function):
                if isinstance(node, (ast.Import, ast.ImportFrom)):
                    yield node.lineno, f"import inside {function.name}"


def test_imports_stand_at_the_top_but_in_the_command_line():
    found = against(inside_functions)
    assert not found, "\n".join(found)


def asserting_or_catching_all(path):
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Assert):
            yield node.lineno, "assert"
        if isinstance(node, ast.ExceptHandler):
            if node.type is None:
                yield node.lineno, "bare except"
            # the packages that speak to stores share no error of their own, and a process that
            # reads hands over any
            elif (
                room(path) not in ("batch", "cli", "explore", "remote")
                and (path.name != "bounded.py")
                and (getattr(node.type, "id", "") in ("Exception", "BaseException"))
            ):
                yield node.lineno, "broad except"


def test_no_assert_and_no_bare_except():
    found = against(asserting_or_catching_all)
    assert not found, "\n".join(found)

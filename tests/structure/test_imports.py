"""Modules import downwards only, and only the edge modules touch files.

The table is the architecture; a new module fails here until it is given a room.
"""

import ast
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "reduction"
# each room imports from those before it
ROOMS = [
    "record", "quantities", "stages", "experiments", "prediction", "uncertainty", "pipeline",
    "readers", "archive", "published", "lines", "campaign", "report", "batch", "pages", "cli",
    "python_interface",
    "__main__",
]  # fmt: skip
LAYER = {room: layer for layer, room in enumerate(ROOMS)}
# the way of a record: each stage knows those before it
STAGES = ["strain", "cycles", "moduli", "holds", "three_parameter_line"]
EDGES = {
    "readers", "archive", "published", "lines", "campaign", "report", "batch", "pages", "cli",
    "python_interface", "__main__",
}  # fmt: skip
UNITS_AT = EDGES  # pint stands at the edges only
# numpy everywhere; scipy where the mathematics is
BELOW_THE_EDGE = {"numpy", "scipy", "reduction"}
STANDARD = {
    "__future__", "collections", "dataclasses", "enum", "functools", "json", "math", "re", "types",
    "typing", "pathlib", "itertools", "operator",
}  # fmt: skip
# the statistics of one regression; imported where one is fitted, for it takes half a second
STATISTICS = "experiments/surface_statistics.py"
# packages that take as long to load as a look-up does, and that most runs do without: pint knows
# units that are not usual, and readers of MATLAB, TDMS and workbooks have one each
LATE = (STATISTICS, "quantities/units.py", "readers/read_log.py", "prediction/wave_theory.py")
# threads start in one place, what steers a terminal is known in one, scratch files are made in one
ALSO_OF = {
    "record/arrays.py": {"os", "concurrent"}, "record/plain_text.py": {"unicodedata", "urllib"},
    "record/samples.py": {"ctypes", "os", "mmap", "tempfile"},
    # the sum of the settings
    "record/measurement.py": {"hashlib"},
    STATISTICS: {"warnings", "statsmodels"},
    # an extra
    "prediction/wave_theory.py": {"raschii"},
}  # fmt: skip
MODULES = sorted(p for p in PACKAGE.rglob("*.py") if p != PACKAGE / "__init__.py")
PLAIN = {"open", "read_text", "write_text", "read_csv", "open_dataset", "to_netcdf", "print"}


@cache
def tree(path):
    """A module as it is written, read once for all rules."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes(path):
    """All that stands in a module, gone through once for all rules."""
    return tuple(ast.walk(tree(path)))


def room(path):
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


def imports(path):
    for node in nodes(path):
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


def stage(parts):
    return parts[1] if parts[0] == "stages" and len(parts) > 2 and parts[1] in STAGES else None


def not_downwards(path):
    own = path.relative_to(PACKAGE).with_suffix("").parts
    here = own[0]
    if here not in LAYER:
        yield 1, f"give '{here}' a layer"
        return
    for parts, line in imports(path):
        if parts[0] != "reduction" or len(parts) == 1:
            continue
        there = parts[1]
        if LAYER[there] > LAYER[here]:
            yield line, f"{here} may not import {there}"
        before, after = stage([*parts[1:], "name"]), stage(own)
        if before and after and STAGES.index(before) > STAGES.index(after):
            yield line, f"{after} is upstream of {before}"
        if parts[1:3] == ["quantities", "units"] and here not in UNITS_AT | {"quantities"}:
            yield line, "units are for the edges"


def test_imports_point_down():
    found = against(not_downwards)
    assert not found, "\n".join(found)


def not_for_physics(path):
    if room(path) in EDGES or path.name == "units.py":
        return
    allowed = STANDARD | BELOW_THE_EDGE | ALSO_OF.get(path.relative_to(PACKAGE).as_posix(), set())
    for parts, line in imports(path):
        if parts[0] not in allowed:
            yield line, parts[0]


def test_imports_below_the_edge_are_numpy_and_scipy():
    found = against(not_for_physics)
    assert not found, "\n".join(found)


def touching_files(path):
    if room(path) in EDGES:
        return
    for node in nodes(path):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name in PLAIN:
                yield node.lineno, name


def test_only_edge_modules_touch_files():
    found = against(touching_files)
    assert not found, "\n".join(found)


def inside_functions(path):
    if room(path) == "cli" or path.relative_to(PACKAGE).as_posix() in LATE:
        return
    for function in nodes(path):
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef)):
            for node in ast.walk(function):
                if isinstance(node, (ast.Import, ast.ImportFrom)):
                    yield node.lineno, f"import inside {function.name}"


def test_imports_stand_at_the_top_but_in_the_command_line_and_of_what_loads_long():
    found = against(inside_functions)
    assert not found, "\n".join(found)


def asserting_or_catching_all(path):
    for node in nodes(path):
        if isinstance(node, ast.Assert):
            yield node.lineno, "assert"
        if isinstance(node, ast.ExceptHandler):
            if node.type is None:
                yield node.lineno, "bare except"
            # the packages that speak to stores share no error of their own, and a process that
            # reads hands over any
            elif (
                room(path) not in ("batch", "cli", "pages")
                and path.name not in ("bounded_reader.py", "remote_files.py")
                and (getattr(node.type, "id", "") in ("Exception", "BaseException"))
            ):
                yield node.lineno, "broad except"


def test_no_assert_and_no_bare_except():
    found = against(asserting_or_catching_all)
    assert not found, "\n".join(found)


def numbers_given_twice(path):
    """Names of a module that stand for two things: the later one holds in the earlier's place."""
    seen = set()
    for node in tree(path).body:
        targets = node.targets if isinstance(node, ast.Assign) else []
        targets = [node.target] if isinstance(node, ast.AnnAssign) else targets
        for name in (one for target in targets for one in ast.walk(target)):
            if isinstance(name, ast.Name) and name.id in seen:
                yield node.lineno, f"{name.id} a second time"
            seen.add(getattr(name, "id", ""))


def test_no_number_of_a_module_has_the_name_of_another():
    found = against(numbers_given_twice)
    assert not found, "\n".join(found)

"""Every public physics function names its arguments, their units, and its source."""

import ast
import importlib
import inspect
import pkgutil
import re
import textwrap

import pytest
from numpydoc.docscrape import FunctionDoc

import reduction

PHYSICS = {"stages", "experiments", "prediction"}
# what carries a plan of a file to physics, and has no equation of its own
FROM_A_PLAN = {
    "fit_experiment", "predict_armour_case", "wound_at_all_angles", "design_hoses",
    "predict_from_plan", "predict_wave_load", "compare_record",
}  # fmt: skip
UNIT = re.compile(r"\[[^\]]+\]\.?$")


def source_of(function):
    return textwrap.dedent(inspect.getsource(function))


def public_functions():
    for info in pkgutil.walk_packages(reduction.__path__, "reduction."):
        if info.name.split(".")[1] not in PHYSICS:
            continue
        module = importlib.import_module(info.name)
        for name, thing in vars(module).items():
            is_own = inspect.isfunction(thing) and thing.__module__ == module.__name__
            # one line says what a function of a neighbour does; what is documented is whole
            is_documented = "Parameters\n---" in (inspect.getdoc(thing) or "")
            if is_own and is_documented and not name.startswith("_") and name not in FROM_A_PLAN:
                yield pytest.param(module, thing, id=f"{info.name}.{name}")


@pytest.mark.parametrize(("module", "function"), list(public_functions()))
def test_docstring_is_complete(module, function):
    doc = FunctionDoc(function)
    named = [name.lstrip("*") for entry in doc["Parameters"] for name in entry.name.split(", ")]
    assert named == list(inspect.signature(function).parameters)
    products = re.compile(
        r"Standstills|StrainModel|Cycles|Loops|Curves|Settings|Specimen|Marks|Design|Harmonics"
    )
    for entry in [*doc["Parameters"], *doc["Returns"]]:
        text = " ".join(entry.desc)
        if "array" in entry.type or "float" in entry.type:
            assert UNIT.search(text) or products.search(entry.type), (
                f"{function.__name__}: {entry.name} ends without its unit: {text!r}"
            )
    raises = any(isinstance(node, ast.Raise) for node in ast.walk(ast.parse(source_of(function))))
    assert doc["Raises"] or not raises, f"{function.__name__} has no Raises section"
    assert doc["Examples"], f"{function.__name__} has no example"
    assert doc["References"] or "References" in (module.__doc__ or ""), "no source is named"

"""The schema has a place for all that the stages can hand on."""

import csv
import inspect
import re
from dataclasses import fields
from pathlib import Path

import pytest

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.test_variables import COEFFICIENTS
from reduction.quantities.names import (
    COMPARISON_SCHEMA,
    OUTCOME_SCHEMA,
    PREDICTION_SCHEMA,
    PROPERTY_SCHEMA,
    RESPONSE_PATTERNS,
    RESPONSES,
    STEPWISE_SCHEMA,
    SURFACE_SCHEMA,
    TEST_SCHEMA,
)
from reduction.quantities.row import SUFFIXES
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.moduli.elastomer_laws import PARAMETERS
from reduction.stages.moduli.modulus_product import AmplitudeSummary
from reduction.stages.strain import strain_model as methods
from reduction.stages.strain import strain_model as splice
from reduction.stages.strain import strain_model as tensiondriven

FROZEN = Path(__file__).parents[1] / "data" / "archive"
OF_A_RESPONSE = re.compile(rf"(log_|box_cox_)?({'|'.join(RESPONSES)})(_|$)")
PER_CYCLE = [item.name for item in fields(Loops) if item.name != "uncertainty"]
OF_TEST = [item.name for item in fields(AmplitudeSummary) if item.name != "uncertainty"]


def test_what_has_no_uncertainty_has_a_reason():
    for row in (TEST_SCHEMA | STEPWISE_SCHEMA).values():
        assert row.has_uncertainty or row.no_uncertainty, row.name
        assert "not evaluated" not in row.no_uncertainty, row.name


@pytest.mark.parametrize(
    "strain",
    [
        methods._marked_line_strain,
        methods._splice_ratio_strain,
        tensiondriven._tension_driven_strain,
        methods._gauge_length_strain,
        splice.free_length_strain,
    ],
)
def test_every_coefficient_of_a_strain_method_has_a_name(strain):
    coefficients = [
        name
        for name, parameter in inspect.signature(strain).parameters.items()
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY
    ]
    assert coefficients
    assert set(coefficients) - {"tension"} <= set(COEFFICIENTS)


def test_only_the_ogden_law_has_exponents():
    for law, names in PARAMETERS.items():
        assert any("exponent" in name for name in names) == (law == "ogden-2")


@pytest.mark.parametrize("name", PER_CYCLE)
def test_every_number_of_a_loop_has_a_place(name):
    assert TEST_SCHEMA[name].dims == ("specimen", "cycle")


@pytest.mark.parametrize("name", OF_TEST)
def test_every_mean_over_a_test_has_a_place_of_its_own(name):
    assert TEST_SCHEMA[f"test_{name}"].dims == ("specimen",)


def stated_now():
    """Product, group, name, dimensions, unit and kind of every variable that an archive may have."""
    schemas = {
        "test": TEST_SCHEMA | STEPWISE_SCHEMA, "surfaces": SURFACE_SCHEMA,
        "predictions": PREDICTION_SCHEMA, "comparisons": COMPARISON_SCHEMA,
        "outcomes": OUTCOME_SCHEMA, "change in length": PROPERTY_SCHEMA,
    }  # fmt: skip
    return (
        {
            (
                product,
                row.group,
                name,
                " ".join(row.dims),
                row.unit,
                "text" if row.is_text else "number",
            )
            for product, schema in schemas.items()
            for name, row in schema.items()
            # an uncertainty, a bound or a count follows from its number, and what is said of a response
            # from the patterns below
            if not any(name.removesuffix(end) in schema for end in SUFFIXES if name.endswith(end))
            and not (product == "surfaces" and OF_A_RESPONSE.match(name))
        }
        | {
            ("surfaces", row.group, row.name, " ".join(row.dims), row.unit, "a response")
            for row in RESPONSE_PATTERNS
        }
        | {("surfaces", "", name, "", "", "response") for name in RESPONSES}
    )


def test_the_schema_is_what_its_version_says():
    with (FROZEN / f"schema-{SCHEMA_VERSION}.csv").open(encoding="utf-8", newline="") as file:
        frozen = {tuple(row) for row in csv.reader(file)}
    gone, new = (sorted(one) for one in (frozen - stated_now(), stated_now() - frozen))
    assert not gone, (
        "readers of this version look for these: raise the first number of SCHEMA_VERSION"
    )
    assert not new, (
        "raise the second number of SCHEMA_VERSION, and write a schema-VERSION.csv of it"
    )

"""The schema has a place for all that the stages can hand on."""

import inspect
from dataclasses import fields

import pytest

from reduction.archive.test_variables import COEFFICIENTS
from reduction.quantities.names import STEPWISE_SCHEMA, TEST_SCHEMA
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.moduli.elastomer_laws import PARAMETERS
from reduction.stages.moduli.modulus_product import AmplitudeSummary
from reduction.stages.strain import strain_model as methods
from reduction.stages.strain import strain_model as splice
from reduction.stages.strain import strain_model as tensiondriven

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

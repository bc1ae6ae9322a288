"""A row of `reduction.quantities` says all that is written of a number."""

import pytest

from reduction.archive.csv_definitions import (
    COMPARISON_TABLES,
    EXPERIMENT_TABLES,
    PREDICTION_TABLES,
    PROPERTY_TABLES,
    TABLES,
)
from reduction.experiments import fit_results
from reduction.quantities import names
from reduction.quantities.flags import QUALITY_MASKS, STATIONARY_KINDS
from reduction.quantities.names import (
    QUANTITIES,
    RESPONSES,
    SINGLE_QUANTITIES,
    STEPWISE_SCHEMA,
    SURFACE_NAMES,
    TEST_SCHEMA,
    quantity,
    rows_of_response,
)
from reduction.quantities.row import along, label
from reduction.record.measurement import Quality

SCHEMAS = [one for name, one in vars(names).items() if name.endswith("_SCHEMA")]


def test_a_group_that_no_archive_has_is_refused():
    with pytest.raises(ValueError, match="no group 'colours'"):
        list(along(("specimen",), label("specimen_colour", "colour"), group="colours"))


def test_a_name_means_one_thing_in_every_product():
    for schema in SCHEMAS:
        for name, row in schema.items():
            if name in QUANTITIES:
                other = QUANTITIES[name]
                assert (row.unit, row.long_name) == (other.unit, other.long_name), name


def test_every_table_that_a_row_names_exists():
    tables = {
        one.name
        for one in (
            *TABLES, *EXPERIMENT_TABLES, *PREDICTION_TABLES, *COMPARISON_TABLES, *PROPERTY_TABLES,
        )
    }  # fmt: skip
    named = {table for schema in SCHEMAS for row in schema.values() for table in row.tables}
    named |= {table for row in names.RESPONSE_PATTERNS for table in row.tables}
    assert named <= tables


def test_flags_are_those_of_the_code_that_sets_them():
    assert QUALITY_MASKS == {str(one.name).lower(): one.value for one in Quality}
    assert {name or "none": code for code, name in fit_results.STATIONARY_KINDS.items()} == (
        STATIONARY_KINDS
    )


def test_companions_take_unit_and_meaning_from_their_base():
    row = TEST_SCHEMA["tangent_modulus_standard_uncertainty"]
    assert row.unit == "Pa"
    assert row.long_name == (
        "standard uncertainty (k=1) of tangent modulus, trimmed branches, mean over the cycles"
    )
    assert TEST_SCHEMA["tangent_modulus_count"].unit == "1"


def test_a_companion_has_no_standard_name():
    assert TEST_SCHEMA["quality_flag"].standard_name == "quality_flag"
    assert TEST_SCHEMA["tension_standard_uncertainty"].standard_name is None


def test_a_number_has_an_uncertainty_or_a_reason_for_none():
    for row in [*TEST_SCHEMA.values(), *STEPWISE_SCHEMA.values()]:
        assert row.has_uncertainty != bool(row.no_uncertainty), row.name
        assert row.is_text == (row.unit == ""), row.name


def test_what_a_row_refers_to_is_in_the_schema():
    for row in TEST_SCHEMA.values():
        assert set(row.ancillary) <= set(TEST_SCHEMA)
        assert not row.bounds or row.bounds in TEST_SCHEMA


def test_a_stepwise_test_has_its_own_time_and_tension():
    assert STEPWISE_SCHEMA["time"].dims == ("step",)
    assert TEST_SCHEMA["time"].dims == ("sample",)


# names of what is said of a response are made of the response and a pattern


@pytest.mark.parametrize(
    ("name", "unit", "long_name"),
    [
        ("relaxation_time_sigma", "s", "relaxation time: residual standard deviation of a run"),
        ("hysteresis_energy_coefficient", "J m-1", "hysteresis energy: coefficient, coded units"),
        ("hysteresis_energy_anova_mean_square", "J2 m-2", "hysteresis energy: mean square"),
        ("loss_factor_anova_mean_square", "1", "loss factor: mean square"),
        ("log_loss_spring_constant_fitted", "1", "logarithm of loss spring constant: value"),
        ("box_cox_relaxation_time_fitted", "1", "Box-Cox transform of relaxation time: value"),
        ("response_coefficient", "unit", "response: coefficient, coded units"),
        (
            "dashpot_coefficient_refusal",
            "",
            "dashpot coefficient: results of the surface that are not",
        ),
        ("dashpot_coefficient_p_value", "1", "dashpot coefficient: p-value"),
    ],
)
def test_unit_and_meaning_follow_the_response(name, unit, long_name):
    found = quantity(name)
    assert found.name == name
    assert found.unit == unit
    assert found.long_name.startswith(long_name)


def test_no_made_name_hides_another():
    made = [row.name for name in SURFACE_NAMES for row in rows_of_response(name)]
    assert len(set(made)) == len(made)
    assert not set(made) & set(SINGLE_QUANTITIES)
    assert set(made) <= set(QUANTITIES)


def test_every_response_is_a_quantity_of_a_cycle():
    assert len(SURFACE_NAMES) == (1 + 3) * len(RESPONSES)  # three transforms
    assert set(RESPONSES) <= set(SINGLE_QUANTITIES)


def test_a_name_that_is_not_there_is_refused():
    with pytest.raises(KeyError):
        quantity("colour_coefficient")

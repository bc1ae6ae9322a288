"""Rows of the tables: every column, every group, every row of the file."""

import math

import pytest

from reduction.experiments.outcome_groups import (
    EXPOSURE_COLUMNS,
    FATIGUE_COLUMNS,
    LOAD_LIFE_COLUMNS,
    STRENGTH_COLUMNS,
    exposure_rows,
    fatigue_rows,
    load_life_rows,
    strength_rows,
)
from reduction.experiments.outcomes import Outcome

BREAKS = [
    *[Outcome("tensile_strength", v, condition="new") for v in (28e3, 29e3, 30e3)],
    Outcome("tensile_strength", 29.5e3, condition="new", place="splice", is_valid=False),
    Outcome("tensile_strength", 1e3, condition="new", is_valid=False),
    *[Outcome("strain_at_failure", v, condition="new") for v in (0.12, 0.14)],
    *[Outcome("tensile_strength", v, condition="worn", exposure=5.0) for v in (14e3, 15e3)],
    Outcome("strain_at_failure", 0.2, condition="worn", exposure=5.0),
]
CYCLES = [
    *[Outcome("cycles_to_failure", v, peak_load_ratio=0.7) for v in (4e3, 5e3, 7e3)],
    *[Outcome("cycles_to_failure", v, peak_load_ratio=0.5) for v in (3e4, 4e4, 5e4)],
    *[Outcome("cycles_to_failure", 2e5, peak_load_ratio=0.3, is_suspended=True)] * 3,
    Outcome("cycles_to_failure", 8e4),
    *[Outcome("abrasion_cycles", v, material="nylon") for v in (12e3, 13e3)],
]
# 6500 - 600 a year, and 100 about it
EXPOSED = [
    Outcome("tensile_strength", 6500 - 600 * years + about, line="PD", exposure=years)
    for years in (0.0, 2.0, 4.0)
    for about in (-100.0, 100.0)
]


@pytest.mark.parametrize(
    ("rows", "columns"),
    [
        (exposure_rows(EXPOSED), EXPOSURE_COLUMNS),
        (strength_rows(BREAKS), STRENGTH_COLUMNS),
        (fatigue_rows(CYCLES), FATIGUE_COLUMNS),
        (load_life_rows(CYCLES), LOAD_LIFE_COLUMNS),
    ],
    ids=["exposure", "strength", "fatigue", "load-life"],
)
def test_a_row_has_every_column_and_each_its_kind(rows, columns):
    names = [column.name for column in columns]
    assert len(set(names)) == len(names) and rows
    for row in rows:
        assert list(row) == names
        for column in columns:
            kind = {"": str, "count": int}.get(column.unit, float)
            assert isinstance(row[column.name], kind), column.name
    for column, after in zip(columns, [*columns[1:], columns[0]], strict=True):
        if not column.no_uncertainty:
            assert after.name == f"{column.name}_standard_uncertainty"


def test_rows_of_strength_stand_by_group_and_count_every_test():
    new, worn = strength_rows(BREAKS)
    assert new["tensile_strength"] == 29e3 and new["tensile_strength_standard_deviation"] == 1e3
    counts = ("count", "lower_bound_count", "excluded_count")
    assert [new[f"tensile_strength_{name}"] for name in counts] == [3, 1, 1]
    assert new["tensile_strength_lower_bound_mean"] == 29.5e3
    assert new["tensile_strength_with_lower_bounds"] > 29e3
    assert math.isnan(new["tensile_strength_change"])
    assert worn["tensile_strength_change"] == pytest.approx(-0.5)
    assert worn["tensile_strength_change_low"] < -0.5 < worn["tensile_strength_change_high"]
    assert worn["tensile_strength_p_value"] < 0.001 and worn["exposure"] == 5.0
    # one strain: a change, and no interval
    assert worn["strain_at_failure_change"] == pytest.approx(0.2 / 0.13 - 1)
    assert math.isnan(worn["strain_at_failure_change_low"])
    assert worn["strain_at_failure_reason"] == (
        "fewer than two values: there is no deviation; no deviation is known for one of the means"
    )


def test_another_condition_may_be_the_reference():
    new, _ = strength_rows(BREAKS, reference_condition="worn")
    assert new["tensile_strength_change"] == pytest.approx(1.0)
    assert new["reference_condition"] == "worn"


def test_rows_of_fatigue_stand_by_level_and_count_every_test():
    rows = fatigue_rows(CYCLES)
    assert [row["peak_load_ratio"] for row in rows[:3]] == pytest.approx([0.3, 0.5, 0.7])
    assert sum(row["failed_count"] + row["suspended_count"] for row in rows) == len(CYCLES)
    survived, _, failed, unknown, abrasion = rows
    assert survived["suspended_count"] == 3 and math.isnan(survived["median_life_high"])
    assert survived["life_reason"] == "no failure: only a lower bound can be given"
    assert failed["median_life_low"] < failed["median_life"] < failed["median_life_high"]
    assert math.isnan(unknown["peak_load_ratio"])
    assert (abrasion["quantity"], abrasion["mean_cycles"]) == ("abrasion_cycles", 12.5e3)


def test_loads_without_a_break_strength_are_levels_too():
    rows = fatigue_rows(
        [Outcome("cycles_to_failure", v, peak_load=load) for v, load in
         ((4e3, 9e3), (5e3, 9.05e3), (4e4, 5e3))]
    )  # fmt: skip
    assert [row["peak_load"] for row in rows] == pytest.approx([5e3, 9.025e3])
    assert [row["failed_count"] for row in rows] == [1, 2]


def test_a_level_of_invalid_tests_alone_is_a_row():
    (row,) = fatigue_rows([Outcome("cycles_to_failure", math.nan, is_valid=False)])
    assert row["excluded_count"] == 1 and row["life_reason"] == "no valid test"


def test_life_against_load_is_a_row_for_a_group_at_several_loads():
    (row,) = load_life_rows(CYCLES)
    assert (row["failed_count"], row["suspended_count"], row["unused_count"]) == (6, 3, 1)
    assert row["life_exponent"] > 0 and row["life_reason"] == ""
    assert load_life_rows(CYCLES[:3]) == []


def test_where_no_line_can_be_fitted_the_row_says_why():
    (row,) = load_life_rows(CYCLES[3:9])
    assert math.isnan(row["life_exponent"])
    assert row["life_reason"] == "the slope of life against load needs failures at two loads"


def test_strength_against_exposure_is_a_row_for_a_line_at_several_exposures():
    (row,) = exposure_rows(EXPOSED)
    assert row["strength_when_new"] == pytest.approx(6500)
    assert row["strength_slope"] == pytest.approx(-600)
    assert row["share_lost_per_year"] == pytest.approx(600 / 6500)
    assert row["share_lost_per_year_low"] < 600 / 6500 < row["share_lost_per_year_high"]
    # six residuals of 100, four degrees of freedom
    assert row["strength_scatter"] == pytest.approx(math.sqrt(6e4 / 4))
    assert (row["degrees_of_freedom"], row["break_count"]) == (4, 6)
    assert (row["exposure_low"], row["exposure_high"]) == (0.0, 4.0)
    assert exposure_rows(EXPOSED[:2]) == []


def test_an_exposure_line_that_cannot_be_fitted_says_why():
    (row,) = exposure_rows([EXPOSED[0], EXPOSED[2]])
    assert math.isnan(row["strength_slope"]) and row["degrees_of_freedom"] == 0
    assert row["exposure_reason"] == "two exposures with one break each leave no scatter"


def test_a_line_that_has_lost_all_when_new_has_no_share():
    (row,) = exposure_rows(
        [Outcome("tensile_strength", strength, exposure=years) for years, strength in
         ((5.0, 10.0), (5.0, 20.0), (6.0, 3000.0))]
    )  # fmt: skip
    assert row["strength_when_new"] < 0 and math.isnan(row["share_lost_per_year"])

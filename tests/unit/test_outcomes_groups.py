"""Rows by group, references, and what a specimen's sheet adds."""

import math

import numpy as np
import pytest

from reduction.experiments.outcome_groups import (
    EXPOSURE_COLUMNS,
    FATIGUE_COLUMNS,
    LOAD_LIFE_COLUMNS,
    STRENGTH_COLUMNS,
    Group,
    _empty_row,
    _group_outcomes,
    _labels_of,
    _reference_of,
    complete_from_specimens,
    exposure_rows,
    exposure_series,
    fatigue_rows,
    load_life_rows,
    load_series,
    odd_outcomes,
    strength_rows,
)
from reduction.experiments.outcomes import IN_THE_TERMINATION, Outcome, reason_codes
from reduction.record.errors import DataError
from reduction.record.measurement import Specimen


def strength(value=28e3, **facts):
    return Outcome("tensile_strength", value, **facts)


def test_every_row_of_the_quantity_has_a_place_and_no_other():
    rows = [
        strength(line="A", diameter=0.0127),
        Outcome("abrasion_cycles", 5e3, line="A"),
        strength(line="A", diameter=0.0127, is_valid=False, place="splice"),
        strength(line="A"),
        strength(math.nan, line="A", is_valid=False),
    ]
    grouped = _group_outcomes(rows, "tensile_strength")
    assert grouped.group.tolist() == [0, 0, 1, 1]
    assert grouped.use.tolist() == [0, 1, 0, 2]
    assert [group.diameter for group in grouped.groups] == [0.0127, None]
    assert grouped.value.tolist() == [28e3, 28e3, 28e3, 1.0]


def test_a_value_that_cannot_be_is_refused_by_its_row():
    with pytest.raises(DataError, match="row 7 has no tensile_strength to be used; found nan"):
        _group_outcomes([strength(math.nan, row=7)], "tensile_strength")


def references(*conditions, **facts):
    rows = [strength(condition=condition, **facts) for condition in conditions]
    return _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist()


def test_each_line_is_held_against_its_own_new_condition():
    assert references("new", "worn", "4 years") == [-1, 0, 0]
    rows = [strength(line=line, condition=c) for line in "AB" for c in ("worn", "new")]
    assert _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist() == [
        1,
        -1,
        3,
        -1,
    ]


def test_no_reference_or_two_of_them_is_none():
    assert references("worn", "4 years") == [-1, -1]
    rows = [strength(condition="new", exposure=e) for e in (0.0, 0.1)]
    rows.append(strength(condition="worn"))
    assert _reference_of(_group_outcomes(rows, "tensile_strength").groups).tolist() == [-1, -1, -1]


SHEET = Specimen(
    "N-1", material="nylon", construction="plaited", condition="new", diameter=(0.012, 0.013),
    rated_break_strength=20e3,
)  # fmt: skip


def test_a_sheet_fills_what_the_row_leaves_open():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-1", condition="wet", peak_load_ratio=0.5,
                  minimum_load=0.0)  # fmt: skip
    (full,) = complete_from_specimens([row], {"N-1": SHEET})
    assert (full.material, full.construction, full.condition) == ("nylon", "plaited", "wet")
    assert full.diameter == pytest.approx(0.0125)
    assert (full.peak_load, full.minimum_load_ratio) == (10e3, 0.0)


def test_a_row_of_another_specimen_is_left_as_it_is():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-2", peak_load=5e3)
    (left,) = complete_from_specimens([row], {"N-1": SHEET})
    assert left is row


def test_without_break_strength_a_load_stays_a_load():
    row = Outcome("cycles_to_failure", 9e4, specimen="N-1", peak_load=5e3, diameter=0.02)
    (full,) = complete_from_specimens([row], {"N-1": Specimen("N-1")})
    assert full.peak_load == 5e3 and math.isnan(full.peak_load_ratio) and full.diameter == 0.02


# outcomes that are unlike the others of their group


def strengths(*values, condition="new"):
    return [
        Outcome("tensile_strength", value, test=f"B-{place}", condition=condition, row=place)
        for place, value in enumerate(values, start=2)
    ]


def test_a_value_that_is_far_from_every_other_is_named_with_what_it_is_like():
    (found,) = odd_outcomes(strengths(28.5e3, 27.1e3, 2.8e3, 28.0e3))
    assert found.subject == "B-4" and found.severity == "warning"
    assert str(found).startswith(
        "B-4: row 4: its tensile strength is 0.1 times the median of the 3"
    )


def test_of_three_only_the_odd_one_is_named():
    (found,) = odd_outcomes(strengths(20.8e3, 95.6, 21.8e3, condition="worn"))
    assert found.subject == "B-3"


@pytest.mark.parametrize("seed", range(10))
def test_breaks_and_lives_that_scatter_as_they_do_are_not_odd(seed):
    noise = np.random.default_rng(seed)
    breaks = strengths(*(28e3 * noise.lognormal(0, 0.12, 12)))
    lives = [
        Outcome("cycles_to_failure", value, peak_load_ratio=share, row=2)
        for share, usual in ((0.45, 5e4), (0.6, 9e3))
        for value in usual * noise.weibull(1.5, 8)
    ]
    assert odd_outcomes([*breaks, *lives]) == []


def test_groups_loads_and_lower_bounds_are_not_held_against_each_other():
    worn = strengths(14e3, 13e3, 15e3, condition="worn")
    stopped = Outcome("tensile_strength", 5e3, is_suspended=True, condition="new", row=9)
    assert odd_outcomes([*strengths(28e3, 29e3, 27e3), *worn, stopped]) == []


# A row before anything is known, and the labels of a group


def test_an_empty_row_has_every_column_in_order():
    row = _empty_row(FATIGUE_COLUMNS)
    assert list(row) == [column.name for column in FATIGUE_COLUMNS]
    assert (row["quantity"], row["failed_count"]) == ("", 0) and math.isnan(row["mean_cycles"])


def test_what_a_group_does_not_say_is_no_number():
    labels = _labels_of(Group("PD", "nylon", "plaited", None, "new", None))
    assert labels["line"] == "PD" and labels["condition"] == "new"
    assert math.isnan(labels["diameter"]) and math.isnan(labels["exposure"])


# rows of the tables: every column, every group, every row of the file

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


# which tests belong to a line over time, and to a line over load, and what is left out


def broken(strength, years=math.nan, **about):
    return Outcome("tensile_strength", strength, exposure=years, **about)


def cycled(lives, load=math.nan, **about):
    return Outcome("cycles_to_failure", lives, peak_load_ratio=load, **about)


NEW = [broken(6400.0, 0.0, condition="new"), broken(6600.0, 0.0, condition="new")]
WORN = [broken(5000.0, 2.0, condition="worn"), broken(5200.0, 2.0, condition="buoy")]


def test_conditions_of_one_line_are_one_series():
    (series,) = exposure_series([*NEW, *WORN])
    assert series.exposure.tolist() == [0, 0, 2, 2]
    assert series.fit.slope == pytest.approx(-700) and series.n_unused == 0


def test_lower_bounds_are_shown_and_not_fitted():
    (series,) = exposure_series([*NEW, *WORN, broken(900.0, 2.0, place="splice", is_valid=False)])
    assert series.is_lower_bound.tolist() == [False] * 4 + [True]
    assert series.fit.slope == pytest.approx(-700) and series.fit.n == 4


def test_tests_without_an_exposure_or_a_value_are_counted():
    (series,) = exposure_series(
        [*NEW, *WORN, broken(6000.0), broken(math.nan, 2.0, is_valid=False)]
    )
    assert series.n_unused == 2 and series.exposure.size == 4


def test_another_material_is_another_line_and_one_exposure_is_none():
    both = [broken(row.value, row.exposure, material="nylon") for row in [*NEW, *WORN]]
    assert [one.group.material for one in exposure_series([*NEW, *both, *WORN])] == ["", "nylon"]
    assert exposure_series(NEW) == ()


def test_where_breaks_leave_no_scatter_the_series_says_so():
    (series,) = exposure_series([NEW[0], WORN[0]])
    assert series.fit is None and series.reason.startswith("two exposures with one break each")


def test_lives_of_a_group_keep_run_outs_and_count_the_rest():
    rows = [cycled(5e3, 0.7), cycled(7e3, 0.7), cycled(4e4, 0.5), cycled(5e4, 0.5)]
    more = [cycled(2e5, 0.3, is_suspended=True), cycled(8e4), cycled(9e4, 0.5, is_valid=False)]
    (series,) = load_series([*rows, *more])
    assert series.is_suspended.tolist() == [False] * 4 + [True]
    assert series.n_unused == 2 and series.fit.n_suspended == 1 and series.reason == ""


def test_one_load_is_a_series_without_a_line():
    (series,) = load_series([cycled(5e3, 0.7), cycled(7e3, 0.7), cycled(8e4, condition="worn")])
    assert series.fit is None
    assert series.reason == "the slope of life against load needs failures at two loads"


def test_a_value_that_cannot_be_is_refused():
    with pytest.raises(DataError, match="row 0 has no tensile_strength to be used"):
        exposure_series([broken(-1.0, 0.0)])
    with pytest.raises(DataError, match="row 0 has no cycles_to_failure to be used"):
        load_series([cycled(-1.0, 0.5)])


# what an outcome says of the line


@pytest.mark.parametrize(
    ("facts", "use"),
    [
        ({}, "value"),
        ({"place": "splice_toe"}, "value"),
        # the laboratory's word goes before the place
        ({"place": "splice"}, "value"),
        ({"is_valid": False}, "excluded"),
        ({"is_valid": False, "place": "free"}, "excluded"),
        ({"is_valid": False, "is_suspended": True}, "excluded"),
        ({"is_suspended": True}, "lower_bound"),
        *[({"is_valid": False, "place": place}, "lower_bound") for place in IN_THE_TERMINATION],
        ({"is_valid": False, "place": "grip", "value": math.nan}, "excluded"),
    ],
)
def test_use_of_a_value(facts, use):
    assert Outcome(**({"quantity": "tensile_strength", "value": 28e3} | facts)).use == use


def test_the_first_reason_that_holds_is_given():
    assert reason_codes((2,), [([False, True], 3), (True, 2)]).tolist() == [2, 3]

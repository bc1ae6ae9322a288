"""Which tests belong to a line over time, and to a line over load, and what is left out."""

import math

import pytest

from reduction.experiments.outcome_groups import exposure_series, load_series
from reduction.experiments.outcomes import Outcome
from reduction.record.errors import DataError


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

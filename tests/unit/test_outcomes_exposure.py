"""The line of strength over years."""

import math

import numpy as np
import pytest

from reduction.experiments.strength_statistics import (
    fit_exposure_trend,
    share_lost_per_year,
)
from reduction.record.errors import DataError, FitError


def test_groups_give_the_line_of_their_breaks():
    rng = np.random.default_rng(15)
    years = np.repeat([0.0, 2, 3, 5], [16, 1, 4, 2])
    strength = 6400 - 650 * years + rng.normal(0, 300, years.size)
    one_by_one = fit_exposure_trend(years, strength)
    levels, size = np.unique(years, return_counts=True)
    own = [strength[years == level] for level in levels]
    in_groups = fit_exposure_trend(
        levels,
        [v.mean() for v in own],
        [v.std(ddof=1) if v.size > 1 else np.nan for v in own],
        size,
    )
    assert in_groups.n == one_by_one.n == 23
    assert in_groups.degrees_of_freedom == one_by_one.degrees_of_freedom == 21
    for name in ("intercept", "slope", "residual_standard_deviation", "lack_of_fit_p_value"):
        assert getattr(in_groups, name) == pytest.approx(getattr(one_by_one, name))
    np.testing.assert_allclose(in_groups.covariance, one_by_one.covariance)


def test_a_group_without_deviation_counts_for_the_line_alone():
    line = fit_exposure_trend([0, 3, 5], [6400, 4365, 3241], [473, 321, np.nan], [16, 4, 2])
    assert line.degrees_of_freedom == 19 and line.n == 22


def test_two_exposures_have_no_lack_of_fit():
    line = fit_exposure_trend([0, 0, 5, 5], [64.0, 66, 31, 33])
    assert math.isnan(line.lack_of_fit_p_value)
    assert line.slope == pytest.approx(-6.6)


def test_a_curve_is_not_a_line():
    years = np.repeat([0.0, 1, 2, 3, 4], 3)
    noise = np.tile([-0.1, 0.0, 0.1], 5)
    line = fit_exposure_trend(years, 10 * np.exp(-years) + 5 + noise)
    assert line.lack_of_fit_p_value < 1e-6


def test_share_lost_is_that_of_the_line_and_inside_its_interval():
    line = fit_exposure_trend([0, 0, 5, 5], [99.0, 101, 49, 51])
    share, low, high = share_lost_per_year(line)
    assert share == pytest.approx(0.1)
    assert low < share < high


def test_share_lost_of_an_unknown_new_strength_has_no_interval():
    line = fit_exposure_trend([4.0, 4.5, 5], [9.0, 2.0, 6.0])
    share, low, high = share_lost_per_year(line)
    assert math.isfinite(share) and math.isnan(low) and math.isnan(high)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([-1, 1], [5.0, 4.0]), "an exposure is below zero; found -1; needed 0 or more"),
        (([0, 1], [5.0, -4.0]), "values of mean are not positive"),
    ],
)
def test_numbers_that_cannot_be_are_refused(arguments, message):
    with pytest.raises(DataError, match=message):
        fit_exposure_trend(*arguments)


def test_too_little_for_a_line_is_refused():
    with pytest.raises(FitError, match="a line needs two exposures; found 1; needed 2 or more"):
        fit_exposure_trend([3, 3], [5.0, 4.0])
    with pytest.raises(FitError, match="two exposures with one break each leave no scatter"):
        fit_exposure_trend([0, 3], [5.0, 4.0])


def test_a_line_without_new_strength_has_no_share():
    line = fit_exposure_trend([4.0, 4.5, 5], [0.1, 2.0, 6.0])
    with pytest.raises(FitError, match="the line has no strength when new; found"):
        share_lost_per_year(line)

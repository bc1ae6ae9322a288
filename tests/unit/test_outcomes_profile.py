"""Ends of an interval on a profile."""

import math

import pytest
from scipy import stats

from reduction.experiments.life_statistics import cutoff, profile_bounds


def test_few_failures_need_a_larger_drop_than_chi_square():
    drops = [cutoff(n_failed=n, n_coefficients=1) for n in (2, 3, 5, 20)]
    assert drops == sorted(drops, reverse=True)
    assert drops[-1] > stats.chi2.ppf(0.95, 1)


def test_no_failure_to_spare_gives_no_drop_and_no_bounds():
    assert math.isnan(cutoff(n_failed=2, n_coefficients=2))
    bounds = profile_bounds(lambda v: -(v**2), estimate=0, maximum=0, step=1, drop=math.nan)
    assert all(map(math.isnan, bounds))


def test_a_side_that_never_drops_is_open():
    low, high = profile_bounds(
        lambda value: -math.exp(-value), estimate=0, maximum=-1.0, step=0.5, drop=2.0
    )
    assert high == math.inf
    assert low == pytest.approx(-math.log(2))

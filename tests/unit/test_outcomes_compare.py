"""Ratios of means and one-way F where groups are small, equal or empty."""

import numpy as np
import pytest

from reduction.experiments.strength_statistics import one_way, ratio_of_means
from reduction.record.errors import DataError


def ratio(mean=50.0, deviation=2.0, n=5, reference=(100.0, 4.0, 10), **options):
    return ratio_of_means(
        mean, deviation, n, reference_mean=reference[0],
        reference_standard_deviation=reference[1], reference_n=reference[2], **options,
    )  # fmt: skip


def test_interval_ends_solve_the_equation_of_fieller():
    from scipy import stats

    change = ratio()
    t = stats.t.ppf(0.975, change.degrees_of_freedom)
    for end in (1 + change.low, 1 + change.high):
        assert (50 - end * 100) ** 2 == pytest.approx(t**2 * (4 / 5 + end**2 * 16 / 10))


def test_a_mean_well_known_has_the_interval_of_first_order():
    change = ratio(deviation=0.01, reference=(100.0, 0.01, 10))
    from scipy import stats

    half = stats.t.ppf(0.975, change.degrees_of_freedom) * change.standard_uncertainty
    assert change.high - change.low == pytest.approx(2 * half, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ({"n": 1}, 2),
        ({"deviation": float("nan")}, 2),
        ({"reference": (100.0, 4.0, 1)}, 2),
        ({"deviation": 0.0, "reference": (100.0, 0.0, 10)}, 4),
        ({"reference": (100.0, 90.0, 3)}, 3),
    ],
)
def test_an_interval_that_cannot_be_given_has_a_reason(arguments, reason):
    change = ratio(**arguments)
    assert change.reason == reason
    assert np.isnan(change.low) and np.isnan(change.high)
    assert change.change == -0.5


def test_ten_thousand_changes_at_once():
    change = ratio(mean=np.linspace(40, 60, 10_000))
    assert change.low.shape == (10_000,)
    assert (change.low < change.change).all() and (np.diff(change.high) > 0).all()


def test_a_mean_of_nothing_is_refused():
    with pytest.raises(DataError, match="values of reference_mean are not positive"):
        ratio(reference=(0.0, 1.0, 3))


def test_a_group_of_one_counts_between_and_not_within():
    analysis = one_way([1.0, 2.0, 3.0], [np.nan, 0.5, 0.5], [1, 4, 4])
    assert analysis.within == 6
    # means 1, 2 and 3 of 1, 4 and 4 values about 21/9, within-group variance 1/4
    between = ((1 - 21 / 9) ** 2 + 4 * (2 - 21 / 9) ** 2 + 4 * (3 - 21 / 9) ** 2) / 2
    assert analysis.f_statistic == pytest.approx(between / 0.25)


def test_groups_without_scatter_have_a_reason_and_no_f():
    analysis = one_way([1.0, 2.0], [0.0, 0.0], [3, 3])
    assert np.isnan(analysis.f_statistic) and analysis.reason == 4
    analysis = one_way([1.0, 2.0], [np.nan, np.nan], [1, 1])
    assert np.isnan(analysis.p_value) and analysis.within == 0


def test_many_tables_at_once():
    analysis = one_way([[1.0, 2.0], [1.0, 1.0]], [[1.0, 1.0]] * 2, [[5, 5]] * 2)
    assert analysis.f_statistic.tolist() == pytest.approx([2.5, 0.0])


def test_one_group_is_refused():
    with pytest.raises(DataError, match="one group has nothing to be compared with; needed two"):
        one_way([1.0], [1.0], [3])


def test_a_deviation_that_is_missing_is_refused():
    with pytest.raises(DataError, match="a group of several values has no deviation; needed"):
        one_way([1.0, 2.0], [1.0, np.nan], [3, 3])

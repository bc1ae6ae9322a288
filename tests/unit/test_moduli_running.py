"""Running statistics: blocks merge to what numpy says of the whole."""

import numpy as np
import pytest
from scipy.special import stdtrit

from reduction.stages.moduli.local_regression import RunningStatistics


def test_blocks_merge_to_the_statistics_of_the_whole():
    rng = np.random.default_rng(6)
    values = 1e4 + rng.normal(0, 1, (40, 2, 5))
    values[rng.random(values.shape) < 0.2] = np.nan
    parts = [
        RunningStatistics.of(block, np.ones_like(block), weight=np.ones(len(block)))
        for block in (values[:7], values[7:8], values[8:])
    ]
    merged = parts[0] + parts[1] + parts[2]
    assert merged.value() == pytest.approx(np.nanmean(values, axis=0), rel=1e-14)
    assert merged.scatter() == pytest.approx(np.nanstd(values, axis=0, ddof=1), rel=1e-9)
    assert merged.lowest() == pytest.approx(np.nanmin(values, axis=0))
    assert merged.highest() == pytest.approx(np.nanmax(values, axis=0))
    assert (merged.count == np.isfinite(values).sum(axis=0)).all()


def test_one_curve_keeps_the_uncertainty_it_came_with():
    one = RunningStatistics.of(np.array([[3.0]]), np.array([[4.0]]), weight=np.ones(1))
    assert one.standard_uncertainty() == 2.0
    assert np.isnan(one.scatter())


def test_nothing_seen_is_nan():
    none = RunningStatistics.of(np.full((3, 2), np.nan), np.ones((3, 2)), weight=np.ones(3))
    for value in (none.value(), none.lowest(), none.highest(), none.standard_uncertainty()):
        assert np.isnan(value).all()


def test_curve_of_pooled_cycles_counts_them_all():
    pooled = RunningStatistics.of(np.ones((2, 1)), np.ones((2, 1)), weight=np.array([5.0, 7.0]))
    assert pooled.count == 12
    assert pooled.n_curves == 2


def test_bends_of_blocks_are_those_of_the_whole():
    rng = np.random.default_rng(7)
    values = np.cumsum(rng.normal(0, 1, (12, 2, 3)), axis=0) + 0.01 * rng.normal(0, 1, (12, 2, 3))
    values[5, 0, 0] = np.nan
    whole = RunningStatistics.of(values, 0 * values, weight=np.ones(12))
    parts = [
        RunningStatistics.of(block, 0 * block, weight=np.ones(len(block)))
        for block in (values[:1], values[1:4], values[4:5], values[5:7], values[7:])
    ]
    merged = parts[0] + parts[1] + (parts[2] + parts[3]) + parts[4]
    for name in ("bends", "n_bends", "head", "tail"):
        assert getattr(merged, name) == pytest.approx(getattr(whole, name), nan_ok=True)
    assert merged.standard_uncertainty() == pytest.approx(whole.standard_uncertainty())


@pytest.mark.parametrize("cycles", [10, 50])
@pytest.mark.parametrize(
    "course",
    [
        lambda n: -0.12 * (1 - np.exp(-n / 3)),  # softens within some cycles
        lambda n: (1 + n) ** -0.05,  # by a power of their number
        lambda n: 0.1 * (1 - np.exp(-n / n[-1])),  # warms up and stiffens
        lambda n: 0 * n,
    ],
)
def test_a_mean_over_cycles_that_soften_is_as_well_known_as_they_are(course, cycles):
    rng = np.random.default_rng(3)
    level = 500 * (1 + course(np.arange(cycles)))
    values = level[:, None] + 0.5 * rng.normal(size=(cycles, 2000))
    found = RunningStatistics.of(values, np.full_like(values, 0.25), weight=np.ones(cycles))
    off = (found.value() - level.mean()) / found.standard_uncertainty()
    # the scatter about the mean is up to 48 times the noise; the first steps of a decay stay in
    assert 0.25 < np.sqrt(np.mean(off**2)) < 1.25
    assert np.mean(np.abs(off) < stdtrit(cycles - 1, 0.975)) > 0.94


@pytest.mark.parametrize("place", [0, 4, 9])
def test_one_cycle_that_is_unlike_the_others_is_no_trend(place):
    values = np.full(10, 100.0)
    values[place] = 90.0
    found = RunningStatistics.of(values, np.zeros(10), weight=np.ones(10))
    # the mean is off that of the others by 1
    assert 1.96 * found.standard_uncertainty() > 1.0

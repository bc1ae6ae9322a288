"""Running statistics: blocks merge to what numpy says of the whole."""

import numpy as np
import pytest

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

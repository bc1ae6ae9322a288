import numpy as np
import pytest
from export_lines import line, rubber

from reduction.lines.deck_formats import _fit_smooth_curve
from reduction.record.errors import DataError


def value(curve, strain):
    piece = np.clip(np.searchsorted(curve.start, strain, "right") - 1, 0, None)
    over = strain - curve.start[piece]
    return sum(curve.coefficient[piece, power] * over**power for power in range(4))


def test_a_cubic_comes_back():
    one = line()
    found = _fit_smooth_curve(one.strain, one.tension)
    grid = np.linspace(0, 1.5, 501)
    np.testing.assert_allclose(value(found, grid), rubber(grid), atol=2e-5 * rubber(1.5))
    assert found.share < 1e-5


def test_it_is_smooth_and_rises_where_the_data_are_level():
    strain = np.linspace(0, 1, 101)
    found = _fit_smooth_curve(strain, np.where(strain > 0.6, 100 * (strain - 0.6), 0.0))
    width = np.diff(np.append(found.start, found.end))[:-1]
    tension, slope, bend, third = found.coefficient[:-1].T
    ends = [
        tension + width * (slope + width * (bend + width * third)),
        slope + width * (2 * bend + 3 * width * third),
        2 * bend + 6 * width * third,
    ]
    starts = found.coefficient[1:, :3].T * np.array([[1], [1], [2]])
    for end, start in zip(ends, starts, strict=True):
        np.testing.assert_allclose(end, start, atol=1e-9 * np.abs(starts).max())
    grid = np.linspace(0, 1, 5001)
    assert np.all(np.diff(value(found, grid)) > 0)


def test_the_error_is_the_greatest_anywhere():
    found = _fit_smooth_curve(np.array([0.5, 1.0]), np.array([0.0, 1.0]))
    grid = np.linspace(0, 1, 20001)
    off = np.abs(value(found, grid) - np.interp(grid, [0, 0.5, 1], [0, 0, 1]))
    assert off.max() <= found.error + 2e-6
    assert off.max() == pytest.approx(found.error, rel=0.01)
    assert found.share < 0.003


def test_a_loop_is_refused():
    with pytest.raises(DataError, match="a loop cannot be exported"):
        _fit_smooth_curve(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 0.2]))

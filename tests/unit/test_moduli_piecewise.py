"""Piecewise lines: known breakpoints, and the best of all by brute force."""

from itertools import combinations

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.record.errors import DataError
from reduction.stages.moduli.segments import _fit_piecewise_lines

X = 0.8 + 0.01 * np.arange(45)


def lines_of(x, y, sigma=None, maximum_segments=4):
    sigma = np.ones_like(x) if sigma is None else sigma
    return _fit_piecewise_lines(x, y, standard_uncertainty=sigma, maximum_segments=maximum_segments)


@pytest.mark.parametrize(
    ("knots", "slopes"),
    [((0.8, 1.005, 1.24), (100, 300)), ((0.8, 0.905, 1.105, 1.24), (120, 90, 400))],
)
def test_known_breakpoints_come_back_within_half_a_bin(knots, slopes):
    loads = np.concatenate([[50], 50 + np.cumsum(np.diff(knots) * slopes)])
    line = lines_of(X, np.interp(X, knots, loads))[len(slopes) - 1]
    assert line.knot == pytest.approx(knots, abs=0.0051)
    assert np.diff(line.ordinate) / np.diff(line.knot) == pytest.approx(slopes, rel=0.03)


@pytest.mark.parametrize("noise", [0.1, 0.5])
def test_breakpoints_come_back_from_noise(noise):
    rng = np.random.default_rng(10)
    y = np.interp(X, (0.8, 1.0, 1.24), (50, 70, 142)) + rng.normal(0, noise, X.size)
    line = lines_of(X, y)[1]
    assert line.knot[1] == pytest.approx(1.0, abs=0.03)
    assert np.diff(line.ordinate) / np.diff(line.knot) == pytest.approx((100, 300), rel=0.1)


def brute_force(x, y, weight, n_segments):
    """Least weighted squares over every choice of knots, each by a plain least squares."""
    middles = (x[1:] + x[:-1]) / 2
    shortest = max(3, -(-x.size // 10))
    best = np.inf
    for inner in combinations(range(1, x.size), n_segments - 1):
        counts = np.diff([0, *inner, x.size])
        if counts.min() < shortest or x.size - 1 in inner:
            continue
        knots = [x[0], *(middles[i - 1] for i in inner), x[-1]]
        basis = np.stack([np.interp(x, knots, unit) for unit in np.eye(len(knots))], axis=1)
        root = np.sqrt(weight)
        solution = np.linalg.lstsq(basis * root[:, None], y * root, rcond=None)[0]
        best = min(best, float(np.sum(weight * (y - basis @ solution) ** 2)))
    return best


@settings(max_examples=examples(25), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n_segments=st.integers(1, 3))
def test_search_finds_the_best_of_all_lines(seed, n_segments):
    rng = np.random.default_rng(seed)
    x = np.cumsum(0.5 + rng.random(16))
    y = np.cumsum(rng.normal(0, 5, 16))
    sigma = 0.5 + rng.random(16)
    line = lines_of(x, y, sigma, n_segments)[-1]
    assert line.knot.size == n_segments + 1
    assert line.chi_square == pytest.approx(brute_force(x, y, sigma**-2, n_segments), rel=1e-8)


def test_more_segments_never_fit_worse():
    y = np.exp(X) + np.random.default_rng(11).normal(0, 0.01, X.size)
    squares = [line.chi_square for line in lines_of(X, y, maximum_segments=5)]
    assert len(squares) == 5
    assert np.all(np.diff(squares) <= 1e-9)


def test_covariance_is_that_of_repeated_noise():
    rng = np.random.default_rng(12)
    truth = np.interp(X, (0.8, 1.005, 1.24), (50, 70, 142))
    runs = [
        lines_of(X, truth + rng.normal(0, 0.01, X.size), maximum_segments=2)[1] for _ in range(300)
    ]
    same = [run.ordinate for run in runs if run.knot[1] == runs[0].knot[1]]
    stated = 0.01 * np.sqrt(np.diag(runs[0].covariance))
    assert len(same) > 250
    assert np.std(same, axis=0) == pytest.approx(stated, rel=0.15)


def test_few_points_hold_few_segments():
    x = np.arange(5.0)
    assert len(lines_of(x, x**2, maximum_segments=4)) == 1


def test_thousand_points_are_searched_on_48_breakpoints():
    x = np.linspace(0, 1, 1000)
    line = lines_of(x, np.interp(x, (0, 0.5, 1), (0, 1, 4)))[1]
    assert line.knot[1] == pytest.approx(0.5, abs=0.5 / 47)


@pytest.mark.parametrize(("n_points", "n_segments"), [(2, 1), (9, 0)])
def test_too_little_is_refused(n_points, n_segments):
    x = np.arange(float(n_points))
    with pytest.raises(DataError, match=f"found {n_points} points, {n_segments} segments"):
        lines_of(x, x, maximum_segments=n_segments)


def test_points_out_of_order_are_refused():
    with pytest.raises(DataError, match="abscissa are not above the one before"):
        lines_of(np.array([0.0, 2.0, 1.0, 3.0]), np.zeros(4))

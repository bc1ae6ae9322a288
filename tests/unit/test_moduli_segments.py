"""Segments of branches: their number by the criterion, their limits contiguous."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.record.errors import DataError
from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.modulus_product import ModulusCurves
from reduction.stages.moduli.segments import _fit_piecewise_lines, find_segments

AREA = 5e-4
X = 0.8 + 0.01 * np.arange(45)


def curves_of(tension, *, uncertainty=0.1, count=10, modulus_uncertainty=100.0):
    tension = np.broadcast_to(np.asarray(tension, dtype=float), (1, 2, X.size))
    blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((1, 2, X.size)))
    return ModulusCurves(
        **blank
        | {
            "strain_bin": X,
            "window": 0.09,
            "branch_tension": tension.copy(),
            "branch_tension_standard_uncertainty": np.full(tension.shape, uncertainty),
            "tangent_modulus_count": np.full(tension.shape, count),
            "tangent_modulus_standard_uncertainty": np.full(tension.shape, modulus_uncertainty),
            "tangent_modulus_by_cycle": np.empty((1, 0, 2, X.size)),
        }
    )


def segments_of(curves, **settings):
    return find_segments(curves, area=[AREA], settings=ModulusSettings(**settings))


@pytest.mark.parametrize("n_segments", [1, 2, 3])
def test_as_many_segments_are_found_as_the_branch_has(n_segments):
    knots = [0.8, 0.955, 1.105, 1.24][: n_segments + 1]
    knots[-1] = 1.24
    loads = np.cumsum([50, *(np.diff(knots) * [100, 250, 500][:n_segments])])
    segments = segments_of(curves_of(np.interp(X, knots, loads)))
    assert segments.segment_modulus.shape == (1, 2, n_segments)
    expected = np.array([100, 250, 500][:n_segments])
    assert segments.segment_modulus[0, 0] * AREA == pytest.approx(expected, rel=0.05)


def test_segments_are_contiguous_and_their_modulus_is_the_chord():
    segments = segments_of(curves_of(100 * np.exp(X)))
    for low, high in (("strain_low", "strain_high"), ("tension_low", "tension_high")):
        lows, highs = (getattr(segments, f"segment_{name}")[0, 0] for name in (low, high))
        assert lows[1:] == pytest.approx(highs[:-1])
    chord = (segments.segment_tension_high - segments.segment_tension_low) / (
        AREA * (segments.segment_strain_high - segments.segment_strain_low)
    )
    assert segments.segment_modulus == pytest.approx(chord)
    assert segments.segment_strain_low[0, 0, 0] == X[0]
    assert segments.segment_strain_high[0, 0, -1] == X[-1]


@pytest.mark.parametrize(("tolerance", "n_segments"), [(0.1, 1), (0.02, 1), (0.01, 2), (0.002, 3)])
def test_the_tolerance_decides_how_many_segments(tolerance, n_segments):
    # one line through exp(x) on this range is off by 1.7 % rms of the range of tension,
    # n contiguous ones by about 1/n^2 of that
    tension = 100 * np.exp(X)
    line = np.polynomial.Polynomial.fit(X, tension, 1)
    share = np.sqrt(np.mean((tension - line(X)) ** 2)) / np.ptp(tension)
    assert share == pytest.approx(0.017, abs=0.001)
    segments = segments_of(curves_of(tension, uncertainty=1e-6), segment_tolerance=tolerance)
    assert np.isfinite(segments.segment_modulus[0, 0]).sum() == n_segments


def test_noise_of_the_branch_asks_for_no_further_segments():
    noise = np.random.default_rng(4).normal(0, 5.0, X.size)
    segments = segments_of(curves_of(100 * np.exp(X) + noise))
    assert np.isfinite(segments.segment_modulus[0, 0]).sum() == 1


def test_bins_that_few_cycles_reach_do_not_bend_the_line():
    tension = np.broadcast_to(300 * X, (1, 2, X.size)).copy()
    tension[..., -3:] -= 20
    count = np.full(tension.shape, 10)
    count[..., -3:] = 2
    curves = replace(curves_of(tension), tangent_modulus_count=count)
    segments = segments_of(curves)
    assert segments.segment_modulus[0, 0] * AREA == pytest.approx([300])
    assert segments.segment_strain_high[0, 0, 0] == X[-4]


def test_the_distance_of_the_branch_from_the_line_stands_beside_the_uncertainty():
    curves = curves_of(100 * np.exp(X), uncertainty=1e-6, modulus_uncertainty=1e-6)
    segments = segments_of(curves, maximum_segments=1)
    line = np.interp(
        X,
        [X[0], X[-1]],
        [segments.segment_tension_low[0, 0, 0], segments.segment_tension_high[0, 0, 0]],
    )
    rms = np.sqrt(np.mean((100 * np.exp(X) - line) ** 2))
    assert segments.segment_misfit[0, 0, 0] == pytest.approx(rms, rel=1e-9)
    # ten cycles that agree: the chord is known, the curve is no chord
    assert segments.segment_modulus_standard_uncertainty[0, 0, 0] < 1e-2 * rms / AREA


@pytest.mark.parametrize("tension", [100 * np.exp(X), 300 * X**3, 400 / (2 - X)])
def test_segments_of_a_smooth_branch_end_on_it(tension):
    segments = segments_of(curves_of(tension))
    for end in ("low", "high"):
        at = getattr(segments, f"segment_strain_{end}")[0, 0]
        found = getattr(segments, f"segment_tension_{end}")[0, 0]
        spread = getattr(segments, f"segment_tension_{end}_standard_uncertainty")[0, 0]
        truth = np.interp(at, X, tension)
        assert np.all(np.abs(found - truth) < 2 * spread)
        assert np.abs(found - truth).max() < 5e-3 * np.ptp(tension)
    low, high = segments.segment_strain_low[0, 0], segments.segment_strain_high[0, 0]
    chord = (np.interp(high, X, tension) - np.interp(low, X, tension)) / AREA / (high - low)
    error = segments.segment_modulus[0, 0] - chord
    assert np.all(np.abs(error) < 2 * segments.segment_modulus_standard_uncertainty[0, 0])


def test_number_of_segments_stays_within_the_setting():
    segments = segments_of(curves_of(1e4 * X**3, uncertainty=1e-9), maximum_segments=2)
    assert segments.segment_modulus.shape[-1] == 2
    assert "at most 2" in segments.criterion


def test_branch_with_fewer_segments_is_filled_with_nan():
    both = np.stack([200 * X, np.interp(X, (0.8, 1.0, 1.24), (50, 70, 142))])[None]
    segments = segments_of(curves_of(both))
    assert np.isnan(segments.segment_modulus[0, 0, 1])
    assert np.isfinite(segments.segment_modulus[0, 1]).all()


def test_branch_without_tension_has_no_segment():
    tension = np.full((1, 2, X.size), np.nan)
    tension[0, 0] = 200 * X
    tension[0, 1, :5] = 1.0
    segments = segments_of(curves_of(tension))
    assert np.isfinite(segments.segment_modulus[0, 0, 0])
    assert np.isnan(segments.segment_modulus[0, 1]).all()


def test_one_cycle_without_scatter_still_has_segments():
    segments = segments_of(curves_of(200 * X, uncertainty=np.nan, count=1))
    assert segments.segment_modulus[0, 0, 0] * AREA == pytest.approx(200)


def test_uncertainty_is_that_of_the_windows_in_the_segment():
    segments = segments_of(curves_of(200 * X, modulus_uncertainty=100.0))
    assert segments.segment_modulus_standard_uncertainty[0, 0, 0] == pytest.approx(
        100 / np.sqrt(0.44 / 0.09)
    )


def test_uncertainty_is_the_scatter_of_the_cycles_where_they_have_curves():
    # ten cycles whose stiffness differs as a whole, and noise from bin to bin within each
    rng = np.random.default_rng(3)
    stiff = rng.normal(1e6, 2e4, 10)
    noise = rng.normal(0, 1e5, (1, 10, 2, X.size))
    by_cycle = stiff[None, :, None, None] + noise - noise.mean(axis=-1, keepdims=True)
    curves = replace(curves_of(200 * X), tangent_modulus_by_cycle=by_cycle)
    found = segments_of(curves).segment_modulus_standard_uncertainty[0, 0, 0]
    assert found == pytest.approx(np.std(stiff, ddof=1) / np.sqrt(10))


def test_kept_cycles_of_a_long_test_speak_for_all_of_them():
    stiff = np.array([1.0, 1.1, 0.9, 1.05, 0.95]) * 1e6
    by_cycle = np.broadcast_to(stiff[None, :, None, None], (1, 5, 2, X.size))
    curves = replace(curves_of(200 * X, count=400), tangent_modulus_by_cycle=by_cycle)
    found = segments_of(curves).segment_modulus_standard_uncertainty[0, 0, 0]
    assert found == pytest.approx(np.std(stiff, ddof=1) / 20)


# piecewise lines: known breakpoints, and the best of all by brute force


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

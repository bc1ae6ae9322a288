"""Local regression from nine sums: exact on parabolas, equal to polyfit, honest about noise."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from reduction.record.errors import DataError
from reduction.stages.moduli.local_regression import accumulate_moments, fit_windows
from reduction.stages.moduli.tangent_window import StrainGrid

GRID = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=3)


def fits_of(strain, tension, *, grid=GRID, curve=None, n_curves=1, minimum_count=4):
    curve = np.zeros(strain.size, dtype=np.int64) if curve is None else curve
    moments, _ = accumulate_moments(
        strain, tension, curve=curve, n_curves=n_curves, grid=grid, tension_reference=300.0
    )
    return fit_windows(moments, minimum_count=minimum_count)


def tells_a_bend(strain, grid=GRID):
    """Whether the samples of each window leave of u**2, beside a line, 5 % of what even ones do."""
    shares = []
    for centre in grid.centres:
        u = (strain[np.abs(strain - centre) < grid.window / 2] - centre) / grid.window
        line = np.polynomial.Polynomial.fit(u, u**2, 1) if u.size > 1 else np.zeros_like
        shares.append(np.mean((u**2 - line(u)) ** 2) * 180 if u.size else 0.0)
    return np.array(shares) > 0.05


@given(seed=st.integers(0, 2**32 - 1), bend=st.floats(-1e4, 1e4))
@example(seed=12521, bend=1e4)  # a window of two clusters, which a straight line fits alone
def test_parabola_comes_back_at_the_bin_centres_where_samples_tell_its_bend(seed, bend):
    strain = 1 + 0.5 * np.random.default_rng(seed).random(150)
    fits = fits_of(strain, 300 + 500 * strain + bend * strain**2)
    known = np.isfinite(fits.slope[0]) & tells_a_bend(strain)
    centre = GRID.centres[known]
    scale = 500 + abs(bend)
    assert known.sum() > 10
    assert fits.slope[0, known] == pytest.approx(500 + 2 * bend * centre, abs=1e-9 * scale)
    value = 300 + 500 * centre + bend * centre**2
    assert fits.tension[0, known] == pytest.approx(value, abs=1e-9 * scale)


def test_a_line_is_fitted_where_no_bend_can_be_told():
    """Two clusters at the ends of a window: the chord between them, at its own mean."""
    strain = np.concatenate([np.linspace(1.031, 1.037, 4), np.linspace(1.143, 1.149, 4)])
    fits = fits_of(strain, 1000 * strain + 2000 * strain**2)
    (middle,) = np.flatnonzero(np.abs(GRID.centres - 1.09) < 1e-9)
    assert not tells_a_bend(strain)[middle]
    # about the centre the mean of the ends: 1000 + 2 * 2000 * 1.09; the level is the chord's
    assert fits.slope[0, middle] == pytest.approx(1000 + 4000 * 1.09)
    spread = np.mean((strain - 1.09) ** 2)
    level = 1000 * 1.09 + 2000 * (1.09**2 + spread)
    assert fits.tension[0, middle] == pytest.approx(level)


def test_fit_equals_polyfit_on_the_samples_of_the_window():
    rng = np.random.default_rng(1)
    strain = 1 + 0.5 * rng.random(400)
    tension = 100 * np.exp(strain) + rng.normal(0, 1, 400)
    fits = fits_of(strain, tension)
    for at in range(4, 21):
        low, high = GRID.bounds[at - 3, 0], GRID.bounds[at + 3, 1]
        inside = (strain >= low) & (strain < high)
        _, slope, level = np.polyfit(strain[inside] - GRID.centres[at], tension[inside], 2)
        assert fits.slope[0, at] == pytest.approx(slope, rel=1e-8)
        assert fits.tension[0, at] == pytest.approx(level, rel=1e-10)


@pytest.mark.parametrize("per_curve", [20, 60])  # 6 and 17 samples in a window
def test_stated_variances_are_those_of_many_noisy_branches(per_curve):
    rng = np.random.default_rng(2)
    n_curves = 2000
    strain = np.tile(np.linspace(1, 1.5, per_curve), n_curves)
    tension = 1000 * strain + rng.normal(0, 2.0, strain.size)
    fits = fits_of(
        strain, tension, curve=np.repeat(np.arange(n_curves), per_curve), n_curves=n_curves
    )
    for value, variance in (
        (fits.slope, fits.slope_variance),
        (fits.tension, fits.tension_variance),
    ):
        known = np.isfinite(value[0])
        stated = np.sqrt(variance[:, known].mean(axis=0))
        assert stated == pytest.approx(value[:, known].std(axis=0), rel=0.08)


def test_moments_of_two_pieces_add_up_to_those_of_the_whole():
    rng = np.random.default_rng(3)
    strain, tension = 1 + 0.5 * rng.random(200), rng.normal(300, 50, 200)

    def moments_of(part):
        return accumulate_moments(
            strain[part], tension[part], curve=np.zeros(strain[part].size, dtype=np.int64),
            n_curves=1, grid=GRID, tension_reference=300.0,
        )[0]  # fmt: skip

    together = moments_of(slice(0, 90)) + moments_of(slice(90, 200))
    assert together.sums == pytest.approx(moments_of(slice(0, 200)).sums, rel=1e-12)


def test_moments_of_two_references_are_refused():
    none = np.empty(0)
    both = [
        accumulate_moments(
            none, none, curve=none.astype(np.int64), n_curves=1, grid=GRID, tension_reference=level
        )[0]
        for level in (0.0, 1.0)
    ]
    with pytest.raises(DataError, match="moments of two grids do not add up"):
        both[0] + both[1]


def test_missing_samples_and_samples_of_no_curve_are_skipped():
    strain = np.linspace(1, 1.5, 300)
    tension = 1000 * strain
    spoiled_strain, spoiled_tension = strain.copy(), tension.copy()
    spoiled_strain[50:60] = np.nan
    spoiled_tension[100:110] = np.nan
    curve = np.zeros(300, dtype=np.int64)
    curve[200:205] = -1
    spoiled_tension[200:205] = 1e6
    fits = fits_of(spoiled_strain, spoiled_tension, curve=curve)
    known = np.isfinite(fits.slope)
    assert known.sum() >= 20
    assert fits.slope[known] == pytest.approx(1000)


def test_samples_off_the_grid_are_counted():
    strain = np.array([0.5, 1.1, 1.2, 9.0, np.nan])
    _, n_outside = accumulate_moments(
        strain, np.zeros(5), curve=np.zeros(5, dtype=np.int64), n_curves=1, grid=GRID,
        tension_reference=0.0,
    )  # fmt: skip
    assert n_outside == 2


def test_cluster_of_samples_has_no_slope():
    strain = np.full(50, 1.25) + np.random.default_rng(4).normal(0, 1e-4, 50)
    assert np.isnan(fits_of(strain, 1000 * strain).slope).all()


def test_two_clusters_give_a_straight_slope_between_them():
    strain = np.tile([1.20, 1.30], 20)
    fits = fits_of(strain, 1000 * strain)
    at = 12  # centre 1.25
    assert fits.slope[0, at] == pytest.approx(1000)


def test_fewer_samples_than_the_minimum_give_no_slope():
    strain = np.array([1.20, 1.23, 1.27, 1.30])
    assert np.isfinite(fits_of(strain, 1000 * strain, minimum_count=4).slope).any()
    assert np.isnan(fits_of(strain, 1000 * strain, minimum_count=5).slope).all()


def test_no_slope_is_given_where_a_window_hangs_over_the_end_of_a_branch():
    strain = np.linspace(1.0, 1.3, 300)
    known = np.isfinite(fits_of(strain, 1000 * strain).slope[0])
    last = GRID.centres[known][-1]
    assert 1.3 - last >= 0.24 * GRID.window


def test_two_samples_cannot_make_a_slope():
    strain = np.linspace(1, 1.5, 9)
    with pytest.raises(DataError, match=r"needs more samples; found minimum_count 2"):
        fits_of(strain, strain, minimum_count=2)


def test_the_levels_of_curves_of_few_samples_are_found_beside_their_slope():
    """A parabola, seven samples a curve at other strains each, on levels that fall: no residual."""
    n_curves, n_each = 12, 7
    places = (np.arange(n_each) + np.mod(0.37 * np.arange(n_curves)[:, None], 1)) / n_each
    strain = (1 + 0.5 * places).ravel()
    curve = np.repeat(np.arange(n_curves), n_each)
    tension = 1000 * strain + 400 * strain**2 - 3.0 * curve
    grid = StrainGrid(low=1.0, width=0.02, n_bins=25, half_window=7)
    moments, _ = accumulate_moments(
        strain, tension, curve=curve, n_curves=n_curves, grid=grid, tension_reference=300.0
    )
    fits = fit_windows(moments.pooled(1), minimum_count=4)
    known = np.isfinite(fits.slope[0])
    assert known.sum() > 15
    # across a bin tension rises by 35 N; of that, a few hundredths of a newton are taken for level
    assert fits.slope[0, known] == pytest.approx(1000 + 800 * grid.centres[known], rel=2e-3)
    assert np.sqrt(fits.slope_variance[0, known]).max() < 2.0

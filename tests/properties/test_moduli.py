"""Laws of the modulus stage: scale, shift, reversal of time, no order of specimens."""

import numpy as np
import pytest
from examples import examples
from hypothesis import given, settings
from hypothesis import strategies as st

from reduction.record.settings import ModulusSettings
from reduction.stages.moduli.loop_balance import check_identity
from reduction.stages.moduli.segments import find_segments
from reduction.stages.moduli.tangent_modulus import tangent_curves

SETTINGS = ModulusSettings(strain_bin_width=0.02)
EXAMPLES = settings(max_examples=examples(15), deadline=None)
SEED = st.integers(0, 2**32 - 1)


def noisy_loop(triangle, seed, **keywords):
    rng = np.random.default_rng(seed)
    strain, cycles = triangle(n_cycles=4, per_cycle=120, trimmed=4, **keywords)
    sign = np.where(cycles.branch == 1, -1.0, 1.0)
    tension = 200 * strain + 60 * strain**3 + 4 * sign * np.cos(2 * np.pi * (strain - 1.25))
    strain = strain + rng.normal(0, 3e-4, strain.size)
    return strain, tension + rng.normal(0, 0.5, strain.size), cycles


def reduce(strain, tension, cycles, area=(5e-4,)):
    return tangent_curves(
        np.atleast_2d(strain), np.atleast_2d(tension), area=area, cycles=cycles, settings=SETTINGS
    )


@EXAMPLES
@given(seed=SEED, scale=st.floats(0.01, 100), shift=st.floats(-1e4, 1e4))
def test_modulus_scales_with_tension_and_forgets_its_zero(triangle, seed, scale, shift):
    strain, tension, cycles = noisy_loop(triangle, seed)
    one = reduce(strain, tension, cycles)
    other = reduce(strain, scale * tension + shift, cycles)
    assert other.tangent_modulus == pytest.approx(
        scale * one.tangent_modulus, rel=1e-6, nan_ok=True
    )
    assert other.branch_tension == pytest.approx(
        scale * one.branch_tension + shift, rel=1e-6, nan_ok=True
    )


@EXAMPLES
@given(seed=SEED, bins=st.integers(-40, 200))
def test_curve_moves_with_strain_by_whole_bins(triangle, seed, bins):
    strain, tension, cycles = noisy_loop(triangle, seed)
    # away from edges, so that rounding moves no sample to the next bin
    one = reduce(strain, tension, cycles)
    other = reduce(strain + 0.02 * bins, tension, cycles)
    assert other.strain_bin == pytest.approx(one.strain_bin + 0.02 * bins)
    assert other.tangent_modulus == pytest.approx(one.tangent_modulus, rel=1e-3, nan_ok=True)


@EXAMPLES
@given(seed=SEED)
def test_reversed_time_swaps_the_branches(triangle, seed):
    strain, tension, cycles = noisy_loop(triangle, seed)
    _, backwards = triangle(n_cycles=4, per_cycle=120, trimmed=4)
    one = reduce(strain, tension, cycles)
    other = reduce(strain[::-1].copy(), tension[::-1].copy(), backwards)
    # a reversal belongs to one branch, and to the other one backwards: it is trimmed here
    assert other.tangent_modulus[:, ::-1] == pytest.approx(
        one.tangent_modulus, rel=1e-9, nan_ok=True
    )


@EXAMPLES
@given(seed=SEED, factor=st.floats(0.1, 10))
def test_area_divides_everything_but_tension(triangle, seed, factor):
    strain, tension, cycles = noisy_loop(triangle, seed)
    one = reduce(strain, tension, cycles)
    other = reduce(strain, tension, cycles, area=(5e-4 * factor,))
    for name in ("tangent_modulus", "tangent_modulus_standard_uncertainty"):
        assert getattr(other, name) * factor == pytest.approx(getattr(one, name), nan_ok=True)
    assert other.branch_tension == pytest.approx(one.branch_tension, nan_ok=True)
    segments = [
        find_segments(curves, area=[area], settings=SETTINGS)
        for curves, area in ((one, 5e-4), (other, 5e-4 * factor))
    ]
    assert segments[1].segment_modulus * factor == pytest.approx(
        segments[0].segment_modulus, nan_ok=True
    )


@EXAMPLES
@given(seed=SEED)
def test_order_of_specimens_does_not_matter(triangle, seed):
    strain, tension, cycles = noisy_loop(triangle, seed)
    strains, tensions = np.stack([strain, strain * 1.02]), np.stack([tension, tension * 1.5])
    one = reduce(strains, tensions, cycles, area=(5e-4, 4e-4))
    other = reduce(strains[::-1], tensions[::-1], cycles, area=(4e-4, 5e-4))
    assert other.tangent_modulus[::-1] == pytest.approx(one.tangent_modulus, nan_ok=True)


@EXAMPLES
@given(seed=SEED)
def test_envelope_holds_the_mean(triangle, seed):
    curves = reduce(*noisy_loop(triangle, seed))
    known = np.isfinite(curves.tangent_modulus)
    slack = 1e-9 * curves.tangent_modulus[known]
    assert (curves.tangent_modulus_minimum[known] <= curves.tangent_modulus[known] + slack).all()
    assert (curves.tangent_modulus_maximum[known] >= curves.tangent_modulus[known] - slack).all()


@EXAMPLES
@given(seed=SEED, lost=st.floats(-5, 5))
def test_identity_closes_whatever_is_lost(triangle, seed, lost):
    strain, tension, cycles = noisy_loop(triangle, seed)
    tension = tension - lost * np.arange(tension.size) / 120
    checked = check_identity(strain[None], tension[None], area=[5e-4], cycles=cycles)
    # 0.5 N of noise, 4 pieces of 15 samples, 240 N of range: 0.5 % one sigma
    assert np.abs(checked.identity_residual).max() < 0.04

"""Secant and chord modulus of each cycle, with the noise that one or two readings carry."""

import dataclasses

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.secant_modulus import end_moduli

AREA = np.array([5e-4, 4e-4])


def law(strain):
    return 200 * strain + 30 * strain**3


def both(strain):
    return np.stack([strain, strain]), np.stack([law(strain), 2 * law(strain)])


def test_secant_is_stress_over_strain_at_the_peak_and_chord_the_slope_between_ends(triangle):
    strain, cycles = triangle(n_cycles=4, per_cycle=100)
    low, high = strain.min(), strain.max()
    found = end_moduli(*both(strain), area=AREA, cycles=cycles)
    factor = np.array([1, 2]) / AREA
    assert found.secant_modulus == pytest.approx(
        np.outer(factor, np.full(4, law(high) / high)), rel=1e-9
    )
    chord = (law(high) - law(low)) / (high - low)
    assert found.chord_modulus.shape == (2, 4, 2)
    assert found.chord_modulus[1] == pytest.approx(np.full((4, 2), factor[1] * chord), rel=1e-9)


def test_uncertainties_are_the_scatter_that_noise_of_both_channels_gives(triangle):
    strain, cycles = triangle(n_cycles=600, per_cycle=100)
    random = np.random.default_rng(3)
    tension = 300 * strain + random.normal(0, 1.5, strain.size)
    noisy = strain + random.normal(0, 0.002, strain.size)
    found = end_moduli(noisy[None], tension[None], area=AREA[:1], cycles=cycles)
    for name in ("secant_modulus", "chord_modulus"):
        values = getattr(found, name)[0]
        stated = getattr(found, f"{name}_standard_uncertainty")[0]
        assert values.std(axis=0) == pytest.approx(np.median(stated, axis=0), rel=0.1)


def test_a_missing_reading_or_a_branch_without_stroke_has_no_number(triangle):
    strain, cycles = triangle(n_cycles=3, per_cycle=50)
    strains, tensions = both(strain)
    tensions[0, cycles.branch_last[1, 0]] = np.nan
    still = cycles.branch_last.copy()
    still[2] = cycles.branch_first[2]
    found = end_moduli(
        strains, tensions, area=AREA, cycles=dataclasses.replace(cycles, branch_last=still)
    )
    assert np.isnan(found.secant_modulus).tolist() == [[False, True, False], [False] * 3]
    assert np.isnan(found.chord_modulus[0, 1]).all()
    assert np.isnan(found.chord_modulus[:, 2]).all()
    assert np.isfinite(found.chord_modulus[1, :2]).all()


def test_a_secant_from_no_strain_is_not_given(triangle):
    strain, cycles = triangle(n_cycles=2, per_cycle=50)
    found = end_moduli(strain[None] - strain.max(), law(strain)[None], area=AREA[:1], cycles=cycles)
    assert np.isnan(found.secant_modulus).all()
    assert np.isnan(found.secant_modulus_standard_uncertainty).all()
    assert np.isfinite(found.chord_modulus).all()


def test_an_area_that_is_not_positive_is_refused(triangle):
    strain, cycles = triangle(n_cycles=2, per_cycle=50)
    with pytest.raises(DataError, match="area"):
        end_moduli(*both(strain), area=[5e-4, 0.0], cycles=cycles)

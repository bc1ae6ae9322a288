"""Closed-cycle identity: it holds for sound cycles and fails where something is wrong."""

import dataclasses

import numpy as np
import pytest

from reduction.moduli import identity
from reduction.moduli.identity import check_identity

AREA = 5e-4


def loop(strain, cycles, *, lost=0.0):
    """A hysteresis loop that closes but for ``lost`` newton a cycle."""
    sign = np.where(cycles.branch == 1, -1.0, 1.0)
    middle, half = (strain.max() + strain.min()) / 2, np.ptp(strain) / 2
    bow = 1 - ((strain - middle) / half) ** 2
    progress = np.arange(strain.size) / (strain.size - 1) * cycles.n_cycles
    return 200 * strain + 30 * strain**3 + 5 * sign * bow - lost * progress


@pytest.mark.parametrize("begins", ["valley", "peak"])
@pytest.mark.parametrize("per_cycle", [20, 95, 400])
def test_identity_holds_for_a_relaxing_loop(triangle, begins, per_cycle):
    strain, cycles = triangle(n_cycles=6, per_cycle=per_cycle, begins=begins)
    checked = check_identity(
        strain[None], loop(strain, cycles, lost=2.0)[None], area=[AREA], cycles=cycles
    )
    assert checked.tension_loss_modulus == pytest.approx(np.full((1, 6), 2.0 / (AREA * 0.5)))
    assert (checked.stroke_mean_modulus_difference < 0).all()
    assert np.abs(checked.identity_residual).max() < (0.02 if per_cycle == 20 else 0.003)


def test_residual_of_noise_is_as_stated(triangle):
    rng = np.random.default_rng(13)
    strain, cycles = triangle(n_cycles=400, per_cycle=96)
    noise, n, pieces = 1.2, 48, 4
    tension = 300 * strain + rng.normal(0, noise, strain.size)
    checked = check_identity(strain[None], tension[None], area=[AREA], cycles=cycles)
    stated = noise * pieces * np.sqrt(24 / n) / (300 * 0.5)
    assert checked.identity_residual.std() == pytest.approx(stated, rel=0.15)
    assert abs(checked.identity_residual.mean()) < 4 * stated / 20


def test_swapped_branches_show_as_twice_the_loss(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    tension = loop(strain, cycles, lost=10.0)
    swapped = dataclasses.replace(
        cycles,
        branch=(3 - cycles.branch).astype(np.int8),
        branch_first=cycles.branch_first[:, ::-1].copy(),
        branch_last=cycles.branch_last[:, ::-1].copy(),
    )
    sound, wrong = (
        check_identity(strain[None], tension[None], area=[AREA], cycles=each)
        for each in (cycles, swapped)
    )
    assert np.abs(sound.identity_residual).max() < 0.003
    mean = 10 / (AREA * 0.5) * 2 / wrong.identity_residual
    assert (mean * AREA * 0.5) == pytest.approx(np.ptp(200 * strain + 30 * strain**3), rel=0.05)


def test_drop_of_tension_at_a_dwell_shows(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    tension = loop(strain, cycles)
    tension = tension - 10.0 * (cycles.branch == 2)  # lost at each peak, back at each valley
    tension[cycles.first] = tension[0]
    checked = check_identity(strain[None], tension[None], area=[AREA], cycles=cycles)
    assert np.abs(checked.identity_residual[0, :-1]).max() < 0.02
    falling = tension - 10.0 * (cycles.cycle_number - 1)
    checked = check_identity(strain[None], falling[None], area=[AREA], cycles=cycles)
    assert checked.identity_residual[0, 2] == pytest.approx(10 / (250 * 0.5), rel=0.5)


def test_cycle_with_missing_samples_is_not_checked(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    tension = loop(strain, cycles)
    tension[230:260] = np.nan
    checked = check_identity(strain[None], tension[None], area=[AREA], cycles=cycles)
    assert np.isnan(checked.identity_residual[0, 1])
    assert np.isfinite(np.delete(checked.identity_residual[0], 1)).all()


def test_size_of_a_block_changes_nothing(triangle, monkeypatch):
    strain, cycles = triangle(n_cycles=20, per_cycle=60)
    arguments = {"area": [AREA], "cycles": cycles}
    tension = loop(strain, cycles, lost=1.0)[None]
    whole = check_identity(strain[None], tension, **arguments)
    monkeypatch.setattr(identity, "_BLOCK_SAMPLES", 77)
    pieces = check_identity(strain[None], tension, **arguments)
    assert pieces.identity_residual == pytest.approx(whole.identity_residual, abs=1e-12)


def test_dead_specimen_is_nan_and_leaves_the_other_alone(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    both = np.stack([loop(strain, cycles), np.full_like(strain, np.nan)])
    checked = check_identity(np.stack([strain, strain]), both, area=[AREA, AREA], cycles=cycles)
    assert np.isfinite(checked.identity_residual[0]).all()
    assert np.isnan(checked.identity_residual[1]).all()

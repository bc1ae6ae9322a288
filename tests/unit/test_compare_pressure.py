"""Measured fill pressure against the prediction, of hoses whose pressure is known."""

import numpy as np
import pytest
from compared_hoses import PSI, TRUTH, cycled, dataset, squeezed
from measured_hoses import Truth
from scipy.stats import binom

from reduction.prediction.hose_comparison import _compare_hose, compare_record
from reduction.prediction.hose_prediction import HosePlan
from reduction.prediction.hose_tension import predict_hose
from reduction.prediction.measured_curve import constant_errors, measured_curve, pressure_errors

UNCERTAIN = {"wrap_angle": np.radians(0.3), "cord_load_scale": 0.03}
GAUGE, STRAIN_GAIN = 5e3, 0.003


def compared(truth=TRUTH, *, pressure=None, gauge=2e3, calibrate=()):
    return _compare_hose(
        TRUTH.design(), cycled(truth, reach=0.9), standard_uncertainty=UNCERTAIN,
        calibrate=calibrate, pressure=pressure or squeezed(truth, reach=0.9, gauge=gauge),
    ).pressure  # fmt: skip


def test_the_pressure_of_the_prediction_is_the_hoop_force_over_the_radius():
    strain = np.linspace(0.0, 1.0, 51)
    np.testing.assert_allclose(
        predict_hose(TRUTH.design(), strain).fill_pressure, TRUTH.pressure(strain), rtol=1e-9, atol=1e-6
    )  # fmt: skip


def test_a_right_pressure_agrees_and_a_wrong_one_does_not():
    found = compared()
    assert found.validation.agrees and "% of the fill pressure" in found.validation.verdict
    assert found.fill_pressure_rms < 0.01 * np.nanmax(found.predicted)
    stronger = compared(TRUTH.but(cord_load_scale=1.6))
    assert not stronger.validation.agrees
    assert stronger.fill_pressure_bias < 0 and "kPa" in stronger.validation.verdict
    assert "below the test" in stronger.validation.verdict


def test_the_pressure_finds_the_angle_and_says_nothing_of_the_rubber():
    steeper = TRUTH.but(wrap_angle=np.radians(64.5), rubber_modulus=250 * PSI)
    found = compared(steeper, calibrate=("rubber_modulus", "wrap_angle"))
    assert found.calibration.parameter == ("wrap_angle",)
    rubber, angle = found.fill_pressure_parameter_value
    assert np.isnan(rubber)
    assert angle == pytest.approx(np.radians(64.5), abs=np.radians(0.1))
    spread = found.fill_pressure_parameter_value_standard_uncertainty
    assert np.isnan(spread[0]) and 0 < spread[1] < np.radians(0.5)
    assert compared(steeper, calibrate=("rubber_modulus",)).calibration is None


def test_cords_that_never_press_calibrate_nothing():
    """A gauge that reads its own noise, over strains at which the cords are still slack."""
    reach = 0.3
    assert not TRUTH.pressure(np.linspace(0.0, reach, 51)).any()
    up = np.linspace(0.0, reach, 401)
    idle = measured_curve(
        np.tile(np.concatenate([up, up[::-1]]), 3), np.random.default_rng(5).normal(0, 1e3, 2406),
        loading="static", cycle_number=np.repeat([1, 2, 3], 802),
        branch=np.tile(np.repeat([1, 2], 401), 3), shared=pressure_errors(None, 2e3),
    )  # fmt: skip
    found = compared(pressure=idle, calibrate=("wrap_angle",))
    assert not found.calibration.identifiability.is_identified


def test_the_pressure_stands_on_the_strains_of_the_tension():
    archive = dataset()
    strain, pressure = archive["strain"].values[0], archive["measured_fill_pressure"].values
    there = np.isfinite(pressure[0])
    expected = TRUTH.pressure(strain[there])
    # a bin in which the cords pick up is rounded
    assert pressure[0, there] == pytest.approx(expected, abs=0.01 * expected.max())
    assert (
        np.isnan(pressure[1:]).all() and (archive["fill_pressure_verdict"].values[1:] == "").all()
    )


def record(rng):
    """A log of a hose as it was built, and what its gauge, load cell and marks are wrong by."""
    truth = Truth(
        wrap_angle=TRUTH.wrap_angle + UNCERTAIN["wrap_angle"] * rng.standard_normal(),
        cord_load_scale=1 + UNCERTAIN["cord_load_scale"] * rng.standard_normal(),
    )
    phase = np.linspace(0, 3, 1800, endpoint=False)
    strain = 0.9 * (1 - np.abs(2 * (phase % 1) - 1))
    pressure = truth.pressure(strain) + rng.normal(0, 2e3, strain.size)
    pressure += GAUGE * rng.standard_normal()
    return {
        "strain": strain * (1 + STRAIN_GAIN * rng.standard_normal()),
        "tension": truth.tension(strain) + rng.normal(0, 20, strain.size),
        "fill_pressure": pressure,
        "cycle_number": phase.astype(int) + 1,
        "branch": np.where(phase % 1 < 0.5, 1, 2),
    }  # fmt: skip


@pytest.mark.parametrize("n_draws", [4, pytest.param(200, marks=pytest.mark.nightly)])
def test_the_verdict_and_the_interval_hold_in_19_of_20_hoses(n_draws):
    # of three seeds the verdict holds in 93.0, 94.0 and 95.5 %, the interval in 93.5, 95.5 and 96.5 %
    rng = np.random.default_rng(11)
    hose = HosePlan("H", TRUTH.design(), standard_uncertainty=UNCERTAIN)
    hits = []
    for _ in range(n_draws):
        found = compare_record(
            hose, **record(rng), loading="static", fill_pressure_standard_uncertainty=GAUGE,
            shared=constant_errors(strain_gain=STRAIN_GAIN),
        ).pressure  # fmt: skip
        last = np.flatnonzero(np.isfinite(found.difference.difference))[-5]
        limit = 1.96 * found.validation.validation_uncertainty[last]
        hits.append((found.validation.agrees, abs(found.difference.difference[last]) <= limit))
    low, high = (0.93, 0.98) if n_draws == 200 else (binom.ppf(1e-3, n_draws, 0.95) / n_draws, 1)
    share = np.mean(hits, axis=0)
    assert np.all(share >= low) and np.all(share <= high), share

"""What the hysteresis of a load cell does to a loop and its branches."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import LoadTrain
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.effects_on_answers import load_train_notes
from reduction.uncertainty.errors_of_curves import _reversibility_on_branches
from reduction.uncertainty.propagation import LoopQuantities, loop_contributions

GAUGE = StrainModel("rope", "gauge-length", {"gauge_length": 1.0, "reference_position": 1.0})
PEAK, STROKE, LOSS = 1000.0, 0.01, 0.05  # [N], [1], [1]: tension from zero, strain amplitude


def indication(tension):
    """What a cell reads in whose elastic element small parts stick and slip (play operators)."""
    reach = np.linspace(0, PEAK, 200)
    held, read = np.zeros_like(reach), []
    for one in tension:
        held = np.clip(held, one - reach, one + reach)
        read.append(one + 0.01 * held.mean())
    return np.array(read)


def area(strain, tension):
    """Of a closed polygon."""
    return 0.5 * abs(strain @ np.roll(tension, -1) - tension @ np.roll(strain, -1))


def cycle():
    angle = np.linspace(0, 2 * np.pi, 4001)[:-1]
    strain = 0.02 - STROKE * np.cos(angle)
    tension = PEAK / 2 - PEAK / 2 * np.cos(angle + LOSS)
    return strain, tension


def test_the_energy_of_a_loop_changes_by_the_area_between_the_two_ways_of_the_cell():
    way = np.linspace(0, PEAK, 1001)
    # as a laboratory states it: after a preload, up to the peak and back, at half the load
    _, _, up, down = np.split(indication(np.tile(np.concatenate([way, way[::-1]]), 2)), 4)
    half = np.interp(PEAK / 2, way, up - down[::-1])
    errors = InstrumentErrors("rope", tension_reversibility=abs(half) / (PEAK / 2))
    assert 0.001 < errors.tension_reversibility < 0.01
    strain, tension = cycle()
    # its scale is that of rising load
    read = np.interp(indication(np.tile(tension, 2))[tension.size :], up, way)
    one = np.ones(1)
    loop = LoopQuantities(
        frequency=0.1 * one, mean_tension=PEAK / 2 * one, tension_amplitude=PEAK / 2 * one,
        mean_strain=0.02 * one, strain_amplitude=STROKE * one,
        apparent_spring_constant=PEAK / 2 / STROKE * one,
        hysteresis_energy=area(strain, tension) * one,
        storage_spring_constant=PEAK / 2 / STROKE * np.cos(LOSS) * one,
        loss_spring_constant=PEAK / 2 / STROKE * np.sin(LOSS) * one,
        closed_loop_energy=area(strain, tension) * one,
    )  # fmt: skip
    found = loop_contributions(errors, GAUGE, loop, waveform="sinusoidal")
    (place,) = [k for k, one in enumerate(found.component) if one.source == "tension_reversibility"]
    moved = {name: float(rows[place, 0]) for name, rows in found.values.items()}
    change = abs(area(strain, read) - area(strain, tension))
    assert moved["hysteresis_energy"] == pytest.approx(change, rel=0.01)
    assert moved["loss_spring_constant"] == pytest.approx(change / (np.pi * STROKE**2), rel=0.01)
    for name in ("tension_amplitude", "apparent_spring_constant", "mean_tension", "mean_strain"):
        assert moved[name] == 0.0


def test_only_the_falling_branch_is_off_and_its_modulus_by_the_slope_of_that_error():
    errors = InstrumentErrors("rope", tension_reversibility=0.002)
    strain = np.linspace(0.0, 1.0, 2001)
    tension = np.stack([200 + 800 * strain**1.5, 200 + 800 * strain**2])
    off, steeper = _reversibility_on_branches(errors, tension)
    assert not off[0].any() and not steeper[0].any()
    # half of the range of 800 N is 400 N, and .2 % of it .8 N
    assert np.abs(off[1]).max() == pytest.approx(0.8, rel=1e-4)
    slope = np.gradient(tension[1], strain)
    assert steeper[1] * slope == pytest.approx(np.gradient(off[1], strain), abs=0.02)


@pytest.mark.parametrize("stated", [0.0, 0.001])
def test_the_hysteresis_that_moves_the_energy_by_its_uncertainty_is_told_where_none_is_stated(
    stated,
):
    """By hand: tension half range 500 N, 0.01 of strain on 2 m, an energy known to 0.2 J/m.

    0.4 mm of play is 2e-4 of strain: times a range of 1,000 N, it is 0.2 J/m.
    """
    rope = StrainModel("rope", "gauge-length", {"gauge_length": 2.0, "reference_position": 2.0})
    one = np.ones(1)
    summary = SimpleNamespace(
        apparent_spring_constant=50_000.0 * one, frequency=0.1 * one, strain_amplitude=0.01 * one,
        tension_amplitude=500.0 * one, mean_strain=0.02 * one, mean_tension=500.0 * one,
        uncertainty={"apparent_spring_constant": 50.0 * one, "hysteresis_energy": 0.2 * one},
    )  # fmt: skip
    test = SimpleNamespace(
        amplitude=summary, cycles=None, contributions=None, strain_models=[rope],
        specimens=[SimpleNamespace(name="rope", linear_density=None, is_rope=False)],
        record=SimpleNamespace(load_train=LoadTrain("fixed", 0.0)),
    )  # fmt: skip
    errors = [InstrumentErrors("rope", tension_reversibility=stated)]
    codes = {one.code: one for one in load_train_notes(test, errors)}
    assert ("instrument-hysteresis-unknown" in codes) == (not stated)
    if not stated:
        assert codes["instrument-hysteresis-unknown"].numbers == pytest.approx(
            # 20.3 ms turn the phase at 0.1 Hz by 0.0127, times pi x 500 N x 0.01
            {"reversibility": 0.03, "play": 4e-4, "lag": 0.2 / (0.1 * 2 * np.pi**2 * 5)},
            rel=1e-6,
        )
        told = str(codes["instrument-hysteresis-unknown"])
        assert "or 20 ms between the two channels" in told
        (known,) = [
            one
            for one in load_train_notes(test, [InstrumentErrors("rope", lag=1e-3)])
            if one.code == "instrument-hysteresis-unknown"
        ]
        assert "ms between" not in str(known)

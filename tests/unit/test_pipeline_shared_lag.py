"""What a test says of a tension that was logged late, and that it corrects nothing."""

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.archive.test_variables import lag_values
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import Record, Specimen
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.reduced_test import TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.errors_of_cycles import _has_corners
from reduction.uncertainty.propagation import LoopQuantities, loop_contributions
from reduction.uncertainty.shared_contributions import lag_of_test

TIME = np.arange(0, 118, 0.1)
TURNS = np.arange(50, 1151, 50)


def ramps(time):
    return 1 - 2 * np.abs(np.mod(time / 10, 1) - 0.5)


def lag_of(lag, **stated):
    position = ramps(TIME)
    tension = np.stack([500 * ramps(TIME - one) for one in lag])
    noise = np.random.default_rng(4).normal(0, 0.3, tension.shape)
    record = Record(
        "T", ("new", "used")[: len(lag)], TIME, position, tension + noise,
        np.zeros(tension.shape, np.uint16), np.zeros(TIME.size, np.uint16), n_rows_read=TIME.size,
    )  # fmt: skip
    first = TURNS[:-2:2]
    halves = np.column_stack([first, first + 50]), np.column_stack([first + 50, first + 100])
    cycles = Cycles(
        first, first + 100, *halves, np.ones((first.size, 2)),
        np.zeros(TIME.size, np.int32), np.zeros(TIME.size, np.int8),
        np.zeros(TIME.size, bool), 0.01,
    )  # fmt: skip
    return lag_of_test(record, position, tension + noise, cycles, **stated)


def test_a_tension_that_is_late_is_noted_for_its_own_channel():
    estimate, notes = lag_of([0.02, 0.0])
    assert estimate.lag == pytest.approx([0.02, 0.0], abs=0.002)
    assert len(notes) == 1
    assert str(notes[0]).startswith("new: tension reverses 20 +- ")
    assert "no lag is stated" in str(notes[0]) and "No correction is made" in str(notes[0])


def test_a_lag_within_what_is_stated_is_no_news():
    _, notes = lag_of([0.02], stated=[0.015])
    assert notes == []
    _, notes = lag_of([0.05], stated=[0.015])
    assert "a lag of 0 +- 15 ms is stated" in str(notes[0])


def test_the_archive_has_the_estimate_and_why_there_is_none():
    estimate, _ = lag_of([0.02, -0.02])
    values = lag_values(estimate)
    assert values["channel_lag_refusal"].tolist() == [0, 4]
    assert np.isnan(values["channel_lag"][1])


def cycled(*, begin, time_constant):
    """A sine of a loss factor of 0.2 behind a filter, with its approach or from the middle of it.

    The damper is one of dT = E de + c de/dt, c = 0.2 E / omega.
    """
    frequency, amplitude = 0.2, 0.1
    fine = np.arange(0, 80, 0.002)
    omega = 2 * np.pi * frequency
    strain = np.where(
        fine < 8,
        0.4 * np.clip(fine - 2, 0, 2) / 2,
        0.5 - amplitude * np.cos(omega * (fine - 8)),
    )
    rng = np.random.default_rng(3)
    rate = np.gradient(strain, fine)
    rate[fine < 8] = 0  # that of a ramp would step
    decay = np.exp(-0.002 / time_constant) if time_constant else 0.0
    ideal = 1000 * (strain + 0.2 / omega * rate)
    tension = lfilter([1 - decay], [1, -decay], ideal + 3 * rng.normal(size=fine.size))
    at = np.arange(begin, 75, 0.01)
    position = np.interp(at, fine, strain) + 2e-5 * rng.normal(size=at.size)
    force = np.interp(at, fine, tension)[None]
    flags = np.zeros((1, at.size), np.uint16)
    record = Record("T", ("cord",), at - begin, position, force, flags, flags[0].copy())
    settings = ReductionSettings(cycles=CycleSettings(waveform="sinusoidal"))
    return reduce_test(
        locate(record, kind="cyclic", settings=settings),
        description=TestDescription("c", "T", "cyclic", "position", "sinusoidal", 1, {}),
        specimens=(Specimen("cord", kind="elastomer", diameter=(0.025,)),),
        models=(
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": 0.0}),
        ),
        history=None, sources=(), settings=settings, settings_json="{}",
    ), np.pi * amplitude**2 * 1000 * 0.2  # fmt: skip


@pytest.mark.parametrize(("begin", "says"), [(0.0, "tension stops"), (20.0, "low-pass filter")])
def test_a_filtered_load_of_a_sine_is_said_and_is_in_the_interval(begin, says):
    test, energy = cycled(begin=begin, time_constant=0.1)
    assert any(says in str(note) and note.severity == "warning" for note in test.notes)
    lost = energy - test.amplitude.hysteresis_energy[0]
    assert lost > 0.5 * energy
    shared = test.contributions.shared_standard_uncertainty("test_hysteresis_energy")[0]
    assert lost / 1.96 < shared < 1.7 * lost
    test, energy = cycled(begin=begin, time_constant=0.0)
    assert not any(says in str(note) for note in test.notes)
    assert test.amplitude.hysteresis_energy[0] == pytest.approx(energy, rel=0.01)


def test_a_filter_takes_its_share_of_an_amplitude():
    one = np.ones(1)
    lost = []
    for waveform in ("sinusoidal", "triangular"):
        found = loop_contributions(
            InstrumentErrors("cord", lag=0.1, smoothed_over=0.1),
            StrainModel("cord", "gauge-length", {"gauge_length": 1.0, "reference_position": 0.0}),
            LoopQuantities(
                frequency=0.2 * one, mean_tension=500 * one, tension_amplitude=100 * one,
                mean_strain=0.5 * one, strain_amplitude=0.1 * one,
                apparent_spring_constant=1000 * one, hysteresis_energy=one,
                storage_spring_constant=1000 * one, loss_spring_constant=30 * one,
                closed_loop_energy=one,
            ),
            waveform=waveform,
        )  # fmt: skip
        (at,) = [k for k, part in enumerate(found.component) if part.source == "lag"]
        lost.append(-found.values["apparent_spring_constant"][at, 0] / 1000 * np.sqrt(3))
    # of a sine by its transfer function; of a triangle by the greatest of a filtered one
    time = np.arange(0, 50, 1e-3)
    wave = 1 - 4 * np.abs(np.mod(0.2 * time, 1) - 0.5)
    behind = lfilter([1 - np.exp(-1e-2)], [1, -np.exp(-1e-2)], wave)[-10_000:]
    assert lost == pytest.approx([1 - 1 / np.hypot(1, 0.04 * np.pi), 1 - behind.max()], rel=0.01)


def test_a_late_tension_moves_what_is_read_at_corners_and_no_rounded_turn():
    phase = TIME / 10
    waves = {
        "rounded": 1 - 0.5 * np.cos(2 * np.pi * phase),
        # ramps that rest for a tenth of the time at both ends
        "corners": 0.5 + np.clip(1.25 * (1 - 2 * np.abs(np.mod(phase, 1) - 0.5)) - 0.125, 0, 1),
    }
    first = np.arange(0, 1000, 100)
    halves = np.column_stack([first, first + 50]), np.column_stack([first + 50, first + 100])
    none = np.zeros(TIME.size, np.int8)
    cycles = Cycles(first, first + 100, *halves, np.ones((10, 2)), none, none, none > 0, 0.01)
    line = StrainModel("rope", "gauge-length", {"reference_position": 0.0, "gauge_length": 1.0})
    known = {
        "frequency": 0.1, "mean_tension": 1e3, "tension_amplitude": 500.0, "mean_strain": 1.0,
        "strain_amplitude": 0.5, "apparent_spring_constant": 1e3, "hysteresis_energy": 1.0,
        "storage_spring_constant": 1e3, "loss_spring_constant": 1.0, "closed_loop_energy": 1.0,
    }  # fmt: skip
    moved = {}
    for name, wave in waves.items():
        record = Record(
            "T", ("rope",), TIME, wave, 1e3 * wave[None], np.zeros((1, TIME.size)), none
        )
        found = loop_contributions(
            InstrumentErrors("rope", lag=0.02), line,
            LoopQuantities(**{key: np.full(1, value) for key, value in known.items()}),
            waveform="other",
            has_corners=_has_corners(cycles, CycleSettings(waveform="other"), record),
        )  # fmt: skip
        moved[name] = float(found.values["apparent_spring_constant"][0, 0])
    # the approach to a corner goes on for the lag at the speed of straight ramps
    assert moved == pytest.approx({"rounded": 0.0, "corners": -4 * 0.1 * 0.02 * 1e3})

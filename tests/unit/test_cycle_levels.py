"""Levels of a record are found where there are some, and nothing else is cut."""

from itertools import pairwise

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.record.settings import CycleSettings
from reduction.stages.cycles.levels import are_unlike, find_levels, spread_of_cycles

PER = 40  # samples a cycle

STEP = 0.05  # [s]


def wave(mean, amplitude, n_cycles, *, per=PER):
    """Cycles from valley to valley; mean and amplitude are numbers or one value a cycle."""
    phase = np.arange(n_cycles * per) / per
    of_cycle = phase.astype(int)
    middle = np.broadcast_to(mean, n_cycles)[of_cycle]
    half = np.broadcast_to(amplitude, n_cycles)[of_cycle]
    return middle - half * np.cos(2 * np.pi * phase)


def ramp(start, stop, n=60):
    return np.linspace(start, stop, n, endpoint=False)


def levels_of(*pieces, noise=0.02, seed=1):
    control = np.concatenate(pieces)
    control = control + noise * np.random.default_rng(seed).standard_normal(control.size)
    time = STEP * np.arange(control.size)
    settings = CycleSettings(control="load", waveform="sinusoidal")
    cycles = cycles_of_log(time, control / 10, control[None], settings=settings)
    return time, cycles, find_levels(time, control, cycles, waveform="sinusoidal")


def test_levels_of_unequal_length_are_found_from_the_first_cycle_to_the_last():
    pieces = [
        ramp(0, 8),
        wave(10, 2, 50),
        ramp(8, 18),
        wave(20, 2, 7),
        ramp(18, 28),
        wave(30, 2, 25),
    ]
    *_, levels = levels_of(*pieces, ramp(28, 0))
    starts = STEP * np.cumsum([one.size for one in pieces])[::2]
    assert [round(one.mean) for one in levels] == [10, 20, 30]
    assert [one.amplitude for one in levels] == pytest.approx([2, 2, 2], rel=0.03)
    assert [one.frequency for one in levels] == pytest.approx([1 / (PER * STEP)] * 3, rel=0.01)
    for one, start, count in zip(levels, starts, (50, 7, 25), strict=True):
        # to a quarter of a cycle, ramp and cycle are one rise; the last fall may go on in a ramp
        assert one.start == pytest.approx(start, abs=PER * STEP / 4)
        assert one.stop == pytest.approx(start + PER * STEP * count, abs=1.25 * PER * STEP)


def test_levels_that_fall_are_found():
    *_, levels = levels_of(
        ramp(0, 28), wave(30, 2, 12), ramp(28, 18), wave(20, 2, 40), ramp(18, 8), wave(10, 2, 9)
    )
    assert [round(one.mean) for one in levels] == [30, 20, 10]


@pytest.mark.parametrize(
    ("second", "what"),
    [
        ({"amplitude": 3.0}, "amplitude"),
        ({"per": 20}, "frequency"),
    ],
)
def test_a_step_of_amplitude_or_frequency_is_a_level(second, what):
    changed = {"mean": 10.0, "amplitude": 2.0, "n_cycles": 20} | second
    *_, levels = levels_of(ramp(0, 8), wave(10, 2, 20), wave(**changed))
    first, last = (getattr(one, what) for one in levels)
    assert last / first == pytest.approx(1.5 if what == "amplitude" else 2.0, rel=0.03)


@pytest.mark.parametrize(
    "cycles",
    [
        wave(10, 2, 100),
        wave(10, np.linspace(1, 4, 100), 100),  # slow ramp of the amplitude
        wave(10, np.linspace(1, 4, 12), 12),  # fast ramp
        wave(10, np.geomspace(0.5, 4, 40), 40),  # 5.5 % a cycle
        wave(np.linspace(10, 20, 60), 2, 60),  # ramp of the mean
        wave(10 + 0.6 * np.log10(np.arange(1, 101)), 2, 100),  # creep of the controlled channel
        wave(10, np.where(np.arange(60) == 30, 3.0, 2.0), 60),  # one cycle that differs
        wave(10, np.where(np.arange(60) < 2, 1.2, 2.0), 60),  # two cycles to get there
        wave(10, 2 * np.random.default_rng(3).uniform(0.8, 1.2, 60), 60),  # no two alike
    ],
    ids=["one", "slow", "fast", "middling", "mean", "creep", "odd", "begin", "scatter"],
)
def test_what_is_no_step_is_not_cut(cycles):
    *_, levels = levels_of(ramp(0, cycles[0]), cycles, ramp(cycles[-1], 0))
    assert levels == ()


def test_a_spectrum_is_not_cut():
    blocks = [wave(10 + 4 * (place % 2), 2, 5) for place in range(30)]
    *_, levels = levels_of(ramp(0, 8), *blocks)
    assert levels == ()


def test_a_programme_of_growing_cycles_is_no_level_beside_its_steady_beginning():
    # synthetic, after seismic programmes: a greater cycle, then some of three quarters of it, ...;
    # its later parts have too few cycles for levels of their own, and are unlike as one
    turns = [0.0]
    for peak, n_cycles in zip([1, 1.5, 2.2, 2.7, 3.2, 4.0], [4, 4, 4, 2, 2, 2], strict=True):
        turns += [peak, -1.1 * peak, *([0.78 * peak, -0.86 * peak] * n_cycles)]
    share = (1 - np.cos(np.pi * np.arange(PER // 2) / (PER // 2))) / 2
    strokes = [one + (other - one) * share for one, other in pairwise(turns)]
    *_, levels = levels_of(*strokes, noise=0.002)
    assert levels == ()


@pytest.mark.parametrize(("other", "unlike"), [(PER, False), (int(0.8 * PER), False), (10, True)])
def test_cycles_of_two_periods_are_unlike(other, unlike):
    control = np.concatenate([wave(10, 2, 20), wave(10, 2, 20, per=other)])
    time, cycles, _ = levels_of(control)
    mean, ratio, of_periods = spread = spread_of_cycles(time, control, cycles)
    assert (mean, ratio) == pytest.approx((0, 1), abs=0.05)
    assert of_periods == pytest.approx(PER / other, rel=0.1)
    assert are_unlike(*spread) == unlike


@pytest.mark.parametrize("seed", range(3))
def test_a_dwell_in_which_noise_places_the_turn_is_no_other_period(seed):
    pulse = np.concatenate([1 - np.cos(2 * np.pi * np.arange(25) / 25), np.zeros(25)])
    pieces = [np.append(ramp(0, 8), np.tile(8 + half * pulse, 15)) for half in (1, 2, 3)]
    *_, levels = levels_of(*pieces, noise=0.002, seed=seed)
    assert [round(one.amplitude, 1) for one in levels] == [1, 2, 3]
    control = np.concatenate([ramp(0, 8), np.tile(8 + pulse, 20)])
    control += 0.002 * np.random.default_rng(seed).standard_normal(control.size)
    time, cycles, _ = levels_of(control, noise=0.0)
    *_, of_periods = spread_of_cycles(time, control, cycles)
    # from turn to turn, 90 % of the periods differ by a factor of 1.6
    assert of_periods == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize("rate", [0.6, 1.0, 2.0])
def test_a_level_of_sines_does_not_begin_on_the_ramp_to_their_mean(rate):
    # the ramp goes on as a sine from its mean: about half a stroke of the first rise is no sine
    n_ramp = int(10 / (rate * 2 * np.pi * 2 / PER))
    begin = wave(10, 2, 30)[PER // 4 :]
    control = [ramp(0, 10, n_ramp), begin, ramp(10, 20), wave(20, 2, 30)[PER // 4 :]]
    *_, levels = levels_of(*control, noise=0.002)
    valley = STEP * (n_ramp + PER * 0.75)
    assert levels[0].start == pytest.approx(valley, abs=2 * STEP)

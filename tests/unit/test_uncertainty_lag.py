"""Lag of synthetic logs with a known lag and known damping, by the turns of their wave."""

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.quantities.flags import LAG_REFUSALS
from reduction.stages import channel_lag as lag_module
from reduction.stages.channel_lag import (
    delay_by_noise,
    delay_of_extensometer,
    lag_at_stops,
    lag_by_turns,
)

FINE, HALF, LAST = 0.002, 5.0, 118.0
TURNS = np.arange(HALF, LAST, HALF)
# G(t) = 1 + sum g exp(-t / tau); the last has a loss angle of 0.1 from 1 ms to 1,000 s
MATERIALS = {
    "elastic": ((), ()),
    "relaxes in 2 s": ((0.3,), (2.0,)),
    "relaxes in 20 s": ((0.5,), (20.0,)),
    "loss at all rates": ((0.06,) * 24, tuple(np.logspace(-3, 3, 24))),
}


def ramps(time):
    return 1 - 2 * np.abs(np.mod(time / (2 * HALF), 1) - 0.5)


def log(material, *, lag=0.0, rate=10.0, noise=0.0, seed=0):
    """Time, position and tension of a material with memory, by the recursion that is exact."""
    time = np.arange(0, 120, FINE)
    strain = ramps(time)
    tension = strain.copy()
    for strength, tau in zip(*MATERIALS[material], strict=True):
        decay = np.exp(-FINE / tau)
        gain = strength * tau * (1 - decay) / FINE
        tension[1:] += lfilter([gain], [1, -decay], np.diff(strain))
    at = np.arange(0.5, LAST, 1 / rate) + 0.013
    rng = np.random.default_rng(seed)
    position, force = np.interp(at, time, strain), 500 * np.interp(at - lag, time, tension)
    position = position + noise * rng.normal(size=at.size)
    return at, position, force + 500 * noise * rng.normal(size=at.size)


def estimate(time, position, *tensions):
    return lag_by_turns(time, position, tensions, np.searchsorted(time, TURNS))


@pytest.mark.parametrize("rate", [10.0, 100.0])
@pytest.mark.parametrize("lag", [0.0, 0.02, 0.15])
def test_the_lag_of_an_elastic_line_comes_back(lag, rate):
    found = estimate(*log("elastic", lag=lag, rate=rate))
    assert found.lag == pytest.approx([lag], abs=1e-3 / rate + 2e-4)
    assert found.refusal.tolist() == [0]


@pytest.mark.parametrize("material", ["relaxes in 2 s", "relaxes in 20 s", "loss at all rates"])
@pytest.mark.parametrize("lag", [0.03, 0.1])
def test_damping_is_not_taken_for_lag(material, lag):
    found = estimate(*log(material, lag=lag))
    assert abs(found.lag[0] - lag) < 2 * found.standard_uncertainty[0] + 2e-4
    # never more than there is
    assert found.lag[0] < lag + 1e-3


@pytest.mark.parametrize("lag", [0.0, 0.15])
def test_friction_behind_a_rounded_turn_is_not_taken_for_lag(lag):
    ramp, rounded, step = 2.5, 0.3, 0.025
    time = np.arange(0, 80, step)

    def friction(path):
        return path + 2 * (1 - np.exp(-path / 0.5))

    def tension(at):
        """Of the path since the last turn alone: without memory of time, so without a delay."""
        is_up = np.mod(at, 2 * ramp) < ramp
        gone = place(at)
        low, high = rounded / 2, ramp - rounded / 2
        return np.where(is_up, friction(gone - low), friction(high - low) - friction(high - gone))

    def place(at):
        x = ramp - np.abs(np.mod(at, 2 * ramp) - ramp)
        bottom, top = (x**2 + rounded**2) / (2 * rounded), ramp - x
        round_top = ramp - (top**2 + rounded**2) / (2 * rounded)
        return np.where(x < rounded, bottom, np.where(top < rounded, round_top, x))

    turns = np.rint(np.arange(ramp, 80, ramp) / step).astype(int)
    found = lag_by_turns(time, place(time), [tension(time - lag)], turns)
    assert abs(found.lag[0] - lag) < 2 * found.standard_uncertainty[0]


@pytest.mark.parametrize("material", MATERIALS)
def test_a_lag_in_noise_is_held_by_its_uncertainty(material):
    lag = 0.04
    found = [estimate(*log(material, lag=lag, noise=2e-3, seed=seed)) for seed in range(25)]
    error = np.array([one.lag[0] - lag for one in found])
    u = np.array([one.standard_uncertainty[0] for one in found])
    # two standard uncertainties hold 95 % or more: 21 of 25 is the 0.5 % quantile of that
    assert np.sum(np.abs(error) < 2 * u) >= 21
    assert np.median(u) < 0.5 * lag


def test_fast_damping_alone_is_refused_and_not_called_a_lead():
    """A dashpot in parallel moves the ramps by eta / K, as a lead would."""
    time = np.arange(0.013, LAST, 0.1)
    found = estimate(time, ramps(time), 500 * ramps(time + 0.02))
    assert np.isnan(found.lag).all()
    assert found.refusal.tolist() == [LAG_REFUSALS["early_as_damping_makes_it"]]


def test_a_sine_does_not_tell_damping_from_lag():
    time = np.arange(0, LAST, 0.1)
    place = -np.cos(np.pi * time / HALF)
    force = -np.cos(np.pi * (time - 0.02) / HALF + 0.05)
    found = estimate(time, place, force)
    assert found.refusal.tolist() == [LAG_REFUSALS["turns_not_sharp"]]
    assert np.isnan(found.standard_uncertainty).all()


def test_a_wave_that_rests_at_its_ends_is_refused():
    time = np.arange(0, LAST, 0.1)
    rests = np.clip(1.3 * (2 * ramps(time) - 1), -1, 1)
    found = estimate(time, rests, 500 * rests)
    assert found.refusal.tolist() == [LAG_REFUSALS["turns_not_sharp"]]


def test_channels_are_told_apart():
    time, place, early = log("elastic", lag=0.01)
    late = log("elastic", lag=0.05)[2]
    found = estimate(time, place, early, late)
    assert found.lag == pytest.approx([0.01, 0.05], abs=5e-4)


def test_samples_that_are_missing_take_their_turn_with_them():
    time, place, force = log("elastic", lag=0.03)
    force[240:260] = np.nan
    found = estimate(time, place, force)
    assert found.lag == pytest.approx([0.03], abs=5e-4)
    assert found.n_turns[0] < estimate(time, place, place).n_turns[0]


@pytest.mark.parametrize("block", [7, 100, 500])
def test_turns_are_read_in_blocks_of_any_length(monkeypatch, block):
    time, position, tension = log("loss at all rates", lag=0.03, rate=40.0, noise=1e-4)
    tension[1234] = np.nan
    whole = estimate(time, position, tension)
    monkeypatch.setattr(lag_module, "BLOCK", block)
    found = estimate(time, position, tension)
    assert found.n_turns == whole.n_turns
    assert found.lag == pytest.approx(whole.lag, rel=1e-9)
    assert found.standard_uncertainty == pytest.approx(whole.standard_uncertainty, rel=1e-9)


def test_few_turns_and_few_samples_are_refused():
    time, place, force = log("elastic")
    few = lag_by_turns(time, place, [force], [50, 100, 150])
    assert few.refusal.tolist() == [LAG_REFUSALS["few_turns"]]
    coarse = lag_by_turns(time[::4], place[::4], [force[::4]], np.searchsorted(time[::4], TURNS))
    assert coarse.refusal.tolist() == [LAG_REFUSALS["few_samples_a_ramp"]]
    force[::90] = np.nan
    gone = lag_by_turns(time, place, [force, force], np.searchsorted(time, TURNS))
    assert gone.refusal.tolist() == [LAG_REFUSALS["few_turns"]] * 2


def test_a_turn_beside_a_gap_of_days_is_left_out():
    time, position, force = log("elastic", lag=0.02)
    turns = np.searchsorted(time, TURNS)
    # on one side of it all samples are one instant beside the length of the window
    time = time + np.where(np.arange(time.size) > turns[8] + 3, 1e6, 0.0)
    found = lag_by_turns(time, position, [force], turns)
    whole = estimate(*log("elastic", lag=0.02))
    assert found.lag == pytest.approx(whole.lag, abs=5e-4)
    assert found.n_turns[0] < whole.n_turns[0]


def stretch_with_extensometer(*, late=0.0, strop=0.0, shape="sine", lost=0, seed=3):
    """A viscous specimen, and what else is stretched between the pins; one is truly late."""
    time = np.arange(0, 120, 0.02)

    def wave(at):
        phase = 0.4 * at % 1
        return np.sin(2 * np.pi * phase) if shape == "sine" else 1 - 4 * np.abs(phase - 0.5)

    noise = np.random.default_rng(seed).normal(0, 1, (3, time.size))
    strain = 0.5 + 0.2 * wave(time - late) + 1e-4 * noise[0]
    before = 0.5 + 0.2 * wave(time)
    tension = 100 * before + 40 * before**2 + 140 * 0.02 * np.gradient(before, time)
    position = before + strop * tension / 140 + 1e-4 * noise[1]
    strain[100 : 100 + lost] = 0.0
    return delay_of_extensometer(
        time, position, strain, tension + 0.2 * noise[2], np.ones(time.size)
    )


@pytest.mark.parametrize("shape", ["sine", "ramps"])
def test_a_camera_that_is_late_is_told_from_damping(shape):
    assert stretch_with_extensometer(late=0.03, shape=shape) == pytest.approx(0.03, rel=0.1)
    assert stretch_with_extensometer(late=0.03, shape=shape, lost=11) == pytest.approx(
        0.03, rel=0.1
    )


@pytest.mark.parametrize("shape", ["sine", "ramps"])
@pytest.mark.parametrize("strop", [0.0, 0.3])
def test_a_strop_in_series_makes_no_extensometer_late(strop, shape):
    assert stretch_with_extensometer(strop=strop, shape=shape) == 0.0


def stop(material, *, time_constant=0.0, poles=1, noise=0.0):
    """A ramp of 4 s that stops under tension, the latter behind a low-pass filter."""
    fine = np.arange(0, 9, FINE)
    strain = np.clip(fine - 1, 0, 4)
    tension = strain.copy()
    for strength, tau in zip(*MATERIALS[material], strict=True):
        decay = np.exp(-FINE / tau)
        tension[1:] += lfilter([strength * tau * (1 - decay) / FINE], [1, -decay], np.diff(strain))
    for _ in range(poles if time_constant else 0):
        decay = np.exp(-FINE / time_constant)
        tension = lfilter([1 - decay], [1, -decay], tension)
    rng = np.random.default_rng(6)
    at = slice(None, None, 10)
    scatter = noise * rng.normal(size=(2, fine[at].size))
    return fine[at], strain[at] + scatter[0], 500 * (tension[at] + scatter[1])


@pytest.mark.parametrize("material", list(MATERIALS))
def test_where_a_crosshead_stops_damping_is_not_taken_for_lag(material):
    time, position, tension = stop(material, noise=1e-3)
    found = lag_at_stops(time, position, [tension], [250], [50])
    assert not found.lag[0] > 2 * found.standard_uncertainty[0]


@pytest.mark.parametrize(("time_constant", "poles"), [(0.1, 1), (0.0159, 2)])
def test_a_filter_stops_later_than_the_crosshead_by_up_to_its_delay(time_constant, poles):
    time, position, tension = stop("elastic", time_constant=time_constant, poles=poles, noise=1e-3)
    found = lag_at_stops(time, position, [tension], [250], [50])
    lag, spread, delay = found.lag[0], found.standard_uncertainty[0], poles * time_constant
    assert lag > 2 * spread and 0.5 * delay < lag < delay + 2 * spread
    assert delay < lag + 2.5 * spread


def test_noise_of_both_channels_that_is_alike_is_vibration_and_no_filter():
    white = np.random.default_rng(2).normal(size=(2, 20_000))
    behind = lfilter([1], [1, -np.exp(-1 / 4)], white)
    assert delay_by_noise(white[0], behind[1], samples_per_cycle=400) == pytest.approx(4, rel=0.4)
    assert delay_by_noise(behind[0], behind[1], samples_per_cycle=400) == 0
    assert delay_by_noise(white[0], behind[1], samples_per_cycle=40) == 0
    coarse = np.round(behind[1] / 20) * 20
    assert delay_by_noise(white[0], coarse, samples_per_cycle=400) == 0
    # readings that alternate are no noise: every second one is alike
    assert delay_by_noise(white[0], (-1.0) ** np.arange(white[0].size), samples_per_cycle=400) == 0


@pytest.mark.parametrize(
    ("readings", "low", "high"), [(3, 1, 1), (5, 2, 2), (10, 4, 5), (50, 9, 25)]
)
def test_a_moving_mean_of_the_load_alone_shows_by_its_noise(readings, low, high):
    """Of five readings 20 samples were found, or none; of fifty readings the delay is a lower bound."""
    found = []
    for seed in range(12):
        white = np.random.default_rng(seed).normal(size=(2, 6000))
        mean = np.convolve(white[1], np.ones(readings) / readings, "same")
        found.append(delay_by_noise(white[0], mean, samples_per_cycle=500))
    assert low <= np.median(found) <= high

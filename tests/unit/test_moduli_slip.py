"""The level of a cycle, and slips told from creep."""

from types import SimpleNamespace

import numpy as np
import pytest
from located_cycles import cycles_of_log
from refusals import refusals
from scipy.signal import lfilter

from reduction.pipeline.located_test import slips_of
from reduction.record.errors import DataError
from reduction.record.settings import ReductionSettings, SlipSettings
from reduction.stages.cycles.reading_noise import noise_and_step, reading_noise
from reduction.stages.moduli import splice_slip
from reduction.stages.moduli import splice_slip as stepscan
from reduction.stages.moduli.loop_balance import cycle_tension_level
from reduction.stages.moduli.splice_slip import (
    _fit_kinks,
    _fit_ramps,
    _ramp_of,
    _SlipStep,
    _step_sizes,
    _strongest_response,
    _without_parabola,
    find_slips,
    find_steps,
    sample_noise,
)

SLOPE = 200.0  # N/m


def sampled_log(n_cycles, samples_per_cycle, slip, *, noise=0.0, phase=0.0):
    """Triangular cycles between 6 m and 9 m of a stiffening specimen with hysteresis."""
    n_samples = int(n_cycles * samples_per_cycle)
    turn = np.arange(n_samples) / samples_per_cycle + phase
    number = np.floor(turn).astype(int) + 1
    part = turn % 1
    position = 6 + 3 * (1 - np.abs(1 - 2 * part))
    branch = np.where(part < 0.5, 1, 2)
    stretch = position - slip[np.minimum(number, n_cycles) - 1] - 5
    tension = 60 * stretch + 10 * stretch**2 + 15 * (branch == 1)
    tension = tension + noise * np.random.default_rng(0).standard_normal(n_samples)
    return position, tension, np.where(number > n_cycles, 0, number), branch


@pytest.mark.parametrize("samples_per_cycle", [19.3, 20.0, 400.0])
def test_the_level_does_not_depend_on_where_the_samples_fall(samples_per_cycle):
    slip = np.zeros(200)
    position, tension, number, branch = sampled_log(200, samples_per_cycle, slip)
    level, slope = cycle_tension_level(
        position, tension[None], cycle_number=number, branch=branch, n_cycles=200
    )
    peak = np.array([tension[number == cycle].max() for cycle in range(1, 201)])
    # The slope of the law at 9 m is 60 + 20 * 4.
    assert slope[0] == pytest.approx(140, rel=0.05)
    assert np.ptp(level) < 0.6
    if samples_per_cycle == 19.3:
        assert np.ptp(peak) > 5


def test_a_slip_lowers_the_level_by_slope_times_length():
    slip = np.where(np.arange(200) >= 100, 0.02, 0.0)
    position, tension, number, branch = sampled_log(200, 50, slip)
    level, slope = cycle_tension_level(
        position, tension[None], cycle_number=number, branch=branch, n_cycles=200
    )
    step = level[0, 100:].mean() - level[0, :100].mean()
    assert -step / slope[0] == pytest.approx(0.02, rel=0.02)


def test_a_cycle_without_samples_has_no_level():
    position, tension, number, branch = sampled_log(60, 40, np.zeros(60))
    tension = np.where(number == 7, np.nan, tension)
    level, _ = cycle_tension_level(
        position, tension[None], cycle_number=number, branch=branch, n_cycles=60
    )
    assert np.flatnonzero(np.isnan(level[0])).tolist() == [6]


def test_a_dead_channel_beside_a_sound_one_has_no_level():
    position, tension, number, branch = sampled_log(60, 40, np.zeros(60))
    loads = np.stack([tension, np.full(tension.size, np.nan)])
    level, slope = cycle_tension_level(
        position, loads, cycle_number=number, branch=branch, n_cycles=60
    )
    assert np.isfinite(level[0]).all() and np.isfinite(slope[0])
    assert np.isnan(level[1]).all() and np.isnan(slope[1])


def peaks(steps, n_cycles=600, noise=1.0, seed=0):
    rng = np.random.default_rng(seed)
    count = np.arange(1.0, n_cycles + 1)
    series = 700 - 4 * np.log(count) - 30 * np.exp(-count / 15)
    for cycle, size in steps:
        series = series + size * (count >= cycle)
    return series + noise * rng.standard_normal(n_cycles)


def test_slips_are_listed_by_specimen_and_creep_is_not():
    series = [peaks([(201, -9.0), (401, -6.0)]), peaks([], seed=1)]
    slips = find_slips(
        series, specimens=("new", "used"), settings=SlipSettings(), tension_slope=[SLOPE, SLOPE]
    )
    assert slips.specimen == ("new", "new")
    np.testing.assert_allclose(slips.slip_cycle, [201, 401], atol=2)
    assert np.all(slips.slip_cycle_low <= slips.slip_cycle)
    assert np.all(slips.slip_cycle <= slips.slip_cycle_high)
    np.testing.assert_allclose(slips.slip_tension_step, [-9, -6], atol=0.8)
    np.testing.assert_allclose(slips.slip_length, [9 / SLOPE, 6 / SLOPE], atol=0.8 / SLOPE)
    np.testing.assert_allclose(
        slips.slip_length_standard_uncertainty * SLOPE,
        slips.slip_tension_step_standard_uncertainty,
    )
    # d(-4 ln c)/dc over cycles 301 to 600, mean slope by least squares about 450.
    np.testing.assert_allclose(slips.creep_per_cycle, -4 / 450, atol=0.004)


def test_creep_is_that_of_the_last_half():
    count = np.arange(1.0, 601)
    series = 700 - 30 * np.exp(-count / 15) - 0.01 * count
    series += 1e-3 * np.random.default_rng(3).standard_normal(600)
    slips = find_slips([series], specimens=("new",), settings=SlipSettings())
    assert slips.creep_per_cycle == pytest.approx([-0.01], abs=1e-5)


def test_without_a_slope_the_length_is_not_given():
    slips = find_slips([peaks([(201, -9.0)])], specimens=("new",), settings=SlipSettings())
    assert np.isnan(slips.slip_length).all()


def test_a_step_up_is_named_for_what_it_cannot_be():
    slips = find_slips([peaks([(201, 9.0)])], specimens=("new",), settings=SlipSettings())
    assert slips.slip_tension_step[0] > 0
    assert "A splice cannot do this" in str(slips.notes[0])


def test_two_specimens_stepping_together_point_to_the_machine():
    series = [peaks([(201, -9.0)]), peaks([(201, -9.0)], seed=1)]
    slips = find_slips(series, specimens=("new", "used"), settings=SlipSettings())
    assert any("check the crosshead before the splices" in note for note in map(str, slips.notes))


def test_relaxation_in_a_pause_is_no_slip_and_a_slip_in_it_is_one():
    # three blocks of 30 cycles of 10 s, half an hour apart; tension falls by 40 N a decade of time
    time = 10.0 * np.arange(90) + 1800.0 * (np.arange(90) // 30)
    for seed in range(20):
        noise = np.random.default_rng(seed).standard_normal(90)
        relaxed = 7000 - 40 * np.log10(1 + time + 10) + noise
        for slip, found in ((0.0, []), (500.0, [31])):
            slips = find_slips(
                [relaxed - slip * (np.arange(90) >= 30)], specimens=("new",),
                settings=SlipSettings(), time=time,
            )  # fmt: skip
            assert slips.slip_cycle.tolist() == found


def test_relaxation_in_cycles_that_the_machine_did_not_store_is_no_slip():
    """Three blocks of 30 cycles; the rows have no time, and tension falls by 40 N a decade."""
    number = np.repeat(np.array([0, 1000, 100_000])[:, None] + np.arange(1, 31), 24)
    phase = number + np.tile(np.arange(24) / 24, 90)
    position = 2 - 0.2 * np.cos(2 * np.pi * phase)
    tension = 5000 * (position - 1) - 40 * np.log10(1 + phase)
    tension += np.random.default_rng(0).normal(0, 1.0, tension.size)
    time = 0.1 * np.arange(phase.size)
    cycles = cycles_of_log(time, position, [tension], cycle_counter=number)
    located = SimpleNamespace(
        cycles=cycles, position=position, tension=tension[None], parted=(-1,),
        record=SimpleNamespace(specimens=("new",), time=time),
    )  # fmt: skip
    assert slips_of(located, ReductionSettings()).slip_cycle.size == 0
    tension[number > 1000] -= 5000
    assert slips_of(located, ReductionSettings()).slip_cycle.size == 1


def test_too_few_cycles_are_a_line_of_the_history():
    slips = find_slips([peaks([], 30)], specimens=("new",), settings=SlipSettings())
    assert slips.specimen == ()
    assert slips.notes == ()
    assert slips.made == ("not looked for: 30 cycles; 50 or more are needed",)
    assert np.isnan(slips.creep_per_cycle).all()


def test_missing_cycles_are_bridged_until_they_are_too_many():
    some, most = peaks([(301, -9.0)]), peaks([])
    some[[40, 41, 350]] = np.nan
    most[:400] = np.nan
    slips = find_slips([some, most], specimens=("new", "used"), settings=SlipSettings())
    assert slips.slip_cycle == pytest.approx(301, abs=2)
    assert tuple(map(str, slips.notes)) == (
        "used: no search for slip: 400 of 600 cycles are missing",
    )


# steps are found, dated, and not invented

NOISE = 0.3


def background(rng, n_samples):
    """Creep, drift and softening of random size."""
    count = np.arange(1.0, n_samples + 1)
    return (
        rng.uniform(-3, 3) * np.log(count)
        - rng.uniform(0, 10) * np.exp(-(count - 1) / rng.uniform(2, 40))
        + rng.uniform(-0.002, 0.002) * count
    )


def white(rng, n_samples):
    return rng.standard_normal(n_samples)


def heavy_tailed(rng, n_samples):
    return rng.standard_t(4, n_samples)


def correlated(rng, n_samples):
    return lfilter([1], [1, -0.5], rng.standard_normal(n_samples))


@pytest.mark.parametrize(
    "noise",
    [
        white,
        pytest.param(heavy_tailed, marks=pytest.mark.nightly),
        pytest.param(correlated, marks=pytest.mark.nightly),
    ],
)
def test_a_series_without_steps_shows_none_more_often_than_stated(noise):
    rng = np.random.default_rng(11)
    alarms = sum(
        bool(find_steps(background(rng, 120) + NOISE * noise(rng, 120), false_alarm=0.01))
        for _ in range(300)
    )
    # 300 series at 1 % give 3 on average; 9 or more have a chance below 0.4 %.
    assert alarms < 9


@pytest.mark.parametrize("quantum", [0.5, 1.0, 3.0])
def test_a_rounded_drift_is_not_a_row_of_steps(quantum):
    rng = np.random.default_rng(3)
    for _ in range(5):
        series = background(rng, 400) + NOISE * white(rng, 400)
        assert find_steps(np.round(series / quantum) * quantum, false_alarm=1e-3) == ()


@pytest.mark.parametrize("decay", [2.0, 6.0, 20.0, 60.0])
def test_softening_of_the_first_cycles_is_not_a_step(decay):
    rng = np.random.default_rng(4)
    count = np.arange(800.0)
    series = 40 * np.exp(-count / decay) - 25 * np.exp(-count / 1.5) - 2 * np.log1p(count)
    assert find_steps(series + 0.1 * white(rng, 800), false_alarm=1e-3) == ()


@pytest.mark.parametrize("power", [-0.3, 0.3, 0.5])
def test_creep_by_a_power_law_is_not_a_step(power):
    rng = np.random.default_rng(5)
    series = 20 * np.arange(1.0, 1201.0) ** power
    assert find_steps(series + 0.1 * white(rng, 1200), false_alarm=1e-3) == ()


def test_a_change_of_slope_is_not_a_step():
    rng = np.random.default_rng(6)
    count = np.arange(1000.0)
    series = -0.02 * np.maximum(0, count - 500)
    assert find_steps(series + 0.05 * white(rng, 1000), false_alarm=1e-3) == ()


@pytest.mark.parametrize("extent", [1, 5, 20])
@pytest.mark.parametrize("size", [-1.5, 1.5])
def test_a_step_is_dated_and_sized(extent, size):
    rng = np.random.default_rng(7)
    for onset in (100, 333, 500):
        series = background(rng, 600) + size * _ramp_of(600, onset=onset, extent=extent)
        steps = find_steps(series + NOISE * white(rng, 600), false_alarm=1e-3)
        assert len(steps) == 1
        assert abs(steps[0].onset - onset) <= max(3, extent // 2)
        assert abs(steps[0].size - size) < 5 * steps[0].size_standard_uncertainty
        assert steps[0].onset_low <= steps[0].onset <= steps[0].onset_high
        assert steps[0].end <= steps[0].end_high


@pytest.mark.nightly
def test_the_stated_range_of_an_onset_holds_it_nineteen_times_of_twenty():
    rng = np.random.default_rng(15)
    step = -0.7 * _ramp_of(300, onset=150, extent=1)
    found = [find_steps(step + NOISE * white(rng, 300), false_alarm=1e-3) for _ in range(120)]
    ranges = np.array([(one[0].onset_low, one[0].onset_high) for one in found if len(one) == 1])
    assert len(ranges) > 50
    holds = (ranges[:, 0] <= 150) & (ranges[:, 1] >= 150)
    assert 0.9 <= holds.mean() <= 1


def test_several_steps_come_in_order():
    rng = np.random.default_rng(8)
    onsets = [120, 260, 700]
    series = background(rng, 1000) + NOISE * white(rng, 1000)
    for onset in onsets:
        series = series - 2 * _ramp_of(1000, onset=onset, extent=4)
    found = [step.onset for step in find_steps(series, false_alarm=1e-3)]
    np.testing.assert_allclose(found, onsets, atol=4)


def test_the_recovery_after_a_step_is_not_a_step():
    rng = np.random.default_rng(9)
    count = np.arange(600.0)
    lag = np.clip(count - 300, 0, None)
    series = -3 * (count >= 300) + 1.2 * (1 - np.exp(-lag / 12)) * (count >= 300)
    steps = find_steps(series + 0.1 * white(rng, 600), false_alarm=1e-3)
    assert [step.size < 0 for step in steps] == [True]


@pytest.mark.parametrize(("back", "found"), [(1.2, [-1]), (2.0, [-1, 1])])
def test_a_change_back_by_more_than_half_is_a_step_of_its_own(back, found):
    rng = np.random.default_rng(9)
    series = -3 * _ramp_of(600, onset=300, extent=1) + back * _ramp_of(600, onset=330, extent=1)
    steps = find_steps(series + 0.1 * white(rng, 600), false_alarm=1e-3)
    assert [np.sign(step.size) for step in steps] == found


def test_a_single_wild_sample_is_not_a_step():
    rng = np.random.default_rng(10)
    series = NOISE * white(rng, 300)
    series[150] += 40
    assert find_steps(series, false_alarm=1e-3) == ()


def test_an_uneven_step_is_one_step():
    rng = np.random.default_rng(12)
    series = -2 * _ramp_of(500, onset=200, extent=6) - 1.5 * _ramp_of(500, onset=206, extent=20)
    steps = find_steps(series + 0.05 * white(rng, 500), false_alarm=1e-3)
    assert len(steps) == 1
    assert steps[0].onset == pytest.approx(200, abs=6)
    assert steps[0].size == pytest.approx(-3.5, abs=0.2)


def test_a_constant_series_has_no_step():
    assert find_steps(np.ones(100), false_alarm=1e-3) == ()


def test_the_background_of_a_series_is_factored_once_and_leaves_a_ramp_in():
    count = np.arange(1.0, 2001)
    series = 5000 - 300 * np.log10(count)
    splice_slip._background.cache_clear()
    find_steps(5 * np.round(series / 5), false_alarm=1e-3)
    assert splice_slip._background.cache_info().misses == 1
    # of a logarithm, a line, a softening and a step nothing is left but the step
    ramp = 1.0 * (count > 1200)
    left = splice_slip._without_background(
        series - 0.01 * count + 40 * np.exp(-(count - 1) / 8) - 7 * ramp, ramp[None]
    )
    np.testing.assert_allclose(left, -7 * ramp, atol=1e-6)


# the scan for steps, against the same written out sample by sample


@pytest.mark.parametrize("n_samples", [20, 61, 640])
def test_products_and_powers_of_ramps_are_those_of_the_ramps_themselves(n_samples):
    rng = np.random.default_rng(n_samples)
    level = _without_parabola(50 + 3 * rng.standard_normal(n_samples).cumsum())
    onset, extent = (
        grid.ravel()
        for grid in np.meshgrid(np.arange(2, n_samples - 3), [1, 2, 5, 13], indexing="ij")
    )
    inside = onset + extent <= n_samples - 2
    onset, extent = onset[inside], extent[inside]
    ramps = _ramp_of(n_samples, onset=onset, extent=extent)
    product, power = _fit_ramps(level, onset=onset, extent=extent)
    np.testing.assert_allclose(product, ramps @ level, rtol=1e-9, atol=1e-9 * np.ptp(level))
    np.testing.assert_allclose(power, (_without_parabola(ramps) ** 2).sum(axis=1), rtol=1e-8)


@pytest.mark.parametrize("n_samples", [20, 61, 640])
def test_products_and_powers_of_kinks_are_those_of_the_kinks_themselves(n_samples):
    rng = np.random.default_rng(n_samples)
    level = _without_parabola(50 + 3 * rng.standard_normal(n_samples).cumsum())
    onset = np.arange(2, n_samples - 3)
    kinks = np.maximum(0.0, np.arange(n_samples) - onset[:, None])
    product, power = _fit_kinks(level, onset=onset)
    rounding = 1e-11 * n_samples * np.ptp(level)
    np.testing.assert_allclose(product, kinks @ level, rtol=1e-9, atol=rounding)
    # of a kink near the end next to nothing is left beyond the parabola
    np.testing.assert_allclose(power, (_without_parabola(kinks) ** 2).sum(axis=1), rtol=1e-6)


@pytest.mark.parametrize("n_samples", [40, 97, 700, 3001])
def test_the_strongest_response_is_that_of_a_convolution_with_each_kernel(n_samples):
    rng = np.random.default_rng(n_samples)
    values = 0.2 * rng.standard_normal(n_samples)
    values += _ramp_of(n_samples, onset=3 * n_samples // 4, extent=2)
    allowed = rng.random(n_samples) > 0.1
    scores, tried, inflation = {}, 0, 1.0
    for window, extent in stepscan._windows(n_samples):
        ramp = _without_parabola(_ramp_of(2 * window + extent, onset=window, extent=extent))
        size = np.convolve(values, ramp[::-1] / (ramp @ ramp), mode="valid")
        onset = np.arange(size.size) + window
        kept = allowed[onset] & (onset >= max(2 * window, window + stepscan.FIRST_SAMPLE))
        if not kept.any():
            continue
        size, onset = size[kept], onset[kept]
        white = 0.2 / np.sqrt(ramp @ ramp)
        colour = stepscan._colour(size, onset, white, 2 * window + extent)
        inflation = max(inflation, colour or 1.0)
        scores |= {
            (at, window, extent): one / (white * max(1.0, colour or inflation))
            for at, one in zip(onset.tolist(), size.tolist(), strict=True)
        }
        tried += size.size
    strongest = max(scores, key=lambda place: abs(scores[place]))
    found, n_tried = _strongest_response(values, noise=0.2, allowed=allowed)
    assert (found.onset, found.window, found.extent) == strongest
    assert found.score == pytest.approx(scores[strongest], rel=1e-10)
    assert n_tried == tried


def test_a_series_shorter_than_a_window_has_no_response():
    allowed = np.ones(12, dtype=bool)
    assert _strongest_response(np.zeros(12), noise=1.0, allowed=allowed) == (None, 0)


# sizes of known steps in a series


def test_the_size_of_a_step_in_another_series_is_free_of_its_neighbours():
    steps = tuple(_SlipStep(onset, 1, onset, onset, onset, 1.0, 0.0, 0.0) for onset in (100, 130))
    series = -2.0 * _ramp_of(300, onset=100, extent=1) - 5.0 * _ramp_of(300, onset=130, extent=1)
    size, uncertainty = _step_sizes(series + 0.01 * np.arange(300), steps)
    np.testing.assert_allclose(size, [-2, -5], atol=1e-9)
    np.testing.assert_allclose(uncertainty, 0, atol=1e-9)


def test_a_size_is_uncertain_by_the_share_that_the_shape_is():
    step = _SlipStep(100, 1, 100, 100, 100, 2.0, 0.5, 0.0)
    size, uncertainty = _step_sizes(-8.0 * _ramp_of(200, onset=100, extent=1), (step,))
    assert size == pytest.approx([-8])
    assert uncertainty == pytest.approx([8 * 0.5 / 2])


def test_no_steps_have_no_sizes():
    size, uncertainty = _step_sizes(np.arange(50.0), ())
    assert size.shape == uncertainty.shape == (0,)


# noise and digitizer step of a series


def test_noise_of_a_white_series_is_its_standard_deviation():
    noise, _ = sample_noise(2 * np.random.default_rng(0).standard_normal(40000))
    assert noise == pytest.approx(2, rel=0.02)


def test_the_step_of_the_digitizer_is_found():
    series = np.round(np.random.default_rng(1).standard_normal(500) / 0.25) * 0.25
    assert sample_noise(series)[1] == pytest.approx(0.25)


def test_a_constant_series_has_neither():
    assert sample_noise(np.full(10, 5.0)) == (0.0, 0.0)


@pytest.mark.parametrize("noise", [0.45, 0.6])
def test_rounding_is_no_part_of_the_noise_beneath_it(noise):
    """Rounding to a step adds a twelfth of its square: 0.6 steps would be read as 0.67."""
    rows = np.arange(6000)
    wave = 7.37 * np.abs((rows + 0.3) % 400 - 200)
    codes = np.round(wave + noise * np.random.default_rng(3).standard_normal(rows.size))
    found, step = noise_and_step(0.25 * codes, reading_noise(0.25 * codes))
    assert step == 0.25
    assert found == pytest.approx(0.25 * noise, rel=0.08)


REFUSED = {
    "cycles without stroke are refused": (
        lambda: cycle_tension_level(
            np.ones(40),
            np.ones((1, 40)),
            cycle_number=np.ones(40, dtype=int),
            branch=np.repeat([1, 2], 20),
            n_cycles=1,
        ),
        DataError,
        "no stroke to compare cycles on; found 40 samples",
    ),
    "a series too short is refused": (
        lambda: find_steps(np.zeros(10), false_alarm=1e-3),
        DataError,
        "too short for steps; found 10 samples; needed 24",
    ),
    "a rate that is no chance is refused": (
        lambda: find_steps(np.zeros(100), false_alarm=2.0),
        DataError,
        "false-alarm rate is not a chance; found 2",
    ),
    "a missing value is refused": (
        lambda: find_steps(np.where(np.arange(100) == 5, np.nan, 0.0), false_alarm=1e-3),
        DataError,
        "1 of 100 values of values are not finite",
    ),
    "a step without extent is refused": (
        lambda: _ramp_of(10, onset=3, extent=0),
        DataError,
        "a step has no extent; found 0",
    ),
    "one sample has no noise to read": (
        lambda: sample_noise([1.0]),
        DataError,
        "no noise can be read from one sample",
    ),
}


test_refusals = refusals(REFUSED)

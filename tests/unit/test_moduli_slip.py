"""The level of a cycle, and slips told from creep."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.pipeline.located_test import slips_of
from reduction.record.errors import DataError
from reduction.record.settings import (
    CycleSettings,
    PhaseSettings,
    ReductionSettings,
    SlipSettings,
)
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.moduli.loop_balance import cycle_tension_level
from reduction.stages.moduli.splice_slip import find_slips
from reduction.stages.standstills import find_standstills

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


def test_cycles_without_stroke_are_refused():
    with pytest.raises(DataError, match="no stroke to compare cycles on; found 40 samples"):
        cycle_tension_level(
            np.ones(40),
            np.ones((1, 40)),
            cycle_number=np.ones(40, dtype=int),
            branch=np.repeat([1, 2], 20),
            n_cycles=1,
        )


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
    stands = find_standstills(time, position, [tension], settings=PhaseSettings())
    cycles = find_cycles(
        time,
        position,
        [tension],
        stands,
        settings=CycleSettings(),
        cycle_counter=number,
    )
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

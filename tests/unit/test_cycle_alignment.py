"""Curves of cycles that creep, and of cycles of which some reach further than others."""

import numpy as np
import pytest

from reduction.record.settings import ModulusSettings
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli.cycle_alignment import (
    CLEAR_JUMP,
    aligned_strain,
    alignment_moves,
    is_shift_of_curve,
    jump_at_stop,
    jump_of_mean,
    strain_shifts,
)
from reduction.stages.moduli.segments import find_segments
from reduction.stages.moduli.tangent_modulus import tangent_curves

PER, AREA = 100, np.array([1e-3])
SLOPE, BEND = 2e6, 6e6  # [N]


def law(relative):
    return 5e4 + SLOPE * relative + BEND * relative**2


def cycles_of(half, middle, tension_of):
    """Triangular cycles, half range and middle by cycle: strain, tension and the cycles."""
    n = half.size
    phase = np.arange(n * PER + 1)
    number = np.minimum(phase // PER, n - 1)
    share = 1 - np.abs(1 - 2 * (phase - PER * number) / PER)
    relative = half[number] * (2 * share - 1)
    first = PER * np.arange(n)
    ends = np.column_stack([first, first + PER // 2])
    branch = np.where(phase - PER * number <= PER // 2, 1, 2).astype(np.int8)
    found = Cycles(
        first, first + PER, ends, ends + PER // 2, np.ones((n, 2)),
        (number + 1).astype(np.int32), branch, np.ones(phase.size, dtype=bool), 0.001,
    )  # fmt: skip
    return (relative + middle[number])[None], tension_of(relative, number)[None], found


def curves_of(strain, tension, cycles):
    settings = ModulusSettings()
    return tangent_curves(strain, tension, area=AREA, cycles=cycles, settings=settings)


def slope_of(curves, branch):
    known = np.isfinite(curves.branch_tension[0, branch])
    x, y = curves.strain_bin[known], curves.branch_tension[0, branch][known]
    return np.polyfit(x - x.mean(), y, 2)[1], np.ptp(x)


def test_the_curve_of_creeping_cycles_is_that_of_each():
    creep = 0.1 + 0.005 * np.log10(np.arange(1, 81))
    half = np.full(80, 0.02)
    strain, tension, cycles = cycles_of(half, creep, lambda relative, _: law(relative))
    shift, reference = strain_shifts(creep[None])
    assert reference[0] == pytest.approx(creep.mean())
    plain = curves_of(strain, tension, cycles)
    assert alignment_moves(plain, shift, half[None], reference, area=AREA).all()
    curves = curves_of(aligned_strain(strain, shift, cycles.cycle_number), tension, cycles)
    for branch in (0, 1):
        known = np.isfinite(curves.branch_tension[0, branch])
        expected = law(curves.strain_bin - reference[0])[known]
        np.testing.assert_allclose(curves.branch_tension[0, branch][known], expected, rtol=2e-4)
        assert known.sum() > 0.85 * 0.04 / np.diff(curves.strain_bin_bounds[0])[0]
    segments = find_segments(curves, area=AREA, settings=ModulusSettings())
    low, high = segments.segment_strain_low[0, 0, 0], segments.segment_strain_high[0, 0, 0]
    chord = (law(high - reference[0]) - law(low - reference[0])) / (high - low)
    assert segments.segment_modulus[0, 0, 0] * AREA[0] == pytest.approx(chord, rel=0.005)


def test_cycles_that_hardly_drift_stay_as_they_lie():
    rng = np.random.default_rng(2)
    creep, half = 0.1 + 1e-6 * np.arange(40.0), np.full(40, 0.02)

    def noisy(relative, _):
        return law(relative) + 300 * rng.standard_normal(relative.size)

    strain, tension, cycles = cycles_of(half, creep, noisy)
    shift, reference = strain_shifts(creep[None])
    plain = curves_of(strain, tension, cycles)
    assert not alignment_moves(plain, shift, half[None], reference, area=AREA).any()


@pytest.mark.parametrize(("of_tension", "is_creep"), [(0.0, True), (1.0, False), (-3.0, False)])
def test_strain_that_goes_with_the_tension_is_no_creep(of_tension, is_creep):
    shift = np.linspace(-0.003, 0.003, 30)[None]
    mean = 5e4 + of_tension * SLOPE * shift
    assert is_shift_of_curve(shift, mean, np.full_like(shift, SLOPE))[0] == is_creep


def test_a_mean_has_no_step_where_some_cycles_end():
    # half of the cycles reach further, and lie a tenth higher
    half = np.where(np.arange(20) % 2, 0.020, 0.024)
    strain, tension, cycles = cycles_of(
        half,
        np.full(20, 0.1),
        lambda relative, number: law(relative) * np.where(number % 2, 1, 1.1),
    )
    curves = curves_of(strain, tension, cycles)
    counts = curves.branch_tension_count[0]
    assert set(np.unique(counts)) == {0, 20}
    assert np.isnan(curves.branch_tension[0][counts == 0]).all()
    assert [one.code for one in curves.notes] == ["bins-of-some-cycles"]
    for branch in (0, 1):
        slope, covered = slope_of(curves, branch)
        assert slope == pytest.approx(1.05 * SLOPE, rel=0.01)
        assert covered > 0.03


def test_one_cycle_of_many_that_ends_early_makes_no_step():
    half = np.full(20, 0.02)
    half[0] = 0.0185
    strain, tension, cycles = cycles_of(
        half, np.full(20, 0.1), lambda relative, number: law(relative) * np.where(number, 1, 1.5)
    )
    curves = curves_of(strain, tension, cycles)
    assert {19, 20} <= set(np.unique(curves.branch_tension_count[0]))
    known = np.isfinite(curves.branch_tension[0, 0])
    step = np.diff(curves.branch_tension[0, 0][known]) / np.diff(curves.strain_bin[known])
    middle = (curves.strain_bin[known][1:] + curves.strain_bin[known][:-1]) / 2 - 0.1
    # the plain mean of 19 beside one of 20 would be off by a fortieth of 5e4 N over a bin
    np.testing.assert_allclose(step, 1.025 * (SLOPE + 2 * BEND * middle), rtol=0.03)


def test_shifts_of_cycles_without_a_mean_strain_are_those_beside():
    shift, reference = strain_shifts(np.array([[np.nan, 0.1, np.nan, 0.3], 4 * [np.nan]]))
    np.testing.assert_allclose(shift, [[-0.1, -0.1, 0.0, 0.1], [0, 0, 0, 0]], atol=1e-15)
    assert reference[0] == pytest.approx(0.2)
    assert np.isnan(reference[1])


def of_creeping_cycles(seed, jump=0.0, n=20, inside=False):
    """Mean strain by creep in the logarithm of the cycles, with noise; others as they are."""
    rng = np.random.default_rng(seed)
    strain = 0.03 + 1e-4 * np.log(np.arange(1.0, n + 1)) + rng.normal(0, 2e-6, n)
    strain += jump * (np.arange(n) >= n // 2) + inside * jump / 2 * (np.arange(n) == n // 2 - 1)
    tension = 1000 + rng.normal(0, 0.3, n)
    return 10.0 * np.arange(n), strain, tension, np.full(n, 6e4), np.full(n, 5e-3)


def test_a_slip_between_two_cycles_is_found_and_creep_is_none():
    alarms = sum(jump_of_mean(*of_creeping_cycles(seed)) is not None for seed in range(300))
    assert alarms == 0
    for inside in (False, True):
        for seed in range(20):
            number, size = jump_of_mean(*of_creeping_cycles(seed, -1e-3, inside=inside))
            assert number in (9, 10)
            assert size == pytest.approx(-1e-3, rel=0.05)


@pytest.mark.parametrize("seed", range(5))
def test_a_slip_that_is_less_than_the_creep_of_the_first_cycles_is_found(seed):
    number = np.arange(60)
    creep = 0.03 - 2e-3 * np.exp(-number / 2) + 2e-4 * np.log10(1 + number)
    mean = creep + np.random.default_rng(seed).normal(0, 2e-6, 60)
    steady = np.full(60, 1000.0), np.full(60, 6e4), np.full(60, 0.004)
    assert jump_of_mean(12.0 * number, mean, *steady) is None
    place, size = jump_of_mean(12.0 * number, mean + 3e-4 * (number >= 30), *steady)
    assert place == 30
    assert size == pytest.approx(3e-4, rel=0.05)


def test_a_level_that_was_asked_for_is_no_slip():
    time, strain, tension, *rest = of_creeping_cycles(3, 1e-3)
    assert jump_of_mean(time, strain, tension + 60 * (np.arange(20) >= 10), *rest) is None


def test_creep_in_a_pause_is_no_slip_and_a_slip_beside_the_pause_is_found():
    # blocks of five cycles with half an hour between them, creep in the logarithm of time
    time = 10.0 * np.arange(20) + 1800.0 * (np.arange(20) // 5)
    noise = np.random.default_rng(1).normal(0, 5e-6, (100, 20))
    creep = 0.03 + 1e-3 * np.log10(1 + time + 10) + noise
    steady = np.full(20, 1000.0), np.full(20, 6e4), np.full(20, 0.018)
    assert not any(jump_of_mean(time, one, *steady) for one in creep)
    for one in creep:
        number, size = jump_of_mean(time, one + 4e-3 * (np.arange(20) >= 8), *steady)
        assert number == 8
        assert size == pytest.approx(4e-3, rel=0.05)


def of_two_blocks(relax, *, level, jump=0.0, n=(30, 30), stop=40.0, seed=0):
    """Cycles of 2 s with a stop at another level: a linear specimen that relaxes, and a load zero."""
    begin = 2.0 * np.arange(sum(n)) + stop * (np.arange(sum(n)) >= n[0])
    at = begin[:, None] + 1.0 - np.array([-3.0, 2.0 * n[0], 2.0 * n[0] + stop])
    response = np.where(at > 0, relax(np.maximum(at, 0.0)), 0.0)
    mean = 1000 * response @ [1, level - 1, 1 - level] + jump * (begin > 2.0 * n[0])
    mean += np.random.default_rng(seed).normal(0, 0.3, mean.size)
    return begin, begin + 2.0, mean, np.full(mean.size - 1, True)


LAWS = [
    lambda t: 1 - 0.02 * np.log10(1 + t / 0.1), lambda t: (1 + t / 0.3) ** -0.03,
    lambda t: 0.8 + 0.1 * np.exp(-t / 2) + 0.1 * np.exp(-t / 12),
]  # fmt: skip


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("level", [0.0, 0.6, 1.0, 1.4])
@pytest.mark.parametrize("n", [(30, 30), (30, 100), (100, 30)])
def test_relaxation_and_recovery_in_a_stop_are_no_clear_step_and_a_moved_zero_is(law, level, n):
    found = jump_at_stop(*of_two_blocks(law, level=level, n=n))
    assert found is None or abs(found[1]) < CLEAR_JUMP * found[2]
    for jump in (80.0, -80.0):
        number, size, explained = jump_at_stop(*of_two_blocks(law, level=level, n=n, jump=jump))
        assert number == n[0] and abs(size - jump) < explained + 15


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("wait", [5.0, 300.0])
def test_cycles_that_may_have_run_in_a_gap_of_the_log_go_on_as_those_beside_it(law, wait):
    """Relaxation goes on in the gap; a zero that moves by 80 N does not."""
    begin = np.append(np.arange(20.0), 20 + wait + np.arange(20.0))
    mean, nowhere = 2000 + 40 * law(begin + 3), np.zeros(39, dtype=bool)
    found = jump_at_stop(begin, begin + 1, mean, nowhere)
    assert found is None or abs(found[1]) < CLEAR_JUMP * found[2]
    for size in (80.0, -80.0):
        moved = mean + size * (begin > 20)
        number, step, explained = jump_at_stop(begin, begin + 1, moved, nowhere)
        assert number == 20 and abs(step - size) < explained + 1

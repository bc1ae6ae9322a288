"""Closed-cycle identity: it holds for sound cycles and fails where something is wrong."""

import dataclasses

import numpy as np
import pytest
from scipy.signal import lfilter

from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli import loop_balance as identity
from reduction.stages.moduli.loop_balance import check_identity

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


def test_loops_whose_turns_are_lost_say_nothing_of_a_late_tension(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=20, begins="valley")
    tension = loop(strain, cycles)
    tension[tension > 0.8 * tension.max()] = np.nan  # a load cell that saturates
    assert np.isnan(identity._opens(strain, tension, cycles))


def test_residual_of_noise_is_as_stated(triangle):
    rng = np.random.default_rng(13)
    strain, cycles = triangle(n_cycles=400, per_cycle=94)  # no reading ends two pieces
    noise, n, pieces = 1.2, 47, 4
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
    blocks = Cycles.blocks
    monkeypatch.setattr(Cycles, "blocks", lambda cycles: blocks(cycles, 77))
    pieces = check_identity(strain[None], tension, **arguments)
    assert pieces.identity_residual == pytest.approx(whole.identity_residual, abs=1e-12)


def test_a_cycle_longer_than_a_part_is_summed_part_by_part(triangle, monkeypatch):
    strain, cycles = triangle(n_cycles=6, per_cycle=400)
    tension = loop(strain, cycles, lost=2.0)
    args = strain[None], tension[None]
    whole = check_identity(*args, area=[AREA], cycles=cycles)
    monkeypatch.setattr(identity, "_PART", 37)
    parted = check_identity(*args, area=[AREA], cycles=cycles)
    for name in ("identity_residual", "stroke_mean_modulus_difference"):
        np.testing.assert_allclose(
            getattr(parted, name), getattr(whole, name), rtol=1e-9, atol=1e-12
        )


def test_dead_specimen_is_nan_and_leaves_the_other_alone(triangle):
    strain, cycles = triangle(n_cycles=6, per_cycle=200)
    both = np.stack([loop(strain, cycles), np.full_like(strain, np.nan)])
    checked = check_identity(np.stack([strain, strain]), both, area=[AREA, AREA], cycles=cycles)
    assert np.isfinite(checked.identity_residual[0]).all()
    assert np.isnan(checked.identity_residual[1]).all()


def sampled(lag, *, per_cycle=100, n_cycles=40, noise=0.05, bend=30.0):
    """Two specimens on one triangle, the second one's tension sampled late, in periods."""
    time = np.arange(n_cycles * per_cycle + 1) / per_cycle
    rng = np.random.default_rng(4)

    def strain(when):
        return 1.0 + np.abs((when + 0.5) % 1 * 2 - 1)

    stretch = strain(time)
    loads = [
        200 * strain(time - late)
        + bend * strain(time - late) ** 3
        + rng.normal(0, noise, time.size)
        for late in (0, lag)
    ]
    return np.stack([stretch, stretch]), np.stack(loads)


def judged(lag, triangle, control="position", **options):
    strain, tension = sampled(lag, **options)
    _, cycles = triangle(
        n_cycles=options.get("n_cycles", 40), per_cycle=options.get("per_cycle", 100)
    )
    return check_identity(
        strain, tension, area=[AREA, AREA], cycles=cycles, names=("sound", "late"),
        control=control,
    )  # fmt: skip


def test_tension_sampled_late_is_noted_and_sound_channels_are_not(triangle):
    found = judged(0.005, triangle)
    assert found.mean_identity_residual[1] == pytest.approx(
        found.identity_residual[1].mean(), rel=1e-12
    )
    assert found.mean_identity_residual_standard_uncertainty[1] == pytest.approx(
        found.identity_residual[1].std(ddof=1) / np.sqrt(40)
    )
    assert abs(found.mean_identity_residual[0]) < 0.001
    assert -0.011 < found.mean_identity_residual[1] < -0.007
    (note,) = map(str, found.notes)
    assert note.startswith("late: the difference between the mean slopes of the two branches")
    assert "residual -0." in note and "channel lag" in note
    assert "few samples" not in note
    (note,) = map(str, judged(0.005, triangle, control="load").notes)
    assert note.startswith("late: the difference")


@pytest.mark.parametrize(("stated", "severity"), [(0.0025, "note"), (0.0005, "warning")])
def test_a_lag_that_is_stated_is_no_warning_where_it_explains_what_is_left(
    stated, severity, triangle
):
    strain, tension = sampled(0.005)
    _, cycles = triangle(n_cycles=40, per_cycle=100)
    found = check_identity(
        strain, tension, area=[AREA, AREA], cycles=cycles, names=("sound", "late"),
        time=np.arange(strain.shape[1]) / 100, lag=[stated, stated],
    )  # fmt: skip
    (note,) = found.notes
    assert note.severity == severity
    assert ("The stated channel lag explains up to 0." in str(note)) is (severity == "note")


def test_what_noise_explains_or_is_below_half_a_percent_is_not_noted(triangle):
    # as late as before, and as far off: but the scatter of ten cycles hides it
    assert tuple(map(str, judged(0.005, triangle, n_cycles=10, noise=8.0).notes)) == ()
    found = judged(0.001, triangle)
    error = found.mean_identity_residual_standard_uncertainty[1]
    assert found.mean_identity_residual[1] < -3 * error
    assert tuple(map(str, found.notes)) == ()


def test_few_samples_a_branch_are_named_among_the_causes(triangle):
    (note,) = map(str, judged(0.1, triangle, per_cycle=20).notes)
    assert "few samples for the curvature" in note


def saw(rise, fall, *, lag=0.0, wave=None, n_cycles=20):
    """A solid that relaxes, in strokes of so many samples, its tension logged late by samples."""
    turns = np.cumsum([0, *n_cycles * [rise, fall]])
    n = np.arange(100 * turns[-1] + 1) / 100
    strain = np.interp(n, turns, np.arange(turns.size) % 2)
    if wave is not None:
        strain = wave(strain)
    period = rise + fall
    tension = strain + 0.2 * strain**2
    for lasts in (0.02, 0.1, 0.4):  # of a period
        decay = np.exp(-1 / (100 * lasts * period))
        tension += 0.1 * lfilter([decay], [1, -decay], np.diff(strain, prepend=0))
    at = np.arange(3 * period, turns[-1] + 1)  # after three cycles
    logged = np.interp(at - lag, n, tension)
    edges = (turns[6:] - turns[6]).astype(int)
    number = np.searchsorted(edges[::2], at - at[0], side="right")
    side = np.where((at - at[0]) % period < rise, 1, 2)
    ends = np.stack([edges[:-1], edges[1:]], axis=-1).reshape(-1, 2, 2)
    cycles = Cycles(
        first=edges[:-1:2], last=edges[2::2], branch_first=ends[..., 0], branch_last=ends[..., 1],
        plateau_rate=np.ones((n_cycles - 3, 2)),
        cycle_number=np.minimum(number, n_cycles - 3).astype(np.int32),
        branch=side.astype(np.int8), is_in_trimmed_branch=np.ones(at.size, bool), band=0.01,
    )  # fmt: skip
    noise = np.random.default_rng(1).normal(0, 1e-3, at.size)
    return check_identity(
        np.interp(at, n, strain)[None], (logged + noise)[None], area=[1.0], cycles=cycles
    )


@pytest.mark.parametrize(("rise", "fall"), [(40, 160), (180, 20), (100, 100)])
def test_relaxation_in_unequal_strokes_is_no_imbalance_and_lag_is(rise, fall):
    assert saw(rise, fall).notes == ()
    late = saw(rise, fall, lag=4.0)
    assert len(late.notes) == 1


@pytest.mark.parametrize("half", [6, 10, 12, 16, 24])  # in step, some of their readings end pieces
def test_a_sine_of_few_readings_is_no_imbalance(half):
    found = saw(half, half, wave=lambda x: (1 - np.cos(np.pi * x)) / 2)
    assert found.notes == ()


def test_one_cycle_has_a_mean_and_no_error_and_no_note(triangle):
    found = judged(0.02, triangle, n_cycles=1)
    assert np.isfinite(found.mean_identity_residual).all()
    assert np.isnan(found.mean_identity_residual_standard_uncertainty).all()
    assert tuple(map(str, found.notes)) == ()


def test_cycles_without_a_residual_are_left_out_of_the_mean(triangle):
    strain, tension = sampled(0.0)
    _, cycles = triangle(n_cycles=40, per_cycle=100)
    tension[0, cycles.first[5]] = np.nan
    tension[1] = np.nan
    found = check_identity(strain, tension, area=[AREA, AREA], cycles=cycles)
    assert np.isnan(found.identity_residual[0]).sum() == 2
    assert found.mean_identity_residual[0] == pytest.approx(np.nanmean(found.identity_residual[0]))
    assert np.isnan(found.mean_identity_residual[1])
    assert tuple(map(str, found.notes)) == ()


@pytest.mark.parametrize("late", [0, 4])
def test_a_curve_that_bends_within_a_piece_is_no_imbalance_and_a_late_one_is(triangle, late):
    """A closed loop that stiffens tenfold; friction grows with stretch and turns in a few percent."""
    strain, cycles = triangle(n_cycles=12, per_cycle=400, low=0.0, high=1.0)
    up = cycles.branch == 1
    since_turn = np.where(up, strain, 1 - strain)
    friction = np.where(up, 1, -1) * (1 - 2 * np.exp(-since_turn / 0.06) / (1 + np.exp(-1 / 0.06)))
    softplus = 0.05 * np.logaddexp(0, (strain - 0.7) / 0.05)
    tension = np.roll(500 * strain + 5000 * softplus + 100 * friction * (1 + strain), late)
    tension += np.random.default_rng(3).normal(0, 1, strain.size)
    found = check_identity(strain[None], tension[None], area=[AREA], cycles=cycles)
    assert len(found.notes) == (late > 0)


@pytest.mark.parametrize(("late", "severity"), [(0.0, "note"), (1.5, "warning")])
@pytest.mark.parametrize("place", [0.6, 0.9])
def test_turns_between_the_same_two_readings_are_no_warning_and_a_late_load_is(
    place, late, severity
):
    """Friction that turns within a reading of a corner, read 50 times in each cycle."""
    fine, first = 100, 50 * np.arange(1, 12) + 1
    at = (np.arange(50 * fine * 13) / fine - place) / 50  # in cycles
    strain = 1.5 - 0.5 * np.abs((2 * at) % 2 - 1)
    turned = 2 * np.minimum(25 * ((2 * at) % 1), 1.0) - 1
    friction = np.where((2 * at) % 2 < 1, turned, -turned)
    tension = 200 * strain + 60 * strain**4 + 15 * strain**2 * friction
    rise = np.column_stack([first, first + 25])
    number = np.clip((np.arange(650) - 1) // 50, 0, 12) % 12
    side = np.where(number > 0, 1 + (np.arange(650) - 1) // 25 % 2, 0)
    cycles = Cycles(
        first, first + 50, rise, rise + 25, np.ones((11, 2)), number, side, side > 0, 0.1
    )
    read = fine * np.arange(650)
    found = check_identity(
        strain[read][None], tension[np.maximum(read - int(late * fine), 0)][None], area=[AREA],
        cycles=cycles,
    )  # fmt: skip
    (note,) = found.notes
    assert note.severity == severity
    assert ("the reversal lies between the same two readings" in str(note)) is (severity == "note")


@pytest.mark.parametrize("per_cycle", [30, 40, 50])
def test_readings_in_step_on_a_curve_that_bends_open_no_cycle(per_cycle):
    # a third of a reading beside the turn in every cycle: the pieces of a rise and of a fall hold
    # readings at other strains, alike in all cycles, so that their scatter says nothing of it
    n_cycles, late = 10, per_cycle / 2
    at = np.arange(per_cycle * n_cycles + 1) + 0.33
    angle = 2 * np.pi * at / per_cycle
    strain = 0.5 - 0.3 * np.cos(angle)
    tension = 200 * np.expm1(1.5 * strain) + 15 * np.sin(angle)
    first = per_cycle * np.arange(n_cycles)
    rise = np.column_stack([first, first + late]).astype(np.int64)
    number = np.minimum(np.arange(at.size) // per_cycle + 1, n_cycles).astype(np.int32)
    branch = np.where((np.arange(at.size) - 1) % per_cycle < late, 1, 2).astype(np.int8)
    branch[0] = 1
    number[first[1:]] -= 1
    branch[first[1:]] = 2
    cycles = Cycles(
        first, first + per_cycle, rise, rise + int(late), np.ones((n_cycles, 2)), number, branch,
        np.ones(at.size, dtype=bool), 0.0,
    )  # fmt: skip
    found = check_identity(strain[None], tension[None], area=[AREA], cycles=cycles)
    assert abs(found.mean_identity_residual[0]) < 0.001
    assert found.notes == ()


def in_a_row(half, n_cycles, *, apart=0):
    """Cycles of two branches of ``half`` steps; the second begins ``apart`` steps late."""
    first, order = 2 * half * np.arange(n_cycles), np.arange(2 * half * n_cycles + 1)
    end = np.column_stack([first + half, first + 2 * half])
    return Cycles(
        first, end[:, 1], np.column_stack([first, end[:, 0] + apart]), end, np.ones((n_cycles, 2)),
        np.maximum(order - 1, 0) // (2 * half) + 1,
        np.where(np.maximum(order - 1, 0) % (2 * half) < half, 1, 2),
        np.ones(order.size, dtype=bool), 0.0,
    )  # fmt: skip


def test_strain_that_goes_on_behind_the_turn_of_a_driven_load_opens_no_cycle():
    """A rope that stiffens, creeps within seconds and has friction, read 40 times a cycle."""
    half, n_cycles, fine = 20, 12, 50
    at = np.arange(half * fine * (2 * n_cycles + 1) + 1) / fine + 0.1 - half
    driven = 1 + 0.67 * (1 - 2 * np.abs(at / half % 2 - 1))
    elastic = np.log1p(np.expm1(3.0) * driven / 1.67)
    strain = elastic.copy()
    for reach in (2.0, 20.0):
        left = np.exp(-1 / (fine * reach))
        strain += 0.05 * lfilter([1 - left], [1, -left], elastic, zi=[left * elastic[0]])[0]
    held, room = elastic.copy(), 0.04 * np.ptp(elastic)
    for place in range(1, held.size):
        held[place] = np.clip(held[place - 1], elastic[place] - room, elastic[place] + room)
    strain += 0.3 * (held - elastic)
    read = slice(half * fine, None, fine)
    cycles = in_a_row(half, n_cycles)
    sides = 0.05 * strain[read][None], 1e4 * driven[read][None]
    over_strain, over_load = (
        check_identity(*sides, area=[AREA], cycles=cycles, control=one)
        for one in ("position", "load")
    )
    assert [one.severity for one in over_strain.notes] == ["warning"]
    assert over_load.notes == ()


def test_a_driven_sine_load_may_leave_a_negative_residual_with_closed_turns():
    """An exponential spring beside a spring and dashpot (.8 s), at .125 Hz and 400 readings."""
    half, n_cycles, fine = 200, 4, 10
    step = 0.02 / fine
    time = np.arange(-4 * half * fine, 2 * half * n_cycles * fine + 1) * step
    phase = 2 * np.pi * 0.125 * time
    load, rate = 15e3 - 9e3 * np.cos(phase), 9e3 * 2 * np.pi * 0.125 * np.sin(phase)
    strain = np.empty(time.size)
    strain[0] = 0.05 * np.log1p(load[0] / 2e4)
    for place in range(time.size - 1):  # steps of a quarter of a per cent of the time constant
        spring = 2e4 * np.exp(strain[place] / 0.05)
        grows = rate[place] + (load[place] - spring + 2e4) / 0.8
        strain[place + 1] = strain[place] + step * grows / (spring / 0.05 + 5e5)
    read = slice(4 * half * fine, None, fine)
    found = check_identity(
        strain[read][None], load[read][None], area=[AREA], control="load",
        cycles=in_a_row(half, n_cycles, apart=1),
    )  # fmt: skip
    assert found.mean_identity_residual[0] < -0.01
    assert found.notes == ()

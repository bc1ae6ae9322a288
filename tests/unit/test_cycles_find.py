"""Cycles are counted right whatever real logs do: the counts are those the paths were drawn with."""

from itertools import pairwise

import numpy as np
import pytest
from located_cycles import cycles_of_log

from reduction.quantities.flags import BRANCH_VALUES, PHASE_VALUES
from reduction.record.errors import DataError
from reduction.record.settings import CycleSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles, label_phases
from reduction.stages.cycles.periods import own_periods
from reduction.stages.standstills import find_standstills

LEAD = [(0, 3), (20, 3), (40, 4)]


def path(points, *, rate=10.0, noise=0.002):
    knots = np.array(points, dtype=float)
    time = np.arange(0, knots[-1, 0] + 0.5 / rate, 1 / rate)
    generator = np.random.default_rng(3)
    return time, np.interp(time, *knots.T) + generator.normal(0, noise, time.size)


def strokes(start, n_cycles, low=4.0, high=5.0, *, half=5.0, dwell_low=0.0, dwell_high=0.0):
    points = [(start, low)]
    for _ in range(n_cycles):
        for level, dwell in ((high, dwell_high), (low, dwell_low)):
            points.append((points[-1][0] + half, level))
            if dwell:
                points.append((points[-1][0] + dwell, level))
    return points


def back(points, *, after=10.0, rest=50.0):
    end = points[-1][0] + after
    return [*points, (end, 3), (end + rest, 3)]


def find(time, position, counter=None, **settings):
    tension = np.stack([100 * (position - 3), 80 * (position - 3)])
    return cycles_of_log(
        time, position, tension, settings=CycleSettings(**settings), cycle_counter=counter
    )


@pytest.fixture
def twenty():
    return path(back([*LEAD, *strokes(50, 20)]))


def test_cycles_run_from_valley_to_valley_between_set_up_and_return(twenty):
    time, position = twenty
    cycles = find(time, position)
    assert cycles.n_cycles == 20
    assert time[cycles.first] == pytest.approx(50 + 10 * np.arange(20), abs=0.2)
    assert time[cycles.last] == pytest.approx(60 + 10 * np.arange(20), abs=0.2)
    assert time[cycles.branch_last[:, 0]] == pytest.approx(55 + 10 * np.arange(20), abs=0.2)
    assert (cycles.branch_last[:, 0] == cycles.branch_first[:, 1]).all()
    assert (cycles.last[:-1] == cycles.first[1:]).all()
    assert cycles.counted_by == "reversals"


def test_the_return_to_slack_is_cut_at_the_valley_and_the_history_says_so(twenty):
    time, position = twenty
    cycles = find(time, position)
    assert position[cycles.last[-1]] == pytest.approx(4.0, abs=0.03)
    assert cycles.notes == ()
    assert cycles.made == (
        "half cycles at the end of a run of cycles, cut where they go beyond the level of their neighbours: 1, "
        f"first near {time[cycles.branch_last[-1, 0]]:g} s",
    )


def test_labels_follow_the_branches(twenty):
    time, position = twenty
    cycles = find(time, position)
    labels = cycles.cycle_number, cycles.branch
    assert [np.unique(label).tolist() for label in labels] == [list(range(21)), [0, 1, 2]]
    for i in (0, 7, 19):
        (up, down), (peak, _) = cycles.branch_first[i], cycles.branch_last[i]
        assert (cycles.branch[up : peak + 1] == BRANCH_VALUES["ascending"]).all()
        assert (cycles.branch[down + 1 : cycles.last[i]] == BRANCH_VALUES["descending"]).all()
        assert (cycles.cycle_number[cycles.first[i] : cycles.last[i]] == i + 1).all()
    assert cycles.cycle_number[cycles.first[1]] == 2  # a shared valley begins the next cycle
    assert cycles.cycle_number[cycles.last[-1]] == 20
    assert (cycles.is_in_trimmed_branch <= (cycles.branch > 0)).all()
    assert cycles.cycle_number.dtype == np.int32 and cycles.branch.dtype == np.int8


def test_set_up_moves_between_holds_are_no_cycles():
    set_up = [(0, 3), (20, 3), (40, 4), (100, 4), (110, 4.5), (170, 4.5), (180, 5), (360, 5)]
    points = back([*set_up, (380, 4), *strokes(390, 10)])
    time, position = path(points)
    for control in ("position", "load"):
        cycles = find(time, position, control=control)
        assert cycles.n_cycles == 10
        assert time[cycles.first[0]] == pytest.approx(390, abs=0.3)


def test_missing_samples_on_branches_and_at_peaks_change_no_count(twenty):
    time, position = twenty
    for begin, length in ((700, 5), (1000, 3), (1049, 3), (1300, 11)):
        position[begin : begin + length] = np.nan
    assert find(time, position).n_cycles == 20


def test_drop_outs_to_zero_and_to_full_scale_change_no_count(twenty):
    time, position = twenty
    position[720:725] = position[1010] = position[1077:1080] = position[1300] = 0
    position[1104:1108] = 8
    cycles = find(time, position)
    assert cycles.n_cycles == 20
    assert any("spikes of the control channel" in note for note in map(str, cycles.notes))


def test_cycles_beside_an_unloading_between_two_runs_are_left_out():
    time, position = path(back([*LEAD, *strokes(50, 10)]))
    cycles = find(time, position)
    foot = position[cycles.first[5]]
    unload = np.linspace(foot, 0.0, round((foot - 0.0) / np.abs(np.diff(position)).max()) + 1)
    at = int(cycles.first[5])
    position = np.concatenate([position[:at], unload, unload[::-1], position[at:]])
    time = np.arange(position.size) * (time[1] - time[0])
    cycles = find(time, position)
    assert cycles.n_cycles == 8
    assert np.ptp(position[np.r_[cycles.first, cycles.last]]) < 0.1 * (position.max() - foot)


def test_cycles_between_two_levels_by_turns_are_left_out_with_a_warning():
    # unloaded after every second cycle: no cycle but the first and last begins and ends at 6
    knots = [0, *[6, 10, 6, 10, 6, 0] * 4]
    ways = pairwise(knots)
    position = np.concatenate([np.linspace(a, b, 12 * abs(b - a), endpoint=False) for a, b in ways])
    time = np.arange(position.size) * 0.05
    cycles = find(time, position)
    assert cycles.n_cycles == 2
    (left,) = [one for one in cycles.notes if one.code == "cycles-of-two-amplitudes"]
    assert left.severity == "warning"
    period, _ = own_periods(
        time, position, cycles, time[cycles.last] - time[cycles.first], noise=0.0
    )
    assert period == pytest.approx(8 * 12 * 0.05, rel=0.02)  # not the 55 s from one to the other


def test_backward_slips_below_the_band_change_no_count():
    time, position = path(back([*LEAD, *strokes(50, 20)]))
    slips = 0.08 * (np.arange(time.size) // 20 % 2) * ((time > 50) & (time < 245))
    assert find(time, position + slips).n_cycles == 20


@pytest.mark.parametrize("dwell", [0.5, 2.0, 10.0])
@pytest.mark.parametrize("where", ["peaks", "valleys", "both"])
def test_dwells_are_parts_of_cycles(dwell, where):
    points = strokes(
        50,
        12,
        dwell_high=dwell if where != "valleys" else 0,
        dwell_low=dwell if where != "peaks" else 0,
    )
    time, position = path(back([*LEAD, *points]))
    cycles = find(time, position)
    assert cycles.n_cycles == 12
    assert (cycles.plateau_rate == pytest.approx(0.2, rel=0.02)) or dwell == 2.0


@pytest.mark.parametrize("dwell", [2.0, 2.5, 3.0])
def test_ramps_of_a_wave_that_dwells_for_half_of_a_branch_have_their_own_rate(dwell):
    points = strokes(50, 12, half=2.5, dwell_high=dwell, dwell_low=dwell)
    cycles = find(*path(back([*LEAD, *points])), waveform="other")
    assert cycles.plateau_rate == pytest.approx(1 / 2.5, rel=0.02)


def test_branches_leave_out_dwells_that_are_standstills():
    time, position = path(back([*LEAD, *strokes(50, 12, dwell_low=10, dwell_high=10)], after=30))
    cycles = find(time, position)
    duration = time[cycles.branch_last] - time[cycles.branch_first]
    assert duration == pytest.approx(5, abs=0.4)
    between = slice(cycles.branch_last[3, 0] + 1, cycles.branch_first[3, 1])
    assert (cycles.branch[between] == 0).all()
    assert (cycles.cycle_number[between] == 4).all()


def test_two_holds_of_the_set_up_are_no_dwells():
    points = [*LEAD, (50, 4), (60, 5), (70, 5), (80, 4), (90, 4), (100, 5), (110, 5), (120, 4)]
    time, position = path(back([*points, *strokes(130, 5)]))
    assert find(time, position).n_cycles == 5


def test_cycles_of_a_machine_that_starts_are_left_out_said_and_numbered():
    time, position = path(back([*LEAD, *strokes(50, 20)]))
    # strokes of 5 s between 4 and 5 m; two peaks are too low at the start
    low = np.select([time < 60, time < 70], [0.88, 0.94], 1.0)
    moved = np.where(position > 4, 4 + low * (position - 4), position)
    assert find(time, moved).n_cycles == 20
    # a stroke of constant speed has its amplitude from the first; a sine grows into it
    found = find(time, moved, waveform="sinusoidal")
    assert found.n_cycles == 18
    (one,) = [one for one in found.notes if one.code == "cycles-of-starting-machine"]
    assert one.numbers == {"n_first": 2, "n_last": 0}
    # creep began with them: a slope per decade of cycles numbers them
    np.testing.assert_array_equal(found.number, np.arange(3, 21))
    assert found.is_count_sure


@pytest.mark.parametrize("waveform", ["triangular", "sinusoidal"])
def test_a_cycle_in_which_a_generator_starts_again_is_left_out_and_counted(waveform):
    time = np.arange(0, 200.0, 0.1)
    # a third of a cycle on, within the tenth
    phase = time / 10 + np.where(time > 93, 0.35, 0.0)
    ramps = 1 - np.abs(2 * (phase % 1) - 1)
    wave = ramps if waveform == "triangular" else (1 - np.cos(2 * np.pi * phase)) / 2
    cycles = find(time, 4 + wave, waveform=waveform)
    lengths = time[cycles.last] - time[cycles.first]
    np.testing.assert_allclose(lengths, 10.0, atol=0.25)
    # the machine ran on: its number is that of the cycle
    assert np.setdiff1d(np.arange(1, cycles.number[-1] + 1), cycles.number).size == 1
    assert any("1 cycle differs in length from the others" in str(note)
               for note in cycles.notes)  # fmt: skip


def test_a_file_of_peaks_and_valleys_is_called_so():
    time = np.arange(0, 200.0)
    with pytest.raises(DataError, match="greatest and least value of each cycle") as refused:
        find(time, 4.2 + 0.1 * (-1) ** time)
    assert "saturated" not in str(refused.value)


def test_a_level_that_is_another_is_counted():
    time, position = path(back([*LEAD, *strokes(50, 20)]))
    low = np.where(time < 70, 0.6, 1.0)
    moved = np.where(position > 4, 4 + low * (position - 4), position)
    found = find(time, moved, waveform="sinusoidal")
    assert "cycles-of-starting-machine" not in {one.code for one in found.notes}


@pytest.mark.parametrize(
    ("begin", "end", "n_cycles"),
    [(12, 189, 16), (2, 189, 17), (1, 199, 18), (6, 194, 18), (0.2, 199.8, 20), (0, 200, 20)],
)
def test_a_record_that_begins_and_ends_in_a_cycle_counts_whole_ones(begin, end, n_cycles):
    time, position = path(strokes(0, 20))
    part = (time >= begin) & (time <= end)
    assert find(time[part], position[part]).n_cycles == n_cycles


def test_a_broken_first_half_cycle_is_noted():
    time, position = path(strokes(0, 20))
    cycles = find(time[20:], position[20:])
    assert cycles.n_cycles == 19
    assert cycles.notes == ()
    assert cycles.made == (
        "half cycles at the end of a run of cycles, short of the level of their neighbours, not counted: 1, "
        f"first near {time[20 + np.argmin(position[20:30])]:g} s",
    )


@pytest.mark.parametrize("share", [0.74, 0.80, 0.87, 0.93])
@pytest.mark.parametrize("edge", ["end", "begin", "stop", "gap"])
@pytest.mark.parametrize("waveform", ["triangular", "sinusoidal"])
def test_a_half_cycle_broken_off_at_an_edge_is_not_counted_and_the_rest_has_the_right_pace(
    share, edge, waveform
):
    # six cycles of 10 s, of the outermost half cycle only a share of the stroke
    time = np.arange(0, 60.05, 0.1)
    phase = np.arccos(1 - 2 * share) / np.pi if waveform == "sinusoidal" else share
    last = 55 + 5 * phase
    wave = 4.5 - 0.5 * np.cos(2 * np.pi * time / 10)
    if waveform == "triangular":
        wave = 5 - np.abs(time % 10 - 5) / 5
    kept = time <= last
    time, wave = time[kept], wave[kept]
    if edge == "begin":
        wave = wave[::-1]
    elif edge == "stop":
        time = np.arange(0, last + 30, 0.1)
        wave = np.concatenate([wave, np.full(time.size - wave.size, wave[-1])])
    elif edge == "gap":
        time = np.concatenate([time, time + 200])
        wave = np.concatenate([wave, wave])
    wave = wave + np.random.default_rng(5).normal(0, 0.001, wave.size)
    cycles = find(time, wave, waveform=waveform)
    n_whole = 10 if edge == "gap" else 5
    assert cycles.n_cycles == n_whole
    assert time[cycles.last] - time[cycles.first] == pytest.approx(10, abs=0.5)
    noted = [note for note in cycles.made if f"not counted: {n_whole // 5}, first near" in note]
    assert len(noted) == 1


@pytest.mark.parametrize("n_samples", [12, 19, 31])
def test_a_slow_log_that_misses_the_last_valley_by_less_than_a_sample_has_all_its_cycles(n_samples):
    # the outermost samples lie up to one sample's travel off the valleys, as the others do
    for shift in (0.2, 0.5, 0.8):
        time = np.arange(10 * n_samples) + shift
        stroke = 1 - np.abs(2 * (time / n_samples % 1) - 1)
        assert find(time, 3 + 2 * stroke).n_cycles == 10


def test_an_amplitude_that_decays_between_reversals_keeps_its_cycles_to_the_last_reversal():
    # 12 % less from one half cycle to the next, then away to slack
    levels = 4 + np.cumsum(np.concatenate([[0.0], (-1.0) ** np.arange(24) * 0.88 ** np.arange(24)]))
    points = [(0, 3), (20, 3), (40, 4)]
    points += [(50 + 5 * i, level) for i, level in enumerate(levels)]
    time, position = path([*points, (points[-1][0] + 5, 3), (points[-1][0] + 55, 3)], noise=0.0005)
    # ranges fall below the band of 0.1 typical stroke after the last counted ones
    cycles = find(time, position, band=0.02)
    assert cycles.n_cycles == 12


@pytest.mark.parametrize(("stands", "n_cycles"), [(1.0, 6), (30.0, 6), (0.0, 5)])
def test_a_machine_that_starts_from_a_stand_may_settle_in_its_first_stroke(stands, n_cycles):
    # the first stroke begins 12 % above the valleys that follow
    levels = [4.12, 5.0, *(level for _ in range(5) for level in (4.0, 5.0)), 4.0]
    points = [(stands + 5 * i, level) for i, level in enumerate(levels)]
    points = [(0, 4.12), *points] if stands else points
    assert find(*path(points)).n_cycles == n_cycles


def test_a_gap_of_the_record_ends_a_run_and_cycles_across_it_are_not_counted(twenty):
    time, position = twenty
    kept = (time < 103) | (time > 128)  # from cycle 6 on the way up to cycle 8 on the way down
    cycles = find(time[kept], position[kept])
    assert cycles.n_cycles == 17
    assert any("gaps in the record" in note for note in map(str, cycles.notes))
    missing = np.where(kept, position, np.nan)
    assert find(time, missing).n_cycles == 17


@pytest.mark.parametrize(("n_close", "is_told"), [(4, True), (14, False)])
def test_cycles_of_which_the_log_has_the_turns_alone_are_told(n_close, is_told):
    time, position = path([*LEAD, *strokes(50, 20)], noise=0.0)
    close, turns = time < 50 + 10 * n_close, np.isclose(time % 5, 0, atol=0.01)
    cycles = find(time[close | turns], position[close | turns])
    assert cycles.n_cycles == n_close
    told = [str(one) for one in cycles.notes if one.code == "cycles-by-turns"]
    assert bool(told) == is_told
    assert not told or (f"only {n_close} of about 2" in told[0] and "up to 90 s" in told[0])


def test_a_short_gap_does_not_end_a_run(twenty):
    time, position = twenty
    kept = (time < 103) | (time > 104)
    assert find(time[kept], position[kept]).n_cycles == 20


def test_levels_may_change_from_block_to_block_with_moves_between():
    first = strokes(20, 10)
    second = strokes(first[-1][0] + 20, 8, 6.0, 6.4, half=2)
    third = strokes(second[-1][0] + 15, 7, 3.5, 5.5, half=10)
    time, position = path(back([(0, 3), (10, 3), *first, *second, *third], after=20))
    assert find(time, position).n_cycles == 25


def test_levels_may_change_from_block_to_block_without_a_break():
    first = strokes(20, 10)
    second = strokes(first[-1][0], 8, 3.8, 5.2, half=7)
    time, position = path(back([(0, 3), (10, 3), *first, *second], after=20))
    assert find(time, position).n_cycles == 18


@pytest.mark.parametrize("starts", [1, -1])
@pytest.mark.parametrize("amplitudes", [(0.1, 0.05, 0.02), (0.02, 0.05, 0.1)])
@pytest.mark.parametrize("waveform", ["triangular", "sinusoidal"])
def test_cycles_between_two_amplitudes_are_left_out_and_noted(starts, amplitudes, waveform):
    # ten cycles of each amplitude about one mean, each block from the mean and back to it
    angle = np.arange(0, 30, 0.01)  # in cycles
    wave = np.sin(2 * np.pi * angle)
    if waveform == "triangular":
        wave = 2 / np.pi * np.arcsin(wave)
    ranges = np.repeat(amplitudes, 1000) * starts
    noise = np.random.default_rng(6).normal(0, 0.0001, angle.size)
    time, position = 5 * angle, 4 + ranges * wave + noise
    cycles = find(time, position, waveform=waveform, band=0.01)
    stroke = position[cycles.branch_last] - position[cycles.branch_first]
    amplitude = np.abs(stroke) / 2
    # every counted branch has one of the amplitudes, and both branches of a cycle the same
    nearest = np.argmin(np.abs(amplitude[..., None] - np.array(amplitudes)), axis=-1)
    assert amplitude == pytest.approx(np.array(amplitudes)[nearest], rel=0.05)
    assert (nearest[:, 0] == nearest[:, 1]).all()
    # rising from the mean, a block holds nine from valley to valley; else all ten of the last
    # end at a valley, and the record ends on the way up to the mean
    assert np.bincount(nearest[:, 0]).tolist() == [9, 9, 9]
    # at the border of two blocks the valleys differ: the pairs that hold it are no cycle
    noted = [note for note in map(str, cycles.notes) if "cycles between two amplitudes" in note]
    border = 5 * (9.75 if starts == 1 else 9.25)
    assert len(noted) == 1
    assert noted[0].startswith("2 transition cycles") and "not counted, first at " in noted[0]
    assert float(noted[0].split("first at ")[1][:-2]) == pytest.approx(border, abs=0.2)


@pytest.mark.parametrize("factor", [0.75, 0.85, 1.2, 1.3])
def test_an_amplitude_that_grows_or_decays_steadily_keeps_its_cycles(factor):
    # 30 % and less from one half cycle to the next, between two moves from and to slack
    ranges = 0.05 * factor ** (np.arange(10) if factor > 1 else np.arange(-9, 1))
    levels = 5 + np.cumsum(np.concatenate([[0.0], (-1.0) ** np.arange(10) * ranges]))
    points = [(0, 3), (20, 3)] + [(40 + 5 * i, level) for i, level in enumerate(levels)]
    time, position = path(back(points), noise=0.0001)
    assert find(time, position, band=0.02).n_cycles == 5


def test_a_growing_amplitude_counts_from_the_first_valley():
    time = np.arange(0, 100, 0.05)
    amplitude = 0.5 * np.minimum(time / 20, 1)
    noise = np.random.default_rng(2).normal(0, 0.001, time.size)
    # valleys at 1.5, 3.5, ... 99.5 s; the last rise is broken off
    wave = 4.5 + amplitude * np.sin(np.pi * time) + noise
    cycles = find(time, wave, waveform="sinusoidal")
    assert cycles.n_cycles == 49
    assert any(
        note.startswith("a sinusoidal waveform has no part at constant rate")
        for note in map(str, cycles.notes)
    )
    notes = map(str, find(time, wave, waveform="other").notes)
    assert any(note.startswith("a non-triangular waveform has no part") for note in notes)


@pytest.mark.parametrize("shape", ["triangle", "sine", "quantised"])
def test_19_samples_a_cycle_at_1_hz_are_enough(shape):
    time = np.arange(30 * 19 + 1.0)
    position = 3 + 2 * (1 - np.abs(2 * (time / 19 % 1) - 1))
    if shape == "sine":
        position = 4 - np.cos(2 * np.pi * time / 19)
    elif shape == "quantised":
        noise = np.random.default_rng(0).normal(0, 0.0012, time.size)
        position = np.round((position + noise) / 0.0037) * 0.0037
    cycles = find(time, position)
    assert cycles.n_cycles == 30
    kept = np.add.reduceat(cycles.is_in_trimmed_branch, cycles.first)
    assert (kept[:-1] >= 10).all()


def test_ragged_cycles_of_49_to_51_samples_are_counted():
    lengths = np.random.default_rng(8).integers(49, 52, 60)
    position = np.concatenate([4 + 1 - np.abs(2 * np.arange(n) / n - 1) for n in lengths])
    position = np.append(position, 4.0) + np.random.default_rng(1).normal(
        0, 0.002, lengths.sum() + 1
    )
    cycles = find(0.1 * np.arange(position.size), position)
    assert cycles.n_cycles == 60
    assert cycles.last - cycles.first == pytest.approx(lengths, abs=2)


def test_one_cycle_is_allowed_with_a_note():
    cycles = find(*path([(0, 3), (10, 3), (20, 5), (30, 3), (40, 3)]))
    assert cycles.n_cycles == 1
    assert "one cycle only: no cycle-to-cycle scatter can be given" in tuple(map(str, cycles.notes))


def test_a_count_that_differs_from_the_plan_is_noted(twenty):
    assert "20 complete cycles found, 25 planned" in tuple(
        map(str, find(*twenty, expected_cycles=25).notes)
    )
    assert not any("planned" in note for note in map(str, find(*twenty, expected_cycles=20).notes))


def test_a_stated_band_is_used(twenty):
    assert find(*twenty, band=0.3).band == 0.3
    assert find(*twenty, band=0.9).n_cycles == 20


def test_control_by_load_finds_reversals_of_tension_and_its_rate(twenty):
    cycles = find(*twenty, control="load")
    assert cycles.n_cycles == 20
    assert cycles.plateau_rate == pytest.approx(0.2 * 90, rel=0.02)
    assert cycles.band == pytest.approx(0.1 * 90, rel=0.1)


@pytest.mark.parametrize("amplitude", [8.0, 20.0])
@pytest.mark.parametrize("from_below", [True, False])
def test_a_sine_that_begins_and_ends_at_its_mean_counts_whole_cycles_only(amplitude, from_below):
    # up to the mean of 20, ten cycles from there, away to zero: half a range at each end
    time = np.arange(0, 130, 0.1)
    angle = np.clip(time - 10, 0, 100) / 10 * 2 * np.pi
    wave = amplitude * np.sin(angle) * (1 if from_below else -1)
    mean = np.interp(time, [0, 10, 110, 120, 130], [0, 20, 20, 0, 0])
    tension = mean + wave + np.random.default_rng(4).normal(0, 0.02, time.size)
    stand = find_standstills(time, tension, tension[None], settings=PhaseSettings())
    settings = CycleSettings(control="load", waveform="sinusoidal")
    cycles = find_cycles(time, tension, tension, stand, settings=settings)
    ranges = tension[cycles.branch_last[:, 0]] - tension[cycles.branch_first[:, 0]]
    assert cycles.n_cycles == 9
    assert ranges == pytest.approx(2 * amplitude, rel=0.01)
    assert cycles.last - cycles.first == pytest.approx(100, abs=4)
    # the two half cycles at the ends are the tenth that was planned; two more were not made
    for planned, code in ((10, "planned-cycles-not-whole"), (12, "cycles-not-as-planned")):
        settings = CycleSettings(control="load", waveform="sinusoidal", expected_cycles=planned)
        notes = find_cycles(time, tension, tension, stand, settings=settings).notes
        assert [one.code for one in notes if "planned" in one.code] == [code]


@pytest.mark.parametrize("control", ["position", "load"])
@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_a_constant_channel_is_refused(control, noise):
    time, position = path([(0, 4), (100, 4)], noise=noise)
    name = "crosshead position" if control == "position" else "tension"
    with pytest.raises(DataError, match=f"no cycle: {name} does not reverse; found .* needed two"):
        find(time, position, control=control)


def test_a_single_pull_is_refused():
    with pytest.raises(DataError, match='1 movements of .* m or more; .* kind = "tensile"'):
        find(*path([(0, 3), (10, 3), (20, 5), (60, 5)]))


def test_a_pull_that_bounces_where_the_specimen_parts_is_said_to_be_one():
    time, position = path([(0, 3), (10, 3), (100, 5), (120, 5.4)], noise=0)
    position[1000:1016] += 0.4 * np.tile([1, -1], 8)
    with pytest.raises(DataError, match='too few samples .* bounced .* kind = "tensile"'):
        find(time, position)


def test_no_cycle_runs_over_smaller_ones_that_the_band_hides():
    """A protocol of growing amplitude: the first pair of turns had two cycles of half its range."""
    sizes = np.repeat([1.0, 1.5, 3, 6, 12, 20], 3)
    turns = np.concatenate([[0.0], np.stack([sizes, -sizes], axis=1).ravel(), [0.0]])
    begins = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(turns)))])
    time = np.arange(0, begins[-1], 0.1)
    position = np.interp(time, begins, turns)
    cycles = find(time, position + 100)
    for first, last in zip(cycles.first, cycles.last, strict=True):
        one = position[first : last + 1]
        assert 2 * np.ptp(one) == pytest.approx(np.abs(np.diff(one)).sum(), rel=0.2)
    # the cycle on the way to 6, and the first of each amplitude that is reached from a smaller one
    assert cycles.n_cycles == 11


def test_movements_that_never_repeat_are_refused():
    points = [(0, 3), (10, 3), (20, 5), (50, 5), (60, 4), (90, 4), (100, 6), (130, 6), (140, 3)]
    with pytest.raises(
        DataError, match="no whole cycle; found 4 movements .* without a standstill"
    ):
        find(*path(points))


def test_what_is_let_back_to_no_load_is_a_cycle_of_load_and_the_message_says_so():
    # synthetic: a foil is pulled by 50 mm and let back to no load, where it is 9 mm longer
    time = np.arange(0, 9.01, 0.1)
    position = 1e-3 * np.interp(time, [0, 5, 9], [0, 50, 9])
    tension = 1e-3 * np.interp(time, [0, 2, 5, 9], [0, 450, 700, 0])[None]
    stands = find_standstills(time, position, tension, settings=PhaseSettings())
    with pytest.raises(DataError, match='no whole cycle.* state control = "load"'):
        find_cycles(time, position, tension, stands, settings=CycleSettings())
    settings = CycleSettings(control="load")
    assert find_cycles(time, position, tension, stands, settings=settings).n_cycles == 1


def test_the_counter_of_the_machine_numbers_the_cycles(twenty):
    time, position = twenty
    counter = np.where((time >= 50) & (time < 250), ((time - 50 + 1e-6) // 10 + 1), 0).astype(int)
    cycles = find(time, position, counter=counter)
    assert cycles.counted_by == "reversals"
    assert cycles.number.tolist() == list(range(1, 21))
    assert cycles.first.tolist() == (500 + 100 * np.arange(20)).tolist()
    # of 10 s, at ten readings a second
    assert cycles.last.tolist() == (600 + 100 * np.arange(20)).tolist()
    assert not any("machine" in note for note in map(str, cycles.notes))


def test_a_counter_that_disagrees_with_the_reversals_is_noted(twenty):
    time, position = twenty
    counter = np.where((time >= 50) & (time < 230), ((time - 50 + 1e-6) // 10 + 1), 0).astype(int)
    cycles = find(time, position, counter=counter)
    assert cycles.n_cycles == 18
    note = "the machine counted 18 cycles with a stroke, but the reversals give 20 complete cycles"
    assert note in tuple(map(str, cycles.notes))


def test_counted_cycles_that_are_missing_or_without_stroke_are_noted(twenty):
    time, position = twenty
    counter = np.where((time >= 50) & (time < 250), ((time - 50 + 1e-6) // 10 + 1), 0).astype(int)
    counter[time >= 265] = 22
    notes = tuple(map(str, find(time, position, counter=counter).notes))
    assert "1 machine-counted cycles have no stroke, first machine cycle 22" in notes
    assert "the log contains 21 of the machine cycles 1 to 22: 22 follows 20" in notes


def test_a_table_of_one_row_a_cycle_is_refused_as_such():
    time = 4.0 * np.arange(60)
    greatest = 1.13 + 1e-5 * np.sin(np.arange(60))
    with pytest.raises(DataError, match=r"one row per cycle; found 60 rows.*reduction surface"):
        find(time, greatest, counter=np.arange(1, 61))


def test_a_counter_that_never_changes_is_not_used(twenty):
    cycles = find(*twenty, counter=np.ones(twenty[0].size, dtype=int))
    assert cycles.n_cycles == 20
    assert cycles.counted_by == "reversals"
    assert any(
        note.startswith("the machine's cycle counter never changes")
        for note in map(str, cycles.notes)
    )


def test_branches_without_a_constant_rate_are_noted(twenty):
    time, position = twenty
    counter = np.where((time >= 50) & (time < 250), ((time - 50 + 1e-6) // 10 + 1), 0).astype(int)
    position[(time >= 265) & (time < 275)] = np.nan
    counter[(time >= 265) & (time < 275)] = 30  # a cycle that the machine stored alone
    notes = tuple(map(str, find(time, position, counter=counter).notes))
    assert any(
        note.startswith("2 of 42 branches have no part at a constant rate") for note in notes
    )


def test_phases_of_a_test(twenty):
    time, position = twenty
    tension = np.stack([100 * (position - 3)])
    stand = find_standstills(time, position, tension, settings=PhaseSettings())
    cycles = find_cycles(time, position, tension, stand, settings=CycleSettings())
    phase = label_phases(time, standstills=stand, cycles=cycles)
    value = {when: phase[int(10 * when)] for when in (10, 30, 45, 150, 255, 290)}
    names = ["rest", "approach", "hold", "cycling", "approach", "rest"]
    assert list(value.values()) == [PHASE_VALUES[name] for name in names]
    assert phase.dtype == np.int8


def test_dwells_are_cycling_in_the_phases():
    time, position = path(back([*LEAD, *strokes(50, 5, dwell_high=10)]))
    tension = np.stack([100 * (position - 3)])
    stand = find_standstills(time, position, tension, settings=PhaseSettings())
    cycles = find_cycles(time, position, tension, stand, settings=CycleSettings())
    phase = label_phases(time, standstills=stand, cycles=cycles)
    assert (phase[cycles.first[0] : cycles.last[-1]] == PHASE_VALUES["cycling"]).all()


@pytest.mark.parametrize("n_cycles", [6, 12, 40])
def test_regular_cycles_that_are_small_beside_the_pull_are_found(n_cycles):
    # a pull of 2 m, and cycles of 40 mm at its end
    pull = [(0, 3), (20, 3), (30, 5.02), (40, 5.02), (43, 4.98)]
    time, position = path(back([*pull, *strokes(43, n_cycles, 4.98, 5.02)[1:]]), noise=2e-4)
    cycles = find(time, position)
    assert cycles.n_cycles == n_cycles
    assert cycles.band == pytest.approx(0.004, rel=0.1)
    assert time[cycles.first] == pytest.approx(43 + 10 * np.arange(n_cycles), abs=0.3)
    (told,) = (one for one in cycles.notes if one.code == "cycles-small")
    assert told.numbers["stroke"] == pytest.approx(0.04, rel=0.05)


def test_irregular_movements_that_are_small_beside_the_pull_are_no_cycles():
    swings = np.random.default_rng(5).uniform(0.002, 0.04, 24) * np.tile([1, -1], 12)
    ripple = [(45.0 + 5 * place, 4.9 + swing) for place, swing in enumerate(swings)]
    time, position = path(back([(0, 3), (20, 3), (30, 5), (40, 5), *ripple]), noise=2e-4)
    with pytest.raises(DataError, match="no whole cycle|no cycle"):
        find(time, position)


def test_the_way_over_the_mean_to_slack_is_no_cycle_where_the_specimen_recovers_there():
    """Twelve sines of 1 kN about 1.02 kN in 60 s; then to the mean, and slack in 4 s."""
    at = np.arange(0, 110, 1 / 16)
    cycling = 1020 + 1000 * np.sin(2 * np.pi * 0.2 * np.clip(at - 15, 0, 60))
    load = np.where(at < 15, np.interp(at, [0, 5, 10], [0, 0, 1020]), cycling)
    load[at > 75] = np.interp(at[at > 75], [75, 79], [1020, 0])
    load += np.random.default_rng(2).normal(0, 3, at.size)
    # it goes on back while the load is zero: no standstill
    position = 3 + load / 5e4 + 0.05 * np.exp(-np.clip(at - 79, 0, None) / 20) * (at > 79)
    stand = find_standstills(at, position, load[None], settings=PhaseSettings())
    assert not (stand.first > np.searchsorted(at, 79)).any()
    settings = CycleSettings(waveform="sinusoidal", control="load")
    cycles = find_cycles(at, load, load[None], stand, settings=settings)
    amplitude = load[cycles.branch_last[:, 0]] - load[cycles.branch_first[:, 0]]
    np.testing.assert_allclose(amplitude, 2000, rtol=0.01)
    assert cycles.n_cycles == 11


@pytest.mark.parametrize("share", [0.5, 0.55])  # of the stroke, from the last valley to the mean
def test_the_way_from_the_last_valley_over_the_mean_to_slack_is_no_cycle(share):
    """Twelve sines of 260 N about 300 N in 30 s; then to the mean, and slack in 8 s."""
    at = np.arange(0, 78.5, 1 / 16)
    ends = [0, 5, 13, 33]  # slack, up, held at the mean, down to the valley
    angle = 2 * np.pi * 0.4 * (at - 38)
    way = 40 + 520 * share
    load = np.interp(at, [*ends, 38, 68, 68.625, 76.6, 90], [0, 0, 300, 300, 40, 40, way, 0, 0])
    cycling = (at >= 38) & (at <= 68)
    load[cycling] = 300 - 260 * np.cos(angle[cycling])
    load += np.random.default_rng(2).normal(0, 0.3, at.size)
    found = find(at, load, waveform="sinusoidal")
    assert found.n_cycles == 12


@pytest.mark.parametrize("behind", [0.1, 0.3])
def test_a_sample_of_constant_rate_has_the_branch_that_moves_its_way(behind):
    """Sharp corners ``behind`` a reading by that share of a step, in step with the log.

    The greatest reading stands on the way down there, the least on the way up; labelled as the end
    of the other branch, it would bring the tension of this one to it.
    """
    points = strokes(50, 12, half=1.0)
    time, position = path(back([*LEAD, *points]), noise=0.0)
    position = np.interp(time - 0.1 * (1 - behind), time, position)
    cycles = find(time, position)
    kept = cycles.is_in_trimmed_branch & (time > 51) & (time < 73)
    up = np.mod(time - 0.1 * (1 - behind) - 50, 2) < 1
    for name, way in (("ascending", up), ("descending", ~up)):
        of_branch = kept & (cycles.branch == BRANCH_VALUES[name])
        assert of_branch.sum() > 90 and way[of_branch].all()


@pytest.mark.parametrize("dwell", [2.9, 3.3])
def test_dwells_of_which_the_readings_show_some_long_enough_for_a_standstill_end_no_run(dwell):
    """Held for about 3 s at peaks and valleys, read every .79 s: four or five readings a dwell."""
    lead = [(0, 3), (20, 3), (30, 4)]
    ramps = strokes(30, 20, half=6.7, dwell_low=dwell, dwell_high=dwell)
    time, position = path(back([*lead, *ramps[:-1]]), rate=1 / 0.787, noise=1e-4)
    cycles = find(time, position, waveform="other")
    assert cycles.n_cycles == 20
    lasting = np.diff(time[cycles.first])
    assert lasting == pytest.approx(2 * (6.7 + dwell), abs=dwell + 0.8)

import numpy as np
import pytest

from reduction.pipeline.reduce_test import _with_late_readings
from reduction.readers.sample_flags import _is_interpolated, flag_record
from reduction.record.contributions import InstrumentErrors
from reduction.record.errors import DataError
from reduction.record.measurement import Quality, Record
from reduction.record.settings import QualitySettings

RANDOM = np.random.default_rng(20051010)
TIME = np.arange(0, 200, 0.1)
WAVE = np.abs(TIME % 20 - 10)


def record(*, time=TIME, position=None, load=None, **settings):
    return Record(
        test_id="T-1",
        specimens=("new",),
        time=np.array(time, float),
        crosshead_position=6.0 + 0.1 * WAVE + RANDOM.normal(0, 1e-3, TIME.size)
        if position is None
        else np.array(position, float),
        tension=(200 + 10 * WAVE + RANDOM.normal(0, 0.3, TIME.size) if load is None else load)[
            np.newaxis
        ],
        quality_flag=np.zeros((1, len(time)), dtype=np.uint16),
        crosshead_position_quality_flag=np.zeros(len(time), dtype=np.uint16),
        n_rows_read=len(time),
        **settings,
    )


def flagged(one, **settings):
    return flag_record(one, settings=QualitySettings(), **settings)


def where(flags, mask):
    return np.flatnonzero(flags & mask).tolist()


def test_a_clean_record_gets_no_flag_and_no_note():
    result = flagged(record(notes=("kept",)))
    assert not result.quality_flag.any() and not result.crosshead_position_quality_flag.any()
    assert tuple(map(str, result.notes)) == ("kept",)


def test_a_buffer_that_a_logger_writes_twice_or_late_is_put_in_order():
    plain = flagged(record())
    place, load = plain.crosshead_position, plain.tension[0]
    twice = np.r_[0:1000, 872:2000]
    late = np.r_[0:1000, 1064:1128, 1000:1064, 1128:2000]
    beside = np.sort(np.r_[0:2000, 5:2000:20])
    for rows, words in (
        (twice, "repeated rows (same time and readings) are left out: 128"),
        (beside, "repeated rows (same time and readings) are left out: 100"),
        (late, "rows are sorted by time, which goes back at 1 of them"),
    ):
        found = flagged(record(time=TIME[rows], position=place[rows], load=load[rows]))
        np.testing.assert_array_equal(found.time, TIME)
        np.testing.assert_array_equal(found.crosshead_position, place)
        np.testing.assert_array_equal(found.tension[0], load)
        assert not found.crosshead_position_quality_flag.any()
        assert words in str(found.notes[0])


def test_no_spike_is_where_a_log_goes_on_at_another_rate():
    # every tenth cycle of 2 s at 100 Hz and the others at 2 Hz
    fine = np.arange(0, 200, 0.01)
    time = fine[(fine % 20 < 2) | (np.arange(fine.size) % 50 == 0)]
    place = -np.cos(np.pi * time) + RANDOM.normal(0, 1e-4, time.size)
    load = 100 * np.exp(2 * place)
    found = flagged(record(time=time, position=6 + place, load=load))
    assert not where(found.quality_flag[0], Quality.SPIKE)
    load = load.copy()
    load[300] += 2000.0  # within a burst
    found = flagged(record(time=time, position=6 + place, load=load))
    assert where(found.quality_flag[0], Quality.SPIKE) == [300]


def test_a_drop_out_of_an_uneven_log_is_a_spike():
    # readings as two instruments answer, 0.1 or 0.2 s apart; the position reads 0 for one of them
    steps = np.where(np.random.default_rng(4).random(600) < 0.6, 0.1, 0.2)
    time = np.cumsum(steps)
    place = 6.0 + np.clip(time - 10, 0, 12) / 60
    lost = [250, 400, 520]
    assert any(max(steps[row - 6 : row + 6]) > 1.9 * min(steps[row - 6 : row + 6]) for row in lost)
    place[lost] = 6.0
    load = 100 * np.clip(time - 10, 0, 12) + RANDOM.normal(0, 1.0, time.size)
    found = flagged(record(time=time, position=place, load=load))
    assert where(found.crosshead_position_quality_flag, Quality.SPIKE) == lost


def test_an_extensometer_that_drops_out_is_not_read_there():
    strain = 0.01 * WAVE + RANDOM.normal(0, 1e-5, TIME.size)
    lost = np.r_[350:354, 755:762]
    strain[lost] = 0.0
    found = flagged(record(measured_strain=strain[np.newaxis]))
    assert np.flatnonzero(np.isnan(found.measured_strain[0])).tolist() == lost.tolist()
    assert "11 readings of the extensometer jump away" in str(found.notes[0])


@pytest.mark.parametrize("slip", [0.15, 0.3])
def test_a_clock_that_slips_back_is_flagged_and_not_sorted(slip):
    time = TIME.copy()
    time[1000:] -= slip
    found = flagged(record(time=time))
    assert found.n_samples == TIME.size
    assert where(found.crosshead_position_quality_flag, Quality.REPEATED_OR_BACKWARD_TIME)


def test_every_fault_gets_its_mask_and_a_line_in_the_notes():
    load = 200 + 10 * WAVE + RANDOM.normal(0, 0.3, TIME.size)
    position = 6.0 + 0.1 * WAVE + RANDOM.normal(0, 1e-3, TIME.size)
    time = TIME.copy()
    load[100], load[300] = np.nan, 500.0
    load[730:830] = load[730]
    position[55] = np.nan
    time[1500:] += 3.0
    time[1700] = time[1699]
    result = flagged(record(time=time, position=position, load=load))
    assert where(result.quality_flag[0], Quality.MISSING) == [100]
    assert where(result.quality_flag[0], Quality.SPIKE) == [300]
    assert where(result.quality_flag[0], Quality.STUCK) == list(range(730, 830))
    along = result.crosshead_position_quality_flag
    assert where(along, Quality.MISSING) == [55]
    assert where(along, Quality.GAP) == [1500]
    assert where(along, Quality.REPEATED_OR_BACKWARD_TIME) == [1700]
    assert str(result.notes[-1]).startswith(
        "flagged, of 2000 rows: crosshead_position missing 1, gap 1, "
        "repeated_or_backward_time 1; tension of new missing 1, stuck 100, spike 1. Saturated and "
    )


def test_the_last_reading_of_a_machine_that_stops_makes_no_uneven_rate():
    time = TIME.copy()
    time[-1] -= 0.07
    assert not flagged(record(time=time)).notes
    time[1000] += 0.05
    assert [one.code for one in flagged(record(time=time)).notes] == ["sampling-uneven"]


def test_a_saturated_run_is_not_called_stuck_as_well():
    load = np.minimum(200 + 10 * WAVE, 260.0)
    result = flagged(record(load=load))
    assert where(result.quality_flag[0], Quality.SATURATED)
    assert not where(result.quality_flag[0], Quality.STUCK)


def test_a_spike_of_the_load_does_not_make_a_resting_crosshead_stuck():
    place = np.maximum(6.0 + 0.1 * WAVE, 6.3)  # stands for six seconds in every twenty
    load = 200 + 1000 * (place - 6.0) + RANDOM.normal(0, 0.3, TIME.size)
    load[500] += 600
    result = flagged(record(position=place, load=load))
    assert where(result.quality_flag[0], Quality.SPIKE) == [500]
    assert not where(result.crosshead_position_quality_flag, Quality.STUCK)


def test_an_uneven_rate_is_a_note():
    time = np.cumsum(np.tile(6 * [0.1] + 2 * [0.15], TIME.size // 8))
    (note,) = map(str, flagged(record(time=time)).notes)
    assert note == (
        "the sampling rate is not constant: 500 of 1999 time steps differ by more than 20 % from "
        "their median 0.1 s (0.1 to 0.15 s, not counting gaps)"
    )


def test_resampled_channels_are_flagged_throughout():
    result = flagged(record(), resampled=("tension.1", "crosshead_position"))
    assert np.all(result.quality_flag & Quality.RESAMPLED)
    assert np.all(result.crosshead_position_quality_flag & Quality.RESAMPLED)


def test_a_channel_without_a_number_is_refused():
    empty = np.full(TIME.size, np.nan)
    with pytest.raises(DataError, match="tension of 'new' holds no number; found 2000 missing"):
        flagged(record(load=empty))
    with pytest.raises(DataError, match="crosshead_position holds no number"):
        flagged(record(position=empty))
    with pytest.raises(DataError, match="time holds no number"):
        flagged(record(time=empty))


def test_missing_stamps_are_bridged_and_position_is_not_used_there():
    time = TIME.copy()
    time[[0, 1, 500, 501, 502, -1]] = np.nan
    result = flagged(record(time=time))
    np.testing.assert_allclose(result.time, TIME, atol=1e-9)
    along = result.crosshead_position_quality_flag
    assert where(along, Quality.MISSING) == [0, 1, 500, 501, 502, TIME.size - 1]
    assert str(result.notes[0]).startswith("6 rows have no time, first at sample 1: ")


def test_rows_that_hold_nothing_of_a_test_at_its_end_are_no_fault():
    time, position, load = TIME.copy(), record().crosshead_position.copy(), 200 + 10 * WAVE
    for series in (time, position, load):
        series[900:] = np.nan
    (first, *_) = flagged(record(time=time, position=position, load=load)).notes
    assert (first.code, first.severity) == ("rows-after-the-end", "note")
    assert first.numbers == {"n_rows": TIME.size - 900, "sample": 901}
    # a load without time and position is no end
    load[-1] = 1.0
    (first, *_) = flagged(record(time=time, position=position, load=load)).notes
    assert (first.code, first.severity) == ("rows-without-time", "warning")


def test_a_gap_among_missing_stamps_is_seen():
    time = TIME.copy()
    time[500:] += 30.0
    time[500:502] = np.nan
    assert where(flagged(record(time=time)).crosshead_position_quality_flag, Quality.GAP)


def test_a_length_of_zero_is_flagged_where_it_is_rare_and_refused_where_it_is_not():
    position = 6.0 + 0.1 * WAVE + RANDOM.normal(0, 1e-3, TIME.size)
    position[100:115] = 0.0
    along = flagged(record(position=position)).crosshead_position_quality_flag
    assert where(along, Quality.SPIKE) == list(range(100, 115))
    with pytest.raises(DataError, match=r"length is not positive; found 100 % .* least -\d"):
        flagged(record(position=position - 9.0))
    shifted = record(position=position - 9.0, position_is_length=False)
    assert not where(flagged(shifted).crosshead_position_quality_flag, ~np.uint16(0))


def test_a_position_that_is_constant_under_cycles_of_load_is_refused():
    words = (
        r"the crosshead position has no sample that can be used; found 2000 samples missing or "
        r"stuck at 3.7 m while tension changes; needed .* follows the crosshead. Is it the right"
    )
    with pytest.raises(DataError, match=words):
        flagged(record(position=np.full(TIME.size, 3.7)))


def test_a_load_cell_that_says_nothing_is_refused():
    with pytest.raises(DataError, match="tension of 'new' is zero throughout; found 2000 samples"):
        flagged(record(load=np.zeros(TIME.size)))
    with pytest.raises(DataError, match="'new' has no sample that can be used; .* stuck at 5 N"):
        flagged(record(load=np.full(TIME.size, 5.0)))


def test_an_even_clock_that_is_written_in_coarse_steps_is_even():
    true = 3.02 + np.arange(TIME.size) / 7
    result = flagged(record(time=np.round(true, 1)))
    np.testing.assert_allclose(result.time - true, 0.0, atol=0.01)
    np.testing.assert_allclose(np.diff(result.time), 1 / 7, rtol=1e-4)
    assert tuple(map(str, result.notes)) == (
        "time is written in steps of 0.1 s: readings are treated as evenly spaced,"
        " 0.142857 s apart, which agrees with all logged times",
    )


@pytest.mark.parametrize("late", [0.0, 0.4])
def test_times_that_no_even_clock_would_be_written_as_stay_as_they_are(late):
    # two rates, and one rate with a pause of three steps
    rate = 7 if late else np.where(np.arange(TIME.size) < TIME.size // 2, 7, 8)
    true = np.cumsum(1 / rate * np.ones(TIME.size)) + late * (np.arange(TIME.size) > 900)
    stamps = np.round(true, 1)
    np.testing.assert_array_equal(flagged(record(time=stamps)).time, stamps)


@pytest.mark.parametrize("lost", [[70], [500, 1500]])
def test_times_beside_a_lost_row_stay_as_they_are(lost):
    # one or two double steps in such places also agree with an even, slightly slower clock
    stamps = np.delete(np.arange(TIME.size + len(lost)) / 10, lost)
    np.testing.assert_array_equal(flagged(record(time=stamps)).time, stamps)


@pytest.mark.parametrize("every", [2, 5])
def test_a_channel_that_is_read_less_often_than_logged_is_not_late(every):
    rows = np.arange(TIME.size) // every * every
    position = 4 + 0.5 * np.sin(0.7 * TIME[rows]) + RANDOM.normal(0, 1e-5, TIME.size)[rows]
    load = 200 + 100 * np.sin(0.7 * TIME) + RANDOM.normal(0, 0.3, TIME.size)
    found = flagged(record(position=position, load=load))
    assert found.n_samples == TIME.size // every
    np.testing.assert_allclose(found.time, TIME[::every])
    # the load is a line of the position without a lag: half of five rows would be 5 N
    off = found.tension[0] - (200 + 200 * (found.crosshead_position - 4))
    assert np.std(off) < 0.4
    (note,) = (one for one in found.notes if one.code == "read-less-often")
    assert (note.severity, note.numbers["every"]) == ("warning", every)
    # it may be late by anything up to a row
    (errors,) = _with_late_readings(found, [InstrumentErrors("new", lag=0.01)])
    assert errors.lag == pytest.approx(np.hypot(0.01, 0.1 / np.sqrt(3)))
    # rows without a position are no new readings of it
    gap = position.copy()
    gap[300:420] = np.nan
    assert flagged(record(position=gap, load=load)).n_samples == TIME.size // every
    # where the load repeats with it nothing is late
    both = flagged(record(position=position, load=load[rows]))
    assert both.n_samples == TIME.size // every
    assert [one.code for one in both.notes if one.severity == "warning"] == []


def test_a_coarse_converter_and_a_rest_are_no_repeated_readings():
    slow = 4 + 0.5 * np.sin(0.7 * TIME)
    load = 200 + 100 * np.sin(0.7 * TIME) + RANDOM.normal(0, 0.3, TIME.size)
    for position in (np.round(slow, 2), np.round(slow, 3), np.minimum(slow, 4.2)):
        assert flagged(record(position=position, load=load)).n_samples == TIME.size


@pytest.mark.parametrize(("jump", "spikes"), [(0.0, []), (0.004, [1500])])
def test_one_step_of_a_channel_written_with_four_digits_is_no_spike(jump, spikes):
    noise = np.random.default_rng(1).normal(0, 1e-4, TIME.size)
    moved = np.interp(TIME, [0, 20, 100, 130], [0.3, 0.9, 0.9, 1.15728]) + noise
    written = np.array([float(f"{one:.4g}") for one in moved])  # by 0.0001 below 1, 0.001 above
    written[1500] += jump
    found = flagged(record(position=5 + written))
    assert where(found.crosshead_position_quality_flag, Quality.SPIKE) == spikes


@pytest.mark.parametrize(("dip", "spikes"), [(0.09, []), (0.9, [600])])
def test_a_dip_of_less_than_a_ten_thousandth_of_the_range_is_no_spike(dip, spikes):
    """A plateau that a good load cell reads to 4 mN: the dip is twenty times that."""
    load = np.minimum(2 * np.arange(TIME.size), 1000.0)
    load += np.random.default_rng(0).normal(0, 0.004, TIME.size)
    load[600] -= dip
    one = flagged(record(position=6 + 1e-3 * np.arange(TIME.size), load=load))
    assert where(one.quality_flag[0], Quality.SPIKE) == spikes


@pytest.mark.parametrize("ratio", [2.0, 2.94, 5.0])
def test_a_channel_that_was_interpolated_before_it_was_logged_is_told(ratio):
    own = np.arange(0, 200, 0.1 * ratio)
    read = 4 + 0.5 * np.sin(0.7 * own) + RANDOM.normal(0, 1e-3, own.size)
    time = TIME[own[-1] > TIME]
    rows = np.round(np.interp(time, own, read), 7)
    load = 200 + 100 * np.sin(0.7 * time) + RANDOM.normal(0, 0.3, time.size)
    codes = [one.code for one in flagged(record(time=time, position=rows, load=load)).notes]
    assert codes.count("interpolated-by-logger") == 1
    # neither white noise nor coarse codes nor a wave without noise is
    for noise, step in ((1e-3, 1e-7), (1e-3, 1e-3), (1e-4, 1e-3), (2e-3, 1e-3), (0.0, 1e-7)):
        plain = 4 + 0.5 * np.sin(0.7 * time) + RANDOM.normal(0, noise, time.size)
        found = flagged(record(time=time, position=np.round(plain / step) * step, load=load))
        assert "interpolated-by-logger" not in [one.code for one in found.notes]


@pytest.mark.parametrize("readings", [22.7, 43.7, 61.3])
@pytest.mark.parametrize("rest", [0.0, 0.3])
def test_ramps_from_turn_to_turn_were_not_interpolated(readings, rest):
    turn = np.arange(6000) / readings % 1
    ends = [0, (1 - rest) / 2, 0.5, 1 - rest / 2, 1]
    wave = 4 + 0.5 * np.interp(turn, ends, [-1, 1, 1, -1, -1])
    rng = np.random.default_rng(3)
    # noise of one step of the converter, of a third of it, far below it, and of a thousandth
    for noise, step in ((1e-4, 1e-4), (1e-4, 3e-5), (1e-5, 1e-4), (1e-3, 1e-7), (0.0, 1e-7)):
        read = np.round((wave + noise * rng.normal(size=wave.size)) / step) * step
        assert not _is_interpolated(read)
    # the same wave, read every third row and interpolated, is told
    rows = wave[::3] + 1e-3 * rng.normal(size=2000)
    assert _is_interpolated(np.interp(np.arange(5998), 3.0 * np.arange(2000), rows))


def test_a_ramp_before_the_cycles_does_not_hide_that_a_logger_interpolated():
    """Synthetic: a ramp, then twelve readings per cycle, written three times as often."""
    own = np.arange(0, 900.0)
    wave = np.where(own < 40, own / 80, 0.5 + np.sin(2 * np.pi * (own - 40) / 12.3) / 2)
    rows = np.interp(np.arange(0, 899, 1 / 3), own, wave)
    assert _is_interpolated(np.round(rows, 5))


def test_a_clock_that_stands_still_is_named_as_the_cause():
    time = np.repeat(np.unique(np.round(TIME[::2] ** 1.001, 1)), 2)[: TIME.size]
    (note, *_) = (
        str(one) for one in flagged(record(time=time)).notes if one.code == "rows-flagged"
    )
    assert "The clock of the log stands still" in note and "state sample_interval" in note
    assert "spike_factor" not in note

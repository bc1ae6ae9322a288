from dataclasses import replace

import numpy as np
import pytest

from reduction.readers.layout import Layout
from reduction.readers.raw_log import RawLog
from reduction.readers.record_in_si import to_record
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Quality, Source
from reduction.record.notes import note
from reduction.record.settings import QualitySettings

FOOT, POUND = 0.3048, 4.4482216152605
TIME = np.arange(0, 20, 0.1)
POSITION = 19 + np.abs(TIME % 10 - 5)
LOAD = 50 + 10 * np.abs(TIME % 10 - 5)
CHANNELS = {
    "time": {"column": "t", "unit": "s"},
    "crosshead_position": {"column": "x", "unit": "ft", "datum": "pin-to-pin"},
    "tension.1": {"column": "a", "unit": "lbf"},
    "tension.2": {"column": "b", "unit": "lbf"},
}


def channels(**changes):
    """The channels, with a change to some; ``tension_1`` stands for ``tension.1``."""
    result = dict(CHANNELS)
    for key, change in changes.items():
        name = key.replace("_", ".") if key[-1].isdigit() else key
        result[name] = result.get(name, {"column": name}) | change
    return result


def log(columns=None, *, name="T-1.csv", row=None, **settings):
    values = {
        "time": TIME,
        "crosshead_position": POSITION,
        "tension.1": LOAD,
        "tension.2": 2 * LOAD,
    }
    values |= {key: np.asarray(value, float) for key, value in (columns or {}).items()}
    return RawLog(
        source=Source(name, "0" * 64, 1),
        columns=values,
        first_row=4,
        row=row,
        n_rows_read=values["time"].size,
        **settings,
    )


def layout(declared=None, **settings):
    return Layout(format="delimited", channels=declared or CHANNELS, **settings)


def convert(*logs, specimens=("new", "used"), **settings):
    return to_record(
        logs, test_id="T-1", specimens=specimens, quality=QualitySettings(), **settings
    )


def test_feet_and_pounds_become_metres_and_newtons():
    record = convert((log(), layout()))
    np.testing.assert_allclose(record.crosshead_position, POSITION * FOOT, rtol=1e-15)
    np.testing.assert_allclose(record.tension, np.array([LOAD, 2 * LOAD]) * POUND, rtol=1e-15)
    assert (record.test_id, record.specimens) == ("T-1", ("new", "used"))
    assert record.position_is_length and record.n_rows_read == TIME.size
    assert record.measured_strain is None and record.cycle_counter is None
    assert tuple(map(str, record.notes)) == () and not record.quality_flag.any()


def test_zero_is_taken_off_before_the_sign_is_applied():
    declared = channels(tension_1={"unit": "kN", "sign": -1, "zero": "-16 N"})
    record = convert((log({"tension.1": -LOAD / 1000 - 0.016}), layout(declared)))
    np.testing.assert_allclose(record.tension[0], LOAD)


def test_a_factor_turns_volts_into_the_unit():
    declared = channels(tension_1={"unit": "lbf", "factor": 100.0})
    record = convert((log({"tension.1": LOAD / 100}), layout(declared)))
    np.testing.assert_allclose(record.tension[0], LOAD * POUND)


def test_a_displacement_is_added_to_its_reference_length():
    declared = channels(
        crosshead_position={
            "unit": "in",
            "datum": "displacement",
            "reference_length": "12.25 ft",
            "sign": -1,
        }
    )
    record = convert((log({"crosshead_position": 12 * (12.25 - POSITION)}), layout(declared)))
    np.testing.assert_allclose(record.crosshead_position, POSITION * FOOT)
    assert record.position_is_length


DISPLACEMENT = channels(crosshead_position={"datum": "displacement"})


def test_a_displacement_used_as_a_length_is_refused():
    with pytest.raises(
        SettingsError,
        match="test 'T-1': a displacement is used as a length; found .*no reference_length; needed "
        "reference_length, the thimble-to-thimble length",
    ):
        convert((log(), layout(DISPLACEMENT)))


def test_a_displacement_stays_one_where_no_length_is_needed():
    record = convert((log(), layout(DISPLACEMENT)), length_needed=False)
    assert not record.position_is_length


def test_lengths_and_displacements_do_not_mix():
    later = log({"time": TIME + 20}, name="b.csv")
    with pytest.raises(SettingsError, match="a displacement is used as a length"):
        convert((log(), layout()), (later, layout(DISPLACEMENT)), length_needed=False)


def test_a_reference_length_read_at_another_tension_is_noted():
    declared = channels(
        crosshead_position={
            "datum": "displacement", "reference_length": "12 ft", "reference_tension": "50 lbf",
        }
    )  # fmt: skip
    at_zero = {"crosshead_position": POSITION - 19}
    assert (
        tuple(map(str, convert((log(at_zero | {"tension.2": LOAD}), layout(declared))).notes)) == ()
    )
    slack = channels(crosshead_position={"datum": "displacement", "reference_length": "12 ft"})
    (note, _) = tuple(map(str, convert((log(at_zero), layout(slack))).notes))
    assert note == (
        "reference_length is stated at 0 N, but where displacement is first zero the tension of "
        "new is 222.4 N. If the displacement was set to zero under that preload, state "
        'reference_tension = "222 N" beside reference_length; strain is then zero there'
    )


@pytest.mark.parametrize("place", [4, -1])
def test_a_drop_out_to_zero_does_not_show_the_load_at_displacement_zero(place):
    stretch = {"crosshead_position": POSITION - 18, "tension.1": 50 + LOAD}
    stretch["crosshead_position"][place] = 0.0
    slack = channels(crosshead_position={"datum": "displacement", "reference_length": "12 ft"})
    notes = convert((log(stretch | {"tension.2": 50 + LOAD}), layout(slack))).notes
    assert not [one for one in notes if one.code.startswith("reference-length")]


def test_a_damper_that_pulls_and_pushes_at_displacement_zero_is_not_under_preload():
    phase = TIME * 2 * np.pi / 7 + 0.3
    stroke = {"crosshead_position": np.sin(phase), "tension.1": 30 * np.cos(phase)}
    slack = channels(crosshead_position={"datum": "displacement", "reference_length": "12 ft"})
    notes = map(str, convert((log(stroke | {"tension.2": LOAD}), layout(slack))).notes)
    (found,) = [one for one in notes if one.startswith("reference_length")]
    assert "of used is" in found


@pytest.mark.parametrize(("shift", "load", "is_told"), [
    (9.0, 0.0, True),  # 9 ft without load beside a length of 12 ft
    (9.0, 60.0, False),  # under load from the first reading on
    (1.0, 0.0, False),  # as a set may leave it
])  # fmt: skip
def test_a_displacement_that_was_not_set_to_zero_is_told(shift, load, is_told):
    stretch = np.abs(TIME % 10 - 5)
    columns = {"crosshead_position": shift + stretch, "tension.1": load + 10 * stretch}
    slack = channels(crosshead_position={"datum": "displacement", "reference_length": "12 ft"})
    notes = convert((log(columns | {"tension.2": 60 + LOAD}), layout(slack))).notes
    told = [one for one in notes if one.code == "reference-length-never-read"]
    assert len(told) == is_told
    if is_told:
        assert told[0].numbers["strain"] == pytest.approx(0.75)
        assert told[0].numbers["displacement"] == pytest.approx(9 * 0.3048)


def test_a_displacement_that_is_never_zero_cannot_be_compared():
    declared = channels(crosshead_position={"datum": "displacement", "reference_length": "12 ft"})
    assert tuple(map(str, convert((log(), layout(declared))).notes)) == ()


@pytest.mark.parametrize("specimens", [("new",), ("new", "used", "third")])
def test_tension_channels_and_specimens_have_to_agree(specimens):
    with pytest.raises(
        SettingsError, match=rf"its layout has 2 tension channels for {len(specimens)} specimens"
    ):
        convert((log(), layout()), specimens=specimens)


def test_tension_alone_is_the_first():
    declared = {key: CHANNELS[key] for key in ("time", "crosshead_position")}
    declared["tension"] = {"column": "a", "unit": "lbf", "standard_uncertainty": "0.5 lbf"}
    record = convert((log({"tension": LOAD}), layout(declared)), specimens=("new",))
    np.testing.assert_allclose(record.tension[0], LOAD * POUND)
    assert record.tension_standard_uncertainty == pytest.approx((0.5 * POUND,))


def test_tension_channels_are_numbered_from_one():
    declared = dict(CHANNELS)
    declared["tension.3"] = declared.pop("tension.2")
    with pytest.raises(SettingsError, match="the tension channels of its layout are not numbered"):
        convert((log(), layout(declared)))


def test_a_layout_without_position_is_refused():
    declared = {key: value for key, value in CHANNELS.items() if key != "crosshead_position"}
    with pytest.raises(
        SettingsError, match="its layout has no crosshead_position channel.*extremes of each"
    ):
        convert((log(), layout(declared)))


def test_a_pressure_gauge_gives_fill_pressure_in_pascals():
    for unit, size in (("bar", 1e5), ("psi", 6894.757293168361), ("kPa", 1e3)):
        gauge = {"column": "p", "unit": unit}
        stated = {"zero": f"1 {unit}", "standard_uncertainty": "2 kPa"}
        declared = CHANNELS | {"fill_pressure.1": gauge | stated, "fill_pressure.2": gauge}
        values = {"fill_pressure.1": 1 + TIME, "fill_pressure.2": 3 * TIME}
        record = convert((log(values), layout(declared)))
        np.testing.assert_allclose(record.fill_pressure, [size * TIME, 3 * size * TIME])
        assert record.fill_pressure_standard_uncertainty[0] == 2e3
        assert np.isnan(record.fill_pressure_standard_uncertainty[1])
    assert convert((log({}), layout(channels()))).fill_pressure is None
    with pytest.raises(SettingsError, match="its layout has 1 fill_pressure channels for 2"):
        convert((log(values), layout(CHANNELS | {"fill_pressure.1": gauge})))


def test_an_extensometer_gives_measured_strain_for_every_specimen():
    declared = channels(strain_1={"unit": "%"}, strain_2={"unit": "%"})
    strain = {"strain.1": 100 * TIME, "strain.2": 50 * TIME}
    record = convert((log(strain), layout(declared)))
    np.testing.assert_allclose(record.measured_strain, [TIME, TIME / 2])
    with pytest.raises(SettingsError, match="its layout has 1 strain channels for 2 specimens"):
        convert((log(strain), layout(channels(strain_1={"unit": "%"}))))


def test_uncertainties_are_carried_and_unknown_where_not_declared():
    declared = channels(
        crosshead_position={"standard_uncertainty": "0.005 ft"},
        tension_1={"standard_uncertainty": "0.5 lbf"},
    )
    record = convert((log(), layout(declared)))
    assert record.position_standard_uncertainty == pytest.approx(0.005 * FOOT)
    assert record.tension_standard_uncertainty[0] == pytest.approx(0.5 * POUND)
    assert np.isnan(record.tension_standard_uncertainty[1])


def test_the_machines_counter_is_kept_as_whole_numbers():
    count = np.floor(TIME / 10)
    in_cycles = channels(cycle_counter={"unit": "cycles"})
    record = convert((log({"cycle_counter": count}), layout(in_cycles)))
    assert record.cycle_counter.tolist() == count.astype(int).tolist()
    declared = channels(cycle_counter={})
    record = convert((log({"cycle_counter": count}), layout(declared)))
    assert record.cycle_counter.dtype == np.int64
    assert record.cycle_counter.tolist() == count.astype(int).tolist()
    count[3] = np.nan
    record = convert((log({"cycle_counter": count}), layout(declared)))
    assert record.cycle_counter[3] == -1
    assert tuple(map(str, record.notes)) == (
        "the cycle counter is missing in 1 rows; it is set to -1 there",
    )
    count[3] = 0.5
    with pytest.raises(
        DataError, match="the cycle counter is not a whole number, first at sample 4"
    ):
        convert((log({"cycle_counter": count}), layout(declared)))


def test_a_sample_interval_stands_for_a_time_column():
    declared = {key: value for key, value in CHANNELS.items() if key != "time"}
    record = convert((log(), layout(declared, sample_interval="100 ms")))
    np.testing.assert_allclose(record.time, TIME, atol=1e-12)
    with pytest.raises(DataError, match="channel 'crosshead_position' has no time"):
        convert((log(), layout(declared)))
    with pytest.raises(SettingsError, match="sample_interval is not positive; found 0 s"):
        convert((log(), layout(declared, sample_interval="0 s")))


def test_time_in_minutes_becomes_seconds():
    record = convert((log({"time": TIME / 60}), layout(channels(time={"unit": "min"}))))
    np.testing.assert_allclose(record.time, TIME)


def test_channels_with_their_own_time_come_to_the_slower_one():
    declared = channels(tension_1={"time_column": "ta", "time_unit": "ms"})
    slow = np.full(TIME.size, np.nan)
    slow[:40] = TIME[::5]
    own = {"tension.1": np.where(np.isnan(slow), np.nan, 50 + slow), "tension.1.time": 1000 * slow}
    record = convert((log(own), layout(declared)))
    np.testing.assert_allclose(record.time, TIME[::5])
    np.testing.assert_allclose(record.tension[0], (50 + TIME[::5]) * POUND)
    np.testing.assert_allclose(record.crosshead_position, POSITION[::5] * FOOT)
    assert np.all(record.crosshead_position_quality_flag & Quality.RESAMPLED)
    assert np.all(record.quality_flag[1] & Quality.RESAMPLED)
    assert not np.any(record.quality_flag[0] & Quality.RESAMPLED)
    assert str(record.notes[0]) == (
        "crosshead_position, tension.2: resampled from 10 Hz to the 2 Hz of tension.1, by cubics "
        "through four readings"
    )
    assert (record.n_rows_read, record.n_samples) == (200, 40)


def test_channels_that_a_record_does_not_hold_are_named():
    record = convert((log({"temperature": TIME}), layout(channels(temperature={"unit": "degC"}))))
    assert tuple(map(str, record.notes)) == ("read and checked, but not used: temperature",)


SHORT = note("laboratory", text="short")


def test_pieces_are_joined_in_order_and_their_gap_is_flagged():
    first = log(name="a.csv", metadata={"Operator": "Kh", "Part": "1"}, notes=(SHORT,))
    second = log({"time": TIME + 25}, name="b.csv", metadata={"Operator": "Kh", "Part": "2"})
    record = convert((first, layout()), (second, layout()))
    assert record.n_samples == record.n_rows_read == 400
    assert record.metadata == {"Operator": "Kh", "Part": "1", "Part (b.csv)": "2"}
    gaps = record.crosshead_position_quality_flag & Quality.GAP
    assert np.flatnonzero(gaps).tolist() == [200]
    assert tuple(map(str, record.notes)) == (
        "one record joined from 2 files: a.csv and b.csv",
        "a.csv: short",
        "400 rows read, 400 kept, flagged: crosshead_position gap 1",
    )


def test_pieces_may_have_layouts_of_their_own():
    metric = channels(
        crosshead_position={"unit": "m"}, tension_1={"unit": "N"}, tension_2={"unit": "N"}
    )
    record = convert((log(), layout()), (log({"time": TIME + 20}), layout(metric)))
    np.testing.assert_allclose(record.tension[0], np.concatenate([LOAD * POUND, LOAD]))


def test_pieces_that_each_count_from_zero_are_two_time_bases():
    with pytest.raises(
        DataError,
        match=r"two time bases; found b.csv from 0 s, a.csv to 19.9 s; needed pieces in order",
    ):
        convert((log(name="a.csv"), layout()), (log(name="b.csv"), layout()))


@pytest.mark.parametrize(
    ("texts", "starts"),
    [
        (("03.11.2026 23:59:50", "04.11.2026 00:00:20.5", "05.11.2026 00:00:20.5"),
         (0.0, 30.5, 86430.5)),
        (("23:59:50", "00:00:20", "00:00:19"), (0.0, 30.0, 86429.0)),
    ],
)  # fmt: skip
def test_pieces_by_a_clock_go_on_at_their_clock(texts, starts):
    clocked = [
        (replace(log({"time": TIME}, name=f"{place}.csv"), text={"time": (text,)}), layout())
        for place, text in enumerate(texts)
    ]
    record = convert(*clocked)
    np.testing.assert_allclose(record.time, np.concatenate([TIME + start for start in starts]))


def test_pieces_by_a_clock_in_the_wrong_order_are_refused():
    clocked = [
        (replace(log({"time": TIME}, name=name), text={"time": (text,)}), layout())
        for name, text in (("a.csv", "2026-11-04 00:01:00"), ("b.csv", "2026-11-03 23:50:00"))
    ]
    with pytest.raises(DataError, match=r"found b.csv from -660 s, a.csv to 19.9 s"):
        convert(*clocked)


def test_pieces_with_other_channels_are_refused():
    later = log({"time": TIME + 20, "cycle_counter": TIME})
    with pytest.raises(SettingsError, match="the pieces of a record have different channels"):
        convert((log(), layout()), (later, layout(channels(cycle_counter={}))))


def test_a_counter_that_wraps_is_told_from_two_time_bases():
    wraps = np.arange(TIME.size) * 0.5 % 65.536
    with pytest.raises(
        DataError, match=r"restarts every 65\.536 s: at each restart, add that much"
    ):
        convert((log({"time": wraps}), layout()))


def test_time_that_starts_again_is_two_time_bases():
    again = np.concatenate([TIME[:150], TIME[:50]])
    with pytest.raises(
        DataError,
        match=r"^T-1.csv:154 \[time\]: the log has two time bases: time starts again; found 0 s after "
        r"14.9 s; needed one time that keeps rising. Split the log",
    ):
        convert((log({"time": again}), layout()))
    with pytest.raises(DataError, match=r"^T-1.csv:1150 \[time\]: "):
        convert((log({"time": again}, row=np.arange(200) + 1000), layout()))


@pytest.mark.parametrize("n_blank", [1, 2, 5])
def test_blank_rows_between_two_runs_hide_no_second_time_base(n_blank):
    again = np.concatenate([TIME[:150], np.full(n_blank, np.nan), TIME[: 50 - n_blank]])
    with pytest.raises(DataError, match=f"T-1.csv:{154 + n_blank} .*time starts again; found 0 s"):
        convert((log({"time": again}), layout()))


def test_a_slip_of_the_clock_is_flagged_and_no_second_time_base():
    time = TIME.copy()
    time[-1] = 18.0
    time[50] = 0.0
    record = convert((log({"time": time}), layout()))
    flags = record.crosshead_position_quality_flag & Quality.REPEATED_OR_BACKWARD_TIME
    assert np.flatnonzero(flags).tolist() == [50, 199]


def text_of_clock(seconds):
    hours, rest = divmod(seconds % 86400, 3600)
    return f"{hours:02.0f}:{rest // 60:02.0f}:{rest % 60:06.3f}"


@pytest.mark.parametrize(
    ("shift", "at", "suffix", "told"),
    [
        (-3600, 3 * 3600, "", "set back by one hour"),
        (3600, 2 * 3600, "", "set forward by one hour"),
        (3600, 2 * 3600, "Z", None),  # the time of the world is put forward nowhere
        (3600, 2 * 3600 + 700, "", None),  # nor is any on another minute
        (3600, 12 * 3600, "", None),  # or at noon
        (1800, 2 * 3600, "", None),
    ],
)
def test_an_hour_by_which_a_clock_was_put_is_no_time(shift, at, suffix, told):
    """Readings of every 20 s, from an hour before the change to an hour after it."""
    elapsed = np.arange(-3600, 3600, 20.0) + 4
    shown = at + elapsed + np.where(elapsed > 0, shift, 0)
    channels_ = channels(time={"unit": "clock"})
    many = {name: np.resize(values, elapsed.size) for name, values in
            (("crosshead_position", POSITION), ("tension.1", LOAD), ("tension.2", LOAD))}  # fmt: skip
    clocked = replace(
        log({"time": shown - shown[0], **many}),
        text={"time": tuple(text_of_clock(one) + suffix for one in shown.tolist())},
    )
    record = convert((clocked, layout(channels_)))
    steps = np.diff(record.time)
    notes = [str(one) for one in record.notes if one.code == "clock-changed"]
    if told is None:
        assert not notes and steps.max() == 20 + shift
    else:
        assert len(notes) == 1 and told in notes[0]
        np.testing.assert_allclose(steps, 20)


def test_the_verified_range_of_each_piece_is_its_own():
    narrow = channels(tension_1={"verified_range": ("50 lbf", "90 lbf")})
    record = convert((log(), layout(narrow)), (log({"time": TIME + 20}), layout()))
    outside = (record.quality_flag & Quality.OUTSIDE_VERIFIED_RANGE).astype(bool)
    assert np.array_equal(outside[0, :200], LOAD > 90)
    assert not outside[0, 200:].any() and not outside[1].any()


def test_the_record_cannot_be_written_to():
    record = convert((log(), layout()))
    with pytest.raises(ValueError, match="read-only"):
        record.tension[0, 0] = 0.0


def test_numbers_that_no_machine_measures_are_refused_with_their_row():
    position = POSITION.copy()
    position[[7, 9]] = 1e300
    with pytest.raises(DataError, match=r"crosshead_position has 2 values .* row 11 of T-1\.csv"):
        convert((log({"crosshead_position": position}), layout()))
    load = LOAD.copy()
    load[3], load[5] = np.nan, -3e9
    with pytest.raises(DataError, match=r"tension\.2 has 1 values .* row 9 of T-1\.csv"):
        convert((log({"tension.2": load}), layout()))


@pytest.mark.parametrize("time", [1e13, -7e300])
def test_a_time_that_no_clock_shows_is_refused(time):
    clock = np.where(TIME < 5, TIME, time)
    with pytest.raises(DataError, match=r"the time of T-1\.csv has values that no clock can show"):
        convert((log({"time": clock}), layout()))


def test_ticks_of_a_clock_become_seconds():
    declared = channels(time={"unit": "ms", "factor": 20.0})
    record = convert((log({"time": np.arange(TIME.size)}), layout(declared)))
    np.testing.assert_allclose(record.time, 0.02 * np.arange(TIME.size), rtol=1e-15)


def test_rows_of_a_logger_of_two_rates_are_readings_of_one_channel_each():
    time = np.arange(0, 40, 0.1)
    place, load = 19 + 0.1 * time, 50 + 2 * time
    turn = np.arange(time.size) % 4
    columns = {
        "time": time,
        "crosshead_position": np.where(turn == 1, place, np.nan),
        "tension.1": np.where(turn != 1, load, np.nan),
        "tension.2": np.where(turn != 1, 2 * load, np.nan),
    }
    record = convert((log(columns), layout()))
    assert record.n_samples == 100
    np.testing.assert_allclose(record.time, time[1::4])
    np.testing.assert_allclose(record.crosshead_position, place[1::4] * FOOT)
    np.testing.assert_allclose(record.tension[0], load[1::4] * POUND)
    assert np.all(record.quality_flag & Quality.RESAMPLED)
    # what is blank in the same rows is as it was
    blank = {key: np.where(turn % 2, one, np.nan) for key, one in columns.items() if key != "time"}
    blank |= {"time": time, "crosshead_position": np.where(turn % 2, place, np.nan)}
    blank |= {f"tension.{k}": np.where(turn % 2, k * load, np.nan) for k in (1, 2)}
    assert convert((log(blank), layout())).n_samples == time.size

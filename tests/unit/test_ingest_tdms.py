from datetime import datetime

import numpy as np
import pytest
from binary_layouts import layout_of
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

from reduction.readers.tdms import read_tdms
from reduction.record.errors import LogError

N = 5
START = datetime(2020, 1, 1)  # noqa: DTZ001 - the writer takes naive times


layout = layout_of("tdms", load="load")


def channel(name, values, group="log", **properties):
    return ChannelObject(group, name, np.asarray(values), properties)


def write(path, *channels):
    with TdmsWriter(path) as writer:
        root, group = RootObject({"operator": "KH"}), GroupObject("log", {"rate": 10})
        writer.write_segment([root, group, *channels])
    return path


def read(tmp_path, *channels, **settings):
    path = write(tmp_path / "log.tdms", *channels)
    return read_tdms(path, layout(**settings), name="log.tdms")


def waveform(increment=0.1, offset=0.0, **more):
    return {"wf_increment": increment, "wf_start_offset": offset, **more}


def test_channels_are_read_in_float64_with_the_properties_as_metadata(tmp_path):
    load = channel("load", np.arange(N, dtype=np.int16), unit_string="kN")
    log = read(tmp_path, channel("t", np.arange(N) * 0.1), load)
    assert log.columns["tension.1"].tolist() == [0, 1, 2, 3, 4]
    assert log.columns["tension.1"].dtype == np.float64
    np.testing.assert_array_equal(log.columns["time"], np.arange(N) * 0.1)
    assert log.metadata == {"operator": "KH", "rate": "10"}
    assert (log.first_row, log.n_rows_read, tuple(map(str, log.notes))) == (0, N, ())


def test_segments_are_read_as_one_record(tmp_path):
    path = tmp_path / "log.tdms"
    with TdmsWriter(path) as writer:
        for part in (0, 1):
            time = np.arange(N) + part * N
            writer.write_segment([channel("t", 1.0 * time), channel("load", 2.0 * time)])
    log = read_tdms(path, layout(), name="log.tdms")
    assert log.columns["tension.1"].tolist() == [2.0 * i for i in range(2 * N)]


def test_a_unit_that_disagrees_is_an_error(tmp_path):
    load = channel("load", np.ones(N), unit_string="N")
    with pytest.raises(LogError, match=r"\[load\]: the unit in the file is not the declared one"):
        read(tmp_path, channel("t", np.arange(N)), load)


def test_the_group_may_be_named(tmp_path):
    channels = [channel(name, np.arange(N), group="other") for name in ("t", "load")]
    log = read(tmp_path, *channels, channel("x", [1.0]), group="other")
    assert log.n_rows_read == N


@pytest.mark.parametrize(
    ("group", "problem"), [("", "the layout names no group"), ("T-9", "there is no group 'T-9'")]
)
def test_a_group_that_is_not_clear_lists_those_there_are(tmp_path, group, problem):
    with pytest.raises(LogError, match=rf"{problem}; found 'log', 'other'"):
        read(tmp_path, channel("t", [1.0]), channel("t", [1.0], group="other"), group=group)


def test_a_missing_channel_lists_those_there_are(tmp_path):
    with pytest.raises(LogError, match=r"'load' is not in group 'log'; found 't', 'force'"):
        read(tmp_path, channel("t", np.arange(N)), channel("force", np.arange(N)))


def test_channels_of_two_lengths_are_two_time_bases(tmp_path):
    with pytest.raises(LogError, match="two time bases; found time 5 values"):
        read(tmp_path, channel("t", np.arange(N)), channel("load", np.arange(3)))


def test_a_channel_with_its_own_times_may_be_shorter(tmp_path):
    channels = {
        "time": {"column": "t", "unit": "s"},
        "tension": {"1": {"column": "load", "unit": "kN", "time_column": "tl"}},
    }
    log = read(
        tmp_path,
        channel("t", np.arange(N)), channel("load", np.arange(3)), channel("tl", [0.0, 2.0, 4.0]),
        channels=channels,
    )  # fmt: skip
    assert log.columns["tension.1.time"].tolist() == [0, 2, 4]
    assert log.n_rows_read == N


@pytest.mark.parametrize("values", [np.array([True] * N), ["a"] * N, [np.datetime64(START)] * N])
def test_what_is_no_number_is_an_error(tmp_path, values):
    with pytest.raises(LogError, match=r"\[load\]: a column does not hold numbers"):
        read(tmp_path, channel("t", np.arange(N)), channel("load", values))


WAVEFORM = {"column": "wf_increment", "unit": "s"}


def waveform_layout(**load):
    return {
        "time": WAVEFORM,
        "crosshead_position": {"column": "x", "unit": "mm", "datum": "pin-to-pin"},
        "tension": {"1": {"column": "load", "unit": "kN", **load}},
    }


def test_time_is_made_from_the_waveform_properties(tmp_path):
    log = read(
        tmp_path,
        channel("x", np.arange(N), **waveform(0.25, 1.0)),
        channel("load", np.arange(N), **waveform(0.25, 1.0)),
        channels=waveform_layout(),
    )
    assert log.columns["time"].tolist() == [1.0, 1.25, 1.5, 1.75, 2.0]


def test_waveforms_of_two_rates_are_two_time_bases(tmp_path):
    x = channel("x", np.arange(N), **waveform(0.25))
    load = channel("load", np.arange(N), **waveform(0.5))
    with pytest.raises(LogError, match=r"two time bases; found .*every 0\.25 s.*every 0\.5 s"):
        read(tmp_path, x, load, channels=waveform_layout())


def test_a_waveform_of_another_rate_has_its_own_times_on_the_same_zero(tmp_path):
    log = read(
        tmp_path,
        channel("x", np.arange(N), **waveform(0.25, wf_start_time=START)),
        channel("load", [1.0, 2.0], **waveform(0.5, wf_start_time=START.replace(second=3))),
        channels=waveform_layout(time_column="wf_increment"),
    )
    assert log.columns["time"].tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert log.columns["tension.1.time"].tolist() == [3.0, 3.5]


def test_a_channel_without_waveform_properties_is_an_error(tmp_path):
    x = channel("x", np.arange(N), **waveform(0.25))
    with pytest.raises(LogError, match="'load' does not say its sampling interval"):
        read(tmp_path, x, channel("load", np.arange(N)), channels=waveform_layout())


def test_waveform_time_is_in_seconds_unless_the_file_says_otherwise(tmp_path):
    channels = {**waveform_layout(), "time": {"column": "wf_increment", "unit": "ms"}}
    x = channel("x", np.arange(N), **waveform(0.25))
    load = channel("load", np.arange(N), **waveform(0.25))
    with pytest.raises(LogError, match="found 's'; needed 'ms'"):
        read(tmp_path, x, load, channels=channels)


def test_a_channel_named_like_the_property_is_read_as_a_channel(tmp_path):
    clock = channel("wf_increment", np.arange(N) * 2.0)
    log = read(
        tmp_path, clock, channel("x", np.arange(N)), channel("load", np.arange(N)),
        channels=waveform_layout(),
    )  # fmt: skip
    assert log.columns["time"].tolist() == [0, 2, 4, 6, 8]


def test_a_file_that_is_cut_off_says_so(tmp_path, capfd):
    path = write(
        tmp_path / "log.tdms", channel("t", np.arange(100.0)), channel("load", np.ones(100))
    )
    path.write_bytes(path.read_bytes()[:-8])
    with pytest.raises(LogError, match="two time bases; found time 100 values, .* 99 values"):
        read_tdms(path, layout(), name="log.tdms")
    only = layout(channels={"time": {"column": "t", "unit": "s"}})
    log = read_tdms(path, only, name="log.tdms")
    assert tuple(map(str, log.notes)) == (
        "the file ends inside a block of data: the logger was stopped or the file cut off",
    )
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize("content", [b"garbage" * 50, b"TDSm" + b"\xff" * 200])
def test_a_file_that_is_no_tdms_is_an_error(tmp_path, content):
    (tmp_path / "log.tdms").write_bytes(content)
    with pytest.raises(LogError, match=r"the file is not TDMS|names no group"):
        read_tdms(tmp_path / "log.tdms", layout(), name="log.tdms")


def test_a_channel_that_cannot_be_read_is_an_error(tmp_path, monkeypatch):
    path = write(tmp_path / "log.tdms", channel("t", np.arange(N)), channel("load", np.ones(N)))

    def fail(self, _):
        raise ValueError("no bytes left")

    monkeypatch.setattr("nptdms.TdmsChannel.__getitem__", fail)
    with pytest.raises(LogError, match=r"\[t\]: a channel cannot be read; found no bytes left"):
        read_tdms(path, layout(), name="log.tdms")

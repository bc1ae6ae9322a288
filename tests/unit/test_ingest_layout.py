import pytest
from pydantic import ValidationError

from reduction.readers.layout import Layout
from reduction.record.errors import SettingsError


def layout(*, channels=None, **settings):
    return Layout(**{"format": "delimited", "channels": channels or {}} | settings)


def tension(**channel):
    return {"tension.1": {"column": "F", "unit": "N"} | channel}


def test_nested_channels_of_a_toml_table_get_their_number():
    one = layout(
        channels={"tension": {"1": {"column": "a", "unit": "N"}, "2": {"column": "b", "unit": "N"}}}
    )
    assert list(one.channels) == ["tension.1", "tension.2"]


def test_an_unknown_unit_is_refused():
    with pytest.raises(ValidationError, match="unit 'furlong-stone' is not known"):
        layout(channels=tension(unit="furlong-stone"))


def test_a_unit_of_the_wrong_dimension_is_refused():
    with pytest.raises(ValidationError, match="unit 'mm' is not a unit of force; .*such as N"):
        layout(channels=tension(unit="mm"))
    with pytest.raises(ValidationError, match="unit 'N' is not a unit of time"):
        layout(channels=tension(time_column="t", time_unit="N"))
    with pytest.raises(ValidationError, match="is not a unit of force"):
        layout(channels=tension(zero="3 mm"))


def test_a_clock_is_a_unit_of_time_alone():
    assert (
        layout(channels={"time": {"column": "t", "unit": "clock"}}).channels["time"].unit == "clock"
    )
    with pytest.raises(ValidationError, match="unit 'clock' is not known"):
        layout(channels=tension(unit="clock"))


@pytest.mark.parametrize(
    ("name", "channel", "key"),
    [
        ("time", {"unit": "s", "sign": -1}, "sign"),
        ("time", {"unit": "s", "zero": "5 s"}, "zero"),
        ("time", {"unit": "clock", "factor": 2.0}, "factor"),
        ("time", {"unit": "s", "date_order": "day first"}, "date_order"),
        ("tension.1", {"unit": "N", "reference_length": "2 m"}, "reference_length"),
        ("tension.1", {"unit": "N", "datum": "displacement"}, "datum"),
    ],
)
def test_what_nothing_would_look_at_is_refused(name, channel, key):
    with pytest.raises(ValidationError, match=f"channel {name} has no {key}; found {key} = "):
        layout(channels={name: {"column": "c"} | channel})


def test_a_length_from_pin_to_pin_has_no_reference_length():
    channel = {"column": "x", "unit": "m", "datum": "pin-to-pin", "reference_length": "2 m"}
    with pytest.raises(ValidationError, match="a length from pin to pin has no reference_length"):
        layout(channels={"crosshead_position": channel})


def test_a_factor_is_above_zero():
    with pytest.raises(ValidationError, match="greater than 0"):
        layout(channels=tension(factor=0.0))


def test_a_sample_interval_is_a_time_and_takes_the_place_of_a_time_channel():
    assert layout(sample_interval="20 ms").sample_interval == "20 ms"
    with pytest.raises(ValidationError, match="is not a unit of time"):
        layout(sample_interval="20 mm")
    with pytest.raises(ValidationError, match="both a time channel and a sample_interval"):
        layout(channels={"time": {"column": "t", "unit": "s"}}, sample_interval="1 s")


@pytest.mark.parametrize(
    "marks",
    [
        {"delimiter": ",", "decimal": ",", "quote": ""},
        {"delimiter": ";", "decimal": ".", "thousands": "."},
        {"delimiter": ";;"},
        {"delimiter": ""},
        {"delimiter": " ", "thousands": " "},
    ],
)
def test_separators_that_cannot_be_told_apart_are_refused(marks):
    with pytest.raises(ValidationError, match="the separators of a layout cannot be told apart"):
        layout(**marks)


def test_a_position_without_datum_is_refused():
    with pytest.raises(ValidationError, match="the position channel has no datum"):
        layout(channels={"crosshead_position": {"column": "x", "unit": "mm"}})


def test_an_unknown_channel_lists_those_that_are_known():
    with pytest.raises(SettingsError, match="channel 'load' is not known; .*tension"):
        Layout.dimension("load")

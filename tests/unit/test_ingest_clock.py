import re
from pathlib import Path

import numpy as np
import pytest

from reduction.readers.columns import clock_to_seconds, plain_date
from reduction.readers.record_in_si import _between_ticks
from reduction.record.errors import LogError

LOG = Path("log.csv")


def seconds(*texts, row=None):
    return clock_to_seconds(
        LOG, texts, channel="clock", missing=("", "-"), row=row, first_row=2
    ).tolist()


def test_readings_count_from_the_first():
    assert seconds("0945", "0955", "1009") == [0.0, 600.0, 1440.0]


def test_colons_seconds_and_short_hours_are_read():
    assert seconds("9:45", "09:45:30", "10:00:00.5") == [0.0, 30.0, 900.5]


def test_midnight_starts_a_new_day():
    assert seconds("2350", "0010", "2340", "0005") == [0.0, 1200.0, 85800.0, 87300.0]


def test_a_small_step_back_is_kept():
    assert seconds("1009", "1008") == [0.0, -60.0]


def test_a_missing_mark_is_missing():
    np.testing.assert_equal(seconds("-", "0945", "", "0946"), [np.nan, 0.0, np.nan, 60.0])


@pytest.mark.parametrize(
    "text", ["2400", "0960", "noon", "9.45", "12345", "13:00 PM", "0:30 AM", "09:45+1"]
)
def test_text_that_is_no_clock_time_names_its_row(text):
    with pytest.raises(
        LogError,
        match=rf"log\.csv:3 \[clock\]: a reading is not a clock time; found '{re.escape(text)}'",
    ):
        seconds("0945", text)


def test_rows_that_are_not_consecutive_are_named():
    with pytest.raises(LogError, match=r"log\.csv:17 "):
        seconds("0945", "x", row=np.array([2, 17]))


def test_a_date_before_the_time_counts_the_days():
    assert seconds("2024-02-28 23:59:30", "2024-02-29T00:00:00.25", "2024-03-03 00:00:00Z") == [
        0.0, 30.25, 3 * 86400.0 + 30.0,
    ]  # fmt: skip
    assert seconds("31.12.2024 12:00", "02.01.2025 12:00") == [0.0, 2 * 86400.0]


def test_halves_of_a_day_are_told_by_their_letters():
    assert seconds("11:59:30 AM", "12:00:30 PM", "11:59:30 pm", "12:00:30 a.m.") == [
        0.0, 60.0, 12 * 3600.0, 12 * 3600.0 + 60.0,
    ]  # fmt: skip
    assert seconds("2024-02-28 09:00:00 PM", "2024-02-29 12:30 AM") == [0.0, 3.5 * 3600]


def test_a_zone_that_changes_is_no_time():
    """A clock that is put back shows so in its zone; both readings are 20 minutes apart."""
    assert seconds("2026-10-25 02:50:00+02:00", "2026-10-25T02:10:00.5+0100") == [0.0, 1200.5]
    assert seconds("2026-03-07 23:50 -05:00", "2026-03-08 04:51:00Z") == [0.0, 60.0]


def test_a_date_in_some_rows_is_refused():
    with pytest.raises(LogError, match="some readings of a clock have a date and some have none"):
        seconds("2024-02-28 10:00", "10:01")


@pytest.mark.parametrize("text", ["31.02.2024 10:00", "2023-02-29 10:00", "2023/13/01 10:00"])
def test_a_date_of_no_day_is_refused(text):
    with pytest.raises(LogError, match=f"a reading is not a clock time; found '{text}'"):
        seconds(text)


@pytest.mark.parametrize(
    ("texts", "told"),
    [
        (["03/04/2024 10:00"], '"month first" or "day first"'),
        (["12-05-24 10:00", "13-05-24 10:00"], 'date_order = "day first" .* no other'),
        (["5/31/2024 10:00"], 'date_order = "month first" .* no other'),
        (["13/01/2024 10:00", "01/13/2024 10:00"], "Neither number"),
    ],
)
def test_a_date_that_may_be_of_either_order_is_refused_and_the_order_asked_for(texts, told):
    with pytest.raises(LogError, match=f"found '{texts[0]}'.*{told}"):
        seconds(*texts)


def test_dates_are_read_in_the_order_that_is_stated():
    # across the end of May, that of a leap February, and of the century in two digits
    texts = ["05/31/2005 11:59:30 PM", "06/01/2005 12:00:30 AM"]
    assert seconds(*(plain_date(text, "month first") for text in texts)) == [0.0, 60.0]
    texts = ["28-02-24 12:00", "01-03-24 12:00"]
    assert seconds(*(plain_date(text, "day first") for text in texts)) == [0.0, 2 * 86400.0]
    texts = ["12/31/99 12:00", "1/1/00 12:00"]
    assert seconds(*(plain_date(text, "month first") for text in texts)) == [0.0, 86400.0]


def test_a_month_at_midnight_is_a_wrong_order_of_dates():
    texts = ["05/04/2026 23:59:59", "05/05/2026 00:00:01"]
    assert seconds(*(plain_date(text, "month first") for text in texts)) == [0.0, 2.0]
    with pytest.raises(LogError, match="found 2026-05-05 after 2026-04-05.*date_order"):
        seconds(*(plain_date(text, "day first") for text in texts))
    # a reading a month later at a later time of day is a pause
    assert seconds("05.04.2026 10:00", "05.05.2026 10:00") == [0.0, 30 * 86400.0]


def test_months_by_name_and_years_first_need_no_order():
    texts = ["30-Sep-2005 12:00", "1 october 2005 12:00"]
    assert seconds(*(plain_date(text, None) for text in texts)) == [0.0, 86400.0]
    assert seconds("2005/12/31 12:00", "2006/1/1 12:00") == [0.0, 86400.0]


def test_rows_of_one_second_are_spread_evenly_where_the_clock_agrees():
    true = 12.3 + 0.1 * np.arange(900)
    load = {"tension.1": np.sin(true)}
    spread, [told] = _between_ticks(np.floor(true), load)
    assert told.code == "clock-coarse"
    # a clock that cuts off is half a second early, in all rows alike
    assert np.ptp(spread - true) < 0.01
    # the rate is known to a row over the log, also where it ends within a second
    dense = 0.013 + 0.02 * np.arange(3648)
    spread, _ = _between_ticks(np.floor(dense), {"tension.1": np.sin(dense)})
    assert np.ptp(spread - dense) < 0.005
    # a pause breaks the even rate: rows are known to the second that they stand in
    paused = true + 7.0 * (np.arange(900) > 450)
    spread, [told] = _between_ticks(np.floor(paused), load)
    assert told.code == "clock-coarse-uneven"
    assert told.severity == "warning"
    assert np.abs(spread - paused).max() < 1.0
    assert (np.diff(spread) > 0).all()


def test_a_clock_little_coarser_than_the_log_is_spread_evenly():
    true = 12.3 + 0.0802 * np.arange(900)
    load = {"tension.1": np.sin(true)}
    spread, [told] = _between_ticks(np.floor(10 * true) / 10, load)
    assert told.code == "clock-coarse"
    assert np.ptp(spread - true) < 0.01
    # a clock that loses steps in one part of the log is not
    lost = np.round(0.1 * (np.arange(900) - np.minimum(np.arange(900) // 15, 20)), 1)
    kept, told = _between_ticks(lost, load)
    assert kept is lost and told == ()


def test_rows_that_are_written_twice_and_fine_clocks_are_left_alone():
    twice = np.repeat(np.arange(400.0), 2)
    load = np.repeat(np.sin(np.arange(400.0)), 2)
    kept, told = _between_ticks(twice, {"tension.1": load})
    assert kept is twice
    assert told == ()
    fine = 0.1 * np.arange(900)
    assert _between_ticks(fine, {"tension.1": np.sin(fine)})[1] == ()

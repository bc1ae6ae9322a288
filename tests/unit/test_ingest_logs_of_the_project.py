"""Logs that come with the project, each by a declared layout.

Counts and peaks of the synthetic logs were taken from the files with awk; the printed test
is WHOI-2005-10, Table 4.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from reduction.readers.layout import Layout
from reduction.readers.read_log import read_log, read_record
from reduction.record.settings import QualitySettings

RAW = Path(__file__).parents[2] / "raw"
FOOT, POUND = 0.3048, 4.4482216152605

LOGGER = Layout(
    format="delimited",
    comment="#",
    channels={
        "time": {"column": "time_s", "unit": "s"},
        "crosshead_position": {"column": "crosshead_ft", "unit": "ft", "datum": "pin-to-pin"},
        "tension.1": {"column": "load_new_lb", "unit": "lbf"},
        "tension.2": {"column": "load_used_lb", "unit": "lbf"},
    },
)
SYNTHETIC = [
    ("T-1", 7_632, 141.357, 123.047),
    ("T-2", 8_679, 177.246, 151.123),
    ("T-3", 7_822, 209.473, 182.129),
    ("T-4", 8_869, 259.033, 227.051),
    ("T-4_extended", 60_026, 155.762, 152.832),
    ("T-4_extended_start_5Hz", 2_121, 152.588, 145.264),
    ("T-4_extended_end_5Hz", 2_005, 151.611, 153.32),
    ("T-5", 8_012, 298.096, 271.729),
    ("T-6", 8_202, 411.865, 407.471),
    ("overnight_hold", 1_440, 68.604, 74.463),
]


def read(name):
    path = f"{name}.csv"
    record, (source,) = read_record(
        [(RAW / "tmt-synthetic" / path, LOGGER, path)],
        test_id="test",
        specimens=("new", "used"),
        quality=QualitySettings(),
    )
    assert source.name == path
    return record


@pytest.mark.parametrize(("name", "n_rows", "new", "used"), SYNTHETIC)
def test_synthetic_tether_logs_are_read_without_a_flag(name, n_rows, new, used):
    record = read(name)
    assert record.n_samples == n_rows
    assert record.tension[:, :].max(axis=1) == pytest.approx([new * POUND, used * POUND])
    assert not record.quality_flag.any() and not record.crosshead_position_quality_flag.any()
    assert record.notes == () and record.metadata


def test_every_value_of_a_log_is_the_one_a_plain_reader_finds():
    record = read("T-6")
    with (RAW / "tmt-synthetic" / "T-6.csv").open() as stream:
        rows = [row for row in csv.reader(stream) if row[0][:1].isdigit()]
    plain = np.array(rows, dtype=float)
    np.testing.assert_array_equal(record.time, plain[:, 0])
    np.testing.assert_allclose(record.crosshead_position, plain[:, 1] * FOOT, rtol=1e-15)
    np.testing.assert_allclose(record.tension, plain[:, 2:].T * POUND, rtol=1e-15)


def test_the_printed_stepwise_test_keeps_its_clock():
    table = Layout(
        format="delimited",
        comment="#",
        channels={
            "time": {"column": "time_est", "unit": "clock"},
            "tension.1": {"column": "weight_lb", "unit": "lbf"},
            "gauge_length": {"column": "tether_length_in", "unit": "inch"},
            "strain.1": {"column": "elongation_pct", "unit": "%"},
        },
    )
    log = read_log(RAW / "buoy-technology-1997" / "table_4.csv", table, name="table_4.csv")
    assert log.n_rows_read == 15
    assert (log.text["time"][0], log.text["time"][-1]) == ("0945", "1330")
    assert log.columns["time"][[0, 1, -1]].tolist() == [0.0, 600.0, 13_500.0]
    assert log.columns["gauge_length"][13] == 16.38

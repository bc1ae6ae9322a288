"""The clock of a log: small slips are let be, and a second beginning is refused."""

import numpy as np
import pytest

from reduction.readers import record_in_si as piece
from reduction.readers.layout import Layout
from reduction.readers.raw_log import RawLog
from reduction.readers.record_in_si import _to_piece
from reduction.record import samples as blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Source
from reduction.record.settings import QualitySettings

LAYOUT = Layout(
    format="delimited",
    channels={
        "time": {"column": "t", "unit": "s"},
        "tension.1": {"column": "F", "unit": "N"},
    },
)


def read(time):
    columns = {"time": time, "tension.1": np.ones(time.size)}
    log = RawLog(
        source=Source("T-1.csv", "0" * 64, 1), columns=columns, first_row=2, n_rows_read=time.size
    )
    return _to_piece(log, LAYOUT, quality=QualitySettings(gap_factor=5.0))


def test_a_clock_that_slips_again_and_again_is_gone_over_once(monkeypatch):
    whole, times = blocks.sample_blocks, []

    def counted(*series, **settings):
        times.append(series)
        return whole(*series, **settings)

    for module in (blocks, piece):
        monkeypatch.setattr(module, "sample_blocks", counted)
    time = np.arange(100_000) / 10
    time[50::100] -= 0.15
    np.testing.assert_array_equal(read(time).time, time)
    assert len(times) == 1


@pytest.mark.parametrize("length", [1, 2, 3, 50, 1 << 16])
@pytest.mark.parametrize("at", [40, 50, 51])
def test_time_that_starts_again_is_found_wherever_blocks_end(monkeypatch, length, at):
    monkeypatch.setitem(blocks.sample_blocks.__kwdefaults__, "size", length)
    time = np.arange(100.0)
    time[10] = 8.5  # a slip
    time[3] = np.nan
    read(time)
    time[at:] -= at
    with pytest.raises(DataError, match=rf"T-1\.csv:{at + 2} .*found 0 s after {at - 1} s"):
        read(time)

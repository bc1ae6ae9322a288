"""One log on one time axis, with the factors that will bring its channels to SI."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import DataError, SettingsError
from reduction.ingest.layout import CLOCK, Channel, Layout
from reduction.ingest.rawlog import RawLog
from reduction.ingest.resample import on_common_time
from reduction.record import Floats
from reduction.samples.blocks import sample_blocks
from reduction.samples.scratch import empty_like
from reduction.units import Dimension, parse_quantity, scale_to_si

_USED = ("crosshead_position", "tension", "strain", "cycle_counter")
_RESTART_SAMPLES = 3


@dataclass(frozen=True)
class Piece:
    """One file of a record.

    Parameters
    ----------
    log : RawLog
        As it was read.
    layout : Layout
        What it looked like.
    time : ndarray, shape (n_samples,)
        Elapsed time as logged. [s]
    values : dict of str to ndarray, shape (n_samples,)
        By channel key, in the file's unit.
    scale : dict of str to (float, float)
        Factor and shift that bring each channel to SI, sign and zero applied.
    resampled : frozenset of str
        Channels that were interpolated.
    notes : tuple of str
        What the reader of the product has to know.
    """

    log: RawLog
    layout: Layout
    time: Floats
    values: dict[str, Floats]
    scale: dict[str, tuple[float, float]]
    resampled: frozenset[str]
    notes: tuple[str, ...]

    def channel(self, key: str) -> Channel:
        """Declaration of a channel; ``tension`` alone is ``tension.1``."""
        return self.layout.channels[_declared(self.layout, key)]

    def place_of(self, sample: int, channel: str) -> dict[str, str | int]:
        """File, row and channel of a sample, as the facts of an error; none without rows."""
        if self.log.first_row == 0 or self.resampled:
            return {}
        row = self.log.first_row + sample if self.log.row is None else int(self.log.row[sample])
        return {"file": self.log.source.name, "row": row, "channel": channel}

    def row_of(self, sample: int) -> str:
        """Where a sample stands in its file, in words."""
        place = self.place_of(sample, "")
        what = f"row {place['row']}" if place else f"sample {sample + 1}"
        return f"{what} of {self.log.source.name}"


def to_piece(log: RawLog, layout: Layout, *, gap_factor: float) -> Piece:
    """Bring a log to one time axis.

    Parameters
    ----------
    log : RawLog
        As it was read.
    layout : Layout
        What it looked like.
    gap_factor : float
        As in `reduction.settings.QualitySettings`. [1]

    Returns
    -------
    piece : Piece
        Channels that a record holds; others are named in the notes.

    Raises
    ------
    DataError
        If channels have no time or two time bases, or time starts again.
    """
    values, scale, unused = {}, {}, []
    for name, channel in layout.channels.items():
        kind = name.split(".")[0]
        key = f"{kind}.1" if name in ("tension", "strain") else name
        if kind in _USED:
            values[key] = log.columns[name]
            scale[key] = _scale(channel, layout.dimension(name))
        elif name != "time":
            unused.append(name)
    own = {
        key: _seconds(log.columns[f"{name}.time"], layout.channels[name].time_unit)
        for key, name in ((key, _declared(layout, key)) for key in values)
        if f"{name}.time" in log.columns
    }
    common = on_common_time(_shared_time(log, layout), values, own, gap_factor=gap_factor)
    notes = [*log.notes, *common.notes]
    if unused:
        notes.append(f"read, but not part of a record: {', '.join(unused)}")
    piece = Piece(log, layout, common.time, common.values, scale, common.resampled, tuple(notes))
    _check_restart(piece)
    return piece


def _declared(layout: Layout, key: str) -> str:
    return key if key in layout.channels else key.split(".")[0]


def _scale(channel: Channel, dimension: Dimension) -> tuple[float, float]:
    """Factor and shift to SI: the zero is taken off first, then the sign is applied."""
    factor, offset = scale_to_si(channel.unit, dimension)
    zero = 0.0 if channel.zero is None else parse_quantity(channel.zero, dimension)
    shift = channel.sign * (offset - zero)
    if channel.datum == "displacement" and channel.reference_length is not None:
        shift += parse_quantity(channel.reference_length, "length")
    return channel.sign * factor * channel.factor, shift


def _seconds(values: Floats, unit: str, ticks: float = 1.0) -> Floats:
    factor = ticks * (1.0 if unit == CLOCK else scale_to_si(unit, "time")[0])
    if factor == 1:
        return values
    seconds = empty_like(values)
    for part in sample_blocks(values.size, values, seconds):
        np.multiply(values[part], factor, out=seconds[part])
    return seconds


def _shared_time(log: RawLog, layout: Layout) -> Floats | None:
    if "time" in layout.channels:
        channel = layout.channels["time"]
        return _seconds(log.columns["time"], channel.unit, channel.factor)
    if layout.sample_interval is None:
        return None
    step = parse_quantity(layout.sample_interval, "time")
    if step <= 0:
        raise SettingsError(
            "sample_interval is not positive", found=layout.sample_interval, needed="above zero"
        )
    beside = next(iter(log.columns.values()), np.empty(0))
    time = empty_like(beside, shape=log.n_rows_read)
    for part in sample_blocks(time.size, time):
        time[part] = step * np.arange(part.start, part.stop)
    return time


def _check_restart(piece: Piece) -> None:
    """Refuse a log in which time starts again: a slip of the clock is short or small."""
    time, low, high = piece.time, np.inf, -np.inf
    for part in sample_blocks(time.size, time, overlap=1):
        block = time[part]
        falls = np.flatnonzero(np.diff(block) < 0)
        if falls.size:  # of all samples so far: a clock may slip at every hundredth
            first = np.fmin(np.fmin.accumulate(block)[falls], low)
            top = np.fmax(np.fmax.accumulate(block)[falls], high)
            is_far = top - block[falls + 1] > (top - first) / 2
            for last, reached in zip(part.start + falls[is_far], top[is_far], strict=True):
                _check_slip(piece, int(last), reached)
        low, high = np.fmin.reduce(block, initial=low), np.fmax.reduce(block, initial=high)


def _check_slip(piece: Piece, last: int, top: float) -> None:
    """Refuse a fall of time after which it goes on for some samples, below where it was."""
    time = piece.time
    after = time[last + 1 : last + 2 + _RESTART_SAMPLES]
    if after.size <= _RESTART_SAMPLES or after[-1] >= top or not np.all(np.diff(after) > 0):
        return
    place = piece.place_of(last + 1, "time")
    raise DataError(
        "the log has two time bases: time starts again",
        found=f"{after[0]:g} s after {time[last]:g} s"
        + ("" if place else f" at {piece.row_of(last + 1)}"),
        needed="one time that goes on",
        hint="Split the log, and give each part a test of its own.",
        **place,
    )

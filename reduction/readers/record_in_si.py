"""Converts logs in the file's own units to one record in SI."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from reduction.quantities.units import Dimension, parse_quantity, scale_to_si
from reduction.readers.columns import DAY, clock_reading, is_of_a_zone
from reduction.readers.layout import CLOCK, Channel, Layout
from reduction.readers.raw_log import RawLog
from reduction.readers.sample_flags import find_spikes, flag_record
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, LoadTrain, Record
from reduction.record.notes import Note, note
from reduction.record.samples import (
    empty_like,
    finite_extremes,
    join_columns,
    readings_between,
    sample_blocks,
    take_samples,
    zeros_like,
)
from reduction.record.settings import QualitySettings


def length_at_slack(layouts: Sequence[Layout]) -> float | None:
    """Thimble-to-thimble length at which, according to its layouts, a log is slack."""
    lengths = set()
    for layout in layouts:
        channel = layout.channels.get("crosshead_position")
        if channel is None or channel.datum != "displacement" or channel.reference_length is None:
            return None
        if parse_quantity(channel.reference_tension or "0 N", "force") > 0:
            return None
        lengths.add(parse_quantity(channel.reference_length, "length"))
    return lengths.pop() if len(lengths) == 1 else None


def reference_of(layouts: Sequence[Layout]) -> tuple[float | None, float]:
    """Length at displacement zero and the tension at which it was read, from all layouts.

    None and zero if they do not state it, or do not agree.
    """
    stated = set()
    for layout in layouts:
        channel = layout.channels.get("crosshead_position")
        if channel is None or channel.datum != "displacement" or channel.reference_length is None:
            return None, 0.0
        tension = parse_quantity(channel.reference_tension or "0 N", "force")
        stated.add((parse_quantity(channel.reference_length, "length"), tension))
    return stated.pop() if len(stated) == 1 else (None, 0.0)


def zero_to_set(layouts: Sequence[Layout], number: int, load: float) -> str:
    """Value of ``zero`` that makes a load reading zero; specimens count from 1.

    It is in the log's unit, before the sign is applied. Empty if the layouts of a log disagree.
    """
    texts = set()
    for layout in layouts:
        name = f"tension.{number}"
        channel = layout.channels.get(name) or layout.channels.get("tension")
        if channel is None:
            return ""
        size, _ = scale_to_si(channel.unit, "force")
        now = 0.0 if channel.zero is None else parse_quantity(channel.zero, "force")
        texts.add(f"{(now + channel.sign * load) / size:.4g} {channel.unit}")
    return texts.pop() if len(texts) == 1 else ""


_COUNTED = "cycle_counter"


@dataclass(frozen=True)
class _CommonTime:
    """Channels on one time axis."""

    time: Floats
    values: dict[str, Floats]
    resampled: frozenset[str] = frozenset()
    notes: tuple[Note, ...] = ()


@dataclass
class _Axis:
    time: Floats
    keys: list[str]

    @property
    def step(self) -> float:
        """Median of the forward steps. [s]."""
        steps = np.diff(self.time)
        steps = steps[steps > 0]
        return float(np.median(steps)) if steps.size else np.nan


def _on_common_time(
    shared: Floats | None,
    values: Mapping[str, Floats],
    own: Mapping[str, Floats],
    *,
    quality: QualitySettings,
) -> _CommonTime:
    """Bring channels to the time axis of the slowest, without their spikes."""
    axes: list[_Axis] = []
    trimmed: dict[str, Floats] = {}
    for key, series in values.items():
        time = own.get(key, shared)
        if time is None:
            raise DataError(
                f"channel '{key}' has no time",
                found="neither a time channel nor time stamps of its own",
                needed="a time channel, a time_column, or a sample_interval in the layout",
            )
        if own:  # the column of a slower channel ends before the table does
            stamped = np.flatnonzero(np.isfinite(time))
            if stamped.size < 2:
                raise DataError(
                    f"channel '{key}' has too few time stamps",
                    found=str(stamped.size),
                    needed="two or more",
                )
            time, series = time[: stamped[-1] + 1], series[: stamped[-1] + 1]
        trimmed[key] = series
        same = next((axis for axis in axes if _is_same(axis.time, time)), None)
        if same is None:
            axes.append(_Axis(time, [key]))
        else:
            same.keys.append(key)
    if len(axes) == 1:
        return _CommonTime(axes[0].time, trimmed)
    base = max(axes, key=lambda axis: axis.step)
    result = {key: trimmed[key] for key in base.keys}
    notes = []
    for axis in axes:
        if axis is base:
            continue
        _check_overlap(base, axis)
        for key in axis.keys:
            series, is_count = trimmed[key], key == _COUNTED
            # interpolation would spread a spike over the rows beside it
            spikes: Integers = (
                np.empty(0, dtype=np.intp)
                if is_count
                else np.flatnonzero(find_spikes(series, quality, axis.time))
            )
            if spikes.size:
                first = float(axis.time[spikes[0]])
                notes.append(
                    note("spikes-not-resampled", channel=key, n_samples=spikes.size, time=first)
                )
                series = series.copy()
                series[spikes] = np.nan
            result[key] = _interpolate(
                base.time, axis, series, quality.gap_factor, is_count=is_count
            )
        notes.append(
            note(
                "resampled",
                channels=", ".join(axis.keys),
                rate=1 / axis.step,
                base_rate=1 / base.step,
                base=", ".join(base.keys),
            )
        )
    moved = frozenset(key for axis in axes if axis is not base for key in axis.keys)
    return _CommonTime(base.time, {key: result[key] for key in values}, moved, tuple(notes))


def _is_same(one: Floats, other: Floats) -> bool:
    return one is other or np.array_equal(one, other, equal_nan=True)


def _check_overlap(base: _Axis, axis: _Axis) -> None:
    low, high = np.nanmin(axis.time), np.nanmax(axis.time)
    if np.count_nonzero((base.time >= low) & (base.time <= high)) < 2:
        raise DataError(
            "the log has two time bases",
            found=f"{', '.join(base.keys)} from {np.nanmin(base.time):g} to "
            f"{np.nanmax(base.time):g} s, {', '.join(axis.keys)} from {low:g} to {high:g} s",
            needed="time stamps that count from the same moment",
        )


def _interpolate(
    time: Floats, axis: _Axis, series: Floats, gap_factor: float, *, is_count: bool
) -> Floats:
    ahead = np.concatenate([[True], axis.time[1:] > np.fmax.accumulate(axis.time)[:-1]])
    ahead &= np.isfinite(axis.time)
    stamps, series = axis.time[ahead], series[ahead]
    after = np.clip(np.searchsorted(stamps, time), 1, max(stamps.size - 1, 1))
    if is_count:
        place = np.clip(np.searchsorted(stamps, time, side="right") - 1, 0, stamps.size - 1)
        result = series[place]
    else:
        result = readings_between(time, stamps, series)
    in_gap = (stamps[after] - stamps[after - 1] > gap_factor * axis.step) & (
        (time > stamps[after - 1]) & (time < stamps[after])
    )
    outside = ~((time >= stamps[0]) & (time <= stamps[-1]))
    return np.where(in_gap | outside, np.nan, result)


_OF_SPECIMENS = ("tension", "strain", "fill_pressure")

_USED = ("crosshead_position", "cycle_counter", *_OF_SPECIMENS)

_RESTART_SAMPLES = 3


@dataclass(frozen=True)
class _Piece:
    """One file of a record."""

    log: RawLog
    layout: Layout
    time: Floats
    values: dict[str, Floats]
    scale: dict[str, tuple[float, float]]
    resampled: frozenset[str]
    notes: tuple[Note, ...]

    def channel(self, key: str) -> Channel:
        """Declaration of a channel; ``tension`` without a number is ``tension.1``."""
        return self.layout.channels[_declared(self.layout, key)]

    def place_of(self, sample: int, channel: str) -> dict[str, str | int]:
        """File, row and channel of a sample, for an error message; empty without rows."""
        if self.log.first_row == 0 or self.resampled:
            return {}
        row = self.log.first_row + sample if self.log.row is None else int(self.log.row[sample])
        return {"file": self.log.source.name, "row": row, "channel": channel}

    def row_of(self, sample: int) -> str:
        """Position of a sample in its file, in words."""
        place = self.place_of(sample, "")
        what = f"row {place['row']}" if place else f"sample {sample + 1}"
        return f"{what} of {self.log.source.name}"


def _to_piece(log: RawLog, layout: Layout, *, quality: QualitySettings) -> _Piece:
    """Bring a log to one time axis."""
    values, scale, unused = {}, {}, []
    for name, channel in layout.channels.items():
        kind = name.split(".")[0]
        key = f"{kind}.1" if name in _OF_SPECIMENS else name
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
    shared, of_hour = _on_one_time_of_day(_shared_time(log, layout), log, layout)
    shared, of_clock = _between_ticks(shared, values)
    _stamp_rows_with_readings(shared, values, own)
    common = _on_common_time(shared, values, own, quality=quality)
    notes = [*log.notes, *of_hour, *of_clock, *common.notes]
    if unused:
        notes.append(note("channels-not-used", channels=", ".join(unused)))
    piece = _Piece(log, layout, common.time, common.values, scale, common.resampled, tuple(notes))
    _check_restart(piece)
    return piece


_BLANK = 1 / 3  # of the rows, at least, of a channel that is read less often than rows are written

_FEWEST_READ = 50

_IN_STEP = 0.98  # minimum share of readings at most this many usual intervals apart:

_INTERVALS = 3


def _stamp_rows_with_readings(
    shared: Floats | None, values: dict[str, Floats], own: dict[str, Floats]
) -> None:
    """Give a channel that is blank in most rows the times of its own readings, in place.

    A multi-rate logger writes a row whenever any channel is read. If all channels are blank in the
    same rows, they are left unchanged.

    Examples
    --------
    >>> load = np.where(np.arange(200) % 2, np.nan, 1.0)
    >>> values, own = {"crosshead_position": np.ones(200), "tension.1": load}, {}
    >>> _stamp_rows_with_readings(np.arange(200.0), values, own)
    >>> print(own["tension.1"][:3], values["tension.1"].size)
    [0. 2. 4.] 100
    """
    if shared is None or own or not np.isfinite(shared[:_LOOKED_AT]).all():
        return
    if not any(map(_is_mostly_blank, values.values())):
        return
    read = {key: np.isfinite(one) for key, one in values.items()}
    first, *others = read.values()
    if all(np.array_equal(first, one) for one in others):
        return
    for key, rows in read.items():
        if not rows.all():
            own[key], values[key] = shared[rows], values[key][rows]


def _is_mostly_blank(series: Floats) -> bool:
    """Whether readings and blanks alternate in its first rows."""
    looked = np.isfinite(series[: 16 * _LOOKED_AT])
    place = np.flatnonzero(looked)
    if place.size < _FEWEST_READ or place.size > (1 - _BLANK) * looked.size:
        return False
    gaps = np.diff(place)
    return bool(np.mean(gaps <= _INTERVALS * np.median(gaps)) >= _IN_STEP)


def _declared(layout: Layout, key: str) -> str:
    return key if key in layout.channels else key.split(".")[0]


def _scale(channel: Channel, dimension: Dimension) -> tuple[float, float]:
    """Factor and offset to SI: the zero is subtracted first, then the sign is applied."""
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


_HOUR = 3600.0  # s

_HOURS_OF_CHANGE = 4  # after midnight, the latest hour of a daylight-saving change


def _on_one_time_of_day(
    time: Floats | None, log: RawLog, layout: Layout
) -> tuple[Floats | None, tuple[Note, ...]]:
    """Clock time corrected for the one-hour changes of daylight saving.

    Time never goes back by an hour, so such a step is a change. A step forward is taken for one
    only at the hour of a change: few logs stop for an hour exactly on the hour.
    """
    texts = log.text.get("time", ())
    start = next(filter(None, map(clock_reading, texts)), None)
    if time is None or start is None or layout.channels["time"].unit != CLOCK:
        return time, ()
    known = np.flatnonzero(np.isfinite(time))
    steps = np.diff(time[known])
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else _HOUR
    if 4 * usual > _HOUR:
        return time, ()
    near = [(0 <= steps - way * _HOUR) & (steps - way * _HOUR <= 3 * usual) for way in (-1, 1)]
    into_hour = (start[1] + time[known[1:]]) % DAY
    on_hour = (into_hour % _HOUR < 3 * usual) & (into_hour < _HOUR * (_HOURS_OF_CHANGE + 1))
    is_zoned = is_of_a_zone(texts[int(known[0])])
    changes = [*np.flatnonzero(near[0]), *np.flatnonzero(near[1] & on_hour & (not is_zoned))]
    notes = []
    for place in sorted(changes):
        shift = -math.copysign(_HOUR, steps[place])
        time = np.concatenate([time[: known[place] + 1], time[known[place] + 1 :] + shift])
        notes.append(
            note("clock-changed", way="back" if shift > 0 else "forward", time=time[known[place]])
        )
    return time, tuple(notes)


_ROWS_OF_A_TICK = 1.5  # from this average on, the clock is coarser than the log

_ROWS_AT_AN_EVEN_RATE = 1.02  # the same if all times agree with an even rate

_LOOKED_AT = 4096  # rows examined to decide whether it can be

_FEWEST_TICKS = 8


def _between_ticks(
    time: Floats | None, values: Mapping[str, Floats]
) -> tuple[Floats | None, tuple[Note, ...]]:
    """Row times spread evenly where the clock gives several rows the same time.

    Rows within a tick of an even rate get that rate; others are spread over their own tick. A
    duplicated row does not count.

    Examples
    --------
    >>> clock = np.floor(np.arange(0.0, 20.0, 0.25))
    >>> spread, told = _between_ticks(clock, {"tension.1": np.sin(np.arange(80.0))})
    >>> print(np.diff(spread).round(6).max(), [one.code for one in told])
    0.25 ['clock-coarse']

    A step of 1 s and a reading every 0.83 s:

    >>> clock = np.floor(np.arange(0.0, 100.0, 0.83))
    >>> spread, told = _between_ticks(clock, {"tension.1": np.sin(np.arange(clock.size))})
    >>> print(np.diff(spread).round(2).max(), [one.code for one in told])
    0.83 ['clock-coarse']
    """
    if time is None or time.size < 2:
        return time, ()
    look = np.diff(time[:_LOOKED_AT])
    n_ahead = np.count_nonzero(look > 0)
    if not np.isfinite(look).all() or n_ahead * _ROWS_AT_AN_EVEN_RATE > look.size:
        return time, ()
    steps = np.diff(time)
    ahead = np.flatnonzero(steps > 0)
    if not (steps >= 0).all() or ahead.size < _FEWEST_TICKS:
        return time, ()
    again = np.flatnonzero(steps == 0)
    twice = np.ones(again.size, dtype=bool)
    for one in values.values():
        twice &= one[again] == one[again + 1]
    if 2 * np.count_nonzero(twice) > again.size:
        return time, ()
    tick = float(np.median(steps[ahead]))
    place = np.arange(time.size)
    # the clock advances within the row before: known to one row if its steps are long
    middle = ahead.mean()
    rate, begin = np.polyfit(ahead - middle, time[ahead + 1], 1)
    even = begin + rate * (place - middle)
    said = {"tick": tick, "rows": time.size / (ahead.size + 1)}
    if np.ptp(time - even) < 1.5 * tick:
        return even, (note("clock-coarse", **said),)
    if n_ahead * _ROWS_OF_A_TICK > look.size:
        return time, ()
    first = np.concatenate([[0], ahead + 1])
    count = np.diff(first, append=time.size)
    share = (place - np.repeat(first, count) + 0.5) / np.repeat(count, count)
    return time + tick * share, (note("clock-coarse-uneven", **said),)


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


def _check_restart(piece: _Piece) -> None:
    """Refuse a log in which time restarts; a clock slip is brief or small."""
    time, low, high = piece.time, np.inf, -np.inf
    for part in sample_blocks(time.size, time, overlap=_RESTART_OVERLAP):
        known = np.flatnonzero(np.isfinite(time[part]))  # blank rows may part two runs
        block, known = time[part][known], known + part.start
        falls = np.flatnonzero(np.diff(block) < 0)
        if falls.size:  # from the latest time so far: a clock may slip at every hundredth sample
            first = np.fmin(np.fmin.accumulate(block)[falls], low)
            top = np.fmax(np.fmax.accumulate(block)[falls], high)
            is_far = top - block[falls + 1] > (top - first) / 2
            for last, reached in zip(falls[is_far], top[is_far], strict=True):
                _check_slip(piece, int(known[last]), int(known[last + 1]), reached)
        low, high = np.fmin.reduce(block, initial=low), np.fmax.reduce(block, initial=high)


_RESTART_OVERLAP = 8  # samples: more blank rows between two runs, at the seam of blocks, hide one


def _check_slip(piece: _Piece, last: int, fallen: int, top: float) -> None:
    """Refuse a fall in time that then runs on for some samples below its earlier maximum."""
    time = piece.time
    after = time[fallen : fallen + 1 + _RESTART_SAMPLES]
    if after.size <= _RESTART_SAMPLES or after[-1] >= top or not np.all(np.diff(after) > 0):
        return
    place = piece.place_of(fallen, "time")
    step = float(after[1] - after[0])
    wraps = [one for one in _WRAPS if 0 <= one - time[last] < 2 * step and 0 <= after[0] < 2 * step]
    raise DataError(
        "the log has two time bases: time starts again",
        found=f"{after[0]:g} s after {time[last]:g} s"
        + ("" if place else f" at {piece.row_of(fallen)}"),
        needed="one time that keeps rising",
        hint=f"The clock restarts every {wraps[0]:g} s: at each restart, add that much to the time "
        "of all later rows."
        if wraps
        else "Split the log, and make each part a separate test.",
        **place,
    )


# a minute, an hour, and the overflow of 16-bit counters in ms and 32-bit counters in us and ms
_WRAPS = (60.0, 65.536, 3600.0, 4294.967296, 4294967.296)

_WORKERS = 4

_NO_COUNT = -1

_DATUM_SHARE = 0.05

_AROUND = 50  # readings

_BEND_OF_NOISE = 0.67449 * math.sqrt(6)  # median second difference of normal noise

_CLEAR_OF_NOISE = 4.0

_ABSURD = 1e9  # m, N or 1: beyond any machine's length or load

_ABSURD_TIME = 1e12  # s: 30,000 years, beyond which a float cannot serve as a clock


def to_record(
    logs: Sequence[tuple[RawLog, Layout]],
    *,
    test_id: str,
    specimens: Sequence[str],
    quality: QualitySettings,
    length_needed: bool = True,
) -> Record:
    """Convert the log or logs of a test; several logs make one record in pieces, in order."""
    if not logs:
        raise SettingsError(f"test '{test_id}' has no file", needed="one or more logs")
    counts = [_check_channels(layout, test_id, len(specimens)) for _, layout in logs]
    position_is_length = _check_datum([layout for _, layout in logs], test_id, length_needed)
    pieces = [_to_piece(log, layout, quality=quality) for log, layout in logs]
    pieces = _on_one_clock(pieces)
    _check_order(pieces)
    n_samples = sum(piece.time.size for piece in pieces)
    beside, rows = pieces[0].time, (len(specimens), n_samples)
    position = empty_like(beside, shape=n_samples)
    tension = empty_like(beside, shape=rows)
    strain, pressure = (
        empty_like(beside, shape=rows) if any(one[kind] for one in counts) else None
        for kind in ("strain", "fill_pressure")
    )
    targets = [("crosshead_position", position)]
    for kind, series in zip(_OF_SPECIMENS, (tension, strain, pressure), strict=True):
        if series is not None:
            targets += [(f"{kind}.{number}", row) for number, row in enumerate(series, 1)]
    with ThreadPoolExecutor(_WORKERS) as workers:  # first access to fresh memory is slow
        list(workers.map(lambda target: _fill(target[1], pieces, target[0]), targets))
    counter, counter_notes = _counter(pieces, n_samples)
    for piece in pieces:
        _check_clock(piece)
    times = [piece.time for piece in pieces]
    record = Record(
        test_id=test_id,
        specimens=tuple(specimens),
        time=join_columns(times),
        crosshead_position=position,
        tension=tension,
        quality_flag=zeros_like(tension, dtype=np.uint16),
        crosshead_position_quality_flag=zeros_like(position, dtype=np.uint16),
        measured_strain=strain,
        fill_pressure=pressure,
        cycle_counter=counter,
        position_is_length=position_is_length,
        n_rows_read=sum(log.n_rows_read for log, _ in logs),
        tension_standard_uncertainty=tuple(
            _uncertainty(pieces, f"tension.{number}", "force")
            for number in range(1, len(specimens) + 1)
        ),
        position_standard_uncertainty=_uncertainty(pieces, "crosshead_position", "length"),
        fill_pressure_standard_uncertainty=tuple(
            _uncertainty(pieces, f"fill_pressure.{number}", "stress")
            for number in range(1, len(specimens) + 1)
            if pressure is not None
        ),
        metadata=_metadata(pieces),
        notes=(*_piece_notes(pieces), *counter_notes),
        load_train=_load_train([layout for _, layout in logs], test_id),
    )
    return flag_record(
        record,
        settings=quality,
        resampled=sorted(frozenset().union(*(piece.resampled for piece in pieces))),
        verified=_verified(pieces, len(specimens)),
        notes=_datum_notes(record, pieces[0]),
    )


def _check_channels(layout: Layout, test_id: str, n_specimens: int) -> dict[str, int]:
    """Check the channels of every specimen; returns the number of each kind."""
    if "crosshead_position" not in layout.channels:
        raise SettingsError(
            f"test '{test_id}': its layout has no crosshead_position channel",
            found=", ".join(layout.channels),
            needed="crosshead_position",
            hint="Add it to the layout; of a log with strain alone, the column of strain with the"
            " gauge length as factor. Where `reduction init` found no column, the comments of the"
            " draft say why: a table of the extremes of each cycle has none.",
        )
    counts = {}
    for kind in _OF_SPECIMENS:
        there = [name for name in layout.channels if name.split(".")[0] == kind]
        wanted = [[f"{kind}.{number}" for number in range(1, len(there) + 1)], [kind]]
        if there and sorted(there) not in [sorted(names) for names in wanted]:
            raise SettingsError(
                f"test '{test_id}': the {kind} channels of its layout are not numbered from 1",
                found=", ".join(there),
                needed=", ".join(wanted[0]),
            )
        counts[kind] = len(there)
    wrong = [
        kind
        for kind, count in counts.items()
        if count != n_specimens and (count or kind == "tension")
    ]
    if wrong:
        kind = wrong[0]
        raise SettingsError(
            f"test '{test_id}': its layout has {counts[kind]} {kind} channels "
            f"for {n_specimens} specimens",
            found=", ".join(name for name in layout.channels if name.startswith(kind)) or "none",
            needed=", ".join(f"{kind}.{number}" for number in range(1, n_specimens + 1)),
        )
    return counts


def _check_datum(layouts: Sequence[Layout], test_id: str, length_needed: bool) -> bool:
    """Whether position is a length in every layout."""
    is_length = set()
    for layout in layouts:
        channel = layout.channels["crosshead_position"]
        is_length.add(channel.datum == "pin-to-pin" or channel.reference_length is not None)
    if (length_needed and False in is_length) or len(is_length) > 1:
        raise SettingsError(
            f"test '{test_id}': a displacement is used as a length",
            found='crosshead_position with datum = "displacement" and no reference_length',
            needed="reference_length, the thimble-to-thimble length at displacement zero",
            hint="Measure it at slack, or at a reference_tension that is stated too.",
        )
    return is_length == {True}


def _load_train(layouts: Sequence[Layout], test_id: str) -> LoadTrain:
    """Load train stated by the layouts, which must agree."""
    stated = list(dict.fromkeys(layout.load_train for layout in layouts))
    if len(stated) > 1:
        raise SettingsError(
            f"test '{test_id}': the layouts of its pieces state different load trains",
            found=" and ".join(str(one) for one in stated),
            needed="one load_cell_at, attached_mass and machine_compliance for all pieces",
        )
    return stated[0]


def _on_one_clock(pieces: list[_Piece]) -> list[_Piece]:
    """Clock times counted from the first reading of the first piece; undated pieces follow on."""
    starts = [
        next(filter(None, map(clock_reading, piece.log.text.get("time", ()))), None)
        for piece in pieces
    ]
    placed: list[_Piece] = []
    for piece, start in zip(pieces, starts, strict=True):
        if starts[0] is None or start is None:
            return pieces
        after = DAY * (start[0] - starts[0][0]) + start[1] - starts[0][1]
        if math.isnan(after):
            if not math.isnan(start[0]) or not math.isnan(starts[0][0]):
                return pieces  # only some have a date
            end = finite_extremes(placed[-1].time)[1] if placed else 0.0
            after = end + (start[1] - starts[0][1] - end) % DAY
        placed.append(replace(piece, time=piece.time + after) if after else piece)
    return placed


def _check_order(pieces: Sequence[_Piece]) -> None:
    """Check that time increases across pieces, and that strain and counter are in all or none."""
    for before, after in pairwise(pieces):
        end, start = finite_extremes(before.time)[1], finite_extremes(after.time)[0]
        if start <= end:
            raise DataError(
                "the pieces of a record have two time bases",
                found=f"{after.log.source.name} from {start:g} s, "
                f"{before.log.source.name} to {end:g} s",
                needed="pieces in order, in which time keeps rising",
                hint="If each piece counts time from zero, make it a separate test.",
            )
        if set(before.values) != set(after.values):
            raise SettingsError(
                "the pieces of a record have different channels",
                found=f"{', '.join(before.values)} in {before.log.source.name}, "
                f"{', '.join(after.values)} in {after.log.source.name}",
                needed="the same channels in all pieces",
            )


def _fill(target: Floats, pieces: Sequence[_Piece], key: str) -> None:
    """Write a channel of all pieces in SI, one piece after another."""
    start = 0
    for piece in pieces:
        part = target[start : start + piece.time.size]
        factor, shift = piece.scale[key]
        values = piece.values[key]
        is_absurd = False
        for block in sample_blocks(part.size, values, target):
            np.multiply(values[block], factor, out=part[block])
            if shift:
                part[block] += shift
            low, high = part[block].min(), part[block].max()
            is_absurd |= not (low >= -_ABSURD and high <= _ABSURD)  # so is a NaN, at first
        if is_absurd:
            _check_size(part, piece, key)
        start += piece.time.size


def _check_size(part: Floats, piece: _Piece, key: str) -> None:
    """Refuse values that no machine can have measured."""
    absurd = np.concatenate(
        [
            block.start + np.flatnonzero(np.abs(part[block]) > _ABSURD)
            for block in sample_blocks(part.size, part)
        ]
    )
    if absurd.size:
        raise DataError(
            f"{key} has {absurd.size} values that no instrument can read, first at"
            f" {piece.row_of(int(absurd[0]))}",
            found=f"{part[absurd[0]]:g} in SI",
            needed=f"at most {_ABSURD:g}",
            hint="Check the unit and the column; list a value that stands for a missing reading in"
            " `missing` of the layout.",
        )


def _check_clock(piece: _Piece) -> None:
    """Refuse times that no clock can have shown."""
    low, high = finite_extremes(piece.time)
    if low < -_ABSURD_TIME or high > _ABSURD_TIME:
        value = low if low < -_ABSURD_TIME else high
        raise DataError(
            f"the time of {piece.log.source.name} has values that no clock can show",
            found=f"{value:g} s",
            needed=f"at most {_ABSURD_TIME:g} s",
            hint="Check the unit and the column of the time channel.",
        )


def _counter(pieces: Sequence[_Piece], n_samples: int) -> tuple[Integers | None, tuple[Note, ...]]:
    """The machine's cycle count as integers, -1 where missing."""
    key = "cycle_counter"
    if key not in pieces[0].values:
        return None, ()
    count = empty_like(pieces[0].time, shape=n_samples)
    _fill(count, pieces, key)
    whole, n_missing = empty_like(count, dtype=np.int64), 0
    for part in sample_blocks(n_samples, count, whole):
        block = count[part]
        missing = np.isnan(block)
        n_missing += int(np.count_nonzero(missing))
        numbers = np.where(missing, _NO_COUNT, block)
        whole[part] = numbers
        odd = np.flatnonzero(whole[part] != numbers)
        if odd.size:
            raise DataError(
                "the cycle counter is not a whole number, first at sample"
                f" {part.start + int(odd[0]) + 1}",
                found=f"{block[odd[0]]:g}",
                needed="whole numbers",
            )
    if n_missing:
        return whole, (note("counter-missing", n_rows=n_missing),)
    return whole, ()


def _uncertainty(pieces: Sequence[_Piece], key: str, dimension: Dimension) -> float:
    """Largest declared standard uncertainty; NaN if a piece declares none."""
    texts = [piece.channel(key).standard_uncertainty for piece in pieces]
    return max(
        (np.nan if text is None else parse_quantity(text, dimension) for text in texts),
        key=lambda value: np.inf if np.isnan(value) else value,
    )


def _metadata(pieces: Sequence[_Piece]) -> dict[str, str]:
    metadata: dict[str, str] = {}
    for piece in pieces:
        for key, value in piece.log.metadata.items():
            same = metadata.get(key, value) == value
            metadata[key if same else f"{key} ({piece.log.source.name})"] = value
    return metadata


def _piece_notes(pieces: Sequence[_Piece]) -> list[Note]:
    if len(pieces) == 1:
        return list(pieces[0].notes)
    joined = " and ".join(piece.log.source.name for piece in pieces)
    named = [replace(one, subject=piece.log.source.name) for piece in pieces for one in piece.notes]
    return [note("record-of-pieces", n_pieces=len(pieces), files=joined), *named]


def _verified(
    pieces: Sequence[_Piece], n_specimens: int
) -> dict[tuple[int, int, int], tuple[float, float]]:
    """Verified range of each load cell by specimen, first row and end row (exclusive). [N]."""
    verified = {}
    start = 0
    for piece in pieces:
        stop = start + int(piece.time.size)
        for index in range(n_specimens):
            limits = piece.channel(f"tension.{index + 1}").verified_range
            if limits is not None:
                low, high = (parse_quantity(limit, "force") for limit in limits)
                verified[index, start, stop] = (low, high)
        start = stop
    return verified


def _datum_notes(record: Record, piece: _Piece) -> tuple[Note, ...]:
    """Compare the tension at displacement zero with that at which the length was read."""
    channel = piece.channel("crosshead_position")
    if channel.datum != "displacement" or channel.reference_length is None:
        return ()
    zero = parse_quantity(channel.reference_length, "length")
    stated = parse_quantity(channel.reference_tension or "0 N", "force")
    position = record.crosshead_position
    passes = []
    for part in sample_blocks(position.size, position, overlap=1):
        away = position[part] - zero
        passes.append(part.start + np.flatnonzero(away[:-1] * away[1:] <= 0))
    before = np.concatenate(passes)
    before = before[before + 2 < position.size]
    before = before[~(_drops_out(position, before) | _drops_out(position, before + 1))]
    if not before.size:
        return tuple(_never_zero(record, zero, stated))
    begin, span = position[before], position[before] - position[before + 1]
    weight = np.divide(begin - zero, span, out=np.zeros_like(span), where=span != 0)
    notes = []
    for name, load in zip(record.specimens, record.tension, strict=True):
        found = load[before] + weight * (load[before + 1] - load[before])
        low, high = finite_extremes(load)
        # the noise of one reading, from the second differences around the first pass
        first = int(before[0])
        bends = np.abs(np.diff(load[max(first - _AROUND, 0) : first + 1 + _AROUND], n=2))
        bends = bends[np.isfinite(bends)]
        noise = float(np.median(bends)) / _BEND_OF_NOISE if bends.size else 0.0
        beyond = max(_DATUM_SHARE * (high - low), _CLEAR_OF_NOISE * noise)
        away = found - stated
        # a damper has loads of both signs there, one on the way up and one on the way down
        if abs(away[0]) > beyond and not (away * np.sign(away[0]) < -beyond).any():
            code = "reference-length-under-preload" if away[0] > 0 else "reference-length-elsewhere"
            notes.append(note(code, stated=stated, specimen=name, found=float(found[0])))
    return tuple(notes)


def _drops_out(position: Floats, at: Integers) -> Bools:
    """Whether a reading lies beyond both beside it, by more than these differ from the next."""
    places = np.clip(at + np.arange(-2, 3)[:, None], 0, position.size - 1)
    earlier, before, here, after, later = take_samples(position, places)
    usual = np.abs(before - earlier) + np.abs(later - after)
    least = np.minimum(np.abs(before - here), np.abs(after - here))
    return np.asarray(((before - here) * (after - here) > 0) & (least > _DROP * usual))


_DROP = 3.0

_NO_SET = 0.2  # of a length: no rope or rubber is left longer by a fifth


def _never_zero(record: Record, length: float, stated: float) -> Iterator[Note]:
    """Say of specimens without load far from displacement zero that it was not set there."""
    away = np.abs(record.crosshead_position - length)
    if not np.isfinite(away).any():
        return
    nearest = int(np.nanargmin(away))
    strain = float(record.crosshead_position[nearest]) / length - 1
    for name, load in zip(record.specimens, record.tension, strict=True):
        low, high = finite_extremes(load)
        if strain > _NO_SET and abs(load[nearest] - stated) < _DATUM_SHARE * (high - low):
            yield note("reference-length-never-read", specimen=name, strain=strain,
                       displacement=strain * length, load=float(load[nearest]))  # fmt: skip

"""TDMS logs.

A channel's ``unit_string`` is checked against the declared unit.  A log without a time channel
states its times in the waveform properties of its channels: the layout then declares the column
``wf_increment``, and time is ``wf_start_offset`` plus ``wf_increment`` times the sample number.
"""

from __future__ import annotations

import logging
import re
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import nptdms
import numpy as np
from nptdms.log import log_manager
from numpy.typing import NDArray

from reduction.readers.columns import (
    ColumnTable,
    DeclaredColumn,
    check_unit,
    declared_columns,
    find_column,
    read_columns,
    row_parts,
)
from reduction.readers.layout import Layout, LogParts, Watch, short_metadata
from reduction.readers.raw_log import RawLog, hash_source
from reduction.record.errors import LogError
from reduction.record.measurement import Floats
from reduction.record.notes import note

WAVEFORM_COLUMN = "wf_increment"

_SCALES = "NI_Number_Of_Scales"

_SCALE = re.compile(r"NI_Scale\[(\d{1,18})\]")

_MOST_SCALES = 1000

_NOT_TDMS = (
    ValueError, KeyError, TypeError, OSError, EOFError, struct.error, IndexError,
    NotImplementedError, OverflowError, RecursionError, MemoryError, ZeroDivisionError,
)  # fmt: skip

# npTDMS prints messages that this module turns into notes and errors
log_manager.set_level(logging.CRITICAL)


@contextmanager
def open_tdms(path: Path) -> Iterator[nptdms.TdmsFile]:
    """Open a TDMS file; `LogError` for any other file."""
    with path.open("rb") as stream:
        try:
            file = nptdms.TdmsFile.open(stream)
        except _NOT_TDMS as error:
            raise LogError(
                path, "the file is not TDMS", found=str(error)[:200], needed="a .tdms file"
            ) from error
        with file:
            yield file


def _tdms_group(path: Path, file: nptdms.TdmsFile, group: str) -> nptdms.TdmsGroup:
    """The named group, or the only one if no name is given."""
    names = [entry.name for entry in file.groups()]
    if not group and len(names) == 1:
        return file[names[0]]
    if group not in names:
        raise LogError(
            path,
            f"there is no group '{group}'" if group else "the layout names no group",
            found=", ".join(repr(name) for name in names) or "no groups",
            needed="group in the layout, one of these",
        )
    return file[group]


def tdms_table(
    path: Path, file: nptdms.TdmsFile, group: nptdms.TdmsGroup, watch: Watch
) -> ColumnTable:
    """Channels of a group as columns."""
    channels = group.channels()
    watch.check_columns(len(channels))
    most = 8 * path.stat().st_size  # a value takes at least one bit
    for channel in channels:
        if len(channel) > most:
            raise LogError(
                path, "a channel states more values than the file holds", channel=channel.name[:80],
                found=f"{len(channel):,} values", needed="an intact .tdms file",
            )  # fmt: skip

    def load(place: int, n_rows: int) -> Iterator[NDArray[Any]]:
        channel = channels[place]
        _check_scales(path, file, group, channel)
        try:
            for part in row_parts(len(channel), n_rows):
                yield np.asarray(channel[part])
        except _NOT_TDMS as error:
            raise LogError(
                path, "a channel cannot be read", channel=channel.name,
                found=str(error)[:200], needed="an intact .tdms file",
            ) from error  # fmt: skip

    return ColumnTable(
        names=tuple(channel.name for channel in channels),
        units=tuple(str(channel.properties.get("unit_string", "")) for channel in channels),
        load=load,
        n_rows=max((len(channel) for channel in channels), default=0),
        where=f"group '{group.name}'",
        sizes=tuple(len(channel) for channel in channels),
    )


def _check_scales(path: Path, *holders: Any) -> None:
    """Limit the number of scales, since the library creates as many as a property states."""
    for holder in holders:
        stated = holder.properties.get(_SCALES, 0)
        numbers = [int(match[1]) for key in holder.properties if (match := _SCALE.match(key))]
        if not isinstance(stated, (int, np.integer)) or not 0 <= stated <= _MOST_SCALES:
            found = f"{_SCALES} {str(stated)[:40]}"
        elif max(numbers, default=0) > _MOST_SCALES:
            found = f"scale {max(numbers)}"
        else:
            continue
        raise LogError(
            path, "a channel cannot be scaled", found=found, needed=f"{_MOST_SCALES} scales at most"
        )


def _waveform(
    path: Path, wanted: DeclaredColumn, channel: nptdms.TdmsChannel
) -> tuple[Any, float, float]:
    """Start, offset and increment of a channel's waveform."""
    properties = channel.properties
    increment = float(properties.get(WAVEFORM_COLUMN, 0.0))
    if increment <= 0:
        raise LogError(
            path,
            f"channel '{channel.name}' does not say its sampling interval",
            channel=str(wanted.column),
            found=f"properties {', '.join(properties) or 'none'}",
            needed=f"{WAVEFORM_COLUMN} above zero, or a time channel",
        )
    check_unit(path, wanted, str(properties.get("wf_xunit_string", "")) or "s")
    return properties.get("wf_start_time"), float(properties.get("wf_start_offset", 0)), increment


def _waveform_times(
    path: Path, layout: Layout, group: nptdms.TdmsGroup, table: ColumnTable
) -> dict[str, Callable[[int], Iterator[Floats]]]:
    """Times that the layout takes from waveform properties, by channel key, in parts."""
    if WAVEFORM_COLUMN in table.names:  # a channel of that name is read like any other
        return {}
    wanted = {want.key: want for want in declared_columns(layout)}
    channels = group.channels()

    def waveform(key: str, clock: DeclaredColumn) -> tuple[tuple[Any, float, float], int]:
        place = find_column(path, wanted[key], table.names, where=table.where)
        return _waveform(path, clock, channels[place]), len(channels[place])

    times: dict[str, Callable[[int], Iterator[Floats]]] = {}
    zero = None
    clock = wanted.get("time")
    if clock is not None and clock.column == WAVEFORM_COLUMN:
        shared = [
            key for key, channel in layout.channels.items()
            if key != "time" and channel.time_column is None
        ]  # fmt: skip
        found = {key: waveform(key, clock) for key in shared}
        if len({properties for properties, _ in found.values()}) != 1:
            raise LogError(
                path,
                "the channels have two time bases",
                channel=WAVEFORM_COLUMN,
                found=", ".join(
                    f"{key} every {increment:g} s from {offset:g} s after {start}"
                    for key, ((start, offset, increment), _) in found.items()
                )
                or "no channel without own time stamps",
                needed="one start and one sampling interval",
                hint=f'Give a channel of another rate time_column = "{WAVEFORM_COLUMN}".',
            )
        (zero, offset, increment), size = found[shared[0]]
        times["time"] = partial(_regular, offset, increment, size)
    for key, channel in layout.channels.items():
        if channel.time_column == WAVEFORM_COLUMN:
            (start, offset, increment), size = waveform(key, wanted[f"{key}.time"])
            if zero is not None and start is not None:
                offset += float((start - zero) / np.timedelta64(1, "s"))
            times[f"{key}.time"] = partial(_regular, offset, increment, size)
    return times


def _regular(offset: float, increment: float, size: int, n_rows: int) -> Iterator[Floats]:
    """Times of a waveform, in parts of `n_rows`."""
    for part in row_parts(size, n_rows):
        yield offset + increment * np.arange(part.start, part.stop, dtype=np.float64)


def read_tdms(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: LogParts | None = None,
    watch: Watch | None = None,
) -> RawLog:
    """Read the declared channels of one group; channel scaling in the file is applied."""
    source = hash_source(path, name)
    watch = watch or Watch(path)
    with open_tdms(path) as file:
        group = _tdms_group(path, file, layout.group)
        table = tdms_table(path, file, group, watch)
        made = _waveform_times(path, layout, group, table)
        columns, n_rows = read_columns(path, layout, table, made, parts=parts, watch=watch)
        metadata, notes = short_metadata(
            {key: str(value) for key, value in {**file.properties, **group.properties}.items()}
        )
        cut = file.file_status.incomplete_final_segment
    return RawLog(
        source=source,
        columns=columns,
        first_row=0,
        n_rows_read=n_rows,
        metadata=metadata,
        notes=(note("log-cut-off"), *notes) if cut else notes,
    )

"""Reads the files of a test, in any format."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from reduction.quantities.units import parse_quantity, scale_to_si
from reduction.readers.blocks import read_blocks
from reduction.readers.bounded_reader import bounded
from reduction.readers.delimited import read_delimited
from reduction.readers.hdf5 import read_hdf5
from reduction.readers.json_matrix import read_json
from reduction.readers.layout import Channel, Format, Layout, LogParts, Watch
from reduction.readers.parquet import read_parquet
from reduction.readers.raw_log import RawLog, unchanged
from reduction.readers.record_in_si import to_record
from reduction.record.errors import LogError, SettingsError
from reduction.record.measurement import Floats, Record, Source, StepReadings
from reduction.record.samples import trim_heap_after
from reduction.record.settings import Limits, QualitySettings


# each imports its own package, which most campaigns do not need
def _read_tdms(path: Path, layout: Layout, **given: Any) -> RawLog:
    from reduction.readers.tdms import read_tdms

    return read_tdms(path, layout, **given)


def _read_matlab(path: Path, layout: Layout, **given: Any) -> RawLog:
    from reduction.readers.matlab import read_matlab

    return read_matlab(path, layout, **given)


def _read_spreadsheet(path: Path, layout: Layout, **given: Any) -> RawLog:
    from reduction.readers.spreadsheet import read_spreadsheet

    return read_spreadsheet(path, layout, **given)


_IN_PARTS: dict[Format, Callable[..., RawLog]] = {
    "delimited": read_delimited,
    "blocks": read_blocks,
    "tdms": _read_tdms,
    "hdf5": read_hdf5,
    "parquet": read_parquet,
}

_WHOLE: dict[Format, Callable[..., RawLog]] = {
    "spreadsheet": _read_spreadsheet,
    "matlab": _read_matlab,
    "json": read_json,
}

_TEXTS = ("delimited", "blocks", "json")  # read by this package, in this process


def read_log(
    path: Path,
    layout: Layout,
    *,
    name: str,
    parts: LogParts | None = None,
    limits: Limits | None = None,
) -> RawLog:
    """Read a log with its declared layout."""
    watch = Watch(path, limits)
    with unchanged(path) as n_bytes:
        watch.check_size(n_bytes)
        given: dict[str, Any] = {"name": name, "watch": watch}
        if layout.format in _IN_PARTS:
            given["parts"] = parts or LogParts()
        read = (_IN_PARTS | _WHOLE)[layout.format]
        if layout.format in _TEXTS:
            return read(path, layout, **given)
        return bounded(read, path, layout, **given)


def read_record(
    files: Sequence[tuple[Path, Layout, str]],
    *,
    test_id: str,
    specimens: Sequence[str],
    quality: QualitySettings,
    length_needed: bool = True,
    limits: Limits | None = None,
) -> tuple[Record, tuple[Source, ...]]:
    """Read the file or files of a test."""
    logs = [
        (read_log(path, layout, name=name, limits=limits), layout) for path, layout, name in files
    ]
    record = to_record(
        logs, test_id=test_id, specimens=specimens, quality=quality, length_needed=length_needed
    )
    trim_heap_after(record.time)
    return record, tuple(log.source for log, _ in logs)


_NEEDED = ("time", "tension.1", "gauge_length")


def _si(log: RawLog, layout: Layout, name: str) -> Floats:
    channel = layout.channels[name]
    factor, offset = (1.0, 0.0)
    if channel.unit != "clock":
        factor, offset = scale_to_si(channel.unit, layout.dimension(name))
    values = factor * channel.factor * log.columns[name] + offset
    if channel.zero is not None:
        values = values - parse_quantity(channel.zero, layout.dimension(name))
    return channel.sign * values


def _uncertainty(channel: Channel, layout: Layout, name: str) -> float:
    text = channel.standard_uncertainty
    return float("nan") if text is None else parse_quantity(text, layout.dimension(name))


def read_step_readings(
    files: Sequence[tuple[Path, Layout, str]], *, test_id: str, limits: Limits
) -> tuple[StepReadings, tuple[Source, ...]]:
    """Read the log of a stepwise test."""
    if len(files) != 1:
        raise SettingsError(
            f"stepwise test '{test_id}' has several files", found=str(len(files)), needed="one"
        )
    path, layout, name = files[0]
    lacking = [channel for channel in _NEEDED if channel not in layout.channels]
    if lacking:
        raise SettingsError(
            f"the layout of stepwise test '{test_id}' lacks a channel",
            found=", ".join(layout.channels),
            needed="time, tension.1 and gauge_length (the length between the marks)",
        )
    log = read_log(path, layout, name=name, limits=limits)
    for channel in _NEEDED:
        missing = log.missing(channel)
        if missing.any():
            first = int(np.flatnonzero(missing)[0])
            raise LogError(
                path,
                "a step has no reading",
                row=log.first_row + first if log.row is None else int(log.row[first]),
                channel=str(layout.channels[channel].column),
                needed="a number; leave the row out if it was not read",
            )
    nothing = np.full(log.n_rows_read, np.nan)
    time = _si(log, layout, "time")
    return (
        StepReadings(
            clock=log.text.get("time", tuple(f"{value:g}" for value in log.columns["time"])),
            time=time - time[0],
            tension=_si(log, layout, "tension.1"),
            length=_si(log, layout, "gauge_length"),
            eye_to_eye_length=_si(log, layout, "eye_to_eye_length")
            if "eye_to_eye_length" in layout.channels
            else nothing,
            printed_strain=_si(log, layout, "strain.1")
            if "strain.1" in layout.channels
            else nothing,
            length_standard_uncertainty=_uncertainty(
                layout.channels["gauge_length"], layout, "gauge_length"
            ),
            tension_standard_uncertainty=_uncertainty(
                layout.channels["tension.1"], layout, "tension.1"
            ),
            metadata=log.metadata,
            notes=log.notes,
        ),
        (log.source,),
    )

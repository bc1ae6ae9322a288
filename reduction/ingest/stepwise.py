"""Stepwise tests: one row a weight, read by a person; a log to `StepReadings` in SI."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reduction.errors import LogError, SettingsError
from reduction.ingest.layout import Channel, Layout
from reduction.ingest.rawlog import RawLog
from reduction.ingest.read import read_log
from reduction.provenance import Source
from reduction.record import Floats, StepReadings
from reduction.settings import Limits
from reduction.units import parse_quantity, scale_to_si

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
    files: Sequence[tuple[Path, Layout, str]], *, test_id: str, limits: Limits | None = None
) -> tuple[StepReadings, tuple[Source, ...]]:
    """Read the log of a stepwise test.

    Parameters
    ----------
    files : sequence of (path, layout, name)
        One file; a stepwise test is too short to come in pieces.
    test_id : str
        For messages.
    limits : Limits, optional
        What the file may be.

    Returns
    -------
    readings : StepReadings
        In SI.
    sources : tuple of Source
        The file.

    Raises
    ------
    SettingsError
        If there is not one file, or the layout lacks a channel.
    LogError
        If the file cannot be read, or a needed reading is missing.
    """
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

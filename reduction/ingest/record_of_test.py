"""The way in: the files of a test to its record, with where they came from."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reduction.ingest.convert import to_record
from reduction.ingest.layout import Layout
from reduction.ingest.parts import Parts
from reduction.ingest.read import read_log
from reduction.provenance import Source
from reduction.record import Record
from reduction.samples.scratch import give_back
from reduction.settings import Limits, QualitySettings


def read_record(
    files: Sequence[tuple[Path, Layout, str]],
    *,
    test_id: str,
    specimens: Sequence[str],
    quality: QualitySettings,
    length_needed: bool = True,
    parts: Parts | None = None,
    limits: Limits | None = None,
) -> tuple[Record, tuple[Source, ...]]:
    """Read the file or files of a test.

    Parameters
    ----------
    files : sequence of (path, layout, name)
        In order of time; ``name`` is relative to the campaign folder.
    test_id : str
        Key of the test.
    specimens : sequence of str
        Names; ``tension.1`` belongs to the first.
    quality : QualitySettings
        When a sample is flagged.
    length_needed : bool
        As in `reduction.ingest.convert.to_record`.
    parts : Parts, optional
        How much of a file is read at a time.
    limits : Limits, optional
        What each file may be.

    Returns
    -------
    record : Record
        In SI, flags set, every row kept.
    sources : tuple of Source
        One a file.

    Raises
    ------
    LogError
        If a file cannot be read as its layout says.
    SettingsError, DataError
        As in `reduction.ingest.convert.to_record`.
    """
    logs = [
        (read_log(path, layout, name=name, parts=parts, limits=limits), layout)
        for path, layout, name in files
    ]
    record = to_record(
        logs, test_id=test_id, specimens=specimens, quality=quality, length_needed=length_needed
    )
    give_back(record.time)
    return record, tuple(log.source for log, _ in logs)

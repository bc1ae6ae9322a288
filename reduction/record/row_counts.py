"""Accounts for the rows of a record by their flags."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from reduction.record.measurement import Quality, Record
from reduction.record.notes import Note, note
from reduction.record.samples import sample_blocks

_HARMLESS = {"missing", "gap", "repeated_or_backward_time", "not_constant_rate", "resampled"}
"""Flags for absent samples, or covered by a separate note: the kept samples are correct."""

_OUT_OF_ORDER = 0.02
"""Share of rows with backward time above which the clock may have been reset. [1]"""


@dataclass(frozen=True)
class _RowCounts:
    """Account of every row of a record."""

    n_read: int
    n_kept: int
    n_flagged: dict[str, dict[str, int]]


def count_rows(record: Record) -> _RowCounts:
    """Number of rows read, kept, and flagged by mask and channel."""
    channels = {"crosshead_position": record.crosshead_position_quality_flag}
    for name, flags in zip(record.specimens, record.quality_flag, strict=True):
        channels[f"tension of {name}"] = flags
    n_flagged = {}
    for channel, flags in channels.items():
        found: Counter[int] = Counter()
        for part in sample_blocks(flags.size, flags):
            flagged = flags[part][flags[part] != 0]
            values, counts = np.unique(flagged, return_counts=True)
            found.update(dict(zip(values.tolist(), counts.tolist(), strict=True)))
        of_mask = {
            mask.name.lower(): sum(count for value, count in found.items() if value & mask)
            for mask in Quality
            if mask.name is not None
        }
        n_flagged[channel] = {name: count for name, count in of_mask.items() if count}
    return _RowCounts(record.n_rows_read, record.n_samples, n_flagged)


ROWS_FLAGGED = ("rows-resampled", "rows-set-aside", "rows-flagged")
"""Codes of the notes on rows."""


def notes_on_rows(record: Record) -> list[Note]:
    """Count flagged rows by mask and channel; empty if no row is flagged."""
    account = count_rows(record)
    masks = set().union(*account.n_flagged.values())
    if not masks:
        return []
    listed = "; ".join(
        f"{channel} " + ", ".join(f"{mask} {count}" for mask, count in of_channel.items())
        for channel, of_channel in account.n_flagged.items()
        if of_channel
    )
    out_of_order = max(
        one.get("repeated_or_backward_time", 0) for one in account.n_flagged.values()
    )
    is_harmless = masks <= _HARMLESS and out_of_order <= _OUT_OF_ORDER * account.n_kept
    code = ROWS_FLAGGED[0 if masks <= {"resampled"} else 1 if is_harmless else 2]
    counts = {"n_read": account.n_read, "n_kept": account.n_kept}
    return [note(code, **counts, flags=listed, of_clock=masks <= _HARMLESS)]

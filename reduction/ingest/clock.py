"""Clock text, such as 0945 or 09:45:30, to elapsed seconds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from reduction.errors import LogError
from reduction.record import Floats, Integers

_CLOCK = re.compile(r"(\d{1,2}):?([0-5]\d)(?::([0-5]\d(?:[.,]\d+)?))?")
_DAY = 86400.0


def clock_to_seconds(
    path: Path,
    texts: Sequence[str],
    *,
    channel: str,
    missing: Sequence[str],
    row: Integers | None,
    first_row: int,
) -> Floats:
    """Seconds from the first reading, shape (n_rows,); missing marks are NaN. [s].

    A reading more than half a day before the one above it is on the next day; a
    smaller step back is kept as it is.

    Raises
    ------
    LogError
        If a text is no clock time, with its row.
    """
    seconds = np.full(len(texts), np.nan)
    for index, text in enumerate(texts):
        if text in missing:
            continue
        match = _CLOCK.fullmatch(text)
        if match is None or int(match[1]) > 23:
            raise LogError(
                path,
                "a reading is not a clock time",
                row=first_row + index if row is None else int(row[index]),
                channel=channel,
                found=f"'{text}'",
                needed="hours and minutes, such as 0945, 09:45 or 09:45:30",
            )
        hours, minutes = int(match[1]), int(match[2])
        seconds[index] = 3600 * hours + 60 * minutes + float((match[3] or "0").replace(",", "."))
    valid = np.flatnonzero(np.isfinite(seconds))
    if valid.size:
        read = seconds[valid]
        midnights = np.cumsum(np.diff(read, prepend=read[0]) < -_DAY / 2)
        seconds[valid] = read + _DAY * midnights - read[0]
    return seconds

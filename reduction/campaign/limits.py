"""``[limits]`` of campaign.toml: how large a log may be, and how long it may take to read."""

from __future__ import annotations

import re
from pathlib import Path

from pydantic import BaseModel, ConfigDict

from reduction.campaign.quantities import TableReader
from reduction.errors import SettingsError
from reduction.settings import Limits

# of pint's many plain numbers, a turn and a percent among them, those that count bytes
_BYTES = re.compile(r"[\d.+\-eE\s]*([kMGT]i?B|B|bytes?)\s*")
_SIZES: dict[str, tuple[float, float, str]] = {
    "file_size": (1e3, 1e14, '"1 kB" to "100 TB"'),
    "unpacked_size": (1e6, 1e12, '"1 MB" to "1 TB"'),
    "line_length": (1e3, 1e8, '"1 kB" to "100 MB"'),
}
_MOST_COLUMNS = 1_000_000
_TIMES = (1.0, 7 * 86400.0)


class LimitsSection(BaseModel):
    """``[limits]``: beyond them a log is refused; no number depends on them."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    file_size: str | None = None
    """Of one log: ``"100 GB"`` where left out."""
    unpacked_size: str | None = None
    """What a file that is read whole, or a piece of one, may take in memory: ``"4 GB"``."""
    line_length: str | None = None
    """Of a line of text: ``"1 MB"``."""
    columns: int | None = None
    """In a log: 10000."""
    time: str | None = None
    """To read one log: ``"1 h"``."""


def stated_limits(path: Path, section: LimitsSection) -> Limits:
    """Limits in bytes and seconds, with the defaults of what is not written.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml, for messages.
    section : LimitsSection
        As written.

    Returns
    -------
    limits : Limits
        Of every log of the campaign.

    Raises
    ------
    SettingsError
        If a value has another unit, or is none that anybody can mean.
    """
    reader = TableReader(path, "limits")
    found: dict[str, int | float] = {}
    for key, (least, most, shown) in _SIZES.items():
        text = getattr(section, key)
        if text is None:
            continue
        needed = f"{shown}, in bytes (B, kB, MB, GB, TB, KiB, MiB, GiB, TiB)"
        if _BYTES.fullmatch(text) is None:
            raise _refused(reader, key, "a size is not in bytes", text, needed)
        value = reader.value(key, text, "information")
        if not least <= value <= most:
            raise _refused(reader, key, "this is no limit", text, needed)
        found[key] = round(value)
    if section.columns is not None:
        if not 1 <= section.columns <= _MOST_COLUMNS:
            needed = f"a whole number from 1 to {_MOST_COLUMNS}"
            raise _refused(reader, "columns", "this is no limit", str(section.columns), needed)
        found["columns"] = section.columns
    if section.time is not None:
        seconds = reader.value("time", section.time, "time")
        if not _TIMES[0] <= seconds <= _TIMES[1]:
            needed = '"1 s" to "7 days"'
            raise _refused(reader, "time", "this is no limit", section.time, needed)
        found["time"] = seconds
    return Limits(**found)  # type: ignore[arg-type]


def _refused(reader: TableReader, key: str, problem: str, found: str, needed: str) -> SettingsError:
    fault = SettingsError("", found=repr(found), needed=needed)
    return reader.fault(f"{key}: {problem}", fault)

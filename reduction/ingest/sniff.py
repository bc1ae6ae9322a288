"""Look at an unknown log and propose a layout, for a person to confirm.

The proposal is text, never a `Layout`: what is not known is ``?`` in it, and a layout
with a ``?`` does not load.
"""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path

from reduction.errors import LogError
from reduction.ingest.bounded import bounded
from reduction.ingest.layout import Format
from reduction.ingest.limits import Watch
from reduction.ingest.sniff_binary import (
    SeenTable,
    look_at_binary,
    look_at_json,
    look_at_sheet,
    table_sheets,
)
from reduction.ingest.sniff_channels import UNKNOWN, propose_channels
from reduction.ingest.sniff_text import look_at_text
from reduction.ingest.source import check_not_empty, unchanged, unreadable
from reduction.settings import Limits
from reduction.visible import toml_text

_LIMITS = Limits(time=60.0)

_MAGIC: tuple[tuple[bytes, Format], ...] = (
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "spreadsheet"),
    (b"TDSm", "tdms"),
    (b"PAR1", "parquet"),
    (b"MATLAB", "matlab"),
    (b"\x89HDF\r\n\x1a\n", "hdf5"),
)


@dataclass(frozen=True)
class SniffedLayout:
    """A proposal.

    Parameters
    ----------
    toml : str
        ``[layouts.NAME]`` as for campaign.toml.
    remarks : tuple of str
        What stands behind it; each begins with ``sure:``, ``guess:`` or ``unknown:``.
    keys : tuple of str
        Channels that were found.
    """

    toml: str
    remarks: tuple[str, ...]
    keys: tuple[str, ...]

    @property
    def settings(self) -> str:
        """What the layout says, without comments: equal for logs that look alike."""
        return "\n".join(line.split("  # ")[0] for line in self.toml.split("\n") if line[:1] != "#")


def format_of(path: Path) -> Format:
    """Format of a file by its first bytes; text that is not JSON is ``delimited``."""
    try:
        with path.open("rb") as stream:
            head = stream.read(16)
    except OSError as error:
        raise unreadable(path, error) from error
    for magic, name in _MAGIC:
        if head.startswith(magic):
            return name
    if zipfile.is_zipfile(path):
        return "spreadsheet"
    return "json" if head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{") else "delimited"


def _look(path: Path, sheet: str | None, watch: Watch) -> SeenTable:
    kind = format_of(path)
    if kind == "spreadsheet":
        return bounded(look_at_sheet, path, sheet, watch=watch)
    if kind == "json":
        return look_at_json(path, watch)
    if kind != "delimited":
        return bounded(look_at_binary, path, kind, watch=watch)
    text = look_at_text(path)
    return SeenTable(text.format, text.columns, text.settings, text.remarks)


def sheets_with_tables(path: Path) -> list[str]:
    """Names of the sheets of a workbook that hold a table of numbers."""
    return [name for name, _ in bounded(table_sheets, path, watch=Watch(path, _LIMITS))]


def sniff_layout(path: Path, *, name: str = "log", sheet: str | None = None) -> SniffedLayout:
    """Propose a layout for a log.

    Parameters
    ----------
    path : pathlib.Path
        The log.
    name : str
        Key of the layout.
    sheet : str, optional
        Sheet of a workbook; the first that holds a table of numbers where not given.

    Returns
    -------
    sniffed : SniffedLayout
        To be confirmed by a person.

    Raises
    ------
    LogError
        If the file cannot be read or is beyond a limit, or no table of numbers is found.
    """
    watch = Watch(path, _LIMITS)
    with unchanged(path) as n_bytes:
        watch.check_size(n_bytes)
        check_not_empty(path, n_bytes)
        seen = _look(path, sheet, watch)
    if not seen.columns:
        raise LogError(path, "no columns of numbers are found", needed="a log")
    proposal = propose_channels(seen.columns)
    lines = [f"[layouts.{name}]", f'format = "{seen.format}"']
    lines += [f"{key} = {toml_text(value)}" for key, value in seen.settings.items()]
    remarks = [*seen.remarks, *proposal.remarks]
    if "time" not in proposal.keys:
        lines.append(f'sample_interval = "{UNKNOWN}"  # or a time channel below')
        remarks.append("unknown: the time between rows, because no column looks like time")
    lines += [f"[layouts.{name}.channels]", *proposal.lines, ""]
    return SniffedLayout("\n".join(lines), tuple(remarks), proposal.keys)

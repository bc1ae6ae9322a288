"""A draft of campaign.toml for a folder of logs.

Every ``?`` has to be replaced before the campaign loads.  Which specimen hung at which load
no log says, so that none is assumed: two logs may be of one specimen, or of two.
"""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path

from reduction.readers.layout import UNKNOWN
from reduction.readers.raw_log import unreadable
from reduction.readers.sniff import (
    SniffedLayout,
    format_of,
    sheets_with_tables,
    sniff_layout,
)
from reduction.record.errors import LogError
from reduction.record.plain_text import safe_cell, toml_comment, toml_text

_WRITTEN = ("campaign.toml", "tests.csv")

_MARKS = {"test", "specimen", "hold"}

_COLUMNS = ("id", "kind", "file", "layout", "order", "specimens")

_SPECIMENS = """\
# One such section for each specimen: copy it, and put the specimen's name, such as tether-A, in
# place of the ? in brackets. The same name stands in the column specimens of tests.csv in every
# test of this specimen, so that its history is known; of several, parted by ;, the first hung
# at tension.1.
[specimens."?"]
kind = "?"  # rubber tether, stretch hose, rope, wire or elastomer
diameter = ["?"]  # before stretch, each reading with its unit: ["1.04 in", "1.03 in"]
# material = ""  # what is known: EPDM, nylon, ...
# rated_break_strength = ""  # with its unit: "800 lbf"
"""

_NO_MARKS = """\
# How position becomes strain. Where there are splices: tape readings at their toes, in a table
# test,specimen,hold,near_toe_mm,far_toe_mm,far_thimble_mm
# strain = { marks = "marks.csv" }
# Where there are none, and no channel is a strain: gauge_length = "2.5 m" under each specimen."""


@dataclass(frozen=True)
class _Log:
    """A file, or a sheet of one, that may be a log."""

    file: str
    sheet: str | None
    sniffed: SniffedLayout

    @property
    def is_named(self) -> bool:
        """Whether a column of it is a position or a load."""
        return bool({"crosshead_position", "tension.1"} & set(self.sniffed.keys))

    @property
    def n_specimens(self) -> int:
        return max(1, sum(key.startswith("tension.") for key in self.sniffed.keys))


def _slug(text: str) -> str:
    """A name that may stand as an id: letters, digits, underscore and hyphen."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", text).strip("-_")[:80] or "log"


def _unique(name: str, taken: set[str]) -> str:
    number, made = 1, name
    while made in taken:
        number += 1
        made = f"{name}-{number}"
    taken.add(made)
    return made


def _is_marks(path: Path) -> bool:
    """Whether a file is a table of tape readings, by its header."""
    if path.suffix.lower() != ".csv":
        return False
    try:
        with path.open("rb") as stream:
            header = stream.readline(4096).decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise unreadable(path, error) from error
    names = {name.strip() for name in header.split(",")}
    return names >= _MARKS and any(name.startswith("near_toe") for name in names)


def _logs_of(path: Path) -> list[_Log]:
    sheets: list[str | None] = [None]
    if format_of(path) == "spreadsheet":
        sheets = [*sheets_with_tables(path)]
    return [_Log(path.name, sheet, sniff_layout(path, sheet=sheet)) for sheet in sheets]


def starter_campaign(folder: Path) -> dict[str, str]:
    """Text of ``campaign.toml`` and ``tests.csv`` for the logs of a folder."""
    logs: list[_Log] = []
    unnamed: list[_Log] = []
    marks: list[str] = []
    refused: list[str] = []
    for path in sorted(folder.iterdir(), key=lambda entry: _natural(entry.name)):
        if not path.is_file() or path.name.startswith(".") or path.name in _WRITTEN:
            continue
        if not path.resolve().is_relative_to(folder.resolve()):
            refused.append(f"{path.name}: a link that leads out of the folder")
            continue
        try:
            if _is_marks(path):
                marks.append(path.name)
                continue
            found = _logs_of(path)
        except LogError as error:
            refused.append(f"{path.name}: {error.problem}")
            continue
        named = [log for log in found if log.is_named]
        unnamed += [] if named else found
        logs += named
    if not logs:  # tables whose columns nobody knows, for a reader to name them
        logs, unnamed = unnamed, []
    names = dict.fromkeys(log.file for log in unnamed)
    refused += [f"{name}: no column looks like a position or a load" for name in names]
    if not logs:
        raise LogError(
            folder, "the folder holds no log", found="; ".join(refused) or "no files",
            needed="a file with a table of numbers, one column of it a position or a load",
        )  # fmt: skip
    return _texts(folder, logs, marks, refused)


def _natural(name: str) -> list[tuple[int, str]]:
    """Sort key under which T-10 comes after T-9."""
    parts = re.split(r"(\d+)", name.lower())
    return [(int(part), "") if part.isdigit() else (-1, part) for part in parts if part]


def _texts(folder: Path, logs: list[_Log], marks: list[str], refused: list[str]) -> dict[str, str]:
    layouts: dict[str, tuple[str, SniffedLayout]] = {}
    taken: set[str] = set()
    rows = []
    for log in logs:
        if log.sniffed.settings not in layouts:
            wish = _slug(f"{Path(log.file).suffix[1:]}-{log.sheet}") if log.sheet else "log"
            layouts[log.sniffed.settings] = _unique(wish, taken), log.sniffed
        name = f"{Path(log.file).stem}-{log.sheet}" if log.sheet else Path(log.file).stem
        rows.append((_slug(name), log))
    lines = [
        "# A first draft. Replace every ?, check every line, then: reduction check campaign.toml",
        "",
        "[campaign]",
        f'id = "{_slug(folder.resolve().name)}"',
        'title = "?"',
        'institution = "?"',
        'source = "?"',
        "# one row a log; order is its place in the history of its specimens: 1, 2, ...",
        'tests = "tests.csv"',
        "",
        _SPECIMENS,
        "[defaults]",
        'kind = "cyclic"  # bedding-in, fatigue, snap, relaxation, creep, quasi-static, tensile,',
        "# stepwise",
        'control = "position"  # or load',
    ]
    if not marks:
        lines.append(_NO_MARKS)
    if marks:
        lines.append(f"strain = {{ marks = {toml_text(marks[0])} }}")
        refused += [f"{name}: another table of marks" for name in marks[1:]]
    for name, sniffed in layouts.values():
        lines += ["", *(f"# {toml_comment(remark)}" for remark in sniffed.remarks)]
        lines.append(
            re.sub(r"(?m)^\[layouts\.log(?=[.\]])", f"[layouts.{name}", sniffed.toml).rstrip()
        )
    if refused:
        lines += ["", "# not taken for logs:", *(f"#   {toml_comment(entry)}" for entry in refused)]
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(_COLUMNS)
    ids: set[str] = set()
    for wish, log in rows:
        specimens = ";".join([UNKNOWN] * log.n_specimens)
        layout, _ = layouts[log.sniffed.settings]
        writer.writerow((_unique(wish, ids), "", safe_cell(log.file), layout, "", specimens))
    return {"campaign.toml": "\n".join(lines) + "\n", "tests.csv": table.getvalue()}

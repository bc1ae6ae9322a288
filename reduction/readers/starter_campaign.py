"""Drafts campaign.toml for a folder of logs.

Every ``?`` has to be replaced before the campaign loads.  No log states which specimen was on which
load cell, so none is assumed: two logs may be of one specimen, or of two.
"""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path

from reduction.readers.channel_names import is_unit
from reduction.readers.layout import UNKNOWN
from reduction.readers.raw_log import unreadable
from reduction.readers.sniff import (
    UNSCALED,
    SniffedLayout,
    format_of,
    sheets_with_tables,
    sniff_layout,
    unknown_layout,
)
from reduction.record.errors import LogError
from reduction.record.plain_text import natural_order, safe_cell, toml_comment, toml_text

_WRITTEN = ("campaign.toml", "tests.csv")

_PRODUCTS = ("processed", "reports")

_MARKS = {"test", "specimen", "hold"}

_COLUMNS = ("id", "kind", "file", "layout", "order", "specimens")

_SPECIMENS = """\
# One section per specimen: copy it, and replace the ? in the brackets by the specimen's name, such
# as tether-A. Use this name in the column specimens of tests.csv in every test of the specimen, so
# that its load history is known. Several specimens in one test: in the order of tension.1,
# tension.2, ..., separated by ;
"""

_SPECIMEN = """\
kind = "?"  # rubber tether, stretch hose, rope, wire, elastomer or other
diameter = ["?"]  # before stretch, each reading with its unit: ["1.04 in", "1.03 in"]
# or instead: area = "2.3 mm2"; width = "11.4 mm" and thickness = "0.2 mm"; or
# linear_density = "0.11 kg/m" and density = "1140 kg/m3". A rope or a hose needs none of these.
"""

_SPECIMEN_MORE = """\
# material = ""  # EPDM, nylon, ...
# rated_break_strength = ""  # with its unit: "800 lbf"
"""

_GAUGE = """\
gauge_length = "?"  # length that stretches: "2.5 m"; delete this line if you have marks.csv
"""

_KIND = """\
# guess: the kinds in tests.csv of short logs: tensile where the position moves one way, relaxation
# where it goes to one length and mostly stands there
"""

_NO_MARKS = """\
# How strain is computed. With splices: from tape readings at their toes, in a table with columns
# test,specimen,hold,near_toe_mm,far_toe_mm,far_thimble_mm
# strain = { marks = "marks.csv" }
# Without splices: from the gauge_length of each specimen."""

_SIZES = re.compile(
    r"width|thickness|height|diameter|area|section|length|\bL0\b|breite|dicke|durchmesser|länge|"
    r"höhe|querschnitt|largeur|hauteur|épaisseur|diamètre|longueur|ancho|espesor|diámetro|longitud|"
    r"宽度|厚度|直径|标距|幅|厚さ|長さ|断面積",
    re.IGNORECASE,
)
"""Preamble words that state a dimension of the specimen."""


@dataclass(frozen=True)
class _Log:
    """A file, or one of its sheets, that may be a log."""

    file: str
    sheet: str | None
    sniffed: SniffedLayout

    @property
    def is_named(self) -> bool:
        """Whether one of its columns is a position or a load."""
        return bool({"crosshead_position", "tension.1"} & set(self.sniffed.keys))

    @property
    def n_specimens(self) -> int:
        return max(1, sum(key.startswith("tension.") for key in self.sniffed.keys))


def _slug(text: str) -> str:
    """A name usable as an id: letters, digits, underscore and hyphen."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", text).strip("-_")[:80] or "log"


def _unique(name: str, taken: set[str]) -> str:
    number, made = 1, name
    while made in taken:
        number += 1
        made = f"{name}-{number}"
    taken.add(made)
    return made


def _is_marks(path: Path) -> bool:
    """Whether the header of a file is that of a table of tape readings."""
    if path.suffix.lower() != ".csv":
        return False
    try:
        with path.open("rb") as stream:
            header = stream.readline(4096).decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise unreadable(path, error) from error
    names = {name.strip() for name in header.split(",")}
    return names >= _MARKS and any(name.startswith("near_toe") for name in names)


def _logs_of(path: Path, refused: list[str]) -> list[_Log]:
    sheets: list[str | None] = [None]
    if format_of(path) == "spreadsheet":
        tables = sheets_with_tables(path)
        fewest = min(_FEWEST_READINGS, max(tables.values(), default=0))
        sheets = [name for name, n_rows in tables.items() if n_rows >= fewest]
        refused += [
            f"{path.name}, sheet '{name}': {n_rows} rows, as of a table of results"
            for name, n_rows in tables.items()
            if n_rows < fewest
        ]
        if not tables:
            refused.append(f"{path.name}: no sheet holds a table of numbers")
    return [_Log(path.name, sheet, sniff_layout(path, sheet=sheet)) for sheet in sheets]


_FEWEST_READINGS = 10  # of a sheet beside others: testXpert adds one of means and deviations


def starter_campaign(folder: Path) -> dict[str, str]:
    """Text of ``campaign.toml`` and ``tests.csv`` for the logs of a folder."""
    logs: list[_Log] = []
    unnamed: list[_Log] = []
    marks: list[str] = []
    refused: list[str] = []
    blind: list[Path] = []
    for path in sorted(folder.iterdir(), key=lambda entry: natural_order(entry.name)):
        if path.name.startswith(".") or path.name in _WRITTEN:
            continue
        if path.is_dir() and path.name not in _PRODUCTS:
            refused.append(f"{path.name}/: a folder; move its logs up, or draft it as a campaign")
        if not path.is_file():
            continue
        if not path.resolve().is_relative_to(folder.resolve()):
            refused.append(f"{path.name}: a link that leads out of the folder")
            continue
        try:
            if _is_marks(path):
                marks.append(path.name)
                continue
            found = _logs_of(path, refused)
        except LogError as error:
            refused.append(". ".join(filter(None, (f"{path.name}: {error.problem}", error.hint))))
            if path.suffix.lower() not in _NO_LOGS:
                blind.append(path)
            continue
        named = [log for log in found if log.is_named]
        unnamed += [] if named else found
        logs += named
    if not logs:  # tables without recognised columns, for the user to name them
        logs, unnamed = unnamed, []
    names = dict.fromkeys(log.file for log in unnamed)
    refused += [f"{name}: no column looks like a position or a load" for name in names]
    if not logs:  # nothing readable: a draft in which the user states what the files are
        logs = [_Log(path.name, None, unknown_layout()) for path in blind]
    if not logs:
        raise LogError(
            folder, "the folder holds no log", found="; ".join(refused) or "no files",
            needed="a file with a table of numbers, one column of it a position or a load",
        )  # fmt: skip
    return _texts(folder, logs, marks, refused)


_NO_LOGS = (".md", ".pdf", ".png", ".jpg", ".jpeg", ".docx", ".doc", ".toml", ".zip", ".py")


def _specimen_lines(names: list[str], logs: list[_Log], *, has_gauge: bool) -> list[str]:
    """Sections of the specimens, with the sizes stated in the preambles of the logs."""
    said = dict.fromkeys(
        line for log in logs for line in log.sniffed.preamble if _SIZES.search(line)
    )
    lines = []
    for name in names:
        key = name if name != UNKNOWN else toml_text(name)
        lines += [f"[specimens.{key}]", _SPECIMEN.rstrip()]
        lines += [f"# from the log: {toml_comment(line)}" for line in list(said)[:_MOST_SAID]]
        lines += [*([_GAUGE.rstrip()] if has_gauge else []), _SPECIMEN_MORE]
    return lines


_MOST_SAID = 12


def _one_layout(alike: list[_Log]) -> tuple[str, list[str]]:
    """Common layout of similar logs; a zero or datum that differs becomes a question."""
    toml, remarks = alike[0].sniffed.toml, list(alike[0].sniffed.remarks)
    if (said := _units_said(alike[0])) and f'unit = "{UNKNOWN}"' in toml:
        remarks.append(f"from the log: units {', '.join(said)}")
    above = alike[0].sniffed.preamble
    if any(UNSCALED.search(line) for line in above):
        unscaled = [line for line in above if UNSCALED.search(line) or _CHANNELS.match(line)]
        remarks.append("unknown: the factor of each channel, because the log says of its readings:")
        remarks += [f"from the log: {line}" for line in unscaled]
    texts = [log.sniffed.toml.split("\n") for log in alike]
    merged = []
    for number, line in enumerate(toml.split("\n")):
        others = {text[number] for text in texts if number < len(text)}
        if len(others) > 1 and not line.startswith("#"):
            line = re.sub(r'zero = "[^"]*"', f'zero = "{UNKNOWN}"', line)
            if 'datum = "' in line:
                line = re.sub(r", datum = .*?(?= })", f', datum = "{UNKNOWN}"', line)
            unlike = [
                log.file for log, text in zip(alike, texts, strict=True)
                if number < len(text) and text[number] != texts[0][number]
            ]  # fmt: skip
            more = f" and {len(unlike) - _MOST_NAMED} more" if len(unlike) > _MOST_NAMED else ""
            remarks.append(
                f"unknown: {line.split(' = ')[0]}: the logs differ in how they begin"
                f" ({', '.join(unlike[:_MOST_NAMED])}{more} unlike {alike[0].file}); a log with a"
                " zero or datum of its own needs a layout of its own"
            )
        merged.append(line)
    return "\n".join(merged), remarks


_MOST_NAMED = 5

_CHANNELS = re.compile(r"(channels?|units?|kan[aä]le?|einheit(en)?)\b", re.IGNORECASE)
"""Preamble lines that list the channels, and their units once they are scaled."""


def _units_said(log: _Log) -> tuple[str, ...]:
    """Units in brackets above the table."""
    said = re.findall(r"[\[(]\s*([^\s\[\]()\d]+)\s*[\])]", " ".join(log.sniffed.preamble))
    return tuple(
        dict.fromkeys(unit for unit in said if is_unit(unit) and not is_unit(unit, "frequency"))
    )


def _form(log: _Log) -> tuple[str, tuple[str, ...]]:
    """What logs of one layout have in common; of columns without a unit also what is above them."""
    settings = log.sniffed.settings
    return settings, _units_said(log) if f'unit = "{UNKNOWN}"' in settings else ()


def _texts(folder: Path, logs: list[_Log], marks: list[str], refused: list[str]) -> dict[str, str]:
    layouts: dict[tuple[str, tuple[str, ...]], tuple[str, list[_Log]]] = {}
    taken: set[str] = set()
    rows = []
    for log in logs:
        if _form(log) not in layouts:
            wish = _slug(f"{Path(log.file).suffix[1:]}-{log.sheet}") if log.sheet else "log"
            layouts[_form(log)] = _unique(wish, taken), []
        layouts[_form(log)][1].append(log)
        name = f"{Path(log.file).stem}-{log.sheet}" if log.sheet else Path(log.file).stem
        rows.append((_slug(name), log))
    # with one log, its specimens cannot have been in another one
    alone = [f"specimen-{i + 1}" for i in range(logs[0].n_specimens)] if len(logs) == 1 else []
    has_strain = bool(logs) and all("strain.1" in log.sniffed.keys for log in logs)
    lines = [
        "# A first draft. Replace every ?, check every line, then: reduction check campaign.toml",
        "",
        "[campaign]",
        f'id = "{_slug(folder.resolve().name)}"',
        f"title = {toml_text(folder.resolve().name)}",
        '# institution = ""',
        '# source = ""  # where the logs are from',
        "# one row per log; order is its place in the history of its specimens: 1, 2, ...",
        'tests = "tests.csv"',
        "",
        *([] if alone else [_SPECIMENS.rstrip()]),
        *_specimen_lines(alone or [UNKNOWN], logs, has_gauge=not marks and not has_strain),
        "[defaults]",
        'kind = "cyclic"  # bedding-in, fatigue, snap, relaxation, creep, quasi-static, tensile,',
        "# stepwise",
        *([_KIND.rstrip()] if any(log.sniffed.kind for log in logs) else []),
        'control = "position"  # or load',
        '# waveform = "sinusoidal"  # or other; triangular if not stated. check compares it with',
        "# the logs",
    ]
    if not marks:
        lines.append(_NO_MARKS)
    if marks:
        lines.append(f"strain = {{ marks = {toml_text(marks[0])} }}")
        refused += [f"{name}: another table of marks" for name in marks[1:]]
    for name, alike in layouts.values():
        toml, remarks = _one_layout(alike)
        lines += ["", *(f"# {toml_comment(remark)}" for remark in remarks)]
        lines.append(re.sub(r"(?m)^\[layouts\.log(?=[.\]])", f"[layouts.{name}", toml).rstrip())
    if refused:
        lines += ["", "# not taken for logs:", *(f"#   {toml_comment(entry)}" for entry in refused)]
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(_COLUMNS)
    ids: set[str] = set()
    for wish, log in rows:
        specimens = ";".join(alone or [UNKNOWN] * log.n_specimens)
        layout, _ = layouts[_form(log)]
        row = (_unique(wish, ids), log.sniffed.kind, safe_cell(log.file), layout, "", specimens)
        writer.writerow(row)
    return {"campaign.toml": "\n".join(lines) + "\n", "tests.csv": table.getvalue()}

"""Outcomes without a log: results.csv, one row per outcome."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TypeVar, get_args

from reduction.campaign.toml_file import read_csv_rows
from reduction.experiments.outcome_groups import complete_from_specimens
from reduction.experiments.outcomes import IN_THE_TERMINATION, Outcome, OutcomeQuantity, Place
from reduction.quantities.units import Dimension, scale_to_si
from reduction.readers.raw_log import hash_source, unchanged
from reduction.record.errors import LogError, SettingsError
from reduction.record.measurement import Source, Specimen

_TEXTS = ("test", "specimen", "line", "material", "construction", "condition", "mode", "note")

_SUSPENDED = ("run_out", "suspended")

_WORDS = (*_TEXTS, "id", "quantity", "unit", "place", "valid", *_SUSPENDED)

_MEASURED: dict[str, Dimension] = {
    "diameter": "length", "exposure": "time", "minimum_load": "force", "peak_load": "force",
}  # fmt: skip

_DIMENSION: dict[OutcomeQuantity, Dimension] = {
    "tensile_strength": "force", "strain_at_failure": "strain",
    "cycles_to_failure": "number", "abrasion_cycles": "number",
}  # fmt: skip

_YEAR = 365.25 * 86400.0

_YES = {"yes": True, "y": True, "true": True, "1": True,
        "no": False, "n": False, "false": False, "0": False}  # fmt: skip

_OF_BREAK_STRENGTH = re.compile(r"%\s*(RBS|MBS|MBL)", re.IGNORECASE)

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")

_QUANTITY: dict[str, OutcomeQuantity] = {name: name for name in _DIMENSION}

_PLACE: dict[str, Place] = {name: name for name in get_args(Place)} | {"": "not_stated"}

_T = TypeVar("_T")


@dataclass(frozen=True)
class _Column:
    """A column with a unit, and its header unchanged."""

    unit: str | None
    header: str


@dataclass(frozen=True)
class _ResultRow:
    """One row of the file, read cell by cell."""

    path: Path
    row: int
    cells: dict[str, str]

    def fault(
        self, problem: str, channel: str, *, needed: str, hint: str | None = None
    ) -> LogError:
        """The error for an unusable cell."""
        return LogError(
            self.path, problem, row=self.row, channel=channel,
            found=repr(self.cells.get(channel, "")), needed=needed, hint=hint,
        )  # fmt: skip

    def choice(self, name: str, choices: Mapping[str, _T], problem: str) -> _T:
        """Meaning of a word; blanks, hyphens and capitals are ignored."""
        word = _word(self.cells.get(name, ""))
        if word not in choices:
            raise self.fault(problem, name, needed=", ".join(filter(None, choices)))
        return choices[word]

    def is_yes(self, name: str, default: bool) -> bool:
        """Yes or no; the default for an empty cell."""
        word = self.cells.get(name, "").strip().lower()
        if not word:
            return default
        if word not in _YES:
            raise self.fault(
                f"{name} is neither yes nor no", name, needed="yes, no or an empty cell"
            )
        return _YES[word]

    def number(self, header: str) -> float:
        """A number, unconverted; NaN for an empty cell."""
        cell = self.cells[header].strip()
        if not cell:
            return math.nan
        if not _NUMBER.fullmatch(cell):
            raise self.fault("a value is not a number", header, needed="a number, without its unit")
        value = float(cell)
        if not math.isfinite(value):
            raise self.fault("a value is not finite", header, needed="a finite number")
        return value

    def in_si(self, header: str, unit: str, dimension: Dimension) -> float:
        """A number with the unit declared in its column or row."""
        try:
            factor, offset = scale_to_si(unit, dimension)
        except SettingsError as error:
            raise LogError(
                self.path, error.problem, row=self.row, channel=header, found=error.found,
                needed=error.needed,
            ) from error  # fmt: skip
        return factor * self.number(header) + offset


def _word(text: str) -> str:
    return re.sub(r"[\s-]+", "_", text.strip().lower())


def _columns(path: Path, header: list[str]) -> tuple[dict[str, list[_Column]], list[str]]:
    """Columns with a unit by quantity, and the columns kept as notes."""
    measured: dict[str, list[_Column]] = {}
    others = []
    for name in header:
        stem, _, bracket = name.partition("[")
        known = next(
            (
                s
                for s in (*_MEASURED, "value")
                if _word(stem) == s or _word(name).startswith(s + "_")
            ),
            None,
        )
        if known is not None:
            unit = bracket.rstrip("] ") if bracket else name[len(known) :].lstrip("_ ")
            # a header may avoid the percent sign
            unit = re.sub(r"^pct[_ ]?", "%", unit)
            measured.setdefault(known, []).append(_Column(unit or None, name))
        elif name in _WORDS:
            continue
        elif near := get_close_matches(_word(name), (*_WORDS, *_MEASURED, "value"), cutoff=0.75):
            raise LogError(
                path, "unknown column name", row=1, channel=name, needed=f"{near[0]}?",
                hint="Rename a column of your own if its name resembles a known one.",
            )  # fmt: skip
        else:
            others.append(name)
    for stem, columns in measured.items():
        if stem != "value" and len(columns) > 1:
            raise LogError(path, f"two columns contain {stem}", row=1, channel=columns[1].header)
        for column in columns:
            if stem != "value" and column.unit is None:
                raise LogError(
                    path, f"{stem} has no unit", row=1, channel=column.header,
                    needed=f"a header such as {stem}_{'years' if stem == 'exposure' else 'lbf'}"
                    if stem != "diameter" else "a header such as diameter_in",
                )  # fmt: skip
    return measured, others


def _header(path: Path, header: list[str]) -> None:
    stems = {_word(name.partition("[")[0]) for name in header}
    has_value = any(stem == "value" or stem.startswith("value_") for stem in stems)
    repeated = {name for name in header if header.count(name) > 1}
    if "quantity" not in header or not has_value or repeated or {"id", "test"} <= set(header):
        raise LogError(
            path, "the table of results has no usable header", row=1, found=", ".join(header),
            needed="quantity, value with a unit (value_lbf, or value and unit), and what names the "
            "group or the specimen, each once; id is another name of test",
        )  # fmt: skip


def _value(
    row: _ResultRow, columns: list[_Column], quantity: OutcomeQuantity, valid: bool
) -> float:
    """The single value of a row, in SI."""
    filled = [column for column in columns if row.cells[column.header].strip()]
    if not filled and not valid:
        return math.nan
    if len(filled) != 1:
        raise row.fault(
            "a row has no value" if not filled else "a row has two values",
            (filled or columns)[-1].header, needed="one value",
            hint=None if filled else "For a test that gave no value, set valid = no.",
        )  # fmt: skip
    (column,) = filled
    unit = row.cells.get("unit", "").strip() if column.unit is None else column.unit
    dimension = _DIMENSION[quantity]
    if dimension == "number":
        unit = "" if unit in ("cycles", "cycle") else unit
    elif not unit:
        raise row.fault("a value has no unit", column.header, needed=f"a unit of {dimension}")
    if _OF_BREAK_STRENGTH.fullmatch(unit):
        raise row.fault(
            "a strength is given as a share of another", column.header, needed="a unit of force"
        )
    value = row.in_si(column.header, unit, dimension)
    if not value > 0:
        raise row.fault("a value is not above zero", column.header, needed="a number above zero")
    return value


def _load(row: _ResultRow, columns: list[_Column]) -> tuple[float, float]:
    """A load [N] and its share of the rated break strength [1], from either of them."""
    if not columns:
        return math.nan, math.nan
    (column,) = columns
    unit = column.unit or ""
    load = row.number(column.header)
    if load < 0:
        raise row.fault("a load is below zero", column.header, needed="0 or more")
    if _OF_BREAK_STRENGTH.fullmatch(unit):
        return math.nan, load / 100
    return row.in_si(column.header, unit, "force"), math.nan


def _outcome(row: _ResultRow, measured: dict[str, list[_Column]], others: list[str]) -> Outcome:
    quantity = row.choice("quantity", _QUANTITY, "a quantity has no known name")
    place = row.choice("place", _PLACE, "a place has no known name")
    is_valid = row.is_yes("valid", place not in IN_THE_TERMINATION)
    minimum = _load(row, measured.get("minimum_load", []))
    peak = _load(row, measured.get("peak_load", []))
    if minimum[0] >= peak[0] or minimum[1] >= peak[1]:
        raise row.fault(
            "the minimum load is not below the peak load", measured["minimum_load"][0].header,
            needed="less than the peak load",
        )  # fmt: skip
    remarks = [f"{name}: {row.cells[name].strip()}" for name in others if row.cells[name].strip()]

    def text(name: str) -> str:
        return row.cells.get(name, "").strip()

    sizes = {}
    for name in ("diameter", "exposure"):
        for column in measured.get(name, []):
            size = row.in_si(column.header, column.unit or "", _MEASURED[name])
            if size < 0 or (name == "diameter" and size == 0):
                raise row.fault(f"{name} cannot be", column.header, needed="a number above zero")
            sizes[name] = size / _YEAR if name == "exposure" else size
    return Outcome(
        quantity=quantity,
        value=_value(row, measured["value"], quantity, is_valid),
        test=text("test") or text("id"),
        specimen=text("specimen"),
        line=text("line"),
        material=text("material"),
        construction=text("construction"),
        condition=text("condition"),
        diameter=sizes.get("diameter", math.nan),
        exposure=sizes.get("exposure", math.nan),
        minimum_load=minimum[0],
        minimum_load_ratio=minimum[1],
        peak_load=peak[0],
        peak_load_ratio=peak[1],
        mode=text("mode"),
        place=place,
        is_valid=is_valid,
        is_suspended=any(row.is_yes(name, default=False) for name in _SUSPENDED),
        note="; ".join(filter(None, [text("note"), *remarks])),
        row=row.row,
    )


def _read_results(path: Path) -> tuple[Outcome, ...]:
    """Read a table of results."""
    header, rows = read_csv_rows(path, "the table of results")
    _header(path, header)
    measured, others = _columns(path, header)
    outcomes: list[Outcome] = []
    seen: dict[tuple[str, str, str], int] = {}
    for number, cells in rows:
        outcome = _outcome(
            _ResultRow(path, number, dict(zip(header, cells, strict=True))), measured, others
        )
        key = (outcome.test, outcome.specimen, outcome.quantity)
        if outcome.test and seen.setdefault(key, number) != number:
            raise LogError(
                path, f"{outcome.quantity} of a test is listed twice", row=number,
                found=f"{outcome.test!r}, also in row {seen[key]}",
                needed="one value of each quantity per test and specimen",
            )  # fmt: skip
        outcomes.append(outcome)
    if not outcomes:
        raise LogError(path, "the table of results has no rows", needed="one row per outcome")
    return tuple(outcomes)


def outcomes_of(
    path: Path, name: str, specimens: Mapping[str, Specimen]
) -> tuple[Source | None, tuple[Outcome, ...]]:
    """Read the table of results of a campaign."""
    if not name:
        return None, ()
    table = path.parent / name
    with unchanged(table):
        source = hash_source(table, name)
        rows = _read_results(table)
    for row in rows:
        if row.specimen and row.specimen not in specimens:
            raise LogError(
                table, "an outcome names an unknown specimen", row=row.row, channel="specimen",
                found=repr(row.specimen),
                needed="one of " + ", ".join(specimens) if specimens else "[specimens.NAME]",
                hint="Put the name of a break or test without a sheet into id.",
            )  # fmt: skip
    return source, complete_from_specimens(rows, specimens)

"""Curves and look-up tables as CSV, JSON, LaTeX and Markdown."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from reduction import __version__
from reduction.errors import SettingsError
from reduction.export.guards import range_of
from reduction.export.header import number
from reduction.export.product import ExportLine
from reduction.export.spread import CurveSpread
from reduction.export.thin import curve_from_zero
from reduction.record import Bools, Floats
from reduction.uncertainty.product import Component
from reduction.units import UnitSystem, display_unit
from reduction.visible import safe_cell

CONTRIBUTION = "tension_uncertainty_contribution"
SIGNED = "what one standard uncertainty of each shared error adds to the tension"
"""What stands where a format has a place for contributions."""


@dataclass(frozen=True)
class TableColumn:
    """A column: name, SI unit (empty where it has none), meaning, and values or words (n_rows,)."""

    name: str
    unit: str
    meaning: str
    values: Floats | Bools | NDArray[np.str_]


@dataclass(frozen=True)
class ValueTable:
    """A table, with a sentence on what it is and where its numbers are from.

    ``contribution`` is what each of the errors ``component`` adds to the tension of each row,
    signed, shape (n_components, n_rows), in N; json and netcdf have a place for it.
    """

    title: str
    columns: tuple[TableColumn, ...]
    sources: tuple[str, ...]
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        """Check that the columns are of one length."""
        sizes = {column.values.shape for column in self.columns}
        if len(sizes) != 1 or len(next(iter(sizes))) != 1:
            raise SettingsError("the columns of a table differ in length", found=str(sorted(sizes)))


def curve_table(line: ExportLine) -> ValueTable:
    """The curve of a line from zero, every point of it, and which points were tested."""
    at, load, words = curve_from_zero(line.strain, line.tension)
    low, high = line.tested
    tested = (at >= low * (1 - 1e-9)) & (at <= high * (1 + 1e-9)) & (at > 0)
    spread = None if line.spread is None else line.spread.at(at, line.strain)
    return ValueTable(
        title=f"{line.name}: {line.curve}",
        columns=(
            TableColumn("strain", "1", "nominal strain", at),
            TableColumn("tension", "N", "tension", load),
            *(() if spread is None else spread_columns(spread)),
            TableColumn("is_tested", "", "inside the strains that were tested", tested),
        ),
        sources=line.sources,
        notes=(*line.notes, range_of(line), *((f"at the start: {words}",) if words else ())),
        is_synthetic=line.is_synthetic,
        component=() if spread is None else spread.component,
        contribution=np.empty((0, at.size)) if spread is None else spread.contribution,
    )


def spread_columns(
    spread: CurveSpread, random: str = "of the curve by itself", both: str = "of both parts"
) -> tuple[TableColumn, ...]:
    """Standard uncertainty of the tensions of a curve, and its parts where they are known."""
    name = "standard_uncertainty"
    if spread.random is None:
        return (TableColumn(f"tension_{name}", "N", "of the tension (k = 1)", spread.standard),)
    return (
        TableColumn(f"tension_{name}", "N", f"{both} that follow (k = 1)", spread.standard),
        TableColumn(f"tension_random_{name}", "N", random, spread.random),
        TableColumn(
            f"tension_shared_{name}", "N", "of what the tests share with each other and with other "
            "tests, as a load cell", spread.shared,
        ),
    )  # fmt: skip


def _shown(table: ValueTable, units: UnitSystem) -> tuple[list[str], list[list[str]]]:
    """Headers with units, and rows as text."""
    heads, columns = [], []
    for column in table.columns:
        unit, factor = display_unit(column.unit, units) if column.unit else ("", 1.0)
        heads.append(f"{column.name} [{unit}]" if unit else column.name)
        columns.append([_cell(value, factor) for value in column.values.tolist()])
    return heads, [list(row) for row in zip(*columns, strict=True)]


def _cell(value: float | bool | str, factor: float) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number(factor * value) if math.isfinite(value) else ""


def _plain(value: float | bool | str, factor: float) -> float | bool | str | None:
    if isinstance(value, str):
        return value or None
    if isinstance(value, bool):
        return value
    return factor * value if math.isfinite(value) else None


def _said(table: ValueTable) -> list[str]:
    made = ["Synthetic: nothing was tested"] if table.is_synthetic else []
    return [
        *made,
        *(f"Source: {text}" for text in table.sources),
        *(f"Note: {text}" for text in table.notes),
        f"Made by reduction {__version__}",
    ]


def table_text_of(table: ValueTable, form: str, *, units: UnitSystem = "si") -> str:
    """A table as text.

    Parameters
    ----------
    table : ValueTable
        What is written.
    form : {"csv", "json", "latex", "markdown"}
        CSV has title, sources and notes in two columns, since it has no place for a remark: in the
        first row, and empty below, where a reader of tables has nothing.
    units : {"si", "us"}
        What is shown.

    Returns
    -------
    text : str
        All of it.

    Raises
    ------
    SettingsError
        If the form is not known.
    """
    writers = {"csv": _csv, "json": _json, "latex": _latex, "markdown": _markdown}
    if form not in writers:
        raise SettingsError(
            "the form of a table is not known", found=repr(form), needed=", ".join(writers)
        )
    return writers[form](table, units)


def _csv(table: ValueTable, units: UnitSystem) -> str:
    heads, rows = _shown(table, units)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(map(safe_cell, [*heads, "what", "source"]))
    said = [table.title, "; ".join(_said(table))]
    for row in rows:
        writer.writerow(map(safe_cell, [*row, *said]))
        said = ["", ""]
    return text.getvalue()


def _json(table: ValueTable, units: UnitSystem) -> str:
    document = {"title": table.title, "synthetic": table.is_synthetic} | {
        "sources": list(table.sources),
        "notes": list(table.notes),
        "software": f"reduction {__version__}",
        "units": {},
        "meaning": {column.name: column.meaning for column in table.columns},
        "values": {},
    }
    shown: dict[str, str] = {}
    values: dict[str, list[float | bool | str | None]] = {}
    for column in table.columns:
        unit, factor = display_unit(column.unit, units) if column.unit else ("", 1.0)
        shown[column.name] = unit
        values[column.name] = [_plain(value, factor) for value in column.values.tolist()]
    document |= {"units": shown, "values": values} | _contributions(table, units)
    return json.dumps(document, indent=1) + "\n"


def _contributions(table: ValueTable, units: UnitSystem) -> dict[str, object]:
    """Signed contributions of the shared errors to the tension; nothing where there are none."""
    if not table.component:
        return {}
    unit, factor = display_unit("N", units)
    rows = [
        {"source": one.source, "of": one.of, "number": one.number}
        | {"contribution": [_plain(value, factor) for value in row]}
        for one, row in zip(table.component, table.contribution.tolist(), strict=True)
    ]
    return {f"{CONTRIBUTION}s": {"unit": unit, "meaning": SIGNED, "sources": rows}}


def _latex(table: ValueTable, units: UnitSystem) -> str:
    heads, rows = _shown(table, units)
    body = [" & ".join(_escaped(cell) for cell in row) + r" \\" for row in rows]
    return "\n".join(
        [
            *(f"% {' '.join(text.split())}" for text in _said(table)),
            rf"\begin{{longtable}}{{{'r' * len(heads)}}}",
            rf"\caption{{{_escaped(table.title)}. {_escaped('; '.join(_said(table)))}}} \\",
            r"\hline",
            " & ".join(_escaped(head) for head in heads) + r" \\",
            r"\hline",
            r"\endhead",
            *body,
            r"\hline",
            r"\end{longtable}",
            "",
        ]
    )


def _escaped(text: str) -> str:
    named = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%$#_{}]", lambda sign: named.get(sign[0], "\\" + sign[0]), text)


def _markdown(table: ValueTable, units: UnitSystem) -> str:
    heads, rows = _shown(table, units)
    cells = [heads, ["---:"] * len(heads), *rows]
    return "\n".join(
        [
            f"**{table.title}**",
            "",
            *(f"- {' '.join(text.split())}" for text in _said(table)),
            "",
            *("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in cells),
            "",
        ]
    )

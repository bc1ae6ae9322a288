"""Curves and look-up tables as CSV, JSON, LaTeX, Markdown and netCDF.

Design values are one table for every format: levels, value, intervals, loads.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from html import escape
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from reduction import __version__
from reduction.archive.atomic_write import atomic_file
from reduction.archive.workbook import Cell, Sheet
from reduction.lines.deck_text import number
from reduction.lines.export_line import CurveSpread, ExportLine, curve_from_zero, range_of
from reduction.lines.line_search import LineDifference
from reduction.lines.lookup_product import TENSIONS, DesignValues, LineSource
from reduction.lines.population import PopulationValues
from reduction.quantities.names import quantity
from reduction.quantities.row import COMPONENT
from reduction.quantities.units import UnitSystem, display_unit
from reduction.record.contributions import Component
from reduction.record.errors import ArchiveError, SettingsError
from reduction.record.measurement import Bools, Floats
from reduction.record.plain_text import safe_cell

_Cell = TypeVar("_Cell")

CONTRIBUTION = "tension_uncertainty_contribution"

SIGNED = "change of tension per standard uncertainty of each shared error"
"""Text where a format can hold contributions."""


@dataclass(frozen=True)
class TableColumn:
    """A column: name, SI unit (empty where it has none), meaning, and values or words (n_rows,)."""

    name: str
    unit: str
    meaning: str
    values: Floats | Bools | NDArray[np.str_]


@dataclass(frozen=True)
class ValueTable:
    """A table, with a sentence on its contents and the sources of its numbers.

    ``contribution`` holds the signed contribution of each error ``component`` to the tension of
    each row, shape (n_components, n_rows), in N; only json and netcdf store it.
    """

    title: str
    columns: tuple[TableColumn, ...]
    sources: tuple[str, ...]
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        """Check that all columns have the same length."""
        sizes = {column.values.shape for column in self.columns}
        if len(sizes) != 1 or len(next(iter(sizes))) != 1:
            raise SettingsError("the columns of a table differ in length", found=str(sorted(sizes)))


def curve_table(line: ExportLine) -> ValueTable:
    """The curve of a line from zero, with every point, and which points were tested."""
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
            TableColumn("is_tested", "", "within the tested strains", tested),
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


def _shown(
    table: ValueTable, units: UnitSystem, cell: Callable[[Any, float], _Cell]
) -> tuple[list[str], list[list[_Cell]]]:
    """Headers with units, and rows of cells made of values and the factor of their unit."""
    heads, columns = [], []
    for column in table.columns:
        unit, factor = display_unit(column.unit, units) if column.unit else ("", 1.0)
        heads.append(f"{column.name} [{unit}]" if unit else column.name)
        columns.append([cell(value, factor) for value in column.values.tolist()])
    return heads, [list(row) for row in zip(*columns, strict=True)]


def _text(value: float | bool | str, factor: float) -> str:
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
    """A table as text."""
    writers = {"csv": _csv, "json": _json, "latex": _latex, "markdown": _markdown}
    return writers[form](table, units)


def _csv(table: ValueTable, units: UnitSystem) -> str:
    heads, rows = _shown(table, units, _text)
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
    """Signed contributions of the shared errors to the tension; empty where there are none."""
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
    heads, rows = _shown(table, units, _text)
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
    heads, rows = _shown(table, units, _text)
    cells = [heads, ["---:"] * len(heads), *rows]
    return "\n".join(
        [
            f"**{_as_markdown(table.title)}**",
            "",
            *(f"- {_as_markdown(text)}" for text in _said(table)),
            "",
            *("| " + " | ".join(map(_as_markdown, row)) + " |" for row in cells),
            "",
        ]
    )


def _as_markdown(text: str) -> str:
    r"""Text in one line that no reader of Markdown parses as HTML, a link or a cell.

    Examples
    --------
    >>> print(_as_markdown("<img src=x> a|b [go](javascript:1)"))
    &lt;img src=x&gt; a\|b [go\](javascript:1)
    """
    plain = escape(" ".join(text.split()), quote=False)
    return re.sub(r"[\\`|]|\](?=\()", lambda sign: "\\" + sign[0], plain)


def sheets_of_table(table: ValueTable, *, units: UnitSystem = "si") -> list[Sheet]:
    """A table as the sheets of a workbook: its values, and a description."""
    heads, rows = _shown(table, units, _plain)
    about: list[tuple[Cell, ...]] = [("title", table.title)]
    about += [("", text) for text in _said(table)]
    about += [(head, column.meaning) for head, column in zip(heads, table.columns, strict=True)]
    return [
        Sheet("values", heads, rows),
        Sheet("about", ("what", "meaning"), about),
    ]


_OF_SUFFIX = {
    ".csv": "csv",
    ".json": "json",
    ".tex": "latex",
    ".md": "markdown",
    ".nc": "netcdf",
    ".xlsx": "xlsx",
}

_PERCENT = "percent_of_break_strength"

_NO_INTERVAL = "nothing: no scatter is known"


def format_of_file(path: Path) -> str:
    """Format of a table by the suffix of its file."""
    form = _OF_SUFFIX.get(path.suffix.lower())
    if form is None:
        raise SettingsError(
            "the file extension names no format", found=path.name,
            needed=", ".join(_OF_SUFFIX),
        )  # fmt: skip
    return form


def table_of_values(
    line: LineSource, found: DesignValues, levels: Mapping[str, ArrayLike]
) -> ValueTable:
    """Design values of one line as a table, one row per point."""
    unit = found.unit
    columns = [
        *_levels(line, found, levels),
        _column(found.quantity, unit, _meaning(found.quantity), found.value),
        *_interval("interval", unit, found.interval_of or _NO_INTERVAL, found.low, found.high),
        *_interval("surface_interval", unit, found.surface_interval_of or _NO_INTERVAL,
                   found.surface_low, found.surface_high),
        *_between_lines(found),
        _column("is_below_zero", "", "below zero, which it cannot be", found.is_below_zero),
        _column("is_inside", "", "within the tested range", found.is_inside),
        _column("is_untested", "", "farther from the runs than any run", found.is_untested),
        _column("peak_tension", "N", "peak tension of the cycle", found.peak_tension),
        _column("minimum_tension", "N", "minimum tension of the cycle", found.minimum_tension),
        _column(f"peak_{_PERCENT}", "%", "the greatest tension so", 100 * found.peak_share),
        _column(f"minimum_{_PERCENT}", "%", "the least tension so", 100 * found.minimum_share),
        _column(f"peak_{_PERCENT}_in_its_condition", "%",
                "the greatest tension, of the strength that the line still has",
                100 * found.own_peak_share),
        _column("is_slack", "", "the least tension is zero", found.is_slack),
        _column("is_above_rule", "", "peak above the rule of the source", found.is_above_rule),
    ]  # fmt: skip
    return ValueTable(
        title=f"{found.quantity} of {line.name}{_branch(found)}",
        columns=tuple(columns),
        sources=(_source(line, found),),
        notes=(*found.warnings, *_about(line), f"rule: {found.rule}", *found.notes),
        is_synthetic=_is_synthetic(line),
    )


def table_of_population(
    kind: LineSource, found: PopulationValues, levels: Mapping[str, ArrayLike]
) -> ValueTable:
    """Specimens of one kind together, with tolerance limits, one row per point."""
    table = table_of_values(kind, found.values, levels)
    unit, of = found.values.unit, f"{100 * found.share:g} % of the population"
    limit = f"with {100 * found.confidence:g} % confidence {of} are"
    added = [
        _column("standard_deviation", unit, "between the specimens", found.standard_deviation),
        _column("lower_limit", unit, f"{limit} above", found.lower),
        _column("upper_limit", unit, f"{limit} below", found.upper),
        _column("two_sided_limit_low", unit, f"{limit} between this and the other", found.both_low),
        _column("two_sided_limit_high", unit, f"{limit} between this and the other",
                found.both_high),
        *(
            _column(f"specimen_{place + 1}", unit, f"of {name}", found.of_specimens[place])
            for place, name in enumerate(found.specimens)
        ),
    ]  # fmt: skip
    return replace(table, columns=(*table.columns, *added))


def table_of_difference(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    levels: Mapping[str, ArrayLike],
    other_levels: Mapping[str, ArrayLike],
) -> ValueTable:
    """Two lines at the same points as a table, one row per point."""
    unit, name = found.unit, found.quantity
    a, b = found.first, found.second
    columns = [
        *_levels(first, a, levels),
        *_levels(second, b, other_levels, "other_"),
        _column(name, unit, f"{_meaning(name)}, {first.name}", a.value),
        _column(f"other_{name}", unit, f"{_meaning(name)}, {second.name}", b.value),
        _column("difference", unit, "second minus first", found.difference),
        _column("ratio", "1", "second over first", found.ratio),
        _column("surface_interval_low", unit, "lower 95 % limit of the difference of the surfaces",
                found.surface_low),
        _column("surface_interval_high", unit, "upper 95 % limit of the difference of the surfaces",
                found.surface_high),
        _column("interval_low", unit, "the same of one more run of the same specimens",
                found.low),
        _column("interval_high", unit, "the same of one more run of the same specimens",
                found.high),
        _column("kind_interval_low", unit, "the same of all specimens of the kinds",
                found.kind_low),
        _column("kind_interval_high", unit, "the same of all specimens of the kinds",
                found.kind_high),
        _column("line_interval_low", unit, "the same of another specimen of each", found.line_low),
        _column("line_interval_high", unit, "the same of another specimen of each",
                found.line_high),
        _column("is_known", "", "both surfaces have an interval", found.is_known),
        _column("is_different", "", "the surfaces of these specimens differ", found.is_different),
        _column("is_test_known", "", "both have an interval of one more run",
                found.is_test_known),
        _column("is_test_different", "", "one more run of the same specimens would differ",
                found.is_test_different),
        _column("is_kind_known", "", "of both kinds the scatter between specimens is known",
                found.is_kind_known),
        _column("is_kind_different", "", "the means of the two kinds of line differ",
                found.is_kind_different),
        _column("is_line_known", "", "both have an interval of another specimen",
                found.is_line_known),
        _column("is_line_different", "", "another specimen of each would differ",
                found.is_line_different),
        _column("is_inside", "", "within the tested range, first line", a.is_inside),
        _column("other_is_inside", "", "within the tested range, second line", b.is_inside),
        _column("is_untested", "", "farther from the runs than any run, first line",
                a.is_untested),
        _column("other_is_untested", "", "farther from the runs than any run, second line",
                b.is_untested),
        _column(f"peak_{_PERCENT}", "%", "greatest tension so, first line", 100 * a.peak_share),
        _column(f"minimum_{_PERCENT}", "%", "least tension so, first line", 100 * a.minimum_share),
    ]  # fmt: skip
    notes = [
        f"{line.name}: {text}"
        for line, one in ((first, a), (second, b))
        for text in (*one.warnings, *_about(line), f"rule: {one.rule}", *one.notes)
    ]
    return ValueTable(
        title=f"{name} of {second.name} against {first.name}{_branch(a)}",
        columns=tuple(columns),
        sources=(_source(first, a), _source(second, b)),
        notes=tuple(dict.fromkeys(notes)),
        is_synthetic=_is_synthetic(first) or _is_synthetic(second),
    )


def _column(name: str, unit: str, meaning: str, values: NDArray[np.generic]) -> TableColumn:
    kind = np.bool_ if values.dtype == np.bool_ else np.float64
    return TableColumn(name, unit, meaning, np.array(values.ravel(), dtype=kind))


def _between_lines(found: DesignValues) -> list[TableColumn]:
    """Intervals with the scatter between lines; none where it is not known."""
    if not np.isfinite(found.line_low).any():
        return []
    unit = found.unit
    return [
        *_interval("kind_interval", unit, "the mean of all specimens of the kind",
                   found.kind_low, found.kind_high),
        *_interval("line_interval", unit, "another specimen of the kind",
                   found.line_low, found.line_high),
    ]  # fmt: skip


def _interval(name: str, unit: str, of: str, low: Floats, high: Floats) -> list[TableColumn]:
    return [
        _column(f"{name}_low", unit, f"lower end of 95 % of {of}", low),
        _column(f"{name}_high", unit, f"upper end of 95 % of {of}", high),
    ]


def _levels(
    line: LineSource, found: DesignValues, levels: Mapping[str, ArrayLike], prefix: str = ""
) -> list[TableColumn]:
    """Levels in SI, and tensions in % of the break strength."""
    columns = []
    whose = f", {line.name}" if prefix else ""
    for name, values in levels.items():
        try:
            at: Floats = np.broadcast_to(np.asarray(values, np.float64), found.value.shape)
        except ValueError:
            raise SettingsError(
                f"the levels of {name} are not those of the values",
                found=str(np.shape(values)), needed=str(found.value.shape),
            ) from None  # fmt: skip
        known = quantity(name)
        columns.append(_column(f"{prefix}{name}", known.unit, f"{known.long_name}{whose}", at))
        if name in TENSIONS and np.isfinite(line.rated_break_strength):
            columns.append(
                _column(
                    f"{prefix}{name}_{_PERCENT}", "%", f"the same, of the break strength{whose}",
                    100 * at / line.rated_break_strength,
                )
            )  # fmt: skip
    return columns


def _branch(found: DesignValues) -> str:
    return f", {found.branch} branch" if found.branch else ""


def _meaning(name: str) -> str:
    return quantity(name).long_name


def _source(line: LineSource, found: DesignValues) -> str:
    errata = f"; errata that apply: {', '.join(found.errata)}" if found.errata else ""
    return f"{line.name}: {found.source}{errata}"


def _about(line: LineSource) -> list[str]:
    """Stated properties of the line itself."""
    stated = (
        (
            f"break strength of {line.strength_of}, of which levels are shares,"
            if line.strength_of
            else "break strength",
            line.rated_break_strength,
            "N",
        ),
        ("residual strength in its condition", line.tensile_strength, "N"),
        ("diameter", line.diameter, "m"),
        ("linear density in air", line.linear_density, "kg/m"),
        ("linear density in water", line.wet_linear_density, "kg/m"),
    )
    return [f"{what} {value:.6g} {unit}" for what, value, unit in stated if np.isfinite(value)]


def _is_synthetic(line: LineSource) -> bool:
    return "synthetic data" in line.notes


def write_netcdf(table: ValueTable, path: Path) -> None:
    """Write a table as a netCDF file in SI, with its sources as attributes."""
    variables: dict[str, Any] = {}
    for column in table.columns:
        is_flag = column.values.dtype == np.bool_
        values = column.values.astype(np.int8) if is_flag else column.values
        about: dict[str, object] = {"long_name": column.meaning}
        if is_flag:
            about |= {"flag_values": np.array([0, 1], np.int8), "flag_meanings": "no yes"}
        elif column.values.dtype.kind != "U":
            about["units"] = column.unit
        variables[column.name] = (("point",), values, about)
    variables |= _contribution_variables(table)
    dataset = xr.Dataset(
        variables,
        attrs={
            "Conventions": "CF-1.11 ACDD-1.3",
            "title": table.title,
            "source": "; ".join(table.sources),
            "comment": "; ".join(table.notes) or "none",
            "synthetic": "yes" if table.is_synthetic else "no",
            "history": f"reduction {__version__} export",
            "software_version": __version__,
        },
    )
    encoding = {
        name: {"_FillValue": np.nan if array.dtype == np.float64 else None}
        for name, array in dataset.variables.items()
        if array.dtype.kind != "U"
    }
    try:
        with atomic_file(path) as part:
            dataset.to_netcdf(part, format="NETCDF4", engine="netcdf4", encoding=encoding)
    except ArchiveError:
        raise
    except (OSError, RuntimeError) as error:
        raise ArchiveError(
            f"{path} cannot be written", found=getattr(error, "strerror", None) or str(error)
        ) from error


def _contribution_variables(table: ValueTable) -> dict[str, Any]:
    """Signed contributions to the tension by error, with the names used in archives."""
    if not table.component:
        return {}
    named = {
        "uncertainty_source": np.array([one.source for one in table.component]),
        "uncertainty_source_of": np.array([one.of for one in table.component]),
        "uncertainty_source_number": np.array([one.number for one in table.component]),
    }
    about = {name: {"long_name": quantity(name).long_name} for name in named}
    return {name: ((COMPONENT,), values, about[name]) for name, values in named.items()} | {
        CONTRIBUTION: (
            (COMPONENT, "point"), table.contribution, {"long_name": SIGNED, "units": "N"},
        )
    }  # fmt: skip

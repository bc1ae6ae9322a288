"""Design values as a table that every table format takes: levels, value, intervals, loads."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.errors import SettingsError
from reduction.export.table import TableColumn, ValueTable
from reduction.lookup.against import LineDifference
from reduction.lookup.product import DesignValues, LineSource
from reduction.record import Floats
from reduction.vocabulary import quantity

TENSIONS = ("mean_tension", "tension_amplitude", "tension")
"""Levels that are shares of a break strength as well."""
_OF_SUFFIX = {
    ".csv": "csv",
    ".json": "json",
    ".tex": "latex",
    ".md": "markdown",
    ".nc": "netcdf",
}
_PERCENT = "percent_of_break_strength"
_NO_INTERVAL = "nothing: no scatter is known"


def format_of_file(path: Path) -> str:
    """Format of a table by the end of its file's name.

    Parameters
    ----------
    path : pathlib.Path
        ``values.tex``.

    Returns
    -------
    form : str
        As `reduction.export.write.export_table` takes it.

    Raises
    ------
    SettingsError
        If no format has that end.
    """
    form = _OF_SUFFIX.get(path.suffix.lower())
    if form is None:
        raise SettingsError(
            "the end of the file's name says no format", found=path.name,
            needed=", ".join(_OF_SUFFIX),
        )  # fmt: skip
    return form


def table_of_values(
    line: LineSource, found: DesignValues, levels: Mapping[str, ArrayLike]
) -> ValueTable:
    """Design values of one line as a table, one row a point.

    Parameters
    ----------
    line : LineSource
        Whose values they are.
    found : DesignValues
        Of the points.
    levels : mapping of str to array_like
        As they were looked up; broadcast to the points. [SI]

    Returns
    -------
    table : ValueTable
        Tensions in % of the break strength too, where that is known.

    Raises
    ------
    SettingsError
        If the levels do not broadcast to the points.
    """
    unit = found.unit
    columns = [
        *_levels(line, found, levels),
        _column(found.quantity, unit, _meaning(found.quantity), found.value),
        *_interval("interval", unit, found.interval_of or _NO_INTERVAL, found.low, found.high),
        *_interval("surface_interval", unit, found.surface_interval_of or _NO_INTERVAL,
                   found.surface_low, found.surface_high),
        *_between_lines(found),
        _column("is_below_zero", "", "below zero, which it cannot be", found.is_below_zero),
        _column("is_inside", "", "inside what was tested", found.is_inside),
        _column("is_untested", "", "inside, farther from the runs than any", found.is_untested),
        _column("peak_tension", "N", "greatest tension of the cycle", found.peak_tension),
        _column("minimum_tension", "N", "least tension of the cycle", found.minimum_tension),
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
        notes=(*_about(line), f"rule: {found.rule}", *found.notes),
        is_synthetic=_is_synthetic(line),
    )


def table_of_difference(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    levels: Mapping[str, ArrayLike],
    other_levels: Mapping[str, ArrayLike],
) -> ValueTable:
    """Two lines at the same points as a table, one row a point.

    Parameters
    ----------
    first, second : LineSource
        Whose values they are.
    found : LineDifference
        The second against the first.
    levels, other_levels : mapping of str to array_like
        At which the first and the second were looked up. [SI]

    Returns
    -------
    table : ValueTable
        Columns of the second line begin with ``other_``.

    Raises
    ------
    SettingsError
        If the levels do not broadcast to the points.
    """
    unit, name = found.unit, found.quantity
    a, b = found.first, found.second
    columns = [
        *_levels(first, a, levels),
        *_levels(second, b, other_levels, "other_"),
        _column(name, unit, f"{_meaning(name)}, {first.name}", a.value),
        _column(f"other_{name}", unit, f"{_meaning(name)}, {second.name}", b.value),
        _column("difference", unit, "the second less the first", found.difference),
        _column("ratio", "1", "the second over the first", found.ratio),
        _column("surface_interval_low", unit, "lower end of 95 % of what the surfaces differ by",
                found.surface_low),
        _column("surface_interval_high", unit, "upper end of 95 % of what the surfaces differ by",
                found.surface_high),
        _column("interval_low", unit, "the same of one more run of the same lines", found.low),
        _column("interval_high", unit, "the same of one more run of the same lines", found.high),
        _column("kind_interval_low", unit, "the same of all lines of the kinds", found.kind_low),
        _column("kind_interval_high", unit, "the same of all lines of the kinds",
                found.kind_high),
        _column("line_interval_low", unit, "the same of another line of each", found.line_low),
        _column("line_interval_high", unit, "the same of another line of each", found.line_high),
        _column("is_known", "", "both surfaces have an interval", found.is_known),
        _column("is_different", "", "the surfaces of these lines differ", found.is_different),
        _column("is_test_known", "", "both have an interval of one more run",
                found.is_test_known),
        _column("is_test_different", "", "one more run of the same lines would differ",
                found.is_test_different),
        _column("is_kind_known", "", "of both kinds the scatter between lines is known",
                found.is_kind_known),
        _column("is_kind_different", "", "the means of the two kinds of line differ",
                found.is_kind_different),
        _column("is_line_known", "", "both have an interval of another line",
                found.is_line_known),
        _column("is_line_different", "", "another line of each would differ",
                found.is_line_different),
        _column("is_inside", "", "inside what was tested, first line", a.is_inside),
        _column("other_is_inside", "", "inside what was tested, second line", b.is_inside),
        _column("is_untested", "", "inside, farther from the runs than any, first line",
                a.is_untested),
        _column("other_is_untested", "", "inside, farther from the runs than any, second line",
                b.is_untested),
        _column(f"peak_{_PERCENT}", "%", "greatest tension so, first line", 100 * a.peak_share),
        _column(f"minimum_{_PERCENT}", "%", "least tension so, first line", 100 * a.minimum_share),
    ]  # fmt: skip
    notes = [
        f"{line.name}: {text}"
        for line, one in ((first, a), (second, b))
        for text in (*_about(line), f"rule: {one.rule}", *one.notes)
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
    """Intervals with the scatter between lines; none where that is not known."""
    if not np.isfinite(found.line_low).any():
        return []
    unit = found.unit
    return [
        *_interval("kind_interval", unit, "the mean of all lines of the kind",
                   found.kind_low, found.kind_high),
        *_interval("line_interval", unit, "another line of the kind",
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
    errata = f"; errata that touch it: {', '.join(found.errata)}" if found.errata else ""
    return f"{line.name}: {found.source}{errata}"


def _about(line: LineSource) -> list[str]:
    """What is stated of the line itself."""
    stated = (
        (
            f"break strength of {line.strength_of}, of which levels are shares,"
            if line.strength_of
            else "break strength",
            line.rated_break_strength,
            "N",
        ),
        ("strength that it has in its condition", line.tensile_strength, "N"),
        ("diameter", line.diameter, "m"),
        ("linear density in air", line.linear_density, "kg/m"),
        ("linear density in water", line.wet_linear_density, "kg/m"),
    )
    return [f"{what} {value:.6g} {unit}" for what, value, unit in stated if np.isfinite(value)]


def _is_synthetic(line: LineSource) -> bool:
    return "synthetic data" in line.notes

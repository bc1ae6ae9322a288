"""The command lookup: one design value, or a grid of them, with interval, range and source."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
from rich.table import Table

from reduction.cli.commandoutput import CommandOutput
from reduction.cli.lookuppoints import Wanted, points_of
from reduction.cli.lookupsource import lines_of, one_of
from reduction.cli.numbers import as_given, plain, short, table_of, within
from reduction.export.lookuptable import TENSIONS, format_of_file, table_of_values
from reduction.export.table import ValueTable
from reduction.export.write import export_table
from reduction.lookup.line import look_up
from reduction.lookup.product import DesignValues, LineSource
from reduction.lookup.search import find_lines
from reduction.record import Floats
from reduction.units import UnitSystem, display_unit
from reduction.vocabulary import quantity as quantity_of


def list_sources(source: str, search: Mapping[str, Any], *, output: CommandOutput) -> None:
    """Print what SOURCE holds: each line, its quantities, and over which range."""
    lines = find_lines(lines_of(source), **search)
    unit, factor = ("in", 1 / 0.0254) if output.units == "us" else ("mm", 1e3)
    force, scale = display_unit("N", cast("UnitSystem", output.units))
    table = table_of(
        "line", "source", "material", "construction", "condition", f"diameter\n[{unit}]",
        f"%RBS are of\n[{force}]", "quantities", texts=5,
    )  # fmt: skip
    fold_last(table)
    # what is copied into the next command is never broken
    table.columns[0].no_wrap = True
    table.columns[-1].min_width = 1 + max(len(name) for line in lines for name in line.quantities)
    for line in lines:
        table.add_row(
            line.name, line.source, line.material, line.construction, line.condition,
            short(factor * line.diameter, 4),
            short(scale * line.rated_break_strength)
            + (f"\n({line.strength_of})" if line.strength_of else ""),
            ", ".join(line.quantities),
        )  # fmt: skip
    output.show(table)
    output.answer({"lines": [_described(line) for line in lines]})


def _described(line: LineSource) -> dict[str, Any]:
    return {
        "name": line.name,
        "source": line.source,
        "kind": line.kind,
        "material": line.material,
        "construction": line.construction,
        "condition": line.condition,
        "diameter": plain(line.diameter),
        "rated_break_strength": plain(line.rated_break_strength),
        "rated_break_strength_of": line.strength_of or None,
        "tensile_strength": plain(line.tensile_strength),
        "linear_density": plain(line.linear_density),
        "wet_linear_density": plain(line.wet_linear_density),
        "units": {
            "diameter": "m",
            "rated_break_strength": "N",
            "tensile_strength": "N",
            "linear_density": "kg m-1",
            "wet_linear_density": "kg m-1",
        },
        "quantities": list(line.quantities),
        "absent": line.absent,
        "ranges": {
            quantity: {
                name: [float(surface.low[place]), float(surface.high[place])]
                for place, name in enumerate(line.factor_names)
            }
            for quantity, surface in line.surfaces.items()
        },
        "curves": [
            {
                "quantity": curve.quantity,
                "variable": curve.variable,
                "branch": curve.branch or None,
                "range": [curve.low, curve.high],
                "range_note": curve.range_note or None,
            }
            for curve in line.curves
        ],
        "range_units": {
            name: quantity_of(name).unit
            for name in (*line.factor_names, *(curve.variable for curve in line.curves))
        },
        "rule": line.rule,
        "notes": list(line.notes),
    }


def look_up_values(source: str, wanted: Wanted, *, output: CommandOutput) -> None:
    """Print design values; several values of a level, parted by commas, make a grid."""
    form = None if wanted.out is None else format_of_file(wanted.out)
    line = one_of(find_lines(lines_of(source), **wanted.search), wanted.quantity, wanted.name)
    (points,), left_out = points_of(wanted, line)
    if left_out:
        output.say("combinations whose amplitude is above the mean tension are left out")
    found = look_up(
        line, wanted.quantity, branch=wanted.branch, extrapolate=wanted.extrapolate, **points
    )
    _show(line, found, points, output)
    files = write_table(table_of_values(line, found, points), wanted.out, form, output)
    output.answer(_document(line, found, points, grid=wanted.grid) | {"files": files})


def write_table(
    table: ValueTable, out: Path | None, form: str | None, output: CommandOutput
) -> list[str]:
    """Write the table where a file was named, and say so."""
    if out is None or form is None:
        return []
    paths = export_table(table, form, out, units=cast("UnitSystem", output.units))
    for path in paths:
        output.say(f"written: {path}")
    return [str(path) for path in paths]


def _show(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], output: CommandOutput
) -> None:
    system = cast("UnitSystem", output.units)
    unit, factor = display_unit(found.unit, system)
    branch = f", {found.branch} branch" if found.branch else ""
    output.say(f"{found.quantity} of {line.name}{branch}; {found.source}")
    if output.is_text:
        output.show(_table(line, found, points, unit, factor, system))
    said_of_lines(output, (line, found))


def _table(
    line: LineSource,
    found: DesignValues,
    points: Mapping[str, Floats],
    unit: str,
    factor: float,
    system: UnitSystem,
) -> Table:
    """One row a point; of the intervals those that are known."""
    heads, levels = shown_levels(points, line.rated_break_strength, found.value.size, system)
    intervals = [
        (head, low.ravel(), high.ravel())
        for head, low, high in (
            ("95 % of\none more run", found.low, found.high),
            (
                f"95 % of\nthe {'surface' if found.interval_of else 'one test'}",
                found.surface_low,
                found.surface_high,
            ),
            ("95 % of\nanother line", found.line_low, found.line_high),
        )
        if np.isfinite(low).any()
    ]
    is_weaker = np.isfinite(line.tensile_strength)
    table = table_of(
        *heads, f"value\n[{unit}]", *(head for head, _, _ in intervals),
        "peak\n[%RBS]", "minimum\n[%RBS]",
        *(("peak [% of what\nit still has]",) if is_weaker else ()), "remark", texts=0,
    )  # fmt: skip
    fold_last(table)
    shares = [found.peak_share, found.minimum_share, *([found.own_peak_share] if is_weaker else [])]
    for place, numbers in enumerate(levels):
        table.add_row(
            *numbers,
            within(
                factor * float(found.value.ravel()[place]),
                *(factor * float(high[place] - low[place]) / 2 for _, low, high in intervals),
            ),
            *(span(factor, low[place], high[place]) for _, low, high in intervals),
            *(short(100 * float(share.ravel()[place]), 4) for share in shares),
            "; ".join(_remarks(found, place)),
        )
    return table


def _remarks(found: DesignValues, place: int) -> list[str]:
    def at(values: Any) -> Any:
        return values.ravel()[place]

    return [
        word
        for word, is_so in (
            ("OUTSIDE what was tested", not at(found.is_inside)),
            ("untested corner", at(found.is_untested)),
            ("peak above the strength it has", at(found.own_peak_share) >= 1),
            ("peak above the rule", at(found.is_above_rule)),
            ("snap load: goes slack", at(found.is_slack) and at(found.peak_tension) > 0),
            ("below zero: no value", at(found.is_below_zero)),
            (
                "lower end below zero: not told from zero",
                not at(found.is_below_zero) and (at(found.low) < 0 or at(found.surface_low) < 0),
            ),
        )
        if is_so
    ]


def said_of_lines(output: CommandOutput, *pairs: tuple[LineSource, DesignValues]) -> None:
    """What is stated of each line, its rule, its errata and notes; each sentence once."""
    told = []
    for line, found in pairs:
        of = f" of {line.name}" if len(pairs) > 1 else ""
        for what, value in (("in air", line.linear_density), ("in water", line.wet_linear_density)):
            if np.isfinite(value):
                told.append(f"linear density{of} {what}: {short(value)} kg/m")
        told.append(f"rule: {found.rule}")
        if found.errata:
            told.append(f"errata that touch it{of}: {', '.join(found.errata)}")
        told += [f"note{of}: {note}" for note in found.notes]
    for text in dict.fromkeys(told):
        output.say(text)


def shown_levels(
    points: Mapping[str, Floats], strength: float, size: int, system: UnitSystem
) -> tuple[list[str], list[list[str]]]:
    """Headings and cells of the levels, tensions in %RBS as well where that is known."""
    heads, columns = [], []
    for name, values in points.items():
        unit, factor = _shown(name, system)
        # names stand below each other's words: there is little room beside seven columns
        words = name.replace("_", "\n")
        heads.append(f"{words}\n[{unit}]")
        columns.append([as_given(factor * float(value)) for value in values.ravel()])
        if name in TENSIONS and np.isfinite(strength):
            heads.append("\n[%RBS]")
            columns.append([short(100 * float(value) / strength, 4) for value in values.ravel()])
    return heads, [[column[place] for column in columns] for place in range(size)]


def fold_last(table: Table) -> None:
    """Let the last column, of words, take the room that numbers leave."""
    last = table.columns[-1]
    last.justify, last.no_wrap, last.overflow = "left", False, "fold"


def span(factor: float, low: float, high: float) -> str:
    """An interval for a table; a dash where there is none."""
    if not (np.isfinite(low) and np.isfinite(high)):
        return "-"
    ends, half = (factor * float(low), factor * float(high)), factor * float(high - low) / 2
    return " to ".join(within(one, half) for one in ends)


def _shown(name: str, system: UnitSystem) -> tuple[str, float]:
    units = {"frequency": "Hz", "strain": "1"}
    if name == "strain":
        return "%", 100.0
    return display_unit(units.get(name, "N"), system)


def _document(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], *, grid: bool
) -> dict[str, Any]:
    """What ``--json`` says, in SI: numbers of a single point, lists of a grid."""

    def of(values: Any) -> Any:
        shaped = np.atleast_1d(values).ravel()
        return plain(shaped if grid else shaped[0])

    return {
        "line": line.name,
        "quantity": found.quantity,
        "branch": found.branch or None,
        "levels": {name: of(values) for name, values in points.items()},
        "level_units": {name: quantity_of(name).unit for name in points},
        "value": of(found.value),
        "unit": found.unit,
        "below_zero": of(found.is_below_zero),
        "interval": [of(found.low), of(found.high)],
        "interval_of": found.interval_of or None,
        "surface_interval": [of(found.surface_low), of(found.surface_high)],
        "surface_interval_of": found.surface_interval_of or None,
        "kind_interval": [of(found.kind_low), of(found.kind_high)],
        "kind_interval_of": "the mean of all lines of the kind",
        "line_interval": [of(found.line_low), of(found.line_high)],
        "line_interval_of": "another line of the kind",
        "inside": of(found.is_inside),
        "untested": of(found.is_untested),
        "peak_tension": of(found.peak_tension),
        "minimum_tension": of(found.minimum_tension),
        "peak_share": of(found.peak_share),
        "minimum_share": of(found.minimum_share),
        "tension_unit": "N",
        "own_peak_share": of(found.own_peak_share),
        "own_minimum_share": of(found.own_minimum_share),
        "slack": of(found.is_slack),
        "above_rule": of(found.is_above_rule),
        "rule": found.rule,
        "rated_break_strength": plain(line.rated_break_strength),
        "rated_break_strength_of": line.strength_of or None,
        "tensile_strength": plain(line.tensile_strength),
        "strength_unit": "N",
        "linear_density": plain(line.linear_density),
        "wet_linear_density": plain(line.wet_linear_density),
        "linear_density_unit": "kg m-1",
        "source": found.source,
        "errata": list(found.errata),
        "notes": list(found.notes),
    }

"""The command lookup with --against: design values of two lines at the same points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
from rich.table import Table

from reduction.cli.commandoutput import CommandOutput
from reduction.cli.lookup import fold_last, said_of_lines, shown_levels, span, write_table
from reduction.cli.lookuppoints import Wanted, points_of
from reduction.cli.lookupsource import lines_of, one_of
from reduction.cli.numbers import plain, short, table_of, within
from reduction.errors import SettingsError
from reduction.export.lookuptable import format_of_file, table_of_difference
from reduction.lookup.against import LineDifference, compare_values
from reduction.lookup.line import look_up
from reduction.lookup.product import DesignValues, LineSource
from reduction.lookup.search import find_lines
from reduction.record import Bools, Floats
from reduction.units import UnitSystem, display_unit
from reduction.vocabulary import quantity as quantity_of


def look_up_against(source: str, other: str, wanted: Wanted, *, output: CommandOutput) -> None:
    """Print values of two lines, their difference and ratio, and whether the intervals allow it."""
    form = None if wanted.out is None else format_of_file(wanted.out)
    lines = lines_of(source)
    first = one_of(find_lines(lines, **wanted.search), wanted.quantity, wanted.name)
    second = _other(lines, other, wanted.quantity, first)
    (points, others), left_out = points_of(wanted, first, second)
    if left_out:
        output.say("combinations whose amplitude is above the mean tension are left out")
    values = [
        look_up(line, wanted.quantity, branch=wanted.branch, extrapolate=wanted.extrapolate, **at)
        for line, at in ((first, points), (second, others))
    ]
    found = compare_values(*values)
    _show(first, second, found, points, others, output)
    table = table_of_difference(first, second, found, points, others)
    files = write_table(table, wanted.out, form, output)
    document = _document(first, second, found, points, others, grid=wanted.grid)
    output.answer(document | {"files": files})


def _other(lines: list[LineSource], name: str, quantity: str, first: LineSource) -> LineSource:
    """The second line: one of SOURCE by its name, else what the name means by itself.

    Of several that it means the one that is called as the first: the same specimen in two tests.
    """
    of_source = [line for line in lines if line.name == name]
    found = of_source or lines_of(name)
    having = [line for line in found if quantity in line.quantities]
    if len(having) < 2:
        return one_of(found, quantity, None)
    alike = [line for line in having if line.name == first.name]
    if len(alike) != 1:
        raise SettingsError(
            f"--against {name} means several lines with {quantity}: which is not said",
            found=", ".join(f"{line.name} ({line.source})" for line in having),
            needed=f"the name of one line, or one called {first.name} as the first is",
            hint='Of tests of one campaign: lookup processed/CAMPAIGN --line "T-1 new" --against '
            '"T-2 used".',
        )
    return alike[0]


def _show(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    others: Mapping[str, Floats],
    output: CommandOutput,
) -> None:
    system = cast("UnitSystem", output.units)
    unit, factor = display_unit(found.unit, system)
    branch = f", {found.first.branch} branch" if found.first.branch else ""
    # one specimen in two tests has one name
    told = [
        f"{line.name} of {line.source}" if first.name == second.name else line.name
        for line in (second, first)
    ]
    output.say(f"{found.quantity} of {told[0]} (second) against {told[1]} (first){branch}")
    if any(not np.array_equal(values, others[name]) for name, values in points.items()):
        output.say(
            "levels in %RBS are shares of each line's own break strength: "
            + " and ".join(
                f"{short(scale * line.rated_break_strength)} {force}"
                for line in (first, second)
                for force, scale in (display_unit("N", system),)
            )
            + "; loads are those of the first"
        )
    if output.is_text:
        output.show(_table(first, found, points, unit, factor, system))
    output.say("differ: zero is not in the 95 % interval that follows from those of both lines")
    output.say(
        "95 % of the difference is of these lines: the surfaces, or the curves, that were tested"
    )
    output.say(
        "these lines: the two surfaces, of the lines that were tested; the kinds, another line of "
        "each: with how lines differ among each other, where a source says it"
    )
    for note in found.notes:
        output.say(note)
    said_of_lines(output, (first, found.first), (second, found.second))


def _table(
    first: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    unit: str,
    factor: float,
    system: UnitSystem,
) -> Table:
    heads, levels = shown_levels(points, first.rated_break_strength, found.difference.size, system)
    table = table_of(
        *heads, f"first\n[{unit}]", f"second\n[{unit}]", f"difference\n[{unit}]", "ratio",
        "95 % of the\ndifference of\nthese lines", "these\nlines", "the kinds",
        "another line\nof each", "remark", texts=0,
    )  # fmt: skip
    fold_last(table)
    numbers = ("difference", "ratio", "surface_low", "surface_high")
    for place, cells in enumerate(levels):
        at = {name: float(getattr(found, name).ravel()[place]) for name in numbers}
        table.add_row(
            *cells,
            *(within(*_with_halves(one, place, factor)) for one in (found.first, found.second)),
            within(
                factor * at["difference"], factor * (at["surface_high"] - at["surface_low"]) / 2
            ),
            short(at["ratio"], 4),
            span(factor, at["surface_low"], at["surface_high"]),
            _verdict(found.is_known, found.is_different, place),
            _verdict(found.is_kind_known, found.is_kind_different, place),
            _verdict(found.is_line_known, found.is_line_different, place),
            _remark(found, place),
        )
    return table


def _with_halves(found: DesignValues, place: int, factor: float) -> tuple[float, ...]:
    """A value and the half widths of its intervals, as they are shown."""
    spans = ((found.surface_low, found.surface_high), (found.low, found.high))
    halves = ((high - low).ravel()[place] / 2 for low, high in spans)
    return tuple(factor * float(one) for one in (found.value.ravel()[place], *halves))


def _verdict(is_known: Bools, is_different: Bools, place: int) -> str:
    if not is_known.ravel()[place]:
        return "no interval"
    return "differ" if is_different.ravel()[place] else "not told apart"


def _remark(found: LineDifference, place: int) -> str:
    words = []
    for which, one in (("first", found.first), ("second", found.second)):
        if not one.is_inside.ravel()[place]:
            words.append(f"{which}: OUTSIDE")
        if one.is_untested.ravel()[place]:
            words.append(f"{which}: untested corner")
        if one.own_peak_share.ravel()[place] >= 1:
            words.append(f"{which}: peak above the strength it has")
        elif one.is_above_rule.ravel()[place]:
            words.append(f"{which}: peak above the rule")
        if one.is_below_zero.ravel()[place]:
            words.append(f"{which}: below zero, no value")
    return "; ".join(words)


def _document(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    others: Mapping[str, Floats],
    *,
    grid: bool,
) -> dict[str, Any]:
    """What ``--json`` says, in SI: numbers of a single point, lists of a grid."""

    def of(values: Any) -> Any:
        shaped = np.atleast_1d(values).ravel()
        return plain(shaped if grid else shaped[0])

    def side(line: LineSource, one: DesignValues, at: Mapping[str, Floats]) -> dict[str, Any]:
        return {
            "line": line.name,
            "levels": {name: of(values) for name, values in at.items()},
            "level_units": {name: quantity_of(name).unit for name in at},
            "value": of(one.value),
            "interval": [of(one.low), of(one.high)],
            "interval_of": one.interval_of or None,
            "surface_interval": [of(one.surface_low), of(one.surface_high)],
            "surface_interval_of": one.surface_interval_of or None,
            "kind_interval": [of(one.kind_low), of(one.kind_high)],
            "line_interval": [of(one.line_low), of(one.line_high)],
            "below_zero": of(one.is_below_zero),
            "inside": of(one.is_inside),
            "untested": of(one.is_untested),
            "peak_share": of(one.peak_share),
            "minimum_share": of(one.minimum_share),
            "own_peak_share": of(one.own_peak_share),
            "own_minimum_share": of(one.own_minimum_share),
            "tensile_strength": plain(line.tensile_strength),
            "above_rule": of(one.is_above_rule),
            "rule": one.rule,
            "source": one.source,
            "errata": list(one.errata),
            "notes": list(one.notes),
        }

    return {
        "quantity": found.quantity,
        "branch": found.first.branch or None,
        "unit": found.unit,
        "first": side(first, found.first, points),
        "second": side(second, found.second, others),
        "difference": of(found.difference),
        "ratio": of(found.ratio),
        "surface_interval": [of(found.surface_low), of(found.surface_high)],
        "interval": [of(found.low), of(found.high)],
        "kind_interval": [of(found.kind_low), of(found.kind_high)],
        "line_interval": [of(found.line_low), of(found.line_high)],
        "known": of(found.is_known),
        "different": of(found.is_different),
        "test_known": of(found.is_test_known),
        "test_different": of(found.is_test_different),
        "kind_known": of(found.is_kind_known),
        "kind_different": of(found.is_kind_different),
        "line_known": of(found.is_line_known),
        "line_different": of(found.is_line_different),
        "inside": of(found.is_inside),
        "notes": list(found.notes),
    }

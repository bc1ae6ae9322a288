"""The command composite: one curve of tension against strain from zero, out of many tests."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np

from reduction.cli.commandoutput import CommandOutput
from reduction.cli.compositesource import piece_source, rule_of
from reduction.cli.numbers import plain, short, table_of
from reduction.errors import SettingsError
from reduction.export.fromcomposite import composite_table, ranges_of
from reduction.export.write import export_table
from reduction.lookup.composite import CompositeCurve
from reduction.lookup.compositerule import CompositeRule
from reduction.lookup.pieces import PieceBranch
from reduction.lookup.source import PieceSource, compose, used_of
from reduction.record import Floats
from reduction.report.curvepage import write_composite_page
from reduction.uncertainty.product import Component
from reduction.units import UnitSystem, display_unit

_ROWS = 24
_SHOWN = 1e-3
"""Share of the tension above which a row says that it was moved."""
PAGE = "page"
_FORMATS = {
    ".csv": "csv", ".json": "json", ".nc": "netcdf", ".md": "markdown", ".tex": "latex",
    ".html": PAGE,
}  # fmt: skip


def table_format(path: Path) -> str:
    """Format of a table, or `PAGE`, by the name of its file.

    Raises
    ------
    SettingsError
        If the name ends otherwise.
    """
    if path.suffix.lower() not in _FORMATS:
        raise SettingsError(
            "the name of the file says its format", found=path.name,
            needed="a name that ends in " + ", ".join(_FORMATS),
        )  # fmt: skip
    return _FORMATS[path.suffix.lower()]


def compose_tests(
    sources: Sequence[str],
    *,
    specimen: str | None,
    branch: PieceBranch | None,
    precedence: str | None,
    out: Path | None,
    output: CommandOutput,
) -> None:
    """Print the composite curve of SOURCE; with ``out``, write every node of it."""
    form = None if out is None else table_format(out)
    rule = rule_of(precedence)
    source = piece_source(sources, specimen=specimen, branch=branch)
    curve = compose(source, rule)
    source = used_of(source, curve)
    units = cast("UnitSystem", output.units)
    _show(source, curve, output, units)
    if out is not None and form is not None:
        if form == PAGE:
            write_composite_page(source, curve, out, units=units)
        else:
            export_table(composite_table(source, curve), form, out, units=units)
        output.say(f"written: {out}")
    output.answer(_document(source, curve, rule) | {"out": None if out is None else str(out)})


def _show(
    source: PieceSource, curve: CompositeCurve, output: CommandOutput, system: UnitSystem
) -> None:
    unit, factor = display_unit("N", system)
    made = ", SYNTHETIC: nothing was tested" if source.is_synthetic else ""
    doubt = f"; DOUBTFUL: {curve.doubt}" if curve.doubt else ""
    output.say(f"{composite_table(source, curve).title}{made}{doubt}")
    table = table_of(
        "strain [%]", f"tension [{unit}]", f"standard uncertainty [{unit}]",
        f"of it shared [{unit}]", "piece", "remark",
        texts=0,
    )  # fmt: skip
    ends = np.flatnonzero(np.diff(curve.is_gap)) + 1
    some = np.linspace(0, curve.strain.size - 1, _ROWS).round().astype(int)
    is_moved = np.abs(np.nan_to_num(curve.monotone_change)) > _SHOWN * curve.tension
    shared = factor * curve.shared_standard_uncertainty
    for place in np.union1d(ends, some):
        flags = [
            word
            for word, of in (
                ("gap", curve.is_gap), ("join", curve.is_join),
            )
            if place and of[place - 1]
        ]  # fmt: skip
        change = factor * float(curve.monotone_change[place])
        if is_moved[place]:
            flags.append(f"moved {change:+.3g} by the rule of rising")
        table.add_row(
            short(100 * float(curve.strain[place]), 4),
            short(factor * float(curve.tension[place])),
            short(factor * float(curve.standard_uncertainty[place]), 3),
            short(float(shared[place]), 3),
            curve.piece_words[curve.piece[place]] if curve.piece[place] >= 0 else "-",
            ", ".join(flags),
        )
    output.show(table)
    for text in curve.notes:
        output.say(f"note: {text}")
    for text in source.notes:
        output.say(f"note: {text}")
    for text in source.sources:
        output.say(f"source: {text}")


def contributions(component: Sequence[Component], rows: Floats) -> list[dict[str, Any]]:
    """What each shared error adds to a curve, signed, as ``--json`` says it."""
    return [
        {"source": one.source, "of": one.of, "number": one.number, "contribution": plain(row)}
        for one, row in zip(component, rows, strict=True)
    ]


def _document(source: PieceSource, curve: CompositeCurve, rule: CompositeRule) -> dict[str, Any]:
    """What ``--json`` says, in SI."""
    return {
        "name": source.name,
        "branch": source.branch,
        "rule": {
            "precedence": list(rule.precedence),
            "taper": rule.taper,
            "least_slope": rule.least_slope,
        },
        "strain": plain(curve.strain),
        "tension": plain(curve.tension),
        "tension_standard_uncertainty": plain(curve.standard_uncertainty),
        "tension_random_standard_uncertainty": plain(curve.random_standard_uncertainty),
        "tension_shared_standard_uncertainty": plain(curve.shared_standard_uncertainty),
        "tension_uncertainty_contributions": contributions(curve.component, curve.contribution),
        "piece": [curve.piece_words[one] if one >= 0 else None for one in curve.piece],
        "units": {
            "strain": "1", "tension": "N", "tension_standard_uncertainty": "N",
            "tension_random_standard_uncertainty": "N",
            "tension_shared_standard_uncertainty": "N", "tension_uncertainty_contributions": "N",
            "joins": "1", "gaps": "1", "moved": "1", "monotone_change": "N",
            "between_pieces": "1",
        },
        "pieces": [
            {
                "name": one.name,
                "kind": one.kind,
                "branch": one.branch,
                "strain": [float(one.strain[0]), float(one.strain[-1])],
                "used": one.kind in rule.precedence,
            }
            for one in source.pieces
        ],
        "joins": [list(one) for one in ranges_of(curve, curve.is_join)],
        "gaps": [list(one) for one in ranges_of(curve, curve.is_gap)],
        "moved": [list(one) for one in ranges_of(curve, curve.is_moved)],
        "monotone_change": plain(curve.monotone_change),
        "between_pieces": plain(curve.between_pieces),
        "doubt": curve.doubt,
        "sources": list(source.sources),
        "notes": [*curve.notes, *source.notes],
        "synthetic": source.is_synthetic,
    }  # fmt: skip

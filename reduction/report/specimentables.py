"""Tables about the specimens: what they are, what they had seen, how their strain was found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.archive.schema import COEFFICIENTS
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    count,
    make_table,
    measured,
    number,
    span,
    words,
)
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import NORMAL, plus_minus
from reduction.report.view import TestView, any_synthetic
from reduction.units import UnitSystem
from reduction.vocabulary import QUANTITIES

__all__ = [
    "coefficient_table",
    "history_table",
    "mark_table",
    "slope_sentences",
    "specimen_notes",
    "specimen_table",
]


def specimen_table(tests: Sequence[TestView], units: UnitSystem) -> Table:
    """Return the specimens of a campaign, each once, as its first test has it."""
    small, area, force = shown("small length", units), shown("area", units), shown("tension", units)
    rows: dict[str, list[Cell]] = {}
    for view in tests:
        for place, name in enumerate(view.specimens):
            if name in rows:
                continue
            rows[name] = [
                words(name),
                words(_text(view, "specimen_kind", place)),
                words(_text(view, "specimen_material", place)),
                words(_text(view, "specimen_condition", place)),
                number(_value(view, "diameter", place), small),
                number(_value(view, "area", place), area),
                number(_value(view, "rated_break_strength", place), force),
            ]
    columns = (
        "specimen", "kind", "material", "condition", small.label("diameter"),
        area.label("area at zero tension"), force.label("rated break strength"),
    )  # fmt: skip
    return make_table(
        "Specimens before their first test; the diameter is the mean of the readings.", columns,
        list(rows.values()), synthetic=any_synthetic(tests),
    )  # fmt: skip


def specimen_notes(tests: Sequence[TestView]) -> list[str]:
    """Return what is to be known about each specimen, each sentence once."""
    notes = [
        f"{stage.removeprefix('specimen ')}: {text}"
        for view in tests
        for stage, text in zip(view.texts("note_stage"), view.texts("note"), strict=True)
        if stage.startswith("specimen ")
    ]
    return list(dict.fromkeys(notes))


def history_table(view: TestView) -> Table | None:
    """Return what each specimen had seen before the test."""
    if "earlier_cycles" not in view.data:
        return None
    percent, force = shown("strain", view.units), shown("tension", view.units)
    flex = ["earlier_flex_cycles"] if "earlier_flex_cycles" in view.data else []
    rows = [
        [
            words(name),
            words(_text(view, "earlier_tests", place) or "none"),
            *(count(_value(view, cycles, place)) for cycles in ("earlier_cycles", *flex)),
            number(_value(view, "earlier_maximum_strain", place), percent),
            number(_value(view, "earlier_maximum_tension", place), force),
            number(_value(view, "permanent_set", place), percent),
        ]
        for place, name in enumerate(view.specimens)
    ]
    columns = (
        "specimen", "earlier tests", "earlier cycles [1]",
        *("earlier flex cycles [1]" for _ in flex), percent.label("greatest strain seen"),
        force.label("greatest tension seen"), percent.label("permanent set"),
    )  # fmt: skip
    return make_table(
        "What each specimen had seen before this test.", columns, rows, synthetic=view.is_synthetic
    )


def coefficient_table(view: TestView) -> Table | None:
    """Return how crosshead position became strain: method, range of the marks, coefficients."""
    methods = view.texts("strain_method")
    if not methods:
        return None
    columns = [dict(_coefficients(view, place)) for place in range(len(methods))]
    names = dict.fromkeys(name for column in columns for name in column)
    rows = [
        [words("method"), *(words(method) for method in methods)],
        *([words(name), *(column.get(name, words("")) for column in columns)] for name in names),
    ]
    if set(methods) == {"extensometer"}:
        return make_table(
            "How strain was found: read off an extensometer, no splice in it.",
            ("what, with its unit", *view.specimens), rows[:1], synthetic=view.is_synthetic,
        )  # fmt: skip
    return make_table(
        "Position to strain of the splice-free length: method, and what it goes by.",
        ("what, with its unit", *view.specimens), rows, synthetic=view.is_synthetic,
        remarks=[
            plus_minus(
                [NORMAL],
                "tape readings, regression on the splice marks",
                left_out="load-cell calibration, position scale, the choice of strain method",
            )
        ],
    )  # fmt: skip


def slope_sentences(view: TestView) -> list[str]:
    """Return what a constant splice fraction would make of the moduli, one sentence a specimen.

    A modulus goes as the inverse of the strain slope.
    """
    ratio = view.array("strain_slope_ratio")
    if ratio is None or "tangent_modulus" not in view.data:
        return []
    methods = view.texts("strain_method")
    found = []
    for place, name in enumerate(view.specimens):
        if not np.isfinite(ratio[place]) or ratio[place] <= 0:
            continue
        if methods[place] == "constant-fraction":
            continue
        excess = 100.0 * (1.0 / ratio[place] - 1.0)
        side = "high" if excess >= 0 else "low"
        found.append(
            f"{name}: a constant splice fraction, the method printed in WHOI-2005-10, reads these"
            f" moduli {abs(excess):.1f} % {side} (strain slope {ratio[place]:.3f} of the one used"
            " here)."
        )
    return found


def mark_table(view: TestView) -> Table | None:
    """Return the readings at the splice marks, and how far the method is off at each."""
    position = view.array("mark_position")
    if position is None:
        return None
    length, force = shown("length", view.units), shown("tension", view.units)
    percent = shown("strain", view.units)
    strain = view.array_like("mark_strain", position)
    tension = view.array_like("mark_tension", position)
    residual = view.array_like("mark_strain_residual", position)
    labels = (view.texts("mark_specimen"), view.texts("mark_test"), view.texts("mark_hold"))
    rows = [
        [
            *(words(text[place]) for text in labels),
            number(position[place], length),
            number(tension[place], force),
            number(strain[place], percent),
            number(strain[place] + residual[place], percent),
            Cell(_signed(residual[place]), repr(float(residual[place])), is_number=True),
        ]
        for place in range(position.size)
    ]
    columns = (
        "specimen", "test", "hold", length.label("position"), force.label("tension"),
        percent.label("strain at the marks"), percent.label("strain by the method"),
        "method minus marks [points of strain %]",
    )  # fmt: skip
    return make_table(
        "Splice marks: what the tape read, and what the method makes of it.", columns, rows,
        synthetic=view.is_synthetic, is_tall=len(rows) > 12,
    )  # fmt: skip


def _coefficients(view: TestView, place: int) -> Iterator[tuple[str, Cell]]:
    length, force = shown("length", view.units), shown("tension", view.units)
    yield "marks from", words(_text(view, "strain_marks_from", place))
    for name in COEFFICIENTS.values():
        value = _value(view, name, place)
        if np.isfinite(value):
            si_unit = QUANTITIES[name].unit
            # c of c F**n goes with a force in newton; no other unit would keep its meaning
            unit = length if si_unit == "m" else Shown(si_unit, 1.0)
            half = NORMAL * _value(view, f"{name}_standard_uncertainty", place)
            yield unit.label(QUANTITIES[name].long_name), measured(value, half, unit)
    for name, unit, places in (("position", length, 2), ("tension", force, 0)):
        low, high = (_value(view, f"strain_{name}_{end}", place) for end in ("low", "high"))
        if np.isfinite(low) and np.isfinite(high):
            yield unit.label(f"{name} at the marks"), span(low, high, unit, places=places)


def _signed(residual: float) -> str:
    return f"{round(100 * residual, 2) + 0.0:+.2f}" if np.isfinite(residual) else NOT_GIVEN


def _value(view: TestView, name: str, place: int) -> float:
    values = view.array(name)
    return float("nan") if values is None else float(values[place])


def _text(view: TestView, name: str, place: int) -> str:
    values = view.texts(name)
    return values[place] if values else ""

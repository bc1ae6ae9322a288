"""Tables of the programme of a rope: its properties, its levels, its holds, its bedding-in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.line.propertyproduct import PROPERTY_NAMES
from reduction.report.htmltable import (
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    number_text,
    span,
    words,
)
from reduction.report.ropeview import RopeView, expanded_property, shared_by_properties
from reduction.report.sources import in_order, source_words
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import (
    expanded_of,
    plus_minus,
    plus_minus_of_tests,
)
from reduction.report.view import TestView

__all__ = [
    "answer_of_ropes",
    "bedding_table",
    "creep_table",
    "level_table",
    "pair_table",
    "property_table",
    "told_of",
]

_SCATTER = "scatter between cycles, noise, regression"
_NOT_IN_IT = "load-cell calibration, scale of position or strain, lag between the channels"
# what is shown of a step: variable, unit of the page or None for a share, words
_Column = tuple[str, Shown | None, str]


def answer_of_ropes(views: Sequence[RopeView]) -> Table | None:
    """Return the properties of each rope in a row; least to greatest where it has several."""
    if not views:
        return None
    force, percent = shown("tension", views[0].units), shown("strain", views[0].units)
    units = [force if name.endswith("stiffness") else percent for name in PROPERTY_NAMES]
    rows = [
        [
            words(view.specimen),
            *(_least_to_greatest(view, *one) for one in zip(PROPERTY_NAMES, units, strict=True)),
        ]
        for view in views
    ]
    return make_table(
        "Change-in-length properties of the ropes, least to greatest where the programme gives"
        " several; between which tensions, and why one is missing, is in the section of the rope.",
        ("rope", *(unit.label(name) for name, unit in zip(PROPERTY_NAMES, units, strict=True))),
        rows, synthetic=any(view.is_synthetic for view in views), is_tall=len(rows) > 16,
        remarks=[_about(rows, views)],
    )  # fmt: skip


def _about(rows: Sequence[Sequence[Cell]], views: Sequence[RopeView]) -> str:
    """Say what ± holds: and of the instruments what is stated of them."""
    shared = in_order({one for view in views for one in shared_by_properties(view)})
    if not shared:
        return plus_minus(factors_of(rows), left_out=_NOT_IN_IT)
    told = ", ".join(source_words(one) for one in shared)
    held = f"{_SCATTER}; and what all samples share: {told}"
    return plus_minus(factors_of(rows), held, left_out="")


def _least_to_greatest(view: RopeView, name: str, unit: Shown) -> Cell:
    kind = "property_stiffness" if name.endswith("stiffness") else "property_strain"
    rows = view.rows_of(name)
    values = view.array(kind)[rows]
    if len(rows) > 1:
        ends = [number_text(unit.factor * end) for end in (values.min(), values.max())]
        return Cell(" to ".join(ends), is_number=True)
    if not rows:
        return number(float("nan"))
    spread = expanded_property(view, kind)
    return measured(values[0], spread.half[rows[0]], unit, factor=spread.factor[rows[0]])


def told_of(view: RopeView, *, known: bool) -> list[str]:
    """Return what there is to say of the properties with a number, or why the others have none."""
    has_number = {row for name in PROPERTY_NAMES for row in view.rows_of(name)}
    tests = view.texts("property_test")
    return [
        f"{', '.join(filter(None, (view.names[row], tests[row])))}: {text}"
        for row, text in enumerate(view.texts("property_remark"))
        if text and (row in has_number) is known
    ]


def property_table(view: RopeView) -> Table | None:
    """Return the six properties; one without a number has its reason."""
    force, percent = shown("tension", view.units), shown("strain", view.units)
    seconds = shown("time", view.units)
    low, high = view.array("property_low_tension"), view.array("property_high_tension")
    at = view.array("property_reference_time")
    tests = view.texts("property_test")

    def cell(name: str, row: int, unit: Shown | None) -> Cell:
        spread = expanded_property(view, name)
        return measured(view.array(name)[row], spread.half[row], unit, factor=spread.factor[row])

    rows = [
        [
            words(name),
            number(low[row], force) if low[row] == high[row]
            else span(low[row], high[row], force, places=0),
            number(at[row], seconds),
            cell("property_stiffness", row, force),
            cell("property_stiffness_over_strength", row, None),
            cell("property_strain", row, percent),
            words(tests[row]),
        ]
        for row, name in enumerate(view.names)
    ]  # fmt: skip
    columns = (
        "property", force.label("tensions"), seconds.label("time after loading"),
        force.label("stiffness"), "stiffness over strength [1]", percent.label("strain"),
        "test or step",
    )  # fmt: skip
    return make_table(
        f"Change-in-length properties of {view.specimen}.", columns, rows,
        synthetic=view.is_synthetic, is_tall=len(rows) > 16,
        remarks=[
            *told_of(view, known=True),
            "Original stiffness: chord of the first rise of a new rope. Static: secant between two"
            " held tensions. Dynamic: last cycles of a level. Construction strain: what bedding-in"
            " left at equal tension. Polymer strain: creep from the reference time to the end of"
            " the hold. Working strain: rise of tension over static stiffness, after bedding-in.",
            _about(rows, [view]),
        ],
    )  # fmt: skip


def bedding_table(view: RopeView) -> Table | None:
    """Return what bedding-in did."""
    force, percent = shown("tension", view.units), shown("strain", view.units)
    return _table(
        view, "specimen", "bedding_permanent_strain", "Bedding-in.",
        (
            ("bedding_cycles", None, "cycles [1]"),
            ("bedding_first_stiffness", force, force.label("stiffness of the first cycle")),
            ("bedding_last_stiffness", force, force.label("stiffness of the last cycle")),
            ("bedding_stiffening", None, "last over first [1]"),
            ("bedding_permanent_strain", percent, percent.label("permanent strain")),
        ),
    )  # fmt: skip


def level_table(view: RopeView) -> Table | None:
    """Return the levels of dynamic stiffness."""
    force, hertz = shown("tension", view.units), shown("frequency", view.units)
    return _table(
        view, "specimen", "dynamic_stiffness", "Levels of dynamic stiffness, last cycles of each.",
        (
            ("dynamic_mean_tension", force, force.label("mean tension")),
            ("dynamic_tension_amplitude", force, force.label("tension amplitude")),
            ("dynamic_frequency", hertz, hertz.label("frequency")),
            ("dynamic_cycles", None, "cycles [1]"),
            ("dynamic_stiffness", force, force.label("dynamic stiffness")),
            ("dynamic_stiffness_over_strength", None, "over strength [1]"),
            ("dynamic_stiffness_drift", force, force.label("change a cycle")),
        ),
    )  # fmt: skip


def pair_table(view: RopeView) -> Table | None:
    """Return the pairs of holds, with the reason of one without a stiffness."""
    force, seconds = shown("tension", view.units), shown("time", view.units)
    return _table(
        view, "held_pair", "static_stiffness", "Pairs of held tensions.",
        (
            ("held_pair_low_tension", force, force.label("lower tension")),
            ("held_pair_high_tension", force, force.label("higher tension")),
            ("static_reference_time", seconds, seconds.label("reference time")),
            ("static_stiffness", force, force.label("static stiffness")),
            ("static_stiffness_over_strength", None, "over strength [1]"),
            ("static_stiffness_per_decade", force, force.label("change a decade of time")),
        ),
        reason="static_refusal",
    )  # fmt: skip


def creep_table(view: RopeView) -> Table | None:
    """Return the holds at a kept tension, with the reason of one without a rate."""
    force, seconds = shown("tension", view.units), shown("time", view.units)
    percent = shown("strain", view.units)
    return _table(
        view, "hold", "creep_tension_over_strength", "Creep at held tensions.",
        (
            ("hold_final_tension", force, force.label("tension")),
            ("creep_tension_over_strength", None, "over strength [1]"),
            ("hold_duration", seconds, seconds.label("lasts")),
            ("creep_rate_per_decade", percent, percent.label("strain a decade of time")),
            (
                "creep_compliance_per_decade", percent,
                percent.label("strain a decade, over tension as a share of strength"),
            ),
        ),
        reason="hold_refusal",
    )  # fmt: skip


def _table(
    view: RopeView,
    along: str,
    needed: str,
    caption: str,
    columns: Sequence[_Column],
    *,
    reason: str = "",
) -> Table | None:
    """Return one row a step and place of this rope; a column that no row fills is left out."""
    entries = list(view.entries(along, needed))
    filled = [one for one in columns if any(_is_known(*entry, one[0]) for entry in entries)]
    if not filled:
        return None
    rows = [
        [words(test.id), *(_cell(test, place, name, unit) for name, unit, _ in filled)]
        for test, place in entries
    ]
    labels = ["test or step", *(label for *_, label in filled)]
    why = [test.texts(reason)[place] if reason in test.data else "" for test, place in entries]
    if any(why):
        labels.append("why there is no number")
        rows = [[*row, words(one)] for row, one in zip(rows, why, strict=True)]
    return make_table(
        caption, labels, rows, synthetic=view.is_synthetic, is_tall=len(rows) > 16,
        remarks=[
            plus_minus_of_tests(
                factors_of(rows), [test for test, _ in entries], [name for name, *_ in filled]
            )
        ],
    )  # fmt: skip


def _is_known(test: TestView, place: int, name: str) -> bool:
    return name in test.data and bool(np.isfinite(test.data[name].values[place]))


def _cell(test: TestView, place: int, name: str, unit: Shown | None) -> Cell:
    if name not in test.data:
        return number(float("nan"))
    if test.data[name].dtype.kind == "i":
        return count(float(test.data[name].values[place]))
    values = np.asarray(test.data[name].values, dtype=np.float64)
    spread = expanded_of(test, name, values)
    return measured(
        float(values[place]), float(spread.half[place]), unit, factor=float(spread.factor[place])
    )

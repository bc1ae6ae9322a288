"""Tables of the programme of a rope: its properties, its levels, its holds, its bedding-in."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.line.propertyproduct import PROPERTY_NAMES
from reduction.report.htmltable import Cell, Table, measured, number, number_text, span
from reduction.report.ropeview import RopeView, expanded_property, shared_by_properties
from reduction.report.sheet import Calculated, Sheet, Unit
from reduction.report.sources import in_order, source_words
from reduction.report.style import PERCENT, Shown, shown
from reduction.report.uncertainty import plus_minus

_SCATTER = "scatter between cycles, noise, regression"
_NOT_IN_IT = "load-cell calibration, scale of position or strain, lag between the channels"
_COUNTED = ("bedding_cycles", "dynamic_cycles")


def answer_of_ropes(views: Sequence[RopeView]) -> Table | None:
    """Return the properties of each rope in a row; least to greatest where it has several."""
    if not views:
        return None
    units = views[0].units
    sheet = Sheet(Calculated(units, any(view.is_synthetic for view in views)))
    sheet.texts("rope", [view.specimen for view in views])
    for name in PROPERTY_NAMES:
        unit = shown("tension" if name.endswith("stiffness") else "strain", units)
        sheet.cells(unit.label(name), [_least_to_greatest(view, name, unit) for view in views])
    return sheet.table(
        "Change-in-length properties of the ropes, least to greatest where the programme gives"
        " several; between which tensions, and why one is missing, is in the section of the rope.",
        tall=16, remarks=[_about(sheet, views)],
    )  # fmt: skip


def _about(sheet: Sheet, views: Sequence[RopeView]) -> str:
    """Say what ± holds: and of the instruments what is stated of them."""
    shared = in_order({one for view in views for one in shared_by_properties(view)})
    if not shared:
        return plus_minus(sheet.factors, left_out=_NOT_IN_IT)
    told = ", ".join(source_words(one) for one in shared)
    return plus_minus(sheet.factors, f"{_SCATTER}; and what all samples share: {told}", left_out="")


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
    force = shown("tension", view.units)
    ends = zip(view.array("property_low_tension"), view.array("property_high_tension"), strict=True)
    sheet = Sheet(view, ("property",)).texts("property", "property_name").cells(
        force.label("tensions"),
        [
            number(low, force) if low == high else span(low, high, force, places=0)
            for low, high in ends
        ],
    )  # fmt: skip
    sheet.numbers("time after loading", "property_reference_time")
    properties: tuple[tuple[str, str, Unit], ...] = (
        ("stiffness", "property_stiffness", None),
        ("stiffness over strength", "property_stiffness_over_strength", None),
        ("strain", "property_strain", PERCENT),
    )
    for heading, name, unit in properties:
        sheet.measured(heading, name, unit, expanded_property(view, name))
    return sheet.texts("test or step", "property_test").table(
        f"Change-in-length properties of {view.specimen}.", tall=16,
        remarks=[
            *told_of(view, known=True),
            "Original stiffness: chord of the first rise of a new rope. Static: secant between two"
            " held tensions. Dynamic: last cycles of a level. Construction strain: what bedding-in"
            " left at equal tension. Polymer strain: creep from the reference time to the end of"
            " the hold. Working strain: rise of tension over static stiffness, after bedding-in.",
            _about(sheet, [view]),
        ],
    )  # fmt: skip


def bedding_table(view: RopeView) -> Table | None:
    """Return what bedding-in did."""
    return _of_steps(
        view, "specimen", "bedding_permanent_strain", "Bedding-in.",
        ("cycles [1]", "bedding_cycles"),
        ("stiffness of the first cycle", "bedding_first_stiffness"),
        ("stiffness of the last cycle", "bedding_last_stiffness"),
        ("last over first", "bedding_stiffening"),
        ("permanent strain", "bedding_permanent_strain", PERCENT),
    )  # fmt: skip


def level_table(view: RopeView) -> Table | None:
    """Return the levels of dynamic stiffness."""
    return _of_steps(
        view, "specimen", "dynamic_stiffness", "Levels of dynamic stiffness, last cycles of each.",
        ("mean tension", "dynamic_mean_tension"),
        ("tension amplitude", "dynamic_tension_amplitude"),
        ("frequency", "dynamic_frequency"),
        ("cycles [1]", "dynamic_cycles"),
        ("dynamic stiffness", "dynamic_stiffness"),
        ("over strength", "dynamic_stiffness_over_strength"),
        ("change a cycle", "dynamic_stiffness_drift"),
    )  # fmt: skip


def pair_table(view: RopeView) -> Table | None:
    """Return the pairs of holds, with the reason of one without a stiffness."""
    return _of_steps(
        view, "held_pair", "static_stiffness", "Pairs of held tensions.",
        ("lower tension", "held_pair_low_tension"),
        ("higher tension", "held_pair_high_tension"),
        ("reference time", "static_reference_time"),
        ("static stiffness", "static_stiffness"),
        ("over strength", "static_stiffness_over_strength"),
        ("change a decade of time", "static_stiffness_per_decade"),
        reason="static_refusal",
    )  # fmt: skip


def creep_table(view: RopeView) -> Table | None:
    """Return the holds at a kept tension, with the reason of one without a rate."""
    return _of_steps(
        view, "hold", "creep_tension_over_strength", "Creep at held tensions.",
        ("tension", "hold_final_tension"),
        ("over strength", "creep_tension_over_strength"),
        ("lasts", "hold_duration"),
        ("strain a decade of time", "creep_rate_per_decade", PERCENT),
        ("strain a decade, over tension as a share of strength", "creep_compliance_per_decade",
         PERCENT),
        reason="hold_refusal",
    )  # fmt: skip


def _of_steps(
    view: RopeView,
    along: str,
    needed: str,
    caption: str,
    *columns: tuple[str, str] | tuple[str, str, Unit],
    reason: str = "",
) -> Table | None:
    """Return one row a step and place of this rope; a column that no row fills is left out."""
    sheets = []
    for test in view.tests:
        sheet = Sheet(test, (along,))
        owner = sheet.of(along if along == "specimen" else f"{along}_specimen", "")
        sheet.keep(owner.astype(str) == view.specimen)
        if not sheet.n_rows or needed not in test.data:
            continue
        sheet.texts("test or step", [test.id] * sheet.n_rows)
        for one in columns:
            sheet.counts(*one[:2]) if one[1] in _COUNTED else sheet.all_of(one)
        sheets.append(sheet.texts("why there is no number", reason))
    found = Sheet.stack(sheets, view)
    if not found.is_known:
        return None
    return found.table(caption, optional=found.headings, tall=16, remarks=[found.about()])

"""Tables of predicted hoses: events, construction, idle layers, the cord, the curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.report.hoseview import DEGREES, SOURCE_WORDS, HoseView, OneEvent
from reduction.report.htmltable import (
    Cell,
    Table,
    make_table,
    measured,
    number,
    span,
    words,
)
from reduction.report.style import Shown, shown
from reduction.report.uncertainty import NORMAL, factor_words

__all__ = [
    "answer_of_hoses", "cord_table", "curve_table", "design_table", "event_table", "layer_table",
    "plus_minus_of_hoses",
]  # fmt: skip

_ROWS = 24
"""Of the curve on the page, about; the archive has them all."""
_ONE = Shown("1", 1.0)
_TOGETHER = (
    "An event moves along the curve with what is uncertain: its tension is known better than the"
    " tension at a held strain, which the band of the figure shows."
)


def plus_minus_of_hoses(views: Sequence[HoseView]) -> list[str]:
    """Return the sentence that says what ± is, or that nothing is known."""
    sources = dict.fromkeys(_named(name) for view in views for name in view.sources)
    if not sources:
        return ["No number of the construction has a stated uncertainty, so none is given."]
    without = [view.name for view in views if not view.sources]
    said = (
        f"±: expanded uncertainty, 95 % ({factor_words([NORMAL])}), carried through from what is"
        f" stated of the construction: {', '.join(sources)}. Not in it: the model itself (straight"
        " hose, constant volume, static cord, law of the rubber)."
    )
    return [said, *([f"Nothing is stated of {', '.join(without)}."] if without else [])]


def answer_of_hoses(views: Sequence[HoseView]) -> Table | None:
    """Return where the cords pick up, work and break: a line a hose."""
    if not views:
        return None
    strain, force = shown("strain", views[0].units), shown("tension", views[0].units)
    rows = []
    for view in views:
        pick_up, working, at_break = (
            view.events[name] for name in ("pick_up", "working", "cord_break")
        )
        rows.append(
            [
                words(view.name),
                _own(view, "wrap_angle", DEGREES),
                _at(pick_up, "strain", strain),
                _at(working, "strain", strain),
                _at(working, "tension", force),
                _at(at_break, "strain", strain),
                _at(at_break, "tension", force),
            ]
        )
    return make_table(
        "Predicted hoses, from construction alone: strain where the cords pick up, strain and"
        " tension at the working load and where the cords break.",
        (
            "hose", DEGREES.label("wrap angle"), strain.label("pick-up strain"),
            strain.label("strain at working load"), force.label("safe working load"),
            strain.label("strain where cords break"), force.label("tension where cords break"),
        ),
        rows, synthetic=any(view.is_synthetic for view in views),
        remarks=plus_minus_of_hoses(views),
    )  # fmt: skip


def event_table(view: HoseView) -> Table:
    """Return what happens to the cords, in the order of stretch."""
    strain, force = shown("strain", view.units), shown("tension", view.units)
    pressure = shown("stress", view.units)
    return make_table(
        f"Events of hose {view.name}, from rest to the break of its cords.",
        (
            "event", strain.label("strain of the hose"), force.label("tension"),
            pressure.label("fill pressure"), force.label("tension of a cord"),
            strain.label("strain of a cord"),
        ),
        [
            [
                words(event.words),
                _at(event, "strain", strain),
                _at(event, "tension", force),
                _at(event, "fill_pressure", pressure),
                number(event.cord_tension, force),
                number(event.cord_strain, strain),
            ]
            for event in view.events.values()
        ],
        synthetic=view.is_synthetic,
        remarks=[
            *plus_minus_of_hoses([view]),
            *([_TOGETHER] if view.sources else []),
        ],
    )  # fmt: skip


def design_table(view: HoseView) -> Table:
    """Return the numbers that the hose is made of, and what follows from them."""
    small, stress = shown("small length", view.units), shown("stress", view.units)
    percent = shown("strain", view.units)
    diameters = view.array("layer_diameter")
    of_layers = view.array_like("layer_diameter_standard_uncertainty", diameters)
    ribbons = view.array("ribbon_width")
    is_same = diameters[0] == diameters[-1]
    names = ("of both cord layers",) if is_same else ("of the inner layer", "of the outer layer")
    spacing = view.array("cord_spacing") / view.scalar("cord_diameter")
    bore = view.array("current_inner_diameter")
    least_bore = view.scalar("minimum_inner_diameter")
    given = [
        ("wrap angle from the axis", DEGREES, _own(view, "wrap_angle", DEGREES)),
        ("bore at rest", small, _own(view, "inner_diameter", small)),
        *(
            (f"diameter {name}", small, measured(diameters[k], NORMAL * of_layers[k], small))
            for k, name in enumerate(names)
        ),
        ("outer diameter", small, _own(view, "outer_diameter", small)),
        ("cords a length of fabric", view.per_length,
         _own(view, "cords_per_length", view.per_length)),
        ("diameter of a cord", small, _own(view, "cord_diameter", small)),
        ("Young's modulus of the rubber", stress, _own(view, "rubber_modulus", stress)),
        ("factor on the load of the cord curve", _ONE, _own(view, "cord_load_scale", _ONE)),
        ("factor on the strain of the cord curve", _ONE, _own(view, "cord_strain_scale", _ONE)),
        ("dead length, of the whole", percent, _own(view, "dead_length_share", percent)),
        ("working share of the break load of a cord", percent,
         _own(view, "working_share", percent)),
        *([("least bore that is allowed", small, number(least_bore, small))] if least_bore else []),
    ]  # fmt: skip
    found = [
        *(
            (f"width of the ribbon {name}", small, number(ribbons[k], small))
            for k, name in enumerate(names)
        ),
        ("cords in the section, both layers", _ONE,
         number(view.scalar("number_of_cords"), digits=4)),
        ("least spacing of cords over their diameter", _ONE, number(float(np.nanmin(spacing)))),
        ("bore at the greatest strain", small, number(float(np.nanmin(bore)), small)),
    ]  # fmt: skip
    law = view.text("rubber_law")
    return make_table(
        f"Construction of hose {view.name}: what was given, and what follows from it.",
        ("number", "value", "from"),
        [
            [words(unit.label(name)), cell, words(source)]
            for source, listed in (("given", given), ("geometry", found))
            for name, unit, cell in listed
        ],
        synthetic=view.is_synthetic,
        remarks=[
            f"Law of the rubber: {law}. ±: expanded uncertainty, 95 % ({factor_words([NORMAL])}),"
            " of what is stated; a number without ± counts as known.",
            *([] if view.scalar("dead_length_share") else [
                "No dead length is stated: stretch-limited ends count as hose that stretches."
            ]),
        ],
    )  # fmt: skip


def layer_table(view: HoseView) -> Table | None:
    """Return what the layers that carry no load are put to, and at which angle they bear it."""
    names = view.texts("hose_layer_name")
    if not names:
        return None
    percent = shown("strain", view.units)
    columns = {
        name: view.array(f"hose_layer_{name}")
        for name in (
            "wrap_angle", "least_strain", "greatest_strain", "break_strain", "strain_limit",
            "compression_limit", "least_angle", "greatest_angle",
        )
    }  # fmt: skip
    rows = []
    for k, name in enumerate(names):
        one = {key: float(values[k]) for key, values in columns.items()}
        rows.append(
            [
                words(name),
                number(one["wrap_angle"], DEGREES),
                span(one["least_strain"], one["greatest_strain"], percent, places=1),
                number(one["break_strain"], percent, digits=3),
                number(one["strain_limit"], percent, digits=3),
                number(one["compression_limit"], percent, digits=3),
                number(one["least_angle"], DEGREES),
                number(one["greatest_angle"], DEGREES),
                words(_verdict(one)),
            ]
        )
    return make_table(
        f"Layers of hose {view.name} that are to carry no load: their strain up to the working load"
        " and the angles that keep them within their limits.",
        (
            "layer", DEGREES.label("wrap angle"), percent.label("strain up to working load"),
            percent.label("most until cords break"), percent.label("tensile limit"),
            percent.label("compressive limit"), DEGREES.label("least angle"),
            DEGREES.label("greatest angle"), "within its limits",
        ),
        rows, synthetic=view.is_synthetic,
        remarks=["Strains of a layer that follows the hose; it adds nothing to the tension, also"
                 " where it is stretched beyond its limit."],
    )  # fmt: skip


def _verdict(one: dict[str, float]) -> str:
    is_limited = [np.isfinite(one[name]) for name in ("strain_limit", "compression_limit")]
    if not any(is_limited):
        return "no limit stated"
    wrong = [
        text
        for text, is_so in (
            ("stretched", one["greatest_strain"] > one["strain_limit"]),
            ("compressed", -one["least_strain"] > one["compression_limit"]),
        )
        if is_so
    ]
    return f"no: {' and '.join(wrong)} too far" if wrong else "yes"


def cord_table(view: HoseView) -> Table:
    """Return the measured points of one cord."""
    strain, load = view.array("cord_curve_strain"), view.array("cord_curve_load")
    percent, force = shown("strain", view.units), shown("tension", view.units)
    scales = view.scalar("cord_load_scale"), view.scalar("cord_strain_scale")
    remarks = [
        "A static pull; between the points a monotone cubic, beyond the last the cord is broken."
    ]
    if scales != (1.0, 1.0):
        remarks.append(
            f"The prediction has the loads times {scales[0]:g} and the strains times {scales[1]:g}."
        )
    return make_table(
        f"Points of the cord of hose {view.name}; the last is its break.",
        ("point", percent.label("strain"), force.label("load"), percent.label("share of break")),
        [
            [words(f"{k + 1}"), number(strain[k], percent), number(load[k], force),
             number(float(load[k] / load[-1]), percent, digits=3)]
            for k in range(strain.size)
        ],
        synthetic=view.is_synthetic, remarks=remarks,
    )  # fmt: skip


def curve_table(view: HoseView) -> Table:
    """Return some points of the predicted curve, evenly spread, with the last."""
    percent, force = shown("strain", view.units), shown("tension", view.units)
    pressure, small = shown("stress", view.units), shown("small length", view.units)
    strain, tension = view.array("strain"), view.array("tension")
    u_tension = view.array_like("tension_standard_uncertainty", strain)
    u_pressure = view.array_like("fill_pressure_standard_uncertainty", strain)
    along = {
        name: view.array(name)
        for name in (
            "fill_pressure", "cord_tension", "cord_strain", "cord_share", "rubber_share",
            "current_wrap_angle", "current_inner_diameter",
        )
    }  # fmt: skip
    spacing = view.array("cord_spacing") / view.scalar("cord_diameter")
    step = max(1, -(-(strain.size - 1) // _ROWS))
    kept = [*range(0, strain.size - 1, step), strain.size - 1]
    return make_table(
        f"Predicted curve of hose {view.name}, {len(kept):,} of {strain.size:,} points; the archive"
        " and predictions.csv have them all.",
        (
            percent.label("strain"), force.label("tension"), pressure.label("fill pressure"),
            force.label("cord"), percent.label("cord strain"), percent.label("cords' share"),
            percent.label("rubber's share"), DEGREES.label("wrap angle"),
            "spacing over diameter [1]", small.label("bore"),
        ),
        [
            [
                number(strain[k], percent),
                measured(tension[k], NORMAL * u_tension[k], force),
                measured(along["fill_pressure"][k], NORMAL * u_pressure[k], pressure),
                number(along["cord_tension"][k], force),
                number(along["cord_strain"][k], percent),
                number(along["cord_share"][k], percent),
                number(along["rubber_share"][k], percent),
                number(along["current_wrap_angle"][k], DEGREES),
                number(spacing[k]),
                number(along["current_inner_diameter"][k], small),
            ]
            for k in kept
        ],
        synthetic=view.is_synthetic, is_tall=True, is_compact=True,
        remarks=plus_minus_of_hoses([view]),
    )  # fmt: skip


def _named(source: str) -> str:
    return SOURCE_WORDS.get(source, source.replace("_", " "))


def _own(view: HoseView, name: str, unit: Shown) -> Cell:
    """A number of the design with its uncertainty, where one is stated."""
    return measured(view.scalar(name), NORMAL * view.scalar(f"{name}_standard_uncertainty"), unit)


def _at(event: OneEvent, name: str, unit: Shown) -> Cell:
    return measured(
        getattr(event, name), NORMAL * getattr(event, f"{name}_standard_uncertainty"), unit
    )

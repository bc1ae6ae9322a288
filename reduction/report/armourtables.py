"""Tables of an armour: wires by theory, layers, the cable, where each theory holds."""

from __future__ import annotations

import numpy as np

from reduction.pipeline.armour import PredictedArmour
from reduction.report.figures.armour import THEORY_WORDS, moment_unit, of_layers
from reduction.report.hoseview import DEGREES
from reduction.report.htmltable import Cell, Table, count, make_table, number, span, words
from reduction.report.style import Shown, shown, with_prefix
from reduction.units import UnitSystem

__all__ = ["cable_table", "design_table", "layers_table", "use_table", "wires_table"]

_PERCENT = Shown("%", 100.0)


def wires_table(found: PredictedArmour, units: UnitSystem) -> Table:
    """Return forces, moments and stresses of one wire of each layer by each theory."""
    force, moment, stress = shown("tension", units), moment_unit(units), shown("stress", units)
    columns = {
        "axial_force": force, "shear_force": force, "bending_moment": moment,
        "torsion_moment": moment, "axial_stress": stress, "bending_stress": stress,
        "torsion_stress": stress,
    }  # fmt: skip
    rows = [
        [
            words(f"{layer}, {THEORY_WORDS[theory]}"),
            *(
                number(float(getattr(response, name)[place, 0]), unit)
                for name, unit in columns.items()
            ),
        ]
        for place, layer in enumerate(found.layer_names)
        for theory, response in found.responses.items()
    ]
    return make_table(
        f"One wire of each layer by each theory, at {100 * float(found.strain[0]):g} % of strain of"
        " the cable.",
        ("layer, theory", *(unit.label(name.replace("_", " ")) for name, unit in columns.items())),
        rows, synthetic=False, is_compact=True,
        remarks=[
            "Exact: the helix as it is, with the report's moments; small and intermediate angles"
            " simplify it. With an energy: the rod whose tension is the slope of what it stores;"
            " layers and cable go by it. Large angles: a spring without a core, another body.",
            "No uncertainty is given: none is stated of the armour. The thinning of the wires and"
            " the give of the core are in none of them.",
        ],
    )  # fmt: skip


def layers_table(found: PredictedArmour, units: UnitSystem) -> Table:
    """Return what each layer carries and presses, and whether its wires find room."""
    force, moment, stress = shown("tension", units), moment_unit(units), shown("stress", units)
    small, together = shown("small length", units), found.together
    rows = []
    for place, name in enumerate(found.layer_names):
        limit = float(found.layers.yield_stress[place])
        is_yielding = "yes" if together.is_yielding[place, 0] else "no"
        rows.append(
            [
                words(name),
                number(float(together.layer_tension[place, 0]), force),
                number(float(together.layer_torque[place, 0]), moment),
                number(float(together.layer_pressure[place, 0]), stress),
                number(float(together.core_pressure[place, 0]), stress),
                number(float(together.wire_stress[place, 0]), stress),
                number(limit, stress),
                words(is_yielding if np.isfinite(limit) else ""),
                number(float(found.fill[place]), _PERCENT),
                number(float(found.gap[place]), small, digits=3),
                number(float(found.thinning_loss[place]), _PERCENT, digits=2),
            ]
        )
    return make_table(
        f"Layers at {100 * float(found.strain[0]):g} % of strain of the cable, innermost first.",
        (
            "layer", force.label("tension"), moment.label("torque"),
            stress.label("pressure of the layer"), stress.label("pressure with all outside"),
            stress.label("von Mises stress"), stress.label("yield stress"), "yields",
            "circumference filled [%]", small.label("room between wires"),
            "lost by thinning [%]",
        ),
        rows, synthetic=False, is_compact=True,
        remarks=["Torque: above zero of right-handed wires. The cable is held from turning; its"
                 " core is rigid; friction between layers is left out. Lost by thinning: by which"
                 " strain and tension are too high, since a wire that thins sinks to the core."],
    )  # fmt: skip


def cable_table(found: PredictedArmour, units: UnitSystem) -> Table:
    """Return tension, torque, stiffness and first yield of all layers together."""
    force, moment = shown("tension", units), moment_unit(units)
    held, free = found.axial_stiffness
    together = found.together
    rows = [
        _force_row("tension", float(together.tension[0]), force),
        [words(moment.label("torque")), number(float(together.torque[0]), moment)],
        [
            words("torque that is left over, of the layers' sizes [%]"),
            number(float(together.torque_imbalance[0]), _PERCENT, digits=3),
        ],
        _force_row("axial stiffness, held from turning", held, force),
        _force_row("axial stiffness, free to turn", free, force),
    ]
    remarks = ["Stiffness: force per unit strain of the cable, at rest."]
    if found.strength is None:
        remarks.append("First yield is not given: not every layer has a yield stress.")
    else:
        first = found.layer_names[found.strength.governing_layer]
        rows += [
            [words("strain at first yield [%]"), number(found.strength.strain, _PERCENT)],
            _force_row("tension at first yield", found.strength.tension, force),
        ]
        remarks.append(f"Layer {first} yields first.")
    return make_table(
        "The cable.", ("number", "value"), rows, synthetic=False, remarks=remarks
    )  # fmt: skip


def _force_row(name: str, value: float, force: Shown) -> list[Cell]:
    unit = with_prefix(force, value)
    return [words(unit.label(name)), number(value, unit)]


def use_table(found: PredictedArmour) -> Table:
    """Return between which angles each theory is within the tolerance, layer by layer."""
    rows = []
    for layer, use in zip(found.layer_names, found.use, strict=True):
        for i, theory in enumerate(use.theory):
            ends = zip(use.least_angle[i], use.greatest_angle[i], strict=True)
            rows.append(
                [
                    words(f"{layer}, {THEORY_WORDS[theory]}"),
                    *(_angles(float(low), float(high)) for low, high in ends),
                ]
            )
    quantities = found.use[0].quantity
    return make_table(
        f"Winding angles at which each theory is within {100 * found.tolerance:g} % of the exact"
        " rod.",
        (
            "layer, theory",
            *(DEGREES.label(name.replace("_", " ")) for name in quantities),
        ),
        rows, synthetic=False,
        remarks=["From 5 to 85 degrees in steps of a half; of several ranges the longest."],
    )  # fmt: skip


def design_table(found: PredictedArmour, units: UnitSystem) -> Table:
    """Return what was given of each layer."""
    small, stress = shown("small length", units), shown("stress", units)
    columns = {
        "winding_angle": DEGREES, "wire_radius": small, "core_radius": small,
        "elastic_modulus": stress, "poisson_ratio": Shown("1", 1.0),
    }  # fmt: skip
    given = {name: of_layers(found, name) for name in (*columns, "n_wires")}
    rows = [
        [
            words(layer),
            *(number(float(given[name][place]), unit) for name, unit in columns.items()),
            count(float(given["n_wires"][place])),
            words(found.layers.lay[place]),
        ]
        for place, layer in enumerate(found.layer_names)
    ]
    return make_table(
        "Layers as given, the innermost first.",
        (
            "layer", *(unit.label(name.replace("_", " ")) for name, unit in columns.items()),
            "wires [1]", "lay",
        ),
        rows, synthetic=False,
    )  # fmt: skip


def _angles(low: float, high: float) -> Cell:
    if not np.isfinite(low):
        return Cell("nowhere", is_number=True)
    return number(low, DEGREES, digits=3) if low == high else span(low, high, DEGREES, places=1)

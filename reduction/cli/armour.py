"""The command predict armour: forces, stresses and stiffness of helical wires on a core."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

import numpy as np

from reduction.archive.write import write_whole
from reduction.campaign.armourspec import load_armour_case
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import plain, short, table_of
from reduction.errors import DataError, SettingsError
from reduction.pipeline.armour import PredictedArmour, predict_armour_case
from reduction.report.predictionpage import write_armour_page
from reduction.tables.column import Cell, csv_text
from reduction.units import UnitSystem, display_unit

_OF_WIRE = {
    "axial_force": "N", "shear_force": "N", "bending_moment": "N m", "torsion_moment": "N m",
    "axial_stress": "Pa", "bending_stress": "Pa", "torsion_stress": "Pa",
}  # fmt: skip
_MORE = {
    "wire_strain": "1", "angle_change": "rad", "curvature_change": "m-1", "torsion_change": "m-1",
    "tension": "N", "torque": "N m", "contact_line_load": "N m-1",
}  # fmt: skip
_OF_LAYER = {
    "layer_tension": "N", "layer_torque": "N m", "layer_pressure": "Pa", "core_pressure": "Pa",
    "wire_stress": "Pa",
}  # fmt: skip


def predict_cable(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Predict the armour of SPEC.toml and print it; with ``out``, write tables and page."""
    case = load_armour_case(path)
    try:
        found = predict_armour_case(
            case.layers, case.strain, names=case.layer_names, tolerance=case.tolerance
        )
    except (DataError, SettingsError) as error:
        raise type(error)(
            f"{path}: {error.problem}", found=error.found, needed=error.needed, hint=error.hint
        ) from error
    units = cast("UnitSystem", output.units)
    _show(found, output, units)
    if out is not None:
        wires, layers = out / "tables" / "armour_wires.csv", out / "tables" / "armour_layers.csv"
        write_whole(wires, _wires_csv(found))
        write_whole(layers, _layers_csv(found))
        page = write_armour_page(found, out, name=case.name, units=units)
        output.say(f"tables: {wires}, {layers}")
        output.say(f"figures: {page}")
    output.answer(document(found) | {"name": case.name, "out": None if out is None else str(out)})


def _wires_csv(found: PredictedArmour) -> str:
    quantities = _OF_WIRE | _MORE
    rows: list[list[Cell]] = []
    for theory, response in found.responses.items():
        for place, name in enumerate(found.layer_names):
            numbers = [float(getattr(response, one)[place, 0]) for one in quantities]
            rows.append([theory, name, *(None if np.isnan(value) else value for value in numbers)])
    header = ["theory", "layer", *(f"{name} [{unit}]" for name, unit in quantities.items())]
    return csv_text(header, rows)


def _layers_csv(found: PredictedArmour) -> str:
    header = [
        "layer", "fill_factor [1]", "wire_gap [m]", "thinning_loss [1]",
        *(f"{name} [{unit}]" for name, unit in _OF_LAYER.items()),
    ]  # fmt: skip
    return csv_text(
        header,
        (
            [
                name,
                float(found.fill[place]),
                float(found.gap[place]),
                float(found.thinning_loss[place]),
                *(float(getattr(found.together, one)[place, 0]) for one in _OF_LAYER),
            ]
            for place, name in enumerate(found.layer_names)
        ),
    )


def _show(found: PredictedArmour, output: CommandOutput, system: UnitSystem) -> None:
    force, per_newton = display_unit("N", system)
    stress, per_pascal = display_unit("Pa", system)
    if system == "si":
        stress, per_pascal = "MPa", 1e-6
    table = table_of(
        "layer", "theory", f"T [{force}]", f"N' [{force}]", "G' [N m]", "H [N m]",
        f"axial [{stress}]", f"bending [{stress}]", f"torsion [{stress}]", texts=2,
        title=f"One wire at {100 * float(found.strain[0]):g} % strain of the cable",
    )  # fmt: skip
    scales = (per_newton, per_newton, 1.0, 1.0, per_pascal, per_pascal, per_pascal)
    for place, name in enumerate(found.layer_names):
        for theory, response in found.responses.items():
            numbers = (float(getattr(response, one)[place, 0]) for one in _OF_WIRE)
            table.add_row(
                name, theory, *(short(a * b) for a, b in zip(scales, numbers, strict=True))
            )
    output.show(table)
    table = table_of(
        "layer", f"tension [{force}]", "torque [N m]", f"pressure [{stress}]",
        f"von Mises [{stress}]", "filled [%]", "gap [mm]", "thinning [%]",
        title="Layers, theory conjugate",
    )  # fmt: skip
    for place, name in enumerate(found.layer_names):
        together = found.together
        table.add_row(
            name,
            short(per_newton * float(together.layer_tension[place, 0])),
            short(float(together.layer_torque[place, 0])),
            short(per_pascal * float(together.core_pressure[place, 0])),
            short(per_pascal * float(together.wire_stress[place, 0])),
            short(100 * float(found.fill[place]), 4),
            short(1e3 * float(found.gap[place]), 4),
            short(100 * float(found.thinning_loss[place]), 2),
        )
    output.show(table)
    held, free = found.axial_stiffness
    output.say(
        f"cable: tension {short(per_newton * float(found.together.tension[0]))} {force}, torque "
        f"{float(found.together.torque[0]):.4g} N m; axial stiffness {short(per_newton * held)} "
        f"{force} held from turning, {short(per_newton * free)} {force} free to turn"
    )
    if found.strength is not None:
        output.say(
            f"first yield: {found.layer_names[found.strength.governing_layer]} at "
            f"{100 * found.strength.strain:.4g} %, tension of the cable "
            f"{short(per_newton * found.strength.tension)} {force}"
        )
    for sentence in found.use[0].statement:
        output.say(f"  {sentence}")
    for note in found.notes:
        output.say(f"note: {note}")


def document(found: PredictedArmour) -> dict[str, Any]:
    """What ``--json`` says of an armour, in SI: by theory, one number a layer."""
    quantities = _OF_WIRE | _MORE
    theories: dict[str, Any] = {
        theory: {name: plain(getattr(response, name)[:, 0]) for name in quantities}
        for theory, response in found.responses.items()
    }
    errors = {
        theory: {
            quantity: plain(found.errors.error[i, j, :, 0])
            for j, quantity in enumerate(found.errors.quantity)
        }
        for i, theory in enumerate(found.errors.theory)
    }
    held, free = found.axial_stiffness
    return {
        **theories,
        "units": quantities | _OF_LAYER,
        "strain": float(found.strain[0]),
        "layers": [
            {
                "name": name,
                "fill_factor": plain(found.fill[place]),
                "wire_gap": plain(found.gap[place]),
                "thinning_loss": plain(found.thinning_loss[place]),
                **{one: plain(getattr(found.together, one)[place, 0]) for one in _OF_LAYER},
                "holds": list(found.use[place].statement),
            }
            for place, name in enumerate(found.layer_names)
        ],
        "cable": {
            "tension": plain(found.together.tension[0]),
            "torque": plain(found.together.torque[0]),
            "torque_imbalance": plain(found.together.torque_imbalance[0]),
            "axial_stiffness_held": held,
            "axial_stiffness_free": free,
            "first_yield": None
            if found.strength is None
            else {key: plain(value) for key, value in asdict(found.strength).items()},
        },
        "error_against_exact": errors,
        "notes": list(found.notes),
    }

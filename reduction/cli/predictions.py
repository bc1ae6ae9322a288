"""Implements the commands predict and compare."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from reduction.archive.atomic_write import write_text_atomically
from reduction.archive.campaign_products import NamedComparison
from reduction.archive.csv_columns import Cell, csv_text
from reduction.archive.csv_tables import write_tables
from reduction.batch.prediction_product import compare_archive, write_hoses, write_named
from reduction.campaign.hose_spec import load_hose
from reduction.campaign.plan import ComparisonPlan
from reduction.campaign.prediction_specs import load_armour_case, load_wave_case
from reduction.campaign.toml_file import at_place
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain, short, table_of
from reduction.prediction.armour import (
    ARMOUR_QUANTITIES,
    SIMPLER_THEORIES,
    PredictedArmour,
    predict_armour_case,
)
from reduction.prediction.comparison_error import HoseCalibration, PressureComparison, verdict_words
from reduction.prediction.hose_design import DesignedHose, design_hoses
from reduction.prediction.hose_prediction import (
    HOSE_SERIES,
    HoseTarget,
    PredictedHose,
    doubts_of_design,
    predict_from_plan,
)
from reduction.prediction.hose_product import HoseEvent
from reduction.prediction.wave_load import PredictedWaveLoad, predict_wave_load
from reduction.quantities.names import quantity
from reduction.quantities.units import UnitSystem, display_unit
from reduction.readers.raw_log import hash_source
from reduction.record.errors import SettingsError
from reduction.record.notes import Note
from reduction.report.campaign_page import write_report
from reduction.report.single_pages import write_armour_page, write_wave_page
from reduction.report.text_style import shown


def _show_designs(
    designs: Sequence[DesignedHose], target: HoseTarget, output: CommandOutput
) -> None:
    """Print each design that reaches a target, or the reason why there is none."""
    force, per_newton = output.unit("N")
    small, per_metre = ("in", 1 / 0.0254) if output.system == "us" else ("mm", 1e3)
    load = "" if target.tension is None else f" and {per_newton * target.tension:.5g} {force}"
    table = table_of(
        "change", "angle [deg]", f"cords [1/{small}]", f"layers [{small}]", f"bore [{small}]",
        f"skin [{small}]", f"ribbon [{small}]", "strain [%]", f"tension [{force}]",
        f"break [{force}]", "break over working",
        title=f"Hoses for {100 * target.strain:.4g} %{load} at the working load",
    )  # fmt: skip
    for one in designs:
        if one.design is None or one.events is None:
            continue
        hose, events = one.design, one.events
        layers = " ".join(short(per_metre * float(value), 4) for value in hose.layer_diameter)
        ribbons = " ".join(dict.fromkeys(short(per_metre * value, 4) for value in one.ribbon_width))
        working, at_break = float(events.working.tension), float(events.cord_break.tension)
        table.add_row(
            one.varied,
            short(float(np.degrees(hose.wrap_angle)), 4),
            short(float(hose.cords_per_length) / per_metre, 4),
            " ".join(dict.fromkeys(layers.split())),
            short(per_metre * float(hose.inner_diameter), 4),
            short(per_metre * float(hose.outer_diameter), 4),
            ribbons,
            short(100 * float(events.working.strain), 4),
            short(per_newton * working),
            short(per_newton * at_break),
            short(at_break / working, 3),
        )
    if table.row_count:
        output.show(table)
    for one in designs:
        if one.refusal:
            output.say(f"no hose by {one.varied}: {one.refusal}")


def _designed(one: DesignedHose) -> dict[str, Any]:
    """Output of ``--json`` for one design that reaches a target, in SI."""
    answer: dict[str, Any] = {"varied": one.varied, "refusal": one.refusal or None}
    if one.design is None or one.events is None:
        return answer
    numbers = (
        "wrap_angle", "layer_diameter", "inner_diameter", "outer_diameter", "cords_per_length",
    )  # fmt: skip
    events = {"pick_up": one.events.pick_up, "working": one.events.working,
              "break": one.events.cord_break}  # fmt: skip
    return answer | {
        **{name: plain(getattr(one.design, name)) for name in numbers},
        "ribbon_width": list(one.ribbon_width),
        "events": {
            name: {"strain": plain(event.strain), "tension": plain(event.tension)}
            for name, event in events.items()
        },
    }


_SHOWN = 24

_IN_TABLE = (
    "strain", "tension", "fill_pressure", "cord_tension", "cord_strain", "cord_share",
    "rubber_share",
)  # fmt: skip

_EVENTS = {
    "deepest_slack": "cords slackest", "pick_up": "cords pick up", "working": "working load",
    "break": "cords break",
}  # fmt: skip


def predict_hose(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Predict the hose of SPEC.toml and print it; if ``out``, write archive, tables and page."""
    plan, file = load_hose(path)
    target = None if file.target is None else HoseTarget(**file.target.model_dump())
    hose = predict_from_plan(plan)
    designs = () if target is None else design_hoses(plan, target)
    _show_hose(hose, output)
    if target is not None:
        _show_designs(designs, target, output)
        if all(one.refusal for one in designs):
            output.error(f"{path}: target: no hose of this design reaches it")
            output.raise_status(SettingsError.exit_status)
    if out is not None:
        write_hoses(
            [hose],
            out / "predictions.nc",
            campaign_id=plan.name,
            attributes={"title": f"Prediction of hose {plan.name}"},
            source=hash_source(path, path.name),
            command=f"reduction predict hose {path.name}",
        )
        archive = out / "predictions.nc"
        tables = write_tables([], out / "tables", predictions=archive)
        _say_written(archive, tables, output)
    output.answer(
        _hose_document(hose)
        | {"designs": [_designed(one) for one in designs]}
        | {"out": None if out is None else str(out)}
    )


def _say_written(archive: Path, tables: Sequence[Path], output: CommandOutput) -> None:
    """Write the page of an archive beside it, and say what is there."""
    out = archive.parent
    page = write_report(out, out, units=output.system)
    output.say(f"archive: {archive}")
    output.say(f"tables: {len(tables)} in {out / 'tables'}")
    output.say(f"figures: {page}")


def _events(hose: PredictedHose) -> dict[str, HoseEvent]:
    events = hose.events
    return {
        "deepest_slack": events.deepest_slack,
        "pick_up": events.pick_up,
        "working": events.working,
        "break": events.cord_break,
    }


def _by_kind(notes: Iterable[Note]) -> tuple[list[str], list[str]]:
    """Warnings, and the other notes, as sentences."""
    kinds: tuple[list[str], list[str]] = ([], [])
    for one in notes:
        kinds[one.severity != "warning"].append(str(one))
    return kinds


def _show_hose(hose: PredictedHose, output: CommandOutput) -> None:
    force, per_newton = output.unit("N")
    pressure, per_pascal = output.unit("Pa")
    small = shown("small length", output.system)
    warnings, notes = _by_kind(hose.notes)
    output.say_each("warning", warnings)
    output.say(
        f"hose {hose.plan.name}: {np.degrees(float(hose.plan.design.wrap_angle)):.4g} degrees from"
        f" the axis, {hose.number_of_cords:.1f} cords, ribbon"
        f" {' and '.join(short(small.factor * width, 4) for width in hose.ribbon_width)}"
        f" {small.unit} wide"
    )
    table = table_of(
        "event", "strain [%]", "u [%]", f"tension [{force}]", f"u [{force}]",
        f"fill pressure [{pressure}]", f"cord [{force}]", "cord strain [%]",
    )  # fmt: skip
    for name, event in _events(hose).items():
        spread = _spread(hose, name)
        table.add_row(
            _EVENTS[name],
            short(100 * float(event.strain)),
            short(100 * spread["strain"], 2),
            short(per_newton * float(event.tension)),
            short(per_newton * spread["tension"], 2),
            short(per_pascal * float(event.fill_pressure)),
            short(per_newton * float(event.cord_tension), 4),
            short(100 * float(event.cord_strain), 4),
        )
    output.show(table)
    moment, per_moment = output.unit("N m")
    output.say(
        f"torque at the working load, held from turning: {per_moment * hose.working_torque:.3g} "
        f"{moment}; none with the outer layer at {np.degrees(hose.balanced_wrap_angle):.2f} degrees"
    )
    prediction = hose.prediction
    table = table_of(
        "strain [%]", f"tension [{force}]", f"fill pressure [{pressure}]", f"cord [{force}]",
        "cord strain [%]", "cords' share [%]", "rubber's share [%]", texts=0,
    )  # fmt: skip
    step = max(1, -(-(prediction.strain.size - 1) // _SHOWN))
    scales = (100.0, per_newton, per_pascal, per_newton, 100.0, 100.0, 100.0)
    for place in [*range(0, prediction.strain.size - 1, step), prediction.strain.size - 1]:
        numbers = (float(getattr(prediction, name)[place]) for name in _IN_TABLE)
        table.add_row(*(short(scale * value) for scale, value in zip(scales, numbers, strict=True)))
    output.show(table)
    for layer in hose.layers:
        needed = "" if np.isnan(layer.least_angle) else (
            f"; {np.degrees(layer.least_angle):.1f} degrees or more keep it within its limit"
        )  # fmt: skip
        output.say(
            f"layer {layer.layer.name} at {np.degrees(layer.layer.wrap_angle):.4g} degrees: "
            f"{100 * layer.least_strain:.1f} to {100 * layer.greatest_strain:.1f} % up to the "
            f"working load{needed}"
        )
    output.say_each("note", notes)


def _spread(hose: PredictedHose, event: str) -> dict[str, float]:
    """Standard uncertainty of strain and tension at an event; NaN if unknown."""
    found = getattr(hose.uncertainty, "cord_break" if event == "break" else event, None)
    known = found is not None and bool(hose.uncertainty.source)
    return {
        name: float(getattr(found, f"{name}_standard_uncertainty")) if known else float("nan")
        for name in ("strain", "tension")
    }


def _hose_document(hose: PredictedHose) -> dict[str, Any]:
    """Output of ``--json`` for a hose, in SI."""
    prediction, uncertainty = hose.prediction, hose.uncertainty
    known = bool(uncertainty.source)
    return {
        "hose": hose.plan.name,
        **{name: plain(getattr(prediction, name)) for name in HOSE_SERIES},
        "tension_standard_uncertainty": plain(uncertainty.tension_standard_uncertainty)
        if known
        else None,
        "fill_pressure_standard_uncertainty": plain(uncertainty.fill_pressure_standard_uncertainty)
        if known
        else None,
        "uncertainty_sources": {
            name: plain(row)
            for name, row in zip(
                uncertainty.source, uncertainty.tension_contribution, strict=True
            )
        },
        **{
            name: plain(getattr(prediction, name))
            for name in ("is_slack", "is_broken", "is_jammed", "is_bore_too_small")
        },
        "units": {name: quantity(name).unit for name in HOSE_SERIES},
        "events": {
            name: {
                **{
                    what: plain(getattr(event, what))
                    for what in (
                        "strain", "tension", "fill_pressure", "cord_tension", "cord_strain",
                    )
                },
                **{
                    f"{what}_standard_uncertainty": plain(value)
                    for what, value in _spread(hose, name).items()
                },
            }
            for name, event in _events(hose).items()
        },
        "ribbon_width": list(hose.ribbon_width),
        "number_of_cords": hose.number_of_cords,
        "working_torque": hose.working_torque,
        "balanced_wrap_angle": hose.balanced_wrap_angle,
        "layers": [
            {
                "name": one.layer.name,
                **{
                    name: plain(getattr(one.layer, name))
                    for name in ("wrap_angle", "strain_limit", "compression_limit")
                },
                **{
                    name: plain(getattr(one, name))
                    for name in (
                        "least_strain", "greatest_strain", "break_strain", "least_angle",
                        "greatest_angle",
                    )
                },
            }
            for one in hose.layers
        ],
        "notes": list(map(str, hose.notes)),
    }  # fmt: skip


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
    """Predict the armour of SPEC.toml and print it; if ``out``, write tables and page."""
    case = load_armour_case(path)
    with at_place(f"{path}: "):
        found = predict_armour_case(
            case.layers, case.strain, names=case.layer_names, tolerance=case.tolerance
        )
    _show_armour(found, output)
    if out is not None:
        wires, layers = out / "tables" / "armour_wires.csv", out / "tables" / "armour_layers.csv"
        write_text_atomically(wires, _wires_csv(found))
        write_text_atomically(layers, _layers_csv(found))
        page = write_armour_page(found, out, name=case.name, units=output.system)
        output.say(f"tables: {wires}, {layers}")
        output.say(f"figures: {page}")
    output.answer(
        _armour_document(found) | {"name": case.name, "out": None if out is None else str(out)}
    )


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
        "layer", "wire_gap [m]", "thinning_loss [1]",
        *(f"{name} [{unit}]" for name, unit in _OF_LAYER.items()),
    ]  # fmt: skip
    return csv_text(
        header,
        (
            [
                name,
                float(found.gap[place]),
                float(found.thinning_loss[place]),
                *(float(getattr(found.together, one)[place, 0]) for one in _OF_LAYER),
            ]
            for place, name in enumerate(found.layer_names)
        ),
    )


def _show_armour(found: PredictedArmour, output: CommandOutput) -> None:
    force, per_newton = output.unit("N")
    moment, per_moment = output.unit("N m")
    small = shown("small length", output.system)
    stress = shown("stress", output.system)
    warnings, notes = _by_kind(found.notes)
    output.say_each("warning", warnings)
    held, free = found.axial_stiffness
    output.say(
        f"cable: tension {short(per_newton * float(found.together.tension[0]))} {force}, torque "
        f"{per_moment * float(found.together.torque[0]):.4g} {moment}; axial stiffness "
        f"{short(per_newton * held)} {force} held from turning, "
        f"{short(per_newton * free)} {force} free to turn"
    )
    if found.strength is not None:
        output.say(
            f"first yield: {found.layer_names[found.strength.governing_layer]} at "
            f"{100 * found.strength.strain:.4g} %, tension of the cable "
            f"{short(per_newton * found.strength.tension)} {force}"
        )
    table = table_of(
        "layer", "theory", f"T [{force}]", f"N' [{force}]", f"G' [{moment}]", f"H [{moment}]",
        f"axial [{stress.unit}]", f"bending [{stress.unit}]", f"torsion [{stress.unit}]", texts=2,
        title=f"One wire at {100 * float(found.strain[0]):g} % strain of the cable",
    )  # fmt: skip
    scales = (
        per_newton, per_newton, per_moment, per_moment, stress.factor, stress.factor, stress.factor,
    )  # fmt: skip
    for place, name in enumerate(found.layer_names):
        for theory, response in found.responses.items():
            numbers = (float(getattr(response, one)[place, 0]) for one in _OF_WIRE)
            table.add_row(
                name, theory, *(short(a * b) for a, b in zip(scales, numbers, strict=True))
            )
    output.show(table)
    table = table_of(
        "layer", f"tension [{force}]", f"torque [{moment}]", f"pressure [{stress.unit}]",
        f"von Mises [{stress.unit}]", f"gap [{small.unit}]", "thinning [%]",
        title="Layers, theory conjugate",
    )  # fmt: skip
    for place, name in enumerate(found.layer_names):
        together = found.together
        table.add_row(
            name,
            short(per_newton * float(together.layer_tension[place, 0])),
            short(per_moment * float(together.layer_torque[place, 0])),
            short(stress.factor * float(together.core_pressure[place, 0])),
            short(stress.factor * float(together.wire_stress[place, 0])),
            short(small.factor * float(found.gap[place]), 4),
            short(100 * float(found.thinning_loss[place]), 2),
        )
    output.show(table)
    for sentence in found.use[0].statement:
        output.say(f"  {sentence}")
    output.say_each("note", notes)


def _armour_document(found: PredictedArmour) -> dict[str, Any]:
    """Output of ``--json`` for an armour, in SI: by theory, one number per layer."""
    quantities = _OF_WIRE | _MORE
    theories: dict[str, Any] = {
        theory: {name: plain(getattr(response, name)[:, 0]) for name in quantities}
        for theory, response in found.responses.items()
    }
    errors = {
        theory: {
            quantity: plain(found.errors[i, j, :, 0])
            for j, quantity in enumerate(ARMOUR_QUANTITIES)
        }
        for i, theory in enumerate(SIMPLER_THEORIES)
    }
    held, free = found.axial_stiffness
    return {
        **theories,
        "units": quantities | _OF_LAYER,
        "strain": float(found.strain[0]),
        "layers": [
            {
                "name": name,
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
        **dict(zip(("doubts", "notes"), _by_kind(found.notes), strict=True)),
    }


_SERIES = ("horizontal", "vertical", "horizontal_classic", "vertical_classic")

_UNITS = {
    "time": "s", **dict.fromkeys(_SERIES, "N m-1"), "immersion_depth": "m",
    "submerged_section_area": "m2", "elevation": "m", "wave_length": "m", "anchor_force": "N",
}  # fmt: skip


def predict_wave(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Predict the wave load of SPEC.toml and print it; if ``out``, write table and page."""
    name, case = path.stem, load_wave_case(path)
    with at_place(f"{path}: "):
        found = predict_wave_load(**case)
    _show_wave_load(found, output)
    if out is not None:
        table = out / "tables" / "wave_load.csv"
        write_text_atomically(table, _csv(found))
        page = write_wave_page(found, out, name=name, units=output.system)
        output.say(f"table: {table}")
        output.say(f"figures: {page}")
    output.answer(
        _wave_load_document(found) | {"name": name, "out": None if out is None else str(out)}
    )


def _csv(found: PredictedWaveLoad) -> str:
    load = found.load
    return csv_text(
        ["time [s]", *(f"{name} [N m-1]" for name in _SERIES)],
        zip(load.time.tolist(), *(getattr(load, name).tolist() for name in _SERIES), strict=True),
    )


def _show_wave_load(found: PredictedWaveLoad, output: CommandOutput) -> None:
    length, per_metre = output.unit("m")
    force, per_newton = output.unit("N")
    area = shown("area", output.system)
    section, theory = found.load.section, found.theory
    warnings, notes = _by_kind(found.notes)
    output.say_each("warning", warnings)
    table = table_of(
        f"load [{force}/{length}]", "maximum", "at [s]", "minimum", "at [s]", "classic maximum",
        "classic minimum", "reduction from classic [%]",
    )  # fmt: skip
    scale = per_newton / per_metre
    for direction in ("horizontal", "vertical"):
        own = getattr(found.extremes, direction)
        classic = getattr(found.extremes, f"{direction}_classic")
        table.add_row(
            direction,
            short(scale * float(own.maximum)), short(float(own.time_of_maximum), 4),
            short(scale * float(own.minimum)), short(float(own.time_of_minimum), 4),
            short(scale * float(classic.maximum)), short(scale * float(classic.minimum)),
            short(100 * float(getattr(found.difference, f"{direction}_of_maximum")), 4),
        )  # fmt: skip
    output.show(table)
    anchor = found.anchor
    output.say(
        f"anchor force: {short(per_newton * float(anchor.combined))} {force} combined;"
        f" {short(per_newton * float(anchor.separate))} {force} as the sum of wave"
        f" {short(per_newton * float(anchor.wave), 4)}, current"
        f" {per_newton * float(anchor.current):.4g} and wind {per_newton * float(anchor.wind):.4g}"
    )
    depth = float(section.immersion_depth)
    output.say(
        f"immersed {per_metre * depth:.4g} {length} of "
        f"{per_metre * float(section.outer_diameter):.4g} {length} "
        f"({100 * depth / float(section.outer_diameter):.1f} %), "
        f"{area.factor * float(section.submerged_section_area):.4g} {area.unit} of its section"
    )
    output.say(
        f"wave of {per_metre * theory.wave_length:.4g} {length}: d/L {theory.relative_depth:.3g}, "
        f"H/L {theory.steepness:.3g}, {100 * theory.breaking_ratio:.0f} % of the height at which "
        f"it breaks; computed by {found.used} at {per_metre * found.elevation:+.4g} {length}"
    )
    regime = found.regime
    output.say(
        f"Keulegan-Carpenter {float(regime.keulegan_carpenter_number):.3g}, "
        f"Reynolds {short(float(regime.reynolds_number), 3)}, "
        f"drag over inertia {float(regime.drag_to_inertia):.3g}"
    )
    output.say_each("note", notes)


def _wave_load_document(found: PredictedWaveLoad) -> dict[str, Any]:
    """Output of ``--json`` for a wave load, in SI."""
    load, theory = found.load, found.theory
    return {
        "time": plain(load.time),
        **{name: plain(getattr(load, name)) for name in _SERIES},
        "immersion_depth": plain(load.section.immersion_depth),
        "submerged_section_area": plain(load.section.submerged_section_area),
        "elevation": found.elevation,
        "units": _UNITS,
        "wave": {
            "theory_used": found.used,
            **{name: value for name, value in asdict(theory).items() if name != "reasons"},
        },
        "extremes": {
            name: {key: plain(value) for key, value in entries.items()}
            for name, entries in asdict(found.extremes).items()
        },
        "difference_from_classic": {
            f"{direction}_of_{end}": plain(getattr(found.difference, f"{direction}_of_{end}"))
            for direction in ("horizontal", "vertical")
            for end in ("maximum", "minimum")
        },
        "regime": {key: plain(value) for key, value in asdict(found.regime).items()},
        "anchor_force": {key: plain(value) for key, value in asdict(found.anchor).items()},
        **dict(zip(("doubts", "notes"), _by_kind(found.notes), strict=True)),
    }


_EVENT_WORDS = {"pick_up": "cords pick up", "working": "working load", "break": "cords break"}


def compare_test(measured: Path, spec: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Compare a test with the hose of SPEC.toml and print it; if ``out``, write products."""
    hose, file = load_hose(spec)
    plan = ComparisonPlan(
        name=hose.name,
        measured=measured.stem,
        specimen=file.comparison.specimen or "",
        predicted=hose.name,
        loading=file.comparison.loading,
        calibrate=file.comparison.calibrate,
    )
    named = compare_archive(measured, hose, plan)
    notes = (*doubts_of_design(hose), *named.comparison.notes)
    named = replace(named, comparison=replace(named.comparison, notes=notes))
    _show_comparison(named, output)
    if out is not None:
        path = out / "comparisons.nc"
        write_named(
            [named],
            path,
            hoses={hose.name: hose},
            campaign_id=hose.name,
            attributes={"title": f"Test {named.test} against hose {hose.name}"}
            | ({"synthetic": "yes"} if named.is_synthetic else {}),
            sources=[
                hash_source(spec, spec.name),
                hash_source(measured, measured.name),
            ],
            command=f"reduction compare {measured.name} {spec.name}",
        )
        tables = write_tables([], out / "tables", comparisons=path)
        _say_written(path, tables, output)
    output.answer(_comparison_document(named) | {"out": None if out is None else str(out)})


def _show_comparison(named: NamedComparison, output: CommandOutput) -> None:
    found = named.comparison
    force, factor = output.unit("N")
    if named.is_synthetic:
        output.say("SYNTHETIC DATA: no specimen was tested.")
    output.say(
        f"{named.test} of {named.specimen} ({found.measured.loading}) against {named.hose}: "
        f"{verdict_words(found.validation, unit=force, factor=factor)}"
    )
    warnings, notes = _by_kind(named.notes)
    output.say_each("warning", warnings)
    table = table_of(
        f"predicted less measured [{force}]", "bias", "RMS", "RMS [%]", "worst", "at strain [%]",
    )  # fmt: skip
    for curve, one in found.differences.items():
        table.add_row(
            f"{curve}{' (judged)' if curve == found.judged else ''}",
            short(factor * one.bias, 4), short(factor * one.rms, 4),
            short(100 * one.relative_rms, 3), short(factor * one.worst_tension_difference, 4),
            short(100 * one.worst_strain, 4),
        )  # fmt: skip
    output.show(table)
    table = table_of(
        "event", "predicted strain [%]", "of that tension [%]", f"predicted tension [{force}]",
        f"measured there [{force}]", f"difference [{force}]", f"u [{force}]",
    )  # fmt: skip
    for event in found.events:
        table.add_row(
            _EVENT_WORDS.get(event.name, event.name),
            short(100 * event.strain, 4), short(100 * event.measured_strain, 4),
            short(factor * event.tension), short(factor * event.measured_tension),
            short(factor * event.tension_difference, 4),
            short(factor * event.tension_difference_standard_uncertainty, 2),
        )  # fmt: skip
    output.show(table)
    if np.isfinite(found.measured_pick_up_strain):
        spread = found.measured_pick_up_strain_standard_uncertainty
        output.say(
            f"the test itself bends upward at {100 * found.measured_pick_up_strain:.2f} % "
            f"(u {100 * spread:.2g})"
        )
    if found.calibration is not None:
        _show_calibration(found.calibration, output)
    if found.pressure is not None:
        unit, per_pascal = output.unit("Pa")
        output.say(
            "fill pressure: "
            + verdict_words(
                found.pressure.validation, unit=unit, factor=per_pascal, of="fill pressure"
            )
        )
        if found.pressure.calibration is not None:
            _show_calibration(found.pressure.calibration, output)
    output.say_each("note", notes)


def _show_calibration(fit: HoseCalibration, output: CommandOutput) -> None:
    table = table_of("calibrated", "unit", "before", "after", "u", "95 % interval", texts=2)
    for place, name in enumerate(fit.parameter):
        unit, factor = _shown_unit(name, output.system)
        table.add_row(
            name, unit,
            short(factor * fit.start[place]), short(factor * fit.value[place], 6),
            short(factor * fit.value_standard_uncertainty[place], 2),
            (
                f"{factor * fit.low[place]:.6g} to {factor * fit.high[place]:.6g}"
                if np.isfinite(fit.high[place] - fit.low[place])
                else "wider than all that is allowed"
            )
            + (" (at its bound)" if fit.is_at_bound[place] else ""),
        )  # fmt: skip
    output.show(table)
    output.say(
        f"RMS {100 * fit.before.relative_rms:.3g} % before, {100 * fit.after.relative_rms:.3g} % "
        "after"
    )


def _shown_unit(name: str, system: UnitSystem) -> tuple[str, float]:
    unit = quantity(name).unit
    return ("deg", float(np.degrees(1.0))) if unit == "rad" else display_unit(unit, system)


def _comparison_document(named: NamedComparison) -> dict[str, Any]:
    """Output of ``--json`` for a comparison, in SI; differences are predicted minus measured."""
    found = named.comparison
    judged, validation = found.differences[found.judged], found.validation
    return {
        "test": named.test,
        "synthetic": named.is_synthetic,
        "specimen": named.specimen,
        "hose": named.hose,
        "loading": found.measured.loading,
        "judged": found.judged,
        "bias": plain(judged.bias),
        "rms": plain(judged.rms),
        "relative_rms": plain(judged.relative_rms),
        "worst": {
            "strain": plain(judged.worst_strain),
            "difference": plain(judged.worst_tension_difference),
        },
        "curves": {
            curve: {
                "bias": plain(one.bias),
                "rms": plain(one.rms),
                "relative_rms": plain(one.relative_rms),
                "worst": {
                    "strain": plain(one.worst_strain),
                    "difference": plain(one.worst_tension_difference),
                },
            }
            for curve, one in found.differences.items()
        },
        "events": {
            event.name: {
                name: plain(value) for name, value in vars(event).items() if name != "name"
            }
            for event in found.events
        },
        "measured_pick_up": {
            "strain": plain(found.measured_pick_up_strain),
            "standard_uncertainty": plain(found.measured_pick_up_strain_standard_uncertainty),
        },
        "energy": {name: plain(value) for name, value in vars(found.energy).items()},
        "validation_uncertainty": plain(validation.validation_uncertainty),
        "validation": {
            name: plain(getattr(validation, name))
            for name in (
                "coverage_factor", "largest_ratio", "largest_ratio_strain", "chi_square",
                "chi_square_freedom", "chi_square_probability", "uncertainty_share", "agrees",
                "is_informative",
            )
        },
        "verdict": validation.verdict,
        "strain": plain(found.measured.strain),
        "predicted": plain(found.prediction.tension),
        "measured": {
            curve: plain(found.measured.tension_of(curve)) for curve in found.differences
        },
        "difference": plain(judged.difference),
        "cycles": {
            "cycle": plain(found.cycles.cycle_number),
            "bias": plain(found.cycles.cycle_bias),
            "rms": plain(found.cycles.cycle_rms),
        },
        "calibrated": None if found.calibration is None else _calibrated(found.calibration),
        "fill_pressure": None if found.pressure is None else _pressure_document(found.pressure),
        "units": {"strain": "1", "tension": "N", "difference": "N", "energy": "J m-1"},
        "notes": list(map(str, named.notes)),
    }  # fmt: skip


def _pressure_document(found: PressureComparison) -> dict[str, Any]:
    return {
        "strain": plain(found.measured.strain),
        "predicted": plain(found.predicted),
        "measured": plain(found.measured.tension_of(found.measured.judged)),
        "validation_uncertainty": plain(found.validation.validation_uncertainty),
        "bias": plain(found.difference.bias),
        "rms": plain(found.difference.rms),
        "agrees": plain(found.validation.agrees),
        "verdict": found.validation.verdict,
        "calibrated": None if found.calibration is None else _calibrated(found.calibration),
    }


def _calibrated(fit: HoseCalibration) -> dict[str, Any]:
    return {
        "parameters": {
            name: {
                "unit": quantity(name).unit,
                "start": plain(fit.start[place]),
                "value": plain(fit.value[place]),
                "standard_uncertainty": plain(fit.value_standard_uncertainty[place]),
                "interval": plain(np.array([fit.low[place], fit.high[place]])),
                "bounds": plain(np.array([fit.lower_bound[place], fit.upper_bound[place]])),
                "is_at_bound": bool(fit.is_at_bound[place]),
            }
            for place, name in enumerate(fit.parameter)
        },
        "correlation": plain(fit.correlation),
        "is_identified": fit.identifiability.is_identified,
        "identifiability": fit.identifiability.words,
        "bias": plain(fit.after.bias),
        "rms": plain(fit.after.rms),
        "relative_rms": plain(fit.after.relative_rms),
        "model_error": plain(fit.model_error),
        "effective_points": plain(fit.effective_points),
    }

"""The command predict hose: table, events and figures of a stretch hose from its construction."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np

from reduction.batch.predictions import write_hoses
from reduction.campaign.hoses import load_hose, target_of
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.hosedesigns import designed, show_designs
from reduction.cli.numbers import plain, short, table_of
from reduction.errors import SettingsError
from reduction.ingest.source import hash_source
from reduction.pipeline.hosedesigns import design_hoses
from reduction.pipeline.prediction import predict_from_plan
from reduction.predict.product import HoseEvent
from reduction.prediction import PredictedHose
from reduction.report.page import write_report
from reduction.report.style import shown
from reduction.tables.write import write_tables
from reduction.units import UnitSystem, display_unit
from reduction.vocabulary import quantity

_SHOWN = 24
_ALONG = (
    "strain", "free_strain", "tension", "fill_pressure", "cord_tension", "cord_strain",
    "cord_share", "rubber_share", "end_cap_load", "current_wrap_angle", "cord_spacing",
    "current_inner_diameter",
)  # fmt: skip
_IN_TABLE = (
    "strain", "tension", "fill_pressure", "cord_tension", "cord_strain", "cord_share",
    "rubber_share",
)  # fmt: skip
_EVENTS = {
    "deepest_slack": "cords slackest", "pick_up": "cords pick up", "working": "working load",
    "break": "cords break",
}  # fmt: skip


def predict_hose(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Predict the hose of SPEC.toml and print it; with ``out``, write archive, tables and page."""
    plan, file = load_hose(path)
    target = target_of(path, file)
    hose = predict_from_plan(plan)
    designs = () if target is None else design_hoses(plan, target)
    units = cast("UnitSystem", output.units)
    _show(hose, output, units)
    if target is not None:
        show_designs(designs, target, output, units)
        if all(one.refusal for one in designs):
            output.error(f"{path}: target: no hose like this one does that")
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
        tables = write_tables([], out / "tables", predictions=out / "predictions.nc")
        page = write_report(out, out, units=units)
        output.say(f"archive: {out / 'predictions.nc'}")
        output.say(f"tables: {len(tables)} in {out / 'tables'}")
        output.say(f"figures: {page}")
    output.answer(
        document(hose)
        | {"designs": [designed(one) for one in designs]}
        | {"out": None if out is None else str(out)}
    )


def _events(hose: PredictedHose) -> dict[str, HoseEvent]:
    events = hose.events
    return {
        "deepest_slack": events.deepest_slack,
        "pick_up": events.pick_up,
        "working": events.working,
        "break": events.cord_break,
    }


def _show(hose: PredictedHose, output: CommandOutput, system: UnitSystem) -> None:
    force, per_newton = display_unit("N", system)
    pressure, per_pascal = display_unit("Pa", system)
    small = shown("small length", system)
    output.say(
        f"hose {hose.plan.name}: {np.degrees(float(hose.plan.design.wrap_angle)):.4g} degrees from "
        f"the axis, {hose.number_of_cords:.1f} cords, ribbon "
        f"{' and '.join(short(small.factor * width, 4) for width in hose.ribbon_width)} "
        f"{small.unit} wide"
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
    for note in hose.notes:
        output.say(f"note: {note}")


def _spread(hose: PredictedHose, event: str) -> dict[str, float]:
    """Standard uncertainty of strain and tension at an event; NaN where none is known."""
    found = getattr(hose.uncertainty, "cord_break" if event == "break" else event, None)
    known = found is not None and bool(hose.uncertainty.source)
    return {
        name: float(getattr(found, f"{name}_standard_uncertainty")) if known else float("nan")
        for name in ("strain", "tension")
    }


def document(hose: PredictedHose) -> dict[str, Any]:
    """What ``--json`` says of a hose, in SI."""
    prediction, uncertainty = hose.prediction, hose.uncertainty
    known = bool(uncertainty.source)
    return {
        "hose": hose.plan.name,
        **{name: plain(getattr(prediction, name)) for name in _ALONG},
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
        "units": {name: quantity(name).unit for name in _ALONG},
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
        "notes": list(hose.notes),
    }  # fmt: skip

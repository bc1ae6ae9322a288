"""The command compare: the archive of a test against a predicted hose."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np

from reduction.archive.comparisons import NamedComparison
from reduction.batch.comparisons import compare_archive, write_named
from reduction.campaign.hoses import load_hose
from reduction.campaign.plan import ComparisonPlan
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import plain, short, table_of
from reduction.compare.product import Calibration
from reduction.compare.verdict import verdict_words
from reduction.ingest.source import hash_source
from reduction.report.page import write_report
from reduction.tables.write import write_tables
from reduction.units import UnitSystem, display_unit
from reduction.vocabulary import quantity

_EVENTS = {"pick_up": "cords pick up", "working": "working load", "break": "cords break"}


def compare_test(measured: Path, spec: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Compare a test with the hose of SPEC.toml and print it; with ``out``, write products."""
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
    units = cast("UnitSystem", output.units)
    _show(named, output, units)
    if out is not None:
        path = out / "comparisons.nc"
        write_named(
            [named],
            path,
            hoses={hose.name: hose},
            campaign_id=hose.name,
            attributes={"title": f"Test {named.test} against hose {hose.name}"},
            sources=[
                hash_source(spec, spec.name),
                hash_source(measured, measured.name),
            ],
            command=f"reduction compare {measured.name} {spec.name}",
        )
        tables = write_tables([], out / "tables", comparisons=path)
        page = write_report(out, out, units=units)
        output.say(f"archive: {path}")
        output.say(f"tables: {len(tables)} in {out / 'tables'}")
        output.say(f"figures: {page}")
    output.answer(document(named) | {"out": None if out is None else str(out)})


def _show(named: NamedComparison, output: CommandOutput, system: UnitSystem) -> None:
    found = named.comparison
    force, factor = display_unit("N", system)
    output.say(
        f"{named.test} of {named.specimen} ({found.measured.loading}) against {named.hose}: "
        f"{verdict_words(found.validation, unit=force, factor=factor)}"
    )
    table = table_of(
        f"predicted less measured [{force}]", "bias", "RMS", "RMS [%]", "worst", "at strain [%]",
    )  # fmt: skip
    for curve, one in found.differences.items():
        table.add_row(
            f"{curve}{' (judged)' if curve == found.judged else ''}",
            short(factor * one.bias, 4), short(factor * one.rms, 4),
            short(100 * one.relative_rms, 3), short(factor * one.worst_difference, 4),
            short(100 * one.worst_strain, 4),
        )  # fmt: skip
    output.show(table)
    table = table_of(
        "event", "predicted strain [%]", "of that tension [%]", f"predicted tension [{force}]",
        f"measured there [{force}]", f"difference [{force}]", f"u [{force}]",
    )  # fmt: skip
    for event in found.events:
        table.add_row(
            _EVENTS.get(event.name, event.name),
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
        _show_calibration(found.calibration, output, system)
    for note in named.notes:
        output.say(f"note: {note}")


def _show_calibration(fit: Calibration, output: CommandOutput, system: UnitSystem) -> None:
    table = table_of("calibrated", "unit", "before", "after", "u", "95 % interval", texts=2)
    for place, name in enumerate(fit.parameter):
        unit, factor = _shown_unit(name, system)
        table.add_row(
            name, unit,
            short(factor * fit.start[place]), short(factor * fit.value[place], 6),
            short(factor * fit.standard_uncertainty[place], 2),
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


def document(named: NamedComparison) -> dict[str, Any]:
    """What ``--json`` says of a comparison, in SI; every difference is predicted less measured."""
    found = named.comparison
    judged, validation = found.differences[found.judged], found.validation
    return {
        "test": named.test,
        "specimen": named.specimen,
        "hose": named.hose,
        "loading": found.measured.loading,
        "judged": found.judged,
        "bias": plain(judged.bias),
        "rms": plain(judged.rms),
        "relative_rms": plain(judged.relative_rms),
        "worst": {
            "strain": plain(judged.worst_strain),
            "difference": plain(judged.worst_difference),
        },
        "curves": {
            curve: {
                "bias": plain(one.bias),
                "rms": plain(one.rms),
                "relative_rms": plain(one.relative_rms),
                "worst": {
                    "strain": plain(one.worst_strain),
                    "difference": plain(one.worst_difference),
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
        "validation_uncertainty": plain(validation.standard_uncertainty),
        "validation": {
            name: plain(getattr(validation, name))
            for name in (
                "coverage_factor", "ratio", "ratio_strain", "chi_square", "chi_square_freedom",
                "chi_square_probability", "share", "agrees", "is_informative",
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
            "bias": plain(found.cycles.bias),
            "rms": plain(found.cycles.rms),
        },
        "calibrated": None if found.calibration is None else _calibrated(found.calibration),
        "units": {"strain": "1", "tension": "N", "difference": "N", "energy": "J m-1"},
        "notes": list(named.notes),
    }  # fmt: skip


def _calibrated(fit: Calibration) -> dict[str, Any]:
    return {
        "parameters": {
            name: {
                "unit": quantity(name).unit,
                "start": plain(fit.start[place]),
                "value": plain(fit.value[place]),
                "standard_uncertainty": plain(fit.standard_uncertainty[place]),
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

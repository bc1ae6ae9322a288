"""The command predict wave-load: load of a wave, a current and wind on a floating hose."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

from reduction.archive.write import write_whole
from reduction.campaign.wavespec import load_wave_case
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import plain, short, table_of
from reduction.errors import DataError
from reduction.pipeline.waveload import PredictedWaveLoad, predict_wave_load
from reduction.report.predictionpage import write_wave_page
from reduction.tables.column import csv_text
from reduction.units import UnitSystem, display_unit

_SERIES = ("horizontal", "vertical", "horizontal_classic", "vertical_classic")
_UNITS = {
    "time": "s", **dict.fromkeys(_SERIES, "N m-1"), "immersion_depth": "m",
    "submerged_section_area": "m2", "elevation": "m", "wave_length": "m", "anchor_force": "N",
}  # fmt: skip


def predict_wave(path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Predict the wave load of SPEC.toml and print it; with ``out``, write table and page."""
    case = load_wave_case(path)
    given = asdict(case)
    name = given.pop("name")
    try:
        found = predict_wave_load(**given)
    except DataError as error:
        raise DataError(
            f"{path}: {error.problem}", found=error.found, needed=error.needed, hint=error.hint
        ) from error
    units = cast("UnitSystem", output.units)
    _show(found, output, units)
    if out is not None:
        table = out / "tables" / "wave_load.csv"
        write_whole(table, _csv(found))
        page = write_wave_page(found, out, name=name, units=units)
        output.say(f"table: {table}")
        output.say(f"figures: {page}")
    output.answer(document(found) | {"name": name, "out": None if out is None else str(out)})


def _csv(found: PredictedWaveLoad) -> str:
    load = found.load
    return csv_text(
        ["time [s]", *(f"{name} [N m-1]" for name in _SERIES)],
        zip(load.time.tolist(), *(getattr(load, name).tolist() for name in _SERIES), strict=True),
    )


def _show(found: PredictedWaveLoad, output: CommandOutput, system: UnitSystem) -> None:
    length, per_metre = display_unit("m", system)
    force, per_newton = display_unit("N", system)
    section, theory = found.load.section, found.theory
    depth = float(section.immersion_depth)
    output.say(
        f"immersed {per_metre * depth:.4g} {length} of "
        f"{per_metre * float(section.outer_diameter):.4g} {length} "
        f"({100 * depth / float(section.outer_diameter):.1f} %), "
        f"{1e4 * float(section.submerged_section_area):.4g} cm2 of its section"
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
    table = table_of(
        f"load [{force}/{length}]", "maximum", "at [s]", "minimum", "at [s]", "classic maximum",
        "classic minimum", "less than classic [%]",
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
        f"anchor force: {short(per_newton * float(anchor.combined))} {force} combined; "
        f"{short(per_newton * float(anchor.separate))} {force} as the sum of wave "
        f"{short(per_newton * float(anchor.wave), 4)}, current "
        f"{per_newton * float(anchor.current):.4g} and wind {per_newton * float(anchor.wind):.4g}"
    )
    for note in found.notes:
        output.say(f"note: {note}")


def document(found: PredictedWaveLoad) -> dict[str, Any]:
    """What ``--json`` says of a wave load, in SI."""
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
        "notes": list(found.notes),
    }

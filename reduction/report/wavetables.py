"""Tables of a wave load: extremes, the wave, the hose in it, coefficients, the anchor force."""

from __future__ import annotations

import numpy as np

from reduction.digits import plain_number
from reduction.pipeline.waveload import PredictedWaveLoad
from reduction.predict.coefficients import CODE_OF_HYDROLOGY, PUBLISHED_COEFFICIENTS
from reduction.report.figures.waves import THEORY_NAMES, force_per_length
from reduction.report.htmltable import Cell, Table, make_table, number, words
from reduction.report.style import Shown, shown
from reduction.units import UnitSystem, display_unit

__all__ = [
    "anchor_table", "coefficient_table", "extremes_table", "regime_table", "wave_table",
]  # fmt: skip

_ONE = Shown("1", 1.0)
_PERCENT = Shown("%", 100.0)
_SECOND = Shown("s", 1.0)
_Row = tuple[str, Shown, float]


def extremes_table(found: PredictedWaveLoad, units: UnitSystem) -> Table:
    """Return greatest and least load of both forms, with how much less the improved one is."""
    unit = force_per_length(units)
    rows = []
    for direction in ("horizontal", "vertical"):
        for end in ("maximum", "minimum"):
            own = getattr(found.extremes, direction)
            classic = getattr(found.extremes, f"{direction}_classic")
            rows.append(
                [
                    words(f"{direction}, {end}"),
                    number(float(getattr(own, end)), unit),
                    number(float(getattr(own, f"time_of_{end}")), digits=3),
                    number(float(getattr(classic, end)), unit),
                    number(float(getattr(classic, f"time_of_{end}")), digits=3),
                    number(float(getattr(found.difference, f"{direction}_of_{end}")), _PERCENT),
                ]
            )
    return make_table(
        "Extremes of the load over a period, found continuously and not among the times drawn.",
        (
            "load", unit.label("improved"), "at [s]", unit.label("classic"), "at [s]",
            "less than classic [%]",
        ),
        rows, synthetic=False,
        remarks=[
            "Classic: Morison's equation on the whole section. Improved: on the part under water"
            " in still water. Each has its extremes at times of its own.",
            "No uncertainty is given: none is stated of the wave, the hose or the coefficients, and"
            " those of the coefficients alone are tens of percent.",
        ],
    )  # fmt: skip


def wave_table(found: PredictedWaveLoad, units: UnitSystem) -> Table:
    """Return what the wave is, and how far it is from the limits of its theory."""
    length, theory = shown("length", units), found.theory
    height = theory.steepness * theory.wave_length
    rows: list[_Row] = [
        ("height", length, height),
        ("period", _SECOND, 2 * np.pi / found.wave.angular_frequency),
        ("length", length, theory.wave_length),
        ("depth of the water", length, theory.relative_depth * theory.wave_length),
        ("current along the wave", _velocity(units), found.current_velocity),
        ("depth over length", _ONE, theory.relative_depth),
        ("height over length", _ONE, theory.steepness),
        ("height over the height at which it breaks", _ONE, theory.breaking_ratio),
        ("Ursell number", _ONE, theory.ursell_number),
        ("second harmonic of the surface over the first", _ONE, theory.elevation_ratio),
        ("second harmonic of the velocity over the first", _ONE, theory.velocity_ratio),
        ("given length over that of the period, less one", _PERCENT, theory.length_mismatch),
    ]
    return make_table(
        "The wave.", ("number", "value"), [_row(row) for row in rows], synthetic=False,
        remarks=[
            f"Computed by the theory of {_named(found.used)}. By relative depth, as the paper reads"
            f" its table: {_named(theory.theory)}; by the letter of the table:"
            f" {_named(theory.printed)}.",
        ],
    )  # fmt: skip


def regime_table(found: PredictedWaveLoad, units: UnitSystem) -> Table:
    """Return the hose in the water, and the numbers by which coefficients are chosen."""
    small, section, regime = shown("small length", units), found.load.section, found.regime
    rows: list[_Row] = [
        ("outer diameter", small, float(section.outer_diameter)),
        ("immersion depth", small, float(section.immersion_depth)),
        ("share of the section under water", _PERCENT, float(section.submerged_share)),
        ("section under water", shown("area", units), float(section.submerged_section_area)),
        ("level at which the water moves", small, found.elevation),
        ("greatest velocity of the water", _velocity(units), regime.greatest_velocity),
        ("Keulegan-Carpenter number", _ONE, float(regime.keulegan_carpenter_number)),
        ("Reynolds number", _ONE, float(regime.reynolds_number)),
        ("Reynolds over Keulegan-Carpenter", _ONE, float(regime.frequency_parameter)),
        ("greatest drag over greatest inertia", _ONE, float(regime.drag_to_inertia)),
        ("diameter over wave length", _ONE, float(regime.diameter_to_length)),
    ]
    return make_table(
        "The hose in the water, and the flow past it.", ("number", "value"),
        [_row(row) for row in rows], synthetic=False,
        remarks=["Velocity with the current, at the level of the load. Morison's equation holds up"
                 " to a diameter of 0.2 wave lengths."],
    )  # fmt: skip


def anchor_table(found: PredictedWaveLoad, units: UnitSystem) -> Table:
    """Return the greatest horizontal force of wind, wave and current, added and as one flow."""
    force, length, anchor = shown("tension", units), shown("length", units), found.anchor
    rows: list[_Row] = [
        ("wind alone", force, float(anchor.wind)),
        ("current alone", force, float(anchor.current)),
        ("wave alone, at its greatest", force, float(anchor.wave)),
        ("sum of the three", force, float(anchor.separate)),
        ("wave and current as one flow, with the wind", force, float(anchor.combined)),
        ("combined less sum, over combined", _PERCENT, float(anchor.difference)),
    ]
    speed = _velocity(units)
    return make_table(
        f"Horizontal force on {length.factor * found.hose_length:.4g} {length.unit} of hose, the"
        " anchor force.",
        ("force", "value"), [_row(row) for row in rows], synthetic=False,
        remarks=[
            f"Wind {speed.factor * found.wind_velocity:.4g} {speed.unit} at the hose, current"
            f" {speed.factor * found.current_velocity:.4g} {speed.unit}. Drag goes with the square"
            " of the velocity: loads do not add, velocities do. The whole length meets one phase:"
            " it lies along the crest.",
        ],
    )  # fmt: skip


def coefficient_table(found: PredictedWaveLoad) -> Table:
    """Return published coefficients, with those of this case and where it stands among them."""
    regime = found.regime
    rows = [
        [
            words(one.source), words(one.wave_theory), _pair(*one.drag_coefficient),
            number(one.inertia_coefficient, digits=3), words(one.comment),
        ]
        for one in (*PUBLISHED_COEFFICIENTS, CODE_OF_HYDROLOGY)
    ]  # fmt: skip
    rows.append(
        [
            words("this case"),
            words(_named(found.used)),
            number(found.drag_coefficient, digits=3),
            number(found.inertia_coefficient, digits=3),
            words(
                f"KC {float(regime.keulegan_carpenter_number):.3g},"
                f" Re {plain_number(float(regime.reynolds_number), 3)}"
            ),
        ]
    )
    return make_table(
        "Coefficients of drag and inertia as published, and of this case.",
        ("source", "wave theory", "drag [1]", "inertia [1]", "said of them"),
        rows, synthetic=False,
        remarks=["None is for a cylinder that floats, and none comes with its range of KC and Re,"
                 " on which they depend. Inertia: one plus the added mass."],
    )  # fmt: skip


def _named(theory: str) -> str:
    return THEORY_NAMES.get(theory, theory)


def _velocity(units: UnitSystem) -> Shown:
    unit, factor = display_unit("m s-1", units)
    return Shown({"m s-1": "m/s", "ft s-1": "ft/s"}.get(unit, unit), factor)


def _row(row: _Row) -> list[Cell]:
    name, unit, value = row
    return [words(unit.label(name)), number(value, unit)]


def _pair(low: float, high: float) -> Cell:
    text = f"{low:g}" if low == high else f"{low:g} to {high:g}"
    return Cell(text, f"{low!r} {high!r}", is_number=True)

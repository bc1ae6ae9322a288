"""A wave load from a hose, a sea and its exposure to loads, extremes and what to doubt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from reduction.predict.coefficients import (
    GREATEST_DIAMETER_TO_LENGTH,
    FlowRegime,
    flow_regime,
)
from reduction.predict.difference import LoadDifference, load_difference
from reduction.predict.environment import AnchorForce, anchor_force
from reduction.predict.extremes import LoadExtremes, find_extremes
from reduction.predict.harmonics import WaveHarmonics
from reduction.predict.immersion import immerse_hose
from reduction.predict.morison import VerticalWidth, WaveLoad, wave_load
from reduction.predict.theorytable import WaveTheoryName
from reduction.predict.wavetheory import WaveTheory, describe_wave, regular_wave
from reduction.record import Floats

_LINEAR = 0.6
"""Share of the breaking height above which the neglected terms are no small ones."""


@dataclass(frozen=True)
class PredictedWaveLoad:
    """Loads per length over time, their extremes, and where the case stands.

    ``elevation`` is that at which the water was taken, from the mean level up [m]; ``used`` the
    theory that computed ``wave``.  Coefficients [1], velocities [m s-1] and length of the hose
    [m] as given.
    """

    theory: WaveTheory
    used: str
    wave: WaveHarmonics
    elevation: float
    drag_coefficient: float
    inertia_coefficient: float
    current_velocity: float
    wind_velocity: float
    hose_length: float
    load: WaveLoad
    extremes: LoadExtremes
    difference: LoadDifference
    regime: FlowRegime
    anchor: AnchorForce
    notes: tuple[str, ...]


def predict_wave_load(
    *,
    outer_diameter: float,
    wall_thickness: float,
    wall_density: float,
    content_density: float,
    water_density: float,
    water_depth: float,
    wave_height: float,
    wave_period: float,
    wave_length: float | None,
    wave_theory: Literal["auto", "airy", "stokes"],
    elevation: float | None,
    drag_coefficient: float,
    inertia_coefficient: float,
    vertical_width: VerticalWidth,
    current_velocity: float,
    wind_velocity: float,
    wind_drag_coefficient: float,
    air_density: float,
    hose_length: float,
    time: Floats,
) -> PredictedWaveLoad:
    """Predict the load of a regular wave on a floating hose that lies along its crest.

    Parameters
    ----------
    outer_diameter, wall_thickness : float
        Of the hose. [m]
    wall_density, content_density, water_density, air_density : float
        [kg m-3]
    water_depth, wave_height : float
        [m]
    wave_period : float
        As a fixed point sees it. [s]
    wave_length : float or None
        Given beside the period, it is used as it is. [m]
    wave_theory : {"auto", "airy", "stokes"}
        ``airy``, ``stokes``, or ``auto`` for the one that applies.
    elevation : float or None
        At which the water moves; None for the centre of the hose. [m]
    drag_coefficient, inertia_coefficient, wind_drag_coefficient : float
        [1]
    vertical_width : str
        Which width the vertical drag acts on.
    current_velocity, wind_velocity : float
        Along the wave. [m s-1]
    hose_length : float
        For the anchor force. [m]
    time : ndarray, shape (n_times,)
        [s]

    Returns
    -------
    load : PredictedWaveLoad
        Improved and classic, with extremes found continuously.

    Raises
    ------
    DataError
        If the hose sinks, the wave is beyond breaking, or no theory here computes it.
    """
    section = immerse_hose(
        outer_diameter=outer_diameter,
        wall_thickness=wall_thickness,
        wall_density=wall_density,
        content_density=content_density,
        water_density=water_density,
    )
    described = describe_wave(
        wave_height=wave_height,
        wave_period=wave_period,
        water_depth=water_depth,
        wave_length=wave_length,
        current_velocity=current_velocity,
    )
    centre = outer_diameter / 2 - float(section.immersion_depth)
    at = centre if elevation is None else elevation
    asked: WaveTheoryName | None = None if wave_theory == "auto" else wave_theory
    wave = regular_wave(
        described,
        wave_height=wave_height,
        wave_period=wave_period,
        water_depth=water_depth,
        elevation=at,
        theory=asked,
        current_velocity=current_velocity,
    )
    given = {
        "drag_coefficient": drag_coefficient,
        "inertia_coefficient": inertia_coefficient,
        "water_density": water_density,
        "current_velocity": current_velocity,
    }
    load = wave_load(wave, section, time, vertical_width=vertical_width, **given)
    extremes = find_extremes(wave, section, vertical_width=vertical_width, **given)
    used = described.theory if asked is None else asked
    regime = flow_regime(
        wave,
        outer_diameter,
        current_velocity=current_velocity,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
    )
    notes = list(described.reasons)
    slender = float(regime.diameter_to_length)
    if slender > GREATEST_DIAMETER_TO_LENGTH:
        notes.append(
            f"the diameter is {100 * slender:.0f} % of the wave length: the hose scatters the "
            "wave, and Morison's equation does not hold above "
            f"{100 * GREATEST_DIAMETER_TO_LENGTH:.0f} %"
        )
    if used == "airy" and described.breaking_ratio > _LINEAR:
        notes.append(
            f"at {100 * described.breaking_ratio:.0f} % of the height at which it breaks a wave is "
            "far from linear: Airy's theory does not hold"
        )
    if used != described.theory:
        notes.append(f"computed by {used}, as asked for; by depth {described.theory} applies")
    return PredictedWaveLoad(
        theory=described,
        used=used,
        wave=wave,
        elevation=at,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
        current_velocity=current_velocity,
        wind_velocity=wind_velocity,
        hose_length=hose_length,
        load=load,
        extremes=extremes,
        difference=load_difference(load, extremes),
        regime=regime,
        anchor=anchor_force(
            wave,
            section,
            hose_length=hose_length,
            wind_velocity=wind_velocity,
            wind_drag_coefficient=wind_drag_coefficient,
            air_density=air_density,
            **given,
        ),
        notes=tuple(notes),
    )

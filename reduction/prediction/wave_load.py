"""Wave, current and wind on a moored floating hose.

Wind, current and wave together on a moored floating hose: the anchor force.

.. math:: F_P = F_{wind} + F_{wave} + F_{current}

Drag goes with the square of the velocity, so that wave and current do not add: their
velocities do.

A wave load from a hose, a sea and its exposure to loads, extremes and what to doubt.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 4, Fig. 3.
.. [2] ISO 2533:1975, Standard Atmosphere.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.prediction.morison import (
    CODE_OF_HYDROLOGY,
    GREATEST_DIAMETER_TO_LENGTH,
    SEAWATER_DENSITY,
    FlowRegime,
    ImmersedSection,
    LoadDifference,
    LoadExtremes,
    LoadRange,
    VerticalWidth,
    WaveLoad,
    find_extremes,
    flow_regime,
    immerse_hose,
    load_difference,
    load_factors,
    wave_load,
)
from reduction.prediction.wave_theory import (
    WaveHarmonics,
    WaveTheory,
    WaveTheoryName,
    describe_wave,
    regular_wave,
)
from reduction.record.arrays import as_finite, as_positive
from reduction.record.measurement import Floats, read_only_arrays

AIR_DENSITY = 1.225
"""At sea level, 15 deg C ([2]_). [kg m-3]"""


@dataclass(frozen=True)
@read_only_arrays
class _AnchorForce:
    """Horizontal force on a length of hose, shape (...), positive along the wave."""

    wind: Floats
    current: Floats
    wave: Floats
    separate: Floats
    combined: Floats
    difference: Floats


def _wind_load(
    section: ImmersedSection,
    *,
    wind_velocity: float,
    wind_drag_coefficient: float,
    air_density: float = AIR_DENSITY,
) -> Floats:
    """Load of a steady wind on the part of the hose above the water.

    Notes
    -----
    [1]_ names the load in eq. (4) and gives no form; this is drag on D - h.  A wind stated for
    a height of 10 m is larger than that at the hose.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> print(_wind_load(hose, wind_velocity=10.0, wind_drag_coefficient=1.2).round(3))
    1.389
    """
    speed = float(as_finite("wind_velocity", wind_velocity))
    drag = float(as_finite("wind_drag_coefficient", wind_drag_coefficient))
    density = float(as_positive("air_density", air_density))
    return np.asarray(density / 2 * drag * section.emergent_height * speed * abs(speed))


def _current_load(
    section: ImmersedSection,
    *,
    current_velocity: float,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    water_density: float = SEAWATER_DENSITY,
) -> Floats:
    """Load of a steady current alone.

    Notes
    -----
    The drag of eq. (9) of [1]_ with the current for the velocity.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> print(_current_load(hose, current_velocity=0.5).round(3))
    14.622
    """
    speed = float(as_finite("current_velocity", current_velocity))
    factors = load_factors(section, drag_coefficient=drag_coefficient, water_density=water_density)
    return np.asarray(factors.horizontal_drag * speed * abs(speed))


def _anchor_force(
    wave: WaveHarmonics,
    section: ImmersedSection,
    *,
    hose_length: float,
    current_velocity: float = 0.0,
    wind_velocity: float = 0.0,
    wind_drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    air_density: float = AIR_DENSITY,
) -> _AnchorForce:
    """Greatest horizontal force of wind, wave and current, added and combined.

    Notes
    -----
    Eq. (4) of [1]_, the extreme case in which all act in one direction, adds loads; the cross
    term 2 u U of the squared velocity is missing there, so that the sum is too low where the
    current follows the wave, the very case meant.  Where the current opposes the wave the
    term takes from the load under the crest, and the sum is too high.

    Examples
    --------
    A current of 0.5 m/s and a wind of 10 m/s on 100 m of the hose of [1]_.

    >>> from reduction.prediction.wave_theory import airy_wave
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> force = _anchor_force(wave, hose, hose_length=100.0, current_velocity=0.5,
    ...                      wind_velocity=10.0)
    >>> print(force.separate.round(0), force.combined.round(0), force.difference.round(3))
    9530.0 15996.0 0.404
    """
    length = float(as_positive("hose_length", hose_length))
    wind = length * _wind_load(
        section,
        wind_velocity=wind_velocity,
        wind_drag_coefficient=wind_drag_coefficient,
        air_density=air_density,
    )
    current = length * _current_load(
        section,
        current_velocity=current_velocity,
        drag_coefficient=drag_coefficient,
        water_density=water_density,
    )

    def water(velocity: float) -> LoadRange:
        return find_extremes(
            wave,
            section,
            drag_coefficient=drag_coefficient,
            inertia_coefficient=inertia_coefficient,
            water_density=water_density,
            current_velocity=velocity,
        ).horizontal

    alone, together = water(0.0), water(current_velocity)
    wave_force = _larger_sum(wind + current, length * alone.maximum, length * alone.minimum)
    separate = wind + current + wave_force
    combined = wind + _larger_sum(wind, length * together.maximum, length * together.minimum)
    return _AnchorForce(
        wind=np.asarray(wind),
        current=np.asarray(current),
        wave=wave_force,
        separate=np.asarray(separate),
        combined=np.asarray(combined),
        difference=np.asarray((combined - separate) / np.where(combined == 0, np.nan, combined)),
    )


def _larger_sum(steady: Floats, maximum: Floats, minimum: Floats) -> Floats:
    """That extreme which with the steady force is of the larger magnitude."""
    return np.asarray(
        np.where(np.abs(steady + maximum) >= np.abs(steady + minimum), maximum, minimum)
    )


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
    anchor: _AnchorForce
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
    """Predict the load of a regular wave on a floating hose that lies along its crest."""
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
        anchor=_anchor_force(
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

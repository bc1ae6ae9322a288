r"""Wave, current and wind on a floating hose, by Morison's equation, classic and improved.

**Immersion of a floating hose, from its weight**:

.. math::
   S_1 = \frac{\rho_2 (S_0 - S_b) + \rho_3 S_b}{\rho_1}, \qquad
   S_1 = \frac{D^2}{8} (\beta - \sin\beta), \qquad h = D \sin^2\frac{\beta}{4}

with the bore S_b, and beta the central angle of the part under water (2 pi - 2 theta
in [1]_).

**Coefficients of drag and inertia with their sources, and the flow regime.** With the greatest
velocity u and the diameter D,

.. math:: KC = \frac{u T}{D}, \qquad Re = \frac{u D}{\nu}, \qquad
          \frac{F_D}{F_I} = \frac{C_D}{\pi^2 C_M} KC

**Wave load on a floating hose per length, by Morison's equation and by its improved form**:

.. math::
   f = \tfrac12 C_D \rho\, b\, (u + U) |u + U| + C_M \rho\, S\, \dot u

The classic form uses the whole section, b = D and S = pi D^2/4; the improved form uses the part
under water, S = S_1 and b = h for the horizontal load.

**Greatest and least wave load over a period, also between samples.** A Morison load is a|u|u + b
du/dt with sums of harmonics u and du/dt of the phase.  Where u keeps its sign, the derivative

.. math:: \pm 2 a\, u\, u' + b\, (\dot u)'

is also a sum of harmonics, of twice the order, whose zeros are roots of a polynomial.  Where u
changes its sign the derivative is continuous, so no extreme is missed there.

**Anchor force of a moored floating hose in wind, current and waves**:

.. math:: F_P = F_{wind} + F_{wave} + F_{current}

Drag is proportional to the square of the velocity, so the loads of wave and current do not add:
their velocities do.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 4-8 and 11, Table 3; Table 2 and eq. 12; eq. 1-3, 7-10;
   Tables 5 and 6; eq. 18-19, Tables 7 and 8; eq. 4, Fig. 3.
.. [2] G. H. Keulegan and L. H. Carpenter, "Forces on cylinders and plates in an oscillating fluid,"
   J. Res. Nat. Bur. Standards, vol. 60, 1958, pp. 423-440.
.. [3] ITTC, "Fresh Water and Seawater Properties," Recommended Procedure 7.5-02-01-03, 2011.
.. [4] ISO 2533:1975, Standard Atmosphere.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.wave_theory import (
    Coefficients,
    WaveHarmonics,
    WaveTheory,
    WaveTheoryName,
    cosine_series,
    describe_wave,
    particle_motion,
    phase_derivative,
    regular_wave,
    root_phases,
    series_product,
    sine_series,
    sum_at,
)
from reduction.record.arrays import as_finite, as_positive
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, by_severity, note

_STEP = 1e-14  # greatest last Newton step, relative to the root

_MOST_STEPS = 50

_MOST_ROOTED = 20  # harmonics

_SERIES_TERMS = 10  # of beta - sin beta up to beta = 1: the last is below 1e-21 of the first


@dataclass(frozen=True)
@read_only_arrays
class ImmersedSection:
    """Cross section of a floating hose in still water.  Arrays have the shape (...) of the hoses.

    Parameters
    ----------
    outer_diameter : ndarray
        D. [m]
    submerged_section_area : ndarray
        S_1. [m2]
    immersion_depth : ndarray
        h, lowest point below the surface. [m]
    """

    outer_diameter: Floats
    submerged_section_area: Floats
    immersion_depth: Floats

    @property
    def section_area(self) -> Floats:
        """Area of the whole cylinder, S_0. [m2]."""
        return np.asarray(pi * self.outer_diameter**2 / 4)

    @property
    def submerged_share(self) -> Floats:
        """Submerged share of the section. [1]."""
        return np.asarray(self.submerged_section_area / self.section_area)

    @property
    def emergent_height(self) -> Floats:
        """Highest point above the surface. [m]."""
        return np.asarray(self.outer_diameter - self.immersion_depth)

    @property
    def centre_elevation(self) -> Floats:
        """Height of the axis above the surface; negative if more than half is submerged. [m]."""
        return np.asarray(self.outer_diameter / 2 - self.immersion_depth)

    @property
    def submerged_width(self) -> Floats:
        """Width of the part under water, seen from below. [m].

        The chord at the waterline, or D if more than half is submerged.
        """
        chord = 2 * np.sqrt(self.immersion_depth * self.emergent_height)
        return np.asarray(np.where(self.centre_elevation > 0, chord, self.outer_diameter))


def immerse_hose(
    *,
    outer_diameter: ArrayLike,
    wall_thickness: ArrayLike,
    wall_density: ArrayLike,
    content_density: ArrayLike,
    water_density: ArrayLike,
) -> ImmersedSection:
    """Floating position of a full or an empty hose.

    Notes
    -----
    Eq. (6) of [1]_.  Eq. (5) leaves out the acceleration of free fall, which cancels.

    An empty hose is assumed round; a collapsible one lies flat, which [1]_, eq. 4-8 and 11, Table
    3 mentions but does not compute.

    Examples
    --------
    Table 3 of [1]_; eq. (11) prints 95.1 mm, 0.834 and 0.0091 m2.

    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> print((1000 * hose.immersion_depth).round(3), hose.submerged_section_area.round(7))
    95.124 0.0090994
    """
    diameter, wall, wall_mass, content_mass, water = np.broadcast_arrays(
        as_positive("outer_diameter", outer_diameter),
        as_positive("wall_thickness", wall_thickness),
        as_positive("wall_density", wall_density),
        as_finite("content_density", content_density),
        as_positive("water_density", water_density),
    )
    _refuse(
        content_mass < 0, "content_density is below zero", content_mass, "kg/m3", "0 or more kg/m3"
    )
    bore = diameter - 2 * wall
    _refuse(
        bore < 0, "the wall is thicker than half the hose", wall, "m", "at most half the diameter"
    )
    bore_share = (bore / diameter) ** 2
    mass = wall_mass * (1 - bore_share) + content_mass * bore_share
    is_sinking = mass > water
    if np.any(is_sinking):
        first = int(np.flatnonzero(np.ravel(is_sinking))[0])
        raise DataError(
            f"{int(np.sum(is_sinking))} of {mass.size} hoses are heavier than water, "
            f"first at index {first}"
            if mass.size > 1
            else "the hose is heavier than water",
            found=f"{np.ravel(mass)[first]:.5g} kg/m3 with a wall of "
            f"{np.ravel(wall_mass)[first]:g} and a content of "
            f"{np.ravel(content_mass)[first]:g} kg/m3",
            needed=f"at most {np.ravel(water)[first]:g} kg/m3, the water",
            hint="A hose that sinks has no waterline: give its floats with the wall.",
        )
    area = pi * diameter**2 / 4 * (mass / water)
    return ImmersedSection(
        outer_diameter=np.array(diameter),
        submerged_section_area=np.asarray(area),
        immersion_depth=_immersion_depth_of(area, diameter),
    )


def _immersion_depth_of(submerged_section_area: ArrayLike, outer_diameter: ArrayLike) -> Floats:
    """Depth of a circular segment of this area.

    Notes
    -----
    Eq. (8) of [1]_ in the angle beta of the smaller of the two segments, which is Kepler's
    equation on its edge.  The start, beta^3 = 6 (beta - sin beta), is below the root; the first
    step goes above it, and beta - sin beta is convex up to pi, so the following steps decrease
    without passing the root.  Below beta = 1 the difference is summed as a series, since it would
    lose digits.

    Examples
    --------
    Half a circle, and almost nothing.

    >>> print(_immersion_depth_of([np.pi / 8, 1e-12], 1.0))
    [5.00000000e-01 8.25481814e-09]
    """
    area, diameter = np.broadcast_arrays(
        as_finite("submerged_section_area", submerged_section_area),
        as_positive("outer_diameter", outer_diameter),
    )
    share = area / (pi * diameter**2 / 4)
    _refuse(
        (share < 0) | (share > 1 + 4e-16), "no segment of the circle is this large", area, "m2",
        "an area from 0 to that of the circle",
    )  # fmt: skip
    smaller = np.maximum(np.minimum(share, 1 - share), 0.0)
    depth = diameter * np.sin(_segment_angle(2 * pi * smaller) / 4) ** 2
    return np.asarray(np.where(share > 0.5, diameter - depth, depth))


def _segment_angle(segment: Floats) -> Floats:
    """Root beta of beta - sin beta = segment, for segments from 0 to pi."""
    angle = np.cbrt(6 * segment)
    for _ in range(_MOST_STEPS):
        slope = 2 * np.sin(angle / 2) ** 2
        miss = _segment_of(angle) - segment
        step = np.divide(miss, slope, out=np.zeros_like(miss), where=slope > 0)
        angle = angle - step
        if np.all(np.abs(step) <= _STEP * angle):
            return np.asarray(angle)
    raise FitError(
        "the immersion depth was not found",
        found=f"no end after {_MOST_STEPS} Newton steps",
        needed=f"a last step below {_STEP:g} of the root",
    )


def _segment_of(angle: Floats) -> Floats:
    """Difference beta - sin beta without loss of digits."""
    square = np.minimum(angle, 1.0) ** 2
    tail = np.ones_like(angle)
    for term in range(_SERIES_TERMS, 1, -1):
        tail = 1 - square / (2 * term * (2 * term + 1)) * tail
    return np.asarray(np.where(angle < 1, angle**3 / 6 * tail, angle - np.sin(angle)))


def _refuse(bad: Bools, problem: str, values: Floats, unit: str, needed: str) -> None:
    if not np.any(bad):
        return
    first = int(np.flatnonzero(np.ravel(bad))[0])
    place = f": {int(np.sum(bad))} of {bad.size}, first at index {first}" if bad.size > 1 else ""
    raise DataError(
        f"{problem}{place}",
        found=f"{np.ravel(values)[first]:g} {unit}",
        needed=needed,
    )


SEAWATER_VISCOSITY = 1.1892e-6

"""Kinematic viscosity of standard seawater at 15 deg C ([3]_). [m2 s-1]"""

GREATEST_DIAMETER_TO_LENGTH = 0.2

"""Above it a cylinder changes the wave, and Morison's equation does not hold ([1]_, sec. 2). [1]"""


@dataclass(frozen=True)
class _PublishedCoefficients:
    """One row of a table; where the source gives one number, low and high are equal."""

    wave_theory: str
    drag_coefficient: tuple[float, float]
    inertia_coefficient: float
    comment: str
    source: str


PUBLISHED_COEFFICIENTS = (
    _PublishedCoefficients(
        "linear", (1.0, 1.0), 0.95,
        "mean values for ocean wave data on 13-24 in cylinders", "Wiegel et al. (1957)",
    ),
    _PublishedCoefficients(
        "linear", (1.0, 1.4), 2.0,
        "recommended design values based on statistical analysis of published data",
        "Agerschou and Edens (1965)",
    ),
    _PublishedCoefficients(
        "Stokes, third order", (1.34, 1.34), 1.6,
        "mean values for oscillatory flow for 2-3 in cylinders", "Keulegan and Carpenter (1958)",
    ),
    _PublishedCoefficients(
        "Stokes, fifth order", (0.8, 1.0), 2.0,
        "recommended values based on statistical analysis of published data",
        "Agerschou and Edens (1965)",
    ),
)  # fmt: skip

"""Table 2 of [1]_; no row is for a floating cylinder."""

CODE_OF_HYDROLOGY = _PublishedCoefficients(
    "any", (1.2, 1.2), 2.0,
    "settled for the sea area of China; used in all examples of the paper",
    "Code of Hydrology for Sea Harbour (1998)",
)  # fmt: skip

"""Eq. (12) of [1]_: the default of a wave load."""


@dataclass(frozen=True)
@read_only_arrays
class _FlowRegime:
    """Flow regime of a hose in a wave; arrays have the shape (...) of the diameters."""

    greatest_velocity: float
    keulegan_carpenter_number: Floats
    reynolds_number: Floats
    drag_to_inertia: Floats
    diameter_to_length: Floats


def _keulegan_carpenter_number(
    greatest_velocity: ArrayLike, wave_period: ArrayLike, outer_diameter: ArrayLike
) -> Floats:
    """Path of the water over the diameter, times pi for a sinusoid.

    Notes
    -----
    Defined in [2]_.

    Examples
    --------
    The hose of [1]_ in its 6 m deep wave, 1.15 m/s: far in the drag regime, yet not steady.

    >>> print(_keulegan_carpenter_number(1.15, 3.57, 0.114).round(1))
    36.0
    """
    speed = np.abs(as_finite("greatest_velocity", greatest_velocity))
    period = as_positive("wave_period", wave_period)
    return np.asarray(speed * period / as_positive("outer_diameter", outer_diameter))


def _reynolds_number(greatest_velocity: ArrayLike, outer_diameter: ArrayLike) -> Floats:
    """Ratio of inertia to friction in the flow.

    Notes
    -----
    Viscosity of seawater from [3]_.

    Examples
    --------
    >>> print(_reynolds_number(1.15, 0.114).round(-3))
    110000.0
    """
    speed = np.abs(as_finite("greatest_velocity", greatest_velocity))
    return np.asarray(speed * as_positive("outer_diameter", outer_diameter) / SEAWATER_VISCOSITY)


def _drag_to_inertia(
    keulegan_carpenter_number: ArrayLike,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
) -> Floats:
    """Greatest drag over greatest inertia of a whole cylinder in a sinusoidal flow.

    Notes
    -----
    From eq. (1) of [1]_ with u = u_max cos: (C_D D u^2 / 2) / (C_M pi D^2 / 4 * 2 pi u / T).

    Examples
    --------
    >>> print(_drag_to_inertia(36.0).round(2))
    2.19
    """
    number = as_finite("keulegan_carpenter_number", keulegan_carpenter_number)
    drag = as_finite("drag_coefficient", drag_coefficient)
    return np.asarray(
        drag * number / (pi**2 * as_positive("inertia_coefficient", inertia_coefficient))
    )


def _flow_regime(
    wave: WaveHarmonics,
    outer_diameter: ArrayLike,
    *,
    current_velocity: float = 0.0,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
) -> _FlowRegime:
    """Numbers by which coefficients are chosen, for hoses in one wave.

    Notes
    -----
    For the horizontal velocity, including the current; some sources give KC for the wave alone
    and treat the current separately.  Table 2 of [1]_ gives no range of KC or Re for its values,
    though [2]_ shows that they depend on KC.

    Examples
    --------
    >>> from reduction.prediction.wave_theory import airy_wave
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> print(_flow_regime(wave, 0.114).keulegan_carpenter_number.round(1))
    35.4
    """
    period = 2 * pi / wave.angular_frequency
    velocity = cosine_series(wave.horizontal_velocity, current_velocity)
    speed = float(np.max(np.abs(sum_at(velocity, root_phases(phase_derivative(velocity))))))
    number = _keulegan_carpenter_number(speed, period, outer_diameter)
    return _FlowRegime(
        greatest_velocity=speed,
        keulegan_carpenter_number=number,
        reynolds_number=_reynolds_number(speed, outer_diameter),
        drag_to_inertia=_drag_to_inertia(
            number, drag_coefficient=drag_coefficient, inertia_coefficient=inertia_coefficient
        ),
        diameter_to_length=np.asarray(
            as_positive("outer_diameter", outer_diameter) * wave.wave_number / (2 * pi)
        ),
    )


VerticalWidth = Literal["submerged", "immersion depth"]

SEAWATER_DENSITY = 1025.0

"""Table 3 of [1]_. [kg m-3]"""


@dataclass(frozen=True)
@read_only_arrays
class _LoadFactors:
    """Factors of u|u| and of the acceleration; arrays have the shape (...).

    Drag factors are in [kg m-2], inertia factors in [kg m-1]; the classic load has the same
    in both directions.
    """

    horizontal_drag: Floats
    vertical_drag: Floats
    inertia: Floats
    classic_drag: Floats
    classic_inertia: Floats


@dataclass(frozen=True)
@read_only_arrays
class _WaveLoad:
    """Load per length of hose over time; loads have the shape (..., n_times)."""

    time: Floats
    horizontal: Floats
    vertical: Floats
    horizontal_classic: Floats
    vertical_classic: Floats
    horizontal_drag: Floats
    vertical_drag: Floats
    section: ImmersedSection


def load_factors(
    section: ImmersedSection,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    vertical_width: VerticalWidth = "submerged",
) -> _LoadFactors:
    """Drag per velocity squared and inertia per acceleration, for a section.

    Notes
    -----
    Eq. (9) of [1]_ uses the height h for the vertical load too.  Rising water meets the width,
    which is D for its hose: h underestimates the drag by 1 - h/D, 16.6 %.

    Examples
    --------
    >>> hose = ImmersedSection(np.array(0.114), np.array(0.0091), np.array(0.0951))
    >>> factors = load_factors(hose)
    >>> print(factors.horizontal_drag.round(2), factors.vertical_drag.round(2))
    58.49 70.11
    """
    drag = float(as_finite("drag_coefficient", drag_coefficient))
    inertia = float(as_positive("inertia_coefficient", inertia_coefficient))
    density = float(as_positive("water_density", water_density))
    width = section.submerged_width if vertical_width == "submerged" else section.immersion_depth
    return _LoadFactors(
        horizontal_drag=np.asarray(drag * density / 2 * section.immersion_depth),
        vertical_drag=np.asarray(drag * density / 2 * width),
        inertia=np.asarray(inertia * density * section.submerged_section_area),
        classic_drag=np.asarray(drag * density / 2 * section.outer_diameter),
        classic_inertia=np.asarray(inertia * density * section.section_area),
    )


def wave_load(
    wave: WaveHarmonics,
    section: ImmersedSection,
    time: ArrayLike,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    current_velocity: float = 0.0,
    position: float = 0.0,
    vertical_width: VerticalWidth = "submerged",
) -> _WaveLoad:
    """Load of a wave, and a current with it, on a hose that lies along the crest.

    Notes
    -----
    Eq. (1) and (10) of [1]_.  The hose is fixed with its waterline at the mean level, as there; a
    hose that rides the wave has less load.  Drag is computed for each direction separately; on a
    fully submerged round section it would depend on the resultant speed, which is larger.  Lift and
    the change of buoyancy are left out.

    Examples
    --------
    Table 7 of [1]_ prints 84.21 and 70.25 N/m at time 0; with a length that matches the period, the
    hose at its own depth and 1025 kg/m3 the result is this.

    >>> from reduction.prediction.wave_load import immerse_hose
    >>> from reduction.prediction.wave_theory import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0,
    ...                  elevation=float(hose.centre_elevation))
    >>> load = wave_load(wave, hose, 0.0)
    >>> print(load.horizontal_classic.round(2), load.horizontal.round(2))
    [89.51] [74.69]
    """
    factors = load_factors(
        section,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
        water_density=water_density,
        vertical_width=vertical_width,
    )
    current = float(as_finite("current_velocity", current_velocity))
    motion = particle_motion(wave, time, position)
    along, upwards = motion.horizontal_velocity + current, motion.vertical_velocity
    along_squared, upwards_squared = along * np.abs(along), upwards * np.abs(upwards)
    drag = np.multiply.outer(factors.horizontal_drag, along_squared)
    lift = np.multiply.outer(factors.vertical_drag, upwards_squared)

    def times(factor: Floats, series: Floats) -> Floats:
        return np.asarray(np.multiply.outer(factor, series))

    return _WaveLoad(
        time=np.atleast_1d(np.array(time, dtype=np.float64)),
        horizontal=drag + times(factors.inertia, motion.horizontal_acceleration),
        vertical=lift + times(factors.inertia, motion.vertical_acceleration),
        horizontal_classic=times(factors.classic_drag, along_squared)
        + times(factors.classic_inertia, motion.horizontal_acceleration),
        vertical_classic=times(factors.classic_drag, upwards_squared)
        + times(factors.classic_inertia, motion.vertical_acceleration),
        horizontal_drag=np.asarray(drag),
        vertical_drag=np.asarray(lift),
        section=section,
    )


@dataclass(frozen=True)
@read_only_arrays
class _LoadRange:
    """Greatest and least value over a period; arrays have the shape (...).

    Loads are in [N m-1]; times in [s], from 0 to the period, of one occurrence.
    """

    maximum: Floats
    minimum: Floats
    time_of_maximum: Floats
    time_of_minimum: Floats

    @property
    def greatest(self) -> Floats:
        """Largest magnitude. [N m-1]."""
        return np.asarray(np.maximum(np.abs(self.maximum), np.abs(self.minimum)))


@dataclass(frozen=True)
class _LoadExtremes:
    """Extremes of the improved and the classic load, in both directions."""

    horizontal: _LoadRange
    vertical: _LoadRange
    horizontal_classic: _LoadRange
    vertical_classic: _LoadRange


def _find_extremes(
    wave: WaveHarmonics,
    section: ImmersedSection,
    *,
    drag_coefficient: float = CODE_OF_HYDROLOGY.drag_coefficient[0],
    inertia_coefficient: float = CODE_OF_HYDROLOGY.inertia_coefficient,
    water_density: float = SEAWATER_DENSITY,
    current_velocity: float = 0.0,
    position: float = 0.0,
    vertical_width: VerticalWidth = "submerged",
) -> _LoadExtremes:
    """Extremes of the loads of `reduction.prediction.wave_load.wave_load` over a period.

    Notes
    -----
    Table 5 of [1]_ has the extreme on a grid of 0.1 s up to 5 s, its Table 6 up to 10 s; both
    miss the extremes of their own formula, by up to 0.4 N/m.

    Examples
    --------
    >>> from reduction.prediction.wave_load import immerse_hose
    >>> from reduction.prediction.wave_theory import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0,
    ...                  elevation=float(hose.centre_elevation))
    >>> extremes = _find_extremes(wave, hose)
    >>> print(extremes.horizontal_classic.maximum.round(2), extremes.horizontal.maximum.round(2))
    94.35 79.3
    """
    factors = load_factors(
        section,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
        water_density=water_density,
        vertical_width=vertical_width,
    )
    current = float(as_finite("current_velocity", current_velocity))
    along = (
        cosine_series(wave.horizontal_velocity, current),
        sine_series(wave.horizontal_acceleration),
    )
    upwards = sine_series(wave.vertical_velocity), cosine_series(wave.vertical_acceleration)

    def of(motion: tuple[Coefficients, Coefficients], drag: Floats, inertia: Floats) -> _LoadRange:
        return _load_range(
            *motion, drag=drag, inertia=inertia, wave_number=wave.wave_number,
            angular_frequency=wave.angular_frequency, position=position,
        )  # fmt: skip

    return _LoadExtremes(
        horizontal=of(along, factors.horizontal_drag, factors.inertia),
        vertical=of(upwards, factors.vertical_drag, factors.inertia),
        horizontal_classic=of(along, factors.classic_drag, factors.classic_inertia),
        vertical_classic=of(upwards, factors.classic_drag, factors.classic_inertia),
    )


def _load_range(
    velocity: Coefficients,
    acceleration: Coefficients,
    *,
    drag: ArrayLike,
    inertia: ArrayLike,
    wave_number: float,
    angular_frequency: float,
    position: float = 0.0,
) -> _LoadRange:
    """Greatest and least value of drag u|u| + inertia du/dt over a period.

    Notes
    -----
    The load is computed at the phases of *all* roots of both branches with its true sign.  The
    extremes are among them, and no other phase gives more, so no root has to be judged.

    A wave of more than 20 harmonics is computed at 256 phases per harmonic, since the time for the
    roots grows with the cube of their number.

    Examples
    --------
    2 cos|cos| + sin: the greatest value is at sin = 1/4.

    >>> u, a = cosine_series(np.array([1.0])), sine_series(np.array([1.0]))
    >>> extremes = _load_range(u, a, drag=2.0, inertia=1.0, wave_number=1.0, angular_frequency=1.0)
    >>> print(extremes.maximum.round(6))
    2.125
    """
    drag_factor, inertia_factor = np.broadcast_arrays(
        as_finite("drag", drag), as_finite("inertia", inertia)
    )
    place = float(as_finite("position", position))
    squared = 2 * series_product(velocity, phase_derivative(velocity))
    slope = phase_derivative(acceleration)
    beside = (squared.size - slope.size) // 2
    slope = np.pad(slope, beside)
    n_harmonics = velocity.size // 2
    if n_harmonics > _MOST_ROOTED:
        phase = np.broadcast_to(
            np.linspace(0.0, 2 * pi, 256 * n_harmonics), (*drag_factor.shape, 256 * n_harmonics)
        )
    else:
        candidates = [
            root_phases(
                sign * np.multiply.outer(drag_factor, squared)
                + np.multiply.outer(inertia_factor, slope)
            )
            for sign in (1.0, -1.0)
        ]
        phase = np.concatenate(candidates, axis=-1)
    speed = sum_at(velocity, phase)
    load = drag_factor[..., None] * speed * np.abs(speed)
    load += inertia_factor[..., None] * sum_at(acceleration, phase)
    time = np.mod(wave_number * place - phase, 2 * pi) / angular_frequency
    high, low = (pick(load, axis=-1, keepdims=True) for pick in (np.argmax, np.argmin))

    def at(values: Floats, index: np.ndarray) -> Floats:
        return np.asarray(np.take_along_axis(values, index, axis=-1)[..., 0])

    return _LoadRange(
        maximum=at(load, high),
        minimum=at(load, low),
        time_of_maximum=at(time, high),
        time_of_minimum=at(time, low),
    )


@dataclass(frozen=True)
@read_only_arrays
class _LoadDifference:
    """Classic less improved load over the classic one."""

    horizontal_of_maximum: Floats
    horizontal_of_minimum: Floats
    vertical_of_maximum: Floats
    vertical_of_minimum: Floats


def _load_difference(extremes: _LoadExtremes) -> _LoadDifference:
    """Reduction of the extremes of the improved load relative to those of the classic one.

    Notes
    -----
    Eq. (18) and (19) of [1]_.  Drag and inertia vanish at different times and are reduced by
    different shares, so the two loads pass zero at different times, where P of eq. (19) is
    arbitrary: 35.85 % in Table 7 occurs at 8 % of the greatest load.  Its mean over a period does
    not exist, and that of Table 8 depends on the chosen times.  The differences of the extremes
    do not have this problem.

    Examples
    --------
    Drag is reduced by 1 - h/D and inertia by 1 - S1/S0, the load by a value between.

    >>> from reduction.prediction.wave_load import _find_extremes
    >>> from reduction.prediction.wave_load import immerse_hose
    >>> from reduction.prediction.wave_theory import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> difference = _load_difference(_find_extremes(wave, hose))
    >>> print(difference.horizontal_of_maximum.round(4))
    0.1595
    """
    along, upwards = extremes.horizontal, extremes.vertical
    classic_along, classic_upwards = extremes.horizontal_classic, extremes.vertical_classic
    return _LoadDifference(
        horizontal_of_maximum=_cut(along.maximum, classic_along.maximum),
        horizontal_of_minimum=_cut(along.minimum, classic_along.minimum),
        vertical_of_maximum=_cut(upwards.maximum, classic_upwards.maximum),
        vertical_of_minimum=_cut(upwards.minimum, classic_upwards.minimum),
    )


def _cut(improved: Floats, classic: Floats) -> Floats:
    """Share by which the improved load is less; NaN where there is no load."""
    return np.asarray(1 - improved / np.where(classic == 0, np.nan, classic))


AIR_DENSITY = 1.225

"""Density of air at sea level, 15 deg C ([4]_). [kg m-3]"""


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
    [1]_ names the load in eq. (4) but gives no formula; this is drag on D - h.  A wind speed stated
    for a height of 10 m is larger than that at the hose.

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
    The drag of eq. (9) of [1]_ with the velocity of the current.

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
    """Greatest horizontal force of wind, wave and current, as a sum and combined.

    Notes
    -----
    Eq. (4) of [1]_, the extreme case with all loads in one direction, adds loads.  It lacks the
    cross term 2 u U of the squared velocity, so the sum is too low where the current follows the
    wave, which is the intended case.  Where the current opposes the wave, the term reduces the load
    under the crest, and the sum is too high.

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

    def water(velocity: float) -> _LoadRange:
        return _find_extremes(
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
    """The extreme that gives the larger magnitude together with the steady force."""
    return np.asarray(
        np.where(np.abs(steady + maximum) >= np.abs(steady + minimum), maximum, minimum)
    )


_SAME_LENGTH = 0.005  # between theories

_SMALL_ERROR = 0.05

"""Error of a greatest load relative to the stream function that needs no message."""


@dataclass(frozen=True)
class PredictedWaveLoad:
    """Loads per length over time, their extremes, and the flow regime.

    ``elevation`` is the level of the water motion, upwards from the mean level [m]; ``used`` the
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
    load: _WaveLoad
    extremes: _LoadExtremes
    difference: _LoadDifference
    regime: _FlowRegime
    anchor: _AnchorForce
    notes: tuple[Note, ...]


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
    wave_theory: Literal[
        "auto", "airy", "stokes", "stokes 3", "stokes 5", "cnoidal", "stream function"
    ],
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

    ``auto`` is the stream function.  The error of another theory is the difference of its loads.
    Without ``elevation`` the motion is that at the centre of the hose, or at half the wave height,
    which every crest reaches, where the centre of a light hose lies higher.
    """
    section = immerse_hose(
        outer_diameter=outer_diameter,
        wall_thickness=wall_thickness,
        wall_density=wall_density,
        content_density=content_density,
        water_density=water_density,
    )
    used: WaveTheoryName = "stream function" if wave_theory == "auto" else wave_theory
    described = describe_wave(
        wave_height=wave_height,
        wave_period=wave_period,
        water_depth=water_depth,
        wave_length=wave_length,
        current_velocity=current_velocity,
        asked=used,
    )
    centre = outer_diameter / 2 - float(section.immersion_depth)
    at = min(centre, wave_height / 2) if elevation is None else elevation

    def wave_by(theory: WaveTheoryName) -> WaveHarmonics:
        return regular_wave(
            described,
            wave_height=wave_height,
            wave_period=wave_period,
            water_depth=water_depth,
            elevation=at,
            wave_length=wave_length,
            theory=theory,
            current_velocity=current_velocity,
        )

    wave = wave_by(used)
    given = {
        "drag_coefficient": drag_coefficient,
        "inertia_coefficient": inertia_coefficient,
        "water_density": water_density,
        "current_velocity": current_velocity,
    }
    load = wave_load(wave, section, time, vertical_width=vertical_width, **given)
    extremes = _find_extremes(wave, section, vertical_width=vertical_width, **given)
    regime = _flow_regime(
        wave,
        outer_diameter,
        current_velocity=current_velocity,
        drag_coefficient=drag_coefficient,
        inertia_coefficient=inertia_coefficient,
    )
    notes = list(described.reasons)
    notes += _outside_usual(
        wall_density=wall_density, water_density=water_density, air_density=air_density,
        drag_coefficient=drag_coefficient, wind_drag_coefficient=wind_drag_coefficient,
        inertia_coefficient=inertia_coefficient, current_velocity=abs(current_velocity),
        wind_velocity=abs(wind_velocity),
    )  # fmt: skip
    slender = float(regime.diameter_to_length)
    if slender > GREATEST_DIAMETER_TO_LENGTH:
        notes.append(note("hose-scatters-wave", share=slender, most=GREATEST_DIAMETER_TO_LENGTH))
    length = 2 * pi / wave.wave_number
    if abs(length / described.wave_length - 1) > _SAME_LENGTH:
        notes.append(note("high-wave-is-longer", theory=used, length=length))
    if used != "stream function":
        if used != described.theory:
            notes.append(note("theory-asked-for", theory=used, usual=described.theory))
        try:
            true = _find_extremes(
                wave_by("stream function"), section, vertical_width=vertical_width, **given
            )
        except (DataError, FitError):
            notes.append(note("theory-error-unknown", theory=used))
        else:
            errors = _error_words(extremes, true)
            notes += [note("theory-does-not-hold", theory=used, errors=errors)] if errors else []
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
        difference=_load_difference(extremes),
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
        notes=by_severity(notes),
    )


# in SI: outside of these, a unit or a decimal place is more likely to be wrong
_USUAL = {
    "wall_density": (50.0, 9000.0, " kg/m3"), "water_density": (950.0, 1250.0, " kg/m3"),
    "air_density": (0.9, 1.6, " kg/m3"), "drag_coefficient": (0.2, 4.0, ""),
    "wind_drag_coefficient": (0.2, 4.0, ""), "inertia_coefficient": (1.0, 3.0, ""),
    "current_velocity": (0.0, 4.0, " m/s"), "wind_velocity": (0.0, 90.0, " m/s"),
}  # fmt: skip


def _outside_usual(**stated: float) -> list[Note]:
    """Find numbers that are not those of a hose at sea."""
    return [
        note("wave-number-outside-band", name=name, value=one, low=low, high=high, unit=unit)
        for name, one in stated.items()
        for low, high, unit in [_USUAL[name]]
        if not low <= one <= high
    ]


def _error_words(found: _LoadExtremes, true: _LoadExtremes) -> str:
    """Errors of the greatest loads of a theory, by the stream function; empty where small."""
    said = []
    for name in ("horizontal", "vertical"):
        own, right = (float(getattr(one, name).greatest) for one in (found, true))
        # far below the surface there is no motion
        if right > 0 and abs(own / right - 1) > _SMALL_ERROR:
            size = f"{100 * abs(own / right - 1):.0f} %"
            said.append(f"greatest {name} load is {size} too {'high' if own > right else 'low'}")
    return " and the ".join(said)

r"""How deep a hose floats, from its weight.

.. math::
   S_1 = \frac{\rho_2 (S_0 - S_b) + \rho_3 S_b}{\rho_1}, \qquad
   S_1 = \frac{D^2}{8} (\beta - \sin\beta), \qquad h = D \sin^2\frac{\beta}{4}

with the bore S_b, and beta the angle at the centre over the part under water (2 pi - 2 theta
in [1]_).

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 4-8 and 11, Table 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError, FitError
from reduction.record import Bools, Floats, read_only_arrays

_STEP = 1e-14  # last Newton step over the root, at most
_MOST_STEPS = 50
_SERIES_TERMS = 10  # of beta - sin beta up to beta = 1: the last is below 1e-21 of the first


@dataclass(frozen=True)
@read_only_arrays
class ImmersedSection:
    """Cross section of a floating hose, still water.  Arrays have the shape (...) of the hoses.

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
        """Of the whole cylinder, S_0. [m2]."""
        return np.asarray(pi * self.outer_diameter**2 / 4)

    @property
    def submerged_share(self) -> Floats:
        """Of the section. [1]."""
        return np.asarray(self.submerged_section_area / self.section_area)

    @property
    def emergent_height(self) -> Floats:
        """Highest point above the surface. [m]."""
        return np.asarray(self.outer_diameter - self.immersion_depth)

    @property
    def centre_elevation(self) -> Floats:
        """Of the axis above the surface; below zero once more than half is under. [m]."""
        return np.asarray(self.outer_diameter / 2 - self.immersion_depth)

    @property
    def submerged_width(self) -> Floats:
        """Of the part under water, seen from below. [m].

        The chord at the waterline, and D once more than half is under.
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

    Parameters
    ----------
    outer_diameter : array_like, shape (...)
        Of the hose. [m]
    wall_thickness : array_like, shape (...)
        Of the hose, below half its diameter. [m]
    wall_density : array_like, shape (...)
        Mass over volume of the wall, buoyancy layers included. [kg m-3]
    content_density : array_like, shape (...)
        Of what fills the bore; 0 for an empty hose. [kg m-3]
    water_density : array_like, shape (...)
        Of the sea. [kg m-3]

    Returns
    -------
    section : ImmersedSection
        Arrays of shape (...).

    Raises
    ------
    DataError
        If a number is not positive, the wall fills the bore, or the hose is heavier than water.
    FitError
        If the immersion depth is not found.

    Notes
    -----
    Eq. (6) of [1]_.  Eq. (5) leaves out the acceleration of free fall, which cancels.

    An empty hose is taken as round; a collapsible one lies flat, which [1]_ says and does not
    compute.

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
    _refuse(content_mass < 0, "content_density is below zero", content_mass, "0 or more kg/m3")
    bore = diameter - 2 * wall
    _refuse(bore < 0, "the wall is thicker than half the hose", wall, "at most half the diameter")
    bore_share = (bore / diameter) ** 2
    mass = wall_mass * (1 - bore_share) + content_mass * bore_share
    is_sinking = mass > water
    if np.any(is_sinking):
        first = int(np.flatnonzero(np.ravel(is_sinking))[0])
        raise DataError(
            f"{int(np.sum(is_sinking))} of {mass.size} hoses are heavier than water, "
            f"first at index {first}",
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
        immersion_depth=immersion_depth_of(area, diameter),
    )


def immersion_depth_of(submerged_section_area: ArrayLike, outer_diameter: ArrayLike) -> Floats:
    """Depth of a circular segment of this area.

    Parameters
    ----------
    submerged_section_area : array_like, shape (...)
        From 0 to that of the whole circle. [m2]
    outer_diameter : array_like, shape (...)
        Of the circle. [m]

    Returns
    -------
    immersion_depth : ndarray, shape (...)
        From 0 to the diameter. [m]

    Raises
    ------
    DataError
        If a diameter is not positive, or an area is below zero or above the circle.
    FitError
        If the last Newton step is not below 1e-14 of the root.

    Notes
    -----
    Eq. (8) of [1]_ in the angle beta of the smaller one of the two segments, which is
    Kepler's equation on its edge.  The start, beta^3 = 6 (beta - sin beta), is below the root;
    the first step goes above it, and beta - sin beta is convex up to pi, so that the steps
    behind it fall without passing the root.  Below beta = 1 the difference is summed as a
    series: it would lose its digits.

    Examples
    --------
    Half a circle, and nearly none.

    >>> print(immersion_depth_of([np.pi / 8, 1e-12], 1.0))
    [5.00000000e-01 8.25481814e-09]
    """
    area, diameter = np.broadcast_arrays(
        as_finite("submerged_section_area", submerged_section_area),
        as_positive("outer_diameter", outer_diameter),
    )
    share = area / (pi * diameter**2 / 4)
    _refuse(
        (share < 0) | (share > 1 + 4e-16), "no segment of the circle is this large", area,
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


def _refuse(bad: Bools, problem: str, values: Floats, needed: str) -> None:
    if not np.any(bad):
        return
    first = int(np.flatnonzero(np.ravel(bad))[0])
    raise DataError(
        f"{problem}: {int(np.sum(bad))} of {bad.size}, first at index {first}",
        found=f"{np.ravel(values)[first]:g} in SI",
        needed=needed,
    )

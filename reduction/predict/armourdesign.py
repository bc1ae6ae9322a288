r"""What an armour prediction takes and gives.

Angles are from the axis of the cable.  Of a wire, the tangent, the inward normal and the binormal
are its axes; curvature is about the binormal, torsion about the tangent.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import pi
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.record import Bools, Floats, read_only_arrays

ArmourTheory = Literal["small", "intermediate", "large", "exact", "conjugate"]

ARMOUR_THEORIES: tuple[ArmourTheory, ...] = (
    "small",
    "intermediate",
    "large",
    "exact",
    "conjugate",
)
"""In the order of tables: three of the report, the rod they simplify, the rod of an energy."""


@dataclass(frozen=True)
@read_only_arrays
class ArmourDesign:
    """Round wires in a helix on a rigid core, one layer or many designs at once.

    Numbers are floats or arrays that broadcast to the shape (...) of the designs.

    Parameters
    ----------
    winding_angle : float or ndarray, shape (...)
        Of the wires at rest, from the axis. [rad]
    wire_radius : float or ndarray, shape (...)
        Of one wire. [m]
    core_radius : float or ndarray, shape (...)
        Of what the wires lie on; the helix of their centres has this and a wire radius. [m]
    elastic_modulus : float or ndarray, shape (...)
        Young's modulus of the wires. [Pa]
    poisson_ratio : float or ndarray, shape (...)
        Of the wires. [1]
    n_wires : int or ndarray, shape (...)
        Side by side in the layer. [1]
    """

    winding_angle: float | Floats
    wire_radius: float | Floats
    core_radius: float | Floats
    elastic_modulus: float | Floats
    poisson_ratio: float | Floats = 0.3
    n_wires: float | Floats = 1

    def __post_init__(self) -> None:
        """Check ranges, and make the arrays read-only."""
        angle = np.asarray(self.winding_angle, dtype=np.float64)
        _need("winding_angle", angle, (angle > 0) & (angle < pi / 2), "between 0 and 90 deg")
        for name in ("wire_radius", "core_radius", "elastic_modulus"):
            number = np.asarray(getattr(self, name), dtype=np.float64)
            _need(name, number, (number > 0) & np.isfinite(number), "above zero")
        ratio = np.asarray(self.poisson_ratio, dtype=np.float64)
        _need("poisson_ratio", ratio, (ratio > -1) & (ratio < 0.5), "between -1 and 0.5")
        count = np.asarray(self.n_wires, dtype=np.float64)
        _need("n_wires", count, (count >= 1) & (count % 1 == 0), "a whole number, 1 or more")

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the designs together; () for one."""
        return np.broadcast_shapes(*(np.shape(getattr(self, item.name)) for item in fields(self)))

    @property
    def helix_radius(self) -> Floats:
        """From the axis to the centre of a wire, shape (...). [m]."""
        return np.asarray(np.asarray(self.core_radius, dtype=np.float64) + self.wire_radius)

    @property
    def wire_area(self) -> Floats:
        """Cross section of one wire, shape (...). [m2]."""
        return np.asarray(pi * np.asarray(self.wire_radius, dtype=np.float64) ** 2)

    @property
    def axial_stiffness(self) -> Floats:
        """E A of one wire along itself, shape (...). [N]."""
        return np.asarray(self.elastic_modulus * self.wire_area)

    @property
    def bending_stiffness(self) -> Floats:
        """E I of one wire, shape (...). [N m2]."""
        return np.asarray(self.axial_stiffness * np.asarray(self.wire_radius) ** 2 / 4)

    @property
    def torsion_stiffness(self) -> Floats:
        """G J of one wire, shape (...). [N m2]."""
        return np.asarray(self.bending_stiffness / (1 + np.asarray(self.poisson_ratio)))


def _need(name: str, value: Floats, is_good: Bools, needed: str) -> None:
    if np.all(is_good):
        return
    bad = np.atleast_1d(~is_good)
    found = np.atleast_1d(value)[bad].flat[0]
    where = "" if bad.size == 1 else f" of {int(bad.sum())} of {bad.size} designs"
    raise SettingsError(f"{name}{where} is no armour", found=f"{found:g} in SI", needed=needed)


@dataclass(frozen=True)
@read_only_arrays
class ArmourResponse:
    """Response of one wire at each strain of the cable.  Arrays have the shape (..., n_strain).

    Parameters
    ----------
    theory : {"small", "intermediate", "large", "exact", "conjugate"}
        Which gave it.
    strain : ndarray, shape (n_strain,)
        Of the cable along its axis. [1]
    wire_strain : ndarray
        Of the wire along itself. [1]
    current_winding_angle, angle_change : ndarray
        From the axis; the change is below zero in extension.  NaN by the theory of large
        angles, which does not say. [rad]
    curvature_change, torsion_change : ndarray
        Those that make the moments. [m-1]
    axial_force, shear_force : ndarray
        On the section of a wire along the tangent (T) and the binormal (N'). [N]
    bending_moment, torsion_moment : ndarray
        G', above zero where it bends the wire more, and H. [N m]
    axial_stress, bending_stress, torsion_stress : ndarray
        Of the axial force; greatest of the bending moment and of the torsion moment on the
        section, with the sign of the moment. [Pa]
    tension, torque : ndarray
        What the wire adds to the tension of the cable and to its torque about the axis; a
        right-handed wire in extension has a torque above zero. [N], [N m]
    contact_line_load : ndarray
        Outwards, by the core on the wire, per length of the wire. [N m-1]
    is_lifted : ndarray of bool
        The core would have to pull: the wire leaves it, and no theory here holds.
    """

    theory: ArmourTheory
    strain: Floats
    wire_strain: Floats
    current_winding_angle: Floats
    angle_change: Floats
    curvature_change: Floats
    torsion_change: Floats
    axial_force: Floats
    shear_force: Floats
    bending_moment: Floats
    torsion_moment: Floats
    axial_stress: Floats
    bending_stress: Floats
    torsion_stress: Floats
    tension: Floats
    torque: Floats
    contact_line_load: Floats
    is_lifted: Bools


@dataclass(frozen=True)
class Wire:
    """Numbers of a design with an axis of strain behind them, shape (..., 1)."""

    angle: Floats
    sine: Floats
    cosine: Floats
    wire_radius: Floats
    helix_radius: Floats
    area: Floats
    axial_stiffness: Floats
    bending_stiffness: Floats
    torsion_stiffness: Floats

    @classmethod
    def of(cls, design: ArmourDesign) -> Wire:
        """Spread a design."""
        angle = _behind(design.winding_angle)
        return cls(
            angle=angle,
            sine=np.sin(angle),
            cosine=np.cos(angle),
            wire_radius=_behind(design.wire_radius),
            helix_radius=_behind(design.helix_radius),
            area=_behind(design.wire_area),
            axial_stiffness=_behind(design.axial_stiffness),
            bending_stiffness=_behind(design.bending_stiffness),
            torsion_stiffness=_behind(design.torsion_stiffness),
        )


def _behind(value: ArrayLike) -> Floats:
    return np.asarray(value, dtype=np.float64)[..., None]


@dataclass(frozen=True)
class Deformed:
    """How a wire is deformed: strains, and the helix on which its forces are in balance."""

    wire_strain: Floats
    angle_change: Floats
    curvature_change: Floats
    torsion_change: Floats
    balance_angle: Floats


def respond(
    wire: Wire, theory: ArmourTheory, strain: Floats, is_as: Deformed, axial_force: Floats
) -> ArmourResponse:
    """Give forces, moments and stresses of a deformed wire.

    Equations 4 (torsion with the torsional stiffness), 6, 17-19 of the module's reference.
    """
    shape = np.broadcast_shapes(wire.angle.shape, wire.area.shape, wire.helix_radius.shape,
                                wire.torsion_stiffness.shape, strain.shape)  # fmt: skip
    sine, cosine = np.sin(is_as.balance_angle), np.cos(is_as.balance_angle)
    curvature, torsion = sine**2 / wire.helix_radius, sine * cosine / wire.helix_radius
    bending_moment = wire.bending_stiffness * is_as.curvature_change
    torsion_moment = wire.torsion_stiffness * is_as.torsion_change
    shear_force = torsion_moment * curvature - bending_moment * torsion  # eq (6), fourth line
    contact = axial_force * curvature - shear_force * torsion  # -X1 of eq (6), first line
    section_modulus = wire.area * wire.wire_radius / 4
    across = axial_force * sine - shear_force * cosine
    numbers = {
        "wire_strain": is_as.wire_strain,
        "current_winding_angle": wire.angle + is_as.angle_change,
        "angle_change": is_as.angle_change,
        "curvature_change": is_as.curvature_change,
        "torsion_change": is_as.torsion_change,
        "axial_force": axial_force,
        "shear_force": shear_force,
        "bending_moment": bending_moment,
        "torsion_moment": torsion_moment,
        "axial_stress": axial_force / wire.area,
        "bending_stress": bending_moment / section_modulus,
        "torsion_stress": torsion_moment / (2 * section_modulus),
        "tension": axial_force * cosine + shear_force * sine,
        "torque": wire.helix_radius * across + torsion_moment * cosine + bending_moment * sine,
        "contact_line_load": contact,
        "is_lifted": contact < 0,
    }
    spread = {name: np.broadcast_to(number, shape) for name, number in numbers.items()}
    return ArmourResponse(theory=theory, strain=strain, **spread)

r"""Helical armour: design, forces by each theory, several layers.

**Input and output of an armour prediction.** Angles are measured from the axis of the cable.  The
axes of a wire are its tangent, inward normal and binormal; curvature is about the binormal, torsion
about the tangent.

**Theories of small, intermediate and large winding angles.** All three are of first order in the
strain.  The theory of intermediate angles is the first term of the rod below; that of small angles
is the same except for the change of angle, which it takes from a cosine; that of large angles is a
close-coiled spring without a core.

**Exact geometry of a wire on a rigid core, with two laws of its moments.** Neither core nor cable
turns, so the helix of the wire centre follows

.. math:: (1+\zeta)\cos\bar\alpha = (1+\varepsilon)\cos\alpha,\qquad
   (1+\zeta)\sin\bar\alpha = \sin\alpha

``exact`` is the rod from which the theories of small and intermediate angles follow to first order:
moments depend on the change of curvature and torsion *per current length*, the axial force on the
strain alone.  These do not derive from an energy: with :math:`U = \tfrac12(EA\zeta^2 +
EI\Delta\kappa^2 + GJ\Delta\tau^2)` per rest length of wire, virtual work gives

.. math:: \frac{1}{\cos\alpha}\frac{dU}{d\varepsilon} - (T\cos\bar\alpha + N'\sin\bar\alpha)
   = -\cos\bar\alpha\,(G'\bar\kappa' + H\bar\tau)

a share of order :math:`(R_2/r)^2/4` at any strain, since a curvature per current length changes
even if the wire is only stretched.

``conjugate`` is the rod that derives from an energy and agrees with three-dimensional elasticity.
A curved bar bends as a bundle of fibres: those on the inside of the helix are shorter at rest and
are strained more by the same displacement.  So bending does depend on the curvature per current
length, and causes an axial force.  Torsion is the rotation between two sections over the length of
wire between them at rest: for a straight round wire, any other measure would depend on the choice
of its axes.

.. math:: W = \tfrac12 EA\zeta^2 + \tfrac12 EI\chi^2 + \tfrac12 GJ\vartheta^2,\quad
   \chi = (1+\zeta)(\bar\kappa' - \kappa'),\quad \vartheta = (1+\zeta)\bar\tau - \tau

.. math:: T = EA\zeta - \kappa' G',\quad G' = EI\chi,\quad H = GJ\vartheta,\quad
   T\cos\bar\alpha + N'\sin\bar\alpha = \frac{1}{\cos\alpha}\frac{dW}{d\varepsilon}

Its torsion moment is :math:`GJ\varepsilon\sin^3\alpha\cos\alpha/r` to the first order: it does not
vanish at 45 deg and does not change sign.  The bending moment is that of ``exact``; its relative
uncertainty is nu/2, since thinning of the wire moves its fibres by as much as bending does.

**Tension and torque of an armour layer for a small strain and twist of the cable.** From the same
energy, with the core twisted by :math:`\theta` per length:
:math:`(1+\zeta)\sin\bar\alpha = \sin\alpha + r\theta\cos\alpha`.

.. math:: K = \frac{n}{\cos\alpha} V^T \operatorname{diag}(EA, EI, GJ)\, V,\quad
   V = \begin{pmatrix} \cos^2\alpha & r\sin\alpha\cos\alpha \\
   -2\sin^2\alpha\cos^2\alpha/r & 2\sin\alpha\cos^3\alpha \\
   \sin^3\alpha\cos\alpha/r & \cos^4\alpha \end{pmatrix}

**Load on a cable with several armour layers.** Each layer lies on its own core, which is rigid and
does not turn, so that all layers have the strain of the cable and squeeze what is inside them.  The
terminations have to hold the torque that the layers leave unbalanced.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 2; sec. 3; sec. 3.1; sec. 5; sec. 3.1
   and 5.3; sec. 5.3.
.. [2] A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, 4th ed., Cambridge Univ.
   Press, 1944, ch. 18-19.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from math import pi
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.hose_geometry import cord_stretch_ratio, hose_stretch_ratio
from reduction.record.arrays import as_increasing, require_of_design, runs_of_true
from reduction.record.errors import FitError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note

ArmourTheory = Literal["small", "intermediate", "large", "exact", "conjugate"]

ARMOUR_THEORIES: tuple[ArmourTheory, ...] = (
    "small",
    "intermediate",
    "large",
    "exact",
    "conjugate",
)
"""In the order of tables: three of the report, the rod they simplify, the rod with an energy."""


@dataclass(frozen=True)
@read_only_arrays
class ArmourDesign:
    """Round wires in a helix on a rigid core, one layer or many designs at once.

    Numbers are floats or arrays that broadcast to the shape (...) of the designs.

    Parameters
    ----------
    winding_angle : float or ndarray, shape (...)
        Angle of the wires at rest, from the axis. [rad]
    wire_radius : float or ndarray, shape (...)
        Radius of one wire. [m]
    core_radius : float or ndarray, shape (...)
        Radius under the wires; the helix radius of their centres is this plus a wire radius. [m]
    elastic_modulus : float or ndarray, shape (...)
        Young's modulus of the wires. [Pa]
    poisson_ratio : float or ndarray, shape (...)
        Poisson's ratio of the wires. [1]
    n_wires : int or ndarray, shape (...)
        Number of wires in the layer. [1]
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
        """Common shape of the designs; () for one."""
        return np.broadcast_shapes(*(np.shape(getattr(self, item.name)) for item in fields(self)))

    @property
    def helix_radius(self) -> Floats:
        """Distance from the axis to the centre of a wire, shape (...). [m]."""
        return np.asarray(np.asarray(self.core_radius, dtype=np.float64) + self.wire_radius)

    @property
    def wire_area(self) -> Floats:
        """Cross section of one wire, shape (...). [m2]."""
        return np.asarray(pi * np.asarray(self.wire_radius, dtype=np.float64) ** 2)

    @property
    def axial_stiffness(self) -> Floats:
        """E A of one wire along its own axis, shape (...). [N]."""
        return np.asarray(self.elastic_modulus * self.wire_area)

    @property
    def bending_stiffness(self) -> Floats:
        """E I of one wire, shape (...). [N m2]."""
        return np.asarray(self.axial_stiffness * np.asarray(self.wire_radius) ** 2 / 4)

    @property
    def torsion_stiffness(self) -> Floats:
        """G J of one wire, shape (...). [N m2]."""
        return np.asarray(self.bending_stiffness / (1 + np.asarray(self.poisson_ratio)))


_UNITS = {
    "winding_angle": "deg",
    "wire_radius": "m",
    "core_radius": "m",
    "elastic_modulus": "Pa",
    "yield_stress": "Pa",
}
"""Units of the numbers in messages; the others are ratios."""


def _need(name: str, value: Floats, is_good: Bools, needed: str) -> None:
    unit = _UNITS.get(name, "")
    require_of_design("an armour", name, value, is_good, needed, unit)


@dataclass(frozen=True)
@read_only_arrays
class _ArmourResponse:
    """Response of one wire at each strain of the cable.  Arrays have the shape (..., n_strain)."""

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
class _Wire:
    """Parameters of a design with an additional axis for strain, shape (..., 1)."""

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
    def of(cls, design: ArmourDesign) -> _Wire:
        """Expand a design."""
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
class _Deformed:
    """Deformation of a wire: strains, and the helix on which its forces are in equilibrium."""

    wire_strain: Floats
    angle_change: Floats
    curvature_change: Floats
    torsion_change: Floats
    balance_angle: Floats


def _respond(
    wire: _Wire, theory: ArmourTheory, strain: Floats, is_as: _Deformed, axial_force: Floats
) -> _ArmourResponse:
    """Compute forces, moments and stresses of a deformed wire.

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
    return _ArmourResponse(theory=theory, strain=strain, **spread)


_STEPS = 40  # each doubles the digits near the solution; the slowest start needs about ten


def _wire_gap(design: ArmourDesign) -> Floats:
    r"""Gap between neighbouring wires at rest, from the least distance of their centre lines.

    .. math:: \min_\psi r\sqrt{2(1 - \cos\psi) + \cot^2\!\alpha\,(2\pi/n - \psi)^2} - 2 R_2

    Notes
    -----
    The angle of the nearest point is the root of :math:`\sin\psi = \cot^2\!\alpha(2\pi/n - \psi)`.
    The difference of the two sides is concave up to half a turn and negative at first, so
    Newton steps from zero approach the first root and never pass it.  Geometry of [1]_, sec.
    2, Figure 2.

    Examples
    --------
    Nearly straight wires as thick as their core: six would just fit, as in a strand of seven

    >>> design = ArmourDesign(1e-9, 1.0, 1.0, 210e9, n_wires=np.array([5, 7]))
    >>> print(_wire_gap(design).round(3))
    [ 0.351 -0.264]
    """
    angle = np.asarray(design.winding_angle, dtype=np.float64)
    slope = 1 / np.tan(angle) ** 2
    neighbour = 2 * pi / np.asarray(design.n_wires, dtype=np.float64)
    farthest = np.minimum(neighbour, pi)
    place = np.zeros(np.broadcast_shapes(slope.shape, neighbour.shape))
    for _ in range(_STEPS):
        rise = np.cos(place) + slope
        miss = slope * (neighbour - place) - np.sin(place)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(rise > 0, miss / rise, pi)
        place = np.clip(place + step, 0, farthest)
    square = 2 * (1 - np.cos(place)) + slope * (neighbour - place) ** 2
    return np.asarray(design.helix_radius * np.sqrt(square) - 2 * np.asarray(design.wire_radius))


def _predict_intermediate(design: ArmourDesign, strain: Floats) -> _ArmourResponse:
    r"""Response of a wire to the first order in the strain.

    .. math:: \zeta = \varepsilon\cos^2\alpha,\quad \Delta\alpha = -\varepsilon\sin\alpha\cos\alpha,
       \quad \Delta\kappa' = -2\varepsilon\sin^2\alpha\cos^2\alpha/r,
       \quad \Delta\tau = \varepsilon\sin\alpha\cos\alpha(\sin^2\alpha - \cos^2\alpha)/r

    Notes
    -----
    Source: [1]_, eq. (10)-(19).  The change of angle is current minus rest, as the text defines
    it; (9)-(15) use the opposite.  As printed, the torsion moment of (4) has the bending
    stiffness, 1 + nu times too much, and that of (16) and (19) has :math:`2\sin^2\alpha` where
    (15) gives :math:`1 - 2\cos^2\alpha`.  Computed here: (15) with the torsional stiffness,

    .. math:: N' = H\sin^2\alpha/r - G'\sin\alpha\cos\alpha/r

    Examples
    --------
    At 45 deg the torsion does not change, and the bending moment is greatest:

    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = _predict_intermediate(design, np.array([1e-3]))
    >>> print((wire.axial_stress / 1e6).round(1), abs(wire.torsion_moment).round(9))
    [105.] [0.]
    """
    wire = _Wire.of(design)
    product = wire.sine * wire.cosine
    wire_strain = strain * wire.cosine**2
    is_as = _Deformed(
        wire_strain=wire_strain,
        angle_change=-strain * product,
        curvature_change=-2 * strain * product**2 / wire.helix_radius,
        torsion_change=-strain * product * np.cos(2 * wire.angle) / wire.helix_radius,
        balance_angle=wire.angle,
    )
    return _respond(wire, "intermediate", strain, is_as, wire.axial_stiffness * wire_strain)


def _predict_small(design: ArmourDesign, strain: Floats) -> _ArmourResponse:
    r"""Response of a wire with the change of angle from a cosine.

    .. math:: \cos\bar\alpha = (1 + \varepsilon - \varepsilon\cos^2\alpha)\cos\alpha

    Notes
    -----
    Source: [1]_, eq. (20)-(22), for 0-20 deg.  (20) is (12), so the axial force is that of
    intermediate angles.  (21) is :math:`(1+\varepsilon)/(1+\zeta)` to the first order.  As
    printed, the bending and torsion moments of (22) have the opposite sign to (16), and the
    torsion moment lacks one wire radius; computed here: (14) and (15) with this change of angle.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([10.0, 20.0]), 2.5e-3, 25e-3, 210e9)
    >>> print((_predict_small(design, np.array([1e-3])).axial_force[:, 0] / 1e3).round(3))
    [3.999 3.641]
    """
    wire = _Wire.of(design)
    wire_strain = strain * wire.cosine**2
    with np.errstate(invalid="ignore"):
        change = np.arccos((1 + strain - wire_strain) * wire.cosine) - wire.angle
    is_as = _Deformed(
        wire_strain=wire_strain,
        angle_change=change,
        curvature_change=np.sin(2 * wire.angle) * change / wire.helix_radius,
        torsion_change=np.cos(2 * wire.angle) * change / wire.helix_radius,
        balance_angle=wire.angle,
    )
    return _respond(wire, "small", strain, is_as, wire.axial_stiffness * wire_strain)


def _predict_large(design: ArmourDesign, strain: Floats) -> _ArmourResponse:
    r"""Response of a wire as a close-coiled helical spring, free of the core.

    .. math:: f = \frac{\pi E R_2^4 \varepsilon}{4 (1+\nu) r^2 \tan\alpha},\quad
       T = f\cos\alpha,\quad N' = f\sin\alpha,\quad G' = -f r\cos\alpha,\quad H = f r\sin\alpha

    Notes
    -----
    Source: [1]_, eq. (23)-(29), for 70-90 deg.  (25) has the pitch :math:`2\pi r/\tan\alpha`,
    not the printed :math:`2\pi r\tan\alpha`; (26) leaves out the sine of the torsion moment.
    Shear force and bending moment are not printed: they follow from the statics of a spring with
    ends that are free to turn, and satisfy (6) without core.  This is a different body from a wire
    on a rigid core, not an approximation of it: its axial force is
    :math:`(R_2/r)^2 / (4(1+\nu)\sin\alpha)` of that, 1.8 % at 5 deg and 0.16 % at 80 deg.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(80.0), 2.5e-3, 25e-3, 210e9)
    >>> strain = np.array([1e-3])
    >>> rod = _predict_intermediate(design, strain)
    >>> print((100 * _predict_large(design, strain).axial_force / rod.axial_force).round(2))
    [0.16]
    """
    wire = _Wire.of(design)
    force = wire.torsion_stiffness * strain * wire.cosine / (wire.sine * wire.helix_radius**2)
    arm = force * wire.helix_radius
    axial_force = force * wire.cosine
    is_as = _Deformed(
        wire_strain=axial_force / wire.axial_stiffness,
        angle_change=np.full_like(axial_force, np.nan),
        curvature_change=-arm * wire.cosine / wire.bending_stiffness,
        torsion_change=arm * wire.sine / wire.torsion_stiffness,
        balance_angle=wire.angle,
    )
    return _respond(wire, "large", strain, is_as, axial_force)


def _deform(wire: _Wire, strain: Floats, *, torsion_per_rest_length: bool) -> _Deformed:
    """Deform the helix; every difference is a product, so small strains lose no digits."""
    stretch = cord_stretch_ratio(1 + strain, wire.angle, core="rigid")
    change = -np.arcsin(strain * wire.sine * wire.cosine / stretch)
    wire_strain = strain * (2 + strain) * wire.cosine**2 / (1 + stretch)
    between = 2 * wire.angle + change
    curvature_change = np.sin(change) * np.sin(between) / wire.helix_radius
    torsion_change = np.sin(change) * np.cos(between) / wire.helix_radius
    if torsion_per_rest_length:
        # sin a (cos of current - cos of rest) / r, and the curvature per rest length
        half = -2 * np.sin(change / 2) * np.sin(wire.angle + change / 2)
        torsion_change = wire.sine * half / wire.helix_radius
        curvature_change = stretch * curvature_change
    return _Deformed(
        wire_strain, change, curvature_change, torsion_change, balance_angle=wire.angle + change
    )


def _predict_exact(design: ArmourDesign, strain: Floats) -> _ArmourResponse:
    r"""Response of a wire with the exact helix and the moments of the report.

    .. math:: G' = EI(\bar\kappa' - \kappa'),\quad H = GJ(\bar\tau - \tau),\quad T = EA\zeta

    Notes
    -----
    Source: [1]_, eq. (2)-(8) before linearisation, after [2]_; the printed torsion moment of (4)
    has the bending stiffness.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = _predict_exact(design, np.array([1e-3, 0.1]))
    >>> print((100 * wire.wire_strain).round(5), np.degrees(wire.current_winding_angle).round(4))
    [0.05001 5.11898] [44.9714 42.2737]
    """
    wire = _Wire.of(design)
    is_as = _deform(wire, strain, torsion_per_rest_length=False)
    return _respond(wire, "exact", strain, is_as, wire.axial_stiffness * is_as.wire_strain)


def _predict_conjugate(design: ArmourDesign, strain: Floats) -> _ArmourResponse:
    r"""Response of a wire with the tension that is the derivative of its energy.

    .. math:: T = EA\zeta - \kappa' G',\quad G' = EI(1+\zeta)(\bar\kappa' - \kappa'),\quad
       H = GJ((1+\zeta)\bar\tau - \tau)

    Notes
    -----
    Derived in the module docstring; balance of forces and moments by [1]_, eq. (6).

    Examples
    --------
    The torsion moment at 45 deg, zero in [1]_, sec. 3.1, is to first order GJ strain / (4
    r):

    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = _predict_conjugate(design, np.array([1e-6]))
    >>> print((wire.torsion_moment * 4 * 27.5e-3 / (design.torsion_stiffness * 1e-6)).round(4))
    [1.]
    """
    wire = _Wire.of(design)
    is_as = _deform(wire, strain, torsion_per_rest_length=True)
    rest_curvature = wire.sine**2 / wire.helix_radius
    eccentric = rest_curvature * wire.bending_stiffness * is_as.curvature_change
    axial_force = wire.axial_stiffness * is_as.wire_strain - eccentric
    return _respond(wire, "conjugate", strain, is_as, axial_force)


_PREDICT: dict[ArmourTheory, Callable[[ArmourDesign, Floats], _ArmourResponse]] = {
    "small": _predict_small,
    "intermediate": _predict_intermediate,
    "large": _predict_large,
    "exact": _predict_exact,
    "conjugate": _predict_conjugate,
}


def predict_armour(
    design: ArmourDesign, strain: ArrayLike, *, theory: ArmourTheory = "exact"
) -> _ArmourResponse:
    """Forces, moments and stresses of one wire at each strain of the cable.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : array_like, shape (n_strain,)
        Axial strain of the cable; a number is a series of one. [1]
    theory : {"small", "intermediate", "large", "exact", "conjugate"}
        Three theories of the report; ``exact`` is the rod that the first two simplify,
        ``conjugate`` the one whose forces derive from an energy.

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain).

    Raises
    ------
    SettingsError
        If the theory is unknown, or a strain is not a number above -1.

    Notes
    -----
    Source: [1]_.  The material is elastic at any stress; `reduction.prediction.armour` also
    computes where a wire yields.  The core is rigid; where it gives, or the wire thins on it, the
    wire is strained less (`reduction.prediction.armour._thinning_loss`).  A negative strain is
    computed and flagged: wires under compression lift off the core.

    Examples
    --------
    The steel and the strain of [1]_, sec. 4: stress 210 MPa times the squared cosine

    >>> design = ArmourDesign(np.radians([20.0, 30.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_armour(design, 1e-3, theory="intermediate")
    >>> print((wire.axial_stress[:, 0] / 1e6).round(2))
    [185.43 157.5 6.33]
    """
    if theory not in _PREDICT:
        raise SettingsError(
            "the theory of the armour is not known", found=repr(theory), needed=", ".join(_PREDICT)
        )
    series = np.array(strain, dtype=np.float64, ndmin=1)
    bad = ~(np.isfinite(series) & (series > -1))
    if bad.any():
        raise SettingsError(
            f"{int(bad.sum())} of {series.size} strains are none of a cable, "
            f"first at index {int(np.flatnonzero(bad)[0])}"
            if series.size > 1
            else "the strain is not that of a cable",
            found=f"{series[bad][0]:g}",
            needed="numbers above -1",
        )
    return _PREDICT[theory](design, series)


ARMOUR_QUANTITIES = ("axial_force", "shear_force", "bending_moment", "torsion_moment")
"""The stresses are proportional to the axial force and the moments, and have their errors."""

Reference = Literal["exact", "conjugate"]

SIMPLER_THEORIES: tuple[ArmourTheory, ...] = ("small", "intermediate", "large")


def theory_errors(
    design: ArmourDesign, strain: ArrayLike, *, reference: Reference = "exact"
) -> Floats:
    r"""Error of the theories of small, intermediate and large angles, for each quantity.

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : array_like, shape (n_strain,)
        Strain of the cable. [1]
    reference : {"exact", "conjugate"}
        The rod with the moments of the report, which the theories simplify, or the rod with an
        energy, which shows the effects that those moments leave out.

    Returns
    -------
    errors : ndarray, shape (n_theories, n_quantities, ..., n_strain)
        Of `SIMPLER_THEORIES` and `ARMOUR_QUANTITIES`. [1]

    Raises
    ------
    SettingsError
        If the reference is neither, or the strain is invalid.

    Notes
    -----
    The torsion moment of ``exact`` passes zero near 45 deg, where [1]_, sec. 5.3, finds an error
    of 100 % of a moment that vanishes.  Its error is therefore relative to
    :math:`GJ\sqrt{\Delta\kappa'^2 + \Delta\tau^2}`; errors of the others are relative to their own
    values, which have no zero.

    Examples
    --------
    [1]_, sec. 5.2: the axial force of small and intermediate angles, and of a spring

    >>> design = ArmourDesign(np.radians(20.0), 2.5e-3, 25e-3, 210e9)
    >>> for percent in 100 * theory_errors(design, 1e-3)[:, 0, 0]:
    ...     print(f"{percent:.3f}")
    -0.006
    -0.006
    -99.535
    """
    if reference not in ("exact", "conjugate"):
        raise SettingsError(
            "no theory is held against this", found=repr(reference), needed="exact or conjugate"
        )
    true = predict_armour(design, strain, theory=reference)
    scale = np.abs(_table(true))
    stiffness = np.asarray(design.torsion_stiffness)[..., None]
    scale[-1] = stiffness * np.hypot(true.curvature_change, true.torsion_change)
    each = [_table(predict_armour(design, strain, theory=theory)) for theory in SIMPLER_THEORIES]
    miss = np.stack(each) - _table(true)
    return np.divide(miss, scale, out=np.full_like(miss, np.nan), where=scale > 0)


def _table(response: _ArmourResponse) -> Floats:
    return np.stack([getattr(response, name) for name in ARMOUR_QUANTITIES])


@dataclass(frozen=True)
@read_only_arrays
class _AnglesOfUse:
    """Angles at which each theory holds."""

    winding_angle: Floats
    is_within: Bools
    least_angle: Floats
    greatest_angle: Floats
    statement: tuple[str, ...]


def _angles_of_use(design: ArmourDesign, strain: float, *, tolerance: float) -> _AnglesOfUse:
    """Winding angles at which each theory is within a tolerance, with a statement in words.

    Notes
    -----
    [1]_, sec. 3.2, gives 0-20 and 70-90 deg for the theories of small and large angles, without a
    tolerance.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(np.arange(5.0, 86.0)), 2.5e-3, 25e-3, 210e9)
    >>> use = _angles_of_use(design, 1e-3, tolerance=0.02)
    >>> print(use.statement[2])
    small angles: bending_moment within 2 % of exact at 5-85 deg
    """
    if not tolerance > 0:
        raise SettingsError("tolerance is not above zero", found=f"{tolerance:g}", needed="above 0")
    angle = as_increasing("winding_angle", design.winding_angle)
    is_within = np.abs(theory_errors(design, strain)[..., 0]) <= tolerance
    ends = np.full((*is_within.shape[:2], 2), np.nan)
    sentences = []
    for i, theory in enumerate(SIMPLER_THEORIES):
        for j, quantity in enumerate(ARMOUR_QUANTITIES):
            runs = runs_of_true(is_within[i, j]) - [0, 1]
            if runs.size:
                ends[i, j] = angle[runs[np.argmax(runs[:, 1] - runs[:, 0])]]
            places = ", ".join(_degrees(angle[run]) for run in runs)
            sentences.append(
                f"{theory} angles: {quantity} within {100 * tolerance:g} % of exact "
                + (f"at {places} deg" if places else "nowhere")
            )
    return _AnglesOfUse(
        winding_angle=angle,
        is_within=is_within,
        least_angle=ends[..., 0],
        greatest_angle=ends[..., 1],
        statement=tuple(sentences),
    )


def _degrees(ends: Floats) -> str:
    first, last = np.degrees(ends)
    return f"{first:.4g}" if first == last else f"{first:.4g}-{last:.4g}"


def _thinning_loss(design: ArmourDesign) -> Floats:
    r"""Share of its strain that a wire loses because it thins and moves towards the core.

    .. math:: \frac{\nu (R_2/r)\sin^2\alpha}{1 + \nu (R_2/r)\sin^2\alpha}

    Notes
    -----
    The centre of a wire that rests on the core moves :math:`\nu\zeta R_2` closer to the axis.
    To first order this shortens the helix by :math:`\nu\zeta (R_2/r)\sin^2\alpha`.  The effect is
    larger than the difference between the theories at 0.1 % of strain, and about as large as the
    excess of the theory in [1]_, sec. 5.3, over its numerical results ("because the Poisson effect
    was considered").  Indentation of wire and core is an additional effect, not included.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([20.0, 30.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> print((100 * _thinning_loss(design)).round(2))
    [0.32 0.68 2.58]
    """
    slender = np.asarray(design.wire_radius) / design.helix_radius
    shorter = np.asarray(design.poisson_ratio) * slender * np.sin(design.winding_angle) ** 2
    return np.asarray(shorter / (1 + shorter))


@dataclass(frozen=True)
@read_only_arrays
class _LayerStiffness:
    """Stiffness of layers at rest; arrays have the shape (...) of the designs.

    ``torque_per_strain`` is also the tension per twist, for right-handed wires; for left-handed
    wires the sign is opposite.
    """

    tension_per_strain: Floats
    torque_per_strain: Floats
    torque_per_twist: Floats


def _layer_stiffness(design: ArmourDesign) -> _LayerStiffness:
    """Stiffness of all wires of a layer together, at rest.

    Notes
    -----
    The layer stiffness of [1]_, sec. 5.3, is that of the axial stress alone, n E A cos^3.  A
    single layer that is free to turn has almost none: it unwinds under the load, and only the
    bending and torsion of the wires remain.

    Examples
    --------
    30 wires at 20 deg, with EA of 124 MN in total, held against turning

    >>> design = ArmourDesign(np.radians(20.0), 2.5e-3, 25e-3, 210e9, n_wires=30)
    >>> stiffness = _layer_stiffness(design)
    >>> print((stiffness.tension_per_strain / 1e6).round(2))
    102.65
    """
    angle = np.asarray(design.winding_angle, dtype=np.float64)
    sine, cosine, radius = np.sin(angle), np.cos(angle), design.helix_radius
    by_strain = (cosine**2, -2 * (sine * cosine) ** 2 / radius, sine**3 * cosine / radius)
    by_twist = (radius * sine * cosine, 2 * sine * cosine**3, cosine**4)
    rods = (design.axial_stiffness, design.bending_stiffness, design.torsion_stiffness)
    count = np.asarray(design.n_wires) / cosine

    def pair(one: tuple[Floats, ...], other: tuple[Floats, ...]) -> Floats:
        terms = (rod * x * y for rod, x, y in zip(rods, one, other, strict=True))
        return np.asarray(count * sum(terms))

    return _LayerStiffness(
        tension_per_strain=pair(by_strain, by_strain),
        torque_per_strain=pair(by_strain, by_twist),
        torque_per_twist=pair(by_twist, by_twist),
    )


_YIELD_STEPS = 100

_CLOSE = 1e-10  # relative to the yield stress; strains of the cable are differences from one


def _wire_stress(response: _ArmourResponse) -> Floats:
    r"""Greatest stress on the section of a wire.

    .. math:: \sqrt{(|\sigma_T| + |\sigma_{G'}|)^2 + 3\sigma_H^2}

    Notes
    -----
    Source: [1]_, sec. 5.3 adds axial and bending stress.  The three meet at one point of the
    surface of the wire, where the stress from the shear force is zero.  The stresses from laying
    the wires and from contact are not included.

    Examples
    --------
    >>> from reduction.prediction.armour import predict_armour
    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_armour(design, 1e-3, theory="intermediate")
    >>> print(((np.abs(wire.axial_stress) + np.abs(wire.bending_stress)) / 1e6).round(2))
    [114.55]
    >>> print((_wire_stress(wire) > np.abs(wire.axial_stress)).all())
    True
    """
    normal = np.abs(response.axial_stress) + np.abs(response.bending_stress)
    return np.asarray(np.hypot(normal, np.sqrt(3.0) * response.torsion_stress))


def _yield_strain(design: ArmourDesign, yield_stress: ArrayLike) -> Floats:
    """Strain of the cable at which the wires begin to yield in extension.

    Notes
    -----
    Strain of the wire and strain of the cable are related in closed form
    (`reduction.prediction.hose_geometry`), and the stress is nearly proportional to the strain of
    the wire: it is scaled until the stress equals the yield stress to 1e-10.  [1]_, sec. 5.3, uses
    the axial stress alone.

    Examples
    --------
    Steel of 800 MPa at 20 and 80 deg: with steeper wires the cable may stretch more

    >>> design = ArmourDesign(np.radians([20.0, 80.0]), 2.5e-3, 25e-3, 210e9)
    >>> print((100 * _yield_strain(design, 800e6)).round(3))
    [0.422 9.871]
    """
    limit = np.asarray(yield_stress, dtype=np.float64)
    if not np.all((limit > 0) & np.isfinite(limit)):
        raise SettingsError(
            "yield_stress is not above zero", found=f"{limit.min():g} Pa", needed="above 0 Pa"
        )
    shape = np.broadcast_shapes(design.shape, limit.shape)
    angle = np.broadcast_to(np.asarray(design.winding_angle, dtype=np.float64), shape)
    wire_strain = np.broadcast_to(limit / np.asarray(design.elastic_modulus), shape)
    for _ in range(_YIELD_STEPS):
        strain = hose_stretch_ratio(1 + wire_strain, angle, core="rigid") - 1
        stress = _wire_stress(_predict_conjugate(design, strain[..., None]))[..., 0]
        if np.all(np.abs(stress - limit) <= _CLOSE * limit):
            return np.asarray(strain)
        wire_strain = wire_strain * limit / stress
    worst = float(np.max(np.abs(stress / limit - 1)))
    raise FitError(
        "the strain at which the wires yield is not found",
        found=f"a stress that is still {100 * worst:.2g} % off",
        needed="a yield stress above 1e-5 of the modulus, and wires no thicker than their core",
    )


def layer_strength(design: ArmourDesign, yield_stress: ArrayLike) -> Floats:
    r"""Tension of the cable at which the axial stress of a layer equals the yield stress.

    .. math:: F = n \sigma_y A \cos\alpha

    Notes
    -----
    Source: [1]_, sec. 5.3, which divides by the cosine instead of multiplying by it for the axial
    component: 13 % too much at 20 deg, 33 times at 80 deg.  The angle is that at rest, and bending,
    torsion and shear are left out; `_yield_strain` includes them.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([20.0, 80.0]), 2.5e-3, 25e-3, 210e9, n_wires=30)
    >>> print((layer_strength(design, 800e6) / 1e3).round(1))
    [442.8 81.8]
    """
    along = np.asarray(yield_stress, dtype=np.float64) * design.wire_area
    return np.asarray(np.asarray(design.n_wires) * along * np.cos(design.winding_angle))


Lay = Literal["right", "left"]

_TOUCH = 1e-9  # in wire radii: layers and wires that just touch differ by rounding


@dataclass(frozen=True)
@read_only_arrays
class ArmourLayers:
    """Layers of one cable, the innermost first.

    Parameters
    ----------
    design : ArmourDesign
        Arrays of shape (n_layers,), or floats common to all layers.
    lay : tuple of {"right", "left"}, length n_layers
        Hand of each layer.
    yield_stress : ndarray, shape (n_layers,)
        Yield stress of the wires; NaN where none is stated. [Pa]
    """

    design: ArmourDesign
    lay: tuple[Lay, ...]
    yield_stress: Floats

    def __post_init__(self) -> None:
        """Check that the layers match, that each has room, and that its wires have room."""
        count = len(self.lay)
        for name, shape in (
            ("the armour", self.design.shape),
            ("yield_stress", self.yield_stress.shape),
        ):
            if shape != (count,):
                raise SettingsError(
                    f"{name} does not pair up with the layers",
                    found=f"shape {shape} for {count} hands of lay",
                    needed="one number a layer",
                )
        unknown = [hand for hand in self.lay if hand not in get_args(Lay)]
        if unknown:
            raise SettingsError(
                "the hand of a layer is not known", found=repr(unknown[0]), needed="right, left"
            )
        bad = self.yield_stress <= 0
        if bad.any():
            raise SettingsError(
                f"yield_stress of layer {_first(bad)} is not above zero",
                found=f"{self.yield_stress[bad][0]:g} Pa",
                needed="above 0 Pa",
            )
        core, wire = (self._spread(one) for one in ("core_radius", "wire_radius"))
        inside = core[:-1] + 2 * wire[:-1]
        bad = core[1:] < inside - _TOUCH * wire[:-1]
        if bad.any():
            at = _first(bad)
            raise SettingsError(
                f"layer {at + 1} lies inside layer {at}",
                found=f"core_radius {core[at]:g} m",
                needed=f"{inside[at - 1]:g} m or more",
                hint="Give the layers from the innermost outwards.",
            )
        gap = np.broadcast_to(_wire_gap(self.design), (count,))
        bad = gap < -_TOUCH * wire
        if bad.any():
            at = _first(bad)
            n_wires = self._spread("n_wires")[at - 1]
            raise SettingsError(
                f"the wires of layer {at} do not fit on its core",
                found=f"{n_wires:g} wires that overlap by {-gap[bad][0]:g} m",
                needed="fewer or thinner wires, or a smaller angle",
            )

    def _spread(self, name: str) -> Floats:
        value = np.asarray(getattr(self.design, name), dtype=np.float64)
        return np.asarray(np.broadcast_to(value, (len(self.lay),)))

    @property
    def hand(self) -> Floats:
        """1 for a right-handed layer, -1 for a left-handed one, shape (n_layers,)."""
        return np.array([1.0 if hand == "right" else -1.0 for hand in self.lay])


def _first(bad: Bools) -> int:
    return int(np.flatnonzero(bad)[0]) + 1


@dataclass(frozen=True)
@read_only_arrays
class _LayersResponse:
    """Response of the cable at each strain; shape by layer (n_layers, n_strain)."""

    wire: _ArmourResponse
    layer_tension: Floats
    tension: Floats
    layer_torque: Floats
    torque: Floats
    torque_imbalance: Floats
    layer_pressure: Floats
    core_pressure: Floats
    wire_stress: Floats
    is_yielding: Bools


def _predict_layers(layers: ArmourLayers, strain: ArrayLike) -> _LayersResponse:
    r"""Tension, torque, pressure and stress of a cable that is stretched and held against turning.

    .. math:: F = \sum n (T\cos\bar\alpha + N'\sin\bar\alpha),\quad
       M = \sum \pm n (r(T\sin\bar\alpha - N'\cos\bar\alpha) + H\cos\bar\alpha + G'\sin\bar\alpha),
       \quad p = \frac{-n X_1}{2\pi R_1\cos\bar\alpha}

    Notes
    -----
    Source: [1]_, eq. (6) for the line load, Figure 2 for the sum; the torque is that of the
    forces and moments of (6) about the axis.  Line contacts are averaged to a pressure.
    Friction between layers and the load of the core itself are left out.

    Examples
    --------
    Two layers of opposite hands, the outer one less steep: most of the torque is balanced

    >>> design = ArmourDesign(np.radians([24.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([30, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.array([800e6, 800e6]))
    >>> cable = _predict_layers(layers, [1e-3])
    >>> print((cable.tension / 1e3).round(1), cable.torque_imbalance.round(2))
    [217.6] [0.12]
    """
    wire = predict_armour(layers.design, strain, theory="conjugate")
    count = layers._spread("n_wires")[:, None]
    core_radius = layers._spread("core_radius")[:, None]
    layer_tension = count * wire.tension
    layer_torque = layers.hand[:, None] * count * wire.torque
    along = np.cos(wire.current_winding_angle)
    radial = count * wire.contact_line_load / (2 * pi * along)  # pressure times radius
    inwards = np.cumsum(radial[::-1], axis=0)[::-1]
    torque = layer_torque.sum(axis=0)
    size = np.abs(layer_torque).sum(axis=0)
    stress = _wire_stress(wire)
    return _LayersResponse(
        wire=wire,
        layer_tension=layer_tension,
        tension=layer_tension.sum(axis=0),
        layer_torque=layer_torque,
        torque=torque,
        torque_imbalance=np.divide(
            np.abs(torque), size, out=np.full_like(size, np.nan), where=size > 0
        ),
        layer_pressure=radial / core_radius,
        core_pressure=inwards / core_radius,
        wire_stress=stress,
        is_yielding=stress > layers.yield_stress[:, None],
    )


def _cable_stiffness(layers: ArmourLayers) -> tuple[float, float]:
    """Tension per strain of the cable at rest: held against turning, and free to turn.

    Notes
    -----
    Layers add in stiffness against strain and twist, not in stiffness when free.  After
    [1]_, sec. 5.3, with the energy of `reduction.prediction.armour`.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([24.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([30, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.full(2, np.nan))
    >>> print("{:.3e} {:.3e}".format(*_cable_stiffness(layers)))
    2.175e+08 2.146e+08
    """
    each = _layer_stiffness(layers.design)
    held = float(np.sum(each.tension_per_strain))
    coupling = float(np.sum(layers.hand * each.torque_per_strain))
    return held, held - coupling**2 / float(np.sum(each.torque_per_twist))


@dataclass(frozen=True)
@read_only_arrays
class _CableStrength:
    """First yield of a cable."""

    layer_strength: Floats
    layer_yield_strain: Floats
    governing_layer: int
    strain: float
    tension: float


def _cable_strength(layers: ArmourLayers) -> _CableStrength:
    """Strain at which the first wire of the cable yields, and the load of the cable there.

    Notes
    -----
    After [1]_, sec. 5.3, for several layers and with bending and torsion.

    Examples
    --------
    The less steep layer is strained more:

    >>> from reduction.prediction.armour import ArmourDesign
    >>> design = ArmourDesign(np.radians([35.0, 20.0]), 2.5e-3, np.array([25e-3, 30e-3]), 210e9,
    ...                       n_wires=np.array([26, 36]))
    >>> layers = ArmourLayers(design, ("right", "left"), np.array([800e6, 800e6]))
    >>> _cable_strength(layers).governing_layer
    1
    """
    bare = np.isnan(layers.yield_stress)
    if bare.any():
        raise SettingsError(
            f"layer {int(np.flatnonzero(bare)[0]) + 1} has no yield stress",
            needed="one for every layer",
        )
    strain = _yield_strain(layers.design, layers.yield_stress)
    governing = int(np.argmin(strain))
    first = float(strain[governing])
    return _CableStrength(
        layer_strength=layer_strength(layers.design, layers.yield_stress),
        layer_yield_strain=strain,
        governing_layer=governing,
        strain=first,
        tension=float(_predict_layers(layers, first).tension[0]),
    )


_UNBALANCED = 0.1

_ANGLES = np.radians(np.arange(5.0, 85.5, 0.5))


@dataclass(frozen=True)
class PredictedArmour:
    """An armour at one strain.

    ``responses`` are those of one wire of each layer by theory, shape (n_layers, 1); ``use`` holds
    the angles of use of each layer, at the ``tolerance`` [1]; ``axial_stiffness`` is that of the
    cable held against turning, and free to turn [N]; ``thinning_loss`` is the share of its strain
    that a wire of each layer loses as it thins, which no theory includes [1].
    """

    layer_names: tuple[str, ...]
    layers: ArmourLayers
    strain: Floats
    responses: dict[ArmourTheory, _ArmourResponse]
    errors: Floats
    use: tuple[_AnglesOfUse, ...]
    tolerance: float
    together: _LayersResponse
    axial_stiffness: tuple[float, float]
    strength: _CableStrength | None
    gap: Floats
    thinning_loss: Floats
    notes: tuple[Note, ...]


# [Pa]: from aramid and aluminium to steel, with room on both sides
_MODULUS, _YIELD = (20e9, 250e9), (0.03e9, 3e9)


def predict_armour_case(
    layers: ArmourLayers, strain: Floats, *, names: Sequence[str], tolerance: float
) -> PredictedArmour:
    """Predict an armour by every theory."""
    design = layers.design
    responses = {
        theory: predict_armour(design, strain, theory=theory) for theory in ARMOUR_THEORIES
    }
    together = _predict_layers(layers, strain)
    known = np.isfinite(layers.yield_stress)
    notes = []
    modulus = np.broadcast_to(design.elastic_modulus, np.shape(layers.yield_stress))
    for place, name in enumerate(names):
        for what, one, (low, high) in (
            ("elastic_modulus", modulus[place], _MODULUS),
            ("yield_stress", layers.yield_stress[place], _YIELD),
        ):
            if one < low or one > high:  # not so where none is stated
                notes.append(
                    note("wire-outside-band", name, what=what, value=one, low=low, high=high)
                )
        if responses["exact"].is_lifted[place, 0]:
            notes.append(note("wires-leave-core", name))
        if together.is_yielding[place, 0]:
            notes.append(note("wires-yield", name))
    if abs(together.torque_imbalance[0]) > _UNBALANCED:
        notes.append(note("layers-unbalanced", effect=float(together.torque_imbalance[0])))
    return PredictedArmour(
        layer_names=tuple(names),
        layers=layers,
        strain=strain,
        responses=responses,
        errors=theory_errors(design, strain),
        use=tuple(
            _angles_of_use(
                wound_at_all_angles(design, place), float(strain[0]), tolerance=tolerance
            )
            for place in range(len(names))
        ),
        tolerance=tolerance,
        together=together,
        axial_stiffness=_cable_stiffness(layers),
        strength=_cable_strength(layers) if known.all() else None,
        gap=_wire_gap(design),
        thinning_loss=_thinning_loss(design),
        notes=tuple(notes),
    )


def wound_at_all_angles(design: ArmourDesign, place: int) -> ArmourDesign:
    """Wires of a layer, wound at any angle from 5 to 85 deg."""

    def of_layer(value: float | Floats) -> float:
        return float(np.broadcast_to(value, design.shape)[place])

    return ArmourDesign(
        _ANGLES,
        of_layer(design.wire_radius),
        of_layer(design.core_radius),
        of_layer(design.elastic_modulus),
        of_layer(design.poisson_ratio),
    )

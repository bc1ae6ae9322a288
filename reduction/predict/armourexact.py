r"""A wire on a rigid core without approximation of its geometry: two laws of its moments.

Neither core nor cable turns, so that the helix of the wire centre follows

.. math:: (1+\zeta)\cos\bar\alpha = (1+\varepsilon)\cos\alpha,\qquad
   (1+\zeta)\sin\bar\alpha = \sin\alpha

``exact`` is the rod whose first order are the theories of small and intermediate angles: moments
go with the change of curvature and torsion *per current length*, the axial force with the strain
alone.  These do not derive from an energy: with :math:`U = \tfrac12(EA\zeta^2 + EI\Delta\kappa^2
+ GJ\Delta\tau^2)` per rest length of wire, virtual work gives

.. math:: \frac{1}{\cos\alpha}\frac{dU}{d\varepsilon} - (T\cos\bar\alpha + N'\sin\bar\alpha)
   = -\cos\bar\alpha\,(G'\bar\kappa' + H\bar\tau)

a share of order :math:`(R_2/r)^2/4` at any strain, since a curvature per current length changes
when the wire is merely stretched.

``conjugate`` is the rod that has an energy and that agrees with three-dimensional elasticity.  A
curved bar bends as a sheaf of fibres: those on the inside of the helix are shorter at rest and
are strained more by the same displacement, so that bending does go with the curvature per current
length, and costs an axial force.  Torsion is the turn of one section against another over the
length of wire that lay between them at rest: for a straight round wire any other measure would
depend on how its axes were drawn.

.. math:: W = \tfrac12 EA\zeta^2 + \tfrac12 EI\chi^2 + \tfrac12 GJ\vartheta^2,\quad
   \chi = (1+\zeta)(\bar\kappa' - \kappa'),\quad \vartheta = (1+\zeta)\bar\tau - \tau

.. math:: T = EA\zeta - \kappa' G',\quad G' = EI\chi,\quad H = GJ\vartheta,\quad
   T\cos\bar\alpha + N'\sin\bar\alpha = \frac{1}{\cos\alpha}\frac{dW}{d\varepsilon}

Its torsion moment is :math:`GJ\varepsilon\sin^3\alpha\cos\alpha/r` to the first order: it does not
vanish at 45 deg and does not change sign.  The bending moment is that of ``exact``; it is known to
nu/2 of itself, since thinning of the wire moves its fibres by as much as bending does.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 3.1.
.. [2] A. E. H. Love, A Treatise on the Mathematical Theory of Elasticity, 4th ed., Cambridge
   Univ. Press, 1944, ch. 18-19.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.armourdesign import ArmourDesign, ArmourResponse, Deformed, Wire, respond
from reduction.predict.cord import cord_stretch_ratio
from reduction.record import Floats


def _deform(wire: Wire, strain: Floats, *, torsion_per_rest_length: bool) -> Deformed:
    """Deform the helix; every difference is a product, so that small strains lose no digits."""
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
    return Deformed(
        wire_strain, change, curvature_change, torsion_change, balance_angle=wire.angle + change
    )


def predict_exact(design: ArmourDesign, strain: Floats) -> ArmourResponse:
    r"""Response of a wire with the exact helix and the moments of the report.

    .. math:: G' = EI(\bar\kappa' - \kappa'),\quad H = GJ(\bar\tau - \tau),\quad T = EA\zeta

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : ndarray, shape (n_strain,)
        Of the cable. [1]

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain).

    Raises
    ------
    SettingsError
        By the design; see `reduction.predict.armour.predict_armour` for the strain.

    Notes
    -----
    Source: [1]_, eq. (2)-(8) before they are made linear, after [2]_; the printed torsion moment
    of (4) has the bending stiffness.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_exact(design, np.array([1e-3, 0.1]))
    >>> print((100 * wire.wire_strain).round(5), np.degrees(wire.current_winding_angle).round(4))
    [0.05001 5.11898] [44.9714 42.2737]
    """
    wire = Wire.of(design)
    is_as = _deform(wire, strain, torsion_per_rest_length=False)
    return respond(wire, "exact", strain, is_as, wire.axial_stiffness * is_as.wire_strain)


def predict_conjugate(design: ArmourDesign, strain: Floats) -> ArmourResponse:
    r"""Response of a wire whose tension is the derivative of its energy.

    .. math:: T = EA\zeta - \kappa' G',\quad G' = EI(1+\zeta)(\bar\kappa' - \kappa'),\quad
       H = GJ((1+\zeta)\bar\tau - \tau)

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : ndarray, shape (n_strain,)
        Of the cable. [1]

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain); curvature and torsion changes per rest length.

    Raises
    ------
    SettingsError
        By the design; see `reduction.predict.armour.predict_armour` for the strain.

    Notes
    -----
    Derived in the module's text, balance of forces and moments by [1]_, eq. (6).

    Examples
    --------
    The torsion moment at 45 deg, which [1]_ makes zero, to the first order GJ strain / (4 r):

    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_conjugate(design, np.array([1e-6]))
    >>> print((wire.torsion_moment * 4 * 27.5e-3 / (design.torsion_stiffness * 1e-6)).round(4))
    [1.]
    """
    wire = Wire.of(design)
    is_as = _deform(wire, strain, torsion_per_rest_length=True)
    rest_curvature = wire.sine**2 / wire.helix_radius
    eccentric = rest_curvature * wire.bending_stiffness * is_as.curvature_change
    axial_force = wire.axial_stiffness * is_as.wire_strain - eccentric
    return respond(wire, "conjugate", strain, is_as, axial_force)

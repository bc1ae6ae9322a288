r"""The theories of small, intermediate and large winding angles.

All three are of the first order in the strain.  That of intermediate angles is the first term of
the rod of `reduction.predict.armourexact`; that of small angles is the same but for the change of
angle, which it takes from a cosine; that of large angles is a close-coiled spring that has no core.

References
----------
.. [1] H. Wang, Z. Yang, J. Yan, G. Wang, D. Shi, B. Zhou and Y. Li, "Prediction Method and
   Validation Study of Tensile Performance of Reinforced Armor Layer in Marine Flexible
   Pipe/Cables," J. Mar. Sci. Eng., vol. 10, 642, 2022, sec. 3.
"""

from __future__ import annotations

import numpy as np

from reduction.predict.armourdesign import ArmourDesign, ArmourResponse, Deformed, Wire, respond
from reduction.record import Floats


def predict_intermediate(design: ArmourDesign, strain: Floats) -> ArmourResponse:
    r"""Response of a wire to the first order in the strain.

    .. math:: \zeta = \varepsilon\cos^2\alpha,\quad \Delta\alpha = -\varepsilon\sin\alpha\cos\alpha,
       \quad \Delta\kappa' = -2\varepsilon\sin^2\alpha\cos^2\alpha/r,
       \quad \Delta\tau = \varepsilon\sin\alpha\cos\alpha(\sin^2\alpha - \cos^2\alpha)/r

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
    Source: [1]_, eq. (10)-(19).  The change of angle is current minus rest, as the text defines
    it; (9)-(15) use the opposite.  As printed, the torsion moment of (4) has the bending
    stiffness, 1 + nu times too much, and that of (16) and (19) has :math:`2\sin^2\alpha` where
    (15) gives :math:`1 - 2\cos^2\alpha`.  As computed: (15) with the torsional stiffness,

    .. math:: N' = H\sin^2\alpha/r - G'\sin\alpha\cos\alpha/r

    Examples
    --------
    At 45 deg the torsion does not change, and the bending moment is greatest:

    >>> design = ArmourDesign(np.radians(45.0), 2.5e-3, 25e-3, 210e9)
    >>> wire = predict_intermediate(design, np.array([1e-3]))
    >>> print((wire.axial_stress / 1e6).round(1), abs(wire.torsion_moment).round(9))
    [105.] [0.]
    """
    wire = Wire.of(design)
    product = wire.sine * wire.cosine
    wire_strain = strain * wire.cosine**2
    is_as = Deformed(
        wire_strain=wire_strain,
        angle_change=-strain * product,
        curvature_change=-2 * strain * product**2 / wire.helix_radius,
        torsion_change=-strain * product * np.cos(2 * wire.angle) / wire.helix_radius,
        balance_angle=wire.angle,
    )
    return respond(wire, "intermediate", strain, is_as, wire.axial_stiffness * wire_strain)


def predict_small(design: ArmourDesign, strain: Floats) -> ArmourResponse:
    r"""Response of a wire with the change of angle from a cosine.

    .. math:: \cos\bar\alpha = (1 + \varepsilon - \varepsilon\cos^2\alpha)\cos\alpha

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : ndarray, shape (n_strain,)
        Of the cable. [1]

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain); NaN where the cosine passes one.

    Raises
    ------
    SettingsError
        By the design; see `reduction.predict.armour.predict_armour` for the strain.

    Notes
    -----
    Source: [1]_, eq. (20)-(22), for 0-20 deg.  (20) is (12), so the axial force is that of
    intermediate angles.  (21) is :math:`(1+\varepsilon)/(1+\zeta)` to the first order.  As
    printed, the bending and torsion moments of (22) have the opposite sign to (16), and the
    torsion moment lacks one wire radius; as computed, (14) and (15) with this change of angle.

    Examples
    --------
    >>> design = ArmourDesign(np.radians([10.0, 20.0]), 2.5e-3, 25e-3, 210e9)
    >>> print((predict_small(design, np.array([1e-3])).axial_force[:, 0] / 1e3).round(3))
    [3.999 3.641]
    """
    wire = Wire.of(design)
    wire_strain = strain * wire.cosine**2
    with np.errstate(invalid="ignore"):
        change = np.arccos((1 + strain - wire_strain) * wire.cosine) - wire.angle
    is_as = Deformed(
        wire_strain=wire_strain,
        angle_change=change,
        curvature_change=np.sin(2 * wire.angle) * change / wire.helix_radius,
        torsion_change=np.cos(2 * wire.angle) * change / wire.helix_radius,
        balance_angle=wire.angle,
    )
    return respond(wire, "small", strain, is_as, wire.axial_stiffness * wire_strain)


def predict_large(design: ArmourDesign, strain: Floats) -> ArmourResponse:
    r"""Response of a wire as a close-coiled helical spring, free of the core.

    .. math:: f = \frac{\pi E R_2^4 \varepsilon}{4 (1+\nu) r^2 \tan\alpha},\quad
       T = f\cos\alpha,\quad N' = f\sin\alpha,\quad G' = -f r\cos\alpha,\quad H = f r\sin\alpha

    Parameters
    ----------
    design : ArmourDesign
        Shape (...).
    strain : ndarray, shape (n_strain,)
        Of the cable. [1]

    Returns
    -------
    response : ArmourResponse
        Arrays of shape (..., n_strain); the angle is NaN, the contact load zero.

    Raises
    ------
    SettingsError
        By the design; see `reduction.predict.armour.predict_armour` for the strain.

    Notes
    -----
    Source: [1]_, eq. (23)-(29), for 70-90 deg.  (25) has the pitch :math:`2\pi r/\tan\alpha`,
    not the printed :math:`2\pi r\tan\alpha`; (26) leaves out the sine of the torsion moment.
    Shear force and bending moment are not printed: they are the statics of a spring whose ends
    are free to turn, and meet (6) without core.  This is another body than a wire on a rigid
    core, not an approximation of it: its axial force is
    :math:`(R_2/r)^2 / (4(1+\nu)\sin\alpha)` of that, 1.8 % at 5 deg and 0.16 % at 80 deg.

    Examples
    --------
    >>> design = ArmourDesign(np.radians(80.0), 2.5e-3, 25e-3, 210e9)
    >>> strain = np.array([1e-3])
    >>> rod = predict_intermediate(design, strain)
    >>> print((100 * predict_large(design, strain).axial_force / rod.axial_force).round(2))
    [0.16]
    """
    wire = Wire.of(design)
    force = wire.torsion_stiffness * strain * wire.cosine / (wire.sine * wire.helix_radius**2)
    arm = force * wire.helix_radius
    axial_force = force * wire.cosine
    is_as = Deformed(
        wire_strain=axial_force / wire.axial_stiffness,
        angle_change=np.full_like(axial_force, np.nan),
        curvature_change=-arm * wire.cosine / wire.bending_stiffness,
        torsion_change=arm * wire.sine / wire.torsion_stiffness,
        balance_angle=wire.angle,
    )
    return respond(wire, "large", strain, is_as, axial_force)

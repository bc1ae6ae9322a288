r"""Tension of a rubber wall that keeps its volume, by four laws with one modulus.

With :math:`A_0` the area at rest and :math:`E` Young's modulus at small strain, the load is

=================  ===============================================================
neo-hookean        :math:`\tfrac13 A_0 E (\lambda - \lambda^{-2})`
linear             :math:`A_0 E (\lambda - 1)`: nominal stress is proportional to strain
linear-current     :math:`(A_0/\lambda) E (\lambda - 1)`: true stress is proportional to strain
hencky             :math:`(A_0/\lambda) E \ln\lambda`: true stress is proportional to true strain
=================  ===============================================================

All have the initial slope :math:`A_0 E`; at a stretch ratio of 2.46 they reach 0.76, 1.46, 0.59 and
0.37 of :math:`A_0 E`.  Only the neo-Hookean law is that of a three-dimensional solid of constant
volume; linear-current levels off at :math:`A_0 E`, and the Hencky load *falls* beyond a stretch
ratio of e.

The report prints the load as :math:`A_r E_r \lambda_h`, which is :math:`A_r E_r` on the hose at
rest; "linear" is this law without the load at rest.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, eq.
   (26).
.. [2] L. R. G. Treloar, The Physics of Rubber Elasticity, 3rd ed., Oxford, 1975, ch. 4-5.
"""

from __future__ import annotations

from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.hose_product import RubberLaw
from reduction.record.arrays import as_positive
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats


def rubber_tension(
    stretch_ratio: ArrayLike, *, area: ArrayLike, modulus: ArrayLike, law: RubberLaw
) -> Floats:
    r"""Axial load of the wall.

    Parameters
    ----------
    stretch_ratio : array_like, shape (...)
        :math:`\lambda`. [1]
    area : array_like, shape (...)
        Area of the wall at rest. [m2]
    modulus : array_like, shape (...)
        Young's modulus at small strain. [Pa]
    law : {"neo-hookean", "linear", "linear-current", "hencky"}
        See the table in the module docstring.

    Returns
    -------
    tension : ndarray, shape (...)
        Negative in compression. [N]

    Raises
    ------
    SettingsError
        If the law is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (26), second term, corrected; [2]_ for the neo-Hookean law.

    Examples
    --------
    >>> laws = ("neo-hookean", "linear", "linear-current", "hencky")
    >>> print([round(float(rubber_tension(2.46, area=1, modulus=1, law=law)), 2) for law in laws])
    [0.76, 1.46, 0.59, 0.37]
    """
    stretch, stiffness = as_positive("stretch_ratio", stretch_ratio), _stiffness(area, modulus)
    tension = np.empty(np.broadcast_shapes(stretch.shape, stiffness.shape))
    return tension_into(tension, stretch, stiffness, law)


def tension_into(out: Floats, stretch: Floats, stiffness: Floats, law: RubberLaw) -> Floats:
    """Write the axial load of the wall into an array; only the law is checked.

    Notes
    -----
    As `rubber_tension`, for many hoses at once, without temporary arrays.

    Examples
    --------
    >>> print(tension_into(np.empty(2), np.array([1.0, 2.0]), np.array(3.0), "neo-hookean"))
    [0. 1.75]
    """
    match _known(law):
        case "neo-hookean":
            np.reciprocal(stretch, out=out)
            np.square(out, out=out)
            np.subtract(stretch, out, out=out)
            out *= stiffness / 3
        case "linear":
            np.subtract(stretch, 1, out=out)
            out *= stiffness
        case "linear-current":
            np.subtract(stretch, 1, out=out)
            out /= stretch
            out *= stiffness
        case "hencky":
            np.log(stretch, out=out)
            out /= stretch
            out *= stiffness
    return out


def rubber_energy(
    stretch_ratio: ArrayLike, *, area: ArrayLike, modulus: ArrayLike, law: RubberLaw
) -> Floats:
    r"""Energy in the wall per rest length: the integral of the tension over strain.

    .. math:: \tfrac16(\lambda - 1)^2(1 + 2/\lambda), \quad \tfrac12(\lambda - 1)^2, \quad
       \lambda - 1 - \ln\lambda, \quad \tfrac12\ln^2\lambda

    times :math:`A_0 E`, in the order of the table in the module docstring.

    Notes
    -----
    The integrals of the laws of [1]_ and [2]_ in closed form.

    Examples
    --------
    At a stretch ratio of 2 the neo-Hookean wall stores 1/6 (4 + 1 - 3) of A E:

    >>> print(rubber_energy(2.0, area=1, modulus=3, law="neo-hookean").round(12))
    1.0
    """
    stretch, stiffness = as_positive("stretch_ratio", stretch_ratio), _stiffness(area, modulus)
    strain = stretch - 1
    match _known(law):
        case "neo-hookean":
            return np.asarray(strain**2 * (1 + 2 / stretch) * (stiffness / 6))
        case "linear":
            return np.asarray(strain**2 * (stiffness / 2))
        case "linear-current":
            return np.asarray((strain - np.log1p(strain)) * stiffness)
        case "hencky":
            return np.asarray(np.log1p(strain) ** 2 * (stiffness / 2))


def rubber_stiffness(
    stretch_ratio: ArrayLike, *, area: ArrayLike, modulus: ArrayLike, law: RubberLaw
) -> Floats:
    r"""Slope of the tension over strain.

    .. math:: \tfrac13(1 + 2\lambda^{-3}), \quad 1, \quad \lambda^{-2}, \quad
       (1 - \ln\lambda)\lambda^{-2}

    times :math:`A_0 E`, in the order of the table in the module docstring.

    Notes
    -----
    The derivatives of the laws of [1]_ and [2]_ in closed form.

    Examples
    --------
    >>> print(rubber_stiffness([1.0, 2.0], area=1, modulus=12, law="neo-hookean"))
    [12. 5.]
    """
    stretch, stiffness = as_positive("stretch_ratio", stretch_ratio), _stiffness(area, modulus)
    match _known(law):
        case "neo-hookean":
            return np.asarray((1 + 2 / stretch**3) * (stiffness / 3))
        case "linear":
            return np.asarray(np.ones_like(stretch) * stiffness)
        case "linear-current":
            return np.asarray(stiffness / stretch**2)
        case "hencky":
            return np.asarray((1 - np.log(stretch)) / stretch**2 * stiffness)


def _stiffness(area: ArrayLike, modulus: ArrayLike) -> Floats:
    """Slope at rest, A E."""
    return np.asarray(np.asarray(area, dtype=np.float64) * np.asarray(modulus, dtype=np.float64))


def _known(law: RubberLaw) -> RubberLaw:
    if law not in get_args(RubberLaw):
        raise SettingsError(
            "unknown law of rubber", found=str(law), needed=", ".join(get_args(RubberLaw))
        )
    return law

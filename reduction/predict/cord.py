r"""Length of a helix on a cylinder that stretches: cords of a hose, wires of an armour layer.

.. math:: \lambda_c^2 = \lambda_h^2 \cos^2 a_0 + \lambda_r^2 \sin^2 a_0

:math:`\lambda_h` is the stretch ratio of the cylinder, :math:`\lambda_c` that of the helix,
:math:`a_0` the angle at rest between helix and axis.  The radius follows the stretch as
:math:`\lambda_r^2 = 1/\lambda_h` where wall and filling keep their volume (``isochoric``: the
water-filled hose), or stays (``rigid``: wires on a core that does not give).

The isochoric form needs both wall and filling incompressible, none of the filling lost, no twist,
and the ends far away.  A hose that leaks, holds air or turns under load is not of this kind.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.predict.helix import Core, check_core, squared_radius_ratio, squares_of_angle
from reduction.record import Floats


def cord_stretch_ratio(
    stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Stretch ratio of a helix from that of its cylinder.

    .. math:: \lambda_c = \sqrt{\lambda_h^2 \cos^2 a_0 + \lambda_r^2 \sin^2 a_0}

    Parameters
    ----------
    stretch_ratio : array_like, shape (...)
        :math:`\lambda_h` of the cylinder. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]
    core : {"isochoric", "rigid"}
        What the radius does.

    Returns
    -------
    cord_stretch_ratio : ndarray, shape (...)
        :math:`\lambda_c`; below one the cord is slack. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg, or the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (8).

    Examples
    --------
    A cord at 64 deg is 2.74 % short where it is slackest, and at length again at +61.04 %:

    >>> print((100 * cord_stretch_ratio([1.28096, 1.61039], np.radians(64.0)) - 100).round(2))
    [-2.74 0. ]
    """
    stretch, (cosine2, sine2) = (
        as_positive("stretch_ratio", stretch_ratio),
        squares_of_angle(wrap_angle),
    )
    return np.asarray(np.sqrt(stretch**2 * cosine2 + squared_radius_ratio(stretch, core) * sine2))


def hose_stretch_ratio(
    cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Stretch ratio of the cylinder at which a helix has a given stretch ratio.

    .. math:: \lambda_h = 2\sqrt{p/3}\,
       \cos\left(\tfrac13 \arccos\left(-\tfrac32 \frac{q}{p} \sqrt{3/p}\right)\right),
       \quad p = \lambda_c^2/\cos^2 a_0, \quad q = \tan^2 a_0

    Parameters
    ----------
    cord_stretch_ratio : array_like, shape (...)
        :math:`\lambda_c`. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]
    core : {"isochoric", "rigid"}
        What the radius does.

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        :math:`\lambda_h` on the branch where stretch lengthens the helix; NaN where the helix
        is nowhere as short as asked. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg, or the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (8), which is the cubic :math:`\lambda_h^3 - p \lambda_h + q = 0`; the
    largest of its three roots in closed form.  With the rigid core the equation is quadratic.
    At an angle below 54.7356 deg a cord that is shorter than at rest gives a ratio below one.

    Examples
    --------
    Cords strained by 3.3 % in a hose with a wrap angle of 64 deg: the 79 % of [1]_, sec. 3.0

    >>> print(hose_stretch_ratio(1.033, np.radians(64.0)).round(4))
    1.7901
    """
    cord, (cosine2, sine2) = (
        as_positive("cord_stretch_ratio", cord_stretch_ratio),
        squares_of_angle(wrap_angle),
    )
    check_core(core)
    with np.errstate(invalid="ignore"):
        if core == "rigid":
            return np.asarray(np.sqrt(1 + (cord - 1) * (cord + 1) / cosine2))
        square = cord**2 / cosine2
        cosine3 = -1.5 * (sine2 / cord**2) * np.sqrt(3 / square)
        # the shortest helix of all is at -1, and may be found there to rounding only
        cosine3 = np.where(cosine3 > -1 - 8 * np.finfo(np.float64).eps, cosine3, np.nan)
        cosine3 = np.maximum(cosine3, -1.0)
        return np.asarray(2 * np.sqrt(square / 3) * np.cos(np.arccos(cosine3) / 3))


def pick_up_stretch_ratio(wrap_angle: ArrayLike) -> Floats:
    r"""Stretch ratio of a water-filled hose at which its slack cords are at length again.

    .. math:: \lambda_h^* = \tfrac12\left(\sqrt{1 + 4\tan^2 a_0} - 1\right)

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        One where the angle is not above 54.7356 deg: the cords bear load from the start. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.

    Notes
    -----
    Source: [1]_, eq. (8) with :math:`\lambda_c = 1`, divided by its root
    :math:`\lambda_h = 1`: :math:`\lambda_h^2 + \lambda_h - \tan^2 a_0 = 0`.

    Examples
    --------
    >>> print((100 * pick_up_stretch_ratio(np.radians([50.0, 64.0, 68.0])) - 100).round(2))
    [  0.    61.04 102.51]
    """
    cosine2, sine2 = squares_of_angle(wrap_angle)
    above = np.maximum(sine2 / cosine2 - 2, 0.0)
    return np.asarray(1 + 2 * above / (3 + np.sqrt(9 + 4 * above)))


def slackest_stretch_ratio(wrap_angle: ArrayLike) -> Floats:
    r"""Stretch ratio of a water-filled hose at which its cords are shortest.

    .. math:: \lambda_h = \left(\tfrac12 \tan^2 a_0\right)^{1/3}

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio : ndarray, shape (...)
        One where the angle is not above 54.7356 deg. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.

    Notes
    -----
    Where the derivative of eq. (8) of [1]_ is zero.  The current angle is then 54.7356 deg at
    any angle at rest, by eq. (7).

    Examples
    --------
    >>> from reduction.predict.wrapangle import current_wrap_angle
    >>> slackest = slackest_stretch_ratio(np.radians([64.0, 68.0]))
    >>> print(slackest.round(4))
    [1.281 1.4523]
    >>> print(np.degrees(current_wrap_angle(slackest, np.radians([64.0, 68.0]))).round(4))
    [54.7356 54.7356]
    """
    cosine2, sine2 = squares_of_angle(wrap_angle)
    return np.asarray(np.maximum(np.cbrt(sine2 / cosine2 / 2), 1.0))

r"""Angle of a helix on a cylinder that stretches, and the angle at rest that gives two stretches.

.. math:: \tan a = \tan a_0 \, \lambda_r / \lambda_h

Symbols, and when this holds: `reduction.predict.cord`.

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
from reduction.predict.helix import Core, squared_radius_ratio, squares_of_angle
from reduction.record import Floats


def current_wrap_angle(
    stretch_ratio: ArrayLike, wrap_angle: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Angle of the helix on the stretched cylinder.

    .. math:: \tan a = \tan a_0 \, \lambda_r / \lambda_h

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
    current_wrap_angle : ndarray, shape (...)
        :math:`a`, from the axis. [rad]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg, or the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (7), :math:`\lambda_r/\lambda_h = \lambda_h^{-3/2}`.

    Examples
    --------
    >>> print(np.degrees(current_wrap_angle(2.3, np.radians(68.0))).round(2))
    35.36
    """
    stretch, (cosine2, sine2) = (
        as_positive("stretch_ratio", stretch_ratio),
        squares_of_angle(wrap_angle),
    )
    tangent = np.sqrt(squared_radius_ratio(stretch, core) * sine2 / cosine2) / stretch
    return np.asarray(np.arctan(tangent))


def wrap_angle_for(
    stretch_ratio: ArrayLike, cord_stretch_ratio: ArrayLike, *, core: Core = "isochoric"
) -> Floats:
    r"""Angle at rest that gives both stretch ratios at once.

    .. math:: \cos^2 a_0 = \frac{\lambda_c^2 - \lambda_r^2}{\lambda_h^2 - \lambda_r^2}

    Parameters
    ----------
    stretch_ratio : array_like, shape (...)
        :math:`\lambda_h` of the cylinder. [1]
    cord_stretch_ratio : array_like, shape (...)
        :math:`\lambda_c` of the helix. [1]
    core : {"isochoric", "rigid"}
        What the radius does.

    Returns
    -------
    wrap_angle : ndarray, shape (...)
        :math:`a_0` at rest, from the axis; NaN where no angle between 0 and 90 deg does. [rad]

    Raises
    ------
    SettingsError
        If the core is unknown.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Source: [1]_, eq. (8) solved for the angle.

    Examples
    --------
    Cords strained by 5.65 % at the 130 % of the second hose of [1]_, sec. 3.0:

    >>> print(np.degrees(wrap_angle_for(2.3, 1.0565)).round(2))
    68.
    """
    stretch = as_positive("stretch_ratio", stretch_ratio)
    cord2 = as_positive("cord_stretch_ratio", cord_stretch_ratio) ** 2
    radius2 = squared_radius_ratio(stretch, core)
    with np.errstate(invalid="ignore", divide="ignore"):
        tangent2 = (stretch**2 - cord2) / (cord2 - radius2)
        is_angle = (tangent2 > 0) & np.isfinite(tangent2)
        return np.asarray(np.arctan(np.sqrt(np.where(is_angle, tangent2, np.nan))))

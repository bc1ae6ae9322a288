r"""How the stretch of a water-filled hose goes with the stretch and the angle of its cords.

Derivatives of the kinematics of `reduction.predict.cord`.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.predict.cord import hose_stretch_ratio
from reduction.record import Floats


def stretch_ratio_per_angle(cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""How the stretch of a water-filled hose at a given stretch of its cords goes with the angle.

    .. math:: \frac{\partial\lambda_h}{\partial a_0} = \frac{(\lambda_h^2 - 1/\lambda_h)\sin a_0
       \cos a_0}{\lambda_h \cos^2 a_0 - \sin^2 a_0/(2\lambda_h^2)}

    Parameters
    ----------
    cord_stretch_ratio : array_like, shape (...)
        :math:`\lambda_c`, held. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio_per_angle : ndarray, shape (...)
        NaN where the cord is nowhere as short as asked. [rad-1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Eq. (8) of [1]_ differentiated at constant :math:`\lambda_c`.

    Examples
    --------
    Points of stretch a degree, at a cord strain of 9.5 %:

    >>> print(np.radians(100 * stretch_ratio_per_angle(1.095, np.radians([64.0, 68.0]))).round(1))
    [ 8.6 12.5]
    """
    stretch, cosine2, sine2 = _stretched(cord_stretch_ratio, wrap_angle)
    rise = (stretch**2 - 1 / stretch) * np.sqrt(cosine2 * sine2)
    return np.asarray(rise / rise_of_cord(stretch, cosine2, sine2))


def stretch_ratio_per_cord_stretch(cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike) -> Floats:
    r"""How the stretch of a water-filled hose goes with the stretch of its cords.

    .. math:: \frac{\partial\lambda_h}{\partial\lambda_c} =
       \frac{\lambda_c}{\lambda_h \cos^2 a_0 - \sin^2 a_0/(2\lambda_h^2)}

    Parameters
    ----------
    cord_stretch_ratio : array_like, shape (...)
        :math:`\lambda_c`. [1]
    wrap_angle : array_like, shape (...)
        :math:`a_0` at rest, from the axis. [rad]

    Returns
    -------
    stretch_ratio_per_cord_stretch : ndarray, shape (...)
        NaN where the cord is nowhere as short as asked. [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.
    DataError
        If a stretch ratio is not a positive number.

    Notes
    -----
    Eq. (8) of [1]_ differentiated at constant angle.

    Examples
    --------
    >>> print(stretch_ratio_per_cord_stretch(1.095, np.radians([64.0, 68.0])).round(1))
    [3.7 4. ]
    """
    stretch, cosine2, sine2 = _stretched(cord_stretch_ratio, wrap_angle)
    return np.asarray(np.asarray(cord_stretch_ratio) / rise_of_cord(stretch, cosine2, sine2))


def rise_of_cord(stretch: Floats, cosine2: Floats, sine2: Floats) -> Floats:
    """Half the derivative of lambda_c squared: lambda_c times d lambda_c / d lambda_h."""
    return np.asarray(stretch * cosine2 - sine2 / (2 * stretch**2))


def _stretched(
    cord_stretch_ratio: ArrayLike, wrap_angle: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Stretch of the hose, and squares of cosine and sine of the angle, which it has checked."""
    stretch = hose_stretch_ratio(cord_stretch_ratio, wrap_angle)
    angle = np.asarray(wrap_angle, dtype=np.float64)
    return stretch, np.asarray(np.cos(angle) ** 2), np.asarray(np.sin(angle) ** 2)

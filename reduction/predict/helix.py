r"""Helix on a cylinder at rest: its angle, and how the cylinder's radius follows its stretch.

.. math:: \lambda_r^2 = 1/\lambda_h \text{ (isochoric)}, \qquad \lambda_r = 1 \text{ (rigid)}

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.1.
"""

from __future__ import annotations

from math import atan, pi, sqrt
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import SettingsError
from reduction.record import Floats

Core = Literal["isochoric", "rigid"]

NEUTRAL_ANGLE = atan(sqrt(2.0))
"""54.7356 deg: wrapped at more, a cord goes slack as a water-filled hose stretches. [rad]."""


def squares_of_angle(wrap_angle: ArrayLike) -> tuple[Floats, Floats]:
    """Squares of cosine and sine of the angle between helix and axis.

    Parameters
    ----------
    wrap_angle : array_like, shape (...)
        At rest. [rad]

    Returns
    -------
    cosine2, sine2 : ndarray, shape (...)
        [1]

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.

    Examples
    --------
    >>> cosine2, sine2 = squares_of_angle(NEUTRAL_ANGLE)
    >>> print(cosine2.round(4), sine2.round(4))
    0.3333 0.6667
    """
    angle = np.asarray(wrap_angle, dtype=np.float64)
    is_angle = (angle > 0) & (angle < pi / 2)
    if not np.all(is_angle):
        bad = np.atleast_1d(angle)[np.atleast_1d(~is_angle)][0]
        raise SettingsError(
            "wrap_angle is no angle of a helix",
            found=f"{np.degrees(bad):g} deg",
            needed="between 0 and 90 deg from the axis",
        )
    return np.asarray(np.cos(angle) ** 2), np.asarray(np.sin(angle) ** 2)


def squared_radius_ratio(stretch_ratio: Floats, core: Core) -> Floats:
    """Square of the ratio of the radius to that at rest.

    Parameters
    ----------
    stretch_ratio : ndarray, shape (...)
        Of the cylinder. [1]
    core : {"isochoric", "rigid"}
        What the radius does.

    Returns
    -------
    squared_radius_ratio : ndarray, shape (...)
        [1]

    Raises
    ------
    SettingsError
        If the core is unknown.

    Examples
    --------
    >>> squared_radius_ratio(np.array([1.0, 2.0]), "isochoric")
    array([1. , 0.5])
    """
    check_core(core)
    unit = np.ones_like(stretch_ratio)
    return np.asarray(1 / stretch_ratio if core == "isochoric" else unit)


def check_core(core: Core) -> None:
    """Refuse a core that is none.

    Parameters
    ----------
    core : {"isochoric", "rigid"}
        What the radius does.

    Raises
    ------
    SettingsError
        If the core is unknown.

    Examples
    --------
    >>> check_core("rigid")
    """
    if core not in get_args(Core):
        raise SettingsError("unknown core", found=str(core), needed=" or ".join(get_args(Core)))

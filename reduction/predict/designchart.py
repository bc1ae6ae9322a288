r"""Chart to choose a wrap angle by: cord strain over hose strain.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   eq. 8 and Figure 7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.errors import DataError
from reduction.predict.cord import cord_stretch_ratio, pick_up_stretch_ratio, slackest_stretch_ratio
from reduction.predict.helix import NEUTRAL_ANGLE
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class CordStrainChart:
    """Cord strain over hose strain for a family of wrap angles.

    Hose strains are of the whole relaxed length.

    Parameters
    ----------
    wrap_angle : ndarray, shape (n_angles,)
        At rest, from the axis. [rad]
    strain : ndarray, shape (n_strain,)
        Of the hose. [1]
    cord_strain : ndarray, shape (n_angles, n_strain)
        Below zero where a cord is slack. [1]
    slackest_strain, slackest_cord_strain : ndarray, shape (n_angles,)
        Of hose and cord where the cords are shortest; zero at 54.7356 degrees and below. [1]
    pick_up_strain : ndarray, shape (n_angles,)
        Of the hose where the cords are at length again. [1]
    neutral_angle : float
        Above it cords go slack at first: 54.7356 degrees. [rad]
    """

    wrap_angle: Floats
    strain: Floats
    cord_strain: Floats
    slackest_strain: Floats
    slackest_cord_strain: Floats
    pick_up_strain: Floats
    neutral_angle: float


def cord_strain_chart(
    wrap_angle: ArrayLike, strain: ArrayLike, *, dead_length_share: float = 0.0
) -> CordStrainChart:
    """Cord strain over hose strain for a family of wrap angles: Figure 7.

    Parameters
    ----------
    wrap_angle : array_like, shape (n_angles,)
        At rest, from the hose axis. [rad]
    strain : array_like, shape (n_strain,)
        Of the whole relaxed length. [1]
    dead_length_share : float
        Part of the relaxed length that does not stretch. [1]

    Returns
    -------
    chart : CordStrainChart
        The curves, their lowest points and where they come back to zero.

    Raises
    ------
    SettingsError
        If an angle is not between 0 and 90 deg.
    DataError
        If a strain is -1 or less, an input is no series, or the share is none.

    Notes
    -----
    Eq. 8 of [1]_ (module).  The report reads "about 54 degrees" from its figure for the angle
    above which cords go slack; it is the arctangent of the root of two.

    Examples
    --------
    >>> chart = cord_strain_chart(np.radians([54.0, 64.0, 68.0]), [0.5, 1.0])
    >>> print(chart.cord_strain.round(3))
    [[ 0.102 0.307]
     [-0.015 0.083]
     [-0.057 -0.004]]
    >>> print((100 * chart.slackest_cord_strain).round(2) + 0)
    [ 0. -2.74 -5.77]
    """
    angle, along = _series("wrap_angle", wrap_angle), _series("strain", strain)
    free = _free(dead_length_share)
    slackest = slackest_stretch_ratio(angle)
    return CordStrainChart(
        wrap_angle=np.array(angle),
        strain=np.array(along),
        cord_strain=cord_stretch_ratio(1 + along / free, angle[:, None]) - 1,
        slackest_strain=free * (slackest - 1),
        slackest_cord_strain=cord_stretch_ratio(slackest, angle) - 1,
        pick_up_strain=free * (pick_up_stretch_ratio(angle) - 1),
        neutral_angle=NEUTRAL_ANGLE,
    )


def _series(name: str, values: ArrayLike) -> Floats:
    series = as_finite(name, values)
    if series.ndim != 1:
        raise DataError(f"{name} is not a series", found=f"shape {series.shape}", needed="1-D")
    return series


def _free(dead_length_share: float) -> float:
    if not 0 <= dead_length_share < 1:
        raise DataError(
            "dead_length_share is no share", found=f"{dead_length_share:g}", needed="0 to below 1"
        )
    return 1 - dead_length_share

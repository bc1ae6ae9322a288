"""Whether a wave length and a period that are given together belong to one wave.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Table 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.predict.dispersion import STANDARD_GRAVITY, wave_number, wave_period_of
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class WaveLengthCheck:
    """A length and a period that were given together, against the dispersion relation.

    Parameters
    ----------
    period_of_length : ndarray, shape (...)
        That a wave of the given length has. [s]
    length_of_period : ndarray, shape (...)
        That a wave of the given period has. [m]
    period_mismatch : ndarray, shape (...)
        Period of the length over the given period, less one. [1]
    length_mismatch : ndarray, shape (...)
        Given length over the length of the period, less one. [1]
    """

    period_of_length: Floats
    length_of_period: Floats
    period_mismatch: Floats
    length_mismatch: Floats


def check_wave_length(
    wave_length: ArrayLike,
    wave_period: ArrayLike,
    water_depth: ArrayLike,
    *,
    current_velocity: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveLengthCheck:
    """How far a length and a period that were given together are from one wave.

    Parameters
    ----------
    wave_length : array_like, shape (...)
        As given. [m]
    wave_period : array_like, shape (...)
        As given. [s]
    water_depth : array_like, shape (...)
        Of the still water. [m]
    current_velocity : array_like, shape (...)
        Uniform over the depth, positive along the wave. [m s-1]
    gravity : float
        Acceleration of free fall. [m s-2]

    Returns
    -------
    check : WaveLengthCheck
        Both mismatches.

    Raises
    ------
    DataError
        If a number is not positive, or the current stops the wave.

    Notes
    -----
    By the linear relation; a steep wave is faster, so that a few per cent may be its height.

    Examples
    --------
    Table 4 of [1]_ at the depths of its two examples.

    >>> check = check_wave_length(20.0, 3.57, [6.0, 3.0])
    >>> print(check.period_mismatch.round(3), check.length_mismatch.round(3))
    [0.026 0.169] [0.045 0.227]
    """
    length = as_positive("wave_length", wave_length)
    period = as_positive("wave_period", wave_period)
    by_length = wave_period_of(
        2 * pi / length, water_depth, current_velocity=current_velocity, gravity=gravity
    )
    by_period = (
        2
        * pi
        / wave_number(period, water_depth, current_velocity=current_velocity, gravity=gravity)
    )
    return WaveLengthCheck(
        period_of_length=by_length,
        length_of_period=np.asarray(by_period),
        period_mismatch=np.asarray(by_length / period - 1),
        length_mismatch=np.asarray(length / by_period - 1),
    )

r"""Length of a wave from its period, and back, over still water or a current.

A current U along the wave shifts the period that a fixed point sees,

.. math:: (\omega - k U)^2 = g k \tanh k d

An opposing current faster than the group of waves stops them: no length answers then.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 14 and Table 4.
.. [2] C. Eckart, "The propagation of gravity waves from deep to shallow water," in Gravity
   Waves, Nat. Bur. Standards Circ. 521, 1952, pp. 165-173.
.. [3] D. H. Peregrine, "Interaction of water waves and currents," Adv. Appl. Mech., vol. 16,
   1976, pp. 9-117, sec. II.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.errors import DataError, FitError
from reduction.record import Floats

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall. [m s-2]"""

_STEP = 1e-14  # last Newton step over the root, at most
_RESIDUAL = 4 * float(np.finfo(np.float64).eps)
_MOST_STEPS = 100  # four or five are enough but at the very edge of blocking


def wave_number(
    wave_period: ArrayLike,
    water_depth: ArrayLike,
    *,
    current_velocity: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> Floats:
    r"""Wave number of the linear wave with this period.

    Parameters
    ----------
    wave_period : array_like, shape (...)
        As a fixed point sees it. [s]
    water_depth : array_like, shape (...)
        Of the still water. [m]
    current_velocity : array_like, shape (...)
        Uniform over the depth, positive along the wave. [m s-1]
    gravity : float
        Acceleration of free fall. [m s-2]

    Returns
    -------
    wave_number : ndarray, shape (...)
        Of the longer of the two waves that an opposing current allows: the one whose energy
        still goes forward. [rad m-1]

    Raises
    ------
    DataError
        If a period or depth is not positive, or the current stops the wave.
    FitError
        If the last Newton step is not below 1e-14 of the root.

    Notes
    -----
    Eq. (14) of [1]_ prints k = 2 pi / T; a wave number is 2 pi / L (its tables use that).

    Over still water Newton starts from the form of [2]_, which is right to 5 %.  Over a
    current it starts from there: omega - k U - sqrt(g k tanh k d) is convex in k, so that it
    cannot pass the wanted root, and a tangent that no longer falls proves there is none.

    Examples
    --------
    Table 4 of [1]_ gives 20 m beside 3.57 s, the length over deep water; 3 m deep it is 16.3 m.

    >>> print((2 * np.pi / wave_number(3.57, [100.0, 6.0, 3.0])).round(2))
    [19.89 19.13 16.31]
    """
    period, depth, current = _conditions(wave_period, water_depth, current_velocity)
    pace = np.sqrt(gravity * depth)
    frequency = 2 * pi / period * depth / pace
    root = _still_water(frequency**2)
    if np.any(current != 0):
        root = _over_current(frequency, current / pace, root)
        _refuse_blocked(np.isnan(root), current)
    return np.asarray(root / depth)


def wave_period_of(
    wave_number: ArrayLike,
    water_depth: ArrayLike,
    *,
    current_velocity: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> Floats:
    """Period of the linear wave with this wave number, as a fixed point sees it.

    Parameters
    ----------
    wave_number : array_like, shape (...)
        2 pi over the wave length. [rad m-1]
    water_depth : array_like, shape (...)
        Of the still water. [m]
    current_velocity : array_like, shape (...)
        Uniform over the depth, positive along the wave. [m s-1]
    gravity : float
        Acceleration of free fall. [m s-2]

    Returns
    -------
    wave_period : ndarray, shape (...)
        Period. [s]

    Raises
    ------
    DataError
        If a wave number or depth is not positive, or the current stops the wave.

    Notes
    -----
    The inverse of `wave_number`.

    Examples
    --------
    The 20 m of Table 4 of [1]_ do not fit its 3.57 s at either depth of its examples.

    >>> print(wave_period_of(2 * np.pi / 20, [6.0, 3.0]).round(3))
    [3.663 4.172]
    """
    number, depth, current = np.broadcast_arrays(
        as_positive("wave_number", wave_number),
        as_positive("water_depth", water_depth),
        as_finite("current_velocity", current_velocity),
    )
    group = group_velocity(number, depth, gravity=gravity)
    _refuse_blocked(current + group <= 0, current)
    intrinsic = np.sqrt(gravity * number * np.tanh(number * depth))
    return np.asarray(2 * pi / (intrinsic + number * current))


def group_velocity(
    wave_number: ArrayLike, water_depth: ArrayLike, *, gravity: float = STANDARD_GRAVITY
) -> Floats:
    """Speed of the energy of a linear wave through the water.

    Parameters
    ----------
    wave_number : array_like, shape (...)
        2 pi over the wave length. [rad m-1]
    water_depth : array_like, shape (...)
        Of the still water. [m]
    gravity : float
        Acceleration of free fall. [m s-2]

    Returns
    -------
    group_velocity : ndarray, shape (...)
        An opposing current as fast as this stops the wave. [m s-1]

    Raises
    ------
    DataError
        If a wave number or depth is not positive.

    Notes
    -----
    Derivative of the frequency by the wave number ([3]_): half the phase speed over deep water.

    Examples
    --------
    >>> print(group_velocity(2 * np.pi / 20, 100.0).round(3))
    2.794
    """
    number = as_positive("wave_number", wave_number)
    relative_depth = number * as_positive("water_depth", water_depth)
    phase_speed = np.sqrt(gravity / number * np.tanh(relative_depth))
    # 2 q / sinh 2q, which neither overflows nor loses digits
    share = 4 * relative_depth * np.exp(-2 * relative_depth) / -np.expm1(-4 * relative_depth)
    return np.asarray(phase_speed / 2 * (1 + share))


def _conditions(period: ArrayLike, depth: ArrayLike, current: ArrayLike) -> tuple[Floats, ...]:
    return np.broadcast_arrays(
        as_positive("wave_period", period),
        as_positive("water_depth", depth),
        as_finite("current_velocity", current),
    )


def _still_water(squared_frequency: Floats) -> Floats:
    """Root q of q tanh q = omega^2 d / g."""
    root = squared_frequency / np.sqrt(np.tanh(squared_frequency))
    for _ in range(_MOST_STEPS):
        tanh = np.tanh(root)
        step = (root * tanh - squared_frequency) / (tanh + root * (1 - tanh**2))
        root = root - step
        if np.all(np.abs(step) <= _STEP * root):
            return np.asarray(root)
    raise _no_root()


def _over_current(frequency: Floats, current: Floats, start: Floats) -> Floats:
    """Root q of omega - q U = sqrt(q tanh q), all over sqrt(g / d); NaN where there is none."""
    root = start.copy()
    for _ in range(_MOST_STEPS):
        tanh = np.tanh(root)
        intrinsic = np.sqrt(root * tanh)
        miss = frequency - root * current - intrinsic
        is_there = np.abs(miss) <= _RESIDUAL * (frequency + root * np.abs(current))
        slope = -current - (tanh + root * (1 - tanh**2)) / (2 * intrinsic)
        is_blocked = (slope >= 0) & ~is_there
        step = miss / np.where(slope < 0, slope, np.nan)
        is_there |= np.abs(step) <= _STEP * root
        root = np.where(is_blocked, np.nan, np.where(is_there, root, root - step))
        if np.all(is_there | np.isnan(root)):
            return np.asarray(root)
    raise _no_root()


def _no_root() -> FitError:
    return FitError(
        "the wave number was not found",
        found=f"no end after {_MOST_STEPS} Newton steps",
        needed=f"a last step below {_STEP:g} of the root",
    )


def _refuse_blocked(is_blocked: np.ndarray, current: Floats) -> None:
    if not np.any(is_blocked):
        return
    first = int(np.flatnonzero(np.ravel(is_blocked))[0])
    raise DataError(
        f"the opposing current stops {int(np.sum(is_blocked))} of {np.size(is_blocked)} waves, "
        f"first at index {first}",
        found=f"a current of {np.ravel(current)[first]:g} m/s",
        needed="an opposing current slower than the group velocity of the wave",
    )

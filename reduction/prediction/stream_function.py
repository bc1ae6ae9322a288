r"""Steady wave of any height over a flat bed, by a Fourier series of the stream function.

In the frame of the wave, with the bed at 0, x from the crest and lengths over the depth,
velocities over :math:`\sqrt{g d}`,

.. math::
   \psi(x, z) = -\bar u z + \sum_{j=1}^{N} \frac{B_j}{k}
                \frac{\sinh j k z}{\cosh j k} \cos j k x, \qquad
   \psi(x, \eta) = -Q, \qquad
   \tfrac12 (u^2 + w^2) + \eta = R \text{ at } z = \eta

The series satisfies Laplace's equation and the condition at the bed for every N; the two conditions
at the surface hold at N + 1 points from crest to trough.  The only approximation is N.

References
----------
.. [1] M. M. Rienecker and J. D. Fenton, "A Fourier approximation method for steady water waves,"
   J. Fluid Mech., vol. 104, 1981, pp. 119-137.
.. [2] J. D. Fenton, "The numerical solution of steady water wave problems," Computers &
   Geosciences, vol. 14, 1988, pp. 357-368.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record.errors import FitError
from reduction.record.measurement import Floats, read_only_arrays

_SIZES = (16, 32, 64, 128)  # numbers of harmonics, tried until the last harmonic is small

_LAST = 1e-5  # greatest last harmonic, as a share of the height and velocity of the crest

_MISS = 1e-11  # greatest residual of a condition at the surface

_MOST_STEPS = 12  # of Newton's method at one height; five or six are enough

_LEAST_RISE = 1e-2  # least increase of the height between solved waves, as a share of it


@dataclass(frozen=True)
@read_only_arrays
class SteadyWave:
    """A wave in units of the depth and the velocity of long waves.

    Parameters
    ----------
    number : float
        k d. [1]
    speed : float
        Speed of the crest in water at rest on average, over sqrt(g d). [1]
    surface : ndarray, shape (n_harmonics,)
        Amplitudes of the cosines of the surface over the depth. [1]
    velocity : ndarray, shape (n_harmonics,)
        j B_j: horizontal velocities at the mean level in a depth of many wave lengths. [1]
    """

    number: float
    speed: float
    surface: Floats
    velocity: Floats


def steady_wave(
    *, height: float, first_number: float, frequency: float | None, current: float
) -> SteadyWave:
    """Wave with this height, and this frequency over this current or this wave number.

    Parameters
    ----------
    height : float
        From trough to crest, over the depth. [1]
    first_number : float
        k d of the given wave number, or of the linear wave for a given frequency. [1]
    frequency : float or None
        Angular frequency at a fixed point, times sqrt(d / g); None keeps the wave number. [1]
    current : float
        Mean velocity of the water below the trough, over sqrt(g d). [1]

    Raises
    ------
    FitError
        If there is no such wave: it is higher than a wave can be, or too long for the series.

    Notes
    -----
    Method of [1]_ in the form of [2]_, with its derivatives in closed form.  The height grows
    from a low wave in steps, each extrapolated from the two before it, which are halved where
    Newton's method fails.

    Examples
    --------
    A low wave has the speed of the linear wave, here the root of tanh(1) over 1.

    >>> wave = steady_wave(height=1e-4, first_number=1.0, frequency=None, current=0.0)
    >>> print(round(wave.speed, 6), round(float(np.sqrt(np.tanh(1.0))), 6))
    0.872694 0.872694
    """
    for size in _SIZES:
        found = _grown(size, height, first_number, frequency, current)
        if found is None:
            continue
        speeds = np.arange(1, size + 1) * found[size + 1 : 2 * size + 1]
        surface = found[: size + 1] * np.where(np.arange(size + 1) % size == 0, 0.5, 1.0)
        angle = np.multiply.outer(np.arange(1, size + 1), np.arange(size + 1)) * np.pi / size
        amplitude = 2 / size * np.cos(angle) @ surface
        amplitude[-1] /= 2
        if all(abs(one[-1]) <= _LAST * np.sum(np.abs(one)) for one in (speeds, amplitude)):
            return SteadyWave(
                number=float(found[-4]),
                speed=float(found[-3]),
                surface=amplitude,
                velocity=speeds,
            )
    raise FitError(
        "no steady wave of this height was found",
        found=f"a height of {height:.4g} depths and a length of about "
        f"{2 * np.pi / first_number:.4g} depths",
        needed=f"a wave that does not break, of at most {_SIZES[-1]} harmonics",
        hint="Give a lower wave or a shorter period: a wave that is far longer than the water is "
        "deep is a row of solitary waves, which do not change with the period.",
    )


def _grown(
    size: int, height: float, first_number: float, frequency: float | None, current: float
) -> Floats | None:
    """Solution at the full height, from a low wave on; None where it is not reached."""
    low = min(0.01 * height, 1e-3 * min(1.0, 1 / first_number))
    speed = np.sqrt(np.tanh(first_number) / first_number)
    state = np.zeros(2 * size + 5)
    state[: size + 1] = 1 + low / 2 * np.cos(np.arange(size + 1) * np.pi / size)
    state[size + 1] = low / 2 * first_number * speed / np.tanh(first_number)
    state[-4:] = first_number, speed, speed, 1 + speed**2 / 2
    before, at, there, rise = state, 0.0, 0.0, low
    while there < height:
        tried = min(there + rise, height)
        guess = state if at == there else state + (tried - there) / (there - at) * (state - before)
        found = _solved(guess, size, tried, first_number, frequency, current)
        if found is None:
            if rise <= max(_LEAST_RISE * height, low):
                return None
            rise /= 2
            continue
        before, state, at, there = state, found, there, tried
        rise = min(2 * rise, height / 4)
    return state


def _solved(
    state: Floats,
    size: int,
    height: float,
    held_number: float,
    frequency: float | None,
    current: float,
) -> Floats | None:
    """Newton's method on 2 N + 5 equations from a guess; None where it does not converge."""
    state = state.copy()
    order, point = np.arange(1, size + 1), np.arange(size + 1)
    cosine = np.cos(np.multiply.outer(point, order) * np.pi / size)
    sine = np.sin(np.multiply.outer(point, order) * np.pi / size)
    weight = np.where(point % size == 0, 0.5, 1.0) / size
    eta_at, series_at = slice(0, size + 1), slice(size + 1, 2 * size + 1)
    number_at, speed_at, flux_at, head_at = range(2 * size + 1, 2 * size + 5)
    rows, diagonal = slice(size + 1, 2 * size + 2), np.arange(size + 1)
    for _ in range(_MOST_STEPS):
        eta, series, number, speed = state[eta_at], state[series_at], state[-4], state[-3]
        up, flat = np.multiply.outer(eta, order * number), order * number
        # also where an unsound step has left no number
        if not (np.max(np.abs(up) - flat) <= 300 and number > 0):
            return None
        rising, falling = np.exp(up - flat), np.exp(-up - flat)
        scale = 1 + np.exp(-2 * flat)
        sinh, cosh = (rising - falling) / scale, (rising + falling) / scale
        along, across = cosh * cosine, sinh * sine
        u, w = -speed + along @ (order * series), across @ (order * series)
        miss = np.empty(state.size)
        miss[eta_at] = -speed * eta + (sinh * cosine) @ series / number + state[flux_at]
        miss[rows] = (u**2 + w**2) / 2 + eta - state[head_at]
        miss[-3:-1] = weight @ eta - 1, eta[0] - eta[-1] - height
        miss[-1] = (
            number - held_number if frequency is None else number * (speed + current) - frequency
        )
        slope = np.zeros((state.size, state.size))
        # derivatives by wave number of sinh(j k eta) / cosh(j k) and of cosh(j k eta) / cosh(j k)
        tanh = order * np.tanh(flat)
        sinh_by = order * eta[:, None] * cosh - sinh * tanh
        cosh_by = order * eta[:, None] * sinh - cosh * tanh
        square = order**2 * series
        u_by_eta, w_by_eta = number * (sinh * cosine) @ square, number * (cosh * sine) @ square
        slope[diagonal, diagonal] = u
        slope[eta_at, series_at] = sinh * cosine / number
        slope[eta_at, number_at] = (sinh_by * cosine) @ series / number - (
            sinh * cosine
        ) @ series / number**2
        slope[eta_at, speed_at] = -eta
        slope[eta_at, flux_at] = 1
        slope[size + 1 + diagonal, diagonal] = u * u_by_eta + w * w_by_eta + 1
        slope[rows, series_at] = (u[:, None] * along + w[:, None] * across) * order
        slope[rows, number_at] = u * ((cosh_by * cosine) @ (order * series)) + w * (
            (sinh_by * sine) @ (order * series)
        )
        slope[rows, speed_at] = -u
        slope[rows, head_at] = -1
        slope[-3, eta_at] = weight
        slope[-2, [0, size]] = 1, -1
        slope[-1, number_at] = 1 if frequency is None else speed + current
        slope[-1, speed_at] = 0 if frequency is None else number
        try:
            step = np.linalg.solve(slope, miss)
        except np.linalg.LinAlgError:
            return None
        state -= step
        if not np.all(np.isfinite(state)):
            return None
        if np.max(np.abs(miss)) < _MISS and np.max(np.abs(step[eta_at])) < 1e-9:
            return state if np.all(np.diff(state[eta_at]) < 1e-12) else None
    return None

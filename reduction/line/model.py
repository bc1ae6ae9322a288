r"""Forward model of the three-parameter line: one spring beside a spring and a dashpot in series.

With :math:`x = \omega\tau = 2\pi f \tau` and :math:`\tau = N / K_1`,

.. math::

    E' = K_0 + K_1 \frac{x^2}{1 + x^2}, \qquad E'' = K_1 \frac{x}{1 + x^2}, \qquad
    K_{ap} = \sqrt{E'^2 + E''^2}, \qquad
    H = \frac{\pi K_1 (\Delta T)^2 x}{K_0^2 + (K_0 + K_1)^2 x^2}

As printed, and as computed.  Eq. 1 of [1]_ is the K_ap above.  Its eq. 4 prints
:math:`H = K_1 (\Delta T)^2 \omega\tau / [K_0 + (K_0 + K_1)^2 (\omega\tau)^2]`: the pi and
the square on K_0 are lost (K_0 beside a square of K_0 + K_1 has no unit), the integrand is
the mean load T_m where the area of a loop is that of the tension T, and omega is called a
frequency.  The numbers of [1]_ say which form was computed.  At the seven centre points the
constant in front of K_1 has the geometric mean 3.166 with a 95 % interval of 2.82 to 3.56,
which holds pi and neither 1, 2, 4 nor 2 pi; omega = 2 pi f gives K_ap within 0.966 to 1.013
of the print, omega = f gives 0.55 to 0.80.  K_0 against its square moves H by 5 % at most
there, so it is the unit that decides.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 3-19.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def _at_least_zero(**named: ArrayLike) -> tuple[Floats, ...]:
    """The inputs as float64, NaN let through; a negative one is refused by its name."""
    arrays = {name: np.asarray(values, dtype=np.float64) for name, values in named.items()}
    for name, array in arrays.items():
        bad = array < 0
        if bad.any():
            raise DataError(
                f"{int(bad.sum())} of {bad.size} values of {name.replace('_', ' ')} are negative",
                found=f"{array[bad].flat[0]:g}",
                needed="zero or more",
            )
    return tuple(arrays.values())


def dashpot_coefficient(
    *, dissipation_spring_constant: ArrayLike, relaxation_time: ArrayLike
) -> Floats:
    r"""Damping coefficient of the dashpot.

    .. math:: N = K_1 \tau

    Parameters
    ----------
    dissipation_spring_constant : array_like, shape (...)
        :math:`K_1`, force per unit strain. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]

    Returns
    -------
    dashpot_coefficient : ndarray, shape (...)
        Force per unit strain rate. [N s]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, sec. 4.2 (tau = N / K_1).  NaN in, NaN out.

    Examples
    --------
    >>> print(dashpot_coefficient(dissipation_spring_constant=43530.0, relaxation_time=4.0))
    174120.0
    """
    spring, time = _at_least_zero(
        dissipation_spring_constant=dissipation_spring_constant, relaxation_time=relaxation_time
    )
    product: Floats = spring * time
    return product


def storage_and_loss(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
) -> tuple[Floats, Floats]:
    r"""Storage and loss spring constant of the line.

    .. math:: E' = K_0 + K_1 \frac{x^2}{1 + x^2}, \qquad E'' = K_1 \frac{x}{1 + x^2}

    Parameters
    ----------
    quasi_static_spring_constant : array_like, shape (...)
        :math:`K_0` at the mean tension. [N]
    dissipation_spring_constant : array_like, shape (...)
        :math:`K_1`. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    frequency : array_like, shape (...)
        :math:`f`, cycles in a second. [Hz]

    Returns
    -------
    storage_spring_constant, loss_spring_constant : ndarray, shape (...)
        Tension in phase and in quadrature with strain, per unit strain. [N]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, eq. 1, whose modulus they are.  Small motions about a mean tension; the
    line does not go slack.  NaN in, NaN out.

    Examples
    --------
    Far above and far below the frequency of relaxation the line is a spring (eqs. 2, 3).

    >>> stored, _ = storage_and_loss(quasi_static_spring_constant=1.2,
    ...     dissipation_spring_constant=1.8, relaxation_time=1.0, frequency=[0.0, 1e6])
    >>> print(stored.round(6))
    [1.2 3. ]
    """
    rest, spring, time, rate = _at_least_zero(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    turn = 2 * np.pi * rate * time
    share = 1 / (1 + turn**2)
    return rest + spring * (turn**2 * share), spring * (turn * share)


def apparent_spring_constant(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
) -> Floats:
    r"""Tension amplitude over strain amplitude.

    .. math:: K_{ap} = \left[\frac{K_0^2 + (K_0 + K_1)^2 x^2}{1 + x^2}\right]^{1/2}

    Parameters
    ----------
    quasi_static_spring_constant, dissipation_spring_constant : array_like, shape (...)
        :math:`K_0` and :math:`K_1`. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    frequency : array_like, shape (...)
        :math:`f`; x is 2 pi f tau. [Hz]

    Returns
    -------
    apparent_spring_constant : ndarray, shape (...)
        Between :math:`K_0` and :math:`K_0 + K_1`. [N]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, eq. 1; the frequency there is omega = 2 pi f (module).

    Examples
    --------
    Polyester, 8-strand plaited, 1/2 in, centre point: 6.317 printed (1e4 lb).

    >>> print(apparent_spring_constant(quasi_static_spring_constant=2.014,
    ...     dissipation_spring_constant=4.353, relaxation_time=4.007, frequency=0.3).round(3))
    6.318
    """
    stored, lost = storage_and_loss(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    modulus: Floats = np.hypot(stored, lost)
    return modulus


def hysteresis_energy(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
    tension_amplitude: ArrayLike,
) -> Floats:
    r"""Energy lost in a cycle and unit length, for a tension amplitude.

    .. math:: H = \oint T d\varepsilon
              = \pi \frac{(\Delta T)^2}{K_{ap}^2} E''
              = \frac{\pi K_1 (\Delta T)^2 x}{K_0^2 + (K_0 + K_1)^2 x^2}

    Parameters
    ----------
    quasi_static_spring_constant, dissipation_spring_constant : array_like, shape (...)
        :math:`K_0` and :math:`K_1`. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    frequency : array_like, shape (...)
        :math:`f`; x is 2 pi f tau. [Hz]
    tension_amplitude : array_like, shape (...)
        :math:`\Delta T`, half the range. [N]

    Returns
    -------
    hysteresis_energy : ndarray, shape (...)
        Area of the loop of tension against strain. [J m-1]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, eq. 4, which as printed lacks pi and the square on K_0 (module).

    Examples
    --------
    Polyester, 8-strand plaited, 1/2 in, centre point, in lb: 1.392 printed.

    >>> print(hysteresis_energy(quasi_static_spring_constant=20140.0,
    ...     dissipation_spring_constant=43530.0, relaxation_time=4.007, frequency=0.3,
    ...     tension_amplitude=561.0).round(3))
    1.403
    """
    stored, lost = storage_and_loss(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    (amplitude,) = _at_least_zero(tension_amplitude=tension_amplitude)
    energy: Floats = np.pi * amplitude**2 * lost / (stored**2 + lost**2)
    return energy

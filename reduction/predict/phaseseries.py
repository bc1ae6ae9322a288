r"""Sums of harmonics of a phase, and the phases at which such a sum vanishes.

A real sum of harmonics up to order M is written with complex coefficients,

.. math:: f(\theta) = \sum_{m=-M}^{M} c_m e^{i m \theta}, \qquad c_{-m} = \overline{c_m}

so that z^M f is a polynomial in :math:`z = e^{i \theta}`, and the zeros of f are those of its
roots that lie on the unit circle.

References
----------
.. [1] J. P. Boyd, "Computing the zeros, maxima and inflection points of Chebyshev, Legendre
   and Fourier series: solving transcendental equations by spectral interpolation and
   polynomial rootfinding," J. Eng. Math., vol. 56, 2006, pp. 203-219, sec. 6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.errors import DataError
from reduction.record import Floats

Coefficients = NDArray[np.complex128]

_ZERO = 1e-14  # outermost coefficients below this share of the largest are rounding


def cosine_series(amplitude: Floats, constant: float = 0.0) -> Coefficients:
    """Coefficients of a constant and cosines.

    Parameters
    ----------
    amplitude : ndarray, shape (n_harmonics,)
        Of cos n(phase), n from 1. [1] or that of the quantity, e.g. [m s-1]
    constant : float
        Mean of the sum, in the same unit. [1]

    Returns
    -------
    coefficients : ndarray of complex, shape (2 n_harmonics + 1,)
        From order -n_harmonics upwards, in the same unit. [1]

    Raises
    ------
    DataError
        If the amplitudes are not a series.

    Notes
    -----
    cos x = (e^ix + e^-ix) / 2.

    Examples
    --------
    >>> print(cosine_series(np.array([2.0]), 3.0).real)
    [1. 3. 1.]
    """
    half = _amplitudes(amplitude) / 2
    return np.concatenate([half[::-1], [constant], half]).astype(np.complex128)


def sine_series(amplitude: Floats) -> Coefficients:
    """Coefficients of sines.

    Parameters
    ----------
    amplitude : ndarray, shape (n_harmonics,)
        Of sin n(phase), n from 1. [1] or that of the quantity, e.g. [m s-1]

    Returns
    -------
    coefficients : ndarray of complex, shape (2 n_harmonics + 1,)
        From order -n_harmonics upwards, in the same unit. [1]

    Raises
    ------
    DataError
        If the amplitudes are not a series.

    Notes
    -----
    sin x = (e^ix - e^-ix) / 2i.

    Examples
    --------
    >>> print(sine_series(np.array([2.0])).imag)
    [ 1. 0. -1.]
    """
    half = _amplitudes(amplitude) / 2j
    return np.concatenate([-half[::-1], [0.0], half]).astype(np.complex128)


def phase_derivative(coefficients: Coefficients) -> Coefficients:
    """Coefficients of the derivative by the phase.

    Parameters
    ----------
    coefficients : ndarray of complex, shape (..., 2 n_harmonics + 1)
        Of a sum. [1]

    Returns
    -------
    derivative : ndarray of complex, shape (..., 2 n_harmonics + 1)
        Of its derivative, per radian. [rad-1]

    Raises
    ------
    DataError
        If the coefficients are not of an odd number.

    Notes
    -----
    i m c_m.

    Examples
    --------
    The derivative of 2 cos is -2 sin.

    >>> print(phase_derivative(cosine_series(np.array([2.0]))).imag)
    [-1. 0. 1.]
    """
    return np.asarray(1j * _orders(coefficients) * coefficients)


def series_product(first: Coefficients, second: Coefficients) -> Coefficients:
    """Coefficients of the product of two sums.

    Parameters
    ----------
    first, second : ndarray of complex, shape (2 n_harmonics + 1,)
        Of the factors. [1]

    Returns
    -------
    product : ndarray of complex, shape (2 (n_first + n_second) + 1,)
        Of the product. [1]

    Raises
    ------
    DataError
        If the coefficients are not of an odd number.

    Notes
    -----
    The convolution of the two.

    Examples
    --------
    4 cos^2 is 2 + 2 cos of the double phase.

    >>> cosine = cosine_series(np.array([2.0]))
    >>> print(series_product(cosine, cosine).real)
    [1. 0. 2. 0. 1.]
    """
    _orders(first), _orders(second)
    return np.convolve(first, second)


def sum_at(coefficients: Coefficients, phase: Floats) -> Floats:
    """Value of a sum at phases.

    Parameters
    ----------
    coefficients : ndarray of complex, shape (2 n_harmonics + 1,)
        Of the sum. [1]
    phase : ndarray, shape (...)
        Where. [rad]

    Returns
    -------
    value : ndarray, shape (...)
        In the unit of the coefficients. [1]

    Raises
    ------
    DataError
        If the coefficients are not of an odd number.

    Notes
    -----
    Real, since the coefficients of opposite orders are conjugate.

    Examples
    --------
    >>> print(sum_at(cosine_series(np.array([2.0]), 3.0), np.array([0.0, np.pi])))
    [5. 1.]
    """
    waves = np.exp(1j * np.multiply.outer(phase, _orders(coefficients)))
    return np.asarray((waves @ coefficients).real)


def root_phases(coefficients: Coefficients) -> Floats:
    """Phases of all roots of z^M f, on the unit circle or not.

    Parameters
    ----------
    coefficients : ndarray of complex, shape (..., 2 n_harmonics + 1)
        Of the sums, in any unit. [1]

    Returns
    -------
    phase : ndarray, shape (..., n_roots)
        Among them every zero of the sum; 0 where a sum has fewer roots than others. [rad]

    Raises
    ------
    DataError
        If the coefficients are not of an odd number.

    Notes
    -----
    Eigenvalues of the companion matrix ([1]_).  Roots off the circle are kept: who looks
    for the greatest value of a function tries them all and needs no tolerance to tell them
    apart.  Outermost orders that are rounding are left out.

    Examples
    --------
    >>> print(np.sort(root_phases(cosine_series(np.array([1.0])))).round(6))
    [-1.570796  1.570796]
    """
    orders = _orders(coefficients)
    rows = np.reshape(coefficients, (-1, orders.size))
    size = np.abs(rows)
    is_there = size > _ZERO * size.max(axis=-1, keepdims=True)
    order_of = np.max(np.where(is_there, orders, 0), axis=-1)
    phase = np.zeros((len(rows), max(2 * int(order_of.max(initial=0)), 1)))
    for order in range(1, int(order_of.max(initial=0)) + 1):
        alike = order_of == order
        middle = orders.size // 2
        falling = rows[alike, middle - order : middle + order + 1][:, ::-1]
        companion = np.zeros((len(falling), 2 * order, 2 * order), dtype=np.complex128)
        companion[:, 0, :] = -falling[:, 1:] / falling[:, :1]
        companion[:, np.arange(1, 2 * order), np.arange(2 * order - 1)] = 1.0
        phase[alike, : 2 * order] = np.angle(np.linalg.eigvals(companion))
    return phase.reshape(*np.shape(coefficients)[:-1], phase.shape[1])


def _amplitudes(amplitude: Floats) -> Floats:
    array = np.asarray(amplitude, dtype=np.float64)
    if array.ndim != 1:
        raise DataError(
            "the amplitudes are not a series", found=f"shape {array.shape}", needed="(n_harmonics,)"
        )
    return array


def _orders(coefficients: Coefficients) -> NDArray[np.int64]:
    n_coefficients = np.shape(coefficients)[-1]
    if n_coefficients % 2 == 0:
        raise DataError(
            "the coefficients have no middle", found=f"{n_coefficients}", needed="an odd number"
        )
    middle = n_coefficients // 2
    return np.arange(-middle, middle + 1, dtype=np.int64)

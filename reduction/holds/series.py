r"""Prony series: the tension it gives, and what a finite ramp leaves of each term.

.. math:: T(t) = T_\infty + \sum_i T_i e^{-t/\tau_i}

References
----------
.. [1] W. G. Knauss and J. Zhao, "Improved relaxation time coverage in ramp-strain
   histories," Mech. Time-Depend. Mater. 11, 2007 (correction for the finite ramp).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats

SMALLEST_RATIO = 1e-12


def ramp_factor(relaxation_time: ArrayLike, *, ramp_duration: float) -> Floats:
    r"""Share of a Prony term that is left at the end of a constant-rate ramp.

    .. math:: \frac{1 - e^{-t_r/\tau}}{t_r/\tau}

    Parameters
    ----------
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    ramp_duration : float
        :math:`t_r`; 0 for a step. [s]

    Returns
    -------
    factor : ndarray, shape (...)
        1 for a step or a slow term. [1]

    Raises
    ------
    DataError
        If the duration is negative, or a time is not positive.

    Notes
    -----
    Time counts from the end of the ramp.  Counted from its start the factor reads
    :math:`(e^{t_r/\tau} - 1)/(t_r/\tau)`, the usual form ([1]_); the two differ by
    :math:`e^{t_r/\tau}`.

    Examples
    --------
    >>> print(ramp_factor([1.0, 100.0], ramp_duration=2.0).round(4))
    [0.4323 0.9901]
    """
    if ramp_duration < 0:
        raise DataError("the ramp has a negative duration", found=f"{ramp_duration:g} s")
    times = as_positive("relaxation_time", relaxation_time)
    # The quotient tends to 1; below this it would be 0 over 0.
    ratio = np.maximum(ramp_duration / times, SMALLEST_RATIO)
    factor: Floats = -np.expm1(-ratio) / ratio
    return factor


def prony_tension(
    elapsed: ArrayLike,
    *,
    tension: ArrayLike,
    relaxation_time: ArrayLike,
    long_time_tension: float,
    ramp_duration: float = 0.0,
) -> Floats:
    """Tension of a Prony series at constant length after a constant-rate ramp.

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time from the end of the ramp. [s]
    tension, relaxation_time : array_like, shape (n_terms,)
        Terms. [N], [s]
    long_time_tension : float
        What the series tends to. [N]
    ramp_duration : float, optional
        Duration of the ramp. [s]

    Returns
    -------
    tension : ndarray, shape (n_samples,)
        Tension. [N]

    Raises
    ------
    DataError
        If a relaxation time is not positive.

    Examples
    --------
    >>> print(prony_tension([0.0, 60.0], tension=[75.0], relaxation_time=[60.0],
    ...                     long_time_tension=325.0).round(2))
    [400.   352.59]
    """
    times = as_positive("relaxation_time", relaxation_time)
    size = np.asarray(tension, dtype=np.float64) * ramp_factor(times, ramp_duration=ramp_duration)
    decay = exponentials(np.asarray(elapsed, dtype=np.float64), times)
    return long_time_tension + decay @ size


def exponentials(elapsed: Floats, relaxation_time: Floats) -> Floats:
    r"""Columns :math:`e^{-t/\tau_i}` of a Prony series.

    Parameters
    ----------
    elapsed : ndarray, shape (n_samples,)
        Time. [s]
    relaxation_time : ndarray, shape (n_terms,) or (..., 1, n_terms)
        Times of the terms, or several sets of them. [s]

    Returns
    -------
    columns : ndarray, shape (..., n_samples, n_terms)
        1 at time zero. [1]

    Raises
    ------
    ValueError
        If the times are not one-dimensional.

    Examples
    --------
    >>> print(exponentials(np.array([0.0, 1.0]), np.array([1.0])).round(3).ravel())
    [1.    0.368]
    """
    columns: Floats = np.exp(-elapsed[:, None] / relaxation_time)
    return columns

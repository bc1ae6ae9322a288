"""Creep: strain gained at constant tension.

References
----------
.. [1] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_increasing, as_same_shape
from reduction.errors import DataError
from reduction.holds.blocks import logarithmic_blocks
from reduction.holds.relaxation import Rate, rate_per_decade

TENSION_TOLERANCE = 0.01


def tension_variation(time: ArrayLike, tension: ArrayLike) -> float:
    """Largest departure of tension from its mean over a hold, as a share of the mean.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Time from the centre of the ramp, increasing and positive. [s]
    tension : array_like, shape (n_samples,)
        Tension. [N]

    Returns
    -------
    variation : float
        Of means over twenty blocks a decade, so that noise of single samples does not
        count but drift does. [1]

    Raises
    ------
    DataError
        If the mean tension is not positive, or the time does not increase from above zero.

    Examples
    --------
    >>> print(tension_variation([1.0, 10.0, 100.0], [100.0, 102.0, 98.0]))
    0.02
    """
    blocks = logarithmic_blocks(time, tension, per_decade=20)
    mean = float(np.mean(blocks.value))
    if mean <= 0:
        raise DataError("creep under no tension", found=f"{mean:.3g} N", needed="tension above 0")
    return float(np.max(np.abs(blocks.value - mean))) / mean


def creep_rate(
    time: ArrayLike, strain: ArrayLike, tension: ArrayLike, *, ramp_duration: float
) -> Rate:
    """Strain gained per decade of time at constant tension.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Time from the centre of the ramp, increasing and positive. [s]
    strain : array_like, shape (n_samples,)
        Strain of the free length. [1]
    tension : array_like, shape (n_samples,)
        Tension. [N]
    ramp_duration : float
        Duration of the equivalent ramp. [s]

    Returns
    -------
    rate : Rate
        Slope of strain against log10(time). [1]

    Raises
    ------
    DataError
        If tension strays from its mean by more than 1 % after the ramp, or the hold is too
        short (`rate_per_decade`).

    Notes
    -----
    A specimen held at constant length by a moving tension does not creep; it relaxes.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> rate = creep_rate(t, 1 + 0.02 * np.log10(t), np.full(1000, 400.0), ramp_duration=2.0)
    >>> print(round(rate.value, 4))
    0.02
    """
    seconds = as_increasing("time", time)
    seconds, stretch, load = as_same_shape(time=seconds, strain=strain, tension=tension)
    variation = tension_variation(seconds, load)
    if variation > TENSION_TOLERANCE:
        raise DataError(
            f"tension is not constant: it strays {variation:.1%} from its mean",
            needed=f"{TENSION_TOLERANCE:.0%} or less",
        )
    return rate_per_decade(logarithmic_blocks(seconds, stretch), ramp_duration=ramp_duration)

r"""Whether one relaxation time holds over frequency.

At equal loads a line of three parameters has one tau whatever the frequency; a material
with a loss angle that does not change with frequency gives a tau that falls as 1/f.  With
one intercept a load,

.. math:: \ln \tau = a_g - n \ln f, \qquad n = 0: \text{one } \tau, \qquad n = 1: \tau \propto 1/f

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 11 and 17 and sec. 4.4.5 ("a
   major departure from the theory represented in equation (4)").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ndtr, ndtri, stdtr, stdtrit

from reduction.checks import as_positive
from reduction.errors import DataError, SettingsError
from reduction.record import Floats, Integers, read_only_arrays

VERDICTS: dict[int, str] = {
    0: "not decided: the interval of the exponent reaches both 0 and 1",
    1: "one relaxation time holds over frequency: the interval reaches 0 and not 1",
    2: "the relaxation time follows 1/f: the interval reaches 1 and not 0, so tau re-expresses "
    "a loss angle that hardly changes with frequency",
    3: "neither: the relaxation time changes with frequency, and not as 1/f",
    4: "not decided: too few frequencies at equal loads, or no scatter to judge them by",
}


@dataclass(frozen=True)
@read_only_arrays
class SingleTimeCheck:
    """How the relaxation time of lines changes with frequency; arrays have shape (...).

    Parameters
    ----------
    exponent, exponent_standard_uncertainty : ndarray
        n of tau ~ f^-n. [1]
    exponent_low, exponent_high : ndarray
        Interval of n. [1]
    p_one_time, p_inverse_frequency : ndarray
        Probability of an estimate as far from exactly 0 (one tau), and from 1 (1/f). [1]
    time_ratio, time_ratio_low, time_ratio_high : ndarray
        tau at the lowest over tau at the highest frequency, by the fit; 1 where one tau
        holds and ``frequency_ratio`` where tau follows 1/f. [1]
    frequency_ratio : ndarray
        Highest over lowest frequency. [1]
    degrees_of_freedom : ndarray of int
        Of the scatter about the fit; 0 where the stated uncertainties were used. [1]
    loss_exponent, loss_exponent_low, loss_exponent_high : ndarray
        m of tan(loss angle) ~ f^m, with its interval; 0 for a constant loss angle, near -1
        for one tau far above its frequency. [1]
    verdict : ndarray of int8
        Key of `VERDICTS`.
    confidence, tolerance : float
        Of the intervals, and by which they may miss 0 or 1. [1]
    """

    exponent: Floats
    exponent_standard_uncertainty: Floats
    exponent_low: Floats
    exponent_high: Floats
    p_one_time: Floats
    p_inverse_frequency: Floats
    time_ratio: Floats
    time_ratio_low: Floats
    time_ratio_high: Floats
    frequency_ratio: Floats
    degrees_of_freedom: Integers
    loss_exponent: Floats
    loss_exponent_low: Floats
    loss_exponent_high: Floats
    verdict: NDArray[np.int8]
    confidence: float
    tolerance: float


def _membership(group: ArrayLike | None, n_runs: int) -> Floats:
    """One row a group of runs at equal loads, 1 where a run belongs to it."""
    labels = np.zeros(n_runs, dtype=np.int64) if group is None else np.asarray(group)
    if labels.shape != (n_runs,):
        raise DataError(
            "groups of equal loads do not fit the runs",
            found=f"shape {labels.shape}",
            needed=f"({n_runs},)",
        )
    member: Floats = (np.unique(labels)[:, None] == labels).astype(np.float64)
    return member


def power_of_frequency(
    frequency: ArrayLike,
    values: ArrayLike,
    *,
    group: ArrayLike | None = None,
    relative_standard_uncertainty: ArrayLike | None = None,
) -> tuple[Floats, Floats, Integers]:
    r"""Exponent of a power law of frequency, with one factor for each group of runs.

    .. math:: \ln y = a_g + m \ln f

    Parameters
    ----------
    frequency : array_like, shape (n_runs,)
        Of each run. [Hz]
    values : array_like, shape (..., n_runs)
        Positive; a run that is NaN or not positive is left out. [any]
    group : array_like, shape (n_runs,), optional
        Label of the loads of each run; left out, all runs have equal loads. [1]
    relative_standard_uncertainty : array_like, shape (..., n_runs), optional
        Of the values; used where the runs leave no degree of freedom. [1]

    Returns
    -------
    exponent, standard_uncertainty : ndarray, shape (...)
        NaN where no group has two frequencies, or nothing says how uncertain it is. [1]
    degrees_of_freedom : ndarray of int, shape (...)
        Runs less groups less one; 0 where none is left. [1]

    Raises
    ------
    DataError
        If a frequency is not positive, or shapes do not fit.

    Notes
    -----
    The check that [1]_ did not make on its runs.  Runs count alike: from the third run on,
    their scatter about the line is the uncertainty, lack of fit included.

    Examples
    --------
    >>> m, _, dof = power_of_frequency([0.1, 0.3, 0.5], [10.0, 30.0, 50.0])
    >>> print(m.round(6), dof)
    1.0 1
    """
    x = np.log(as_positive("frequency", frequency))
    series = np.asarray(values, dtype=np.float64)
    if x.ndim != 1 or series.shape[-1:] != x.shape:
        raise DataError(
            "runs do not pair up",
            found=f"frequency {x.shape}, values {series.shape}",
            needed="one frequency a run, on the last axis of the values",
        )
    member = _membership(group, x.size)
    used = np.isfinite(series) & (series > 0)
    y = np.log(np.where(used, series, 1.0))
    weight = used.astype(np.float64)
    count = weight @ member.T
    present = np.maximum(count, 1)
    x_own = x - (weight * x) @ member.T / present @ member
    y_own = y - (weight * y) @ member.T / present @ member
    power = (weight * x_own**2).sum(axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        # runs at one frequency leave rounding errors of its logarithm
        slope = np.where(power > 1e-12, (weight * x_own * y_own).sum(axis=-1) / power, np.nan)
        left = weight.sum(axis=-1) - (count > 0).sum(axis=-1) - 1
        residual = weight * (y_own - slope[..., None] * x_own)
        scatter = np.sqrt((residual**2).sum(axis=-1) / np.maximum(left, 1) / power)
        stated = np.full(slope.shape, np.nan)
        if relative_standard_uncertainty is not None:
            relative = np.asarray(relative_standard_uncertainty, dtype=np.float64)
            moved = np.where(used, x_own * relative, 0.0)
            stated = np.sqrt((moved**2).sum(axis=-1)) / power
    uncertainty = np.where(left > 0, scatter, stated)
    return slope, uncertainty, np.maximum(left, 0).astype(np.int64)


def _quantile(degrees_of_freedom: Integers, confidence: float) -> Floats:
    """Half width of an interval in standard uncertainties; normal where they were stated."""
    t = stdtrit(np.maximum(degrees_of_freedom, 1), (1 + confidence) / 2)
    return np.where(degrees_of_freedom > 0, t, ndtri((1 + confidence) / 2))


def _tail(distance: Floats, degrees_of_freedom: Integers) -> Floats:
    """Probability of a distance as large, in standard uncertainties, on both sides."""
    t = 2 * stdtr(np.maximum(degrees_of_freedom, 1), -np.abs(distance))
    return np.where(degrees_of_freedom > 0, t, 2 * ndtr(-np.abs(distance)))


def check_single_time(
    frequency: ArrayLike,
    relaxation_time: ArrayLike,
    loss_factor: ArrayLike,
    *,
    group: ArrayLike | None = None,
    relative_standard_uncertainty: ArrayLike | None = None,
    confidence: float = 0.95,
    tolerance: float = 0.1,
) -> SingleTimeCheck:
    r"""Whether one relaxation time holds over the frequencies of some runs.

    .. math:: \ln \tau = a_g - n \ln f

    Parameters
    ----------
    frequency : array_like, shape (n_runs,)
        Of each run. [Hz]
    relaxation_time : array_like, shape (..., n_runs)
        tau of each run, of one line or of many; NaN is left out. [s]
    loss_factor : array_like, shape (..., n_runs)
        Tangent of the loss angle of each run. [1]
    group : array_like, shape (n_runs,), optional
        Label of the loads of each run: only runs at equal loads are compared. [1]
    relative_standard_uncertainty : array_like, shape (..., n_runs), optional
        Of tau, without the part of K_0, which runs at equal loads share; used where the
        runs leave no degree of freedom, as two frequencies at one load do. [1]
    confidence : float, optional
        Of the intervals. [1]
    tolerance : float, optional
        An exponent this near to 0 or 1 is as good as it: many runs would else tell 0.95
        from 1, and no line is exactly either. [1]

    Returns
    -------
    check : SingleTimeCheck
        Exponent, ratio of times, tests and verdict.

    Raises
    ------
    DataError
        If shapes do not fit or a frequency is not positive.
    SettingsError
        If the confidence is not between 0 and 1, or the tolerance not between 0 and 0.5.

    Notes
    -----
    Source: Table 17 of [1]_ prints tau with terms of frequency as large as its mean: at the
    centre loads tau(0.1 Hz)/tau(0.5 Hz) is 2.85 to 14, where 1/f gives 5.  A fifteen-run
    design has four pairs of extreme frequencies at equal loads; with its centre runs in a
    group of their own that is 8 runs, 4 factors and 3 degrees of freedom.

    Examples
    --------
    >>> f = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    >>> wobble = 1 + 0.02 * np.array([1, -1, 1, -1, 0])
    >>> check = check_single_time(f, 0.6 / f * wobble, 0.1 * wobble)
    >>> print(check.exponent.round(2), check.time_ratio.round(1), VERDICTS[int(check.verdict)][:34])
    1.01 5.1 the relaxation time follows 1/f: t
    """
    if not 0 < confidence < 1:
        raise SettingsError("a confidence is a share", found=f"{confidence:g}", needed="0 to 1")
    if not 0 <= tolerance < 0.5:
        raise SettingsError(
            "a tolerance of the exponent", found=f"{tolerance:g}", needed="0 to 0.5"
        )
    slope, uncertainty, left = power_of_frequency(
        frequency,
        relaxation_time,
        group=group,
        relative_standard_uncertainty=relative_standard_uncertainty,
    )
    loss_slope, loss_uncertainty, loss_left = power_of_frequency(
        frequency, loss_factor, group=group
    )
    exponent = -slope
    width = _quantile(left, confidence) * uncertainty
    loss_width = _quantile(loss_left, confidence) * loss_uncertainty
    rates = np.asarray(frequency, dtype=np.float64)
    used = np.asarray(relaxation_time) > 0
    highest = np.where(used, rates, -np.inf).max(axis=-1)
    lowest = np.where(used, rates, np.inf).min(axis=-1)
    span = np.where(np.isfinite(highest), highest, 1) / np.where(np.isfinite(lowest), lowest, 1)
    low, high = exponent - width, exponent + width
    with np.errstate(divide="ignore", invalid="ignore"):
        holds_none, holds_one = (
            (low <= exact + tolerance) & (high >= exact - tolerance) for exact in (0, 1)
        )
        verdict = np.select(
            [~np.isfinite(width), holds_none & holds_one, holds_none, holds_one],
            [4, 0, 1, 2],
            default=3,
        ).astype(np.int8)
        p_none = _tail(exponent / uncertainty, left)
        p_inverse = _tail((exponent - 1) / uncertainty, left)
    return SingleTimeCheck(
        exponent=exponent,
        exponent_standard_uncertainty=uncertainty,
        exponent_low=low,
        exponent_high=high,
        p_one_time=p_none,
        p_inverse_frequency=p_inverse,
        time_ratio=span**exponent,
        time_ratio_low=span**low,
        time_ratio_high=span**high,
        frequency_ratio=span,
        degrees_of_freedom=left,
        loss_exponent=loss_slope,
        loss_exponent_low=loss_slope - loss_width,
        loss_exponent_high=loss_slope + loss_width,
        verdict=verdict,
        confidence=confidence,
        tolerance=tolerance,
    )

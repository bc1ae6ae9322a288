r"""Prony series of a relaxation: number of terms that the record supports, and their values.

**Prony series: its tension, and the part of each term left by a finite ramp**:

.. math:: T(t) = T_\infty + \sum_i T_i e^{-t/\tau_i}

References
----------
.. [1] W. G. Knauss and J. Zhao, "Improved relaxation time coverage in ramp-strain histories,"
   Mech. Time-Depend. Mater. 11, 2007 (correction for the finite ramp).
.. [2] G. H. Golub and V. Pereyra, "Separable nonlinear least squares: the variable projection
   method and its applications," Inverse Problems 19(2), 2003.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Floats, read_only_arrays
from reduction.stages.moduli.least_squares import SeparableFit, fit_separable, lag_one_inflation

SMALLEST_RATIO = 1e-12


def _ramp_factor(relaxation_time: ArrayLike, *, ramp_duration: float) -> Floats:
    r"""Fraction of a Prony term left at the end of a constant-rate ramp.

    .. math:: \frac{1 - e^{-t_r/\tau}}{t_r/\tau}

    Notes
    -----
    Time counts from the end of the ramp.  Counted from its start, the factor is
    :math:`(e^{t_r/\tau} - 1)/(t_r/\tau)`, the usual form ([1]_); the two differ by
    :math:`e^{t_r/\tau}`.

    Examples
    --------
    >>> print(_ramp_factor([1.0, 100.0], ramp_duration=2.0).round(4))
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

    Examples
    --------
    >>> print(prony_tension([0.0, 60.0], tension=[75.0], relaxation_time=[60.0],
    ...                     long_time_tension=325.0).round(2))
    [400.   352.59]
    """
    times = as_positive("relaxation_time", relaxation_time)
    size = np.asarray(tension, dtype=np.float64) * _ramp_factor(times, ramp_duration=ramp_duration)
    decay = _exponentials(np.asarray(elapsed, dtype=np.float64), times)
    return long_time_tension + decay @ size


def _exponentials(elapsed: Floats, relaxation_time: Floats) -> Floats:
    r"""Columns :math:`e^{-t/\tau_i}` of a Prony series.

    Examples
    --------
    >>> print(_exponentials(np.array([0.0, 1.0]), np.array([1.0])).round(3).ravel())
    [1.    0.368]
    """
    columns: Floats = np.exp(-elapsed[:, None] / relaxation_time)
    return columns


def left_by_ramp(
    added: ArrayLike,
    at_end: Floats,
    relaxation_time: Floats,
    *,
    ramp_duration: float,
) -> Floats:
    """Fraction of each Prony term left at the end of a ramp of any shape, from its tension.

    What the ramp would add without relaxation follows from what it added, by the terms themselves.

    Parameters
    ----------
    added : array_like, shape (n_times,)
        Tension that the ramp had added at even times up to its end. [N]
    at_end, relaxation_time : ndarray, shape (n_terms,)
        Terms as they are at the end of the ramp. [N], [s]
    ramp_duration : float
        [s]

    Returns
    -------
    left : ndarray, shape (n_terms,)
        [1]

    Examples
    --------
    A constant-rate ramp of a term that relaxes as fast:

    >>> t = np.linspace(0.0, 5.0, 65)
    >>> left = _ramp_factor([5.0], ramp_duration=5.0)
    >>> logged = 240 * t / 5 + 160 * (1 - np.exp(-t / 5))
    >>> print(left.round(3),
    ...       left_by_ramp(logged, 160 * left, np.array([5.0]), ramp_duration=5.0).round(3))
    [0.632] [0.632]
    """
    logged = np.asarray(added, dtype=np.float64)
    ratio = ramp_duration / (logged.size - 1) / relaxation_time
    decay, gain = np.exp(-ratio), -np.expm1(-ratio) / ratio
    left = np.ones_like(at_end)
    for _ in range(MOST_PASSES):
        before, step = left, at_end / left
        share = step / (logged[-1] + np.sum(step - at_end))
        rest = 1.0 - share.sum()
        elastic, states = 0.0, np.zeros(relaxation_time.size)
        for load in logged[1:]:
            states = states * decay
            push = (load - rest * elastic - share @ states) / (rest + share @ gain)
            elastic += push
            states = states + gain * push
        left = np.clip(states / elastic, SMALLEST_RATIO, 1.0)
        if np.allclose(left, before, rtol=1e-4):
            break
    return left


MOST_PASSES = 30


_DEGENERATE = "terms not positive, or not distinct"

GRID_TIMES = 20

STARTS = 3

DECISIVE = 10.0

LONGEST_TIME = 2.0

SHORTEST_SHARE = 0.05
"""Time of a term relative to the ramp before it, of which the ramp leaves as much, below which the
term would be the corner of the ramp, not the specimen. [1]"""

LARGEST_SHARE = 0.5
"""Relative uncertainty of a term, or of its time, beyond which there is no series. [1]"""

LEAST_MISFIT = 2e-4
"""Misfit below which a series is not judged, as a share of the range of tension. [1]"""

LARGEST_LOG = 50.0

STILL_RELAXES = 3**-0.5
"""Standard uncertainty of a long-time tension, as a fraction of the loss per decade of time at the
end of the hold: slower terms, which the hold does not show, take up to that. [1]"""


@dataclass(frozen=True)
@read_only_arrays
class PronyFit:
    """A Prony series with its standard uncertainties (type A).

    Parameters
    ----------
    tension, time : ndarray, shape (n_terms,)
        Terms after a step in length, shortest time first. [N], [s]
    tension_standard_uncertainty, time_standard_uncertainty : ndarray, shape (n_terms,)
        [N], [s]
    left : ndarray, shape (n_terms,)
        Fraction of each term left at the end of the ramp. [1]
    long_time_tension, long_time_tension_standard_uncertainty : float
        [N]
    criterion : str
        How the number of terms was chosen.
    """

    tension: Floats
    tension_standard_uncertainty: Floats
    time: Floats
    time_standard_uncertainty: Floats
    left: Floats
    long_time_tension: float
    long_time_tension_standard_uncertainty: float
    criterion: str


def _starts(
    elapsed: Floats, tension: Floats, weights: Floats, grid: Floats, n_terms: int
) -> Floats:
    """Best sets of times of a coarse grid with positive terms, from one Gram matrix."""
    root = np.sqrt(weights)[:, None]
    columns = np.column_stack([np.ones_like(elapsed), _exponentials(elapsed, grid)]) * root
    target = tension * root[:, 0]
    gram, product = columns.T @ columns, columns.T @ target
    sets = np.array(list(combinations(range(1, grid.size + 1), n_terms)))
    index = np.column_stack([np.zeros(len(sets), dtype=np.intp), sets])
    small = gram[index[:, :, None], index[:, None, :]]
    # A ridge far below the noise separates neighbours of the grid.
    small = small + 1e-10 * np.trace(gram) / gram.shape[0] * np.eye(n_terms + 1)
    right = product[index]
    size = np.linalg.solve(small, right[..., None])[..., 0]
    gain = np.where((size[:, 1:] > 0).all(axis=1), np.sum(size * right, axis=1), -np.inf)
    order = np.argsort(-gain, kind="stable")[:STARTS]
    starts: Floats = np.log(grid[sets[order[np.isfinite(gain[order])]] - 1])
    return starts


def _is_positive(fit: SeparableFit) -> bool:
    return bool(np.all(fit.amplitude[1:] > 0) and fit.amplitude[0] >= 0)


def _terms(number: int) -> str:
    return f"{number} term{'' if number == 1 else 's'}"


def _unsupported(
    fit: SeparableFit, inflation: float, shortest: float, longest: float
) -> str | None:
    """Reason why a fit may not be reported, or None."""
    if not _is_positive(fit):
        return _DEGENERATE
    times, size = np.exp(fit.shape), fit.amplitude[1:]
    uncertainty = fit.standard_uncertainty * np.sqrt(inflation)
    if times.max() > LONGEST_TIME * longest:
        return f"a time of {times.max():.3g} s is too long for a hold of {longest:.3g} s"
    if times.min() < shortest:
        return f"a time of {times.min():.3g} s is shorter than the record resolves"
    if np.any(uncertainty[1 : size.size + 1] > LARGEST_SHARE * size):
        return "a term is uncertain by more than half its size"
    if np.any(uncertainty[size.size + 1 :] > LARGEST_SHARE):
        return "a relaxation time is uncertain by more than half"
    return None


def fit_prony(
    elapsed: ArrayLike,
    tension: ArrayLike,
    *,
    ramp_duration: float = 0.0,
    added: ArrayLike | None = None,
    maximum_terms: int = 3,
    weights: ArrayLike | None = None,
    shared_error: ArrayLike | None = None,
    time_variance: ArrayLike = 0.0,
    known_to: float = 0.0,
) -> PronyFit:
    r"""Prony series of a relaxation with as many terms as the record supports.

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time from the end of the ramp, increasing; a few hundred block means rather than
        every sample of a long hold. [s]
    tension : array_like, shape (n_samples,)
        Tension at constant length. [N]
    ramp_duration : float, optional
        Duration of the ramp before it. [s]
    added : array_like, shape (n_times,), optional
        Tension that the ramp had added at even times up to its end; without it the ramp has a
        constant rate. [N]
    maximum_terms : int, optional
        Largest number of terms tried. [1]
    weights : array_like, shape (n_samples,), optional
        Inverse relative variances. [1]
    shared_error : array_like, shape (n_samples,), optional
        Change of the tensions for a common error of one standard uncertainty. [N]
    time_variance : array_like, shape (n_samples,), optional
        Variance of the times whose mean a sample is: the mean of an exponential exceeds that at
        the mean time. [s2]
    known_to : float, optional
        Standard uncertainty of tension that is not noise: the error left by a correction. [N]

    Returns
    -------
    fit : PronyFit
        Terms for a step in length, shortest time first. [N], [s]

    Raises
    ------
    DataError
        If the series do not pair up, or the number of terms is below one.
    FitError
        If no number of terms is supported; the message gives the reason for each.

    Notes
    -----
    Variable projection ([2]_) from the three best sets of a grid of 20 times.  The
    number of terms has the lowest Bayesian information criterion
    :math:`n' \ln(S/n) + p \ln n'`, where :math:`n' = n (1 - r_1)/(1 + r_1)` is the number of
    independent samples, with :math:`r_1` the correlation of neighbouring residuals in
    the fit in which it is least; :math:`S/n` is at least 2e-4 of the range of
    tension, squared, since no specimen is a series to better than that, and at least ``known_to``
    squared.  A fit is excluded if a term is negative, a time is more than twice the record or
    not resolved at its start, or a term or its time is uncertain by more than half.  No series
    is reported if an excluded one has a criterion lower by more than 10, for then the
    record itself shows that the shorter series is wrong.  Uncertainties are widened by the
    correlation.

    The long-time tension is the limit of the series, not an equilibrium: a longer hold
    would show slower terms.  Where tension still falls at the end of the hold, they exist, and
    the fit understates the uncertainty due to terms that no record can show: the uncertainty of the
    long-time tension includes the loss of one more decade at the last rate (`STILL_RELAXES`).

    Examples
    --------
    >>> t = np.geomspace(0.1, 600, 200)
    >>> truth = 325 + 40 * np.exp(-t / 4) + 35 * np.exp(-t / 70)
    >>> fit = fit_prony(t, truth + 0.1 * np.random.default_rng(0).standard_normal(200))
    >>> print(fit.time.round(0), fit.tension.round(0), round(fit.long_time_tension))
    [ 4. 70.] [40. 35.] 325
    """
    if maximum_terms < 1:
        raise DataError("a series needs a term", found=str(maximum_terms), needed="1 or more")
    time, load = as_same_shape(elapsed=elapsed, tension=tension)
    weight = np.ones_like(time) if weights is None else np.asarray(weights, dtype=np.float64)
    shortest = max(0.5 * float(np.median(np.diff(time[:8]))), SHORTEST_SHARE * ramp_duration)
    longest = float(time[-1])
    grid = np.geomspace(shortest, LONGEST_TIME * longest, GRID_TIMES)
    own = np.broadcast_to(time_variance, time.shape)[:, None]

    def basis(log_times: Floats) -> tuple[Floats, Floats]:
        # A search that strays stays finite.
        times = np.exp(np.minimum(np.maximum(log_times, -LARGEST_LOG), LARGEST_LOG))[:, None, :]
        decay, of_mean = _exponentials(time, times), own / times**2
        level = np.ones((len(log_times), time.size, 1))
        slopes = decay * (time[:, None] / times * (1 + of_mean / 2) - of_mean)
        return np.concatenate([level, decay * (1 + of_mean / 2)], axis=2), slopes

    fits: dict[int, SeparableFit] = {}
    refused: list[str] = []
    for n_terms in range(1, maximum_terms + 1):
        starts = _starts(time, load, weight, grid, n_terms)
        if starts.size == 0 or time.size <= 2 * n_terms + 1:
            refused.append(f"{_terms(n_terms)}: {_DEGENERATE}")
            continue
        try:
            fits[n_terms] = fit_separable(basis, load, starts=starts, weights=weight)
        except FitError:
            refused.append(f"{_terms(n_terms)}: {_DEGENERATE}")
    # whether terms that cancel each other are found depends on the last digits of the library
    # that searches: they do not show how many values are independent
    inflation = min(
        (lag_one_inflation(fit.residual) for fit in fits.values() if _is_positive(fit)),
        default=1.0,
    )
    independent = time.size / inflation
    floor = max((LEAST_MISFIT * float(np.ptp(load))) ** 2, known_to**2, np.finfo(float).tiny)
    scores: dict[int, float] = {}
    supported: list[int] = []
    for n_terms, fit in sorted(fits.items()):
        mean_square = max(fit.residual_sum_of_squares / time.size, floor)
        scores[n_terms] = independent * float(np.log(mean_square)) + (2 * n_terms + 2) * float(
            np.log(independent)
        )
        reason = _unsupported(fit, lag_one_inflation(fit.residual), shortest, longest)
        if reason is None:
            supported.append(n_terms)
        else:
            refused.append(f"{_terms(n_terms)}: {reason}")
    if not supported:
        raise FitError("the record supports no Prony series", found="; ".join(sorted(refused)))
    n_terms = min(supported, key=lambda key: scores[key])
    if scores[n_terms] > min(scores.values()) + DECISIVE:
        raise FitError(
            f"the record supports {_terms(n_terms)}, which fits poorly",
            found="; ".join(sorted(refused)),
        )
    criterion = (
        f"{n_terms} of up to {maximum_terms} terms: lowest Bayesian information criterion "
        f"({independent:.0f} of the {time.size} values count as independent)"
    )
    if np.exp(fits[n_terms].shape.max()) > longest:
        criterion += "; the slowest time is longer than the hold, so its term is extrapolated"
    texts = [criterion, *sorted(refused)]

    def left(times: Floats, at_end: Floats) -> Floats:
        if added is None:
            return _ramp_factor(times, ramp_duration=ramp_duration)
        return left_by_ramp(added, at_end, times, ramp_duration=ramp_duration)

    found = _reported(fits[n_terms], longest, left, "; ".join(texts))
    if shared_error is None or not np.any(shared_error):
        return found
    other = load + as_finite("shared_error", shared_error)
    shifted = fit_separable(basis, other, starts=fits[n_terms].shape, weights=weight)
    return _widened(found, _reported(shifted, longest, left, ""))


def _widened(found: PronyFit, other: PronyFit) -> PronyFit:
    """A series whose uncertainties include the difference from another one."""
    wider = {
        f"{name}_standard_uncertainty": np.hypot(
            getattr(found, f"{name}_standard_uncertainty"),
            getattr(found, name) - getattr(other, name),
        )
        for name in ("tension", "time", "long_time_tension")
    }
    return replace(found, **wider)


def _reported(
    fit: SeparableFit,
    longest: float,
    left: Callable[[Floats, Floats], Floats],
    criterion: str,
) -> PronyFit:
    """Amplitudes for a step, corrected for the ramp, with propagated uncertainties."""
    order = np.argsort(fit.shape)
    n_terms = order.size
    times, at_end = np.exp(fit.shape[order]), fit.amplitude[1 + order]
    index = np.concatenate([[0], 1 + order, 1 + n_terms + order])
    covariance = fit.covariance[np.ix_(index, index)] * lag_one_inflation(fit.residual)
    factor = left(times, at_end)
    size = at_end / factor
    # d(ln factor) / d(ln time): 0 for a step, 1 for terms much shorter than the ramp.
    growth = np.log(left(_A_LITTLE * times, at_end) / factor) / np.log(_A_LITTLE)
    slopes = np.zeros((2 * n_terms, 2 * n_terms + 1))
    terms = np.arange(n_terms)
    slopes[terms, 1 + terms] = 1 / factor
    slopes[terms, 1 + n_terms + terms] = -size * growth
    slopes[n_terms + terms, 1 + n_terms + terms] = times
    variance = np.diag(slopes @ covariance @ slopes.T)
    ending = at_end @ (longest / times * np.exp(-longest / times))
    unseen = STILL_RELAXES * float(np.log(10) * ending)
    return PronyFit(
        tension=size,
        tension_standard_uncertainty=np.sqrt(variance[:n_terms]),
        time=times,
        time_standard_uncertainty=np.sqrt(variance[n_terms:]),
        left=factor,
        long_time_tension=float(fit.amplitude[0]),
        long_time_tension_standard_uncertainty=float(np.hypot(np.sqrt(covariance[0, 0]), unseen)),
        criterion=criterion,
    )


_A_LITTLE = 1.001

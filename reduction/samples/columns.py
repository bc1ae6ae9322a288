"""Columns made of columns block by block, and what they come to as a whole."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.samples.blocks import sample_blocks
from reduction.samples.scratch import empty_like
from reduction.samples.search import Where

Floats = NDArray[np.float64]


def chosen(where: Where, *series: NDArray[Any]) -> tuple[NDArray[Any], ...]:
    """Samples of several series for which a condition on slices is true, beside them.

    Parameters
    ----------
    where : callable
        Of a slice: whether each of its samples is wanted.
    *series : ndarray, shape (n_samples,)
        In memory or on disk. [any]

    Returns
    -------
    kept : tuple of ndarray, shape (n_kept,)
        The series themselves where all is wanted. [as series]

    Raises
    ------
    IndexError
        If the series differ in length and not all is wanted.

    Examples
    --------
    >>> values = np.array([5.0, np.nan, 7.0])
    >>> chosen(lambda part: np.isfinite(values[part]), np.arange(3), values)
    (array([0, 2]), array([5., 7.]))
    """
    n_samples = series[0].size
    counts = [int(np.count_nonzero(where(part))) for part in sample_blocks(n_samples, *series)]
    n_kept = sum(counts)
    if n_kept == n_samples:
        return series
    kept = tuple(empty_like(one, shape=n_kept) for one in series)
    ends = np.cumsum(counts, dtype=np.intp)
    for number, part in enumerate(sample_blocks(n_samples, *series, *kept)):
        wanted = where(part)
        for one, made in zip(series, kept, strict=True):
            made[ends[number] - counts[number] : ends[number]] = one[part][wanted]
    return kept


def shifted(series: Floats, by: float) -> Floats:
    """Series less a number, shape (n_samples,); on disk where the series is.

    Examples
    --------
    >>> shifted(np.array([5.0, 7.0]), 5.0)
    array([0., 2.])
    """
    made = empty_like(series)
    for part in sample_blocks(series.size, series, made):
        np.subtract(series[part], by, out=made[part])
    return made


def mean_of(series: Floats) -> float:
    """Mean of a series of one sample or more.

    Notes
    -----
    Samples are summed as they differ from the first one: of a level that hardly changes the sum
    of blocks of any length then gives the same mean to the last digit or two.

    Examples
    --------
    >>> mean_of(np.array([1.0, 2.0]))
    1.5
    """
    first = float(series[0])
    parts = sample_blocks(series.size, series)
    return first + float(sum((series[part] - first).sum() for part in parts)) / series.size


def median_step_reaches(series: Floats, factor: float, value: float) -> bool:
    """Whether a multiple of the median difference of neighbours is as great as a value.

    Parameters
    ----------
    series : ndarray, shape (n_samples,)
        Two samples or more, such as times. [any]
    factor : float
        Positive. [1]
    value : float
        What the multiple is held against. [as series]

    Returns
    -------
    reaches : bool
        As ``factor * np.median(np.diff(series)) >= value`` has it. [1]

    Raises
    ------
    ZeroDivisionError
        If there is no difference.

    Notes
    -----
    The median lies where half of the differences are below it, so it need not be known: they are
    counted.  Where one half is below and the other is not, it is the mean of the two beside.

    Examples
    --------
    >>> median_step_reaches(np.array([0.0, 1.0, 2.0, 9.0]), 3.0, 7.0)
    False
    """
    n_below, below, above = 0, -np.inf, np.inf
    for part in sample_blocks(series.size, series, overlap=1):
        steps = np.diff(series[part])
        is_below = factor * steps < value
        n_below += int(np.count_nonzero(is_below))
        below = max(below, float(steps[is_below].max(initial=-np.inf)))
        above = min(above, float(steps[~is_below].min(initial=np.inf)))
    share = 2 * n_below / (series.size - 1)
    return share < 1 or (share == 1 and bool(factor * ((below + above) / 2) >= value))

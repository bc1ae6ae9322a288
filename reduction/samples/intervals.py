"""Intervals of samples: a label for each sample of them, and what their samples come to."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.samples.blocks import BLOCK, sample_blocks
from reduction.samples.scratch import empty_like, let_go


def interval_labels(
    like: NDArray[Any],
    first: NDArray[np.integer[Any]],
    stop: NDArray[np.integer[Any]],
    values: NDArray[Any],
) -> NDArray[Any]:
    """Value of the interval of each sample, 0 outside all.

    Parameters
    ----------
    like : ndarray, shape (..., n_samples)
        A series of the record, beside which the labels lie. [any]
    first, stop : ndarray of int, shape (n_intervals,)
        First sample, and the one after the last; in order, without overlap. [1]
    values : ndarray, shape (n_intervals,)
        One an interval. [any]

    Returns
    -------
    labels : ndarray, shape (n_samples,)
        Of the type of the values. [as values]

    Raises
    ------
    ValueError
        If intervals overlap.

    Examples
    --------
    >>> interval_labels(np.zeros(5), np.array([1, 3]), np.array([2, 5]), np.array([7, 8]))
    array([0, 7, 0, 8, 8])
    """
    edges = np.column_stack([first, stop]).ravel()
    between = np.zeros(edges.size + 1, dtype=values.dtype)
    between[1::2] = values
    labels = empty_like(like, shape=like.shape[-1], dtype=values.dtype)
    for part in sample_blocks(labels.size, labels):
        inside = slice(*np.searchsorted(edges, [part.start, part.stop]))
        lengths = np.diff(np.concatenate([[part.start], edges[inside], [part.stop]]))
        labels[part] = np.repeat(between[inside.start : inside.stop + 1], lengths)
    return labels


def over_intervals(
    operation: np.ufunc,
    series: NDArray[Any],
    first: NDArray[np.integer[Any]],
    stop: NDArray[np.integer[Any]],
) -> NDArray[Any]:
    """Sum, least or greatest of the samples of each interval, in bounded memory.

    Parameters
    ----------
    operation : ufunc
        ``np.add``, ``np.minimum``, ``np.maximum``.
    series : ndarray, shape (n_samples,)
        In memory or on disk. [any]
    first : ndarray of int, shape (n_intervals,)
        First sample of each; intervals may overlap, in any order. [1]
    stop : ndarray of int, shape (n_intervals,)
        Sample after the last, greater than ``first``. [1]

    Returns
    -------
    results : ndarray, shape (n_intervals,)
        One an interval. [as series]

    Raises
    ------
    IndexError
        If an interval begins beyond the series.

    Examples
    --------
    >>> over_intervals(np.add, np.arange(6.0), np.array([0, 3]), np.array([3, 5]))
    array([3., 7.])
    """
    results = np.empty(first.size, dtype=series.dtype)
    if (np.diff(first) < 0).any():
        order = np.argsort(first, kind="stable")
        results[order] = over_intervals(operation, series, first[order], stop[order])
        return results
    reached = np.maximum.accumulate(stop)
    at = 0
    while at < first.size:
        low = int(first[at])
        end = int(np.searchsorted(reached, low + BLOCK, side="right"))
        if end <= at:  # longer than a block
            own, end = series[low : int(stop[at])], at + 1
            parts = [
                operation.reduce(own[part]) for part in sample_blocks(own.size, own, size=BLOCK)
            ]
            results[at] = operation.reduce(np.array(parts))
        else:
            bounds = np.column_stack([first[at:end], stop[at:end]]).ravel() - low
            samples = series[low : int(reached[end - 1]) + 1]
            if reached[end - 1] == series.size:  # reduceat takes no bound after the last sample
                samples = np.append(samples, samples[-1:])
            results[at:end] = operation.reduceat(samples, bounds)[::2]
        let_go(series)
        at = end
    return results

"""Samples of a series for which something is true: the first, the last, some of many."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reduction.samples.blocks import BLOCK, sample_blocks
from reduction.samples.scratch import let_go

Where = Callable[[slice], NDArray[np.bool_]]
"""Of a slice of samples: for which of them it is true."""


def first_sample(where: Where, start: int, stop: int, *samples: NDArray[Any]) -> int | None:
    """First sample from ``start`` up to ``stop`` for which a condition on slices is true.

    ``samples`` is what the condition reads.
    """
    for low in range(start, stop, BLOCK):
        found = where(slice(low, min(low + BLOCK, stop)))
        let_go(*samples)
        if found.any():
            return low + int(found.argmax())
    return None


def last_sample(where: Where, start: int, stop: int, *samples: NDArray[Any]) -> int | None:
    """Last sample from ``start`` up to ``stop`` for which a condition on slices is true."""
    for high in range(stop, start, -BLOCK):
        low = max(high - BLOCK, start)
        found = where(slice(low, high))
        let_go(*samples)
        if found.any():
            return high - 1 - int(found[::-1].argmax())
    return None


def any_sample(where: Where, n_samples: int, *samples: NDArray[Any]) -> bool:
    """Whether a condition on slices is true for any sample of a series."""
    return first_sample(where, 0, n_samples, *samples) is not None


def thinned(
    where: Where, n_samples: int, *, most: int, every: int = 1, samples: Sequence[NDArray[Any]] = ()
) -> NDArray[np.intp]:
    """Samples for which a condition is true, evenly thinned to fewer than twice a number.

    Parameters
    ----------
    where : callable
        Of a slice, which may have a step: whether each of its samples is wanted.
    n_samples : int
        Length of the series. [1]
    most : int
        So many are kept, or up to twice as many. [1]
    every : int
        Every so manieth sample of the series is looked at. [1]
    samples : sequence of ndarray
        What the condition reads.

    Returns
    -------
    kept : ndarray of int, shape (n_kept,)
        In order. [1]

    Raises
    ------
    ValueError
        If ``every`` is zero.

    Examples
    --------
    >>> thinned(lambda part: np.arange(10)[part] > 3, 10, most=3)
    array([4, 6, 8])
    """

    def rows() -> Iterator[NDArray[np.intp]]:
        for part in sample_blocks(n_samples, *samples, size=every * BLOCK):
            looked = slice(part.start, part.stop, every)
            yield part.start + every * np.flatnonzero(where(looked))

    step = max(1, sum(block.size for block in rows()) // most)
    kept, before = [np.empty(0, dtype=np.intp)], 0
    for block in rows():
        kept.append(block[-before % step :: step].copy())  # a view would keep the block
        before += block.size
    return np.concatenate(kept)

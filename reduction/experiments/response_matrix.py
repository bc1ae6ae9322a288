"""Many responses at once: products of rows, searches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reduction.record.measurement import Bools, Floats, Integers

_PIECE = 200_000
"""Multiplications in one call of the linear algebra library: below it stays in one thread."""


def times(left: Floats, right: Floats) -> Floats:
    """Matrix product of many rows with a small matrix, in pieces too small for threads.

    Threads of the linear algebra library cost a hundred times what they bring to a product
    this narrow, and how they part the sums would depend on the machine.
    """
    n_rows = max(_PIECE // max(right.size, 1), 1)
    product = np.empty((left.shape[0], right.shape[1]))
    for start in range(0, left.shape[0], n_rows):
        piece = slice(start, start + n_rows)
        np.matmul(left[piece], right, out=product[piece])
    return product


def block_contrasts(block: Integers) -> Floats:
    """Columns that tell the blocks present apart, shape (n_runs, n_present - 1).

    1 in a block, -1 in the last one: their coefficients are effects that add up to nil, and
    the mean of the surface is that over the blocks.
    """
    present, own = np.unique(block, return_inverse=True)
    member = own[:, None] == np.arange(present.size)
    contrasts: Floats = member[:, :-1].astype(np.float64) - member[:, -1:]
    return contrasts


def patterns_of(known: Bools) -> tuple[Bools, Integers]:
    """Different patterns of known runs, and which one each response has."""
    if (known == known[:1]).all():
        return known[:1].copy(), np.zeros(known.shape[0], dtype=np.intp)
    is_used, pattern = np.unique(known, axis=0, return_inverse=True)
    return is_used, pattern.reshape(-1)


_STEPS = 60

_GOLDEN = (5**0.5 - 1) / 2


def highest_of_each(
    height: Callable[[Floats], Floats], grid: Floats, count: int
) -> tuple[Floats, Floats]:
    """Place of the top of each curve, shape (count,), and heights on the grid, (count, n_grid).

    ``height`` takes one place a curve.  The search stays between the neighbours of the highest
    place of the grid, where it takes the curve to have one top.
    """
    on_grid = np.stack([height(np.full(count, place)) for place in grid], axis=1)
    top = np.argmax(on_grid, axis=1)
    left, right = grid[np.maximum(top - 1, 0)], grid[np.minimum(top + 1, grid.size - 1)]
    for _ in range(_STEPS):
        reach = _GOLDEN * (right - left)
        first, second = right - reach, left + reach
        rising = height(first) < height(second)
        left, right = np.where(rising, first, left), np.where(rising, right, second)
    return (left + right) / 2, on_grid

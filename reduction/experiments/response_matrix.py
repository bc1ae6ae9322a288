"""Many responses at once: products of rows, searches."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reduction.record.measurement import Bools, Floats, Integers

_PIECE = 200_000
"""Multiplications per call of the linear algebra library: below this it stays in one thread."""


def times(left: Floats, right: Floats) -> Floats:
    """Matrix product of many rows with a small matrix, in pieces too small for threads.

    Threads of the linear algebra library cost a hundred times what they gain in a product
    this narrow, and the way they split the sums would depend on the machine.
    """
    n_rows = max(_PIECE // max(right.size, 1), 1)
    product = np.empty((left.shape[0], right.shape[1]))
    for start in range(0, left.shape[0], n_rows):
        piece = slice(start, start + n_rows)
        np.matmul(left[piece], right, out=product[piece])
    return product


def block_contrasts(block: Integers) -> Floats:
    """Columns that distinguish the blocks present, shape (n_runs, n_present - 1).

    1 in a block, -1 in the last one: their coefficients are effects that add up to zero, and
    the mean of the surface is that over the blocks.
    """
    present, own = np.unique(block, return_inverse=True)
    member = own[:, None] == np.arange(present.size)
    contrasts: Floats = member[:, :-1].astype(np.float64) - member[:, -1:]
    return contrasts


def patterns_of(known: Bools) -> tuple[Bools, Integers]:
    """Different patterns of known runs, and the pattern of each response."""
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

    ``height`` takes one place per curve.  The search stays between the neighbours of the highest
    grid point, where it assumes that the curve has one maximum.
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

"""The highest place of many curves at once, by a grid and golden sections."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reduction.record import Floats

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

"""Rows of a table of responses: their products with small matrices, their missing runs."""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats, Integers

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

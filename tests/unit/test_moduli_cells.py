"""Sums by cell, against numpy's own count of bins."""

from __future__ import annotations

import numpy as np
import pytest

from reduction.stages.moduli.local_regression import sums_by_cell


def test_sums_are_those_of_bincount_to_the_last_bit() -> None:
    rng = np.random.default_rng(5)
    cell, values = rng.integers(0, 300, 20_000), rng.normal(0, 1e3, 20_000)
    expected = np.bincount(cell, weights=values, minlength=301)
    assert np.array_equal(sums_by_cell(cell, 301) @ values, expected)


def test_no_samples_leave_every_cell_empty() -> None:
    empty = np.empty(0, dtype=np.int64)
    assert np.array_equal(sums_by_cell(empty, 4) @ np.empty(0), np.zeros(4))


def test_more_cells_than_32_bits_count_are_refused() -> None:
    with pytest.raises(ValueError, match="too many for one block"):
        sums_by_cell(np.zeros(1, dtype=np.int64), 1 << 31)

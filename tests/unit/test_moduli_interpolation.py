"""Curves between their bins."""

import numpy as np
import pytest

from reduction.stages.moduli.local_regression import curve_at


def test_curve_is_not_carried_over_a_gap_or_its_ends():
    x = np.arange(8.0)
    curve = np.where((x == 3) | (x == 4), np.nan, 10 * x)
    at = curve_at([-0.5, 0.0, 1.5, 2.5, 3.5, 5.0, 6.5, 7.1], x, curve, spacing=1.0)
    assert at == pytest.approx([np.nan, 0, 15, np.nan, np.nan, 50, 65, np.nan], nan_ok=True)
    assert np.isnan(curve_at([1.0], x, np.full(8, np.nan), spacing=1.0)).all()


def test_grids_that_differ_by_rounding_are_the_same():
    x = 0.1 * np.arange(1, 9)
    at = curve_at(x * (1 + 1e-15), x, np.arange(8.0), spacing=0.1)
    assert np.isfinite(at).all()

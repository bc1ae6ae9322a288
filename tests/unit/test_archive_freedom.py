"""From how many numbers an uncertainty was found."""

import numpy as np
import pytest
import xarray as xr

from reduction.archive.freedom import random_freedom


@pytest.mark.parametrize("n_cycles", [3, 10, 30])
def test_differences_of_neighbours_are_worth_fewer_than_cycles(n_cycles):
    # drawn: twice the mean over the variance of what they are found from
    drawn = np.random.default_rng(3).normal(size=(200_000, n_cycles))
    variance = (np.diff(drawn, axis=1) ** 2).mean(axis=1) / 2
    expected = 2 * variance.mean() ** 2 / variance.var()
    archive = xr.Dataset({"peak_tension_change": ("specimen", [0.1])}, {"cycle": range(n_cycles)})
    found = random_freedom(archive, "peak_tension_change")
    assert found == pytest.approx(expected, rel=0.015)
    assert found < n_cycles - 1

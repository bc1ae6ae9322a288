"""From how many numbers an uncertainty was found."""

import numpy as np
import pytest
import xarray as xr

from reduction.archive.uncertainty_budget import cycles_averaged, effective_freedom, random_freedom
from reduction.record.contributions import coverage_factor


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


def test_the_uncertainty_of_a_single_cycle_is_that_of_its_readings_not_of_a_scatter():
    # one pull and return: nothing scatters, and its readings are as many as those of a slow pull
    archive = xr.Dataset(
        {
            "tension_amplitude": (("specimen", "cycle"), [[100.0]]),
            "test_apparent_spring_constant": ("specimen", [1e6]),
            "test_apparent_spring_constant_standard_uncertainty": ("specimen", [1e4]),
        }
    )
    freedom = effective_freedom(archive, "test_apparent_spring_constant")
    assert coverage_factor(freedom) == pytest.approx([1.96], abs=1e-3)


def test_a_mean_is_of_the_cycles_after_the_break_in_that_have_a_number():
    # of twelve cycles two are break-in, and of the second specimen six more have no tension
    amplitude = np.full((2, 12), 100.0)
    amplitude[1, 4:10] = np.nan
    frequency = np.full(12, 0.1)
    archive = xr.Dataset(
        {
            "tension_amplitude": (("specimen", "cycle"), amplitude),
            "frequency": ("cycle", frequency),
            "test_dynamic_modulus": ("specimen", [1e6, 1e6]),
            "test_frequency": ("specimen", [0.1, 0.1]),
            "segment_modulus": (("specimen", "branch_name", "segment"), np.ones((2, 2, 3))),
            "peak_tension_per_decade": ("specimen", [1.0, 1.0]),
        },
        attrs={"settings": '{"reduction": {"cycles": {"break_in_cycles": 2}}}'},
    )
    assert cycles_averaged(archive, "test_dynamic_modulus").tolist() == [10, 4]
    assert random_freedom(archive, "test_dynamic_modulus").tolist() == [9.0, 3.0]
    assert random_freedom(archive, "segment_modulus")[:, 0, 0].tolist() == [9.0, 3.0]
    assert random_freedom(archive, "peak_tension_per_decade").tolist() == [8.0, 2.0]
    # scatter of four cycles: 3.18 times its standard uncertainty, by the table of Student's t
    spread = archive.assign(
        test_dynamic_modulus_standard_uncertainty=("specimen", [1e4, 1e4]),
    )
    freedom = effective_freedom(spread, "test_dynamic_modulus")
    assert coverage_factor(freedom) == pytest.approx([2.262, 3.182], abs=1e-3)

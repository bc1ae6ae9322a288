"""Intervals of surfaces under instruments that all runs share, against drawn campaigns."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.uncertainty.surface_errors import with_shared_at_points

pytestmark = pytest.mark.slow

CAMPAIGNS = 1500
PLAN = box_behnken(3).coded
EXPONENTS = quadratic_exponents(3)
TRUTH = np.array([10.0, 0.5, 0.2, -0.3, 0.4, 2.0, -1.0, 0.5, 0.3, 0.2])
GRID = np.stack(np.meshgrid(*[np.linspace(-1, 1, 5)] * 3), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize(
    "gain", [0.1, *(pytest.param(gain, marks=pytest.mark.nightly) for gain in (0.0, 0.03, 0.5))]
)
def test_intervals_hold_a_drawn_truth_as_often_as_they_say(gain):
    """Scatter of 1 in fifteen runs, a gain that all share and a zero of 0.2 beside it."""
    rng = np.random.default_rng(8)
    rows = np.stack([gain * TRUTH, np.append(0.2, np.zeros(9))])
    shared = rng.normal(size=(CAMPAIGNS, 2)) @ rows
    runs = (TRUTH + shared) @ model_matrix(PLAN, EXPONENTS).T
    runs += rng.normal(size=runs.shape)
    surfaces = fit_surfaces(
        PLAN, runs, factor_names=("f", "m", "a"), units="coded", low=[0.0] * 3, high=[1.0] * 3,
        response_names=[f"draw {number}" for number in range(CAMPAIGNS)], with_tests=False,
    )  # fmt: skip
    at = evaluate_surfaces(surfaces, GRID, units="coded")
    # what is stated: known beforehand, not drawn
    found = with_shared_at_points(
        surfaces, at, np.repeat(rows[:, None], CAMPAIGNS, axis=1), [np.inf, np.inf]
    )
    exact = model_matrix(GRID, EXPONENTS) @ TRUTH
    # one more run has the instruments of the others, and is compared with what is true
    another = exact + rng.normal(size=(CAMPAIGNS, exact.size))

    def held(interval, value):
        return (interval[..., 0] <= value) & (value <= interval[..., 1])

    # campaigns differ, points of one do not by much: three standard errors of 1,500 campaigns
    assert held(found.confidence_interval, exact).mean() == pytest.approx(0.95, abs=0.017)
    assert held(found.prediction_interval, another).mean() == pytest.approx(0.95, abs=0.017)
    assert held(found.simultaneous_interval, exact).all(axis=1).mean() > 0.95
    scatter = held(at.confidence_interval, exact).mean()
    assert scatter < 0.93 if gain >= 0.1 else scatter > 0.85

"""What a quadratic surface may miss between its runs: by hand, by limits and by drawn laws."""

import numpy as np
import pytest

from reduction.experiments.designs import box_behnken
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_discrepancy import discrepancy_of
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.uncertainty.surface_errors import with_shared_at_points

PLAN = box_behnken(3).coded
LOW, HIGH = np.array([0.1, 12.0, 5.0]), np.array([0.5, 30.0, 12.0])


def fitted(responses, *, transform="none", coded=PLAN, **more):
    return fit_surfaces(
        coded, responses, factor_names=("f", "m", "a"), low=LOW, high=HIGH, units="coded",
        response_names=[str(number) for number in range(len(responses))], transforms=transform,
        with_tests=False, **more,
    )  # fmt: skip


def test_a_parabola_of_three_levels_misses_what_its_slope_and_curvature_suggest():
    """Cubic a rho^2/3 (x^3 - x), quartic a rho^3/4 (x^4 - x^2), a of the series of a logarithm."""
    slope, curvature, rho = 0.8, -0.3, 2 / 3
    x = np.array([-1.0, 0.0, 1.0, -1.0, 1.0])
    levels = x[:, None]
    found = fit_surfaces(
        levels, [slope * x + curvature * x**2], factor_names=["f"], response_names=["y"],
        low=[0.1], high=[0.5], units="coded", with_tests=False,
    )  # fmt: skip
    at = np.array([-1.0, -0.6, 0.0, 0.3, 1.0])
    size = max(slope, abs(2 * curvature / rho))
    beyond = curvature + rho / 2 * slope  # what a logarithm of this slope does not bend
    cubic = np.hypot(size * rho**2 / 3, beyond * rho)
    quartic = np.hypot(size * rho**3 / 4, beyond * rho**2 * 11 / 12)
    wanted = np.hypot(cubic * (at**3 - at), quartic * (at**4 - at**2))
    np.testing.assert_allclose(discrepancy_of(found).at(at[:, None])[0], wanted, atol=1e-9)


def test_a_loss_that_is_least_between_the_levels_is_within_the_interval():
    """ln(f/f_0 + f_0/f): a slow and a fast relaxation, least at f_0 of 0.22 Hz."""

    def law(f):
        return f / np.sqrt(0.05) + np.sqrt(0.05) / f

    coded = np.array([-1.0, 0.0, 1.0, -1.0, 1.0])[:, None]
    found = fit_surfaces(
        coded, [law(0.3 + 0.2 * coded[:, 0])], factor_names=["f"], response_names=["y"],
        low=[0.1], high=[0.5], units="coded", with_tests=False, transforms="log",
    )  # fmt: skip
    discrepancy = discrepancy_of(found)
    between = np.array([[-0.5]])
    left, middle, right = np.log(law(np.array([0.1, 0.3, 0.5])))
    missed = 0.375 * left + 0.75 * middle - 0.125 * right - np.log(law(0.2))
    assert missed == pytest.approx(0.099, abs=1e-3)
    assert missed / 2 < discrepancy.at(between)[0, 0] < missed


def test_nothing_is_missed_at_the_runs_of_one_factor_and_something_between_them():
    runs = np.log(0.3 + 0.2 * PLAN[:, 0]) * -0.9
    found = discrepancy_of(fitted([np.exp(runs)], transform="log"))
    # roots of squares that round to nil
    assert found.at(PLAN)[0] == pytest.approx(0.0, abs=1e-8)
    between = np.array([[-0.5, 0.0, 0.0]])
    assert 0.02 < found.at(between)[0, 0] < 0.1
    # slope and curvature of three factors, three interactions, three contrasts of the residuals
    assert found.degrees_of_freedom == pytest.approx([12.0])


def test_scatter_alone_is_no_lack_of_fit():
    """Runs that scatter as their repeats do: terms of higher order stay below the scatter."""
    rng = np.random.default_rng(3)
    coded = np.vstack([PLAN] * 8)
    found = fitted([10 + rng.normal(size=len(coded))], coded=coded)
    corner = np.array([[0.7, -0.7, 0.7]])
    assert discrepancy_of(found).at(corner)[0, 0] < 0.3


def test_a_third_order_that_the_residuals_see_widens_what_is_between_the_runs():
    """x y^2 is seen by the contrasts of a Box-Behnken design."""
    seen = 10 + PLAN[:, 0] + 0.5 * PLAN[:, 0] * PLAN[:, 1] ** 2
    plain = 10 + PLAN[:, 0]
    rng = np.random.default_rng(4)
    scatter = 1e-3 * rng.normal(size=15)
    found = discrepancy_of(fitted([plain + scatter, seen + scatter])).at([[0.5, 0.9, 0.2]])
    assert found[1, 0] > 2 * found[0, 0]


def test_a_response_without_a_surface_has_none():
    runs = np.vstack([10 + PLAN[:, 0], np.full(15, np.nan)])
    runs[1, :4] = 1.0
    found = discrepancy_of(fitted(runs)).at(np.zeros((1, 3)))
    assert np.isnan(found[1, 0]) and np.isfinite(found[0, 0])


def power(rng, at):
    """A product of powers of the factors: no quadratic in them or in their logarithms' response."""
    return np.prod(at ** rng.uniform([-1.0, 0.0, 0.5], [-0.6, 1.0, 2.0]), axis=-1)


def relaxing(rng, at):
    """Storage by three relaxation times beside a constant, stiffer with load."""
    time, share = np.exp(rng.uniform(-2, 1.5, 3)), rng.uniform(0.3, 1.5, 3)
    turn = 2 * np.pi * at[..., :1] * time
    storage = 1.5 + np.sum(share * turn**2 / (1 + turn**2), axis=-1)
    return storage * (1 + rng.uniform(1, 3) * (at[..., 1] / 100 - 0.21)) * at[..., 2] ** -0.1


def exponential(rng, at):
    """Exponentials of the levels, with a constant beside them."""
    rate = rng.uniform([-3, -0.06, -0.05], [3, 0.06, 0.05])
    return 1 + np.exp((at - (LOW + HIGH) / 2) @ rate)


@pytest.mark.parametrize(
    ("law", "transform", "least"),
    [
        (power, "none", 0.93),
        (power, "log", 0.93),
        (exponential, "none", 0.93),
        (exponential, "log", 0.93),
        (relaxing, "none", 0.93),
        # one time within the frequencies turns a logarithm faster than three levels can show
        (relaxing, "log", 0.8),
    ],
)
def test_intervals_hold_laws_that_are_not_quadratic(law, transform, least):
    """24 realisations at 40 random points each; by the scatter alone most are missed."""
    rng = np.random.default_rng(11)
    centre, half = (LOW + HIGH) / 2, (HIGH - LOW) / 2
    held, scatter = [], []
    for _ in range(24):
        state = rng.integers(1 << 31)
        points = rng.uniform(-1, 1, (40, 3))
        truth = law(np.random.default_rng(state), centre + half * points)
        runs = law(np.random.default_rng(state), centre + half * PLAN)
        surfaces = fitted([runs * (1 + 1e-3 * rng.normal(size=15))], transform=transform)
        at = evaluate_surfaces(surfaces, points, units="coded")
        stated = with_shared_at_points(surfaces, at, np.zeros((0, 1, 10)), [])
        for ends, kept in (
            (stated.confidence_interval, held), (at.confidence_interval, scatter)
        ):  # fmt: skip
            kept.append(((ends[0, :, 0] <= truth) & (truth <= ends[0, :, 1])).mean())
    assert np.mean(held) > least
    assert np.mean(held) >= np.mean(scatter)

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


@pytest.mark.parametrize("response", ["loss_factor", "storage_spring_constant"])
@pytest.mark.parametrize(
    ("lowest", "middle_level"), [(0.1, 0.0), (0.02, 0.0), (0.02, -2 / 3)],
    ids=["a fifth", "a twenty-fifth", "of equal ratios"],
)  # fmt: skip
def test_a_parabola_of_three_levels_misses_what_spectra_of_its_slope_and_curvature_do(
    response, lowest, middle_level
):
    """Drawn spectra: what the parabola misses, by regression on its slope and curvature."""
    rng = np.random.default_rng(5)
    time = np.arange(-12.0, 12.0, 0.1)
    slope, curvature = 0.8, -0.3
    x = np.array([-1.0, middle_level, 1.0, -0.8, 0.5])
    apart = np.log((0.5 + lowest) / 2 + (0.5 - lowest) / 2 * x)[:, None] - time
    part = 1 / np.cosh(apart) if response == "loss_factor" else 1 + np.tanh(apart)
    drawn = part @ rng.normal(size=(time.size, 20000))
    powers = x[:, None] ** np.arange(3)
    parabola = np.linalg.solve(powers[:3], drawn[:3])
    bent, missed = parabola[1:], drawn[3:] - powers[3:] @ parabola
    gain = missed @ bent.T @ np.linalg.inv(bent @ bent.T)
    left = np.mean((missed - gain @ bent) ** 2, axis=1)
    given = np.array([slope, curvature])
    size = given @ np.linalg.solve(np.cov(bent), given) / 2
    wanted = np.sqrt((gain @ given) ** 2 + size * left)
    levels = np.array([-1.0, middle_level, 1.0, -1.0, 1.0])
    found = fit_surfaces(
        levels[:, None], [slope * levels + curvature * levels**2], factor_names=["frequency"],
        response_names=[response], low=[lowest], high=[0.5], units="coded", with_tests=False,
    )  # fmt: skip
    at = discrepancy_of(found).at(x[:, None])[0]
    # roots of squares that round to nil
    assert at[:3] == pytest.approx(0.0, abs=1e-6)
    # a polynomial stands for all that is missed
    assert at[3:] == pytest.approx(wanted, rel=0.1)


def test_a_loss_that_is_least_between_the_levels_is_within_the_interval():
    """ln(f/f_0 + f_0/f): a slow and a fast relaxation, least at f_0 of 0.22 Hz."""

    def law(f):
        return f / np.sqrt(0.05) + np.sqrt(0.05) / f

    coded = np.array([-1.0, 0.0, 1.0, -1.0, 1.0])[:, None]
    found = fit_surfaces(
        coded, [law(0.3 + 0.2 * coded[:, 0])], factor_names=["frequency"], response_names=["y"],
        low=[0.1], high=[0.5], units="coded", with_tests=False, transforms="log",
    )  # fmt: skip
    discrepancy = discrepancy_of(found)
    between = np.array([[-0.5]])
    left, middle, right = np.log(law(np.array([0.1, 0.3, 0.5])))
    missed = 0.375 * left + 0.75 * middle - 0.125 * right - np.log(law(0.2))
    assert missed == pytest.approx(0.099, abs=1e-3)
    assert missed / 2 < discrepancy.at(between)[0, 0] < 1.5 * missed


def test_nothing_is_missed_at_the_runs_of_one_factor_and_something_between_them():
    runs = np.log(0.3 + 0.2 * PLAN[:, 0]) * -0.9
    found = discrepancy_of(fitted([np.exp(runs)], transform="log"))
    # roots of squares that round to nil
    assert found.at(PLAN)[0] == pytest.approx(0.0, abs=1e-8)
    between = np.array([[-0.5, 0.0, 0.0]])
    assert 0.02 < found.at(between)[0, 0] < 0.1
    # slope and curvature of three factors
    assert found.degrees_of_freedom == pytest.approx([6.0])


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
        (relaxing, "log", 0.93),
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


def line_of(static, storage, loss, frequency, amplitude):
    """K_ap, H, K_1 and tau of a storage and a loss."""
    spring, above = np.hypot(static + storage, loss), storage
    time = above / loss / (2 * np.pi * frequency)
    return np.stack([
        spring, np.pi * (amplitude / spring) ** 2 * loss, (above**2 + loss**2) / above, time
    ])  # fmt: skip


@pytest.mark.parametrize("slow", [1.0, 20.0])
def test_times_are_held_where_a_loss_turns_within_the_frequencies(slow):
    """Greatest by a time within the range, or least between a slow and a fast time.

    The relaxation time bends more than its slope and curvature say, as the loss does: looked at
    between the lower two frequencies, which are farthest apart.
    """
    rng = np.random.default_rng(2)
    centre, half = (LOW + HIGH) / 2, (HIGH - LOW) / 2
    names = ("apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
             "relaxation_time")  # fmt: skip
    held = []
    for _ in range(30):
        # of a peak a slow relaxation stands beside; of a dip a fast one far above
        middle = np.exp(rng.uniform(np.log(0.13), np.log(0.4)))
        apart = rng.uniform(4, 12) if slow == 1.0 else 1.0
        times = np.array([apart, slow / apart]) / (2 * np.pi * middle)
        shares = rng.uniform(0.3, 1.0, 2) * (1 if slow == 1.0 else np.array([1.0, 0.3]))

        def law(at, times=times, shares=shares):
            turn = 2 * np.pi * at[:, :1] * times
            static = 1.5 + 0.02 * (at[:, 1] - 21)
            storage, loss = ((shares * one / (1 + turn**2)).sum(axis=1) for one in (turn**2, turn))
            return line_of(static, storage, loss, at[:, 0], at[:, 2] / 100)

        points = rng.uniform([-1, -1, -1], [0, 1, 1], (40, 3))
        truth = law(centre + half * points)[3]
        runs = law(centre + half * PLAN) * (1 + 1e-3 * rng.normal(size=(4, 15)))
        low, high = (np.array([*end[:2], end[2] / 100]) for end in (LOW, HIGH))
        surfaces = fit_surfaces(
            PLAN, runs, factor_names=("frequency", "mean_tension", "tension_amplitude"), low=low,
            high=high, units="coded", response_names=names, with_tests=False,
            transforms=("none", "log", "none", "log-times-frequency"),
        )  # fmt: skip
        at = evaluate_surfaces(surfaces, points, units="coded")
        ends = with_shared_at_points(surfaces, at, np.zeros((0, 4, 10)), []).confidence_interval[3]
        held.append(((ends[:, 0] <= truth) & (truth <= ends[:, 1])).mean())
    assert np.mean(held) > 0.93


def test_times_of_a_single_relaxation_are_stated_no_wider_than_half_beyond_need():
    """K_1 and tau stand still along the frequency, whatever the loss does."""
    rng = np.random.default_rng(3)
    centre, half = (LOW + HIGH) / 2, (HIGH - LOW) / 2
    low, high = (np.array([*end[:2], end[2] / 100]) for end in (LOW, HIGH))
    over = []
    for _ in range(40):
        time = np.exp(-rng.uniform(np.log(0.1), np.log(0.5))) / (2 * np.pi)
        share = rng.uniform(0.3, 1.5)

        def law(at, scatter, time=time, share=share):
            turn = 2 * np.pi * at[:, 0] * time
            static, amplitude = 1.5 + 0.02 * (at[:, 1] - 21), at[:, 2] / 100
            storage, loss = (share * one / (1 + turn**2) for one in (turn**2, turn))
            spring, energy, *_ = line_of(static, storage, loss, at[:, 0], amplitude)
            spring, energy = (spring, energy) * (1 + scatter * rng.normal(size=(2, len(at))))
            loss = energy / np.pi * (spring / amplitude) ** 2
            storage = np.sqrt(spring**2 - loss**2) - static
            return line_of(static, storage, loss, at[:, 0], amplitude)

        points = rng.uniform(-1, 1, (40, 3))
        truth = law(centre + half * points, 0.0)[2:]
        surfaces = fit_surfaces(
            PLAN, law(centre + half * PLAN, 1e-3),
            factor_names=("frequency", "mean_tension", "tension_amplitude"), low=low, high=high,
            units="coded", with_tests=False, transforms=("none", "log", "none", "log"),
            response_names=("apparent_spring_constant", "hysteresis_energy",
                            "dissipation_spring_constant", "relaxation_time"),
        )  # fmt: skip
        at = evaluate_surfaces(surfaces, points, units="coded")
        ends = with_shared_at_points(surfaces, at, np.zeros((0, 4, 10)), []).confidence_interval[2:]
        middle = ends.mean(axis=-1)
        over.append(np.abs(truth - middle) / (ends[..., 1] - middle))
    assert (np.mean(np.array(over) < 1, axis=(0, 2)) > 0.93).all()
    assert (np.quantile(over, 0.95, axis=(0, 2)) > 1 / 1.5).all()

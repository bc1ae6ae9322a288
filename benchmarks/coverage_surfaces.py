"""Coverage of surfaces between their runs: laws that are not quadratic, at random points.

    python benchmarks/coverage_surfaces.py 24
    python benchmarks/coverage_surfaces.py 24 0.02    # frequencies of 0.02, 0.26 and 0.5 Hz

Each realisation is one line at the points of a Box-Behnken design with one to three centre runs.
K_ap and H of the runs follow a law but for their scatter, K_1 and tau are made from them; surfaces
are fitted as a campaign fits them where no scale is stated, and held against the law at 40 random
points within the levels.  Nothing is shared by the runs.  The lines of three parameters are those
of tests/strangers.  Printed by law and response: how often the 95 % interval holds the law, and
its half width over that which would just have held 95 %.  Everything is synthetic.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from reduction.experiments.designs import box_behnken
from reduction.experiments.experiment_fit import _scales
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.record.measurement import Floats
from reduction.uncertainty.surface_errors import with_shared_at_points

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from strangers.ropes import _closed_form, draw_line, line_response

FACTORS = ("frequency", "mean_tension", "tension_amplitude")
RESPONSES = (
    "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
    "relaxation_time",
)  # fmt: skip
LOWEST = 0.1
MOST = np.array([0.5, 0.30, 0.12])
N_POINTS = 40

Law = Callable[[Floats], tuple[Floats, Floats, Floats]]
"""K_ap, H and K_0 at frequency [Hz], mean and amplitude [share of a strength of 1 N]."""


def line(rng: np.random.Generator, damping: str) -> Law:
    """Draw a line of three parameters, or of a constant loss angle."""
    c = draw_line(rng, damping)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        frequency, mean, swing = levels.T
        found = line_response(frequency, mean * c["strength"], swing * c["strength"], c)
        names = ("apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant")
        return tuple(found[name] / c["strength"] for name in names)  # type: ignore[return-value]

    return at


def relaxing(rng: np.random.Generator) -> Law:
    """Draw three relaxation times between 0.1 and 5 s, softer with amplitude."""
    time, share = np.exp(rng.uniform(np.log(0.1), np.log(5), 3)), rng.uniform(0.3, 1.5, 3)
    stiffer, softer = rng.uniform(1, 3), rng.uniform(-2, 0)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        frequency, mean, swing = levels.T
        static = 1.5 * (1 + stiffer * (mean - 0.21) + 4 * (mean - 0.21) ** 2)
        turn = 2 * np.pi * frequency[:, None] * time
        load = np.exp(4 * softer * (swing - 0.085)) * (1 + stiffer * (mean - 0.21))
        storage = static + load * (share * turn**2 / (1 + turn**2)).sum(axis=1)
        loss = load * (share * turn / (1 + turn**2)).sum(axis=1)
        spring = np.hypot(storage, loss)
        return spring, np.pi * (swing / spring) ** 2 * loss, static

    return at


def between(rng: np.random.Generator) -> Law:
    """Draw a fast and a slow relaxation: the loss is least within the frequencies."""
    time = np.exp(rng.uniform(np.log([0.05, 2.0]), np.log([0.2, 8.0])))
    share, stiffer = rng.uniform(0.3, 1.0, 2), rng.uniform(1, 3)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        frequency, mean, swing = levels.T
        static = 1.5 * (1 + stiffer * (mean - 0.21) + 4 * (mean - 0.21) ** 2)
        turn = 2 * np.pi * frequency[:, None] * time
        storage = static + (share * turn**2 / (1 + turn**2)).sum(axis=1)
        loss = (share * turn / (1 + turn**2)).sum(axis=1)
        spring = np.hypot(storage, loss)
        return spring, np.pi * (swing / spring) ** 2 * loss, static

    return at


def stiffening(rng: np.random.Generator) -> Law:
    """Draw a stiffness that rises as an exponential of the mean load, at a constant loss angle."""
    rate, share, angle = rng.uniform(8, 20), rng.uniform(0.2, 0.6), rng.uniform(0.05, 0.15)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        frequency, mean, swing = levels.T
        static = 1.2 * (1 + share * np.exp(rate * (mean - 0.21)))
        spring = static * (1.6 + 0.1 * np.log(frequency / 0.2)) * (swing / 0.08) ** -0.05
        return spring, np.pi * swing**2 / spring * np.sin(angle), static

    return at


def powers(rng: np.random.Generator) -> Law:
    """Draw powers of all three levels, in stiffness and loss angle."""
    of_stiffness = rng.uniform([0.02, 0.1, -0.4], [0.12, 0.8, -0.05])
    of_angle, tangent = (rng.uniform(-0.5, 0.2), -0.6, 0.5), rng.uniform(0.05, 0.25)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        scaled = levels / [0.25, 0.2, 0.08]
        spring = 1.9 * np.prod(scaled**of_stiffness, axis=1)
        lost = np.sin(np.arctan(tangent * np.prod(scaled**of_angle, axis=1)))
        static = 0.96 * (1 + 2.2 * (levels[:, 1] - 0.21))
        return spring, np.pi * levels[:, 2] ** 2 / spring * lost, static

    return at


def slipping(rng: np.random.Generator) -> Law:
    """Draw an amplitude above which strands slip: softer and with more loss from there on."""
    onset, softer = rng.uniform(0.06, 0.11), rng.uniform(2, 8)

    def at(levels: Floats) -> tuple[Floats, Floats, Floats]:
        frequency, mean, swing = levels.T
        static, beyond = 1.2 * (1 + 2.2 * (mean - 0.21)), np.maximum(swing - onset, 0)
        spring = static * (1.9 + 0.1 * np.log(frequency / 0.2) - softer * beyond)
        lost = np.sin(np.arctan(0.1 + 0.8 * beyond))
        return spring, np.pi * swing**2 / spring * lost, static

    return at


LAWS: dict[str, Callable[[np.random.Generator], Law]] = {
    "line, tau falling": lambda rng: line(rng, "falling"),
    "line, tau constant": lambda rng: line(rng, "constant"),
    "constant loss angle": lambda rng: line(rng, "angle"),
    "spring-pot": lambda rng: line(rng, "fractional"),
    "three relaxation times": relaxing,
    "loss least within the frequencies": between,
    "exponential in the mean load": stiffening,
    "powers": powers,
    "slip from an amplitude on": slipping,
}


def realisation(law: str, seed: int, lowest: float = LOWEST) -> tuple[Floats, Floats] | None:
    """Error over half width, by response and point: stated, and by the scatter alone.

    None where a run has no K_1 and tau.
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    low, high = np.array([lowest, 0.12, 0.05]), MOST
    at = LAWS[law](rng)
    plan = box_behnken(3).coded
    plan = np.vstack([plan[(plan != 0).any(axis=1)], np.zeros((int(rng.integers(1, 4)), 3))])
    coded = plan + 0.003 * rng.standard_normal(plan.shape)
    levels = (low + high) / 2 + coded * (high - low) / 2
    points = rng.uniform(-1, 1, (N_POINTS, 3))
    there = (low + high) / 2 + points * (high - low) / 2

    def responses(levels: Floats, scatter: tuple[float, float]) -> Floats:
        spring, energy, static = at(levels)
        spring = spring * (1 + scatter[0] * rng.standard_normal(len(levels)))
        energy = energy * (1 + scatter[1] * rng.standard_normal(len(levels)))
        two = _closed_form(spring, energy, levels[:, 2] / spring, static, levels[:, 0])
        return np.stack([spring, energy, *two])

    scatter = np.exp(rng.uniform(np.log([2e-4, 1e-3]), np.log([4e-3, 1e-2])))
    truth = responses(there, (0.0, 0.0))
    measured = responses(levels, tuple(scatter))
    if not (measured > 0).all():
        return None
    names = tuple(f"R{number}" for number in range(len(levels)))
    runs: Any = SimpleNamespace(
        level=levels, response=measured, names=names, specimen=("line",) * len(levels)
    )
    scales, _ = _scales(runs, FACTORS, low, high, RESPONSES, {})
    surfaces = fit_surfaces(
        levels, measured, factor_names=FACTORS, response_names=RESPONSES, low=low, high=high,
        with_tests=False, transforms=[scales[name] for name in RESPONSES],  # type: ignore[misc]
    )  # fmt: skip
    values = evaluate_surfaces(surfaces, points, units="coded")
    stated = with_shared_at_points(surfaces, values, np.zeros((0, *surfaces.coefficient.shape)), [])
    error = truth - values.value

    def over(interval: Floats) -> Floats:
        half = np.where(error > 0, interval[..., 1] - values.value, values.value - interval[..., 0])
        return np.asarray(np.abs(error) / half)

    return over(stated.confidence_interval), over(values.confidence_interval)


def main(n_realisations: int = 24, lowest: float = LOWEST) -> None:
    """Print the table."""
    print("| law | response | held | half width over that of 95 % | held by scatter alone |")
    print("|---|---|---|---|---|")
    for law in LAWS:
        every = (realisation(law, seed, lowest) for seed in range(n_realisations))
        found = np.array([one for one in every if one is not None])
        for row, name in enumerate(RESPONSES):
            stated, scatter = found[:, 0, row], found[:, 1, row]
            print(
                f"| {law} | {name} | {100 * (stated <= 1).mean():.1f} %"
                f" | {1 / np.quantile(stated, 0.95):.2f} | {100 * (scatter <= 1).mean():.1f} % |"
            )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *map(float, sys.argv[2:3]))

"""Intervals of a table of runs half way between its levels, for laws that saturate."""

import numpy as np
import pandas as pd

from reduction import fit_surface
from reduction.experiments.designs import box_behnken

LOW, HIGH = np.array([0.1, 3400.0, 1400.0]), np.array([0.5, 8500.0, 3400.0])
SPEC = {
    "factors": {
        "frequency": ["0.1 Hz", "0.5 Hz"], "mean_tension": ["3400 N", "8500 N"],
        "tension_amplitude": ["1400 N", "3400 N"],
    },
    "responses": {"relaxation_time": {"unit": "s", "transform": "log"}},
}  # fmt: skip


def law(coded, rng):
    """A response that falls as 1/f and rises with the load to a limit; of one line."""
    frequency, mean, amplitude = ((LOW + HIGH) / 2 + coded * (HIGH - LOW) / 2).T
    power, load = rng.uniform(0.8, 1.1), rng.uniform(3000, 9000)
    return frequency**-power * mean / (mean + load) * (1 - 0.1 * amplitude / 3400)


def test_intervals_between_the_levels_hold_what_a_quadratic_misses():
    held, held_by_scatter = [], []
    plan = box_behnken(3).coded
    for seed in range(25):
        rng = np.random.default_rng(seed)
        state = rng.bit_generator.state
        runs = law(plan, rng) * (1 + rng.normal(0, 0.01, len(plan)))
        level = (LOW + HIGH) / 2 + plan * (HIGH - LOW) / 2
        frame = pd.DataFrame(level, columns=["frequency [Hz]", "mean_tension [N]",
                                             "tension_amplitude [N]"])  # fmt: skip
        frame["relaxation_time [s]"] = runs
        found = fit_surface(frame, SPEC)
        at = found["point_coded"].to_numpy()
        rng.bit_generator.state = state
        true = law(at, rng)
        low, high = (found[f"point_{end}"].to_numpy()[0] for end in ("low", "high"))
        held.append((low <= true) & (true <= high))
        coefficient, covariance = (found[name].to_numpy()[0] for name in ("coefficient",
                                                                          "covariance"))  # fmt: skip
        terms = np.array([_terms(found["term"].to_numpy(), one) for one in at])
        spread = np.sqrt(np.einsum("ij,jk,ik->i", terms, covariance, terms))
        held_by_scatter.append(np.abs(np.log(true) - terms @ coefficient) < 2.571 * spread)
    assert np.mean(held) > 0.93
    # Student's 2.571 times the scatter alone
    assert np.mean(held_by_scatter) < 0.85


def _terms(names, coded):
    value = dict(zip(SPEC["factors"], coded, strict=True)) | {"mean": 1.0}
    return [
        value[name.removesuffix("^2")] ** 2
        if name.endswith("^2")
        else np.prod([value[part] for part in name.split("*")])
        for name in names
    ]

"""Linear propagation against Monte Carlo (GUM Supplement 1): the whole reduction, again and again.

    python benchmarks/monte_carlo.py 400

First the synthetic tether of `coverage_tethers.py`, every error and all noise drawn anew: what the
reduction states, random and shared part together, against the standard deviation of what it finds.
Then test T-1 of `raw/tmt-synthetic`: one log, one noise, and only what samples share is drawn, with
the standard uncertainties of its campaign; stated is the shared part.  Everything is synthetic.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from coverage_tethers import numbers_of, one_test

from reduction.batch.reduce_tests import _reduce_survey
from reduction.batch.reuse import basis_of
from reduction.batch.survey import Survey, _read_test
from reduction.batch.test_history import earlier_tests_of, fit_strain_models
from reduction.campaign.load import load_campaign
from reduction.record.contributions import combined_standard_uncertainty
from reduction.stages.reduced_test import ReducedTest

ROOT = Path(__file__).parents[1] / "raw" / "tmt-synthetic"
FOOT, POUND = 0.3048, 4.4482216152605
# inside the trimmed branches: the bin at their end has three cycles of ten, in each draw others
STRETCHES_OF_T_1 = np.linspace(0.82, 1.22, 10)
OF_LOOP = (
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant",
)  # fmt: skip
Numbers = dict[str, tuple[float, float]]


def of_tether(seed: int) -> Numbers:
    """Error and stated standard uncertainty of every number of one drawn tether."""
    found: Numbers = {}
    for name, value, truth, random, shared, _ in numbers_of(one_test(np.random.default_rng(seed))):
        key, place = name, 1
        while key in found:
            place, key = place + 1, f"{name}, {place + 1}"
        found[key] = value - truth, float(combined_standard_uncertainty([shared], random))
    return found


def t_1(draw: int) -> Numbers:
    """Value and stated shared uncertainty of every number of T-1; draw 0 is the log as it is."""
    rng = np.random.default_rng([7, draw])
    size = 1.0 if draw else 0.0
    known = load_campaign(ROOT / "campaign.toml")
    u = known.uncertainty
    gain, zero, scale, shift, late, wide = size * rng.normal(size=6) * (
        u.tension_gain, u.tension_offset, u.position_gain, u.position_offset, u.lag, u.diameter,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for name in ("campaign.toml", "marks.csv", "T-1.csv"):
            shutil.copy(ROOT / name, place)
        _rewrite(place / "T-1.csv", lambda time, length, *loads: [
            time, length * (1 + scale) + shift / FOOT,
            *(np.interp(time - late, time, load) * (1 + gain) + zero / POUND for load in loads),
        ])  # fmt: skip
        campaign = load_campaign(place / "campaign.toml")
        marks = {
            name: replace(one, **{
                reading: getattr(one, reading)
                + size * one.reading_uncertainty * rng.normal(size=len(one.test))
                for reading in ("near_toe", "far_toe", "far_thimble")
            })
            for name, one in campaign.marks.items()
        }  # fmt: skip
        specimens = {
            name: replace(one, diameter=tuple(np.array(one.diameter) + wide))
            for name, one in campaign.specimens.items()
        }
        campaign = replace(campaign, specimens=specimens, marks=marks)
        (survey,) = _read_test(campaign, campaign.tests["T-1"])
        # the marks of the other tests were read under the same load cell
        others = [
            replace(one, mark_tension={
                name: tension * (1 + gain) + zero for name, tension in one.mark_tension.items()
            })
            for one in _surveys() if one.plan.id != "T-1"
        ]  # fmt: skip
        surveys = [survey, *others]
        models, _ = fit_strain_models(campaign, surveys)
        basis = basis_of(campaign, survey, earlier_tests_of(surveys, models), pulls={})
        return dict(_numbers(_reduce_survey(campaign, survey, basis.models, None, "{}")))


@cache
def _surveys() -> list[Survey]:
    """Every test of the campaign, as it was logged."""
    campaign = load_campaign(ROOT / "campaign.toml")
    return [one for plan in campaign.tests.values() for one in _read_test(campaign, plan)]


def _rewrite(path: Path, change: Callable[..., list[np.ndarray]]) -> None:
    """Put a changed log in the place of one."""
    lines = path.read_text(encoding="utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    names, *rows = [line for line in lines if not line.startswith("#")]
    table = np.column_stack(change(*np.array([row.split(",") for row in rows], dtype=float).T))
    text = [",".join(f"{value:.9g}" for value in row) for row in table]
    path.write_text("\n".join([*head, names, *text]) + "\n", encoding="utf-8")


def _numbers(test: ReducedTest) -> Iterator[tuple[str, tuple[float, float]]]:
    """Of the new tether, at ten stretches of each branch, its segments, and its loop."""
    curves, shared, segments, loop = (
        test.curves, test.contributions, test.segments, test.amplitude,
    )  # fmt: skip
    if curves is None or shared is None or segments is None or loop is None:
        raise RuntimeError("the test was not reduced")
    for side, branch in enumerate(("ascending", "descending")):
        modulus = curves.tangent_modulus[0, side]
        rows = shared.values["tangent_modulus"][:, 0, side]
        known = np.isfinite(modulus)
        at = curves.strain_bin[known]
        for number, stretch in enumerate(STRETCHES_OF_T_1, start=1):
            parts = [np.interp(stretch, at, row[known]) for row in rows]
            name = f"tangent_modulus, {branch}" + (f", {number}" if number > 1 else "")
            yield (
                name,
                (float(np.interp(stretch, at, modulus[known])), float(np.hypot.reduce(parts))),
            )
        together = shared.shared_standard_uncertainty("segment_modulus")[0, side]
        moduli = segments.segment_modulus[0, side]
        n_segments = int(np.isfinite(moduli).sum())
        for number in range(n_segments):
            yield (
                f"segment_modulus, {branch}, {number + 1} of {n_segments}",
                (float(moduli[number]), float(together[number])),
            )
    for name in OF_LOOP:
        u = shared.shared_standard_uncertainty(f"test_{name}")[0]
        yield name, (float(getattr(loop, name)[0]), float(u))


def compared(draws: list[Numbers]) -> dict[str, tuple[int, float, float]]:
    """Draws, root mean square of the stated uncertainty, and standard deviation, by number."""
    names = dict.fromkeys(name for draw in draws for name in draw)
    found = {}
    for name in names:
        value, stated = np.array([draw[name] for draw in draws if name in draw]).T
        if value.size > len(draws) / 2:
            linear = float(np.sqrt(np.mean(stated**2)))
            found[name] = value.size, linear, float(np.std(value, ddof=1))
    return found


def table(found: dict[str, tuple[int, float, float]]) -> str:
    """Markdown: both standard uncertainties and their ratio, and its sampling error."""
    lines = [
        "| number | draws | linear u | Monte Carlo u | linear / Monte Carlo |",
        "|---" * 5 + "|",
    ]
    for name, (count, linear, drawn) in found.items():
        error = linear / drawn / np.sqrt(2 * count)
        ratio = f"{linear / drawn:.3f} +- {error:.3f}"
        lines.append(f"| {name} | {count} | {linear:.4g} | {drawn:.4g} | {ratio} |")
    return "\n".join(lines)


def main(count: int) -> None:
    """Print both tables."""
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for title, one in (("Synthetic tether, SI", of_tether), ("T-1, new tether, SI", t_1)):
            draws = list(pool.map(one, range(1, count + 1), chunksize=4))
            print(f"{title}\n\n{table(compared(draws))}\n")


if __name__ == "__main__":
    main(int(sys.argv[1]))

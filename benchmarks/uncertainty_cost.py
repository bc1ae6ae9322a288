"""What the propagation of shared errors adds to the reduction of a log.

    python benchmarks/uncertainty_cost.py [ROWS] [REPEATS]

The log of `reduction_over_parse.py` (synthetic) is read once a repeat; the whole of it, reading
and hashing included, is timed with and without the propagation, in turn, every instrument stated.
"""

from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path
from statistics import median

from figures import Figure, hand_on
from programs import sizes, synthetic_log

from reduction.batch.reuse import basis_of, describe
from reduction.batch.survey import _read_test, located_again
from reduction.batch.test_history import earlier_tests_of, fit_strain_models, instruments_of
from reduction.campaign.load import load_campaign
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import StatedErrors

STATED = StatedErrors(
    tension_gain=0.0025, tension_offset=2.0, position_gain=0.001, position_offset=0.003, lag=0.005,
    diameter=1e-4, strain_gain=0.002, stiffness=0.003,
)  # fmt: skip


def seconds(path: Path, *, propagated: bool) -> tuple[float, int]:
    """Time from the file to the reduced test, and its cycles."""
    campaign = replace(load_campaign(path), uncertainty=STATED)
    start = time.perf_counter()
    surveys = [one for plan in campaign.tests.values() for one in _read_test(campaign, plan)]
    models, _ = fit_strain_models(campaign, surveys)
    (survey,) = surveys
    basis = basis_of(campaign, survey, earlier_tests_of(surveys, models), pulls={})
    test = reduce_test(
        located_again(campaign, survey),
        description=describe(campaign, survey),
        specimens=tuple(campaign.specimens[name] for name in survey.plan.specimens),
        models=basis.models, history=None, sources=survey.sources, settings=survey.plan.settings,
        settings_json="{}",
        instruments=instruments_of(campaign, survey, basis.models) if propagated else (),
    )  # fmt: skip
    taken = time.perf_counter() - start
    if test.cycles is None or (test.contributions is None) == propagated:
        raise RuntimeError("the log was not reduced as it should be")
    return taken, test.cycles.n_cycles


def main(n_rows: int, repeats: int) -> list[Figure]:
    """Print both times and their ratio."""
    path, _ = synthetic_log(n_rows)
    seconds(path, propagated=True)
    pairs = [
        (seconds(path, propagated=False)[0], *seconds(path, propagated=True))
        for _ in range(repeats)
    ]
    ratios = [after / before for before, after, _ in pairs]
    print(f"{n_rows} rows, {pairs[0][2]} cycles, {os.cpu_count()} processors, {repeats} pairs")
    print(f"without: {median(one[0] for one in pairs):.2f} s")
    print(f"with:    {median(one[1] for one in pairs):.2f} s")
    print(f"ratio:   {median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})")
    return [
        Figure(
            what=f"reduction of {n_rows:,} rows with uncertainty propagated",
            values=tuple(after for _, after, _ in pairs),
            against="times the same without",
            ratios=tuple(ratios),
        )
    ]


if __name__ == "__main__":
    hand_on(main(*sizes()))

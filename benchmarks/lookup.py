"""A million look-ups in one call against one matrix product of that size, in one run.

    python benchmarks/lookup.py [number of points]
    taskset -c 0 python benchmarks/lookup.py

A look-up gives value, two intervals, whether the point was tested, peak and minimum tension with
their shares, and the rule of the source.  The other side is a product of an array of points
times ten terms with ten coefficients.
"""

from __future__ import annotations

import os
import statistics
import sys
from collections.abc import Callable
from time import perf_counter

import numpy as np
from figures import Figure, hand_on

from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources

PASSES = 15
LINE = "nylon-double-braid-0.5in-new"
WANTED = 60


def seconds(call: Callable[[], object]) -> float:
    """Of one call."""
    start = perf_counter()
    call()
    return perf_counter() - start


def main(count: int) -> list[Figure]:
    """Print medians and their ratio."""
    rng = np.random.default_rng(1)
    line = published_sources()[LINE]
    surface = line.surfaces["apparent_spring_constant"]
    # a mean below an amplitude would be slack; the levels of the source leave none
    points = rng.uniform(surface.low, surface.high, (count, 3)).T
    levels = dict(zip(line.factor_names, points, strict=True))
    matrix, coefficient = rng.normal(size=(count, 10)), rng.normal(size=10)

    def one() -> object:
        return look_up(line, "apparent_spring_constant", **levels)

    sides = [(seconds(one), seconds(lambda: matrix @ coefficient)) for _ in range(PASSES)]
    ours, product = (statistics.median(side) for side in zip(*sides, strict=True))
    processors = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    )
    print(f"{count} points, {processors} processors")
    print(f"look-ups {1e3 * ours:.1f} ms, matrix product {1e3 * product:.2f} ms")
    print(f"ratio of medians {ours / product:.1f} (wanted: below {WANTED})")
    ratios = sorted(one / other for one, other in sides)
    print(f"ratios of single passes {ratios[0]:.1f} to {ratios[-1]:.1f}")
    return [
        Figure(
            what=f"{count:,} look-ups in one call",
            unit="ms",
            values=tuple(1e3 * one for one, _ in sides),
            against="times one matrix product",
            ratios=tuple(ratios),
            at_most=WANTED,
        )
    ]


if __name__ == "__main__":
    hand_on(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000))

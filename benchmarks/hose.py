"""10,000 hoses at 200 strains in one call against one square root of that array, in one run.

    python benchmarks/hose.py [number of hoses] [number of strains]
    taskset -c 0 python benchmarks/hose.py

Every number of a hose is drawn for itself, so that nothing is shared among them but the cord curve.
The call gives every array of a prediction: strain of the part that stretches, tension, fill
pressure, tension, strain and angle of the cords, shares of cords and rubber, end-cap load, spacing,
bore, and four flags.  One other side is `np.sqrt` of an array of that size; the other is the same
arithmetic written plainly, whole arrays at a time, with scipy's interpolator, which also checks the
numbers.
"""

from __future__ import annotations

import os
import statistics
import sys
import tracemalloc
from collections.abc import Callable
from dataclasses import fields
from time import perf_counter

import numpy as np
from figures import Figure, hand_on
from scipy.interpolate import PchipInterpolator

from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_product import HoseDesign, HosePrediction
from reduction.prediction.hose_tension import predict_hose

PASSES = 15
WANTED = 90.0  # times one square root of the array
CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)


def drawn(count: int) -> HoseDesign:
    """Hoses whose numbers all differ; the wrap angles lie on both sides of the neutral one."""
    rng = np.random.default_rng(1)
    return HoseDesign(
        wrap_angle=np.radians(rng.uniform(45, 72, count)),
        layer_diameter=(rng.uniform(0.07, 0.08, count), rng.uniform(0.08, 0.09, count)),
        inner_diameter=rng.uniform(0.05, 0.06, count),
        outer_diameter=rng.uniform(0.10, 0.12, count),
        cords_per_length=rng.uniform(1200, 1400, count),
        cord_diameter=rng.uniform(0.0005, 0.0006, count),
        rubber_modulus=rng.uniform(1e6, 2e6, count),
        cord=CORD,
        cord_load_scale=rng.uniform(0.9, 1.1, count),
        cord_strain_scale=rng.uniform(0.9, 1.1, count),
        dead_length_share=rng.uniform(0, 0.1, count),
        minimum_inner_diameter=0.03,
    )


def plainly(design: HoseDesign, strain: np.ndarray) -> dict[str, np.ndarray]:
    """The same arithmetic, equation by equation, with whole arrays between them."""
    angle = np.asarray(design.wrap_angle)[:, None]
    first, second = (np.asarray(one)[:, None] for one in design.layer_diameter)
    bore, skin = (
        np.asarray(getattr(design, f"{one}_diameter"))[:, None] for one in ("inner", "outer")
    )
    count = np.asarray(design.cords_per_length)[:, None]
    free = strain / (1 - np.asarray(design.dead_length_share)[:, None])
    stretch = 1 + free
    cord_stretch = np.sqrt(stretch**2 * np.cos(angle) ** 2 + np.sin(angle) ** 2 / stretch)
    cord_strain = cord_stretch - 1
    on_curve = cord_strain / np.asarray(design.cord_strain_scale)[:, None]
    curve = PchipInterpolator(design.cord.strain, design.cord.load, extrapolate=False)
    cord = np.where(on_curve <= 0, 0.0, curve(on_curve))
    cord = cord * np.asarray(design.cord_load_scale)[:, None]
    pressures = [
        2 * cord * count * np.sin(angle) ** 2 / (stretch * cord_stretch * one)
        for one in (first, second)
    ]
    end_cap = sum(
        pressure * np.pi * one**2 / (4 * stretch)
        for pressure, one in zip(pressures, (first, second), strict=True)
    )
    number = np.pi * (first + second) * count * np.cos(angle)
    net = number * np.cos(angle) * cord * stretch / cord_stretch - end_cap
    modulus = np.asarray(design.rubber_modulus)[:, None]
    rubber = np.pi / 4 * (skin**2 - bore**2) * modulus / 3 * (stretch - stretch**-2)
    tension = net + rubber
    share = np.where(tension == 0, 0.0, net / np.where(tension == 0, 1.0, tension))
    spacing = np.sqrt(stretch) / cord_stretch / count
    inner = bore / np.sqrt(stretch)
    return {
        "free_strain": free,
        "tension": tension,
        "fill_pressure": pressures[0] + pressures[1],
        "cord_tension": cord,
        "cord_strain": cord_strain,
        "cord_share": share,
        "rubber_share": 1 - share,
        "end_cap_load": end_cap,
        "current_wrap_angle": np.arctan(np.tan(angle) * stretch**-1.5),
        "cord_spacing": spacing,
        "current_inner_diameter": inner,
        "is_slack": on_curve <= 0,
        "is_broken": on_curve > design.cord.break_strain,
        "is_jammed": spacing < np.asarray(design.cord_diameter)[:, None],
        "is_bore_too_small": inner < design.minimum_inner_diameter,
    }


def seconds(call: Callable[[], object]) -> float:
    """Time of one call, its answer thrown away after the clock has stopped."""
    start = perf_counter()
    answer = call()
    taken = perf_counter() - start
    del answer
    return taken


def largest_difference(ours: HosePrediction, theirs: dict[str, np.ndarray]) -> tuple[float, int]:
    """Relative to the largest value of each array; and the number of flags that differ."""
    most, n_flags = 0.0, 0
    for name, other in theirs.items():
        mine = getattr(ours, name)
        if mine.dtype == np.bool_:
            n_flags += int(np.sum(mine != other))
        else:
            scale = float(np.nanmax(np.abs(other))) or 1.0
            most = max(most, float(np.nanmax(np.abs(mine - other))) / scale)
    return most, n_flags


def main(count: int, n_strain: int) -> list[Figure]:
    """Print times, their ratios, the agreement and the memory."""
    design, strain = drawn(count), np.linspace(0.0, 1.6, n_strain)
    numbers = np.random.default_rng(2).uniform(1.0, 3.0, (count, n_strain))
    calls: dict[str, Callable[[], object]] = {
        "root": lambda: np.sqrt(numbers),
        "hoses": lambda: predict_hose(design, strain),
        "plain": lambda: plainly(design, strain),
    }
    taken: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(PASSES):
        for name, call in calls.items():
            taken[name].append(seconds(call))
    middle = {name: statistics.median(times) for name, times in taken.items()}
    spread = sorted(one / other for one, other in zip(taken["hoses"], taken["root"], strict=True))
    tracemalloc.start()
    found = predict_hose(design, strain)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    kept = sum(getattr(found, item.name).nbytes for item in fields(found))
    most, n_flags = largest_difference(found, plainly(design, strain))
    n_processors = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    )
    print(f"{count} hoses x {n_strain} strains, {n_processors} processors, median of {PASSES}")
    print(f"np.sqrt of the array: {1e3 * middle['root']:.2f} ms")
    print(
        f"predict_hose: {1e3 * middle['hoses']:.1f} ms; {middle['hoses'] / middle['root']:.1f} "
        f"square roots ({spread[0]:.1f} to {spread[-1]:.1f} pass by pass)"
    )
    print(
        f"whole arrays, plainly: {1e3 * middle['plain']:.0f} ms; "
        f"{middle['plain'] / middle['root']:.0f} square roots"
    )
    print(f"largest relative difference: {most:.1e}; flags that differ: {n_flags}")
    print(f"memory: {peak / 1e6:.0f} MB at most, {kept / 1e6:.0f} MB of them the answer")
    return [
        Figure(
            what=f"{count:,} hoses at {n_strain} strains in one call",
            unit="ms",
            values=tuple(1e3 * one for one in taken["hoses"]),
            against="times `np.sqrt` of the array",
            ratios=tuple(spread),
            at_most=WANTED,
        ),
        Figure(what="their peak memory", unit="MB", values=(peak / 1e6,)),
    ]


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 10_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 200,
        )
    )

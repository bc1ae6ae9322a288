"""Does the 95 % interval hold the truth in 95 % of cases?  Synthetic tests, every error drawn.

    python benchmarks/coverage_tethers.py 1000

Each test is a tether of a law in closed form, cycled ten times.  Its load cell, crosshead,
clocks, diameter and tape are wrong by errors that are drawn anew for each test with the standard
uncertainties that the reduction is told, and both channels are noisy.  The table counts, for each
number, how often value +- k u holds the truth; everything is synthetic.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import (
    InstrumentErrors,
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.measurement import Record, Specimen, SpliceMarks
from reduction.record.settings import ReductionSettings
from reduction.stages.reduced_test import ReducedTest, TestDescription
from reduction.stages.strain.strain_fit import fit_strain_model

FREE, SPLICES, COMPLIANCE, EXPONENT = 2.55, 1.19, 0.4 / 900**0.85, 0.85
DIAMETER = 0.026416
AREA = np.pi * DIAMETER**2 / 4
LOW, HIGH, FREQUENCY, N_CYCLES, RATE = 0.75, 1.25, 0.1, 10, 20.0
HOLDS = (0.0, 0.35, 0.8, 1.25)
U = InstrumentErrors(
    "new", tension_gain=0.005, tension_offset=2.0, position_gain=0.001, position_offset=0.003,
    lag=0.005, diameter=5e-5,
)  # fmt: skip
TAPE = 1.2e-3
NOISE, PLACE_NOISE = 0.6, 4e-4
STRETCHES = np.linspace(0.8, 1.2, 10)


def middle(strain: np.ndarray) -> np.ndarray:
    """Tension halfway between the branches. [N]."""
    return 420 * strain + 90 * (strain - 0.6) ** 2 + 40


def side(strain: np.ndarray) -> np.ndarray:
    """Half the width of the loop, zero at both ends. [N]."""
    share = (strain - LOW) / (HIGH - LOW)
    return 60 * share * (1 - share)


def modulus(strain: np.ndarray, way: int) -> np.ndarray:
    """True tangent modulus of the rising (+1) or falling (-1) branch. [Pa]."""
    share = (strain - LOW) / (HIGH - LOW)
    return (420 + 180 * (strain - 0.6) + way * 60 * (1 - 2 * share) / (HIGH - LOW)) / AREA


def splices(tension: np.ndarray) -> np.ndarray:
    """Length of both splices under a tension. [m]."""
    return SPLICES * (1 + COMPLIANCE * np.maximum(tension, 0) ** EXPONENT)


def true_state(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Strain and tension: a slow rise from slack, a hold, ten triangular cycles and half of one."""
    start = 20.0
    turn = (time - start) * FREQUENCY
    phase = np.mod(turn, 1.0)
    stroke = np.where(phase < 0.5, 2 * phase, 2 - 2 * phase)
    cycling = LOW + (HIGH - LOW) * stroke
    strain = np.where(time < start, LOW * np.clip((time - 2) / (start - 12), 0, 1), cycling)
    way = np.where(phase < 0.5, 1.0, -1.0) * (time >= start)
    return strain, np.where(strain > 0, middle(strain) * np.minimum(strain / 0.3, 1), 0) + way * (
        side(strain) * (time >= start)
    )


def marks_of(rng: np.random.Generator, errors: dict[str, float]) -> tuple[SpliceMarks, np.ndarray]:
    """Tape readings at the holds, and what the load cell said there."""
    strain = np.array(HOLDS)
    tension = np.where(strain > 0, middle(strain), 0.0)
    free, both = FREE * (1 + strain), splices(tension)
    near, far_toe, far = both / 2, both / 2 + free, both + free
    read = [values + rng.normal(0, TAPE, strain.size) for values in (near, far_toe, far)]
    marks = SpliceMarks(
        "new", ("T",) * 4, ("slack", "min", "centre", "max"), *read, reading_uncertainty=TAPE
    )
    return marks, tension * (1 + errors["tension_gain"]) + errors["tension_offset"]


def one_test(rng: np.random.Generator) -> ReducedTest:
    """A test with every error drawn, reduced with what is known of them."""
    names = ("tension_gain", "tension_offset", "position_gain", "position_offset", "lag")
    errors = {name: rng.normal(0, getattr(U, name)) for name in names}
    time = np.arange(0, 20 + (N_CYCLES + 0.5) / FREQUENCY, 1 / RATE)
    strain, tension = true_state(time)
    _, late = true_state(time - errors["lag"])
    position = FREE * (1 + strain) + splices(tension)
    logged = position * (1 + errors["position_gain"]) + errors["position_offset"]
    logged = logged + rng.normal(0, PLACE_NOISE, time.size)
    load = late * (1 + errors["tension_gain"]) + errors["tension_offset"]
    load = load + rng.normal(0, NOISE, time.size)
    specimen = Specimen("new", diameter=(DIAMETER + rng.normal(0, U.diameter),))
    marks, mark_tension = marks_of(rng, errors)
    settings = ReductionSettings()
    record = Record(
        "T", ("new",), time, logged, load[None],
        np.zeros((1, time.size), np.uint16), np.zeros(time.size, np.uint16),
        n_rows_read=time.size,
    )  # fmt: skip
    model = fit_strain_model(
        specimen, test_id="T", marks=marks, mark_tension=mark_tension, settings=settings.strain
    )
    return reduce_test(
        locate(record, kind="cyclic", settings=settings),
        description=TestDescription("coverage", "T", "cyclic", "position", "triangular", 1, {}),
        specimens=(specimen,), models=(model,), history=None, sources=(), settings=settings,
        settings_json="{}", instruments=(U,),
    )  # fmt: skip


def true_loop() -> dict[str, float]:
    """Quantities of the loop, from the law on a fine grid."""
    time = 20 + (np.arange(200_000) + 0.5) / 200_000 / FREQUENCY
    strain, tension = true_state(time)
    # at equal strain phase the branches differ from their mean by what cancels in the storage
    phase = (np.arange(20_000) + 0.5) / 20_000 * np.pi
    half = (HIGH - LOW) / 2
    around = middle((HIGH + LOW) / 2 + half * np.cos(phase))
    energy = 2 * 60 * (HIGH - LOW) / 6
    return {
        "apparent_spring_constant": float(np.ptp(tension) / np.ptp(strain)),
        "hysteresis_energy": energy,
        "storage_spring_constant": float(2 * np.mean(around * np.cos(phase)) / half),
        "loss_spring_constant": energy / (np.pi * half**2),
        "mean_tension": float((tension.max() + tension.min()) / 2),
        "strain_amplitude": (HIGH - LOW) / 2,
    }


TRUE_LOOP = true_loop()
Found = tuple[str, float, float, float, float, float]


def numbers_of(test: ReducedTest) -> Iterator[Found]:
    """Name, value, truth, random and shared uncertainty, and degrees of freedom of each."""
    curves, summary, shared = test.curves, test.amplitude, test.contributions
    if curves is None or summary is None or shared is None or test.segments is None:
        raise RuntimeError("a test was not reduced")
    together = {name: shared.shared_standard_uncertainty(name) for name in shared.values}
    for place, branch in enumerate(("ascending", "descending")):
        for stretch in STRETCHES:
            bin_ = int(np.argmin(np.abs(curves.strain_bin - stretch)))
            at = (0, place, bin_)
            yield (
                f"tangent_modulus, {branch}",
                float(curves.tangent_modulus[at]),
                float(modulus(curves.strain_bin[bin_], 1 - 2 * place)),
                float(curves.tangent_modulus_standard_uncertainty[at]),
                float(together["tangent_modulus"][at]),
                float(curves.tangent_modulus_count[at] - 1),
            )
        segments = test.segments
        low, high = segments.segment_strain_low[0, place], segments.segment_strain_high[0, place]
        known = np.isfinite(low)
        knot = np.append(low[known], high[known][-1])
        inside = (curves.strain_bin >= knot[0]) & (curves.strain_bin <= knot[-1])
        at_bin = curves.strain_bin[inside]
        hats = np.stack([np.interp(at_bin, knot, unit) for unit in np.eye(knot.size)], axis=1)
        tension = middle(at_bin) + (1 - 2 * place) * side(at_bin)
        ordinate = np.linalg.lstsq(hats, tension, rcond=None)[0]
        for number in range(knot.size - 1):
            yield (
                f"segment_modulus, {branch}",
                float(segments.segment_modulus[0, place, number]),
                float((ordinate[number + 1] - ordinate[number]) / (knot[number + 1] - knot[number]))
                / AREA,
                float(segments.segment_modulus_standard_uncertainty[0, place, number]),
                float(together["segment_modulus"][0, place, number]),
                N_CYCLES - 1,
            )
    for name, truth in TRUE_LOOP.items():
        yield (
            name,
            float(getattr(summary, name)[0]),
            truth,
            float(summary.uncertainty[name][0]),
            float(together[f"test_{name}"][0]),
            N_CYCLES - 1,
        )


def tethers(count: int, seed: int = 1) -> dict[str, list[Found]]:
    """Every number of every test, by name."""
    rng = np.random.default_rng(seed)
    found: dict[str, list[Found]] = defaultdict(list)
    for _ in range(count):
        for row in numbers_of(one_test(rng)):
            found[row[0]].append(row)
    return found


def table(found: dict[str, list[Found]]) -> str:
    """Markdown: share of intervals that hold the truth, and what the interval is made of."""
    lines = [
        "| number | cases | held by 95 % | error / u (rms) | shared share of u^2 | bias / u |",
        "|---|---|---|---|---|---|",
    ]
    for name, rows in found.items():
        value, truth, random, shared, freedom = np.array([row[1:] for row in rows]).T
        total = combined_standard_uncertainty(shared[None], random)
        factor = coverage_factor(
            effective_degrees_of_freedom(random, freedom, contribution=shared[None])
        )
        error = (value - truth) / total
        known = np.isfinite(error)
        held = np.abs(error[known]) <= factor[known]
        share = np.mean((shared[known] / total[known]) ** 2)
        lines.append(
            f"| {name} | {known.sum()} | {100 * held.mean():.1f} % "
            f"| {np.sqrt(np.mean(error[known] ** 2)):.2f} | {share:.2f} "
            f"| {error[known].mean():+.2f} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    print(table(tethers(int(sys.argv[1]))))

"""Coverage of the numbers of a rope: synthetic fifteen-run campaigns, every error drawn.

    python benchmarks/coverage_ropes.py 1000

Each campaign is one line, pulled slowly once and cycled at the fifteen points of a Box-Behnken
design.  Crosshead, clock, gauge length and scale of strain are wrong by errors that are drawn once
a campaign, as are the load cells, one of the pull and one of the runs; every test is warmer or
colder than it says, runs scatter, and both channels are noisy.  In every other campaign K_1 and
tau are quadratic in the coded levels, in the others K_ap and H: coefficients are judged where the
surface is true.  Everything is synthetic.
"""

from __future__ import annotations

import os
import sys
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
from coverage_tethers import Found, table

from reduction.archive.surfaces_dataset import surfaces_to_dataset
from reduction.archive.test_dataset import to_dataset
from reduction.batch.experiment_product import _fit_rows, _row_of_archive
from reduction.campaign.plan import ExperimentPlan
from reduction.experiments.designs import (
    FactorLevels,
    box_behnken,
    model_matrix,
    quadratic_exponents,
)
from reduction.experiments.experiment import ExperimentResult
from reduction.lines.archive_source import _line_source_of_experiment
from reduction.lines.line_lookup import look_up
from reduction.pipeline.located_test import locate
from reduction.pipeline.reduce_test import reduce_test
from reduction.record.contributions import InstrumentErrors
from reduction.record.measurement import Origin, Record, Specimen
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.reduced_test import ReducedTest, TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.uncertainty.errors_of_cycles import PullOrigin

STRENGTH, LENGTH = 28.5e3, 1.8
PULL = np.array([0.0, 1 / 45e3, -6.5e-10, 9.5e-15])  # strain of the slow pull: K_0 doubles on it
LOW = np.array([0.1, 0.15 * STRENGTH, 0.05 * STRENGTH])
HIGH = np.array([0.5, 0.30 * STRENGTH, 0.12 * STRENGTH])
PLAN = box_behnken(3).coded
EXPONENTS = quadratic_exponents(3)
RESPONSES = (
    "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
    "relaxation_time",
)  # fmt: skip
# mean, squares, slopes, interactions
SPRING = 40e3 * np.array([1, 0.01, 0.01, -0.01, 0.02, 0.04, -0.03, 0.01, 0.0, 0.01])
TIME = 0.8 * np.array([1, 0.01, -0.01, 0.01, -0.03, 0.03, -0.02, 0.0, 0.01, 0.0])
APPARENT = 95e3 * np.array([1, 0.01, 0.02, -0.01, 0.03, 0.1, -0.03, 0.01, 0.0, 0.01])
LOSS = 0.1
OF_PAIR = (RESPONSES[2:], RESPONSES[:2])
RUN_SCATTER = 0.01
U = InstrumentErrors(
    "line", tension_gain=0.003, tension_offset=20.0, position_gain=0.002, position_offset=2e-4,
    lag=0.002, strain_gain=0.002, stiffness=0.004,
)  # fmt: skip
OF_CELL = ("tension_gain", "tension_offset")
GAUGE = 0.003
NOISE, PLACE_NOISE = 3.0, 2e-6
N_CYCLES, SAMPLES = 8, 60


def pulled_strain(tension: np.ndarray | float) -> np.ndarray:
    """Strain of the slow pull."""
    return np.asarray(np.polynomial.polynomial.polyval(tension, PULL))


def rest(tension: float) -> float:
    """K_0 at a mean tension."""
    slope = np.polynomial.polynomial.polyder(PULL)
    return 1 / float(np.polynomial.polynomial.polyval(tension, slope))


def stiffness(pair: int, coded: np.ndarray, rng: np.random.Generator | None = None) -> complex:
    """Complex modulus at coded levels, scattered about it where a generator is given."""
    terms = model_matrix(coded[None], EXPONENTS)
    draw = (0.0, 0.0) if rng is None else rng.normal(0, RUN_SCATTER, 2)
    first, second = 1 + draw[0], 1 + draw[1]
    frequency = float((HIGH[0] + LOW[0]) / 2 + coded[0] * (HIGH[0] - LOW[0]) / 2)
    if pair == 0:
        turn = 2j * np.pi * frequency * float(terms[0] @ TIME) * second
        mean = float((HIGH[1] + LOW[1]) / 2 + coded[1] * (HIGH[1] - LOW[1]) / 2)
        return complex(rest(mean) + float(terms[0] @ SPRING) * first * turn / (1 + turn))
    # H goes as the square of the tension amplitude: quadratic in its level
    size = float(terms[0] @ APPARENT) * first
    lost = LOSS * second * size * size / APPARENT[0]
    return complex(np.sqrt(size**2 - lost**2), lost)


def responses(
    modulus: complex, frequency: float, mean: float, amplitude: float
) -> dict[str, float]:
    """What a run would give without errors."""
    lost, above = modulus.imag, modulus.real - rest(mean)
    ratio = above / lost
    return {
        "apparent_spring_constant": abs(modulus),
        "hysteresis_energy": np.pi * lost * (amplitude / abs(modulus)) ** 2,
        "dissipation_spring_constant": above * (1 + ratio**-2),
        "relaxation_time": ratio / (2 * np.pi * frequency),
        "quasi_static_spring_constant": rest(mean),
    }


def record(
    name: str, time: np.ndarray, strain: np.ndarray, tension: np.ndarray, late: np.ndarray,
    rng: np.random.Generator, errors: dict[str, float],
) -> Record:  # fmt: skip
    """What the channels say of a true strain and tension."""
    told = strain * (1 + errors["strain_gain"])
    place = LENGTH * told * (1 + errors["position_gain"]) + errors["position_offset"]
    load = late * (1 + errors["tension_gain"]) + errors["tension_offset"]
    return Record(
        name, ("line",), time, place + rng.normal(0, PLACE_NOISE, time.size),
        (load + rng.normal(0, NOISE, time.size))[None],
        np.zeros((1, time.size), np.uint16), np.zeros(time.size, np.uint16),
        position_is_length=False, n_rows_read=time.size,
    )  # fmt: skip


def stated(test: str) -> InstrumentErrors:
    """What is known of a test: the pull has a load cell of its own, every test its temperature."""
    return replace(U, test=test, tension_instrument="A" if test == "Q" else "B")


def reduced(
    log: Record, kind: str, model: StrainModel, pulls: list[SlowPull | None] | None
) -> ReducedTest:
    """One log of the line, reduced with what is known of its errors."""
    settings = ReductionSettings(cycles=CycleSettings(control="load", waveform="sinusoidal"))
    return reduce_test(
        locate(log, kind=kind, settings=settings),
        description=TestDescription("c", log.test_id, kind, "load", "sinusoidal", 1, {}),
        specimens=(Specimen("line", kind="rope", rated_break_strength=STRENGTH),),
        models=(model,), history=None, sources=(), settings=settings, settings_json=SETTINGS,
        pulls=pulls, instruments=(stated(log.test_id),),
        pull_origins=() if pulls is None else (PullOrigin(stated("Q"), model),),
    )  # fmt: skip


ORIGIN = Origin("coverage", {"synthetic": "yes"}, (), (), "{}", "0", "coverage")
SETTINGS = '{"reduction": {"cycles": {"break_in_cycles": 0}}}'


def campaign(seed: int) -> list[Found]:
    """Every number of one campaign, beside its truth."""
    rng = np.random.default_rng(seed)
    pair = seed % 2
    names = (*OF_CELL, "position_gain", "position_offset", "lag", "strain_gain")
    errors = {name: rng.normal(0, getattr(U, name)) for name in names}
    of_pull = errors | {name: rng.normal(0, getattr(U, name)) for name in OF_CELL}
    length = LENGTH + rng.normal(0, GAUGE)
    model = StrainModel(
        "line", "gauge-length", {"reference_position": 0.0, "gauge_length": length},
        np.diag([0.0, GAUGE**2]),
    )  # fmt: skip
    time = np.arange(0, 200, 0.1)
    force = np.interp(time, [0, 5, 195, 200], [0, 0, 0.4 * STRENGTH, 0.4 * STRENGTH])
    strain = pulled_strain(force) / (1 + rng.normal(0, U.stiffness))
    pulled = reduced(
        record("Q", time, strain, force, force, rng, of_pull), "quasi-static", model, None
    )
    pulls = list(pulled.pulls)
    level = (HIGH + LOW) / 2 + PLAN * (HIGH - LOW) / 2
    rows: list[dict[str, Any]] = []
    plan = ExperimentPlan(
        "rope", "box-behnken",
        tuple(
            FactorLevels(name, low, high)
            for name, low, high in zip(
                ("frequency", "mean_tension", "tension_amplitude"), LOW, HIGH, strict=True
            )
        ),
        {f"R{number}": tuple(row) for number, row in enumerate(PLAN)}, {"line": "Q"}, RESPONSES,
        {}, "blocks",
    )  # fmt: skip
    exact_of: list[dict[str, float]] = []
    found: list[Found] = []
    for number, (frequency, mean, amplitude) in enumerate(level):
        modulus = stiffness(pair, PLAN[number], rng)
        turn = 2 * np.pi * frequency
        step = 1 / frequency / SAMPLES
        time = np.arange(0, (N_CYCLES + 0.6) / frequency, step)

        def wave(at: np.ndarray, turn: float = turn) -> np.ndarray:
            return np.asarray(-np.exp(1j * turn * at))

        strain = pulled_strain(mean) + (amplitude / modulus * wave(time)).real
        strain = strain / (1 + rng.normal(0, U.stiffness))
        late = mean + amplitude * wave(time - errors["lag"]).real
        test = reduced(
            record(f"R{number}", time, strain, late, late, rng, errors), "cyclic", model, pulls
        )
        dataset = to_dataset(test, version="0", command="coverage")
        row = _row_of_archive(plan, dataset, 0, "line")
        rows.append(row | {"run": f"R{number}", "coded": tuple(PLAN[number]), "order": number})
        own = responses(modulus, frequency, mean, amplitude)
        exact_of.append(responses(stiffness(pair, PLAN[number]), frequency, mean, amplitude))
        for name, value in own.items():
            shared = dataset[f"test_{name}_uncertainty_contribution"].values[:, 0]
            found.append(
                (
                    f"{name} of a run",
                    float(dataset[f"test_{name}"].values[0]),
                    float(value),
                    float(dataset[f"test_{name}_random_standard_uncertainty"].values[0]),
                    float(np.sqrt(np.sum(shared**2))),
                    N_CYCLES - 1,
                )
            )
    result = _fit_rows(plan, rows)
    if result.surfaces is None or result.shared is None:
        raise RuntimeError("; ".join(result.notes))
    terms = model_matrix(PLAN, EXPONENTS)
    for index, name in enumerate(RESPONSES):
        if name not in OF_PAIR[pair]:
            continue
        truth = np.array([one[name] for one in exact_of])
        exact = np.linalg.lstsq(terms, truth, rcond=None)[0]
        shared = np.sqrt(np.sum(result.shared.coefficient[:, index] ** 2, axis=0))
        for term, wanted in enumerate(exact):
            found.append(
                (
                    f"{name}, coefficients",
                    float(result.surfaces.coefficient[index, term]),
                    float(wanted),
                    float(result.surfaces.coefficient_standard_uncertainty[index, term]),
                    float(shared[term]),
                    float(result.surfaces.degrees_of_freedom[index]),
                )
            )
    return found + looked_up(result, pair, rng)


def looked_up(result: ExperimentResult, pair: int, rng: np.random.Generator) -> list[Found]:
    """Design values of the surface at three points of the box, with the parts of their interval."""
    line = _line_source_of_experiment(surfaces_to_dataset([result], origin=ORIGIN), "rope")
    found: list[Found] = []
    for coded in rng.uniform(-0.8, 0.8, (3, 3)):
        level = (HIGH + LOW) / 2 + coded * (HIGH - LOW) / 2
        truth = responses(stiffness(pair, coded), *map(float, level))
        at = dict(zip(line.factor_names, level, strict=True))
        for name in OF_PAIR[pair]:
            value = look_up(line, name, **at)
            # both parts of the interval that is given, and the freedom of its scatter
            found.append(
                (
                    f"{name}, looked up",
                    float(value.value),
                    truth[name],
                    float(value.random_standard_uncertainty),
                    float(np.sqrt(np.sum(value.contribution**2))),
                    float(value.random_degrees_of_freedom),
                )
            )
    return found


def campaigns(count: int) -> dict[str, list[Found]]:
    """Every number of every campaign, by name."""
    found: dict[str, list[Found]] = defaultdict(list)
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        for rows in pool.map(campaign, range(count), chunksize=4):
            for row in rows:
                found[row[0]].append(row)
    return found


if __name__ == "__main__":
    print(table(campaigns(int(sys.argv[1]))))

"""Experiments over runs made from a law, for the tests of archives and tables of them."""

from functools import cache

import numpy as np

from reduction.experiments.designs import box_behnken, plackett_burman
from reduction.experiments.experiment import ExperimentResult, RunTable
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.run_sheet import Caution
from reduction.experiments.screening import screening_effects
from reduction.experiments.stiffness_forms import (
    compare_stiffness_forms,
    fit_del_vecchio_stiffness,
    fit_mean_load_stiffness,
)
from reduction.experiments.surface_discrepancy import SurfaceDiscrepancy
from reduction.quantities.names import RESPONSES
from reduction.record.contributions import Component, Contributions
from reduction.record.measurement import Origin, Source, Step
from reduction.record.notes import Note, note
from reduction.stages.three_parameter_line.line_model import check_single_time
from reduction.uncertainty.surface_errors import with_shared_surfaces


def nothing_missed(surfaces):
    """What a quadratic may miss of laws that are known to be quadratic."""
    count, n_terms = surfaces.coefficient.shape
    return SurfaceDiscrepancy(
        surfaces.exponents, np.zeros((count, n_terms, n_terms)), np.full(count, np.inf)
    )


FACTORS = ("frequency", "mean_tension", "tension_amplitude")
UNITS = ("Hz", "N", "N")
LOW, HIGH = np.array([0.1, 3400.0, 850.0]), np.array([0.5, 8500.0, 3400.0])
STRENGTH = 28470.0
ABOUT = Origin(
    campaign_id="nylon",
    attributes={"title": "Nylon line", "synthetic": "yes"},
    sources=(Source("R01.nc", "ab" * 32, 7), Source("R02.nc", "cd" * 32, 8)),
    steps=(Step("surface", "fitted 4 responses over 15 runs"),),
    settings_json="{}",
    version="1.2.3",
    command="reduction run",
)


def run_table(coded, level, responses, *, specimens=None, missing=(), prefix="R", names=None):
    """Runs with responses of a law; those of ``missing`` were not done, those named share a gain."""
    n_runs = len(coded)
    gone = np.isin(np.arange(n_runs), missing)
    mean, amplitude = level[:, 1], level[:, 2]

    def known(values):
        return np.where(gone, np.nan, values)

    return RunTable(
        run=tuple(f"{prefix}{number + 1:02d}" for number in range(n_runs)),
        specimen=tuple(specimens or ["line"] * n_runs),
        coded_plan=coded,
        level=np.where(gone[:, None], np.nan, level),
        response=known(responses),
        response_standard_uncertainty=known(0.002 * responses),
        frequency=known(level[:, 0]),
        mean_tension=known(mean),
        tension_amplitude=known(amplitude),
        peak_tension=known(mean + amplitude),
        minimum_tension=known(mean - amplitude),
        rated_break_strength=np.full(n_runs, STRENGTH),
        remarks=tuple((note("run-without-product"),) if one else () for one in gone),
        shared=None if names is None else Contributions(
            (Component("tension_gain", "load cell"),),
            {
                **{name: 0.01 * known(row)[None] for name, row in zip(names, responses, strict=True)},
                "mean_tension": 0.01 * known(mean)[None],
                "tension_amplitude": 0.01 * known(amplitude)[None],
                "frequency": 0.0 * known(mean)[None],
            },
        ),
    )  # fmt: skip


def laws(rng, coded, count):
    """Positive responses that are near to quadratic in the coded levels."""
    slopes = rng.uniform(-0.2, 0.2, (count, coded.shape[1]))
    bend = rng.uniform(0.02, 0.1, (count, 1))
    shape = 1 + slopes @ coded.T + bend * (coded**2).sum(axis=1)
    noise = 1 + 0.01 * rng.standard_normal((count, len(coded)))
    return 10.0 ** rng.uniform(-1, 5, (count, 1)) * shape * noise


@cache
def surface_experiment(
    name="half-inch", *, seed=3, names=RESPONSES, missing=(), specimens=None, treatment="fixed"
):
    """Box-Behnken runs of one line, with forms, transforms, cautions and a single-time check."""
    rng = np.random.default_rng(seed)
    coded = box_behnken(3).coded
    if specimens is not None:
        coded = np.repeat(coded, len(specimens), axis=0)
    reached = coded + 0.01 * rng.standard_normal(coded.shape)
    level = (HIGH + LOW) / 2 + reached * (HIGH - LOW) / 2
    who = None if specimens is None else list(specimens) * 15
    runs = run_table(
        coded, level, laws(rng, coded, len(names)), specimens=who, missing=missing, names=names
    )
    bent = [index for index, one in enumerate(names) if one in RESPONSES[1:4]]
    scales = ["log", "box-cox", "log"][: len(bent)]
    prefix = {"log": "log_", "box-cox": "box_cox_"}
    surfaces = fit_surfaces(
        runs.level,
        runs.response[[*range(len(names)), *bent]],
        factor_names=FACTORS,
        response_names=(
            *names,
            *(prefix[scale] + names[index] for scale, index in zip(scales, bent, strict=True)),
        ),
        low=LOW,
        high=HIGH,
        run_names=runs.names,
        blocks=None if who is None else runs.specimen,
        block_treatment=treatment,
        transforms=[*["none"] * len(names), *scales],
    )
    stiffness = runs.response[names.index("apparent_spring_constant")]
    loads = {"mean_tension": runs.mean_tension, "rated_break_strength": STRENGTH}
    more = {"tension_amplitude": runs.tension_amplitude, "frequency": runs.frequency}
    single = None
    if "relaxation_time" in names:
        time = runs.response[names.index("relaxation_time")]
        single = check_single_time(
            np.where(np.isfinite(runs.frequency), runs.frequency, 1.0), time, time,
            group=[str(row[1:]) for row in coded],
        )  # fmt: skip
    result = ExperimentResult(
        name=name,
        kind="box-behnken",
        factor_names=FACTORS,
        factor_units=UNITS,
        low=LOW,
        high=HIGH,
        response_names=tuple(names),
        runs=runs,
        surfaces=surfaces,
        screening=None,
        stiffness_forms=(
            fit_del_vecchio_stiffness(stiffness, load_amplitude="half-range", **loads, **more),
            fit_mean_load_stiffness(stiffness, **loads),
        ),
        form_quality=compare_stiffness_forms(stiffness, coded=surfaces.coded, **loads, **more),
        single_time=single,
        derived_dissipation_spring_constant=np.linspace(1e4, 2e4, len(coded)),
        derived_relaxation_time=np.linspace(1.0, 2.0, len(coded)),
        cautions=(
            Caution("slack", "the minimum tension of run 2 reaches zero", "Raise it.", (2,)),
            Caution("no-repeats", "no run is repeated", "Add centre runs."),
        ),
        notes=(
            *surfaces.notes,
            Note("fixture", "note", text="=a note that looks like a formula"),
        ),
    )
    return with_shared_surfaces(result)


@cache
def screening_experiment(name="screening", *, seed=5, missing=()):
    """Five factors in twelve runs, with six dummies."""
    rng = np.random.default_rng(seed)
    design = plackett_burman(5)
    names, responses = (*FACTORS, "temperature", "duration"), RESPONSES[:2]
    coded = np.hstack([design.coded, design.dummy])
    low, high = np.array([*LOW, 278.0, 100.0]), np.array([*HIGH, 298.0, 1000.0])
    level = (high + low) / 2 + design.coded * (high - low) / 2
    runs = run_table(coded, level, laws(rng, design.coded, 2), missing=missing, prefix="P")
    return ExperimentResult(
        name=name,
        kind="plackett-burman",
        factor_names=names,
        factor_units=(*UNITS, "K", "1"),
        low=low,
        high=high,
        response_names=responses,
        runs=runs,
        surfaces=None,
        screening=screening_effects(design, runs.response, names=names),
        stiffness_forms=(),
        form_quality=None,
        single_time=None,
        derived_dissipation_spring_constant=np.full(12, np.nan),
        derived_relaxation_time=np.full(12, np.nan),
    )

"""From runs to surfaces: what an experiment gives, and what it refuses in which words."""

import numpy as np
import pytest

from reduction.experiment import RunTable
from reduction.pipeline.experiment import LineOfRuns, fit_experiment
from reduction.surface.designs import box_behnken, plackett_burman
from reduction.surface.levels import FactorLevels

FACTORS = (
    FactorLevels("frequency", 0.1, 0.5),
    FactorLevels("mean_tension", 3000.0, 8000.0),
    FactorLevels("tension_amplitude", 1000.0, 2500.0),
)
NAMES = ("apparent_spring_constant", "hysteresis_energy", "relaxation_time")
UNITS = ("Hz", "N", "N")
DISSIPATION, TIME = 7.0e4, 2.0


def made(coded=None, specimens=("a",), shift=0.0, factors=FACTORS):
    """Runs of a line of one K_1 and tau whose K_0 rises with the mean tension."""
    coded = box_behnken(3).coded if coded is None else np.asarray(coded, dtype=float)
    n_runs = coded.shape[0]
    coded = np.tile(coded, (len(specimens), 1))
    low, high = (np.array([getattr(one, end) for one in factors]) for end in ("low", "high"))
    level = (low + high) / 2 + coded[:, : len(factors)] * (high - low) / 2
    frequency, mean, amplitude = level.T[:3]
    x = 2 * np.pi * frequency * TIME
    rest = 4.0e4 + 5.0 * mean + shift * np.repeat(np.arange(len(specimens)), n_runs)
    storage = rest + DISSIPATION * x**2 / (1 + x**2)
    loss = DISSIPATION * x / (1 + x**2)
    apparent = np.hypot(storage, loss)
    energy = np.pi * loss * (amplitude / apparent) ** 2
    response = np.array([apparent, energy, np.full(apparent.size, TIME)])
    runs = RunTable(
        run=tuple(f"R{number + 1}" for number in range(n_runs)) * len(specimens),
        specimen=tuple(name for name in specimens for _ in range(n_runs)),
        coded_plan=coded,
        level=level,
        response=response,
        response_standard_uncertainty=1e-3 * response,
        frequency=frequency,
        mean_tension=mean,
        tension_amplitude=amplitude,
        peak_tension=mean + amplitude,
        minimum_tension=mean - amplitude,
        rated_break_strength=np.full(frequency.size, 28000.0),
        remark=("",) * frequency.size,
    )
    return runs, LineOfRuns(storage, loss, rest)


def fit(runs, line, kind="box-behnken", factors=FACTORS, **changed):
    given = {"transform": {}, "specimens_as": "blocks", "response_names": NAMES} | changed
    return fit_experiment(
        runs, line, name="nylon", kind=kind, factors=factors, factor_units=UNITS, **given
    )


def without(runs, *places):
    response = runs.response.copy()
    response[:, list(places)] = np.nan
    return RunTable(**{**vars(runs), "response": response})


def test_a_surface_a_response_and_one_more_on_another_scale():
    result = fit(*made(), transform={"hysteresis_energy": "log"})
    surfaces = result.surfaces
    assert surfaces.response_names == (*NAMES, "log_hysteresis_energy")
    assert surfaces.transform == ("none", "none", "none", "log")
    # tau is the same in every run
    assert surfaces.coefficient[2] == pytest.approx([TIME, *[0.0] * 9], abs=1e-9)
    # the mean of the three centre runs is B1
    centre = np.all(result.runs.coded_plan == 0, axis=1)
    assert surfaces.coefficient[:2, 0] == pytest.approx(result.runs.response[:2, centre].mean(1))


def test_one_time_of_every_run_is_said_to_hold():
    result = fit(*made())
    assert result.single_time.exponent == pytest.approx(0.0, abs=1e-6)
    assert any("one relaxation time holds" in note for note in result.notes)


def test_k_1_and_tau_come_back_from_the_surfaces_of_their_parts():
    result = fit(*made())
    assert result.derived_dissipation_spring_constant == pytest.approx(DISSIPATION, rel=0.03)
    assert result.derived_relaxation_time == pytest.approx(TIME, rel=0.05)


def test_stiffness_forms_say_which_load_they_hold():
    result = fit(*made())
    assert [form.form for form in result.stiffness_forms] == ["del-vecchio", "mean-load"]
    assert result.form_quality.forms == ("del-vecchio", "mean-load", "quadratic")
    best = np.argmin(result.form_quality.prediction_sum_of_squares)
    assert result.form_quality.forms[best] == "quadratic"


def test_forms_are_refused_without_a_break_strength_and_the_surfaces_stand():
    runs, line = made()
    bare = RunTable(**{**vars(runs), "rated_break_strength": np.full(15, np.nan)})
    result = fit(bare, line)
    assert result.stiffness_forms == () and result.form_quality is None
    assert any("refused: stiffness forms" in note for note in result.notes)
    assert result.surfaces is not None


def test_fourteen_of_fifteen_runs_still_make_surfaces():
    whole, line = made()
    result = fit(without(whole, 3), line)
    assert result.surfaces.degrees_of_freedom.tolist() == [4, 4, 4]
    assert result.surfaces.coefficient[2, 0] == pytest.approx(TIME)


def test_fewer_runs_than_terms_are_refused_with_a_note():
    runs, line = made()
    result = fit(without(runs, *range(7)), line)
    assert result.surfaces is None
    assert any("refused: response surfaces: " in note for note in result.notes)


def test_several_specimens_are_blocks():
    result = fit(*made(specimens=("a", "b"), shift=4000.0))
    assert result.surfaces.blocks.names == ("a", "b")
    assert result.surfaces.blocks.treatment == "fixed"
    assert result.runs.names[0] == "R1 a"
    effect = result.surfaces.blocks.effect[0]
    assert effect[1] - effect[0] == pytest.approx(4000.0, rel=0.02)


def test_specimens_may_be_draws_from_many_lines():
    result = fit(*made(specimens=("a", "b", "c"), shift=4000.0), specimens_as="random")
    assert result.surfaces.blocks.treatment == "random"
    # 0, 4000 and 8000 N apart at rest: standard deviation 4000 N
    assert result.surfaces.blocks.standard_deviation[0] == pytest.approx(4000.0, rel=0.05)


def test_a_run_that_goes_slack_is_named():
    levels = (*FACTORS[:2], FactorLevels("tension_amplitude", 1000.0, 3000.0))
    runs, line = made(factors=levels)
    result = fit(runs, line, factors=levels)
    slack = [caution for caution in result.cautions if caution.kind == "slack"]
    place = [tuple(row) for row in runs.coded_plan].index((0.0, -1.0, 1.0))
    assert [caution.runs for caution in slack] == [(place + 1,)]


def test_remarks_of_runs_are_notes_of_the_experiment():
    runs, line = made()
    remark = ("its test gave no product", *[""] * 14)
    result = fit(RunTable(**{**vars(without(runs, 0)), "remark": remark}), line)
    assert "R1: its test gave no product" in result.notes


def test_a_screening_gives_effects_and_no_surface():
    design = plackett_burman(3)
    coded = np.hstack([design.coded, design.dummy])
    result = fit(*made(coded), kind="plackett-burman")
    assert result.surfaces is None
    assert result.screening.names == tuple(one.name for one in FACTORS)
    # K_0 rises by 5 N a newton of mean tension, and K_ap nearly as much
    assert result.screening.effect[0, 1] == pytest.approx(25000.0, rel=0.05)
    assert (
        result.screening.is_significant[0].tolist() == [False, True, False]
        or (result.screening.is_significant[0, 1])
    )


def test_a_column_that_does_not_fit_the_runs_is_refused():
    runs, _ = made()
    with pytest.raises(ValueError, match="specimen does not fit the runs; found 1; needed 15"):
        RunTable(**{**vars(runs), "specimen": ("a",)})


def test_terms_are_left_out_only_where_it_is_asked_for():
    runs, line = made()
    assert fit(runs, line).reduced is None
    noise = np.random.default_rng(8).normal(0, 0.02, runs.response.shape)
    noisy = RunTable(**{**vars(runs), "response": runs.response * (1 + noise)})
    result = fit(noisy, line, term_reduction="aicc")
    # tau is one number and its scatter: the mean alone
    assert result.reduced.is_kept[2].tolist() == [True, *[False] * 9]
    # K_ap rises with the mean tension by far the most
    assert result.reduced.is_kept[0, 5]
    assert result.surfaces.coefficient.shape == (3, 10)


def test_specimens_drawn_from_many_keep_all_terms_with_a_note():
    runs, line = made(specimens=("a", "b", "c"), shift=4000.0)
    result = fit(runs, line, specimens_as="random", term_reduction="aicc")
    assert result.reduced is None
    assert any("refused: reduction of terms" in note for note in result.notes)

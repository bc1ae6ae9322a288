"""From runs to surfaces: what an experiment gives, and what it refuses in which words."""

from types import SimpleNamespace

import numpy as np
import pytest

from reduction.experiments.designs import FactorLevels, box_behnken, plackett_burman
from reduction.experiments.experiment import RunTable
from reduction.experiments.experiment_fit import (
    LineOfRuns,
    _single_time_of_runs,
    fit_experiment,
)
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.record.notes import note

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
        remarks=((),) * frequency.size,
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
    result = fit(*made(), transform={"hysteresis_energy": "log", "relaxation_time": "none"})
    surfaces = result.surfaces
    assert surfaces.response_names == (*NAMES, "log_hysteresis_energy")
    assert surfaces.transform == ("none", "none", "none", "log")
    # tau is the same in every run
    assert surfaces.coefficient[2] == pytest.approx([TIME, *[0.0] * 9], abs=1e-9)
    # the mean of the three centre runs is B1
    centre = np.all(result.runs.coded_plan == 0, axis=1)
    assert surfaces.coefficient[:2, 0] == pytest.approx(result.runs.response[:2, centre].mean(1))


def test_energy_and_time_are_read_from_logarithms_where_nothing_is_stated():
    surfaces = fit(*made()).surfaces
    assert surfaces.response_names[3:] == ("log_hysteresis_energy", "log_relaxation_time")
    stated = fit(*made(), transform=dict.fromkeys(NAMES, "none")).surfaces
    assert stated.response_names == NAMES


@pytest.mark.parametrize(
    ("exponent", "scale"),
    [(0.0, "log"), (0.3, "log"), (0.8, "log-times-frequency"), (1.0, "log-times-frequency")],
)
def test_a_time_that_falls_with_the_frequency_is_fitted_as_product_with_it(exponent, scale):
    """Three levels leave ln f^-n no residual: a quadratic misses n of it, or 1 - n of the product."""
    runs, line = made()
    response = runs.response.copy()
    response[2] = TIME * (runs.frequency / 0.3) ** -exponent * np.exp(0.2 * runs.coded_plan[:, 1])
    surfaces = fit(RunTable(**{**vars(runs), "response": response}), line).surfaces
    place = surfaces.transform.index(scale)
    prefix = {"log": "log_", "log-times-frequency": "log_frequency_times_"}[scale]
    assert f"{prefix}relaxation_time" in surfaces.response_names
    assert surfaces.response_names[-1] == f"{prefix}relaxation_time"
    found = evaluate_surfaces(surfaces, [[-0.5, 0.0, 0.0], [0.5, 1.0, 0.0]], units="coded")
    truth = TIME * (np.array([0.2, 0.4]) / 0.3) ** -exponent * np.exp([0.0, 0.2])
    # 0.070 and 0.041 are what the parabola through ln f at 0.1, 0.3 and 0.5 Hz misses there
    least = exponent if scale == "log" else 1 - exponent
    off = np.log(found.value[surfaces.response_names.index(f"{prefix}relaxation_time")] / truth)
    assert np.abs(off) == pytest.approx(least * np.array([0.07037, 0.04120]), abs=1e-5)
    assert place >= 3


def test_a_scale_that_is_stated_is_kept_where_the_time_falls():
    runs, line = made()
    response = runs.response.copy()
    response[2] = TIME * 0.3 / runs.frequency
    falling = RunTable(**{**vars(runs), "response": response})
    stated = fit(falling, line, transform={"relaxation_time": "log"}).surfaces
    assert "log_frequency_times_relaxation_time" not in stated.response_names
    asked = fit(falling, line, transform={"relaxation_time": "log-times-frequency"}).surfaces
    place = asked.response_names.index("log_frequency_times_relaxation_time")
    # f tau is one number
    assert asked.coefficient[place] == pytest.approx([np.log(0.3 * TIME), *[0.0] * 9], abs=1e-9)


@pytest.mark.parametrize(("place", "law"), [(1, lambda plane: plane), (0, np.exp)])
def test_runs_that_object_to_the_usual_scale_choose_the_other(place, law):
    """A plane over the levels has no logarithm that is quadratic, its exponential no other scale."""
    runs, line = made()
    plane = 1.6 + runs.coded_plan @ [0.7, 0.3, 0.5]
    noise = 1e-4 * np.random.default_rng(2).normal(size=15)
    response = runs.response.copy()
    response[place] = law(plane + noise)
    result = fit(RunTable(**{**vars(runs), "response": response}), line)
    of = NAMES[place]
    assert (f"log_{of}" in result.surfaces.response_names) == (law is np.exp)
    (said,) = [str(one) for one in result.notes if f"{of} uses the surface fitted to" in str(one)]
    assert ("its logarithm" if law is np.exp else "as measured") in said


def test_one_time_of_every_run_is_said_to_hold():
    result = fit(*made())
    assert result.single_time.exponent == pytest.approx(0.0, abs=1e-6)
    assert any("one relaxation time holds" in note for note in map(str, result.notes))


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
    assert any(
        "stiffness forms of mooring codes not given" in note for note in map(str, result.notes)
    )
    assert result.surfaces is not None


def test_fourteen_of_fifteen_runs_still_make_surfaces():
    whole, line = made()
    result = fit(without(whole, 3), line)
    assert result.surfaces.degrees_of_freedom.tolist() == [4] * 5
    assert result.surfaces.coefficient[2, 0] == pytest.approx(TIME)


def test_fewer_runs_than_terms_are_refused_with_a_note():
    runs, line = made()
    result = fit(without(runs, *range(7)), line)
    assert result.surfaces is None
    assert any("response surfaces not given: " in note for note in map(str, result.notes))


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
    remarks = ((note("run-without-product"),), *[()] * 14)
    result = fit(RunTable(**{**vars(without(runs, 0)), "remarks": remarks}), line)
    assert "R1: its test gave no results" in tuple(map(str, result.notes))


def test_a_screening_gives_effects_and_no_surface():
    design = plackett_burman(3)
    coded = np.hstack([design.coded, design.dummy])
    result = fit(*made(coded), kind="plackett-burman")
    assert result.surfaces is None
    assert result.screening.names == tuple(one.name for one in FACTORS)
    # K_0 rises by 5 N a newton of mean tension, and K_ap nearly as much
    assert result.screening.effect[0, 1] == pytest.approx(25000.0, rel=0.05)
    assert result.screening.is_significant[0, 1]
    assert np.argmax(np.abs(result.screening.effect[0])) == 1


def test_a_column_that_does_not_fit_the_runs_is_refused():
    runs, _ = made()
    with pytest.raises(ValueError, match="specimen does not fit the runs; found 1; needed 15"):
        RunTable(**{**vars(runs), "specimen": ("a",)})


def changed(runs, **columns):
    return RunTable(**{**vars(runs), **columns})


def test_k_1_and_tau_of_each_specimen_come_from_its_own_level():
    # half a K_1 lies between the two at rest
    runs, line = made(specimens=("a", "b"), shift=35000.0)
    result = fit(runs, line)
    assert result.derived_dissipation_spring_constant == pytest.approx(DISSIPATION, rel=0.03)
    assert result.derived_relaxation_time == pytest.approx(TIME, rel=0.05)


def test_a_run_without_loops_still_has_k_1_and_tau_of_the_surfaces():
    runs, line = made(specimens=("a", "b"), shift=35000.0)
    parts = [part.copy() for part in (line.storage_spring_constant, line.loss_spring_constant)]
    for part in parts:
        part[3] = np.nan
    result = fit(runs, LineOfRuns(*parts, line.quasi_static_spring_constant))
    assert result.derived_dissipation_spring_constant[3] == pytest.approx(DISSIPATION, rel=0.05)


def test_a_missing_run_leaves_the_stiffness_forms_and_the_single_time():
    runs, line = made()
    gone = {
        name: np.where(np.arange(15) == 4, np.nan, getattr(runs, name))
        for name in ("frequency", "mean_tension", "tension_amplitude", "rated_break_strength")
    }
    response, level = runs.response.copy(), runs.level.copy()
    response[:, 4], level[4] = np.nan, np.nan
    parts = [np.where(np.arange(15) == 4, np.nan, part) for part in vars(line).values()]
    result = fit(changed(runs, response=response, level=level, **gone), LineOfRuns(*parts))
    assert [form.form for form in result.stiffness_forms] == ["del-vecchio", "mean-load"]
    assert result.single_time.exponent == pytest.approx(0.0, abs=1e-6)
    assert not [note for note in map(str, result.notes) if "not given" in note]


def test_lines_of_two_strengths_have_no_common_form():
    runs, line = made(specimens=("a", "b"))
    result = fit(changed(runs, rated_break_strength=np.repeat([28000.0, 30000.0], 15)), line)
    assert result.stiffness_forms == ()
    assert any("lines of 2 break strengths" in note for note in map(str, result.notes))


def test_forms_over_several_specimens_say_that_they_pool_them():
    assert any(
        "pool the specimens" in note for note in map(str, fit(*made(specimens=("a", "b"))).notes)
    )
    assert not any("pool the specimens" in note for note in map(str, fit(*made()).notes))


def test_runs_at_equal_loads_are_found_by_the_levels_reached_not_by_the_plan():
    # a line whose tau is 1/f at each load, and a plan that two swapped runs contradict
    runs, line = made()
    load = 1 + 0.3 * runs.coded_plan[:, 1] + 0.2 * runs.coded_plan[:, 2]
    response = runs.response.copy()
    response[2] = load / runs.frequency
    plan = runs.coded_plan.copy()
    plan[[0, 6]] = plan[[6, 0]]
    result = fit(changed(runs, response=response, coded_plan=plan), line)
    assert result.single_time.exponent == pytest.approx(1.0, abs=1e-6)
    # what the runs reached tells them apart, and no surface is drawn through a plan that is wrong
    (note,) = [note for note in map(str, result.notes) if "not those of the plan" in note]
    assert "R1 " in note and "R7 " in note and "R2 " not in note


def test_a_screening_whose_runs_are_swapped_has_no_effects_and_says_which():
    design = plackett_burman(3)
    coded = np.hstack([design.coded, design.dummy])
    runs, line = made(coded)
    plan = coded.copy()
    plan[[0, 1]] = plan[[1, 0]]
    result = fit(changed(runs, coded_plan=plan), line, kind="plackett-burman")
    assert result.screening is None
    (note,) = [
        note for note in map(str, result.notes) if "effects" in note and "not given: " in note
    ]
    assert "R1 " in note and "R2 " in note and "R3 " not in note


def test_a_screening_whose_levels_stray_keeps_its_effects_with_a_note():
    design = plackett_burman(3)
    coded = np.hstack([design.coded, design.dummy])
    near = coded.copy()
    near[4, 0] *= 0.8
    runs, line = made(near)
    result = fit(changed(runs, coded_plan=coded), line, kind="plackett-burman")
    assert result.screening is not None
    (note,) = [note for note in map(str, result.notes) if "differ from the plan" in note]
    assert "R5 frequency" in note


def test_a_screening_that_misses_a_run_says_why_it_has_no_effects():
    design = plackett_burman(3)
    runs, line = made(np.hstack([design.coded, design.dummy]))
    result = fit(without(runs, 3), line, kind="plackett-burman")
    assert np.isnan(result.screening.effect).all() and result.refusal_status == 5
    (note,) = [
        note for note in map(str, result.notes) if "effects" in note and "not given: " in note
    ]
    assert "a run is missing" in note and "no value of R4" in note


def test_a_screening_without_dummies_says_whose_error_it_has():
    coded = plackett_burman(3).coded
    assert any(
        "Lenth" in note for note in map(str, fit(*made(coded), kind="plackett-burman").notes)
    )


def test_a_response_that_no_run_gives_is_named_with_the_reason_of_the_runs():
    runs, line = made()
    response = runs.response.copy()
    response[2] = np.nan
    reason = "K_1 and tau not given: no slow pull is named"
    remark = note("run-without-line", reason="no slow pull is named")
    result = fit(changed(runs, response=response, remarks=((remark,),) * 15), line)
    (said,) = [note for note in map(str, result.notes) if note.startswith("surface of")]
    assert said.startswith("surface of relaxation_time not given: fewer runs")
    assert "0 of 15 runs" in said and f"{reason} (15 of them)" in said
    # and the runs themselves in one line
    (remark,) = [note for note in map(str, result.notes) if note.endswith(f": {reason}")]
    assert remark == f"R1, R2, R3, R4, R5 and 10 more: {reason}"


def test_a_remark_of_two_parts_is_two_notes_and_the_first_is_the_reason():
    runs, line = made()
    response = runs.response.copy()
    response[2] = np.nan
    remarks = [(note("run-without-line", reason="no pull"),)] * 15
    remarks[3] += (note("run-slack", cycles="every cycle"),)
    notes = tuple(
        map(str, fit(changed(runs, response=response, remarks=tuple(remarks)), line).notes)
    )
    assert "R4: the line goes slack in every cycle" in notes
    (refusal,) = [note for note in notes if note.startswith("surface of")]
    assert "slack" not in refusal and "(15 of them)" in refusal


def test_the_error_of_the_slow_pull_is_said_to_be_outside_the_standard_errors():
    said = "the error of K_0"
    assert any(said in note for note in map(str, fit(*made()).notes))
    other = fit(*made(), response_names=("apparent_spring_constant", "hysteresis_energy", "x"))
    assert not any(said in note for note in map(str, other.notes))


def test_a_surface_below_zero_is_not_named_where_its_logarithm_stands_beside_it():
    runs, line = made()
    response = runs.response.copy()
    response[1] = 2.1 - runs.coded_plan.sum(axis=1)
    found = fit(changed(runs, response=response), line)
    assert "log_hysteresis_energy" in found.surfaces.response_names
    assert "surface-below-zero" not in [one.code for one in found.notes]


def test_a_drift_over_the_order_that_is_stated_is_named():
    rng = np.random.default_rng(2)
    runs, line = made()
    # numbers that rise with gaps, as tests between the runs leave them
    order = 10.0 * rng.permutation(15) + 3
    response = runs.response.copy()
    response[2] = TIME + 0.02 * order / 10 + rng.normal(0, 1e-3, 15)
    drifting = changed(runs, response=response)
    notes = tuple(map(str, fit(drifting, line, run_order=order).notes))
    # the surface in use is that of the logarithm: a share of the response
    (note,) = [note for note in notes if "relaxation_time drifts with run order" in note]
    share = float(np.mean(0.02 / response[2]))
    assert note.startswith("log_")
    assert float(note.partition("change by ")[2].split()[0]) == pytest.approx(share, rel=0.05)
    assert not any("drifts with" in note for note in map(str, fit(drifting, line).notes))


def test_cautions_follow_the_order_that_is_stated():
    runs, line = made()
    # the three centre runs are last in the campaign, and were run far apart
    order = np.arange(15.0)
    order[[12, 13, 14]] = [-1, 6.5, 20]
    kinds = {one.kind: one for one in fit(runs, line).cautions}
    assert "R13, R14, R15" in kinds["pure-error-excludes-drift"].message
    assert "it states no order" in kinds["pure-error-excludes-drift"].message
    stated = {one.kind for one in fit(runs, line, run_order=order).cautions}
    assert "pure-error-excludes-drift" not in stated


def test_two_specimens_in_one_run_are_one_run_of_the_cautions():
    levels = (*FACTORS[:2], FactorLevels("tension_amplitude", 1000.0, 3000.0))
    result = fit(*made(specimens=("a", "b"), factors=levels), factors=levels)
    slack = [caution for caution in result.cautions if caution.kind == "slack"]
    assert len(slack) == 1 and len(slack[0].runs) == 1
    assert slack[0].message.count("run R") == 1


def test_specimens_in_tests_of_their_own_have_cautions_of_their_own():
    runs, line = made(specimens=("a", "b"))
    names = tuple(f"A{n}" if n <= 15 else f"B{n - 15}" for n in range(1, 31))
    found = fit(changed(runs, run=names), line).cautions
    repeats = [one.message for one in found if one.kind == "pure-error-excludes-drift"]
    assert len(repeats) == 2
    assert "A13, A14, A15" in repeats[0] and "B13, B14, B15" in repeats[1]


def test_whether_there_is_one_relaxation_time_does_not_hang_on_its_unit():
    """Of two runs the stated uncertainty is all that is known; it enters relative to the time.

    tau as f^-n: the standard uncertainty of n is sqrt(2) times the relative one over ln 5.
    """
    frequency, time = np.array([0.1, 0.5]), np.array([3.0, 2.0])

    def check(scale, relative):
        runs = SimpleNamespace(
            response=(scale * time)[None],
            response_standard_uncertainty=(scale * relative * time)[None],
            specimen=["rope"] * 2, frequency=frequency,
        )  # fmt: skip
        line = SimpleNamespace(
            loss_spring_constant=0.1 * frequency, storage_spring_constant=frequency**0.2
        )
        coded = np.array([[-1.0, 0.0], [1.0, 0.0]])
        return _single_time_of_runs(runs, coded, 0, ("relaxation_time",), line)[0]

    for scale in (1.0, 1e3):  # s, ms
        found = check(scale, 0.02)
        assert found.exponent == pytest.approx(np.log(3 / 2) / np.log(5))
        assert found.exponent_standard_uncertainty == pytest.approx(0.02 * 2**0.5 / np.log(5))
        assert found.loss_exponent == pytest.approx(0.8)  # of the loss factor, f over f^0.2

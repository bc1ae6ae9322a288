"""Experiments of a campaign: what may be written, and what is refused in which words."""

from pathlib import Path

import pytest

from reduction.campaign.experiment_plans import _parse_factor, agree_on_pulls, plan_experiment
from reduction.campaign.load import load_campaign
from reduction.campaign.model import ExperimentSection
from reduction.campaign.plan import StepPlan, TestPlan
from reduction.record.errors import SettingsError
from reduction.record.measurement import Specimen
from reduction.record.settings import ReductionSettings

CAMPAIGN = Path(__file__).parents[2] / "raw" / "nylon-synthetic" / "campaign.toml"
LOADS = {"mean_tension": ("12 %RBS", "30 %RBS"), "tension_amplitude": ("5 %RBS", "12 %RBS")}


def plan_of(name, kind="cyclic", specimens=("line",), steps=()):
    return TestPlan(
        id=name, kind=kind, files=(), specimens=specimens, order=None, control="load",
        waveform="sinusoidal", target_strain=(), attributes={}, settings=ReductionSettings(),
        steps=steps,
    )  # fmt: skip


STEPS = (
    StepPlan("dynamic 1", "cyclic", (0.0, 1.0), None, None),
    StepPlan("pull", "quasi-static", (1.0, 2.0), None, None),
)
TESTS = {
    "R1": plan_of("R1"),
    "R2": plan_of("R2"),
    "Q": plan_of("Q", "quasi-static"),
    "P-7": plan_of("P-7", steps=STEPS),
    "H": plan_of("H", "relaxation"),
}
SPECIMENS = {
    "line": Specimen("line", kind="rope", rated_break_strength=1000.0),
    "bare": Specimen("bare", kind="rope"),
}


def plan(**changed):
    section = {
        "kind": "box-behnken",
        "factors": LOADS,
        "runs": {"R1": (-1, 0), "P-7/dynamic 1": (0, 1)},
    }
    return plan_experiment(
        Path("campaign.toml"), "nylon", ExperimentSection(**(section | changed)),
        tests=TESTS, specimens=SPECIMENS,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "levels", "low", "high", "basis"),
    [
        ("frequency", ("0.1 Hz", "0.5 Hz"), 0.1, 0.5, "absolute"),
        ("mean_tension", ("100 lbf", "1 kN"), 444.822, 1000.0, "absolute"),
        ("mean_tension", ("12 %MBL", "30%RBS"), 0.12, 0.30, "rated_break_strength"),
        ("tension_amplitude", ("20 % of mean", "45 %of mean"), 0.20, 0.45, "mean_tension"),
        ("moisture", ("1", "2.5"), 1.0, 2.5, "absolute"),
    ],
)
def test_levels_are_read_with_their_units(name, levels, low, high, basis):
    found = _parse_factor(name, levels)
    assert (found.low, found.high) == pytest.approx((low, high), rel=1e-6)
    assert (found.name, found.basis) == (name, basis)


@pytest.mark.parametrize(
    ("name", "levels", "message"),
    [
        ("frequency", ("0.1", "0.5"), "a value has no unit"),
        ("mean_tension", ("0.1 m", "0.5 m"), "'m' is not a unit of force"),
        ("mean_tension", ("12 %RBS", "500 N"), "given in different forms; found 12 %RBS and 500 N"),
        ("mean_tension", ("30 %RBS", "12 %RBS"), "levels of mean_tension do not rise"),
    ],
)
def test_levels_that_cannot_be_are_refused(name, levels, message):
    with pytest.raises(SettingsError, match=message):
        _parse_factor(name, levels)


def test_runs_and_pulls_are_named_as_their_products_are():
    found = plan(quasi_static={"line": "P-7/pull"}, transform={"relaxation_time": "log"})
    assert found.runs == {"R1": (-1.0, 0.0), "P-7.dynamic-1": (0.0, 1.0)}
    assert found.quasi_static == {"line": "P-7.pull"}
    assert found.transform == {"relaxation_time": "log"}


def test_the_responses_are_those_of_the_report_where_none_is_said():
    assert plan().responses == (
        "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
        "relaxation_time",
    )  # fmt: skip


def test_dummy_columns_are_for_screening_alone():
    runs = {"R1": (-1, 0, 1), "R2": (1, 1, -1)}
    assert plan(kind="plackett-burman", runs=runs).runs["R1"] == (-1.0, 0.0, 1.0)
    with pytest.raises(
        SettingsError, match="run 'R1' has 3 coded levels; needed 2, one per factor"
    ):
        plan(runs=runs)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"runs": {"R9": (0, 0)}}, "a run is not a test of the campaign; found R9; needed"),
        ({"runs": {"P-7": (0, 0)}}, "a run is not a test of the campaign; found P-7"),
        ({"runs": {"P-7/x": (0, 0)}}, "a run is not a test of the campaign; found P-7/x"),
        ({"runs": {"H": (0, 0)}}, "run 'H' has no cycles; found relaxation"),
        ({"runs": {"R1": (0,)}}, "run 'R1' has 1 coded levels; needed 2"),
        (
            {"kind": "plackett-burman", "runs": {"R1": (0, 0), "R2": (1, 1, 1)}},
            "the runs differ in the number",
        ),
        ({"quasi_static": {"line": "Q9"}}, "slow pull of 'line' is not a test of the campaign"),
        ({"quasi_static": {"line": "R1"}}, "'R1' is not a slow pull; found cyclic"),
        ({"quasi_static": {"other": "Q"}}, "the slow pull 'Q' does not pull 'other'"),
        (
            {"runs": {"R1": (0, -7)}},
            "run 'R1' is planned outside the levels.*; found coded -7; needed",
        ),
        (
            {"responses": ("hysteresis_energy", "loss_factor", "hysteresis_energy")},
            "a response is listed twice; found hysteresis_energy, loss_factor, hysteresis_energy",
        ),
        (
            {"responses": ("loss_factor",), "transform": {"relaxation_time": "log"}},
            "a transform is stated for a response that is not requested; found relaxation_time; needed",
        ),
        ({"factors": {"frequency": ("1 Hz", "x")}}, "experiment 'nylon': a value is not a number"),
    ],
)
def test_what_does_not_fit_the_campaign_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        plan(**changed)


def test_a_share_of_a_break_strength_that_is_not_stated_is_refused():
    tests = TESTS | {"R1": plan_of("R1", specimens=("line", "bare"))}
    section = ExperimentSection(kind="box-behnken", factors=LOADS, runs={"R1": (0, 0)})
    with pytest.raises(SettingsError, match="found no rated_break_strength of bare; needed"):
        plan_experiment(Path("campaign.toml"), "nylon", section, tests=tests, specimens=SPECIMENS)


def test_the_campaign_of_the_synthetic_line_is_the_design_that_it_says():
    found = load_campaign(CAMPAIGN).experiments["nylon"]
    edges = {run for run in found.runs.values() if any(run)}
    assert len(found.runs) == 15
    assert len(edges) == 12
    assert all(sorted(map(abs, run)) == [0, 1, 1] for run in edges)


def agree(first, second):
    tests = TESTS | {"Q2": plan_of("Q2", "quasi-static")}
    both = {
        name: plan_experiment(
            Path("campaign.toml"), name,
            ExperimentSection(**({"kind": "box-behnken", "factors": LOADS} | section)),
            tests=tests, specimens=SPECIMENS,
        )
        for name, section in (("one", first), ("two", second))
    }  # fmt: skip
    agree_on_pulls(Path("campaign.toml"), both, tests)


def test_a_run_of_two_experiments_has_one_slow_pull():
    of_q = {"runs": {"R1": (0, 0), "R2": (1, 0)}, "quasi_static": {"line": "Q"}}
    of_q2 = {"runs": {"R1": (0, 0), "P-7/dynamic 1": (1, 0)}, "quasi_static": {"line": "Q2"}}
    with pytest.raises(SettingsError, match="run 'R1' is in two.*; found Q in 'one', Q2 in 'two'"):
        agree(of_q, of_q2)
    with pytest.raises(SettingsError, match="found Q in 'one', none in 'two'; needed the same"):
        agree(of_q, of_q2 | {"quasi_static": {}})
    agree(of_q, of_q2 | {"quasi_static": {"line": "Q"}})
    # a pull for each experiment, where they share no run
    agree(of_q, of_q2 | {"runs": {"P-7/dynamic 1": (0, 0)}})


def test_an_experiment_that_needs_no_pull_shares_runs_with_one_that_does():
    of_q = {"runs": {"R1": (0, 0)}, "quasi_static": {"line": "Q"}}
    agree({"runs": {"R1": (0, 0)}, "responses": ("hysteresis_energy",)}, of_q)

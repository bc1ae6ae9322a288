"""What a check says of an experiment: minimum tensions by hand, logs that are copies."""

from pathlib import Path
from types import SimpleNamespace

import pytest

from reduction.batch.campaign_status import TestStatus
from reduction.batch.experiment_product import _same_logs, experiments_found
from reduction.batch.slow_pulls import pull_tests
from reduction.campaign.plan import Campaign, ExperimentPlan, TestPlan
from reduction.experiments.designs import FactorLevels
from reduction.readers.layout import Layout
from reduction.record.measurement import Specimen
from reduction.record.settings import ReductionSettings

MEAN = FactorLevels("mean_tension", 0.10, 0.30, "rated_break_strength")
AMPLITUDE = FactorLevels("tension_amplitude", 0.05, 0.15, "rated_break_strength")


def plan(factors=(MEAN, AMPLITUDE), pulls=None, **runs):
    return ExperimentPlan(
        name="lines", kind="box-behnken", factors=factors, runs=runs, quasi_static=pulls or {},
        responses=("apparent_spring_constant",), transform={}, specimens_as="blocks",
    )  # fmt: skip


def campaign(experiment, **specimens):
    tests = {
        run: TestPlan(
            id=run, kind="cyclic", files=(), specimens=pulled, order=None, control="load",
            waveform="sinusoidal", target_strain=(), attributes={}, settings=ReductionSettings(),
        )
        for run, pulled in specimens.items()
    }  # fmt: skip
    sheets = {
        "weak": Specimen("weak", kind="rope", rated_break_strength=1000.0),
        "strong": Specimen("strong", kind="rope", rated_break_strength=4000.0),
    }
    return Campaign(
        Path("campaign.toml"), "c", {}, sheets, {}, tests, {}, experiments={"lines": experiment}
    )


def status(test, failed=False):
    return TestStatus(test, "failed" if failed else "no_work", 0, "", 1, 1, f"sum of {test}", 0.0)


def test_a_run_of_two_lines_has_a_minimum_of_each():
    # 10 % less 15 %, of 1000 N and of 4000 N; 10 % less 10 % is zero though its last bit is not
    planned = plan(A=(-1.0, 1.0), B=(-1.0, 0.0), C=(1.0, 1.0))
    whole = campaign(planned, A=("weak", "strong"), B=("weak",), C=("weak",))
    (found,) = experiments_found(whole, [status("A"), status("B", failed=True)])
    least = {
        (row["run"], row["specimen"]): row["planned_minimum_tension"]["value"]
        for row in found["slack_runs"]
    }
    assert least == {
        ("A", "weak"): pytest.approx(-50.0),
        ("A", "strong"): pytest.approx(-200.0),
        ("B", "weak"): 0.0,
    }
    # C was not asked for: neither found nor failed
    assert (found["runs_found"], found["runs_failed"]) == (["A"], ["B"])
    assert found["notes"] == ["no slow pull of weak, strong: K_0, K_1 and tau are not given"]


def test_without_both_loads_nothing_is_said_of_slack():
    planned = plan(factors=(MEAN,), A=(-1.0,))
    assert experiments_found(campaign(planned, A=("weak",)), [])[0]["slack_runs"] == []


def test_pulls_are_those_of_the_experiments_that_a_run_is_in():
    planned = plan(pulls={"weak": "Q"}, A=(0.0, 0.0))
    whole = campaign(planned, A=("weak",))
    assert pull_tests(whole, "A") == {"weak": "Q"}
    assert pull_tests(whole, "B") == {}


def test_steps_of_one_log_are_no_copies():
    level = (0.0, 0.0)
    planned = plan(**{"P-7.one": level, "P-7.two": level, "P-8.one": level, "R": level, "S": level})
    sums = {"P-7.one": "a", "P-7.two": "a", "P-8.one": "b", "R": "b", "S": ""}
    channels = {"tension.1": {"column": "Force", "unit": "N"}}
    layouts = {
        name: Layout(format="spreadsheet", sheet=name, channels=channels) for name in ("I", "II")
    }

    def notes(sheet_of_r):
        sheets = {"P-7": "I", "P-8": "I", "R": sheet_of_r, "S": "I"}
        tests = {
            log: SimpleNamespace(log=log, files=(("logs.xlsx", sheet),))
            for log, sheet in sheets.items()
        }
        return _same_logs(SimpleNamespace(tests=tests, layouts=layouts), planned, sums)

    (note,) = map(str, notes("I"))
    assert note.startswith("P-8 and R have the same log, byte for byte")
    assert notes("II") == []  # two sheets of one workbook

"""The two passes over a campaign: which records are kept, and what becomes of lost tests."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from manytests import write_many

from reduction.batch import reduce_tests as secondpass
from reduction.batch import slow_pulls as pulls_module
from reduction.batch import survey as firstpass
from reduction.batch.campaign_status import Silent, TestStatus
from reduction.batch.experiment_product import _same_logs, experiments_found
from reduction.batch.reduce_tests import reduce_campaign
from reduction.batch.reuse import Basis
from reduction.batch.run_campaign import run_campaign
from reduction.batch.run_lock import RunLock, run_lock
from reduction.batch.slow_pulls import fit_pulls, pull_tests
from reduction.batch.survey import FirstPass, survey_campaign, survey_log, with_record
from reduction.batch.test_history import fit_strain_models
from reduction.batch.workers import _Ended, local_workers
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign, ExperimentPlan, TestPlan
from reduction.experiments.designs import FactorLevels
from reduction.readers.layout import Layout
from reduction.record.errors import ArchiveError, WorkerError
from reduction.record.measurement import Specimen
from reduction.record.settings import ReductionSettings


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    return load_campaign(write_many(tmp_path_factory.mktemp("many") / "raw", 4, n_cycles=4))


def lossy(lost):
    """Workers that die at one test."""

    def work_on(function, tasks, **options):
        for task in tasks:
            if task.test == lost:
                yield _Ended(task.test, None, WorkerError("lost with all hands"))
            else:
                yield _Ended(task.test, function(*task.arguments), worker="w:1")

    return work_on


class Told(Silent):
    """Keeps what it is told."""

    def __init__(self):
        self.words = []

    def stage(self, name, n_tests):
        self.words.append((name, n_tests))

    def begun(self, test):
        self.words.append(("begun", test))

    def ended(self, test, status=None):
        self.words.append(("ended", test, None if status is None else status.status))


def test_surveys_come_in_the_order_of_the_campaign_without_their_samples(campaign):
    first = survey_campaign(campaign)
    assert [one.plan.id for one in first.surveys] == ["T01", "T02.a", "T02.b", "T03", "T04"]
    assert all(one.located is None for one in first.surveys)
    assert list(first.kept) == ["T01", "T02", "T03", "T04"]
    records = [one.located for one in first.kept["T02"]]
    assert len(records) == 2 and all(one is not None for one in records)
    assert "no number" in str(first.surveys[3].error)


def test_records_beyond_the_bound_are_not_kept(campaign, monkeypatch):
    n_rows = survey_campaign(campaign).surveys[0].n_rows
    monkeypatch.setattr(firstpass, "KEPT_SAMPLES", n_rows)
    assert list(survey_campaign(campaign).kept) == ["T01"]


def test_long_records_are_not_sent_between_processes(campaign, monkeypatch):
    def records(is_elsewhere):
        return [
            one.located is not None
            for one in firstpass._survey(*given, is_elsewhere, is_followed=False)
        ]

    given = firstpass.with_one_log(campaign, "T02"), "T02", None
    assert records(is_elsewhere=True) == [True, True]
    monkeypatch.setattr(firstpass, "SENT_SAMPLES", 10)
    assert records(is_elsewhere=True) == [False, False]
    assert records(is_elsewhere=False) == [True, True]


def test_surveys_of_workers_are_those_of_this_process(campaign):
    with local_workers(2) as workers:
        first = survey_campaign(campaign, workers=workers)
    assert sorted(first.kept) == ["T01", "T02", "T03", "T04"]
    assert all(one.located is None for one in first.surveys)
    here = survey_campaign(campaign)
    assert [(one.plan.id, one.n_rows, one.n_cycles, one.sources) for one in first.surveys] == [
        (one.plan.id, one.n_rows, one.n_cycles, one.sources) for one in here.surveys
    ]
    assert [str(one.error) for one in first.surveys] == [str(one.error) for one in here.surveys]


def test_a_record_of_another_file_is_not_taken(campaign):
    first = survey_campaign(campaign)
    survey, kept = first.surveys[0], first.kept["T01"]
    assert with_record(survey, kept).located is kept[0].located
    assert with_record(survey, None) is survey
    changed = replace(survey, sources=(replace(survey.sources[0], sha256="0" * 64),))
    assert with_record(changed, kept) is changed


def test_progress_hears_of_each_log_as_it_begins_and_ends(campaign):
    progress = Told()
    survey_campaign(campaign, progress=progress)
    assert progress.words[:3] == [("survey", 4), ("begun", "T01"), ("ended", "T01", None)]
    assert progress.words[-1] == ("ended", "T04", None)


def test_a_test_that_is_lost_in_the_first_pass_has_an_error(campaign, monkeypatch):
    monkeypatch.setattr(firstpass, "work_on", lossy("T01"))
    first = survey_campaign(campaign)
    assert str(first.surveys[0].error) == "lost with all hands"
    assert first.surveys[1].error is None


def test_a_slow_pull_that_is_lost_is_an_error_of_its_test(campaign, monkeypatch):
    plan = type("Plan", (), {"quasi_static": {"one": "T01"}})
    asking = replace(campaign, experiments={"e": plan})
    first = survey_campaign(campaign)
    models, _ = fit_strain_models(campaign, first.surveys)
    monkeypatch.setattr(pulls_module, "work_on", lossy("T01"))
    pulls, errors = fit_pulls(asking, first, models, progress=Silent())
    assert pulls == {} and str(errors["T01"]) == "lost with all hands"


def reduced(campaign, folder, *, lock, progress=None, basis=None, errors=None):
    first = FirstPass(survey_campaign(campaign).surveys)
    return reduce_campaign(
        campaign, first, first.surveys, errors=errors or {}, folder=folder, workers=None,
        basis=basis or (lambda survey: Basis(None, (), None, (), "{}", ())),
        lock=lock, progress=progress or Silent(), clock=lambda: 7.0, force=True, command="",
    )  # fmt: skip


def test_a_test_that_is_lost_in_the_second_pass_is_a_failed_row(campaign, tmp_path, monkeypatch):
    monkeypatch.setattr(secondpass, "_bring_up_to_date", lambda *a, **b: ("reduced", "well", None))
    monkeypatch.setattr(secondpass, "work_on", lossy("T02.b"))
    progress = Told()
    with run_lock(tmp_path) as lock:
        rows = reduced(campaign, tmp_path, lock=lock, progress=progress)
    assert [(row.test, row.status, row.worker) for row in rows] == [
        ("T01", "reduced", "w:1"),
        ("T02.a", "reduced", "w:1"),
        ("T02.b", "failed", ""),
        ("T03", "failed", ""),
        ("T04", "reduced", "w:1"),
    ]
    assert rows[2].message.endswith("lost with all hands") and rows[2].exit_status == 1
    assert progress.words[0] == ("reduce", 5)
    assert ("ended", "T02.b", "failed") in progress.words


def test_a_defect_in_what_one_test_rests_on_fails_that_test_alone(campaign, tmp_path, monkeypatch):
    monkeypatch.setattr(secondpass, "_bring_up_to_date", lambda *a, **b: ("reduced", "well", None))

    def basis(survey):
        if survey.plan.id == "T04":
            raise KeyError("no such thing")
        return Basis(None, (), None, (), "{}", ())

    with run_lock(tmp_path) as lock:
        rows = reduced(campaign, tmp_path, lock=lock, basis=basis)
    assert [row.status for row in rows] == ["reduced"] * 3 + ["failed"] * 2
    assert "internal error, a defect of this program: KeyError" in rows[-1].message


def test_nothing_is_begun_without_the_lock(campaign, tmp_path):
    lost = RunLock(tmp_path / "run.lock", "token")
    with pytest.raises(ArchiveError, match="is no longer the lock of this run"):
        survey_campaign(campaign, lock=lost)
    with pytest.raises(ArchiveError, match="is no longer the lock of this run"):
        reduced(campaign, tmp_path, lock=lost)


def test_nothing_is_written_where_the_lock_went_while_a_test_was_reduced(
    campaign, tmp_path, monkeypatch
):
    """What is left of a run that was ended reduces to its end, and keeps it to itself."""
    lock = RunLock(tmp_path / "run.lock", "token")
    monkeypatch.setattr(secondpass.RunLock, "confirm", lambda self: None)
    whole = secondpass._bring_up_to_date

    def slow(*arguments, before_writing, **options):
        monkeypatch.undo()
        return whole(*arguments, before_writing=lock.confirm, **options)

    monkeypatch.setattr(secondpass, "_bring_up_to_date", slow)
    first = survey_campaign(campaign)
    models, _ = fit_strain_models(campaign, first.surveys)
    rows = reduce_campaign(
        campaign, first, first.surveys[:1], errors={}, folder=tmp_path, workers=None,
        basis=lambda survey: Basis(None, (models["T01", "one"],), None, (), "{}", ()),
        lock=lock, progress=Silent(), clock=lambda: 7.0, force=True, command="",
    )  # fmt: skip
    assert "is no longer the lock of this run" in rows[0].message
    assert list(tmp_path.iterdir()) == []


def test_a_log_with_a_name_that_no_disk_can_have_is_one_failed_test(campaign):
    name = "n" * 300
    plan = campaign.tests["T04"]
    files = tuple((name, layout) for _, layout in plan.files)
    tests = campaign.tests | {"T04": replace(plan, files=files)}
    found = {one.plan.id: one for one in survey_campaign(replace(campaign, tests=tests)).surveys}
    assert "the file cannot be read; found File name too long" in str(found["T04"].error)
    assert found["T01"].error is None


# A run of which no test could be reduced has a page all the same: it says so, and why


def run(campaign, folder):
    return run_campaign(
        load_campaign(campaign), processed=folder / "p", reports=folder / "r",
        clock=lambda: 0.0, command="reduction run campaign.toml",
    )  # fmt: skip


def test_where_every_test_failed_the_page_says_that_and_why(tmp_path):
    campaign = write_many(tmp_path / "raw", 1)
    (campaign.parent / "T01.csv").write_text("time_s,crosshead_ft,load_lb\n0,no number,1\n")
    page = tmp_path / "r" / "many" / "index.html"
    page.parent.mkdir(parents=True)
    page.write_text("of a run whose archives were taken away")
    found = run(campaign, tmp_path)
    assert found.exit_status == 3
    assert found.report == page
    text = page.read_text(encoding="utf-8")
    assert "T01" in text and "no number" in text and "Failures" in text
    # it had an empty table, "0 specimens", and spoke of sections that are not there
    assert "No test could be reduced, so there are no results." in text
    assert "in its section" not in text and "specimens</a>" not in text
    assert "Specimens before their first test" not in text
    assert found.tables == ()


# A pull whose machine set the displacement to zero under a preload (synthetic)

CAMPAIGN = """
[campaign]
id = "preload"
title = "Preload (synthetic)"
source = "synthetic"
[specimens.bar]
kind = "other"
area = "20 mm2"
gauge_length = "25 mm"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = {{ column = 1, unit = "s" }}
crosshead_position = {{ column = 2, unit = "mm", datum = "displacement", reference_length = "25 mm"{at} }}
tension.1 = {{ column = 3, unit = "N" }}
{strain}
[tests.T-1]
file = "log.csv"
layout = "log"
kind = "tensile"
specimens = ["bar"]
"""


def loads_told(tmp_path, tension, at="", strain=""):
    """What is said of the tension at displacement zero of a pull with that log."""
    travel = 0.01 * np.arange(tension.size)
    rows = np.column_stack([10 * travel, travel, tension, 100 * travel / 25])
    np.savetxt(tmp_path / "log.csv", rows, "%.5f", ",", header="t,x,F,e", comments="")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN.format(at=at, strain=strain))
    (survey,) = survey_log(load_campaign(tmp_path / "campaign.toml"), "T-1")
    return [str(one) for one in survey.located.record.notes if "displacement is first" in str(one)]


@pytest.mark.parametrize(
    ("at", "strain", "is_told"),
    [
        ("", "", True),
        (', reference_tension = "150 N"', "", False),
        ("", 'strain.1 = { column = 4, unit = "%" }', False),  # no strain rests on the length
    ],
)
def test_a_zero_under_preload_is_told_where_strain_rests_on_it(tmp_path, at, strain, is_told):
    told = loads_told(tmp_path, 150.0 + 30 * np.arange(60), at, strain)
    assert bool(told) == is_told
    assert all('state reference_tension = "150 N"' in one for one in told)


def test_one_noisy_reading_is_no_preload(tmp_path):
    """The first reading of a weak strip is 6 % of its greatest load, and within its noise."""
    noise = 1.5 * np.random.default_rng(1).standard_normal(400)
    assert loads_told(tmp_path, np.linspace(0, 50, 400) + noise - noise[0] + 3.0) == []
    (told,) = loads_told(tmp_path, np.linspace(0, 50, 400) - 15)  # a zero of the load cell
    assert "preload" not in told


# what a check says of an experiment: minimum tensions by hand, logs that are copies

MEAN = FactorLevels("mean_tension", 0.10, 0.30, "rated_break_strength")
AMPLITUDE = FactorLevels("tension_amplitude", 0.05, 0.15, "rated_break_strength")


def plan(factors=(MEAN, AMPLITUDE), pulls=None, **runs):
    return ExperimentPlan(
        name="lines", kind="box-behnken", factors=factors, runs=runs, quasi_static=pulls or {},
        responses=("apparent_spring_constant",), transform={}, specimens_as="blocks",
    )  # fmt: skip


def campaign_of_planned(experiment, **specimens):
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
    whole = campaign_of_planned(planned, A=("weak", "strong"), B=("weak",), C=("weak",))
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
    assert experiments_found(campaign_of_planned(planned, A=("weak",)), [])[0]["slack_runs"] == []


def test_pulls_are_those_of_the_experiments_that_a_run_is_in():
    planned = plan(pulls={"weak": "Q"}, A=(0.0, 0.0))
    whole = campaign_of_planned(planned, A=("weak",))
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

"""The two passes over a campaign: which records are kept, and what becomes of lost tests."""

from dataclasses import replace

import pytest
from manytests import write_many

from reduction.batch import reduce_tests as secondpass
from reduction.batch import slow_pulls as pulls_module
from reduction.batch import survey as firstpass
from reduction.batch.campaign_status import Silent
from reduction.batch.reduce_tests import reduce_campaign
from reduction.batch.reuse import Basis
from reduction.batch.run_lock import RunLock, run_lock
from reduction.batch.slow_pulls import fit_pulls
from reduction.batch.survey import FirstPass, survey_campaign, with_record
from reduction.batch.test_history import fit_strain_models
from reduction.batch.workers import _Ended, local_workers
from reduction.campaign.load import load_campaign
from reduction.record.errors import ArchiveError, WorkerError


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

"""A run stops where nothing changed, and only there."""

import hashlib
import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from reduction.batch import finished_run as module
from reduction.batch.campaign_status import CampaignResult, ShownAnswers, ShownTable, TestStatus
from reduction.batch.finished_run import finished_run, keep_finished
from reduction.cli.campaigns import _say_run
from reduction.cli.output import CommandOutput
from reduction.record.notes import note
from reduction.report.campaign_page import _withheld

CHOICES = {"units": "si", "values_page": ""}
FILES = {
    "raw/campaign.toml": '[campaign]\nid = "one"\n',
    "raw/T-1.csv": "0,1\n",
    "p/one/T-1.nc": "not an archive",
    "p/one/status.csv": "of any run",
    "p/one/tables/cycles.csv": "test\r\n",
    "r/one/index.html": "<p>",
}


def result_of(folder: Path, *, exit_status: int = 0) -> CampaignResult:
    read = {
        name: hashlib.sha256((folder / "raw" / name).read_bytes()).hexdigest()
        for name in ("campaign.toml", "T-1.csv")
    }
    test = TestStatus("T-1", "reduced", exit_status, "", 1, 2, read["T-1.csv"], 3.5, {"gaps": 0})
    return CampaignResult(
        tests=(test,),
        parts={"hoses": []},
        processed=folder / "p" / "one",
        report=folder / "r" / "one" / "index.html",
        tables=(folder / "p" / "one" / "tables" / "cycles.csv",),
        read=read,
        answers=ShownAnswers(
            [ShownTable("of", ["a"], [True], [["1"]])],
            [("T-1", "odd")],
            ["T-1"],
            withheld={"T-2": "no hold found"},
        ),
    )


@pytest.fixture
def folder(tmp_path):
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    keep_finished(result_of(tmp_path), CHOICES)
    return tmp_path


def found_in(folder: Path, choices=CHOICES) -> CampaignResult | None:
    return finished_run(folder / "raw" / "campaign.toml", folder / "p", folder / "r", choices)


def test_what_a_run_did_is_given_again(folder):
    found, before = found_in(folder), result_of(folder)
    assert found.answers == before.answers
    assert [(one.test, one.status, one.found) for one in found.tests] == [
        ("T-1", "unchanged", {"gaps": 0})
    ]
    assert (found.processed, found.report) == (before.processed, before.report)
    assert found.tables == before.tables
    assert found.exit_status == 0


@pytest.mark.parametrize("name", [name for name in FILES if "status" not in name])
def test_a_file_that_changed_or_is_gone_has_the_campaign_run(folder, name):
    path = folder / name
    text = path.read_bytes()
    path.write_bytes(text + b" ")
    assert found_in(folder) is None
    path.unlink()
    assert found_in(folder) is None
    path.write_bytes(text)
    assert found_in(folder) is not None


@pytest.mark.parametrize("name", ["p/one/T-9.nc", "p/one/tables/odd.csv", "r/one/tests-01.html"])
def test_a_product_that_was_added_has_the_campaign_run(folder, name):
    (folder / name).write_bytes(b"")
    assert found_in(folder) is None


def test_another_version_and_other_units_have_the_campaign_run(folder, monkeypatch):
    assert found_in(folder, CHOICES | {"units": "us"}) is None
    monkeypatch.setattr(module, "__version__", "another")
    assert found_in(folder) is None


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"version": 1}'])
def test_a_file_that_says_nothing_has_the_campaign_run(folder, text):
    (folder / "p" / "one" / "finished-run.json").write_text(text, encoding="utf-8")
    assert found_in(folder) is None


def test_a_run_that_failed_is_not_kept(folder):
    keep_finished(result_of(folder, exit_status=4), CHOICES)
    assert not (folder / "p" / "one" / "finished-run.json").exists()


def test_what_is_kept_names_no_place_and_no_time(folder):
    text = (folder / "p" / "one" / "finished-run.json").read_text(encoding="utf-8")
    assert str(folder) not in text
    assert json.loads(text)["tests"][0]["seconds"] == 0.0


# A test without an answer says why, on the first screen of a run


def test_a_test_without_an_answer_shows_its_first_refusals():
    notes = (
        note(
            "no-hold",
            channel="the crosshead",
            tolerance=1e-5,
            slack_tension=0.02,
            duration=3.0,
            unit="m",
            key="position_tolerance",
        ),
        note("slack-strain-not-given", "cord", reason="the record does not return to slack"),
    )
    said = _withheld(SimpleNamespace(notes=notes))
    assert said.startswith("no hold found") and "; cord: slack strain" in said
    assert _withheld(SimpleNamespace(notes=())) == ""


def test_a_run_prints_why_a_test_has_no_answer(capsys):
    tests = tuple(
        TestStatus(name, "reduced", 0, text, 10, 0, "", 0.1)
        for name, text in (("T-1", ""), ("T-2", ""), ("T-3", "a warning"))
    )
    result = CampaignResult(
        tests=tests,
        parts={},
        processed=Path("p"),
        report=None,
        answers=ShownAnswers((), (), ("T-1",), withheld={"T-2": "no hold found", "T-3": "more"}),
    )
    _say_run(result, CommandOutput())
    shown = capsys.readouterr().out
    assert "no hold found" in shown and "a warning" in shown
    assert "T-1" not in shown and "more" not in shown

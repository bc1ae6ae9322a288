"""A test without an answer says why, on the first screen of a run."""

from pathlib import Path
from types import SimpleNamespace

from reduction.batch.campaign_status import CampaignResult, ShownAnswers, TestStatus
from reduction.cli.campaigns import _say_run
from reduction.cli.output import CommandOutput
from reduction.record.notes import note
from reduction.report.campaign_page import _withheld


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

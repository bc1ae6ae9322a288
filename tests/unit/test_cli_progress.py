"""What a person sees while a campaign runs."""

import io
from dataclasses import replace

import pytest
from rich.console import Console
from rich.progress import Progress

from reduction.batch.campaign_status import TestStatus
from reduction.cli.output import CommandOutput
from reduction.cli.progress import _CampaignProgress, campaign_progress


def row(test, status="reduced", worker=""):
    return TestStatus(test, status, 0, "", 10, 2, "", 1.26, worker=worker)


def test_each_test_has_a_line_with_its_number_time_and_worker(capsys):
    progress = _CampaignProgress()
    progress.stage("survey", 12)
    progress.begun("T-1")
    progress.ended("T-1")
    progress.stage("reduce", 12)
    progress.ended("T-1", row("T-1", worker="h:1"))
    progress.ended("T-2", row("T-2", "unchanged"))
    progress.begun("T-3")
    progress.ended("T-3", row("T-3"))
    assert capsys.readouterr().err.splitlines() == [
        " 1/12 T-1 reduced, 1.3 s, h:1",
        " 2/12 T-2 unchanged",
        " 3/12 T-3 reduced, 1.3 s",
    ]


def test_a_reason_ends_at_the_end_of_a_clause(capsys):
    said = "new: the splices slipped at cycle 599: from there on, and in later tests without marks"
    progress = _CampaignProgress()
    progress.stage("reduce", 1)
    progress.ended("T-1", replace(row("T-1", "check"), message=f"{said}, strain is 3.5 % off"))
    assert capsys.readouterr().err == (
        "1/1 T-1 check: new: the splices slipped at cycle 599, 1.3 s\n"
    )


@pytest.mark.parametrize("options", [{"json": True}, {"quiet": True}])
def test_nothing_is_said_where_nothing_is_wanted(options, capsys):
    with campaign_progress(CommandOutput(**options)) as progress:
        progress.stage("reduce", 1)
        progress.ended("T-1", row("T-1"))
    assert capsys.readouterr().err == ""


def test_a_terminal_has_a_bar_below_the_lines():
    text = io.StringIO()
    console = Console(file=text, force_terminal=True, width=80)
    with Progress(console=console, auto_refresh=False) as bar:
        progress = _CampaignProgress(bar)
        progress.stage("reduce", 3)
        progress.begun("[red]")
        task = bar.tasks[0]
        assert task.total == 3 and task.description == r"reducing \[red]"
        progress.ended("[red]", row("[red]"))
        assert task.completed == 1 and task.description == "reducing"
        progress.stage("tables", 0)
        assert bar.tasks[0].total is None
    assert "1/3 [red] reduced, 1.3 s" in text.getvalue()

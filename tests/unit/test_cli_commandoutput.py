"""Tables on a terminal: a number is never cut, however few columns there are."""

import io
import re
import sys
from dataclasses import replace

import pytest
from rich.console import Console
from rich.progress import Progress

from reduction.batch.campaign_status import TestStatus
from reduction.cli import main as module
from reduction.cli import output as output_module
from reduction.cli.output import NOTHING, CommandOutput, plain_table
from reduction.cli.printed_numbers import table_of
from reduction.cli.progress import _CampaignProgress, campaign_progress

CELLS = ["a long name of a line", "1.2345e+05", "-9.8765e-12", "1.5e+05 to 1.6e+05"]


def table(n_numbers):
    heads = [f"number\n{place} [N]" for place in range(n_numbers)]
    made = table_of("name", *heads)
    for _ in range(2):
        made.add_row(CELLS[0], *(CELLS[1 + place % 3] for place in range(n_numbers)))
    return made


@pytest.mark.parametrize(
    ("is_terminal", "shown"), [(True, ["160 000", "278 900 to 283 100"]), (False, ["160000", "278900 to 283100"])]
)  # fmt: skip
def test_thousands_are_parted_for_eyes_and_not_in_a_pipe(capsys, monkeypatch, is_terminal, shown):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    monkeypatch.setenv("COLUMNS", "80")
    made = table_of("file", "load\n[N]", "95 %\n[N]")
    made.add_row("123456.csv", "160000", "278900 to 283100")
    CommandOutput().show(made)
    row = capsys.readouterr().out.splitlines()[-1].strip()
    assert re.split(r"\s{2,}", row) == ["123456.csv", *shown]


@pytest.mark.parametrize("n_numbers", [1, 3, 6, 14])
@pytest.mark.parametrize("width", [40, 80, 100])
@pytest.mark.parametrize("is_terminal", [True, False])
def test_no_digit_is_lost(capsys, monkeypatch, n_numbers, width, is_terminal):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    monkeypatch.setenv("COLUMNS", str(width))
    CommandOutput().show(table(n_numbers))
    text = re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out)
    assert "\N{HORIZONTAL ELLIPSIS}" not in text
    for cell in CELLS[1 : 1 + n_numbers]:
        assert len(re.findall(re.escape(cell), text)) >= 2
    if is_terminal and "number 0 [N]" not in text:
        # not row by row: as wide as the terminal at most
        assert max(map(len, text.splitlines())) <= width


def test_row_by_row_each_cell_has_its_heading(capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr(output_module, "Console", lambda **_: Console(width=40, highlight=False))
    CommandOutput().show(table(3))
    lines = [line.rstrip() for line in capsys.readouterr().out.splitlines()]
    block = [
        "name          a long name of a line",
        "number 0 [N]  1.2345e+05",
        "number 1 [N]  -9.8765e-12",
        "number 2 [N]  1.5e+05 to 1.6e+05",
    ]
    assert lines == [*block, "", *block]


def test_nothing_is_shown_where_no_text_is_said(capsys):
    for silent in (CommandOutput(quiet=True), CommandOutput(json=True)):
        silent.show(table(1))
        assert not silent.is_text
    assert capsys.readouterr().out == ""


MESSAGE = "a message of several words that is longer than what is left of eighty columns"


def messages():
    made = table_of("test", "status", "number", texts=2)
    made.columns[2].justify, made.columns[2].no_wrap = "right", True
    made.add_column("message")
    made.add_row("T-1", "check", "1.2345e+05", MESSAGE)
    made.add_row("T-2", "reduced", "1", "")
    return made


@pytest.mark.parametrize("width", [30, 60, 80, 200])
def test_a_long_message_is_whole_at_any_width(capsys, monkeypatch, width):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr(output_module, "Console", lambda **_: Console(width=width, highlight=False))
    CommandOutput().show(messages())
    said = re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out)
    assert max(map(len, said.splitlines())) <= width
    assert MESSAGE in " ".join(said.split())


def test_headings_of_two_lines_count_whole_where_they_would_stand_on_one(capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setattr(output_module, "Console", lambda **_: Console(width=80, highlight=False))
    made = table_of("name", *(f"a long heading\nof number {place} [N]" for place in range(3)))
    made.add_column("message")
    made.add_row("T-1", "1", "2", "3", MESSAGE)
    CommandOutput().show(made)
    text = re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out)
    assert max(map(len, text.splitlines())) <= 80


def test_a_pipe_has_one_line_a_row_and_no_markup(capsys):
    made = table_of("name", "number", texts=1, title="[bold]title[/]")
    made.add_row(r"\[red]a name", "1")
    made.add_row("", "2")
    made.add_row(MESSAGE * 5, "3")
    CommandOutput().show(made)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "title"
    assert [line.split()[-1] for line in lines[1:]] == ["number", "1", "2", "3"]
    assert lines[2].startswith("[red]a name ") and lines[3].startswith("- ")
    assert lines[4].startswith(MESSAGE * 5)


def test_a_pipe_has_no_escape_codes_even_where_colour_is_forced(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    CommandOutput().show(table(3))
    assert "\x1b" not in capsys.readouterr().out


# tables for a pipe: every row one line, every column where a program finds it


def test_columns_stand_at_the_same_places_in_every_line():
    text = plain_table(
        ["name", "load [N]"],
        [["a", "a longer name"], ["1.5", "-1.25e+05"]],
        is_number=[False, True],
    )
    assert text.splitlines() == [
        "name            load [N]",
        "a                    1.5",
        "a longer name  -1.25e+05",
    ]


@pytest.mark.parametrize("cell", ["two  spaces", "two\nlines", "a\ttab", "\x0b", "", "   "])
def test_no_cell_looks_like_the_space_between_two(cell):
    text = plain_table(["a", "b", "c"], [["x"], [cell], ["y"]], is_number=[False] * 3)
    for line in text.splitlines():
        assert len([one for one in line.split("  ") if one.strip()]) == 3


def test_an_empty_cell_has_a_mark():
    assert plain_table(["a", "b"], [["x"], [""]], is_number=[False, False]).split()[-1] == NOTHING


def test_letters_that_are_two_columns_wide_count_as_two():
    rows = plain_table(
        ["a", "b"], [["張力", "ab"], ["1", "2"]], is_number=[False, False]
    ).splitlines()
    assert rows[1] == "張力  1" and rows[2] == "ab    2"


def test_nothing_is_cut_however_long():
    long = "word " * 500
    text = plain_table(["a", "b"], [["x"], [long]], is_number=[False, False])
    assert long.strip() in text and len(text.splitlines()) == 2


def test_an_interrupt_before_a_command_has_begun_ends_in_words(monkeypatch, capsys):
    def interrupted(*words, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(module.Commands, "main", interrupted)
    with pytest.raises(SystemExit) as ended:
        module.app(["run", "campaign.toml"])
    assert ended.value.code == 130
    assert capsys.readouterr().err == "interrupted\n"


# what a person sees while a campaign runs


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

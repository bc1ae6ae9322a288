"""Tables on a terminal: a number is never cut, however few columns there are."""

import re
import sys

import pytest
from rich.console import Console

from reduction.cli import output as output_module
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import table_of

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

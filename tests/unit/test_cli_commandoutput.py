"""Tables on a terminal: a number is never cut, however few columns there are."""

import re
import sys

import pytest
from rich.console import Console

from reduction.cli import commandoutput as output_module
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import table_of

CELLS = ["a long name of a line", "1.2345e+05", "-9.8765e-12", "1.5e+05 to 1.6e+05"]


def table(n_numbers):
    heads = [f"number\n{place} [N]" for place in range(n_numbers)]
    made = table_of("name", *heads)
    for _ in range(2):
        made.add_row(CELLS[0], *(CELLS[1 + place % 3] for place in range(n_numbers)))
    return made


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
    monkeypatch.setattr(output_module, "Console", lambda **_: Console(width=30, highlight=False))
    CommandOutput().show(table(3))
    blocks = capsys.readouterr().out.strip().split("\n\n")
    assert len(blocks) == 2
    assert blocks[0].splitlines() == [
        "name          a long name of a line",
        "number 0 [N]  1.2345e+05",
        "number 1 [N]  -9.8765e-12",
        "number 2 [N]  1.5e+05 to 1.6e+05",
    ]


def test_nothing_is_shown_where_no_text_is_said(capsys):
    for silent in (CommandOutput(quiet=True), CommandOutput(json=True)):
        silent.show(table(1))
        assert not silent.is_text
    assert capsys.readouterr().out == ""

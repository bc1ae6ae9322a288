"""Prints the output of a command: text, tables, one JSON object, or nothing."""

from __future__ import annotations

import json as json_module
import os
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TextIO, cast

import typer
from rich.cells import cell_len
from rich.console import Console
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from reduction.cli.usage import grouped
from reduction.readers.remote_files import in_words
from reduction.record.errors import ReductionError, SettingsError, refused_by_system
from reduction.record.plain_text import visible, without_secrets

if TYPE_CHECKING:  # help is printed without importing the units
    from reduction.quantities.units import UnitSystem

NOTHING = "-"
"""Text of an empty cell, so that every line has the same number of columns."""


def plain_table(
    heads: Sequence[str], columns: Sequence[Sequence[str]], *, is_number: Sequence[bool]
) -> str:
    """Return a heading and rows as text, with at least two spaces between columns.

    Examples
    --------
    >>> print(plain_table(["test", "cycles"], [["T-1", "T-10"], ["10", ""]],
    ...     is_number=[False, True]))
    test  cycles
    T-1       10
    T-10       -
    """
    padded = []
    for head, column, is_right in zip(heads, columns, is_number, strict=True):
        # single spaces inside cells, unlike the gaps between columns
        cells = [" ".join(cell.split()) or NOTHING for cell in (head, *column)]
        widths = [len(cell) if cell.isascii() else cell_len(cell) for cell in cells]
        size = max(widths)
        spaces = [" " * (size - width) for width in widths]
        padded.append(
            [
                space + cell if is_right else cell + space
                for cell, space in zip(cells, spaces, strict=True)
            ]
        )
    return "\n".join("  ".join(row).rstrip() for row in zip(*padded, strict=True))


INTERRUPTED = 130

_LEAST_WORDS = 20


@dataclass
class CommandOutput:
    """Output channel of one command; ``status`` is its exit status."""

    json: bool = False
    quiet: bool = False
    units: str = "si"
    status: int = 0
    answered: bool = False
    names: dict[str, str] = field(default_factory=dict)
    """Remote addresses by the paths of their copies, which replace these in all output."""

    def say(self, text: str, *, is_verbatim: bool = False) -> None:
        """Print a line on standard output, except with JSON or no output."""
        if self.json or self.quiet:
            return
        said = visible(in_words(text, self.names))
        typer.echo(said if is_verbatim else _between_words(said, sys.stdout))

    @property
    def is_text(self) -> bool:
        """Whether text is printed: neither JSON nor no output was requested."""
        return not (self.json or self.quiet)

    def show(self, table: Table) -> None:
        """Print a table on standard output if text is printed, with all digits of its numbers."""
        if not self.is_text:
            return
        table = _changed(table, lambda cell, _: visible(in_words(cell, self.names)))
        if not sys.stdout.isatty():
            typer.echo(_line_by_line(table))
            return
        # only on a terminal: programs that read a pipe do not expect blanks in numbers
        table = _changed(table, lambda cell, is_right: grouped(cell) if is_right else cell)
        console = Console(highlight=False)
        has_room = _least_width(table, console) <= console.width
        console.print(table if has_room else _row_by_row(table))

    @property
    def system(self) -> UnitSystem:
        """Unit system for display."""
        return cast("UnitSystem", self.units)

    def unit(self, si_unit: str) -> tuple[str, float]:
        """Display unit, and the factor to it from SI."""
        from reduction.quantities.units import display_unit

        return display_unit(si_unit, self.system)

    def say_each(self, what: str, texts: Iterable[object]) -> None:
        """Print several lines of one kind, such as notes or sources."""
        for text in texts:
            self.say(f"{what}: {text}")

    def answer(self, document: object) -> None:
        """Print the JSON object of ``--json``, then the only text on standard output."""
        if self.json:
            # a path in JSON has doubled backslashes
            names = {json_module.dumps(path)[1:-1]: name for path, name in self.names.items()}
            text = json_module.dumps(document, indent=2, allow_nan=False)
            typer.echo(in_words(text, names))
            self.answered = True

    def error(self, text: str) -> None:
        """Print an error on standard error."""
        said = visible(without_secrets(in_words(text, self.names)))
        typer.echo(_between_words(said, sys.stderr), err=True)

    def defect(self, error: Exception) -> None:
        """Print an error that is a defect of this program."""
        self.error(
            f"internal error, a defect of this program: {type(error).__name__}: {error}. "
            "Set REDUCTION_DEBUG=1 to see where, and please report it."
        )

    def raise_status(self, status: int) -> None:
        """Keep the highest status so far."""
        self.status = max(self.status, status)


def _changed(table: Table, change: Callable[[str, bool], str]) -> Table:
    """A table with changed texts, by cell and by whether it is right-aligned."""
    said = copy(table)
    said.columns = [column.copy() for column in table.columns]
    said.rows = []
    is_right = [column.justify == "right" for column in table.columns]
    for row in zip(*(column.cells for column in table.columns), strict=True):
        pairs = zip(row, is_right, strict=True)
        said.add_row(*(change(cell, at) if isinstance(cell, str) else cell for cell, at in pairs))
    return said


def _between_words(text: str, stream: TextIO) -> str:
    """Break lines between words where a terminal would break them inside a word."""
    if not stream.isatty():
        return text
    width = Console(file=stream).width
    lines = []
    for line in text.split("\n"):
        if cell_len(line) <= width:
            lines.append(line)
            continue
        margin = line[: len(line) - len(line.lstrip())] + "  "
        lines += textwrap.wrap(
            line, width, subsequent_indent=margin, break_long_words=False, break_on_hyphens=False,
            replace_whitespace=False,
        )  # fmt: skip
    return "\n".join(lines)


def _least_width(table: Table, console: Console) -> int:
    """Width at which no number is cut, with at most twenty columns for words."""
    options = console.options.update(max_width=10_000)
    total = 0
    for column in table.columns:
        sizes = [Measurement.get(console, options, cell) for cell in (column.header, *column.cells)]
        if column.no_wrap:
            total += max(size.maximum for size in sizes)
        else:
            least = max(_LEAST_WORDS, column.min_width or 0)
            total += min(least, max(size.maximum for size in sizes))
    return total + 2 * len(table.columns)


def _words(cell: object) -> str:
    """A cell without markup, on one line."""
    return " ".join(Text.from_markup(str(cell), emoji=False).plain.split())


def _line_by_line(table: Table) -> str:
    """A table for a pipe, below its title."""
    plain = plain_table(
        [_words(column.header) for column in table.columns],
        [[_words(cell) for cell in column.cells] for column in table.columns],
        is_number=[column.justify == "right" for column in table.columns],
    )
    return f"{_words(table.title)}\n{plain}" if table.title else plain


def _row_by_row(table: Table) -> Table:
    """A table with a heading and a cell per line, and empty lines between rows."""
    found = Table.grid(padding=(0, 2, 0, 0))
    found.title, found.title_style, found.title_justify = table.title, "bold", "left"
    heads = [" ".join(str(column.header).split()) for column in table.columns]
    for place, row in enumerate(zip(*(column.cells for column in table.columns), strict=True)):
        if place:
            found.add_row()
        for head, cell in zip(heads, row, strict=True):
            found.add_row(head, cell)
    return found


@contextmanager
def guarded(output: CommandOutput) -> Iterator[CommandOutput]:
    """Run a command body; convert every outcome to a message and an exit status."""
    try:
        if output.units not in ("si", "us"):
            raise SettingsError("--units is not known", found=repr(output.units), needed="si or us")
        yield output
    except ReductionError as error:
        _say_failure(output, error)
    except KeyboardInterrupt:
        output.error("interrupted; archives that were finished are kept")
        output.status = INTERRUPTED
    except BrokenPipeError:
        # the reader of the pipe has closed it: not our error, and no more can be printed
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        if error.errno is None:
            _end_of_defect(output, error)
        else:
            _say_failure(output, refused_by_system(error))
    except Exception as error:
        _end_of_defect(output, error)
    raise typer.Exit(output.status)


def _say_failure(output: CommandOutput, error: ReductionError) -> None:
    output.error(str(error))
    output.raise_status(error.exit_status)
    if not output.answered:
        failed = {"tests": [], "error": str(error), "exit_status": error.exit_status}
        output.answer(failed)


def _end_of_defect(output: CommandOutput, error: Exception) -> None:
    if os.environ.get("REDUCTION_DEBUG"):
        raise error
    output.defect(error)
    output.raise_status(1)

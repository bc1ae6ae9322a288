"""What a command says and how it ends: text, one JSON object, or nothing; and a status.

Errors go to standard error in one form and never as a traceback; a defect of the
package is status 1 and asks for a report.
"""

from __future__ import annotations

import json as json_module
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import typer
from rich.console import Console
from rich.table import Table

from reduction.errors import ReductionError, SettingsError

__all__ = ["Outcome", "guarded"]

INTERRUPTED = 130


@dataclass
class Outcome:
    """How one command talks; ``status`` is what it exits with."""

    json: bool = False
    quiet: bool = False
    units: str = "si"
    status: int = 0
    answered: bool = False

    def say(self, text: str) -> None:
        """One line of text on standard output, unless JSON or nothing was asked for."""
        if not (self.json or self.quiet):
            typer.echo(text)

    def show(self, table: Table) -> None:
        """A table on standard output, where text is said; 160 columns where no terminal is."""
        if not (self.json or self.quiet):
            width = None if sys.stdout.isatty() else 160
            Console(width=width, highlight=False).print(table)

    def answer(self, document: object) -> None:
        """The JSON object of ``--json``; the only thing on standard output then."""
        if self.json:
            typer.echo(json_module.dumps(document, indent=2, allow_nan=False))
            self.answered = True

    def error(self, text: str) -> None:
        """One error on standard error."""
        typer.echo(text, err=True)

    def raise_status(self, status: int) -> None:
        """Keep the highest status seen."""
        self.status = max(self.status, status)


@contextmanager
def guarded(outcome: Outcome) -> Iterator[Outcome]:
    """Run a command body; turn every ending into a message and an exit status."""
    try:
        if outcome.units not in ("si", "us"):
            raise SettingsError(
                "--units is not known", found=repr(outcome.units), needed="si or us"
            )
        yield outcome
    except ReductionError as error:
        outcome.error(str(error))
        outcome.raise_status(error.exit_status)
        if not outcome.answered:
            failed = {"tests": [], "error": str(error), "exit_status": error.exit_status}
            outcome.answer(failed)
    except KeyboardInterrupt:
        outcome.error("interrupted; products that were finished are kept")
        outcome.status = INTERRUPTED
    except BrokenPipeError:
        # the reader of a pipe went away: not an error of ours, and nothing more can be said
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except Exception as error:
        if os.environ.get("REDUCTION_DEBUG"):
            raise
        outcome.error(
            f"internal error, a defect of this program: {type(error).__name__}: {error}. "
            "Set REDUCTION_DEBUG=1 to see where, and please report it."
        )
        outcome.raise_status(1)
    raise typer.Exit(outcome.status)

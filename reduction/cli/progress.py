"""Prints the progress of a campaign on standard error."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.progress import (
    BarColumn,  # fmt: skip
    MofNCompleteColumn,  # fmt: skip
    Progress,  # fmt: skip
    Task,  # fmt: skip
    TaskID,  # fmt: skip
    TextColumn,  # fmt: skip
    TimeElapsedColumn,  # fmt: skip
)
from rich.text import Text

from reduction.batch.campaign_status import TestStatus
from reduction.cli.output import CommandOutput
from reduction.record.notes import first_clauses

_WORDS = {
    "survey": "reading", "reduce": "reducing", "tables": "writing tables",
    "report": "writing the report",
}  # fmt: skip
"""Descriptions of the stages of a run."""

_MOST_LETTERS = 100  # of the clauses beside the status of a test


class _Count(MofNCompleteColumn):
    """Count out of a total; empty if the total is unknown."""

    def render(self, task: Task) -> Text:
        """Text of the column."""
        return Text() if task.total is None else super().render(task)


class _CampaignProgress:
    """Prints the progress of a campaign."""

    def __init__(self, bar: Progress | None = None, *, is_quiet: bool = False) -> None:
        self._bar = bar
        self._is_quiet = is_quiet
        self._task: TaskID | None = None
        self._stage, self._done, self._total = "", 0, 0
        self._running = ""

    def stage(self, name: str, n_tests: int) -> None:
        """Start a stage."""
        self._stage, self._done, self._total = name, 0, n_tests
        self._running = ""
        if self._bar is not None:
            if self._task is not None:
                self._bar.remove_task(self._task)
            self._task = self._bar.add_task(self._words(), total=n_tests or None)
        self._show()

    def begun(self, test: str) -> None:
        """Start work on a test."""
        self._running = test
        self._show()

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """End work on a test; print a line if it has a status."""
        self._done += 1
        self._running = ""
        self._show()
        if status is None:
            return
        width = len(str(self._total))
        words = [f"{self._done:{width}}/{self._total} {test} {status.status}"]
        if status.message and not status.exit_status:  # an error is printed only once, at the end
            words[0] += f": {first_clauses(status.message, _MOST_LETTERS)}"
        if status.status != "unchanged":
            words.append(f"{status.seconds:.1f} s")
        if status.worker:
            words.append(status.worker)
        self._line(", ".join(words))

    def _words(self) -> str:
        return escape(f"{_WORDS.get(self._stage, self._stage)} {self._running}".rstrip())

    def _show(self) -> None:
        if self._bar is not None and self._task is not None:
            # refresh at once: a short stage would be over before the next refresh
            self._bar.update(
                self._task, description=self._words(), completed=self._done, refresh=True
            )

    def _line(self, text: str) -> None:
        if self._is_quiet:
            return
        if self._bar is None:
            sys.stderr.write(f"{text}\n")
            sys.stderr.flush()
        else:
            self._bar.console.print(text, markup=False, highlight=False)


@contextmanager
def campaign_progress(output: CommandOutput) -> Iterator[_CampaignProgress]:
    """Print lines on standard error, with a bar on a terminal; nothing if disabled."""
    if not output.is_text or not sys.stderr.isatty():
        yield _CampaignProgress(is_quiet=not output.is_text)
        return
    columns = (
        TextColumn("{task.description}"), BarColumn(), _Count(), TimeElapsedColumn(),
    )  # fmt: skip
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield _CampaignProgress(bar)

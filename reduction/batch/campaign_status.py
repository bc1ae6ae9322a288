"""Status of each test and each part of a campaign, and progress while it runs."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, Protocol, cast

from reduction.record.notes import Note, by_severity, full_note
from reduction.record.plain_text import bare_cell, safe_cell

Status = Literal["reduced", "check", "unchanged", "no_work", "failed"]


@dataclass(frozen=True)
class TestStatus:
    """What became of one test.

    Parameters
    ----------
    test : str
        Its id.
    status : Status
        ``no_work`` where the campaign asked for something else.
    exit_status : int
        As the command line defines it.
    message : str
        The error, or what could move an answer most.
    n_rows, n_cycles : int
        Rows of the log; whole cycles found.
    raw_sha256 : str
        Hashes of its raw files, parted by blanks.
    seconds : float
        Wall time; not part of any product.
    found : dict
        What `check` prints: rate, gaps, flags.
    worker : str
        Address of the worker that reduced it, where there are several.
    """

    __test__ = False  # a test of a tether, not of this software

    test: str
    status: Status
    exit_status: int
    message: str
    n_rows: int
    n_cycles: int
    raw_sha256: str
    seconds: float
    found: dict[str, Any] = field(default_factory=dict)
    worker: str = ""

    def document(self) -> dict[str, Any]:
        """The entry of ``tests`` in the JSON answer."""
        entry = asdict(self)
        entry["id"] = entry.pop("test")
        return entry


@dataclass(frozen=True)
class PartStatus:
    """What became of an experiment, a hose or a comparison.

    ``status`` is ``fitted``, ``predicted`` or ``compared``; ``check`` where something could move
    its answer; ``failed``; or ``no_work``.
    """

    id: str
    status: str
    exit_status: int
    message: str


_COLUMNS = ("test", "status", "exit_status", "message", "raw_sha256", "seconds")


def status_csv(rows: Sequence[TestStatus]) -> str:
    """Text of status.csv, one row per test."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(_COLUMNS)
    for row in rows:
        writer.writerow(
            [
                row.test,
                row.status,
                row.exit_status,
                safe_cell(row.message),
                row.raw_sha256,
                f"{row.seconds:.3f}",
            ]
        )
    return text.getvalue()


def read_status(path: Path) -> dict[str, TestStatus]:
    """Rows of an earlier status.csv by test; empty where there is none that can be read."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        return {
            row["test"]: TestStatus(
                test=row["test"],
                status=cast("Status", row["status"]),
                exit_status=int(row["exit_status"]),
                message=bare_cell(row["message"]),
                n_rows=0,
                n_cycles=0,
                raw_sha256=row["raw_sha256"],
                seconds=float(row["seconds"]),
            )
            for row in rows
        }
    except (OSError, KeyError, ValueError, TypeError):
        return {}  # it is made anew, from what this run did


@dataclass(frozen=True)
class ShownTable:
    """A table as it is printed: texts alone, ``number_columns`` flush right."""

    caption: str
    columns: Sequence[str]
    number_columns: Sequence[bool]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class ShownAnswers:
    """What a run shows first: tables of answers, doubts with their tests, tests with a row."""

    tables: Sequence[ShownTable]
    doubts: Sequence[tuple[str, str]]
    answered: Sequence[str]
    is_synthetic: bool = False


@dataclass(frozen=True)
class CampaignResult:
    """What a run did: one status a test and a part, and what it wrote.

    ``parts`` are those that are no tests: ``experiments``, ``hoses`` and ``comparisons``.
    ``superseded`` are archives of earlier runs that nothing in the campaign makes now, where they
    were put; ``stray`` those that stay, since a log could not be read.  ``results`` is what the
    table of results holds, ``read`` the SHA-256 of each file of the campaign that was read, by
    name.
    """

    tests: tuple[TestStatus, ...]
    parts: dict[str, list[PartStatus]]
    processed: Path
    report: Path | None
    results: dict[str, Any] | None = None
    stray: tuple[str, ...] = ()
    superseded: tuple[Path, ...] = ()
    tables: tuple[Path, ...] = ()
    read: Mapping[str, str] = field(default_factory=dict)
    answers: ShownAnswers = field(default_factory=lambda: ShownAnswers((), (), ()))

    @property
    def exit_status(self) -> int:
        """The highest seen."""
        seen = [test.exit_status for test in self.tests]
        seen += [one.exit_status for parts in self.parts.values() for one in parts]
        return max(seen, default=0)


def note_message(notes: Sequence[Note]) -> str:
    """The one thing that could move an answer most; nothing where there is none.

    What else is known stands in the archive, and in the report behind a fold.
    """
    doubts = [one for one in by_severity(notes) if one.severity == "warning"]
    return full_note(doubts[0].stage, str(doubts[0])) if doubts else ""


class Progress(Protocol):
    """One who is told how far a campaign is."""

    def stage(self, name: str, n_tests: int) -> None:
        """A stage begins that works on so many tests; none for tables and report."""
        ...

    def begun(self, test: str) -> None:
        """Work on a test began in this process."""
        ...

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Work on a test ended in this stage; with its status where nothing more comes."""
        ...


class Silent:
    """Nobody listens."""

    def stage(self, name: str, n_tests: int) -> None:
        """Nothing."""

    def begun(self, test: str) -> None:
        """Nothing."""

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Nothing."""

"""Status of each test and each part of a campaign, and progress during the run."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal, Protocol, cast

from reduction.record.plain_text import bare_cell, safe_cell

Status = Literal["reduced", "check", "unchanged", "no_work", "failed"]


@dataclass(frozen=True)
class TestStatus:
    """Result of one test.

    Parameters
    ----------
    test : str
        Id of the test.
    status : Status
        Status; ``no_work`` if the test was not requested.
    exit_status : int
        Exit status as on the command line.
    message : str
        The error, or the note with the largest effect on an answer.
    n_rows, n_cycles : int
        Number of log rows; number of complete cycles.
    raw_sha256 : str
        Hashes of its raw files, separated by blanks.
    seconds : float
        Wall time; not part of any product.
    found : dict
        Output of `check`: rate, gaps, flags.
    worker : str
        Address of the worker that reduced it, if there are several.
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
        """The entry in ``tests`` of the JSON answer."""
        entry = asdict(self)
        entry["id"] = entry.pop("test")
        return entry


@dataclass(frozen=True)
class PartStatus:
    """Result of an experiment, a hose or a comparison.

    ``status`` is ``fitted``, ``predicted`` or ``compared``; ``check`` if something may affect its
    answer; ``failed``; or ``no_work``.
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
    """Rows of an earlier status.csv by test; empty if it is missing or unreadable."""
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
        return {}  # it is written again from this run


@dataclass(frozen=True)
class ShownTable:
    """A table in printed form: texts only, ``number_columns`` right-aligned."""

    caption: str
    columns: Sequence[str]
    number_columns: Sequence[bool]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class ShownAnswers:
    """First output of a run: tables of answers, doubts with their tests, tests with a row.

    ``withheld`` has the reasons of tests without a row, or whose row lacks its answer, by test.
    """

    tables: Sequence[ShownTable]
    doubts: Sequence[tuple[str, str]]
    answered: Sequence[str]
    is_synthetic: bool = False
    withheld: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class CampaignResult:
    """Result of a run: the status of each test and part, and the files written.

    ``parts`` are ``experiments``, ``hoses`` and ``comparisons``, as opposed to tests.
    ``superseded`` are archives of earlier runs that the campaign no longer makes, at their new
    location; ``replaced`` is the other campaign of the same id whose results they were; ``stray``
    are those left in place because a log could not be read.  ``results`` is the content of the
    table of results, ``read`` the SHA-256 of each campaign file read, by name.
    """

    tests: tuple[TestStatus, ...]
    parts: dict[str, list[PartStatus]]
    processed: Path
    report: Path | None
    results: dict[str, Any] | None = None
    stray: tuple[str, ...] = ()
    superseded: tuple[Path, ...] = ()
    replaced: Path | None = None
    tables: tuple[Path, ...] = ()
    read: Mapping[str, str] = field(default_factory=dict)
    answers: ShownAnswers = field(default_factory=lambda: ShownAnswers((), (), ()))

    @property
    def exit_status(self) -> int:
        """The highest exit status of the tests and parts."""
        seen = [test.exit_status for test in self.tests]
        seen += [one.exit_status for parts in self.parts.values() for one in parts]
        return max(seen, default=0)


class Progress(Protocol):
    """Receiver of the progress of a campaign."""

    def stage(self, name: str, n_tests: int) -> None:
        """A stage starts with this number of tests; none for tables and report."""
        ...

    def begun(self, test: str) -> None:
        """Work on a test has started in this process."""
        ...

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Work on a test has ended in this stage; with its status if it is final."""
        ...


class Silent:
    """Ignores progress."""

    def stage(self, name: str, n_tests: int) -> None:
        """Do nothing."""

    def begun(self, test: str) -> None:
        """Do nothing."""

    def ended(self, test: str, status: TestStatus | None = None) -> None:
        """Do nothing."""

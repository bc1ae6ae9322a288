"""Status of each test and each part of a campaign, and progress while it runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, Protocol

from reduction.record.notes import Note, by_severity, full_note

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

"""Status of each test and each part of a campaign, and progress while it runs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, Protocol

from reduction.record.note_sentences import Severity
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
        The error, or the most serious note.
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

    ``status`` is ``fitted``, ``predicted`` or ``compared``, each also with ``_with_notes``;
    ``failed``; or ``no_work``.
    """

    id: str
    status: str
    exit_status: int
    message: str


_SERIOUS: tuple[Severity, ...] = ("warning", "refusal")


def note_message(notes: Sequence[Note]) -> str:
    """How many notes there are, how many of them are serious, and the most serious of all."""
    ranked = by_severity(notes)
    if not ranked:
        return ""
    kinds = Counter(one.severity for one in ranked)
    serious = [
        f"{kinds[kind]} {kind}{'s' if kinds[kind] > 1 else ''}" for kind in _SERIOUS if kinds[kind]
    ]
    among = f" ({', '.join(serious)})" if serious else ""
    count = f"{len(ranked)} note{'s' if len(ranked) > 1 else ''}"
    return f"{count}{among}; first: {full_note(ranked[0].stage, str(ranked[0]))}"


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

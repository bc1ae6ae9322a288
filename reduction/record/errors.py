"""Exceptions raised by this package, and the command-line exit status of each.

A message answers four questions, in this order: where (file, row, channel),
what was found, what is needed, and what to do.  The same facts are kept as
attributes, so that a batch report can tabulate them without parsing text.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

from reduction.record.plain_text import cut, visible, without_secrets


class ReductionError(Exception):
    """Base of every error this package raises on purpose.

    Parameters
    ----------
    problem : str
        One sentence that states the problem.
    found : str, optional
        The offending value, as read.
    needed : str, optional
        What would have been accepted.
    hint : str, optional
        The user's next step.
    **facts
        Numbers that explain the failure (points, degrees of freedom, ...).
    """

    exit_status: ClassVar[int] = 1

    def __init__(
        self,
        problem: str,
        *,
        found: str | None = None,
        needed: str | None = None,
        hint: str | None = None,
        **facts: float | int | str | bool,
    ) -> None:
        super().__init__(problem)
        self.problem = problem
        self.found = found
        self.needed = needed
        self.hint = hint
        self.facts = facts

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle every part of the error for another process."""
        return _made_again, (type(self), self.args, self.__dict__)

    def where(self) -> str:
        """Location of the fault, or an empty string if there is none."""
        return ""

    def __str__(self) -> str:
        """Compose the message from its parts, without passwords or queries in addresses.

        Text from a file is cut to readable length, without terminal control characters.
        """
        where, problem = _in_one_line(self.where()), visible(cut(self.problem))
        parts = [f"{where}: {problem}" if where else problem]
        if self.found is not None:
            parts.append(f"found {visible(cut(self.found))}")
        if self.needed is not None:
            parts.append(f"needed {visible(cut(self.needed))}")
        text = "; ".join(parts)
        return without_secrets(f"{text}. {self.hint}" if self.hint else text)


class SettingsError(ReductionError, ValueError):
    """A setting, specimen sheet or command-line option cannot be used."""

    exit_status = 2


class LogError(ReductionError, ValueError):
    """A raw log, or a row of it, cannot be read.

    Parameters
    ----------
    path : pathlib.Path or str
        The raw file, or the safe form of its address.
    row : int, optional
        Row as in a text editor: the first line of the file is row 1.
    channel : str, optional
        Column, by the name in the file's own header.
    """

    exit_status = 3

    def __init__(
        self,
        path: Path | str,
        problem: str,
        *,
        row: int | None = None,
        channel: str | None = None,
        found: str | None = None,
        needed: str | None = None,
        hint: str | None = None,
    ) -> None:
        super().__init__(problem, found=found, needed=needed, hint=hint)
        self.path = path
        self.row = row
        self.channel = channel

    def where(self) -> str:
        """``FILE:ROW [CHANNEL]``, the form editors can jump to."""
        row = "" if self.row is None else f":{self.row}"
        channel = "" if self.channel is None else f" [{self.channel}]"
        return f"{self.path}{row}{channel}"


class DataError(ReductionError, ValueError):
    """The file was read, but the values cannot support this step.

    If one row is at fault, the facts ``file`` (as named in the campaign), ``row`` and ``channel``
    identify it.
    """

    exit_status = 4

    def where(self) -> str:
        """``FILE:ROW [CHANNEL]`` if a single row is at fault."""
        if "row" not in self.facts:
            return ""
        return f"{self.facts['file']}:{self.facts['row']} [{self.facts['channel']}]"


class FitError(ReductionError, ArithmeticError):
    """A fit or a root search has no acceptable answer for sound input."""

    exit_status = 5


class ArchiveError(ReductionError, OSError):
    """An archive file cannot be written, read, or does not follow CF."""

    exit_status = 6


def refused_by_system(error: OSError) -> ArchiveError:
    """Convert an operating-system error that no stage has reported in its own words.

    Error with the file name, if the system states it.

    Examples
    --------
    >>> str(refused_by_system(PermissionError(13, "Permission denied", "processed/a/T-1.nc")))
    'processed/a/T-1.nc cannot be used; found Permission denied'
    """
    name = "a file" if error.filename is None else str(error.filename)
    return ArchiveError(f"{name} cannot be used", found=error.strerror or type(error).__name__)


class WorkerError(ReductionError, RuntimeError):
    """A worker process or the scheduler was lost; log and settings are not at fault."""


def _in_one_line(where: str) -> str:
    return visible(where).replace("\n", "\\n").replace("\t", "\\t")


def _made_again(
    kind: type[ReductionError], said: tuple[str, ...], parts: dict[str, Any]
) -> ReductionError:
    error = kind.__new__(kind)
    error.args = said
    error.__dict__.update(parts)
    return error

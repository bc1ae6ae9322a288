"""Every exception this package raises, and the exit status each one gives the command line.

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
        One sentence: what is wrong.
    found : str, optional
        The offending value, as it was read.
    needed : str, optional
        What would have been accepted.
    hint : str, optional
        What the user can do next.
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
        """Every part of the error goes with it to another process."""
        return _made_again, (type(self), self.args, self.__dict__)

    def where(self) -> str:
        """Place of the fault, or an empty string where there is none."""
        return ""

    def __str__(self) -> str:
        """Compose the message from its parts; no address in it keeps a password or a query.

        What came from a file is shown as far as a person reads it, and never steers a terminal.
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
        The raw file, or what may be shown of its address on the net.
    row : int, optional
        Row as a text editor counts it: the first line of the file is row 1.
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

    Where one row is at fault, the facts ``file`` (as the campaign names it), ``row`` and
    ``channel`` say which.
    """

    exit_status = 4

    def where(self) -> str:
        """``FILE:ROW [CHANNEL]`` where a row is at fault."""
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
    """Tell in words what the system refuses, where no stage has told it in its own.

    Parameters
    ----------
    error : OSError
        With a number of the system.

    Returns
    -------
    told : ArchiveError
        That names the file, as far as the system does.

    Examples
    --------
    >>> str(refused_by_system(PermissionError(13, "Permission denied", "processed/a/T-1.nc")))
    'processed/a/T-1.nc cannot be used; found Permission denied'
    """
    name = "a file" if error.filename is None else str(error.filename)
    return ArchiveError(f"{name} cannot be used", found=error.strerror or type(error).__name__)


class WorkerError(ReductionError, RuntimeError):
    """A worker process, or the scheduler of several, was lost: no fault of log or settings."""


def _in_one_line(where: str) -> str:
    return visible(where).replace("\n", "\\n").replace("\t", "\\t")


def _made_again(
    kind: type[ReductionError], said: tuple[str, ...], parts: dict[str, Any]
) -> ReductionError:
    error = kind.__new__(kind)
    error.args = said
    error.__dict__.update(parts)
    return error

"""What one log may be: a regular file, no larger and no slower to read than the limits say."""

from __future__ import annotations

import stat
import time
from pathlib import Path
from typing import Literal

from reduction.errors import LogError
from reduction.settings import Limits

_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
}
_DAMAGED = "It may be damaged: save it again with the program that wrote it. "
_Limit = Literal["file_size", "unpacked_size", "line_length", "columns", "time"]


def check_regular(path: Path, mode: int) -> None:
    """`LogError` where a path is no regular file: a pipe or a device may never end.

    Parameters
    ----------
    path : pathlib.Path
        For the message.
    mode : int
        As `os.stat` gives it, links followed.

    Raises
    ------
    LogError
        If it is anything else.
    """
    if not stat.S_ISREG(mode):
        raise LogError(
            path,
            "this is no file that can be read",
            found=_KINDS.get(stat.S_IFMT(mode), "something else"),
            needed="a regular file",
        )


class Watch:
    """Holds one log against the limits while it is read.

    Parameters
    ----------
    path : pathlib.Path
        The log.
    limits : Limits, optional
        What it may be; the defaults where left out.

    Examples
    --------
    >>> Watch(Path("log.csv"), Limits(columns=100)).check_columns(101, row=1)
    Traceback (most recent call last):
    reduction.errors.LogError: log.csv:1: the file has too many columns; found 101; needed 100 at \
most. If that is what was logged, raise columns under [limits] of campaign.toml.
    """

    def __init__(self, path: Path, limits: Limits | None = None) -> None:
        """Begin to count the time."""
        self.path = path
        self.limits = limits or Limits()
        self._begin = time.monotonic()

    def check_size(self, n_bytes: int) -> None:
        """`LogError` where the file has more bytes than ``file_size``."""
        if n_bytes > self.limits.file_size:
            raise self._beyond(
                "file_size", "the file is too large", f"{n_bytes:,} bytes",
                f"{self.limits.file_size:,} bytes at most",
            )  # fmt: skip

    def check_unpacked(self, n_bytes: int, what: str = "the file") -> None:
        """`LogError` where what a file unpacks to is more than ``unpacked_size``.

        Parameters
        ----------
        n_bytes : int
            What it states, or what has come out of it so far.
        what : str
            For the message: ``the workbook``, ``variable 'A'``.

        Raises
        ------
        LogError
            If it is more.
        """
        if n_bytes > self.limits.unpacked_size:
            raise self._beyond(
                "unpacked_size", f"{what} unpacks to more than the memory it may take",
                f"{n_bytes:,} bytes", f"{self.limits.unpacked_size:,} bytes at most",
            )  # fmt: skip

    def check_columns(self, n_columns: int, *, row: int | None = None) -> None:
        """`LogError` where there are more columns than ``columns``."""
        if n_columns > self.limits.columns:
            raise self._beyond(
                "columns", "the file has too many columns", f"{n_columns:,}",
                f"{self.limits.columns:,} at most", row=row,
            )  # fmt: skip

    def check_time(self) -> None:
        """`LogError` where reading has taken longer than ``time``; to be called between blocks."""
        seconds = time.monotonic() - self._begin
        if seconds > self.limits.time:
            raise self.too_slow(seconds)

    def too_slow(self, seconds: float) -> LogError:
        """Error of a file that took so long, and was not read."""
        return self._beyond(
            "time", "the file takes too long to read", f"{seconds:.3g} s so far",
            f"{self.limits.time:g} s at most",
        )  # fmt: skip

    def too_much_memory(self) -> LogError:
        """Error of a file whose reader was refused more memory."""
        return self._beyond(
            "unpacked_size", "the file takes more memory than it may", "more when it is read",
            f"{self.limits.unpacked_size:,} bytes at most", before=_DAMAGED,
        )  # fmt: skip

    def broken(self, found: str) -> LogError:
        """Error of a file that ended the process of its reader."""
        return self._beyond(
            "unpacked_size", "the library that reads this format broke at the file", found,
            f"an intact file that takes {self.limits.unpacked_size:,} bytes of memory at most",
            before=_DAMAGED,
        )  # fmt: skip

    def long_line(self, row: int) -> LogError:
        """Error of a line that is longer than ``line_length``."""
        return self._beyond(
            "line_length", "a line is too long to be a row of a log",
            f"more than {self.limits.line_length:,} bytes without a line end", "one line a row",
            row=row, before="Check the format and the encoding of the layout. ",
        )  # fmt: skip

    def _beyond(
        self,
        limit: _Limit,
        problem: str,
        found: str,
        needed: str,
        *,
        row: int | None = None,
        before: str = "",
    ) -> LogError:
        return LogError(
            self.path,
            problem,
            row=row,
            found=found,
            needed=needed,
            hint=f"{before}If that is what was logged, raise {limit} under [limits] of "
            "campaign.toml.",
        )

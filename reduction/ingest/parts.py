"""How much of a file is read at a time, and from which length on its columns lie on disk."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from reduction.samples.scratch import scratch_folder


@dataclass(frozen=True)
class Parts:
    """Parts of a raw file; no number depends on them.

    Parameters
    ----------
    in_memory : int
        Bytes of a text file, or of the columns of a binary one, up to which its columns stay
        in memory. [1]
    n_bytes : int
        Bytes of a part, of text or of columns; a shorter file is one part. [1]
    folder : pathlib.Path
        Where the scratch files of its columns lie.
    """

    in_memory: int = 32 << 20
    n_bytes: int = 16 << 20
    folder: Path = field(default_factory=scratch_folder)

    def folder_of(self, n_bytes: int) -> Path | None:
        """Where columns of a file of that length lie; None in memory."""
        return self.folder if n_bytes > self.in_memory else None

    def length_of(self, n_bytes: int) -> int:
        """Bytes of a part of a file of that length."""
        return max(min(self.n_bytes, n_bytes), 1)

"""What a check of products against their sources finds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

__all__ = ["Finding", "Kind", "Verification"]

Kind = Literal[
    "damaged",
    "changed",
    "misplaced",
    "raw_file",
    "settings",
    "missing",
    "stray",
    "table",
    "status",
    "unfinished",
    "not_compared",
]
"""What is wrong.

``damaged``: not as it was written, or not to be read. ``changed``: another program wrote it.
``misplaced``: the archive of another test or campaign under this name. ``raw_file``: a source that
is not as it was, or gone. ``settings``: the campaign would make it otherwise now. ``missing`` and
``stray``: a product that should be there, or should not. ``table`` and ``status``: not what the
archives give. ``unfinished``: what a run that is at work, or was killed, has left.
``not_compared``: what could not be looked at.
"""


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with one file; ``product`` is its name below the folder."""

    product: str
    kind: Kind
    problem: str
    found: str = ""
    needed: str = ""
    hint: str = ""

    def __str__(self) -> str:
        """All of it in one line, as errors are written."""
        parts = [f"{self.product}: {self.problem}"]
        parts += [f"found {self.found}"] if self.found else []
        parts += [f"needed {self.needed}"] if self.needed else []
        text = "; ".join(parts)
        return f"{text}. {self.hint}" if self.hint else text


@dataclass(frozen=True)
class Verification:
    """What was looked at in the folder of one campaign, and what is wrong there.

    ``remarks`` are what a reader should know and what is no fault.
    """

    campaign: str
    n_archives: int
    n_sources: int
    n_tables: int
    findings: tuple[Finding, ...]
    remarks: tuple[str, ...] = ()

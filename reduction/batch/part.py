"""What became of a part of a campaign that is not a test."""

from __future__ import annotations

from dataclasses import dataclass


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

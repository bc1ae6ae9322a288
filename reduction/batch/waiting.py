"""Runs of an experiment that a run of some tests left out, and that are not as they stand now."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path

from reduction.archive.open import reading
from reduction.batch.basis import Basis
from reduction.batch.standing import standing_product
from reduction.batch.survey import Survey
from reduction.errors import ArchiveError

__all__ = ["waiting_in_words", "waiting_runs"]

_MANY = 4  # runs that are named one by one
_NONE, _PULL, _OTHER = (
    "not reduced yet",
    "made with another slow pull than the one that stands now",
    "made from other logs, settings or software",
)


def waiting_runs(
    folder: Path, surveys: Sequence[Survey], basis_of: Callable[[Survey], Basis]
) -> dict[str, str]:
    """Why runs have to be reduced before their experiment is fitted.

    Parameters
    ----------
    folder : pathlib.Path
        Of the campaign's archives.
    surveys : sequence of Survey
        Tests that were not asked for, without an error.
    basis_of : callable
        What a test rests on now.

    Returns
    -------
    waiting : dict of str to str
        Reason by run; a run whose archive is what it would be made again is left out.
    """
    waiting = {}
    for survey in surveys:
        path = folder / f"{survey.plan.id}.nc"
        if not path.exists():
            waiting[survey.plan.id] = _NONE
            continue
        now = basis_of(survey)
        before = standing_product(
            path, survey, now.settings, remarks=now.remarks, failed=now.failed
        )
        if before is None:
            waiting[survey.plan.id] = _OTHER if _same_pull(path, now.settings) else _PULL
    return waiting


def _same_pull(path: Path, settings: str) -> bool:
    try:
        with reading(path) as archive:
            before = json.loads(str(archive.attrs.get("settings")))
        return bool(before.get("quasi_static") == json.loads(settings).get("quasi_static"))
    except (ArchiveError, AttributeError, ValueError):
        return True  # another form or nothing at all: more than the pull is another


def waiting_in_words(waiting: Mapping[str, str], runs: Collection[str]) -> str:
    """What has to be run before an experiment is fitted; empty where nothing has."""
    parts = []
    for reason in (_NONE, _PULL, _OTHER):
        listed = [run for run in runs if waiting.get(run) == reason]
        if listed:
            named = ", ".join(listed[:_MANY]) + (", .." if len(listed) > _MANY else "")
            parts.append(f"{len(listed)} of its runs {reason} ({named})")
    return "; ".join(parts)

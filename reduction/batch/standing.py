"""Whether the product of an earlier run stands as it is."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from pathlib import Path

from reduction import __version__
from reduction.archive.attributes import key_of
from reduction.archive.open import reading
from reduction.batch.basis import Basis
from reduction.batch.survey import Survey

NOT_REDUCED = "not reduced yet from logs and settings as they stand now"
_MANY = 4  # runs that are named one by one


def standing_product(
    path: Path, survey: Survey, settings: str, *, remarks: Sequence[str] = ()
) -> tuple[tuple[str, str], ...] | None:
    """Notes of the product of an earlier run that stands; None where it has to be made.

    Parameters
    ----------
    path : pathlib.Path
        Where it would be.
    survey : Survey
        The test.
    settings : str
        Every setting in force now, as JSON.
    remarks : sequence of str
        What the campaign leaves open about the test now; a product that stands says it too.

    Returns
    -------
    notes : tuple of (stage, text) or None
        It stands where raw hash, settings and version are the same.
    """
    try:
        if not path.exists():
            return None
        with reading(path) as archive:
            wanted = {
                "software_version": __version__,
                "test": survey.plan.id,  # that of another test may have been put in its place
                "raw_file_sha256": "\n".join(source.sha256 for source in survey.sources),
                "key": key_of(settings),
            }
            if any(archive.attrs.get(name) != value for name, value in wanted.items()):
                return None
            notes: tuple[tuple[str, str], ...] = ()
            if "note" in archive:
                stages, texts = (
                    archive.variables["note_stage"].values,
                    archive.variables["note"].values,
                )
                notes = tuple(
                    (str(stage), str(text)) for stage, text in zip(stages, texts, strict=True)
                )
    except OSError:
        return None  # an archive that cannot be read is made again
    # where it lacks a remark another test has failed than then
    return notes if set(remarks) <= {text for _, text in notes} else None


def waiting_runs(
    folder: Path, surveys: Sequence[Survey], basis_of: Callable[[Survey], Basis]
) -> set[str]:
    """Runs that have to be reduced before their experiment is fitted.

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
    waiting : set of str
        Those whose archive is not there, or not what it would be made again.
    """
    waiting = set()
    for survey in surveys:
        now = basis_of(survey)
        path = folder / f"{survey.plan.id}.nc"
        if standing_product(path, survey, now.settings, remarks=now.remarks) is None:
            waiting.add(survey.plan.id)
    return waiting


def waiting_in_words(waiting: Collection[str], runs: Collection[str]) -> str:
    """What has to be run before an experiment is fitted; empty where nothing has."""
    listed = [run for run in runs if run in waiting]
    if not listed:
        return ""
    named = ", ".join(listed[:_MANY]) + (", .." if len(listed) > _MANY else "")
    return f"{len(listed)} of its runs {NOT_REDUCED} ({named})"

"""Whether the product of an earlier run stands as it is."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reduction import __version__
from reduction.archive.open import reading
from reduction.archive.seal import has_seal
from reduction.batch.survey import Survey

__all__ = ["Standing", "failed_beside", "standing_product"]


@dataclass(frozen=True)
class Standing:
    """A product that stands: its notes, and the tests that failed since it was made."""

    notes: tuple[tuple[str, str], ...]
    rests_on: tuple[str, ...] = ()

    @property
    def remark(self) -> str:
        """What the status says beside the notes; empty where nothing failed since."""
        if not self.rests_on:
            return ""
        return (
            f"kept as an earlier, complete run made it: {', '.join(self.rests_on)} failed in this "
            "one, on which its history or its splice correction rests (--force makes it anew "
            "without)"
        )


def failed_beside(
    survey: Survey, surveys: Sequence[Survey], failed: Sequence[str]
) -> tuple[Survey, ...]:
    """Other tests of the same specimens that failed.

    Parameters
    ----------
    survey : Survey
        The test.
    surveys : sequence of Survey
        All tests of the campaign.
    failed : sequence of str
        Ids of those that failed.

    Returns
    -------
    tests : tuple of Survey
        In the order of the campaign.
    """
    return tuple(
        entry
        for entry in surveys
        if entry.plan.id in failed
        and entry.plan.log != survey.plan.log
        and set(entry.plan.specimens) & set(survey.plan.specimens)
    )


def standing_product(
    path: Path,
    survey: Survey,
    settings: str,
    *,
    remarks: Sequence[str] = (),
    failed: Sequence[Survey] = (),
) -> Standing | None:
    """Product of an earlier run that stands; None where it has to be made.

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
    failed : sequence of Survey
        From `failed_beside`.

    Returns
    -------
    standing : Standing or None
        It stands where it is as it was written, and raw hash, settings and version are the same;
        where others failed, also where it differs only in what comes from them and was made when
        they did not fail.
    """
    try:
        if not path.exists() or not has_seal(path):
            return None  # not there, or changed by another program since
        with reading(path) as archive:
            sums = "\n".join(source.sha256 for source in survey.sources)
            before = str(archive.attrs.get("settings"))
            if archive.attrs.get("software_version") != __version__:
                return None
            if archive.attrs.get("test") != survey.plan.id:
                return None  # that of another test, which was put in its place
            if archive.attrs.get("raw_file_sha256") != sums:
                return None
            rests_on = () if before == settings else _made_with(before, settings, failed)
            if rests_on is None:
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
    if not rests_on and not set(remarks) <= {text for _, text in notes}:
        return None  # another test has failed than then
    return Standing(notes, rests_on)


def _made_with(before: str, now: str, failed: Sequence[Survey]) -> tuple[str, ...] | None:
    """Failed tests that once gave what the settings now lack; None where more differs."""
    logs = [entry.plan.log for entry in failed]
    try:
        old, new = json.loads(before), json.loads(now)
        (history, history_now), (strain, strain_now) = (
            [document.pop(key) for document in (old, new)] for key in ("history", "strain")
        )
        pulls, pulls_now = (document.pop("quasi_static", None) or {} for document in (old, new))
        tests = _logs_of(history, logs)
        same = (
            old == new
            and _is_complete(history)
            and tests == _logs_of(history_now, logs)
            and all(_marks_agree(strain[name], part, logs) for name, part in strain_now.items())
            and all(pull is None or pulls[name] == pull for name, pull in pulls_now.items())
        )
    except (AttributeError, KeyError, TypeError, ValueError):
        return None  # settings of another form: the product is made again
    used = {log for row in tests or () for log in row}
    used |= {row[0] for part in strain.values() for row in part["marks"]}
    rests_on = tuple(log for log in dict.fromkeys(logs) if log in used) or tuple(logs)
    return rests_on if same and rests_on else None


def _logs_of(history: dict[str, Any] | None, failed: Sequence[str]) -> list[list[str]] | None:
    """Earlier tests of each specimen; the steps of a log that failed as that log."""
    if history is None:
        return None
    return [
        list(
            dict.fromkeys(
                test if test.rpartition(".")[0] not in failed else test.rpartition(".")[0]
                for test in tests
            )
        )
        for tests in history["earlier_tests"]
    ]


def _is_complete(history: dict[str, Any] | None) -> bool:
    """Whether no earlier test had failed when a history was made."""
    return history is None or None not in history["earlier_cycles"]


def _marks_agree(before: dict[str, Any], now: dict[str, Any], failed: Sequence[str]) -> bool:
    """Whether the tape and the marks of the tests that both have are the same.

    Marks of tests that failed are left out: what their logs said of them is not known now.
    """
    if before.get("tape") != now.get("tape"):
        return False
    tests = {row[0] for row in before["marks"]} & {row[0] for row in now["marks"]} - set(failed)
    old, new = ([row for row in part["marks"] if row[0] in tests] for part in (before, now))
    return bool(old == new)

"""Whether archives are what the campaign would make now, from the same logs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from reduction import __version__
from reduction.archive.products import OF_CAMPAIGN
from reduction.batch.executor import Serial
from reduction.batch.experiments import settings_of_experiments
from reduction.batch.progress import Progress
from reduction.batch.standing import standing_product
from reduction.batch.survey import Survey
from reduction.batch.wanted import Wanted, find_wanted
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError
from reduction.verify.archives import Looked
from reduction.verify.finding import Finding

__all__ = ["settings_findings"]

_MANY = 5  # settings that are named
_AGAIN = "Run the campaign again."


def settings_findings(
    campaign: Campaign, folder: Path, archives: Mapping[str, Looked], *, progress: Progress
) -> list[Finding]:
    """Read the logs as a run would, and compare what it would rest on with what is stored.

    Parameters
    ----------
    campaign : Campaign
        As loaded.
    folder : pathlib.Path
        Of the products.
    archives : mapping of str to Looked
        By the names of tests and parts; one that has a finding is known to be wrong and is not
        compared.
    progress : Progress
        Told of each log.

    Returns
    -------
    findings : list of Finding
        One an archive at most.
    """
    wanted = find_wanted(campaign, executor=Serial(), progress=progress)
    sound = {name: looked for name, looked in archives.items() if not looked.findings}
    findings = [
        one
        for survey in wanted.first.surveys
        if survey.plan.id in sound
        and (one := _of_test(survey, wanted, folder, sound[survey.plan.id])) is not None
    ]
    for name in OF_CAMPAIGN:
        if name in sound:
            findings += _of_part(campaign, name, sound[name])
    return findings


def _of_test(survey: Survey, wanted: Wanted, folder: Path, looked: Looked) -> Finding | None:
    name = looked.path.name
    try:
        error = survey.error or wanted.errors.get(survey.plan.id)
        if error is not None:
            raise error
        basis = wanted.basis(survey)
    except ReductionError as failure:
        return Finding(name, "settings", "the test cannot be reduced now", str(failure))
    stands = standing_product(
        folder / name, survey, basis.settings, remarks=basis.remarks, failed=basis.failed
    )
    if stands is not None:
        return None
    return (
        _of_other_version(looked)
        or _of_other_settings(looked, basis.settings)
        or Finding(name, "settings", "other tests have failed than when it was made", hint=_AGAIN)
    )


def _of_part(campaign: Campaign, name: str, looked: Looked) -> list[Finding]:
    found = _of_other_version(looked)
    if found is None and name == "surfaces" and campaign.experiments:
        found = _of_other_settings(looked, settings_of_experiments(campaign.experiments))
    return [] if found is None else [found]


def _of_other_version(looked: Looked) -> Finding | None:
    version = (looked.attributes or {}).get("software_version", "")
    if version == __version__:
        return None
    return Finding(
        looked.path.name, "settings", "another version of the software made it", version,
        __version__, _AGAIN,
    )  # fmt: skip


def _of_other_settings(looked: Looked, now: str) -> Finding | None:
    before = (looked.attributes or {}).get("settings", "")
    if before == now:
        return None
    try:
        differing = list(_differing(json.loads(before), json.loads(now)))
    except ValueError:
        differing = ["settings that cannot be read"]
    more = f" and {len(differing) - _MANY} more" if len(differing) > _MANY else ""
    return Finding(
        looked.path.name,
        "settings",
        "it was made with other settings, marks or earlier tests than stand now",
        "; ".join(differing[:_MANY]) + more,
        hint=_AGAIN,
    )


def _differing(before: Any, now: Any, place: str = "") -> Iterator[str]:
    """Places of two documents that differ, each with what stood there and stands there."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in sorted({*before, *now}):
            inner = f"{place}.{key}" if place else key
            if key in before and key in now:
                yield from _differing(before[key], now[key], inner)
            else:
                yield f"{inner} {'is gone' if key in before else 'is new'}"
    elif before != now:
        yield f"{place} {_short(before)}, now {_short(now)}"


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= 40 else f"{text[:37]}..."

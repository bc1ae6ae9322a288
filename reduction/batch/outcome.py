"""What a run says of one test: its status, in one line what matters, and what was found."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from reduction.batch.status import Status, TestStatus
from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.errors import LogError, ReductionError, SettingsError
from reduction.notes import Severity, by_severity, full_note, severity_of

_SERIOUS: tuple[Severity, ...] = ("doubt", "refusal")


def note_message(notes: Sequence[tuple[str, str]]) -> str:
    """How many notes there are, how many of them are serious, and the most serious of all."""
    ranked = by_severity(notes)
    if not ranked:
        return ""
    kinds = Counter(severity_of(stage, text) for stage, text in ranked)
    serious = [
        f"{kinds[kind]} {kind}{'s' if kinds[kind] > 1 else ''}" for kind in _SERIOUS if kinds[kind]
    ]
    among = f" ({', '.join(serious)})" if serious else ""
    count = f"{len(ranked)} note{'s' if len(ranked) > 1 else ''}"
    return f"{count}{among}; first: {full_note(*ranked[0])}"


def _error_message(campaign: Campaign, survey: Survey, error: ReductionError) -> str:
    """``FILE:ROW [CHANNEL]: problem``; an error of the data is given its test's file."""
    if isinstance(error, (LogError, SettingsError)):
        return campaign.in_words(str(error))
    if error.where():  # its file, as the campaign names it, and row and channel
        name = str(error.facts["file"])
        return f"{campaign.shown(name)}{str(error).removeprefix(name)}"
    return campaign.in_words(f"{campaign.shown(survey.plan.files[0][0])}: {error}")


def status_row(
    campaign: Campaign,
    survey: Survey,
    status: Status,
    *,
    error: ReductionError | None = None,
    message: str = "",
    seconds: float = 0.0,
    worker: str = "",
) -> TestStatus:
    """One row of the status table."""
    return TestStatus(
        test=survey.plan.id,
        status=status,
        exit_status=0 if error is None else error.exit_status,
        message=message if error is None else _error_message(campaign, survey, error),
        n_rows=survey.n_rows,
        n_cycles=survey.n_cycles,
        raw_sha256=" ".join(source.sha256 for source in survey.sources),
        seconds=seconds,
        found=survey.found,
        worker=worker,
    )

"""Notes, and how serious each one is.

A note is a sentence for a reader, given by the stage that knows; this is the one place
that ranks them, for the archive, the status table and the report alike.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Literal

Severity = Literal["doubt", "refusal", "note", "method"]

SEVERITIES: tuple[Severity, ...] = ("doubt", "refusal", "note", "method")
"""Most serious first."""

# what was done, as it is done in every test of its kind: no reason to look again
_METHOD = re.compile(
    r"by local regression|rising pieces? between|^initial tension is the mean|acts as a step"
    r"|^rate per decade from|take an area of|left to relax goes on|^the interval holds what"
    r"|the method of WHOI|marks are taken to be read|under one crosshead: one piece of each"
    r"|each curve pools|gauge length .* from length and|no marks of its own; its strain rests"
    r"|slip not looked for: \d+ cycles;|is held at 1$|to which none|^a part of "
    r"|^half cycles at the end of a run|^samples are stored in part",
    re.IGNORECASE,
)

_REFUSAL = re.compile(
    r"(^|: )refused:|\bnot given\b|: no hyperelastic law|has no tangent modulus|^not fitted"
    r"|no stress and no modulus|no load is given",
    re.IGNORECASE,
)

# words of a note after which a reader may have to put a number aside
_DOUBT = re.compile(
    r"contradict|disagree|inconsisten|extrapolat|outside|saturat|stuck|spike|backward|repeated"
    r"|\bgaps?\b|missing|broken|slipped|steps? of|not stable|do not use"
    r"|fewer|second look|implies|imply|points off|grows|gives no|creep, not|identity leaves"
    r"|whole cycles found|not counted|is negative|falls with stretch|slack within"
    r"|only \d+% of the branches|which no specimen does|cut off|marks differ|reversals give"
    r"|has no time|have no time|two amplitudes|is not constant|given up for|failed"
    r"|goes slack|drifts over the order|goes below zero"
    r"|does not hold there|is (stretched|compressed) by|no angle keeps it|load is uncertain by"
    r"|this curve (cannot tell|does not show)|stopped at a bound|was allowed: not determined"
    r"|where no stated error|is one that the stated errors|uncertainties are too small",
    re.IGNORECASE,
)


def severity_of(stage: str, text: str) -> Severity:
    """Rank of one note.

    Parameters
    ----------
    stage : str
        Stage that gave it, such as ``hold 2 new``; what is said of a specimen in the
        laboratory's own words is never more than a note.
    text : str
        The note.

    Returns
    -------
    severity : {"doubt", "refusal", "note", "method"}
        A doubt of the data or of a number that is given all the same; a number that is
        not given, and why; what else there is to know; how a number was made.

    Examples
    --------
    >>> severity_of("hold 1 new", "refused: rate per decade: the hold is too short")
    'refusal'
    >>> severity_of("moduli", "tangent modulus by local regression in a window of 0.1 of strain")
    'method'
    """
    if stage.startswith("specimen"):
        return "note"
    if _REFUSAL.search(text):
        return "refusal"
    if _METHOD.search(text):
        return "method"
    return "doubt" if _DOUBT.search(text) else "note"


def by_severity(notes: Iterable[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Notes as (stage, text), most serious first; those alike keep their order."""
    return tuple(sorted(notes, key=lambda note: SEVERITIES.index(severity_of(*note))))


def full_note(stage: str, text: str) -> str:
    """Return a note with its subject: the stage stands before it where the note does not say it.

    Parameters
    ----------
    stage : str
        Stage that gave it, such as ``hold 2 new``; its last word is the specimen.
    text : str
        The note.

    Returns
    -------
    sentence : str
        What can stand alone, beside the name of the test.

    Examples
    --------
    >>> full_note("hold 1 new", "refused: rate per decade: the hold is too short")
    'hold 1 new: refused: rate per decade: the hold is too short'
    >>> full_note("strain new", "new: marks differ from the splice law")
    'new: marks differ from the splice law'
    """
    specimen = stage.split(" ")[-1]
    is_said = text.startswith((f"{stage}:", f"{specimen}:", f"{specimen},"))
    return text if is_said or not stage else f"{stage}: {text}"

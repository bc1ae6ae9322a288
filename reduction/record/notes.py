"""Notes: what a reader has to know before a number is used, as data.

The stage that knows raises a note by its code.  What a code means, how serious it is and the
sentence for a reader stand in one table, `reduction.record.note_sentences`; the sentence is
composed where it is shown.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from reduction.record.note_sentences import CAUSES, SENTENCES, UNSTATED, Severity

SEVERITIES: tuple[Severity, ...] = ("warning", "refusal", "note")
"""Most serious first."""


@dataclass(frozen=True)
class Note:
    """One thing that a reader has to know.

    Parameters
    ----------
    code : str
        What it is, such as ``marks-outlier``; the same in every version.
    severity : {"warning", "refusal", "note"}
        What could move an answer; a number that is not given, and why; what else there is to
        know.
    stage : str
        Stage that gave it, such as ``hold 2 new``; its last word is the specimen.
    subject : str
        What it is of and the sentence begins with, a specimen, a reading, a file; empty where the
        stage says it.
    numbers : mapping
        Numbers [SI] and short texts of the sentence, by name; ``effect`` is how far the answer
        moves, as a share of it. [1]
    text : str
        The sentence, of a note that was read from an archive.
    """

    code: str
    severity: Severity
    stage: str = ""
    subject: str = ""
    numbers: Mapping[str, Any] = field(default_factory=dict, hash=False)
    text: str = ""

    def __str__(self) -> str:
        """Return the sentence."""
        if self.text:
            return self.text
        template = SENTENCES[self.code][1]
        compose = template.format if isinstance(template, str) else template
        said = compose(**self.numbers)
        return f"{self.subject}: {said}" if self.subject else said


def note(code: str, subject: str = "", /, **numbers: Any) -> Note:
    """Return a note with the severity of its code.

    Parameters
    ----------
    code : str
        A key of `reduction.record.note_sentences.SENTENCES`.
    subject : str, optional
        What it is of and the sentence begins with.
    **numbers
        What its sentence uses. [SI]

    Returns
    -------
    note : Note
        Without a stage as yet.

    Raises
    ------
    KeyError
        If nothing is known of the code.

    Examples
    --------
    >>> found = note("cycles-not-as-planned", n_found=9, n_planned=10)
    >>> print(found.severity, "-", found)
    warning - 9 complete cycles found, 10 planned
    """
    return Note(code, SENTENCES[code][0], subject=subject, numbers=numbers)


def urgency(one: Note) -> tuple[int, float]:
    """Rank of a note among those as serious: causes first, then by how far they move an answer.

    What is only not stated of a machine comes last.
    """
    place = CAUSES.index(one.code) if one.code in CAUSES else len(CAUSES)
    place += one.code in UNSTATED
    effect = one.numbers.get("effect")
    far = abs(effect) if isinstance(effect, int | float) and isfinite(effect) else 0.0
    return place, -far


def by_severity(notes: Iterable[Note]) -> tuple[Note, ...]:
    """Notes, most serious first, causes before what follows, then by how far they move an answer.

    Those alike keep their order.
    """
    return tuple(sorted(notes, key=lambda one: (SEVERITIES.index(one.severity), urgency(one))))


def full_note(stage: str, text: str) -> str:
    """Return a note with its subject: a stage of a specimen stands before it where it is not said.

    Parameters
    ----------
    stage : str
        Stage that gave it, such as ``hold 2 new``; its last word is the specimen.
    text : str
        The sentence.

    Returns
    -------
    sentence : str
        What can stand alone, beside the name of the test.

    Examples
    --------
    >>> full_note("hold 1 new", "rate per decade not given: the hold is too short")
    'hold 1 new: rate per decade not given: the hold is too short'
    >>> full_note("strain new", "new: marks differ from the splice law")
    'new: marks differ from the splice law'
    """
    specimen = stage.split(" ")[-1]
    is_said = text.startswith((f"{stage}:", f"{specimen}:", f"{specimen},"))
    return text if is_said or " " not in stage else f"{stage}: {text}"

"""Notes, stored as data, for the user of a number.

A stage raises a note by its code.  The severity and the sentence of each code are in one table,
`reduction.record.note_sentences`; the sentence is composed when it is shown.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from reduction.record.note_sentences import CAUSES, SENTENCES, UNSTATED, Severity

SEVERITIES: tuple[Severity, ...] = ("warning", "refusal", "note")
"""Most serious first."""


class _Number(float):
    """A number with a space before a percent sign, and below ten million no power of ten."""

    def __format__(self, format_spec: str, /) -> str:
        text = super().__format__(format_spec)
        if format_spec.endswith("%"):
            return f"{text[:-1]} %"
        return f"{float(text):{format_spec[:-3]}.0f}" if "e+0" in text and abs(self) < 1e7 else text


@dataclass(frozen=True)
class Note:
    """One note to the user.

    Parameters
    ----------
    code : str
        Identifier, such as ``marks-outlier``; the same in every version.
    severity : {"warning", "refusal", "note"}
        A possible error in an answer; a number not given, with the reason; other information.
    stage : str
        Stage that raised it, such as ``hold 2 new``; its last word is the specimen.
    subject : str
        Start of the sentence: a specimen, a reading, a file; empty if the stage states it.
    numbers : mapping
        Numbers [SI] and short texts of the sentence, by name; ``effect`` is the relative change of
        the answer. [1]
    text : str
        The sentence, for a note read from an archive.
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
        shown = {
            name: _Number(one) if isinstance(one, float) else one
            for name, one in self.numbers.items()
        }
        compose = template.format if isinstance(template, str) else template
        said = compose(**shown)
        return f"{self.subject}: {said}" if self.subject else said


def note(code: str, subject: str = "", /, **numbers: Any) -> Note:
    """Return a note with the severity of its code.

    Note without a stage.

    Examples
    --------
    >>> found = note("cycles-not-as-planned", n_found=9, n_planned=10)
    >>> print(found.severity, "-", found)
    warning - 9 complete cycles found, 10 planned
    """
    return Note(code, SENTENCES[code][0], subject=subject, numbers=numbers)


def urgency(one: Note) -> tuple[int, float]:
    """Rank within one severity: causes first, then by their effect on an answer.

    Unstated properties of the machine come last.
    """
    place = CAUSES.index(one.code) if one.code in CAUSES else len(CAUSES)
    place += one.code in UNSTATED
    effect = one.numbers.get("effect")
    far = abs(effect) if isinstance(effect, int | float) and isfinite(effect) else 0.0
    return place, -far


def by_severity(notes: Iterable[Note]) -> tuple[Note, ...]:
    """Notes, most severe first; within one severity, causes first, then by effect on an answer.

    Equal ones keep their order.
    """
    return tuple(sorted(notes, key=lambda one: (SEVERITIES.index(one.severity), urgency(one))))


def full_note(stage: str, text: str) -> str:
    """Return a note with the stage and specimen in front if its sentence lacks them.

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


def note_message(notes: Sequence[Note]) -> str:
    """The note with the largest effect on an answer; empty if there is none.

    The other notes are in the archive, and in a collapsed part of the report.
    """
    doubts = [one for one in by_severity(notes) if one.severity == "warning"]
    return full_note(doubts[0].stage, str(doubts[0])) if doubts else ""


_CLAUSE_END = re.compile(r"\.(?=\s+[A-Z])|[:;](?=\s)|$")

_SHORTEST = 30
"""Letters of a clause that says something; a shorter one names a specimen or a stage."""


def first_clauses(text: str, room: int) -> str:
    """Return as many clauses of a note as a line has room for, at least one, none in part.

    Parameters
    ----------
    text : str
        The note; its clauses end at a full stop, semicolon or colon.
    room : int
        Letters wanted at most. A longer first clause stays whole. [1]

    Returns
    -------
    text : str
        Without the mark at which it ends.

    Examples
    --------
    >>> first_clauses("new: the splices slipped at cycle 599: strain is 3.5 % off", 40)
    'new: the splices slipped at cycle 599'
    >>> first_clauses("the tension falls; it was filtered at 2.5 Hz", 60)
    'the tension falls; it was filtered at 2.5 Hz'
    """
    ends = [found.start() for found in _CLAUSE_END.finditer(text)]
    said = [end for end in ends if end >= _SHORTEST] or [len(text)]
    fitting = [end for end in said if end <= room]
    return text[: fitting[-1] if fitting else said[0]]

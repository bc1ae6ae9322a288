"""The first screen of the report: status of each test, problems found."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from reduction.quantities.digits import fixed_number
from reduction.record.note_sentences import CAUSES
from reduction.record.note_sentences import Severity as NoteSeverity
from reduction.record.notes import SEVERITIES, full_note, urgency
from reduction.report.test_view import OF_NO_TEST, Status, TestView, all_specimens
from reduction.report.text_style import (
    NOT_GIVEN,
    PageTable,
    Shown,
    TableCell,
    count,
    make_table,
    shorten,
    shown,
    span,
    words,
)

Severity = Literal["failure", "warning", "note", "refusal"]

_ORDER: tuple[Severity, ...] = ("failure", "warning", "note", "refusal")

_NOT_SHOWN = "no archive"

_STATUS_WORDS = {OF_NO_TEST: "from an earlier run; the campaign no longer has this test"}

_HEADINGS: dict[NoteSeverity, str] = {
    "warning": "Check before use",
    "refusal": "Numbers withheld, and why",
    "note": "For information",
}

_NO_TEST = (
    "The campaign no longer has this test; what is shown comes from the archive of an earlier run."
)

_MOST_NAMES = 200
"""Greatest number of characters of the list of specimens under the title."""

_FIRST = (0, float("-inf"))

# an archive counts the holds of each specimen separately, the page orders them by time
_NUMBER = re.compile(r"[-+]?\d[\d.,]*(e[-+]?\d+)?")


TOPICS = {
    code: ("slack", place)
    for place, code in enumerate(("slack-in-cycles", "line-slack-in-loops", "run-slack", "slack"))
}
"""Topic of notes and cautions, by code, that tell one matter, and their order in the item."""


@dataclass(frozen=True)
class SummaryFinding:
    """One finding for the reader, with the tests it concerns; urgent ones first.

    Findings of one ``topic`` are one item.
    """

    severity: Severity
    tests: tuple[str, ...]
    text: str
    urgency: tuple[int, float] = (len(CAUSES), 0.0)
    topic: tuple[str, int] | None = None


@dataclass(frozen=True)
class Tile:
    """One number at the top of the page, and the target of its link."""

    number: str
    words: str
    target: str
    is_bad: bool = False


def find_faults(
    tests: Sequence[TestView],
    statuses: Sequence[Status],
    unreadable: Mapping[str, str],
    others: Sequence[SummaryFinding] = (),
) -> list[SummaryFinding]:
    """Return failures, then warnings, notes and refusals, by their possible effect on an answer.

    Texts that differ only in numbers appear once: that of the test in which it matters most, under
    the name of that test, followed by the names of the others.
    """
    gathered: dict[tuple[Severity, str], list[SummaryFinding]] = {}
    for pattern, one in _all_faults(tests, statuses, unreadable):
        gathered.setdefault((one.severity, pattern), []).append(one)
    found = []
    for own in gathered.values():
        worst = min(own, key=lambda one: one.urgency)
        names = _names(one for one in own if one.text == worst.text)
        found.append(replace(worst, tests=names, text=worst.text + _similar(worst, own)))
    joined = _by_topic([*found, *others])
    return sorted(joined, key=lambda one: (_ORDER.index(one.severity), one.urgency))


def _by_topic(found: Sequence[SummaryFinding]) -> Iterator[SummaryFinding]:
    """Yield findings, those of one topic as one item that names all their tests."""
    groups: dict[str | int, list[SummaryFinding]] = {}
    for place, one in enumerate(found):
        groups.setdefault(one.topic[0] if one.topic else place, []).append(one)
    for group in groups.values():
        own = sorted(group, key=lambda one: one.topic[1] if one.topic else 0)
        others = [f"{one.text[:1].upper()}{one.text[1:]}" for one in own[1:]]
        yield replace(
            own[0],
            severity=min((one.severity for one in own), key=_ORDER.index),
            tests=_names(own),
            text=". ".join([own[0].text, *others]),
            urgency=min(one.urgency for one in own),
        )


def _names(findings: Iterable[SummaryFinding]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for one in findings for name in one.tests))


def _similar(shown: SummaryFinding, alike: Sequence[SummaryFinding]) -> str:
    """Return the tests that have the text of a finding with other numbers; empty if none."""
    others = [one for one in alike if one.text != shown.text]
    if not others:
        return ""
    notes = f"{len(others)} similar note{'' if len(others) == 1 else 's'}"
    return f". {notes} in {', '.join(_names(others))}"


def grouped_notes(view: TestView) -> list[tuple[str, list[str]]]:
    """Return the notes of a test under headings, most serious first; empty headings left out."""
    groups = [
        (
            _HEADINGS[kind],
            [full_note(one.stage, str(one)) for one in view.notes if one.severity == kind],
        )
        for kind in SEVERITIES
    ]
    return [(heading, notes) for heading, notes in groups if notes]


def brief(view: TestView) -> str:
    """Return the short description of a test: cycles, strain, whether there is a doubt."""
    n_cycles = view.n_cycles
    rows = [f"{n_cycles:,} {'cycle' if n_cycles == 1 else 'cycles'}"] if n_cycles else []
    reached = _reached(view).text
    if reached != NOT_GIVEN:
        rows.append(f"strain {reached} %")
    if any(one.severity == "warning" for one in view.notes):
        rows.append("check")
    return ", ".join(rows)


def summary_sentence(tests: Sequence[TestView]) -> str:
    """Return the description of the campaign, else the number of its tests by kind."""
    if not tests:
        return ""
    summaries = {view.attribute("summary") for view in tests}
    own = f"Reduced {tests[0].kind} test {tests[0].id} of specimen "
    if len(summaries) == 1 and not tests[0].attribute("summary").startswith(own):
        return summaries.pop()
    kinds = Counter(view.kind for view in tests)
    of_kinds = ", ".join(f"{number} {kind}" for kind, number in kinds.items())
    names = all_specimens(tests)
    return (
        f"{len(tests)} {'test' if len(tests) == 1 else 'tests'} ({of_kinds}) of {len(names)}"
        f" {'specimen' if len(names) == 1 else 'specimens'}:"
        f" {shorten(', '.join(names), _MOST_NAMES)}."
    )


def test_table(tests: Sequence[TestView], statuses: Sequence[Status]) -> PageTable:
    """Return the tests with target, cycles found and status, including those without archive."""
    is_by_load = _is_by_load(tests)
    rows = [_test_row(view, is_by_load=is_by_load) for view in tests]
    shown_ids = {view.id for view in tests}
    for row in statuses:
        if row.test not in shown_ids:
            empty = [words("")] * 6
            rows.append([words(row.test), *empty, words(f"{_words(row.status)}, {_NOT_SHOWN}")])
    force = shown("tension", tests[0].units if tests else "si")
    columns = (
        "test", "kind", "specimens",
        force.label("tension range") if is_by_load else "target strain [%]",
        "strain reached [%]",
        "cycles found", "samples", "status",
    )  # fmt: skip
    several = any(len(view.specimens) > 1 for view in tests)
    mean = " Strain reached: mean over the specimens of a test." if several else ""
    return make_table(f"Tests in order.{mean}", columns, rows)


def tiles(
    tests: Sequence[TestView], statuses: Sequence[Status], faults: Sequence[SummaryFinding]
) -> list[Tile]:
    """Return the numbers at the top: tests, specimens, cycles, failures."""
    n_failures = sum(one.severity == "failure" for one in faults)
    n_tests = len({view.id for view in tests} | {row.test for row in statuses})
    n_specimens = len({name for view in tests for name in view.specimens})
    # the cycles of a part are also in the log of the whole test
    whole = {view.id for view in tests}
    n_cycles = sum(view.n_cycles for view in tests if view.attribute("part_of") not in whole)
    found = [_tile(n_tests, "test", "tested")]
    if tests:  # otherwise how many is unknown
        found += [
            _tile(n_specimens, "specimen", "tested"),
            _tile(n_cycles, "cycle", "answer"),
        ]
    return [*found, _tile(n_failures, "failure", "wrong", is_bad=True)] if n_failures else found


def _tile(number: int, noun: str, target: str, *, is_bad: bool = False) -> Tile:
    return Tile(f"{number:,}", noun if number == 1 else f"{noun}s", target, is_bad)


def _all_faults(
    tests: Sequence[TestView], statuses: Sequence[Status], unreadable: Mapping[str, str]
) -> Iterator[tuple[str, SummaryFinding]]:
    """Yield the key by which findings are similar, and the finding of one test."""

    def of_file(severity: Severity, name: str, text: str) -> tuple[str, SummaryFinding]:
        return text, SummaryFinding(severity, (name,), text, _FIRST)

    for name, message in unreadable.items():
        yield of_file("failure", name, f"This file cannot be shown: {message}")
    archived = {view.id for view in tests}
    for row in statuses:
        if row.status == "failed":
            yield of_file("failure", row.test, row.message or "failed without a message")
            if row.test in archived:
                yield of_file("failure", row.test, "What is shown below is from an earlier run.")
        elif row.test not in archived:
            text = f"No archive; status is {_words(row.status)}. {row.message}"
            yield of_file("warning", row.test, text)
    for view in tests:
        status = view.status
        if status and status.status == OF_NO_TEST:
            yield of_file("warning", view.id, _NO_TEST)
        archived_hash = " ".join(view.attribute("raw_file_sha256").split())
        if status and status.status != "failed" and status.raw_sha256 not in ("", archived_hash):
            text = "The raw files named in the archive differ from those in status.csv."
            yield of_file("warning", view.id, text)
        for one in view.notes:
            text = str(one)
            finding = SummaryFinding(
                one.severity, (view.id,), full_note(one.stage, text), urgency(one),
                TOPICS.get(one.code),
            )  # fmt: skip
            yield _pattern(view, text), finding


def _pattern(view: TestView, note: str) -> str:
    """Return a note without its numbers and specimens: of similar ones, one is shown on top."""
    for specimen in view.specimens:
        note = re.sub(rf"\b{re.escape(specimen)}\b", "#", note)
    return _NUMBER.sub("#", note)


def _is_by_load(tests: Sequence[TestView]) -> bool:
    """Return whether the tests are of ropes, which are planned by tension instead of strain."""
    return bool(tests) and all(view.is_rope and not _target(view) for view in tests)


def _tension(view: TestView) -> TableCell:
    mean, amplitude = view.array("mean_tension"), view.array("tension_amplitude")
    if mean is None or amplitude is None or not np.isfinite(mean).any():
        return _up_to(view, "pull_peak_tension", shown("tension", view.units), places=0)
    ends = float(np.nanmean(mean - amplitude)), float(np.nanmean(mean + amplitude))
    return span(*ends, shown("tension", view.units), places=0)


def _reached(view: TestView) -> TableCell:
    """Return the strain range of the cycles, mean of least and greatest, else of the record."""
    strain = view.array("strain")
    mean, amplitude = view.array("mean_strain"), view.array("strain_amplitude")
    percent = shown("strain", view.units)
    if mean is not None and amplitude is not None and np.isfinite(mean).any():
        ends = float(np.nanmean(mean - amplitude)), float(np.nanmean(mean + amplitude))
        return span(*ends, percent, places=1)
    if strain is not None and np.isfinite(strain).any():
        return span(float(np.nanmin(strain)), float(np.nanmax(strain)), percent, places=1)
    return _up_to(view, "pull_peak_strain", percent, places=1)


def _up_to(view: TestView, name: str, unit: Shown, *, places: int) -> TableCell:
    """Return the end of a pull, mean over its specimens; empty for other tests."""
    peak = view.array(name)
    if peak is None or not np.isfinite(peak).any():
        return words("")
    return words(f"to {fixed_number(float(np.nanmean(peak)) * unit.factor, places)}")


def _test_row(view: TestView, *, is_by_load: bool) -> list[TableCell]:
    return [
        words(view.id),
        words(view.kind),
        words(", ".join(view.specimens)),
        _tension(view) if is_by_load else words(_target(view)),
        _reached(view),
        count(float(view.n_cycles)),
        count(view.scalar("n_rows_kept")),
        words(_status(view)),
    ]


def _target(view: TestView) -> str:
    """Return the target strain of the plan in percent; the archive has "0.75 to 1.25"."""
    ends = view.attribute("target_strain").split(" to ")
    return " to ".join(f"{100 * float(end):g}" for end in ends) if ends != [""] else ""


def _status(view: TestView) -> str:
    """Return the status of a test, independent of the run that made its archive."""
    if view.status is None:
        return "archived"
    if view.status.status == "unchanged":
        return "check" if any(one.severity == "warning" for one in view.notes) else "reduced"
    return _words(view.status.status)


def _words(status: str) -> str:
    return _STATUS_WORDS.get(status, status.replace("_", " "))

"""Fields of the report to a client: a label, and the text or that it is not stated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from reduction.archive.laboratory import Client, Instrument, Item, Laboratory, ReportDetails
from reduction.report.htmltable import Cell, Table, make_table, words
from reduction.report.view import TestView, all_specimens, any_synthetic

NOT_STATED = "not stated"


@dataclass(frozen=True)
class Entry:
    """One field; an empty text was not stated."""

    label: str
    given: str

    @property
    def is_missing(self) -> bool:
        """Whether nothing was stated."""
        return not self.given

    @property
    def text(self) -> str:
        """What the report shows."""
        return self.given or NOT_STATED


def identification(details: ReportDetails, tests: Sequence[TestView]) -> list[Entry]:
    """Return which report this is, who made it for whom, and when."""
    found = [
        Entry("Report number", details.number),
        Entry("Revision", _revision(details)),
        Entry("Date of issue", details.issued),
        Entry("Laboratory", _lines(details.laboratory)),
        Entry("Place of the tests", details.laboratory.location),
    ]
    if details.laboratory.accreditation:
        found.append(Entry("Accreditation", details.laboratory.accreditation))
    return [
        *found,
        Entry("Client", _lines(details.client)),
        Entry("Order", details.client.order),
        Entry("Items received", details.received or _received(details.items)),
        Entry("Date of the tests", details.tested or _dates(tests)),
    ]


def _revision(details: ReportDetails) -> str:
    if not (details.revision or details.amendment):
        return "0 (first issue)"
    said = details.amendment or f"what changed is {NOT_STATED}"
    return f"{details.revision} \N{EM DASH} AMENDED REPORT: {said}"


def _lines(party: Laboratory | Client) -> str:
    return "\n".join(filter(None, (party.name, party.address, party.contact)))


def _received(items: Mapping[str, Item]) -> str:
    """Say when each item came in, where each has a date of its own."""
    if not items or not all(one.received for one in items.values()):
        return ""
    return "; ".join(f"{specimen}: {one.received}" for specimen, one in items.items())


def _dates(tests: Sequence[TestView]) -> str:
    """Give the first and the last date that the archives know, where each test has one."""
    dates = [view.attribute("date") for view in tests]
    if not dates or not all(dates):
        return ""
    ends = list(dict.fromkeys((min(dates), max(dates))))
    return " to ".join(ends)


def method(details: ReportDetails, tests: Sequence[TestView]) -> list[Entry]:
    """Return by which method, what was done otherwise, and how the items were chosen."""
    return [
        Entry("Method", details.method or _of_tests(tests, "procedure")),
        Entry("Deviations from the method", details.deviations),
        Entry("Sampling", details.sampling),
        Entry(
            "Published source",
            next(filter(None, (one.attribute("references") for one in tests)), ""),
        ),
    ]


def environment(details: ReportDetails, tests: Sequence[TestView]) -> list[Entry]:
    """Return the conditions during the tests."""
    found = [
        Entry("Medium", _of_tests(tests, "medium")),
        Entry("Temperature", _of_tests(tests, "temperature")),
    ]
    soak = _of_tests(tests, "soak")
    if soak:
        found.append(Entry("Soaking", soak))
    if details.environment or all(one.is_missing for one in found):
        found.append(Entry("Other conditions", details.environment))
    return found


def authorisation(details: ReportDetails) -> list[Entry]:
    """Return who answers for the report."""
    return [
        Entry("Authorised by", details.authorised.by),
        Entry("Function", details.authorised.function),
        Entry("Date", details.authorised.on),
    ]


def missing_of(groups: Iterable[Sequence[Entry]]) -> list[str]:
    """Return the labels of what is not stated, in the order of the report."""
    return [one.label for group in groups for one in group if one.is_missing]


def _of_tests(tests: Sequence[TestView], name: str) -> str:
    """Give an attribute of the tests: once where they agree, by test where they do not."""
    by_text: dict[str, list[str]] = {}
    for view in tests:
        by_text.setdefault(view.attribute(name), []).append(view.id)
    if set(by_text) <= {""}:
        return ""
    if len(by_text) == 1:
        return next(iter(by_text))
    return "; ".join(f"{', '.join(ids)}: {text or NOT_STATED}" for text, ids in by_text.items())


def item_table(details: ReportDetails, tests: Sequence[TestView]) -> Table:
    """Return what came in: every specimen that was tested, stated or not."""
    names = dict.fromkeys([*all_specimens(tests), *details.items])
    given = {name: details.items.get(name, Item()) for name in names}
    rows = [
        [
            words(name), _said(one.identification), _said(one.description), _said(one.condition),
            _said(one.received or details.received),
        ]
        for name, one in given.items()
    ]  # fmt: skip
    return make_table(
        "Items as they were received.",
        ("item", "identification", "description", "condition on receipt", "received"), rows,
        synthetic=any_synthetic(tests),
    )  # fmt: skip


def calibration_table(details: ReportDetails, tests: Sequence[TestView]) -> Table:
    """Return the instruments with their calibration: as stated, then as the tests name them."""
    stated = list(details.instruments)
    known = {one.name for one in stated}
    for view in tests:
        due = view.attribute("calibration_due")
        for name in ("machine", "load_cell"):
            text = view.attribute(name)
            if text and text not in known:
                known.add(text)
                stated.append(Instrument(name=text, due=due if name == "load_cell" else ""))
    if not stated:
        stated = [Instrument(name="")]
    rows = [
        [
            _said(one.name), _said(one.identification), _said(one.certificate),
            _said(one.traceable_to), _said(one.calibrated), _said(one.due),
        ]
        for one in stated
    ]  # fmt: skip
    return make_table(
        "Instruments and their calibration.",
        ("instrument", "identification", "certificate", "traceable to", "calibrated", "due"),
        rows, synthetic=any_synthetic(tests),
    )  # fmt: skip


def _said(text: str) -> Cell:
    return Cell(text or NOT_STATED)

"""The report of a laboratory to its client: one page for print, with the content required by [1]_.

It opens from disk, needs no script, and prints to A4 or Letter with the number of the report and
of the page on each sheet.  Missing information is shown as not stated.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from reduction import __version__
from reduction.archive.report_details import (
    Client,
    Instrument,
    Laboratory,
    ReportDetails,
    ReportItem,
)
from reduction.quantities.units import UnitSystem
from reduction.report.answer_tables import (
    AnswerBudget,
    answer_budgets,
    conformity_table,
    pull_table,
)
from reduction.report.campaign_sections import CampaignView
from reduction.report.campaign_summary import SummaryFinding, test_table
from reduction.report.figure_data import Figure
from reduction.report.figures.campaign_figures import draw_all_moduli
from reduction.report.svg_figure import can_be_drawn, vector_of
from reduction.report.test_section import (
    Part,
    TestSection,
    design_tables,
    specimen_notes,
    specimen_table,
)
from reduction.report.test_view import (
    DRAWN,
    Status,
    TestView,
    all_specimens,
    any_synthetic,
    factor_words,
    instrument_sentences,
    instrument_table,
)
from reduction.report.text_style import (
    PageTable,
    TableCell,
    factors_of,
    make_table,
    number,
    shorten,
    words,
)

NOT_STATED = "not stated"


@dataclass(frozen=True)
class _Entry:
    """One field; an empty text means not stated."""

    label: str
    given: str

    @property
    def is_missing(self) -> bool:
        """Whether nothing was stated."""
        return not self.given

    @property
    def text(self) -> str:
        """Text in the report."""
        return self.given or NOT_STATED


def _identification(details: ReportDetails, tests: Sequence[TestView]) -> list[_Entry]:
    """Return number, author, client and date of the report."""
    found = [
        _Entry("Report number", details.number),
        _Entry("Revision", _revision(details)),
        _Entry("Date of issue", details.issued),
        _Entry("Laboratory", _lines(details.laboratory)),
        _Entry("Place of the tests", details.laboratory.location),
    ]
    if details.laboratory.accreditation:
        found.append(_Entry("Accreditation", details.laboratory.accreditation))
    return [
        *found,
        _Entry("Client", _lines(details.client)),
        _Entry("Order", details.client.order),
        _Entry("Items received", details.received or _received(details.items)),
        _Entry("Date of the tests", details.tested or _dates(tests)),
    ]


def _revision(details: ReportDetails) -> str:
    if not (details.revision or details.amendment):
        return "0 (first issue)"
    said = details.amendment or f"what changed is {NOT_STATED}"
    return f"{details.revision} \N{EM DASH} AMENDED REPORT: {said}"


def _lines(party: Laboratory | Client) -> str:
    return "\n".join(filter(None, (party.name, party.address, party.contact)))


def _received(items: Mapping[str, ReportItem]) -> str:
    """State when each item was received, where the dates differ by item."""
    if not items or not all(one.received for one in items.values()):
        return ""
    return "; ".join(f"{specimen}: {one.received}" for specimen, one in items.items())


def _dates(tests: Sequence[TestView]) -> str:
    """Return the first and the last date in the archives, where each test has one."""
    dates = [view.attribute("date") for view in tests]
    if not dates or not all(dates):
        return ""
    ends = list(dict.fromkeys((min(dates), max(dates))))
    return " to ".join(ends)


def _method(details: ReportDetails, tests: Sequence[TestView]) -> list[_Entry]:
    """Return the method, deviations from it, and how the items were chosen."""
    return [
        _Entry("Method", details.method or _of_tests(tests, "procedure")),
        _Entry("Deviations from the method", details.deviations),
        _Entry("Sampling", details.sampling),
        _Entry(
            "Published source",
            next(filter(None, (one.attribute("references") for one in tests)), ""),
        ),
    ]


def _environment(details: ReportDetails, tests: Sequence[TestView]) -> list[_Entry]:
    """Return the conditions during the tests."""
    found = [
        _Entry("Medium", _of_tests(tests, "medium")),
        _Entry("Temperature", _of_tests(tests, "temperature")),
    ]
    soak = _of_tests(tests, "soak")
    if soak:
        found.append(_Entry("Soaking", soak))
    if details.environment or all(one.is_missing for one in found):
        found.append(_Entry("Other conditions", details.environment))
    return found


def _of_tests(tests: Sequence[TestView], name: str) -> str:
    """Return an attribute of the tests: once where they agree, by test where they differ."""
    by_text: dict[str, list[str]] = {}
    for view in tests:
        by_text.setdefault(view.attribute(name), []).append(view.id)
    if set(by_text) <= {""}:
        return ""
    if len(by_text) == 1:
        return next(iter(by_text))
    return "; ".join(f"{', '.join(ids)}: {text or NOT_STATED}" for text, ids in by_text.items())


def _item_table(details: ReportDetails, tests: Sequence[TestView]) -> PageTable:
    """Return the received items: every tested specimen, stated or not."""
    names = dict.fromkeys([*all_specimens(tests), *details.items])
    given = {name: details.items.get(name, ReportItem()) for name in names}
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

    )  # fmt: skip


def _calibration_table(details: ReportDetails, tests: Sequence[TestView]) -> PageTable:
    """Return the instruments with their calibration: those stated, then those named in tests."""
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
        rows,
    )  # fmt: skip


def _said(text: str) -> TableCell:
    return TableCell(text or NOT_STATED)


_TWO_PANELS = 1.25

_BANDS = (
    " Bands: ± expanded uncertainty, the inner of scatter alone, the outer of all that is known."
)

_HOLDS = "Holds"

_OF_HOLDS = ("relaxation", "creep")

_FIGURES = ("Modulus against strain", "Loops", "Slow pull", "Stepwise readings", _HOLDS)


@dataclass(frozen=True)
class _Drawing:
    """A figure with its caption; a wide one uses the full width of the page."""

    vector: Markup
    caption: str
    is_wide: bool = False


def _chosen_figures(
    tests: Sequence[TestView], sections: Sequence[TestSection]
) -> Iterator[tuple[Figure, bool]]:
    """Yield the figures to draw, and whether each uses the full width."""
    for one in draw_all_moduli(tests):
        yield one, True
    for _, part in _chosen_parts(tests, sections, _FIGURES):
        for one in part.figures:
            yield one, False


def _drawing(figure: Figure, *, is_wide: bool) -> _Drawing:
    width, height = (680.0, 360.0) if is_wide else (440.0, 225.0)
    if "yaxis2" in figure.layout:
        height *= _TWO_PANELS
    caption, *about = figure.caption.split(" Inner band:")
    caption += _BANDS if about else ""
    # the drawing escapes its input
    drawn = Markup(vector_of(figure, width=width, height=height))  # noqa: S704
    return _Drawing(drawn, caption, is_wide)


def _chosen_parts(
    tests: Sequence[TestView], sections: Sequence[TestSection], headings: Collection[str]
) -> Iterator[tuple[TestSection, Part]]:
    """Yield parts of the sections of the tests; holds only for tests that were made for them."""
    kinds = {view.key: view.kind for view in tests}
    for section in sections:
        for part in section.parts:
            is_asked = part.heading in headings
            if is_asked and (part.heading != _HOLDS or kinds.get(section.key) in _OF_HOLDS):
                yield section, part


_MOST_COLUMNS = 5

_TABLES = ("Stepwise readings", "Slow pull", "Holds")

_IN_FULL = {
    "K_ap": "apparent spring constant K_ap", "H": "hysteresis energy H",
    "K_1": "dissipation spring constant K_1", "tau": "relaxation time tau",
}  # fmt: skip

_STATEMENTS = (
    "The results in this report relate only to the items that were tested, as they were received.",
    "This report is not to be reproduced except in full without written approval of the"
    " laboratory.",
)


@dataclass(frozen=True)
class ClientContent:
    """Content of a report to a client, all from the folder of the archives."""

    details: ReportDetails
    tests: Sequence[TestView]
    whole: CampaignView
    sections: Sequence[TestSection]
    statuses: Sequence[Status]
    faults: Sequence[SummaryFinding]
    title: str
    campaign: str
    units: UnitSystem


def _groups(details: ReportDetails, tests: Sequence[TestView]) -> dict[str, list[_Entry]]:
    return {
        "identification": _identification(details, tests),
        "method": _method(details, tests),
        "environment": _environment(details, tests),
        "authorisation": [
            _Entry("Authorised by", details.authorised.by),
            _Entry("Function", details.authorised.function),
            _Entry("Date", details.authorised.on),
        ],
    }


def render_client_report(content: ClientContent) -> str:
    """Return the report as HTML that opens from disk."""
    details, tests, units = content.details, content.tests, content.units
    synthetic = any_synthetic(tests) or content.whole.is_synthetic
    label = f"Report {details.number or NOT_STATED}, revision {details.revision}"
    figures = list(_chosen_figures(tests, content.sections))
    environment_of = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    room = files("reduction.report")
    template = environment_of.from_string((room / "templates" / "client.html").read_text("utf-8"))
    groups = _groups(details, tests)
    return template.render(
        **groups,
        missing=[one.label for group in groups.values() for one in group if one.is_missing],
        style=Markup(  # noqa: S704  # the style of the package; texts on each sheet are quoted
            _sheet_style(details, label, synthetic=synthetic)
            + (room / "static" / "client.css").read_text("utf-8")
        ),
        details=details,
        label=label,
        title=content.title,
        campaign=content.campaign,
        synthetic=synthetic,
        items=_item_table(details, tests),
        specimens=specimen_table(tests) if tests else None,
        specimen_notes=specimen_notes(tests),
        tests=_tests(content),
        calibration=_calibration_table(details, tests),
        instruments=instrument_table(tests, units),
        instrument_notes=instrument_sentences(tests),
        results=_results(content),
        drawings=[_drawing(one, is_wide=wide) for one, wide in figures if can_be_drawn(one)],
        not_drawn=[one.title for one, _ in figures if not can_be_drawn(one)],
        conformity=conformity_table(details, tests, units),
        doubts=[one for one in content.faults if one.severity in ("failure", "warning")],
        statements=_STATEMENTS,
        raw_files=_raw_file_table(tests),
        version=__version__,
        not_stated=NOT_STATED,
    )


def _results(content: ClientContent) -> list[PageTable]:
    """Return the numbers: moduli at round strains, answers of each test, answers of the whole."""
    found = [part for one in design_tables(content.tests) for part in _by_columns(one)]
    found += [table for view in content.tests if (table := _answers(view)) is not None]
    if (pulls := pull_table(content.tests)) is not None:
        found += _by_columns(_without_status(pulls))
    found += [
        replace(table, caption=f"{section.title}: {table.caption}")
        for section, part in _chosen_parts(content.tests, content.sections, _TABLES)
        for table in part.tables
    ]
    found += [
        replace(table, caption=f"{section.title}: {table.caption}")
        for _, section in content.whole.ropes
        for part in section.parts
        for table in part.tables
    ]
    return [*found, *content.whole.answers]


def _answers(view: TestView) -> PageTable | None:
    answers = answer_budgets(view)
    if not answers or view.is_stepwise:  # its intervals are in a separate table
        return None
    rows = [
        [
            words(_in_full(view, one)), words(one.specimen), one.cell, words(one.unit.unit),
            number(float("nan") if one.drawn else one.budget.coverage_factor, digits=3),
        ]
        for one in answers
    ]  # fmt: skip
    return make_table(
        f"Test {view.id}.", ("quantity", "item", "result", "unit", "k"), rows,

        remarks=[
            f"±: expanded uncertainty, coverage 95 % ({factor_words(factors_of(rows))}).",
            *([DRAWN] if any(one.drawn for one in answers) else []),
        ],
    )  # fmt: skip


def _in_full(view: TestView, one: AnswerBudget) -> str:
    """Return the full name of an answer, for a reader who has only this report."""
    place = one.budget.place
    if "segment" not in place:
        return _IN_FULL.get(one.words, one.words)
    at = (
        view.specimens.index(one.specimen),
        view.texts("branch_name").index(place["branch_name"]),
        int(place["segment"]) - 1,
    )
    ends = [view.array(f"segment_strain_{end}") for end in ("low", "high")]
    low, high = (np.nan if rows is None else 100 * rows[at] for rows in ends)
    return f"modulus, {place['branch_name']}, strain {low:.3g} to {high:.3g} %"


def _by_columns(table: PageTable) -> list[PageTable]:
    """Return a table in parts that fit the page width, each with the first column."""
    rest = range(1, len(table.columns))
    parts = [rest[start : start + _MOST_COLUMNS] for start in range(0, len(rest), _MOST_COLUMNS)]
    if len(parts) < 2:
        return [table]
    found = []
    for order, part in enumerate(parts):
        places = [0, *part]
        # a row of placeholders only has no information
        rows = [
            [row[place] for place in places]
            for row in table.rows
            if any(row[place].value for place in part)
        ]
        caption = table.caption if order == 0 else f"{table.caption} Continued."
        remarks = table.remarks if order == len(parts) - 1 else ()
        found.append(
            make_table(
                caption, [table.columns[place] for place in places], rows,
                remarks=remarks,
            )
        )  # fmt: skip
    return found


def _tests(content: ClientContent) -> PageTable | None:
    """Return the tests; the status of each is given only where it failed."""
    if not (content.tests or content.statuses):
        return None
    table = test_table(content.tests, content.statuses)
    is_amiss = any(row.status == "failed" for row in content.statuses) or any(
        view.is_of_earlier_run for view in content.tests
    )
    if is_amiss or len(content.statuses) > len(content.tests):
        return table
    return _without_status(table)


def _without_status(table: PageTable) -> PageTable:
    """Return a table without its last column, the status of each test."""
    rows = tuple(row[:-1] for row in table.rows)
    return replace(table, columns=table.columns[:-1], rows=rows)


def _raw_file_table(tests: Sequence[TestView]) -> PageTable | None:
    rows = [
        [words(view.id), words(name), words(sum_)]
        for view in tests
        for name, sum_ in zip(
            view.attribute("raw_file").splitlines(),
            view.attribute("raw_file_sha256").splitlines(),
            strict=False,
        )
    ]
    if not rows:
        return None
    return make_table(
        "Logs from which the results were made.", ("test", "file", "SHA-256"), rows,

    )  # fmt: skip


def _sheet_style(details: ReportDetails, label: str, *, synthetic: bool) -> str:
    """Return the content of the margins of each sheet."""
    laboratory = shorten(details.laboratory.name, 60) or f"Laboratory {NOT_STATED}"
    amended = " (amended)" if details.revision or details.amendment else ""
    boxes = {
        "top-left": _quoted(laboratory),
        "top-right": _quoted("SYNTHETIC DATA: no specimen was tested" if synthetic else ""),
        "bottom-left": _quoted(shorten(label, 70) + amended),
        "bottom-right": '"Page " counter(page) " of " counter(pages)',
    }
    rules = " ".join(f"@{place} {{ content: {text}; }}" for place, text in boxes.items())
    return f"@page {{ size: {details.paper}; {rules} }}\n"


def _quoted(text: str) -> str:
    r"""Return text as a string of CSS that cannot be escaped from.

    Examples
    --------
    >>> print(_quoted('A"</style>'))
    "A\22 \3c \2f style\3e "
    """
    return '"' + "".join(
        one if one.isascii() and (one.isalnum() or one in " .,-") else f"\\{ord(one):x} "
        for one in text
    ) + '"'  # fmt: skip

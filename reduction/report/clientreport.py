"""The report of a laboratory to its client: one page for paper, with what [1]_ asks of it.

It opens from disk, needs no script, and prints to A4 or Letter with the number of the report and
of the page on each sheet.  What was not stated is shown as not stated.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from reduction import __version__
from reduction.laboratory import ReportDetails
from reduction.report.answers import AnswerBudget, answer_budgets
from reduction.report.clientfields import (
    NOT_STATED,
    Entry,
    authorisation,
    calibration_table,
    environment,
    identification,
    item_table,
    method,
    missing_of,
)
from reduction.report.conformitytable import conformity_table
from reduction.report.designtables import design_tables
from reduction.report.figure import Figure
from reduction.report.figures.campaign import draw_all_moduli
from reduction.report.htmltable import Table, factors_of, make_table, number, words
from reduction.report.instruments import instrument_sentences, instrument_table
from reduction.report.section import Part, Section
from reduction.report.specimentables import specimen_notes, specimen_table
from reduction.report.style import shorten
from reduction.report.summary import Finding, test_table
from reduction.report.uncertainty import DRAWN, factor_words
from reduction.report.vector import can_be_drawn, vector_of
from reduction.report.view import Status, TestView, any_synthetic
from reduction.report.whole import WholeCampaign
from reduction.units import UnitSystem

__all__ = ["PAGE_NAME", "ClientContent", "missing_fields", "render_client_report"]

PAGE_NAME = "client-report.html"
_MOST_COLUMNS = 5
_BANDS = (
    " Bands: ± expanded uncertainty, the inner of scatter alone, the outer of all that is known."
)
_HOLDS = "Holds"
_OF_HOLDS = ("relaxation", "creep")
_TABLES = ("Stepwise readings", "Slow pull", _HOLDS)
_FIGURES = ("Modulus against strain", "Loops", "Slow pull", "Stepwise readings", _HOLDS)
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
    """What a report to a client is made from: all of it out of the folder of the archives."""

    details: ReportDetails
    tests: Sequence[TestView]
    whole: WholeCampaign
    sections: Sequence[Section]
    statuses: Sequence[Status]
    faults: Sequence[Finding]
    title: str
    campaign: str
    units: UnitSystem


@dataclass(frozen=True)
class _Drawing:
    """A figure with its caption; a wide one takes the whole width of the page."""

    vector: Markup
    caption: str
    is_wide: bool = False


def missing_fields(details: ReportDetails, tests: Sequence[TestView]) -> list[str]:
    """Return the labels of the fields that nobody stated."""
    return missing_of(_groups(details, tests).values())


def _groups(details: ReportDetails, tests: Sequence[TestView]) -> dict[str, list[Entry]]:
    return {
        "identification": identification(details, tests),
        "method": method(details, tests),
        "environment": environment(details, tests),
        "authorisation": authorisation(details),
    }


def render_client_report(content: ClientContent) -> str:
    """Return the report as HTML that opens from disk."""
    details, tests, units = content.details, content.tests, content.units
    synthetic = any_synthetic(tests) or content.whole.is_synthetic
    label = f"Report {details.number or NOT_STATED}, revision {details.revision}"
    environment_of = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    room = files("reduction.report")
    template = environment_of.from_string((room / "templates" / "client.html").read_text("utf-8"))
    return template.render(
        **_groups(details, tests),
        style=Markup(  # noqa: S704  # the style of the package; what stands on each sheet is quoted
            _sheet_style(details, label, synthetic=synthetic)
            + (room / "static" / "client.css").read_text("utf-8")
        ),
        details=details,
        label=label,
        title=content.title,
        campaign=content.campaign,
        synthetic=synthetic,
        items=item_table(details, tests),
        specimens=specimen_table(tests, units) if tests else None,
        specimen_notes=specimen_notes(tests),
        tests=test_table(tests, content.statuses) if tests or content.statuses else None,
        calibration=calibration_table(details, tests),
        instruments=instrument_table(tests, units),
        instrument_notes=instrument_sentences(tests),
        results=_results(content),
        drawings=_drawings(content),
        conformity=conformity_table(details, tests, units),
        doubts=[one for one in content.faults if one.severity in ("failure", "warning")],
        statements=_STATEMENTS,
        raw_files=_raw_file_table(tests, synthetic=synthetic),
        version=__version__,
        not_stated=NOT_STATED,
    )


def _results(content: ClientContent) -> list[Table]:
    """Return the numbers: moduli at round strains, answers of each test, answers of the whole."""
    found = [part for one in design_tables(content.tests) for part in _by_columns(one)]
    found += [table for view in content.tests if (table := _answers(view)) is not None]
    found += [
        replace(table, caption=f"{section.title}: {table.caption}")
        for section, part in _parts(content, _TABLES)
        for table in part.tables
    ]
    return [*found, *content.whole.answers]


def _answers(view: TestView) -> Table | None:
    answers = answer_budgets(view)
    if not answers or view.is_stepwise:  # whose intervals stand in a table of their own
        return None
    rows = [
        [
            words(_in_full(view, one)), words(one.specimen), one.cell, words(one.unit.unit),
            number(float("nan") if one.drawn else one.budget.coverage_factor, digits=3),
        ]
        for one in answers
    ]  # fmt: skip
    return make_table(
        f"Test {view.id}.", ("quantity", "item", "result", "unit", "k [1]"), rows,
        synthetic=view.is_synthetic,
        remarks=[
            f"±: expanded uncertainty, coverage 95 % ({factor_words(factors_of(rows))}).",
            *([DRAWN] if any(one.drawn for one in answers) else []),
        ],
    )  # fmt: skip


def _in_full(view: TestView, one: AnswerBudget) -> str:
    """Return what an answer is, for a reader who has nothing but this report."""
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
    return f"modulus, {place['branch_name']}, strain {low:.0f} to {high:.0f} %"


def _by_columns(table: Table) -> list[Table]:
    """Return a table in parts that fit the width of a page, the first column in each."""
    rest = range(1, len(table.columns))
    parts = [rest[start : start + _MOST_COLUMNS] for start in range(0, len(rest), _MOST_COLUMNS)]
    if len(parts) < 2:
        return [table]
    found = []
    for order, part in enumerate(parts):
        places = [0, *part]
        # a row of nothing but marks says nothing
        rows = [
            [row[place] for place in places]
            for row in table.rows
            if any(row[place].value for place in part)
        ]
        caption = table.caption if order == 0 else f"{table.caption} Continued."
        remarks = table.remarks if order == len(parts) - 1 else ()
        found.append(
            make_table(
                caption, [table.columns[place] for place in places], rows, synthetic=False,
                remarks=remarks,
            )
        )  # fmt: skip
    return found


def _parts(content: ClientContent, headings: Collection[str]) -> Iterator[tuple[Section, Part]]:
    """Give parts of the sections of the tests; of holds those that a test was made for."""
    kinds = {view.key: view.kind for view in content.tests}
    for section in content.sections:
        for part in section.parts:
            is_asked = part.heading in headings
            if is_asked and (part.heading != _HOLDS or kinds.get(section.key) in _OF_HOLDS):
                yield section, part


def _drawings(content: ClientContent) -> list[_Drawing]:
    wide = [one for one in draw_all_moduli(content.tests) if can_be_drawn(one)]
    narrow = [
        one for _, part in _parts(content, _FIGURES) for one in part.figures if can_be_drawn(one)
    ]
    return [
        *(_drawing(one, is_wide=True) for one in wide),
        *(_drawing(one, is_wide=False) for one in narrow),
    ]


def _drawing(figure: Figure, *, is_wide: bool) -> _Drawing:
    size = {"width": 680.0, "height": 360.0} if is_wide else {"width": 440.0, "height": 262.0}
    caption, *about = figure.caption.split(" Inner band:")
    caption += _BANDS if about else ""
    # the drawing escapes what it is given
    return _Drawing(Markup(vector_of(figure, **size)), caption, is_wide)  # noqa: S704


def _raw_file_table(tests: Sequence[TestView], *, synthetic: bool) -> Table | None:
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
        "Logs that the results were made from.", ("test", "file", "SHA-256"), rows,
        synthetic=synthetic,
    )  # fmt: skip


def _sheet_style(details: ReportDetails, label: str, *, synthetic: bool) -> str:
    """Return what stands in the margins of each sheet."""
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
    r"""Return text as a string of CSS, from which nothing can break out.

    Examples
    --------
    >>> print(_quoted('A"</style>'))
    "A\22 \3c \2f style\3e "
    """
    return '"' + "".join(
        one if one.isascii() and (one.isalnum() or one in " .,-") else f"\\{ord(one):x} "
        for one in text
    ) + '"'  # fmt: skip

"""The report of a laboratory to its client: one page for paper, with what [1]_ asks of it.

It opens from disk, needs no script, and prints to A4 or Letter with the number of the report and
of the page on each sheet.  What was not stated is shown as not stated.

References
----------
.. [1] ISO/IEC 17025:2017, 7.8.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import files

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup

from reduction import __version__
from reduction.archive.laboratory import ReportDetails
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
from reduction.report.clientfigures import chosen_figures, chosen_parts, drawings, not_drawn
from reduction.report.conformitytable import conformity_table
from reduction.report.htmltable import Table, factors_of, make_table, number, words
from reduction.report.instruments import instrument_sentences, instrument_table
from reduction.report.section import Section
from reduction.report.style import shorten
from reduction.report.summary import Finding, test_table
from reduction.report.testtables import design_tables, specimen_notes, specimen_table
from reduction.report.uncertainty import DRAWN, factor_words
from reduction.report.view import Status, TestView, any_synthetic
from reduction.report.whole import WholeCampaign
from reduction.units import UnitSystem

PAGE_NAME = "client-report.html"
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
    figures = list(chosen_figures(tests, content.sections))
    environment_of = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    room = files("reduction.report")
    template = environment_of.from_string((room / "templates" / "client.html").read_text("utf-8"))
    groups = _groups(details, tests)
    return template.render(
        **groups,
        missing=missing_of(groups.values()),
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
        tests=_tests(content),
        calibration=calibration_table(details, tests),
        instruments=instrument_table(tests, units),
        instrument_notes=instrument_sentences(tests),
        results=_results(content),
        drawings=drawings(figures),
        not_drawn=not_drawn(figures),
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
        for section, part in chosen_parts(content.tests, content.sections, _TABLES)
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


def _tests(content: ClientContent) -> Table | None:
    """Return the tests; of what the software did with each only that it failed."""
    if not (content.tests or content.statuses):
        return None
    table = test_table(content.tests, content.statuses)
    is_amiss = any(row.status == "failed" for row in content.statuses) or any(
        view.is_of_earlier_run for view in content.tests
    )
    if is_amiss or len(content.statuses) > len(content.tests):
        return table
    rows = tuple(row[:-1] for row in table.rows)
    return replace(table, columns=table.columns[:-1], rows=rows)


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

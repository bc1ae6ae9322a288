"""Implements the command figures."""

from __future__ import annotations

from pathlib import Path

from rich.markup import escape

from reduction.cli.lookup import lines_of_source
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import table_of
from reduction.lines.report_figures import FigureRow, figure_in_numbers, figure_rows
from reduction.pages.report_figure_files import units_of_report, write_figure, write_page
from reduction.published.printed_cells import REPORTS
from reduction.record.errors import SettingsError


def draw_figures(
    report: str | None,
    figure: str | None,
    *,
    campaign: Path | None,
    out: Path,
    units: str | None,
    output: CommandOutput,
) -> None:
    """Draw figures of the reports, with a page for each report unless one figure is requested."""
    rows = _asked(report, figure)
    own = [] if campaign is None else lines_of_source(str(campaign))
    drawn = [row for row in rows if row.is_drawn]
    if figure is not None and not drawn:
        figure_in_numbers(rows[0])
    files = [
        write_figure(
            figure_in_numbers(row, own), out / row.report, units_of_report(row.report, units)
        )
        for row in drawn
    ]
    told = {(one.row.report, one.row.figure): str(one.paths[0]) for one in files}
    table = table_of("report", "figure", "shows", "file, or why not", texts=4)
    for row in rows:
        written = told.get((row.report, row.figure), row.from_or_why_not)
        table.add_row(*map(escape, (row.report, row.figure, row.shows, written)))
    output.show(table)
    pages = []
    if figure is None:
        for name in dict.fromkeys(row.report for row in rows):
            own_rows = [row for row in rows if row.report == name]
            own_files = [one for one in files if one.row.report == name]
            told_of = "" if campaign is None else campaign.name
            pages.append(write_page(name, own_files, own_rows, out / name, told_of))
            output.say(f"page: {pages[-1]}")
    output.answer(
        {
            "figures": [
                {
                    **vars(row),
                    "drawn": row.is_drawn,
                    "file": told.get((row.report, row.figure)),
                }
                for row in rows
            ],
            "files": [str(path) for one in files for path in one.paths],
            "pages": [str(page) for page in pages],
        }
    )


def _asked(report: str | None, figure: str | None) -> list[FigureRow]:
    if report is not None and report not in REPORTS:
        raise SettingsError(
            "there is no such report", found=repr(report), needed="one of " + ", ".join(REPORTS)
        )
    rows = [row for row in figure_rows() if report in (None, row.report)]
    if figure is None:
        return rows
    found = [row for row in rows if row.figure == figure]
    if not found:
        raise SettingsError(
            "there is no such figure", found=repr(figure),
            needed="a number as the report has it, such as 4, A-1 or 9(a)",
        )  # fmt: skip
    return found

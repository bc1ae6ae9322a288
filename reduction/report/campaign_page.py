"""The report of a campaign: one page, made from its archives alone, that opens from disk."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import xarray as xr

from reduction.archive.atomic_write import take_away, write_text_atomically
from reduction.archive.open import Opener, reading
from reduction.archive.product_files import CLIENT_PAGE_NAME, archives_of_tests
from reduction.archive.report_details import read_details
from reduction.quantities.units import UnitSystem
from reduction.record.errors import ArchiveError
from reduction.record.plain_text import bare_cell, natural_order
from reduction.report.answer_tables import (
    design_modulus_table,
    hold_table,
    lacking_answer,
    pull_table,
    unlike_tests_table,
)
from reduction.report.campaign_sections import (
    ALL_COMPARISONS,
    CampaignView,
    is_there,
    read_campaign,
)
from reduction.report.campaign_summary import (
    SummaryFinding,
    find_faults,
    summary_sentence,
    test_table,
    tiles,
)
from reduction.report.client_report import ClientContent, render_client_report
from reduction.report.figure_data import Figure
from reduction.report.figures.campaign_figures import (
    draw_all_moduli,
    draw_parts,
    draw_ratios,
    draw_specimens_together,
    draw_static_dynamic,
    draw_stiffness_levels,
)
from reduction.report.figures.cycle_figures import draw_amplitude_pairs
from reduction.report.page_template import (
    Link,
    Page,
    RenderedSection,
    ScratchTexts,
    about_page,
    render_page,
    render_section,
)
from reduction.report.test_section import (
    Part,
    TestSection,
    design_tables,
    interval_table,
    make_part,
    make_section,
    segment_table,
    specimen_notes,
    specimen_table,
)
from reduction.report.test_view import (
    OF_NO_TEST,
    Status,
    TestView,
    any_synthetic,
    instrument_sentences,
    instrument_table,
)
from reduction.report.text_style import PageTable

MOST_BYTES = 9_000_000
"""Greatest size of the sections on a page: with plotly (4.9 MB) it stays below 15 MB. [byte]"""

MOST_IN_ALL = 14_500_000
"""Greatest size of a page with all its content. [byte]"""

_NAME = "tests-{:02}.html"

_OWN = re.compile(r"tests-\d{2,}\.html")
"""File names that are written here: pages of others in the folder are kept."""


def _over_pages(
    sections: Sequence[RenderedSection], most: int = MOST_BYTES
) -> list[Sequence[RenderedSection]]:
    """Split sections into pages, in their order.

    Examples
    --------
    >>> sections = [RenderedSection(f"test-{n}", f"T-{n}", 40 * "x") for n in range(5)]
    >>> [len(page) for page in _over_pages(sections, most=100)]
    [2, 2, 1]
    """
    pages: list[list[RenderedSection]] = [[]]
    held = 0
    for section in sections:
        size = section.n_bytes
        if pages[-1] and held + size > most:
            pages.append([])
            held = 0
        pages[-1].append(section)
        held += size
    return list(pages)


_SEGMENTS_ELSEWHERE = (
    "The straight-line segments of each test are in its section and in tables/moduli.csv."
)


def _write_pages(
    content: Page,
    sections: Sequence[RenderedSection],
    out: Path,
    most: int = MOST_BYTES,
    most_in_all: int = MOST_IN_ALL,
) -> Path:
    """Write the page of a campaign, and further pages where it has no room for all sections."""
    pages = _over_pages(sections, most)
    index = out / "index.html"
    kept: set[Path] = set()
    pieces: list[bytes] = []
    if len(pages) == 1:
        pieces = render_page(replace(content, sections=pages[0], links=_links(pages[0])))
    # tables and figures over all tests also take room
    if len(pages) > 1 or (pages[0] and sum(map(len, pieces)) > most_in_all):
        names = [_NAME.format(number) for number in range(1, len(pages) + 1)]
        beside = [Link(name, _words(page)) for name, page in zip(names, pages, strict=True)]
        for name, page in zip(names, pages, strict=True):
            write_text_atomically(out / name, *render_page(_part_of(content, page)))
            kept.add(out / name)
        links = [
            link for name, page in zip(names, pages, strict=True) for link in _links(page, name)
        ]
        content = replace(content, links=links, beside=beside)
        pieces = render_page(content)
        if content.segments is not None and sum(map(len, pieces)) > most_in_all:
            # with many tests these tables are the largest, and each is also in its test's section
            about = (*content.about, _SEGMENTS_ELSEWHERE)
            pieces = render_page(replace(content, segments=None, about=about))
    write_text_atomically(index, *pieces)
    for path in out.iterdir():
        if _OWN.fullmatch(path.name) and path not in kept:
            take_away(path)
    return index


def _links(page: Sequence[RenderedSection], name: str = "") -> list[Link]:
    return [Link(f"{name}#{section.key}", section.title) for section in page]


def _words(page: Sequence[RenderedSection]) -> str:
    if len(page) == 1:
        return page[0].title
    return f"{page[0].title} to {page[-1].title} ({len(page)} tests)"


def _part_of(content: Page, page: Sequence[RenderedSection]) -> Page:
    return Page(
        title=f"{content.title}: {_words(page)}",
        campaign=content.campaign,
        summary="",
        about=content.about,
        tiles=(),
        faults=(),
        chapters=(),
        synthetic=content.synthetic,
        sections=page,
        links=_links(page),
        home="index.html",
        values_page=content.values_page,
        is_part=True,
    )


_LAST = 10**9

_OF_TESTS = (
    "Strain is nominal strain of the splice-free length; stress is tension over the area at zero"
    " tension."
)

_OF_HOSES = (
    "Strain of a predicted hose is nominal strain of its whole relaxed length, ends included."
)

Name = tuple[tuple[int, int, str], ...]

Place = tuple[int, str, Name, bool, str, float, Name]


def write_report(
    processed: Path,
    out: Path,
    *,
    units: UnitSystem = "si",
    values_page: str = "",
    stray: Collection[str] = (),
    unreadable: Callable[[str, str], None] | None = None,
) -> Path:
    """Write the page of a campaign."""
    page = CampaignPage(processed, units=units, stray=stray)
    return page.write(out, values_page=values_page, unreadable=unreadable)[0]


class CampaignPage:
    """The page of a campaign, to which archives are added one by one, in any order.

    Other archives are opened when the page is written.
    """

    def __init__(
        self,
        processed: Path,
        *,
        units: UnitSystem = "si",
        stray: Collection[str] = (),
        opener: Opener = reading,
    ) -> None:
        self._processed, self._units, self._stray, self._opener = processed, units, stray, opener
        self._details = read_details(processed)
        self._statuses = _read_statuses(processed / "status.csv")
        self._by_test = {row.test: row for row in self._statuses}
        self._has_statuses = (processed / "status.csv").is_file()
        paths = sorted(archives_of_tests(processed), key=lambda path: natural_order(path.stem))
        self._keys = {path: f"test-{index}" for index, path in enumerate(paths)}
        self._tests: list[TestView] = []
        self._known: dict[str, str] = {}
        self._starts: dict[str, float] = {}
        self._rendered: dict[str, RenderedSection] = {}
        self._scratch = ScratchTexts()
        self._sections: dict[str, TestSection] = {}
        self._not_shown: dict[str, str] = {}

    def add(self, path: Path, data: xr.Dataset) -> None:
        """Add the section of a test; its samples are not kept."""
        try:
            name = data.attrs["test"]
            known = self._by_test.get(name)
            if known is None and self._has_statuses:
                known = Status(name, OF_NO_TEST)
            view = TestView(self._keys[path], data, self._units, known)
            section = make_section(view)
            rendered = render_section(section, is_folded=len(self._keys) > 1)
            self._rendered[view.key] = self._scratch.stored(rendered)
            if self._details is not None:
                self._sections[view.key] = section
            self._starts[view.key] = view.start_time
            view = view.without_samples()
            self._tests.append(view.of_campaign(self._known) if self._details is None else view)
        except ArchiveError as error:
            # the page does not depend on the location of the archives
            self._not_shown[path.name] = str(error).replace(str(path), path.name)

    def write(
        self,
        out: Path,
        *,
        values_page: str = "",
        unreadable: Callable[[str, str], None] | None = None,
        only: Collection[str] | None = None,
    ) -> tuple[Path, CampaignAnswers]:
        """Write the page, and return its answers for the tests in ``only``."""
        tests, not_shown = self._tests, self._not_shown
        self._add_others()
        by_id = {view.id: view for view in tests}
        tests.sort(key=lambda view: _place(view, by_id, self._starts))
        whole = read_campaign(
            self._processed, by_id, self._units, not_shown, self._stray, self._opener
        )
        if unreadable is not None:
            for name, why in not_shown.items():
                unreadable(name, why)
        content = replace(
            _page_of(tests, whole, self._statuses, not_shown, self._units, self._processed.name),
            values_page=values_page,
        )
        outcomes = [
            render_section(section, is_folded=len(self._keys) + len(whole.outcomes) > 1)
            for _, section in whole.outcomes
        ]
        own = [self._rendered[view.key] for view in tests]
        page = _write_pages(content, [*outcomes, *own], out)
        beside = out / CLIENT_PAGE_NAME
        if self._details is None:
            take_away(beside)  # from an earlier run: the campaign no longer has such a report
        else:
            of_client = ClientContent(
                self._details, tests, whole, [self._sections[view.key] for view in tests],
                self._statuses, content.faults, content.title, content.campaign, self._units,
            )  # fmt: skip
            write_text_atomically(beside, render_client_report(of_client))
        return page, _answers(tests, whole, self._statuses, not_shown, only)

    def _add_others(self) -> None:
        """Open the archives that were not added."""
        if not (self._keys or self._statuses or is_there(self._processed)):
            raise ArchiveError(
                "there is nothing to report on",
                found=f"neither an archive nor status.csv in {self._processed}",
                needed="the folder of a campaign, such as processed/CAMPAIGN",
                hint="Run the campaign first.",
            )
        for path, key in self._keys.items():
            if key in self._starts or path.name in self._not_shown:
                continue
            try:
                with self._opener(path) as data:
                    self.add(path, data)
            except ArchiveError as error:
                self._not_shown[path.name] = str(error).replace(str(path), path.name)


@dataclass(frozen=True)
class CampaignAnswers:
    """The answers of a campaign, and the points that a person has to check, most serious first.

    ``answered`` are the tests that have a row in the tables, ``withheld`` the reasons of the
    others, and of those whose row lacks its answer; else empty.
    """

    tables: tuple[PageTable, ...]
    is_synthetic: bool
    doubts: tuple[SummaryFinding, ...]
    answered: frozenset[str]
    withheld: Mapping[str, str]


def _answers(
    tests: list[TestView],
    whole: CampaignView,
    statuses: list[Status],
    not_shown: Mapping[str, str],
    only: Collection[str] | None,
) -> CampaignAnswers:
    """Return the first content of the page."""
    if only is not None:
        tests = [view for view in tests if view.id in only]
        statuses = [row for row in statuses if row.test in only]
    doubts = [
        one
        for one in find_faults(tests, statuses, not_shown, whole.findings)
        if one.severity == "warning"
    ]
    own = _answers_of(tests)
    answered = frozenset(row[1].text for table in own for row in table.rows)
    return CampaignAnswers(
        tables=(*whole.answers, *own),
        is_synthetic=any_synthetic(tests) or whole.is_synthetic,
        doubts=tuple(doubts),
        answered=answered,
        withheld={
            view.id: lacking_answer(view) if view.id in answered else _withheld(view)
            for view in tests
        },
    )


def _withheld(view: TestView) -> str:
    """Why a test has no answer: the first refusals in its notes."""
    refusals = [str(one) for one in view.notes if one.severity == "refusal"]
    return "; ".join(refusals[:_MOST_REFUSALS])


_MOST_REFUSALS = 2


def _answers_of(tests: Sequence[TestView]) -> list[PageTable]:
    """Return design moduli, pairs of tests that differ over the same strains, pulls, holds."""
    makers = (design_modulus_table, unlike_tests_table, pull_table, hold_table)
    return [table for make in makers if (table := make(tests)) is not None]


def _page_of(
    tests: Sequence[TestView],
    whole: CampaignView,
    statuses: Sequence[Status],
    unreadable: dict[str, str],
    units: UnitSystem,
    folder: str,
) -> Page:
    faults = find_faults(tests, statuses, unreadable, whole.findings)
    figures: dict[str, tuple[Callable[[Sequence[TestView]], Sequence[Figure]], ...]] = {
        "All tests in one figure": (draw_specimens_together, draw_all_moduli),
        "Ratios of moduli": (draw_ratios,),
        "Mean strain and amplitude": (draw_amplitude_pairs,),
        "Start against end": (draw_parts,),
        "Static against dynamic": (draw_static_dynamic,),
    }
    comparisons = [
        *(
            make_part(heading, [one.compact() for draw in draws for one in draw(tests)])
            for heading, draws in figures.items()
        ),
        *whole.comparisons,
    ]
    first, comparisons = _first_figure(tests, comparisons)
    intervals = [interval_table(view) for view in tests]
    speakers = [*tests, *whole.views]
    speaker = speakers[0] if speakers else None
    of_tests = tiles(tests, statuses, faults)
    if not (tests or statuses):
        of_tests = [one for one in of_tests if one.target == "wrong"]
    definitions = [_OF_TESTS] if tests or statuses or not whole.hoses else []
    definitions += [_OF_HOSES] if whole.hoses else []
    return Page(
        title=(speaker.attribute("title") if speaker else "") or f"Campaign {folder}",
        campaign=speaker.attribute("campaign") if speaker else folder,
        summary=summary_sentence(tests) or whole.summary,
        about=about_page(
            units,
            "the archives alone",
            in_si="Notes, settings and history are as in the archives, in SI.",
            institution=speaker.attribute("institution") if speaker else "",
            references=speaker.attribute("references") if speaker else "",
            definitions=definitions,
        ),
        tiles=whole.with_tiles(of_tests),
        faults=faults,
        chapters=whole.chapters,
        synthetic=any_synthetic(tests) or whole.is_synthetic,
        has_tests=bool(tests or statuses),
        specimens=specimen_table(tests),
        specimen_notes=specimen_notes(tests),
        instruments=instrument_table(tests, units),
        instrument_notes=instrument_sentences(tests),
        tests=test_table(tests, statuses),
        first=first,
        answers=[*whole.answers, *_answers_of(tests)],
        designs=design_tables(tests),
        segments=segment_table(tests),
        intervals=[table for table in intervals if table is not None],
        comparisons=[part for part in comparisons if part.figures],
        across="Across the tests" if tests else "Across the hoses",
    )


_FIRST_HEIGHT = 380
"""Height that keeps the answers on the first screen. [px]"""


def _first_figure(
    tests: Sequence[TestView], comparisons: Sequence[Part]
) -> tuple[Figure | None, list[Part]]:
    """Take the figure for the first screen out of the figures over several tests or hoses."""
    levels = draw_stiffness_levels(tests)
    if levels:
        return replace(levels[0], height=_FIRST_HEIGHT), list(comparisons)
    found = [place for place, part in enumerate(comparisons) if part.figures]
    if not found:
        return None, list(comparisons)
    # for hoses compared with their tests the comparison, which is the last figure
    place = found[-1] if comparisons[found[-1]].heading == ALL_COMPARISONS else found[0]
    part = comparisons[place]
    rest = [
        *comparisons[:place],
        replace(part, figures=part.figures[1:]),
        *comparisons[place + 1 :],
    ]
    return replace(part.figures[0], height=_FIRST_HEIGHT), rest


def _read_statuses(path: Path) -> list[Status]:
    if not path.is_file():
        return []
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ArchiveError(f"{path} cannot be read", found=str(error)) from error
    names = Status.__dataclass_fields__
    return [Status(**{name: bare_cell(row.get(name) or "") for name in names}) for row in rows]


def _place(view: TestView, by_id: Mapping[str, TestView], starts: Mapping[str, float]) -> Place:
    """Return the sort key of a test: by its order, followed by its parts in order of start."""
    name = view.attribute("part_of")
    whole = by_id.get(name or view.id)
    order = "" if whole is None else whole.attribute("test_order")
    return (
        int(order) if order.isdigit() else _LAST,
        "" if whole is None else whole.attribute("date"),
        natural_order(name or _log_of(view)),
        bool(name),
        view.attribute("date"),
        starts[view.key],
        natural_order(view.id),
    )


def _log_of(view: TestView) -> str:
    """Return the test that the log belongs to: for a step, its name before that of the step."""
    return view.id.partition(".")[0] if view.attribute("step") else view.id

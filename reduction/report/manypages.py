"""Sections of tests that are too many for one page: pages of their own, beside that one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from reduction.archive.whole import take_away
from reduction.archive.write import write_whole
from reduction.report.render import Link, Page, RenderedSection, render_page

MOST_BYTES = 9_000_000
"""Of the sections on a page: with the program that draws (4.9 MB) it stays below 15 MB. [1]"""
MOST_IN_ALL = 14_500_000
"""Of a page with all that stands on it. [1]"""
_NAME = "tests-{:02}.html"
_OWN = re.compile(r"tests-\d{2,}\.html")
"""Names that are given here: a page of somebody else beside them stays."""


def is_page_of_tests(name: str) -> bool:
    """Whether a file of this name holds sections for which the page of a campaign has no room."""
    return _OWN.fullmatch(name) is not None


def over_pages(
    sections: Sequence[RenderedSection], most: int = MOST_BYTES
) -> list[Sequence[RenderedSection]]:
    """Part sections into pages, in their order.

    Parameters
    ----------
    sections : sequence of RenderedSection
        All of them.
    most : int
        Bytes on a page; one that is longer by itself has a page of its own. [1]

    Returns
    -------
    pages : list of sequence of RenderedSection
        One where all have room together.

    Examples
    --------
    >>> sections = [RenderedSection(f"test-{n}", f"T-{n}", 40 * "x") for n in range(5)]
    >>> [len(page) for page in over_pages(sections, most=100)]
    [2, 2, 1]
    """
    pages: list[list[RenderedSection]] = [[]]
    held = 0
    for section in sections:
        size = len(section.html.encode("utf-8"))
        if pages[-1] and held + size > most:
            pages.append([])
            held = 0
        pages[-1].append(section)
        held += size
    return list(pages)


def write_pages(
    content: Page,
    sections: Sequence[RenderedSection],
    out: Path,
    most: int = MOST_BYTES,
    most_in_all: int = MOST_IN_ALL,
) -> Path:
    """Write the page of a campaign, and those beside it where it has no room for all sections.

    Parameters
    ----------
    content : Page
        Without sections.
    sections : sequence of RenderedSection
        Of its tests, in order.
    out : pathlib.Path
        Folder of the pages.
    most : int
        Bytes of sections on a page. [1]
    most_in_all : int
        Bytes of the page of the campaign, from which its sections stand beside it. [1]

    Returns
    -------
    page : pathlib.Path
        ``index.html``, which is written last; pages of an earlier run that it does not name are
        taken away.

    Raises
    ------
    ArchiveError
        If the disk refuses.
    """
    pages = over_pages(sections, most)
    index = out / "index.html"
    kept: set[Path] = set()
    text = ""
    if len(pages) == 1:
        text = render_page(replace(content, sections=pages[0], links=_links(pages[0])))
    # tables and figures over all tests take room, too
    if len(pages) > 1 or (pages[0] and len(text.encode("utf-8")) > most_in_all):
        names = [_NAME.format(number) for number in range(1, len(pages) + 1)]
        beside = [Link(name, _words(page)) for name, page in zip(names, pages, strict=True)]
        for name, page in zip(names, pages, strict=True):
            write_whole(out / name, render_page(_part_of(content, page, beside)))
            kept.add(out / name)
        links = [
            link for name, page in zip(names, pages, strict=True) for link in _links(page, name)
        ]
        text = render_page(replace(content, links=links, beside=beside))
    write_whole(index, text)
    for path in out.iterdir():
        if is_page_of_tests(path.name) and path not in kept:
            take_away(path)
    return index


def _links(page: Sequence[RenderedSection], name: str = "") -> list[Link]:
    return [Link(f"{name}#{section.key}", section.title) for section in page]


def _words(page: Sequence[RenderedSection]) -> str:
    if len(page) == 1:
        return page[0].title
    return f"{page[0].title} to {page[-1].title} ({len(page)} tests)"


def _part_of(content: Page, page: Sequence[RenderedSection], beside: Sequence[Link]) -> Page:
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

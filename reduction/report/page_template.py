"""The page made from its template.

Nothing is fetched: plotly is contained in the page once as text, and is read after the page has
loaded.  Figures are deflated JSON beside their captions and are drawn when they come into view.
Names from files are escaped wherever they appear, in the text by the template and in the
figures by `reduction.report.figure_data`.
"""

from __future__ import annotations

import zlib
from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files

from jinja2 import Environment, PackageLoader, StrictUndefined
from plotly.offline import get_plotlyjs

from reduction import __version__
from reduction.archive.scratch_file import ScratchFile
from reduction.quantities.units import UnitSystem
from reduction.record.notes import first_clauses
from reduction.report.campaign_summary import SummaryFinding, Tile
from reduction.report.figure_data import Figure
from reduction.report.test_section import Part, TestSection
from reduction.report.text_style import PageTable

_SCRIPTS = ("inflate", "figures", "cycles", "downloads", "contents")


@dataclass(frozen=True)
class Link:
    """An address on this page or in its folder, and the text shown for it."""

    target: str
    words: str


@dataclass(frozen=True)
class RenderedSection:
    """The section of one test as HTML, in which figures take no more memory than on the page."""

    key: str
    title: str
    text: str | _StoredText

    @property
    def html(self) -> str:
        """The section, read again where it was stored on disk."""
        return self.text if isinstance(self.text, str) else self.text.read()

    @property
    def n_bytes(self) -> int:
        """Size of the section on a page."""
        return len(self.text.encode()) if isinstance(self.text, str) else self.text.n_bytes


class ScratchTexts:
    """Texts on disk until a page is written, since memory cannot hold a thousand sections."""

    def __init__(self) -> None:
        self._file = ScratchFile()

    def stored(self, section: RenderedSection) -> RenderedSection:
        """Store the text of a section on disk."""
        place = self._file.put(section.html.encode())
        return replace(section, text=_StoredText(self._file, place))


@dataclass(frozen=True)
class _StoredText:
    """One of the texts on disk."""

    file: ScratchFile
    place: slice

    @property
    def n_bytes(self) -> int:
        """Length of the text as UTF-8."""
        return int(self.place.stop - self.place.start)

    def read(self) -> str:
        """The text."""
        return self.file.get(self.place).decode()


@dataclass(frozen=True)
class Page:
    """Content of a page, from top to bottom; all texts are plain.

    Parameters
    ----------
    title, campaign, summary : str
        Texts for the whole page; ``campaign`` heads the list of contents.
    about : sequence of str
        Sentences under the numbers at the top.
    tiles : sequence of Tile
        Numbers at the top.
    faults : sequence of SummaryFinding
        What a reader must know first, most serious first.
    chapters : sequence of TestSection
        Sections that follow.
    synthetic : bool
        Whether the banner says that no specimen was ever pulled.
    has_tests : bool
        Whether it is a page of tests; the fields that follow are used only then.
    specimens, tests, segments : PageTable or None
        Tested specimens and tests, and straight-line segments.
    specimen_notes : sequence of str
        Notes under the specimens.
    instruments : PageTable or None
        Stated instrument errors; ``instrument_notes`` where there are none.
    first : Figure or None
        Figure at the top.
    answers, designs, intervals : sequence of PageTable
        The rest of the first screen.
    comparisons : sequence of Part
        Figures over several items of a kind, headed by ``across``.
    sections : sequence of RenderedSection
        One per test.
    links : sequence of Link
        Entries of the list of contents below the headings: sections here or on the other pages.
    beside : sequence of Link
        Further pages with the sections that this one has no room for.
    home : str
        Target of the name at the head of the contents.
    values_page : str
        Address of the page of design values; empty where there is none.
    is_part : bool
        Whether it is such a further page; the main page then shows what is wrong.
    """

    title: str
    campaign: str
    summary: str
    about: Sequence[str]
    tiles: Sequence[Tile]
    faults: Sequence[SummaryFinding]
    chapters: Sequence[TestSection]
    synthetic: bool = False
    has_tests: bool = False
    specimens: PageTable | None = None
    specimen_notes: Sequence[str] = ()
    tests: PageTable | None = None
    instruments: PageTable | None = None
    instrument_notes: Sequence[str] = ()
    first: Figure | None = None
    answers: Sequence[PageTable] = ()
    designs: Sequence[PageTable] = ()
    segments: PageTable | None = None
    intervals: Sequence[PageTable] = ()
    comparisons: Sequence[Part] = ()
    across: str = ""
    sections: Sequence[RenderedSection] = ()
    links: Sequence[Link] = ()
    beside: Sequence[Link] = ()
    home: str = "#top"
    values_page: str = ""
    is_part: bool = False


def about_page(
    units: UnitSystem,
    made_from: str,
    *,
    in_si: str = "",
    institution: str = "",
    references: str = "",
    definitions: Sequence[str] = (),
) -> list[str]:
    """Return the sentences on the units of a page and its source."""
    is_us = units == "us"
    found = [f"Units: {'US customary' if is_us else 'SI'}."]
    if is_us and in_si:
        found.append(in_si)
    found += [
        f"{name}: {text}."
        for name, text in (("Laboratory", institution.rstrip(".")), ("Reference", references))
        if text
    ]
    return [*found, f"Made by mooring-reduction {__version__} from {made_from}.", *definitions]


def _packed(text: str) -> tuple[str, int]:
    """Return text deflated, in base64, and its length as UTF-8: a page has to stay small.

    Examples
    --------
    >>> text, size = _packed("nought " * 100)
    >>> size, len(text) < 40
    (700, True)
    """
    content = text.encode("utf-8")
    packer = zlib.compressobj(6, zlib.DEFLATED, -zlib.MAX_WBITS)
    return b64encode(packer.compress(content) + packer.flush()).decode("ascii"), len(content)


def render_section(section: TestSection, *, is_folded: bool) -> RenderedSection:
    """Return the section of one test as HTML; a folded one opens by a click."""
    macros = _environment().get_template("section.html").module
    html = str(macros.chapter(section, is_folded))  # type: ignore[attr-defined]
    return RenderedSection(section.key, section.title, html)


_PIECE = 1 << 18  # characters


def render_page(page: Page) -> list[bytes]:
    """Return a page as HTML that opens from disk, in pieces, since it may have 15 MB."""
    room = files("reduction.report")
    plotly = get_plotlyjs()
    # with one wide letter a text takes four bytes per letter, and this one has 5 million
    slices = [plotly[first : first + _PIECE] for first in range(0, len(plotly), _PIECE)]
    del plotly
    found, waiting, n_waiting = [], [], 0
    for text in (
        _environment()
        .get_template("page.html")
        .generate(
            **{name: getattr(page, name) for name in Page.__dataclass_fields__},
            style=(room / "static" / "page.css").read_text("utf-8"),
            script="\n".join(
                (room / "static" / f"{name}.js").read_text("utf-8") for name in _SCRIPTS
            ),
            plotly=slices,
        )
    ):
        waiting.append(text)
        n_waiting += len(text)
        if n_waiting >= _PIECE:
            found.append("".join(waiting).encode("utf-8"))
            waiting, n_waiting = [], 0
    found.append("".join(waiting).encode("utf-8"))
    return found


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("reduction.report"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.globals["packed"] = _packed
    environment.filters["clauses"] = first_clauses
    return environment

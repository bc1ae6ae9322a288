"""The page made from its template.

Nothing is fetched: plotly stands in the page once as text and is read when the page is there,
figures are deflated JSON beside their captions and are drawn when a reader comes to them.
Names out of files are escaped wherever they show, in the text by the template and in the
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
from plotly.offline import get_plotlyjs  # type: ignore[import-untyped]

from reduction import __version__
from reduction.archive.scratch_file import ScratchFile
from reduction.quantities.units import UnitSystem
from reduction.report.campaign_summary import SummaryFinding, Tile
from reduction.report.figure_data import Figure
from reduction.report.test_section import Part, TestSection
from reduction.report.text_style import PageTable

_SCRIPTS = ("inflate", "figures", "cycles", "downloads", "contents")


@dataclass(frozen=True)
class Link:
    """An address in this page or beside it, and what a reader is shown of it."""

    target: str
    words: str


@dataclass(frozen=True)
class RenderedSection:
    """The section of one test as HTML: its figures are no more in memory than on the page."""

    key: str
    title: str
    text: str | _StoredText

    @property
    def html(self) -> str:
        """The section, read again where it was put on disk."""
        return self.text if isinstance(self.text, str) else self.text.read()

    @property
    def n_bytes(self) -> int:
        """Of the section on a page."""
        return len(self.text.encode()) if isinstance(self.text, str) else self.text.n_bytes


class ScratchTexts:
    """Texts on disk until a page is written: memory has no room for a thousand sections."""

    def __init__(self) -> None:
        self._file = ScratchFile()

    def stored(self, section: RenderedSection) -> RenderedSection:
        """Put the text of a section on disk."""
        place = self._file.put(section.html.encode())
        return replace(section, text=_StoredText(self._file, place))


@dataclass(frozen=True)
class _StoredText:
    """One of the texts on disk."""

    file: ScratchFile
    place: slice

    @property
    def n_bytes(self) -> int:
        """Its length as UTF-8."""
        return int(self.place.stop - self.place.start)

    def read(self) -> str:
        """The text."""
        return self.file.get(self.place).decode()


@dataclass(frozen=True)
class Page:
    """What stands on a page, from the top down; all texts are plain.

    Parameters
    ----------
    title, campaign, summary : str
        Of the whole; ``campaign`` heads the list of contents.
    about : sequence of str
        Sentences under the numbers at the top.
    tiles : sequence of Tile
        Those numbers.
    faults : sequence of Finding
        What a reader must know first, most serious first.
    chapters : sequence of Section
        What follows.
    synthetic : bool
        Whether the banner says that no specimen was ever pulled.
    has_tests : bool
        Whether it is a page of tests; the fields behind it are for those alone.
    specimens, tests, segments : Table or None
        What was tested, and straight-line segments.
    specimen_notes : sequence of str
        Under the specimens.
    instruments : Table or None
        What is stated of the instruments; ``instrument_notes`` where nothing is.
    first : Figure or None
        What stands first of all.
    answers, designs, intervals : sequence of Table
        The rest of the first screen.
    comparisons : sequence of Part
        Figures over several of a kind, headed by ``across``.
    sections : sequence of RenderedSection
        One a test.
    links : sequence of Link
        Behind the headings in the list of contents: to these, or to those of the pages beside.
    beside : sequence of Link
        Pages that hold the sections which this one has no room for.
    home : str
        Where the name at the head of the contents leads.
    values_page : str
        Address of the page of design values; empty where there is none.
    is_part : bool
        Whether it is such a page beside another, which says what is wrong.
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
    """Return the sentences that say in which units a page is and what it was made from."""
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
    """Return the section of one test as HTML; one that is folded opens by a click."""
    macros = _environment().get_template("section.html").module
    html = str(macros.chapter(section, is_folded))  # type: ignore[attr-defined]
    return RenderedSection(section.key, section.title, html)


_PIECE = 1 << 18  # characters


def render_page(page: Page) -> list[bytes]:
    """Return a page as HTML that opens from disk, in pieces: it may have 15 MB."""
    room = files("reduction.report")
    plotly = get_plotlyjs()
    # a text with one wide letter has four bytes for each, and this one has 5 million letters
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
    return environment

"""Figures of the report to a client, and which parts of the sections of the tests it shows."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from markupsafe import Markup

from reduction.report.figure import Figure
from reduction.report.figures.campaign import draw_all_moduli
from reduction.report.section import Part, Section
from reduction.report.vector import can_be_drawn, vector_of
from reduction.report.view import TestView

_TWO_PANELS = 1.25
_BANDS = (
    " Bands: ± expanded uncertainty, the inner of scatter alone, the outer of all that is known."
)
_HOLDS = "Holds"
_OF_HOLDS = ("relaxation", "creep")
_FIGURES = ("Modulus against strain", "Loops", "Slow pull", "Stepwise readings", _HOLDS)


@dataclass(frozen=True)
class Drawing:
    """A figure with its caption; a wide one takes the whole width of the page."""

    vector: Markup
    caption: str
    is_wide: bool = False


def drawings(figures: Collection[tuple[Figure, bool]]) -> list[Drawing]:
    """Return the figures that can be drawn; ``True`` beside one asks for the whole width."""
    return [_drawing(one, is_wide=wide) for one, wide in figures if can_be_drawn(one)]


def not_drawn(figures: Collection[tuple[Figure, bool]]) -> list[str]:
    """Return the titles of the others."""
    return [one.title for one, _ in figures if not can_be_drawn(one)]


def chosen_figures(
    tests: Sequence[TestView], sections: Sequence[Section]
) -> Iterator[tuple[Figure, bool]]:
    """Give what is to be drawn, and whether it takes the whole width."""
    for one in draw_all_moduli(tests):
        yield one, True
    for _, part in chosen_parts(tests, sections, _FIGURES):
        for one in part.figures:
            yield one, False


def _drawing(figure: Figure, *, is_wide: bool) -> Drawing:
    width, height = (680.0, 360.0) if is_wide else (440.0, 225.0)
    if "yaxis2" in figure.layout:
        height *= _TWO_PANELS
    caption, *about = figure.caption.split(" Inner band:")
    caption += _BANDS if about else ""
    # the drawing escapes what it is given
    drawn = Markup(vector_of(figure, width=width, height=height))  # noqa: S704
    return Drawing(drawn, caption, is_wide)


def chosen_parts(
    tests: Sequence[TestView], sections: Sequence[Section], headings: Collection[str]
) -> Iterator[tuple[Section, Part]]:
    """Give parts of the sections of the tests; of holds those that a test was made for."""
    kinds = {view.key: view.kind for view in tests}
    for section in sections:
        for part in section.parts:
            is_asked = part.heading in headings
            if is_asked and (part.heading != _HOLDS or kinds.get(section.key) in _OF_HOLDS):
                yield section, part

"""Search of lines: words, sizes, and what is said where there is none."""

import pytest

from reduction.lines.line_search import find_lines
from reduction.lines.lookup_product import LineSource
from reduction.lines.published_source import published_sources
from reduction.record.errors import SettingsError

INCH = 0.0254
NAN = float("nan")
LINES = [
    LineSource("a", "r", "Nylon 6", "8-strand plaited", "new", 0.5 * INCH, 28e3),
    LineSource("b", "r", "nylon", "double braid", "4 years", 0.5 * INCH, 28e3),
    LineSource("c", "r", "polyester", "double braid", "40 cycles", NAN, 28e3),
]


def names(found):
    return [one.name for one in found]


def test_the_four_together_name_one_published_line():
    found = find_lines(
        published_sources().values(), material="nylon", construction="double braid",
        diameter=0.5 * INCH, condition="new",
    )  # fmt: skip
    assert names(found) == ["nylon-double-braid-0.5in-new"]


def test_published_lines_by_one_of_them_alone():
    lines = published_sources().values()
    # Tables 1 and 2 of CG-D-39-80: double-braided nylon of four sizes, 1/2 in aged as well
    braids = find_lines(lines, material="NYLON", construction="Braid")
    assert names(braids) == [
        *(f"nylon-double-braid-{size}in-new" for size in ("0.5", "0.75", "1", "1.25")),
        "nylon-double-braid-0.5in-5-years",
    ]
    # six tests of the used tether of WHOI-2005-10, and T-4 again after 3,000 cycles
    assert len(find_lines(lines, material="rubber", condition="used")) == 7
    assert names(find_lines(lines, condition="new 3000")) == [
        "rubber-tether-new-T-4-after-3000-cycles"
    ]
    assert {one.condition for one in find_lines(lines, condition="years")} == {"4 years", "5 years"}


def test_words_are_found_in_any_case_and_order_and_by_their_beginning():
    assert names(find_lines(LINES, material="nylon")) == ["a", "b"]
    assert names(find_lines(LINES, construction="plait 8 STRAND")) == ["a"]
    assert names(find_lines(LINES, construction="8-strand")) == ["a"]


def test_a_number_is_found_whole():
    assert names(find_lines(LINES, condition="4")) == ["b"]


def test_nothing_asked_for_finds_all():
    assert find_lines(LINES) == LINES


@pytest.mark.parametrize(
    ("diameter", "tolerance", "count"),
    [
        (0.013, 0.03, 2),  # 12.7 mm is 2.3 % off
        (0.012, 0.03, 0),  # 5.8 %
        (0.012, 0.06, 2),
        (0.5 * INCH, 0.0, 2),
        (9 / 16 * INCH, 0.03, 0),  # the next size: 11 %
    ],
)
def test_a_diameter_is_found_within_the_tolerance(diameter, tolerance, count):
    if count:
        assert len(find_lines(LINES, diameter=diameter, tolerance=tolerance)) == count
    else:
        with pytest.raises(SettingsError, match="no line matches; found diameter"):
            find_lines(LINES, diameter=diameter, tolerance=tolerance)


def test_what_there_is_is_told_where_nothing_is_found():
    with pytest.raises(SettingsError) as caught:
        find_lines(LINES, material="aramid", diameter=0.02)
    assert caught.value.found == "material 'aramid'; diameter 20 mm within 3 %"
    assert caught.value.needed == (
        "material Nylon 6 or nylon or polyester; construction 8-strand plaited or double braid; "
        "condition new or 4 years or 40 cycles; diameter 12.7 mm"
    )
    bare = [LineSource("d", "r", "", "", "", NAN, NAN)]
    with pytest.raises(SettingsError, match="needed lines of which more is known"):
        find_lines(bare, material="nylon")


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"diameter": 0.0}, "a diameter is not positive; found 0 m"),
        ({"diameter": 0.01, "tolerance": -0.1}, "tolerance of a diameter is negative; found -0.1"),
    ],
)
def test_sizes_that_are_none_are_refused(asked, message):
    with pytest.raises(SettingsError, match=message):
        find_lines(LINES, **asked)

"""A campaign of more tests than one page has room for has pages beside it."""

import re
from dataclasses import replace

import pytest

from reduction.report.campaign_page import _over_pages, _write_pages
from reduction.report.page_template import Page, RenderedSection
from reduction.report.text_style import PageTable, TableCell

CONTENT = Page(
    title="Many <tests>", campaign="many", summary="", about=["Units: SI."], tiles=(), faults=(),
    chapters=(), synthetic=True, has_tests=False,
)  # fmt: skip


def sections(n_sections, size=100):
    return [
        RenderedSection(f"test-{n}", f"T<{n}>", f"<p id=test-{n}>{'é' * (size // 2)}</p>")
        for n in range(n_sections)
    ]


def links(page):
    return re.findall(r'href="([^"]+)"', page.read_text())


def test_what_has_room_on_one_page_stays_there(tmp_path):
    page = _write_pages(CONTENT, sections(3), tmp_path)
    assert [one.name for one in tmp_path.iterdir()] == ["index.html"]
    text = page.read_text()
    assert all(f"<p id=test-{n}>" in text for n in range(3))
    assert {"#test-0", "#test-1", "#test-2"} <= set(links(page))


def test_every_section_is_on_one_page_and_the_contents_lead_to_it(tmp_path):
    page = _write_pages(CONTENT, sections(5), tmp_path, most=250)
    names = ["tests-01.html", "tests-02.html", "tests-03.html"]
    assert sorted(one.name for one in tmp_path.iterdir()) == ["index.html", *names]
    assert "<p id=test-" not in page.read_text()
    for n, name in enumerate([names[0], names[0], names[1], names[1], names[2]]):
        assert f"{name}#test-{n}" in links(page)
        assert f"<p id=test-{n}>" in (tmp_path / name).read_text()
    assert set(names) <= set(links(page))
    assert "T&lt;0&gt; to T&lt;1&gt; (2 tests)" in page.read_text()


def test_a_page_beside_leads_back_and_says_what_it_is(tmp_path):
    _write_pages(CONTENT, sections(3), tmp_path, most=250)
    text = (tmp_path / "tests-02.html").read_text()
    assert '<a class="home" href="index.html">many</a>' in text
    assert "<h1>Many &lt;tests&gt;: T&lt;2&gt;</h1>" in text
    assert "SYNTHETIC DATA" in text and "Anything wrong" not in text


def test_a_section_that_is_longer_than_a_page_has_one_of_its_own():
    given = sections(3)
    given[1] = RenderedSection("test-1", "long", 900 * "x")
    assert [[one.title for one in page] for page in _over_pages(given, most=250)] == [
        ["T<0>"], ["long"], ["T<2>"],
    ]  # fmt: skip


@pytest.mark.parametrize("n_sections", [0, 1])
def test_few_sections_are_one_page(n_sections):
    assert [len(page) for page in _over_pages(sections(n_sections), most=1)] == [n_sections]


def test_pages_of_an_earlier_run_are_taken_away(tmp_path):
    _write_pages(CONTENT, sections(5), tmp_path, most=250)
    (tmp_path / "tests-of-mine.txt").write_text("kept")
    _write_pages(CONTENT, sections(3), tmp_path, most=250)
    assert sorted(one.name for one in tmp_path.iterdir()) == [
        "index.html", "tests-01.html", "tests-02.html", "tests-of-mine.txt",
    ]  # fmt: skip


def test_a_page_of_somebody_else_is_not_taken_away(tmp_path):
    for name in ("tests-of-mine.html", "tests-1.html", "mytests-02.html", "tests-07.html"):
        (tmp_path / name).write_text("kept")
    _write_pages(CONTENT, sections(1), tmp_path)
    # seven of two digits is a name that is given here
    assert sorted(one.name for one in tmp_path.iterdir()) == [
        "index.html", "mytests-02.html", "tests-1.html", "tests-of-mine.html",
    ]  # fmt: skip


def test_sections_that_have_room_together_but_not_beside_the_rest_stand_on_a_page_of_their_own(
    tmp_path,
):
    alone = _write_pages(CONTENT, [], tmp_path / "alone").stat().st_size
    page = _write_pages(CONTENT, sections(3), tmp_path / "r", most_in_all=alone + 250)
    names = sorted(one.name for one in page.parent.iterdir())
    assert names == ["index.html", "tests-01.html"]
    assert "<p id=test-" not in page.read_text()
    assert {f"tests-01.html#test-{n}" for n in range(3)} <= set(links(page))
    text = (page.parent / "tests-01.html").read_text()
    assert all(f"<p id=test-{n}>" in text for n in range(3))
    # nothing is gained where there is no section to move
    assert _write_pages(CONTENT, [], tmp_path / "none", most_in_all=1).exists()
    assert not (tmp_path / "none" / "tests-01.html").exists()


def test_segments_of_many_tests_are_left_to_the_section_of_each(tmp_path):
    row = (TableCell("T-1"), TableCell("1.2"))
    pieces, other = (
        PageTable(name, ("test", "E"), (row,) * 40) for name in ("straight pieces", "all tests")
    )
    content = replace(CONTENT, has_tests=True, segments=pieces, specimens=other, tests=other)
    page = _write_pages(content, sections(3), tmp_path, most=250)
    assert "straight pieces" in page.read_text()
    short = _write_pages(content, sections(3), tmp_path, most=250, most_in_all=100).read_text()
    assert "straight pieces" not in short and "all tests" in short
    assert "The straight-line segments of each test are in its section" in short

"""What a report page is on paper: whole, on white, and without a reader having drawn anything."""

import re
import shutil
import subprocess

import pytest

SHEETS = {"A4": 680, "Letter": 702}
"""Width of a sheet inside its margins of 15 mm, in CSS pixels."""
CUT = """width => {
  const wide = element => Math.ceil(element.getBoundingClientRect().right);
  return [...document.querySelectorAll("main table, main figure, main .main-svg, main pre")]
    .filter(element => element.checkVisibility() && wide(element) > width)
    .map(element => `${element.closest("[id]").id} ${wide(element)}`);
}"""


@pytest.mark.parametrize("paper", ["A4", pytest.param("Letter", marks=pytest.mark.nightly)])
def test_nothing_is_wider_than_the_sheet_and_all_is_there(paper, small, visit):
    width = SHEETS[paper]
    shown = visit(small.page, width=width, dark=True)
    page = shown.page
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("details.chapter:not([open])").count() == 0
    assert page.locator(".plot").count() == page.locator(".plot.js-plotly-plot").count() > 0
    assert page.evaluate(CUT, width) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    colours = page.evaluate(
        "[...new Set([...document.querySelectorAll('.plot')].map(plot => plot.layout.paper_bgcolor))]"
    )
    assert colours == ["#fff"]
    for control in ("nav", ".save", ".cycles input", ".modebar-container"):
        assert page.locator(control).first.is_hidden()
    page.emulate_media(media="screen")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("details.chapter[open]").count() == 0
    assert shown.errors == []


@pytest.mark.nightly
def test_figures_that_are_put_away_while_they_are_drawn_are_put_away(small, visit):
    shown = visit(small.page)
    page = shown.page
    page.evaluate(
        "for (const moment of ['beforeprint', 'afterprint']) dispatchEvent(new Event(moment))"
    )
    page.locator("details.chapter .main-svg").first.wait_for(state="detached")
    page.evaluate("new Promise(done => setTimeout(done, 500))")
    assert shown.errors == []


@pytest.mark.nightly
def test_a_column_headed_by_a_long_name_is_not_cut_off(small, visit):
    shown = visit(small.page)
    page = shown.page
    page.evaluate(
        """() => document.querySelectorAll("main table").forEach(table => {
             for (const head of [...table.tHead.rows[0].cells].slice(1, 4)) head.textContent = "N".repeat(100); })"""
    )
    # a printer asks while the page still has the rules of the screen
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    page.emulate_media(media="print")
    page.set_viewport_size({"width": SHEETS["A4"], "height": 900})
    assert page.evaluate(CUT, SHEETS["A4"]) == []
    smallest = page.evaluate(
        "Math.min(...[...document.querySelectorAll('main table')].map(one => parseFloat(getComputedStyle(one).fontSize)))"
    )
    assert smallest > 4  # CSS pixels


@pytest.mark.nightly
def test_a_reader_who_opens_the_page_and_prints_it_has_every_section_and_figure(
    small, visit, tmp_path
):
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext is not on the path")
    shown = visit(small.page, dark=True)
    path = tmp_path / "report.pdf"
    shown.page.pdf(path=path, format="A4")
    done = subprocess.run(
        [shutil.which("pdftotext"), "-layout", path, "-"], capture_output=True, check=True
    )
    sheets = done.stdout.decode().split("\f")[:-1]
    text = " ".join(" ".join(sheets).split())
    for words in ("T02.b: record", "T02.b: modulus, one", "T01: shares of the variance, one"):
        assert words in text
    assert re.search(rf"\b1 of {len(sheets)}$", sheets[0].rstrip())
    # a heading is not the last line of a sheet: what it is of follows it
    last = [sheet.rstrip().splitlines()[-2].strip() for sheet in sheets]
    assert not set(last) & {"Record", "Loops", "Cycle by cycle", "Holds", "First loading"}


@pytest.mark.nightly
def test_the_chosen_cycle_stays_chosen_on_paper(small, visit):
    shown = visit(small.page)
    section = shown.open_section("T01")
    section.get_by_role("spinbutton").fill("6")
    section.get_by_role("spinbutton").press("Enter")
    shown.page.emulate_media(media="print")
    shown.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert section.get_by_text("Cycle 6 of 12").is_visible()
    shapes = shown.page.evaluate("document.querySelector('#test-0-record .plot').layout.shapes")
    assert "cycle 6" in [one.get("name") for one in shapes]

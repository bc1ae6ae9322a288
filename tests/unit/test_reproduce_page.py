"""The page of reproduced numbers: every cell with its verdict, and nothing fetched."""

import re
from collections import Counter
from dataclasses import replace
from functools import cache
from html.parser import HTMLParser

import pytest
from reproduced import whole

from reduction.published.printed_cells import REPORTS, cells_of, errata_of, printed_step
from reduction.published.reproduce_page import (
    TITLES,
    VERDICTS,
    number_beside,
    render_reproduction,
)
from reduction.published.reproduced_item import ReproducedItem

VOID = {"meta", "input", "link", "br", "wbr"}


class Read(HTMLParser):
    """Tags with their attributes, in order, and whether they close as they open."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.open, self.text = [], [], ""
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data if self.open[-1:] not in (["script"], ["style"]) else ""


@cache
def html():
    return render_reproduction(whole())


@cache
def page():
    return Read(html())


def test_tags_close_and_ids_are_unique():
    assert page().open == []
    ids = [attrs["id"] for _, attrs in page().tags if "id" in attrs]
    assert [one for one, n in Counter(ids).items() if n > 1] == []


def test_every_cell_stands_on_the_page_with_its_verdict():
    shown = Counter(attrs["data-verdict"] for tag, attrs in page().tags if "data-verdict" in attrs)
    assert shown == Counter(item.verdict for items in whole().values() for item in items)


def test_links_lead_to_an_id_of_the_page():
    ids = {attrs["id"] for _, attrs in page().tags if "id" in attrs}
    links = [attrs["href"] for tag, attrs in page().tags if tag == "a"]
    assert all(link.startswith("#") and link[1:] in ids for link in links)
    assert {one.id for report in REPORTS for one in errata_of(report)} <= ids


def test_nothing_is_fetched():
    assert not [tag for tag, attrs in page().tags if "src" in attrs or tag in ("link", "iframe")]
    assert "default-src 'none'" in html()
    assert not re.search(r"url\(|@import|https?://", html())


def test_the_filter_knows_reports_and_verdicts():
    options = re.findall(r"<option[^>]*>([^<]*)</option>", html())
    assert options == ["all", *REPORTS]
    ticks = [a["value"] for tag, a in page().tags if tag == "input" and a.get("name") == "verdict"]
    assert ticks == list(VERDICTS)
    # without a script there is no filter, and everything is shown
    (form,) = (attrs for tag, attrs in page().tags if tag == "form")
    assert "hidden" in form


def test_each_report_has_its_title():
    assert TITLES.keys() == set(REPORTS)
    assert all(title in page().text for title in TITLES.values())


def test_a_tolerance_wider_than_half_the_last_digit_is_told():
    wide = sum(
        item.verdict in ("derived", "closed", "repeated")
        and item.tolerance > 0.501 * printed_step(item.cell.printed) > 0
        for items in whole().values()
        for item in items
    )
    assert page().text.count("Held within ") == wide and "Held within 0.3." in page().text


def test_parts_of_a_report_are_no_tables_and_long_names_may_break():
    assert "CG-D-39-80, App B" in page().text and "CG-D-39-80, Table A-2" in page().text
    assert "Table App" not in page().text
    assert "<td>apparent_<wbr>spring_<wbr>constant B1</td>" in html()


def test_words_of_a_cell_are_no_markup_and_an_unexplained_cell_stands_out():
    cell = replace(cells_of("Wang-2022")[0], row="<b>steel</b>", column="<i>modulus", note="a & b")
    html = render_reproduction({"Wang-2022": [ReproducedItem(cell, 1.0, "unexplained", "x < y")]})
    assert (
        "&lt;b&gt;steel" in html
        and "&lt;i&gt;modulus" in html
        and "a &amp; b" in html
        and "x &lt; y" in html
    )
    assert re.search(r'<a href="#filter" data-only="unexplained" class=bad>', html)
    # errata of the report without a cell here are named
    assert "No single cell: WA-1, WA-2" in html


@pytest.mark.parametrize(
    ("value", "printed", "text"),
    [
        (84.2132, "84.21", "84.2132"),
        (1020.0, "about 1,000", "1,020.00"),
        (3.2612e-11, "3.26e-11", "3.2612e-11"),
        (1e-16, "0.02", "0"),
        (0.34202, "fr", "0.34202"),
        (float("nan"), "1", ""),
        (2.5e12, "2", "2.5e+12"),
    ],
)
def test_a_recomputed_number_has_two_digits_more(value, printed, text):
    assert number_beside(value, printed) == text

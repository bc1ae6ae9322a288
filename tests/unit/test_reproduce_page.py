"""The page of reproduced numbers: every cell with its verdict, and nothing fetched."""

import csv
import io
import math
import re
from collections import Counter
from dataclasses import replace
from functools import cache
from html.parser import HTMLParser

import pytest
from misprinted import misprint
from reproduced import whole

from reduction.published.printed_cells import (
    REPORTS,
    Cell,
    cells_of,
    errata_of,
    number_of,
    printed_step,
)
from reduction.published.reproduce_page import (
    TITLES,
    VERDICTS,
    counts_by_table,
    counts_of,
    csv_of,
    number_beside,
    render_reproduction,
    reproduce,
    touched_errata,
)
from reduction.published.reproduced_item import (
    DETECTED,
    Answer,
    ReproducedItem,
    item_of,
    items_from,
    judge_as,
    judge_limit,
    judge_round,
    judge_word,
    last_counted_place,
)
from reduction.record.errors import DataError

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


# all reports again: the counts, the errata with their cells, the table of items


def test_all_five_reports_are_there_with_every_cell():
    assert tuple(whole()) == REPORTS
    for report, items in whole().items():
        assert {item.cell for item in items} == set(cells_of(report))
        assert len(items) == len(cells_of(report))


def test_one_report_alone():
    (found,) = reproduce("Wang-2022").items()
    assert found[0] == "Wang-2022"
    assert [(one.cell, one.verdict) for one in found[1]] == [
        (one.cell, one.verdict) for one in whole()["Wang-2022"]
    ]


@pytest.mark.parametrize("report", REPORTS)
def test_no_cell_is_unexplained(report):
    assert [one.cell.key for one in whole()[report] if one.verdict == "unexplained"] == []


@pytest.mark.parametrize("report", REPORTS)
def test_counts_add_up(report):
    counts = counts_of(whole()[report])
    assert list(counts) == ["cells", *VERDICTS]
    assert counts["cells"] == len(cells_of(report)) == sum(counts[one] for one in VERDICTS)
    tables = counts_by_table(whole()[report])
    assert {name: sum(one[name] for one in tables.values()) for name in counts} == counts


@pytest.mark.parametrize("report", REPORTS)
def test_touched_errata_hold_every_cell_that_names_them(report):
    found = touched_errata(report, whole()[report])
    assert [one.erratum for one in found] == list(errata_of(report))
    named = [item for item in whole()[report] if item.cell.erratum]
    assert sum(len(one.items) for one in found) == len(named)
    assert all(item.cell.erratum == one.erratum.id for one in found for item in one.items)


@pytest.mark.parametrize("report", REPORTS)
def test_a_wrong_cell_says_which_erratum_and_each_item_says_how(report):
    for item in whole()[report]:
        assert item.how
        assert item.cell.erratum or item.verdict != "erratum"


def test_the_table_of_items_gives_every_number_back():
    items = [item for one in whole().values() for item in one]
    rows = list(csv.DictReader(io.StringIO(csv_of(items))))
    assert len(rows) == len(items)
    for row, item in zip(rows, items, strict=True):
        assert row["printed"] == item.cell.printed and row["verdict"] == item.verdict
        assert (row["recomputed"] == "") == (item.recomputed != item.recomputed)
        if row["recomputed"]:
            assert float(row["recomputed"]) == item.recomputed
        corrected = item.cell.corrected
        assert row["corrected"] == ("" if corrected is None else repr(corrected))


def test_the_table_keeps_commas_and_lines_within_a_cell():
    cell = replace(cells_of("Wang-2022")[0], note='two, "three"\nfour')
    (row,) = csv.DictReader(
        io.StringIO(csv_of([ReproducedItem(cell, float("inf"), "open", "so, so")]))
    )
    assert (row["note"], row["how"], row["recomputed"]) == ('two, "three"\nfour', "so, so", "")


# answers become items: one for every cell, and none without a cell

CELL = cells_of("Wang-2022")[0]


def item(printed, answer, **other):
    cell = replace(CELL, printed=printed, **other)
    return item_of(cell, {cell.key: answer})


@pytest.mark.parametrize(
    ("printed", "value", "verdict"),
    [
        ("2.50", 2.5049, "derived"),
        ("2.50", 2.5051, "unexplained"),
        ("-1/2", -0.5 + 1e-12, "derived"),
        ("1/2", 0.5001, "unexplained"),
        ("about 30 lbs", 30.4, "derived"),
    ],
)
def test_half_of_the_last_printed_digit_and_a_fraction_is_exact(printed, value, verdict):
    assert item(printed, Answer(value, "so")).verdict == verdict


def test_a_tolerance_of_the_inputs_is_kept():
    assert item("9000", Answer(9003.2, "so", tolerance=4.8)).verdict == "derived"
    assert item("9000", Answer(9005.2, "so", tolerance=4.8)).verdict == "unexplained"


@pytest.mark.parametrize(
    ("bound", "value", "verdict"),
    [
        ("below", 0.05, "derived"),
        ("below", 2.6, "unexplained"),
        ("above", 2.6, "derived"),
        ("above", 1.4, "unexplained"),
    ],
)
def test_a_limit_holds_or_not(bound, value, verdict):
    assert item("less than 2%", Answer(value, "so", bound=bound)).verdict == verdict


def test_words_are_judged_by_the_digits_of_what_is_right():
    answer = Answer(0.34202, "sine")
    wrong = {"corrected": 0.342, "erratum": "X-1", "confidence": "certain"}
    assert item("fr", answer, **wrong).verdict == "erratum"
    assert item("fr", answer, **wrong | {"corrected": 0.343}).verdict == "unexplained"
    assert item("fr", answer).verdict == "unexplained"


def test_words_that_mean_a_number():
    assert item("the same", Answer(1 + 1e-13, "so", meaning=1.0)).verdict == "derived"
    assert item("the same", Answer(0.9, "so", meaning=1.0)).verdict == "unexplained"


def test_a_reason_is_not_a_number():
    found = item("7800", "a property of the steel")
    assert found.verdict == "measured" and math.isnan(found.recomputed)
    assert found.how == "a property of the steel"


def test_every_cell_needs_an_answer_and_every_answer_a_cell():
    whole = {cell.key: "so" for cell in cells_of("Wang-2022")}
    assert len(items_from("Wang-2022", whole)) == len(whole)
    with pytest.raises(DataError, match=r"has no such cell; found 1 / steel / colour"):
        items_from("Wang-2022", whole | {("1", "steel", "colour"): "so"})
    first = next(iter(whole))
    del whole[first]
    with pytest.raises(DataError, match="nothing is said of a cell of Wang-2022; found 1 / steel"):
        items_from("Wang-2022", whole)


def test_misprints_change_one_digit():
    assert [misprint(text) for text in ("0.09", "-1/2", "about 30", "1,000", "0°")] == [
        "0.08", "-2/2", "about 40", "2,000", "7°",
    ]  # fmt: skip


# how blind a reproduced number is: by how much it could be wrong and still come back

HIDDEN = 0.1
# a mean and a deviation of two digits, in a difference of two means that nearly cancel or are few
F_OF_TABLE_A_4 = {".83", "42.75", ".33", ".003"}
# said with about or approximately, of one digit that is not zero
ONE_DIGIT = {"about 1,000", "about 20", "200", "30"}
# known to one interval of weights
ONE_INTERVAL = {("sec 4.8", "static test, where it agrees with T-2", "strain")}


@cache
def numbers(report):
    return [
        item
        for item in whole()[report]
        if item.verdict in ("derived", "closed", "repeated")
        and math.isfinite(item.tolerance)
        and number_of(item.cell.printed)
    ]


def digits(text):
    """Printed digits from the first that is not zero."""
    return round(abs(number_of(text)) / printed_step(text))


def wide(report):
    """Numbers that a change of 10 % leaves reproduced, and not because they have one digit."""
    return [
        item
        for item in numbers(report)
        if item.tolerance >= HIDDEN * abs(number_of(item.cell.printed))
        and item.tolerance > 0.501 * printed_step(item.cell.printed)
    ]


@pytest.mark.parametrize("report", REPORTS)
def test_half_a_digit_hides_a_tenth_of_one_digit_only(report):
    hidden = [
        item
        for item in numbers(report)
        if item.tolerance >= HIDDEN * abs(number_of(item.cell.printed)) and item not in wide(report)
    ]
    assert all(digits(item.cell.printed) <= 5 for item in hidden)


@pytest.mark.parametrize("report", REPORTS)
def test_rounded_inputs_hide_a_tenth_of_these_numbers_and_of_no_other(report):
    for item in wide(report):
        key = item.cell.key
        assert (
            key[2].endswith("F-stat")
            or (key[0] == "A-4" and item.cell.printed in F_OF_TABLE_A_4)
            or item.cell.printed in ONE_DIGIT
            or key in ONE_INTERVAL
        ), key


def test_f_of_a_fit_is_not_closed_where_r2_is_within_half_a_per_cent_of_one():
    # F = c r2 / (1 - r2): half of .001 in r2 is 10 % of 1 - r2 where that is .005
    r2 = {
        (cell.table, cell.row): number_of(cell.printed)
        for cell in cells_of("CG-D-39-80")
        if cell.column.endswith(" r2")
    }
    f = [item for item in numbers("CG-D-39-80") if item.cell.column.endswith("F-stat")]
    near = {item.cell.key for item in f if r2[item.cell.table, item.cell.row] == 0.995}
    assert not near
    blind = [
        item
        for item in whole()["CG-D-39-80"]
        if item.cell.column.endswith("F-stat") and item.power < DETECTED
    ]
    assert {r2[item.cell.table, item.cell.row] for item in blind} == {0.994, 0.995}
    assert {item.verdict for item in blind} <= {"measured", "repeated"}
    # nearer ones stand in two tables, and are held to their other print
    nearer = [item for item in f if r2[item.cell.table, item.cell.row] > 0.995]
    assert all(item.tolerance < HIDDEN * item.recomputed for item in nearer)


def test_no_tolerance_is_less_than_half_the_last_digit():
    for report in REPORTS:
        for item in numbers(report):
            assert item.tolerance >= 0.5 * printed_step(item.cell.printed)


# about, below, over and in words: how near a number is meant to be, and which it is


def cell(printed, **known):
    plain = {
        "report": "WHOI-2005-10", "table": "sec 6.0", "row": "a", "column": "b", "unit": "psi",
        "corrected": None, "erratum": "", "confidence": "", "page": "", "note": "",
    }  # fmt: skip
    return Cell(printed=printed, **(plain | known))


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("350", 10),
        ("500", 100),
        ("123", 1),
        ("10,000", 10_000),
        ("1.50", 0.1),
        ("0", 0),
        ("n/a", 0),
    ],
)
def test_last_digit_that_is_not_zero(text, place):
    assert last_counted_place(text) == pytest.approx(place)


@pytest.mark.parametrize(("value", "verdict"), [(115, "derived"), (116, "unexplained")])
def test_a_round_number_covers_half_its_last_counted_digit(value, verdict):
    item = judge_round(cell("110"), value, "from a table")
    assert item.verdict == verdict and item.how == "from a table; round to 10"


def test_a_limit_holds_on_its_own_side_only():
    assert judge_limit(cell("below 100"), 48.0, "x", is_upper=True).verdict == "derived"
    assert judge_limit(cell("below 100"), 120.0, "x", is_upper=True).verdict == "unexplained"
    assert judge_limit(cell("over 200"), 212.0, "x", is_upper=False).verdict == "derived"
    assert judge_limit(cell("over 200"), 180.0, "x", is_upper=False).verdict == "unexplained"


def test_a_limit_that_is_known_to_be_wrong_is_an_erratum():
    wrong = cell("less than 200", corrected=212.0, erratum="WH5-18", confidence="certain")
    assert judge_limit(wrong, 212.0, "x", is_upper=True).verdict == "erratum"
    assert judge_limit(wrong, 230.0, "x", is_upper=True).verdict == "unexplained"


def test_a_text_without_a_number_is_no_limit():
    assert judge_limit(cell("near zero"), 52.0, "x", is_upper=True).verdict == "unexplained"


@pytest.mark.parametrize(
    ("words", "value", "step", "verdict"),
    [
        ("twice", 2.05, 1.0, "derived"),
        ("twice", 2.51, 1.0, "unexplained"),
        ("two samples each", 2.0, 1.0, "derived"),
        ("Three minutes", 3.0, 1.0, "derived"),
        ("one-and-a-half", 1.67, 0.5, "derived"),
        ("one-and-a-half", 1.76, 0.5, "unexplained"),
        ("twice", 1.67, 0.5, "unexplained"),
        ("stiffer", 2.0, 1.0, "unexplained"),
    ],
)
def test_a_number_in_words_is_held_in_the_steps_in_which_it_is_said(words, value, step, verdict):
    item = judge_word(cell(words), value, "from a table", step=step)
    assert (item.verdict, item.recomputed, item.cell.printed) == (verdict, value, words)


def test_another_writing_of_a_number_is_judged_by_its_own_digits():
    power = cell("10^{-4}", corrected=4.0, erratum="CG-7", confidence="certain")
    assert judge_as(power, "-4", -4.0, "x").verdict == "derived"
    assert judge_as(power, "-4", 4.0, "x").verdict == "erratum"
    assert judge_as(power, "-4", 3.0, "x").verdict == "unexplained"
    assert judge_as(power, "-4", 4.0, "x").cell is power

"""One page a campaign: whole, safe, offline, and with the numbers of the archives."""

import json
import re
import zlib
from base64 import b64decode
from dataclasses import replace
from html.parser import HTMLParser
from importlib.resources import files
from itertools import pairwise

import numpy as np
import plotly.graph_objects as go
import pytest

from reduction.archive.open import open_archive
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
from reduction.record.errors import ArchiveError
from reduction.record.notes import Note, note
from reduction.report.campaign_page import _over_pages, _write_pages, write_report
from reduction.report.page_template import Page, RenderedSection
from reduction.report.test_view import TestView
from reduction.report.text_style import PageTable, TableCell

NASTY = "</script><script>alert(1)</script> \"quote\" 'x' & \u2028\nnew line"
STATUS = "test,status,exit_status,message,raw_sha256,seconds\r\n"


class ReadPage(HTMLParser):
    """What a browser would make of the page: elements, text, scripts, tables."""

    def __init__(self, html):
        super().__init__()
        self.elements, self.scripts, self.tables, self.text = [], {}, {}, []
        self._script, self._table, self._cell = None, None, None
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.elements.append((tag, attributes))
        if tag == "script":
            self._script = attributes.get("id", f"script-{len(self.scripts)}")
            self.scripts[self._script] = ""
        elif tag == "caption":
            self._table = ""
        elif tag == "tr" and isinstance(self._table, list):
            self._table.append([])
        elif tag in ("td", "th") and isinstance(self._table, list):
            self._table[-1].append([attributes, ""])
            self._cell = self._table[-1][-1]

    def handle_endtag(self, tag):
        if tag == "script":
            self._script = None
        elif tag == "caption":
            rows = self.tables.setdefault(self._table, [])
            self._table = []
            rows.append(self._table)
        elif tag == "table":
            self._table = None
        elif tag in ("td", "th"):
            self._cell = None

    def handle_data(self, data):
        if self._script is not None:
            self.scripts[self._script] += data
            return
        self.text.append(data)
        if self._cell is not None:
            self._cell[1] += data
        elif isinstance(self._table, str):
            self._table += data

    def figures(self):
        return {
            name: json.loads(zlib.decompress(b64decode(text), -zlib.MAX_WBITS))
            for name, text in self.scripts.items()
            if name.endswith("-data")
        }

    def rows(self, caption):
        (name,) = {name for name in self.tables if name.startswith(caption)}
        return self.tables[name][0]


PLUS_MINUS = "±: expanded uncertainty, 95 % (k = "


@pytest.fixture
def report(tmp_path, write):
    """Write reduced tests as archives, make the page, and read it."""

    def make(*tests, status="", units="si"):
        for test in tests:
            write(test)
        if status:
            (tmp_path / "status.csv").write_text(status, encoding="utf-8", newline="")
        path = write_report(tmp_path, tmp_path / "reports", units=units)
        return ReadPage(path.read_text(encoding="utf-8"))

    return make


@pytest.fixture(scope="module")
def rich_page(tmp_path_factory, rich_test):
    """The page of one test with everything."""
    folder = tmp_path_factory.mktemp("rich")
    write_archive(to_dataset(rich_test, version="1.2.3", command="run"), folder / "T-1.nc")
    return ReadPage(write_report(folder, folder / "reports").read_text(encoding="utf-8"))


def test_the_page_is_the_same_from_all_numbers_of_its_tests(
    rich_test, write, tmp_path, monkeypatch
):
    write(rich_test)
    first = write_report(tmp_path, tmp_path / "first").read_text(encoding="utf-8")
    monkeypatch.setattr(TestView, "of_campaign", lambda view, known: view)
    again = write_report(tmp_path, tmp_path / "again").read_text(encoding="utf-8")
    assert again == first


def plain(text):
    return Note("fixture", "note", text=text)


def renamed(test, test_id, **attributes):
    about = test.description
    description = replace(about, test_id=test_id, attributes=about.attributes | attributes)
    return replace(test, description=description)


def test_nothing_is_fetched(rich_page):
    page = rich_page
    for tag, attributes in page.elements:
        for name in ("src", "href", "data", "srcset", "poster", "action"):
            assert not re.match(r"(https?:)?//", attributes.get(name) or ""), (tag, attributes)
    assert not [tag for tag, _ in page.elements if tag in ("link", "iframe", "img", "object")]
    policy = next(a for _, a in page.elements if a.get("http-equiv") == "Content-Security-Policy")
    assert policy["content"].startswith("default-src 'none'")


@pytest.mark.slow
def test_every_figure_is_one_that_plotly_takes_and_has_data(report, rich_test, stepwise_test):
    figures = report(rich_test, stepwise_test).figures()
    assert len(figures) > 15
    for name, figure in figures.items():
        go.Figure(figure)  # refuses a property that plotly does not know
        assert figure["data"], name
        assert any(any(y is not None for y in trace["y"]) for trace in figure["data"]), name
        for axis, settings in figure["layout"].items():
            if axis.startswith(("xaxis", "yaxis")):
                assert re.search(r"\[.+\]$", settings["title"]["text"]), (name, axis)


def test_a_figure_is_there_for_every_part_of_a_rich_test(report, rich_test, stepwise_test):
    names = " ".join(report(rich_test, stepwise_test).figures())
    for part in (
        "record", "tension-position", "loops", "modulus", "first-last", "peaks",
        "spring-constant", "energy", "loss-factor", "mooney", "steps", "step-moduli",
        "campaign-moduli", "campaign-ratio", "campaign-test_dynamic_modulus", "campaign-static",
    ):  # fmt: skip
        assert part in names, part


def test_the_answer_has_the_numbers_of_the_archive(report, rich_test, tmp_path):
    rows = report(rich_test).rows("Elastic modulus of the rubber")
    header = [cell[1] for cell in rows[0]]
    place = next(k for k, text in enumerate(header) if text.startswith("segment modulus"))
    assert header[place].endswith("[MPa]")
    found = sorted(float(row[place][0]["data-value"]) for row in rows[1:])
    with open_archive(tmp_path / "T-1.nc") as data:
        modulus = data["segment_modulus"].values
        assert found == sorted(modulus[np.isfinite(modulus)].tolist())
        by_name = {
            (row[1][1], row[2][1], int(row[3][0]["data-value"])): row[place] for row in rows[1:]
        }
        for row, name in enumerate(data["specimen"].values):
            for column, branch in enumerate(data["branch_name"].values):
                for segment, value in enumerate(modulus[row, column], start=1):
                    cell = by_name.get((name, branch, segment))
                    if np.isfinite(value):
                        assert float(cell[0]["data-value"]) == value
                    else:
                        assert cell is None


def test_us_units_change_what_is_shown_and_not_the_value_beside_it(report, rich_test):
    rows = report(rich_test, units="us").rows("Specimens before")
    header = [cell[1] for cell in rows[0]]
    place = header.index("diameter [in]")
    # 26.4 and 26.5 mm are 1.0394 and 1.0433 in
    assert rows[1][place][1] == "1.041"
    assert float(rows[1][place][0]["data-value"]) == 0.02645


def test_names_with_markup_quotes_lines_and_500_characters_are_text(report, rich_test):
    long = "x" * 500
    specimens = (
        replace(rich_test.specimens[0], condition=NASTY, material=long, notes=(NASTY,)),
        rich_test.specimens[1],
    )
    nasty = renamed(
        replace(rich_test, specimens=specimens, notes=(plain(NASTY), plain(long))), "T-1",
        title=NASTY, operator=NASTY, summary=long,
    )  # fmt: skip
    page = report(nasty)
    scripts = [attributes for tag, attributes in page.elements if tag == "script"]
    assert len([one for one in scripts if one.get("type") in (None, "text/plain")]) == 2
    assert not any("alert(1)" in text for text in page.scripts.values())
    everything = "".join(page.text)
    assert everything.count("<script>alert(1)</script>") >= 4
    assert long in everything


def test_a_specimen_name_with_markup_is_text_in_the_figures(rich_page, monkeypatch):
    names = {"new": "<b>new</b>" + "y" * 500, "used": "<i>used</i>"}
    texts = TestView.texts
    monkeypatch.setattr(
        TestView,
        "texts",
        lambda self, name: tuple(names.get(text, text) for text in texts(self, name)),
    )
    page = rich_page
    for figure in page.figures().values():
        drawn = [trace["name"] for trace in figure["data"]] + [figure["layout"]["title"]["text"]]
        drawn += [note["text"] for note in figure["layout"].get("annotations", ())]
        assert not any("<" in text for text in drawn)
        assert all(len(text) < 120 for text in drawn)
    assert not any(tag == "i" for tag, _ in page.elements)


def test_synthetic_data_are_called_so_once_and_in_every_figure(rich_page):
    page = rich_page
    assert sum("SYNTHETIC DATA" in text for text in page.text) == 1
    for figure in page.figures().values():
        assert figure["layout"]["title"]["subtitle"]["text"] == "SYNTHETIC DATA"
    assert not any("SYNTHETIC" in caption for caption in page.tables)


def test_measured_data_are_not_called_synthetic(report, stepwise_test):
    page = report(stepwise_test)
    assert "SYNTHETIC DATA" not in "".join([*page.text, *page.tables])


@pytest.mark.nightly
def test_ten_tests_stay_below_fifteen_megabytes(report, rich_test, tmp_path):
    page = report(*(renamed(rich_test, f"T-{number}") for number in range(1, 11)))
    assert (tmp_path / "reports" / "index.html").stat().st_size < 15e6
    assert sum(tag == "h2" for tag, _ in page.elements) == 4 + 10


def test_tests_stand_in_their_order_and_parts_behind_the_whole(report, rich_test):
    order = [
        renamed(rich_test, "T-10"),
        replace(renamed(rich_test, "A-end", part_of="T-2")),
        renamed(rich_test, "T-2"),
    ]
    numbers = (10, None, 2)
    tests = [
        replace(one, description=replace(one.description, order=number))
        for one, number in zip(order, numbers, strict=True)
    ]
    page = report(*tests)
    rows = page.rows("Tests in order")
    assert [row[0][1] for row in rows[1:]] == ["T-2", "A-end", "T-10"]


def test_parts_of_a_test_stand_in_the_order_in_which_they_began(report, rich_test):
    record = rich_test.record
    late = replace(record, time=record.time + 59000.0)
    page = report(
        replace(renamed(rich_test, "A-end", part_of="T-2"), record=late),
        renamed(rich_test, "B-start", part_of="T-2"),
        renamed(rich_test, "T-2"),
        replace(renamed(rich_test, "T-3"), record=late),
    )
    rows = page.rows("Tests in order")
    assert [row[0][1] for row in rows[1:]] == ["T-2", "B-start", "A-end", "T-3"]


def test_a_part_whose_whole_has_no_order_stands_behind_it_all_the_same(report, rich_test):
    tests = (
        renamed(rich_test, "T-1"),
        renamed(rich_test, "T-2"),
        renamed(rich_test, "part", part_of="T-1"),
    )
    unordered = [replace(one, description=replace(one.description, order=None)) for one in tests]
    rows = report(*unordered).rows("Tests in order")
    assert [row[0][1] for row in rows[1:]] == ["T-1", "part", "T-2"]


def test_a_campaign_without_a_summary_is_described_by_what_it_holds(
    report, rich_test, stepwise_test
):
    page = report(rich_test, renamed(rich_test, "T-2"), stepwise_test)
    sentence = "3 tests (1 stepwise, 2 cyclic) of 3 specimens: tether, new, used."
    assert sentence in "".join(page.text)


def test_a_campaign_of_one_test_is_not_described_by_the_summary_of_its_archive(rich_page):
    assert "1 test (1 cyclic) of 2 specimens: new, used." in "".join(rich_page.text)


def test_the_summary_of_a_campaign_is_shown_as_it_stands(report, rich_test):
    page = report(renamed(rich_test, "T-1", summary="What we pulled and why."))
    leads = [a for _, a in page.elements if a.get("class") == "lead"]
    assert leads and "What we pulled and why." in "".join(page.text)
    assert "1 test (1 cyclic)" not in "".join(page.text)


def test_the_page_does_not_tell_the_run_that_made_an_archive_from_a_later_one(report, rich_test):
    page = report(rich_test, status=STATUS + "T-1,unchanged,0,,,0.1\r\n")
    assert page.rows("Tests in order")[1][-1][1] == "check"


def test_of_a_test_without_notes_none_are_said(report, bare_test):
    test = renamed(replace(bare_test, notes=()), "T-1")
    with_notes = bool(test.all_notes())
    page = report(test, status=STATUS + "T-1,unchanged,0,,,0.1\r\n")
    assert page.rows("Tests in order")[1][-1][1] == "reduced"
    assert not with_notes


def test_failures_come_first_and_a_kept_archive_is_called_old(report, rich_test):
    status = STATUS + (
        "T-1,failed,3,T-1.csv:7 [load]: load is not a number,,0.1\r\n"
        "T-9,failed,4,one cycle,,0.1\r\nT-8,no_work,0,,,0.1\r\n"
    )
    page = report(rich_test, status=status)
    text = "".join(page.text)
    wrong = text[text.index("Failures") :]
    assert "load is not a number" in wrong
    assert "is from an earlier run" in wrong
    assert wrong.index("one cycle") < wrong.index("Warnings")
    assert "status is no work" in wrong
    rows = page.rows("Tests in order")
    assert ["T-9", "failed, no archive"] in [[row[0][1], row[-1][1]] for row in rows]


def test_notes_that_differ_in_numbers_alone_stand_once_on_top_and_all_in_their_section(
    report, rich_test
):
    notes = tuple(f"window of 0.{place} of strain" for place in range(5))
    told = replace(rich_test, notes=tuple(map(plain, notes)))
    page = report(told, renamed(rich_test, "T-2"))
    text = "".join(page.text)
    assert text.count("of strain. 4 similar notes in T-1") == 1
    assert all(text.count(note) >= 1 for note in notes)


def test_an_archive_from_other_raw_files_is_a_warning(report, rich_test):
    page = report(rich_test, status=STATUS + "T-1,reduced,0,,abc,0.1\r\n")
    assert "differ from those in status.csv" in "".join(page.text)


def test_a_file_that_is_no_archive_is_named_and_the_others_are_shown(report, rich_test, tmp_path):
    (tmp_path / "broken.nc").write_bytes(b"not netCDF")
    page = report(rich_test)
    text = "".join(page.text)
    assert "broken.nc" in text
    assert "cannot be read as a netCDF file" in text
    assert page.rows("Elastic modulus of the rubber")


def test_a_campaign_of_which_every_test_failed_still_has_a_page(report):
    page = report(status=STATUS + "T-1,failed,3,no such file,,0.1\r\n")
    assert "no such file" in "".join(page.text)


def test_an_empty_folder_is_refused(tmp_path):
    with pytest.raises(ArchiveError, match="there is nothing to report on"):
        write_report(tmp_path, tmp_path / "reports")


def test_a_status_file_that_is_no_text_is_refused(tmp_path):
    (tmp_path / "status.csv").write_bytes(b"\xff\xfe\x00test")
    with pytest.raises(ArchiveError, match=r"status\.csv cannot be read"):
        write_report(tmp_path, tmp_path / "reports")


@pytest.mark.parametrize("name", ["holds_only_test", "bare_test", "stepwise_test"])
def test_a_test_with_little_in_it_has_a_section(report, request, name):
    test = request.getfixturevalue(name)
    page = report(test)
    assert test.description.test_id in "".join(page.text)


def test_headings_go_down_one_level_at_a_time_and_tables_say_what_heads_what(rich_page):
    page = rich_page
    levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(low - high <= 1 for high, low in pairwise(levels))
    assert all(a.get("scope") in ("col", "row") for tag, a in page.elements if tag == "th")
    ids = [a["id"] for _, a in page.elements if "id" in a]
    assert len(ids) == len(set(ids))
    targets = [a["href"] for tag, a in page.elements if tag == "a"]
    assert all(target[1:] in ids for target in targets)


def test_the_page_of_design_values_is_linked_where_one_is_written(report, rich_test, tmp_path):
    report(rich_test)
    path = write_report(tmp_path, tmp_path / "reports", values_page="../design-values.html")
    beside = [a["href"] for tag, a in ReadPage(path.read_text(encoding="utf-8")).elements
              if tag == "a" and not a["href"].startswith("#")]  # fmt: skip
    assert beside == ["../design-values.html"]


def test_a_plot_says_what_it_shows_and_has_a_caption(rich_page):
    page = rich_page
    plots = [a for _, a in page.elements if a.get("class") == "plot"]
    assert all(a["role"] == "group" and a["aria-label"] for a in plots)
    assert len(plots) == sum(tag == "figcaption" for tag, _ in page.elements) > 0


def test_the_page_says_what_a_constant_fraction_would_read(rich_page):
    # 1 / 0.86 is 1.163
    assert "would give moduli 16.3 % higher" in "".join(rich_page.text)


def test_holds_are_numbered_by_time_alike_for_all_specimens(report, rich_test):
    begins = (3.0, 3.0, 1.0)  # new, used, and the creep of new before both
    holds = tuple(
        replace(hold, hold_start_time=begin)
        for hold, begin in zip(rich_test.holds, begins, strict=True)
    )
    page = report(replace(rich_test, holds=holds))
    rows = page.rows("Holds: relaxation")
    assert [[cell[1] for cell in row[:3]] for row in rows[1:]] == [
        ["2", "new", "relaxation"], ["2", "used", "relaxation"], ["1", "new", "creep"],
    ]  # fmt: skip
    assert [row[0][1] for row in page.rows("Prony series")[1:]] == ["2", "2", "1", "1"]
    names = {
        name: [trace["name"].split(",")[0] for trace in figure["data"]]
        for name, figure in page.figures().items()
        if "-hold-" in name
    }
    assert {
        name.removeprefix("test-0-hold-").removesuffix("-data"): set(drawn)
        for name, drawn in names.items()
    } == {"relaxation-0": {"hold 2"}, "relaxation-1": {"hold 2"}, "creep-0": {"hold 1"}}
    text = "".join(page.text)
    assert "hold 2, used: Prony series not given: the hold lasts 25 s" in text
    assert "hold 2 used: rate not given: too short" in text
    assert "hold 1 new: ramp of 4 s left out" in text


def test_how_the_terms_were_chosen_stands_once_a_hold_below_the_prony_table(rich_page, rich_test):
    page = rich_page
    assert not any("chosen" in cell[1] for cell in page.rows("Prony series")[0])
    said = re.findall(r"Number of terms, hold \d+, \w+: [^<\n]+", "".join(page.text))
    assert len(said) == len(set(said)) == len(rich_test.holds)


def test_wherever_a_plus_minus_stands_its_meaning_stands_too(
    report, rich_test, stepwise_test, tmp_path
):
    report(rich_test, stepwise_test)
    html = (tmp_path / "reports" / "index.html").read_text(encoding="utf-8")
    html = re.sub(r"<script.*?</script>", "", html, flags=re.DOTALL)
    captions = re.findall(r"<figcaption>(.*?)</figcaption>", html, flags=re.DOTALL)
    tables = re.findall(r"<table>.*?(?=<table>|<h\d|<figure|<details)", html, flags=re.DOTALL)
    places = [text for text in (*captions, *tables) if "±" in text]
    assert len(places) > 12
    for text in places:
        assert PLUS_MINUS in text, text[:300]


def test_the_first_answer_is_the_modulus_to_design_with_and_the_rest_is_folded(rich_page):
    page = rich_page
    headings = [a.get("id") for tag, a in page.elements if tag == "h2"]
    assert headings[0] == "answer"
    captions = list(page.tables)
    assert captions[0].startswith("Design moduli")
    assert captions[1].startswith("new: tangent modulus at stated strains")
    assert captions[2].startswith("used: tangent modulus at stated strains")
    folded = [a for tag, a in page.elements if tag == "details" and a.get("class") == "segments"]
    assert len(folded) == 2 and not any("open" in one for one in folded)


def test_without_round_strains_the_segments_alone_are_folded(report, rich_test):
    curves = replace(rich_test.curves, strain_bin=rich_test.curves.strain_bin * 0 + 0.0031)
    page = report(replace(rich_test, curves=curves))
    folded = [a for tag, a in page.elements if tag == "details" and a.get("class") == "segments"]
    assert len(folded) == 1


def test_what_to_check_stands_before_the_answers_and_leads_to_the_whole_list(rich_page):
    page = rich_page
    lists = [a for tag, a in page.elements if tag == "ul" and a.get("class") == "urgent"]
    assert len(lists) == 1
    text = "".join(page.text)
    first = text.index("the last cycle is broken")
    assert first < text.index("Design moduli")
    assert text.index("the last cycle is broken", first + 1) > text.index("Problems found", first)


def test_the_section_of_a_test_begins_with_the_reasons_for_check_and_status_stays_in_sight(
    rich_page,
):
    text = "".join(rich_page.text)
    section = text[text.index("Across the tests" if "Across the tests" in text else "T-1") :]
    assert section.index("the last cycle is broken") < section.index("All notes on this test")
    bad = [a for tag, a in rich_page.elements if tag == "p" and a.get("class") == "remark bad"]
    assert bad
    # a column of its own class, which the style keeps at the edge of a table that scrolls
    assert any(tag == "td" and a.get("class") == "status" for tag, a in rich_page.elements)


def test_the_notes_of_a_test_stand_under_headings_most_serious_first(rich_page):
    text = "".join(rich_page.text)
    text = text[text.index("All notes on this test") :]
    places = [text.index(words) for words in ("Check before use", "Numbers withheld")]
    assert places == sorted(places)
    assert places[0] < text.index("the last cycle is broken") < places[1]


def test_a_page_in_us_units_says_what_of_it_is_not(report, rich_test):
    words = "Notes, settings and history are as in the archives, in SI."
    assert words in "".join(report(rich_test, units="us").text)
    assert words not in "".join(report(rich_test).text)


def test_an_archive_of_a_test_that_the_campaign_has_no_more_says_so(report, rich_test):
    status = STATUS + "T-1,reduced,0,,,1\r\n"
    page = report(rich_test, renamed(rich_test, "T-9"), status=status)
    text = " ".join("".join(page.text).split())
    assert "T-9 The campaign no longer has this test" in text
    assert "T-1 The campaign has no such test now" not in text
    rows = {row[0][1]: row[-1][1] for row in page.rows("Tests in order")[1:]}
    assert rows["T-1"] == "reduced"
    assert rows["T-9"] == "from an earlier run; the campaign no longer has this test"


def test_an_archive_of_the_campaign_that_nothing_stands_for_now_says_so(rich_test, write, tmp_path):
    write(rich_test)
    page = write_report(tmp_path, tmp_path / "r", stray=["surfaces.nc", "T-9.nc"])
    text = " ".join("".join(ReadPage(page.read_text(encoding="utf-8")).text).split())
    assert "surfaces.nc The campaign no longer makes this archive" in text
    assert "T-9.nc Nothing" not in text


@pytest.mark.parametrize(
    ("room", "name"),
    [
        ("reduction.report", "page.html"),
        ("reduction.report", "client.html"),
        ("reduction.published", "reproduce.html"),
        ("reduction.pages", "design-values.html"),
    ],
)
def test_every_page_forbids_another_base_and_sending_of_forms(room, name):
    page = (files(room) / "templates" / name).read_text("utf-8")
    (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert {"default-src 'none'", "form-action 'none'", "base-uri 'none'"} <= set(
        policy.split("; ")
    )


def test_what_moves_an_answer_most_is_named_first_over_all_tests(report, rich_test):
    small = replace(rich_test, notes=(note("drift-in-energy", "new", energy=1.0, closed=1.01,
                                           effect=0.01),))  # fmt: skip
    large = replace(renamed(rich_test, "T-2"), notes=(note("stiffness-not-settled", "new",
                                                           effect=0.3, n_cycles=10),))  # fmt: skip
    text = "".join(report(small, large).text)
    assert text.index("has not settled: it changes by +30.0 %") < text.index(
        "the loop area as logged is"
    )


# A campaign of more tests than one page has room for has pages beside it

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

"""The report to a client: every field there or called missing, texts as text, one set of numbers."""

import html
import re
from dataclasses import replace

import numpy as np
import pytest

from reduction.archive.open import open_archive
from reduction.archive.report_details import (
    Client,
    Instrument,
    Laboratory,
    ReportDetails,
    ReportItem,
    ReportLimit,
    _Authorised,
    keep_details,
)
from reduction.report import client_report as clientfigures
from reduction.report.answer_tables import RULES, conformity_table
from reduction.report.campaign_page import write_report
from reduction.report.client_report import NOT_STATED
from reduction.report.test_view import OF_NO_TEST, Status, TestView

NASTY = (
    "</style></script><script>alert(1)</script> \"q\" 'x' & \\ \u2028\nnew line } @import url(//x)"
)
FIELDS = (
    "Report number", "Revision", "Date of issue", "Laboratory", "Place of the tests", "Client",
    "Order", "Items received", "Date of the tests", "Method", "Deviations from the method",
    "Sampling", "Temperature", "Authorised by", "Function", "Date",
)  # fmt: skip


@pytest.fixture
def client(tmp_path, write):
    """Write a campaign and what its laboratory states; give the report to the client."""

    def make(details, *tests, units="si"):
        for test in tests:
            write(test)
        keep_details(tmp_path, details)
        page = write_report(tmp_path, tmp_path / "reports", units=units)
        beside = page.with_name("client-report.html")
        return beside.read_text(encoding="utf-8") if beside.exists() else None

    return make


def shown(page):
    """Fields of a page: label to text."""
    rows = re.findall(r"<dt>(.*?)</dt><dd[^>]*>(.*?)</dd>", page, re.S)
    return {html.unescape(label): html.unescape(text) for label, text in rows}


def text_of(page):
    body = page.partition("<body>")[2]
    return " ".join(html.unescape(re.sub(r"<[^>]*>", " ", body)).split())


def rows_of(page, caption):
    table = page.partition(f"<caption>{caption}")[2].partition("</table>")[0]
    return [
        [html.unescape(cell) for cell in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.S)]
        for row in table.split("<tr>")[1:]
    ]


def filled(section, *values, **more):
    """A section with values in the order of its keys."""
    return section(**dict(zip(section.model_fields, values, strict=False)), **more)


AT = {"specimen": "new", "branch": "ascending", "strain": "1.0"}


def limit(value, at=AT, **more):
    return ReportLimit(
        quantity="tangent_modulus", test="T-1", at=at, lower=value, **{"source": "order"} | more
    )


def test_a_campaign_that_states_nothing_has_no_such_report_and_loses_an_older_one(
    client, rich_test
):
    assert client(None, rich_test) is None
    assert client(ReportDetails(number="1")) is not None
    assert client(None) is None


def test_what_is_not_stated_is_called_so_field_by_field(client, rich_test):
    page = client(
        ReportDetails(),
        replace(rich_test, description=replace(rich_test.description, attributes={})),
    )
    found = shown(page)
    missing = {label for label, text in found.items() if text == NOT_STATED}
    assert set(FIELDS) - missing == {"Revision"}
    assert found["Revision"] == "0 (first issue)"
    assert "This report does not state: Report number, Date of issue, Laboratory" in text_of(page)
    for name in ("identification", "condition on receipt"):
        at = rows_of(page, "Items as they were received")[0].index(name)
        assert {row[at] for row in rows_of(page, "Items as they were received")[1:]} == {NOT_STATED}
    assert "No limit is stated" in text_of(page)
    assert f"End of report {NOT_STATED}, revision 0" in text_of(page)


def test_what_is_stated_stands_under_its_label(client, rich_test):
    details = ReportDetails(
        number="17", revision=2, amendment="table added", issued="today", received="May",
        tested="June", method="P-12", deviations="none", sampling="by the client",
        environment="23 °C", opinions="it may serve on",
        authorised=_Authorised(by="A. Person", function="head", on="5 June"),
        laboratory=Laboratory(name="Lab", address="1 Street", location="the quay"),
        client=Client(name="Buoy", order="4711"),
        items={"new": filled(ReportItem, "tag 1", "a tether", "wet", "4 May")},
        instruments=(filled(Instrument, "cell", "s/n 1", "cert 2", "PTB", "2025", "2027"),),
    )  # fmt: skip
    page = client(details, rich_test)
    found = shown(page)
    assert found["Revision"] == "2 — AMENDED REPORT: table added"
    assert found["Laboratory"] == "Lab\n1 Street"
    assert [found[label] for label in FIELDS if label not in ("Revision", "Laboratory", "Temperature")] == [
        "17", "today", "the quay", "Buoy", "4711", "May", "June", "P-12", "none", "by the client",
        "A. Person", "head", "5 June",
    ]  # fmt: skip
    assert found["Other conditions"] == "23 °C"
    assert rows_of(page, "Items as")[1] == ["new", "tag 1", "a tether", "wet", "4 May"]
    assert rows_of(page, "Items as")[2] == ["used", NOT_STATED, NOT_STATED, NOT_STATED, "May"]
    assert rows_of(page, "Instruments and")[1] == ["cell", "s/n 1", "cert 2", "PTB", "2025", "2027"]
    assert rows_of(page, "Instruments and")[2][0] == "tether machine"
    assert "Opinion, not a result of the tests: it may serve on" in text_of(page)
    assert "relate only to the items" in text_of(page) and "except in full" in text_of(page)
    assert text_of(page).endswith("End of report 17, revision 2")


def test_a_revision_that_does_not_say_what_it_changed_says_that(client, rich_test):
    page = client(ReportDetails(revision=1), rich_test)
    assert shown(page)["Revision"] == f"1 — AMENDED REPORT: what changed is {NOT_STATED}"


def test_every_sheet_has_number_revision_page_and_the_word_synthetic(client, rich_test):
    page = client(ReportDetails(number="17", revision=1, paper="Letter"), rich_test)
    sheet = page.partition("<style>")[2].partition("}\n")[0]
    assert "size: Letter" in sheet
    assert '"Report 17, revision 1 \\28 amended\\29 "' in sheet
    assert '"Page " counter(page) " of " counter(pages)' in sheet
    assert "SYNTHETIC DATA" in sheet
    assert page.count("SYNTHETIC DATA") >= page.count("<svg") + 2


def test_measured_data_are_not_called_synthetic(client, stepwise_test):
    page = client(ReportDetails(), stepwise_test)
    assert "synthetic" not in text_of(page).lower()
    assert "SYNTHETIC" not in page


def test_texts_of_the_laboratory_are_text_on_the_page_and_in_the_margins(client, rich_test):
    details = filled(
        ReportDetails, NASTY, 1, *[NASTY] * 9, decision_rule="guard band",
        laboratory=filled(Laboratory, *[NASTY] * 5), client=filled(Client, *[NASTY] * 4),
        authorised=_Authorised(by=NASTY), instruments=(Instrument(name=NASTY),),
        items={"new": filled(ReportItem, *[NASTY] * 4), NASTY: ReportItem()},
        limits=(limit(1.0, source=NASTY),),
    )  # fmt: skip
    page = client(details, rich_test)
    assert "<script" not in page
    assert page.count("<style>") == page.count("</style>") == 1
    style = page.partition("<style>")[2].partition("</style>")[0]
    assert "import" not in style.replace("\\40 import", "")
    # what is quoted for the margins has no end of string, rule or element in it
    for quoted in re.findall(r'content: "(.*?)";', style):
        assert not set(quoted) & set("<>\"'{}()@;\n\u2028")
    assert NASTY in shown(page)["Method"]


def test_numbers_are_those_of_the_archive(client, rich_test, tmp_path):
    page = client(ReportDetails(), rich_test)
    rows = rows_of(page, "Test T-1")
    with open_archive(tmp_path / "T-1.nc") as archive:
        stiffness = archive["test_apparent_spring_constant"].values
        energy = archive["test_hysteresis_energy"].values
    exact = re.findall(
        r'data-value="([^"]*)"', page.partition("<caption>Test T-1")[2].partition("</table>")[0]
    )
    assert {float(stiffness[0]), float(energy[0])} <= {float(one) for one in exact}
    assert rows[0] == ["quantity", "item", "result", "unit", "k"]
    assert {row[1] for row in rows[1:]} <= {"new", "used"}


def test_segments_within_one_percent_of_strain_keep_their_ends_apart(client, rich_test):
    segments = rich_test.segments
    low = np.full_like(segments.segment_strain_low, 0.0223)
    narrow = replace(segments, segment_strain_low=low, segment_strain_high=low + 0.0031)
    rows = rows_of(client(ReportDetails(), replace(rich_test, segments=narrow)), "Test T-1")
    assert "modulus, ascending, strain 2.23 to 2.54 %" in {row[0] for row in rows}


def test_a_break_stands_among_the_results(client, rich_test):
    description = replace(rich_test.description, kind="tensile")
    page = client(ReportDetails(), replace(rich_test, description=description))
    head, *rows = rows_of(page, "Pulls and weights")
    assert head[:5] == ["specimen", "test", "ends at", "strain [%]", "load [N]"]
    assert "status" not in head
    assert [row[0] for row in rows] == ["new", "used"]


@pytest.fixture
def judged(write, rich_test):
    """Hold one limit against a test: the row of the table, and what stands below it."""

    def judge(one, rule="guard band", units="si"):
        with open_archive(write(rich_test)) as archive:
            details = ReportDetails(decision_rule=rule, limits=(one,))
            table = conformity_table(details, [TestView("t", archive, units)], units)
        return [cell.text for cell in table.rows[0]], table.remarks

    return judge


@pytest.mark.parametrize(
    ("rule", "distance", "expected"),
    [
        ("simple acceptance", -0.1, "conforms"),
        ("guard band", -0.1, "no statement: the interval reaches over a limit"),
        ("guard band", -40, "conforms"),
        ("guard band", 40, "does not conform"),
        ("simple acceptance", 0.1, "does not conform"),
    ],
)
def test_a_limit_is_held_against_the_number_of_the_archive_by_the_rule_that_is_printed(
    judged, write, rich_test, rule, distance, expected
):
    with open_archive(write(rich_test)) as archive:
        middle = float(archive["strain_bin"].values[2])
        value = float(archive["tangent_modulus"].values[0, 0, 2])
        u = float(archive["tangent_modulus_standard_uncertainty"].values[0, 0, 2])
    at = {"specimen": "new", "branch": "ascending", "strain": repr(middle)}
    row, below = judged(limit(value + distance * u, at=at), rule)
    assert row[-1] == expected
    assert float(row[3].split(" ± ")[0]) == pytest.approx(1e-6 * value, abs=1e-6 * u)
    assert RULES[rule] in below


def test_no_limit_makes_no_table():
    assert conformity_table(ReportDetails(), [], "si") is None


@pytest.mark.parametrize(
    ("lower", "upper", "shown"),
    [(1e6, 2e6, "1 to 2"), (1.5e6, None, "≥ 1.5"), (None, 1.2e9, "≤ 1,200")],
)
def test_limits_are_shown_as_they_were_agreed(judged, lower, upper, shown):
    assert judged(limit(lower, upper=upper))[0][4:6] == [shown, "MPa"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"test": "T-9"}, "no statement: there is no archive of the test"),
        (
            {"quantity": "relaxation_time"},
            "no statement: test_relaxation_time does not vary with branch",
        ),
        (
            {"at": {"branch": "ascending"}},
            "no statement: specimen is not stated, and there are several",
        ),
    ],
)
def test_a_limit_of_a_number_that_is_not_there_gives_no_statement_and_says_why(
    judged, change, words
):
    one = limit(1.0).model_copy(update=change)
    row, _ = judged(one)
    assert row[-1].startswith(words)
    assert row[5] == {"tangent_modulus": "MPa", "relaxation_time": "s"}[one.quantity]


def test_a_limit_at_a_place_that_a_number_has_not_is_told_which_it_has(judged):
    row, _ = judged(limit(1.0, at={"hold": "1"}))
    assert row[-1].startswith("no statement: tangent_modulus does not vary with hold; needed at ")
    assert row[-1].endswith("specimen, branch, strain")


def test_us_units_change_what_is_shown(client, rich_test):
    page = client(
        ReportDetails(decision_rule="guard band", limits=(limit(1e6),)), rich_test, units="us"
    )
    assert "[psi]" in page and "[MPa]" not in page


def test_the_page_asks_for_nothing_and_runs_nothing(client, rich_test):
    page = client(ReportDetails(number="1"), rich_test)
    assert "default-src 'none'" in page and "<script" not in page
    assert not re.findall(r'(?:src|href)="(?!#)|url\((?!#)', page)
    assert "<svg" in page


def test_what_the_software_did_with_a_test_stands_there_only_where_it_failed(
    client, rich_test, tmp_path
):
    status = tmp_path / "status.csv"
    head = "test,status,exit_status,message,raw_sha256,seconds\r\n"
    status.write_text(head + "T-1,unchanged,0,,,0\r\n")
    assert rows_of(client(ReportDetails(), rich_test), "Tests in order")[0][-1] == "samples"
    status.write_text(head + "T-1,reduced,0,,,0\r\nT-2,failed,3,broken log,,0\r\n")
    page = client(ReportDetails())
    assert rows_of(page, "Tests in order")[-1][-1] == "failed, no archive"
    assert "T-2: broken log" in text_of(page)


def test_a_figure_that_cannot_be_drawn_is_named(client, rich_test, monkeypatch):
    monkeypatch.setattr(clientfigures, "can_be_drawn", lambda figure: "loops" not in figure.title)
    page = client(ReportDetails(), rich_test)
    assert "Shown only on the page of the campaign: T-1: loops, new" in text_of(page)
    assert "T-1: modulus, new" in page.partition("<svg")[2]


@pytest.mark.parametrize("status", ["failed", OF_NO_TEST])
def test_no_statement_of_conformity_rests_on_an_earlier_run(write, rich_test, status):
    with open_archive(write(rich_test)) as archive:
        middle = repr(float(archive["strain_bin"].values[2]))
        at = {"specimen": "new", "branch": "ascending", "strain": middle}
        details = ReportDetails(decision_rule="guard band", limits=(limit(-1e12, at=at),))
        views = [TestView("t", archive, "si", Status("T-1", one)) for one in ("reduced", status)]
        said = [conformity_table(details, [view], "si").rows[0][-1].text for view in views]
    assert said == ["conforms", "no statement: the archive of the test is of an earlier run"]


def test_a_limit_with_a_power_of_ten_keeps_it(judged):
    at = {"specimen": "new", "branch": "ascending", "strain": "1"}
    row, _ = judged(limit(2e16, at=at))
    assert row[4] == "≥ 2e+10"

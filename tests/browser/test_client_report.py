"""The report to a client as PDF: every field, page x of y on each sheet, figures as vectors."""

import json
import re
import shutil
import subprocess

import pytest
from commandruns import reduction

from reduction.archive.open import open_archive
from reduction.archive.report_details import Laboratory, ReportDetails, keep_details, read_details

TMT = "tmt-synthetic"
A4, LETTER = (595, 842), (612, 792)


@pytest.fixture(scope="session", autouse=True)
def programs(browser):
    """Tests of paper need a browser that prints, and poppler to read what came out."""
    for name in ("pdftotext", "pdfimages", "pdfinfo"):
        if shutil.which(name) is None:
            pytest.skip(f"{name} is not on the path")


def read(name, *arguments):
    done = subprocess.run(
        [shutil.which(name), *map(str, arguments)], capture_output=True, check=True
    )
    return done.stdout.decode()


def pages_of(pdf):
    return read("pdftotext", "-layout", pdf, "-").split("\f")[:-1]


def size_of(pdf):
    found = re.search(r"Page size: +([\d.]+) x ([\d.]+)", read("pdfinfo", pdf))
    return round(float(found[1])), round(float(found[2]))


def printed(folder, reports):
    done = reduction("report", folder, "--reports", reports, "--pdf", "--json")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    (pdf,) = json.loads(done.stdout)["pdfs"]
    return pdf


@pytest.fixture(scope="session")
def pdf(campaigns, tmp_path_factory):
    return printed(campaigns(TMT).processed, tmp_path_factory.mktemp("printed"))


@pytest.fixture(scope="session")
def pages(pdf):
    return pages_of(pdf)


@pytest.fixture(scope="session")
def text(pages):
    return " ".join(" ".join(pages).split())


def test_every_sheet_has_its_number_of_all_and_the_number_of_the_report(pages):
    assert len(pages) > 5
    for number, page in enumerate(pages, start=1):
        assert f"Page {number} of {len(pages)}" in page
        assert "Report SYNTHETIC-0001, revision 1 (amended)" in page
        assert "Example Laboratory (fictitious)" in page
        assert "SYNTHETIC DATA" in page


def test_every_field_of_the_campaign_is_on_paper(text, campaigns):
    details = read_details(campaigns(TMT).processed)
    for given in (
        details.number, details.amendment, details.issued, details.received, details.tested,
        details.method, details.deviations, details.sampling, details.environment, details.opinions,
        details.laboratory.name, details.laboratory.address, details.laboratory.contact,
        details.laboratory.location, details.client.name, details.client.address,
        details.client.order, details.authorised.by, details.authorised.function,
    ):  # fmt: skip
        assert given and " ".join(given.split()) in text
    for item in details.items.values():
        assert item.identification in text


def test_the_statements_of_the_standard_are_there_and_the_end_is_marked(text, pages):
    assert "relate only to the items that were tested" in text
    assert "not to be reproduced except in full" in text
    assert "Decision rule: guard band" in text
    assert "Opinion, not a result of the tests" in text
    assert "not stated" in text  # the temperature of a generated test
    assert "Shown on the screen only" not in text
    assert "End of report SYNTHETIC-0001, revision 1" in pages[-1]
    assert not any("End of report" in page for page in pages[:-1])


def test_numbers_on_paper_are_those_of_the_archive(text, campaigns):
    with open_archive(campaigns(TMT).processed / "T-1.nc") as archive:
        value = float(archive["test_apparent_spring_constant"].values[0])
    of_test = text.partition("Test T-1.")[2].partition("Test T-2.")[0]
    found = re.search(r"apparent spring constant K_ap new ([\d.,]+) ± ([\d.]+) N", of_test)
    half = 0.5 * 10.0 ** -len(found[1].partition(".")[2])
    assert abs(float(found[1].replace(",", "")) - value) <= half


def test_figures_are_vectors(pdf):
    assert len(read("pdfimages", "-list", pdf).splitlines()) == 2  # the heading alone


@pytest.mark.nightly
def test_paper_is_what_the_laboratory_chose(pdf, campaigns, tmp_path):
    assert size_of(pdf) == A4
    folder = tmp_path / "static"
    shutil.copytree(campaigns("buoy-technology-1997").processed, folder)
    keep_details(folder, ReportDetails(paper="Letter"))
    letter = printed(folder, tmp_path)
    assert size_of(letter) == LETTER
    pages = pages_of(letter)
    assert all(f"Page {number} of {len(pages)}" in page for number, page in enumerate(pages, 1))
    assert "SYNTHETIC" not in "".join(pages)
    assert "".join(pages).count("not stated") > 15


@pytest.mark.nightly
def test_nothing_hostile_leaves_its_place(campaigns, tmp_path):
    folder = tmp_path / "static"
    shutil.copytree(campaigns("buoy-technology-1997").processed, folder)
    nasty = '</style><script>document.title=1</script><img src=file:///etc/hostname> "} @page{x}'
    keep_details(
        folder, ReportDetails(number=nasty, method=nasty, laboratory=Laboratory(name=nasty))
    )
    pages = pages_of(printed(folder, tmp_path))
    text = " ".join(" ".join(pages).split())
    assert nasty in text
    assert all(f"Page {number} of {len(pages)}" in page for number, page in enumerate(pages, 1))


def test_the_page_opens_without_an_error_or_a_request(campaigns, visit):
    for width in (1280, 390):
        shown = visit(campaigns(TMT).reports / "client-report.html", width=width)
        assert shown.page.locator("svg").count() > 5
        assert shown.errors == []
        assert shown.beyond == []
        assert shown.page.evaluate("document.documentElement.scrollWidth") <= width


@pytest.mark.nightly
def test_the_page_has_no_serious_fault_for_who_cannot_see_it(campaigns, visit):
    for width in (1280, 390):
        shown = visit(campaigns(TMT).reports / "client-report.html", width=width, bypass_csp=True)
        assert shown.faults() == []


@pytest.mark.nightly
def test_figures_are_inside_the_width_of_the_page(campaigns, visit):
    shown = visit(campaigns(TMT).reports / "client-report.html")
    outside = shown.page.evaluate(
        """[...document.querySelectorAll("svg text")].filter(text => {
             const own = text.getBoundingClientRect(), all = text.closest("svg").getBoundingClientRect();
             return own.left < all.left - 1 || own.right > all.right + 1
               || own.top < all.top - 1 || own.bottom > all.bottom + 1;
           }).map(text => text.textContent)"""
    )
    assert outside == []

"""[report] of campaign.toml: a report to a client beside the page, and no number that depends on it."""

import json
import os
import stat
import sys

import pytest
from commandruns import ROOT, reduction

from reduction.cli import campaigns as printing
from reduction.cli.campaigns import _find_browser, _print_page
from reduction.record.errors import ArchiveError, SettingsError

pytestmark = pytest.mark.slow

RAW = ROOT / "raw" / "buoy-technology-1997"
REPORT = '\n[report]\nnumber = "17"\n[report.client]\nname = "Buoy Company"\n'


@pytest.fixture
def campaign(tmp_path):
    """A measured campaign, to be changed."""
    folder = tmp_path / "raw"
    folder.mkdir()
    for path in RAW.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    return folder / "campaign.toml"


def products(folder):
    return {
        path.name: path.read_bytes()
        for path in (folder / "processed").rglob("*")
        if path.suffix in (".nc", ".csv") and path.name != "status.csv"
    }


def test_no_product_depends_on_it_and_no_test_is_reduced_again(campaign, tmp_path, command):
    text = campaign.read_text()
    assert "client_report" in json.loads(command("run", campaign, "--json", cwd=tmp_path).stdout)
    before = products(tmp_path)
    page = tmp_path / "reports" / "buoy-technology-1997" / "client-report.html"
    assert not page.exists()

    for number in ("17", "18"):
        campaign.write_text(text + REPORT.replace("17", number))
        done = command("run", campaign, "--json", cwd=tmp_path)
        answer = json.loads(done.stdout)
        assert [test["status"] for test in answer["tests"]] == ["unchanged"]
        assert answer["client_report"].endswith("client-report.html")
        assert f"Report {number}, revision 0" in page.read_text()
        assert products(tmp_path) == before

    campaign.write_text(text)
    assert (
        json.loads(command("run", campaign, "--json", cwd=tmp_path).stdout)["client_report"] is None
    )
    assert not page.exists()
    assert products(tmp_path) == before


def test_it_is_made_again_from_the_folder_of_the_archives_alone(campaign, tmp_path, command):
    campaign.write_text(campaign.read_text() + REPORT)
    command("run", campaign, "--quiet", cwd=tmp_path)
    page = tmp_path / "reports" / "buoy-technology-1997" / "client-report.html"
    first = page.read_text()
    page.unlink()
    campaign.unlink()
    done = command("report", "processed/buoy-technology-1997", cwd=tmp_path)
    assert "report to the client: " in done.stdout
    assert page.read_text() == first


def test_printing_without_a_report_says_what_is_missing(campaign, tmp_path, command):
    command("run", campaign, "--quiet", cwd=tmp_path)
    done = command("report", "processed/buoy-technology-1997", "--pdf", cwd=tmp_path)
    assert done.returncode == 2
    assert "there is no client report to print" in done.stderr
    assert "[report] in campaign.toml" in done.stderr


def test_without_a_browser_the_page_is_there_and_the_message_says_how_to_print_it(
    campaign, tmp_path, command
):
    campaign.write_text(campaign.read_text() + REPORT)
    command("run", campaign, "--quiet", cwd=tmp_path)
    done = reduction(
        "report", "processed/buoy-technology-1997", "--pdf", cwd=tmp_path,
        BROWSER_PROGRAM="no-such-browser",
    )  # fmt: skip
    assert done.returncode == 2
    assert "BROWSER_PROGRAM is not a program; found 'no-such-browser'" in done.stderr
    assert "Open the page in any browser and print it to PDF" in done.stderr
    folder = tmp_path / "reports" / "buoy-technology-1997"
    assert (folder / "client-report.html").exists() and not (folder / "client-report.pdf").exists()


def test_a_machine_without_any_browser_is_told_which_would_do(monkeypatch):
    monkeypatch.delenv("BROWSER_PROGRAM", raising=False)
    monkeypatch.setattr(printing.shutil, "which", lambda name: None)
    with pytest.raises(
        SettingsError, match="no browser found to print.*Chromium nor Chrome nor Edge"
    ):
        _find_browser()


def test_the_browser_that_is_named_is_taken_before_any_other(monkeypatch):
    monkeypatch.setenv("BROWSER_PROGRAM", sys.executable)
    assert _find_browser() == sys.executable


@pytest.fixture
def program(tmp_path):
    """Make a program that stands for a browser."""

    def make(text):
        path = tmp_path / "browser"
        path.write_text(f"#!{sys.executable}\n{text}\n")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)

    return make


needs_scripts = pytest.mark.skipif(os.name != "posix", reason="a script stands for the browser")


@needs_scripts
def test_a_browser_that_prints_nothing_is_named_with_its_last_word(tmp_path, program):
    pdf = tmp_path / "out" / "report.pdf"
    browser = program("import sys; sys.exit('no display')")
    with pytest.raises(ArchiveError, match=r"report\.pdf was not printed; found .*no display"):
        _print_page(tmp_path / "page.html", pdf, browser=browser)
    assert list(pdf.parent.iterdir()) == []


@needs_scripts
def test_what_is_no_pdf_does_not_become_one(tmp_path, program):
    pdf = tmp_path / "report.pdf"
    pdf.write_bytes(b"%PDF- an earlier one")
    browser = program(
        "import sys; name = [a for a in sys.argv if a.startswith('--print-to-pdf=')][0]\n"
        "open(name.partition('=')[2], 'w').write('<html>')"
    )
    with pytest.raises(ArchiveError, match="no reason given"):
        _print_page(tmp_path / "page.html", pdf, browser=browser)
    assert pdf.read_bytes() == b"%PDF- an earlier one"


@needs_scripts
def test_a_browser_that_hangs_is_ended(tmp_path, program, monkeypatch):
    monkeypatch.setattr(printing, "_LONGEST", 0.2)
    with pytest.raises(ArchiveError, match="did not finish the report; found .*ended after 0.2 s"):
        _print_page(
            tmp_path / "page.html", tmp_path / "report.pdf",
            browser=program("import time; time.sleep(60)"),
        )  # fmt: skip


def test_a_program_that_cannot_be_started_is_named(tmp_path):
    with pytest.raises(ArchiveError, match="the browser cannot be started; found .*nowhere"):
        _print_page(
            tmp_path / "page.html", tmp_path / "report.pdf", browser=str(tmp_path / "nowhere")
        )


@needs_scripts
def test_the_browser_gets_no_network_and_a_profile_of_its_own(tmp_path, program):
    listed = tmp_path / "arguments"
    browser = program(
        f"import sys; open({str(listed)!r}, 'w').write('\\n'.join(sys.argv[1:]))\n"
        "name = [a for a in sys.argv if a.startswith('--print-to-pdf=')][0]\n"
        "open(name.partition('=')[2], 'w').write('%PDF-1.4')"
    )
    _print_page(tmp_path / "page.html", tmp_path / "report.pdf", browser=browser)
    given = listed.read_text().splitlines()
    assert "--host-resolver-rules=MAP * ~NOTFOUND" in given
    assert "--proxy-server=127.0.0.1:9" in given
    profile = next(one for one in given if one.startswith("--user-data-dir="))
    assert not os.path.exists(profile.partition("=")[2])
    assert given[-1] == (tmp_path / "page.html").as_uri()

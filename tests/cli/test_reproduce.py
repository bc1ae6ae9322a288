"""`reduction reproduce`: text, keys of --json, files, exit statuses."""

import json
from dataclasses import replace

import pytest
from commandruns import answered
from csvrows import csv_rows

from reduction.published import reproduce_page as reports
from reduction.published.printed_cells import REPORTS, cells_of, errata_of

SETTINGS, DATA = 2, 4
KEYS = {"cells", "derived", "closed", "repeated", "erratum", "open", "measured", "unexplained"}


def test_keys_of_the_contract(command):
    done = command("reproduce", "--json")
    answer = answered(done)
    assert list(answer["reports"]) == list(REPORTS)
    assert all(set(counts) == KEYS for counts in answer["reports"].values())
    assert sum(one["cells"] for one in answer["reports"].values()) == len(answer["items"])
    fixed = {"report", "table", "cell", "printed", "recomputed", "verdict", "erratum"}
    assert all(fixed <= set(item) for item in answer["items"])
    assert {one["unexplained"] for one in answer["reports"].values()} == {0}
    known = {one["id"] for one in answer["errata"]}
    assert {item["erratum"] for item in answer["items"]} - {None} <= known


def test_one_report_in_words(command):
    done = command("reproduce", "Zhang-2015")
    assert done.returncode == 0 and done.stderr == ""
    lines = [line.split() for line in done.stdout.splitlines()]
    heading = "Zhang-2015 cells derived closed repeated erratum open measured unexplained"
    assert lines[0] == heading.split()
    assert ["7", "168", "132", "0", "0", "36", "0", "0", "0"] in lines
    assert ["all", "261", "189", "0", "0", "52", "2", "18", "0"] in lines
    assert "ZH-10" in done.stdout and "WA-1" not in done.stdout
    # what is open, with what it may be
    assert "level 4 waves" in done.stdout and "4.17 s at 3 m" in " ".join(done.stdout.split())


def test_all_reports_end_with_their_sum(command):
    done = command("reproduce")
    lines = [line.split() for line in done.stdout.splitlines()]
    assert [line[0] for line in lines[-6:]] == [*REPORTS, "all"]
    assert lines[-1][-1] == "0"


def test_page_and_table_go_to_a_folder(command, tmp_path):
    done = command("reproduce", "Wang-2022", "--out", "found", cwd=tmp_path)
    assert done.returncode == 0
    assert {path.name for path in (tmp_path / "found").iterdir()} == {
        "reproduce.html", "reproduce.csv",
    }  # fmt: skip
    rows = csv_rows(tmp_path / "found" / "reproduce.csv")
    assert [row["printed"] for row in rows] == [cell.printed for cell in cells_of("Wang-2022")]
    assert "page: found/reproduce.html" in done.stdout
    again = command("reproduce", "Wang-2022", "--out", "found", "--json", cwd=tmp_path)
    assert json.loads(again.stdout)["out"] == "found"


def test_quiet_says_nothing(command):
    done = command("reproduce", "Wang-2022", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_an_unknown_report_is_refused(command):
    done = command("reproduce", "WHOI-2006-01")
    assert done.returncode == SETTINGS
    assert (
        "there is no such report; found 'WHOI-2006-01'; needed one of WHOI-2004-06" in done.stderr
    )


@pytest.mark.parametrize("options", [(), ("--json",), ("--quiet",)])
def test_an_unexplained_cell_fails_the_command(command, monkeypatch, options):
    good = reports.reproduce("Wang-2022")["Wang-2022"]
    wrong = replace(good[0], verdict="unexplained", recomputed=210_001.0, how="a guess")
    monkeypatch.setitem(reports._ITEMS, "Wang-2022", lambda: [wrong, *good[1:]])
    done = command("reproduce", "Wang-2022", *options)
    assert done.returncode == DATA
    assert done.stderr == (
        "Wang-2022, table 1, steel of the wires, elastic_modulus: printed number does not come "
        "back; found 210,000 MPa; needed 210,001.00 (a guess).\n"
    )
    if options == ("--json",):
        assert json.loads(done.stdout)["reports"]["Wang-2022"]["unexplained"] == 1


def test_one_erratum_is_given_with_its_evidence_and_cells(command):
    done = command("reproduce", "--erratum", "cg-39")
    assert done.returncode == 0, done.stderr
    (known,) = (one for one in errata_of("CG-D-39-80") if one.id == "CG-39")
    assert f"evidence: {known.evidence}" in done.stdout
    assert "CG-38" not in done.stdout.partition("evidence")[0]
    answer = json.loads(command("reproduce", "CG-D-39-80", "--erratum", "CG-39", "--json").stdout)
    assert answer["corrected"] == known.corrected
    assert {item["erratum"] for item in answer["items"]} <= {"CG-39"}


def test_an_erratum_that_is_not_known_is_refused(command):
    done = command("reproduce", "--erratum", "XX-1")
    assert done.returncode == SETTINGS
    assert "there is no such erratum; found 'XX-1'; needed one of " in done.stderr


def test_the_columns_are_explained(command):
    text = command("reproduce", "Wang-2022").stdout
    for word in (
        "derived:",
        "closed:",
        "repeated:",
        "measured:",
        "unexplained:",
        "right is",
        "sure how",
    ):
        assert word in text

import csv
import io
import tomllib
from pathlib import Path

import pytest

from reduction.campaign.load import load_campaign
from reduction.errors import LogError, SettingsError
from reduction.ingest.starter import starter_campaign

SHARED = Path(__file__).parents[2].parent / "shared"
DATA = SHARED / "data"
LOG = "time_s,crosshead_ft,load_new_lb,load_used_lb\n0,12,1,2\n1,13,2,3\n2,14,3,4\n"
ONE = "Zeit;Kraft\ns;kN\n0;1,5\n1;2,5\n2;3,5\n"


def rows(files):
    return list(csv.DictReader(io.StringIO(files["tests.csv"])))


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "summer tests"
    folder.mkdir()
    for name in ("T-2.csv", "T-10.csv", "T-1.csv"):
        (folder / name).write_text(LOG)
    (folder / "über 5.txt").write_text(ONE, encoding="latin-1")
    (folder / "notes.md").write_text("just words\n")
    (folder / ".hidden.csv").write_text(LOG)
    (folder / "campaign.toml").write_text("")
    (folder / "marks.csv").write_text("test,specimen,hold,near_toe_ft,far_toe_ft,far_thimble_ft\n")
    (folder / "deeper").mkdir()
    return folder


def test_each_log_has_a_row_in_natural_order(folder):
    table = rows(starter_campaign(folder))
    assert [row["file"] for row in table] == ["T-1.csv", "T-2.csv", "T-10.csv", "über 5.txt"]
    assert [row["id"] for row in table] == ["T-1", "T-2", "T-10", "ber-5"]
    assert list(table[0]) == ["id", "kind", "file", "layout", "order", "specimens"]
    assert {row["order"] for row in table} == {""}


def test_logs_that_look_alike_share_a_layout(folder):
    files = starter_campaign(folder)
    assert [row["layout"] for row in rows(files)] == ["log", "log", "log", "log-2"]
    assert set(tomllib.loads(files["campaign.toml"])["layouts"]) == {"log", "log-2"}


def test_each_test_has_as_many_specimens_as_its_log_has_loads(folder):
    table = rows(starter_campaign(folder))
    assert table[0]["specimens"] == "specimen-1;specimen-2"
    assert table[-1]["specimens"] == "specimen-1"


def test_marks_are_used_and_what_is_no_log_is_listed(folder):
    (folder / "marks-2.csv").write_text((folder / "marks.csv").read_text())
    text = starter_campaign(folder)["campaign.toml"]
    assert tomllib.loads(text)["defaults"]["strain"] == {"marks": "marks-2.csv"}
    assert "#   notes.md: no table of numbers" in text
    assert "#   marks.csv: another table of marks" in text
    assert ".hidden" not in text


def test_two_files_of_one_name_have_two_ids(folder):
    (folder / "T-1.txt").write_text(LOG)
    names = [row["id"] for row in rows(starter_campaign(folder))]
    assert names[:2] == ["T-1", "T-1-2"]


def test_a_file_without_position_or_load_is_no_log(tmp_path):
    (tmp_path / "T-1.csv").write_text(LOG)
    (tmp_path / "diameters.csv").write_text("a,b\n1,2\n2,3\n3,4\n")
    text = starter_campaign(tmp_path)["campaign.toml"]
    assert "#   diameters.csv: no column looks like a position or a load" in text


def test_a_folder_without_logs_is_refused(tmp_path):
    with pytest.raises(LogError, match="the folder holds no log; found no files"):
        starter_campaign(tmp_path)
    (tmp_path / "notes.md").write_text("words\n")
    with pytest.raises(LogError, match=r"found notes\.md: no table of numbers"):
        starter_campaign(tmp_path)


def test_the_draft_loads_once_every_question_is_answered(folder):
    files = starter_campaign(folder)
    (folder / "marks.csv").unlink()
    for name, text in starter_campaign(folder).items():
        (folder / name).write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError):
        load_campaign(folder / "campaign.toml")
    answered = (
        files["campaign.toml"]
        .replace('strain = { marks = "marks.csv" }\n', "")
        .replace('datum = "?"', 'datum = "pin-to-pin"')
        .replace('kind = "?"', 'kind = "rope"')
        .replace('diameter = ["?"]', 'diameter = ["1 in"]')
    )
    (folder / "campaign.toml").write_text(answered, encoding="utf-8")
    campaign = load_campaign(folder / "campaign.toml")
    assert campaign.id == "summer-tests"
    assert list(campaign.tests) == ["T-1", "T-2", "T-10", "ber-5"]


@pytest.mark.skipif(not SHARED.exists(), reason="the reference logs are not there")
def test_the_draft_for_the_tether_tests_has_every_log_and_sheet():
    files = starter_campaign(DATA / "tmt-synthetic")
    table = rows(files)
    assert [row["layout"] for row in table[:10]] == ["log"] * 10
    assert [row["layout"] for row in table[10:]][-1] == "xlsx-Overnight-Hold"
    assert len(table) == 17
    assert "diameters.csv" in files["campaign.toml"]

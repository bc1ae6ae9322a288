"""The table of results of a campaign: where it is named, what completes it, what is refused."""

import hashlib

import pytest

from reduction.campaign.load import load_campaign
from reduction.record.errors import LogError, SettingsError

ROWS = (
    "id,quantity,specimen,line,condition,value_lbf,peak_load_lbf\n"
    "B-1,tensile_strength,N-1,PD,,6400,\n"
    "B-2,tensile_strength,,PD,worn,4672,\n"
)
SHEET = """
[specimens.N-1]
kind = "rope"
material = "nylon"
condition = "new"
diameter = "0.5 in"
"""
CAMPAIGN = '[campaign]\nid = "c"\ntitle = "t"\n'
NAMED = CAMPAIGN + 'results = "results.csv"\n'
TEST = """
[specimens.a]
kind = "rope"
diameter = "0.5 in"
[layouts.l]
format = "delimited"
[layouts.l.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "p", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "f", unit = "lbf" }
[tests.outcomes]
file = "T.csv"
layout = "l"
specimens = ["a"]
"""


@pytest.fixture
def load(tmp_path):
    def loaded(text, rows=ROWS):
        (tmp_path / "T.csv").write_text("t,p,f\n0,1,2\n")
        (tmp_path / "results.csv").write_text(rows, encoding="utf-8")
        (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
        return load_campaign(tmp_path / "campaign.toml")

    return loaded


@pytest.mark.parametrize(
    "text", [NAMED, 'results = "results.csv"\n' + CAMPAIGN, 'results = "results.csv"\n' + NAMED]
)
def test_results_alone_are_a_campaign(load, text):
    campaign = load(text, ROWS.replace("N-1", ""))
    assert campaign.tests == {} and len(campaign.outcomes) == 2
    assert campaign.results.name == "results.csv"
    content = ROWS.replace("N-1", "").encode()
    assert campaign.results.sha256 == hashlib.sha256(content).hexdigest()
    assert "results" not in campaign.attributes


def test_a_row_is_completed_from_the_sheet_of_its_specimen(load):
    first, second = load(NAMED + SHEET).outcomes
    assert (first.material, first.condition) == ("nylon", "new")
    assert first.diameter == pytest.approx(0.0127)
    assert (second.material, second.condition) == ("", "worn")


def test_a_campaign_without_results_has_no_outcomes(load):
    campaign = load(CAMPAIGN + TEST.replace("[tests.outcomes]", "[tests.one]"))
    assert campaign.results is None and campaign.outcomes == ()


def test_a_specimen_without_a_sheet_is_refused_with_its_row(load):
    message = r"results.csv:2 \[specimen\]: .*unknown specimen; found 'N-1'; needed one of N-2"
    with pytest.raises(LogError, match=message):
        load(NAMED + SHEET.replace("N-1", "N-2"))
    with pytest.raises(LogError, match=r"needed \[specimens.NAME\]. Put the name"):
        load(NAMED)


def test_an_open_question_in_the_results_is_told_with_its_place(load):
    for text in (NAMED, 'results = "results.csv"\n' + CAMPAIGN):
        with pytest.raises(SettingsError, match=r"still '\?'.*\n  results.csv:3 \[value_lbf\]"):
            load(text + SHEET, ROWS.replace("4672", "?"))


def test_two_tables_of_results_are_refused(load):
    with pytest.raises(
        SettingsError, match="results is stated both above .campaign. and in it; found a.c"
    ):
        load('results = "a.csv"\n' + NAMED)


def test_a_table_outside_the_folder_and_one_that_is_not_there_are_refused(load):
    with pytest.raises(SettingsError, match="lies outside the campaign folder"):
        load(NAMED.replace('"results.csv"', '"../results.csv"'))
    with pytest.raises(LogError, match="the file is not there"):
        load(NAMED.replace('"results.csv"', '"none.csv"'))


def test_a_test_may_not_have_the_name_of_the_product_of_the_results(load):
    with pytest.raises(SettingsError, match="test 'outcomes' has the name of another archive"):
        load(NAMED + TEST, ROWS.replace("N-1", ""))

"""results.csv: units, words, and every row that cannot be used."""

import hashlib
import math
import re
from pathlib import Path

import pytest

from reduction.campaign.load import load_campaign
from reduction.campaign.outcome_results import _read_results
from reduction.record.errors import LogError, SettingsError

HEADER = "id,quantity,line,condition,exposure_years,value,unit,place,valid,run_out,note"


def write(tmp_path, *lines, header=HEADER):
    path = tmp_path / "results.csv"
    path.write_text("\n".join([header, *lines]) + "\n", encoding="utf-8")
    return path


def read(tmp_path, *lines, header=HEADER):
    return _read_results(write(tmp_path, *lines, header=header))


def test_a_break_is_read_in_si(tmp_path):
    (row,) = read(tmp_path, "B-1,tensile_strength,PD,5yr,5,3241,lbf,free,yes,,pulled at noon")
    assert row.value == pytest.approx(3241 * 4.4482216152605)
    assert (row.test, row.line, row.condition, row.exposure) == ("B-1", "PD", "5yr", 5.0)
    assert (row.place, row.is_valid, row.is_suspended) == ("free", True, False)
    assert (row.note, row.row, row.use) == ("pulled at noon", 2, "value")


def test_quantities_of_one_file_have_units_of_their_own(tmp_path):
    rows = read(
        tmp_path,
        "B-1,tensile_strength,,,,6.4,kip,,,,",
        "B-1,Strain at failure,,,,13.2,%,,,,",
        "S-1,cycles-to-failure,,,,200000,cycles,,,yes,",
        "A-1,abrasion_cycles,,,,8134,,,,,",
    )
    assert [row.value for row in rows] == pytest.approx([28468.6, 0.132, 2e5, 8134], rel=1e-5)
    assert [row.use for row in rows] == ["value", "value", "lower_bound", "value"]
    assert [row.row for row in rows] == [2, 3, 4, 5]


def test_a_suffix_or_brackets_are_the_unit(tmp_path):
    header = "test,quantity,value_lbf,value [%],diameter_in,peak_load_pct_RBS,minimum_load [N]"
    rows = read(
        tmp_path, "1,tensile_strength,100,,0.5,,", "1,strain_at_failure,,20,0.5,,",
        "2,tensile_strength,90,,0.5,62,150", header=header,
    )  # fmt: skip
    assert [row.value for row in rows] == pytest.approx([444.82216, 0.2, 400.33994])
    assert rows[0].diameter == pytest.approx(0.0127)
    assert math.isnan(rows[0].peak_load) and math.isnan(rows[0].peak_load_ratio)
    assert rows[2].peak_load_ratio == pytest.approx(0.62) and math.isnan(rows[2].peak_load)
    assert rows[2].minimum_load == 150 and math.isnan(rows[2].minimum_load_ratio)


def test_a_load_in_newton_is_read(tmp_path):
    header = "quantity,value,minimum_load_lbf,peak_load_kN"
    (row,) = read(tmp_path, "cycles_to_failure,5000,0,9.5", header=header)
    assert (row.minimum_load, row.peak_load) == (0.0, 9500.0)


@pytest.mark.parametrize("place", ["splice", "Thimble", "grip"])
def test_a_break_in_the_termination_is_not_valid_unless_the_laboratory_says_so(tmp_path, place):
    rows = read(
        tmp_path,
        f"B-1,tensile_strength,,,,5000,lbf,{place},,,",
        f"B-2,tensile_strength,,,,5000,lbf,{place},yes,,",
    )
    assert [row.use for row in rows] == ["lower_bound", "value"]


def test_a_break_at_the_toe_is_one_of_the_line(tmp_path):
    (row,) = read(tmp_path, "B-1,tensile_strength,,,,5000,lbf,splice toe,,,")
    assert (row.place, row.use) == ("splice_toe", "value")


def test_an_invalid_test_may_have_no_value(tmp_path):
    (row,) = read(tmp_path, "B-1,tensile_strength,,,,,lbf,,no,,slipped")
    assert math.isnan(row.value) and row.use == "excluded"


def test_columns_of_ones_own_are_kept_as_notes(tmp_path):
    header = "quantity,value_lbf,note,machine,Prüfer"
    (row,) = read(tmp_path, "tensile_strength,10,dry,M1,Groß", header=header)
    assert row.note == "dry; machine: M1; Prüfer: Groß"


def test_blank_lines_are_counted_and_left_out(tmp_path):
    rows = read(
        tmp_path, "", "A,tensile_strength,,,,1,N,,,,", ",,,,,,,,,,", "B,tensile_strength,,,,2,N,,,,"
    )
    assert [row.row for row in rows] == [3, 5]


GOOD = "B-1,tensile_strength,PD,new,0,6400,lbf,free,yes,no,"
BAD = {
    "quantity": ("B-1,strength,,,,1,N,,,,", r":2 \[quantity\]: a quantity has no known name; found "
                 "'strength'; needed tensile_strength, strain_at_failure"),
    "place": ("B-1,tensile_strength,,,,1,N,one foot off,,,", r":2 \[place\]: a place has no known "
              "name; found 'one foot off'; needed free, splice_toe"),
    "open place": ("B-1,tensile_strength,,,,1,N,?,,,", r":2 \[place\]: a place has no known name"),
    "valid": ("B-1,tensile_strength,,,,1,N,,maybe,,", r":2 \[valid\]: valid is neither yes nor no"),
    "run-out": ("B-1,tensile_strength,,,,1,N,,,2e5,", r":2 \[run_out\]: run_out is neither yes nor"),
    "number": ("B-1,tensile_strength,,,,6400 lbf,lbf,,,,", r":2 \[value\]: a value is not a number; "
               "found '6400 lbf'"),
    "not finite": ("B-1,tensile_strength,,,,inf,lbf,,,,", r":2 \[value\]: a value is not a number"),
    "decimal comma": ('B-1,tensile_strength,,,,"6,4",kip,,,,', r":2 \[value\]: a value is not a num"),
    "nothing": ("B-1,tensile_strength,,,,0,lbf,,,,", r":2 \[value\]: a value is not above zero"),
    "no value": ("B-1,tensile_strength,,,,,lbf,,,,", r":2 \[value\]: a row has no value; .*valid = no"),
    "no unit": ("B-1,tensile_strength,,,,6400,,,,,", r":2 \[value\]: a value has no unit; found "
                "'6400'; needed a unit of force"),
    "strain in lbf": ("B-1,strain_at_failure,,,,1,lbf,,,,", r":2 \[value\]: unit 'lbf' is not a unit"),
    "cycles in lbf": ("B-1,abrasion_cycles,,,,1,lbf,,,,", r":2 \[value\]: unit 'lbf' is not a unit"),
    "no such unit": ("B-1,tensile_strength,,,,1,lbz,,,,", r":2 \[value\]: unit 'lbz' is not known"),
    "share": ("B-1,tensile_strength,,,,98,%RBS,,,,", r":2 \[value\]: a strength is given as a share"),
    "exposure": ("B-1,tensile_strength,,,-1,98,lbf,,,,", r":2 \[exposure_years\]: exposure cannot be"),
    "cells": ("B-1,tensile_strength", ":2: the number of cells in a row differs from the header; found 2"),
    "twice": (f"{GOOD}\n{GOOD}", ":3: tensile_strength of a test is listed twice; found 'B-1', also in "
              "row 2"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_a_row_that_cannot_be_used_is_refused_by_its_place(tmp_path, name):
    row, message = BAD[name]
    with pytest.raises(LogError, match=r"results\.csv" + message):
        read(tmp_path, row)


HEADERS = {
    "no quantity": ("value_lbf", "the table of results has no usable header; found value_lbf"),
    "no value": ("quantity,unit", "the table of results has no usable header"),
    "twice": ("quantity,value,line,line", "the table of results has no usable header"),
    "two names": ("id,test,quantity,value", "the table of results has no usable header"),
    "misspelt": ("quantity,value_lbf,suspendd", r"\[suspendd\]: unknown column name; needed "
                 r"suspended\?"),
    "two loads": ("quantity,value,peak_load_N,peak_load_lbf", r"\[peak_load_lbf\]: two columns contain"),
    "no unit": ("quantity,value,peak_load", r"\[peak_load\]: peak_load has no unit; needed a header "
                "such as peak_load_lbf"),
    "no length": ("quantity,value,diameter", "a header such as diameter_in"),
    "no time": ("quantity,value,exposure", "a header such as exposure_years"),
}  # fmt: skip


@pytest.mark.parametrize("name", HEADERS)
def test_a_header_that_cannot_be_used_is_refused(tmp_path, name):
    header, message = HEADERS[name]
    with pytest.raises(LogError, match=r"results\.csv:1.*" + message):
        read(tmp_path, header=header)


def test_two_values_in_a_row_are_refused(tmp_path):
    with pytest.raises(LogError, match=r":2 \[value_kN\]: a row has two values; found '2'"):
        read(tmp_path, "tensile_strength,1,2", header="quantity,value_lbf,value_kN")


def test_loads_that_cannot_be_are_refused(tmp_path):
    header = "quantity,value,minimum_load_N,peak_load_N"
    with pytest.raises(LogError, match=r":2 \[minimum_load_N\]: a load is below zero; found '-5'"):
        read(tmp_path, "cycles_to_failure,10,-5,10", header=header)
    with pytest.raises(LogError, match=r":2 \[minimum_load_N\]: the minimum load is not below the"):
        read(tmp_path, "cycles_to_failure,10,10,10", header=header)


def test_files_that_cannot_be_read_are_refused(tmp_path):
    with pytest.raises(LogError, match="the table of results has no rows; needed one row"):
        read(tmp_path)
    path = tmp_path / "results.csv"
    path.write_bytes(b"quantity,value\n\xff")
    with pytest.raises(LogError, match="the table of results is not UTF-8 text"):
        _read_results(path)
    with pytest.raises(LogError, match="the table of results cannot be read; found No such file"):
        _read_results(tmp_path / "none.csv")


def test_the_table_of_the_documents_is_read(tmp_path):
    text = (Path(__file__).parents[2] / "docs" / "campaign.md").read_text(encoding="utf-8")
    section = text.partition("## Outcomes without a log")[2].partition("\n## ")[0]
    (table,) = re.findall(r"^```csv\n(.*?)^```$", section, re.MULTILINE | re.DOTALL)
    rows = read(tmp_path, *table.splitlines()[1:], header=table.splitlines()[0])
    assert [row.use for row in rows] == (
        ["value"] * 2 + ["lower_bound", "value", "lower_bound"] + ["value"] * 2
    )
    assert all(f"`{name}" in section for name in table.splitlines()[0].split(",") if name != "unit")


# the table of results of a campaign: where it is named, what completes it, what is refused

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

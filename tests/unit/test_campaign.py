"""campaign.toml, tests.csv and marks.csv: what is read, and what is refused with which words."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import reduction
from reduction.campaign.load import _read_marks, load_campaign
from reduction.campaign.toml_file import read_csv_rows
from reduction.record.errors import DataError, LogError, SettingsError

ROOT = Path(__file__).parents[2]
BASE = """
[campaign]
id = "c"
title = "t"
[specimens.a]
kind = "rubber tether"
diameter = ["1 inch", "1.2 inch"]
[layouts.l]
format = "delimited"
[layouts.l.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "p", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "f", unit = "lbf" }
[defaults]
layout = "l"
specimens = ["a"]
"""
TEST = '[tests.T]\nfile = "T.csv"\n'
MARKS = "test,specimen,hold,near_toe_ft,far_toe_ft,far_thimble_ft\nT,a,slack,2,10,12\n"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "T.csv").write_text("t,p,f\n0,1,2\n")
    return tmp_path


def load(folder, text):
    path = folder / "campaign.toml"
    path.write_text(text, encoding="utf-8")
    return load_campaign(path)


def test_defaults_fill_what_a_test_leaves_out(folder):
    campaign = load(
        folder,
        BASE
        + 'medium = "dry"\n[defaults.reduction.cycles]\ntrim_threshold = 0.9\n'
        + TEST
        + "order = 3\n",
    )
    plan = campaign.tests["T"]
    assert plan.kind == "cyclic" and plan.specimens == ("a",) and plan.order == 3
    assert plan.attributes["medium"] == "dry"
    assert plan.settings.cycles.trim_threshold == 0.9
    assert campaign.specimens["a"].mean_diameter == pytest.approx(1.1 * 0.0254)


def test_a_folder_stands_for_its_campaign(folder):
    load(folder, BASE + TEST)
    assert load_campaign(folder).path == folder / "campaign.toml"
    assert list(load_campaign(folder).tests) == ["T"]


def test_reference_tension_may_be_a_share_of_the_specimen_s_own_strength(folder):
    stated = 'gauge_length = "2 m"\nreference_tension = "2 %RBS"\n'
    strong = BASE.replace("[layouts.l]", stated + 'rated_break_strength = "30 kN"\n[layouts.l]')
    specimen = load(folder, strong + TEST).specimens["a"]
    assert specimen.reference_tension == pytest.approx(600.0)
    with pytest.raises(SettingsError, match="no break strength"):
        load(folder, BASE.replace("[layouts.l]", stated + "[layouts.l]") + TEST)


def test_what_a_specimen_had_seen_and_how_a_test_flexes_it(folder):
    # WHOI-2004-06, sec. 3.0: 1,000,000 flex cycles at +/-30 deg, 600,000 of tension
    seen = "earlier_cycles = 115000\nearlier_flex_cycles = 0\n"
    text = BASE.replace("[layouts.l]", seen + "[layouts.l]")
    flexed = 'unlogged_cycles = 600000\nn_flex_cycles = 1000000\nflex_angle = "30 deg"\n'
    campaign = load(folder, text + TEST + flexed)
    specimen, plan = campaign.specimens["a"], campaign.tests["T"]
    assert (specimen.earlier_cycles, specimen.earlier_flex_cycles) == (115_000, 0)
    assert (plan.unlogged_cycles, plan.n_flex_cycles) == (600_000, 1_000_000)
    kept = {name: plan.attributes[name] for name in ("unlogged_cycles", "n_flex_cycles")}
    assert kept == {"unlogged_cycles": "600000", "n_flex_cycles": "1000000"}
    assert plan.attributes["flex_angle"] == "30 deg"
    bare = load(folder, BASE + TEST)
    assert bare.specimens["a"].earlier_flex_cycles is None
    assert "n_flex_cycles" not in bare.tests["T"].attributes


def test_a_row_of_the_table_says_how_it_was_flexed(folder):
    (folder / "tests.csv").write_text(
        "id,file,unlogged_cycles,n_flex_cycles,flex_angle\nT,T.csv,3,0,30 deg\n"
    )
    plan = load(folder, 'tests = "tests.csv"\n' + BASE).tests["T"]
    assert (plan.unlogged_cycles, plan.n_flex_cycles) == (3, 0)
    assert plan.attributes["n_flex_cycles"] == "0"


@pytest.mark.parametrize("quote", ["", '"'])
def test_the_date_of_a_test_is_one_of_toml_or_text(folder, quote):
    keys = f"date = {quote}2026-03-05{quote}\ncalibration_due = {quote}2027-01-31{quote}\n"
    found = load(folder, BASE + TEST + keys).tests["T"].attributes
    assert (found["date"], found["calibration_due"]) == ("2026-03-05", "2027-01-31")


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ('flex_angle = "30 ft"', r"tests\.T\.flex_angle"),
        ("n_flex_cycles = -1", r"tests\.T\.n_flex_cycles"),
        ("unlogged_cycles = -1", r"tests\.T\.unlogged_cycles"),
    ],
)
def test_flexing_that_cannot_be_is_refused(folder, key, message):
    with pytest.raises(SettingsError, match=message):
        load(folder, BASE + TEST + key + "\n")


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ('gauge_length_standard_uncertainty = "1 mm"', "is stated alone"),
        ('gauge_length = "1 m"\ngauge_length_standard_uncertainty = "0 mm"', "not positive"),
        ("earlier_cycles = -1", r"specimens\.a\.earlier_cycles"),
        ('linear_density = "0 kg/m"', r"specimens\.a\.linear_density: is not positive"),
        ('linear_density = "3 lbf"', r"specimens\.a\.linear_density"),
        (
            'linear_density = "0.1 kg/m"\nwet_linear_density = "0.1 kg/m"',
            r"wet_linear_density is not below linear_density; found 0\.1 kg/m, 0\.1 kg/m",
        ),
    ],
)
def test_a_specimen_that_cannot_be_so_is_refused(folder, keys, message):
    with pytest.raises(SettingsError, match=message):
        load(folder, BASE.replace("[layouts.l]", keys + "\n[layouts.l]") + TEST)


def test_a_specimen_states_its_mass_a_length_in_air_and_in_water(folder):
    keys = 'linear_density = "0.0672 lb/ft"\nwet_linear_density = "-10 g/m"\n'
    found = load(folder, BASE.replace("[layouts.l]", keys + "[layouts.l]") + TEST).specimens["a"]
    assert found.linear_density == pytest.approx(0.0672 * 0.45359237 / 0.3048)
    assert found.wet_linear_density == pytest.approx(-0.01)  # it floats
    assert load(folder, BASE + TEST).specimens["a"].linear_density is None


def test_the_uncertainty_of_a_gauge_length_is_a_length(folder):
    keys = 'gauge_length = "96 in"\ngauge_length_standard_uncertainty = "0.05 in"\n'
    campaign = load(folder, BASE.replace("[layouts.l]", keys + "[layouts.l]") + TEST)
    assert campaign.specimens["a"].gauge_length_standard_uncertainty == pytest.approx(0.00127)


def test_a_test_overrides_the_defaults(folder):
    text = BASE + TEST + '[tests.T.reduction.modulus]\nwindow = "12 %"\n'
    assert load(folder, text).tests["T"].settings.modulus.window == pytest.approx(0.12)


def test_tension_channels_are_read_from_nested_toml(folder):
    channels = load(folder, BASE + TEST).layouts["l"].channels
    assert set(channels) == {"time", "crosshead_position", "tension.1"}


def test_one_row_a_test_in_a_table(folder):
    (folder / "tests.csv").write_text(
        "id,file,kind,order,target_strain,note\nT,T.csv,fatigue,2,75 %;1.25,slow\nU,T.csv,,,,\n"
    )
    campaign = load(folder, BASE.replace('title = "t"', 'title = "t"\ntests = "tests.csv"'))
    assert campaign.tests["T"].kind == "fatigue"
    assert campaign.tests["T"].target_strain == (0.75, 1.25)
    assert campaign.tests["T"].attributes["note"] == "slow"
    assert campaign.tests["U"].kind == "cyclic" and campaign.tests["U"].order is None


def test_the_table_may_stand_in_place_of_the_sections(folder):
    (folder / "tests.csv").write_text("id,file\nT,T.csv\n")
    assert set(load(folder, 'tests = "tests.csv"\n' + BASE).tests) == {"T"}


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("file,order\nT.csv,1\n", r"tests.csv:1: .*no usable header; found file, order"),
        ("id,file\nT,T.csv\nT,T.csv\n", r"tests.csv:3 \[id\]: a test appears twice; found 'T'"),
        ("id,file,order\nT,T.csv,first\n", r"tests.csv:2 \[order\]: .*found 'first'"),
        ("id,file,order\nT,T.csv,--5\n", r"tests.csv:2 \[order\]: .*found '--5'"),
        ("id,file,order\nT,T.csv,²\n", r"tests.csv:2 \[order\]: .*found '²'"),
        ("id,file\nT\n", r"tests.csv:2: .*the number of cells in a row differs.*found 1; needed 2"),
        (
            "id,file,colour\nT,T.csv,red\n",
            r"tests.csv:1 \[colour\]: a column is not a key of a test; needed one of id, .*, method, "
            r"marks$",
        ),
        (
            "id,file,steps\nT,T.csv,red\n",
            r"tests.csv:1 \[steps\]: .*reduction and steps stand in campaign.toml, as \[tests.ID\]",
        ),
        ("id,order\nT,1\n", r"1 test has no file, .*row of tests.csv\n  tests.T.file: is required"),
        ("id,file\nT,\n", r"1 test has no file, .*row of tests.csv\n  tests.T.file: is required"),
        ("id,file\n../T,T.csv\n", r"tests.csv:2 \[id\]"),
    ],
)
def test_a_row_of_tests_that_cannot_be_used_is_named(folder, rows, message):
    (folder / "tests.csv").write_text(rows)
    with pytest.raises(SettingsError, match=message):
        load(folder, 'tests = "tests.csv"\n' + BASE)


BESIDE = BASE.replace('title = "t"', 'title = "t"\ntests = "tests.csv"')
STEP = '[[tests.T.steps]]\nname = "pull"\nfrom = "2 s"\nto = "9 s"\n'


def test_steps_and_numbers_of_a_test_in_the_table_stand_in_campaign_toml(folder):
    (folder / "tests.csv").write_text("id,file,order\nT,T.csv,2\nU,T.csv,3\n")
    numbers = '[tests.T.reduction.modulus]\nwindow = "12 %"\n'
    tests = load(folder, BESIDE + numbers + STEP).tests
    assert list(tests) == ["T", "U"]
    assert tests["T"].order == 2 and tests["T"].files == (("T.csv", "l"),)
    assert tests["T"].steps[0].time_range == (2.0, 9.0)
    assert tests["T"].settings.modulus.window == pytest.approx(0.12)
    assert not tests["U"].steps


def test_pieces_of_a_test_in_the_table_stand_in_campaign_toml(folder):
    (folder / "U.csv").write_text((folder / "T.csv").read_text())
    pieces = '[tests.T]\nfile = [{ file = "T.csv" }, { file = "U.csv" }]\n'
    for table in ("id,file,order\nT,,2\n", "id,order\nT,2\n"):
        (folder / "tests.csv").write_text(table)
        (test,) = load(folder, BESIDE + pieces).tests.values()
        assert test.order == 2 and [name for name, _ in test.files] == ["T.csv", "U.csv"]


def test_a_setting_in_both_places_is_refused(folder):
    (folder / "tests.csv").write_text("id,file,order\nT,T.csv,1\n")
    message = r"2 settings stand both in tests.csv and in \[tests\], first tests.T.file\n"
    with pytest.raises(SettingsError, match=message):
        load(folder, BESIDE + TEST + "order = 1\n")


def test_a_test_without_a_file_is_refused(folder):
    with pytest.raises(SettingsError, match=r"1 test has no file\n  tests.T.file: is required$"):
        load(folder, BASE + STEP)
    (folder / "tests.csv").write_text("id,file\nU,T.csv\n")
    with pytest.raises(SettingsError, match="1 test has no file, here or as a row of tests.csv"):
        load(folder, BESIDE + STEP)


def test_two_kinds_of_tests_at_one_place_are_told_where_the_table_goes(folder):
    with pytest.raises(SettingsError, match=r"not TOML; .*tests = \"...\" in \[campaign\]\.$"):
        load(folder, 'tests = "tests.csv"\n' + BASE + TEST)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'diameter = ["1 inch", "1.2 inch"]', 'diameter = ["1 inch", "20 N"]',
            r"specimens.a.diameter.2: unit 'N' is not a unit of length; found 'N'",
        ),
        (
            'diameter = ["1 inch", "1.2 inch"]', 'rated_break_strength = "3 m"',
            "specimens.a.rated_break_strength: unit 'm' is not a unit of force",
        ),
        (
            'from = "2 s"', 'from = "2"',
            r"campaign.toml: tests.T.steps 'pull': from: a value has no unit; found '2'; needed",
        ),
        (
            'unit = "lbf"', 'unit = "ft"',
            r"\n  layouts.l: channel tension.1: unit 'ft' is not a unit of force; found 'ft'",
        ),
        (
            'file = "T.csv"', 'file = ["T.csv", "U.csv"]',
            r"\n  tests.T.file: the files of a record are not given as tables; found \['T.csv', 'U.csv'\]; "
            r"needed a file name, or a list such as \[\{ file = \"a.csv\" \}",
        ),
    ],
)  # fmt: skip
def test_a_value_that_cannot_be_used_is_told_with_file_and_key(folder, old, new, message):
    text = BASE + TEST + STEP
    assert old in text
    with pytest.raises(SettingsError, match=message):
        load(folder, text.replace(old, new))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("campaign = [", "the campaign is not TOML"),
        ("[campaign]\nnote = 1\n", r"\n  campaign.id: is required\n  campaign.title: is required"),
        (BASE + TEST + "colour = 'red'\n", r"\n  tests.T.colour: is not a known key; found 'red'$"),
        (BASE + TEST + "contol = 'load'\n", r"; found 'load'\. Did you mean 'control'\?$"),
        (
            BASE + TEST + "load_cell_at = 'fixed'\n",
            r"; found 'fixed'\. It belongs in \[layouts\.NAME\]$",
        ),
        (BASE, r"the campaign has no tests; needed at least one \[tests.NAME\], or results"),
        (
            BASE + '[tests."a/b"]\nfile = "T.csv"\n',
            r"tests.a/b: Input should be a name of unaccented letters,",
        ),
        (BASE + TEST + "layout = 'm'\n", "test 'T' has no layout; found 'm'; needed one of"),
        (BASE + TEST + "specimens = ['b']\n", "names no known specimen; found b"),
        (BASE + TEST + "specimens = ['a', 'a']\n", "names a specimen twice; found a, a"),
        (BASE + '[tests.T]\nfile = "../T.csv"\n', "lies outside the campaign folder"),
        (BASE + '[tests.T]\nfile = "/etc/passwd"\n', "lies outside the campaign folder"),
        (
            BASE + '[tests.T]\nfile = "a\\u0000.csv"\n',
            r"no file can have such a name; found 'a\\x00",
        ),
        (BASE + TEST + "part_of = 'U'\n", "is part of a test that the campaign lacks"),
        (BASE.replace("1 inch", "1 lbf") + TEST, "'lbf' is not a unit of length"),
        (BASE.replace("1 inch", "-1 inch") + TEST, r"specimens.a.diameter.1: is not positive"),
        (BASE.replace('unit = "lbf"', 'unit = "ft"') + TEST, "is not a unit of force"),
        (BASE.replace(', datum = "pin-to-pin"', "") + TEST, "the position channel has no datum"),
        (BASE + TEST + "[tests.T.reduction.cycle]\n", "reduction.cycle is not a group"),
        (BASE + TEST + "[tests.T.reduction.cycles]\nbnd = 1\n", "reduction.cycles.bnd is not a s"),
        (
            BASE + TEST + "[tests.T.reduction.strain]\nmethod = 'mixed'\n",
            r'needed the key strain = \{ method = "..." \} of the test$',
        ),
        (
            BASE + TEST + "[tests.T.reduction.cycles]\nexpected_cycles = 3\n",
            "needed the key n_cycles = ... of the test$",
        ),
        (
            BASE + TEST + "[strain]\nmethod = 'gauge-length'\n",
            r"It belongs in \[defaults\] or \[tests\.NAME\] or \[uncertainty\]$",
        ),
        (
            BASE + TEST + "[tests.T.reduction.cycles]\nband = '1 lbf'\n",
            "reduction.cycles.band: unit 'lbf' is not a unit of length",
        ),
        (BASE + TEST + "[tests.T.reduction.cycles]\nbreak_in_cycles = 1.5\n", "whole number"),
        (BASE + TEST + "[tests.T.reduction.cycles]\nbreak_in_cycles = inf\n", "whole number"),
        (BASE + TEST + "[tests.T.reduction.quality]\nrate_tolerance = inf\n", "is out of range"),
        (BASE + TEST + "[tests.T.reduction.modulus]\nstress_at_strain = [nan]\n", "is not finite"),
        (BASE.replace("1 inch", "1e400 inch") + TEST, "a value is not finite; found '1e400 inch'"),
        (
            BASE + TEST + "[tests.T.reduction.cycles]\ntrim_threshold = -1\n",
            "needed at least 0 and at most 1",
        ),
        (BASE + TEST + "[tests.T.reduction.cycles]\nband = '0 m'\n", "cycles.band is out of range"),
        (BASE + TEST + "[tests.T.reduction.modulus]\nminimum_count = 0\n", "needed at least 3"),
        (BASE + TEST + "[tests.T.reduction.modulus]\nstrain_bin_width = 1e-9\n", "out of range"),
        (BASE + TEST + "[tests.T.reduction.modulus]\nmaximum_segments = 0\n", "at least 1 and at"),
        (BASE + TEST + "[tests.T.reduction.quality]\ngap_factor = 0\n", "out of range"),
        (BASE + TEST + "[tests.T.reduction.slip]\nfalse_alarm = 0\n", "out of range"),
        (BASE + TEST + "[tests.T.reduction.slip]\nminimum_cycles = 0\n", "out of range"),
        (BASE + TEST + "[tests.T.reduction.cycles]\ntrim_threshold = 'x'\n", "is not a number"),
        (BASE + TEST + "[tests.T.reduction.modulus]\nstress_at_strain = 1\n", "is not a list"),
        (BASE + TEST + "[[tests.T.steps]]\nname='s'\nfrom='2 s'\nto='1 s'\n", "has no range"),
        (
            BASE + TEST + 2 * "[[tests.T.steps]]\nname='s'\nfrom=1\nto=2\n",
            "two steps of test 'T' have the same name",
        ),
    ],
)
def test_a_campaign_that_cannot_be_used_says_where_and_why(folder, text, message):
    with pytest.raises((SettingsError, LogError), match=message):
        load(folder, text)


def faults(folder, text):
    """First line, and the lines below it, of what is said about a campaign."""
    with pytest.raises(SettingsError) as raised:
        load(folder, text)
    assert raised.value.exit_status == 2
    first, *below = str(raised.value).splitlines()
    return first, [line.strip() for line in below]


def test_all_faults_are_told_one_a_line(folder):
    first, below = faults(
        folder,
        BASE.replace('"rubber tether"', '"rubber"')
        .replace('unit = "lbf"', 'unit = "lbf", factor = -1')
        .replace(', datum = "pin-to-pin"', "")
        + TEST
        + "n_cycles = 0\nfile_name = 'T.csv'\n"
        + f"[tests.U]\nfile = 3\ncontrol = '{'x' * 200}'\n",
    )
    assert "campaign.toml: 6 settings cannot be used, first 'specimens.a.kind' (" in first
    kinds = "'rubber tether', 'stretch hose', 'rope', 'wire', 'elastomer' or 'other'"
    assert below[0] == f"specimens.a.kind: Input should be {kinds}; found 'rubber'"
    assert below[1:4] == [
        "layouts.l.channels.tension.1.factor: Input should be greater than 0; found -1",
        "tests.T.n_cycles: Input should be greater than or equal to 1; found 0",
        "tests.T.file_name: is not a known key; found 'T.csv'",
    ]
    assert sorted(below[4:]) == [
        f"tests.U.control: Input should be 'position' or 'load'; found '{55 * 'x'}...'",
        "tests.U.file: Input should be a valid string or a list; found 3",
    ]


def test_more_than_ten_faults_are_counted(folder):
    first, below = faults(folder, BASE + TEST + "".join(f"k{n} = {n}\n" for n in range(13)))
    assert "13 settings cannot be used" in first
    assert len(below) == 11 and below[9:] == [
        "tests.T.k9: is not a known key; found 9",
        "and 3 more",
    ]


def test_a_long_value_is_cut_and_a_rule_speaks_for_itself(folder):
    _, below = faults(folder, BASE + TEST + f"medium = {list(range(1000))}\n")
    assert below[0].endswith("; found [0, 1, 2, 3, 4, 5, ...]")
    _, below = faults(folder, BASE.replace(', datum = "pin-to-pin"', "") + TEST)
    assert below[0].startswith("layouts.l: the position channel has no datum; found crosshead")


def test_all_faults_of_a_row_of_tests_are_told(folder):
    (folder / "tests.csv").write_text("id,file,control,n_cycles\nT,T.csv,red,0\n")
    words = (
        r"tests.csv:2 \[control\]: a row .* found 'red'; needed 'position' or 'load'. "
        "Also n_cycles: Input should be greater than or equal to 1; found 0.$"
    )
    with pytest.raises(SettingsError, match=words):
        load(folder, 'tests = "tests.csv"\n' + BASE)


def test_open_questions_are_named_wherever_they_stand(folder):
    (folder / "tests.csv").write_text("id,file,specimens,marks\nT,T.csv,?;?,m.csv\nU,T.csv,a,\n")
    (folder / "m.csv").write_text(MARKS.replace("12", " ? ") + "?,a,max,2,10,12\n")
    text = BASE.replace('title = "t"', 'title = "?"\nsource = "why?"')
    text = text.replace("[specimens.a]", '[specimens."?"]').replace('"1 inch", "1.2 inch"', '"?"')
    text = text.replace('unit = "s"', 'unit = "?"').replace(
        "[layouts.l.ch", 'missing = ["?"]\n[layouts.l.ch'
    )
    first, below = faults(folder, 'tests = "tests.csv"\n' + text)
    assert first.endswith("campaign.toml: 7 values are still '?'")
    assert below == [
        "campaign.title",
        "specimens.?",
        "specimens.?.diameter",
        "layouts.l.channels.time.unit",
        "tests.csv:2 [specimens]",
        "m.csv:2 [far_thimble_ft]",
        "m.csv:3 [test]",
    ]


def test_one_open_question_is_told_before_other_faults(folder):
    text = BASE.replace('title = "t"', 'title = "?"') + "colour = 1\n" + TEST
    assert faults(folder, text) == (
        f"{folder / 'campaign.toml'}: 1 value is still '?'",
        ["campaign.title"],
    )


def test_more_than_ten_open_questions_are_counted(folder):
    steps = "".join(f"[[tests.T.steps]]\nname='s{n}'\nfrom=1\nto='?'\n" for n in range(12))
    first, below = faults(folder, BASE + TEST + steps)
    assert "12 values are still '?'" in first
    assert below[9:] == ["tests.T.steps.9.to", "and 2 more"]


def test_tables_that_cannot_be_read_are_left_to_their_readers(folder):
    (folder / "tests.csv").write_bytes(b"id,file\n\xff,?\n")
    with pytest.raises(SettingsError, match="the table of tests is not UTF-8 text"):
        load(folder, 'tests = "tests.csv"\n' + BASE)
    with pytest.raises(SettingsError, match="lies outside the campaign folder"):
        load(folder, 'tests = "../tests.csv"\n' + BASE)


def test_a_missing_campaign_says_how_to_start(tmp_path):
    with pytest.raises(SettingsError, match="`reduction init FOLDER` writes a first one"):
        load_campaign(tmp_path / "campaign.toml")


def test_marks_of_all_tests_are_pooled_by_specimen(folder):
    (folder / "marks.csv").write_text(MARKS + "T,a,max,2.5,20,23\n")
    campaign = load(folder, BASE + "strain = { marks = 'marks.csv' }\n" + TEST)
    marks = campaign.marks["a"]
    assert marks.hold == ("slack", "max")
    assert marks.free_length == pytest.approx([8 * 0.3048, 17.5 * 0.3048])
    assert marks.splice_length == pytest.approx([4 * 0.3048, 5.5 * 0.3048])
    stated = "[uncertainty]\nsplice_creep = '8 %'\n" + BASE + "strain = { marks = 'marks.csv' }\n"
    assert load(folder, stated + TEST).marks["a"].splice_creep == 0.08


@pytest.mark.parametrize(
    ("suffix", "metre"), [("ft", 0.3048), ("in", 0.0254), ("m", 1), ("mm", 1e-3), ("cm", 1e-2)]
)
def test_the_suffix_of_a_marks_column_is_its_unit(tmp_path, suffix, metre):
    path = tmp_path / "marks.csv"
    path.write_text(MARKS.replace("_ft", f"_{suffix}"))
    assert _read_marks(path)["a"].near_toe == pytest.approx([2 * metre])


def test_sixteenths_of_an_inch_in_decimal_feet_are_not_read_to_their_last_digit(tmp_path):
    path = tmp_path / "marks.csv"
    path.write_text(MARKS.replace("2,10,12", "2.0417,10.4375,12.1042"))
    assert _read_marks(path)["a"].reading_uncertainty == 0.0005


def test_marks_with_the_digits_of_a_spreadsheet_are_read(tmp_path):
    path = tmp_path / "marks.csv"
    path.write_text(MARKS.replace("2,10,12", "2.0416666666666665,1.0437499999999998e1,12.10"))
    marks = _read_marks(path)["a"]
    assert marks.near_toe == pytest.approx([24.5 * 0.0254])
    assert marks.free_length == pytest.approx([(10.4375 - 24.5 / 12) * 0.3048])
    assert marks.reading_uncertainty == 0.0005


def test_a_mark_on_the_way_down_is_known_by_its_hold(tmp_path):
    path = tmp_path / "marks.csv"
    path.write_text(MARKS.replace("slack", "75 % down"))
    assert _read_marks(path)["a"].is_unloading.tolist() == [True]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("test,specimen,hold,near_toe_ft\n", "lacks a column.*missing: far_toe, far_thimble"),
        (
            MARKS.replace("10", "ten"),
            r"marks.csv:2 \[far_toe_ft\]: a mark is not a number; found 'ten'",
        ),
        (MARKS.replace("slack", "somewhere"), r"marks.csv:2 \[hold\]: unknown name of a hold"),
        (MARKS.replace(",12", ""), r"marks.csv:2: .*found 5; needed 6"),
        (MARKS.splitlines()[0] + "\n", "the marks file has no rows"),
        (MARKS.replace("near_toe_ft", "near_toe_yd"), "missing: near_toe"),
    ],
)
def test_marks_that_cannot_be_used_are_named(tmp_path, text, message):
    path = tmp_path / "marks.csv"
    path.write_text(text)
    with pytest.raises(LogError, match=message):
        _read_marks(path)


def test_a_mark_row_out_of_order_is_refused(tmp_path):
    path = tmp_path / "marks.csv"
    path.write_text(MARKS.replace("2,10,12", "10,2,12"))
    with pytest.raises(DataError, match="contradict themselves, first test T, hold slack"):
        _read_marks(path)


def test_marks_of_an_unknown_specimen_or_test_are_refused(folder):
    text = BASE + "strain = { marks = 'marks.csv' }\n" + TEST
    (folder / "marks.csv").write_text(MARKS.replace(",a,", ",b,"))
    with pytest.raises(LogError, match="a mark names an unknown specimen; found 'b'"):
        load(folder, text)
    (folder / "marks.csv").write_text(MARKS.replace("T,a", "U,a"))
    with pytest.raises(SettingsError, match="name a test that the campaign lacks; found U"):
        load(folder, text)


@pytest.mark.parametrize("name", ["tmt-synthetic", "buoy-technology-1997"])
def test_the_campaigns_of_the_project_load(name):
    campaign = load_campaign(ROOT / "raw" / name / "campaign.toml")
    assert campaign.id == name
    assert len(campaign.tests) == {"tmt-synthetic": 10, "buoy-technology-1997": 1}[name]
    assert (campaign.attributes.get("synthetic") == "yes") == (name == "tmt-synthetic")


def test_a_file_on_the_net_is_refused_in_words(folder):
    words = (
        "the log of test 'T' is a URL, and URLs are refused without --allow-remote; found "
        "'https://example.org/T.csv'; needed --allow-remote"
    )
    with pytest.raises(SettingsError, match=words):
        load(folder, BASE + TEST.replace("T.csv", "https://example.org/T.csv"))


# areas of specimens that have no diameter, from campaign.toml to a modulus and its uncertainty

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
CAMPAIGN = """
[campaign]
id = "one"
title = "one"
[specimens.new]
kind = "rubber tether"
SIZE
[layouts.logger]
format = "delimited"
comment = "#"
[layouts.logger.channels]
time = { column = "time_s", unit = "s" }
crosshead_position = { column = "crosshead_ft", unit = "ft", datum = "pin-to-pin" }
tension.1 = { column = "load_new_lb", unit = "lbf" }
[defaults]
layout = "logger"
specimens = ["new"]
strain = { method = "gauge-length" }
[tests.T-1]
file = "T-1.csv"
"""


@pytest.fixture
def stated(tmp_path):
    shutil.copy(RAW / "T-1.csv", tmp_path)

    def write(size, more=""):
        text = CAMPAIGN.replace("SIZE", f'gauge_length = "12.256 ft"\n{size}') + more
        (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
        return tmp_path / "campaign.toml"

    return write


@pytest.mark.parametrize(
    ("size", "area"),
    [
        ('area = "5.5 cm2"', 5.5e-4),
        ('area = ["2.2 mm2", "2.4 mm2"]', 2.3e-6),
        ('width = "11.4 mm"\nthickness = "0.2 mm"', 2.28e-6),
        ('width = ["6 mm", "6.2 mm"]\nthickness = ["3 mm", "3.1 mm"]', (18 + 19.22) / 2 * 1e-6),
        ('linear_density = "0.11 kg/m"\ndensity = "1100 kg/m3"', 1e-4),
        ('diameter = "2 mm"\nlinear_density = "0.11 kg/m"', np.pi * 1e-6),
    ],
)
def test_the_area_is_that_of_what_is_stated(stated, size, area):
    specimen = load_campaign(stated(size)).specimens["new"]
    assert specimen.has_area
    assert specimen.area == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize(
    ("size", "match"),
    [
        ('area = "1 mm2"\ndiameter = "1 mm"', "states its cross-section in two ways"),
        ('width = "1 mm"', "width is stated alone"),
        ('density = "900 kg/m3"', "density is stated alone"),
        (
            'width = ["1 mm", "2 mm"]\nthickness = ["1 mm", "2 mm", "3 mm"]',
            "not of the same places",
        ),
        ('area = "1 mm"', "unit 'mm' is not a unit of area"),
        (
            'area = "1 mm2"\nstretched_diameter = { "10 %" = ["1 mm"] }',
            "stretched_diameter is stated alone",
        ),
    ],
)
def test_a_size_that_is_stated_twice_or_by_half_is_refused(stated, size, match):
    with pytest.raises(SettingsError, match=match):
        load_campaign(stated(size))


def test_an_area_gives_the_moduli_of_the_circle_of_that_area(stated, tmp_path):
    inch = 0.0254
    area = np.pi * (1.04 * inch) ** 2 / 4
    made = {}
    for name, size, error in (
        ("circle", 'diameter = "1.04 in"', 'diameter = "0.0104 in"'),
        ("area", f'area = "{area:.12e} m2"', 'area = "2 %"'),
    ):
        path = stated(size, f"[uncertainty]\n{error}\n")
        reduction.run(path, processed=tmp_path / name, reports=tmp_path / "r").close()
        with xr.open_datatree(tmp_path / name / "one" / "T-1.nc") as tree:
            made[name] = tree.load()
    for name in ("tangent_modulus", "tangent_modulus_standard_uncertainty", "area",
                 "area_standard_uncertainty"):  # fmt: skip
        np.testing.assert_allclose(made["area"][name], made["circle"][name], rtol=1e-9)
    assert np.isnan(made["area"]["diameter"]).all()
    assert re.search("area", made["area"].attrs["settings"])


# what every small table beside campaign.toml has in common: how it is opened


def in_settings(path, problem, *, row=None, **kwargs):
    return SettingsError(f"{path}:{row}: {problem}", **kwargs)


def test_rows_keep_their_line_and_empty_ones_are_left_out(tmp_path):
    path = tmp_path / "t.csv"
    path.write_bytes(b"\xef\xbb\xbf a , b\r\n1,2\r\n,\r\n3,\r\n")
    header, rows = read_csv_rows(path, "the table")
    assert header == ["a", "b"]
    assert list(rows) == [(2, ["1", "2"]), (4, ["3", ""])]


def test_a_file_without_a_line_has_no_header(tmp_path):
    (tmp_path / "t.csv").write_text("")
    header, rows = read_csv_rows(tmp_path / "t.csv", "the table")
    assert header == []
    assert list(rows) == []


def test_a_header_can_be_refused_before_a_row_is(tmp_path):
    (tmp_path / "t.csv").write_text("a,b\n1\n")
    header, rows = read_csv_rows(tmp_path / "t.csv", "the table", fault=in_settings)
    assert header == ["a", "b"]
    with pytest.raises(
        SettingsError, match=r"t.csv:2: the number of cells in a row .*found 1; needed 2"
    ):
        next(rows)


@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_table_of_another_separator_is_told(tmp_path, mark):
    (tmp_path / "t.csv").write_text(f"test{mark}hold\nT{mark}min\n")
    with pytest.raises(LogError, match=r"t.csv:1: the columns of the table are not separated by"):
        read_csv_rows(tmp_path / "t.csv", "the table")


def test_a_file_that_is_no_text_or_is_not_there_is_told(tmp_path):
    (tmp_path / "t.csv").write_bytes(b"a\xff,b\n")
    with pytest.raises(LogError, match="the table is not UTF-8 text; found the byte 0xff in row 1"):
        read_csv_rows(tmp_path / "t.csv", "the table")
    with pytest.raises(LogError, match="the table cannot be read; found No such file"):
        read_csv_rows(tmp_path / "none.csv", "the table")

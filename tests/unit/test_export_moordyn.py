"""None"""

import math
import re
from dataclasses import replace

import pytest
import yaml
from export_lines import constant, growing, line, syrope
from export_readers import moordyn_sections, moordyn_table, moorpy_table

from reduction.lines.deck_moordyn import moordyn_files, moorpy_files, openfast_files
from reduction.record.errors import SettingsError


def row_of(files):
    (row,) = moordyn_sections(files[""])["LINE TYPES"]
    return row


def test_a_table_is_named_in_the_row_and_has_numerical_damping():
    files = moordyn_files(line(viscoelasticity=constant()), "x")
    assert list(files) == ["", "x_table.txt"]
    assert row_of(files) == [
        "new_tether", "0.026", "0.6", "x_table.txt", "-1", "0", "1.2", "1", "0", "0",
    ]  # fmt: skip
    strain, _ = moordyn_table(files["x_table.txt"])
    assert strain.size == 30
    assert "internal damping -1: MoorDyn reads a negative number as" in files[""]


def test_static_and_dynamic_stiffness_have_the_dashpot_of_the_series_form():
    files = moordyn_files(line(viscoelasticity=constant()), "x", form="static-dynamic")
    row = row_of(files)
    assert row[3] == "20000|50000"
    slow, fast = map(float, row[4].split("|"))
    assert slow == pytest.approx(9e4 * (5 / 3) ** 2)
    # a tenth of critical for segments of 2 m
    assert fast == pytest.approx(0.1 * 2 * math.sqrt(5e4 * 0.6))
    assert "K_1 tau = 90000 N s" in " ".join(files[""].split())


def test_a_stiffness_that_grows_is_written_as_three_numbers():
    files = moordyn_files(line(viscoelasticity=growing()), "x", form="load-dependent")
    assert row_of(files)[3] == "20000|30000|10"
    assert "found at mean tension 2 kN" in files[""]


def test_the_energy_of_a_running_stiffness_is_that_of_the_tension_that_was_asked_for():
    """H = pi T_a^2 Im(-1/K): at equal stretch it would be another share."""
    part = replace(growing(), frequency=0.005)
    text = " ".join(
        moordyn_files(line(viscoelasticity=part), "x", form="load-dependent")[""].split()
    )
    running, held = part.running_stiffness_at(0.005), part.stiffness_at(0.005)
    share = 100 * ((1 / running).imag / (1 / held).imag - 1)
    assert f"{share:+.1f} percent in hysteresis energy at equal tension amplitude" in text
    assert abs(share - 100 * (running.imag / held.imag - 1)) > 1


def test_a_syrope_has_its_three_files_and_its_initial_conditions():
    files = moordyn_files(line(syrope=syrope()), "x", form="syrope")
    assert files["x_syrope.dat"] == "x_owc.dat OWC\nLINEAR WCType\n0.2 k1\n0 k2"
    strain, tension = moordyn_table(files["x_owc.dat"])
    # 1.9 MN over the last 0.02 of strain, straight on for 30 % of 0.08
    assert tension[-2:] == pytest.approx([6.5e6, 6.5e6 + 0.024 * 1.9e6 / 0.02])
    assert strain[-2:] == pytest.approx([0.08, 0.104])
    assert row_of(files)[3:5] == ["SYROPE:x_syrope.dat|150000000|25", "100000000|1000000"]
    sections = moordyn_sections(files[""])
    assert sections["SYROPE IC"] == [["1", "3000000", "1000000"]]
    assert list(sections).index("SYROPE IC") == list(sections).index("LINES") + 1
    # damping of the fast spring would ask for tiny steps: no node is free
    assert sections["LINES"][0][5] == "1"


@pytest.mark.parametrize(
    ("fields", "form", "message"),
    [
        ({}, "static-dynamic", "static and dynamic stiffness of new tether are not known"),
        ({"viscoelasticity": constant()}, "load-dependent", "no growth of the dynamic stiffness"),
        ({}, "syrope", "has no Syrope working curves"),
        ({"linear_density": math.nan}, "table", "linear density of new tether is not known"),
        ({"diameter": math.nan}, "table", "diameter of new tether is not known"),
    ],
)
def test_what_the_line_has_not_is_refused(fields, form, message):
    with pytest.raises(SettingsError, match=message):
        moordyn_files(line(**fields), "x", form=form)


def test_the_line_of_a_deck_is_as_long_as_the_line_that_is_exported():
    """36 m of line in segments of 7.2 m; half its stretch of 1.5 puts the end 63 m up."""
    text = moordyn_files(line(unstretched_length=36.0), "x")[""]
    rows = text.splitlines()
    below, above = (float(next(row for row in rows if row.startswith(start)).split()[4])
                    for start in ("1 Fixed", "2 Coupled"))  # fmt: skip
    assert "1 new_tether 1 2 36 5 -" in rows
    assert 36 < above - below < 36 * 2.5 and above < 0
    assert -2 * below == float(next(row for row in rows if row.endswith("WtrDpth")).split()[0])
    # a stable step grows with the segment
    step, of_ten = (
        float(next(row for row in one.splitlines() if row.endswith("dtM")).split()[0])
        for one in (text, moordyn_files(line(), "x")[""])
    )
    assert step == pytest.approx(3.6 * of_ten, rel=0.01)


def test_the_name_of_the_table_stands_in_bars_and_the_table_ends_at_a_rule():
    files = moorpy_files(line(), "x")
    (row,) = moordyn_sections(files[""])["LINE TYPES"]
    assert row[3] == "|x_moorpy.txt|"
    assert files["x_moorpy.txt"].endswith("\n---")
    assert moorpy_table(files["x_moorpy.txt"]).shape == (2, 30)
    assert "working folder" in files[""]


def test_the_library_is_over_break_strength_and_diameter():
    one = line(viscoelasticity=growing(), rated_break_strength=5e4)
    props = yaml.safe_load(moorpy_files(one, "x", form="library")[""])["lineProps"]["new_tether"]
    assert all(isinstance(value, float) for value in props.values())
    assert props["MBL_d2"] * 0.026**2 == pytest.approx(5e4)
    assert props["EA_MBL"] == 0.4
    assert props["EAd_MBL"] == 0.6
    assert props["EAD_LM"] == props["EAd_MBL_Lm"] == 10
    assert not {"d_min", "d_max"} & set(props)


@pytest.mark.parametrize(
    ("fields", "form", "message"),
    [
        ({}, "library", "the library is linear"),
        ({"viscoelasticity": growing()}, "library", "rated break strength"),
        ({"linear_density": math.nan}, "table", "linear density"),
    ],
)
def test_what_the_line_has_not_is_refused_in_moorpy(fields, form, message):
    with pytest.raises(SettingsError, match=message):
        moorpy_files(line(**fields), "x", form=form)


def test_without_a_dashpot_the_dynamic_stiffness_is_that_of_the_cycle():
    """K_0 20 kN, K_1 30 kN, tau 18 s and 0.01 Hz: K_ap of eq. 1, not the 50 kN of a fast pull."""
    part = replace(growing(), frequency=0.01)
    one = line(viscoelasticity=part, rated_break_strength=5e4)
    turned = 2j * math.pi * 0.01 * 9e5 / 3e4
    expected = abs(2e4 + 3e4 * turned / (1 + turned))
    text = moorpy_files(one, "x", form="library")[""]
    props = yaml.safe_load(text)["lineProps"]["new_tether"]
    assert props["EAd_MBL"] * 5e4 + props["EAD_LM"] * 2000 == pytest.approx(expected)
    assert "K_ap at that frequency" in text


def test_a_name_that_yaml_takes_for_a_number_stays_text():
    one = line(name="1", viscoelasticity=growing(), rated_break_strength=5e4)
    assert list(yaml.safe_load(moorpy_files(one, "x", form="library")[""])["lineProps"]) == ["1"]


def test_options_of_the_other_code_are_left_out():
    files, other = openfast_files(line(), "x"), moordyn_files(line(), "x")
    assert files["x_table.txt"] == other["x_table.txt"]
    sections, others = moordyn_sections(files[""]), moordyn_sections(other[""])
    assert {row[1] for row in sections["OPTIONS"]} == {"dtM", "WtrDpth"}
    # gravity of OpenFAST stays: 0 g would take the weight of every line of the module
    assert "NO GRAVITY" in other[""]
    assert {row[1]: row[0] for row in others["OPTIONS"]}["g"] == "0"
    assert "NO GRAVITY" not in files[""]
    said = " ".join(files[""].split())
    assert "gravity is that of OpenFAST" in said
    assert "looks for the table in the folder where it is started" in said


def test_damping_of_a_table_is_a_number_above_zero():
    """MoorDyn-F ends where a share of critical damping, a number below zero, stands beside one."""
    (row,) = moordyn_sections(openfast_files(line(), "x")[""])["LINE TYPES"]
    assert float(row[4]) > 0
    (other,) = moordyn_sections(moordyn_files(line(), "x")[""])["LINE TYPES"]
    assert [*row[:4], *row[5:]] == [*other[:4], *other[5:]]


@pytest.mark.parametrize("form", ["table", "static-dynamic"])
def test_names_are_no_longer_than_what_is_read(form):
    names = set()
    for name in ("polyester-double-braid-0.5in-new", "polyester-double-braid-0.5in-exposed"):
        one = line(name=name, viscoelasticity=constant())
        files = openfast_files(one, "a" * 60, form=form)
        sections = moordyn_sections(files[""])
        ((found, *_),), ((_, used, *_),) = sections["LINE TYPES"], sections["LINES"]
        assert found == used
        assert len(found) <= 20
        names.add(found)
        assert all(len(beside) <= 40 and beside in files[""] for beside in files if beside)
        assert re.search(rf"\b{name}\b", files[""]), "the header has the whole name"
    assert len(names) == 2

import math
from dataclasses import replace

import pytest
from export_lines import constant, growing, line, syrope
from export_readers import moordyn_sections, moordyn_table

from reduction.lines.deck_moordyn import moordyn_files
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

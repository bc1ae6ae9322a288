import re

import pytest
from export_lines import constant, line
from export_readers import moordyn_sections

from reduction.lines.deck_moordyn import moordyn_files, openfast_files


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

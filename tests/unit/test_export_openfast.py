from export_lines import line, syrope
from export_readers import moordyn_sections

from reduction.lines.deck_moordyn import moordyn_files, openfast_files


def test_the_row_is_that_of_moordyn_and_options_of_the_other_code_are_left_out():
    files, other = openfast_files(line(), "x"), moordyn_files(line(), "x")
    assert files["x_table.txt"] == other["x_table.txt"]
    sections, others = moordyn_sections(files[""]), moordyn_sections(other[""])
    assert sections["LINE TYPES"] == others["LINE TYPES"]
    assert {row[1] for row in sections["OPTIONS"]} == {"dtM", "WtrDpth"}
    # gravity of OpenFAST stays: 0 g would take the weight of every line of the module
    assert "NO GRAVITY" in other[""]
    assert {row[1]: row[0] for row in others["OPTIONS"]}["g"] == "0"
    assert "NO GRAVITY" not in files[""]
    assert "gravity is that of OpenFAST" in files[""]
    assert "sought beside the executable: put them there, or write the path" in " ".join(
        files[""].split()
    )


def test_syrope_says_which_version_it_needs():
    assert "June 2026" in openfast_files(line(syrope=syrope()), "x", form="syrope")[""]

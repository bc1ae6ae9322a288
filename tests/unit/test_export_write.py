from typing import get_args

import pytest
from export_lines import constant, line

from reduction.lines.deck_formats import FORMATS, FORMS, WhoiCableForm, export_line
from reduction.lines.deck_moordyn import MoorDynForm, MoorPyForm, OpenFastForm
from reduction.lines.export_line import cycle_damping
from reduction.record.errors import SettingsError


@pytest.mark.parametrize("to", FORMATS)
def test_the_file_that_was_asked_for_is_there_and_is_the_last(to, tmp_path):
    path = tmp_path / "my line.dat"
    # a code with one stiffness takes that of a cycle
    written = export_line(line(damping=cycle_damping(10.0, 0.1, 0.5)), to, path)
    assert written[-1] == path
    assert set(tmp_path.iterdir()) == set(written)
    assert all(" " not in one.name for one in written[:-1])


def test_files_of_two_codes_may_stand_in_one_folder(tmp_path):
    """MoorDyn does not survive the end of the table that MoorPy needs."""
    first = export_line(line(), "moordyn", tmp_path / "a.dat")
    second = export_line(line(), "moorpy", tmp_path / "a.txt")
    assert not set(first) & set(second)


def test_forms_are_handed_on(tmp_path):
    one = line(viscoelasticity=constant())
    export_line(one, "moordyn", tmp_path / "a.dat", form="static-dynamic")
    assert "20000|50000" in (tmp_path / "a.dat").read_text()
    export_line(one, "whoi-cable", tmp_path / "a.cbl", form="table")
    assert "T = (0.0, 0.0) (" in (tmp_path / "a.cbl").read_text()


def test_a_format_is_told_the_forms_that_its_writer_knows():
    known = {
        "moordyn": MoorDynForm, "openfast": OpenFastForm, "moorpy": MoorPyForm,
        "whoi-cable": WhoiCableForm,
    }  # fmt: skip
    assert FORMS == {to: get_args(known[to]) if to in known else () for to in FORMS}


def test_unknown_formats_and_forms_are_refused(tmp_path):
    with pytest.raises(SettingsError, match="format is not known"):
        export_line(line(), "ansys", tmp_path / "a")
    with pytest.raises(SettingsError, match="orcaflex has no form 'table'"):
        export_line(line(), "orcaflex", tmp_path / "a", form="table")
    with pytest.raises(SettingsError, match=r"needed one of table, library"):
        export_line(line(), "moorpy", tmp_path / "a", form="syrope")
    assert set(FORMS) < set(FORMATS)
    assert list(tmp_path.iterdir()) == []


def test_every_deck_of_a_folder_has_a_table_of_its_own(tmp_path):
    """The second must not take the table of the first, whatever both are called."""
    names = ["leg 1.dat", "leg-1.txt", "leg_1.dat", "leg.dat", "leg.txt", "leg_table.dat", "leg"]
    tables = [export_line(line(), "moordyn", tmp_path / name)[0] for name in names]
    assert len(set(tables)) == len(names)
    assert not set(tables) & {tmp_path / name for name in names}
    for name, table in zip(names, tables, strict=True):
        assert f" {table.name} " in (tmp_path / name).read_text()
    assert export_line(line(), "moordyn", tmp_path / "leg 1.dat")[0] == tables[0]

import math
from typing import get_args

import numpy as np
import pytest
import yaml
from export_lines import constant, line

from reduction.lines.deck_formats import FORMATS, FORMS, WhoiCableForm, export_line
from reduction.lines.deck_moordyn import MoorDynForm, MoorPyForm, OpenFastForm
from reduction.lines.export_line import ExportLine, beside_dashpot, cycle_damping, loop_stiffness
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


K, LOSS = 100.0, 0.3  # a spring [N], and the loss factor of the dashpot beside it
REACH = K * math.hypot(1, LOSS) / 2  # half the range of tension in a sine of strain 1 +- 0.5


def viscous_test(**changed):
    """The mean curve of spring and dashpot, cut off at 0.8 of the amplitude, and its turns."""
    strain = np.array([0.5, 0.6, 1.4, 1.5])
    tension = np.array([100 - REACH, 60.0, 140.0, 100 + REACH])
    damping = cycle_damping(
        math.pi * LOSS * K * 0.25, 0.2, 0.5, apparent_stiffness=K * math.hypot(1, LOSS)
    )
    fields = {
        "turns": (0.5, 1.5), "tested": (0.6, 1.4), "linear_density": 0.6, "diameter": 0.03,
        "damping": damping,
    }  # fmt: skip
    return ExportLine("a", strain, tension, "mean", sources=("none",), **fields | changed)


def test_what_the_dashpot_pulls_is_not_in_its_table_as_well():
    one = viscous_test()
    made = beside_dashpot(one)
    assert made.tension == pytest.approx([50.0, 60.0, 140.0, 150.0], rel=1e-4)
    assert loop_stiffness(made, one.damping) == pytest.approx(K * math.hypot(1, LOSS), rel=1e-5)
    assert "K_ap of that cycle is 104.4" in made.notes[-1]


def test_a_curve_without_a_straight_end_or_a_dashpot_stays_as_it_is():
    for one in (viscous_test(damping=None), viscous_test(tested=(0.5, 1.5))):
        assert beside_dashpot(one) is one


def test_a_code_with_one_stiffness_takes_k_ap_of_the_test(tmp_path):
    export_line(viscous_test(), "raft", tmp_path / "a.yml")
    mooring = yaml.safe_load((tmp_path / "a.yml").read_text())["mooring"]
    (kind,), (whole,) = mooring["line_types"], mooring["lines"]
    # the anchor lies under the fairlead by the length of the line at the middle of the cycle
    length = -mooring["points"][0]["location"][2] / 2
    assert kind["stiffness"] * length / whole["length"] == pytest.approx(
        K * math.hypot(1, LOSS), rel=1e-6
    )

import math
from dataclasses import replace

import pytest
import yaml
from export_lines import growing, line
from export_readers import moordyn_sections, moorpy_table

from reduction.lines.deck_moordyn import moorpy_files
from reduction.record.errors import SettingsError


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
def test_what_the_line_has_not_is_refused(fields, form, message):
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

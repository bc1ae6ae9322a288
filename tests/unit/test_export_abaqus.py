import math

import numpy as np
import pytest
from export_lines import line, rubber
from export_readers import abaqus

from reduction.lines.deck_formats import _abaqus_text
from reduction.record.errors import SettingsError


def test_nominal_stress_stands_first_and_the_origin_is_there():
    stress, strain = abaqus(_abaqus_text(line()))
    np.testing.assert_allclose(stress * math.pi / 4 * 0.026**2, rubber(strain), rtol=1e-3)
    assert strain[0] == stress[0] == 0
    assert strain[-1] == 1.5


def test_a_label_begins_with_a_letter():
    assert "*MATERIAL, NAME=M_64_hose\n" in _abaqus_text(line(name="64-hose"))


def test_a_line_without_diameter_has_no_stress():
    with pytest.raises(SettingsError, match="diameter"):
        _abaqus_text(line(diameter=math.nan))

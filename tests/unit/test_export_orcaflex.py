import math

import numpy as np
import pytest
import yaml
from export_lines import line, rubber
from export_readers import orcaflex

from reduction.lines.deck_formats import _orcaflex_text
from reduction.record.errors import SettingsError

KEYS = {
    "Name", "Category", "OD", "ID", "MassPerUnitLength", "EIx", "EIy", "EA", "GJ", "PoissonRatio",
    "Cd", "Ca", "NormalDragLiftDiameter", "AxialDragLiftDiameter",
}  # fmt: skip


def test_the_line_type_is_in_kilonewton_and_tonnes():
    text = _orcaflex_text(line())
    found, strain, tension = orcaflex(text)
    assert set(found) == KEYS
    assert found["MassPerUnitLength"] == 0.0006
    assert found["Cd"] == [1.2, None, 0.0]
    np.testing.assert_allclose(tension, rubber(strain), atol=1e-6 * rubber(1.5))
    assert strain.size == 100
    assert "syntax checked only" in text


def test_every_number_is_a_number_of_yaml():
    found, *_ = orcaflex(_orcaflex_text(line(diameter=1e-7, linear_density=1e12)))
    assert isinstance(found["OD"], float)
    assert isinstance(found["MassPerUnitLength"], float)


def test_a_line_without_mass_is_refused():
    with pytest.raises(SettingsError, match="linear density"):
        _orcaflex_text(line(linear_density=math.nan))


@pytest.mark.parametrize("name", ["12.5", "1", "no", "null", "1e3"])
def test_a_name_that_yaml_takes_for_something_else_stays_text(name):
    found = yaml.safe_load(_orcaflex_text(line(name=name)))
    (kind,) = found["LineTypes"]
    assert kind["Name"] == line(name=name).identifier
    (stiffness,) = found["VariableData"]["Axialstiffness"]
    assert kind["EA"] == stiffness["Name"]

"""Drag and added mass as they are stated, with their source."""

import pytest

from reduction.cli.export import _stated_hydrodynamics
from reduction.lines.export_line import CYLINDER
from reduction.record.errors import SettingsError


def test_both_stand_in_place_of_the_assumed_cylinder():
    found = _stated_hydrodynamics("1.6, 0.02", "0.9,0.1", "towed in 2019")["hydrodynamics"]
    assert (found.normal_drag, found.axial_drag) == (1.6, 0.02)
    assert (found.normal_added_mass, found.axial_added_mass) == (0.9, 0.1)
    assert found.source == "stated at the export, towed in 2019"
    assert "assumed" not in found.source


def test_what_is_not_stated_stays_assumed_and_says_so():
    drag = _stated_hydrodynamics("1.6, 0.02", None, "towed")["hydrodynamics"]
    assert drag.normal_added_mass == CYLINDER.normal_added_mass
    assert drag.source.startswith("drag stated at the export, towed; added mass assumed, not")
    mass = _stated_hydrodynamics(None, "0.9, 0", None)["hydrodynamics"]
    assert mass.normal_drag == CYLINDER.normal_drag
    assert mass.source.startswith("drag assumed, not measured")
    assert mass.source.endswith("added mass stated at the export, without a source")
    assert _stated_hydrodynamics(None, None, None) == {}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (("1.6", None, None), "--drag is not a pair of coefficients; found '1.6'"),
        ((None, "1,0,0", None), "--added-mass is not a pair"),
        (("1.6, -0.1", None, None), "--drag is negative; found '1.6, -0.1'"),
        (("1.6, 0.1 m", None, None), "--drag: .*needed two numbers"),
        (("a, b", None, None), "--drag: "),
        ((None, None, "a book"), "without coefficients; found --hydrodynamics-source a book"),
    ],
)
def test_what_is_no_pair_of_coefficients_is_refused(given, message):
    with pytest.raises(SettingsError, match=message):
        _stated_hydrodynamics(*given)

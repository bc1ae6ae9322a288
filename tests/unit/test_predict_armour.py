"""Prediction of a wire: series of strains, signs, limits."""

import numpy as np
import pytest

from reduction.prediction.armour import ARMOUR_THEORIES, ArmourDesign, predict_armour
from reduction.record.errors import SettingsError

DESIGN = ArmourDesign(np.radians(35.0), 2.5e-3, 25e-3, 210e9)


def test_an_unknown_theory_is_refused():
    with pytest.raises(SettingsError, match="theory of the armour is not known; found 'knapp'"):
        predict_armour(DESIGN, 1e-3, theory="knapp")


@pytest.mark.parametrize("strain", [-1.0, np.nan, np.inf])
def test_strain_below_minus_one_or_not_finite_is_refused(strain):
    with pytest.raises(SettingsError, match="1 of 2 strains are none of a cable, first at index 1"):
        predict_armour(DESIGN, [0.0, strain])


@pytest.mark.parametrize("theory", ARMOUR_THEORIES)
def test_nothing_is_loaded_without_strain(theory):
    wire = predict_armour(DESIGN, 0.0, theory=theory)
    for name in ("axial_force", "shear_force", "bending_moment", "torsion_moment", "tension"):
        assert abs(getattr(wire, name)[0]) < 1e-6
    assert not wire.is_lifted[0]


def test_strains_of_the_caller_stay_writeable():
    strain = np.array([1e-3, 2e-3])
    predict_armour(DESIGN, strain)
    strain[0] = 0.0


@pytest.mark.parametrize("theory", ["small", "intermediate", "exact", "conjugate"])
def test_compression_lifts_the_wires_off(theory):
    wire = predict_armour(DESIGN, [-1e-3, 1e-3], theory=theory)
    assert wire.is_lifted.tolist() == [True, False]
    assert wire.contact_line_load[1] > 0

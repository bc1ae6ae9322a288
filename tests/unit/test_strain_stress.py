"""Unit tests of reduction.stages.strain.stress."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.record.measurement import Specimen
from reduction.stages.strain.stress import (
    check_constant_volume,
    constant_volume_diameter,
    nominal_stress,
)


def test_stress_is_tension_over_area_and_missing_where_tension_is():
    np.testing.assert_allclose(nominal_stress([10.0, np.nan], area=0.5), [20.0, np.nan])


def test_volume_is_kept():
    stretch, diameter = np.array([1.0, 1.5, 4.0]), np.array([0.03, 0.02, 0.01])
    before = constant_volume_diameter(stretch - 1, diameter)
    np.testing.assert_allclose(before**2, diameter**2 * stretch)


def stretched(scale, scatter=0.0):
    strain = np.array([0.1, 0.1, 1.0, 1.0])
    diameter = scale * 0.0264 / np.sqrt(1 + strain) * (1 + scatter * np.array([1, -1, 1, -1]))
    return tuple(zip(strain.tolist(), diameter.tolist(), strict=True))


@pytest.mark.parametrize(("scale", "scatter"), [(1.0, 0.005), (1.01, 0.01)])
def test_diameters_that_differ_by_no_more_than_their_scatter_say_nothing(scale, scatter):
    specimen = Specimen("a", diameter=(0.0264,), stretched_diameters=stretched(scale, scatter))
    assert tuple(map(str, check_constant_volume(specimen))) == ()


def test_a_difference_beyond_reading_scatter_says_what_it_does_to_moduli():
    thick = Specimen("a", diameter=(0.0264,), stretched_diameters=stretched(1.05, 0.001))
    assert "9.3 % lower" in str(check_constant_volume(thick)[0])  # 1 / 1.05**2 - 1
    thin = Specimen("a", diameter=(0.0264,), stretched_diameters=stretched(0.95, 0.001))
    assert "10.8 % higher" in str(check_constant_volume(thin)[0])  # 1 / 0.95**2 - 1


@pytest.mark.parametrize(
    ("stretched", "is_sound"), [(0.0187, True), (0.0178, True), (0.0264, False)]
)
def test_one_stretched_reading_is_held_against_a_tenth_of_the_diameter(stretched, is_sound):
    """26.4 mm at 100 % is 18.67 mm by constant volume; the last one was read stretched twice."""
    specimen = Specimen("a", diameter=(0.0264,), stretched_diameters=((1.0, stretched),))
    assert (check_constant_volume(specimen) == ()) == is_sound


def test_stretched_diameters_without_one_before_stretch_are_refused():
    with pytest.raises(DataError, match="specimen 'a' has no diameter"):
        tuple(map(str, check_constant_volume(Specimen("a", stretched_diameters=stretched(1.0)))))


REFUSED = {
    "no area no stress": (
        lambda: nominal_stress([1.0], area=0.0),
        DataError,
        "area are not positive",
    ),
    "a diameter at no length is refused": (
        lambda: constant_volume_diameter([-1.0], [0.02]),
        DataError,
        r"1 \+ strain",
    ),
    "strains and diameters pair up": (
        lambda: constant_volume_diameter([0.1, 1.0], [0.02]),
        DataError,
        "do not pair up",
    ),
}


test_refusals = refusals(REFUSED)

"""Stress of hyperelastic laws: limits, identities, and the work they come from."""

import numpy as np
import pytest

from reduction.record.errors import DataError
from reduction.stages.moduli.elastomer_laws import (
    LAWS,
    _ogden_basis,
    _ogden_columns,
    _polynomial_columns,
    hyperelastic_stress,
)

EXAMPLE = {
    "neo-hookean": {"shear_modulus": 4e5},
    "mooney-rivlin": {"c10": 1.5e5, "c01": 0.6e5},
    "yeoh": {"c10": 2e5, "c20": -8e3, "c30": 4e2},
    "ogden-2": {"modulus_1": 4e5, "modulus_2": 2e3, "exponent_1": 1.3, "exponent_2": 5.0},
}
# Shear modulus at zero strain in the terms of each law (Ogden: half the sum of mu_i alpha_i).
SHEAR_MODULUS = {
    "neo-hookean": 4e5,
    "mooney-rivlin": 2 * (1.5e5 + 0.6e5),
    "yeoh": 2 * 2e5,
    "ogden-2": (4e5 * 1.3 + 2e3 * 5.0) / 2,
}
# Initial slope over shear modulus: uniaxial 3, equibiaxial 6, pure shear 4.
INITIAL = {"uniaxial": 3.0, "equibiaxial": 6.0, "pure-shear": 4.0}


def energy(law, parameters, principal):
    """Strain energy from principal stretches, shape (3, n)."""
    first = np.sum(principal**2, axis=0) - 3
    second = np.sum(principal**-2.0, axis=0) - 3
    if law == "neo-hookean":
        return parameters["shear_modulus"] / 2 * first
    if law == "mooney-rivlin":
        return parameters["c10"] * first + parameters["c01"] * second
    if law == "yeoh":
        return sum(parameters[f"c{i}0"] * first**i for i in (1, 2, 3))
    return sum(
        parameters[f"modulus_{i}"]
        / parameters[f"exponent_{i}"]
        * (np.sum(principal ** parameters[f"exponent_{i}"], axis=0) - 3)
        for i in (1, 2)
    )


def principal_stretches(stretch, deformation):
    lateral = {
        "uniaxial": [stretch**-0.5, stretch**-0.5],
        "equibiaxial": [stretch, stretch**-2.0],
        "pure-shear": [np.ones_like(stretch), 1 / stretch],
    }[deformation]
    return np.stack([stretch, *lateral])


@pytest.mark.parametrize("deformation", list(INITIAL))
@pytest.mark.parametrize("law", LAWS)
def test_stress_is_the_derivative_of_the_energy(law, deformation):
    stretch, step = np.linspace(1.05, 3.5, 50), 1e-5
    work = [
        energy(law, EXAMPLE[law], principal_stretches(stretch + side, deformation))
        for side in (-step, step)
    ]
    pulls = 2 if deformation == "equibiaxial" else 1
    expected = (work[1] - work[0]) / (2 * step) / pulls
    found = hyperelastic_stress(
        stretch - 1, law=law, parameters=EXAMPLE[law], deformation=deformation
    )
    np.testing.assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.parametrize("deformation", list(INITIAL))
@pytest.mark.parametrize("law", LAWS)
def test_initial_slope_is_that_of_an_incompressible_solid(law, deformation):
    step = 1e-6
    stress = hyperelastic_stress(
        [-step, step], law=law, parameters=EXAMPLE[law], deformation=deformation
    )
    slope = (stress[1] - stress[0]) / (2 * step)
    assert slope == pytest.approx(INITIAL[deformation] * SHEAR_MODULUS[law], rel=1e-6)


def test_mooney_rivlin_is_ogden_of_exponents_two_and_minus_two():
    ogden = {"modulus_1": 3e5, "modulus_2": -1.2e5, "exponent_1": 2.0, "exponent_2": -2.0}
    strain = np.linspace(0.1, 3, 20)
    for deformation in INITIAL:
        np.testing.assert_allclose(
            hyperelastic_stress(strain, law="ogden-2", parameters=ogden, deformation=deformation),
            hyperelastic_stress(
                strain,
                law="mooney-rivlin",
                parameters={"c10": 1.5e5, "c01": 0.6e5},
                deformation=deformation,
            ),
            rtol=1e-12,
        )


def test_an_impossible_stretch_is_refused():
    with pytest.raises(DataError, match="stretch_ratio are not positive"):
        hyperelastic_stress([-1.5], law="neo-hookean", parameters=EXAMPLE["neo-hookean"])


def test_an_unknown_deformation_is_refused():
    with pytest.raises(DataError, match="no such deformation; found torsion"):
        _polynomial_columns([1.0], law="yeoh", deformation="torsion")
    with pytest.raises(DataError, match="no such deformation; found torsion"):
        _ogden_columns(np.ones(1), np.ones(1), deformation="torsion")


def test_an_unknown_law_is_refused():
    with pytest.raises(DataError, match="not a law in the invariants; found gent"):
        _polynomial_columns([1.0], law="gent")


@pytest.mark.parametrize("deformation", list(INITIAL))
def test_ogden_slopes_are_the_derivatives_of_the_columns(deformation):
    stretch, exponents, step = np.linspace(0.5, 3.0, 9), np.array([-3.0, 0.0, 1.3, 6.0]), 1e-6
    up, down = (
        _ogden_columns(stretch, exponents + side, deformation=deformation) for side in (step, -step)
    )
    _, slopes = _ogden_basis(stretch, exponents, deformation=deformation)
    np.testing.assert_allclose(slopes, (up - down) / (2 * step), rtol=1e-7, atol=1e-8)


def test_several_sets_of_exponents_are_one_call():
    stretch, sets = np.linspace(1.0, 3.0, 5), np.array([[1.3, 5.0], [-2.0, 2.0]])
    together = _ogden_basis(stretch, sets[:, None, :])
    for place, one in enumerate(sets):
        for all_sets, alone in zip(together, _ogden_basis(stretch, one), strict=True):
            np.testing.assert_array_equal(all_sets[place], alone)

"""Elastomer fits: parameters come back, and unstable ones are named."""

import numpy as np
import pytest
from refusals import refusals

from reduction.record.errors import DataError
from reduction.stages.moduli.elastomer_laws import (
    LAWS,
    _is_stable,
    _ogden_basis,
    _ogden_columns,
    _polynomial_columns,
    even_grid,
    fit_elastomers,
    hyperelastic_stress,
    mooney_plot,
)

STRAIN = np.linspace(0.005, 2.75, 1500)
EXAMPLE = {
    "neo-hookean": {"shear_modulus": 4e5},
    "mooney-rivlin": {"c10": 1.5e5, "c01": 0.6e5},
    "yeoh": {"c10": 2e5, "c20": -8e3, "c30": 4e2},
    "ogden-2": {"modulus_1": 4e5, "modulus_2": 2e3, "exponent_1": 1.3, "exponent_2": 5.0},
}


@pytest.mark.parametrize("law", LAWS)
def test_a_law_gives_its_own_parameters_back_within_its_uncertainty(law):
    rng = np.random.default_rng(1)
    stress = hyperelastic_stress(STRAIN, law=law, parameters=EXAMPLE[law])
    fits = fit_elastomers(STRAIN, stress + 500 * rng.standard_normal(STRAIN.size), specimen="new")
    fit = fits[LAWS.index(law)]
    assert (fit.specimen, fit.law) == ("new", law)
    for name, value in EXAMPLE[law].items():
        assert abs(fit.parameters[name] - value) < 4 * fit.standard_uncertainty[name]
        assert fit.standard_uncertainty[name] < 0.05 * abs(value)
    assert fit.strain_high == pytest.approx(2.75, abs=0.01)
    assert fit.rms_stress < 300
    others = [other.aicc for other in fits if len(other.parameters) < len(fit.parameters)]
    assert all(fit.aicc < aicc for aicc in others)


def test_a_hold_in_the_pull_does_not_count_for_more():
    stress = hyperelastic_stress(STRAIN, law="yeoh", parameters=EXAMPLE["yeoh"])
    held = np.concatenate([STRAIN, np.full(20000, STRAIN[700])])
    loads = np.concatenate([stress, np.full(20000, stress[700])])
    once, twice = (
        fit_elastomers(x, y, specimen="a")[0] for x, y in [(STRAIN, stress), (held, loads)]
    )
    assert twice.parameters["shear_modulus"] == pytest.approx(
        once.parameters["shear_modulus"], rel=1e-3
    )


def test_a_scaled_stress_scales_the_moduli_and_not_the_exponents():
    stress = hyperelastic_stress(STRAIN, law="ogden-2", parameters=EXAMPLE["ogden-2"])
    one, ten = (fit_elastomers(STRAIN, k * stress, specimen="a")[3] for k in (1, 10))
    for name, value in one.parameters.items():
        factor = 10 if name.startswith("modulus") else 1
        assert ten.parameters[name] == pytest.approx(factor * value, rel=1e-5)


@pytest.mark.parametrize("exponents", [(-3.0, 5.0), (5.0, -3.0), (1.3, 20.0)])
def test_ogden_terms_stand_in_the_order_of_their_exponents(exponents):
    modulus = {5.0: 2e3, -3.0: -4e4, 1.3: 4e5, 20.0: 1e-6}
    law = {"modulus_1": modulus[exponents[0]], "modulus_2": modulus[exponents[1]]}
    law |= {"exponent_1": exponents[0], "exponent_2": exponents[1]}
    stress = hyperelastic_stress(STRAIN, law="ogden-2", parameters=law)
    noise = 300 * np.random.default_rng(6).standard_normal(STRAIN.size)
    found = fit_elastomers(STRAIN, stress + noise, specimen="a")[3]
    for place, exponent in enumerate(sorted(exponents), start=1):
        for name, value in {"exponent": exponent, "modulus": modulus[exponent]}.items():
            off = abs(found.parameters[f"{name}_{place}"] - value)
            assert off < 4 * found.standard_uncertainty[f"{name}_{place}"]


def test_an_unstable_fit_says_so():
    parameters = {"c10": 3e5, "c01": -1e5}
    stress = hyperelastic_stress(STRAIN, law="mooney-rivlin", parameters=parameters)
    fit = fit_elastomers(STRAIN, stress, specimen="new")[1]
    assert not fit.is_stable
    (note,) = [note for note in map(str, fit.notes) if "not stable" in note]
    assert note.startswith("the fitted law is not stable: below a strain of ")
    assert note.endswith(". Do not use it in a model")


def test_a_parameter_not_told_from_zero_is_named():
    rng = np.random.default_rng(2)
    stress = hyperelastic_stress(STRAIN, law="neo-hookean", parameters=EXAMPLE["neo-hookean"])
    fits = fit_elastomers(STRAIN, stress + 5e4 * rng.standard_normal(STRAIN.size), specimen="new")
    assert any("interval includes zero" in note for fit in fits for note in map(str, fit.notes))


def test_a_law_that_cannot_be_fitted_gives_nan_and_the_reason():
    fit = fit_elastomers(STRAIN, np.zeros_like(STRAIN), specimen="new")[3]
    assert np.isnan(list(fit.parameters.values())).all()
    assert str(fit.notes[0]).startswith("not fitted: ")


@pytest.mark.parametrize("law", LAWS)
def test_sound_examples_are_stable(law):
    assert _is_stable(law=law, parameters=EXAMPLE[law], strain_high=2.75)


def test_stability_is_asked_in_every_deformation():
    # Uniaxial stress of this material rises throughout; the equibiaxial one does not.
    parameters = {"c10": 3e5, "c01": -2e4}
    grid = np.linspace(0, 3, 300)
    stress = {
        deformation: hyperelastic_stress(
            grid, law="mooney-rivlin", parameters=parameters, deformation=deformation
        )
        for deformation in ("uniaxial", "equibiaxial")
    }
    assert np.all(np.diff(stress["uniaxial"]) > 0)
    assert np.any(np.diff(stress["equibiaxial"]) < 0)
    assert not _is_stable(law="mooney-rivlin", parameters=parameters, strain_high=3.0)


def test_mooney_plot_of_a_mooney_rivlin_material_is_its_line():
    stress = hyperelastic_stress(STRAIN, law="mooney-rivlin", parameters=EXAMPLE["mooney-rivlin"])
    inverse, reduced = mooney_plot(STRAIN, stress)
    shown = np.isfinite(reduced)
    np.testing.assert_allclose(reduced[shown], 1.5e5 + 0.6e5 * inverse[shown], rtol=1e-9)
    assert np.isnan(reduced[STRAIN <= 0.02]).all()


def test_the_grid_leaves_out_slack_and_missing_samples():
    strain, stress = even_grid(
        [-0.1, 0.0, np.nan, 0.5, 1.0], [0.0, 0.0, 1.0, 5.0, 10.0], n_points=2
    )
    np.testing.assert_array_equal(strain, [0.75])
    np.testing.assert_array_equal(stress, [7.5])


def test_the_criterion_is_that_of_akaike_corrected_for_few_readings():
    """n ln(S/n) + 2p + 2p(p+1)/(n-p-1) with p - 1 parameters, from the rms residual."""
    rng = np.random.default_rng(3)
    stress = hyperelastic_stress(STRAIN, law="yeoh", parameters=EXAMPLE["yeoh"])
    stress = stress + 500 * rng.standard_normal(STRAIN.size)
    n = even_grid(STRAIN, stress)[0].size
    for fit in fit_elastomers(STRAIN, stress, specimen="new"):
        p = len(fit.parameters) + 1
        expected = n * np.log(fit.rms_stress**2) + 2 * p + 2 * p * (p + 1) / (n - p - 1)
        assert fit.aicc == pytest.approx(expected)


# stress of hyperelastic laws: limits, identities, and the work they come from

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


def test_an_unknown_deformation_is_refused():
    with pytest.raises(DataError, match="no such deformation; found torsion"):
        _polynomial_columns([1.0], law="yeoh", deformation="torsion")
    with pytest.raises(DataError, match="no such deformation; found torsion"):
        _ogden_columns(np.ones(1), np.ones(1), deformation="torsion")


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


REFUSED = {
    "an empty range is refused": (
        lambda: _is_stable(law="yeoh", parameters=EXAMPLE["yeoh"], strain_high=0.0),
        DataError,
        "range of strain is empty; found 0 to 0",
    ),
    "a pull that never stretches is refused": (
        lambda: even_grid([0.0, -1.0], [0.0, 0.0]),
        DataError,
        "no stretched sample; found 0 samples",
    ),
    "too few intervals are refused": (
        lambda: fit_elastomers(np.linspace(0.1, 1, 5), np.ones(5), specimen="new"),
        DataError,
        "too few strain intervals hold a sample; found 5",
    ),
    "an impossible stretch is refused": (
        lambda: hyperelastic_stress([-1.5], law="neo-hookean", parameters=EXAMPLE["neo-hookean"]),
        DataError,
        "stretch_ratio are not positive",
    ),
    "an unknown law is refused": (
        lambda: _polynomial_columns([1.0], law="gent"),
        DataError,
        "not a law in the invariants; found gent",
    ),
}


test_refusals = refusals(REFUSED)

"""Contributions to the parameters of a law against the same fit to a stress with that error."""

import numpy as np
import pytest

from reduction.stages.moduli.elastomer_laws import fit_elastomers, hyperelastic_stress
from reduction.uncertainty.propagation import elastomer_contributions

STRAIN = np.linspace(0.02, 2.2, 500)
# two Ogden terms, and a part that no law here has: what is left over bends the least squares
TRUE = hyperelastic_stress(
    STRAIN,
    law="ogden-2",
    parameters={"modulus_1": 4e5, "modulus_2": 2e3, "exponent_1": 1.6, "exponent_2": 6.0},
)
STRESS = TRUE + 6e3 * np.sin(4 * STRAIN)
ERRORS = {"gain": 2e-4 * STRESS, "zero": np.full(STRAIN.size, 30.0), "strain": 4e2 * STRAIN**2}


@pytest.mark.parametrize("error", ERRORS)
@pytest.mark.parametrize("place", range(4))
def test_parameters_move_as_a_fit_to_the_wrong_stress_says(place, error):
    change = ERRORS[error]
    fits = [
        fit_elastomers(STRAIN, STRESS + way * change, specimen="new")[place] for way in (1, 0, -1)
    ]
    exact = fits[1].parameters
    found = elastomer_contributions(
        [change], strain=STRAIN, stress=STRESS, law=fits[1].law, parameters=exact
    )[0]
    for name, value in zip(exact, found, strict=True):
        wanted = (fits[0].parameters[name] - fits[2].parameters[name]) / 2
        tolerance = 0.02 * abs(wanted) + 1e-6 * abs(exact[name])
        assert value == pytest.approx(wanted, abs=tolerance), (fits[1].law, name)


def test_no_error_gives_no_row():
    found = elastomer_contributions(
        np.empty((0, STRAIN.size)),
        strain=STRAIN,
        stress=STRESS,
        law="neo-hookean",
        parameters={"shear_modulus": 2e5},
    )
    assert found.shape == (0, 1)

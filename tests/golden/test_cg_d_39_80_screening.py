"""CG-D-39-80, Table A-2: effects, smallest significant effects, and which factors count.

The report prints neither runs nor the error of an effect.  The error follows from the printed
smallest significant effect over 1.943, t(0.10 two-sided, 6 dummies); runs that have the
printed effects and dummies of that size must give the table and the marks of its text back.
"""

import numpy as np
import pytest

from reduction.experiments.designs import plackett_burman
from reduction.experiments.screening import screening_effects

FACTORS = ("f", "Tm", "dT", "duration", "D")
# effects as printed, smallest significant effect as printed, its error, factors that count
TABLE = {
    "K_ap": ((6.1, 14.3, 3.1, 5.3, 3.7), 7.72, 3.973, {"Tm"}),
    "K1": ((5.2, 8.3, 3.5, 5.0, 0.6), 8.0, 4.117, {"Tm"}),
    "K0": ((0.5, 6.5, 1.1, 0.2, 1.6), 1.5, 0.772, {"Tm", "D"}),
    "tau": ((5.3, 2.3, 5.7, 4.5, 4.2), 10.79, 5.553, set()),
    "H": ((0.7, 6.6, 6.1, 0.5, 4.5), 3.12, 1.606, {"Tm", "dT", "D"}),
    "tensile strength": ((0.5, 0.1, 0.4, 1.0, 9.4), 1.4, 0.720, {"D"}),
    "elongation at failure": ((6.9, 8.1, 0.0, 6.6, 9.4), 7.0, 3.602, {"Tm", "D"}),
}
HALF_A_DIGIT = {7.72: 0.005, 10.79: 0.005, 3.12: 0.005, 8.0: 0.05, 1.5: 0.05, 1.4: 0.05, 7.0: 0.05}


def screened():
    design = plackett_burman(5)
    columns = np.hstack([design.coded, design.dummy])
    effects = np.array([[*row[0], *np.full(6, row[2])] for row in TABLE.values()])
    return screening_effects(design, effects @ columns.T / 2, names=FACTORS)


@pytest.mark.parametrize("number", range(len(TABLE)), ids=TABLE)
def test_a_row_of_table_a2_comes_back(number):
    printed, smallest, error, marked = list(TABLE.values())[number]
    found = screened()
    np.testing.assert_allclose(found.effect[number], printed, atol=1e-9)
    assert found.effect_standard_error[number] == pytest.approx(error)
    assert abs(found.minimum_significant_effect[number] - smallest) < HALF_A_DIGIT[smallest]
    counted = {
        name for name, counts in zip(FACTORS, found.is_significant[number], strict=True) if counts
    }
    assert counted == marked


def test_taken_together_the_five_factors_clear_a_higher_bar():
    # Not in the report: at 90 % for one effect, five noise effects give a false mark in 41 %.
    found = screened()
    assert np.all(found.simultaneous_minimum_effect > found.minimum_significant_effect)

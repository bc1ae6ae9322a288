"""Names of what is said of a response are made of the response and a pattern."""

import pytest

from reduction.quantities.names import (
    QUANTITIES,
    RESPONSES,
    SINGLE_QUANTITIES,
    SURFACE_NAMES,
    quantity,
    rows_of_response,
)


@pytest.mark.parametrize(
    ("name", "unit", "long_name"),
    [
        ("relaxation_time_sigma", "s", "relaxation time: residual standard deviation of a run"),
        ("hysteresis_energy_coefficient", "J m-1", "hysteresis energy: coefficient, coded units"),
        ("hysteresis_energy_anova_mean_square", "J2 m-2", "hysteresis energy: mean square"),
        ("loss_factor_anova_mean_square", "1", "loss factor: mean square"),
        ("log_loss_spring_constant_fitted", "1", "logarithm of loss spring constant: value"),
        ("box_cox_relaxation_time_fitted", "1", "Box-Cox transform of relaxation time: value"),
        ("response_coefficient", "unit", "response: coefficient, coded units"),
        (
            "dashpot_coefficient_refusal",
            "",
            "dashpot coefficient: results of the surface that are not",
        ),
        ("dashpot_coefficient_p_value", "1", "dashpot coefficient: p-value"),
    ],
)
def test_unit_and_meaning_follow_the_response(name, unit, long_name):
    found = quantity(name)
    assert found.name == name
    assert found.unit == unit
    assert found.long_name.startswith(long_name)


def test_no_made_name_hides_another():
    made = [row.name for name in SURFACE_NAMES for row in rows_of_response(name)]
    assert len(set(made)) == len(made)
    assert not set(made) & set(SINGLE_QUANTITIES)
    assert set(made) <= set(QUANTITIES)


def test_every_response_is_a_quantity_of_a_cycle():
    assert len(SURFACE_NAMES) == (1 + 3) * len(RESPONSES)  # three transforms
    assert set(RESPONSES) <= set(SINGLE_QUANTITIES)


def test_a_name_that_is_not_there_is_refused():
    with pytest.raises(KeyError):
        quantity("colour_coefficient")

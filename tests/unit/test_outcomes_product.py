"""What an outcome says of the line."""

import math

import pytest

from reduction.experiments.outcomes import IN_THE_TERMINATION, Outcome, reason_codes


@pytest.mark.parametrize(
    ("facts", "use"),
    [
        ({}, "value"),
        ({"place": "splice_toe"}, "value"),
        # the laboratory's word goes before the place
        ({"place": "splice"}, "value"),
        ({"is_valid": False}, "excluded"),
        ({"is_valid": False, "place": "free"}, "excluded"),
        ({"is_valid": False, "is_suspended": True}, "excluded"),
        ({"is_suspended": True}, "lower_bound"),
        *[({"is_valid": False, "place": place}, "lower_bound") for place in IN_THE_TERMINATION],
        ({"is_valid": False, "place": "grip", "value": math.nan}, "excluded"),
    ],
)
def test_use_of_a_value(facts, use):
    assert Outcome(**({"quantity": "tensile_strength", "value": 28e3} | facts)).use == use


def test_the_first_reason_that_holds_is_given():
    assert reason_codes((2,), [([False, True], 3), (True, 2)]).tolist() == [2, 3]

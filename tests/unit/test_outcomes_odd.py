"""Outcomes that are unlike the others of their group."""

import numpy as np
import pytest

from reduction.experiments.outcome_groups import odd_outcomes
from reduction.experiments.outcomes import Outcome


def strengths(*values, condition="new"):
    return [
        Outcome("tensile_strength", value, test=f"B-{place}", condition=condition, row=place)
        for place, value in enumerate(values, start=2)
    ]


def test_a_value_that_is_far_from_every_other_is_named_with_what_it_is_like():
    (found,) = odd_outcomes(strengths(28.5e3, 27.1e3, 2.8e3, 28.0e3))
    assert found.subject == "B-4" and found.severity == "warning"
    assert str(found).startswith(
        "B-4: row 4: its tensile strength is 0.1 times the median of the 3"
    )


def test_of_three_only_the_odd_one_is_named():
    (found,) = odd_outcomes(strengths(20.8e3, 95.6, 21.8e3, condition="worn"))
    assert found.subject == "B-3"


@pytest.mark.parametrize("seed", range(10))
def test_breaks_and_lives_that_scatter_as_they_do_are_not_odd(seed):
    noise = np.random.default_rng(seed)
    breaks = strengths(*(28e3 * noise.lognormal(0, 0.12, 12)))
    lives = [
        Outcome("cycles_to_failure", value, peak_load_ratio=share, row=2)
        for share, usual in ((0.45, 5e4), (0.6, 9e3))
        for value in usual * noise.weibull(1.5, 8)
    ]
    assert odd_outcomes([*breaks, *lives]) == []


def test_groups_loads_and_lower_bounds_are_not_held_against_each_other():
    worn = strengths(14e3, 13e3, 15e3, condition="worn")
    stopped = Outcome("tensile_strength", 5e3, is_suspended=True, condition="new", row=9)
    assert odd_outcomes([*strengths(28e3, 29e3, 27e3), *worn, stopped]) == []

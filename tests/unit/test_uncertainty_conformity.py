"""Decision rules: the cases of JCGM 106:2012, 8.2 and 8.3, one beside the other."""

from math import nan

import pytest

from reduction.uncertainty.budget import conformity

# value, interval, lower, upper; simple acceptance, guard band
CASES = [
    (5.0, (4.0, 6.0), 3.0, 7.0, "conforms", "conforms"),
    (5.0, (4.0, 6.0), 4.0, 6.0, "conforms", "conforms"),
    (5.0, (4.0, 6.0), 4.5, 7.0, "conforms", "no statement"),
    (5.0, (4.0, 6.0), 5.0, None, "conforms", "no statement"),
    (5.0, (4.0, 6.0), None, 4.5, "does not conform", "no statement"),
    (5.0, (4.0, 6.0), 6.0, None, "does not conform", "no statement"),
    (5.0, (4.0, 6.0), 6.1, None, "does not conform", "does not conform"),
    (5.0, (4.0, 6.0), None, 3.9, "does not conform", "does not conform"),
    # wider than the tolerance: nothing can be shown to conform
    (5.0, (0.0, 10.0), 4.0, 6.0, "conforms", "no statement"),
    # not even about the value
    (5.0, (4.8, 9.0), 4.5, 8.0, "conforms", "no statement"),
    (5.0, (nan, nan), 4.0, 6.0, "conforms", "no statement"),
    (nan, (nan, nan), 4.0, 6.0, "no statement", "no statement"),
]


@pytest.mark.parametrize(("value", "interval", "lower", "upper", "simple", "guarded"), CASES)
def test_each_rule_decides_as_it_says(value, interval, lower, upper, simple, guarded):
    limits = {"lower": lower, "upper": upper}
    assert conformity(value, interval, rule="simple acceptance", **limits) == simple
    assert conformity(value, interval, rule="guard band", **limits) == guarded

"""A few mutations of every kind, held against the invariant; all of them are nightly."""

import pytest
from mutatedruns import hold
from mutations import strategies


@pytest.mark.parametrize("name", sorted(strategies()))
def test_what_is_spoilt_breaks_no_rule(name):
    assert hold(name, 4).total() > 0

"""Workbooks and MATLAB files, spoilt; docs/fuzzing.md has the rule."""

import pytest
from mutatedruns import hold

pytestmark = pytest.mark.nightly


@pytest.mark.parametrize(
    ("name", "n_examples"),
    [("spreadsheet", 150), ("matlab", 110), ("matlab-packed", 110), ("matlab-4", 110)],
)
def test_a_spoilt_log_is_refused_or_flagged_or_gives_the_numbers_in_it(name, n_examples):
    tally = hold(name, n_examples)
    assert tally["refused"] > 0 and tally["flagged"] > 0
    assert tally["as before"] + tally["another log"] > 0

"""campaign.toml and the tables beside it, spoilt; docs/fuzzing.md has the rule."""

import pytest
from mutatedruns import hold

pytestmark = pytest.mark.nightly


@pytest.mark.parametrize(
    ("name", "n_examples"),
    [
        ("campaign", 130),
        ("campaign-without-units", 130),
        ("campaign-of-tables", 100),
        ("tables", 150),
    ],
)
def test_a_spoilt_campaign_is_refused_or_flagged_or_gives_the_numbers_in_it(name, n_examples):
    tally = hold(name, n_examples)
    assert tally["refused"] > 0 and tally["as before"] > 0
    assert tally["another log"] + tally["flagged"] > 0

"""Logs of every format, spoilt: refused, flagged, or reduced as they are; docs/fuzzing.md has the rule."""

import pytest
from mutatedruns import hold

pytestmark = pytest.mark.nightly


@pytest.mark.parametrize(
    ("name", "n_examples"),
    [
        ("delimited", 150), ("continental", 150), ("blocks", 120), ("json", 130),
        ("spreadsheet", 150), ("matlab", 110), ("matlab-packed", 110), ("matlab-4", 110),
        ("hdf5", 100), ("hdf5-matrix", 100), ("tdms", 110), ("parquet", 100), ("parquet-plain", 100),
    ],
)  # fmt: skip
def test_a_spoilt_log_is_refused_or_flagged_or_gives_the_numbers_in_it(name, n_examples):
    tally = hold(name, n_examples)
    # what is drawn is neither all rubbish nor all sound
    assert tally["refused"] > 0 and tally["flagged"] > 0
    assert tally["as before"] + tally["another log"] > 0

"""Which theory the printed table names, and which is meant."""

import pytest

from reduction.prediction.wave_theory import _printed_theory, _theory_by_depth
from reduction.record.errors import DataError


@pytest.mark.parametrize(
    ("relative_depth", "theory"),
    [
        (0.5, "airy"), (0.2, "airy"), (0.199, "stokes"), (0.1, "stokes"),
        (0.099, "cnoidal"), (0.041, "cnoidal"),
        (0.04, "beyond the table"), (0.01, "beyond the table"),
    ],
)  # fmt: skip
def test_depth_names_the_theory(relative_depth, theory):
    assert _theory_by_depth(relative_depth) == theory


@pytest.mark.parametrize(
    ("relative_depth", "steepness", "theory"),
    [
        (0.3, 0.0625, "airy"), (0.3, 0.2, "airy"), (0.3, 0.201, "none"), (0.0999, 0.01, "cnoidal or solitary"), (0.15, 0.0625, "none"), (0.15, 0.2, "stokes"),
        (0.1, 0.2, "none"), (0.07, 0.01, "cnoidal or solitary"), (0.03, 0.01, "none"),
    ],
)  # fmt: skip
def test_the_letter_of_the_table(relative_depth, steepness, theory):
    assert _printed_theory(relative_depth, steepness) == theory


def test_no_wave_that_stands_is_in_the_printed_row_of_stokes():
    # 0.142 is the steepest wave on any depth, and the row begins at 0.2
    for relative_depth in (0.11, 0.13, 0.15, 0.17, 0.19):
        assert _printed_theory(relative_depth, 0.142) == "none"


def test_ratios_are_positive():
    with pytest.raises(DataError, match="relative_depth"):
        _theory_by_depth(0.0)
    with pytest.raises(DataError, match="steepness"):
        _printed_theory(0.3, -0.1)

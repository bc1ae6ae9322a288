"""A life over one of which mean and deviation are printed."""

import math

import numpy as np
import pytest

from reduction.experiments.life_statistics import ratio_to_published_life
from reduction.record.errors import DataError

REFERENCE = {"reference_mean": 8134, "reference_standard_deviation": 1963, "reference_n": 38}


def test_the_ratio_is_that_of_medians():
    ratio, *_ = ratio_to_published_life([29e3, 39e3, 41e3], [False] * 3, **REFERENCE)
    median = 8134 / np.sqrt(1 + (1963 / 8134) ** 2)
    assert ratio == pytest.approx((29e3 * 39e3 * 41e3) ** (1 / 3) / median)


def test_one_failure_gives_no_ratio():
    ratios = ratio_to_published_life([29e3, 39e3], [False, True], **REFERENCE)
    assert all(map(math.isnan, ratios))


@pytest.mark.parametrize("name", REFERENCE)
def test_a_reference_without_scatter_or_mean_is_refused(name):
    with pytest.raises(DataError, match="a reference life cannot be used; found mean"):
        ratio_to_published_life([29e3, 39e3], [False] * 2, **(REFERENCE | {name: 0}))

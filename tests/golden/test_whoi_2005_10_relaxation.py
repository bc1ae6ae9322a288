"""Relaxation printed in WHOI-2005-10, sec. 4.1 and Figure 24."""

import numpy as np
import pytest

from reduction.stages.holds.relaxation_numbers import relaxation_drop

HALF_LAST_DIGIT_LBF = 0.5


def test_t_6_new_tether_loses_three_sixteenths_in_three_minutes():
    # "a measured tension of 400 lbs when first stretched to 275%.  Three minutes later ...
    # the tension had dropped to 325 lbs"
    assert relaxation_drop(400.0, 325.0) == pytest.approx(0.1875)
    low = relaxation_drop(400 - HALF_LAST_DIGIT_LBF, 325 + HALF_LAST_DIGIT_LBF)
    high = relaxation_drop(400 + HALF_LAST_DIGIT_LBF, 325 - HALF_LAST_DIGIT_LBF)
    assert np.all([low < 0.1875, high > 0.1875])

"""A length beside a period."""

import numpy as np
import pytest

from reduction.prediction.wave_theory import _check_wave_length, _wave_number
from reduction.record.errors import DataError


def test_a_length_that_fits_has_no_mismatch():
    length = 2 * np.pi / _wave_number([3.0, 9.0], 5.0)
    check = _check_wave_length(length, [3.0, 9.0], 5.0)
    assert check.period_mismatch == pytest.approx(0.0, abs=1e-13)
    assert check.length_mismatch == pytest.approx(0.0, abs=1e-13)
    assert check.length_of_period == pytest.approx(length)


def test_the_printed_wave_fits_neither_depth():
    # 20 m beside 3.57 s: 3.663 s at 6 m, 4.17 s at 3 m; 3.57 s needs 16.3 m there
    check = _check_wave_length(20.0, 3.57, [6.0, 3.0])
    assert check.period_of_length == pytest.approx([3.663, 4.171], abs=0.001)
    assert check.period_mismatch == pytest.approx([0.026, 0.168], abs=0.001)
    assert check.length_of_period[1] == pytest.approx(16.3, abs=0.05)


def test_a_length_is_positive():
    with pytest.raises(DataError, match="wave_length"):
        _check_wave_length(-20.0, 3.57, 6.0)

"""Numbers are written as Python writes them, whatever their size."""

import numpy as np
import pytest
from table_cells import text_of_columns

RNG = np.random.default_rng(20)
SIZES = 10.0 ** np.arange(-8, 20)
NUMBERS = {
    "of any bits": RNG.integers(0, 2**63, 20000, dtype=np.int64).view(np.float64),
    "of sizes that occur": RNG.normal(size=20000) * RNG.choice(SIZES, 20000),
    "of few digits": np.round(RNG.normal(size=20000) * RNG.choice(SIZES[8:14], 20000), 3),
    "whole": RNG.integers(-(10**9), 10**9, 20000).astype(float),
    "at powers of ten": np.concatenate(
        [SIZES, np.nextafter(SIZES, 0), np.nextafter(SIZES, np.inf), -SIZES]
    ),
    "special": np.array([0.0, -0.0, np.inf, -np.inf, 5e-324, 1.7976931348623157e308, 2.0**53]),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_is_written_as_python_writes_it(name):
    numbers = NUMBERS[name][~np.isnan(NUMBERS[name])]
    lines = text_of_columns(numbers).split("\r\n")[:-1]
    assert lines == [repr(number) for number in numbers.tolist()]

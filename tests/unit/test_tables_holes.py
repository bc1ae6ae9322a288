"""Why a cell of a table is empty beside a number."""

import numpy as np
import pandas as pd

from reduction.archive.csv_columns import (
    SYNTHETIC,
    CsvColumn,
    _lonely_numbers,
    column_descriptions,
    uncertainty_of,
)
from reduction.quantities.names import QUANTITIES


def test_an_empty_cell_beside_a_number_has_a_reason_and_a_full_column_needs_none():
    diameter = CsvColumn("diameter", QUANTITIES["diameter"])
    columns = [diameter, uncertainty_of(diameter), SYNTHETIC]
    holed = _lonely_numbers(columns, pd.DataFrame([[0.02, np.nan, "no"], [0.02, 1e-4, "no"]]))
    full = _lonely_numbers(columns, pd.DataFrame([[np.nan, np.nan, "no"], [0.02, 1e-4, "no"]]))
    assert (holed, full) == ({1}, set())
    (_, of_holed, _) = column_descriptions(columns, holed)
    assert of_holed[-1] == (
        "is an uncertainty; empty where there is one reading, and nothing is stated of it"
    )
    (_, of_full, _) = column_descriptions(columns, full)
    assert of_full[-1] == "is an uncertainty"

"""Why a cell of a table is empty beside a number."""

from contextlib import ExitStack

import numpy as np

from reduction.archive.csv_columns import (
    SYNTHETIC,
    CsvColumn,
    TableFile,
    column_descriptions,
    uncertainty_of,
)
from reduction.quantities.names import QUANTITIES


def _lonely(columns, path, diameters):
    with ExitStack() as whole:
        table = TableFile(path, columns, whole)
        table.add_columns([np.array(diameters), np.array([np.nan, 1e-4]), ["no", "no"]])
        return table.lonely


def test_an_empty_cell_beside_a_number_has_a_reason_and_a_full_column_needs_none(tmp_path):
    diameter = CsvColumn("diameter", QUANTITIES["diameter"])
    columns = [diameter, uncertainty_of(diameter), SYNTHETIC]
    holed = _lonely(columns, tmp_path / "holed.csv", [0.02, 0.02])
    full = _lonely(columns, tmp_path / "full.csv", [np.nan, 0.02])
    assert (holed, full) == ({1}, set())
    (_, of_holed, _) = column_descriptions(columns, holed)
    assert of_holed[-1] == (
        "is an uncertainty; empty where there is one reading, and nothing is stated of it"
    )
    (_, of_full, _) = column_descriptions(columns, full)
    assert of_full[-1] == "is an uncertainty"

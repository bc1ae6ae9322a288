"""A step has one static stiffness and one creep: of its last pair, and of its longest hold."""

import numpy as np
import xarray as xr
from table_cells import table_rows

from reduction.archive.csv_definitions import TABLES

(PROGRAMME,) = (table for table in TABLES if table.name == "rope_programme")


def cells(**variables):
    dataset = xr.Dataset(
        {"programme_step": ((), "step"), **variables}, coords={"specimen": ["a", "b"]},
        attrs={"test": "T"},
    )  # fmt: skip
    header = [column.name for column in PROGRAMME.columns]
    return [dict(zip(header, row, strict=True)) for row in table_rows(dataset, PROGRAMME)]


def test_the_last_pair_that_has_a_stiffness_stands_for_the_step():
    first, second = cells(
        held_pair_specimen=("held_pair", ["a", "a", "a"]),
        static_stiffness=("held_pair", [1.0, 2.0, np.nan]),
        held_pair_low_tension=("held_pair", [10.0, 20.0, 30.0]),
    )
    assert (first["static_stiffness"], first["held_pair_low_tension"]) == (2.0, 20.0)
    assert second["static_stiffness"] is None
    assert second["programme_step"] == "step"


def test_the_longest_hold_stands_for_the_step():
    first, second = cells(
        hold_specimen=("hold", ["a", "b", "a", "b"]),
        hold_duration=("hold", [600.0, 600.0, 60.0, 60.0]),
        creep_rate_per_decade=("hold", [0.1, 0.2, 0.3, 0.4]),
    )
    assert (first["creep_rate_per_decade"], second["creep_rate_per_decade"]) == (0.1, 0.2)


def test_a_test_that_is_no_step_has_no_row():
    dataset = xr.Dataset(coords={"specimen": ["a"]})
    assert table_rows(dataset, PROGRAMME) == []

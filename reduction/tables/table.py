"""What a table is: the variables of an archive that it lays out in rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import xarray as xr

from reduction.archive.comparison_schema import COMPARISON_SCHEMA
from reduction.archive.prediction_schema import PREDICTION_SCHEMA
from reduction.archive.properties import PROPERTY_SCHEMA
from reduction.archive.schema import schema_of
from reduction.archive.surface_rows import rows_of_response
from reduction.archive.surface_schema import SURFACE_SCHEMA
from reduction.archive.variable import Variable, count, label, measured, stated
from reduction.tables.column import Column, uncertainty_of

Product = Literal[
    "test", "stepwise test", "experiments", "predictions", "comparisons", "properties"
]
Variables = Mapping[str, xr.Variable]
"""By name, as those of an archive."""

TEST = Column("test", label("test")[0])
SYNTHETIC = Column("synthetic", label("synthetic")[0])
_OWN = {
    row.name: row
    for row in [
        *count("n_cycles", ()),
        *measured("chord_modulus_ascending", ("specimen", "cycle")),
        *measured("chord_modulus_descending", ("specimen", "cycle")),
        *stated("strain_bin_low", ("strain_bin",), "bound"),
        *stated("strain_bin_high", ("strain_bin",), "bound"),
    ]
}
_OF_RESPONSES = {
    row.name: row
    for row in [
        *label("response"),
        *label("unit"),
        *label("response_unit"),
        *label("coefficient_engineering_unit"),
        *rows_of_response("response", is_transformed=False),
    ]
}
_SCHEMAS: dict[Product, dict[str, Variable]] = {
    "test": schema_of(is_stepwise=False) | _OWN,
    "stepwise test": schema_of(is_stepwise=True) | _OWN,
    "experiments": SURFACE_SCHEMA | _OF_RESPONSES,
    "predictions": PREDICTION_SCHEMA,
    "comparisons": COMPARISON_SCHEMA,
    "properties": PROPERTY_SCHEMA,
}


def _nothing(_: xr.Dataset) -> Variables:
    return {}


@dataclass(frozen=True)
class Table:
    """One file of tables: a row for each combination of the entries of ``dims``.

    Parameters
    ----------
    name : str
        File name without suffix.
    dims : tuple of str
        Slowest first; a dimension with a coordinate gives a column.
    variables : tuple of str
        Of the archive, in order; ``column=variable`` gives it another name here. A
        measured one is followed by its standard uncertainty.
    needs : tuple of str
        A row is written where one of these is known.
    derive : callable
        From the archive to variables that the table needs beside or in place of its own.
    product : str
        Whose names they are. A row of a test names it; any other names its experiment or hose.
    """

    name: str
    dims: tuple[str, ...]
    variables: tuple[str, ...]
    needs: tuple[str, ...]
    derive: Callable[[xr.Dataset], Variables] = _nothing
    product: Product = "test"

    @cached_property
    def columns(self) -> list[Column]:
        """Every column, the test first and the word on synthetic data last."""
        schema = _SCHEMAS[self.product]
        columns = [TEST] if self.product in ("test", "stepwise test") else []
        for item in (*(dim for dim in self.dims if dim in schema), *self.variables):
            name, _, source = item.partition("=")
            column = _column(name, schema[source or name])
            columns.append(column)
            if column.variable.has_uncertainty:
                columns.append(uncertainty_of(column))
        return [*columns, SYNTHETIC]


def _column(name: str, variable: Variable) -> Column:
    # the axis is `branch_name`, since `branch` is a flag of the samples
    return Column("branch" if name == "branch_name" else name, variable)

"""A table of experiments: its names are those of their archive."""

from __future__ import annotations

from reduction.tables.table import Table

RUN = ("run_name", "run_specimen")
"""Columns that say which run a row is of."""


def table_of_experiments(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> Table:
    """Return a table of a product of experiments."""
    return Table(name, dims, variables, needs, product="experiments")

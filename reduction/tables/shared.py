"""Tables of the errors that a test shares with others: a row each, with what it adds."""

from __future__ import annotations

from reduction.archive.shared import COMPONENT, SHARED
from reduction.tables.table import Table

__all__ = ["SHARED_TABLES"]

_ERROR = ("uncertainty_source", "uncertainty_source_of", "uncertainty_source_number")
_FILES = {
    ("specimen",): "shared_errors",
    ("specimen", "branch_name", "segment"): "shared_errors_segments",
    ("specimen", "branch_name", "strain_bin"): "shared_errors_curves",
    ("specimen", "branch_name", "first_loading_strain_bin"): "shared_errors_first_loading",
}


def _table(name: str, dims: tuple[str, ...]) -> Table:
    rows = tuple(
        f"{quantity}_uncertainty_contribution" for quantity, own in SHARED.items() if own == dims
    )
    return Table(name, (*dims, COMPONENT), (*_ERROR, *rows), rows)


SHARED_TABLES = tuple(_table(name, dims) for dims, name in _FILES.items())

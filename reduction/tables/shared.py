"""Tables of the errors that a test shares with others: a row each, with what it adds."""

from __future__ import annotations

from reduction.archive.shared import COMPONENT, SHARED, SHARED_OF_STEPS
from reduction.tables.table import Table

ERROR = (
    "uncertainty_source", "uncertainty_source_of", "uncertainty_source_number",
    "uncertainty_source_degrees_of_freedom",
)  # fmt: skip
"""Columns that say which error a row is of."""
_FILES = {
    ("specimen",): "shared_errors",
    ("specimen", "branch_name", "segment"): "shared_errors_segments",
    ("specimen", "branch_name", "strain_bin"): "shared_errors_curves",
    ("specimen", "branch_name", "first_loading_strain_bin"): "shared_errors_first_loading",
    ("specimen", "strain_level"): "shared_errors_stress",
    ("specimen", "tension_grid"): "shared_errors_slow_pull",
    ("specimen", "break_share"): "shared_errors_break_share",
    ("specimen", "pull_term"): "shared_errors_cubic",
    ("hold",): "shared_errors_holds",
    ("hold", "hold_time"): "shared_errors_hold_times",
    ("hold", "prony_term"): "shared_errors_prony",
    ("held_pair",): "shared_errors_static_stiffness",
    ("interval",): "shared_errors_stepwise",
    ("step",): "shared_errors_weights",
    ("slip",): "shared_errors_slips",
    ("elastomer_parameter",): "shared_errors_elastomer",
    ("comparison", "branch_name", "ratio_strain_bin"): "shared_errors_ratios",
}
# whose they are, where a row of the table itself would not say
_OF = {
    ("hold",): ("specimen=hold_specimen", "hold_number"),
    ("hold", "hold_time"): ("specimen=hold_specimen", "hold_number"),
    ("hold", "prony_term"): ("specimen=hold_specimen", "hold_number"),
    ("held_pair",): ("specimen=held_pair_specimen",),
    ("slip",): ("specimen=slip_specimen", "slip_cycle"),
    ("step",): ("clock",),
    ("elastomer_parameter",): ("elastomer_parameter_fit", "elastomer_parameter_name"),
    ("comparison", "branch_name", "ratio_strain_bin"): ("ratio_numerator", "ratio_denominator"),
}


def _table(name: str, dims: tuple[str, ...]) -> Table:
    rows = tuple(
        f"{quantity}_uncertainty_contribution"
        for quantity, own in (SHARED | SHARED_OF_STEPS).items()
        if own == dims
    )
    return Table(
        name, (*dims, COMPONENT), (*_OF.get(dims, ()), *ERROR, *rows), rows,
        product="stepwise test" if "step" in dims else "test",
    )  # fmt: skip


SHARED_TABLES = tuple(_table(name, dims) for dims, name in _FILES.items())

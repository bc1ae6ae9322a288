"""Tables of what was tested and read: specimens, splices, standstills, notes, rows."""

from __future__ import annotations

from reduction.archive.schema import COEFFICIENTS
from reduction.tables.table import Table

RECORD_TABLES = (
    Table(
        "specimens",
        ("specimen",),
        (
            "specimen_kind",
            "specimen_material",
            "specimen_construction",
            "specimen_condition",
            "diameter",
            "area",
            "rated_break_strength",
            "rated_break_strength_source",
            "linear_density",
            "wet_linear_density",
            "declared_gauge_length",
        ),
        ("specimen_kind",),
    ),
    Table(
        "standstills",
        ("standstill", "specimen"),
        (
            "standstill_start_time",
            "standstill_end_time",
            "standstill_position",
            "standstill_tension",
            "standstill_is_rest",
        ),
        ("standstill_start_time",),
    ),
    Table("notes", ("note",), ("note_stage",), ("note",)),
    Table(
        "rows",
        ("channel", "quality_mask"),
        ("n_rows_read", "n_rows_kept", "n_rows_stored", "n_flagged"),
        ("n_flagged",),
    ),
)

SPLICE_TABLES = (
    Table(
        "splice",
        ("mark",),
        (
            "specimen=mark_specimen",
            "mark_test",
            "mark_hold",
            "mark_position",
            "mark_strain",
            "mark_tension",
            "mark_strain_residual",
        ),
        ("mark_test",),
    ),
    Table(
        "splice_coefficients",
        ("specimen",),
        (
            "strain_method",
            "strain_marks_from",
            "strain_position_low",
            "strain_position_high",
            "strain_tension_low",
            "strain_tension_high",
            "strain_slope_ratio",
            *COEFFICIENTS.values(),
        ),
        ("strain_method",),
    ),
)

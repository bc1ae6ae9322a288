"""Table of the change-in-length properties: one row a property, pair of tensions and specimen.

A property without a number has a row, too, with the reason.
"""

from __future__ import annotations

from reduction.tables.table import Table

__all__ = ["PROPERTY_TABLES"]

PROPERTY_TABLES = (
    Table(
        "change_in_length",
        ("property",),
        (
            "specimen=property_specimen",
            "property_name",
            "property_test",
            "property_low_tension",
            "property_high_tension",
            "property_reference_time",
            "property_stiffness",
            "property_stiffness_over_strength",
            "property_strain",
            "property_remark",
        ),
        ("property",),
        product="properties",
    ),
)

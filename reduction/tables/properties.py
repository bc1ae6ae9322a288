"""Table of the change-in-length properties: one row a property, pair of tensions and specimen.

A property without a number has a row, too, with the reason.
"""

from __future__ import annotations

from reduction.archive.shared import COMPONENT
from reduction.tables.shared import ERROR
from reduction.tables.table import Table

_CONTRIBUTIONS = tuple(
    f"property_{name}_uncertainty_contribution"
    for name in ("stiffness", "stiffness_over_strength", "strain")
)

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
    Table(
        "shared_errors_change_in_length",
        ("property", COMPONENT),
        (
            "specimen=property_specimen",
            "property_name",
            "property_test",
            *ERROR,
            *_CONTRIBUTIONS,
        ),
        _CONTRIBUTIONS,
        product="properties",
    ),
)

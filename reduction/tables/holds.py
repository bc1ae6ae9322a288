"""Tables of the holds of a test: relaxation and creep, their times, their Prony terms."""

from __future__ import annotations

from reduction.tables.table import Table

HOLD_TABLES = (
    Table(
        "relaxation",
        ("hold",),
        (
            "specimen=hold_specimen",
            "hold_number",
            "hold_kind",
            "hold_start_time",
            "hold_duration",
            "hold_ramp_centre_time",
            "hold_strain",
            "hold_initial_tension",
            "hold_final_tension",
            "relaxation_drop",
            "relaxation_rate_per_decade",
            "creep_rate_per_decade",
            "long_time_tension",
            "hold_criterion",
            "hold_refusal",
        ),
        ("hold",),
    ),
    Table(
        "relaxation_times",
        ("hold", "hold_time"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "tension_at_time", "strain_at_time"),
        ("tension_at_time", "strain_at_time"),
    ),
    Table(
        "prony",
        ("hold", "prony_term"),
        ("specimen=hold_specimen", "hold_number", "hold_kind", "prony_tension", "prony_time"),
        ("prony_tension",),
    ),
)

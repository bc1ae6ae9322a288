"""Tables of what went on in a test: lag, slips, trends, history, and what has to agree."""

from __future__ import annotations

from reduction.tables.derived import cycle_count
from reduction.tables.table import Table

_IDENTITY = ("stroke_mean_modulus_difference", "tension_loss_modulus", "identity_residual")
_TREND = ("peak_tension_per_decade", "dynamic_modulus_per_decade", "peak_tension_change")

CHANGE_TABLES = (
    Table(
        "channel_lag",
        ("specimen",),
        ("channel_lag", "channel_lag_turns", "channel_lag_refusal"),
        ("channel_lag_refusal",),
    ),
    Table(
        "slips",
        ("slip",),
        (
            "specimen=slip_specimen",
            "slip_cycle",
            "slip_cycle_low",
            "slip_cycle_high",
            "slip_tension_step",
            "slip_length",
        ),
        ("slip_cycle",),
    ),
    Table("identity", ("specimen", "cycle"), _IDENTITY, _IDENTITY),
    Table(
        "mean_identity",
        ("specimen",),
        ("mean_identity_residual", "n_cycles"),
        ("mean_identity_residual",),
        cycle_count,
    ),
    Table(
        "history",
        ("specimen",),
        (
            "earlier_tests",
            "earlier_maximum_strain",
            "earlier_maximum_tension",
            "earlier_cycles",
            "earlier_flex_cycles",
            "permanent_set",
        ),
        ("earlier_tests",),
    ),
    Table(
        "trend",
        ("specimen",),
        (*_TREND, "n_slips", "creep_per_cycle"),
        (*_TREND, "n_slips"),
    ),
)

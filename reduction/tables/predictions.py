"""Which tables of predicted hoses there are."""

from __future__ import annotations

from reduction.tables.table import Table


def _table(
    name: str, dims: tuple[str, ...], variables: tuple[str, ...], needs: tuple[str, ...]
) -> Table:
    return Table(name, dims, variables, needs, product="predictions")


PREDICTION_TABLES = (
    _table(
        "predictions",
        ("hose", "hose_point"),
        (
            "strain",
            "free_strain",
            "tension",
            "fill_pressure",
            "cord_tension",
            "cord_strain",
            "cord_share",
            "rubber_share",
            "end_cap_load",
            "current_wrap_angle",
            "cord_spacing",
            "current_inner_diameter",
            "hose_state",
        ),
        ("strain",),
    ),
    _table(
        "hose_events",
        ("hose", "hose_event"),
        (
            "event_strain",
            "event_tension",
            "event_fill_pressure",
            "event_cord_tension",
            "event_cord_strain",
        ),
        ("event_strain",),
    ),
    _table(
        "hoses",
        ("hose",),
        (
            "wrap_angle",
            "inner_diameter",
            "outer_diameter",
            "cords_per_length",
            "cord_diameter",
            "rubber_modulus",
            "rubber_law",
            "working_share",
            "cord_load_scale",
            "cord_strain_scale",
            "dead_length_share",
            "minimum_inner_diameter",
            "number_of_cords",
        ),
        ("wrap_angle",),
    ),
    _table(
        "cord_layers",
        ("hose", "cord_layer"),
        ("layer_diameter", "ribbon_width"),
        ("layer_diameter",),
    ),
    _table(
        "hose_layers",
        ("hose", "hose_layer"),
        (
            "hose_layer_name",
            "hose_layer_wrap_angle",
            "hose_layer_strain_limit",
            "hose_layer_compression_limit",
            "hose_layer_least_strain",
            "hose_layer_greatest_strain",
            "hose_layer_break_strain",
            "hose_layer_least_angle",
            "hose_layer_greatest_angle",
        ),
        ("hose_layer_wrap_angle",),
    ),
)

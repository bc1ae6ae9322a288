"""Tables of the cycles of a test and of its curves of tension over strain."""

from __future__ import annotations

from reduction.archive.schema import SCHEMA
from reduction.archive.variable import SUFFIXES
from reduction.tables.derived import chords_of_branches, cycle_count, edges_of_bins
from reduction.tables.table import Table
from reduction.vocabulary import BRANCH_NAMES

_PER_CYCLE = tuple(
    name
    for name, row in SCHEMA.items()
    if row.dims == ("specimen", "cycle") and not name.endswith(tuple(SUFFIXES))
)

CURVE_TABLES = (
    Table(
        "moduli",
        ("specimen", "branch_name", "segment"),
        (
            "segment_tension_low",
            "segment_tension_high",
            "segment_strain_low",
            "segment_strain_high",
            "segment_modulus",
            "segment_misfit",
            "n_cycles",
            "strain_method",
            "segment_criterion",
        ),
        ("segment_modulus",),
        cycle_count,
    ),
    Table(
        "cycles",
        ("specimen", "cycle"),
        (*_PER_CYCLE, *(f"chord_modulus_{branch}" for branch in BRANCH_NAMES)),
        _PER_CYCLE,
        chords_of_branches,
    ),
    Table(
        "tangent_modulus",
        ("specimen", "branch_name", "strain_bin"),
        (
            "strain_bin_low",
            "strain_bin_high",
            "tangent_modulus",
            "tangent_modulus_count",
            "tangent_modulus_minimum",
            "tangent_modulus_maximum",
            "tangent_modulus_scatter",
            "tangent_modulus_untrimmed",
            "branch_tension",
            "branch_tension_count",
        ),
        ("tangent_modulus", "tangent_modulus_untrimmed"),
        edges_of_bins,
    ),
    Table(
        "first_loading",
        ("specimen", "branch_name", "first_loading_strain_bin"),
        ("tangent_modulus_first_loading", "branch_tension_first_loading"),
        ("tangent_modulus_first_loading",),
    ),
)

"""Tables of the means of a test, of its three-parameter line and of its slow pull."""

from __future__ import annotations

from reduction.archive.schema import SCHEMA
from reduction.archive.variable import SUFFIXES
from reduction.tables.table import Table

_LINE = (
    "test_quasi_static_spring_constant",
    "test_dissipation_spring_constant",
    "test_relaxation_time",
    "test_dashpot_coefficient",
    "test_line_conditioning",
    "test_line_refusal",
    "test_line_uncertainty_method",
    "test_line_without_solution_share",
    *(
        f"test_{name}_{end}"
        for name in ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
        for end in ("low", "high")
    ),
)
_AMPLITUDE = tuple(
    name
    for name in SCHEMA
    if name.startswith("test_") and name not in _LINE and not name.endswith(tuple(SUFFIXES))
)
_PULL = (
    "pull_tension_low",
    "pull_tension_high",
    "pull_strain_rate",
    "pull_waiting_time",
    "pull_waiting",
    "pull_residual",
    "pull_reference_tension",
)

LINE_TABLES = (
    Table("amplitude", ("specimen",), _AMPLITUDE, _AMPLITUDE),
    Table(
        "line",
        ("specimen",),
        ("test_frequency", "test_mean_tension", "test_tension_amplitude", *_LINE),
        ("test_line_refusal",),
    ),
    Table(
        "slow_pull",
        ("specimen", "tension_grid"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
        ("quasi_static_spring_constant", "quasi_static_strain"),
    ),
    Table(
        "slow_pull_cubic",
        ("specimen", "pull_term"),
        ("pull_strain_coefficient", "pull_spring_constant_coefficient", *_PULL),
        ("pull_strain_coefficient",),
    ),
    Table(
        "strain_at_break_share",
        ("specimen", "break_share"),
        ("strain_at_break_share",),
        ("strain_at_break_share",),
    ),
)

"""Columns of a catalogue: what is known of a test, and what a number is."""

from __future__ import annotations

from typing import Any, Final

import pyarrow  # type: ignore[import-untyped]

from reduction.vocabulary import QUANTITIES

TEXTS: Final = (
    "campaign", "test", "specimen", "test_kind", "medium", "control", "waveform",
    "specimen_kind", "specimen_material", "specimen_construction", "specimen_condition",
    "synthetic", "archive",
)  # fmt: skip
"""What is said of a test in words."""

NUMBERS: Final = (
    "n_cycles", "test_frequency", "test_mean_tension", "test_tension_amplitude",
    "test_mean_strain", "test_strain_amplitude", "least_strain", "greatest_strain", "diameter",
    "rated_break_strength",
)  # fmt: skip
"""What is said of a test in numbers, SI."""

CONDITIONS: Final = (*TEXTS[:-2], *NUMBERS, *TEXTS[-2:])
"""Columns of a table of tests, in order."""

NUMBER: Final = ("quantity", "value", "standard_uncertainty")
"""Columns of a number; a row of a test has none."""

LEFT_OUT: Final = frozenset(
    {"sample", "selected_cycle", "bound", "uncertainty_component", "uncertainty_source"}
)
"""Dimensions that stay in the archives: samples, curves by cycle, parts of uncertainties."""


def column_type(name: str) -> Any:
    """Arrow type of a column by its row in the vocabulary: text where it has no unit."""
    if name == "quantity":
        return pyarrow.string()
    row = QUANTITIES.get(name)
    return pyarrow.float64() if row is None or row.unit else pyarrow.string()


def standing_for(name: str) -> str:
    """Name of the mean over a test, where a quantity of the cycles has one.

    Examples
    --------
    >>> [standing_for(name) for name in ("frequency", "peak_tension", "mean_tension")]
    ['test_frequency', 'peak_tension', 'test_mean_tension']
    """
    return f"test_{name}" if f"test_{name}" in QUANTITIES else name

"""Runs as the forms of dynamic stiffness take them: levels checked, loads over break strength."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError, SettingsError
from reduction.record import Floats

LoadAmplitude = Literal["half-range", "full-range"]


def checked_strength(rated_break_strength: float | None) -> float:
    """Return the break strength, or raise where there is none."""
    if rated_break_strength is None:
        raise SettingsError(
            "stiffness over break strength has no break strength",
            needed="the rated break strength of the line",
            hint="Give rated_break_strength of the specimen.",
        )
    if not rated_break_strength > 0 or not np.isfinite(rated_break_strength):
        raise SettingsError(
            "the rated break strength cannot be",
            found=f"{rated_break_strength:g}",
            needed="a finite number above zero",
        )
    return float(rated_break_strength)


def _above_zero(name: str, values: Floats) -> None:
    bad = np.flatnonzero(values <= 0)
    if bad.size:
        raise DataError(
            f"{bad.size} of {values.size} values of {name} are not above zero, "
            f"first at index {int(bad[0])}",
            found=f"{values[bad[0]]:g}",
            needed="levels above zero, or NaN where the run is missing",
        )


def del_vecchio_matrix(
    mean: Floats, amplitude: Floats, frequency: Floats, strength: float, kind: LoadAmplitude
) -> Floats:
    """Columns of a, b, c, d: per cent of break strength, seconds."""
    if kind not in ("half-range", "full-range"):
        raise SettingsError(
            "the load amplitude is one of two things",
            found=kind,
            needed="half-range or full-range",
        )
    wide = 2.0 if kind == "full-range" else 1.0
    percent = 100 / strength
    # -log10(period) is log10(frequency); its sign and that of c are those of the equation
    columns = [np.ones_like(mean), percent * mean, -wide * percent * amplitude, np.log10(frequency)]
    matrix: Floats = np.column_stack(columns)
    return matrix


def positive_levels(**named: ArrayLike) -> tuple[Floats, ...]:
    """Return levels as series of runs, none of them zero or less."""
    arrays = as_same_shape(**named)
    if arrays[0].ndim != 1:
        raise DataError(
            "the levels are not a series of runs", found=f"shape {arrays[0].shape}", needed="1-D"
        )
    for name, values in zip(named, arrays, strict=True):
        _above_zero(name, values)
    return arrays


def relative_stiffness(
    spring_constant: ArrayLike, strength: float, n_runs: int
) -> tuple[Floats, tuple[int, ...]]:
    """Stiffness over break strength as (n_responses, n_runs), and the shape before the runs."""
    stiffness = np.asarray(spring_constant, dtype=np.float64)
    if stiffness.ndim == 0 or stiffness.shape[-1] != n_runs:
        raise DataError(
            "the spring constants do not fit the runs",
            found=f"shape {stiffness.shape}",
            needed=f"{n_runs} runs on the last axis",
        )
    return stiffness.reshape(-1, n_runs) / strength, stiffness.shape[:-1]

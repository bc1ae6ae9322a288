"""What has to be right with the runs of an experiment before a surface is fitted to them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.record import Floats
from reduction.surface.coding import coded_from_engineering

_STILL = 1e-6
"""Coded range below which a factor does not move."""


def coded_levels(
    levels: ArrayLike,
    *,
    low: ArrayLike,
    high: ArrayLike,
    units: Literal["engineering", "coded"],
    factor_names: Sequence[str],
) -> Floats:
    """Levels as achieved, coded, shape (n_runs, n_factors); NaN rows are runs not done. [1]."""
    found = np.array(levels, dtype=np.float64)
    if found.ndim != 2 or found.shape[1] != len(factor_names) or np.shape(low) != found.shape[1:]:
        raise SettingsError(
            "the levels do not pair up with the factors",
            found=f"levels {found.shape}, {len(factor_names)} names, low {np.shape(low)}",
            needed="one column, one name, one low and one high level a factor",
        )
    if np.isinf(found).any():
        raise DataError(
            "a level is infinite",
            found=f"run {int(np.flatnonzero(np.isinf(found).any(axis=1))[0]) + 1}",
            needed="numbers, or NaN for a run that was not done",
        )
    in_coded = coded_from_engineering(found, low=low, high=high)
    return found if units == "coded" else in_coded


def require_names(names: tuple[str, ...], count: int, what: str) -> None:
    """Refuse names that do not pair up, or a name that stands twice."""
    if len(set(names)) < len(names):
        twice = sorted(name for name, count_of in Counter(names).items() if count_of > 1)
        raise SettingsError(
            f"a {what} is named twice",
            found=", ".join(twice),
            needed=f"a name of its own for every {what}",
            hint=f"A {what} entered twice is to be left out once.",
        )
    if len(names) != count:
        raise SettingsError(
            f"the names of the {what}s do not pair up with the {what}s",
            found=f"{len(names)} names",
            needed=f"{count}",
        )


def require_motion(coded: Floats, factor_names: Sequence[str]) -> None:
    """Refuse runs in which a factor keeps its level."""
    if len(coded) == 0:
        raise DataError("no run has a value", needed="runs with levels and responses")
    still = np.flatnonzero(np.ptp(coded, axis=0) < _STILL)
    if still.size:
        first = int(still[0])
        raise DataError(
            f"{factor_names[first]} never moves",
            found=f"{coded[0, first]:g} (coded) in all {len(coded)} runs",
            needed="at least three levels",
            hint="Leave the factor out, or add the runs that move it.",
        )

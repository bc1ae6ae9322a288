"""Strength against exposure by line, and life against peak load by group, each with its fit.

References
----------
.. [1] CG-D-39-80, Figures 15 and 19.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from reduction.errors import FitError
from reduction.outcomes.exposure import fit_exposure_trend
from reduction.outcomes.fatigue import fit_load_life
from reduction.outcomes.groups import Group, group_outcomes
from reduction.outcomes.life_product import LifeDistribution, LoadLife
from reduction.outcomes.product import ExposureTrend, Outcome
from reduction.outcomes.strength import EXCLUDED, VALUE
from reduction.record import Bools, Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class ExposureSeries:
    """Breaks of one line by time in the field.

    Parameters
    ----------
    group : Group
        The line; without a condition and an exposure, which differ.
    exposure : ndarray, shape (n,)
        Of each break. [year]
    strength : ndarray, shape (n,)
        Of each break. [N]
    is_lower_bound : ndarray of bool, shape (n,)
        True where the line holds at least this; not in the fit.
    n_unused : int
        Tests of the line without an exposure or a value.
    fit : ExposureTrend or None
        None where there is no line.
    reason : str
        Why; empty where there is one.
    """

    group: Group
    exposure: Floats
    strength: Floats
    is_lower_bound: Bools
    n_unused: int
    fit: ExposureTrend | None = None
    reason: str = ""


@dataclass(frozen=True)
@read_only_arrays
class LoadSeries:
    """Cycle tests of one group by peak load.

    Parameters
    ----------
    group : Group
        The line in its condition.
    peak_load_ratio, minimum_load_ratio : ndarray, shape (n,)
        Over the rated break strength; the least NaN where not stated. [1]
    cycles : ndarray, shape (n,)
        To failure, or to the end of the test. [1]
    is_suspended : ndarray of bool, shape (n,)
        True where the line lasts at least this.
    n_unused : int
        Tests of the group without a peak load ratio, and invalid ones.
    fit : LoadLife or None
        None where there is no line.
    reason : str
        Why; empty where there is one.
    """

    group: Group
    peak_load_ratio: Floats
    minimum_load_ratio: Floats
    cycles: Floats
    is_suspended: Bools
    n_unused: int
    fit: LoadLife | None = None
    reason: str = ""


def exposure_series(outcomes: Iterable[Outcome]) -> tuple[ExposureSeries, ...]:
    """Strength of each line that was broken after some time in the field.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity.

    Returns
    -------
    series : tuple of ExposureSeries
        In order of appearance; lines of one exposure alone are left out.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> breaks = {0.0: [6400, 6600], 2.0: [5200, 5400], 4.0: [4000, 4200]}
    >>> series, = exposure_series([Outcome("tensile_strength", strength, exposure=years)
    ...     for years, values in breaks.items() for strength in values])
    >>> print(round(series.fit.intercept), round(series.fit.slope))
    6500 -600
    """
    lines: dict[Group, list[Outcome]] = {}
    for row in outcomes:
        if row.quantity == "tensile_strength":
            grouped = group_outcomes([row], "tensile_strength")
            line = replace(grouped.groups[0], condition="", exposure=None)
            lines.setdefault(line, []).append(row)
    found = []
    for line, rows in lines.items():
        used = [row for row in rows if row.use != "excluded" and not np.isnan(row.exposure)]
        exposure = np.array([row.exposure for row in used])
        if np.unique(exposure).size < 2:
            continue
        strength = np.array([row.value for row in used])
        is_bound = np.array([row.use == "lower_bound" for row in used])
        fit, reason = None, ""
        try:
            fit = fit_exposure_trend(exposure[~is_bound], strength[~is_bound])
        except FitError as error:
            reason = error.problem
        n_unused = len(rows) - len(used)
        found.append(ExposureSeries(line, exposure, strength, is_bound, n_unused, fit, reason))
    return tuple(found)


def load_series(
    outcomes: Iterable[Outcome], *, distribution: LifeDistribution = "lognormal"
) -> tuple[LoadSeries, ...]:
    """Cycles to failure of each group that was tested at a peak load.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity.
    distribution : str
        Law of the lives: ``lognormal`` or ``weibull``.

    Returns
    -------
    series : tuple of LoadSeries
        In order of appearance; groups without a peak load ratio are left out.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> cycles = {0.4: [2.2e5, 2.7e5], 0.5: [5.8e4, 7.1e4], 0.7: [7.6e3, 9.4e3]}
    >>> series, = load_series([Outcome("cycles_to_failure", life, peak_load_ratio=load)
    ...     for load, lives in cycles.items() for life in lives])
    >>> print(round(series.fit.exponent, 1), series.n_unused)
    6.0 0
    """
    grouped = group_outcomes(outcomes, "cycles_to_failure")
    peak = np.array([row.peak_load_ratio for row in grouped.outcomes])
    least = np.array([row.minimum_load_ratio for row in grouped.outcomes])
    usable = ~np.isnan(peak) & (grouped.use != EXCLUDED)
    found = []
    for place, group in enumerate(grouped.groups):
        here = usable & (grouped.group == place)
        if not here.any():
            continue
        suspended = grouped.use[here] != VALUE
        fit, reason = None, ""
        try:
            fit = fit_load_life(
                peak[here], grouped.value[here], suspended, distribution=distribution
            )
        except FitError as error:
            reason = error.problem
        found.append(
            LoadSeries(
                group, peak[here], least[here], grouped.value[here], suspended,
                int(((grouped.group == place) & ~usable).sum()), fit, reason,
            )
        )  # fmt: skip
    return tuple(found)

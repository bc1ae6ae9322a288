"""Rows of the tables of fatigue and of life against load, in SI.

References
----------
.. [1] CG-D-39-80, Table 20 and Figure 19.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import exp, isfinite, nan

import numpy as np

from reduction.outcomes.columns import FATIGUE_COLUMNS, LOAD_LIFE_COLUMNS
from reduction.outcomes.fatigue import load_levels
from reduction.outcomes.groups import Grouped, group_outcomes
from reduction.outcomes.life import fit_life
from reduction.outcomes.life_product import LifeDistribution
from reduction.outcomes.product import REASONS, Outcome, OutcomeQuantity
from reduction.outcomes.row import Row, empty_row, labels_of
from reduction.outcomes.series import load_series
from reduction.outcomes.strength import EXCLUDED, VALUE, group_statistics
from reduction.record import Integers


def _levels_of(grouped: Grouped, place: int) -> list[Integers]:
    """Rows of a group by level of peak load, rising; those without a load last."""
    rows = np.flatnonzero(grouped.group == place)
    ratio = np.array([grouped.outcomes[row].peak_load_ratio for row in rows])
    force = np.array([grouped.outcomes[row].peak_load for row in rows])
    has_ratio = ~np.isnan(ratio)
    has_force = ~np.isnan(force) & ~has_ratio
    parts = []
    for has, load in ((has_ratio, ratio), (has_force, force / np.nanmax(force, initial=0.0))):
        if has.any():
            level = load_levels(load[has])
            parts += [rows[has][level == number] for number in range(int(level.max()) + 1)]
    rest = rows[~has_ratio & ~has_force]
    return [*parts, rest] if rest.size else parts


def fatigue_rows(
    outcomes: Iterable[Outcome], *, distribution: LifeDistribution = "weibull"
) -> list[Row]:
    """Rows of the table of cycles to failure and of abrasion, one a group and level of load.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity.
    distribution : str
        Law of the lives: ``weibull`` or ``lognormal``.

    Returns
    -------
    rows : list of dict
        By the names of `FATIGUE_COLUMNS`, by quantity and group, peak load rising.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> rows = fatigue_rows([Outcome("abrasion_cycles", cycles) for cycles in (7e3, 8e3, 9e3)])
    >>> print(rows[0]["failed_count"], rows[0]["mean_cycles"])
    3 8000.0
    """
    listed = tuple(outcomes)
    quantities: tuple[OutcomeQuantity, ...] = ("cycles_to_failure", "abrasion_cycles")
    table: list[Row] = []
    for quantity in quantities:
        grouped = group_outcomes(listed, quantity)
        for place, group in enumerate(grouped.groups):
            for part in _levels_of(grouped, place):
                row = empty_row(FATIGUE_COLUMNS) | labels_of(group)
                row |= _fatigue_of(grouped, part, distribution)
                row["quantity"] = quantity
                table.append(row)
    return table


def _fatigue_of(grouped: Grouped, part: Integers, distribution: LifeDistribution) -> Row:
    loads = [grouped.outcomes[row] for row in part]
    statistics = group_statistics(
        grouped.value[part], np.zeros(part.size, dtype=np.intp), grouped.use[part], n_groups=1
    )
    row: Row = {
        "peak_load": float(np.mean([one.peak_load for one in loads])),
        "peak_load_ratio": float(np.mean([one.peak_load_ratio for one in loads])),
        "minimum_load_ratio": float(np.mean([one.minimum_load_ratio for one in loads])),
        "failed_count": int(statistics.n[0]),
        "suspended_count": int(statistics.n_lower_bound[0]),
        "excluded_count": int(statistics.n_excluded[0]),
        "mean_cycles": float(statistics.mean[0]),
        "mean_cycles_standard_uncertainty": float(statistics.mean_standard_uncertainty[0]),
        "cycles_standard_deviation": float(statistics.standard_deviation[0]),
        "cycles_relative_variability": float(statistics.relative_variability[0]),
        "life_distribution": distribution,
    }
    used = part[grouped.use[part] != EXCLUDED]
    if not used.size:
        return row | {"life_reason": "no valid test"}
    lives = grouped.value[used]
    fit = fit_life(lives, grouped.use[used] != VALUE, distribution=distribution)
    return row | {
        "least_cycles": float(lives.min()),
        "most_cycles": float(lives.max()),
        "median_life": fit.life,
        "median_life_standard_uncertainty": fit.life_standard_uncertainty,
        "median_life_low": fit.low,
        # a table has no infinity; the reason says that there is a lower bound alone
        "median_life_high": fit.high if isfinite(fit.high) else nan,
        "log_life_scale": fit.log_scale,
        "log_life_scale_standard_uncertainty": fit.log_scale_uncertainty,
        "life_reason": REASONS[fit.reason],
    }


def load_life_rows(
    outcomes: Iterable[Outcome], *, distribution: LifeDistribution = "lognormal"
) -> list[Row]:
    """Rows of the table of life against peak load, one a group tested at two loads or more.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity; a cycle test without a peak load is left out.
    distribution : str
        Law of the lives: ``lognormal`` or ``weibull``.

    Returns
    -------
    rows : list of dict
        By the names of `LOAD_LIFE_COLUMNS`; where no line can be fitted, a reason.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> cycles = {0.4: [2.2e5, 2.7e5], 0.5: [5.8e4, 7.1e4], 0.7: [7.6e3, 9.4e3]}
    >>> rows = load_life_rows([Outcome("cycles_to_failure", life, peak_load_ratio=load)
    ...     for load, lives in cycles.items() for life in lives])
    >>> print(round(rows[0]["life_exponent"], 1))
    6.0
    """
    table: list[Row] = []
    for series in load_series(outcomes, distribution=distribution):
        load = series.peak_load_ratio
        if not load_levels(load).any():
            continue  # one load: its row of the table of fatigue says all
        row = empty_row(LOAD_LIFE_COLUMNS) | labels_of(series.group)
        row |= {
            "failed_count": int((~series.is_suspended).sum()),
            "suspended_count": int(series.is_suspended.sum()),
            "unused_count": series.n_unused,
            "peak_load_ratio_low": float(load.min()),
            "peak_load_ratio_high": float(load.max()),
            "life_distribution": distribution,
            "life_reason": series.reason,
        }
        table.append(row)
        if series.fit is None:
            continue
        fit = series.fit
        spread = np.sqrt(np.diag(fit.covariance))
        life = exp(fit.log_life)
        row |= {
            "reference_load_ratio": fit.reference_load_ratio,
            "life_at_reference": life,
            "life_at_reference_standard_uncertainty": life * float(spread[0]),
            "life_exponent": fit.exponent,
            "life_exponent_standard_uncertainty": float(spread[1]),
            "log_life_scale": fit.log_scale,
            "log_life_scale_standard_uncertainty": float(spread[2]),
            "lack_of_fit_p_value": fit.lack_of_fit_p_value,
        }
    return table

"""Rows of the tables of strength, of fatigue and of life against load, in SI.

References
----------
.. [1] CG-D-39-80, Tables 10, 20 and 21, Figure 19.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import exp, isfinite, nan

import numpy as np

from reduction.errors import FitError
from reduction.outcomes.columns import (
    FATIGUE_COLUMNS,
    LOAD_LIFE_COLUMNS,
    STRENGTH_COLUMNS,
    OutcomeColumn,
)
from reduction.outcomes.compare import one_way, ratio_of_means
from reduction.outcomes.fatigue import fit_load_life, load_levels
from reduction.outcomes.groups import Group, Grouped, group_outcomes, reference_of
from reduction.outcomes.life import fit_life
from reduction.outcomes.life_product import LifeDistribution
from reduction.outcomes.product import REASONS, Outcome, OutcomeQuantity
from reduction.outcomes.strength import EXCLUDED, VALUE, censored_mean, group_statistics
from reduction.record import Integers

__all__ = ["Row", "fatigue_rows", "load_life_rows", "strength_rows"]

Row = dict[str, float | int | str]


def _empty(columns: Iterable[OutcomeColumn]) -> Row:
    return {
        column.name: "" if column.unit == "" else 0 if column.unit == "count" else nan
        for column in columns
    }


def _labels(group: Group) -> Row:
    return {
        "line": group.line,
        "material": group.material,
        "construction": group.construction,
        "diameter": nan if group.diameter is None else group.diameter,
        "condition": group.condition,
        "exposure": nan if group.exposure is None else group.exposure,
    }


def _strength_of(grouped: Grouped, reference_condition: str) -> dict[Group, Row]:
    """Numbers of one quantity by group, without the name of the quantity."""
    n_groups = len(grouped.groups)
    statistics = group_statistics(grouped.value, grouped.group, grouped.use, n_groups=n_groups)
    reference = reference_of(grouped.groups, reference_condition=reference_condition)
    rows: dict[Group, Row] = {}
    for place, group in enumerate(grouped.groups):
        mean, deviation = statistics.mean[place], statistics.standard_deviation[place]
        row: Row = {
            "": float(mean),
            "_standard_uncertainty": float(statistics.mean_standard_uncertainty[place]),
            "_standard_deviation": float(deviation),
            "_relative_variability": float(statistics.relative_variability[place]),
            "_minimum": float(statistics.minimum[place]),
            "_maximum": float(statistics.maximum[place]),
            "_count": int(statistics.n[place]),
            "_lower_bound_count": int(statistics.n_lower_bound[place]),
            "_excluded_count": int(statistics.n_excluded[place]),
            "_lower_bound_mean": float(statistics.lower_bound_mean[place]),
        }
        reasons = [REASONS[int(statistics.reason[place])]]
        if statistics.n_lower_bound[place]:
            here = (grouped.group == place) & (grouped.use != EXCLUDED)
            censored = censored_mean(grouped.value[here], grouped.use[here] != VALUE)
            row["_with_lower_bounds"] = censored.mean
            row["_with_lower_bounds_low"] = censored.low
            row["_with_lower_bounds_high"] = censored.high
        base = reference[place]
        if base >= 0 and statistics.n[place] and statistics.n[base]:
            change = ratio_of_means(
                mean, deviation, statistics.n[place], reference_mean=statistics.mean[base],
                reference_standard_deviation=statistics.standard_deviation[base],
                reference_n=statistics.n[base],
            )  # fmt: skip
            pair = [place, base]
            test = one_way(
                statistics.mean[pair], statistics.standard_deviation[pair], statistics.n[pair]
            )
            row["_change"] = float(change.change)
            row["_change_standard_uncertainty"] = float(change.standard_uncertainty)
            row["_change_low"], row["_change_high"] = float(change.low), float(change.high)
            row["_f_statistic"], row["_p_value"] = float(test.f_statistic), float(test.p_value)
            reasons.append(REASONS[int(change.reason)])
        row["_reason"] = "; ".join(reason for reason in reasons if reason)
        rows[group] = row
    return rows


def strength_rows(outcomes: Iterable[Outcome], *, reference_condition: str = "new") -> list[Row]:
    """Rows of the table of strength and strain at failure, one a group.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity.
    reference_condition : str
        Condition of the group against which others of the same line are held.

    Returns
    -------
    rows : list of dict
        By the names of `STRENGTH_COLUMNS`, in order of appearance.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> rows = strength_rows([Outcome("tensile_strength", value, condition=word)
    ...     for value, word in [(28e3, "new"), (29e3, "new"), (14e3, "worn"), (15e3, "worn")]])
    >>> print(rows[1]["condition"], round(rows[1]["tensile_strength_change"], 3))
    worn -0.491
    """
    listed = tuple(outcomes)
    quantities: tuple[OutcomeQuantity, ...] = ("tensile_strength", "strain_at_failure")
    rows: dict[Group, Row] = {}
    for quantity in quantities:
        grouped = group_outcomes(listed, quantity)
        for group, numbers in _strength_of(grouped, reference_condition).items():
            row = rows.setdefault(group, _empty(STRENGTH_COLUMNS) | _labels(group))
            row["reference_condition"] = reference_condition
            row.update({quantity + name: number for name, number in numbers.items()})
    return list(rows.values())


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
                row = _empty(FATIGUE_COLUMNS) | _labels(group)
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
    grouped = group_outcomes(outcomes, "cycles_to_failure")
    load = np.array([row.peak_load_ratio for row in grouped.outcomes])
    usable = ~np.isnan(load) & (grouped.use != EXCLUDED)
    table: list[Row] = []
    for place, group in enumerate(grouped.groups):
        here = usable & (grouped.group == place)
        if not here.any() or not load_levels(load[here]).any():
            continue  # one load: its row of the table of fatigue says all
        suspended = grouped.use[here] != VALUE
        row = _empty(LOAD_LIFE_COLUMNS) | _labels(group)
        row |= {
            "failed_count": int((~suspended).sum()),
            "suspended_count": int(suspended.sum()),
            "unused_count": int(((grouped.group == place) & ~usable).sum()),
            "peak_load_ratio_low": float(load[here].min()),
            "peak_load_ratio_high": float(load[here].max()),
            "life_distribution": distribution,
        }
        table.append(row)
        try:
            fit = fit_load_life(
                load[here], grouped.value[here], suspended, distribution=distribution
            )
        except FitError as error:
            row["life_reason"] = error.problem
            continue
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

"""Rows of the tables of strength and of strength against exposure, in SI.

References
----------
.. [1] CG-D-39-80, Tables 10 and 21, Figure 15.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from reduction.outcomes.columns import EXPOSURE_COLUMNS, STRENGTH_COLUMNS
from reduction.outcomes.compare import one_way, ratio_of_means
from reduction.outcomes.exposure import share_lost_per_year
from reduction.outcomes.groups import Group, Grouped, group_outcomes, reference_of
from reduction.outcomes.product import REASONS, Outcome, OutcomeQuantity
from reduction.outcomes.row import Row, empty_row, labels_of
from reduction.outcomes.series import exposure_series
from reduction.outcomes.strength import EXCLUDED, VALUE, censored_mean, group_statistics

_OF_LINE = ("line", "material", "construction", "diameter")


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
            row = rows.setdefault(group, empty_row(STRENGTH_COLUMNS) | labels_of(group))
            row["reference_condition"] = reference_condition
            row.update({quantity + name: number for name, number in numbers.items()})
    return list(rows.values())


def exposure_rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Rows of the table of strength against time in the field, one a line.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity; breaks without an exposure are left out and counted.

    Returns
    -------
    rows : list of dict
        By the names of `EXPOSURE_COLUMNS`; where no line can be fitted, a reason.

    Raises
    ------
    DataError
        If a value cannot be.

    Examples
    --------
    >>> breaks = {0.0: [6400, 6600], 2.0: [5200, 5400], 4.0: [4000, 4200]}
    >>> rows = exposure_rows([Outcome("tensile_strength", strength, exposure=years)
    ...     for years, values in breaks.items() for strength in values])
    >>> print(round(rows[0]["share_lost_per_year"], 3))
    0.092
    """
    table: list[Row] = []
    for series in exposure_series(outcomes):
        row = empty_row(EXPOSURE_COLUMNS) | {
            name: label for name, label in labels_of(series.group).items() if name in _OF_LINE
        }
        row |= {
            "break_count": int((~series.is_lower_bound).sum()),
            "lower_bound_count": int(series.is_lower_bound.sum()),
            "unused_count": series.n_unused,
            "exposure_reason": series.reason,
        }
        table.append(row)
        if series.fit is None:
            continue
        fit = series.fit
        spread = np.sqrt(np.diag(fit.covariance))
        row |= {
            "strength_when_new": fit.intercept,
            "strength_when_new_standard_uncertainty": float(spread[0]),
            "strength_slope": fit.slope,
            "strength_slope_standard_uncertainty": float(spread[1]),
            "strength_scatter": fit.residual_standard_deviation,
            "degrees_of_freedom": fit.degrees_of_freedom,
            "lack_of_fit_p_value": fit.lack_of_fit_p_value,
            "exposure_low": fit.exposure_low,
            "exposure_high": fit.exposure_high,
        }
        if fit.intercept > 0:
            share, low, high = share_lost_per_year(fit)
            row |= {
                "share_lost_per_year": share,
                "share_lost_per_year_low": low,
                "share_lost_per_year_high": high,
            }
    return table

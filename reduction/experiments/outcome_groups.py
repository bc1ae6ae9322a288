"""Groups of outcomes, their series over exposure and load, and the rows of their tables.

References
----------
.. [1] CG-D-39-80, Tables 10 and 20: a group is a line (material, construction, diameter) in one
   condition.
.. [2] CG-D-39-80, Figures 15 and 19.
.. [3] CG-D-39-80, Tables 10, 20 and 21, Figure 19.
.. [4] CG-D-39-80, Tables 10 and 20: a row is a line in one condition.
.. [5] CG-D-39-80, Tables 10 and 21, Figure 15.
.. [6] CG-D-39-80, Table 20 and Figure 19.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, isfinite, isnan, log, nan

import numpy as np

from reduction.experiments.life_statistics import (
    fit_life,
    fit_load_life,
    load_levels,
    ratio_of_lives,
)
from reduction.experiments.outcomes import (
    REASONS,
    ExposureTrend,
    LifeDistribution,
    LoadLife,
    Outcome,
    OutcomeQuantity,
)
from reduction.experiments.strength_statistics import (
    EXCLUDED,
    LOWER_BOUND,
    VALUE,
    censored_mean,
    fit_exposure_trend,
    group_statistics,
    one_way,
    ratio_of_means,
    share_lost_per_year,
)
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers, Specimen, read_only_arrays
from reduction.record.notes import Note, note
from reduction.stages.plausible_bands import words_of_ratio

_USE = {"value": VALUE, "lower_bound": LOWER_BOUND, "excluded": EXCLUDED}


@dataclass(frozen=True)
class Group:
    """One line in one condition; ``diameter`` [m] and ``exposure`` [year] are None if not given."""

    line: str
    material: str
    construction: str
    diameter: float | None
    condition: str
    exposure: float | None

    @property
    def product(self) -> tuple[str, str, str, float | None]:
        """Properties that do not change when the line wears."""
        return self.line, self.material, self.construction, self.diameter


@dataclass(frozen=True)
class _Grouped:
    """Rows of one quantity: the groups in order of appearance, and the group of each row."""

    groups: tuple[Group, ...]
    outcomes: tuple[Outcome, ...]
    group: Integers
    value: Floats
    use: Integers


def _group_outcomes(outcomes: Iterable[Outcome], quantity: OutcomeQuantity) -> _Grouped:
    """Rows of one quantity by group.

    Examples
    --------
    >>> words = ("new", "worn", "new")
    >>> rows = [Outcome("tensile_strength", 29e3, condition=word) for word in words]
    >>> grouped = _group_outcomes(rows, "tensile_strength")
    >>> print([group.condition for group in grouped.groups], grouped.group)
    ['new', 'worn'] [0 1 0]
    """
    rows = tuple(row for row in outcomes if row.quantity == quantity)
    for row in rows:
        if row.use != "excluded" and not 0 < row.value < float("inf"):
            raise DataError(
                f"row {row.row} has no {quantity} to be used", found=f"{row.value:g}",
                needed="a value above zero",
            )  # fmt: skip
    keys = [
        Group(
            row.line, row.material, row.construction,
            None if isnan(row.diameter) else row.diameter,
            row.condition,
            None if isnan(row.exposure) else row.exposure,
        )
        for row in rows
    ]  # fmt: skip
    place = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    return _Grouped(
        groups=tuple(place),
        outcomes=rows,
        group=np.array([place[key] for key in keys], dtype=np.intp),
        value=np.array([row.value if row.value > 0 else 1.0 for row in rows]),
        use=np.array([_USE[row.use] for row in rows], dtype=np.intp),
    )


_REFERENCE_CONDITION = "new"


def _reference_of(groups: Sequence[Group]) -> Integers:
    """Reference group of each group: that of the same product in the reference condition.

    Examples
    --------
    >>> line = ("", "nylon", "plaited", None)
    >>> print(_reference_of([Group(*line, "new", None), Group(*line, "5 years", 5.0)]))
    [-1  0]
    """
    places: dict[tuple[str, str, str, float | None], list[int]] = {}
    for number, group in enumerate(groups):
        if group.condition == _REFERENCE_CONDITION:
            places.setdefault(group.product, []).append(number)
    found = [places.get(group.product, []) for group in groups]
    return np.array(
        [
            one[0] if len(one) == 1 and groups[one[0]] != group else -1
            for one, group in zip(found, groups, strict=True)
        ],
        dtype=np.intp,
    )


def _ratio(force: float, ratio: float, strength: float | None) -> tuple[float, float]:
    """A load and its fraction of the break strength, each from the other."""
    if strength is None:
        return force, ratio
    return (
        ratio * strength if isnan(force) else force,
        force / strength if isnan(ratio) else ratio,
    )


def complete_from_specimens(
    outcomes: Iterable[Outcome], specimens: Mapping[str, Specimen]
) -> tuple[Outcome, ...]:
    """Rows completed from the sheets of their specimens; entries of the row itself take precedence.

    Examples
    --------
    >>> sheet = Specimen("N-1", material="nylon", rated_break_strength=25e3)
    >>> row = Outcome("cycles_to_failure", 9e4, specimen="N-1", peak_load=10e3)
    >>> full, = complete_from_specimens([row], {"N-1": sheet})
    >>> print(full.material, full.peak_load_ratio)
    nylon 0.4
    """
    completed = []
    for row in outcomes:
        sheet = specimens.get(row.specimen)
        if sheet is None:
            completed.append(row)
            continue
        words = {
            name: getattr(row, name) or getattr(sheet, name)
            for name in ("material", "construction", "condition")
        }
        has_diameter = not isnan(row.diameter) or not sheet.diameter
        strength = sheet.rated_break_strength
        minimum, minimum_ratio = _ratio(row.minimum_load, row.minimum_load_ratio, strength)
        peak, peak_ratio = _ratio(row.peak_load, row.peak_load_ratio, strength)
        completed.append(
            replace(
                row,
                **words,
                diameter=row.diameter if has_diameter else sheet.mean_diameter,
                minimum_load=minimum,
                minimum_load_ratio=minimum_ratio,
                peak_load=peak,
                peak_load_ratio=peak_ratio,
            )
        )
    return tuple(completed)


@dataclass(frozen=True)
@read_only_arrays
class ExposureSeries:
    """Strengths of one line by time in the field.

    Parameters
    ----------
    group : Group
        The line, without a condition and an exposure, since these differ.
    exposure : ndarray, shape (n,)
        Exposure of each break. [year]
    strength : ndarray, shape (n,)
        Strength at each break. [N]
    is_lower_bound : ndarray of bool, shape (n,)
        True where the line holds at least this; such values are not in the fit.
    n_unused : int
        Tests of the line without an exposure or a value.
    fit : ExposureTrend or None
        None where no line can be fitted.
    reason : str
        The reason for that; empty where there is a fit.
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
        Peak and minimum load over the rated break strength; the minimum NaN if not stated. [1]
    cycles : ndarray, shape (n,)
        Cycles to failure, or to the end of the test. [1]
    is_suspended : ndarray of bool, shape (n,)
        True where the line lasts at least this.
    n_unused : int
        Tests of the group without a peak load ratio, and invalid ones.
    fit : LoadLife or None
        None where no line can be fitted.
    reason : str
        The reason for that; empty where there is a fit.
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
    """Strength of each line that was broken after a time in the field.

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
            grouped = _group_outcomes([row], "tensile_strength")
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


_AT_ONE_LOAD: LifeDistribution = "weibull"

_AT_SEVERAL_LOADS: LifeDistribution = "lognormal"  # least squares on log life, where all failed


def load_series(outcomes: Iterable[Outcome]) -> tuple[LoadSeries, ...]:
    """Cycles to failure of each group that was tested at a peak load.

    Examples
    --------
    >>> cycles = {0.4: [2.2e5, 2.7e5], 0.5: [5.8e4, 7.1e4], 0.7: [7.6e3, 9.4e3]}
    >>> series, = load_series([Outcome("cycles_to_failure", life, peak_load_ratio=load)
    ...     for load, lives in cycles.items() for life in lives])
    >>> print(round(series.fit.exponent, 1), series.n_unused)
    6.0 0
    """
    grouped = _group_outcomes(outcomes, "cycles_to_failure")
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
                peak[here], grouped.value[here], suspended, distribution=_AT_SEVERAL_LOADS
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


@dataclass(frozen=True)
class OutcomeColumn:
    """A column: name, SI unit (empty for text, ``count`` for a whole number), meaning.

    ``no_uncertainty`` gives the reason why it has no column of standard uncertainty; empty where
    it has one.
    """

    name: str
    unit: str
    long_name: str
    no_uncertainty: str = ""


def _measured(name: str, unit: str, long_name: str) -> tuple[OutcomeColumn, OutcomeColumn]:
    return (
        OutcomeColumn(name, unit, long_name),
        OutcomeColumn(
            f"{name}_standard_uncertainty", unit, f"standard uncertainty of {long_name}",
            "is an uncertainty",
        ),
    )  # fmt: skip


_LINE = (
    OutcomeColumn("line", "", "line, in the laboratory's words", "is a label"),
    OutcomeColumn("material", "", "material", "is a label"),
    OutcomeColumn("construction", "", "construction", "is a label"),
    OutcomeColumn("diameter", "m", "nominal diameter", "is stated"),
)

_GROUP = (
    *_LINE,
    OutcomeColumn("condition", "", "condition of the line", "is a label"),
    OutcomeColumn("exposure", "year", "time in the field, in years of 365.25 days", "is stated"),
)


def _of_strength(name: str, unit: str, words: str) -> tuple[OutcomeColumn, ...]:
    return (
        *_measured(name, unit, f"mean {words} of the valid tests"),
        OutcomeColumn(f"{name}_standard_deviation", unit, f"deviation of {words}", "is a scatter"),
        OutcomeColumn(
            f"{name}_relative_variability", "1", f"deviation over mean of {words}", "is a scatter"
        ),
        OutcomeColumn(f"{name}_minimum", unit, f"least {words}", "is an extreme"),
        OutcomeColumn(f"{name}_maximum", unit, f"greatest {words}", "is an extreme"),
        OutcomeColumn(f"{name}_count", "count", f"valid tests of {words}", "is a count"),
        OutcomeColumn(
            f"{name}_lower_bound_count", "count", "tests in which the termination broke first, "
            "or that were stopped", "is a count",
        ),
        OutcomeColumn(f"{name}_excluded_count", "count", "other invalid tests", "is a count"),
        OutcomeColumn(
            f"{name}_lower_bound_mean", unit, f"mean {words} reached in those tests: a lower bound",
            "is a bound",
        ),
        OutcomeColumn(
            f"{name}_with_lower_bounds", unit, f"mean {words}, maximum likelihood with the lower "
            "bounds as such", "has an interval",
        ),
        OutcomeColumn(f"{name}_with_lower_bounds_low", unit, "lower end, 95 %", "is a bound"),
        OutcomeColumn(f"{name}_with_lower_bounds_high", unit, "upper end, 95 %", "is a bound"),
        *_measured(f"{name}_change", "1", f"change of {words} against the reference"),
        OutcomeColumn(f"{name}_change_low", "1", "lower end of the change, 95 %", "is a bound"),
        OutcomeColumn(f"{name}_change_high", "1", "upper end of the change, 95 %", "is a bound"),
        OutcomeColumn(
            f"{name}_f_statistic", "1", "one-way F against the reference", "is a statistic"
        ),
        OutcomeColumn(f"{name}_p_value", "1", "of that F", "is a statistic"),
        OutcomeColumn(f"{name}_reason", "", "why a number of it is missing", "is a word"),
    )  # fmt: skip


STRENGTH_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_GROUP,
    OutcomeColumn("reference_condition", "", "condition of the reference group", "is a label"),
    *_of_strength("tensile_strength", "N", "tensile strength"),
    *_of_strength("strain_at_failure", "1", "strain at failure"),
)
"""Columns of ``tables/strength.csv``, one row a group."""

EXPOSURE_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_LINE,
    *_measured("strength_when_new", "N", "tensile strength of the fitted line at no exposure"),
    *_measured("strength_slope", "N year-1", "change of tensile strength by time in the field"),
    OutcomeColumn(
        "share_lost_per_year", "year-1", "share of the strength at no exposure lost in a year",
        "has an interval",
    ),
    OutcomeColumn("share_lost_per_year_low", "year-1", "lower end, 95 %", "is a bound"),
    OutcomeColumn("share_lost_per_year_high", "year-1", "upper end, 95 %", "is a bound"),
    OutcomeColumn("strength_scatter", "N", "deviation of one break from the line", "is a scatter"),
    OutcomeColumn("degrees_of_freedom", "count", "of that deviation", "is a count"),
    OutcomeColumn("lack_of_fit_p_value", "1", "a line against means by exposure", "is a statistic"),
    OutcomeColumn("exposure_low", "year", "shortest exposure of the fit", "is a bound"),
    OutcomeColumn("exposure_high", "year", "longest exposure of the fit", "is a bound"),
    OutcomeColumn("break_count", "count", "breaks in the fit", "is a count"),
    OutcomeColumn("lower_bound_count", "count", "lower bounds, not in the fit", "is a count"),
    OutcomeColumn("unused_count", "count", "tests without an exposure or a value", "is a count"),
    OutcomeColumn("exposure_reason", "", "why there is no line", "is a word"),
)  # fmt: skip
"""Columns of ``tables/exposure.csv``, one row a line broken at several exposures."""

FATIGUE_COLUMNS: tuple[OutcomeColumn, ...] = (
    OutcomeColumn("quantity", "", "cycles_to_failure or abrasion_cycles", "is a label"),
    *_GROUP,
    OutcomeColumn("peak_load", "N", "peak load", "is a setting"),
    OutcomeColumn("peak_load_ratio", "1", "peak load over rated break strength", "is a setting"),
    OutcomeColumn("minimum_load_ratio", "1", "minimum load over that", "is a setting"),
    OutcomeColumn("failed_count", "count", "specimens that failed", "is a count"),
    OutcomeColumn(
        "suspended_count", "count", "run-outs, suspended tests and failures of the termination",
        "is a count",
    ),
    OutcomeColumn("excluded_count", "count", "other invalid tests", "is a count"),
    *_measured("mean_cycles", "1", "mean cycles of the failures alone"),
    OutcomeColumn("cycles_standard_deviation", "1", "deviation of those", "is a scatter"),
    OutcomeColumn("cycles_relative_variability", "1", "that over their mean", "is a scatter"),
    OutcomeColumn("least_cycles", "1", "shortest test", "is an extreme"),
    OutcomeColumn("most_cycles", "1", "longest test", "is an extreme"),
    *_measured("median_life", "1", "cycles by which half have failed, run-outs included"),
    OutcomeColumn("median_life_low", "1", "lower end, 95 %, profile likelihood", "is a bound"),
    OutcomeColumn("median_life_high", "1", "upper end, 95 %, profile likelihood", "is a bound"),
    *_measured("log_life_scale", "1", "scatter of ln cycles; one over the shape of a Weibull law"),
    OutcomeColumn("life_distribution", "", "law of the lives", "is a label"),
    OutcomeColumn("life_reason", "", "why there is no median life", "is a word"),
    OutcomeColumn(
        "relative_abrasion_resistance", "1",
        "median life in abrasion over that of new polypropylene of this construction and diameter",
        "has an interval",
    ),
    OutcomeColumn("relative_abrasion_resistance_low", "1", "lower end, 95 %", "is a bound"),
    OutcomeColumn("relative_abrasion_resistance_high", "1", "upper end, 95 %", "is a bound"),
)  # fmt: skip
"""Columns of ``tables/fatigue.csv``, one row a group and level of peak load."""

LOAD_LIFE_COLUMNS: tuple[OutcomeColumn, ...] = (
    *_GROUP,
    OutcomeColumn(
        "reference_load_ratio", "1", "peak load over rated break strength at which the life stands",
        "is a setting",
    ),
    *_measured("life_at_reference", "1", "median life there"),
    *_measured("life_exponent", "1", "m of ln N = a - m ln S"),
    *_measured("log_life_scale", "1", "scatter of ln cycles about the line"),
    OutcomeColumn("lack_of_fit_p_value", "1", "a line against medians by level", "is a statistic"),
    OutcomeColumn("peak_load_ratio_low", "1", "least peak load tested", "is a bound"),
    OutcomeColumn("peak_load_ratio_high", "1", "greatest peak load tested", "is a bound"),
    OutcomeColumn("failed_count", "count", "specimens that failed", "is a count"),
    OutcomeColumn("suspended_count", "count", "run-outs and suspended tests", "is a count"),
    OutcomeColumn(
        "unused_count", "count", "tests without a peak load ratio, and invalid ones", "is a count"
    ),
    OutcomeColumn("life_distribution", "", "law of the lives", "is a label"),
    OutcomeColumn("life_reason", "", "why there is no line", "is a word"),
)  # fmt: skip
"""Columns of ``tables/load_life.csv``, one row a group tested at several loads."""

Row = dict[str, float | int | str]


def _empty_row(columns: Iterable[OutcomeColumn]) -> Row:
    """A row in which all values are still unknown.

    Examples
    --------
    >>> _empty_row([OutcomeColumn("line", "", "line"), OutcomeColumn("load", "N", "load")])
    {'line': '', 'load': nan}
    """
    return {
        column.name: "" if column.unit == "" else 0 if column.unit == "count" else nan
        for column in columns
    }


def _labels_of(group: Group) -> Row:
    """Labels of a group, by column.

    Examples
    --------
    >>> _labels_of(Group("PD", "polyester", "double braid", None, "new", 0.0))["exposure"]
    0.0
    """
    return {
        "line": group.line,
        "material": group.material,
        "construction": group.construction,
        "diameter": nan if group.diameter is None else group.diameter,
        "condition": group.condition,
        "exposure": nan if group.exposure is None else group.exposure,
    }


_OF_LINE = ("line", "material", "construction", "diameter")


def _strength_of(grouped: _Grouped) -> dict[Group, Row]:
    """Numbers of one quantity by group, without the name of the quantity."""
    n_groups = len(grouped.groups)
    statistics = group_statistics(grouped.value, grouped.group, grouped.use, n_groups=n_groups)
    reference = _reference_of(grouped.groups)
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


def strength_rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Rows of the table of strength and strain at failure, one a group.

    By the names of `STRENGTH_COLUMNS`, in order of appearance.

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
        grouped = _group_outcomes(listed, quantity)
        for group, numbers in _strength_of(grouped).items():
            row = rows.setdefault(group, _empty_row(STRENGTH_COLUMNS) | _labels_of(group))
            row["reference_condition"] = _REFERENCE_CONDITION
            row.update({quantity + name: number for name, number in numbers.items()})
    return list(rows.values())


def exposure_rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Rows of the table of strength against time in the field, one a line.

    By the names of `EXPOSURE_COLUMNS`; where no line can be fitted, a reason.

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
        row = _empty_row(EXPOSURE_COLUMNS) | {
            name: label for name, label in _labels_of(series.group).items() if name in _OF_LINE
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


def _levels_of(grouped: _Grouped, place: int) -> list[Integers]:
    """Rows of a group by rising level of peak load; those without a load last."""
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


# factor by which an odd value differs from every other of its group: breaks of one line
# scatter by a tenth, lives at one load by a factor of about three
_ODD: dict[OutcomeQuantity, float] = {
    "tensile_strength": 2.0, "strain_at_failure": 2.5,
    "cycles_to_failure": 80.0, "abrasion_cycles": 80.0,
}  # fmt: skip

_FEWEST_OTHERS = 2


def odd_outcomes(outcomes: Iterable[Outcome]) -> list[Note]:
    """Values that are far from the others of their group and level of load.

    Examples
    --------
    >>> rows = [Outcome("tensile_strength", value) for value in (28e3, 2.9e3, 27e3, 29e3)]
    >>> (found,) = odd_outcomes(rows)
    >>> print(found.code, round(found.numbers["ratio"], 2), found.numbers["like"])
    outcome-far-off 0.1 a factor of 0.1
    """
    listed = tuple(outcomes)
    found = []
    for quantity, most in _ODD.items():
        grouped = _group_outcomes(listed, quantity)
        for place in range(len(grouped.groups)):
            parts = (
                _levels_of(grouped, place)
                if quantity == "cycles_to_failure"
                else [np.flatnonzero(grouped.group == place)]
            )
            for part in parts:
                used = part[grouped.use[part] == VALUE]
                for row in used:
                    others = grouped.value[used[used != row]]
                    if others.size < _FEWEST_OTHERS:
                        continue
                    ratio = float(grouped.value[row] / np.median(others))
                    if np.abs(np.log(grouped.value[row] / others)).min() > log(most):
                        one = grouped.outcomes[row]
                        found.append(
                            note(
                                "outcome-far-off", one.test or one.specimen,
                                quantity=quantity.replace("_", " "), row=one.row, ratio=ratio,
                                n_others=int(others.size), like=words_of_ratio(ratio),
                            )
                        )  # fmt: skip
    return found


def fatigue_rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Rows of the table of cycles to failure and of abrasion, one a group and level of load.

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
        grouped = _group_outcomes(listed, quantity)
        for place, group in enumerate(grouped.groups):
            for part in _levels_of(grouped, place):
                row = _empty_row(FATIGUE_COLUMNS) | _labels_of(group)
                row |= _fatigue_of(grouped, part)
                row["quantity"] = quantity
                if quantity == "abrasion_cycles":
                    row |= _relative_resistance(grouped, place, part)
                table.append(row)
    return table


_REFERENCE_MATERIAL = "polypropylene"


def _relative_resistance(grouped: _Grouped, place: int, part: Integers) -> Row:
    """Ratio of lives to new polypropylene, as in CG-D-39-80, sec. 6.2; empty for itself."""

    def is_reference(group: Group) -> bool:
        own = grouped.groups[place]
        return (
            group.material.casefold() == _REFERENCE_MATERIAL
            and group.condition in ("new", "")
            and (group.construction, group.diameter) == (own.construction, own.diameter)
        )

    beside = [k for k, group in enumerate(grouped.groups) if is_reference(group)]
    rows = np.concatenate([part, np.flatnonzero(np.isin(grouped.group, beside))])
    of_reference = np.arange(rows.size) >= part.size
    use = grouped.use[rows]
    kept, failed = use != EXCLUDED, use == VALUE
    if place in beside or not all((failed & side).any() for side in (of_reference, ~of_reference)):
        return {}
    ratio, low, high = ratio_of_lives(
        grouped.value[rows][kept], ~failed[kept], of_reference[kept], distribution=_AT_ONE_LOAD
    )
    name = "relative_abrasion_resistance"
    return {name: ratio, f"{name}_low": low, f"{name}_high": high if isfinite(high) else nan}


def _fatigue_of(grouped: _Grouped, part: Integers) -> Row:
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
        "life_distribution": _AT_ONE_LOAD,
    }
    used = part[grouped.use[part] != EXCLUDED]
    if not used.size:
        return row | {"life_reason": "no valid test"}
    lives = grouped.value[used]
    fit = fit_life(lives, grouped.use[used] != VALUE, distribution=_AT_ONE_LOAD)
    return row | {
        "least_cycles": float(lives.min()),
        "most_cycles": float(lives.max()),
        "median_life": fit.life,
        "median_life_standard_uncertainty": fit.life_standard_uncertainty,
        "median_life_low": fit.low,
        # a table has no infinity; the reason says that there is only a lower bound
        "median_life_high": fit.high if isfinite(fit.high) else nan,
        "log_life_scale": fit.log_scale,
        "log_life_scale_standard_uncertainty": fit.log_scale_uncertainty,
        "life_reason": REASONS[fit.reason],
    }


def load_life_rows(outcomes: Iterable[Outcome]) -> list[Row]:
    """Rows of the table of life against peak load, one a group tested at two loads or more.

    By the names of `LOAD_LIFE_COLUMNS`; where no line can be fitted, a reason.

    Examples
    --------
    >>> cycles = {0.4: [2.2e5, 2.7e5], 0.5: [5.8e4, 7.1e4], 0.7: [7.6e3, 9.4e3]}
    >>> rows = load_life_rows([Outcome("cycles_to_failure", life, peak_load_ratio=load)
    ...     for load, lives in cycles.items() for life in lives])
    >>> print(round(rows[0]["life_exponent"], 1))
    6.0
    """
    table: list[Row] = []
    for series in load_series(outcomes):
        load = series.peak_load_ratio
        if not load_levels(load).any():
            continue  # one load: its row in the table of fatigue is sufficient
        row = _empty_row(LOAD_LIFE_COLUMNS) | _labels_of(series.group)
        row |= {
            "failed_count": int((~series.is_suspended).sum()),
            "suspended_count": int(series.is_suspended.sum()),
            "unused_count": series.n_unused,
            "peak_load_ratio_low": float(load.min()),
            "peak_load_ratio_high": float(load.max()),
            "life_distribution": _AT_SEVERAL_LOADS,
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

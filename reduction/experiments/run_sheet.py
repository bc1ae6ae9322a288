r"""Run sheets: order, peak loads, warnings and expected precision.

**Smallest effect that a screening will detect, before a line is broken**:

.. math:: E_{min} = t_{1 - \alpha/2;\, m}\, \frac{2 \sigma}{\sqrt{n}}

**Information of the runs of a design about its terms, before any response**:

.. math:: C = (X^T X)^{-1}, \qquad h(x) = x^T C x

**Precision of the surface of an experiment, before a line is broken**:

.. math:: v_t = \left[(X^T X)^{-1}\right]_{tt}, \qquad v(x) = f^T (X^T X)^{-1} f, \qquad
   w = t_{\nu}\, \sigma \sqrt{v}

References
----------
.. [1] CG-D-39-80, sec. 4.3: runs ordered by rising peak load, so that the line is always tested
   at successively higher loads.
.. [2] CG-D-39-80: sec. 4.3 (order of the runs), sec. 3.4 (snap loading is cyclic loading with a
   minimum of zero; nylon failed by it above 30 % of the break strength), App. A (levels chosen
   to keep a minimum tension of 3 %).
.. [5] R. L. Plackett and J. P. Burman, "The design of optimum multifactorial experiments,"
   Biometrika 33(4), 1946.
.. [7] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3.
.. [8] CG-D-39-80, sec. 4.3 and eq. 5: fifteen runs, ten terms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.experiments.designs import (
    Design,
    FactorLevels,
    engineering_levels,
    model_matrix,
    quadratic_exponents,
    term_names,
)
from reduction.experiments.response_matrix import times
from reduction.quantities.digits import fixed_number, places_of
from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import FitError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

RepeatPlacing = Literal["together", "spread"]

SAME_LOAD = 1e-9  # of the greatest peak; levels are entered with three digits


@dataclass(frozen=True)
@read_only_arrays
class RunSheet:
    """Runs in the order in which they are to be made; one row a run.

    Parameters
    ----------
    factors : tuple of FactorLevels, length n_factors
    run : ndarray of int, shape (n_runs,)
        Number of the run in the standard order of the design, from 1.
    coded, engineering : ndarray, shape (n_runs, n_factors)
        Coded levels, and levels in SI. [1], [SI unit of each factor]
    load_block : ndarray of int, shape (n_runs,)
        Runs of equal peak load share a number, from 1 at the lowest; 0 where the peak
        load is not known.
    mean_tension, tension_amplitude, peak_tension, minimum_tension : ndarray, shape (n_runs,)
        NaN where a load is not a factor. [N]
    peak_share, minimum_share : ndarray, shape (n_runs,)
        Peak and minimum over the rated break strength; NaN where that is not given. [1]
    """

    factors: tuple[FactorLevels, ...]
    run: Integers
    coded: Floats
    engineering: Floats
    load_block: Integers
    mean_tension: Floats
    tension_amplitude: Floats
    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return int(self.run.size)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the factors."""
        return tuple(factor.name for factor in self.factors)


def _spread(order: Integers, coded: Floats) -> Integers:
    """Move repeats of a run to later places at even distances, the last to the end.

    They are only moved later: a repeat before its own place would load the line above the runs that
    still follow.
    """
    _, group = np.unique(coded[order], axis=0, return_inverse=True)
    group = group.ravel()
    repeat = np.array([np.sum(group[:place] == group[place]) for place in range(order.size)])
    moved = repeat > 0
    kept = order[~moved]
    # Runs kept before each repeat: those up to its first, and its share of the rest.
    own = (np.cumsum(~moved))[moved]
    rest = kept.size - own
    spread: Integers = np.insert(
        kept,
        own + repeat[moved] * rest // (np.bincount(group)[group[moved]] - 1),
        order[moved],
    )
    return spread


def make_run_sheet(
    design: Design,
    factors: tuple[FactorLevels, ...],
    *,
    rated_break_strength: ArrayLike | None = None,
    repeats: RepeatPlacing = "together",
) -> RunSheet:
    """Run sheet of a design, ordered by rising peak tension.

    Notes
    -----
    Peak is mean plus amplitude, minimum mean less amplitude.  [1]_ gives the order by
    load alone, nine blocks in fifteen runs.  Within a block the lower mean tension comes
    first, then the lower first factor (frequency in [1]_), then the standard order.
    An order by load is confounded with load.

    Examples
    --------
    The peaks of [1]_ for levels of 12 to 30 and 5 to 12 % of the break strength:

    >>> from reduction.experiments.designs import box_behnken
    >>> levels = (
    ...     FactorLevels("frequency", 0.1, 0.5),
    ...     FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength"),
    ...     FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength"),
    ... )
    >>> sheet = make_run_sheet(box_behnken(3), levels, rated_break_strength=28.5e3)
    >>> print((100 * sheet.peak_share).round(1)[[0, 1, 3, 4, 6, 9, 11, 12, 14]])
    [17.  20.5 24.  26.  29.5 33.  35.  38.5 42. ]
    """
    if repeats not in ("together", "spread"):
        raise SettingsError(
            "repeats are placed in one of two ways", found=repeats, needed="together or spread"
        )
    levels = engineering_levels(design.coded, factors, rated_break_strength=rated_break_strength)
    names = [factor.name for factor in factors]
    strength = np.nan if rated_break_strength is None else rated_break_strength
    unknown = np.full(design.n_runs, np.nan)
    mean, amplitude = (
        levels[:, names.index(name)] if name in names else unknown
        for name in ("mean_tension", "tension_amplitude")
    )
    peak, minimum = mean + amplitude, mean - amplitude
    standard: Integers = np.arange(design.n_runs)
    order: Integers
    if np.isnan(peak).any():
        block, order = np.zeros(design.n_runs, dtype=np.int64), standard
    else:
        rising = np.argsort(peak, kind="stable")
        steps = np.diff(peak[rising], prepend=-np.inf) > SAME_LOAD * peak.max()
        block = np.empty(design.n_runs, dtype=np.int64)
        block[rising] = np.cumsum(steps)
        order = np.lexsort((standard, design.coded[:, 0], mean, block))
    if repeats == "spread":
        order = _spread(order, design.coded)
    share = np.broadcast_to(strength, peak.shape)[order]
    return RunSheet(
        factors=factors,
        run=order + 1,
        coded=design.coded[order],
        engineering=levels[order],
        load_block=block[order],
        mean_tension=mean[order],
        tension_amplitude=amplitude[order],
        peak_tension=peak[order],
        minimum_tension=minimum[order],
        peak_share=peak[order] / share,
        minimum_share=minimum[order] / share,
    )


CautionKind = Literal[
    "load-not-known",
    "slack",
    "load-over-limit",
    "share-over-limit",
    "share-not-known",
    "no-repeats",
    "pure-error-excludes-drift",
    "order-confounded",
]

NEAR_ZERO = 1e-9  # of the peak: 12 % less 12 % is zero, but its last bit may not be

MEASURED_SLACK = 0.01  # of the peak, as in reduction.stages.three_parameter_line.line_of_loops

_CONFOUNDED = 0.05
"""Probability that a factor is named for a plan whose order was drawn at random."""


@dataclass(frozen=True)
class Caution:
    """One warning to consider before the runs are made.

    Parameters
    ----------
    kind : str
        A fixed name, for scripts.
    message : str
        Finding, with its numbers.
    hint : str
        Possible remedy.
    runs : tuple of int
        Numbers of the runs concerned, in the order of the sheet; empty for the whole sheet.
    """

    kind: CautionKind
    message: str
    hint: str
    runs: tuple[int, ...] = ()


def _numbers(sheet: RunSheet, chosen: Bools) -> tuple[int, ...]:
    return tuple(int(number) for number in sheet.run[chosen])


def _named(runs: tuple[int, ...], names: Mapping[int, str]) -> str:
    listed = ", ".join(names[run] for run in runs)
    return f"run {listed}" if len(runs) == 1 else f"runs {listed}"


def _slack(sheet: RunSheet, names: Mapping[int, str], *, is_measured: bool) -> list[Caution]:
    share_of_peak = MEASURED_SLACK if is_measured else NEAR_ZERO
    chosen = sheet.minimum_tension <= share_of_peak * sheet.peak_tension
    runs = _numbers(sheet, chosen)
    if not runs:
        return []
    least = float(np.min(sheet.minimum_tension[chosen]))
    in_newtons = fixed_number(least, places_of(least, 2))
    rounding = NEAR_ZERO * float(np.max(sheet.peak_tension))
    if least < -rounding:
        goes = f"falls below zero, to {in_newtons} N"
    elif least <= rounding:
        goes = "reaches zero"
    else:
        goes = f"falls to {in_newtons} N, too little for a load cell to resolve"
    when = "" if is_measured else " in every cycle"
    highest = float(np.max(sheet.peak_share[chosen]))
    share = (
        f"; its peak is {100 * highest:.4g} % of the break strength, and nylon failed by such "
        "cycles above 30 %"
        if np.isfinite(highest)
        else ""
    )
    return [
        Caution(
            "slack",
            f"the minimum tension of {_named(runs, names)} {goes}: the line goes slack{when} "
            f"and snaps taut{share}",
            "Give the amplitude as a fraction of the mean tension, or raise the lowest mean.",
            runs,
        )
    ]


def _over(
    sheet: RunSheet,
    names: Mapping[int, str],
    load_limit: float | None,
    peak_share_limit: float | None,
) -> list[Caution]:
    found = []
    if load_limit is not None:
        runs = _numbers(sheet, sheet.peak_tension > load_limit * (1 + NEAR_ZERO))
        if runs:
            found.append(
                Caution(
                    "load-over-limit",
                    f"the peak tension of {_named(runs, names)} is above the limit of "
                    f"{load_limit:.4g} N, up to {float(np.max(sheet.peak_tension)):.4g} N",
                    "Lower the levels, or take a machine and a cell for the load.",
                    runs,
                )
            )
    if peak_share_limit is not None:
        runs = _numbers(sheet, sheet.peak_share > peak_share_limit * (1 + NEAR_ZERO))
        if runs:
            found.append(
                Caution(
                    "share-over-limit",
                    f"the peak tension of {_named(runs, names)} is above"
                    f" {100 * peak_share_limit:.4g} % of the rated break strength, up to"
                    f" {100 * float(np.max(sheet.peak_share)):.4g} %",
                    "Lower the levels: the line may creep, heat or break in these runs.",
                    runs,
                )
            )
        elif np.isnan(sheet.peak_share).any():
            found.append(
                Caution(
                    "share-not-known",
                    "the peak tension as a share of the break strength is not known",
                    "Give rated_break_strength of the specimen.",
                )
            )
    return found


def _repeats(sheet: RunSheet, names: Mapping[int, str]) -> list[Caution]:
    _, group, count = np.unique(sheet.coded, axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    if count.max() == 1:
        return [
            Caution(
                "no-repeats",
                "no run is repeated: there is no pure error and no test of lack of fit",
                "Add centre runs.",
            )
        ]
    found = []
    for number in np.flatnonzero(count > 1):
        place = np.flatnonzero(group == number)
        if np.all(np.diff(place) == 1):
            runs = _numbers(sheet, group == number)
            found.append(
                Caution(
                    "pure-error-excludes-drift",
                    f"{_named(runs, names)} repeat one run with no other between: their scatter "
                    "does not include changes of the line over the experiment, so the test of lack "
                    "of fit is too strict",
                    "Spread the repeats over the order (repeats = spread).",
                    runs,
                )
            )
    return found


def order_cautions(coded: Floats, order: Floats, names: Sequence[str]) -> list[Caution]:
    """Warn of factors, coded (n_runs, n_factors), that are correlated with the order of the runs.

    Examples
    --------
    >>> coded = np.repeat([-1.0, 0.0, 1.0], 4)[:, None]
    >>> [one.kind for one in order_cautions(coded, np.arange(12.0), ["mean_tension"])]
    ['order-confounded']
    >>> order_cautions(coded, np.tile(np.arange(4.0), 3), ["mean_tension"])
    []
    """
    known = np.isfinite(order) & np.isfinite(coded).all(axis=1)
    n_runs = int(known.sum())
    if not n_runs:
        return []
    place = order[known] - order[known].mean()
    levels = coded[known] - coded[known].mean(axis=0)
    size = np.linalg.norm(levels, axis=0) * np.linalg.norm(place)
    correlation: Floats = np.divide(place @ levels, size, out=np.zeros_like(size), where=size > 0)
    # in a random order the correlation of each factor has nearly Student's distribution
    freedom = max(n_runs - 2, 1)
    limit = scipy.special.stdtrit(freedom, 1 - _CONFOUNDED / (2 * len(names)))
    strong = np.flatnonzero(np.abs(correlation) > limit / np.hypot(limit, np.sqrt(freedom)))
    if not strong.size:
        return []
    listed = ", ".join(f"{names[i]} {correlation[i]:+.2f}" for i in strong.tolist())
    return [
        Caution(
            "order-confounded",
            f"a factor follows the order of the runs (correlation {listed}): wear, heating and "
            "bedding-in over the test look like its effect",
            "Break the line in above the highest peak first, or run a second line in another "
            "order.",
        )
    ]


def find_cautions(
    sheet: RunSheet,
    *,
    load_limit: float | None = None,
    peak_share_limit: float | None = None,
    run_names: Sequence[str] | None = None,
    is_measured: bool = False,
) -> tuple[Caution, ...]:
    """Warnings on a run sheet before the first run.

    Parameters
    ----------
    sheet : RunSheet
        From `make_run_sheet`.
    load_limit : float, optional
        Greatest tension that machine, cell or laboratory allow; None: not checked. [N]
    peak_share_limit : float, optional
        Greatest peak as a fraction of the rated break strength; None: not checked. [1]
    run_names : sequence of str, length n_runs, optional
        Names of the runs in messages; None: their numbers.
    is_measured : bool
        True for measured tensions, where a slack line reads up to 1 % of its peak.

    Returns
    -------
    cautions : tuple of Caution
        Slack runs, loads above a limit, repeats that show no drift, order confounded
        with a factor; empty if there are none.

    Raises
    ------
    SettingsError
        If a limit is not above zero.

    Notes
    -----
    The run with the lowest mean and the highest amplitude reaches zero tension on every
    line of [2]_ (12 less 12, 10 less 10 % of the break strength): the condition that
    [2]_ itself calls snap loading.  The three centre runs of [2]_ are
    consecutive, and the loads of its runs rise with their order.

    Examples
    --------
    >>> from reduction.experiments.designs import box_behnken
    >>> from reduction.experiments.designs import FactorLevels
    >>> from reduction.experiments.run_sheet import make_run_sheet
    >>> levels = (
    ...     FactorLevels("frequency", 0.1, 0.5),
    ...     FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength"),
    ...     FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength"),
    ... )
    >>> sheet = make_run_sheet(box_behnken(3), levels, rated_break_strength=28.5e3)
    >>> [(caution.kind, caution.runs) for caution in find_cautions(sheet)][:2]
    [('slack', (11,)), ('pure-error-excludes-drift', (13, 14, 15))]
    """
    for name, limit in (("load_limit", load_limit), ("peak_share_limit", peak_share_limit)):
        if limit is not None and not limit > 0:
            raise SettingsError(
                f"{name} is not above zero", found=f"{limit:g}", needed="a limit above zero"
            )
    labels = tuple(str(run) for run in sheet.run) if run_names is None else tuple(run_names)
    names = dict(zip(sheet.run.tolist(), labels, strict=True))
    if np.isnan(sheet.peak_tension).any():
        loads = [
            Caution(
                "load-not-known",
                "mean tension and tension amplitude are not both factors: peak and minimum "
                "tension are not known, and the runs stand in the standard order",
                "Add the factor, or check the loads of each run by hand.",
            )
        ]
    else:
        loads = _slack(sheet, names, is_measured=is_measured)
        loads += _over(sheet, names, load_limit, peak_share_limit)
    order = order_cautions(sheet.coded, np.arange(float(sheet.n_runs)), sheet.names)
    return tuple(loads + _repeats(sheet, names) + order)


ON_PLAN = 0.3
"""Coded distance from the plan that a machine with poor control may cause. [1]."""

NOT_OF_PLAN = 0.5
"""Coded distance from which a run is not the planned one, as if two were swapped. [1]."""


def levels_off_plan(
    coded: ArrayLike,
    plan: ArrayLike,
    *,
    beyond: float,
    run_names: Sequence[str],
    factor_names: Sequence[str],
) -> tuple[str, ...]:
    """Runs whose levels differ from the plan, in words, farthest first.

    Notes
    -----
    Two runs swapped in a plan differ by 1 or 2; machines that control the stroke may miss
    a load by some tenths.  A surface is fitted to the levels reached and needs no plan; effects
    of two levels rest on the plan alone.

    Examples
    --------
    >>> levels_off_plan([[-0.98], [0.97]], [[-1], [-1]], beyond=0.1, run_names=["A", "B"],
    ...     factor_names=["frequency"])
    ('B frequency +0.97, planned -1.00',)
    """
    reached, planned = as_same_shape(coded=coded, plan=plan)
    away = np.nan_to_num(np.abs(reached - planned))
    order = np.argsort(-away, axis=None, kind="stable")[: int((away > beyond).sum())]
    rows, columns = np.unravel_index(order, away.shape)
    return tuple(
        f"{run_names[row]} {factor_names[column]} {reached[row, column]:+.2f}, "
        f"planned {planned[row, column]:+.2f}"
        for row, column in zip(rows.tolist(), columns.tolist(), strict=True)
    )


SIGNIFICANCE = 0.10
"""Two-sided level at which an effect of a screening counts: the 90 % of CG-D-39-80."""


def smallest_effect(design: Design, *, sigma: ArrayLike) -> Floats:
    r"""Smallest effect that the screening is expected to find significant.

    .. math:: E_{min} = t_{1 - \alpha/2;\, m}\, \frac{2 \sigma}{\sqrt{n}}

    Notes
    -----
    An effect is the difference of two means of n / 2 runs [5]_.  The scatter of the dummies
    is taken as ``sigma`` itself; interactions, which they also contain, add to it.

    Examples
    --------
    Five factors in twelve runs, six dummies: 1.943 times 2 / sqrt(12):

    >>> from reduction.experiments.designs import plackett_burman
    >>> print(smallest_effect(plackett_burman(5), sigma=1.0).round(3))
    1.122
    """
    freedom = design.dummy.shape[1] or design.n_factors / 3
    error = as_positive("sigma", sigma) * 2 / np.sqrt(design.n_runs)
    return np.asarray(scipy.special.stdtrit(freedom, 1 - SIGNIFICANCE / 2) * error)


_SINGULAR = 1e-9
"""Smallest over largest singular value, columns of equal length, below which terms coincide."""


def _find_confounded(matrix: ArrayLike, names: Sequence[str]) -> tuple[str, ...]:
    """Name the columns that are sums of the columns before them.

    Examples
    --------
    Two levels do not distinguish a square from the mean:

    >>> levels = np.array([-1.0, 1.0, -1.0, 1.0])
    >>> _find_confounded(np.stack([np.ones(4), levels**2, levels], axis=1), ["mean", "f^2", "f"])
    ('f^2 with mean',)
    """
    columns = np.asarray(matrix, dtype=np.float64)
    size = np.linalg.norm(columns, axis=0)
    unit = columns / np.where(size > 0, size, 1.0)
    kept: list[int] = []
    found: list[str] = []
    for index, name in enumerate(names):
        if size[index] == 0:
            found.append(f"{name} is zero in every run")
            continue
        share, *_ = np.linalg.lstsq(unit[:, kept], unit[:, index], rcond=None)
        left = unit[:, index] - unit[:, kept] @ share
        if np.linalg.norm(left) > _SINGULAR * len(names):
            kept.append(index)
        else:
            partners = [names[at] for at, part in zip(kept, share, strict=True) if abs(part) > 1e-6]
            found.append(f"{name} with {', '.join(partners)}")
    return tuple(found)


def covariance_factor(matrix: ArrayLike, *, names: Sequence[str]) -> Floats:
    r"""Covariance of the coefficients over the variance of a run, from the design alone.

    .. math:: C = (X^T X)^{-1}

    Parameters
    ----------
    matrix : array_like, shape (n_runs, n_columns)
        Model matrix. [1]
    names : sequence of str, length n_columns
        Names of the columns, for the message.

    Returns
    -------
    covariance_factor : ndarray, shape (n_columns, n_columns)
        Symmetric matrix. [1]

    Raises
    ------
    FitError
        If there are fewer runs than terms, or terms are confounded, which are named.

    Notes
    -----
    For the fifteen runs of [7]_: mean 1/3, squares 13/48, linear terms 1/8, interactions 1/4.

    Examples
    --------
    A mean of three runs:

    >>> print(covariance_factor(np.ones((3, 1)), names=["mean"]).round(4))
    [[0.3333]]
    """
    columns = np.asarray(matrix, dtype=np.float64)
    n_runs, n_columns = columns.shape
    if n_runs < n_columns:
        raise FitError(
            "there are fewer runs than terms",
            found=f"{n_runs} runs",
            needed=f"{n_columns} for {n_columns} terms, and more to judge the scatter",
            hint="Add runs, or fit fewer factors.",
            n_runs=n_runs,
            n_terms=n_columns,
        )
    if is_singular(columns):
        found = _find_confounded(columns, names)
        raise FitError(
            "the runs cannot tell all terms apart",
            found="; ".join(found),
            needed="runs that move every factor over three levels, and pairs of them together",
            hint="Add the runs that are missing from the design.",
            n_confounded=len(found),
        )
    inverse = np.linalg.inv(np.linalg.qr(columns)[1])
    return np.asarray(inverse @ inverse.T)


def variance_factor(
    matrix: ArrayLike, factor: ArrayLike, *, pattern: Integers | None = None
) -> Floats:
    r"""Variance of the surface at points over the variance of a run.

    .. math:: h(x) = x^T C x

    Parameters
    ----------
    matrix : array_like, shape (..., n_points, n_terms)
        Terms at the points; with a leading axis for the responses, or without. [1]
    factor : array_like, shape (n_terms, n_terms) or (n_patterns, n_terms, n_terms)
        Covariance of the coefficients over the variance of a run. [1]
    pattern : ndarray of int, shape (n_responses,), optional
        Index of the ``factor`` of each response, where there are several. [1]

    Returns
    -------
    variance_factor : ndarray, shape (..., n_points)
        The leverage where the point is a run. [1]

    Examples
    --------
    >>> print(variance_factor([[1.0]], [[1 / 3]]).round(3))
    [0.333]
    """
    terms, factors = np.asarray(matrix, dtype=np.float64), np.asarray(factor, dtype=np.float64)
    if factors.ndim == 3:
        factors = factors[0] if len(factors) == 1 or pattern is None else factors[pattern]
    if factors.ndim == 2:
        weighed = times(terms.reshape(-1, len(factors)), factors).reshape(terms.shape)
    else:
        weighed = terms @ factors
    return np.asarray(np.sum(weighed * terms, axis=-1))


def is_singular(columns: Floats) -> bool:
    """Whether the runs give no separate information on some columns of a matrix.

    Examples
    --------
    Two levels do not distinguish a square from the mean, three do:

    >>> levels = np.array([-1.0, 1.0, 0.0])
    >>> two, three = (np.stack([x**2, x**0], axis=1) for x in (levels[:2], levels))
    >>> is_singular(two), is_singular(three)
    (True, False)
    """
    size = np.linalg.norm(columns, axis=0)
    if not size.all():
        return True
    values = np.linalg.svd(columns / size, compute_uv=False)
    return bool(values[-1] < _SINGULAR * values[0])


@dataclass(frozen=True)
@read_only_arrays
class ExpectedPrecision:
    """Expected half widths of the intervals of a quadratic surface.

    Parameters
    ----------
    terms : tuple of str, length n_terms
        In printed order: mean, squares, linear, interactions.
    term_variance_factor : ndarray, shape (n_terms,)
        Variance of a coefficient over that of one run. [1]
    term_half_width : ndarray, shape (..., n_terms)
        Half width of the confidence interval of each coefficient. [unit of sigma]
    points : ndarray, shape (n_points, n_factors)
        Centre, the other points of the design, and the corners of the cube, coded. [1]
    point_kind : tuple of str, length n_points
        ``centre``, ``design`` or ``corner``.
    point_variance_factor : ndarray, shape (n_points,)
        Variance of the fitted response over that of one run. [1]
    confidence_half_width, prediction_half_width : ndarray, shape (..., n_points)
        Half width for the mean response, and for one more run there. [unit of sigma]
    is_beyond_design : ndarray of bool, shape (n_points,)
        True where the variance factor exceeds that of every run.
    degrees_of_freedom : int
        Of the residual.
    condition_number : float
        Of the model matrix. [1]
    """

    terms: tuple[str, ...]
    term_variance_factor: Floats
    term_half_width: Floats
    points: Floats
    point_kind: tuple[str, ...]
    point_variance_factor: Floats
    confidence_half_width: Floats
    prediction_half_width: Floats
    is_beyond_design: Bools
    degrees_of_freedom: int
    condition_number: float


def _points(coded: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Centre first, then the design, then corners that are not runs."""
    n_factors = coded.shape[1]
    runs = np.unique(coded, axis=0)
    runs = runs[np.any(runs != 0, axis=1)]
    corners = np.array(list(product((-1.0, 1.0), repeat=n_factors)))
    corners = corners[~np.any(np.all(corners[:, None] == runs, axis=2), axis=1)]
    kinds = ("centre",) + ("design",) * len(runs) + ("corner",) * len(corners)
    return np.vstack([np.zeros((1, n_factors)), runs, corners]), kinds


def expected_precision(
    coded: ArrayLike,
    *,
    sigma: ArrayLike,
    factor_names: Sequence[str] | None = None,
) -> ExpectedPrecision:
    """Half width of the interval of each term and of the response, for a stated scatter.

    Notes
    -----
    The quantile is Student's for the residual of the runs to come, so that the width includes the
    cost of few degrees of freedom; the scatter of the runs is taken as
    ``sigma`` itself.  The width holds for a quadratic surface: otherwise
    the misfit adds to it.

    Examples
    --------
    The design of [8]_: mean, squares, linear terms, interactions, then the corners:

    >>> from reduction.experiments.designs import box_behnken
    >>> precision = expected_precision(box_behnken(3).coded, sigma=0.02)
    >>> print(precision.term_variance_factor.round(4)[[0, 1, 4, 7]])
    [0.3333 0.2708 0.125  0.25  ]
    >>> print(precision.point_variance_factor.round(3)[[0, 1, -1]])
    [0.333 0.75  1.396]
    """
    runs = as_finite("coded", coded)
    scatter = as_positive("sigma", sigma)
    n_runs, n_factors = runs.shape
    exponents = quadratic_exponents(n_factors)
    names = [f"X{i + 1}" for i in range(n_factors)] if factor_names is None else factor_names
    terms = term_names(exponents, names)
    matrix = model_matrix(runs, exponents)
    factor = covariance_factor(matrix, names=terms)
    freedom = n_runs - len(terms)
    if freedom == 0:
        raise FitError(
            "as many runs as terms leave nothing to judge the surface by",
            found=f"{n_runs} runs",
            needed=f"more than the {len(terms)} terms",
            degrees_of_freedom=freedom,
        )
    points, kinds = _points(runs)
    of_term = np.diagonal(factor)
    of_point = variance_factor(model_matrix(points, exponents), factor)
    of_run = variance_factor(matrix, factor)
    reach = scipy.special.stdtrit(freedom, (1 + CONFIDENCE) / 2) * scatter[..., None]
    return ExpectedPrecision(
        terms=terms,
        term_variance_factor=of_term,
        term_half_width=reach * np.sqrt(of_term),
        points=points,
        point_kind=kinds,
        point_variance_factor=of_point,
        confidence_half_width=reach * np.sqrt(of_point),
        prediction_half_width=reach * np.sqrt(1 + of_point),
        is_beyond_design=of_point > of_run.max() * (1 + 1e-9),
        degrees_of_freedom=freedom,
        condition_number=float(np.linalg.cond(matrix)),
    )

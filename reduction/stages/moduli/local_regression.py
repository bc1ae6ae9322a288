"""Sums of strain and tension by strain bin, and the local regression of the tangent modulus.

**Sums of strain and tension by curve and strain bin, and the local regression from them.** A
moving regression needs nine sums of the samples in each bin. They are computed once from the
samples; any window is a sum of neighbouring bins, and sums of two pieces of a record add up.

References
----------
.. [2] T. A. Davis, "Direct Methods for Sparse Linear Systems," SIAM, 2006, ch. 2 (compressed
   columns).
.. [3] T. F. Chan, G. H. Golub and R. J. LeVeque, "Algorithms for computing the sample
   variance," Amer. Statistician, vol. 37, no. 3, 1983.
.. [4] A. Savitzky and M. J. E. Golay, "Smoothing and differentiation of data by simplified
   least squares procedures," Anal. Chem., vol. 36, 1964.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import ceil

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import ArrayLike

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.moduli.tangent_window import StrainGrid

# Large enough that threads do not wait for the interpreter between the steps of a block;
# at twice this size the system allocates fresh memory for every step, which costs more.
_BLOCK_SAMPLES = 1 << 17

_BLOCK_CELLS = 1 << 16

_END_CYCLES = 3  # kept at the start and end of a long test, enough for a mean of each


def select_cycles(n_cycles: int, *, longest: int) -> Integers:
    """Numbers of the cycles whose own curves are kept.

    Parameters
    ----------
    n_cycles : int
        Cycles of the test. [1]
    longest : int
        Longest test for which every cycle is kept. [1]

    Returns
    -------
    selected : ndarray of int, shape (n_selected,)
        Cycle numbers, from 1: all of a short test; of a long one the first three,
        the last three, and between them about as many, spaced by equal ratio, as
        make up ``longest``. [1]

    Raises
    ------
    DataError
        If there is no cycle.

    Examples
    --------
    >>> print(select_cycles(3000, longest=12))
    [   1    2    3    7   20   55  149  405 1103 2998 2999 3000]
    """
    if n_cycles < 1:
        raise DataError("there is no cycle to select", found=f"{n_cycles}", needed="1 or more")
    if n_cycles <= longest:
        return np.arange(1, n_cycles + 1)
    ends = np.arange(1, _END_CYCLES + 1)
    spaced = np.geomspace(1, n_cycles, max(longest - 2 * _END_CYCLES + 3, 2))
    return np.unique(np.concatenate([ends, np.rint(spaced).astype(int), n_cycles + 1 - ends]))


@dataclass(frozen=True)
@read_only_arrays
class CycleGroups:
    """Consecutive cycles that give one curve; group g holds cycles first[g]..first[g+1]-1."""

    first: Integers
    of_cycle: Integers  # by cycle number, index 0 (outside cycles) is -1
    is_break_in: Bools

    @classmethod
    def of(cls, n_cycles: int, break_in_cycles: int, pooled: int) -> CycleGroups:
        """Groups of the cycles after break-in, and of the break-in cycles apart."""
        # The last group takes the remainder: a group of fewer cycles than the
        # others would give a curve of fewer samples than a window needs.
        n_after = max((n_cycles - break_in_cycles) // pooled, 1)
        after = break_in_cycles + pooled * np.arange(n_after)
        before = np.arange(0, break_in_cycles, pooled)
        first = np.concatenate([before, after])
        of_cycle = np.searchsorted(first, np.arange(n_cycles), side="right") - 1
        return cls(first, np.concatenate([[-1], of_cycle]), first < break_in_cycles)

    def blocks(self, cycles: Cycles, n_bins: int) -> Iterator[tuple[int, int, slice]]:
        """Groups [start, stop) and their samples, small enough to stay in the cache."""
        start_sample = cycles.first[self.first]
        start, n_groups = 0, self.first.size
        most_groups = max(_BLOCK_CELLS // (4 * n_bins), 1)
        while start < n_groups:
            stop = int(np.searchsorted(start_sample, start_sample[start] + _BLOCK_SAMPLES))
            stop = min(max(stop, start + 1), start + most_groups, n_groups)
            last_cycle = self.first[stop] - 1 if stop < n_groups else cycles.n_cycles - 1
            yield start, stop, slice(int(start_sample[start]), int(cycles.last[last_cycle]) + 1)
            start = stop


def sums_by_cell(cell: Integers, n_cells: int) -> scipy.sparse.csc_array:
    """Matrix that sums samples by cell: ``sums_by_cell(cell, n_cells) @ values``.

    Parameters
    ----------
    cell : ndarray of int, shape (n_samples,)
        Cell of each sample, from 0 and below ``n_cells``. [1]
    n_cells : int
        Number of cells. [1]

    Returns
    -------
    matrix : sparse array, shape (n_cells, n_samples)
        A one in each column. [1]

    Raises
    ------
    ValueError
        If there are more cells or samples than 32 bits can count.

    Notes
    -----
    One column per sample, stored by columns ([2]_).  The sums are those of `numpy.bincount`,
    added in the same order, in about the same time; but bincount holds the interpreter's
    lock, and blocks would wait for each other.

    Examples
    --------
    >>> sums_by_cell(np.array([0, 2, 2]), 3) @ np.array([1.0, 2.0, 3.0])
    array([1., 0., 5.])
    """
    if max(n_cells, cell.size) > np.iinfo(np.int32).max:
        raise ValueError(f"{cell.size} samples in {n_cells} cells are too many for one block")
    one_each = np.arange(cell.size + 1, dtype=np.int32)
    return scipy.sparse.csc_array(
        (np.ones(cell.size), cell.astype(np.int32), one_each), shape=(n_cells, cell.size)
    )


@dataclass(frozen=True)
@read_only_arrays
class RunningStatistics:
    """Statistics over the curves so far, without NaN; arrays of one shape.

    Parameters
    ----------
    count : ndarray
        Values in the mean, weighted: a curve pooled from m cycles counts m times. [1]
    n_curves : ndarray
        Curves in the mean. [1]
    mean, squares, minimum, maximum : ndarray
        Mean, sum of squared deviations from it, least and greatest. [SI]
    variance : ndarray
        Sum of the variances supplied with the values. [SI]
    bends, n_bends : ndarray
        Sum of squared differences between each curve and the mean of the curves before and after
        it, and their number. [SI], [1]
    head, tail : ndarray, shape (up to 3, ...)
        Values of the first three curves and of the last three. [SI]
    """

    count: Floats
    n_curves: Floats
    mean: Floats
    squares: Floats
    minimum: Floats
    maximum: Floats
    variance: Floats
    bends: Floats
    n_bends: Floats
    head: Floats
    tail: Floats

    @classmethod
    def of(cls, values: Floats, variance: Floats, *, weight: Floats) -> RunningStatistics:
        """Statistics over the first axis; ``weight`` (n_curves,) is the cycles in each curve."""
        known = np.isfinite(values)
        n_curves = known.sum(axis=0).astype(np.float64)
        mean = np.where(known, values, 0.0).sum(axis=0) / np.maximum(n_curves, 1)
        step = np.where(known, values - mean, 0.0)
        step *= step
        bends, n_bends = _bends(values)
        return cls(
            count=np.where(known, weight.reshape(-1, *[1] * (values.ndim - 1)), 0.0).sum(axis=0),
            n_curves=n_curves,
            mean=mean,
            squares=step.sum(axis=0),
            minimum=np.where(known, values, np.inf).min(axis=0, initial=np.inf),
            maximum=np.where(known, values, -np.inf).max(axis=0, initial=-np.inf),
            variance=np.where(known, variance, 0.0).sum(axis=0),
            bends=bends,
            n_bends=n_bends,
            head=values[:3],
            tail=values[-3:],
        )

    def __add__(self, other: RunningStatistics) -> RunningStatistics:
        """Statistics over both blocks ([3]_, eq. 2.1)."""
        n_curves = self.n_curves + other.n_curves
        share = other.n_curves / np.maximum(n_curves, 1)
        step = other.mean - self.mean
        bends, n_bends = _bends(np.concatenate([self.tail[-2:], other.head[:2]]))
        return RunningStatistics(
            count=self.count + other.count,
            n_curves=n_curves,
            mean=self.mean + step * share,
            squares=self.squares + other.squares + step**2 * self.n_curves * share,
            minimum=np.minimum(self.minimum, other.minimum),
            maximum=np.maximum(self.maximum, other.maximum),
            variance=self.variance + other.variance,
            bends=self.bends + other.bends + bends,
            n_bends=self.n_bends + other.n_bends + n_bends,
            head=np.concatenate([self.head, other.head])[:3],
            tail=np.concatenate([self.tail, other.tail])[-3:],
        )

    def value(self) -> Floats:
        """Mean; NaN where there is no value."""
        return np.where(self.n_curves > 0, self.mean, np.nan)

    def scatter(self) -> Floats:
        """Standard deviation; NaN below two curves."""
        freedom = np.where(self.n_curves > 1, self.n_curves - 1, np.nan)
        return np.sqrt(self.squares / freedom)

    def standard_uncertainty(self) -> Floats:
        """Type A of the mean without a trend (`_variance_of_a_cycle`); for one curve, its own."""
        n_curves = np.maximum(self.n_curves, 1)
        own = self.variance / n_curves
        # the first and last curve deviate from the line through the next two by twice the bend
        (head, n_head), (tail, n_tail) = _bends(self.head), _bends(self.tail)
        many = _variance_of_a_cycle(
            self.scatter() ** 2, bends=self.bends + head + tail,
            n_bends=self.n_bends + n_head + n_tail, own=own,
        )  # fmt: skip
        return np.sqrt(np.where(self.n_curves == 1, own, many / n_curves))

    def lowest(self) -> Floats:
        """Minimum; NaN where there is no value."""
        return np.where(self.n_curves > 0, self.minimum, np.nan)

    def highest(self) -> Floats:
        """Maximum; NaN where there is no value."""
        return np.where(self.n_curves > 0, self.maximum, np.nan)


def _bends(values: Floats) -> tuple[Floats, Floats]:
    """Sum of squares and number of `RunningStatistics.bends` over the first axis."""
    bend = values[1:-1] - (values[:-2] + values[2:]) / 2
    known = np.isfinite(bend)
    return (np.where(known, bend, 0.0) ** 2).sum(axis=0), known.sum(axis=0).astype(np.float64)


_FEWEST_BENDS = 5  # three cycles between the first and the last, and both ends

_TREND = 4.0  # least ratio of the variances with and without the trend

_OF_A_BEND = 1.5  # variance of a value minus the mean of two others, over that of one value


def _variance_of_a_cycle(
    variance: Floats, *, bends: Floats, n_bends: Floats, own: Floats
) -> Floats:
    r"""Variance of one of several cycles about their trend.

    .. math:: s^2 = \frac{2}{3 n} \left(b_2^2 + b_{n-1}^2 + \sum_{i = 2}^{n - 1} b_i^2\right),
              \qquad b_i = x_i - \frac{x_{i-1} + x_{i+1}}{2}

    Parameters
    ----------
    variance : ndarray
        About their mean, n - 1 degrees of freedom. [SI]
    bends, n_bends : ndarray
        Sum in the brackets of the formula, and its number of terms. [SI], [1]
    own : ndarray
        Mean of the variances of the cycles themselves; NaN where they have none. [SI]

    Returns
    -------
    variance : ndarray
        Variance about the mean, unless a trend accounts for more than three quarters of it. [SI]

    Notes
    -----
    A stiffness that falls over the cycles because the specimen softens or warms up is not scatter:
    the mean of these cycles is known as well as the cycles are.  Differences between neighbours
    remove a trend [1]_, and second differences remove most of a decay over one or two cycles as
    well.  The first and last cycle have a neighbour on one side only: each deviates from the line
    through the next two by twice their bend, with four times its variance, and counts as one more
    term.  A single unusual cycle is not a trend: the second differences contain all of the variance
    that it causes, or a third of it if it is the first or the last.

    References
    ----------
    .. [1] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
       difference," Ann. Math. Stat. 12(2), 1941.

    Examples
    --------
    Of a variance of 13, and twelve bends with squares of 0.04 each or of 40:

    >>> for bend in (0.04, 40.0):
    ...     print(_variance_of_a_cycle(
    ...         np.array(13.0), bends=12 * bend, n_bends=np.array(12), own=np.array(0.01)).round(3))
    0.027
    13.0
    """
    without = np.fmax(bends / (_OF_A_BEND * np.maximum(n_bends, 1)), own)
    is_trend = (n_bends >= _FEWEST_BENDS) & (variance > _TREND * without)
    return np.where(is_trend, without, variance)


_N_SUMS = 9

_LEVEL_STEPS = 4  # each reduces the error of the levels to a small fraction

# Fractions of the values for samples spread evenly over the window.
_LEAST_SPREAD = 0.25  # of the second moment: less is a cluster, which has no slope

_LEAST_BEND = 0.05  # of the bending moment: with less, a straight line is fitted

_FURTHEST_CENTRE = 0.125  # of the window: mean strain of the samples off the bin centre


@dataclass(frozen=True)
@read_only_arrays
class BranchMoments:
    """Nine sums of each curve and bin; moments of one grid and reference add up.

    Parameters
    ----------
    sums : ndarray, shape (9, n_curves, n_bins + 2 half_window)
        1, x, x2, x3, x4, y, xy, x2y, y2, where x is strain from the middle of the
        grid in bins and y is tension less ``tension_reference``; with half a window of
        empty bins on each side. [1], [N], [N2]
    grid : StrainGrid
        The bins. [1]
    tension_reference : float
        Subtracted from tension to preserve the digits of squares. [N]
    """

    sums: Floats
    grid: StrainGrid
    tension_reference: float

    def __add__(self, other: BranchMoments) -> BranchMoments:
        """Moments of both pieces together."""
        mine, theirs = (self.grid, self.tension_reference), (other.grid, other.tension_reference)
        if mine != theirs:
            raise DataError(
                "moments of two grids do not add up", found=str(theirs), needed=str(mine)
            )
        return BranchMoments(self.sums + other.sums, *mine)

    def curves(self, start: int, stop: int) -> BranchMoments:
        """Moments of the curves from start to stop, stop not included."""
        return BranchMoments(self.sums[:, start:stop], self.grid, self.tension_reference)

    def pooled(self, n_branches: int) -> BranchMoments:
        """Moments of each branch over all its curves, each put on the mean curve.

        Curves come branch by branch within a cycle.  Tension falls from cycle to cycle, and not
        every cycle has a sample in every bin: if the level of a cycle were not removed, that fall
        would appear as a slope.  Nor are the samples of a bin at one strain: where there are few,
        the slope across the bin must not count as level.  A specimen that softens loses tension in
        proportion: where the ranges of the curves differ beyond chance, they are removed as well,
        as if each curve had one more reading, that of the mean curve.
        """
        sums = self.sums.reshape(_N_SUMS, -1, n_branches, self.sums.shape[-1])
        count, strain, tension = sums[0], sums[1], sums[5]
        n_samples = np.maximum(count.sum(axis=0), 1)
        of_curve = np.maximum(count.sum(axis=-1, keepdims=True), 1)
        tension = tension - (strain - count * (strain.sum(axis=0) / n_samples)) * self._slope(sums)
        level, scale = np.zeros((*count.shape[:2], 1)), np.ones((*count.shape[:2], 1))
        for _ in range(_LEVEL_STEPS):  # the mean of a bin depends on the levels of its curves
            mean = ((tension - count * level) / scale).sum(axis=0) / n_samples
            above = mean - (count * mean).sum(axis=-1, keepdims=True) / of_curve
            power = (count * above**2).sum(axis=-1, keepdims=True)
            # a curve without readings, or with few in a small part of the range, shows none
            of_one = np.maximum(power.sum(axis=0) / of_curve.sum(axis=0), _TINY)
            grown = ((above * tension).sum(axis=-1, keepdims=True) + of_one) / (power + of_one)
            scale = np.where(_is_beyond_chance(tension, count, above, grown), grown, 1.0)
            scale = scale / ((of_curve * scale).sum(axis=0) / of_curve.sum(axis=0))
            level = (tension - count * scale * mean).sum(axis=-1, keepdims=True) / of_curve
        pooled = sums.copy()
        pooled[8] += level * (level * count - 2 * sums[5])
        pooled[8] /= scale**2
        pooled[5:8] = (sums[5:8] - sums[0:3] * level) / scale
        return BranchMoments(pooled.sum(axis=1), self.grid, self.tension_reference)

    def _slope(self, sums: Floats) -> Floats:
        """Slope of all curves of a branch together at each bin; the nearest one at the ends."""
        together = BranchMoments(sums.sum(axis=1), self.grid, self.tension_reference)
        slope = fit_windows(together, minimum_count=3).slope * self.grid.width
        beside = self.grid.half_window
        padded = np.zeros((slope.shape[0], sums.shape[-1]))
        for row, of_branch in zip(padded, slope, strict=True):
            known = np.flatnonzero(np.isfinite(of_branch))
            if known.size:
                row[:] = np.interp(np.arange(row.size), known + beside, of_branch[known])
        return padded

    def in_windows(self, half_window: int) -> BranchMoments:
        """Return the same moments for a window that is not wider."""
        beside = self.grid.half_window - half_window
        inner = slice(beside, self.sums.shape[-1] - beside)
        grid = replace(self.grid, half_window=half_window)
        return BranchMoments(self.sums[..., inner], grid, self.tension_reference)

    def followed_by(self, other: BranchMoments) -> BranchMoments:
        """Curves of both, one after the other, of one grid and reference."""
        both = np.concatenate([self.sums, other.sums], axis=1)
        return BranchMoments(both, self.grid, self.tension_reference)


def _is_beyond_chance(tension: Floats, count: Floats, above: Floats, grown: Floats) -> Bools:
    """Whether the ranges of the curves of a branch differ by more than their readings explain.

    ``tension`` and ``count`` are sums by curve, branch and bin; ``above`` is the mean curve less
    its mean over the readings of a curve, and ``grown`` the range of a curve over that of it.
    """
    filled = np.maximum(count, 1)
    level = tension.sum(axis=-1, keepdims=True) / np.maximum(count.sum(axis=-1, keepdims=True), 1)
    left = ((tension - count * (level + grown * above)) ** 2 / filled).sum(axis=(0, 2))
    freedom = np.maximum((count > 0).sum(axis=(0, 2)) - 2 * count.shape[0], 1)
    apart = ((grown - 1) ** 2 * (count * above**2).sum(axis=-1, keepdims=True)).mean(axis=(0, 2))
    return np.asarray(apart > _APART * left / freedom)[:, None]


_APART = 16.0  # ratio of the variances; of many pairs of blocks none exceeds it by chance

_TINY = 1e-300


@dataclass(frozen=True)
@read_only_arrays
class LocalFits:
    """Local regression at every bin centre; arrays have shape (n_curves, n_bins).

    ``slope`` [N] and ``tension`` [N] are NaN where the samples do not support
    them; the variances [N2] are also NaN where the branch has no degree of freedom.
    """

    slope: Floats
    slope_variance: Floats
    tension: Floats
    tension_variance: Floats


def accumulate_moments(
    strain: Floats,
    tension: Floats,
    *,
    curve: Integers,
    n_curves: int,
    grid: StrainGrid,
    tension_reference: float,
) -> tuple[BranchMoments, int]:
    r"""Nine sums of strain and tension in each bin of each curve.

    Parameters
    ----------
    strain : ndarray, shape (n_samples,)
        Nominal strain; NaN where missing. [1]
    tension : ndarray, shape (n_samples,)
        Tension; NaN where missing. [N]
    curve : ndarray of int, shape (n_samples,)
        Curve to which each sample belongs, such as a branch of a cycle; negative
        where it belongs to none. [1]
    n_curves : int
        Number of curves. [1]
    grid : StrainGrid
        The bins. [1]
    tension_reference : float
        A tension of the branch; any value, but equal for pieces that are added. [N]

    Returns
    -------
    moments : BranchMoments
        Sums of each curve and bin. [SI]
    n_outside : int
        Samples of a curve with strain and tension, but with strain outside the grid. [1]

    Raises
    ------
    DataError
        Not by this function, but by the sum of two `BranchMoments` of different grids.

    Notes
    -----
    Samples with NaN in strain or tension are skipped.

    Examples
    --------
    >>> import numpy as np
    >>> grid = StrainGrid(low=1.0, width=0.5, n_bins=2, half_window=1)
    >>> moments, n_outside = accumulate_moments(
    ...     np.array([1.1, 1.2, 1.6, np.nan, 3.0]), np.array([10.0, 12.0, 14.0, 0.0, 0.0]),
    ...     curve=np.zeros(5, dtype=np.int64), n_curves=1, grid=grid, tension_reference=10.0,
    ... )
    >>> print(moments.sums[0], moments.sums[5], n_outside)
    [[0. 2. 1. 0.]] [[0. 2. 4. 0.]] 1
    """
    position = (strain - grid.low) * (1 / grid.width)
    y = tension - tension_reference
    n_padded = grid.n_bins + 2 * grid.half_window
    n_cells = n_curves * n_padded
    # comparisons with NaN are false, and the value to which a NaN is cast is not used
    inside = (position >= 0) & (position < grid.n_bins) & np.isfinite(y) & (curve >= 0)
    with np.errstate(invalid="ignore"):
        cell = position.astype(np.int32)
    cell += grid.half_window
    cell += (curve * n_padded).astype(np.int32, copy=False)
    n_outside = 0
    if not inside.all():
        known = (curve >= 0) & np.isfinite(position) & np.isfinite(y)
        n_outside = int(np.count_nonzero(known) - np.count_nonzero(inside))
        cell[~inside] = n_cells  # an extra cell, cut off later: cheaper than removing samples

    x = position
    x -= grid.n_bins / 2
    adds = sums_by_cell(cell, n_cells + 1)
    x2, xy = x * x, x * y
    sums = np.empty((_N_SUMS, n_cells))
    for row, value in enumerate((np.ones_like(x), x, x2, x2 * x, x2 * x2, y, xy, x * xy, y * y)):
        sums[row] = (adds @ value)[:n_cells]
    return BranchMoments(
        sums.reshape(_N_SUMS, n_curves, n_padded), grid, tension_reference
    ), n_outside


def _window_sums(sums: Floats, n_window: int) -> Floats:
    """Sums over every run of an odd number of neighbours, by doubling: no cancellation."""
    n_out = sums.shape[-1] - n_window + 1
    windows = np.empty((*sums.shape[:-1], n_out))
    for of_curves, window in zip(sums, windows, strict=True):
        # curves end to end are one long row; windows across the end of a curve are left out
        total = run = of_curves.ravel()
        covered = width = 1
        while covered < n_window:
            run, width = run[:-width] + run[width:], 2 * width
            if n_window & width:
                total, covered = total[: run.size - covered] + run[covered:], covered + width
        window[:] = sliding_window_view(total, n_out)[:: sums.shape[-1]]
    return windows


_ALONE = 12  # degrees of freedom from which a window uses its own scatter

_OTHER_SCATTER = 3.0  # ratio of variances with twelve degrees of freedom: 1 in 60 by chance


def _variance_near(squares: Floats, freedom: Floats, *, n_window: int) -> Floats:
    """Residual variance of as many windows around each one as have twelve degrees of freedom.

    NaN where there are not enough.

    Examples
    --------
    Windows of one bin with three degrees of freedom each, half of them with a tenth of the noise:

    >>> squares = np.repeat([0.03, 3.0], 10)[None]
    >>> print(_variance_near(squares, np.full((1, 20), 3.0), n_window=1)[0, [0, 5, 9, 15]].round(2))
    [0.01 0.01 0.41 1.  ]
    """
    usual = freedom[freedom > 0]
    if not usual.size:
        return np.full(freedom.shape, np.nan)
    half = n_window * ceil(_ALONE / float(np.median(usual))) // 2
    sums = np.cumsum(np.pad([np.maximum(squares, 0.0), freedom], ((0, 0), (0, 0), (1, 0))), axis=-1)
    n_bins = freedom.shape[-1]
    found = np.full(freedom.shape, np.nan)
    while np.isnan(found).any() and half < n_bins:  # wider where readings are few
        low = np.clip(np.arange(n_bins) - half, 0, max(n_bins - 2 * half - 1, 0))
        high = np.minimum(low + 2 * half + 1, n_bins)
        total, free = sums[..., high] - sums[..., low]
        # neighbouring windows share their samples
        is_enough = np.isnan(found) & (free >= _ALONE * n_window)
        found[is_enough] = total[is_enough] / free[is_enough]
        half *= 2
    return found


def fit_windows(moments: BranchMoments, *, minimum_count: int, is_alone: bool = False) -> LocalFits:
    r"""Slope and value of tension against strain at every bin centre.

    In each window tension is regressed on strain with a quadratic; the slope at
    the bin centre :math:`x_c`, with :math:`u = x - \bar x`, is

    .. math::

        b + c\,\bigl(2 (x_c - \bar x) - S_3 / S_2\bigr),\quad b = S_{uy} / S_2

    where :math:`c` is the regression on the part of :math:`u^2` that is orthogonal to the straight
    line.

    Parameters
    ----------
    moments : BranchMoments
        Sums of each curve and bin. [SI]
    minimum_count : int
        Fewest samples in a window that give a slope. [1]
    is_alone : bool
        For curves that are not repeated by others. [1]

    Returns
    -------
    fits : LocalFits
        Slope per unit strain and tension at the bin centres, with variances from
        the residuals. [SI]

    Raises
    ------
    DataError
        If ``minimum_count`` is below 3.

    Notes
    -----
    With samples spread evenly about the centre the curvature drops out: the slope is that
    of a straight line ([4]_ has the same for equal spacing), with the bias
    :math:`E'' W^2 / 40` for a window of width :math:`W`. The curvature matters where
    samples are few or the branch ends: a straight line has the slope at the mean
    strain of its samples, not at the bin centre, and in a test logged in step
    with its period this error is the same in every cycle.

    NaN where fewer than ``minimum_count`` samples are in the window, where they
    cluster (their variance is below a quarter of an even spread), or where their
    mean is further than an eighth of the window from the bin centre, as
    at the end of a branch. Residual variance is pooled over the windows of a curve.  With
    ``is_alone``, it is that of each window with twelve degrees of freedom, else that of the
    windows around it with as many, where that differs by a factor of three: a knee or a break
    elsewhere on a single curve does not affect it.

    Strain noise does not flatten the slope where the spacing of samples is below the noise,
    since the window is cut on the strain that was read; where the spacing is larger
    it does, by noise variance over the variance of strain in the window.

    Examples
    --------
    A straight line is reproduced, 1000 N per unit strain:

    >>> import numpy as np
    >>> strain = np.linspace(0.0, 1.0, 201)
    >>> moments, _ = accumulate_moments(
    ...     strain, 50 + 1000 * strain, curve=np.zeros(201, dtype=np.int64), n_curves=1,
    ...     grid=StrainGrid(low=0.0, width=0.1, n_bins=10, half_window=1), tension_reference=0.0,
    ... )
    >>> fits = fit_windows(moments, minimum_count=4)
    >>> print(fits.slope[0, 4:6].round(6), fits.tension[0, 4].round(6))
    [1000. 1000.] 500.0
    """
    if minimum_count < 3:
        raise DataError(
            "a slope needs more samples", found=f"minimum_count {minimum_count}", needed="3 or more"
        )
    grid = moments.grid
    n_window = 2 * grid.half_window + 1
    n, sx, sxx, sxxx, sxxxx, sy, sxy, sxxy, syy = _window_sums(moments.sums, n_window)
    centre = np.arange(grid.n_bins) + 0.5 - grid.n_bins / 2
    with np.errstate(divide="ignore", invalid="ignore"):
        per_n = 1 / n
        mean, level = sx / n, sy / n
        s2 = sxx - mean * sx
        s3 = sxxx - mean * (3 * sxx - 2 * mean * sx)
        s4 = sxxxx - mean * (4 * sxxx - mean * (6 * sxx - 3 * mean * sx))
        suy = sxy - mean * sy
        per_s2 = 1 / s2
        skew = s3 * per_s2
        bend_moment = s4 - s2 * s2 * per_n - skew * s3
        bend_tension = sxxy - mean * (2 * sxy - mean * sy) - s2 * level - skew * suy
        has_bend = bend_moment > (_LEAST_BEND * n_window**4 / 180) * n
        per_bend = np.where(has_bend, 1 / bend_moment, 0.0)
        bend = bend_tension * per_bend
        straight = suy * per_s2
        offset = centre - mean
        tilt = 2 * offset - skew
        arc = offset * offset - s2 * per_n - skew * offset
        supported = (
            (n >= minimum_count)
            & (s2 >= (_LEAST_SPREAD * n_window**2 / 12) * n)
            & (np.abs(offset) <= _FURTHEST_CENTRE * n_window)
        )
        squares = np.where(supported, syy - level * sy - straight * suy - bend * bend_tension, 0.0)
        freedom = np.where(supported, n - 2 - has_bend, 0.0)
        total_freedom = freedom.sum(axis=-1, keepdims=True)
        variance = np.maximum(squares.sum(axis=-1, keepdims=True), 0.0) / total_freedom
        variance = np.where(total_freedom > 0, variance, np.nan)
        if is_alone:
            near = _variance_near(squares, freedom, n_window=n_window)
            is_other = (near < variance / _OTHER_SCATTER) | (near > _OTHER_SCATTER * variance)
            variance = np.where(is_other, near, variance)
            variance = np.where(freedom >= _ALONE, np.maximum(squares, 0.0) / freedom, variance)
        slope = straight + bend * tilt
        slope_variance = variance * (per_s2 + tilt * tilt * per_bend)
        tension = level + straight * offset + bend * arc + moments.tension_reference
        tension_variance = variance * (per_n + offset * offset * per_s2 + arc * arc * per_bend)
    return LocalFits(
        slope=np.where(supported, slope * (1 / grid.width), np.nan),
        slope_variance=np.where(supported, slope_variance * grid.width**-2, np.nan),
        tension=np.where(supported, tension, np.nan),
        tension_variance=np.where(supported, tension_variance, np.nan),
    )


def curve_at(
    strain: ArrayLike, strain_bin: ArrayLike, values: ArrayLike, *, spacing: float | None
) -> Floats:
    """Values of a curve between its bins, by straight lines; nothing is extrapolated.

    All readings at a given strain, in a look-up, a budget, a table or a ratio, use this function.

    Parameters
    ----------
    strain : array_like, shape (n,)
        Strains at which the curve is wanted. [1]
    strain_bin : array_like, shape (n_bins,)
        Bin centres, or other points of an axis, increasing. [1]
    values : array_like, shape (n_bins,)
        The curve, NaN where not supported. [SI]
    spacing : float or None
        Distance of neighbouring bins; a gap wider than 1.5 times this is not
        bridged. None if any gap is bridged. [1]

    Returns
    -------
    at_strain : ndarray, shape (n,)
        NaN outside the curve and in its gaps. [SI]

    Examples
    --------
    >>> nan = float("nan")
    >>> print(curve_at([0.5, 1.5, 4.0], [0.0, 1.0, 2.0, 3.0], [1.0, 3.0, nan, 5.0], spacing=1.0))
    [ 2. nan nan]
    """
    wanted = np.asarray(strain, dtype=np.float64)
    bins, curve = (np.asarray(series, dtype=np.float64) for series in (strain_bin, values))
    known = np.isfinite(curve)
    bins, curve = bins[known], curve[known]
    if bins.size == 0:
        return np.full(wanted.shape, np.nan)
    if spacing is None:
        return np.interp(wanted, bins, curve, left=np.nan, right=np.nan)
    close = 1e-6 * spacing  # two grids of one width differ by rounding
    after = np.clip(np.searchsorted(bins, wanted - close), 0, bins.size - 1)
    before = np.clip(np.searchsorted(bins, wanted + close, side="right") - 1, 0, None)
    between = (
        (bins[before] <= wanted + close)
        & (bins[after] >= wanted - close)
        & (bins[after] - bins[before] <= 1.5 * spacing)
    )
    return np.where(between, np.interp(wanted, bins, curve), np.nan)

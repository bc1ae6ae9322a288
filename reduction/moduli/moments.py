"""Sums of strain and tension by curve and strain bin, and the local regression they give.

All that a moving regression needs of the samples is nine sums in each bin. They
are taken once over the samples; any window is a sum of neighbouring bins, and
sums of two pieces of a record add up.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] A. Savitzky and M. J. E. Golay, "Smoothing and differentiation of data by
   simplified least squares procedures," Anal. Chem., vol. 36, 1964.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from reduction.errors import DataError
from reduction.moduli.cells import sums_by_cell
from reduction.moduli.grid import StrainGrid
from reduction.record import Floats, Integers, read_only_arrays

_N_SUMS = 9
# Shares of what samples spread evenly over the window would give.
_LEAST_SPREAD = 0.25  # of the second moment: less is a cluster, which has no slope
_LEAST_BEND = 0.05  # of the bending moment: less cannot tell a bend, a straight line is fitted
_FURTHEST_CENTRE = 0.125  # of the window: mean strain of the samples off the bin centre


@dataclass(frozen=True)
@read_only_arrays
class BranchMoments:
    """Nine sums of each curve and bin; moments of one grid and reference add up.

    Parameters
    ----------
    sums : ndarray, shape (9, n_curves, n_bins + 2 half_window)
        1, x, x2, x3, x4, y, xy, x2y, y2, where x is strain from the middle of the
        grid in bins and y is tension less ``tension_reference``; half a window of
        empty bins stands at each side. [1], [N], [N2]
    grid : StrainGrid
        The bins. [1]
    tension_reference : float
        Subtracted from tension, so that squares keep their digits. [N]
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

    def followed_by(self, other: BranchMoments) -> BranchMoments:
        """Curves of both, one after the other, of one grid and reference."""
        both = np.concatenate([self.sums, other.sums], axis=1)
        return BranchMoments(both, self.grid, self.tension_reference)


@dataclass(frozen=True)
@read_only_arrays
class LocalFits:
    """Local regression at every bin centre; arrays have shape (n_curves, n_bins).

    ``slope`` [N] and ``tension`` [N] are NaN where the samples do not support
    them; the variances [N2] are NaN also where the branch has no degree of freedom.
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
        A tension of the branch; any will do, equal for pieces that are added. [N]

    Returns
    -------
    moments : BranchMoments
        Sums of each curve and bin. [SI]
    n_outside : int
        Samples of a curve with strain and tension, but with strain off the grid. [1]

    Raises
    ------
    DataError
        Not by this function; the sum of two `BranchMoments` of unlike grids raises it.

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
    # comparisons with NaN are false, and what a NaN is cast to counts nowhere
    inside = (position >= 0) & (position < grid.n_bins) & np.isfinite(y) & (curve >= 0)
    with np.errstate(invalid="ignore"):
        cell = position.astype(np.int32)
    cell += grid.half_window
    cell += (curve * n_padded).astype(np.int32, copy=False)
    n_outside = 0
    if not inside.all():
        known = (curve >= 0) & np.isfinite(position) & np.isfinite(y)
        n_outside = int(np.count_nonzero(known) - np.count_nonzero(inside))
        cell[~inside] = n_cells  # one more, which is cut off: cheaper than to take samples out

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
        # curves end to end are one long row; windows over the end of a curve are left out
        total = run = of_curves.ravel()
        covered = width = 1
        while covered < n_window:
            run, width = run[:-width] + run[width:], 2 * width
            if n_window & width:
                total, covered = total[: run.size - covered] + run[covered:], covered + width
        window[:] = sliding_window_view(total, n_out)[:: sums.shape[-1]]
    return windows


def fit_windows(moments: BranchMoments, *, minimum_count: int) -> LocalFits:
    r"""Slope and value of tension against strain at every bin centre.

    In each window tension is regressed on strain with a quadratic; the slope at
    the bin centre :math:`x_c`, with :math:`u = x - \bar x`, is

    .. math::

        b + c\,\bigl(2 (x_c - \bar x) - S_3 / S_2\bigr),\quad b = S_{uy} / S_2

    where :math:`c` is the regression on the part of :math:`u^2` that the straight
    line leaves.

    Parameters
    ----------
    moments : BranchMoments
        Sums of each curve and bin. [SI]
    minimum_count : int
        Fewest samples in a window that give a slope. [1]

    Returns
    -------
    fits : LocalFits
        Slope per unit strain and tension at the bin centres, with the variances that
        the residuals give. [SI]

    Raises
    ------
    DataError
        If ``minimum_count`` is below 3.

    Notes
    -----
    Samples spread evenly about the centre make the bend drop out: the slope is that
    of a straight line ([2]_ has the same for equal spacing), with the bias
    :math:`E'' W^2 / 40` for a window of width :math:`W`. The bend matters where
    samples are few or the branch ends: a straight line has the slope of the mean
    strain of its samples, not of the bin centre, which in a test logged in step
    with its period is the same error in every cycle.

    NaN where fewer than ``minimum_count`` samples are in the window, where they
    cluster (their variance is below a quarter of an even spread), or where their
    mean lies further than an eighth of the window from the bin centre, as it does
    at the end of a branch. Residual variance is pooled over the windows of a curve.

    Strain noise does not flatten the slope where samples lie closer than the noise,
    since the window is cut on the strain that was read; where they lie further
    apart it does, by noise variance over the variance of strain in the window.

    Examples
    --------
    A straight line comes back, 1000 N per unit strain.

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

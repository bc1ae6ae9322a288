"""Bins of strain of every branch, and the tension at their centres.

References
----------
.. [1] W. H. Press et al., "Numerical Recipes," 3rd ed., 2007, sec. 14.1 (sums in one pass).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import DataError
from reduction.record import Floats, Integers, freeze_arrays

__all__ = ["Cells", "fill_cells", "tension_at_centres"]

# samples further off the centre than this, all on one side with no bin beyond, would be
# extrapolated; half a bin at the turning point has its mean a quarter off
_FURTHEST = 0.3


@dataclass(frozen=True)
class Cells:
    """Moments of the samples of each row and bin; arrays have the shape (n_rows, n_bins).

    ``offset`` and ``spread`` are mean and variance of strain from the bin centre, in bins;
    ``tension`` the mean [N]; ``residual`` the sum of squares about the straight line in the
    bin [N2], with ``freedom`` its degrees of freedom.  NaN and zero where there is no sample.
    """

    count: Floats
    offset: Floats
    spread: Floats
    tension: Floats
    residual: Floats
    freedom: Floats

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def fill_cells(
    strain: Floats, tension: Floats, *, row: Integers, n_rows: int, step: float
) -> tuple[Cells, Floats]:
    """Moments of the samples in each bin, and the centres of the bins.

    Parameters
    ----------
    strain, tension : ndarray, shape (n_samples,)
        Of samples that belong to a row; finite. [1], [N]
    row : ndarray of int, shape (n_samples,)
        Row of each sample, such as a branch of a cycle. [1]
    n_rows : int
        Number of rows. [1]
    step : float
        Width of a bin; centres are whole multiples of it, from zero. [1]

    Returns
    -------
    cells : Cells
        Six moments of each. [SI]
    centre : ndarray, shape (n_bins,)
        From the first bin that was visited to the last. [1]

    Raises
    ------
    DataError
        If no sample has a strain of zero or more.

    Examples
    --------
    >>> cells, centre = fill_cells(
    ...     np.array([0.11, 0.12]), np.array([5.0, 7.0]),
    ...     row=np.array([0, 0]), n_rows=1, step=0.1,
    ... )
    >>> print(centre, cells.count, cells.offset, cells.tension)
    [0.1] [[2.]] [[0.15]] [[6.]]
    """
    place = strain / step
    number = np.rint(place).astype(np.int64)
    inside = number >= 0
    if not inside.all():
        place, number, row, tension = place[inside], number[inside], row[inside], tension[inside]
    if not number.size:
        raise DataError("no sample of a branch has a strain", needed="strains of zero or more")
    first, n_bins = int(number.min()), int(number.max() - number.min()) + 1
    key = row * n_bins + (number - first)
    x = place - number
    reference = float(tension.mean())  # squares keep their digits
    y = tension - reference

    def sums(weights: Floats | None) -> Floats:
        found = np.bincount(key, weights=weights, minlength=n_rows * n_bins)
        return found.reshape(n_rows, n_bins).astype(np.float64)

    count = sums(None)
    n = np.where(count > 0, count, np.nan)
    offset, level = sums(x) / n, sums(y) / n
    spread = np.maximum(sums(x * x) / n - offset**2, 0.0)
    across = sums(x * y) / n - offset * level
    scatter = np.maximum(sums(y * y) / n - level**2, 0.0)
    has_slope = spread > 1e-12
    along = np.where(has_slope, across**2 / np.where(has_slope, spread, 1.0), 0.0)
    freedom = np.where(has_slope, np.maximum(count - 2, 0.0), 0.0)
    residual = np.where(freedom > 0, np.maximum(scatter - along, 0.0) * count, 0.0)
    centre: Floats = np.arange(first, first + n_bins, dtype=np.float64) * step
    return Cells(count, offset, spread, level + reference, residual, freedom), centre


def tension_at_centres(cells: Cells) -> Floats:
    """Tension at the bin centres, by the slope and bend through the neighbouring bins.

    Parameters
    ----------
    cells : Cells
        Moments of rows and bins. [SI]

    Returns
    -------
    tension : ndarray, shape (n_rows, n_bins)
        NaN where there is no sample, or samples on one side of the centre alone. [N]

    Raises
    ------
    Nothing
        An empty bin is NaN.

    Examples
    --------
    Means of a parabola at the means of strain, moved to the centres 0, 1 and 2.

    >>> place = np.array([[0.1, 1.2, 1.9]])
    >>> cells = Cells(
    ...     np.ones((1, 3)), place - [0, 1, 2], np.zeros((1, 3)), place**2,
    ...     np.zeros((1, 3)), np.zeros((1, 3)),
    ... )
    >>> print(tension_at_centres(cells)[0, 1].round(9))
    1.0
    """
    level, offset = cells.tension, cells.offset
    n_rows = level.shape[0]
    beyond = np.full((n_rows, 1), np.nan)
    bins = np.arange(level.shape[1])
    place = bins + offset
    rise = np.diff(level, axis=1) / np.diff(place, axis=1)
    before, after = np.hstack([beyond, rise]), np.hstack([rise, beyond])
    gap_before = np.hstack([beyond, np.diff(place, axis=1)])
    gap_after = np.hstack([np.diff(place, axis=1), beyond])
    both = gap_before + gap_after
    bend = 2 * (after - before) / both
    slope = (before * gap_after + after * gap_before) / both
    is_middle = np.isfinite(slope)
    one_sided = np.where(np.isfinite(before), before, after)
    slope = np.where(is_middle, slope, one_sided)
    bend = np.where(is_middle, bend, 0.0)
    is_alone = ~np.isfinite(slope)
    moved = level - slope * offset + bend / 2 * (offset**2 - cells.spread)
    moved = np.where(is_alone & (np.abs(offset) < 0.05), level, moved)
    is_beside = ~is_middle & (np.abs(offset) > _FURTHEST)
    # the centre lies between these samples and the only neighbour
    inward = np.where(np.isfinite(before), offset > 0, offset < 0)
    return np.where(is_beside & ~inward, np.nan, moved)

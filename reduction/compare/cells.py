"""Bins of strain of every branch, and the tension at their centres.

References
----------
.. [1] W. H. Press et al., "Numerical Recipes," 3rd ed., 2007, sec. 14.1 (sums in one pass).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.compare.measuredcurve import NODES_A_BIN, Reading
from reduction.errors import DataError
from reduction.record import Floats, Integers, read_only_arrays

# a centre further than this beyond the last sample would be extrapolated, not read
_BEYOND = 0.05
# of the range of the samples: a slope from bin to bin is not quite that within the last one
_OUTSIDE = 0.05


@dataclass(frozen=True)
@read_only_arrays
class Cells:
    """Moments of the samples of each row and bin; arrays have the shape (n_rows, n_bins).

    ``offset`` and ``spread`` are mean and variance of strain from the bin centre, in bins, and
    ``nearest`` and ``furthest`` its least and greatest; ``tension`` the mean [N], ``lowest`` and
    ``highest`` the least and greatest; ``residual`` the sum of squares about the straight line in
    the bin [N2], with ``freedom`` its degrees of freedom.  NaN and zero where there is no sample.
    """

    count: Floats
    offset: Floats
    spread: Floats
    nearest: Floats
    furthest: Floats
    tension: Floats
    lowest: Floats
    highest: Floats
    residual: Floats
    freedom: Floats


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
        Moments of each. [SI]
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

    def ends(values: Floats) -> tuple[Floats, Floats]:
        least, most = np.full((2, n_rows * n_bins), np.nan)
        np.fmin.at(least, key, values)
        np.fmax.at(most, key, values)
        return least.reshape(n_rows, n_bins), most.reshape(n_rows, n_bins)

    nearest, furthest = ends(x)
    lowest, highest = ends(y + reference)
    cells = Cells(
        count=count,
        offset=offset,
        spread=spread,
        nearest=nearest,
        furthest=furthest,
        tension=level + reference,
        lowest=lowest,
        highest=highest,
        residual=residual,
        freedom=freedom,
    )
    return cells, centre


def centre_weights(cells: Cells) -> Floats:
    """What the tension at a centre takes from the means of its own bin and of the two beside it.

    Parameters
    ----------
    cells : Cells
        Moments of rows and bins. [SI]

    Returns
    -------
    weight : ndarray, shape (3, n_rows, n_bins)
        Of the bin below, of the bin itself and of the bin above; NaN where the tension at the
        centre cannot be read. [1]

    Raises
    ------
    Nothing
        An empty bin is NaN.

    Notes
    -----
    The tension at a centre is moved there from the means by slope and bend, both of which are
    differences of means: it is linear in them.

    Examples
    --------
    Means of three samples that lie at the centres: the middle one is taken as it is.

    >>> cells, _ = fill_cells(
    ...     np.array([0.1, 0.2, 0.3]), np.zeros(3), row=np.zeros(3, int), n_rows=1, step=0.1
    ... )
    >>> print(np.abs(centre_weights(cells)[:, 0, 1].round(9)))
    [0. 1. 0.]
    """
    level, offset = cells.tension, cells.offset
    beyond = np.full((level.shape[0], 1), np.nan)
    gap = np.diff(np.arange(level.shape[1]) + offset, axis=1)
    before, after = np.hstack([beyond, gap]), np.hstack([gap, beyond])
    has_before, has_after = np.isfinite(before), np.isfinite(after)
    is_middle = has_before & has_after
    both = before + after
    bend = (offset**2 - cells.spread) / 2
    # of the rise from the bin below to this one, and from this one to the bin above
    of_before = np.where(is_middle, -(offset * after + 2 * bend) / both, -offset)
    of_after = np.where(is_middle, -(offset * before - 2 * bend) / both, -offset)
    of_before = np.where(has_before, of_before / before, 0.0)
    of_after = np.where(has_after & (is_middle | ~has_before), of_after / after, 0.0)
    weight = np.stack([-of_before, 1 + of_before - of_after, of_after])
    is_alone = ~has_before & ~has_after
    lowest = np.where(has_before, -np.inf, cells.nearest)
    highest = np.where(has_after, np.inf, cells.furthest)
    is_beyond = (lowest > _BEYOND) | (highest < -_BEYOND)
    is_read = np.isfinite(level) & ~(is_alone & (np.abs(offset) >= _BEYOND)) & ~is_beyond
    return np.asarray(np.where(is_read, weight, np.nan))


def tension_at_centres(cells: Cells) -> Floats:
    """Tension at the bin centres, by the slope and bend through the neighbouring bins.

    Parameters
    ----------
    cells : Cells
        Moments of rows and bins. [SI]

    Returns
    -------
    tension : ndarray, shape (n_rows, n_bins)
        NaN where there is no sample, or samples on one side of the centre alone; between the
        least and the greatest sample of the bin and of those beside it. [N]

    Raises
    ------
    Nothing
        An empty bin is NaN.

    Notes
    -----
    A bend that is not that of the curve (bins far wider than it) moves a mean out of all
    samples; no test measured that, and the value stays among them.

    Examples
    --------
    Samples of a parabola, moved to the centres 0.1, 0.2 and 0.3.

    >>> place = np.linspace(0.0501, 0.3499, 300)
    >>> cells, centre = fill_cells(place, place**2, row=np.zeros(300, int), n_rows=1, step=0.1)
    >>> print(tension_at_centres(cells)[0, 1].round(6))
    0.04
    """
    below, own, above = centre_weights(cells)
    level = cells.tension
    padded = np.pad(np.nan_to_num(level), ((0, 0), (1, 1)))
    moved = below * padded[:, :-2] + own * padded[:, 1:-1] + above * padded[:, 2:]
    low, high = (np.pad(one, ((0, 0), (1, 1)), constant_values=np.nan)
                 for one in (cells.lowest, cells.highest))  # fmt: skip
    least = np.fmin(np.fmin(low[:, :-2], low[:, 1:-1]), low[:, 2:])
    most = np.fmax(np.fmax(high[:, :-2], high[:, 1:-1]), high[:, 2:])
    slack = _OUTSIDE * (most - least)
    return np.asarray(np.clip(moved, least - slack, most + slack))


def reading_of(
    strain: Floats, *, row: Integers, cells: Cells, row_weight: Floats, centre: Floats, step: float
) -> Reading:
    """How a mean of rows was read from the samples, as weights of strains between the centres.

    Parameters
    ----------
    strain : ndarray, shape (n_samples,)
        Of the samples that are in the cells. [1]
    row : ndarray of int, shape (n_samples,)
        Row of each sample. [1]
    cells : Cells
        Moments of rows and bins. [SI]
    row_weight : ndarray, shape (n_rows, n_bins)
        Of each row in the mean at each bin; zero where it is not in it. [1]
    centre : ndarray, shape (n_bins,)
        Of the bins. [1]
    step : float
        Width of a bin. [1]

    Returns
    -------
    reading : Reading
        A smooth curve comes back as it is, a kink as the test shows it. [1]

    Raises
    ------
    Nothing
        A bin without a row reads nothing.

    Examples
    --------
    A straight line is read as it is.

    >>> place, row = np.linspace(0.0, 0.5, 600), np.zeros(600, int)
    >>> cells, centre = fill_cells(place, place, row=row, n_rows=1, step=0.1)
    >>> reading = reading_of(
    ...     place, row=row, cells=cells, row_weight=np.ones((1, 6)), centre=centre, step=0.1
    ... )
    >>> print(reading.of(reading.node).round(9)[1:-1])
    [0.1 0.2 0.3 0.4]
    """
    n_bins, wide = centre.size, 3 * NODES_A_BIN + 1
    number = np.rint(strain / step).astype(np.int64)
    inside = number >= 0
    number, row = number[inside], row[inside]
    of_node = (strain[inside] / step - number + 0.5) * NODES_A_BIN
    place = number - round(float(centre[0]) / step)
    left = np.clip(np.floor(of_node).astype(np.int64), 0, NODES_A_BIN - 1)
    part = of_node - left
    weight = np.zeros(n_bins * wide)
    for side, of_rows in enumerate(centre_weights(cells)):
        # the bin whose tension takes its share from the bin of the sample
        taker = place + 1 - side
        known = (taker >= 0) & (taker < n_bins)
        rows, takers, its = row[known], taker[known], place[known]
        each = np.where(row_weight > 0, np.nan_to_num(of_rows) * row_weight, 0.0)[rows, takers]
        each /= cells.count[rows, its]
        at = takers * wide + side * NODES_A_BIN + left[known]
        for one, share in ((at, 1 - part[known]), (at + 1, part[known])):
            weight += np.bincount(one, weights=each * share, minlength=weight.size)
    node = centre[0] + step * (np.arange((n_bins + 2) * NODES_A_BIN + 1) / NODES_A_BIN - 1.5)
    return Reading(node, weight.reshape(n_bins, wide))

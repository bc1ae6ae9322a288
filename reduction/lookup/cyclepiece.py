"""A piece of a tension-strain curve from chosen cycles of a log.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError
from reduction.lookup.pieces import CurvePiece, PieceBranch
from reduction.record import Floats
from reduction.vocabulary import BRANCH_VALUES

__all__ = ["piece_of_cycles"]

_FEWEST = 2


def piece_of_cycles(
    strain: ArrayLike,
    tension: ArrayLike,
    cycle_number: ArrayLike,
    branch_of_sample: ArrayLike,
    *,
    name: str,
    cycles: tuple[int, int],
    branch: PieceBranch = "mean",
    n_bins: int = 50,
) -> CurvePiece:
    """Mean tension of chosen cycles of a log, as a piece.

    Parameters
    ----------
    strain, tension : array_like, shape (n_samples,)
        Of one specimen; NaN where missing. [1], [N]
    cycle_number : array_like of int, shape (n_samples,)
        Zero outside cycles. [1]
    branch_of_sample : array_like of int, shape (n_samples,)
        1 ascending, 2 descending. [1]
    name : str
        Of the piece.
    cycles : tuple of int
        First and last of them. [1]
    branch : {"ascending", "descending", "mean"}, optional
        Which way.
    n_bins : int, optional
        Over the range of strain. [1]

    Returns
    -------
    piece : CurvePiece
        Mean tension at the centre of each bin that holds three samples or more.

    Raises
    ------
    DataError
        If the series do not pair up, or the cycles have too few samples.

    Notes
    -----
    Each bin gives its mean tension at its mean strain, which lies on a straight line through the
    bin, and is carried to the centre along the curve; the uncertainty is the scatter in the bin
    about the chord of the curve, over the root of the count (type A).  Where the first cycles of
    a test are softer or stiffer than the last ([1]_, sec. 4.1), this chooses which are meant.

    Examples
    --------
    >>> import numpy as np
    >>> up = np.linspace(0.5, 1.0, 500)
    >>> piece = piece_of_cycles(up, 200 * up, np.ones(500), np.ones(500), name="T",
    ...     cycles=(1, 1), branch="ascending", n_bins=5)
    >>> print(piece.strain.round(2), piece.tension.round(3))
    [0.55 0.65 0.75 0.85 0.95] [110. 130. 150. 170. 190.]
    """
    stretch, load, number, way = as_same_shape(
        strain=strain, tension=tension, cycle_number=cycle_number, branch=branch_of_sample
    )
    chosen = (number >= cycles[0]) & (number <= cycles[1]) & np.isfinite(stretch + load)
    if np.count_nonzero(chosen) < 3 * n_bins:
        raise DataError(
            f"cycles {cycles[0]} to {cycles[1]} of {name} are too few samples for {n_bins} bins",
            found=f"{np.count_nonzero(chosen)} samples",
            needed=f"{3 * n_bins} or more",
        )
    low, high = float(stretch[chosen].min()), float(stretch[chosen].max())
    edges = np.linspace(low, high, n_bins + 1)
    centres = (edges[:-1] + edges[1:]) / 2
    wanted = (1, 2) if branch == "mean" else (BRANCH_VALUES[branch],)
    levels, variances = [], []
    for value in wanted:
        taken = chosen & (way == value)
        level, variance = _bins(stretch[taken], load[taken], edges, centres)
        levels.append(level)
        variances.append(variance)
    mean = np.mean(levels, axis=0)
    spread = np.sqrt(np.sum(variances, axis=0)) / len(wanted)
    with np.errstate(invalid="ignore"):
        known = np.isfinite(mean) & (mean > 0) & (centres > 0)
    return CurvePiece(name, "cyclic", branch, centres[known], mean[known], spread[known])


def _bins(strain: Floats, tension: Floats, edges: Floats, centres: Floats) -> tuple[Floats, Floats]:
    """Mean tension at the centre of each bin, and its variance; NaN below three samples."""
    n = centres.size
    place = np.clip(np.searchsorted(edges, strain, side="right") - 1, 0, n - 1)
    count = np.bincount(place, minlength=n).astype(np.float64)
    count[count < 3] = np.nan
    mean_strain = np.bincount(place, strain, n) / count
    mean_tension = np.bincount(place, tension, n) / count
    level, variance = np.full((2, n), np.nan)
    held = np.flatnonzero(np.isfinite(count))
    if held.size < _FEWEST:
        return level, variance
    slope = np.gradient(mean_tension[held], mean_strain[held])
    level[held] = mean_tension[held] + slope * (centres[held] - mean_strain[held])
    slopes: Floats = np.zeros(n)
    slopes[held] = slope
    off = tension - mean_tension[place] - slopes[place] * (strain - mean_strain[place])
    squares = np.bincount(place, np.nan_to_num(off) ** 2, n)
    variance[held] = squares[held] / (count[held] - 2) / count[held]
    return level, variance

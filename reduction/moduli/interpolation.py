"""A curve on bins, read between them.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def curve_at(
    strain: ArrayLike, strain_bin: ArrayLike, values: ArrayLike, *, spacing: float | None
) -> Floats:
    """Values of a curve between its bins, by straight lines; nothing is extrapolated.

    What is read at a strain anywhere, in a look-up, a budget, a table or a ratio, is read by this.

    Parameters
    ----------
    strain : array_like, shape (n,)
        Where the curve is wanted. [1]
    strain_bin : array_like, shape (n_bins,)
        Bin centres, or other points of an axis, increasing. [1]
    values : array_like, shape (n_bins,)
        The curve, NaN where not supported. [SI]
    spacing : float or None
        Distance of neighbouring bins; a gap wider than half as much again is not
        bridged. None where any gap is. [1]

    Returns
    -------
    at_strain : ndarray, shape (n,)
        NaN outside the curve and in its gaps. [SI]

    Raises
    ------
    DataError
        If the curve does not have a value a bin.

    Examples
    --------
    >>> nan = float("nan")
    >>> print(curve_at([0.5, 1.5, 4.0], [0.0, 1.0, 2.0, 3.0], [1.0, 3.0, nan, 5.0], spacing=1.0))
    [ 2. nan nan]
    """
    wanted = np.asarray(strain, dtype=np.float64)
    bins, curve = (np.asarray(series, dtype=np.float64) for series in (strain_bin, values))
    if bins.shape != curve.shape or bins.ndim != 1:
        raise DataError(
            "a curve needs a value a bin", found=f"{curve.shape}", needed=f"{bins.shape}"
        )
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

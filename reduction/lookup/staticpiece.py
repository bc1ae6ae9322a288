"""Pieces of a tension-strain curve from tests that hardly move: weights both ways, a slow pull.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8, Table 4.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError
from reduction.lookup.pieces import CurvePiece

__all__ = ["mean_piece", "piece_of_pull"]

_FEWEST = 2


def mean_piece(ascending: CurvePiece, descending: CurvePiece) -> CurvePiece:
    """Mean of both branches of a static test, where both were read.

    Parameters
    ----------
    ascending, descending : CurvePiece
        Of one test.

    Returns
    -------
    piece : CurvePiece
        On the strains of both that lie between the ends of both. [SI]

    Raises
    ------
    DataError
        If the branches do not overlap.

    Notes
    -----
    Straight lines between the rows.  Neither way of the loop, as that of `pieces_of_branches`.

    Examples
    --------
    >>> at = np.array([0.5, 1.0, 1.5])
    >>> up = CurvePiece("T", "static", "ascending", at, np.array([60.0, 110.0, 150.0]), 0 * at)
    >>> down = CurvePiece("T", "static", "descending", at, np.array([40.0, 90.0, 150.0]), 0 * at)
    >>> mean_piece(up, down).tension
    array([ 50., 100., 150.])
    """
    low = max(ascending.strain[0], descending.strain[0])
    high = min(ascending.strain[-1], descending.strain[-1])
    nodes = np.union1d(ascending.strain, descending.strain)
    nodes = nodes[(nodes >= low) & (nodes <= high)]
    if nodes.size < _FEWEST:
        raise DataError(
            f"the branches of {ascending.name} do not overlap",
            found=f"{ascending.strain[0]:.4g} to {ascending.strain[-1]:.4g} and "
            f"{descending.strain[0]:.4g} to {descending.strain[-1]:.4g}",
            needed="strains that both of them reach",
        )
    load, spread = (
        [np.interp(nodes, one.strain, getattr(one, name)) for one in (ascending, descending)]
        for name in ("tension", "standard_uncertainty")
    )
    return CurvePiece(
        ascending.name, ascending.kind, "mean", nodes, (load[0] + load[1]) / 2,
        np.hypot(spread[0], spread[1]) / 2,
    )  # fmt: skip


def piece_of_pull(
    strain: ArrayLike, tension: ArrayLike, strain_uncertainty: ArrayLike, *, name: str
) -> CurvePiece:
    r"""Slow pull as a piece: strain was fitted over tension, the uncertainty is turned over.

    .. math:: u(T) = u(\varepsilon) \, \frac{d T}{d \varepsilon}

    Parameters
    ----------
    strain : array_like, shape (n,)
        Of the fit, on a grid of tension; NaN where not known. [1]
    tension : array_like, shape (n,)
        The grid, rising. [N]
    strain_uncertainty : array_like, shape (n,)
        Standard, of the strain. [1]
    name : str
        Of the piece.

    Returns
    -------
    piece : CurvePiece
        Where strain and tension are above zero, up to where the fit turns back. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, or fewer than two points are left.

    Notes
    -----
    A slow pull ([2]_) is a static test that only rises; the loads of [1]_ were hung.

    Examples
    --------
    >>> load = np.array([100.0, 200.0, 300.0])
    >>> piece = piece_of_pull([0.01, 0.02, 0.03], load, [1e-4, 1e-4, 1e-4], name="Q01")
    >>> piece.standard_uncertainty
    array([1., 1., 1.])
    """
    stretch, load, spread = as_same_shape(
        strain=strain, tension=tension, strain_uncertainty=strain_uncertainty
    )
    kept = np.isfinite(stretch + load + spread) & (stretch > 0) & (load > 0)
    stretch, load, spread = stretch[kept], load[kept], spread[kept]
    back = np.flatnonzero(np.diff(stretch) <= 0)
    end = int(back[0]) + 1 if back.size else stretch.size
    stretch, load, spread = stretch[:end], load[:end], spread[:end]
    if stretch.size < _FEWEST:
        raise DataError(f"{name} is no curve", found=f"{stretch.size} points")
    slope = np.gradient(load, stretch)
    return CurvePiece(name, "static", "ascending", stretch, load, spread * slope)

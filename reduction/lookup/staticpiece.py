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

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError
from reduction.lookup.pieces import CurvePiece
from reduction.moduli.stepwise import StepwiseResult
from reduction.uncertainty.join import stacked
from reduction.uncertainty.product import Component, Contributions
from reduction.vocabulary import BRANCH_VALUES

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
    Straight lines between the rows.  What both branches share is in their mean as it is.  Neither
    of the loop, as that of `pieces_of_branches`.

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
        for name in ("tension", "random_standard_uncertainty")
    )
    both = stacked([one.shared_at(nodes) for one in (ascending, descending)])
    return CurvePiece(
        ascending.name, ascending.kind, "mean", nodes, (load[0] + load[1]) / 2,
        np.hypot(spread[0], spread[1]) / 2, both.component, both.values["tension"].mean(axis=1),
    )  # fmt: skip


def piece_of_pull(
    strain: ArrayLike,
    tension: ArrayLike,
    strain_uncertainty: ArrayLike,
    *,
    name: str,
    shared: Contributions | None = None,
) -> CurvePiece:
    r"""Slow pull as a piece: strain was fitted over tension, the uncertainty is turned over.

    .. math:: u(T) = u(\varepsilon) \, \frac{d T}{d \varepsilon}, \qquad
        c_k(T) = -c_k(\varepsilon) \, \frac{d T}{d \varepsilon}

    Parameters
    ----------
    strain : array_like, shape (n,)
        Of the fit, on a grid of tension; NaN where not known. [1]
    tension : array_like, shape (n,)
        The grid, rising. [N]
    strain_uncertainty : array_like, shape (n,)
        Standard, of the strain, by what is of this pull alone. [1]
    name : str
        Of the piece.
    shared : Contributions, optional
        To ``strain`` at the tensions of the grid, shape (n_components, n). [1]

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
    >>> piece.random_standard_uncertainty
    array([1., 1., 1.])
    """
    stretch, load, spread = as_same_shape(
        strain=strain, tension=tension, strain_uncertainty=strain_uncertainty
    )
    kept = np.isfinite(stretch + load + spread) & (stretch > 0) & (load > 0)
    known = shared or Contributions((), {"strain": np.empty((0, kept.size))})
    rows = np.nan_to_num(known.values["strain"])[:, kept]
    stretch, load, spread = stretch[kept], load[kept], spread[kept]
    back = np.flatnonzero(np.diff(stretch) <= 0)
    end = int(back[0]) + 1 if back.size else stretch.size
    stretch, load, spread, rows = stretch[:end], load[:end], spread[:end], rows[:, :end]
    if stretch.size < _FEWEST:
        raise DataError(f"{name} is no curve", found=f"{stretch.size} points")
    slope = np.gradient(load, stretch)
    # more strain at one tension is less tension at one strain
    return CurvePiece(
        name, "static", "ascending", stretch, load, spread * slope, known.component, -rows * slope
    )


def piece_of_steps(
    steps: StepwiseResult,
    *,
    name: str,
    branch: Literal["ascending", "descending"] = "ascending",
    shared: Contributions | None = None,
) -> CurvePiece:
    r"""One branch of a static test as a piece.

    .. math:: u(T) = T \, u(E_s) / E_s, \qquad c_k(T) = T \, c_k(E_s) / E_s

    Parameters
    ----------
    steps : StepwiseResult
        Weights and lengths. [SI]
    name : str
        Of the piece.
    branch : {"ascending", "descending"}, optional
        Weights added or taken off.
    shared : Contributions, optional
        To ``secant_modulus``, shape (n_components, n_steps). [Pa]

    Returns
    -------
    piece : CurvePiece
        Rows that contradict themselves, and rows that do not rise in strain, are left out.

    Raises
    ------
    DataError
        If fewer than two rows are left.

    Notes
    -----
    The relative uncertainty is that of the secant modulus E_s: of the weight and of the reading
    of the length.  The diameter is in the modulus and in no tension.  Table 4 of [1]_ has a row
    of each kind that is left out.

    Examples
    --------
    See `tests/unit/test_lookup_staticpiece.py`, which reads Table 4 of [1]_.
    """
    kept = (steps.branch == BRANCH_VALUES[branch]) & ~steps.is_inconsistent
    with np.errstate(invalid="ignore", divide="ignore"):
        share = steps.secant_modulus_standard_uncertainty / steps.secant_modulus
    order = np.flatnonzero(kept & (steps.strain > 0) & (steps.tension > 0))
    order = order[np.argsort(steps.strain[order], kind="stable")]
    strain = steps.strain[order]
    order = order[np.concatenate([[True], np.diff(strain) > 0])[: strain.size]]
    tension = steps.tension[order]
    component: tuple[Component, ...] = ()
    rows = np.empty((0, order.size))
    if shared is not None:
        kinds = [one.source != "diameter" for one in shared.component]
        component = tuple(np.array(shared.component, dtype=object)[kinds])
        rows = shared.values["secant_modulus"][kinds][:, order]
        rows = np.nan_to_num(rows / steps.secant_modulus[order] * tension)
    return CurvePiece(
        name, "static", branch, steps.strain[order], tension,
        np.nan_to_num(share[order] * tension), component, rows,
    )  # fmt: skip

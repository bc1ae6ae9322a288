"""Pieces of a tension-strain curve, from cyclic windows, first pulls and static tests.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4, Figures 21, 31, 35.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_increasing, as_same_shape
from reduction.errors import DataError, SettingsError
from reduction.moduli.product import ModulusCurves
from reduction.moduli.stepwise import StepwiseResult
from reduction.record import Bools, Floats, freeze_arrays
from reduction.vocabulary import BRANCH_NAMES, BRANCH_VALUES

__all__ = [
    "CurvePiece",
    "PieceBranch",
    "PieceKind",
    "piece_of_steps",
    "pieces_of_branches",
    "pieces_of_curves",
]

PieceKind = Literal["cyclic", "static", "first-loading"]
PieceBranch = Literal["ascending", "descending", "mean"]
_FEWEST = 2
_KIND_WORDS = {"cyclic": "cycles", "static": "static", "first-loading": "first loading"}


@dataclass(frozen=True)
class CurvePiece:
    """Tension against strain over one unbroken range of one test.

    Parameters
    ----------
    name : str
        Which test and specimen.
    kind : {"cyclic", "static", "first-loading"}
        Mean of the cycles of a window, weights hung one after another, or the first rise.
    branch : {"ascending", "descending", "mean"}
        Of it; the mean is that of both at one strain.
    strain : ndarray, shape (n,)
        Rising, above zero. [1]
    tension : ndarray, shape (n,)
        Above zero. [N]
    standard_uncertainty : ndarray, shape (n,)
        Of the tension, type A; zero where not known. [N]
    """

    name: str
    kind: PieceKind
    branch: PieceBranch
    strain: Floats
    tension: Floats
    standard_uncertainty: Floats

    @property
    def words(self) -> str:
        """Which test, and which part of it."""
        return f"{self.name} {_KIND_WORDS[self.kind]}"

    def __post_init__(self) -> None:
        """Check that it is a curve, and make the arrays read-only."""
        freeze_arrays(self)
        as_same_shape(
            strain=self.strain, tension=self.tension, uncertainty=self.standard_uncertainty
        )
        as_increasing(f"strain of {self.name}", self.strain)
        as_finite(f"tension of {self.name}", self.tension)
        if self.strain.size < _FEWEST:
            raise DataError(f"{self.name} is no curve", found=f"{self.strain.size} points")
        if self.strain[0] <= 0 or self.tension.min() <= 0:
            raise DataError(
                f"{self.name} holds points that are slack",
                found=f"strain {self.strain[0]:.4g}, tension {self.tension.min():.4g} N",
                needed="strain and tension above zero",
            )
        as_finite(f"uncertainty of {self.name}", self.standard_uncertainty)
        if (self.standard_uncertainty < 0).any():
            raise DataError(
                f"an uncertainty of {self.name} is negative",
                found=f"{self.standard_uncertainty.min():.4g} N",
                needed="zero or above",
            )


def _runs(known: Bools) -> list[tuple[int, int]]:
    """First and past-the-last index of each unbroken run of two points or more."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(np.int8)))
    pairs = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    return [(first, stop) for first, stop in pairs if stop - first >= _FEWEST]


def pieces_of_branches(
    strain: ArrayLike,
    tension: ArrayLike,
    standard_uncertainty: ArrayLike,
    *,
    name: str,
    branch: PieceBranch = "mean",
    kind: Literal["cyclic", "first-loading"] = "cyclic",
) -> tuple[CurvePiece, ...]:
    """Tension of both branches on one grid of strain, as an archive holds it, as pieces.

    Parameters
    ----------
    strain : array_like, shape (n,)
        Rising. [1]
    tension, standard_uncertainty : array_like, shape (2, n)
        Ascending, then descending; NaN where not known. [N]
    name : str
        Of the pieces.
    branch : {"ascending", "descending", "mean"}, optional
        A first rise has only the first one.
    kind : {"cyclic", "first-loading"}, optional
        What the curves are.

    Returns
    -------
    pieces : tuple of CurvePiece
        One for each range without a gap; none where nothing is known.

    Raises
    ------
    SettingsError
        If another branch than the ascending one is asked of a first rise.
    DataError
        If there are not two branches on the grid, or strain does not rise.

    Notes
    -----
    The mean branch runs through the middle of the loop ([1]_, Figure 21): it is neither way of
    the loop, and has no tangent modulus that was measured.  Points that are slack are left out.

    Examples
    --------
    >>> load = [[10.0, 20.0, 30.0], [6.0, 18.0, 30.0]]
    >>> piece, = pieces_of_branches([0.1, 0.2, 0.3], load, np.ones((2, 3)), name="T-1 new")
    >>> piece.tension
    array([ 8., 19., 30.])
    """
    if kind == "first-loading" and branch != "ascending":
        raise SettingsError("a first rise only rises", found=branch, needed="branch = ascending")
    grid = as_increasing("strain", strain)
    load, spread = as_same_shape(tension=tension, standard_uncertainty=standard_uncertainty)
    if load.shape != (2, grid.size):
        raise DataError(
            "tension is not that of two branches on the grid of strain",
            found=f"shape {load.shape}",
            needed=f"(2, {grid.size})",
        )
    if branch == "mean":
        level, uncertainty = load.mean(axis=0), np.hypot(spread[0], spread[1]) / 2
    else:
        row = BRANCH_NAMES.index(branch)
        level, uncertainty = load[row], spread[row]
    with np.errstate(invalid="ignore"):
        known = np.isfinite(uncertainty) & (level > 0) & (grid > 0)
    return tuple(
        CurvePiece(name, kind, branch, grid[low:high], level[low:high], uncertainty[low:high])
        for low, high in _runs(known)
    )


def pieces_of_curves(
    curves: ModulusCurves,
    specimen: int,
    *,
    name: str,
    branch: PieceBranch = "mean",
    kind: Literal["cyclic", "first-loading"] = "cyclic",
) -> tuple[CurvePiece, ...]:
    """Mean tension of the cycles of one test, or of its first rise, as pieces.

    Parameters
    ----------
    curves : ModulusCurves
        Of a test. [SI]
    specimen : int
        Row. [1]
    name, branch, kind
        As `pieces_of_branches`.

    Returns
    -------
    pieces : tuple of CurvePiece
        As `pieces_of_branches`.

    Raises
    ------
    SettingsError
        As `pieces_of_branches`.

    Notes
    -----
    ``branch_tension`` with its type A uncertainty: a modulus alone leaves tension unknown ([1]_).

    Examples
    --------
    See `tests/oracle/test_composite_truth.py`.
    """
    return pieces_of_branches(
        curves.strain_bin,
        curves.branch_tension[specimen],
        curves.branch_tension_standard_uncertainty[specimen],
        name=name,
        branch=branch,
        kind=kind,
    )


def piece_of_steps(
    steps: StepwiseResult, *, name: str, branch: Literal["ascending", "descending"] = "ascending"
) -> CurvePiece:
    r"""One branch of a static test as a piece.

    .. math:: u(T) = T \, u(E_s) / E_s

    Parameters
    ----------
    steps : StepwiseResult
        Weights and lengths. [SI]
    name : str
        Of the piece.
    branch : {"ascending", "descending"}, optional
        Weights added or taken off.

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
    of the length (type A).  Table 4 of [1]_ has a row of each kind that is left out.

    Examples
    --------
    See `tests/unit/test_lookup_pieces.py`, which reads Table 4 of [1]_.
    """
    kept = (steps.branch == BRANCH_VALUES[branch]) & ~steps.is_inconsistent
    with np.errstate(invalid="ignore", divide="ignore"):
        share = steps.secant_modulus_standard_uncertainty / steps.secant_modulus
    order = np.flatnonzero(kept & (steps.strain > 0) & (steps.tension > 0))
    order = order[np.argsort(steps.strain[order], kind="stable")]
    strain = steps.strain[order]
    order = order[np.concatenate([[True], np.diff(strain) > 0])[: strain.size]]
    tension = steps.tension[order]
    return CurvePiece(
        name, "static", branch, steps.strain[order], tension,
        np.nan_to_num(share[order] * tension),
    )  # fmt: skip

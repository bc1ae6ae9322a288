"""Pieces of a tension-strain curve, from cyclic windows and first pulls.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4, Figures 21, 31, 35.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_increasing, as_same_shape
from reduction.errors import DataError, SettingsError
from reduction.record import Bools, Floats, read_only_arrays
from reduction.uncertainty.product import Component, Contributions
from reduction.vocabulary import BRANCH_NAMES

PieceKind = Literal["cyclic", "static", "first-loading"]
PieceBranch = Literal["ascending", "descending", "mean"]
_FEWEST = 2
_KIND_WORDS = {"cyclic": "cycles", "static": "static", "first-loading": "first loading"}


@dataclass(frozen=True)
@read_only_arrays
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
    random_standard_uncertainty : ndarray, shape (n,)
        Of the tension, by what is of this piece alone: scatter of its cycles, readings; zero where
        not known. [N]
    component : tuple of Component, length n_components
        Errors that the piece shares with others: of its load cell, its crosshead, its marks.
    contribution : ndarray, shape (n_components, n)
        What each of them adds to the tension, signed. [N]
    """

    name: str
    kind: PieceKind
    branch: PieceBranch
    strain: Floats
    tension: Floats
    random_standard_uncertainty: Floats
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 1)))

    @property
    def words(self) -> str:
        """Which test, and which part of it."""
        return f"{self.name} {_KIND_WORDS[self.kind]}"

    def __post_init__(self) -> None:
        """Check that it is a curve, and make the arrays read-only."""
        as_same_shape(
            strain=self.strain, tension=self.tension, uncertainty=self.random_standard_uncertainty
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
        as_finite(f"uncertainty of {self.name}", self.random_standard_uncertainty)
        if (self.random_standard_uncertainty < 0).any():
            raise DataError(
                f"an uncertainty of {self.name} is negative",
                found=f"{self.random_standard_uncertainty.min():.4g} N",
                needed="zero or above",
            )
        rows = (len(self.component), self.strain.size)
        if self.component and self.contribution.shape != rows:
            raise DataError(
                f"contributions to {self.name} do not fit its errors and points",
                found=f"shape {self.contribution.shape}",
                needed=f"{rows}",
            )
        as_finite(f"contributions to {self.name}", self.contribution)

    def shared_at(self, strain: Floats) -> Contributions:
        """Contributions to ``tension`` [N] at strains [1]; beyond an end those of the end."""
        rows = [np.interp(strain, self.strain, row) for row in self.contribution]
        table = np.array(rows).reshape(len(self.component), strain.size)
        return Contributions(self.component, {"tension": table})


def _runs(known: Bools) -> list[tuple[int, int]]:
    """First and past-the-last index of each unbroken run of two points or more."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(np.int8)))
    pairs = zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
    return [(first, stop) for first, stop in pairs if stop - first >= _FEWEST]


def pieces_of_branches(
    strain: ArrayLike,
    tension: ArrayLike,
    random_standard_uncertainty: ArrayLike,
    *,
    name: str,
    branch: PieceBranch = "mean",
    kind: Literal["cyclic", "first-loading"] = "cyclic",
    shared: Contributions | None = None,
) -> tuple[CurvePiece, ...]:
    """Tension of both branches on one grid of strain, as an archive holds it, as pieces.

    Parameters
    ----------
    strain : array_like, shape (n,)
        Rising. [1]
    tension, random_standard_uncertainty : array_like, shape (2, n)
        Ascending, then descending; NaN where not known. [N]
    name : str
        Of the pieces.
    branch : {"ascending", "descending", "mean"}, optional
        A first rise has only the first one.
    kind : {"cyclic", "first-loading"}, optional
        What the curves are.
    shared : Contributions, optional
        To ``tension``, shape (n_components, 2, n); NaN where nothing is known adds nothing. [N]

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
    the loop, and has no tangent modulus that was measured.  What both branches share is in their
    mean as it is, by its sign; what scatters is less by the root of 2.  Points that are slack are
    left out.

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
    load, spread = as_same_shape(
        tension=tension, random_standard_uncertainty=random_standard_uncertainty
    )
    if load.shape != (2, grid.size):
        raise DataError(
            "tension is not that of two branches on the grid of strain",
            found=f"shape {load.shape}",
            needed=f"(2, {grid.size})",
        )
    known_errors = shared or Contributions((), {"tension": np.empty((0, 2, grid.size))})
    moved = np.nan_to_num(known_errors.values["tension"])
    if branch == "mean":
        level, uncertainty = load.mean(axis=0), np.hypot(spread[0], spread[1]) / 2
        rows = moved.mean(axis=1)
    else:
        row = BRANCH_NAMES.index(branch)
        level, uncertainty, rows = load[row], spread[row], moved[:, row]
    with np.errstate(invalid="ignore"):
        known = np.isfinite(uncertainty) & (level > 0) & (grid > 0)
    return tuple(
        CurvePiece(
            name,
            kind,
            branch,
            grid[low:high],
            level[low:high],
            uncertainty[low:high],
            known_errors.component,
            rows[:, low:high],
        )
        for low, high in _runs(known)
    )

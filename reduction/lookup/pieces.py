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
    "piece_of_cycles",
    "piece_of_steps",
    "pieces_of_branches",
    "pieces_of_curves",
]

PieceKind = Literal["cyclic", "static", "first-loading"]
PieceBranch = Literal["ascending", "descending", "mean"]
_FEWEST = 2


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

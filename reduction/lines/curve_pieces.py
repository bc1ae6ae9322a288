"""Pieces of a tension-strain curve: cyclic windows, first pulls, static tests.

Pieces of a tension-strain curve, from cyclic windows and first pulls.

How pieces of a tension-strain curve become one: which kind goes first, and how they fade.

Pieces of a tension-strain curve from tests that hardly move: weights both ways, a slow pull.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4, Figures 21, 31, 35.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8, Table 4.
.. [3] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.quantities.names import BRANCH_NAMES, BRANCH_VALUES
from reduction.record.arrays import as_finite, as_increasing, as_same_shape
from reduction.record.contributions import Component, Contributions, stacked
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.stages.moduli.stepwise_test import StepwiseResult

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


_KINDS: tuple[PieceKind, ...] = ("cyclic", "static", "first-loading")


@dataclass(frozen=True)
class CompositeRule:
    """How pieces become one curve.

    Parameters
    ----------
    precedence : tuple of str
        Kinds, the one that counts first where it exists; kinds that are not named are not used.
    taper : float
        Share of a piece, at each end, over which its weight falls to zero; 0.5 makes the weight
        a triangle over the whole piece.
    least_slope : float
        Share b of the least slope of the pieces there, below which that of the curve may not
        fall: 0 lets it run level where pieces fall, 1 keeps every slope and moves levels more.
    n_points : int
        Of the grid over all pieces; ends of pieces are added.
    """

    precedence: tuple[PieceKind, ...] = _KINDS
    taper: float = 0.5
    least_slope: float = 0.5
    n_points: int = 401

    def __post_init__(self) -> None:
        """Refuse a rule that cannot be followed."""
        if not self.precedence or set(self.precedence) - set(_KINDS):
            raise SettingsError(
                "the precedence names no kind of piece",
                found=", ".join(self.precedence) or "nothing",
                needed="of " + ", ".join(_KINDS),
            )
        if len(set(self.precedence)) < len(self.precedence):
            raise SettingsError(
                "the precedence names a kind twice", found=", ".join(self.precedence)
            )
        if not 0 < self.taper <= 0.5:
            raise SettingsError(
                "the taper is a share of a piece", found=f"{self.taper:g}", needed="above 0, to 0.5"
            )
        if not 0 <= self.least_slope <= 1:
            raise SettingsError(
                "the least slope is a share of that of the pieces",
                found=f"{self.least_slope:g}",
                needed="0 to 1",
            )
        if self.n_points < 2:
            raise SettingsError("a grid has two points", found=str(self.n_points))


def mean_piece(ascending: CurvePiece, descending: CurvePiece) -> CurvePiece:
    """Mean of both branches of a static test, where both were read.

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

    Notes
    -----
    A slow pull ([3]_) is a static test that only rises; the loads of [2]_ were hung.

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

    Notes
    -----
    The relative uncertainty is that of the secant modulus E_s: of the weight and of the reading
    of the length.  The diameter is in the modulus and in no tension.  Table 4 of [2]_ has a row
    of each kind that is left out.

    Examples
    --------
    See `tests/unit/test_lookup_staticpiece.py`, which reads Table 4 of [2]_.
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

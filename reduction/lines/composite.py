r"""Pieces of a tension-strain curve from many tests, and one rising curve through them.

**Difference between pieces of a tension-strain curve, and the part that their errors explain**:

.. math:: d = \frac{T_1 - T_2}{\bar T}, \qquad
          u^2(d) = \frac{u_1^2 + u_2^2}{\bar T^2}
              + \sum_k \Bigl(\frac{c_{1k} T_2 - c_{2k} T_1}{\bar T^2}\Bigr)^2

with the mean of both tensions, the random part u of each and the contribution c_k of each error
that they share.  A gain of one load cell is in both and cancels: it explains no difference.

**One monotone curve of tension against strain, from zero, from many tests.** The curve y is the
rising curve that is nearest to all pieces T_i:

.. math:: \min_y \int \sum_i w_i(\varepsilon)\,(y - T_i)^2\,d\varepsilon, \quad
   y' \ge b\,\min_i T_i', \qquad w_i = \frac{h_i\,g_i}{u_i^2 + (s\,\bar T)^2}

u_i is the uncertainty of a piece without the part that all pieces share, s the relative deviation
between pieces of its kind where they overlap.  h_i falls to zero towards the ends of a piece, and
g_i where a kind of higher precedence takes over.  Without the constraint y is the weighted mean.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4, Figures 21, 31, 35; sec. 4.8, Table 4; Figure 35;
   sec. 4.8, Figures 31, 35.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2.
.. [3] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3 (correlation by common influence quantities).
.. [4] R. E. Barlow, D. J. Bartholomew, J. M. Bremner and H. D. Brunk, "Statistical Inference under
   Order Restrictions," Wiley, 1972 (isotonic regression, and with bounds).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.lines.cycle_stiffness import LineLoop, LoadedTest
from reduction.quantities.flags import BRANCH_VALUES
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.arrays import as_finite, as_increasing, as_same_shape, runs_of_true
from reduction.record.contributions import (
    Component,
    Contributions,
    combined_standard_uncertainty,
    stacked,
)
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.strain.strain_model import StrainModel

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
        Test and specimen.
    kind : {"cyclic", "static", "first-loading"}
        Mean of the cycles of a window, loading by hung weights, or the first loading.
    branch : {"ascending", "descending", "mean"}
        Branch of the loop; "mean" is the mean of both branches at one strain.
    strain : ndarray, shape (n,)
        Increasing, above zero. [1]
    tension : ndarray, shape (n,)
        Above zero. [N]
    random_standard_uncertainty : ndarray, shape (n,)
        Part of the uncertainty of the tension that is independent of all other pieces (scatter of
        the cycles, readings); zero where not known. [N]
    component : tuple of Component, length n_components
        Errors that the piece shares with others: of its load cell, crosshead and marks.
    contribution : ndarray, shape (n_components, n)
        Signed contribution of each shared error to the tension. [N]
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
        """Test, and part of it."""
        return f"{self.name} {_KIND_WORDS[self.kind]}"

    def __post_init__(self) -> None:
        """Check that this is a curve, and make the arrays read-only."""
        as_same_shape(
            strain=self.strain, tension=self.tension, uncertainty=self.random_standard_uncertainty
        )
        as_increasing(f"strain of {self.name}", self.strain)
        as_finite(f"tension of {self.name}", self.tension)
        if self.strain.size < _FEWEST:
            raise DataError(f"{self.name} is not a curve", found=f"{self.strain.size} points")
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
        """Contributions to ``tension`` [N] at strains [1]; constant beyond the ends."""
        rows = [np.interp(strain, self.strain, row) for row in self.contribution]
        table = np.array(rows).reshape(len(self.component), strain.size)
        return Contributions(self.component, {"tension": table})


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
    """Tension of both branches on one grid of strain, as stored in an archive, as pieces.

    Notes
    -----
    The mean branch runs through the middle of the loop ([1]_, Figure 21).  It is neither branch of
    the loop, so no tangent modulus was measured for it.  Shared errors enter the mean with their
    sign; the scatter of the mean is smaller by the root of 2.  Slack points are left out.

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
        for low, high in runs_of_true(known)
        if high - low >= _FEWEST
    )


_KINDS: tuple[PieceKind, ...] = ("cyclic", "static", "first-loading")

TAPER = 0.5
"""Share of a piece, at each end, over which its weight falls to zero: a triangle over all of it."""

LEAST_SLOPE = 0.5
"""Of the least slope of the pieces there: 0 would let the curve run level where pieces fall, and
1 keep every slope and move levels more."""

_GRID_POINTS = 401  # over all pieces; ends of pieces are added


@dataclass(frozen=True)
class CompositeRule:
    """How pieces become one curve.

    Parameters
    ----------
    precedence : tuple of str
        Kinds, highest precedence first; kinds that are not named are not used.
    """

    precedence: tuple[PieceKind, ...] = _KINDS

    def __post_init__(self) -> None:
        """Refuse a rule that cannot be followed."""
        if not self.precedence or set(self.precedence) - set(_KINDS):
            raise SettingsError(
                "the precedence names no known kind of piece",
                found=", ".join(self.precedence) or "nothing",
                needed="of " + ", ".join(_KINDS),
            )
        if len(set(self.precedence)) < len(self.precedence):
            raise SettingsError(
                "the precedence names a kind twice", found=", ".join(self.precedence)
            )


def mean_piece(ascending: CurvePiece, descending: CurvePiece) -> CurvePiece:
    """Mean of both branches of a static test, where both were measured.

    Notes
    -----
    Straight lines between the rows.  Shared errors enter the mean with their sign.  It is neither
    branch of the loop, as in `pieces_of_branches`.

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
    r"""Slow pull as a piece: strain was fitted over tension, so its uncertainty is converted.

    .. math:: u(T) = u(\varepsilon) \, \frac{d T}{d \varepsilon}, \qquad
        c_k(T) = -c_k(\varepsilon) \, \frac{d T}{d \varepsilon}

    Notes
    -----
    A slow pull ([2]_) is a static test that only loads; in [1]_, sec. 4.8, Table 4, weights were
    hung.

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
        raise DataError(f"{name} is not a curve", found=f"{stretch.size} points")
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
    The relative uncertainty is that of the secant modulus E_s, from the weight and the reading
    of the length.  The diameter enters the modulus but not the tension.  Table 4 of [1]_ has a
    row of each kind that is left out.

    Examples
    --------
    See `tests/unit/test_lookup_staticpiece.py`, which reads Table 4 of [1]_.
    """
    kept = (steps.branch == BRANCH_VALUES[branch]) & ~steps.is_inconsistent & ~steps.is_odd
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


def _between_pieces(
    pieces: Sequence[CurvePiece], tension: Floats, variance: Floats, rows: Floats, known: Bools
) -> dict[PieceKind, float]:
    """Relative deviation between pieces of each kind, by pairs, less the part due to their errors.

    Notes
    -----
    First order in the errors (see the module).  Never below zero: it is zero where the errors
    explain the differences ([1]_, Figure 35 shows some that they do not).

    Examples
    --------
    Two pieces 10 % apart, with one cell, and with two cells that may each be off by 7 %:

    >>> at = np.array([0.5, 1.0])
    >>> load = np.array([95 * at, 105 * at])
    >>> two = [CurvePiece("T", "cyclic", "mean", at, one, 0 * at) for one in load]
    >>> seen = np.ones((2, 2), dtype=bool)
    >>> one_cell, two_cells = 0.07 * load[None], 0.07 * load * np.eye(2)[:, :, None]
    >>> for rows in (one_cell, two_cells):
    ...     print(round(_between_pieces(two, load, 0 * load, rows, seen)["cyclic"], 4))
    0.0707
    0.0112
    """
    found = {one.kind: 0.0 for one in pieces}
    count = dict.fromkeys(found, 0)
    for first, one in enumerate(pieces):
        for second in range(first + 1, len(pieces)):
            both = known[first] & known[second]
            if pieces[second].kind != one.kind or np.count_nonzero(both) < 2:
                continue
            load, other = tension[first, both], tension[second, both]
            level = (load + other) / 2
            apart = ((load - other) / level) ** 2
            own = (variance[first, both] + variance[second, both]) / level**2
            moved = (rows[:, first, both] * other - rows[:, second, both] * load) / level**2
            own += (moved**2).sum(axis=0)
            # two draws of one deviation differ with twice its variance
            found[one.kind] += float(((apart - own) / 2).sum())
            count[one.kind] += int(np.count_nonzero(both))
    return {
        kind: float(np.sqrt(max(sum_, 0.0) / count[kind])) if count[kind] else float("nan")
        for kind, sum_ in found.items()
    }


def _variance_apart(pieces: Sequence[CurvePiece], strain: Floats, tension: Floats) -> Floats:
    """Variance of each piece by shared errors, without the part that all pieces have in common.

    Notes
    -----
    An error in all pieces moves their mean by the same amount, whatever their weights, so it does
    not tell which of them to trust.  The common part of each error is the share of the tension
    nearest to zero, and none where the signs differ ([3]_, F.1.2.3).  Beyond its ends a piece keeps
    the share at its end, so that no weight jumps where a piece begins.

    Examples
    --------
    One of two cells is accurate to 5 %; a third error of 3 % is in both:

    >>> from reduction.record.contributions import Component
    >>> at, both = np.array([0.5, 1.0]), Component("position_gain", "crosshead")
    >>> cell = Component("tension_gain", "cell")
    >>> load = 100 * at
    >>> good = CurvePiece("T-1", "cyclic", "mean", at, load, 0 * at, (both,), 0.03 * load[None])
    >>> bad = CurvePiece("T-2", "cyclic", "mean", at, load, 0 * at, (both, cell),
    ...     np.stack([0.03 * load, 0.05 * load]))
    >>> print(np.sqrt(_variance_apart([good, bad], at, np.stack([load, load]))))
    [[0.  0. ]
     [2.5 5. ]]
    """
    relative = [replace(one, contribution=one.contribution / one.tension) for one in pieces]
    share = stacked([one.shared_at(strain) for one in relative]).values["tension"]
    common = np.clip(0.0, share.min(axis=1), share.max(axis=1))
    return np.asarray(((share - common[:, None]) ** 2).sum(axis=0) * tension**2)


def _pulls_within_loops(
    pieces: Sequence[CurvePiece], strain: Floats, tension: Floats, known: Bools
) -> Floats:
    """Relative difference between first loadings and kinds of higher precedence, over strain.

    Notes
    -----
    A first loading is another state of the material, not another reading of the same state, so
    nothing is subtracted ([1]_, Figure 35).

    Examples
    --------
    >>> at = np.array([0.5, 1.0])
    >>> load = np.array([110 * at, 90 * at])
    >>> pair = [CurvePiece("T", kind, "ascending", at, one, 0 * at)
    ...     for kind, one in zip(("cyclic", "first-loading"), load)]
    >>> print(_pulls_within_loops(pair, at, load, load > 0).round(6))
    [0.2 0.2]
    """
    own = np.array([one.kind == "first-loading" for one in pieces])
    before = np.cumsum(own) == 0
    both = known[own].any(axis=0) & known[before].any(axis=0)
    if not both.any():
        return np.full(strain.size, np.nan)
    # tension is zero outside a piece
    first, other = (
        tension[rows][:, both].sum(axis=0) / known[rows][:, both].sum(axis=0)
        for rows in (own, before)
    )
    return np.asarray(np.interp(strain, strain[both], 2 * np.abs(first - other) / (first + other)))


# share of a range, from its end, after which the kind of higher precedence is used alone
_HAND_OVER = 0.1

# weight at the very end of a piece: negligible beside another piece, all the weight where alone
_LEAST_WEIGHT = 1e-18

# no tension is known better than this share of it: an uncertainty of zero must not dominate
_LEAST_UNCERTAINTY = 1e-3

# share of the weight below which a piece is ignored
_NO_SAY = 0.01

# least slope over the mean slope where the pieces themselves fall, since the curve has to rise
_LEAST_SLOPE = 1e-6


@dataclass(frozen=True)
@read_only_arrays
class _Blend:
    """Pieces as one curve on a grid; arrays have shape (n,), those of intervals (n - 1,)."""

    strain: Floats
    tension: Floats
    variance: Floats
    component: tuple[Component, ...]
    contribution: Floats
    variance_apart: Floats
    change: Floats
    piece: Integers
    is_covered: Bools
    is_join: Bools
    between_pieces: dict[PieceKind, float]
    beside_loops: float
    farthest: Floats


def _blend_pieces(pieces: Sequence[CurvePiece]) -> _Blend:
    """Weighted mean of pieces, and the nearest rising curve.

    Notes
    -----
    Isotonic regression ([4]_) of the mean less the integral of the least slope, weighted with all
    pieces there and bounded below by zero tension: the least squares solution.  Where a piece is
    alone, its slope exceeds a share of itself, and nothing is moved.

    A first loading is a different state from the loops that follow it.  It is not used where a kind
    of higher precedence reaches.  Its difference from that kind is added to its uncertainty beyond,
    interpolated linearly between the strains where it is known.  Other kinds fade out inside.

    Shared errors enter the mean with their sign.  The part that all pieces have in common does not
    affect the weights; the rising curve has the same share of it.

    Examples
    --------
    >>> at = np.array([0.5, 1.0])
    >>> one = CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)
    >>> _blend_pieces([one]).tension[::200]
    array([ 50.,  75., 100.])
    """
    strain, is_covered = _grid(pieces)
    tension, variance, fade = _on_grid(pieces, strain)
    shared = stacked([one.shared_at(strain) for one in pieces])
    rows = shared.values["tension"] * (fade > 0)
    apart = _variance_apart(pieces, strain, tension)
    simple = (fade * tension).sum(axis=0) / fade.sum(axis=0)
    between = _between_pieces(pieces, tension, variance, rows, fade > 0)
    beside = _pulls_within_loops(pieces, strain, tension, fade > 0)
    is_first = np.array([one.kind == "first-loading" for one in pieces])
    # by kind of each piece: rises from slack differ by far more than cycles do
    own_kind = np.nan_to_num([between[one.kind] for one in pieces])[:, None]
    differs = np.hypot(own_kind, is_first[:, None] * np.nan_to_num(beside)) * simple
    least = (_LEAST_UNCERTAINTY * simple) ** 2
    weight = fade / np.maximum(variance + apart + differs**2, least)
    total = weight.sum(axis=0)
    share = weight / total
    mean = (share * tension).sum(axis=0)
    middle = (share[:, 1:] + share[:, :-1]) / 2
    slopes = _least_slopes(strain, tension, mean, middle, is_covered)
    rising = _rising(strain, mean, total * _widths(strain, is_covered), slopes)
    off = (share * (tension - mean) ** 2).sum(axis=0)
    own = (share * variance).sum(axis=0)
    own += np.maximum(off, (share * differs**2).sum(axis=0)) + (rising - mean) ** 2
    return _Blend(
        strain=strain,
        tension=rising,
        variance=own,
        component=shared.component,
        contribution=(share * rows).sum(axis=1) * (rising / mean),
        variance_apart=own + (share * apart).sum(axis=0),
        change=rising - mean,
        piece=share.argmax(axis=0),
        is_covered=is_covered,
        is_join=is_covered & ((middle > _NO_SAY).sum(axis=0) > 1),
        between_pieces=between,
        beside_loops=float(beside.max()),
        farthest=np.where(share > _NO_SAY, np.abs(tension - rising), 0.0).max(axis=0),
    )


def _grid(pieces: Sequence[CurvePiece]) -> tuple[Floats, Bools]:
    """Strains of the grid, and for each piece the intervals that it covers."""
    ends = np.array([(one.strain[0], one.strain[-1]) for one in pieces])
    fine = np.linspace(ends.min(), ends.max(), _GRID_POINTS)
    # a node closer than this to an end is moved to that end
    near = 0.05 * (fine[1] - fine[0])
    edges = np.unique(ends)
    edges = edges[np.concatenate([[True], np.diff(edges) > near])]
    fine = fine[np.abs(fine[:, None] - edges).min(axis=1) > near]
    strain = np.union1d(fine, edges)
    inside = (strain >= ends[:, :1]) & (strain <= ends[:, 1:])
    strain = strain[inside.any(axis=0)]
    middle = (strain[1:] + strain[:-1]) / 2
    covered: Bools = ((middle > ends[:, :1]) & (middle < ends[:, 1:])).any(axis=0)
    return strain, covered


def _on_grid(pieces: Sequence[CurvePiece], strain: Floats) -> tuple[Floats, Floats, Floats]:
    """Tension, variance and fading weight of each piece on the grid; zero outside it."""
    tension, variance, fade = np.zeros((3, len(pieces), strain.size))
    over, taken = np.zeros((2, strain.size))
    kind = pieces[0].kind
    for row, one in enumerate(pieces):
        if one.kind != kind:  # kinds of higher precedence are done: only the rest is left over
            over, taken, kind = np.maximum(over, taken), np.zeros(strain.size), one.kind
        inside = (strain >= one.strain[0]) & (strain <= one.strain[-1])
        at = strain[inside]
        depth = np.minimum(at - one.strain[0], one.strain[-1] - at)
        depth /= one.strain[-1] - one.strain[0]
        tension[row, inside] = np.interp(at, one.strain, one.tension)
        variance[row, inside] = np.interp(at, one.strain, one.random_standard_uncertainty) ** 2
        full = np.minimum(depth / TAPER, 1.0)
        fade[row, inside] = full * (1 - over[inside]) + _LEAST_WEIGHT
        alone = np.minimum(depth / _HAND_OVER, 1.0)
        taken[inside] = np.maximum(taken[inside], alone)
    for row, one in enumerate(pieces):
        before = [other for other in pieces[:row] if other.kind != one.kind]
        if one.kind == "first-loading" and before:
            inside = (strain >= one.strain[0]) & (strain <= one.strain[-1])
            hidden = inside & np.any(
                [(strain >= each.strain[0]) & (strain <= each.strain[-1]) for each in before],
                axis=0,
            )
            fade[row, hidden] = _LEAST_WEIGHT**2
    return tension, variance, fade


def _widths(strain: Floats, is_covered: Bools) -> Floats:
    """Width of strain that each node stands for; gaps have none."""
    steps = np.where(is_covered, np.diff(strain), 0.0)
    widths = (np.concatenate([[0.0], steps]) + np.concatenate([steps, [0.0]])) / 2
    return np.asarray(np.maximum(widths, 1e-12 * strain[-1]))


def _least_slopes(
    strain: Floats,
    tension: Floats,
    mean: Floats,
    share: Floats,
    is_covered: Bools,
) -> Floats:
    """Least slope allowed for the curve in each interval: that of the softest piece there."""
    slopes = np.diff(tension, axis=1) / np.diff(strain)
    of_pieces = np.where(share > _NO_SAY, slopes, np.inf).min(axis=0)
    # a piece has no slope outside its range; a gap takes the chord of the pieces beside it
    told = np.flatnonzero(is_covered & np.isfinite(of_pieces))
    place = np.searchsorted(told, np.arange(is_covered.size))
    chords = np.where(share > _NO_SAY, _chords(strain, tension)[:, None], np.inf).min(axis=0)
    beside = [chords[told[np.clip(place - back, 0, told.size - 1)]] for back in (1, 0)]
    softest = np.minimum(*beside)  # infinite where no piece has a chord: no bound there
    least = LEAST_SLOPE * np.where(np.isfinite(softest), softest, 0.0)
    least[told] = LEAST_SLOPE * of_pieces[told]
    return np.asarray(np.maximum(least, _LEAST_SLOPE * mean.max() / strain[-1]))


def _chords(strain: Floats, tension: Floats) -> Floats:
    """Slope of each piece between its first and last nodes."""
    reached = tension > 0
    first = reached.argmax(axis=1)
    last = strain.size - 1 - reached[:, ::-1].argmax(axis=1)
    row = np.arange(len(tension))
    apart = strain[last] - strain[first]
    # a piece between two neighbouring grid nodes has no chord
    risen = tension[row, last] - tension[row, first]
    return np.asarray(np.divide(risen, apart, out=np.full(row.size, np.inf), where=apart > 0))


def _rising(strain: Floats, mean: Floats, weight: Floats, least: Floats) -> Floats:
    """Nearest curve whose slope is at least the least one, and whose tension is above zero."""
    given = np.concatenate([[0.0], np.cumsum(least * np.diff(strain))])
    found = scipy.optimize.isotonic_regression(mean - given, weights=weight / weight.max())
    rest = np.asarray(found.x, dtype=np.float64)
    bound = _LEAST_SLOPE * mean.max() * strain[0] / strain[-1]
    rising = np.maximum(rest, bound) + given
    # where nothing was moved, use the mean itself, not its copy with rounding from a difference
    moved = np.abs(rising - mean) > 1e-12 * mean.max()
    return np.where(moved, rising, mean)


_MOVED = 1e-9

_FAR = 2.0

_LITTLE = 0.03


def _quality_warning(blend: _Blend) -> tuple[str, Bools]:
    """Where the curve deviates from its pieces beyond its uncertainty, in words and by node.

    Notes
    -----
    Errors that all pieces share move curve and pieces alike, and are left out ([1]_, Figure 35).

    Examples
    --------
    >>> from reduction.lines.composite import _blend_pieces
    >>> at = np.array([0.5, 1.0])
    >>> pieces = [CurvePiece("T", "static", "ascending", at, load * at, 0 * at)
    ...     for load in (*[100] * 5, 200)]
    >>> blend = _blend_pieces(pieces)
    >>> print(_quality_warning(blend)[0][:42])
    the curve is up to 2.24 standard uncertain
    """
    # near slack, a small difference in strain can be any share of the tension
    told = blend.farthest > _LITTLE * blend.tension[-1]
    share = told * blend.farthest / np.sqrt(blend.variance_apart + _MOVED * blend.tension**2)
    worst = int(np.argmax(share))
    is_far = np.asarray(share > _FAR)
    if not is_far.any():
        return "", is_far
    far = float(blend.farthest[worst])
    return (
        f"the curve is up to {share[worst]:.3g} standard uncertainties from a piece: {far:.4g} N "
        f"({100 * (far / blend.tension[worst]):.1f} %) at strain {blend.strain[worst]:.4g}"
    ), is_far


def _notes_of(
    pieces: Sequence[CurvePiece], rule: CompositeRule, blend: _Blend, moved: Bools
) -> tuple[str, ...]:
    """Rule, range, joins, gaps, deviation between the pieces, and the greatest change.

    Notes
    -----
    Given as shares of tension, since pieces of rubber differ by a share ([1]_, sec. 4.8).

    Examples
    --------
    See `reduction.lines.composite._composite_curve`.
    """
    named = Counter((one.kind, one.branch, one.name) for one in pieces)
    used = ", ".join(
        f"{name} ({kind}, {branch}" + (f", in {count} parts)" if count > 1 else ")")
        for (kind, branch, name), count in named.items()
    )
    strain, change = blend.strain, blend.change
    notes = [
        f"order of precedence {', '.join(rule.precedence)}; pieces are blended over "
        f"{TAPER:g} of their length at each end: {used}",
        f"a straight line from zero to strain {strain[0]:.4g}, where the first piece begins",
    ]
    notes += [
        f"no piece between strain {strain[gap]:.4g} and {strain[gap + 1]:.4g}: a straight line"
        for gap in np.flatnonzero(~blend.is_covered)
    ]
    between = {kind: one for kind, one in blend.between_pieces.items() if not np.isnan(one)}
    if not between:
        notes.append("no two pieces of one kind overlap: the scatter between them is unknown")
    notes += [
        f"{kind} pieces differ by {100 * one:.1f} % of tension where they overlap"
        for kind, one in between.items()
    ]
    if not np.isnan(blend.beside_loops):
        notes.append(
            f"first loadings differ by up to {100 * blend.beside_loops:.1f} % from the pieces of"
            " higher precedence; their uncertainty includes this where they are alone"
        )
    if moved.any():
        share = change / blend.tension
        worst = int(np.argmax(np.abs(change)))
        notes.append(
            "the mean of the pieces falls where one ends and the next begins:"
            f" {100 * moved.mean():.0f} % of the nodes were moved to keep the curve from being"
            f" softer than {LEAST_SLOPE:g} of the softest piece there, by"
            f" {np.sqrt(np.mean(change**2)):.4g} N rms, most by {change[worst]:+.4g} N"
            f" ({100 * share[worst]:+.1f} %) at strain {strain[worst]:.4g}"
        )
        # over all nodes: near slack a local share means nothing
        off = float(np.sqrt(np.sum(change**2) / np.sum(blend.tension**2)))
        apart = next(iter(between.values()), np.inf)
        if off > apart:
            several = len({one.kind for one in pieces}) > 1
            notes.append(
                f"the curve is {100 * off:.1f} % off the mean of its pieces, which differ by"
                f" {100 * apart:.1f} % where they overlap: "
                + (
                    "they do not belong to one curve, such as loops of a rope and its slow pull;"
                    " name the kinds that you want"
                    if several
                    else "the tests are of different states; name those that you want"
                )
            )
    return tuple(notes)


_TANGENT_NODES = 5


@dataclass(frozen=True)
@read_only_arrays
class CompositeCurve:
    """Tension against strain, strictly rising from 0, 0; straight lines between the nodes.

    Parameters
    ----------
    strain, tension : ndarray, shape (n,)
        [1], [N]
    standard_uncertainty : ndarray, shape (n,)
        Random and shared parts together. [N]
    random_standard_uncertainty : ndarray, shape (n,)
        From the pieces themselves, their disagreement, and the change made so that the curve rises.
        [N]
    component : tuple of Component, length n_components
        Errors that pieces share with each other, and with other curves.
    contribution : ndarray, shape (n_components, n)
        Signed contribution of each shared error to the tension. [N]
    piece : ndarray of int, shape (n,)
        Index of the piece with the greatest weight; -1 where there is none.
    is_join, is_gap, is_moved : ndarray of bool, shape (n - 1,)
        For each interval: several pieces contribute; no piece reaches; the curve is not the
        mean of the pieces, since the mean falls or is too soft nearby.
    monotone_change : ndarray, shape (n,)
        Change of the weighted mean of the pieces that makes it rise; NaN without pieces. [N]
    between_pieces : float
        Relative deviation between pieces where they overlap, for the first kind of the rule with
        two such pieces; NaN where there is none. [1]
    piece_names, piece_words : tuple of str
        For each piece, its test, and its test with its kind.
    pieces : tuple of CurvePiece
        With the same index: pieces that the curve is made of.
    is_doubtful : ndarray of bool, shape (n,)
        Whether the curve is in doubt at each node.
    doubt : str
        Where, and by how much, the curve differs from a piece in use by more than twice its
        uncertainty and 3 % of the greatest tension; else empty.
    notes : tuple of str
        Rule, range, joins, gaps, and the greatest change.
    """

    strain: Floats
    tension: Floats
    standard_uncertainty: Floats
    random_standard_uncertainty: Floats
    component: tuple[Component, ...]
    contribution: Floats
    piece: Integers
    is_join: Bools
    is_gap: Bools
    is_moved: Bools
    monotone_change: Floats
    between_pieces: float
    piece_names: tuple[str, ...]
    piece_words: tuple[str, ...]
    pieces: tuple[CurvePiece, ...]
    is_doubtful: Bools
    doubt: str = ""
    notes: tuple[str, ...] = field(default=())

    @property
    def shared_standard_uncertainty(self) -> Floats:
        """Uncertainty of the tension from errors shared with others, all together. [N]."""
        return np.asarray(np.sqrt(np.sum(self.contribution**2, axis=0)))

    def tension_at(self, strain: ArrayLike) -> Floats:
        """Tension [N] at a strain [1]; zero where it is slack, NaN beyond the last node."""
        return np.interp(
            np.asarray(strain, dtype=np.float64), self.strain, self.tension, right=np.nan
        )

    def strain_at(self, tension: ArrayLike) -> Floats:
        """Strain [1] at a tension [N]; NaN below zero and beyond the last node."""
        return np.interp(
            np.asarray(tension, dtype=np.float64),
            self.tension,
            self.strain,
            left=np.nan,
            right=np.nan,
        )


def _composite_curve(
    pieces: Sequence[CurvePiece], *, rule: CompositeRule | None = None
) -> CompositeCurve:
    """Monotone curve of tension against strain from zero, nearest to all pieces.

    Notes
    -----
    *Overlap.*  Pieces of one kind are blended.  Their own uncertainties are far smaller than the
    deviation between them (another state of the rubber), so s dominates.  It is one number per
    kind: the weights are continuous, and so is the mean.

    *Monotony.*  Isotonic regression ([4]_) of the mean less the integral of the least slope,
    weighted with all pieces there: the curve is nowhere softer than a share of the softest
    piece there, and where one piece is alone the curve is that piece.

    *To zero.*  A straight line from 0, 0 to the first node, as over a gap.  If the curvature
    keeps its sign there, the curve lies between that line and the tangents at its ends: a third
    of the squared height of that triangle is in the variance at the middle node.

    *Uncertainty.*  That of a mixture: the mean variance of the pieces, with the greater of their
    variance there and (s T)^2, and the square of the change.  It does not fall with the number
    of pieces, since they are not draws of one state ([1]_, Figure 35).  Errors that pieces share
    (a load cell) are averaged with their sign, error by error, and their squares are added at the
    end; s is found without them.

    Examples
    --------
    Two windows of one straight line of 100 N per unit strain:

    >>> low, high = np.linspace(0.2, 1.0, 9), np.linspace(0.8, 2.0, 9)
    >>> pieces = [CurvePiece(name, "cyclic", "mean", at, 100 * at, 0 * at + 0.1)
    ...     for name, at in (("T-1", low), ("T-2", high))]
    >>> curve = _composite_curve(pieces)
    >>> print(curve.tension_at([0.1, 0.9, 2.0]).round(6), curve.is_gap.sum())
    [ 10.  90. 200.] 2
    """
    rule = rule or CompositeRule()
    used = [one for kind in rule.precedence for one in pieces if one.kind == kind]
    if not used:
        raise DataError(
            "no piece is of a kind that the rule names",
            found=", ".join(sorted({one.kind for one in pieces})) or "no pieces",
            needed=" or ".join(rule.precedence),
        )
    blend = _blend_pieces(used)
    moved = np.abs(blend.change) > _MOVED * blend.tension
    strain = np.concatenate([[0.0], blend.strain])
    tension = np.concatenate([[0.0], blend.tension])
    variance = np.concatenate([[0.0], blend.variance])
    rows = np.pad(blend.contribution, ((0, 0), (1, 0)))
    is_gap = np.concatenate([[True], ~blend.is_covered])
    gaps = np.flatnonzero(is_gap)
    doubt, is_far = _quality_warning(blend)
    bend = _rise_warning(strain, tension, variance, gaps)

    def with_middles(values: Floats, middle: Floats | float) -> Floats:
        return np.insert(values, gaps + 1, middle)

    def of_intervals(flags: Bools) -> Bools:
        return np.insert(flags, gaps, flags[gaps])

    random = np.sqrt(with_middles(variance, bend))
    moved_by = np.insert(rows, gaps + 1, (rows[:, gaps] + rows[:, gaps + 1]) / 2, axis=1)
    return CompositeCurve(
        strain=with_middles(strain, (strain[gaps] + strain[gaps + 1]) / 2),
        tension=with_middles(tension, (tension[gaps] + tension[gaps + 1]) / 2),
        standard_uncertainty=combined_standard_uncertainty(moved_by, random),
        random_standard_uncertainty=random,
        component=blend.component,
        contribution=moved_by,
        piece=np.insert(np.concatenate([[-1], blend.piece]), gaps + 1, -1),
        is_join=of_intervals(np.concatenate([[False], blend.is_join])),
        is_gap=of_intervals(is_gap),
        is_moved=of_intervals(
            np.concatenate([[False], blend.is_covered & (moved[1:] | moved[:-1])])
        ),
        monotone_change=with_middles(np.concatenate([[np.nan], blend.change]), np.nan),
        between_pieces=next(
            (one for one in blend.between_pieces.values() if not np.isnan(one)), float("nan")
        ),
        piece_names=tuple(one.name for one in used),
        piece_words=tuple(one.words for one in used),
        pieces=tuple(used),
        doubt=doubt,
        is_doubtful=np.insert(np.concatenate([[False], is_far]), gaps + 1, False),
        notes=_notes_of(used, rule, blend, moved),
    )


def _rise_warning(strain: Floats, tension: Floats, variance: Floats, gaps: Integers) -> Floats:
    """Variance in the middle of each gap: from its ends, and from a possible curvature."""
    steps = np.diff(strain)
    slopes = np.diff(tension) / steps
    # tangents from the nodes beyond each end; there is none before the first gap
    last = strain.size - 1
    after = np.minimum(gaps + 1 + _TANGENT_NODES, last)
    before = np.maximum(gaps - _TANGENT_NODES, 1)
    height = np.fmin(
        np.abs(slopes[gaps] - _slopes(strain, tension, gaps + 1, after)),
        np.abs(slopes[gaps] - _slopes(strain, tension, before, gaps)),
    )
    # above the lower end and below the upper one, whatever the tangents give
    height = np.nan_to_num(np.minimum(height, slopes[gaps])) * steps[gaps] / 2
    return (variance[gaps] + variance[gaps + 1]) / 2 + height**2 / 3


def _slopes(strain: Floats, tension: Floats, first: Integers, last: Integers) -> Floats:
    """Slope between pairs of nodes; NaN where both are the same node."""
    apart = np.where(last > first, strain[last] - strain[first], np.nan)
    return (tension[last] - tension[first]) / apart


@dataclass(frozen=True)
@read_only_arrays
class MeasuredLoop:
    """Mean loop of the cycles of a test, of one specimen.

    Parameters
    ----------
    name : str
        Test.
    strain, tension : ndarray, shape (2,)
        At the lower and the upper turn. [1], [N]
    distance : ndarray, shape (n,)
        From either turn; increasing, from zero. [1]
    width : ndarray, shape (n,)
        Greatest difference of tension between the branches up to there. [N]
    relative_uncertainty : float
        Standard uncertainty of the spring constant between the turns. [1]
    """

    name: str
    strain: Floats
    tension: Floats
    distance: Floats
    width: Floats
    relative_uncertainty: float

    @property
    def words(self) -> str:
        """As the words of the piece of these cycles."""
        return f"{self.name} {_KIND_WORDS['cyclic']}"

    def of_line(self) -> LineLoop:
        """Loop of a line of the specimen, 1 m long at zero strain."""
        low, high = self.tension.tolist()
        stroke = float(self.strain[1] - self.strain[0])
        return LineLoop(
            low, high, 1 + float(self.strain[0]), stroke, self.distance, self.width,
            self.relative_uncertainty,
        )  # fmt: skip


@dataclass(frozen=True)
class PieceSource:
    """Pieces of one line or tether.

    Parameters
    ----------
    name : str
        Name of the line or tether.
    branch : {"ascending", "descending", "mean"}
        Branch of the cycles.
    pieces : tuple of CurvePiece
        In the order of the tests. [SI]
    model : StrainModel, optional
        Law of its length over strain and tension, where known.
    diameter, rated_break_strength : float
        NaN where not stated. [m], [N]
    linear_density, wet_linear_density : float
        In air and in water; NaN where not stated. [kg m-1]
    sources : tuple of str
        Sources of the pieces, and other data behind them.
    piece_sources : tuple of str
        One of ``sources`` for each piece; empty where they are not known by piece.
    notes : tuple of str
        Parts that were left out, and other remarks.
    is_synthetic : bool
        Nothing was tested: the numbers are synthetic.
    loops : tuple of MeasuredLoop
        Of its cyclic tests, also of those without a curve.
    """

    name: str
    branch: PieceBranch
    pieces: tuple[CurvePiece, ...]
    model: StrainModel | None = None
    diameter: float = float("nan")
    rated_break_strength: float = float("nan")
    linear_density: float = float("nan")
    wet_linear_density: float = float("nan")
    sources: tuple[str, ...] = ()
    piece_sources: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    is_synthetic: bool = False
    loops: tuple[MeasuredLoop, ...] = ()


def used_of(source: PieceSource, curve: CompositeCurve) -> PieceSource:
    """Source of a curve: without the sources of pieces that are not in the curve.

    Notes
    -----
    A rule leaves out kinds: a test without a kind that the rule names is no source of the curve.

    References
    ----------
    .. [1] WHOI-2005-10, as `reduction.lines.composite`.

    Examples
    --------
    >>> import numpy as np
    >>> at = np.array([0.5, 1.0])
    >>> pieces = [CurvePiece(name, kind, "ascending", at, 100 * at, 0 * at)
    ...     for name, kind in (("Q", "static"), ("R", "cyclic"))]
    >>> rope = PieceSource("rope", "ascending", tuple(pieces), None, sources=("log Q", "log R"),
    ...     piece_sources=("log Q", "log R"))
    >>> found = used_of(rope, compose(rope, CompositeRule(precedence=("static",))))
    >>> print(found.sources, found.notes)
    ('log Q',) ('of other kinds, not used: R',)
    """
    if not source.piece_sources:
        return source
    pairs = list(zip(source.pieces, source.piece_sources, strict=True))
    used = {where for one, where in pairs if one.words in curve.piece_words}
    left = {where: one.name for one, where in pairs if where not in used}
    left = {where: name for where, name in left.items() if where in source.sources}
    if not left:
        return source
    return replace(
        source,
        sources=tuple(text for text in source.sources if text not in left),
        notes=(*source.notes, f"of other kinds, not used: {', '.join(left.values())}"),
    )


def curve_of_piece(piece: CurvePiece) -> CompositeCurve:
    """One piece alone as a curve from zero."""
    return _composite_curve((piece,), rule=CompositeRule(precedence=(piece.kind,)))


def whole_pieces(pieces: Sequence[CurvePiece]) -> tuple[CurvePiece, ...]:
    """Pieces, with those of the mean curve of one loop as one.

    Readings in step with the machine leave bins that no window reaches, also in the middle.
    """
    found: dict[str, CurvePiece] = {}
    for piece in pieces:
        words = piece.words if piece.kind == "cyclic" else f"{piece.words} {len(found)}"
        first = found.get(words)
        found[words] = piece if first is None else replace(
            first,
            strain=np.append(first.strain, piece.strain),
            tension=np.append(first.tension, piece.tension),
            random_standard_uncertainty=np.append(
                first.random_standard_uncertainty, piece.random_standard_uncertainty
            ),
            contribution=np.concatenate([first.contribution, piece.contribution], axis=1)
            if first.component
            else first.contribution,
        )  # fmt: skip
    return tuple(found.values())


def tests_of_curve(curve: CompositeCurve, loops: Sequence[MeasuredLoop]) -> tuple[LoadedTest, ...]:
    """Each piece of a curve as a separate line, 1 m long at zero tension, with its loop."""
    found = []
    of_lines = {one.words: one.of_line() for one in loops}
    for piece in whole_pieces(curve.pieces):
        own = curve_of_piece(piece)
        inside = own.strain >= piece.strain[0]
        found.append(
            LoadedTest(
                words=piece.words,
                kind=piece.kind,
                length=1 + own.strain[inside],
                tension=own.tension[inside],
                random_standard_uncertainty=own.random_standard_uncertainty[inside],
                contribution=own.contribution[:, inside],
                low=float(own.tension[inside][0]),
                high=float(own.tension[-1]),
                loop=of_lines.get(piece.words),
            )
        )
    return tuple(found)


def compose(source: PieceSource, rule: CompositeRule) -> CompositeCurve:
    """Composite curve of the pieces of a source.

    Parameters
    ----------
    source : PieceSource
        Pieces of one line or tether.
    rule : CompositeRule
        Precedence of kinds.

    Returns
    -------
    curve : CompositeCurve
        Begins at zero. [SI]

    Raises
    ------
    DataError
        If no piece is of a kind that the rule names; the message names the source.

    Notes
    -----
    See `reduction.lines.composite._composite_curve`.

    References
    ----------
    .. [1] WHOI-2005-10, as `reduction.lines.composite`.

    Examples
    --------
    >>> import numpy as np
    >>> at = np.array([0.5, 1.0])
    >>> piece = CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)
    >>> source = PieceSource("tether", "ascending", (piece,))
    >>> print(compose(source, CompositeRule()).tension_at(0.75))
    75.0
    """
    try:
        return _composite_curve(source.pieces, rule=rule)
    except DataError as error:
        raise DataError(
            f"{source.name}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip

r"""One monotone curve of tension against strain, from zero, out of many tests.

The curve y is the one that rises and is nearest to all pieces T_i:

.. math:: \min_y \int \sum_i w_i(\varepsilon)\,(y - T_i)^2\,d\varepsilon, \quad
   y' \ge b\,\min_i T_i', \qquad w_i = \frac{h_i\,g_i}{u_i^2 + (s\,\bar T)^2}

u_i is the uncertainty of a piece but for what all of them share, s the relative deviation between
pieces of its kind where they overlap, h_i falls to zero towards the ends of a piece, and g_i hands
over to pieces of a kind that goes before.  Without the constraint the answer is the weighted mean.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8, Figures 31, 35.
.. [2] R. E. Barlow, D. J. Bartholomew, J. M. Bremner and H. D. Brunk, "Statistical Inference
   under Order Restrictions," Wiley, 1972 (isotonic regression).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.lookup.blend import blend_pieces
from reduction.lookup.compositerule import CompositeRule
from reduction.lookup.compositewords import doubt_of, notes_of
from reduction.lookup.pieces import CurvePiece
from reduction.record import Bools, Floats, Integers, read_only_arrays
from reduction.uncertainty.combine import combined_standard_uncertainty
from reduction.uncertainty.product import Component

_MOVED = 1e-9
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
        Both parts that follow, together. [N]
    random_standard_uncertainty : ndarray, shape (n,)
        Of the pieces by themselves, of their disagreement, and of what making them rise has moved.
        [N]
    component : tuple of Component, length n_components
        Errors that pieces share with each other, and with other curves.
    contribution : ndarray, shape (n_components, n)
        What each of them adds to the tension, signed. [N]
    piece : ndarray of int, shape (n,)
        Index of the piece with the greatest weight; -1 where there is none.
    is_join, is_gap, is_moved : ndarray of bool, shape (n - 1,)
        Of each interval: more than one piece has a say; no piece reaches; the curve is not the
        mean of the pieces, since that falls or is too soft nearby.
    monotone_change : ndarray, shape (n,)
        What making it rise has added to the weighted mean of the pieces; NaN without one. [N]
    between_pieces : float
        Relative deviation between pieces where they overlap, of the first kind of the rule that
        has two; NaN where none has. [1]
    piece_names, piece_words : tuple of str
        By index: its test, and its test with its kind.
    doubt : str
        Where the curve is farther from a piece that has a say than twice its uncertainty and 3 % of
        the greatest tension, and how far; else empty.
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
    doubt: str = ""
    notes: tuple[str, ...] = field(default=())

    @property
    def shared_standard_uncertainty(self) -> Floats:
        """Of the tension by what is shared with others, all errors together. [N]."""
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


def composite_curve(
    pieces: Sequence[CurvePiece], *, rule: CompositeRule | None = None
) -> CompositeCurve:
    r"""Monotone curve of tension against strain from zero, nearest to all pieces.

    Parameters
    ----------
    pieces : sequence of CurvePiece
        Of one line or tether, in one condition. [SI]
    rule : CompositeRule, optional
        Which kind goes before which, and how pieces fade.

    Returns
    -------
    curve : CompositeCurve
        With joins, gaps and the change that monotony asked for.

    Raises
    ------
    DataError
        If no piece is of a kind that the rule names.

    Notes
    -----
    *Overlap.*  Pieces of one kind are blended.  Their own uncertainties are far smaller than what
    is between them (another state of the rubber), so s decides, and it is one number of a
    kind: the weights are continuous, and so is the mean.

    *Monotony.*  Isotonic regression ([2]_) with the weight of all pieces there, of the mean less
    the integral of the least slope: the curve is nowhere softer than a share of the softest
    piece there, and where one piece is alone it is that piece.

    *To zero.*  A straight line from 0, 0 to the first node; the same over a gap.  If the
    curvature keeps its sign there, the curve lies between that line and the tangents at its
    ends: a third of that triangle's height squared is in the variance at the middle node.

    *Uncertainty.*  That of a mixture: the mean variance of the pieces, with the greater of their
    variance there and (s T)^2, and the square of the change.  It does not fall with the number
    of pieces, since they are not draws of one state ([1]_, Figure 35).  What pieces share (a load
    cell) is averaged by its sign, error by error, and added as squares in the end; s is judged
    without it.

    Examples
    --------
    Two windows of one straight line of 100 N per unit strain:

    >>> low, high = np.linspace(0.2, 1.0, 9), np.linspace(0.8, 2.0, 9)
    >>> pieces = [CurvePiece(name, "cyclic", "mean", at, 100 * at, 0 * at + 0.1)
    ...     for name, at in (("T-1", low), ("T-2", high))]
    >>> curve = composite_curve(pieces)
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
    blend = blend_pieces(
        used, taper=rule.taper, least_slope=rule.least_slope, n_points=rule.n_points
    )
    moved = np.abs(blend.change) > _MOVED * blend.tension
    strain = np.concatenate([[0.0], blend.strain])
    tension = np.concatenate([[0.0], blend.tension])
    variance = np.concatenate([[0.0], blend.variance])
    rows = np.pad(blend.contribution, ((0, 0), (1, 0)))
    is_gap = np.concatenate([[True], ~blend.is_covered])
    gaps = np.flatnonzero(is_gap)
    doubt = _doubt(strain, tension, variance, gaps)

    def with_middles(values: Floats, middle: Floats | float) -> Floats:
        return np.insert(values, gaps + 1, middle)

    def of_intervals(flags: Bools) -> Bools:
        return np.insert(flags, gaps, flags[gaps])

    random = np.sqrt(with_middles(variance, doubt))
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
        doubt=doubt_of(blend),
        notes=notes_of(used, rule, blend, moved),
    )


def _doubt(strain: Floats, tension: Floats, variance: Floats, gaps: Integers) -> Floats:
    """Variance in the middle of each gap: of its ends, and of what curvature may do."""
    steps = np.diff(strain)
    slopes = np.diff(tension) / steps
    # tangents from the nodes beyond each end; before the first gap there is none
    last = strain.size - 1
    after = np.minimum(gaps + 1 + _TANGENT_NODES, last)
    before = np.maximum(gaps - _TANGENT_NODES, 1)
    height = np.fmin(
        np.abs(slopes[gaps] - _slopes(strain, tension, gaps + 1, after)),
        np.abs(slopes[gaps] - _slopes(strain, tension, before, gaps)),
    )
    # above the lower end and below the upper one, whatever the tangents say
    height = np.nan_to_num(np.minimum(height, slopes[gaps])) * steps[gaps] / 2
    return (variance[gaps] + variance[gaps + 1]) / 2 + height**2 / 3


def _slopes(strain: Floats, tension: Floats, first: Integers, last: Integers) -> Floats:
    """Slope between pairs of nodes; NaN where they are one."""
    apart = np.where(last > first, strain[last] - strain[first], np.nan)
    return (tension[last] - tension[first]) / apart

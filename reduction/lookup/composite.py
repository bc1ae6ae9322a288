r"""One monotone curve of tension against strain, from zero, out of many tests.

The curve y is the one that rises and is nearest to all pieces T_i:

.. math:: \min_y \int \sum_i w_i(\varepsilon)\,(y - T_i)^2\,d\varepsilon, \quad
   y' \ge b\,\min_i T_i', \qquad w_i = \frac{h_i\,g_i}{u_i^2 + (s\,\bar T)^2}

u_i is the uncertainty of a piece (type A), s the relative deviation between pieces of its kind
where they overlap, h_i falls to zero towards the ends of a piece, and g_i hands over to pieces
of a kind that goes before.  Without the constraint the answer is the weighted mean.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8, Figures 31, 35.
.. [2] R. E. Barlow, D. J. Bartholomew, J. M. Bremner and H. D. Brunk, "Statistical Inference
   under Order Restrictions," Wiley, 1972 (isotonic regression).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, SettingsError
from reduction.lookup.blend import Blend, blend_pieces
from reduction.lookup.pieces import CurvePiece, PieceKind
from reduction.lookup.product import LineCurve
from reduction.record import Bools, Floats, Integers, freeze_arrays

__all__ = ["CompositeCurve", "CompositeRule", "composite_curve", "composite_line_curve"]

_KINDS: tuple[PieceKind, ...] = ("cyclic", "static", "first-loading")
_MOVED = 1e-9
_FAR = 2.0
_LITTLE = 0.03
_TANGENT_NODES = 5


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


@dataclass(frozen=True)
class CompositeCurve:
    """Tension against strain, strictly rising from 0, 0; straight lines between the nodes.

    Parameters
    ----------
    strain, tension : ndarray, shape (n,)
        [1], [N]
    standard_uncertainty : ndarray, shape (n,)
        Of the pieces, of their disagreement, and of what making them rise has moved. [N]
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

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
    *Overlap.*  Pieces of one kind are blended.  Their type A uncertainties are far smaller than
    what is between them (another state of the rubber), so s decides, and it is one number of a
    kind: the weights are continuous, and so is the mean.

    *Monotony.*  Isotonic regression ([2]_) with the weight of all pieces there, of the mean less
    the integral of the least slope: the curve is nowhere softer than a share of the softest
    piece there, and where one piece is alone it is that piece.

    *To zero.*  A straight line from 0, 0 to the first node; the same over a gap.  If the
    curvature keeps its sign there, the curve lies between that line and the tangents at its
    ends: a third of that triangle's height squared is in the variance at the middle node.

    *Uncertainty.*  That of a mixture: the mean variance of the pieces, with the greater of their
    variance there and (s T)^2, and the square of the change.  It does not fall with the number
    of pieces, since they are not draws of one state ([1]_, Figure 35).

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
    is_gap = np.concatenate([[True], ~blend.is_covered])
    gaps = np.flatnonzero(is_gap)
    doubt = _doubt(strain, tension, variance, gaps)

    def with_middles(values: Floats, middle: Floats | float) -> Floats:
        return np.insert(values, gaps + 1, middle)

    def of_intervals(flags: Bools) -> Bools:
        return np.insert(flags, gaps, flags[gaps])

    return CompositeCurve(
        strain=with_middles(strain, (strain[gaps] + strain[gaps + 1]) / 2),
        tension=with_middles(tension, (tension[gaps] + tension[gaps + 1]) / 2),
        standard_uncertainty=np.sqrt(with_middles(variance, doubt)),
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
        doubt=_far_off(blend),
        notes=_notes(used, rule, blend, moved),
    )


def _far_off(blend: Blend) -> str:
    """Where the curve is not among its pieces by its own uncertainty, in words."""
    # near slack a little strain is any share of the tension
    told = blend.farthest > _LITTLE * blend.tension[-1]
    share = told * blend.farthest / np.sqrt(blend.variance + _MOVED * blend.tension**2)
    worst = int(np.argmax(share))
    if share[worst] <= _FAR:
        return ""
    far = float(blend.farthest[worst])
    return (
        f"up to {share[worst]:.3g} standard uncertainties from a piece: {far:.4g} N "
        f"({far / blend.tension[worst]:.1%}) at strain {blend.strain[worst]:.4g}"
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


def _notes(
    pieces: Sequence[CurvePiece], rule: CompositeRule, blend: Blend, moved: Bools
) -> tuple[str, ...]:
    named = Counter((one.kind, one.branch, one.name) for one in pieces)
    used = ", ".join(
        f"{name} ({kind}, {branch}" + (f", in {count} parts)" if count > 1 else ")")
        for (kind, branch, name), count in named.items()
    )
    strain, change = blend.strain, blend.change
    notes = [
        f"tension against strain by {' before '.join(rule.precedence)}, blended over "
        f"{rule.taper:g} of each piece at its ends: {used}",
        f"a straight line from zero to strain {strain[0]:.4g}, where the first piece begins",
    ]
    notes += [
        f"no piece between strain {strain[gap]:.4g} and {strain[gap + 1]:.4g}: a straight line"
        for gap in np.flatnonzero(~blend.is_covered)
    ]
    between = {kind: one for kind, one in blend.between_pieces.items() if not np.isnan(one)}
    if not between:
        notes.append("no two pieces of one kind overlap: what is between them is not known")
    notes += [
        f"{kind} pieces differ by {one:.1%} of tension where they overlap"
        for kind, one in between.items()
    ]
    if not np.isnan(blend.beside_loops):
        notes.append(
            f"first loadings differ by up to {blend.beside_loops:.1%} from what goes before them: "
            "this is in their uncertainty where they stand alone"
        )
    if moved.any():
        share = change / blend.tension
        worst = int(np.argmax(np.abs(change)))
        notes.append(
            f"pieces fall where they hand over: {moved.mean():.0%} of the nodes were moved so that "
            f"the curve is nowhere softer than {rule.least_slope:g} of the softest piece there, by "
            f"{np.sqrt(np.mean(change**2)):.4g} N rms, most by {change[worst]:+.4g} N "
            f"({share[worst]:+.1%}) at strain {strain[worst]:.4g}"
        )
        # of all tension: near slack a share says nothing
        off = float(np.sqrt(np.sum(change**2) / np.sum(blend.tension**2)))
        apart = next(iter(between.values()), np.inf)
        if off > apart:
            several = len({one.kind for one in pieces}) > 1
            notes.append(
                f"the curve is {off:.1%} off the mean of its pieces, which differ by {apart:.1%} "
                "where they overlap: "
                + (
                    "they are no pieces of one curve, as loops of a rope and its slow pull are "
                    "none; name the kinds that are wanted"
                    if several
                    else "they hand over between tests in other states; name the tests that are "
                    "wanted"
                )
            )
    return tuple(notes)


def composite_line_curve(curve: CompositeCurve) -> LineCurve:
    """Return a composite curve as one of a line, so that it can be looked up.

    Parameters
    ----------
    curve : CompositeCurve
        Tension against strain. [SI]

    Returns
    -------
    line_curve : LineCurve
        ``tension`` over ``strain``; tested from the first node of a piece to the last. [SI]

    Raises
    ------
    DataError
        Never by itself.

    Notes
    -----
    A gap inside counts as tested, since the range of a look-up has two ends: the notes name it.

    Examples
    --------
    >>> at = np.linspace(0.5, 1.0, 5)
    >>> curve = composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> line_curve = composite_line_curve(curve)
    >>> print(line_curve.low, line_curve.high)
    0.5 1.0
    """
    first = int(np.argmax(curve.piece >= 0))
    return LineCurve(
        "tension", "strain", float(curve.strain[first]), float(curve.strain[-1]),
        at=curve.strain, value=curve.tension, standard_uncertainty=curve.standard_uncertainty,
        notes=curve.notes,
    )  # fmt: skip

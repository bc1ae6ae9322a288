"""What is said of a composite curve: its rule, its gaps, what its pieces differ by, and doubts.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from reduction.lookup.blend import Blend
from reduction.lookup.compositerule import CompositeRule
from reduction.lookup.pieces import CurvePiece
from reduction.record import Bools

_MOVED = 1e-9
_FAR = 2.0
_LITTLE = 0.03


def doubt_of(blend: Blend) -> str:
    """Where the curve is not among its pieces by its own uncertainty, in words.

    Parameters
    ----------
    blend : Blend
        Of the pieces. [SI]

    Returns
    -------
    doubt : str
        Empty where there is none.

    Raises
    ------
    ValueError
        If the blend has no nodes.

    Notes
    -----
    What all pieces share moves curve and pieces alike, and is no excuse ([1]_, Figure 35).

    Examples
    --------
    >>> from reduction.lookup.blend import blend_pieces
    >>> at = np.array([0.5, 1.0])
    >>> pieces = [CurvePiece("T", "static", "ascending", at, load * at, 0 * at)
    ...     for load in (*[100] * 5, 200)]
    >>> print(doubt_of(blend_pieces(pieces, taper=0.5, least_slope=0.5, n_points=3))[:42])
    up to 2.24 standard uncertainties from a p
    """
    # near slack a little strain is any share of the tension
    told = blend.farthest > _LITTLE * blend.tension[-1]
    share = told * blend.farthest / np.sqrt(blend.variance_apart + _MOVED * blend.tension**2)
    worst = int(np.argmax(share))
    if share[worst] <= _FAR:
        return ""
    far = float(blend.farthest[worst])
    return (
        f"up to {share[worst]:.3g} standard uncertainties from a piece: {far:.4g} N "
        f"({far / blend.tension[worst]:.1%}) at strain {blend.strain[worst]:.4g}"
    )


def notes_of(
    pieces: Sequence[CurvePiece], rule: CompositeRule, blend: Blend, moved: Bools
) -> tuple[str, ...]:
    """Rule, range, joins, gaps, what is between the pieces, and the greatest change.

    Parameters
    ----------
    pieces : sequence of CurvePiece
        That were used. [SI]
    rule : CompositeRule
        By which they became one.
    blend : Blend
        Of them. [SI]
    moved : ndarray of bool, shape (n,)
        Nodes that are not the mean of the pieces. [1]

    Returns
    -------
    notes : tuple of str
        In that order.

    Raises
    ------
    IndexError
        If the flags are not of these nodes.

    Notes
    -----
    Shares of tension, since pieces of rubber differ by a share of it ([1]_).

    Examples
    --------
    See `reduction.lookup.composite.composite_curve`.
    """
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

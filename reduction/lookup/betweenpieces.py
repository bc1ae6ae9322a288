r"""What pieces of a tension-strain curve differ by, and how much of it their own errors explain.

.. math:: d = \frac{T_1 - T_2}{\bar T}, \qquad
          u^2(d) = \frac{u_1^2 + u_2^2}{\bar T^2}
              + \sum_k \Bigl(\frac{c_{1k} T_2 - c_{2k} T_1}{\bar T^2}\Bigr)^2

with the mean of both tensions, the random part u of each and the contribution c_k of each error
that they share.  A gain of one load cell is in both and in no ratio: it explains no difference.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Figure 35.
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.lookup.pieces import CurvePiece, PieceKind
from reduction.record import Bools, Floats
from reduction.uncertainty.join import stacked


def between_pieces(
    pieces: Sequence[CurvePiece], tension: Floats, variance: Floats, rows: Floats, known: Bools
) -> dict[PieceKind, float]:
    """Relative deviation between pieces of each kind, by pairs, less what their errors explain.

    Parameters
    ----------
    pieces : sequence of CurvePiece, length n_pieces
        Of any kinds.
    tension, variance : ndarray, shape (n_pieces, n)
        On one grid, the variance of the random part. [N], [N2]
    rows : ndarray, shape (n_components, n_pieces, n)
        What each shared error adds to the tension, signed. [N]
    known : ndarray of bool, shape (n_pieces, n)
        Where a piece is. [1]

    Returns
    -------
    between : dict of str to float
        By kind; NaN where no two of it overlap. [1]

    Raises
    ------
    IndexError
        If the arrays are not of these pieces.

    Notes
    -----
    First order in the errors (module).  Never below zero: differences that the errors explain
    leave nothing ([1]_ shows some that they do not).

    Examples
    --------
    Two pieces 10 % apart under one cell, and under two cells of which each may be off by 7 %:

    >>> at = np.array([0.5, 1.0])
    >>> load = np.array([95 * at, 105 * at])
    >>> two = [CurvePiece("T", "cyclic", "mean", at, one, 0 * at) for one in load]
    >>> seen = np.ones((2, 2), dtype=bool)
    >>> one_cell, two_cells = 0.07 * load[None], 0.07 * load * np.eye(2)[:, :, None]
    >>> for rows in (one_cell, two_cells):
    ...     print(round(between_pieces(two, load, 0 * load, rows, seen)["cyclic"], 4))
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
            # two draws of one deviation are apart by twice its variance
            found[one.kind] += float(((apart - own) / 2).sum())
            count[one.kind] += int(np.count_nonzero(both))
    return {
        kind: float(np.sqrt(max(sum_, 0.0) / count[kind])) if count[kind] else float("nan")
        for kind, sum_ in found.items()
    }


def variance_apart(pieces: Sequence[CurvePiece], strain: Floats, tension: Floats) -> Floats:
    """Variance of each piece by shared errors, without the part that all pieces have alike.

    Parameters
    ----------
    pieces : sequence of CurvePiece, length n_pieces
        Of one curve.
    strain : ndarray, shape (n,)
        The grid. [1]
    tension : ndarray, shape (n_pieces, n)
        On it, zero where a piece is not. [N]

    Returns
    -------
    variance : ndarray, shape (n_pieces, n)
        Zero of what is a load cell of all of them. [N2]

    Raises
    ------
    ValueError
        If the grid is not that of the tensions.

    Notes
    -----
    An error that is in all pieces moves their mean by as much, whatever their weights, and says
    nothing of which of them to trust.  Of each error what all of them have is the share of the
    tension that is nearest to zero, and none where the signs differ ([2]_, F.1.2.3).  Beyond its
    ends a piece has the share of its end, so that no weight jumps where a piece begins.

    Examples
    --------
    One of two cells is good to 5 %, a third error of 3 % is in both:

    >>> from reduction.uncertainty.product import Component
    >>> at, both = np.array([0.5, 1.0]), Component("position_gain", "crosshead")
    >>> cell = Component("tension_gain", "cell")
    >>> load = 100 * at
    >>> good = CurvePiece("T-1", "cyclic", "mean", at, load, 0 * at, (both,), 0.03 * load[None])
    >>> bad = CurvePiece("T-2", "cyclic", "mean", at, load, 0 * at, (both, cell),
    ...     np.stack([0.03 * load, 0.05 * load]))
    >>> print(np.sqrt(variance_apart([good, bad], at, np.stack([load, load]))))
    [[0.  0. ]
     [2.5 5. ]]
    """
    relative = [replace(one, contribution=one.contribution / one.tension) for one in pieces]
    share = stacked([one.shared_at(strain) for one in relative]).values["tension"]
    common = np.clip(0.0, share.min(axis=1), share.max(axis=1))
    return np.asarray(((share - common[:, None]) ** 2).sum(axis=0) * tension**2)


def beside_loops(
    pieces: Sequence[CurvePiece], strain: Floats, tension: Floats, known: Bools
) -> Floats:
    """Relative difference of first loadings to the kinds before them, over strain.

    Parameters
    ----------
    pieces : sequence of CurvePiece, length n_pieces
        Kind by kind, those that go before first.
    strain : ndarray, shape (n,)
        The grid. [1]
    tension : ndarray, shape (n_pieces, n)
        On it, zero where a piece is not. [N]
    known : ndarray of bool, shape (n_pieces, n)
        Where a piece is. [1]

    Returns
    -------
    beside : ndarray, shape (n,)
        On straight lines between the strains where both are; NaN where they never are. [1]

    Raises
    ------
    IndexError
        If the arrays are not of these pieces.

    Notes
    -----
    Another state of the material, not another reading of it: nothing is taken off ([1]_).

    Examples
    --------
    >>> at = np.array([0.5, 1.0])
    >>> load = np.array([110 * at, 90 * at])
    >>> pair = [CurvePiece("T", kind, "ascending", at, one, 0 * at)
    ...     for kind, one in zip(("cyclic", "first-loading"), load)]
    >>> print(beside_loops(pair, at, load, load > 0).round(6))
    [0.2 0.2]
    """
    own = np.array([one.kind == "first-loading" for one in pieces])
    before = np.cumsum(own) == 0
    both = known[own].any(axis=0) & known[before].any(axis=0)
    if not both.any():
        return np.full(strain.size, np.nan)
    # tension is zero where a piece is not
    first, other = (
        tension[rows][:, both].sum(axis=0) / known[rows][:, both].sum(axis=0)
        for rows in (own, before)
    )
    return np.asarray(np.interp(strain, strain[both], 2 * np.abs(first - other) / (first + other)))

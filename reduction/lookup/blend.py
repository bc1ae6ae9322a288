"""Pieces on one grid of strain: their weights, their mean, and the nearest curve that rises.

References
----------
.. [1] R. E. Barlow, D. J. Bartholomew, J. M. Bremner and H. D. Brunk, "Statistical Inference
   under Order Restrictions," Wiley, 1972 (isotonic regression, and with bounds).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from reduction.lookup.betweenpieces import beside_loops, between_pieces, variance_apart
from reduction.lookup.pieces import CurvePiece, PieceKind
from reduction.record import Bools, Floats, Integers, read_only_arrays
from reduction.uncertainty.join import stacked
from reduction.uncertainty.product import Component

# share of a range, from its end, after which a kind that goes before is alone
_HAND_OVER = 0.1
# weight at the very end of a piece: it decides nothing where another piece is, all where none is
_LEAST_WEIGHT = 1e-18
# no tension is known better than this share of it: an uncertainty of zero may not decide alone
_LEAST_UNCERTAINTY = 1e-3
# share of the weight below which a piece has no say
_NO_SAY = 0.01
# least slope, over the mean one, where pieces themselves fall: the curve has to rise
_LEAST_SLOPE = 1e-6


@dataclass(frozen=True)
@read_only_arrays
class Blend:
    """Pieces as one curve on a grid; arrays have shape (n,), of intervals (n - 1,).

    Parameters
    ----------
    strain, tension, variance : ndarray
        Nodes that a piece reaches, the rising curve [N], its variance but for what is shared [N2].
    component : tuple of Component, length n_components
        Errors that pieces share.
    contribution : ndarray, shape (n_components, n)
        What each of them adds to the rising curve, signed. [N]
    variance_apart : ndarray
        By which a piece may lie off the curve: without what all pieces share. [N2]
    change : ndarray
        Of the rising curve from the weighted mean. [N]
    piece : ndarray of int
        With the greatest weight.
    is_covered, is_join : ndarray of bool
        Of each interval: a piece reaches over it; more than one has a say.
    between_pieces : dict of str to float
        Relative deviation between pieces of each kind; NaN without an overlap. [1]
    beside_loops : float
        Greatest relative difference of first loadings to the kinds before them; NaN where these do
        not overlap. [1]
    farthest : ndarray
        Of the rising curve from a piece that has a say there. [N]
    """

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


def blend_pieces(
    pieces: Sequence[CurvePiece], *, taper: float, least_slope: float, n_points: int
) -> Blend:
    """Weighted mean of pieces, and the nearest curve that rises.

    Parameters
    ----------
    pieces : sequence of CurvePiece
        Kind by kind, those that go before first. [SI]
    taper : float
        Share of a piece at each end over which its weight falls to zero. [1]
    least_slope : float
        Share of the least slope of the pieces there, below which the curve may not fall. [1]
    n_points : int
        Of the grid. [1]

    Returns
    -------
    blend : Blend
        On the nodes that a piece reaches. [SI]

    Raises
    ------
    DataError
        Never by itself: pieces are checked when they are made.

    Notes
    -----
    Isotonic regression ([1]_) of the mean less the integral of the least slope, with the weight
    of all pieces there, bounded below by zero tension: the least squares solution.  Where one
    piece is alone its slope is above a share of itself, and nothing is moved.

    A first loading is another state than the loops that follow it.  Behind another kind it has no
    say where that one reaches, and what it differs by from it there is in its uncertainty beyond,
    a straight line between the strains where that is known.  Other kinds hand over inside.

    What pieces share is in their mean by its sign, and has no say in how they are weighted as far
    as all of them have it; the curve that rises has the same share of it.

    Examples
    --------
    >>> at = np.array([0.5, 1.0])
    >>> one = CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)
    >>> blend_pieces([one], taper=0.5, least_slope=0.5, n_points=3).tension
    array([ 50.,  75., 100.])
    """
    strain, is_covered = _grid(pieces, n_points)
    tension, variance, fade = _on_grid(pieces, strain, taper)
    shared = stacked([one.shared_at(strain) for one in pieces])
    rows = shared.values["tension"] * (fade > 0)
    apart = variance_apart(pieces, strain, tension)
    simple = (fade * tension).sum(axis=0) / fade.sum(axis=0)
    between = between_pieces(pieces, tension, variance, rows, fade > 0)
    beside = beside_loops(pieces, strain, tension, fade > 0)
    is_first = np.array([one.kind == "first-loading" for one in pieces])
    # of the kind of each piece: rises from slack differ by far more than cycles do
    own_kind = np.nan_to_num([between[one.kind] for one in pieces])[:, None]
    differs = np.hypot(own_kind, is_first[:, None] * np.nan_to_num(beside)) * simple
    least = (_LEAST_UNCERTAINTY * simple) ** 2
    weight = fade / np.maximum(variance + apart + differs**2, least)
    total = weight.sum(axis=0)
    share = weight / total
    mean = (share * tension).sum(axis=0)
    middle = (share[:, 1:] + share[:, :-1]) / 2
    slopes = _least_slopes(strain, tension, mean, middle, is_covered, least_slope)
    rising = _rising(strain, mean, total * _widths(strain, is_covered), slopes)
    off = (share * (tension - mean) ** 2).sum(axis=0)
    own = (share * variance).sum(axis=0)
    own += np.maximum(off, (share * differs**2).sum(axis=0)) + (rising - mean) ** 2
    return Blend(
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


def _grid(pieces: Sequence[CurvePiece], n_points: int) -> tuple[Floats, Bools]:
    """Strains that a piece reaches, and which of the intervals between them one covers."""
    ends = np.array([(one.strain[0], one.strain[-1]) for one in pieces])
    fine = np.linspace(ends.min(), ends.max(), n_points)
    # a node nearer to an end than this is that end
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


def _on_grid(
    pieces: Sequence[CurvePiece], strain: Floats, taper: float
) -> tuple[Floats, Floats, Floats]:
    """Tension, variance and fading weight of each piece on the grid; zero outside it."""
    tension, variance, fade = np.zeros((3, len(pieces), strain.size))
    over, taken = np.zeros((2, strain.size))
    kind = pieces[0].kind
    for row, one in enumerate(pieces):
        if one.kind != kind:  # what goes before has had its say: the rest is left over
            over, taken, kind = np.maximum(over, taken), np.zeros(strain.size), one.kind
        inside = (strain >= one.strain[0]) & (strain <= one.strain[-1])
        at = strain[inside]
        depth = np.minimum(at - one.strain[0], one.strain[-1] - at)
        depth /= one.strain[-1] - one.strain[0]
        tension[row, inside] = np.interp(at, one.strain, one.tension)
        variance[row, inside] = np.interp(at, one.strain, one.random_standard_uncertainty) ** 2
        full = np.minimum(depth / taper, 1.0)
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
    """Width of strain that each node stands for; none of a gap."""
    steps = np.where(is_covered, np.diff(strain), 0.0)
    widths = (np.concatenate([[0.0], steps]) + np.concatenate([steps, [0.0]])) / 2
    return np.asarray(np.maximum(widths, 1e-12 * strain[-1]))


def _least_slopes(
    strain: Floats,
    tension: Floats,
    mean: Floats,
    share: Floats,
    is_covered: Bools,
    least_slope: float,
) -> Floats:
    """Slope below which the curve may not fall in each interval: of the softest piece there."""
    slopes = np.diff(tension, axis=1) / np.diff(strain)
    of_pieces = np.where(share > _NO_SAY, slopes, np.inf).min(axis=0)
    # what a piece says outside its range is nothing: a gap has a chord of those beside it
    told = np.flatnonzero(is_covered & np.isfinite(of_pieces))
    place = np.searchsorted(told, np.arange(is_covered.size))
    chords = np.where(share > _NO_SAY, _chords(strain, tension)[:, None], np.inf).min(axis=0)
    beside = [chords[told[np.clip(place - back, 0, told.size - 1)]] for back in (1, 0)]
    softest = np.minimum(*beside)  # infinite where no piece has a chord: it bounds nothing there
    least = least_slope * np.where(np.isfinite(softest), softest, 0.0)
    least[told] = least_slope * of_pieces[told]
    return np.asarray(np.maximum(least, _LEAST_SLOPE * mean.max() / strain[-1]))


def _chords(strain: Floats, tension: Floats) -> Floats:
    """Slope of each piece from its first node to its last one."""
    reached = tension > 0
    first = reached.argmax(axis=1)
    last = strain.size - 1 - reached[:, ::-1].argmax(axis=1)
    row = np.arange(len(tension))
    apart = strain[last] - strain[first]
    # a piece between two nodes of the grid has no chord there
    risen = tension[row, last] - tension[row, first]
    return np.asarray(np.divide(risen, apart, out=np.full(row.size, np.inf), where=apart > 0))


def _rising(strain: Floats, mean: Floats, weight: Floats, least: Floats) -> Floats:
    """Nearest curve whose slope is nowhere below the least one, and whose tension is above zero."""
    given = np.concatenate([[0.0], np.cumsum(least * np.diff(strain))])
    found = scipy.optimize.isotonic_regression(mean - given, weights=weight / weight.max())
    rest = np.asarray(found.x, dtype=np.float64)
    bound = _LEAST_SLOPE * mean.max() * strain[0] / strain[-1]
    rising = np.maximum(rest, bound) + given
    # where nothing had to move, the mean itself, not its copy by way of a difference
    moved = np.abs(rising - mean) > 1e-12 * mean.max()
    return np.where(moved, rising, mean)

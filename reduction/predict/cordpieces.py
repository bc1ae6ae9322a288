r"""A cord curve as polynomials between its points, evaluated without large powers.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.4.
.. [2] F. N. Fritsch and R. E. Carlson, "Monotone piecewise cubic interpolation," SIAM J. Numer.
   Anal., vol. 17, no. 2, pp. 238-246, 1980.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import NDArray

from reduction.predict.cordcurve import CordCurve
from reduction.record import Floats

FEW_KNOTS = 32
"""Up to here a comparison with every knot is quicker than a search."""


@dataclass(frozen=True)
class CordPieces:
    """A cord curve as polynomials, one a column: slack, one between two points each, broken.

    Parameters
    ----------
    knot : ndarray, shape (n_points,)
        Strains of the points. [1]
    origin : ndarray, shape (n_points + 1,)
        Strain from which the polynomial of a piece counts. [1]
    coefficient : ndarray, shape (n_terms, n_points + 1)
        Highest power first; zero where slack, NaN where broken.
    """

    knot: Floats
    origin: Floats
    coefficient: Floats


def pieces_of(curve: CordCurve, *, order: Literal[0, 1, -1] = 0) -> CordPieces:
    """Polynomials of a cord curve, of its slope, or of its integral.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    order : {0, 1, -1}
        Of the derivative; -1 is the integral from zero strain.

    Returns
    -------
    pieces : CordPieces
        For `piece_of` and `evaluate`.

    Raises
    ------
    ValueError
        From scipy, if the points do not rise; `CordCurve` has seen to that.

    Notes
    -----
    Source: [2]_, as `scipy.interpolate.PchipInterpolator` has it.

    Examples
    --------
    >>> line = pieces_of(CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])))
    >>> print(line.coefficient[-2])
    [ 0. 650. nan]
    """
    cubic = scipy.interpolate.PchipInterpolator(curve.strain, curve.load)
    match order:
        case 1:
            coefficient = cubic.derivative().c
        case -1:
            coefficient = cubic.antiderivative().c
        case _:
            coefficient = cubic.c
    edge = np.ones((len(coefficient), 1))
    return CordPieces(
        knot=curve.strain,
        origin=np.concatenate([[0.0], curve.strain[:-1], [0.0]]),
        coefficient=np.hstack([0 * edge, coefficient, np.nan * edge]),
    )


def piece_of(pieces: CordPieces, strain: Floats) -> NDArray[np.intp]:
    """Which polynomial a strain belongs to.

    Parameters
    ----------
    pieces : CordPieces
        Of a cord.
    strain : ndarray, shape (...)
        Of the cord. [1]

    Returns
    -------
    piece : ndarray of int, shape (...)
        0 where slack (strain not above zero), the number of points where broken. [1]

    Raises
    ------
    ValueError
        From numpy, if the strains are no array of numbers.

    Notes
    -----
    The break strain itself is still borne ([1]_, sec. 1.2.4).

    Examples
    --------
    >>> line = pieces_of(CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])))
    >>> print(piece_of(line, np.array([-0.1, 0.0, 0.1, 0.2, 0.3])))
    [0 0 1 1 2]
    """
    if len(pieces.knot) > FEW_KNOTS:
        return np.asarray(np.searchsorted(pieces.knot, strain), dtype=np.intp)
    n_below, is_above = (
        np.zeros(strain.shape, dtype=np.int8),
        np.empty(strain.shape, dtype=np.bool_),
    )
    for knot in pieces.knot:
        np.greater(strain, knot, out=is_above)
        n_below += is_above
    return n_below.astype(np.intp)


def evaluate_into(
    out: Floats, scratch: Floats, pieces: CordPieces, strain: Floats, piece: NDArray[np.intp]
) -> Floats:
    """Write the values of the polynomials into an array.

    Parameters
    ----------
    out, scratch : ndarray, shape (...)
        Written; loads in `out` where the pieces are those of the load. [N]
    pieces : CordPieces
        Of a cord.
    strain : ndarray, shape (...)
        Of the cord; overwritten by strain from the left end of the piece. [1]
    piece : ndarray of int, shape (...)
        From `piece_of`. [1]

    Returns
    -------
    out : ndarray, shape (...)
        The array given: load [N], slope [N] or energy a length [J m-1], by the pieces. [N]

    Raises
    ------
    ValueError
        From numpy, if shapes differ.

    Notes
    -----
    Horner's rule from the left end of each piece, so that no large powers cancel ([2]_).

    Examples
    --------
    >>> line = pieces_of(CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])))
    >>> strain = np.array([-0.1, 0.1, 0.3])
    >>> print(evaluate_into(np.empty(3), np.empty(3), line, strain, piece_of(line, strain)))
    [ 0. 65. nan]
    """
    strain -= pieces.origin.take(piece, mode="clip", out=scratch)
    pieces.coefficient[0].take(piece, mode="clip", out=out)
    for coefficient in pieces.coefficient[1:]:
        out *= strain
        out += coefficient.take(piece, mode="clip", out=scratch)
    return out

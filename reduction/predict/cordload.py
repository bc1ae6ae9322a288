r"""Load on a cord between the measured points: monotone cubics, and their inverse.

Between two points the load is a cubic of strain whose slopes at the points are those of Fritsch
and Carlson as scipy has them (PCHIP), so that it rises wherever the points do and goes through
each of them.  A cord carries nothing below zero strain, and beyond its last point it is broken:
NaN.  The curve is that of one slow pull: creep, hysteresis and the stiffening of nylon under fast
cycles are not in it.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2.1, 1.2.4: the load-elongation curve of the cord is an input.
.. [2] F. N. Fritsch and R. E. Carlson, "Monotone piecewise cubic interpolation," SIAM J. Numer.
   Anal., vol. 17, no. 2, pp. 238-246, 1980.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.predict.cordcurve import CordCurve
from reduction.predict.cordpieces import CordPieces, evaluate_into, piece_of, pieces_of
from reduction.record import Floats

MOST_STEPS = 100
"""Of the inverse of a cord curve; some six are usual, and halving alone needs fifty-three."""


def cord_load(curve: CordCurve, strain: ArrayLike) -> Floats:
    """Load on one cord.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    strain : array_like, shape (...)
        Of the cord. [1]

    Returns
    -------
    load : ndarray, shape (...)
        0 where the strain is not above zero, NaN beyond the last point. [N]

    Raises
    ------
    ValueError
        From numpy, if the strains are no array of numbers.

    Notes
    -----
    Source: [1]_, sec. 1.2.1; [2]_ between the points.

    Examples
    --------
    >>> curve = CordCurve(strain=np.array([0.0, 0.1, 0.2]), load=np.array([0.0, 40.0, 130.0]))
    >>> print(cord_load(curve, [-0.01, 0.1, 0.2, 0.21]))
    [ 0. 40. 130. nan]
    """
    return _value(pieces_of(curve), strain)


def cord_stiffness(curve: CordCurve, strain: ArrayLike) -> Floats:
    """Slope of the load on one cord over its strain.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    strain : array_like, shape (...)
        Of the cord. [1]

    Returns
    -------
    stiffness : ndarray, shape (...)
        0 where the strain is not above zero, NaN beyond the last point. [N]

    Raises
    ------
    ValueError
        From numpy, if the strains are no array of numbers.

    Notes
    -----
    Continuous but for the pick-up, where it jumps from zero; its own slope jumps at the points
    ([2]_).

    Examples
    --------
    >>> line = CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0]))
    >>> print(cord_stiffness(line, [-0.1, 0.1, 0.3]))
    [ 0. 650. nan]
    """
    return _value(pieces_of(curve, order=1), strain)


def cord_energy(curve: CordCurve, strain: ArrayLike) -> Floats:
    """Energy in one cord, a length at rest: the integral of its load over strain.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    strain : array_like, shape (...)
        Of the cord. [1]

    Returns
    -------
    energy : ndarray, shape (...)
        0 where the strain is not above zero, NaN beyond the last point. [J m-1]

    Raises
    ------
    ValueError
        From numpy, if the strains are no array of numbers.

    Notes
    -----
    The quartics that belong to the cubics of [2]_.

    Examples
    --------
    >>> line = CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0]))
    >>> print(cord_energy(line, [0.0, 0.1, 0.2]))
    [ 0. 3.25 13. ]
    """
    return _value(pieces_of(curve, order=-1), strain)


def cord_strain_at(curve: CordCurve, load: ArrayLike) -> Floats:
    """Strain at which one cord bears a load: the inverse of `cord_load`.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    load : array_like, shape (...)
        On one cord. [N]

    Returns
    -------
    strain : ndarray, shape (...)
        0 at no load; NaN below zero and beyond the break load. [1]

    Raises
    ------
    ValueError
        From numpy, if the loads are no array of numbers.

    Notes
    -----
    Newton's rule on the cubic of the piece, all loads at once; a step that would leave the
    bracket is replaced by a halving of it.  Ends where a step no longer changes a number, so that
    the load at the strain found is the one asked for to rounding ([2]_ for the cubics).

    Examples
    --------
    >>> curve = CordCurve(strain=np.array([0.0, 0.1, 0.2]), load=np.array([0.0, 40.0, 130.0]))
    >>> print(cord_strain_at(curve, [0.0, 40.0, 130.0, 131.0]))
    [0. 0.1 0.2 nan]
    """
    wanted = np.asarray(load, dtype=np.float64)
    pieces = pieces_of(curve)
    is_borne = (wanted >= 0) & (wanted <= curve.break_load)
    asked = np.where(is_borne, wanted, 0.0)
    left = np.clip(np.searchsorted(curve.load, asked, side="right") - 1, 0, len(curve.load) - 2)
    cubic, square, slope = pieces.coefficient[:3, left + 1]
    above = asked - curve.load[left]
    low, high = np.zeros_like(above), np.diff(curve.strain)[left]
    local = _first_guess(above, slope, square, high)
    for _ in range(MOST_STEPS):
        miss = local * (slope + local * (square + local * cubic)) - above
        low, high = np.where(miss <= 0, local, low), np.where(miss >= 0, local, high)
        rate = slope + local * (2 * square + local * 3 * cubic)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            step = local - miss / rate
        inside = (step >= low) & (step <= high)
        better = np.where(inside, step, low + (high - low) / 2)
        is_done = (miss == 0) | (np.abs(better - local) <= np.spacing(local))
        if np.all(is_done):
            break
        local = np.where(is_done, local, better)
    strain = np.where(asked == curve.break_load, curve.break_strain, curve.strain[left] + local)
    return np.asarray(np.where(is_borne, strain, np.nan))


def _first_guess(above: Floats, slope: Floats, square: Floats, width: Floats) -> Floats:
    """Where a piece without its cubic term bears the load: right for small loads at any slope."""
    with np.errstate(divide="ignore", invalid="ignore"):
        guess = 2 * above / (slope + np.sqrt(slope**2 + 4 * square * above))
    return np.asarray(np.clip(np.where(np.isnan(guess), 0.0, guess), 0.0, width))


def _value(pieces: CordPieces, strain: ArrayLike) -> Floats:
    local = np.array(strain, dtype=np.float64)
    piece = piece_of(pieces, local)
    return evaluate_into(np.empty_like(local), np.empty_like(local), pieces, local, piece)

"""Load of one cord against its strain.

**Load on a cord between the measured points: monotone cubics, and their inverse.** Between two
points the load is a cubic of strain with the Fritsch-Carlson slopes at the points, as in scipy
(PCHIP), so it rises wherever the points do and passes through each of them.  A cord carries no load
below zero strain, and is broken (NaN) beyond its last point.  The curve is that of one slow pull:
creep, hysteresis and the stiffening of nylon under fast cycles are not included.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, sec. 1.2.4; sec. 1.2.1,
   1.2.4: the load-elongation curve of the cord is an input.
.. [2] F. N. Fritsch and R. E. Carlson, "Monotone piecewise cubic interpolation," SIAM J. Numer.
   Anal., vol. 17, no. 2, pp. 238-246, 1980.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, read_only_arrays

_ROUNDING = 1e-12


@dataclass(frozen=True)
@read_only_arrays
class CordCurve:
    """Measured points of a cord, the last one its break.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        Begins at 0, strictly increasing. [1]
    load : ndarray, shape (n_points,)
        Begins at 0, strictly increasing. [N]
    """

    strain: Floats
    load: Floats

    def __post_init__(self) -> None:
        """Check that the curve begins at zero and rises, and make the arrays read-only."""
        if self.strain.ndim != 1 or self.strain.shape != self.load.shape or self.strain.size < 2:
            raise SettingsError(
                "the points of the cord curve do not pair up",
                found=f"{self.strain.size} strains, {self.load.size} loads",
                needed="as many loads as strains, two or more",
            )
        for name, unit, values in (("strain", "", self.strain), ("load", " N", self.load)):
            if not np.all(np.isfinite(values)):
                raise SettingsError(f"cord.{name} is not finite", needed="numbers")
            if values[0] != 0:
                raise SettingsError(
                    f"cord.{name} does not begin at zero", found=f"{values[0]:g}{unit}", needed="0"
                )
            if not np.all(np.diff(values) > 0):
                place = int(np.flatnonzero(np.diff(values) <= 0)[0])
                raise SettingsError(
                    f"cord.{name} does not rise at point {place + 2}",
                    found=f"{values[place + 1]:g} after {values[place]:g}{unit}",
                    needed="a strictly rising curve up to the break",
                )

    @property
    def break_strain(self) -> float:
        """Strain of the last point. [1]."""
        return float(self.strain[-1])

    @property
    def break_load(self) -> float:
        """Load of the last point. [N]."""
        return float(self.load[-1])

    @cached_property
    def cubic(self) -> scipy.interpolate.PchipInterpolator:
        """Load as a function of strain, monotone between the points."""
        return scipy.interpolate.PchipInterpolator(self.strain, self.load)


FEW_KNOTS = 32
"""Up to this number of knots, comparing with each is faster than a search."""


@dataclass(frozen=True)
class CordPieces:
    """A cord curve as polynomials, one per column: slack, one between two points each, broken.

    Parameters
    ----------
    knot : ndarray, shape (n_points,)
        Strains of the points. [1]
    origin : ndarray, shape (n_points + 1,)
        Origin of strain for the polynomial of a piece. [1]
    coefficient : ndarray, shape (n_terms, n_points + 1)
        Highest power first; zero where slack, NaN where broken.
    """

    knot: Floats
    origin: Floats
    coefficient: Floats


def pieces_of(curve: CordCurve, *, order: Literal[0, 1, -1] = 0) -> CordPieces:
    """Polynomials of a cord curve, of its slope, or of its integral.

    Notes
    -----
    Source: [2]_, as in `scipy.interpolate.PchipInterpolator`.

    Examples
    --------
    >>> line = pieces_of(CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0])))
    >>> print(line.coefficient[-2])
    [ 0. 650. nan]
    """
    cubic = curve.cubic
    match order:
        case 1:
            coefficient = cubic.derivative().c
        case -1:
            coefficient = cubic.antiderivative().c
        case _:
            coefficient = cubic.c
    edge = np.ones((len(coefficient), 1))
    # the strain of a hose at the break of its cords, converted to the cord, is off by rounding
    knot = np.append(curve.strain[:-1], curve.break_strain * (1 + _ROUNDING))
    return CordPieces(
        knot=knot,
        origin=np.concatenate([[0.0], curve.strain[:-1], [0.0]]),
        coefficient=np.hstack([0 * edge, coefficient, np.nan * edge]),
    )


def piece_of(pieces: CordPieces, strain: Floats) -> NDArray[np.intp]:
    """Index of the polynomial for a strain.

    Notes
    -----
    The cord still carries load at the break strain ([1]_, sec. 1.2.4).

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


MOST_STEPS = 100
"""Greatest number of steps for the inverse; about six are usual, bisection alone needs 53."""


def cord_load(curve: CordCurve, strain: ArrayLike) -> Floats:
    """Load on one cord.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    strain : array_like, shape (...)
        Strain of the cord. [1]

    Returns
    -------
    load : ndarray, shape (...)
        0 where the strain is not positive, NaN beyond the last point. [N]

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
    """Derivative of the load on one cord with respect to its strain.

    Notes
    -----
    Continuous except at pick-up, where it jumps from zero; its own slope jumps at the points
    ([2]_).

    Examples
    --------
    >>> line = CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0]))
    >>> print(cord_stiffness(line, [-0.1, 0.1, 0.3]))
    [ 0. 650. nan]
    """
    return _value(pieces_of(curve, order=1), strain)


def cord_energy(curve: CordCurve, strain: ArrayLike) -> Floats:
    """Energy in one cord per rest length: the integral of its load over strain.

    Notes
    -----
    The quartics that are the integrals of the cubics of [2]_.

    Examples
    --------
    >>> line = CordCurve(strain=np.array([0.0, 0.2]), load=np.array([0.0, 130.0]))
    >>> print(cord_energy(line, [0.0, 0.1, 0.2]))
    [ 0. 3.25 13. ]
    """
    return _value(pieces_of(curve, order=-1), strain)


def cord_strain_at(curve: CordCurve, load: ArrayLike) -> Floats:
    """Strain at which one cord carries a load: the inverse of `cord_load`.

    Parameters
    ----------
    curve : CordCurve
        Measured points.
    load : array_like, shape (...)
        On one cord. [N]

    Returns
    -------
    strain : ndarray, shape (...)
        0 at zero load; NaN below zero and beyond the break load. [1]

    Notes
    -----
    Newton's method on the cubic of the piece, for all loads at once; a step that would leave the
    bracket is replaced by bisection.  It ends when a step no longer changes a number, so the load
    at the result equals the given load to rounding ([2]_ for the cubics).

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
    """Solution for a piece without its cubic term: right for small loads at any slope."""
    with np.errstate(divide="ignore", invalid="ignore"):
        guess = 2 * above / (slope + np.sqrt(slope**2 + 4 * square * above))
    return np.asarray(np.clip(np.where(np.isnan(guess), 0.0, guess), 0.0, width))


def _value(pieces: CordPieces, strain: ArrayLike) -> Floats:
    local = np.array(strain, dtype=np.float64)
    piece = piece_of(pieces, local)
    return evaluate_into(np.empty_like(local), np.empty_like(local), pieces, local, piece)

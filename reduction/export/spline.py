r"""A curve as a rising function with a continuous second derivative.

The stiffness is a sum of quadratic B-splines with positive weights, so the tension, its integral,
is a cubic spline with two continuous derivatives that rises everywhere ([1]_):

.. math:: T(e) = \sum_k c_k \int_0^e B_k, \qquad c_k > 0.

References
----------
.. [1] J. O. Ramsay, "Monotone regression splines in action," Statist. Sci., vol. 3, no. 4,
   pp. 425-441, 1988.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from reduction.export.thin import curve_from_zero, local_share, thin_curve
from reduction.record import Floats, read_only_arrays

_DEGREE = 2
_FIRST, _MOST = 4, 24
_SHORTEST = 1e-3
_ENOUGH = 1e-3
_LEAST_SLOPE = 1e-6
_GRID = 801


@dataclass(frozen=True)
@read_only_arrays
class SmoothCurve:
    """Cubic pieces of a curve.

    Parameters
    ----------
    start : ndarray, shape (n_pieces,)
        Strain at which each begins; the first is zero. [1]
    end : float
        Of the last one. [1]
    coefficient : ndarray, shape (n_pieces, 4)
        Of rising powers of the strain less ``start``. [N]
    error, share : float
        Greatest difference in tension from the curve that was given [N], and over the greatest
        tension. [1]
    local : float
        The greatest difference over the tension at its place, or a thousandth of the greatest
        tension. [1]
    words : str
        What was added at the start.
    """

    start: Floats
    end: float
    coefficient: Floats
    error: float
    share: float
    local: float
    words: str


def fit_smooth_curve(strain: Floats, tension: Floats) -> SmoothCurve:
    """Fit a rising cubic spline to a curve.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        Strictly rising. [1]
    tension : ndarray, shape (n_points,)
        Not falling. [N]

    Returns
    -------
    curve : SmoothCurve
        With as many pieces as come within a thousandth of the greatest tension, or the closest
        with at most 24.

    Raises
    ------
    DataError
        If the curve cannot be exported; see `reduction.export.thin.curve_from_zero`.

    Notes
    -----
    The first pieces begin where a curve thinned to five points has them; then the piece with the
    greatest error is halved, again and again, but never below a thousandth of the strain. Least
    squares on an even grid and on the points; the error is the greatest one anywhere.

    Examples
    --------
    >>> at = np.linspace(0, 1, 50)
    >>> fit_smooth_curve(at, 100 * at**3).share < 1e-3
    True
    """
    at, load, words = curve_from_zero(strain, tension)
    end, top = float(at[-1]), float(load[-1])
    grid = np.union1d(np.linspace(0.0, end, _GRID), at)
    wanted = np.interp(grid, at, load)
    knots = thin_curve(at, load, most=_FIRST + 1).strain[:-1]
    knots = knots[np.append(True, np.diff(knots) > _SHORTEST * end)]
    knots = knots[end - knots > _SHORTEST * end]
    best = _fitted(grid, wanted, knots, end, top)
    error, worst = _greatest_error(best, at, load)
    while error > _ENOUGH * top and knots.size < _MOST:
        bounds = np.append(knots, end)
        piece = min(int(np.searchsorted(knots, worst, side="right")), knots.size) - 1
        if bounds[piece + 1] - bounds[piece] <= 2 * _SHORTEST * end:
            piece = int(np.diff(bounds).argmax())
        knots = np.insert(knots, piece + 1, (bounds[piece] + bounds[piece + 1]) / 2)
        fitted = _fitted(grid, wanted, knots, end, top)
        off, worst = _greatest_error(fitted, at, load)
        if off < error:
            best, error = fitted, off
    local = local_share(best(grid) - wanted, wanted, top)
    return SmoothCurve(
        best.x[:-1].copy(), end, best.c[::-1].T.copy(), error, error / top, local, words
    )


def _greatest_error(
    fitted: scipy.interpolate.PPoly, at: Floats, load: Floats
) -> tuple[float, float]:
    """Greatest difference from the straight lines between the points, and its strain."""
    breaks = np.union1d(at, fitted.x)
    step = np.clip(np.searchsorted(at, breaks[:-1], "right") - 1, 0, at.size - 2)
    slope = (np.diff(load) / np.diff(at))[step]
    # where the slopes are equal: a quadratic in the strain above the start of the piece
    piece = np.clip(np.searchsorted(fitted.x, breaks[:-1], "right") - 1, 0, fitted.c.shape[1] - 1)
    cubic, square, linear = fitted.c[:3, piece]
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(square**2 - 3 * cubic * (linear - slope))
        both = np.stack([(-square + root) / (3 * cubic), (-square - root) / (3 * cubic)])
        flat = (slope - linear) / (2 * square)
    places = fitted.x[piece] + np.concatenate([both, flat[np.newaxis]])
    inside = (places > breaks[:-1]) & (places < breaks[1:])
    places = np.concatenate([breaks, places[inside]])
    off = np.abs(fitted(places) - np.interp(places, at, load))
    return float(off.max()), float(places[off.argmax()])


def _fitted(
    grid: Floats, wanted: Floats, knots: Floats, end: float, top: float
) -> scipy.interpolate.PPoly:
    """Integral of positive quadratic B-splines through 0 0, as pieces."""
    whole = np.concatenate([[0.0] * _DEGREE, knots, [end] * (_DEGREE + 1)])
    count = whole.size - _DEGREE - 1
    integrals = [
        scipy.interpolate.BSpline(whole, row, _DEGREE, extrapolate=True).antiderivative()
        for row in np.eye(count)
    ]
    columns = np.stack([one(grid) - one(0.0) for one in integrals], axis=1)
    least = _LEAST_SLOPE * top / end
    weights, _ = scipy.optimize.nnls(
        columns / end, wanted / top - columns.sum(axis=1) * least / top
    )
    slope = scipy.interpolate.BSpline(whole, least + weights * top / end, _DEGREE)
    pieces = scipy.interpolate.PPoly.from_spline(slope.antiderivative().tck)
    # from_spline keeps the repeated knots as empty pieces
    real = np.flatnonzero(np.diff(pieces.x) > 0)
    bounds = np.append(pieces.x[real], end)
    coefficient = pieces.c[:, real].copy()
    coefficient[-1] -= coefficient[-1, 0]
    return scipy.interpolate.PPoly(coefficient, bounds)

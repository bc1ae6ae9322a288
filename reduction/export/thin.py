"""One monotone curve, begun at zero and thinned to few points with a stated error.

References
----------
.. [1] H. Imai and M. Iri, "An optimal algorithm for approximating a piecewise linear function,"
   J. Inf. Process., vol. 9, no. 3, pp. 159-162, 1986.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats, Integers, freeze_arrays

__all__ = ["LIFT", "ThinnedCurve", "curve_from_zero", "thin_curve"]

LIFT = 1e-6
"""Share of the greatest tension that is added over the curve where it does not rise. [1]"""
_HALVINGS = 48
_ROUNDING = 1e-12
_DIGITS = 10


@dataclass(frozen=True)
class ThinnedCurve:
    """A curve from 0 0, strictly rising; arrays have the shape (n_points,).

    ``error`` is the greatest difference in tension from the curve that was given [N], ``share``
    the same over the greatest tension, ``words`` what was done, ``n_given`` of how many points.
    """

    strain: Floats
    tension: Floats
    error: float
    share: float
    words: str

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def curve_from_zero(strain: ArrayLike, tension: ArrayLike) -> tuple[Floats, Floats, str]:
    """Begin a curve at zero strain and zero tension, and make it rise strictly.

    Parameters
    ----------
    strain : array_like, shape (n_points,)
        Strictly rising. [1]
    tension : array_like, shape (n_points,)
        Not falling. [N]

    Returns
    -------
    strain : ndarray, shape (n_kept,)
        The first is zero. [1]
    tension : ndarray, shape (n_kept,)
        The first is zero. [N]
    words : str
        What was added.

    Raises
    ------
    DataError
        If there are fewer than two points, one is not finite, the curve turns back or falls (a
        loop), ends at no tension, or has tension where there is no strain.

    Notes
    -----
    The rule: points without strain or without tension are left out; the last of them that has
    strain says where the line comes taut, and below it the line is slack. Where there is none, a
    straight line joins 0 0 and the first point; it was not measured. Where the curve does not
    rise, one millionth of the greatest tension is added evenly over the strain.

    Examples
    --------
    >>> strain, tension, words = curve_from_zero([0.1, 0.3], [200.0, 500.0])
    >>> print(strain, tension, words)
    [0.  0.1 0.3] [  0. 200. 500.] a straight line from 0 0 to the first point at strain 0.1
    """
    at = np.asarray(strain, dtype=np.float64)
    load = np.asarray(tension, dtype=np.float64)
    if at.ndim != 1 or at.shape != load.shape or at.size < 2:
        raise DataError(
            "a curve has not two points or more", found=f"{at.shape} strains, {load.shape} tensions"
        )
    if not (np.isfinite(at).all() and np.isfinite(load).all()):
        raise DataError("a curve has values that are not numbers", needed="finite numbers")
    back = (np.diff(at) <= 0) | (np.diff(load) < 0)
    if back.any():
        first = int(np.argmax(back))
        raise DataError(
            f"a curve turns back at {int(back.sum())} of {back.size} steps: a loop is not exported",
            found=f"strain {at[first]:g} to {at[first + 1]:g}, tension {load[first]:g} to "
            f"{load[first + 1]:g} N after point {first + 1}",
            needed="one branch, or a mean: strain rising, tension not falling",
        )
    if np.any((at <= 0) & (load > 0)):
        raise DataError(
            "a curve has tension where it has no strain",
            found=f"{load[at <= 0].max():g} N at strain {at[at <= 0].max():g}",
            needed="strain of the length at zero tension",
        )
    kept = load > 0
    if not kept.any():
        raise DataError("a curve ends at no tension", found=f"{load[-1]:g} N")
    slack = at[(at > 0) & ~kept]
    zero: Floats = np.zeros(1)
    if slack.size:
        at = np.concatenate([zero, slack[-1:], at[kept]])
        load = np.concatenate([zero, zero, load[kept]])
        words = f"slack from 0 0 to strain {slack[-1]:g}"
    else:
        has_zero = bool(np.any(~kept & (at == 0)))
        at, load = np.concatenate([zero, at[kept]]), np.concatenate([zero, load[kept]])
        words = "" if has_zero else (
            f"a straight line from 0 0 to the first point at strain {at[1]:g}"
        )  # fmt: skip
    if np.any(np.diff(load) <= _ROUNDING * load[-1]):
        load = load + LIFT * load[-1] * at / at[-1]
        added = f"{LIFT:g} of the greatest tension added over the strain, where it did not rise"
        words = f"{words}; {added}" if words else added
    return at, load, words


def thin_curve(strain: ArrayLike, tension: ArrayLike, *, most: int) -> ThinnedCurve:
    """Choose few points of a curve so that straight lines between them stay close to it.

    Parameters
    ----------
    strain : array_like, shape (n_points,)
        Strictly rising. [1]
    tension : array_like, shape (n_points,)
        Not falling. [N]
    most : int
        Points that may be kept, 0 0 among them; at least 3.

    Returns
    -------
    curve : ThinnedCurve
        From 0 0, strictly rising, numbers with ten digits.

    Raises
    ------
    DataError
        If the curve cannot be exported; see `curve_from_zero`.

    Notes
    -----
    From each kept point the farthest one is taken whose chord leaves all points between them
    within a tolerance (a cone of slopes, [1]_); the tolerance is halved between what is enough
    and what is not. The error is then taken from the points as they are written.

    Examples
    --------
    >>> at = np.linspace(0, 1, 5000)
    >>> curve = thin_curve(at, 100 * at**2, most=30)
    >>> print(curve.strain.size, round(curve.error, 3))
    30 0.03
    """
    at, load, words = curve_from_zero(strain, tension)
    high = float(load[-1])
    chosen: Integers = np.arange(at.size)
    if at.size > most:
        low, tolerance = 0.0, high
        chosen = np.array([0, at.size - 1])
        for _ in range(_HALVINGS):
            middle = max((low + tolerance) / 2, _ROUNDING * high)
            found = _within(at, load, middle, most)
            if found is None:
                low = middle
            else:
                chosen, tolerance = found, middle
    kept, held = _written(at[chosen]), _written(load[chosen])
    if np.any(np.diff(kept) <= 0) or np.any(np.diff(held) <= 0):
        kept, held = at[chosen], load[chosen]
    # tension of the points that were given, where they have strain and tension of their own
    given, measured = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    own = given >= 0
    difference = np.interp(given[own], kept, held) - np.maximum(measured[own], 0.0)
    error = float(np.abs(difference).max(initial=0.0))
    return ThinnedCurve(kept, held, error, error / high, words)


def _within(at: Floats, load: Floats, tolerance: float, most: int) -> Integers | None:
    """Points whose chords stay within the tolerance; None where they are too many."""
    last = at.size - 1
    chosen = [0]
    while chosen[-1] < last:
        if len(chosen) == most:
            return None
        here = chosen[-1]
        run, rise = at[here + 1 :] - at[here], load[here + 1 :] - load[here]
        slope = rise / run
        steepest = np.minimum.accumulate((rise + tolerance) / run)
        flattest = np.maximum.accumulate((rise - tolerance) / run)
        reached = np.flatnonzero((slope >= flattest) & (slope <= steepest))
        chosen.append(here + 1 + int(reached[-1]))
    return np.array(chosen)


def _written(values: Floats) -> Floats:
    """The numbers that ten digits give back."""
    return np.array([float(f"{value:.{_DIGITS}g}") for value in values])

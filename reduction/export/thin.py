"""One monotone curve, begun at zero and thinned to few points with a stated error.

References
----------
.. [1] H. Imai and M. Iri, "An optimal algorithm for approximating a piecewise linear function,"
   J. Inf. Process., vol. 9, no. 3, pp. 159-162, 1986.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats, Integers, read_only_arrays

LIFT = 1e-6
"""Share of the greatest tension that is added over the curve where it does not rise. [1]"""
LEAST_SHARE = 1e-3
"""Tension, over the greatest, below which an error counts as if it were that much. [1]"""
_HALVINGS = 56
_ENOUGH, _LOOSER = 0.01, 1.25
_ROUNDING = 1e-12
_DIGITS = 10


class _Close(Protocol):
    @property
    def local(self) -> float: ...


@dataclass(frozen=True)
@read_only_arrays
class ThinnedCurve:
    """A curve from 0 0, strictly rising; arrays have the shape (n_points,).

    ``error`` is the greatest difference in tension from the curve that was given [N], ``share``
    the same over the greatest tension, ``local`` the greatest difference over the tension there,
    ``words`` what was done.
    """

    strain: Floats
    tension: Floats
    error: float
    share: float
    local: float
    words: str


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
    Small tensions are where a line works, great ones where it breaks: first the error relative to
    the tension at its place (to a thousandth of the greatest one where it is below that) is made
    least; then the error over the greatest tension, with the first held to a hundredth, or to a
    quarter more than its least where that is above a hundredth.

    From each kept point the farthest one is taken whose chord leaves all points between them
    within a tolerance (a cone of slopes, [1]_); its share is halved between what is enough
    and what is not. The error is then taken from the points as they are written.

    Examples
    --------
    >>> at = np.linspace(0, 1, 5000)
    >>> curve = thin_curve(at, 100 * at**2, most=30)
    >>> print(curve.strain.size, curve.error < 0.1, curve.local < 0.01)
    30 True True
    """
    at, load, words = curve_from_zero(strain, tension)
    high = float(load[-1])
    chosen: Integers = np.arange(at.size)
    if at.size > most:
        scale = np.maximum(load, LEAST_SHARE * high)
        chosen, least = _fewest(at, load, lambda share: share * scale, most)
        near = max(_ENOUGH, _LOOSER * least) * scale
        closer, _ = _fewest(at, load, lambda share: np.minimum(share * high, near), most)
        chosen = closer if closer.size > 2 else chosen
    kept, held = _written(at[chosen]), _written(load[chosen])
    if np.any(np.diff(kept) <= 0) or np.any(np.diff(held) <= 0):
        kept, held = at[chosen], load[chosen]
    # tension of the points that were given, where they have strain and tension of their own
    given, measured = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    own = given >= 0
    difference = np.interp(given[own], kept, held) - np.maximum(measured[own], 0.0)
    error = float(np.abs(difference).max(initial=0.0))
    local = local_share(difference, measured[own], high)
    return ThinnedCurve(kept, held, error, error / high, local, words)


def local_words(curve: _Close) -> str:
    """How far a curve is off at small tensions.

    Parameters
    ----------
    curve : ThinnedCurve or SmoothCurve
        As written.

    Returns
    -------
    words : str
        A part of a sentence.

    Raises
    ------
    AttributeError
        If it is no such curve.
    """
    return f"{curve.local:.2e} of the tension there, or of {LEAST_SHARE:g} of the greatest"


def local_share(difference: ArrayLike, tension: ArrayLike, greatest: float) -> float:
    """Greatest difference over the tension at its place, or a thousandth of the greatest one.

    Parameters
    ----------
    difference : array_like, shape (n_points,)
        Of two curves. [N]
    tension : array_like, shape (n_points,)
        At the points. [N]
    greatest : float
        Of the curve. [N]

    Returns
    -------
    share : float
        Zero where there is no point. [1]

    Raises
    ------
    ValueError
        If differences and tensions do not pair up.

    Examples
    --------
    >>> print(local_share([1.0, 10.0], [20.0, 1000.0], 1000.0))
    0.05
    """
    scale = np.maximum(np.asarray(tension, dtype=np.float64), LEAST_SHARE * greatest)
    return float(np.max(np.abs(np.asarray(difference)) / scale, initial=0.0))


def _fewest(
    at: Floats, load: Floats, allowed: Callable[[float], Floats], most: int
) -> tuple[Integers, float]:
    """Points of the least share whose tolerances leave few enough, and that share."""
    chosen: Integers = np.array([0, at.size - 1])
    low, high = 0.0, 1 / LEAST_SHARE
    for _ in range(_HALVINGS):
        middle = max((low + high) / 2, _ROUNDING)
        found = _within(at, load, allowed(middle), most)
        if found is None:
            low = middle
        else:
            chosen, high = found, middle
    return chosen, high


def _within(at: Floats, load: Floats, tolerance: Floats, most: int) -> Integers | None:
    """Points whose chords stay within the tolerances; None where they are too many."""
    last = at.size - 1
    chosen = [0]
    while chosen[-1] < last:
        if len(chosen) == most:
            return None
        here = chosen[-1]
        run, rise = at[here + 1 :] - at[here], load[here + 1 :] - load[here]
        slope = rise / run
        steepest = np.minimum.accumulate((rise + tolerance[here + 1 :]) / run)
        flattest = np.maximum.accumulate((rise - tolerance[here + 1 :]) / run)
        reached = np.flatnonzero((slope >= flattest) & (slope <= steepest))
        chosen.append(here + 1 + int(reached[-1]))
    return np.array(chosen)


def _written(values: Floats) -> Floats:
    """The numbers that ten digits give back."""
    return np.array([float(f"{value:.{_DIGITS}g}") for value in values])

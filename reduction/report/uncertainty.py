"""What ± means on the page: the expanded uncertainty for 95 %, and what it is made of.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 6.2, 7.2.3 (an expanded uncertainty is given with its coverage factor), G.4.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.archive.freedom import effective_freedom
from reduction.record import Floats
from reduction.report.instruments import NOTHING_STATED, is_stated
from reduction.report.sources import FROM_READINGS, in_order, source_words
from reduction.report.view import TestView
from reduction.uncertainty.combine import coverage_factor, effective_degrees_of_freedom
from reduction.uncertainty.product import LINE_METHODS

DRAWN = (
    "In brackets: the 95 % interval by Monte Carlo, of the same errors, where they are so large"
    " that they do not propagate linearly."
)
MANY = np.inf
"""Degrees of freedom of a regression on hundreds of samples, and of what is taken as known."""
_CYCLES = "scatter between cycles, noise, regression"
_INSTRUMENTS = "errors of the instruments"


@dataclass(frozen=True)
class Expanded:
    """Expanded uncertainty of several numbers, and the factor of each; in one shape."""

    half: Floats
    factor: Floats

    @property
    def factors(self) -> tuple[float, ...]:
        """Factors of the numbers that have an uncertainty."""
        return tuple(np.unique(self.factor[np.isfinite(self.half)]).tolist())


def expand(
    standard_uncertainty: ArrayLike,
    *,
    random: ArrayLike | None = None,
    degrees_of_freedom: ArrayLike = MANY,
) -> Expanded:
    """Return the expanded uncertainty for 95 %.

    Parameters
    ----------
    standard_uncertainty : array_like
        Combined. [any]
    random : array_like, optional
        Its random part; all of it where not given. [as standard_uncertainty]
    degrees_of_freedom : array_like
        Of the random part. [1]

    Examples
    --------
    The same scatter of ten cycles alone, and beside a shared part of twice its size:

    >>> found = expand([1.0, np.sqrt(5)], random=[1.0, 1.0], degrees_of_freedom=9.0)
    >>> print(found.half.round(1), found.factor.round(2))
    [2.3 4.4] [2.26 1.97]
    """
    spread = np.asarray(standard_uncertainty, dtype=np.float64)
    part = spread if random is None else np.asarray(random, dtype=np.float64)
    rest = np.sqrt(np.maximum(spread**2 - part**2, 0.0))
    effective = effective_degrees_of_freedom(part, degrees_of_freedom, contribution=rest[None])
    factor = np.asarray(coverage_factor(effective))
    return Expanded(factor * spread, factor)


NORMAL = float(expand(1.0).factor)
"""Coverage factor of what is taken as known, or has hundreds of samples behind it. [1]"""


def expanded_of(view: TestView, name: str, values: Floats) -> Expanded:
    """Return the expanded uncertainty of a quantity of an archive, in the shape of its values.

    The factor follows from what the archive says its parts were found from.

    Parameters
    ----------
    view : TestView
        The archive.
    name : str
        Of the quantity.
    values : ndarray
        Of it.
    """
    spread = view.array_like(f"{name}_standard_uncertainty", values)
    if name not in view.data:
        return expand(spread)
    return expand(spread, degrees_of_freedom=effective_freedom(view.data, name))


def drawn_interval(view: TestView, name: str, place: int) -> tuple[float, float] | None:
    """Return the 95 % interval of a parameter of the line where it was found by Monte Carlo.

    None where linear propagation holds, and of other quantities.
    """
    method = view.array("test_line_uncertainty_method")
    low, high = view.array(f"{name}_low"), view.array(f"{name}_high")
    if method is None or low is None or high is None:
        return None
    if method[place] != LINE_METHODS["monte_carlo"] or not np.isfinite(high[place] - low[place]):
        return None
    return float(low[place]), float(high[place])


def shared_sources(views: Sequence[TestView], names: Sequence[str]) -> list[str]:
    """Return the sources of shared errors that reach any of some quantities, in fixed order."""
    found: set[str] = set()
    for view in views:
        sources = view.texts("uncertainty_source")
        for name in names:
            rows = view.array(f"{name}_uncertainty_contribution")
            if rows is not None:
                reached = (np.nan_to_num(rows) != 0).reshape(len(sources), -1).any(axis=1)
                found |= {one for one, is_in in zip(sources, reached, strict=True) if is_in}
    return in_order(found)


def factor_words(factors: Iterable[float]) -> str:
    """Return the coverage factors of several numbers as text.

    Examples
    --------
    >>> factor_words([2.2622, 1.9745, np.nan]), factor_words([1.96])
    ('k = 1.97 to 2.26', 'k = 1.96')
    """
    known = [f"{one:.2f}" for one in sorted(factors) if np.isfinite(one)]
    ends = list(dict.fromkeys([known[0], known[-1]])) if known else []
    return f"k = {' to '.join(ends)}" if ends else ""


def plus_minus(
    factors: Iterable[float],
    found_from: str = _CYCLES,
    *,
    left_out: str = _INSTRUMENTS,
    mark: str = "±",
) -> str:
    """Return the sentence: what an uncertainty holds, and what it leaves out.

    Parameters
    ----------
    factors : iterable of float
        Coverage factors of the numbers that it is said of.
    found_from : str
        What it holds.
    left_out : str
        What it does not hold; nothing is said where it is empty.
    mark : str
        What shows it.

    Examples
    --------
    >>> plus_minus([2.26], "tape readings", left_out="position scale")
    '±: expanded uncertainty, 95 % (k = 2.26): tape readings. Not in it: position scale.'
    """
    factor = factor_words(factors)
    head = f"{mark}: expanded uncertainty, 95 %{f' ({factor})' if factor else ''}"
    tail = f" Not in it: {left_out}." if left_out else ""
    return f"{head}: {found_from}.{tail}"


def plus_minus_of_tests(
    factors: Iterable[float],
    views: Sequence[TestView],
    names: Sequence[str],
    *,
    found_from: str = _CYCLES,
    mark: str = "±",
) -> str:
    """Return the sentence for quantities of tests: with what is shared.

    Where nothing is stated of the instruments, it says that.
    """
    shared = shared_sources(views, names)
    held = found_from
    if shared:
        held += f"; and what all samples share: {', '.join(source_words(one) for one in shared)}"
    said = plus_minus(factors, held, left_out="", mark=mark)
    if set(shared) - FROM_READINGS:
        return said
    if not any(is_stated(view) for view in views):
        nothing = NOTHING_STATED if shared else NOTHING_STATED.replace(" and tape readings", "")
        return f"{said} {nothing}"
    if any(f"{name}_uncertainty_contribution" in view.data for view in views for name in names):
        return f"{said} Nothing that is stated of the instruments reaches it."
    return f"{said} Not in it: {_INSTRUMENTS}."

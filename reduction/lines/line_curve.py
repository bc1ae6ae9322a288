r"""Curves of a line over one variable, with intervals.

**Intervals for lines of a kind, from those of the tested lines and the scatter between lines.** A
surface holds for the tested lines.  Their mean differs from that of all lines of the kind by the
scatter between lines over the root of their number; another line differs from that mean by the
whole scatter.  The scatter is a share of a positive value, so it is taken on the logarithm:

.. math:: u^2 = t_\nu^2 \ln(1 + c^2)\left(a + \frac{1}{n}\right) +
          \left(\frac{y_{high} - y}{y}\right)^2, \qquad y e^{\pm u}

**Parts of the intervals of design values: the value's own part, and the shared part**:

.. math:: w = t_{\nu_{eff}} \sqrt{r^2 + \textstyle\sum_k c_k^2}, \qquad w_r = t_\nu\, r

with the half width w of an interval and w_r of the value's own part, its standard uncertainty r,
and the contribution c_k of each shared error.  Wherever two values are added, subtracted or
multiplied, the contributions of one error are combined first and then squared.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, Tables 6-9; sec. 4.4.1.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6.
.. [3] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3 (correlation by common influence quantities), G.4.1 (effective degrees
   of freedom, Welch and Satterthwaite).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.lines.lookup_product import DesignValues, LineCurve
from reduction.record.contributions import (
    Contributions,
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
    merged,
)
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.stages.moduli.local_regression import curve_at
from reduction.stages.three_parameter_line.slow_pull import slope_of_cubic

_EDGE = 1e-9


@dataclass(frozen=True)
@read_only_arrays
class _CurvePoints:
    """A curve at points; arrays have the shape (...) of the points."""

    value: Floats
    random: Floats
    freedom: Floats
    contribution: Floats
    standard_uncertainty: Floats
    half_width: Floats
    is_inside: Bools


def evaluate_curve(curve: LineCurve, at: ArrayLike) -> _CurvePoints:
    """Value of a curve, its uncertainty, and whether the point was tested.

    Parameters
    ----------
    curve : LineCurve
        Polynomial or points.
    at : array_like, shape (...)
        Values of its variable. [SI unit of the variable]

    Returns
    -------
    points : _CurvePoints
        [SI unit of the quantity]

    Raises
    ------
    DataError
        If a cubic whose slope is needed does not have four coefficients.

    Notes
    -----
    Source: [1]_, Tables 6-9 for polynomials, [2]_ for moduli over strain.  Between points, every
    part of the uncertainty is interpolated linearly, as is the value: neighbours are from the same
    cycles.

    Examples
    --------
    >>> curve = LineCurve("strain", "tension", 0.0, 10.0, coefficient=np.array([0.0, 0.1, 0.02]))
    >>> found = evaluate_curve(curve, [5.0, 20.0])
    >>> print(found.value, found.is_inside)
    [ 1. 10.] [ True False]
    """
    points = np.asarray(at, dtype=np.float64)
    width = _EDGE * max(abs(curve.low), abs(curve.high))
    inside = (points >= curve.low - width) & (points <= curve.high + width)
    for low, high in curve.gaps:
        inside &= (points <= low + width) | (points >= high - width)

    def between(values: Floats) -> Floats:
        return curve_at(points.ravel(), curve.at, values, spacing=None).reshape(points.shape)

    if curve.is_inverse_slope:
        value = slope_of_cubic(points, curve.coefficient)
    elif curve.coefficient.size:
        value = np.asarray(np.polynomial.polynomial.polyval(points, curve.coefficient))
    else:
        value = between(curve.value)
    nothing: Floats = np.full(points.shape, np.nan)
    rows = np.zeros((len(curve.component), *points.shape))
    random, freedom = nothing, nothing
    if curve.standard_uncertainty.size:
        shared = np.sum(curve.contribution**2, axis=0) if curve.component else 0.0
        random = between(np.sqrt(np.maximum(curve.standard_uncertainty**2 - shared, 0.0)))
        few = 1 / curve.degrees_of_freedom if curve.degrees_of_freedom.size else 0 * curve.at
        with np.errstate(divide="ignore"):
            freedom = 1 / between(few)
        for place, own in enumerate(curve.contribution):
            rows[place] = between(own)
    spread = combined_standard_uncertainty(rows, random)
    effective = effective_degrees_of_freedom(
        random,
        freedom,
        contribution=rows,
        of_contribution=np.array([one.degrees_of_freedom for one in curve.component]),
    )
    return _CurvePoints(
        value=value,
        random=random,
        freedom=freedom,
        contribution=rows,
        standard_uncertainty=spread,
        half_width=coverage_factor(effective) * spread,
        is_inside=inside,
    )


_BOTH_SIDES = 0.975


def interval_between_lines(
    value: Floats,
    low: Floats,
    high: Floats,
    *,
    line_scatter: float,
    n_lines: float,
    degrees_of_freedom: float,
    is_another: bool,
) -> tuple[Floats, Floats]:
    """95 % interval of the mean of all lines of a kind, or of another line of it.

    Notes
    -----
    [1]_, sec. 4.4.1 gives the scatter as typical, a tenth for new lines and half for exposed ones,
    without degrees of freedom: those of the surface are used for it as well.  The interval is never
    narrower than the given one.

    Examples
    --------
    Four lines that differ by a tenth, a surface without scatter, and many degrees of freedom:
    1.96 times 0.0998 times the root of 5/4 is 0.219.

    >>> one = np.array(1.0)
    >>> found = interval_between_lines(
    ...     one, one, one, line_scatter=0.1, n_lines=4, degrees_of_freedom=1e9, is_another=True
    ... )
    >>> print(np.log(found).round(3))
    [-0.219  0.219]
    """
    if not (np.isfinite(line_scatter) and n_lines > 0):
        nothing = np.full(np.shape(value), np.nan)
        return nothing, nothing
    share = float(is_another) + 1 / n_lines
    own = scipy.special.stdtrit(degrees_of_freedom, _BOTH_SIDES) * np.sqrt(
        np.log1p(line_scatter**2) * share
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        known = np.where(value > 0, value, np.nan)
        down, up = (np.sqrt(own**2 + ((end - value) / known) ** 2) for end in (low, high))
        # far out, where the logarithm raises the lower end, the given limits still hold
        below, above = np.minimum(known * np.exp(-down), low), np.maximum(known * np.exp(up), high)
    return np.asarray(below), np.asarray(above)


End = Literal[
    "low", "high", "surface_low", "surface_high", "kind_low", "kind_high", "line_low", "line_high"
]  # fmt: skip

_NORMAL = 1.96

_EVEN = 1e-6


def shared_half_width(contribution: ArrayLike) -> Floats:
    """Half width of the 95 % interval of shared errors together, with known uncertainties.

    Zero where nothing is shared.

    Notes
    -----
    Normal, as assumed for the errors of instruments ([3]_).

    Examples
    --------
    >>> print(shared_half_width([[3.0], [-4.0]]))
    [9.8]
    """
    rows = np.asarray(contribution, dtype=np.float64)
    return np.asarray(_NORMAL * np.sqrt(np.sum(rows**2, axis=0)))


def own_half_width(found: DesignValues, end: End) -> Floats:
    """Half width of an interval without the errors that the value shares with others.

    NaN where there is no interval.

    Notes
    -----
    See the module docstring.  In an asymmetric interval the same share of each side is the value's
    own part, which includes the scatter between lines ([3]_).  Where the parts are not known, the
    interval is taken as normal and the shared part is removed.

    Examples
    --------
    >>> from reduction.lines.line_lookup import look_up
    >>> from reduction.lines.lookup_product import LineCurve, LineSource
    >>> at = np.array([0.0, 1.0])
    >>> curve = LineCurve("tension", "strain", 0, 1, at=at, value=100 * at,
    ...     standard_uncertainty=5 * at)
    >>> line = LineSource("a", "", "rubber", "", "", 0.025, 3e3, curves=(curve,))
    >>> print(own_half_width(look_up(line, "tension", strain=1.0), "surface_high").round(3))
    9.8
    """
    half: Floats = np.abs(getattr(found, end) - found.value)
    if not found.component:
        return half
    of_surface = end.startswith(("surface", "kind"))
    random = found.random_standard_uncertainty if of_surface else found.run_standard_uncertainty
    if not random.size:
        shared = shared_half_width(found.contribution)
        return np.asarray(np.sqrt(np.maximum(half**2 - shared**2, 0.0)))
    base = f"{'surface_' if of_surface else ''}{end.rpartition('_')[2]}"
    within = np.abs(getattr(found, base) - found.value)
    freedom = found.random_degrees_of_freedom
    alone = half_width_of_parts(random[None], freedom[None])
    both = half_width_of_parts(
        random[None], freedom[None], found.contribution,
        [one.degrees_of_freedom for one in found.component],
    )  # fmt: skip
    # far outside the tested range an interval has no end, and its parts are not known
    own = within * np.divide(alone, both, out=np.ones_like(both), where=both > 0)
    between = np.subtract(half**2, within**2, out=np.array(half), where=np.isfinite(half))
    return np.asarray(np.sqrt(np.maximum(between, 0.0) + own**2))


def is_even(found: DesignValues) -> bool:
    """Whether the parts are known and the interval is symmetric everywhere.

    False for a surface on another scale, and where only an interval is known.

    Notes
    -----
    Differences and products of such values have the degrees of freedom of all their parts ([3]_).

    Examples
    --------
    See `reduction.lines.line_search.compare_values`.
    """
    up, down = found.surface_high - found.value, found.value - found.surface_low
    if not found.random_standard_uncertainty.size:
        return False
    return bool(np.allclose(up, down, rtol=_EVEN, atol=0.0, equal_nan=True))


def half_width_of_parts(
    random: ArrayLike,
    degrees_of_freedom: ArrayLike,
    contribution: ArrayLike | None = None,
    of_contribution: ArrayLike = (),
) -> Floats:
    """Half width of the 95 % interval of independent parts together with shared errors.

    Parameters
    ----------
    random, degrees_of_freedom : array_like, shape (n_parts, ...)
        Random part of each value, and its degrees of freedom. [any], [1]
    contribution : array_like, shape (n_components, ...), optional
        Contributions of shared errors, already combined. [as random]
    of_contribution : array_like, shape (n_components,)
        Degrees of freedom of each. [1]

    Returns
    -------
    half : ndarray, shape (...)
        [as random]

    Notes
    -----
    Welch-Satterthwaite formula ([3]_).

    Examples
    --------
    Two surfaces with five degrees of freedom each have ten together: 2.228 times the root of 2.

    >>> print(half_width_of_parts([1.0, 1.0], [5.0, 5.0]).round(3))
    3.151
    """
    own = np.asarray(random, dtype=np.float64)
    few = np.broadcast_to(np.asarray(degrees_of_freedom, dtype=np.float64), own.shape)
    rows = np.zeros((0, *own.shape[1:])) if contribution is None else np.asarray(contribution)
    of = np.asarray(of_contribution, dtype=np.float64).reshape(-1, *(1,) * (own.ndim - 1))
    parts = np.concatenate([own, rows])
    freedom = effective_degrees_of_freedom(
        np.zeros(own.shape[1:]), np.inf, contribution=parts,
        of_contribution=np.concatenate([few, np.broadcast_to(of, rows.shape)]),
    )  # fmt: skip
    return np.asarray(coverage_factor(freedom) * combined_standard_uncertainty(parts, 0.0))


def shared_of(values: Mapping[str, DesignValues]) -> Contributions:
    """Contributions of shared errors to several values at the same points, one row per error.

    By that name; zero for an error that a value does not have.

    Notes
    -----
    Errors of one source and one ``of`` are one error ([3]_).

    Examples
    --------
    See `reduction.lines.line_lookup.look_up` of a dashpot coefficient.
    """
    return merged(
        [
            Contributions(
                one.component,
                {name: np.array(one.contribution)}
                if one.component
                else {name: np.empty((0, *one.value.shape))},
            )
            for name, one in values.items()
        ]
    )

r"""Intervals of design values taken apart: what is of a value alone, and what it shares.

.. math:: w = t_{\nu_{eff}} \sqrt{r^2 + \textstyle\sum_k c_k^2}, \qquad w_r = t_\nu\, r

with the half width w of an interval and w_r of the value alone, its standard uncertainty r, and the
contribution c_k of each shared error.  Wherever two values are added, subtracted or multiplied, the
contributions of one error are put together first and squared then.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3 (correlation by common influence quantities), G.4.1 (effective degrees
   of freedom, Welch and Satterthwaite).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.lookup.product import DesignValues
from reduction.record import Floats
from reduction.uncertainty.combine import (
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.uncertainty.join import merged
from reduction.uncertainty.product import Contributions

End = Literal[
    "low", "high", "surface_low", "surface_high", "kind_low", "kind_high", "line_low", "line_high"
]  # fmt: skip
_NORMAL = 1.96
_EVEN = 1e-6


def shared_half_width(contribution: ArrayLike) -> Floats:
    """Half width of the 95 % interval of shared errors together, known as they are.

    Parameters
    ----------
    contribution : array_like, shape (n_components, ...)
        Signed, one row an error. [any]

    Returns
    -------
    half : ndarray, shape (...)
        Zero where nothing is shared. [as contribution]

    Raises
    ------
    ValueError
        If the rows differ in length.

    Notes
    -----
    Normal, as the errors of instruments are taken ([1]_).

    Examples
    --------
    >>> print(shared_half_width([[3.0], [-4.0]]))
    [9.8]
    """
    rows = np.asarray(contribution, dtype=np.float64)
    return np.asarray(_NORMAL * np.sqrt(np.sum(rows**2, axis=0)))


def own_half_width(found: DesignValues, end: End) -> Floats:
    """Half width of an interval without the errors that the value shares with others.

    Parameters
    ----------
    found : DesignValues
        As looked up.
    end : {"low", "high", "surface_low", "surface_high", "kind_low", ...}
        To which end.

    Returns
    -------
    half : ndarray, shape (...)
        NaN where there is no interval. [unit of the value]

    Raises
    ------
    AttributeError
        If there is no such end.

    Notes
    -----
    See the module.  Of an interval that reaches farther to one side the same share of each is the
    value's own; the scatter between lines is ([1]_).  Where the parts are not known an interval
    counts as normal, less what is shared.

    Examples
    --------
    >>> from reduction.lookup.line import look_up
    >>> from reduction.lookup.product import LineCurve, LineSource
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
    own = within * np.divide(alone, both, out=np.zeros_like(both), where=both > 0)
    return np.asarray(np.sqrt(np.maximum(half**2 - within**2, 0.0) + own**2))


def is_even(found: DesignValues) -> bool:
    """Whether the parts are known and the interval reaches as far to either side everywhere.

    Parameters
    ----------
    found : DesignValues
        As looked up.

    Returns
    -------
    is_even : bool
        False of a surface on another scale, and where an interval is all that is known.

    Raises
    ------
    ValueError
        Never by itself.

    Notes
    -----
    Differences and products of such values have the degrees of freedom of all their parts ([1]_).

    Examples
    --------
    See `reduction.lookup.against.compare_values`.
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
        What is of each value alone, and from how much. [any], [1]
    contribution : array_like, shape (n_components, ...), optional
        Of shared errors, put together already. [as random]
    of_contribution : array_like, shape (n_components,)
        Degrees of freedom of each. [1]

    Returns
    -------
    half : ndarray, shape (...)
        [as random]

    Raises
    ------
    ValueError
        If the shapes do not fit.

    Notes
    -----
    Welch and Satterthwaite ([1]_).

    Examples
    --------
    Two surfaces of five degrees of freedom each are ten together: 2.228 times the root of 2.

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
    """What shared errors add to several values at the same points, one row an error for all.

    Parameters
    ----------
    values : mapping of str to DesignValues
        By a name. [unit of each]

    Returns
    -------
    contributions : Contributions
        By that name; zero of an error that a value does not know. [unit of each]

    Raises
    ------
    SettingsError
        If an error stands twice among those of one value.

    Notes
    -----
    Errors of one source and one ``of`` are one error ([1]_).

    Examples
    --------
    See `reduction.lookup.line.look_up` of a dashpot coefficient.
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

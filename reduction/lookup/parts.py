r"""Intervals of design values taken apart: what is of a value alone, and what it shares.

.. math:: w^2 = w_r^2 + 1.96^2 \sum_k c_k^2

with the half width w of an interval, that of the value alone w_r, and the contribution c_k of each
shared error.  Wherever two values are added, subtracted or multiplied, the contributions of one
error are put together first and squared then.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2, F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.lookup.product import DesignValues
from reduction.record import Floats
from reduction.uncertainty.join import merged
from reduction.uncertainty.product import Contributions

__all__ = ["End", "own_half_width", "shared_half_width", "shared_of"]

End = Literal[
    "low", "high", "surface_low", "surface_high", "kind_low", "kind_high", "line_low", "line_high"
]  # fmt: skip
_NORMAL = 1.96


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
    See the module; where a scale bends, what is shared may be all of the shorter side ([1]_).

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
    half = getattr(found, end) - found.value
    shared = shared_half_width(found.contribution) if found.component else 0.0
    return np.asarray(np.sqrt(np.maximum(half**2 - np.square(shared), 0.0)))


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

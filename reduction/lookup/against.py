r"""Two lines at the same points: difference, ratio, and whether it is more than their intervals.

The limits of a difference follow from those of the two values, each side on its own:

.. math:: L = d - \sqrt{(b - l_b)^2 + (u_a - a)^2}, \qquad
          U = d + \sqrt{(u_b - b)^2 + (a - l_a)^2}, \qquad d = b - a

References
----------
.. [1] G. Y. Zou and A. Donner, "Construction of Confidence Limits about Effect Measures: A
   General Approach," Statistics in Medicine, vol. 27, no. 10, pp. 1693-1702, 2008.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.1, Tables 4, 5.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.lookup.product import DesignValues
from reduction.record import Bools, Floats, freeze_arrays

__all__ = ["LineDifference", "compare_values"]


@dataclass(frozen=True)
class LineDifference:
    """Values of one quantity of two lines.  Arrays have the shape (...) of the points.

    Parameters
    ----------
    quantity, unit : str
        Of both, SI.
    first, second : DesignValues
        As they were looked up.
    difference : ndarray
        The second less the first. [unit]
    ratio : ndarray
        The second over the first; NaN where that is zero. [1]
    surface_low, surface_high : ndarray
        95 % interval of the difference of the two surfaces; NaN where one has none. [unit]
    low, high : ndarray
        The same of one more test of each. [unit]
    is_known, is_test_known : ndarray of bool
        Both lines have that interval.
    is_different, is_test_different : ndarray of bool
        Zero is not in the interval of the surfaces, or of one more test of each.
    """

    quantity: str
    unit: str
    first: DesignValues
    second: DesignValues
    difference: Floats
    ratio: Floats
    surface_low: Floats
    surface_high: Floats
    low: Floats
    high: Floats
    is_known: Bools
    is_test_known: Bools
    is_different: Bools
    is_test_different: Bools

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    @property
    def is_inside(self) -> Bools:
        """Inside what was tested of both."""
        return np.asarray(self.first.is_inside & self.second.is_inside)


def compare_values(first: DesignValues, second: DesignValues) -> LineDifference:
    """Difference and ratio of two lines at the points of two look-ups.

    Parameters
    ----------
    first, second : DesignValues
        Of one quantity, at the same number of points: at the same tensions, or at the same
        shares of two break strengths.

    Returns
    -------
    difference : LineDifference
        The second against the first.

    Raises
    ------
    SettingsError
        If the quantities or the shapes differ.

    Notes
    -----
    Limits by [1]_, which needs no more than the two intervals and holds where they are not
    symmetric: a surface brought back from a logarithm, or an open coefficient.  For two normal
    values of the same degrees of freedom it is Student's t of those times the root of the summed
    variances, which is never below 95 %.  It speaks of the scatter about each surface; how lines
    of one kind differ among each other ([2]_: about 10 % of new ones, 50 % after years in the
    sea) is in no surface.

    Examples
    --------
    Table 5 of [2]_: plaited polyester line is 30 % stiffer after four years.

    >>> from reduction.lookup.line import look_up
    >>> from reduction.lookup.product import LineCurve, LineSource
    >>> def line(value):
    ...     curve = LineCurve("tangent_modulus", "strain", 0, 1, at=[0, 1], value=2 * [value])
    ...     return LineSource("a", "", "polyester", "", "", 0.0127, 29e3, curves=(curve,))
    >>> values = [look_up(line(one), "tangent_modulus", strain=0.5) for one in (6.317, 8.252)]
    >>> print(compare_values(*values).ratio.round(3))
    1.306
    """
    if first.quantity != second.quantity:
        raise SettingsError(
            "two quantities cannot be compared", found=f"{first.quantity}, {second.quantity}"
        )
    if first.value.shape != second.value.shape:
        raise SettingsError(
            "two lines were not looked up at the same points",
            found=f"{first.value.shape}, {second.value.shape}", needed="one shape",
        )  # fmt: skip
    difference = second.value - first.value
    surface_low, surface_high = _limits(first, second, "surface_low", "surface_high")
    low, high = _limits(first, second, "low", "high")
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(first.value != 0, second.value / first.value, np.nan)
    return LineDifference(
        quantity=first.quantity,
        unit=first.unit,
        first=first,
        second=second,
        difference=np.asarray(difference),
        ratio=np.asarray(ratio),
        surface_low=surface_low,
        surface_high=surface_high,
        low=low,
        high=high,
        is_known=np.isfinite(surface_low) & np.isfinite(surface_high),
        is_test_known=np.isfinite(low) & np.isfinite(high),
        # NaN is neither above nor below
        is_different=np.asarray((surface_low > 0) | (surface_high < 0)),
        is_test_different=np.asarray((low > 0) | (high < 0)),
    )


def _limits(
    first: DesignValues, second: DesignValues, low: str, high: str
) -> tuple[Floats, Floats]:
    difference = second.value - first.value
    down = np.hypot(second.value - getattr(second, low), getattr(first, high) - first.value)
    up = np.hypot(getattr(second, high) - second.value, first.value - getattr(first, low))
    return np.asarray(difference - down), np.asarray(difference + up)

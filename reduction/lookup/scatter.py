r"""Intervals for the lines of a kind, from those of the lines that were tested and their scatter.

A surface is of the lines that were tested.  Their mean differs from that of all lines of the kind
by the scatter between lines over the root of their number, and another line from that mean by the
whole of it.  A scatter is a share of a positive value, so that it is taken on the logarithm:

.. math:: u^2 = t_\nu^2 \ln(1 + c^2)\left(a + \frac{1}{n}\right) +
          \left(\frac{y_{high} - y}{y}\right)^2, \qquad y e^{\pm u}

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.1.
"""

from __future__ import annotations

import numpy as np
from scipy.special import stdtrit

from reduction.errors import DataError
from reduction.record import Floats

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
    """95 % interval of the mean of all lines of a kind, or of one more of them.

    Parameters
    ----------
    value, low, high : ndarray, shape (...)
        Of the lines that were tested: the interval of their surface for the mean of the kind, that
        of one more run for another line. [unit of the quantity]
    line_scatter : float
        Standard deviation between lines over their mean. [1]
    n_lines : float
        That were tested. [1]
    degrees_of_freedom : float
        Of Student's t, of both parts. [1]
    is_another : bool
        Another line, in place of the mean of all.

    Returns
    -------
    low, high : ndarray, shape (...)
        NaN where the scatter is not known, or the value is not above zero. [unit of the quantity]

    Raises
    ------
    DataError
        If the scatter is negative.

    Notes
    -----
    [1]_ gives the scatter as typical, a tenth for new lines and half for exposed ones, without a
    number of degrees of freedom: those of the surface are taken for it as well.  The interval is
    never narrower than the one it is made from.

    Examples
    --------
    Four lines that differ by a tenth, a surface without scatter, and very many degrees of freedom:
    1.96 times 0.0998 times the root of 5/4 is 0.219.

    >>> one = np.array(1.0)
    >>> found = interval_between_lines(
    ...     one, one, one, line_scatter=0.1, n_lines=4, degrees_of_freedom=1e9, is_another=True
    ... )
    >>> print(np.log(found).round(3))
    [-0.219  0.219]
    """
    if line_scatter < 0:
        raise DataError("a scatter is negative", found=f"{line_scatter:g}", needed="zero or above")
    if not (np.isfinite(line_scatter) and n_lines > 0):
        nothing = np.full(np.shape(value), np.nan)
        return nothing, nothing
    share = float(is_another) + 1 / n_lines
    own = stdtrit(degrees_of_freedom, _BOTH_SIDES) * np.sqrt(np.log1p(line_scatter**2) * share)
    with np.errstate(divide="ignore", invalid="ignore"):
        known = np.where(value > 0, value, np.nan)
        down, up = (np.sqrt(own**2 + ((end - value) / known) ** 2) for end in (low, high))
        # far out, where a logarithm draws the lower end in, the limits given still hold
        below, above = np.minimum(known * np.exp(-down), low), np.maximum(known * np.exp(up), high)
    return np.asarray(below), np.asarray(above)

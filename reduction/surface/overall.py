r"""F statistic of a whole surface from its r2: the right one, and the one the report prints.

As printed, [1]_ computes :math:`F = (r^2 / 10) / ((1 - r^2) / 4)` for fifteen runs and ten
terms, which counts the mean twice, and holds it against 3.48, which is the 5 % point for 4 and
10 degrees of freedom, transposed.  As computed, r2 is about the mean: 9 and 5.  The two errors
nearly cancel (3.48 against 3.44 on the printed scale).

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3, Tables 3-5 and 11-19.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import fdtrc, fdtri

from reduction.errors import SettingsError
from reduction.record import Floats


class OverallF(NamedTuple):
    """Statistics of one r2: the right test, and the one the report printed.

    ``critical`` and ``printed_critical`` are on the scale of their own statistic.
    """

    f: Floats
    p_value: Floats
    critical: Floats
    printed_f: Floats
    printed_critical: Floats


def statistics_from_r2(
    r2: ArrayLike, *, n_runs: ArrayLike, n_terms: int, level: float = 0.05
) -> OverallF:
    r"""Overall F of a surface from its r2, and the statistic CG-D-39-80 prints.

    .. math::

        F = \frac{r^2 / (p - 1)}{(1 - r^2) / (n - p)}, \qquad
        F_{printed} = \frac{r^2 / p}{(1 - r^2) / (n - p - 1)}

    Parameters
    ----------
    r2 : array_like, shape (...)
        About the mean. [1]
    n_runs : array_like, shape (...)
        Runs fitted. [1]
    n_terms : int
        With the mean, two or more.
    level : float
        Of the test. [1]

    Returns
    -------
    statistics : OverallF
        f, p_value, critical; printed_f and printed_critical, which is the critical value as
        the report looked it up, with its degrees of freedom transposed.

    Raises
    ------
    SettingsError
        If there are fewer than two terms, or the level is not between 0 and 1.

    Notes
    -----
    Source: [1]_, Tables 3-5 and 11-19: 54 of 58 printed statistics follow from the printed r2
    and 10 and 4 degrees of freedom within its rounding, 3 from 9 and 5.  The text "if F-Stat >
    F-Crit the data fits equation 5 with 95 % confidence" is not what the test says: that not
    all slopes are nil.  NaN where no degree of freedom is left.

    Examples
    --------
    Polyester, new, K_ap: 26.98 is printed beside r2 = 0.985, which may be 0.9845 to 0.9855.

    >>> print(statistics_from_r2([0.9845, 0.9855], n_runs=15, n_terms=10).printed_f.round(2))
    [25.41 27.19]

    >>> found = statistics_from_r2(0.985, n_runs=15, n_terms=10)
    >>> print(found.printed_f.round(2), found.printed_critical.round(2))
    26.27 3.48
    >>> print(found.f.round(2), found.critical.round(2), found.p_value.round(4))
    36.48 4.77 0.0005
    """
    if n_terms < 2:
        raise SettingsError("a surface of the mean alone has no F", needed="two or more terms")
    if not 0 < level < 1:
        raise SettingsError(
            "the level of a test is a probability", found=f"{level:g}", needed="between 0 and 1"
        )
    share = np.asarray(r2, dtype=np.float64)
    runs = np.asarray(n_runs, dtype=np.float64)
    above, below = n_terms - 1.0, _positive_or_nan(runs - n_terms)
    printed_below = _positive_or_nan(runs - n_terms - 1)
    # critical values are dear, and numbers of runs few
    different, which = np.unique(runs, return_inverse=True)
    right = fdtri(above, _positive_or_nan(different - n_terms), 1 - level)
    transposed = fdtri(_positive_or_nan(different - n_terms - 1), n_terms, 1 - level)
    none_left = np.where(share >= 1, np.inf, np.nan)
    odds = np.divide(share, 1 - share, out=none_left, where=share < 1)
    f = odds * below / above
    return OverallF(
        f,
        np.asarray(fdtrc(above, below, f), dtype=np.float64),
        np.asarray(right[which.reshape(runs.shape)]),
        odds * printed_below / n_terms,
        np.asarray(transposed[which.reshape(runs.shape)]),
    )


def _positive_or_nan(values: Floats) -> Floats:
    return np.where(values > 0, values, np.nan)

r"""Leverage, Cook's distance, studentized residuals, and how straight their probability plot is.

References
----------
.. [1] R. D. Cook and S. Weisberg, Residuals and Influence in Regression. New York: Chapman and
   Hall, 1982.
.. [2] S. S. Shapiro and R. S. Francia, "An Approximate Analysis of Variance Test for
   Normality," J. Am. Stat. Assoc., vol. 67, pp. 215-216, 1972.
"""

from __future__ import annotations

import numpy as np
from scipy.special import ndtri

from reduction.record import Bools, Floats
from reduction.surface.leastsquares import LeastSquares
from reduction.surface.parts import Diagnostics

_FIXES_A_TERM = 1 - 1e-9
"""Leverage from which a run is fitted by itself alone and has no residual to look at."""


def diagnose(fit: LeastSquares) -> Diagnostics:
    r"""Look at the residuals of every run of every surface.

    .. math::

        r_i = \frac{e_i}{s \sqrt{1 - h_i}}, \qquad
        t_i = r_i \sqrt{\frac{n - p - 1}{n - p - r_i^2}}, \qquad
        D_i = \frac{r_i^2}{p} \frac{h_i}{1 - h_i}

    Parameters
    ----------
    fit : LeastSquares
        The surfaces.

    Returns
    -------
    diagnostics : Diagnostics
        NaN where a run is missing or fixes a term alone, and where the scatter is rounding.

    Raises
    ------
    AttributeError
        If it is not a fit.

    Notes
    -----
    Source: [1]_; the correlation of [2]_ is with the scores of Blom.  Fifteen residuals of a
    surface of ten terms have five degrees of freedom among them and look more normal than the
    scatter is: a low correlation says something, a high one little.

    Examples
    --------
    Three values about their mean: the leverage of each is a third.

    >>> from reduction.surface.fit import fit_least_squares
    >>> found = diagnose(fit_least_squares(np.ones((3, 1)), [[1.0, 2.0, 3.0]]))
    >>> print(found.leverage.round(3), found.cooks_distance.round(3))
    [[0.333 0.333 0.333]] [[0.75 0.   0.75]]
    """
    leverage = fit.leverage[fit.pattern]
    n_columns = np.isfinite(fit.coefficient).sum(axis=1, keepdims=True)
    df = fit.degrees_of_freedom[:, None]
    own = np.where(leverage < _FIXES_A_TERM, 1 - leverage, np.nan)
    sigma = np.where(fit.reason == 0, fit.sigma, np.nan)[:, None]
    inner = fit.residual / (sigma * np.sqrt(own))
    distance = inner**2 * leverage / own / np.maximum(n_columns, 1)
    # with every other residual nil the scatter without the run is nil, and t has no bound
    without = df - inner**2
    safe = (without > 1e-9 * df) & (df > 1)
    outer = inner * np.sqrt(
        np.divide(df - 1, without, where=safe, out=np.full(inner.shape, np.inf))
    )
    outer = np.where(df > 1, outer, np.nan)
    return Diagnostics(
        leverage, distance, inner, outer, _straightness(inner, fit.is_used[fit.pattern])
    )


def _straightness(studentized: Floats, used: Bools) -> Floats:
    """Squared correlation of ordered residuals with normal scores, shape (n_responses,)."""
    known = np.isfinite(studentized)
    count = known.sum(axis=1, keepdims=True)
    ordered = np.sort(np.where(known, studentized, np.nan), axis=1)
    place = np.arange(1, used.shape[1] + 1)
    inside = place <= count
    score = np.where(inside, ndtri(np.where(inside, (place - 0.375) / (count + 0.25), 0.5)), 0.0)
    inside &= count > 2
    middle = np.sum(np.where(inside, ordered, 0.0), axis=1, keepdims=True) / np.maximum(count, 1)
    centred = np.where(inside, ordered - middle, 0.0)
    product = np.sum(centred * score, axis=1) ** 2
    size = np.sum(centred**2, axis=1) * np.sum(score**2, axis=1)
    return np.asarray(np.divide(product, size, where=size > 0, out=np.full(size.shape, np.nan)))

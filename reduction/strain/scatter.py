r"""Whether tape readings scatter more than the tape explains, and the variance of a row of them.

References
----------
.. [1] R. T. Birge, "The calculation of errors by the method of least squares," Phys. Rev.,
   vol. 40, pp. 207-227, 1932 (the ratio of external to internal consistency).
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.3 (stated errors), 4.2 and G.3 (scatter, Student's t).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import chdtrc, ndtri, stdtrit

from reduction.errors import DataError
from reduction.record import Floats

LEVEL = 0.005
"""Chance at which sound marks are taken to scatter too much. [1]"""
_CONFIDENCE = 0.975  # of one side of a 95 % interval


@dataclass(frozen=True)
class RowScatter:
    """What one row of a fit is good for.

    Parameters
    ----------
    variance : float
        Of one row. [SI]
    widening : float
        Root of ``variance`` over the stated one: the Birge ratio where the residuals are too
        large, else 1. [1]
    note : str
        What a reader has to know; empty where the tape explains the scatter.
    """

    variance: float
    widening: float = 1.0
    note: str = ""


def row_scatter(
    stated: float, residual: ArrayLike, design: ArrayLike, shared: ArrayLike | None = None
) -> RowScatter:
    r"""Variance of one row: the stated one, unless the residuals refute it.

    .. math:: \chi^2 = z^T V^{-1} z, \quad z = Q^T r, \quad V = \sigma^2 I + Q^T G^T G Q

    Parameters
    ----------
    stated : float
        Variance of one row by the tape, :math:`\sigma^2`; 0 where nothing is stated. [SI]
    residual : array_like, shape (n_marks,)
        Of a least squares fit, :math:`r`. [SI]
    design : array_like, shape (n_values, n_marks)
        Change of a row with each coefficient of the fit. [SI]
    shared : array_like, shape (n_errors, n_marks), optional
        Change of the residual by one standard uncertainty of what all rows share, :math:`G`: the
        relaxed length, which the fit holds. [SI]

    Returns
    -------
    scatter : RowScatter
        [SI]

    Raises
    ------
    DataError
        If the residuals and the design do not pair up.

    Notes
    -----
    The columns of Q span what the coefficients cannot follow.  What the tape is known to do is
    known better than what a few residuals say ([2]_): the larger of the two would be too large
    in the mean, with one mark to spare by :math:`E \max(1, \chi^2_1) = 1.48`, which is 1.22 of
    the standard uncertainty.  The residuals are therefore tested, and only where sound marks
    would have them that large in one of 200 fits is the variance multiplied by the square of
    the Birge ratio :math:`\chi^2 / \nu` ([1]_).  With one mark to spare that adds 4.4 % to the
    mean variance of sound marks (:math:`P(\chi^2_3 > 7.88) - 0.005`); testing at 1 % would add
    7.5 %.

    Where nothing is stated the scatter is all there is: its variance by :math:`\nu` degrees of
    freedom, times :math:`(t_\nu / 1.96)^2`, so that 1.96 standard uncertainties hold 95 %.
    Without a row to spare nothing is known, and the coefficients count as exact.

    Examples
    --------
    Three marks about a mean, good to 1; then the same marks good to 0.2:

    >>> marks = np.array([1.0, -1.0, 0.0])
    >>> print(row_scatter(1.0, marks, np.ones((1, 3))).variance)
    1.0
    >>> wide = row_scatter(0.04, marks, np.ones((1, 3)))
    >>> print(round(wide.variance, 3), round(wide.widening, 2))
    1.0 5.0
    """
    left, columns = np.asarray(residual, dtype=np.float64), np.atleast_2d(design)
    if left.ndim != 1 or columns.shape[1:] != left.shape:
        raise DataError(
            "residuals and the design of their fit do not pair up",
            found=f"{left.shape} and {columns.shape}",
            needed="one column of the design for each residual",
        )
    spare = left.size - columns.shape[0]
    if not stated > 0:
        return _unstated(left, spare)
    if spare <= 0:
        return RowScatter(stated)
    free = np.linalg.qr(columns.T, mode="complete")[0][:, columns.shape[0] :]
    common = np.zeros((1, left.size)) if shared is None else np.atleast_2d(shared)
    common = common @ free
    away = free.T @ left
    covariance = stated * np.eye(spare) + common.T @ common
    chi_square = float(away @ np.linalg.solve(covariance, away))
    chance = float(chdtrc(spare, chi_square))
    if chance >= LEVEL:
        return RowScatter(stated)
    ratio = float(np.sqrt(chi_square / spare))
    return RowScatter(
        stated * ratio**2,
        ratio,
        f"scatter {ratio:.1f} times as much as the tape explains (chi-square {chi_square:.3g} of "
        f"{spare} degree{'s' if spare > 1 else ''} of freedom, one in {_odds(chance)}); their "
        "uncertainty is widened by as much",
    )


def _unstated(residual: Floats, spare: int) -> RowScatter:
    if spare <= 0:
        return RowScatter(
            0.0, note="have no stated reading error and none to spare: they count as exact"
        )
    factor = float(stdtrit(spare, _CONFIDENCE) / ndtri(_CONFIDENCE))
    return RowScatter(
        float(residual @ residual) / spare * factor**2,
        note="have no stated reading error: their scatter is taken, with "
        f"{spare} degree{'s' if spare > 1 else ''} of freedom",
    )


def _odds(chance: float) -> str:
    return f"{1 / chance:,.0f}" if chance > 1e-6 else "a million or more"

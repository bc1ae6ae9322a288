"""Coefficients of the strain methods from tape readings, each with its covariance.

A row of marks is three tape readings (near toe, far toe, far thimble) of one
standard uncertainty.  The relaxed lengths come from the slack rows alone, so that
strain is zero at slack by construction; the stretched rows give the rest.  Where
the rows scatter more than the tape explains, the scatter is used instead.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive, as_same_shape
from reduction.errors import DataError
from reduction.record import Floats, freeze_arrays

__all__ = [
    "Calibration",
    "fit_free_length_line",
    "fit_splice_ratio",
    "larger_variance",
    "line_slope",
    "relaxed_lengths",
]


@dataclass(frozen=True)
class Calibration:
    """Coefficients of one method.

    Parameters
    ----------
    values : ndarray, shape (n_values,)
        In the order the fitting function names them. [SI]
    covariance : ndarray, shape (n_values, n_values)
        From the stretched rows alone, the relaxed lengths held. [SI]
    relaxed_sensitivity : ndarray, shape (n_values, 2)
        Change of each value with the relaxed free and splice length. [SI m-1]
    residual : ndarray, shape (n_marks,)
        Of the fitted length or strain. [m] or [1]
    """

    values: Floats
    covariance: Floats
    relaxed_sensitivity: Floats
    residual: Floats

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def larger_variance(stated: float, residual: Floats, n_values: int) -> float:
    """Variance that readings imply, or that of the residuals where it is larger.

    Parameters
    ----------
    stated : float
        From the tape. [SI]
    residual : ndarray, shape (n_marks,)
        Of a fit. [SI]
    n_values : int
        Coefficients the fit used up.

    Returns
    -------
    variance : float
        ``stated`` alone where no mark is left over. [SI]

    Raises
    ------
    DataError
        Never.

    Examples
    --------
    >>> print(larger_variance(1.0, np.array([2.0, -2.0, 0.0]), 1))
    4.0
    """
    spare = residual.size - n_values
    return max(stated, float(residual @ residual) / spare) if spare > 0 else stated


def line_slope(position: ArrayLike, values: ArrayLike) -> float:
    """Least squares slope of a series on position.

    Parameters
    ----------
    position : array_like, shape (n,)
        At two places or more. [m]
    values : array_like, shape (n,)
        Strain, or its residual. [1]

    Returns
    -------
    slope : float
        Per unit of position. [m-1]

    Raises
    ------
    DataError
        If the series do not pair up.

    Examples
    --------
    >>> print(line_slope([1.0, 2.0, 3.0], [0.1, 0.3, 0.5]))
    0.2
    """
    at, series = as_same_shape(position=position, values=values)
    centred = at - at.mean()
    return float(centred @ series) / float(centred @ centred)


def relaxed_lengths(
    free_length: ArrayLike, splice_length: ArrayLike, *, reading_uncertainty: float
) -> tuple[Floats, Floats]:
    """Mean free and splice length of the slack rows.

    Parameters
    ----------
    free_length : array_like, shape (n_slack,)
        Splice toe to splice toe, slack. [m]
    splice_length : array_like, shape (n_slack,)
        Both splices together, slack. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]

    Returns
    -------
    lengths : ndarray, shape (2,)
        Free and splice length. [m]
    covariance : ndarray, shape (2, 2)
        Of their means; the two share both toe readings. [m2]

    Raises
    ------
    DataError
        If there is no slack row, or a length is not positive.

    Notes
    -----
    The mean over tests, and not each test's own row: a reading is good to 0.01 ft
    ([1]_, Table 3), which is 0.12 % of the free length, and that would enter every
    strain and modulus of the test.

    Examples
    --------
    Two slack rows read to 1 mm:

    >>> lengths, covariance = relaxed_lengths([2.55, 2.56], [1.18, 1.18], reading_uncertainty=1e-3)
    >>> print(lengths.round(3), (1e3 * np.sqrt(np.diag(covariance))).round(2))
    [2.555 1.18 ] [5.   1.22]
    """
    rows = np.array(as_same_shape(free_length=free_length, splice_length=splice_length))
    if rows.shape[-1] == 0:
        raise DataError(
            "the marks have no slack row",
            needed="at least one row with hold = slack, read before the specimen is stretched",
        )
    as_positive("relaxed length", rows)
    n_slack = rows.shape[1]
    # free = far toe - near toe; splices = far thimble - far toe + near toe
    covariance = reading_uncertainty**2 / n_slack * np.array([[2.0, -2.0], [-2.0, 3.0]])
    if n_slack > 1:
        scatter = np.cov(rows) / n_slack
        for i in range(2):
            covariance[i, i] = max(covariance[i, i], scatter[i, i])
    return rows.mean(axis=1), covariance


def fit_free_length_line(
    free_length: ArrayLike, position: ArrayLike, *, reading_uncertainty: float
) -> Calibration:
    """Least squares line of free length on position.

    Parameters
    ----------
    free_length : array_like, shape (n_marks,)
        Of the stretched rows. [m]
    position : array_like, shape (n_marks,)
        Far thimble. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]

    Returns
    -------
    calibration : Calibration
        ``free_length_intercept`` [m] and ``free_length_slope`` [1].

    Raises
    ------
    DataError
        If there are fewer than two positions, or a value is not finite.

    Notes
    -----
    A line through three marks leaves 0.1 to 0.2 points of strain in Table 3 of
    [1]_, no more than the tape explains.  Two marks give the line but no residual.

    Examples
    --------
    Table 3 of [1]_, used tether, in feet:

    >>> line = fit_free_length_line(
    ...     [14.79, 16.96, 19.09], [19.37, 21.75, 24.12], reading_uncertainty=0.004)
    >>> print(line.values.round(4))
    [-2.7399 0.9053]
    """
    free, length = as_same_shape(
        free_length=as_finite("free_length", free_length), position=as_finite("position", position)
    )
    if np.unique(length).size < 2:
        raise DataError(
            "a line needs marks at two positions",
            found=f"{np.unique(length).size}",
            needed="at least two stretched rows at different positions",
            hint="Use strain-ratio or constant-fraction, which need one.",
        )
    centre = length.mean()
    spread = float(np.sum((length - centre) ** 2))
    slope = line_slope(length, free)
    intercept = float(free.mean()) - slope * centre
    residual = intercept + slope * length - free
    variance = larger_variance(reading_uncertainty**2 * (2 + slope**2), residual, 2)
    covariance = variance * np.array(
        [
            [1 / free.size + centre**2 / spread, -centre / spread],
            [-centre / spread, 1 / spread],
        ]
    )
    return Calibration(np.array([intercept, slope]), covariance, np.zeros((2, 2)), residual)


def fit_splice_ratio(
    free_length: ArrayLike,
    splice_length: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    reading_uncertainty: float,
) -> Calibration:
    r"""Ratio of splice strain to free strain, least squares through the slack point.

    .. math:: \rho = \sum x y / \sum x^2

    with :math:`x` the free strain and :math:`y` the splice strain.

    Parameters
    ----------
    free_length : array_like, shape (n_marks,)
        Of the stretched rows. [m]
    splice_length : array_like, shape (n_marks,)
        Both splices together, same rows. [m]
    relaxed_free_length : float
        From `relaxed_lengths`. [m]
    relaxed_splice_length : float
        From `relaxed_lengths`. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]

    Returns
    -------
    calibration : Calibration
        ``splice_strain_ratio`` [1]; residual in splice strain [1].

    Raises
    ------
    DataError
        If there is no stretched row, or a length is not positive.

    Notes
    -----
    Errors of the free strain are one fortieth of its value in Table 3 of [1]_, so
    that the ratio is not biased by them to the digits given.

    Examples
    --------
    Table 3 of [1]_, new tether, in feet:

    >>> ratio = fit_splice_ratio(
    ...     [14.80, 16.95, 19.03], [4.57, 4.80, 5.09],
    ...     relaxed_free_length=8.38, relaxed_splice_length=3.88, reading_uncertainty=0.004)
    >>> print(ratio.values.round(4))
    [0.2386]
    """
    as_positive("relaxed lengths", [relaxed_free_length, relaxed_splice_length])
    free, splice = as_same_shape(
        free_length=as_positive("free_length", free_length),
        splice_length=as_positive("splice_length", splice_length),
    )
    free_stretch, splice_stretch = free / relaxed_free_length, splice / relaxed_splice_length
    x, y = free_stretch - 1, splice_stretch - 1
    total = float(x @ x)
    if total == 0:
        raise DataError("a strain ratio needs a stretched row", needed="a free length above slack")
    ratio = float(x @ y) / total
    residual = ratio * x - y
    by_x, by_y = (y - 2 * ratio * x) / total, x / total
    # readings of a row: near toe, far toe, far thimble
    by_toe = by_x / relaxed_free_length - by_y / relaxed_splice_length
    variance = reading_uncertainty**2 * float(
        np.sum(2 * by_toe**2 + (by_y / relaxed_splice_length) ** 2)
    )
    variance = max(variance, larger_variance(0.0, residual, 1) / total)
    sensitivity = np.array(
        [
            [
                -float(by_x @ free_stretch) / relaxed_free_length,
                -float(by_y @ splice_stretch) / relaxed_splice_length,
            ]
        ]
    )
    return Calibration(np.array([ratio]), np.array([[variance]]), sensitivity, residual)

"""Coefficients of the strain methods from tape readings, each with its covariance.

A row of marks is three tape readings (near toe, far toe, far thimble) of one
standard uncertainty.  The relaxed lengths come from the slack rows alone
(`reduction.strain.relaxed`), so that strain is zero at slack by construction; the
stretched rows give the rest.  Where the rows scatter more than the tape explains,
the covariance is widened (`reduction.strain.scatter`).

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
from reduction.record import Floats, read_only_arrays
from reduction.strain.scatter import row_scatter


@dataclass(frozen=True)
@read_only_arrays
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
    note : str
        What the marks do that the tape does not explain; empty where it does.
    """

    values: Floats
    covariance: Floats
    relaxed_sensitivity: Floats
    residual: Floats
    note: str = ""


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
    scatter = row_scatter(
        reading_uncertainty**2 * (2 + slope**2), residual, np.stack([np.ones_like(length), length])
    )
    covariance = scatter.variance * np.array(
        [
            [1 / free.size + centre**2 / spread, -centre / spread],
            [-centre / spread, 1 / spread],
        ]
    )
    return Calibration(
        np.array([intercept, slope]), covariance, np.zeros((2, 2)), residual, scatter.note
    )


def fit_splice_ratio(
    free_length: ArrayLike,
    splice_length: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    relaxed_covariance: ArrayLike = ((0.0, 0.0), (0.0, 0.0)),
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
    relaxed_covariance : array_like, shape (2, 2)
        Of the two relaxed lengths, by which residuals are judged; it is not in the covariance
        returned. [m2]

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
    of_toe = ratio / relaxed_free_length + 1 / relaxed_splice_length
    slope = np.stack([-ratio * free_stretch / relaxed_free_length,
                      splice_stretch / relaxed_splice_length])  # fmt: skip
    scatter = row_scatter(
        reading_uncertainty**2 * (2 * of_toe**2 + relaxed_splice_length**-2),
        residual,
        x[None],
        _root(np.asarray(relaxed_covariance, dtype=np.float64)).T @ slope,
    )
    variance = variance * scatter.widening**2 if variance > 0 else scatter.variance / total
    sensitivity = np.array(
        [
            [
                -float(by_x @ free_stretch) / relaxed_free_length,
                -float(by_y @ splice_stretch) / relaxed_splice_length,
            ]
        ]
    )
    return Calibration(
        np.array([ratio]), np.array([[variance]]), sensitivity, residual, scatter.note
    )


def _root(covariance: Floats) -> Floats:
    """Matrix whose product with its own transpose is a covariance, which may be singular."""
    variance, direction = np.linalg.eigh(covariance)
    return np.asarray(direction * np.sqrt(np.maximum(variance, 0)))

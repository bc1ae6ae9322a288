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
from scipy.optimize import minimize_scalar

from reduction.checks import as_finite, as_positive, as_same_shape
from reduction.errors import DataError, FitError
from reduction.record import Floats, freeze_arrays

__all__ = [
    "EXPONENT_BOUNDS",
    "Calibration",
    "fit_free_length_line",
    "fit_splice_law",
    "fit_splice_ratio",
    "line_slope",
    "relaxed_lengths",
]

EXPONENT_BOUNDS = (0.3, 1.9)
"""Exponents between which a splice law is looked for: a friction-locked splice
stiffens with tension (below 1), one that beds in and then slides softens (above 1)."""


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


def _larger_variance(stated: float, residual: Floats, n_values: int) -> float:
    """Variance the readings imply, or that of the residuals where it is larger."""
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
    variance = _larger_variance(reading_uncertainty**2 * (2 + slope**2), residual, 2)
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
    variance = max(variance, _larger_variance(0.0, residual, 1) / total)
    sensitivity = np.array(
        [
            [
                -float(by_x @ free_stretch) / relaxed_free_length,
                -float(by_y @ splice_stretch) / relaxed_splice_length,
            ]
        ]
    )
    return Calibration(np.array([ratio]), np.array([[variance]]), sensitivity, residual)


def fit_splice_law(
    splice_length: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    exponent: float | None = None,
) -> Calibration:
    r"""Power law of splice strain on tension.

    .. math:: \ell_s (1 + c F^n)

    Parameters
    ----------
    splice_length : array_like, shape (n_marks,)
        Both splices together, stretched rows. [m]
    tension : array_like, shape (n_marks,)
        While each row was read. [N]
    relaxed_splice_length : float
        From `relaxed_lengths`. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]
    exponent : float, optional
        Held at this value; None: fitted, within `EXPONENT_BOUNDS`. [1]

    Returns
    -------
    calibration : Calibration
        ``splice_compliance`` [N**-n] and ``splice_exponent`` [1].

    Raises
    ------
    DataError
        If there are fewer rows than coefficients, or a tension is not positive.
    FitError
        If the splices do not lengthen with tension, or the exponent runs to a bound.

    Notes
    -----
    Rows have equal weight: each splice length is three readings of one tape.  The
    compliance is linear and solved for; the exponent is found by a bounded search
    in one dimension, so that there is no starting value to depend on.

    Examples
    --------
    Three splices of 1.2 m that strain by 0.002 times the square root of tension:

    >>> force = np.array([100.0, 400.0, 900.0])
    >>> law = fit_splice_law(1.2 * (1 + 0.002 * np.sqrt(force)), force,
    ...                      relaxed_splice_length=1.2, reading_uncertainty=1e-3)
    >>> print(law.values.round(5))
    [0.002 0.5 ]
    """
    as_positive("relaxed_splice_length", relaxed_splice_length)
    splice, force = as_same_shape(
        splice_length=as_positive("splice_length", splice_length),
        tension=as_positive("tension", tension),
    )
    n_values = 1 if exponent is not None else 2
    if splice.size < n_values:
        raise DataError(
            "a splice law needs more marks",
            found=f"{splice.size} stretched rows with a tension",
            needed=f"at least {n_values}",
        )
    strain = splice / relaxed_splice_length - 1
    # tension over its geometric mean: keeps compliance and exponent apart in the fit
    reference = float(np.exp(np.mean(np.log(force))))
    relative = force / reference

    def compliance(trial: float) -> tuple[float, Floats]:
        power = relative**trial
        best = float(power @ strain) / float(power @ power)
        return best, best * power - strain

    if exponent is None:
        search = minimize_scalar(
            lambda trial: float(np.sum(compliance(trial)[1] ** 2)),
            bounds=EXPONENT_BOUNDS,
            method="bounded",
            options={"xatol": 1e-9},
        )
        exponent = float(search.x)
    at_reference, strain_residual = compliance(exponent)
    if at_reference <= 0:
        raise FitError(
            "the splices do not lengthen with tension",
            found=f"mean splice strain {float(strain.mean()):.4f}",
            needed="longer splices under tension than slack",
            n_marks=splice.size,
        )
    if n_values == 2 and min(abs(exponent - bound) for bound in EXPONENT_BOUNDS) < 1e-3:
        raise FitError(
            "the exponent of the splice law runs to the edge of its range",
            found=f"{exponent:.3f}",
            needed="between {} and {}".format(*EXPONENT_BOUNDS),
            hint="The marks do not follow a power law of tension; use marks or strain-ratio.",
            n_marks=splice.size,
        )
    power = relative**exponent
    design = relaxed_splice_length * np.stack([power, at_reference * power * np.log(relative)])
    design = design[:n_values]
    inverse = np.linalg.inv(design @ design.T)
    residual = relaxed_splice_length * strain_residual
    variance = _larger_variance(3 * reading_uncertainty**2, residual, n_values)
    covariance, sensitivity = np.zeros((2, 2)), np.zeros(2)
    covariance[:n_values, :n_values] = variance * inverse
    # d(splice length)/d(relaxed splice length) is the stretch of the splice
    sensitivity[:n_values] = -inverse @ design @ (1 + at_reference * power)
    # from the compliance at the reference tension to that at 1 N
    scale = reference**-exponent
    to_si = np.array([[scale, -at_reference * scale * np.log(reference)], [0.0, 1.0]])
    sensitivity = to_si @ sensitivity
    return Calibration(
        np.array([at_reference * scale, exponent]),
        to_si @ covariance @ to_si.T,
        np.stack([np.zeros(2), sensitivity], axis=1),
        residual,
    )

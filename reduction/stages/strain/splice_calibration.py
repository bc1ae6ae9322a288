"""Coefficients of one splice law from the stretched rows of tape readings, with their covariance.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.contributions import covariance_root
from reduction.record.errors import DataError, FitError
from reduction.record.measurement import (
    Floats,
    read_only_arrays,
)
from reduction.record.notes import Note
from reduction.stages.strain.mark_readings import row_scatter


@dataclass(frozen=True)
@read_only_arrays
class SpliceCalibration:
    """Fitted coefficients of one method."""

    values: Floats
    covariance: Floats
    relaxed_sensitivity: Floats
    residual: Floats
    note: Note | None = None


def line_slope(position: ArrayLike, values: ArrayLike) -> float:
    """Least squares slope of a series on position.

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
) -> SpliceCalibration:
    """Least squares line of free length on position.

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
    return SpliceCalibration(
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
) -> SpliceCalibration:
    r"""Ratio of splice strain to free strain, least squares through the slack point.

    .. math:: \rho = \sum x y / \sum x^2

    with :math:`x` the free strain and :math:`y` the splice strain.

    Notes
    -----
    Errors of the free strain are one fortieth of its value in Table 3 of [1]_, so
    their bias of the ratio is below the digits given.

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
        covariance_root(np.asarray(relaxed_covariance, dtype=np.float64)).T @ slope,
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
    return SpliceCalibration(
        np.array([ratio]), np.array([[variance]]), sensitivity, residual, scatter.note
    )


EXPONENT_BOUNDS = (0.3, 1.9)
"""Bounds of the search for the exponent of a splice law: a friction-locked splice
stiffens with tension (below 1), one that beds in and then slides softens (above 1)."""

HELD_EXPONENT = 1.0
"""Exponent where the marks do not determine one: splices that strain in proportion to tension."""

_POLISHING_STEPS = 30


def fit_power_law(
    splice_length: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    exponent: float | None = None,
    relaxed_standard_uncertainty: float = 0.0,
) -> SpliceCalibration:
    r"""Power law of splice strain on tension.

    .. math:: \ell_s (1 + c F^n)

    Notes
    -----
    Rows have equal weight: each splice length is three readings of one tape, and its stated
    error is taken unless the residuals refute it
    (`reduction.stages.strain.mark_readings.row_scatter`).  The
    compliance is linear and solved for.  The exponent is found by a bounded search
    in one dimension, so that there is no starting value to depend on, then refined to
    its last digits.

    Examples
    --------
    Three splices of 1.2 m that strain by 0.002 times the square root of tension:

    >>> force = np.array([100.0, 400.0, 900.0])
    >>> law = fit_power_law(1.2 * (1 + 0.002 * np.sqrt(force)), force,
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
    # tension is scaled by its geometric mean to decorrelate compliance and exponent in the fit
    reference = float(np.exp(np.mean(np.log(force))))
    relative = force / reference

    def compliance(trial: float) -> tuple[float, Floats]:
        power = relative**trial
        best = float(power @ strain) / float(power @ power)
        return best, best * power - strain

    if exponent is None:
        search = scipy.optimize.minimize_scalar(
            lambda trial: float(np.sum(compliance(trial)[1] ** 2)),
            bounds=EXPONENT_BOUNDS,
            method="bounded",
            options={"xatol": 1e-9},
        )
        exponent = _polished(float(search.x), compliance, relative)
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
    stretch = 1 + at_reference * power
    scatter = row_scatter(
        3 * reading_uncertainty**2, residual, design, relaxed_standard_uncertainty * stretch
    )
    covariance, sensitivity = np.zeros((2, 2)), np.zeros(2)
    covariance[:n_values, :n_values] = scatter.variance * inverse
    # d(splice length)/d(relaxed splice length) is the stretch of the splice
    sensitivity[:n_values] = -inverse @ design @ stretch
    # from the compliance at the reference tension to that at 1 N
    scale = reference**-exponent
    to_si = np.array([[scale, -at_reference * scale * np.log(reference)], [0.0, 1.0]])
    sensitivity = to_si @ sensitivity
    return SpliceCalibration(
        np.array([at_reference * scale, exponent]),
        to_si @ covariance @ to_si.T,
        np.stack([np.zeros(2), sensitivity], axis=1),
        residual,
        scatter.note,
    )


def _polished(
    exponent: float, compliance: Callable[[float], tuple[float, Floats]], relative: Floats
) -> float:
    """Gauss-Newton steps while they get shorter.

    A search that compares sums of squares finds only half the digits of the exponent; the rest
    depends on the rounding of the sums, which differs between processors.
    """
    shortest = np.inf
    for _ in range(_POLISHING_STEPS):
        power = relative**exponent
        at_reference, residual = compliance(exponent)
        slope = at_reference * power * np.log(relative)
        slope -= power * float(power @ slope) / float(power @ power)
        size = float(slope @ slope)
        step = -float(slope @ residual) / size if size > 0 else np.inf
        low, high = EXPONENT_BOUNDS
        if not (abs(step) < shortest and low < exponent + step < high):
            break
        exponent, shortest = exponent + step, abs(step)
    return exponent


TENSION_SPAN = 2.0
"""Marks must span this factor in tension before an exponent is fitted to them. [1]"""

# an exponent less certain than this adds nothing to a straight line
EXPONENT_UNCERTAINTY = 0.25

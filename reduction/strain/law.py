"""Power law of splice strain on tension, fitted to tape readings.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.checks import as_positive, as_same_shape
from reduction.errors import DataError, FitError
from reduction.record import Floats
from reduction.strain.calibration import Calibration
from reduction.strain.scatter import row_scatter

EXPONENT_BOUNDS = (0.3, 1.9)
"""Exponents between which a splice law is looked for: a friction-locked splice
stiffens with tension (below 1), one that beds in and then slides softens (above 1)."""
HELD_EXPONENT = 1.0
"""Exponent where the marks do not fix one: splices that strain in proportion to tension."""
_POLISHING_STEPS = 30


def fit_splice_law(
    splice_length: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_splice_length: float,
    reading_uncertainty: float,
    exponent: float | None = None,
    relaxed_standard_uncertainty: float = 0.0,
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
    relaxed_standard_uncertainty : float
        Of ``relaxed_splice_length``, by which residuals are judged; it is not in the covariance
        returned. [m]

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
    Rows have equal weight: each splice length is three readings of one tape, and its stated
    error is taken unless the residuals refute it (`reduction.strain.scatter.row_scatter`).  The
    compliance is linear and solved for; the exponent is found by a bounded search
    in one dimension, so that there is no starting value to depend on, and followed from there to
    its last digits.

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
    return Calibration(
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

    A search that compares sums of squares stops at half the digits of the exponent, at a place
    that the last digits of the sums decide, which are those of a processor.
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

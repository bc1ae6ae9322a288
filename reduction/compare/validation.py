r"""Comparison error against the uncertainty of measurement and prediction together.

.. math:: u_{val}^2 = u_{input}^2 + u_D^2 \qquad (u_{num} = 0)

at every strain, and with the covariance over the strains for the curve as a whole.

References
----------
.. [1] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer," sec. 1-5 and 6.
.. [2] ASME V&V 20.1-2024, "Multivariate Metric for Validation."
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.product import Validation
from reduction.compare.verdict import LEAST_PROBABILITY, probability_words, verdict_words
from reduction.errors import DataError
from reduction.record import Floats

N_DRAWS = 4000
"""Draws of all errors that a verdict rests on: 5 % of them are 200."""
_PROBABILITY = 0.95
_RANK = 1e-10  # eigenvalues of a correlation matrix below this part of the greatest are rounding
_OUTSIDE = 1e-6
_SEED = 21  # any; that it stays makes answers repeatable


@dataclass(frozen=True)
class _Errors:
    """At the strains that are compared: own (n,), shared (n_source, n), inputs (n_draws, n)."""

    own: Floats
    shared: Floats
    inputs: Floats

    def of_test(self) -> Floats:
        return np.asarray(np.sqrt(self.own**2 + np.sum(self.shared**2, axis=0)))

    def of_model(self) -> Floats:
        """Root mean square about the nominal hose: the shift of the mean is in it."""
        if not self.inputs.size:
            return np.zeros(self.own.size)
        return np.asarray(np.sqrt(np.mean(self.inputs**2, axis=0)))

    def covariance(self) -> Floats:
        n_draws = max(self.inputs.shape[0], 1)
        by_inputs = _product(self.inputs.T, self.inputs) / n_draws
        by_shared = _product(self.shared.T, self.shared)
        return np.asarray(by_inputs + by_shared + np.diag(self.own**2))

    def draw(self) -> Floats:
        """What E may be if the prediction is right, shape (n_draws, n)."""
        n_draws = self.inputs.shape[0] or N_DRAWS
        normal = np.random.default_rng(_SEED).standard_normal
        errors = _product(normal((n_draws, self.shared.shape[0])), self.shared)
        errors += normal((n_draws, self.own.size)) * self.own
        return np.asarray(errors - self.inputs if self.inputs.size else errors)


def _product(one: Floats, other: Floats) -> Floats:
    """Matrix product whose sums are in one order: that of a library depends on its threads."""
    return np.asarray(np.einsum("ik,kj->ij", one, other, optimize=False))


class _Judged(NamedTuple):
    ratio: float
    place: int
    factor: float
    chi_square: float
    freedom: int
    probability: float
    outside: float  # part of the squared difference that no stated error can make


def _judge(error: Floats, errors: _Errors) -> _Judged:
    nan = float("nan")
    total = np.hypot(errors.of_test(), errors.of_model())
    known = np.flatnonzero(total > 0)
    if not known.size:
        return _Judged(nan, 0, nan, nan, 0, nan, 0.0)
    z = error[known] / total[known]
    draws = errors.draw()[:, known] / total[known]
    correlation = errors.covariance()[np.ix_(known, known)] / np.outer(total[known], total[known])
    size, axes = np.linalg.eigh(correlation)
    kept = size > _RANK * size[-1] * size.size
    along = axes.T @ z
    square = float(np.sum(along[kept] ** 2 / size[kept]))
    of_draws = np.sum(_product(draws, axes[:, kept]) ** 2 / size[kept], axis=1)
    whole = float(z @ z)
    place = int(np.argmax(np.abs(z)))
    return _Judged(
        ratio=float(np.abs(z[place])),
        place=int(known[place]),
        factor=float(np.quantile(np.max(np.abs(draws), axis=1), _PROBABILITY)),
        chi_square=square,
        freedom=int(kept.sum()),
        probability=float(np.mean(of_draws >= square)),
        outside=float(np.sum(along[~kept] ** 2)) / whole if whole > 0 else 0.0,
    )


def validate_curve(
    predicted: ArrayLike,
    measured: MeasuredCurve,
    *,
    input_error: ArrayLike,
    largest_useful_share: float = 0.3,
) -> Validation:
    """Whether prediction and test agree within what both are uncertain by.

    Parameters
    ----------
    predicted : array_like, shape (n_strain,)
        Tension at the strains of the measured curve; NaN where the cords are broken. [N]
    measured : MeasuredCurve
        The test; its judged curve counts. [SI]
    input_error : array_like, shape (n_draws, n_strain)
        What the prediction may be off by, in draws of the numbers that went into it, from
        `reduction.compare.inputs.input_draws`; no rows where it counts as exact. [N]
    largest_useful_share : float
        Where U is more than this part of the measured tension at half of the strains,
        agreement says little. [1]

    Returns
    -------
    validation : Validation
        Uncertainties over strain, the largest ratio, chi square, and the verdict.

    Raises
    ------
    DataError
        If the series do not pair up, or prediction and test have no strain in common.

    Notes
    -----
    *Verdict.* With many strains the largest ratio abs(E) / u_val exceeds 2 almost always.  It is
    held against the 95 % quantile of the largest ratio in draws of all errors together, so that
    a right prediction is called wrong in 5 % of all cases however many strains there are: 1.96
    for strains that err as one, 3.3 for fifty that err each for itself.  U is that factor
    times u_val.  Agreement within U means that an error of the model cannot be seen; it does not
    mean that there is none [1]_.

    *Chi square* E' V^-1 E with the full covariance [2]_ sees a wrong shape that stays inside
    the band, and needs the uncertainties to be right in every direction; it does not make the
    verdict, which says so where it does not agree.  Its probability is the share of the draws
    that exceed it, since tension is no linear function of the angle where cords pick up.
    Directions in which no stated error can move the curve have no inverse and are left out; if
    the difference lies in one of them, a note says so.

    The draws are the same every time.

    Nothing is taken for an uncertainty that was not stated: the verdict says which side is
    missing.

    Examples
    --------
    A load cell that may be 10 N off, and a prediction 8 N below.

    >>> from reduction.compare.measured import measured_curve
    >>> from reduction.compare.shared import constant_errors
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(
    ...     stroke, 100 * stroke + 50, loading="static",
    ...     shared=constant_errors(tension_offset=10.0),
    ... )
    >>> found = validate_curve(
    ...     100 * pull.strain + 42, pull, input_error=np.zeros((0, pull.strain.size))
    ... )
    >>> print(found.agrees, found.verdict.split(",")[0], round(found.ratio, 2))
    True agrees within U 0.8
    """
    model, test = as_same_shape(predicted=predicted, measured=measured.tension_of(measured.judged))
    inputs = np.asarray(input_error, dtype=np.float64)
    if inputs.ndim != 2 or inputs.shape[1:] != model.shape:
        raise DataError(
            "errors of the prediction are not on the strains",
            found=str(inputs.shape),
            needed=f"(n_draws, {model.size})",
        )
    there = np.isfinite(model) & np.isfinite(test) & np.isfinite(inputs).all(axis=0)
    if not there.any():
        raise DataError(
            "prediction and test have no strain in common",
            found=f"{int(np.isfinite(test).sum())} measured strains",
            needed="one at which both are known",
        )
    shared = measured.contribution_of(measured.judged)
    errors = _Errors(
        own=measured.independent_uncertainty()[there],
        shared=np.vstack([shared, measured.scatter_contribution])[:, there],
        inputs=inputs[:, there],
    )
    error = np.where(there, model - test, np.nan)
    judged = _judge(error[there], errors)

    def on_axis(values: Floats) -> Floats:
        whole = np.full(model.size, np.nan)
        whole[there] = values
        return whole

    of_test, of_model = on_axis(errors.of_test()), on_axis(errors.of_model())
    total = np.hypot(of_test, of_model)
    factor, largest = judged.factor, judged.ratio
    place = int(np.flatnonzero(there)[judged.place])
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(there & (test > 0), factor * total / test, np.nan)
    share = float(np.nanmedian(shares)) if np.isfinite(shares).any() else float("nan")
    agrees = bool(largest <= factor)
    is_informative = bool(share <= largest_useful_share)
    found = Validation(
        input_standard_uncertainty=of_model,
        measurement_standard_uncertainty=np.where(there, of_test, np.nan),
        standard_uncertainty=total,
        coverage_factor=factor,
        ratio=largest,
        ratio_strain=float(measured.strain[place]) if np.isfinite(largest) else float("nan"),
        chi_square=judged.chi_square,
        chi_square_freedom=judged.freedom,
        chi_square_probability=judged.probability,
        share=share,
        agrees=agrees,
        is_informative=is_informative,
        verdict="",
        ratio_difference=float(error[place]) if np.isfinite(largest) else float("nan"),
        notes=_notes(inputs, measured, agrees, judged),
    )
    return replace(found, verdict=verdict_words(found))


def _notes(
    inputs: Floats, measured: MeasuredCurve, agrees: bool, judged: _Judged
) -> tuple[str, ...]:
    notes = []
    if not inputs.any():
        notes.append(
            "no uncertainty of the prediction is stated: it counts as exact, and a difference "
            "that the angle or the cord curve would explain counts against it"
        )
    if not measured.contribution.any():
        notes.append("no uncertainty of the calibration is stated: the test counts as unbiased")
    elif not any(one.source.startswith("tension_") for one in measured.component):
        notes.append("nothing is stated of the load cell: its scale and its zero count as exact")
    if agrees and judged.probability < LEAST_PROBABILITY:
        notes.append(
            f"no strain differs by more than U, but the shape of the difference is one that the "
            f"stated errors make in {probability_words(judged.probability)} of all cases alone"
        )
    if judged.outside > _OUTSIDE:
        notes.append(
            f"{100 * judged.outside:.2g} % of the squared difference lies where no stated error "
            "can be"
        )
    return tuple(notes)

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

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import chi2

from reduction.checks import as_same_shape
from reduction.compare.product import MeasuredCurve, Validation
from reduction.errors import DataError
from reduction.record import Floats

__all__ = ["joint_coverage_factor", "validate_curve"]

_PROBABILITY = 0.95
_N_DRAWS = 20_000
_RANK = 1e-10  # eigenvalues of a correlation matrix below this part of the greatest are rounding
_OUTSIDE = 1e-6  # part of a squared difference that no stated error can make


def joint_coverage_factor(independent: ArrayLike, contribution: ArrayLike) -> float:
    """Factor that the largest of many correlated ratios stays below in 95 % of all cases.

    Parameters
    ----------
    independent : array_like, shape (n_strain,)
        Standard uncertainty that no two strains share. [N]
    contribution : array_like, shape (n_source, n_strain)
        Signed contributions that they share. [N]

    Returns
    -------
    factor : float
        1.96 for one strain or strains that err as one; 3.3 for fifty that err each for
        itself. [1]

    Raises
    ------
    DataError
        If the contributions are not on the strains.

    Notes
    -----
    With many strains the largest of all ratios exceeds 2 almost always. The factor is the 95 %
    quantile of the largest ratio in 20 000 draws of normal errors with this covariance; the
    draws are the same every time.

    Examples
    --------
    >>> print(round(joint_coverage_factor(np.zeros(50), np.ones((1, 50))), 2))
    1.96
    """
    own = np.asarray(independent, dtype=np.float64)
    shared = np.asarray(contribution, dtype=np.float64)
    if shared.ndim != 2 or shared.shape[1:] != own.shape:
        raise DataError(
            "contributions are not on the strains",
            found=f"{shared.shape} and {own.shape}",
            needed="(n_source, n_strain) and (n_strain,)",
        )
    total = np.sqrt(own**2 + np.sum(shared**2, axis=0))
    known = total > 0
    own, shared, total = own[known], shared[:, known], total[known]
    if not total.size:
        return float("nan")
    draws = np.random.default_rng(20).standard_normal
    largest = np.empty(_N_DRAWS)
    n_block = max(1, 1_000_000 // total.size)
    for start in range(0, _N_DRAWS, n_block):
        n = min(n_block, _N_DRAWS - start)
        errors = draws((n, shared.shape[0])) @ shared
        if own.any():
            errors += draws((n, own.size)) * own
        largest[start : start + n] = np.max(np.abs(errors) / total, axis=1)
    return float(np.quantile(largest, _PROBABILITY))


def validate_curve(
    predicted: ArrayLike,
    measured: MeasuredCurve,
    *,
    input_contribution: ArrayLike,
    largest_useful_share: float = 0.3,
) -> Validation:
    """Whether prediction and test agree within what both are uncertain by.

    Parameters
    ----------
    predicted : array_like, shape (n_strain,)
        Tension at the strains of the measured curve; NaN where the cords are broken. [N]
    measured : MeasuredCurve
        The test; its judged curve counts. [SI]
    input_contribution : array_like, shape (n_source, n_strain)
        To the prediction, from the numbers that went into it, signed. [N]
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
    *Verdict.* The largest ratio abs(E) / u_val of the curve against `joint_coverage_factor`: a
    right prediction is called wrong in 5 % of all cases however many strains there are.  U is
    that factor times u_val.  Agreement within U means that an error of the model cannot be
    seen; it does not mean that there is none [1]_.

    *Chi square* E' V^-1 E with the full covariance [2]_ sees a wrong shape that stays inside
    the band, and needs the uncertainties to be right in every direction; it is given beside the
    verdict and does not make it.  Directions in which no stated error can move the curve (as
    in a test without scatter) have no inverse and are left out; if the difference lies in
    one of them, a note says so.

    Nothing is taken for an uncertainty that was not stated: the verdict says which side is
    missing.

    Examples
    --------
    A load cell that may be 10 N off, and a prediction 8 N below.

    >>> from reduction.compare.measured import SharedUncertainty, measured_curve
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(
    ...     stroke, 100 * stroke + 50, loading="static",
    ...     shared=SharedUncertainty(tension_offset=10.0),
    ... )
    >>> found = validate_curve(
    ...     100 * pull.strain + 42, pull, input_contribution=np.zeros((0, pull.strain.size))
    ... )
    >>> print(found.agrees, found.verdict.split(",")[0])
    True agrees within U
    """
    model, test = as_same_shape(predicted=predicted, measured=measured.tension_of(measured.judged))
    inputs = np.asarray(input_contribution, dtype=np.float64)
    if inputs.ndim != 2 or inputs.shape[1:] != model.shape:
        raise DataError(
            "contributions are not on the strains",
            found=str(inputs.shape),
            needed=f"(n_source, {model.size})",
        )
    there = np.isfinite(model) & np.isfinite(test) & np.isfinite(inputs).all(axis=0)
    if not there.any():
        raise DataError(
            "prediction and test have no strain in common",
            found=f"{int(np.isfinite(test).sum())} measured strains",
            needed="one at which both are known",
        )
    own = np.where(there, measured.independent_uncertainty(), np.nan)
    shared = np.vstack([measured.contribution, measured.scatter_contribution])
    of_test = np.sqrt(own**2 + np.sum(shared**2, axis=0))
    of_model = np.where(there, np.sqrt(np.sum(inputs**2, axis=0)), np.nan)
    total = np.sqrt(of_test**2 + of_model**2)
    error = np.where(there, model - test, np.nan)
    common = np.vstack([inputs, shared])[:, there]
    factor = joint_coverage_factor(own[there], common)
    known = np.where(total > 0, total, np.nan)
    ratio = np.abs(error) / known
    place = int(np.nanargmax(ratio)) if np.isfinite(ratio).any() else 0
    largest = float(ratio[place])
    square, freedom, outside = _chi_square(error[there], own[there], common)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = np.where(there & (test > 0), factor * total / test, np.nan)
    share = float(np.nanmedian(shares)) if np.isfinite(shares).any() else float("nan")
    agrees = bool(largest <= factor)
    is_informative = bool(share <= largest_useful_share)
    words = _verdict(
        agrees=agrees,
        is_informative=is_informative,
        error=float(error[place]),
        strain=float(measured.strain[place]),
        ratio=largest,
        factor=factor,
        share=share,
        middle=float(np.nanmedian(factor * total)),
    )
    return Validation(
        input_standard_uncertainty=of_model,
        measurement_standard_uncertainty=np.where(there, of_test, np.nan),
        standard_uncertainty=total,
        coverage_factor=factor,
        ratio=largest,
        ratio_strain=float(measured.strain[place]) if np.isfinite(largest) else float("nan"),
        chi_square=square,
        chi_square_freedom=freedom,
        chi_square_probability=float(chi2.sf(square, freedom)) if freedom else float("nan"),
        share=share,
        agrees=agrees,
        is_informative=is_informative,
        verdict=words,
        notes=_notes(
            inputs, measured, agrees, float(chi2.sf(square, freedom)) if freedom else 1.0, outside
        ),
    )


def _chi_square(error: Floats, own: Floats, shared: Floats) -> tuple[float, int, float]:
    """E' V^-1 E, the rank of V, and the part of the squared difference that V cannot make."""
    total = np.sqrt(own**2 + np.sum(shared**2, axis=0))
    known = total > 0
    if not known.any():
        return float("nan"), 0, 0.0
    z = error[known] / total[known]
    rows = shared[:, known] / total[known]
    correlation = rows.T @ rows + np.diag((own[known] / total[known]) ** 2)
    size, axes = np.linalg.eigh(correlation)
    kept = size > _RANK * size[-1] * size.size
    along = axes.T @ z
    square = float(np.sum(along[kept] ** 2 / size[kept]))
    whole = float(z @ z)
    outside = float(np.sum(along[~kept] ** 2)) / whole if whole > 0 else 0.0
    return square, int(kept.sum()), outside


def _verdict(
    *,
    agrees: bool,
    is_informative: bool,
    error: float,
    strain: float,
    ratio: float,
    factor: float,
    share: float,
    middle: float,
) -> str:
    if not np.isfinite(ratio):
        return "not judged: neither the test nor the prediction has an uncertainty"
    if not agrees:
        way = "above" if error > 0 else "below"
        return (
            f"differs by {error:+.4g} N at strain {strain:.4g}, {ratio:.1f} times its standard "
            f"uncertainty ({factor:.1f} expected at most): the prediction is {way} the test"
        )
    within = f"agrees within U, {middle:.3g} N or {100 * share:.2g} % of the tension at the median"
    if is_informative:
        return within
    return f"{within}: so wide that agreement says little"


def _notes(
    inputs: Floats, measured: MeasuredCurve, agrees: bool, probability: float, outside: float
) -> tuple[str, ...]:
    notes = []
    if not inputs.any():
        notes.append(
            "no uncertainty of the prediction is stated: it counts as exact, and a difference "
            "that the angle or the cord curve would explain counts against it"
        )
    if not measured.contribution.any():
        notes.append("no uncertainty of the calibration is stated: the test counts as unbiased")
    if agrees and probability < 1 - _PROBABILITY:
        notes.append(
            f"no strain differs by more than U, but the shape of the difference is one that the "
            f"stated errors make in {100 * probability:.2g} % of all cases alone"
        )
    if outside > _OUTSIDE:
        notes.append(
            f"{100 * outside:.2g} % of the squared difference lies where no stated error can be"
        )
    return tuple(notes)

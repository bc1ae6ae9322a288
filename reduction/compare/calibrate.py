r"""Named numbers of a hose fitted to a measured curve.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
.. [2] G. A. F. Seber and C. J. Wild, "Nonlinear Regression," Wiley, 1989, ch. 2 and 6.
.. [3] R. T. Birge, "The calculation of errors by the method of least squares," Phys. Rev.,
   vol. 40, 1932.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.special import stdtrit

from reduction.compare.difference import difference_of
from reduction.compare.fitproblem import FitProblem, FitSpread, parameter_bounds, spread_of
from reduction.compare.identifiability import identify_directions, plausible_error
from reduction.compare.inputs import cord_curve_error, known_uncertainties
from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.product import Calibration, Identifiability
from reduction.compare.shared import error_words, read_along
from reduction.compare.trials import design_with, number_of
from reduction.errors import DataError, SettingsError
from reduction.predict.hose import predict_hose
from reduction.predict.product import HoseDesign
from reduction.record import Bools, Floats

_LEAST_NOISE = 1e-6  # of the RMS tension: points without scatter are not infinitely exact
_AT_BOUND = 1e-4  # of the width between the bounds
_FAR = 2.0  # standard uncertainties
_NOTHING = 1e-3  # of the noise
_WIDE = 0.5  # of the width between the bounds


def calibrate_hose(
    design: HoseDesign,
    measured: MeasuredCurve,
    parameters: Sequence[str],
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
) -> Calibration:
    r"""Fit numbers of a hose to the judged curve of a test, with intervals that can be trusted.

    Least of

    .. math:: \sum_i \frac{[T_i(\theta, z) + \sum_j z_j c_{ij} - D_i]^2}{u_i^2 + s^2}
              + \sum_j z_j^2

    over the numbers :math:`\theta` between their bounds and the shared errors :math:`z`, each of
    unit variance.  Errors of strain move the strains at which T is taken, uncertain numbers that
    are not fitted change the hose, and :math:`T_i` is read from it as the curve was from the
    samples; errors of load and the scatter that cycles have in common are in proportion.

    Parameters
    ----------
    design : HoseDesign
        One hose; where the fit begins, and the numbers that are not fitted.
    measured : MeasuredCurve
        The test. [SI]
    parameters : sequence of str, length n_parameter
        One to five of `reduction.compare.identifiability.CALIBRATED`.
    standard_uncertainty : mapping of str to float, optional
        Of numbers of the design; those of fitted numbers do not hold them back. [SI]
    bounds : mapping of str to tuple of float, optional
        Instead of `reduction.compare.fitproblem.parameter_bounds`. [SI]

    Returns
    -------
    calibration : Calibration
        Values, intervals, correlations, and whether the curve can tell them apart. [SI]

    Raises
    ------
    SettingsError
        If a number is not one to be fitted, is named twice, or its bounds are empty.
    DataError
        If there are fewer points than numbers and two.
    FitError
        If the least sum of squares is not found.

    Notes
    -----
    *Weights* [2]_. Type A of each strain, and s, one variance for all strains that makes the
    residuals of a first fit what they should be: where the model is wrong by more than the
    noise, all strains count alike instead of the few with the least scatter.

    *Intervals.* A model that is wrong is wrong smoothly: neighbouring residuals are no
    independent witnesses.  The variance of the data is multiplied by the length over which
    residuals are correlated, tau, and by what is left of the reduced chi square where that
    is above 1 [3]_; the interval is Student's with n / tau - p degrees of freedom.  Shared
    errors keep their stated variance.  Not in the interval: a smooth error of the model that
    fitted numbers can follow and that leaves no residual; but where `identify_directions` finds
    that the curve does not show a direction, what one percent of it would do is.  An interval
    that would reach beyond all that a number was allowed is NaN.

    *Start.* Of five values of each number around the design, in all combinations, the best.

    *Break.* Trials whose cords would break within the measured strains go on along their
    tangent, so that the fit does not fall into a gap.

    Fitted values are those that make the prediction meet this test; a cord scale found from a
    dynamic test holds what the cord does differently under dynamic load.

    Examples
    --------
    A pull of the hose itself, its modulus thought to be a tenth less.

    >>> from reduction.compare.measured import measured_curve
    >>> from reduction.predict.cordcurve import CordCurve
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.0, 1001)
    >>> pull = measured_curve(stroke, predict_hose(hose, stroke).tension, loading="static")
    >>> found = calibrate_hose(
    ...     design_with(hose, {"rubber_modulus": 1.26e6}), pull, ["rubber_modulus"]
    ... )
    >>> print(found.parameter, (found.value / 1e6).round(3), found.identifiability.is_identified)
    ('rubber_modulus',) [1.4] True
    """
    names, stated = tuple(parameters), dict(standard_uncertainty or {})
    held = {name: u for name, u in stated.items() if name not in names}
    judged = measured.tension_of(measured.judged)
    used = np.isfinite(judged)
    start = np.array([number_of(design, name) for name in names])
    problem, sources = _pose(design, measured, names, bounds or {}, held)
    p = len(names)
    first = problem.solve(problem.start(start / problem.unit), problem.noise)
    near = design_with(design, dict(zip(names, (first[:p] * problem.unit).tolist(), strict=True)))
    between = cord_curve_error(near, measured.strain)[used]
    if np.any(np.abs(between) > problem.noise * _NOTHING):
        problem = replace(problem, shared=np.vstack([problem.shared, between]))
        sources = (*sources, "cord curve between its points")
        first = problem.solve(first, problem.noise)
    remainder = problem.remainder(first)
    excess = remainder @ remainder / (remainder.size - p) - np.mean(problem.noise**2)
    model_error = float(np.sqrt(np.maximum(excess, 0.0)))
    noise = np.hypot(problem.noise, model_error)
    best = problem.solve(first, noise)
    value = best[:p] * problem.unit
    fitted = design_with(design, dict(zip(names, value.tolist(), strict=True)))
    spread = spread_of(problem, best, noise)
    told_apart = identify_directions(
        problem.slopes(best[: problem.n_traced])[:, :p] / problem.unit,
        tension=problem.tension_at(best[None, : problem.n_traced])[0],
        names=names,
        plausible=problem.unit,
        value=value,
        contribution=problem.error_slopes(best),
        misfit=float(np.sqrt(np.mean(problem.remainder(best) ** 2))),
    )
    covariance = spread.covariance * np.outer(problem.unit, problem.unit)
    covariance += told_apart.open_covariance
    deviation = np.sqrt(np.diagonal(covariance))
    width = (problem.high - problem.low) * problem.unit
    half = stdtrit(spread.freedom, 0.975) * deviation
    is_wide = 2 * half > _WIDE * width
    is_known = half <= width
    half, stated_deviation = (np.where(is_known, one, np.nan) for one in (half, deviation))
    margin = _AT_BOUND * (problem.high - problem.low)
    at_bound = (best[:p] - problem.low < margin) | (problem.high - best[:p] < margin)
    predicted = [predict_hose(one, measured.strain).tension for one in (design, fitted)]
    before, after = (
        difference_of(measured.strain, one, judged, curve=measured.judged) for one in predicted
    )
    return Calibration(
        parameter=names,
        start=start,
        value=value,
        standard_uncertainty=stated_deviation,
        low=value - half,
        high=value + half,
        lower_bound=problem.low * problem.unit,
        upper_bound=problem.high * problem.unit,
        is_at_bound=at_bound,
        correlation=covariance / np.outer(deviation, deviation),
        identifiability=told_apart,
        design=fitted,
        before=before,
        after=after,
        model_error=model_error,
        effective_points=spread.effective_points,
        shared_error=sources,
        shared_error_value=best[p:],
        notes=(
            *_notes_of_numbers(names, told_apart, at_bound, is_wide),
            *_notes_of_fit(spread, p, sources, best[p:], used & ~np.isfinite(predicted[1])),
            *_notes_of_stated(names, value - start, stated),
        ),
    )


def _pose(
    design: HoseDesign,
    measured: MeasuredCurve,
    names: tuple[str, ...],
    bounds: Mapping[str, tuple[float, float]],
    held: Mapping[str, float],
) -> tuple[FitProblem, tuple[str, ...]]:
    """The problem, and the names of the errors that are fitted beside the numbers."""
    if not names or len(set(names)) < len(names):
        raise SettingsError(
            "what to calibrate cannot be read",
            found=", ".join(names) or "nothing",
            needed="one number or more, each once",
        )
    start = [number_of(design, name) for name in names]
    unit = np.array([plausible_error(name, at) for name, at in zip(names, start, strict=True)])
    limits = []
    for name, at in zip(names, start, strict=True):
        low, high = bounds[name] if name in bounds else parameter_bounds(name, at)
        if not low < high:
            raise SettingsError(
                f"the bounds of {name} leave nothing between them",
                found=f"{low:g} to {high:g}",
                needed="a lower one below a higher one",
            )
        limits.append((low, high))
    low_high = np.array(limits) / unit[:, None]
    judged = measured.tension_of(measured.judged)
    used = np.isfinite(judged)
    if used.sum() < len(names) + 2:
        raise DataError(
            f"too few strains were measured to calibrate {len(names)} numbers",
            found=f"{int(used.sum())}",
            needed=f"{len(names) + 2} or more",
        )
    floor = _LEAST_NOISE * float(np.sqrt(np.mean(judged[used] ** 2)))
    stated = known_uncertainties(design, held)
    is_moved = np.any(measured.strain_error != 0, axis=1)
    in_proportion = measured.contribution_of(measured.judged)[~is_moved]
    node = measured.reading.node
    scatter = measured.scatter_contribution
    problem = FitProblem(
        design=design,
        names=names,
        unit=unit,
        low=low_high[:, 0],
        high=low_high[:, 1],
        held=stated,
        moved=np.array(
            [read_along(node, measured.strain, row) for row in measured.strain_error[is_moved]]
        ).reshape(-1, node.size),
        measured=measured,
        noise=np.maximum(measured.independent_uncertainty()[used], floor),
        shared=np.vstack([in_proportion, scatter])[:, used],
    )
    common = tuple(f"scatter of the cycles {k + 1}" for k in range(scatter.shape[0]))
    names_of = np.array([error_words(one) for one in measured.component], dtype=object)
    return problem, (*stated, *names_of[is_moved], *names_of[~is_moved], *common)


def _notes_of_numbers(
    names: tuple[str, ...], told_apart: Identifiability, at_bound: Bools, is_wide: Bools
) -> list[str]:
    notes = []
    if not told_apart.is_identified:
        notes.append(
            f"this curve cannot tell {' and '.join(names)} apart: {told_apart.words}, less than "
            f"the {100 * told_apart.needed_change:.2g} % that an error of the model may be; the "
            "values are one choice of many, and their intervals are as wide as such an error makes "
            "them"
            if len(names) > 1
            else f"this curve does not show {names[0]}: {told_apart.words}, less than the "
            f"{100 * told_apart.needed_change:.2g} % that an error of the model may be"
        )
    notes += [
        f"{name} was stopped at a bound: its interval does not hold"
        for name, stopped in zip(names, at_bound, strict=True)
        if stopped
    ]
    notes += [
        f"the interval of {name} is wider than half of what it was allowed: not determined"
        for name, wide in zip(names, is_wide, strict=True)
        if wide
    ]
    return notes


def _notes_of_fit(
    spread: FitSpread, n_fitted: int, sources: tuple[str, ...], z: Floats, broken: Bools
) -> list[str]:
    notes = []
    if spread.effective_points < n_fitted + 1:
        notes.append(
            f"residuals are worth {spread.effective_points:.1f} independent points for {n_fitted} "
            "numbers: what is left is an error of the model, not noise"
        )
    notes += [
        f"{name} would have to be {value:+.1f} of its standard uncertainty off"
        for name, value in zip(sources, z, strict=True)
        if abs(value) > _FAR
    ]
    if broken.any():
        notes.append(
            f"cords of the fitted hose are broken at {int(broken.sum())} of the measured strains: "
            "there it was held against its tangent"
        )
    return notes


def _notes_of_stated(
    names: tuple[str, ...], moved: Floats, stated: Mapping[str, float]
) -> list[str]:
    return [
        f"{name} moved by {step / stated[name]:+.1f} of its stated standard uncertainty"
        for name, step in zip(names, moved, strict=True)
        if stated.get(name, 0) > 0 and abs(step) > _FAR * stated[name]
    ]

r"""Predicted minus measured: over strain, at events, in energy, with a verdict.

**Input and output of a comparison of a measured hose curve with its prediction.** A *comparison
error* is predicted less measured, E = S - D in the notation of [1]_: positive where the hose is
softer than predicted.

**Comparison error against the uncertainty of measurement and prediction together**:

.. math:: u_{val}^2 = u_{input}^2 + u_{num}^2 + u_D^2

at every strain, and with the covariance over the strains for the curve as a whole.

References
----------
.. [1] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid Dynamics
   and Heat Transfer," sec. 1-5 (comparison error E = S - D); sec. 1-5 and 6.
.. [2] C. J. Geyer, "Practical Markov chain Monte Carlo," Statist. Sci., vol. 7, 1992 (the initial
   positive sequence).
.. [3] N. F. Zhang, "Calculation of the uncertainty of the mean of autocorrelated measurements,"
   Metrologia, vol. 43, 2006.
.. [4] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical Properties,"
   Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004, sec. 1.2; sec. 3.0.
.. [5] G. A. F. Seber and C. J. Wild, "Nonlinear Regression," Wiley, 1989, ch. 9 (two phases with a
   change point that is not known).
.. [6] ASME V&V 20.1-2024, "Multivariate Metric for Validation."
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.prediction.hose_product import HoseDesign, HoseEvent, HosePrediction
from reduction.prediction.hose_tension import find_events, predict_hose
from reduction.prediction.hose_uncertainty import EventUncertainty, propagate_hose
from reduction.prediction.measured_curve import CurveName, Loading, MeasuredCurve
from reduction.quantities.digits import places_of
from reduction.record.arrays import as_finite, as_same_shape
from reduction.record.contributions import FROM_READINGS
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note


@dataclass(frozen=True)
@read_only_arrays
class _Difference:
    """Comparison error of one curve; ``difference`` has the shape (n_strain,), NaN outside.

    ``relative_rms`` is the RMS of the comparison error over the RMS of the measured tension at
    the same strains; the worst point has the greatest absolute difference.
    """

    curve: CurveName
    strain: Floats
    difference: Floats
    bias: float
    rms: float
    relative_rms: float
    worst_strain: float
    worst_tension_difference: float


@dataclass(frozen=True)
class EventDifference:
    """Comparison error at the events of the cords, on the judged curve.

    ``tension_difference`` [N] is that at the predicted strain of the event; ``measured_strain``
    [1] is where the test had the *predicted tension* of the event, and ``strain_difference`` the
    predicted strain less that strain.  This is not the place of the event in the test, since it
    depends on the prediction; for the cords of the test see `Comparison.measured_pick_up_strain`.
    The standard uncertainties are those of the differences, with both sides included.  NaN where
    the test did not go that far.
    """

    name: str
    strain: float
    tension: float
    measured_tension: float
    tension_difference: float
    tension_difference_standard_uncertainty: float
    measured_strain: float
    strain_difference: float
    strain_difference_standard_uncertainty: float


@dataclass(frozen=True)
class _EnergyDifference:
    """Energies per relaxed length between the same two strains. [J m-1].

    The prediction is elastic and has no loop; ``energy_difference_share`` is the difference over
    the measured energy under the ascending branch, ``loop_energy_share`` the measured loop over
    it. [1]
    """

    energy_strain_low: float
    energy_strain_high: float
    measured_energy: float
    predicted_energy: float
    energy_difference: float
    energy_difference_share: float
    loop_energy: float
    loop_energy_share: float


@dataclass(frozen=True)
@read_only_arrays
class _CycleDifference:
    """Comparison error of each cycle, on its judged curve; shape (n_cycle,). [N].

    ``bias_per_decade`` is the slope of the bias over log10 of the cycle number, over all
    cycles, including break-in, with its standard uncertainty from the scatter about that line; the
    bias is taken at the strains that every cycle in it reached. [N]
    """

    cycle_number: Integers
    cycle_bias: Floats
    cycle_rms: Floats
    bias_per_decade: float
    bias_per_decade_standard_uncertainty: float


@dataclass(frozen=True)
@read_only_arrays
class _Validation:
    """Comparison error against the uncertainties of measurement and prediction.

    Arrays have the shape (n_strain,), NaN where nothing was compared. [N]  ``median_limit`` and
    ``uncertainty_share`` refer to the strains with a predicted load.
    """

    input_standard_uncertainty: Floats
    measurement_standard_uncertainty: Floats
    validation_uncertainty: Floats
    coverage_factor: float
    largest_ratio: float
    largest_ratio_strain: float
    chi_square: float
    chi_square_freedom: int
    chi_square_probability: float
    uncertainty_share: float
    median_limit: float
    agrees: bool
    is_informative: bool
    verdict: str
    ratio_difference: float = float("nan")
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class Identifiability:
    """Whether the curve can separate the fitted parameters.

    Parameters
    ----------
    least_change : float
        RMS change of the curve over its own RMS, for a step of one plausible error along the
        direction of least response, without the part that shared errors can imitate. [1]
    needed_change : float
        A smaller change cannot be separated from an error of the model. [1]
    direction : ndarray, shape (n_parameter,)
        That direction, in units of each parameter. [SI]
    collinearity : float
        1 over the least singular value of the sensitivities scaled to unit length. [1]
    is_identified : bool
        Whether the least change exceeds the needed change.
    words : str
        Parameters that compensate each other; empty where all are identified.
    open_covariance : ndarray, shape (n_parameter, n_parameter)
        Covariance due to an error of the model that the curve cannot show, along the unidentified
        directions; zero where all are identified. [SI]
    """

    least_change: float
    needed_change: float
    direction: Floats
    collinearity: float
    is_identified: bool
    words: str
    open_covariance: Floats


@dataclass(frozen=True)
@read_only_arrays
class HoseCalibration:
    """Parameters of a hose fitted to a measured curve; arrays have the shape (n_parameter,).

    Parameters
    ----------
    parameter : tuple of str
        Names from `reduction.prediction.hose_product.HOSE_PARAMETERS`.
    start, value : ndarray
        Before and after the fit, in the unit of each. [SI]
    value_standard_uncertainty, low, high : ndarray
        Of the value, and its 95 % interval (not cut at the bounds); NaN where the interval would
        exceed the allowed range on either side. [SI]
    lower_bound, upper_bound : ndarray
        Bounds of the fit. [SI]
    is_at_bound : ndarray of bool
        Whether the fit stopped at a bound.
    correlation : ndarray, shape (n_parameter, n_parameter)
        Correlation of the fitted values. [1]
    design : HoseDesign
        The hose with the fitted values.
    before, after : _Difference
        Judged curve against the prediction, with the start and the fitted values.
    model_error : float
        Standard deviation to be added to type A for the residuals to be explained. [N]
    effective_points : float
        Number of strains over the autocorrelation length of the residuals. [1]
    shared_error : tuple of str
        Errors fitted together with the parameters, each within its standard uncertainty.
    shared_error_value : ndarray, shape (n_shared,)
        Their fitted values, in standard uncertainties. [1]
    """

    parameter: tuple[str, ...]
    start: Floats
    value: Floats
    value_standard_uncertainty: Floats
    low: Floats
    high: Floats
    lower_bound: Floats
    upper_bound: Floats
    is_at_bound: np.ndarray
    correlation: Floats
    identifiability: Identifiability
    design: HoseDesign
    before: _Difference
    after: _Difference
    model_error: float
    effective_points: float
    shared_error: tuple[str, ...]
    shared_error_value: Floats
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class PressureComparison:
    """Measured fill pressure and its prediction; `MeasuredCurve` holds pascals for newtons.

    ``calibration`` fits the parameters that affect the pressure to it alone; ``parameter`` names
    those that the comparison calibrates.
    """

    measured: MeasuredCurve
    predicted: Floats
    difference: _Difference
    validation: _Validation
    calibration: HoseCalibration | None
    parameter: tuple[str, ...]

    @property
    def fill_pressure_bias(self) -> float:
        """Mean of predicted less measured. [Pa]."""
        return self.difference.bias

    @property
    def fill_pressure_rms(self) -> float:
        """RMS of predicted less measured. [Pa]."""
        return self.difference.rms

    @property
    def fill_pressure_parameter_value(self) -> list[float]:
        """Value of each calibrated parameter; NaN if it does not affect the pressure."""
        return self._of_parameters("value")

    @property
    def fill_pressure_parameter_value_standard_uncertainty(self) -> list[float]:
        """Standard uncertainty of each of these."""
        return self._of_parameters("value_standard_uncertainty")

    def _of_parameters(self, what: str) -> list[float]:
        fit = self.calibration
        known = {} if fit is None else dict(zip(fit.parameter, getattr(fit, what), strict=True))
        return [float(known.get(name, np.nan)) for name in self.parameter]


@dataclass(frozen=True)
class Comparison:
    """A measured curve beside its prediction on the same axis of strain.

    ``differences`` has one entry per measured curve, by name; ``judged`` is the one used for
    events, validation and calibration.  ``measured_pick_up_strain`` [1] is where that curve itself
    bends upward, with its standard uncertainty; NaN where it does not show a bend, and a note says
    why.
    """

    measured: MeasuredCurve
    prediction: HosePrediction
    judged: CurveName
    differences: dict[CurveName, _Difference]
    events: tuple[EventDifference, ...]
    energy: _EnergyDifference
    cycles: _CycleDifference
    validation: _Validation
    calibration: HoseCalibration | None
    notes: tuple[Note, ...]
    measured_pick_up_strain: float = float("nan")
    measured_pick_up_strain_standard_uncertainty: float = float("nan")
    pressure: PressureComparison | None = None


def autocorrelation_length(residual: ArrayLike) -> float:
    r"""Autocorrelation length of residuals, in points.

    .. math:: \tau = 1 + 2 \sum_k \rho_k

    Notes
    -----
    The sum ends before the first pair of lags with a negative sum of correlations
    [2]_.  The variance of a mean of such residuals is that of n / tau points [3]_.

    Examples
    --------
    Signs that change every ten points: the correlation falls to zero within five, and the
    correlation length is about seven points.

    >>> wave = np.tile(np.repeat([1.0, -1.0], 10), 10)
    >>> print(5 < autocorrelation_length(wave) < 10)
    True
    """
    r: Floats = as_finite("residual", residual)
    n = r.size
    power = float(r @ r)
    if n < 3 or power == 0:
        return 1.0
    padded = np.fft.rfft(r, 2 * n)
    rho = np.fft.irfft(padded * padded.conj(), 2 * n)[:n] / power
    pairs = rho[: n - n % 2].reshape(-1, 2).sum(axis=1)
    ended = np.flatnonzero(pairs <= 0)
    length = 2 * pairs[: ended[0] if ended.size else pairs.size].sum() - 1
    return float(np.clip(length, 1.0, n))


def difference_of(
    strain: ArrayLike, predicted: ArrayLike, measured: ArrayLike, *, curve: CurveName
) -> _Difference:
    """Comparison error E = predicted - measured of one curve.

    Notes
    -----
    Positive where the prediction is above the test ([1]_, sec. 1-5). The relative RMS is the RMS of
    the error over the RMS of the measured tension, both at the same strains.  Unlike a mean of
    relative errors it is not dominated by the start of the curve, where tension tends to zero, and
    it is 1 for a prediction of zero.  Strains count alike: the axis is equally spaced.

    Examples
    --------
    >>> found = difference_of(
    ...     [0.0, 0.1, 0.2], [0.0, 33.0, 44.0], [0.0, 30.0, 40.0], curve="midline"
    ... )
    >>> print(round(found.rms, 3), found.relative_rms)
    2.887 0.1
    >>> print(found.worst_strain, found.worst_tension_difference)
    0.2 4.0
    """
    x, model, test = as_same_shape(strain=strain, predicted=predicted, measured=measured)
    error = model - test
    both = np.isfinite(error)
    if not both.any():
        raise DataError(
            f"prediction and {curve} curve have no strain in common",
            found=f"measured at {_range(x, np.isfinite(test))}, "
            f"predicted at {_range(x, np.isfinite(model))}",
            needed="a strain at which both are known",
        )
    worst = int(np.nanargmax(np.abs(error)))
    rms = float(np.sqrt(np.mean(error[both] ** 2)))
    level = float(np.sqrt(np.mean(test[both] ** 2)))
    return _Difference(
        curve=curve,
        strain=x,
        difference=error,
        bias=float(error[both].mean()),
        rms=rms,
        relative_rms=rms / level if level > 0 else float("nan"),
        worst_strain=float(x[worst]),
        worst_tension_difference=float(error[worst]),
    )


def _range(strain: Floats, there: np.ndarray) -> str:
    if not there.any():
        return "no strain"
    return f"{100 * strain[there].min():.4g} to {100 * strain[there].max():.4g} %"


def _strain_at_tension(strain: ArrayLike, tension: ArrayLike, level: float) -> float:
    """Strain at which a measured curve first reaches a tension.

    Examples
    --------
    >>> print(round(_strain_at_tension([0.0, 0.1, 0.2], [0.0, 10.0, 30.0], 15.0), 6))
    0.125
    """
    x, y = as_same_shape(strain=strain, tension=tension)
    there = np.isfinite(y)
    x, y = x[there], y[there]
    above = np.flatnonzero(y >= level)
    if not above.size or (above[0] == 0 and y[0] > level):
        return float("nan")
    k = int(above[0])
    if k == 0:
        return float(x[0])
    return float(x[k - 1] + (level - y[k - 1]) / (y[k] - y[k - 1]) * (x[k] - x[k - 1]))


def energy_difference(predicted: ArrayLike, measured: MeasuredCurve) -> _EnergyDifference:
    """Energy under the ascending branch, and of the loop, beside the elastic prediction.

    Notes
    -----
    Trapezoidal rule.  The energy that a cyclic test does not return is the loop; an elastic
    prediction has none, and lies below the ascending branch by about half of it even where the
    midline agrees.

    Examples
    --------
    >>> from reduction.prediction.measured_curve import measured_curve
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(stroke, 100 * stroke, loading="static")
    >>> energy = energy_difference(110 * pull.strain, pull)
    >>> print(round(energy.measured_energy, 6), round(energy.energy_difference, 6))
    50.0 5.0
    >>> round(energy.energy_difference_share, 6), energy.loop_energy
    (0.1, nan)
    """
    model, up = as_same_shape(predicted=predicted, measured=measured.branch_tension[0])
    down = measured.branch_tension[1]
    has_loop = bool(np.isfinite(down).any())
    there = np.isfinite(model) & np.isfinite(up)
    if has_loop:
        there &= np.isfinite(down)
    if np.count_nonzero(there) < 2:
        return _EnergyDifference(*[float("nan")] * 8)
    x = measured.strain[there]
    taken, stored = (float(np.trapezoid(curve[there], x)) for curve in (up, model))
    loop = taken - float(np.trapezoid(down[there], x)) if has_loop else float("nan")
    return _EnergyDifference(
        energy_strain_low=float(x[0]),
        energy_strain_high=float(x[-1]),
        measured_energy=taken,
        predicted_energy=stored,
        energy_difference=stored - taken,
        energy_difference_share=stored / taken - 1 if taken > 0 else float("nan"),
        loop_energy=loop,
        loop_energy_share=loop / taken if taken > 0 else float("nan"),
    )


def cycle_differences(predicted: ArrayLike, measured: MeasuredCurve) -> _CycleDifference:
    """Comparison error of every cycle, and its trend over the cycles.

    Notes
    -----
    The bias of a cycle is that of the mean curve less the deviation of the cycle from it, so that
    a cycle with a shorter range does not get a bias from that.  A hose that softens from cycle
    to cycle has a bias that rises.

    Examples
    --------
    Each cycle 10 N below the one before: 1 to 3 is 0.477 decades.

    >>> from reduction.prediction.measured_curve import measured_curve
    >>> stroke = np.tile(np.concatenate([np.linspace(0, 1, 301), np.linspace(1, 0, 301)]), 3)
    >>> number = np.repeat([1, 2, 3], 602)
    >>> test = measured_curve(
    ...     stroke, 500 * stroke - 10 * number, loading="static", cycle_number=number,
    ...     branch=np.tile(np.repeat([1, 2], 301), 3),
    ... )
    >>> print(cycle_differences(500 * test.strain, test).cycle_bias.round(6))
    [10. 20. 30.]
    """
    model, mean = as_same_shape(predicted=predicted, measured=measured.tension_of(measured.judged))
    is_midline = measured.judged == "midline"
    each = measured.tension.mean(axis=1) if is_midline else measured.tension[:, 0]
    there = np.isfinite(each) & np.isfinite(model) & np.isfinite(mean)
    n = np.where(there.any(axis=1), there.sum(axis=1), np.nan)
    whole = np.isfinite(model) & np.isfinite(mean)
    above = np.where(there, each - mean, 0.0).sum(axis=1) / n
    squares = np.where(there, (model - each) ** 2, 0.0).sum(axis=1) / n
    bias = (float((model - mean)[whole].mean()) if whole.any() else np.nan) - above
    slope, slope_uncertainty = _slope(np.log10(measured.cycle_number), bias)
    return _CycleDifference(
        cycle_number=measured.cycle_number,
        cycle_bias=bias,
        cycle_rms=np.sqrt(squares),
        bias_per_decade=slope,
        bias_per_decade_standard_uncertainty=slope_uncertainty,
    )


def _slope(x: Floats, y: Floats) -> tuple[float, float]:
    there = np.isfinite(y)
    x, y = x[there], y[there]
    if x.size < 3:
        return float("nan"), float("nan")
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    spread = float(np.sum((y - slope * x) ** 2) / (x.size - 2))
    return slope, float(np.sqrt(spread / (x @ x)))


_MARGIN = 5  # bins needed on either side of a bend

_CANDIDATES = 41

_ENDS = (1.0, 0.8, 0.65, 0.5)  # shares of the strains: near break a pull bends in other ways too

_LEAST_RATIO = 5.0  # change of slope over its standard uncertainty

_LEAST_SHARE = 0.1  # change of slope over the mean slope: cords cause more

_ORDER = 3  # of the polynomial on either side

_TOES = (1.0, 1.1, 1.2, 1.35, 1.5)
"""Powers with which the load of a cord may begin. [1]"""

_TINY = 1e-9  # N: points without scatter


class PickUp(NamedTuple):
    """Strain at which the judged curve bends, with its standard uncertainty [1].

    NaN where the curve does not show it; ``reason`` says why.
    """

    strain: float
    standard_uncertainty: float
    reason: str


class _Fit(NamedTuple):
    strain: float
    uncertainty: float
    jump: float
    jump_uncertainty: float
    is_inside: bool
    squares: float
    unit: float  # of the squares: one variance of the residuals, times their autocorrelation length


class _Fitted(NamedTuple):
    """Fits with the bend at each of several strains."""

    squares: Floats
    residual: Floats
    jump: Floats
    variance: Floats  # of the jump, for the stated noise


def measured_pick_up(measured: MeasuredCurve) -> PickUp:
    r"""Find the strain at which a measured curve bends, independently of the prediction.

    .. math:: D(\varepsilon) = \sum_{k=0}^{3} b_k \varepsilon^k
              + \sum_{k=0}^{m-1} c_k (\varepsilon - \varepsilon_p)_+^{q+k}

    Notes
    -----
    Below the bend the rubber alone carries, above it the cords as well ([4]_, sec. 1.2): the curve
    is continuous and, with q = 1, its slope has a jump, :math:`c_0`.  Every place of the bend is
    tried [5]_, evaluated as the samples were, in the initial part of the curve that shows it best.
    A cord whose load begins as a power of its strain rounds the bend, and with q = 1 the place
    found is then too high.  So the place is the mean over five q from 1 to 1.5, weighted by
    their likelihoods, the unit of the squares being one variance of the residuals times their
    autocorrelation length.  Its uncertainty combines the spread of the five, the width over which
    the sum of squares stays within one unit, and the difference to a curve of second degree
    above the bend over half as far, since neither is that of the cords.  An error of the strain
    moves the bend by the same amount.

    The result is a bend, not a law of a hose: it reveals a hose that was not built as drawn, and is
    less precise than a calibrated wrap angle.

    Examples
    --------
    >>> from reduction.prediction.measured_curve import measured_curve
    >>> stroke = np.linspace(0, 1, 2001)
    >>> bent = 900 * stroke + 3000 * np.maximum(stroke - 0.4137, 0)
    >>> print(round(measured_pick_up(measured_curve(stroke, bent, loading="static")).strain, 4))
    0.4137
    """
    curve = measured.tension_of(measured.judged)
    place: Integers = np.flatnonzero(np.isfinite(curve))
    if place.size < 4 * _MARGIN:
        return _nothing(f"{place.size} strains of the measured curve are too few to show a bend")
    place = _window(measured, place)
    fit = _bend(measured, place, _ORDER)
    if not (fit.jump > 0 and fit.jump > _LEAST_RATIO * fit.jump_uncertainty):
        return _nothing("the measured curve has no upward bend beyond its scatter")
    rise = float(np.ptp(curve[place]) / np.ptp(measured.strain[place]))
    if fit.jump < _LEAST_SHARE * rise:
        return _nothing("the measured curve bends upward by less than a tenth of its slope")
    if not fit.is_inside:
        return _nothing("the measured curve bends too near its ends")
    strain = measured.strain[place]
    near = place[strain < (fit.strain + strain[-1]) / 2]
    of_model = _bend(measured, near, _ORDER - 1).strain - fit.strain
    at, spread = _mean_of([fit, *(_bend(measured, place, _ORDER, toe) for toe in _TOES[1:])])
    return PickUp(
        strain=at,
        standard_uncertainty=float(
            np.linalg.norm(
                [
                    fit.uncertainty,
                    of_model,
                    spread,
                    *(np.interp(at, measured.strain, row) for row in measured.strain_error),
                ]
            )
        ),
        reason="",
    )


def _mean_of(fits: list[_Fit]) -> tuple[float, float]:
    """Mean place of the bend and its standard deviation over the fits, by their likelihoods."""
    fits = [one for one in fits if one.is_inside]
    best = min(fits, key=lambda one: one.squares)
    weight = np.exp([(best.squares - one.squares) / (2 * best.unit) for one in fits])
    place = np.array([one.strain for one in fits])
    mean = float(np.average(place, weights=weight))
    return mean, float(np.sqrt(np.average((place - mean) ** 2, weights=weight)))


def _nothing(reason: str) -> PickUp:
    return PickUp(float("nan"), float("nan"), reason)


def _window(measured: MeasuredCurve, place: Integers) -> Integers:
    """Initial range of strains in which a bend stands out most."""
    best, kept = -np.inf, place
    for end in _ENDS:
        part = place[: int(end * place.size)]
        if part.size < 4 * _MARGIN:
            break
        axis = measured.strain
        tried = axis[part[_MARGIN:-_MARGIN]]
        found = _fitted(measured, part, tried, _ORDER, axis)
        k = int(np.argmin(found.squares))
        freedom = max(part.size - 2 * _ORDER - 2, 1)
        ratio = found.jump[k] / np.sqrt(found.variance[k] * max(found.squares[k] / freedom, 1e-12))
        if ratio > best and 0 < k < tried.size - 1:
            best, kept = ratio, part
    return kept


def _bend(measured: MeasuredCurve, place: Integers, degree: int, toe: float = 1.0) -> _Fit:
    strain, node = measured.strain[place], measured.reading.node
    step = float(measured.strain[1] - measured.strain[0])
    low, high = float(strain[_MARGIN]), float(strain[-1 - _MARGIN])

    def squares_at(tried: Floats, axis: Floats) -> Floats:
        return _fitted(measured, place, tried, degree, axis, toe).squares

    tried = strain[_MARGIN:-_MARGIN]
    at = float(tried[np.argmin(squares_at(tried, measured.strain))])
    width = 2 * step
    for _ in range(2):
        tried = np.linspace(max(low, at - width), min(high, at + width), _CANDIDATES)
        at, width = float(tried[np.argmin(squares_at(tried, node))]), 2 * width / _CANDIDATES
    fit = _Fitted(*(one[0] for one in _fitted(measured, place, np.array([at]), degree, node, toe)))
    freedom = max(place.size - _ORDER - 2 - degree, 1)
    unit = max(float(fit.squares) / freedom, 1e-12) * autocorrelation_length(fit.residual)
    around = np.linspace(max(low, at - 3 * step), min(high, at + 3 * step), _CANDIDATES)
    above = squares_at(around, node) - fit.squares
    inside = around[above <= unit]
    uncertainty = float(np.ptp(inside)) / 2 if inside.size > 1 else 0.0
    if uncertainty < 2 * (around[1] - around[0]):  # narrower than the steps: use the curvature
        near = np.abs(around - at) <= step
        by_square = (around[near] - at) ** 2
        bend = float(by_square @ above[near] / (by_square @ by_square))
        uncertainty = float(np.sqrt(unit / bend)) if bend > 0 else step / np.sqrt(12.0)
    return _Fit(
        strain=at,
        uncertainty=uncertainty,
        jump=float(fit.jump),
        jump_uncertainty=float(np.sqrt(fit.variance * unit)),
        is_inside=low + step < at < high - step,
        squares=float(fit.squares),
        unit=unit,
    )


def _fitted(
    measured: MeasuredCurve,
    place: Integers,
    at: Floats,
    degree: int,
    axis: Floats,
    toe: float = 1.0,
) -> _Fitted:
    """Least squares with the bend at each strain, on the nodes of the reading or at the centres."""
    x, past = axis / axis[-1], np.maximum(axis - at[:, None], 0.0)  # scaled against collinearity
    is_node = axis.size == measured.reading.node.size
    noise = measured.independent_uncertainty()[place]
    noise = np.maximum(noise, np.median(noise) / 10 + _TINY)

    def basis(curves: list[Floats]) -> Floats:
        columns = np.stack(curves, axis=-2)
        read = (measured.reading.of(columns) if is_node else columns)[..., place]
        return np.asarray((read / noise).swapaxes(-1, -2))

    tension = measured.tension_of(measured.judged)[place] / noise
    # the polynomial below is the same for every place of the bend: it is taken out once
    below = np.linalg.qr(basis([x**k for k in range(_ORDER + 1)]))[0]
    share = past / axis[-1]
    first = past if toe == 1 else past * share ** (toe - 1)
    above = basis([first * share**k for k in range(degree)])
    for _ in range(2):  # once leaves rounding that the nearly parallel columns would enlarge
        above = above - below @ (below.T @ above)
    directions, triangle = np.linalg.qr(above)
    left = tension - below @ (below.T @ tension)
    along = left @ directions
    residual = left - (directions @ along[..., None])[..., 0]
    of_jump = np.linalg.pinv(triangle)[:, 0]
    return _Fitted(
        squares=np.sum(residual**2, axis=1),
        residual=residual,
        jump=np.sum(of_jump * along, axis=1),
        variance=np.sum(of_jump**2, axis=1),
    )


EVENTS = ("pick_up", "working", "break")


def event_differences(
    design: HoseDesign,
    measured: MeasuredCurve,
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
) -> tuple[EventDifference, ...]:
    r"""Predicted less measured at each event, in tension and in strain.

    With errors :math:`\delta T` and :math:`\delta\varepsilon` of the predicted event, the error of
    the difference of tension at its strain is :math:`\delta T - D' \delta\varepsilon`, where D' is
    the slope of the measured curve, plus the error of that curve.

    Notes
    -----
    At pick-up the tension is compared, and the strain at which the test had that tension; neither
    is where the cords of the test pick up
    (`reduction.prediction.comparison_error.measured_pick_up`).  The difference of strain at the
    working load is what a designer needs: how much less or more the hose stretches under its safe
    load.  The judged curve is used up to its last sample, which lies beyond the last bin centre.
    Between two strains of the curve the difference is interpolated linearly, since both curves have
    the kink; near the break, where one of them has no prediction, the measured curve is
    interpolated.

    Examples
    --------
    >>> from reduction.prediction.measured_curve import measured_curve
    >>> from reduction.prediction.cord_curve import CordCurve
    >>> from reduction.prediction.hose_tension import predict_hose
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.2, 1201)
    >>> stiffer = measured_curve(stroke, 1.1 * predict_hose(hose, stroke).tension, loading="static")
    >>> pick_up = event_differences(hose, stiffer)[0]
    >>> print(round(pick_up.tension_difference / pick_up.measured_tension, 2))
    -0.09
    """
    found = find_events(design)
    known = propagate_hose(design, np.zeros(1), standard_uncertainty or {})
    curve = measured.tension_of(measured.judged)
    there = np.isfinite(curve)
    x, y = measured.strain[there], curve[there]
    own = np.vstack(
        [
            measured.independent_uncertainty()[None, there],
            measured.contribution_of(measured.judged)[:, there],
            measured.scatter_contribution[:, there],
        ]
    )
    if np.isfinite(measured.end_strain):
        x, y = np.append(x, measured.end_strain), np.append(y, measured.end_tension)
        last = own[:, -1].copy()
        last[0] = measured.end_standard_uncertainty
        own = np.column_stack([own, last])
    test = _Test(x, y, predict_hose(design, x).tension, own)
    pairs = (
        (found.pick_up, known.pick_up),
        (found.working, known.working),
        (found.cord_break, known.cord_break),
    )
    return tuple(
        _compare(name, event, error, test)
        for name, (event, error) in zip(EVENTS, pairs, strict=True)
    )


class _Test(NamedTuple):
    """Judged curve up to its last sample, prediction there, and errors, (n_source, n)."""

    strain: Floats
    tension: Floats
    predicted: Floats
    own: Floats


def _compare(
    name: str, event: HoseEvent, error: EventUncertainty, test_curve: _Test
) -> EventDifference:
    x, y, predicted, own = test_curve
    strain, tension = float(event.strain), float(event.tension)
    reached = _strain_at_tension(x, y, tension)
    slope = np.gradient(y, x) if x.size > 1 else np.full(x.size, np.nan)

    def uncertainty(at: float) -> float:
        of_test = np.array([_at(at, x, row) for row in own])
        of_model = error.tension_contribution - _at(at, x, slope) * error.strain_contribution
        return float(np.sqrt(np.sum(of_test**2) + np.sum(of_model**2)))

    # between two strains the difference is linear where both curves have a kink
    apart = _at(strain, x, predicted - y)
    test = _between(tension - apart, strain, x, y) if np.isfinite(apart) else _at(strain, x, y)
    return EventDifference(
        name=name,
        strain=strain,
        tension=tension,
        measured_tension=test,
        tension_difference=tension - test,
        tension_difference_standard_uncertainty=uncertainty(strain),
        measured_strain=reached,
        strain_difference=strain - reached,
        strain_difference_standard_uncertainty=uncertainty(reached) / _at(reached, x, slope),
    )


def _between(tension: float, strain: float, x: Floats, y: Floats) -> float:
    """A tension limited to those of the two neighbouring strains.

    Without a kink in the test, interpolation would give it the bow of the prediction inverted.
    """
    k = int(np.clip(np.searchsorted(x, strain), 1, max(x.size - 1, 1)))
    return float(np.clip(tension, y[k - 1 : k + 1].min(), y[k - 1 : k + 1].max()))


def _at(strain: float, x: Floats, y: Floats) -> float:
    """Value by linear interpolation; NaN outside the points."""
    if not (x.size and x[0] <= strain <= x[-1]):
        return float("nan")
    return float(np.interp(strain, x, y))


# [1] sec. 3.0: angle, stretch, cycle; then by its eq. 8 the stretch with a cord strain of 9.5 % at
# a third of its break load, and the effect of a degree of angle
_REPORTED = (
    (64.0, 0.79, "115,000th", 1.046, 0.086),
    (68.0, 1.30, "127,000th", 1.461, 0.125),
)

_NEAR = 1.0  # degree of wrap angle


def plausibility_of_working_strain(
    wrap_angle: float, working_strain: float, *, loading: Loading = "static"
) -> str:
    """Compare a stretch at the working load with the two reported hoses.

    Notes
    -----
    [4]_, sec. 3.0 reports a maximum stretch of 79 % at the 115,000th cycle for 64 degrees and 130 %
    at the 127,000th for 68 degrees, "to 1/3rd of its theoretical breaking strength".  These are
    dynamic, of two hoses whose cord curve and section are not printed, and no single cord strain
    gives both (79 % needs 3.3 % in the cord, 130 % needs 5.6 %).  They define a band in which a
    hose of that angle may lie, not a target: a static cord curve with 9.5 % at a third of its break
    load gives 105 and 146 %.  The band extends down by one degree of wrap angle from the reported
    stretch, and up to the stretch of a static curve plus one degree.

    Examples
    --------
    >>> import numpy as np
    >>> note = plausibility_of_working_strain(np.radians(64.0), 1.05)
    >>> print(note.split(":")[0])
    stretch of 105 % at the working load is inside the band of the hose reported at 64 deg
    """
    for name, value in (("wrap_angle", wrap_angle), ("working_strain", working_strain)):
        if not value > 0:
            raise DataError(f"{name} cannot be compared", found=f"{value:g}", needed="above zero")
    for angle, reported, cycle, static, slope in _REPORTED:
        off = degrees(wrap_angle) - angle
        if abs(off) > _NEAR:
            continue
        low, high = (stretch + off * slope for stretch in (reported - slope, static + slope))
        place = "below" if working_strain < low else "above" if working_strain > high else "inside"
        at_angle = "" if abs(off) < 0.05 else f" (moved by {off:+.1f} deg)"
        kind = "static" if loading == "static" else "dynamic"
        return (
            f"stretch of {100 * working_strain:.0f} % at the working load is {place} the band of "
            f"the hose reported at {angle:.0f} deg: {100 * low:.0f} to {100 * high:.0f} %"
            f"{at_angle}, about {100 * reported:.0f} % at its {cycle} cycle (dynamic, where this "
            f"is {kind}); a band of plausibility, not a target"
        )
    return ""


LEAST_PROBABILITY = 0.05
"""Below this probability the stated errors do not explain the shape of a difference."""

_SMALLEST = 1e-3  # four thousand draws do not resolve smaller ones


def _probability_words(probability: float) -> str:
    """A probability in per cent, as far as draws resolve it.

    Examples
    --------
    >>> print(_probability_words(0.0153), "and", _probability_words(4e-137))
    1.5 % and below 0.1 %
    """
    return "below 0.1 %" if probability < _SMALLEST else f"{100 * probability:.2g} %"


def verdict_words(
    validation: _Validation, *, unit: str = "N", factor: float = 1.0, of: str = "tension"
) -> str:
    """Verdict of a comparison, with forces or pressures in the unit of the reader.

    Notes
    -----
    Agreement is judged at every strain separately; where the stated errors give the shape of the
    difference in less than 5 % of all cases ([1]_, sec. 1-5 and 6), the sentence says so.

    Examples
    --------
    A difference of 44.5 N for a reader in pounds-force.

    >>> from reduction.prediction.measured_curve import measured_curve
    >>> from reduction.prediction.measured_curve import constant_errors
    >>> from reduction.prediction.comparison_error import validate_curve
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(
    ...     stroke, 100 * stroke + 50, loading="static",
    ...     shared=constant_errors(tension_offset=10.0),
    ... )
    >>> found = validate_curve(
    ...     100 * pull.strain + 94.5, pull, input_error=np.zeros((0, pull.strain.size))
    ... )
    >>> print(verdict_words(found, unit="lbf", factor=1 / 4.4482216).split(" at")[0])
    differs by +10 lbf
    """
    if not np.isfinite(validation.largest_ratio):
        return "not judged: neither the test nor the prediction has an uncertainty"
    if not validation.agrees:
        difference = factor * validation.ratio_difference
        way = "above" if difference > 0 else "below"
        return (
            f"differs by {round(difference, places_of(difference, 4)):+,.9g} {unit} at"
            f" {100 * validation.largest_ratio_strain:.4g} % strain, {validation.largest_ratio:.1f}"
            " times its standard uncertainty (a correct prediction stays below"
            f" {validation.coverage_factor:.1f}): the prediction is {way} the test"
        )
    size = (
        f"{factor * validation.median_limit:.3g} {unit} or {100 * validation.uncertainty_share:.2g}"
        f" % of the {of} at the median"
    )
    words = f"agrees within U, {size}"
    if validation.chi_square_probability < LEAST_PROBABILITY:
        chance = _probability_words(validation.chi_square_probability)
        words = f"agrees within U point by point, but its shape does not ({chance}); U is {size}"
    return words if validation.is_informative else f"{words}, so wide that agreement means little"


N_DRAWS = 4000
"""Number of draws of all errors for a verdict: 5 % of them are 200."""

_PROBABILITY = 0.95

_RANK = 1e-10  # eigenvalues of a correlation matrix below this share of the greatest are rounding

# The directions left out for their rank still have a little stated noise: of a small difference it
# can be a thousandth. A share of 1 % is a tenth of the difference.
_OUTSIDE = 0.01

_SEED = 21  # arbitrary but fixed, so that answers are repeatable


@dataclass(frozen=True)
class _Errors:
    """Errors at the compared strains: own (n,), shared (n_source, n), inputs (n_draws, n).

    ``numerical`` (n_row, n) also belongs to the prediction: one standard uncertainty per row.
    """

    own: Floats
    shared: Floats
    inputs: Floats
    numerical: Floats

    def of_test(self) -> Floats:
        return np.asarray(np.sqrt(self.own**2 + np.sum(self.shared**2, axis=0)))

    def of_model(self) -> Floats:
        """Root mean square about the nominal hose, so the shift of the mean is included."""
        own = np.sum(self.numerical**2, axis=0)
        if self.inputs.size:
            own = own + np.mean(self.inputs**2, axis=0)
        return np.asarray(np.sqrt(own))

    def covariance(self) -> Floats:
        n_draws = max(self.inputs.shape[0], 1)
        by_inputs = _product(self.inputs.T, self.inputs) / n_draws
        by_shared = _product(self.shared.T, self.shared)
        by_curve = _product(self.numerical.T, self.numerical)
        return np.asarray(by_inputs + by_shared + by_curve + np.diag(self.own**2))

    def draw(self) -> Floats:
        """Possible values of E if the prediction is right, shape (n_draws, n)."""
        n_draws = self.inputs.shape[0] or N_DRAWS
        normal = np.random.default_rng(_SEED).standard_normal
        errors = _product(normal((n_draws, self.shared.shape[0])), self.shared)
        errors += normal((n_draws, self.own.size)) * self.own
        errors += _product(normal((n_draws, self.numerical.shape[0])), self.numerical)
        return np.asarray(errors - self.inputs if self.inputs.size else errors)


def _product(one: Floats, other: Floats) -> Floats:
    """Matrix product with a fixed order of summation: that of a library depends on its threads."""
    return np.asarray(np.einsum("ik,kj->ij", one, other, optimize=False))


class _Judged(NamedTuple):
    ratio: float
    place: int
    factor: float
    chi_square: float
    freedom: int
    probability: float
    outside: float  # share of the squared difference that no stated error can cause


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
    numerical_error: ArrayLike | None = None,
    largest_useful_share: float = 0.3,
) -> _Validation:
    """Test whether prediction and test agree within their uncertainties.

    Notes
    -----
    *Verdict.* With many strains the largest ratio abs(E) / u_val almost always exceeds 2.  It is
    compared with the 95 % quantile of the largest ratio in draws of all errors together, so that a
    right prediction is rejected in 5 % of all cases, whatever the number of strains: 1.96 for fully
    correlated strains, 3.3 for fifty independent ones.  U is that factor times u_val.  Agreement
    within U means that an error of the model cannot be seen; it does not mean that there is none
    ([1]_, sec. 1-5 and 6).

    *Chi square* E' V^-1 E with the full covariance [6]_ detects a wrong shape inside the band, but
    requires correct uncertainties in every direction; it does not make the verdict, which says so
    where the two disagree.  Its probability is the share of the draws that exceed it, since tension
    is not linear in the angle where cords pick up.  Directions in which no stated error can move
    the curve have no inverse and are left out; if the difference lies in one of them, a note says
    so.

    The draws are the same every time.

    No value is assumed for an uncertainty that was not stated: the verdict says which side is
    missing.  ``numerical_error`` (n_row, n_strain) [N] is the error of the prediction because its
    cord curve is known only at its points, where it is not in ``input_error``; where nothing
    else is known, no verdict is given.

    Examples
    --------
    A load cell that may be 10 N off, and a prediction 8 N too low.

    >>> from reduction.prediction.measured_curve import measured_curve
    >>> from reduction.prediction.measured_curve import constant_errors
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(
    ...     stroke, 100 * stroke + 50, loading="static",
    ...     shared=constant_errors(tension_offset=10.0),
    ... )
    >>> found = validate_curve(
    ...     100 * pull.strain + 42, pull, input_error=np.zeros((0, pull.strain.size))
    ... )
    >>> print(found.agrees, found.verdict.split(",")[0], round(found.largest_ratio, 2))
    True agrees within U 0.8
    """
    model, test = as_same_shape(predicted=predicted, measured=measured.tension_of(measured.judged))
    inputs = np.asarray(input_error, dtype=np.float64)
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
        numerical=np.zeros((0, int(there.sum())))
        if numerical_error is None
        else np.asarray(numerical_error, dtype=np.float64)[:, there],
    )
    if not (errors.of_test().any() or inputs[:, there].any()):
        errors = replace(errors, numerical=errors.numerical[:0])
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
    # slack cords give no pressure to which U could be relative
    is_loaded = there & (test > 0) & (model > 0)
    limit, share = (
        float(np.median(one)) if is_loaded.any() else float("nan")
        for one in (factor * total[is_loaded], factor * total[is_loaded] / test[is_loaded])
    )
    agrees = bool(largest <= factor)
    is_informative = bool(share <= largest_useful_share)
    found = _Validation(
        input_standard_uncertainty=of_model,
        measurement_standard_uncertainty=np.where(there, of_test, np.nan),
        validation_uncertainty=total,
        coverage_factor=factor,
        largest_ratio=largest,
        largest_ratio_strain=float(measured.strain[place])
        if np.isfinite(largest)
        else float("nan"),
        chi_square=judged.chi_square,
        chi_square_freedom=judged.freedom,
        chi_square_probability=judged.probability,
        uncertainty_share=share,
        median_limit=limit,
        agrees=agrees,
        is_informative=is_informative,
        verdict="",
        ratio_difference=float(error[place]) if np.isfinite(largest) else float("nan"),
        notes=_notes(inputs, measured, agrees, judged),
    )
    return replace(found, verdict=verdict_words(found))


def _notes(
    inputs: Floats, measured: MeasuredCurve, agrees: bool, judged: _Judged
) -> tuple[Note, ...]:
    notes = []
    if not inputs.any():
        notes.append(note("prediction-counts-as-exact"))
    sources = {one.source for one in measured.component} - FROM_READINGS
    if not sources:
        notes.append(note("test-counts-as-unbiased"))
    elif not any(one.startswith("tension_") for one in sources):
        notes.append(note("load-cell-counts-as-exact"))
    if agrees and judged.probability < LEAST_PROBABILITY:
        notes.append(note("shape-differs", probability=_probability_words(judged.probability)))
    if judged.outside > _OUTSIDE:
        notes.append(note("difference-without-error", effect=judged.outside))
    return tuple(notes)

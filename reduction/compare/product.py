"""What a comparison of a measured hose curve with its prediction takes and gives.

A *comparison error* is predicted less measured, E = S - D in the words of [1]_: positive where
the hose is softer than predicted.

References
----------
.. [1] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer."
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.compare.measuredcurve import CurveName, MeasuredCurve
from reduction.predict.product import HoseDesign, HosePrediction
from reduction.record import Floats, Integers, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class Difference:
    """Comparison error of one curve; ``difference`` has the shape (n_strain,), NaN outside.

    ``relative_rms`` is the RMS of the comparison error over the RMS of the measured tension at
    the same strains; the worst point is that of the greatest absolute difference.
    """

    curve: CurveName
    strain: Floats
    difference: Floats
    n_strain: int
    bias: float
    rms: float
    relative_rms: float
    worst_strain: float
    worst_difference: float


@dataclass(frozen=True)
class EventDifference:
    """Comparison error at what happens to the cords, at the judged curve.

    ``tension_difference`` [N] is that at the predicted strain of the event; ``measured_strain``
    [1] is where the test had the *predicted tension* of the event, and ``strain_difference`` the
    predicted strain less that.  It is no place of the event in the test: another prediction has
    another one; where the cords of the test pick up is `Comparison.measured_pick_up_strain`.
    The standard uncertainties are of the differences, both sides in them.  NaN where the test did
    not go that far.
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
class EnergyDifference:
    """Energies per relaxed length between the same two strains. [J m-1].

    The prediction is elastic and has no loop; ``loop_share`` is the measured loop over the
    measured energy under the ascending branch. [1]
    """

    strain_low: float
    strain_high: float
    measured: float
    predicted: float
    difference: float
    loop: float
    loop_share: float


@dataclass(frozen=True)
@read_only_arrays
class CycleDifference:
    """Comparison error cycle by cycle, at the judged curve of each; shape (n_cycle,). [N].

    ``bias_per_decade`` is the slope of the bias over log10 of the cycle number, over all
    cycles, break-in too, with its standard uncertainty from the scatter about that line; the
    bias is taken at the strains that every cycle in it visited. [N]
    """

    cycle_number: Integers
    bias: Floats
    rms: Floats
    bias_per_decade: float
    bias_per_decade_standard_uncertainty: float


@dataclass(frozen=True)
@read_only_arrays
class Validation:
    """Comparison error against what measurement and prediction are uncertain by.

    Arrays have the shape (n_strain,), NaN where nothing was compared. [N]

    Parameters
    ----------
    input_standard_uncertainty : ndarray
        Of the prediction, from the numbers that went into it. [N]
    measurement_standard_uncertainty : ndarray
        Of the measured curve, calibration and type A. [N]
    standard_uncertainty : ndarray
        u_val, both together. [N]
    coverage_factor : float
        What the largest abs(E) / u_val of the whole curve stays below in 95 % of all cases in
        which the prediction is right. [1]
    ratio : float
        Largest abs(E) / u_val. [1]
    ratio_strain : float
        Where it is. [1]
    chi_square, chi_square_freedom, chi_square_probability : float
        E' V^-1 E, the rank of V, and how often a right prediction exceeds it. [1]
    share : float
        Median of U = coverage factor times u_val over the measured tension. [1]
    agrees, is_informative : bool
        Whether the ratio is inside; whether U is small enough for that to mean anything.
    verdict : str
        In words, with newtons; `reduction.compare.verdict.verdict_words` has other units.
    ratio_difference : float
        Comparison error, signed, where the ratio is largest. [N]
    """

    input_standard_uncertainty: Floats
    measurement_standard_uncertainty: Floats
    standard_uncertainty: Floats
    coverage_factor: float
    ratio: float
    ratio_strain: float
    chi_square: float
    chi_square_freedom: int
    chi_square_probability: float
    share: float
    agrees: bool
    is_informative: bool
    verdict: str
    ratio_difference: float = float("nan")
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class Identifiability:
    """Whether the curve can tell the fitted numbers apart.

    Parameters
    ----------
    least_change : float
        RMS change of the curve over its own RMS along the direction that it sees least, for a
        step of one plausible error; what shared errors can imitate taken off. [1]
    needed_change : float
        Below this it cannot be told from an error of the model. [1]
    direction : ndarray, shape (n_parameter,)
        That direction, in units of each number. [SI]
    collinearity : float
        1 over the least singular value of the sensitivities scaled to unit length. [1]
    is_identified : bool
        Whether the least change is the greater one.
    words : str
        Which numbers trade against which; empty where they are told apart.
    open_covariance : ndarray, shape (n_parameter, n_parameter)
        What an error of the model that the curve cannot show may move the numbers by, along the
        directions that are not seen; zero where all are. [SI]
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
class Calibration:
    """Numbers of a hose fitted to a measured curve; arrays have the shape (n_parameter,).

    Parameters
    ----------
    parameter : tuple of str
        Names, of `reduction.predict.product.HOSE_PARAMETERS`.
    start, value : ndarray
        Before and after, in the unit of each. [SI]
    standard_uncertainty, low, high : ndarray
        Of the value, and its 95 % interval (not cut at the bounds); NaN where it would be wider on
        either side than all that was allowed. [SI]
    lower_bound, upper_bound : ndarray
        What the fit was kept between. [SI]
    is_at_bound : ndarray of bool
        Where it was stopped.
    correlation : ndarray, shape (n_parameter, n_parameter)
        Of the fitted values. [1]
    design : HoseDesign
        The hose with the fitted values.
    before, after : Difference
        Judged curve against the prediction, start and fitted.
    model_error : float
        Standard deviation that has to be added to type A for the residuals to be explained. [N]
    effective_points : float
        Strains over the autocorrelation length of the residuals. [1]
    shared_error : tuple of str
        Errors that were fitted beside the numbers, each within its standard uncertainty.
    shared_error_value : ndarray, shape (n_shared,)
        What was found for them, in units of it. [1]
    """

    parameter: tuple[str, ...]
    start: Floats
    value: Floats
    standard_uncertainty: Floats
    low: Floats
    high: Floats
    lower_bound: Floats
    upper_bound: Floats
    is_at_bound: np.ndarray
    correlation: Floats
    identifiability: Identifiability
    design: HoseDesign
    before: Difference
    after: Difference
    model_error: float
    effective_points: float
    shared_error: tuple[str, ...]
    shared_error_value: Floats
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Comparison:
    """A measured curve beside its prediction on the same axis of strain.

    ``differences`` has one entry a curve that was measured, by name; ``judged`` is the one
    that events, validation and calibration are of.  ``measured_pick_up_strain`` [1] is where that
    curve bends upward by itself, with its standard uncertainty; NaN where it does not show it, and
    a note says why.
    """

    measured: MeasuredCurve
    prediction: HosePrediction
    judged: CurveName
    differences: dict[CurveName, Difference]
    events: tuple[EventDifference, ...]
    energy: EnergyDifference
    cycles: CycleDifference
    validation: Validation
    calibration: Calibration | None
    notes: tuple[str, ...]
    measured_pick_up_strain: float = float("nan")
    measured_pick_up_strain_standard_uncertainty: float = float("nan")

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
from typing import Literal

import numpy as np

from reduction.errors import DataError
from reduction.predict.product import HoseDesign, HosePrediction
from reduction.record import Floats, Integers, freeze_arrays

__all__ = [
    "BRANCHES",
    "NODES_A_BIN",
    "Calibration",
    "Comparison",
    "CurveName",
    "CycleDifference",
    "Difference",
    "EnergyDifference",
    "EventDifference",
    "Identifiability",
    "Loading",
    "MeasuredCurve",
    "Reading",
    "Validation",
]

Loading = Literal["static", "dynamic"]
CurveName = Literal["ascending", "descending", "midline"]
BRANCHES: tuple[CurveName, CurveName] = ("ascending", "descending")
NODES_A_BIN = 40
"""Steps of the strains between two bin centres at which a prediction is read."""


@dataclass(frozen=True)
class Reading:
    """How a test shows a curve: weights of the strains between the bin centres.

    Samples lie at some strains of a bin and the mean is moved to its centre; at a kink that is
    not the tension at the centre.  A prediction that is read in the same way has the same kink.

    Parameters
    ----------
    node : ndarray, shape (n_node,)
        Equally spaced strains, `NODES_A_BIN` a bin, from one bin below the first bin. [1]
    weight : ndarray, shape (n_strain, 3 * NODES_A_BIN + 1)
        Of the nodes from the bin below each bin to the bin above it; zero where the judged curve
        is not known. [1]
    """

    node: Floats
    weight: Floats

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)

    def of(self, curve: Floats) -> Floats:
        """A curve at the nodes, shape (..., n_node), as the test shows it, (..., n_strain)."""
        windows = np.lib.stride_tricks.sliding_window_view(curve, self.weight.shape[1], axis=-1)
        return np.asarray(np.einsum("...bm,bm->...b", windows[..., ::NODES_A_BIN, :], self.weight))


@dataclass(frozen=True)
class MeasuredCurve:
    """Tension of a test on one axis of strain, cycle by cycle and over the cycles.

    NaN stands where a branch was not visited.  The *judged* curve is the midline of the two
    branches, or the ascending branch of a test that has no other.

    Parameters
    ----------
    strain : ndarray, shape (n_strain,)
        Bin centres, equally spaced, of the whole relaxed length. [1]
    tension : ndarray, shape (n_cycle, 2, n_strain)
        Of each cycle, ascending before descending, at the bin centre. [N]
    count : ndarray of int, shape (n_cycle, 2, n_strain)
        Samples in the bin. [1]
    cycle_number : ndarray of int, shape (n_cycle,)
        First cycle of each row; a row is one cycle unless ``cycles_pooled`` is above 1.
    branch_tension, branch_standard_uncertainty : ndarray, shape (2, n_strain)
        Mean over the cycles after break-in, and its standard uncertainty, type A alone. [N]
    midline_tension, midline_standard_uncertainty : ndarray, shape (n_strain,)
        Half way between the branches, and its standard uncertainty, type A alone. [N]
    scatter_contribution : ndarray, shape (n_component, n_strain)
        What the type A standard uncertainty of the judged curve has in common over strain, as
        signed contributions: cycles lie high or low as a whole. [N]
    source : tuple of str, length n_source
        Names of the errors that all cycles share.
    contribution : ndarray, shape (n_source, n_strain)
        Of each, to the judged curve, one standard uncertainty, signed. [N]
    loading : {"static", "dynamic"}
        How it was pulled.
    reading : Reading
        How the judged curve was read from the samples.
    strain_offset_uncertainty, strain_scale_uncertainty : float
        Standard uncertainties of which ``contribution`` is the change of tension in proportion. [1]
    end_strain, end_tension, end_standard_uncertainty : float
        Where the judged curve ends beyond its last bin centre: mean of the samples between, and
        its type A; NaN where there are none. [1], [N], [N]
    cycles_pooled : int
        Consecutive cycles in a row of ``tension``.
    notes : tuple of str
        What a reader has to know.
    """

    strain: Floats
    tension: Floats
    count: Integers
    cycle_number: Integers
    branch_tension: Floats
    branch_standard_uncertainty: Floats
    midline_tension: Floats
    midline_standard_uncertainty: Floats
    scatter_contribution: Floats
    source: tuple[str, ...]
    contribution: Floats
    loading: Loading
    reading: Reading
    strain_offset_uncertainty: float = 0.0
    strain_scale_uncertainty: float = 0.0
    end_strain: float = float("nan")
    end_tension: float = float("nan")
    end_standard_uncertainty: float = float("nan")
    cycles_pooled: int = 1
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check shapes once and make the arrays read-only."""
        freeze_arrays(self)
        n_strain, n_cycle = self.strain.size, self.cycle_number.size
        shapes = {
            "tension": (n_cycle, 2, n_strain),
            "count": (n_cycle, 2, n_strain),
            "branch_tension": (2, n_strain),
            "branch_standard_uncertainty": (2, n_strain),
            "midline_tension": (n_strain,),
            "midline_standard_uncertainty": (n_strain,),
            "scatter_contribution": (self.scatter_contribution.shape[0], n_strain),
            "contribution": (len(self.source), n_strain),
        }
        for name, shape in shapes.items():
            found = getattr(self, name).shape
            if found != shape:
                raise DataError(
                    f"{name} does not fit the measured curve", found=str(found), needed=str(shape)
                )

    @property
    def judged(self) -> CurveName:
        """The curve that the prediction is judged by."""
        return "midline" if np.isfinite(self.midline_tension).any() else "ascending"

    def tension_of(self, curve: CurveName) -> Floats:
        """Mean over the cycles, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_tension
        return np.asarray(self.branch_tension[BRANCHES.index(curve)])

    def standard_uncertainty_of(self, curve: CurveName) -> Floats:
        """Of that mean, type A alone, shape (n_strain,). [N]."""
        if curve == "midline":
            return self.midline_standard_uncertainty
        return np.asarray(self.branch_standard_uncertainty[BRANCHES.index(curve)])

    def curves(self) -> tuple[CurveName, ...]:
        """Curves that were measured anywhere."""
        names: tuple[CurveName, ...] = (*BRANCHES, "midline")
        return tuple(name for name in names if np.isfinite(self.tension_of(name)).any())

    def independent_uncertainty(self) -> Floats:
        """Type A of the judged curve that no two strains share, shape (n_strain,). [N]."""
        whole = self.standard_uncertainty_of(self.judged) ** 2
        common = np.sum(self.scatter_contribution**2, axis=0)
        return np.asarray(np.sqrt(np.maximum(whole - common, 0.0)))


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


@dataclass(frozen=True)
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

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


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

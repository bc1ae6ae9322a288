"""What the modulus stage returns.

Tension stands beside every modulus, because a modulus alone leaves tension unknown by a
constant.  Axis order is (specimen, ..., branch, bin); branch 0 ascends, branch 1 descends.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays
from reduction.record.notes import Note


@dataclass(frozen=True)
@read_only_arrays
class ModulusCurves:
    """Tangent modulus against strain.

    Parameters
    ----------
    strain_bin : ndarray, shape (n_bins,)
        Bin centres, one grid for all specimens of the test. [1]
    strain_bin_bounds : ndarray, shape (n_bins, 2)
        Edges. [1]
    window : float
        Width of the widest regression window. [1]
    tangent_modulus, tangent_modulus_standard_uncertainty : ndarray, shape (n_specimens, 2, n_bins)
        Mean over the cycles, trimmed branches; NaN where there is no support. [Pa]
    tangent_modulus_count : ndarray of int, same shape
        Cycles in the mean. [1]
    tangent_modulus_minimum, tangent_modulus_maximum : ndarray, same shape
        Least and greatest over the cycles: the envelope. [Pa]
    tangent_modulus_scatter : ndarray, same shape
        Standard deviation over the cycles. [Pa]
    tangent_modulus_untrimmed, tangent_modulus_untrimmed_standard_uncertainty : ndarray, same shape
        The same with the branch ends included. [Pa]
    branch_tension, branch_tension_standard_uncertainty : ndarray, same shape
        Mean tension of the branch at each bin centre. [N]
    branch_tension_count : ndarray of int, same shape, or None
        Cycles in the means with the ends; None for a single rise. [1]
    selected_cycle : ndarray of int, shape (n_selected,)
        Numbers of the cycles whose curves are kept.
    tangent_modulus_by_cycle, tangent_modulus_by_cycle_standard_uncertainty : ndarray
        Shape (n_specimens, n_selected, 2, n_bins). [Pa]
    alignment_strain : ndarray, shape (n_specimens,), or None
        Mean strain to which the cycles were aligned before averaging; NaN for a specimen
        whose cycles were not moved, None for a single rise. [1]
    made : tuple of str
        How they were made, with numbers given nowhere else: lines of the history.
    tangent_modulus_window_uncertainty : ndarray, shape (n_specimens, 2, n_bins), or None
        Standard uncertainty of the modulus from blurring by the window; None for a single rise.
        [Pa]
    """

    strain_bin: Floats
    strain_bin_bounds: Floats
    window: float
    tangent_modulus: Floats
    tangent_modulus_standard_uncertainty: Floats
    tangent_modulus_count: Integers
    tangent_modulus_minimum: Floats
    tangent_modulus_maximum: Floats
    tangent_modulus_scatter: Floats
    tangent_modulus_untrimmed: Floats
    tangent_modulus_untrimmed_standard_uncertainty: Floats
    branch_tension: Floats
    branch_tension_standard_uncertainty: Floats
    selected_cycle: Integers
    tangent_modulus_by_cycle: Floats
    tangent_modulus_by_cycle_standard_uncertainty: Floats
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()
    branch_tension_count: Integers | None = None
    tangent_modulus_window_uncertainty: Floats | None = None
    alignment_strain: Floats | None = None


@dataclass(frozen=True)
@read_only_arrays
class Segments:
    """Piecewise-linear moduli, the form of Tables 5 and 6 of WHOI-2005-10.

    Every array has shape (n_specimens, 2, n_segments), NaN where a branch has
    fewer segments.  Tensions at both ends are those of the mean branch, and the modulus is its
    chord.  ``segment_misfit`` is the rms distance of the branch from the chord [N];
    ``criterion`` says how the number of segments was chosen.
    """

    segment_modulus: Floats
    segment_modulus_standard_uncertainty: Floats
    segment_strain_low: Floats
    segment_strain_high: Floats
    segment_tension_low: Floats
    segment_tension_low_standard_uncertainty: Floats
    segment_tension_high: Floats
    segment_tension_high_standard_uncertainty: Floats
    segment_misfit: Floats
    criterion: str


@dataclass(frozen=True)
@read_only_arrays
class EndModuli:
    """Moduli from the ends of the branches, each with its standard uncertainty (noise). [Pa].

    ``secant_modulus`` is stress over strain at the peak of a cycle, shape (n_specimens,
    n_cycles); ``chord_modulus`` is the slope from end to end of a branch, shape
    (n_specimens, n_cycles, 2).
    """

    secant_modulus: Floats
    secant_modulus_standard_uncertainty: Floats
    chord_modulus: Floats
    chord_modulus_standard_uncertainty: Floats


@dataclass(frozen=True)
@read_only_arrays
class CycleIdentity:
    """Closed-cycle identity, checked on every cycle; arrays have shape (n_specimens, n_cycles).

    ``mean_identity_residual`` is the mean over the cycles, shape (n_specimens,), with its
    standard error from their scatter; ``notes`` say where it exceeds noise.

    Stroke-mean modulus ascending minus descending equals minus the tension lost over
    the cycle, divided by area and strain stroke: what is lost was given back on the way down
    and not taken up again.
    """

    stroke_mean_modulus_difference: Floats
    tension_loss_modulus: Floats
    identity_residual: Floats
    mean_identity_residual: Floats
    mean_identity_residual_standard_uncertainty: Floats
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class AmplitudeSummary:
    """Dynamic quantities of a test at its frequency, means and amplitudes.

    One value per specimen, shape (n_specimens,): the mean over the cycles after break-in,
    each with its standard uncertainty in ``uncertainty``.
    """

    frequency: Floats
    mean_strain: Floats
    strain_amplitude: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    apparent_spring_constant: Floats
    dynamic_modulus: Floats
    hysteresis_energy: Floats
    storage_spring_constant: Floats
    loss_spring_constant: Floats
    loss_factor: Floats
    slope_reading_spread: Floats
    closed_loop_energy: Floats
    uncertainty: dict[str, Floats]


@dataclass(frozen=True)
@read_only_arrays
class PeakTrend:
    """Peak tension, modulus and strain against log10 of cycle number, shape (n_specimens,).

    ``peak_tension_per_decade`` [N], ``dynamic_modulus_per_decade`` [Pa] and
    ``mean_strain_per_decade`` [1] are slopes; ``peak_tension_change`` [1] is the
    mean of the last tenth of the cycles over that of the first, minus 1, and
    ``mean_strain_drift`` [1] the mean strain of the last tenth less that of the first.
    """

    peak_tension_per_decade: Floats
    peak_tension_per_decade_standard_uncertainty: Floats
    dynamic_modulus_per_decade: Floats
    dynamic_modulus_per_decade_standard_uncertainty: Floats
    peak_tension_change: Floats
    peak_tension_change_standard_uncertainty: Floats
    mean_strain_per_decade: Floats
    mean_strain_per_decade_standard_uncertainty: Floats
    mean_strain_drift: Floats
    mean_strain_drift_standard_uncertainty: Floats


@dataclass(frozen=True)
@read_only_arrays
class Slips:
    """Steps of peak tension that steady creep does not explain, one row per step.

    Parameters
    ----------
    specimen : tuple of str, length n_slips
        Which specimen stepped.
    slip_cycle : ndarray of int, shape (n_slips,)
        First cycle after the step.
    slip_cycle_low, slip_cycle_high : ndarray of int, shape (n_slips,)
        Range of cycles in which the step lies.
    slip_tension_step, slip_tension_step_standard_uncertainty : ndarray, shape (n_slips,)
        Step of peak tension, negative for a loss. [N]
    slip_length, slip_length_standard_uncertainty : ndarray, shape (n_slips,)
        Splice length let out, from the step and the slope of tension on position. [m]
    creep_per_cycle : ndarray, shape (n_specimens,)
        Steady drift of peak tension in the last half of the test, with steps removed. [N]
    made : tuple of str
        Why slips were not looked for: a line of the history.
    """

    specimen: tuple[str, ...]
    slip_cycle: Integers
    slip_cycle_low: Integers
    slip_cycle_high: Integers
    slip_tension_step: Floats
    slip_tension_step_standard_uncertainty: Floats
    slip_length: Floats
    slip_length_standard_uncertainty: Floats
    creep_per_cycle: Floats
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class Ratio:
    """Ratio of the moduli of two specimens (or two tests) on one strain axis.

    Arrays have shape (2, n_bins); the interval has 95 % coverage, from the ``degrees_of_freedom``
    of the standard uncertainty.
    """

    numerator: str
    denominator: str
    strain_bin: Floats
    ratio: Floats
    ratio_standard_uncertainty: Floats
    ratio_low: Floats
    ratio_high: Floats
    is_different: Bools
    notes: tuple[Note, ...] = ()
    degrees_of_freedom: Floats = field(default_factory=lambda: np.array(np.inf))


@dataclass(frozen=True)
class ElastomerFit:
    """A hyperelastic law fitted to a first loading.

    Parameters
    ----------
    specimen, law : str
        ``neo-hookean``, ``mooney-rivlin``, ``yeoh`` or ``ogden-2``.
    parameters, standard_uncertainty : dict of str to float
        Pa for moduli, 1 for exponents.
    rms_stress : float
        Root mean square residual. [Pa]
    strain_low, strain_high : float
        Range of the fit; the law says nothing outside. [1]
    is_stable : bool
        True where d(stress)/d(strain) stays positive over the fitted range and in
        equibiaxial and pure-shear deformation of the same range.
    aicc : float
        Corrected Akaike criterion, lower is better. [1]
    """

    specimen: str
    law: str
    parameters: dict[str, float]
    standard_uncertainty: dict[str, float]
    rms_stress: float
    strain_low: float
    strain_high: float
    is_stable: bool
    aicc: float
    notes: tuple[Note, ...] = field(default=())

r"""Stiffness between two held tensions against the logarithm of time, and creep of a hold.

.. math:: K_s(t) = \frac{T_h(t) - T_l}{\varepsilon_h(t) - \varepsilon_l}
          = K_{ref} + b \log_{10}(t / t_{ref})

A rope that is held creeps, so the secant between two levels falls with the time for which
the upper one has been held; a straight line in the logarithm of time is the usual summary.

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length
   Properties of Fibre Rope," OIPEEC (abstract: static stiffness beside dynamic stiffness
   and polymer strain).
.. [2] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 1
   (lines in the logarithm of time).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.checks import as_positive, as_same_shape
from reduction.errors import DataError, FitError, SettingsError
from reduction.holds.blocks import logarithmic_blocks
from reduction.holds.product import HoldResult
from reduction.holds.relaxation import RAMP_TIMES_LEFT_OUT
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Bools, Floats, read_only_arrays
from reduction.samples.blocks import finite_extremes, sample_blocks
from reduction.samples.columns import chosen
from reduction.samples.scratch import empty_like

_FEWEST_POINTS = 4
_SHORTEST_SPAN = 0.5


@dataclass(frozen=True)
@read_only_arrays
class StaticStiffness:
    """Secant between two held tensions against time.

    Parameters
    ----------
    elapsed, stiffness : ndarray, shape (n_points,)
        Time since the load was put on, and the secant then. [s], [N]
    reference_time : float
        Time at which ``stiffness_at_reference`` stands. [s]
    stiffness_at_reference, stiffness_at_reference_standard_uncertainty : float
        By the fit. [N]
    slope_per_decade, slope_per_decade_standard_uncertainty : float
        Change of the stiffness in a tenfold time. [N]
    slope_low, slope_high : float
        Interval of the slope. [N]
    stiffness_over_strength, slope_per_decade_over_strength : float
        Over the rated break strength. [1]
    confidence : float
        Of the interval. [1]
    notes : tuple of str
        A reference time that the hold does not reach.
    """

    elapsed: Floats
    stiffness: Floats
    reference_time: float
    stiffness_at_reference: float
    stiffness_at_reference_standard_uncertainty: float
    slope_per_decade: float
    slope_per_decade_standard_uncertainty: float
    slope_low: float
    slope_high: float
    stiffness_over_strength: float
    slope_per_decade_over_strength: float
    confidence: float
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class CreepOfHold:
    """Creep of one hold; NaN with a reason where the hold does not support it.

    Parameters
    ----------
    specimen : str
        Which specimen.
    creep_per_decade, creep_per_decade_standard_uncertainty : float
        Strain gained in a tenfold time. [1]
    tension, tension_over_strength : float
        Held tension, and over the rated break strength. [N], [1]
    creep_compliance_per_decade : float
        Strain a decade over tension as a share of the strength: what is alike in ropes of
        one construction and many sizes. [1]
    duration : float
        Of the hold. [s]
    reason : str
        Why there is no number; empty where there is.
    tension_standard_uncertainty : float
        Of the means at both ends of the hold (type A). [N]
    """

    specimen: str
    creep_per_decade: float
    creep_per_decade_standard_uncertainty: float
    tension: float
    tension_over_strength: float
    creep_compliance_per_decade: float
    duration: float
    reason: str = ""
    tension_standard_uncertainty: float = float("nan")


def static_stiffness(
    elapsed: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    *,
    low_tension: float,
    low_strain: float,
    reference_time: float,
    ramp_duration: float = 0.0,
    rated_break_strength: float = float("nan"),
    confidence: float = 0.95,
) -> StaticStiffness:
    r"""Secant stiffness from the end of a lower hold into an upper hold, against log time.

    .. math:: K_s(t) = K_{ref} + b \log_{10}(t / t_{ref})

    Parameters
    ----------
    elapsed : array_like, shape (n_samples,)
        Time since the centre of the ramp to the upper hold, rising and positive. [s]
    tension, strain : array_like, shape (n_samples,)
        Of the upper hold, as samples or as values at stated times; NaN is left out. [N], [1]
    low_tension : float
        At the end of the lower hold. [N]
    low_strain : float
        At the end of the lower hold. [1]
    reference_time : float
        Time at which the stiffness is wanted. [s]
    ramp_duration : float, optional
        Duration of the ramp; the first three of them are left out. [s]
    rated_break_strength : float, optional
        NaN where not stated. [N]
    confidence : float, optional
        Of the interval of the slope. [1]

    Returns
    -------
    stiffness : StaticStiffness
        Line in the logarithm of time with its uncertainty (type A).

    Raises
    ------
    DataError
        If the series do not pair up, time does not rise from above zero, or the upper hold
        is not above the lower one in tension and strain.
    FitError
        If fewer than four points, or less than half a decade of time, are left.
    SettingsError
        If the confidence is not between 0 and 1, or the reference time is not positive.

    Notes
    -----
    Samples become means over equal steps of the logarithm of time first, so that the last
    decade does not decide alone; their scatter about the line is widened by their likeness.
    Levels and times are the laboratory's: [1]_ was read in its abstract only, and no standard.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> strain = 0.05 + 200 / (4000 - 100 * np.log10(t))
    >>> found = static_stiffness(t, np.full(1000, 300.0), strain,
    ...     low_tension=100.0, low_strain=0.05, reference_time=100.0)
    >>> print(round(found.stiffness_at_reference), round(found.slope_per_decade))
    3800 -100
    """
    if not 0 < confidence < 1:
        raise SettingsError("a confidence is a share", found=f"{confidence:g}", needed="0 to 1")
    if not reference_time > 0:
        raise SettingsError(
            "the reference time is not positive", found=f"{reference_time:g} s", needed="above 0 s"
        )
    clock, load, stretch = as_same_shape(elapsed=elapsed, tension=tension, strain=strain)
    series, shortest = (clock, load, stretch), RAMP_TIMES_LEFT_OUT * ramp_duration

    def is_kept(part: slice) -> Bools:
        clock, load, stretch = (one[part] for one in series)
        known = np.isfinite(clock) & np.isfinite(load) & np.isfinite(stretch)
        return known & ~(clock < shortest)

    clock, load, stretch = chosen(is_kept, *series)
    if clock.size < _FEWEST_POINTS:
        raise FitError(
            "the upper hold is too short for a line in the logarithm of time",
            found=f"{clock.size} readings after {RAMP_TIMES_LEFT_OUT:g} ramp times",
            needed=f"{_FEWEST_POINTS} or more",
        )
    rise, gain = finite_extremes(load)[0] - low_tension, finite_extremes(stretch)[0] - low_strain
    if not (rise > 0 and gain > 0):
        raise DataError(
            "the upper hold is not above the lower one",
            found=f"least rise {rise:.4g} N of tension and {gain:.4g} of strain",
            needed="both above zero",
        )
    stiffness = empty_like(load)
    for part in sample_blocks(load.size, load, stretch, stiffness):
        stiffness[part] = (load[part] - low_tension) / (stretch[part] - low_strain)
    blocks = logarithmic_blocks(clock, stiffness)
    x, y = np.log10(blocks.elapsed / reference_time), blocks.value
    if x.size < _FEWEST_POINTS or x[-1] - x[0] < _SHORTEST_SPAN:
        raise FitError(
            "the upper hold is too short for a line in the logarithm of time",
            found=f"{x.size} points over {x[-1] - x[0]:.2f} decades",
            needed=f"{_FEWEST_POINTS} points over {_SHORTEST_SPAN:g} decades",
        )
    share = blocks.weight / blocks.weight.sum()
    centre, level = float((share * x).sum()), float((share * y).sum())
    power = float((share * (x - centre) ** 2).sum())
    slope = float((share * (x - centre) * (y - level)).sum()) / power
    residual = np.sqrt(share) * (y - level - slope * (x - centre))
    variance = float((residual**2).sum()) / (x.size - 2) * lag_one_inflation(residual)
    u_slope = float(np.sqrt(variance / power))
    width = float(stdtrit(x.size - 2, (1 + confidence) / 2)) * u_slope
    reaches = clock[0] <= reference_time <= clock[-1]
    return StaticStiffness(
        elapsed=blocks.elapsed,
        stiffness=y,
        reference_time=reference_time,
        stiffness_at_reference=level - slope * centre,
        stiffness_at_reference_standard_uncertainty=float(
            np.sqrt(variance * (1 + centre**2 / power))
        ),
        slope_per_decade=slope,
        slope_per_decade_standard_uncertainty=u_slope,
        slope_low=slope - width,
        slope_high=slope + width,
        stiffness_over_strength=(level - slope * centre) / rated_break_strength,
        slope_per_decade_over_strength=slope / rated_break_strength,
        confidence=confidence,
        notes=()
        if reaches
        else (
            f"the stiffness at {reference_time:g} s is read off the line beyond the hold, which "
            f"has readings from {clock[0]:.3g} to {clock[-1]:.3g} s",
        ),
    )


def creep_of_hold(hold: HoldResult, *, rated_break_strength: float = float("nan")) -> CreepOfHold:
    """Creep per decade of one hold at constant tension, with the tension as a share.

    Parameters
    ----------
    hold : HoldResult
        Of kind ``creep``, from `reduction.holds.reduce`.
    rated_break_strength : float, optional
        NaN where not stated. [N]

    Returns
    -------
    creep : CreepOfHold
        Rate, or NaN with the hold's own reason.

    Raises
    ------
    DataError
        If the hold is one of relaxation, or the strength is not positive.

    Notes
    -----
    The rate is that of [2]_, a straight line in the logarithm of time.

    Examples
    --------
    >>> nan, none = float("nan"), np.empty(0)
    >>> hold = HoldResult("new", "creep", 0.0, 3600.0, 0.1, 3000.0, 3000.0, nan, nan, 0.002, 1e-5,
    ...     none, none, none, none, none, none, none, nan, nan)
    >>> print(round(creep_of_hold(hold, rated_break_strength=1e4).creep_compliance_per_decade, 5))
    0.00667
    """
    if hold.kind != "creep":
        raise DataError(
            f"a hold of {hold.specimen} is no creep", found=hold.kind, needed="a constant tension"
        )
    if not np.isnan(rated_break_strength):
        as_positive("rated break strength", rated_break_strength)
    tension = (hold.hold_initial_tension + hold.hold_final_tension) / 2
    share = tension / rated_break_strength
    of_ends = (
        hold.hold_initial_tension_standard_uncertainty,
        hold.hold_final_tension_standard_uncertainty,
    )
    return CreepOfHold(
        specimen=hold.specimen,
        creep_per_decade=hold.rate_per_decade,
        creep_per_decade_standard_uncertainty=hold.rate_per_decade_standard_uncertainty,
        tension=tension,
        tension_over_strength=share,
        creep_compliance_per_decade=hold.rate_per_decade / share if share else float("nan"),
        duration=hold.hold_duration,
        tension_standard_uncertainty=float(np.hypot(*of_ends)) / 2,
        reason="; ".join(hold.refusals) if np.isnan(hold.rate_per_decade) else "",
    )

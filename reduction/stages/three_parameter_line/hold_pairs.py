r"""Pairs of holds of a quasi-static programme.

**Stiffness between two held tensions against the logarithm of time, and creep of a hold**:

.. math:: K_s(t) = \frac{T_h(t) - T_l}{\varepsilon_h(t) - \varepsilon_l}
          = K_{ref} + b \log_{10}(t / t_{ref})

A rope under load creeps, so the secant between two levels falls with the time for which
the upper one has been held; a straight line in the logarithm of time is the usual summary.

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length Properties
   of Fibre Rope," OIPEEC (abstract: static stiffness beside dynamic stiffness and polymer
   strain).
.. [2] J. D. Ferry, "Viscoelastic Properties of Polymers," 3rd ed., Wiley, 1980, ch. 1 (lines in
   the logarithm of time).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.samples import (
    empty_like,
    finite_extremes,
    sample_blocks,
    select_samples,
    shifted,
)
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.holds.hold_selection import Hold, select_hold
from reduction.stages.holds.relaxation_numbers import (
    RAMP_TIMES_LEFT_OUT,
    at_last,
    logarithmic_blocks,
)
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.standstills import Standstills
from reduction.stages.three_parameter_line.line_product import one_a_specimen

_FEWEST_POINTS = 4

_SHORTEST_SPAN = 0.5

# a stiffness at a single time uses the readings within this factor of it
_BESIDE_REFERENCE = 10**0.1

_NEAR_REFERENCE = 0.25  # decades to either side


@dataclass(frozen=True)
@read_only_arrays
class _StaticStiffness:
    """Secant between two held tensions against time."""

    elapsed: Floats
    stiffness: Floats
    reference_time: float
    stiffness_at_reference: float
    stiffness_at_reference_standard_uncertainty: float
    slope_per_decade: float
    slope_per_decade_standard_uncertainty: float
    stiffness_over_strength: float
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class CreepOfHold:
    """Creep of one hold; NaN with a reason where the hold does not support it.

    Parameters
    ----------
    specimen : str
        Which specimen.
    creep_per_decade, creep_per_decade_standard_uncertainty : float
        Strain gained in a tenfold increase of time. [1]
    tension, tension_over_strength : float
        Held tension; the same over the rated break strength. [N], [1]
    creep_compliance_per_decade : float
        Strain per decade over tension as a fraction of the strength: similar for ropes of
        one construction and many sizes. [1]
    duration : float
        Duration of the hold. [s]
    reason : str
        Reason for a missing number; else empty.
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


def _static_stiffness(
    elapsed: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    *,
    low_tension: float,
    low_strain: float,
    reference_time: float,
    ramp_duration: float = 0.0,
    rated_break_strength: float = float("nan"),
) -> _StaticStiffness:
    r"""Secant stiffness from the end of a lower hold into an upper hold, against log time.

    .. math:: K_s(t) = K_{ref} + b \log_{10}(t / t_{ref})

    Notes
    -----
    Samples are first averaged over equal steps of the logarithm of time, so that the last
    decade does not dominate; their scatter about the line is widened by their correlation.
    Levels and times are the laboratory's: only the abstract of [1]_ was read, and no standard.

    Examples
    --------
    >>> t = np.arange(1.0, 1001.0)
    >>> strain = 0.05 + 200 / (4000 - 100 * np.log10(t))
    >>> found = _static_stiffness(t, np.full(1000, 300.0), strain,
    ...     low_tension=100.0, low_strain=0.05, reference_time=100.0)
    >>> print(round(found.stiffness_at_reference), round(found.slope_per_decade))
    3800 -100
    """
    if not reference_time > 0:
        raise SettingsError(
            "the reference time is not positive", found=f"{reference_time:g} s", needed="above 0 s"
        )
    clock, load, stretch = as_same_shape(elapsed=elapsed, tension=tension, strain=strain)
    series = clock, load, stretch
    earliest, latest = RAMP_TIMES_LEFT_OUT * ramp_duration, np.inf
    end = finite_extremes(clock)[1]
    # a plateau of a slow programme ends within these ramp times: it has a secant at one time only
    is_of_ramp = bool(end < 10**_SHORTEST_SPAN * earliest and reference_time <= min(end, earliest))
    after_ramp = max(0.0, float(np.log10(end / earliest))) if is_of_ramp else 0.0
    if is_of_ramp:
        earliest, latest = reference_time / _BESIDE_REFERENCE, reference_time * _BESIDE_REFERENCE

    def is_kept(part: slice) -> Bools:
        clock, load, stretch = (one[part] for one in series)
        known = np.isfinite(clock) & np.isfinite(load) & np.isfinite(stretch)
        return known & ~((clock < earliest) | (clock > latest))

    clock, load, stretch = select_samples(is_kept, *series)
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
    reaches = bool(clock[0] <= reference_time <= clock[-1])
    span = float(x[-1] - x[0])
    # a short line gives the stiffness in the middle of its readings, but not its trend
    is_short = span < _SHORTEST_SPAN
    if x.size < _FEWEST_POINTS or (is_short and not reaches):
        raise FitError(
            "the upper hold is too short for a line in the logarithm of time",
            found=f"{x.size} points over {span:.2f} decades",
            needed=f"{_FEWEST_POINTS} points over {_SHORTEST_SPAN:g} decades, or among them the "
            f"reference time of {reference_time:g} s",
        )
    level, slope, u_level, u_slope = _line_at_zero(x, y, blocks.weight)
    near = np.abs(x) < _NEAR_REFERENCE
    if reaches and not is_short and np.count_nonzero(near) >= _FEWEST_POINTS:
        # exponential creep is no line over the logarithm of time, but one beside the time asked for
        level, _, u_level, _ = _line_at_zero(x[near], y[near], blocks.weight[near], n_terms=3)
    if is_short:
        slope = u_slope = float("nan")
    return _StaticStiffness(
        elapsed=blocks.elapsed,
        stiffness=y,
        reference_time=reference_time,
        stiffness_at_reference=level,
        stiffness_at_reference_standard_uncertainty=u_level,
        slope_per_decade=slope,
        slope_per_decade_standard_uncertainty=u_slope,
        stiffness_over_strength=level / rated_break_strength,
        notes=(
            *((note("stiffness-amid-ramp-times", reference=reference_time, ramp=ramp_duration),)
              if is_of_ramp else ()),
            *(
                (note("no-static-slope", span=after_ramp if is_of_ramp else span,
                      needed=_SHORTEST_SPAN),)
                if is_short
                else ()
            ),
            *(
                ()
                if reaches
                else (
                    note(
                        "stiffness-beyond-hold", reference=reference_time,
                        first=float(clock[0]), last=float(clock[-1]),
                    ),
                )
            ),
        ),
    )  # fmt: skip


def _line_at_zero(
    x: Floats, y: Floats, weight: Floats, n_terms: int = 2
) -> tuple[float, float, float, float]:
    """Value and slope at x = 0 of a line (of three terms: a parabola), and their uncertainties."""
    root = np.sqrt(weight / weight.sum())
    rows = np.vander(x, n_terms, increasing=True) * root[:, None]
    inverse = np.linalg.inv(rows.T @ rows)
    terms = inverse @ (rows.T @ (root * y))
    residual = root * y - rows @ terms
    variance = float(residual @ residual) / (x.size - n_terms) * lag_one_inflation(residual)
    spread = np.sqrt(variance * np.diag(inverse))
    return float(terms[0]), float(terms[1]), float(spread[0]), float(spread[1])


def creep_of_hold(hold: HoldResult, *, rated_break_strength: float = float("nan")) -> CreepOfHold:
    """Creep per decade of one hold at constant tension, with the tension as a fraction.

    Parameters
    ----------
    hold : HoldResult
        Of kind ``creep``, from `reduction.stages.holds.relaxation_and_creep`.
    rated_break_strength : float, optional
        NaN where not stated. [N]

    Returns
    -------
    creep : CreepOfHold
        Rate, or NaN with the reason from the hold.

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
        reason=hold.refused if np.isnan(hold.rate_per_decade) else "",
    )


# a hold is a step up where its tension exceeds that of the last one by this fraction of it
_LEAST_RISE = 0.05


@dataclass(frozen=True)
class HeldPair:
    """A lower hold and the higher one after it, of one specimen.

    Parameters
    ----------
    specimen : str
        Which specimen.
    low_hold, high_hold : int
        Numbers of the holds in the test, by time from 1.
    low_tension, high_tension : float
        Tension at the end of each hold. [N]
    stiffness : StaticStiffness or None
        Secant between them as a function of the time for which the higher one was held.
    reason : str
        Reason for a missing stiffness; else empty.
    low_tension_standard_uncertainty, high_tension_standard_uncertainty : float
        Of the means at the ends (type A). [N]
    low_strain : float
        Strain at the end of the lower hold, from which the stiffness counts; NaN if unknown. [1]
    """

    specimen: str
    low_hold: int
    high_hold: int
    low_tension: float
    high_tension: float
    stiffness: _StaticStiffness | None
    reason: str = ""
    low_tension_standard_uncertainty: float = float("nan")
    high_tension_standard_uncertainty: float = float("nan")
    low_strain: float = float("nan")


def _end_of(hold: Hold, values: Floats) -> tuple[float, float]:
    """Value at the end of a hold, with its standard uncertainty."""
    since, known = select_samples(
        lambda part: np.isfinite(values[part]), shifted(hold.time, hold.ramp_end_time), values
    )
    return at_last(since, known)[:2]


def _stiffness(
    low: Hold, high: Hold, *, strength: float, reference_time: float
) -> _StaticStiffness:
    """Line in the logarithm of time, with the uncertainty of the end of the lower hold."""
    if high.ramp is None:
        raise DataError(
            "the record does not show the ramp to the upper hold, so the time since loading is "
            "not known"
        )
    (known,) = select_samples(lambda part: np.isfinite(low.strain[part]), low.strain)
    if known.size < 3:
        raise DataError("the lower hold has no strain", found=f"{known.size} readings")
    (tension, u_tension), (strain, u_strain) = _end_of(low, low.tension), _end_of(low, low.strain)
    since = high.since_centre
    later = int(np.searchsorted(since, 0.0, side="right"))
    found = _static_stiffness(
        since[later:],
        high.tension[later:],
        high.strain[later:],
        low_tension=tension,
        low_strain=strain,
        reference_time=reference_time,
        ramp_duration=high.ramp_duration,
        rated_break_strength=strength,
    )
    gain = (_end_of(high, high.tension)[0] - tension) / found.stiffness[-1]
    level = found.stiffness_at_reference
    spread = np.hypot(
        found.stiffness_at_reference_standard_uncertainty,
        np.hypot(u_tension, level * u_strain) / gain,
    )
    return replace(found, stiffness_at_reference_standard_uncertainty=float(spread))


def held_pairs(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    standstills: Standstills,
    *,
    specimens: Sequence[str],
    rated_break_strength: ArrayLike,
    reference_time: float,
) -> tuple[HeldPair, ...]:
    """Static stiffness from each hold to the next one, if that is at a higher tension.

    Parameters
    ----------
    time, position : array_like, shape (n_samples,)
        Elapsed time and crosshead position. [s], [m]
    tension, strain : array_like, shape (n_specimens, n_samples)
        NaN where missing. [N], [1]
    standstills : Standstills
        Holds of the crosshead, or of the tension.
    specimens : sequence of str, length n_specimens
        Names, in the order of the rows.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    reference_time : float
        Time after the centre of the ramp to which the stiffness refers. [s]

    Returns
    -------
    pairs : tuple of HeldPair
        By upper hold, then by specimen; without a stiffness where the holds do not support
        one, with the reason.

    Raises
    ------
    DataError
        If time and position do not pair up, or a strength is not positive.

    Notes
    -----
    A hold counts as higher if its mean tension exceeds that of the hold before by 5 % of
    it; a rest between the two separates them.  Tension and strain of the lower hold are those at
    its end, by a line through its last 5 %, and their type A uncertainty is included in that of the
    stiffness; time counts from the centre of the ramp.  Levels and durations are the laboratory's:
    only the abstract of [1]_ was read, and no standard.

    Examples
    --------
    A hold at 100 N, and one at 300 N whose secant falls by 100 N a decade:

    >>> t = np.arange(0.0, 1200.0)
    >>> load = np.interp(t, [0, 10, 100, 102, 1200], [0, 100, 100, 300, 300])
    >>> since = np.clip(t - 101, 1, None)
    >>> strain = 0.05 * load / 100
    >>> strain[t > 101] = (0.05 + (load - 100) / (4000 - 100 * np.log10(since)))[t > 101]
    >>> stand = Standstills(
    ...     first=np.array([10, 102]), last=np.array([99, 1199]),
    ...     start_time=np.array([10.0, 102.0]), end_time=np.array([99.0, 1199.0]),
    ...     mean_position=np.array([1.0, 1.1]), mean_tension=np.array([[100.0, 300.0]]),
    ...     is_rest=np.array([False, False]), position_tolerance=1e-3, slack_tension=5.0,
    ...     tension_tolerance=1.0)
    >>> pair, = held_pairs(t, 1 + strain, [load], [strain], stand, specimens=["rope"],
    ...     rated_break_strength=1e4, reference_time=100.0)
    >>> print(round(pair.stiffness.stiffness_at_reference, -1), pair.low_hold, pair.high_hold)
    3800.0 1 2
    """
    seconds, place = as_same_shape(time=time, position=position)
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    stretches = np.atleast_2d(np.asarray(strain, dtype=np.float64))
    strengths = one_a_specimen(rated_break_strength, len(specimens))
    number = np.cumsum(~standstills.is_rest)
    pairs = []
    for upper in range(1, standstills.n_standstills):
        if standstills.is_rest[upper - 1 : upper + 1].any():
            continue
        for row, name in enumerate(specimens):
            low_mean, high_mean = standstills.mean_tension[row, upper - 1 : upper + 1]
            if not high_mean > (1 + _LEAST_RISE) * low_mean:
                continue
            low, high = (
                select_hold(seconds, place, loads[row], stretches[row], standstills, index)
                for index in (upper - 1, upper)
            )
            stiffness, reason = None, ""
            try:
                stiffness = _stiffness(
                    low, high, strength=float(strengths[row]), reference_time=reference_time
                )
            except (DataError, FitError) as error:
                reason = str(error)
            ends = _level(low, low_mean), _level(high, high_mean)
            known = low.strain[np.isfinite(low.strain)]
            pairs.append(
                HeldPair(
                    specimen=name,
                    low_hold=int(number[upper - 1]),
                    high_hold=int(number[upper]),
                    low_tension=ends[0][0],
                    high_tension=ends[1][0],
                    stiffness=stiffness,
                    reason=reason,
                    low_tension_standard_uncertainty=ends[0][1],
                    high_tension_standard_uncertainty=ends[1][1],
                    low_strain=_end_of(low, low.strain)[0] if known.size > 2 else float("nan"),
                )
            )
    return tuple(pairs)


def _level(hold: Hold, mean: float) -> tuple[float, float]:
    """Tension at the end of a hold; its mean if readings are too few for a scatter."""
    return _end_of(hold, hold.tension) if hold.tension.size > 2 else (float(mean), float("nan"))

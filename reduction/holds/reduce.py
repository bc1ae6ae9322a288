"""Holds of a record, one result a hold and specimen: numbers where supported, reasons where not.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, FitError
from reduction.holds.blocks import logarithmic_blocks
from reduction.holds.creep import creep_rate
from reduction.holds.product import HoldResult
from reduction.holds.prony import PronyFit, fit_prony
from reduction.holds.relaxation import Rate, rate_per_decade, value_at_times
from reduction.holds.select import select_hold
from reduction.holds.support import SIGNIFICANT, Ends, Hold, hold_ends, reasons_against
from reduction.phases.standstill import Standstills
from reduction.samples.columns import chosen, mean_of, shifted
from reduction.settings import HoldSettings

_EMPTY = np.empty(0)


def _rate(hold: Hold, ends: Ends) -> Rate | None:
    """Share of tension lost per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(
            "rate per decade: the record does not show the ramp, so the time since loading "
            "is not known"
        )
        return None
    since = hold.since_centre
    later = int(np.searchsorted(since, 0.0, side="right"))
    blocks = logarithmic_blocks(since[later:], hold.tension[later:])
    blocks = replace(blocks, value=blocks.value / ends.initial)
    try:
        slope = rate_per_decade(blocks, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(f"rate per decade: {error.problem}")
        return None
    if -slope.value < SIGNIFICANT * slope.standard_uncertainty:
        hold.refusals.append(
            f"rate per decade: a loss of {-slope.value:.2%} +- {slope.standard_uncertainty:.2%} "
            "(one standard uncertainty) is not told from zero"
        )
        return None
    return Rate(-slope.value, slope.standard_uncertainty, slope.elapsed_low, slope.elapsed_high)


def _prony(hold: Hold, ends: Ends, settings: HoldSettings) -> PronyFit | None:
    """Prony series, or None with a refusal."""
    if ends.drop < SIGNIFICANT * ends.drop_uncertainty:
        hold.refusals.append(
            f"Prony series: a drop of {ends.drop:.2%} +- {ends.drop_uncertainty:.2%} "
            "(one standard uncertainty) is not told from zero"
        )
        return None
    # The constant-rate ramp of the same centre and spread ends half its duration later.
    ramp_end = float(hold.time[0])
    if hold.ramp is not None:
        ramp_end = max(ramp_end, hold.ramp.centre_time + hold.ramp.duration / 2)
    later = int(np.searchsorted(hold.time, ramp_end, side="right"))
    blocks = logarithmic_blocks(shifted(hold.time[later:], ramp_end), hold.tension[later:])
    try:
        return fit_prony(
            blocks.elapsed,
            blocks.value,
            ramp_duration=hold.ramp_duration,
            maximum_terms=settings.maximum_terms,
            weights=blocks.weight,
        )
    except FitError as error:
        hold.refusals.append(f"Prony series: {error.problem} ({error.found})")
        return None


def _creep(hold: Hold) -> Rate | None:
    """Strain per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(
            "rate per decade: the record does not show the ramp, so the time since loading "
            "is not known"
        )
        return None
    since, strain = hold.since_centre, hold.strain
    series = chosen(
        lambda part: (since[part] > 0) & np.isfinite(strain[part]), since, strain, hold.tension
    )
    try:
        return creep_rate(*series, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(f"rate per decade: {error.problem}")
        return None


def _describe(
    hold: Hold, rate: Rate | None, *, n_samples: int, follows_hold: bool, on_tension: bool
) -> None:
    """Say how the ramp was treated and what was left out."""
    if hold.ramp is not None:
        added = "length" if on_tension else "tension"
        use = "counts" if on_tension else "enters the Prony terms"
        hold.notes.append(
            f"ramp of {hold.ramp.end_time - hold.ramp.start_time:.3g} s; it acts as a step "
            f"{hold.ramp.end_time - hold.ramp.centre_time:.3g} s before the hold (centre of the "
            f"{added} it adds) and {use} as {hold.ramp.duration:.3g} s at constant rate"
        )
    if rate is not None:
        hold.notes.append(
            f"rate per decade from {rate.elapsed_low:.3g} to {rate.elapsed_high:.3g} s after "
            "the centre of the ramp"
        )
    if hold.time.size < n_samples:
        hold.notes.append(f"{n_samples - hold.time.size} of {n_samples} samples left out")
    if follows_hold:
        hold.notes.append("what an earlier hold has left to relax goes on under this one")


def _result(
    hold: Hold,
    *,
    name: str,
    kind: str,
    settings: HoldSettings,
    n_samples: int,
    follows_hold: bool,
    on_tension: bool,
) -> HoldResult:
    """Reduce one hold of one specimen."""
    times = np.array(settings.times, dtype=np.float64)
    nothing = np.full(times.size, np.nan)
    drop = Rate(np.nan, np.nan, np.nan, np.nan)
    rate: Rate | None = None
    prony: PronyFit | None = None
    tension_at = strain_at = (nothing, nothing)
    ends = Ends(*(np.nan,) * 6)
    times_known, known = chosen(lambda part: np.isfinite(hold.strain[part]), hold.time, hold.strain)
    if hold.time.size < 3:
        hold.refusals.append(f"everything: {hold.time.size} samples in the hold")
    else:
        ends = hold_ends(hold)
        tension_at = value_at_times(shifted(hold.time, hold.start_time), hold.tension, times)
        if known.size > 1:
            strain_at = value_at_times(shifted(times_known, hold.start_time), known, times)
        reasons = reasons_against(hold, ends, settings) if kind == "relaxation" else []
        hold.refusals.extend(f"drop, rate per decade, Prony series: {one}" for one in reasons)
        if kind == "creep":
            rate = _creep(hold)
        elif not reasons:
            drop = Rate(ends.drop, ends.drop_uncertainty, np.nan, np.nan)
            rate = _rate(hold, ends)
            prony = _prony(hold, ends, settings)
    _describe(hold, rate, n_samples=n_samples, follows_hold=follows_hold, on_tension=on_tension)
    shown = rate or Rate(np.nan, np.nan, np.nan, np.nan)
    return HoldResult(
        specimen=name,
        kind=kind,
        hold_start_time=hold.start_time,
        hold_duration=hold.duration,
        hold_strain=mean_of(known) if known.size else np.nan,
        hold_initial_tension=ends.initial,
        hold_final_tension=ends.final,
        relaxation_drop=drop.value,
        relaxation_drop_standard_uncertainty=drop.standard_uncertainty,
        rate_per_decade=shown.value,
        rate_per_decade_standard_uncertainty=shown.standard_uncertainty,
        times=times,
        tension_at_time=tension_at[0],
        strain_at_time=strain_at[0],
        prony_tension=_EMPTY if prony is None else prony.tension,
        prony_tension_standard_uncertainty=(
            _EMPTY if prony is None else prony.tension_standard_uncertainty
        ),
        prony_time=_EMPTY if prony is None else prony.time,
        prony_time_standard_uncertainty=(
            _EMPTY if prony is None else prony.time_standard_uncertainty
        ),
        long_time_tension=np.nan if prony is None else prony.long_time_tension,
        long_time_tension_standard_uncertainty=(
            np.nan if prony is None else prony.long_time_tension_standard_uncertainty
        ),
        criterion="" if prony is None else prony.criterion,
        refusals=tuple(hold.refusals),
        notes=tuple(hold.notes),
        ramp_centre_time=np.nan if hold.ramp is None else hold.ramp.centre_time,
        hold_strain_standard_uncertainty=hold.strain_uncertainty,
        hold_initial_tension_standard_uncertainty=ends.initial_uncertainty,
        hold_final_tension_standard_uncertainty=ends.final_uncertainty,
        tension_at_time_standard_uncertainty=tension_at[1],
        strain_at_time_standard_uncertainty=strain_at[1],
    )


def reduce_holds(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    standstills: Standstills,
    *,
    specimens: tuple[str, ...],
    settings: HoldSettings,
    kind: Literal["relaxation", "creep"] = "relaxation",
) -> tuple[HoldResult, ...]:
    """Relaxation or creep of every specimen in every hold; rests are left out.

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time; samples that do not come later than all before are left out. [s]
    position : array_like, shape (n_samples,)
        Crosshead position. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN is left out, so samples flagged as spikes are passed as NaN. [N]
    strain : array_like, shape (n_specimens, n_samples)
        Strain of the free length. [1]
    standstills : Standstills
        Intervals in which the crosshead (for creep: the tension) stands still; where it has a
        ``tension_tolerance`` the ramps are those of the tension.
    specimens : tuple of str, length n_specimens
        Names, in the order of the rows.
    settings : HoldSettings
        Shortest duration, number of Prony terms, times.
    kind : str, optional
        ``relaxation`` at constant length or ``creep`` at constant tension.

    Returns
    -------
    results : tuple of HoldResult
        By hold, then by specimen; NaN where refused, with the reason in ``refusals``.

    Raises
    ------
    DataError
        If the names do not fit the rows of tension and strain.

    Notes
    -----
    Source: WHOI-2005-10, sec. 4.1 and Figure 24 ([1]_), which calls relaxation "creep".
    The zero of time for rates is the centre of what the ramp adds, tension or, where the
    machine keeps the tension, length; for
    ``times`` it is the first sample of the hold; the Prony terms are corrected for the
    ramp exactly as far as it has a constant rate.  Uncertainties are type A.  Cost grows
    with the samples of the holds: series are fitted on 40 block means a decade of time.

    Examples
    --------
    >>> t = np.arange(0.0, 200.0, 0.5)
    >>> x = np.clip(t - 10, 0, 5)
    >>> load = np.where(t < 15, 80 * x, 325 + 75 * np.exp(-(t - 15) / 40))
    >>> stand = Standstills(
    ...     first=np.array([30]), last=np.array([399]), start_time=np.array([15.0]),
    ...     end_time=np.array([199.5]), mean_position=np.array([5.0]),
    ...     mean_tension=np.array([[340.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.05, slack_tension=5.0)
    >>> hold, = reduce_holds(
    ...     t, x, [load], [x / 2], stand, specimens=("new",), settings=HoldSettings())
    >>> print(round(hold.long_time_tension), hold.prony_time.round())
    325 [40.]
    """
    seconds, place = np.asarray(time, dtype=np.float64), np.asarray(position, dtype=np.float64)
    loads, stretches = np.atleast_2d(tension), np.atleast_2d(strain)
    if not len(specimens) == loads.shape[0] == stretches.shape[0]:
        raise DataError(
            "specimens do not fit the record",
            found=f"{len(specimens)} names, {loads.shape[0]} rows of tension, "
            f"{stretches.shape[0]} of strain",
            needed="one row a specimen",
        )
    results = []
    for index in np.flatnonzero(~standstills.is_rest):
        earlier = bool(index) and not standstills.is_rest[index - 1]
        n_samples = int(standstills.last[index] - standstills.first[index]) + 1
        for name, load, stretch in zip(specimens, loads, stretches, strict=True):
            hold = select_hold(seconds, place, load, stretch, standstills, int(index))
            results.append(
                _result(
                    hold,
                    name=name,
                    kind=kind,
                    settings=settings,
                    n_samples=n_samples,
                    follows_hold=earlier,
                    on_tension=standstills.tension_tolerance is not None,
                )
            )
    return tuple(results)

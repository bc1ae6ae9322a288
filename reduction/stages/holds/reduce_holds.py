"""Holds of a record: numbers where supported, reasons where not.

One specimen in one hold, and everything that speaks against a number from it.

Samples of one specimen in one hold, and the ramp before it, out of a record.

Holds of a record, one result a hold and specimen: numbers where supported, reasons where not.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note
from reduction.record.samples import (
    BLOCK,
    empty_like,
    mean_of,
    median_step_reaches,
    sample_blocks,
    select_samples,
    shifted,
)
from reduction.record.settings import HoldSettings
from reduction.stages.holds.hold_start import Ramp, begins_inside, find_ramp
from reduction.stages.holds.prony_series import PronyFit, fit_prony
from reduction.stages.holds.relaxation import (
    HoldResult,
    Rate,
    creep_rate,
    end_mean,
    logarithmic_blocks,
    rate_per_decade,
    relaxation_drop,
    value_at_times,
)
from reduction.stages.moduli.splice_slip import find_steps
from reduction.stages.standstills import Standstills

SIGNIFICANT = 3.0

FEWEST_SAMPLES = 20

FINAL_SHARE = 0.05

INITIAL_SHARE = 0.005

STEP_BLOCKS = 4096

STEP_FALSE_ALARM = 1e-3


@dataclass(frozen=True)
class Hold:
    """One specimen in one hold: finite samples in order, and the ramp before them.

    Parameters
    ----------
    time, position, tension, strain : ndarray, shape (n_samples,)
        Samples of the hold. [s], [m], [N], [1]
    start_time : float
        First time of the standstill. [s]
    ramp : Ramp or None
        None where the record does not show it.
    position_tolerance : float
        Range of position that was allowed inside the standstill. [m]
    slack_tension : float
        Tension at or below which the specimen is slack. [N]
    refusals, notes : list of Note
        Filled as the hold is reduced; ``made``, how, too.
    """

    time: Floats
    position: Floats
    tension: Floats
    strain: Floats
    start_time: float
    ramp: Ramp | None
    position_tolerance: float
    slack_tension: float = 0.0
    refusals: list[Note] = field(default_factory=list)
    notes: list[Note] = field(default_factory=list)
    made: list[str] = field(default_factory=list)

    @property
    def duration(self) -> float:
        """From the first to the last sample. [s]."""
        return float(self.time[-1] - self.time[0]) if self.time.size else 0.0

    @property
    def strain_uncertainty(self) -> float:
        """Of its mean strain (type A); NaN with fewer than two readings. [1]."""
        (known,) = select_samples(lambda part: np.isfinite(self.strain[part]), self.strain)
        if known.size < 2:
            return float("nan")
        return end_mean(known, n_samples=known.size, at_end=True)[1]

    @property
    def since_centre(self) -> Floats:
        """Time from the centre of the ramp, or from the first sample where none is known. [s]."""
        centre = self.time[0] if self.ramp is None else self.ramp.centre_time
        return shifted(self.time, float(centre))

    @property
    def ramp_duration(self) -> float:
        """Of the equivalent constant-rate ramp; 0 where none is known. [s]."""
        return 0.0 if self.ramp is None else self.ramp.duration


@dataclass(frozen=True)
class _Ends:
    """Tension at both ends of a hold, and the share lost."""

    initial: float
    final: float
    drop: float
    drop_uncertainty: float
    initial_uncertainty: float
    final_uncertainty: float


def _hold_ends(hold: Hold) -> _Ends:
    """Tension at both ends of a hold; the stretches are named in ``made``.

    Notes
    -----
    The first stretch is a tenth of the ramp time, at least 0.5 % of the hold and three
    samples; the last is 5 % of the samples, at least three.

    Examples
    --------
    WHOI-2005-10, sec. 4.1: 400 lbf falls to 325 lbf in three minutes.

    >>> t = np.linspace(0, 180, 361)
    >>> load = np.where(t < 2, 400.0, 325.0)
    >>> hold = Hold(t, 0 * t, load, 2.75 + 0 * t, 0.0, None, 0.01)
    >>> round(_hold_ends(hold).drop, 4)
    0.1875
    """
    step = hold.duration / max(1, hold.time.size - 1)
    stretch = max(INITIAL_SHARE * hold.duration, 0.1 * hold.ramp_duration)
    n_initial = max(3, int(stretch / step)) if step > 0 else 3
    n_final = max(3, int(FINAL_SHARE * hold.time.size))
    initial, u_initial = end_mean(hold.tension, n_samples=n_initial, at_end=False)
    final, u_final = end_mean(hold.tension, n_samples=n_final, at_end=True)
    hold.made.append(
        f"initial tension is the mean of the first {n_initial}, final tension of the last "
        f"{n_final} of {hold.time.size} samples"
    )
    drop = float(relaxation_drop(initial, final))
    uncertainty = float(np.hypot(u_final, (1 - drop) * u_initial) / initial)
    known = uncertainty if drop == drop else np.nan
    return _Ends(initial, final, drop, known, u_initial, u_final)


def _step_reason(hold: Hold) -> Note | None:
    """Name a step of tension inside the hold, where there is one."""
    if hold.time.size < FEWEST_SAMPLES or not median_step_reaches(
        hold.time, 3, _longest_step(hold.time)
    ):
        return None
    size = -(-hold.time.size // STEP_BLOCKS)
    whole = hold.time.size // size * size
    if whole < 24 * size:
        return None
    parts = sample_blocks(whole, hold.tension, size=size * max(1, BLOCK // size))
    series = np.concatenate([hold.tension[part].reshape(-1, size).mean(axis=1) for part in parts])
    steps = find_steps(series, false_alarm=STEP_FALSE_ALARM)
    if not steps:
        return None
    largest = max(steps, key=lambda step: abs(step.size))
    when = hold.time[largest.onset * size] - hold.start_time
    return note("hold-tension-steps", step=float(largest.size), time=float(when))


def _longest_step(time: Floats) -> float:
    return max(
        float(np.diff(time[part]).max(initial=0.0))
        for part in sample_blocks(time.size, time, overlap=1)
    )


def _motion_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a motion of the crosshead that is worth more than a tenth of the drop."""
    n_samples = max(3, int(FINAL_SHARE * hold.time.size))
    before, u_before = end_mean(hold.position, n_samples=n_samples, at_end=False)
    after, u_after = end_mean(hold.position, n_samples=n_samples, at_end=True)
    motion, noise = after - before, float(np.hypot(u_before, u_after))
    if hold.ramp is None or not np.isfinite(hold.ramp.stiffness):
        moved = abs(motion) > max(SIGNIFICANT * noise, 0.5 * hold.position_tolerance)
        worth = float("nan")
    else:
        stiffness = abs(hold.ramp.stiffness)
        lost = abs(ends.initial - ends.final)
        moved = abs(motion) > SIGNIFICANT * noise and stiffness * abs(motion) > max(
            0.1 * lost, SIGNIFICANT * ends.drop_uncertainty * ends.initial
        )
        worth = stiffness * abs(motion)
    return note("hold-crosshead-moves", motion=motion, worth=worth) if moved else None


def _reasons_against(hold: Hold, ends: _Ends, settings: HoldSettings) -> list[Note]:
    """Everything that speaks against relaxation numbers from a hold.

    Notes
    -----
    Too short; too few samples; a slack specimen; tension that rises by more than three standard
    uncertainties; a crosshead that moves by more than three standard uncertainties where
    the motion is worth more than a tenth of the drop (by the stiffness of the ramp); a
    step of tension that relaxation does not explain (`find_steps`, false alarm 0.1 %).

    Examples
    --------
    >>> t = np.linspace(0, 10, 101)
    >>> hold = Hold(t, 0 * t, 400 - t, 1 + 0 * t, 0.0, None, 0.01)
    >>> [one.code for one in _reasons_against(hold, _hold_ends(hold), HoldSettings())]
    ['hold-too-short']
    """
    reasons = []
    if hold.duration < settings.minimum_duration:
        reasons.append(
            note("hold-too-short", duration=hold.duration, needed=settings.minimum_duration)
        )
    if hold.time.size < FEWEST_SAMPLES:
        reasons.append(
            note("hold-too-few-samples", n_samples=hold.time.size, needed=FEWEST_SAMPLES)
        )
    if not ends.final > hold.slack_tension or not ends.drop_uncertainty < 1 / SIGNIFICANT:
        reasons.append(note("hold-slack", tension=ends.final, slack_tension=hold.slack_tension))
    elif ends.drop < -SIGNIFICANT * ends.drop_uncertainty:
        reasons.append(note("hold-tension-rises", rise=-ends.drop))
    reasons += [reason for reason in (_motion_reason(hold, ends), _step_reason(hold)) if reason]
    return reasons


_LOOKED_BACK = 1 << 16
"""Samples before a hold in which its ramp is looked for at first: many cycles may lie between two
holds."""


def _finite_times(part: slice, time: Floats, *series: Floats) -> Floats:
    """Times of the samples of a part, -inf where one of their values is not finite."""
    finite = np.isfinite(time[part])
    for one in series:
        finite &= np.isfinite(one[part])
    return np.where(finite, time[part], -np.inf)


def _is_sound(time: Floats, *series: Floats, after: float = -np.inf) -> Bools:
    """Which samples have finite values and a time that is later than all before."""
    is_sound, latest = empty_like(time, dtype=bool), after
    for part in sample_blocks(time.size, time, *series, is_sound):
        known = _finite_times(part, time, *series)
        reached = np.maximum.accumulate(np.concatenate([[latest], known]))
        np.greater(known, reached[:-1], out=is_sound[part])
        latest = float(reached[-1])
    return is_sound


def _latest(time: Floats, *series: Floats) -> float:
    """Latest time of samples whose values are finite."""
    latest = -np.inf
    for part in sample_blocks(time.size, time, *series):
        latest = _finite_times(part, time, *series).max(initial=latest)
    return float(latest)


def _ramp_before(time: Floats, moved: Floats, answer: Floats, *, band: float) -> Ramp | None:
    """The ramp that ends with the last sample, out of as much as shows where it began."""
    n_looked = 0
    while n_looked < time.size:
        n_looked = min(max(2 * n_looked, _LOOKED_BACK), time.size)
        start = time.size - n_looked
        whole = time, moved, answer
        looked = [one[start:] for one in whole]
        is_sound = _is_sound(*looked, after=_latest(*(one[:start] for one in whole)))
        before = select_samples(is_sound.__getitem__, *looked)
        if before[0].size > 2 and begins_inside(before[1], band=band):
            break
    return find_ramp(*before, band=band) if before[0].size > 2 else None


def select_hold(
    time: Floats,
    position: Floats,
    tension: Floats,
    strain: Floats,
    standstills: Standstills,
    index: int,
) -> Hold:
    """Take the samples of one specimen in one standstill, and the ramp that led to it.

    Notes
    -----
    The ramp is looked for from the start of the standstill before, or of the record.

    Examples
    --------
    A rise of 5 m in 5 s, of which one sample of the hold is missing.

    >>> t = np.arange(0.0, 40.0)
    >>> x = np.clip(t - 10, 0, 5)
    >>> stand = Standstills(
    ...     first=np.array([15]), last=np.array([39]), start_time=np.array([15.0]),
    ...     end_time=np.array([39.0]), mean_position=np.array([5.0]),
    ...     mean_tension=np.array([[400.0]]), is_rest=np.array([False]),
    ...     position_tolerance=0.05, slack_tension=5.0)
    >>> hold = select_hold(t, x, np.where(t == 20, np.nan, 80 * x), x / 2, stand, 0)
    >>> print(hold.time.size, hold.duration, round(hold.ramp.duration))
    24 24.0 5
    """
    first, last = int(standstills.first[index]), int(standstills.last[index])
    begin = int(standstills.first[index - 1]) if index else 0
    inside = slice(first, last + 1)
    held = [one[inside] for one in (time, position, tension, strain)]
    seconds, place, load, stretch = select_samples(_is_sound(*held[:3]).__getitem__, *held)
    # under load control the machine moves the tension, and the length answers
    moved, answer, band = position, tension, standstills.position_tolerance
    if standstills.tension_tolerance is not None:
        moved, answer, band = tension, position, standstills.tension_tolerance
    ramp = _ramp_before(*(one[begin : first + 1] for one in (time, moved, answer)), band=band)
    return Hold(
        time=seconds,
        position=place,
        tension=load,
        strain=stretch,
        start_time=float(standstills.start_time[index]),
        ramp=ramp,
        position_tolerance=standstills.position_tolerance,
        slack_tension=standstills.slack_tension,
    )


_EMPTY = np.empty(0)


def _rate(hold: Hold, ends: _Ends) -> Rate | None:
    """Share of tension lost per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(note("rate-without-ramp"))
        return None
    since = hold.since_centre
    later = int(np.searchsorted(since, 0.0, side="right"))
    blocks = logarithmic_blocks(since[later:], hold.tension[later:])
    blocks = replace(blocks, value=blocks.value / ends.initial)
    try:
        slope = rate_per_decade(blocks, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(note("no-rate", reason=error.problem))
        return None
    if -slope.value < SIGNIFICANT * slope.standard_uncertainty:
        hold.refusals.append(
            note("rate-not-told-from-zero", loss=-slope.value, spread=slope.standard_uncertainty)
        )
        return None
    return Rate(-slope.value, slope.standard_uncertainty, slope.elapsed_low, slope.elapsed_high)


def _prony(hold: Hold, ends: _Ends, settings: HoldSettings) -> PronyFit | None:
    """Prony series, or None with a refusal."""
    if ends.drop < SIGNIFICANT * ends.drop_uncertainty:
        hold.refusals.append(
            note("drop-not-told-from-zero", drop=ends.drop, spread=ends.drop_uncertainty)
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
        hold.refusals.append(note("no-prony-series", reason=error.problem, found=error.found))
        return None


def _creep(hold: Hold) -> Rate | None:
    """Strain per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(note("rate-without-ramp"))
        return None
    since, strain = hold.since_centre, hold.strain
    series = select_samples(
        lambda part: (since[part] > 0) & np.isfinite(strain[part]), since, strain, hold.tension
    )
    try:
        return creep_rate(*series, ramp_duration=hold.ramp_duration)
    except DataError as error:
        hold.refusals.append(note("no-rate", reason=error.problem))
        return None


def _describe(
    hold: Hold, rate: Rate | None, *, n_samples: int, follows_hold: bool, on_tension: bool
) -> None:
    """Say how the ramp was treated and what was left out."""
    if hold.ramp is not None:
        added = "length" if on_tension else "tension"
        use = "counts" if on_tension else "enters the Prony terms"
        hold.made.append(
            f"ramp of {hold.ramp.end_time - hold.ramp.start_time:.3g} s; it acts as a step "
            f"{hold.ramp.end_time - hold.ramp.centre_time:.3g} s before the hold (centre of the "
            f"{added} it adds) and {use} as {hold.ramp.duration:.3g} s at constant rate"
        )
    if rate is not None:
        hold.made.append(
            f"rate per decade from {rate.elapsed_low:.3g} to {rate.elapsed_high:.3g} s after "
            "the centre of the ramp"
        )
    if hold.time.size < n_samples:
        left_out = n_samples - hold.time.size
        hold.notes.append(note("hold-samples-left-out", n_left_out=left_out, n_samples=n_samples))
    if follows_hold:
        hold.made.append("what an earlier hold has left to relax goes on under this one")


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
    ends = _Ends(*(np.nan,) * 6)
    times_known, known = select_samples(
        lambda part: np.isfinite(hold.strain[part]), hold.time, hold.strain
    )
    if hold.time.size < 3:
        hold.refusals.append(note("hold-empty", n_samples=hold.time.size))
    else:
        ends = _hold_ends(hold)
        tension_at = value_at_times(shifted(hold.time, hold.start_time), hold.tension, times)
        if known.size > 1:
            strain_at = value_at_times(shifted(times_known, hold.start_time), known, times)
        reasons = _reasons_against(hold, ends, settings) if kind == "relaxation" else []
        hold.refusals.extend(reasons)
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
        made=tuple(hold.made),
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

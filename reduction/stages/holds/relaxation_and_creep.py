"""Relaxation at constant length and creep at constant tension, a hold and a specimen at a time.

Tests whether the samples of a hold (`reduction.stages.holds.hold_selection`) support a result, and
computes drop, rate per decade, Prony series and tension at stated times, or strain gained.  The
specimen also relaxes during the ramp: rates count time from its centre and leave out the first
three ramp times.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note
from reduction.record.samples import (
    BLOCK,
    mean_of,
    median_step_reaches,
    sample_blocks,
    select_samples,
    shifted,
)
from reduction.record.settings import HoldSettings
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.holds.hold_selection import (
    BESIDE,
    SAMPLES_BESIDE,
    SIGNIFICANT,
    Hold,
    select_hold,
)
from reduction.stages.holds.prony_series import (
    PronyFit,
    fit_prony,
)
from reduction.stages.holds.ramp_end import (
    MOTION_KNOWN_TO,
    effect_of_motion,
    level_at_end,
)
from reduction.stages.holds.relaxation_numbers import (
    Rate,
    at_last,
    creep_rate,
    logarithmic_blocks,
    on_curve,
    rate_per_decade,
    relaxation_drop,
    value_at_times,
)
from reduction.stages.load_at_slack import LoadAtSlack
from reduction.stages.moduli.splice_slip import find_steps
from reduction.stages.standstills import Standstills

_EMPTY = np.empty(0)

FEWEST_SAMPLES = 20

STEP_BLOCKS = 4096

STEP_FALSE_ALARM = 1e-3


@dataclass(frozen=True)
class _LateLoad:
    """Tension that goes on rising while the crosshead stands.

    ``rise`` above the end of the ramp, ``peak`` that it reaches [N], ``delay`` of the peak [s].
    """

    rise: float
    peak: float
    delay: float


@dataclass(frozen=True)
class _Ends:
    """Tension at both ends of a hold, and the share lost."""

    initial: float
    final: float
    drop: float
    drop_uncertainty: float
    initial_uncertainty: float
    final_uncertainty: float
    n_initial: int = 0
    n_final: int = 0
    late: _LateLoad | None = None


def _hold_ends(hold: Hold) -> _Ends:
    """Tension at the end of the ramp and at the end of a hold.

    Notes
    -----
    The tension at the end of the ramp is that of a line through as many samples as follow one
    (`level_at_end`).  The end of the ramp is known to a step of the log or to the noise of
    position; the rate of the tension converts this into tension.  A higher peak in the log near
    it means that the tension may be as high.  The line is no shorter than a twentieth of the ramp:
    anything that relaxes faster has done so within it, and machines ring.  Where the last readings
    of the ramp lead to a higher tension than that line, the specimen may have relaxed between two
    readings, and the tension lies between both.  The tension at the end of the hold is from a line
    over the logarithm of time through the last 5 % of the samples, at least three: their mean would
    be the tension in the middle of them.

    Examples
    --------
    WHOI-2005-10, sec. 4.1: 400 lbf falls to 325 lbf in three minutes.

    >>> t = np.linspace(0, 180, 361)
    >>> load = np.interp(t, [0, 120, 180], [400, 325, 325])
    >>> hold = Hold(t, 0 * t, load, 2.75 + 0 * t, 0.0, None, 0.01)
    >>> round(_hold_ends(hold).drop, 4)
    0.1875
    """
    final, u_final, n_final = at_last(shifted(hold.time, hold.ramp_end_time), hold.tension)
    first = level_at_end(
        shifted(hold.time, hold.ramp_end_time),
        hold.tension,
        noise=reading_noise(hold.tension),
        shortest=0.0 if hold.ramp is None else min(BESIDE * hold.ramp.length, _RINGING),
        step=hold.tension_step,
        relaxes=not hold.motion.greatest,  # a crosshead that settles bends it within seconds
    )
    u_initial = first.standard_uncertainty
    if hold.ramp is not None:
        # falling tension is uncertain through the time, rising tension through the position
        u_initial = float(np.hypot(u_initial, first.slope * hold.ramp.end_uncertainty))
        if np.isfinite(hold.ramp.stiffness) and not hold.on_tension:
            u_initial = float(
                np.hypot(u_initial, hold.ramp.stiffness * reading_noise(hold.position))
            )
    if hold.ramp_is_within_steps:
        u_initial = float(np.hypot(u_initial, _lost_in_a_decade(hold) / np.sqrt(3)))
    late = _late_load(hold, first.value)
    if late is not None:
        u_initial = float(np.hypot(u_initial, _LATE_MISSES * late.rise))
    above = hold.logged_peak - SIGNIFICANT * hold.tension_noise - first.value
    # the tension did not settle at once: it lies somewhere between the two
    if SIGNIFICANT * u_initial < above < LARGEST_DISAGREEMENT * first.value:
        u_initial = float(np.hypot(u_initial, above / np.sqrt(3)))
    led_to = hold.ramp_leads_to - first.value
    # the ramp says nothing about a piece that has broken
    if SIGNIFICANT * hold.tension_noise < led_to < first.value:
        u_initial = float(np.hypot(u_initial, led_to / np.sqrt(3)))
    initial = first.value
    if late is None and initial > hold.logged_peak + SIGNIFICANT * hold.tension_noise:
        initial, u_initial = _with_ramp(hold, initial, u_initial)
    return _ends_of(initial, u_initial, final, u_final, first.n_samples, n_final, late)


def _ends_of(
    initial: float,
    u_initial: float,
    final: float,
    u_final: float,
    n_initial: int,
    n_final: int,
    late: _LateLoad | None = None,
) -> _Ends:
    """Both end tensions, and the loss between them with its uncertainty."""
    drop = float(relaxation_drop(initial, final))
    uncertainty = float(np.hypot(u_final, (1 - drop) * u_initial) / initial)
    known = uncertainty if drop == drop else np.nan
    return _Ends(initial, final, drop, known, u_initial, u_final, n_initial, n_final, late)


def _with_ramp(hold: Hold, initial: float, uncertainty: float) -> tuple[float, float]:
    """Tension at the end of a ramp, from the hold extrapolated back and the ramp extrapolated on.

    A line through a few noisy readings of a fast relaxation may exceed everything logged.
    Where the ramp leads to less, within the uncertainty of both, they are weighted by variance.
    """
    ahead, own = hold.ramp_leads_to, hold.ramp_leads_to_within
    if not SIGNIFICANT * float(np.hypot(own, uncertainty)) > initial - ahead > 0:
        return initial, uncertainty
    weight = uncertainty**2 / (own**2 + uncertainty**2)
    both = float(np.hypot(weight * own, (1 - weight) * uncertainty))
    return initial + weight * (ahead - initial), both


def _lost_in_a_decade(hold: Hold) -> float:
    """Tension lost while the time since the ramp grows tenfold, from the first step on.

    A ramp within a step or two of the log may have ended anywhere in the last step.  Relaxation
    before the first reading is not in the log; it may equal that of the decade after it.
    """
    since = shifted(hold.time, hold.ramp_end_time)
    begin = int(np.searchsorted(since, 0.0, side="right"))
    stop = int(np.searchsorted(since, 10 * since[min(begin, since.size - 1)], side="right"))
    if stop - begin < FEWEST_SAMPLES // 4:
        return 0.0
    part = slice(begin, stop)
    _, rate, _ = on_curve(since[part], hold.tension[part], float(since[begin]), noise=0.0)
    return float(abs(rate) * since[begin] * np.log(10))


def _late_load(hold: Hold, initial: float) -> _LateLoad | None:
    """Rise of the load after the end of its ramp, within one ramp time; None where there is none.

    A specimen at constant length relaxes.  The load is late if it rises by more than the remaining
    motion of the crosshead explains, and by more than a ramp adds within the uncertainty of its
    end.  Means over a tenth of a decade are used, so that noise is not taken for a rise.
    """
    if hold.ramp is None or hold.on_tension or not np.isfinite(hold.logged_peak):
        return None
    since = shifted(hold.time, hold.ramp_end_time)
    begin, stop = np.searchsorted(since, [0.0, hold.ramp.length], side="right")
    if stop - begin < SAMPLES_BESIDE:
        return None
    blocks = logarithmic_blocks(since[begin:stop], hold.tension[begin:stop], per_decade=10)
    motion = hold.motion
    value = blocks.value
    if motion.greatest and np.isfinite(hold.ramp.stiffness):
        distance = np.interp(blocks.elapsed, motion.time - hold.ramp_end_time, motion.distance)
        value = value - hold.ramp.stiffness * distance
    at = int(np.argmax(value))
    rise = float(value[at]) - initial
    end_known_to = initial * hold.ramp.end_uncertainty / hold.ramp.length
    # both levels may be rounded by half a step of the converter, away from each other
    told = SIGNIFICANT * float(np.hypot(hold.tension_noise, end_known_to)) + hold.tension_step
    # a maximum in the first block is no rise: a line through a fast relaxation ends below it
    if at == 0 or not rise > max(told, _LATE_LEAST * initial):
        return None
    return _LateLoad(rise, float(blocks.value[at]), float(blocks.elapsed[at]))


def _past_jerk(hold: Hold, ends: _Ends) -> tuple[Hold, _Ends]:
    """The hold after the swing of a crosshead that stops with a jerk, and its ends.

    Mass between specimen and load cell keeps moving when the crosshead stops: the load dips below
    its value on the ramp, comes back and swings.  A load that lags was never higher before.  The
    tension at the end of the ramp is extrapolated from the ramp; its uncertainty is the difference
    from the tension that the hold after the swing leads back to.

    Examples
    --------
    >>> t = np.linspace(0, 100, 2001)
    >>> from reduction.stages.holds.hold_selection import _Ramp
    >>> ramp = _Ramp(-10.0, 0.0, -5.0, 10.0, 0.01, 600.0)
    >>> load = 300 * (t + 1) ** -0.05 - 50 * np.exp(-t / 0.3) * np.cos(2 * np.pi * t / 0.8)
    >>> hold = Hold(t, 0 * t, load, 0 * t, 0.0, ramp, 0.01, logged_peak=314, ramp_peak=299)
    >>> swinging = _ends_of(260, 2, 238, 0.1, 10, 100, _LateLoad(54, 314, 0.4))
    >>> kept, ends = _past_jerk(hold, swinging)
    >>> print(kept.time[0], ends.initial, abs(ends.initial - 300) < 2 * ends.initial_uncertainty)
    1.6 299 True
    """
    late = ends.late
    if late is None:
        return hold, ends
    above = hold.ramp_peak - ends.initial
    begin = int(np.searchsorted(shifted(hold.time, hold.ramp_end_time), _SWINGS * late.delay))
    if not above > SIGNIFICANT * hold.tension_noise + late.rise / 4:
        return hold, ends
    if not begin < hold.time.size // 2:
        return hold, ends
    kept = replace(
        hold,
        **{name: getattr(hold, name)[begin:] for name in ("time", "position", "tension", "strain")},
        logged_peak=np.nan,
        ramp_leads_to=np.nan,
    )
    after = _hold_ends(kept)
    # an extrapolation of readings a moment apart is worthless
    is_led = 1 <= hold.ramp_leads_to / hold.ramp_peak < 1 + LARGEST_DISAGREEMENT
    initial = hold.ramp_leads_to if is_led else hold.ramp_peak
    unsure = np.hypot(after.initial_uncertainty, (initial - after.initial) / np.sqrt(3))
    hold.notes.append(
        note(
            "hold-begins-with-jerk",
            before=initial,
            lowest=float(hold.tension[:begin].min()),
            settled=_SWINGS * late.delay,
            after=after.initial,
        )
    )
    at_end = after.final, after.final_uncertainty
    counts = after.n_initial, after.n_final
    return kept, _ends_of(initial, float(unsure), *at_end, *counts, after.late)


_SWINGS = 4.0  # times from the stop to the first peak after it: two swings


_LATE_LEAST = 0.003  # of the tension: a ramp rounds its corner


_LATE_MOST = 0.02  # of the tension: above this the end of the ramp is not in the log


_LATE_MISSES = 2.0  # times the rise in the log: the specimen relaxes while the load rises


_MOTION_WORTH = 0.005  # of the tension lost: less changes no number


_MOTION_LARGE = 0.1  # of the tension lost: less is a machine that settles after its ramp


def _at_one_length(hold: Hold, ends: _Ends) -> tuple[Hold, Floats, float]:
    """The hold corrected to the length at the end of its ramp, and the uncertainty left.

    The uncertainty of the correction at every sample, with one sign, and that of the position from
    which the motion counts. [N].
    """
    motion = hold.motion
    stiffness = np.nan if hold.ramp is None else hold.ramp.stiffness
    worth = stiffness * motion.greatest
    # a crosshead that settles between two readings
    of_begin = float(np.nan_to_num(abs(stiffness) * motion.known_to))
    loss = abs(ends.initial - ends.final)
    if not abs(worth) > _MOTION_WORTH * loss:
        return hold, np.zeros_like(hold.tension), of_begin
    share = abs(worth) / loss if loss else np.inf
    found = note("hold-settles", motion=motion.greatest, worth=worth, share=share)
    # the intervals cover half of it
    hold.notes.append(replace(found, severity="note") if share < _MOTION_LARGE else found)
    since = shifted(motion.time, hold.ramp_end_time)
    left = np.interp(motion.time, hold.time, hold.tension) / ends.initial
    added = effect_of_motion(since, motion.distance, left, stiffness=stiffness)
    of_motion = np.interp(hold.time, motion.time, added)
    return replace(hold, tension=hold.tension - of_motion), MOTION_KNOWN_TO * of_motion, of_begin


def _step_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a step of tension inside the hold that is large enough to change a number.

    A crosshead that moves by one code of its encoder makes a step that the interval covers.
    """
    if hold.time.size < FEWEST_SAMPLES or not median_step_reaches(
        hold.time, 3, _longest_step(hold.time)
    ):
        return None
    # where a log thins out, the change per sample changes, which is not a step
    early, late = np.diff(hold.time[:9]), np.diff(hold.time[-9:])
    if not 1 / 3 < np.median(early) / np.median(late) < 3:
        return None
    size = -(-hold.time.size // STEP_BLOCKS)
    whole = hold.time.size // size * size
    if whole < 24 * size:
        return None
    # tension falls farther where readings are lost: a step is one on even times, too
    time, tension = (_means_of_blocks(one, whole, size) for one in (hold.time, hold.tension))
    even = np.linspace(time[0], time[-1], time.size)
    for series in (tension, np.interp(even, time, tension)):
        steps = find_steps(series, false_alarm=STEP_FALSE_ALARM, quantum=hold.tension_step)
        if not steps:
            return None
    largest = max(steps, key=lambda step: abs(step.size))
    lost = abs(ends.initial - ends.final)
    of_drop = np.nan_to_num(ends.drop_uncertainty * abs(ends.initial))
    if abs(largest.size) < max(_MOTION_WORTH * lost, of_drop / 2):
        return None
    when = even[largest.onset] - hold.start_time
    return note("hold-tension-steps", step=float(largest.size), time=float(when))


def _means_of_blocks(series: Floats, count: int, size: int) -> Floats:
    """Means of ``size`` readings each, of the first ``count``."""
    parts = sample_blocks(count, series, size=size * max(1, BLOCK // size))
    return np.concatenate([series[part].reshape(-1, size).mean(axis=1) for part in parts])


def _longest_step(time: Floats) -> float:
    return max(
        float(np.diff(time[part]).max(initial=0.0))
        for part in sample_blocks(time.size, time, overlap=1)
    )


def _motion_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a motion of the crosshead that is too uncertain to be corrected.

    Its error may be a tenth of the drop; without a ramp its effect on tension is unknown.
    """
    motion = hold.motion.greatest
    if hold.ramp is None or not np.isfinite(hold.ramp.stiffness):
        moved, worth = abs(motion) > 0.5 * hold.position_tolerance, float("nan")
    else:
        worth = abs(hold.ramp.stiffness * motion)
        moved = MOTION_KNOWN_TO * worth > max(
            0.1 * abs(ends.initial - ends.final),
            SIGNIFICANT * ends.drop_uncertainty * ends.initial,
        )
    return note("hold-crosshead-moves", motion=motion, worth=worth) if moved else None


def _start_reason(hold: Hold, ends: _Ends) -> Note | None:
    """Name a logged peak before the end of the ramp that exceeds the tension found there.

    A peak near the end is covered by the uncertainty of that tension, unless this is too small.
    """
    noise = hold.tension_noise
    spread = np.hypot(ends.initial_uncertainty, START_KNOWN_TO * ends.initial)
    limits = {
        hold.logged_peak: (1 + LARGEST_DISAGREEMENT) * ends.initial,
        hold.earlier_peak: ends.initial + SIGNIFICANT * float(np.hypot(spread, noise)),
    }
    above = [peak for peak, limit in limits.items() if peak > limit]
    if not above:
        return None
    return note("hold-start-contradicted", peak=max(above), initial=ends.initial)


def _late_reason(ends: _Ends) -> Note | None:
    """Name a load that rises after its ramp by too much for the tension at its end to be known."""
    if ends.late is None or not ends.late.rise > _LATE_MOST * ends.initial:
        return None
    return _late_note(ends.late, is_refused=True)


def _late_note(late: _LateLoad, *, is_refused: bool) -> Note:
    return note(
        "hold-load-late",
        rise=late.rise, peak=late.peak, delay=late.delay, is_refused=is_refused,
    )  # fmt: skip


LARGEST_DISAGREEMENT = 0.1
"""Fraction by which a log may peak above the tension that its hold leads back to. [1]"""


START_KNOWN_TO = 0.005
"""Standard uncertainty of a tension at the end of a ramp beyond its noise, as a fraction: the ramp
rounds its corner. [1]"""


def _reasons_against(hold: Hold, ends: _Ends, settings: HoldSettings) -> list[Note]:
    """All reasons against relaxation numbers from a hold.

    Notes
    -----
    Too short; too few samples; a load that comes late; a slack specimen; tension that rises by
    more than three standard uncertainties; a crosshead whose motion, by the stiffness of the ramp,
    leaves an uncertainty above a tenth of the drop; a log that peaks
    above the tension found at the end of the ramp; a step of tension that relaxation does not
    explain (`find_steps`, false alarm 0.1 %), above 0.5 % of the loss and half the
    standard uncertainty of the drop.

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
    late = _late_reason(ends)
    if late is not None:  # the end of the ramp is not in the log: the other tests say nothing
        return [*reasons, late]
    if not ends.final > hold.slack_tension or not ends.drop_uncertainty < 1 / SIGNIFICANT:
        reasons.append(note("hold-slack", tension=ends.final, slack_tension=hold.slack_tension))
    elif ends.drop < -SIGNIFICANT * ends.drop_uncertainty:
        reasons.append(note("hold-tension-rises", rise=-ends.drop))
    found = _motion_reason(hold, ends), _start_reason(hold, ends), _step_reason(hold, ends)
    reasons += [reason for reason in found if reason]
    return reasons


_RINGING = 0.5  # longest time over which a machine rings; rubber relaxes within a second too. [s]


def _rate(hold: Hold, ends: _Ends, *, known_to: float, of_zero: float) -> Rate | None:
    """Fraction of tension lost per decade, or None with a refusal.

    The tension due to a motion relaxes as the rest does, but is subtracted unrelaxed.  The rate is
    uncertain by that fraction, twice the uncertainty of the motion.  An even drift of the zero,
    ``of_zero``, falls mostly into the last decade.
    """
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
    of_tension = np.hypot(slope.value * 2 * known_to, of_zero) / ends.initial
    spread = float(np.hypot(slope.standard_uncertainty, of_tension))
    return Rate(-slope.value, spread, slope.elapsed_low, slope.elapsed_high)


def _prony(
    hold: Hold, ends: _Ends, settings: HoldSettings, *, of_motion: Floats, known_to: float
) -> PronyFit | None:
    """Prony series, or None with a refusal."""
    if ends.drop < SIGNIFICANT * ends.drop_uncertainty:
        hold.refusals.append(
            note("drop-not-told-from-zero", drop=ends.drop, spread=ends.drop_uncertainty)
        )
        return None
    since = shifted(hold.time, hold.ramp_end_time)
    later = int(np.searchsorted(since, 0.0, side="right"))
    blocks, shared_error = (
        logarithmic_blocks(since[later:], one[later:]) for one in (hold.tension, of_motion)
    )
    length, added = 0.0, None
    if hold.ramp is not None:
        length, added = hold.ramp.length, hold.ramp.added(ends.initial)
    try:
        fit = fit_prony(
            blocks.elapsed,
            blocks.value,
            ramp_duration=length,
            added=added,
            maximum_terms=settings.maximum_terms,
            weights=blocks.weight,
            shared_error=shared_error.value,
            time_variance=blocks.time_variance,
            known_to=known_to,
        )
    except FitError as error:
        hold.refusals.append(note("no-prony-series", reason=error.problem, found=error.found))
        return None
    modelled = _at_ramp_end(fit)
    spread = float(np.hypot(ends.initial_uncertainty, START_KNOWN_TO * ends.initial))
    if abs(modelled - ends.initial) > SIGNIFICANT * spread:
        hold.refusals.append(
            note("prony-misses-ramp-end", modelled=modelled, initial=ends.initial, spread=spread)
        )
        return None
    if added is None:
        return fit
    # more tension at the end of the ramp is more of what it left
    of_ramp = ends.initial_uncertainty / added[-1] * (1 - fit.left) / fit.left
    spread = np.hypot(fit.tension_standard_uncertainty, fit.tension * of_ramp)
    return replace(fit, tension_standard_uncertainty=spread)


def _at_ramp_end(fit: PronyFit) -> float:
    """Tension of a series at the end of the ramp. [N]."""
    return float(fit.long_time_tension + fit.tension @ fit.left)


def _creep(hold: Hold) -> Rate | None:
    """Strain per decade, or None with a refusal."""
    if hold.ramp is None:
        hold.refusals.append(note("rate-without-ramp"))
        return None
    # a creep in proportion to load counts from the centre of the load, one in proportion to strain
    # from that of the length: a hold does not show which of them it is
    centres = [hold.ramp.centre_time]
    if hold.on_tension:
        centres.append(hold.ramp.driven_centre_time)
    since, strain = shifted(hold.time, float(np.mean(centres))), hold.strain
    series = select_samples(
        lambda part: (since[part] > 0) & np.isfinite(strain[part]), since, strain, hold.tension
    )
    compliance = hold.ramp.stiffness if hold.on_tension else float("nan")
    try:
        return creep_rate(
            *series,
            ramp_duration=hold.ramp_duration,
            compliance=compliance,
            centre_known_to=float(np.ptp(centres)) / 2,
        )
    except DataError as error:
        hold.refusals.append(note("no-rate", reason=error.problem))
        return None


def _describe(hold: Hold, rate: Rate | None, *, follows_hold: bool) -> None:
    """Say how the ramp was treated and what was left out."""
    if hold.ramp is not None:
        added = "length" if hold.on_tension else "tension"
        hold.made.append(
            f"ramp of {hold.ramp.end_time - hold.ramp.start_time:.3g} s; it acts as a step "
            f"{hold.ramp.end_time - hold.ramp.centre_time:.3g} s before the hold (centre of the "
            f"{added} it adds) and counts as {hold.ramp.duration:.3g} s at constant rate"
        )
    if rate is not None:
        hold.made.append(
            f"rate per decade from {rate.elapsed_low:.3g} to {rate.elapsed_high:.3g} s after "
            + ("the mean of the centres of length and load" if hold.on_tension else "the centre")
            + " of the ramp"
        )
    left_out = hold.n_logged - hold.time.size
    if left_out > 0:
        hold.notes.append(
            note("hold-samples-left-out", n_left_out=left_out, n_samples=hold.n_logged)
        )
    if follows_hold:
        hold.made.append("relaxation from an earlier hold continues during this one")


def _with_delay(
    hold: Hold, found: tuple[Floats, Floats], times: Floats, delay: float
) -> tuple[Floats, Floats]:
    """Tension at stated times, with its loss during the possible delay of the load.

    No value is given before that: the load has not arrived yet.
    """
    value, spread = (np.where(times > delay, one, np.nan) for one in found)
    later, _ = value_at_times(shifted(hold.time, hold.ramp_end_time), hold.tension, times + delay)
    lost = np.nan_to_num(value - later) / np.sqrt(3)
    return value, np.hypot(spread, lost)


def _with_motion(read: _Ends, kept: _Ends, unknown: float) -> _Ends:
    """Ends as they are read, with the drop at constant length and its uncertainty."""
    known_to = max(kept.drop_uncertainty, read.drop_uncertainty)
    spread = float(np.hypot(known_to, unknown / read.initial))
    return replace(read, drop=kept.drop, drop_uncertainty=spread)


def _less_known(fit: PronyFit, unknown: float) -> PronyFit:
    """A series widened by an uncertainty of unknown course, divided among its terms by size."""
    share = fit.tension / fit.tension.sum()
    return replace(
        fit,
        tension_standard_uncertainty=np.hypot(fit.tension_standard_uncertainty, share * unknown),
        long_time_tension_standard_uncertainty=float(
            np.hypot(fit.long_time_tension_standard_uncertainty, unknown)
        ),
    )


def _result(
    hold: Hold,
    *,
    name: str,
    kind: str,
    settings: HoldSettings,
    follows_hold: bool,
    at_slack: LoadAtSlack | None,
) -> HoldResult:
    """Reduce one hold of one specimen."""
    times = np.array(settings.times, dtype=np.float64)
    nothing = np.full(times.size, np.nan)
    drop = Rate(np.nan, np.nan, np.nan, np.nan)
    rate: Rate | None = None
    prony: PronyFit | None = None
    modelled = np.nan
    tension_at = strain_at = (nothing, nothing)
    ends = _Ends(*(np.nan,) * 6)
    times_known, known = select_samples(
        lambda part: np.isfinite(hold.strain[part]), hold.time, hold.strain
    )
    if hold.time.size < 3:
        hold.refusals.append(note("hold-empty", n_samples=hold.time.size))
    else:
        ends = _hold_ends(hold)
        if kind == "relaxation":
            hold, ends = _past_jerk(hold, ends)
        hold.made.append(
            f"initial tension is that of a line through the first {ends.n_initial} samples at the "
            f"end of the ramp, final tension that of a line over the logarithm of time through the "
            f"last {ends.n_final} of {hold.time.size}"
        )
        unsure = 0.0 if hold.ramp is None else hold.ramp.end_uncertainty
        tension_at = value_at_times(
            shifted(hold.time, hold.ramp_end_time), hold.tension, times, begin_uncertainty=unsure
        )
        if known.size > 1:
            strain_at = value_at_times(
                shifted(times_known, hold.ramp_end_time), known, times, begin_uncertainty=unsure
            )
        reasons = _reasons_against(hold, ends, settings) if kind == "relaxation" else []
        if kind == "relaxation" and not reasons and hold.ramp_is_within_steps:
            hold.notes.append(note("hold-ramp-within-steps"))
        hold.refusals.extend(reasons)
        late = ends.late
        if kind == "relaxation" and late is not None:
            hold = replace(hold, logged_peak=max(hold.logged_peak, late.peak))
            tension_at = _with_delay(hold, tension_at, times, late.delay)
            if _late_reason(ends) is not None:
                ends = replace(ends, initial=np.nan, initial_uncertainty=np.nan)
            else:
                told = _late_note(late, is_refused=False)
                # of a stop between a ramp and cycles, too, but no drop is given there
                hold.notes.append(replace(told, severity="note") if reasons else told)
        if kind == "creep":
            rate = _creep(hold)
        elif not reasons:
            kept, correction_known_to, of_begin = _at_one_length(hold, ends)
            of_motion = float(np.hypot(correction_known_to[-1], of_begin))
            of_zero = 0.0 if at_slack is None else at_slack.drift_within(hold.duration)
            unknown = float(np.hypot(of_motion, of_zero))
            ends = _with_motion(ends, ends if kept is hold else _hold_ends(kept), unknown)
            drop = Rate(ends.drop, ends.drop_uncertainty, np.nan, np.nan)
            rate = _rate(kept, ends, known_to=of_motion, of_zero=of_zero)
            prony = _prony(kept, ends, settings, of_motion=correction_known_to, known_to=unknown)
            if prony is not None:
                modelled = _at_ramp_end(prony)
                prony = _less_known(prony, float(np.hypot(of_begin, of_zero)))
    _describe(hold, rate, follows_hold=follows_hold)
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
        prony_fraction_at_ramp_end=_EMPTY if prony is None else prony.left,
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
        ramp_end_time=np.nan if hold.ramp is None else hold.ramp.end_time,
        ramp_duration=np.nan if hold.ramp is None else hold.ramp.duration,
        logged_peak_tension=hold.logged_peak,
        ramp_end_tension=modelled,
        hold_strain_standard_uncertainty=hold.strain_uncertainty,
        hold_initial_tension_standard_uncertainty=ends.initial_uncertainty,
        hold_final_tension_standard_uncertainty=ends.final_uncertainty,
        tension_at_time_standard_uncertainty=tension_at[1],
        strain_at_time_standard_uncertainty=strain_at[1],
        is_unloading=hold.ramp is not None and not hold.ramp.tension.size,
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
    at_slack: Sequence[LoadAtSlack | None] = (),
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
    at_slack : sequence of LoadAtSlack or None, optional
        Reading of each load cell at slack; where it moves, so may the tension within a hold.

    Returns
    -------
    results : tuple of HoldResult
        By hold, then by specimen; NaN where refused, with the reason in ``refusals``.

    Raises
    ------
    DataError
        If time and position differ in length.

    Notes
    -----
    Source: WHOI-2005-10, sec. 4.1 and Figure 24 ([1]_), which calls relaxation "creep".
    The zero of time for rates is the centre of the added tension or, where the
    machine controls the tension, of the added length; for
    ``times`` it is the first sample of the hold.  The Prony terms are corrected for the
    ramp by the tension that it adds.  Uncertainties are type A.  Cost grows
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
    results = []
    for index in np.flatnonzero(~standstills.is_rest):
        earlier = bool(index) and not standstills.is_rest[index - 1]
        for name, load, stretch, slack in zip(
            specimens, loads, stretches, at_slack or (None,) * len(specimens), strict=True
        ):
            hold = select_hold(seconds, place, load, stretch, standstills, int(index))
            results.append(
                _result(
                    hold,
                    name=name,
                    kind=kind,
                    settings=settings,
                    follows_hold=earlier,
                    at_slack=slack,
                )
            )
    return tuple(results)

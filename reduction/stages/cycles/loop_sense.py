r"""Loops that run the wrong way round, and effect of the drift of cycles on their energy.

In a passive specimen tension rises with stretch and leads it.  Where it falls with stretch, one
channel has the wrong sign; where it rises and lags, tension was logged late, by

.. math:: \ell \ge -\delta / (2 \pi f)

with the angle :math:`\delta` of the loop, or something in the specimen does work.  A single
frequency does not distinguish these two, but the known lag of the channels may.

References
----------
.. [1] J. D. Ferry, *Viscoelastic Properties of Polymers*, 3rd ed., Wiley, New York, 1980, ch. 1
   (stress leads strain by the loss angle).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Literal

import numpy as np

from reduction.record.arrays import MAD_TO_DEVIATION, evenly_spread, finite_median
from reduction.record.measurement import Bools, Floats
from reduction.record.notes import Note, note
from reduction.record.samples import take_samples
from reduction.stages.cycles.cycle_product import PLACE_OF_DRIFT, Cycles, Loops
from reduction.stages.cycles.periods import touching
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.standstills import Standstills

_OF_A_SPECIMEN = (
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant", "loss_factor", "fundamental_energy_share", "closed_loop_energy",
)  # fmt: skip

_WITHIN = 2.0  # standard uncertainties

_BEYOND_SCATTER = 3.0

_DRIFT_TOLD = 0.02  # of the energy

_FEWEST_DRIFTING, _SETTLING = 24, 0.1  # for a drift of clocks; fraction of cycles omitted at first

_EVEN = 0.5  # least ratio of the slopes of both halves of the cycles

_STIFFNESS_STAYS = 0.1  # greatest relative change of EA over that of the energy

_WAVE_STAYS = 0.2  # relative, of frequency times both amplitudes

_LEAST_LOSS = 1e-3  # loss factor that no rubber or fibre comes near

_FRICTION = 2.0  # loss over the fall of tension with stretch: less may be damping besides inertia

_PLACED = 0.5  # of the uncertainty of the work of a drift whose place in the cycles is unknown


def without_backward_loops(loops: Loops) -> Loops:
    """Leave out results that do not describe a specimen, where tension falls with stretch.

    Parameters
    ----------
    loops : Loops
        From `reduction.stages.cycles.loops`. [SI]

    Returns
    -------
    loops : Loops
        With NaN for stiffness, energy and loss of such specimens; means, amplitudes, frequency and
        the fundamental over time are kept as logged. For friction that falls with stretch
        only the loss factor is left out.

    Examples
    --------
    >>> one = {name: np.ones((1, 2)) for name in Loops.__dataclass_fields__}
    >>> loops = Loops(**one | {"storage_over_time": np.full((1, 2), -8.0), "uncertainty": {}})
    >>> print(without_backward_loops(loops).apparent_spring_constant)
    [[nan nan]]
    """
    backward = _runs_backward(loops)
    falls = np.array([finite_median(row) < 0 for row in loops.storage_over_time], dtype=bool)
    if not falls.any():
        return loops
    kept = {
        name: ~(falls if name == "loss_factor" else backward)[:, None] for name in _OF_A_SPECIMEN
    }
    return replace(
        loops,
        **{name: np.where(kept[name], getattr(loops, name), np.nan) for name in _OF_A_SPECIMEN},
        uncertainty=loops.uncertainty
        | {
            name: np.where(kept[name], loops.uncertainty[name], np.nan)
            for name in _OF_A_SPECIMEN
            if name in loops.uncertainty
        },
    )


def contradicts_sine(loops: Loops) -> Bools:
    """Specimens whose loops are not those of a sine, shape (n_specimens,).

    Where the driven channel is a sine, the energy of a loop is that of the fundamentals alone,
    whatever the other channel does.  A rise of different duration than the fall turns the curvature
    of an elastic specimen into a loss, over time; its energy has none.  For a specimen
    with hardly any loss, a difference that is small compared with its stiffness is no
    contradiction: splices between it and the machine distort its strain.

    Examples
    --------
    >>> one = {name: np.ones((1, 9)) for name in Loops.__dataclass_fields__} | {"uncertainty": {}}
    >>> fundamentals = {"fundamental_energy_share": np.full((1, 9), 2.5)}
    >>> contradicts_sine(Loops(**one)), contradicts_sine(Loops(**one | fundamentals))
    (array([False]), array([ True]))
    """
    over_time, share = loops.loss_over_time, loops.fundamental_energy_share
    told = np.zeros(over_time.shape[0], dtype=bool)
    for row, (lost, of_energy) in enumerate(zip(over_time, share, strict=True)):
        known = np.isfinite(lost) & np.isfinite(of_energy) & (of_energy != 0)
        if known.sum() < _FEWEST_CYCLES:
            continue
        by_energy = lost[known] / of_energy[known]
        apart = lost[known] - by_energy
        scatter = float(apart.std()) / np.sqrt(known.sum() - 1)
        greater = max(abs(finite_median(lost[known])), abs(finite_median(by_energy)))
        least = _SINE_LEAST * abs(finite_median(loops.storage_over_time[row]))
        told[row] = abs(finite_median(apart)) > max(
            _SINE_TOLD * greater, _BEYOND_SCATTER * scatter, least
        )
    return told


def unlike_neighbours(
    time: Floats, driven: Floats, cycles: Cycles, standstills: Standstills
) -> float:
    r"""Difference between the wave of a cycle and that of the cycle before it; 0 if it repeats.

    .. math:: x_{k+1}(\varphi) \approx a + b \varphi + c \, x_k(\varphi)

    Parameters
    ----------
    time, driven : ndarray, shape (n_samples,)
        [s], and position or tension. [m] or [N]
    cycles : Cycles
        Cycles of the record.
    standstills : Standstills
        Standstills of the record.

    Returns
    -------
    share : float
        Root mean square of the residual, or the scatter of the steps of its middle, over half the
        range: the greater one; 0 where readings, their noise or chance explain it. [1]

    Notes
    -----
    The median over some forty pairs at equal fractions of their durations.  A drifting mean, a
    growing amplitude and a frequency sweep leave no residual; a second frequency does.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import (find_cycles)
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 120, 0.05)
    >>> def told(wave):
    ...     stands = find_standstills(time, wave, wave[None], settings=PhaseSettings())
    ...     cycles = find_cycles(time, wave, wave[None], stands, settings=CycleSettings())
    ...     return unlike_neighbours(time, wave, cycles, stands)
    >>> print(told(np.cos(time)), told(np.cos(time) + 0.2 * np.cos(3.7 * time)) > 0.2)
    0.0 True
    """
    follows = touching(cycles)
    threes = np.flatnonzero(follows[1:-1] & follows[2:])
    if threes.size >= _FEWEST_CYCLES - 1:
        # from middle to middle of the rises, which noise and rests at the turns do not shift
        which = (evenly_spread(threes, _MOST_CYCLES)[:, None] + np.arange(3)).ravel()
        edges = cycles.branch_first[which, 0], cycles.branch_last[which, 0] + 1
        begins = [
            _crossing(time[first:stop], driven[first:stop])
            for first, stop in zip(*(one.tolist() for one in edges), strict=True)
        ]
        pairs = np.array(begins).reshape(-1, 3)
    else:  # cycles that no similar one follows, while the machine goes on about their middle
        ends = np.stack([cycles.first, cycles.last, 2 * cycles.last - cycles.first], axis=1)
        stop = ends[:, 1] + _GOES_ON * (ends[:, 1] - ends[:, 0])
        goes_on = [
            end < driven.size and not standstills.covers(slice(first, end)).any()
            for first, end in zip(cycles.first.tolist(), stop.tolist(), strict=True)
        ]
        some = evenly_spread(
            np.column_stack([ends, stop])[np.array(goes_on, dtype=bool)], _MOST_CYCLES
        )
        crosses = [
            _crosses(driven[second:end], driven[first:last])
            for first, last, second, end in some.tolist()
        ]
        pairs = take_samples(time, some[np.array(crosses, dtype=bool), :3])
        # after a cycle that is stored alone the log continues with one of another time
        own, following = np.diff(pairs, axis=1).T
        pairs = pairs[following < _GAP * own]
    phase = np.linspace(0, 1, _PHASES, endpoint=False)
    left, gone, noise = [], [], []
    for times in pairs:
        begin, end = np.searchsorted(time, times[[0, 2]], side="right").tolist()
        part = slice(max(begin - 1, 0), end + 1)
        one, other = (
            np.interp(low + phase * (high - low), time[part], driven[part])
            for low, high in pairwise(times)
        )
        half = float(np.ptp(one)) / 2
        if not (half > 0 and np.isfinite(one + other).all()):
            continue
        left.append(float(np.sqrt(np.mean(_beside(one, other, phase) ** 2))) / half)
        gone.append((other.max() + other.min() - one.max() - one.min()) / (4 * half))
        noise.append(reading_noise(driven[part]) / half)
    if not left:
        return 0.0
    scatter = MAD_TO_DEVIATION * finite_median(np.abs(np.array(gone) - np.median(gone)))
    share = max(float(np.median(left)), scatter)
    n_readings = float(np.median(cycles.last - cycles.first))
    # a turn is uncertain by up to half a reading
    by_chance = _REPEATS + np.pi / n_readings + _BEYOND_SCATTER * float(np.median(noise))
    return share if share > by_chance else 0.0


def change_of_wave(time: Floats, driven: Floats, cycles: Cycles) -> tuple[float, int, int] | None:
    """Lasting change of the shape of the wave, between two cycles of a test; None without one.

    Parameters
    ----------
    time, driven : ndarray, shape (n_samples,)
        [s], and position or tension. [m] or [N]
    cycles : Cycles
        Cycles of the record.

    Returns
    -------
    share : float
        Root mean square of the difference over half the range. [1]
    last, first : int
        Last cycle with the old shape and first one with the new, among those examined. [1]

    Notes
    -----
    Some forty cycles at equal phases, from middle to middle of their rises. The place is that of
    least squares; the medians of those before and after it, three or more, differ.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import (find_cycles)
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 120, 0.05)
    >>> wave = np.where(time < 60, 1 - 2 * np.abs(time / 6 % 2 - 1), -np.cos(np.pi * time / 6))
    >>> stands = find_standstills(time, wave, wave[None], settings=PhaseSettings())
    >>> cycles = find_cycles(time, wave, wave[None], stands, settings=CycleSettings())
    >>> share, last, first = change_of_wave(time, wave, cycles)
    >>> print(round(share, 2), last, first)
    0.08 4 5
    """
    places = evenly_spread(np.flatnonzero(touching(cycles)[1:]), _MOST_CYCLES)
    phase = np.linspace(0, 1, _PHASES, endpoint=False)
    waves, at, noise = [], [], []
    for one in places.tolist():
        begin, end = (
            _crossing(time[part], driven[part])
            for part in (
                slice(cycles.branch_first[place, 0], cycles.branch_last[place, 0] + 1)
                for place in (one, one + 1)
            )
        )
        low, high = np.searchsorted(time, [begin, end]).tolist()
        part = slice(low - 1, high + 1)
        wave = np.interp(begin + phase * (end - begin), time[part], driven[part])
        half = float(np.ptp(wave)) / 2
        if half > 0 and np.isfinite(wave).all():
            waves.append((wave - wave.mean()) / half)
            noise.append(reading_noise(driven[part]) / half)
            at.append(one)
    if len(waves) < 2 * _FEWEST_CYCLES:
        return None
    shapes, count = np.array(waves), len(waves)
    stops = np.arange(_FEWEST_CYCLES, count - _FEWEST_CYCLES + 1)
    apart = [_of_parts(np.mean, shapes, stop, phase) for stop in stops.tolist()]
    stop = int(stops[np.argmax(stops * (count - stops) * np.square(apart))])
    share = _of_parts(np.median, shapes, stop, phase)
    n_readings = float(np.median(cycles.last - cycles.first))
    # noise of two medians, and the chords between the readings of a sine
    by_noise = _WITHIN * float(np.median(noise)) * np.sqrt(1 / stop + 1 / (count - stop))
    least = float(np.hypot(_REPEATS + (2 * np.pi / n_readings) ** 2 / 8, by_noise))
    return (share, at[stop - 1], at[stop]) if share > least else None


def missed_between_changes(time: Floats, driven: Floats, cycles: Cycles) -> float:
    """Share of half the range that a log of changes may miss at its turns; 0 for other logs. [1].

    A logger that stores a reading only after a change stores no smaller step, and waits longest at
    the turns: lines beside them, through evenly counted readings, do not lead to the turn.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import find_cycles
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 60, 0.01)
    >>> wave = 1 - 2 * np.abs(time / 6 % 2 - 1)
    >>> kept = [0]
    >>> for place, value in enumerate(wave):
    ...     if abs(value - wave[kept[-1]]) > 0.12:
    ...         kept.append(place)
    >>> t, x = time[kept], wave[kept]
    >>> stands = find_standstills(t, x, x[None], settings=PhaseSettings())
    >>> cycles = find_cycles(t, x, x[None], stands, settings=CycleSettings())
    >>> print(round(missed_between_changes(t, x, cycles), 2))
    0.13
    """
    some = evenly_spread(np.arange(cycles.n_cycles), _MOST_CYCLES)
    first, last, peak = cycles.first[some], cycles.last[some], cycles.branch_last[some, 0]
    # a turn is beside its extreme reading, before it or after it; one may be near a reading
    waits = np.diff(time[first[0] : last[-1] + 1], prepend=np.nan, append=np.nan)
    waits = np.fmax(waits[:-1], waits[1:])
    longest = max(np.median(waits[at - first[0]]) for at in (peak, last))
    if not longest > _LONGER_WAIT * np.median(waits):
        return 0.0
    part = driven[first[0] : last[-1] + 1]
    steps = np.abs(np.diff(part))
    least, middle = np.nanquantile(steps, [_RARE, 0.5])
    reach = np.median(np.abs(driven[peak] - driven[first])) / 2
    return float(least / reach) if least > _ALL_ALIKE * middle else 0.0


_LONGER_WAIT = 1.2  # times the usual time between readings

_RARE, _ALL_ALIKE = 0.05, 0.7  # share of smaller steps, and their size over the usual one


def _of_parts(middle: Callable[..., Floats], shapes: Floats, stop: int, phase: Floats) -> float:
    """Root mean square between the mean or median shapes before and from a cycle on."""
    one, other = middle(shapes[:stop], axis=0), middle(shapes[stop:], axis=0)
    return float(np.sqrt(np.mean(_beside(one, other, phase) ** 2)))


def _beside(one: Floats, other: Floats, phase: Floats) -> Floats:
    """What a factor times one wave, a constant and a line leave of another."""
    basis = np.stack([np.ones(phase.size), phase, one], axis=1)
    return np.asarray(other - basis @ np.linalg.lstsq(basis, other)[0])


def _crosses(values: Floats, wave: Floats) -> bool:
    """Whether values lie on both sides of the middle of a wave: a ramp away from it does not."""
    middle = (np.fmax.reduce(wave) + np.fmin.reduce(wave)) / 2
    return bool(np.fmin.reduce(values) < middle < np.fmax.reduce(values))


_PHASES = 64

_GOES_ON = 3  # durations of a cycle

_GAP = 1.3  # ratio of durations for equal numbers of readings


def _crossing(time: Floats, rise: Floats) -> float:
    """Time at which a rise first reaches its middle. [s]."""
    known = np.isfinite(rise)  # an unused reading may lie next to the middle
    time, rise = time[known], rise[known]
    level = (rise.min() + rise.max()) / 2
    after = max(int(np.argmax(rise >= level)), 1)
    return float(np.interp(level, rise[after - 1 : after + 1], time[after - 1 : after + 1]))


_REPEATS = 0.03  # of half the range; a machine repeats its wave to a hundredth

OPEN = 0.1
"""Of half a range: a cycle farther than this from a closed loop has no loss."""


def without_loss(loops: Loops) -> Loops:
    """Leave out energy and loss of cycles that are not closed loops.

    Parameters
    ----------
    loops : Loops
        From `reduction.stages.cycles.loops`. [SI]

    Returns
    -------
    loops : Loops
        With NaN for energy, loss and loss factor.

    Examples
    --------
    >>> one = {name: np.ones((1, 2)) for name in Loops.__dataclass_fields__} | {"uncertainty": {}}
    >>> print(without_loss(Loops(**one)).hysteresis_energy)
    [[nan nan]]
    """
    gone = {name: np.full_like(getattr(loops, name), np.nan) for name in _OF_LOSS}
    known = {name: gone[name] for name in _OF_LOSS if name in loops.uncertainty}
    return replace(loops, **gone, uncertainty=loops.uncertainty | known)


_OF_LOSS = (
    "hysteresis_energy", "loss_spring_constant", "loss_factor", "fundamental_energy_share",
    "closed_loop_energy",
)  # fmt: skip

_MOST_CYCLES = 40  # that are examined, spread over the test

_FEWEST_READINGS = 10  # of a cycle whose shape can be determined

_LIKE_LINES, _UNLIKE_LINES = 0.06, 0.09  # of half the range, root mean square: a twentieth at rest

_LIKE_SINE = 0.03  # a symmetrical trapezoid has 0.033 at least


def waveform_of_log(
    time: Floats, driven: Floats, cycles: Cycles
) -> Literal["triangular", "sinusoidal", "other", ""]:
    """Determine the waveform of a test from the channel that the machine drives.

    Parameters
    ----------
    time, driven : ndarray, shape (n_samples,)
        [s], and position or tension. [m] or [N]
    cycles : Cycles
        Cycles of the record.

    Returns
    -------
    waveform : str
        ``triangular`` where two straight lines from turn to turn fit, ``sinusoidal`` where a sine
        does, ``other`` where neither comes near, as for ramps with dwells; empty in between, and
        where there are too few readings.

    Notes
    -----
    The median over some forty cycles. A symmetrical trapezoid that rests for a quarter to a third
    of its time has the root mean square of a sine, and 0.03 to 0.05 of harmonics.

    Examples
    --------
    >>> from reduction.record.settings import CycleSettings, PhaseSettings
    >>> from reduction.stages.cycles.cycle_search import (find_cycles)
    >>> from reduction.stages.standstills import find_standstills
    >>> time = np.arange(0, 60, 0.1)
    >>> def told(wave):
    ...     stands = find_standstills(time, wave, wave[None], settings=PhaseSettings())
    ...     cycles = find_cycles(time, wave, wave[None], stands, settings=CycleSettings())
    ...     return waveform_of_log(time, wave, cycles)
    >>> triangle = np.abs((time / 5) % 2 - 1)
    >>> print(told(triangle), told(np.cos(time)), told(np.clip(triangle, 0.15, 0.85)))
    triangular sinusoidal other
    """
    some = evenly_spread(np.arange(cycles.n_cycles), _MOST_CYCLES)
    apart = np.array([
        _apart_from_shapes(time[first : last + 1], driven[first : last + 1])
        for first, last in zip(cycles.first[some].tolist(), cycles.last[some].tolist(), strict=True)
    ]).reshape(-1, 4)  # fmt: skip
    apart = apart[np.isfinite(apart).all(axis=1)]
    if not apart.size:
        return ""
    lines, inside, sine, noise = np.median(apart, axis=0).tolist()
    if lines < _LIKE_LINES and lines < sine:
        return "triangular"
    if sine < _LIKE_SINE:
        return "sinusoidal"
    # near a turn between two readings, a reading is on the line of the other stroke
    is_far = inside > _UNLIKE_LINES + _WITHIN * noise and sine > _LIKE_SINE + _WITHIN * noise
    return "other" if is_far else ""


def _apart_from_shapes(time: Floats, driven: Floats) -> tuple[float, float, float, float]:
    """Root mean square about two lines, inside their turns and about a sine, and noise.

    All are divided by half the range.
    """
    known = np.isfinite(driven)
    t, x = time[known], driven[known]
    if t.size < _FEWEST_READINGS or not np.ptp(x) > 0 or not t[-1] > t[0]:
        return np.nan, np.nan, np.nan, np.nan
    half = float(np.ptp(x)) / 2
    turn = int(np.argmax(np.abs(x - x[0])))
    lines = np.interp(t, t[[0, turn, -1]], x[[0, turn, -1]])
    phase = 2 * np.pi * (t - t[0]) / (t[-1] - t[0])
    basis = np.stack([np.ones(t.size), np.cos(phase), np.sin(phase)], axis=1)
    sine = basis @ np.linalg.lstsq(basis, x)[0]
    about = [x - lines, x - sine]
    strokes = slice(1, turn), slice(turn + 1, t.size - 1)
    if _FEWEST_INSIDE < min(turn, t.size - 1 - turn) < _MATTERS:
        chords = (np.interp(t[one], t[one][[0, -1]], x[one][[0, -1]]) for one in strokes)
        inside = np.concatenate([x[one] - line for one, line in zip(strokes, chords, strict=True)])
    else:
        inside = about[0]
    of_lines, of_inside, of_sine = (
        float(np.sqrt(np.mean(one**2))) / half for one in (about[0], inside, about[1])
    )
    return of_lines, min(of_inside, of_lines), of_sine, reading_noise(x) / half


_FEWEST_INSIDE = 4  # readings of a stroke

_MATTERS = 20  # readings of a stroke: with fewer, one at a turn is far off, by a tenth

_SINE_TOLD = 0.05  # of the loss: no machine makes a sine to one per cent

_SINE_LEAST = 5e-4  # of the storage: no lag is known to this fraction of a radian

_FEWEST_CYCLES = 3


def _least_delay(loops: Loops, row: int) -> float:
    """Delay of tension that explains a negative energy: of a sine; of ramps a quarter more. [s].

    The fundamental over time does not show it: bent elastic loops under unequal strokes turn it.
    """
    frequency, tension, strain, energy = (
        finite_median(getattr(loops, one)[row])
        for one in ("frequency", "tension_amplitude", "strain_amplitude", "hysteresis_energy")
    )
    sine = min(max(-energy / (np.pi * tension * strain), 0.0), 1.0)
    return float(np.arcsin(sine)) / (2 * np.pi * frequency)


def _drift_of_lag(loops: Loops, row: int, *, stated: float) -> tuple[float, float]:
    """Change of the lag of tension over a test, and its duration; NaN where none shows. [s].

    The loops widen or narrow by as much in the first half of the cycles as in the second, by more
    than the stated lag, while EA and the wave are constant.  A specimen that settles changes less
    and less, and one that heats or wears usually changes its stiffness too.
    """
    energy, stiffness = loops.hysteresis_energy[row], loops.apparent_spring_constant[row]
    swing = loops.frequency[row] * loops.tension_amplitude[row] * loops.strain_amplitude[row]
    with np.errstate(divide="ignore", invalid="ignore"):
        lag = energy / (2 * np.pi**2 * swing)
    known = np.flatnonzero(np.isfinite(lag) & np.isfinite(stiffness))
    if known.size < _FEWEST_DRIFTING:
        return np.nan, np.nan
    known = known[int(_SETTLING * known.size) :]
    time, lag = loops.cycle_start_time[row, known], lag[known]
    time = time - time[0]
    is_late = np.arange(known.size) >= known.size // 2
    slopes, errors = zip(*(_slope(time[one], lag[one]) for one in (~is_late, is_late)), strict=True)
    slope, error = _slope(time, lag)
    change = slope * float(time[-1])
    mean = float(np.median(lag))
    softens = _slope(time, stiffness[known])[0] * time[-1] / float(np.median(stiffness[known]))
    # in a sweep the energy changes with the wave
    swings = _slope(time, swing[known])[0] * time[-1] / float(np.median(swing[known]))
    shows = (
        slopes[0] * slopes[1] > 0
        and min(np.abs(slopes)) > max(_EVEN * max(np.abs(slopes)), _BEYOND_SCATTER * max(errors))
        and abs(slope) > _BEYOND_SCATTER * error
        and abs(change) / 2 > max(stated, _DRIFT_TOLD * abs(mean))
        and abs(softens * mean) < _STIFFNESS_STAYS * abs(change)
        and abs(swings) < _WAVE_STAYS
    )
    return (change, float(time[-1])) if shows else (np.nan, np.nan)


def _slope(x: Floats, y: Floats) -> tuple[float, float]:
    """Slope of a straight line, and its standard error."""
    away = x - x.mean()
    slope = float(away @ y / (away @ away))
    residual = y - y.mean() - slope * away
    return slope, float(np.sqrt(residual @ residual / (x.size - 2) / (away @ away)))


def notes_of_loops(
    loops: Loops,
    *,
    names: Sequence[str],
    lag: Sequence[float],
    time_step: float,
    is_sinusoidal: bool = False,
) -> tuple[Note, ...]:
    """Notes on channels and specimens from loops: running backward, late, or giving work.

    Parameters
    ----------
    loops : Loops
        From `reduction.stages.cycles.loops`. [SI]
    names : sequence of str, length n_specimens
        Names of the specimens.
    lag : sequence of float, length n_specimens
        Standard uncertainty of the lag of tension, 0 if none is stated. [s]
    time_step : float
        Time between two samples. [s]
    is_sinusoidal : bool, optional
        Whether the waveform is stated as a sine.

    Returns
    -------
    notes : tuple of Note

    Notes
    -----
    Source of the sense: [1]_.  Loops give out work where the mean of their energy is negative by
    more than three times its scatter.

    Examples
    --------
    Tension that follows strain by 0.1 rad at 2 Hz, 8 ms, which is half a sample:

    >>> one = {name: np.ones((1, 9)) for name in Loops.__dataclass_fields__}
    >>> found, = notes_of_loops(
    ...     Loops(**one | {"frequency": np.full((1, 9), 2.0), "uncertainty": {},
    ...         "hysteresis_energy": np.full((1, 9), -0.31), "closed_loop_energy":
    ...         np.full((1, 9), -0.31), "loss_over_time": np.full((1, 9), -0.1)}),
    ...     names=["rope"], lag=[0.0], time_step=0.016)
    >>> print(found.code, round(found.numbers["delay"], 4), found.numbers["cause"])
    loops-give-work 0.0079 sampling
    """
    backward = _runs_backward(loops)
    not_of_sine = contradicts_sine(loops) & is_sinusoidal
    not_placed = loops.drift_not_placed()
    told: list[Note] = []
    for row, (name, stated) in enumerate(zip(names, lag, strict=True)):
        tension, strain, storage = (
            finite_median(getattr(loops, one)[row])
            for one in ("mean_tension", "mean_strain", "storage_over_time")
        )
        if backward[row]:
            channel = _channel_that_runs_backward(tension, strain)
            told.append(
                note("loops-run-backward", name, slope=storage, tension=tension, strain=strain,
                     channel=channel)
            )  # fmt: skip
            continue
        if not_of_sine[row]:
            share = finite_median(loops.fundamental_energy_share[row])
            told.append(note("loops-not-of-a-sine", name, share=share, effect=share - 1))
        energy = loops.hysteresis_energy[row]
        known = energy[np.isfinite(energy)]
        if not known.size:
            continue
        mean, scatter = float(known.mean()), float(known.std()) / np.sqrt(max(known.size - 1, 1))
        if mean < -_BEYOND_SCATTER * scatter:
            delay = _least_delay(loops, row)
            cause = (
                "lag" if delay <= _WITHIN * stated
                else "sampling" if not stated and delay <= time_step
                else "driven"
            )  # fmt: skip
            found = note(
                "loops-give-work", name, energy=mean, n_cycles=int((known < 0).sum()),
                n_known=known.size, delay=delay, stated=stated, time_step=time_step, cause=cause,
            )  # fmt: skip
            # the interval of the energy includes the stated lag, and contains zero
            told.append(replace(found, severity="note") if cause == "lag" else found)
        change, duration = _drift_of_lag(loops, row, stated=stated)
        if np.isfinite(change):
            half = np.pi**2 * change * finite_median(
                loops.frequency[row] * loops.tension_amplitude[row] * loops.strain_amplitude[row]
            )  # fmt: skip
            told.append(
                note(
                    "loops-widen-evenly", name, change=change, rate=change / duration,
                    first=mean - half, last=mean + half, effect=half / abs(mean),
                )
            )  # fmt: skip
        # in a first cycle the ramp before it makes most of the drift, and little of the mean
        later = np.flatnonzero(np.isfinite(energy))[int(known.size > 2) :]
        mean = float(energy[later].mean())
        closed = float(np.nanmean(loops.closed_loop_energy[row, later]))
        # in an elastic specimen any drift is many times the loss
        elastic = np.pi * abs(storage) * finite_median(loops.strain_amplitude[row]) ** 2
        least = max(_DRIFT_TOLD * abs(mean), _BEYOND_SCATTER * scatter, _LEAST_LOSS * elastic)
        if abs(closed - mean) > least:
            effect = (closed - mean) / abs(mean)
            found = note("drift-in-energy", name, energy=mean, closed=closed, effect=effect)
            # cycles of unequal drift and equal loss show that the correction is right
            is_placed = not_placed[row] < _PLACED / PLACE_OF_DRIFT
            told.append(replace(found, severity="note") if is_placed else found)
    return tuple(told)


def _runs_backward(loops: Loops) -> Bools:
    """Specimens whose tension falls with stretch in most cycles, except by friction.

    A reversed channel also turns the loop round: a loop that takes up energy, and much more of it
    than its slope stores, is due to friction.
    """
    pairs = zip(loops.storage_over_time, loops.loss_over_time, strict=True)
    middle = np.array(
        [[finite_median(store), finite_median(loss)] for store, loss in pairs]
    ).reshape(-1, 2)
    return np.asarray(middle[:, 0] < -np.fmax(middle[:, 1], 0) / _FRICTION)


def _channel_that_runs_backward(tension: float, strain: float) -> str:
    """Channel that the means point to: a specimen pulls, and at a length above its own."""
    if tension > 0 > strain:
        return "crosshead_position"
    if strain > 0 > tension:
        return "tension"
    return ""

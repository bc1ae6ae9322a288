"""Cycles of a test between the reversals of its driven channel, and the phases of its samples.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.quantities.flags import BRANCH_VALUES, PHASE_VALUES
from reduction.quantities.names import BRANCH_NAMES
from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, Integers
from reduction.record.notes import Note, note
from reduction.record.samples import (
    empty_like,
    finite_extremes,
    interval_labels,
    mean_of_rows,
    sample_blocks,
    take_samples,
)
from reduction.record.settings import CycleSettings
from reduction.stages.cycles.branch_span import trimmed_branches
from reduction.stages.cycles.cycle_pairing import find_half_cycles, whole_cycles
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.machine_counter import (
    are_apart,
    begin_at_peaks,
    change_at_valleys,
    changes_of_count,
    count_over_gaps,
    counted_cycles,
    counter_notes,
    number_of_cycles,
    skips_of_count,
)
from reduction.stages.cycles.reversals import (
    FEWEST_SMALL,
    Indices,
    drop_jumps,
    find_reversals,
    reversals_of_small_cycles,
    reversals_of_typical_cycles,
    turning_points,
)
from reduction.stages.standstills import Standstills, median_step, noise_range

FEWEST_SAMPLES = 4
"""Per cycle, not counting the last, which belongs to the next: two turns, a sample per branch."""

ENOUGH_SAMPLES = 12
"""Per cycle: the polygon through that many encloses 4.5 % less than the loop."""

_ALIKE = 0.3  # relative spread of stroke and of duration, for nine tenths of the cycles


def _are_alike(time: Floats, values: Floats, branch_first: Indices, branch_last: Indices) -> bool:
    """Whether whole cycles are so many and so similar that a machine made them."""
    if branch_first.shape[0] < FEWEST_SMALL:
        return False
    stroke = np.abs(take_samples(values, branch_last) - take_samples(values, branch_first))
    period = take_samples(time, branch_last[:, 1]) - take_samples(time, branch_first[:, 0])
    for of in (stroke, period):
        low, middle, high = np.quantile(of, [0.05, 0.5, 0.95])
        if not (1 - _ALIKE) * middle <= low <= high <= (1 + _ALIKE) * middle:
            return False
    return True


def _cycles_before(time: Floats, values: Floats, reversals: Indices, begin: int) -> int:
    """Number of cycles before the first whole one, of its pace and half of its range or more.

    Examples
    --------
    Slack, a sine that grows, of which the cycles from 7 on are whole:

    >>> values = np.array([0.0, 0, 2, 3.6, 2.2, 3.8, 2.1, 4, 2, 4, 2, 4])[[0, *range(12)]]
    >>> time = np.array([0.0, *range(20, 32)])
    >>> print(_cycles_before(time, values, np.arange(2, 13), 9))
    3
    """
    near = int(np.searchsorted(reversals, begin))
    turns = np.concatenate([reversals[:near], [begin], reversals[near:]])
    turns = turns[np.concatenate([[True], np.diff(turns) > 0])]
    at = int(np.searchsorted(turns, begin))
    lasts = np.diff(take_samples(time, turns))
    ranges = np.abs(np.diff(take_samples(values, turns)))
    n_found = 0
    # the half cycles before it, from the last one back, beside those of its kind behind it
    for place in range(at - 1, -1, -1):
        own = slice(at + (at - place) % 2, at + 5, 2)
        if not lasts[own].size:
            break
        pace, part = (one[place] / np.median(one[own]) for one in (lasts, ranges))
        if not (abs(pace - 1) < _OFF_PACE and _LEAST_PART < part < _MOST_PART):
            break
        n_found += 1
    return n_found // 2


_OFF_PACE = 0.25  # of the time of a half cycle

_LEAST_PART, _MOST_PART = 0.5, 1.3  # of its range


def label_phases(
    time: Floats, *, standstills: Standstills, cycles: Cycles | None
) -> NDArray[np.int8]:
    """Return the phase of each sample, by the values of `reduction.quantities.names.PHASE_VALUES`.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time of the record, aligned with the labels. [s]
    standstills : Standstills
        Rests and holds. [SI]
    cycles : Cycles or None
        Cycles, where the test has them. [SI]

    Returns
    -------
    phase : ndarray of int8, shape (n_samples,)
        Cycling during a cycle, including dwells; else rest or hold where the crosshead
        stands; else approach: every other movement, to and from the test. [1]

    Raises
    ------
    DataError
        If a standstill or the cycles reach beyond the record.

    Notes
    -----
    The order of a test in [1]_ is rest, approach and hold in turn, cycling, approach, rest.

    Examples
    --------
    >>> stand = Standstills(
    ...     np.array([0, 5]), np.array([2, 6]), np.zeros(2), np.zeros(2), np.zeros(2),
    ...     np.zeros((1, 2)), np.array([True, False]), 0.1, 1.0)
    >>> label_phases(np.arange(8.0), standstills=stand, cycles=None)
    array([0, 0, 0, 1, 1, 2, 2, 1], dtype=int8)
    """
    n_samples = time.size
    if standstills.n_standstills and int(standstills.last[-1]) >= n_samples:
        raise DataError(
            "a standstill reaches beyond the record",
            found=f"sample {int(standstills.last[-1])}",
            needed=f"less than {n_samples}",
        )
    phase = empty_like(time, dtype=np.int8)
    for part in sample_blocks(n_samples, phase):
        phase[part] = PHASE_VALUES["approach"]
    for first, last, is_rest in zip(
        standstills.first, standstills.last, standstills.is_rest, strict=True
    ):
        stand = phase[first : last + 1]
        for part in sample_blocks(stand.size, stand):
            stand[part] = PHASE_VALUES["rest" if is_rest else "hold"]
    if cycles is not None:
        if cycles.cycle_number.size != n_samples:
            raise DataError(
                "the cycles are of another record",
                found=f"{cycles.cycle_number.size} samples",
                needed=f"{n_samples}",
            )
        cycling = np.int8(PHASE_VALUES["cycling"])
        for part in sample_blocks(n_samples, phase, cycles.cycle_number):
            np.copyto(phase[part], cycling, where=cycles.cycle_number[part] > 0)
    return phase


_HINT = (
    "Check cycles.control, cycles.band, phases.minimum_duration (a longer pause at a turn is a"
    " hold) and the layout, or state the kind of the test "
    "(relaxation, creep, quasi-static, tensile)."
)

_ONE_WAY_HINT = (
    'The crosshead moves one way: give a pull kind = "tensile", a hold kind = "relaxation". If the'
    " machine cycled, check the column of crosshead_position in the layout."
)

_BOUNCE_HINT = (
    "The crosshead ends at its furthest: if it only bounced as the specimen parted, give kind ="
    ' "tensile". '
)

_ONE_WAY = 0.95  # of the range: least distance from the first reading to the last

_CUT_OFF = 0.03  # of the samples, at the top of the range: a sine has 2 % of them there

_AT_TOP = 1e-3  # of the range

_AT_TURNS = 0.9  # of the readings

_BETWEEN = (
    "Loops and moduli need the readings between them: use the log before thinning. The ranges of"
    " load and strain give only K_ap; `reduction surface` takes a table of K_ap by run."
)

_NO_LOAD = 0.1  # of the greatest


def _let_back(tension: Floats, settings: CycleSettings) -> str:
    """Advice for a specimen that is longer when it returns to no load than it was before."""
    ends, most = tension[:, [0, -1]], np.nanmax(tension)
    if settings.control == "load" or not bool((ends < _NO_LOAD * most).all()):
        return ""
    return (
        "The load begins and ends near zero: if the specimen does not return to its first length,"
        ' state control = "load". '
    )


def _hint(time: Floats, values: Floats) -> str:
    """Advice where no cycle is found; a log may be too coarse, or cut off at a value."""
    step = median_step(time)
    if values.size > FEWEST_SAMPLES and turning_points(values).size > _AT_TURNS * values.size:
        return (
            "Nearly every reading is a turn: the log contains only the greatest and least value of"
            f" each cycle. {_BETWEEN}"
        )
    top = float(np.nanmax(values))
    share = float(np.mean(values > top - _AT_TOP * (top - float(np.nanmin(values)))))
    cut_off = (
        f"{100 * share:.0f} % of the samples are at {top:.6g}, the greatest value: the channel is"
        " saturated there, or the machine dwells. "
    )
    return (
        f"{cut_off if share > _CUT_OFF else ''}{_HINT} The samples are {step:.4g} s"
        f" apart: cycles shorter than {FEWEST_SAMPLES * step:.4g} s need a faster log."
    )


_BRANCHES = np.array([BRANCH_VALUES[name] for name in BRANCH_NAMES], dtype=np.int8)


def control_channel(position: Floats, tension: Floats, settings: CycleSettings) -> Floats:
    """Return the channel that the machine moves: position, or the mean tension of the specimens.

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Position of the crosshead. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        [N]
    settings : CycleSettings
        Which channel is controlled.

    Returns
    -------
    driven : ndarray, shape (n_samples,)
        [m] or [N]

    Examples
    --------
    >>> settings = CycleSettings(control="load")
    >>> print(control_channel(np.zeros(2), np.array([[1.0, 2.0], [3.0, 4.0]]), settings))
    [2. 3.]
    """
    if settings.control == "position":
        return position
    return mean_of_rows(tension)


@dataclass(frozen=True)
class _Paired:
    """Reversals found with a band, without those of jumps, and the whole cycles between them."""

    reversals: Indices
    band: float
    jumps: Indices
    branch_first: Indices
    branch_last: Indices
    left_out: Indices
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()
    n_ends_left_out: int = 0


def _paired(
    time: Floats,
    values: Floats,
    standstills: Standstills,
    found: tuple[Indices, float],
    *,
    is_sinusoidal: bool,
    counter: Integers | None,
) -> _Paired:
    """Whole cycles between reversals."""
    none = np.empty((0, 2), dtype=np.intp)
    if found[0].size < 3:
        return _Paired(*found, none[:, 0], none, none, none[:, 0])
    reversals, jumps = drop_jumps(values, found[0])
    skips = none[:, 0] if counter is None else skips_of_count(counter, reversals)
    halves = find_half_cycles(
        time, values, reversals, standstills,
        band=found[1], skips=skips, is_sinusoidal=is_sinusoidal,
    )  # fmt: skip
    return _Paired(
        reversals, found[1], jumps, *whole_cycles(values, halves),
        notes=tuple(halves.notes), made=tuple(halves.made),
        n_ends_left_out=halves.n_ends_left_out,
    )  # fmt: skip


def _paired_cycles(
    time: Floats,
    values: Floats,
    standstills: Standstills,
    settings: CycleSettings,
    *,
    counter: Integers | None,
    is_counted: bool,
) -> tuple[_Paired, list[Note]]:
    """Cycles by the stated or the estimated band; small cycles where there are no others.

    A band of a tenth of the typical travel hides cycles that are small beside the pull to them.
    """
    pair = partial(
        _paired, time, values, standstills,
        is_sinusoidal=settings.waveform == "sinusoidal", counter=counter,
    )  # fmt: skip
    if settings.band is not None:
        found = pair((find_reversals(values, band=settings.band), settings.band))
    else:
        found = pair(reversals_of_typical_cycles(values, time))
    if settings.band is None and not is_counted and not found.branch_first.size:
        small = pair(reversals_of_small_cycles(values, time))
        if _are_alike(time, values, small.branch_first, small.branch_last):
            ends = take_samples(values, small.branch_last) - take_samples(
                values, small.branch_first
            )
            stroke = float(np.median(np.abs(ends)))
            of_record = _range(values)
            return small, [
                note("cycles-small", stroke=stroke, of_record=of_record, band=small.band,
                     unit="N" if settings.control == "load" else "m")
            ]  # fmt: skip
    if found.reversals.size < 3:
        load = settings.control == "load"
        channel, unit = ("tension", "N") if load else ("crosshead position", "m")
        raise DataError(
            f"no cycle: {channel} does not reverse",
            found=f"a range of {_range(values):.4g} {unit}, "
            f"{max(found.reversals.size - 1, 0)} movements of {found.band:.4g} {unit} or more",
            needed="two half cycles or more",
            hint=_ONE_WAY_HINT
            if found.reversals.size == 2 and not load and _goes_one_way(values)
            else _hint(time, values),
        )
    return found, []


def _goes_one_way(values: Floats) -> bool:
    return abs(float(values[-1] - values[0])) > _ONE_WAY * _range(values)


def _range(values: Floats) -> float:
    """Range of the finite samples; 0 where there is none."""
    low, high = finite_extremes(values)
    return max(high - low, 0.0)


_STEADY = 0.015  # of a range: a smaller difference changes a mean of a dozen by a thousandth

_STARTING = 0.25  # of a range: a larger difference is another level, not a machine that starts

_OTHER_LENGTH = 0.1

_TELLS_NOISE = 14  # readings a cycle: of fewer, the wave itself looks like noise

_MOST_STARTING = 3

_LEFT_STEADY = 5

_READ_CLOSELY = 0.5  # of the cycles: a lower fraction is a log that goes on at the turns only


def _steady_span(
    values: Floats, branch_first: Indices, branch_last: Indices, *, noise: float = 0.0
) -> slice:
    """Cycles without those at either end in which the machine starts or stops.

    A controller takes one or a few cycles to reach its set amplitude, and the phase of those
    cycles differs from that of the others.  A range beside a hold lacks what the wave moved
    before the hold ended, the range ``noise`` of readings at rest, and what noise adds to the
    extremes of the others.

    Examples
    --------
    >>> wave = np.append(np.tile([0.0, 100.0], 12), 0.0)
    >>> wave[1] = 90
    >>> ends = np.stack([np.arange(0, 24, 2), np.arange(1, 24, 2)], axis=1)
    >>> _steady_span(wave, ends, ends + 1)
    slice(1, 12, None)
    """
    begin, peak, end = branch_first[:, 0], branch_last[:, 0], branch_last[:, 1]
    falls, rises = values[peak] - values[end], values[peak] - values[begin]
    n_cycles = peak.size
    if n_cycles < _LEFT_STEADY + _MOST_STARTING or not np.isfinite(falls + rises).all():
        return slice(0, n_cycles)

    def apart(of: Floats) -> Floats:
        """Relative distance of ranges from the median; zero within their scatter."""
        middle = np.median(of)
        far = np.abs(of - middle)
        scatter = max(6 * 1.5 * np.median(far), noise)
        return np.where(far > scatter, far / middle, 0.0)

    of_rise, of_fall = apart(rises), apart(falls)
    # one branch with the range of the others shows that the level is the same
    worse, better = np.maximum(of_rise, of_fall), np.minimum(of_rise, of_fall)
    # a machine that waits before it starts makes a cycle of different length
    length = end - begin
    is_long = np.abs(length / np.median(length) - 1) > _OTHER_LENGTH
    is_off = (worse > _STEADY) | is_long
    # half cycles that grow up to the level, or die away from it, are no level of their own
    step = _STEADY * np.median(rises)
    grows, dies = np.zeros((2, n_cycles), np.bool_)
    grows[:-1] = (falls - rises > step)[:-1] & (rises[1:] - falls[:-1] > step)
    dies[1:] = (rises - falls > step)[1:] & (falls[:-1] - rises[1:] > step)
    starts, stops = (is_off & ((better < _STARTING) | one) for one in (grows, dies))
    # a record may begin and end within a cycle: the branch there is no evidence
    reach = int(np.median(end - begin)) // 20
    if begin[0] <= reach:
        starts[0] = _STEADY < of_fall[0] < _STARTING
    if end[-1] >= values.size - 1 - reach:
        stops[-1] = _STEADY < of_rise[-1] < _STARTING

    def n_off(of: Bools) -> int:
        first = int(np.argmin(of))  # the first that is like the others
        return first if first <= min(_MOST_STARTING, (n_cycles - _LEFT_STEADY + 1) // 2) else 0

    return slice(n_off(starts), n_cycles - n_off(stops[::-1]))


_MOST_ODD = 0.1  # of the cycles, and at most this many

_FEW = 3


def _odd_cycles(time: Floats, first: Indices, last: Indices, ranges: Floats) -> Bools:
    """Cycles within a row whose duration differs from all others: the machine jumped or waited.

    A function generator that restarts continues at another phase.  A cycle at an end of the row
    may have been cut there; if both its ranges, shape (n_cycles, 2), differ from those of the two
    beside it, it is part of the way to the cycles or from them.

    Examples
    --------
    >>> turns = np.append(np.arange(0, 60, 10), np.arange(67, 130, 10))
    >>> time, ranges = np.arange(130.0), np.ones((turns.size - 1, 2))
    >>> print(np.flatnonzero(_odd_cycles(time, turns[:-1], turns[1:], ranges)))
    [5]
    """
    length = take_samples(time, last) - take_samples(time, first)
    is_odd = np.zeros(length.size, dtype=np.bool_)
    if length.size < _LEFT_STEADY + _MOST_STARTING:
        return is_odd
    middle = float(np.median(length))
    sample = length / np.maximum(last - first, 1)
    limit = np.maximum(
        _OTHER_LENGTH * middle + 2 * sample, 6 * 1.5 * np.median(abs(length - middle))
    )
    is_odd[1:-1] = (np.abs(length - middle) > limit)[1:-1]
    # two that together last as long as two others only have a misplaced turn between them
    beside = is_odd[1:] & is_odd[:-1] & (np.abs(length[1:] + length[:-1] - 2 * middle) < limit[1:])
    is_odd[1:][beside] = is_odd[:-1][beside] = False
    n_odd = np.count_nonzero(is_odd)
    is_odd &= n_odd <= min(_FEW, _MOST_ODD * length.size)
    for end, beside in ((0, [1, 2]), (-1, [-2, -3])):
        apart = np.abs(length[end] - length[beside]) > limit[end]
        is_odd[end] = apart.all() and (np.abs(ranges[end] / ranges[beside] - 1) > _STARTING).all()
    return is_odd


def _labels(first: Indices, last: Indices, values: NDArray[Any], time: Floats) -> NDArray[Any]:
    """Value of the interval of each sample, 0 outside; a shared sample belongs to the later one."""
    end = last + 1
    end[:-1] = np.minimum(end[:-1], first[1:])
    return interval_labels(time, first, end, values)


@dataclass(frozen=True)
class _Chosen:
    """Cycles of a record with their number in the machine's count, before branches are trimmed."""

    first: Indices
    last: Indices
    branch_first: Indices
    branch_last: Indices
    count: Integers | None
    counted_by: str
    is_odd: Bools
    n_unsteady: int = 0
    n_starting: int = 0  # of them before the first cycle
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()


def _between_reversals(
    time: Floats,
    values: Floats,
    found: _Paired,
    settings: CycleSettings,
    counter: Integers | None,
    *,
    is_stored: bool,
) -> _Chosen:
    """Cycles between reversals, without those in which the machine starts, stops, jumps or waits.

    ``is_stored``: the log has a counter; it does not change where ``counter`` is None.
    """
    notes = list(found.notes)
    branch_first, branch_last = found.branch_first, found.branch_last
    n_starting = 0
    # a stroke of constant speed has its full amplitude from the start, a sine grows into it
    if settings.waveform == "sinusoidal":
        n_readings = branch_last[:, 1] - branch_first[:, 0]
        is_told = n_readings.size and np.median(n_readings) >= _TELLS_NOISE
        noise = noise_range(values) if is_told else 0.0
        steady = _steady_span(values, branch_first, branch_last, noise=noise)
        n_last = branch_first.shape[0] - steady.stop
        if steady.start or n_last:
            code = "cycles-of-starting-machine"
            notes.append(note(code, n_first=steady.start, n_last=n_last))
        branch_first, branch_last = branch_first[steady], branch_last[steady]
        n_starting = steady.start
    n_unsteady = found.branch_first.shape[0] - branch_first.shape[0]
    first, last = branch_first[:, 0], branch_last[:, 1]
    # the only cycle of a log, stored by a machine
    is_counted = is_stored and counter is None and first.size == 1
    n_moves = found.reversals.size // 2
    has_gaps = any(one.code == "gaps-end-runs" for one in notes)
    if counter is None and has_gaps and 0 < first.size < _READ_CLOSELY * n_moves:
        ends = float(time[last[-1]])
        notes.append(note("cycles-by-turns", n_cycles=first.size, n_moves=n_moves, time=ends))
    turned = take_samples(values, branch_last) - take_samples(values, branch_first)
    is_odd = _odd_cycles(time, first, last, np.abs(turned))
    if is_odd.any():
        begins = float(time[first[is_odd][0]])
        notes.append(note("cycles-of-other-length", n_cycles=int(is_odd.sum()), time=begins))
        branch_first, branch_last = branch_first[~is_odd], branch_last[~is_odd]
        first, last = first[~is_odd], last[~is_odd]
    if found.left_out.size:
        begins = float(time[found.left_out[0]])
        told = note("cycles-of-two-amplitudes", n_cycles=found.left_out.size, time=begins)
        # results from the lesser part of a test are to be looked at
        is_most = found.left_out.size > first.size > 0
        notes.append(replace(told, severity="warning") if is_most else told)
    count = None
    if counter is not None and first.size:
        count = number_of_cycles(counter, first, last)
        has_number = count > 0
        first, last, count = first[has_number], last[has_number], count[has_number]
        branch_first, branch_last = branch_first[has_number], branch_last[has_number]
    elif counter is None and is_stored:
        notes.append(note("counter-constant"))
    return _Chosen(
        first, last, branch_first, branch_last, count,
        counted_by="machine counter" if is_counted else "reversals",
        is_odd=is_odd, n_unsteady=n_unsteady, n_starting=n_starting, notes=tuple(notes),
        made=found.made,
    )  # fmt: skip


def find_cycles(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    standstills: Standstills,
    *,
    settings: CycleSettings,
    cycle_counter: Integers | None = None,
) -> Cycles:
    """Find the whole cycles of a record, valley to peak to valley.

    Notes
    -----
    Reversals are found by a hysteresis band (`reversals_of_typical_cycles` where none is stated;
    `reversals_of_small_cycles` where that gives no cycle and this gives five similar ones), half
    cycles by the rules of `find_half_cycles`. An ascending half cycle with the descending one after
    it is a cycle; a run that begins at a peak loses its first half cycle.
    A pair whose branches have different amplitudes is left out (`whole_cycles`). At a dwell the
    branches end where the crosshead arrives and begin where it leaves. A sample shared by two
    branches or cycles is labelled with the later cycle and with the earlier branch of a
    cycle; a peak gets the later branch where only that has its rate (`_own_begin`).
    Parts of branches: `reduction.stages.cycles.branch_span.trimmed_branches`.

    Examples
    --------
    Slack, two cycles between 1 and 3 m, and back:

    >>> from reduction.stages.standstills import find_standstills
    >>> from reduction.record.settings import PhaseSettings
    >>> time = np.arange(0, 90, 0.5)
    >>> position = np.interp(time, [0, 20, 40, 50, 60, 70, 90], [0, 0, 3, 1, 3, 1, 0])
    >>> tension = [100 * position]
    >>> stand = find_standstills(time, position, tension, settings=PhaseSettings())
    >>> cycles = find_cycles(time, position, tension, stand, settings=CycleSettings())
    >>> print(time[cycles.first], time[cycles.last], cycles.plateau_rate[1].round(3))
    [26.5 50. ] [50. 70.] [0.2 0.2]
    """
    tension = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    time, position, _ = as_same_shape(time=time, position=position, tension=tension[0])
    values = control_channel(position, tension, settings)
    counter, counted = cycle_counter, None
    if counter is not None and not changes_of_count(counter).size:
        counter = None
    if counter is not None and changes_of_count(counter).size > _AT_TURNS * counter.size:
        raise DataError(
            "the log has one row per cycle",
            found=f"{counter.size} rows, and {changes_of_count(counter).size} changes of the"
            " cycle_counter",
            needed=f"{FEWEST_SAMPLES} readings per cycle or more",
            hint=f"It is a table of the values of each cycle. {_BETWEEN}",
        )
    if counter is not None:
        counted = counted_cycles(time, values, counter)
    at_valleys = counted is not None and change_at_valleys(values, *counted[:4])
    found, notes = _paired_cycles(
        time, values, standstills, settings, counter=counter, is_counted=at_valleys
    )
    reversals, band, jumps = found.reversals, found.band, found.jumps
    if jumps.size:
        notes.append(note("jumps-no-reversals", n_jumps=jumps.size, time=float(time[jumps[0]])))
    n_between = found.branch_first.shape[0]
    stand_alone = at_valleys
    if counter is not None and counted is not None:
        notes += counter_notes(values, *counted[2:], n_between, band)
        skips = () if at_valleys else skips_of_count(counter, reversals)
        if len(skips):
            # a cycle stored alone has no other half, wherever the count changes in it
            stand_alone = not begin_at_peaks(values, *counted[2:4])
            if not stand_alone:
                notes.append(note("stored-from-peak", n_cycles=len(skips)))
    if counted is not None and stand_alone and are_apart(counted[4], n_between):
        none_odd = np.zeros(counted[0].size, dtype=np.bool_)
        chosen = _Chosen(*counted, counted_by="machine counter", is_odd=none_odd)
    else:
        chosen = _between_reversals(
            time, values, found, settings, counter, is_stored=cycle_counter is not None
        )
    notes += chosen.notes
    first, last, count, odd = chosen.first, chosen.last, chosen.count, chosen.is_odd
    branch_first, branch_last = chosen.branch_first, chosen.branch_last
    if first.size == 0:
        raise DataError(
            "no whole cycle",
            found=f"{reversals.size - 1} movements of {band:.4g} or more, none followed by one "
            "of similar range without a standstill or a gap between",
            needed="an ascending and a descending half cycle of similar range",
            hint=_let_back(tension, settings) + _hint(time, values),
        )
    is_pull = settings.control == "position" and _goes_one_way(values)
    notes += _refuse_coarse(time, first, branch_first[:, 1], last, is_pull=is_pull)
    is_sure = count is not None and bool(np.all(np.diff(count) > 0))  # it may restart at 1
    if not is_sure:
        count = count_over_gaps(time, first, last, standstills)
        if count is not None:
            n_hidden = int(count[-1]) - count.size
            notes.append(note("cycles-in-gaps", n_cycles=first.size, n_hidden=n_hidden))
        elif odd.any():
            count, is_sure = np.flatnonzero(~odd) + 1 - int(odd[0]), True
        # creep, and softening, began with the cycles in which the machine started
        n_before = max(chosen.n_starting, _cycles_before(time, values, reversals, int(first[0])))
        if n_before:
            if count is None:
                count, is_sure = np.arange(1, first.size + 1), True
            count = count + n_before
    if first.size == 1:
        notes.append(note("one-cycle"))
    # the way to the cycles and from them is not a cycle
    n_left = chosen.n_unsteady + np.count_nonzero(odd[1:-1])
    n_made = first.size + (n_left if chosen.counted_by == "reversals" else 0)
    if settings.expected_cycles is not None and settings.expected_cycles != n_made:
        # each end that is left out removes at most one cycle
        is_ends = 0 < settings.expected_cycles - n_made <= found.n_ends_left_out
        code = "planned-cycles-not-whole" if is_ends else "cycles-not-as-planned"
        notes.append(note(code, n_found=n_made, n_planned=settings.expected_cycles))

    start, stop, rate, trim_notes = trimmed_branches(
        time, values, branch_first.ravel(), branch_last.ravel(), settings
    )
    notes += trim_notes
    begin = _own_begin(branch_first, branch_last, start.reshape(-1, 2), stop.reshape(-1, 2)).ravel()
    end = branch_last.ravel().copy()
    end[:-1] = np.minimum(end[:-1], begin[1:] - 1)
    start, stop = np.maximum(start, begin), np.minimum(stop, end)
    kept = stop >= start
    return Cycles(
        first=first,
        last=last,
        branch_first=branch_first,
        branch_last=branch_last,
        plateau_rate=rate.reshape(-1, 2),
        cycle_number=_labels(first, last, np.arange(1, first.size + 1, dtype=np.int32), time),
        branch=_labels(begin, branch_last.ravel(), np.tile(_BRANCHES, first.size), time),
        is_in_trimmed_branch=_labels(
            start[kept], stop[kept], np.ones(int(kept.sum()), dtype=np.bool_), time
        ),
        band=float(band),
        counted_by=chosen.counted_by,
        count=count,
        is_count_sure=is_sure or count is None,
        notes=tuple(notes),
        made=chosen.made,
    )


def _own_begin(
    branch_first: Indices, branch_last: Indices, start: Indices, stop: Indices
) -> Indices:
    """First sample that is a branch's own, shape (n_cycles, 2); `start`, `stop`: its trimmed part.

    Branches alternate: a shared peak is the end of the ascending branch, a shared valley its
    beginning.  But a reading just after the corner of a ramp is the greatest and lies on the way
    down: a peak at the rate of the descending branch alone is the beginning of that branch.

    Examples
    --------
    Ramps that turn at 3.5, shortly before the reading of 3.4, and shortly after it.

    >>> first, last = np.array([[0, 4]]), np.array([[4, 8]])
    >>> _own_begin(first, last, np.array([[0, 4]]), np.array([[3, 8]]))
    array([[0, 4]])
    >>> _own_begin(first, last, np.array([[0, 5]]), np.array([[4, 8]]))
    array([[0, 5]])
    """
    begin = branch_first.copy()
    peak = branch_last[:, 0]
    is_behind = (start[:, 1] == peak) & (stop[:, 0] < peak)
    begin[:, 1] += (branch_first[:, 1] == peak) & ~is_behind
    return np.minimum(begin, branch_last)  # for a count that ends at its peak


def _refuse_coarse(
    time: Floats, first: Indices, leaves_peak: Indices, last: Indices, *, is_pull: bool = False
) -> list[Note]:
    """Refuse a log with too few samples in its cycles; a note where they are few.

    A pull bounces a few times when the specimen parts.

    Examples
    --------
    >>> time = np.arange(0.0, 30.0, 4.0)
    >>> _refuse_coarse(time, np.array([0, 3]), np.array([2, 5]), np.array([3, 6]))
    Traceback (most recent call last):
    reduction.record.errors.DataError: too few samples in a cycle; found 3 in cycle 1, which lasts
    12 s; needed 4 or more, and 12 for sound peaks and loops. Log every 1 s or faster, or use the
    log before thinning.
    """
    counts = last - first
    duration = take_samples(time, last) - take_samples(time, first)
    usual, period = float(np.median(counts)), float(np.median(duration))
    wanted = f"{period / ENOUGH_SAMPLES:.3g} s or faster"
    least = int(np.argmin(counts))
    if usual < FEWEST_SAMPLES or counts[least] < FEWEST_SAMPLES - 1:
        raise DataError(
            "too few samples in a cycle",
            found=f"{counts[least]} in cycle {least + 1}, which lasts {duration[least]:.4g} s",
            needed=f"{FEWEST_SAMPLES} or more, and {ENOUGH_SAMPLES} for sound peaks and loops",
            hint=(_BOUNCE_HINT if is_pull else "")
            + f"Log every {wanted}, or use the log before thinning.",
        )
    if usual < ENOUGH_SAMPLES:
        return [note("few-samples-a-cycle", n_samples=usual, needed=ENOUGH_SAMPLES, step=wanted)]
    # the faster stroke, with the rest after it: a turn between its samples is in no reading
    goes_on = np.append(first[1:], last[-1])
    faster = np.minimum(leaves_peak - first, goes_on - leaves_peak)
    fewest = float(np.median(faster))
    if fewest < ENOUGH_SAMPLES / 2:
        wanted = f"{period * fewest / usual / (ENOUGH_SAMPLES / 2):.3g} s or faster"
        return [
            note("few-samples-a-stroke", n_samples=fewest, needed=ENOUGH_SAMPLES // 2, step=wanted)
        ]
    return []

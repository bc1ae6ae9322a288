"""Cycles of a record: found, counted, cut at the ends, checked and labelled.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.checks import as_same_shape
from reduction.cycles.counter import changes_of_count, counted_cycles
from reduction.cycles.halves import find_half_cycles
from reduction.cycles.jumps import drop_jumps
from reduction.cycles.product import Cycles
from reduction.cycles.reversals import find_reversals, first_pass
from reduction.cycles.trim import constant_rate_span, plateau_rates, stroke_span
from reduction.cycles.whole import whole_cycles
from reduction.errors import DataError
from reduction.phases.noise import estimate_noise
from reduction.phases.standstill import Standstills
from reduction.record import Floats, Integers
from reduction.samples.blocks import finite_extremes, mean_of_rows, take_samples
from reduction.samples.intervals import interval_labels
from reduction.settings import CycleSettings
from reduction.vocabulary import BRANCH_NAMES, BRANCH_VALUES

_HINT = (
    "Check cycles.control, cycles.band and the layout, or give the test the kind it is "
    "(relaxation, creep, quasi-static)."
)

_BRANCHES = np.array([BRANCH_VALUES[name] for name in BRANCH_NAMES], dtype=np.int8)

Indices = NDArray[np.intp]


def _control_channel(position: Floats, tension: Floats, settings: CycleSettings) -> Floats:
    if settings.control == "position":
        return position
    return mean_of_rows(tension)


def _reversals(values: Floats, settings: CycleSettings) -> tuple[Indices, float]:
    """Reversals and the band that they were found with."""
    load = settings.control == "load"
    channel, unit = ("tension", "N") if load else ("crosshead position", "m")
    if settings.band is not None:
        reversals, band = find_reversals(values, band=settings.band), settings.band
    else:
        reversals, band = first_pass(values)
    if reversals.size < 3:
        raise DataError(
            f"no cycle: {channel} does not reverse",
            found=f"a range of {_range(values):.4g} {unit}, "
            f"{max(reversals.size - 1, 0)} movements of {band:.4g} {unit} or more",
            needed="two half cycles or more",
            hint=_HINT,
        )
    return reversals, band


def _range(values: Floats) -> float:
    """Range of the finite samples; 0 where there is none."""
    low, high = finite_extremes(values)
    return max(high - low, 0.0)


def _labels(first: Indices, last: Indices, values: NDArray[Any], time: Floats) -> NDArray[Any]:
    """Value of the interval of each sample, 0 outside; a shared sample is the later one's."""
    end = last + 1
    end[:-1] = np.minimum(end[:-1], first[1:])
    return interval_labels(time, first, end, values)


def _trimmed(
    time: Floats,
    values: Floats,
    branch_first: Indices,
    branch_last: Indices,
    settings: CycleSettings,
) -> tuple[Indices, Indices, Floats, list[str]]:
    noise = estimate_noise(values)[0]
    if settings.waveform != "triangular":
        first, last = stroke_span(values, branch_first, branch_last)
        return (
            first,
            last,
            plateau_rates(time, values, branch_first, branch_last, noise=noise),
            [
                f"a {settings.waveform} waveform has no plateau of rate: the trimmed branches "
                "leave out 5 % of the stroke at each end"
            ],
        )
    first, last, rate = constant_rate_span(
        time,
        values,
        branch_first,
        branch_last,
        noise=noise,
        trim_threshold=settings.trim_threshold,
    )
    bare = int(np.sum(last < first))
    return (
        first,
        last,
        rate,
        [
            f"{bare} of {first.size} branches have no part at a constant rate, first near "
            f"{time[branch_first[np.argmax(last < first)]]:g} s"
        ]
        if bare
        else [],
    )


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

    Parameters
    ----------
    time : array_like, shape (n_samples,)
        Elapsed time. [s]
    position : array_like, shape (n_samples,)
        Crosshead position; NaN where missing. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; their mean is the control channel of a load-controlled test. [N]
    standstills : Standstills
        From `reduction.phases.standstill.find_standstills`. [SI]
    settings : CycleSettings
        Control channel, waveform, band, threshold, plan. [SI]
    cycle_counter : ndarray of int, shape (n_samples,), optional
        The machine's own count: it says where each cycle begins, and the reversals are
        held against it. [1]

    Returns
    -------
    cycles : Cycles
        One or more, with notes on what was cut, left out, or differs. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, the control channel is missing or does not
        reverse, or no whole cycle is left.

    Notes
    -----
    Reversals by a hysteresis band (`first_pass` where none is stated), half cycles by the
    rules of `find_half_cycles`. An ascending half cycle with the descending one after it is a
    cycle; a run that begins at a peak loses its first half cycle. A pair of which one branch
    is of one amplitude and the other of the next is left out (`whole_cycles`). At a dwell the
    branches end where the crosshead arrives and begin where it leaves. A sample that two
    branches or cycles share is labelled with the later cycle and the earlier branch of a
    cycle. Constant rate: `constant_rate_span`; without a triangular waveform `stroke_span`.

    Examples
    --------
    Slack, two cycles between 1 and 3 m, and back.

    >>> from reduction.phases.standstill import find_standstills
    >>> from reduction.settings import PhaseSettings
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
    values = _control_channel(position, tension, settings)
    notes: list[str] = []
    reversals, band = _reversals(values, settings)
    reversals, jumps = drop_jumps(values, reversals)
    if jumps.size:
        notes.append(
            f"{jumps.size} jumps of the control channel and back are no reversals, first at "
            f"{time[jumps[0]]:g} s"
        )
    halves = find_half_cycles(
        time, values, reversals, standstills, band=band,
        is_sinusoidal=settings.waveform == "sinusoidal",
    )  # fmt: skip
    branch_first, branch_last, left_out = whole_cycles(values, halves)
    first, last = branch_first[:, 0], branch_last[:, 1]
    counted_by = "reversals"
    if cycle_counter is not None and changes_of_count(cycle_counter).size:
        n_reversals = first.size
        first, last, branch_first, branch_last, number = counted_cycles(cycle_counter, values)
        counted_by = "machine counter"
        notes += _counter_notes(number, values, first, branch_first, branch_last, n_reversals, band)
    else:
        notes += halves.notes
        if left_out.size:
            notes.append(
                f"cycles between two amplitudes, one branch of each, not counted: {left_out.size}, "
                f"first at {time[left_out[0]]:g} s"
            )
        if cycle_counter is not None:
            notes.append("the machine's cycle counter never changes: reversals are counted instead")
    if first.size == 0:
        raise DataError(
            "no whole cycle",
            found=f"{reversals.size - 1} movements of {band:.4g} or more, none followed by one "
            "of similar range without a standstill or a gap between",
            needed="an ascending and a descending half cycle of similar range",
            hint=_HINT,
        )
    if first.size == 1:
        notes.append("one cycle only: there is no scatter from cycle to cycle")
    if settings.expected_cycles is not None and settings.expected_cycles != first.size:
        notes.append(f"{first.size} whole cycles found, {settings.expected_cycles} planned")

    start, stop, rate, trim_notes = _trimmed(
        time, values, branch_first.ravel(), branch_last.ravel(), settings
    )
    notes += trim_notes
    kept = stop >= start
    # branches in turn: a shared peak is the end of the ascending one, a valley the begin of it
    begin = branch_first.copy()
    begin[:, 1] += branch_first[:, 1] == branch_last[:, 0]
    return Cycles(
        first=first,
        last=last,
        branch_first=branch_first,
        branch_last=branch_last,
        plateau_rate=rate.reshape(-1, 2),
        cycle_number=_labels(first, last, np.arange(1, first.size + 1, dtype=np.int32), time),
        branch=_labels(begin.ravel(), branch_last.ravel(), np.tile(_BRANCHES, first.size), time),
        is_constant_rate=_labels(
            start[kept], stop[kept], np.ones(int(kept.sum()), dtype=np.bool_), time
        ),
        band=float(band),
        counted_by=counted_by,
        notes=tuple(notes),
    )


def _counter_notes(
    number: Integers,
    values: Floats,
    first: Indices,
    branch_first: Indices,
    branch_last: Indices,
    n_reversals: int,
    band: float,
) -> list[str]:
    """What the machine's counter says that the reversals do not."""
    notes = []
    travel = take_samples(values, branch_last) - take_samples(values, branch_first)
    stroke = np.abs(travel).max(axis=1)
    still = stroke < band
    if still.any():
        notes.append(
            f"counted cycles without a stroke: {int(still.sum())}, first machine cycle "
            f"{int(number[np.argmax(still)])}"
        )
    if number.size and (np.diff(number) != 1).any():
        row = int(np.argmax(np.diff(number) != 1))
        notes.append(
            f"the log holds {number.size} of the machine's cycles {int(number[0])} to "
            f"{int(number[-1])}: {int(number[row + 1])} follows {int(number[row])}"
        )
    moving = int((~still).sum())
    if moving != n_reversals:
        notes.append(
            f"the machine counted {moving} cycles with a stroke, the reversals give {n_reversals} "
            "whole ones"
        )
    return notes

"""Half cycles: which of the movements between reversals belong to cycling, and from where to where.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.dwells import dwells_of_cycles
from reduction.cycles.ends import fit_ends
from reduction.cycles.runs import gaps_of_record, runs_that_cycle
from reduction.phases.intervals import median_step
from reduction.phases.noise import noise_range
from reduction.phases.standstill import Standstills
from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import take_samples

_GAP_SHARE = 0.3  # of a half cycle
_GAP_STEPS = 3.5  # median time steps

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class HalfCycles:
    """Half cycles in order of time, shape (n_half_cycles,) each.

    ``first`` and ``last`` are samples, both inside, and ``run`` counts runs of half cycles
    that follow each other; within a run they rise and fall in turn.
    """

    first: Indices
    last: Indices
    rises: Bools
    run: Indices
    notes: tuple[str, ...]


def _replaced(samples: Indices, old: Indices, new: Integers) -> Indices:
    """Samples with each of the old ones, in order of time, replaced by the new."""
    if old.size == 0:
        return samples
    place = np.minimum(np.searchsorted(old, samples), old.size - 1)
    return np.where(old[place] == samples, new[place], samples)


def find_half_cycles(
    time: Floats,
    values: Floats,
    reversals: Indices,
    standstills: Standstills,
    *,
    band: float,
    is_sinusoidal: bool = False,
) -> HalfCycles:
    """Keep the half cycles of runs that cycle, ends cut or left out.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    values : ndarray, shape (n_samples,)
        Control channel; NaN where missing. [m] or [N]
    reversals : ndarray of int, shape (n_reversals,)
        From `reduction.cycles.reversals.find_reversals`, at least two. [1]
    standstills : Standstills
        They end a run, unless they are dwells. [SI]
    band : float
        With which the reversals were found. [m] or [N]
    is_sinusoidal : bool
        Whether every half cycle takes the same time.

    Returns
    -------
    half_cycles : HalfCycles
        In order of time; empty where nothing cycles.

    Raises
    ------
    IndexError
        If there are fewer than two reversals.

    Notes
    -----
    A *run* is a stretch between standstills and between gaps of the record of more than
    30 % of a half cycle.  It cycles where two half cycles in a row have ranges that
    differ by at most 30 %: the moves between holds before a test do not.  A standstill
    at a reversal is a *dwell* and ends no run where three or more peaks in a row, or
    valleys, have one at the same level, and their durations differ by at most a factor 2.
    A half cycle at least as long as its two neighbours together is a move from one level
    to another: the run is parted there, and the move serves as an end of both parts.

    *Ends.* A first or last half cycle with a range over 1.3 times its neighbour's is cut
    where it passes the neighbour's level, cf. the return to slack after the tenth peak
    in [1]_.  One that begins or ends with the record or at a gap, or ends at a standstill,
    short of the neighbour's level by more than 5 % of its range, the travel of a sample and
    the tolerance of the standstill, is incomplete and left out; so is one that begins at a
    standstill, or at an edge where the signal stands, with less than 0.7 times its range.
    Between two reversals it is whole, but for one beside a move away: a sine that begins or
    ends at its mean has moved half a range there.
    In a sinusoidal test an end that ran on, or takes 25 % more or less time, is left out.
    A wait at an end, too short for a standstill, is no part of the half cycle there
    (`reduction.cycles.ends.without_stands`).

    Examples
    --------
    Slack, two cycles between 2 and 3, and back to slack.

    >>> values = np.array([0.0, 1, 2, 3, 2.5, 2, 3, 2, 1, 0])
    >>> none = np.empty(0)
    >>> rests = Standstills(
    ...     none.astype(int), none.astype(int), none, none, none, np.empty((1, 0)),
    ...     none > 0, 0.1, 1.0)
    >>> halves = find_half_cycles(
    ...     np.arange(10.0), values, np.array([0, 3, 5, 6, 9]), rests, band=0.5)
    >>> print(halves.first, halves.last, halves.rises)
    [2 3 5 6] [3 5 6 7] [ True False  True False]
    """
    half_duration = float(np.median(np.diff(take_samples(time, reversals))))
    at, is_dwell = dwells_of_cycles(values, reversals, standstills, band=band)
    longest = max(_GAP_SHARE * half_duration, _GAP_STEPS * median_step(time))
    gap_before, gap_after = gaps_of_record(time, values, longest=longest)
    breaks = (
        np.concatenate([standstills.first[~is_dwell], gap_before]),
        np.concatenate([standstills.last[~is_dwell], gap_after]),
    )
    # of the channel that stands still: the tension where it is held, else the position
    still = standstills.tension_tolerance
    tolerance = standstills.position_tolerance if still is None else still
    noise = noise_range(values)
    runs = [
        fit_ends(time, values, run, is_sinusoidal=is_sinusoidal, still=tolerance, tolerance=noise)
        for run in runs_that_cycle(
            values, reversals, breaks, n_standstills=int(np.sum(~is_dwell)), band=band
        )
    ]
    cut = [at for run in runs for at in run.cut]
    short = [at for run in runs for at in run.short]
    paced = [at for run in runs for at in run.paced]
    notes = []
    for samples, what in (
        (cut, "half cycles at the end of a run, cut where they pass their neighbours' level"),
        (short, "half cycles at the end of a run, short of their neighbours' level, not counted"),
        (paced, "half cycles at the end of a run that are no part of the sine, not counted"),
        (gap_before, "gaps of the record longer than 30 % of a half cycle, each the end of a run"),
    ):
        if len(samples):
            notes.append(f"{what}: {len(samples)}, first near {time[samples[0]]:g} s")
    empty = np.empty(0, dtype=np.intp)
    first = np.concatenate([empty, *(run.nodes[:-1] for run in runs)])
    last = np.concatenate([empty, *(run.nodes[1:] for run in runs)])
    rises = take_samples(values, last) > take_samples(values, first)
    # at a dwell one half cycle ends where the crosshead arrives, the next begins where it leaves
    dwell = reversals[at[is_dwell]]
    first = _replaced(first, dwell, standstills.last[is_dwell])
    last = _replaced(last, dwell, standstills.first[is_dwell])
    return HalfCycles(
        first=first,
        last=last,
        rises=rises,
        run=np.repeat(np.arange(len(runs)), [run.nodes.size - 1 for run in runs]),
        notes=tuple(notes),
    )

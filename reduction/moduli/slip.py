"""Slip of a splice: steps of tension from cycle to cycle that steady creep does not explain.

A splice that slips lets out length, and the tension at every crosshead position falls.
The peak of a sampled cycle is a poor witness: at 20 samples a cycle the sample nearest
the turn may miss it.  The level of the whole branch is better: every sample of a cycle
is compared with the mean branch at its own position.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.cycles.product import Loops
from reduction.errors import DataError
from reduction.moduli.product import Slips
from reduction.moduli.steps import find_steps
from reduction.moduli.stepscan import ramp_of
from reduction.moduli.stepsize import Step, step_sizes
from reduction.record import Bools, Floats, Integers
from reduction.samples.blocks import BLOCK, count_samples, sample_blocks, take_samples
from reduction.samples.search import thinned
from reduction.settings import SlipSettings
from reduction.workers import run_blocks

__all__ = ["cycle_tension_level", "find_slips"]

N_BINS = 32
SAMPLES_PER_CYCLE = 64
FEWEST_SAMPLES = 8
FEWEST_IN_A_CYCLE = 4
_MOST_READ = 1 << 18  # samples of the mean branch


def _reference_branch(position: Floats, tension: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean branch on a grid of position: position, tension, slope; bins without samples left out.

    The grid leaves out the two outer fiftieths of the stroke, where the turn is.
    """
    low, high = np.quantile(position, [0.02, 0.98])
    index = np.clip(((position - low) / (high - low) * N_BINS).astype(np.intp), 0, N_BINS - 1)
    count = np.bincount(index, minlength=N_BINS)
    filled = np.flatnonzero(count)
    sums = np.stack(
        [count, np.bincount(index, position, N_BINS), np.bincount(index, tension, N_BINS)]
    )[:, filled]
    # Cycles in step with the clock repeat a few positions; one that lies on an edge would
    # fall into both bins beside it, and the slope between those is noise.
    apart = np.diff(sums[1] / sums[0], prepend=-np.inf) > (high - low) / N_BINS / 4
    count, position, tension = np.add.reduceat(sums, np.flatnonzero(apart), axis=1)
    mean_position, mean_tension = position / count, tension / count
    return mean_position, mean_tension, np.gradient(mean_tension, mean_position)


def cycle_tension_level(
    crosshead_position: ArrayLike,
    tension: ArrayLike,
    *,
    cycle_number: Integers,
    branch: Integers,
    n_cycles: int,
) -> tuple[Floats, Floats]:
    r"""Tension level of each cycle: the whole loop against the mean loop, as one number.

    .. math:: \Delta T_c = g_{top} \sum_{i \in c} g_i (T_i - \bar T(x_i)) / \sum_{i \in c} g_i^2

    where :math:`\bar T` is the mean branch and :math:`g` its slope, so that the shift of
    position that explains the cycle best is given as tension at the top of the loop.

    Parameters
    ----------
    crosshead_position : array_like, shape (n_samples,)
        Position; NaN is left out. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN is left out. [N]
    cycle_number : ndarray of int, shape (n_samples,)
        1 for the first cycle, 0 outside cycles. [1]
    branch : ndarray of int, shape (n_samples,)
        0 none, 1 ascending, 2 descending. [1]
    n_cycles : int
        Number of cycles. [1]

    Returns
    -------
    tension_level : ndarray, shape (n_specimens, n_cycles)
        Mean tension at the top of the loop plus the shift of the cycle; NaN where a cycle
        has fewer than four samples, or a specimen fewer than eight on a branch. [N]
    tension_slope : ndarray, shape (n_specimens,)
        Slope of the mean ascending and descending branch at the top. [N m-1]

    Raises
    ------
    DataError
        If the series do not pair up, or the cycles have no samples or no stroke.

    Notes
    -----
    About 64 samples a cycle are used, evenly picked, whatever the rate, and of those some
    hundred thousand for the mean branch.  On a generated
    log of 20 samples a cycle the level has a third of the noise of the peak (0.09 against
    0.26 lbf), and it does not beat with the phase of the samples.

    Examples
    --------
    A specimen of 10 N/m that has let out 0.1 m after the second cycle.

    >>> x = np.tile([1.0, 2, 3, 4, 5, 6, 5, 4, 3, 2], 4)
    >>> cycle = np.repeat([1, 2, 3, 4], 10)
    >>> branch = np.tile([1, 1, 1, 1, 1, 1, 2, 2, 2, 2], 4)
    >>> level, slope = cycle_tension_level(
    ...     x, [10 * (x - 0.1 * (cycle > 2))], cycle_number=cycle, branch=branch, n_cycles=4
    ... )
    >>> print((level - level[:, :1]).round(6) + 0.0, slope.round(6))
    [[ 0.  0. -1. -1.]] [10.]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    position = np.asarray(crosshead_position, dtype=np.float64)
    if not position.shape == np.shape(cycle_number) == np.shape(branch) == loads.shape[1:]:
        raise DataError(
            "series do not pair up",
            found=f"position {position.shape}, cycle number {np.shape(cycle_number)}, branch "
            f"{np.shape(branch)}, tension {loads.shape}",
            needed="one length",
        )
    number, side = np.asarray(cycle_number), np.asarray(branch)
    # Thinned before anything is computed: a log may have thousands of samples a cycle.
    step = max(1, count_samples(number) // (SAMPLES_PER_CYCLE * max(1, n_cycles)))

    series = number, side, position

    def is_used(part: slice) -> Bools:
        return (number[part] > 0) & (side[part] > 0) & np.isfinite(position[part])

    read = thinned(is_used, position.size, most=_MOST_READ, every=step, samples=series)
    if read.size == 0 or np.ptp(take_samples(position, read)) == 0:
        raise DataError(
            "no stroke to compare cycles on",
            found=f"{read.size} samples in cycles",
            needed="samples at different positions",
        )
    level = np.full((loads.shape[0], n_cycles), np.nan)
    slope = np.full(loads.shape[0], np.nan)

    def find_level(row: int) -> None:
        load = loads[row]
        branches = _reference_branches(position, load, side, read)
        if branches is None:
            return
        product, power, count = np.zeros((3, n_cycles))
        for part in sample_blocks(position.size, *series, load, size=step * BLOCK):
            rows = part.start + step * np.flatnonzero(is_used(slice(part.start, part.stop, step)))
            for which, (grid, mean, gradient) in branches.items():
                keep = rows[(side[rows] == which) & np.isfinite(load[rows])]
                if not keep.size:
                    continue
                x, y, cycle = position[keep], load[keep], number[keep] - 1
                g = np.interp(x, grid, gradient)
                # Beyond the grid the branch is the straight line of its end.
                over = x - np.clip(x, grid[0], grid[-1])
                shift = y - np.interp(x, grid, mean) - g * over
                low = int(cycle.min())
                here = slice(low, int(cycle.max()) + 1)
                product[here] += np.bincount(cycle - low, g * shift)
                power[here] += np.bincount(cycle - low, g * g)
                count[here] += np.bincount(cycle - low)
        slope[row] = np.mean([gradient[-1] for _, _, gradient in branches.values()])
        top = np.mean([mean[-1] for _, mean, _ in branches.values()])
        known = (count >= FEWEST_IN_A_CYCLE) & (power > 0)
        level[row, known] = top + slope[row] * product[known] / power[known]

    run_blocks(find_level, range(loads.shape[0]))
    return level, slope


def _reference_branches(
    position: Floats, load: Floats, side: Integers, read: NDArray[np.intp]
) -> dict[int, tuple[Floats, Floats, Floats]] | None:
    """Mean ascending (1) and descending (2) branch; None where one has no samples or no stroke."""
    branches = {}
    place, tension, of_branch = (take_samples(one, read) for one in (position, load, side))
    for which in (1, 2):
        keep = (of_branch == which) & np.isfinite(tension)
        if np.count_nonzero(keep) < FEWEST_SAMPLES or np.ptp(place[keep]) == 0:
            return None
        branches[which] = _reference_branch(place[keep], tension[keep])
    return branches


def _filled(series: Floats) -> Floats:
    """Bridge missing cycles linearly."""
    known = np.flatnonzero(np.isfinite(series))
    if known.size == series.size:
        return series
    return np.interp(np.arange(series.size), known, series[known])


def _creep_per_cycle(series: Floats, steps: tuple[Step, ...]) -> float:
    """Slope of the last half of the series, steps taken out."""
    n_samples = series.size
    half = slice(n_samples // 2, n_samples)
    columns = [np.ones(n_samples), np.arange(n_samples) / n_samples]
    columns += [ramp_of(n_samples, onset=step.onset, extent=step.extent) for step in steps]
    basis = np.stack(columns, axis=1)[half]
    return float(np.linalg.lstsq(basis, series[half])[0][1] / n_samples)


def _remarks(name: str, steps: tuple[Step, ...], sizes: Floats) -> list[str]:
    rises = [str(step.onset + 1) for step, size in zip(steps, sizes, strict=True) if size > 0]
    if not rises:
        return []
    return [
        f"{name}: tension steps up at cycle {', '.join(rises)}; a splice cannot take up "
        "length, look at the zero of the load cell and the set point of the crosshead"
    ]


def find_slips(
    loops: Loops,
    *,
    specimens: tuple[str, ...],
    settings: SlipSettings,
    tension_level: ArrayLike | None = None,
    tension_slope: ArrayLike | None = None,
) -> Slips:
    """Slips of the splices, found and dated cycle by cycle.

    Parameters
    ----------
    loops : Loops
        Table of loops; ``peak_tension`` gives the size of each step. [N]
    specimens : tuple of str, length n_specimens
        Names, in the order of the rows. [text]
    settings : SlipSettings
        Shortest run of cycles and the false-alarm rate of one specimen. [1]
    tension_level : array_like, shape (n_specimens, n_cycles), optional
        Series in which steps are looked for, from `cycle_tension_level`; the peaks where
        it is not given. [N]
    tension_slope : array_like, shape (n_specimens,), optional
        Slope of tension on position at the top of the loop; without it the length of a
        slip is NaN. [N m-1]

    Returns
    -------
    slips : Slips
        One row a step, by specimen and cycle; ``slip_cycle`` is the onset, ``slip_cycle_low``
        and ``slip_cycle_high`` enclose the whole step with the 95 % range of both ends. [N]

    Raises
    ------
    DataError
        If the names or the level do not fit the loops.

    Notes
    -----
    Source: WHOI-2005-10, sec. 4.7 and Figures 32-33, which report the slip but do not
    date it ([1]_).  Method and false-alarm rate: `find_steps`.  ``slip_length`` is the step of
    peak tension over the slope of a cycle; a relaxed specimen is softer than that slope,
    so the length is a lower bound (0.5 to 0.8 of the true length on a generated tether).
    Missing cycles are bridged; a specimen of which more than half are missing is left
    out, and a note says so.

    Examples
    --------
    >>> from reduction.cycles.product import Loops
    >>> peak = 700 + np.random.default_rng(0).standard_normal((1, 200))
    >>> peak[:, 120:] -= 8.0
    >>> loops = Loops(*[peak] * 14, uncertainty={})
    >>> slips = find_slips(
    ...     loops, specimens=("new",), settings=SlipSettings(), tension_slope=[200.0]
    ... )
    >>> print(slips.specimen, slips.slip_cycle, slips.slip_length.round(2))
    ('new',) [121] [0.04]
    """
    peaks = np.atleast_2d(loops.peak_tension)
    level = peaks if tension_level is None else np.atleast_2d(np.asarray(tension_level, float))
    slopes = np.asarray([np.nan] * len(peaks) if tension_slope is None else tension_slope, float)
    if level.shape != peaks.shape or not len(specimens) == slopes.size == len(peaks):
        raise DataError(
            "the series do not fit the loops",
            found=f"level {level.shape}, {len(specimens)} names, {slopes.size} slopes",
            needed=f"level {peaks.shape}, {peaks.shape[0]} names and slopes",
        )
    n_cycles = peaks.shape[1]
    notes: list[str] = []
    names: list[str] = []
    steps: list[Step] = []
    sizes, lengths = [np.empty((2, 0))], [np.empty((2, 0))]
    creep = np.full(len(specimens), np.nan)
    if n_cycles < settings.minimum_cycles:
        notes.append(
            f"slip not looked for: {n_cycles} cycles; {settings.minimum_cycles} or more are needed"
        )
    for row, name in enumerate(specimens if n_cycles >= settings.minimum_cycles else ()):
        missing = int(np.sum(~np.isfinite(level[row]) | ~np.isfinite(peaks[row])))
        if missing > n_cycles // 2:
            notes.append(f"{name}: slip not looked for: {missing} of {n_cycles} cycles are missing")
            continue
        found = find_steps(_filled(level[row]), false_alarm=settings.false_alarm)
        peak = _filled(peaks[row])
        size = np.stack(step_sizes(peak, found))
        creep[row] = _creep_per_cycle(peak, found)
        notes += _remarks(name, found, size[0])
        names += [name] * len(found)
        steps += found
        sizes.append(size)
        lengths.append(np.stack([-size[0] / slopes[row], size[1] / abs(slopes[row])]))
    notes += _shared_steps(names, steps)
    step_size, slip_length = np.concatenate(sizes, axis=1), np.concatenate(lengths, axis=1)
    return Slips(
        specimen=tuple(names),
        slip_cycle=np.array([step.onset + 1 for step in steps], dtype=np.int64),
        slip_cycle_low=np.array([step.onset_low + 1 for step in steps], dtype=np.int64),
        slip_cycle_high=np.array([step.end_high + 1 for step in steps], dtype=np.int64),
        slip_tension_step=step_size[0],
        slip_tension_step_standard_uncertainty=step_size[1],
        slip_length=slip_length[0],
        slip_length_standard_uncertainty=slip_length[1],
        creep_per_cycle=creep,
        notes=tuple(notes),
    )


def _shared_steps(names: list[str], steps: list[Step]) -> list[str]:
    """Note steps of two specimens in the same cycles: more likely the machine than the splices."""
    shared = {
        step.onset + 1
        for name, step in zip(names, steps, strict=True)
        for other_name, other in zip(names, steps, strict=True)
        if name < other_name
        and step.onset_low <= other.end_high
        and other.onset_low <= step.end_high
    }
    return [
        f"two specimens step at cycle {cycle}: look at the crosshead before the splices"
        for cycle in sorted(shared)
    ]

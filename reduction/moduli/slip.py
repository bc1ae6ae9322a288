"""Slip of a splice: steps of tension from cycle to cycle that steady creep does not explain.

A splice that slips lets out length, and the tension at every crosshead position falls; what is
looked at is the level of each cycle, from `reduction.moduli.tensionlevel`.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.cycles.product import Loops
from reduction.errors import DataError
from reduction.moduli.product import Slips
from reduction.moduli.steps import find_steps
from reduction.moduli.stepscan import ramp_of
from reduction.moduli.stepsize import Step, step_sizes
from reduction.record import Floats
from reduction.settings import SlipSettings


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
        Series in which steps are looked for, from
        `reduction.moduli.tensionlevel.cycle_tension_level`; the peaks where it is not given. [N]
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

"""Cycles to failure of a rope, from its loops.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 5 (cycles to failure under snap
   loads, against the peak as a share of the break strength).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.cycles.product import Loops
from reduction.errors import DataError, SettingsError
from reduction.line.strength import mean_of_rows, one_a_specimen
from reduction.record import Bools, Floats, Integers, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class CyclesToFailure:
    """How long a rope lasted; arrays have shape (n_specimens,).

    Parameters
    ----------
    cycles : ndarray of int
        Whole cycles before failure, or survived. [1]
    failed : ndarray of bool
        False for a run-out.
    peak_tension, valley_tension : ndarray
        Means over those cycles. [N]
    peak_tension_over_strength : ndarray
        Over the rated break strength. [1]
    how : tuple of str, length n_specimens
        What says that it failed or not.
    """

    cycles: Integers
    failed: Bools
    peak_tension: Floats
    valley_tension: Floats
    peak_tension_over_strength: Floats
    how: tuple[str, ...]


def cycles_to_failure(
    loops: Loops,
    *,
    rated_break_strength: ArrayLike,
    failed: ArrayLike | None = None,
    cycle_number: ArrayLike | None = None,
    parted_in: ArrayLike | None = None,
    failure_share: float = 0.5,
) -> CyclesToFailure:
    """Cycles that a rope lasted, by the fall of its peak or by the laboratory's word.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    failed : array_like of bool, shape (n_specimens,), optional
        Whether it broke, as the laboratory says; left out, the peaks alone decide. [1]
    cycle_number : array_like of int, shape (n_cycles,), optional
        Of each row, where a machine logs some cycles only or an earlier log began. [1]
    parted_in : array_like of int, shape (n_specimens,), optional
        Index of the cycle in which the record shows that it parted, the number of cycles
        where it did after the last; -1 where the record shows nothing. [1]
    failure_share : float, optional
        A peak below this share of the median peak before it is a failure. [1]

    Returns
    -------
    lasted : CyclesToFailure
        Cycles, failure or run-out, and the level.

    Raises
    ------
    DataError
        If there is no cycle, a strength is not positive, or arrays do not fit.
    SettingsError
        If the share is not between 0 and 1.

    Notes
    -----
    A rope that parts within a cycle leaves that cycle incomplete, so the last whole cycle
    looks sound: the loops alone cannot tell it from a run-out, and the text says so.  A cycle
    in which it parted is not one that it lasted, whatever its peak; ``parted_in`` says so.
    Source of the record: [1]_, sec. 5, cycles against the peak as a share of the strength.

    Examples
    --------
    >>> one = {name: np.full((1, 5), 100.0) for name in Loops.__dataclass_fields__}
    >>> one["peak_tension"] = np.array([[100.0, 99.0, 101.0, 100.0, 8.0]])
    >>> lasted = cycles_to_failure(Loops(**one), rated_break_strength=200.0)
    >>> print(lasted.cycles, lasted.failed, lasted.peak_tension_over_strength)
    [4] [ True] [0.5]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if not 0 < failure_share < 1:
        raise SettingsError(
            "the share of the peak that is a failure", found=f"{failure_share:g}", needed="0 to 1"
        )
    strength = one_a_specimen(rated_break_strength, n_specimens)
    number = np.arange(1, n_cycles + 1) if cycle_number is None else np.asarray(cycle_number)
    stated = None if failed is None else np.asarray(failed, dtype=bool)
    seen = np.full(n_specimens, -1) if parted_in is None else np.asarray(parted_in)
    if (
        n_cycles == 0
        or number.shape != (n_cycles,)
        or seen.shape != (n_specimens,)
        or (stated is not None and stated.shape != (n_specimens,))
        or (seen == 0).any()
    ):
        raise DataError(
            "cycles to failure: the arrays do not fit the loops",
            found=f"{n_cycles} cycles, numbers {number.shape}",
            needed="one number a cycle, one word a specimen, and a cycle before the failure",
        )
    lasted, parted = np.zeros(n_specimens, dtype=np.int64), np.zeros(n_specimens, dtype=bool)
    levels = np.full((2, n_specimens), np.nan)
    how = []
    for row, peak in enumerate(loops.peak_tension):
        # a failure lasts to the end of the record; one low peak before sound ones is none
        known = np.flatnonzero(np.isfinite(peak))
        limit = failure_share * np.median(peak[known]) if known.size else 0.0
        sound = known[peak[known] >= limit]
        fell = bool(sound.size and known[-1] > sound[-1])
        last = int(sound[-1]) if fell else n_cycles - 1
        shown = seen[row] > 0
        if shown:
            last = min(last, int(seen[row]) - 1)
        parted[row] = fell or shown if stated is None else stated[row]
        lasted[row] = number[last]
        levels[:, row] = mean_of_rows(
            np.stack([peak[: last + 1], loops.valley_tension[row, : last + 1]])
        )
        if shown:
            how.append("slack at a position at which it was taut")
        elif fell:
            how.append(f"the peak falls below {failure_share:.0%} of its median and stays there")
        elif stated is None:
            how.append("every whole cycle is sound: a run-out, or a failure after the last one")
        else:
            how.append("as stated" + (", after the last whole cycle" if stated[row] else ""))
    return CyclesToFailure(
        cycles=lasted,
        failed=parted,
        peak_tension=levels[0],
        valley_tension=levels[1],
        peak_tension_over_strength=levels[0] / strength,
        how=tuple(how),
    )

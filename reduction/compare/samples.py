"""Samples of a test that belong to a branch of a cycle.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError, SettingsError
from reduction.record import Floats, Integers, read_only_arrays

_LEAST_STEP = 0.01
_SAMPLES_A_BIN = 1.5
_MOST_ROWS = 1000


@dataclass(frozen=True)
@read_only_arrays
class BranchSamples:
    """Samples that are finite and belong to a branch.

    Parameters
    ----------
    strain, tension : ndarray, shape (n_samples,)
        In the order of the record. [1], [N]
    row : ndarray of int, shape (n_samples,)
        2 k where cycle k ascends, 2 k + 1 where it descends.
    cycle_number : ndarray of int, shape (n_cycle,)
        First cycle of each k; cycles without a sample have none.
    cycles_pooled, n_break_in : int
        Consecutive cycles in one k; how many k are break-in.
    """

    strain: Floats
    tension: Floats
    row: Integers
    cycle_number: Integers
    cycles_pooled: int
    n_break_in: int
    notes: tuple[str, ...]

    def least_step(self) -> float:
        """Width of a bin that holds four samples or more, 1, 2 or 5 times a power of ten. [1]."""
        along = np.abs(np.diff(self.strain))[np.diff(self.row) == 0]
        least = _SAMPLES_A_BIN * float(np.median(along)) if along.size else 0.0
        if least <= _LEAST_STEP:
            return _LEAST_STEP
        power = 10.0 ** np.floor(np.log10(least))
        return float(power * next(k for k in (1, 2, 5, 10) if k * power >= least * (1 - 1e-9)))


def select_samples(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    cycle_number: ArrayLike | None,
    branch: ArrayLike | None,
    break_in_cycles: int,
) -> BranchSamples:
    """Samples that are finite and belong to a branch, each with its cycle and branch.

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        NaN where missing. [1]
    tension : array_like, shape (n_samples,)
        NaN where missing. [N]
    cycle_number : array_like of int, shape (n_samples,), or None
        From 1; 0 outside cycles; None for a slow pull. [1]
    branch : array_like of int, shape (n_samples,), or None
        0 none, 1 ascending, 2 descending; None for a slow pull. [1]
    break_in_cycles : int
        First cycles that are in no mean. [1]

    Returns
    -------
    samples : BranchSamples
        Of a slow pull, those up to its greatest tension: what follows is a hold, an
        unloading or a break. [SI]

    Raises
    ------
    DataError
        If the series do not pair up, no sample belongs to a branch, or no cycle is left.
    SettingsError
        If one of ``cycle_number`` and ``branch`` is missing.

    Examples
    --------
    >>> pull = select_samples(
    ...     [0.0, 0.1, 0.2, 0.2], [0.0, 5.0, 9.0, 8.0],
    ...     cycle_number=None, branch=None, break_in_cycles=0,
    ... )
    >>> print(pull.tension)
    [0. 5. 9.]
    """
    strains, tensions = as_same_shape(strain=strain, tension=tension)
    if strains.ndim != 1:
        raise DataError(
            "strain and tension are not series", found=f"shape {strains.shape}", needed="1-D"
        )
    if (cycle_number is None) != (branch is None):
        raise SettingsError(
            "cycle_number and branch go together",
            found="one of them",
            needed="both, or neither for a slow pull",
        )
    is_finite = np.isfinite(strains) & np.isfinite(tensions)
    if cycle_number is None or branch is None:
        number, side = _pull(np.where(is_finite, tensions, -np.inf), break_in_cycles)
    else:
        number, side = np.asarray(cycle_number), np.asarray(branch)
        if not number.shape == side.shape == strains.shape:
            raise DataError(
                "cycle_number and branch do not pair up with the samples",
                found=f"{number.shape} and {side.shape}",
                needed=str(strains.shape),
            )
    use = is_finite & (number > 0) & ((side == 1) | (side == 2))
    if not use.any():
        raise DataError(
            "no sample belongs to a branch",
            found=f"{strains.size} samples, {int(is_finite.sum())} with strain and tension",
            needed="cycles with branches, or a slow pull",
        )
    n_cycles = int(number[use].max())
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than break_in_cycles",
        )
    # of a long test there are samples of some cycles alone: each of those is one, and no other
    there = np.flatnonzero(np.bincount(number[(number > 0) & (number <= n_cycles)]))
    pooled = -(-there.size // _MOST_ROWS)
    k = np.searchsorted(there, number[use]) // pooled
    n_break_in = int(np.searchsorted(there, break_in_cycles, side="right"))
    return BranchSamples(
        strain=strains[use],
        tension=tensions[use],
        row=2 * k + side[use] - 1,
        cycle_number=there[::pooled],
        cycles_pooled=pooled,
        n_break_in=min(-(-n_break_in // pooled), (there.size - 1) // pooled),
        notes=() if pooled == 1 else (f"each row pools {pooled} consecutive cycles",),
    )


def _pull(tension: Floats, break_in_cycles: int) -> tuple[Integers, Integers]:
    if break_in_cycles:
        raise DataError("a slow pull has no break-in", found=f"{break_in_cycles} cycles")
    ascending = np.zeros(tension.size, dtype=np.int64)
    if tension.size:
        ascending[: tension.size - int(np.argmax(tension[::-1]))] = 1
    return ascending, ascending

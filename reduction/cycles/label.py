"""Phase of the test at each sample: rest, approach, hold or cycling.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from reduction.cycles.product import Cycles
from reduction.errors import DataError
from reduction.phases.standstill import Standstills
from reduction.record import Floats
from reduction.samples.blocks import sample_blocks
from reduction.samples.scratch import empty_like
from reduction.vocabulary import PHASE_VALUES


def label_phases(
    time: Floats, *, standstills: Standstills, cycles: Cycles | None
) -> NDArray[np.int8]:
    """Return the phase of each sample, by the values of `reduction.vocabulary.PHASE_VALUES`.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time of the record, beside which the labels lie. [s]
    standstills : Standstills
        Rests and holds. [SI]
    cycles : Cycles or None
        Cycles, where the test has them. [SI]

    Returns
    -------
    phase : ndarray of int8, shape (n_samples,)
        Cycling where a cycle is, dwells included; else rest or hold where the crosshead
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

"""What the turns of a test's wave say of the clocks of its channels; nothing is corrected by it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.cycles.product import Cycles
from reduction.record import Floats, Record
from reduction.uncertainty.lag import LagEstimate, lag_by_turns

_NOTED = 2.0  # standard uncertainties


def lag_of_test(
    record: Record,
    position: Floats,
    tension: Floats,
    cycles: Cycles,
    *,
    stated: Sequence[float] = (),
) -> tuple[LagEstimate, list[str]]:
    """Estimate the lag of each tension channel, and say where it is more than what is stated.

    Parameters
    ----------
    record : Record
        With its clock.
    position : ndarray, shape (n_samples,)
        NaN where not usable. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        NaN where not usable. [N]
    cycles : Cycles
        Where the wave turns.
    stated : sequence of float, length n_specimens, optional
        Standard uncertainty of the lag that is stated; empty where nothing is. [s]

    Returns
    -------
    estimate : LagEstimate
        By specimen.
    notes : list of str
        One a specimen whose tension is late by more than twice what is known.
    """
    turns = np.concatenate([cycles.branch_first.ravel(), cycles.branch_last.ravel()])
    estimate = lag_by_turns(record.time, position, tension, turns)
    known = np.asarray(stated) if len(stated) else np.zeros(len(record.specimens))
    total = np.hypot(estimate.standard_uncertainty, known)
    notes = []
    for place, name in enumerate(record.specimens):
        lag, spread, own = estimate.lag[place], estimate.standard_uncertainty[place], known[place]
        if not lag > _NOTED * total[place]:
            continue
        told = f"a lag of 0 +- {1e3 * own:g} ms is stated" if own else "no lag is stated"
        notes.append(
            f"{name}: tension turns {1e3 * lag:.0f} +- {1e3 * spread:.0f} ms (k=1) later than "
            f"position, and {told}: it was logged late, by at least that, since damping makes it "
            "turn early; nothing is corrected, and loops are too narrow by it"
        )
    return estimate, notes

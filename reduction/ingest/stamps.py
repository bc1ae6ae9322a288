"""Missing time stamps of a log, bridged between those that are there."""

from __future__ import annotations

import numpy as np

from reduction.record import Bools, Floats

__all__ = ["bridge_stamps"]


def bridge_stamps(time: Floats, missing: Bools) -> Floats:
    """Time without missing stamps: even steps between neighbours, the median step at the ends.

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time; NaN where missing, at least one stamp there. [s]
    missing : ndarray of bool, shape (n_samples,)
        Where it is NaN. [1]

    Returns
    -------
    bridged : ndarray, shape (n_samples,)
        The stamps that are there as they are. [s]
    """
    if not missing.any():
        return time
    known = np.flatnonzero(~missing)
    lost = np.flatnonzero(missing)
    steps = np.diff(time[known]) / np.diff(known)
    step = float(np.median(steps)) if steps.size else 0.0
    bridged = time.copy()
    # beyond the ends interp repeats the end; the rows beyond count on from it
    beyond = np.minimum(lost - known[0], 0) + np.maximum(lost - known[-1], 0)
    bridged[lost] = np.interp(lost, known, time[known]) + step * beyond
    return bridged

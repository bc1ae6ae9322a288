"""What the cycles of a run say of the means that a line is found from: scatter and correlation.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 4.2 (type A) and C.3.4 (covariance).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.cycles.product import Loops
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Floats

_FEWEST_CYCLES = 3


def relative_deviations(
    loops: Loops, names: Sequence[str], *, break_in_cycles: int
) -> tuple[Floats, Floats]:
    """Means over the cycles that have every quantity, and how far each cycle is from them.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    names : sequence of str, length n_inputs
        Quantities.
    break_in_cycles : int
        Cycles left out at the start. [1]

    Returns
    -------
    means : ndarray, shape (n_inputs, n_specimens)
        NaN where no cycle is whole. [of the quantity]
    deviations : ndarray, shape (n_inputs, n_specimens, n_cycles)
        Relative to the mean; NaN in cycles that lack a quantity. [1]

    Raises
    ------
    AttributeError
        If the table has no such quantity.

    Notes
    -----
    A cycle that lacks one quantity is left out of all, as type A of several quantities that are
    read together asks ([1]_).

    Examples
    --------
    >>> one = {name: np.full((1, 3), 1.0) for name in Loops.__dataclass_fields__}
    >>> loops = Loops(**one | {"frequency": np.array([[5.0, 0.9, 1.1]]), "uncertainty": {}})
    >>> print(relative_deviations(loops, ["frequency"], break_in_cycles=1)[1].round(3))
    [[[-0.1  0.1]]]
    """
    cycles = np.stack([getattr(loops, name)[:, break_in_cycles:] for name in names])
    whole = np.isfinite(cycles).all(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = np.where(whole, cycles, 0.0).sum(axis=-1) / whole.sum(axis=-1)
        deviations = np.where(whole, cycles, np.nan) / means[..., None] - 1
    return means, deviations


def covariance_of_means(deviations: Floats) -> tuple[Floats, Floats]:
    """Relative covariance of the means over the cycles, neighbouring cycles being alike.

    Parameters
    ----------
    deviations : ndarray, shape (n_inputs, n_specimens, n_cycles)
        From `relative_deviations`. [1]

    Returns
    -------
    covariance : ndarray, shape (n_specimens, n_inputs, n_inputs)
        NaN where there are fewer than three cycles. [1]
    degrees_of_freedom : ndarray, shape (n_specimens,)
        Cycles less one. [1]

    Raises
    ------
    DataError
        Never.

    Notes
    -----
    [1]_.  Each quantity's own likeness of neighbours widens its row and column, so that the
    matrix stays one of a covariance.

    Examples
    --------
    >>> covariance, freedom = covariance_of_means(np.array([[[-0.1, 0.1, -0.1, 0.1]]]))
    >>> print(covariance.round(5), freedom)
    [[[0.00333]]] [3.]
    """
    n_inputs, n_specimens, _ = deviations.shape
    covariance = np.full((n_specimens, n_inputs, n_inputs), np.nan)
    freedom = np.zeros(n_specimens)
    for place in range(n_specimens):
        kept = deviations[:, place, np.isfinite(deviations[:, place]).all(axis=0)]
        freedom[place] = max(kept.shape[1] - 1, 0)
        if kept.shape[1] < _FEWEST_CYCLES:
            continue
        kept = kept - kept.mean(axis=1, keepdims=True)
        widened = kept * np.sqrt([[lag_one_inflation(row)] for row in kept])
        # sums, not dot products, whose last digits depend on the number of threads
        products = (widened[:, None] * widened[None]).sum(axis=-1)
        covariance[place] = products / (kept.shape[1] - 1) / kept.shape[1]
    return covariance, freedom

"""What the programmes share: one break strength a specimen, and means that pass over gaps.

References
----------
.. [1] CG-D-39-80, Table 2 (rated break strengths).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def one_a_specimen(rated_break_strength: ArrayLike, n_specimens: int) -> Floats:
    """Rated break strength of each specimen.

    Parameters
    ----------
    rated_break_strength : array_like, shape () or (n_specimens,)
        NaN where not stated. [N]
    n_specimens : int
        Number of specimens. [1]

    Returns
    -------
    strength : ndarray, shape (n_specimens,)
        As given. [N]

    Raises
    ------
    DataError
        If a strength is not positive, or their number does not fit.

    Examples
    --------
    >>> one_a_specimen(28470.0, 2)
    array([28470., 28470.])
    """
    strength = np.asarray(rated_break_strength, dtype=np.float64)
    if strength.shape not in ((), (n_specimens,)) or (strength <= 0).any():
        raise DataError(
            "the rated break strength does not fit the specimens",
            found=f"{strength.tolist()}",
            needed=f"{n_specimens} positive numbers, NaN where not stated",
        )
    return np.broadcast_to(strength, (n_specimens,))


def mean_of_rows(values: Floats) -> Floats:
    """Mean over the last axis of what is known.

    Parameters
    ----------
    values : ndarray, shape (..., n)
        NaN is left out. [any]

    Returns
    -------
    mean : ndarray, shape (...)
        NaN where nothing is known. [any]

    Raises
    ------
    numpy.exceptions.AxisError
        If the values have no axis.

    Examples
    --------
    >>> print(mean_of_rows(np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan]])))
    [ 2. nan]
    """
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        mean: Floats = np.where(known, values, 0.0).sum(axis=-1) / known.sum(axis=-1)
    return mean

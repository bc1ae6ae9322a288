"""Noise of a sampled, digitized series, read from the series itself.

References
----------
.. [1] B. Widrow and I. Kollar, "Quantization Noise," Cambridge Univ. Press, 2008, ch. 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.samples.blocks import sample_blocks


def sample_noise(values: ArrayLike) -> tuple[float, float]:
    """Noise of single samples and the step of the digitizer, from the series itself.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        A series that changes slowly. [any unit]

    Returns
    -------
    noise : float
        Root mean square of neighbouring differences over the square root of two.
        [unit of the series]
    quantum : float
        Smallest difference between unequal values; 0 where all are equal. [unit of the series]

    Raises
    ------
    DataError
        If there are fewer than two samples.

    Notes
    -----
    A series quieter than half its quantum has an error of the quantum over the root of
    12 that no averaging removes.  The quantum is taken from at most 4096 samples.

    Examples
    --------
    >>> noise, quantum = sample_noise([1.0, 1.5, 1.0, 1.5])
    >>> print(round(noise, 3), quantum)
    0.354 0.5
    """
    series = np.asarray(values, dtype=np.float64)
    if series.size < 2:
        raise DataError("no noise can be read from one sample", found=f"{series.size}", needed="2")
    steps = np.diff(np.unique(series[:4096]))
    greatest, squares = [], 0.0
    for part in sample_blocks(series.size, series, overlap=1):
        greatest.append(np.max(np.abs(series[part])))
        squares += float(np.sum(np.diff(series[part]) ** 2))
    steps = steps[steps > 1e-9 * max(1e-300, float(np.max(greatest)))]
    noise = float(np.sqrt(squares / (series.size - 1) / 2))
    return noise, float(steps.min()) if steps.size else 0.0

"""How many independent points the residuals of a curve are worth.

References
----------
.. [1] C. J. Geyer, "Practical Markov chain Monte Carlo," Statist. Sci., vol. 7, 1992 (the
   initial positive sequence).
.. [2] N. F. Zhang, "Calculation of the uncertainty of the mean of autocorrelated
   measurements," Metrologia, vol. 43, 2006.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.record import Floats


def autocorrelation_length(residual: ArrayLike) -> float:
    r"""Number of neighbouring points that err together.

    .. math:: \tau = 1 + 2 \sum_k \rho_k

    Parameters
    ----------
    residual : array_like, shape (n_strain,)
        In the order of strain, about zero, over its standard deviation. [1]

    Returns
    -------
    length : float
        1 for residuals without memory, never less; n for residuals of one sign. [1]

    Raises
    ------
    DataError
        If a residual is not finite.

    Notes
    -----
    The sum ends before the first pair of lags whose correlations add up to less than nothing
    [1]_.  The variance of a mean of such residuals is that of n / tau points [2]_.

    Examples
    --------
    Signs that change every ten points: the correlation falls to zero within five, and points
    err about seven at a time.

    >>> wave = np.tile(np.repeat([1.0, -1.0], 10), 10)
    >>> print(5 < autocorrelation_length(wave) < 10)
    True
    """
    r: Floats = as_finite("residual", residual)
    n = r.size
    power = float(r @ r)
    if n < 3 or power == 0:
        return 1.0
    padded = np.fft.rfft(r, 2 * n)
    rho = np.fft.irfft(padded * padded.conj(), 2 * n)[:n] / power
    pairs = rho[: n - n % 2].reshape(-1, 2).sum(axis=1)
    ended = np.flatnonzero(pairs <= 0)
    length = 2 * pairs[: ended[0] if ended.size else pairs.size].sum() - 1
    return float(np.clip(length, 1.0, n))

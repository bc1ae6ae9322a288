"""What a moving window adds to a curved modulus, from the curve itself.

References
----------
.. [1] A. Savitzky and M. J. E. Golay, "Smoothing and differentiation of data by
   simplified least squares procedures," Anal. Chem., vol. 36, 1964.
.. [2] J. W. Tukey, *Exploratory Data Analysis*. Reading, MA: Addison-Wesley, 1977
   (a smoother applied to what it left: "twicing").
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def _overlap(shift: float) -> float:
    """Correlation of two window slopes of white noise, centres ``shift`` windows apart."""
    if shift >= 1:
        return 0.0
    low = shift - 0.5
    return 12 * ((0.125 - low**3) / 3 - shift / 2 * (0.25 - low**2))


def window_blur(slope: ArrayLike, *, half_window: int) -> tuple[Floats, float]:
    r"""Excess of a window slope over the slope at the window's centre.

    .. math::

        \hat E - E = \frac{W^2}{40} E'' + O(W^4)

    with :math:`E''` from the second difference of the curve over half a window.

    Parameters
    ----------
    slope : array_like, shape (..., n_bins)
        Window slopes at the bin centres, NaN where not supported. [SI]
    half_window : int
        Bins on each side of the centre bin in the window. [1]

    Returns
    -------
    blur : ndarray, shape (..., n_bins)
        What to take off the slope; zero where a curve is too short to tell. [SI]
    noise_gain : float
        Factor by which taking it off raises the standard deviation of the slope. [1]

    Raises
    ------
    DataError
        If ``half_window`` is below 1.

    Notes
    -----
    Derivation: over samples spread evenly on :math:`[-W/2, W/2]` the regression slope
    of :math:`y = u^3` is :math:`\int u^4 / \int u^2 = 3 W^2 / 20`, and
    :math:`E'' = y''' = 6`. The step of the second difference is one bin more than
    ``half_window``; nearer than that to the end of a curve the blur is that of the
    nearest bin that has one. A jump of the modulus stays spread over the window.

    The gain is that of white noise under the combined kernel, about 1.2.

    Examples
    --------
    The window slope of a cubic, E = 3 x2, in windows of 5 bins of width 1, is high by
    25 / 40 of 6.

    >>> import numpy as np
    >>> centre = np.arange(-10.0, 11.0)
    >>> blur, gain = window_blur(3 * centre**2 + 3.75, half_window=2)
    >>> print(blur[0], blur[10], round(gain, 2))
    3.75 3.75 1.19
    """
    if half_window < 1:
        raise DataError("a window is a bin wide", found=f"half_window {half_window}", needed="1")
    slopes = np.asarray(slope, dtype=np.float64)
    step, n_window = half_window + 1, 2 * half_window + 1
    share = (n_window / step) ** 2 / 40
    blur = np.zeros_like(slopes)
    n_bins = slopes.shape[-1]
    if n_bins > 2 * step:
        bend = slopes[..., 2 * step :] - 2 * slopes[..., step:-step] + slopes[..., : -2 * step]
        inner = np.arange(step, n_bins - step)
        for curve in np.ndindex(bend.shape[:-1]):
            known = np.isfinite(bend[curve])
            if known.any():
                blur[curve] = share * np.interp(np.arange(n_bins), inner[known], bend[curve][known])
    shift = step / n_window
    variance = (
        (1 + 2 * share) ** 2
        + 2 * share**2 * (1 + _overlap(2 * shift))
        - 4 * share * (1 + 2 * share) * _overlap(shift)
    )
    return blur, sqrt(variance)

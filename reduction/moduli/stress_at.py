"""Stress at a stated elongation: what the rubber trade calls M100, and is not a modulus.

References
----------
.. [1] ASTM D412, "Standard test methods for vulcanized rubber and thermoplastic
   elastomers - tension" ("tensile stress at given elongation").
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats

__all__ = ["stress_at_strain"]


def stress_at_strain(
    strain_bin: ArrayLike,
    branch_tension: ArrayLike,
    *,
    area: ArrayLike,
    levels: Sequence[float],
) -> Floats:
    r"""Nominal stress at stated elongations on the curves of a branch.

    Parameters
    ----------
    strain_bin : array_like, shape (n_bins,)
        Bin centres. [1]
    branch_tension : array_like, shape (n_specimens, ..., n_bins)
        Tension at them, of a first loading or of a branch over the cycles. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    levels : sequence of float
        Elongations; 1.0 is 100 %. [1]

    Returns
    -------
    stress : ndarray, shape (n_specimens, ..., n_levels)
        Nominal stress. [Pa]

    Raises
    ------
    DataError
        If an area is not positive or the arrays do not pair up.

    Notes
    -----
    [1]_ takes it on the first loading; on later cycles it is lower, and a descending
    branch gives less than an ascending one: a value without its branch says little.

    Straight lines between neighbouring bins. NaN at a level that is not between two
    neighbouring bins with tension: nothing is extrapolated or carried over a gap.

    Examples
    --------
    >>> print(stress_at_strain([0.9, 1.1], [[90.0, 110.0]], area=[1e-4], levels=(1.0, 2.0)))
    [[1000000.      nan]]
    """
    areas = np.atleast_1d(as_positive("area", area))
    strain = np.asarray(strain_bin, dtype=np.float64)
    tension = np.asarray(branch_tension, dtype=np.float64)
    if tension.shape[-1:] != strain.shape or tension.shape[:1] != areas.shape or strain.size < 2:
        raise DataError(
            "strain, tension and area do not pair up",
            found=f"strain {strain.shape}, tension {tension.shape}, area {areas.shape}",
            needed="(n_bins,), (n_specimens, ..., n_bins), (n_specimens,), 2 bins or more",
        )
    level = np.asarray(levels, dtype=np.float64)
    below = np.clip(np.searchsorted(strain, level, side="right") - 1, 0, strain.size - 2)
    share = (level - strain[below]) / (strain[below + 1] - strain[below])
    share = np.where((share >= 0) & (share <= 1), share, np.nan)
    at_level = tension[..., below] * (1 - share) + tension[..., below + 1] * share
    return np.asarray(at_level / areas.reshape(-1, *[1] * (tension.ndim - 1)))

"""Nominal stress at a stated elongation on a first loading: M100 and the like.

The rubber trade calls this stress "modulus" (M100, M300).  It is a stress, never mixed
with a modulus here: on a curve through the origin it is the secant modulus times the strain.

References
----------
.. [1] ASTM D412 usage: tensile stress at given elongation, on a first loading.
.. [2] WHOI-2005-10, sec. 2.3.2: a tether carries about 85 lb at 100 % stretch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive, as_same_shape
from reduction.record import Bools, Floats, Integers
from reduction.samples.search import first_sample, last_sample

# samples before the level that make the line, and the strain that it may span
_SAMPLES = 12
_SPAN = 0.1
_FEWEST = 4


def stress_at_strain(
    strain: ArrayLike,
    tension: ArrayLike,
    *,
    area: float,
    levels: Sequence[float],
    is_still: Callable[[slice], Bools] | None = None,
) -> tuple[Floats, Floats, tuple[str, ...]]:
    r"""Nominal stress where a record first passes stated elongations.

    .. math:: \sigma_L = F(\varepsilon = L) / A

    Parameters
    ----------
    strain : array_like, shape (n_samples,)
        Of one specimen; NaN where missing. [1]
    tension : array_like, shape (n_samples,)
        NaN where missing. [N]
    area : float
        Cross-sectional area at zero tension. [m2]
    levels : sequence of float
        Elongations; 1.0 is 100 %. [1]
    is_still : callable, optional
        Of a slice:
        Samples in a hold or rest, whose tension relaxes; they are left out. [1]

    Returns
    -------
    stress, stress_standard_uncertainty : ndarray, shape (n_levels,)
        NaN where a level is not reached, or not measured. [Pa]
    reasons : tuple of str, length n_levels
        Why a level within the range of the record has no number; empty elsewhere. [text]

    Raises
    ------
    DataError
        If the area is not positive or the series do not pair up.

    Notes
    -----
    A line through the samples just before the level, twelve at most and within 10 % of
    strain, read at the level: what comes after (a hold, the turn) does not enter.  The
    uncertainty is that of the line there (type A).

    Examples
    --------
    >>> x = np.linspace(0, 2, 401)
    >>> stress, _, _ = stress_at_strain(x, 100 * x, area=1e-4, levels=(1.0, 3.0))
    >>> print(stress.round(3))
    [1000000.      nan]
    """
    section = float(as_positive("area", area))
    stretch, load = as_same_shape(strain=strain, tension=tension)

    def known(part: slice) -> Bools:
        found: Bools = np.isfinite(stretch[part]) & np.isfinite(load[part])
        return found if is_still is None else found & ~is_still(part)

    def first_at(level: float) -> int | None:
        return first_sample(
            lambda part: known(part) & (stretch[part] >= level), 0, stretch.size, stretch, load
        )

    begin = first_sample(known, 0, stretch.size, stretch, load)
    stress, uncertainty = np.full((2, len(levels)), np.nan)
    reasons = [""] * len(levels)
    for index, level in enumerate(levels):
        reached = first_at(level)
        if reached is None or reached == begin:
            continue
        used = _last_of(known, reached + 1)
        near = stretch[used] >= level - _SPAN
        # a gap in the samples ends the line: a hold, or a reading that was left out
        joined = np.concatenate([np.cumsum(np.diff(used)[::-1] > 1)[::-1] == 0, [True]])
        x, y = stretch[used][near & joined] - level, load[used][near & joined]
        if x.size < _FEWEST:
            reasons[index] = f"{x.size} samples within 10 % before it; needed {_FEWEST}"
            continue
        mean, square = x.mean(), float(np.sum((x - x.mean()) ** 2))
        slope = float(np.sum((x - mean) * y)) / square
        left = y - y.mean() - slope * (x - mean)
        variance = float(left @ left) / (x.size - 2)
        stress[index] = (y.mean() - slope * mean) / section
        uncertainty[index] = np.sqrt(variance * (1 / x.size + mean**2 / square)) / section
    return stress, uncertainty, tuple(reasons)


def _last_of(known: Callable[[slice], Bools], stop: int) -> Integers:
    """The last samples before one that are known, as many as make the line."""
    found: list[int] = []
    while len(found) < _SAMPLES:
        at = last_sample(known, 0, found[-1] if found else stop)
        if at is None:
            break
        found.append(at)
    return np.array(found[::-1])

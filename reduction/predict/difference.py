"""How much less the improved wave load is than the classic one.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 18-19, Tables 7 and 8.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.predict.extremes import LoadExtremes
from reduction.predict.morison import WaveLoad
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class LoadDifference:
    """Classic less improved load over the classic one.

    Parameters
    ----------
    horizontal, vertical : ndarray, shape (..., n_times)
        NaN where the classic load is a small share of its greatest magnitude. [1]
    horizontal_of_maximum, horizontal_of_minimum : ndarray, shape (...)
        Of the extremes over a period, wherever each has its own. [1]
    vertical_of_maximum, vertical_of_minimum : ndarray, shape (...)
        The same. [1]
    minimum_share : float
        Below which a difference has no meaning. [1]
    """

    horizontal: Floats
    vertical: Floats
    horizontal_of_maximum: Floats
    horizontal_of_minimum: Floats
    vertical_of_maximum: Floats
    vertical_of_minimum: Floats
    minimum_share: float


def load_difference(
    load: WaveLoad, extremes: LoadExtremes, *, minimum_share: float = 0.1
) -> LoadDifference:
    """How much less the improved load is than the classic one, where that means something.

    Parameters
    ----------
    load : WaveLoad
        Over time.
    extremes : LoadExtremes
        Of the same loads.
    minimum_share : float
        Of the greatest magnitude of the classic load over a period; below it the difference
        is NaN. [1]

    Returns
    -------
    difference : LoadDifference
        Shares of the classic load.

    Raises
    ------
    SettingsError
        If the share is not above 0 and at most 1.

    Notes
    -----
    Eq. (18) and (19) of [1]_.  Drag and inertia vanish at different times and are cut by
    different shares, so the two loads pass zero at different times, where P of eq. (19) is
    any number: 35.85 % in Table 7 is at 8 % of the greatest load.  Its mean over a period does
    not exist, and that of Table 8 depends on the times chosen.  The differences of the
    extremes have no such trouble.

    Examples
    --------
    The drag is cut by 1 - h/D and the inertia by 1 - S1/S0, hence the load by what is between.

    >>> from reduction.predict.extremes import find_extremes
    >>> from reduction.predict.immersion import immerse_hose
    >>> from reduction.predict.morison import wave_load
    >>> from reduction.predict.waves import airy_wave
    >>> hose = immerse_hose(outer_diameter=0.114, wall_thickness=0.006, wall_density=1250.0,
    ...                     content_density=830.0, water_density=1025.0)
    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=-0.038)
    >>> load, extremes = wave_load(wave, hose, [0.0]), find_extremes(wave, hose)
    >>> difference = load_difference(load, extremes)
    >>> print(difference.horizontal.round(4), difference.horizontal_of_maximum.round(4))
    [0.1656] 0.1595
    """
    if not 0 < minimum_share <= 1:
        raise SettingsError(
            "minimum_share is no share", found=f"{minimum_share:g}", needed="above 0, at most 1"
        )
    pairs = {
        "horizontal": (extremes.horizontal, extremes.horizontal_classic),
        "vertical": (extremes.vertical, extremes.vertical_classic),
    }
    found: dict[str, Floats] = {}
    for name, (improved, classic) in pairs.items():
        whole = getattr(load, f"{name}_classic")
        means_something = np.abs(whole) >= minimum_share * classic.greatest[..., None]
        found[name] = _cut(getattr(load, name), np.where(means_something, whole, np.nan))
        found[f"{name}_of_maximum"] = _cut(improved.maximum, classic.maximum)
        found[f"{name}_of_minimum"] = _cut(improved.minimum, classic.minimum)
    return LoadDifference(**found, minimum_share=minimum_share)


def _cut(improved: Floats, classic: Floats) -> Floats:
    return np.asarray(1 - improved / np.where(classic == 0, np.nan, classic))

"""Peak and minimum tension of a cycle, and the rule of the source for how high it may go.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Bools, Floats, freeze_arrays

__all__ = ["LOADED_SHARE", "SLACK_SHARE", "CycleLoads", "cycle_loads"]

LOADED_SHARE = 0.6
"""Greatest share of the break strength for a line that is always loaded. [1]"""
SLACK_SHARE = 0.3
"""The same for a line that goes slack. [1]"""
_SLACK = 1e-9


@dataclass(frozen=True)
class CycleLoads:
    """Ends of a cycle of tension; arrays have the shape (...) of the points.

    ``is_slack`` where the minimum is zero; ``is_above_rule`` where the peak is above the share
    that the source allows. Shares are NaN where the break strength is not known.
    """

    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats
    is_slack: Bools
    is_above_rule: Bools

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze_arrays(self)


def cycle_loads(
    mean_tension: ArrayLike, tension_amplitude: ArrayLike, *, rated_break_strength: float
) -> CycleLoads:
    """Peak and minimum tension of a cycle, as loads and as shares of the break strength.

    Parameters
    ----------
    mean_tension, tension_amplitude : array_like, shape (...)
        Amplitude is half the range. [N]
    rated_break_strength : float
        NaN where not known. [N]

    Returns
    -------
    loads : CycleLoads
        With the rule of the source.

    Raises
    ------
    DataError
        If an amplitude is above its mean: the line would be pushed; or is negative.

    Notes
    -----
    Source: [1]_: at most 60 % of the break strength where a line is always loaded, 30 % where it
    goes slack.

    Examples
    --------
    Mean 21 % and amplitude 8.5 % of the break strength:

    >>> loads = cycle_loads(2100.0, 850.0, rated_break_strength=1e4)
    >>> print(loads.peak_share, loads.minimum_share, loads.is_above_rule)
    0.295 0.125 False
    """
    mean = np.asarray(mean_tension, dtype=np.float64)
    amplitude = np.asarray(tension_amplitude, dtype=np.float64)
    mean, amplitude = np.broadcast_arrays(mean, amplitude)
    if np.any(amplitude < 0):
        raise DataError("an amplitude is negative", found=f"{amplitude.min():g} N")
    least = mean - amplitude
    pushed = least < -_SLACK * np.maximum(mean, 1.0)
    if np.any(pushed):
        first = np.unravel_index(int(np.argmax(pushed)), pushed.shape)
        raise DataError(
            f"{int(pushed.sum())} of {pushed.size} amplitudes are above their mean tension: the "
            "line goes slack, and no surface knows of that",
            found=f"{amplitude[first]:.4g} N about {mean[first]:.4g} N",
            needed="an amplitude of at most the mean",
        )
    peak, least = mean + amplitude, np.maximum(least, 0.0)
    is_slack = least <= _SLACK * peak
    with np.errstate(invalid="ignore"):
        peak_share, least_share = peak / rated_break_strength, least / rated_break_strength
        above = peak_share > np.where(is_slack, SLACK_SHARE, LOADED_SHARE)
    return CycleLoads(
        peak_tension=np.asarray(peak),
        minimum_tension=np.asarray(least),
        peak_share=np.asarray(peak_share),
        minimum_share=np.asarray(least_share),
        is_slack=np.asarray(is_slack),
        is_above_rule=np.asarray(above),
    )

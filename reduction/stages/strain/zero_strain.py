"""Where a specimen without splices has no strain: at slack, or at the tension of its gauge length.

A rubber cord is measured slack.  A rope hangs in a curve then and is measured under a small
tension that is part of its gauge length, usually a hundredth or two of its break strength ([1]_),
so that its strain counts from that tension.

References
----------
.. [1] ISO 2307:2019, "Fibre ropes - Determination of certain physical and mechanical
   properties" (reference tension, under which length and linear density are measured).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats
from reduction.record.samples import first_sample, last_sample
from reduction.stages.standstills import Standstills, noise_range

# of the reference tension to either side of it: a rope's curve is straight there
_BAND = 0.2

_FEWEST = 4  # samples in the band, for a line and its residual


@dataclass(frozen=True)
class ZeroStrain:
    """Where strain is zero in one test, of one specimen.

    ``position`` [m] is None where nothing says it, ``standard_uncertainty`` [m] that of reading
    it from the log, ``compliance`` [m/N] how far it moves with the tension that it stands for,
    ``is_logged`` whether it is a position of the log itself, ``reference_tension`` [N] the
    tension there, zero at slack, and ``stated_position`` [m] where the layout has that tension.
    """

    position: float | None = None
    standard_uncertainty: float = 0.0
    compliance: float = 0.0
    is_logged: bool = False
    reference_tension: float = 0.0
    stated_position: float | None = None


def zero_at_slack(
    standstills: Standstills, *, position_is_length: bool, length_at_slack: float | None = None
) -> ZeroStrain:
    """Position of the first rest, else that at which the layout says that the specimen is slack.

    Examples
    --------
    >>> none = np.empty(0)
    >>> no_rest = Standstills(none, none, none, none, none, np.empty((1, 0)), none > 0, 0.01, 5.0)
    >>> print(zero_at_slack(no_rest, position_is_length=False).position)
    0.0
    """
    rests = standstills.mean_position[standstills.is_rest]
    if rests.size:
        return ZeroStrain(float(rests[0]), is_logged=True)
    return ZeroStrain(length_at_slack if position_is_length else 0.0)


def half_band_of(reference_tension: float, tension: Floats) -> float:
    """By how much a reading at the reference tension may miss it: a fifth of it, or noise. [N]."""
    return max(_BAND * reference_tension, float(noise_range(tension)) / 2)


def zero_at_tension(
    position: Floats,
    tension: Floats,
    *,
    reference_tension: float,
    stated_position: float | None = None,
) -> ZeroStrain:
    r"""Position at which a specimen first has its reference tension.

    .. math:: p = p_0 + c\,(F - F_0)

    Parameters
    ----------
    position : ndarray, shape (n_samples,)
        Of the crosshead; NaN where not usable. [m]
    tension : ndarray, shape (n_samples,)
        Of the specimen. [N]
    reference_tension : float
        Under which its gauge length was read. [N]
    stated_position : float, optional
        Where the layout says that the tension is that one; it counts where the log begins above
        the reference tension. [m]

    Returns
    -------
    zero : ZeroStrain
        Without a position where neither says it.

    Raises
    ------
    DataError
        If the reference tension is not positive.

    Notes
    -----
    The first rise of the log through the reference tension, or the hold at it with which the log
    begins: a line of position on tension over a fifth of that tension to either side, or over the
    noise where that is wider; through the two samples beside it where too few lie there.  What a
    later cycle has at that tension is creep and hysteresis, and is strain.

    Examples
    --------
    A rope of 20 kN a metre that is pulled from slack, and has 400 N at 0.12 m.

    >>> place = np.linspace(0, 1, 2001)
    >>> zero = zero_at_tension(place, 2e4 * np.clip(place - 0.1, 0, None), reference_tension=400.0)
    >>> print(round(zero.position, 6), zero.is_logged)
    0.12 True
    """
    if not reference_tension > 0:
        raise DataError(
            "a reference tension is not positive", found=f"{reference_tension:g} N",
            needed="the tension under which the gauge length was read",
        )  # fmt: skip
    stated = ZeroStrain(stated_position, reference_tension=reference_tension)
    if np.count_nonzero(np.isfinite(tension)) < 2 * _FEWEST:
        return stated
    half = half_band_of(reference_tension, tension)

    def is_above(part: slice) -> Bools:
        return (tension[part] > reference_tension + half) & np.isfinite(position[part])

    def is_below(part: slice) -> Bools:
        return (tension[part] < reference_tension - half) & np.isfinite(position[part])

    above = first_sample(is_above, 0, tension.size, tension, position)
    stop = tension.size if above is None else above + 1
    below = last_sample(is_below, 0, stop, tension, position)
    rise = slice(0 if below is None else below, stop)
    place, load = np.array(position[rise]), np.array(tension[rise]) - reference_tension
    known = np.isfinite(place) & np.isfinite(load)
    place, load = place[known], load[known]
    near = np.abs(load) <= half
    if near.sum() < _FEWEST:
        if above is None or below is None:
            return stated
        # the ramp passes the band within a few samples
        compliance = float((place[-1] - place[0]) / (load[-1] - load[0]))
        between = float(np.interp(0.0, load[[0, -1]], place[[0, -1]]))
        spread = abs(float(place[-1] - place[0])) / 12**0.5
        return ZeroStrain(
            between, spread, compliance, True, reference_tension, stated_position
        )  # fmt: skip
    place, load = place[near], load[near]
    design = np.stack([np.ones_like(load), load - load.mean()], axis=1)
    (middle, compliance), *_ = np.linalg.lstsq(design, place)
    residual = place - design @ [middle, compliance]
    spread = float(np.sqrt(residual @ residual / (load.size - 2) / load.size))
    return ZeroStrain(
        float(middle - compliance * load.mean()), spread, float(compliance), True,
        reference_tension, stated_position,
    )  # fmt: skip

"""Peak and minimum tension of a cycle, and the rule of the source for how high or low it may go.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 3.4, 5.0.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.digits import plain_number
from reduction.errors import DataError
from reduction.lookup.curve import evaluate_curve
from reduction.lookup.product import LineSource
from reduction.record import Bools, Floats, read_only_arrays

LOADED_SHARE = 0.6
"""Greatest share of the break strength for a line that is always loaded. [1]"""
SLACK_SHARE = 0.3
"""The same for a line that goes slack. [1]"""
LEAST_SHARE = 0.03
"""Least tension over the break strength with which a line was found to keep its strength. [1]"""
_SLACK = 1e-9


@dataclass(frozen=True)
@read_only_arrays
class CycleLoads:
    """Ends of a cycle of tension; arrays have the shape (...) of the points.

    ``is_slack`` where the minimum is zero; ``is_above_rule`` where the peak is above the share
    that the source allows. Shares are of the rated break strength, ``own`` ones of the strength
    that the line has in its condition; NaN where that is not known.
    """

    peak_tension: Floats
    minimum_tension: Floats
    peak_share: Floats
    minimum_share: Floats
    own_peak_share: Floats
    own_minimum_share: Floats
    is_slack: Bools
    is_above_rule: Bools


def cycle_loads(
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    *,
    rated_break_strength: float,
    tensile_strength: float = float("nan"),
) -> CycleLoads:
    """Peak and minimum tension of a cycle, as loads and as shares of the break strength.

    Parameters
    ----------
    mean_tension, tension_amplitude : array_like, shape (...)
        Amplitude is half the range. [N]
    rated_break_strength : float
        NaN where not known. [N]
    tensile_strength : float, optional
        That the line has in its condition; the rated one where not known. [N]

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
    goes slack.  Between 3 % and 62 % (sec. 5.0) it kept its strength, from zero to above 30 % it
    failed; nothing was tested with less than 3 %, and the lower share is taken there.  Of a line
    that lost strength the share is that of what it has left.

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
            found=f"{plain_number(amplitude[first], 4)} N about {plain_number(mean[first], 4)} N",
            needed="an amplitude of at most the mean",
        )
    peak, least = mean + amplitude, np.maximum(least, 0.0)
    is_slack = least <= _SLACK * peak
    with np.errstate(invalid="ignore"):
        peak_share, least_share = peak / rated_break_strength, least / rated_break_strength
        own_peak, own_least = peak_share, least_share
        if np.isfinite(tensile_strength):
            own_peak, own_least = peak / tensile_strength, least / tensile_strength
        is_low = own_least < LEAST_SHARE * (1 - _SLACK)
        above = own_peak > np.where(is_low, SLACK_SHARE, LOADED_SHARE) * (1 + _SLACK)
    return CycleLoads(
        peak_tension=np.asarray(peak),
        minimum_tension=np.asarray(least),
        peak_share=np.asarray(peak_share),
        minimum_share=np.asarray(least_share),
        own_peak_share=np.asarray(own_peak),
        own_minimum_share=np.asarray(own_least),
        is_slack=np.asarray(is_slack),
        is_above_rule=np.asarray(above),
    )


def loads_of_line(
    line: LineSource, given: Mapping[str, Floats], shape: tuple[int, ...], *, branch: str = ""
) -> CycleLoads:
    """Ends of the tension at the points of a look-up.

    Parameters
    ----------
    line : LineSource
        Whose rule and break strength count.
    given : mapping of str to ndarray, shape (...)
        Levels that broadcast to ``shape``. [SI]
    shape : tuple of int
        Of the points.
    branch : {"", "ascending", "descending"}
        Of the value that is looked up, where it differs by branch.

    Returns
    -------
    loads : CycleLoads
        Of mean and amplitude; where one tension is given, or follows from the strain on the same
        branch, peak and minimum are that one; else NaN.

    Raises
    ------
    DataError
        If an amplitude is above its mean, a tension is negative, or a tether goes slack.

    Notes
    -----
    The rule of [1]_ is of nylon and polyester, where zero tension lowers what a line stands; a
    tether of rubber must not go slack at all, since it tangles and is cut ([2]_).  Beyond a
    curve that is given by points the tension is not known, and no rule can be checked.

    Examples
    --------
    >>> rope = LineSource("a", "", "nylon", "braid", "new", 0.0127, 1e4)
    >>> loads = loads_of_line(rope, {"mean_tension": np.array(3000.0)}, ())
    >>> print(loads.peak_share, loads.minimum_share)
    0.3 0.3
    """
    if {"mean_tension", "tension_amplitude"} <= set(given):
        mean, amplitude = given["mean_tension"], given["tension_amplitude"]
    else:
        mean, amplitude = _one_tension(line, given, branch), np.zeros(())
    known = np.where(np.isfinite(mean), mean, 0.0) if np.isnan(mean).any() else mean
    loads = cycle_loads(
        np.broadcast_to(known, shape),
        np.broadcast_to(amplitude, shape),
        rated_break_strength=line.rated_break_strength,
        tensile_strength=line.tensile_strength,
    )
    if known is not mean:
        unknown = np.broadcast_to(np.isnan(mean), shape)
        loads = _unknown_at(loads, unknown)
    if line.is_tether:
        _refuse_slack(line, loads)
        # the shares of the rule are of fibres
        loads = replace(loads, is_above_rule=np.zeros(shape, dtype=bool))
    return loads


def _one_tension(line: LineSource, given: Mapping[str, Floats], branch: str) -> Floats:
    """Tension at points without a cycle; NaN where it is not known."""
    for name in ("tension", "mean_tension"):
        if name in given:
            if np.any(given[name] < 0):
                raise DataError(
                    f"{name} is negative", found=f"{plain_number(given[name].min(), 4)} N"
                )
            return given[name]
    if "strain" in given:
        for curve in line.curves:
            if curve.quantity == "branch_tension" and curve.branch == branch:
                # noise about zero is zero
                return np.maximum(evaluate_curve(curve, given["strain"]).value, 0.0)
    return np.asarray(np.nan)


def _unknown_at(loads: CycleLoads, unknown: Bools) -> CycleLoads:
    numbers = (
        "peak_tension", "minimum_tension", "peak_share", "minimum_share", "own_peak_share",
        "own_minimum_share",
    )  # fmt: skip
    return replace(
        loads,
        **{name: np.where(unknown, np.nan, getattr(loads, name)) for name in numbers},
        is_slack=loads.is_slack & ~unknown,
    )


def _refuse_slack(line: LineSource, loads: CycleLoads) -> None:
    if loads.is_slack.any():
        peak = loads.peak_tension[loads.is_slack].ravel()[0]
        raise DataError(
            f"{line.name} goes slack at {int(loads.is_slack.sum())} of {loads.is_slack.size} "
            "points, and a tether must not",
            found=f"a minimum tension of zero, peak {plain_number(peak, 4)} N",
            needed="a minimum above zero",
            hint="A slack tether tangles and is cut: more stretch, or less amplitude.",
        )

"""Pairs of holds of a quasi-static programme: from a lower tension to a higher one.

References
----------
.. [1] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length
   Properties of Fibre Rope," OIPEEC (abstract: static stiffness beside dynamic stiffness
   and polymer strain).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.errors import DataError, FitError
from reduction.holds.relaxation import end_mean
from reduction.holds.select import select_hold
from reduction.holds.support import Hold
from reduction.line.static import StaticStiffness, static_stiffness
from reduction.line.strength import one_a_specimen
from reduction.phases.standstill import Standstills
from reduction.record import Floats
from reduction.samples.columns import chosen

# a hold is a step up where its tension is above the last one's by this share of it
_LEAST_RISE = 0.05
_FINAL_SHARE = 0.05


@dataclass(frozen=True)
class HeldPair:
    """A lower hold and the higher one after it, of one specimen.

    Parameters
    ----------
    specimen : str
        Which specimen.
    low_hold, high_hold : int
        Numbers of the holds in the test, by time from 1.
    low_tension, high_tension : float
        At the end of each hold. [N]
    stiffness : StaticStiffness or None
        Secant between them against the time for which the higher one was held.
    reason : str
        Why there is no stiffness; empty where there is.
    low_tension_standard_uncertainty, high_tension_standard_uncertainty : float
        Of the means at the ends (type A). [N]
    low_strain : float
        At the end of the lower hold, from which the stiffness counts; NaN where none is known. [1]
    """

    specimen: str
    low_hold: int
    high_hold: int
    low_tension: float
    high_tension: float
    stiffness: StaticStiffness | None
    reason: str = ""
    low_tension_standard_uncertainty: float = float("nan")
    high_tension_standard_uncertainty: float = float("nan")
    low_strain: float = float("nan")


def _end_of(values: Floats) -> tuple[float, float]:
    """Mean over the end of a hold, with its standard uncertainty."""
    return end_mean(values, n_samples=max(3, int(_FINAL_SHARE * values.size)), at_end=True)


def _stiffness(low: Hold, high: Hold, *, strength: float, reference_time: float) -> StaticStiffness:
    """Line in the logarithm of time, with what is not known of the end of the lower hold."""
    if high.ramp is None:
        raise DataError(
            "the record does not show the ramp to the upper hold, so the time since loading is "
            "not known"
        )
    (known,) = chosen(lambda part: np.isfinite(low.strain[part]), low.strain)
    if known.size < 3:
        raise DataError("the lower hold has no strain", found=f"{known.size} readings")
    (tension, u_tension), (strain, u_strain) = _end_of(low.tension), _end_of(known)
    since = high.since_centre
    later = int(np.searchsorted(since, 0.0, side="right"))
    found = static_stiffness(
        since[later:],
        high.tension[later:],
        high.strain[later:],
        low_tension=tension,
        low_strain=strain,
        reference_time=reference_time,
        ramp_duration=high.ramp_duration,
        rated_break_strength=strength,
    )
    gain = (_end_of(high.tension)[0] - tension) / found.stiffness[-1]
    level = found.stiffness_at_reference
    spread = np.hypot(
        found.stiffness_at_reference_standard_uncertainty,
        np.hypot(u_tension, level * u_strain) / gain,
    )
    return replace(found, stiffness_at_reference_standard_uncertainty=float(spread))


def held_pairs(
    time: ArrayLike,
    position: ArrayLike,
    tension: ArrayLike,
    strain: ArrayLike,
    standstills: Standstills,
    *,
    specimens: Sequence[str],
    rated_break_strength: ArrayLike,
    reference_time: float,
) -> tuple[HeldPair, ...]:
    """Static stiffness from each hold to the next one, where that is at a higher tension.

    Parameters
    ----------
    time, position : array_like, shape (n_samples,)
        Elapsed time and crosshead position. [s], [m]
    tension, strain : array_like, shape (n_specimens, n_samples)
        NaN where missing. [N], [1]
    standstills : Standstills
        Holds of the crosshead, or of the tension.
    specimens : sequence of str, length n_specimens
        Names, in the order of the rows.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    reference_time : float
        Time after the centre of the ramp at which the stiffness stands. [s]

    Returns
    -------
    pairs : tuple of HeldPair
        By upper hold, then by specimen; without a stiffness where the holds do not support
        one, with the reason.

    Raises
    ------
    DataError
        If time and position do not pair up, or a strength is not positive.

    Notes
    -----
    A hold counts as higher where its mean tension is above that of the hold before by 5 % of
    it; a rest between the two parts them.  Tension and strain of the lower hold are means
    over its last 5 %, and their type A uncertainty is in that of the stiffness; the time
    counts from the centre of the ramp.  Levels and durations are the laboratory's: [1]_ was
    read in its abstract only, and no standard.

    Examples
    --------
    A hold at 100 N, and one at 300 N of which the secant falls by 100 N a decade.

    >>> t = np.arange(0.0, 1200.0)
    >>> load = np.interp(t, [0, 10, 100, 102, 1200], [0, 100, 100, 300, 300])
    >>> since = np.clip(t - 101, 1, None)
    >>> strain = 0.05 * load / 100
    >>> strain[t > 101] = (0.05 + (load - 100) / (4000 - 100 * np.log10(since)))[t > 101]
    >>> stand = Standstills(
    ...     first=np.array([10, 102]), last=np.array([99, 1199]),
    ...     start_time=np.array([10.0, 102.0]), end_time=np.array([99.0, 1199.0]),
    ...     mean_position=np.array([1.0, 1.1]), mean_tension=np.array([[100.0, 300.0]]),
    ...     is_rest=np.array([False, False]), position_tolerance=1e-3, slack_tension=5.0,
    ...     tension_tolerance=1.0)
    >>> pair, = held_pairs(t, 1 + strain, [load], [strain], stand, specimens=["rope"],
    ...     rated_break_strength=1e4, reference_time=100.0)
    >>> print(round(pair.stiffness.stiffness_at_reference, -1), pair.low_hold, pair.high_hold)
    3800.0 1 2
    """
    seconds, place = as_same_shape(time=time, position=position)
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    stretches = np.atleast_2d(np.asarray(strain, dtype=np.float64))
    strengths = one_a_specimen(rated_break_strength, len(specimens))
    number = np.cumsum(~standstills.is_rest)
    pairs = []
    for upper in range(1, standstills.n_standstills):
        if standstills.is_rest[upper - 1 : upper + 1].any():
            continue
        for row, name in enumerate(specimens):
            low_mean, high_mean = standstills.mean_tension[row, upper - 1 : upper + 1]
            if not high_mean > (1 + _LEAST_RISE) * low_mean:
                continue
            low, high = (
                select_hold(seconds, place, loads[row], stretches[row], standstills, index)
                for index in (upper - 1, upper)
            )
            stiffness, reason = None, ""
            try:
                stiffness = _stiffness(
                    low, high, strength=float(strengths[row]), reference_time=reference_time
                )
            except (DataError, FitError) as error:
                reason = str(error)
            ends = _level(low, low_mean), _level(high, high_mean)
            known = low.strain[np.isfinite(low.strain)]
            pairs.append(
                HeldPair(
                    specimen=name,
                    low_hold=int(number[upper - 1]),
                    high_hold=int(number[upper]),
                    low_tension=ends[0][0],
                    high_tension=ends[1][0],
                    stiffness=stiffness,
                    reason=reason,
                    low_tension_standard_uncertainty=ends[0][1],
                    high_tension_standard_uncertainty=ends[1][1],
                    low_strain=_end_of(known)[0] if known.size > 2 else float("nan"),
                )
            )
    return tuple(pairs)


def _level(hold: Hold, mean: float) -> tuple[float, float]:
    """Tension at the end of a hold; its mean where readings are too few for a scatter."""
    return _end_of(hold.tension) if hold.tension.size > 2 else (float(mean), float("nan"))

"""Strain left at zero tension after a test, where the record returns to slack.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.samples import first_sample, last_sample

FEWEST_SAMPLES = 3

REACH = 4.0


@dataclass(frozen=True)
@read_only_arrays
class _SlackCrossings:
    """Where a record first becomes taut and last goes slack; arrays have shape (2,)."""

    position: Floats
    standard_uncertainty: Floats
    compliance: Floats
    rate: Floats
    reason: str


@dataclass(frozen=True)
@read_only_arrays
class SlackStrain:
    """Strain at which specimens go slack when a test unloads; arrays have shape (n_specimens,).

    Parameters
    ----------
    strain, standard_uncertainty : ndarray
        NaN where the record does not begin or does not end slack; uncertainty from scatter. [1]
    by_tension : ndarray
        Change of the strain with the tension that counts as slack. [N-1]
    by_lag : ndarray
        Change of the strain with a time by which tension is logged late. [s-1]
    remarks : tuple of Note or None, length n_specimens
        Why the number is missing; empty where it is present.
    """

    strain: Floats
    standard_uncertainty: Floats
    by_tension: Floats
    by_lag: Floats
    remarks: tuple[Note | None, ...]


def _slack_position(
    position: ArrayLike, tension: ArrayLike, *, slack_tension: float
) -> tuple[float, float, float]:
    """Position at which tension crosses the slack tension on one loading or unloading.

    Notes
    -----
    Below the slack tension a tether hangs in a curve and tension does not give its length,
    so samples there are left out.

    Examples
    --------
    >>> x = np.linspace(0, 1, 101)
    >>> crossing, _, _ = _slack_position(x, 100 * np.clip(x - 0.2, 0, None), slack_tension=5.0)
    >>> round(crossing, 6)
    0.25
    """
    as_positive("slack_tension", slack_tension)
    place, load = as_same_shape(position=position, tension=tension)
    used = (load >= slack_tension) & (load <= REACH * slack_tension) & np.isfinite(place)
    x, y = place[used], load[used] - slack_tension
    if x.size < FEWEST_SAMPLES or np.ptp(x) == 0:
        return np.nan, np.nan, np.nan
    # Position on tension: the noise of tension is small against its range here, and the
    # crossing is then the constant term.
    design = np.stack([np.ones_like(y), y], axis=1)
    (crossing, slope), *_ = np.linalg.lstsq(design, x)
    if not slope > 0:
        return np.nan, np.nan, np.nan
    if x.size == FEWEST_SAMPLES:
        return float(crossing), np.nan, float(slope)
    residual = x - design @ [crossing, slope]
    covariance = np.linalg.inv(design.T @ design) * (residual @ residual) / (x.size - 2)
    return float(crossing), float(np.sqrt(covariance[0, 0])), float(slope)


def slack_crossings(
    position: ArrayLike,
    tension: ArrayLike,
    *,
    slack_tension: float,
    time: ArrayLike | None = None,
) -> _SlackCrossings:
    """Positions at which a record first becomes taut and last goes slack.

    Notes
    -----
    The first rise of a specimen's next test, less the first rise of this one, is the
    set that remains after the rest between them.

    Examples
    --------
    >>> x = np.concatenate([np.linspace(0, 2, 201), np.linspace(2, 0, 201)])
    >>> found = slack_crossings(x, 100 * np.clip(x - 0.2, 0, None), slack_tension=5.0)
    >>> print(found.position.round(4), found.compliance.round(4))
    [0.25 0.25] [0.01 0.01]
    """
    as_positive("slack_tension", slack_tension)
    place, load = as_same_shape(position=position, tension=tension)
    clock = None if time is None else np.asarray(time, dtype=np.float64)

    def is_taut(part: slice) -> Bools:
        return (load[part] > REACH * slack_tension) & np.isfinite(place[part])

    def is_slack(part: slice) -> Bools:
        return (load[part] <= slack_tension) & np.isfinite(place[part])

    crossing, uncertainty, compliance, rate = np.full((4, 2), np.nan)
    taut_first, taut_last = (
        find(is_taut, 0, load.size, load, place) for find in (first_sample, last_sample)
    )
    if taut_first is None or taut_last is None:
        return _SlackCrossings(
            crossing, uncertainty, compliance, rate, "the specimen is never taut"
        )
    before = last_sample(is_slack, 0, taut_first, load, place)
    after = first_sample(is_slack, taut_last, load.size, load, place)
    reasons = []
    if before is None:
        reasons.append("the record does not begin slack")
    if after is None:
        reasons.append("the record does not return to slack")
    for side, (begin, end) in enumerate(((before, taut_first), (taut_last, after))):
        if begin is None or end is None:
            continue
        part = slice(begin, end + 1)
        known = np.isfinite(place[part]) & np.isfinite(load[part])
        way, pull = place[part][known], load[part][known]
        crossing[side], uncertainty[side], compliance[side] = _slack_position(
            way, pull, slack_tension=slack_tension
        )
        if clock is not None:
            rate[side] = _rate(clock[part][known], way)
    if not reasons and not np.isfinite(crossing).all():
        reasons.append("too few samples where the specimen goes slack")
    return _SlackCrossings(crossing, uncertainty, compliance, rate, "; ".join(reasons))


def _rate(time: Floats, position: Floats) -> float:
    """Mean rate between the ends of a part; NaN where it takes no time."""
    span = time[-1] - time[0]
    return float((position[-1] - position[0]) / span) if span > 0 else float("nan")


def slack_strain_at_unloading(
    position: ArrayLike,
    tension: ArrayLike,
    *,
    slack_tension: float,
    relaxed_free_length: ArrayLike,
    time: ArrayLike | None = None,
) -> SlackStrain:
    r"""Strain at which a specimen goes slack when a test unloads.

    .. math:: s = (x_{last} - x_{first}) / \ell_0

    with the position at which tension first rises through the slack tension, the position
    at which it last falls through it, and the relaxed free length.

    Parameters
    ----------
    position : array_like, shape (n_samples,)
        Crosshead position, length or displacement. [m]
    tension : array_like, shape (n_specimens, n_samples)
        Tension. [N]
    slack_tension : float
        Tension at or below which a specimen is slack. [N]
    relaxed_free_length : array_like, shape (n_specimens,)
        Free length at zero tension before the test; NaN where not known. [m]
    time : array_like, shape (n_samples,), optional
        For the effect of a lag, which is not given without it. [s]

    Returns
    -------
    slack_strain : SlackStrain
        [1]

    Raises
    ------
    DataError
        If the series do not match, or the slack tension is not positive.

    Notes
    -----
    [1]_, sec. 2.3.4, reports "a permanent elongation of 2-3%" after deployment at 200 %.
    The number here is not permanent set: at the moment of unloading it includes the delayed
    elasticity that a rest recovers, and any length let out by a slipped splice.  The set
    left after a rest is the difference between the first crossings of two tests
    (`slack_crossings`), and is given in the history of the later one.

    Examples
    --------
    >>> up, down = np.linspace(0, 2, 201), np.linspace(2, 0, 201)
    >>> x = np.concatenate([up, down])
    >>> load = 100 * np.clip(np.concatenate([up - 0.2, down - 0.25]), 0, None)
    >>> left = slack_strain_at_unloading(
    ...     x, [load], slack_tension=5.0, relaxed_free_length=[2.0]
    ... )
    >>> print(left.strain.round(4))
    [0.025]
    """
    loads = np.atleast_2d(np.asarray(tension, dtype=np.float64))
    lengths = np.atleast_1d(np.asarray(relaxed_free_length, dtype=np.float64))
    found, uncertainty, by_tension, by_lag = np.full((4, loads.shape[0]), np.nan)
    remarks = []
    for row, (load, length) in enumerate(zip(loads, lengths, strict=True)):
        at = slack_crossings(position, load, slack_tension=slack_tension, time=time)
        reason = at.reason
        if not reason and not np.isfinite(length):
            reason = "the relaxed free length is not known"
        found[row] = (at.position[1] - at.position[0]) / length
        uncertainty[row] = np.hypot(*at.standard_uncertainty) / length
        by_tension[row] = (at.compliance[1] - at.compliance[0]) / length
        by_lag[row] = (at.rate[1] - at.rate[0]) / length
        remarks.append(note("slack-strain-not-given", reason=reason) if reason else None)
    return SlackStrain(found, uncertainty, by_tension, by_lag, tuple(remarks))

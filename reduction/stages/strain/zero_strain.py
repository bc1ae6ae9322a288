"""Zero of strain of a specimen without splices: at slack, or at the tension of its gauge length.

A rubber cord is measured slack.  A slack rope hangs in a curve, so it is measured under a small
tension that belongs to its gauge length, usually a hundredth or two of its break strength ([1]_),
and its strain counts from that tension.

References
----------
.. [1] ISO 2307:2019, "Fibre ropes - Determination of certain physical and mechanical
   properties" (reference tension, under which length and linear density are measured).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np

from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats
from reduction.record.samples import finite_extremes, first_sample, last_sample, step_of_codes
from reduction.stages.standstills import (
    Standstills,
    estimate_noise,
    level_of_standstill,
    noise_range,
)

# of the reference tension, on either side of it: there the curve of a rope is straight
_BAND = 0.2

_LOADED = 0.5  # of the greatest tension: a log begins with less before its first rest

_FEWEST = 4  # samples in the band, for a line and its residual


@dataclass(frozen=True)
class ZeroStrain:
    """Zero of strain of one specimen in one test.

    ``position`` [m] is None if it is not known, ``standard_uncertainty`` [m] that of reading
    it from the log, ``compliance`` [m/N] its derivative by the corresponding tension,
    ``is_logged`` whether it is a position of the log itself, ``reference_tension`` [N] the
    tension there, zero at slack, and ``stated_position`` [m] that of the layout for this tension,
    where it may contradict the log.
    ``bent_at`` [m] is the first rest of a specimen that is longer than this rest, and hangs bent.
    ``is_behind_load`` says that the specimen was loaded before it rested there.
    """

    position: float | None = None
    standard_uncertainty: float = 0.0
    compliance: float = 0.0
    is_logged: bool = False
    reference_tension: float = 0.0
    stated_position: float | None = None
    bent_at: float | None = None
    is_behind_load: bool = False


def zero_at_slack(
    standstills: Standstills,
    position: Floats,
    tension: Floats,
    *,
    position_is_length: bool,
    length_at_slack: float | None = None,
) -> ZeroStrain:
    """Position of the first rest, else that at which the layout states that the specimen is slack.

    It is uncertain by what the rest shows, and by one of the codes in which positions are written.
    ``tension`` has the shape (n_specimens, n_samples): at a rest behind the loading a specimen is
    longer than before it, so the stated position counts unless the rest is shorter.

    Examples
    --------
    >>> none = np.empty(0)
    >>> no_rest = Standstills(none, none, none, none, none, np.empty((1, 0)), none > 0, 0.01, 5.0)
    >>> place, load = np.arange(9.0), np.ones((1, 9))
    >>> print(zero_at_slack(no_rest, place, load, position_is_length=False).position)
    0.0
    """
    rests = np.flatnonzero(standstills.is_rest)
    stated = ZeroStrain(length_at_slack if position_is_length else 0.0)
    if not rests.size:
        return stated
    level, spread = level_of_standstill(position, standstills, int(rests[0]))
    first = int(standstills.first[rests[0]])
    is_behind_load = any(
        finite_extremes(load[:first])[1] > _LOADED * finite_extremes(load)[1] for load in tension
    )
    if is_behind_load and stated.position is not None:
        if level > stated.position - standstills.position_tolerance:
            return stated
    spread = float(np.hypot(spread, step_of_codes(position) / 12**0.5))
    return ZeroStrain(level, spread, is_logged=True, is_behind_load=is_behind_load)


def zero_at_start(
    position: Floats, tension: Floats, *, slack_tension: float, stated: float | None = None
) -> ZeroStrain | None:
    """Level of the first three readings of a log that begins slack with too few for a rest.

    None if they do not stand, unless the first is beyond the ``stated`` length at slack and the
    specimen still slack there.  ``tension`` has the shape (n_specimens, n_samples).  The level is
    uncertain by the noise of one reading, since a slow ramp may begin among them.

    Examples
    --------
    A pull that is logged every three seconds, from nine seconds on:

    >>> place = 7.0 + 0.02 * np.clip(np.arange(60.0) - 2, 0, None)
    >>> print(zero_at_start(place, 1e4 * (place[None] - 7), slack_tension=200.0).position)
    7.0
    >>> late = place[2:]
    >>> found = (late, 1e4 * (late[None] - 7))
    >>> print(zero_at_start(*found, slack_tension=200.0))
    None
    >>> print(zero_at_start(*found, slack_tension=200.0, stated=6.9).position)
    7.0

    A log that begins on the way from there:

    >>> print(zero_at_start(late, 1e4 * (late[None] - 6.99), slack_tension=200.0, stated=6.99))
    None
    """
    first, place = position[: _FEWEST - 1], None  # four are a rest
    noise = noise_range(position)
    # of the noise alone, one range of three readings in a hundred is wider
    if not np.ptp(first) <= noise / 3:
        if stated is None or not first[0] > stated + noise:
            return None
        beyond = 2 * first[0] - stated
        twice = first_sample(lambda part: position[part] >= beyond, 0, position.size, position)
        # a log that begins on the way has as much load there as it gains in the same stretch
        if twice is not None:
            most = [load[0] + _TOLD * estimate_noise(load)[0] for load in tension]
            if (most > _STILL_SLACK * tension[:, twice]).any():
                return None
        first, place = first[:1], stated
    if not (tension[:, : first.size] <= slack_tension).all():
        return None
    spread = np.hypot(step_of_codes(position) / 12**0.5, estimate_noise(position)[0])
    return ZeroStrain(float(np.median(first)), float(spread), is_logged=True, stated_position=place)


def zero_before_a_move(
    time: Floats,
    position: Floats,
    tension: Floats,
    *,
    slack_tension: float,
    minimum_duration: float,
) -> ZeroStrain | None:
    """Level of a log that begins slack and hardly moves for as long as the shortest rest.

    Where a logger interpolates or filters the position, neighbouring readings hide its noise, and
    the readings of a rest wander by more than it.  ``tension`` has the shape (n_specimens,
    n_samples).  The level is uncertain by the scatter of the readings.

    Examples
    --------
    >>> time = np.arange(0, 60, 0.1)
    >>> wanders = 0.001 * np.sin(time)
    >>> place = 7 + wanders + 0.02 * np.clip(time - 5, 0, None)
    >>> found = zero_before_a_move(
    ...     time, place, 1e4 * (place[None] - 7), slack_tension=200.0, minimum_duration=3.0)
    >>> print(round(found.position, 3))
    7.001
    """
    count = int(np.searchsorted(time, time[0] + minimum_duration))
    first, (low, high) = position[:count], finite_extremes(position)
    loads = np.nanmedian(tension[:, :count], axis=1) if count >= _FEWEST else np.inf
    if not (np.all(loads <= slack_tension) and np.ptp(first) <= _HARDLY * (high - low)):
        return None
    return ZeroStrain(float(np.median(first)), float(np.std(first)), is_logged=True)


_HARDLY = 0.005  # of the range of the record

_TOLD = 3.0  # standard deviations of the noise

_STILL_SLACK = 0.1  # of the load at twice the displacement; a cubic curve has an eighth


def zero_of_bent(
    zero: ZeroStrain, position: Floats, tension: Floats, *, gauge_length: float
) -> ZeroStrain:
    """Zero at the gauge length, if a specimen hangs bent in the first rest, with closer pins.

    It pulls from about its own length on; a specimen that is shorter than stated pulls as soon as
    it leaves the rest.

    Examples
    --------
    >>> place = np.linspace(0.45, 0.6, 500)
    >>> rest = ZeroStrain(0.45, is_logged=True)
    >>> for begins in (0.5, 0.45):
    ...     pull = 900 * np.clip(place - begins, 0, None)
    ...     print(zero_of_bent(rest, place, pull, gauge_length=0.5).position)
    0.5
    0.45
    """
    if not zero.is_logged or zero.position is None:
        return zero
    noise, step = estimate_noise(position)
    # pins at the gauge length read closer half of the time
    if not gauge_length - zero.position > max(_PULLS * noise, 2 * step):
        return zero
    noise, step = estimate_noise(tension)
    least = max(_PULLS * noise, 2 * step, _LEAST_PULL * finite_extremes(tension)[1])

    def is_pull(part: slice) -> Bools:
        return (tension[part] > least) & np.isfinite(position[part])

    begins = first_sample(is_pull, 0, tension.size, tension, position)
    taut = zero.position + _NEARER * (gauge_length - zero.position)
    if begins is None or not position[begins] > taut:
        return zero
    return ZeroStrain(gauge_length, bent_at=zero.position)


_PULLS, _LEAST_PULL = 6.0, 0.002  # times the noise of a reading; of the greatest load

_NEARER = 0.7  # of the way from the rest to the gauge length


def half_band_of(reference_tension: float, tension: Floats) -> float:
    """Allowed distance of a reading from the reference tension: a fifth of it, or noise. [N]."""
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
        Position of the crosshead; NaN where not usable. [m]
    tension : ndarray, shape (n_samples,)
        Tension of the specimen. [N]
    reference_tension : float
        Tension under which its gauge length was read. [N]
    stated_position : float, optional
        Position at that tension as stated in the layout, used if the log begins above
        the reference tension. [m]

    Returns
    -------
    zero : ZeroStrain
        Without a position if neither determines it.

    Raises
    ------
    DataError
        If the reference tension is not positive.

    Notes
    -----
    The first rise of the log through the reference tension is used, or the hold at it with which
    the log begins: a line of position over tension, a fifth of that tension to either side or
    over the noise if that is wider; through the two nearest samples if too few are in that range.
    Consecutive readings are averaged until their noise is within half of the reference tension.
    The difference in a later cycle at that tension is creep and hysteresis, and counts as strain.

    Examples
    --------
    A rope of 20 kN a metre, pulled from slack, with 400 N at 0.12 m:

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
    # readings whose noise reaches slack are averaged until it does not
    noise = float(noise_range(tension))
    together = ceil((noise / 2 / (_WIDEST * reference_tension)) ** 2)
    whole = tension.size // max(together, 1) * together
    if together > 1 and whole >= _FEWEST_MEANS * together:
        means = [one[:whole].reshape(-1, together).mean(axis=1) for one in (position, tension)]
        # of few readings per cycle, motion counts as noise, and their means have no less of it
        if noise_range(means[1]) < _QUIETER * noise / together**0.5:
            position, tension = means
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
    noises = estimate_noise(position)[0], estimate_noise(tension)[0]
    found, compliance, spread = _at_no_load(place[near], load[near], noises)
    # a bend of the curve moves the line through half of the band by three quarters less
    inner = np.abs(load) <= half / 2
    if inner.sum() >= _FEWEST:
        moved = (_at_no_load(place[inner], load[inner], noises)[0] - found) ** 2 - spread**2
        spread = float(np.sqrt(spread**2 + max(moved, 0.0) * 16 / 9))
    return ZeroStrain(found, spread, compliance, True, reference_tension, stated_position)


def _at_no_load(place: Floats, load: Floats, noises: tuple[float, float]) -> tuple[float, ...]:
    """Place where a rising load is zero, on a line; its slope, and the standard uncertainty.

    The order of the readings places the line, since noise of the load would flatten that of least
    squares; at a hold, where the load does not rise with it, least squares do.
    """
    offset = load - load.mean()
    by = np.linspace(-1.0, 1.0, load.size)
    if np.corrcoef(by, offset)[0, 1] < _RISES:
        by = offset
    reach = float(by @ offset)
    slope = float(by @ place) / reach if reach else 0.0
    left = place - place.mean() - slope * offset
    of_one = max(left @ left / (load.size - 2), noises[0] ** 2 + (slope * noises[1]) ** 2)
    away = load.mean() ** 2 * (by @ by) / reach**2 if reach else 0.0
    spread = float(np.sqrt(of_one * (1 / load.size + away)))
    return float(place.mean() - slope * load.mean()), slope, spread


_WIDEST = 0.5  # of the reference tension: the band of a noisy load on either side of it

_FEWEST_MEANS, _QUIETER = 32, 1.5  # of means, and their noise over that of white noise

_RISES = 0.7  # correlation with the order of the readings


# readings on each side of a jump of length, and its size compared with their own steps
_BESIDE_JUMP = 8
_JUMP = 10.0

_LEAST_JUMP, _CODES = 0.002, 3.5  # of the range of length, and steps in which it is written

_IN_STEP = 3.5  # usual time steps: in a longer gap creep may be as large

# fraction of a jump to which the load may respond: for a real stretch it responds to all of it
_ANSWER = 0.1


def jumps_of_length(
    time: Floats, length: Floats, tension: Floats, *, slack_tension: float
) -> list[tuple[float, float]]:
    """Times and sizes of steps of a length to which the load does not respond.

    Parameters
    ----------
    time, length, tension : ndarray, shape (n_samples,)
        Length may be a measured strain. [s], [m], [N]
    slack_tension : float
        Tension up to which a specimen is slack, and does not respond to motion. [N]

    Returns
    -------
    jumps : list of tuple of float
        Time of the first reading after it, and its size. [s], [m]

    Notes
    -----
    Causes are a stroke that is reset to zero under load, and a grip or extensometer that slips.
    The medians of eight readings on both sides differ by the step, so that neither a spike nor the
    motion of both sides counts; the load steps by less than a tenth of its change for a stretch of
    that size, by the ranges of the record.

    Examples
    --------
    >>> time = np.arange(200.0)
    >>> load = np.interp(time, [0, 50, 200], [0.0, 1000.0, 1000.0])
    >>> stroke = load / 1e4 - 0.02 * (time >= 120)
    >>> found = jumps_of_length(time, stroke, load, slack_tension=20.0)
    >>> print([(float(when), round(size, 4)) for when, size in found])
    [(120.0, -0.02)]
    """
    known = np.isfinite(length) & np.isfinite(tension)
    if np.count_nonzero(known) < 4 * _BESIDE_JUMP:
        return []
    # most records have no missing values, and need no copy
    t, x, load = (one if known.all() else one[known] for one in (time, length, tension))
    reach, pull = float(np.ptp(x)), float(np.ptp(load))
    step = np.diff(x)
    size_of_step = np.abs(step)
    far = np.flatnonzero(size_of_step > max(_LEAST_JUMP * reach, _CODES * step_of_codes(x)))
    far = far[(far >= _BESIDE_JUMP) & (far < step.size - _BESIDE_JUMP)]
    for beside in range(1, _BESIDE_JUMP):  # the nearest first: next to none of many are left
        for side in (-beside, beside):
            far = far[size_of_step[far] > _JUMP * size_of_step[far + side]]
    found = []
    for place in far.tolist():
        around = slice(place + 1 - _BESIDE_JUMP, place + 1 + _BESIDE_JUMP)
        waits = np.diff(t[around])
        (size, way), (answered, pulled) = (_step_beside_motion(one[around]) for one in (x, load))
        if 4 * pull * abs(way) < reach * abs(pulled):
            # repeated readings stand still, and step, while the load moves
            answered += pulled / 2
        # a wait may hide motion, but none by which a taut specimen loses half of its stretch
        is_seen = waits[_BESIDE_JUMP - 1] <= _IN_STEP * np.median(waits) or -2 * size > reach
        if (
            is_seen
            and abs(size - step[place]) < abs(step[place]) / 2
            and abs(answered) < _ANSWER * pull * abs(size) / reach
            and load[around].min() > slack_tension
        ):
            found.append((float(t[place + 1]), size))
    return found


def _step_beside_motion(values: Floats) -> tuple[float, float]:
    """Step in the middle of some readings, and their motion beside it."""
    half = values.size // 2
    rate = float(np.median(np.delete(np.diff(values), half - 1)))
    still = values - rate * np.arange(values.size)
    return float(np.median(still[half:]) - np.median(still[:half])), rate * values.size

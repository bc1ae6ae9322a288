"""End of a ramp: its time between two samples, and the tension then.

A mean over the first stretch of a hold is a tension that has already relaxed.  The tension at the
end of the ramp is that of a line through as many samples as follow one, and later motion of the
crosshead is corrected by the stiffness of the ramp.

References
----------
.. [1] O. V. Lepski, "On a problem of adaptive estimation in Gaussian white noise," Theory
   Probab. Appl. 35(3), 1991.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from reduction.record.measurement import Floats
from reduction.stages.approach import NEAR_SHARE

FEWEST_ON_LINE, MOST_ON_LINE = 3, 1 << 14

_GROWTH = 1.4

# of the combined standard uncertainties: many lines through the same first samples are compared and
# differ by less than this; a line that stops in noise has the noise of only a few samples
_AGREEING = 2.0

_LARGEST_SPREAD = 3.0  # ratio expected with fewer samples in noise; more is a line across ringing

_STEPS_BACK = 3  # a third of the samples has an eighth of the bias of a parabola

_STEPS_BEFORE = 5

MOTION_KNOWN_TO = 0.5 / 3**0.5
"""Standard uncertainty of the effect of a motion in a hold, as a fraction of it: a half either way.
[1]"""


def ramp_end_time(time: Floats, place: Floats, *, band: float) -> tuple[float, float]:
    """End of a ramp, between its last two samples, and its standard uncertainty.

    Parameters
    ----------
    time, place : ndarray, shape (n_samples,)
        A ramp, with its last sample at the end or after it. [s], [m]
    band : float
        Range that noise may span in it. [m]

    Returns
    -------
    end_time, standard_uncertainty : float
        The last time if a step of the log is within the noise. [s], [s]

    Notes
    -----
    No source: the last step of a ramp sampled at even steps is cut short if the ramp ends
    between two samples, or slows down within it.  A ramp that slows down has no corner, and is
    over at the last sample: the excess duration of its last fiftieth over that at its mean rate is
    the range, either way, of its end.  A step of the log that does not show the corner is also
    such a range; a ramp within two steps, both of which are cut short, ends before the
    last sample.

    Examples
    --------
    The crosshead stands after half the last step:

    >>> end, known_to = ramp_end_time(np.arange(4.0), np.array([0.0, 1.0, 2.0, 2.5]), band=0.01)
    >>> print(end, round(known_to, 3))
    2.5 0.144
    """
    end = float(time[-1])
    step = float(time[-1] - time[-2]) if time.size > 1 else 0.0
    # in a ramp within a step or two each is cut short, and shows nothing of the rate
    if time.size <= FEWEST_STEPS:
        return end, step / 3**0.5
    left = np.abs(place - place[-1])
    stroke, duration = float(left[0]), end - float(time[0])
    near = max(NEAR_SHARE * stroke, band / 2)
    entered = int(time.size - np.argmax((left > near)[::-1]))
    slowing = end - float(time[min(entered, time.size - 1)]) - near / stroke * duration
    # the first step is cut short as well
    rates = np.diff(place[max(time.size - 2 - _STEPS_BEFORE, 1) : -1])
    rates /= np.diff(time[-1 - rates.size - 1 : -1])
    rate = float(np.median(rates))
    last = place[-1] - place[-2]
    is_hidden = abs(rate) * step <= band
    slows = np.sign(rate) * (rates[-1] - _SLOWS * rate) < 0  # of a median of zero: no
    # without a corner, or if noise hides it, by that much before or after
    width = max(slowing, 0.0) * (2 if is_hidden or slows else 1)
    if is_hidden:
        width = max(width, step)
    elif not (slows and abs(rate - rates[-1]) * step > band):
        end = float(time[-2]) + step * float(np.clip(last / (rate * step), 0.0, 1.0))
        # a crosshead that slows within the step that is cut short ends later in it
        width = max(width, float(time[-1]) - end)
    return end, width / 12**0.5


FEWEST_STEPS = 3  # samples

_SLOWS = 0.8  # of the rate of the steps before: a slower last whole step


def time_to_stop(time: Floats, place: Floats, *, held_at: float) -> float:
    """Time for which a ramp that slows down moves on after its last sample. [s].

    For uniform deceleration, from the remaining distance and the mean speed of the last five
    steps; zero for one that reaches its corner at the mean speed of the ramp, or runs back.

    Examples
    --------
    Uniform deceleration to a stand at 4 s, with the last sample at 3 s:

    >>> t = np.arange(0.0, 3.1, 0.1)
    >>> x = np.where(t < 2, t, 4 - (4 - t) ** 2 / 4 - 1)
    >>> print(round(time_to_stop(t, x, held_at=3.0), 1))
    1.0
    """
    if time.size <= FEWEST_STEPS:
        return 0.0
    back = min(_STEPS_BEFORE, time.size - 2)
    lasted = float(time[-1] - time[-1 - back])
    speed = (place[-1] - place[-1 - back]) / lasted
    mean = (place[-1] - place[0]) / (time[-1] - time[0])
    left = float(held_at - place[-1]) / speed if speed else 0.0
    if left <= 0 or abs(speed) >= _SLOWS * abs(mean):
        return 0.0
    # t squared / 2 is left of the stroke, and t plus half of the steps is their mean speed
    return left + sqrt(left**2 + left * lasted)


@dataclass(frozen=True)
class _LevelAtEnd:
    """A series at the end of its ramp.

    Parameters
    ----------
    value, standard_uncertainty, slope : float
        [unit], [unit], [unit / s]
    n_samples : int
        Number of samples on the line. [1]
    """

    value: float
    standard_uncertainty: float
    slope: float
    n_samples: int


def level_at_end(
    since: Floats,
    values: Floats,
    *,
    noise: float,
    shortest: float = 0.0,
    step: float = 0.0,
    relaxes: bool = False,
) -> _LevelAtEnd:
    """Value of a series at time zero, by the longest line that its first samples follow.

    Parameters
    ----------
    since : ndarray, shape (n_samples,)
        Time after the end of the ramp. [s]
    values : ndarray, shape (n_samples,)
        Series, such as tension. [any unit]
    noise : float
        Standard deviation of one sample. [unit of the series]
    shortest : float, optional
        Time over which a machine may ring: least duration of the line. [s]
    step : float, optional
        Step of a converter, if noise does not spread readings over several of its codes.
        [unit of the series]
    relaxes : bool, optional
        Whether the series bends over decades of time, as tension at constant length does, and not
        within seconds, as a position that settles. [-]

    Returns
    -------
    level : _LevelAtEnd
        The mean if there are fewer than three samples. [unit of the series]

    Notes
    -----
    Method of [1]_: lines through 3, 5, 7, 10, ... samples, each 1.4 times as long, until the
    value at zero of one differs from that of any before by more than twice the sum of their
    standard uncertainties.  Of the line before that and the one with a third as many samples, the
    shorter is used, corrected by half of their difference, all of which counts as uncertainty: of a
    series that ``relaxes`` as the half width of a uniform distribution, unless the shorter line has
    only three readings.  Its bias is an eighth of the difference if the curvature is uniform, and
    as much or more if it is largest at the beginning, as in a relaxation over decades of time.  A
    machine that rings scatters its first samples more than their noise: the scatter about a line is
    used if greater.  Readings of one code have equal rounding errors: the rounding error of a line
    is that of one reading, or of as many as the codes it passes; the end of a line has four times
    the variance of their mean.

    Examples
    --------
    >>> since = np.arange(0.5, 100.0)
    >>> print(round(level_at_end(since, 300 + 100 * np.exp(-since / 40), noise=0.5).value))
    400
    """
    n_samples = min(since.size, MOST_ON_LINE)
    if n_samples < FEWEST_ON_LINE:
        return _LevelAtEnd(float(np.mean(values[:n_samples])), noise, 0.0, n_samples)
    origin = float(values[0])
    x, y = since[:n_samples], values[:n_samples] - origin
    sums = [np.cumsum(one) for one in (x, y, x * x, x * y, y * y)]
    found: list[_LevelAtEnd] = []
    spreads: list[float] = []
    count = min(max(FEWEST_ON_LINE, int(np.searchsorted(x, shortest))), n_samples)
    while True:
        sx, sy, sxx, sxy, syy = (float(one[count - 1]) for one in sums)
        power = sxx - sx * sx / count
        slope = (sxy - sx * sy / count) / power
        value = (sy - slope * sx) / count
        left = max(syy - sy * sy / count - slope * slope * power, 0.0) / (count - 2)
        scatter = max(noise, float(np.sqrt(left)))
        spread = scatter * float(np.sqrt(1 / count + (sx / count) ** 2 / power))
        if any(
            abs(value - one.value) > _AGREEING * (spread + of_noise) + step / 2
            for one, of_noise in zip(found, spreads, strict=True)
        ):
            largest = _LARGEST_SPREAD * found[-1].standard_uncertainty
            back = found[-1 - _STEPS_BACK :] if len(found) > _STEPS_BACK else found
            chosen = next(one for one in back if one.standard_uncertainty <= largest)
            if len(found) == 1:  # bent already, with no shorter line to tell by how much
                found.append(_LevelAtEnd(value, spread, slope, count))
            break
        spreads.append(spread)
        if step:
            codes = 1 + float(np.ptp(y[:count])) / step
            spread = float(np.hypot(spread, step / 12**0.5 * min(2 / codes**0.5, 1.0)))
        chosen = _LevelAtEnd(value, spread, slope, count)
        found.append(chosen)
        if count == n_samples:
            break
        count = min(int(np.ceil(_GROWTH * count)), n_samples)
    bias = found[-1].value - chosen.value
    # the first three readings, bent already, do not show what happened before them
    share = 1 / sqrt(3) if relaxes and chosen.n_samples > FEWEST_ON_LINE else 1.0
    return _LevelAtEnd(
        origin + chosen.value - bias / 2,
        float(np.hypot(chosen.standard_uncertainty, share * bias)),
        chosen.slope,
        chosen.n_samples,
    )


def effect_of_motion(
    elapsed: Floats, distance: Floats, share: Floats, *, stiffness: float
) -> Floats:
    """Tension that a motion after the ramp has added.

    Parameters
    ----------
    elapsed : ndarray, shape (n_times,)
        Time since the end of the ramp, increasing. [s]
    distance : ndarray, shape (n_times,)
        Motion of the crosshead since the end of the ramp, without its noise. [m]
    share : ndarray, shape (n_times,)
        Fraction of the tension of the ramp that is left. [1]
    stiffness : float
        Stiffness at the end of the ramp. [N/m]

    Returns
    -------
    added : ndarray, shape (n_times,)
        [N]

    Notes
    -----
    First order: what each step of the motion adds relaxes as the tension of the ramp does.

    Examples
    --------
    A hundredth of a stroke of 1 m that took 400 N, half of which relaxes in the first second:

    >>> print(effect_of_motion(np.array([1.0, 2.0]), np.array([0.01, 0.01]),
    ...                        np.array([0.5, 0.5]), stiffness=400.0))
    [4. 2.]
    """
    since = elapsed[:, None] - elapsed
    left = np.interp(since, [0.0, *elapsed], [1.0, *share], left=0.0)
    added: Floats = stiffness * (left @ np.diff(distance, prepend=0.0))
    return added

r"""Readings at the turns of a wave: effect of noise and sampling on extremes.

The greatest of many noisy readings exceeds the greatest level.  The excess follows from
the noise of a reading and from the shape of the turn, given by the mean over many cycles,

.. math::

    E \max_j (z_j - d_j) = \int x \sum_j \varphi(x + d_j) \prod_{i \ne j} \Phi(x + d_i) \, dx

where :math:`d_j` is the distance of sample j below the turn, over the noise ([1]_).  A log that is
slow compared with its ramps has little of this, but misses the turn by up to half a sample.  The
turn lies between the readings and the crossing of the lines through two samples on either side.

References
----------
.. [1] H. A. David and H. N. Nagaraja, *Order Statistics*, 3rd ed., Wiley, 2003, sec. 5.2 (greatest
   of independent variables that are unlike).
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike

from reduction.record.arrays import evenly_spread
from reduction.record.measurement import Floats, Integers
from reduction.record.samples import release_pages, take_samples

_MOST_TURNS = 400  # for a mean over cycles

_MOST_REACH = 600  # samples beside a turn

_FARTHEST = 6.0  # standard deviations below a turn

_SMOOTHED = 1.2  # noise over the step between samples: width that hardly rounds a turn

_PASSES = 3  # of aligning turns with each other: a window off its turn has unequal flanks

_CLEAR = 3.0  # times the noise of a reading: such steps between samples show the place of a turn

STEEP = 10.0  # times the noise of a reading: such steps of a single turn show a corner

_ROUNDED = 0.2  # of that step: distance of a turn below the lines beside it

_MOST_CORNERS = 0.8  # of the turns of a wave

_BENDS = 3 * 6**0.5  # noise of a reading: three standard deviations of a second difference

_BESIDE = 3  # samples on either side of a turn through which the crossing lines are drawn


def _excess_of_greatest(below: ArrayLike) -> float:
    r"""Mean of the greatest of normal readings whose levels lie below the highest.

    .. math:: E \max_j (z_j - d_j)

    Parameters
    ----------
    below : array_like, shape (n_readings,)
        Distances below the highest level, in standard deviations of a reading. [1]

    Returns
    -------
    excess : float
        In the same unit; 0 for no readings. [1]

    Notes
    -----
    Source: [1]_.

    Examples
    --------
    For two readings of one level 1 / sqrt(pi) = 0.5642, for three 3 / (2 sqrt(pi)) = 0.8463:

    >>> print(round(_excess_of_greatest([0, 0]), 4), round(_excess_of_greatest([0, 0, 0]), 4))
    0.5642 0.8463
    """
    distance = np.asarray(below, dtype=np.float64)
    distance = distance[distance < _FARTHEST]
    if distance.size == 0:
        return 0.0
    level = np.linspace(-_FARTHEST, _FARTHEST, 241)
    each = scipy.special.log_ndtr(level[:, None] + distance)
    density = -0.5 * (level[:, None] + distance) ** 2 - 0.5 * np.log(2 * np.pi)
    chosen = np.exp(density - each + each.sum(axis=1, keepdims=True)).sum(axis=1)
    return float((level * chosen).sum() * (level[1] - level[0]))


def noise_in_extreme(
    values: Floats,
    turn: Integers,
    *,
    reach: int,
    sign: int,
    noise: float,
) -> tuple[float, float]:
    r"""Mean excess of the extreme reading near a turn due to noise.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series. [any]
    turn : ndarray of int, shape (n_turns,)
        Samples at which the wave turns. [1]
    reach : int
        Samples on either side among which the extreme is searched. [1]
    sign : {1, -1}
        1 for peaks, -1 for valleys. [1]
    noise : float
        Standard deviation of one reading. [any]

    Returns
    -------
    excess : float
        To be subtracted from a peak and added to a valley; 0 if all turns are near the ends. [any]
    fall : float
        Fall of the shape from its top to the next reading, on the steeper side; for a
        turn between two readings the mean shape is blunt, and the excess too great. [any]

    Notes
    -----
    Source: [1]_, with the mean over the turns as their shape, smoothed over as many samples as
    leave a sharp turn within a third of the noise.  Noise misplaces turns, and
    their mean would be blunt: they are aligned by the middle of their flanks.

    Examples
    --------
    Ramps of 2 N a sample with 3 N of noise; excess of the greatest readings of 100 turns:

    >>> ramp = np.concatenate([np.tile(np.r_[0:100, 100:0:-1], 100), [0]]) * 2.0
    >>> noisy = ramp + np.random.default_rng(1).normal(0, 3, ramp.size)
    >>> peak = np.arange(100, ramp.size, 200)
    >>> greatest = np.mean([noisy[one - 25 : one + 25].max() for one in peak])
    >>> excess, _ = noise_in_extreme(noisy, peak, reach=25, sign=1, noise=3.0)
    >>> print(round(greatest - 200, 1), round(excess, 1))
    1.6 1.8
    """
    reach = min(reach, _MOST_REACH)
    inside = turn[(turn >= 2 * reach) & (turn < values.size - 2 * reach)]
    if not inside.size or reach < 1 or not noise > 0:
        return 0.0, 0.0
    some = evenly_spread(inside, _MOST_TURNS)
    place = np.arange(-reach, reach + 1)
    shift = np.zeros(some.size, dtype=int)
    for _ in range(_PASSES):
        levels = sign * _around(values, some + shift, reach)
        mean = levels.mean(axis=0)
        if not np.isfinite(mean).all():
            return 0.0, 0.0
        # the turns were misplaced by noise: the first moment of the window corrects their position
        weight = levels - min(mean[0], mean[-1])
        total = weight.sum(axis=1)
        # in a window dominated by noise the moment has no information
        clear = total * reach > 2 * noise * np.sqrt((place**2).sum())
        if not clear.any():
            break
        middle = (weight[clear] @ place) / total[clear]
        moved = np.round(middle - np.median(middle)).astype(int)
        shift[clear] = np.clip(shift[clear] + moved, -reach, reach)
        if not moved.any():
            break
    mean = sign * _around(values, some + shift, reach).mean(axis=0)
    if not np.isfinite(mean).all():
        return 0.0, 0.0
    step = float(mean.max() - min(mean[0], mean[-1])) / reach
    rough = _SMOOTHED * noise * min(6 / np.sqrt(some.size), 1.0)
    width = min(int(rough / step) if step > 0 else reach, reach) // 2 * 2 + 1
    padded = np.pad(mean, width // 2, mode="edge")
    shape = np.convolve(padded, np.full(width, 1 / width), mode="valid")
    top = int(np.argmax(shape[1:-1])) + 1
    fall = float(shape[top] - min(shape[top - 1], shape[top + 1]))
    # the greatest of a mean over some turns is itself biased high
    own = noise / np.sqrt(some.size * width)
    highest = shape.max() - own * _excess_of_greatest((shape.max() - shape) / own)
    return noise * _excess_of_greatest((highest - shape) / noise), fall


Turn = Literal["sharp", "hidden", "rounded"]


def _around(values: Floats, places: Integers, reach: int) -> Floats:
    """Samples within some reach of places, one row a place."""
    found = np.stack([values[one - reach : one + reach + 1] for one in places.tolist()])
    release_pages(values)
    return found


def kind_of_turns(
    driven: Floats, peak: Integers, *, noise: float, in_doubt: Turn = "hidden"
) -> Turn:
    """Whether a wave turns from sample to sample, rounds its turns, or hides them in noise.

    Parameters
    ----------
    driven : ndarray, shape (n_samples,)
        The channel that the machine moves. [any]
    peak : ndarray of int, shape (n_turns,)
        Samples of its peaks. [1]
    noise : float
        Standard deviation of one reading. [any]
    in_doubt : {"hidden", "sharp", "rounded"}
        Kind where noise alone may round the turns: for the other channel, the kind of
        the driven one, which moves both. [-]

    Returns
    -------
    kind : {"sharp", "hidden", "rounded"}
        Hidden where the steps beside the turn are within three times the noise. [-]

    Examples
    --------
    >>> place = np.arange(200)
    >>> peaks = np.arange(20, 190, 20)
    >>> triangle, sine = -np.abs((place + 10.3) % 20 - 10), np.cos(np.pi * place / 10)
    >>> print(kind_of_turns(triangle, peaks, noise=0), kind_of_turns(sine, peaks, noise=0))
    sharp rounded
    >>> print(kind_of_turns(triangle, peaks, noise=0.5))
    hidden
    >>> print(kind_of_turns(triangle, peaks, noise=0.3, in_doubt="sharp"))
    sharp

    Turns that lack a reading are left out:

    >>> triangle[100:] = np.nan
    >>> print(kind_of_turns(triangle, peaks, noise=0))
    sharp
    """
    inside = peak[(peak >= _BESIDE) & (peak < driven.size - _BESIDE)]
    if inside.size == 0:
        return "rounded"
    level = take_samples(driven, evenly_spread(inside, _MOST_TURNS)[:, None] + np.arange(-2, 3))
    level = level[np.isfinite(level).all(axis=1)]
    if not level.size:
        return "rounded"
    rise, fall = level[:, 1] - level[:, 0], level[:, 3] - level[:, 4]
    step = np.median(np.minimum(rise, fall))
    rounded = np.median(np.minimum(level[:, 1] + rise, level[:, 3] + fall) - level[:, 2])
    # of a median over turns: two readings before less one before and one at the turn
    unknown = 1.25 * 6**0.5 * noise / len(level) ** 0.5
    if not step > _CLEAR * noise:
        return "hidden"
    if abs(rounded - _ROUNDED * step) < unknown:
        return in_doubt
    return "sharp" if rounded < _ROUNDED * step else "rounded"


def level_of_turn(values: Floats, turn: Integers, extreme: Floats, *, sign: int) -> Floats:
    """Level at which the lines beside a sharp turn cross; the extreme reading where none do.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series. [any]
    turn : ndarray of int, shape (n_turns,)
        Samples next to which it turns. [1]
    extreme : ndarray, shape (n_turns,)
        Readings. [any]
    sign : {1, -1}
        1 for peaks, -1 for valleys. [1]

    Returns
    -------
    level : ndarray, shape (n_turns,)
        [any]

    Examples
    --------
    A peak of 100, 0.4 samples after the logged one:

    >>> place = np.arange(-5, 6)
    >>> wave = np.minimum(100 + 10 * (place - 0.4), 100 - 20 * (place - 0.4))
    >>> print(level_of_turn(wave, np.array([5]), wave[[5]], sign=1))
    [100.]
    """
    crossing, offset, *_ = _crossing(values, turn, sign=sign)
    known = np.isfinite(offset)
    return np.asarray(sign * np.where(known, np.maximum(crossing, sign * extreme), sign * extreme))


def level_at_corner(
    values: Floats,
    moved: Floats,
    extreme_at: Integers,
    *,
    sign: int,
    noise: float,
    rests: bool,
    own_noise: float = 0.0,
    steep: float = STEEP,
) -> Floats:
    """Level of a series extrapolated along its approach to the corner of the driving channel.

    Where the series relaxes within a sample after the corner, there is no line after it: only
    the readings before it determine the level.  An approach that clearly steepens, as for a hose
    whose cords lock, is extrapolated as a parabola.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series. [any]
    moved : ndarray, shape (n_samples,)
        The channel that the machine moves, rising where the series does. [any]
    extreme_at : ndarray of int, shape (n_turns,)
        Samples of its extreme readings. [1]
    sign : {1, -1}
        1 for peaks, -1 for valleys. [1]
    noise : float
        Standard deviation of one reading of ``moved``. [any]
    rests : bool
        Whether ``moved`` stays where it turns: `rests_at_turns`. [-]
    own_noise : float
        Standard deviation of one reading of ``values``. [any]
    steep : float
        Least step of ``moved`` beside a corner, over its noise. [1]

    Returns
    -------
    level : ndarray, shape (n_turns,)
        NaN where ``moved`` has no corner nearby, or the series went on beyond it. [any]

    Examples
    --------
    Held from 0.6 samples after the reading, and relaxed before the next one:

    >>> place = np.arange(11)
    >>> drive = np.minimum(place - 5.6, 0)
    >>> force = np.where(place <= 5, 100 + 10 * (place - 5.6), 80)
    >>> print(level_at_corner(force, drive, np.array([5]), sign=1, noise=0, rests=True))
    [100.]

    A force that steepens by 4 from step to step, and a corner half a step after a reading:

    >>> drive = -np.abs(place - 5.5)
    >>> print(level_at_corner(2.0 * np.maximum(drive + 5.5, 0) ** 2, drive, np.array([5]), sign=1,
    ...     noise=0, rests=False))
    [60.5]
    """
    offset, leaving = (
        _offset_of_corner(series, at, sign=sign, noise=noise, rests=rests, steep=steep)
        for series, at in ((moved, extreme_at), (moved[::-1], moved.size - 1 - extreme_at))
    )
    level = sign * values

    def led_to(series: Floats, at: Integers, offset: Floats) -> Floats:
        before = at - (offset < 0)
        approach = series[before] - series[before - 1]
        bend = approach - series[before - 1] + series[np.maximum(before - 2, 0)]
        bend = np.where(bend > _BENDS * own_noise, bend, 0.0)
        on = np.where(offset < 0, 1 + offset, offset)
        return np.asarray(series[before] + (approach + bend * (1 + on) / 2) * on)

    # creep during a rest is greatest where the rest ends: the same, backward in time
    backward = moved.size - 1 - extreme_at
    beyond = np.where(
        np.isfinite(offset),
        led_to(level, extreme_at, offset),
        led_to(level[::-1], backward, leaving),
    )
    reading = take_samples(level, extreme_at)
    goes_on = beyond < reading - _CLEAR * own_noise
    return np.asarray(sign * np.where(goes_on, np.nan, np.maximum(beyond, reading)))


def level_beside_corner(values: Floats, moved: Floats, turn: Integers, *, sign: int) -> Floats:
    """Level at a corner, from the extreme reading and the motion of the driving channel.

    The slope is that of the step beside the turn without the corner.  For a series that stiffens
    towards its turn on both branches, the lines beside cross below the reading, and a parabola lags
    behind.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series. [any]
    moved : ndarray, shape (n_samples,)
        The channel that the machine moves, rising where the series does. [any]
    turn : ndarray of int, shape (n_turns,)
        Samples at which the channel turns. [1]
    sign : {1, -1}
        1 for peaks, -1 for valleys. [1]

    Returns
    -------
    level : ndarray, shape (n_turns,)
        The reading at the turn where the series does not stiffen, or where a reading nearby is
        farther, as in a series that turns before or after. [any]

    Examples
    --------
    A corner 0.4 samples before a reading, and a force that grows by a half with every step:

    >>> drive = -np.abs(np.arange(11) - 4.6)
    >>> force = 100 * 1.5**drive
    >>> print(force[5].round(1), level_beside_corner(force, drive, np.array([5]), sign=1).round(1))
    85.0 [96.4]
    """
    window = np.clip(turn[:, None] + np.arange(-_BESIDE, _BESIDE + 1), 0, values.size - 1)
    drive, level = sign * moved[window], sign * values[window]
    beyond = sign * level_of_turn(moved, turn, moved[turn], sign=sign) - drive[:, _BESIDE]
    steps = np.diff(level, axis=1)
    stiffens = (steps[:, 1] > steps[:, 0]) & (steps[:, -2] < steps[:, -1])
    stiffens &= (steps[:, 0] > 0) & (steps[:, -1] < 0)
    stiffens &= (steps[:, _BESIDE - 1] > 0) & (steps[:, _BESIDE] < 0)
    lower = _BESIDE + np.where(drive[:, _BESIDE - 1] < drive[:, _BESIDE + 1], -1, 1)
    row = np.arange(turn.size)
    on = drive[:, _BESIDE] - drive[row, lower]
    stiffens &= on > 0
    slope = (level[:, _BESIDE] - level[row, lower]) / np.where(stiffens, on, 1.0)
    return np.asarray(sign * (level[:, _BESIDE] + np.where(stiffens, slope * beyond, 0.0)))


def rests_at_turns(moved: Floats, extreme_at: Integers) -> bool:
    """Whether a channel rests for more than one reading at most of its extremes.

    Then two readings are at one level, or the lines beside cross farther above the extreme reading
    than they do above the readings on either side of a turn of ramps.

    Examples
    --------
    >>> place = np.arange(200)
    >>> ramps = np.abs((place * 1.01) % 20 - 10)
    >>> peaks = np.flatnonzero((ramps[1:-1] > ramps[:-2]) & (ramps[1:-1] > ramps[2:])) + 1
    >>> print(rests_at_turns(ramps, peaks), rests_at_turns(np.minimum(ramps, 8.9), peaks))
    False True
    """
    inside = extreme_at[(extreme_at >= _BESIDE) & (extreme_at < moved.size - _BESIDE)]
    if inside.size == 0:
        return False
    level = moved[inside[:, None] + np.arange(-_BESIDE, _BESIDE + 1)]
    steps = np.diff(level, axis=1)
    rise, fall = steps[:, 0], -steps[:, -1]
    is_ramp = np.minimum(rise, fall) > _RESTS * np.abs(steps).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        # crossing of the lines through the outer readings, in steps from the second one
        along = (level[:, -2] - level[:, 1] + 4 * fall) / (rise + fall)
        height = level[:, 1] + rise * along - level.max(axis=1)
        is_above = height > _ABOVE * rise * fall / (rise + fall)
    beside = np.abs(steps[:, _BESIDE - 1 : _BESIDE + 1]).min(axis=1)
    is_level = beside < _RESTS * np.abs(steps).max(axis=1)
    return bool(np.where(is_ramp, is_above, is_level).mean() > _MOST_CORNERS)


_RESTS = 0.05  # of the greatest step nearby

_ABOVE = 1.1  # of the greatest height at which lines cross above the readings at a turn of ramps


def energy_missed_by_polygon(
    tension: Floats, strain: Floats, moved: Floats, *, noise: float
) -> tuple[Floats, Floats]:
    r"""Area between the polygon of the readings and a loop, at machine corners and elsewhere.

    .. math:: \Delta H_i = \int_{i \to c \to c' \to j} T \, d\varepsilon
              - \tfrac12 (T_i + T_j)(\varepsilon_j - \varepsilon_i)

    at a corner, with the line through the two readings before it extended to c, and that through
    the two after it extended back to c'.  Tension may fall at once from c to c', as friction does.
    Elsewhere it is a third of the difference between this polygon and one of every other reading:
    the next order where the loop is smooth, and the mean over all places of a kink between two
    readings.

    Parameters
    ----------
    tension, strain, moved : ndarray, shape (n_samples,)
        Two series, and the one of them, or a third, that the machine moves. [N], [1], [any]
    noise : float
        Standard deviation of one reading of ``moved``. [any]

    Returns
    -------
    at_corners : ndarray, shape (n_samples,)
        Area missing from the polygon between each reading and the next; 0 without a corner.
        [J m-1]
    between : ndarray, shape (n_samples,)
        Area missing about each reading; 0 beside a corner. [J m-1]

    Examples
    --------
    To 0.1 of strain at 100 N half a sample after a reading, then at once 40 N less:

    >>> strain = 0.1 - np.abs(np.arange(11) - 5.5) * 0.01
    >>> force = 1000 * strain - np.where(np.arange(11) <= 5, 0, 40)
    >>> at_corners, between = energy_missed_by_polygon(force, strain, strain, noise=0)
    >>> print(at_corners.round(4)[4:7], abs(between).max().round(9))
    [0.  0.2 0. ] 0.0

    A circle of 12 readings, whose polygon is 4.5 % too small:

    >>> turn = 2 * np.pi * np.arange(13) / 12
    >>> _, between = energy_missed_by_polygon(np.sin(turn), np.cos(turn), np.cos(turn), noise=0)
    >>> print((between[1:].sum() * 12 / 11 / np.pi).round(3))
    -0.043
    """
    at_corners, between = np.zeros((2, moved.size))
    if moved.size < 2 * _BESIDE:
        return at_corners, between
    to_force, to_strain = np.diff(tension), np.diff(strain)
    between[1:-1] = (to_force[:-1] * to_strain[1:] - to_force[1:] * to_strain[:-1]) / 12
    steps = np.diff(moved)
    # the steps of a corner: two equal ones before it, the one containing it, two equal ones after
    # it
    second, before, own, after, third = (steps[k : steps.size - 4 + k] for k in range(5))
    fastest = np.maximum(np.abs(before), np.abs(after))
    unlike = np.maximum(np.abs(before - second), np.abs(after - third))
    change = before - after
    is_corner = (fastest > STEEP * noise) & (unlike < _ROUNDED * fastest + 2 * noise)
    is_corner &= np.abs(change) > 2 * _ROUNDED * fastest
    at = np.flatnonzero(is_corner)
    share = (own[at] - after[at]) / change[at]
    at, share = at[np.abs(share - 0.5) <= 1], np.clip(share[np.abs(share - 0.5) <= 1], 0, 1)
    last = at + 2  # reading before the corner
    (force, stretch), (force_on, stretch_on), (force_end, stretch_end) = (
        (share * (one[last] - one[last - 1]) for one in (tension, strain)),
        (
            one[last + 1] - one[last] - (1 - share) * (one[last + 2] - one[last + 1])
            for one in (tension, strain)
        ),
        (one[last + 1] - one[last] for one in (tension, strain)),
    )
    at_corners[last] = (
        force * stretch
        + (force + force_on) * (stretch_on - stretch)
        + (force_on + force_end) * (stretch_end - stretch_on)
        - force_end * stretch_end
    ) / 2
    between[last] = between[last + 1] = 0.0
    return at_corners, between


def has_corners(
    moved: Floats, extreme_at: Integers, *, sign: int, noise: float, rests: bool
) -> bool:
    """Whether the driving channel has a corner near most of the extremes of the responding one."""
    arriving, leaving = (
        _offset_of_corner(series, at, sign=sign, noise=noise, rests=rests)
        for series, at in ((moved, extreme_at), (moved[::-1], moved.size - 1 - extreme_at))
    )
    return bool((np.isfinite(arriving) | np.isfinite(leaving)).mean() > _MOST_CORNERS)


def _offset_of_corner(
    moved: Floats,
    extreme_at: Integers,
    *,
    sign: int,
    noise: float,
    rests: bool,
    steep: float = STEEP,
) -> Floats:
    """Samples from an extreme to the corner near it; NaN where there is none.

    For a channel that ``rests`` where it turns, the corner is where its approach meets the rest.
    """
    window = extreme_at[:, None] + np.arange(-_BESIDE, _BESIDE + 1)
    usable = (window[:, 0] >= 0) & (window[:, -1] < moved.size)
    drive = sign * moved[np.clip(window, 0, moved.size - 1)]
    steps = np.diff(drive, axis=1)
    if rests:
        row = np.arange(extreme_at.size)
        below = drive[:, 1:-1].max(axis=1)[:, None] - drive
        is_on_ramp = below[:, : _BESIDE + 1] > _RESTS * np.abs(steps).max(axis=1)[:, None]
        last = _BESIDE - is_on_ramp[:, ::-1].argmax(axis=1)
        usable &= is_on_ramp.any(axis=1) & (last >= _BESIDE - 1)
        rise = steps[row, last - 1]
        alike = np.abs(steps[row, np.maximum(last - 2, 0)] - rise)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = below[row, last] / rise
        usable &= share < 1 + _ROUNDED
        offset = last - _BESIDE + np.minimum(share, 1)
    else:
        rise, on = steps[:, 1], steps[:, 4]
        # two equal steps before the corner and two after it, and a change of slope between them
        alike = np.maximum(np.abs(steps[:, 0] - rise), np.abs(steps[:, 5] - on))
        usable &= rise - on > 2 * _ROUNDED * rise
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = (drive[:, 4] - drive[:, 2] - rise - on) / (rise - on)
    usable &= (rise > steep * noise) & (alike < _ROUNDED * rise + 2 * noise)
    return np.where(usable & (np.abs(offset) <= 1), offset, np.nan)


def missed_by_extreme(values: Floats, turn: Integers, extreme: Floats, *, sign: int) -> Floats:
    """Distance by which the extreme reading may miss a turn rounded over a sample or two.

    Parameters
    ----------
    values : ndarray, shape (n_samples,)
        A series. [any]
    turn : ndarray of int, shape (n_turns,)
        Samples next to which it turns. [1]
    extreme : ndarray, shape (n_turns,)
        Readings. [any]
    sign : {1, -1}
        1 for peaks, -1 for valleys. [1]

    Returns
    -------
    missed : ndarray, shape (n_turns,)
        The greater of the height of a parabola through three readings above them and of the rise
        along the steeper way to the crossing of the lines; at most the crossing, 0 where no
        lines cross. [any]

    Notes
    -----
    Where a rise is faster than the following fall, a rounded turn lies after the corner of the two
    lines, and a reading at the corner misses it: the parabola accounts for that.

    Examples
    --------
    A parabola logged at its top, and one logged a quarter of a sample beside it:

    >>> place = np.arange(-5, 6)
    >>> for beside in (0.0, 0.25):
    ...     wave = -((place - beside) ** 2)
    ...     print(missed_by_extreme(wave, np.array([5]), wave[[5]], sign=1))
    [0.]
    [0.0625]
    """
    crossing, offset, step, bow = _crossing(values, turn, sign=sign)
    above = np.maximum(crossing - sign * extreme, 0.0)
    most = np.maximum(step * np.abs(offset), bow)
    return np.asarray(np.where(np.isfinite(offset), np.minimum(above, most), 0.0))


def _crossing(values: Floats, turn: Integers, *, sign: int) -> tuple[Floats, ...]:
    """Level where the lines at a turn cross, samples after the extreme, step on that side, bow.

    The last one is the height above it of the parabola through the extreme and its neighbours.
    NaN where no lines cross.
    """
    window = turn[:, None] + np.arange(-_BESIDE, _BESIDE + 1)
    usable = (window[:, 0] >= 0) & (window[:, -1] < values.size)
    level = sign * values[np.clip(window, 0, values.size - 1)]
    # a channel that lags turns a sample after the driven one
    top = _BESIDE - 1 + level[:, _BESIDE - 1 : _BESIDE + 2].argmax(axis=1)
    row = np.arange(turn.size)
    before, after = level[row, top - 1], level[row, top + 1]
    rise, fall = before - level[row, top - 2], after - level[row, top + 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        # crossing of the lines, counted from the sample at the turn
        offset = (after + fall - before - rise) / (rise + fall)
        crossing = before + rise * (1 + offset)
    usable &= (rise > 0) & (fall > 0) & (np.abs(offset) <= 1)
    # a reading after the turn is on the way down
    step = np.where(offset < 0, fall, rise)
    bend = 2 * level[row, top] - before - after
    with np.errstate(divide="ignore", invalid="ignore"):
        bow = np.where(bend > 0, (after - before) ** 2 / (8 * bend), 0.0)
    return crossing, np.where(usable, offset, np.nan), step, bow

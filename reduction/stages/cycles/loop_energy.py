r"""Energy of the loops of tension against strain.

.. math:: H = \oint T \, d\varepsilon = \sum_i T_i \, \Delta\varepsilon_i

A polygon through N samples of an ellipse is too small by :math:`(2\pi/N)^2/6`: 4.5 %
at 12 samples a cycle.  Where strain and tension are smooth (sinusoidal tests) the
differences of strain are taken to eighth order, which leaves 1e-5 at 12 samples.  Where
the crosshead turns sharply (triangular tests) the polygon is the better area: it follows
straight branches exactly, and only the two tips between samples are cut, while a
high-order difference would ring at each turn.

Storage and loss of a wave that is not a sine are taken at equal phase of the channel that the
machine moves.  With that channel as :math:`\cos\theta` of its half range,

.. math::

    E'' = \frac{1}{\pi \varepsilon_a} \oint T \, d\cos\theta
        = \frac{H}{\pi \varepsilon_a^2}, \qquad
    E' = \frac{1}{\pi \varepsilon_a} \oint T \, d\sin\theta

([1]_), which do not depend on time: the loss of an elastic curve is zero, whatever the duration of
its strokes.  For a sine they are those of the fundamental over time.  For a triangle they are not:
a linear material of constant loss angle has 0.69 of its loss in a sine, (8/pi^2)^2 times the sum of
1/k^3 over the odd harmonics k.

References
----------
.. [1] ISO 4664-1:2022, "Rubber, vulcanized or thermoplastic - Determination of dynamic properties -
   Part 1: General guidance," ISO, Geneva (loss from the area of the loop).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers
from reduction.record.settings import Waveform
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.fundamental import sums_over_cycles
from reduction.stages.cycles.reading_noise import reading_noise, rounding_of_branches
from reduction.stages.cycles.turns import energy_missed_by_polygon

_EIGHTH_ORDER = (4 / 5, -1 / 5, 4 / 105, -1 / 280)


def _smooth_steps(strain: Floats, first: Integers, last: Integers, stride: int = 1) -> Floats:
    """Eighth-order change of strain per stride of samples at each sample, shape (n_samples,).

    Where the record ends within four strides of a cycle, that cycle is continued
    periodically, with its drift added, so that a log of one cycle is as good as any.
    """
    reach = stride * len(_EIGHTH_ORDER)
    ahead, behind = strain[:0], strain[:0]
    if first[0] < reach:
        start, stop = first[0], last[0]
        places = np.arange(-reach, 0) + (stop - start)
        behind = strain[np.clip(places, 0, None)] - (strain[stop] - strain[start])
    if strain.size - 1 - last[-1] < reach:
        start, stop = first[-1], last[-1]
        places = np.arange(strain.size, strain.size + reach) - (stop - start)
        ahead = strain[np.clip(places, None, strain.size - 1)] + (strain[stop] - strain[start])
    padded = np.concatenate([behind, strain, ahead])
    change = np.zeros_like(strain)
    low = reach - behind.size
    high = strain.size - (reach - ahead.size)
    inner = change[low:high]
    for offset, weight in enumerate(_EIGHTH_ORDER, start=1):
        at = reach + stride * offset
        inner += weight * padded[at : at + inner.size]
        at = reach - stride * offset
        inner -= weight * padded[at : at + inner.size]
    return change


def loop_energy(
    tension: ArrayLike,
    strain: ArrayLike,
    first: Integers,
    last: Integers,
    *,
    waveform: Waveform = "triangular",
) -> tuple[Floats, Floats]:
    """Energy lost in each cycle and unit length, and its sensitivity to noise.

    Notes
    -----
    An open loop is closed by the straight line from its last sample to its first; `without_drift`
    then subtracts the energy added by that line.
    Independent noise of tension and strain leaves the energy unbiased, since no
    reading is multiplied by itself.

    Examples
    --------
    An ellipse of 12 samples a cycle, strain amplitude 0.2, tension in quadrature
    50 N: the area is pi * 0.2 * 50 = 31.416 J/m; the polygon gives 30.0.

    >>> phase = 2 * np.pi * np.arange(37) / 12
    >>> strain, tension = 0.2 * np.sin(phase), 50 * np.cos(phase)
    >>> first, last = np.array([12]), np.array([24])
    >>> energy, _ = loop_energy(tension, strain, first, last, waveform="sinusoidal")
    >>> print(energy.round(3))
    [31.416]
    >>> print(loop_energy(tension, strain, first, last)[0].round(3))
    [30.]
    """
    force, stretch = as_same_shape(tension=tension, strain=strain)
    if stretch.ndim != 1 or stretch.size < 3:
        raise DataError(
            "a loop is too short", found=f"{stretch.size} samples", needed="three or more"
        )
    if first.size == 0:
        return np.empty(0), np.empty(0)
    # tension is counted from the closing line, so that the noise of strain at an end of the loop
    # is not multiplied by the whole mean tension
    closing = (force[last] + force[first]) / 2
    if waveform == "sinusoidal":
        step = _smooth_steps(stretch, first, last)
        work = force * step
        # the ends of a cycle count half, as in any trapezoid
        energy = sums_over_cycles(work, first, last) + (work[last] - work[first]) / 2
        travel = sums_over_cycles(step, first, last) + (step[last] - step[first]) / 2
        energy -= closing * travel
    else:
        step = np.diff(stretch)
        work = force[1:] + force[:-1]
        work *= step
        energy = sums_over_cycles(work, first, last) / 2
        energy -= closing * (stretch[last] - stretch[first])
    np.multiply(step, step, out=step)
    return energy, np.sqrt(sums_over_cycles(step, first, last))


def without_drift(
    energy: Floats,
    *,
    end_tension: ArrayLike,
    mean_tension: ArrayLike,
    tension_drift: ArrayLike,
    end_strain: ArrayLike,
    mean_strain: ArrayLike,
    strain_drift: ArrayLike,
) -> Floats:
    r"""Energy that the loop would lose if neither tension nor strain drifted over the cycle.

    .. math:: H = H_c + (T_e - \bar T) \, d_\varepsilon - (\varepsilon_e - \bar\varepsilon) \, d_T

    Notes
    -----
    A cycle begins at a reversal, so its closing line is at an extreme: while a rope still
    creeps by d a cycle under a tension amplitude, that line adds the amplitude times d to
    the area, several per cent in a narrow loop.  Both series are taken as a steady
    cycle and a drift that is linear in time; with y = y_s + d t / P the work of the drift,
    integrated by parts, is the correction.  Means of cycles have little noise, so it adds hardly
    any.

    Examples
    --------
    The ellipse of 31.416 J/m whose strain grows by 0.01 a cycle, begun at its least tension;
    the closed loop has 50 N * 0.01 = 0.5 J/m too much:

    >>> turn = np.linspace(0, 1, 401)
    >>> tension = 1000 - 50 * np.cos(2 * np.pi * turn)
    >>> strain = 0.01 * turn - 0.2 * np.sin(2 * np.pi * turn)
    >>> closed, _ = loop_energy(tension, strain, np.array([0]), np.array([400]))
    >>> steady = without_drift(closed, end_tension=950.0, mean_tension=1000.0,
    ...     tension_drift=0.0, end_strain=0.005, mean_strain=0.005, strain_drift=0.01)
    >>> print(closed.round(2), steady.round(2))
    [31.91] [31.41]
    """
    force = np.subtract(end_tension, mean_tension)
    stretch = np.subtract(end_strain, mean_strain)
    return np.asarray(energy + force * strain_drift - stretch * tension_drift)


_LEAST_STEP = 1e-9  # of the half range


def work_at_equal_phase(
    values: Floats,
    driven: Floats,
    time: Floats,
    branch_first: Integers,
    branch_last: Integers,
    levels: Floats,
) -> tuple[Floats, Floats, Floats]:
    r"""Integral of a series over the sine of the phase of another, mean of that sine, and x_a.

    .. math:: \oint y \, d\sin\theta, \qquad \overline{\sin\theta}, \qquad
              \cos\theta = \frac{x - \bar x}{x_a}

    Notes
    -----
    Between samples of a branch the series is linear in the other one, so that the turns,
    where the phase changes fast, cause no error; where noise reverses the other one, the series is
    linear in the sine.  ``levels`` are those of the other series in the first valley, the peak
    and the last valley of each cycle: with noisy readings it would end short of its turns.

    Examples
    --------
    A straight line of slope 900 whose strokes last 60 and 5 samples, amplitude 0.2:

    >>> strain = np.r_[np.linspace(-0.2, 0.2, 61), np.linspace(0.2, -0.2, 6)[1:]]
    >>> work, *_ = work_at_equal_phase(900 * strain, strain, np.arange(66.0),
    ...     np.array([[0, 60]]), np.array([[60, 65]]), np.array([[-0.2], [0.2], [-0.2]]))
    >>> print((work / (np.pi * 0.2)).round(6))
    [900.]
    """
    n_cycles = branch_first.shape[0]
    work, mean, used = np.zeros((3, n_cycles))
    for column, way in ((0, -1.0), (1, 1.0)):
        begin, end = branch_first[:, column], branch_last[:, column]
        low, high = levels[column : column + 2]
        length = end - begin + 1
        row = np.repeat(np.arange(n_cycles), length)
        at = np.arange(row.size) + np.repeat(begin - np.cumsum(length) + length, length)
        half, middle = way * (low - high) / 2, (high + low) / 2
        used += np.abs(half) / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            level = (driven[at] - middle[row]) / half[row]
        level[at == begin[row]], level[at == end[row]] = way, -way
        # noise takes a rest beyond its level as often as below it: there the sine changes sign
        mirror = np.where(np.abs(level) > 1, 2 * np.sign(level), 0.0)
        inside = np.clip(np.where(mirror == 0, level, mirror - level), -1, 1)
        sine = np.where(mirror == 0, way, -way) * np.sqrt(1 - inside**2)
        # integral of the level over the sine
        area = (way * np.arccos(inside) + sine * (level + mirror)) / 2
        step, rise = np.diff(level), np.diff(sine)
        with np.errstate(divide="ignore", invalid="ignore"):
            over = (np.diff(area) - level[:-1] * rise) / step
            share = np.where(-way * step > _LEAST_STEP, over, rise / 2)
        load, seconds = values[at], time[at]
        inside = row[1:] == row[:-1]
        for total, part in (
            (work, load[:-1] * rise + np.diff(load) * share),
            (mean, (sine[1:] + sine[:-1]) / 2 * np.diff(seconds)),
        ):
            total += np.bincount(row[:-1][inside], part[inside], n_cycles)
    with np.errstate(divide="ignore", invalid="ignore"):
        return work, mean / (time[branch_last[:, 1]] - time[branch_first[:, 0]]), used


def energy_of_cycles_missed_by_polygon(
    force: Floats, stretch: Floats, moved: Floats, begin: Integers, end: Integers
) -> tuple[Floats, Floats]:
    """Area missing from the polygon of the readings of each loop, and its possible error."""

    def of_cycles(lacking: Floats) -> Floats:
        up_to = np.concatenate([[0.0], np.cumsum(lacking)])
        # the area beside a valley belongs half to the cycle before it and half to the one after it
        beside = sum(lacking[np.maximum(at - 1, 0)] + lacking[at] for at in (begin, end))
        return np.asarray(up_to[np.maximum(end - 1, begin + 1)] - up_to[begin + 1] + beside / 2)

    at_corners, between = (
        of_cycles(one)
        for one in energy_missed_by_polygon(force, stretch, moved, noise=reading_noise(moved))
    )
    # half of it, as for the levels: no machine turns at once
    return at_corners / 2 + between, np.abs(at_corners / 2) + _OF_A_KINK * np.abs(between)


def energy_by_chance(tension: Floats, strain: Floats, first: Integers, last: Integers) -> float:
    r"""Possible error of the energy of smooth steps due to kinks of tension between readings.

    .. math:: u = \max_r \frac{1}{r^2} \sqrt{\frac1r \sum_p (H_{rp} - \bar H_r)^2}

    Notes
    -----
    The error of the sum of a kinked integrand is its second Bernoulli polynomial at the place of
    the kink between two readings, times the square of the interval.  The same holds for the sum
    over every r-th reading from the p-th on, H_rp, of r times the interval: their scatter is r^2
    times the error.  If the sampling is not synchronous with the wave, it averages out over cycles.

    Examples
    --------
    Dry friction of 10 N, 24 readings a cycle, 40.0 J/m:

    >>> turn = 2 * np.pi * (np.arange(24 * 6 + 1) + 0.3) / 24
    >>> drag = np.where(np.sin(turn) > 0, 10.0, -10.0)
    >>> first = 24 * np.arange(1, 5)
    >>> found, _ = loop_energy(drag, -np.cos(turn), first, first + 24, waveform="sinusoidal")
    >>> print((found[0] - 40).round(2), round(energy_by_chance(drag, -np.cos(turn), first,
    ...     first + 24), 2))
    0.06 0.1
    """
    first, last = first[:_MOST_FOLDED], last[:_MOST_FOLDED]
    part = slice(int(first[0]), int(last[-1]) + 1)
    own = first, last
    force, first, last = tension[part], first - part.start, last - part.start
    closing = (force[last] + force[first]) / 2
    place = np.arange(force.size)
    place -= first[np.searchsorted(first, place, side="right") - 1]
    found = 0.0
    for stride in range(2, 1 + min(4, int(np.median(last - first)) // 6)):
        energies = []
        # from the same readings, so that noise of strain meets changes of tension, not tension
        steps = _smooth_steps(strain, *own, stride)[part]
        for rest in range(stride):
            step = np.where(place % stride == rest, steps, 0.0)
            work, travel = (sums_over_cycles(one, first, last) for one in (step * force, step))
            energies.append(np.nanmean(work - closing * travel))
        found = max(found, float(np.std(energies)) / stride**2)
    lengths = last - first
    if lengths.size and (lengths == lengths[0]).all():
        found = max(found, _energy_by_aliases(force, strain[part], first, int(lengths[0])))
    return found


def _energy_by_aliases(tension: Floats, strain: Floats, first: Integers, n_samples: int) -> float:
    r"""Error of the energy of a sine due to kinks of tension, in a log synchronous with it.

    .. math:: u = \pi \hat\varepsilon \frac{C}{\sqrt 2}
        \sqrt{\frac1{(n - 1)^4} + \frac1{(n + 1)^4}}, \qquad
        C^2 = \overline{\lvert F_k \rvert^2 \Big/ \sum_{m} \frac1{(m n + k)^4}}

    Notes
    -----
    With n readings a cycle the harmonics n - 1 and n + 1 count as the fundamental.  Those of a wave
    with kinks fall with the square of their order, so they are estimated from the upper harmonics
    of the same parity that the readings show.  Of the lower harmonics only the part that no elastic
    line has is used, since a nonlinear line has many; and from all the part of a jump at the
    turns, as by dry friction, is excluded, since that cancels.  Sums over every other reading may
    agree by chance.

    Examples
    --------
    Slip at 10 N, read 12 and 1,200 times a cycle; energies, and the possible error of the first:

    >>> def loop(per_cycle, first):
    ...     turn = 2 * np.pi * (np.arange(6 * per_cycle + 1) + 0.3) / per_cycle
    ...     return np.clip(30 * np.sin(turn - 0.4), -10, 10), -np.cos(turn), per_cycle * first
    >>> for per_cycle in (12, 1200):
    ...     force, strain, first = loop(per_cycle, np.arange(1, 5))
    ...     print(loop_energy(force, strain, first, first + per_cycle,
    ...         waveform="sinusoidal")[0][0].round(1))
    36.3
    36.1
    >>> print(round(_energy_by_aliases(*loop(12, np.arange(1, 5)), 12), 1))
    1.0
    """
    harmonic = np.arange(2, (n_samples + 1) // 2)
    harmonic = harmonic[harmonic % 2 != n_samples % 2]
    if not harmonic.size:
        return 0.0
    cycle = first[:, None] + np.arange(n_samples)
    waves = [
        2 / n_samples * np.fft.rfft(np.nanmean(one[cycle], axis=0)) for one in (tension, strain)
    ]
    turned = np.angle(-waves[1][1])
    own = np.exp(-1j * harmonic * turned) * waves[0][harmonic]
    fold = np.arange(-20, 21)
    places = harmonic[:, None] + n_samples * fold
    per_kink = 1 / np.sqrt(((1.0 * places) ** -4).sum(axis=1))
    of_jump = 1j * (places % 2 / places * np.exp(1j * n_samples * turned * fold)).sum(axis=1)
    is_low = harmonic < n_samples / 3
    kinks, jump = (
        np.concatenate([(np.sqrt(2) * one.imag)[is_low], one.imag[~is_low], one.real[~is_low]])
        for one in (own * per_kink, of_jump * per_kink)
    )
    if kinks.size > 1 and jump @ jump > 0:
        kinks -= jump * (kinks @ jump) / (jump @ jump)
    square = 2 * np.sum(kinks**2) / max(kinks.size - 1, 1)
    beyond = (n_samples - 1.0) ** -4 + (n_samples + 1.0) ** -4
    energy = np.pi * np.abs(waves[1][1]) * np.sqrt(square * beyond / 2)
    return float(energy) if np.isfinite(energy) else 0.0


_MOST_FOLDED = 50  # cycles used to find how far chance changes all of them


_OF_A_KINK = 0.45
"""Of a third of D, standard deviation over all places of a kink between two readings: it is
D times the root of 16 / 720."""


def energy_of_rounding(
    series: tuple[Floats, Floats],
    steps: Sequence[float],
    left: Sequence[float],
    cycles: Cycles,
    norm: Floats,
    ranges: Floats,
    *,
    waveform: Waveform,
) -> Floats:
    """Standard uncertainty of the energy of each cycle by the steps of both converters.

    For every reading by itself, by the norm of the steps of strain, and for the branches together.
    """
    force, strain = ranges
    own = norm * np.hypot(left[0], left[1] * force / strain)
    if waveform == "sinusoidal":
        return np.asarray(own)
    of_branches = [
        # for both branches; noise reduces an error of their mean as it does that of one reading
        np.sqrt(2) * rounding_of_branches(one, cycles, step) * rest * np.sqrt(12) / step * other
        if step
        else 0.0
        for one, step, rest, other in zip(series, steps, left, (strain, force), strict=True)
    ]
    return np.asarray(np.sqrt(own**2 + sum(one**2 for one in of_branches)))

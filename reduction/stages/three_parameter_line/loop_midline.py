r"""Tension of the midline of a loop at its mean strain: the level of the slow spring of a cycle.

The mean tension of a cycle is the mean of its greatest and its least.  Where the slow spring of a
line is curved, :math:`T_0 + K_0 \varepsilon + c \varepsilon^2` about the mean strain, that mean is
above :math:`T_0` by up to :math:`c \varepsilon_a^2`, and the slope of the slow pull there is not
the one that applies over the cycle.  A loop shows its own curvature,

.. math:: T = a_0 + a_1 s + a_2 s^2 + a_3 s^3 \pm b \sqrt{1 - s^2}, \qquad
          s = (\varepsilon - \bar\varepsilon) / \varepsilon_a

with plus on the rising branch: :math:`a_0` is the tension of the spring.  K_0 of the cycle is the
chord of the spring about it, between the strains at the peak and the valley of tension,
:math:`\varepsilon_a \cos\varphi` to either side, with the loss angle :math:`\varphi`: there the
dashpot adds as much to the one as it takes from the other.  Waves other than sines are read by
their fundamentals, whose spring lies between that chord and the slope (`spring_of_wave`).  K_0
"must be calculated at the mean
load level" and be used "for small perturbations around that mean load" ([1]_); this module gives
what a large perturbation needs.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.4.2, 4.4.3 and App. D.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import evenly_spread
from reduction.record.measurement import Floats, Integers
from reduction.record.settings import Control, Waveform

_LEAST_SAMPLES = 12  # of a cycle, for five numbers

_MOST_CYCLES = 50  # spread evenly over the run


def tension_above_midline(
    strain: ArrayLike, tension: ArrayLike, *, first: Integers, turn: Integers, last: Integers
) -> tuple[float, float]:
    """Mean height of tension above the midline at the mean strain, and its uncertainty.

    Parameters
    ----------
    strain, tension : array_like, shape (n_samples,)
        Of one specimen. [1], [N]
    first, turn, last : ndarray of int, shape (n_cycles,)
        First and last sample of each cycle, and the first sample after its turn. [1]

    Returns
    -------
    difference, standard_uncertainty : float
        Mean over the cycles, and scatter of that mean; NaN with fewer than three cycles of 12
        samples. [N]

    Notes
    -----
    See the module.  Each cycle is fitted separately, so that drift and creep add no curvature.

    Examples
    --------
    A spring curved by 30 N at the ends of the stroke, with a dashpot:

    >>> phase = np.linspace(0, 8 * np.pi, 801)
    >>> strain = 0.02 - 0.01 * np.cos(phase)
    >>> s = (strain - 0.02) / 0.01
    >>> tension = 500 + 100 * s + 30 * s**2 + 5 * np.sin(phase)
    >>> first = np.array([0, 200, 400, 600])
    >>> above, _ = tension_above_midline(
    ...     strain, tension, first=first, turn=first + 100, last=first + 200
    ... )
    >>> print(round(above))
    30
    """
    strain, tension = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    chosen = evenly_spread(np.arange(first.size), _MOST_CYCLES)
    found = []
    for cycle in chosen.tolist():
        rows = slice(int(first[cycle]), int(last[cycle]) + 1)
        stretch, load = strain[rows], tension[rows]
        rises = np.arange(stretch.size) < turn[cycle] - first[cycle]
        known = np.isfinite(stretch) & np.isfinite(load)
        stretch, load, rises = stretch[known], load[known], rises[known]
        if stretch.size < _LEAST_SAMPLES or not np.ptp(stretch) > 0:
            continue
        s = 2 * (stretch - stretch.min()) / np.ptp(stretch) - 1
        apart = np.where(rises, 1.0, -1.0) * np.sqrt(np.maximum(1 - s**2, 0.0))
        design = np.stack([np.ones(s.size), s, s**2, s**3, apart], axis=1)
        series = np.linalg.lstsq(design, load, rcond=None)[0]
        # from the fitted loop: noise raises the greatest reading
        fitted = design @ series
        found.append((fitted.max() + fitted.min()) / 2 - series[0])
    if len(found) < 3:
        return float("nan"), float("nan")
    return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(len(found)))


_BENT = 3.0  # standard uncertainties by which a loop must be curved

_LEAST_BEND = 0.005  # of its amplitude: a load cell and a clock may curve it as much


def is_bent(above: float, standard_uncertainty: float, amplitude: float) -> bool:
    """Whether a loop is curved, from `tension_above_midline` and its tension amplitude.

    Examples
    --------
    >>> is_bent(30.0, 2.0, 1000.0), is_bent(30.0, 20.0, 1000.0), is_bent(3.0, 0.0, 1000.0)
    (True, False, False)
    """
    return abs(above) > max(_BENT * standard_uncertainty, _LEAST_BEND * amplitude)


def chord_of_spring(
    constant_at: Callable[[Floats], Floats], tension: ArrayLike, half_strain: ArrayLike
) -> tuple[Floats, Floats]:
    r"""Chord of a curved spring about a tension, and how far the mean of its ends is above it.

    .. math:: \frac{dT}{d\varepsilon} = K_0(T), \qquad
              K = \frac{T_+ - T_-}{2 \varepsilon}, \qquad \frac{T_+ + T_-}{2} - T

    Parameters
    ----------
    constant_at : callable
        K_0 at tensions, NaN where it is not known. [N]
    tension : array_like, shape (...)
        At the middle of the strains. [N]
    half_strain : array_like, shape (...)
        From the middle to either end. [1]

    Returns
    -------
    chord, above : ndarray, shape (...)
        NaN where K_0 is not known as far as the ends. [N], [N]

    Notes
    -----
    One fourth-order Runge-Kutta step to either side.

    Examples
    --------
    T = 4e5 e + 6e6 e^2 has the slope sqrt(16e10 + 24e6 T); about 800 kN at e = 1/30, the ends at
    .01 are 6e6 times 1e-4 above.

    >>> chord, above = chord_of_spring(lambda t: np.sqrt(16e10 + 24e6 * t), 20e3, 0.01)
    >>> print((chord / 1e3).round(), above.round())
    800.0 600.0
    """
    start, step = np.asarray(tension, dtype=np.float64), np.asarray(half_strain, dtype=np.float64)

    def end(step: Floats) -> Floats:
        first = constant_at(start)
        second = constant_at(start + step / 2 * first)
        third = constant_at(start + step / 2 * second)
        last = constant_at(start + step * third)
        return np.asarray(start + step / 6 * (first + 2 * second + 2 * third + last))

    high, low = end(step), end(-step)
    return np.asarray((high - low) / (2 * step)), np.asarray((high + low) / 2 - start)


def spring_of_wave(
    constant_at: Callable[[Floats], Floats],
    mean_tension: float,
    above_midline: float,
    half_strain: float,
    *,
    waveform: Waveform = "sinusoidal",
    control: Control = "position",
) -> float:
    r"""K_0 of a curved loop: chord of its spring, or for other waves that of the fundamental. [N].

    A sine is read by its peaks, which lie on the chord.  Other waves are read by their fundamentals
    over time: from the slope about the mean of the driven channel towards the chord, they go the
    share that :math:`s^3` has in the fundamental relative to s: :math:`3 (1 - 8 / \pi^2)` for a
    triangle, 3/4 for a sine, which stands for all others.  Where the pull does not reach far enough
    for a chord, the slope at the midline.

    Examples
    --------
    The spring of `chord_of_spring`, with loops whose mean is 600 N above their midline:

    >>> constant_at = lambda t: np.sqrt(16e10 + 24e6 * t)
    >>> for wave in ("sinusoidal", "triangular"):
    ...     print(round(spring_of_wave(constant_at, 20.6e3, 600.0, 0.01, waveform=wave,
    ...         control="load") / 1e3, 1))
    800.0
    803.9
    """
    middle = np.asarray(mean_tension - above_midline)
    chord = float(chord_of_spring(constant_at, middle, half_strain)[0])
    about = np.asarray(mean_tension) if waveform != "sinusoidal" and control == "load" else middle
    slope = float(constant_at(about))
    if not np.isfinite(chord):
        return float(constant_at(middle))
    return slope + _CUBIC_IN_FUNDAMENTAL[waveform] * (chord - slope)


_CUBIC_IN_FUNDAMENTAL = {"sinusoidal": 1.0, "triangular": 3 * (1 - 8 / np.pi**2), "other": 0.75}

_ROUNDS = 12  # each reduces the remainder by the curvature of the cycle, a tenth or so


def spring_of_cycle(
    constant_at: Callable[[Floats], Floats], mean_tension: ArrayLike, half_strain: ArrayLike
) -> Floats:
    """Chord of a curved spring between ends whose mean tension is given. [N].

    NaN where K_0 is not known as far as the ends.

    Examples
    --------
    The spring of `chord_of_spring`, from its mean tension:

    >>> chord = spring_of_cycle(lambda t: np.sqrt(16e10 + 24e6 * t), 20.6e3, 0.01)
    >>> print((chord / 1e3).round())
    800.0
    """
    mean = np.asarray(mean_tension, dtype=np.float64)
    middle = mean
    for _ in range(_ROUNDS):
        middle = mean - chord_of_spring(constant_at, middle, half_strain)[1]
    return chord_of_spring(constant_at, middle, half_strain)[0]

r"""EA of a cycle of tension, from the tests that cover it.

.. math:: EA_i = L_0 \, \frac{T_2 - T_1}{L_i(T_2) - L_i(T_1)}, \qquad
    EA = \frac{\sum_i EA_i / d_i^2}{\sum_i 1 / d_i^2}, \qquad
    d_i^2 = (\bar T_i - \bar T)^2 + (A_i - A)^2

T_1 and T_2 are the ends of the load range common to all tests that cover the cycle, and d_i is the
distance of test i from the cycle in mean and amplitude [1]_.  The interval is from the least EA_i
less its expanded uncertainty to the greatest EA_i plus it.

A curve that joins tests of different states keeps the tension continuous, but where it changes from
one test to the next it has the stiffness of neither: its slope is not used.

The chord of a mean curve lacks what the loop adds: the cycle of a test has its K_ap, and a smaller
cycle, whose loop was not measured, is stiffer [3]_.  With the chord c over the loads of a cycle,
the width w(x) of the loop at the distance x from its turns, the rise T_2 - T_1 of the cycle, and
the share s of a chord that is left without the loop (of the whole: that of its rise less w),

.. math:: c + (K_{ap} - c_{whole}) \le EA_i \le L_0 \, \frac{T_2 - T_1}{x}, \qquad
    T_2 - T_1 = \frac{s c}{L_0} x + w(x)

The lower end is that of a loss in proportion to the amplitude (linear viscoelastic), the upper end
that of friction, whose branches after a turn are the same in all cycles (Masing's rule).  EA_i is
the middle of both, and its interval reaches from one to the other.

References
----------
.. [1] D. Shepard, "A two-dimensional interpolation function for irregularly-spaced data," Proc.
   23rd ACM National Conf., 1968, pp. 517-524 (weights by the inverse square of the distance).
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 5.1, 5.2.
.. [3] G. Masing, "Eigenspannungen und Verfestigung beim Messing," Proc. 2nd Int. Congr. Applied
   Mechanics, Zurich, 1926, pp. 332-335.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.contributions import coverage_factor
from reduction.record.measurement import Bools, Floats, Integers, read_only_arrays

LEAST_COVER = 0.7
"""Share of the loads of a cycle that a test has to reach for its EA to be used. [1]"""

_ROUNDING = 1e-9


@dataclass(frozen=True)
@read_only_arrays
class LineLoop:
    """Loop of a line in the cycles of a test.

    Parameters
    ----------
    low, high : float
        Tensions at the turns. [N]
    begin, stroke : float
        Length at the lower turn, and from there to the upper. [m]
    distance : ndarray, shape (n,)
        From either turn; increasing, from zero. [m]
    width : ndarray, shape (n,)
        Greatest difference of tension between the branches up to there. [N]
    relative_uncertainty : float
        Standard uncertainty of the spring constant between the turns. [1]
    """

    low: float
    high: float
    begin: float
    stroke: float
    distance: Floats
    width: Floats
    relative_uncertainty: float = 0.0


@dataclass(frozen=True)
@read_only_arrays
class LoadedTest:
    """Length of a line against its tension in one test; arrays have the shape (n,).

    Parameters
    ----------
    words : str
        Test, and part of it.
    kind : str
        Kind of the piece.
    length, tension : ndarray, shape (n,)
        Both increasing. [m], [N]
    random_standard_uncertainty : ndarray, shape (n,)
        Random part for the tension at one length. [N]
    contribution : ndarray, shape (n_components, n)
        Signed contribution of each shared error to the tension at one length. [N]
    low, high : float
        Loads between which it was tested. [N]
    loop : LineLoop, optional
        Of the mean curve of cycles, where known.
    """

    words: str
    kind: str
    length: Floats
    tension: Floats
    random_standard_uncertainty: Floats
    contribution: Floats
    low: float
    high: float
    loop: LineLoop | None = None

    @property
    def cycle(self) -> tuple[float, float]:
        """Loads at its turns, or of its curve where it has no loop. [N]."""
        return (self.low, self.high) if self.loop is None else (self.loop.low, self.loop.high)


@dataclass(frozen=True)
@read_only_arrays
class CycleStiffness:
    """EA of cycles; arrays have the shape (n,) or (n_tests, n) of the cycles, NaN without one.

    Parameters
    ----------
    spring_constant : ndarray, shape (n,)
        EA. [N]
    least, greatest : ndarray, shape (n,)
        Ends of its interval: all tests with their expanded uncertainties, 95 %. [N]
    low, high : ndarray, shape (n,)
        Load range common to the tests. [N]
    nearest : ndarray of int, shape (n,)
        Test used that is nearest in mean and amplitude; -1 where none is used.
    covered : ndarray, shape (n_tests, n)
        Share of the cycle that each test reaches. [1]
    test_spring_constant, test_standard_uncertainty : ndarray, shape (n_tests, n)
        EA of each test used. [N]
    curve_least, curve_greatest : ndarray, shape (n,)
        As ``least`` and ``greatest``, of the curves of the tests without their loops: what the
        slope of a curve can be compared with. [N]
    """

    spring_constant: Floats
    least: Floats
    greatest: Floats
    low: Floats
    high: Floats
    nearest: Integers
    covered: Floats
    test_spring_constant: Floats
    test_standard_uncertainty: Floats
    curve_least: Floats
    curve_greatest: Floats


def stiffness_of_cycles(
    tests: Sequence[LoadedTest], low: ArrayLike, high: ArrayLike, *, slack_length: float
) -> CycleStiffness:
    r"""EA of cycles of tension from the tests that cover at least 70 % of each.

    Parameters
    ----------
    tests : sequence of LoadedTest
        Kinds of higher precedence first.
    low, high : array_like, shape (n,)
        Valley and peak of each cycle. [N]
    slack_length : float
        Reference length of the strain. [m]

    Returns
    -------
    stiffness : CycleStiffness
        EA with its interval, in total and by test. [SI]

    Notes
    -----
    Tests of one kind are used together: where loops cover a cycle, static tests and first loadings,
    which are slower or of another state, are not used.  Where they are used beside the loops, the
    interval reaches as far as EA of a loop differs from theirs over its loads.  The chord of a test
    is taken at its own lengths: the errors of its tension at both ends change its EA,

    .. math:: u^2(EA_i) = \Bigl(\frac{EA_i}{T_2 - T_1}\Bigr)^2
        \Bigl(u_1^2 + u_2^2 + \sum_k (c_{k2} - c_{k1})^2\Bigr)

    with the random part u at each end and the contribution c_k of each shared error ([2]_).  Two
    tests that reach 70 % of a cycle have at least 40 % of it in common.

    References
    ----------
    .. [1] D. Shepard, 1968, as `reduction.lines.cycle_stiffness`.
    .. [2] JCGM 100:2008, 5.1, 5.2.

    Examples
    --------
    Two springs of 100 and 300 N per unit strain, 1 m long, between 60 and 140 N:

    >>> at = np.linspace(1.0, 3.0, 21)
    >>> springs = [LoadedTest(f"T-{ea}", "cyclic", at, ea * (at - 1), 0 * at, np.empty((0, 21)),
    ...     50.0, 150.0) for ea in (100, 300)]
    >>> found = stiffness_of_cycles(springs, [60.0, 10.0], [140.0, 90.0], slack_length=1.0)
    >>> print(found.spring_constant.round(6), found.least.round(6), found.greatest.round(6))
    [200.  nan] [100.  nan] [300.  nan]
    """
    valley, peak = np.atleast_1d(np.asarray(low, float)), np.atleast_1d(np.asarray(high, float))
    shape = (len(tests), valley.size)
    ends = np.array([(one.low, one.high) for one in tests]).reshape(-1, 2, 1)
    begin, end = np.maximum(valley, ends[:, 0]), np.minimum(peak, ends[:, 1])
    with np.errstate(invalid="ignore", divide="ignore"):
        covered = np.nan_to_num(np.maximum(end - begin, 0.0) / (peak - valley))
    is_used = _first_kind_that_covers(tests, covered >= LEAST_COVER - _ROUNDING)
    is_known = is_used.any(axis=0)
    first = np.where(is_used, begin, -np.inf).max(axis=0, initial=-np.inf)
    last = np.where(is_used, end, np.inf).min(axis=0, initial=np.inf)
    first, last = np.where(is_known, first, np.nan), np.where(is_known, last, np.nan)
    spring, spread = np.full(shape, np.nan), np.full(shape, np.nan)
    least_of_loop, most_of_loop = np.zeros(shape), np.zeros(shape)
    for place, one in enumerate(tests):
        own = is_used[place]
        loads = first[own], last[own]
        rise, by = loads[1] - loads[0], slack_length / _between(one.length, one, *loads)
        errors = [
            *(np.interp(at, one.tension, one.random_standard_uncertainty) for at in loads),
            *(_between(row, one, *loads) for row in one.contribution),
        ]
        spring[place, own] = rise * by
        spread[place, own] = np.linalg.norm(errors, axis=0) * by
        if one.loop is not None:
            least_of_loop[place, own], most_of_loop[place, own] = _of_loop(
                one, one.loop, spring[place, own], valley[own], peak[own], slack_length
            )
            # what changes the stiffness of the curve changes that of the whole cycle as much
            spread[place, own] *= 1 + least_of_loop[place, own] / spring[place, own]
            # turns that the readings missed are in the whole cycle, not in its curve
            whole = spring[place, own] + least_of_loop[place, own]
            spread[place, own] = np.maximum(
                spread[place, own], one.loop.relative_uncertainty * whole
            )
    cycles = np.array([one.cycle for one in tests]).reshape(-1, 2, 1)
    apart = _distance(cycles, valley, peak)
    weight = np.where(is_used, apart**-2, 0.0)
    factor = float(coverage_factor(np.inf))
    with np.errstate(invalid="ignore", divide="ignore"):
        of_test = spring + (least_of_loop + most_of_loop) / 2
        value = np.nansum(weight * of_test, axis=0) / weight.sum(axis=0)

    def interval(more: Floats, most: Floats) -> tuple[Floats, Floats]:
        low = np.where(is_used, spring + more - factor * spread, np.inf).min(0, initial=np.inf)
        high = np.where(is_used, spring + most + factor * spread, -np.inf).max(0, initial=-np.inf)
        return (
            np.where(is_known, np.maximum(low, 0.0), np.nan), np.where(is_known, high, np.nan),
        )  # fmt: skip

    none = np.zeros(shape)
    least, greatest = interval(least_of_loop, most_of_loop)
    softer, stiffer = _other_state(tests, is_used, slack_length)
    least, greatest = least * softer, greatest * stiffer
    curve_least, curve_greatest = interval(none, none)
    nearest = (
        np.where(is_used, apart, np.inf).argmin(axis=0) if tests else np.zeros(valley.size, int)
    )
    return CycleStiffness(
        spring_constant=value,
        least=least,
        greatest=greatest,
        low=first,
        high=last,
        nearest=np.where(is_known, nearest, -1),
        covered=covered,
        test_spring_constant=of_test,
        test_standard_uncertainty=np.hypot(spread, (most_of_loop - least_of_loop) / np.sqrt(12)),
        curve_least=curve_least,
        curve_greatest=curve_greatest,
    )


def middle_of_cycle(test: LoadedTest, low: float, high: float) -> float:
    """How far the middle of a cycle is from the length at its mean tension. [m].

    Notes
    -----
    Both are on the curve of one test, up to the turns of its loop.  Of a cycle that goes beyond it,
    the part within is taken, and the bend grows by the square of the amplitude.

    Examples
    --------
    T = x^2 between 0.25 and 2.25 N: 0.5 to 1.5 m, with 1.25 N at 1.118 m.

    >>> x = np.linspace(0.4, 1.6, 1201)
    >>> none = np.empty((0, x.size))
    >>> test = LoadedTest("T", "static", x, x**2, 0 * x, none, 0.16, 2.56)
    >>> print(round(middle_of_cycle(test, 0.25, 2.25), 3))
    -0.118
    """
    length, tension = test.length, test.tension
    if test.loop is not None:
        ends = np.array([test.loop.low, test.loop.high])
        turns = test.loop.begin + np.array([0.0, test.loop.stroke])
        is_inside = (tension > ends[0]) & (tension < ends[1])
        is_inside &= (length > turns[0]) & (length < turns[1])
        tension = np.concatenate([ends[:1], tension[is_inside], ends[1:]])
        length = np.concatenate([turns[:1], length[is_inside], turns[1:]])
    within = np.clip((low, high), tension[0], tension[-1])
    rise = float(within[1] - within[0])
    if rise <= 0:
        return 0.0
    at = np.interp((*within, within.mean()), tension, length)
    return float((at[:2].mean() - at[2]) * ((high - low) / rise) ** 2)


def _of_loop(
    test: LoadedTest,
    loop: LineLoop,
    chord: Floats,
    valley: Floats,
    peak: Floats,
    slack_length: float,
) -> tuple[Floats, Floats]:
    """What a loop adds at least and at most to the chords of its mean curve. [N]."""
    whole = slack_length * (loop.high - loop.low) / loop.stroke
    middle = slack_length * (test.high - test.low) / (test.length[-1] - test.length[0])
    least = np.full(chord.size, max(whole - middle, 0.0))
    # the mean curve near its ends belongs to both branches: without the loop, the whole has less
    bare = np.minimum(slack_length * (loop.high - loop.low - loop.width[-1]) / loop.stroke, middle)
    slopes = chord * bare / middle / slack_length
    # a cycle beyond the turns has at least the stroke of the test
    rise = np.minimum(peak, loop.high) - np.maximum(valley, loop.low)
    most = np.empty(chord.size)
    for place, (slope, own) in enumerate(zip(slopes, rise, strict=True)):
        pulled = slope * loop.distance + loop.width
        far = loop.distance[-1] + max(own - pulled[-1], 0.0) / slope
        at = far if own > pulled[-1] else np.interp(own, pulled, loop.distance)
        most[place] = slack_length * own / at - chord[place]
    return least, np.maximum(most, least)


def _first_kind_that_covers(tests: Sequence[LoadedTest], is_enough: Bools) -> Bools:
    """Tests that cover a cycle, of the first kind with such a test, shape (n_tests, n)."""
    is_used = np.zeros_like(is_enough)
    for kind in dict.fromkeys(one.kind for one in tests):
        own = np.array([one.kind == kind for one in tests])[:, None] & is_enough
        is_used |= own & ~is_used.any(axis=0)
    return is_used


def _other_state(
    tests: Sequence[LoadedTest], is_used: Bools, slack_length: float
) -> tuple[Floats, Floats]:
    """Least and greatest ratio of EA of tests of higher precedence to that of those used, (n,).

    Over the loads of the former, where both are known; 1 is between them.
    """
    softer, stiffer = np.ones((2, is_used.shape[1]))
    kinds = [one.kind for one in tests]
    for kind in dict.fromkeys(kinds):
        own = [one for one in tests if one.kind == kind]
        higher = tests[: kinds.index(kind)]
        here = is_used[[one == kind for one in kinds]].any(axis=0)
        if not (higher and here.any()):
            continue
        loads = np.array([one.cycle for one in higher]).T
        of_higher, of_own = (
            stiffness_of_cycles(of, *loads, slack_length=slack_length).spring_constant
            for of in (higher, own)
        )
        ratio = of_higher / of_own
        softer[here] = np.fmin(1.0, np.fmin.reduce(ratio))
        stiffer[here] = np.fmax(1.0, np.fmax.reduce(ratio))
    return softer, stiffer


def _between(values: Floats, test: LoadedTest, low: Floats, high: Floats) -> Floats:
    """Difference of values along a test between two loads."""
    first, last = (np.interp(at, test.tension, values) for at in (low, high))
    return np.asarray(last - first)


def _distance(ends: Floats, valley: Floats, peak: Floats) -> Floats:
    """Distance of tests from cycles in mean and amplitude, shape (n_tests, n). [N]."""
    mean = (ends[:, 0] + ends[:, 1] - valley - peak) / 2
    amplitude = (ends[:, 1] - ends[:, 0] - peak + valley) / 2
    return np.asarray(np.maximum(np.hypot(mean, amplitude), _ROUNDING * (valley + peak)))

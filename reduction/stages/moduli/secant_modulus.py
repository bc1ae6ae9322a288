r"""Secant, chord and dynamic moduli, ratios of curves, trends over cycles.

**Dynamic modulus, loss factor and energy of a test as one number each, with its amplitude.** The
slope of a loop has three readings that differ.  For a loop of loss angle :math:`\delta`,
"the line drawn between the ends of the loop" has the slope

.. math::

    |K| \cos\delta \;\text{(strain extremes)}, \qquad |K| \;\text{(amplitudes)}, \qquad
    |K| / \cos\delta \;\text{(tension extremes)}

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] A. R. Payne, "The dynamic properties of carbon black-loaded natural rubber vulcanizates,"
   J. Appl. Polym. Sci., vol. 6, 1962.
.. [3] JCGM 100, "Guide to the expression of uncertainty in measurement," 2008, G.4.
.. [4] A. N. Gent, "Relaxation processes in vulcanized rubber. I," J. Appl. Polym. Sci. 6(22),
   1962 (straight lines against the logarithm of time).
.. [5] J. von Neumann, R. H. Kent, H. R. Bellinson and B. I. Hart, "The mean square successive
   difference," Ann. Math. Stat. 12(2), 1941.
.. [6] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.2 and A-3 (slope of the line between
   the ends of the loop; which ends is not said).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.record.arrays import as_positive
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers
from reduction.record.notes import note
from reduction.record.samples import take_samples
from reduction.stages.cycles.cycle_product import Cycles, Loops, turns_alike
from reduction.stages.cycles.fundamental import steady_cycles
from reduction.stages.cycles.reading_noise import reading_noise
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.moduli.local_regression import RunningStatistics, curve_at
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    EndModuli,
    ModulusCurves,
    PeakTrend,
    Ratio,
)
from reduction.stages.moduli.tangent_modulus import pair_specimens


def _secant_modulus(strain: ArrayLike, tension: ArrayLike, *, area: ArrayLike) -> Floats:
    r"""Stress over strain, from the unstretched state.

    .. math:: E = \frac{F}{A \varepsilon}

    Notes
    -----
    Printed source: eq. 1 of [1]_. NaN where strain is zero or below, or an input is NaN.

    Examples
    --------
    The design value of sec. 2.3 of [1]_, 85 lbf at 100 %, on a diameter of 1.04 in: 100 psi.

    >>> print((_secant_modulus(1.0, 378.1, area=5.4805e-4) / 6894.757).round(0))
    100.0
    """
    areas = as_positive("area", area)
    strain, tension = np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    return np.asarray(tension / (areas * np.where(strain > 0, strain, np.nan)))


def chord_modulus(
    strain_low: ArrayLike,
    strain_high: ArrayLike,
    tension_low: ArrayLike,
    tension_high: ArrayLike,
    *,
    area: ArrayLike,
) -> Floats:
    r"""Slope of stress between two points of a branch.

    .. math:: E = \frac{F_2 - F_1}{A (\varepsilon_2 - \varepsilon_1)}

    Parameters
    ----------
    strain_low : array_like, shape (...)
        Strain at one point. [1]
    strain_high : array_like, shape (...)
        Strain at the other. [1]
    tension_low : array_like, shape (...)
        Tension at the first point. [N]
    tension_high : array_like, shape (...)
        Tension at the other. [N]
    area : array_like, shape (...)
        Cross-sectional area at zero tension. [m2]

    Returns
    -------
    modulus : ndarray, shape (...)
        Chord modulus. [Pa]

    Raises
    ------
    DataError
        If an area is not positive, or a pair of points has the same strain.

    Notes
    -----
    Printed source: Tables 5 and 6 of [1]_ are chords between the limits they print; 43 of
    their 47 rows agree within 1 psi, on 1.04 in for the new tether (Table 2 prints 1.01)
    and 0.94 in for the used one. End points carry the noise of two samples; use it on
    means, not on raw samples.

    Examples
    --------
    Table 6 of [1]_, T-5 new: 124 to 275 lbf over 1.72 to 2.19, printed 378 psi.

    >>> pound_force, psi = 4.4482216, 6894.757
    >>> modulus = chord_modulus(
    ...     1.72, 2.19, 124 * pound_force, 275 * pound_force, area=np.pi / 4 * 0.026416**2
    ... )
    >>> print((modulus / psi).round(0))
    378.0
    """
    areas = as_positive("area", area)
    run = np.asarray(strain_high, dtype=np.float64) - np.asarray(strain_low, dtype=np.float64)
    if (run == 0).any():
        raise DataError(
            "a chord needs two strains",
            found=f"{np.count_nonzero(run == 0)} of {run.size} pairs with equal strain",
            needed="two different strains",
        )
    rise = np.asarray(tension_high, dtype=np.float64) - np.asarray(tension_low, dtype=np.float64)
    return np.asarray(rise / (areas * run))


def end_moduli(
    strain: ArrayLike, tension: ArrayLike, *, area: ArrayLike, cycles: Cycles
) -> EndModuli:
    r"""Secant modulus at the peak of each cycle, and chord modulus of each branch.

    .. math::

        E_{sec} = \frac{F_{peak}}{A \varepsilon_{peak}}, \qquad
        E_{chord} = \frac{F_{end} - F_{begin}}{A (\varepsilon_{end} - \varepsilon_{begin})}

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    cycles : Cycles
        Whole branches, ends included. [SI]

    Returns
    -------
    moduli : EndModuli
        By cycle, with standard uncertainties. [Pa]

    Raises
    ------
    DataError
        If strain, tension and area do not pair up, or an area is not positive.

    Notes
    -----
    Printed source: eq. 1 of [1]_ for the secant. The peak is the reversal, the last sample
    of the ascending branch; where the machine dwells there, the sample at which it arrives.
    Each number rests on one or two readings: its uncertainty is their noise
    (`reading_noise`), nothing else. NaN where a reading is missing, the secant also where
    strain is zero or below, the chord where a branch has no stroke.

    Examples
    --------
    From 100 % and 1000 N to 200 % and 2500 N and back to 1100 N, on 1 cm2:

    >>> strain = np.array([[1.0, 1.5, 2.0, 1.5, 1.0]])
    >>> tension = np.array([[1000.0, 1700.0, 2500.0, 1800.0, 1100.0]])
    >>> ends = np.array([[0, 2]])
    >>> cycles = Cycles(
    ...     np.array([0]), np.array([4]), ends, ends + 2, np.ones((1, 2)),
    ...     np.ones(5, np.int32), np.array([1, 1, 1, 2, 2], np.int8), np.ones(5, bool), 0.1,
    ... )
    >>> moduli = end_moduli(strain, tension, area=[1e-4], cycles=cycles)
    >>> print(moduli.secant_modulus / 1e6, moduli.chord_modulus / 1e6)
    [[12.5]] [[[15. 14.]]]
    """
    strains, tensions, areas = pair_specimens(strain, tension, area)
    peak = cycles.branch_last[:, 0]
    ends = [take_samples(series, cycles.branch_first) for series in (strains, tensions)]
    ends += [take_samples(series, cycles.branch_last) for series in (strains, tensions)]
    strain_begin, tension_begin, strain_end, tension_end = ends
    strain_end = np.where(strain_end == strain_begin, np.nan, strain_end)
    section = areas[:, None]
    strain_at_peak = take_samples(strains, peak)
    secant = _secant_modulus(strain_at_peak, take_samples(tensions, peak), area=section)
    chord = chord_modulus(
        strain_begin, strain_end, tension_begin, tension_end, area=section[..., None]
    )
    noise = np.array([reading_noise(one) for one in tensions])[:, None]
    strain_noise = np.array([reading_noise(one) for one in strains])[:, None]
    at_peak = np.hypot(noise / section, secant * strain_noise) / np.abs(strain_at_peak)
    of_branch = np.sqrt(2) * np.hypot(noise[..., None] / section[..., None],
                                      chord * strain_noise[..., None])  # fmt: skip
    return EndModuli(
        secant_modulus=secant,
        secant_modulus_standard_uncertainty=at_peak,
        chord_modulus=chord,
        chord_modulus_standard_uncertainty=of_branch / np.abs(strain_end - strain_begin),
    )


_QUANTITIES = (
    "frequency", "mean_strain", "strain_amplitude", "mean_tension", "tension_amplitude",
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant", "loss_factor", "closed_loop_energy",
)  # fmt: skip


def _mean_over_cycles(values: Floats, uncertainty: Floats | None) -> tuple[Floats, Floats]:
    """Mean over the last axis without NaN, and its standard uncertainty of type A."""
    if uncertainty is None:
        uncertainty = np.full_like(values, np.nan)
    statistics = RunningStatistics.of(values.T, uncertainty.T**2, weight=np.ones(values.shape[1]))
    return statistics.value(), statistics.standard_uncertainty()


_FEWEST_TO_SETTLE = 4  # cycles, of which the last half is a mean


def late_change(values: Floats) -> float:
    """Mean over the last half of the cycles minus that over all; NaN for fewer than four.

    Parameters
    ----------
    values : ndarray, shape (n_cycles,)
        One per cycle, NaN where there is none. [SI]

    Returns
    -------
    change : float
        [SI]

    Examples
    --------
    >>> late_change(np.array([106.0, 102.0, np.nan, 100.0, 100.0]))
    -2.0
    """
    known = values[np.isfinite(values)]
    if known.size < _FEWEST_TO_SETTLE:
        return np.nan
    return float(known[known.size // 2 :].mean() - known.mean())


def mean_frequency(loops: Loops, cycles: slice | Integers) -> tuple[Floats, Floats]:
    r"""Frequency over some cycles, and its standard uncertainty, shape (n_specimens,) each.

    .. math:: f = n / \sum P, \qquad u^2(f) = \left(\frac{f^2 \sqrt 2 \, u(t)}{n}\right)^2
              + \frac{1}{3} \left(\frac{\dot\delta}{2 \pi}\right)^2
              + \left(\frac{2 f^2 L}{n}\right)^2

    Notes
    -----
    A machine that searches its amplitude turns its phase: L is the span, beyond noise, of the
    lead of its turns over even ones, and twice the span over the duration is how far the mean may
    be from the frequency to which the machine settles.

    Cycles touch, so that only the first and the last turn are uncertain: by the scatter of
    the durations or, where it is larger, by the uncertainty of each cycle.  While the loss angle
    changes, the driven channel and the other one differ in frequency; between the two the frequency
    of a test is not defined, and the excess of that rate over its own uncertainty counts as limits
    of a uniform distribution.
    """
    frequency = loops.frequency[:, cycles]
    angle = np.arctan2(loops.loss_over_time[:, cycles], loops.storage_over_time[:, cycles])
    time = loops.cycle_start_time[:, cycles]
    n_specimens = frequency.shape[0]
    mean, spread = np.full(n_specimens, np.nan), np.full(n_specimens, np.nan)
    own = loops.uncertainty.get("frequency", np.zeros(loops.frequency.shape))[:, cycles]
    for row in range(n_specimens):
        known = np.isfinite(frequency[row]) & (frequency[row] > 0)
        run = known.copy()
        # the phase of a wave that still grows, or dies out, is not that of the machine
        steady = known & steady_cycles(
            loops.strain_amplitude[row, cycles],
            loops.tension_amplitude[row, cycles],
        )
        known = steady if 2 * steady.sum() > known.sum() else known
        # a cycle that includes a wait, as before the machine starts, is not typical of the others
        n = int(known.sum())
        if n:
            middle = np.median(frequency[row, known])
            off = np.abs(frequency[row] - middle)
            scatter = max(np.median(off[known]), np.median(own[row, known]))
            limit = np.clip(_BEYOND_SCATTER * scatter, _LEAST_WAIT * middle, _WAITING * middle)
            alike = known & (off < limit)
            known = alike if alike.sum() >= _MOST_ALIKE * n else known
            n = int(known.sum())
        if not n:
            continue
        # the last one of a row may have no end of its own, and double the error of its beginning
        of_turn = own[row] / frequency[row] ** 2
        while n > 2 and of_turn[known][-1] > _IMPRECISE * np.median(of_turn[known]):
            known[np.flatnonzero(known)[-1]] = False
            n -= 1
        period = 1 / frequency[row, known]
        mean[row] = n / period.sum()
        run &= np.abs(frequency[row] - mean[row]) < _WAITING * mean[row]
        jitter = np.sqrt(np.mean(np.diff(period) ** 2) / 3) if n > 1 else 0.0
        ends = float(np.hypot(*own[row, known][[0, -1]])) / np.sqrt(2)
        of_turns = max(ends, mean[row] ** 2 * float(jitter)) / max(n - 1, 1)
        # cycles separated by gaps have ends of their own, whose sampling errors may be equal
        n_rows = 1 + np.sum(np.diff(time[row, known]) > _APART * period[:-1])
        of_turns = max(of_turns, ends * n_rows / n) if n_rows > 1 else of_turns
        # a driver that searches its wave: by how much its turns lead or lag even ones
        whole = 1 / frequency[row, run]
        lead = np.cumsum(np.append(0.0, whole - whole.sum() / max(whole.size, 1)))
        of_turn = float(np.max(own[row, run], initial=0.0)) / mean[row] ** 2
        of_noise = of_turn * np.sqrt(3 * np.log(n + 1.0))
        wanders = np.sqrt(max(float(np.ptp(lead)) ** 2 - of_noise**2, 0.0))
        of_turns = np.hypot(of_turns, 2 * wanders * mean[row] ** 2 / n)
        rate, of_rate = _line_over(time[row, known], angle[row, known])
        beyond = np.sqrt(max(rate**2 - of_rate**2, 0.0)) / (2 * np.pi)
        spread[row] = np.hypot(of_turns, beyond / np.sqrt(3))
    return mean, spread


def _line_over(time: Floats, values: Floats) -> tuple[float, float]:
    """Slope of a series over time and its standard uncertainty; zero if no line can be fitted."""
    known = np.isfinite(time) & np.isfinite(values)
    if known.sum() < _FEWEST_OF_LINE or not np.ptp(time[known]) > 0:
        return 0.0, 0.0
    x, y = time[known] - time[known].mean(), values[known] - values[known].mean()
    square = float((x**2).sum())
    slope = float((x * y).sum()) / square
    return slope, float(np.sqrt(((y - slope * x) ** 2).sum() / (x.size - 2) / square))


_FEWEST_OF_LINE = 4

_APART = 1.5  # periods from the beginning of a cycle to that of the next one

_WAITING, _MOST_ALIKE = 0.15, 0.75  # of a frequency, whatever the scatter; of the cycles

_BEYOND_SCATTER, _LEAST_WAIT = 10.0, 0.005  # median deviations; of a frequency

_IMPRECISE = 1.3  # times the usual uncertainty of a cycle's frequency


def summarise_amplitude(
    loops: Loops,
    *,
    area: ArrayLike,
    break_in_cycles: int = 0,
    turns_alike: Floats | float = 0.0,
) -> AmplitudeSummary:
    r"""Mean over the cycles of quantities that depend on mean strain and amplitude.

    .. math:: E_{dyn} = K_{ap} / A

    Parameters
    ----------
    loops : Loops
        One row a cycle and specimen. [SI]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension; NaN for a rope without a stated area. [m2]
    break_in_cycles : int
        First cycles that are left out. [1]
    turns_alike : ndarray, shape (n_specimens,), optional
        Correlation of the errors of tension and strain from a turn between two samples. [1]

    Returns
    -------
    summary : AmplitudeSummary
        Means, with their standard uncertainty by name. [SI]

    Raises
    ------
    DataError
        If an area is not positive, or no cycle is left.

    Notes
    -----
    Filled rubber is the softer the larger the amplitude ([2]_), so a dynamic modulus
    without its strain amplitude is of little use: T-1 and T-2, and T-3 and T-4, of [1]_ are
    pairs with one mean and two amplitudes.

    ``slope_reading_spread`` is the distance between the other two readings of "slope of the loop",
    over K_ap (`reduction.stages.cycles.loops`).

    Uncertainty is type A: scatter over the cycles over the root of their number; for a
    single cycle, its own. It is the uncertainty of the mean of these cycles: a trend is not scatter
    (`reduction.stages.moduli.local_regression._variance_of_a_cycle`), and `late_change` is the
    distance of the mean from the later cycles. Cycles with NaN are left out.  Errors
    common to all cycles are added: a turn missed between two samples in means, amplitudes, K_ap,
    K', energy, loss and loss factor, and in the frequency the difference between the driven channel
    and the other one.

    Examples
    --------
    Two cycles of 100 N and 110 N per unit strain on 1 cm2:

    >>> import numpy as np
    >>> one = np.ones((1, 2))
    >>> loops = Loops(
    ...     **{name: one for name in Loops.__dataclass_fields__ if name not in (
    ...         "apparent_spring_constant", "tension_turn_missed", "strain_turn_missed",
    ...         "energy_turn_missed", "uncertainty")},
    ...     apparent_spring_constant=np.array([[100.0, 110.0]]), uncertainty={},
    ...     tension_turn_missed=0 * one, strain_turn_missed=0 * one, energy_turn_missed=0 * one,
    ... )
    >>> summary = summarise_amplitude(loops, area=[1e-4])
    >>> print(summary.dynamic_modulus, summary.uncertainty["dynamic_modulus"])
    [1050000.] [50000.]
    """
    areas = np.atleast_1d(np.asarray(area, dtype=np.float64))
    as_positive("area", areas[~np.isnan(areas)])
    n_cycles = loops.frequency.shape[1]
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "no cycle is left after break-in",
            found=f"{n_cycles} cycles, {break_in_cycles} of them break-in",
            needed="at least one cycle more than cycles.break_in_cycles",
        )
    means: dict[str, Floats] = {}
    uncertainty: dict[str, Floats] = {}
    for name in _QUANTITIES:
        own = loops.uncertainty.get(name)
        means[name], uncertainty[name] = _mean_over_cycles(
            getattr(loops, name)[:, break_in_cycles:],
            None if own is None else own[:, break_in_cycles:],
        )
    means["frequency"], uncertainty["frequency"] = mean_frequency(
        loops, slice(break_in_cycles, None)
    )
    alike = loops.shared_by_cycles(slice(break_in_cycles, None), turns_alike=turns_alike)
    for name, shared in alike.items():
        uncertainty[name] = np.hypot(uncertainty[name], shared)
    # noise may turn a loss angle negative: then there is no ellipse to read slopes from
    tangent = np.where(means["loss_factor"] >= 0, means["loss_factor"], np.nan)
    secant = np.sqrt(1 + tangent**2)
    means["slope_reading_spread"] = secant - 1 / secant
    per_tangent = tangent / secant * (1 + 1 / (1 + tangent**2))
    # a budget has the place of the drift for the loss factor, but none for this
    drift = (means["closed_loop_energy"] - means["hysteresis_energy"]) * loops.drift_not_placed()
    with np.errstate(divide="ignore", invalid="ignore"):
        of_drift = drift / (
            np.pi * means["strain_amplitude"] ** 2 * means["storage_spring_constant"]
        )
    uncertainty["slope_reading_spread"] = per_tangent * np.hypot(
        uncertainty["loss_factor"], of_drift
    )
    means["dynamic_modulus"] = means["apparent_spring_constant"] / areas
    uncertainty["dynamic_modulus"] = uncertainty["apparent_spring_constant"] / areas
    return AmplitudeSummary(**means, uncertainty=uncertainty)


_MANY = 1e9
"""Degrees of freedom for hundreds of samples."""


@dataclass(frozen=True)
class _Side:
    """Numerator or denominator on the common axis; arrays (2, n_bins)."""

    name: str
    modulus: Floats
    uncertainty: Floats
    freedom: Floats


def _ratio(strain: Floats, above: _Side, below: _Side) -> Ratio:
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = above.modulus / below.modulus
        relative = [(side.uncertainty / side.modulus) ** 2 for side in (above, below)]
        total = relative[0] + relative[1]
        # Welch-Satterthwaite, [3]_ eq. G.2b
        freedom = total**2 / (relative[0] ** 2 / above.freedom + relative[1] ** 2 / below.freedom)
        uncertainty = np.abs(ratio) * np.sqrt(total)
        reach = uncertainty * stdtrit(np.where(total > 0, freedom, 1), (1 + CONFIDENCE) / 2)
    is_apart = not np.isfinite(ratio).any()
    low, high = ratio - reach, ratio + reach
    return Ratio(
        numerator=above.name,
        denominator=below.name,
        strain_bin=strain,
        ratio=ratio,
        ratio_standard_uncertainty=uncertainty,
        ratio_low=low,
        ratio_high=high,
        is_different=(low > 1) | (high < 1),
        notes=(note("no-common-strain", above=above.name, below=below.name),) if is_apart else (),
        degrees_of_freedom=freedom,
    )


def _spacing(curves: ModulusCurves) -> float:
    return float(np.ptp(curves.strain_bin_bounds[0]))


def _side(curves: ModulusCurves, specimen: int, name: str, strain: Floats) -> _Side:
    """Mean curve of one specimen at the strains of the axis."""
    cycles = curves.tangent_modulus_count[specimen]
    # for one cycle the uncertainty is that of a regression on its samples
    count = np.where(cycles > 1, cycles - 1.0, _MANY)
    series = (
        curves.tangent_modulus[specimen],
        curves.tangent_modulus_standard_uncertainty[specimen],
        np.where(np.isfinite(curves.tangent_modulus[specimen]), count, np.nan),
    )
    spacing = _spacing(curves)
    at = [
        np.stack([curve_at(strain, curves.strain_bin, row, spacing=spacing) for row in values])
        for values in series
    ]
    return _Side(name, *at)


def compare_curves(
    numerator: ModulusCurves,
    denominator: ModulusCurves,
    *,
    numerator_specimen: int,
    denominator_specimen: int,
    numerator_name: str,
    denominator_name: str,
) -> Ratio:
    r"""Ratio of the mean tangent moduli of two specimens, or of two tests.

    Parameters
    ----------
    numerator : ModulusCurves
        Curves of one test. [SI]
    denominator : ModulusCurves
        Curves of another test, or the same if one test holds both specimens. [SI]
    numerator_specimen : int
        Place of the specimen in the numerator. [1]
    denominator_specimen : int
        Place of the specimen in the denominator. [1]
    numerator_name : str
        Name of the numerator.
    denominator_name : str
        Name of the denominator.

    Returns
    -------
    ratio : Ratio
        On the coarser of the two grids, both branches, with its 95 % interval. [1]

    Raises
    ------
    DataError
        If a curve does not have one value per bin.

    Notes
    -----
    Printed source: sec. 4.6 of [1]_ compares new and used tethers at equal strain.

    The interval is :math:`r \pm t_{95}(\nu)\,u(r)` with u from the type A uncertainties
    of both, taken as independent, and :math:`\nu` after Welch and Satterthwaite ([3]_).
    It applies to a single strain: of a hundred bins of equal curves five are outside. Where one
    of the two has no modulus, the ratio is NaN and ``is_different`` False; a note says
    if that is so at every strain.

    Examples
    --------
    Ten cycles each; 11 and 10 MPa, both known to 1 %:

    >>> import numpy as np
    >>> modulus = np.array([11e6, 10e6])[:, None, None] * np.ones((2, 2, 3))
    >>> x = np.array([1.0, 1.1, 1.2])
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((2, 2, 3)))
    >>> curves = ModulusCurves(**blank | {
    ...     "strain_bin": x, "strain_bin_bounds": np.stack([x - 0.05, x + 0.05], axis=1),
    ...     "tangent_modulus": modulus, "tangent_modulus_count": np.full((2, 2, 3), 10),
    ...     "tangent_modulus_standard_uncertainty": 0.01 * modulus,
    ... })
    >>> ratio = compare_curves(
    ...     curves, curves, numerator_specimen=0, denominator_specimen=1,
    ...     numerator_name="new", denominator_name="used",
    ... )
    >>> print(ratio.ratio[0, 0].round(3), ratio.ratio_low[0, 0].round(3))
    1.1 1.067
    """
    axis = max((numerator, denominator), key=_spacing).strain_bin
    above = _side(numerator, numerator_specimen, numerator_name, axis)
    below = _side(denominator, denominator_specimen, denominator_name, axis)
    return _ratio(axis, above, below)


def compare_cycles(
    curves: ModulusCurves,
    *,
    specimen: int,
    numerator_cycles: Sequence[int],
    denominator_cycles: Sequence[int],
) -> Ratio:
    r"""Ratio of the mean curves of two sets of cycles, such as the last and the first.

    Parameters
    ----------
    curves : ModulusCurves
        With the curves of selected cycles. [SI]
    specimen : int
        Place of the specimen in the curves. [1]
    numerator_cycles : sequence of int
        Cycle numbers, all among ``selected_cycle``. [1]
    denominator_cycles : sequence of int
        The same for the denominator. [1]

    Returns
    -------
    ratio : Ratio
        On the grid of the curves, both branches, with its 95 % interval. [1]

    Raises
    ------
    DataError
        If a set is empty or names a cycle whose curve was not kept.

    Notes
    -----
    Printed source: sec. 4.7 of [1]_ compares the last cycles of the extended test with the
    first. The uncertainty of each mean is that of the regressions of its cycles (type A).

    Examples
    --------
    A modulus that halves from cycle 1 to cycle 3:

    >>> import numpy as np
    >>> by_cycle = np.array([2.0, 1.5, 1.0])[None, :, None, None] * np.ones((1, 3, 2, 1))
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((1, 2, 1)))
    >>> curves = ModulusCurves(**blank | {
    ...     "selected_cycle": np.array([1, 2, 3]), "tangent_modulus_by_cycle": by_cycle,
    ...     "tangent_modulus_by_cycle_standard_uncertainty": 0.01 * by_cycle,
    ... })
    >>> ratio = compare_cycles(
    ...     curves, specimen=0, numerator_cycles=[3], denominator_cycles=[1]
    ... )
    >>> print(ratio.ratio[0], ratio.ratio_low[0].round(4), ratio.is_different[0])
    [0.5] [0.4861] [ True]
    """
    sides = []
    for chosen in (numerator_cycles, denominator_cycles):
        kept = np.isin(curves.selected_cycle, chosen)
        if len(chosen) == 0 or np.count_nonzero(kept) < len(set(chosen)):
            raise DataError(
                "a cycle to compare has no curve of its own",
                found=", ".join(str(number) for number in chosen) or "no cycle",
                needed="cycles among " + ", ".join(str(n) for n in curves.selected_cycle),
            )
        modulus = curves.tangent_modulus_by_cycle[specimen, kept].mean(axis=0)
        variance = curves.tangent_modulus_by_cycle_standard_uncertainty[specimen, kept] ** 2
        uncertainty = np.sqrt(variance.sum(axis=0)) / len(set(chosen))
        name = "cycles " + ", ".join(str(number) for number in sorted(set(chosen)))
        sides.append(_Side(name, modulus, uncertainty, np.full(modulus.shape, np.inf)))
    above, below = sides
    return _ratio(curves.strain_bin, above, below)


FEWEST_CYCLES = 3


def _trend_of(values: Floats, start: int, *, cycles: Cycles | None) -> tuple[Floats, Floats]:
    """Slope per decade from a cycle on, with the uncertainty from cycles in gaps of the log."""
    logged = np.arange(start + 1, values.shape[1] + 1)
    number = logged if cycles is None else cycles.number[start:]
    slope, uncertainty = slope_per_decade(values[:, start:], number=number)
    if cycles is not None and not cycles.is_count_sure:
        without, _ = slope_per_decade(values[:, start:], number=logged)
        uncertainty = np.hypot(uncertainty, (without - slope) / np.sqrt(3))
    return slope, uncertainty


def slope_per_decade(
    values: ArrayLike, *, number: ArrayLike | None = None
) -> tuple[Floats, Floats]:
    """Slope of per-cycle values against log10 of the cycle number.

    Notes
    -----
    All cycles have equal weight in the logarithm: each is weighted by the inverse of its
    number, so that the last decade of a long test, which holds nine tenths of the cycles,
    does not dominate.

    Examples
    --------
    >>> slope, _ = slope_per_decade([700 - 20 * np.log10(np.arange(1, 101))])
    >>> print(slope.round(6))
    [-20.]
    """
    series = np.atleast_2d(np.asarray(values, dtype=np.float64))
    number = np.arange(1, series.shape[1] + 1) if number is None else np.asarray(number)
    if number.size and not number.min() >= 1:
        raise DataError("cycles count from 1", found=str(number.min()))
    slope, uncertainty = np.full((2, series.shape[0]), np.nan)
    for row, one in enumerate(series):
        known = np.isfinite(one)
        if known.sum() < FEWEST_CYCLES:
            continue
        x, y = np.log10(number[known]), one[known]
        share = 1 / number[known]
        share /= share.sum()
        # sums, not dot products: those start threads of their own and depend on their number
        x = x - (share * x).sum()
        y = y - (share * y).sum()
        power = (share * x * x).sum()
        slope[row] = (share * x * y).sum() / power
        residual = y - slope[row] * x
        # Sandwich form: the weights even out the decades and do not imply different noise.
        freedom = y.size - 2
        variance = (residual**2).sum() / freedom * ((share * x) ** 2).sum() / power**2
        uncertainty[row] = np.sqrt(variance * lag_one_inflation(residual))
    return slope, uncertainty


def cycles_at_an_end(n_cycles: int) -> int:
    """Return the number of cycles compared at each end of a test: a tenth, from one to ten.

    Examples
    --------
    >>> [cycles_at_an_end(number) for number in (5, 30, 3000)]
    [1, 3, 10]
    """
    return min(max(n_cycles // 10, 1), 10)


_LATER = 10  # cycles after which the slope of creep is fitted again, to test its linearity

_SETTLING = 2  # first cycles, in which a specimen still follows the ramp to its mean load


def first_of_trend(n_cycles: int, break_in_cycles: int, *, is_creep: bool = False) -> int:
    """Return the number of first cycles left out of a slope per decade; creep also settles.

    Examples
    --------
    >>> first_of_trend(100, 0), first_of_trend(100, 0, is_creep=True), first_of_trend(4, 3)
    (0, 2, 1)
    """
    first = max(break_in_cycles, _SETTLING) if is_creep else break_in_cycles
    return min(first, max(0, n_cycles - FEWEST_CYCLES))


def _means_at_ends(values: ArrayLike) -> tuple[Floats, Floats, Floats]:
    r"""Means of the first and of the last tenth of the cycles, and the scatter of such a mean.

    Notes
    -----
    .. math:: s^2 = \overline{(y_{i+1} - y_i)^2} / 2

    is the variance of a cycle, which a slow trend does not affect [5]_; a fast one at the start of
    a test does, and the uncertainty is then too large rather than too small.

    Examples
    --------
    Ten cycles whose neighbours differ by 1 N; each mean is of one cycle:

    >>> parts = _means_at_ends([[100, 98, 97, 96, 96, 95, 96, 95, 96, 95]])
    >>> print(*(part.round(2) for part in parts))
    [100.] [95.] [0.78]
    """
    series = np.atleast_2d(np.asarray(values, dtype=np.float64))
    n_ends = cycles_at_an_end(series.shape[1])
    steps = np.diff(series, axis=1)
    pairs = np.isfinite(steps).sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        variance = np.nansum(steps**2, axis=1) / np.where(pairs < FEWEST_CYCLES - 1, np.nan, pairs)
        scatter = np.sqrt(variance / 2 / n_ends)
    return series[:, :n_ends].mean(axis=1), series[:, -n_ends:].mean(axis=1), scatter


def _change_of_ends(values: ArrayLike, drift: ArrayLike = 0.0) -> tuple[Floats, Floats]:
    """Relative change of the mean of the last tenth of the cycles from that of the first.

    ``drift`` is the standard uncertainty of a change of their zero, in the unit of the values.

    Examples
    --------
    Ten cycles that lose 5 %, and whose neighbours differ by 1 N:

    >>> change, uncertainty = _change_of_ends([[100, 98, 97, 96, 96, 95, 96, 95, 96, 95]])
    >>> print(change.round(3), uncertainty.round(3))
    [-0.05] [0.011]
    """
    first, last, scatter = _means_at_ends(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        spread = np.hypot(scatter * np.hypot(1.0, last / first), drift) / np.abs(first)
        return last / first - 1, spread


def slip_of_turns(frequency: Floats, step: float, n_cycles: int) -> float:
    """Share of the missed parts of its turns by which a log out of step with them may drift.

    Turns that pass half of a sampling interval go from a reading to the middle of two.  Those that
    pass whole intervals within the tenth of the cycles at either end are as good as even there.

    Examples
    --------
    A hundred cycles with a reading every 0.1 s, in step, nearly so and far from it:

    >>> [round(slip_of_turns(np.array([0.25]), step, 100), 2) for step in (0.1, 0.09998, 0.0997)]
    [0.0, 0.99, 0.16]
    """
    period = 1 / float(np.mean(frequency))
    readings = period / step
    at_end = turns_alike(
        np.array([np.inf]), step, period=period, n_cycles=cycles_at_an_end(n_cycles)
    )
    slip = min(1.0, 2 * n_cycles * abs(readings - round(readings)))
    return slip * float(np.sqrt(1.5 * (1 - at_end[0])))


def _unseen_in_steps(loops: Loops, name: str) -> Floats:
    """Part of the uncertainty of single cycles that the steps from cycle to cycle do not show.

    A log nearly in step with the machine misses a little more, or less, of each turn than of the
    one before: its extremes drift as those of a specimen do.

    Examples
    --------
    >>> peak = np.linspace(100, 98, 50)[None]
    >>> loops = Loops(*[peak] * 21, uncertainty={"peak_tension": 0 * peak + 1.0})
    >>> print(_unseen_in_steps(loops, "peak_tension").round(2))
    [1.]
    """
    values = np.atleast_2d(getattr(loops, name))
    own = np.atleast_2d(loops.uncertainty.get(name, np.zeros(values.shape)))
    steps = np.diff(values, axis=1, append=values[:, -1:])
    hidden = np.nan_to_num(own) ** 2 - np.nan_to_num(steps) ** 2 / 2
    return np.asarray(np.sqrt(np.fmax(hidden.mean(axis=1), 0.0)))


def fit_peak_trend(
    loops: Loops,
    *,
    area: ArrayLike,
    break_in_cycles: int = 0,
    cycles: Cycles | None = None,
    of_zero: ArrayLike = 0.0,
    of_turns: float = 0.0,
) -> PeakTrend:
    """Decay of the peak and change of the dynamic modulus over the cycles of a test.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    area : array_like, shape (n_specimens,)
        Cross-section at zero tension; NaN where no diameter is known. [m2]
    break_in_cycles : int, optional
        Cycles left out of the slopes at the start. [1]
    cycles : Cycles, optional
        With their numbers, where the log lacks some; by default 1, 2, 3, ...
    of_zero : array_like, shape (n_specimens,), optional
        Standard uncertainty of the change of the zero of the load cell over the cycles. [N]
    of_turns : float, optional
        Share of the missed parts of the turns that may drift (`slip_of_turns`). [1]

    Returns
    -------
    trend : PeakTrend
        Slopes per decade of cycles with standard uncertainties (type A), relative change of the
        peak from the first to the last cycles, and change of the mean strain. [N], [Pa], [1]

    Raises
    ------
    DataError
        If an area is not positive.

    Notes
    -----
    Source: [1]_, sec. 4.1 ("the maximum peak can be seen to still decreasing with time");
    the straight line in the logarithm is from [4]_.  The dynamic modulus is the apparent spring
    constant over the area.  The changes from the first to the last cycles are those of a tenth of
    the cycles each, counted from the first cycle whatever the break-in.  The slope of the mean
    strain is the creep of a rope in load control.  It begins with the third cycle: in the first
    two a specimen still follows the ramp to its mean load, and with the weights of
    `slope_per_decade` they would dominate it.  Creep need not be a line in the logarithm: half
    of the difference from the slope from the eleventh cycle on is in its uncertainty.

    Examples
    --------
    >>> peak = 700 - 20 * np.log10(np.arange(1.0, 11.0))[None]
    >>> loops = Loops(*[peak] * 21, uncertainty={})
    >>> trend = fit_peak_trend(loops, area=[5e-4])
    >>> print(trend.peak_tension_per_decade.round(3), trend.peak_tension_change.round(4))
    [-20.] [-0.0286]
    """
    peaks = np.atleast_2d(loops.peak_tension)
    areas = np.atleast_1d(np.asarray(area, dtype=np.float64))
    as_positive("area", areas[np.isfinite(areas)])
    start = first_of_trend(peaks.shape[1], break_in_cycles)
    settled = first_of_trend(peaks.shape[1], break_in_cycles, is_creep=True)
    modulus = np.atleast_2d(loops.apparent_spring_constant) / areas[:, None]
    strain = np.atleast_2d(loops.mean_strain)
    slope_of = partial(_trend_of, cycles=cycles)
    peak_slope, peak_uncertainty = slope_of(peaks, start)
    modulus_slope, modulus_uncertainty = slope_of(modulus, start)
    strain_slope, strain_uncertainty = slope_of(strain, settled)
    if strain.shape[1] >= 2 * _LATER:
        later, _ = slope_of(strain, _LATER)
        strain_uncertainty = np.hypot(strain_uncertainty, (later - strain_slope) / 2)
    of_peaks, of_modulus, of_strain = (
        np.sqrt(2) * of_turns * _unseen_in_steps(loops, name) if of_turns else 0.0
        for name in ("peak_tension", "apparent_spring_constant", "mean_strain")
    )
    drift = np.hypot(np.asarray(of_zero, dtype=np.float64), of_peaks)
    change, change_uncertainty = _change_of_ends(peaks, drift)
    # an even drift is mostly in the last decade
    decades = max(float(np.log10(peaks.shape[1])), 1.0)
    peak_uncertainty = np.hypot(peak_uncertainty, drift / decades)
    modulus_uncertainty = np.hypot(modulus_uncertainty, of_modulus / areas / decades)
    strain_uncertainty = np.hypot(strain_uncertainty, of_strain / decades)
    first_strain, last_strain, strain_scatter = _means_at_ends(strain)
    return PeakTrend(
        peak_tension_per_decade=peak_slope,
        peak_tension_per_decade_standard_uncertainty=peak_uncertainty,
        dynamic_modulus_per_decade=modulus_slope,
        dynamic_modulus_per_decade_standard_uncertainty=modulus_uncertainty,
        peak_tension_change=change,
        peak_tension_change_standard_uncertainty=change_uncertainty,
        mean_strain_per_decade=strain_slope,
        mean_strain_per_decade_standard_uncertainty=strain_uncertainty,
        mean_strain_drift=last_strain - first_strain,
        mean_strain_drift_standard_uncertainty=np.hypot(np.sqrt(2) * strain_scatter, of_strain),
    )

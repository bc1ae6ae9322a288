"""Programmes of a rope laboratory, from loops: bedding-in and dynamic stiffness.

Each number also stands divided by the rated break strength.  What a programme asks for
(levels, numbers of cycles) is the laboratory's; nothing here is taken from a standard.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 (break-in and levels).
.. [2] J. F. Flory and V. Ahjem, "Measuring and Calculating the Six Change-in-Length
   Properties of Fibre Rope," OIPEEC (abstract: original, static and dynamic stiffness,
   construction, polymer and working strain, by a programme of many steps).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.cycles.product import Loops
from reduction.errors import DataError, SettingsError
from reduction.line.strength import mean_of_rows, one_a_specimen
from reduction.moduli.separable import lag_one_inflation
from reduction.record import Floats, Integers, read_only_arrays

_FEWEST_CYCLES = 3


@dataclass(frozen=True)
@read_only_arrays
class BeddingIn:
    """How a new rope settles over its first cycles; arrays have shape (n_specimens,).

    Parameters
    ----------
    first_stiffness, last_stiffness : ndarray
        Secant of the first and of the last cycle, force per unit strain. [N]
    first_stiffness_standard_uncertainty, last_stiffness_standard_uncertainty : ndarray
        [N]
    first_stiffness_over_strength, last_stiffness_over_strength : ndarray
        Over the rated break strength. [1]
    stiffening : ndarray
        Last over first stiffness. [1]
    permanent_strain, permanent_strain_standard_uncertainty : ndarray
        By which the foot of the loop moved, at equal tension. [1]
    n_cycles : int
        Cycles in the table.
    """

    first_stiffness: Floats
    first_stiffness_standard_uncertainty: Floats
    last_stiffness: Floats
    last_stiffness_standard_uncertainty: Floats
    first_stiffness_over_strength: Floats
    last_stiffness_over_strength: Floats
    stiffening: Floats
    permanent_strain: Floats
    permanent_strain_standard_uncertainty: Floats
    n_cycles: int


@dataclass(frozen=True)
@read_only_arrays
class DynamicStiffness:
    """Stiffness over the last cycles of each level; arrays have shape (n_specimens, n_levels).

    Parameters
    ----------
    level : ndarray of int, shape (n_levels,)
        Labels, in the order of the cycles.
    n_cycles : ndarray of int
        Cycles that were used.
    dynamic_stiffness, dynamic_stiffness_standard_uncertainty : ndarray
        Mean apparent spring constant, and its standard error with the likeness of
        neighbouring cycles (type A); NaN below three cycles. [N]
    drift_per_cycle, drift_per_cycle_standard_uncertainty : ndarray
        Slope of the stiffness against the cycle over the same cycles. [N]
    frequency, mean_tension, tension_amplitude : ndarray
        Means over the same cycles, each with its standard error as that of the stiffness in
        ``..._standard_uncertainty``. [Hz], [N], [N]
    dynamic_stiffness_over_strength, dynamic_stiffness_over_strength_standard_uncertainty : ndarray
        Over the rated break strength, which counts as exact. [1]
    mean_tension_over_strength, tension_amplitude_over_strength : ndarray
        [1]
    notes : tuple of str
        Levels with fewer cycles than asked for.
    """

    level: Integers
    n_cycles: Integers
    dynamic_stiffness: Floats
    dynamic_stiffness_standard_uncertainty: Floats
    drift_per_cycle: Floats
    drift_per_cycle_standard_uncertainty: Floats
    frequency: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    dynamic_stiffness_over_strength: Floats
    dynamic_stiffness_over_strength_standard_uncertainty: Floats
    mean_tension_over_strength: Floats
    tension_amplitude_over_strength: Floats
    frequency_standard_uncertainty: Floats
    mean_tension_standard_uncertainty: Floats
    tension_amplitude_standard_uncertainty: Floats
    notes: tuple[str, ...] = ()


def summarise_bedding_in(loops: Loops, *, rated_break_strength: ArrayLike) -> BeddingIn:
    r"""First and last secant of bedding-in cycles, and the permanent elongation.

    .. math:: \varepsilon_p = (\varepsilon_{v,n} - \varepsilon_{v,1})
              - (T_{v,n} - T_{v,1}) / K_{ap,n}

    Parameters
    ----------
    loops : Loops
        Table of the bedding-in cycles.
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]

    Returns
    -------
    bedding : BeddingIn
        Stiffness, permanent strain and their uncertainties.

    Raises
    ------
    DataError
        If there are fewer than two cycles, or a strength is not positive.

    Notes
    -----
    The permanent strain is between the feet (v) of the first and the last loop, brought to
    one tension along the last secant; the elongation of the first rise, before the first
    valley, is not in it.  [1]_ leaves break-in cycles out and prints none.

    Examples
    --------
    >>> one = {name: np.full((1, 2), 100.0) for name in Loops.__dataclass_fields__}
    >>> one |= dict(mean_strain=np.array([[0.10, 0.13]]), strain_amplitude=np.full((1, 2), 0.02),
    ...     apparent_spring_constant=np.array([[800.0, 1000.0]]), uncertainty=one.copy())
    >>> bedding = summarise_bedding_in(Loops(**one), rated_break_strength=500.0)
    >>> print(bedding.permanent_strain.round(3), bedding.stiffening)
    [0.03] [1.25]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if n_cycles < 2:
        raise DataError("bedding-in needs two cycles", found=str(n_cycles), needed="2 or more")
    strength = one_a_specimen(rated_break_strength, n_specimens)
    secant = loops.apparent_spring_constant[:, [0, -1]]
    u_secant = loops.uncertainty["apparent_spring_constant"][:, [0, -1]]
    foot = (loops.mean_strain - loops.strain_amplitude)[:, [0, -1]]
    u_foot = np.hypot(loops.uncertainty["mean_strain"], loops.uncertainty["strain_amplitude"])
    valley = loops.valley_tension[:, [0, -1]]
    u_valley = loops.uncertainty["valley_tension"][:, [0, -1]]
    variance = (u_foot[:, [0, -1]] ** 2 + (u_valley / secant[:, 1:]) ** 2).sum(axis=1)
    return BeddingIn(
        first_stiffness=secant[:, 0],
        first_stiffness_standard_uncertainty=u_secant[:, 0],
        last_stiffness=secant[:, 1],
        last_stiffness_standard_uncertainty=u_secant[:, 1],
        first_stiffness_over_strength=secant[:, 0] / strength,
        last_stiffness_over_strength=secant[:, 1] / strength,
        stiffening=secant[:, 1] / secant[:, 0],
        permanent_strain=foot[:, 1] - foot[:, 0] - (valley[:, 1] - valley[:, 0]) / secant[:, 1],
        permanent_strain_standard_uncertainty=np.sqrt(variance),
        n_cycles=n_cycles,
    )


def _mean_and_drift(series: Floats) -> tuple[float, float, float, float]:
    """Mean and slope a cycle of one series, each with its standard uncertainty."""
    at = np.flatnonzero(np.isfinite(series)).astype(np.float64)
    values = series[np.isfinite(series)]
    mean = float(values.mean()) if values.size else np.nan
    if values.size < _FEWEST_CYCLES:
        return mean, np.nan, np.nan, np.nan
    own = values - mean
    at -= at.mean()
    # sums, not dot products, whose last digits depend on the number of threads
    power = float((at * at).sum())
    slope = float((at * own).sum()) / power
    error = np.sqrt((own * own).sum() / (own.size - 1) / own.size * lag_one_inflation(own))
    left = own - slope * at
    scatter = (left * left).sum() / (own.size - 2) / power * lag_one_inflation(left)
    return mean, float(error), slope, float(np.sqrt(scatter))


def dynamic_stiffness(
    loops: Loops,
    *,
    last_cycles: int,
    rated_break_strength: ArrayLike,
    level: ArrayLike | None = None,
) -> DynamicStiffness:
    """Dynamic stiffness over the last cycles of each level of a programme.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    last_cycles : int
        Cycles at the end of each level that count. [1]
    rated_break_strength : array_like, shape (n_specimens,)
        NaN where not stated. [N]
    level : array_like of int, shape (n_cycles,), optional
        Level of each cycle; left out, all cycles are one level. [1]

    Returns
    -------
    stiffness : DynamicStiffness
        Mean, standard error and drift of the apparent spring constant, and the levels.

    Raises
    ------
    SettingsError
        If no cycle is asked for.
    DataError
        If the levels do not fit the cycles, or a strength is not positive.

    Notes
    -----
    A drift that is large against its uncertainty says that the level has not settled; the
    standard error then holds the drift too.  The dynamic stiffness is K_ap of [1]_, force
    per unit strain, which the field calls dynamic EA.

    Examples
    --------
    >>> one = {name: np.full((1, 4), 1.0) for name in Loops.__dataclass_fields__}
    >>> one["apparent_spring_constant"] = np.array([[500.0, 99.0, 100.0, 101.0]])
    >>> found = dynamic_stiffness(Loops(**one), last_cycles=3, rated_break_strength=10.0)
    >>> print(found.dynamic_stiffness, found.drift_per_cycle, found.dynamic_stiffness_over_strength)
    [[100.]] [[1.]] [[10.]]
    """
    n_specimens, n_cycles = loops.frequency.shape
    if last_cycles < 1:
        raise SettingsError(
            "no cycle counts towards the stiffness", found=str(last_cycles), needed="1 or more"
        )
    labels = np.zeros(n_cycles, dtype=np.int64) if level is None else np.asarray(level)
    if labels.shape != (n_cycles,):
        raise DataError(
            "levels do not fit the cycles", found=str(labels.shape), needed=f"({n_cycles},)"
        )
    strength = one_a_specimen(rated_break_strength, n_specimens)[:, None]
    names, begins = np.unique(labels, return_index=True)
    names = names[np.argsort(begins)]
    notes = []
    numbers = np.full((4, n_specimens, names.size), np.nan)
    used = np.zeros((n_specimens, names.size), dtype=np.int64)
    means, errors = np.full((2, 3, n_specimens, names.size), np.nan)
    for column, name in enumerate(names):
        cycles = np.flatnonzero(labels == name)
        if cycles.size < last_cycles:
            notes.append(f"level {name} has {cycles.size} of the {last_cycles} cycles asked for")
        cycles = cycles[-last_cycles:]
        series = loops.apparent_spring_constant[:, cycles]
        used[:, column] = np.isfinite(series).sum(axis=1)
        numbers[:, :, column] = np.array([_mean_and_drift(row) for row in series]).T
        for row, quantity in enumerate(("frequency", "mean_tension", "tension_amplitude")):
            values = getattr(loops, quantity)[:, cycles]
            means[row, :, column] = mean_of_rows(values)
            errors[row, :, column] = [_mean_and_drift(one)[1] for one in values]
    return DynamicStiffness(
        level=names,
        n_cycles=used,
        dynamic_stiffness=numbers[0],
        dynamic_stiffness_standard_uncertainty=numbers[1],
        drift_per_cycle=numbers[2],
        drift_per_cycle_standard_uncertainty=numbers[3],
        frequency=means[0],
        mean_tension=means[1],
        tension_amplitude=means[2],
        dynamic_stiffness_over_strength=numbers[0] / strength,
        dynamic_stiffness_over_strength_standard_uncertainty=numbers[1] / strength,
        mean_tension_over_strength=means[1] / strength,
        tension_amplitude_over_strength=means[2] / strength,
        frequency_standard_uncertainty=errors[0],
        mean_tension_standard_uncertainty=errors[1],
        tension_amplitude_standard_uncertainty=errors[2],
        notes=tuple(notes),
    )

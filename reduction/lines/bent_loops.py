"""K_0 of a cycle, for a line whose loops are as bent as its slow pull.

K_0 of a slow pull is its slope at one tension.  A large cycle covers a part of the pull: where the
loops of the runs are bent, their K_0 is the chord of the pull over the cycle
(`reduction.stages.three_parameter_line.loop_midline`).  The loops of a rope may be straight even if
its pull is bent.  At a point without a loop the K_0 of the runs decide, by their relative position
between slope and chord.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.lines.line_curve import evaluate_curve
from reduction.lines.lookup_product import DesignValues, LineCurve
from reduction.record.measurement import Floats
from reduction.record.settings import Control, Waveform
from reduction.stages.three_parameter_line.loop_midline import (
    is_bent,
    spring_of_cycle,
    spring_of_wave,
)

_FEWEST_RUNS = 3

_STRAIGHT = 1e-3  # share of K_0; the error between the points of a curve is smaller


class RunOfLine(NamedTuple):
    """A run with known K_0. [N], [N], [N], [J m-1], [N]."""

    mean_tension: float
    tension_amplitude: float
    apparent_spring_constant: float
    hysteresis_energy: float
    quasi_static_spring_constant: float


def chord_over_slope(
    curve: LineCurve,
    *,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    apparent_spring_constant: ArrayLike,
    hysteresis_energy: ArrayLike,
) -> Floats:
    """Chord of a slow pull over cycles, over its slope at their mean tension; 1 where not known.

    Examples
    --------
    T = 4e5 e + 6e6 e^2 and a lossless cycle from 11 to 29 kN with K_ap 1000 kN: strains of
    .009 about that of 19,514 N, where the slope is 792.7 kN, instead of 800 kN at 20 kN.

    >>> at = np.linspace(0, 4e4, 401)
    >>> curve = LineCurve("quasi_static_spring_constant", "mean_tension", 0, 4e4, at=at,
    ...     value=np.sqrt(16e10 + 24e6 * at))
    >>> print(chord_over_slope(curve, mean_tension=20e3, tension_amplitude=9e3,
    ...     apparent_spring_constant=1e6, hysteresis_energy=0.0).round(4))
    0.9908
    """
    mean, load, stiffness, energy = np.broadcast_arrays(
        *(
            np.asarray(one, dtype=np.float64)
            for one in (mean_tension, tension_amplitude, apparent_spring_constant,
                        hysteresis_energy)
        )
    )  # fmt: skip

    with np.errstate(invalid="ignore", divide="ignore"):
        half = _half_strain(load, stiffness, energy)
        chord = spring_of_cycle(_constant_at(curve), mean, half)
        ratio = chord / _constant_at(curve)(mean)
    return np.asarray(np.where(np.isfinite(ratio) & (ratio > 0), ratio, 1.0))


def _constant_at(curve: LineCurve) -> Callable[[Floats], Floats]:
    """K_0 at tensions; NaN beyond the pull. [N]."""

    def constant(tension: Floats) -> Floats:
        found = evaluate_curve(curve, tension)
        return np.asarray(np.where(found.is_inside, found.value, np.nan))

    return constant


def _half_strain(load: Floats, stiffness: Floats, energy: Floats) -> Floats:
    """Half the strain range between peak and valley of the tension. [1]."""
    sine = energy * stiffness / (np.pi * load**2)
    return np.asarray(load / stiffness * np.sqrt(1 - sine**2))


def constant_of_level(
    curve: LineCurve,
    cycle: RunOfLine,
    above_midline: float,
    standard_uncertainty: float,
    *,
    waveform: Waveform = "sinusoidal",
    control: Control = "load",
) -> RunOfLine:
    """A test at a level with K_0 of its loops, as in `quasi_static_of_run` for a run.

    NaN where the bend of the loops is not known.
    """
    constant_at = _constant_at(curve)
    mean, load, stiffness, energy = (np.asarray(one) for one in cycle[:4])
    found = np.nan
    if is_bent(above_midline, standard_uncertainty, cycle.tension_amplitude):
        found = spring_of_wave(
            constant_at, cycle.mean_tension, above_midline,
            float(_half_strain(load, stiffness, energy)), waveform=waveform, control=control,
        )  # fmt: skip
    elif np.isfinite(above_midline):
        found = float(constant_at(mean))
    return cycle._replace(quasi_static_spring_constant=found)


def with_bend_of_levels(curve: LineCurve, levels: Sequence[RunOfLine]) -> LineCurve:
    """K_0 over mean tension with the bend of the loops of single levels, all of them used.

    Where no bend is known, K_0 may be anywhere between slope and chord.
    """
    known = [one for one in levels if np.isfinite(one.quasi_static_spring_constant)]
    if known or not levels:
        return _with_bend(curve, np.array(known, dtype=np.float64))
    mean, load, stiffness, energy, _ = np.array(levels, dtype=np.float64).T
    bent = chord_over_slope(
        curve, mean_tension=mean, tension_amplitude=load, apparent_spring_constant=stiffness,
        hysteresis_energy=energy,
    ) - 1  # fmt: skip
    return replace(curve, loop_bend=0.5, loop_bend_misfit=float(np.abs(bent).max() / 12**0.5))


def with_bend_of_runs(curve: LineCurve, runs: Sequence[RunOfLine]) -> LineCurve:
    """K_0 over mean tension with the bend given by the K_0 of runs."""
    table = np.array(runs, dtype=np.float64).reshape(-1, len(RunOfLine._fields))
    table = table[np.isfinite(table).all(axis=1)]
    return _with_bend(curve, table) if len(table) >= _FEWEST_RUNS else curve


def _with_bend(curve: LineCurve, table: Floats) -> LineCurve:
    """The curve with the bend of runs, one per row; unchanged without runs."""
    if not len(table):
        return curve
    mean, load, stiffness, energy, own = table.T
    bent = chord_over_slope(
        curve, mean_tension=mean, tension_amplitude=load, apparent_spring_constant=stiffness,
        hysteresis_energy=energy,
    ) - 1  # fmt: skip
    of_runs = own / evaluate_curve(curve, mean).value - 1
    if min(np.max(np.abs(bent)), np.max(np.abs(of_runs))) < _STRAIGHT:
        return curve
    share = float(bent @ of_runs / (bent @ bent))
    misfit = float(np.sqrt(np.sum((of_runs - share * bent) ** 2) / max(len(table) - 1, 1)))
    return replace(curve, loop_bend=share, loop_bend_misfit=misfit)


def constant_of_cycles(
    curve: LineCurve,
    slope: DesignValues,
    *,
    mean_tension: ArrayLike,
    tension_amplitude: ArrayLike,
    apparent_spring_constant: ArrayLike,
    hysteresis_energy: ArrayLike,
) -> DesignValues:
    """K_0 of cycles, from the slope at their mean tension, with the same relative uncertainty.

    The misfit of the bend to the runs is added to the uncertainty.
    """
    if not curve.loop_bend:
        return slope
    ratio = share_of_slope(
        curve, mean_tension=mean_tension, tension_amplitude=tension_amplitude,
        apparent_spring_constant=apparent_spring_constant, hysteresis_energy=hysteresis_energy,
    )  # fmt: skip
    value = ratio * slope.value
    missed = curve.loop_bend_misfit * value
    random = slope.random_standard_uncertainty
    below, above = slope.value - slope.surface_low, slope.surface_high - slope.value
    said = (
        "the loops of the runs are bent as the slow pull is: K_0 is the chord of the pull over the "
        f"cycle, {100 * (float(ratio.flat[0]) - 1):+.2g} percent from its slope at the mean tension"
    )
    return replace(
        slope,
        value=value,
        surface_low=value - np.hypot(ratio * below, _NORMAL * missed),
        surface_high=value + np.hypot(ratio * above, _NORMAL * missed),
        random_standard_uncertainty=np.hypot(ratio * random, missed) if random.size else random,
        contribution=ratio * slope.contribution,
        notes=(*slope.notes, *([said] if ratio.size == 1 else [])),
    )


_NORMAL = 1.96


def share_of_slope(curve: LineCurve, **cycle: ArrayLike) -> Floats:
    """K_0 of cycles over the slope at their mean tension, by the bend of the runs."""
    return np.asarray(1 + curve.loop_bend * (chord_over_slope(curve, **cycle) - 1))

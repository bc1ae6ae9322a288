"""Parameters of the line from loops, cycle by cycle and per run.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 4.2 (type A) and C.3.4 (covariance).
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 (one K_ap and H a run) and 4.4.2
   (K_0 at the mean load of interest).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.errors import DataError
from reduction.record.measurement import Floats
from reduction.record.notes import Note, note
from reduction.stages.cycles.cycle_product import Loops
from reduction.stages.moduli.least_squares import lag_one_inflation
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    identify_by_amplitude,
    identify_by_fundamental,
    line_sensitivities,
)
from reduction.stages.three_parameter_line.line_product import LineParameters

_FEWEST_CYCLES = 3


def relative_deviations(
    loops: Loops, names: Sequence[str], *, break_in_cycles: int
) -> tuple[Floats, Floats]:
    """Means over the cycles that have every quantity, and deviations of each cycle from them.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    names : sequence of str, length n_inputs
        Quantities of the loops.
    break_in_cycles : int
        Cycles left out at the start. [1]

    Returns
    -------
    means : ndarray, shape (n_inputs, n_specimens)
        NaN where no cycle is complete. [of the quantity]
    deviations : ndarray, shape (n_inputs, n_specimens, n_cycles)
        Relative to the mean; NaN in cycles that lack a quantity. [1]

    Notes
    -----
    A cycle that lacks one quantity is left out of all, as required for type A of several quantities
    that are measured together ([1]_).

    Examples
    --------
    >>> one = {name: np.full((1, 3), 1.0) for name in Loops.__dataclass_fields__}
    >>> loops = Loops(**one | {"frequency": np.array([[5.0, 0.9, 1.1]]), "uncertainty": {}})
    >>> print(relative_deviations(loops, ["frequency"], break_in_cycles=1)[1].round(3))
    [[[-0.1  0.1]]]
    """
    cycles = np.stack([getattr(loops, name)[:, break_in_cycles:] for name in names])
    whole = np.isfinite(cycles).all(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = np.where(whole, cycles, 0.0).sum(axis=-1) / whole.sum(axis=-1)
        deviations = np.where(whole, cycles, np.nan) / means[..., None] - 1
    return means, deviations


def relative_shared(loops: Loops, names: Sequence[str], *, break_in_cycles: int) -> Floats:
    """Relative standard uncertainty common to the cycles of a run, shape (n_inputs, n_specimens).

    Examples
    --------
    Loops whose corners between two readings may miss a tenth of the energy:

    >>> one = {name: np.full((1, 3), 1.0) for name in Loops.__dataclass_fields__}
    >>> loops = Loops(**one | {"energy_turn_missed": np.full((1, 3), 0.1), "uncertainty": {}})
    >>> print(relative_shared(loops, ["hysteresis_energy"], break_in_cycles=0).round(4))
    [[0.1]]
    """
    shared = loops.shared_by_cycles(slice(break_in_cycles, None))
    means, _ = relative_deviations(loops, names, break_in_cycles=break_in_cycles)
    return np.abs(np.stack([shared.get(name, 0.0 * means[0]) for name in names]) / means)


def covariance_of_means(deviations: Floats) -> tuple[Floats, Floats]:
    """Relative covariance of the means over the cycles, with neighbouring cycles correlated.

    Parameters
    ----------
    deviations : ndarray, shape (n_inputs, n_specimens, n_cycles)
        From `relative_deviations`. [1]

    Returns
    -------
    covariance : ndarray, shape (n_specimens, n_inputs, n_inputs)
        NaN where there are fewer than three cycles. [1]
    degrees_of_freedom : ndarray, shape (n_specimens,)
        Cycles less one. [1]

    Notes
    -----
    [1]_.  The correlation of neighbours in each quantity widens its row and column, so that the
    matrix remains a covariance.

    Examples
    --------
    >>> covariance, freedom = covariance_of_means(np.array([[[-0.1, 0.1, -0.1, 0.1]]]))
    >>> print(covariance.round(5), freedom)
    [[[0.00333]]] [3.]
    """
    n_inputs, n_specimens, _ = deviations.shape
    covariance = np.full((n_specimens, n_inputs, n_inputs), np.nan)
    freedom = np.zeros(n_specimens)
    for place in range(n_specimens):
        kept = deviations[:, place, np.isfinite(deviations[:, place]).all(axis=0)]
        freedom[place] = max(kept.shape[1] - 1, 0)
        if kept.shape[1] < _FEWEST_CYCLES:
            continue
        kept = kept - kept.mean(axis=1, keepdims=True)
        widened = kept * np.sqrt([[lag_one_inflation(row)] for row in kept])
        # sums, not dot products, whose last digits depend on the number of threads
        products = (widened[:, None] * widened[None]).sum(axis=-1)
        covariance[place] = products / (kept.shape[1] - 1) / kept.shape[1]
    return covariance, freedom


Reading = Literal["amplitude", "fundamental"]

# E'' from H and amplitudes over E'' of the fundamental: 1 for an ellipse, 0.66 for a triangle
_NOT_AN_ELLIPSE = 0.1

# relative uncertainty of E' - K_0 beyond which linear propagation is unreliable
_SKEWED = 0.3

# a line goes slack where the valley is below this fraction of the peak
_SLACK_SHARE = 0.01


def _quasi_static_part(loops: Loops, name: str, values: ArrayLike) -> Floats:
    """One value per specimen, or per specimen and cycle, as an array that broadcasts."""
    array = np.asarray(values, dtype=np.float64)
    shape = loops.frequency.shape
    if array.shape == shape[:1] and array.ndim == 1:
        return array[:, None]
    if array.shape == shape:
        return array
    raise DataError(
        f"{name} does not fit the loops",
        found=f"shape {array.shape}",
        needed=f"({shape[0]},) or {shape}",
    )


def _amplitude_correlation(loops: Loops) -> Floats:
    """Correlation of the errors of K_ap and tension amplitude.

    K_ap is the ratio of the amplitudes a and b, so that with relative variances the
    covariance of ln K_ap and ln a is (v_a - v_b + v_K)/2, whatever the correlation of a and b.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        of_tension, of_strain, of_ratio = (
            (loops.uncertainty[name] / getattr(loops, name)) ** 2
            for name in ("tension_amplitude", "strain_amplitude", "apparent_spring_constant")
        )
        shared = (of_tension - of_strain + of_ratio) / 2
        correlation: Floats = np.clip(shared / np.sqrt(of_tension * of_ratio), -1, 1)
    return np.nan_to_num(correlation)


def _remarks(loops: Loops, line: LineParameters, break_in_cycles: int = 0) -> tuple[Note, ...]:
    """Features of the loops that are unusual for a line of three parameters."""
    remarks = list(line.notes)
    known = line.reason == 0
    if line.reading == "amplitude" and known.any():
        own = np.broadcast_to(line.loss_spring_constant, known.shape)[known]
        # a single line for a run is compared with the mean of the cycles from which it was made
        lost = loops.loss_over_time
        if lost.shape != known.shape:
            lost = np.nanmean(lost[:, break_in_cycles:], axis=1)
        ratio = float(np.nanmedian(own / lost[known]))
        if abs(ratio - 1) > _NOT_AN_ELLIPSE:
            remarks.append(note("loops-no-ellipses", ratio=ratio))
    with np.errstate(invalid="ignore"):
        relative = line.shared_uncertainty["dissipation_spring_constant"]
        skewed = relative > _SKEWED * line.dissipation_spring_constant
    if skewed.any():
        n_skewed = int(skewed.sum())
        remarks.append(
            note("line-uncertainty-skewed", n_skewed=n_skewed, n_lines=skewed.size, limit=_SKEWED)
        )
    slack = loops.valley_tension <= _SLACK_SHARE * loops.peak_tension
    if slack.any():
        n_slack = int(slack.sum())
        remarks.append(note("line-slack-in-loops", n_slack=n_slack, n_loops=slack.size))
    return tuple(remarks)


def identify_cycles(
    loops: Loops,
    *,
    quasi_static_spring_constant: ArrayLike,
    quasi_static_standard_uncertainty: ArrayLike,
    reading: Reading = "amplitude",
) -> LineParameters:
    """Parameters of the line in every cycle of a run.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    quasi_static_spring_constant : array_like, shape (n_specimens,) or (n_specimens, n_cycles)
        K_0 at the mean tension of the run (`reduction.stages.three_parameter_line.slow_pull`);
        NaN without a pull. [N]
    quasi_static_standard_uncertainty : array_like, same shape
        Its standard uncertainty, which the cycles share. [N]
    reading : {"amplitude", "fundamental"}
        From K_ap and H of the loop, as in [2]_, or from E' and E'' of its fundamental, as
        needed for cycles that are not sinusoidal. [-]

    Returns
    -------
    parameters : LineParameters
        Shape (n_specimens, n_cycles). [N], [s], [N s]

    Raises
    ------
    DataError
        If K_0 does not fit the loops.

    Notes
    -----
    Source: [2]_, sec. 4.3.  The uncertainty of a cycle is its own noise only; for results of a run
    see `identify_run`.

    Examples
    --------
    >>> one = {name: np.full((1, 2), 1.0) for name in Loops.__dataclass_fields__}
    >>> one |= dict(storage_spring_constant=np.full((1, 2), 2.7), uncertainty=one.copy(),
    ...     loss_spring_constant=np.full((1, 2), 0.6), frequency=np.full((1, 2), 0.3))
    >>> line = identify_cycles(Loops(**one), quasi_static_spring_constant=[1.2],
    ...     quasi_static_standard_uncertainty=[0.1], reading="fundamental")
    >>> print(line.relaxation_time.round(3))
    [[1.326 1.326]]
    """
    rest = _quasi_static_part(
        loops, "the quasi-static spring constant", quasi_static_spring_constant
    )
    names = FUNDAMENTAL_INPUTS if reading == "fundamental" else AMPLITUDE_INPUTS
    values = {name: getattr(loops, name) for name in names[:-1]}
    stated = {name: loops.uncertainty[name] for name in names[:-1]}
    stated[names[-1]] = _quasi_static_part(
        loops, "the uncertainty of the quasi-static one", quasi_static_standard_uncertainty
    )
    if reading == "fundamental":
        line = identify_by_fundamental(
            **values, quasi_static_spring_constant=rest, standard_uncertainty=stated
        )
    else:
        line = identify_by_amplitude(
            **values,
            quasi_static_spring_constant=rest,
            standard_uncertainty=stated,
            correlation=_amplitude_correlation(loops),
        )
    return replace(line, notes=_remarks(loops, line))


def _scatter(deviations: Floats) -> Floats:
    """Standard uncertainty of the mean of each row, with neighbouring cycles correlated."""
    result = np.full(deviations.shape[0], np.nan)
    for row, series in enumerate(deviations):
        kept = series[np.isfinite(series)]
        if kept.size >= _FEWEST_CYCLES:
            kept = kept - kept.mean()
            # sums, not dot products, whose last digits depend on the number of threads
            variance = float((kept**2).sum()) / (kept.size - 1) / kept.size
            result[row] = np.sqrt(variance * lag_one_inflation(kept))
    return result


def identify_run(
    loops: Loops,
    *,
    quasi_static_spring_constant: ArrayLike,
    quasi_static_standard_uncertainty: ArrayLike,
    reading: Reading = "amplitude",
    break_in_cycles: int = 0,
) -> LineParameters:
    """Parameters of the line of each specimen, from the means over the cycles of a run.

    Parameters
    ----------
    loops : Loops
        Table of loops.
    quasi_static_spring_constant : array_like, shape (n_specimens,)
        K_0 at the mean tension of the run (`reduction.stages.three_parameter_line.slow_pull`);
        NaN without a pull. [N]
    quasi_static_standard_uncertainty : array_like, shape (n_specimens,)
        Its standard uncertainty. [N]
    reading : {"amplitude", "fundamental"}
        From K_ap and H of the loop, as in [2]_, or from E' and E'' of its fundamental. [-]
    break_in_cycles : int, optional
        Cycles left out at the start. [1]

    Returns
    -------
    parameters : LineParameters
        Shape (n_specimens,). [N], [s], [N s]

    Raises
    ------
    DataError
        If the break-in leaves no cycle.

    Notes
    -----
    Source: [2]_, sec. 4.3: one K_ap and H per run, then K_1 and tau.  Means are used, so that a
    cycle whose noise hides K_1 is not left out of one side of the distribution.  The
    random part is from the scatter of the cycles, propagated by the sensitivities at the mean
    and so with all correlations between K_ap, H and amplitude, and widened by the correlation
    of neighbouring cycles (type A); it needs three cycles.  Errors common to the loops
    (`Loops.shared_by_cycles`) are added; the part of K_0 is as large as for one cycle.

    Examples
    --------
    >>> one = {name: np.full((1, 4), 1.0) for name in Loops.__dataclass_fields__}
    >>> one |= dict(storage_spring_constant=np.array([[9.0, 2.6, 2.8, 2.7]]), uncertainty={},
    ...     loss_spring_constant=np.full((1, 4), 0.6), frequency=np.full((1, 4), 0.3))
    >>> line = identify_run(Loops(**one), quasi_static_spring_constant=[1.2], break_in_cycles=1,
    ...     quasi_static_standard_uncertainty=[0.1], reading="fundamental")
    >>> print(line.relaxation_time.round(3))
    [1.326]
    """
    n_cycles = loops.frequency.shape[1]
    rest, u_rest = (
        np.asarray(one, dtype=np.float64)
        for one in (quasi_static_spring_constant, quasi_static_standard_uncertainty)
    )
    if not 0 <= break_in_cycles < n_cycles:
        raise DataError(
            "the break-in leaves no cycle",
            found=f"{break_in_cycles} of {n_cycles} cycles",
            needed="at least one cycle after it",
        )
    names = FUNDAMENTAL_INPUTS if reading == "fundamental" else AMPLITUDE_INPUTS
    means, deviations = relative_deviations(loops, names[:-1], break_in_cycles=break_in_cycles)
    values = dict(zip(names[:-1], means, strict=True))
    stated = {"quasi_static_spring_constant": u_rest}
    if reading == "fundamental":
        line = identify_by_fundamental(
            **values, quasi_static_spring_constant=rest, standard_uncertainty=stated
        )
        table = line_sensitivities
    else:
        line = identify_by_amplitude(
            **values, quasi_static_spring_constant=rest, standard_uncertainty=stated
        )
        table = amplitude_sensitivities
    above = np.where(line.reason == 0, rest, np.nan)
    carried = table(line.storage_spring_constant, line.loss_spring_constant, above)
    # (outputs, inputs, specimens) with (inputs, specimens, cycles)
    moved = (carried[:, :-1, :, None] * deviations).sum(axis=1)
    alike = relative_shared(loops, names[:-1], break_in_cycles=break_in_cycles)
    random, both = {}, {}
    for row, name in enumerate(OUTPUTS):
        of_loops = np.sqrt(((carried[row, :-1] * alike) ** 2).sum(axis=0))
        random[name] = np.abs(getattr(line, name)) * np.hypot(_scatter(moved[row]), of_loops)
        both[name] = np.hypot(random[name], line.shared_uncertainty[name])
    line = replace(line, random_uncertainty=random, uncertainty=both)
    return replace(line, notes=_remarks(loops, line, break_in_cycles))

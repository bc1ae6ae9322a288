r"""One row of dynamic quantities per cycle and specimen.

Dynamic quantities of a cycle from sums over its samples, and how far noise moves them.

Three readings of the slope of a loop, and how far apart they lie.

A loop of loss angle :math:`\delta` has, by "the line drawn between the ends of the loop",

.. math::

    |K| \cos\delta \;\text{(strain extremes)}, \qquad |K| \;\text{(amplitudes)}, \qquad
    |K| / \cos\delta \;\text{(tension extremes)}

Closed loops: one row of dynamic quantities a cycle and specimen.

References
----------
.. [1] CG-D-39-80, sec. 2.2: apparent spring constant (eq. 1) and hysteresis (eq. 4).
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.2 and A-3 (slope of the line between
   the ends of the loop; which ends is not said).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_same_shape, run_blocks
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.samples import empty_like, release_pages, take_samples
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.cycles.loop_energy import (
    CycleBasis,
    bridge_gaps,
    cycle_basis,
    fundamental,
    loop_energy,
    mean_drift,
    mean_period,
    part_means,
    phase_turns,
    reading_noise,
    without_drift,
)

Waveform = Literal["triangular", "sinusoidal", "other"]

MEASURED = (
    "peak", "valley", "high", "low", "energy", "strain_step_norm", "force_cosine", "force_sine",
    "force_mean", "strain_cosine", "strain_sine", "strain_mean", "force_end", "strain_end",
    "force_rise", "force_turn", "force_fall", "strain_rise", "strain_turn", "strain_fall",
)  # fmt: skip
"""What is summed over the samples of a cycle, in this order."""


def _quantities_of_cycles(
    measured: Floats,
    cycles: Cycles,
    ends: Floats,
    *,
    waveform: Waveform,
    noise: float,
    strain_noise: float,
) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Quantities of each cycle of one specimen, and their standard uncertainties.

    Notes
    -----
    Source: [1]_, eq. 1 and 4, freed of drift.  Where the drift is more than the range of the
    cycle, what it is taken off is NaN.

    Examples
    --------
    Of a triangular cycle from 100 to 300 N and from 1 to 3 %, K_ap is 100 N over 1 %:

    >>> known = {"peak": 300.0, "valley": 100.0, "high": 0.03, "low": 0.01, "strain_cosine": 0.01}
    >>> measured = np.array([[known.get(name, 0.0)] for name in MEASURED])
    >>> one, pair = np.array([0]), np.array([[0, 50]])
    >>> cycles = Cycles(
    ...     one, one + 100, pair, pair + 50, np.ones((1, 2)), np.zeros(101, np.int32),
    ...     np.zeros(101, np.int8), np.zeros(101, bool), 0.1,
    ... )
    >>> values, _ = _quantities_of_cycles(
    ...     measured, cycles, np.array([[0.0], [2.5], [7.5], [10.0]]),
    ...     waveform="triangular", noise=1.0, strain_noise=0.0,
    ... )
    >>> values["apparent_spring_constant"].round(6), values["mean_tension"]
    (array([10000.]), array([200.]))
    """
    row = dict(zip(MEASURED, measured, strict=True))
    n_samples = (cycles.last - cycles.first).astype(np.float64)
    peak, valley = row["peak"], row["valley"]
    force_cos, strain_cos = row["force_cosine"], row["strain_cosine"]
    force_drift, strain_drift = (
        mean_drift(np.stack([row[f"{name}_{part}"] for part in ("rise", "turn", "fall")]), ends)
        for name in ("force", "strain")
    )
    # drift of more than the range is that of a jump among the neighbours: no steady cycle is left
    force_drift[np.abs(force_drift) > peak - valley] = np.nan
    strain_drift[np.abs(strain_drift) > row["high"] - row["low"]] = np.nan
    force_sin = row["force_sine"] + force_drift / np.pi
    strain_sin = row["strain_sine"] + strain_drift / np.pi
    if waveform == "sinusoidal":
        mean, mean_strain = row["force_mean"], row["strain_mean"]
        amplitude = np.hypot(force_cos, force_sin)
        strain_amplitude = np.hypot(strain_cos, strain_sin)
    else:
        mean, mean_strain = (peak + valley) / 2, (row["high"] + row["low"]) / 2
        # between a turn and the next, half a period, a drift adds half of itself to the range
        amplitude = (peak - valley - np.abs(force_drift) / 2) / 2
        strain_amplitude = (row["high"] - row["low"] - np.abs(strain_drift) / 2) / 2
    energy = without_drift(
        row["energy"],
        end_tension=row["force_end"],
        mean_tension=row["force_mean"],
        tension_drift=force_drift,
        end_strain=row["strain_end"],
        mean_strain=row["strain_mean"],
        strain_drift=strain_drift,
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        # a series a cos + b sin is the real part of (a - ib) exp(i omega t)
        square = strain_cos**2 + strain_sin**2
        storage = (force_cos * strain_cos + force_sin * strain_sin) / square
        loss = (force_cos * strain_sin - force_sin * strain_cos) / square
        apparent = amplitude / strain_amplitude
        share = np.pi * square * loss / energy
        factor = loss / storage
        both = np.hypot(noise, apparent * strain_noise)
        u_part = np.sqrt(2 / n_samples) * both / np.sqrt(square)
        u_energy = row["strain_step_norm"] * both
        u_extreme = np.hypot(noise, _missed_turn(amplitude, n_samples))
        if waveform == "sinusoidal":
            u_half, u_strain = np.sqrt(2 / n_samples) * noise, np.sqrt(2 / n_samples) * strain_noise
            u_apparent = u_part
        else:
            u_half = u_extreme / np.sqrt(2)
            u_strain = np.hypot(strain_noise, _missed_turn(strain_amplitude, n_samples))
            u_strain /= np.sqrt(2)
            # a missed turn takes the same share off both amplitudes; only noise is left
            u_apparent = apparent * np.hypot(noise / amplitude, strain_noise / strain_amplitude)
            u_apparent /= np.sqrt(2)
        values = {
            "mean_tension": mean,
            "tension_amplitude": amplitude,
            "mean_strain": mean_strain,
            "strain_amplitude": strain_amplitude,
            "peak_tension": peak,
            "valley_tension": valley,
            "apparent_spring_constant": apparent,
            "hysteresis_energy": energy,
            "storage_spring_constant": storage,
            "loss_spring_constant": loss,
            "loss_factor": factor,
            "fundamental_energy_share": share,
        }
        uncertainty = {
            "mean_tension": u_half,
            "tension_amplitude": u_half,
            "mean_strain": u_strain,
            "strain_amplitude": u_strain,
            "peak_tension": u_extreme,
            "valley_tension": u_extreme,
            "apparent_spring_constant": u_apparent,
            "hysteresis_energy": u_energy,
            "storage_spring_constant": u_part,
            "loss_spring_constant": u_part,
            "loss_factor": u_part / np.abs(storage) * np.sqrt(1 + factor**2),
            "fundamental_energy_share": np.abs(share)
            * np.hypot(u_part / np.abs(loss), u_energy / np.abs(energy)),
        }
    return values, uncertainty


def _missed_turn(amplitude: Floats, n_samples: Floats) -> Floats:
    """How far the logged extreme may lie below the turn between two samples.

    A branch at constant rate rises by four amplitudes over N per sample; the turn lies
    within half a sample of the logged extreme, evenly spread, so the loss is spread evenly
    over half a step: the root of its mean square is the step over the root of 12.
    """
    missed: Floats = 4 * amplitude / n_samples / np.sqrt(12)
    return missed


@dataclass(frozen=True)
@read_only_arrays
class _SlopeReadings:
    """Slope of each loop by three readings; every array has the shape of the loops."""

    amplitude_ratio: Floats
    between_strain_extremes: Floats
    between_tension_extremes: Floats
    relative_spread: Floats


def slope_readings(apparent_spring_constant: ArrayLike, loss_factor: ArrayLike) -> _SlopeReadings:
    r"""Slope of an elliptical loop by amplitudes and by the two pairs of its extremes.

    .. math:: |K| \cos\delta, \quad |K|, \quad |K| / \cos\delta, \qquad
              \cos\delta = (1 + \tan^2\delta)^{-1/2}

    Parameters
    ----------
    apparent_spring_constant : array_like, shape (...)
        Tension amplitude over strain amplitude, of each loop. [N]
    loss_factor : array_like, shape (...)
        Tangent of the loss angle, of each loop. [1]

    Returns
    -------
    readings : SlopeReadings
        The three slopes and their spread. [N], [1]

    Raises
    ------
    DataError
        If the shapes differ, or a loss factor is negative.

    Notes
    -----
    [2]_ reads K_ap from "the slope of the line drawn between the ends of the hysteresis
    loop", and eq. 1 there gives the modulus: the amplitude ratio, which is used here.  The
    others differ from it by 0.4 to 2.7 % at the loss angles of [2]_, 5.1 to 13.1 degrees.  A
    loop with pointed ends has its extremes of strain and tension at one point and all three
    readings are one: there the spread is that of the ellipse with the same loss angle.
    NaN in, NaN out.

    Examples
    --------
    >>> readings = slope_readings(100.0, np.tan(np.radians([5.0, 13.0])).max())
    >>> print(readings.between_strain_extremes.round(1), readings.between_tension_extremes.round(1))
    97.4 102.6
    >>> print(readings.relative_spread.round(3))
    0.052
    """
    slope, tangent = as_same_shape(
        apparent_spring_constant=apparent_spring_constant, loss_factor=loss_factor
    )
    bad = tangent < 0
    if bad.any():
        raise DataError(
            f"{int(bad.sum())} of {bad.size} loss factors are negative",
            found=f"{tangent[bad].flat[0]:g}",
            needed="tension that leads strain",
            hint="Check the signs of tension and position.",
        )
    secant = np.sqrt(1 + tangent**2)
    return _SlopeReadings(slope + 0.0, slope / secant, slope * secant, secant - 1 / secant)


# samples reduced at a time: near the cache, yet long enough for threads to pay
_BLOCK = 1 << 17

# samples beside a block that its differences of strain reach
_REACH = 4

_FIELDS = (
    "frequency", "cycle_start_time", "mean_tension", "tension_amplitude", "mean_strain",
    "strain_amplitude", "peak_tension", "valley_tension", "apparent_spring_constant",
    "hysteresis_energy", "storage_spring_constant", "loss_spring_constant", "loss_factor",
    "fundamental_energy_share",
)  # fmt: skip


def _extremes(values: Floats, first: Integers, last: Integers) -> tuple[Floats, Floats]:
    pairs = np.column_stack([first, last]).ravel()
    stop = int(last[-1])
    greatest = np.maximum.reduceat(values[:stop], pairs[:-1])[::2]
    least = np.minimum.reduceat(values[:stop], pairs[:-1])[::2]
    return np.maximum(greatest, values[last]), np.minimum(least, values[last])


def _measure(
    tension: Floats, strain: Floats, basis: CycleBasis, middles: Integers, waveform: Waveform
) -> Floats:
    """What only the samples tell, one row a quantity of `MEASURED`, one column a cycle."""
    first, last = basis.first, basis.last
    force, lost_force = bridge_gaps(tension, first, last)
    stretch, lost_stretch = bridge_gaps(strain, first, last)
    measured = np.array(
        [
            *_extremes(force, first, last),
            *_extremes(stretch, first, last),
            *loop_energy(force, stretch, first, last, waveform=waveform),
            *fundamental(force, basis),
            *fundamental(stretch, basis),
            (force[first] + force[last]) / 2,
            (stretch[first] + stretch[last]) / 2,
            *part_means(force, basis, middles),
            *part_means(stretch, basis, middles),
        ]
    )
    measured[:, lost_force | lost_stretch] = np.nan
    return measured


def close_loops(
    time: Floats,
    tension: Floats,
    strain: Floats,
    cycles: Cycles,
    *,
    waveform: Waveform = "triangular",
) -> Loops:
    r"""Dynamic quantities of each cycle and specimen.

    .. math:: K_{ap} = \frac{T_{max} - T_{min}}{\varepsilon_{max} - \varepsilon_{min}}, \qquad
              H = \oint T d\varepsilon, \qquad K' + i K'' = \hat T / \hat\varepsilon

    Parameters
    ----------
    time : ndarray, shape (n_samples,)
        Elapsed time. [s]
    tension : ndarray, shape (n_specimens, n_samples)
        NaN where missing. [N]
    strain : ndarray, shape (n_specimens, n_samples)
        Nominal strain of the free length. [1]
    cycles : Cycles
        From `reduction.stages.cycles.cycle_search`.
    waveform : {"triangular", "sinusoidal", "other"}
        How the control channel moves; see `reduction.stages.cycles.loop_energy`. [-]

    Returns
    -------
    loops : Loops
        One row a cycle; amplitudes are half ranges.

    Raises
    ------
    DataError
        If a cycle takes no time.

    Notes
    -----
    Means and amplitudes of a sinusoidal test are those of its fundamental, whose range they
    are: the turn of a slow log lies between two samples, earlier in tension than in strain.
    Peaks and valleys, and of other waves means and amplitudes, are of the logged extremes:
    noise makes a peak read high by about one to two standard deviations of a reading, and a
    slow log misses the turn by up to half a sample.  Uncertainties are of one cycle: the
    noise of a reading (`reading_noise`) carried through and, for extremes, the turn between
    two samples; nothing else.  K_ap
    by amplitudes is one of three readings of "slope of the loop"; for an ellipse it is
    hypot(K', K''), and K' itself is the slope of the regression of tension on strain.  An
    open loop is closed by a straight line and freed of its drift (`without_drift`), and
    so are the amplitudes of other waves: half the range less a quarter of the drift.  A
    cycle that lacks up to a tenth of its readings has them bridged by straight lines; one
    that lacks more is NaN throughout.

    Examples
    --------
    A standard linear solid with K' = 900 N and K'' = 100 N at 0.1 Hz, strain 1 +- 0.2.

    >>> t = np.arange(0, 30.01, 0.1)
    >>> strain = 1 - 0.2 * np.cos(0.2 * np.pi * t)
    >>> tension = 1000 - 0.2 * (900 * np.cos(0.2 * np.pi * t) - 100 * np.sin(0.2 * np.pi * t))
    >>> first, last = np.array([0, 100]), np.array([100, 200])
    >>> ends = np.column_stack([first, first + 50])
    >>> cycles = Cycles(
    ...     first, last, ends, ends + 50, np.ones((2, 2)), np.zeros(301, np.int32),
    ...     np.zeros(301, np.int8), np.zeros(301, bool), 0.1,
    ... )
    >>> loops = close_loops(t, tension[None], strain[None], cycles, waveform="sinusoidal")
    >>> print(loops.storage_spring_constant.round(2), loops.loss_spring_constant.round(2))
    [[900. 900.]] [[100. 100.]]
    >>> print(loops.hysteresis_energy.round(3), round(np.pi * 100 * 0.2**2, 3))
    [[12.566 12.566]] 12.566
    """
    first, last = cycles.first, cycles.last
    begin, end = take_samples(time, first), take_samples(time, last)
    duration = end - begin
    period = mean_period(begin, first, last, last_turn=end)
    if waveform == "sinusoidal" and np.all(period > 0):
        period = _sine_period(time, tension, cycles, period)
        duration = period
    measured = empty_like(tension, shape=(tension.shape[0], len(MEASURED), cycles.n_cycles))
    # the middles of rise and fall, at least a sample apart and from either end
    middles = (cycles.branch_first + cycles.branch_last).T // 2
    middles[0] = np.clip(middles[0], cycles.first + 1, cycles.last - 2)
    middles[1] = np.clip(middles[1], middles[0] + 1, cycles.last - 1)
    ends = take_samples(time, np.stack([cycles.first, *middles, cycles.last]))

    def measure_block(block: slice) -> None:
        low = max(int(cycles.first[block.start]) - _REACH, 0)
        high = int(cycles.last[block.stop - 1]) + _REACH + 1
        basis = cycle_basis(
            time[low:high], cycles.first[block] - low, cycles.last[block] - low,
            period=period[block],
        )  # fmt: skip
        for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
            measured[index, :, block] = _measure(
                force[low:high], stretch[low:high], basis, middles[:, block] - low, waveform
            )

    samples = (time, tension, strain, measured)
    run_blocks(measure_block, cycles.blocks(_BLOCK), samples=samples, longest=cycles.longest)
    shape = (tension.shape[0], cycles.n_cycles)
    tables = {name: empty_like(tension, shape=shape) for name in _FIELDS}
    uncertainty = {
        name: empty_like(tension, shape=shape) for name in _FIELDS if name != "cycle_start_time"
    }
    for index, (force, stretch) in enumerate(zip(tension, strain, strict=True)):
        values, errors = _quantities_of_cycles(
            measured[index],
            cycles,
            ends,
            waveform=waveform,
            noise=reading_noise(force),
            strain_noise=reading_noise(stretch),
        )
        for name, column in values.items():
            tables[name][index] = column
            uncertainty[name][index] = errors[name]
            release_pages(tables[name], uncertainty[name])
        release_pages(measured)
    tables["cycle_start_time"][:] = begin
    tables["frequency"][:] = 1 / duration
    # a turn is known to one sample at each end of the cycle, evenly spread
    step = duration / (cycles.last - cycles.first)
    uncertainty["frequency"][:] = step / duration**2 * np.sqrt(2 / 12)
    release_pages(*tables.values(), *uncertainty.values())
    return Loops(**tables, uncertainty=uncertainty)


def _sine_period(time: Floats, tension: Floats, cycles: Cycles, period: Floats) -> Floats:
    """Period of the wave in each cycle, from the phase of the fundamental of its tension.

    Noise puts the turns of a log a sample early or late; the phase of a fundamental over a
    hundred samples is known to a hundredth of one.
    """
    turns = np.empty(cycles.n_cycles)
    blocks = cycles.blocks(_BLOCK)

    def find(block: slice) -> None:
        low, high = int(cycles.first[block.start]), int(cycles.last[block.stop - 1]) + 1
        first, last = cycles.first[block] - low, cycles.last[block] - low
        basis = cycle_basis(time[low:high], first, last, period=period[block])
        force, _ = bridge_gaps(tension[0, low:high], first, last)
        turns[block] = phase_turns(*fundamental(force, basis)[:2], basis, time[low:high])

    run_blocks(find, blocks, samples=(time, tension), longest=cycles.longest)
    last_turn = np.append(turns[1:], np.nan)
    # the last cycle of a run ends where it would go on
    ends_run = np.append(cycles.last[:-1] != cycles.first[1:], True)
    last_turn[ends_run] = (turns + period)[ends_run]
    return mean_period(turns, cycles.first, cycles.last, last_turn=last_turn)

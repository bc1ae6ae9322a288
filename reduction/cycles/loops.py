"""Closed loops: one row of dynamic quantities a cycle and specimen.

References
----------
.. [1] CG-D-39-80, sec. 2.2: apparent spring constant (eq. 1) and hysteresis (eq. 4).
.. [2] ISO 4664-1 usage of storage and loss: in phase and in quadrature with strain.
"""

from __future__ import annotations

import numpy as np

from reduction.cycles.drift import part_means
from reduction.cycles.energy import loop_energy
from reduction.cycles.harmonic import (
    CycleBasis,
    cycle_basis,
    fundamental,
    mean_period,
    phase_turns,
)
from reduction.cycles.product import Cycles, Loops
from reduction.cycles.quantities import MEASURED, Waveform, quantities_of_cycles
from reduction.cycles.readings import bridge_gaps, reading_noise
from reduction.record import Floats, Integers
from reduction.samples.blocks import take_samples
from reduction.samples.scratch import empty_like, let_go
from reduction.workers import run_blocks

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
        From `reduction.cycles.find`.
    waveform : {"triangular", "sinusoidal", "other"}
        How the control channel moves; see `reduction.cycles.energy`. [-]

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
        values, errors = quantities_of_cycles(
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
            let_go(tables[name], uncertainty[name])
        let_go(measured)
    tables["cycle_start_time"][:] = begin
    tables["frequency"][:] = 1 / duration
    # a turn is known to one sample at each end of the cycle, evenly spread
    step = duration / (cycles.last - cycles.first)
    uncertainty["frequency"][:] = step / duration**2 * np.sqrt(2 / 12)
    let_go(*tables.values(), *uncertainty.values())
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

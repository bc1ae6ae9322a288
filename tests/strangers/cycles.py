"""What is true of exact records of cycles: loops, branches and their tangents."""

import itertools
from dataclasses import dataclass

import numpy as np

from strangers.materials import Array

UNITS = {
    "apparent_spring_constant": "N",
    "hysteresis_energy": "J m-1",
    "hysteresis_energy_work": "J m-1",
    "hysteresis_energy_drift_free": "J m-1",
    "storage_spring_constant": "N",
    "loss_spring_constant": "N",
    "loss_factor": "1",
    "loss_factor_sine": "1",
    "strain_amplitude": "1",
    "mean_strain": "1",
    "tension_amplitude": "N",
    "mean_tension": "N",
    "peak_tension": "N",
    "valley_tension": "N",
    "frequency": "Hz",
}


def refine_turns(strain: Array, planned: list[int]) -> list[int]:
    """Move planned turning points (samples of the crosshead) to those of the strain."""
    out = []
    for place, index in enumerate(planned):
        before = planned[place - 1] if place else index
        after = planned[place + 1] if place + 1 < len(planned) else index
        low = index - (index - before) // 4
        high = index + (after - index) // 4 + 1
        if low == index and high == index + 1:
            out.append(index)
            continue
        neighbour = strain[before] if place else strain[after]
        window = strain[low:high]
        rises = strain[index] > neighbour
        out.append(low + int(np.argmax(window) if rises else np.argmin(window)))
    return out


@dataclass(frozen=True)
class Branches:
    """Ascending and descending runs of a record, as pairs of samples (first, last)."""

    ascending: list[tuple[int, int]]
    descending: list[tuple[int, int]]
    loops: list[tuple[int, int, int]]  # valley, peak, next valley


def find_branches(strain: Array, turns: list[int]) -> Branches:
    """Sort the runs between turning points."""
    runs = list(itertools.pairwise(turns))
    up = [run for run in runs if strain[run[1]] > strain[run[0]]]
    down = [run for run in runs if strain[run[1]] <= strain[run[0]]]
    loops = [
        (first, top, last)
        for (first, top), (start, last) in itertools.pairwise(runs)
        if top == start and strain[top] > strain[first]
    ]
    return Branches(up, down, loops)


def closed_area(strain: Array, tension: Array) -> float:
    """Area of a loop that rises on its upper side, closed by its chord."""
    following_strain, following_tension = np.roll(strain, -1), np.roll(tension, -1)
    return float(0.5 * np.sum((following_tension + tension) * (following_strain - strain)))


def loop_measures(
    strain: Array, tension: Array, loops: list[tuple[int, int, int]], time_step: float
) -> dict[str, Array]:
    """Measures of each loop from valley to valley, from exact values.

    ``hysteresis_energy`` is the area closed by its chord and ``hysteresis_energy_work`` the work
    done as it was. ``hysteresis_energy_drift_free`` is the area after the drift of the tension
    from valley to valley, linear in time, is taken off. ``loss_factor`` is the ratio of the first
    harmonics of tension at equal strain phase, ``loss_factor_sine`` the energy over pi times the
    product of the amplitudes.
    """
    out: dict[str, list[float]] = {name: [] for name in UNITS}
    phase = np.linspace(0.0, np.pi, 721)
    cosine = np.cos(phase)
    for first, top, last in loops:
        e, t = strain[first : last + 1], tension[first : last + 1]
        amplitude, force = float(np.ptp(e)) / 2.0, float(np.ptp(t)) / 2.0
        energy = closed_area(e, t)
        drift = (t[-1] - t[0]) * np.linspace(0.0, 1.0, t.size)
        both = np.zeros_like(phase)
        for a, b in ((first, top), (top, last)):
            x, y = strain[a : b + 1], tension[a : b + 1]
            if x[-1] < x[0]:
                x, y = x[::-1], y[::-1]
            both += np.interp((x[0] + x[-1]) / 2 + (x[-1] - x[0]) / 2 * cosine, x, y)
        storage = float(np.trapezoid(both * cosine, phase)) / (np.pi * amplitude)
        loss = energy / (np.pi * amplitude**2)
        row = {
            "apparent_spring_constant": force / amplitude,
            "hysteresis_energy": energy,
            "hysteresis_energy_work": float(np.trapezoid(t, e)),
            "hysteresis_energy_drift_free": closed_area(e, t - drift),
            "storage_spring_constant": storage,
            "loss_spring_constant": loss,
            "loss_factor": loss / storage,
            "loss_factor_sine": energy / (np.pi * amplitude * force),
            "strain_amplitude": amplitude,
            "mean_strain": float(e.max() + e.min()) / 2.0,
            "tension_amplitude": force,
            "mean_tension": float(t.max() + t.min()) / 2.0,
            "peak_tension": float(t.max()),
            "valley_tension": float(t.min()),
            "frequency": 1.0 / ((last - first) * time_step),
        }
        for name, value in row.items():
            out[name].append(value)
    return {name: np.array(values) for name, values in out.items()}


def tangents(
    abscissa: Array, force: Array, strain: Array, runs: list[tuple[int, int]], grid: Array
) -> tuple[Array, Array]:
    """d(force)/d(strain) and force on a grid of the abscissa, one row a run."""
    slopes, forces = [], []
    for first, last in runs:
        x, y, e = (values[first : last + 1] for values in (abscissa, force, strain))
        if x[-1] < x[0]:
            x, y, e = x[::-1], y[::-1], e[::-1]
        keep = np.concatenate(([True], x[1:] > np.maximum.accumulate(x)[:-1]))
        x, y, e = x[keep], y[keep], e[keep]
        middle = 0.5 * (x[1:] + x[:-1])
        slopes.append(np.interp(grid, middle, np.diff(y) / np.diff(e)))
        forces.append(np.interp(grid, x, y))
    return np.array(slopes), np.array(forces)


def common_grid(
    abscissa: Array, runs: list[tuple[int, int]], count: int = 401, margin: float = 0.002
) -> Array:
    """Grid that lies inside all runs, short of their ends by a share of the range."""
    low = max(min(abscissa[a], abscissa[b]) for a, b in runs)
    high = min(max(abscissa[a], abscissa[b]) for a, b in runs)
    return np.linspace(low + margin * (high - low), high - margin * (high - low), count)

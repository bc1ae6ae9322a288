"""Half cycles, areas and slopes of many cycles, against the package `hysteresis` on the same ones.

    python benchmarks/hysteresis_package.py [cycles] [samples a cycle]

The loops are synthetic: a sine of strain and one of tension that leads it, without noise and with
noise of 0.2 % of the range on both.  The sides run in turn in one process.  Where `hysteresis`
(PyPI) is not installed, the script says so and prints this package's side alone.

- *three steps*: reversals; area of each loop; slope of each half cycle between its ends, and at
  each sample by the central differences that the other package takes (plain numpy, below).
- *as in a run*: standstills, cycles with everything that is checked of them, then 14 quantities of
  each loop and the slopes of its half cycles, with their uncertainties.
- *with tangent moduli*: that, and regressions in a moving window on a strain grid in each half
  cycle.
- *hysteresis*: `Hysteresis` for the half cycles, then area and slope of each of them.
- *hysteresis, one curve*: `Hysteresis` as it comes, area and slope at each sample of the whole.
"""

from __future__ import annotations

import os
import statistics
import sys
from collections.abc import Callable
from importlib.metadata import version
from importlib.util import find_spec
from time import perf_counter
from typing import NamedTuple

import numpy as np
from figures import Figure, hand_on

from reduction.record.settings import CycleSettings, ModulusSettings, PhaseSettings
from reduction.stages.cycles.cycle_search import find_cycles
from reduction.stages.cycles.loop_energy import loop_energy
from reduction.stages.cycles.loops import close_loops
from reduction.stages.cycles.reversals import reversals_of_typical_cycles
from reduction.stages.moduli.secant_modulus import chord_modulus, end_moduli
from reduction.stages.moduli.tangent_modulus import tangent_curves
from reduction.stages.standstills import find_standstills

PASSES = 9
NOISE = 0.002  # of the range
WANTED = 5.0
ENERGY_WANTED = 0.2  # %
STRAIN, STRAIN_AMPLITUDE = 1.0, 0.25
TENSION, TENSION_AMPLITUDE, ANGLE = 400.0, 150.0, np.radians(8.0)
ENERGY = np.pi * STRAIN_AMPLITUDE * TENSION_AMPLITUDE * np.sin(ANGLE)
SINE = CycleSettings(waveform="sinusoidal")


class Answer(NamedTuple):
    """Half cycles found, and energy of each loop [J/m]."""

    half_cycles: int
    energy: np.ndarray


def signals(cycles: int, samples: int, noise: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time [s], strain and tension [N]; valley to valley."""
    rng = np.random.default_rng(1)
    phase = 2 * np.pi * np.arange(cycles * samples + 1) / samples
    strain = STRAIN - STRAIN_AMPLITUDE * np.cos(phase)
    tension = TENSION - TENSION_AMPLITUDE * np.cos(phase + ANGLE)
    strain += 2 * STRAIN_AMPLITUDE * noise * rng.standard_normal(phase.size)
    tension += 2 * TENSION_AMPLITUDE * noise * rng.standard_normal(phase.size)
    return np.arange(phase.size) / samples, strain, tension


def three_steps(strain: np.ndarray, tension: np.ndarray) -> Answer:
    """What the other package gives, no more."""
    reversals, _ = reversals_of_typical_cycles(strain)
    with np.errstate(divide="ignore", invalid="ignore"):
        # at each sample; at a turn it is none, as there
        np.divide(tension[2:] - tension[:-2], strain[2:] - strain[:-2])
    first, last = reversals[:-1], reversals[1:]
    chord_modulus(strain[first], strain[last], tension[first], tension[last], area=1.0)
    valleys = reversals[0 if strain[reversals[0]] < strain[reversals[1]] else 1 :: 2]
    return Answer(first.size, loop_energy(tension, strain, valleys[:-1], valleys[1:])[0])


def as_in_a_run(
    time: np.ndarray, strain: np.ndarray, tension: np.ndarray, *, tangent: bool = False
) -> Answer:
    """The stages of a run up to the slopes; strain stands for the crosshead."""
    stands = find_standstills(time, strain, tension[None], settings=PhaseSettings())
    cycles = find_cycles(time, strain, tension, stands, settings=SINE)
    loops = close_loops(time, tension[None], strain[None], cycles, waveform="sinusoidal")
    end_moduli(strain[None], tension[None], area=[1.0], cycles=cycles)
    if tangent:
        tangent_curves(
            strain[None], tension[None], area=[1.0], cycles=cycles, settings=ModulusSettings()
        )
    return Answer(cycles.branch_first.size, loops.hysteresis_energy[0])


def theirs(strain: np.ndarray, tension: np.ndarray, prominence: float | None = None) -> Answer:
    """`hysteresis`, half cycle by half cycle; a loop is a pair of half cycles in turn."""
    from hysteresis import Hysteresis

    whole = Hysteresis(
        np.column_stack([strain, tension]), revProminence=prominence, setArea=False, setSlope=False
    )
    areas = np.empty(len(whole.cycles))
    for index, one in enumerate(whole.cycles):
        one.setArea()
        areas[index] = one.getNetArea()
        if one.Npoints > 3:  # a shorter one ends its slope in an UnboundLocalError
            one.setSlope()
    pairs = areas.size // 2
    return Answer(areas.size, areas[: 2 * pairs].reshape(-1, 2).sum(axis=1))


def theirs_at_once(
    strain: np.ndarray, tension: np.ndarray, prominence: float | None = None
) -> Answer:
    """`hysteresis` as it comes: area and slope at each sample, none of a half cycle."""
    from hysteresis import Hysteresis

    whole = Hysteresis(np.column_stack([strain, tension]), revProminence=prominence)
    return Answer(len(whole.cycles), np.array([whole.getNetArea() / (len(whole.cycles) / 2)]))


def timed(sides: dict[str, Callable[[], Answer]], n_half_cycles: int, kind: str) -> list[Figure]:
    """Print a row a side, with the ratio to that of `hysteresis` where it is installed."""
    figures = []
    taken: dict[str, list[float]] = {name: [] for name in sides}
    answers = {}
    for _ in range(PASSES + 1):
        for name, side in sides.items():
            start = perf_counter()
            answers[name] = side()
            taken[name].append(perf_counter() - start)
    print("| | median s | min | max | times as fast | half cycles | energy, mean error % |")
    print("|---|---|---|---|---|---|---|")
    for name, every in taken.items():
        # the first pass warms up
        seconds = sorted(every[1:])
        pairs = zip(every[1:], taken.get("hysteresis", every)[1:], strict=True)
        ratios = tuple(other / own for own, other in pairs)
        ratio = statistics.median(ratios)
        found = answers[name]
        error = 100 * (found.energy.mean() / ENERGY - 1)
        print(
            f"| {name} | {statistics.median(seconds):.4f} | {seconds[0]:.4f} | {seconds[-1]:.4f} "
            f"| {ratio:.1f} | {found.half_cycles} | {error:+.4f} |"
        )
        is_three = name == "three steps"
        has_ratio = "hysteresis" in taken and name != "hysteresis"
        figures.append(
            Figure(
                what=f"{name}, {kind}",
                values=tuple(every[1:]),
                against="times as fast as `hysteresis`",
                ratios=ratios if has_ratio else (),
                at_least=WANTED if is_three else None,
            )
        )
        if is_three or name == "as in a run":
            figures += [
                Figure(
                    what=f"half cycles found, {name}, {kind}",
                    unit="",
                    values=(found.half_cycles,),
                    at_least=n_half_cycles,
                    at_most=n_half_cycles,
                    of="value",
                ),
                Figure(
                    what=f"error of their energy, {name}, {kind}",
                    unit="%",
                    values=(abs(error),),
                    at_most=ENERGY_WANTED,
                    of="value",
                ),
            ]
    return figures


def main(cycles: int, samples: int) -> list[Figure]:
    """Print both tables."""
    figures = []
    has_theirs = find_spec("hysteresis") is not None
    processors = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    )
    print(f"{cycles} cycles of {samples} samples (synthetic), {processors} processors")
    print(
        f"hysteresis {version('hysteresis')}; wanted: three steps {WANTED:g} times as fast"
        if has_theirs
        else "hysteresis is not installed (pip install hysteresis==2.0.5): this side alone"
    )
    for noise in (0.0, NOISE):
        time, strain, tension = signals(cycles, samples, noise)
        sides: dict[str, Callable[[], Answer]] = {
            "three steps": lambda e=strain, f=tension: three_steps(e, f),
            "as in a run": lambda t=time, e=strain, f=tension: as_in_a_run(t, e, f),
            "with tangent moduli": lambda t=time, e=strain, f=tension: as_in_a_run(
                t, e, f, tangent=True
            ),
        }
        if has_theirs:
            # its prominence, where there is no noise, takes minutes: the search is quadratic
            share = 0.2 * STRAIN_AMPLITUDE if noise else None
            sides["hysteresis"] = lambda e=strain, f=tension, p=share: theirs(e, f, p)
            sides["hysteresis, one curve"] = lambda e=strain, f=tension, p=share: theirs_at_once(
                e, f, p
            )
        print(f"\nnoise {100 * noise:g} % of the range")
        if has_theirs and noise:
            print("`hysteresis` here with revProminence of 10 % of the range")
        figures += timed(sides, 2 * cycles, f"noise {100 * noise:g} %" if noise else "noise-free")
        if has_theirs and noise:
            start = perf_counter()
            found = theirs(strain, tension)
            error = 100 * (found.energy.mean() / ENERGY - 1)
            print(
                f"`hysteresis` with its defaults: {found.half_cycles} half cycles, energy of a "
                f"pair {error:+.1f} %, {perf_counter() - start:.1f} s"
            )
            figures.append(
                Figure(
                    what="half cycles found, `hysteresis` with its defaults, noise",
                    unit="",
                    values=(found.half_cycles,),
                )
            )
    if not has_theirs:
        figures.append(
            Figure(what="`hysteresis`", remark="not installed (pip install hysteresis==2.0.5)")
        )
    return figures


if __name__ == "__main__":
    hand_on(
        main(
            int(sys.argv[1]) if len(sys.argv) > 1 else 3_000,
            int(sys.argv[2]) if len(sys.argv) > 2 else 400,
        )
    )

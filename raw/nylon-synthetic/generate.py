"""Write the synthetic logs of this folder: fifteen runs of loops and a slow pull of one line.

    python raw/nylon-synthetic/generate.py [FOLDER]

No rope was pulled.  The line is a three-parameter (standard linear) solid whose slow pull is
the load-strain cubic of 1/2-inch nylon double braid (CG-D-39-80, Table 8) and whose
dissipation spring constant and relaxation time are quadratics in the coded factors, stated
below.  numpy alone is used, nothing of the package: the logs are its truth.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

RATED_BREAK_STRENGTH = 6400.0  # lbf, CG-D-39-80 Table 1
FREQUENCY = (0.1, 0.5)  # Hz
MEAN_TENSION = (0.12, 0.30)  # share of the rated break strength
TENSION_AMPLITUDE = (0.05, 0.12)  # half range, share of the rated break strength
# strain = A + B T + C T^2 + D T^3 with T in lbf, Table 8; A is a seating error and left out
LOAD_STRAIN = (0.0, 1.389e-4, -3.906e-8, 3.795e-12)
# mean, then shares of it on frequency, mean tension and tension amplitude, all coded
DISSIPATION_SPRING_CONSTANT = (1.70e4, 0.02, 0.06, -0.04)  # lbf per unit strain
RELAXATION_TIME = (5.0, 0.0, -0.04, 0.03)  # s

SAMPLES_A_CYCLE, CYCLES, BREAK_IN = 80, 14, 4
LENGTH = 72.0  # in, between the pins at the reference tension
GAUGE_SHARE = 0.92  # strain of the whole length over that of the gauge length
LOAD_NOISE, STRAIN_NOISE, STROKE_NOISE = 0.3, 0.5e-5, 0.001  # lbf, 1, in
BREAK_IN_STRAIN, BREAK_IN_TIME = 2.0e-3, 15.0  # the mean strain still grows at first

# Box-Behnken in order of rising peak load; the three centres are spread over it
RUNS = {
    "R01": (0, -1, -1), "R02": (0, 0, 0), "R03": (-1, -1, 0), "R04": (1, -1, 0), "R05": (0, -1, 1),
    "R06": (-1, 0, -1), "R07": (1, 0, -1), "R08": (0, 0, 0), "R09": (-1, 0, 1), "R10": (1, 0, 1),
    "R11": (0, 1, -1), "R12": (-1, 1, 0), "R13": (1, 1, 0), "R14": (0, 0, 0), "R15": (0, 1, 1),
}  # fmt: skip
HEADER = "# synthetic, no rope was pulled: see README.md and generate.py in this folder\n"


def level(limits: tuple[float, float], coded: float) -> float:
    """Level of a factor from its coded value."""
    low, high = limits
    return (low + high) / 2 + coded * (high - low) / 2


def linear(terms: tuple[float, ...], coded: tuple[float, ...]) -> float:
    """A mean times one plus shares on the coded factors."""
    mean, *shares = terms
    return mean * (1 + sum(share * value for share, value in zip(shares, coded, strict=True)))


def strain_of(tension: np.ndarray) -> np.ndarray:
    """Strain of the slow pull at a tension in lbf."""
    return np.polynomial.polynomial.polyval(tension, LOAD_STRAIN)


def quasi_static(tension: float) -> float:
    """Slope of the slow pull [lbf per unit strain] at a tension in lbf."""
    slope = np.polynomial.polynomial.polyder(LOAD_STRAIN)
    return float(1 / np.polynomial.polynomial.polyval(tension, slope))


def truth(coded: tuple[float, ...]) -> dict[str, float]:
    """Levels of a run and what the line is at them, in lbf, Hz, s, and inch-pounds per inch."""
    frequency = level(FREQUENCY, coded[0])
    mean = level(MEAN_TENSION, coded[1]) * RATED_BREAK_STRENGTH
    amplitude = level(TENSION_AMPLITUDE, coded[2]) * RATED_BREAK_STRENGTH
    k_0 = quasi_static(mean)
    k_1 = linear(DISSIPATION_SPRING_CONSTANT, coded)
    tau = linear(RELAXATION_TIME, coded)
    x = 2 * np.pi * frequency * tau
    storage = k_0 + k_1 * x**2 / (1 + x**2)
    loss = k_1 * x / (1 + x**2)
    apparent = float(np.hypot(storage, loss))
    return {
        "frequency_hz": frequency,
        "mean_tension_lbf": mean,
        "tension_amplitude_lbf": amplitude,
        "quasi_static_spring_constant_lbf": k_0,
        "dissipation_spring_constant_lbf": k_1,
        "relaxation_time_s": tau,
        "storage_spring_constant_lbf": storage,
        "loss_spring_constant_lbf": loss,
        "apparent_spring_constant_lbf": apparent,
        "hysteresis_energy_lbf": float(np.pi * loss * (amplitude / apparent) ** 2),
    }


def write(
    path: Path, time: np.ndarray, load: np.ndarray, strain: np.ndarray, noise: np.random.Generator
) -> None:
    """Write one log with the noise of its channels."""
    stroke = LENGTH * GAUGE_SHARE * strain + noise.normal(0, STROKE_NOISE, time.size)
    load = load + noise.normal(0, LOAD_NOISE, time.size)
    strain = strain + noise.normal(0, STRAIN_NOISE, time.size)
    rows = [
        f"{t:.4f},{s:.4f},{f:.2f},{100 * e:.4f}"
        for t, s, f, e in zip(time, stroke, load, strain, strict=True)
    ]
    head = HEADER + "time_s,stroke_in,load_lbf,extensometer_pct\n"
    path.write_text(head + "\n".join(rows) + "\n", encoding="utf-8", newline="\n")


def loops(coded: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, load and strain of a run: slack, up to the mean load, a stop, cycles, slack."""
    line = truth(coded)
    mean, amplitude = line["mean_tension_lbf"], line["tension_amplitude_lbf"]
    frequency = line["frequency_hz"]
    step = 1 / (frequency * SAMPLES_A_CYCLE)
    rest, ramp, stop = (round(seconds / step) for seconds in (5.0, 20.0, 10.0))
    # a whole number of samples a cycle, begun between two samples so that no turn is logged
    phase = 2 * np.pi * (np.arange(CYCLES * SAMPLES_A_CYCLE) + 0.37) / SAMPLES_A_CYCLE
    cycling = phase / (2 * np.pi * frequency)
    lag = np.arctan2(line["loss_spring_constant_lbf"], line["storage_spring_constant_lbf"])
    size = amplitude / line["apparent_spring_constant_lbf"]
    growth = BREAK_IN_STRAIN * (1 - np.exp(-cycling / BREAK_IN_TIME))
    up = mean * np.arange(ramp) / ramp
    down = mean * (1 - np.arange(1, ramp + 1) / ramp)
    load = [np.zeros(rest), up, np.full(stop, mean), mean + amplitude * np.sin(phase), down]
    cycles = strain_of(np.array(mean)) + size * np.sin(phase - lag) + growth
    strain = [*map(strain_of, load[:3]), cycles, strain_of(down) + growth[-1]]
    joined = np.concatenate(load)
    return np.arange(joined.size) * step, joined, np.concatenate(strain)


def slow_pull() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, load and strain of a pull at 10 inches a minute, to 36 % of the break strength."""
    load_grid = np.linspace(0, 0.36 * RATED_BREAK_STRENGTH, 4001)
    rate = 10 / 60 / (LENGTH * GAUGE_SHARE)  # strain a second
    strain = np.arange(0, float(strain_of(load_grid[-1:])[0]), rate / 10)
    strain = np.concatenate([np.zeros(50), strain])
    load = np.interp(strain, strain_of(load_grid), load_grid)
    return np.arange(strain.size) / 10, load, strain


def main(folder: Path) -> None:
    """Write every log and its truth."""
    (folder / "truth").mkdir(parents=True, exist_ok=True)
    noise = np.random.Generator(np.random.PCG64(398080))
    rows = []
    for name, coded in RUNS.items():
        write(folder / f"{name}.csv", *loops(coded), noise)
        values = truth(coded)
        rows.append(
            [name, *(str(value) for value in coded), *(f"{v:.9g}" for v in values.values())]
        )
    write(folder / "Q01.csv", *slow_pull(), noise)
    header = ["run", "x_frequency", "x_mean_tension", "x_tension_amplitude", *truth((0, 0, 0))]
    text = "\n".join(",".join(row) for row in [header, *rows])
    (folder / "truth" / "runs.csv").write_text(HEADER + text + "\n", encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)

"""Write the synthetic logs of this folder: two stretch hoses pulled slowly and cycled, one broken.

    python raw/hose-synthetic/generate.py [FOLDER]

No hose was pulled.  The hoses are those of WHOI-2004-06 in kind: a rubber wall with two helical
cord layers, filled with water and closed.  Their tension is had from virtual work, below, and
not from the equations of the report.  numpy alone is used, nothing of the package: the logs
are its truth.

Derivation, per relaxed length of the part that stretches, with stretch ratio h:

1. Wall and water keep their volume, so every radius goes with h**-1/2.
2. A cord that lies at a0 from the axis is the diagonal of cos(a0) along and sin(a0) around it;
   these become h cos(a0) and h**-1/2 sin(a0), so its own stretch ratio is
   c = sqrt(h**2 cos(a0)**2 + sin(a0)**2 / h).
3. A layer is a fabric of pi d by 1 with n cords across each length: pi d n of cord, whatever
   the angle.  Two layers on the mean diameter d: 2 pi d n.
4. The tension is the derivative by h of what is stored,
   T = 2 pi d n P(c - 1) dc/dh + A E/3 (h - h**-2),   dc/dh = (h cos**2 - sin**2/(2 h**2)) / c,
   with P the load of one cord (none in a slack one) and a neo-Hookean wall of area A.  What the
   water pressure takes off the cords is in it.
5. At constant length a wider hose works against the water alone:
   p = (dU/dr) / (dV/dr) = 4 n P sin(a0)**2 / (c h d).
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# as built; the design in campaign.toml and README.md is nominal: 64 and 68 deg, 200 psi
WRAP_ANGLE = {"64": 63.6, "68": 68.3}  # deg from the axis
RUBBER_MODULUS = 212.0  # psi, Young's at small strain
WRAP_DIAMETER, INNER_DIAMETER, OUTER_DIAMETER = 3.5, 2.5, 5.0  # in
CORDS_PER_LENGTH = 34.0  # 1/in
LENGTH = 96.0  # in, flange to flange, relaxed
DEAD_LENGTH = 4.0  # in, what of it the stretch-limited ends keep from stretching
# load of one cord in lbf is a strain + b strain^2 + c strain^3: 10 at 9.5 %, 30 at 26 %
CORD = (80.0, 340.685, -786.883)
CORD_BREAK_STRAIN, CORD_BREAK_LOAD = 0.26, 30.0
WORKING_SHARE = 1 / 3  # of the break load of a cord
DYNAMIC_FACTOR = 1.4  # load of a cord at 0.1 Hz over that of the slow pull, at equal strain
# half the height of the loop, over the tension between its branches, is share (1 - x^2)^power
# with x from -1 to 1 between two turns; a power of 1/2 is a dashpot under a sine
STATIC_LOOP, DYNAMIC_LOOP = (0.03, 1.0), (0.05, 0.5)

LEAST_STRAIN = 0.10  # of the cycles
FREQUENCY, CYCLES = 0.1, 12
INTERVAL = 0.033  # s between rows of the cycles: never the same strains twice
SLOW_FREQUENCY, SLOW_INTERVAL = 0.01, 0.1  # Hz, s between rows of the other tests
BREAK_RATE = 0.015  # strain a second
LOAD_NOISE, POSITION_NOISE = 4.0, 0.015  # lbf, in
HEADER = "# synthetic, no hose was pulled: see README.md and generate.py in this folder\n"

Curve = tuple[np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Hose:
    """A hose as it is built, in inches, pounds-force and degrees."""

    wrap_angle: float
    cord_factor: float = 1.0

    def cord_stretch(self, stretch: np.ndarray) -> np.ndarray:
        """Stretch ratio of the cords (step 2)."""
        cos, sin = np.cos(np.radians(self.wrap_angle)), np.sin(np.radians(self.wrap_angle))
        return np.sqrt((stretch * cos) ** 2 + sin**2 / stretch)

    def cord_load(self, stretch: np.ndarray) -> np.ndarray:
        """Load of one cord [lbf]; nothing beyond its break."""
        strain = self.cord_stretch(stretch) - 1
        load = self.cord_factor * np.polynomial.polynomial.polyval(strain, (0.0, *CORD))
        return np.where((strain > 0) & (strain <= CORD_BREAK_STRAIN + 1e-12), load, 0.0)

    def rubber_tension(self, stretch: np.ndarray) -> np.ndarray:
        """Tension of the wall [lbf]."""
        area = np.pi / 4 * (OUTER_DIAMETER**2 - INNER_DIAMETER**2)
        return area * RUBBER_MODULUS / 3 * (stretch - stretch**-2)

    def tension(self, strain: np.ndarray) -> np.ndarray:
        """Tension [lbf] at strains of the whole length (step 4)."""
        h = stretch_of(strain)
        cos, sin = np.cos(np.radians(self.wrap_angle)), np.sin(np.radians(self.wrap_angle))
        rate = (h * cos**2 - sin**2 / (2 * h**2)) / self.cord_stretch(h)
        cord_length = 2 * np.pi * WRAP_DIAMETER * CORDS_PER_LENGTH
        return cord_length * self.cord_load(h) * rate + self.rubber_tension(h)

    def fill_pressure(self, strain: np.ndarray) -> np.ndarray:
        """Of the water above that outside [psi] (step 5)."""
        h = stretch_of(strain)
        sin = np.sin(np.radians(self.wrap_angle))
        tension = CORDS_PER_LENGTH * self.cord_load(h) * sin**2
        return 4 * tension / (self.cord_stretch(h) * h * WRAP_DIAMETER)

    def strain_at(self, cord_stretch: float) -> float:
        """Strain of the whole length at which the cords, after any slack, are this long.

        Above the neutral angle the cords shorten first: the search begins where they are shortest.
        """
        low = max(1.0, (np.tan(np.radians(self.wrap_angle)) ** 2 / 2) ** (1 / 3))
        high = 6.0
        for _ in range(80):
            middle = (low + high) / 2
            is_below = self.cord_stretch(np.array(middle)) < cord_stretch
            low, high = (middle, high) if is_below else (low, middle)
        return float((low - 1) * (1 - DEAD_LENGTH / LENGTH))

    def working_strain(self) -> float:
        """Strain of the whole length at the working load of the cords."""
        load = WORKING_SHARE * CORD_BREAK_LOAD / self.cord_factor
        grid = np.linspace(0, CORD_BREAK_STRAIN, 260_001)
        curve = np.polynomial.polynomial.polyval(grid, (0.0, *CORD))
        return self.strain_at(1 + float(np.interp(load, curve, grid)))


def stretch_of(strain: np.ndarray) -> np.ndarray:
    """Stretch ratio of the part that stretches; the dead ends keep their length."""
    return 1 + np.asarray(strain) / (1 - DEAD_LENGTH / LENGTH)


def leg(
    hose: Hose, strain: np.ndarray, start: float, end: float, loop: tuple[float, float]
) -> np.ndarray:
    """Tension on the way from one turn to the next.

    It is T (1 + k) on the way up and T (1 - k) on the way down with one k at each strain, so
    that half their sum is T.
    """
    share, power = loop
    place = np.clip((2 * strain - start - end) / (end - start), -1, 1)
    sign = 1 if end > start else -1
    return hose.tension(strain) * (1 + sign * share * (1 - place**2) ** power)


def rest(hose: Hose, strain: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Strain and tension of a standstill."""
    held = np.full(n, strain)
    return held, hose.tension(held)


def ramp(
    hose: Hose, start: float, end: float, n: int, loop: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Strain and tension of a leg at a constant rate, both turns between two rows."""
    strain = start + (end - start) * (np.arange(n) + 0.37) / n
    return strain, leg(hose, strain, start, end, loop)


def joined(parts: list[tuple[np.ndarray, np.ndarray]], interval: float) -> Curve:
    """Time, strain and tension of parts that follow one another."""
    strain = np.concatenate([part[0] for part in parts])
    return np.arange(strain.size) * interval, strain, np.concatenate([part[1] for part in parts])


def slow_pull(name: str) -> Curve:
    """Slack, up to the working load and back at 0.01 Hz, slack."""
    hose = Hose(WRAP_ANGLE[name])
    top = hose.working_strain()
    n = round(0.5 / SLOW_FREQUENCY / SLOW_INTERVAL)
    slack = rest(hose, 0.0, round(10 / SLOW_INTERVAL))
    up = ramp(hose, 0.0, top, n, STATIC_LOOP)
    down = ramp(hose, top, 0.0, n, STATIC_LOOP)
    return joined([slack, up, down, slack], SLOW_INTERVAL)


def slow_loops(name: str) -> Curve:
    """The same three times over without a stop."""
    hose = Hose(WRAP_ANGLE[name])
    top = hose.working_strain()
    n = round(0.5 / SLOW_FREQUENCY / SLOW_INTERVAL)
    slack = rest(hose, 0.0, round(10 / SLOW_INTERVAL))
    cycle = [ramp(hose, 0.0, top, n, STATIC_LOOP), ramp(hose, top, 0.0, n, STATIC_LOOP)]
    return joined([slack, *cycle * 3, slack], SLOW_INTERVAL)


def cycles(name: str) -> Curve:
    """Slack, to the least strain, a stop, sines to the working load of the cords, slack."""
    hose = Hose(WRAP_ANGLE[name], DYNAMIC_FACTOR)
    top = hose.working_strain()
    slack = rest(hose, 0.0, round(10 / INTERVAL))
    approach = ramp(hose, 0.0, LEAST_STRAIN, round(10 / INTERVAL), DYNAMIC_LOOP)
    stop = rest(hose, LEAST_STRAIN, round(5 / INTERVAL))
    phase = (np.arange(round(CYCLES / FREQUENCY / INTERVAL)) + 0.37) * INTERVAL * FREQUENCY
    strain = LEAST_STRAIN + (top - LEAST_STRAIN) * (1 - np.cos(2 * np.pi * phase)) / 2
    up = leg(hose, strain, LEAST_STRAIN, top, DYNAMIC_LOOP)
    down = leg(hose, strain, top, LEAST_STRAIN, DYNAMIC_LOOP)
    cycling = strain, np.where(phase % 1 < 0.5, up, down)
    back = ramp(hose, LEAST_STRAIN, 0.0, round(10 / INTERVAL), DYNAMIC_LOOP)
    return joined([slack, approach, stop, cycling, stop, back, slack], INTERVAL)


def pull_to_break(name: str) -> Curve:
    """Slack, up to the break of all cords at once, and the rubber alone held there."""
    hose = Hose(WRAP_ANGLE[name])
    top = hose.strain_at(1 + CORD_BREAK_STRAIN)
    up = ramp(hose, 0.0, top, round(top / BREAK_RATE / SLOW_INTERVAL), STATIC_LOOP)
    bare = np.full(round(5 / SLOW_INTERVAL), top)
    broken = bare, hose.rubber_tension(stretch_of(bare))
    return joined([rest(hose, 0.0, round(10 / SLOW_INTERVAL)), up, broken], SLOW_INTERVAL)


LOGS: dict[str, tuple[Callable[[str], Curve], str]] = {
    "S-64": (slow_pull, "64"),
    "L-64": (slow_loops, "64"),
    "D-64": (cycles, "64"),
    "B-64": (pull_to_break, "64"),
    "S-68": (slow_pull, "68"),
    "L-68": (slow_loops, "68"),
    "D-68": (cycles, "68"),
}


def write_log(path: Path, curve: Curve, noise: np.random.Generator) -> None:
    """Write one log with the noise of its channels."""
    time, strain, load = curve
    position = LENGTH * (1 + strain) + noise.normal(0, POSITION_NOISE, time.size)
    load = load + noise.normal(0, LOAD_NOISE, time.size)
    rows = [f"{t:.3f},{x:.3f},{f:.1f}" for t, x, f in zip(time, position, load, strict=True)]
    text = HEADER + "time_s,flange_to_flange_in,load_lbf\n" + "\n".join(rows) + "\n"
    path.write_text(text, encoding="utf-8", newline="\n")


def write_table(path: Path, columns: dict[str, list[str]]) -> None:
    """Write one table of the truth."""
    rows = [columns, *zip(*columns.values(), strict=True)]
    text = "\n".join(",".join(row) for row in rows)
    path.write_text(HEADER + text + "\n", encoding="utf-8", newline="\n")


def written(values: np.ndarray) -> list[str]:
    """Numbers as text."""
    return [f"{value:.8g}" for value in values]


def curve_table(name: str) -> dict[str, list[str]]:
    """The line between the branches, slow and at 0.1 Hz, up to the break of the cords."""
    slow, fast = Hose(WRAP_ANGLE[name]), Hose(WRAP_ANGLE[name], DYNAMIC_FACTOR)
    strain = np.arange(0, slow.strain_at(1 + CORD_BREAK_STRAIN), 0.01)
    stretch = stretch_of(strain)
    return {
        "strain": [f"{value:.2f}" for value in strain],
        "cord_strain": written(slow.cord_stretch(stretch) - 1),
        "rubber_tension_lbf": written(slow.rubber_tension(stretch)),
        "cord_tension_lbf": written(slow.cord_load(stretch)),
        "tension_lbf": written(slow.tension(strain)),
        "fill_pressure_psi": written(slow.fill_pressure(strain)),
        "dynamic_cord_tension_lbf": written(fast.cord_load(stretch)),
        "dynamic_tension_lbf": written(fast.tension(strain)),
    }


def hose_table() -> dict[str, list[str]]:
    """As built, and where the cords pick up, work and break; and what the curve is then."""
    columns: dict[str, list[str]] = {"hose": [f"hose-{name}" for name in WRAP_ANGLE]}
    numbers: dict[str, list[float]] = {}
    for angle in WRAP_ANGLE.values():
        slow, fast = Hose(angle), Hose(angle, DYNAMIC_FACTOR)
        found = {
            "wrap_angle_deg": angle,
            "rubber_modulus_psi": RUBBER_MODULUS,
            "wrap_diameter_in": WRAP_DIAMETER,
            "inner_diameter_in": INNER_DIAMETER,
            "outer_diameter_in": OUTER_DIAMETER,
            "cords_per_length_per_in": CORDS_PER_LENGTH,
            "length_in": LENGTH,
            "dead_length_in": DEAD_LENGTH,
            "cord_load_scale_slow": 1.0,
            "cord_load_scale_dynamic": DYNAMIC_FACTOR,
        }
        for event, hose, strain in (
            ("pick_up", slow, slow.strain_at(1.0)),
            ("working", slow, slow.working_strain()),
            ("dynamic_working", fast, fast.working_strain()),
            ("break", slow, slow.strain_at(1 + CORD_BREAK_STRAIN)),
        ):
            found[f"{event}_strain"] = strain
            found[f"{event}_tension_lbf"] = float(hose.tension(np.array(strain)))
        for key, value in found.items():
            numbers.setdefault(key, []).append(value)
    return columns | {key: written(np.array(values)) for key, values in numbers.items()}


def cord_table() -> dict[str, list[str]]:
    """Points of the cord curve as a laboratory would give them."""
    strain = np.linspace(0, CORD_BREAK_STRAIN, 14)
    load = np.polynomial.polynomial.polyval(strain, (0.0, *CORD))
    return {"strain": [f"{x:.2f}" for x in strain], "load_lbf": [f"{x:.2f}" for x in load]}


def main(folder: Path) -> None:
    """Write every log and the truth."""
    truth = folder / "truth"
    truth.mkdir(parents=True, exist_ok=True)
    noise = np.random.Generator(np.random.PCG64(200406))
    for name, (curve, hose) in LOGS.items():
        write_log(folder / f"{name}.csv", curve(hose), noise)
    write_table(truth / "hoses.csv", hose_table())
    write_table(truth / "cord.csv", cord_table())
    for hose in WRAP_ANGLE:
        write_table(truth / f"curve_{hose}.csv", curve_table(hose))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)

"""Family A: tethers with splices, in position control, two side by side on one crosshead."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from strangers.campaign import KEYS, Inline, Truth, make_document, write_log, write_toml
from strangers.cycles import (
    UNITS,
    common_grid,
    find_branches,
    loop_measures,
    refine_turns,
    tangents,
)
from strangers.instruments import SI, Channel, ErrorBook, Statement, rounded
from strangers.materials import Array, Rubber, draw_rubber

FOOT = SI["ft"]
SPLICES = (
    "tension", "ratio", "mixture", "saturating", "stiffening", "hyperbolic", "slip-sudden",
    "slip-slow",
)  # fmt: skip
TARGETS = [
    (0.75, 0.25),
    (1.0, 0.25),
    (1.0, 0.5),
    (1.25, 0.25),
    (1.5, 0.25),
    (1.5, 0.5),
    (2.0, 0.25),
    (2.25, 0.25),
]


@dataclass(frozen=True)
class Splice:
    """Strain of one splice against the strain of the free length and the tension."""

    law: str
    length: float  # at rest [m]
    at_one: float  # splice strain at the free strain 1 (or the reference tension)
    exponent: float = 1.0
    share: float = 0.0  # of the tension-driven part in a mixture
    bend: float = 1.0  # strain of saturation or stiffening
    reference_tension: float = 1.0  # [N]
    slow_slip: float = 0.0  # [m/s] at the reference tension
    friction: float = 0.0  # of the tension, by which what the splice feels may lag either way

    def strain(self, free: Array, tension: Array) -> Array:
        """Strain of the splice without slip."""
        free = np.asarray(free, dtype=float)
        weight = {"tension": 1.0, "hyperbolic": 1.0, "mixture": self.share}.get(self.law, 0.0)
        # a power of every sample is what takes long, and is asked for only where it counts
        driven = self._driven(tension) if weight > 0.0 else np.zeros_like(free)
        follow = free
        if self.law == "saturating":
            follow = np.expm1(-free / self.bend) / np.expm1(-1.0 / self.bend)
        elif self.law == "stiffening":
            follow = free * (1.0 + (free / self.bend) ** 2) / (1.0 + self.bend**-2)
        total: Array = self.at_one * (weight * driven + (1.0 - weight) * follow)
        return total

    def _driven(self, tension: Array) -> Array:
        reduced = np.maximum(tension, 0.0) / self.reference_tension
        if self.law == "hyperbolic":
            return np.asarray(reduced / (reduced + self.bend) * (1.0 + self.bend))
        toe = 5e-4
        return np.asarray((reduced + toe) ** self.exponent - toe**self.exponent)


@dataclass(frozen=True)
class Specimen:
    """A tether: rubber, diameter, lengths at rest, two splices."""

    name: str
    rubber: Rubber
    diameter: float
    free_length: float
    near: Splice
    far: Splice

    @property
    def area(self) -> float:
        """Area at zero tension."""
        return float(np.pi / 4.0 * self.diameter**2)

    @property
    def length(self) -> float:
        """Thimble to thimble at rest, before any slip."""
        return self.free_length + self.near.length + self.far.length


@dataclass
class State:
    """Exact history of one specimen in one test."""

    strain: Array
    tension: Array
    near: Array  # length [m]
    far: Array
    near_slip: Array
    far_slip: Array


def _felt(tension: Array, friction: float) -> Array:
    """Tension that a splice with friction feels: play, as wide as a share of the tension."""
    if friction == 0.0:
        return tension
    felt, out = 0.0, []
    low, high = (tension / (1.0 + friction)).tolist(), (tension / (1.0 - friction)).tolist()
    for least, most in zip(low, high, strict=True):
        felt = least if felt < least else min(felt, most)
        out.append(felt)
    return np.array(out)


def _slow_slip(splice: Splice, tension: Array, time_step: float) -> Array:
    if splice.slow_slip == 0.0:
        return np.zeros_like(tension)
    rate = splice.slow_slip * (np.maximum(tension, 0.0) / splice.reference_tension) ** 2
    return np.concatenate(([0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1])))) * time_step


def solve(
    specimen: Specimen,
    time_step: float,
    crosshead: Array,
    slip: tuple[float, float],
    steps: tuple[Array, Array],
) -> State:
    """Histories of strain and tension under a crosshead history.

    ``slip`` is what each splice has slipped before this test, ``steps`` its sudden slips now.
    The balance of lengths is iterated to rounding error; the rubber is integrated in time.
    """
    near, far, free = specimen.near, specimen.far, specimen.free_length
    length = np.maximum(crosshead, specimen.length + slip[0] + slip[1])
    strain = np.maximum(length - specimen.length - slip[0] - slip[1], 0.0) / (1.3 * free)
    gain = np.ones_like(strain)
    worst = np.inf
    for turn in range(200):
        tension = np.maximum(specimen.area * specimen.rubber.stress(time_step, strain), 0.0)
        slips = [
            before + step + _slow_slip(splice, tension, time_step)
            for before, step, splice in zip(slip, steps, (near, far), strict=True)
        ]
        felt = _felt(tension, near.friction)
        lengths = [
            splice.length * (1.0 + splice.strain(strain, felt)) + moved
            for splice, moved in zip((near, far), slips, strict=True)
        ]
        residual = (length - lengths[0] - lengths[1]) / free - 1.0 - strain
        last, worst = worst, float(np.max(np.abs(residual)))
        if worst < 2e-15 or (worst < 1e-12 and worst > 0.5 * last):
            break
        if turn < 4:
            small = 1e-6
            rise = specimen.area * specimen.rubber.instant_slope(strain) * small
            gain = np.ones_like(strain) + sum(
                splice.length
                / free
                * (splice.strain(strain + small, tension + rise) - splice.strain(strain, tension))
                / small
                for splice in (near, far)
            )
        strain = strain + residual / gain
    if worst > 1e-10:
        raise ArithmeticError(f"balance of lengths: residual {worst:.1e}")
    return State(strain, tension, lengths[0], lengths[1], slips[0], slips[1])


def draw_specimen(
    rng: np.random.Generator,
    name: str,
    splice: str,
    hysteresis: str,
    length: float,
    friction: float = 0.0,
) -> Specimen:
    """Draw a tether of a given length between thimbles at rest."""
    diameter = rng.uniform(0.90, 1.08) * SI["in"]
    rubber = draw_rubber(rng, hysteresis, rng.uniform(0.5, 0.8) * 1e6)
    lengths = rng.uniform(1.7, 2.1, 2) * FOOT
    reference = float(rubber.curve.stress(np.array(1.0))) * np.pi / 4.0 * diameter**2
    at_one = rng.uniform(0.13, 0.24)
    # a splice that slips follows one of the plain laws
    law = str(rng.choice(["tension", "ratio"])) if splice.startswith("slip") else splice
    base = Splice(
        law=law,
        length=0.0,
        at_one=0.0,
        exponent=rng.uniform(0.6, 1.25),
        share=rng.uniform(0.4, 0.6),
        bend=rng.uniform(1.2, 3.0) if law == "saturating" else rng.uniform(1.8, 3.5),
        reference_tension=float(reference),
        slow_slip=rng.uniform(0.8, 3.0) * 1e-5 * FOOT if splice == "slip-slow" else 0.0,
        friction=friction,
    )
    near, far = (
        replace(base, length=float(part), at_one=at_one * rng.uniform(0.92, 1.08))
        for part in lengths
    )
    if law == "hyperbolic":  # unlike ends
        near, far = (
            replace(near, bend=rng.uniform(0.15, 0.3)),
            replace(far, bend=rng.uniform(0.4, 0.8)),
        )
    free = length - near.length - far.length
    return Specimen(name, rubber, float(diameter), float(free), near, far)


@dataclass
class Plan:
    """Crosshead history of one test on the fine grid."""

    crosshead: Array
    turns: list[int]
    holds: dict[str, tuple[int, int]]  # samples of each hold
    cycling: tuple[int, int]


def plan_test(
    rng: np.random.Generator,
    levels: tuple[float, float, float, float],
    cycles: int,
    speed: float,
    time_step: float,
    waveform: str,
) -> Plan:
    """Slack, min, centre, max with holds, then cycles, then slack again.

    ``levels`` are crosshead lengths at slack, min, centre and max.
    """
    slack, low, centre, high = levels
    pieces: list[Array] = []
    holds: dict[str, tuple[int, int]] = {}
    count = 0

    def hold(position: float, seconds: float, name: str = "") -> None:
        nonlocal count
        size = round(seconds / time_step)
        pieces.append(np.full(size, position))
        if name:
            holds[name] = (count, count + size - 1)
        count += size

    def move(start: float, end: float, rate: float, smooth: bool = False) -> None:
        nonlocal count
        size = max(round(abs(end - start) / rate / time_step), 2)
        share = np.arange(size) / size
        if smooth:
            share = 0.5 - 0.5 * np.cos(np.pi * share)
        pieces.append(start + (end - start) * share)
        count += size

    slow = speed * rng.uniform(0.3, 1.0)
    hold(slack, rng.uniform(12, 25), "slack")
    move(slack, low, slow)
    hold(low, rng.uniform(20, 45), "min")
    move(low, centre, slow)
    hold(centre, rng.uniform(20, 45), "centre")
    move(centre, high, slow)
    hold(high, rng.uniform(40, 110), "max")
    from_min = bool(rng.random() < 0.5)
    sine = waveform == "sinusoidal"
    start = low if from_min else centre
    move(high, start, slow)
    hold(start, rng.uniform(2, 15))
    first = count
    turns = [count]
    if not from_min:
        move(centre, high, speed)
        turns.append(count)
        move(high, low, speed, sine)
        turns.append(count)
    for _ in range(cycles - (0 if from_min else 1)):
        move(low, high, speed, sine)
        turns.append(count)
        move(high, low, speed, sine)
        turns.append(count)
    last = count
    hold(low, rng.uniform(1, 4))
    move(low, slack, slow)
    hold(slack, rng.uniform(8, 15))
    crosshead = np.concatenate(pieces)
    if not sine and rng.random() < 0.5:  # the drive rounds its corners a little
        width = 2 * round(rng.uniform(0.02, 0.08) / time_step) + 1
        padded = np.pad(crosshead, width // 2, mode="edge")
        total = np.concatenate(([0.0], np.cumsum(padded)))
        crosshead = (total[width:] - total[:-width]) / width
    return Plan(crosshead, turns, holds, (first, last))


def _sudden(rng: np.random.Generator, plan: Plan, time_step: float, active: bool) -> Array:
    """Draw steps of slip, each within about .3 s, between the centre hold and the last cycle."""
    size = plan.crosshead.size
    out = np.zeros(size)
    if not active:
        return out
    time = np.arange(size) * time_step
    begin = plan.holds["centre"][1] * time_step
    end = plan.cycling[1] * time_step
    for _ in range(int(rng.integers(1, 4))):
        moment = rng.uniform(begin + 1.0, end - 2.0)
        ease = np.clip((time - moment) / 0.3, 0.0, 1.0)
        out += rng.uniform(0.005, 0.03) * FOOT * ease**2 * (3.0 - 2.0 * ease)
    return out


@dataclass(frozen=True)
class Bench:
    """The machine and the logger: channels, tape, rates and what is stated of them."""

    unit: str
    rate: float
    fine: int
    position: Channel
    tension: tuple[Channel, Channel]
    drift: tuple[float, float]  # stated offset in SI where the cells drift, else 0
    lag: float
    tape_scatter: float  # in the unit of the tape
    tape_step: float
    tape_unit: str


def draw_bench(
    rng: np.random.Generator, book: ErrorBook, drift: bool, play: bool
) -> tuple[Bench, dict[str, Any]]:
    """Draw the bench; return it with the table [uncertainty]."""
    us = bool(rng.random() < 0.6)
    unit, force = ("ft", "lbf") if us else ("m", "N")
    foot, pound = FOOT / SI[unit], SI["lbf"] / SI[force]
    position_gain = Statement(rounded(rng.uniform(0.03, 0.1), 2), "%")
    position_offset = Statement(rounded(rng.uniform(0.002, 0.006) * foot, 2), unit)
    tension_gain = Statement(rounded(rng.uniform(0.3, 0.8), 2), "%", "expanded")
    tension_offset = Statement(rounded(rng.uniform(0.2, 0.6) * pound, 2), force)
    lag = (
        Statement(rounded(rng.uniform(5, 30), 2), "ms", "half_width", one_sided=True)
        if rng.random() < 0.5
        else Statement(rounded(rng.uniform(3, 15), 2), "ms", one_sided=True)
    )
    lag_drawn = book.draw("lag", lag)
    while lag_drawn > 0.030:
        lag_drawn = book.draw("lag", lag)
    width = rng.uniform(0.002, 0.01) * FOOT if play else 0.0
    position = Channel(
        unit,
        noise=rng.uniform(0.001, 0.004) * foot,
        quantum=rounded(float(rng.choice([0.0122, 0.003, 0.001])) * foot, 4),
        gain_error=book.draw("crosshead_position.gain", position_gain),
        offset_error=book.draw("crosshead_position.offset", position_offset),
        play=width,
    )
    cells = []
    noise = rng.uniform(0.1, 0.3) * pound
    quantum = rounded(float(rng.choice([0.244, 0.06])) * pound, 3)
    share = 0.5**0.5 if drift else 1.0
    for place in ("1", "2"):
        gain = book.draw(f"tension.{place}.gain", tension_gain)
        error = book.draw(f"tension.{place}.offset", tension_offset) * share
        book.note(f"tension.{place}.offset", tension_offset, error / SI[force])
        cells.append(Channel(force, noise, quantum, gain, error))
    limit = tension_offset.standard * SI[force] * 0.5**0.5 if drift else 0.0
    tape_step = float(rng.choice([0.01, 0.005])) if us else float(rng.choice([0.002, 0.001]))
    scatter = rng.uniform(0.0015, 0.005) * foot
    tape = Statement(rounded((scatter**2 + tape_step**2 / 12.0) ** 0.5 * 1.005, 3), unit)
    book.note("tape", tape, scatter)
    bench = Bench(
        unit=unit,
        rate=float(rng.choice([10.0, 12.5, 16.0, 20.0])),
        fine=10,
        position=position,
        tension=(cells[0], cells[1]),
        drift=(limit, limit),
        lag=lag_drawn,
        tape_scatter=scatter,
        tape_step=tape_step,
        tape_unit=unit,
    )
    table: dict[str, Any] = {
        "lag": lag.toml(),
        "tension": {"gain": tension_gain.toml(), "offset": tension_offset.toml()},
        "crosshead_position": {"gain": position_gain.toml(), "offset": position_offset.toml()},
    }
    if KEYS["tape"]:
        table = {KEYS["tape"]: tape.toml(), **table}
    return bench, table


def _drift(rng: np.random.Generator, bench: Bench, place: int, size: int) -> Array | float:
    """Slow drift of a cell: a line and a slow wave, within the stated offset."""
    if bench.drift[place] == 0.0:
        return 0.0
    share = np.linspace(0.0, 1.0, size)
    wave = np.sin(2.0 * np.pi * (share * rng.uniform(0.3, 1.2) + rng.random()))
    line = rng.normal() * share + rng.normal() * 0.5 * wave
    return bench.drift[place] * line / 1.1


def steady_truth(
    specimen: Specimen, state: State, turns: list[int], time_step: float, moved: Array
) -> tuple[dict[str, Any], dict[str, Array]]:
    """Truth of the cycles after the first two of one test.

    ``moved`` are the sudden slips: branches in which one happens are left out of the curves
    (the rubber unloads and loads there), and such loops out of the means over the cycles.
    """
    planned, turns = turns, refine_turns(state.strain, turns)
    found = find_branches(state.strain, turns)
    loops = found.loops[2:]
    up, down = (
        [run for run in runs[2:] if moved[run[1]] == moved[run[0]]] or runs[2:]
        for runs in (found.ascending, found.descending)
    )
    grid = common_grid(state.strain, up + down)
    measures = loop_measures(state.strain, state.tension, loops, time_step)
    # the strain turns a step beside the crosshead, which is what keeps the time
    place = dict(zip(turns, planned, strict=True))
    measures["frequency"] = np.array([1 / (place[c] - place[a]) / time_step for a, _, c in loops])
    splice = state.near + state.far
    rest = specimen.near.length + specimen.far.length
    arrays: dict[str, Array] = {"strain": grid}
    for name, runs in (("ascending", up), ("descending", down)):
        slope, force = tangents(state.strain, state.tension, state.strain, runs, grid)
        _, extension = tangents(state.strain, splice, state.strain, runs, grid)
        arrays[f"{name}/tangent_modulus"] = slope.mean(axis=0) / specimen.area
        arrays[f"{name}/tangent_modulus_by_cycle"] = slope / specimen.area
        arrays[f"{name}/branch_tension"] = force.mean(axis=0)
        arrays[f"{name}/splice_strain"] = extension.mean(axis=0) / rest - 1.0
    for name, values in measures.items():
        arrays[f"cycles/{name}"] = values
    slipping = np.array([moved[last] != moved[first] for first, _, last in loops])
    arrays["cycles/slipping"] = slipping.astype(float)
    kept = ~slipping if not np.all(slipping) else np.ones_like(slipping)
    scalars: dict[str, Any] = {
        name: float(values[kept].mean()) for name, values in measures.items()
    }
    scalars |= {"n_steady_cycles": len(loops), "n_curves": [len(up), len(down)]}
    return scalars, arrays


def make(
    law: str,
    seed: int,
    folder: Path,
    *,
    splice: str,
    hysteresis: str,
    about: str,
    waveform: str = "drawn",
    drift: bool = False,
    play: bool = False,
    friction: float = 0.0,
    max_tests: int = 6,
) -> Truth:
    """Write a campaign of two tethers and return its truth.

    Parameters
    ----------
    splice, hysteresis
        names out of ``SPLICES``, and smooth, kinked or both.
    waveform
        triangular, sinusoidal, or drawn (two of three are triangular).
    drift, play
        slow drift of the load cells within their stated offset; backlash of the encoder.
    friction
        of the splices: play of what they feel, as a share of the tension, either way.
    max_tests
        with 3 or fewer, as many; one test has three marks.
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    book = ErrorBook(rng)
    bench, uncertainty = draw_bench(rng, book, drift, play)
    shape = waveform
    if waveform == "drawn":
        shape = "triangular" if rng.random() < 2.0 / 3.0 else "sinusoidal"
    length = rng.uniform(11.8, 12.8) * FOOT
    pair = [
        draw_specimen(rng, name, splice, hysteresis, length, friction) for name in ("new", "used")
    ]
    diameter = Statement(0.005, "in", "half_width")
    stated_diameters = []
    for specimen in pair:
        error = rng.uniform(-0.0045, 0.0045)
        stated_diameters.append(f"{specimen.diameter / SI['in'] + error:.3f} in")
        printed = float(stated_diameters[-1].split()[0])
        book.note(f"diameter.{specimen.name}", diameter, printed - specimen.diameter / SI["in"])

    count = int(rng.integers(3, max_tests + 1)) if max_tests > 3 else max_tests
    chosen = sorted(rng.choice(len(TARGETS), size=count, replace=False))
    targets = sorted((TARGETS[i] for i in chosen), key=lambda pair_: (sum(pair_), pair_))
    time_step = 1.0 / (bench.rate * bench.fine)
    truth = Truth(law, seed, "tether", about, errors=book.entries)
    truth.units = UNITS | {
        "strain": "1",
        "tangent_modulus": "Pa",
        "tangent_modulus_by_cycle": "Pa",
        "branch_tension": "N",
        "splice_strain": "1 (both splices together, slip included)",
        "lengths": "m",
        "marks": "true: time s, near_toe m, far_toe m, far_thimble m, free strain 1, tension N",
    }
    truth.constants = {
        "waveform": shape,
        "specimens": {
            s.name: {
                "diameter_m": s.diameter,
                "area_m2": s.area,
                "free_length_m": s.free_length,
                "near_splice_length_m": s.near.length,
                "far_splice_length_m": s.far.length,
                "near_splice": vars(s.near),
                "far_splice": vars(s.far),
                "rubber": s.rubber.constants(),
            }
            for s in pair
        },
    }
    tests: dict[str, Any] = {}
    marks: list[str] = []
    slips = [(0.0, 0.0), (0.0, 0.0)]
    lead = pair[0]
    for order, (mean, amplitude) in enumerate(targets, start=1):
        name = f"T-{order}"
        rest = min(s.length + sum(moved) for s, moved in zip(pair, slips, strict=True))
        levels = [rest]
        for target in (mean - amplitude, mean, mean + amplitude):
            e = np.array(target)
            force = lead.area * lead.rubber.curve.stress(e)
            parts = sum(x.length * (1.0 + x.strain(e, force)) for x in (lead.near, lead.far))
            levels.append(float(lead.free_length * (1.0 + e) + parts + sum(slips[0])))
        plan = plan_test(
            rng,
            (levels[0], levels[1], levels[2], levels[3]),
            int(rng.integers(8, 13)),
            rng.uniform(0.6, 1.2) * FOOT,
            time_step,
            shape,
        )
        size = plan.crosshead.size
        time = np.arange(size) * time_step
        sampled = np.arange(int(rng.integers(0, bench.fine)), size, bench.fine)
        logged = {
            "time_s": (time[sampled] - time[sampled[0]], 4),
            f"crosshead_{bench.unit}": (bench.position.read(plan.crosshead, rng)[sampled], 5),
        }
        moments = {
            hold: int(rng.uniform(first + 0.5 * (last - first), last))
            for hold, (first, last) in plan.holds.items()
        }
        truth.tests[name] = {}
        for place, specimen in enumerate(pair):
            sudden = splice == "slip-sudden"
            steps = tuple(_sudden(rng, plan, time_step, sudden) for _ in range(2))
            state = solve(specimen, time_step, plan.crosshead, slips[place], (steps[0], steps[1]))
            window = state.tension[plan.holds["min"][0] : plan.cycling[1]]
            if window.min() <= 0.0:
                raise ValueError(f"{law} seed {seed} {name}: slack in the cycles")
            cell = bench.tension[place]
            delayed = np.interp(time[sampled] - bench.lag, time, state.tension)
            seen = cell.read(delayed, rng, _drift(rng, bench, place, sampled.size))
            logged[f"load_{specimen.name}_{cell.unit}"] = (seen, 4)
            scalars, arrays = steady_truth(
                specimen, state, plan.turns, time_step, steps[0] + steps[1]
            )
            scalars |= {
                "free_length_m": specimen.free_length,
                "slip_before_m": list(slips[place]),
                "slip_after_m": [float(state.near_slip[-1]), float(state.far_slip[-1])],
                "marks": {},
            }
            for hold, index in moments.items():
                if hold == "slack":  # read along the tether, which may sag after a slip
                    points = [specimen.near.length + slips[place][0]]
                    points.append(points[0] + specimen.free_length)
                    points.append(points[1] + specimen.far.length + slips[place][1])
                    strain = 0.0
                else:
                    points = [float(state.near[index])]
                    strain = float(state.strain[index])
                    points.append(points[0] + specimen.free_length * (1.0 + strain))
                    points.append(points[1] + float(state.far[index]))
                pull = float(state.tension[index])
                moment = float(time[index] - time[sampled[0]])
                scalars["marks"][hold] = [moment, *points, strain, pull]
                scale = SI[bench.tape_unit]
                read = np.array(points) / scale + rng.normal(0.0, bench.tape_scatter, 3)
                read = np.round(read / bench.tape_step) * bench.tape_step
                row = ",".join(f"{value:.4f}" for value in read)
                marks.append(f"{name},{specimen.name},{hold},{row}")
            slips[place] = (float(state.near_slip[-1]), float(state.far_slip[-1]))
            truth.tests[name][specimen.name] = scalars
            for key, values in arrays.items():
                truth.arrays[f"{name}/{specimen.name}/{key}"] = values
        note = f"{law} {name}: crosshead [{bench.unit}], tensions, {bench.rate:g} Hz"
        write_log(folder / f"{name}.csv", logged, note)
        tests[name] = {
            "file": f"{name}.csv",
            "order": order,
            "target_strain": [mean - amplitude, mean + amplitude],
            "n_cycles": len(plan.turns) // 2,
        }
    head = ",".join(f"{x}_{bench.tape_unit}" for x in ("near_toe", "far_toe", "far_thimble"))
    text = f"test,specimen,hold,{head},note\n" + "".join(f"{m},synthetic\n" for m in marks)
    (folder / "marks.csv").write_text(text, encoding="utf-8")

    specimens = {
        s.name: {
            "kind": "rubber tether",
            "material": "rubber (synthetic)",
            "condition": s.name,
            "diameter": [stated],
            "rated_break_strength": "800 lbf",
        }
        for s, stated in zip(pair, stated_diameters, strict=True)
    }
    document = make_document(law, seed, about, specimens)
    position_u = f"{bench.position.standard_uncertainty:g} {bench.unit}"
    channels: dict[str, Any] = {
        "time": Inline(column="time_s", unit="s"),
        "crosshead_position": Inline(
            column=f"crosshead_{bench.unit}",
            unit=bench.unit,
            datum="pin-to-pin",
            standard_uncertainty=position_u,
        ),
        "tension": {
            str(place): Inline(
                column=f"load_{s.name}_{cell.unit}",
                unit=cell.unit,
                standard_uncertainty=f"{cell.standard_uncertainty:g} {cell.unit}",
            )
            for place, (s, cell) in enumerate(zip(pair, bench.tension, strict=True), start=1)
        },
    }
    document["layouts"] = {
        "logger": {"format": "delimited", "delimiter": ",", "comment": "#", "channels": channels}
    }
    document["uncertainty"] = {
        "lag": uncertainty["lag"],
        "diameter": diameter.toml(),
        **{key: value for key, value in uncertainty.items() if key != "lag"},
    }
    document["defaults"] = {
        "layout": "logger",
        "specimens": [s.name for s in pair],
        "kind": "cyclic",
        "control": "position",
        "waveform": shape,
        "medium": "dry",
        "machine": "generated",
        "strain": Inline(marks="marks.csv"),
    }
    document["tests"] = tests
    write_toml(folder / "campaign.toml", document)
    return truth

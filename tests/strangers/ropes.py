"""Family B: ropes in load control, one that creeps and lines of three parameters."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.signal import lfilter

from strangers.campaign import Inline, Truth, make_document, write_log, write_toml
from strangers.cycles import UNITS, common_grid, find_branches, loop_measures, tangents
from strangers.instruments import SI, Channel, ErrorBook, Statement, rounded
from strangers.materials import Array


def _stated(
    rng: np.random.Generator, book: ErrorBook, unit: str, full: float
) -> tuple[Channel, dict[str, Any]]:
    """Draw a load cell of a full scale [N] and the table [uncertainty.tension]."""
    scale = SI[unit]
    gain = Statement(rounded(rng.uniform(0.2, 0.8), 2), "%", "expanded")
    offset = Statement(rounded(full * rng.uniform(2e-4, 1e-3) / scale, 2), unit)
    cell = Channel(
        unit,
        noise=full * rng.uniform(1e-4, 5e-4) / scale,
        quantum=rounded(full * float(rng.choice([1e-5, 1e-4])) / scale, 2),
        gain_error=book.draw("tension.1.gain", gain),
        offset_error=book.draw("tension.1.offset", offset),
    )
    return cell, {"gain": gain.toml(), "offset": offset.toml()}


def _lag(rng: np.random.Generator, book: ErrorBook, largest: float) -> tuple[float, Any]:
    """Draw a lag of the tension channel [s]; the largest is in seconds."""
    if rng.random() < 0.5:
        size = rounded(rng.uniform(0.2, 1.0) * largest * 1e3, 2)
        statement = Statement(size, "ms", "half_width", one_sided=True)
    else:
        size = rounded(rng.uniform(0.1, 0.4) * largest * 1e3, 2)
        statement = Statement(size, "ms", one_sided=True)
    return book.draw("lag", statement), statement.toml()


def _layout(force: str, position: Channel, cell: Channel, extensometer: Channel) -> dict[str, Any]:
    """Layout of a log with time, length, strain and tension."""
    return {
        "logger": {
            "format": "delimited",
            "delimiter": ",",
            "comment": "#",
            "channels": {
                "time": Inline(column="time_s", unit="s"),
                "crosshead_position": Inline(
                    column="length_m",
                    unit="m",
                    datum="pin-to-pin",
                    standard_uncertainty=f"{position.standard_uncertainty:g} m",
                ),
                "tension": {
                    "1": Inline(
                        column=f"load_{force}",
                        unit=force,
                        standard_uncertainty=f"{cell.standard_uncertainty:g} {force}",
                    )
                },
                "strain": {
                    "1": Inline(
                        column="strain_pct",
                        unit="%",
                        standard_uncertainty=f"{extensometer.standard_uncertainty:g} %",
                    )
                },
            },
        }
    }


def _closed_form(
    apparent: Array, energy: Array, amplitude: Array, static: Array, frequency: Array
) -> tuple[Array, Array]:
    """K_1 and tau of the three-parameter line that has this K_ap, H and K_0."""
    loss = energy / (np.pi * amplitude**2)
    above = np.sqrt(np.maximum(apparent**2 - loss**2, 0.0)) - static
    omega = 2.0 * np.pi * frequency
    return (above**2 + loss**2) / above, above / loss / omega


# --------------------------------------------------------------------------- creeping rope


def _record_creep(strain: Array, loops: list[tuple[int, int, int]]) -> dict[str, float]:
    """Slope of the exact mean strain of the cycles against log10 of the cycle number."""
    middle = np.array([np.mean(strain[first:last]) for first, _, last in loops])
    decade = np.log10(np.arange(1, middle.size + 1))
    return {
        f"creep_per_decade_record_from_{first}": float(
            np.polyfit(decade[first - 1 :], middle[first - 1 :], 1)[0]
        )
        for first in (3, 10)
    }


def make_creeping(
    law: str,
    seed: int,
    folder: Path,
    *,
    about: str,
    steps: bool,
    waveform: str = "drawn",
) -> Truth:
    """Write one record of a creeping nylon-like rope at three mean loads.

    The strain is an elastic curve, K = K_a + K_b T, with two retarded (Kelvin-Voigt) elements
    and creep that goes with the logarithm of the cycles of each level.
    ``steps`` states the levels in campaign.toml; the same seed gives the same record without.
    """
    rng = np.random.default_rng([seed, sum(b"rope-creep")])
    book = ErrorBook(rng)
    size = rng.uniform(0.6, 1.5)
    secants = np.array([2.28, 2.62, 2.98]) * 1e6 * size * rng.uniform(0.98, 1.02, 3)
    strength = rng.uniform(0.9, 1.4) * 1e6 * size
    amplitude = rng.uniform(0.035, 0.06) * strength
    low_mean = rng.uniform(0.11, 0.15) * strength
    high_mean = rng.uniform(0.28, 0.34) * strength
    slope = (secants[2] - secants[0]) / (high_mean - low_mean)
    base = secants[0] - slope * low_mean
    means = (secants - base) / slope
    frequency = float(rng.choice([0.1, 0.125, 0.2, 0.25]))
    cycles = [int(n) for n in rng.integers(60, 101, 3)]
    rate = float(rng.choice([10.0, 16.0, 20.0]))
    fine = 10
    step = 1.0 / (rate * fine)
    half = round(0.5 / frequency / step)
    shape = waveform
    if waveform == "drawn":
        shape = str(rng.choice(["sinusoidal", "sinusoidal", "triangular"]))
    retarded = [
        (rng.uniform(0.02, 0.06), rng.uniform(0.1, 0.4) / frequency),
        (rng.uniform(0.01, 0.04), rng.uniform(0.5, 1.5) / frequency),
    ]
    creep = rng.uniform(0.0012, 0.003, 3)  # strain per decade of cycles

    pieces: list[Array] = [np.zeros(round(rng.uniform(5, 10) / step))]
    position = pieces[0].size
    here = 0.0
    turns: list[list[int]] = []
    spans: list[tuple[int, int]] = []
    for mean, count in zip(means, cycles, strict=True):
        low = mean - amplitude
        ramp = round(rng.uniform(8, 20) / step)
        pieces.append(here + (low - here) * np.arange(ramp) / ramp)
        position += ramp
        share = np.arange(half) / half
        if shape == "sinusoidal":
            share = 0.5 - 0.5 * np.cos(np.pi * share)
        up = low + 2.0 * amplitude * share
        down = low + 2.0 * amplitude * (1.0 - share)
        pieces.append(np.tile(np.concatenate((up, down)), count))
        turns.append([position + half * k for k in range(2 * count + 1)])
        spans.append((position, position + 2 * half * count))
        position += 2 * half * count
        here = low
    pieces.append(np.full(round(1.0 / step), here))
    tension = np.concatenate(pieces)
    time = np.arange(tension.size) * step

    strain = np.log1p(slope * tension / base) / slope
    for share_, retardation in retarded:
        ratio = step / retardation
        decay = np.exp(-ratio)
        weight_new = 1.0 - (1.0 - decay) / ratio
        weight_old = (1.0 - decay) / ratio - decay
        drive = tension * share_ / secants[1]
        follow, _ = lfilter([weight_new, weight_old], [1.0, -decay], drive, zi=[0.0])
        strain = strain + follow
    for (first, last), per_decade in zip(spans, creep, strict=True):
        done = np.clip((np.arange(tension.size) - first) / (2.0 * half), 0.0, None)
        done = np.minimum(done, (last - first) / (2.0 * half))
        strain = strain + per_decade * (np.log10(done + 0.5) - np.log10(0.5))

    length = rng.uniform(3.0, 8.0)
    diameter = (strength / 1.6e8 * 4.0 / np.pi) ** 0.5
    area = np.pi / 4.0 * diameter**2
    lag, lag_toml = _lag(rng, book, 0.005 / frequency)
    cell, tension_table = _stated(rng, book, "kN", 0.5 * strength)
    extensometer = Channel("%", rng.uniform(0.001, 0.004), 0.001)
    gauge = Channel("m", rng.uniform(1e-4, 3e-4), 1e-4)
    sampled = np.arange(int(rng.integers(0, fine)), tension.size, fine)
    start = time[sampled[0]]
    diameter_u = Statement(0.3, "mm", "half_width")
    stated_mm = round(diameter * 1e3 + rng.uniform(-0.25, 0.25), 2)
    book.note("diameter.line", diameter_u, stated_mm - diameter * 1e3)

    truth = Truth(law, seed, "rope", about, errors=book.entries)
    truth.units = UNITS | {
        "secant_spring_constant": "N, of the exact record, cycles after the first two",
        "secant_spring_constant_elastic": "N, of the elastic curve alone",
        "creep_per_decade": "strain per decade of cycles of the level (log10 of cycle number)",
        "creep_per_decade_record_from_N": "the same, fitted to the exact cycle means from cycle N",
        "tangent_spring_constant": "N, dT/d(strain) on the grid",
        "tangent_modulus": "Pa",
        "branch_tension": "N",
        "relative_strain": "1, from the mean strain of each cycle",
        "from, to": "s, time in the log",
    }
    truth.constants = {
        "K_a_N": base,
        "K_b": slope,
        "retarded_share_and_time_s": retarded,
        "creep_per_decade": creep,
        "mean_tensions_N": means,
        "tension_amplitude_N": amplitude,
        "frequency_Hz": frequency,
        "n_cycles": cycles,
        "rated_break_strength_N": strength,
        "area_m2": area,
        "waveform": shape,
    }
    truth.tests["R-1"] = {}
    for place, (points, (first, last)) in enumerate(zip(turns, spans, strict=True)):
        found = find_branches(tension, points)
        up, down, loops = found.ascending[2:], found.descending[2:], found.loops[2:]
        measures = loop_measures(strain, tension, loops, step)
        relative = strain.copy()
        for a, _, b in found.loops:
            middle = 0.5 * (strain[a : b + 1].max() + strain[a : b + 1].min())
            relative[a:b] = strain[a:b] - middle
        label = f"level {place + 1}"
        secant = measures["apparent_spring_constant"]
        ends = np.array([means[place] - amplitude, means[place] + amplitude])
        elastic = float(2.0 * amplitude / np.diff(np.log1p(slope * ends / base) / slope)[0])
        truth.tests["R-1"][label] = {
            **{name: float(values.mean()) for name, values in measures.items()},
            "secant_spring_constant": float(secant.mean()),
            "secant_spring_constant_elastic": elastic,
            "creep_per_decade": float(creep[place]),
            **_record_creep(strain, found.loops),
            "from": float(time[first] - start),
            "to": float(time[last] - start),
            "n_cycles": cycles[place],
        }
        for name, values in measures.items():
            truth.arrays[f"R-1/{label}/cycles/{name}"] = values
        grid = common_grid(tension, up + down, margin=0.004)
        truth.arrays[f"R-1/{label}/tension_grid"] = grid
        lined = common_grid(relative, [(a, b - 1) for a, b in up + down], margin=0.01)
        truth.arrays[f"R-1/{label}/relative_strain"] = lined
        for name, runs in (("ascending", up), ("descending", down)):
            stiffness, _ = tangents(tension, tension, strain, runs, grid)
            key = f"R-1/{label}/{name}"
            truth.arrays[f"{key}/tangent_spring_constant_at_tension"] = stiffness.mean(axis=0)
            short = [(a, b - 1) for a, b in runs]
            stiffness, force = tangents(relative, tension, relative, short, lined)
            truth.arrays[f"{key}/tangent_spring_constant"] = stiffness.mean(axis=0)
            truth.arrays[f"{key}/tangent_modulus"] = stiffness.mean(axis=0) / area
            truth.arrays[f"{key}/branch_tension"] = force.mean(axis=0)

    delayed = np.interp(time[sampled] - lag, time, tension)
    logged = {
        "time_s": (time[sampled] - start, 4),
        "length_m": (gauge.read(length * (1.0 + strain), rng)[sampled], 5),
        "strain_pct": (extensometer.read(strain, rng)[sampled], 4),
        "load_kN": (cell.read(delayed, rng), 4),
    }
    write_log(folder / "R-1.csv", logged, f"{law}: three mean loads in one record, {rate:g} Hz")
    specimen = {
        "line": {
            "kind": "rope",
            "material": "nylon (synthetic)",
            "diameter": [f"{stated_mm:g} mm"],
            "rated_break_strength": f"{strength / 1e3:.4f} kN",
        }
    }
    document = make_document(law, seed, about, specimen)
    document["layouts"] = _layout("kN", gauge, cell, extensometer)
    document["uncertainty"] = {
        "lag": lag_toml,
        "diameter": diameter_u.toml(),
        "tension": tension_table,
    }
    document["defaults"] = {
        "layout": "logger",
        "specimens": ["line"],
        "kind": "cyclic",
        "control": "load",
        "waveform": shape,
        "medium": "wet",
        "machine": "generated",
        "strain": Inline(method="extensometer"),
    }
    test: dict[str, Any] = {"file": "R-1.csv", "order": 1}
    if steps:
        test["steps"] = [
            {
                "name": f"level {place + 1}",
                "from": f"{time[first] - start:.2f} s",
                "to": f"{time[last] - start:.2f} s",
                "kind": "cyclic",
            }
            for place, (first, last) in enumerate(spans)
        ]
    document["tests"] = {"R-1": test}
    write_toml(folder / "campaign.toml", document)
    return truth


# ---------------------------------------------------------------- line of three parameters

BOX_BEHNKEN = [
    (-1, -1, 0),
    (1, -1, 0),
    (-1, 1, 0),
    (1, 1, 0),
    (-1, 0, -1),
    (1, 0, -1),
    (-1, 0, 1),
    (1, 0, 1),
    (0, -1, -1),
    (0, 1, -1),
    (0, -1, 1),
    (0, 1, 1),
]
FACTORS = {"frequency": (0.1, 0.5), "mean_tension": (12.0, 30.0), "tension_amplitude": (5.0, 12.0)}


def static_tension(strain: Array, c: dict[str, float]) -> Array:
    """Slow pull: dT/d(strain) = K_a + K_b T + K_c T^2 / strength, in closed form."""
    a, b, c2 = c["K_a"], c["K_b"], c["K_c"]
    root = np.sqrt(4.0 * a * c2 - b * b + 0j)
    angle = np.arctan(b / root) + root * strain / 2.0
    return np.real((root * np.tan(angle) - b) / (2.0 * c2))


def static_stiffness(tension: Array, c: dict[str, float]) -> Array:
    """K_0 at a tension."""
    return c["K_a"] + c["K_b"] * tension + c["K_c"] * tension**2


def line_constants(
    frequency: Array | float,
    mean: Array | float,
    amplitude: Array | float,
    c: dict[str, float],
) -> tuple[Array, Array]:
    """K_1 and tau of the law at a frequency, mean tension and tension amplitude."""
    load, swing = mean / c["strength"], amplitude / c["strength"]
    stiffness = np.asarray(c["K_1"]) * (
        1.0 + c["K_1_mean"] * (load - 0.21) + c["K_1_swing"] * (swing - 0.085)
    )
    time = c["tau"] * (np.asarray(frequency) / 0.3) ** -c["exponent"]
    return stiffness, time * (1.0 + c["tau_mean"] * (load - 0.21))


def _steady(
    frequency: Array,
    mean: Array,
    amplitude: Array,
    c: dict[str, float],
    cycles: int,
    size: int,
    start: Array | None = None,
) -> tuple[Array, Array]:
    """Integrate lines under sinusoidal load in the tension T_0(strain) as the unknown (RK4).

    With p = T_0(strain): K_0(p) = dp/d(strain), and (1 + K_1/K_0) dp/dt = dT/dt + (T - p)/tau.
    Returns tension and p, shape (samples, lines), from the valley of the load.
    """
    stiffness, tau = line_constants(frequency, mean, amplitude, c)
    omega = 2.0 * np.pi * frequency
    step = 1.0 / frequency / size

    def load(time: Array) -> tuple[Array, Array]:
        return mean - amplitude * np.cos(omega * time), amplitude * omega * np.sin(omega * time)

    def rate(time: Array, static: Array) -> Array:
        force, slope = load(time)
        return (slope + (force - static) / tau) / (1.0 + stiffness / static_stiffness(static, c))

    static = mean - amplitude / (1.0 + stiffness / static_stiffness(mean, c))
    if start is not None:
        static = start
    tensions, statics = [load(0.0 * frequency)[0]], [static]
    for k in range(cycles * size):
        time = k * step
        a = rate(time, static)
        b = rate(time + step / 2.0, static + step / 2.0 * a)
        d = rate(time + step / 2.0, static + step / 2.0 * b)
        e = rate(time + step, static + step * d)
        static = static + step / 6.0 * (a + 2.0 * b + 2.0 * d + e)
        tensions.append(load(time + step)[0])
        statics.append(static)
    return np.array(tensions), np.array(statics)


def static_strain(tension: Array, c: dict[str, float]) -> Array:
    """Strain of the slow pull at a tension."""
    a, b, c2 = c["K_a"], c["K_b"], c["K_c"]
    root = np.sqrt(4.0 * a * c2 - b * b + 0j)
    angle = np.arctan((2.0 * c2 * tension + b) / root) - np.arctan(b / root)
    return np.real(2.0 / root * angle)


def line_response(
    frequency: Array | float,
    mean: Array | float,
    amplitude: Array | float,
    c: dict[str, float],
) -> dict[str, Array]:
    """Truth at any point: K_ap, H of the steady cycle, K_0 at the mean, K_1, tau.

    K_1 and tau are the constants of the law (of one that is no such line: of the equivalent line);
    ``..._closed_form`` are those that K_ap, H and K_0 give.
    """
    frequency, mean, amplitude = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(x, dtype=float)) for x in (frequency, mean, amplitude))
    )
    static = static_stiffness(mean, c)
    if _is_linear(c):
        modulus = _complex_stiffness(frequency, mean, amplitude, c)
        apparent = np.abs(modulus)
        strain = amplitude / apparent
        energy = np.pi * amplitude * strain * np.sin(np.angle(modulus))
    else:
        slow = float(np.max(2.0 * np.pi * frequency * line_constants(frequency, mean, 0, c)[1]))
        cycles = int(np.ceil(8.0 * slow)) + 3
        _, statics = _steady(frequency, mean, amplitude, c, cycles, 100)
        force, statics = _steady(frequency, mean, amplitude, c, 1, 800, statics[-1])
        strains = static_strain(statics, c)
        strain = np.ptp(strains, axis=0) / 2.0
        apparent = amplitude / strain
        energy = np.trapezoid(force, strains, axis=0)
    first, time = _closed_form(apparent, energy, strain, static, frequency)
    out = {
        "apparent_spring_constant": apparent,
        "hysteresis_energy": energy,
        "quasi_static_spring_constant": static,
        "dissipation_spring_constant_closed_form": first,
        "relaxation_time_closed_form": time,
        "strain_amplitude": strain,
    }
    if _is_linear(c):
        out |= {"dissipation_spring_constant": first, "relaxation_time": time}
    else:
        law = line_constants(frequency, mean, amplitude, c)
        out |= {"dissipation_spring_constant": law[0], "relaxation_time": law[1]}
    return out


def _is_linear(c: dict[str, float]) -> bool:
    """Whether the law is a complex stiffness about the mean, and no line with one tau."""
    return c["loss_angle"] > 0.0 or "order" in c or "share_1" in c


def _complex_stiffness(
    frequency: Array | float, mean: Array | float, swing: Array | float, c: dict[str, float]
) -> Array:
    """Storage and loss stiffness about a mean tension, as one complex number.

    A constant loss angle (a power of the frequency, exact for that angle); a spring-pot in series
    with a spring, beside K_0 (fractional Zener); or three Maxwell elements beside K_0.
    """
    mean, swing, frequency = np.asarray(mean), np.asarray(swing), np.asarray(frequency)
    if c["loss_angle"] > 0.0:
        power = 2.0 * c["loss_angle"] / np.pi
        ratio = 1.0 + c["rise"] * (1.0 + c["K_1_swing"] * (swing / c["strength"] - 0.085))
        size = static_stiffness(mean, c) * ratio * (frequency / 0.3) ** power
        return size * np.exp(1j * c["loss_angle"])
    stiffness, tau = line_constants(0.3, mean, swing, c)
    turn = 2j * np.pi * frequency * tau
    if "order" in c:
        share = turn ** c["order"] / (1.0 + turn ** c["order"])
    else:
        share = sum(
            c[f"share_{k}"] * turn * c[f"time_{k}"] / (1.0 + turn * c[f"time_{k}"])
            for k in (1, 2, 3)
        )
    return static_stiffness(mean, c) + stiffness * share


def draw_line(rng: np.random.Generator, damping: str) -> dict[str, float]:
    """Draw the constants of a rope: damping is falling, constant, angle, fractional or spectrum."""
    strength = rng.uniform(2.5e4, 9e4)
    polyester = bool(rng.random() < 0.4)
    k_21 = strength * (rng.uniform(3.5, 6.0) if polyester else rng.uniform(1.6, 2.6))
    low = 0.75 if polyester else 0.35
    shares = np.array([low, rng.uniform(0.6, 0.9) * (1.0 - low)])
    c = {
        "strength": strength,
        "K_a": k_21 * shares[0],
        "K_b": k_21 * shares[1] / (0.21 * strength),
        "K_c": k_21 * (1.0 - shares.sum()) / (0.21 * strength) ** 2,
        "K_1": k_21 * rng.uniform(1.0, 2.2),
        "K_1_mean": rng.uniform(1.0, 3.0),
        "K_1_swing": rng.uniform(-3.0, 0.0),
        "tau": rng.uniform(0.5, 1.6),
        "tau_mean": rng.uniform(-1.0, 1.5),
        "exponent": rng.uniform(0.6, 1.0) if damping == "falling" else 0.0,
        "loss_angle": rng.uniform(0.06, 0.2) if damping == "angle" else 0.0,
        "rise": rng.uniform(0.8, 2.0),
    }
    if damping == "fractional":
        c["order"] = rng.uniform(0.25, 0.75)
    if damping == "spectrum":
        shares = rng.dirichlet((2.0, 2.0, 2.0))
        for k, share in enumerate(shares, start=1):
            c |= {f"share_{k}": share, f"time_{k}": 10.0 ** (k - 2 + rng.uniform(-0.3, 0.3))}
    return {name: float(value) for name, value in c.items()}


def _run_strain(
    time: Array, tension: Array, first: int, run: tuple[float, float, float], c: dict[str, float]
) -> Array:
    """Strain of one run whose cycles start at a sample, after a ramp to the mean load.

    In the ramp the line follows the same equation, with the constants of the run.
    """
    frequency, mean, swing = run
    step = time[1] - time[0]
    if _is_linear(c):
        modulus = complex(_complex_stiffness(frequency, mean, swing, c))
        strain = static_strain(np.minimum(tension, mean), c)
        phase = 2.0 * np.pi * frequency * (time[first:] - time[first])
        grow = np.clip(phase / (2.0 * np.pi) / 2.0, 0.0, 1.0)
        wave = np.sin(phase - np.angle(modulus)) * grow
        strain[first:] = float(static_strain(np.array(mean), c)) + swing / abs(modulus) * wave
        return strain
    k_1, tau = (float(x) for x in line_constants(frequency, mean, swing, c))
    static = np.zeros_like(tension)
    slopes = np.diff(tension) / step
    value = 0.0
    a, b, c2 = c["K_a"], c["K_b"], c["K_c"]
    for k, slope in enumerate(slopes.tolist()):
        force = float(tension[k])

        def rate(p: float, share: float, force: float = force, slope: float = slope) -> float:
            now = force + slope * share * step
            return float((slope + (now - p) / tau) / (1.0 + k_1 / (a + b * p + c2 * p * p)))

        one = rate(value, 0.0)
        two = rate(value + step / 2.0 * one, 0.5)
        three = rate(value + step / 2.0 * two, 0.5)
        four = rate(value + step * three, 1.0)
        value += step / 6.0 * (one + 2.0 * two + 2.0 * three + four)
        static[k + 1] = value
    return static_strain(static, c)


def make_line(
    law: str,
    seed: int,
    folder: Path,
    *,
    about: str,
    damping: str,
    n_cycles: int = 16,
    interior: int = 120,
) -> Truth:
    """Write a Box-Behnken set of runs and the slow pull of one rope.

    Parameters
    ----------
    damping
        falling (tau as f^-n, n in 0.6-1), constant (tau), angle (constant loss angle), fractional
        (a spring-pot of order 0.25-0.75) or spectrum (three relaxation times over two decades).
    interior
        number of random interior points with their truth (arrays ``interior/...``).
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    book = ErrorBook(rng)
    c = draw_line(rng, damping)
    force = str(rng.choice(["lbf", "N", "kN"]))
    strength_text = f"{c['strength'] / SI[force]:.5g} {force}"
    c["strength"] = float(strength_text.split()[0]) * SI[force]
    plan = list(BOX_BEHNKEN) + [(0, 0, 0)] * int(rng.integers(1, 4))
    mid = {name: (sum(span) / 2.0, (span[1] - span[0]) / 2.0) for name, span in FACTORS.items()}
    plan.sort(key=lambda code: (21 + 9 * code[1]) + (8.5 + 3.5 * code[2]))
    cell, tension_table = _stated(rng, book, force, 0.5 * c["strength"])
    extensometer = Channel("%", rng.uniform(0.001, 0.004), 0.001)
    gauge = Channel("m", rng.uniform(2e-5, 1e-4), 1e-5)
    lag, lag_toml = _lag(rng, book, 0.01)
    length = rng.uniform(1.4, 2.0)
    diameter = (c["strength"] / 1.8e8 * 4.0 / np.pi) ** 0.5
    diameter_u = Statement(0.2, "mm", "half_width")
    stated_mm = round(diameter * 1e3 + rng.uniform(-0.19, 0.19), 2)
    book.note("diameter.line-1", diameter_u, stated_mm - diameter * 1e3)

    truth = Truth(law, seed, "line", about, constants=c, errors=book.entries)
    truth.constants["area_m2"] = np.pi / 4.0 * diameter**2
    truth.units = UNITS | {
        "quasi_static_spring_constant": "N, at the mean tension",
        "dissipation_spring_constant": "N",
        "relaxation_time": "s",
        "..._closed_form": "from the true K_ap, H and K_0 by the equations of the line",
        "slow_pull": "tension N, K_0 N, strain",
        "interior": "frequency Hz, tensions N, then the responses",
    }

    def response(frequency: Array, mean: Array, amplitude: Array) -> dict[str, Array]:
        return line_response(frequency, mean, amplitude, c)

    truth.response = response
    tests: dict[str, Any] = {}
    runs: dict[str, list[int]] = {}
    for order, code in enumerate(plan, start=1):
        name = f"R{order:02d}"
        frequency, mean, swing = (
            mid[factor][0] + mid[factor][1] * x for factor, x in zip(FACTORS, code, strict=True)
        )
        mean, swing = mean / 100.0 * c["strength"], swing / 100.0 * c["strength"]
        rate = 20.0 if frequency < 0.2 else 40.0
        fine = 2
        step = 1.0 / (rate * fine)
        lead, ramp = round(3.0 / step), round(rng.uniform(6.0, 12.0) / step)
        count = round(n_cycles / frequency / step)
        phase = 2.0 * np.pi * frequency * np.arange(count) * step
        grow = np.clip(phase / (2.0 * np.pi) / 2.0, 0.0, 1.0)
        tension = np.concatenate(
            (np.zeros(lead), mean * np.arange(ramp) / ramp, mean + swing * np.sin(phase) * grow)
        )
        time = np.arange(tension.size) * step
        strain = _run_strain(time, tension, lead + ramp, (frequency, mean, swing), c)
        sampled = np.arange(0, tension.size, fine)
        delayed = np.interp(time[sampled] - lag, time, tension)
        logged = {
            "time_s": (time[sampled], 4),
            "length_m": (gauge.read(length * (1.0 + strain), rng)[sampled], 5),
            "strain_pct": (extensometer.read(strain, rng)[sampled], 4),
            f"load_{force}": (cell.read(delayed, rng), 4),
        }
        write_log(folder / f"{name}.csv", logged, f"{law} {name}, {rate:g} Hz")
        tests[name] = {"file": f"{name}.csv", "order": order, "n_cycles": n_cycles}
        runs[name] = list(code)
        point = response(np.array(frequency), np.array(mean), np.array(swing))
        truth.tests[name] = {
            "line-1": {
                "coded": list(code),
                "frequency": frequency,
                "mean_tension": mean,
                "tension_amplitude": swing,
                **{key: float(values[0]) for key, values in point.items()},
            }
        }
        truth.arrays[f"{name}/line-1/exact/strain"] = strain[sampled]
        truth.arrays[f"{name}/line-1/exact/tension"] = tension[sampled]
    top = 0.55 * c["strength"]
    end = float(static_strain(np.array(top), c))
    speed = rng.uniform(0.15, 0.35) / 60.0 / length  # strain a second: some inches a minute
    pull_step = max(0.1, round(end / speed / 3000.0, 1))
    pull = np.concatenate((np.zeros(30), np.arange(0.0, end, speed * pull_step)))
    tension = static_tension(pull, c)
    time = np.arange(pull.size) * pull_step
    logged = {
        "time_s": (time, 4),
        "length_m": (gauge.read(length * (1.0 + pull), rng), 5),
        "strain_pct": (extensometer.read(pull, rng), 4),
        f"load_{force}": (cell.read(tension, rng), 4),
    }
    write_log(folder / "Q01.csv", logged, f"{law} Q01: slow pull")
    truth.arrays["Q01/line-1/strain"] = pull
    truth.arrays["Q01/line-1/tension"] = tension
    truth.arrays["Q01/line-1/quasi_static_spring_constant"] = static_stiffness(tension, c)
    points = rng.uniform(-1.0, 1.0, (interior, 3))
    values = [mid[factor][0] + mid[factor][1] * points[:, k] for k, factor in enumerate(FACTORS)]
    inside = response(
        values[0], values[1] / 100.0 * c["strength"], values[2] / 100.0 * c["strength"]
    )
    truth.arrays["interior/frequency"] = values[0]
    truth.arrays["interior/mean_tension"] = values[1] / 100.0 * c["strength"]
    truth.arrays["interior/tension_amplitude"] = values[2] / 100.0 * c["strength"]
    truth.arrays |= {f"interior/{key}": column for key, column in inside.items()}

    specimen = {
        "line-1": {
            "kind": "rope",
            "material": "nylon or polyester (synthetic)",
            "diameter": [f"{stated_mm:g} mm"],
            "rated_break_strength": strength_text,
        }
    }
    document = make_document(law, seed, about, specimen)
    document["layouts"] = _layout(force, gauge, cell, extensometer)
    document["uncertainty"] = {
        "lag": lag_toml,
        "diameter": diameter_u.toml(),
        "tension": tension_table,
    }
    document["defaults"] = {
        "layout": "logger",
        "specimens": ["line-1"],
        "kind": "cyclic",
        "control": "load",
        "waveform": "sinusoidal",
        "medium": "wet",
        "machine": "generated",
        "strain": Inline(method="extensometer"),
    }
    slow = {"file": "Q01.csv", "order": len(plan) + 1, "kind": "quasi-static"}
    slow |= {"control": "position"}
    document["tests"] = tests | {"Q01": slow}
    document["experiments"] = {
        "line": {
            "kind": "box-behnken",
            "factors": {
                "frequency": ["0.1 Hz", "0.5 Hz"],
                "mean_tension": ["12 %RBS", "30 %RBS"],
                "tension_amplitude": ["5 %RBS", "12 %RBS"],
            },
            "runs": Inline(runs),
            "quasi_static": Inline({"line-1": "Q01"}),
            "responses": [
                "apparent_spring_constant",
                "hysteresis_energy",
                "dissipation_spring_constant",
                "relaxation_time",
            ],
        }
    }
    write_toml(folder / "campaign.toml", document)
    return truth

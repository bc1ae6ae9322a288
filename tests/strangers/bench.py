"""Families C, D and E: holds, loops as other laboratories measure them, and the load train."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from strangers.campaign import KEYS, Inline, Truth, make_document, write_log, write_toml
from strangers.cycles import UNITS, loop_measures
from strangers.instruments import SI, Channel, ErrorBook, Statement, rounded
from strangers.materials import Array, ElasticCurve, draw_curve


def _layout(
    position: Channel, cell: Channel, reference_length: float, extra: dict[str, Any] | None = None
) -> dict[str, Any]:
    """Layout of a log of time, displacement and tension."""
    channels = {
        "time": Inline(column="time_s", unit="s"),
        "crosshead_position": Inline(
            column=f"displacement_{position.unit}",
            unit=position.unit,
            datum="displacement",
            reference_length=f"{reference_length / SI[position.unit]:.6g} {position.unit}",
            standard_uncertainty=f"{position.standard_uncertainty:g} {position.unit}",
        ),
        "tension": {
            "1": Inline(
                column=f"load_{cell.unit}",
                unit=cell.unit,
                standard_uncertainty=f"{cell.standard_uncertainty:g} {cell.unit}",
            )
        },
    }
    logger = {"format": "delimited", "delimiter": ",", "comment": "#", **(extra or {})}
    return {"logger": logger | {"channels": channels}}


def _draw_errors(
    rng: np.random.Generator, book: ErrorBook, force: float, length: float, lag: float
) -> tuple[dict[str, float], dict[str, Any]]:
    """Draw gains, offsets and lag; ``force`` and ``length`` are full scales, ``lag`` in s."""
    statements = {
        "tension.gain": Statement(rounded(rng.uniform(0.2, 0.6), 2), "%", "expanded"),
        "tension.offset": Statement(rounded(force * rng.uniform(1e-4, 5e-4), 2), "N"),
        "crosshead_position.gain": Statement(rounded(rng.uniform(0.02, 0.1), 2), "%"),
        "crosshead_position.offset": Statement(
            rounded(length * rng.uniform(1e-5, 1e-4) * 1e3, 2), "mm"
        ),
        "lag": Statement(rounded(lag * 1e3, 2), "ms", one_sided=True),
    }
    drawn = {name: book.draw(name, statement) for name, statement in statements.items()}
    table = {
        "lag": statements["lag"].toml(),
        "tension": {
            "gain": statements["tension.gain"].toml(),
            "offset": statements["tension.offset"].toml(),
        },
        "crosshead_position": {
            "gain": statements["crosshead_position.gain"].toml(),
            "offset": statements["crosshead_position.offset"].toml(),
        },
    }
    return drawn, table


@dataclass
class Piece:
    """One specimen on the bench."""

    kind: str
    diameter: float
    length: float
    stated_diameter: str
    half_width: Statement

    @property
    def area(self) -> float:
        """Area at zero tension."""
        return float(np.pi / 4.0 * self.diameter**2)

    def table(self) -> dict[str, Any]:
        """Return the table [specimens.NAME]."""
        return {
            "kind": self.kind,
            "material": "elastomer (synthetic)",
            "diameter": [self.stated_diameter],
            "gauge_length": f"{self.length * 1e3:.6g} mm",
        }


def _draw_piece(
    rng: np.random.Generator, book: ErrorBook, kind: str, length: float, diameter: float
) -> Piece:
    width = rounded(diameter * 1e3 * rng.uniform(0.002, 0.006), 2)
    statement = Statement(width, "mm", "half_width")
    stated = round(diameter * 1e3 + rng.uniform(-0.9, 0.9) * width, 3)
    book.note("diameter.piece", statement, stated - diameter * 1e3)
    return Piece(kind, diameter, length, f"{stated:.3f} mm", statement)


def _finish(
    truth: Truth,
    folder: Path,
    piece: Piece,
    layouts: dict[str, Any],
    uncertainty: dict[str, Any],
    defaults: dict[str, Any],
    tests: dict[str, Any],
) -> Truth:
    document = make_document(truth.law, truth.seed, truth.about, {"piece": piece.table()})
    document["layouts"] = layouts
    document["uncertainty"] = {
        "lag": uncertainty["lag"],
        "diameter": piece.half_width.toml(),
        **{key: value for key, value in uncertainty.items() if key != "lag"},
    }
    document["defaults"] = {
        "layout": "logger",
        "specimens": ["piece"],
        "control": "position",
        "medium": "dry",
        "machine": "generated",
        "strain": Inline(method="gauge-length"),
        **defaults,
    }
    document["tests"] = tests
    write_toml(folder / "campaign.toml", document)
    truth.constants |= {
        "diameter_m": piece.diameter,
        "area_m2": piece.area,
        "reference_length_m": piece.length,
    }
    return truth


# --------------------------------------------------------------------------- C. holds


def _relax(time: Array, drive: Array, shares: Array, times: Array) -> tuple[Array, Array]:
    """Stress of a drive (elastic stress, linear between samples) and its branch states."""
    step = np.diff(time)
    ratio = step[:, None] / times
    decay, gain = np.exp(-ratio), -np.expm1(-ratio) / ratio
    push = np.diff(drive)[:, None] * gain * shares
    states = np.zeros((time.size, times.size))
    state = np.zeros(times.size)
    for k in range(step.size):
        state = decay[k] * state + push[k]
        states[k + 1] = state
    return (1.0 - shares.sum()) * drive + states.sum(axis=1), states


def make_hold(
    law: str, seed: int, folder: Path, *, about: str, back: bool = False, tether: bool = False
) -> Truth:
    """Write relaxation tests whose crosshead settles after the ramp.

    Parameters
    ----------
    back
        the crosshead runs over its target and settles back, instead of creeping up to it.
    tether
        a rubber tether with a stroke of metres that settles by .01-.1 % of it; otherwise a
        coupon whose crosshead settles by 5-50 micrometres.
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    book = ErrorBook(rng)
    length = rng.uniform(2.0, 4.0) if tether else rng.uniform(0.03, 0.12)
    diameter = rng.uniform(0.022, 0.028) if tether else rng.uniform(0.006, 0.015)
    kind = "rubber tether" if tether else "elastomer"
    piece = _draw_piece(rng, book, kind, length, diameter)
    curve = draw_curve(rng, rng.uniform(0.5, 1.5) * 1e6)
    terms = int(rng.integers(1, 4))
    shares = rng.uniform(0.25, 0.55) * rng.dirichlet(np.full(terms, 4.0))
    rate = float(rng.choice([1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]))
    duration = float(min(max(6000.0 / rate, 150.0), 1800.0))
    times = np.sort(np.geomspace(max(4.0 / rate, 1.5), duration / 5.0, terms + 2)[1:-1])
    times = times * rng.uniform(0.8, 1.25, terms)
    strain = rng.uniform(0.3, 1.0) if tether else rng.uniform(0.08, 0.6)
    peak = float(curve.stress(np.array(strain))) * piece.area
    errors, table = _draw_errors(rng, book, peak, length, min(0.02, 0.2 / rate))
    unit = "m" if tether else "mm"
    step_mm = (1e-4 if tether else 1e-6) / SI[unit]
    position = Channel(
        unit,
        noise=step_mm * rng.uniform(0.3, 2.0),
        quantum=step_mm,
        gain_error=errors["crosshead_position.gain"],
        offset_error=errors["crosshead_position.offset"],
    )
    cell = Channel(
        "N",
        noise=peak * rng.uniform(2e-4, 2e-3),
        quantum=rounded(peak * 1e-4, 2),
        gain_error=errors["tension.gain"],
        offset_error=errors["tension.offset"],
    )
    truth = Truth(law, seed, "hold", about, errors=book.entries)
    truth.constants = {
        "curve": vars(curve),
        "shares": shares,
        "times_s": times,
        "sampling_Hz": rate,
    }
    truth.units = {
        "hold_start": "s, end of the ramp in the time of the log",
        "ramp_start": "s",
        "ramp_duration": "s",
        "peak": "N, true tension at the end of the ramp (and the largest of the record beside it)",
        "prony_sum_at_ramp_end": "N, equilibrium + amplitudes = tension at the end of the ramp",
        "equilibrium": "N, tension after unlimited time at the strain of the end of the ramp",
        "equilibrium_settled": "N, the same at the settled strain",
        "amplitudes": "N, of exp(-(t - hold_start)/time), the crosshead held at the ramp's end",
        "times": "s",
        "drop_to_infinity": "share of the tension at the end of the ramp, no settling",
        "drop_to_end": "the same, to the end of the record, no settling",
        "drop_recorded": "the same, of the record as it was, with the settling",
        "settling": "m, signed; settling_time s",
    }
    tests: dict[str, Any] = {}
    for order in range(1, 4):
        name = f"H-{order}"
        ramp = float(np.exp(rng.uniform(np.log(max(0.5, 2.5 / rate)), np.log(60.0))))
        rest = rng.uniform(2.0, 6.0) + 2.0 / rate
        stroke = strain * length
        settle = stroke * rng.uniform(1e-4, 1e-3) if tether else rng.uniform(5e-6, 50e-6)
        settle = -settle if back else settle
        settling_time = rng.uniform(0.5, 5.0)
        begin = rest + ramp
        dense = np.concatenate(
            (
                np.array([0.0]),
                rest + ramp * np.linspace(0.0, 1.0, 3001),
                begin + np.geomspace(1e-3, duration, 6000),
            )
        )
        logged_at = np.arange(rng.uniform(0.0, 1.0) / rate, begin + duration - 0.1, 1.0 / rate)
        time = np.unique(np.concatenate((dense, logged_at)))
        moved = stroke * np.clip((time - rest) / ramp, 0.0, 1.0)
        after = np.clip(time - begin, 0.0, None)
        moved = moved - settle * np.exp(-after / settling_time) * (after > 0.0)
        at_end = stroke - settle
        moved = np.where(after > 0.0, moved, at_end * np.clip((time - rest) / ramp, 0.0, 1.0))
        drive = curve.stress(moved / length) * piece.area
        force, states = _relax(time, drive, shares, times)
        end = int(np.searchsorted(time, begin))
        equilibrium = float((1.0 - shares.sum()) * drive[end])
        still = equilibrium + float(np.sum(states[end] * np.exp(-(time[-1] - begin) / times)))
        total = equilibrium + float(states[end].sum())
        zero = logged_at[0]
        tests[name] = {"file": f"{name}.csv", "order": order, "target_strain": [round(strain, 4)]}
        truth.tests[name] = {
            "piece": {
                "ramp_start": float(rest - zero),
                "ramp_duration": ramp,
                "hold_start": float(begin - zero),
                "peak": float(force[end]),
                "largest": float(force.max()),
                "prony_sum_at_ramp_end": total,
                "equilibrium": equilibrium,
                "equilibrium_settled": float(
                    (1.0 - shares.sum()) * curve.stress(np.array(stroke / length)) * piece.area
                ),
                "amplitudes": states[end],
                "times": times,
                "drop_to_infinity": 1.0 - equilibrium / total,
                "drop_to_end": 1.0 - still / total,
                "drop_recorded": float(1.0 - force[-1] / force[end]),
                "settling": settle,
                "settling_time": settling_time,
                "strain": at_end / length,
            }
        }
        truth.arrays[f"{name}/piece/exact/time"] = time - zero
        truth.arrays[f"{name}/piece/exact/tension"] = force
        truth.arrays[f"{name}/piece/exact/strain"] = moved / length
        seen = np.interp(logged_at - errors["lag"], time, force)
        place = np.interp(logged_at, time, moved)
        logged = {
            "time_s": (logged_at - zero, 4),
            f"displacement_{unit}": (position.read(place, rng), 5),
            "load_N": (cell.read(seen, rng), 4),
        }
        write_log(folder / f"{name}.csv", logged, f"{law} {name}, {rate:g} Hz")
    return _finish(
        truth,
        folder,
        piece,
        _layout(position, cell, length),
        table,
        {"kind": "relaxation"},
        tests,
    )


# --------------------------------------------------------------------------- D. loops


@dataclass
class Loop:
    """Exact record of the cycles of a loop test: strain and tension on a fine grid.

    ``turns`` are the samples of the turning points, valley first; ``truth`` holds what the law
    gives by itself (without the transients of the record).
    """

    time_step: float
    strain: Array
    tension: Array
    turns: list[int]
    truth: dict[str, Any]
    by_cycle: dict[str, Array] = field(default_factory=dict)
    noise: float = 5e-4  # of the tension amplitude
    waveform: str = "sinusoidal"
    sign: int = 1


FINE = 4


def _sine(
    rng: np.random.Generator, low: float = 0.05, high: float = 28.0
) -> tuple[float, float, int, float, float]:
    """Draw frequency, fine time step, cycles, mean strain and strain amplitude."""
    frequency = float(np.exp(rng.uniform(np.log(low), np.log(high))))
    frequency = rounded(frequency, 3)
    per_cycle = int(rng.integers(40, 121))
    cycles = int(rng.integers(20, 61))
    amplitude = rng.uniform(0.02, 0.15)
    mean = amplitude * rng.uniform(1.5, 3.0)
    return frequency, 1.0 / (frequency * per_cycle * FINE), cycles, mean, amplitude


def _linear(
    stiffness: float, amplitude: float, angle: Array | float, frequency: float
) -> dict[str, Any]:
    """Truth of a linear loop of a dynamic stiffness and a loss angle."""
    return {
        "frequency": frequency,
        "apparent_spring_constant": stiffness,
        "hysteresis_energy": np.pi * stiffness * amplitude**2 * np.sin(angle),
        "loss_factor": np.tan(angle),
        "loss_factor_sine": np.sin(angle),
        "storage_spring_constant": stiffness * np.cos(angle),
        "loss_spring_constant": stiffness * np.sin(angle),
        "strain_amplitude": amplitude,
        "tension_amplitude": stiffness * amplitude,
    }


def _turns(cycles: int, per_half: int) -> list[int]:
    return [k * per_half for k in range(2 * cycles + 1)]


def settling_angle(rng: np.random.Generator, area: float) -> Loop:
    """Loss angle that settles from about .15 to .05 rad over the cycles."""
    frequency, step, cycles, mean, amplitude = _sine(rng)
    stiffness = rng.uniform(1.0, 4.0) * 1e6 * area
    per = round(1.0 / frequency / step)
    count = cycles * per + 1
    cycle = np.arange(count) / per
    first, last = rng.uniform(0.10, 0.20), rng.uniform(0.03, 0.07)
    pace = rng.uniform(0.1, 0.5) * cycles
    angle = last + (first - last) * np.exp(-cycle / pace)
    phase = 2.0 * np.pi * cycle
    strain = mean - amplitude * np.cos(phase)
    tension = stiffness * (mean - amplitude * np.cos(phase + angle))
    middle = last + (first - last) * np.exp(-(np.arange(cycles) + 0.5) / pace)
    by_cycle = {
        key: np.broadcast_to(np.asarray(value, dtype=float), cycles).copy()
        for key, value in _linear(stiffness, amplitude, middle, frequency).items()
    }
    truth = {key: float(value[2:].mean()) for key, value in by_cycle.items()}
    return Loop(step, strain, tension, _turns(cycles, per // 2), truth, by_cycle)


def _unequal(rng: np.random.Generator, area: float, lossy: bool) -> Loop:
    """Strokes of unlike duration (40 s up, 10 s down, or the like) on a nonlinear curve."""
    curve = draw_curve(rng, rng.uniform(0.8, 2.0) * 1e6)
    up = float(rng.choice([40.0, 20.0, 8.0, 10.0]))
    down = up / float(rng.choice([4.0, 3.0, 2.0])) if rng.random() < 0.7 else up * 3.0
    amplitude = rng.uniform(0.2, 0.5)
    mean = amplitude * rng.uniform(1.2, 1.8)
    rate = float(rng.choice([5.0, 10.0, 20.0]))
    step = 1.0 / (rate * FINE)
    rise, fall = round(up / step), round(down / step)
    cycles = int(rng.integers(10, 21))
    ramp_up = mean - amplitude + 2.0 * amplitude * np.arange(rise) / rise
    ramp_down = mean + amplitude - 2.0 * amplitude * np.arange(fall) / fall
    strain = np.concatenate(
        (np.tile(np.concatenate((ramp_up, ramp_down)), cycles), [mean - amplitude])
    )
    turns = [0]
    for _ in range(cycles):
        turns.extend([turns[-1] + rise, turns[-1] + rise + fall])
    tension = curve.stress(strain) * area
    if lossy:  # one branch in its periodic state: the mean of a drive that repeats
        share, time = rng.uniform(0.05, 0.2), rng.uniform(0.05, 0.4) * (up + down)
        ratio = step / time
        gain, decay = -float(np.expm1(-ratio)) / ratio, float(np.exp(-ratio))
        push = gain * share * np.diff(tension[: rise + fall + 1])
        states = np.zeros(rise + fall + 1)
        for turn in range(2):
            for k, value in enumerate(push.tolist()):
                states[k + 1] = decay * states[k] + value
            if turn == 0:
                states[0] = states[-1] / (1.0 - decay ** (rise + fall))
        tension = (1.0 - share) * tension + np.concatenate(
            (np.tile(states[:-1], cycles), states[-1:])
        )
    loop = [(0, rise, rise + fall)]
    measures = loop_measures(strain, tension, loop, step)
    truth = {name: float(values[0]) for name, values in measures.items()}
    truth["frequency"] = 1.0 / ((rise + fall) * step)
    truth |= {"stroke_up_s": up, "stroke_down_s": down, "elastic": not lossy}
    return Loop(step, strain, tension, turns, truth, waveform="triangular", noise=2e-3)


def unequal_elastic(rng: np.random.Generator, area: float) -> Loop:
    """Unequal strokes of an elastic nonlinear curve: the loss is zero."""
    return _unequal(rng, area, lossy=False)


def unequal_lossy(rng: np.random.Generator, area: float) -> Loop:
    """Unequal strokes of a nonlinear viscoelastic piece."""
    return _unequal(rng, area, lossy=True)


def _cornered(rng: np.random.Generator, area: float, dwell: bool) -> Loop:
    """Corners of a piece of two relaxation times, one of them about the interval of the log."""
    amplitude = rng.uniform(0.01, 0.1)
    mean = amplitude * rng.uniform(1.5, 3.0)
    period, rate = float(rng.choice([2.0, 5.0, 10.0, 20.0])), rng.uniform(30.0, 100.0)
    step = period / round(rate) / FINE
    per = round(period / step)
    cycles = int(rng.integers(10, 21))
    if dwell:
        up = rng.uniform(0.25, 0.4)
        parts = [round(share * per) for share in (up, 0.5 - up, up)]
    else:
        parts = [round(rng.uniform(0.6, 0.75) * per)]
    ends = np.cumsum([0, *parts, per - sum(parts)])
    path = np.interp(np.arange(per), ends, [-1, 1, 1, -1, -1] if dwell else [-1, 1, -1])
    strain = mean + amplitude * np.append(np.tile(path, cycles), path[0])
    stiffness = rng.uniform(1.0, 4.0) * 1e6 * area
    tension = stiffness * strain
    for share, time in (
        (rng.uniform(0.2, 0.6), FINE * step * rng.uniform(0.3, 3.0)),
        (rng.uniform(0.1, 0.4), period * rng.uniform(0.1, 0.4)),
    ):
        ratio = step / time
        gain, decay = -float(np.expm1(-ratio)) / ratio, float(np.exp(-ratio))
        push = gain * share * stiffness * np.diff(strain[: per + 1])
        states = np.zeros(per + 1)
        for turn in range(2):
            for k, value in enumerate(push.tolist()):
                states[k + 1] = decay * states[k] + value
            if turn == 0:
                states[0] = states[-1] / (1.0 - decay**per)
        tension = tension + np.append(np.tile(states[:-1], cycles), states[-1])
    peak = int(ends[1])
    measures = loop_measures(strain, tension, [(0, peak, per)], step)
    truth = {name: float(values[0]) for name, values in measures.items()}
    truth["frequency"] = 1.0 / period
    turns = [0]
    for _ in range(cycles):
        turns.extend([turns[-1] + peak, turns[-1] + per])
    waveform = "other" if dwell else "triangular"
    return Loop(step, strain, tension, turns, truth, waveform=waveform, noise=1e-3)


def dwelling(rng: np.random.Generator, area: float) -> Loop:
    """Ramps with a dwell at both ends, on a piece that relaxes within a sample or two."""
    return _cornered(rng, area, dwell=True)


def fast_corners(rng: np.random.Generator, area: float) -> Loop:
    """Unequal ramps of a piece that relaxes within a sample or two."""
    return _cornered(rng, area, dwell=False)


def _steady(rng: np.random.Generator, area: float, angle: float, noise: float) -> Loop:
    frequency, step, cycles, mean, amplitude = _sine(rng)
    stiffness = rng.uniform(1.0, 4.0) * 1e6 * area
    per = round(1.0 / frequency / step)
    phase = 2.0 * np.pi * np.arange(cycles * per + 1) / per
    strain = mean - amplitude * np.cos(phase)
    tension = stiffness * (mean - amplitude * np.cos(phase + angle))
    truth = _linear(stiffness, amplitude, angle, frequency)
    return Loop(step, strain, tension, _turns(cycles, per // 2), truth, noise=noise)


def noisy_turns(rng: np.random.Generator, area: float) -> Loop:
    """Linear viscoelastic loop with tension noise of .3-1.5 % of the amplitude."""
    return _steady(rng, area, rng.uniform(0.02, 0.2), rng.uniform(0.003, 0.015))


def work_out(rng: np.random.Generator, area: float) -> Loop:
    """Driven specimen: tension lags behind strain, each loop gives work out."""
    return _steady(rng, area, -rng.uniform(0.05, 0.4), rng.uniform(5e-4, 3e-3))


def reversed_channel(rng: np.random.Generator, area: float) -> Loop:
    """Lossy piece whose position channel is logged with the wrong sign."""
    loop = _steady(rng, area, rng.uniform(0.03, 0.2), 5e-4)
    loop.sign = -1
    return loop


def relaxing_mean(rng: np.random.Generator, area: float) -> Loop:
    """Linear loop whose mean tension relaxes through the test."""
    loop = _steady(rng, area, rng.uniform(0.02, 0.15), rng.uniform(5e-4, 3e-3))
    share = np.linspace(0.0, 1.0, loop.tension.size)
    mean = float(loop.tension.mean())
    first, second = rng.uniform(0.05, 0.25, 2)
    fade = first * np.expm1(-share / rng.uniform(0.03, 0.15)) + second * np.expm1(-share / 0.6)
    loop.tension = loop.tension + mean * fade
    loop.truth["mean_tension_first"] = mean
    loop.truth["mean_tension_last"] = float(mean * (1.0 + fade[-1]))
    return loop


LOOPS: dict[str, Callable[[np.random.Generator, float], Loop]] = {
    "settling-angle": settling_angle,
    "unequal-elastic": unequal_elastic,
    "unequal-lossy": unequal_lossy,
    "noisy-turns": noisy_turns,
    "relaxing-mean": relaxing_mean,
    "work-out": work_out,
    "reversed-channel": reversed_channel,
    "dwelling": dwelling,
    "fast-corners": fast_corners,
}


def _lead_in(loop: Loop, rng: np.random.Generator) -> tuple[Array, Array, int]:
    """Put a rest and a ramp to the first valley before the cycles; return the shift too.

    In the ramp the tension follows a straight line: it is no part of any truth.
    """
    span = loop.turns[2] - loop.turns[0]
    rest, ramp = round(rng.uniform(1.0, 2.0) * span), round(rng.uniform(1.5, 3.0) * span)
    ease = np.concatenate((np.zeros(rest), np.arange(ramp) / ramp))
    strain = np.concatenate((ease * loop.strain[0], loop.strain))
    tension = np.concatenate((ease * loop.tension[0], loop.tension))
    return strain, tension, rest + ramp


def make_loop(
    law: str, seed: int, folder: Path, *, about: str, loop: str, lead_in: bool | None = None
) -> Truth:
    """Write one cyclic test of a small piece.

    Parameters
    ----------
    loop
        name out of ``LOOPS``.
    lead_in
        start with a rest and a ramp (drawn if not given); otherwise the log starts in a valley.
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    book = ErrorBook(rng)
    length = rng.uniform(0.03, 0.15)
    piece = _draw_piece(rng, book, "elastomer", length, rng.uniform(0.006, 0.02))
    record = LOOPS[loop](rng, piece.area)
    frequency = float(record.truth["frequency"])
    swing = float(np.ptp(record.tension)) / 2.0
    peak = float(record.tension.max())
    errors, table = _draw_errors(rng, book, peak, length, rng.uniform(2e-4, 1e-3) / frequency)
    stroke = float(np.ptp(record.strain)) * length * 1e3
    position = Channel(
        "mm",
        noise=stroke * rng.uniform(5e-5, 5e-4),
        quantum=rounded(stroke * 2e-5, 2),
        gain_error=errors["crosshead_position.gain"],
        offset_error=errors["crosshead_position.offset"],
    )
    cell = Channel(
        "N",
        noise=swing * record.noise,
        quantum=rounded(swing * 2e-4, 2),
        gain_error=errors["tension.gain"],
        offset_error=errors["tension.offset"],
    )
    if lead_in is None:
        lead_in = bool(rng.random() < 0.5)
    strain, tension, shift = (
        _lead_in(record, rng) if lead_in else (record.strain, record.tension, 0)
    )
    time = np.arange(strain.size) * record.time_step
    sampled = np.arange(0, strain.size, FINE)
    delayed = np.interp(time[sampled] - errors["lag"], time, tension)
    decimals = max(4, int(np.ceil(-np.log10(record.time_step))) + 2)
    fine = max(4, int(np.ceil(-np.log10(position.quantum))) + 1)
    small = max(4, int(np.ceil(-np.log10(cell.quantum))) + 1)
    logged = {
        "time_s": (time[sampled], decimals),
        "displacement_mm": (
            record.sign * position.read(strain * length, rng)[sampled],
            fine,
        ),
        "load_N": (cell.read(delayed, rng), small),
    }
    write_log(folder / "D-1.csv", logged, f"{law}: cycles at {frequency:g} Hz")
    truth = Truth(law, seed, "loop", about, errors=book.entries)
    truth.units = UNITS | {"by_cycle": "the same, one value a cycle"}
    truth.constants = {"lead_in": lead_in, "noise_of_amplitude": record.noise}
    cycles = (len(record.turns) - 1) // 2
    truth.tests["D-1"] = {
        "piece": {
            **record.truth,
            "n_cycles": cycles,
            "first_valley_s": float(time[shift]),
        }
    }
    for name, values in record.by_cycle.items():
        truth.arrays[f"D-1/piece/cycles/{name}"] = values
    valleys = record.turns
    loops = [(valleys[2 * k], valleys[2 * k + 1], valleys[2 * k + 2]) for k in range(cycles)]
    exact = loop_measures(record.strain, record.tension, loops, record.time_step)
    for name, values in exact.items():
        truth.arrays[f"D-1/piece/record/{name}"] = values
    test = {"file": "D-1.csv", "order": 1, "n_cycles": cycles}
    defaults = {"kind": "cyclic", "waveform": record.waveform}
    return _finish(
        truth, folder, piece, _layout(position, cell, length), table, defaults, {"D-1": test}
    )


# --------------------------------------------------------------------------- E. load train


def _follow(
    curve: ElasticCurve, area: float, loss_time: float, share: float, strain: Array, step: float
) -> Array:
    """Tension of an elastic curve with one Maxwell branch beside it."""
    drive = curve.stress(strain) * area
    ratio = step / loss_time
    gain, decay = -np.expm1(-ratio) / ratio, np.exp(-ratio)
    state = np.zeros_like(drive)
    value = share * float(drive[0]) * 0.3
    state[0] = value
    for k, push in enumerate((gain * share * np.diff(drive)).tolist()):
        value = decay * value + push
        state[k + 1] = value
    return (1.0 - share) * drive + state


def make_train(
    law: str,
    seed: int,
    folder: Path,
    *,
    about: str,
    mass: bool,
    compliance: bool,
    stated: bool = True,
) -> Truth:
    """Write sinusoidal tests with a mass at the moving end and a compliant machine.

    Parameters
    ----------
    mass
        a mass between specimen and load cell, the cell at the moving end.
    compliance
        frame and grips give way; the logged position is the crosshead's.
    stated
        campaign.toml states them (``load_cell_at``, ``attached_mass``, ``machine_compliance`` in
        the layout); the values are exact unless ``KEYS`` names a place for their uncertainty.
    """
    rng = np.random.default_rng([seed, sum(law.encode())])
    book = ErrorBook(rng)
    length = rng.uniform(1.0, 2.5)
    piece = _draw_piece(rng, book, "rubber tether", length, rng.uniform(0.02, 0.027))
    curve = draw_curve(rng, rng.uniform(0.5, 0.8) * 1e6)
    secant = float(curve.stress(np.array(1.0))) * piece.area
    errors, table = _draw_errors(rng, book, secant, length, rng.uniform(1e-3, 5e-3))
    true_mass = rng.uniform(2.0, 8.0) if mass else 0.0
    true_compliance = rng.uniform(0.5, 3.0) * 1e-2 * length / secant if compliance else 0.0
    extra: dict[str, Any] = {}
    uncertainty: dict[str, Any] = {}
    if stated:
        extra["load_cell_at"] = "moving" if mass else "fixed"
    for name, unit, true in (
        ("attached_mass", "kg", true_mass),
        ("machine_compliance", "m/N", true_compliance),
    ):
        if true == 0.0 or not stated:
            continue
        key = KEYS[f"{name}_uncertainty"]
        printed = rounded(true, 6)
        if key:
            statement = Statement(rounded(true * rng.uniform(0.02, 0.08), 2), unit)
            printed = rounded(true + statement.draw(rng), 4)
            book.note(name, statement, printed - true)
            uncertainty[key] = statement.toml()
        extra[name] = f"{printed:g} {unit}"
    position = Channel(
        "mm",
        noise=0.05,
        quantum=0.02,
        gain_error=errors["crosshead_position.gain"],
        offset_error=errors["crosshead_position.offset"],
    )
    cell = Channel(
        "N",
        noise=secant * rng.uniform(2e-4, 1e-3),
        quantum=0.02,
        gain_error=errors["tension.gain"],
        offset_error=errors["tension.offset"],
    )
    truth = Truth(law, seed, "load train", about, errors=book.entries)
    truth.units = UNITS | {"uncorrected": "the same measures of cell and crosshead as they are"}
    truth.constants = {
        "attached_mass_kg": true_mass,
        "machine_compliance_m_per_N": true_compliance,
        "load_cell_at": "moving" if mass else "fixed",
        "stated": stated,
        "curve": vars(curve),
    }
    tests: dict[str, Any] = {}
    for order in range(1, 4):
        name = f"L-{order}"
        frequency = rounded(float(rng.uniform(0.2, 2.0)), 3)
        per, cycles = 64 * FINE, int(rng.integers(15, 26))
        step = 1.0 / frequency / per
        amplitude = rng.uniform(0.05, 0.2) * length
        mean = rng.uniform(0.4, 0.9) * length
        rest, ramp = round(3.0 / step), round(rng.uniform(6.0, 10.0) / step)
        cyc = np.arange(cycles * per + 1) / per
        grow = 0.5 - 0.5 * np.cos(np.pi * np.clip(cyc / 2.0, 0.0, 1.0))
        wave = mean - amplitude * np.cos(2.0 * np.pi * cyc) * grow
        ease = 0.5 - 0.5 * np.cos(np.pi * np.arange(ramp) / ramp)
        crosshead = np.concatenate((np.zeros(rest), mean * ease, wave))
        loss_time, share = rng.uniform(0.05, 0.5) / frequency, rng.uniform(0.05, 0.2)
        specimen = crosshead.copy()
        for _ in range(60):
            tension = _follow(curve, piece.area, loss_time, share, specimen / length, step)
            change = crosshead - true_compliance * tension - specimen
            specimen = specimen + change
            if float(np.max(np.abs(change))) < 1e-13:
                break
        acceleration = np.gradient(np.gradient(specimen, step), step)
        # the mass sits at the specimen's moving end: the cell pulls it along
        felt = tension + true_mass * acceleration
        time = np.arange(felt.size) * step
        sampled = np.arange(0, felt.size, FINE)
        delayed = np.interp(time[sampled] - errors["lag"], time, felt)
        logged = {
            "time_s": (time[sampled], 6),
            "displacement_mm": (position.read(crosshead, rng)[sampled], 4),
            "load_N": (cell.read(delayed, rng), 4),
        }
        write_log(folder / f"{name}.csv", logged, f"{law} {name}: {frequency:g} Hz")
        first = rest + ramp
        loops = [
            (first + per * k, first + per * k + per // 2, first + per * (k + 1))
            for k in range(3, cycles)
        ]
        exact = loop_measures(specimen / length, tension, loops, step)
        crude = loop_measures(crosshead / length, felt, loops, step)
        truth.tests[name] = {
            "piece": {
                **{key: float(values.mean()) for key, values in exact.items()},
                "frequency": frequency,
                "uncorrected": {key: float(values.mean()) for key, values in crude.items()},
            }
        }
        for key, values in exact.items():
            truth.arrays[f"{name}/piece/cycles/{key}"] = values
        truth.arrays[f"{name}/piece/exact/strain"] = specimen[sampled] / length
        truth.arrays[f"{name}/piece/exact/tension"] = tension[sampled]
        tests[name] = {"file": f"{name}.csv", "order": order, "n_cycles": cycles}
    table = {"lag": table["lag"], **uncertainty, **table}
    defaults = {"kind": "cyclic", "waveform": "sinusoidal"}
    return _finish(
        truth, folder, piece, _layout(position, cell, length, extra), table, defaults, tests
    )

"""What shared errors add to the loops of a specimen, to its dynamic modulus and to its line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Literal

import numpy as np

from reduction.cycles.product import Cycles, Loops
from reduction.line.product import LineParameters
from reduction.moduli.product import AmplitudeSummary
from reduction.record import Floats
from reduction.settings import CycleSettings
from reduction.strain.inverse import position_by_model
from reduction.strain.model import StrainModel
from reduction.uncertainty.curves import by_diameter, diameter_error
from reduction.uncertainty.line import line_contributions
from reduction.uncertainty.loops import loop_contributions
from reduction.uncertainty.product import Contributions, InstrumentErrors

Reading = Literal["amplitude", "fundamental"]
_LOOP = (
    "frequency", "mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude",
    "apparent_spring_constant", "hysteresis_energy", "storage_spring_constant",
    "loss_spring_constant",
)  # fmt: skip
_K_0 = "quasi_static_spring_constant"


def speed_ratio(
    loops: Loops | AmplitudeSummary,
    index: int,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
) -> Floats:
    """Speed of the ramps over that of ramps without a stop at their ends."""
    frequency, mean, amplitude = (
        getattr(loops, name)[index] for name in ("frequency", "mean_strain", "strain_amplitude")
    )
    tension, swing = loops.mean_tension[index], loops.tension_amplitude[index]
    if settings.control == "load":
        half = swing
    elif model.method == "extensometer":
        return np.ones(np.shape(frequency))
    else:
        ends = [
            position_by_model(model, strain=mean + way * amplitude, tension=tension + way * swing)
            for way in (1, -1)
        ]
        half = (ends[0] - ends[1]) / 2
    plateau = cycles.plateau_rate.mean(axis=1)
    if np.ndim(frequency) == 0:
        plateau = np.asarray(np.nanmedian(plateau))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = plateau / (4 * frequency * half)
    usable = np.isfinite(ratio) & (ratio > 1)
    return np.asarray(np.where(usable, ratio, 1.0))


def of_loops(
    loops: Loops | AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    model: StrainModel,
    cycles: Cycles,
    settings: CycleSettings,
) -> Contributions:
    """Each cycle of a specimen, or the means of its test."""
    return loop_contributions(
        errors, model,
        **{name: np.asarray(getattr(loops, name)[index]) for name in _LOOP},
        waveform=settings.waveform,
        control=settings.control,
        speed_ratio=speed_ratio(loops, index, model, cycles, settings),
    )  # fmt: skip


def of_dynamic_modulus(
    of_loop: Contributions,
    summary: AmplitudeSummary,
    index: int,
    errors: InstrumentErrors,
    area: float,
) -> Contributions:
    """Spring constant over area."""
    rows = of_loop.values["apparent_spring_constant"] / area
    component = of_loop.component
    if errors.diameter:
        component = (*component, diameter_error(errors))
        own = by_diameter(summary.dynamic_modulus[index], errors, area=area)
        rows = np.concatenate([rows, own[None]])
    return Contributions(component, {"dynamic_modulus": rows})


def of_line(
    line: LineParameters,
    loops: Loops | AmplitudeSummary,
    index: int,
    of_loop: Contributions,
    of_rest: Contributions,
) -> Contributions:
    """K_1, tau and K_1 tau of each cycle of a specimen, or of the means of its test."""
    values: Mapping[str, Floats] = {
        item.name: getattr(line, item.name)[index]
        for item in fields(line)
        if isinstance(getattr(line, item.name), np.ndarray)
    } | {name: np.asarray(getattr(loops, name)[index]) for name in _LOOP if name not in
         ("storage_spring_constant", "loss_spring_constant")}  # fmt: skip
    # one K_0 a run: its error is that of every cycle
    rest = of_rest.values[_K_0]
    shape = (*rest.shape[:1], *np.shape(values[_K_0]))
    rest = np.broadcast_to(rest.reshape(rest.shape[:1] + (1,) * (len(shape) - 1)), shape)
    reading: Reading = "fundamental" if line.reading == "fundamental" else "amplitude"
    found = line_contributions(
        of_loop, Contributions(of_rest.component, {_K_0: rest}), values, reading=reading
    )
    names = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
    return Contributions(found.component, {name: found.values[name] for name in names})

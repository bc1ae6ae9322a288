"""SPEC.toml of a wave load: a floating hose, its sea, and what it is exposed to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from reduction.campaign.toml_file import Number, TableReader, in_toml, read_toml
from reduction.prediction.wave_load import (
    AIR_DENSITY,
    CODE_OF_HYDROLOGY,
    SEAWATER_DENSITY,
    VerticalWidth,
)
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats

_MAY_FOLLOW = ("wave_length", "hose_length")

_MOST_TIMES = 1_000_000

_STEPS_A_PERIOD = 200


class _WaveLoadKeys(BaseModel):
    """``[wave_load]``."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    outer_diameter: str
    wall_thickness: str
    wall_density: str
    content_density: str
    """0 kg/m^3 of an empty hose."""
    water_density: str = f"{SEAWATER_DENSITY:g} kg/m^3"
    water_depth: str
    wave_height: str
    wave_period: str
    wave_length: str | None = None
    """Beside the period it is used as it is, and the mismatch of the two is told."""
    wave_theory: Literal["auto", "airy", "stokes"] = "auto"
    elevation: str | None = None
    """At which the water moves, from the mean level up; the centre of the hose if nothing."""
    drag_coefficient: Number = CODE_OF_HYDROLOGY.drag_coefficient[0]
    inertia_coefficient: Number = CODE_OF_HYDROLOGY.inertia_coefficient
    vertical_width: VerticalWidth = "submerged"
    current_velocity: str = "0 m/s"
    wind_velocity: str = "0 m/s"
    wind_drag_coefficient: Number = CODE_OF_HYDROLOGY.drag_coefficient[0]
    air_density: str = f"{AIR_DENSITY:g} kg/m^3"
    hose_length: str | None = None
    """For the anchor force; a metre if nothing."""
    duration: str | None = None
    """Of the time series; two periods if nothing."""
    time_step: str | None = None


class _WaveLoadFile(BaseModel):
    """The whole of SPEC.toml."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    wave_load: _WaveLoadKeys


@dataclass(frozen=True)
class _WaveLoadCase:
    """A wave load in SI; ``wave_length`` and ``elevation`` are None where they follow."""

    name: str
    outer_diameter: float
    wall_thickness: float
    wall_density: float
    content_density: float
    water_density: float
    water_depth: float
    wave_height: float
    wave_period: float
    wave_length: float | None
    wave_theory: Literal["auto", "airy", "stokes"]
    elevation: float | None
    drag_coefficient: float
    inertia_coefficient: float
    vertical_width: VerticalWidth
    current_velocity: float
    wind_velocity: float
    wind_drag_coefficient: float
    air_density: float
    hose_length: float
    time: Floats


def load_wave_case(path: Path) -> _WaveLoadCase:
    """Read SPEC.toml of a wave load."""
    file = read_toml(
        path,
        _WaveLoadFile,
        what="the wave load",
        needed="a SPEC.toml with [wave_load]",
        keys="docs/predictions.md lists every key",
    )
    keys = file.wave_load
    read = TableReader(path, "wave_load")
    lengths = ("outer_diameter", "wall_thickness", "water_depth", "wave_height")
    densities = ("wall_density", "content_density", "water_density", "air_density")
    numbers = ("drag_coefficient", "inertia_coefficient", "wind_drag_coefficient")
    values = {name: read.value(name, getattr(keys, name), "length") for name in lengths}
    values |= {name: read.value(name, getattr(keys, name), "density") for name in densities}
    values |= {name: read.value(name, getattr(keys, name), "number") for name in numbers}
    values["wave_period"] = read.value("wave_period", keys.wave_period, "time")
    for name in ("current_velocity", "wind_velocity"):
        values[name] = read.value(name, getattr(keys, name), "velocity")
    given = {name: read.optional(name, getattr(keys, name), "length") for name in _MAY_FOLLOW}
    of_any_sign = {"current_velocity", "wind_velocity"}
    for name, value in {**values, **given}.items():
        if value is None or (np.isfinite(value) and name in of_any_sign):
            continue
        if name == "content_density":
            if not (np.isfinite(value) and value >= 0):
                raise _fault(path, f"{name} is negative", value, "zero or more")
        elif not (np.isfinite(value) and value > 0):
            raise _fault(path, f"{name} is not positive", value, "above zero")
    return _WaveLoadCase(
        name=path.stem,
        **values,
        wave_length=given["wave_length"],
        wave_theory=keys.wave_theory,
        elevation=read.optional("elevation", keys.elevation, "length"),
        vertical_width=keys.vertical_width,
        hose_length=1.0 if given["hose_length"] is None else given["hose_length"],
        time=_times(path, read, keys, values["wave_period"]),
    )


def _fault(path: Path, problem: str, value: float, needed: str) -> SettingsError:
    return in_toml(path, f"wave_load.{problem}", found=f"{value:g} in SI", needed=needed)


def _times(path: Path, read: TableReader, keys: _WaveLoadKeys, period: float) -> Floats:
    duration = read.optional("duration", keys.duration, "time")
    step = read.optional("time_step", keys.time_step, "time")
    duration = 2 * period if duration is None else duration
    step = period / _STEPS_A_PERIOD if step is None else step
    if not (duration > 0 and step > 0 and duration / step <= _MOST_TIMES):
        raise in_toml(
            path, "wave_load has no time series that can be made",
            found=f"{duration:g} s in steps of {step:g} s",
            needed=f"both above zero, at most {_MOST_TIMES} steps",
        )  # fmt: skip
    return np.arange(int(np.floor(duration / step + 1e-9)) + 1, dtype=np.float64) * step

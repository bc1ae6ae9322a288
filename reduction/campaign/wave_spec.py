"""SPEC.toml of a wave load: a floating hose, the sea, and the loads on it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import in_toml, read_toml
from reduction.campaign.unit_types import (
    InSI,
    Length,
    PositiveDensity,
    PositiveLength,
    PositiveNumber,
    Time,
    Velocity,
)
from reduction.prediction.wave_load import (
    AIR_DENSITY,
    CODE_OF_HYDROLOGY,
    SEAWATER_DENSITY,
    VerticalWidth,
)
from reduction.record.measurement import Floats

_MOST_TIMES = 1_000_000

_STEPS_A_PERIOD = 200


class _WaveLoadKeys(BaseModel):
    """``[wave_load]``, in SI after reading."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    outer_diameter: PositiveLength
    wall_thickness: PositiveLength
    wall_density: PositiveDensity
    content_density: Annotated[float, InSI("density", least=0.0)]
    """0 kg/m^3 for an empty hose."""
    water_density: PositiveDensity = Field(f"{SEAWATER_DENSITY:g} kg/m^3", validate_default=True)
    water_depth: PositiveLength
    wave_height: PositiveLength
    wave_period: Annotated[float, InSI("time", above=0.0)]
    wave_length: PositiveLength | None = None
    """With a period it is used unchanged, and the mismatch of the two is reported."""
    wave_theory: Literal[
        "auto", "airy", "stokes", "stokes 3", "stokes 5", "cnoidal", "stream function"
    ] = "auto"
    elevation: Length | None = None
    """Elevation of the water motion above the mean level; default the centre of the hose."""
    drag_coefficient: PositiveNumber = CODE_OF_HYDROLOGY.drag_coefficient[0]
    inertia_coefficient: PositiveNumber = CODE_OF_HYDROLOGY.inertia_coefficient
    vertical_width: VerticalWidth = "submerged"
    current_velocity: Velocity = Field("0 m/s", validate_default=True)
    wind_velocity: Velocity = Field("0 m/s", validate_default=True)
    wind_drag_coefficient: PositiveNumber = CODE_OF_HYDROLOGY.drag_coefficient[0]
    air_density: PositiveDensity = Field(f"{AIR_DENSITY:g} kg/m^3", validate_default=True)
    hose_length: PositiveLength = Field("1 m", validate_default=True)
    """Length for the anchor force."""
    duration: Time | None = None
    """Duration of the time series; default two periods."""
    time_step: Time | None = None


class _WaveLoadFile(BaseModel):
    """The whole of SPEC.toml."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    wave_load: _WaveLoadKeys


def load_wave_case(path: Path) -> dict[str, Any]:
    """Read SPEC.toml of a wave load: arguments of `predict_wave_load`, in SI."""
    file = read_toml(
        path,
        _WaveLoadFile,
        what="the wave load",
        needed="a SPEC.toml with [wave_load]",
        keys="docs/predictions.md lists every key",
    )
    given = file.wave_load.model_dump()
    times = _times(path, given["wave_period"], given.pop("duration"), given.pop("time_step"))
    return given | {"time": times}


def _times(path: Path, period: float, duration: float | None, step: float | None) -> Floats:
    duration = 2 * period if duration is None else duration
    step = period / _STEPS_A_PERIOD if step is None else step
    if not (duration > 0 and step > 0 and duration / step <= _MOST_TIMES):
        raise in_toml(
            path, "wave_load has no time series that can be made",
            found=f"{duration:g} s in steps of {step:g} s",
            needed=f"both above zero, at most {_MOST_TIMES} steps",
        )  # fmt: skip
    return np.arange(int(np.floor(duration / step + 1e-9)) + 1, dtype=np.float64) * step

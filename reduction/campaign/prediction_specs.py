"""SPEC.toml of `reduction predict`: the sea and a floating hose, or the layers of an armour."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import at_place, in_toml, read_toml
from reduction.campaign.unit_types import (
    Angle,
    InSI,
    Length,
    PositiveDensity,
    PositiveLength,
    PositiveNumber,
    PositiveStrain,
    Ratio,
    Strain,
    Stress,
    Time,
    Velocity,
)
from reduction.prediction.armour import ArmourDesign, ArmourLayers
from reduction.prediction.wave_load import (
    AIR_DENSITY,
    CODE_OF_HYDROLOGY,
    SEAWATER_DENSITY,
    VerticalWidth,
)
from reduction.record.measurement import Floats


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


_MOST_TIMES = 1_000_000

_STEPS_A_PERIOD = 200


class _WaveLoadKeys(_Section):
    """``[wave_load]``, in SI after reading."""

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


class _WaveLoadFile(_Section):
    """The whole of SPEC.toml."""

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


class _ArmourLayerKeys(_Section):
    """``[[armour.layers]]``, in SI after reading."""

    name: str = ""
    winding_angle: Angle
    """Measured from the axis of the cable."""
    wire_radius: Length | None = None
    """Alternatively ``wire_diameter``."""
    wire_diameter: Length | None = None
    core_radius: Length | None = None
    """Radius of the core below the wires; alternatively ``core_diameter``."""
    core_diameter: Length | None = None
    n_wires: int = Field(default=1, ge=1)
    elastic_modulus: Stress = Field("210 GPa", validate_default=True)
    poisson_ratio: Ratio = 0.3
    lay: Literal["right", "left"] = "right"
    yield_stress: Stress | None = None


class _ArmourKeys(_Section):
    """``[armour]``, in SI after reading."""

    axial_strain: Strain
    """Strain of the cable along its axis."""
    tolerance: PositiveStrain = Field("1 %", validate_default=True)
    """Error up to which a theory counts as correct."""
    layers: tuple[_ArmourLayerKeys, ...] = Field(min_length=1)


class _ArmourFile(_Section):
    """The whole of SPEC.toml."""

    armour: _ArmourKeys


@dataclass(frozen=True)
class _ArmourCase:
    """An armour in SI; ``strain`` has the shape (1,)."""

    name: str
    layer_names: tuple[str, ...]
    layers: ArmourLayers
    strain: Floats
    tolerance: float


_MOST_STRAIN = 0.05


def load_armour_case(path: Path) -> _ArmourCase:
    """Read SPEC.toml of an armour."""
    keys = read_toml(
        path,
        _ArmourFile,
        what="the armour",
        needed="a SPEC.toml with [armour] and [[armour.layers]]",
        keys="docs/predictions.md lists every key",
    ).armour
    if keys.axial_strain > _MOST_STRAIN:
        raise in_toml(
            path, "armour.axial_strain is more than a cable can stretch",
            found=f"{100 * keys.axial_strain:g} %", needed=f"at most {100 * _MOST_STRAIN:g} %",
            hint='A bare number is a share: 0.1 % is 0.001 or "0.1 %".',
        )  # fmt: skip
    rows = [
        (
            layer.winding_angle,
            _radius(path, number, layer, "wire"),
            _radius(path, number, layer, "core"),
            layer.elastic_modulus,
            layer.poisson_ratio,
            float(layer.n_wires),
        )
        for number, layer in enumerate(keys.layers, start=1)
    ]
    with at_place(f"{path}: armour: "):
        layers = ArmourLayers(
            ArmourDesign(*np.array(rows).T),
            tuple(layer.lay for layer in keys.layers),
            np.array([layer.yield_stress for layer in keys.layers], dtype=np.float64),
        )
    return _ArmourCase(
        name=path.stem,
        layer_names=tuple(
            layer.name or f"layer {number}" for number, layer in enumerate(keys.layers, start=1)
        ),
        layers=layers,
        strain=np.array([keys.axial_strain]),
        tolerance=keys.tolerance,
    )


def _radius(path: Path, number: int, layer: _ArmourLayerKeys, what: str) -> float:
    """A radius, from a stated radius or diameter."""
    radius, diameter = getattr(layer, f"{what}_radius"), getattr(layer, f"{what}_diameter")
    if (radius is None) == (diameter is None):
        raise in_toml(
            path,
            f"armour.layers.{layer.name or number}: state {what}_radius or {what}_diameter once",
            found="neither" if radius is None else "both",
            needed=f"{what}_radius or {what}_diameter",
        )  # fmt: skip
    return float(diameter / 2 if radius is None else radius)

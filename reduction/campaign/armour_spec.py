"""SPEC.toml of a helical armour: its layers, innermost first, and the strain of the cable."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import at_place, in_toml, read_toml
from reduction.campaign.unit_types import Angle, Length, PositiveStrain, Ratio, Strain, Stress
from reduction.prediction.armour import ArmourDesign, ArmourLayers
from reduction.record.measurement import Floats


class _ArmourSection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class _ArmourLayerKeys(_ArmourSection):
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


class _ArmourKeys(_ArmourSection):
    """``[armour]``, in SI after reading."""

    axial_strain: Strain
    """Strain of the cable along its axis."""
    tolerance: PositiveStrain = Field("1 %", validate_default=True)
    """Error up to which a theory counts as correct."""
    layers: tuple[_ArmourLayerKeys, ...] = Field(min_length=1)


class _ArmourFile(_ArmourSection):
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


def load_armour_case(path: Path) -> _ArmourCase:
    """Read SPEC.toml of an armour."""
    keys = read_toml(
        path,
        _ArmourFile,
        what="the armour",
        needed="a SPEC.toml with [armour] and [[armour.layers]]",
        keys="docs/predictions.md lists every key",
    ).armour
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

"""SPEC.toml of a helical armour: its layers, the innermost first, and the strain of the cable."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from reduction.campaign.toml_file import Number, TableReader, in_toml, read_toml
from reduction.prediction.armour import ArmourDesign, ArmourLayers
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats


class _ArmourSection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _ArmourLayerKeys(_ArmourSection):
    """``[[armour.layers]]``."""

    name: str = ""
    winding_angle: str
    """From the axis of the cable."""
    wire_radius: str | None = None
    """Or ``wire_diameter``."""
    wire_diameter: str | None = None
    core_radius: str | None = None
    """Of what the wires lie on; or ``core_diameter``."""
    core_diameter: str | None = None
    n_wires: int = Field(default=1, ge=1)
    elastic_modulus: str = "210 GPa"
    poisson_ratio: Number = 0.3
    lay: Literal["right", "left"] = "right"
    yield_stress: str | None = None


class _ArmourKeys(_ArmourSection):
    """``[armour]``."""

    axial_strain: Number
    """Of the cable along its axis."""
    tolerance: Number = "1 %"
    """Error at which a theory still counts as right."""
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


def _length(read: TableReader, layer: _ArmourLayerKeys, what: str) -> float:
    """A radius, given as such or as a diameter."""
    radius, diameter = getattr(layer, f"{what}_radius"), getattr(layer, f"{what}_diameter")
    if (radius is None) == (diameter is None):
        raise in_toml(
            read.path, f"{read.place}: {what}_radius is not said once",
            found="both" if radius else "neither", needed=f"{what}_radius or {what}_diameter",
        )  # fmt: skip
    if radius is not None:
        return read.value(f"{what}_radius", radius, "length")
    return read.value(f"{what}_diameter", str(diameter), "length") / 2


def load_armour_case(path: Path) -> _ArmourCase:
    """Read SPEC.toml of an armour."""
    file = read_toml(
        path,
        _ArmourFile,
        what="the armour",
        needed="a SPEC.toml with [armour] and [[armour.layers]]",
        keys="docs/predictions.md lists every key",
    )
    keys = file.armour
    rows, yields = [], []
    for number, layer in enumerate(keys.layers, start=1):
        read = TableReader(path, f"armour.layers.{layer.name or number}")
        rows.append(
            (
                read.value("winding_angle", layer.winding_angle, "angle"),
                _length(read, layer, "wire"),
                _length(read, layer, "core"),
                read.value("elastic_modulus", layer.elastic_modulus, "stress"),
                read.value("poisson_ratio", layer.poisson_ratio, "number"),
                float(layer.n_wires),
            )
        )
        stress = read.optional("yield_stress", layer.yield_stress, "stress")
        yields.append(np.nan if stress is None else stress)
    strain = TableReader(path, "armour").value("axial_strain", keys.axial_strain, "strain")
    tolerance = TableReader(path, "armour").value("tolerance", keys.tolerance, "strain")
    if not tolerance > 0:
        raise in_toml(path, "armour.tolerance is not positive", found=f"{tolerance:g}")
    angle, wire, core, modulus, poisson, n_wires = np.array(rows).T
    try:
        layers = ArmourLayers(
            ArmourDesign(angle, wire, core, modulus, poisson, n_wires),
            tuple(layer.lay for layer in keys.layers),
            np.array(yields),
        )
    except SettingsError as error:
        raise in_toml(
            path, f"armour: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    return _ArmourCase(
        name=path.stem,
        layer_names=tuple(
            layer.name or f"layer {number}" for number, layer in enumerate(keys.layers, start=1)
        ),
        layers=layers,
        strain=np.array([strain]),
        tolerance=tolerance,
    )

"""SPEC.toml of a hose, and the tables ``[hoses]`` and ``[comparisons]`` of a campaign."""

from __future__ import annotations

import math
from dataclasses import fields
from math import pi
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from reduction.campaign.toml_file import in_toml, quantity_of, read_toml
from reduction.campaign.unit_types import (
    Angle,
    Force,
    InSI,
    Length,
    Number,
    PositiveLength,
    PositiveStrain,
    Ratio,
    Strain,
    Stress,
)
from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_prediction import HelicalLayer, HosePlan
from reduction.prediction.hose_product import HoseDesign, RubberLaw
from reduction.quantities.units import Dimension
from reduction.record.errors import SettingsError

_Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_ \-]{0,99}$")]

_Calibrated = Literal[
    "wrap_angle",
    "rubber_modulus",
    "cord_load_scale",
    "cord_strain_scale",
    "dead_length_share",
]
"""Parameters that a comparison may fit; diameters and cords are measured, not fitted."""


class _HoseSection(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


class CordSection(_HoseSection):
    """``[cord]``: measured points of one cord; the last one is its break."""

    strain: tuple[Strain, ...]
    load: tuple[Force, ...]


class LayerSection(_HoseSection):
    """``[[hose.layers]]``: a layer that should carry no load."""

    name: _Name
    wrap_angle: Angle
    strain_limit: Strain | None = None
    """Maximum tensile strain."""
    compression_limit: Strain | None = None
    """Maximum compressive strain, a positive number."""


class _HoseKeys(_HoseSection):
    """``[hose]``, and ``[hoses.NAME]`` of a campaign, without the cord."""

    wrap_angle: Angle
    """Measured from the hose axis."""
    wrap_diameter: Length | None = None
    """Mean of the two cord layers; alternatively ``layer_diameters``."""
    layer_diameters: tuple[Length, Length] | None = None
    inner_diameter: Length
    outer_diameter: Length
    cords_per_length: Annotated[float, InSI("per_length")]
    cord_diameter: Length
    rubber_modulus: Stress
    rubber_law: RubberLaw = "neo-hookean"
    working_share: Ratio = Field(default=1 / 3)
    """Share of the break load of a cord at the safe working load."""
    cord_load_scale: Ratio = 1.0
    cord_strain_scale: Ratio = 1.0
    minimum_inner_diameter: Length | None = None
    length: PositiveLength | None = None
    """Relaxed length with stretch-limited ends; required with ``dead_length``."""
    dead_length: Length | None = None
    """Part of the length that does not stretch, total of both ends."""
    strain_step: Strain = Field("1 %", validate_default=True)
    greatest_strain: PositiveStrain | None = None
    standard_uncertainty: dict[str, Number] = Field(default_factory=dict)
    """By key of this table, in its unit or in % of its value."""
    layers: tuple[LayerSection, ...] = ()


class HoseSection(_HoseKeys):
    """``[hoses.NAME]`` with ``[hoses.NAME.cord]``."""

    cord: CordSection


class _TargetSection(_HoseSection):
    """``[target]``: requirements for a hose like this one at its safe working load."""

    strain: Strain
    tension: Force | None = None


class _ComparisonKeys(_HoseSection):
    """``[comparison]``: how a measured curve is compared with the prediction."""

    specimen: str | None = None
    """Specimen of the measured test, if it has several."""
    loading: Literal["static", "dynamic"] | None = None
    """How it was pulled, if not clear from the kind of test: a cyclic test may be slow."""
    calibrate: tuple[_Calibrated, ...] = ()
    """Parameters of the hose to fit to the measured curve."""


class _HoseSpecFile(_HoseSection):
    """SPEC.toml of ``reduction predict hose`` and ``reduction compare``."""

    hose: _HoseKeys
    cord: CordSection
    target: _TargetSection | None = None
    comparison: _ComparisonKeys = _ComparisonKeys()


class ComparisonSection(_ComparisonKeys):
    """``[comparisons.NAME]``."""

    measured: str
    """Test or test/step of the campaign."""
    predicted: str
    """One of the hoses in ``[hoses]``."""


_DIMENSIONS: dict[str, Dimension] = {
    "wrap_angle": "angle",
    "wrap_diameter": "length",
    "layer_diameters": "length",
    "inner_diameter": "length",
    "outer_diameter": "length",
    "cords_per_length": "per_length",
    "rubber_modulus": "stress",
    "cord_load_scale": "number",
    "cord_strain_scale": "number",
    "dead_length": "length",
}

"""Keys that may have a standard uncertainty."""

_MOST_CORD_STRAIN, _MOST_TARGET = 1.0, 10.0

_PARAMETERS = {
    "wrap_diameter": "layer_diameter",
    "layer_diameters": "layer_diameter",
    "dead_length": "dead_length_share",
}


def hose_of(path: Path, name: str, place: str, keys: _HoseKeys, cord: CordSection) -> HosePlan:
    """Hose for the prediction; errors name the file and the key."""
    given = keys.layer_diameters if keys.wrap_diameter is None else (keys.wrap_diameter,) * 2
    if given is None or None not in (keys.wrap_diameter, keys.layer_diameters):
        raise in_toml(
            path, f"{place} needs the position of its cords, stated once",
            found="wrap_diameter and layer_diameters" if given else "neither",
            needed="wrap_diameter, the mean of the two layers, or layer_diameters, one of each",
        )  # fmt: skip
    if keys.dead_length is not None and keys.length is None:
        raise in_toml(
            path, f"{place}.dead_length is stated without length",
            needed='length = "2.4 m", relaxed, stretch-limited ends included',
        )  # fmt: skip
    length = np.nan if keys.length is None else keys.length
    if max(cord.strain, default=0.0) > _MOST_CORD_STRAIN:
        where = "cord" if place == "hose" else f"{place}.cord"
        raise in_toml(
            path, f"{where}.strain is more than a cord can stretch",
            found=f"{100 * max(cord.strain):g} %", needed=f"at most {100 * _MOST_CORD_STRAIN:g} %",
            hint='A bare number is a share: 22 % is 0.22 or "22 %".',
        )  # fmt: skip
    names = {item.name for item in fields(HoseDesign)} & _HoseKeys.model_fields.keys()
    try:
        design = HoseDesign(
            **keys.model_dump(include=names, exclude_none=True),
            layer_diameter=given,
            cord=CordCurve(np.array(cord.strain), np.array(cord.load)),
            dead_length_share=0.0 if keys.dead_length is None else keys.dead_length / length,
        )
    except SettingsError as error:
        key = "layer_diameters" if keys.wrap_diameter is None else "wrap_diameter"
        problem = error.problem.replace("layer_diameter", key)
        problem = problem.replace("dead_length_share", "dead_length over length")
        raise in_toml(
            path, f"{place}: {problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    if not 0 < keys.strain_step < 1:
        raise in_toml(
            path, f"{place}.strain_step is out of range", found=f"{keys.strain_step:g}",
            needed='above 0 and below 1, such as "1 %"',
        )  # fmt: skip
    return HosePlan(
        name=name,
        design=design,
        standard_uncertainty=_uncertainties(path, place, keys, design, length),
        strain_step=keys.strain_step,
        greatest_strain=np.nan if keys.greatest_strain is None else keys.greatest_strain,
        layers=tuple(_layer(path, f"{place}.layers.{one.name}", one) for one in keys.layers),
        length=length,
    )


def _layer(path: Path, place: str, layer: LayerSection) -> HelicalLayer:
    if not 0 < layer.wrap_angle < pi / 2:
        raise in_toml(
            path, f"{place}.wrap_angle is out of range",
            found=f"{math.degrees(layer.wrap_angle):g} deg",
            needed="between 0 and 90 deg, from the hose axis",
        )  # fmt: skip
    limits = [
        np.nan if limit is None else limit
        for limit in (layer.strain_limit, layer.compression_limit)
    ]
    # comparison with NaN is false, so unstated limits cause no error
    if limits[0] < 0 or limits[1] < 0 or limits[1] >= 1:
        raise in_toml(
            path, f"{place} has an impossible strain limit",
            found=f"{limits[0]:g} in tension, {limits[1]:g} in compression",
            needed="positive numbers, compression below 100 %",
        )  # fmt: skip
    return HelicalLayer(layer.name, layer.wrap_angle, *limits)


def _uncertainties(
    path: Path, place: str, keys: _HoseKeys, design: HoseDesign, length: float
) -> dict[str, float]:
    """Standard uncertainties in SI, by parameter; % is relative to the value."""
    found: dict[str, float] = {}
    for key, text in keys.standard_uncertainty.items():
        where = f"{place}.standard_uncertainty.{key}"
        if key not in _DIMENSIONS:
            raise in_toml(
                path, f"{where} is not a hose parameter that can have an uncertainty",
                needed="one of " + ", ".join(_DIMENSIONS),
            )  # fmt: skip
        if key in ("wrap_diameter", "layer_diameters") and getattr(keys, key) is None:
            raise in_toml(
                path, f"{where} is stated without {key}",
                needed="the key that the hose has",
            )  # fmt: skip
        name = _PARAMETERS.get(key, key)
        value = design.wrap_diameter if name == "layer_diameter" else getattr(design, name)
        if isinstance(text, str) and text.strip().endswith("%"):
            number = quantity_of(path, where, text, "strain") * float(np.mean(value))
        else:
            number = quantity_of(path, where, text, _DIMENSIONS[key])
            if key == "dead_length":
                number = number / length
        size = abs(float(np.mean(value)))
        # a dead length may be zero, with a relatively large uncertainty
        if not (np.isfinite(number) and 0 <= number < (size or 1.0)):
            raise in_toml(
                path, f"{where} is not a standard uncertainty", found=str(text),
                needed="zero or more, below the number itself; a dead_length needs the length",
            )  # fmt: skip
        found[name] = number
    return found


def load_hose(path: Path) -> tuple[HosePlan, _HoseSpecFile]:
    """Read SPEC.toml of a hose."""
    file = read_toml(
        path,
        _HoseSpecFile,
        what="the hose",
        needed="a SPEC.toml with [hose] and [cord]",
        keys="docs/predictions.md lists every key",
    )
    if file.target is not None and file.target.strain > _MOST_TARGET:
        raise in_toml(
            path, "target.strain is more than a hose can stretch",
            found=f"{100 * file.target.strain:g} %", needed=f"at most {100 * _MOST_TARGET:g} %",
            hint='A bare number is a share: 130 % is 1.3 or "130 %".',
        )  # fmt: skip
    return hose_of(path, path.stem, "hose", file.hose, file.cord), file

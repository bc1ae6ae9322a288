"""What a user may write of a hose to be predicted, and of a comparison, as pydantic models."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from reduction.campaign.quantities import Number
from reduction.predict.product import RubberLaw

_Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9][A-Za-z0-9_ \-]{0,99}$")]
Calibrated = Literal[
    "wrap_angle",
    "rubber_modulus",
    "cord_load_scale",
    "cord_strain_scale",
    "dead_length_share",
]
"""What a comparison may fit; diameters and cords are measured, not fitted."""


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class CordSection(_Section):
    """``[cord]``: measured points of one cord, the last one its break."""

    strain: tuple[Number, ...]
    load: tuple[str, ...]


class LayerSection(_Section):
    """``[[hose.layers]]``: a layer that is to carry no load."""

    name: _Name
    wrap_angle: str
    strain_limit: Number | None = None
    """Greatest tensile strain that it bears."""
    compression_limit: Number | None = None
    """Greatest compressive strain that it bears, a positive number."""


class HoseKeys(_Section):
    """``[hose]``, and ``[hoses.NAME]`` of a campaign without its cord."""

    wrap_angle: str
    """From the hose axis."""
    wrap_diameter: str | None = None
    """Mean of the two cord layers; or ``layer_diameters``."""
    layer_diameters: tuple[str, str] | None = None
    inner_diameter: str
    outer_diameter: str
    cords_per_length: str
    cord_diameter: str
    rubber_modulus: str
    rubber_law: RubberLaw = "neo-hookean"
    working_share: Number = Field(default=1 / 3)
    """Of the break load of a cord, at the safe working load."""
    cord_load_scale: Number = 1.0
    cord_strain_scale: Number = 1.0
    minimum_inner_diameter: str | None = None
    length: str | None = None
    """Relaxed, stretch-limited ends included; needed with ``dead_length``."""
    dead_length: str | None = None
    """Part of the length that does not stretch, both ends together."""
    strain_step: Number = "1 %"
    greatest_strain: Number | None = None
    standard_uncertainty: dict[str, Number] = Field(default_factory=dict)
    """By key of this table, in its unit or in % of its value."""
    layers: tuple[LayerSection, ...] = ()


class HoseSection(HoseKeys):
    """``[hoses.NAME]`` with ``[hoses.NAME.cord]``."""

    cord: CordSection


class TargetSection(_Section):
    """``[target]``: what a hose like this one is to do at its safe working load."""

    strain: Number
    tension: str | None = None


class ComparisonKeys(_Section):
    """``[comparison]``: how a measured curve meets the prediction."""

    specimen: str | None = None
    """Of the measured test, where it has several."""
    loading: Literal["static", "dynamic"] | None = None
    """How it was pulled, where its kind does not say it: a cyclic test may be slow."""
    calibrate: tuple[Calibrated, ...] = ()
    """Numbers of the hose to be fitted to the measured curve."""


class HoseSpecFile(_Section):
    """SPEC.toml of ``reduction predict hose`` and ``reduction compare``."""

    hose: HoseKeys
    cord: CordSection
    target: TargetSection | None = None
    comparison: ComparisonKeys = ComparisonKeys()


class ComparisonSection(ComparisonKeys):
    """``[comparisons.NAME]``."""

    measured: str
    """Test or test/step of the campaign."""
    predicted: str
    """One of ``[hoses]``."""

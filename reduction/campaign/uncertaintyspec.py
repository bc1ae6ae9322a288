"""``[uncertainty]`` of campaign.toml: what is known of the errors of the instruments."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict

from reduction.campaign.quantities import Number, TableReader
from reduction.errors import ReductionError, SettingsError
from reduction.record import Specimen
from reduction.uncertainty.stated import (
    StatedErrors,
    of_expanded,
    of_half_width,
    of_resolution,
)
from reduction.units import Dimension

_HALF = 0.5
"""Relative errors beyond this are no first-order ones: nothing that is carried would hold."""
_OF_DIAMETER = 0.2
"""Of a diameter: 40 % of its area, and of every stress and modulus."""
_MOST: dict[Dimension, tuple[float, str]] = {
    "strain": (_HALF, ", at most 50 %"),
    "temperature": (100.0, ", at most 100 K, as a difference: in K"),
}


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Expanded(_Section):
    """As a certificate of calibration prints it: ``{ expanded = "0.2 %", k = 2 }``."""

    expanded: Number
    k: float


class Limits(_Section):
    """As a data sheet prints it: ``{ half_width = "0.25 %", shape = "rectangular" }``."""

    half_width: Number
    shape: Literal["rectangular", "triangular", "arcsine"] = "rectangular"


Stated = Number | Expanded | Limits
"""A plain value is a standard uncertainty."""


class TensionSection(_Section):
    """``[uncertainty.tension]``."""

    gain: Stated | None = None
    """Of the whole indication: ``"0.1 %"``."""
    offset: Stated | None = None
    """Of the zero."""
    noise: Stated | None = None
    """Of one reading."""
    resolution: Number | None = None
    """One step of the indication."""
    one_load_cell: bool = False
    """All tension channels are of one cell, or calibrated against one."""


class PositionSection(_Section):
    """``[uncertainty.crosshead_position]``."""

    gain: Stated | None = None
    offset: Stated | None = None
    noise: Stated | None = None
    resolution: Number | None = None


class TemperatureSection(_Section):
    """``[uncertainty.temperature]``: both keys, or nothing can be said of it."""

    value: Stated
    """Of the temperature of a specimen while it is tested: ``"2 K"``."""
    stiffness_per_kelvin: Number
    """Relative change of its tension at one strain: ``"0.3 %"``."""


class UncertaintySection(_Section):
    """``[uncertainty]``: standard uncertainties of what the tests of the campaign share."""

    tension: TensionSection = TensionSection()
    crosshead_position: PositionSection = PositionSection()
    lag: Stated | None = None
    """Between the two channels."""
    diameter: Stated | None = None
    """Of the mean of the readings of a specimen."""
    strain: Stated | None = None
    """Relative: what the strain method itself may miss."""
    rated_break_strength: Stated | None = None
    """Relative."""
    temperature: TemperatureSection | None = None


def stated_errors(
    path: Path, section: UncertaintySection, specimens: Iterable[Specimen] = ()
) -> StatedErrors:
    """Standard uncertainties in SI; an error names campaign.toml and the key.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml.
    section : UncertaintySection
        As written.
    specimens : iterable of Specimen
        Of the campaign, whose diameters bound what may be stated of them.

    Returns
    -------
    errors : StatedErrors
        Zero where nothing is written.

    Raises
    ------
    SettingsError
        If a value has the wrong unit, is negative, or is beyond what can be meant.

    Notes
    -----
    What only a log can bound (zeros, readings and lag) is looked at when the test is reduced, by
    `reduction.pipeline.statedlimits.check_stated_errors`.
    """
    reader = TableReader(path, "uncertainty")

    def standard(key: str, text: Stated | None, dimension: Dimension) -> float:
        if text is None:
            return 0.0
        try:
            if isinstance(text, Expanded):
                found = of_expanded(
                    reader.value(f"{key}.expanded", text.expanded, dimension), text.k
                )
            elif isinstance(text, Limits):
                found = of_half_width(
                    reader.value(f"{key}.half_width", text.half_width, dimension), text.shape
                )
            else:
                found = reader.value(key, text, dimension)
        except SettingsError:
            raise
        except ReductionError as error:
            fault = SettingsError(error.problem, found=error.found, needed=error.needed)
            raise reader.fault(f"{key}: {fault.problem}", fault) from error
        # a temperature in degC would be one above freezing
        most, words = _MOST.get(dimension, (float("inf"), ""))
        if not 0 <= found <= most:
            fault = SettingsError(
                "this is no standard uncertainty", found=str(text), needed=f"zero or more{words}"
            )
            raise reader.fault(f"{key}: {fault.problem}", fault)
        return found

    def reading(name: str, of: TensionSection | PositionSection, dimension: Dimension) -> float:
        noise = standard(f"{name}.noise", of.noise, dimension)
        step = standard(f"{name}.resolution", of.resolution, dimension)
        return float((noise**2 + of_resolution(step) ** 2) ** 0.5)

    tension, position, warmth = section.tension, section.crosshead_position, section.temperature
    stiffness = 0.0
    if warmth is not None:
        kelvin = standard("temperature.value", warmth.value, "temperature")
        each = reader.value(
            "temperature.stiffness_per_kelvin", warmth.stiffness_per_kelvin, "strain"
        )
        stiffness = kelvin * abs(each)
        if stiffness > _HALF:
            raise reader.fault(
                "temperature: value times stiffness_per_kelvin is no standard uncertainty",
                SettingsError(
                    "", found=f"{100 * stiffness:,.0f} % of the stiffness", needed="at most 50 %"
                ),
            )
    diameter = standard("diameter", section.diameter, "length")
    for specimen in specimens:
        if specimen.diameter and diameter > _OF_DIAMETER * specimen.mean_diameter:
            raise reader.fault(
                f"diameter: this is no standard uncertainty of the diameter of '{specimen.name}'",
                SettingsError(
                    "",
                    found=f"{1e3 * diameter:.4g} mm of {1e3 * specimen.mean_diameter:.4g} mm",
                    needed="at most 20 % of it, which is 40 % of every modulus",
                    hint="It is of the mean of the readings, not the diameter itself.",
                ),
            )
    return StatedErrors(
        tension_gain=standard("tension.gain", tension.gain, "strain"),
        tension_offset=standard("tension.offset", tension.offset, "force"),
        tension_reading=reading("tension", tension, "force"),
        position_gain=standard("crosshead_position.gain", position.gain, "strain"),
        position_offset=standard("crosshead_position.offset", position.offset, "length"),
        position_reading=reading("crosshead_position", position, "length"),
        lag=standard("lag", section.lag, "time"),
        diameter=diameter,
        strain_gain=standard("strain", section.strain, "strain"),
        rated_break_strength=standard(
            "rated_break_strength", section.rated_break_strength, "strain"
        ),
        stiffness=stiffness,
        has_one_load_cell=tension.one_load_cell,
    )

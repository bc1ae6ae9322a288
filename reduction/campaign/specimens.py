"""``[specimens.NAME]`` to `Specimen`, in SI."""

from __future__ import annotations

from pathlib import Path

from reduction.campaign.faults import in_toml, quantity_of
from reduction.campaign.model import SpecimenSection
from reduction.record import Specimen


def _length(text: str, where: str, path: Path) -> float:
    value = quantity_of(path, where, text, "length")
    if not value > 0:
        raise in_toml(path, f"{where} is not positive", found=text, needed="above zero")
    return value


def _linear_densities(
    path: Path, name: str, section: SpecimenSection
) -> tuple[float | None, float | None]:
    """Mass a length in air and in water; in water it is less, and of what floats below zero."""
    dry, wet = (
        None if text is None else quantity_of(path, where, text, "linear_density")
        for where, text in (
            (f"specimens.{name}.linear_density", section.linear_density),
            (f"specimens.{name}.wet_linear_density", section.wet_linear_density),
        )
    )
    if dry is not None and not dry > 0:
        raise in_toml(
            path, f"specimens.{name}.linear_density is not positive", found=section.linear_density,
            needed="above zero",
        )  # fmt: skip
    if dry is not None and wet is not None and not wet < dry:
        raise in_toml(
            path, f"specimens.{name}.wet_linear_density is not below linear_density",
            found=f"{section.wet_linear_density}, {section.linear_density}",
            needed="the mass in air less that of the displaced water",
        )  # fmt: skip
    return dry, wet


def specimen_of(path: Path, name: str, section: SpecimenSection) -> Specimen:
    """The specimen before its first test; an error names campaign.toml and the key."""
    readings = (section.diameter,) if isinstance(section.diameter, str) else section.diameter
    where = f"specimens.{name}.diameter"
    stretched = tuple(
        (
            quantity_of(path, f"specimens.{name}.stretched_diameter", stretch, "strain"),
            _length(reading, f"specimens.{name}.stretched_diameter", path),
        )
        for stretch, at_stretch in section.stretched_diameter.items()
        for reading in at_stretch
    )
    strength = section.rated_break_strength
    dry, wet = _linear_densities(path, name, section)
    gauge, spread = section.gauge_length, section.gauge_length_standard_uncertainty
    if gauge is None and spread is not None:
        raise in_toml(
            path, f"specimens.{name}.gauge_length_standard_uncertainty stands alone",
            found=spread, needed="gauge_length beside it",
        )  # fmt: skip
    return Specimen(
        name=name,
        kind=section.kind,
        material=section.material,
        construction=section.construction,
        condition=section.condition,
        diameter=tuple(_length(reading, where, path) for reading in readings),
        stretched_diameters=stretched,
        rated_break_strength=None
        if strength is None
        else quantity_of(path, f"specimens.{name}.rated_break_strength", strength, "force"),
        rated_break_strength_source=section.rated_break_strength_source,
        linear_density=dry,
        wet_linear_density=wet,
        gauge_length=None
        if gauge is None
        else _length(gauge, f"specimens.{name}.gauge_length", path),
        gauge_length_standard_uncertainty=None
        if spread is None
        else _length(spread, f"specimens.{name}.gauge_length_standard_uncertainty", path),
        earlier_cycles=section.earlier_cycles,
        earlier_flex_cycles=section.earlier_flex_cycles,
        notes=(section.note,) if section.note else (),
    )

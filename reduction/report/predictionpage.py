"""Pages of predictions that no campaign holds: a wave load, an armour."""

from __future__ import annotations

from pathlib import Path

from reduction.pipeline.armour import PredictedArmour
from reduction.pipeline.waveload import PredictedWaveLoad
from reduction.units import UnitSystem

__all__ = ["write_armour_page", "write_wave_page"]


def write_wave_page(
    found: PredictedWaveLoad, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    raise NotImplementedError


def write_armour_page(
    found: PredictedArmour, out: Path, *, name: str, units: UnitSystem = "si"
) -> Path:
    raise NotImplementedError

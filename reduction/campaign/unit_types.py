"""Types of keys that carry a unit in TOML and are numbers in SI once the file is read."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, Strict
from pydantic_core import CoreSchema, core_schema

from reduction.quantities.units import Dimension, parse_quantity
from reduction.record.errors import SettingsError

Number = str | Annotated[float, Strict()]
"""A number of TOML or text with a unit; true and false are neither."""

_GREATEST = 1e15


def value_in_si(text: Number, dimension: Dimension) -> float:
    """Value in SI of a number or of a text with a unit."""
    value = parse_quantity(text, dimension)
    if not abs(value) < _GREATEST:
        raise SettingsError(
            "a number is outside the physical range", found=str(text), needed="a finite number"
        )
    return value


class ReadKey(ABC):
    """How a key is read, as an annotation: the JSON Schema is that of what is written."""

    @property
    @abstractmethod
    def written(self) -> Any:
        """Type of what may stand in the file."""

    @abstractmethod
    def value(self, stated: Any) -> Any:
        """What it means, a number in SI; `SettingsError` where it cannot be meant."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Read what is written, then what it means; the number is given out as it is."""
        return core_schema.no_info_after_validator_function(
            self.value,
            handler.generate_schema(self.written),
            serialization=core_schema.simple_ser_schema("any"),
        )


@dataclass(frozen=True)
class InSI(ReadKey):
    """A number with a unit, and what it has to be above or may not be below."""

    dimension: Dimension
    above: float = -inf
    least: float = -inf

    @property
    def written(self) -> Any:
        """A text, or of what has no unit a number too."""
        return Number if self.dimension in ("strain", "number") else str

    def value(self, stated: Number) -> float:
        """The number in SI; `SettingsError` where it cannot be meant."""
        value = value_in_si(stated, self.dimension)
        if not value > self.above:
            raise SettingsError("is not positive", found=f"{value:g} in SI", needed="above zero")
        if value < self.least:
            raise SettingsError("is negative", found=f"{value:g} in SI", needed="zero or more")
        return value


@dataclass(frozen=True)
class ReadText(ReadKey):
    """A text that a function reads."""

    read: Callable[[str], Any]
    written = str

    def value(self, stated: str) -> Any:
        """What the function makes of it."""
        return self.read(stated)


Length = Annotated[float, InSI("length")]
PositiveLength = Annotated[float, InSI("length", above=0.0)]
Force = Annotated[float, InSI("force")]
PositiveArea = Annotated[float, InSI("area", above=0.0)]
PositiveForce = Annotated[float, InSI("force", above=0.0)]
Strain = Annotated[float, InSI("strain")]
"""Also a share: ``0.01`` or ``"1 %"``."""
PositiveStrain = Annotated[float, InSI("strain", above=0.0)]
Angle = Annotated[float, InSI("angle")]
Stress = Annotated[float, InSI("stress")]
Time = Annotated[float, InSI("time")]
Ratio = Annotated[float, InSI("number")]
PositiveNumber = Annotated[float, InSI("number", above=0.0)]
PositiveDensity = Annotated[float, InSI("density", above=0.0)]
Velocity = Annotated[float, InSI("velocity")]

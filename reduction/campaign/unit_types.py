"""Types of keys with a unit in TOML that are numbers in SI after reading."""

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
"""A TOML number, or text with a unit; booleans are excluded."""

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
    """How a key is read, as an annotation; the JSON Schema describes the written form."""

    @property
    @abstractmethod
    def written(self) -> Any:
        """Type allowed in the file."""

    @abstractmethod
    def value(self, stated: Any) -> Any:
        """Value as a number in SI; `SettingsError` if it is invalid."""

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validate the written form, then convert it; numbers are serialised unchanged."""
        return core_schema.no_info_after_validator_function(
            self.value,
            handler.generate_schema(self.written),
            serialization=core_schema.simple_ser_schema("any"),
        )


@dataclass(frozen=True)
class InSI(ReadKey):
    """A number with a unit, and its lower limit, exclusive or inclusive."""

    dimension: Dimension
    above: float = -inf
    least: float = -inf

    @property
    def written(self) -> Any:
        """A text, or also a number if it has no unit."""
        return Number if self.dimension in ("strain", "number") else str

    def value(self, stated: Number) -> float:
        """The number in SI; `SettingsError` if it is invalid."""
        value = value_in_si(stated, self.dimension)
        if not value > self.above:
            raise SettingsError("is not positive", found=f"{value:g} in SI", needed="above zero")
        if value < self.least:
            raise SettingsError("is negative", found=f"{value:g} in SI", needed="zero or more")
        return value


@dataclass(frozen=True)
class ReadText(ReadKey):
    """A text converted by a function."""

    read: Callable[[str], Any]
    written = str

    def value(self, stated: str) -> Any:
        """Result of the function."""
        return self.read(stated)


Length = Annotated[float, InSI("length")]
PositiveLength = Annotated[float, InSI("length", above=0.0)]
Force = Annotated[float, InSI("force")]
PositiveArea = Annotated[float, InSI("area", above=0.0)]
PositiveForce = Annotated[float, InSI("force", above=0.0)]
Strain = Annotated[float, InSI("strain")]
"""A ratio also as a number: ``0.01`` or ``"1 %"``."""
PositiveStrain = Annotated[float, InSI("strain", above=0.0)]
Angle = Annotated[float, InSI("angle")]
Stress = Annotated[float, InSI("stress")]
Time = Annotated[float, InSI("time")]
Ratio = Annotated[float, InSI("number")]
PositiveNumber = Annotated[float, InSI("number", above=0.0)]
PositiveDensity = Annotated[float, InSI("density", above=0.0)]
Velocity = Annotated[float, InSI("velocity")]

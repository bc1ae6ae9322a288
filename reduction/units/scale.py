"""Factor and offset from a unit, as a test house writes it, to SI."""

from __future__ import annotations

import re
from functools import lru_cache
from tokenize import TokenError
from typing import Literal

import pint

from reduction.errors import SettingsError

Dimension = Literal[
    "time", "length", "force", "strain", "stress", "area", "frequency", "temperature", "angle",
    "mass", "velocity", "number", "force_rate", "density", "per_length",
    "linear_density", "information",
]  # fmt: skip

DIMENSIONS: dict[Dimension, str] = {
    "time": "s",
    "length": "m",
    "force": "N",
    "strain": "1",
    "stress": "Pa",
    "area": "m2",
    "frequency": "Hz",
    "temperature": "K",
    "angle": "rad",
    "mass": "kg",
    "velocity": "m s-1",
    "number": "1",
    "force_rate": "N s-1",
    "density": "kg m-3",
    "per_length": "m-1",
    "linear_density": "kg m-1",
    "information": "byte",
}
_PINT_SI = {
    "m2": "m**2",
    "m s-1": "m/s",
    "N s-1": "N/s",
    "1": "dimensionless",
    "kg m-3": "kg/m**3",
    "m-1": "1/m",
    "kg m-1": "kg/m",
}
# as test machines write them, where pint has no such name
_SPELLINGS = {"Sec": "s", "SEC": "s", "Secs": "s", "lb": "pound", "IN": "in", "KN": "kN"}
# what pint lets out when a text is no unit expression
_NO_UNIT = (
    pint.PintError, ValueError, TypeError, AttributeError, SyntaxError, AssertionError,
    ArithmeticError, TokenError,
)  # fmt: skip
# no unit of a test house is longer, and a tower of powers would never end
_LONGEST, _MOST_POWERS = 40, 4
# pint passes over a comment, and over much that follows or precedes a unit
_STRAY = re.compile(r"[^\w *·/^().%°²³-]")
# a dimension that shares its units with another one stands behind it
_AS_FORCE_FIRST: tuple[Dimension, ...] = (
    "force", "number", *(name for name in DIMENSIONS if name not in ("force", "number")),
)  # fmt: skip


@lru_cache(maxsize=1)
def registry() -> pint.UnitRegistry[float]:
    """Units of pint, with those of test houses that it lacks."""
    known: pint.UnitRegistry[float] = pint.UnitRegistry(cache_folder=None)
    known.define("kip = 1000 * lbf")
    known.define("tonne_force = 1000 * kgf = tf")
    known.define("rev = revolution = cyc")
    known.define("cpm = cycle / minute")
    return known


def _pint_text(unit: str) -> str:
    text = unit.strip()
    text = _SPELLINGS.get(text, text)
    if text in ("", "1", "-"):
        return "dimensionless"
    # the degree, square and dot signs that test machines write
    return (
        text.replace("%", "percent")
        .replace("µ", "micro")
        .replace("μ", "micro")
        .replace("²", "**2")
        .replace("³", "**3")
        .replace("°C", "degC")
        .replace("°F", "degF")
        .replace("°", "degree")
        .replace("·", "*")
    )


@lru_cache(maxsize=512)
def scale_to_si(unit: str, dimension: Dimension) -> tuple[float, float]:
    """Factor and offset that turn a value in ``unit`` into SI: ``factor * value + offset``.

    Parameters
    ----------
    unit : str
        As the test house writes it: ``lbf``, ``ft``, ``kN``, ``mm``, ``%``, ``°C``.
    dimension : Dimension
        What the channel or setting has to be.

    Returns
    -------
    factor, offset : float
        To SI; the offset is zero for all but temperatures.

    Raises
    ------
    SettingsError
        If the unit is unknown or has another dimension.

    Examples
    --------
    >>> scale_to_si("lbf", "force")
    (4.4482216152605, 0.0)
    >>> scale_to_si("%", "strain")
    (0.01, 0.0)
    """
    known = registry()
    target = DIMENSIONS[dimension]
    powers = unit.count("^") + unit.count("**")
    too_long = len(unit) > _LONGEST or powers > _MOST_POWERS or re.search(r"\d{3}", unit)
    is_strange = _STRAY.search(unit.strip()) or re.search(r"\*\*\s*\d+\s*\*\*", unit)
    if too_long or is_strange:
        raise SettingsError(
            "a unit is not one that a test house writes",
            found=repr(unit[:_LONGEST]),
            needed=f"a unit of {dimension}, such as {target}",
        )
    try:
        # pound is a mass in pint; a test house that writes lb for a load means lbf
        text = "lbf" if dimension == "force" and unit.strip() in ("lb", "lbs") else _pint_text(unit)
        target_unit = known.Unit(_PINT_SI.get(target, target))
        # turns and radians a second are frequencies too; pint has them 2 pi and 1 times a hertz
        if dimension == "frequency" and "radian" in dict(
            known.Quantity(1.0, text).to_root_units().unit_items()
        ):
            target_unit = known.Unit("turn/s")
        zero = known.Quantity(0.0, text).to(target_unit).magnitude
        one = known.Quantity(1.0, text).to(target_unit).magnitude
    except pint.DimensionalityError as error:
        raise SettingsError(
            f"unit '{unit}' is not a unit of {dimension}",
            found=f"'{unit}', a unit of {error.dim1 or 'another dimension'}",
            needed=f"a unit of {dimension}, such as {target}",
        ) from error
    except _NO_UNIT as error:
        raise SettingsError(
            f"unit '{unit}' is not known",
            found=f"'{unit}'",
            needed=f"a unit of {dimension}, such as {target}",
        ) from error
    return float(one - zero), float(zero)


def scale_of_unit(unit: str) -> tuple[str, float, float]:
    """SI unit of a unit whose dimension nobody has stated, and the way to it.

    Parameters
    ----------
    unit : str
        As a person or a header of this package writes it: ``lbf``, ``J/m``, ``J m-1``,
        ``Pa s``; ``lb`` is a force here too.

    Returns
    -------
    si_unit : str
        As in `DIMENSIONS` where one fits, else made of base units.
    factor, offset : float
        To SI: ``factor * value + offset``.

    Raises
    ------
    SettingsError
        If the unit is unknown.

    Examples
    --------
    >>> scale_of_unit("ft lbf")
    ('kg m2 s-2', 1.35581794833140, 0.0)
    >>> scale_of_unit("J m-1")
    ('N', 1.0, 0.0)
    """
    # a power may stand behind its unit, as in products
    text = re.sub(r"(?<=[A-Za-z])(-?\d+)\b", r"**\1", unit.strip())
    for dimension in _AS_FORCE_FIRST:
        try:
            return DIMENSIONS[dimension], *scale_to_si(text, dimension)
        except SettingsError as error:
            if "is not a unit of" not in error.problem:
                hint = "Without a unit the numbers stay as they are."
                raise SettingsError(
                    error.problem, found=error.found, needed="a unit that is known", hint=hint
                ) from error
    base = registry().Quantity(1.0, _pint_text(text)).to_base_units()
    powers = pint.util.to_units_container(base.units).items()
    si_unit = " ".join(
        registry().get_symbol(name) + ("" if power == 1 else f"{power:g}")
        for name, power in sorted(powers)
    )
    return si_unit, float(base.magnitude), 0.0

"""Unit conversion at the interfaces: text with a unit to SI, and SI to displayed values.

Inside the package every number is SI.  The factors are from pint, and exact by definition for the
pound-force, the inch and the foot.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from tokenize import TokenError
from typing import TYPE_CHECKING, Literal

from reduction.record.errors import SettingsError
from reduction.record.plain_text import cut

if TYPE_CHECKING:  # importing it takes longer than a look-up without it
    import pint

Dimension = Literal[
    "time", "length", "force", "strain", "stress", "area", "frequency", "temperature", "angle",
    "mass", "velocity", "number", "force_rate", "density", "per_length",
    "linear_density", "compliance", "information",
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
    "compliance": "m N-1",
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
    "m N-1": "m/N",
}

# spellings of test machines that pint lacks
_SPELLINGS = {
    "Sec": "s", "SEC": "s", "Secs": "s", "Sek": "s", "sek": "s", "mSec": "ms", "msec": "ms",
    "lb": "pound", "te": "tonne", "IN": "in", "KN": "kN", "MM": "mm", "Kgf": "kgf", "KGF": "kgf",
    "LBF": "lbf",
    "с": "s", "сек": "s", "мм": "mm", "Н": "N", "кН": "kN",  # noqa: RUF001
    "秒": "s", "毫米": "mm", "牛": "N", "千牛": "kN",
}  # fmt: skip

_PLAIN: tuple[Dimension, ...] = ("strain", "number", "angle")

_USUAL: dict[tuple[str, Dimension], tuple[float, float]] = {
    **{("", one): (1.0, 0.0) for one in _PLAIN},
    **{("1", one): (1.0, 0.0) for one in _PLAIN},
    **{("%", one): (0.01, 0.0) for one in _PLAIN},
    **{("deg", one): (0.017453292519943295, 0.0) for one in _PLAIN},
    **{("rad", one): (1.0, 0.0) for one in _PLAIN},
    ("s", "time"): (1.0, 0.0),
    ("ms", "time"): (0.001, 0.0),
    ("min", "time"): (60.0, 0.0),
    ("h", "time"): (3600.0, 0.0),
    ("m", "length"): (1.0, 0.0),
    ("cm", "length"): (0.01, 0.0),
    ("mm", "length"): (0.001, 0.0),
    ("ft", "length"): (0.30479999999999996, 0.0),
    ("in", "length"): (0.0254, 0.0),
    ("inch", "length"): (0.0254, 0.0),
    ("N", "force"): (1.0, 0.0),
    ("kN", "force"): (1000.0, 0.0),
    ("MN", "force"): (1e6, 0.0),
    ("lbf", "force"): (4.4482216152605005, 0.0),
    ("lb", "force"): (4.4482216152605005, 0.0),
    ("kip", "force"): (4448.221615260501, 0.0),
    ("kgf", "force"): (9.80665, 0.0),
    ("Pa", "stress"): (1.0, 0.0),
    ("kPa", "stress"): (1000.0, 0.0),
    ("MPa", "stress"): (1e6, 0.0),
    ("GPa", "stress"): (1e9, 0.0),
    ("bar", "stress"): (1e5, 0.0),
    ("psi", "stress"): (6894.7572931683635, 0.0),
    ("ksi", "stress"): (6894757.293168363, 0.0),
    ("Hz", "frequency"): (1.0, 0.0),
    ("mHz", "frequency"): (0.001, 0.0),
    ("cycle/minute", "frequency"): (0.016666666666666666, 0.0),
    ("K", "temperature"): (1.0, 0.0),
    ("degC", "temperature"): (1.0, 273.15),
    ("°C", "temperature"): (1.0, 273.15),
    ("kg", "mass"): (1.0, 0.0),
    ("g", "mass"): (0.001, 0.0),
    ("lb", "mass"): (0.4535923700000001, 0.0),
    ("m/s", "velocity"): (1.0, 0.0),
    ("mm/s", "velocity"): (0.001, 0.0),
    ("mm/min", "velocity"): (1.6666666666666667e-05, 0.0),
    ("ft/s", "velocity"): (0.30479999999999996, 0.0),
    ("in/min", "velocity"): (0.0004233333333333333, 0.0),
    ("in/s", "velocity"): (0.0254, 0.0),
    ("kg/m", "linear_density"): (1.0, 0.0),
    ("g/m", "linear_density"): (0.001, 0.0),
    ("kg/m^3", "density"): (1.0, 0.0),
    ("m/N", "compliance"): (1.0, 0.0),
    ("1/m", "per_length"): (1.0, 0.0),
    ("1/in", "per_length"): (39.37007874015748, 0.0),
}
"""Factor and offset from pint for the most common units of logs and campaigns; each unit with all
its dimensions except information.
"""

# exceptions of pint for a text that is not a unit, beside its own errors
_NO_UNIT = (
    ValueError, TypeError, AttributeError, SyntaxError, AssertionError, ArithmeticError, TokenError,
)  # fmt: skip

# longer than any unit of a test house; a tower of powers would never finish
_LONGEST, _MOST_POWERS = 40, 4

# pint ignores a comment, and much of what precedes or follows a unit
_STRAY = re.compile(r"[^\w *·/^().%°²³-]")

# a dimension that shares its units with another is listed after it
_AS_FORCE_FIRST: tuple[Dimension, ...] = (
    "force", "number", *(name for name in DIMENSIONS if name not in ("force", "number")),
)  # fmt: skip


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[float]:
    """Unit registry of pint, with the test-house units that it lacks."""
    import pint

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
    # powers, degree, square and dot signs used by test houses
    text = re.sub(r"(?<=[A-Za-z])([23])(?!\w)", r"**\1", text)
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


# signs that look like a degree: of a ring above, of an ordinal, of one letter with its C
_DEGREES = str.maketrans({"\u02da": "°", "\u00ba": "°", "\u2103": "°C", "\u2109": "°F"})


@lru_cache(maxsize=512)
def scale_to_si(unit: str, dimension: Dimension) -> tuple[float, float]:
    """Factor and offset that convert a value in ``unit`` to SI: ``factor * value + offset``.

    Conversion to SI; the offset is zero except for temperatures.

    Examples
    --------
    >>> scale_to_si("kN", "force")
    (1000.0, 0.0)
    >>> scale_to_si("%", "strain")
    (0.01, 0.0)
    """
    unit = unit.translate(_DEGREES)
    usual = _USUAL.get((unit, dimension))
    if usual is not None:
        return usual
    others = [other for known, other in _USUAL if known == unit]
    if others and dimension != "information":
        raise _of_other_dimension(unit, dimension, others[0])
    return _scale_by_pint(unit, dimension)


def _of_other_dimension(unit: str, dimension: Dimension, found: str) -> SettingsError:
    is_weight = dimension == "force" and found.strip("[]") == "mass"
    return SettingsError(
        f"unit '{unit}' is not a unit of {dimension}",
        found=f"'{unit}', a unit of {found or 'another dimension'}",
        needed=f"a unit of {dimension}, such as {DIMENSIONS[dimension]}",
        hint='A load in kilograms is in "kgf", in tonnes in "tf", in pounds in "lbf".'
        if is_weight
        else None,
    )


def _scale_by_pint(unit: str, dimension: Dimension) -> tuple[float, float]:
    import pint

    known = _registry()
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
        # the pound is a mass in pint; a test house that writes lb for a load means lbf
        text = "lbf" if dimension == "force" and unit.strip() in ("lb", "lbs") else _pint_text(unit)
        target_unit = known.Unit(_PINT_SI.get(target, target))
        # in pint, turns and radians per second are frequencies too, 2 pi and 1 times a hertz
        if dimension == "frequency" and "radian" in dict(
            known.Quantity(1.0, text).to_root_units().unit_items()
        ):
            target_unit = known.Unit("turn/s")
        # a number of cycles is a count; in pint each is 2 pi
        names = [name for name, _ in known.Quantity(1.0, text).unit_items()]
        if dimension == "number" and any(name.endswith(("turn", "rev")) for name in names):
            target_unit = known.Unit("turn")
        zero = known.Quantity(0.0, text).to(target_unit).magnitude
        one = known.Quantity(1.0, text).to(target_unit).magnitude
    except pint.DimensionalityError as error:
        raise _of_other_dimension(unit, dimension, str(error.dim1)) from error
    except (pint.PintError, *_NO_UNIT) as error:
        raise SettingsError(
            f"unit '{unit}' is not known",
            found=f"'{unit}'",
            needed=f"a unit of {dimension}, such as {target}",
        ) from error
    return float(one - zero), float(zero)


def scale_of_unit(unit: str) -> tuple[str, float, float]:
    """SI unit and conversion for a unit of unstated dimension.

    ``si_unit``: unit from `DIMENSIONS` if one matches, else composed of base units.

    Examples
    --------
    >>> unit, factor, offset = scale_of_unit("ft lbf")
    >>> unit, round(factor, 12), offset
    ('kg m2 s-2', 1.355817948331, 0.0)
    >>> scale_of_unit("J m-1")
    ('N', 1.0, 0.0)
    """
    # a power may follow its unit, as in products
    text = re.sub(r"(?<=[A-Za-z])(-?\d+)\b", r"**\1", unit.strip())
    for dimension in _AS_FORCE_FIRST:
        if (text, dimension) in _USUAL:
            return DIMENSIONS[dimension], *_USUAL[text, dimension]
    for dimension in _AS_FORCE_FIRST:
        try:
            return DIMENSIONS[dimension], *scale_to_si(text, dimension)
        except SettingsError as error:
            if "is not a unit of" not in error.problem:
                hint = "Without a unit the numbers stay as they are."
                raise SettingsError(
                    error.problem, found=error.found, needed="a unit that is known", hint=hint
                ) from error
    import pint

    base = _registry().Quantity(1.0, _pint_text(text)).to_base_units()
    powers = pint.util.to_units_container(base.units).items()
    si_unit = " ".join(
        _registry().get_symbol(name) + ("" if power == 1 else f"{power:g}")
        for name, power in sorted(powers)
    )
    return si_unit, float(base.magnitude), 0.0


_PER_LENGTH = re.compile(
    r"/\s*\(?(?:[cmk]?m|ft|in|inch)\)?\s*$"
    r"|(?<![a-zA-Z])(?:[cmk]?m|ft|in)(?:\^|\*\*)?-1\b"
)


def scale_to_show(unit: str) -> tuple[str, float, float]:
    """SI unit to show and conversion, where an energy per length is not written as a force.

    Examples
    --------
    >>> [scale_to_show(one)[0] for one in ("J/m", "ft lbf / ft", "J m-1", "lbf", "kN", "kN/m")]
    ['J m-1', 'J m-1', 'J m-1', 'N', 'N', 'kg s-2']
    """
    si_unit, factor, offset = scale_of_unit(unit)
    is_energy = si_unit == "N" and _PER_LENGTH.search(unit) is not None
    return "J m-1" if is_energy else si_unit, factor, offset


UnitSystem = Literal["si", "us"]

_US = {
    "m": "ft",
    "N": "lbf",
    "Pa": "psi",
    "m2": "in2",
    "J m-1": "ft lbf / ft",
    "N m": "ft lbf",
    "m s-1": "ft s-1",
    "N s": "lbf s",
}

_PER_SI = {
    "ft": 3.2808398950131235,
    "lbf": 0.22480894309971053,
    "psi": 0.0001450377377302092,
    "in2": 1550.0031000062002,
    "ft lbf / ft": 0.22480894309971053,
    "ft s-1": 3.2808398950131235,
    "lbf s": 0.22480894309971053,
    "ft lbf": 0.7375621492772655,
}
"""Factor from SI to the displayed unit, from pint."""

_UNIT_AND_POWER = re.compile(r"([^\s\d/-]+)(-?\d+)?")


def combined_unit(unit: str, others: Sequence[str], powers: Sequence[int]) -> str:
    """Unit of a coefficient: that of the response divided by those of its factors.

    Examples
    --------
    >>> combined_unit("N", ["Hz", "m s-1"], [2, 1])
    'N Hz-2 m-1 s'
    >>> combined_unit("N", ["Hz", "N"], [0, 2])
    'N-1'
    """
    # a unit that is not a product of powers is kept unchanged
    is_product = re.fullmatch(rf"({_UNIT_AND_POWER.pattern}\s*)+", unit) and "(" not in unit
    total: Counter[str] = Counter()
    factors = [(unit, 1)] if is_product else []
    factors += [(other, -power) for other, power in zip(others, powers, strict=True)]
    for one, times in factors:
        for name, own in _UNIT_AND_POWER.findall("" if one == "1" else one):
            total[name] += times * int(own or 1)
    parts = [name if power == 1 else f"{name}{power}" for name, power in total.items() if power]
    if not is_product and unit not in ("1", ""):
        parts.insert(0, f"({unit})" if "/" in unit and parts else unit)
    return " ".join(parts) or "1"


def display_unit(si_unit: str, system: UnitSystem) -> tuple[str, float]:
    """Display unit, and the factor from SI to it.

    Examples
    --------
    >>> unit, factor = display_unit("N", "us")
    >>> unit, round(factor, 12)
    ('lbf', 0.2248089431)
    """
    if system == "si":
        return si_unit, 1.0
    if system != "us":
        raise SettingsError("unit system is not known", found=repr(system), needed="si or us")
    shown = _US.get(si_unit)
    if shown is None:
        return si_unit, 1.0
    return shown, _PER_SI[shown]


_QUANTITY = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")


def parse_quantity(
    text: str | float, dimension: Dimension, *, rated_break_strength: float | None = None
) -> float:
    """Value in SI of a text with a unit, such as ``"21.5 ft"`` or ``"12 %RBS"``.

    Parameters
    ----------
    text : str or float
        A number and a unit; a bare number only if the dimension is number or strain.
    dimension : Dimension
        Required dimension.
    rated_break_strength : float, optional
        Reference of ``%RBS`` (also ``%MBS``, ``%MBL``). [N]

    Returns
    -------
    value : float
        Value in SI.

    Raises
    ------
    SettingsError
        If the unit is missing or wrong.

    Examples
    --------
    >>> round(parse_quantity("21.5 ft", "length"), 9)
    6.5532
    >>> parse_quantity("12 %RBS", "force", rated_break_strength=1000.0)
    120.0
    """
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        if dimension in ("strain", "number"):
            return _finite(text, text)
        raise SettingsError(
            "a value has no unit",
            found=repr(text),
            needed=f'text such as "{text} {DIMENSIONS[dimension]}"',
        )
    match = _QUANTITY.match(str(text))
    if match is None:
        is_plain = dimension in ("strain", "number")
        raise SettingsError(
            f"a value is not a number{'' if is_plain else ' with a unit'}",
            found=repr(text),
            needed='0.015 or "1.5 %"'
            if is_plain
            else f'text such as "1.5 {DIMENSIONS[dimension]}"',
        )
    number, unit = _finite(match[1], text), match[2]
    if re.match(r",\d", unit):
        raise SettingsError(
            "a number has a comma", found=repr(cut(str(text), 60)),
            needed="a decimal point, and no mark of thousands",
        )  # fmt: skip
    if re.fullmatch(r"%\s*(RBS|MBS|MBL)", unit) and dimension == "force":
        if rated_break_strength is None:
            raise SettingsError(
                "a share of the break strength is given, but no break strength",
                found=repr(text),
                needed="rated_break_strength in the same table; elsewhere a force in a unit",
            )
        return _finite(number / 100 * rated_break_strength, text)
    if not unit and dimension not in ("strain", "number"):
        raise SettingsError(
            "a value has no unit",
            found=repr(text),
            needed=f'text such as "{number:g} {DIMENSIONS[dimension]}"',
        )
    factor, offset = scale_to_si(unit, dimension)
    return _finite(factor * number + offset, text)


def _finite(number: str | float, text: str | float) -> float:
    """A value in SI; `SettingsError` if it is not a number, or not finite."""
    try:
        value = float(number)
    except OverflowError:  # an integer of hundreds of digits
        value = math.inf
    if not math.isfinite(value):
        raise SettingsError(
            "a value is not finite", found=repr(cut(str(text), 60)), needed="a finite number"
        )
    return value


def parse_in_unit(text: str, unit: str) -> float:
    """Value in SI of a text with a unit, given the SI unit of the quantity.

    Examples
    --------
    >>> round(parse_in_unit("200 psi", "Pa"), 3)
    1378951.459
    >>> parse_in_unit("2.5 kN", "J m-1")
    2500.0
    """
    match = _QUANTITY.match(text)
    if match is None:
        raise SettingsError(
            "a value is not a number with a unit", found=repr(text), needed=f"a number in {unit}"
        )
    si_unit, factor, offset = scale_of_unit(match[2])
    if scale_of_unit(unit)[0] != si_unit:
        raise SettingsError(
            "a value has the unit of something else", found=repr(text), needed=f"such as {unit}"
        )
    return _finite(factor * _finite(match[1], text) + offset, text)

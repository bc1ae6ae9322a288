"""A number with a unit, as a person or a test house writes it, into SI."""

from __future__ import annotations

import math
import re

from reduction.errors import SettingsError
from reduction.units.scale import DIMENSIONS, Dimension, scale_of_unit, scale_to_si
from reduction.visible import cut

_QUANTITY = re.compile(r"^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$")


def parse_quantity(
    text: str | float, dimension: Dimension, *, rated_break_strength: float | None = None
) -> float:
    """Value in SI of a text with a unit, such as ``"21.5 ft"`` or ``"12 %RBS"``.

    Parameters
    ----------
    text : str or float
        A number and a unit; a bare number only where the dimension is a plain
        number or a strain.
    dimension : Dimension
        What it has to be.
    rated_break_strength : float, optional
        What ``%RBS`` (also ``%MBS``, ``%MBL``) refers to. [N]

    Returns
    -------
    value : float
        In SI.

    Raises
    ------
    SettingsError
        If there is no unit, or the wrong one.

    Examples
    --------
    >>> parse_quantity("21.5 ft", "length")
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
    if re.fullmatch(r"%\s*(RBS|MBS|MBL)", unit) and dimension == "force":
        if rated_break_strength is None:
            raise SettingsError(
                "a share of the break strength is given, but no break strength",
                found=repr(text),
                needed="rated_break_strength of the specimen",
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
    """A value in SI; `SettingsError` where it is no number or beyond every float."""
    try:
        value = float(number)
    except OverflowError:  # a whole number of hundreds of digits
        value = math.inf
    if not math.isfinite(value):
        raise SettingsError(
            "a value is not finite", found=repr(cut(str(text), 60)), needed="a finite number"
        )
    return value


def parse_in_unit(text: str, unit: str) -> float:
    """Value in SI of a text with a unit, for a quantity of which only the SI unit is known.

    Parameters
    ----------
    text : str
        A number and a unit; a bare number where the quantity is one.
    unit : str
        As in `reduction.vocabulary`.

    Returns
    -------
    value : float
        [unit]

    Raises
    ------
    SettingsError
        If it is no number with a unit, or the unit is one of something else.

    Examples
    --------
    >>> parse_in_unit("200 psi", "Pa")
    1378951.45863
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

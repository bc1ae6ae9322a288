"""A condition as a person writes it: ``"frequency >= 0.1 Hz"``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from reduction.errors import SettingsError
from reduction.units import DIMENSIONS, parse_quantity, scale_of_unit
from reduction.vocabulary import QUANTITIES

_FORM = re.compile(r"\s*(\w+)\s*(<=|>=|==|!=|<|>|=)\s*(.*?)\s*", re.DOTALL)
_SHARE = re.compile(r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*%\s*(?:RBS|MBS|MBL)")
_VALUE = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*)?")
_DIMENSION_OF: Final = {unit: name for name, unit in reversed(DIMENSIONS.items())} | {"1": "strain"}
_EXAMPLE = 'such as "frequency >= 0.1 Hz" or "medium = wet"'


@dataclass(frozen=True)
class Condition:
    """What has to hold of a row.

    Parameters
    ----------
    name : str
        Quantity, as it was written.
    operator : str
        ``<``, ``<=``, ``>``, ``>=``, ``=`` or ``!=``; a text has the last two.
    value : float or str
        In the unit of the vocabulary, or a text.
    is_share : bool
        The value is a share of the rated break strength of the row.
    """

    name: str
    operator: str
    value: float | str
    is_share: bool = False


def condition_of(text: str) -> Condition:
    """Read a condition.

    Parameters
    ----------
    text : str
        Name, operator, value with its unit.

    Returns
    -------
    condition : Condition
        In SI.

    Raises
    ------
    SettingsError
        If it has another form, the vocabulary lacks the name, or the unit is of another dimension.

    Examples
    --------
    >>> condition_of("mean_tension > 100 lbf")
    Condition(name='mean_tension', operator='>', value=444.82216152605, is_share=False)
    """
    form = _FORM.fullmatch(text)
    if form is None or not form[3]:
        raise SettingsError("--where is no condition", found=repr(text), needed=_EXAMPLE)
    name, operator, value = form[1], form[2].replace("==", "="), form[3]
    row = QUANTITIES.get(name)
    if row is None:
        raise SettingsError(
            f"--where names no quantity: '{name}'",
            found=repr(text),
            needed="a name of the vocabulary",
            hint="docs/glossary.md lists them.",
        )
    if not row.unit:
        if operator not in ("=", "!="):
            raise SettingsError(
                f"'{name}' is a text, which is no greater or less",
                found=repr(text),
                needed=f'"{name} = ..." or "{name} != ..."',
            )
        return Condition(name, operator, value)
    share = _SHARE.fullmatch(value)
    if share is not None and row.unit == "N":
        return Condition(name, operator, _number(share[1], text) / 100, is_share=True)
    return Condition(name, operator, _value(value, row.unit, name))


def _number(digits: str, text: str) -> float:
    try:
        return float(digits)
    except ValueError as error:
        raise SettingsError("--where has no number", found=repr(text), needed=_EXAMPLE) from error


def _value(text: str, unit: str, name: str) -> float:
    """Value in the unit of a quantity."""
    dimension = _DIMENSION_OF.get(unit)
    if dimension is not None:
        return parse_quantity(text, dimension)
    form = _VALUE.fullmatch(text)
    if form is None or form[2] is None:
        raise SettingsError(
            f"the value of '{name}' is not a number with a unit",
            found=repr(text),
            needed=f'text such as "1.5 {unit}"',
        )
    si_unit, factor, offset = scale_of_unit(form[2])
    own_unit, own_factor, _ = scale_of_unit(unit)
    if si_unit != own_unit:
        raise SettingsError(
            f"'{form[2]}' is not a unit of {name}",
            found=repr(text),
            needed=f"a unit such as {unit}",
        )
    return (factor * float(form[1]) + offset) / own_factor

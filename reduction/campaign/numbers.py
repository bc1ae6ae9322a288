"""The numbers of `reduction.settings`, set by group and name in campaign.toml.

``reduction.cycles.band = "0.2 ft"`` sets ``CycleSettings.band``; a number with a
dimension carries its unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any

from reduction.errors import SettingsError
from reduction.settings import ReductionSettings
from reduction.units import Dimension, parse_quantity

__all__ = ["apply_numbers"]

_DIMENSION: dict[tuple[str, str], Dimension] = {
    ("phases", "minimum_duration"): "time",
    ("phases", "position_tolerance"): "length",
    ("phases", "tension_tolerance"): "force",
    ("phases", "slack_tension"): "force",
    ("holds", "minimum_duration"): "time",
    ("holds", "times"): "time",
    ("modulus", "strain_bin_width"): "strain",
    ("modulus", "window"): "strain",
    ("modulus", "stress_at_strain"): "strain",
}
# set elsewhere in campaign.toml, under their own names
_ELSEWHERE = {("strain", "method"), ("cycles", "control"), ("cycles", "waveform"),
              ("cycles", "expected_cycles")}  # fmt: skip


def _value(group: str, name: str, value: object, default: object, control: str) -> object:
    where = f"reduction.{group}.{name}"
    dimension = _DIMENSION.get((group, name))
    if (group, name) == ("cycles", "band"):
        dimension = "force" if control == "load" else "length"
    if isinstance(default, tuple):
        if not isinstance(value, (list, tuple)):
            raise SettingsError(f"{where} is not a list", found=repr(value), needed="a list")
        return tuple(parse_quantity(item, dimension or "number") for item in value)
    if dimension is not None:
        if not isinstance(value, (str, int, float)):
            raise SettingsError(f"{where} is not a value", found=repr(value), needed="a value")
        number = parse_quantity(value, dimension)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        number = float(value)
    else:
        raise SettingsError(f"{where} is not a number", found=repr(value), needed="a number")
    if number < 0:
        raise SettingsError(f"{where} is negative", found=repr(value), needed="zero or more")
    if isinstance(default, int):
        if number != int(number):
            raise SettingsError(
                f"{where} is not a whole number", found=repr(value), needed="a whole number"
            )
        return int(number)
    return number


def apply_numbers(
    settings: ReductionSettings, table: Mapping[str, Mapping[str, Any]], *, control: str
) -> ReductionSettings:
    """Settings with the numbers of one ``reduction`` table put in.

    Parameters
    ----------
    settings : ReductionSettings
        What holds so far.
    table : mapping
        Group to name to value, as TOML gave it.
    control : str
        ``position`` or ``load``: the dimension of a band.

    Returns
    -------
    settings : ReductionSettings
        New settings.

    Raises
    ------
    SettingsError
        If a group, a name or a value cannot be used.
    """
    for group, numbers in table.items():
        known = {item.name for item in fields(settings)}
        if group not in known:
            raise SettingsError(
                f"reduction.{group} is not a group of settings",
                found=f"'{group}'",
                needed="one of " + ", ".join(sorted(known)),
            )
        part = getattr(settings, group)
        names = {
            item.name: item.default for item in fields(part) if (group, item.name) not in _ELSEWHERE
        }
        changed = {}
        for name, value in numbers.items():
            if name not in names:
                raise SettingsError(
                    f"reduction.{group}.{name} is not a setting",
                    found=f"'{name}'",
                    needed="one of " + ", ".join(sorted(names)),
                )
            changed[name] = _value(group, name, value, names[name], control)
        settings = replace(settings, **{group: replace(part, **changed)})
    return settings

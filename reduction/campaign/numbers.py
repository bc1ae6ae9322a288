"""The numbers of `reduction.settings`, set by group and name in campaign.toml.

``reduction.cycles.band = "0.2 ft"`` sets ``CycleSettings.band``; a number with a
dimension carries its unit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Any, get_args

from reduction.errors import SettingsError
from reduction.settings import ReductionSettings, StoredSamples
from reduction.units import Dimension, parse_quantity

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
    ("rope", "reference_time"): "time",
}
# least and greatest value that a stage can work with; SI
_LIMITS: dict[tuple[str, str], tuple[float, float]] = {
    ("quality", "stuck_samples"): (3, math.inf),
    ("quality", "spike_factor"): (3, math.inf),
    ("quality", "gap_factor"): (1.01, math.inf),
    ("quality", "rate_tolerance"): (1e-6, math.inf),
    ("phases", "minimum_duration"): (1e-3, math.inf),
    ("phases", "position_tolerance"): (1e-9, math.inf),
    ("cycles", "band"): (1e-9, math.inf),
    ("cycles", "trim_threshold"): (0.0, 1.0),
    ("cycles", "break_in_cycles"): (0, math.inf),
    ("modulus", "strain_bin_width"): (1e-4, 10.0),
    ("modulus", "window"): (1e-4, 10.0),
    ("modulus", "minimum_count"): (3, math.inf),
    ("modulus", "maximum_segments"): (1, 8),
    ("modulus", "segment_tolerance"): (1e-6, 1.0),
    ("modulus", "selected_cycles"): (2, math.inf),
    ("holds", "minimum_duration"): (1e-3, math.inf),
    ("holds", "maximum_terms"): (1, 5),
    ("slip", "minimum_cycles"): (20, math.inf),
    ("slip", "false_alarm"): (1e-9, 0.5),
    ("rope", "last_cycles"): (1, math.inf),
    ("rope", "reference_time"): (1e-3, math.inf),
    ("rope", "failure_share"): (0.01, 0.99),
    ("archive", "longest_record"): (1000, math.inf),
}
_WORDS: dict[tuple[str, str], tuple[str, ...]] = {("archive", "samples"): get_args(StoredSamples)}
# set elsewhere in campaign.toml, under their own names
_ELSEWHERE = {("strain", "method"), ("cycles", "control"), ("cycles", "waveform"),
              ("cycles", "expected_cycles")}  # fmt: skip


def dimension_of(group: str, name: str, *, control: str) -> Dimension | None:
    """Dimension of a number, with which its unit is written; None where it has none."""
    if (group, name) == ("cycles", "band"):
        return "force" if control == "load" else "length"
    return _DIMENSION.get((group, name))


def limits_of(group: str, name: str) -> tuple[float, float]:
    """Least and greatest value that a number may have, in SI."""
    return _LIMITS.get((group, name), (0.0, math.inf))


def _in_si(where: str, value: str | float, dimension: Dimension) -> float:
    """A value with its unit; a refusal says which number it is."""
    try:
        return parse_quantity(value, dimension)
    except SettingsError as error:
        raise SettingsError(
            f"{where}: {error.problem}", found=repr(value), needed=error.needed, hint=error.hint
        ) from error


def _value(group: str, name: str, value: object, default: object, control: str) -> object:
    where = f"reduction.{group}.{name}"
    words = _WORDS.get((group, name))
    if words is not None:
        if value not in words:
            needed = " or ".join(f'"{word}"' for word in words)
            raise SettingsError(f"{where} is unknown", found=repr(value), needed=needed)
        return value
    dimension = dimension_of(group, name, control=control)
    if isinstance(default, tuple):
        if not isinstance(value, (list, tuple)):
            raise SettingsError(f"{where} is not a list", found=repr(value), needed="a list")
        return tuple(_in_si(where, item, dimension or "number") for item in value)
    if dimension is not None:
        if not isinstance(value, (str, int, float)):
            raise SettingsError(f"{where} is not a value", found=repr(value), needed="a value")
        number = _in_si(where, value, dimension)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:  # a whole number of hundreds of digits
            number = math.inf
    else:
        raise SettingsError(f"{where} is not a number", found=repr(value), needed="a number")
    least, greatest = limits_of(group, name)
    if not least <= number <= greatest or (isinstance(default, float) and math.isinf(number)):
        upper = "" if math.isinf(greatest) else f" and at most {greatest:g}"
        raise SettingsError(
            f"{where} is out of range", found=repr(value), needed=f"at least {least:g}{upper}"
        )
    if isinstance(default, int):
        if not number.is_integer():  # nor is infinity one
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

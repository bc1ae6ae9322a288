"""Points of a look-up as they are asked for: levels with units, alone or as a grid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from reduction.errors import DataError, SettingsError
from reduction.lookup.line import Branch
from reduction.lookup.product import LineSource
from reduction.record import Floats
from reduction.units import Dimension, parse_quantity

__all__ = ["Wanted", "parsed_search", "points_of"]

_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "tension": "force",
    "strain": "strain",
}
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Wanted:
    """What is to be looked up: options as they were given.

    ``levels`` are texts with units, by name; ``search`` what `find_lines` takes; ``name`` the line
    of SOURCE; ``grid`` whether a level may have several values, and one that is not given its
    low, centre and high; ``out`` the file of a table.
    """

    quantity: str
    levels: Mapping[str, str]
    search: Mapping[str, Any] = field(default_factory=dict)
    name: str | None = None
    branch: Branch | None = None
    extrapolate: Literal["refuse", "flag"] = "refuse"
    grid: bool = False
    out: Path | None = None


def parsed_search(
    words: Mapping[str, str | None], diameter: str | None, tolerance: str | None
) -> dict[str, Any]:
    """What `find_lines` takes, of texts; nothing of what was not given."""
    search: dict[str, Any] = {name: text for name, text in words.items() if text is not None}
    if tolerance is not None and diameter is None:
        raise SettingsError(
            "a tolerance is that of a diameter", found=f"--tolerance {tolerance}",
            needed="--diameter with it",
        )  # fmt: skip
    if diameter is not None:
        search["diameter"] = parse_quantity(diameter, "length")
    if tolerance is not None:
        search["tolerance"] = parse_quantity(tolerance, "number")
    return search


def points_of(
    wanted: Wanted, line: LineSource, other: LineSource | None = None
) -> tuple[dict[str, Floats], bool]:
    """Points at which a line is looked up, by level, and whether slack ones were left out.

    Parameters
    ----------
    wanted : Wanted
        Levels as texts; %RBS is of the break strength of ``line``.
    line : LineSource
        Whose box fills a grid.
    other : LineSource, optional
        A line to hold against it: a grid is filled over what both boxes have in common.

    Returns
    -------
    points : dict of str to ndarray, shape (n_points,)
        By level. [SI]
    left_out : bool
        A grid has combinations whose amplitude is above the mean; they are not among the points.

    Raises
    ------
    SettingsError
        If a level has no or a wrong unit, or several values without a grid.
    DataError
        If two boxes have nothing in common.
    """
    given = {level: _numbers(level, text, line) for level, text in wanted.levels.items()}
    if not wanted.grid and any(values.size > 1 for values in given.values()):
        raise SettingsError("several values of a level make a grid", needed="--table with them")
    if wanted.grid:
        given = _filled(wanted, given, line, other)
    axes = np.meshgrid(*given.values(), indexing="ij") if given else []
    points = {level: axis.ravel() for level, axis in zip(given, axes, strict=True)}
    if not (wanted.grid and {"mean_tension", "tension_amplitude"} <= points.keys()):
        return points, False
    taut = points["tension_amplitude"] <= points["mean_tension"] * (1 + _ROUNDING)
    return {level: values[taut] for level, values in points.items()}, not taut.all()


def _filled(
    wanted: Wanted, given: Mapping[str, Floats], line: LineSource, other: LineSource | None
) -> dict[str, Floats]:
    """Levels that are not given get low, centre and high of what was tested."""
    ends = _ends(wanted, line, given)
    of_other = {} if other is None else _ends(wanted, other, given)
    filled = dict(given)
    for name, (low, high) in ends.items():
        if name in given:
            continue
        if other is not None and name in of_other:
            low, high = max(low, of_other[name][0]), min(high, of_other[name][1])
            if low > high:
                raise DataError(
                    f"what was tested of {wanted.quantity} of {line.name} and {other.name} has no "
                    f"{name.replace('_', ' ')} in common",
                    found=f"one from {low:.5g}, one to {high:.5g} (SI)",
                    hint=f"Give --{name.replace('_', '-')}, and --extrapolate flag.",
                )
        filled[name] = np.array([low, (low + high) / 2, high])
    # in the order of the factors, whatever was said first
    return {name: filled[name] for name in dict.fromkeys([*ends, *filled])}


def _ends(
    wanted: Wanted, line: LineSource, given: Mapping[str, Floats]
) -> dict[str, tuple[float, float]]:
    """Range of each variable that was tested; of a damping that of the spring in it."""
    is_dashpot = wanted.quantity == "dashpot_coefficient" and line.has_dashpot
    name = "dissipation_spring_constant" if is_dashpot else wanted.quantity
    surface = line.surfaces.get(name)
    if surface is not None:
        return {
            name: (float(surface.low[place]), float(surface.high[place]))
            for place, name in enumerate(line.factor_names)
        }
    for curve in line.curves:
        is_meant = not given or curve.variable in given
        if curve.quantity == name and curve.branch in ("", wanted.branch) and is_meant:
            return {curve.variable: (curve.low, curve.high)}
    return {}


def _numbers(name: str, text: str, line: LineSource) -> Floats:
    strength = line.rated_break_strength
    known = strength if np.isfinite(strength) else None
    try:
        return np.array(
            [
                parse_quantity(part.strip(), _DIMENSIONS[name], rated_break_strength=known)
                for part in text.split(",")
            ]
        )
    except SettingsError as error:
        raise SettingsError(
            f"--{name.replace('_', '-')}: {error.problem}", found=error.found, needed=error.needed
        ) from error

"""Points of a look-up as they are asked for: levels with units, alone or as a grid."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from reduction.errors import DataError, SettingsError
from reduction.lookup.line import Branch
from reduction.lookup.product import LineSource
from reduction.record import Floats
from reduction.units import Dimension, parse_quantity

_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "tension": "force",
    "strain": "strain",
}
_ROUNDING = 1e-12
MOST_POINTS = 100_000
"""Of a grid: what a table of text, or one JSON object, can reasonably hold."""


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
    wanted: Wanted, line: LineSource, *others: LineSource
) -> tuple[list[dict[str, Floats]], bool]:
    """Points at which lines are looked up, by level, and whether slack ones were left out.

    Parameters
    ----------
    wanted : Wanted
        Levels as texts; %RBS is of the break strength of each line.
    line, *others : LineSource
        A grid is filled over what their boxes have in common.

    Returns
    -------
    points : list of dict of str to ndarray, shape (n_points,)
        One a line, by level. [SI]
    left_out : bool
        A grid has combinations whose amplitude is above the mean; they are not among the points.

    Raises
    ------
    SettingsError
        If a level has no or a wrong unit, or several values without a grid; or a grid has too
        many points.
    DataError
        If the boxes have nothing in common, or a line would be pushed at every point of a grid.
    """
    lines = (line, *others)
    filled = _filled(wanted, lines) if wanted.grid else {}
    # in the order of the factors, whatever was said first
    names = list(dict.fromkeys([*filled, *wanted.levels]))
    points: list[dict[str, Floats]] = []
    for one in lines:
        levels = [
            _numbers(name, wanted.levels[name], one) if name in wanted.levels else filled[name]
            for name in names
        ]
        if not wanted.grid and any(values.size > 1 for values in levels):
            raise SettingsError("several values of a level make a grid", needed="--table with them")
        size = math.prod(values.size for values in levels)
        if size > MOST_POINTS:
            raise SettingsError(
                "a grid has too many points for a table", found=f"{size:,}",
                needed=f"at most {MOST_POINTS:,}",
                hint="`reduction.lookup.line.look_up` takes any number at once.",
            )  # fmt: skip
        axes = np.meshgrid(*levels, indexing="ij") if levels else []
        points.append({name: axis.ravel() for name, axis in zip(names, axes, strict=True)})
    if not (wanted.grid and {"mean_tension", "tension_amplitude"} <= set(names)):
        return points, False
    taut = np.all(
        [at["tension_amplitude"] <= at["mean_tension"] * (1 + _ROUNDING) for at in points], axis=0
    )
    if not taut.any():
        raise DataError(
            "no combination of the grid has an amplitude of at most its mean tension",
            found=f"{taut.size} combinations",
            needed="a mean tension that is above an amplitude",
        )
    kept = [{name: values[taut] for name, values in at.items()} for at in points]
    return kept, not taut.all()


def _filled(wanted: Wanted, lines: Sequence[LineSource]) -> dict[str, Floats]:
    """Low, centre and high of what was tested of all lines, by level; those that are given too."""
    ends = [_ends(wanted, line) for line in lines]
    filled = {}
    for name in ends[0]:
        low = max(one[name][0] for one in ends if name in one)
        high = min(one[name][1] for one in ends if name in one)
        if low > high and name not in wanted.levels:
            raise DataError(
                f"what was tested of {wanted.quantity} of "
                f"{' and '.join(line.name for line in lines)} has no {name.replace('_', ' ')} in "
                "common",
                found=f"one from {low:.5g}, one to {high:.5g} (SI)",
                hint=f"Give --{name.replace('_', '-')}, and --extrapolate flag.",
            )
        filled[name] = np.array([low, (low + high) / 2, high])
    return filled


def _ends(wanted: Wanted, line: LineSource) -> dict[str, tuple[float, float]]:
    """Range of each variable that was tested; of a damping that of the spring in it."""
    is_dashpot = wanted.quantity == "dashpot_coefficient" and line.has_dashpot
    name = "dissipation_spring_constant" if is_dashpot else wanted.quantity
    surface = line.surfaces.get(name)
    if surface is not None:
        return {
            name: (float(surface.low[place]), float(surface.high[place]))
            for place, name in enumerate(line.factor_names)
        }
    of_name = [curve for curve in line.curves if curve.quantity == name]
    for curve in of_name:
        is_meant = not wanted.levels or curve.variable in wanted.levels
        # where one branch alone is known it need not be asked for
        is_branch = curve.branch == wanted.branch or not curve.branch or len(of_name) == 1
        if is_branch and is_meant:
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

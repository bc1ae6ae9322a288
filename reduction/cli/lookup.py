"""The command lookup: one design value, or a grid of them, with interval, range and source."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, cast

import numpy as np

from reduction.cli.lookupsource import lines_of
from reduction.cli.numbers import plain, short, table_of
from reduction.cli.outcome import Outcome
from reduction.errors import SettingsError
from reduction.lookup.line import Branch, look_up
from reduction.lookup.product import DesignValues, LineSource
from reduction.record import Floats
from reduction.units import Dimension, UnitSystem, display_unit, parse_quantity

__all__ = ["list_sources", "look_up_values"]

_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "tension": "force",
    "strain": "strain",
}


def list_sources(source: str, *, outcome: Outcome) -> None:
    """Print what SOURCE holds: each line, its quantities, and over which range."""
    lines = lines_of(source)
    table = table_of("line", "material", "construction", "condition", "quantities", texts=5)
    for line in lines:
        table.add_row(
            line.name, line.material, line.construction, line.condition, ", ".join(line.quantities)
        )
    outcome.show(table)
    outcome.answer({"lines": [_described(line) for line in lines]})


def _described(line: LineSource) -> dict[str, Any]:
    return {
        "name": line.name,
        "source": line.source,
        "material": line.material,
        "construction": line.construction,
        "condition": line.condition,
        "diameter": plain(line.diameter),
        "rated_break_strength": plain(line.rated_break_strength),
        "units": {"diameter": "m", "rated_break_strength": "N"},
        "quantities": list(line.quantities),
        "absent": line.absent,
        "ranges": {
            quantity: {
                name: [float(surface.low[place]), float(surface.high[place])]
                for place, name in enumerate(line.factor_names)
            }
            for quantity, surface in line.surfaces.items()
        },
        "notes": list(line.notes),
    }


def look_up_values(
    source: str,
    quantity: str,
    levels: Mapping[str, str],
    *,
    name: str | None,
    branch: Branch | None,
    extrapolate: Literal["refuse", "flag"],
    grid: bool,
    outcome: Outcome,
) -> None:
    """Print design values; several values of a level, parted by commas, make a grid."""
    line = _one(lines_of(source), quantity, name)
    given = {level: _numbers(level, text, line) for level, text in levels.items()}
    if grid and quantity in line.surfaces:
        surface = line.surfaces[quantity]
        for place, factor in enumerate(line.factor_names):
            low, high = surface.low[place], surface.high[place]
            given.setdefault(factor, np.array([low, (low + high) / 2, high]))
        mean, amplitude = given.get("mean_tension"), given.get("tension_amplitude")
        if mean is not None and amplitude is not None and amplitude.max() > mean.min():
            outcome.say("combinations whose amplitude is above the mean tension are left out")
    axes = np.meshgrid(*given.values(), indexing="ij") if given else []
    points = {level: axis.ravel() for level, axis in zip(given, axes, strict=True)}
    if grid and {"mean_tension", "tension_amplitude"} <= points.keys():
        taut = points["tension_amplitude"] <= points["mean_tension"] * (1 + 1e-12)
        points = {level: values[taut] for level, values in points.items()}
    if not grid and any(values.size > 1 for values in given.values()):
        raise SettingsError("several values of a level make a grid", needed="--table with them")
    found = look_up(line, quantity, branch=branch, extrapolate=extrapolate, **points)
    _show(line, found, points, outcome, cast("UnitSystem", outcome.units))
    outcome.answer(_document(line, found, points, grid=grid))


def _one(lines: list[LineSource], quantity: str, name: str | None) -> LineSource:
    """The line that was meant: by its name, else the only one that has the quantity."""
    named = [line for line in lines if name in (None, line.name)]
    if not named:
        raise SettingsError(
            f"there is no line '{name}'", needed=", ".join(line.name for line in lines)
        )
    having = [line for line in named if quantity in line.quantities]
    if len(having) > 1:
        raise SettingsError(
            f"several lines have {quantity}",
            found=", ".join(dict.fromkeys(line.source for line in having)),
            needed="one archive, or --line NAME",
        )
    return having[0] if having else named[0]


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


def _show(
    line: LineSource,
    found: DesignValues,
    points: Mapping[str, Floats],
    outcome: Outcome,
    system: UnitSystem,
) -> None:
    unit, factor = display_unit(found.unit, system)
    outcome.say(f"{found.quantity} of {line.name}; {found.source}")
    # names stand below each other's words: there is little room beside seven columns
    heads = [f"{name.replace('_', chr(10))}\n[{_shown(name, system)[0]}]" for name in points]
    table = table_of(
        *heads, f"value\n[{unit}]", "95 % of\none more test", "95 % of\nthe surface",
        "peak\n[%RBS]", "minimum\n[%RBS]", "remark", texts=0,
    )  # fmt: skip
    size = found.value.size
    for place in range(size):
        numbers = [
            short(_shown(name, system)[1] * float(values[place])) for name, values in points.items()
        ]
        at = {
            name: np.atleast_1d(getattr(found, name)).ravel()[place]
            for name in (
                "value", "low", "high", "surface_low", "surface_high", "peak_share",
                "minimum_share", "is_inside", "is_untested", "is_above_rule",
            )
        }  # fmt: skip
        remarks = [
            word
            for word, is_so in (
                ("OUTSIDE what was tested", not at["is_inside"]),
                ("untested corner", at["is_untested"]),
                ("peak above the rule", at["is_above_rule"]),
                ("below zero: no value", at["value"] < 0),
            )
            if is_so
        ]
        table.add_row(
            *numbers,
            short(factor * float(at["value"])),
            _span(factor, at["low"], at["high"]),
            _span(factor, at["surface_low"], at["surface_high"]),
            short(100 * float(at["peak_share"]), 4),
            short(100 * float(at["minimum_share"]), 4),
            "; ".join(remarks),
        )
    outcome.show(table)
    if found.errata:
        outcome.say(f"errata that touch it: {', '.join(found.errata)}")
    for note in found.notes:
        outcome.say(f"note: {note}")


def _span(factor: float, low: float, high: float) -> str:
    if not (np.isfinite(low) and np.isfinite(high)):
        return "-"
    return f"{short(factor * float(low))} to {short(factor * float(high))}"


def _shown(name: str, system: UnitSystem) -> tuple[str, float]:
    units = {"frequency": "Hz", "strain": "1"}
    if name == "strain":
        return "%", 100.0
    return display_unit(units.get(name, "N"), system)


def _document(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], *, grid: bool
) -> dict[str, Any]:
    """What ``--json`` says, in SI: numbers of a single point, lists of a grid."""

    def of(values: Any) -> Any:
        shaped = np.atleast_1d(values).ravel()
        return plain(shaped if grid else shaped[0])

    return {
        "line": line.name,
        "quantity": found.quantity,
        "levels": {name: of(values) for name, values in points.items()},
        "value": of(found.value),
        "unit": found.unit,
        "interval": [of(found.low), of(found.high)],
        "surface_interval": [of(found.surface_low), of(found.surface_high)],
        "inside": of(found.is_inside),
        "untested": of(found.is_untested),
        "peak_tension": of(found.peak_tension),
        "minimum_tension": of(found.minimum_tension),
        "peak_share": of(found.peak_share),
        "minimum_share": of(found.minimum_share),
        "above_rule": of(found.is_above_rule),
        "source": found.source,
        "errata": list(found.errata),
        "notes": list(found.notes),
    }

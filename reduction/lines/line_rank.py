"""Lines in the order of one quantity at one load, with ties where their intervals overlap.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 3.2, Figure 4: the choice of a diameter.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from reduction.lines.line_lookup import Branch, look_up
from reduction.lines.lookup_product import DesignValues, LineSource
from reduction.published.printed_cells import Erratum, cells_of, errata_of, number_of
from reduction.quantities.digits import plain_number
from reduction.record.errors import DataError, ReductionError, SettingsError

JUST_OUTSIDE = 0.1
"""How far a line may be outside to be ranked and flagged, over half the tested range. [1]"""

_INCH = 0.0254

_CLOSE = 1e-6


@dataclass(frozen=True)
class _LevelOutside:
    """A level that was not tested, and the nearest end of the tested range, in SI."""

    name: str
    value: float
    end: float
    side: Literal["below", "above"]


@dataclass(frozen=True)
class _RankedLine:
    """A line with its rank.

    ``ties`` name the lines whose 95 % intervals overlap its own, for the tested lines;
    ``kind_ties`` those with overlapping intervals of another line of each kind, None where that is
    not known.
    """

    line: LineSource
    values: DesignValues
    ties: tuple[str, ...]
    kind_ties: tuple[str, ...] | None
    outside: tuple[_LevelOutside, ...]


@dataclass(frozen=True)
class _LineRanking:
    """Lines from the least value to the greatest, and those without a rank, with the reason.

    ``errata`` concern sentences of a report that order some of these lines.
    """

    ranked: tuple[_RankedLine, ...]
    left_out: tuple[tuple[str, str], ...]
    errata: tuple[Erratum, ...]


def rank_lines(
    lines: Sequence[LineSource],
    quantity: str,
    levels: Sequence[Mapping[str, Any]],
    *,
    branch: Branch | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
) -> _LineRanking:
    """Order lines by a quantity at one load.

    A line is left out where it was not tested, or where the load exceeds the limit of its source.

    Notes
    -----
    Figure 4 of [1]_ as numbers.  Two lines tie where their intervals overlap, which is more
    cautious than the interval of their difference.
    """
    found: list[tuple[LineSource, DesignValues, tuple[_LevelOutside, ...]]] = []
    left_out: list[tuple[str, str]] = []
    for line, at in zip(lines, levels, strict=True):
        try:
            values = look_up(line, quantity, branch=branch, extrapolate="flag", **at)
            if values.is_above_rule.any():
                left_out.append((line.name, _above(values)))
                continue
            outside = _outside(line, quantity, at)
            if extrapolate == "refuse" and not values.is_inside.all() and not outside:
                look_up(line, quantity, branch=branch, **at)
        except (DataError, SettingsError) as error:
            left_out.append((line.name, _reason(error)))
            continue
        found.append((line, values, outside))
    if len(found) < 2:
        raise DataError(
            f"fewer than two lines have {quantity} at this load",
            found="; ".join(f"{name}: {why}" for name, why in left_out) or "one line",
            needed="two or more", hint="--extrapolate flag ranks what was not tested, flagged.",
        )  # fmt: skip
    found.sort(key=lambda one: float(one[1].value))
    ranked = tuple(
        _RankedLine(
            line, values, _ties(place, found, "surface") or (), _ties(place, found, "line"), outside
        )
        for place, (line, values, outside) in enumerate(found)
    )
    return _LineRanking(
        ranked, tuple(left_out), _errata_on_order([one for one, *_ in found], quantity)
    )


def _above(values: DesignValues) -> str:
    share = float(values.own_peak_share.ravel()[0])
    return (
        f"its peak would be {100 * share:.0f} % of its break strength, above the load limit (rule)"
    )


def _reason(error: ReductionError) -> str:
    parts = str(error.problem), str(error.found or "")
    return "; ".join(part for part in parts if part)


def _outside(line: LineSource, quantity: str, at: Mapping[str, float]) -> tuple[_LevelOutside, ...]:
    """Levels just outside the box of a surface; none where one of them is farther outside."""
    surface = line.surfaces.get(quantity)
    if surface is None:
        return ()
    found = []
    for place, name in enumerate(line.factor_names):
        low, high = float(surface.low[place]), float(surface.high[place])
        rounded = float(surface.rounding[place]) if surface.rounding.size else 0.0
        beyond = max(low - rounded - at[name], at[name] - high - rounded)
        if beyond <= _CLOSE * high:
            continue
        if beyond > JUST_OUTSIDE * (high - low) / 2:
            return ()
        is_below = at[name] < low
        found.append(
            _LevelOutside(
                name, at[name], low if is_below else high, "below" if is_below else "above"
            )
        )
    return tuple(found)


def _ties(
    place: int,
    found: Sequence[tuple[LineSource, DesignValues, tuple[_LevelOutside, ...]]],
    which: Literal["surface", "line"],
) -> tuple[str, ...] | None:
    """Other lines whose intervals overlap; None where there is no interval."""

    def ends(values: DesignValues) -> tuple[float, float]:
        low, high = (float(getattr(values, f"{which}_{end}").ravel()[0]) for end in ("low", "high"))
        return low, high

    low, high = ends(found[place][1])
    if not np.isfinite([low, high]).all():
        return None
    others = [(line.name, *ends(values)) for line, values, _ in found]
    return tuple(
        name
        for row, (name, least, greatest) in enumerate(others)
        if row != place and least <= high and greatest >= low
    )


def _errata_on_order(lines: Sequence[LineSource], quantity: str) -> tuple[Erratum, ...]:
    """Errata of sentences of [1]_ that order two or more of these lines."""
    named: dict[str, set[str]] = {}
    for cell in cells_of("CG-D-39-80"):
        if not (cell.erratum and cell.column.startswith(f"{quantity} at ")):
            continue
        for line in lines:
            if line.source == "CG-D-39-80" and _is_row(cell.row, line):
                named.setdefault(cell.erratum, set()).add(line.name)
    wanted = {one for one, names in named.items() if len(names) > 1}
    return tuple(one for one in errata_of("CG-D-39-80") if one.id in wanted)


def _is_row(row: str, line: LineSource) -> bool:
    """Whether a row of the report, ``nylon | double braid | 3/4 in | new``, is for a line."""
    words = row.split(" | ")
    if len(words) != 4 or [words[0], words[1], words[3]] != [
        line.material, line.construction, line.condition,
    ]:  # fmt: skip
        return False
    size = number_of(words[2])
    return size is not None and abs(size * _INCH - line.diameter) < _CLOSE


def outside_words(found: _LevelOutside, unit: str, factor: float) -> str:
    """An untested level, in words.

    Examples
    --------
    >>> outside_words(_LevelOutside("tension_amplitude", 1600.0, 1680.0, "below"), "lbf", 1.0)
    'tension amplitude 1,600 lbf, below 1,680 lbf, the lowest that was tested'
    """
    value, end = (plain_number(factor * one, 4) for one in (found.value, found.end))
    reach = "lowest" if found.side == "below" else "highest"
    return (
        f"{found.name.replace('_', ' ')} {_thousands(value)} {unit}, {found.side} "
        f"{_thousands(end)} {unit}, the {reach} that was tested"
    )


def _thousands(text: str) -> str:
    whole, point, rest = text.partition(".")
    return f"{int(whole):,}{point}{rest}" if whole.isdigit() else text

"""Implements the command lookup."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from rich.table import Table

from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import as_given, plain, short, table_of, within
from reduction.lines.line_consistency import (
    DASHPOT,
    ENERGY,
    K_0,
    K_1,
    K_AP,
    TIME,
    ConsistentValues,
    consistent_values,
    is_of_loads,
    refitted_surfaces,
)
from reduction.lines.line_curve import evaluate_curve
from reduction.lines.line_levels import SAME_LEVEL, levels_of_tests
from reduction.lines.line_lookup import Branch, look_up
from reduction.lines.line_search import (
    LineDifference,
    compare_values,
    conditions_of,
    find_lines,
    in_conditions,
    names_with_words,
)
from reduction.lines.lookup_product import (
    LEVEL_DIMENSIONS,
    OF_MEAN,
    TENSIONS,
    DesignValues,
    LineLevels,
    LineSource,
)
from reduction.lines.published_source import published_sources
from reduction.lines.tether_comparison import compared_tethers
from reduction.quantities.names import quantity as quantity_of
from reduction.quantities.units import UnitSystem, display_unit, parse_quantity
from reduction.record.errors import ArchiveError, DataError, SettingsError
from reduction.record.measurement import Bools, Floats
from reduction.stages.three_parameter_line.line_product import REASONS

if TYPE_CHECKING:
    from reduction.lines.export_tables import ValueTable
    from reduction.lines.population import PopulationValues

_ENDINGS = (".nc", ".toml", ".csv")


def lines_of_source(source: str) -> list[LineSource]:
    """All lines of SOURCE."""
    published = published_sources()
    if source == "published":
        return list(published.values())
    if source in published:
        return [published[source]]
    # published lines need neither xarray nor the archive, half of the time of a look-up
    from reduction.lines.archive_source import lines_of_archive, lines_of_folder

    path = Path(source)
    if path.is_file() or (path.is_dir() and any(path.glob("*.nc"))):
        lines = lines_of_folder(path) if path.is_dir() else lines_of_archive(path)
        if not lines:
            contains = "archives contain" if path.is_dir() else "archive contains"
            raise ArchiveError(
                f"the {contains} nothing to look up", found=str(path),
                needed="moduli of a cyclic test, a slow pull, or surfaces of an experiment",
            )  # fmt: skip
        return lines
    if _is_path(source):
        raise _no_products(path)
    near = names_with_words(source, published)
    raise SettingsError(
        f"no line is called '{source}'",
        needed="an archive, a folder of a processed campaign, or "
        + (f"one of {', '.join(near)}" if near else f"one of {len(published)} published lines"),
        hint="List them with `reduction lookup published --list`.",
    )


def _is_path(source: str) -> bool:
    return "/" in source or "\\" in source or source.endswith(_ENDINGS) or Path(source).exists()


def _no_products(path: Path) -> SettingsError:
    """Error for a path without anything to look up, with the command that creates it."""
    if path.is_dir():
        problem, found = "the folder holds no archive of a campaign", str(path)
    else:
        problem, found = "there is no such folder or archive", str(path)
    campaign = path.parent.name if path.suffix == ".nc" else path.name
    return SettingsError(
        problem,
        found=found,
        needed="the archives of a campaign",
        hint=f"`reduction run raw/{campaign}/campaign.toml` makes processed/{campaign}.",
    )


def one_line_of(lines: Sequence[LineSource], quantity: str, name: str | None) -> LineSource:
    """The requested line: by name, or the only one with the quantity.

    For an experiment and its runs, the experiment.
    """
    named = [line for line in lines if name in (None, line.name)]
    if not named:
        # for "T-1 new", the test or specimen alone if it is unique
        named = [
            line
            for line in lines
            if line.name.startswith(f"{name} ") or line.name.endswith(f" {name}")
        ]
    if not named:
        raise SettingsError(
            f"there is no line '{name}'",
            needed=", ".join(dict.fromkeys(line.name for line in lines)),
            hint=f'Example: `--line "{lines[0].name}"`.',
        )
    having = [line for line in named if quantity in line.quantities]
    if not having and name is not None:
        # a rope and its tests are named after the specimen
        parts = [line for line in lines if name in (line.name.split(" ")[-1], *line.specimens)]
        having = [line for line in parts if quantity in line.quantities]
    if not having and len(named) > 1:
        there = dict.fromkeys(name for line in named for name in line.quantities)
        raise SettingsError(
            f"none of {len(named)} lines has {quantity}",
            needed=f"one of {', '.join(there)}" if there else None,
        )
    fitted = [line for line in having if line.surfaces]
    if len(fitted) == 1 and all(
        one.specimens and set(one.specimens) <= set(fitted[0].specimens) for one in having
    ):
        return fitted[0]
    if len(having) > 1:
        raise SettingsError(
            f"several lines have {quantity}",
            found=", ".join(dict.fromkeys(f"{line.name} ({line.source})" for line in having)),
            needed="one archive, --line NAME, or a search that matches one",
            hint=f'Example: `--line "{having[0].name}"`.',
        )
    return having[0] if having else named[0]


_ROUNDING = 1e-12

MOST_POINTS = 100_000
"""Maximum of a grid: as much as a text table or a JSON object can reasonably hold."""


@dataclass(frozen=True)
class LookupRequest:
    """Request for a look-up: options in their original form.

    ``levels`` are texts with units, by name; ``search`` holds arguments of `find_lines`,
    ``conditions`` those of `in_conditions`; ``name`` is the line of SOURCE; ``grid`` allows several
    values of a level, and defaults to its low, centre and high, or to those of each test; ``out``
    is the file of a table.
    """

    quantity: str
    levels: Mapping[str, str]
    search: Mapping[str, Any] = field(default_factory=dict)
    name: str | None = None
    branch: Branch | None = None
    extrapolate: Literal["refuse", "flag"] = "refuse"
    grid: bool = False
    out: Path | None = None
    conditions: Mapping[str, str] = field(default_factory=dict)


def parsed_search(
    words: Mapping[str, str | None], diameter: str | None, tolerance: str | None
) -> dict[str, Any]:
    """Arguments of `find_lines` from texts, without those not given."""
    search: dict[str, Any] = {name: text for name, text in words.items() if text is not None}
    if tolerance is not None and diameter is None:
        raise SettingsError(
            "a tolerance needs a diameter", found=f"--tolerance {tolerance}",
            needed="--diameter with it",
        )  # fmt: skip
    if diameter is not None:
        search["diameter"] = parse_quantity(diameter, "length")
    if tolerance is not None:
        search["tolerance"] = parse_quantity(tolerance, "number")
    return search


def _points_of(
    wanted: LookupRequest, line: LineSource, *others: LineSource
) -> tuple[list[dict[str, Floats]], bool]:
    """Points of a look-up by level, and whether slack ones were left out."""
    lines = (line, *others)
    rows = _tested_rows(wanted, line) if wanted.grid else None
    if rows is not None:
        return [rows for _ in lines], False
    filled = _filled(wanted, lines) if wanted.grid else {}
    # in the order of the factors, not of the options
    names = list(dict.fromkeys([*filled, *wanted.levels]))
    points: list[dict[str, Floats]] = []
    for one in lines:
        levels = [
            _numbers(name, wanted.levels[name], one) if name in wanted.levels else filled[name]
            for name in names
        ]
        if not wanted.grid and any(values.size > 1 for values in levels):
            raise SettingsError("several values of a level need a table", needed="--table")
        size = math.prod(values.size for values in levels)
        if size > MOST_POINTS:
            raise SettingsError(
                "a grid has too many points for a table", found=f"{size:,}",
                needed=f"at most {MOST_POINTS:,}",
                hint="`reduction.lines.line_lookup.look_up` accepts any number of points.",
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
            "every combination has an amplitude above its mean tension",
            found=f"{taut.size} combinations",
            needed="a mean tension above the amplitude",
        )
    kept = [{name: values[taut] for name, values in at.items()} for at in points]
    return kept, not taut.all()


def _tested_rows(wanted: LookupRequest, line: LineSource) -> dict[str, Floats] | None:
    """Distinct levels of single tests; only those requested if any is."""
    levels = _levels_of(line, wanted.quantity)
    if levels is None:
        return None
    at = np.stack([one for one, _ in levels_of_tests(levels)])
    for place, name in enumerate(levels.variables):
        if name in wanted.levels:
            asked = _numbers(name, wanted.levels[name], line)
            near = np.abs(at[:, place, None] - asked) <= SAME_LEVEL * np.abs(asked)
            at = at[near.any(axis=1)]
    if not len(at):
        return None
    return {name: at[:, place].copy() for place, name in enumerate(levels.variables)}


def _is_tested(
    wanted: LookupRequest, lines: Sequence[LineSource], points: Mapping[str, Floats]
) -> Bools:
    """Mask of points at which each line has a test, for those that are known by single levels."""
    at = np.array([*points.values()]).T
    common = np.ones(len(at), dtype=bool)
    for line in lines:
        rows = _tested_rows(wanted, line) if wanted.grid else None
        if rows is not None and list(rows) == list(points):
            own = np.stack(list(rows.values()), axis=1)
            near = np.abs(at[:, None] - own) <= SAME_LEVEL * np.abs(at[:, None])
            common &= np.any(np.all(near, axis=2), axis=1)
    return common


def _levels_of(line: LineSource, quantity: str) -> LineLevels | None:
    """Tests at single levels used to look up the quantity."""
    if quantity in line.surfaces or any(one.quantity == quantity for one in line.curves):
        return None
    return next((one for one in line.levels if one.quantity == quantity), None)


def _filled(wanted: LookupRequest, lines: Sequence[LineSource]) -> dict[str, Floats]:
    """Low, centre and high of the tested ranges of all lines by level, including given ones."""
    ends = [_ends(wanted, line) for line in lines]
    filled = {}
    for name in ends[0]:
        low = max(one[name][0] for one in ends if name in one)
        high = min(one[name][1] for one in ends if name in one)
        if low > high and name not in wanted.levels:
            raise DataError(
                f"the tested ranges of {wanted.quantity} of"
                f" {' and '.join(line.name for line in lines)} has no {name.replace('_', ' ')} in"
                " common",
                found=f"one from {low:.5g}, one to {high:.5g} (SI)",
                hint=f"Give --{name.replace('_', '-')}, and --extrapolate flag.",
            )
        filled[name] = np.array([low, (low + high) / 2, high])
    return filled


def _ends(wanted: LookupRequest, line: LineSource) -> dict[str, tuple[float, float]]:
    """Tested range of each variable; for damping, that of the spring in it."""
    is_dashpot = wanted.quantity == "dashpot_coefficient" and line.has_dashpot
    name = "dissipation_spring_constant" if is_dashpot else wanted.quantity
    surface = line.surfaces.get(name)
    if surface is not None:
        return {
            name: (float(surface.low[place]), float(surface.high[place]))
            for place, name in enumerate(line.factor_names)
            if name != OF_MEAN  # an amplitude is asked for as a load
        }
    of_name = [curve for curve in line.curves if curve.quantity == name]
    for curve in of_name:
        is_meant = not wanted.levels or curve.variable in wanted.levels
        # a single branch is used without a request
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
                parse_quantity(part.strip(), LEVEL_DIMENSIONS[name], rated_break_strength=known)
                for part in text.split(",")
            ]
        )
    except SettingsError as error:
        raise SettingsError(
            f"--{name.replace('_', '-')}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip


def list_sources(source: str, search: Mapping[str, Any], *, output: CommandOutput) -> None:
    """Print the contents of SOURCE: each line, its quantities and their ranges."""
    lines = find_lines(lines_of_source(source), **search)
    unit, factor = ("in", 1 / 0.0254) if output.units == "us" else ("mm", 1e3)
    force, scale = output.unit("N")
    table = table_of(
        "line", "source", "material", "construction", "condition", f"diameter\n[{unit}]",
        f"100 %RBS\n[{force}]", "quantities", texts=5,
    )  # fmt: skip
    _fold_last(table)
    # names to copy into the next command are never wrapped
    table.columns[0].no_wrap = True
    widths = (len(name) for line in lines for name in line.quantities)
    table.columns[-1].min_width = 1 + max(widths, default=0)
    for line in lines:
        table.add_row(
            line.name, line.source, line.material, line.construction, line.condition,
            short(factor * line.diameter, 4),
            short(scale * line.rated_break_strength)
            + (f"\n({line.strength_of})" if line.strength_of else ""),
            ", ".join(line.quantities) or ("none is printed" if line.is_printed else "none"),
        )  # fmt: skip
    output.show(table)
    for line in lines:
        if len(line.levels) and len(line.levels[0].tests) > 1:
            _show_levels(line, output)
    output.answer({"lines": [_described(line) for line in lines]})


def _show_levels(line: LineSource, output: CommandOutput) -> None:
    """Print the test levels of a rope by test, with EA."""
    levels = line.levels[0]
    of, factor = output.unit(quantity_of(levels.quantity).unit)
    points = {name: levels.at[:, place] for place, name in enumerate(levels.variables)}
    heads, cells = _shown_levels(
        points, line.rated_break_strength, len(levels.tests), output.system
    )
    keys = list(dict.fromkeys(key for one in levels.conditions for key in one))
    table = table_of(
        "test", *heads, f"{levels.quantity.replace('_', ' ')}\n[{of}]", "\n[MBL]", *keys,
        title=f"Levels of {line.name}, known at tested levels and between two of them",
    )  # fmt: skip
    for place, test in enumerate(levels.tests):
        value = float(levels.value[place])
        table.add_row(
            test, *cells[place], short(factor * value),
            short(value / line.rated_break_strength, 3),
            *(levels.conditions[place].get(key, "-") for key in keys),
        )  # fmt: skip
    output.show(table)


def _described(line: LineSource) -> dict[str, Any]:
    return {
        "name": line.name,
        "source": line.source,
        "kind": line.kind,
        "material": line.material,
        "construction": line.construction,
        "condition": line.condition,
        "diameter": plain(line.diameter),
        "rated_break_strength": plain(line.rated_break_strength),
        "rated_break_strength_of": line.strength_of or None,
        "tensile_strength": plain(line.tensile_strength),
        "linear_density": plain(line.linear_density),
        "wet_linear_density": plain(line.wet_linear_density),
        "units": {
            "diameter": "m",
            "rated_break_strength": "N",
            "tensile_strength": "N",
            "linear_density": "kg m-1",
            "wet_linear_density": "kg m-1",
        },
        "quantities": list(line.quantities),
        "absent": line.absent,
        "ranges": {
            quantity: {
                name: [float(surface.low[place]), float(surface.high[place])]
                for place, name in enumerate(line.factor_names)
            }
            for quantity, surface in line.surfaces.items()
        },
        "curves": [
            {
                "quantity": curve.quantity,
                "variable": curve.variable,
                "branch": curve.branch or None,
                "range": [curve.low, curve.high],
                "range_note": curve.range_note or None,
            }
            for curve in line.curves
        ],
        "range_units": {
            name: "1" if name == OF_MEAN else quantity_of(name).unit
            for name in (
                *line.factor_names,
                *(curve.variable for curve in line.curves),
                *(name for one in line.levels for name in one.variables),
            )
        },
        "levels": [
            {
                "quantity": one.quantity,
                "unit": quantity_of(one.quantity).unit,
                "tests": list(one.tests),
                **{name: plain(one.at[:, place]) for place, name in enumerate(one.variables)},
                "value": plain(one.value),
                "conditions": list(one.conditions),
            }
            for one in line.levels
        ],
        "conditions": line.conditions,
        "rule": line.rule,
        "notes": list(line.notes),
    }


def look_up_values(source: str, wanted: LookupRequest, *, output: CommandOutput) -> None:
    """Print design values; comma-separated values of a level form a grid."""
    form = _form_of(wanted.out)
    line = line_of_request(source, wanted)
    (points,), left_out = _points_of(wanted, line)
    if left_out:
        output.say("combinations with an amplitude above the mean tension are left out")
    found = look_up(
        line, wanted.quantity, branch=wanted.branch, extrapolate=wanted.extrapolate, **points
    )
    _show(line, found, points, output)
    files = _write_table(
        lambda tables: tables.table_of_values(line, found, points), wanted.out, form, output
    )
    output.answer(_document(line, found, points, grid=wanted.grid) | {"files": files})


def look_up_population(
    source: str, wanted: LookupRequest, share: float, *, output: CommandOutput
) -> None:
    """Print the mean of all specimens of one kind, another specimen, and tolerance limits."""
    from reduction.lines.population import population_values, specimens_of_kind

    form = _form_of(wanted.out)
    chosen = specimens_of_kind(lines_with(source, wanted), wanted.quantity, wanted.name)
    points, _ = _points_of(wanted, chosen[0], *chosen[1:])
    is_common = _is_tested(wanted, chosen[1:], points[0])
    if is_common.any() and not is_common.all():
        points = [{name: one[is_common] for name, one in at.items()} for at in points]
        output.say("levels at which not every specimen was tested are left out")
    every = [
        look_up(line, wanted.quantity, branch=wanted.branch, extrapolate=wanted.extrapolate, **at)
        for line, at in zip(chosen, points, strict=True)
    ]
    found = population_values(chosen, every, share)
    values, kind = found.values, replace(chosen[0], name=f"{len(chosen)} specimens")
    unit, factor = output.unit(values.unit)
    output.say_each("warning", values.warnings)
    output.say(f"{values.quantity} of {kind.name}; {values.source}")
    if output.is_text:
        output.show(_population_table(kind, found, points[0], unit, factor, output.system))
    _said_of_lines(output, (kind, values))
    files = _write_table(
        lambda tables: tables.table_of_population(kind, found, points[0]),
        wanted.out, form, output,
    )  # fmt: skip
    of = partial(_at_points, is_grid=wanted.grid)
    output.answer(
        _document(kind, values, points[0], grid=wanted.grid)
        | {
            "population": {
                "specimens": dict(zip(found.specimens, map(of, found.of_specimens), strict=True)),
                "standard_deviation": of(found.standard_deviation),
                "share": found.share,
                "confidence": found.confidence,
                "one_sided_factor": found.one_sided_factor,
                "two_sided_factor": found.two_sided_factor,
                "lower_limit": of(found.lower),
                "upper_limit": of(found.upper),
                "two_sided_limits": [of(found.both_low), of(found.both_high)],
                "shared_half_width": of(found.shared_half_width),
            },
            "files": files,
        }
    )


def _population_table(
    kind: LineSource,
    found: PopulationValues,
    points: Mapping[str, Floats],
    unit: str,
    factor: float,
    system: UnitSystem,
) -> Table:
    values, share = found.values, f"{100 * found.share:g} %"
    heads, levels = _shown_levels(points, kind.rated_break_strength, values.value.size, system)
    table = table_of(
        *heads, f"mean\n[{unit}]", "standard\ndeviation", "95 % interval,\nmean of the kind",
        "95 % interval,\nanother specimen", f"{share} are\nabove", f"{share} are\nbelow",
        f"{share} are\nbetween", texts=0,
    )  # fmt: skip
    for place, numbers in enumerate(levels):

        def of(numbers: Floats, place: int = place) -> float:
            return float(numbers.ravel()[place])

        half = factor * (of(values.kind_high) - of(values.kind_low)) / 2
        table.add_row(
            *numbers, within(factor * of(values.value), half),
            short(factor * of(found.standard_deviation), 3),
            _span(factor, of(values.kind_low), of(values.kind_high)),
            _span(factor, of(values.line_low), of(values.line_high)),
            # stiffness and energy are never below zero
            within(factor * of(found.lower), half) if of(found.lower) > 0 else "no limit",
            within(factor * of(found.upper), half),
            _span(factor, max(of(found.both_low), 0.0), of(found.both_high)),
        )  # fmt: skip
    return table


def look_up_ranked(source: str, wanted: LookupRequest, *, output: CommandOutput) -> None:
    """Print lines ranked by a quantity at one load, with ties marked."""
    from reduction.lines.line_rank import outside_words, rank_lines

    lines = lines_to_rank(source, wanted)
    points = [
        {name: float(_numbers(name, text, line)[0]) for name, text in wanted.levels.items()}
        for line in lines
    ]
    found = rank_lines(
        lines, wanted.quantity, points, branch=wanted.branch, extrapolate=wanted.extrapolate
    )
    unit, factor = output.unit(quantity_of(wanted.quantity).unit)
    size, per_metre = ("in", 1 / 0.0254) if output.units == "us" else ("mm", 1e3)
    place = {one.line.name: number for number, one in enumerate(found.ranked, start=1)}
    table = table_of(
        "rank", "line", f"diameter\n[{size}]", f"value\n[{unit}]",
        "95 % interval,\nthese specimens", "95 % interval,\nanother specimen",
        "ties with\n(these specimens)", "ties with\n(another specimen)", "remark",
        texts=2,
    )  # fmt: skip
    _fold_last(table)
    said = {}
    for one in found.ranked:
        values = one.values
        half = factor * float(values.surface_high - values.surface_low) / 2
        beyond = "; ".join(
            outside_words(out, *_shown(out.name, output.system)) for out in one.outside
        )
        remarks = [beyond, *(_remarks(values, 0) if not beyond else _remarks(values, 0)[1:])]
        said[one.line.name] = "; ".join(text for text in remarks if text)
        table.add_row(
            f"{place[one.line.name]}{'=' if one.ties else ''}", one.line.name,
            short(per_metre * one.line.diameter, 4), within(factor * float(values.value), half),
            *(_span(factor, float(low), float(high)) for low, high in (
                (values.surface_low, values.surface_high), (values.line_low, values.line_high),
            )),
            *("no interval" if names is None else
              ", ".join(str(place[name]) for name in names) or "none"
              for names in (one.ties, one.kind_ties)),
            said[one.line.name] or "-",
        )  # fmt: skip
    for one in found.ranked:
        output.say_each(f"warning of {one.line.name}", one.values.warnings)
    output.say(f"{wanted.quantity}, lowest first")
    output.show(table)
    for name, why in found.left_out:
        output.say(f"not ranked: {name}: {why}")
    for erratum in found.errata:
        output.say(
            f"erratum {erratum.id}: {erratum.place} prints the opposite ({erratum.printed}, in"
            f" units of 10,000 lbf); correct: {erratum.corrected}"
        )
    output.say("a tie: the 95 % intervals overlap, so the order may be reversed")
    output.answer(
        {
            "quantity": wanted.quantity,
            "unit": quantity_of(wanted.quantity).unit,
            "ranked": [
                {
                    "rank": place[one.line.name],
                    "line": one.line.name,
                    "diameter": plain(one.line.diameter),
                    "levels": at,
                    "value": plain(float(one.values.value)),
                    "interval": [
                        plain(float(one.values.surface_low)), plain(float(one.values.surface_high)),
                    ],
                    "line_interval": [
                        plain(float(one.values.line_low)), plain(float(one.values.line_high)),
                    ],
                    "ties": list(one.ties),
                    "line_ties": None if one.kind_ties is None else list(one.kind_ties),
                    "inside": bool(one.values.is_inside.all()),
                    "remark": said[one.line.name],
                    "warnings": list(one.values.warnings),
                    "source": one.values.source,
                }
                for one in found.ranked
                for at in [points[lines.index(one.line)]]
            ],
            "left_out": dict(found.left_out),
            "errata": [one.id for one in found.errata],
        }
    )  # fmt: skip


def line_of_request(source: str, wanted: LookupRequest) -> LineSource:
    """The single requested line, with only its tests in the requested conditions."""
    lines = find_lines(lines_of_source(source), **wanted.search)
    return _in_conditions(one_line_of(lines, wanted.quantity, wanted.name), wanted)


def lines_with(source: str, wanted: LookupRequest) -> list[LineSource]:
    """Lines with the quantity, with only their tests in the requested conditions."""
    lines = find_lines(lines_of_source(source), **wanted.search)
    return [_in_conditions(line, wanted) for line in lines if wanted.quantity in line.quantities]


def lines_to_rank(source: str, wanted: LookupRequest) -> list[LineSource]:
    """Selected lines from `lines_with`; an error if there are none."""
    lines = [one for one in lines_with(source, wanted) if wanted.name in (None, one.name)]
    if not lines:
        raise SettingsError(f"no line has {wanted.quantity}", found=source, needed="two or more")
    return lines


def _in_conditions(line: LineSource, wanted: LookupRequest) -> LineSource:
    return in_conditions(
        line, wanted.quantity, wanted.conditions, is_flagged=wanted.extrapolate == "flag"
    )


def _form_of(out: Path | None) -> str | None:
    """Format given by the suffix of a file."""
    if out is None:
        return None
    from reduction.lines.export_tables import format_of_file

    return format_of_file(out)


def _write_table(
    make: Callable[[ModuleType], ValueTable],
    out: Path | None,
    form: str | None,
    output: CommandOutput,
) -> list[str]:
    """Write the table of an answer where a file is asked for, and report it."""
    if out is None or form is None:
        return []
    # they import xarray, which output to the screen does not need
    from reduction.lines import export_tables
    from reduction.lines.deck_formats import export_table

    paths = export_table(make(export_tables), form, out, units=output.system)
    for path in paths:
        output.say(f"written: {path}")
    return [str(path) for path in paths]


def _show(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], output: CommandOutput
) -> None:
    unit, factor = output.unit(found.unit)
    branch = f", {found.branch} branch" if found.branch else ""
    output.say_each("warning", found.warnings)
    output.say(f"{found.quantity} of {line.name}{branch}; {found.source}")
    if output.is_text:
        output.show(_table(line, found, points, unit, factor, output.system))
        _show_consistent(line, found, points, output)
    _said_of_lines(output, (line, found))


def _table(
    line: LineSource,
    found: DesignValues,
    points: Mapping[str, Floats],
    unit: str,
    factor: float,
    system: UnitSystem,
) -> Table:
    """One row per point, with the known intervals."""
    heads, levels = _shown_levels(points, line.rated_break_strength, found.value.size, system)
    is_levels = _levels_of(line, found.quantity) is not None
    run, of = "one more run", "the surface" if found.interval_of else "this test"
    if is_levels:
        run, of = "one more test", "the tests"
    intervals = [
        (head, low.ravel(), high.ravel())
        for head, low, high in (
            (f"95 % interval,\n{run}", found.low, found.high),
            (f"95 % interval,\n{of}", found.surface_low, found.surface_high),
            ("95 % interval,\nanother specimen", found.line_low, found.line_high),
        )
        if np.isfinite(low).any()
    ]
    is_weaker = np.isfinite(line.tensile_strength)
    # rope makers and rules state stiffness relative to break strength
    is_share = found.unit == "N" and found.quantity != "branch_tension" and not line.strength_of
    is_share = is_share and np.isfinite(line.rated_break_strength)
    table = table_of(
        *heads, f"value\n[{unit}]", *(("value\n[MBL]",) if is_share else ()),
        *(head for head, _, _ in intervals),
        "peak\n[%RBS]", "minimum\n[%RBS]",
        *(("peak [% of\nresidual strength]",) if is_weaker else ()), "remark", texts=0,
    )  # fmt: skip
    _fold_last(table)
    shares = [found.peak_share, found.minimum_share, *([found.own_peak_share] if is_weaker else [])]
    for place, numbers in enumerate(levels):
        table.add_row(
            *numbers,
            within(
                factor * float(found.value.ravel()[place]),
                *(factor * float(high[place] - low[place]) / 2 for _, low, high in intervals),
            ),
            *(
                (short(float(found.value.ravel()[place]) / line.rated_break_strength, 3),)
                if is_share
                else ()
            ),
            *(_span(factor, low[place], high[place]) for _, low, high in intervals),
            *(short(100 * float(share.ravel()[place]), 4) for share in shares),
            "; ".join(_remarks(found, place)),
        )
    return table


def _slow_pulls_at(line: LineSource, points: Mapping[str, Floats]) -> list[tuple[str, Floats]]:
    """K_0 from each printed method."""
    mean = points["mean_tension"]
    return [(of, evaluate_curve(curve, mean).value) for of, curve in line.slow_pulls.items()]


def _consistent(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats]
) -> tuple[ConsistentValues, ...]:
    """K_1 and tau consistent with K_ap and H at surface points; empty for tests at levels."""
    if found.quantity not in (K_AP, ENERGY, K_1, TIME, DASHPOT) or not line.surfaces:
        return ()
    return consistent_values(line, **points) if is_of_loads(points) else ()


def _show_consistent(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], output: CommandOutput
) -> None:
    """Print every K_0 of a rope with slow pulls, and K_1 and tau that fit its K_ap and H."""
    force, scale = output.unit("N")
    if found.quantity == K_0 and len(line.slow_pulls) > 1:
        misfit = {
            one.slow_pull: one.greatest for one in refitted_surfaces(line) if one.quantity == K_1
        }
        table = table_of(
            f"mean tension\n[{force}]", "K_0 from", f"K_0\n[{force}]", "greatest z\nof printed K_1",
            texts=0,
        )  # fmt: skip
        for of, values in _slow_pulls_at(line, points):
            z = short(misfit.get(of, math.nan), 3)
            for mean, value in zip(points["mean_tension"].ravel(), values.ravel(), strict=True):
                table.add_row(as_given(scale * float(mean)), of, short(scale * float(value)), z)
        output.show(table)
    found_values = _consistent(line, found, points)
    if not found_values:
        return
    heads, levels = _shown_levels(
        points, line.rated_break_strength, found.value.size, output.system
    )
    stated = "printed" if line.is_printed else "of surface"
    output.say(
        "K_1 and tau as printed, and solved from K_ap, H and K_0 by the three-parameter model:"
        if line.is_printed
        else "K_1 and tau of their own surfaces, and solved from K_ap, H and K_0 by the"
        " three-parameter model:"
    )
    table = table_of(
        *heads, "K_0 from", *(f"{name}\n[{force}]" for name in ("K_ap", "K_0")),
        f"K_1 {stated}\n[{force}]", f"K_1 solved\n[{force}]", f"tau {stated}\n[s]",
        "tau solved\n[s]", "remark", texts=0,
    )  # fmt: skip
    _fold_last(table)
    nothing = np.full(found.value.shape, np.nan)
    for place, cells in enumerate(levels):
        for one in found_values:
            columns = (
                (one.of_surfaces[K_AP], scale), (one.quasi_static_spring_constant, scale),
                (one.of_surfaces.get(K_1, nothing), scale),
                (one.dissipation_spring_constant, scale),
                (one.of_surfaces.get(TIME, nothing), 1.0), (one.relaxation_time, 1.0),
            )  # fmt: skip
            remark = REASONS[int(one.reason.ravel()[place])]
            if not remark and line.is_printed and one.is_impossible.ravel()[place]:
                remark = "printed K_ap is above K_0 + printed K_1"
            apart = [
                symbol
                for symbol, name in (("K_1", K_1), ("tau", TIME))
                if one.is_apart(name).ravel()[place]
            ]
            if apart:
                remark = f"{' and '.join(apart)}: outside the interval"
            table.add_row(
                *cells, one.slow_pull,
                *(short(by * float(column.ravel()[place])) for column, by in columns),
                remark or "-",
            )  # fmt: skip
    output.show(table)


def _remarks(found: DesignValues, place: int) -> list[str]:
    def at(values: Any) -> Any:
        return values.ravel()[place]

    return [
        word
        for word, is_so in (
            ("OUTSIDE the tested range", not at(found.is_inside)),
            ("untested corner", at(found.is_untested)),
            ("peak above the residual strength", at(found.own_peak_share) >= 1),
            ("peak above the rule", at(found.is_above_rule)),
            ("snap load: goes slack", at(found.is_slack) and at(found.peak_tension) > 0),
            ("negative: do not use", at(found.is_below_zero)),
            (
                "interval includes zero",
                not at(found.is_below_zero) and (at(found.low) < 0 or at(found.surface_low) < 0),
            ),
        )
        if is_so
    ]


def _said_of_lines(output: CommandOutput, *pairs: tuple[LineSource, DesignValues]) -> None:
    """Print the statements, rule, errata and notes of each line, without repeated sentences."""
    told = []
    for line, found in pairs:
        of = f" of {line.name}" if len(pairs) > 1 else ""
        for what, value in (("in air", line.linear_density), ("in water", line.wet_linear_density)):
            if np.isfinite(value):
                told.append(f"linear density{of} {what}: {short(value)} kg/m")
        conditions = conditions_of(line, found.quantity)
        if conditions:
            words = ", ".join(f"{name} {text}" for name, text in conditions.items())
            told.append(f"test conditions{of}: {words}")
        told.append(f"rule: {found.rule}")
        if found.errata:
            told.append(
                f"errata that apply{of.replace(' of ', ' to ', 1)}: {', '.join(found.errata)}"
            )
        told += [f"note{of}: {note}" for note in found.notes]
    for text in dict.fromkeys(told):
        output.say(text)


def _shown_levels(
    points: Mapping[str, Floats], strength: float, size: int, system: UnitSystem
) -> tuple[list[str], list[list[str]]]:
    """Headings and cells of the levels, with tensions also in %RBS if that is known."""
    heads, columns = [], []
    for name, values in points.items():
        unit, factor = _shown(name, system)
        # words of a name are stacked: there is little room beside seven columns
        words = name.replace("_", "\n")
        heads.append(f"{words}\n[{unit}]")
        columns.append([as_given(factor * float(value)) for value in values.ravel()])
        if name in TENSIONS and np.isfinite(strength):
            heads.append("\n[%RBS]")
            columns.append([short(100 * float(value) / strength, 4) for value in values.ravel()])
    return heads, [[column[place] for column in columns] for place in range(size)]


def _fold_last(table: Table) -> None:
    """Give the last column, of words, the space left by the numbers."""
    last = table.columns[-1]
    last.justify, last.no_wrap, last.overflow = "left", False, "fold"


def _span(factor: float, low: float, high: float) -> str:
    """An interval for a table; a dash if there is none."""
    if not (np.isfinite(low) and np.isfinite(high)):
        return "-"
    ends, half = (factor * float(low), factor * float(high)), factor * float(high - low) / 2
    return " to ".join(within(one, half) for one in ends)


def _shown(name: str, system: UnitSystem) -> tuple[str, float]:
    if LEVEL_DIMENSIONS.get(name) == "strain":
        return "%", 100.0
    return display_unit(quantity_of(name).unit, system)


def _at_points(values: Any, *, is_grid: bool) -> Any:
    """Numbers for JSON: a list for a grid, one for a single point."""
    shaped = np.atleast_1d(values).ravel()
    return plain(shaped if is_grid else shaped[0])


def _document(
    line: LineSource, found: DesignValues, points: Mapping[str, Floats], *, grid: bool
) -> dict[str, Any]:
    """Output of ``--json`` in SI: numbers for a single point, lists for a grid."""
    of = partial(_at_points, is_grid=grid)
    return {
        "line": line.name,
        "quantity": found.quantity,
        "branch": found.branch or None,
        "levels": {name: of(values) for name, values in points.items()},
        "level_units": {name: quantity_of(name).unit for name in points},
        "value": of(found.value),
        "unit": found.unit,
        "value_over_strength": of(
            found.value / line.rated_break_strength
            if found.unit == "N"
            else np.full(found.value.shape, np.nan)
        ),
        "below_zero": of(found.is_below_zero),
        "interval": [of(found.low), of(found.high)],
        "interval_of": found.interval_of or None,
        "surface_interval": [of(found.surface_low), of(found.surface_high)],
        "surface_interval_of": found.surface_interval_of or None,
        "kind_interval": [of(found.kind_low), of(found.kind_high)],
        "kind_interval_of": "the mean of all specimens of the kind",
        "line_interval": [of(found.line_low), of(found.line_high)],
        "line_interval_of": "another specimen of the kind",
        "inside": of(found.is_inside),
        "untested": of(found.is_untested),
        "peak_tension": of(found.peak_tension),
        "minimum_tension": of(found.minimum_tension),
        "peak_share": of(found.peak_share),
        "minimum_share": of(found.minimum_share),
        "tension_unit": "N",
        "own_peak_share": of(found.own_peak_share),
        "own_minimum_share": of(found.own_minimum_share),
        "slack": of(found.is_slack),
        "above_rule": of(found.is_above_rule),
        "rule": found.rule,
        "rated_break_strength": plain(line.rated_break_strength),
        "rated_break_strength_of": line.strength_of or None,
        "tensile_strength": plain(line.tensile_strength),
        "strength_unit": "N",
        "linear_density": plain(line.linear_density),
        "wet_linear_density": plain(line.wet_linear_density),
        "linear_density_unit": "kg m-1",
        "source": found.source,
        "conditions": conditions_of(line, found.quantity),
        "warnings": list(found.warnings),
        "slow_pulls": {
            name: of(values)
            for name, values in (_slow_pulls_at(line, points) if found.quantity == K_0 else ())
        },
        "consistent": [
            {
                "slow_pull": one.slow_pull,
                "of_surfaces": {name: of(values) for name, values in one.of_surfaces.items()},
                "units": {
                    name: quantity_of(name).unit for name in (*one.of_surfaces, K_0, K_1, TIME)
                },
                K_0: of(one.quasi_static_spring_constant),
                K_1: of(one.dissipation_spring_constant),
                TIME: of(one.relaxation_time),
                "impossible": of(one.is_impossible),
                "difference_half_width": {
                    name: of(values) for name, values in one.half_width.items()
                },
                "apart": {name: of(one.is_apart(name)) for name in one.half_width},
            }
            for one in _consistent(line, found, points)
        ],
        "errata": list(found.errata),
        "notes": list(found.notes),
    }


def look_up_against(
    source: str, other: str, wanted: LookupRequest, *, output: CommandOutput
) -> None:
    """Print values of two lines, their difference and ratio, and its significance."""
    form = _form_of(wanted.out)
    lines = lines_of_source(source)
    first = one_line_of(find_lines(lines, **wanted.search), wanted.quantity, wanted.name)
    second = _other(lines, other, wanted.quantity, first)
    first, second = (_in_conditions(line, wanted) for line in (first, second))
    pair = compared_tethers(first, second)
    if pair is not None:
        first, second = pair.first, pair.second
    (points, others), left_out = _points_of(wanted, first, second)
    if left_out:
        output.say("combinations with an amplitude above the mean tension are left out")
    values = [
        look_up(line, wanted.quantity, branch=wanted.branch, extrapolate=wanted.extrapolate, **at)
        for line, at in ((first, points), (second, others))
    ]
    found = compare_values(*values, campaigns=(first.campaign, second.campaign))
    if pair is not None:
        found = replace(found, notes=(*pair.notes, *found.notes))
        output.say(pair.notes[0] + "; " + pair.notes[1])
    _show_difference(first, second, found, points, others, output)
    files = _write_table(
        lambda tables: tables.table_of_difference(first, second, found, points, others),
        wanted.out, form, output,
    )  # fmt: skip
    document = _difference_document(first, second, found, points, others, grid=wanted.grid)
    output.answer(document | {"files": files})


def _other(lines: list[LineSource], name: str, quantity: str, first: LineSource) -> LineSource:
    """The second line: one of SOURCE by name, else from a source of that name."""
    of_source = [line for line in lines if line.name == name]
    found = of_source or lines_of_source(name)
    having = [line for line in found if quantity in line.quantities]
    if len(having) < 2:
        return one_line_of(found, quantity, None)
    alike = [line for line in having if line.name == first.name]
    if len(alike) != 1:
        raise SettingsError(
            f"--against {name} matches several lines with {quantity}",
            found=", ".join(f"{line.name} ({line.source})" for line in having),
            needed=f"the name of one line, or one called {first.name} as the first is",
            hint='Of tests of one campaign: lookup processed/CAMPAIGN --line "T-1 new" --against '
            '"T-2 used".',
        )
    return alike[0]


def _show_difference(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    others: Mapping[str, Floats],
    output: CommandOutput,
) -> None:
    unit, factor = output.unit(found.unit)
    branch = f", {found.first.branch} branch" if found.first.branch else ""
    # one specimen in two tests has the same name
    told = [
        f"{line.name} of {line.source}" if first.name == second.name else line.name
        for line in (second, first)
    ]
    for which, one in (("first", found.first), ("second", found.second)):
        output.say_each(f"warning of the {which}", one.warnings)
    output.say(f"{found.quantity} of {told[0]} (second) against {told[1]} (first){branch}")
    if any(not np.array_equal(values, others[name]) for name, values in points.items()):
        output.say(
            "levels in %RBS are shares of each line's own break strength: "
            + " and ".join(
                f"{short(scale * line.rated_break_strength)} {force}"
                for line in (first, second)
                for force, scale in (output.unit("N"),)
            )
            + "; loads are those of the first"
        )
    if output.is_text:
        output.show(_difference_table(first, found, points, unit, factor, output.system))
    output.say("where they differ, the 95 % interval of the difference excludes zero")
    output.say("the 95 % interval of the difference is for the specimens that were tested")
    output.say(
        "these specimens: the means of those tested; the kinds, another specimen of each:"
        " including the scatter between specimens, where a source states it"
    )
    for note in found.notes:
        output.say(note)
    _said_of_lines(output, (first, found.first), (second, found.second))


def _difference_table(
    first: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    unit: str,
    factor: float,
    system: UnitSystem,
) -> Table:
    heads, levels = _shown_levels(points, first.rated_break_strength, found.difference.size, system)
    table = table_of(
        *heads, f"first\n[{unit}]", f"second\n[{unit}]", f"difference\n[{unit}]", "ratio",
        "95 % interval of\nthe difference,\nthese specimens", "these\nspecimens", "the kinds",
        "another specimen\nof each", "remark", texts=0,
    )  # fmt: skip
    _fold_last(table)
    numbers = ("difference", "ratio", "surface_low", "surface_high")
    for place, cells in enumerate(levels):
        at = {name: float(getattr(found, name).ravel()[place]) for name in numbers}
        table.add_row(
            *cells,
            *(within(*_with_halves(one, place, factor)) for one in (found.first, found.second)),
            within(
                factor * at["difference"], factor * (at["surface_high"] - at["surface_low"]) / 2
            ),
            short(at["ratio"], 4),
            _span(factor, at["surface_low"], at["surface_high"]),
            _verdict(found.is_known, found.is_different, place),
            _verdict(found.is_kind_known, found.is_kind_different, place),
            _verdict(found.is_line_known, found.is_line_different, place),
            _remark(found, place),
        )
    return table


def _with_halves(found: DesignValues, place: int, factor: float) -> tuple[float, ...]:
    """A value and the half-widths of its intervals in display units."""
    spans = ((found.surface_low, found.surface_high), (found.low, found.high))
    halves = ((high - low).ravel()[place] / 2 for low, high in spans)
    return tuple(factor * float(one) for one in (found.value.ravel()[place], *halves))


def _verdict(is_known: Bools, is_different: Bools, place: int) -> str:
    if not is_known.ravel()[place]:
        return "no interval"
    return "differ" if is_different.ravel()[place] else "no difference shown"


def _remark(found: LineDifference, place: int) -> str:
    words = []
    for which, one in (("first", found.first), ("second", found.second)):
        if not one.is_inside.ravel()[place]:
            words.append(f"{which}: OUTSIDE")
        if one.is_untested.ravel()[place]:
            words.append(f"{which}: untested corner")
        if one.own_peak_share.ravel()[place] >= 1:
            words.append(f"{which}: peak above the residual strength")
        elif one.is_above_rule.ravel()[place]:
            words.append(f"{which}: peak above the rule")
        if one.is_below_zero.ravel()[place]:
            words.append(f"{which}: negative, do not use")
    return "; ".join(words)


def _difference_document(
    first: LineSource,
    second: LineSource,
    found: LineDifference,
    points: Mapping[str, Floats],
    others: Mapping[str, Floats],
    *,
    grid: bool,
) -> dict[str, Any]:
    """Output of ``--json`` in SI: numbers for a single point, lists for a grid."""
    of = partial(_at_points, is_grid=grid)

    def side(line: LineSource, one: DesignValues, at: Mapping[str, Floats]) -> dict[str, Any]:
        return {
            "line": line.name,
            "levels": {name: of(values) for name, values in at.items()},
            "level_units": {name: quantity_of(name).unit for name in at},
            "value": of(one.value),
            "interval": [of(one.low), of(one.high)],
            "interval_of": one.interval_of or None,
            "surface_interval": [of(one.surface_low), of(one.surface_high)],
            "surface_interval_of": one.surface_interval_of or None,
            "kind_interval": [of(one.kind_low), of(one.kind_high)],
            "line_interval": [of(one.line_low), of(one.line_high)],
            "below_zero": of(one.is_below_zero),
            "inside": of(one.is_inside),
            "untested": of(one.is_untested),
            "peak_share": of(one.peak_share),
            "minimum_share": of(one.minimum_share),
            "own_peak_share": of(one.own_peak_share),
            "own_minimum_share": of(one.own_minimum_share),
            "tensile_strength": plain(line.tensile_strength),
            "above_rule": of(one.is_above_rule),
            "rule": one.rule,
            "source": one.source,
            "warnings": list(one.warnings),
            "errata": list(one.errata),
            "notes": list(one.notes),
        }

    return {
        "quantity": found.quantity,
        "branch": found.first.branch or None,
        "unit": found.unit,
        "first": side(first, found.first, points),
        "second": side(second, found.second, others),
        "difference": of(found.difference),
        "ratio": of(found.ratio),
        "surface_interval": [of(found.surface_low), of(found.surface_high)],
        "interval": [of(found.low), of(found.high)],
        "kind_interval": [of(found.kind_low), of(found.kind_high)],
        "line_interval": [of(found.line_low), of(found.line_high)],
        "known": of(found.is_known),
        "different": of(found.is_different),
        "test_known": of(found.is_test_known),
        "test_different": of(found.is_test_different),
        "kind_known": of(found.is_kind_known),
        "kind_different": of(found.is_kind_different),
        "line_known": of(found.is_line_known),
        "line_different": of(found.is_line_different),
        "inside": of(found.is_inside),
        "notes": list(found.notes),
    }

"""The command experiment: a run sheet, what to know before the first run, and the precision."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np
from rich.markup import escape

from reduction.archive.write import write_whole
from reduction.campaign.spec import ExperimentSpec, load_spec
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import plain, short, table_of
from reduction.errors import ReductionError, SettingsError
from reduction.surface.cautions import Caution, find_cautions
from reduction.surface.designs import Design, DesignKind, box_behnken, plackett_burman
from reduction.surface.precision import ExpectedPrecision, expected_precision
from reduction.surface.runsheet import RunSheet, make_run_sheet
from reduction.surface.smallest import smallest_effect
from reduction.tables.column import csv_text
from reduction.units import UnitSystem, display_unit

_ROUNDING = 1e-9


def plan_runs(kind: DesignKind, path: Path, *, out: Path | None, output: CommandOutput) -> None:
    """Print the run sheet of SPEC.toml, and write it where asked for."""
    spec = load_spec(path)
    try:
        design = _design(kind, spec)
        sheet = make_run_sheet(
            design,
            tuple(factor.levels for factor in spec.factors if factor.levels is not None),
            rated_break_strength=spec.rated_break_strength,
            repeats=spec.repeats,
        )
        cautions = find_cautions(
            sheet, load_limit=spec.load_limit, peak_share_limit=spec.peak_share_limit
        )
        precision = _precision(design, sheet, spec)
    except ReductionError as error:
        raise in_file(path, error) from error
    if out is not None:
        write_whole(out, _csv(design, sheet, spec))
    units = cast("UnitSystem", output.units)
    _show_sheet(sheet, spec, output, units)
    for caution in cautions:
        output.say(f"caution: {caution.message}. {caution.hint}")
    if precision is not None:
        _show_precision(precision, spec, output, units)
    if out is not None:
        output.say(f"run sheet: {out}")
    output.answer(_document(kind, design, sheet, spec, cautions, precision, out))


def in_file(path: Path, error: ReductionError) -> ReductionError:
    """The same error with the file in front."""
    return type(error)(
        f"{path}: {error.problem}", found=error.found, needed=error.needed, hint=error.hint
    )


def _design(kind: DesignKind, spec: ExperimentSpec) -> Design:
    if spec.kind not in (None, kind):
        raise SettingsError(
            "the design is another than that of the command", found=f'kind = "{spec.kind}"',
            needed=kind,
        )  # fmt: skip
    if not spec.factors:
        raise SettingsError(
            "there are no factors", needed='[factors] with frequency = ["0.1 Hz", "0.5 Hz"]'
        )
    if kind == "box-behnken":
        if spec.n_runs is not None:
            raise SettingsError(
                "experiment.n_runs is for plackett-burman", needed="n_centre, or nothing"
            )
        return box_behnken(len(spec.factors), n_centre=spec.n_centre)
    if spec.n_centre is not None:
        raise SettingsError(
            "experiment.n_centre is for box-behnken", needed="n_runs, or nothing",
            hint="Two levels have no centre.",
        )  # fmt: skip
    return plackett_burman(len(spec.factors), n_runs=spec.n_runs)


def _precision(
    design: Design, sheet: RunSheet, spec: ExperimentSpec
) -> ExpectedPrecision | float | None:
    """Half widths of a surface, or the smallest effect of a screening."""
    if spec.sigma is None:
        return None
    if design.kind == "plackett-burman":
        return float(smallest_effect(design, sigma=spec.sigma))
    return expected_precision(sheet.coded, sigma=spec.sigma, factor_names=sheet.names)


def _level_units(spec: ExperimentSpec) -> tuple[str, ...]:
    """SI units of the levels of the sheet, where every share has become a force."""
    return tuple(
        factor.si_unit if factor.levels and factor.levels.basis == "absolute" else "N"
        for factor in spec.factors
    )


def _loads(sheet: RunSheet) -> dict[str, tuple[np.ndarray[Any, Any], str]]:
    """Loads of each run that are known, with their units."""
    columns = {
        "peak_tension": (sheet.peak_tension, "N"),
        "minimum_tension": (sheet.minimum_tension, "N"),
        "peak_share": (sheet.peak_share, "1"),
        "minimum_share": (sheet.minimum_share, "1"),
    }
    return {name: entry for name, entry in columns.items() if np.isfinite(entry[0]).all()}


def _csv(design: Design, sheet: RunSheet, spec: ExperimentSpec) -> str:
    """The sheet as a form: levels in SI, and an empty column for each response."""
    loads = _loads(sheet)
    header = [
        "run_order", "run", *(f"{name} [coded]" for name in sheet.names),
        *(f"dummy_{number + 1}" for number in range(design.dummy.shape[1])),
        *(f"{name} [{unit}]" for name, unit in zip(sheet.names, _level_units(spec), strict=True)),
        *(f"{name} [{unit}]" for name, (_, unit) in loads.items()),
        *(f"{entry.name} [{entry.unit}]" if entry.unit else entry.name for entry in spec.responses),
    ]  # fmt: skip
    numbers = np.column_stack(
        [
            sheet.coded,
            design.dummy[sheet.run - 1],
            sheet.engineering,
            *(values for values, _ in loads.values()),
        ]
    )
    # 0.1 of a middle and a half range is 0.09999999999999998
    rounded = [[float(f"{value:.12g}") for value in row] for row in numbers.tolist()]
    blank = [None] * len(spec.responses)
    return csv_text(
        header,
        ([place + 1, int(sheet.run[place]), *row, *blank] for place, row in enumerate(rounded)),
    )


def _show_sheet(
    sheet: RunSheet, spec: ExperimentSpec, output: CommandOutput, system: UnitSystem
) -> None:
    columns = [
        (name, *display_unit(unit, system), sheet.engineering[:, place])
        for place, (name, unit) in enumerate(zip(sheet.names, _level_units(spec), strict=True))
    ]
    columns += [
        (name, "%RBS", 100.0, values)
        if unit == "1"
        else (name, *display_unit(unit, system), values)
        for name, (values, unit) in _loads(sheet).items()
        if name != "minimum_share"  # the room of a terminal; it is in the file
    ]
    # names stand below each other's words: seven factors fit beside each other
    headings = [f"{name.replace('_', chr(10))}\n[{unit}]" for name, unit, _, _ in columns]
    table = table_of("order", "run", "coded", *headings, texts=0)
    for place, run in enumerate(sheet.run):
        coded = " ".join(f"{level:+.0f}" if level else " 0" for level in sheet.coded[place])
        numbers = (short(scale * values[place]) for _, _, scale, values in columns)
        table.add_row(str(place + 1), str(run), coded, *numbers)
    output.show(table)


def _show_precision(
    precision: ExpectedPrecision | float,
    spec: ExperimentSpec,
    output: CommandOutput,
    system: UnitSystem,
) -> None:
    unit, scale = ("%", 100.0) if spec.sigma_unit == "1" else display_unit(spec.sigma_unit, system)
    sigma = f"{short(scale * (spec.sigma or 0.0))} {unit}"
    if isinstance(precision, float):
        output.say(
            f"expected with sigma {sigma}: effects above {short(scale * precision)} {unit} are "
            "significant (90 %)"
        )
        return
    output.say(
        f"expected with sigma {sigma}: half widths of {100 * precision.confidence:g} % intervals, "
        f"{precision.degrees_of_freedom} degrees of freedom [{unit}]"
    )
    table = table_of("term", "half width")
    for term, width in zip(precision.terms, precision.term_half_width, strict=True):
        table.add_row(escape(term), short(scale * width, 3))
    output.show(table)
    table = table_of("surface at", "coded", "half width", "of one more run", texts=2)
    for kind, place in _kinds(precision).items():
        point = " ".join(f"{level:+.0f}" if level else " 0" for level in precision.points[place])
        table.add_row(
            kind, point, short(scale * precision.confidence_half_width[place], 3),
            short(scale * precision.prediction_half_width[place], 3),
        )  # fmt: skip
    output.show(table)


def _kinds(precision: ExpectedPrecision) -> dict[str, int]:
    """The worst point of each kind, the surest kind first."""
    factor, worst = precision.point_variance_factor, dict[str, int]()
    for kind in dict.fromkeys(precision.point_kind):
        places = np.flatnonzero([one == kind for one in precision.point_kind])
        # corners are as bad as each other but for rounding, which each processor does its own way
        is_worst = factor[places] >= (1 - _ROUNDING) * factor[places].max()
        place = int(places[is_worst.argmax()])
        beyond = " (beyond the runs)" if precision.is_beyond_design[place] else ""
        worst[kind + beyond] = place
    return dict(sorted(worst.items(), key=lambda one: float(factor[one[1]])))


def _document(
    kind: DesignKind,
    design: Design,
    sheet: RunSheet,
    spec: ExperimentSpec,
    cautions: tuple[Caution, ...],
    precision: ExpectedPrecision | float | None,
    out: Path | None,
) -> dict[str, Any]:
    units = _level_units(spec)
    loads = _loads(sheet)
    runs = [
        {
            "run_order": place + 1,
            "run": int(run),
            "load_block": int(sheet.load_block[place]) or None,
            "coded": plain(sheet.coded[place]),
            "dummy": plain(design.dummy[run - 1]),
            "levels": plain(sheet.engineering[place]),
            **{name: plain(values[place]) for name, (values, _) in loads.items()},
        }
        for place, run in enumerate(sheet.run)
    ]
    expected: dict[str, Any] | None = None
    if precision is not None:
        expected = {"sigma": spec.sigma, "unit": spec.sigma_unit}
    if isinstance(precision, float) and expected is not None:
        expected |= {"smallest_significant_effect": precision, "significance": 0.10}
    elif isinstance(precision, ExpectedPrecision) and expected is not None:
        expected |= {
            "confidence": precision.confidence,
            "degrees_of_freedom": precision.degrees_of_freedom,
            "terms": list(precision.terms),
            "term_half_width": plain(precision.term_half_width),
            "points": plain(precision.points),
            "point_kind": list(precision.point_kind),
            "confidence_half_width": plain(precision.confidence_half_width),
            "prediction_half_width": plain(precision.prediction_half_width),
            "is_beyond_design": plain(precision.is_beyond_design),
        }
    return {
        "kind": kind,
        "factors": [
            dict(
                zip(("unit", "low", "high"), factor.axis(spec.rated_break_strength), strict=True),
                name=factor.name,
                level_unit=unit,
            )
            for factor, unit in zip(spec.factors, units, strict=True)
        ],
        "runs": runs,
        "units": {name: unit for name, (_, unit) in loads.items()},
        "cautions": [
            {"kind": one.kind, "message": one.message, "hint": one.hint, "runs": list(one.runs)}
            for one in cautions
        ],
        "expected_precision": expected,
        "out": None if out is None else str(out),
    }

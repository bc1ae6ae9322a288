"""Tables and section of one test."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from reduction.archive.test_variables import COEFFICIENTS
from reduction.archive.uncertainty_budget import cycles_averaged
from reduction.quantities.flags import BRANCH_VALUES
from reduction.quantities.names import BRANCH_NAMES, ON_PAGE, QUANTITIES
from reduction.record.measurement import Floats
from reduction.report.answer_tables import answer_budgets, budget_sentences, budget_table
from reduction.report.campaign_summary import brief, grouped_notes
from reduction.report.figure_data import Figure, plain_numbers, script_json
from reduction.report.figures.budget_figures import draw_budgets
from reduction.report.figures.cycle_figures import draw_loops, draw_trends
from reduction.report.figures.hold_figures import draw_holds, draw_pull
from reduction.report.figures.modulus_figures import (
    OF_STEPS,
    draw_cycle_curves,
    draw_moduli,
    draw_mooney,
    draw_steps,
    flagged_steps,
)
from reduction.report.figures.record_figures import draw_record, draw_splices, draw_tension_position
from reduction.report.sheet import Calculated, Sheet, Unit
from reduction.report.test_view import (
    DRAWN,
    NORMAL,
    TestView,
    all_specimens,
    drawn_interval,
    expand,
    expanded_of,
    plus_minus,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.text_style import (
    NOT_GIVEN,
    PERCENT,
    PageTable,
    Shown,
    TableCell,
    factors_of,
    make_table,
    measured,
    shown,
    superscript,
    within,
    words,
)
from reduction.stages.moduli.local_regression import curve_at
from reduction.stages.three_parameter_line.line_product import REASONS

STEPS = (0.25, 0.05, 0.01)

"""Strain steps of the table: the first that a test of the campaign reaches; ropes are stiff. [1]"""

CONDITIONING = (
    "Conditioning, K_0 / (E' - K_0): the factor by which a relative error of K_0 grows in E' -"
    " K_0, from which K_1 and tau follow."
)

REFUSED = "refused because"

_OF_LINE = "scatter between cycles, and K_0 with the fit of its slow pull"

_OF_HOLDS = "noise, regression"

_OF_PULL = "scatter about the cubic"


def specimen_table(tests: Sequence[TestView]) -> PageTable:
    """Return the specimens of a campaign, each once, as stated in its first test."""
    names = all_specimens(tests)
    sheets = []
    for view in tests:
        own = [k for k, name in enumerate(view.specimens) if name in names]
        names = [name for name in names if name not in view.specimens]
        sheets.append(
            Sheet(view, ("specimen",)).keep(np.array(own, dtype=np.int64))
            .texts("specimen", "specimen")
            .texts("kind", "specimen_kind")
            .texts("material", "specimen_material")
            .texts("condition", "specimen_condition")
            .numbers("diameter", "diameter")
            .numbers("area at zero tension", "area")
            .numbers("rated break strength", "rated_break_strength")
        )  # fmt: skip
    caption = "Specimens before their first test; the diameter is the mean of the readings."
    empty = make_table(caption, ("specimen",), ())
    return Sheet.stack(sheets).table(caption) or empty


def specimen_notes(tests: Sequence[TestView]) -> list[str]:
    """Return the remarks on each specimen, each sentence once."""
    notes = [
        f"{one.stage.removeprefix('specimen ')}: {one}"
        for view in tests
        for one in view.notes
        if one.stage.startswith("specimen ")
    ]
    return list(dict.fromkeys(notes))


def _history_table(view: TestView) -> PageTable | None:
    """Return the history of each specimen before the test."""
    if "earlier_cycles" not in view.data:
        return None
    sheet = Sheet(view, ("specimen",)).texts("specimen", "specimen")
    sheet.texts("earlier tests", [text or "none" for text in sheet.of("earlier_tests", "")])
    sheet.counts("earlier cycles", "earlier_cycles")
    if "earlier_flex_cycles" in view.data:
        sheet.counts("earlier flex cycles", "earlier_flex_cycles")
    (
        sheet.numbers("greatest strain seen", "earlier_maximum_strain", PERCENT)
        .numbers("greatest tension seen", "earlier_maximum_tension")
        .numbers("permanent set", "permanent_set", PERCENT)
    )
    return sheet.table("History of each specimen before this test.")


def _coefficient_table(view: TestView) -> PageTable | None:
    """Return how crosshead position became strain: method, range of the marks, coefficients."""
    methods = view.texts("strain_method")
    if not methods:
        return None
    sheet = Sheet(view, ("specimen",)).texts("method", "strain_method")
    if set(methods) == {"extensometer"}:
        return sheet.turned("Strain: read from an extensometer, without splices.", view.specimens)
    sheet.texts("marks from", "strain_marks_from")
    unit: Unit
    for name in COEFFICIENTS.values():
        if np.isfinite(sheet.of(name)).any():
            one = QUANTITIES[name]
            # c of c F^n belongs to a force in newton; another unit would change its meaning
            unit = "length" if one.unit == "m" else Shown(superscript(one.unit), 1.0)
            spread = expand(sheet.of(f"{name}_standard_uncertainty"))
            sheet.measured(one.long_name, name, unit, spread)
    ranges: tuple[tuple[str, Unit, int], ...] = (("position", "length", 2), ("tension", None, 0))
    for name, unit, places in ranges:
        low, high = f"strain_{name}_low", f"strain_{name}_high"
        if np.isfinite(sheet.of(low) + sheet.of(high)).any():
            sheet.spans(f"{name} at the marks", low, high, unit, places=places)
    return sheet.turned(
        "Strain of the splice-free length from position: method and parameters.",
        view.specimens,
        remarks=[
            plus_minus(
                [NORMAL],
                "tape readings, regression on the splice marks",
                left_out="load-cell calibration, position scale, the choice of strain method",
            )
        ],
    )


def _slope_sentences(view: TestView) -> list[str]:
    """Return the effect of a constant splice fraction on moduli, one sentence per specimen."""
    ratio = view.array("strain_slope_ratio")
    if ratio is None or "tangent_modulus" not in view.data:
        return []
    found = []
    for name, method, one in zip(view.specimens, view.texts("strain_method"), ratio, strict=True):
        if not np.isfinite(one) or one <= 0 or method == "constant-fraction":
            continue
        excess = 100.0 * (1.0 / one - 1.0)
        found.append(
            f"{name}: a constant splice fraction, the method printed in WHOI-2005-10, would give"
            f" moduli {abs(excess):.1f} % {'higher' if excess >= 0 else 'lower'} (strain per"
            f" position: {one:.3f} times the one used here)."
        )
    return found


def _mark_table(view: TestView) -> PageTable | None:
    """Return the readings at the splice marks, and the error of the method at each."""
    sheet = Sheet(view, ("mark",))
    residual = sheet.of("mark_strain_residual")
    (
        sheet.texts("specimen", "mark_specimen")
        .texts("test", "mark_test")
        .texts("hold", "mark_hold")
        .numbers("position", "mark_position", "length")
        .numbers("tension", "mark_tension")
        .numbers("strain at the marks", "mark_strain", PERCENT)
        .numbers("strain by the method", sheet.of("mark_strain") + residual, PERCENT)
        .cells("method minus marks [points of strain %]", map(_signed, residual))
    )
    return sheet.table("Splice marks: tape readings, and strain by the method.", tall=12)


def _signed(residual: float) -> TableCell:
    text = f"{round(100 * residual, 2) + 0.0:+.2f}" if np.isfinite(residual) else NOT_GIVEN
    return TableCell(text, repr(float(residual)), is_number=True)


def design_tables(tests: Sequence[TestView]) -> list[PageTable]:
    """Return the modulus at round strains: rows are strains, columns the tests that reach them."""
    for step in STEPS:
        found = [_design_table(tests, specimen, step) for specimen in all_specimens(tests)]
        tables = [table for table in found if table is not None]
        if tables:
            return tables
    return []


def _design_table(tests: Sequence[TestView], specimen: str, step: float) -> PageTable | None:
    given = [(view, _at_round_strains(view, specimen, step)) for view in tests]
    columns = [(view, cells) for view, cells in given if cells]
    if not columns:
        return None
    unit = shown("stress", tests[0].units)
    levels = sorted({level for _, cells in columns for level in cells})
    sheet = Sheet(Calculated(tests[0].units))
    sheet.texts("strain [%]", [f"{100 * step * level:g}" for level in levels])
    for view, cells in columns:
        sheet.cells(unit.label(view.id), [cells.get(level, words("")) for level in levels])
    return sheet.table(
        f"{specimen}: tangent modulus at stated strains, ascending / descending, mean over the"
        " cycles of each test; inside its tested range only.",
        is_compact=True,
        remarks=[
            plus_minus_of_tests(sheet.factors, [view for view, _ in columns], ["tangent_modulus"])
        ],
    )


def _at_round_strains(view: TestView, specimen: str, step: float) -> dict[int, TableCell]:
    """Return a cell for each multiple of the step that a branch reaches."""
    if specimen not in view.specimens:
        return {}
    bins, modulus = view.array("strain_bin"), view.array("tangent_modulus")
    if bins is None or modulus is None or bins.size == 0:
        return {}
    row = view.specimens.index(specimen)
    spread = expanded_of(view, "tangent_modulus", modulus)
    spacing = float(np.min(np.diff(bins))) if bins.size > 1 else 0.0
    levels = np.arange(np.floor(bins[0] / step), np.ceil(bins[-1] / step) + 1)
    branches = view.texts("branch_name") or BRANCH_NAMES
    places = [branches.index(name) for name in BRANCH_NAMES]
    curves = [
        [curve_at(step * levels, bins, curve[row, place], spacing=spacing) for place in places]
        for curve in (modulus, spread.half, spread.factor)
    ]
    found: dict[int, TableCell] = {}
    for column in np.flatnonzero(np.isfinite(curves[0]).any(axis=0)):
        both = [
            measured(
                float(value[column]), float(half[column]), shown("stress", view.units),
                factor=float(factor[column]), is_short=True,
            )
            for value, half, factor in zip(*curves, strict=True)
        ]  # fmt: skip
        found[int(levels[column])] = TableCell(
            " /\n".join(cell.text for cell in both),
            " ".join(cell.value or "nan" for cell in both),
            is_number=True,
            factors=tuple(factors_of([both])),
        )
    return found


def segment_table(tests: Sequence[TestView]) -> PageTable | None:
    """Return the piecewise-linear moduli: the answer, in the form of Tables 5 and 6."""
    sheet = Sheet.stack(_segments(view) for view in tests if "segment_modulus" in view.data)
    of = " of the rubber" if any(view.is_rubber for view in tests) else ""
    return sheet.table(
        f"Elastic modulus{of}: slopes of the straight segments of each trimmed branch.", tall=16,
        remarks=[plus_minus_of_tests(sheet.factors, tests, ["segment_modulus"])],
    )  # fmt: skip


def _segments(view: TestView) -> Sheet:
    sheet = Sheet(view, ("specimen", "branch_name", "segment"), where="segment_modulus")
    averaged = np.broadcast_to(
        cycles_averaged(view.data, "segment_modulus"), (len(view.specimens),)
    )
    return (
        sheet.texts("test", [view.id] * sheet.n_rows)
        .texts("specimen", "specimen")
        .texts("branch", "branch_name")
        .counts("segment", sheet.places["segment"] + 1)
        .measured("segment modulus", "segment_modulus")
        .spans("strain range", "segment_strain_low", "segment_strain_high", PERCENT, places=1)
        .spans("tension range", "segment_tension_low", "segment_tension_high")
        .counts("cycles", averaged[sheet.places["specimen"]])
        .texts("strain method", "strain_method")
    )


def _summary_table(view: TestView) -> PageTable | None:
    """Return the means over the cycles of a test, and the changes over them."""
    sheet = Sheet(view, ("specimen",)).shown("means")
    if not any(np.isfinite(sheet.of(name)).any() for name in sheet.known):
        return None
    said = [sheet.about()]
    if shared_sources([view], sheet.known):
        own = [
            heading.partition(" [")[0]
            for heading, column, name in zip(
                sheet.headings, sheet.columns, sheet.known, strict=True
            )
            if factors_of([column]) and not shared_sources([view], [name])
        ]
        said += [f"For {', '.join(own)}, ± is the scatter alone."] if own else []
    return sheet.turned(
        "Means over the cycles of the test, and what changed over them.", view.specimens,
        remarks=said, optional=("mean strain to which the cycles are shifted [%]",),
    )  # fmt: skip


def _stress_table(view: TestView) -> PageTable | None:
    """Return stress at stated elongations; it is a stress and never called a modulus."""
    levels, stress = view.array("strain_level"), view.array("stress_at_strain")
    if levels is None or stress is None or not np.isfinite(stress).any():
        return None
    sheet = Sheet(view, ("specimen",)).texts("specimen", "specimen")
    for level, values in zip(levels, stress.T, strict=True):
        sheet.numbers(f"stress at {100 * level:g} %", values, "stress")
    return sheet.table(
        "Nominal stress at stated elongations of the first loading (M100 etc. in the rubber trade;"
        " not a modulus)."
    )


def _slip_table(view: TestView) -> PageTable | None:
    """Return the steps of the splices."""
    sheet = Sheet(view, ("slip",))
    ends = zip(sheet.of("slip_cycle_low"), sheet.of("slip_cycle_high"), strict=True)
    (
        sheet.texts("specimen", "slip_specimen")
        .counts("first cycle after the step", "slip_cycle")
        .cells(
            "the step lies in cycles",
            [TableCell(f"{low:.0f} to {high:.0f}", is_number=True) for low, high in ends],
        )
        .measured("step of peak tension", "slip_tension_step")
        .measured("splice slip", "slip_length")
    )
    return sheet.table("Slips of a splice, apart from steady creep.", remarks=[sheet.about()])


def _identity_table(view: TestView) -> PageTable | None:
    """Return how well the closed-cycle identity holds, over the cycles of each specimen."""
    residual = view.array("identity_residual")
    if residual is None or not np.isfinite(residual).any():
        return None
    own = [np.abs(row[np.isfinite(row)]) for row in residual]
    ends = [row if row.size else np.array([np.nan]) for row in own]
    return (
        Sheet(view, ("specimen",))
        .texts("specimen", "specimen")
        .counts("cycles checked", [row.size for row in own])
        .numbers("median residual", [np.median(row) for row in ends], PERCENT, 2)
        .numbers("greatest residual", [np.max(row) for row in ends], PERCENT, 2)
        .table(
            "Check: in every cycle, the mean modulus over the unloading stroke minus that over the"
            " loading stroke must equal the tension lost over the cycle, divided by area and strain"
            " stroke. Residuals are relative to the mean modulus of both strokes."
        )
    )


def _elastomer_table(view: TestView) -> PageTable | None:
    """Return the fitted laws with their parameters, range and stability."""
    sheet = Sheet(view, ("elastomer_fit",))
    (
        sheet.texts("specimen", "elastomer_specimen")
        .texts("law", "elastomer_law")
        .texts("parameters", ["; ".join(_parameters(view, k + 1)) for k in range(sheet.n_rows)])
        .spans("fitted range", "elastomer_strain_low", "elastomer_strain_high", PERCENT, places=1)
        .numbers("rms residual", "elastomer_rms_stress", digits=3)
        .numbers("corrected Akaike criterion", "elastomer_aicc")
        .texts("stable over the range", np.where(sheet.of("elastomer_is_stable") == 1, "yes", "no"))
    )
    return sheet.table(
        "Hyperelastic laws of the first loading; not valid outside the fitted range.",
        remarks=[
            plus_minus_of_tests(
                [NORMAL], [view], ["elastomer_modulus", "elastomer_exponent"],
                found_from="regression",
            )
        ],
    )  # fmt: skip


def _parameters(view: TestView, fit: int) -> Iterator[str]:
    sheet = Sheet(view, ("elastomer_parameter",))
    sheet.keep(sheet.of("elastomer_parameter_fit") == fit)
    sheet.measured("", "elastomer_modulus").measured("", "elastomer_exponent", Shown("", 1.0))
    unit = f" {shown('stress', view.units).unit}"
    for name, *both in zip(sheet.of("elastomer_parameter_name", ""), *sheet.columns, strict=True):
        for cell, one in zip(both, (unit, ""), strict=True):
            if cell.text != NOT_GIVEN:
                yield f"{str(name).replace('_', ' ')} {cell.text}{one}"


def _flag_table(view: TestView) -> PageTable | None:
    """Return how many samples of each channel carry each flag; only flags that occur."""
    counts = view.array("n_flagged")
    if counts is None or not counts.any():
        return None
    sheet = Sheet(view, ("channel",)).texts("channel", "channel")
    for name, column in zip(view.texts("quality_mask"), counts.T, strict=True):
        if column.any():
            sheet.counts(name.replace("_", " "), column)
    return sheet.table(
        f"Samples flagged, of {view.scalar('n_rows_kept'):,.0f} kept and"
        f" {view.scalar('n_rows_read'):,.0f} read; nothing is deleted."
    )


def _step_table(view: TestView) -> PageTable | None:
    """Return the readings of a stepwise test."""
    if not view.is_stepwise or "strain" not in view.data:
        return None
    sheet = Sheet(view, ("step",))
    clock = zip(sheet.of("clock", ""), sheet.of("time"), strict=True)
    (
        sheet.texts("clock", [text or f"{time:g} s" for text, time in clock])
        .numbers("tension", "tension")
        .numbers("length between the marks", "gauge_length")
        .numbers("eye to eye", "eye_to_eye_length")
        .numbers("elongation as recorded", "printed_strain", PERCENT)
        .numbers("strain", "strain", PERCENT)
        .numbers("secant modulus", "secant_modulus")
        .texts("branch", _branches(sheet.of("branch")))
        .texts("flag", flagged_steps(view))
    )
    return sheet.table("Readings of the stepwise test.")


def interval_table(view: TestView) -> PageTable | None:
    """Return the moduli between the readings of a stepwise test."""
    sheet = Sheet(view, ("interval",))
    clock = view.texts("clock") or tuple(str(place + 1) for place in range(sheet.n_rows + 1))
    (
        sheet.texts("between", [f"{one} to {other}" for one, other in pairwise(clock)])
        .texts("branch", _branches(sheet.of("interval_branch")))
        .numbers("strain in the middle", "interval_strain", PERCENT)
        .measured("interval modulus", "interval_modulus")
    )
    return sheet.table(
        "Slope of stress on strain between two readings; not given where a reading is flagged or"
        " loading reverses.",
        remarks=[sheet.about(found_from=OF_STEPS)],
    )


def _branches(values: Floats) -> list[str]:
    names = {value: name for name, value in BRANCH_VALUES.items()}
    return [names.get(int(value), "") for value in values]


def _hold_table(view: TestView) -> PageTable | None:
    """Return the holds; a column without values is left out."""
    sheet = Sheet(view, ("hold",))
    sheet.texts("hold", "hold_number").texts("specimen", "hold_specimen").texts("kind", "hold_kind")
    sheet.shown("holds")
    return sheet.table(
        "Holds: relaxation at constant length, creep at constant tension.", tall=12,
        optional=sheet.headings, remarks=[sheet.about(found_from=_OF_HOLDS)],
    )  # fmt: skip


def _of_holds(view: TestView, name: str) -> list[str]:
    """Return the texts of the holds that have one, each with its hold and specimen."""
    sheet = Sheet(view, ("hold",))
    columns = (sheet.of(one, "") for one in ("hold_number", "hold_specimen", name))
    return [
        f"hold {number}, {owner}: {text}"
        for number, owner, text in zip(*columns, strict=True)
        if text
    ]


def _prony_table(view: TestView) -> PageTable | None:
    """Return the Prony series of the holds that support one."""
    sheet = Sheet(view, ("hold", "prony_term"), where="prony_tension")
    (
        sheet.texts("hold", "hold_number")
        .texts("specimen", "hold_specimen")
        .counts("term", sheet.places["prony_term"] + 1)
        .measured("tension of the term", "prony_tension")
        .measured("relaxation time", "prony_time")
        .measured("long-time tension", "long_time_tension")
    )
    return sheet.table(
        "Prony series of the holds.",
        remarks=[
            *(f"Number of terms, {text}." for text in _of_holds(view, "hold_criterion")),
            sheet.about(found_from=_OF_HOLDS),
        ],
    )


def _pull_table(view: TestView) -> PageTable | None:
    """Return the cubic of each slow pull, its range of use, and how it was made."""
    if "pull_strain_coefficient" not in view.data:
        return None
    sheet = Sheet(view, ("specimen",)).at("pull_term", 0)
    sheet.keep(np.isfinite(sheet.of("pull_strain_coefficient")))
    force = shown("tension", view.units)
    for power, term in enumerate(("1", "T", "T²", "T³")):
        sheet.at("pull_term", power)
        both = sheet.of("pull_strain_coefficient"), sheet.expanded("pull_strain_coefficient").half
        per = "1" if power == 0 else superscript(f"{force.unit}-{power}")
        scale = 1.0 / force.factor**power
        sheet.cells(
            f"strain, coefficient of {term} [{per}]",
            [_scaled(*one, scale) for one in zip(*both, strict=True)],
        )
    (
        sheet.spans("range of use", "pull_tension_low", "pull_tension_high")
        .numbers("residual of the cubic", "pull_residual", PERCENT)
        .numbers("rate of strain", "pull_strain_rate", Shown("%/min", 6000.0))
        .numbers("waiting time before the pull", "pull_waiting_time", Shown("h", 1 / 3600.0))
        .numbers("tension at the length reading", "pull_reference_tension")
    )
    return sheet.turned(
        "Slow pull: strain as a cubic of tension T, and the conditions it holds for.",
        map(str, sheet.of("specimen")),
        remarks=["K_0 and strain at a tension come from a spline through the readings, not this"
                 " cubic; K_0 grows with the rate of strain and with the waiting time.",
                 plus_minus_of_tests([NORMAL], [view], ["pull_strain_coefficient"],
                                     found_from=_OF_PULL)],
    )  # fmt: skip


def _scaled(value: float, half: float, scale: float) -> TableCell:
    text = f"{value * scale:.6g}" + (f" ± {half * scale:.2g}" if np.isfinite(half) else "")
    return TableCell(text, repr(float(value)), is_number=True)


def _pull_share_table(view: TestView) -> PageTable | None:
    """Return strain and K_0 of the slow pull at round shares of the break strength."""
    strain = view.array("strain_at_break_share")
    if strain is None:
        return None
    sheet = Sheet(view, ("break_share",)).keep(np.flatnonzero(np.isfinite(strain).any(axis=0)))
    sheet.texts("tension [%RBS]", [f"{100 * share:g}" for share in sheet.of("break_share")])
    for place, name in enumerate(view.specimens):
        sheet.at("specimen", place).measured(name, "strain_at_break_share", PERCENT)
    return sheet.table(
        "Strain of the slow pull at round shares of the rated break strength, within its range.",
        remarks=[sheet.about(found_from=_OF_PULL)],
    )


def _line_table(view: TestView) -> PageTable | None:
    """Return the parameters of the line of each specimen of a test."""
    if "test_relaxation_time" not in view.data:
        return None
    sheet = add_line(Sheet(view, ("specimen",)).texts("specimen", "specimen"), view)
    return sheet.table(
        "The three-parameter line: spring K_0 in parallel with spring K_1 and dashpot in series.",
        optional=(REFUSED,), remarks=[CONDITIONING, *about_line(sheet, [view])],
    )  # fmt: skip


def add_line(sheet: Sheet, view: TestView) -> Sheet:
    """Add the line parameters of the specimens in the rows; those by Monte Carlo as intervals."""
    for line in ON_PAGE["line"]:
        name = line.name
        sheet.measured(line.page[1], name)
        unit, values = sheet.unit_of(name) or Shown("1", 1.0), sheet.of(name)
        for row, place in enumerate(sheet.places["specimen"]):
            drawn = drawn_interval(view, name, int(place))
            if drawn is not None:
                sheet.columns[-1][row] = within(float(values[row]), *drawn, unit)
    reasons = (REASONS.get(int(code), "") for code in sheet.of("test_line_refusal", 0))
    return sheet.numbers("conditioning", "test_line_conditioning", digits=3).texts(REFUSED, reasons)


def about_line(sheet: Sheet, tests: Sequence[TestView]) -> list[str]:
    """Describe what ± and brackets include in a table of lines."""
    names = [row.name for row in ON_PAGE["line"]]
    has_fit = "quasi_static_fit" in shared_sources(tests, names)
    said = plus_minus_of_tests(
        sheet.factors, tests, names, found_from="scatter between cycles" if has_fit else _OF_LINE
    )
    is_drawn = any(
        drawn_interval(test, name, place) is not None
        for test in tests
        for name in names
        for place in range(len(test.specimens))
    )
    return [said, *([DRAWN] if is_drawn else [])]


MOST = 4000

"""Greatest number of selectable cycles of a test; a page has to stay small."""

_DIGITS = 9


@dataclass(frozen=True)
class _CycleLinks:
    """Selectable cycles of a test: their numbers, start and end times."""

    count: int
    number: Floats
    start: Floats
    end: Floats

    def json(self) -> str:
        """JSON for a script element; numbers are left out where all cycles are listed."""
        document: dict[str, object] = {
            "count": self.count,
            "start": plain_numbers(self.start, _DIGITS),
            "end": plain_numbers(self.end, _DIGITS),
        }
        if self.number.size < self.count:
            document["number"] = [int(one) for one in self.number]
        return script_json(document)


def _cycle_links(view: TestView) -> _CycleLinks | None:
    """Return the selectable cycles of a test; None with fewer than two.

    Examples
    --------
    >>> import xarray as xr
    >>> data = xr.Dataset(
    ...     {
    ...         "cycle_start_time": ("cycle", [10.0, 12.0]),
    ...         "frequency": ("cycle", [0.5, 0.4]),
    ...     },
    ...     coords={"cycle": [1, 2]},
    ... )
    >>> _cycle_links(TestView("test-0", data)).json()
    '{"count":2,"start":[10.0,12.0],"end":[12.0,14.5]}'
    """
    cycle, start = view.array("cycle"), view.array("cycle_start_time")
    if cycle is None or start is None or cycle.size < 2:
        return None
    end = start + 1.0 / view.array_like("frequency", start)
    places = _listed(view, cycle)
    # one clock for all specimens, but after an early break later cycles of that one are unknown
    start, end = (
        _first_known(values.reshape(-1, cycle.size)[:, places]) for values in (start, end)
    )
    return _CycleLinks(cycle.size, cycle[places], start, end)


def _listed(view: TestView, cycle: Floats) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the places of the cycles to list, rising."""
    if cycle.size <= MOST:
        return np.arange(cycle.size)
    drawn = view.array_like("selected_cycle", np.zeros(0))
    loops = view.stored_near(np.array([1.0, (cycle.size + 1) // 2, cycle.size]))
    wanted = np.searchsorted(cycle, np.concatenate([drawn[np.isfinite(drawn)], loops]))
    even = np.linspace(0, cycle.size - 1, MOST).round().astype(np.intp)
    return np.unique(np.concatenate([even, np.minimum(wanted, cycle.size - 1)]))


def _first_known(values: Floats) -> Floats:
    """Return the first finite value of each column; NaN where there is none."""
    row = np.argmax(np.isfinite(values), axis=0)
    return np.asarray(values[row, np.arange(values.shape[1])])


_BUDGETS = "Where the uncertainty comes from"

_LINES = ("raw_file", "raw_file_sha256", "raw_file_bytes")

_LONG = ("settings", "raw_metadata", "history")


@dataclass(frozen=True)
class Part:
    """One heading with sentences, figures and tables under it; folded content opens by a click."""

    heading: str
    figures: tuple[Figure, ...] = ()
    tables: tuple[PageTable, ...] = ()
    sentences: tuple[str, ...] = ()
    refusals: tuple[str, ...] = ()
    folded: Part | None = None
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class TestSection:
    """One test, or another subject named by ``noun``: its parts, notes and sources.

    ``subtitle`` is what is visible while a section is folded; ``cycles`` are those that a reader
    can choose in its figures.
    """

    key: str
    title: str
    subtitle: str
    parts: tuple[Part, ...]
    notes: tuple[tuple[str, list[str]], ...]
    provenance: tuple[tuple[str, str], ...]
    documents: tuple[tuple[str, str], ...] = field(default=())
    noun: str = "test"
    cycles: _CycleLinks | None = None


def make_part(
    heading: str,
    figures: Sequence[Figure] = (),
    tables: Sequence[PageTable | None] = (),
    sentences: Sequence[str] = (),
    refusals: Sequence[str] = (),
    folded: Part | None = None,
    warnings: Sequence[str] = (),
) -> Part:
    """Return a part; tables that do not exist for a test are left out."""
    given = tuple(table for table in tables if table is not None)
    return Part(
        heading, tuple(figures), given, tuple(sentences), tuple(refusals), folded, tuple(warnings)
    )


def make_section(view: TestView) -> TestSection:
    """Return the section of one test; empty parts are left out."""
    parts = [
        make_part("Stepwise readings", draw_steps(view), [_step_table(view), interval_table(view)]),
        make_part("Slow pull", draw_pull(view), [_pull_table(view), _pull_share_table(view)]),
        make_part("Modulus against strain", draw_moduli(view), [segment_table([view])]),
        make_part(
            "Record",
            [*draw_record(view), *draw_tension_position(view)],
            [_flag_table(view)],
        ),
        make_part("Loops", draw_loops(view)),
        make_part(
            "Cycle by cycle", [*draw_trends(view), *draw_cycle_curves(view)],
            [_summary_table(view), _slip_table(view), _identity_table(view)],
        ),
        make_part("Three-parameter line", (), [_line_table(view)]),
        _budget_part(view),
        make_part(
            "Holds", draw_holds(view), [_hold_table(view), _prony_table(view)],
            refusals=_of_holds(view, "hold_refusal"),
        ),
        make_part(
            "Strain and splices" if view.is_rubber else "Strain", draw_splices(view),
            [_coefficient_table(view), _mark_table(view)], _slope_sentences(view),
        ),
        make_part(
            "First loading", draw_mooney(view), [_stress_table(view), _elastomer_table(view)],
        ),
        make_part("History of the specimens", (), [_history_table(view)]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.data.attrs)
    return TestSection(
        key=view.key,
        title=view.id,
        subtitle="; ".join(
            part
            for part in (view.kind, f"specimens: {', '.join(view.specimens)}", brief(view))
            if part
        ),
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=tuple(grouped_notes(view)),
        provenance=provenance,
        documents=documents,
        cycles=_cycle_links(view),
    )


def _budget_part(view: TestView) -> Part:
    """Sources of the uncertainty of the answers; the values behind the bars are folded."""
    answers = answer_budgets(view)
    if not answers:
        return make_part(_BUDGETS)
    return make_part(
        _BUDGETS, draw_budgets(view, answers), (), budget_sentences(view, answers),
        folded=make_part("The same in numbers", (), [budget_table(answers)]),
    )  # fmt: skip


def provenance_of(
    attributes: Mapping[Any, Any],
) -> tuple[tuple[tuple[str, str], ...], tuple[tuple[str, str], ...]]:
    """Return the lines on the sources of the numbers, and the long documents."""
    given = {str(name): str(value) for name, value in attributes.items()}
    known = {*_LINES, *_LONG, "test", "title", "id"}
    lines = [(name, given.get(name, "")) for name in _LINES]
    lines += [
        (name, " ".join(text.splitlines())) for name, text in given.items() if name not in known
    ]
    documents = [(name, _readable(given.get(name, ""))) for name in _LONG]
    return (
        tuple((name, text) for name, text in lines if text),
        tuple((name, text) for name, text in documents if text),
    )


def _readable(text: str) -> str:
    """Return JSON with line breaks; other text unchanged."""
    try:
        return json.dumps(json.loads(text), indent=1, ensure_ascii=False)
    except json.JSONDecodeError:
        return text

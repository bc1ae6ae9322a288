"""Tables of the answers: design moduli, budgets, conformity."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np

from reduction.archive.report_details import ReportDetails, ReportLimit
from reduction.archive.uncertainty_budget import (
    all_budgets,
    break_in_cycles,
    budget_from_archive,
    cycles_averaged,
    place_name,
)
from reduction.quantities.names import BRANCH_NAMES, quantity
from reduction.quantities.units import UnitSystem, display_unit
from reduction.record.errors import ReductionError
from reduction.record.measurement import Floats
from reduction.record.notes import Note
from reduction.report.test_view import (
    DRAWN,
    TestView,
    all_specimens,
    drawn_interval,
    expanded_of,
    factor_words,
    instrument_sentences,
    plus_minus_of_tests,
)
from reduction.report.text_style import (
    NOT_GIVEN,
    Kind,
    PageTable,
    Shown,
    TableCell,
    factors_of,
    in_order,
    make_table,
    measured,
    number,
    number_text,
    percent_cell,
    shown,
    source_meanings,
    source_words,
    span,
    superscript,
    within,
    words,
)
from reduction.stages.moduli.local_regression import curve_at
from reduction.stages.moduli.secant_modulus import late_change
from reduction.uncertainty.budget import Budget, DecisionRule, conformity

_ANSWERS: tuple[tuple[str, str, Kind], ...] = (
    ("segment_modulus", "", "stress"),
    ("test_apparent_spring_constant", "K_ap", "tension"),
    ("test_hysteresis_energy", "H", "energy"),
    ("test_dissipation_spring_constant", "K_1", "tension"),
    ("test_relaxation_time", "tau", "time"),
    ("interval_modulus", "", "stress"),
)

_NAMES = " K_ap: apparent spring constant, the EA of the design table. H: hysteresis energy."

_LINE_NAMES = " K_1, tau: dissipation spring constant and relaxation time of the line."

_SMALL = 0.005


@dataclass(frozen=True)
class AnswerBudget:
    """One answer of a test: name, specimen, unit, and budget.

    ``drawn`` is its interval where found by Monte Carlo; the shares are of first order.
    """

    words: str
    specimen: str
    unit: Shown
    budget: Budget
    drawn: tuple[float, float] | None = None

    @staticmethod
    def sources_of(answers: Sequence[AnswerBudget]) -> list[str]:
        """Every source that contributes to any of the answers, in fixed order."""
        return in_order({row.source for one in answers for row in one.budget.rows if row.share > 0})

    @property
    def cell(self) -> TableCell:
        """Value and expanded uncertainty, without the unit."""
        one = self.budget
        if self.drawn is not None:
            return within(one.value, *self.drawn, self.unit)
        return measured(one.value, one.expanded_uncertainty, self.unit, factor=one.coverage_factor)

    @property
    def text(self) -> str:
        """Value, expanded uncertainty and unit; a plain number has none."""
        unit = "" if self.unit.unit == "1" else f" {self.unit.unit}"
        return f"{self.cell.text}{unit}"

    def share(self, source: str) -> float:
        """Share of a source in the variance, over all errors of the source. [1]."""
        return float(sum(row.share for row in self.budget.rows if row.source == source))

    def in_words(self) -> str:
        """Sources with their shares, largest first; those below half a percent are left out."""
        shares = {name: self.share(name) for name in self.sources_of([self])}
        ordered = sorted(shares, key=lambda name: -shares[name])
        return ", ".join(
            f"{source_words(name)} {100 * shares[name]:.0f} %"
            for name in ordered
            if shares[name] >= _SMALL
        )


def answer_budgets(view: TestView) -> list[AnswerBudget]:
    """Return the budgets of a test's answers: segments, K_ap, H, K_1, tau, slopes of weights."""
    names = view.data["specimen"].values if "specimen" in view.data else ()
    places = {str(name): place for place, name in enumerate(names)}
    found = []
    for name, text, kind in _ANSWERS:
        for one in all_budgets(view.data, name):
            if not (np.isfinite(one.standard_uncertainty) and one.standard_uncertainty > 0):
                continue
            # a test with weights has one specimen
            place = places[one.place["specimen"]] if "specimen" in one.place else 0
            found.append(
                AnswerBudget(
                    text or _words_of(view, one),
                    view.specimens[place],
                    shown(kind, view.units),
                    one,
                    drawn_interval(view, name, place),
                )
            )
    return found


def _words_of(view: TestView, one: Budget) -> str:
    """Number of the segment, or the readings at its ends."""
    if "segment" in one.place:
        return f"segment {one.place['segment']}, {one.place['branch_name']}"
    after = int(one.place["interval"])
    clock = view.texts("clock")
    return f"{clock[after - 1]} to {clock[after]}" if all(clock) else f"interval {after}"


def budget_table(answers: Sequence[AnswerBudget]) -> PageTable | None:
    """Return the values behind the bars: value, uncertainty, factor, and share of each source."""
    if not answers:
        return None
    sources = AnswerBudget.sources_of(answers)
    rows = [
        [
            words(f"{one.words}, {one.specimen}"),
            one.cell,
            words(one.unit.unit),
            number(float("nan") if one.drawn else one.budget.coverage_factor, digits=3),
            *(percent_cell(one.share(source)) for source in sources),
        ]
        for one in answers
    ]
    has_line = any(one.words == "tau" for one in answers)
    names = _NAMES if any(one.words in ("K_ap", "H") for one in answers) else ""
    factors = factor_words(k for one in answers for k in one.cell.factors)
    return make_table(
        "Share of each source in the variance of the answers.",
        ("number", "value", "unit", "k", *(f"{source_words(one)} [%]" for one in sources)),
        rows, is_compact=True,
        remarks=[
            f"±: expanded uncertainty, 95 % ({factors}).{names}{_LINE_NAMES if has_line else ''}",
            *([f"{DRAWN} Shares are of first order."] if any(one.drawn for one in answers) else []),
            source_meanings(sources),
        ],
    )  # fmt: skip


def budget_sentences(view: TestView, answers: Sequence[AnswerBudget]) -> list[str]:
    """Say where no instrument errors are stated, since a bar without them is incomplete."""
    return instrument_sentences([view]) if answers else []


_WHOLE, _OF_ROPE = "test_dynamic_modulus", "test_apparent_spring_constant"

_TANGENT = "tangent_modulus"

_MOST_ROWS = 24


def design_modulus_table(tests: Sequence[TestView]) -> PageTable | None:
    """Return the design moduli: EA and modulus of the whole cycle, and tangents at mid-strain."""
    order = all_specimens(tests)
    is_of_lines = bool(tests) and all(view.is_rope or view.is_hose for view in tests)
    by_test = [(view, list(_rows(view, is_of_lines=is_of_lines))) for view in tests]
    found = [row for _, rows in by_test for row in rows]
    found.sort(key=lambda row: order.index(row[0].text))
    if not found:
        return None
    units = tests[0].units
    force, of_branch = shown("tension", units), shown("tension" if is_of_lines else "stress", units)
    columns = [
        "specimen", "test", shown("strain", units).label("strain"), "frequency [Hz]",
        force.label("EA"), "EA/MBL", *([] if is_of_lines else [of_branch.label("whole cycle")]),
        of_branch.label("ascending"), of_branch.label("descending"), "cycles used", "status",
    ]  # fmt: skip
    columns, found = _without_empty(columns, found, ["EA/MBL"])
    tangents = "EA of the tangent" if is_of_lines else "tangent modulus"
    whole = (
        ""
        if is_of_lines
        else " Whole cycle: dynamic modulus, stress amplitude over strain amplitude."
    )
    return make_table(
        f"Design {'stiffness' if is_of_lines else 'moduli'}. EA: tension amplitude over strain"
        f" amplitude, the apparent spring constant K_ap.{whole} Ascending, descending: {tangents}"
        " at mid-strain. Means over the cycles.",
        columns, found, is_compact=True,
        is_tall=len(found) > _MOST_ROWS,
        remarks=[
            plus_minus_of_tests(
                factors_of(found), [view for view, rows in by_test if rows],
                [_OF_ROPE, *([] if is_of_lines else [_WHOLE]), _TANGENT],
            ),
            "Cycles used: how many (after a semicolon for the tangents, if different) and, in"
            " brackets, which. Settled: mean EA of the last half of them is inside the interval."
            f" {NOT_GIVEN}: no trustworthy value on that branch; the section of the test says why."
            " A modulus holds for the strain range of its test; another amplitude or mean gives"
            " another modulus. Status 'check': a problem could shift a result by more than its"
            " interval.",
        ],
    )  # fmt: skip


def pull_table(tests: Sequence[TestView]) -> PageTable | None:
    """Return strain and load reached in pulls, breaks and by weights, and the stiffness.

    None where no test is of this kind.
    """
    own = [view for view in tests if view.kind in _PULLS]
    is_of_lines = bool(own) and all(view.is_rope or view.is_hose for view in own)
    found = [row for view in own for row in _pull_rows(view, is_of_lines=is_of_lines)]
    if not found:
        return None
    has_cubic = any(view.is_rope and _PULLED in view.data for view in own)
    force, stress = (shown(kind, own[0].units) for kind in ("tension", "stress"))
    columns = [
        "specimen", "test", "ends at", shown("strain", own[0].units).label("strain"),
        force.label("load"), force.label("EA at half that strain"),
        *([] if is_of_lines else [stress.label("modulus there")]), "status",
    ]  # fmt: skip
    return make_table(
        "Pulls and weights. Strain: where the load is greatest. EA: slope of load against strain on"
        " the first loading, at half that strain, or in the middle of a pull that begins above it.",
        columns, found, is_compact=True, is_tall=len(found) > _MOST_ROWS,
        remarks=[
            *_about_spread(
                found, own, [_FIRST_RISE, _PULLED, "pull_peak_tension", "interval_modulus"]
            ),
            *(["EA of a slow pull of a rope: K_0 at half the strain."] if has_cubic else []),
            *_sets_of_breaks(own),
        ],
    )  # fmt: skip


_KIND_OF_ROPE = ("kind", "material", "construction", "condition")


def _sets_of_breaks(tests: Sequence[TestView]) -> list[str]:
    """Summarise the breaks of specimens of one kind, where there are several."""
    force = shown("tension", tests[0].units)
    sets: dict[tuple[str, ...], list[tuple[str, float]]] = {}
    for view in tests:
        strength, broke = view.array("tensile_strength"), view.array("pull_is_break")
        if strength is None or broke is None:
            continue
        words_of = [view.texts(f"specimen_{one}") for one in _KIND_OF_ROPE]
        across = view.array_like("diameter", strength)
        for place in np.flatnonzero((broke == 1) & np.isfinite(strength)):
            key = (*(own[place] if own else "" for own in words_of), f"{across[place]:.3g}")
            sets.setdefault(key, []).append((view.specimens[place], float(strength[place])))
    found = []
    for key, breaks in sets.items():
        loads = np.array([load for _, load in breaks])
        if loads.size < 2:
            continue
        mean, deviation = float(loads.mean()), float(loads.std(ddof=1))
        of = ", ".join(one for one in key[:-1] if one)
        texts = [number(one, force).text for one in (mean, deviation, float(loads.min()))]
        found.append(
            f"Breaks of {loads.size} specimens ({of}): mean {texts[0]} {force.unit}, standard"
            f" deviation {texts[1]} {force.unit} ({100 * (deviation / mean):.1f} %), least"
            f" {texts[2]} {force.unit}. Breaks in a splice or grip are included; a table of"
            " outcomes separates them."
        )
    return found


_PULLS = ("tensile", "quasi-static", "stepwise")

_FIRST_RISE, _PULLED = "tangent_modulus_first_loading", "quasi_static_spring_constant"


def _pull_rows(view: TestView, *, is_of_lines: bool) -> Iterator[list[TableCell]]:
    force, stress = (shown(kind, view.units) for kind in ("tension", "stress"))
    strain_unit = shown("strain", view.units)
    areas, broke = view.array("area"), view.array("pull_is_break")
    for place, name in enumerate(view.specimens):
        curve = _rise(view, place)
        is_break = broke is not None and broke[place] == 1
        known = [_pull_peak(view, peak, place) for peak in ("strain", "tension")]
        if curve is None and not all(known):  # a break also has no curve before it
            continue
        ends = [TableCell(NOT_GIVEN, is_number=True)] * 2
        line = material = ends[0]
        if curve is not None:
            strain, load, stiffness, is_modulus = curve
            at_end = int(np.nanargmax(load.values))
            reached = known[0].values[0] if known[0] else strain[at_end]
            if known[1] is None:  # else the strain at that load is unknown where it is not given
                ends = [_Series.known(strain).cell(at_end, strain_unit), load.cell(at_end, force)]
            usable = np.flatnonzero(np.isfinite(stiffness.values))
            if usable.size:
                half_way = reached / 2
                if strain[usable[0]] > half_way:  # the pull begins under load
                    half_way = (strain[usable[0]] + reached) / 2
                there = stiffness.between(strain, half_way)
                area = float("nan") if areas is None else float(np.ravel(areas)[place])
                line = there.cell(0, force, area if is_modulus else 1.0)
                material = there.cell(0, stress, 1.0 if is_modulus else 1.0 / area)
        ends = [
            cell if own is None else own.cell(0, unit)
            for own, cell, unit in zip(known, ends, (strain_unit, force), strict=True)
        ]
        yield [
            words(name), words(f"{view.id} (earlier run)" if view.is_of_earlier_run else view.id),
            words("break" if is_break else "peak load"), *ends, line,
            *([] if is_of_lines else [material]), _status(view, name),
        ]  # fmt: skip


def _pull_peak(view: TestView, of: str, place: int) -> _Series | None:
    """Return the strain or tension at the end of a pull; None where it is not known."""
    values = view.array(f"pull_peak_{of}")
    if values is None or not np.isfinite(values[place]):
        return None
    half = expanded_of(view, f"pull_peak_{of}", values)
    return _Series(
        values[place : place + 1], *(one[place : place + 1] for one in (half.half, half.factor))
    )


@dataclass(frozen=True)
class _Series:
    """Values along a first loading with their half-widths and coverage factors."""

    values: Floats
    half: Floats
    factor: Floats

    @classmethod
    def known(cls, values: Floats) -> _Series:
        """Values without an uncertainty."""
        unknown = np.full(values.shape, np.nan)
        return cls(values, unknown, unknown)

    def between(self, places: Floats, where: float) -> _Series:
        """One value, from those on both sides of it: on a grid the nearest one is off by a step."""
        known = np.isfinite(self.values)
        parts = (self.values, self.half, self.factor)
        return _Series(*(np.interp([where], places[known], one[known]) for one in parts))

    def cell(self, place: int, unit: Shown, times: float = 1.0) -> TableCell:
        """One value, multiplied by a number."""
        value, half = times * self.values[place], times * self.half[place]
        return measured(value, half, unit, factor=float(self.factor[place]))


def _rise(view: TestView, place: int) -> tuple[Floats, _Series, _Series, bool] | None:
    """Return strains of a first loading, loads, stiffness, and whether that is a modulus."""

    def series(name: str, *own: int) -> _Series | None:
        values = view.array(name)
        if values is None:
            return None
        spread = expanded_of(view, name, values)
        return _Series(values[own], spread.half[own], spread.factor[own])

    pulled, strain = series(_PULLED, place), series("quasi_static_strain", place)
    cubic = None
    if pulled is not None and strain is not None and np.isfinite(pulled.values).any():
        load = _Series.known(np.asarray(view.array("tension_grid")))
        cubic = strain.values, load, _at_one_strain(view, place, pulled, load.values), False
        if view.is_rope:
            return cubic
    weights, middles = series("interval_modulus"), view.array("interval_strain")
    if weights is not None and middles is not None:
        rising = view.array_like("interval_branch", middles) == 1
        strains, loads, secants = (
            view.array_like(key, np.zeros(0)) for key in ("strain", "tension", "secant_modulus")
        )
        # a reading without a secant is contradicted by others
        is_sound = np.isfinite(secants) if np.isfinite(secants).any() else np.isfinite(loads)
        top = np.argmax(np.where(is_sound, loads, -np.inf))
        at = np.append(middles[rising], strains[top])
        hung = np.append(np.full(at.size - 1, np.nan), loads[top])
        slope = (
            np.append(np.asarray(one)[rising], np.nan)
            for one in (weights.values, weights.half, weights.factor)
        )
        return at, _Series.known(hung), _Series(*slope), True
    branch = (view.texts("branch_name") or BRANCH_NAMES).index(BRANCH_NAMES[0])
    tangent = series(_FIRST_RISE, place, branch)
    tension = series("branch_tension_first_loading", place, branch)
    bins = view.array("first_loading_strain_bin")
    if tangent is not None and tension is not None and np.isfinite(tension.values).any():
        return np.asarray(bins), tension, tangent, True
    return cubic


def _at_one_strain(view: TestView, place: int, pulled: _Series, load: Floats) -> _Series:
    r"""K_0 of a pull, known at tensions, with its uncertainty at strains.

    .. math:: \delta K|_\varepsilon = \delta K|_T - K \frac{dK}{dT} \, \delta\varepsilon|_T

    The gain of a load cell changes the tension at one strain by all of itself, and K_0 at one
    tension by less where the curve stiffens.
    """
    slope_rows, strain_rows, slope_alone, strain_alone = (
        view.array(f"{name}_{part}")
        for part in ("uncertainty_contribution", "random_standard_uncertainty")
        for name in (_PULLED, "quasi_static_strain")
    )
    if (
        slope_rows is None or strain_rows is None or slope_alone is None or strain_alone is None
        or np.isfinite(pulled.values).sum() < _SLOPE
    ):  # fmt: skip
        return pulled
    known = np.isfinite(pulled.values)
    turn = np.full(load.size, np.nan)
    turn[known] = pulled.values[known] * np.gradient(pulled.values[known], load[known])
    shared = np.nan_to_num(slope_rows[:, place]) - turn * np.nan_to_num(strain_rows[:, place])
    alone = np.hypot(slope_alone[place], turn * strain_alone[place])
    spread = np.hypot(np.linalg.norm(shared, axis=0), alone)
    return _Series(pulled.values, pulled.factor * spread, pulled.factor)


_SLOPE = 3  # values from which a slope follows


def hold_table(tests: Sequence[TestView]) -> PageTable | None:
    """Return the longest hold of each specimen in tests of relaxation or creep; None without."""
    own = [view for view in tests if view.kind in ("relaxation", "creep")]
    found = [row for view in own for row in _hold_rows(view)]
    if not found:
        return None
    units = own[0].units
    rates = ["tension per decade [%]", "strain per decade [%]"]
    columns = [
        "specimen", "test", shown("strain", units).label("strain"),
        shown("tension", units).label("tension at the start"), "held for [h]",
        "drop of tension [%]", *rates, "status",
    ]  # fmt: skip
    columns, found = _without_empty(columns, found, rates)
    return make_table(
        "Relaxation and creep: the longest hold of each test.",
        columns, found, is_compact=True, is_tall=len(found) > _MOST_ROWS,
        remarks=_about_spread(found, own, _OF_HOLD),
    )  # fmt: skip


def _about_spread(
    rows: Sequence[Sequence[TableCell]], tests: Sequence[TestView], names: Sequence[str]
) -> list[str]:
    """Describe what ± includes, if any value has one."""
    factors = factors_of(rows)
    return [plus_minus_of_tests(factors, tests, names)] if factors else []


_OF_HOLD = (
    "hold_strain", "hold_initial_tension", "relaxation_drop", "relaxation_rate_per_decade",
    "creep_rate_per_decade",
)  # fmt: skip


def _longest_holds(view: TestView) -> Iterator[tuple[str, int]]:
    """Yield each specimen with the place of its longest hold."""
    lasted, names = view.array("hold_duration"), view.texts("hold_specimen")
    if lasted is None:
        return
    for name in view.specimens:
        own = [place for place, one in enumerate(names) if one == name]
        if own:
            yield name, max(own, key=lambda one: float(lasted[one]))


def lacking_answer(view: TestView) -> str:
    """Why a pull has no strain, or the longest hold no answer; empty where they are given."""
    if view.kind in _PULLS:
        return "; ".join(str(one) for one in view.notes if one.code == "no-strain-at-failure")
    key = {"relaxation": "relaxation_drop", "creep": "creep_rate_per_decade"}.get(view.kind)
    found, reasons = view.array(key) if key else None, view.texts("hold_refusal")
    if found is None or not reasons:
        return ""
    own = [(name, place) for name, place in _longest_holds(view) if reasons[place]]
    return "; ".join(f"{name}: {reasons[at]}" for name, at in own if np.isnan(found[at]))


def _hold_rows(view: TestView) -> Iterator[list[TableCell]]:
    lasted = view.array("hold_duration")
    if lasted is None:
        return
    strain, force = shown("strain", view.units), shown("tension", view.units)
    for name, place in _longest_holds(view):
        cells = []
        for key, unit in zip(_OF_HOLD, (strain, force, strain, strain, strain), strict=True):
            values = view.array_like(key, lasted)
            spread = expanded_of(view, key, values)
            cells.append(
                measured(values[place], spread.half[place], unit, factor=spread.factor[place])
            )
        yield [
            words(name), words(f"{view.id} (earlier run)" if view.is_of_earlier_run else view.id),
            *cells[:2], number(float(lasted[place]) / 3600.0, digits=3), *cells[2:],
            _status(view, name),
        ]  # fmt: skip


def _without_empty(
    columns: list[str], rows: list[list[TableCell]], names: Collection[str]
) -> tuple[list[str], list[list[TableCell]]]:
    """Leave out those of some columns that have no value in any row."""
    kept = [
        place
        for place, name in enumerate(columns)
        if name not in names or any(row[place].text != NOT_GIVEN for row in rows)
    ]
    return [columns[place] for place in kept], [[row[place] for place in kept] for row in rows]


_SAME_STRAINS = 0.8
"""Common strains of two tests over all strains of either, from which on ranges are the same."""

_UNLIKE = 1.25
"""Ratio of two values of EA that is unexpected over the same strains."""

_LIKE_CONDITIONS = 1.15
"""Amplitudes or frequencies within this ratio do not explain such a difference."""


def unlike_tests_table(tests: Sequence[TestView]) -> PageTable | None:
    """Return pairs of tests of one specimen that differ over the same strains; None without any.

    For each pair the differences found in the log are given: amplitude, frequency, environment, and
    the history of the specimen in between.  Parts of a test that is compared as a whole are left
    out.
    """
    by_specimen: dict[str, list[_Level]] = {}
    for view in tests:
        if not (view.attribute("part_of") or view.is_of_earlier_run):
            for name, level in _levels(view):
                by_specimen.setdefault(name, []).append(level)
    rows = [
        _unlike_row(name, first, second)
        for name, own in by_specimen.items()
        for later, second in enumerate(own)
        for first in own[:later]
        if first.is_unlike(second)
    ]
    if not rows:
        return None
    units = tests[0].units
    force = shown("tension", units)
    return make_table(
        "Tests of one specimen over the same strains with different EA, and what differs between"
        " them.",
        ("specimen", "tests", shown("strain", units).label("strain"), force.label("EA, first"),
         force.label("EA, second"), "ratio", "what differs"),
        rows, is_compact=True, is_tall=len(rows) > _MOST_ROWS,
    )  # fmt: skip


@dataclass(frozen=True)
class _Level:
    """EA of a test with its half-width [N], and its range of strain [1]."""

    view: TestView
    place: int
    low: float
    high: float
    constant: float
    half_width: float

    def is_unlike(self, other: _Level) -> bool:
        """Return whether two tests over the same strains have values of EA far apart."""
        shared = min(self.high, other.high) - max(self.low, other.low)
        union = max(self.high, other.high) - min(self.low, other.low)
        ratio = other.constant / self.constant
        return (
            shared >= _SAME_STRAINS * union
            and not 1 / _UNLIKE < ratio < _UNLIKE
            and abs(other.constant - self.constant) > hypot(self.half_width, other.half_width)
        )

    def of(self, name: str) -> float:
        """A value of the test for this specimen; NaN where the archive has none."""
        found = self.view.array(name)
        if found is None:
            return float("nan")
        return float(np.broadcast_to(found, (len(self.view.specimens),))[self.place])


def _levels(view: TestView) -> Iterator[tuple[str, _Level]]:
    """Give each specimen of a test with its level."""
    middle, half = view.array("test_mean_strain"), view.array("test_strain_amplitude")
    constant = view.array(_OF_ROPE)
    if middle is None or half is None or constant is None:
        return
    spread = np.nan_to_num(expanded_of(view, _OF_ROPE, constant).half)
    low, high = middle - half, middle + half
    for place in np.flatnonzero(np.isfinite(constant)).tolist():
        values = (float(own[place]) for own in (low, high, constant, spread))
        yield view.specimens[place], _Level(view, place, *values)


def _unlike_row(name: str, first: _Level, second: _Level) -> list[TableCell]:
    force = shown("tension", first.view.units)
    low, high = max(first.low, second.low), min(first.high, second.high)
    return [
        words(name),
        words(f"{first.view.id}, {second.view.id}"),
        span(low, high, shown("strain", first.view.units), places=0),
        *(measured(one.constant, one.half_width, force) for one in (first, second)),
        number(second.constant / first.constant, digits=3),
        words("; ".join(_differences(first, second))),
    ]


def _differences(first: _Level, second: _Level) -> Iterator[str]:
    """Describe the differences between two tests, and what is equal."""
    ratios = {
        "strain amplitude": (second.high - second.low) / (first.high - first.low),
        "frequency": second.of("test_frequency") / first.of("test_frequency"),
    }
    for what, ratio in ratios.items():
        if not 1 / _LIKE_CONDITIONS < ratio < _LIKE_CONDITIONS and np.isfinite(ratio):
            yield f"{what} {ratio:.2f} times"
    for what in ("medium", "temperature"):
        before, after = first.view.attribute(what), second.view.attribute(what)
        if before and after and before != after:
            yield f"{what} {before}, then {after}"
    highest = np.nanmax([first.high, first.of("earlier_maximum_strain")])
    reached = second.of("earlier_maximum_strain")
    if reached > _LIKE_CONDITIONS * highest:
        yield (
            f"stretched to {100 * reached:.0f} % in between, at most {100 * highest:.0f} % before:"
            " softening by the larger stretch"
        )
    cycles = second.of("earlier_cycles") - first.of("earlier_cycles")
    if cycles > 0:
        yield f"{cycles:,.0f} cycles between their starts"
    alike = [
        what for what, ratio in ratios.items() if 1 / _LIKE_CONDITIONS < ratio < _LIKE_CONDITIONS
    ]
    if alike:
        yield f"{' and '.join(alike)} equal within {100 * (_LIKE_CONDITIONS - 1):.0f} %"


def _rows(view: TestView, *, is_of_lines: bool) -> Iterator[list[TableCell]]:
    constant, middle = view.array(_OF_ROPE), view.array("test_mean_strain")
    half_range = view.array("test_strain_amplitude")
    if constant is None or middle is None or half_range is None:
        return
    stress, force = shown("stress", view.units), shown("tension", view.units)
    whole = view.array_like(_WHOLE, constant)
    of_whole, of_constant = (
        expanded_of(view, name, values) for name, values in ((_WHOLE, whole), (_OF_ROPE, constant))
    )
    frequency = view.array_like("test_frequency", constant)
    strength = view.array_like("rated_break_strength", constant)
    averaged = np.broadcast_to(cycles_averaged(view.data, _OF_ROPE), constant.shape)
    for place in np.flatnonzero(np.isfinite(constant)).tolist():
        area = float(constant[place] / whole[place]) if is_of_lines else 1.0
        tangents, counts = _tangents(
            view, place, float(middle[place]), area, force if is_of_lines else stress
        )
        low, high = (float(middle[place] + side * half_range[place]) for side in (-1, 1))
        share = float(constant[place] / strength[place])
        yield [
            words(view.specimens[place]),
            words(f"{view.id} (earlier run)" if view.is_of_earlier_run else view.id),
            span(low, high, shown("strain", view.units), places=0),
            number(float(frequency[place]), digits=2),
            measured(
                constant[place], of_constant.half[place], force, factor=of_constant.factor[place]
            ),
            number(share, digits=3),
            *([] if is_of_lines else [
                measured(whole[place], of_whole.half[place], stress, factor=of_whole.factor[place])
            ]),
            *tangents,
            TableCell(
                _used(int(averaged[place]), counts)
                + _which(view, place, float(constant[place]), float(of_constant.half[place])),
                str(averaged[place]), is_number=True,
            ),
            _status(view, view.specimens[place]),
        ]  # fmt: skip


def _status(view: TestView, specimen: str) -> TableCell:
    """Return whether a warning concerns the specimen or the whole test."""
    others = [name for name in view.specimens if name != specimen]
    is_doubted = any(
        one.severity == "warning" and not any(_is_of(one, name) for name in others)
        for one in view.notes
    )
    return words("check" if is_doubted else "reduced")


def _is_of(note: Note, specimen: str) -> bool:
    """Return whether a note concerns one specimen: by its first words, or by its stage."""
    return str(note).startswith(f"{specimen}: ") or note.stage.endswith(f" {specimen}")


def _tangents(
    view: TestView, specimen: int, strain: float, area: float, unit: Shown
) -> tuple[list[TableCell], list[int]]:
    """Return the tangent of both branches at a strain, times an area, and its cycles."""
    bins, modulus = view.array("strain_bin"), view.array(_TANGENT)
    missing = TableCell(NOT_GIVEN, is_number=True)
    if bins is None or modulus is None or bins.size == 0:
        return [missing] * len(BRANCH_NAMES), []
    spacing = float(np.min(np.diff(bins))) if bins.size > 1 else 0.0
    spread = expanded_of(view, _TANGENT, modulus)
    counts = view.array_like(f"{_TANGENT}_count", modulus)
    branches = view.texts("branch_name") or BRANCH_NAMES
    nearest = int(np.argmin(np.abs(bins - strain)))
    cells: list[TableCell] = []
    used: list[int] = []
    for name in BRANCH_NAMES:
        own = (specimen, branches.index(name))

        def at_middle(curve: Floats, own: tuple[int, int] = own) -> float:
            return float(curve_at([strain], bins, curve[own], spacing=spacing)[0])

        value, half, factor = map(at_middle, (modulus, spread.half, spread.factor))
        cells.append(measured(area * value, area * half, unit, factor=factor))
        if np.isfinite(value) and np.isfinite(counts[own][nearest]):
            used.append(int(counts[own][nearest]))
    return cells, used


def _used(n_cycles: int, counts: Sequence[int]) -> str:
    """Return the number of cycles used in a row: one number where all are equal.

    Examples
    --------
    >>> _used(3000, [20, 19]), _used(10, [10, 10]), _used(10, [])
    ('3,000; 19 to 20', '10', '10')
    """
    ends = dict.fromkeys(f"{one:,}" for one in (min(counts), max(counts))) if counts else {}
    of_curve = " to ".join(ends)
    return "; ".join(dict.fromkeys(text for text in (f"{n_cycles:,}", of_curve) if text))


def _which(view: TestView, place: int, mean: float, half: float) -> str:
    """Return the cycles used in a row, and whether its stiffness had settled over them."""
    single = view.array("apparent_spring_constant")
    if single is None or single.ndim != 2:
        return ""
    begin = break_in_cycles(view.data)
    return _cycles_in_words(single[place, begin:], begin + 1, mean, half)


def _cycles_in_words(single: Floats, first: int, mean: float, half: float) -> str:
    """Return the numbers of cycles that have a value, and how the mean of the last half compares.

    Examples
    --------
    >>> falling = np.array([110.0, 104.0, 101.0, 100.0, 99.5, 99.3])
    >>> _cycles_in_words(falling, 1, 102.3, 0.5)
    ' (1 to 6; not settled, -2.6 %)'
    >>> _cycles_in_words(falling, 1, 102.3, 5.0), _cycles_in_words(falling[:1], 3, 110.0, 1.0)
    (' (1 to 6; settled)', ' (3)')
    """
    used = np.flatnonzero(np.isfinite(single))
    if not used.size:
        return ""
    numbers = f"{first + used[0]:,}"
    if used.size > 1:
        numbers += f" to {first + used[-1]:,}"
    off = late_change(single)
    if not (np.isfinite(off) and half > 0):
        return f" ({numbers})"
    settled = "settled" if abs(off) <= half else f"not settled, {100 * off / mean:+.1f} %"
    return f" ({numbers}; {settled})"


RULES: dict[DecisionRule, str] = {
    "simple acceptance": (
        "Decision rule: simple acceptance. A result conforms where the measured value lies inside"
        " the limits or on one; its uncertainty is stated and not taken into account. Near a limit"
        " the probability that a statement is wrong is up to 50 %."
    ),
    "guard band": (
        "Decision rule: guard band as wide as the expanded uncertainty (95 %). A result conforms"
        " where its whole coverage interval lies inside the limits, and does not conform where the"
        " whole interval lies outside; where the interval reaches over a limit no statement is"
        " made. The probability that a statement is wrong is at most 2.5 % at each limit."
    ),
}

_IN_MEGA = 1e6

_REACHES = "no statement: the interval reaches over a limit"


def conformity_table(
    details: ReportDetails, tests: Sequence[TestView], units: UnitSystem
) -> PageTable | None:
    """Return a row for each limit; None where none is given."""
    if not details.limits or details.decision_rule is None:
        return None
    by_id = {view.id: view for view in tests}
    rows = [_row(one, by_id.get(one.test), details.decision_rule, units) for one in details.limits]
    factors = factor_words(factor for row in rows for cell in row for factor in cell.factors)
    return make_table(
        "Statements of conformity with the limits that were agreed.",
        ("quantity", "test", "at", "result", "limits", "unit", "limit from", "statement"), rows,

        remarks=[
            f"±: expanded uncertainty, 95 %{f' ({factors})' if factors else ''}.",
            RULES[details.decision_rule],
        ],
    )  # fmt: skip


def _row(
    one: ReportLimit, view: TestView | None, rule: DecisionRule, units: UnitSystem
) -> list[TableCell]:
    head = [words(one.quantity.replace("_", " ")), words(one.test), words(_place(one))]
    try:
        if view is None:
            raise ReductionError("there is no archive of the test")
        if view.is_of_earlier_run:
            raise ReductionError("the archive of the test is of an earlier run")
        budget = budget_from_archive(view.data, one.quantity, one.at)
    except (ReductionError, ValueError) as error:
        unit = _unit(quantity(one.quantity).unit, units)
        return [
            *head, words(""), _limits(one, unit), words(superscript(unit.unit)), words(one.source),
            TableCell(f"no statement: {_why(error)}"),
        ]  # fmt: skip
    shown = _unit(budget.unit, units)
    interval = _interval(view, budget)
    verdict = conformity(budget.value, interval, lower=one.lower, upper=one.upper, rule=rule)
    return [
        *head,
        measured(budget.value, budget.expanded_uncertainty, shown, factor=budget.coverage_factor),
        _limits(one, shown),
        words(superscript(shown.unit)),
        words(one.source),
        words(verdict if verdict != "no statement" else _REACHES),
    ]


def _why(error: Exception) -> str:
    """Return what is wrong with a limit and what it needs, in the terms of campaign.toml."""
    needed = getattr(error, "needed", None)
    what = str(getattr(error, "problem", error))
    return what if needed is None else f"{what}; needed {needed.replace('--at', 'at')}"


def _interval(view: TestView, budget: Budget) -> tuple[float, float]:
    names = [str(name) for name in view.data["specimen"].values] if "specimen" in view.data else []
    place = names.index(budget.place["specimen"]) if budget.place.get("specimen") in names else 0
    drawn = drawn_interval(view, budget.quantity, place)
    half = budget.expanded_uncertainty
    return drawn or (budget.value - half, budget.value + half)


def _unit(unit: str, system: UnitSystem) -> Shown:
    if unit == "Pa" and system == "si":
        return Shown("MPa", 1 / _IN_MEGA)
    return Shown(*display_unit(unit, system))


def _place(one: ReportLimit) -> str:
    return ", ".join(f"{place_name(key)} {_label(key, value)}" for key, value in one.at.items())


def _label(key: str, value: str) -> str:
    """A strain in percent, a tension with its unit; any other label unchanged."""
    if key.endswith(("strain", "strain_bin")):
        return f"{100 * float(value):g} %"
    return f"{value} N" if key in ("tension", "tension_grid") else value


def _limits(one: ReportLimit, unit: Shown) -> TableCell:
    ends = [
        (sign, _plain(value * unit.factor))
        for sign, value in (("\N{GREATER-THAN OR EQUAL TO}", one.lower),
                            ("\N{LESS-THAN OR EQUAL TO}", one.upper))
        if value is not None
    ]  # fmt: skip
    if len(ends) == 2:
        return TableCell(f"{ends[0][1]} to {ends[1][1]}")
    return TableCell(" ".join(ends[0]))


def _plain(value: float) -> str:
    """A limit as it was written, without trailing zeros."""
    digits, mark, power = number_text(value, 6).partition("e")
    plain = digits.rstrip("0").rstrip(".") if "." in digits else digits
    return f"{plain}{mark}{power}"

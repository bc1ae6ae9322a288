"""Statements of conformity: numbers of the tests, their limits, and what the rule makes of them."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.archive.budget import budget_from_archive
from reduction.archive.budgetplaces import place_name
from reduction.archive.laboratory import Limit, ReportDetails
from reduction.errors import ReductionError
from reduction.report.htmltable import Cell, Table, make_table, measured, number_text, words
from reduction.report.style import Shown, superscript
from reduction.report.uncertainty import drawn_interval, factor_words
from reduction.report.view import TestView, any_synthetic
from reduction.uncertainty.budget import Budget
from reduction.uncertainty.conformity import DecisionRule, conformity
from reduction.units import UnitSystem, display_unit
from reduction.vocabulary import quantity

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
) -> Table | None:
    """Return a row for each limit; None where none is given."""
    if not details.limits or details.decision_rule is None:
        return None
    by_id = {view.id: view for view in tests}
    rows = [_row(one, by_id.get(one.test), details.decision_rule, units) for one in details.limits]
    factors = factor_words(factor for row in rows for cell in row for factor in cell.factors)
    return make_table(
        "Statements of conformity with the limits that were agreed.",
        ("quantity", "test", "at", "result", "limits", "unit", "limit from", "statement"), rows,
        synthetic=any_synthetic(tests),
        remarks=[
            f"±: expanded uncertainty, 95 %{f' ({factors})' if factors else ''}.",
            RULES[details.decision_rule],
        ],
    )  # fmt: skip


def _row(one: Limit, view: TestView | None, rule: DecisionRule, units: UnitSystem) -> list[Cell]:
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
            Cell(f"no statement: {getattr(error, 'problem', error)}"),
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


def _place(one: Limit) -> str:
    return ", ".join(f"{place_name(key)} {_label(key, value)}" for key, value in one.at.items())


def _label(key: str, value: str) -> str:
    """A strain in percent and a tension with its unit; any other label as it is."""
    if key.endswith(("strain", "strain_bin")):
        return f"{100 * float(value):g} %"
    return f"{value} N" if key in ("tension", "tension_grid") else value


def _limits(one: Limit, unit: Shown) -> Cell:
    ends = [
        (sign, _plain(value * unit.factor))
        for sign, value in (("\N{GREATER-THAN OR EQUAL TO}", one.lower),
                            ("\N{LESS-THAN OR EQUAL TO}", one.upper))
        if value is not None
    ]  # fmt: skip
    if len(ends) == 2:
        return Cell(f"{ends[0][1]} to {ends[1][1]}")
    return Cell(" ".join(ends[0]))


def _plain(value: float) -> str:
    """A limit as it was written, without the zeros behind it."""
    digits, mark, power = number_text(value, 6).partition("e")
    plain = digits.rstrip("0").rstrip(".") if "." in digits else digits
    return f"{plain}{mark}{power}"

"""Tables of a stepwise test: its readings, and the moduli between them."""

from __future__ import annotations

from reduction.report.figures.stepwise import OF_STEPS, flagged_steps
from reduction.report.htmltable import Table, factors_of, make_table, measured, number, words
from reduction.report.style import shown
from reduction.report.uncertainty import expanded_of, plus_minus_of_tests
from reduction.report.view import TestView
from reduction.vocabulary import BRANCH_VALUES

__all__ = ["interval_table", "step_table"]


def step_table(view: TestView) -> Table | None:
    """Return the readings of a stepwise test."""
    strain = view.array("strain")
    if not view.is_stepwise or strain is None:
        return None
    force, length = shown("tension", view.units), shown("small length", view.units)
    percent, stress = shown("strain", view.units), shown("stress", view.units)
    column = {
        name: view.array_like(name, strain)
        for name in (
            "time", "tension", "gauge_length", "eye_to_eye_length", "printed_strain",
            "secant_modulus", "branch",
        )
    }  # fmt: skip
    clock = view.texts("clock") or ("",) * strain.size
    branches = {value: name for name, value in BRANCH_VALUES.items()}
    rows = [
        [
            words(clock[place] or f"{column['time'][place]:g} s"),
            number(column["tension"][place], force),
            number(column["gauge_length"][place], length),
            number(column["eye_to_eye_length"][place], length),
            number(column["printed_strain"][place], percent),
            number(strain[place], percent),
            number(column["secant_modulus"][place], stress),
            words(branches.get(int(column["branch"][place]), "")),
            words(flag),
        ]
        for place, flag in enumerate(flagged_steps(view))
    ]
    columns = (
        "clock", force.label("tension"), length.label("length between the marks"),
        length.label("eye to eye"), percent.label("elongation as recorded"),
        percent.label("strain"), stress.label("secant modulus"), "branch", "flag",
    )  # fmt: skip
    return make_table("Readings of the stepwise test.", columns, rows, synthetic=view.is_synthetic)


def interval_table(view: TestView) -> Table | None:
    """Return the moduli between the readings of a stepwise test."""
    strain, modulus = view.array("interval_strain"), view.array("interval_modulus")
    if strain is None or modulus is None:
        return None
    percent, stress = shown("strain", view.units), shown("stress", view.units)
    spread = expanded_of(view, "interval_modulus", modulus)
    branch = view.array_like("interval_branch", modulus)
    branches = {value: name for name, value in BRANCH_VALUES.items()}
    clock = view.texts("clock") or tuple(str(place + 1) for place in range(strain.size + 1))
    rows = [
        [
            words(f"{clock[place]} to {clock[place + 1]}"),
            words(branches.get(int(branch[place]), "")),
            number(strain[place], percent),
            measured(modulus[place], spread.half[place], stress, factor=spread.factor[place]),
        ]
        for place in range(strain.size)
    ]
    columns = (
        "between", "branch", percent.label("strain in the middle"),
        stress.label("interval modulus"),
    )  # fmt: skip
    return make_table(
        "Slope of stress on strain between two readings; none where a reading is flagged or the"
        " weights turn.",
        columns, rows, synthetic=view.is_synthetic,
        remarks=[
            plus_minus_of_tests(
                factors_of(rows), [view], ["interval_modulus"], found_from=OF_STEPS
            )
        ],
    )  # fmt: skip

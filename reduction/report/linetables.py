"""Tables of the three-parameter line, of a slow pull, and of the stiffness forms of codes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.line.product import REASONS
from reduction.report.experimentview import ExperimentView, response_unit
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    probability,
    span,
    within,
    words,
)
from reduction.report.style import Shown, shown, superscript
from reduction.report.uncertainty import (
    DRAWN,
    NORMAL,
    drawn_interval,
    expanded_of,
    plus_minus,
    plus_minus_of_tests,
    shared_sources,
)
from reduction.report.view import TestView

__all__ = [
    "FORM_WORDS", "form_quality_table", "form_table", "line_of_runs_table", "line_table",
    "pull_share_table", "pull_table",
]  # fmt: skip

_PARAMETERS = (
    ("test_quasi_static_spring_constant", "tension", "K_0, quasi-static spring constant"),
    ("test_dissipation_spring_constant", "tension", "K_1, dissipation spring constant"),
    ("test_relaxation_time", "time", "tau, relaxation time"),
    ("test_dashpot_coefficient", "dashpot", "C = K_1 tau, dashpot coefficient"),
)
_FROM = "scatter between cycles, and K_0 with the fit of its slow pull"
_CONDITIONING = (
    "Conditioning, K_0 / (E' - K_0): how many times a relative error of K_0 enters E' - K_0, on"
    " which K_1 and tau stand."
)
_REFUSED = "refused because"
FORM_WORDS = {
    "del-vecchio": "Del Vecchio",
    "mean-load": "mean load",
    "quadratic": "quadratic surface",
}
"""Names of the forms of stiffness on the page."""
_TERMS = ("1", "T", "T²", "T³")


def line_table(view: TestView) -> Table | None:
    """Return the parameters of the line of each specimen of a test."""
    if "test_relaxation_time" not in view.data:
        return None
    rows = [[words(name), *_line_cells(view, k)] for k, name in enumerate(view.specimens)]
    columns, rows = _without_refusals(["specimen", *_line_columns(view)], rows)
    return make_table(
        "The three-parameter line: a spring K_0 beside a spring K_1 in series with a dashpot.",
        columns, rows, synthetic=view.is_synthetic,
        remarks=[_CONDITIONING, *_about_line(rows, [view])],
    )  # fmt: skip


def line_of_runs_table(view: ExperimentView, tests: Mapping[str, TestView]) -> Table | None:
    """Return the parameters of the line of each run, and those derived from surfaces beside."""
    names, specimens = view.texts("run_name"), view.texts("run_specimen")
    force, time = shown("tension", view.units), shown("time", view.units)
    derived = (
        (view.per_run("derived_dissipation_spring_constant"), force),
        (view.per_run("derived_relaxation_time"), time),
    )
    rows, used = [], []
    for k, (run, specimen) in enumerate(zip(names, specimens, strict=True)):
        test = tests.get(run)
        if test is None or "test_relaxation_time" not in test.data:
            continue
        used.append(test)
        rows.append(
            [
                words(view.runs[k]),
                *_line_cells(test, test.specimens.index(specimen)),
                *(number(float(values[k]), unit) for values, unit in derived),
            ]
        )
    if not used:
        return None
    tail = [force.label("K_1 from surfaces"), time.label("tau from surfaces")]
    columns, rows = _without_refusals(["run", *_line_columns(used[0]), *tail], rows)
    return make_table(
        "The three-parameter line of each run; at the right K_1 and tau from surfaces of E' and E''"
        " at the same levels, which smooth over the runs.",
        columns, rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[_CONDITIONING, *_about_line(rows, used)],
    )  # fmt: skip


def form_table(view: ExperimentView) -> Table | None:
    """Return the coefficients of the stiffness forms with their intervals."""
    forms = _forms(view)
    names, units = (view.array_of_texts(f"stiffness_coefficient_{w}") for w in ("name", "unit"))
    spread = view.array("stiffness_coefficient_standard_uncertainty")
    rows = []
    for k, form in forms:
        for j in range(names.shape[1]):
            if not names[k, j]:
                continue
            low, high = (
                float(view.array(f"stiffness_coefficient_{e}")[k, j]) for e in ("low", "high")
            )
            rows.append(
                [
                    words(FORM_WORDS.get(form, form)),
                    words(str(names[k, j])),
                    measured(
                        float(view.array("stiffness_coefficient")[k, j]),
                        (high - low) / 2,
                        factor=(high - low) / 2 / spread[k, j],
                    ),
                    words(str(units[k, j])),
                    Cell(f"{low:.4g} to {high:.4g}", f"{low!r} {high!r}", is_number=True),
                    probability(float(view.array("stiffness_p_value")[k, j])),
                ]
            )
    if not rows:
        return None
    confidence = 100 * float(np.nanmax(view.array("stiffness_confidence")))
    return make_table(
        "Coefficients of the stiffness forms of mooring codes.",
        ("form", "coefficient", "value", "unit", f"{confidence:g} % interval", "p if nil [1]"),
        rows, synthetic=view.is_synthetic,
        remarks=[plus_minus(factors_of(rows), "scatter of the runs about the form",
                            left_out="that the form itself may be wrong: see its quality")],
    )  # fmt: skip


def form_quality_table(view: ExperimentView) -> Table | None:
    """Return how well each form fits the runs, beside the quadratic surface."""
    forms = _forms(view)
    if not forms:
        return None
    strength = np.nanmax(view.per_run("run_rated_break_strength"))
    unit = response_unit("apparent_spring_constant", view.units)
    of_strength = Shown(unit.unit, unit.factor * float(strength))
    columns = ("n_coefficients", "r2", "adjusted_r2", "predicted_r2", "sigma", "sigma", "aicc")
    rows = [
        [
            words(FORM_WORDS.get(form, form)),
            *(
                count(float(view.array(f"stiffness_{name}")[k]))
                if j == 0
                else number(
                    float(view.array(f"stiffness_{name}")[k]), of_strength if j == 5 else None
                )
                for j, name in enumerate(columns)
            ),
        ]
        for k, form in forms
    ]
    return make_table(
        "The forms against the quadratic surface of the same runs.",
        ("form", "coefficients [1]", "r² [1]", "adjusted r² [1]", "predicted r² [1]",
         "s over break strength [1]", unit.label("s"), "AICc [1]"),
        rows, synthetic=view.is_synthetic,
        remarks=["s: standard deviation of a run about the form. AICc: lower is better; one form"
                 " against another on the same runs, nothing by itself."],
    )  # fmt: skip


def pull_table(view: TestView) -> Table | None:
    """Return the cubic of each slow pull, its range of use, and how it was made."""
    coefficient = view.array("pull_strain_coefficient")
    if coefficient is None:
        return None
    force, percent = shown("tension", view.units), shown("strain", view.units)
    half = expanded_of(view, "pull_strain_coefficient", coefficient).half
    given = [k for k in range(len(view.specimens)) if np.isfinite(coefficient[k]).any()]
    rows = []
    for power, term in enumerate(_TERMS):
        scale = 1.0 / force.factor**power
        per = "1" if power == 0 else superscript(f"{force.unit}-{power}")
        rows.append(
            [words(f"strain, coefficient of {term} [{per}]")]
            + [_scaled(coefficient[k, power], half[k, power], scale) for k in given]
        )
    low, high = (view.array_like(f"pull_tension_{e}", coefficient[:, 0]) for e in ("low", "high"))
    scalars: Sequence[tuple[str, str, Shown]] = (
        ("residual of the cubic", "pull_residual", percent),
        ("rate of strain", "pull_strain_rate", Shown("%/min", 6000.0)),
        ("waiting time before the pull", "pull_waiting_time", Shown("h", 1 / 3600.0)),
        ("tension at which the length was read", "pull_reference_tension", force),
    )
    rows += [
        [words(force.label("range of use"))]
        + [span(low[k], high[k], force, places=0) for k in given]
    ]  # fmt: skip
    for text, name, unit in scalars:
        values = view.array_like(name, coefficient[:, 0])
        rows.append([words(unit.label(text))] + [number(float(values[k]), unit) for k in given])
    return make_table(
        "Slow pull: strain as a cubic of tension T, and the conditions it holds for.",
        ("what, with its unit", *(view.specimens[k] for k in given)), rows,
        synthetic=view.is_synthetic,
        remarks=["K_0 is the inverse slope of the cubic at the mean tension of interest; it grows"
                 " with the rate of strain and with the waiting time.",
                 _about_pull(view, "pull_strain_coefficient")],
    )  # fmt: skip


def pull_share_table(view: TestView) -> Table | None:
    """Return strain and K_0 of the slow pull at round shares of the break strength."""
    share, strain = view.array("break_share"), view.array("strain_at_break_share")
    if share is None or strain is None:
        return None
    half = expanded_of(view, "strain_at_break_share", strain).half
    percent = shown("strain", view.units)
    kept = np.flatnonzero(np.isfinite(strain).any(axis=0))
    if kept.size == 0:
        return None
    rows = [
        [words(f"{100 * share[j]:g}")]
        + [measured(strain[k, j], half[k, j], percent) for k in range(len(view.specimens))]
        for j in kept
    ]
    return make_table(
        "Strain of the slow pull at round shares of the rated break strength, within its range.",
        ("tension [%RBS]", *(percent.label(name) for name in view.specimens)), rows,
        synthetic=view.is_synthetic,
        remarks=[_about_pull(view, "strain_at_break_share")],
    )  # fmt: skip


def _line_columns(view: TestView) -> tuple[str, ...]:
    units = [_unit(view, kind).label(text) for _, kind, text in _PARAMETERS]
    return (*units, "conditioning [1]", _REFUSED)


def _without_refusals(
    columns: list[str], rows: list[list[Cell]]
) -> tuple[list[str], list[list[Cell]]]:
    """Return the table without its column of refusals where nothing was refused."""
    place = columns.index(_REFUSED)
    if any(row[place].text != NOT_GIVEN for row in rows):
        return columns, rows
    return (
        [*columns[:place], *columns[place + 1 :]],
        [[*row[:place], *row[place + 1 :]] for row in rows],
    )


def _line_cells(view: TestView, place: int) -> list[Cell]:
    cells = []
    for name, kind, _ in _PARAMETERS:
        values = view.array_like(name, np.empty(len(view.specimens)))
        drawn = drawn_interval(view, name, place)
        if drawn is not None:
            cells.append(within(float(values[place]), *drawn, _unit(view, kind)))
            continue
        spread = expanded_of(view, name, values)
        cells.append(
            measured(
                float(values[place]),
                float(spread.half[place]),
                _unit(view, kind),
                factor=float(spread.factor[place]),
            )
        )
    conditioning = view.array_like("test_line_conditioning", np.empty(len(view.specimens)))
    codes = view.array("test_line_refusal")
    reason = "" if codes is None else REASONS.get(int(codes[place]), "")
    return [*cells, number(float(conditioning[place]), digits=3), words(reason)]


def _about_line(rows: Sequence[Sequence[Cell]], tests: Sequence[TestView]) -> list[str]:
    names = [name for name, *_ in _PARAMETERS]
    has_fit = "quasi_static_fit" in shared_sources(tests, names)
    said = plus_minus_of_tests(
        factors_of(rows), tests, names, found_from="scatter between cycles" if has_fit else _FROM
    )
    is_drawn = any(
        drawn_interval(test, name, place) is not None
        for test in tests
        for name in names
        for place in range(len(test.specimens))
    )
    return [said, *([DRAWN] if is_drawn else [])]


def _about_pull(view: TestView, name: str) -> str:
    return plus_minus_of_tests([NORMAL], [view], [name], found_from="scatter about the cubic")


def _unit(view: TestView, kind: str) -> Shown:
    force, time = shown("tension", view.units), shown("time", view.units)
    dashpot = Shown(f"{force.unit} {time.unit}", force.factor * time.factor)
    return {"tension": force, "time": time, "dashpot": dashpot}[kind]


def _forms(view: ExperimentView) -> list[tuple[int, str]]:
    if (
        "stiffness_form" not in view.data
        or not np.isfinite(view.array("stiffness_n_coefficients")).any()
    ):
        return []
    return [(k, str(name)) for k, name in enumerate(view.data["stiffness_form"].values)]


def _scaled(value: float, half: float, scale: float) -> Cell:
    text = f"{value * scale:.6g}" + (f" ± {half * scale:.2g}" if np.isfinite(half) else "")
    return Cell(text, repr(float(value)), is_number=True)

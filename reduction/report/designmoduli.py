"""The answer of the first screen: what modulus to design with, a row a test and specimen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.archive.freedom import cycles_averaged
from reduction.moduli.interpolation import curve_at
from reduction.notes import severity_of
from reduction.record import Floats
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    factors_of,
    make_table,
    measured,
    number,
    span,
    words,
)
from reduction.report.style import shown
from reduction.report.uncertainty import expanded_of, plus_minus_of_tests
from reduction.report.view import TestView, all_specimens, any_synthetic
from reduction.vocabulary import BRANCH_NAMES

_WHOLE, _OF_ROPE = "test_dynamic_modulus", "test_apparent_spring_constant"
_TANGENT = "tangent_modulus"
_MOST_ROWS = 24


def design_modulus_table(tests: Sequence[TestView]) -> Table | None:
    """Return the moduli to design with: of the whole cycle, and of each branch at its middle.

    Parameters
    ----------
    tests : sequence of TestView
        Of a campaign; those without cycles have no row.

    Returns
    -------
    table : Table or None
        None where no test has a modulus of its cycles.
    """
    order = all_specimens(tests)
    is_of_ropes = bool(tests) and all(view.is_rope for view in tests)
    whole = _OF_ROPE if is_of_ropes else _WHOLE
    by_test = [(view, list(_rows(view, whole))) for view in tests]
    found = [row for _, rows in by_test for row in rows]
    found.sort(key=lambda row: order.index(row[0].text))
    if not found:
        return None
    units = tests[0].units
    stress, percent = shown("stress", units), shown("strain", units)
    columns = (
        "specimen", "test", percent.label("strain of the cycles"), "frequency [Hz]",
        (shown("tension", units) if is_of_ropes else stress).label("whole cycle"),
        stress.label("ascending"), stress.label("descending"),
        "cycles used [1]", "k [1]", "warnings [1]",
    )  # fmt: skip
    return make_table(
        f"{'Stiffness' if is_of_ropes else 'Modulus'} to design with: of the whole cycle, which is"
        f" amplitude of {'tension' if is_of_ropes else 'stress'} over amplitude of strain, and of"
        " each branch the tangent modulus at the middle of the strain of the cycles; means over the"
        " cycles.",
        columns, found, synthetic=any_synthetic(tests), is_compact=True,
        is_tall=len(found) > _MOST_ROWS,
        remarks=[
            plus_minus_of_tests(
                factors_of(found), [view for view, rows in by_test if rows], [whole, _TANGENT]
            ),
            "Cycles used: of the whole cycle, then of the tangents where those differ."
            f" {NOT_GIVEN}: a branch has no trustworthy value there, and its section says why."
            " A modulus holds for the strains of its own test: a greater amplitude or a higher"
            " mean has another.",
        ],
    )  # fmt: skip


def _rows(view: TestView, name: str) -> Iterator[list[Cell]]:
    whole, middle = view.array(name), view.array("test_mean_strain")
    half_range = view.array("test_strain_amplitude")
    if whole is None or middle is None or half_range is None:
        return
    stress, percent = shown("stress", view.units), shown("strain", view.units)
    unit = stress if name == _WHOLE else shown("tension", view.units)
    spread = expanded_of(view, name, whole)
    frequency = view.array_like("test_frequency", whole)
    doubts = _doubts(view)
    averaged = np.broadcast_to(cycles_averaged(view.data, name), whole.shape)
    for place in np.flatnonzero(np.isfinite(whole)).tolist():
        tangents, counts = _tangents(view, place, float(middle[place]))
        cells = [
            measured(whole[place], spread.half[place], unit, factor=spread.factor[place]),
            *tangents,
        ]
        low, high = (float(middle[place] + side * half_range[place]) for side in (-1, 1))
        yield [
            words(view.specimens[place]),
            words(f"{view.id} (earlier run)" if view.is_of_earlier_run else view.id),
            span(low, high, percent, places=0),
            number(float(frequency[place]), digits=2),
            *cells,
            Cell(_used(int(averaged[place]), counts), str(averaged[place]), is_number=True),
            Cell(_factor_text(cells), is_number=True),
            Cell(f"{doubts}" if doubts else "none", f"{doubts}", is_number=True),
        ]


def _tangents(view: TestView, specimen: int, strain: float) -> tuple[list[Cell], list[int]]:
    """Return the tangent modulus of both branches at a strain, and how many cycles are in it."""
    bins, modulus = view.array("strain_bin"), view.array(_TANGENT)
    missing = Cell(NOT_GIVEN, is_number=True)
    if bins is None or modulus is None or bins.size == 0:
        return [missing] * len(BRANCH_NAMES), []
    spacing = float(np.min(np.diff(bins))) if bins.size > 1 else 0.0
    spread = expanded_of(view, _TANGENT, modulus)
    counts = view.array_like(f"{_TANGENT}_count", modulus)
    branches = view.texts("branch_name") or BRANCH_NAMES
    nearest = int(np.argmin(np.abs(bins - strain)))
    cells: list[Cell] = []
    used: list[int] = []
    for name in BRANCH_NAMES:
        own = (specimen, branches.index(name))

        def at_middle(curve: Floats, own: tuple[int, int] = own) -> float:
            return float(curve_at([strain], bins, curve[own], spacing=spacing)[0])

        value, half, factor = map(at_middle, (modulus, spread.half, spread.factor))
        cells.append(measured(value, half, shown("stress", view.units), factor=factor))
        if np.isfinite(value) and np.isfinite(counts[own][nearest]):
            used.append(int(counts[own][nearest]))
    return cells, used


def _used(n_cycles: int, counts: Sequence[int]) -> str:
    """Return how many cycles stand behind a row: one number where it is the same of all.

    Examples
    --------
    >>> _used(3000, [20, 19]), _used(10, [10, 10]), _used(10, [])
    ('3,000; 19 to 20', '10', '10')
    """
    ends = dict.fromkeys(f"{one:,}" for one in (min(counts), max(counts))) if counts else {}
    of_curve = " to ".join(ends)
    return "; ".join(dict.fromkeys(text for text in (f"{n_cycles:,}", of_curve) if text))


def _factor_text(cells: Sequence[Cell]) -> str:
    ends = [f"{one:.2f}" for one in sorted(factors_of([cells]))]
    return " to ".join(dict.fromkeys([ends[0], ends[-1]])) if ends else NOT_GIVEN


def _doubts(view: TestView) -> int:
    notes = zip(view.texts("note_stage"), view.texts("note"), strict=True)
    return sum(severity_of(*note) == "doubt" for note in notes)

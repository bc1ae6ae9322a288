r"""CG-D-39-80: K_0 polynomials and response surfaces, Tables 3 to 9 and 11 to 19.

A coefficient printed in two tables is compared with the other print; one printed in only one table
comes from runs that are not printed.  B1 is the mean of the centre runs, so it can be compared
with the equations of the line.

**K_1 and tau of a column compared with K_ap, H and K_0 of the same line.**  At the 15 runs of the
design, K_1 and tau are solved from the printed surfaces of K_ap and H and from a slow pull, and the
quadratic is fitted to them again.  A printed coefficient differs from the refitted one by at most
its standard error, which follows from the r2 of its own column:

.. math:: u_j = s \sqrt{[(X^T X)^{-1}]_{jj}}, \qquad
          s^2 = \frac{1 - r^2}{r^2 \, \nu} \sum_i (\hat y_i - \bar{\hat y})^2, \quad \nu = 5

The scatter of the runs about K_ap and H is orthogonal to the quadratic to first order, so the error
is rather too large, and a closure detects slightly more than it states.  Where the quadratic cannot
follow the solutions, as for tau of runs with H near zero, its residual is added to s.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1, 4, 5, sec. 4.3, Tables 3 to 19.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.experiments.least_squares_fit import statistics_from_r2
from reduction.published.cg_cells import (
    CENTRE_LINES,
    ENERGY,
    K_1,
    K_AP,
    NYLON_PLAITED,
    POLYESTER_BRAID,
    POLYNOMIAL_SCALES,
    TIME,
    Pages,
    centre_stiffness,
    levels_of,
    number,
    rounding,
)
from reduction.published.printed_cells import Cell, printed_step
from reduction.published.reproduced_item import (
    ReproducedItem,
    agree,
    closed_item,
    compared_item,
    judge,
    judge_as,
    judge_repeat,
    measured_item,
)
from reduction.record.measurement import Floats, read_only_arrays
from reduction.stages.three_parameter_line.line_model import (
    apparent_spring_constant,
    hysteresis_energy,
    identify_by_amplitude,
)
from reduction.stages.three_parameter_line.slow_pull import fit_pull, spring_constant_ratio

REST, STRAIN = "quasi_static_spring_constant", "quasi_static_strain"

RANGE = "mean_tension high"

FITTED = "a fit to pulls that are not printed"

EXPOSED_YEARS = "5 years"


def item_of_static(cell: Cell, pages: Pages) -> ReproducedItem:
    """Verdict on a cell of Tables 6-9 and D-1."""
    if cell.table == "D-1":
        return _rate(cell, pages)
    term = cell.column.partition(" ")[2]
    if cell.row == "every line":
        return _head(cell, pages, term)
    if term == RANGE:
        return _static_range(cell, pages)
    if term == "number of samples":
        return _static_count(cell, pages)
    twin = _static_twin(cell, pages)
    if twin is not None:
        return judge_repeat(cell, twin[0], twin[1])
    if cell.table in ("6", "7"):
        return _coefficient_of_stiffness(cell, pages, term)
    if cell.erratum == "CG-10":
        return compared_item(
            cell, _curvature_of_strain(cell, pages), f"{FITTED}; C that meets K_0 of Table 7"
        )
    return measured_item(cell, FITTED)


def _static_twin(cell: Cell, pages: Pages) -> tuple[float, str] | None:
    """The number in the other table, corrected where that table is wrong by itself."""
    table = {"6": "7", "7": "6", "8": "9", "9": "8"}[cell.table]
    other = pages.by_key.get((table, cell.row, cell.column))
    if other is None or (other.erratum and other.erratum != cell.erratum):
        return None
    if other.corrected is None:
        return number(other), f"Table {table}"
    if cell.erratum == "CG-9" and cell.table == "6":
        # C of Table 7 has lost its sign, for other reasons
        return other.corrected, f"Table {table}, C with its sign"
    return None


def _slopes(cell: Cell, pages: Pages, tension: float) -> float | None:
    """K_0 [lb] by the cubic of the same line, where one is printed."""
    table = "8" if cell.row.endswith("new") else "9"
    row = cell.row.replace("field exposure", EXPOSED_YEARS)
    if (table, row, f"{STRAIN} A") not in pages.by_key:
        return None
    return pages.slope(table, row, tension)


def _coefficient_of_stiffness(cell: Cell, pages: Pages, term: str) -> ReproducedItem:
    """Value of a coefficient for which the others give the slope at mid range."""
    tension = 0.7 * pages.value(cell.table, cell.row, f"{REST} {RANGE}")
    slope = _slopes(cell, pages, tension)
    if slope is None:
        return measured_item(cell, FITTED)
    power = "ABCD".index(term)
    others = pages.polynomial(cell.table, cell.row, tension)
    scale = tension**power * POLYNOMIAL_SCALES[power]
    own = pages.value(cell.table, cell.row, cell.column)
    return compared_item(
        cell, own + (slope - others) / scale,
        f"{FITTED}; beside it what meets the slope of the cubic at {tension:.0f} lb",
    )  # fmt: skip


def _curvature_of_strain(cell: Cell, pages: Pages) -> float:
    """C [1e-8/lb2] for which the slope of the cubic equals K_0 at the centre of the levels."""
    tension = 1470.0
    rest = pages.polynomial("7", cell.row.replace(EXPOSED_YEARS, "field exposure"), tension)
    _, linear, _, cubic = pages.cubic("9", cell.row)
    return float((1 / rest - linear - 3 * cubic * tension**2) / (2 * tension) * 1e8)


def _head(cell: Cell, pages: Pages, term: str) -> ReproducedItem:
    """The form of the polynomial: powers of T, and the leading power of ten."""
    row, tension = "nylon | double braid | 1/2 in | new", 1344.0
    if term == "power of ten":
        ratio = pages.slope("8", row, tension) / (pages.polynomial("7", row, tension) / 1e4)
        base, _, exponent = cell.printed.partition("^")
        how = "K_0 of Table 8 over the polynomial, as a power of ten"
        text = exponent.strip("{}") if base == "10" else ""
        return judge_as(cell, text, round(np.log10(ratio)), how)
    expected = "ABCD".index(term[-1])
    if cell.printed == "T_m":
        return agree(cell, expected == 1, "Table 7 meets the slopes of Table 8")
    return judge(cell, float(expected), "Table 7, which meets the slopes of Table 8")


def _static_range(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.erratum == "CG-12":
        off = ", ".join(f"{100 * one:.0f}" for one in _departures(cell.row, pages))
        return measured_item(cell, f"{off} % off the slope of Table 8 at the three levels")
    if cell.erratum == "CG-13":
        return _range_of_strength(cell, pages)
    years = cell.row.replace("field exposure", EXPOSED_YEARS)
    exposure = cell.row.replace(EXPOSED_YEARS, "field exposure")
    table = {"6": "8", "8": "6", "7": "9", "9": "7"}[cell.table]
    quantity = REST if table in ("6", "7") else STRAIN
    other = pages.by_key.get(
        (table, exposure if quantity == REST else years, f"{quantity} {RANGE}")
    )
    if other is not None and (not other.erratum or other.erratum == cell.erratum):
        return judge_repeat(cell, number(other), f"Table {table}")
    strength = pages.by_key.get(("1", cell.row, "rated_break_strength"))
    if strength is None:
        return measured_item(cell, "a range that no other table prints")
    return judge(cell, 0.30 * number(strength), "30 % of the rated break strength of Table 1")


def _levels(row: str, pages: Pages) -> list[float]:
    """Low, centre and high mean load [lb] of the design of a new line."""
    centre = CENTRE_LINES[row][1]
    shares = [
        pages.value("1", levels_of(row), f"mean_tension {end}") for end in ("low", "centre", "high")
    ]
    return [centre * share / shares[1] for share in shares]


def _departures(row: str, pages: Pages) -> list[float]:
    """Difference of the polynomial from the slope of the cubic at each level, as a share."""
    table = CENTRE_LINES[row][0]
    return [
        abs(pages.polynomial(table, row, tension) / pages.slope("8", row, tension) - 1)
        for tension in _levels(row, pages)
    ]


def _range_of_strength(cell: Cell, pages: Pages) -> ReproducedItem:
    """Two rows print a break strength where the others print 30 % of it."""
    if cell.row.startswith("polyester"):
        strength = pages.printed("10", cell.row, "tensile_strength mean")
        return judge(cell, 0.30 * strength, "30 % of the strength of Table 10")
    wet = cell.row.replace("new", "wet, before cycling")
    strength = pages.printed("A-3", wet, "tensile_strength mean")
    return judge(cell, 0.30 * strength, "30 % of the strength of Table A-3")


def _static_count(cell: Cell, pages: Pages) -> ReproducedItem:
    table, quantity = ("8", STRAIN) if cell.table == "6" else ("6", REST)
    other = pages.by_key.get((table, cell.row, f"{quantity} number of samples"))
    if other is not None:
        return judge_repeat(cell, number(other), f"Table {table}")
    if "13/16" in cell.row:
        return judge(cell, 9.0, "nine of each diameter, sec. A-2.1")
    return measured_item(cell, "a count that no other table prints")


def _rate(cell: Cell, pages: Pages) -> ReproducedItem:
    if cell.column != REST:
        return measured_item(cell, "a setting of the test")
    load = np.linspace(0, 2000, 100)
    slowest = "24 h after the dynamic test, slow"
    pulls = [
        fit_pull(np.arange(100.0), load / (1e4 * pages.printed("D-1", row, REST)), load)
        for row in (cell.row, slowest)
    ]
    ratio = float(spring_constant_ratio(pulls[0], pulls[1], 1000.0)[0])
    return measured_item(cell, f"measured; {ratio:.2f} times the slow pull after 24 h")


TABLES_OF = {
    K_AP: ("3", "4", "5"), ENERGY: ("11", "12", "13"), K_1: ("14", "15", "16"),
    TIME: ("17", "18", "19"),
}  # fmt: skip

RUNS = "a regression over runs that are not printed"


def item_of_surface(cell: Cell, pages: Pages) -> ReproducedItem:
    """Verdict on a cell of Tables 3-5 and 11-19."""
    quantity, _, term = cell.column.partition(" ")
    if term == "r2":
        return _share(cell, pages)
    if term == "F-stat":
        return _statistic(cell, pages)
    if term == "F-crit":
        found = statistics_from_r2(0.9, n_runs=15, n_terms=10)
        scale = float(found.printed_f / found.f)
        return judge(
            cell, float(found.critical) * scale,
            "F(.05; 9, 5) on the scale of the printed statistic; printed is F(.05; 4, 10)",
        )  # fmt: skip
    if term == "number of lines":
        return _count(cell, pages)
    if term == "change":
        return _change(cell, pages)
    if term.endswith((" low", " high")):
        return _range(cell, pages)
    if term.startswith("B") and quantity in TABLES_OF:
        return _coefficient(cell, pages, quantity, term)
    return measured_item(cell, "a head of the table")


def _twin(cell: Cell, pages: Pages, quantity: str) -> Cell | None:
    """The same number in another table, unless that print is known to be wrong."""
    tables = TABLES_OF[quantity]
    if quantity == K_1 and cell.row == f"{POLYESTER_BRAID} | new":
        # three prints: Table 11 repeats this column under the heading of the energy
        copied = pages.by_key[("11", cell.row, cell.column.replace(K_1, ENERGY))]
        own = pages.by_key.get(("14" if cell.table == "16" else "16", cell.row, cell.column))
        return own if own is not None and number(own) == number(copied) else copied
    for table in tables:
        other = pages.by_key.get((table, cell.row, cell.column))
        if table != cell.table and other is not None and other.confidence in ("", "open"):
            return other
    return None


def _coefficient(cell: Cell, pages: Pages, quantity: str, term: str) -> ReproducedItem:
    item = _by_other_prints(cell, pages, quantity, term)
    if quantity not in SOLVED:
        return item
    closure = closure_of(pages, cell.row, quantity)
    return item if closure is None else _closed(item, closure, int(term.removeprefix("B")) - 1)


def _closed(item: ReproducedItem, closure: Sequence[Closure], place: int) -> ReproducedItem:
    """A coefficient compared by the nearest slow pull, since it is open which pull is right."""
    own = number(item.cell)
    best = min(closure, key=lambda one: abs(own - one.coefficient[place]))
    beside = " or ".join(f"{one.coefficient[place]:.3f} ({one.slow_pull})" for one in closure)
    told = f"{item.how}; " if item.verdict == "repeated" else ""
    return closed_item(
        replace(item, recomputed=float(best.coefficient[place])),
        float(best.standard_error[place]),
        spread=float(np.ptp([one.coefficient[place] for one in closure])),
        how=f"{told}K_ap, H and K_0 at the runs of the design give {beside}",
    )


def _by_other_prints(cell: Cell, pages: Pages, quantity: str, term: str) -> ReproducedItem:
    """A coefficient compared with its other print, or with the equations at the centre."""
    twin = _twin(cell, pages, quantity)
    if twin is not None:
        return judge_repeat(cell, number(twin), f"Table {twin.table}")
    if cell.erratum == "CG-6":
        return compared_item(
            cell, _energy_by_mean_load(pages, cell.row),
            f"{RUNS}; half the difference of H at (0, +1, 0) and (0, -1, 0) by the equations",
        )  # fmt: skip
    if term != "B1" or cell.row not in CENTRE_LINES:
        return _exposed_time(cell, pages, quantity, term)
    recomputed = _centre(pages, cell.row, quantity)
    return compared_item(
        cell, recomputed, f"{RUNS}; the equations at the centre give the number beside"
    )


def _centre(pages: Pages, row: str, quantity: str) -> float:
    """Result of eqs. 1 and 4, as corrected, from the three other printed means."""
    _, _, amplitude = CENTRE_LINES[row]
    rest = centre_stiffness(pages, row)
    table = {K_AP: "3", ENERGY: "11", K_1: "14", TIME: "17"}
    mean = {name: pages.value(table[name], row, f"{name} B1") for name in table}
    if quantity in (K_AP, ENERGY):
        line = {
            "quasi_static_spring_constant": rest,
            "dissipation_spring_constant": 1e4 * mean[K_1],
            "relaxation_time": mean[TIME],
            "frequency": 0.3,
        }
        if quantity == K_AP:
            return float(apparent_spring_constant(**line)) / 1e4
        return float(hysteresis_energy(tension_amplitude=amplitude, **line))
    return _solved(mean[K_AP], mean[ENERGY], amplitude, rest)[quantity == TIME]


def _energy_by_mean_load(pages: Pages, row: str) -> float:
    """Linear effect of mean load on H by eq. 4, from K_1, tau and the slow pull."""
    level = levels_of(row)
    strength = pages.value("1", row, "rated_break_strength") / 100
    energy = []
    for end in ("low", "high"):
        coded = model_matrix([[0.0, 1.0 if end == "high" else -1.0, 0.0]], quadratic_exponents(3))
        mean = {K_1: pages.surface("14", row, K_1), TIME: pages.surface("17", row, TIME)}
        found = hysteresis_energy(
            quasi_static_spring_constant=pages.slope(
                "8", row, strength * pages.value("1", level, f"mean_tension {end}")
            ),
            dissipation_spring_constant=1e4 * (coded @ mean[K_1]),
            relaxation_time=coded @ mean[TIME],
            frequency=0.3,
            tension_amplitude=CENTRE_LINES[row][2],
        )
        energy.append(float(found[0]))
    return (energy[1] - energy[0]) / 2


def _solved(stiffness: float, energy: float, amplitude: float, rest: float) -> tuple[float, float]:
    """K_1 [1e4 lb] and tau [s] from the loop."""
    line = identify_by_amplitude(
        apparent_spring_constant=1e4 * stiffness,
        hysteresis_energy=energy,
        tension_amplitude=amplitude,
        frequency=0.3,
        quasi_static_spring_constant=rest,
    )
    return float(line.dissipation_spring_constant) / 1e4, float(line.relaxation_time)


def _exposed_time(cell: Cell, pages: Pages, quantity: str, term: str) -> ReproducedItem:
    """K_1 and tau of exposed lines compared with those solved from their own K_ap and H."""
    exposed = {
        f"{NYLON_PLAITED} | 5 years": ("4", "12", 1209.6, 489.6),
        f"{POLYESTER_BRAID} | 5 years": ("5", "13", 1470.0, 595.0),
    }
    if term != "B1" or quantity not in (K_1, TIME) or cell.row not in exposed:
        return measured_item(cell, RUNS)
    stiff, lossy, tension, amplitude = exposed[cell.row]
    rest = pages.polynomial("7", cell.row.replace("5 years", "field exposure"), tension)
    solved = _solved(
        pages.value(stiff, cell.row, f"{K_AP} B1"),
        pages.value(lossy, cell.row, f"{ENERGY} B1"),
        amplitude,
        rest,
    )
    return compared_item(
        cell, solved[quantity == TIME],
        f"{RUNS}; Tables {stiff}, {lossy} and 7 with the equations give the number beside",
    )  # fmt: skip


def _f_of(r2: float) -> float:
    return float(statistics_from_r2(r2, n_runs=15, n_terms=10).printed_f)


def _share(cell: Cell, pages: Pages) -> ReproducedItem:
    f = pages.cell(cell.table, cell.row, cell.column.replace("r2", "F-stat"))
    if cell.confidence == "certain":
        return judge_repeat(cell, number(_true_column(cell, pages)), "Table 13, new")
    statistic = number(f)
    # the statistic is 4/10 of the odds of r2
    share = float(statistic / (statistic + _f_of(0.5)))
    item = judge(cell, share, "the printed F, of 10 and 4 degrees of freedom")
    return closed_item(item, 0.5 * printed_step(cell.printed) / np.sqrt(3))


def _true_column(cell: Cell, pages: Pages) -> Cell:
    return pages.cell("13", cell.row, cell.column)


def _statistic(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity = cell.column.partition(" ")[0]
    if cell.erratum == "CG-5":
        return judge_repeat(cell, number(_true_column(cell, pages)), "Table 13, new")
    r2 = pages.cell(cell.table, cell.row, cell.column.replace("F-stat", "r2"))
    half = 0.5 * printed_step(r2.printed)
    allowed = rounding(_f_of, [number(r2)], [half]) + 0.5 * printed_step(cell.printed)
    by_share = judge(
        cell, _f_of(number(r2)),
        "r2 with 10 and 4 degrees of freedom, which counts the mean twice", tolerance=allowed,
    )  # fmt: skip
    if by_share.verdict != "derived":
        return by_share
    by_share = closed_item(by_share, allowed / np.sqrt(3))
    cut = _cut_off(cell, pages, quantity)
    if cut is not None:
        half = 0.5 * printed_step(cut.printed)
        how = f"Table {cut.table}, which cuts digits off, and r2"
        return _also_closed(judge_repeat(cell, number(cut) + half, how, tolerance=half), by_share)
    twin = _twin(cell, pages, quantity)
    if twin is None:
        return by_share
    coarser = max(printed_step(cell.printed), printed_step(twin.printed))
    how = f"Table {twin.table}, and r2"
    return _also_closed(judge_repeat(cell, number(twin), how, tolerance=0.5 * coarser), by_share)


def _also_closed(repeated: ReproducedItem, by_share: ReproducedItem) -> ReproducedItem:
    """A statistic printed twice, with its value from r2."""
    if repeated.verdict != "repeated" or by_share.verdict != "closed":
        return repeated
    return replace(repeated, verdict="closed", z=by_share.z, power=by_share.power)


def _cut_off(cell: Cell, pages: Pages, quantity: str) -> Cell | None:
    """The same statistic in another table, printed with digits cut off."""
    for table in TABLES_OF[quantity]:
        other = pages.by_key.get((table, cell.row, cell.column))
        if table != cell.table and other is not None and other.erratum == "CG-44":
            return other
    return None


def _count(cell: Cell, pages: Pages) -> ReproducedItem:
    for table in ("4", "5", "12", "13"):
        for quantity in (K_AP, ENERGY):
            other = pages.by_key.get((table, cell.row, f"{quantity} number of lines"))
            if other is not None and table != cell.table:
                return judge_repeat(cell, number(other), f"Table {table}")
    strength = pages.by_key.get(("10", cell.row, "tensile_strength number of samples"))
    if strength is None:
        return measured_item(cell, "a count that no other table prints")
    return judge_repeat(cell, number(strength), "samples of Table 10")


def _change(cell: Cell, pages: Pages) -> ReproducedItem:
    quantity = cell.column.partition(" ")[0]
    change = change_of_mean(pages, cell.table, cell.row, quantity)
    if change is None:
        return measured_item(cell, "the column of the exposed line is lost in the text")
    value, how = change
    return judge(cell, value, how)


def change_of_mean(pages: Pages, table: str, row: str, quantity: str) -> tuple[float, str] | None:
    """Percentage by which B1 of an exposed line exceeds that of the new line."""
    new = row.rpartition(" | ")[0] + " | new"
    column, lines = f"{quantity} B1", f"{quantity} number of lines"
    if (table, row, column) not in pages.by_key:
        return None
    exposed = [row]
    if row.startswith(POLYESTER_BRAID):
        exposed = [row.replace("5 years", years) for years in ("4 years", "5 years")]
    means = [pages.value(table, one, column) for one in exposed]
    counts = [pages.printed(table, one, lines) for one in exposed]
    together = float(np.average(means, weights=counts))
    how = "B1 of four and five years, weighted by lines" if len(exposed) == 2 else "B1"
    return 100 * (together / pages.value(table, new, column) - 1), f"{how} over B1 of the new line"


def _range(cell: Cell, pages: Pages) -> ReproducedItem:
    _, what, end = cell.column.split(" ")
    share = pages.value("1", levels_of(cell.row), f"{what} {end}")
    if what == "frequency":
        return judge_repeat(cell, share, "Table 1")
    strength, source = _strength(cell, pages)
    return judge(cell, share / 100 * strength, f"{share:g} % of {strength:g} lb, {source}")


def _strength(cell: Cell, pages: Pages) -> tuple[float, str]:
    """Rated break strength to which the levels refer; the other one where two are printed."""
    if cell.row.startswith(POLYESTER_BRAID):
        if cell.table in ("3", "11"):
            return pages.printed("2", f"{POLYESTER_BRAID} | all", "rated_break_strength"), "Table 2"
        return pages.printed("10", f"{POLYESTER_BRAID} | new", "tensile_strength mean"), "Table 10"
    line = cell.row.rpartition(" | ")[0]
    if line.startswith("nylon | double braid"):
        size = "nylon | double braid | 1 in" if "1 1/4" in line else line
        return pages.printed("1", f"{size} | new", "rated_break_strength"), "Table 1"
    return pages.printed("2", f"{line} | all", "rated_break_strength"), "Table 2"


SOLVED = (K_1, TIME)

_UNIT = {K_AP: 1e4, ENERGY: 1.0, K_1: 1e4, TIME: 1.0}

_TABLES = {
    "new": {K_AP: "3", ENERGY: "11", K_1: "14", TIME: "17"},
    f"{POLYESTER_BRAID} | 5 years": {K_AP: "5", ENERGY: "13", K_1: "16", TIME: "19"},
}

_EXPOSED_CENTRE = (1470.0, 595.0)

_FREEDOM = 5


@dataclass(frozen=True)
@read_only_arrays
class Closure:
    """Coefficients that follow from one slow pull, and their standard errors; shape (10,).

    In the printed unit.
    """

    slow_pull: str
    coefficient: Floats
    standard_error: Floats


@lru_cache(maxsize=1024)
def closure_of(pages: Pages, row: str, quantity: str) -> tuple[Closure, ...] | None:
    """Coefficients of a column that follow from K_ap, H and each K_0 of a line.

    One for each slow pull; None where the line has not all four surfaces.

    Examples
    --------
    B6 of K_1 of new plaited nylon, printed as .756:

    >>> from reduction.published.printed_cells import cells_of
    >>> pages = Pages(cells_of("CG-D-39-80"))
    >>> row = "nylon | 8-strand plaited | 1/2 in | new"
    >>> for one in closure_of(pages, row, "dissipation_spring_constant"):
    ...     print(one.slow_pull, one.coefficient[5].round(3), one.standard_error[5].round(3))
    cubic of K_0 1.11 0.03
    slope of load 1.016 0.03
    """
    tables = _TABLES["new"] if row in CENTRE_LINES else _TABLES.get(row)
    if tables is None:
        return None
    coded = box_behnken(3).coded
    terms = model_matrix(coded, quadratic_exponents(3))
    frequency, mean, amplitude = _levels_of_runs(pages, row, coded)
    printed = pages.surface(tables[quantity], row, quantity)
    scatter = _scatter(terms, printed, pages.value(tables[quantity], row, f"{quantity} r2"))
    found = []
    for label, rest in _slow_pulls(pages, row).items():
        line = identify_by_amplitude(
            apparent_spring_constant=_UNIT[K_AP] * (terms @ pages.surface(tables[K_AP], row, K_AP)),
            hysteresis_energy=terms @ pages.surface(tables[ENERGY], row, ENERGY),
            tension_amplitude=amplitude,
            frequency=frequency,
            quasi_static_spring_constant=np.array([rest(float(one)) for one in mean]),
        )
        solved: Floats = (
            line.dissipation_spring_constant if quantity == K_1 else line.relaxation_time
        ) / _UNIT[quantity]
        good = np.isfinite(solved)
        if np.linalg.matrix_rank(terms[good]) == terms.shape[1]:
            refit = np.linalg.lstsq(terms[good], solved[good], rcond=None)[0]
            left = float(np.sqrt(np.sum((solved - terms @ refit)[good] ** 2) / _FREEDOM))
            error = np.hypot(scatter, left) * np.sqrt(np.diag(np.linalg.inv(terms.T @ terms)))
            found.append(Closure(label, np.asarray(refit, dtype=np.float64), error))
    return tuple(found) or None


def _levels_of_runs(pages: Pages, row: str, coded: Floats) -> tuple[Floats, Floats, Floats]:
    """Frequency [Hz], mean tension and amplitude [lb] of the runs."""
    centre = CENTRE_LINES[row][1:] if row in CENTRE_LINES else _EXPOSED_CENTRE
    place = levels_of(row)
    columns = [0.3 + 0.2 * coded[:, 0]]
    for factor, name in enumerate(("mean_tension", "tension_amplitude"), start=1):
        low, middle, high = (
            pages.value("1", place, f"{name} {end}") for end in ("low", "centre", "high")
        )
        half = centre[factor - 1] * (high - low) / 2 / middle
        columns.append(centre[factor - 1] + half * coded[:, factor])
    frequency, mean, amplitude = columns
    return frequency, mean, amplitude


def _slow_pulls(pages: Pages, row: str) -> dict[str, Callable[[float], float]]:
    """K_0 [lb] at a tension, by the cubic of K_0 and by the slope of load on strain."""
    if row not in CENTRE_LINES:
        exposure = row.replace("5 years", "field exposure")
        return {
            "cubic of K_0": lambda tension: pages.polynomial("7", exposure, tension),
            "slope of load": lambda tension: pages.slope("9", row, tension),
        }
    table = CENTRE_LINES[row][0]
    by_slope: dict[str, Callable[[float], float]] = {
        "slope of load": lambda tension: pages.slope("8", row, tension)
    }
    if table == "slope":
        # two prints of this cubic differ, and it is open which is right
        return by_slope | {"slope of load, Table 9": lambda tension: pages.slope("9", row, tension)}
    return {"cubic of K_0": lambda tension: pages.polynomial(table, row, tension)} | by_slope


def _scatter(terms: Floats, printed: Floats, r2: float) -> float:
    """Standard deviation of a run about a column with this r2; NaN where r2 is not a share."""
    if not 0 < r2 < 1:
        return float("nan")
    fitted = terms @ printed
    explained = float(np.sum((fitted - fitted.mean()) ** 2))
    return float(np.sqrt(explained * (1 - r2) / r2 / _FREEDOM))

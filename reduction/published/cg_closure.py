r"""CG-D-39-80: K_1 and tau of a column compared with K_ap, H and K_0 of the same line.

At the 15 runs of the design, K_1 and tau are solved from the printed surfaces of K_ap and H and
from a slow pull, and the quadratic is fitted to them again.  A printed coefficient differs from the
refitted one by at most its standard error, which follows from the r2 of its own column:

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

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from reduction.experiments.designs import box_behnken, model_matrix, quadratic_exponents
from reduction.published.cg_cells import (
    CENTRE_LINES,
    ENERGY,
    K_1,
    K_AP,
    POLYESTER_BRAID,
    TIME,
    Pages,
    levels_of,
)
from reduction.record.measurement import Floats, read_only_arrays
from reduction.stages.three_parameter_line.line_model import identify_by_amplitude

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

    Parameters
    ----------
    pages : Pages
        All cells of the report.
    row : str
        A new line, or the polyester braid after five years.
    quantity : str
        K_1 or tau.

    Returns
    -------
    closures : tuple of Closure or None
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
    frequency, mean, amplitude = _levels(pages, row, coded)
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


def _levels(pages: Pages, row: str, coded: Floats) -> tuple[Floats, Floats, Floats]:
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

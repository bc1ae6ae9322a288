"""Cells of CG-D-39-80 by their place, and what several of its tables need to be recomputed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from reduction.errors import DataError
from reduction.line.cubic import slope_of_cubic
from reduction.published.cell import Cell, number_of, printed_step
from reduction.record import Floats
from reduction.reproduce.item import Item, not_testable

POLYNOMIAL_SCALES = np.array([1e4, 1.0, 1e-3, 1e-7])
"""Of A, B, C, D of Tables 6 and 7: to pounds."""
CUBIC_SCALES = np.array([1e-4, 1e-4, 1e-8, 1e-12])
"""Of A, B, C, D of Tables 8 and 9: strain, and pounds."""


def number(cell: Cell) -> float:
    """The number of a cell as printed.

    Raises
    ------
    DataError
        If it holds none.
    """
    found = number_of(cell.printed)
    if found is None:
        raise DataError("a cell holds no number", found=f"{'/'.join(cell.key)}: {cell.printed}")
    return found


class Pages:
    """The cells of a report by table, row and column."""

    def __init__(self, cells: Iterable[Cell]) -> None:
        self.by_key = {cell.key: cell for cell in cells}

    def cell(self, table: str, row: str, column: str) -> Cell:
        """One cell.

        Raises
        ------
        DataError
            If there is none.
        """
        found = self.by_key.get((table, row, column))
        if found is None:
            raise DataError("no such cell", found=f"{table} / {row} / {column}")
        return found

    def printed(self, table: str, row: str, column: str) -> float:
        """Number of a cell as the page has it."""
        return number(self.cell(table, row, column))

    def value(self, table: str, row: str, column: str) -> float:
        """Number of a cell as corrected, or as printed where nothing is corrected."""
        cell = self.cell(table, row, column)
        return number(cell) if cell.corrected is None else cell.corrected

    def half(self, table: str, row: str, column: str) -> float:
        """Half the last digit of a cell."""
        return 0.5 * printed_step(self.cell(table, row, column).printed)

    def surface(self, table: str, row: str, quantity: str) -> Floats:
        """B1 .. B10, as corrected; an open coefficient as this table prints it."""
        return np.array([self.value(table, row, f"{quantity} B{i}") for i in range(1, 11)])

    def cubic(self, table: str, row: str) -> Floats:
        """A .. D of strain, in strain and pounds."""
        terms = [self.value(table, row, f"quasi_static_strain {term}") for term in "ABCD"]
        return np.asarray(np.array(terms) * CUBIC_SCALES, dtype=np.float64)

    def slope(self, table: str, row: str, tension: float) -> float:
        """K_0 [lb] as the slope of a load-strain cubic."""
        return float(slope_of_cubic(tension, self.cubic(table, row)))

    def polynomial(self, table: str, row: str, tension: float) -> float:
        """K_0 [lb] by the polynomial of Table 6 or 7."""
        terms = [self.value(table, row, f"quasi_static_spring_constant {term}") for term in "ABCD"]
        return float(tension ** np.arange(4) @ (np.array(terms) * POLYNOMIAL_SCALES))

    def strain(self, table: str, row: str, tension: float) -> float:
        """Strain at a tension [lb], by the cubic."""
        return float(tension ** np.arange(4) @ self.cubic(table, row))


Check = Callable[[Cell, Pages], Item]
"""Verdict on one claim of the text among all cells."""


def always(why: str) -> Check:
    """The check of a claim that nothing in the report determines."""
    return lambda cell, pages: not_testable(cell, why)


def rounding(
    function: Callable[..., float], values: Sequence[float], halves: Sequence[float]
) -> float:
    """By how much the rounding of its inputs may move a result.

    Parameters
    ----------
    function : callable
        Of as many numbers as there are values.
    values, halves : sequence of float
        Inputs as printed, and half their last digits.

    Returns
    -------
    allowance : float
        Sum over the inputs, each at the end of its interval that moves the result most.

    Examples
    --------
    >>> rounding(lambda mean, deviation: deviation / mean, [100.0, 10.0], [0.5, 0.5])
    0.0055
    """
    centre = function(*values)
    total = 0.0
    for place, half in enumerate(halves):
        moved = []
        for sign in (-1, 1):
            inputs = list(values)
            inputs[place] += sign * half
            moved.append(abs(function(*inputs) - centre))
        total += max(moved)
    return total

"""Moduli of WHOI-2005-10 again: every row of Tables 5 and 6 is a chord on one area.

The printed limits are what the authors divided, so they carry no rounding of their own; the
modulus does, and every row therefore says between which two areas it was made.  The rows of a
table that have nothing against them share a narrow range; each is held against that of the others.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from reduction.moduli.secant import chord_modulus
from reduction.published.cell import Cell, printed_step
from reduction.reproduce.item import Item, judge, not_testable
from reduction.reproduce.tether_rows import Row, rows_of

HIGH, LOW = "segment_tension_high", "segment_tension_low"
UPPER, LOWER = "segment_strain_high", "segment_strain_low"
MODULUS = "segment_modulus"
_HALF_A_PSI = 0.5
_COPIED = "WH5-6"
# of each number from the other four and the area, pound-force, inch and psi throughout
_FROM_OTHERS: dict[str, Callable[[dict[str, float]], float]] = {
    HIGH: lambda at: at[LOW] + at[MODULUS] * at["area"] * (at[UPPER] - at[LOWER]),
    LOW: lambda at: at[HIGH] - at[MODULUS] * at["area"] * (at[UPPER] - at[LOWER]),
    UPPER: lambda at: at[LOWER] + (at[HIGH] - at[LOW]) / (at[MODULUS] * at["area"]),
    LOWER: lambda at: at[UPPER] - (at[HIGH] - at[LOW]) / (at[MODULUS] * at["area"]),
    MODULUS: lambda at: float(
        chord_modulus(at[LOWER], at[UPPER], at[LOW], at[HIGH], area=at["area"])
    ),
}


def shared_area(rows: Sequence[Row]) -> tuple[float, float]:
    """Range of area on which every row rounds to its printed modulus.

    Parameters
    ----------
    rows : sequence of Row
        Of Tables 5 or 6, one tether, with nothing against them.

    Returns
    -------
    low, high : float
        Low above high where no one area does. [in2]
    """
    low, high = 0.0, float("inf")
    for row in rows:
        slope = (row[HIGH] - row[LOW]) / (row[UPPER] - row[LOWER])
        low = max(low, slope / (row[MODULUS] + _HALF_A_PSI))
        high = min(high, slope / (row[MODULUS] - _HALF_A_PSI))
    return low, high


def _sound(rows: Sequence[Row], tether: str) -> list[Row]:
    """Rows of which no number is corrected or open."""
    return [
        row
        for row in rows
        if row.tether == tether and not any(cell.confidence for cell in row.cells.values())
    ]


def areas_of_tables(*tables: Sequence[Cell]) -> dict[str, tuple[float, ...]]:
    """Area of each tether that each table implies.

    Parameters
    ----------
    *tables : sequence of Cell
        Tables 5 and 6.

    Returns
    -------
    areas : dict of str to tuple of float
        By tether, the middle of what its sound rows share, one a table. [in2]
    """
    return {
        tether: tuple(sum(shared_area(_sound(rows_of(cells), tether))) / 2 for cells in tables)
        for tether in ("new", "used")
    }


def items_of_segments(cells: Sequence[Cell]) -> Iterator[Item]:
    """Table 5 or Table 6.

    Parameters
    ----------
    cells : sequence of Cell
        Of one of them.

    Yields
    ------
    item : Item
        Each number from the other four of its row and the area that the other rows share. Its
        tolerance carries half the last digit of the modulus and of every corrected number, and
        half the range of area.
    """
    rows = rows_of(cells)
    for row in rows:
        low, high = shared_area([one for one in _sound(rows, row.tether) if one is not row])
        area, half_range = (low + high) / 2, abs(high - low) / 2
        given = {column: row[column] for column in row.cells} | {"area": area}
        half = {"area": half_range, MODULUS: _HALF_A_PSI} | {
            column: 0.5 * printed_step(f"{cell.corrected}")
            for column, cell in row.cells.items()
            if cell.corrected is not None
        }
        for column, cell in row.cells.items():
            if cell.erratum == _COPIED and cell.confidence == "open":
                yield not_testable(cell, "agrees with its row, which is that of the new tether")
                continue
            if not cell.erratum and any(one.confidence == "open" for one in row.cells.values()):
                yield not_testable(cell, "modulus and strains of its row contradict each other")
                continue
            recomputed = _FROM_OTHERS[column](given)
            carried = sum(
                abs(_FROM_OTHERS[column](given | {name: given[name] + step}) - recomputed)
                for name, step in half.items()
                if name != column
            )
            if column == MODULUS:
                how = f"chord of the limits on {area:.4f} in2, which the other rows share"
                carried += _HALF_A_PSI
            else:
                how = f"modulus and the other limits on {area:.4f} in2, which the other rows share"
            yield judge(cell, recomputed, how, tolerance=carried)

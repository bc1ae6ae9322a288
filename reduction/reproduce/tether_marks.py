"""Diameters, splice marks and weights of WHOI-2005-10: Tables 2 to 4 again.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import pi, sqrt

import numpy as np

from reduction.published.cell import Cell
from reduction.reproduce.item import Item, judge, not_testable
from reduction.reproduce.tether_rows import Row, rows_of
from reduction.strain.splice import free_length_fraction, free_length_strain
from reduction.strain.stress import constant_volume_diameter

_PART = {
    "splice_fraction near": "splice_length near",
    "free_fraction": "free_length",
    "splice_fraction far": "splice_length far",
}
_STRETCHED = "measured at three places of the tether; {:.3f} in at constant volume"
_TIMES = "time of a reading, later than the one before"


def items_of_diameters(
    cells: Sequence[Cell], areas: Mapping[str, Sequence[float]]
) -> Iterator[Item]:
    """Table 2.

    Parameters
    ----------
    cells : sequence of Cell
        Of Table 2.
    areas : mapping of str to sequence of float
        By tether, what Tables 5 and 6 imply. [in2]

    Yields
    ------
    item : Item
    """
    for row in rows_of(cells):
        implied = areas[row.tether]
        before = float(np.mean([sqrt(4 * area / pi) for area in implied]))
        for column, cell in row.cells.items():
            if column == "diameter":
                how = "round section of the areas that the rows of Tables 5 and 6 share, "
                yield judge(cell, before, how + " and ".join(f"{one:.4f}" for one in implied))
            else:
                strain = float(column.split()[2]) / 100
                stretched = before / constant_volume_diameter([strain], [1.0])[0]
                yield not_testable(cell, _STRETCHED.format(stretched))


def items_of_marks(cells: Sequence[Cell]) -> Iterator[Item]:
    """Table 3.

    Parameters
    ----------
    cells : sequence of Cell
        Of Table 3.

    Yields
    ------
    item : Item
    """
    rows = rows_of(cells)
    for row in rows:
        own = [one for one in rows if one.tether == row.tether and "far_thimble" in one.cells]
        stretched = own[1:]
        for column, cell in row.cells.items():
            if "far_thimble" not in row.cells:
                share = [100 * one[_PART[column]] / one["far_thimble"] for one in stretched]
                yield judge(cell, float(np.mean(share)), "mean of the three stretched rows")
            else:
                yield judge(cell, *_mark(column, row, own, stretched))


def _mark(column: str, row: Row, own: Sequence[Row], stretched: Sequence[Row]) -> tuple[float, str]:
    if column in _PART:
        return 100 * row[_PART[column]] / row["far_thimble"], "share of the far thimble's position"
    slack = own[0]["free_length"]
    match column:
        case "target_strain":
            others = [one for one in stretched if one is not row]
            line = np.polynomial.Polynomial.fit(
                [one["far_thimble"] for one in others], [one[column] for one in others], 1
            )
            return float(line(row["far_thimble"])), "line of stretch on position, other rows"
        case "near_toe":
            return row["splice_length near"], "the near splice, printed again"
        case "far_toe":
            return row["near_toe"] + row["free_length"], "near toe and free length"
        case "far_thimble":
            return row["far_toe"] + row["splice_length far"], "far toe and far splice"
        case "splice_length near":
            return row["near_toe"], "the near toe, printed again"
        case "free_length":
            return row["far_toe"] - row["near_toe"], "difference of the marks"
        case "splice_length far":
            return row["far_thimble"] - row["far_toe"], "difference of the marks"
        case "mark_strain actual":
            return 100 * (row["free_length"] / slack - 1), "free length over that of the slack row"
    share = free_length_fraction(
        [one["free_length"] for one in stretched], [one["far_thimble"] for one in stretched]
    )
    strain = free_length_strain(row["far_thimble"], free_fraction=share, relaxed_free_length=slack)
    return 100 * float(strain), "constant-fraction: one mean free share of the stretched rows"


def static_gauge_length(rows: Sequence[Row]) -> tuple[float, float]:
    """Range of gauge length that rounds to the elongations of Table 4.

    Parameters
    ----------
    rows : sequence of Row
        Of Table 4.

    Returns
    -------
    low, high : float
        Low above high where no one length does. [in]

    Notes
    -----
    All fifteen rows of [1]_, with 15.38 in at 1325, share 6.1270 to 6.1305 in: 6 1/8 in to two
    decimals, as the other lengths are printed.
    """
    length = np.array([one["length"] for one in rows])
    stretch = 1 + np.array([one["strain"] for one in rows]) / 100
    return float(np.max(length / (stretch + 0.005))), float(np.min(length / (stretch - 0.005)))


def items_of_weights(cells: Sequence[Cell]) -> Iterator[Item]:
    """Table 4.

    Parameters
    ----------
    cells : sequence of Cell
        Of Table 4.

    Yields
    ------
    item : Item
    """
    rows = rows_of(cells)
    for place, row in enumerate(rows):
        others = [one for one in rows if one is not row]
        low, high = static_gauge_length(others)
        gauge, half = (low + high) / 2, abs(high - low) / 2
        for column, cell in row.cells.items():
            match column:
                case "clock":
                    if place and cell.printed <= rows[place - 1].cells["clock"].printed:
                        yield Item(cell, float("nan"), "unexplained", "earlier than the row before")
                    else:
                        yield not_testable(cell, _TIMES)
                case "tension":
                    # what was hung is taken off again, in the opposite order
                    twin = rows[-1 - place]
                    if twin is row:
                        yield not_testable(cell, "the greatest weight, printed once")
                    else:
                        yield judge(cell, twin["tension"], f"the same weight, {twin.branch}")
                case "length":
                    stretch = 1 + row["strain"] / 100
                    yield judge(
                        cell,
                        gauge * stretch,
                        f"printed elongation on {gauge:.3f} in, which the other rows share",
                        tolerance=0.005 * gauge + half * stretch,
                    )
                case "strain":
                    yield judge(
                        cell,
                        100 * (row["length"] / gauge - 1),
                        f"length over {gauge:.3f} in, which the other rows share",
                        tolerance=0.5 + 100 * half * row["length"] / gauge**2,
                    )
                case _:
                    line = np.polynomial.Polynomial.fit(
                        [one["length"] for one in others], [one[column] for one in others], 1
                    )
                    miss = [line(one["length"]) - one[column] for one in others]
                    yield not_testable(
                        cell,
                        f"measured; {line(row['length']):.1f} in by the line through the other "
                        f"rows, which scatter by {np.std(miss, ddof=2):.1f} in",
                    )

"""Settings of Zhang (2015) that its tables and its equations are recomputed with."""

from __future__ import annotations

from math import pi

from reduction.published.cell import Cell
from reduction.published.read import cells_of

LENGTH, PERIOD, SPEED, HEIGHT = 20.0, 3.57, 5.6, 1.25
"""Table 4. [m], [s], [m/s], [m]."""
NUMBER, FREQUENCY = 2 * pi / LENGTH, 2 * pi / PERIOD
"""Of the wave in space [rad/m], and in time [rad/s]; Table 4 prints 1.93 for the latter."""
DEPTH = 6.0
"""Of the example of the Airy theory. [m]."""
GRAVITY = 9.8
"""Not printed. [m/s2]."""


def cells_of_table(table: str) -> list[Cell]:
    """Cells of one table of the paper."""
    return [cell for cell in cells_of("Zhang-2015") if cell.table == table]

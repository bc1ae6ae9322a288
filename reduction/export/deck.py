"""A deck in the grammar of MoorDyn: one line type, and one line of it to try it with.

References
----------
.. [1] MoorDyn documentation, "Input Files", v2.7.1, 2026.
"""

from __future__ import annotations

import math

from reduction.export.header import number
from reduction.export.product import ExportLine

__all__ = ["NO_GRAVITY", "SEGMENT_LENGTH", "WEIGHTLESS", "deck", "line_type"]

_LENGTH, _SEGMENTS = 10.0, 5
SEGMENT_LENGTH = _LENGTH / _SEGMENTS
"""Of the line of a deck. [m]"""
NO_GRAVITY = "0 g"
WEIGHTLESS = (
    f"NO GRAVITY in this deck ({NO_GRAVITY}), so that its tension is that of its strain: put 9.81, "
    "or take the line type into a deck of your own"
)
_COURANT = 0.1
_SHORTEST_STEP, _LONGEST_STEP = 1e-4, 0.02
_COLUMNS = (
    "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
    "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
)


def line_type(line: ExportLine, stiffness: str, damping: str) -> str:
    """Return the row of the line types."""
    water = line.hydrodynamics
    numbers = (water.normal_drag, water.normal_added_mass, water.axial_drag, water.axial_added_mass)
    diameter, mass = line.volume_diameter[0], line.needed("linear_density")
    row = (line.identifier, number(diameter), number(mass), stiffness, damping, "0")
    return " ".join((*row, *map(number, numbers)))


def deck(
    line: ExportLine,
    row: str,
    head: list[str],
    *,
    strain: float,
    stiffness: float,
    damping: float = 0.0,
    conditions: tuple[str, ...] = (),
) -> str:
    """A whole input file: one line between two points, with a strain that it may have.

    Parameters
    ----------
    line : ExportLine
        For its name.
    row : str
        Of `line_type`.
    head : list of str
        Front matter.
    strain : float
        At the start. [1]
    stiffness : float
        Greatest slope of tension over strain; it limits the time step. [N]
    damping : float
        Of the fast spring; it does so too. 0 where it is numerical. [N s]
    conditions : tuple of str
        Section of initial conditions, where the form needs one.

    Returns
    -------
    text : str
        Point 1 is fixed, point 2 is coupled; 10 m of line. Gravity is left out, so that the
        tension is that of the strain.
    """
    segments, step = _steps(line.needed("linear_density"), stiffness, damping)
    top = -100.0 + _LENGTH * (1 + strain)
    rule = "-" * 22
    return "\n".join(
        [
            "MoorDyn input file with one line type, in a deck that tries it",
            WEIGHTLESS,
            *head,
            f"{rule} LINE TYPES {rule}",
            *_COLUMNS,
            row,
            f"{rule} POINTS {rule}",
            "ID Attachment X Y Z Mass Volume CdA Ca",
            "(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)",
            "1 Fixed 0 0 -100 0 0 0 0",
            f"2 Coupled 0 0 {number(top)} 0 0 0 0",
            f"{rule} LINES {rule}",
            "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
            "(-) (name) (ID) (ID) (m) (-) (-)",
            f"1 {line.identifier} 1 2 {number(_LENGTH)} {segments} -",
            *conditions,
            f"{rule} OPTIONS {rule}",
            "0 writeLog",
            "1 disableOutTime",
            NO_GRAVITY,
            "200 WtrDpth",
            f"{step:.3g} dtM",
            "10 TmaxIC",
            "0.1 dtIC",
            f"{rule} OUTPUTS {rule}",
            "FairTen1",
            "AnchTen1",
            f"{rule} need this line {rule}",
            "",
        ]
    )


def _steps(mass: float, stiffness: float, damping: float) -> tuple[int, float]:
    """Segments of the deck and a stable time step; one segment where five ask for a tiny one."""
    step = _COURANT * SEGMENT_LENGTH * math.sqrt(mass / stiffness)
    if damping > 0:
        step = min(step, _COURANT * mass * SEGMENT_LENGTH**2 / damping)
    if step < _SHORTEST_STEP:
        return 1, _LONGEST_STEP  # no node is free
    return _SEGMENTS, min(step, _LONGEST_STEP)

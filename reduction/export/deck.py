"""A deck in the grammar of MoorDyn: one line type, and one line of it to try it with.

References
----------
.. [1] MoorDyn documentation, "Input Files", v2.7.1, 2026.
"""

from __future__ import annotations

import math

from reduction.export.header import number
from reduction.export.product import ExportLine

_LENGTH, _SEGMENTS = 10.0, 5
NO_GRAVITY = "0 g"
WEIGHTLESS = (
    f"NO GRAVITY in this deck ({NO_GRAVITY}), so that its tension is that of its strain: put 9.81, "
    "or take the line type into a deck of your own"
)
_COURANT = 0.1
_DEPTH = 100.0
_SHORTEST_STEP, _LONGEST_STEP = 1e-4, 0.02
_COLUMNS = (
    "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
    "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
)


def _length(line: ExportLine) -> float:
    """Of the line of a deck: its own where it has one. [m]."""
    return line.unstretched_length if math.isfinite(line.unstretched_length) else _LENGTH


def segment_length(line: ExportLine) -> float:
    """Length of a segment of the line of a deck. [m]."""
    return _length(line) / _SEGMENTS


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
    program: str = "MoorDyn",
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
    program : str
        That the first line names; no grammar reads it.

    Returns
    -------
    text : str
        Point 1 is fixed, point 2 is coupled; the unstretched length of the line, 10 m where it
        has none. Gravity is left out, so that the tension is that of the strain.
    """
    length = _length(line)
    segments, step = _steps(line.needed("linear_density"), stiffness, damping, segment_length(line))
    # the upper end stays under water however long the line is
    depth = max(_DEPTH, 2 * length * (1 + strain))
    top = length * (1 + strain) - depth
    rule = "-" * 22
    return "\n".join(
        [
            f"{program} input file with one line type, in a deck that tries it",
            WEIGHTLESS,
            *head,
            f"{rule} LINE TYPES {rule}",
            *_COLUMNS,
            row,
            f"{rule} POINTS {rule}",
            "ID Attachment X Y Z Mass Volume CdA Ca",
            "(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)",
            f"1 Fixed 0 0 {number(-depth)} 0 0 0 0",
            f"2 Coupled 0 0 {number(top)} 0 0 0 0",
            f"{rule} LINES {rule}",
            "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
            "(-) (name) (ID) (ID) (m) (-) (-)",
            f"1 {line.identifier} 1 2 {number(length)} {segments} -",
            *conditions,
            f"{rule} OPTIONS {rule}",
            "0 writeLog",
            "1 disableOutTime",
            NO_GRAVITY,
            f"{number(2 * depth)} WtrDpth",
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


def _steps(mass: float, stiffness: float, damping: float, apart: float) -> tuple[int, float]:
    """Segments of the deck and a stable time step; one segment where five ask for a tiny one."""
    step = _COURANT * apart * math.sqrt(mass / stiffness)
    if damping > 0:
        step = min(step, _COURANT * mass * apart**2 / damping)
    if step < _SHORTEST_STEP:
        return 1, _LONGEST_STEP  # no node is free
    return _SEGMENTS, min(step, _LONGEST_STEP)

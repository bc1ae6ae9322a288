"""Abaqus: uniaxial test data of a hyperelastic material, nominal stress first.

References
----------
.. [1] Dassault Systemes, "Abaqus Keywords Reference Guide": HYPERELASTIC, UNIAXIAL TEST DATA.
"""

from __future__ import annotations

import math

from reduction.export.header import header_lines, real_number
from reduction.export.product import ExportLine
from reduction.export.thin import thin_curve

ABAQUS_POINTS = 200
"""Rows of a table. [1]"""


def abaqus_text(line: ExportLine) -> str:
    """A material for Abaqus, nominal stress and nominal strain.

    Parameters
    ----------
    line : ExportLine
        What is exported.

    Returns
    -------
    text : str
        All of it.

    Raises
    ------
    SettingsError
        If the diameter is not known.
    DataError
        If the curve cannot be exported.

    Notes
    -----
    Stress is tension over the area at zero tension, of the nominal diameter.  The potential of
    Marlow takes the data as they are; it needs the origin among them.
    """
    curve = thin_curve(line.strain, line.tension, most=ABAQUS_POINTS)
    diameter = line.needed("diameter")
    area = math.pi / 4 * diameter**2
    head = header_lines(
        line,
        curve,
        f"nominal stress in Pa: tension over {area:.6g} m2, of the nominal diameter "
        f"{1000 * diameter:.4g} mm at zero tension; nominal strain",
        f"greatest error in stress {curve.error / area:.3g} Pa",
        "stress stands before strain",
    )
    rows = [
        f"{real_number(t / area)}, {real_number(e)}"
        for e, t in zip(curve.strain, curve.tension, strict=True)
    ]
    text = [f"** {one}" for one in head]
    text += [f"*MATERIAL, NAME={_name(line)}", "*HYPERELASTIC, MARLOW", "*UNIAXIAL TEST DATA"]
    return "\n".join([*text, *rows, ""])


def _name(line: ExportLine) -> str:
    """A label of Abaqus begins with a letter and has at most 80 signs."""
    name = line.identifier.replace("-", "_")[:78]
    return name if name[0].isalpha() else f"M_{name}"

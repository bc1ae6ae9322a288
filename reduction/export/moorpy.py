"""MoorPy: its deck with a table, and its library of line properties.

What MoorPy 1.3 does with a file that is not to its liking, and what is done here about it:

* a file of the EA column is opened without its first and last sign, and only where the name holds
  ``.txt``; anything else becomes 1,000 MN without a word: ``|name.txt|`` is written;
* the table ends at a line with ``---``; without it, or with a line after it, reading fails;
* the table is sought in the working folder: the header says so;
* the slope of the dynamic stiffness is ``EAD_LM`` in 1.3 and ``EAd_MBL_Lm`` in its own list of
  names: both are written;
* a least or greatest diameter in the library ends in an error: none is written.

References
----------
.. [1] NREL, "MoorPy documentation", v1.3.0.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from reduction.digits import plain_number
from reduction.errors import SettingsError
from reduction.export.deck import deck, line_type
from reduction.export.header import header_lines, number, real_number
from reduction.export.moordyn import MOST_POINTS, NUMERICAL_DAMPING, table_text
from reduction.export.product import ExportLine
from reduction.export.thin import thin_curve

MoorPyForm = Literal["table", "library"]


def moorpy_files(line: ExportLine, stem: str, *, form: MoorPyForm = "table") -> dict[str, str]:
    """Files of a line type for MoorPy, the deck or the library first.

    Parameters
    ----------
    line : ExportLine
        What is exported.
    stem : str
        Of the name of the table.
    form : {"table", "library"}
        ``table``: a deck with the curve. ``library``: YAML, static and dynamic stiffness over the
        break strength; linear only.

    Returns
    -------
    files : dict of str to str
        Text by name; the key of the deck or library is empty.

    Raises
    ------
    SettingsError
        If the line has not what the form needs, or the form is not known.
    DataError
        If the curve cannot be exported.
    """
    if form == "library":
        return {"": _library(line)}
    if form != "table":
        raise SettingsError(
            "the form of a MoorPy line is not known", found=repr(form), needed="table or library"
        )
    curve, table = thin_curve(line.strain, line.tension, most=MOST_POINTS), f"{stem}_moorpy.txt"
    row = line_type(line, f"|{table}|", number(NUMERICAL_DAMPING))
    head = header_lines(
        line,
        curve,
        line.volume_diameter[1],
        f"hydrodynamic coefficients: {line.hydrodynamics.source}",
        f"MoorPy seeks {table} in the working folder: start it there",
        "with a table MoorPy takes the line as straight, and halves its weight to the ends",
    )
    steepest = float(np.max(np.diff(curve.tension) / np.diff(curve.strain)))
    text = deck(
        line, row, head, strain=float(line.strain[-1]) / 2, stiffness=steepest, program="MoorPy"
    )
    return {"": text, table: f"{table_text(line, curve)}\n---"}


def _library(line: ExportLine) -> str:
    part = line.viscoelasticity
    if part is None:
        raise SettingsError(
            f"static and dynamic stiffness of {line.name} are not known",
            needed="K_0, K_1 and tau of a published line, which are taken at --frequency, "
            "--mean-tension and --tension-amplitude: the library of MoorPy is linear",
            hint="Export the curve instead: --form table.",
        )
    strength, diameter = line.needed("rated_break_strength"), line.needed("diameter")
    mass, water = line.needed("linear_density"), line.hydrodynamics
    beta = part.dynamic_stiffness_per_mean_tension
    volume, words = line.volume_diameter
    head = header_lines(
        line,
        None,
        words,
        f"hydrodynamic coefficients: {water.source}",
        f"holds for the diameter {1000 * diameter:.4g} mm alone: nothing is known of others",
        f"found at {part.holds}" if part.holds else "",
        "the dynamic stiffness is K_ap at that frequency, since the library has no damping; "
        f"K_0 + K_1, that of fast cycles, is {plain_number(part.fast_stiffness, 6)} N"
        if math.isfinite(part.frequency)
        else "",
    )
    slow = part.apparent_stiffness - part.fast_stiffness
    rows = {
        "mass_d2": mass / diameter**2,
        "MBL_d2": strength / diameter**2,
        "EA_MBL": part.static_stiffness / strength,
        "EAd_MBL": (part.dynamic_stiffness + slow) / strength,
        "EAD_LM": beta,
        "EAd_MBL_Lm": beta,
        "dvol_dnom": volume / diameter,
        "Cd": water.normal_drag,
        "Cd_ax": water.axial_drag,
        "Ca": water.normal_added_mass,
        "Ca_ax": water.axial_added_mass,
    }
    text = [f"    {name}: {real_number(value)}" for name, value in rows.items()]
    return "\n".join(
        [f"# {one}" for one in head] + ["lineProps:", f'  "{line.identifier}":', *text, ""]
    )

"""OrcaFlex: a line type with a variable axial stiffness, as text YAML.  Syntax checked only.

OrcaFlex is closed and was not run; the keys are those of its text files, tension in kN, mass in
tonnes.  A table of axial stiffness is strain against wall tension, which this is where internal
and external pressure have no part in the tension that was measured.

References
----------
.. [1] Orcina Ltd., "OrcaFlex Help," version 11.6: line types, variable data, text data files.
"""

from __future__ import annotations

from reduction.export.header import header_lines, real_number
from reduction.export.product import ExportLine
from reduction.export.thin import thin_curve

ORCAFLEX_POINTS = 100
"""Rows of a table. [1]"""
_PER_KILO = 1e-3


def orcaflex_text(line: ExportLine) -> str:
    """A text data file for OrcaFlex.

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
        If diameter or mass is not known.
    DataError
        If the curve cannot be exported.
    """
    curve = thin_curve(line.strain, line.tension, most=ORCAFLEX_POINTS)
    volume, words = line.volume_diameter
    mass, water = line.needed("linear_density"), line.hydrodynamics
    head = header_lines(
        line,
        curve,
        "syntax checked only: OrcaFlex was not run, look at the line type before it is used",
        words,
        f"hydrodynamic coefficients: {water.source}",
        "bending and torsion stiffness 0: not measured",
        "units of the file: kN, te, m",
    )
    name = f"{line.identifier} axial stiffness"
    rows = [
        f"        - [{real_number(e)}, {real_number(_PER_KILO * t)}]"
        for e, t in zip(curve.strain, curve.tension, strict=True)
    ]
    text = [
        "%YAML 1.1",
        "# Type: Model",
        "# Program: OrcaFlex 11.6b",
        *(f"# {one}" for one in head),
        "---",
        "General:",
        "  UnitsSystem: SI",
        "VariableData:",
        "  Axialstiffness:",
        f'    - Name: "{name}"',
        "      IndependentValue, DependentValue:",
        *rows,
        "LineTypes:",
        f'  - Name: "{line.identifier}"',
        "    Category: General",
        f"    OD: {real_number(volume)}",
        "    ID: 0.0",
        f"    MassPerUnitLength: {real_number(_PER_KILO * mass)}",
        "    EIx: 0.0",
        "    EIy: ~",
        f'    EA: "{name}"',
        "    GJ: ~",
        "    PoissonRatio: 0.5",
        f"    Cd: [{real_number(water.normal_drag)}, ~, {real_number(water.axial_drag)}]",
        f"    Ca: [{real_number(water.normal_added_mass)}, ~, "
        f"{real_number(water.axial_added_mass)}]",
        "",
    ]
    return "\n".join(text)

"""A deployed assembly for export: every node of it as a table, and as one line of its own.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 2.3.2.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from reduction.export.product import ExportLine
from reduction.export.spread import CurveSpread
from reduction.export.table import TableColumn, ValueTable, spread_columns
from reduction.pipeline.deployed import DeployedLine


def assembly_table(line: DeployedLine) -> ValueTable:
    """Return every node of an assembly: length, tension, stiffness, and what each tether carries.

    Parameters
    ----------
    line : DeployedLine
        The assembly.

    Returns
    -------
    table : ValueTable
        One column for all tethers where they are alike.
    """
    deployed, assembly = line.deployed, line.deployed.assembly
    columns = [
        TableColumn("total_length", "m", "end to end", np.array(assembly.total_length)),
        TableColumn("tension", "N", "of the assembly", np.array(assembly.tension)),
        *spread_columns(_spread_of(line), both="of the curve, at one length: of both parts"),
        TableColumn(
            "strain", "1", "of the length at which the assembly goes slack",
            np.array(deployed.strain),
        ),
        TableColumn(
            "apparent_spring_constant", "N", "EA, tangent, over that length",
            np.array(deployed.apparent_spring_constant),
        ),
        TableColumn(
            "secant_spring_constant", "N", "EA over 5 % of the length there to each side",
            np.array(deployed.secant_spring_constant),
        ),
        TableColumn("tether_length", "m", "thimble to thimble", np.array(assembly.tether_length)),
    ]  # fmt: skip
    several = [(1, "")] if line.is_equal else [
        (number, f"_{number}") for number in range(1, assembly.n_tethers + 1)
    ]  # fmt: skip
    for number, tail in several:
        which = "of each tether" if line.is_equal else f"of tether {number}"
        columns += [
            TableColumn(
                f"tether_tension{tail}", "N", f"{which}, zero where it is slack",
                np.array(assembly.tether_tension[number - 1]),
            ),
            TableColumn(
                f"tether_strain{tail}", "1", f"{which}, of its free length",
                np.array(assembly.tether_strain[number - 1]),
            ),
        ]  # fmt: skip
    columns.append(
        TableColumn(
            "is_tested", "", "every tether at a strain that a test reaches",
            np.array(assembly.is_tested),
        )
    )  # fmt: skip
    columns += [
        TableColumn("is_join", "", "pieces of a curve hand over", np.array(assembly.is_join)),
        TableColumn(
            "is_moved", "", "a curve was made to rise: the tangent is that of the rule",
            np.array(assembly.is_moved),
        ),
    ]  # fmt: skip
    return ValueTable(
        title=f"{line.name}: {line.words}",
        columns=tuple(columns),
        sources=(line.splices, *line.source.sources),
        notes=(*deployed.notes, *line.curve.notes, *line.source.notes),
        is_synthetic=line.source.is_synthetic,
        component=assembly.component,
        contribution=np.array(assembly.contribution),
    )


def _spread_of(line: DeployedLine) -> CurveSpread:
    assembly = line.deployed.assembly
    return CurveSpread(
        np.array(assembly.standard_uncertainty),
        np.array(assembly.random_standard_uncertainty),
        assembly.component,
        np.array(assembly.contribution),
    )


def line_from_assembly(line: DeployedLine, **stated: Any) -> ExportLine:
    """Make a line for export of an assembly: its strain is over the length at which it goes slack.

    Parameters
    ----------
    line : DeployedLine
        The assembly.
    **stated
        Fields of `ExportLine`; None and NaN are passed over.

    Returns
    -------
    line : ExportLine
        Whose unstretched length stands in its notes.

    Raises
    ------
    SettingsError
        If it cannot be named.

    Notes
    -----
    Diameter and mass of several tethers side by side are not those of one, and are left to be
    stated ([1]_ prints none).
    """
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    deployed, assembly = line.deployed, line.deployed.assembly
    reached = np.flatnonzero(assembly.is_tested)
    tested = (
        (float(deployed.strain[reached[0]]), float(deployed.strain[reached[-1]]))
        if reached.size
        else (math.nan, math.nan)
    )
    return ExportLine(
        name=line.name,
        strain=np.array(deployed.strain),
        tension=np.array(assembly.tension),
        curve=f"assembly of {line.words}; tension of all tethers together",
        tested=tested,
        spread=_spread_of(line),
        sources=(
            line.splices,
            *line.source.sources,
            *(f"{name.replace('_', ' ')}: stated at the export" for name in given),
        ),
        notes=(
            f"strain is of the unstretched length of the whole assembly, "
            f"{assembly.total_length[0]:.6g} m: this is the length of the line in the deck",
            *deployed.notes,
            *line.curve.notes,
            *line.source.notes,
        ),
        is_synthetic=line.source.is_synthetic,
        **{"unstretched_length": float(assembly.total_length[0])} | given,
    )

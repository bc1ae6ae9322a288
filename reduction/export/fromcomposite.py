"""A line for export from a composite curve: its rule, its pieces, its joins and gaps.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.8.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from reduction.digits import plain_number
from reduction.export.product import ExportLine
from reduction.export.spread import CurveSpread
from reduction.export.table import TableColumn, ValueTable, spread_columns
from reduction.lookup.composite import CompositeCurve
from reduction.lookup.source import PieceSource, used_of
from reduction.record import Bools

_WAYS = {
    "mean": "mean of both branches",
    "ascending": "ascending branch",
    "descending": "descending branch",
}


def ranges_of(curve: CompositeCurve, flags: Bools) -> list[tuple[float, float]]:
    """Strains between which intervals of a curve have a flag, neighbours joined. [1].

    Examples
    --------
    >>> from reduction.lookup.composite import composite_curve
    >>> from reduction.lookup.pieces import CurvePiece
    >>> at = np.array([0.5, 1.0])
    >>> curve = composite_curve([CurvePiece("T", "static", "ascending", at, 100 * at, 0 * at)])
    >>> ranges_of(curve, curve.is_gap)
    [(0.0, 0.5)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return [
        (float(curve.strain[first]), float(curve.strain[stop]))
        for first, stop in zip(edges[::2], edges[1::2], strict=True)
    ]


def composite_table(source: PieceSource, curve: CompositeCurve) -> ValueTable:
    """Return every node of a composite curve, its piece, and what is flagged below it.

    Parameters
    ----------
    source : PieceSource
        Of the pieces.
    curve : CompositeCurve
        Of them.

    Returns
    -------
    table : ValueTable
        For csv, json, latex, markdown and netcdf.
    """
    source = used_of(source, curve)
    piece = np.array([curve.piece_words[place] if place >= 0 else "" for place in curve.piece])

    def below(flags: Bools) -> Bools:
        return np.concatenate([[False], flags])

    return ValueTable(
        title=f"{source.name}: composite curve, {_WAYS[source.branch]}",
        columns=(
            TableColumn("strain", "1", "nominal strain", np.array(curve.strain)),
            TableColumn("tension", "N", "tension", np.array(curve.tension)),
            *spread_columns(
                _spread_of(curve), "of the pieces by themselves, of what is between them, and of "
                "what making the curve rise has moved",
            ),
            TableColumn("piece", "", "with the greatest weight; none in a gap", piece),
            TableColumn(
                "is_join", "", "from the node before: more than one piece has a say",
                below(curve.is_join),
            ),
            TableColumn(
                "is_gap", "", "from the node before: no piece reaches", below(curve.is_gap)
            ),
            TableColumn(
                "is_moved", "", "from the node before: not the mean of the pieces, which falls or "
                "is too soft nearby", below(curve.is_moved),
            ),
            TableColumn(
                "monotone_change", "N", "what making the curve rise has added to the mean of the "
                "pieces", np.array(curve.monotone_change),
            ),
        ),
        sources=source.sources,
        notes=(
            *([f"DOUBTFUL: {curve.doubt}"] if curve.doubt else []), *curve.notes, *source.notes,
        ),
        is_synthetic=source.is_synthetic,
        component=curve.component,
        contribution=np.array(curve.contribution),
    )  # fmt: skip


def _spread_of(curve: CompositeCurve) -> CurveSpread:
    return CurveSpread(
        np.array(curve.standard_uncertainty),
        np.array(curve.random_standard_uncertainty),
        curve.component,
        np.array(curve.contribution),
    )


def line_from_composite(source: PieceSource, curve: CompositeCurve, **stated: Any) -> ExportLine:
    """Make a line for export of a composite curve.

    Parameters
    ----------
    source : PieceSource
        Of the pieces.
    curve : CompositeCurve
        Of them.
    **stated
        Fields of `ExportLine` that are better known; None and NaN are passed over.

    Returns
    -------
    line : ExportLine
        With rule, pieces, joins and gaps in its notes.

    Raises
    ------
    SettingsError
        If the line cannot be named.

    Notes
    -----
    Tested from the first node of a piece to the last; a gap between is in the notes ([1]_).
    """
    source = used_of(source, curve)
    given = {
        name: value
        for name, value in stated.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
    first = int(np.argmax(curve.piece >= 0))
    n_tests = len(set(curve.piece_names))
    tests = f"{n_tests} tests" if n_tests > 1 else "1 test"
    joins = [
        f"{plain_number(low, 4)} to {plain_number(high, 4)}"
        for low, high in ranges_of(curve, curve.is_join)
    ]
    fields = {
        "diameter": source.diameter,
        "rated_break_strength": source.rated_break_strength,
        "linear_density": source.linear_density,
        "wet_linear_density": source.wet_linear_density,
    }
    return ExportLine(
        name=source.name,
        strain=np.array(curve.strain),
        tension=np.array(curve.tension),
        curve=f"composite of {tests}, {_WAYS[source.branch]}; one curve, no loop",
        tested=(float(curve.strain[first]), float(curve.strain[-1])),
        spread=_spread_of(curve),
        sources=(
            *source.sources,
            *(f"{name.replace('_', ' ')}: stated at the export" for name in given),
        ),
        notes=(
            *([f"DOUBTFUL: {curve.doubt}"] if curve.doubt else []),
            *curve.notes,
            *([f"more than one piece has a say at strain {', '.join(joins)}"] if joins else []),
            *source.notes,
        ),
        is_synthetic=source.is_synthetic,
        **fields | given,
    )

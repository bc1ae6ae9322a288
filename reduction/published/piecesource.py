"""Published tethers as pieces of a tension-strain curve: all windows of one of them.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 2, 3, 5, 6.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from reduction.lookup.pieces import CurvePiece
from reduction.lookup.product import LineCurve
from reduction.lookup.source import PieceSource
from reduction.published.linesource import published_sources
from reduction.published.tethers import published_tethers
from reduction.strain.pool import PooledMarks, fit_to_marks
from reduction.units import scale_to_si

_TO_THE_POUND = scale_to_si("lbf", "force")[0] / np.sqrt(12)
"""Standard uncertainty of a load that is printed to the pound. [N]"""


@cache
def published_piece_sources() -> dict[str, PieceSource]:
    """Published tethers by name, each with a piece of every test that is tabulated.

    Returns
    -------
    sources : dict of str to PieceSource
        ``rubber-tether-new``, ``rubber-tether-used``; ascending, since no other branch is
        tabulated.

    Notes
    -----
    Loads at the ends of the segments as printed and corrected, straight lines between them, as
    a look-up has them: Table 6 of [1]_, and Table 5 where a row of Table 6 is open.  Splices by
    the marks of Table 3 as a constant ratio of strains.

    Examples
    --------
    >>> used = published_piece_sources()["rubber-tether-used"]
    >>> print(used.pieces[0].name, round(used.model.coefficients["splice_strain_ratio"], 4))
    T-1 0.2177
    """
    found = {}
    for tether in published_tethers():
        name = f"rubber-tether-{tether.name}"
        windows = [one for key, one in published_sources().items() if key.startswith(f"{name}-")]
        tests = [
            (one, curve)
            for one in windows
            for curve in one.curves
            if curve.quantity == "branch_tension"
        ]
        marks = tether.marks
        readings = PooledMarks(
            marks, np.full(len(marks.test), np.nan), np.ones(len(marks.test), dtype=bool)
        )
        errata = dict.fromkeys(erratum for _, curve in tests for erratum in curve.errata)
        found[name] = PieceSource(
            name=name,
            branch="ascending",
            pieces=tuple(_piece(one.name.removeprefix(f"{name}-"), curve) for one, curve in tests),
            model=replace(
                fit_to_marks("strain-ratio", readings),
                marks_from="WHOI-2005-10, Table 3, marks of T-1",
            ),
            diameter=tether.specimen.mean_diameter,
            rated_break_strength=float(tether.specimen.rated_break_strength or np.nan),
            sources=(
                *(one.source for one, _ in tests),
                f"errata that touch them: {', '.join(errata)}",
            ),
            piece_sources=tuple(one.source for one, _ in tests),
            notes=(
                *dict.fromkeys(note for one in windows for note in one.notes),
                "loads are printed to the pound: that is the uncertainty of a piece",
            ),
        )
    return found


def _piece(test: str, curve: LineCurve) -> CurvePiece:
    """Ends of the segments, a joint once: where its two loads differ, their mean."""
    strain, place = np.unique(curve.at, return_inverse=True)
    tension = np.bincount(place, curve.value) / np.bincount(place)
    return CurvePiece(
        test, "cyclic", "ascending", strain, tension, np.full(strain.size, _TO_THE_POUND)
    )

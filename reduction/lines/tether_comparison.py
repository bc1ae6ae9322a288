r"""Comparison of two published tethers from one table, with strain from their marks.

Moduli of the tethers are in two tables: from the raw logs, and from smoothed curves.  For one
tether in one test the two differ by up to a fifth, which is more than the tethers differ: a ratio
has to be formed within one table.  Strain in both tables is from a free length that is a constant
share of the position ([1]_, eq. 2).  The marks of Table 3 give the free length itself, in test T-1
only; over the stretched marks it is linear in the position, so that

.. math:: \varepsilon = \frac{b\,p + a}{L_0} - 1, \qquad
          p = \frac{(1 + \varepsilon_c) L_0}{f}, \qquad E = E_c \frac{f}{b}

with the constant share f and the line a + b p through the marks.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005, eq. 2, Tables 3, 5, 6.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.lines.published_source import (
    TABLE_OF_DATA,
    source_of_segments,
    tether_windows,
)
from reduction.published.printed_cells import cells_of, number_of
from reduction.published.published_lines import POUND, PublishedTether, TetherSegment
from reduction.record.measurement import Floats

_MARKED = "T-1"

_TABLES = ("consolidated", "raw")


@dataclass(frozen=True)
class _ComparedTethers:
    """Two windows of one table.

    Parameters
    ----------
    first, second : LineSource
        With strain from the marks where the test has them.
    notes : tuple of str
        Table and correction used; result of another table.
    """

    first: LineSource
    second: LineSource
    notes: tuple[str, ...]


@dataclass(frozen=True)
class _MarkedLine:
    """Free length as a share of the position, and as a line through the stretched marks."""

    fraction: float
    slope: float
    constant: float
    relaxed: float

    @property
    def ratio(self) -> float:
        """Modulus with the constant share over modulus from the marks."""
        return self.slope / self.fraction

    def strain(self, by_fraction: Floats) -> Floats:
        """Strain from the marks."""
        position = (1 + by_fraction) * self.relaxed / self.fraction
        return (self.slope * position + self.constant) / self.relaxed - 1


def _marked_line(tether: PublishedTether) -> _MarkedLine:
    """The line through the stretched marks of T-1.

    Examples
    --------
    Slopes of strain over position, with the share and from the marks, 1.145 and 1.163 apart:

    >>> from reduction.published.published_lines import published_tethers
    >>> [round(_marked_line(one).ratio, 3) for one in published_tethers()]
    [1.145, 1.163]
    """
    marks = tether.marks
    free, position = marks.far_toe - marks.near_toe, marks.far_thimble
    slope, constant = np.polyfit(position[1:], free[1:], 1)
    return _MarkedLine(
        fraction=float(np.mean(free[1:] / position[1:])),
        slope=float(slope),
        constant=float(constant),
        relaxed=float(free[0]),
    )


def compared_tethers(first: LineSource, second: LineSource) -> _ComparedTethers | None:
    """Two published windows from one table.

    None where one of them is not a published tether, or no table has both complete.

    Examples
    --------
    >>> from reduction.lines.published_source import published_sources
    >>> names = ("rubber-tether-new-T-1", "rubber-tether-used-T-1")
    >>> pair = compared_tethers(*(published_sources()[name] for name in names))
    >>> [round(float(one.curves[0].value[0]) / 6894.757) for one in (pair.first, pair.second)]
    [120, 127]
    """
    windows = tether_windows()
    if not {first.name, second.name} <= windows.keys():
        return None
    for data in _TABLES:
        rows = [_rows(name, data) for name in (first.name, second.name)]
        if all(found and not any(one.is_open for one in found) for found in rows):
            return _pair(first.name, second.name, data)
    return None


def _rows(name: str, data: str) -> list[TetherSegment]:
    tether, test, condition = tether_windows()[name]
    return [
        one
        for one in tether.segments
        if (one.name.test, one.name.condition, one.name.data) == (test, condition, data)
    ]


def _pair(first: str, second: str, data: str) -> _ComparedTethers:
    table = TABLE_OF_DATA[data]
    sources = []
    told = [f"both moduli are from Table {table} of WHOI-2005-10"]
    is_marked = all(tether_windows()[name][1] == _MARKED for name in (first, second))
    for name in (first, second):
        tether, test, condition = tether_windows()[name]
        source = source_of_segments(tether, test, condition, data, _rows(name, data))
        sources.append(_by_marks(tether, source) if is_marked else source)
    if is_marked:
        tethers = [tether_windows()[name][0] for name in (first, second)]
        divisors = " and ".join(f"{_marked_line(one).ratio:.3f} ({one.name})" for one in tethers)
        told.append(
            f"strain is by the tape readings of Table 3: printed moduli are divided by {divisors}"
        )
    else:
        told.append(
            "strain is a fixed fraction of the crosshead position, as printed: tape readings are "
            "printed for T-1 only, where this makes moduli 1.145 (new) and 1.163 (used) times too "
            "large"
        )
    one, other = sources
    told += [*_over_common_strain(one, other, f"Table {table}"), *_other_table(first, second, data)]
    return _ComparedTethers(one, other, tuple(told))


def _by_marks(tether: PublishedTether, source: LineSource) -> LineSource:
    """A window with strain from the marks."""
    line = _marked_line(tether)

    def of(curve: LineCurve) -> LineCurve:
        at = line.strain(curve.at)
        value = curve.value / line.ratio if curve.quantity == "tangent_modulus" else curve.value
        return replace(curve, at=at, value=value, low=float(at[0]), high=float(at[-1]), warnings=())

    return replace(
        source,
        source=f"{source.source}, strain by the tape readings of Table 3",
        curves=tuple(of(curve) for curve in source.curves),
        notes=("the printed moduli are slopes of straight segments of the ascending branch",),
    )


def _chord(source: LineSource, low: float, high: float) -> float:
    """Mean modulus between two strains. [Pa]."""
    curve = source.curves[0]
    ends = np.clip(np.asarray(curve.at), low, high)
    return float(np.sum(np.diff(ends) * curve.value[:-1]) / (high - low))


def _over_common_strain(first: LineSource, second: LineSource, table: str) -> list[str]:
    """Both windows over their common strains: their pieces end at different strains."""
    low = max(one.curves[0].low for one in (first, second))
    high = min(one.curves[0].high for one in (first, second))
    if not low < high:
        return []
    chords = [_chord(one, low, high) for one in (first, second)]
    return [
        f"over their common strains, {100 * low:.0f} to {100 * high:.0f} %, the mean modulus of "
        f"{table} is {chords[0] / 1e6:.3f} MPa (first) and {chords[1] / 1e6:.3f} MPa (second), "
        f"ratio {chords[1] / chords[0]:.2f}: slopes of segments depend on where the segments end"
    ]


@cache
def _other_table(first: str, second: str, data: str) -> tuple[str, ...]:
    """Result of the other table where a row of it is open: moduli from its loads and strains."""
    (other,) = (one for one in _TABLES if one != data)
    if not all(len(_rows(name, other)) == 1 for name in (first, second)):
        return ()
    if not any(_rows(name, other)[0].is_open for name in (first, second)):
        return ()
    chords = []
    for name in (first, second):
        tether, test, _ = tether_windows()[name]
        by_marks = _marked_line(tether).ratio if test == _MARKED else 1.0
        chords.append(_printed_chord(tether, _rows(name, other)[0]) / by_marks)
    return (
        f"the row of Table {TABLE_OF_DATA[other]} is ambiguous: its printed loads and strains give "
        f"{chords[0] / 1e6:.3f} MPa (first) and {chords[1] / 1e6:.3f} MPa (second) by the same "
        f"strain, ratio {chords[1] / chords[0]:.2f}",
    )


def _printed_chord(tether: PublishedTether, segment: TetherSegment) -> float:
    """Modulus from the printed loads and strains of a row. [Pa]."""
    named = segment.name
    cells = {
        cell.column.removeprefix("segment_"): number_of(cell.printed) or float("nan")
        for cell in cells_of("WHOI-2005-10")
        if cell.table == TABLE_OF_DATA[named.data]
        and cell.row.startswith(f"{named.test} rubber tether {named.tether},")
        and cell.row.endswith(f"segment {named.number}")
    }
    rise = POUND * (cells["tension_high"] - cells["tension_low"])
    strain = cells["strain_high"] - cells["strain_low"]
    return float(rise / strain / np.mean(tether.specimen.area))

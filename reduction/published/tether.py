"""What WHOI-2005-10 holds of a rubber tether, in SI.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

from reduction.errors import DataError
from reduction.record import Specimen, SpliceMarks
from reduction.settings import StrainMethod

TetherName = Literal["new", "used"]
SegmentData = Literal["raw", "consolidated"]
_SEGMENT = re.compile(
    r"(T-\d)( after 3000 cycles)? rubber tether (new|used), (raw|consolidated) data, ascending, "
    r"segment (\d)"
)


class SegmentName(NamedTuple):
    """What the heading of a row of Tables 5 and 6 says."""

    test: str
    condition: Literal["ten cycles", "after 3000 cycles"]
    tether: TetherName
    data: SegmentData
    number: int


@dataclass(frozen=True)
class TetherSegment:
    """One row of Tables 5 and 6: a straight piece of an ascending branch.

    Parameters
    ----------
    name : SegmentName
        Test, condition, tether, which of the two tables, place from the lowest strain.
    branch : str
        ``ascending``: no descending modulus is tabulated.
    strain_low, strain_high : float
        By ``strain_method``; NaN where open. [1]
    tension_low, tension_high : float
        NaN where open. [N]
    modulus : float
        On the area at zero tension; NaN where open. [Pa]
    strain_method : StrainMethod
        Of the report; in T-1 it gives moduli 1.145 (new) and 1.163 (used) times those of the
        marks.
    is_open : bool
        Whether a number of the row is open.
    errata : tuple of str
        Ids of what touches the row.
    notes : tuple of str
        Alternatives, and what else to know.
    """

    name: SegmentName
    strain_low: float
    strain_high: float
    tension_low: float
    tension_high: float
    modulus: float
    is_open: bool
    errata: tuple[str, ...]
    notes: tuple[str, ...]
    branch: Literal["ascending"] = "ascending"
    strain_method: StrainMethod = "constant-fraction"


@dataclass(frozen=True)
class TetherTest:
    """One row of Table 1.

    The target is a position of the crosshead over an effective length, not the strain of the
    rubber: at 275 % that is 2.6.  [1]
    """

    name: str
    target_strain_low: float
    target_strain_high: float
    n_cycles: int


@dataclass(frozen=True)
class PublishedTether:
    """What the report holds of one tether.

    Parameters
    ----------
    name : {"new", "used"}
    specimen : Specimen
        Diameter as corrected, hence area; stretched diameters; break strength of the text.
    printed_diameter : float
        Of Table 2. [m]
    marks : SpliceMarks
        Of test T-1, the only ones printed.
    tests : tuple of TetherTest
        In the order they were run.
    segments : tuple of TetherSegment
        Raw (Table 5), then consolidated (Table 6).
    errata : tuple of str
        Ids of what touches all of it.
    """

    name: TetherName
    specimen: Specimen
    printed_diameter: float
    marks: SpliceMarks
    tests: tuple[TetherTest, ...]
    segments: tuple[TetherSegment, ...]
    errata: tuple[str, ...]

    def segments_of(
        self, test: str, *, data: SegmentData, condition: str = "ten cycles"
    ) -> tuple[TetherSegment, ...]:
        """Segments of one test, in rising strain.

        Raises
        ------
        DataError
            If the report has none.
        """
        found = tuple(
            one
            for one in self.segments
            if (one.name.test, one.name.data, one.name.condition) == (test, data, condition)
        )
        if not found:
            tests = dict.fromkeys(f"{one.name.test} {one.name.condition}" for one in self.segments)
            raise DataError(
                f"no {data} segments of tether {self.name} are printed for {test} {condition}",
                needed="one of " + ", ".join(tests),
            )
        return found


def name_of_segment(row: str) -> SegmentName:
    """What the heading of a row of Tables 5 and 6 says.

    Parameters
    ----------
    row : str
        Of a `Cell`.

    Returns
    -------
    name : SegmentName

    Raises
    ------
    DataError
        If the row is none of a segment.

    Examples
    --------
    >>> name_of_segment("T-1 rubber tether used, raw data, ascending, segment 1").tether
    'used'
    """
    found = _SEGMENT.fullmatch(row)
    if found is None:
        raise DataError("a row is no segment", found=row, needed="a row of Tables 5 and 6")
    return SegmentName(
        test=found[1],
        condition="after 3000 cycles" if found[2] else "ten cycles",
        tether=cast("TetherName", found[3]),
        data=cast("SegmentData", found[4]),
        number=int(found[5]),
    )

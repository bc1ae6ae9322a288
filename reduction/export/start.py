"""The straight start of a curve against what other tests of the same tether measured there.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5, 6.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.digits import plain_number
from reduction.lookup.product import LineSource
from reduction.record import Floats

_DOUBT = 0.05


def siblings_of(line: LineSource, others: Sequence[LineSource]) -> tuple[LineSource, ...]:
    """Other tests of the same tether in the same condition.

    Parameters
    ----------
    line : LineSource
        One test of a tether.
    others : sequence of LineSource
        Among which they are sought.

    Returns
    -------
    siblings : tuple of LineSource
        Empty for a rope, whose tests are one line.

    Raises
    ------
    AttributeError
        If it is no source.
    """
    if not line.is_tether:
        return ()
    same = ("kind", "material", "construction", "condition", "diameter")
    return tuple(
        one
        for one in others
        if one.name != line.name and all(getattr(one, key) == getattr(line, key) for key in same)
    )


def start_against(
    strain: Floats, tension: Floats, branch: str, siblings: Sequence[LineSource]
) -> tuple[str, ...]:
    """How far the straight line from 0 0 is from what was measured there in other tests.

    Parameters
    ----------
    strain, tension : ndarray, shape (n_points,)
        Of the curve, without what stands below its first point. [1], [N]
    branch : str
        Of the curve.
    siblings : sequence of LineSource
        Other tests of the same tether.

    Returns
    -------
    words : tuple of str
        One sentence a test that reaches below the first point; DOUBTFUL from a twentieth on.

    Raises
    ------
    AttributeError
        If one is no source.

    Notes
    -----
    The windows of a tether ([1]_) begin at the stretch about which it was cycled.
    """
    said = []
    for other in siblings:
        for curve in other.curves:
            if curve.quantity != "branch_tension" or curve.branch != branch or not curve.at.size:
                continue
            below = (curve.at > 0) & (curve.at < strain[0]) & (curve.value > 0)
            if not below.any():
                continue
            at, measured = curve.at[below], curve.value[below]
            off = tension[0] * at / strain[0] / measured - 1
            worst = int(np.argmax(np.abs(off)))
            doubt = "DOUBTFUL: " if abs(off[worst]) > _DOUBT else ""
            said.append(
                f"{doubt}the straight start is off by {100 * off[worst]:+.0f} percent at strain "
                f"{plain_number(at[worst], 4)}, where {other.name} has "
                f"{plain_number(measured[worst], 4)} N; exported "
                "without the test, the tether has what each measured"
            )
    return tuple(said)

"""What shared errors do to the straight segments of a branch.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Tables 5 and 6.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_increasing, as_positive
from reduction.uncertainty.curves import by_diameter
from reduction.uncertainty.product import Contributions, InstrumentErrors


def segment_contributions(
    of_curve: Contributions,
    errors: InstrumentErrors,
    *,
    strain: ArrayLike,
    knot: ArrayLike,
    segment_modulus: ArrayLike,
    area: float,
) -> Contributions:
    r"""Contributions to the segments of one branch, their breakpoints as found.

    Parameters
    ----------
    of_curve : Contributions
        ``branch_tension`` at the strains of the curve, shape (n_components, n_strains).
    errors : InstrumentErrors
        For the diameter.
    strain : array_like, shape (n_strains,)
        Of the points that were fitted. [1]
    knot : array_like, shape (n_segments + 1,)
        Ends and breakpoints. [1]
    segment_modulus : array_like, shape (n_segments,)
        As found. [Pa]
    area : float
        Nominal. [m2]

    Returns
    -------
    contributions : Contributions
        ``segment_tension_low``, ``segment_tension_high`` [N] and ``segment_modulus`` [Pa];
        shape (n_components, n_segments).

    Raises
    ------
    DataError
        If strains or knots do not rise, or the area is not positive.

    Notes
    -----
    The segments of [1]_ are a continuous line by least squares, linear in the tensions that it
    is fitted to: the error of the curve goes through the same fit.  A modulus is the chord of the
    line; the diameter enters it by the area.

    Examples
    --------
    1 N more at the upper end of one segment of 0.5, on 1 cm2: 20 kPa.

    >>> from reduction.uncertainty.product import Component
    >>> curve = Contributions((Component("tape", "new"),),
    ...     {"branch_tension": np.array([[0.0, 0.25, 0.5, 0.75, 1.0]])})
    >>> found = segment_contributions(curve, InstrumentErrors("new"),
    ...     strain=[1.0, 1.125, 1.25, 1.375, 1.5], knot=[1.0, 1.5],
    ...     segment_modulus=[1e6], area=1e-4)
    >>> print(found.values["segment_modulus"].round(6))
    [[20000.]]
    """
    as_positive("area", area)
    at, ends = as_increasing("strain", strain), as_increasing("knot", knot)
    hats = np.stack([np.interp(at, ends, unit) for unit in np.eye(ends.size)], axis=1)
    rows = of_curve.values["branch_tension"]
    ordinate = rows @ np.linalg.pinv(hats).T
    low, high = ordinate[:, :-1], ordinate[:, 1:]
    moduli = (high - low) / (area * np.diff(ends))
    for row, one in enumerate(of_curve.component):
        if one.source == "diameter":
            moduli[row] = by_diameter(segment_modulus, errors, area=area)
    return Contributions(
        of_curve.component,
        {
            "segment_tension_low": low,
            "segment_tension_high": high,
            "segment_modulus": moduli,
        },
    )

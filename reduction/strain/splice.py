"""Strain by one constant splice-free share of the length: the method of WHOI-2005-10 itself.

A tether ends in a splice at each thimble, and the splices strain less than the
rubber between them.  Thimble-to-thimble length therefore understates the strain
of the rubber.  The report takes the mean share of the marked positions for the
share at every position.  Kept so that its Table 3 can be reproduced; the share
grows with stretch, so the slope of this strain on position is too small.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.record import Floats


def free_length_fraction(free_length: ArrayLike, total_length: ArrayLike) -> float:
    """Mean share of the thimble-to-thimble length that is splice-free.

    Parameters
    ----------
    free_length : array_like, shape (n_marks,)
        Splice toe to splice toe, at the marked positions under strain. [m]
    total_length : array_like, shape (n_marks,)
        Thimble to thimble, at the same positions. [m]

    Returns
    -------
    fraction : float
        Mean of ``free_length / total_length``. [1]

    Raises
    ------
    DataError
        If the two lengths differ in shape, are not finite, or a free length is
        not between zero and its total length.

    Notes
    -----
    The row at zero strain is left out by the caller: Table 3 of [1]_ averages
    the stretched positions only, because an unstretched splice takes up a
    larger share (68.4 % free at rest, 77.7 % under strain).

    Any one length unit will do, as only the ratio is used.

    Examples
    --------
    Table 3 of [1]_, new tether, in feet; the printed mean is 77.7 %.

    >>> free = [14.80, 16.95, 19.03]
    >>> total = [19.37, 21.75, 24.12]
    >>> print(f"{free_length_fraction(free, total):.3f}")
    0.777
    """
    free = np.asarray(free_length, dtype=float)
    total = np.asarray(total_length, dtype=float)
    if free.shape != total.shape or free.ndim != 1 or free.size == 0:
        raise DataError(
            "splice marks do not pair up",
            found=f"free_length {free.shape}, total_length {total.shape}",
            needed="two equal, non-empty, one-dimensional series",
        )
    bad = ~(np.isfinite(free) & np.isfinite(total) & (free > 0) & (free < total))
    if bad.any():
        first = int(np.flatnonzero(bad)[0])
        raise DataError(
            f"{int(bad.sum())} of {bad.size} splice marks are impossible, first at index {first}",
            found=f"free_length {free[first]:g}, total_length {total[first]:g}",
            needed="0 < free_length < total_length",
        )
    return float(np.mean(free / total))


def free_length_strain(
    total_length: ArrayLike, *, free_fraction: float, relaxed_free_length: float
) -> Floats:
    r"""Strain of the splice-free rubber at each sample of the log.

    .. math:: \varepsilon = \frac{\phi L - \ell_0}{\ell_0}

    Parameters
    ----------
    total_length : array_like, shape (...)
        Thimble-to-thimble length :math:`L`, that is, crosshead position after
        scale and bias. [m]
    free_fraction : float
        Share :math:`\phi` from `free_length_fraction`. [1]
    relaxed_free_length : float
        Splice toe to splice toe before the test, :math:`\ell_0`. [m]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length; 1.0 is 100 % elongation. [1]

    Raises
    ------
    DataError
        If ``free_fraction`` is not between 0 and 1, or ``relaxed_free_length``
        is not positive.

    See Also
    --------
    free_length_fraction : Where ``free_fraction`` comes from.

    Notes
    -----
    Printed source: column "interpolated strain, free length" of Table 3,
    p. 29 of [1]_; the report gives the numbers, not the formula.  The formula
    here returns all six printed values to the printed digit.

    Not corrected: the share grows with stretch.  Against the marks of Table 3
    the strain is 3.1 points high at the lowest mark and 3.3 low at the highest
    (new tether), its slope 12.7 % too small, and a modulus reduced with it
    14.5 % too high.  Nor is slip of a splice during the test ([1]_, sec. 4.7),
    which makes ``free_fraction`` drift.  NaN in, NaN out.

    Examples
    --------
    Table 3 of [1]_, new tether, prints 79.7, 101.8 and 123.8 %.

    >>> phi = free_length_fraction([14.80, 16.95, 19.03], [19.37, 21.75, 24.12])
    >>> s = free_length_strain([19.37, 21.75, 24.12], free_fraction=phi, relaxed_free_length=8.38)
    >>> print((100 * s).round(1))
    [ 79.7 101.8 123.8]
    """
    if not 0 < free_fraction < 1:
        raise DataError(
            "free_fraction is out of range", found=f"{free_fraction:g}", needed="between 0 and 1"
        )
    if not relaxed_free_length > 0:
        raise DataError(
            "relaxed_free_length is not positive",
            found=f"{relaxed_free_length:g} m",
            needed="more than 0 m",
        )
    length = np.asarray(total_length, dtype=float)
    strain: Floats = (free_fraction * length - relaxed_free_length) / relaxed_free_length
    return strain

"""Table of wave theories by relative depth, as it is meant and to the letter.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Table 1 and sec. 5.
"""

from __future__ import annotations

from typing import Literal

from reduction.checks import as_positive

WaveTheoryName = Literal["airy", "stokes", "cnoidal or solitary", "beyond the table"]
PrintedTheory = Literal["airy", "stokes", "cnoidal or solitary", "none"]


def theory_by_depth(relative_depth: float) -> WaveTheoryName:
    """Theory by the relative depth alone.

    Parameters
    ----------
    relative_depth : float
        Depth over wave length. [1]

    Returns
    -------
    theory : {"airy", "stokes", "cnoidal or solitary", "beyond the table"}
        Of a wave that does not break.

    Raises
    ------
    DataError
        If the relative depth is not positive.

    Notes
    -----
    Table 1 of [1]_ leaves d/L = 0.1 to nobody; it is given to Stokes here, as in sec. 5
    ("between 2 and 4 meters" of a 20 m wave).  Its lowest limit, "0.04~0.05", is taken as 0.04.

    Examples
    --------
    The 20 m wave of [1]_ over 6 m, 3 m and 1.5 m of water.

    >>> [theory_by_depth(depth / 20) for depth in (6.0, 3.0, 1.5)]
    ['airy', 'stokes', 'cnoidal or solitary']
    """
    as_positive("relative_depth", relative_depth)
    if relative_depth >= 0.2:
        return "airy"
    if relative_depth >= 0.1:
        return "stokes"
    return "cnoidal or solitary" if relative_depth > 0.04 else "beyond the table"


def printed_theory(relative_depth: float, steepness: float) -> PrintedTheory:
    """Theory by Table 1 to the letter.

    Parameters
    ----------
    relative_depth : float
        Depth over wave length. [1]
    steepness : float
        Height over wave length. [1]

    Returns
    -------
    printed : {"airy", "stokes", "cnoidal or solitary", "none"}
        What the table names.

    Raises
    ------
    DataError
        If a number is not positive.

    Notes
    -----
    Table 1 of [1]_ contradicts itself: its row of Stokes asks for H/L of 0.2 or more, where
    every wave has broken (at most 0.142, and 0.12 at d/L = 0.2), and its row of Airy allows
    up to 0.2.  The second example of the paper, H/L = 0.0625 at d/L = 0.15, is in no row.

    Examples
    --------
    >>> printed_theory(0.3, 0.0625), printed_theory(0.15, 0.0625)
    ('airy', 'none')
    """
    as_positive("relative_depth", relative_depth)
    as_positive("steepness", steepness)
    if relative_depth >= 0.2:
        return "airy" if steepness <= 0.2 else "none"
    if relative_depth > 0.1:
        return "stokes" if steepness >= 0.2 else "none"
    return "cnoidal or solitary" if 0.04 < relative_depth < 0.1 else "none"

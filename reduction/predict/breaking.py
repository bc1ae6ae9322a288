r"""How high a wave can be before it breaks.

.. math:: H_b = \min(0.142\, L \tanh k d,\; 0.78\, d)

References
----------
.. [1] R. Miche, "Mouvements ondulatoires de la mer en profondeur constante ou décroissante,"
   Annales des Ponts et Chaussées, 1944, pp. 25-78, 131-164, 270-292, 369-406.
.. [2] J. McCowan, "On the highest wave of permanent type," Phil. Mag., ser. 5, vol. 38, 1894,
   pp. 351-358.
.. [3] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, Table 1.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.record import Floats

GREATEST_STEEPNESS = 0.142
"""Height over length of the steepest wave on deep water (Miche). [1]"""
GREATEST_HEIGHT_TO_DEPTH = 0.78
"""Height over depth of the highest solitary wave (McCowan). [1]"""


def breaking_height(wave_number: ArrayLike, water_depth: ArrayLike) -> Floats:
    """Height at which a wave of this length breaks over a flat bed.

    Parameters
    ----------
    wave_number : array_like, shape (...)
        2 pi over the wave length. [rad m-1]
    water_depth : array_like, shape (...)
        Of the still water. [m]

    Returns
    -------
    breaking_height : ndarray, shape (...)
        The lower one of the limits of [1]_ and [2]_. [m]

    Raises
    ------
    DataError
        If a number is not positive.

    Notes
    -----
    Not covered: a sloping bed, an opposing current and short-crested seas, which break
    waves earlier.  NaN is refused.

    Examples
    --------
    Table 1 of [3]_ asks for a height of 0.2 lengths or more where it names Stokes' theory. The
    20 m wave of its examples breaks long before, at 0.136 lengths 6 m deep and 0.105 3 m deep.

    >>> print((breaking_height(2 * np.pi / 20, [6.0, 3.0]) / 20).round(3))
    [0.136 0.105]
    """
    number = as_positive("wave_number", wave_number)
    depth = as_positive("water_depth", water_depth)
    miche = GREATEST_STEEPNESS * 2 * pi / number * np.tanh(number * depth)
    return np.asarray(np.minimum(miche, GREATEST_HEIGHT_TO_DEPTH * depth))


def refuse_breaking(*, wave_height: float, wave_number: float, water_depth: float) -> None:
    """Raise where a wave is higher than it can be.

    Parameters
    ----------
    wave_height : float
        Trough to crest. [m]
    wave_number : float
        2 pi over the wave length. [rad m-1]
    water_depth : float
        Of the still water. [m]

    Raises
    ------
    DataError
        If the wave is beyond breaking.

    Notes
    -----
    A wave of exactly the breaking height passes.

    Examples
    --------
    The wave of [3]_ is well below breaking.

    >>> refuse_breaking(wave_height=1.25, wave_number=2 * np.pi / 20, water_depth=3.0)
    """
    greatest = float(breaking_height(wave_number, water_depth))
    if wave_height <= greatest:
        return
    raise DataError(
        f"a wave {2 * pi / wave_number:.4g} m long breaks before it is this high",
        found=f"{wave_height:.4g} m over {water_depth:.4g} m of water",
        needed=f"at most {greatest:.4g} m",
        hint="Give a lower or a longer wave.",
    )

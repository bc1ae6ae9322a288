"""Nominal stress on the area at zero tension, and what a stretched diameter says about it.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from math import sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.record.arrays import as_positive
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Specimen
from reduction.record.notes import Note, note

# of the diameter: a single stretched reading has no scatter; twice what calipers squeeze
_OF_ONE_READING = 0.1


def nominal_stress(tension: ArrayLike, *, area: float) -> Floats:
    r"""Nominal (engineering) stress.

    .. math:: \sigma = F / A_0

    Parameters
    ----------
    tension : array_like, shape (...)
        :math:`F`. [N]
    area : float
        Area at zero tension, :math:`A_0`. [m2]

    Returns
    -------
    nominal_stress : ndarray, shape (...)
        Tension over the area at zero tension. [Pa]

    Raises
    ------
    DataError
        If ``area`` is not positive.

    Notes
    -----
    Equation 2 of [1]_, which states that the pre-stretch diameters were used.
    Not the true stress: the section shrinks as the rubber stretches.  NaN in,
    NaN out.

    Examples
    --------
    100 lbf on the used tether of [1]_ (0.6940 in2) is 144.1 psi.

    >>> stress = nominal_stress(100 * 4.4482216, area=0.6940 * 0.0254**2)
    >>> print((stress / 6894.757).round(1))
    144.1
    """
    as_positive("area", area)
    return np.multiply(np.asarray(tension, dtype=np.float64), 1.0 / area)


def constant_volume_diameter(strain: ArrayLike, stretched_diameter: ArrayLike) -> Floats:
    r"""Diameter before stretch that a stretched diameter implies at constant volume.

    .. math:: d_0 = d \sqrt{1 + \varepsilon}

    Parameters
    ----------
    strain : array_like, shape (n_readings,)
        Nominal strain at which the diameter was read. [1]
    stretched_diameter : array_like, shape (n_readings,)
        The reading :math:`d`. [m]

    Returns
    -------
    diameter : ndarray, shape (n_readings,)
        Diameter at zero strain. [m]

    Raises
    ------
    DataError
        If shapes differ, a diameter is not positive, or a strain is -1 or less.

    Notes
    -----
    Rubber keeps its volume to about one part in a thousand at these stresses;
    a rope or a braid does not, and the relation says nothing about them.

    Examples
    --------
    Table 2 of [1]_, new tether at 100 %, mean of three readings, in inches; the
    table prints 1.01 in before stretch.

    >>> print(constant_volume_diameter([1.0, 1.0, 1.0], [0.725, 0.739, 0.737]).mean().round(3))
    1.038
    """
    stretch = as_positive("1 + strain", 1.0 + np.asarray(strain, dtype=np.float64))
    diameter = as_positive("stretched_diameter", stretched_diameter)
    if stretch.shape != diameter.shape:
        raise DataError(
            "strains and stretched diameters do not pair up",
            found=f"{stretch.shape} and {diameter.shape}",
            needed="equal shapes",
        )
    return diameter * np.sqrt(stretch)


def check_constant_volume(specimen: Specimen) -> tuple[Note, ...]:
    """Compare the stated diameter with what the stretched diameters imply.

    One where the two differ by more than the readings scatter (Student's t, 95 %), or more than 10
    % where a single stretched reading gives no scatter; empty where they agree.

    Notes
    -----
    The scatter is that of all implied diameters about their mean, and is taken
    to apply to the stated readings too.  In Table 2 of [1]_ it is 0.009 in for
    the new tether, where the implied 1.038 in differs from the printed 1.01 in
    by three times that, and 0.007 in for the used one, where 0.929 in and
    0.94 in agree within it.

    Examples
    --------
    >>> inch = 0.0254
    >>> at_10, at_100 = (0.997, 0.980, 0.995), (0.725, 0.739, 0.737)
    >>> readings = [(0.1, d * inch) for d in at_10] + [(1.0, d * inch) for d in at_100]
    >>> new = Specimen("new", diameter=(1.01 * inch,), stretched_diameters=tuple(readings))
    >>> print(str(check_constant_volume(new)[0])[:77])
    new: at constant volume the stretched diameters imply 26.37 mm before stretch
    """
    if not specimen.stretched_diameters:
        return ()
    strain, stretched = np.array(specimen.stretched_diameters).T
    implied = constant_volume_diameter(strain, stretched)
    mean, stated = float(np.mean(implied)), specimen.mean_diameter
    if implied.size > 1:
        scatter = float(np.std(implied, ddof=1))
        standard_error = scatter * sqrt(1 / implied.size + 1 / len(specimen.diameter))
        allowed = float(stdtrit(implied.size - 1, (1 + CONFIDENCE) / 2)) * standard_error
    else:
        allowed = _OF_ONE_READING * mean
    if abs(mean - stated) <= allowed:
        return ()
    return (
        note(
            "diameters-contradict",
            specimen.name,
            implied=mean,
            stated=stated,
            allowed=allowed,
            effect=(stated / mean) ** 2 - 1,
        ),
    )

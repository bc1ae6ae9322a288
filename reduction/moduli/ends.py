"""Moduli from the ends of the branches: secant at the peak and chord of each branch, by cycle.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.cycles.product import Cycles
from reduction.cycles.readings import reading_noise
from reduction.moduli.product import EndModuli
from reduction.moduli.secant import chord_modulus, secant_modulus
from reduction.moduli.tangent import pair_specimens
from reduction.samples.blocks import take_samples


def end_moduli(
    strain: ArrayLike, tension: ArrayLike, *, area: ArrayLike, cycles: Cycles
) -> EndModuli:
    r"""Secant modulus at the peak of each cycle, and chord modulus of each branch.

    .. math::

        E_{sec} = \frac{F_{peak}}{A \varepsilon_{peak}}, \qquad
        E_{chord} = \frac{F_{end} - F_{begin}}{A (\varepsilon_{end} - \varepsilon_{begin})}

    Parameters
    ----------
    strain : array_like, shape (n_specimens, n_samples)
        Nominal strain of the free length; NaN where missing. [1]
    tension : array_like, shape (n_specimens, n_samples)
        Tension; NaN where missing. [N]
    area : array_like, shape (n_specimens,)
        Cross-sectional area at zero tension. [m2]
    cycles : Cycles
        Whole branches, ends included. [SI]

    Returns
    -------
    moduli : EndModuli
        By cycle, with standard uncertainties. [Pa]

    Raises
    ------
    DataError
        If strain, tension and area do not pair up, or an area is not positive.

    Notes
    -----
    Printed source: eq. 1 of [1]_ for the secant. The peak is the reversal, the last sample
    of the ascending branch; where the machine dwells there, the sample at which it arrives.
    Each number rests on one or two readings: its uncertainty is their noise
    (`reading_noise`), nothing else. NaN where a reading is missing, the secant also where
    strain is zero or below, the chord where a branch has no stroke.

    Examples
    --------
    From 100 % and 1000 N to 200 % and 2500 N and back to 1100 N, on 1 cm2.

    >>> strain = np.array([[1.0, 1.5, 2.0, 1.5, 1.0]])
    >>> tension = np.array([[1000.0, 1700.0, 2500.0, 1800.0, 1100.0]])
    >>> ends = np.array([[0, 2]])
    >>> cycles = Cycles(
    ...     np.array([0]), np.array([4]), ends, ends + 2, np.ones((1, 2)),
    ...     np.ones(5, np.int32), np.array([1, 1, 1, 2, 2], np.int8), np.ones(5, bool), 0.1,
    ... )
    >>> moduli = end_moduli(strain, tension, area=[1e-4], cycles=cycles)
    >>> print(moduli.secant_modulus / 1e6, moduli.chord_modulus / 1e6)
    [[12.5]] [[[15. 14.]]]
    """
    strains, tensions, areas = pair_specimens(strain, tension, area)
    peak = cycles.branch_last[:, 0]
    ends = [take_samples(series, cycles.branch_first) for series in (strains, tensions)]
    ends += [take_samples(series, cycles.branch_last) for series in (strains, tensions)]
    strain_begin, tension_begin, strain_end, tension_end = ends
    strain_end = np.where(strain_end == strain_begin, np.nan, strain_end)
    section = areas[:, None]
    strain_at_peak = take_samples(strains, peak)
    secant = secant_modulus(strain_at_peak, take_samples(tensions, peak), area=section)
    chord = chord_modulus(
        strain_begin, strain_end, tension_begin, tension_end, area=section[..., None]
    )
    noise = np.array([reading_noise(one) for one in tensions])[:, None]
    strain_noise = np.array([reading_noise(one) for one in strains])[:, None]
    at_peak = np.hypot(noise / section, secant * strain_noise) / np.abs(strain_at_peak)
    of_branch = np.sqrt(2) * np.hypot(noise[..., None] / section[..., None],
                                      chord * strain_noise[..., None])  # fmt: skip
    return EndModuli(
        secant_modulus=secant,
        secant_modulus_standard_uncertainty=at_peak,
        chord_modulus=chord,
        chord_modulus_standard_uncertainty=of_branch / np.abs(strain_end - strain_begin),
    )

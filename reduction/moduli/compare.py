"""Ratio of two modulus curves on one strain axis, with the interval it lies in.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
.. [2] JCGM 100, "Guide to the expression of uncertainty in measurement," 2008, G.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from reduction.errors import DataError
from reduction.moduli.interpolation import curve_at
from reduction.moduli.product import ModulusCurves, Ratio
from reduction.record import Floats

_CONFIDENCE = 0.95
_MANY = 1e9
"""Degrees of freedom of hundreds of samples."""
_TYPE_A = (
    "the interval holds what differs from cycle to cycle (type A); errors of area, calibration "
    "and splice strain that the two do not share are not in it"
)


@dataclass(frozen=True)
class _Side:
    """Numerator or denominator on the common axis; arrays (2, n_bins)."""

    name: str
    modulus: Floats
    uncertainty: Floats
    freedom: Floats


def _ratio(strain: Floats, above: _Side, below: _Side) -> Ratio:
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = above.modulus / below.modulus
        relative = [(side.uncertainty / side.modulus) ** 2 for side in (above, below)]
        total = relative[0] + relative[1]
        # Welch-Satterthwaite, [2]_ eq. G.2b
        freedom = total**2 / (relative[0] ** 2 / above.freedom + relative[1] ** 2 / below.freedom)
        uncertainty = np.abs(ratio) * np.sqrt(total)
        reach = uncertainty * stdtrit(np.where(total > 0, freedom, 1), (1 + _CONFIDENCE) / 2)
    notes = [_TYPE_A]
    if not np.isfinite(ratio).any():
        notes.append(f"{above.name} and {below.name} have no strain in common")
    low, high = ratio - reach, ratio + reach
    return Ratio(
        numerator=above.name,
        denominator=below.name,
        strain_bin=strain,
        ratio=ratio,
        ratio_standard_uncertainty=uncertainty,
        ratio_low=low,
        ratio_high=high,
        is_different=(low > 1) | (high < 1),
        notes=tuple(notes),
        degrees_of_freedom=freedom,
    )


def _spacing(curves: ModulusCurves) -> float:
    return float(np.ptp(curves.strain_bin_bounds[0]))


def _side(curves: ModulusCurves, specimen: int, name: str, strain: Floats) -> _Side:
    """Mean curve of one specimen at the strains of the axis."""
    cycles = curves.tangent_modulus_count[specimen]
    # of one cycle the uncertainty is that of a regression on its samples
    count = np.where(cycles > 1, cycles - 1.0, _MANY)
    series = (
        curves.tangent_modulus[specimen],
        curves.tangent_modulus_standard_uncertainty[specimen],
        np.where(np.isfinite(curves.tangent_modulus[specimen]), count, np.nan),
    )
    spacing = _spacing(curves)
    at = [
        np.stack([curve_at(strain, curves.strain_bin, row, spacing=spacing) for row in values])
        for values in series
    ]
    return _Side(name, *at)


def compare_curves(
    numerator: ModulusCurves,
    denominator: ModulusCurves,
    *,
    numerator_specimen: int,
    denominator_specimen: int,
    numerator_name: str,
    denominator_name: str,
) -> Ratio:
    r"""Ratio of the mean tangent moduli of two specimens, or of two tests.

    Parameters
    ----------
    numerator : ModulusCurves
        Of one test. [SI]
    denominator : ModulusCurves
        Of another, or the same again where one test holds both specimens. [SI]
    numerator_specimen : int
        Place of the specimen in the numerator. [1]
    denominator_specimen : int
        Place of the specimen in the denominator. [1]
    numerator_name : str
        What the numerator is called.
    denominator_name : str
        What the denominator is called.

    Returns
    -------
    ratio : Ratio
        On the coarser of the two grids, both branches, with its 95 % interval. [1]

    Raises
    ------
    DataError
        If a curve does not have a value a bin.

    Notes
    -----
    Printed source: sec. 4.6 of [1]_ compares new and used tethers at equal strain.

    The interval is :math:`r \pm t_{95}(\nu)\,u(r)` with u from the type A uncertainty
    of both, taken as independent, and :math:`\nu` after Welch and Satterthwaite ([2]_).
    It is that of one strain: of a hundred bins of equal curves five stand out. Where one
    of the two has no modulus the ratio is NaN and ``is_different`` False; a note says
    where that is so at every strain.

    Examples
    --------
    Ten cycles each; 11 and 10 MPa, both known to 1 %.

    >>> import numpy as np
    >>> modulus = np.array([11e6, 10e6])[:, None, None] * np.ones((2, 2, 3))
    >>> x = np.array([1.0, 1.1, 1.2])
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((2, 2, 3)))
    >>> curves = ModulusCurves(**blank | {
    ...     "strain_bin": x, "strain_bin_bounds": np.stack([x - 0.05, x + 0.05], axis=1),
    ...     "tangent_modulus": modulus, "tangent_modulus_count": np.full((2, 2, 3), 10),
    ...     "tangent_modulus_standard_uncertainty": 0.01 * modulus,
    ... })
    >>> ratio = compare_curves(
    ...     curves, curves, numerator_specimen=0, denominator_specimen=1,
    ...     numerator_name="new", denominator_name="used",
    ... )
    >>> print(ratio.ratio[0, 0].round(3), ratio.ratio_low[0, 0].round(3))
    1.1 1.067
    """
    axis = max((numerator, denominator), key=_spacing).strain_bin
    above = _side(numerator, numerator_specimen, numerator_name, axis)
    below = _side(denominator, denominator_specimen, denominator_name, axis)
    return _ratio(axis, above, below)


def compare_cycles(
    curves: ModulusCurves,
    *,
    specimen: int,
    numerator_cycles: Sequence[int],
    denominator_cycles: Sequence[int],
) -> Ratio:
    r"""Ratio of the mean curves of two sets of cycles, such as the last and the first.

    Parameters
    ----------
    curves : ModulusCurves
        With the curves of selected cycles. [SI]
    specimen : int
        Place of the specimen in the curves. [1]
    numerator_cycles : sequence of int
        Cycle numbers, all among ``selected_cycle``. [1]
    denominator_cycles : sequence of int
        The same for the denominator. [1]

    Returns
    -------
    ratio : Ratio
        On the grid of the curves, both branches, with its 95 % interval. [1]

    Raises
    ------
    DataError
        If a set is empty or names a cycle whose curve was not kept.

    Notes
    -----
    Printed source: sec. 4.7 of [1]_ sets the last cycles of the extended test beside the
    first. The uncertainty of each mean is that of the regressions of its cycles (type A).

    Examples
    --------
    A modulus that halves from cycle 1 to cycle 3.

    >>> import numpy as np
    >>> by_cycle = np.array([2.0, 1.5, 1.0])[None, :, None, None] * np.ones((1, 3, 2, 1))
    >>> blank = dict.fromkeys(ModulusCurves.__dataclass_fields__, np.zeros((1, 2, 1)))
    >>> curves = ModulusCurves(**blank | {
    ...     "selected_cycle": np.array([1, 2, 3]), "tangent_modulus_by_cycle": by_cycle,
    ...     "tangent_modulus_by_cycle_standard_uncertainty": 0.01 * by_cycle,
    ... })
    >>> ratio = compare_cycles(
    ...     curves, specimen=0, numerator_cycles=[3], denominator_cycles=[1]
    ... )
    >>> print(ratio.ratio[0], ratio.ratio_low[0].round(4), ratio.is_different[0])
    [0.5] [0.4861] [ True]
    """
    sides = []
    for chosen in (numerator_cycles, denominator_cycles):
        kept = np.isin(curves.selected_cycle, chosen)
        if len(chosen) == 0 or np.count_nonzero(kept) < len(set(chosen)):
            raise DataError(
                "a cycle to compare has no curve of its own",
                found=", ".join(str(number) for number in chosen) or "no cycle",
                needed="cycles among " + ", ".join(str(n) for n in curves.selected_cycle),
            )
        modulus = curves.tangent_modulus_by_cycle[specimen, kept].mean(axis=0)
        variance = curves.tangent_modulus_by_cycle_standard_uncertainty[specimen, kept] ** 2
        uncertainty = np.sqrt(variance.sum(axis=0)) / len(set(chosen))
        name = "cycles " + ", ".join(str(number) for number in sorted(set(chosen)))
        sides.append(_Side(name, modulus, uncertainty, np.full(modulus.shape, np.inf)))
    above, below = sides
    return _ratio(curves.strain_bin, above, below)

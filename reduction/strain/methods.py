"""Strain of the splice-free length by position alone, one function a method.

`constant-fraction` is in `reduction.strain.splice`, strain by the tension that the
splices carry in `reduction.strain.tensiondriven`; how their coefficients are found
from tape readings is in `reduction.strain.calibration`.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive
from reduction.record import Floats


def marked_line_strain(
    position: ArrayLike,
    *,
    free_length_intercept: float,
    free_length_slope: float,
    relaxed_free_length: float,
) -> Floats:
    r"""Strain by a straight line of free length on position.

    .. math:: \varepsilon = \frac{a + b\,p}{\ell_0} - 1

    Parameters
    ----------
    position : array_like, shape (...)
        Thimble-to-thimble length :math:`p`. [m]
    free_length_intercept : float
        :math:`a`, from `reduction.strain.calibration.fit_free_length_line`. [m]
    free_length_slope : float
        :math:`b`, from the same fit. [1]
    relaxed_free_length : float
        Splice toe to splice toe on the slack specimen, :math:`\ell_0`. [m]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length. [1]

    Raises
    ------
    DataError
        If ``relaxed_free_length`` is not positive.

    Notes
    -----
    Holds inside the marked range of position and at the tension history of the
    marks: where the same position is visited at another tension, the splices
    have another length and the line does not know.  NaN in, NaN out.

    Examples
    --------
    Table 3 of [1]_, new tether, in feet; the tape gives 76.6, 102.3 and 127.1 %.

    >>> strain = marked_line_strain(
    ...     [19.37, 21.75, 24.12],
    ...     free_length_intercept=-2.4395,
    ...     free_length_slope=0.89054,
    ...     relaxed_free_length=8.38,
    ... )
    >>> print((100 * strain).round(1))
    [ 76.7 102.  127.2]
    """
    as_positive("relaxed_free_length", relaxed_free_length)
    strain = np.asarray(position, dtype=np.float64) * (free_length_slope / relaxed_free_length)
    return np.add(strain, free_length_intercept / relaxed_free_length - 1.0)


def splice_ratio_strain(
    position: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    splice_strain_ratio: float,
) -> Floats:
    r"""Strain where the splices strain by a constant share of what the free length does.

    .. math:: \varepsilon = \frac{p - \ell_0 - \ell_s}{\ell_0 + \rho\,\ell_s}

    Parameters
    ----------
    position : array_like, shape (...)
        Thimble-to-thimble length :math:`p`. [m]
    relaxed_free_length : float
        Splice toe to splice toe on the slack specimen, :math:`\ell_0`. [m]
    relaxed_splice_length : float
        Both splices together on the slack specimen, :math:`\ell_s`. [m]
    splice_strain_ratio : float
        :math:`\rho`, splice strain over free strain. [1]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length. [1]

    Raises
    ------
    DataError
        If a relaxed length is not positive, or ``splice_strain_ratio`` is
        negative beyond a rigid splice (:math:`\ell_0 + \rho \ell_s \le 0`).

    Notes
    -----
    Zero at the slack length by construction, so it may be used below the lowest
    mark.  A splice stiffens with tension while the rubber softens and stiffens,
    so the ratio is not constant over a wide range.  NaN in, NaN out.

    Examples
    --------
    Table 3 of [1]_, used tether, in feet; the tape gives 77.3, 103.4 and 128.9 %.

    >>> strain = splice_ratio_strain(
    ...     [19.37, 21.75, 24.12],
    ...     relaxed_free_length=8.34,
    ...     relaxed_splice_length=3.92,
    ...     splice_strain_ratio=0.2177,
    ... )
    >>> print((100 * strain).round(1))
    [ 77.3 103.2 129. ]
    """
    as_positive("relaxed_free_length", relaxed_free_length)
    as_positive("relaxed_splice_length", relaxed_splice_length)
    effective_length = relaxed_free_length + splice_strain_ratio * relaxed_splice_length
    as_positive("relaxed_free_length + splice_strain_ratio * splice length", effective_length)
    strain = np.asarray(position, dtype=np.float64) / effective_length
    return np.subtract(strain, (relaxed_free_length + relaxed_splice_length) / effective_length)


def gauge_length_strain(
    position: ArrayLike, *, reference_position: float, gauge_length: float
) -> Floats:
    r"""Strain of a specimen without splices.

    .. math:: \varepsilon = \frac{p - p_0}{g}

    Parameters
    ----------
    position : array_like, shape (...)
        Length or displacement :math:`p`. [m]
    reference_position : float
        The same channel at zero strain, :math:`p_0`: zero for a displacement
        that starts at slack. [m]
    gauge_length : float
        Length that stretches, at zero strain, :math:`g`. [m]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain. [1]

    Raises
    ------
    DataError
        If ``gauge_length`` is not positive or ``reference_position`` is not finite.

    Notes
    -----
    The whole of the crosshead's travel is charged to the gauge length: give in
    grips and machine is not corrected.  The definition is that of the first
    column of Table 4 of [1]_.  NaN in, NaN out.

    Examples
    --------
    Table 4 of [1]_ at 0945: 9.31 in on a gauge length of 6.125 in is 52 %.

    >>> print(gauge_length_strain(9.31, reference_position=6.125, gauge_length=6.125).round(2))
    0.52
    """
    as_positive("gauge_length", gauge_length)
    as_finite("reference_position", reference_position)
    strain = np.subtract(np.asarray(position, dtype=np.float64), reference_position)
    return np.divide(strain, gauge_length)

"""Strain of the splice-free length at every sample, one function a method.

All but `constant-fraction` (in `reduction.strain.splice`) are here; how their
coefficients are found from tape readings is in `reduction.strain.calibration`.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite, as_positive, as_same_shape
from reduction.record import Floats

__all__ = [
    "gauge_length_strain",
    "marked_line_strain",
    "splice_ratio_strain",
    "splice_strain",
    "tension_driven_strain",
]

# the logarithm of this times any exponent below 2 is finite, and its power is zero in effect
_NO_TENSION = 1e-150


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


def splice_strain(
    tension: ArrayLike, *, splice_compliance: float, splice_exponent: float
) -> Floats:
    r"""Strain of the splices under a tension.

    .. math:: \varepsilon_s = c\,F^n

    Parameters
    ----------
    tension : array_like, shape (...)
        :math:`F`; values below zero (noise about slack) count as zero. [N]
    splice_compliance : float
        :math:`c`; its unit goes with the exponent. [N**-n]
    splice_exponent : float
        :math:`n`. [1]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of both splices together. [1]

    Raises
    ------
    DataError
        If a coefficient is not positive.

    Notes
    -----
    Computed as :math:`\exp(n \ln F + \ln c)` in one array: three times faster
    than a power on most processors, and a log may have millions of rows.
    NaN in, NaN out.

    Examples
    --------
    A splice that strains 40 % at 900 N, at half that tension:

    >>> half = splice_strain(450.0, splice_compliance=0.4 / 900**0.85, splice_exponent=0.85)
    >>> print(half.round(3))
    0.222
    """
    as_positive("splice_compliance", splice_compliance)
    as_positive("splice_exponent", splice_exponent)
    work = np.array(tension, dtype=np.float64)
    np.maximum(work, _NO_TENSION, out=work)
    np.log(work, out=work)
    work *= splice_exponent
    work += math.log(splice_compliance)
    return np.exp(work, out=work)


def tension_driven_strain(
    position: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    splice_compliance: float,
    splice_exponent: float,
) -> Floats:
    r"""Strain where the splices strain by the tension they carry.

    .. math:: \varepsilon = \frac{p - \ell_s (1 + c F^n)}{\ell_0} - 1

    Parameters
    ----------
    position : array_like, shape (...)
        Thimble-to-thimble length :math:`p`. [m]
    tension : array_like, shape (...)
        :math:`F` at the same samples; below zero counts as zero. [N]
    relaxed_free_length : float
        Splice toe to splice toe on the slack specimen, :math:`\ell_0`. [m]
    relaxed_splice_length : float
        Both splices together on the slack specimen, :math:`\ell_s`. [m]
    splice_compliance : float
        :math:`c`; its unit goes with the exponent. [N**-n]
    splice_exponent : float
        :math:`n`. [1]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length. [1]

    Raises
    ------
    DataError
        If position and tension differ in shape, or a coefficient or relaxed
        length is not positive.

    Notes
    -----
    Splice and rubber carry one tension, so the splice length follows from the
    log itself at every sample, also where a position is visited at two tensions:
    on the first pull, and after the rubber has relaxed.  Zero at the slack length.

    Not corrected: creep and friction inside the splice (its strain is taken to
    follow tension at once), and slip ([1]_, sec. 4.7).  Noise of tension enters
    strain by :math:`-(\ell_s/\ell_0)\,n c F^{n-1}`.  NaN in, NaN out.

    Examples
    --------
    Slack is zero strain; a rigid splice would give 103 % where a soft one gives 95 %.

    >>> strain = tension_driven_strain(
    ...     [3.74, 6.35],
    ...     [0.0, 450.0],
    ...     relaxed_free_length=2.55,
    ...     relaxed_splice_length=1.19,
    ...     splice_compliance=0.00036,
    ...     splice_exponent=1.0,
    ... )
    >>> print((100 * strain).round(1))
    [ 0.  94.8]
    """
    as_positive("relaxed_free_length", relaxed_free_length)
    as_positive("relaxed_splice_length", relaxed_splice_length)
    position, tension = as_same_shape(position=position, tension=tension)
    strain = splice_strain(
        tension,
        splice_compliance=splice_compliance * relaxed_splice_length / relaxed_free_length,
        splice_exponent=splice_exponent,
    )
    np.subtract(position * (1.0 / relaxed_free_length), strain, out=strain)
    strain -= 1.0 + relaxed_splice_length / relaxed_free_length
    return strain


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

"""Strain of the splice-free length by each method, and its inverse.

**Strain by one constant splice-free share of the length: the method of WHOI-2005-10 itself.** A
tether ends in a splice at each thimble, and the splices strain less than the rubber between them.
Thimble-to-thimble length therefore understates the strain of the rubber.  The report uses the mean
share of the marked positions at every position.  The method is kept so that its Table 3 can be
reproduced; the share grows with stretch, so the slope of this strain on position is too small.

The coefficients of each method are fitted to tape readings in
`reduction.stages.strain.strain_fit`.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, sec. 4.1, Table 3.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_finite, as_positive, as_same_shape
from reduction.record.errors import DataError
from reduction.record.measurement import Bools, Floats, read_only_arrays
from reduction.record.notes import Note, note
from reduction.record.settings import StrainMethod


def _empty() -> Floats:
    return np.empty(0)


@dataclass(frozen=True)
@read_only_arrays
class StrainModel:
    """Conversion of crosshead position to strain for one specimen in one test.

    Parameters
    ----------
    specimen : str
        Name of the specimen.
    method : StrainMethod
        One of the seven methods.
    coefficients : dict of str to float
        By full name, SI, as `strain_by_model` needs them. For
        ``tension-driven``: ``relaxed_free_length`` [m], ``relaxed_splice_length``
        [m], ``splice_compliance`` c [N**-n] and ``splice_exponent`` n [1].
    covariance : ndarray, shape (n_coefficients, n_coefficients)
        Of the coefficients, in the order of the dict; zeros where exact. [SI]
    position_low, position_high : float
        Marked range of position; outside it the strain is extrapolated. [m]
    tension_low, tension_high : float
        Tension range of the marks; NaN where the method does not use it. [N]
    marks_from : str
        ``this test``, ``pooled over the campaign`` or ``none``.
    mark_test, mark_hold : tuple of str, length n_marks
        Marks of this specimen that were used.
    mark_position, mark_strain, mark_tension, mark_strain_residual : ndarray, shape (n_marks,)
        Far thimble [m], strain at the marks [1], tension while they were read
        [N], strain by the method minus strain at the marks [1].
    mark_load_cell : tuple of str, length n_marks or 0
        Load cell of the tension at each mark; where empty, that of the test.
    strain_slope_ratio : float
        d(strain)/d(position) by ``constant-fraction`` over that of this method,
        mean over the test's own marked range: a modulus by ``constant-fraction``
        is the inverse of this times the modulus here. NaN without marks. [1]
    notes : tuple of Note
        Remarks for the reader.
    made : tuple of str
        Lines of the history: how it was made, with numbers that are not stored elsewhere.
    is_zero_logged : bool
        True where the position of zero strain was read from the log of the test, so that an error
        of the crosshead zero is in it as well.
    by_marks : StrainModel, optional
        For a method that was asked for: the ``mixed`` model, averaged over the laws that the same
        marks do not reject, by which its error is judged.
    law_covariance : ndarray, shape (n_coefficients, n_coefficients)
        Of the coefficients, from the choice of splice law; empty where there is one law. [SI]
    reference_tension : float
        Tension at which strain is zero, where that is not slack. [N]
    splice_friction : float
        Root mean square of the relative excess length of splices on the way down, from marks that
        were read there; NaN without them. [1]
    splice_slip : float
        Standard uncertainty of the slip of the splices between the marks of the test and its
        cycles; zero where the marks show no slip. [m]
    """

    specimen: str
    method: StrainMethod
    coefficients: dict[str, float] = field(default_factory=dict)
    covariance: Floats = field(default_factory=lambda: np.empty((0, 0)))
    position_low: float = float("nan")
    position_high: float = float("nan")
    tension_low: float = float("nan")
    tension_high: float = float("nan")
    marks_from: str = "none"
    mark_test: tuple[str, ...] = ()
    mark_hold: tuple[str, ...] = ()
    mark_position: Floats = field(default_factory=_empty)
    mark_strain: Floats = field(default_factory=_empty)
    mark_tension: Floats = field(default_factory=_empty)
    mark_strain_residual: Floats = field(default_factory=_empty)
    mark_load_cell: tuple[str, ...] = ()
    strain_slope_ratio: float = float("nan")
    notes: tuple[Note, ...] = ()
    made: tuple[str, ...] = ()
    is_zero_logged: bool = False
    by_marks: StrainModel | None = None
    law_covariance: Floats = field(default_factory=lambda: np.empty((0, 0)))
    reference_tension: float = 0.0
    splice_friction: float = float("nan")
    splice_slip: float = 0.0

    @property
    def relaxed_length(self) -> float:
        """Length that stretches, at zero strain; NaN where the method has none. [m]."""
        known = self.coefficients
        return known.get("relaxed_free_length", known.get("gauge_length", float("nan")))


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
    The caller leaves out the row at zero strain: Table 3 of [1]_ averages
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
    14.5 % too high.  Slip of a splice during the test ([1]_, sec. 4.7), which
    makes ``free_fraction`` drift, is not corrected either.  NaN in, NaN out.

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


# the logarithm of this times any exponent below 2 is finite, and the power is effectively zero
_NO_TENSION = 1e-150


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
        :math:`c`; its unit depends on the exponent. [N**-n]
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


def _tension_driven_strain(
    position: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    splice_compliance: float,
    splice_exponent: float,
) -> Floats:
    r"""Strain for splices that strain by the tension they carry.

    .. math:: \varepsilon = \frac{p - \ell_s (1 + c F^n)}{\ell_0} - 1

    Notes
    -----
    Splice and rubber carry the same tension, so the splice length follows from the
    log itself at every sample, even where a position is visited at two tensions:
    on the first pull, and after the rubber has relaxed.  Zero at the slack length.

    Not corrected: creep and friction inside the splice (its strain is taken to
    follow tension at once), and slip ([1]_, sec. 4.7).  Noise of tension enters
    strain by :math:`-(\ell_s/\ell_0)\,n c F^{n-1}`.  NaN in, NaN out.

    Examples
    --------
    Slack is zero strain; a rigid splice would give 103 % where a soft one gives 95 %:

    >>> strain = _tension_driven_strain(
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


def _mixed_strain(
    position: ArrayLike,
    tension: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    splice_offset: float,
    splice_strain_ratio: float,
    splice_strain_curvature: float,
    splice_strain_cubic: float,
    splice_compliance: float,
    splice_exponent: float,
    splice_limit: float,
    splice_saturation: float,
) -> Floats:
    r"""Strain for splices that strain by the tension they carry and by the free strain.

    .. math:: \ell_0 (1 + \varepsilon)
       + \ell_s \left(1 + s_0 + \rho\varepsilon + \kappa\varepsilon^2 + \gamma\varepsilon^3
       + c F^n + a (1 - e^{-b F})\right) = p

    Notes
    -----
    Takes the root that tends to the strain without curvature as curvature vanishes.  Tension below
    zero counts as zero.  NaN in, NaN out, and NaN where the splices would exceed the whole length.

    Examples
    --------
    Half of 22 % by tension, half by the free strain:

    >>> strain = _mixed_strain(
    ...     [6.5518], [450.0], relaxed_free_length=2.55, relaxed_splice_length=1.19,
    ...     splice_offset=0.0, splice_strain_ratio=0.11, splice_strain_curvature=0.0,
    ...     splice_strain_cubic=0.0, splice_compliance=0.11 / 450, splice_exponent=1.0,
    ...     splice_limit=0.0, splice_saturation=0.0)
    >>> print(strain.round(4))
    [1.]
    """
    as_positive("relaxed_free_length", relaxed_free_length)
    as_positive("relaxed_splice_length", relaxed_splice_length)
    place, load = as_same_shape(position=position, tension=tension)
    share = relaxed_splice_length / relaxed_free_length
    slope = 1 + share * splice_strain_ratio
    as_positive("1 + splice_strain_ratio * splice length / free length", slope)
    # NaN stays NaN, except for a law that does not depend on tension
    by_tension = _by_tension(
        np.maximum(load, 0.0), splice_compliance, splice_exponent, splice_limit, splice_saturation
    )
    excess = place * (1 / relaxed_free_length) - 1 - share * (1 + splice_offset + by_tension)
    if splice_strain_curvature == splice_strain_cubic == 0:
        return np.asarray(excess / slope)
    if splice_strain_cubic == 0:
        root = slope**2 + 4 * share * splice_strain_curvature * excess
        with np.errstate(invalid="ignore"):
            return np.asarray(2 * excess / (slope + np.sqrt(root)))
    return _cubic_root(excess, slope, share * splice_strain_curvature, share * splice_strain_cubic)


def _by_tension(
    load: Floats, compliance: float, exponent: float, limit: float, saturation: float
) -> Floats:
    """Splice strain by a tension not below zero; zero, also for NaN, if independent of tension."""
    power = compliance * load**exponent if compliance else np.zeros(load.shape)
    return power - limit * np.expm1(-saturation * load) if limit else power


def _cubic_root(excess: Floats, slope: float, square: float, cube: float) -> Floats:
    """Root of a rising cubic through zero, by Newton; NaN where none is within reach."""
    root = np.asarray(excess / slope)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for _ in range(_MOST_STEPS):
            missing = excess - root * (slope + root * (square + root * cube))
            step = missing / (slope + root * (2 * square + 3 * root * cube))
            root = root + step
            if not np.nanmax(np.abs(step), initial=0.0) > _ROUNDING:
                break
        missing = excess - root * (slope + root * (square + root * cube))
        return np.where(np.abs(missing) <= 10 * _ROUNDING * (1 + np.abs(excess)), root, np.nan)


_MOST_STEPS = 30  # of Newton; five suffice

_ROUNDING = 1e-14  # of the strain 1


def _marked_line_strain(
    position: ArrayLike,
    *,
    free_length_intercept: float,
    free_length_slope: float,
    relaxed_free_length: float,
) -> Floats:
    r"""Strain by a straight line of free length on position.

    .. math:: \varepsilon = \frac{a + b\,p}{\ell_0} - 1

    Notes
    -----
    Holds inside the marked range of position and for the tension history of the
    marks: where the same position is visited at another tension, the splices
    have another length, which the line does not describe.  NaN in, NaN out.

    Examples
    --------
    Table 3 of [1]_, new tether, in feet; the tape gives 76.6, 102.3 and 127.1 %.

    >>> strain = _marked_line_strain(
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


def _splice_ratio_strain(
    position: ArrayLike,
    *,
    relaxed_free_length: float,
    relaxed_splice_length: float,
    splice_strain_ratio: float,
) -> Floats:
    r"""Strain for splices whose strain is a constant fraction of the free strain.

    .. math:: \varepsilon = \frac{p - \ell_0 - \ell_s}{\ell_0 + \rho\,\ell_s}

    Notes
    -----
    Zero at the slack length by construction, so it may be used below the lowest
    mark.  A splice stiffens with tension while the rubber softens and stiffens,
    so the ratio is not constant over a wide range.  NaN in, NaN out.

    Examples
    --------
    Table 3 of [1]_, used tether, in feet; the tape gives 77.3, 103.4 and 128.9 %.

    >>> strain = _splice_ratio_strain(
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


def _gauge_length_strain(
    position: ArrayLike, *, reference_position: float, gauge_length: float
) -> Floats:
    r"""Strain of a specimen without splices.

    .. math:: \varepsilon = \frac{p - p_0}{g}

    Notes
    -----
    The whole travel of the crosshead is attributed to the gauge length: compliance of
    grips and machine is not corrected.  The definition is that of the first
    column of Table 4 of [1]_.  NaN in, NaN out.

    Examples
    --------
    Table 4 of [1]_ at 0945: 9.31 in on a gauge length of 6.125 in is 52 %.

    >>> print(_gauge_length_strain(9.31, reference_position=6.125, gauge_length=6.125).round(2))
    0.52
    """
    as_positive("gauge_length", gauge_length)
    as_finite("reference_position", reference_position)
    strain = np.subtract(np.asarray(position, dtype=np.float64), reference_position)
    return np.divide(strain, gauge_length)


_OF_POSITION: dict[StrainMethod, Callable[..., Floats]] = {
    "marks": _marked_line_strain,
    "strain-ratio": _splice_ratio_strain,
    "constant-fraction": free_length_strain,
    "gauge-length": _gauge_length_strain,
}

# a crosshead that returns to its marks overshoots them by its resolution; not an extrapolation
_MARGIN = 0.01


def strain_by_model(
    model: StrainModel,
    *,
    position: ArrayLike,
    tension: ArrayLike,
    measured_strain: ArrayLike | None = None,
) -> Floats:
    """Strain of one specimen by its model.

    Parameters
    ----------
    model : StrainModel
        From `reduction.stages.strain.strain_fit.fit_strain_model`.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Tension of this specimen; used only by ``tension-driven`` and ``mixed``. [N]
    measured_strain : array_like, shape (...), optional
        Channel of the extensometer, if that is the method. [1]

    Returns
    -------
    strain : ndarray, shape (...)
        Nominal strain of the free length. [1]

    Raises
    ------
    DataError
        If the method is ``extensometer`` and there is no measured strain, or a
        coefficient of the model is impossible.

    Notes
    -----
    Computed sample by sample, so that a block of a log gives the same as the whole log.
    NaN in, NaN out.

    Examples
    --------
    The line of Table 3 of [1]_, used tether, in metres:

    >>> line = StrainModel("used", "marks", {"free_length_intercept": -0.83512,
    ...     "free_length_slope": 0.90527, "relaxed_free_length": 2.542})
    >>> print(strain_by_model(line, position=[6.629], tension=[480.0]).round(3))
    [1.032]
    """
    if model.method == "extensometer":
        if measured_strain is None:
            raise DataError(
                f"strain of '{model.specimen}' is to come from an extensometer, and the log has "
                "none",
                needed="a strain channel in the layout, or another strain method",
            )
        return np.asarray(measured_strain, dtype=np.float64)
    return _strain_of(model.method, model.coefficients, position, tension)


def _strain_of(
    method: StrainMethod, coefficients: Mapping[str, float], position: ArrayLike, tension: ArrayLike
) -> Floats:
    if method == "tension-driven":
        return _tension_driven_strain(position, tension, **coefficients)
    if method == "mixed":
        return _mixed_strain(position, tension, **coefficients)
    return _OF_POSITION[method](position, **coefficients)


def extrapolated(model: StrainModel, position: ArrayLike, tension: ArrayLike) -> Bools:
    """Samples outside the range of the marks.

    Notes
    -----
    ``tension-driven`` is bounded in tension, from slack to the highest marked
    tension; the others in position, between the stretched marks.  One per cent of
    the range is allowed for, since a crosshead that returns to its marks overshoots
    them by its resolution.

    Examples
    --------
    >>> line = StrainModel("used", "marks", position_low=5.9, position_high=7.35)
    >>> print(extrapolated(line, [3.74, 6.6, 7.36, 7.5], 4 * [450.0]))
    [ True False False  True]
    """
    if model.method == "tension-driven":
        values, low, high = np.asarray(tension), -np.inf, model.tension_high
        margin = _MARGIN * high
    elif model.method == "mixed":
        # from slack, where the marks begin, to the highest mark
        values, low, high = np.asarray(position), -np.inf, model.position_high
        margin = _MARGIN * (high - model.position_low)
    else:
        values, low, high = np.asarray(position), model.position_low, model.position_high
        margin = _MARGIN * (high - low)
    outside: Bools = values > high + margin
    if np.isfinite(low):
        outside = outside | (values < low - margin)
    return outside


def strain_sensitivity_of(
    model: StrainModel, *, position: ArrayLike, tension: ArrayLike
) -> tuple[tuple[str, ...], Floats]:
    """Change of strain with each coefficient of a model.

    Parameters
    ----------
    model : StrainModel
        Model with coefficients.
    position : array_like, shape (...)
        Crosshead position. [m]
    tension : array_like, shape (...)
        Tension of this specimen. [N]

    Returns
    -------
    names : tuple of str
        Coefficients, in the order of ``model.covariance``. [1]
    sensitivity : ndarray, shape (n_coefficients, ...)
        Strain over coefficient. [SI]

    Raises
    ------
    DataError
        If a coefficient of the model is impossible.

    Notes
    -----
    With the covariance this gives the part of the uncertainty of strain that all
    samples share: it does not average out over cycles.  For ``mixed``, derivatives of the
    implicit equation for strain; for the others, central differences, since strain is a smooth
    function of the coefficients.

    Examples
    --------
    Standard uncertainty of strain from that of a gauge length of 1 m, 2 mm:

    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0}, np.diag([0.0, 0.002**2]))
    >>> names, slope = strain_sensitivity_of(model, position=[0.05], tension=[900.0])
    >>> variance = np.einsum("i...,ij,j...", slope, model.covariance, slope)
    >>> print(np.sqrt(variance).round(6))
    [0.0001]
    """
    names = tuple(model.coefficients)
    if model.method == "mixed":
        slopes = _mixed_sensitivity(position, tension, model.coefficients)
        return names, np.stack([slopes[name] for name in names])
    rows = []
    for name in names:
        value = model.coefficients[name]
        step = 1e-5 * (abs(value) or 1.0)
        high, low = (
            _strain_of(
                model.method, {**model.coefficients, name: value + sign * step}, position, tension
            )
            for sign in (1, -1)
        )
        rows.append((high - low) / (2 * step))
    shape = (0, *np.shape(position))
    return names, np.stack(rows) if rows else np.empty(shape)


def _mixed_sensitivity(
    position: ArrayLike, tension: ArrayLike, coefficients: Mapping[str, float]
) -> dict[str, Floats]:
    r"""Change of `_mixed_strain` with its coefficients, by their names.

    .. math:: \frac{\partial\varepsilon}{\partial\theta}
       = -\frac{\partial g}{\partial\theta} \Big/ \frac{\partial g}{\partial\varepsilon}, \qquad
       g = \ell_0 (1 + \varepsilon) + \ell_s
       (1 + s_0 + \rho\varepsilon + \kappa\varepsilon^2 + \gamma\varepsilon^3 + c F^n
       + a (1 - e^{-b F})) - p
    """
    strain = _mixed_strain(position, tension, **coefficients)
    free, splice = coefficients["relaxed_free_length"], coefficients["relaxed_splice_length"]
    ratio, curvature = coefficients["splice_strain_ratio"], coefficients["splice_strain_curvature"]
    cubic, compliance = coefficients["splice_strain_cubic"], coefficients["splice_compliance"]
    load = np.maximum(np.broadcast_to(np.asarray(tension, dtype=np.float64), strain.shape), 0.0)
    power = load ** coefficients["splice_exponent"]
    square = strain * strain
    limit, saturation = coefficients["splice_limit"], coefficients["splice_saturation"]
    # NaN stays NaN, except for a law that does not depend on tension
    by_power = compliance * power if compliance else np.zeros(strain.shape)
    by_tension = _by_tension(load, compliance, coefficients["splice_exponent"], limit, saturation)
    left = np.exp(-saturation * load)
    of_splices = ratio * strain + curvature * square + cubic * square * strain
    own = {
        "relaxed_free_length": 1 + strain,
        "relaxed_splice_length": 1 + coefficients["splice_offset"] + of_splices + by_tension,
        "splice_offset": np.full(strain.shape, splice),
        "splice_strain_ratio": splice * strain,
        "splice_strain_curvature": splice * square,
        "splice_strain_cubic": splice * square * strain,
        "splice_compliance": splice * power,
        "splice_exponent": splice * by_power * np.log(np.where(load > 0, load, 1.0)),
        "splice_limit": splice * (1 - left),
        "splice_saturation": splice * limit * load * left,
    }
    slope = free + splice * (ratio + 2 * curvature * strain + 3 * cubic * square)
    # where strain is missing, so is its derivative
    return {name: np.where(np.isnan(strain), np.nan, -one / slope) for name, one in own.items()}


# lengths that grow with the free length; methods not listed have none that separates the splices
_SCALED = {
    "tension-driven": "relaxed_free_length",
    "mixed": "relaxed_free_length",
    "strain-ratio": "relaxed_free_length",
    "gauge-length": "gauge_length",
}


def position_by_model(model: StrainModel, *, strain: ArrayLike, tension: ArrayLike) -> Floats:
    r"""Crosshead position, thimble to thimble, for a given strain of the free length.

    .. math:: p = \frac{\varepsilon - \varepsilon(0, F)}{\varepsilon(1, F) - \varepsilon(0, F)}

    Parameters
    ----------
    model : StrainModel
        Model of the specimen, by any method but an extensometer.
    strain : array_like, shape (...)
        Nominal strain of the free length. [1]
    tension : array_like, shape (...)
        Tension at that strain, which stretches the splices of ``tension-driven``. [N]

    Returns
    -------
    position : ndarray, shape (...)
        Length including the splices. [m]

    Raises
    ------
    DataError
        If the method is an extensometer, which does not measure the length of the specimen.

    Notes
    -----
    At a given tension every method but one is a straight line of strain on position.  Two
    positions then give the inverse exactly, and the laws of the splices are in one place.  For
    ``mixed`` the length is the sum of both parts.

    Examples
    --------
    Table 3 of [1]_, used tether: 103.2 % of the free length is 6.629 m from thimble to thimble.

    >>> line = StrainModel("used", "marks", {"free_length_intercept": -0.83512,
    ...     "free_length_slope": 0.90527, "relaxed_free_length": 2.542})
    >>> print(position_by_model(line, strain=[1.032], tension=[480.0]).round(3))
    [6.628]
    """
    if model.method == "extensometer":
        raise DataError(
            f"strain of '{model.specimen}' is from an extensometer, which does not know the length",
            needed="a strain method with a length: marks, strain-ratio, tension-driven, ...",
        )
    stretch, load = np.broadcast_arrays(
        np.asarray(strain, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    )
    if model.method == "mixed":
        return _mixed_length(stretch, load, model.coefficients)
    at_zero = strain_by_model(model, position=np.zeros(load.shape), tension=load)
    at_one = strain_by_model(model, position=np.ones(load.shape), tension=load)
    return np.asarray((stretch - at_zero) / (at_one - at_zero), dtype=np.float64)


def _mixed_length(strain: Floats, tension: Floats, known: dict[str, float]) -> Floats:
    by_tension = _by_tension(
        np.maximum(tension, 0.0),
        known["splice_compliance"],
        known["splice_exponent"],
        known["splice_limit"],
        known["splice_saturation"],
    )
    by_strain = known["splice_strain_ratio"] + strain * (
        known["splice_strain_curvature"] + known["splice_strain_cubic"] * strain
    )
    splices = 1 + known["splice_offset"] + by_strain * strain + by_tension
    return np.asarray(
        known["relaxed_free_length"] * (1 + strain) + known["relaxed_splice_length"] * splices
    )


def with_free_length(model: StrainModel, free_length: float) -> StrainModel:
    """Model of a specimen that is like another one but longer, with the same splices.

    Parameters
    ----------
    model : StrainModel
        Model of the tested specimen.
    free_length : float
        Relaxed length of the new one, splice toe to splice toe. [m]

    Returns
    -------
    model : StrainModel
        With that length; without marks and covariance, which belong to the old one.

    Raises
    ------
    DataError
        If the method does not separate splices from the whole, or the length is not positive.

    Notes
    -----
    A line through the marks, and a constant fraction, hold for the tested length only: the
    share of the splices differs in a longer tether ([1]_, Table 3: a third of 12 ft at rest).

    Examples
    --------
    >>> model = StrainModel("new", "strain-ratio", {"relaxed_free_length": 2.5,
    ...     "relaxed_splice_length": 1.2, "splice_strain_ratio": 0.2})
    >>> longer = with_free_length(model, 10.0)
    >>> print(position_by_model(longer, strain=1.0, tension=0.0).round(2))
    21.44
    """
    length = float(as_positive("free_length", free_length))
    name = _SCALED.get(model.method)
    if name is None:
        raise DataError(
            f"a strain model by {model.method} holds for the length that was tested",
            needed="tension-driven, strain-ratio, mixed or gauge-length",
            hint="These know the splices apart from the free length.",
        )
    coefficients = {**model.coefficients, name: length}
    if model.method == "gauge-length":
        # it begins at the gauge length where the position is a length, otherwise at zero
        old = model.coefficients["gauge_length"]
        begin = model.coefficients["reference_position"]
        coefficients["reference_position"] = begin * length / old
    return replace(
        model,
        coefficients=coefficients,
        covariance=np.empty((0, 0)),
        marks_from="none",
        mark_test=(),
        mark_hold=(),
        mark_position=np.empty(0),
        mark_strain=np.empty(0),
        mark_tension=np.empty(0),
        mark_strain_residual=np.empty(0),
        mark_load_cell=(),
        notes=(*model.notes, note("other-free-length", length=length)),
        law_covariance=np.empty((0, 0)),
        by_marks=None,
    )

"""Comparison error of curves: over strain, at events, in energy, cycle by cycle.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
.. [2] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer," sec. 1-5 (comparison error E = S - D).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.compare.measuredcurve import CurveName, MeasuredCurve
from reduction.compare.product import CycleDifference, Difference, EnergyDifference
from reduction.errors import DataError
from reduction.record import Floats


def difference_of(
    strain: ArrayLike, predicted: ArrayLike, measured: ArrayLike, *, curve: CurveName
) -> Difference:
    """Comparison error E = predicted - measured of one curve.

    Parameters
    ----------
    strain : array_like, shape (n_strain,)
        Common axis, equally spaced. [1]
    predicted : array_like, shape (n_strain,)
        NaN where the cords are broken. [N]
    measured : array_like, shape (n_strain,)
        NaN where not visited. [N]
    curve : {"ascending", "descending", "midline"}
        Which curve was measured.

    Returns
    -------
    difference : Difference
        Over the strains at which both are known. [N]

    Raises
    ------
    DataError
        If the series do not pair up, or there is no strain at which both are known.

    Notes
    -----
    Positive where the prediction is above the test [2]_.  The relative RMS is the RMS of the
    error over the RMS of the measured tension, both at the same strains; unlike a mean of
    relative errors it is not ruled by the start of the curve, where tension goes to zero, and it
    is 1 for a prediction of nothing.  Strains count alike: the axis is equally spaced.

    Examples
    --------
    >>> found = difference_of(
    ...     [0.0, 0.1, 0.2], [0.0, 33.0, 44.0], [0.0, 30.0, 40.0], curve="midline"
    ... )
    >>> print(round(found.rms, 3), found.relative_rms, found.worst_strain, found.worst_difference)
    2.887 0.1 0.2 4.0
    """
    x, model, test = as_same_shape(strain=strain, predicted=predicted, measured=measured)
    error = model - test
    both = np.isfinite(error)
    if not both.any():
        raise DataError(
            f"prediction and {curve} curve have no strain in common",
            found=f"measured at {_range(x, np.isfinite(test))}, "
            f"predicted at {_range(x, np.isfinite(model))}",
            needed="a strain at which both are known",
        )
    worst = int(np.nanargmax(np.abs(error)))
    rms = float(np.sqrt(np.mean(error[both] ** 2)))
    level = float(np.sqrt(np.mean(test[both] ** 2)))
    return Difference(
        curve=curve,
        strain=x,
        difference=error,
        n_strain=int(both.sum()),
        bias=float(error[both].mean()),
        rms=rms,
        relative_rms=rms / level if level > 0 else float("nan"),
        worst_strain=float(x[worst]),
        worst_difference=float(error[worst]),
    )


def _range(strain: Floats, there: np.ndarray) -> str:
    if not there.any():
        return "no strain"
    return f"{100 * strain[there].min():.4g} to {100 * strain[there].max():.4g} %"


def strain_at_tension(strain: ArrayLike, tension: ArrayLike, level: float) -> float:
    """Strain at which a measured curve first reaches a tension.

    Parameters
    ----------
    strain : array_like, shape (n_strain,)
        Rising. [1]
    tension : array_like, shape (n_strain,)
        NaN where not visited. [N]
    level : float
        The tension. [N]

    Returns
    -------
    reached : float
        Between two points on the straight line; NaN where the curve begins above the level
        or does not reach it. [1]

    Raises
    ------
    DataError
        If the series do not pair up.

    Examples
    --------
    >>> print(round(strain_at_tension([0.0, 0.1, 0.2], [0.0, 10.0, 30.0], 15.0), 6))
    0.125
    """
    x, y = as_same_shape(strain=strain, tension=tension)
    there = np.isfinite(y)
    x, y = x[there], y[there]
    above = np.flatnonzero(y >= level)
    if not above.size or (above[0] == 0 and y[0] > level):
        return float("nan")
    k = int(above[0])
    if k == 0:
        return float(x[0])
    return float(x[k - 1] + (level - y[k - 1]) / (y[k] - y[k - 1]) * (x[k] - x[k - 1]))


def energy_difference(predicted: ArrayLike, measured: MeasuredCurve) -> EnergyDifference:
    """Energy under the ascending branch, and of the loop, beside the elastic prediction.

    Parameters
    ----------
    predicted : array_like, shape (n_strain,)
        Tension at the strains of the measured curve. [N]
    measured : MeasuredCurve
        The test. [SI]

    Returns
    -------
    energy : EnergyDifference
        Between the first and the last strain at which all are known; NaN where there are
        fewer than two. [J m-1]

    Raises
    ------
    DataError
        If the prediction is not on the axis of the test.

    Notes
    -----
    Trapezoid.  What a cyclic test takes up and does not give back is the loop; an elastic
    prediction has none, and lies below the ascending branch by about half of it even where the
    midline agrees.

    Examples
    --------
    >>> from reduction.compare.measured import measured_curve
    >>> stroke = np.linspace(0, 1, 201)
    >>> pull = measured_curve(stroke, 100 * stroke, loading="static")
    >>> energy = energy_difference(110 * pull.strain, pull)
    >>> print(round(energy.measured, 6), round(energy.difference, 6), energy.loop)
    50.0 5.0 nan
    """
    model, up = as_same_shape(predicted=predicted, measured=measured.branch_tension[0])
    down = measured.branch_tension[1]
    has_loop = bool(np.isfinite(down).any())
    there = np.isfinite(model) & np.isfinite(up)
    if has_loop:
        there &= np.isfinite(down)
    if np.count_nonzero(there) < 2:
        return EnergyDifference(*[float("nan")] * 7)
    x = measured.strain[there]
    taken, stored = (float(np.trapezoid(curve[there], x)) for curve in (up, model))
    loop = taken - float(np.trapezoid(down[there], x)) if has_loop else float("nan")
    return EnergyDifference(
        strain_low=float(x[0]),
        strain_high=float(x[-1]),
        measured=taken,
        predicted=stored,
        difference=stored - taken,
        loop=loop,
        loop_share=loop / taken if taken > 0 else float("nan"),
    )


def cycle_differences(predicted: ArrayLike, measured: MeasuredCurve) -> CycleDifference:
    """Comparison error of every cycle, and its trend over the cycles.

    Parameters
    ----------
    predicted : array_like, shape (n_strain,)
        Tension at the strains of the measured curve. [N]
    measured : MeasuredCurve
        The test. [SI]

    Returns
    -------
    cycles : CycleDifference
        Bias and RMS of each, slope of the bias over the logarithm of the cycle number. [N]

    Raises
    ------
    DataError
        If the prediction is not on the axis of the test.

    Notes
    -----
    The bias of a cycle is that of the mean curve less what the cycle lies above it, so that a
    cycle that did not go as far has no bias of its own making.  A hose that softens from cycle
    to cycle has a bias that rises.

    Examples
    --------
    Each cycle 10 N below the one before: 1 to 3 is 0.477 decades.

    >>> from reduction.compare.measured import measured_curve
    >>> stroke = np.tile(np.concatenate([np.linspace(0, 1, 301), np.linspace(1, 0, 301)]), 3)
    >>> number = np.repeat([1, 2, 3], 602)
    >>> test = measured_curve(
    ...     stroke, 500 * stroke - 10 * number, loading="static", cycle_number=number,
    ...     branch=np.tile(np.repeat([1, 2], 301), 3),
    ... )
    >>> print(cycle_differences(500 * test.strain, test).bias.round(6))
    [10. 20. 30.]
    """
    model, mean = as_same_shape(predicted=predicted, measured=measured.tension_of(measured.judged))
    is_midline = measured.judged == "midline"
    each = measured.tension.mean(axis=1) if is_midline else measured.tension[:, 0]
    there = np.isfinite(each) & np.isfinite(model) & np.isfinite(mean)
    n = np.where(there.any(axis=1), there.sum(axis=1), np.nan)
    whole = np.isfinite(model) & np.isfinite(mean)
    above = np.where(there, each - mean, 0.0).sum(axis=1) / n
    squares = np.where(there, (model - each) ** 2, 0.0).sum(axis=1) / n
    bias = (float((model - mean)[whole].mean()) if whole.any() else np.nan) - above
    slope, slope_uncertainty = _slope(np.log10(measured.cycle_number), bias)
    return CycleDifference(
        cycle_number=measured.cycle_number,
        bias=bias,
        rms=np.sqrt(squares),
        bias_per_decade=slope,
        bias_per_decade_standard_uncertainty=slope_uncertainty,
    )


def _slope(x: Floats, y: Floats) -> tuple[float, float]:
    there = np.isfinite(y)
    x, y = x[there], y[there]
    if x.size < 3:
        return float("nan"), float("nan")
    x, y = x - x.mean(), y - y.mean()
    slope = float(x @ y / (x @ x))
    spread = float(np.sum((y - slope * x) ** 2) / (x.size - 2))
    return slope, float(np.sqrt(spread / (x @ x)))

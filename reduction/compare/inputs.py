"""What the tension of a predicted hose may be off by: its uncertain numbers, and its cord curve.

References
----------
.. [1] JCGM 101:2008, "Propagation of distributions using a Monte Carlo method."
.. [2] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer," sec. 2 (u_num).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import scipy

from reduction.checks import as_spread
from reduction.compare.trials import number_of, range_of, trial_tension
from reduction.predict.cordcurve import CordCurve
from reduction.predict.cordload import cord_load
from reduction.predict.product import HOSE_PARAMETERS, HoseDesign
from reduction.record import Floats

_CUT = 3.0
_BETWEEN = 16  # steps from one point of a cord curve to the next
_LEAST_POINTS = 4  # of a cord curve, for a spline that is another one than the straight line
_SEED = 20  # any; that it stays makes answers repeatable


def input_draws(
    design: HoseDesign,
    standard_uncertainty: Mapping[str, float],
    strain: Floats,
    *,
    n_draws: int,
) -> Floats:
    """What the tension of a hose may be off by, in draws of its uncertain numbers.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    standard_uncertainty : mapping of str to float
        By name of `reduction.predict.product.HOSE_PARAMETERS`, in SI. [rad, m, m-1, Pa or 1]
    strain : ndarray, shape (n_strain,)
        Of the whole length. [1]
    n_draws : int
        Hoses that are drawn; the same ones every time. [1]

    Returns
    -------
    error : ndarray, shape (n_draws, n_strain)
        Tension of the drawn hose less that of the design; no rows where nothing is uncertain. [N]

    Raises
    ------
    SettingsError
        If there is no such number, an uncertainty is negative or unknown, or so large that
        what is drawn is no hose.

    Notes
    -----
    Normal and independent, cut at three standard uncertainties and at the range of the number
    (propagation of distributions, [1]_).  Where cords pick up, tension is no linear function
    of the angle over the width of its uncertainty, and no covariance from derivatives has the
    shapes of curve that it makes.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> error = input_draws(design, {"rubber_modulus": 1e5}, np.array([0.0, 0.2]), n_draws=500)
    >>> print(error.shape, error[:, 0].max(), bool(abs(error[:, 1].std() / 143 - 1) < 0.1))
    (500, 2) 0.0 True
    """
    known = known_uncertainties(design, standard_uncertainty)
    if not known:
        return np.zeros((0, strain.size))
    normal = np.random.default_rng(_SEED).standard_normal((n_draws, len(HOSE_PARAMETERS)))
    steps = np.clip(normal, -_CUT, _CUT)
    values = np.stack(
        [
            np.clip(
                number_of(design, name) + spread * steps[:, HOSE_PARAMETERS.index(name)],
                *range_of(name),
            )
            for name, spread in known.items()
        ],
        axis=1,
    )
    centre = np.array([[number_of(design, name) for name in known]])
    tension = trial_tension(design, tuple(known), np.vstack([centre, values]), strain)
    return np.asarray(tension[1:] - tension[0])


def cord_curve_error(design: HoseDesign, strain: Floats) -> Floats:
    """What the tension may be off by since the cord curve is known at its points alone.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    strain : ndarray, shape (n_strain,)
        Of the whole length. [1]

    Returns
    -------
    error : ndarray, shape (n_strain,)
        Signed, one standard uncertainty; zero for a curve of fewer than four points. [N]

    Raises
    ------
    Nothing
        Where the spline falls, there is no other curve than the monotone one.

    Notes
    -----
    Tension with a cubic spline through the points less that with the monotone cubic. Nobody
    states this error: it is one of the numerical solution [2]_.  It is a few newtons for a curve
    of fourteen points, far below the noise of any one strain; but it is smooth and bends the
    curve as a scale of the cord strain does, of which a fit would make two standard deviations.

    Examples
    --------
    Points on a straight line leave nothing open.

    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.linspace(0.0, 0.2, 5), np.linspace(0.0, 130.0, 5)))
    >>> print(np.abs(cord_curve_error(design, np.array([0.5, 1.0]))).max() < 1e-6)
    True
    """
    points = design.cord
    if points.strain.size < _LEAST_POINTS:
        return np.zeros(strain.size)
    steps = np.arange(_BETWEEN) / _BETWEEN
    dense = points.strain[:-1, None] + np.diff(points.strain)[:, None] * steps
    plain = cord_load(points, dense.ravel()).reshape(dense.shape)
    other = np.asarray(scipy.interpolate.CubicSpline(points.strain, points.load)(dense))
    whole = np.hstack([other, points.load[1:, None]])
    other = np.where(np.all(np.diff(whole, axis=1) > 0, axis=1)[:, None], other, plain)
    curves = (
        CordCurve(np.append(dense, points.strain[-1]), np.append(load, points.load[-1]))
        for load in (other, plain)
    )
    scale = np.array([[number_of(design, "cord_load_scale")]])
    spline, monotone = (
        trial_tension(replace(design, cord=curve), ("cord_load_scale",), scale, strain)[0]
        for curve in curves
    )
    return np.asarray(spline - monotone)


def known_uncertainties(
    design: HoseDesign, standard_uncertainty: Mapping[str, float]
) -> dict[str, float]:
    """Uncertainties above zero, in the order of `HOSE_PARAMETERS`.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    standard_uncertainty : mapping of str to float
        By name of `reduction.predict.product.HOSE_PARAMETERS`. [SI]

    Returns
    -------
    known : dict of str to float
        Those that are stated and not zero. [SI]

    Raises
    ------
    SettingsError
        If there is no such number, or an uncertainty is negative or unknown.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(known_uncertainties(design, {"rubber_modulus": 1e5, "wrap_angle": 0.0}))
    {'rubber_modulus': 100000.0}
    """
    for name, spread in standard_uncertainty.items():
        number_of(design, name)
        as_spread(name, spread)
    return {
        name: float(standard_uncertainty[name])
        for name in HOSE_PARAMETERS
        if standard_uncertainty.get(name, 0) > 0
    }

"""Tension of a hose at other values of its numbers, without a gap where cords would break.

References
----------
.. [1] M. Norgaard, N. K. Poulsen and O. Ravn, "New developments in state estimation for
   nonlinear systems," Automatica, vol. 36, 2000 (divided differences over sqrt(3) standard
   deviations).
.. [2] JCGM 101:2008, "Propagation of distributions using a Monte Carlo method."
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi, sqrt
from typing import Any

import numpy as np

from reduction.errors import SettingsError
from reduction.predict.events import find_events
from reduction.predict.hose import predict_hose
from reduction.predict.product import HOSE_PARAMETERS, HoseDesign
from reduction.predict.sensitivity import hose_sensitivity
from reduction.record import Floats

__all__ = ["design_with", "input_contributions", "input_draws", "number_of", "trial_tension"]

_WIDTH = sqrt(3.0)
_LOWEST = {"dead_length_share": 0.0, "rubber_modulus": 0.0}
_SMALLEST = 1e-6  # of what has to be above zero
_CUT = 3.0
_SEED = 20  # any; that it stays makes answers repeatable


def number_of(design: HoseDesign, name: str) -> float:
    """A number of one design by its name.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    name : str
        Of `reduction.predict.product.HOSE_PARAMETERS`; ``layer_diameter`` is the mean of the two.

    Returns
    -------
    value : float
        In the unit of the number. [SI]

    Raises
    ------
    SettingsError
        If there is no such number, or the design is many.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(round(number_of(design, "layer_diameter"), 6))
    0.085
    """
    if name not in HOSE_PARAMETERS:
        raise SettingsError(
            "no such number of a hose", found=name, needed="one of " + ", ".join(HOSE_PARAMETERS)
        )
    if design.shape:
        raise SettingsError(
            "a comparison is of one hose", found=f"designs of shape {design.shape}", needed="one"
        )
    return float(design.wrap_diameter if name == "layer_diameter" else getattr(design, name))


def design_with(design: HoseDesign, numbers: Mapping[str, Any]) -> HoseDesign:
    """The design with some of its numbers replaced.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    numbers : mapping of str to float or ndarray
        By name; a ``layer_diameter`` moves both layers alike. [SI]

    Returns
    -------
    changed : HoseDesign
        One hose, or many where a number is an array.

    Raises
    ------
    SettingsError
        If there is no such number, or no hose has these.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> print(design_with(design, {"wrap_angle": 1.2}).wrap_angle)
    1.2
    """
    changes: dict[str, Any] = {}
    for name, value in numbers.items():
        before = number_of(design, name)
        if name == "layer_diameter":
            inner, outer = design.layer_diameter
            changes[name] = (inner + (value - before), outer + (value - before))
        else:
            changes[name] = value
    return replace(design, **changes)


def trial_tension(
    design: HoseDesign, names: Sequence[str], values: Floats, strain: Floats
) -> Floats:
    """Tension at trial values of some numbers.

    Parameters
    ----------
    design : HoseDesign
        One hose, from which the other numbers are.
    names : sequence of str, length n_parameter
        Numbers that are tried.
    values : ndarray, shape (n_trial, n_parameter)
        Of each trial. [SI]
    strain : ndarray, shape (n_strain,)
        Of the whole length. [1]

    Returns
    -------
    tension : ndarray, shape (n_trial, n_strain)
        Finite everywhere. [N]

    Raises
    ------
    SettingsError
        If no hose has these numbers.

    Notes
    -----
    A trial hose whose cords would break below a strain that was measured has no tension there,
    and a fit would fall into the gap.  Its curve goes on along its tangent at the break, which
    joins it without a step at any value of the numbers.

    Examples
    --------
    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> steps = np.array([0.0, 1.0, 5.0])
    >>> print(np.isfinite(trial_tension(design, ["wrap_angle"], np.array([[1.1]]), steps)).all())
    True
    """
    trials = design_with(design, {name: values[:, k] for k, name in enumerate(names)})
    tension = np.array(predict_hose(trials, strain).tension)
    gap = ~np.isfinite(tension)
    if gap.any():
        last = find_events(trials).cord_break
        slope = hose_sensitivity(trials, strain[:1]).cord_break.stiffness
        onward = last.tension[:, None] + slope[:, None] * (strain - last.strain[:, None])
        tension[gap] = onward[gap]
    return tension


def input_contributions(
    design: HoseDesign, standard_uncertainty: Mapping[str, float], strain: Floats
) -> tuple[tuple[str, ...], Floats]:
    r"""What the uncertain numbers of a design do to its tension, through the kinks of the curve.

    With :math:`T_\pm` at :math:`\pm\sqrt 3` standard uncertainties of one number, a change in
    proportion and a bend are

    .. math:: c_1 = \frac{T_+ - T_-}{2\sqrt 3}, \qquad
              c_2 = \frac{T_+ + T_- - 2 T_0}{2\sqrt 3}

    Parameters
    ----------
    design : HoseDesign
        One hose.
    standard_uncertainty : mapping of str to float
        By name of `reduction.predict.product.HOSE_PARAMETERS`, in SI. [rad, m, m-1, Pa or 1]
    strain : ndarray, shape (n_strain,)
        Of the whole length. [1]

    Returns
    -------
    source : tuple of str, length n_source
        Names, with "bend of" before that of a second contribution.
    contribution : ndarray, shape (n_source, n_strain)
        Signed, one standard uncertainty each. [N]

    Raises
    ------
    SettingsError
        If there is no such number, or an uncertainty is negative or unknown.

    Notes
    -----
    Half a degree of wrap angle moves the strain at which the cords pick up by several points.
    Just below it the derivative is that of the rubber alone, and would call a hose wrong whose
    cords pick up a little earlier; a difference over the width of the distribution does not
    [1]_.  The bend is the mean square of a quadratic term, E[z^4] = 3, so that the shift
    of the mean that it brings is in it.  A number that would leave its range (a dead length
    below zero) is cut there, and the difference taken over what is left.

    Examples
    --------
    A scale of the cord load has no bend: the curve is linear in it.

    >>> from reduction.predict.cordcurve import CordCurve
    >>> design = HoseDesign(1.1, (0.08, 0.09), 0.06, 0.12, 1300.0, 5e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> source, parts = input_contributions(design, {"cord_load_scale": 0.1}, np.array([0.9]))
    >>> print(source, bool(abs(parts[1, 0]) < 1e-9 * parts[0, 0]))
    ('cord_load_scale', 'bend of cord_load_scale') True
    """
    names, rows = [], []
    for name, spread in _known(design, standard_uncertainty).items():
        centre = number_of(design, name)
        ends = np.clip(centre + _WIDTH * spread * np.array([-1.0, 1.0]), *_range_of(name))
        below, above = (centre - ends[0]) / spread, (ends[1] - centre) / spread
        values = np.array([ends[0], centre, ends[1]])[:, None]
        low, middle, high = trial_tension(design, [name], values, strain)
        bend = np.zeros(strain.size)
        if below > 0 and above > 0:
            bend = 2 * ((high - middle) / above - (middle - low) / below) / (above + below)
        names += [name, f"bend of {name}"]
        rows += [(high - low) / (above + below), sqrt(3.0) / 2 * bend]
    return tuple(names), np.array(rows).reshape(-1, strain.size)


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
    (propagation of distributions, [2]_).  Where cords pick up, tension is no linear function
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
    known = _known(design, standard_uncertainty)
    if not known:
        return np.zeros((0, strain.size))
    normal = np.random.default_rng(_SEED).standard_normal((n_draws, len(HOSE_PARAMETERS)))
    steps = np.clip(normal, -_CUT, _CUT)
    values = np.stack(
        [
            np.clip(
                number_of(design, name) + spread * steps[:, HOSE_PARAMETERS.index(name)],
                *_range_of(name),
            )
            for name, spread in known.items()
        ],
        axis=1,
    )
    centre = np.array([[number_of(design, name) for name in known]])
    tension = trial_tension(design, tuple(known), np.vstack([centre, values]), strain)
    return np.asarray(tension[1:] - tension[0])


def _known(design: HoseDesign, standard_uncertainty: Mapping[str, float]) -> dict[str, float]:
    """Uncertainties above zero, in the order of `HOSE_PARAMETERS`."""
    for name, spread in standard_uncertainty.items():
        number_of(design, name)
        if not (np.isfinite(spread) and spread >= 0):
            raise SettingsError(
                f"the standard uncertainty of {name} cannot be used",
                found=f"{spread:g}",
                needed="zero or more",
            )
    return {
        name: float(standard_uncertainty[name])
        for name in HOSE_PARAMETERS
        if standard_uncertainty.get(name, 0) > 0
    }


def _range_of(name: str) -> tuple[float, float]:
    if name == "wrap_angle":
        return _SMALLEST, pi / 2 - _SMALLEST
    return _LOWEST.get(name, _SMALLEST), 0.99 if name == "dead_length_share" else np.inf

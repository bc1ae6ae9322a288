"""Tension of a hose at other values of its numbers, without a gap where cords would break.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004,
   sec. 1.2: the numbers that make a hose.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

from reduction.errors import SettingsError
from reduction.predict.events import find_events
from reduction.predict.hose import predict_hose
from reduction.predict.product import HOSE_PARAMETERS, HoseDesign
from reduction.predict.sensitivity import hose_sensitivity
from reduction.record import Floats

_LOWEST = {"dead_length_share": 0.0, "rubber_modulus": 0.0}
_SMALLEST = 1e-6  # of what has to be above zero


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


def range_of(name: str) -> tuple[float, float]:
    """Between what a number of a hose has to lie.

    Parameters
    ----------
    name : str
        Of `reduction.predict.product.HOSE_PARAMETERS`.

    Returns
    -------
    low, high : float
        In the unit of the number. [SI]

    Raises
    ------
    Nothing
        A name of no number has the range of one that has to be above zero.

    Examples
    --------
    >>> print(range_of("dead_length_share"))
    (0.0, 0.99)
    """
    if name == "wrap_angle":
        return _SMALLEST, pi / 2 - _SMALLEST
    return _LOWEST.get(name, _SMALLEST), 0.99 if name == "dead_length_share" else np.inf

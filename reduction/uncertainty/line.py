r"""What shared errors do to a slow pull, and to the three parameters of a line.

.. math:: S = d\varepsilon / dT = 1 / K_0, \qquad
          \delta S = S \frac{\partial\,\delta\varepsilon}{\partial\varepsilon}
              + \frac{\partial\,\delta\varepsilon}{\partial T}
              - S \frac{\partial\,\delta T}{\partial T} - S' \delta T

The load cell of the pull is that of the loops: its gain enters E' and K_0 alike, and their
difference by no more than its own share.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.2.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1 and 4.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.line.sensitivity import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    line_sensitivities,
)
from reduction.record import Floats
from reduction.uncertainty.field import ErrorField
from reduction.uncertainty.product import Contributions

_K_0 = "quasi_static_spring_constant"


def pull_contributions(
    field: ErrorField, *, quasi_static_spring_constant: ArrayLike, compliance_slope: ArrayLike
) -> Contributions:
    r"""Contributions to the quasi-static spring constant at given tensions of a slow pull.

    Parameters
    ----------
    field : ErrorField
        At the points of the pull, shape (...).
    quasi_static_spring_constant : array_like, shape (...)
        K_0. [N]
    compliance_slope : array_like, shape (...)
        Second derivative of strain over tension, S'. [N-2]

    Returns
    -------
    contributions : Contributions
        ``quasi_static_spring_constant``. [N]

    Raises
    ------
    DataError
        If shapes differ.

    Notes
    -----
    First order ([1]_).  A lag at the rate of a slow pull counts as nothing.

    Examples
    --------
    1 % of load cell gain is 1 % of a constant K_0:

    >>> from reduction.strain.model import StrainModel
    >>> from reduction.uncertainty.field import error_field
    >>> from reduction.uncertainty.product import InstrumentErrors
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> field = error_field(InstrumentErrors("rope", tension_gain=0.01), model,
    ...     strain=0.5, tension=900.0)
    >>> print(pull_contributions(field, quasi_static_spring_constant=2e3, compliance_slope=0.0)
    ...     .values["quasi_static_spring_constant"])
    [20.]
    """
    constant, bend = as_same_shape(
        quasi_static_spring_constant=quasi_static_spring_constant,
        compliance_slope=compliance_slope,
    )
    compliance = 1 / constant
    change = (
        compliance * (field.strain_slope - field.tension_slope)
        + field.strain_slope_over_tension
        - bend * field.tension
    )
    return Contributions(field.component, {_K_0: -(constant**2) * change})


def line_contributions(
    of_loops: Contributions,
    of_pull: Contributions,
    values: Mapping[str, Floats],
    *,
    reading: Literal["amplitude", "fundamental"],
) -> Contributions:
    """Contributions to storage, loss, K_1, tau and N = K_1 tau of lines.

    Parameters
    ----------
    of_loops : Contributions
        To the quantities of the loops, from `reduction.uncertainty.loops.loop_contributions`.
    of_pull : Contributions
        To the quasi-static spring constant, of the same shape.
    values : mapping of str to ndarray, shape (...)
        The numbers themselves, by name: inputs and results. [SI]
    reading : {"amplitude", "fundamental"}
        From which quantities of the loop the line was found.

    Returns
    -------
    contributions : Contributions
        By name of `reduction.line.sensitivity.OUTPUTS`; NaN where the line has no such number.

    Raises
    ------
    KeyError
        If a quantity is not given.

    Notes
    -----
    By the logarithmic derivatives of eqs. 1 and 4 of [2]_ (`reduction.line.sensitivity`).

    Examples
    --------
    A gain that enters the loop and K_0 alike enters K_1 alike, and tau not at all:

    >>> from reduction.uncertainty.product import Component
    >>> cell = (Component("tension_gain", "cell"),)
    >>> known = {"storage_spring_constant": np.array([3.0]), "loss_spring_constant":
    ...     np.array([1.0]), "quasi_static_spring_constant": np.array([2.0]),
    ...     "dissipation_spring_constant": np.array([2.0]), "relaxation_time": np.array([0.3]),
    ...     "dashpot_coefficient": np.array([0.6])}
    >>> loops = {name: 0.01 * known[name][None] for name in list(known)[:2]}
    >>> rest = {"quasi_static_spring_constant": np.array([[0.02]])}
    >>> found = line_contributions(Contributions(cell, loops), Contributions(cell, rest), known,
    ...     reading="fundamental")
    >>> print(found.values["dissipation_spring_constant"].round(6))
    [[0.02]]
    >>> print(np.abs(found.values["relaxation_time"]).max() < 1e-15)
    True
    """
    inputs = AMPLITUDE_INPUTS if reading == "amplitude" else FUNDAMENTAL_INPUTS
    slopes = (amplitude_sensitivities if reading == "amplitude" else line_sensitivities)(
        values["storage_spring_constant"], values["loss_spring_constant"], values[_K_0]
    )
    component = tuple(sorted({*of_loops.component, *of_pull.component}))
    shape = np.shape(values[_K_0])
    relative = np.zeros((len(component), len(inputs), *shape))
    for place, name in enumerate(inputs):
        source = of_pull if name == _K_0 else of_loops
        if name in source.values:
            rows = [component.index(one) for one in source.component]
            relative[rows, place] = source.values[name] / values[name]
    found = {}
    for row, name in enumerate(OUTPUTS):
        with np.errstate(invalid="ignore"):
            found[name] = values[name] * np.sum(slopes[row] * relative, axis=1)
    return Contributions(component, found)

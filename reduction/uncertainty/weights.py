r"""What shared errors do to a stepwise test: weights, a gauge length, strain, warmth, a diameter.

.. math::

    \frac{\delta E_{sec}}{E_{sec}} &= \frac{\delta T}{T}
        + \frac{1 + \varepsilon}{\varepsilon} \frac{\delta g}{g} - g_\varepsilon + s
        - 2 \frac{\delta d}{d} \\
    \frac{\delta E_{int}}{E_{int}} &= g_T + \frac{\delta g}{g} - g_\varepsilon + s
        - 2 \frac{\delta d}{d}

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, Table 4.
"""

from __future__ import annotations

import numpy as np

from reduction.moduli.stepwise import StepwiseResult
from reduction.record import Floats
from reduction.uncertainty.points import with_diameter
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors


def stepwise_contributions(
    result: StepwiseResult, errors: InstrumentErrors, *, area: float
) -> Contributions:
    """Contributions to the strains and moduli of one stepwise test.

    Parameters
    ----------
    result : StepwiseResult
        As reduced, with the standard uncertainty of its gauge length.
    errors : InstrumentErrors
        Of the weights (tension), of strain, of the temperature and of the diameter.
    area : float
        Nominal. [m2]

    Returns
    -------
    contributions : Contributions
        ``tension`` [N], ``strain`` [1], ``secant_modulus`` [Pa], shape (n_components, n_steps),
        and ``interval_modulus`` [Pa], (n_components, n_steps - 1).

    Raises
    ------
    DataError
        If the area is not positive.

    Notes
    -----
    First order ([1]_).  One gauge length is in every strain: on Table 4 of [2]_ it is the one
    that the recorded elongations give.

    Examples
    --------
    Weights that are 1 % heavier than they say:

    >>> from reduction.moduli.stepwise import reduce_stepwise
    >>> from reduction.record import StepReadings
    >>> nothing = np.full(3, np.nan)
    >>> readings = StepReadings(clock=("a", "b", "c"), time=np.arange(3.0),
    ...     tension=np.array([0.0, 50.0, 100.0]), length=np.array([0.1, 0.15, 0.2]),
    ...     eye_to_eye_length=nothing, printed_strain=nothing)
    >>> test = reduce_stepwise(readings, area=1e-4, stated_gauge_length=0.1)
    >>> found = stepwise_contributions(test, InstrumentErrors("new", tension_gain=0.01), area=1e-4)
    >>> print(found.values["interval_modulus"].round(3))
    [[10000. 10000.]]
    """
    load, strain = result.tension, result.strain
    secant, interval = result.secant_modulus, result.interval_modulus
    component: list[Component] = []
    rows: list[tuple[Floats, Floats, Floats, Floats]] = []
    nothing, between = np.zeros(load.shape), np.zeros(interval.shape)
    for source, gain, offset in (
        ("tension_gain", errors.tension_gain, 0.0),
        ("tension_offset", 0.0, errors.tension_offset),
    ):
        if gain or offset:
            component.append(Component(source, errors.tension_instrument))
            change = gain * load + offset
            with np.errstate(divide="ignore", invalid="ignore"):
                of_secant = change / (area * strain)
            rows.append((change, nothing, of_secant, gain * interval))
    for of_strain, own in (
        # dead weights are what they are in the warmth: a stiffer rubber stretches less under them
        (-errors.stiffness, Component("temperature", errors.test)),
        (errors.strain_gain, Component("strain_gain", errors.strain_model or errors.specimen)),
    ):
        if of_strain:
            component.append(own)
            rows.append((nothing, of_strain * strain, -of_strain * secant, -of_strain * interval))
    relative = result.gauge_length_standard_uncertainty / result.gauge_length
    if np.isfinite(relative) and relative > 0:
        component.append(Component("gauge_length", errors.specimen))
        with np.errstate(divide="ignore", invalid="ignore"):
            of_secant = secant * (1 + strain) / strain * relative
        rows.append((nothing, -(1 + strain) * relative, of_secant, interval * relative))
    names = ("tension", "strain", "secant_modulus", "interval_modulus")
    like = (nothing, nothing, nothing, between)
    values = {
        name: np.stack([row[place] for row in rows]) if rows else np.empty((0, *one.shape))
        for place, (name, one) in enumerate(zip(names, like, strict=True))
    }
    moduli = {"secant_modulus": secant, "interval_modulus": interval}
    return with_diameter(Contributions(tuple(component), values), errors, moduli, area=area)

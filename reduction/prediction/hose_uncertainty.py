r"""Uncertainty of a hose prediction, by source.

.. math:: \delta_i T = \frac{\partial T}{\partial x_i} u(x_i), \qquad
          u^2(T) = \sum_i (\delta_i T)^2

Each contribution keeps its sign along the whole curve: one wrong angle moves all of it, so the
errors at two strains are not independent.  For a difference between two points (a modulus, an
energy) the contributions are subtracted before they are squared.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty
   in measurement," 5.1 (the law of propagation) and 5.2 (correlated quantities).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri

from reduction.prediction.hose_product import HOSE_PARAMETERS, HoseDesign
from reduction.prediction.hose_sensitivity import EventSensitivity, hose_sensitivity
from reduction.prediction.hose_tension import find_events, predict_hose
from reduction.record.errors import SettingsError
from reduction.record.measurement import Floats, read_only_arrays

PICK_UP = "pick_up"
"""Source of the load that cords may carry although they are slack in the design."""

_QUANTILES = (np.arange(400) + 0.5) / 400


@dataclass(frozen=True)
@read_only_arrays
class EventUncertainty:
    """Uncertainty of an event of the cords: contributions (n_source, ...) and their sum (...)."""

    strain_contribution: Floats
    tension_contribution: Floats
    fill_pressure_contribution: Floats
    strain_standard_uncertainty: Floats
    tension_standard_uncertainty: Floats
    fill_pressure_standard_uncertainty: Floats


@dataclass(frozen=True)
@read_only_arrays
class HoseUncertainty:
    """Effect of each uncertain parameter of a design on its prediction.

    Contributions are signed, and have the shape (n_source, ...) before the axes of the quantity.

    Parameters
    ----------
    source : tuple of str, length n_source
        Names from `reduction.prediction.hose_product.HOSE_PARAMETERS`, in that order, followed by
        `PICK_UP` from `with_pick_up`.
    strain : ndarray, shape (n_strain,)
        Strain of the whole relaxed length. [1]
    tension_contribution, fill_pressure_contribution : ndarray, shape (n_source, ..., n_strain)
        At constant strain; NaN where the cords are broken. [N], [Pa]
    tension_standard_uncertainty, fill_pressure_standard_uncertainty : ndarray, (..., n_strain)
        Root of the sum of squares. [N], [Pa]
    deepest_slack, pick_up, working, cord_break : EventUncertainty
        Where the cords are shortest, pick up, carry the working share of their break load, break.
    """

    source: tuple[str, ...]
    strain: Floats
    tension_contribution: Floats
    fill_pressure_contribution: Floats
    tension_standard_uncertainty: Floats
    fill_pressure_standard_uncertainty: Floats
    deepest_slack: EventUncertainty
    pick_up: EventUncertainty
    working: EventUncertainty
    cord_break: EventUncertainty


def propagate_hose(
    design: HoseDesign, strain: ArrayLike, standard_uncertainty: Mapping[str, float]
) -> HoseUncertainty:
    r"""Propagate the uncertainty of design parameters to the prediction.

    Parameters
    ----------
    design : HoseDesign
        One hose, or many with the same uncertainties.
    strain : array_like, shape (n_strain,)
        Of the whole relaxed length, as for `reduction.prediction.hose_tension.predict_hose`.
        [1]
    standard_uncertainty : mapping of str to float
        By name of `reduction.prediction.hose_product.HOSE_PARAMETERS`, each in the SI unit of that
        parameter: rad for the wrap angle. Others count as known. [rad, m, m-1, Pa or 1]

    Returns
    -------
    uncertainty : HoseUncertainty
        Contribution of every source along the curve and at the events, and their sums.

    Raises
    ------
    SettingsError
        If a name is unknown, or an uncertainty is negative or not finite.
    DataError
        If a strain is not finite.

    Notes
    -----
    First order, [1]_ (module) 5.1.2, with the derivatives of
    `reduction.prediction.hose_sensitivity.hose_sensitivity`; the sources are assumed independent.
    They are not where one cause affects two of them: a layer that turns out large with its ribbon
    as cut is also steeper (by the cotangent of the angle times the relative error: eq. 10), and
    every diameter depends on that of the mandrel.  ``layer_diameter`` means both layers together.

    Linear propagation fails at the kinks of the curve.  Within a standard uncertainty of the
    strain at pick-up, the cords of some hoses are slack and those of others are not: below pick-up
    the linear result has none of their load; above it, the result is symmetric although the true
    tension cannot fall below that of the rubber.  Compared with sampling, for half a degree of
    angle at 68 degrees, it is a quarter too low at pick-up, a seventh too high half a standard
    uncertainty above, and within a twentieth from two on (`with_pick_up` adds the part missing
    below).  Near the break some hoses are broken.

    The curve above pick-up is steep.  At *constant strain* the same half degree is 13 % of the
    tension at the working load; for the working load itself, whose strain changes too, it is
    3 %.  The uncertainty quoted with a working load is that of the event.

    ``working`` is where the *cords* carry their share: the rubber, the diameters and the number of
    cords have no effect on its strain.

    Examples
    --------
    Half a degree of wrap angle is 6 points of stretch at the working load, 5 % of rubber
    modulus none.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> design = HoseDesign(np.radians(68.0), (0.0889, 0.0889), 0.0635, 0.127,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> known = {"wrap_angle": np.radians(0.5), "rubber_modulus": 0.05 * 1.379e6}
    >>> found = propagate_hose(design, [0.5, 1.0, 1.5], known)
    >>> print(found.source, (100 * found.working.strain_contribution).round(1))
    ('wrap_angle', 'rubber_modulus') [6.2 0. ]
    """
    source = tuple(name for name in HOSE_PARAMETERS if name in standard_uncertainty)
    _check(standard_uncertainty)
    rows = [HOSE_PARAMETERS.index(name) for name in source]
    spread = np.array([float(standard_uncertainty[name]) for name in source])
    slopes = hose_sensitivity(design, strain)

    def scaled(table: Floats) -> Floats:
        return np.asarray(table[rows] * spread.reshape(-1, *[1] * (table.ndim - 1)))

    def of_event(slope: EventSensitivity) -> EventUncertainty:
        parts = [scaled(one) for one in (slope.strain, slope.tension, slope.fill_pressure)]
        return EventUncertainty(*parts, *(_together(one) for one in parts))

    tension, pressure = scaled(slopes.tension), scaled(slopes.fill_pressure)
    return HoseUncertainty(
        source=source,
        strain=slopes.strain,
        tension_contribution=tension,
        fill_pressure_contribution=pressure,
        tension_standard_uncertainty=_together(tension),
        fill_pressure_standard_uncertainty=_together(pressure),
        deepest_slack=of_event(slopes.deepest_slack),
        pick_up=of_event(slopes.pick_up),
        working=of_event(slopes.working),
        cord_break=of_event(slopes.cord_break),
    )


def with_pick_up(design: HoseDesign, known: HoseUncertainty) -> HoseUncertainty:
    r"""Uncertainty of one hose, including the load of cords that are slack in its design.

    Notes
    -----
    Below pick-up the derivatives are those of the rubber alone, and give a fill pressure of exactly
    zero; within two standard uncertainties u of the strain at pick-up this is not certain.  A hose
    that picks up earlier by :math:`\delta`, normal with u, has the cord load Q there that this hose
    has later by :math:`\delta`,

    .. math:: \delta Q^2(\varepsilon) = \int Q^2(\varepsilon + \delta)\, dN(\delta)

    the mean square about the predicted zero.  Above pick-up the derivatives are up to a seventh
    too large, and are kept.

    Examples
    --------
    A hose for which half a degree is 6 points of the strain at pick-up, 1.025; for 1,500 hoses
    drawn with that scatter the root mean square is 63 kPa.

    >>> from reduction.prediction.cord_curve import CordCurve
    >>> cord = CordCurve(np.array([0.0, 0.095, 0.26]), np.array([0.0, 44.5, 133.5]))
    >>> design = HoseDesign(np.radians(68.0), (0.0889, 0.0889), 0.0635, 0.127,
    ...     34 / 0.0254, 0.022 * 0.0254, 1.379e6, cord)
    >>> known = propagate_hose(design, [0.7, 1.0], {"wrap_angle": np.radians(0.5)})
    >>> found = with_pick_up(design, known)
    >>> print(known.fill_pressure_standard_uncertainty, found.source)
    [0. 0.] ('wrap_angle', 'pick_up')
    >>> print((found.fill_pressure_standard_uncertainty / 1000).round(0))
    [ 0. 61.]
    """
    events = find_events(design)
    at, spread = float(events.pick_up.strain), float(known.pick_up.strain_standard_uncertainty)
    if not spread > 0:
        return known
    last = float(events.cord_break.strain)
    reached = known.strain + spread * ndtri(_QUANTILES)[:, None]
    later = predict_hose(design, np.clip(reached, at, last).ravel())
    is_slack = known.strain <= at
    parts = []
    for load in (later.cord_share * later.tension, later.fill_pressure):
        # at the break itself the curve has ended: use the last load before it
        whole = np.nan_to_num(load, nan=float(np.nanmax(load))).reshape(reached.shape)
        parts.append(np.where(is_slack, np.sqrt(np.mean(whole**2, axis=0)), 0.0))
    tension, pressure = (
        np.concatenate([one, part[None]])
        for one, part in zip(
            (known.tension_contribution, known.fill_pressure_contribution), parts, strict=True
        )
    )
    return replace(
        known,
        source=(*known.source, PICK_UP),
        tension_contribution=tension,
        fill_pressure_contribution=pressure,
        tension_standard_uncertainty=_together(tension),
        fill_pressure_standard_uncertainty=_together(pressure),
    )


def _together(contribution: Floats) -> Floats:
    return np.asarray(np.sqrt(np.sum(contribution**2, axis=0)))


def _check(standard_uncertainty: Mapping[str, float]) -> None:
    for name, value in standard_uncertainty.items():
        if name not in HOSE_PARAMETERS:
            raise SettingsError(
                f"standard_uncertainty.{name} is not a number of a hose",
                found=name,
                needed="one of " + ", ".join(HOSE_PARAMETERS),
            )
        if not (np.isfinite(value) and value >= 0):
            raise SettingsError(
                f"standard_uncertainty.{name} is not an uncertainty",
                found=f"{value:g} in SI",
                needed="zero or more",
            )

r"""Effect of shared errors on curves, segments, holds, loops, lines, weights and ratios.

**Effect of shared errors on a curve of tension against strain, and on its slope.** A point of the
branch moves by :math:`(\delta\varepsilon, \delta T)`; the tension at a given strain changes by

.. math:: \delta T|_\varepsilon = \delta T - T' \delta\varepsilon, \qquad
          \delta E = \frac{1}{A}\frac{d}{d\varepsilon}\left(\delta T|_\varepsilon\right)
                     - 2 E \frac{\delta d}{d}

**Effect of shared errors on numbers read at one point of the plane, or between two**:

.. math::

    \frac{\delta E_{sec}}{E_{sec}} &= \frac{\delta T}{T} - \frac{\delta\varepsilon}{\varepsilon}
        - 2\frac{\delta d}{d} \\
    \frac{\delta E_{chord}}{E_{chord}} &= \frac{\delta T_2 - \delta T_1}{T_2 - T_1}
        - \frac{\delta\varepsilon_2 - \delta\varepsilon_1}{\varepsilon_2 - \varepsilon_1}
        - 2\frac{\delta d}{d}

**Effect of shared errors on the parameters of a hyperelastic law fitted to a first loading**:

.. math:: \delta p = \left(J^T J - \sum_i r_i \frac{\partial^2 \sigma_i}{\partial p^2}\right)^{-1}
          J^T \left(\delta\sigma|_\varepsilon\right), \qquad
          J = \partial \sigma / \partial p

where r is the residual of the stress; it matters where a law is not linear in its
parameters.

A gain scales every modulus by the same factor, a diameter by twice its relative error; neither
affects an exponent.

**Effect of shared errors on the results of a hold: tensions, drop, rates, terms of a series**:

.. math::

    d = 1 - T_f / T_i: \qquad \delta d = (1 - d) \delta T_i / T_i - \delta T_f / T_i

A gain is in both tensions and cancels; a zero does not.  The loss of a relaxing tension is a
difference: it scales with the gain and does not depend on the zero.

**Effect of shared errors on a slow pull, and on the three parameters of a line**:

.. math:: S = d\varepsilon / dT = 1 / K_0, \qquad
          \delta S = S \frac{\partial\,\delta\varepsilon}{\partial\varepsilon}
              + \frac{\partial\,\delta\varepsilon}{\partial T}
              - S \frac{\partial\,\delta T}{\partial T} - S' \delta T

The load cell of the pull is that of the loops: its gain enters E' and K_0 alike, and changes their
difference only by the same factor.

**Effect of shared errors on the quantities of a loop.** Amplitudes and means follow from the two
ends of the loop, its area from the growth rate of a small area of the plane:

.. math::

    \delta K_{ap} / K_{ap} &= \delta T_a / T_a - \delta\varepsilon_a / \varepsilon_a \\
    \delta H / H &= \frac{\partial\,\delta T}{\partial T}
        + \frac{\partial\,\delta\varepsilon}{\partial\varepsilon}
        - \frac{\Delta t}{H} \oint \dot T \, d\varepsilon

(the theorem of Gauss for the field of errors, at the centre of the loop).

**Uncertainty of K_0 from the fit of a slow pull, with its correlation along the curve**:

.. math:: S(T) = (b_1 + 2 b_2 u + 3 b_3 u^2) / h, \qquad
          \delta K_0 = -K_0^2 \, \sum_j \frac{\partial S}{\partial b_j} \delta b_j

with u = (T - centre)/h.  The coefficients of a cubic are correlated: K_0 too high at one end of the
pull may be too low at the other, and runs at two mean tensions share that error.

**Contribution of the rated break strength to numbers that are divided by it**:

.. math:: y = q / S^p: \qquad \delta y = -p \, y \, \delta S / S

**Effect of shared errors on a stepwise test: weights, gauge length, strain, temperature,
diameter**:

.. math::

    \frac{\delta E_{sec}}{E_{sec}} &= \frac{\delta T}{T}
        + \frac{1 + \varepsilon}{\varepsilon} \frac{\delta g}{g} - g_\varepsilon + s
        - 2 \frac{\delta d}{d} \\
    \frac{\delta E_{int}}{E_{int}} &= g_T + \frac{\delta g}{g} - g_\varepsilon + s
        - 2 \frac{\delta d}{d}

**Effect of shared errors on the ratio of two moduli, and its interval**:

.. math:: \delta r = r \left(c_1 / E_1 - c_2 / E_2\right)

One load cell, or one crosshead, is in both moduli and cancels where its effect on both is equal.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3; 5.2; 5.2, F.1.2.3; 5.1.6 (relative uncertainty of products of powers); 5.2.2
   and G.4.1.
.. [2] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole, MA,
   Tech. Rep. WHOI-2005-10, Dec. 2005, eq. 2 and sec. 4; eqs. 1 and 2; Tables 5 and 6; Table 4; sec.
   4.6.
.. [3] R. W. Ogden, G. Saccomandi and I. Sgura, "Fitting hyperelastic models to experimental data,"
   Comput. Mech. 34, 2004.
.. [4] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1 and 4; sec. 4.4.2 and App. D.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import as_increasing, as_positive, as_same_shape
from reduction.record.contributions import (
    Component,
    Contributions,
    InstrumentErrors,
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)
from reduction.record.measurement import Floats
from reduction.record.settings import Control, Waveform
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.moduli.elastomer_laws import PARAMETERS, Law, even_grid, hyperelastic_stress
from reduction.stages.moduli.modulus_product import Ratio
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_model import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    OUTPUTS,
    amplitude_sensitivities,
    line_sensitivities,
)
from reduction.stages.three_parameter_line.line_product import SlowPull
from reduction.stages.three_parameter_line.slow_pull import (
    MISFIT_AT,
    quasi_static_spring_constant,
    rows_of_slope,
)
from reduction.uncertainty.error_field import (
    ErrorField,
    Inertia,
    error_field,
    splice_friction_error,
)


def strain_rate_of_wave(
    strain: ArrayLike,
    *,
    frequency: float,
    mean_strain: float,
    strain_amplitude: float,
    waveform: Waveform,
    speed_ratio: float = 1.0,
) -> tuple[Floats, Floats]:
    r"""Speed of strain along a rising branch, and its slope over strain.

    .. math:: \dot\varepsilon = 4 r f \varepsilon_a \quad\text{or}\quad
              \dot\varepsilon = 2 \pi f \sqrt{\varepsilon_a^2 - (\varepsilon - \varepsilon_m)^2}

    Examples
    --------
    >>> rate, _ = strain_rate_of_wave([1.0], frequency=0.1, mean_strain=1.0,
    ...     strain_amplitude=0.25, waveform="triangular")
    >>> print(rate)
    [0.1]
    """
    as_positive("frequency", frequency)
    as_positive("strain_amplitude", strain_amplitude)
    away = np.asarray(strain, dtype=np.float64) - mean_strain
    if waveform != "sinusoidal":
        return np.full(away.shape, 4 * speed_ratio * frequency * strain_amplitude), np.zeros(
            away.shape
        )
    turn = 2 * np.pi * frequency
    rate = turn * np.sqrt(np.maximum(strain_amplitude**2 - away**2, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(rate > 0, -(turn**2) * away / rate, 0.0)
    return rate, slope


def diameter_error(errors: InstrumentErrors) -> Component:
    """Name the error of a diameter, with its degrees of freedom.

    Notes
    -----
    Number of readings less one, for the mean; a stated value counts as known.

    Examples
    --------
    >>> print(diameter_error(InstrumentErrors("new", diameter=1e-4, diameter_readings=3)))
    Component(source='diameter', of='new', number=0, degrees_of_freedom=2.0)
    """
    freedom = float(errors.diameter_readings - 1) if errors.diameter_readings else np.inf
    return Component("diameter", errors.specimen, degrees_of_freedom=freedom)


def by_diameter(modulus: ArrayLike, errors: InstrumentErrors, *, area: float) -> Floats:
    r"""Contribution of the diameter to moduli.

    .. math:: \delta E = -2 E \, \delta d / d

    Notes
    -----
    Eq. 2 of [2]_: the area is that of the mean diameter.

    Examples
    --------
    >>> print(by_diameter(1e6, InstrumentErrors("new", diameter=1e-4), area=np.pi * 0.02**2 / 4))
    -10000.0
    """
    as_positive("area", area)
    return np.asarray(-2 * np.asarray(modulus) * errors.diameter / np.sqrt(4 * area / np.pi))


def curve_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    tangent_modulus: ArrayLike,
    modulus_slope: ArrayLike,
    area: float,
    strain_rate: ArrayLike = 0.0,
    strain_rate_slope: ArrayLike = 0.0,
    inertia_slope: ArrayLike = 0.0,
) -> Contributions:
    """Contributions to tangent modulus and tension at given strains of a curve.

    Notes
    -----
    First order ([1]_, 5.1.3).  Tension that is logged late is lower on a rising branch and
    higher on a falling one; where modulus and rate are constant, the modulus does not change (the
    slope of the splices' share is left out: a hundredth of that).  The delayed signal is the force
    on the load cell, which includes the inertia that was subtracted (its slope over strain, in N).

    Examples
    --------
    1 % of gain is 1 % of modulus; 1 % of diameter is 2 %.

    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, diameter=2.5e-4)
    >>> found = curve_contributions(error_field(errors, model, strain=0.5, tension=900.0), errors,
    ...     tangent_modulus=1e6, modulus_slope=0.0, area=np.pi * 0.025**2 / 4)
    >>> print([one.source for one in found.component], found.values["tangent_modulus"].round(3))
    ['tension_gain', 'diameter'] [ 10000. -20000.]
    """
    as_positive("area", area)
    modulus, bend = as_same_shape(tangent_modulus=tangent_modulus, modulus_slope=modulus_slope)
    rise, curvature = area * modulus, area * bend
    at_strain = field.tension - rise * field.strain
    slope = (
        field.tension_slope * rise
        + field.tension_slope_over_strain
        - rise * (field.strain_slope + field.strain_slope_over_tension * rise)
        - curvature * field.strain
    )
    component = list(field.component)
    tension, moduli = [*at_strain], [*(slope / area)]
    if errors.lag:
        rate, faster = np.asarray(strain_rate), np.asarray(strain_rate_slope)
        component.append(Component("lag", errors.tension_instrument))
        # the extension of splices computed from the late tension is late too
        late = errors.lag * (1 - field.strain_by_tension * rise)
        felt = rise + np.asarray(inertia_slope)
        tension.append(-late * felt * rate)
        moduli.append(-late * (bend * rate + felt / area * faster))
    if errors.diameter:
        component.append(diameter_error(errors))
        tension.append(np.zeros(modulus.shape))
        moduli.append(by_diameter(modulus, errors, area=area))
    return Contributions(
        tuple(component),
        {
            "tangent_modulus": _stacked(moduli, modulus),
            "branch_tension": _stacked(tension, modulus),
        },
    )


def _stacked(rows: Sequence[Floats], like: Floats) -> Floats:
    if not rows:
        return np.empty((0, *like.shape))
    return np.stack([np.broadcast_to(one, like.shape) for one in rows])


def with_diameter(
    found: Contributions, errors: InstrumentErrors, values: dict[str, Floats], *, area: float
) -> Contributions:
    r"""Contributions, with that of the diameter added to quantities divided by the area.

    .. math:: \delta y = -2 y \, \delta d / d

    Parameters
    ----------
    found : Contributions
        Of tension and strain, already divided by the area. [as quantity]
    errors : InstrumentErrors
        For the diameter.
    values : dict of str to ndarray
        Moduli and stresses themselves, by name; others do not depend on the diameter. [Pa]
    area : float
        Nominal area. [m2]

    Returns
    -------
    contributions : Contributions
        Unchanged where no error of the diameter is stated. [as quantity]

    Raises
    ------
    DataError
        If the area is not positive.

    Notes
    -----
    Eq. 2 of [2]_.

    Examples
    --------
    >>> none = Contributions((), {"modulus": np.empty((0, 1))})
    >>> errors = InstrumentErrors("new", diameter=2.5e-4)
    >>> print(with_diameter(none, errors, {"modulus": np.array([1e6])},
    ...     area=np.pi * 0.025**2 / 4).values["modulus"].round(3))
    [[-20000.]]
    """
    if not errors.diameter:
        return found
    rows = {}
    for name, array in found.values.items():
        own = (
            by_diameter(values[name], errors, area=area)
            if name in values
            else np.zeros(array.shape[1:])
        )
        rows[name] = np.concatenate([array, own[None]])
    return Contributions((*found.component, diameter_error(errors)), rows)


def section_contributions(errors: InstrumentErrors, *, area: float) -> Contributions:
    r"""Contributions to the diameter and the area of a specimen.

    .. math:: \delta A = 2 A \, \delta d / d

    Notes
    -----
    Eq. 2 of [2]_.

    Examples
    --------
    >>> found = section_contributions(InstrumentErrors("new", diameter=1e-4), area=5e-4)
    >>> print(found.values["area"].round(9))
    [3.963e-06]
    """
    if not errors.diameter:
        return Contributions((), {"diameter": np.empty(0), "area": np.empty(0)})
    component = (diameter_error(errors),)
    rows = {
        "diameter": np.array([errors.diameter]),
        "area": -by_diameter(area, errors, area=area).reshape(1),
    }
    return Contributions(component, rows)


def stress_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    stress: ArrayLike,
    tension_slope: ArrayLike,
    area: float,
    strain_rate: ArrayLike = 0.0,
) -> Contributions:
    r"""Contributions to the stress at stated strains.

    .. math:: \delta\sigma = (\delta T - T' \delta\varepsilon - T' \dot\varepsilon \Delta t) / A
              - 2 \sigma \, \delta d / d

    Notes
    -----
    First order ([1]_, 5.1.3).

    Examples
    --------
    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", position_offset=0.01)
    >>> field = error_field(errors, model, strain=1.0, tension=500.0)
    >>> print(stress_contributions(field, errors, stress=1e6, tension_slope=400.0, area=5e-4)
    ...     .values["stress"])
    [-8000.]
    """
    value, slope = as_same_shape(stress=stress, tension_slope=tension_slope)
    rows = (field.tension - slope * field.strain) / area
    component = field.component
    if errors.lag:
        late = errors.lag * (1 - field.strain_by_tension * slope)
        own = np.broadcast_to(-late * slope * np.asarray(strain_rate) / area, value.shape)
        component = (*component, Component("lag", errors.tension_instrument))
        rows = np.concatenate([rows, own[None]])
    found = Contributions(component, {"stress": rows})
    return with_diameter(found, errors, {"stress": value}, area=area)


def secant_contributions(
    field: ErrorField,
    errors: InstrumentErrors,
    *,
    strain: ArrayLike,
    secant_modulus: ArrayLike,
    area: float,
) -> Contributions:
    """Contributions to stress over strain at points.

    Notes
    -----
    Eq. 1 of [2]_; first order ([1]_, 5.1.3).

    Examples
    --------
    1 % of gain is 1 % of the secant; 10 mm on 1 m of gauge length are 1 % at 100 %.

    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, position_offset=0.01)
    >>> field = error_field(errors, model, strain=1.0, tension=500.0)
    >>> print(secant_contributions(field, errors, strain=1.0, secant_modulus=1e6, area=5e-4)
    ...     .values["secant_modulus"])
    [ 10000. -10000.]
    """
    at, modulus = as_same_shape(strain=strain, secant_modulus=secant_modulus)
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = (field.tension / area - modulus * field.strain) / at
    found = Contributions(field.component, {"secant_modulus": rows})
    return with_diameter(found, errors, {"secant_modulus": modulus}, area=area)


def chord_contributions(
    begin: ErrorField, end: ErrorField, *, stroke: ArrayLike, chord: ArrayLike
) -> Contributions:
    """Contributions to a difference of tension over the corresponding difference of strain.

    Notes
    -----
    First order ([1]_, 5.1.3).  A zero of the load cell cancels in a difference of tension.

    Examples
    --------
    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, tension_offset=5.0)
    >>> low, high = (error_field(errors, model, strain=e, tension=800 * e) for e in (0.5, 1.0))
    >>> print(chord_contributions(low, high, stroke=0.5, chord=800.0).values["chord"])
    [8. 0.]
    """
    reach, slope = as_same_shape(stroke=stroke, chord=chord)
    with np.errstate(divide="ignore", invalid="ignore"):
        rows = (end.tension - begin.tension - slope * (end.strain - begin.strain)) / reach
    return Contributions(begin.component, {"chord": rows})


def segment_contributions(
    of_curve: Contributions,
    errors: InstrumentErrors,
    *,
    strain: ArrayLike,
    knot: ArrayLike,
    segment_modulus: ArrayLike,
    area: float,
) -> Contributions:
    """Contributions to the segments of one branch, for the breakpoints that were found.

    Notes
    -----
    The segments of [2]_, Tables 5 and 6 are chords of the curve: the errors of their ends are those
    of the curve there.  The diameter enters a modulus through the area.

    Examples
    --------
    1 N more at the upper end of one segment of 0.5, on 1 cm2: 20 kPa.

    >>> from reduction.record.contributions import Component
    >>> curve = Contributions((Component("strain_calibration", "new"),),
    ...     {"branch_tension": np.array([[0.0, 0.25, 0.5, 0.75, 1.0]])})
    >>> found = segment_contributions(curve, InstrumentErrors("new"),
    ...     strain=[1.0, 1.125, 1.25, 1.375, 1.5], knot=[1.0, 1.5],
    ...     segment_modulus=[1e6], area=1e-4)
    >>> print(found.values["segment_modulus"].round(6))
    [[20000.]]
    """
    as_positive("area", area)
    at, ends = as_increasing("strain", strain), as_increasing("knot", knot)
    ordinate = np.stack([np.interp(ends, at, row) for row in of_curve.values["branch_tension"]])
    low, high = ordinate[:, :-1], ordinate[:, 1:]
    moduli = (high - low) / (area * np.diff(ends))
    for row, one in enumerate(of_curve.component):
        if one.source == "diameter":
            moduli[row] = by_diameter(segment_modulus, errors, area=area)
    return Contributions(
        of_curve.component,
        {
            "segment_tension_low": low,
            "segment_tension_high": high,
            "segment_modulus": moduli,
        },
    )


_STEP, _WIDE_STEP = 1e-6, 1e-4  # of a parameter: for first and for second differences


def elastomer_contributions(
    contribution: ArrayLike,
    *,
    strain: ArrayLike,
    stress: ArrayLike,
    law: Law,
    parameters: dict[str, float],
) -> Floats:
    """Contributions to the parameters of one law.

    Notes
    -----
    First order ([1]_, 5.1.3), through the least squares of the fit: on means over even
    intervals of strain, with equal weight.  Two Ogden terms may fit equally well with very
    different parameters ([3]_): the change is that of the set that was found; a first-order
    analysis cannot show a jump to another.

    Examples
    --------
    1 % more stress is 1 % more of both moduli:

    >>> x = np.linspace(0.05, 2.0, 100)
    >>> known = {"c10": 2e5, "c01": 5e4}
    >>> y = hyperelastic_stress(x, law="mooney-rivlin", parameters=known)
    >>> print(elastomer_contributions([0.01 * y], strain=x, stress=y, law="mooney-rivlin",
    ...     parameters=known).round(3))
    [[2000.  500.]]
    """
    rows, at = np.asarray(contribution, dtype=np.float64), np.asarray(strain, dtype=np.float64)
    level = np.asarray(stress, dtype=np.float64)
    known = np.isfinite(rows).all(axis=0) & np.isfinite(level)
    names = PARAMETERS[law]
    if not len(rows):
        return np.empty((0, len(names)))
    grid, fitted = even_grid(at[known], level[known])
    moved = np.stack([even_grid(at[known], row[known])[1] for row in rows])
    centre = np.array([parameters[name] for name in names])
    size = np.maximum(np.abs(centre), _STEP)

    def model(place: Floats) -> Floats:
        given = dict(zip(names, place.tolist(), strict=True))
        return hyperelastic_stress(grid, law=law, parameters=given)

    # divided by its size, every parameter is dimensionless and of order one
    near, far = np.diag(_STEP * size), np.diag(_WIDE_STEP * size)
    jacobian = np.stack(
        [(model(centre + one) - model(centre - one)) / (2 * _STEP) for one in near], axis=1
    )
    left = fitted - model(centre)
    bend = np.array(
        [
            [
                left
                @ (
                    model(centre + one + other)
                    - model(centre + one - other)
                    - model(centre - one + other)
                    + model(centre - one - other)
                )
                / (2 * _WIDE_STEP) ** 2
                for other in far
            ]
            for one in far
        ]
    )
    # by the triangular factor of the Jacobian: the normal matrix would lose half of the digits
    turn, triangle = np.linalg.qr(jacobian)
    inverse = np.linalg.pinv(triangle)
    inner = np.eye(len(names)) - inverse.T @ bend @ inverse
    return np.asarray((inverse @ np.linalg.solve(inner, (moved @ turn).T)).T * size)


def hold_contributions(
    field_at: Callable[[Floats, Floats], ErrorField], hold: HoldResult
) -> Contributions:
    """Contributions to the numbers of one hold.

    Notes
    -----
    First order ([1]_, 5.1.3).  Relaxation is at constant length of the machine; the small stretch
    that splices take up is in the tension itself.  Creep is at constant tension, where strain errs
    by its own slope.  Times of a series are not affected by these errors.

    Examples
    --------
    A zero 4 N high, on a drop from 400 to 320 N: the loss reads 0.2 % of 400 N too low.

    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> from reduction.record.contributions import InstrumentErrors
    >>> model = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> errors = InstrumentErrors("rope", tension_gain=0.01, tension_offset=4.0)
    >>> none = np.empty(0)
    >>> hold = HoldResult("rope", "relaxation", 0.0, 600.0, 1.0, 400.0, 320.0, 0.2, 0.0, 0.08, 0.0,
    ...     none, none, none, none, none, none, none, np.nan, np.nan)
    >>> def field_at(strain, tension):
    ...     return error_field(errors, model, strain=strain, tension=tension)
    >>> found = hold_contributions(field_at, hold)
    >>> print(found.values["relaxation_drop"].round(6), found.values["hold_final_tension"])
    [ 0.    -0.002] [3.2 4. ]
    """
    initial, final = hold.hold_initial_tension, hold.hold_final_tension
    # the middle of the hold, both its ends, its long time, and the stated times
    middle = (initial + final) / 2 if np.isfinite(initial) else final
    levels = [middle, initial, final, hold.long_time_tension]
    n_levels = len(levels)
    field = field_at(
        np.concatenate([np.full(n_levels, hold.hold_strain), hold.strain_at_time]),
        np.concatenate([levels, hold.tension_at_time]),
    )
    first, last, long_time = field.tension[:, 1:n_levels].T
    tension_slope, strain_slope = field.tension_slope[:, 0], field.strain_slope[:, 0]
    rate = hold.rate_per_decade
    relaxation = tension_slope * rate - rate * first / initial
    creep = strain_slope * rate
    is_creep = hold.kind == "creep"
    nothing = np.full(first.shape, np.nan)
    terms = tension_slope[:, None] * hold.prony_tension
    values = {
        "hold_strain": field.strain[:, 0],
        "hold_initial_tension": first,
        "hold_final_tension": last,
        "relaxation_drop": (1 - hold.relaxation_drop) * first / initial - last / initial,
        "relaxation_rate_per_decade": nothing if is_creep else relaxation,
        "creep_rate_per_decade": creep if is_creep else nothing,
        "tension_at_time": field.tension[:, n_levels:],
        "strain_at_time": field.strain[:, n_levels:],
        "prony_tension": terms,
        "long_time_tension": long_time,
    }
    return Contributions(field.component, values)


_K_0 = "quasi_static_spring_constant"


def pull_contributions(
    field: ErrorField, *, quasi_static_spring_constant: ArrayLike, compliance_slope: ArrayLike
) -> Contributions:
    """Contributions to the quasi-static spring constant at given tensions of a slow pull.

    Notes
    -----
    First order ([1]_, 5.2).  A lag is negligible at the rate of a slow pull.

    Examples
    --------
    1 % of load cell gain is 1 % of a constant K_0:

    >>> from reduction.stages.strain.strain_model import StrainModel
    >>> from reduction.uncertainty.error_field import error_field
    >>> from reduction.record.contributions import InstrumentErrors
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
        To the quantities of the loops, from `reduction.uncertainty.propagation.loop_contributions`.
    of_pull : Contributions
        To the quasi-static spring constant, with the same shape.
    values : mapping of str to ndarray, shape (...)
        The values themselves, by name: inputs and results. [SI]
    reading : {"amplitude", "fundamental"}
        Quantities of the loop from which the line was found.

    Returns
    -------
    contributions : Contributions
        By name of `reduction.stages.three_parameter_line.line_model.OUTPUTS`; NaN where the line
        has no such number.

    Notes
    -----
    By the logarithmic derivatives of eqs. 1 and 4 of [4]_
    (`reduction.stages.three_parameter_line.line_model`).

    Examples
    --------
    A gain that enters the loop and K_0 alike enters K_1 alike, and tau not at all:

    >>> from reduction.record.contributions import Component
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


_LAG_SHAPE = {"sinusoidal": 2 * np.pi**2, "triangular": 16.0, "other": 16.0}
"""Integral of tension rate over strain, over f T_a eps_a, for a sine and for straight ramps."""


class LoopQuantities(NamedTuple):
    """Quantities of loops of one specimen, or of their means, that carry shared errors. [SI]."""

    frequency: Floats
    mean_tension: Floats
    tension_amplitude: Floats
    mean_strain: Floats
    strain_amplitude: Floats
    apparent_spring_constant: Floats
    hysteresis_energy: Floats
    storage_spring_constant: Floats
    loss_spring_constant: Floats
    closed_loop_energy: Floats


def loop_contributions(
    errors: InstrumentErrors,
    model: StrainModel,
    loop: LoopQuantities,
    *,
    waveform: Waveform,
    control: Control = "position",
    speed_ratio: Floats | float = 1.0,
    has_corners: bool = True,
    inertia: Inertia | None = None,
) -> Contributions:
    """Contributions to the quantities of loops of one specimen.

    Notes
    -----
    First order ([1]_, 5.1.3).  The ends of the loop are where strain and tension have their
    extremes, taken to be the same place.  A specimen that is stiffer than at the stated temperature
    pulls harder where the machine controls the position, and stretches less where it controls the
    load, by the same relative amount in mean and amplitude.  Tension that is logged late turns the
    complex modulus back by 2 pi f lag and narrows the loop; it has no first-order effect on
    extremes, unless the wave ``has_corners`` at which its other channel is read.  The late signal
    is the force on the load cell, including the inertia that was subtracted.  Inertia is in phase
    with position and does no work over a cycle, so an error of its mass does not change the energy.
    A drift does less or more work than an even one if it takes place at one of the turns.
    Splices that are longer on the way down widen the loop by the difference of strain, over the
    range of tension, and a load cell that reads less on the way down by the difference of tension,
    over the range of strain.

    Examples
    --------
    A line of K_ap 100 kN with a loss of 5 kN; 2 ms of lag at 0.5 Hz change the loss by 12.6 %:

    >>> line = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> one = np.ones(1)
    >>> loop = LoopQuantities(frequency=0.5 * one, mean_tension=2e3 * one,
    ...     tension_amplitude=1e3 * one, mean_strain=0.02 * one, strain_amplitude=0.01 * one,
    ...     apparent_spring_constant=1e5 * one, hysteresis_energy=np.pi * 0.5 * one,
    ...     storage_spring_constant=99875.0 * one, loss_spring_constant=5e3 * one,
    ...     closed_loop_energy=np.pi * 0.5 * one)
    >>> found = loop_contributions(InstrumentErrors("rope", lag=0.002), line, loop,
    ...     waveform="sinusoidal")
    >>> print((found.values["loss_spring_constant"] / 5e3).round(3))
    [[-0.126]]
    """
    # temperature does not change the controlled channel, which the error field does not know
    still = replace(errors, stiffness=0.0)
    field = error_field(
        still,
        model,
        strain=np.stack([loop.mean_strain + way * loop.strain_amplitude for way in (1, -1, 0)]),
        tension=np.stack([loop.mean_tension + way * loop.tension_amplitude for way in (1, -1, 0)]),
        inertia=inertia,
    )
    # peak, valley and centre
    top, foot, _ = np.moveaxis(field.tension, 1, 0)
    top_strain, foot_strain, _ = np.moveaxis(field.strain, 1, 0)
    tension_half = (top - foot) / 2
    strain_half = (top_strain - foot_strain) / 2
    stretch = strain_half / loop.strain_amplitude
    stiffer = tension_half / loop.tension_amplitude - stretch
    wider = field.divergence[:, 2]
    # E'' is H / (pi strain_amplitude^2)
    lossier = wider - 2 * stretch
    values = {
        "mean_tension": (top + foot) / 2,
        "tension_amplitude": tension_half,
        "mean_strain": (top_strain + foot_strain) / 2,
        "strain_amplitude": strain_half,
        "peak_tension": top,
        "valley_tension": foot,
        "apparent_spring_constant": stiffer * loop.apparent_spring_constant,
        "hysteresis_energy": wider * loop.hysteresis_energy,
        "closed_loop_energy": wider * loop.closed_loop_energy,
        "storage_spring_constant": stiffer * loop.storage_spring_constant,
        "loss_spring_constant": lossier * loop.loss_spring_constant,
    }
    component = field.component
    if errors.stiffness:
        component, values = _with(
            component, values, Component("temperature", errors.test),
            _moved_by_temperature(errors, loop, control),
        )  # fmt: skip
    # splices that are taken to stretch by the logged tension follow an error of it
    felt = 1 - field.strain_by_tension[2] * loop.apparent_spring_constant
    if errors.tension_reversibility:
        component, values = _with(
            component, values, Component("tension_reversibility", errors.tension_instrument),
            _moved_by_reversibility(errors, loop, felt),
        )  # fmt: skip
    if errors.lag:
        moved = _moved_by_lag(
            errors, model, loop, felt, waveform=waveform, control=control,
            speed_ratio=speed_ratio, has_corners=has_corners, inertia=inertia,
        )  # fmt: skip
        lagging = Component("lag", errors.tension_instrument)
        component, values = _with(component, values, lagging, moved)
    if errors.splice_friction:
        component, values = _with(
            component, values, Component("splice_friction", errors.specimen),
            _moved_by_friction(errors, model, loop),
        )  # fmt: skip
    if errors.drift_not_placed:
        work = errors.drift_not_placed * (loop.closed_loop_energy - loop.hysteresis_energy)
        component, values = _with(
            component, values, Component("drift_place", errors.specimen),
            {
                "hysteresis_energy": work,
                "loss_spring_constant": work / (np.pi * loop.strain_amplitude**2),
            },
        )  # fmt: skip
    values["foot_strain"] = values["mean_strain"] - values["strain_amplitude"]
    loss_factor = loop.loss_spring_constant / loop.storage_spring_constant
    values["loss_factor"] = loss_factor * (
        values["loss_spring_constant"] / loop.loss_spring_constant
        - values["storage_spring_constant"] / loop.storage_spring_constant
    )
    return Contributions(component, values)


def _moved_by_temperature(
    errors: InstrumentErrors, loop: LoopQuantities, control: Control
) -> dict[str, Floats]:
    """Changes of the quantities of loops by the stiffness at another temperature than stated."""
    moved = {
        "apparent_spring_constant": loop.apparent_spring_constant,
        "storage_spring_constant": loop.storage_spring_constant,
        "loss_spring_constant": loop.loss_spring_constant,
    } | (
        {
            "mean_strain": -loop.mean_strain,
            "strain_amplitude": -loop.strain_amplitude,
            "hysteresis_energy": -loop.hysteresis_energy,
            "closed_loop_energy": -loop.closed_loop_energy,
        }
        if control == "load"
        else {
            "mean_tension": loop.mean_tension,
            "tension_amplitude": loop.tension_amplitude,
            "peak_tension": loop.mean_tension + loop.tension_amplitude,
            "valley_tension": loop.mean_tension - loop.tension_amplitude,
            "hysteresis_energy": loop.hysteresis_energy,
            "closed_loop_energy": loop.closed_loop_energy,
        }
    )
    return {name: errors.stiffness * value for name, value in moved.items()}


def _moved_by_lag(
    errors: InstrumentErrors,
    model: StrainModel,
    loop: LoopQuantities,
    late: Floats,
    *,
    waveform: Waveform,
    control: Control,
    speed_ratio: Floats | float,
    has_corners: bool,
    inertia: Inertia | None,
) -> dict[str, Floats]:
    """Changes of the quantities of loops whose tension is logged late, or smoothed in a filter.

    ``late``: share of a lag that is felt.
    """
    turn = 2 * np.pi * loop.frequency * errors.lag
    taken_off: Floats | float = 0.0
    if inertia is not None:
        ends = [
            inertia.acceleration(
                model,
                strain=np.asarray(loop.mean_strain + way * loop.strain_amplitude),
                tension=np.asarray(loop.mean_tension + way * loop.tension_amplitude),
            )[0]
            for way in (1, -1)
        ]
        taken_off = inertia.mass * (ends[0] - ends[1]) / 2
    felt = loop.tension_amplitude + taken_off
    felt_storage = loop.storage_spring_constant + taken_off / loop.strain_amplitude
    work = _LAG_SHAPE[waveform] * loop.frequency * felt * loop.strain_amplitude
    ramps = 1.0 if waveform == "sinusoidal" else speed_ratio
    of_lag = {
        "hysteresis_energy": -errors.lag * work * ramps * late,
        "closed_loop_energy": -errors.lag * work * ramps * late,
        "storage_spring_constant": turn * loop.loss_spring_constant * late,
        "loss_spring_constant": -turn * felt_storage * late,
    }
    if waveform != "sinusoidal":  # the loss is that of the area
        of_lag["loss_spring_constant"] = of_lag["hysteresis_energy"] / (
            np.pi * loop.strain_amplitude**2
        )
    # readings near a corner and the approach to it are late by the same time
    if waveform == "other" and has_corners:
        of_approach = 4 * loop.frequency * errors.lag * ramps
        of_lag |= {
            "apparent_spring_constant": -of_approach * loop.apparent_spring_constant,
            "tension_amplitude": -of_approach * felt,
            "peak_tension": -of_approach * felt,
            "valley_tension": of_approach * felt,
        }
    # strain is extrapolated half the way to the corner of a driven load: from a reading before
    # it, which is late as well, or from one after it, which cancels that
    if waveform == "triangular" and control == "load" and has_corners:
        of_approach = 2 * 2**0.5 * loop.frequency * errors.lag * ramps
        of_lag |= {
            "apparent_spring_constant": -of_approach * loop.apparent_spring_constant,
            "strain_amplitude": of_approach * loop.strain_amplitude,
        }
    if errors.smoothed_over:
        # uniform between zero, for a late clock, and all that such a filter takes off
        share = _smoothed_away(waveform, ramps * loop.frequency * errors.smoothed_over) / np.sqrt(3)
        lost = share * felt
        for name, way in (
            ("tension_amplitude", 1.0), ("peak_tension", 1.0), ("valley_tension", -1.0),
            ("apparent_spring_constant", 1 / loop.strain_amplitude),
            ("storage_spring_constant", 1 / loop.strain_amplitude),
        ):  # fmt: skip
            of_lag[name] = of_lag.get(name, 0.0) - way * lost
    return of_lag


def reversibility_error(
    errors: InstrumentErrors, tension: Floats, valley: Floats, peak: Floats
) -> tuple[Floats, Floats]:
    r"""Error of tension on the way down, by a load cell that reads less there, and its slope. [N].

    .. math:: \delta T = -2 v\, \frac{(T - T_v)(T_p - T)}{T_p - T_v}

    Notes
    -----
    v is the relative reversibility error (ISO 7500-1) of a calibration up to some load and back, at
    half that load.  The cell is taken to have a loop of this shape in every cycle, as wide in
    proportion to its range, and to be right while the load rises, where it was calibrated.

    Examples
    --------
    .1 % between 0 and 1 kN: half a newton at mid-range.

    >>> error, slope = reversibility_error(InstrumentErrors("rope", tension_reversibility=0.001),
    ...     np.array([0.0, 500.0, 1000.0]), np.array(0.0), np.array(1000.0))
    >>> print(error, slope)
    [-0.  -0.5 -0. ] [-0.002 -0.     0.002]
    """
    per_range = 2 * errors.tension_reversibility / (peak - valley)
    return (
        -per_range * (tension - valley) * (peak - tension),
        -per_range * (peak + valley - 2 * tension),
    )


def _moved_by_reversibility(
    errors: InstrumentErrors, loop: LoopQuantities, felt: Floats
) -> dict[str, Floats]:
    """Changes of the quantities of loops by a load cell that reads less while the load falls.

    Two thirds of the greatest difference over the range of strain; nothing at the ends, nor in the
    part of the fundamental that is in phase with strain.
    """
    wide = (
        4 / 3 * errors.tension_reversibility * loop.tension_amplitude * loop.strain_amplitude * felt
    )
    return {
        "hysteresis_energy": wide,
        "closed_loop_energy": wide,
        "loss_spring_constant": wide / (np.pi * loop.strain_amplitude**2),
    }


def _moved_by_friction(
    errors: InstrumentErrors, model: StrainModel, loop: LoopQuantities
) -> dict[str, Floats]:
    """Changes of the quantities of loops of a specimen whose splices are longer on the way down."""
    # a valley ends a way down; a peak has no error by friction
    below, middle = splice_friction_error(
        errors,
        model,
        strain=np.stack([loop.mean_strain - loop.strain_amplitude, loop.mean_strain]),
        tension=np.stack([loop.mean_tension - loop.tension_amplitude, loop.mean_tension]),
    )
    shorter = -below / 2
    wide = 2 * middle * loop.tension_amplitude
    stretch = shorter / loop.strain_amplitude
    return {
        "mean_strain": below / 2,
        "strain_amplitude": shorter,
        "apparent_spring_constant": -stretch * loop.apparent_spring_constant,
        "hysteresis_energy": wide,
        "closed_loop_energy": wide,
        "storage_spring_constant": -stretch * loop.storage_spring_constant,
        "loss_spring_constant": wide / (np.pi * loop.strain_amplitude**2)
        - 2 * stretch * loop.loss_spring_constant,
    }


def _smoothed_away(waveform: Waveform, constant: Floats) -> Floats:
    r"""Relative loss of amplitude of a wave in a filter, for a time constant given in periods.

    For a sine, :math:`1 - (1 + (2\pi f\tau)^2)^{-1/2}`.  After a corner between ramps of
    :math:`\pm v` the output lags by :math:`v\tau(2 e^{-t/\tau} - 1)` and turns
    where that is zero, at :math:`v \tau \ln 2` below the corner; v is four amplitudes a period.
    """
    if waveform == "sinusoidal":
        return np.asarray(1 - 1 / np.hypot(1, 2 * np.pi * constant))
    return np.asarray(4 * np.log(2) * constant)


def _with(
    component: tuple[Component, ...],
    values: dict[str, Floats],
    added: Component,
    moved: dict[str, Floats],
) -> tuple[tuple[Component, ...], dict[str, Floats]]:
    """Add the row of one more error; quantities that it does not name are unchanged."""
    return (*component, added), {
        name: np.concatenate([rows, moved.get(name, np.zeros(rows.shape[1:]))[None]])
        for name, rows in values.items()
    }


_NEGLIGIBLE = 1e-12  # of the greatest variance


def fit_contributions(pull: SlowPull, tension: ArrayLike, *, of: str) -> Contributions:
    """Contributions of the fit to the quasi-static spring constant at given tensions.

    Notes
    -----
    First order ([1]_, 5.2, F.1.2.3, of the slope of [4]_, sec. 4.4.2 and App. D).  The covariance
    is decomposed into independent errors.  The misfit of the slope is one error more,
    of one sign along the curve, since its size is known but not its course.

    Examples
    --------
    The squares add up to the uncertainty of the fit:

    >>> from reduction.stages.three_parameter_line.slow_pull import fit_pull
    >>> load = np.linspace(0, 2000.0, 400)
    >>> stretch = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    >>> noise = 1e-4 * np.random.default_rng(1).standard_normal(400)
    >>> pull = fit_pull(np.arange(400.0), stretch + noise, load)
    >>> found = fit_contributions(pull, [500.0, 1500.0], of="R, Q01")
    >>> _, spread = quasi_static_spring_constant(pull, [500.0, 1500.0])
    >>> rows = found.values["quasi_static_spring_constant"]
    >>> print(np.allclose(np.linalg.norm(rows, axis=0), spread))
    True
    """
    load = np.asarray(tension, dtype=np.float64)
    constant, _ = quasi_static_spring_constant(pull, load)
    scaled = (load - pull.tension_centre) / pull.tension_half_range
    variance, direction = np.linalg.eigh(pull.curve_covariance)
    kept = variance > _NEGLIGIBLE * variance.max()
    root = (direction * np.sqrt(np.maximum(variance, 0)))[:, kept]
    of_slope = [*np.moveaxis(rows_of_slope(pull, scaled) @ root, -1, 0)]
    if pull.slope_misfit.any():
        missed = np.interp(scaled, MISFIT_AT, pull.slope_misfit)
        of_slope.append(missed / pull.tension_half_range)
    rows = -(constant**2) * np.reshape(of_slope, (-1, *load.shape))
    component = tuple(Component("quasi_static_fit", of, number) for number in range(len(rows)))
    return Contributions(component, {"quasi_static_spring_constant": rows})


def over_strength(
    found: Contributions, errors: InstrumentErrors, powers: Mapping[str, tuple[Floats, float]]
) -> Contributions:
    """Contributions, with that of the rated break strength added.

    Notes
    -----
    First order ([1]_, 5.1.6).

    Examples
    --------
    >>> none = Contributions((), {"share": np.empty((0, 1)), "tension": np.empty((0, 1))})
    >>> errors = InstrumentErrors("rope", rated_break_strength=0.1)
    >>> found = over_strength(none, errors, {"share": (np.array([0.2]), -1.0)})
    >>> print(found.values["share"], found.values["tension"] + 0.0)
    [[-0.02]] [[0.]]
    """
    if not errors.rated_break_strength:
        return found
    rows = {}
    for name, array in found.values.items():
        value, power = powers.get(name, (np.zeros(array.shape[1:]), 0.0))
        own = power * errors.rated_break_strength * np.broadcast_to(value, array.shape[1:])
        rows[name] = np.concatenate([array, own[None]])
    component = Component("rated_break_strength", errors.specimen)
    return Contributions((*found.component, component), rows)


def stepwise_contributions(
    result: StepwiseResult, errors: InstrumentErrors, *, area: float
) -> Contributions:
    """Contributions to the strains and moduli of one stepwise test.

    Notes
    -----
    First order ([1]_, 5.1.3).  One gauge length is in every strain: for Table 4 of [2]_ it is the
    one given by the recorded elongations.

    Examples
    --------
    Weights that are 1 % heavier than stated:

    >>> from reduction.stages.moduli.stepwise_test import reduce_stepwise
    >>> from reduction.record.measurement import StepReadings
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
        # dead weights do not change with temperature: a stiffer rubber stretches less under them
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


def ratio_contributions(
    ratio: ArrayLike,
    *,
    numerator: ArrayLike,
    of_numerator: ArrayLike,
    denominator: ArrayLike,
    of_denominator: ArrayLike,
) -> Floats:
    """Contributions to a ratio.

    Parameters
    ----------
    ratio : array_like, shape (...)
        [1]
    numerator, denominator : array_like, shape (...)
        [any]
    of_numerator, of_denominator : array_like, shape (n_components, ...)
        Contributions to them, of the same components. [as numerator]

    Returns
    -------
    contribution : ndarray, shape (n_components, ...)
        [1]

    Notes
    -----
    First order ([1]_, 5.2.2 and G.4.1, 5.2.2).

    Examples
    --------
    The gain of a common cell leaves the ratio unchanged; two diameters do not cancel:

    >>> print(ratio_contributions(2.0, numerator=4.0, of_numerator=[0.04, 0.08, 0.0],
    ...     denominator=2.0, of_denominator=[0.02, 0.0, 0.04]))
    [ 0.    0.04 -0.04]
    """
    value = np.asarray(ratio, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        above = np.asarray(of_numerator, dtype=np.float64) / np.asarray(numerator)
        below = np.asarray(of_denominator, dtype=np.float64) / np.asarray(denominator)
    return np.asarray(value * (above - below))


def with_shared_interval(
    ratio: Ratio, contribution: ArrayLike, *, of_contribution: ArrayLike = np.inf
) -> Ratio:
    """Ratio with the interval of both parts; its standard uncertainty remains the random one.

    Notes
    -----
    Source: [2]_, sec. 4.6 compares new and used tethers; coverage factor by effective degrees of
    freedom ([1]_, 5.2.2 and G.4.1).

    Examples
    --------
    An excess of 10 %, by cycles known to 1 %, is not significant if diameters are known to 10 %:

    >>> one = np.ones((2, 1))
    >>> found = Ratio("used", "new", np.array([1.0]), 1.1 * one, 0.01 * one, 1.08 * one,
    ...     1.12 * one, one > 0)
    >>> wider = with_shared_interval(found, [0.1 * one])
    >>> print(wider.ratio_low[0].round(3), wider.is_different[0])
    [0.903] [False]
    """
    random = ratio.ratio_standard_uncertainty
    total = combined_standard_uncertainty(np.nan_to_num(contribution), random)
    freedom = effective_degrees_of_freedom(
        random, ratio.degrees_of_freedom, contribution=contribution, of_contribution=of_contribution
    )
    reach = total * coverage_factor(freedom)
    low, high = ratio.ratio - reach, ratio.ratio + reach
    return replace(
        ratio,
        ratio_low=low,
        ratio_high=high,
        is_different=(low > 1) | (high < 1),
    )

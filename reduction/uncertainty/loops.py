r"""What shared errors do to the quantities of a loop.

Amplitudes and means follow from the two ends of the loop, its area from how fast a small area of
the plane grows:

.. math::

    \delta K_{ap} / K_{ap} &= \delta T_a / T_a - \delta\varepsilon_a / \varepsilon_a \\
    \delta H / H &= \frac{\partial\,\delta T}{\partial T}
        + \frac{\partial\,\delta\varepsilon}{\partial\varepsilon}
        - \frac{\Delta t}{H} \oint \dot T \, d\varepsilon

(the theorem of Gauss for the field of errors, at the centre of the loop).

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," 5.1.3.
.. [2] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from reduction.record import Floats
from reduction.strain.model import StrainModel
from reduction.uncertainty.field import error_field
from reduction.uncertainty.product import Component, Contributions, InstrumentErrors

_LAG_SHAPE = {"sinusoidal": 2 * np.pi**2, "triangular": 16.0, "other": 16.0}
"""Integral of tension rate over strain, by f T_a eps_a: of a sine, and of straight ramps."""


def loop_contributions(
    errors: InstrumentErrors,
    model: StrainModel,
    *,
    frequency: Floats,
    mean_tension: Floats,
    tension_amplitude: Floats,
    mean_strain: Floats,
    strain_amplitude: Floats,
    apparent_spring_constant: Floats,
    hysteresis_energy: Floats,
    storage_spring_constant: Floats,
    loss_spring_constant: Floats,
    waveform: Literal["triangular", "sinusoidal", "other"],
    control: Literal["position", "load"] = "position",
    speed_ratio: Floats | float = 1.0,
) -> Contributions:
    """Contributions to the quantities of loops of one specimen.

    Parameters
    ----------
    errors : InstrumentErrors
        Standard uncertainties.
    model : StrainModel
        How position became strain.
    frequency : ndarray, shape (...)
        Of each loop. [Hz]
    mean_tension, tension_amplitude : ndarray, shape (...)
        [N]
    mean_strain, strain_amplitude : ndarray, shape (...)
        [1]
    apparent_spring_constant, storage_spring_constant, loss_spring_constant : ndarray, shape (...)
        [N]
    hysteresis_energy : ndarray, shape (...)
        [J m-1]
    waveform : {"triangular", "sinusoidal", "other"}
        How the control channel moves.
    control : {"position", "load"}
        Which channel the machine holds to its set values.
    speed_ratio : ndarray, shape (...), or float
        Speed of a ramp over that of one without a stop at its ends; a sine has none. [1]

    Returns
    -------
    contributions : Contributions
        To ``mean_tension``, ``tension_amplitude``, ``mean_strain``, ``strain_amplitude``,
        ``peak_tension``, ``valley_tension``, ``apparent_spring_constant``,
        ``hysteresis_energy``, ``storage_spring_constant``, ``loss_spring_constant`` and
        ``loss_factor``. [SI]

    Raises
    ------
    DataError
        If shapes differ.

    Notes
    -----
    First order ([1]_).  The ends of the loop are where strain and tension have their extremes,
    taken to be the same place.  A specimen that is stiffer than at the stated temperature pulls
    harder where the machine sets the position, and stretches less where it sets the load; by as
    much, relatively, at the mean as at the amplitude.  Tension that is logged late turns the
    complex modulus back by 2 pi f lag and narrows the loop; it has no first-order effect on
    extremes.

    Examples
    --------
    A line of K_ap 100 kN with a loss of 5 kN: 2 ms of lag at 0.5 Hz are 12.6 % of the loss.

    >>> line = StrainModel("rope", "gauge-length",
    ...     {"reference_position": 0.0, "gauge_length": 1.0})
    >>> one = np.ones(1)
    >>> found = loop_contributions(InstrumentErrors("rope", lag=0.002), line, frequency=0.5 * one,
    ...     mean_tension=2e3 * one, tension_amplitude=1e3 * one, mean_strain=0.02 * one,
    ...     strain_amplitude=0.01 * one, apparent_spring_constant=1e5 * one,
    ...     hysteresis_energy=np.pi * 0.5 * one, storage_spring_constant=99875.0 * one,
    ...     loss_spring_constant=5e3 * one, waveform="sinusoidal")
    >>> print((found.values["loss_spring_constant"] / 5e3).round(3))
    [[-0.126]]
    """
    # what the machine holds the temperature does not move, and the field knows no machine
    still = replace(errors, stiffness=0.0)
    field = error_field(
        still,
        model,
        strain=np.stack([mean_strain + way * strain_amplitude for way in (1, -1, 0)]),
        tension=np.stack([mean_tension + way * tension_amplitude for way in (1, -1, 0)]),
    )
    # peak, valley and centre
    top, foot, _ = np.moveaxis(field.tension, 1, 0)
    top_strain, foot_strain, _ = np.moveaxis(field.strain, 1, 0)
    tension_half = (top - foot) / 2
    strain_half = (top_strain - foot_strain) / 2
    stretch = strain_half / strain_amplitude
    stiffer = tension_half / tension_amplitude - stretch
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
        "apparent_spring_constant": stiffer * apparent_spring_constant,
        "hysteresis_energy": wider * hysteresis_energy,
        "storage_spring_constant": stiffer * storage_spring_constant,
        "loss_spring_constant": lossier * loss_spring_constant,
    }
    component = field.component
    if errors.stiffness:
        moved = {
            "apparent_spring_constant": apparent_spring_constant,
            "storage_spring_constant": storage_spring_constant,
            "loss_spring_constant": loss_spring_constant,
        } | (
            {
                "mean_strain": -mean_strain,
                "strain_amplitude": -strain_amplitude,
                "hysteresis_energy": -hysteresis_energy,
            }
            if control == "load"
            else {
                "mean_tension": mean_tension,
                "tension_amplitude": tension_amplitude,
                "peak_tension": mean_tension + tension_amplitude,
                "valley_tension": mean_tension - tension_amplitude,
                "hysteresis_energy": hysteresis_energy,
            }
        )
        component, values = _with(
            component, values, Component("temperature", errors.test),
            {name: errors.stiffness * value for name, value in moved.items()},
        )  # fmt: skip
    if errors.lag:
        turn = 2 * np.pi * frequency * errors.lag
        work = _LAG_SHAPE[waveform] * frequency * tension_amplitude * strain_amplitude
        ramps = 1.0 if waveform == "sinusoidal" else speed_ratio
        # splices that are taken to stretch by the late tension are late too
        late = 1 - field.strain_by_tension[2] * apparent_spring_constant
        of_lag = {
            "hysteresis_energy": -errors.lag * work * ramps * late,
            "storage_spring_constant": turn * loss_spring_constant * late,
            "loss_spring_constant": -turn * storage_spring_constant * late,
        }
        component, values = _with(
            component, values, Component("lag", errors.tension_instrument), of_lag
        )
    loss_factor = loss_spring_constant / storage_spring_constant
    values["loss_factor"] = loss_factor * (
        values["loss_spring_constant"] / loss_spring_constant
        - values["storage_spring_constant"] / storage_spring_constant
    )
    return Contributions(component, values)


def _with(
    component: tuple[Component, ...],
    values: dict[str, Floats],
    added: Component,
    moved: dict[str, Floats],
) -> tuple[tuple[Component, ...], dict[str, Floats]]:
    """Add the row of one more error; it leaves alone what it does not name."""
    return (*component, added), {
        name: np.concatenate([rows, moved.get(name, np.zeros(rows.shape[1:]))[None]])
        for name, rows in values.items()
    }

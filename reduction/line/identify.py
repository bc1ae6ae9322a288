r"""K_1 and tau of a line from its loop and its quasi-static spring constant, in closed form.

.. math::

    E'' = \frac{H K_{ap}^2}{\pi (\Delta T)^2}, \quad E' = \sqrt{K_{ap}^2 - E''^2}, \quad
    A = E' - K_0, \quad x = \frac{A}{E''}, \quad K_1 = A + \frac{E''^2}{A}, \quad
    \tau = \frac{x}{2 \pi f}

There is one root with K_1 and x positive where E'' < K_ap and E' > K_0, and none elsewhere.

As printed, and as computed.  [1]_ solves its eqs. 1 and 4 at once; eq. 4 is taken with pi
and the square on K_0 (`reduction.line.model`).  Eq. 4 alone has two roots, x and
[K_0/(K_0 + K_1)]^2/x; eq. 1 decides between them, and the printed values are the higher.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 and A-3 (the simultaneous
   solution), Tables 3-19.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.line.product import LineParameters
from reduction.line.sensitivity import (
    AMPLITUDE_INPUTS,
    FUNDAMENTAL_INPUTS,
    amplitude_sensitivities,
    line_sensitivities,
)
from reduction.line.solve import (
    NOT_POSITIVE,
    TOO_WIDE,
    fault_of_loop,
    line_of_loop,
    relative_uncertainties,
)
from reduction.record import Floats


def _broadcast(**named: ArrayLike) -> dict[str, Floats]:
    arrays = [np.asarray(values, dtype=np.float64) for values in named.values()]
    try:
        shaped = np.broadcast_arrays(*arrays)
    except ValueError as error:
        raise DataError(
            "inputs of the line do not fit together",
            found=", ".join(
                f"{name} {array.shape}" for name, array in zip(named, arrays, strict=True)
            ),
            needed="shapes that broadcast",
        ) from error
    return dict(zip(named, shaped, strict=True))


def identify_by_amplitude(
    *,
    apparent_spring_constant: ArrayLike,
    hysteresis_energy: ArrayLike,
    tension_amplitude: ArrayLike,
    frequency: ArrayLike,
    quasi_static_spring_constant: ArrayLike,
    standard_uncertainty: Mapping[str, ArrayLike] | None = None,
    correlation: ArrayLike = 0.0,
) -> LineParameters:
    r"""Parameters of the line from amplitudes and area of its loop.

    .. math:: x = A / E'', \qquad K_1 = A + E''^2 / A, \qquad A = E' - K_0

    Parameters
    ----------
    apparent_spring_constant : array_like, shape (...)
        :math:`K_{ap}`, tension amplitude over strain amplitude. [N]
    hysteresis_energy : array_like, shape (...)
        :math:`H`, closed-loop area. [J m-1]
    tension_amplitude : array_like, shape (...)
        :math:`\Delta T`, half the range. [N]
    frequency : array_like, shape (...)
        :math:`f`. [Hz]
    quasi_static_spring_constant : array_like, shape (...)
        :math:`K_0` at the mean tension of the run; NaN where there is no slow pull. [N]
    standard_uncertainty : mapping of str to array_like, optional
        By the names above; a name left out is not stated, and 0 is exact. [the input's]
    correlation : array_like, optional
        Correlation of the errors of K_ap and the tension amplitude, which share the
        tension's extremes. [1]

    Returns
    -------
    parameters : LineParameters
        Of the broadcast shape; NaN with a reason where refused. [N], [s], [N s]

    Raises
    ------
    DataError
        If shapes do not broadcast, or an uncertainty is given for no input.

    Notes
    -----
    Source: [1]_, eqs. 1 and 4 solved at once; as computed, see the module.  Holds for
    sinusoidal cycles, whose loop is an ellipse.  A triangular cycle has fundamentals of
    8/pi^2 of its amplitudes: E'' by H and amplitudes is then a third too low
    (`identify_by_fundamental` is free of that).  All uncertainties are of one loop; the
    part of K_0 is kept apart.

    Examples
    --------
    Polyester, 8-strand plaited, 1/2 in, centre point of Tables 3 and 11 of [1]_, in lb;
    Tables 14 and 17 print 4.353e4 lb and 4.007 s.

    >>> line = identify_by_amplitude(apparent_spring_constant=63170.0, hysteresis_energy=1.392,
    ...     tension_amplitude=561.0, frequency=0.3, quasi_static_spring_constant=20140.0)
    >>> print(line.dissipation_spring_constant.round(-1), line.relaxation_time.round(2))
    43520.0 4.04
    """
    inputs = _broadcast(
        apparent_spring_constant=apparent_spring_constant,
        hysteresis_energy=hysteresis_energy,
        tension_amplitude=tension_amplitude,
        frequency=frequency,
        quasi_static_spring_constant=quasi_static_spring_constant,
    )
    apparent, energy, amplitude, rate = (inputs[name] for name in AMPLITUDE_INPUTS[:4])
    bad = fault_of_loop([apparent, energy, amplitude, rate])
    sound = np.where(bad == 0, apparent, np.nan)
    with np.errstate(all="ignore"):
        lost = energy * sound**2 / (np.pi * amplitude**2)
        bad = np.where((bad == 0) & ~(lost < apparent), np.int8(TOO_WIDE), bad)
        # an area so small that its share of K_ap is no number any more
        bad = np.where((bad == 0) & ~(lost > 0), np.int8(NOT_POSITIVE), bad)
        lost = np.where(bad == 0, lost, np.nan)
        stored = np.sqrt((sound - lost) * (sound + lost))
    return line_of_loop(
        stored,
        lost,
        inputs,
        fault=bad,
        sensitivities=amplitude_sensitivities,
        relative=relative_uncertainties(inputs, standard_uncertainty),
        correlation=correlation,
        reading="amplitude",
    )


def identify_by_fundamental(
    *,
    storage_spring_constant: ArrayLike,
    loss_spring_constant: ArrayLike,
    frequency: ArrayLike,
    quasi_static_spring_constant: ArrayLike,
    standard_uncertainty: Mapping[str, ArrayLike] | None = None,
) -> LineParameters:
    r"""Parameters of the line from the fundamental of tension and strain.

    .. math:: x = \frac{E' - K_0}{E''}, \qquad K_1 = (E' - K_0)(1 + x^{-2})

    Parameters
    ----------
    storage_spring_constant, loss_spring_constant : array_like, shape (...)
        E' and E'' of the fundamental, or of a surface fitted to either. [N]
    frequency : array_like, shape (...)
        :math:`f`. [Hz]
    quasi_static_spring_constant : array_like, shape (...)
        :math:`K_0` at the mean tension of the run; NaN where there is no slow pull. [N]
    standard_uncertainty : mapping of str to array_like, optional
        By the names above; a name left out is not stated, and 0 is exact. [the input's]

    Returns
    -------
    parameters : LineParameters
        Of the broadcast shape; NaN with a reason where refused. [N], [s], [N s]

    Raises
    ------
    DataError
        If shapes do not broadcast, or an uncertainty is given for no input.

    Notes
    -----
    Eqs. 1 and 4 of [1]_ in E' and E''; exact for any waveform of a linear line.  E' and E''
    of a fit over a cycle have independent errors of one size.

    Examples
    --------
    >>> line = identify_by_fundamental(storage_spring_constant=2.7, loss_spring_constant=0.6,
    ...     frequency=0.3, quasi_static_spring_constant=1.2)
    >>> print(line.dissipation_spring_constant.round(3), line.relaxation_time.round(3))
    1.74 1.326
    """
    inputs = _broadcast(
        storage_spring_constant=storage_spring_constant,
        loss_spring_constant=loss_spring_constant,
        frequency=frequency,
        quasi_static_spring_constant=quasi_static_spring_constant,
    )
    bad = fault_of_loop([inputs[name] for name in FUNDAMENTAL_INPUTS[:3]])
    stored, lost = (np.where(bad == 0, inputs[name], np.nan) for name in FUNDAMENTAL_INPUTS[:2])
    return line_of_loop(
        stored,
        lost,
        inputs,
        fault=bad,
        sensitivities=line_sensitivities,
        relative=relative_uncertainties(inputs, standard_uncertainty),
        correlation=0.0,
        reading="fundamental",
    )

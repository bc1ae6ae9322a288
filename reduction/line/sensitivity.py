r"""Logarithmic sensitivities of the line's parameters to what was measured.

With :math:`A = E' - K_0` and :math:`x = A / E''`, small relative changes obey

.. math::

    d\ln A &= (E' \, d\ln E' - K_0 \, d\ln K_0) / A \\
    d\ln x &= d\ln A - d\ln E'' \\
    d\ln K_1 &= d\ln A - \frac{2}{1 + x^2} d\ln x \\
    d\ln \tau &= d\ln x - d\ln f, \qquad d\ln N = d\ln K_1 + d\ln\tau

and, where E' and E'' come from the amplitudes and the area of the loop,

.. math::

    d\ln E'' &= d\ln H + 2 \, d\ln K_{ap} - 2 \, d\ln \Delta T \\
    E'^2 d\ln E' &= K_{ap}^2 \, d\ln K_{ap} - E''^2 \, d\ln E''

so that d ln x / d ln H = -1 - E''^2/(E'A), d ln x / d ln K_ap = (K_ap^2 - 2 E''^2)/(E'A) - 2,
d ln x / d ln Delta T = 2 + 2 E''^2/(E'A) and d ln x / d ln K_0 = -K_0/A: tau carries all the
error of H, twice that of the amplitude, and K_0/A times that of K_0.

References
----------
.. [1] CG-D-39-80, eqs. 1 and 4 (the equations that are differentiated).
.. [2] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of
   uncertainty in measurement" (the law of propagation).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_same_shape
from reduction.record import Floats

OUTPUTS = (
    "storage_spring_constant", "loss_spring_constant", "dissipation_spring_constant",
    "relaxation_time", "dashpot_coefficient",
)  # fmt: skip
"""Rows of both matrices."""
FUNDAMENTAL_INPUTS = (
    "storage_spring_constant", "loss_spring_constant", "frequency",
    "quasi_static_spring_constant",
)  # fmt: skip
"""Columns of `line_sensitivities`."""
AMPLITUDE_INPUTS = (
    "apparent_spring_constant", "hysteresis_energy", "tension_amplitude", "frequency",
    "quasi_static_spring_constant",
)  # fmt: skip
"""Columns of `amplitude_sensitivities`."""


def line_sensitivities(
    storage_spring_constant: ArrayLike,
    loss_spring_constant: ArrayLike,
    quasi_static_spring_constant: ArrayLike,
) -> Floats:
    """Relative change of each parameter for a relative change of E', E'', f and K_0.

    Parameters
    ----------
    storage_spring_constant, loss_spring_constant : array_like, shape (...)
        E' and E''. [N]
    quasi_static_spring_constant : array_like, shape (...)
        K_0, below E'; NaN leaves NaN in the rows that need it. [N]

    Returns
    -------
    sensitivities : ndarray, shape (5, 4, ...)
        Row of `OUTPUTS`, column of `FUNDAMENTAL_INPUTS`. [1]

    Raises
    ------
    DataError
        If the shapes differ.

    Notes
    -----
    Derived from eqs. 1 and 4 of [1]_ (module).  Linear: where K_0/(E' - K_0) times the
    relative uncertainty of K_0 is above about 0.3 the distribution of K_1 is skewed and
    a standard uncertainty says little.

    Examples
    --------
    >>> table = line_sensitivities(3.0, 1.0, 2.0)
    >>> print(dict(zip(FUNDAMENTAL_INPUTS, table[OUTPUTS.index("relaxation_time")].tolist())))
    {'storage_spring_constant': 3.0, 'loss_spring_constant': -1.0, 'frequency': -1.0,
    'quasi_static_spring_constant': -2.0}
    """
    stored, lost, rest = as_same_shape(
        storage_spring_constant=storage_spring_constant,
        loss_spring_constant=loss_spring_constant,
        quasi_static_spring_constant=quasi_static_spring_constant,
    )
    table = np.zeros((len(OUTPUTS), len(FUNDAMENTAL_INPUTS), *stored.shape))
    table[0, 0] = table[1, 1] = 1
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = stored - rest
        # of A: storage, loss, frequency, K_0
        of_excess = np.zeros(table.shape[1:])
        of_excess[0], of_excess[3] = stored / excess, -rest / excess
        of_turn = of_excess.copy()
        of_turn[1] -= 1
        table[2] = of_excess - 2 / (1 + (excess / lost) ** 2) * of_turn
        table[3] = of_turn
        table[3, 2] -= 1
        table[4] = table[2] + table[3]
    return table


def amplitude_sensitivities(
    storage_spring_constant: ArrayLike,
    loss_spring_constant: ArrayLike,
    quasi_static_spring_constant: ArrayLike,
) -> Floats:
    """Relative change of each parameter for one of K_ap, H, amplitude, f and K_0.

    Parameters
    ----------
    storage_spring_constant, loss_spring_constant : array_like, shape (...)
        E' and E''. [N]
    quasi_static_spring_constant : array_like, shape (...)
        K_0, below E'; NaN leaves NaN in the rows that need it. [N]

    Returns
    -------
    sensitivities : ndarray, shape (5, 5, ...)
        Row of `OUTPUTS`, column of `AMPLITUDE_INPUTS`. [1]

    Raises
    ------
    DataError
        If the shapes differ.

    Notes
    -----
    Derived from eqs. 1 and 4 of [1]_ (module); linear, as `line_sensitivities`.

    Examples
    --------
    A narrow loop far from K_0: tau follows 1/H and the square of the amplitude.

    >>> table = amplitude_sensitivities(3.0, 0.01, 1.0)
    >>> print(table[OUTPUTS.index("relaxation_time")].round(3) + 0.0)
    [-0.5 -1. 2. -1. -0.5]
    """
    core = line_sensitivities(
        storage_spring_constant, loss_spring_constant, quasi_static_spring_constant
    )
    stored, lost = np.asarray(storage_spring_constant), np.asarray(loss_spring_constant)
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = (lost / stored) ** 2
        # of E' and E'': K_ap, H, amplitude
        of_lost = np.array([2.0, 1.0, -2.0]).reshape(3, *[1] * stored.ndim)
        of_stored = np.zeros((3, *stored.shape))
        of_stored[0] = 1 + wide
        of_stored -= wide * of_lost
        table = np.empty((len(OUTPUTS), len(AMPLITUDE_INPUTS), *stored.shape))
        table[:, :3] = core[:, 0, None] * of_stored + core[:, 1, None] * of_lost
    table[:, 3:] = core[:, 2:]
    return table

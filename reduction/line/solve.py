r"""Parameters of a line from the storage and loss spring constants of its loop and from K_0.

.. math::

    A = E' - K_0, \quad x = \frac{A}{E''}, \quad K_1 = A + \frac{E''^2}{A}, \quad
    \tau = \frac{x}{2 \pi f}

What both readings of a loop share (`reduction.line.identify`).

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard
   R&D Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, sec. 4.3 and A-3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduction.errors import DataError
from reduction.line.product import REASONS, LineParameters
from reduction.line.sensitivity import OUTPUTS
from reduction.record import Floats

_UNKNOWN_REST, _BAD_REST, _MISSING, NOT_POSITIVE, TOO_WIDE, _NOT_ABOVE = range(1, 7)


def reasons_in_words(reason: ArrayLike) -> tuple[str, ...]:
    """How many lines have no K_1 and tau, and why.

    Parameters
    ----------
    reason : array_like of int, shape (...)
        From `LineParameters`. [1]

    Returns
    -------
    words : tuple of str
        One entry a reason that occurs.

    Raises
    ------
    KeyError
        If a code is none of `REASONS`.

    Examples
    --------
    >>> reasons_in_words([0, 6, 6])
    ('K_1 and tau: 2 of 3 are refused: the storage spring constant does not exceed the
    quasi-static one',)
    """
    codes, counts = np.unique(np.asarray(reason), return_counts=True)
    total = int(counts.sum())
    return tuple(
        f"K_1 and tau: {count} of {total} are refused: {REASONS[int(code)]}"
        for code, count in zip(codes, counts, strict=True)
        if code
    )


def fault_of_loop(measured: list[Floats]) -> NDArray[np.int8]:
    """Code of a loop with a quantity missing or not positive.

    Parameters
    ----------
    measured : list of ndarray, shape (...) each
        What the loop was measured to be. [SI]

    Returns
    -------
    fault : ndarray of int8, shape (...)
        0, or a key of `reduction.line.product.REASONS`. [1]

    Raises
    ------
    ValueError
        If the arrays do not broadcast.

    Examples
    --------
    >>> fault_of_loop([np.array([1.0, np.nan, 2.0]), np.array([1.0, 1.0, -1.0])])
    array([0, 3, 4], dtype=int8)
    """
    missing = np.logical_or.reduce([np.isnan(one) for one in measured])
    with np.errstate(invalid="ignore"):
        sound = np.logical_and.reduce([(one > 0) & (one < np.inf) for one in measured])
    return np.select([missing, ~sound], [_MISSING, NOT_POSITIVE], default=0).astype(np.int8)


def relative_uncertainties(
    values: Mapping[str, Floats], standard_uncertainty: Mapping[str, ArrayLike] | None
) -> Floats:
    """Relative standard uncertainties of the inputs of a line.

    Parameters
    ----------
    values : mapping of str to ndarray, shape (...) each
        The inputs by name. [SI]
    standard_uncertainty : mapping of str to array_like, or None
        By the same names. [the input's]

    Returns
    -------
    relative : ndarray, shape (n_inputs, ...)
        NaN where not stated. [1]

    Raises
    ------
    DataError
        If an uncertainty is given for no input.

    Examples
    --------
    >>> relative_uncertainties({"frequency": np.array([0.5, 0.25])}, {"frequency": 0.01})
    array([[0.02, 0.04]])
    """
    stated = standard_uncertainty or {}
    unknown = sorted(set(stated) - set(values))
    if unknown:
        raise DataError(
            f"the line has no input '{unknown[0]}'", needed=f"one of {', '.join(values)}"
        )
    shape = next(iter(values.values())).shape
    relative = np.empty((len(values), *shape))
    with np.errstate(divide="ignore", invalid="ignore"):
        for row, (name, value) in enumerate(values.items()):
            relative[row] = np.asarray(stated.get(name, np.nan), dtype=np.float64) / value
    return np.abs(relative)


def line_of_loop(
    stored: Floats,
    lost: Floats,
    inputs: Mapping[str, Floats],
    *,
    fault: NDArray[np.int8],
    sensitivities: Callable[[ArrayLike, ArrayLike, ArrayLike], Floats],
    relative: Floats,
    correlation: ArrayLike,
    reading: str,
) -> LineParameters:
    """Give the parameters of a line, their uncertainties, and reasons where there are none.

    Parameters
    ----------
    stored, lost : ndarray, shape (...)
        E' and E'' of the loop; NaN where it has a fault. [N]
    inputs : mapping of str to ndarray, shape (...) each
        With ``quasi_static_spring_constant``, the last one, and ``frequency``. [N], [Hz]
    fault : ndarray of int8, shape (...)
        0, or why the loop gives nothing, a key of `reduction.line.product.REASONS`. [1]
    sensitivities : callable
        From E', E'' and K_0 to relative change of each output by each input.
    relative : ndarray, shape (n_inputs, ...)
        Relative standard uncertainties. [1]
    correlation : array_like, shape (...)
        Of the errors of the first and the third input. [1]
    reading : str
        How the loop was read.

    Returns
    -------
    parameters : LineParameters
        NaN with a reason where refused. [N], [s], [N s]

    Raises
    ------
    KeyError
        If an input is missing.

    Notes
    -----
    One root with K_1 and x positive where E' > K_0, and none elsewhere.

    Examples
    --------
    >>> from reduction.line.sensitivity import line_sensitivities
    >>> line = line_of_loop(
    ...     np.array(2.7), np.array(0.6),
    ...     {"frequency": np.array(0.3), "quasi_static_spring_constant": np.array(1.2)},
    ...     fault=np.array(0, np.int8), sensitivities=line_sensitivities,
    ...     relative=np.full(4, np.nan), correlation=0.0, reading="fundamental")
    >>> print(line.dissipation_spring_constant.round(3), line.relaxation_time.round(3))
    1.74 1.326
    """
    rest = inputs["quasi_static_spring_constant"]
    reason = np.select(
        [fault > 0, np.isnan(rest), ~((rest > 0) & (rest < np.inf)), ~(stored > rest)],
        [fault, _UNKNOWN_REST, _BAD_REST, _NOT_ABOVE],
        default=0,
    ).astype(np.int8)
    values = _solve(stored, lost, inputs, reason)
    table = sensitivities(stored, lost, np.where(reason == 0, rest, np.nan))
    # an input that a parameter does not feel need not have its uncertainty stated;
    # K_0 is the last input of either table
    random, shared, both = {}, {}, {}
    with np.errstate(invalid="ignore", over="ignore"):
        felt = np.where(table == 0, 0.0, table * relative)
        crossed = 2 * np.asarray(correlation) * felt[:, 0] * felt[:, 2]
        # differences of nearly equal terms may fall a rounding error below zero
        random_part = np.sqrt(np.maximum((felt[:, :-1] ** 2).sum(axis=1) + crossed, 0))
        for row, name in enumerate(OUTPUTS):
            size = np.abs(values[name])
            random[name] = np.asarray(size * random_part[row])
            shared[name] = np.asarray(size * np.abs(felt[row, -1]))
            both[name] = np.hypot(random[name], shared[name])
    return LineParameters(
        **{name: np.asarray(value) for name, value in values.items()},
        reason=reason,
        random_uncertainty=random,
        shared_uncertainty=shared,
        uncertainty=both,
        reading=reading,
        notes=reasons_in_words(reason),
    )


def _solve(
    stored: Floats, lost: Floats, inputs: Mapping[str, Floats], reason: NDArray[np.int8]
) -> dict[str, Floats]:
    """Fields of `LineParameters` but the uncertainties."""
    rest = inputs["quasi_static_spring_constant"]
    turn_rate = 2 * np.pi * inputs["frequency"]
    stands = reason == 0
    with np.errstate(over="ignore"):
        excess = np.where(stands, stored - rest, np.nan)
        turn = excess / np.where(stands, lost, np.nan)
        # A + E''^2/A, in the form that does not square small numbers
        spring = excess + lost / turn
        time = turn / turn_rate
        dashpot = spring * time
    return {
        "quasi_static_spring_constant": rest,
        "storage_spring_constant": stored,
        "loss_spring_constant": lost,
        "loss_angle": np.arctan2(lost, stored),
        "dissipation_spring_constant": spring,
        "relaxation_time": time,
        "dashpot_coefficient": dashpot,
        "angular_frequency": turn_rate,
        "angular_frequency_relaxation_time": turn,
        "conditioning": rest / excess,
    }

r"""The three-parameter line: forward model, parameters in closed form, sensitivities.

With :math:`x = \omega\tau = 2\pi f \tau` and :math:`\tau = N / K_1`,

.. math::

    E' = K_0 + K_1 \frac{x^2}{1 + x^2}, \qquad E'' = K_1 \frac{x}{1 + x^2}, \qquad
    K_{ap} = \sqrt{E'^2 + E''^2}, \qquad
    H = \frac{\pi K_1 (\Delta T)^2 x}{K_0^2 + (K_0 + K_1)^2 x^2}

As printed, and as computed.  Eq. 1 of [1]_ is the K_ap above.  Its eq. 4 prints
:math:`H = K_1 (\Delta T)^2 \omega\tau / [K_0 + (K_0 + K_1)^2 (\omega\tau)^2]`: the pi and
the square on K_0 are lost (K_0 beside a square of K_0 + K_1 is dimensionally wrong), the integrand
is the mean load T_m where the area of a loop needs the tension T, and omega is called a
frequency.  The numbers of [1]_ show which form was computed.  At the seven centre points the
constant in front of K_1 has the geometric mean 3.166 with a 95 % interval of 2.82 to 3.56,
which includes pi but not 1, 2, 4 or 2 pi; omega = 2 pi f gives K_ap within 0.966 to 1.013
of the print, omega = f gives 0.55 to 0.80.  K_0 in place of its square changes H by 5 % at most
there, so the unit decides.

**Logarithmic sensitivities of the line's parameters to the measured quantities.** With
:math:`A = E' - K_0` and :math:`x = A / E''`, small relative changes obey

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

**Parameters of a line from the storage and loss spring constants of its loop and from K_0**:

.. math::

    A = E' - K_0, \quad x = \frac{A}{E''}, \quad K_1 = A + \frac{E''^2}{A}, \quad
    \tau = \frac{x}{2 \pi f}

**K_1 and tau of a line from its loop and its quasi-static spring constant, in closed form**:

.. math::

    E'' = \frac{H K_{ap}^2}{\pi (\Delta T)^2}, \quad E' = \sqrt{K_{ap}^2 - E''^2}, \quad
    A = E' - K_0, \quad x = \frac{A}{E''}, \quad K_1 = A + \frac{E''^2}{A}, \quad
    \tau = \frac{x}{2 \pi f}

There is one root with positive K_1 and x where E'' < K_ap and E' > K_0, and none elsewhere.

As printed, and as computed.  [1]_ solves its eqs. 1 and 4 together; eq. 4 is taken with pi
and the square on K_0 (see the forward model).  Eq. 4 alone has two roots, x and
[K_0/(K_0 + K_1)]^2/x; eq. 1 decides between them, and the printed values are the higher ones.

**Test for a single relaxation time over frequency.** At equal loads a three-parameter line has
one tau at all frequencies; a material with a loss angle that does not change with frequency
gives a tau that falls as 1/f.  With one intercept per load,

.. math:: \ln \tau = a_g - n \ln f, \qquad n = 0: \text{one } \tau, \qquad n = 1: \tau \propto 1/f

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, eqs. 1-4, Tables 3-19; sec. 4.3 and A-3 (the
   simultaneous solution), Tables 3-19; Tables 11 and 17 and sec. 4.4.5 ("a major departure from the
   theory represented in equation (4)").
.. [2] CG-D-39-80, eqs. 1 and 4 (the equations that are differentiated).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from reduction.record.arrays import as_positive, as_same_shape
from reduction.record.contributions import CONFIDENCE
from reduction.record.errors import DataError
from reduction.record.measurement import Floats, Integers, read_only_arrays
from reduction.record.notes import Note, note
from reduction.stages.three_parameter_line.line_product import REASONS, LineParameters


def _at_least_zero(**named: ArrayLike) -> tuple[Floats, ...]:
    """The inputs as float64; NaN is allowed, a negative input is refused by its name."""
    arrays = {name: np.asarray(values, dtype=np.float64) for name, values in named.items()}
    for name, array in arrays.items():
        bad = array < 0
        if bad.any():
            raise DataError(
                f"{int(bad.sum())} of {bad.size} values of {name.replace('_', ' ')} are negative",
                found=f"{array[bad].flat[0]:g}",
                needed="zero or more",
            )
    return tuple(arrays.values())


def _storage_and_loss(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
) -> tuple[Floats, Floats]:
    r"""Storage and loss spring constant of the line.

    .. math:: E' = K_0 + K_1 \frac{x^2}{1 + x^2}, \qquad E'' = K_1 \frac{x}{1 + x^2}

    Notes
    -----
    Source: [1]_, eq. 1, which gives their modulus.  Small motions about a mean tension; the
    line does not go slack.  NaN in, NaN out.

    Examples
    --------
    Far above and far below the relaxation frequency the line is a spring (eqs. 2, 3).

    >>> stored, _ = _storage_and_loss(quasi_static_spring_constant=1.2,
    ...     dissipation_spring_constant=1.8, relaxation_time=1.0, frequency=[0.0, 1e6])
    >>> print(stored.round(6))
    [1.2 3. ]
    """
    rest, spring, time, rate = _at_least_zero(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    turn = 2 * np.pi * rate * time
    share = 1 / (1 + turn**2)
    return rest + spring * (turn**2 * share), spring * (turn * share)


def apparent_spring_constant(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
) -> Floats:
    r"""Tension amplitude over strain amplitude.

    .. math:: K_{ap} = \left[\frac{K_0^2 + (K_0 + K_1)^2 x^2}{1 + x^2}\right]^{1/2}

    Parameters
    ----------
    quasi_static_spring_constant, dissipation_spring_constant : array_like, shape (...)
        :math:`K_0` and :math:`K_1`. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    frequency : array_like, shape (...)
        :math:`f`; x is 2 pi f tau. [Hz]

    Returns
    -------
    apparent_spring_constant : ndarray, shape (...)
        Between :math:`K_0` and :math:`K_0 + K_1`. [N]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, eq. 1; the frequency there is omega = 2 pi f (module).

    Examples
    --------
    Polyester, 8-strand plaited, 1/2 in, centre point: 6.317 printed (1e4 lb).

    >>> print(apparent_spring_constant(quasi_static_spring_constant=2.014,
    ...     dissipation_spring_constant=4.353, relaxation_time=4.007, frequency=0.3).round(3))
    6.317
    """
    stored, lost = _storage_and_loss(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    modulus: Floats = np.hypot(stored, lost)
    return modulus


def hysteresis_energy(
    *,
    quasi_static_spring_constant: ArrayLike,
    dissipation_spring_constant: ArrayLike,
    relaxation_time: ArrayLike,
    frequency: ArrayLike,
    tension_amplitude: ArrayLike,
) -> Floats:
    r"""Energy lost per cycle and unit length, for a tension amplitude.

    .. math:: H = \oint T d\varepsilon
              = \pi \frac{(\Delta T)^2}{K_{ap}^2} E''
              = \frac{\pi K_1 (\Delta T)^2 x}{K_0^2 + (K_0 + K_1)^2 x^2}

    Parameters
    ----------
    quasi_static_spring_constant, dissipation_spring_constant : array_like, shape (...)
        :math:`K_0` and :math:`K_1`. [N]
    relaxation_time : array_like, shape (...)
        :math:`\tau`. [s]
    frequency : array_like, shape (...)
        :math:`f`; x is 2 pi f tau. [Hz]
    tension_amplitude : array_like, shape (...)
        :math:`\Delta T`, half the range. [N]

    Returns
    -------
    hysteresis_energy : ndarray, shape (...)
        Area of the loop of tension against strain. [J m-1]

    Raises
    ------
    DataError
        If an input is negative.

    Notes
    -----
    Source: [1]_, eq. 4, which as printed lacks pi and the square on K_0 (module).

    Examples
    --------
    Polyester, 8-strand plaited, 1/2 in, centre point, in lb: 1.392 printed.

    >>> print(hysteresis_energy(quasi_static_spring_constant=20140.0,
    ...     dissipation_spring_constant=43530.0, relaxation_time=4.007, frequency=0.3,
    ...     tension_amplitude=561.0).round(3))
    1.403
    """
    stored, lost = _storage_and_loss(
        quasi_static_spring_constant=quasi_static_spring_constant,
        dissipation_spring_constant=dissipation_spring_constant,
        relaxation_time=relaxation_time,
        frequency=frequency,
    )
    (amplitude,) = _at_least_zero(tension_amplitude=tension_amplitude)
    energy: Floats = np.pi * amplitude**2 * lost / (stored**2 + lost**2)
    return energy


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
    Derived from eqs. 1 and 4 of [2]_ (module).  Linear: where K_0/(E' - K_0) times the
    relative uncertainty of K_0 is above about 0.3, the distribution of K_1 is skewed and
    a standard uncertainty is of little use.

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
        # derivatives of A: storage, loss, frequency, K_0
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
    """Relative change of each parameter for a relative change of K_ap, H, amplitude, f and K_0.

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
    Derived from eqs. 1 and 4 of [2]_ (module); linear, as in `line_sensitivities`.

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
        # derivatives of E' and E'': K_ap, H, amplitude
        of_lost = np.array([2.0, 1.0, -2.0]).reshape(3, *[1] * stored.ndim)
        of_stored = np.zeros((3, *stored.shape))
        of_stored[0] = 1 + wide
        of_stored -= wide * of_lost
        table = np.empty((len(OUTPUTS), len(AMPLITUDE_INPUTS), *stored.shape))
        table[:, :3] = core[:, 0, None] * of_stored + core[:, 1, None] * of_lost
    table[:, 3:] = core[:, 2:]
    return table


_UNKNOWN_REST, _BAD_REST, _MISSING, NOT_POSITIVE, TOO_WIDE, _NOT_ABOVE = range(1, 7)


def refused_lines(reason: ArrayLike) -> tuple[Note, ...]:
    """Number of lines without K_1 and tau, and the reasons.

    Examples
    --------
    >>> print(refused_lines([0, 6, 6])[0])
    K_1 and tau not given in 2 of 3 cases: the storage spring constant does not exceed the
    quasi-static one
    """
    codes, counts = np.unique(np.asarray(reason), return_counts=True)
    total = int(counts.sum())
    return tuple(
        note("no-line", n_lines=int(count), n_all=total, reason=REASONS[int(code)])
        for code, count in zip(codes, counts, strict=True)
        if code
    )


def _fault_of_loop(measured: list[Floats]) -> NDArray[np.int8]:
    """Code of a loop with a quantity missing or not positive.

    Examples
    --------
    >>> _fault_of_loop([np.array([1.0, np.nan, 2.0]), np.array([1.0, 1.0, -1.0])])
    array([0, 3, 4], dtype=int8)
    """
    missing = np.logical_or.reduce([np.isnan(one) for one in measured])
    with np.errstate(invalid="ignore"):
        sound = np.logical_and.reduce([(one > 0) & (one < np.inf) for one in measured])
    return np.select([missing, ~sound], [_MISSING, NOT_POSITIVE], default=0).astype(np.int8)


def _relative_uncertainties(
    values: Mapping[str, Floats], standard_uncertainty: Mapping[str, ArrayLike] | None
) -> Floats:
    """Relative standard uncertainties of the inputs of a line.

    Examples
    --------
    >>> _relative_uncertainties({"frequency": np.array([0.5, 0.25])}, {"frequency": 0.01})
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


def _line_of_loop(
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
    """Compute the parameters of a line and their uncertainties, with reasons where refused.

    Notes
    -----
    There is one root with positive K_1 and x where E' > K_0, and none elsewhere.

    Examples
    --------
    >>> from reduction.stages.three_parameter_line.line_model import line_sensitivities
    >>> line = _line_of_loop(
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
    # E' and E'' do not depend on K_0; without stated uncertainties the rest is unknown, as for
    # draws
    felt = np.full((len(OUTPUTS), len(relative), *[1] * rest.ndim), np.nan)
    felt[:2, -1] = 0.0
    # an input that does not affect a parameter may have an unstated uncertainty;
    # K_0 is the last input of either table
    random, shared, both = {}, {}, {}
    with np.errstate(invalid="ignore", over="ignore"):
        if not np.isnan(relative).all():
            table = sensitivities(stored, lost, np.where(reason == 0, rest, np.nan))
            felt = np.where(table == 0, 0.0, table * relative)
        crossed = 2 * np.asarray(correlation) * felt[:, 0] * felt[:, 2]
        # differences of nearly equal terms may be negative by a rounding error
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
        notes=refused_lines(reason),
    )


def _solve(
    stored: Floats, lost: Floats, inputs: Mapping[str, Floats], reason: NDArray[np.int8]
) -> dict[str, Floats]:
    """Fields of `LineParameters` except the uncertainties."""
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
    r"""Parameters of the line from the amplitudes and the area of its loop.

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
        By the names above; a missing name means not stated, and 0 means exact. [the input's]
    correlation : array_like, optional
        Correlation of the errors of K_ap and the tension amplitude, which share the
        tension's extremes. [1]

    Returns
    -------
    parameters : LineParameters
        With the broadcast shape; NaN with a reason where refused. [N], [s], [N s]

    Raises
    ------
    DataError
        If shapes do not broadcast, or an uncertainty is given for an unknown input.

    Notes
    -----
    Source: [1]_, eqs. 1 and 4 solved together; for the computed form see the module.  Holds for
    sinusoidal cycles, whose loop is an ellipse.  The fundamentals of a triangular cycle are
    8/pi^2 of its amplitudes: E'' from H and amplitudes is then a third too low
    (`identify_by_fundamental` does not have this error).  All uncertainties are those of one loop;
    the part of K_0 is kept separate.

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
    bad = _fault_of_loop([apparent, energy, amplitude, rate])
    sound = np.where(bad == 0, apparent, np.nan)
    with np.errstate(all="ignore"):
        lost = energy * sound**2 / (np.pi * amplitude**2)
        bad = np.where((bad == 0) & ~(lost < apparent), np.int8(TOO_WIDE), bad)
        # an area so small that its ratio to K_ap underflows
        bad = np.where((bad == 0) & ~(lost > 0), np.int8(NOT_POSITIVE), bad)
        lost = np.where(bad == 0, lost, np.nan)
        stored = np.sqrt((sound - lost) * (sound + lost))
    return _line_of_loop(
        stored,
        lost,
        inputs,
        fault=bad,
        sensitivities=amplitude_sensitivities,
        relative=_relative_uncertainties(inputs, standard_uncertainty),
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
        By the names above; a missing name means not stated, and 0 means exact. [the input's]

    Returns
    -------
    parameters : LineParameters
        With the broadcast shape; NaN with a reason where refused. [N], [s], [N s]

    Raises
    ------
    DataError
        If shapes do not broadcast, or an uncertainty is given for an unknown input.

    Notes
    -----
    Eqs. 1 and 4 of [1]_ in E' and E''; exact for any waveform of a linear line.  E' and E''
    from a fit over a cycle have independent errors of equal size.

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
    bad = _fault_of_loop([inputs[name] for name in FUNDAMENTAL_INPUTS[:3]])
    stored, lost = (np.where(bad == 0, inputs[name], np.nan) for name in FUNDAMENTAL_INPUTS[:2])
    return _line_of_loop(
        stored,
        lost,
        inputs,
        fault=bad,
        sensitivities=line_sensitivities,
        relative=_relative_uncertainties(inputs, standard_uncertainty),
        correlation=0.0,
        reading="fundamental",
    )


VERDICTS: dict[int, str] = {
    0: "not decided: the interval of the exponent reaches both 0 and 1",
    1: "one relaxation time holds over frequency: the interval reaches 0 and not 1",
    2: "the relaxation time follows 1/f: the interval reaches 1 and not 0, so tau re-expresses "
    "a loss angle that hardly changes with frequency",
    3: "neither: the relaxation time changes with frequency, and not as 1/f",
    4: "not decided: too few frequencies at equal loads, or no scatter to judge them by",
}


@dataclass(frozen=True)
@read_only_arrays
class SingleTimeCheck:
    """Change of the relaxation time of lines with frequency; arrays have shape (...).

    Parameters
    ----------
    exponent, exponent_standard_uncertainty : ndarray
        n of tau ~ f^-n. [1]
    exponent_low, exponent_high : ndarray
        Interval of n. [1]
    p_one_time, p_inverse_frequency : ndarray
        Probability of an estimate at least as far from exactly 0 (one tau), and from 1 (1/f). [1]
    time_ratio, time_ratio_low, time_ratio_high : ndarray
        tau at the lowest over tau at the highest frequency, from the fit; 1 for one tau
        and ``frequency_ratio`` for tau proportional to 1/f. [1]
    frequency_ratio : ndarray
        Highest over lowest frequency. [1]
    degrees_of_freedom : ndarray of int
        Of the scatter about the fit; 0 where the stated uncertainties were used. [1]
    loss_exponent, loss_exponent_low, loss_exponent_high : ndarray
        m of tan(loss angle) ~ f^m, with its interval; 0 for a constant loss angle, near -1
        for one tau far above its frequency. [1]
    verdict : ndarray of int8
        Key of `VERDICTS`.
    confidence, tolerance : float
        Of the intervals; distance from 0 or 1 that counts as equal. [1]
    """

    exponent: Floats
    exponent_standard_uncertainty: Floats
    exponent_low: Floats
    exponent_high: Floats
    p_one_time: Floats
    p_inverse_frequency: Floats
    time_ratio: Floats
    time_ratio_low: Floats
    time_ratio_high: Floats
    frequency_ratio: Floats
    degrees_of_freedom: Integers
    loss_exponent: Floats
    loss_exponent_low: Floats
    loss_exponent_high: Floats
    verdict: NDArray[np.int8]
    confidence: float
    tolerance: float


def _membership(group: ArrayLike | None, n_runs: int) -> Floats:
    """One row for each group of runs at equal loads, 1 where a run belongs to it."""
    labels = np.zeros(n_runs, dtype=np.int64) if group is None else np.asarray(group)
    member: Floats = (np.unique(labels)[:, None] == labels).astype(np.float64)
    return member


def _power_of_frequency(
    frequency: ArrayLike,
    values: ArrayLike,
    *,
    group: ArrayLike | None = None,
    relative_standard_uncertainty: ArrayLike | None = None,
) -> tuple[Floats, Floats, Integers]:
    r"""Exponent of a power law of frequency, with one factor for each group of runs.

    .. math:: \ln y = a_g + m \ln f

    Notes
    -----
    A test that [1]_ did not make on its runs.  Runs have equal weight: from the third run on,
    their scatter about the line is the uncertainty, lack of fit included.

    Examples
    --------
    >>> m, _, dof = _power_of_frequency([0.1, 0.3, 0.5], [10.0, 30.0, 50.0])
    >>> print(m.round(6), dof)
    1.0 1
    """
    x = np.log(as_positive("frequency", frequency))
    series = np.asarray(values, dtype=np.float64)
    member = _membership(group, x.size)
    used = np.isfinite(series) & (series > 0)
    y = np.log(np.where(used, series, 1.0))
    weight = used.astype(np.float64)
    count = weight @ member.T
    present = np.maximum(count, 1)
    x_own = x - (weight * x) @ member.T / present @ member
    y_own = y - (weight * y) @ member.T / present @ member
    power = (weight * x_own**2).sum(axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        # runs at a single frequency leave rounding errors of its logarithm
        slope = np.where(power > 1e-12, (weight * x_own * y_own).sum(axis=-1) / power, np.nan)
        left = weight.sum(axis=-1) - (count > 0).sum(axis=-1) - 1
        residual = weight * (y_own - slope[..., None] * x_own)
        scatter = np.sqrt((residual**2).sum(axis=-1) / np.maximum(left, 1) / power)
        stated = np.full(slope.shape, np.nan)
        if relative_standard_uncertainty is not None:
            relative = np.asarray(relative_standard_uncertainty, dtype=np.float64)
            moved = np.where(used, x_own * relative, 0.0)
            stated = np.sqrt((moved**2).sum(axis=-1)) / power
    uncertainty = np.where(left > 0, scatter, stated)
    return slope, uncertainty, np.maximum(left, 0).astype(np.int64)


def _quantile(degrees_of_freedom: Integers) -> Floats:
    """Half width of an interval in standard uncertainties; normal where these were stated."""
    t = scipy.special.stdtrit(np.maximum(degrees_of_freedom, 1), (1 + CONFIDENCE) / 2)
    return np.where(degrees_of_freedom > 0, t, scipy.special.ndtri((1 + CONFIDENCE) / 2))


def _tail(distance: Floats, degrees_of_freedom: Integers) -> Floats:
    """Two-sided probability of a distance at least as large, in standard uncertainties."""
    t = 2 * scipy.special.stdtr(np.maximum(degrees_of_freedom, 1), -np.abs(distance))
    return np.where(degrees_of_freedom > 0, t, 2 * scipy.special.ndtr(-np.abs(distance)))


_TOLERANCE = 0.1
"""An exponent this close to 0 or 1 counts as equal: otherwise many runs would distinguish 0.95 from
1, and no line is exactly either. [1]"""


def check_single_time(
    frequency: ArrayLike,
    relaxation_time: ArrayLike,
    loss_factor: ArrayLike,
    *,
    group: ArrayLike | None = None,
    relative_standard_uncertainty: ArrayLike | None = None,
) -> SingleTimeCheck:
    r"""Test whether one relaxation time holds over the frequencies of some runs.

    .. math:: \ln \tau = a_g - n \ln f

    Parameters
    ----------
    frequency : array_like, shape (n_runs,)
        Frequency of each run. [Hz]
    relaxation_time : array_like, shape (..., n_runs)
        tau of each run, for one line or many; NaN is left out. [s]
    loss_factor : array_like, shape (..., n_runs)
        Tangent of the loss angle of each run. [1]
    group : array_like, shape (n_runs,), optional
        Label of the loads of each run: only runs at equal loads are compared. [1]
    relative_standard_uncertainty : array_like, shape (..., n_runs), optional
        Of tau, without the part of K_0, which is common to runs at equal loads; used where the
        runs leave no degree of freedom, as two frequencies at one load do. [1]

    Returns
    -------
    check : SingleTimeCheck
        Exponent, ratio of times, tests and verdict.

    Raises
    ------
    DataError
        If shapes do not fit or a frequency is not positive.

    Notes
    -----
    Source: Table 17 of [1]_ prints tau with terms of frequency as large as its mean: at the
    centre loads tau(0.1 Hz)/tau(0.5 Hz) is 2.85 to 14, where 1/f gives 5.  A fifteen-run
    design has four pairs of extreme frequencies at equal loads; with its centre runs in a
    group of their own this gives 8 runs, 4 factors and 3 degrees of freedom.

    Examples
    --------
    >>> f = np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    >>> wobble = 1 + 0.02 * np.array([1, -1, 1, -1, 0])
    >>> check = check_single_time(f, 0.6 / f * wobble, 0.1 * wobble)
    >>> print(check.exponent.round(2), check.time_ratio.round(1), VERDICTS[int(check.verdict)][:34])
    1.01 5.1 the relaxation time follows 1/f: t
    """
    slope, uncertainty, left = _power_of_frequency(
        frequency,
        relaxation_time,
        group=group,
        relative_standard_uncertainty=relative_standard_uncertainty,
    )
    loss_slope, loss_uncertainty, loss_left = _power_of_frequency(
        frequency, loss_factor, group=group
    )
    exponent = -slope
    width = _quantile(left) * uncertainty
    loss_width = _quantile(loss_left) * loss_uncertainty
    rates = np.asarray(frequency, dtype=np.float64)
    used = np.asarray(relaxation_time) > 0
    highest = np.where(used, rates, -np.inf).max(axis=-1)
    lowest = np.where(used, rates, np.inf).min(axis=-1)
    span = np.where(np.isfinite(highest), highest, 1) / np.where(np.isfinite(lowest), lowest, 1)
    low, high = exponent - width, exponent + width
    with np.errstate(divide="ignore", invalid="ignore"):
        holds_none, holds_one = (
            (low <= exact + _TOLERANCE) & (high >= exact - _TOLERANCE) for exact in (0, 1)
        )
        verdict = np.select(
            [~np.isfinite(width), holds_none & holds_one, holds_none, holds_one],
            [4, 0, 1, 2],
            default=3,
        ).astype(np.int8)
        p_none = _tail(exponent / uncertainty, left)
        p_inverse = _tail((exponent - 1) / uncertainty, left)
    with np.errstate(over="ignore"):  # of an exponent that is hardly known there is no upper limit
        ratio, ratio_low, ratio_high = (span**one for one in (exponent, low, high))
    return SingleTimeCheck(
        exponent=exponent,
        exponent_standard_uncertainty=uncertainty,
        exponent_low=low,
        exponent_high=high,
        p_one_time=p_none,
        p_inverse_frequency=p_inverse,
        time_ratio=ratio,
        time_ratio_low=ratio_low,
        time_ratio_high=ratio_high,
        frequency_ratio=span,
        degrees_of_freedom=left,
        loss_exponent=loss_slope,
        loss_exponent_low=loss_slope - loss_width,
        loss_exponent_high=loss_slope + loss_width,
        verdict=verdict,
        confidence=CONFIDENCE,
        tolerance=_TOLERANCE,
    )

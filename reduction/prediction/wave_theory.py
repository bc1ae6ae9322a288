r"""Regular waves: dispersion, breaking, Airy and Stokes theory, and the choice of a theory.

**Length of a wave from its period, and vice versa, over still water or a current.** A current U
along the wave changes the period at a fixed point,

.. math:: (\omega - k U)^2 = g k \tanh k d

An opposing current faster than the group velocity stops the waves: there is no length then.

**Greatest height of a wave before it breaks**:

.. math:: H_b = \min(0.142\, L \tanh k d,\; 0.78\, d)

**Sums of harmonics of a phase, and their zeros.** A real sum of harmonics up to order M is written
with complex coefficients,

.. math:: f(\theta) = \sum_{m=-M}^{M} c_m e^{i m \theta}, \qquad c_{-m} = \overline{c_m}

so that z^M f is a polynomial in :math:`z = e^{i \theta}`, and the zeros of f are those of its
roots that lie on the unit circle.

**Motion of the water under a regular wave: Airy's theory and Stokes' of second order.** With the
phase :math:`\theta = k x - \omega t`, z upwards from the mean level, and :math:`\sigma = \omega - k
U`,

.. math::
   \eta = \tfrac{H}{2} \cos\theta
          + \tfrac{k H^2}{16} \frac{\cosh kd\,(2 + \cosh 2kd)}{\sinh^3 kd} \cos 2\theta

   u_x = \tfrac{\sigma H}{2} \frac{\cosh k(z+d)}{\sinh kd} \cos\theta
         + \tfrac{3 k \sigma H^2}{16} \frac{\cosh 2k(z+d)}{\sinh^4 kd} \cos 2\theta

   u_z = \tfrac{\sigma H}{2} \frac{\sinh k(z+d)}{\sinh kd} \sin\theta
         + \tfrac{3 k \sigma H^2}{16} \frac{\sinh 2k(z+d)}{\sinh^4 kd} \sin 2\theta

The first terms are Airy's.  Over still water sigma H/2 is pi H/T, eq. (16) and (17) of [1]_.

Stokes' theory of third and of fifth order ([7]_), from the coefficients of raschii.

Cnoidal waves of first order ([8]_), with the parameter m and the integrals K and E of m,

.. math::
   \eta = H \left[\mathrm{cn}^2\!\left(\tfrac{K}{\pi} \theta\right)
          - \overline{\mathrm{cn}^2}\right], \qquad
   m K^2 = \frac{3 H L^2}{16 d^3}, \qquad
   c^2 = g d \left[1 + \frac{H}{m d} \left(2 - m - 3 \frac{E}{K}\right)\right]

   u_x = \frac{c\, \eta}{d}, \qquad u_z = -(z + d) \frac{\partial u_x}{\partial x}

For m = 1 it is the solitary wave, H sech^2 over still water with c^2 = g (d + H).

The steady wave of `reduction.prediction.stream_function`, for waves that do not break.

**Which wave theory applies, and the distance of a wave from its limits.** With the Ursell number
Ur = H L^2 / d^3 and the amplitudes a_1, a_2 of the first and second harmonic of Stokes' surface,
a_2 / a_1 tends to 3 Ur / (32 pi^2) over shallow water; where it exceeds 1/4, at Ur = 8 pi^2 / 3 =
26.3, the trough has a secondary crest.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 14 and Table 4; Table 1; eq. 13-17; Table 1 and sec. 5.
.. [2] C. Eckart, "The propagation of gravity waves from deep to shallow water," in Gravity Waves,
   Nat. Bur. Standards Circ. 521, 1952, pp. 165-173.
.. [3] D. H. Peregrine, "Interaction of water waves and currents," Adv. Appl. Mech., vol. 16, 1976,
   pp. 9-117, sec. II.
.. [4] J. P. Boyd, "Computing the zeros, maxima and inflection points of Chebyshev, Legendre and
   Fourier series: solving transcendental equations by spectral interpolation and polynomial
   rootfinding," J. Eng. Math., vol. 56, 2006, pp. 203-219, sec. 6.
.. [5] R. G. Dean and R. A. Dalrymple, Water Wave Mechanics for Engineers and Scientists. Singapore:
   World Scientific, 1991, ch. 3, 4 and 11; ch. 11.
.. [6] F. Ursell, "The long-wave paradox in the theory of gravity waves," Proc. Cambridge Phil.
   Soc., vol. 49, 1953, pp. 685-694.
.. [7] J. D. Fenton, "A fifth-order Stokes theory for steady waves," J. Waterway, Port, Coastal and
   Ocean Eng., vol. 111, 1985, pp. 216-234.
.. [8] R. L. Wiegel, "A presentation of cnoidal wave theory for practical application," J. Fluid
   Mech., vol. 7, 1960, pp. 273-286.
.. [9] T. S. Hedges, "Regions of validity of analytical wave theories," Proc. Inst. Civ. Eng. Water,
   Maritime and Energy, vol. 112, 1995, pp. 111-114.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import cosh, exp, expm1, log, pi, sinh, sqrt, tanh
from typing import Any, Literal

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray
from scipy.special import ellipe, ellipkm1, expit

from reduction.prediction.stream_function import SteadyWave, steady_wave
from reduction.record.arrays import as_finite, as_positive
from reduction.record.errors import DataError, FitError, SettingsError
from reduction.record.measurement import STANDARD_GRAVITY, Floats, read_only_arrays
from reduction.record.notes import Note, note

_STEP = 1e-14  # greatest last Newton step, relative to the root

_RESIDUAL = 4 * float(np.finfo(np.float64).eps)

_MOST_STEPS = 100  # four or five are enough except at the limit of blocking


def _wave_number(
    wave_period: ArrayLike,
    water_depth: ArrayLike,
    *,
    current_velocity: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> Floats:
    """Wave number of the linear wave with this period.

    Notes
    -----
    Eq. (14) of [1]_ prints k = 2 pi / T; a wave number is 2 pi / L (its tables use that).

    Over still water Newton's method starts from the form of [2]_, which is right to 5 %.  Over a
    current it starts from that result: omega - k U - sqrt(g k tanh k d) is convex in k, so it
    cannot pass the wanted root, and a tangent that no longer falls proves that there is none.

    Examples
    --------
    Table 4 of [1]_ has 20 m with 3.57 s, the length over deep water; 3 m deep it is 16.3 m.

    >>> print((2 * np.pi / _wave_number(3.57, [100.0, 6.0, 3.0])).round(2))
    [19.89 19.13 16.31]
    """
    period, depth, current = _conditions(wave_period, water_depth, current_velocity)
    pace = np.sqrt(gravity * depth)
    frequency = 2 * pi / period * depth / pace
    root = _still_water(frequency**2)
    if np.any(current != 0):
        root = _over_current(frequency, current / pace, root)
        _refuse_blocked(np.isnan(root), current)
    return np.asarray(root / depth)


def wave_period_of(
    wave_number: ArrayLike,
    water_depth: ArrayLike,
    *,
    current_velocity: ArrayLike = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> Floats:
    """Period of the linear wave with this wave number at a fixed point.

    Notes
    -----
    The inverse of `_wave_number`.

    Examples
    --------
    The 20 m of Table 4 of [1]_ do not match its 3.57 s at either depth of its examples.

    >>> print(wave_period_of(2 * np.pi / 20, [6.0, 3.0]).round(3))
    [3.663 4.172]
    """
    number, depth, current = np.broadcast_arrays(
        as_positive("wave_number", wave_number),
        as_positive("water_depth", water_depth),
        as_finite("current_velocity", current_velocity),
    )
    group = _group_velocity(number, depth, gravity=gravity)
    _refuse_blocked(current + group <= 0, current)
    intrinsic = np.sqrt(gravity * number * np.tanh(number * depth))
    return np.asarray(2 * pi / (intrinsic + number * current))


def _group_velocity(
    wave_number: ArrayLike, water_depth: ArrayLike, *, gravity: float = STANDARD_GRAVITY
) -> Floats:
    """Speed of the energy of a linear wave relative to the water.

    Notes
    -----
    Derivative of the frequency by the wave number ([3]_): half the phase speed over deep water.

    Examples
    --------
    >>> print(_group_velocity(2 * np.pi / 20, 100.0).round(3))
    2.794
    """
    number = as_positive("wave_number", wave_number)
    relative_depth = number * as_positive("water_depth", water_depth)
    phase_speed = np.sqrt(gravity / number * np.tanh(relative_depth))
    # 2 q / sinh 2q, which neither overflows nor loses digits
    share = 4 * relative_depth * np.exp(-2 * relative_depth) / -np.expm1(-4 * relative_depth)
    return np.asarray(phase_speed / 2 * (1 + share))


def _conditions(period: ArrayLike, depth: ArrayLike, current: ArrayLike) -> tuple[Floats, ...]:
    return np.broadcast_arrays(
        as_positive("wave_period", period),
        as_positive("water_depth", depth),
        as_finite("current_velocity", current),
    )


def _still_water(squared_frequency: Floats) -> Floats:
    """Root q of q tanh q = omega^2 d / g."""
    root = squared_frequency / np.sqrt(np.tanh(squared_frequency))
    for _ in range(_MOST_STEPS):
        tanh = np.tanh(root)
        step = (root * tanh - squared_frequency) / (tanh + root * (1 - tanh**2))
        root = root - step
        if np.all(np.abs(step) <= _STEP * root):
            return np.asarray(root)
    raise _no_root()


def _over_current(frequency: Floats, current: Floats, start: Floats) -> Floats:
    """Root q of omega - q U = sqrt(q tanh q), all over sqrt(g / d); NaN where there is none."""
    root = start.copy()
    for _ in range(_MOST_STEPS):
        tanh = np.tanh(root)
        intrinsic = np.sqrt(root * tanh)
        miss = frequency - root * current - intrinsic
        is_there = np.abs(miss) <= _RESIDUAL * (frequency + root * np.abs(current))
        slope = -current - (tanh + root * (1 - tanh**2)) / (2 * intrinsic)
        is_blocked = (slope >= 0) & ~is_there
        step = miss / np.where(slope < 0, slope, np.nan)
        is_there |= np.abs(step) <= _STEP * root
        root = np.where(is_blocked, np.nan, np.where(is_there, root, root - step))
        if np.all(is_there | np.isnan(root)):
            return np.asarray(root)
    raise _no_root()


def _no_root() -> FitError:
    return FitError(
        "the wave number was not found",
        found=f"no end after {_MOST_STEPS} Newton steps",
        needed=f"a last step below {_STEP:g} of the root",
    )


def _refuse_blocked(is_blocked: np.ndarray, current: Floats) -> None:
    if not np.any(is_blocked):
        return
    first = int(np.flatnonzero(np.ravel(is_blocked))[0])
    raise DataError(
        f"the opposing current stops {int(np.sum(is_blocked))} of {np.size(is_blocked)} waves, "
        f"first at index {first}"
        if np.size(is_blocked) > 1
        else "the opposing current stops the wave",
        found=f"a current of {np.ravel(current)[first]:g} m/s",
        needed="an opposing current slower than the group velocity of the wave",
    )


GREATEST_STEEPNESS = 0.142
"""Height over length of the steepest wave on deep water (Miche). [1]"""

GREATEST_HEIGHT_TO_DEPTH = 0.78
"""Height over depth of the highest solitary wave (McCowan). [1]"""


def breaking_height(wave_number: ArrayLike, water_depth: ArrayLike) -> Floats:
    """Height at which a wave of this length breaks over a flat bed.

    Notes
    -----
    Not covered: a sloping bed, an opposing current and short-crested seas, in which waves break
    earlier.  NaN is refused.

    Examples
    --------
    Table 1 of [1]_ requires a height of 0.2 lengths or more for Stokes' theory. The 20 m wave of
    its examples breaks long before, at 0.136 lengths 6 m deep and 0.105 3 m deep.

    >>> print((breaking_height(2 * np.pi / 20, [6.0, 3.0]) / 20).round(3))
    [0.136 0.105]
    """
    number = as_positive("wave_number", wave_number)
    depth = as_positive("water_depth", water_depth)
    miche = GREATEST_STEEPNESS * 2 * pi / number * np.tanh(number * depth)
    return np.asarray(np.minimum(miche, GREATEST_HEIGHT_TO_DEPTH * depth))


def _refuse_breaking(*, wave_height: float, wave_number: float, water_depth: float) -> None:
    """Raise where a wave is higher than the breaking height.

    Notes
    -----
    A wave of exactly the breaking height passes.

    Examples
    --------
    The wave of [1]_ is well below breaking.

    >>> _refuse_breaking(wave_height=1.25, wave_number=2 * np.pi / 20, water_depth=3.0)
    """
    greatest = float(breaking_height(wave_number, water_depth))
    if wave_height <= greatest:
        return
    raise DataError(
        f"a wave {2 * pi / wave_number:.4g} m long breaks before it is this high",
        found=f"{wave_height:.4g} m over {water_depth:.4g} m of water",
        needed=f"at most {greatest:.4g} m",
        hint="Give a lower or a longer wave.",
    )


@dataclass(frozen=True)
@read_only_arrays
class WaveHarmonics:
    """Amplitudes of the first harmonic and those above it.

    With the phase k x - omega t, harmonic n of the elevation, the horizontal velocity and the
    vertical acceleration varies as cos n(phase); that of the vertical velocity and the
    horizontal acceleration as sin n(phase).  Velocities and accelerations may come from
    different theories: a load does not depend on their origin.

    Parameters
    ----------
    wave_number : float
        k. [rad m-1]
    angular_frequency : float
        omega. [rad s-1]
    elevation : ndarray, shape (n_harmonics,)
        Surface elevation. [m]
    horizontal_velocity, vertical_velocity : ndarray, shape (n_harmonics,)
        Velocity of a particle. [m s-1]
    horizontal_acceleration, vertical_acceleration : ndarray, shape (n_harmonics,)
        Local acceleration; the vertical one is negative in a progressive wave. [m s-2]
    """

    wave_number: float
    angular_frequency: float
    elevation: Floats
    horizontal_velocity: Floats
    vertical_velocity: Floats
    horizontal_acceleration: Floats
    vertical_acceleration: Floats

    def __post_init__(self) -> None:
        """Check that every quantity has the same harmonics, and make the arrays read-only."""
        shapes = {
            name: getattr(self, name).shape
            for name in (
                "elevation",
                "horizontal_velocity",
                "vertical_velocity",
                "horizontal_acceleration",
                "vertical_acceleration",
            )
        }
        if len(set(shapes.values())) > 1 or self.elevation.ndim != 1:
            found = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
            raise DataError("the harmonics do not pair up", found=found, needed="one shape (n,)")


Coefficients = NDArray[np.complex128]

_ZERO = 1e-14  # outermost coefficients below this share of the largest are rounding


def cosine_series(amplitude: Floats, constant: float = 0.0) -> Coefficients:
    """Coefficients of a constant and cosines.

    Notes
    -----
    cos x = (e^ix + e^-ix) / 2.

    Examples
    --------
    >>> print(cosine_series(np.array([2.0]), 3.0).real)
    [1. 3. 1.]
    """
    half = np.asarray(amplitude, dtype=np.float64) / 2
    return np.concatenate([half[::-1], [constant], half]).astype(np.complex128)


def sine_series(amplitude: Floats) -> Coefficients:
    """Coefficients of sines.

    Notes
    -----
    sin x = (e^ix - e^-ix) / 2i.

    Examples
    --------
    >>> print(sine_series(np.array([2.0])).imag)
    [ 1. 0. -1.]
    """
    half = np.asarray(amplitude, dtype=np.float64) / 2j
    return np.concatenate([-half[::-1], [0.0], half]).astype(np.complex128)


def phase_derivative(coefficients: Coefficients) -> Coefficients:
    """Coefficients of the derivative with respect to the phase.

    Notes
    -----
    i m c_m.

    Examples
    --------
    The derivative of 2 cos is -2 sin.

    >>> print(phase_derivative(cosine_series(np.array([2.0]))).imag)
    [-1. 0. 1.]
    """
    return np.asarray(1j * _orders(coefficients) * coefficients)


def series_product(first: Coefficients, second: Coefficients) -> Coefficients:
    """Coefficients of the product of two sums.

    Notes
    -----
    The convolution of the two.

    Examples
    --------
    4 cos^2 is 2 + 2 cos of twice the phase.

    >>> cosine = cosine_series(np.array([2.0]))
    >>> print(series_product(cosine, cosine).real)
    [1. 0. 2. 0. 1.]
    """
    _orders(first), _orders(second)
    return np.convolve(first, second)


def sum_at(coefficients: Coefficients, phase: Floats) -> Floats:
    """Value of a sum at phases.

    Notes
    -----
    Real, since the coefficients of opposite orders are conjugate.

    Examples
    --------
    >>> print(sum_at(cosine_series(np.array([2.0]), 3.0), np.array([0.0, np.pi])))
    [5. 1.]
    """
    waves = np.exp(1j * np.multiply.outer(phase, _orders(coefficients)))
    return np.asarray((waves @ coefficients).real)


def root_phases(coefficients: Coefficients) -> Floats:
    """Phases of all roots of z^M f, whether on the unit circle or not.

    Notes
    -----
    Eigenvalues of the companion matrix ([4]_).  Roots off the circle are kept: a search for the
    greatest value of a function tries them all and needs no tolerance to separate them.  Outermost
    orders that are rounding errors are left out.

    Examples
    --------
    >>> print(np.sort(root_phases(cosine_series(np.array([1.0])))).round(6))
    [-1.570796  1.570796]
    """
    orders = _orders(coefficients)
    rows = np.reshape(coefficients, (-1, orders.size))
    size = np.abs(rows)
    is_there = size > _ZERO * size.max(axis=-1, keepdims=True)
    order_of = np.max(np.where(is_there, orders, 0), axis=-1)
    phase = np.zeros((len(rows), max(2 * int(order_of.max(initial=0)), 1)))
    for order in range(1, int(order_of.max(initial=0)) + 1):
        alike = order_of == order
        middle = orders.size // 2
        falling = rows[alike, middle - order : middle + order + 1][:, ::-1]
        companion = np.zeros((len(falling), 2 * order, 2 * order), dtype=np.complex128)
        companion[:, 0, :] = -falling[:, 1:] / falling[:, :1]
        companion[:, np.arange(1, 2 * order), np.arange(2 * order - 1)] = 1.0
        phase[alike, : 2 * order] = np.angle(np.linalg.eigvals(companion))
    return phase.reshape(*np.shape(coefficients)[:-1], phase.shape[1])


def _orders(coefficients: Coefficients) -> NDArray[np.int64]:
    n_coefficients = np.shape(coefficients)[-1]
    if n_coefficients % 2 == 0:
        raise DataError(
            "the coefficients have no middle", found=f"{n_coefficients}", needed="an odd number"
        )
    middle = n_coefficients // 2
    return np.arange(-middle, middle + 1, dtype=np.int64)


def airy_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_number: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveHarmonics:
    """Airy's linear wave at one elevation.

    Notes
    -----
    Eq. (13) and (15) of [1]_ print the velocity amplitude H g k / (2 omega) with cosh kd in the
    denominator, and the acceleration 2 pi^2 H / T^2 with sinh kd.  One is the derivative of the
    other only where length and period match.  Here velocities follow the surface (pi H/T over sinh
    kd) whatever the length, and accelerations are their derivative; see
    `reduction.prediction.wave_theory` for the mismatch.

    Over a current, the motion is that in water moving with the current ([3]_), and so is the
    acceleration, which is that of a particle to first order.

    Between the mean level and the crest the formula is extrapolated, which overestimates the
    motion; the convective acceleration is left out, as in [1]_, eq. 13-17.

    Examples
    --------
    The wave of Table 4 of [1]_ 6 m deep, at the mean level: pi H/T = 1.1 m/s in both directions,
    except for coth kd.

    >>> wave = airy_wave(wave_height=1.25, wave_period=3.57, water_depth=6.0, elevation=0.0,
    ...                  wave_number=2 * np.pi / 20)
    >>> print(wave.horizontal_velocity.round(3), wave.vertical_velocity.round(3))
    [1.152] [1.1]
    """
    frequency, number = _frequency_and_number(
        wave_height, wave_period, water_depth, wave_number, current_velocity, gravity
    )
    crest = wave_height / 2
    _refuse_outside(elevation, water_depth, crest)
    return _harmonics(
        frequency=2 * pi / wave_period,
        intrinsic=frequency,
        number=number,
        surface=[crest],
        speed=[frequency * wave_height / 2 * _decay(number, water_depth, elevation)],
        height_above_bed=water_depth + elevation,
    )


def stokes_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_number: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveHarmonics:
    """Stokes' wave of second order at one elevation.

    Notes
    -----
    Eq. (16) and (17) of [1]_, which are right as printed; the elevation, which it does not
    print, from [5]_, ch. 3, 4 and 11.  Second order has the dispersion relation of first order: the
    increase of speed with height is of third order.

    Not flagged here: a secondary crest in the trough where the second harmonic of the surface
    is above a quarter of the first; see `reduction.prediction.wave_theory`.

    Examples
    --------
    The wave of Table 4 of [1]_ 3 m deep, at the mean level.

    >>> wave = stokes_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=0.0,
    ...                    wave_number=2 * np.pi / 20)
    >>> print(wave.horizontal_velocity.round(3), wave.elevation.round(3))
    [1.494 0.389] [0.625 0.189]
    """
    intrinsic, number = _frequency_and_number(
        wave_height, wave_period, water_depth, wave_number, current_velocity, gravity
    )
    depth = number * water_depth
    flat = -expm1(-2 * depth)  # 2 exp(-kd) sinh kd: no overflow on deep water
    # cosh kd (2 + cosh 2kd) / sinh^3 kd = coth kd (3 + 2 sinh^2 kd) / sinh^2 kd
    shape = (2 + 12 * exp(-2 * depth) / flat**2) / tanh(depth)
    surface = [wave_height / 2, number * wave_height**2 / 16 * shape]
    _refuse_outside(elevation, water_depth, sum(surface))
    first = intrinsic * wave_height / 2 * _decay(number, water_depth, elevation)
    # sinh 2kd / sinh^4 kd = 8 exp(-2 kd) (1 - exp(-4 kd)) / flat^4
    second = 8 * exp(-2 * depth) * -expm1(-4 * depth) / flat**4
    second *= 3 / 16 * number * intrinsic * wave_height**2
    second *= _decay(2 * number, water_depth, elevation)
    return _harmonics(
        frequency=2 * pi / wave_period,
        intrinsic=intrinsic,
        number=number,
        surface=surface,
        speed=[first, second],
        height_above_bed=water_depth + elevation,
    )


_GREATEST_OF_STOKES = 40.0  # Ursell number H L^2 / d^3 at which the series of Stokes end ([9]_)


def high_stokes_wave(
    *,
    order: int,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_number: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveHarmonics:
    """Stokes' wave of third to fifth order at one elevation.

    Raises
    ------
    SettingsError
        If raschii is not installed.
    DataError, FitError
        If the wave breaks, is too long for its depth ([9]_), or no length matches its period.

    Notes
    -----
    Theory of [7]_.  raschii computes surface and velocities; their harmonics are found from 16
    phases, which is exact for up to seven harmonics.  As for the lower orders, velocities
    follow the surface whatever the length, and accelerations are their local rate.

    Examples
    --------
    The steep wave of [1]_, 16.3 m long by the linear theory; raschii also finds 17.42 m.

    >>> wave = high_stokes_wave(order=5, wave_height=1.25, wave_period=3.57, water_depth=3.0,
    ...                         elevation=0.0)
    >>> print(round(2 * np.pi / wave.wave_number, 2))
    17.42
    """
    try:
        from raschii import StokesWave
    except ImportError:
        raise SettingsError(
            "Stokes waves above second order are computed by raschii, which is not installed",
            found="no module raschii", needed='pip install "mooring-reduction[waves]"',
            hint='wave_theory = "stokes", of second order, needs nothing.',
        ) from None  # fmt: skip

    def raschii_wave(number: float) -> Any:
        # below three lengths the depth has no effect, but cosh overflows
        depth = min(water_depth, 6 * pi / number)
        return StokesWave(wave_height, depth, 2 * pi / number, N=order, g=gravity)

    if wave_number is None:
        wave_number = _long_number(
            lambda number: float(raschii_wave(number).c),
            wave_period, water_depth, current_velocity, gravity,
        )  # fmt: skip
    intrinsic, number = _frequency_and_number(
        wave_height, wave_period, water_depth, wave_number, current_velocity, gravity
    )
    ursell = wave_height * (2 * pi / number) ** 2 / water_depth**3
    if ursell > _GREATEST_OF_STOKES:
        raise DataError(
            "the wave is too long for Stokes' theory",
            found=f"an Ursell number of {ursell:.4g}",
            needed=f"at most {_GREATEST_OF_STOKES:g}",
            hint='wave_theory = "cnoidal" is for long waves.',
        )
    wave = raschii_wave(number)
    place = np.arange(16) * wave.length / 16
    surface = np.fft.rfft(wave.surface_elevation(place, 0.0, False)).real[1 : order + 1] / 8
    _refuse_outside(elevation, water_depth, float(np.sum(surface)))
    height = np.full(16, max(wave.depth + elevation, 0.0))
    speed = wave.velocity(place, height, 0.0, all_points_wet=True) * intrinsic / (number * wave.c)
    series = np.fft.rfft(speed, axis=0)[1 : order + 1] / 8
    return _motions(
        frequency=2 * pi / wave_period,
        intrinsic=intrinsic,
        number=number,
        surface=surface,
        horizontal=series[:, 0].real,
        vertical=-series[:, 1].imag,
    )


_LEAST_HARMONIC = 1e-8  # of a cnoidal surface, relative to the largest

_GREATEST_LOGIT = 600.0  # of m: beyond it the crests are solitary waves, hundreds of depths apart

_MOST_HARMONICS = 100  # of a cnoidal wave: the time to find its extremes grows with their cube


def cnoidal_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_number: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveHarmonics:
    r"""Cnoidal wave of first order at one elevation; a solitary wave where the period is long.

    Raises
    ------
    DataError, FitError
        If the wave breaks, is too short for a long-wave theory, no length matches its period, or
        the crests are so far apart that each is a solitary wave.

    Notes
    -----
    Theory of [8]_, as harmonics of the nome q = exp(-pi K' / K),

    .. math:: a_n = H \frac{2 \pi^2}{m K^2} \frac{n q^n}{1 - q^{2n}}

    down to 1e-8 of the largest.  The horizontal velocity is the same at every depth.  Relative to
    the stream function, at d/L from 0.045 to 0.083 and heights up to half the depth, the length is
    within 1.4 %, the crest within 4 %, and the velocity under the crest, at the mean level, from
    12 % too low in low waves to 30 % too high in the highest.

    Examples
    --------
    A solitary wave rises H above still water, which is 2 H / (kappa L) below the mean level, with
    kappa^2 = 3 H / (4 d^3): here 0.298 per m, and so 0.400 m - 0.032 m.

    >>> wave = cnoidal_wave(wave_height=0.4, wave_period=20.0, water_depth=1.5, elevation=0.0)
    >>> print(wave.elevation.sum().round(3))
    0.368
    """

    def parameter_of(number: float) -> float:
        """Logit of m: neither m nor 1 - m loses digits."""
        ursell = wave_height * (2 * pi / number) ** 2 / water_depth**3

        def miss(logit: float) -> float:
            return log(expit(logit) * ellipkm1(expit(-logit)) ** 2) - log(3 * ursell / 16)

        if miss(_GREATEST_LOGIT) < 0:
            raise _too_far_apart(2 * pi / number / water_depth)
        return float(scipy.optimize.brentq(miss, -60.0, _GREATEST_LOGIT, xtol=1e-13))

    def speed_of(number: float) -> float:
        logit = parameter_of(number)
        m, integral = expit(logit), ellipkm1(expit(-logit))
        square = 1 + wave_height / (m * water_depth) * (2 - m - 3 * ellipe(m) / integral)
        if square <= 0:
            raise DataError(
                "the wave is too short for the cnoidal theory, one of long waves",
                found=f"a depth of {number * water_depth / (2 * pi):.3g} wave lengths",
                needed="0.1 or less",
            )
        return sqrt(gravity * water_depth * square)

    if wave_number is None:
        wave_number = _long_number(speed_of, wave_period, water_depth, current_velocity, gravity)
    intrinsic, number = _frequency_and_number(
        wave_height, wave_period, water_depth, wave_number, current_velocity, gravity
    )
    logit = parameter_of(number)
    integral = ellipkm1(expit(-logit))
    order = np.arange(1, _MOST_HARMONICS + 1)
    fall = np.exp(-pi * order * ellipkm1(expit(logit)) / integral)
    share = 2 * pi**2 / (expit(logit) * integral**2) * order * fall / (1 - fall**2)
    surface = wave_height * share
    if surface[-1] > _LEAST_HARMONIC * surface.max():
        raise _too_far_apart(2 * pi / number / water_depth)
    n_kept = 1 + int(np.flatnonzero(surface > _LEAST_HARMONIC * surface.max())[-1])
    surface, order = surface[:n_kept], order[:n_kept]
    _refuse_outside(elevation, water_depth, float(surface.sum()))
    horizontal = intrinsic / (number * water_depth) * surface
    return _motions(
        frequency=2 * pi / wave_period,
        intrinsic=intrinsic,
        number=number,
        surface=surface,
        horizontal=horizontal,
        vertical=order * number * (water_depth + elevation) * horizontal,
    )


def _too_far_apart(length: float) -> DataError:
    return DataError(
        "the crests are so far apart that the wave has too many harmonics",
        found=f"a length of {length:.4g} depths",
        needed=f"at most {_MOST_HARMONICS} harmonics",
        hint="Give a shorter period: a solitary wave does not change with it.",
    )


_LEAST_OF_STREAM = 1e-9  # share of the largest harmonic: the series is rounding error below it


def stream_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_number: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
) -> WaveHarmonics:
    """Steady wave from its stream function at one elevation, for any depth up to breaking.

    Raises
    ------
    DataError, FitError
        If the wave breaks, or is so long that its crests are solitary waves.

    Notes
    -----
    The current is the mean velocity of the water at a point below the trough.  A length that is
    given with the period is kept; velocities then follow the surface, as in the other theories.

    Examples
    --------
    The 3.57 s wave of [1]_ over 3 m of water: 16.3 m long by the linear theory, 17.4 m with its
    height.

    >>> wave = stream_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0, elevation=0.0)
    >>> print(round(2 * np.pi / wave.wave_number, 2))
    17.42
    """
    steady, depth = _stream_of(
        wave_height, wave_period, water_depth, wave_number, current_velocity, gravity
    )
    number = steady.number / depth
    intrinsic, number = _frequency_and_number(
        wave_height, wave_period, water_depth, number, current_velocity, gravity
    )
    _refuse_outside(elevation, water_depth, depth * float(np.sum(steady.surface)))
    order = np.arange(1, steady.surface.size + 1)
    # j B_j cosh(j k (z + d)) / cosh(j k d) without overflow, as the growing part
    speed = intrinsic / number / steady.speed * steady.velocity
    growing = speed * np.exp(order * number * elevation) / (1 + np.exp(-2 * order * steady.number))
    size = np.abs(np.stack([steady.surface, growing]))
    is_felt = np.any(size > _LEAST_OF_STREAM * size.max(axis=1, keepdims=True), axis=0)
    kept = 1 + int(np.flatnonzero(is_felt)[-1])
    return _harmonics(
        frequency=2 * pi / wave_period,
        intrinsic=intrinsic,
        number=number,
        surface=(depth * steady.surface)[:kept].tolist(),
        speed=growing[:kept].tolist(),
        height_above_bed=water_depth + elevation,
    )


def _stream_of(
    height: float,
    period: float,
    depth: float,
    number: float | None,
    current: float,
    gravity: float,
) -> tuple[SteadyWave, float]:
    """Steady wave, and its computational depth: beyond three lengths the depth has no effect."""
    as_positive("wave_height", height)
    linear = number
    if linear is None:
        linear = float(_wave_number(period, depth, current_velocity=current, gravity=gravity))
    felt = min(depth, 6 * pi / linear)
    pace = sqrt(gravity * felt)
    try:
        steady = steady_wave(
            height=height / felt,
            first_number=linear * felt,
            frequency=None if number is not None else 2 * pi / period * felt / pace,
            current=current / pace,
        )
    except FitError:
        _refuse_breaking(wave_height=height, wave_number=linear, water_depth=depth)
        raise
    return steady, felt


def _long_number(
    speed_of: Callable[[float], float], period: float, depth: float, current: float, gravity: float
) -> float:
    """Wave number of a theory whose speed depends on the height, starting at the linear one."""
    linear = float(_wave_number(period, depth, current_velocity=current, gravity=gravity))
    try:
        return float(
            scipy.optimize.newton(
                lambda number: number * (speed_of(number) + current) * period / (2 * pi) - 1,
                linear, x1=0.97 * linear, tol=1e-13 * linear, maxiter=_MOST_STEPS,
            )
        )  # fmt: skip
    except (RuntimeError, ValueError, ArithmeticError):
        raise FitError(
            "no length of this theory was found for the period of the wave",
            found=f"a period of {period:.4g} s over {depth:.4g} m of water",
            needed="a wave within the range of the theory",
            hint="Give wave_length, or another wave_theory.",
        ) from None


def _frequency_and_number(
    height: float,
    period: float,
    depth: float,
    number: float | None,
    current: float,
    gravity: float,
) -> tuple[float, float]:
    """Frequency in water that moves with the current, and wave number."""
    as_positive("wave_height", height)
    if number is None:
        number = float(_wave_number(period, depth, current_velocity=current, gravity=gravity))
    as_positive("wave_number", number)
    intrinsic = float(2 * pi / as_positive("wave_period", period)) - number * current
    if intrinsic <= 0:
        raise DataError(
            "the current is faster than the wave",
            found=f"a current of {current:g} m/s, a wave of {2 * pi / (period * number):.4g} m/s",
            needed="a wave that goes forward through the water",
        )
    _refuse_breaking(wave_height=height, wave_number=number, water_depth=depth)
    return intrinsic, number


def _refuse_outside(elevation: float, depth: float, crest: float) -> None:
    if -depth <= elevation <= crest:
        return
    raise DataError(
        "the place is not in the water",
        found=f"an elevation of {elevation:.4g} m",
        needed=f"from {-depth:.4g} m, the bed, to {crest:.4g} m, the crest",
    )


def _decay(number: float, depth: float, elevation: float) -> float:
    """Size exp k(z+d) / (2 sinh kd), which does not overflow."""
    return exp(number * elevation) / -expm1(-2 * number * depth)


def _harmonics(
    *,
    frequency: float,
    intrinsic: float,
    number: float,
    surface: list[float],
    speed: list[float],
    height_above_bed: float,
) -> WaveHarmonics:
    """Motions from the size of their growing part, exp n k(z+d), at each harmonic."""
    order = np.arange(1, len(speed) + 1)
    fading = np.exp(-2 * order * number * height_above_bed)
    return _motions(
        frequency=frequency,
        intrinsic=intrinsic,
        number=number,
        surface=np.asarray(surface),
        horizontal=np.asarray(speed) * (1 + fading),
        vertical=np.asarray(speed) * (1 - fading),
    )


def _motions(
    *,
    frequency: float,
    intrinsic: float,
    number: float,
    surface: Floats,
    horizontal: Floats,
    vertical: Floats,
) -> WaveHarmonics:
    """Velocities, and accelerations as their local rate in water that moves with the current."""
    order = np.arange(1, surface.size + 1)
    return WaveHarmonics(
        wave_number=number,
        angular_frequency=frequency,
        elevation=surface,
        horizontal_velocity=horizontal,
        vertical_velocity=vertical,
        horizontal_acceleration=order * intrinsic * horizontal,
        vertical_acceleration=-order * intrinsic * vertical,
    )


WaveTheoryName = Literal[
    "airy", "stokes", "stokes 3", "stokes 5", "cnoidal", "stream function", "beyond the table"
]

PrintedTheory = Literal["airy", "stokes", "cnoidal or solitary", "none"]


def _theory_by_depth(relative_depth: float) -> WaveTheoryName:
    """Theory by the relative depth alone.

    Notes
    -----
    Table 1 of [1]_ assigns d/L = 0.1 to no theory; here it is assigned to Stokes, as in sec. 5
    ("between 2 and 4 meters" of a 20 m wave).  Its lowest limit, "0.04~0.05", is taken as 0.04.
    "Conical" and solitary share a row: a solitary wave is a cnoidal one of long period.

    Examples
    --------
    The 20 m wave of [1]_ over 6 m, 3 m and 1.5 m of water.

    >>> [_theory_by_depth(depth / 20) for depth in (6.0, 3.0, 1.5)]
    ['airy', 'stokes', 'cnoidal']
    """
    as_positive("relative_depth", relative_depth)
    if relative_depth >= 0.2:
        return "airy"
    if relative_depth >= 0.1:
        return "stokes"
    return "cnoidal" if relative_depth > 0.04 else "beyond the table"


def _printed_theory(relative_depth: float, steepness: float) -> PrintedTheory:
    """Theory by Table 1 taken literally.

    Notes
    -----
    Table 1 of [1]_ contradicts itself: its row for Stokes requires H/L of 0.2 or more, where
    every wave has broken (at most 0.142, and 0.12 at d/L = 0.2), and its row for Airy allows
    up to 0.2.  The second example of the paper, H/L = 0.0625 at d/L = 0.15, is in no row.

    Examples
    --------
    >>> _printed_theory(0.3, 0.0625), _printed_theory(0.15, 0.0625)
    ('airy', 'none')
    """
    as_positive("relative_depth", relative_depth)
    as_positive("steepness", steepness)
    if relative_depth >= 0.2:
        return "airy" if steepness <= 0.2 else "none"
    if relative_depth > 0.1:
        return "stokes" if steepness >= 0.2 else "none"
    return "cnoidal or solitary" if 0.04 < relative_depth < 0.1 else "none"


GREATEST_URSELL_NUMBER = 8 * pi**2 / 3
"""Where Stokes' second order has a secondary crest over shallow water. [1]"""

_SECONDARY_CREST = 0.25

_NEGLIGIBLE = 0.05  # ratio of second to first harmonic that the linear theory may neglect

_LENGTH_TOLERANCE = 0.01  # of the given length relative to that from the period
_OTHER_LENGTH = 0.2  # the same; a higher wave, or one by another theory, is longer by less


@dataclass(frozen=True)
class WaveTheory:
    """Characteristics of one wave and the theory that it requires.

    Parameters
    ----------
    theory : {"airy", "stokes", "cnoidal", "beyond the table"}
        By relative depth, as [1]_ applies its Table 1.
    printed : {"airy", "stokes", "cnoidal or solitary", "none"}
        By both columns of Table 1, taken literally.
    wave_length : float
        As given, else by the dispersion relation, or by the stream function where requested. [m]
    relative_depth, steepness, height_to_depth : float
        d / L, H / L, H / d. [1]
    breaking_ratio : float
        Height over breaking height. [1]
    ursell_number : float
        H L^2 / d^3. [1]
    elevation_ratio, velocity_ratio : float
        Ratio of second to first harmonic in Stokes' theory, for the surface and for the horizontal
        velocity at the mean level. [1]
    length_mismatch : float
        Given length over that of the period, less one; 0 where none was given. [1]
    is_breaking : bool
        No theory applies, and none is computed.
    is_computed : bool
        Whether the table has a theory for it.
    is_beyond_stokes : bool
        Ursell number above 8 pi^2 / 3, or a secondary crest in the trough.
    is_second_order_small : bool
        Second harmonics below 5 % of the first.
    reasons : tuple of Note
        Objections to the theory; empty where there are none.
    """

    theory: WaveTheoryName
    printed: PrintedTheory
    wave_length: float
    relative_depth: float
    steepness: float
    height_to_depth: float
    breaking_ratio: float
    ursell_number: float
    elevation_ratio: float
    velocity_ratio: float
    length_mismatch: float
    is_breaking: bool
    is_computed: bool
    is_beyond_stokes: bool
    is_second_order_small: bool
    reasons: tuple[Note, ...]


def describe_wave(
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    wave_length: float | None = None,
    current_velocity: float = 0.0,
    gravity: float = STANDARD_GRAVITY,
    asked: WaveTheoryName | None = None,
) -> WaveTheory:
    """Theory, limits and doubts for one wave and the requested theory.

    Notes
    -----
    Limits of height: `reduction.prediction.wave_theory`.  Ursell number of [6]_, secondary crest
    after [5]_, ch. 11.  The limits for a small second harmonic (5 %) and for a length that matches
    its period (1 %) are set by this package.

    Examples
    --------
    The second example of [1]_ is at the edge of Stokes' second order.

    >>> wave = describe_wave(wave_height=1.25, wave_period=3.57, water_depth=3.0,
    ...                      wave_length=20.0)
    >>> print(wave.theory, round(wave.ursell_number, 1), round(wave.elevation_ratio, 2),
    ...       round(wave.velocity_ratio, 2), wave.is_beyond_stokes)
    stokes 18.5 0.3 0.26 True
    """
    for name, value in (("wave_height", wave_height), ("wave_period", wave_period)):
        as_positive(name, value)
    if wave_length is None and asked == "stream function":
        steady, depth = _stream_of(
            wave_height, wave_period, water_depth, None, current_velocity, gravity
        )
        number = steady.number / depth
        length, mismatch = 2 * pi / number, 0.0
    elif wave_length is None:
        number = float(
            _wave_number(
                wave_period, water_depth, current_velocity=current_velocity, gravity=gravity
            )
        )
        length, mismatch = 2 * pi / number, 0.0
    else:
        as_positive("wave_length", wave_length)
        length, number = wave_length, 2 * pi / wave_length
        by_period = _wave_number(
            wave_period, water_depth, current_velocity=current_velocity, gravity=gravity
        )
        mismatch = float(length / (2 * pi / by_period) - 1)
    relative_depth, steepness = water_depth / length, wave_height / length
    theory = _theory_by_depth(relative_depth)
    surface, velocity = _second_harmonics(number * wave_height, number * water_depth)
    breaking_ratio = wave_height / float(breaking_height(number, water_depth))
    ursell = wave_height * length**2 / water_depth**3
    is_beyond = ursell > GREATEST_URSELL_NUMBER or surface > _SECONDARY_CREST
    is_small = max(surface, velocity) < _NEGLIGIBLE
    doubts = {
        note("wave-breaks", ratio=breaking_ratio): breaking_ratio > 1,
        note("no-theory-at-depth", depth=relative_depth): (
            theory == "beyond the table" and asked != "stream function"
        ),
        note("second-harmonic", share=surface): (
            theory == "airy" and asked in (None, "airy") and not is_small
        ),
        note(
            "stokes-at-its-end", ursell=ursell, most=GREATEST_URSELL_NUMBER, share=surface,
            most_share=_SECONDARY_CREST,
        ): is_beyond and (asked or theory) in ("airy", "stokes"),
        note("wave-length-off", off=mismatch): (
            _LENGTH_TOLERANCE < abs(mismatch) <= _OTHER_LENGTH
        ),
        note(
            "wave-length-not-of-period", period=wave_period, own=length / (1 + mismatch),
            stated=length,
        ): abs(mismatch) > _OTHER_LENGTH,
    }  # fmt: skip
    return WaveTheory(
        theory=theory,
        printed=_printed_theory(relative_depth, steepness),
        wave_length=length,
        relative_depth=relative_depth,
        steepness=steepness,
        height_to_depth=wave_height / water_depth,
        breaking_ratio=breaking_ratio,
        ursell_number=ursell,
        elevation_ratio=surface,
        velocity_ratio=velocity,
        length_mismatch=mismatch,
        is_breaking=breaking_ratio > 1,
        is_computed=theory != "beyond the table",
        is_beyond_stokes=is_beyond,
        is_second_order_small=is_small,
        reasons=tuple(one for one, is_so in doubts.items() if is_so),
    )


def regular_wave(
    wave: WaveTheory,
    *,
    wave_height: float,
    wave_period: float,
    water_depth: float,
    elevation: float,
    wave_length: float | None = None,
    theory: WaveTheoryName | None = None,
    current_velocity: float = 0.0,
) -> WaveHarmonics:
    """Motion at one elevation by the applicable theory, or by the requested one.

    Notes
    -----
    Doubts in the description do not stop a prediction: they are passed on.  Without a given length,
    theories of higher order find their own, which grows with the height.

    Examples
    --------
    The second example of [1]_ has two harmonics.

    >>> sea = dict(wave_height=1.25, wave_period=3.57, water_depth=3.0)
    >>> regular_wave(describe_wave(**sea), **sea, elevation=0.0).elevation.size
    2
    """
    by = theory or wave.theory
    makers: dict[str, Callable[..., WaveHarmonics]] = {
        "airy": airy_wave,
        "stokes": stokes_wave,
        "stokes 3": partial(high_stokes_wave, order=3),
        "stokes 5": partial(high_stokes_wave, order=5),
        "cnoidal": cnoidal_wave,
        "stream function": stream_wave,
    }
    if by not in makers:
        raise DataError(
            f"the theory of this wave is not computed: {by}",
            found=f"a depth of {wave.relative_depth:.3f} wave lengths",
            needed="above 0.04, where Table 1 of Zhang (2015) ends",
            hint='Ask for one by name: wave_theory = "stream function" is for every depth.',
        )
    if by in ("airy", "stokes"):
        wave_length = wave.wave_length
    return makers[by](
        wave_height=wave_height,
        wave_period=wave_period,
        water_depth=water_depth,
        elevation=elevation,
        wave_number=None if wave_length is None else 2 * pi / wave_length,
        current_velocity=current_velocity,
    )


def _second_harmonics(height: float, depth: float) -> tuple[float, float]:
    """Second over first harmonic, from k H and k d, for surface and velocity at the mean level.

    kH/8 cosh kd (2 + cosh 2kd) / sinh^3 kd and 3 kH/8 cosh 2kd / (sinh^3 kd cosh kd).
    """
    if depth > 20:  # limit reached to 1e-17; cosh would overflow for greater depths
        return height / 4, 3 * height * exp(-2 * depth)
    sine, cosine, double = sinh(depth), cosh(depth), cosh(2 * depth)
    surface = height / 8 * cosine * (2 + double) / sine**3
    return surface, 3 * height / 8 * double / (sine**3 * cosine)


@dataclass(frozen=True)
@read_only_arrays
class _ParticleMotion:
    """Surface and water at one place over time; arrays have the shape (n_times,).

    Velocities [m s-1] and accelerations [m s-2] are those of the wave alone, without a current;
    the elevation [m] is that of the surface above the mean level.
    """

    elevation: Floats
    horizontal_velocity: Floats
    vertical_velocity: Floats
    horizontal_acceleration: Floats
    vertical_acceleration: Floats


def particle_motion(wave: WaveHarmonics, time: ArrayLike, position: float = 0.0) -> _ParticleMotion:
    """Surface and water at one place over time.

    Parameters
    ----------
    wave : WaveHarmonics
        From a theory or user-defined.
    time : array_like, shape (n_times,)
        Times. [s]
    position : float
        Along the wave; the crest is at 0 at time 0. [m]

    Returns
    -------
    motion : ParticleMotion
        Arrays of shape (n_times,).

    Raises
    ------
    DataError
        If a time is not finite.

    Notes
    -----
    Sums of the harmonics, without a current.

    Examples
    --------
    Under the crest the water moves forward; a quarter period later it falls fastest.

    >>> from reduction.prediction.wave_theory import airy_wave
    >>> wave = airy_wave(wave_height=1.25, wave_period=4.0, water_depth=6.0, elevation=0.0)
    >>> motion = particle_motion(wave, [0.0, 1.0])
    >>> print(motion.horizontal_velocity.round(3), motion.vertical_velocity.round(3))
    [1.06 0.  ] [ 0.    -0.982]
    """
    when = np.atleast_1d(as_finite("time", time))
    phase = wave.wave_number * position - wave.angular_frequency * when
    order = np.arange(1, wave.elevation.size + 1)
    cosines, sines = (part(np.multiply.outer(phase, order)) for part in (np.cos, np.sin))
    return _ParticleMotion(
        elevation=cosines @ wave.elevation,
        horizontal_velocity=cosines @ wave.horizontal_velocity,
        vertical_velocity=sines @ wave.vertical_velocity,
        horizontal_acceleration=sines @ wave.horizontal_acceleration,
        vertical_acceleration=cosines @ wave.vertical_acceleration,
    )

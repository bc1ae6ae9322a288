r"""Motion of the water under a regular wave: Airy's theory and Stokes' of second order.

With the phase :math:`\theta = k x - \omega t`, z upwards from the mean level, and
:math:`\sigma = \omega - k U`,

.. math::
   \eta = \tfrac{H}{2} \cos\theta
          + \tfrac{k H^2}{16} \frac{\cosh kd\,(2 + \cosh 2kd)}{\sinh^3 kd} \cos 2\theta

   u_x = \tfrac{\sigma H}{2} \frac{\cosh k(z+d)}{\sinh kd} \cos\theta
         + \tfrac{3 k \sigma H^2}{16} \frac{\cosh 2k(z+d)}{\sinh^4 kd} \cos 2\theta

   u_z = \tfrac{\sigma H}{2} \frac{\sinh k(z+d)}{\sinh kd} \sin\theta
         + \tfrac{3 k \sigma H^2}{16} \frac{\sinh 2k(z+d)}{\sinh^4 kd} \sin 2\theta

The first terms are Airy's.  Over still water sigma H/2 is pi H/T, eq. (16) and (17) of [1]_.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 13-17.
.. [2] R. G. Dean and R. A. Dalrymple, Water Wave Mechanics for Engineers and Scientists.
   Singapore: World Scientific, 1991, ch. 3, 4 and 11.
.. [3] D. H. Peregrine, "Interaction of water waves and currents," Adv. Appl. Mech., vol. 16,
   1976, pp. 9-117, sec. II.
"""

from __future__ import annotations

from math import exp, expm1, pi, tanh

import numpy as np

from reduction.checks import as_positive
from reduction.errors import DataError
from reduction.predict import dispersion
from reduction.predict.breaking import refuse_breaking
from reduction.predict.dispersion import STANDARD_GRAVITY
from reduction.predict.harmonics import WaveHarmonics


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

    Parameters
    ----------
    wave_height : float
        Trough to crest. [m]
    wave_period : float
        As a fixed point sees it. [s]
    water_depth : float
        Of the still water. [m]
    elevation : float
        Of the place above the mean level; of a floating hose, that of its centre. [m]
    wave_number : float, optional
        2 pi over a length given beside the period; None: by the dispersion relation. [rad m-1]
    current_velocity : float
        On which the wave rides, positive along it; changes its length and motion. [m s-1]
    gravity : float
        Acceleration of free fall; without use where the wave number is given. [m s-2]

    Returns
    -------
    wave : WaveHarmonics
        One harmonic.

    Raises
    ------
    DataError
        If a number is not positive, the place is in the bed or above the crest, the current
        stops or outruns the wave, or the wave is beyond breaking.

    Notes
    -----
    Eq. (13) and (15) of [1]_ print the velocity amplitude H g k / (2 omega) with cosh kd below,
    and the acceleration 2 pi^2 H / T^2 with sinh kd below.  One is the derivative of the other
    only where length and period fit.  Here velocities follow the surface (pi H/T over sinh kd)
    whatever the length, and accelerations are their derivative; see
    `reduction.predict.wavelength` for the mismatch.

    Over a current the motion is that in water that moves with it ([3]_), and so is the
    acceleration: that of a particle to first order.

    Between the mean level and the crest the motion is that of the formula carried on,
    which overstates it; the convective acceleration is left out, as in [1]_.

    Examples
    --------
    The wave of Table 4 of [1]_ 6 m deep, at the mean level: pi H/T = 1.1 m/s both ways but for
    coth kd.

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

    Parameters
    ----------
    wave_height : float
        Trough to crest. [m]
    wave_period : float
        As a fixed point sees it. [s]
    water_depth : float
        Of the still water. [m]
    elevation : float
        Of the place above the mean level; of a floating hose, that of its centre. [m]
    wave_number : float, optional
        2 pi over a length given beside the period; None: by the dispersion relation. [rad m-1]
    current_velocity : float
        On which the wave rides, positive along it; changes its length and motion. [m s-1]
    gravity : float
        Acceleration of free fall; without use where the wave number is given. [m s-2]

    Returns
    -------
    wave : WaveHarmonics
        Two harmonics.

    Raises
    ------
    DataError
        If a number is not positive, the place is in the bed or above the crest, the current
        stops or outruns the wave, or the wave is beyond breaking.

    Notes
    -----
    Eq. (16) and (17) of [1]_, which are right as printed; the elevation, which it does not
    print, from [2]_.  Second order has the dispersion relation of first order: the gain in
    speed with height is of third order.

    Not flagged here: a secondary crest in the trough where the second harmonic of the surface
    is above a quarter of the first; see `reduction.predict.wavetheory`.

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
    flat = -expm1(-2 * depth)  # 2 exp(-kd) sinh kd: nothing overflows on deep water
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
        number = float(
            dispersion.wave_number(period, depth, current_velocity=current, gravity=gravity)
        )
    as_positive("wave_number", number)
    intrinsic = float(2 * pi / as_positive("wave_period", period)) - number * current
    if intrinsic <= 0:
        raise DataError(
            "the current is faster than the wave",
            found=f"a current of {current:g} m/s, a wave of {2 * pi / (period * number):.4g} m/s",
            needed="a wave that goes forward through the water",
        )
    refuse_breaking(wave_height=height, wave_number=number, water_depth=depth)
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
    horizontal = np.asarray(speed) * (1 + fading)
    vertical = np.asarray(speed) * (1 - fading)
    return WaveHarmonics(
        wave_number=number,
        angular_frequency=frequency,
        elevation=np.asarray(surface),
        horizontal_velocity=horizontal,
        vertical_velocity=vertical,
        horizontal_acceleration=order * intrinsic * horizontal,
        vertical_acceleration=-order * intrinsic * vertical,
    )

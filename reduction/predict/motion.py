"""Motion of the water at one place over time, from the harmonics of a wave.

References
----------
.. [1] R. G. Dean and R. A. Dalrymple, Water Wave Mechanics for Engineers and Scientists.
   Singapore: World Scientific, 1991, ch. 3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.predict.harmonics import WaveHarmonics
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class ParticleMotion:
    """Surface and water at one place over time; arrays have the shape (n_times,).

    Velocities [m s-1] and accelerations [m s-2] are of the wave alone, without a current;
    the elevation [m] is of the surface above the mean level.
    """

    elevation: Floats
    horizontal_velocity: Floats
    vertical_velocity: Floats
    horizontal_acceleration: Floats
    vertical_acceleration: Floats


def particle_motion(wave: WaveHarmonics, time: ArrayLike, position: float = 0.0) -> ParticleMotion:
    """Surface and water at one place over time.

    Parameters
    ----------
    wave : WaveHarmonics
        From a theory or by hand.
    time : array_like, shape (n_times,)
        When. [s]
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
    Sums of the harmonics; a current is not in them.

    Examples
    --------
    Under the crest the water goes forward and falls fastest a quarter period later.

    >>> from reduction.predict.waves import airy_wave
    >>> wave = airy_wave(wave_height=1.25, wave_period=4.0, water_depth=6.0, elevation=0.0)
    >>> motion = particle_motion(wave, [0.0, 1.0])
    >>> print(motion.horizontal_velocity.round(3), motion.vertical_velocity.round(3))
    [1.06 0.  ] [ 0.    -0.982]
    """
    when = np.atleast_1d(as_finite("time", time))
    phase = wave.wave_number * position - wave.angular_frequency * when
    order = np.arange(1, wave.elevation.size + 1)
    cosines, sines = (part(np.multiply.outer(phase, order)) for part in (np.cos, np.sin))
    return ParticleMotion(
        elevation=cosines @ wave.elevation,
        horizontal_velocity=cosines @ wave.horizontal_velocity,
        vertical_velocity=sines @ wave.vertical_velocity,
        horizontal_acceleration=sines @ wave.horizontal_acceleration,
        vertical_acceleration=cosines @ wave.vertical_acceleration,
    )

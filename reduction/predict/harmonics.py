"""A regular wave at one depth below the surface, as amplitudes of harmonics of its phase.

References
----------
.. [1] S. Zhang, C. Chen, Q. Zhang, D. Zhang and F. Zhang, "Wave Loads Computation for Offshore
   Floating Hose Based on Partially Immersed Cylinder Model of Improved Morison Formula," Open
   Petroleum Eng. J., vol. 8, 2015, eq. 13-17.
"""

from __future__ import annotations

from dataclasses import dataclass

from reduction.errors import DataError
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class WaveHarmonics:
    """Amplitudes of the first harmonic and those above it.

    With the phase k x - omega t, harmonic n of the elevation, the horizontal velocity and the
    vertical acceleration goes with cos n(phase); that of the vertical velocity and the
    horizontal acceleration with sin n(phase).  Velocities and accelerations may come from
    different theories: a load does not know them.

    Parameters
    ----------
    wave_number : float
        k. [rad m-1]
    angular_frequency : float
        omega. [rad s-1]
    elevation : ndarray, shape (n_harmonics,)
        Of the surface. [m]
    horizontal_velocity, vertical_velocity : ndarray, shape (n_harmonics,)
        Of a particle. [m s-1]
    horizontal_acceleration, vertical_acceleration : ndarray, shape (n_harmonics,)
        Of a particle, local; the vertical one is negative in a progressive wave. [m s-2]
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

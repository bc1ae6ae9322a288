"""Load on one cord against its strain, through the measured points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.errors import SettingsError
from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class CordCurve:
    """Measured points of a cord, the last one its break.

    Parameters
    ----------
    strain : ndarray, shape (n_points,)
        From 0, strictly rising. [1]
    load : ndarray, shape (n_points,)
        From 0, strictly rising. [N]
    """

    strain: Floats
    load: Floats

    def __post_init__(self) -> None:
        """Check that the curve begins at zero and rises, and make the arrays read-only."""
        if self.strain.ndim != 1 or self.strain.shape != self.load.shape or self.strain.size < 2:
            raise SettingsError(
                "the points of the cord curve do not pair up",
                found=f"{self.strain.size} strains, {self.load.size} loads",
                needed="as many loads as strains, two or more",
            )
        for name, values in (("strain", self.strain), ("load", self.load)):
            if not np.all(np.isfinite(values)):
                raise SettingsError(f"cord.{name} is not finite", needed="numbers")
            if values[0] != 0:
                raise SettingsError(
                    f"cord.{name} does not begin at zero", found=f"{values[0]:g} in SI", needed="0"
                )
            if not np.all(np.diff(values) > 0):
                place = int(np.flatnonzero(np.diff(values) <= 0)[0])
                raise SettingsError(
                    f"cord.{name} does not rise at point {place + 2}",
                    found=f"{values[place + 1]:g} after {values[place]:g} in SI",
                    needed="a strictly rising curve up to the break",
                )

    @property
    def break_strain(self) -> float:
        """Of the last point. [1]."""
        return float(self.strain[-1])

    @property
    def break_load(self) -> float:
        """Of the last point. [N]."""
        return float(self.load[-1])

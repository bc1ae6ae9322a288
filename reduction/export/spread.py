"""Uncertainty of the tension of an exported curve: its own part, and what it shares with others."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.errors import DataError
from reduction.record import Floats, read_only_arrays
from reduction.uncertainty.product import Component


@dataclass(frozen=True)
@read_only_arrays
class CurveSpread:
    """Standard uncertainties of the tensions of a curve, NaN where they are not known.

    Parameters
    ----------
    standard : ndarray, shape (n_points,)
        Both parts. [N]
    random : ndarray, shape (n_points,), optional
        Of the curve by itself; None where the parts are not kept apart. [N]
    component : tuple of Component, length n_components
        Errors that the curve shares with others.
    contribution : ndarray, shape (n_components, n_points)
        What each of them adds to the tension, signed. [N]
    """

    standard: Floats
    random: Floats | None = None
    component: tuple[Component, ...] = ()
    contribution: Floats = field(default_factory=lambda: np.empty((0, 0)))

    def __post_init__(self) -> None:
        """Check that all is of the same points, and make the arrays read-only."""
        n_points = self.standard.size
        of_random = n_points if self.random is None else self.random.size
        rows = (len(self.component), n_points)
        if of_random != n_points or (self.component and self.contribution.shape != rows):
            raise DataError(
                "parts of the uncertainty of a curve are not of the same points",
                found=f"{n_points} uncertainties, {of_random} random ones, contributions of shape "
                f"{self.contribution.shape} to {len(self.component)} errors",
            )

    @property
    def shared(self) -> Floats:
        """Of what is shared, all errors together. [N]."""
        if not self.component:
            return np.where(np.isnan(self.standard), np.nan, 0.0)
        return np.asarray(np.sqrt(np.sum(self.contribution**2, axis=0)))

    def at(self, wanted: Floats, strain: Floats) -> CurveSpread:
        """The same at other strains of the curve.

        Parameters
        ----------
        wanted : ndarray, shape (n,)
            [1]
        strain : ndarray, shape (n_points,)
            Of the curve, rising. [1]

        Returns
        -------
        spread : CurveSpread
            Straight lines between the points; NaN beyond them, where nothing was read.

        Raises
        ------
        ValueError
            If the strains are not as many as the points.

        Examples
        --------
        >>> both = CurveSpread(np.array([1.0, 3.0]))
        >>> both.at(np.array([0.0, 0.2, 0.3]), np.array([0.1, 0.3])).standard
        array([nan,  2.,  3.])
        """

        def read(values: Floats) -> Floats:
            return np.interp(wanted, strain, values, left=np.nan, right=np.nan)

        rows = np.array([read(row) for row in self.contribution]).reshape(-1, wanted.size)
        return CurveSpread(
            read(self.standard),
            None if self.random is None else read(self.random),
            self.component,
            rows if self.component else np.empty((0, wanted.size)),
        )

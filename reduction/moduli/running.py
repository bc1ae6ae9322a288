"""Mean, scatter and envelope over curves that come in blocks.

References
----------
.. [1] T. F. Chan, G. H. Golub and R. J. LeVeque, "Algorithms for computing the
   sample variance," Amer. Statistician, vol. 37, no. 3, 1983.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reduction.record import Floats, read_only_arrays


@dataclass(frozen=True)
@read_only_arrays
class RunningStatistics:
    """Statistics over the curves seen so far, NaN left out; arrays of one shape.

    Parameters
    ----------
    count : ndarray
        Values in the mean, weighted: a curve pooled from m cycles counts m. [1]
    n_curves : ndarray
        Curves in the mean. [1]
    mean, squares, minimum, maximum : ndarray
        Mean, sum of squared deviations from it, least and greatest. [SI]
    variance : ndarray
        Sum of the variances that came with the values. [SI]
    """

    count: Floats
    n_curves: Floats
    mean: Floats
    squares: Floats
    minimum: Floats
    maximum: Floats
    variance: Floats

    @classmethod
    def of(cls, values: Floats, variance: Floats, *, weight: Floats) -> RunningStatistics:
        """Statistics over the first axis; ``weight`` (n_curves,) is the cycles in each curve."""
        known = np.isfinite(values)
        n_curves = known.sum(axis=0).astype(np.float64)
        mean = np.where(known, values, 0.0).sum(axis=0) / np.maximum(n_curves, 1)
        step = np.where(known, values - mean, 0.0)
        step *= step
        return cls(
            count=np.where(known, weight.reshape(-1, *[1] * (values.ndim - 1)), 0.0).sum(axis=0),
            n_curves=n_curves,
            mean=mean,
            squares=step.sum(axis=0),
            minimum=np.where(known, values, np.inf).min(axis=0, initial=np.inf),
            maximum=np.where(known, values, -np.inf).max(axis=0, initial=-np.inf),
            variance=np.where(known, variance, 0.0).sum(axis=0),
        )

    def __add__(self, other: RunningStatistics) -> RunningStatistics:
        """Statistics over both blocks ([1]_, eq. 2.1)."""
        n_curves = self.n_curves + other.n_curves
        share = other.n_curves / np.maximum(n_curves, 1)
        step = other.mean - self.mean
        return RunningStatistics(
            count=self.count + other.count,
            n_curves=n_curves,
            mean=self.mean + step * share,
            squares=self.squares + other.squares + step**2 * self.n_curves * share,
            minimum=np.minimum(self.minimum, other.minimum),
            maximum=np.maximum(self.maximum, other.maximum),
            variance=self.variance + other.variance,
        )

    def value(self) -> Floats:
        """Mean; NaN where nothing was seen."""
        return np.where(self.n_curves > 0, self.mean, np.nan)

    def scatter(self) -> Floats:
        """Standard deviation; NaN below two curves."""
        freedom = np.where(self.n_curves > 1, self.n_curves - 1, np.nan)
        return np.sqrt(self.squares / freedom)

    def standard_uncertainty(self) -> Floats:
        """Type A of the mean: from the scatter, or of the one curve from its regression."""
        many = self.scatter() / np.sqrt(np.maximum(self.n_curves, 1))
        return np.where(self.n_curves == 1, np.sqrt(self.variance), many)

    def lowest(self) -> Floats:
        """Minimum; NaN where nothing was seen."""
        return np.where(self.n_curves > 0, self.minimum, np.nan)

    def highest(self) -> Floats:
        """Maximum; NaN where nothing was seen."""
        return np.where(self.n_curves > 0, self.maximum, np.nan)

"""A step of an evenly sampled series, and the size of known steps in another series.

References
----------
.. [1] M. Basseville and I. V. Nikiforov, "Detection of Abrupt Changes: Theory and
   Application," Prentice-Hall, 1993, sec. 2.4 (size of a change at a known time).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from reduction.checks import as_finite
from reduction.moduli.stepscan import ramp_of, without_background, without_parabola
from reduction.record import Floats


@dataclass(frozen=True)
class Step:
    """One step of a series.

    Parameters
    ----------
    onset : int
        Index of the first sample that has changed.
    extent : int
        Samples over which the step develops; 1 for an abrupt one. [1]
    onset_low, onset_high : int
        95 % range of the onset.
    end_high : int
        Latest sample, at 95 %, at which the step is still developing.
    size : float
        Change of level. [unit of the series]
    size_standard_uncertainty : float
        Of the size. [unit of the series]
    score : float
        Size over its standard deviation where no step is. [1]
    """

    onset: int
    extent: int
    onset_low: int
    onset_high: int
    end_high: int
    size: float
    size_standard_uncertainty: float
    score: float

    @property
    def end(self) -> int:
        """Index of the last sample in which the step still develops."""
        return self.onset + self.extent - 1


def step_sizes(values: ArrayLike, steps: tuple[Step, ...]) -> tuple[Floats, Floats]:
    """Size of known steps in another series of the same length.

    Parameters
    ----------
    values : array_like, shape (n_samples,)
        The other series, for example peak tension where the steps were found in the
        level of whole branches. [any unit]
    steps : tuple of Step
        Onsets and extents. [1]

    Returns
    -------
    size : ndarray, shape (n_steps,)
        Least squares with a parabola and every step nearby, over 64 samples (or twice
        the extent) on each side, the background of the whole series taken out first.
        [unit of the series]
    size_standard_uncertainty : ndarray, shape (n_steps,)
        From the residuals, and from the share by which the shape of the step is uncertain.
        [unit of the series]

    Raises
    ------
    DataError
        If a value is not finite.

    Examples
    --------
    >>> step = Step(50, 1, 50, 50, 50, 1.0, 0.0, 0.0)
    >>> size, _ = step_sizes(3.0 * (np.arange(100) >= 50), (step,))
    >>> print(size.round(6))
    [3.]
    """
    series = as_finite("values", values)
    sizes = np.full((2, len(steps)), np.nan)
    if steps:
        series = without_background(
            series,
            ramp_of(
                series.size,
                onset=[step.onset for step in steps],
                extent=[step.extent for step in steps],
            ),
        )
    for index, step in enumerate(steps):
        reach = max(64, 2 * step.extent)
        first, last = max(0, step.onset - reach), min(series.size, step.onset + step.extent + reach)
        ramps = [
            ramp_of(series.size, onset=other.onset, extent=other.extent)[first:last]
            for other in (step, *(other for other in steps if other is not step))
        ]
        columns = np.stack([row for row in ramps if np.ptp(row) > 0])
        basis = without_parabola(columns)
        local = without_parabola(series[first:last])
        # einsum, not matrix products: their last digits depend on the number of threads
        gram = np.linalg.pinv(np.einsum("ij,kj->ik", basis, basis))
        found = gram @ np.einsum("ij,j->i", basis, local)
        residual = local - np.einsum("i,ij->j", found, basis)
        variance = float((residual**2).sum()) / max(1, local.size - 3 - found.size)
        share = step.size_standard_uncertainty / abs(step.size)
        sizes[:, index] = found[0], np.hypot(np.sqrt(variance * gram[0, 0]), share * found[0])
    return sizes[0], sizes[1]

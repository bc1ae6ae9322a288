"""What the line stage returns.

References
----------
.. [1] CG-D-39-80, Table 2 (rated break strengths).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np
from numpy import int8
from numpy.typing import ArrayLike, NDArray

from reduction.record.errors import DataError
from reduction.record.measurement import Floats, read_only_arrays
from reduction.record.notes import Note

LINE_PARAMETERS = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
"""Numbers of the line that need K_0 of a slow pull."""

REASONS: dict[int, str] = {
    0: "",
    1: "the quasi-static spring constant at this mean tension is not known",
    2: "the quasi-static spring constant is not positive",
    3: "a value of the loop, such as K_ap or H, is missing",
    4: "a value of the loop, such as K_ap or H, is not positive",
    5: "the loop is too wide: the loss spring constant reaches the apparent one",
    6: "the storage spring constant does not exceed the quasi-static one",
}
"""Why a line has no K_1 and tau; the first that applies, in the order 3, 4, 5, 1, 2, 6."""


@dataclass(frozen=True)
@read_only_arrays
class LineParameters:
    """Parameters of the line; all arrays have one shape, (n_specimens, n_cycles) for loops.

    A number that the loop does not support is NaN, and ``reason`` says why.  ``storage`` and
    ``loss`` are given wherever the loop alone yields them, with or without K_0.

    Parameters
    ----------
    quasi_static_spring_constant : ndarray
        The value used. [N]
    storage_spring_constant, loss_spring_constant : ndarray
        The values used: from K_ap and H, or from the fundamental (``reading``). [N]
    loss_angle : ndarray
        Angle by which tension leads strain. [rad]
    dissipation_spring_constant : ndarray
        K_1. [N]
    relaxation_time : ndarray
        tau. [s]
    dashpot_coefficient : ndarray
        K_1 tau. [N s]
    angular_frequency : ndarray
        2 pi f. [rad s-1]
    angular_frequency_relaxation_time : ndarray
        omega tau; at 1 the loop is widest for a given strain amplitude. [1]
    conditioning : ndarray
        K_0 over (E' - K_0): the factor by which a relative error of K_0 enters E' - K_0. [1]
    reason : ndarray of int8
        0 where the parameters are given, else a key of `REASONS`.
    random_uncertainty, shared_uncertainty, uncertainty : dict of str to ndarray
        Standard uncertainties by field name, same shape and unit, of
        storage_spring_constant, loss_spring_constant, dissipation_spring_constant,
        relaxation_time and dashpot_coefficient: from the loop, reduced by a mean over
        cycles; from K_0, which all cycles of a test share and no mean reduces; and both together.
        NaN where an uncertainty that enters is not stated.
    reading : str
        ``amplitude`` or ``fundamental``.
    notes : tuple of Note
        What a reader of the numbers needs to know.
    """

    quasi_static_spring_constant: Floats
    storage_spring_constant: Floats
    loss_spring_constant: Floats
    loss_angle: Floats
    dissipation_spring_constant: Floats
    relaxation_time: Floats
    dashpot_coefficient: Floats
    angular_frequency: Floats
    angular_frequency_relaxation_time: Floats
    conditioning: Floats
    reason: NDArray[int8]
    random_uncertainty: dict[str, Floats]
    shared_uncertainty: dict[str, Floats]
    uncertainty: dict[str, Floats]
    reading: str = "amplitude"
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class SlowPull:
    """Load-strain curve of one specimen: strain as a cubic of tension, and the local slope.

    Parameters
    ----------
    specimen : str
        Which specimen.
    tension_centre, tension_half_range : float
        The fit is in u = (T - centre)/half range, which runs from -1 to 1. [N]
    coefficient : ndarray, shape (4,)
        Of 1, u, u^2, u^3. [1]
    covariance : ndarray, shape (4, 4)
        Of the coefficients, from the residuals and the correlation between neighbours
        (type A); load cell and gauge length are not included. [1]
    strain_misfit : float
        Root mean square of what the cubic misses of the strain, from a polynomial of sixth degree;
        0 where noise explains it. [1]
    curve_coefficient : ndarray, shape (n_pieces + 3,)
        Of the cubic B-splines over -1 to 1 on equal knots, giving strain; its slope is 1/K_0. [1]
    curve_covariance : ndarray, shape (n_pieces + 3, n_pieces + 3)
        Of these coefficients, obtained like ``covariance``. [1]
    curve_misfit : ndarray, shape (81,)
        What the curve misses of the strain at u from -1 to 1. [1]
    slope_misfit : ndarray, shape (81,)
        What the curve misses of its slope in u, from -1 to 1. [1]
    tension_low, tension_high : float
        Range of use: where there are readings and the slope is positive. [N]
    residual_deviation : float
        Standard deviation of the block means about the cubic. [1]
    n_samples, n_blocks : int
        Readings of the loading part, and number of means over equal steps of tension that were
        fitted.
    strain_rate, strain_rate_slowest, strain_rate_fastest : float
        Mean over the loading part, and over the slowest and fastest quarter of its tension
        range; K_0 grows with the rate. [s-1]
    tension_rate : float
        Mean over the loading part. [N s-1]
    waiting_time : float
        Time since the last dynamic test, on which K_0 depends; NaN where not given. [s]
    waiting : str
        The same in the laboratory's words.
    reference_length : float
        Length at which strain is zero; NaN where not stated. [m]
    reference_tension : float
        Tension at which it was read; NaN where not stated. [N]
    polynomial_coefficient : ndarray, shape (4,)
        K_0 as A + B T + C T^2 + D T^3, for those who need the printed form. [N N-k]
    notes : tuple of Note
        What a reader of the numbers needs to know.
    """

    specimen: str
    tension_centre: float
    tension_half_range: float
    coefficient: Floats
    covariance: Floats
    strain_misfit: float
    curve_coefficient: Floats
    curve_covariance: Floats
    curve_misfit: Floats
    slope_misfit: Floats
    tension_low: float
    tension_high: float
    residual_deviation: float
    n_samples: int
    n_blocks: int
    strain_rate: float
    strain_rate_slowest: float
    strain_rate_fastest: float
    tension_rate: float
    waiting_time: float
    waiting: str
    reference_length: float
    reference_tension: float
    polynomial_coefficient: Floats
    notes: tuple[Note, ...] = ()

    @property
    def strain_coefficient(self) -> Floats:
        """A, B, C, D of strain = A + B T + C T^2 + D T^3, shape (4,). [N-k]."""
        printed: Floats = self._to_printed() @ self.coefficient
        return printed

    @property
    def strain_coefficient_covariance(self) -> Floats:
        """Covariance of A, B, C and D, shape (4, 4). [N-k]."""
        turn = self._to_printed()
        printed: Floats = turn @ self.covariance @ turn.T
        return printed

    @property
    def misfit_share(self) -> float:
        """``strain_misfit`` over the strain that the cubic gains along the pull. [1]."""
        return self.strain_misfit / (2 * float(self.coefficient[1] + self.coefficient[3]))

    def _to_printed(self) -> Floats:
        """Matrix from coefficients of u to those of T."""
        turn = np.zeros((4, 4))
        for power in range(4):
            for part in range(power + 1):
                shift = (-self.tension_centre) ** (power - part)
                turn[part, power] = comb(power, part) * shift / self.tension_half_range**power
        return turn


def one_a_specimen(rated_break_strength: ArrayLike, n_specimens: int) -> Floats:
    """Rated break strength of each specimen.

    Parameters
    ----------
    rated_break_strength : array_like, shape () or (n_specimens,)
        NaN where not stated. [N]
    n_specimens : int
        Number of specimens. [1]

    Returns
    -------
    strength : ndarray, shape (n_specimens,)
        One value for each specimen. [N]

    Raises
    ------
    DataError
        If a strength is not positive or their number does not match.

    Examples
    --------
    >>> one_a_specimen(28470.0, 2)
    array([28470., 28470.])
    """
    strength = np.asarray(rated_break_strength, dtype=np.float64)
    if strength.shape not in ((), (n_specimens,)) or (strength <= 0).any():
        raise DataError(
            "the rated break strength does not fit the specimens",
            found=f"{strength.tolist()}",
            needed=f"{n_specimens} positive numbers, NaN where not stated",
        )
    return np.broadcast_to(strength, (n_specimens,))


def mean_of_rows(values: Floats) -> Floats:
    """Mean of the known values over the last axis.

    Examples
    --------
    >>> print(mean_of_rows(np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan]])))
    [ 2. nan]
    """
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        mean: Floats = np.where(known, values, 0.0).sum(axis=-1) / known.sum(axis=-1)
    return mean

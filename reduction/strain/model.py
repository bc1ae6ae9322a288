"""What a strain method found for one specimen: coefficients, residuals, range."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.record import Floats, read_only_arrays
from reduction.settings import StrainMethod


def _empty() -> Floats:
    return np.empty(0)


@dataclass(frozen=True)
@read_only_arrays
class StrainModel:
    """How crosshead position becomes strain of one specimen in one test.

    Parameters
    ----------
    specimen : str
        Name of the specimen.
    method : StrainMethod
        Which of the six methods.
    coefficients : dict of str to float
        By full name, SI; what `strain_by_model` needs. For
        ``tension-driven``: ``relaxed_free_length`` [m], ``relaxed_splice_length``
        [m], ``splice_compliance`` c [N**-n] and ``splice_exponent`` n [1].
    covariance : ndarray, shape (n_coefficients, n_coefficients)
        Of the coefficients in the order of the dict; zeros where exact. [SI]
    position_low, position_high : float
        Marked range of position; outside it the strain is extrapolated. [m]
    tension_low, tension_high : float
        Tension range of the marks; NaN where the method does not use it. [N]
    marks_from : str
        ``this test``, ``pooled over the campaign`` or ``none``.
    mark_test, mark_hold : tuple of str, length n_marks
        Marks of this specimen that were used.
    mark_position, mark_strain, mark_tension, mark_strain_residual : ndarray, shape (n_marks,)
        Far thimble [m], strain at the marks [1], tension while they were read
        [N], strain by the method minus strain at the marks [1].
    mark_load_cell : tuple of str, length n_marks or 0
        Of which load cell the tension at each mark is; where it is empty, that of the test.
    strain_slope_ratio : float
        d(strain)/d(position) by ``constant-fraction`` over that of this method,
        mean over the test's own marked range: a modulus by ``constant-fraction``
        is the inverse of this times the modulus here. NaN without marks. [1]
    notes : tuple of str
        What a reader has to know.
    is_zero_logged : bool
        True where the position of zero strain was read from the log of the test, so that a wrong
        zero of the crosshead is in it as well.
    splice_law : dict of str to float
        Of a method that knows position alone: the coefficients of ``tension-driven`` fitted to
        the same marks, by which its error is judged; empty where there is no such law.
    """

    specimen: str
    method: StrainMethod
    coefficients: dict[str, float] = field(default_factory=dict)
    covariance: Floats = field(default_factory=lambda: np.empty((0, 0)))
    position_low: float = float("nan")
    position_high: float = float("nan")
    tension_low: float = float("nan")
    tension_high: float = float("nan")
    marks_from: str = "none"
    mark_test: tuple[str, ...] = ()
    mark_hold: tuple[str, ...] = ()
    mark_position: Floats = field(default_factory=_empty)
    mark_strain: Floats = field(default_factory=_empty)
    mark_tension: Floats = field(default_factory=_empty)
    mark_strain_residual: Floats = field(default_factory=_empty)
    mark_load_cell: tuple[str, ...] = ()
    strain_slope_ratio: float = float("nan")
    notes: tuple[str, ...] = ()
    is_zero_logged: bool = False
    splice_law: dict[str, float] = field(default_factory=dict)

    @property
    def relaxed_length(self) -> float:
        """Length that stretches, at zero strain; NaN where the method knows none. [m]."""
        known = self.coefficients
        return known.get("relaxed_free_length", known.get("gauge_length", float("nan")))

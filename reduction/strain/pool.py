"""Marks of one specimen pooled over a campaign, and each strain method fitted to them.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from reduction.errors import DataError
from reduction.record import Bools, Floats, Integers, SpliceMarks
from reduction.settings import StrainMethod
from reduction.strain.calibration import (
    Calibration,
    fit_free_length_line,
    fit_splice_ratio,
    line_slope,
)
from reduction.strain.evaluate import strain_by_model
from reduction.strain.law import HELD_EXPONENT, fit_splice_law
from reduction.strain.model import StrainModel
from reduction.strain.relaxed import RelaxedLengths, relaxed_lengths
from reduction.strain.splice import free_length_fraction

TENSION_SPAN = 2.0
"""Marks must span this factor in tension before an exponent is fitted to them. [1]"""
# an exponent less certain than this says nothing that a straight line does not
_EXPONENT_UNCERTAINTY = 0.25


@dataclass(frozen=True)
class PooledMarks:
    """Marks of one specimen over a campaign, as one test sees them.

    Parameters
    ----------
    marks : SpliceMarks
        All rows.
    tension : ndarray, shape (n_marks,)
        While each row was read; NaN where not known. [N]
    is_own : ndarray of bool, shape (n_marks,)
        Rows read in the test itself.
    """

    marks: SpliceMarks
    tension: Floats
    is_own: Bools

    @property
    def has_own(self) -> bool:
        """Whether the test has stretched rows of its own."""
        return bool(np.any(self.is_own & ~self.marks.is_slack))

    def stretched_rows(self, method: StrainMethod) -> Integers:
        """Rows that fix the coefficients of a method.

        ``tension-driven``: all whose tension is known, since splices are the same in
        every test; otherwise those of the test, or all where it has none.
        """
        stretched = ~self.marks.is_slack
        if method == "tension-driven":
            return np.flatnonzero(stretched & (np.nan_to_num(self.tension) > 0))
        return np.flatnonzero(stretched & (self.is_own if self.has_own else np.True_))

    @property
    def tension_span(self) -> float:
        """Greatest over least tension of the stretched rows; 1 where none is known. [1]."""
        force = self.tension[self.stretched_rows("tension-driven")]
        return float(force.max() / force.min()) if force.size else 1.0

    def relaxed(self) -> RelaxedLengths:
        """Relaxed free and splice length and their covariance. [m], [m2]."""
        slack = self.marks.is_slack
        return relaxed_lengths(
            self.marks.free_length[slack],
            self.marks.splice_length[slack],
            reading_uncertainty=self.marks.reading_uncertainty,
        )


def _with_relaxed(
    names: tuple[str, ...], relaxed: RelaxedLengths, fit: Calibration
) -> tuple[dict[str, float], Floats]:
    """Coefficients and joint covariance of relaxed lengths and fitted values."""
    both = np.zeros((2 + fit.values.size,) * 2)
    both[:2, :2] = relaxed.covariance
    both[2:, 2:] = fit.covariance
    spread = np.eye(both.shape[0])
    spread[2:, :2] = fit.relaxed_sensitivity
    values = [*relaxed.values.tolist(), *fit.values.tolist()]
    keys = ("relaxed_free_length", "relaxed_splice_length", *names)
    return dict(zip(keys, values, strict=True)), spread @ both @ spread.T


def _scatter_notes(
    marks: SpliceMarks, relaxed: RelaxedLengths, fit: Calibration
) -> tuple[str, ...]:
    """What the marks do that the tape does not explain."""
    told = {"slack rows": relaxed.note, "stretched marks": fit.note}
    return tuple(f"{marks.specimen}: the {rows} {note}" for rows, note in told.items() if note)


def _fit_marks(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("marks")
    line = fit_free_length_line(
        marks.free_length[rows],
        marks.far_thimble[rows],
        reading_uncertainty=marks.reading_uncertainty,
    )
    relaxed = readings.relaxed()
    coefficients, covariance = _with_relaxed(
        ("free_length_intercept", "free_length_slope"), relaxed, line
    )
    # the line knows no splice length
    del coefficients["relaxed_splice_length"]
    keep = [0, 2, 3]
    return StrainModel(
        marks.specimen, "marks", coefficients, covariance[np.ix_(keep, keep)],
        notes=_scatter_notes(marks, relaxed, line),
    )  # fmt: skip


def _fit_strain_ratio(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("strain-ratio")
    relaxed = readings.relaxed()
    ratio = fit_splice_ratio(
        marks.free_length[rows],
        marks.splice_length[rows],
        relaxed_free_length=float(relaxed.values[0]),
        relaxed_splice_length=float(relaxed.values[1]),
        reading_uncertainty=marks.reading_uncertainty,
        relaxed_covariance=relaxed.covariance,
    )
    return StrainModel(
        marks.specimen,
        "strain-ratio",
        *_with_relaxed(("splice_strain_ratio",), relaxed, ratio),
        notes=_scatter_notes(marks, relaxed, ratio),
    )


def _fit_constant_fraction(readings: PooledMarks) -> StrainModel:
    """As the report: the test's own slack row, the mean share of its stretched rows."""
    marks, rows = readings.marks, readings.stretched_rows("constant-fraction")
    slack = marks.is_slack & readings.is_own
    relaxed = (
        marks.free_length[slack].mean() if slack.any() else float(readings.relaxed().values[0])
    )
    n_slack = max(int(slack.sum()), 1)
    length = marks.far_thimble[rows]
    share = marks.free_length[rows] / length
    # both toes, and the far thimble in the denominator
    variance = marks.reading_uncertainty**2 * np.array(
        [np.sum((2 + share**2) / length**2) / rows.size**2, 2 / n_slack]
    )
    coefficients = {
        "free_fraction": free_length_fraction(marks.free_length[rows], length),
        "relaxed_free_length": float(relaxed),
    }
    return StrainModel(marks.specimen, "constant-fraction", coefficients, np.diag(variance))


def _fit_tension_driven(readings: PooledMarks) -> StrainModel:
    marks, rows = readings.marks, readings.stretched_rows("tension-driven")
    relaxed = readings.relaxed()

    def law(exponent: float | None) -> Calibration:
        return fit_splice_law(
            marks.splice_length[rows],
            readings.tension[rows],
            relaxed_splice_length=float(relaxed.values[1]),
            reading_uncertainty=marks.reading_uncertainty,
            exponent=exponent,
            relaxed_standard_uncertainty=float(np.sqrt(relaxed.covariance[1, 1])),
        )

    notes: tuple[str, ...] = ()
    wide = readings.tension_span > TENSION_SPAN and rows.size > 2
    fit = law(None) if wide else law(HELD_EXPONENT)
    if not wide:
        notes = (
            f"{marks.specimen}: {rows.size} marks over a factor of {readings.tension_span:.2f} in "
            "tension do not fix the exponent of the splice law; it is held at 1",
        )
    elif (uncertainty := float(np.sqrt(fit.covariance[1, 1]))) > _EXPONENT_UNCERTAINTY:
        notes = (
            f"{marks.specimen}: the marks fix the exponent of the splice law only to "
            f"{fit.values[1]:.2f} +- {uncertainty:.2f}; it is held at 1",
        )
        fit = law(HELD_EXPONENT)
    coefficients, covariance = _with_relaxed(("splice_compliance", "splice_exponent"), relaxed, fit)
    notes += _scatter_notes(marks, relaxed, fit)
    return StrainModel(marks.specimen, "tension-driven", coefficients, covariance, notes=notes)


_FROM_MARKS: dict[StrainMethod, Callable[[PooledMarks], StrainModel]] = {
    "marks": _fit_marks,
    "strain-ratio": _fit_strain_ratio,
    "tension-driven": _fit_tension_driven,
    "constant-fraction": _fit_constant_fraction,
}


def _slope_ratio(model: StrainModel, readings: PooledMarks) -> float:
    """Strain slope of constant-fraction over that of the model, over the test's own marks."""
    usable = readings.stretched_rows(model.method)
    own = usable[readings.is_own[usable]]
    rows = own if own.size > 1 else usable
    position = readings.marks.far_thimble[rows]
    if np.unique(position).size < 2:
        return float("nan")
    strain = strain_by_model(model, position=position, tension=readings.tension[rows])
    legacy = _fit_constant_fraction(readings).coefficients
    return legacy["free_fraction"] / legacy["relaxed_free_length"] / line_slope(position, strain)


def fit_to_marks(method: StrainMethod, readings: PooledMarks) -> StrainModel:
    """Fit a method that needs marks, and say how far it is from each mark it used.

    Parameters
    ----------
    method : StrainMethod
        ``marks``, ``strain-ratio``, ``tension-driven`` or ``constant-fraction``.
    readings : PooledMarks
        Marks with their tension.

    Returns
    -------
    model : StrainModel
        Coefficients, covariance, range, residuals, slope ratio. [SI]

    Raises
    ------
    DataError
        If there are too few marks for the method.
    FitError
        If the splices do not follow a law of tension.

    Examples
    --------
    >>> marks = SpliceMarks("new", 2 * ("T-1",), ("slack", "min"), np.array([0.63, 0.74]),
    ...                     np.array([3.18, 5.25]), np.array([3.74, 5.90]))
    >>> readings = PooledMarks(marks, np.array([0.0, 380.0]), np.array([True, True]))
    >>> print(round(fit_to_marks("strain-ratio", readings).coefficients["splice_strain_ratio"], 3))
    0.219
    """
    marks = readings.marks
    stretched = readings.stretched_rows(method)
    if stretched.size == 0:
        raise DataError(
            f"strain of '{marks.specimen}' by {method} has no mark to rest on",
            needed="a stretched row of this specimen"
            + (" whose hold is found in the log" if method == "tension-driven" else ""),
            hint="tension-driven also needs the tension at the mark; the other methods do not."
            if method == "tension-driven"
            else None,
        )
    model = _FROM_MARKS[method](readings)
    slack = marks.is_slack
    if method != "tension-driven" and np.any(slack & readings.is_own):
        slack = slack & readings.is_own
    rows = np.sort(np.concatenate([np.flatnonzero(slack), stretched]))
    tension = np.where(slack, np.nan_to_num(readings.tension), readings.tension)
    strain = marks.free_length[rows] / model.coefficients["relaxed_free_length"] - 1
    by_method = strain_by_model(model, position=marks.far_thimble[rows], tension=tension[rows])
    if method == "tension-driven":
        model = replace(
            model, tension_low=0.0, tension_high=float(readings.tension[stretched].max())
        )
    is_own = readings.has_own and method != "tension-driven"
    return replace(
        model,
        position_low=float(marks.far_thimble[stretched].min()),
        position_high=float(marks.far_thimble[stretched].max()),
        marks_from="this test" if is_own else "pooled over the campaign",
        mark_test=tuple(marks.test[row] for row in rows),
        mark_hold=tuple(marks.hold[row] for row in rows),
        mark_position=marks.far_thimble[rows],
        mark_strain=strain,
        mark_tension=tension[rows],
        mark_strain_residual=by_method - strain,
        strain_slope_ratio=_slope_ratio(model, readings),
    )

"""Choice of a strain method and its fit to the marks of a specimen.

Marks of one specimen pooled over a campaign, and each strain method fitted to them.

What a reader of the strain has to know about the marks behind it, one sentence each.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import betainc

from reduction.record.errors import DataError, FitError
from reduction.record.measurement import Bools, Floats, Integers, Specimen, SpliceMarks
from reduction.record.notes import Note, note
from reduction.record.settings import StrainMethod, StrainSettings
from reduction.stages.standstills import Standstills
from reduction.stages.strain.splice_marks import (
    HELD_EXPONENT,
    RelaxedLengths,
    SpliceCalibration,
    check_marks,
    fit_free_length_line,
    fit_splice_law,
    fit_splice_ratio,
    line_slope,
    relaxed_lengths,
)
from reduction.stages.strain.strain_model import StrainModel, free_length_fraction, strain_by_model

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
    names: tuple[str, ...], relaxed: RelaxedLengths, fit: SpliceCalibration
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
    marks: SpliceMarks, relaxed: RelaxedLengths, fit: SpliceCalibration
) -> tuple[Note, ...]:
    """What the marks do that the tape does not explain."""
    told = {"slack rows": relaxed.note, "stretched marks": fit.note}
    return tuple(
        replace(one, subject=marks.specimen, numbers={"rows": rows, **one.numbers})
        for rows, one in told.items()
        if one
    )


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

    def law(exponent: float | None) -> SpliceCalibration:
        return fit_splice_law(
            marks.splice_length[rows],
            readings.tension[rows],
            relaxed_splice_length=float(relaxed.values[1]),
            reading_uncertainty=marks.reading_uncertainty,
            exponent=exponent,
            relaxed_standard_uncertainty=float(np.sqrt(relaxed.covariance[1, 1])),
        )

    made: tuple[str, ...] = ()
    wide = readings.tension_span > TENSION_SPAN and rows.size > 2
    fit = law(None) if wide else law(HELD_EXPONENT)
    if not wide:
        made = (
            f"{rows.size} marks over a factor of {readings.tension_span:.2f} in "
            "tension do not fix the exponent of the splice law; it is held at 1",
        )
    elif (uncertainty := float(np.sqrt(fit.covariance[1, 1]))) > _EXPONENT_UNCERTAINTY:
        made = (
            "the marks fix the exponent of the splice law only to "
            f"{fit.values[1]:.2f} +- {uncertainty:.2f}; it is held at 1",
        )
        fit = law(HELD_EXPONENT)
    return StrainModel(
        marks.specimen, "tension-driven",
        *_with_relaxed(("splice_compliance", "splice_exponent"), relaxed, fit),
        notes=_scatter_notes(marks, relaxed, fit), made=made,
    )  # fmt: skip


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


# a strain slope that differs by less than this is not worth a sentence
_SLOPE_NOTICE = 0.01

# scatter and outliers, in standard uncertainties of a mark
_SCATTER_NOTICE = 2.0

_OUTLIER_NOTICE = 5.0

# slack rows that can show a trend, and the chance that level ones show it
_TREND_ROWS = 4

_TREND_CHANCE = 0.01


def _rms(residual: Floats) -> float:
    return sqrt(float(np.mean(residual**2)))


def _on_constant_fraction(model: StrainModel, is_stretched: Bools) -> tuple[Note, ...]:
    if model.method != "constant-fraction":
        return ()
    position = model.mark_position[is_stretched]
    if np.unique(position).size < 2:
        return ()
    residual = model.mark_strain_residual[is_stretched]
    steepness = model.coefficients["free_fraction"] / model.coefficients["relaxed_free_length"]
    excess = line_slope(position, residual)
    ratio = steepness / (steepness - excess)
    if abs(ratio - 1) < _SLOPE_NOTICE:
        return ()
    return (
        note(
            "constant-fraction-off",
            model.specimen,
            low=float(residual.min()),
            high=float(residual.max()),
            effect=1 / ratio - 1,
        ),
    )


def _on_scatter(model: StrainModel, is_stretched: Bools, expected: float) -> tuple[Note, ...]:
    """Scatter beyond tape reading, and single marks far off; not for the legacy method."""
    if model.method == "constant-fraction":
        return ()
    residual = model.mark_strain_residual[is_stretched]
    rms = _rms(residual)
    notes = []
    if expected > 0 and rms > _SCATTER_NOTICE * expected:
        notes.append(
            note("marks-differ", model.specimen, method=model.method, rms=rms, expected=expected)
        )
    # a median does not let one misread mark hide itself
    usual = max(expected, 1.4826 * float(np.median(np.abs(residual))))
    if residual.size > 3 and usual > 0:
        rows = np.flatnonzero(is_stretched)[np.abs(residual) > _OUTLIER_NOTICE * usual]
        notes += [
            note(
                "marks-outlier",
                model.specimen,
                test=model.mark_test[row],
                hold=model.mark_hold[row],
                residual=float(model.mark_strain_residual[row]),
            )
            for row in rows
        ]
    return tuple(notes)


def _on_slack(marks: SpliceMarks) -> tuple[Note, ...]:
    """Growth of the slack length from test to test: permanent set, or a splice let out.

    A trend over the rows, since single readings scatter by more than their last digit.
    """
    length = marks.far_thimble[marks.is_slack]
    if length.size < _TREND_ROWS or np.ptp(length) == 0:
        return ()
    row = np.arange(length.size)
    slope, correlation = line_slope(row, length), float(np.corrcoef(row, length)[0, 1])
    # of a correlation this far from zero among rows without a trend (Student's t, both sides)
    chance = betainc(length.size / 2 - 1, 0.5, max(0.0, 1 - correlation**2))
    if slope <= 0 or chance > _TREND_CHANCE:
        return ()
    growth = slope * (length.size - 1)
    effect = float(growth / length[0])
    return (note("slack-length-grows", marks.specimen, growth=float(growth), effect=effect),)


def _on_reading_time(
    model: StrainModel, is_stretched: Bools, at_start: StrainModel
) -> tuple[str, ...]:
    """How far it matters when in a hold the tape was read."""
    force = np.array([model.tension_high])
    position = np.array([float(model.mark_position[is_stretched].max())])
    change = float(
        (
            strain_by_model(at_start, position=position, tension=force)
            - strain_by_model(model, position=position, tension=force)
        )[0]
    )
    end, start = (
        100 * _rms(entry.mark_strain_residual[is_stretched]) for entry in (model, at_start)
    )
    return (
        "marks are taken to be read as a hold ends, and then differ from the "
        f"splice law by {end:.2f} points of strain rms; read as it begins, {start:.2f} points, and "
        f"strain at the highest marked tension would be {100 * change:+.1f} points other",
    )


def _on_left_out(
    model: StrainModel, marks: SpliceMarks, n_used: int, failed_tests: Sequence[str]
) -> tuple[Note, ...]:
    """Stretched marks that the law of tension lacks: their log failed, or shows no hold."""
    rows = np.flatnonzero(~marks.is_slack)
    tests = [marks.test[row] for row in rows if marks.test[row] in failed_tests]
    notes = []
    if tests:
        notes.append(
            note(
                "marks-of-failed-tests",
                model.specimen,
                n_marks=len(tests),
                n_stretched=rows.size,
                tests=", ".join(dict.fromkeys(tests)),
            )
        )
    without_hold = rows.size - n_used - len(tests)
    if model.method == "tension-driven" and without_hold > 0:
        notes.append(
            note("marks-without-hold", model.specimen, n_marks=without_hold, n_stretched=rows.size)
        )
    return tuple(notes)


def _remarks_on(
    model: StrainModel,
    marks: SpliceMarks,
    is_stretched: Bools,
    *,
    failed_tests: Sequence[str] = (),
) -> tuple[Note, ...]:
    """Remarks on a model fitted to marks.

    Examples
    --------
    >>> model = StrainModel(
    ...     "new", "marks", {"relaxed_free_length": 2.55}, mark_test=("T-1",), mark_hold=("min",),
    ...     mark_position=np.array([5.9]), mark_strain=np.array([0.766]),
    ...     mark_strain_residual=np.array([0.02]))
    >>> marks = SpliceMarks("new", ("T-1",), ("min",), np.array([0.7]), np.array([5.2]),
    ...                     np.array([5.9]), reading_uncertainty=0.01)
    >>> print(_remarks_on(model, marks, np.array([True]))[0])
    new: strain by marks differs from the marks by 2.00 points rms, tape reading alone explains 0.68
    """
    expected = sqrt(3) * marks.reading_uncertainty / model.coefficients["relaxed_free_length"]
    return (
        *_on_left_out(model, marks, int(is_stretched.sum()), failed_tests),
        *_on_constant_fraction(model, is_stretched),
        *_on_scatter(model, is_stretched, expected),
        *_on_slack(marks),
    )


_BY_POSITION: tuple[StrainMethod, ...] = ("marks", "strain-ratio", "constant-fraction")


def zero_strain_position(
    standstills: Standstills, *, position_is_length: bool, length_at_slack: float | None = None
) -> float | None:
    """Crosshead position at which a specimen without splices has no strain.

    Examples
    --------
    >>> none = np.empty(0)
    >>> no_rest = Standstills(none, none, none, none, none, np.empty((1, 0)), none > 0, 0.01, 5.0)
    >>> print(zero_strain_position(no_rest, position_is_length=False))
    0.0
    """
    rests = standstills.mean_position[standstills.is_rest]
    if rests.size:
        return float(rests[0])
    return length_at_slack if position_is_length else 0.0


def _without_marks(
    specimen: Specimen, method: StrainMethod, reference_position: float | None
) -> StrainModel:
    if method == "extensometer":
        return StrainModel(specimen.name, "extensometer")
    if specimen.gauge_length is None or reference_position is None:
        raise DataError(
            f"strain of '{specimen.name}' by gauge-length lacks "
            + ("a gauge length" if specimen.gauge_length is None else "a position of zero strain"),
            needed="specimens.NAME.gauge_length, and a rest at slack or a displacement from slack "
            "(its reference_length read without tension)",
        )
    coefficients = {
        "reference_position": reference_position,
        "gauge_length": specimen.gauge_length,
    }
    spread = specimen.gauge_length_standard_uncertainty
    return StrainModel(
        specimen.name,
        "gauge-length",
        coefficients,
        np.diag([0.0, 0.0 if spread is None else spread**2]),
        notes=(note("gauge-length-exact"),) if spread is None else (),
    )


def _default_method(
    specimen: Specimen, readings: PooledMarks | None, has_extensometer: bool
) -> StrainMethod:
    if readings is not None:
        return "tension-driven" if readings.tension_span > TENSION_SPAN else "marks"
    if has_extensometer:
        return "extensometer"
    if specimen.gauge_length is not None:
        return "gauge-length"
    raise DataError(
        f"nothing says how position becomes strain of '{specimen.name}'",
        needed="splice marks, a strain channel, or a gauge length where there are no splices",
        hint='Give strain = { marks = "marks.csv" } under [defaults], or gauge_length under each'
        " [specimens.NAME], in campaign.toml.",
    )


def _splice_law(readings: PooledMarks) -> dict[str, float]:
    """Law of tension of the same splices; empty where the marks do not follow one."""
    if readings.stretched_rows("tension-driven").size == 0:
        return {}
    try:
        return fit_to_marks("tension-driven", readings).coefficients
    except FitError:
        return {}


def fit_strain_model(
    specimen: Specimen,
    *,
    test_id: str,
    marks: SpliceMarks | None = None,
    mark_tension: ArrayLike | None = None,
    mark_tension_at_start: ArrayLike | None = None,
    settings: StrainSettings | None = None,
    has_extensometer: bool = False,
    reference_position: float | None = None,
    failed_tests: Sequence[str] = (),
) -> StrainModel:
    """Fit the strain method of one specimen in one test.

    Parameters
    ----------
    specimen : Specimen
        Its ``gauge_length`` and that one's standard uncertainty are used by that method.
    test_id : str
        Test to which the model will be applied.
    marks : SpliceMarks, optional
        Of this specimen over the whole campaign.
    mark_tension : array_like, shape (n_marks,), optional
        From `reduction.stages.strain.splice_marks.measure_mark_tension`, row by row of ``marks``;
        NaN where no hold was found. [N]
    mark_tension_at_start : array_like, shape (n_marks,), optional
        The same at the start of each hold; only the history uses it. [N]
    settings : StrainSettings, optional
        ``method`` None chooses: see Notes.
    has_extensometer : bool
        Whether the log has a strain channel.
    reference_position : float, optional
        Crosshead position at zero strain, for ``gauge-length``. [m]
    failed_tests : sequence of str
        Tests whose log could not be read, so that their marks have no tension. [1]

    Returns
    -------
    model : StrainModel
        Method, coefficients with covariance, residuals at the marks, notes. [SI]

    Raises
    ------
    DataError
        If the method lacks what it needs, or marks contradict each other.
    FitError
        If ``tension-driven`` was asked for and the marks do not follow such a law.

    Notes
    -----
    Without a stated method: ``tension-driven`` where the pooled marks span more
    than a factor of 2 in tension, else ``marks``; without marks the extensometer,
    else the gauge length.  Where the law of tension then cannot be fitted, the
    model is ``marks`` and a note says why.

    ``tension-driven`` uses all marks of the specimen, since its splices are the
    same in every test; the others use the test's own marks, or all where the test
    has none.  The relaxed lengths are means over all slack rows; only
    ``constant-fraction`` takes the test's own row, as the report does.

    The covariance holds reading errors of the tape, or the stated standard uncertainty of the
    gauge length, which all samples share; not
    the choice of the method, which `strain_slope_ratio` and the residuals show.  A method that
    knows position alone keeps the law of tension of its marks as ``splice_law``.

    Examples
    --------
    Table 3 of [1]_, new tether.  The report's own strain reads its moduli 14.5 % high:

    >>> foot = 0.3048
    >>> marks = SpliceMarks(
    ...     "new", 4 * ("T-1",), ("slack", "min", "centre", "max"),
    ...     near_toe=foot * np.array([2.06, 2.42, 2.53, 2.69]),
    ...     far_toe=foot * np.array([10.44, 17.22, 19.48, 21.72]),
    ...     far_thimble=foot * np.array([12.26, 19.37, 21.75, 24.12]))
    >>> model = fit_strain_model(Specimen("new"), test_id="T-1", marks=marks)
    >>> print(model.method, round(model.strain_slope_ratio, 3))
    marks 0.873
    """
    stated = None if settings is None else settings.method
    readings = None
    if marks is not None:
        tension = np.full(len(marks.test), np.nan) if mark_tension is None else mark_tension
        is_own = np.array([test == test_id for test in marks.test], dtype=bool)
        readings = PooledMarks(marks, np.asarray(tension, dtype=np.float64), is_own)
        if readings.tension.shape != is_own.shape:
            raise DataError(
                "tensions and marks do not pair up",
                found=f"{readings.tension.size} tensions for {is_own.size} marks",
                needed="one tension a row, NaN where it is not known",
            )
    method = stated or _default_method(specimen, readings, has_extensometer)
    if method in ("extensometer", "gauge-length"):
        return _without_marks(specimen, method, reference_position)
    if readings is None:
        raise DataError(
            f"strain of '{specimen.name}' by {method} needs splice marks",
            found="no marks of this specimen",
            needed="rows of it in the marks file",
        )
    used = readings.stretched_rows(method)
    check_marks(readings.marks, tests=sorted({readings.marks.test[row] for row in used}))
    notes: tuple[Note, ...] = ()
    try:
        model = fit_to_marks(method, readings)
    except FitError as error:
        if stated is not None:
            raise
        notes = (note("strain-by-marks-instead", specimen.name, reason=str(error)),)
        model = fit_to_marks("marks", readings)
    if model.method in _BY_POSITION:
        model = replace(model, splice_law=_splice_law(readings))
    is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
    made = model.made
    if model.method == "tension-driven" and mark_tension_at_start is not None:
        early = replace(readings, tension=np.asarray(mark_tension_at_start, dtype=np.float64))
        at_start = fit_to_marks("tension-driven", early)
        made += _on_reading_time(model, is_stretched, at_start)
    # a method that was asked for and needs no tension loses nothing with a log
    lost = failed_tests if stated in (None, "tension-driven") else ()
    remarks = _remarks_on(model, readings.marks, is_stretched, failed_tests=lost)
    return replace(model, notes=(*notes, *model.notes, *remarks), made=made)

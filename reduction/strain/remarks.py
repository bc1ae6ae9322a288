"""What a reader of the strain has to know about the marks behind it, one sentence each.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np
from scipy.special import betainc

from reduction.record import Bools, Floats, SpliceMarks
from reduction.strain.calibration import line_slope
from reduction.strain.evaluate import strain_by_model
from reduction.strain.model import StrainModel

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


def _high_or_low(ratio: float) -> str:
    change = 1 / ratio - 1
    return f"{100 * abs(change):.1f} % {'high' if change > 0 else 'low'}"


def _on_constant_fraction(model: StrainModel, is_stretched: Bools) -> tuple[str, ...]:
    if model.method != "constant-fraction":
        if abs(model.strain_slope_ratio - 1) < _SLOPE_NOTICE or np.isnan(model.strain_slope_ratio):
            return ()
        return (
            f"{model.specimen}: constant-fraction, the method of WHOI-2005-10, would read moduli "
            f"over these marks {_high_or_low(model.strain_slope_ratio)} against {model.method}",
        )
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
        f"{model.specimen}: constant-fraction misses its own marks by "
        f"{100 * residual.min():+.1f} to {100 * residual.max():+.1f} points of strain and reads "
        f"moduli over them {_high_or_low(ratio)}",
    )


def _on_scatter(model: StrainModel, is_stretched: Bools, expected: float) -> tuple[str, ...]:
    """Scatter beyond tape reading, and single marks far off; not for the legacy method."""
    if model.method == "constant-fraction":
        return ()
    residual = model.mark_strain_residual[is_stretched]
    rms = _rms(residual)
    notes = []
    if expected > 0 and rms > _SCATTER_NOTICE * expected:
        notes.append(
            f"{model.specimen}: strain by {model.method} differs from the marks by "
            f"{100 * rms:.2f} points rms, tape reading alone explains {100 * expected:.2f}"
        )
    # a median does not let one misread mark hide itself
    usual = max(expected, 1.4826 * float(np.median(np.abs(residual))))
    if residual.size > 3 and usual > 0:
        rows = np.flatnonzero(is_stretched)[np.abs(residual) > _OUTLIER_NOTICE * usual]
        notes += [
            f"{model.specimen}: the mark of test {model.mark_test[row]}, hold "
            f"{model.mark_hold[row]}, lies {100 * model.mark_strain_residual[row]:+.1f} points off "
            f"the fit; its tape readings want a second look"
            for row in rows
        ]
    return tuple(notes)


def _on_slack(marks: SpliceMarks) -> tuple[str, ...]:
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
    return (
        f"{marks.specimen}: the slack length grows by {1e3 * growth:.0f} mm "
        f"({100 * growth / length[0]:.1f} %) from the first test to the last "
        "(permanent set, or a splice let out); strain counts from the mean slack length",
    )


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
        f"{model.specimen}: marks are taken to be read as a hold ends, and then differ from the "
        f"splice law by {end:.2f} points of strain rms; read as it begins, {start:.2f} points, and "
        f"strain at the highest marked tension would be {100 * change:+.1f} points other",
    )


def _on_left_out(
    model: StrainModel, marks: SpliceMarks, n_used: int, failed_tests: Sequence[str]
) -> tuple[str, ...]:
    """Stretched marks that the law of tension lacks: their log failed, or shows no hold."""
    rows = np.flatnonzero(~marks.is_slack)
    tests = [marks.test[row] for row in rows if marks.test[row] in failed_tests]
    notes: tuple[str, ...] = ()
    if tests:
        notes += (
            f"{model.specimen}: {len(tests)} of {rows.size} stretched marks are of tests that "
            f"failed ({', '.join(dict.fromkeys(tests))}), so that their tension is not known; the "
            "law of tension is without them",
        )
    without_hold = rows.size - n_used - len(tests)
    if model.method == "tension-driven" and without_hold > 0:
        notes += (
            f"{model.specimen}: {without_hold} of {rows.size} stretched marks have no "
            "hold in the logs and are left out",
        )
    return notes


def remarks_on(
    model: StrainModel,
    marks: SpliceMarks,
    test_id: str,
    *,
    at_start: StrainModel | None = None,
    failed_tests: Sequence[str] = (),
) -> tuple[str, ...]:
    """Remarks on a model fitted to marks.

    Parameters
    ----------
    model : StrainModel
        With its marks and residuals.
    marks : SpliceMarks
        All marks of the specimen.
    test_id : str
        Test to which the model will be applied.
    at_start : StrainModel, optional
        The same fit with the tension at the start of each hold.
    failed_tests : sequence of str
        Tests whose log could not be read, so that their marks have no tension. [1]

    Returns
    -------
    notes : tuple of str
        One plain sentence each; empty where there is nothing to say. [1]

    Raises
    ------
    DataError
        Never by itself.

    Examples
    --------
    >>> model = StrainModel(
    ...     "new", "marks", {"relaxed_free_length": 2.55}, mark_test=("T-1",), mark_hold=("min",),
    ...     mark_position=np.array([5.9]), mark_strain=np.array([0.766]),
    ...     mark_strain_residual=np.array([0.001]), strain_slope_ratio=0.873)
    >>> marks = SpliceMarks("new", ("T-1",), ("min",), np.array([0.7]), np.array([5.2]),
    ...                     np.array([5.9]))
    >>> print(remarks_on(model, marks, "T-1")[0][24:])
    the method of WHOI-2005-10, would read moduli over these marks 14.5 % high against marks
    """
    is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
    notes: tuple[str, ...] = ()
    if not any(
        test == test_id and hold != "slack"
        for test, hold in zip(marks.test, marks.hold, strict=True)
    ):
        tests = dict.fromkeys(np.array(model.mark_test)[is_stretched].tolist())
        notes += (
            f"{model.specimen}: {test_id} has no marks of its own; its strain rests on those of "
            + ", ".join(tests),
        )
    notes += _on_left_out(model, marks, int(is_stretched.sum()), failed_tests)
    expected = sqrt(3) * marks.reading_uncertainty / model.coefficients["relaxed_free_length"]
    notes += _on_constant_fraction(model, is_stretched)
    notes += _on_scatter(model, is_stretched, expected)
    notes += _on_slack(marks)
    if at_start is not None:
        notes += _on_reading_time(model, is_stretched, at_start)
    return notes

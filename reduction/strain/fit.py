"""Choice of a strain method and its fit to the marks of a specimen.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic
   Modulus of Rubber Mooring Tethers and their Use in Coastal Moorings," Woods
   Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError, FitError
from reduction.phases.standstill import Standstills
from reduction.record import Specimen, SpliceMarks
from reduction.settings import StrainMethod, StrainSettings
from reduction.strain.marks import check_marks
from reduction.strain.model import StrainModel
from reduction.strain.pool import TENSION_SPAN, PooledMarks, fit_to_marks
from reduction.strain.remarks import remarks_on

_BY_POSITION: tuple[StrainMethod, ...] = ("marks", "strain-ratio", "constant-fraction")

_EXACT_LENGTH = (
    "the gauge length counts as exact: its standard uncertainty is not stated, and that of strain "
    "leaves it out"
)


def zero_strain_position(
    standstills: Standstills, *, position_is_length: bool, length_at_slack: float | None = None
) -> float | None:
    """Crosshead position at which a specimen without splices has no strain.

    Parameters
    ----------
    standstills : Standstills
        Of the log.
    position_is_length : bool
        False where the channel is a displacement of which no length is stated.
    length_at_slack : float, optional
        Length at displacement zero, where it was stated at slack. [m]

    Returns
    -------
    position : float or None
        Mean position of the first rest at slack; without one, where a displacement is zero,
        and None for a length of which nothing says where it is slack. [m]

    Raises
    ------
    DataError
        Never by itself; `fit_strain_model` refuses None where it is needed.

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
        notes=(_EXACT_LENGTH,) if spread is None else (),
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
        From `reduction.strain.marks.measure_mark_tension`, row by row of ``marks``;
        NaN where no hold was found. [N]
    mark_tension_at_start : array_like, shape (n_marks,), optional
        The same at the start of each hold; only the notes use it. [N]
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
    notes: tuple[str, ...] = ()
    try:
        model = fit_to_marks(method, readings)
    except FitError as error:
        if stated is not None:
            raise
        notes = (f"{specimen.name}: tension-driven strain was given up for marks: {error}",)
        model = fit_to_marks("marks", readings)
    if model.method in _BY_POSITION:
        model = replace(model, splice_law=_splice_law(readings))
    at_start = None
    if model.method == "tension-driven" and mark_tension_at_start is not None:
        early = replace(readings, tension=np.asarray(mark_tension_at_start, dtype=np.float64))
        at_start = fit_to_marks("tension-driven", early)
    # a method that was asked for and needs no tension loses nothing with a log
    lost = failed_tests if stated in (None, "tension-driven") else ()
    remarks = remarks_on(model, readings.marks, test_id, at_start=at_start, failed_tests=lost)
    return replace(model, notes=(*notes, *model.notes, *remarks))

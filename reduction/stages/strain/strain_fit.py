"""Strain model of a specimen from its tape readings: laws are fitted, chosen or averaged.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of Rubber
   Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst., Woods Hole,
   MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike

from reduction.record.arrays import MAD_TO_DEVIATION
from reduction.record.errors import DataError
from reduction.record.measurement import (
    Bools,
    Floats,
    Integers,
    Specimen,
    SpliceMarks,
)
from reduction.record.notes import Note, note
from reduction.record.settings import StrainMethod, StrainSettings
from reduction.stages.strain.mark_readings import (
    RelaxedLengths,
    check_marks,
    relaxed_lengths,
    root_mean_square,
    slack_growth,
    tape_error,
    tape_freedom,
)
from reduction.stages.strain.splice_calibration import (
    EXPONENT_UNCERTAINTY,
    HELD_EXPONENT,
    TENSION_SPAN,
    SpliceCalibration,
    fit_free_length_line,
    fit_power_law,
    fit_splice_ratio,
    line_slope,
)
from reduction.stages.strain.splice_laws import (
    LAWS,
    OF_TENSION,
    REJECTED,
    FittedLaw,
    SpliceAverage,
    SpliceReadings,
    fit_splice_laws,
)
from reduction.stages.strain.strain_model import (
    StrainModel,
    free_length_fraction,
    position_by_model,
    strain_by_model,
)
from reduction.stages.strain.tape_and_crosshead import TAPE_UNCERTAINTY
from reduction.stages.strain.zero_strain import ZeroStrain

_CREEP_TOLD = 0.1  # of their extension: a note states the effect of this creep

_CREEP_NOTICE = 0.005  # of a strain amplitude: smaller effects are not stated

_ANY = 12**0.5  # range over standard deviation of a uniform distribution


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
    tension_at_start : ndarray, shape (n_marks,)
        When each hold began, where the tape may have been read; empty where not known. [N]
    tension_on_arrival : ndarray, shape (n_marks,)
        As the crosshead stopped; empty where not known. [N]
    """

    marks: SpliceMarks
    tension: Floats
    is_own: Bools
    tension_at_start: Floats = field(default_factory=lambda: np.empty(0))
    tension_on_arrival: Floats = field(default_factory=lambda: np.empty(0))

    @property
    def has_own(self) -> bool:
        """Whether the test has stretched rows of its own."""
        return bool(np.any(self.is_own & ~self.marks.is_slack & ~self.marks.is_unloading))

    @property
    def knows_tension(self) -> bool:
        """Whether a law of tension can be fitted to at least two stretched rows."""
        known = ~self.marks.is_slack & ~self.marks.is_unloading
        return bool(np.count_nonzero(known & (np.nan_to_num(self.tension) > 0)) > 1)

    def stretched_rows(self, method: StrainMethod) -> Integers:
        """Rows that fix the coefficients of a method.

        ``tension-driven`` and ``mixed``: all whose tension is known, since splices are the same
        in every test.  Other methods, and ``mixed`` where the tension is known for fewer than two
        rows: the rows of the test, or all where it has none.
        """
        stretched = ~self.marks.is_slack & ~self.marks.is_unloading
        if method == "tension-driven" or (method == "mixed" and self.knows_tension):
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
            growth=slack_growth(self.marks).course,
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
    """Scatter of the marks that the tape does not explain."""
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
    # the line does not use a splice length
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
    """As in the report: the test's own slack row, the mean share of its stretched rows."""
    marks, rows = readings.marks, readings.stretched_rows("constant-fraction")
    slack = marks.is_slack & readings.is_own
    relaxed = (
        marks.free_length[slack].mean() if slack.any() else float(readings.relaxed().values[0])
    )
    n_slack = max(int(slack.sum()), 1)
    length = marks.far_thimble[rows]
    share = marks.free_length[rows] / length
    # both toes enter, and the far thimble in the denominator
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
        return fit_power_law(
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
    elif (uncertainty := float(np.sqrt(fit.covariance[1, 1]))) > EXPONENT_UNCERTAINTY:
        made = (
            f"the marks fix the exponent of the splice law only to {fit.values[1]:.2f} +-"
            f" {uncertainty:.2f}; it is held at 1",
        )
        fit = law(HELD_EXPONENT)
    return StrainModel(
        marks.specimen, "tension-driven",
        *_with_relaxed(("splice_compliance", "splice_exponent"), relaxed, fit),
        notes=_scatter_notes(marks, relaxed, fit), made=made,
    )  # fmt: skip


@dataclass(frozen=True)
class _MixedFit:
    """Average over the laws of the splices, and the resulting model of one test."""

    average: SpliceAverage
    model: StrainModel
    rows: Integers


def _splice_readings(readings: PooledMarks, relaxed: RelaxedLengths) -> SpliceReadings:
    """Strains at every row whose tension is known, or at all rows where hardly one is."""
    marks = readings.marks
    known = marks.is_slack.copy()
    known[readings.stretched_rows("mixed")] = True
    free, splice = (float(one) for one in relaxed.values)
    lengths = np.array([free, splice])
    tests = {name: at for at, name in enumerate(dict.fromkeys(marks.test))}
    return SpliceReadings(
        free=marks.free_length[known] / free - 1,
        splice=marks.splice_length[known] / splice - 1,
        tension=np.where(marks.is_slack, 0.0, readings.tension)[known],
        test=np.array([tests[name] for name in marks.test])[known],
        is_slack=marks.is_slack[known],
        share=splice / free,
        tape=marks.reading_uncertainty / splice,
        relaxed=relaxed.covariance / np.outer(lengths, lengths),
        row=np.flatnonzero(known),
        tension_uncertainty=_tension_uncertainty(readings)[known],
        tape_freedom=tape_freedom(marks, slack_growth(marks).course),
    )


def _tension_uncertainty(readings: PooledMarks) -> Floats:
    """Relative uncertainty of tension from the unknown time of reading in its hold. [1]."""
    if not readings.tension_at_start.size:
        return np.zeros(readings.tension.size)
    change = readings.tension_at_start - readings.tension
    is_known = ~readings.marks.is_slack & (np.nan_to_num(readings.tension) > 0) & ~np.isnan(change)
    return (
        np.where(is_known, np.abs(change), 0.0) / np.where(is_known, readings.tension, 1.0) / _ANY
    )


def average_over_laws(readings: PooledMarks) -> SpliceAverage:
    """Average over the laws of the splices that the marks do not reject."""
    marks = readings.marks
    reading = tape_error(marks, slack_growth(marks).course)
    held = replace(readings, marks=replace(marks, reading_uncertainty=reading))
    given = _splice_readings(held, readings.relaxed())
    names = [f"the mark of test {marks.test[row]} at {marks.hold[row]}" for row in given.row]
    return fit_splice_laws(given, specimen=marks.specimen, names=names)


def _fit_mixed(readings: PooledMarks, average: SpliceAverage | None) -> _MixedFit:
    """Average over the laws of the splices, for one test."""
    marks, relaxed = readings.marks, readings.relaxed()
    given = _splice_readings(readings, relaxed)
    if average is None:
        average = average_over_laws(readings)
    free, splice = (float(one) for one in relaxed.values * (1 + average.values[-2:]))
    tests = list(dict.fromkeys(marks.test))
    # a test whose marks are all set aside has none of its own
    rows = np.delete(given.row, average.set_aside)
    of_test = np.array(marks.test)[rows[readings.is_own[rows]]]
    own = [tests.index(test) for test in dict.fromkeys(of_test)]
    offset, of_marks, of_slip = _own_offset(average, own[0] if own else None)
    names = (
        "relaxed_free_length", "relaxed_splice_length", "splice_offset", "splice_strain_ratio",
        "splice_strain_curvature", "splice_strain_cubic", "splice_compliance", "splice_exponent",
        "splice_limit", "splice_saturation",
    )  # fmt: skip
    law, to_law = _law_in_si(average.values, average.reference)
    values = [free, splice, *law.tolist()]
    values[2] += offset
    to_si = np.zeros((len(names), len(names)))
    to_si[[0, 1], [-2, -1]] = relaxed.values
    to_si[2:, :-2] = to_law
    covariance = to_si @ average.covariance @ to_si.T
    between = to_si @ average.between @ to_si.T
    covariance[2, 2] += of_marks
    if not average.slip:  # strain refers to the mean slack length; a test may lie anywhere about it
        of_slip = slack_growth(marks).length / (_ANY * splice)
    between += _of_creep(np.array(values), _mean_splice_strain(given, own), marks.splice_creep)
    model = StrainModel(
        marks.specimen,
        "mixed",
        dict(zip(names, values, strict=True)),
        covariance,
        law_covariance=between if between.any() else np.empty((0, 0)),
        notes=_scatter_notes(marks, relaxed, _NO_FIT),
        splice_slip=of_slip * splice,
    )
    return _MixedFit(average, model, rows)


def _mean_splice_strain(given: SpliceReadings, own: Sequence[int]) -> float:
    """Mean splice strain of the loaded marks of one test, or of all where it has none. [1]."""
    loaded = ~given.is_slack
    of_test = loaded & np.isin(given.test, own)
    return float(given.splice[of_test if of_test.any() else loaded].mean())


def _of_creep(values: Floats, mean: float, share: float) -> Floats:
    """Covariance of the coefficients by creep of the splices before a mark is read. [SI].

    In a cycle the splices extend from their mean less than between marks, by a fixed share:
    their strain about the mean is that much smaller, whatever drives it.
    """
    change = np.zeros(values.size)
    # offset, powers of the strain, compliance and limit
    change[[2, 3, 4, 5, 6, 8]] = -values[[2, 3, 4, 5, 6, 8]]
    change[2] += mean
    return share**2 * np.outer(change, change)


def _law_in_si(values: Floats, reference: float) -> tuple[Floats, Floats]:
    """Coefficients of a law from the strains at a reference tension, and their Jacobian.

    The compliance is the strain at one newton, the limit the asymptote of the saturating term.
    """
    law, change = np.array(values[:-2]), np.eye(values.size - 2)
    strained, exponent, limited, saturation = (float(one) for one in law[4:])
    law[4] = compliance = strained * reference**-exponent
    change[4, 4:6] = reference**-exponent, -compliance * np.log(reference)
    law[7] = saturation / reference
    change[7, 7] = 1 / reference
    if limited > 0:
        share = -np.expm1(-saturation)
        law[6] = limited / share
        change[6, 6:8] = 1 / share, -limited * np.exp(-saturation) / share**2
    return law, change


def _own_offset(average: SpliceAverage, place: int | None) -> tuple[float, float, float]:
    """Extra length of the splices of one test over the law, its variance, and that of later slip.

    Returns the offset, the variance that the test's own marks leave, and the standard uncertainty
    of slip after they were read.  Marks are read before the cycles: the offset at the start of the
    next test slipped between both, at any moment with equal probability.  After the last test no
    mark shows the slip: it is taken to be as uncertain as it is large, so that the variance of a
    fraction U of S is
    E(U^2) E(S^2) - (S / 2)^2 = 5/12 S^2.
    """
    if not average.slip:
        return 0.0, 0.0, 0.0
    if place is None:
        return 0.0, 0.0, average.slip
    steps = np.diff(average.test_offset)
    if place < steps.size:
        step = float(steps[place])
        spread = abs(step) / _ANY
    else:
        step = float(np.sqrt(np.mean(steps**2))) * float(np.sign(steps.sum()))
        spread = abs(step) * sqrt(5.0) / _ANY
    variance = float(average.test_variance[place])
    return float(average.test_offset[place]) + step / 2, variance, spread


_NO_FIT = SpliceCalibration(np.empty(0), np.empty((0, 0)), np.empty((0, 2)), np.empty(0))


def _on_laws(fit: _MixedFit, readings: PooledMarks) -> tuple[Note, ...]:
    """The law used, its certainty, and the effect of another law on a modulus."""
    average, marks = fit.average, readings.marks
    order = np.argsort(-average.weight, kind="stable")
    best, second = average.laws[order[0]], None
    if len(order) > 1 and average.weight[order[1]] > 0:
        second = average.laws[order[1]]
    notes = [
        note(
            "splice-laws",
            marks.specimen,
            law=best.name,
            weight=float(average.weight[order[0]]),
            chance=best.chance,
            second="" if second is None else second.name,
            effect=float("nan")
            if second is None
            else _effect_on_modulus(fit.model, second, average.reference),
        )
    ]
    given = _splice_readings(readings, readings.relaxed())
    notes += [
        note("mark-set-aside", marks.specimen, test=marks.test[row], hold=marks.hold[row])
        for row in given.row[list(average.set_aside)]
    ]
    if average.is_checked and any(
        weight > 0 and law.chance < REJECTED
        for law, weight in zip(average.laws, average.weight, strict=True)
    ):
        is_strain = not OF_TENSION & set(LAWS[best.name])
        notes.append(note("splice-side-rejected", marks.specimen, is_strain=is_strain))
    if not average.is_checked:
        carried = [
            law
            for law, weight in zip(average.laws, average.weight, strict=True)
            if weight > 0 and law.freedom > 0 and law is not best
        ]
        effects = [_effect_on_modulus(fit.model, law, average.reference) for law in carried]
        notes.append(
            note(
                "splice-law-unchecked",
                marks.specimen,
                n_marks=int((~marks.is_slack[fit.rows]).sum()),
                is_one_stretch=given.is_one_stretch,
                carried=", ".join(law.name for law in carried),
                effect=max(effects, key=abs, default=float("nan")),
            )
        )
    if average.slip:
        length = average.slip * fit.model.coefficients["relaxed_splice_length"]
        notes.append(note("splices-slip", marks.specimen, slip=length))
    return tuple(notes)


def _effect_on_modulus(model: StrainModel, law: FittedLaw, reference: float) -> float:
    """Change of a modulus by another law, over the middle of the marked range."""
    other = dict(model.coefficients)
    # the relaxed lengths before these stay
    other |= dict(zip(list(other)[2:], _law_in_si(law.values, reference)[0].tolist(), strict=True))
    middle = (model.position_low + model.position_high) / 2
    force = np.full(2, model.tension_high if np.isfinite(model.tension_high) else 0.0) / 2
    place = np.array([middle, middle + 0.01 * (model.position_high - model.position_low + 1e-9)])
    rises = [
        float(np.diff(strain_by_model(one, position=place, tension=force))[0])
        for one in (model, replace(model, coefficients=other))
    ]
    return rises[0] / rises[1] - 1


_FROM_MARKS: dict[StrainMethod, Callable[[PooledMarks], StrainModel]] = {
    "marks": _fit_marks,
    "strain-ratio": _fit_strain_ratio,
    "tension-driven": _fit_tension_driven,
    "constant-fraction": _fit_constant_fraction,
}


def _slope_ratio(model: StrainModel, readings: PooledMarks) -> float:
    """Strain slope of constant-fraction over that of the model, at the test's own marks."""
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
    """Fit a method that needs marks, with its residual at each mark it used.

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
            f"strain of '{marks.specimen}' by {method} has no mark to use",
            needed="a stretched row of this specimen"
            + (" whose hold is found in the log" if method == "tension-driven" else ""),
            hint="tension-driven also needs the tension at the mark; the other methods do not."
            if method == "tension-driven"
            else None,
        )
    return _at_marks(_FROM_MARKS[method](readings), readings, stretched)


def _at_marks(model: StrainModel, readings: PooledMarks, stretched: Integers) -> StrainModel:
    """Add the residuals of a model at the marks that it used, and the range of these."""
    marks, by_all = readings.marks, model.method in ("tension-driven", "mixed")
    slack = marks.is_slack
    if not by_all and np.any(slack & readings.is_own):
        slack = slack & readings.is_own
    rows = np.sort(np.concatenate([np.flatnonzero(slack), stretched]))
    tension = np.where(slack, np.nan_to_num(readings.tension), readings.tension)
    strain = marks.free_length[rows] / model.coefficients["relaxed_free_length"] - 1
    by_method = strain_by_model(model, position=marks.far_thimble[rows], tension=tension[rows])
    known = readings.tension[stretched]
    if by_all and np.isfinite(known).any():
        model = replace(model, tension_low=0.0, tension_high=float(np.nanmax(known)))
    is_own = readings.has_own and not by_all
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


def _average_at_marks(
    readings: PooledMarks, average: SpliceAverage | None
) -> tuple[StrainModel, _MixedFit]:
    """Fit the average over the laws, with its residual at each mark."""
    fit = _fit_mixed(readings, average)
    stretched = fit.rows[~readings.marks.is_slack[fit.rows]]
    model = _at_marks(fit.model, readings, stretched)
    marks = readings.marks
    if fit.average.slip:
        # only its offset is its own: the covariance of each test holds what the tests share
        model = replace(model, marks_from="this test, over those of the campaign")
    friction = _friction(model, readings)
    if friction is not None:
        share, spread = friction
        model = replace(
            model,
            splice_friction=float(np.hypot(share, spread)),
            notes=(*model.notes, note("splice-friction", marks.specimen, share=share,
                                      spread=spread)),
        )  # fmt: skip
    fit = replace(fit, model=model)
    notes = (*model.notes, *_on_laws(fit, readings), *_on_creep(model, marks, stretched))
    return replace(model, notes=notes), fit


def _on_creep(model: StrainModel, marks: SpliceMarks, rows: Integers) -> tuple[Note, ...]:
    """Effect of creep of the splices, which no mark shows, on a strain amplitude."""
    if marks.is_creep_stated:
        return ()
    free = marks.free_length[rows]
    if np.ptp(free) < _CREEP_NOTICE * model.coefficients["relaxed_free_length"]:
        return ()
    effect = _CREEP_TOLD * line_slope(free, marks.splice_length[rows])
    if effect < _CREEP_NOTICE:
        return ()
    return (note("splice-creep-unknown", marks.specimen, effect=effect),)


def _friction(model: StrainModel, readings: PooledMarks) -> tuple[float, float] | None:
    """Relative excess length of splices on the way down over the law, and its uncertainty.

    None without marks on the way down.  Splices that friction holds keep the length that they had
    as the crosshead stopped while the rubber relaxes, up, or recovers, down; others follow the
    tension.  Each is as likely.
    """
    marks = readings.marks
    loaded = np.nan_to_num(readings.tension) > 0
    rows = np.flatnonzero(marks.is_unloading & loaded)
    if not rows.size:
        return None
    known = model.coefficients
    strain = marks.free_length[rows] / known["relaxed_free_length"] - 1
    tension = [readings.tension[rows]]
    up = loaded & ~marks.is_unloading & ~marks.is_slack
    if readings.tension_on_arrival.size:
        # the law has the tensions at the end of the holds on the way up
        relaxed = float(np.nanmean(readings.tension[up] / readings.tension_on_arrival[up]))
        tension.append(readings.tension_on_arrival[rows] * relaxed)
    reading, shares, errors = sqrt(3) * tape_error(marks, slack_growth(marks).course), [], []
    for one in tension:
        by_law = position_by_model(model, strain=strain, tension=one) - marks.free_length[rows]
        extension = by_law - known["relaxed_splice_length"]
        size = float(extension @ extension)
        if not size > 0:
            return None
        shares.append(float(extension @ (marks.splice_length[rows] - by_law)) / size)
        errors.append(reading / sqrt(size))
    return float(np.mean(shares)), float(np.hypot(np.mean(errors), np.ptp(shares) / 2))


# a smaller relative difference of the strain slope is not worth a note
_SLOPE_NOTICE = 0.01

# scatter and outliers, in standard uncertainties of a mark
_SCATTER_NOTICE = 2.0

_OUTLIER_NOTICE = 5.0

# growth of the slack length that rubber and splices usually keep of their first stretch, which is
# in the interval of strain
_SET = 0.02


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
    """Scatter beyond tape reading, and single marks far off; not for the legacy method.

    An average over laws is also exempt: its laws, with slip, and its single marks are judged one by
    one at the tensions of the marks; the error of their mean is in the interval.
    """
    if model.method in ("constant-fraction", "mixed"):
        return ()
    residual = model.mark_strain_residual[is_stretched]
    rms = root_mean_square(residual)
    notes = []
    if expected > 0 and rms > _SCATTER_NOTICE * expected:
        notes.append(
            note("marks-differ", model.specimen, method=model.method, rms=rms, expected=expected)
        )
    # the median, so that one misread mark does not hide itself
    usual = max(expected, MAD_TO_DEVIATION * float(np.median(np.abs(residual))))
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
    """Say where the slack length grows, or a slack row is misread: strain refers to their mean."""
    growth = slack_growth(marks).length
    if growth:
        effect = growth / float(marks.far_thimble[marks.is_slack][0])
        code = "slack-length-grows" if effect < _SET else "slack-length-grows-far"
        return (note(code, marks.specimen, growth=growth, effect=effect),)
    rows = np.flatnonzero(marks.is_slack)
    if rows.size < 2:
        return ()
    columns = ("near_toe", "far_toe", "far_thimble")
    readings = np.stack([getattr(marks, name)[rows] for name in columns])
    apart = readings - np.median(readings, axis=1, keepdims=True)
    column, at = np.unravel_index(np.argmax(np.abs(apart)), apart.shape)
    reading = marks.reading_uncertainty
    if not marks.is_reading_stated:
        reading = max(reading, TAPE_UNCERTAINTY)
    difference = float(np.ptp(readings[column]))
    if difference <= _OUTLIER_NOTICE * sqrt(2) * reading:
        return ()
    tests = [marks.test[row] for row in rows]
    # of two nothing tells which
    wrong = f"{tests[0]} or {tests[1]}" if rows.size == 2 else tests[at]
    return (
        note(
            "slack-rows-differ",
            marks.specimen,
            column=columns[column],
            difference=difference,
            test=wrong,
        ),
    )


def _on_unlike_splices(marks: SpliceMarks) -> tuple[Note, ...]:
    """Say where one splice stretches much more than the other, though both carry one load.

    No splice law is fitted to the slack rows: nothing else shows a toe that is misread there.
    """
    if not 0 < np.count_nonzero(marks.is_slack) < marks.is_slack.size:
        return ()
    lengths = np.stack([marks.near_toe, marks.far_thimble - marks.far_toe])
    relaxed = lengths[:, marks.is_slack].mean(axis=1)
    grown = lengths[:, ~marks.is_slack].mean(axis=1) - relaxed
    little, much = np.sort(grown / relaxed)
    beyond = _OUTLIER_NOTICE * max(marks.reading_uncertainty, TAPE_UNCERTAINTY)
    # a grip in place of a splice does not stretch
    if _UNLIKE * little + beyond / relaxed.min() >= much or np.abs(grown).min() <= beyond:
        return ()
    return (note("splices-unlike", marks.specimen, near=grown[0] / relaxed[0],
                 far=grown[1] / relaxed[1]),)  # fmt: skip


# ratio of the extensions of two splices; those of WHOI-2005-10, Table 3, differ by a factor of 1.07
_UNLIKE = 1.5


def _on_reading_time(
    model: StrainModel, is_stretched: Bools, at_start: StrainModel
) -> tuple[str, ...]:
    """Effect of the time in a hold at which the tape was read."""
    force = np.array([model.tension_high])
    position = np.array([float(model.mark_position[is_stretched].max())])
    change = float(
        (
            strain_by_model(at_start, position=position, tension=force)
            - strain_by_model(model, position=position, tension=force)
        )[0]
    )
    end, start = (
        100 * root_mean_square(entry.mark_strain_residual[is_stretched])
        for entry in (model, at_start)
    )
    return (
        "marks are taken to be read as a hold ends, and then differ from the "
        f"splice law by {end:.2f} points of strain rms; read as it begins, {start:.2f} points, and "
        f"strain at the highest marked tension would be {100 * change:+.1f} points other",
    )


def _on_left_out(
    model: StrainModel, marks: SpliceMarks, is_stretched: Bools, failed_tests: Sequence[str]
) -> tuple[Note, ...]:
    """Stretched marks without a tension for the law: their log failed, or shows no hold."""
    rows = np.flatnonzero(~marks.is_slack & ~marks.is_unloading)
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
    n_used = int(is_stretched.sum())
    without_hold = rows.size - n_used - len(tests)
    if model.method == "mixed" and not np.isfinite(model.mark_tension[is_stretched]).any():
        notes.append(note("marks-without-tension", model.specimen, n_marks=n_used))
    elif model.method in ("tension-driven", "mixed") and without_hold > 0:
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
    >>> [remark, *_] = _remarks_on(model, marks, np.array([True]))
    >>> print(remark)  # doctest: +NORMALIZE_WHITESPACE, +ELLIPSIS
    new: strain by marks differs from the marks by 2.00 percentage points rms; tape reading explains
    only 0.68. ...
    """
    expected = sqrt(3) * marks.reading_uncertainty / model.coefficients["relaxed_free_length"]
    return (
        *_on_left_out(model, marks, is_stretched, failed_tests),
        *_on_constant_fraction(model, is_stretched),
        *_on_scatter(model, is_stretched, expected),
        *_on_slack(marks),
        *_on_unlike_splices(marks),
    )


_ELSEWHERE = 0.005  # of the gauge length: strain between two zeros that counts as different


def _without_marks(
    specimen: Specimen, method: StrainMethod, zero: ZeroStrain, length: float | None
) -> StrainModel:
    if method == "extensometer":
        return StrainModel(specimen.name, "extensometer")
    gauge = length if specimen.gauge_length is None else specimen.gauge_length
    if gauge is None or zero.position is None:
        raise DataError(
            f"strain of '{specimen.name}' by gauge-length lacks "
            + ("a gauge length" if gauge is None else "a position of zero strain"),
            needed="specimens.NAME.gauge_length or a displacement with reference_length"
            if gauge is None
            else "a rest at slack (no shorter than phases.minimum_duration), a displacement from "
            "slack (its reference_length read without tension), or a reference_tension through "
            "which the log rises",
            hint=None
            if gauge is None
            else "If the specimen is slack where the log begins, state the load there as zero of"
            " its channel. If gauge_length was read there under load, state reference_tension in"
            f" [specimens.{specimen.name}], a little above the first reading of the load",
        )
    spread = specimen.gauge_length_standard_uncertainty
    notes = [note("gauge-length-exact")] if spread is None else []
    if specimen.gauge_length is None:
        notes.append(note("gauge-length-from-reference", specimen.name, length=gauge))
    if zero.bent_at is not None:
        notes.append(note("bent-at-rest", specimen.name, length=zero.bent_at, gauge=gauge))
    if zero.is_behind_load:
        notes.append(note("zero-behind-load", specimen.name))
    if zero.reference_tension:
        notes.append(note("strain-from-tension", specimen.name, tension=zero.reference_tension))
    notes += _on_stated_zero(specimen.name, zero, gauge)
    return StrainModel(
        specimen.name,
        "gauge-length",
        {"reference_position": zero.position, "gauge_length": gauge},
        np.diag([zero.standard_uncertainty**2, 0.0 if spread is None else spread**2]),
        notes=tuple(notes),
        is_zero_logged=zero.is_logged,
        reference_tension=zero.reference_tension,
    )


def _on_stated_zero(name: str, zero: ZeroStrain, gauge: float) -> list[Note]:
    """A position that the layout states for the reference tension or slack, unlike the log."""
    if zero.position is None or zero.stated_position is None:
        return []
    if abs(zero.position - zero.stated_position) <= _ELSEWHERE * gauge:
        return []
    if not zero.reference_tension:
        beyond = zero.position - zero.stated_position
        return [note("slack-beyond-zero", name, beyond=beyond, strain=beyond / gauge)]
    return [
        note(
            "reference-tension-elsewhere", name, tension=zero.reference_tension,
            stated=zero.stated_position, found=zero.position,
        )
    ]  # fmt: skip


def _default_method(
    specimen: Specimen, readings: PooledMarks | None, has_extensometer: bool
) -> StrainMethod:
    if readings is not None:
        return "mixed"
    if has_extensometer:
        return "extensometer"
    if specimen.gauge_length is not None:
        return "gauge-length"
    raise DataError(
        f"no strain method applies to '{specimen.name}'",
        needed="splice marks, a strain channel, or a gauge length where there are no splices",
        hint='Give strain = { marks = "marks.csv" } under [defaults], or gauge_length under each'
        " [specimens.NAME], in campaign.toml.",
    )


def _by_marks(readings: PooledMarks, average: SpliceAverage | None) -> StrainModel | None:
    """Average over the laws of the same splices; None where the marks reject all laws."""
    try:
        return _fit_mixed(readings, average).model
    except DataError:
        return None


def fit_strain_model(
    specimen: Specimen,
    *,
    test_id: str,
    marks: SpliceMarks | None = None,
    mark_tension: ArrayLike | None = None,
    mark_tension_at_start: ArrayLike | None = None,
    mark_tension_on_arrival: ArrayLike | None = None,
    settings: StrainSettings | None = None,
    has_extensometer: bool = False,
    zero: ZeroStrain | None = None,
    reference_length: float | None = None,
    failed_tests: Sequence[str] = (),
    average: SpliceAverage | None = None,
) -> StrainModel:
    """Fit the strain method of one specimen in one test.

    Parameters
    ----------
    specimen : Specimen
        Its ``gauge_length`` with its standard uncertainty is used by that method.
    test_id : str
        Test to which the model will be applied.
    marks : SpliceMarks, optional
        Of this specimen over the whole campaign.
    mark_tension : array_like, shape (n_marks,), optional
        From `reduction.stages.strain.mark_readings.measure_mark_tension`, row by row of ``marks``;
        NaN where no hold was found. [N]
    mark_tension_at_start : array_like, shape (n_marks,), optional
        The same at the start of each hold, where the tape may have been read too. [N]
    mark_tension_on_arrival : array_like, shape (n_marks,), optional
        The same as the crosshead stopped; only the friction of the splices is found with it. [N]
    settings : StrainSettings, optional
        ``method`` None averages: see Notes.
    has_extensometer : bool
        Whether the log has a strain channel.
    zero : ZeroStrain, optional
        Where strain is zero, for ``gauge-length``.
    reference_length : float, optional
        Length of the whole specimen at zero strain, for a ``gauge-length`` that was asked for
        and is not stated. [m]
    failed_tests : sequence of str
        Tests whose log could not be read, so that their marks have no tension. [1]
    average : SpliceAverage, optional
        Average over the laws of the splices, from `average_over_laws`; computed if not given.

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
    Without a stated method: the average over the laws of the splices that the marks do not reject
    (`reduction.stages.strain.splice_laws`); without marks the extensometer, else the gauge length.

    ``mixed`` and ``tension-driven`` use all marks of the specimen, since its splices are the
    same in every test; the others use the test's own marks, or all where the test
    has none.  The relaxed lengths are means over all slack rows; only
    ``constant-fraction`` takes the test's own row, as the report does.

    The covariance holds the errors common to all samples: reading errors of the tape, or the
    stated standard uncertainty of the gauge length; ``law_covariance`` holds the uncertainty of the
    law.  A method that was asked for keeps the average over the laws as ``by_marks``, by which
    its own error is judged.

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
    >>> model.method, bool(abs(model.strain_slope_ratio - 0.873) < 0.005)
    ('mixed', True)
    """
    stated = None if settings is None else settings.method
    readings = None
    if marks is not None:
        tension = np.full(len(marks.test), np.nan) if mark_tension is None else mark_tension
        is_own = np.array([test == test_id for test in marks.test], dtype=bool)
        early, first = (
            np.empty(0) if one is None else np.asarray(one, dtype=np.float64)
            for one in (mark_tension_at_start, mark_tension_on_arrival)
        )
        readings = PooledMarks(
            marks, np.asarray(tension, dtype=np.float64), is_own, early, first
        )  # fmt: skip
        if readings.tension.shape != is_own.shape:
            raise DataError(
                "tensions and marks do not pair up",
                found=f"{readings.tension.size} tensions for {is_own.size} marks",
                needed="one tension a row, NaN where it is not known",
            )
    method = stated or _default_method(specimen, readings, has_extensometer)
    if method in ("extensometer", "gauge-length"):
        return _without_marks(specimen, method, zero or ZeroStrain(), reference_length)
    if readings is None:
        raise DataError(
            f"strain of '{specimen.name}' by {method} needs splice marks",
            found="no marks of this specimen",
            needed="rows of it in the marks file",
        )
    used = readings.stretched_rows(method)
    check_marks(readings.marks, tests=sorted({readings.marks.test[row] for row in used}))
    if method == "mixed":
        model, fit = _average_at_marks(readings, average)
        is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
        made: tuple[str, ...] = (_laws_in_words(fit.average),)
    else:
        model = fit_to_marks(method, readings)
        model = replace(model, by_marks=_by_marks(readings, average))
        is_stretched = np.array([hold != "slack" for hold in model.mark_hold], dtype=bool)
        made = model.made
    if model.method == "tension-driven" and mark_tension_at_start is not None:
        at_start = fit_to_marks(
            "tension-driven", replace(readings, tension=readings.tension_at_start)
        )
        made += _on_reading_time(model, is_stretched, at_start)
    # a method that was asked for and needs no tension loses nothing when a log fails
    lost = failed_tests if stated in (None, "tension-driven", "mixed") else ()
    remarks = _remarks_on(model, readings.marks, is_stretched, failed_tests=lost)
    return replace(model, notes=(*model.notes, *remarks), made=made)


def _laws_in_words(average: SpliceAverage) -> str:
    """One line of the history: each law with its misfit and its weight."""
    laws = (
        f"{law.name} (chi-square {law.chi_square:.3g} of {law.freedom}, weight {weight:.2g})"
        for law, weight in zip(average.laws, average.weight, strict=True)
    )
    return f"laws of the splices fitted to the marks: {', '.join(laws)}"

"""History of a specimen before a test, its strain model and its instruments.

References
----------
.. [1] K. R. Bitting, "The Dynamic Behavior of Nylon and Polyester Line," U.S. Coast Guard R&D
   Center, Groton, CT, Rep. CG-D-39-80, Apr. 1980, App. D.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import get_args

import numpy as np

from reduction.batch.survey import Survey, as_reduction_error
from reduction.campaign.plan import Campaign
from reduction.pipeline.extremes import (
    greatest_strain,
    growth_of_slack_length,
    judge_strain,
)
from reduction.record.contributions import InstrumentErrors, StatedErrors
from reduction.record.errors import DataError, ReductionError
from reduction.record.measurement import Floats, Specimen, SpliceMarks
from reduction.record.notes import Note, note
from reduction.stages.reduced_test import History
from reduction.stages.strain.mark_readings import MarkReading
from reduction.stages.strain.splice_laws import SpliceAverage
from reduction.stages.strain.strain_fit import PooledMarks, average_over_laws, fit_strain_model
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.zero_strain import ZeroStrain

Models = Mapping[tuple[str, str], StrainModel]

Place = tuple[int, int]

_ALIKE = 0.02  # loads within this ratio are one level, as for levels in a look-up


@dataclass(frozen=True)
class EarlierTests:
    """All tests of a campaign in order.

    It is shared by all tests, so that common questions are answered once.  ``placed`` holds the
    tests of each specimen with a known position in its order, oldest first; ``greatest_strain`` is
    by test and specimen [1], NaN if a test failed or has no value; ``of_log`` is the first test of
    each log.
    """

    surveys: Sequence[Survey]
    models: Models
    placed: Mapping[str, Sequence[tuple[Place, Survey]]]
    greatest_strain: Mapping[tuple[str, str], float]
    of_log: Mapping[str, Survey]


def earlier_tests_of(surveys: Sequence[Survey], models: Models) -> EarlierTests:
    """Arrange the tests of a campaign in order."""
    placed: dict[str, list[tuple[Place, Survey]]] = {}
    strain: dict[tuple[str, str], float] = {}
    of_log: dict[str, Survey] = {}
    for entry in surveys:
        plan = entry.plan
        of_log.setdefault(plan.log, entry)
        for name in plan.specimens:
            model = models.get((plan.id, name))
            strain[plan.id, name] = greatest_strain(entry.extremes, name, model)
            if plan.order is not None and plan.part_of is None:
                placed.setdefault(name, []).append(((plan.order, plan.step_place), entry))
    for before in placed.values():
        before.sort(key=itemgetter(0))
    return EarlierTests(surveys, models, placed, strain, of_log)


def _set_after_rest(
    survey: Survey, earlier: Sequence[Survey], name: str, free_length: float
) -> tuple[float, float, float]:
    """Increase in the taut length of the specimen since its first test. [1]."""
    if not earlier:
        return float("nan"), float("nan"), float("nan")
    return growth_of_slack_length(
        earlier[0].extremes, survey.extremes, name, free_length=free_length
    )


def _with_earlier_steps(survey: Survey, past: EarlierTests) -> Survey:
    """The test itself, or the test of which it repeats a part."""
    return past.of_log.get(survey.plan.part_of or "", survey)


def _place(survey: Survey, past: EarlierTests) -> Place | None:
    """Position in the order of tests; a partial test has that of the whole one."""
    order = _with_earlier_steps(survey, past).plan.order
    return None if order is None else (order, survey.plan.step_place)


def _earlier(survey: Survey, past: EarlierTests, name: str) -> list[Survey]:
    """Earlier tests of a specimen, oldest first."""
    place = _place(survey, past)
    if place is None:
        return []
    placed = past.placed.get(name, ())
    return [entry for _, entry in placed[: bisect_left(placed, place, key=itemgetter(0))]]


def _slipped_before(survey: Survey, own: Survey, earlier: Sequence[Survey], name: str) -> float:
    """Slip of the splices before a test [m].

    A burst from a longer log uses the clock of that log.
    """
    slips = [slip for entry in earlier for slip in entry.slips.get(name, ())]
    if own is not survey:
        slips += [slip for slip in own.slips.get(name, ()) if slip.time <= survey.first_time]
    return sum((slip.length for slip in slips), start=0.0)


def _earlier_cycles(earlier: Sequence[Survey], own: Survey, before: int | None) -> float:
    """Tension cycles before a test, logged or not; NaN if an earlier test failed."""
    if any(entry.error is not None for entry in earlier):
        return float("nan")
    in_logs = sum(one.n_cycles + one.n_cycles_between for one in earlier)
    return float(_unlogged_cycles(earlier, own, before) + in_logs)


def _unlogged_cycles(earlier: Sequence[Survey], own: Survey, before: int | None) -> int:
    """Tension cycles before a test that are stated only as a number."""
    # the steps of a log share its history
    between = {entry.plan.log: entry.plan.unlogged_cycles or 0 for entry in (*earlier, own)}
    return (before or 0) + sum(between.values())


def _earlier_flex_cycles(
    earlier: Sequence[Survey], survey: Survey, before: int | None, surveys: Sequence[Survey]
) -> float:
    """Flexing cycles before a test."""
    is_counted = any(entry.plan.n_flex_cycles is not None for entry in surveys)
    flexed = {entry.plan.log: entry.plan.n_flex_cycles or 0 for entry in earlier}
    if (before is None and not is_counted) or flexed.get(survey.plan.log):
        return float("nan")
    return float((before or 0) + sum(flexed.values()))


def history_of(survey: Survey, past: EarlierTests, campaign: Campaign) -> History | None:
    """Earlier maximum strain and tension, and cumulative cycles, of each specimen."""
    if _place(survey, past) is None:
        return None
    nothing = float("nan")
    tests: list[tuple[str, ...]] = []
    strain, tension, cycles, flex, left, slipped = [], [], [], [], [], []
    own = _with_earlier_steps(survey, past)
    for name in survey.plan.specimens:
        earlier = _earlier(survey, past, name)
        tests.append(tuple(entry.plan.id for entry in earlier))
        strain.append(_greatest([past.greatest_strain[entry.plan.id, name] for entry in earlier]))
        tension.append(
            _greatest([entry.extremes.greatest_tension.get(name, nothing) for entry in earlier])
        )
        specimen = campaign.specimens[name]
        cycles.append(_earlier_cycles(earlier, own, specimen.earlier_cycles))
        of_name = [entry for entry in past.surveys if name in entry.plan.specimens]
        flex.append(_earlier_flex_cycles(earlier, survey, specimen.earlier_flex_cycles, of_name))
        model = past.models.get((survey.plan.id, name))
        free = nothing if model is None else model.relaxed_length
        left.append(_set_after_rest(survey, earlier, name, free))
        marks = campaign.marks.get(name)
        is_marked = marks is not None and survey.plan.log in marks.test
        slipped.append(0.0 if is_marked else _slipped_before(survey, own, earlier, name))
    return History(
        earlier_tests=tuple(tests),
        earlier_maximum_strain=np.array(strain),
        earlier_maximum_tension=np.array(tension),
        earlier_cycles=np.array(cycles),
        permanent_set=np.array([value for value, _, _ in left]),
        permanent_set_standard_uncertainty=np.array([spread for _, spread, _ in left]),
        permanent_set_by_tension=np.array([slope for _, _, slope in left]),
        splices_slipped_by=np.array(slipped),
        earlier_flex_cycles=None if np.isnan(flex).all() else np.array(flex),
    )


def _greatest(values: Sequence[float]) -> float:
    """The maximum; NaN if any value is unknown, or there are none."""
    return float(np.max(values)) if values else float("nan")


def history_remarks(survey: Survey, past: EarlierTests, campaign: Campaign) -> tuple[Note, ...]:
    """Uncertain points in the position of a test in its specimens' history."""
    plan = survey.plan
    remarks = (
        *_unknown(survey, past), *_unlogged(survey, past, campaign),
        *_after_greater_load(survey, past),
    )  # fmt: skip
    shared = [
        name
        for name in plan.specimens
        if any(name in other.plan.specimens for other in past.surveys if other.plan.log != plan.log)
    ]
    if plan.order is None and shared and plan.part_of is None:
        return (note("no-order", specimens=", ".join(shared)),)
    return remarks


def _unlogged(survey: Survey, past: EarlierTests, campaign: Campaign) -> tuple[Note, ...]:
    """Note on earlier cycles that are stated only as a number."""
    if _place(survey, past) is None:
        return ()
    remarks = []
    own = _with_earlier_steps(survey, past)
    for name in survey.plan.specimens:
        before = campaign.specimens[name].earlier_cycles
        count = _unlogged_cycles(_earlier(survey, past, name), own, before)
        if count:
            remarks.append(note("cycles-in-no-log", name, n_cycles=count))
    return tuple(remarks)


def _after_greater_load(survey: Survey, past: EarlierTests) -> tuple[Note, ...]:
    """Note on earlier loads above those of the test: in [1]_ K_0 depends on the maximum."""
    remarks = []
    for name in survey.plan.specimens:
        own = survey.extremes.greatest_tension.get(name, np.nan)
        loads = {
            entry.plan.id: entry.extremes.greatest_tension.get(name, np.nan)
            for entry in _earlier(survey, past, name)
        }
        # if any is unknown, so is the maximum
        if (greatest := _greatest([*loads.values()])) > (1 + _ALIKE) * own:
            test = max(loads, key=loads.__getitem__)
            remarks.append(
                note("after-a-greater-load", name, test=test, earlier=greatest, tension=own)
            )
    return tuple(remarks)


def _unknown(survey: Survey, past: EarlierTests) -> tuple[Note, ...]:
    """Note on earlier tests with a missing number, and on the number affected here."""
    failed: dict[str, list[str]] = {}
    bare: dict[str, list[str]] = {}
    for name in survey.plan.specimens:
        for entry in _earlier(survey, past, name):
            if entry.error is not None:
                failed.setdefault(entry.plan.id, []).append(name)
            elif np.isnan(past.greatest_strain[entry.plan.id, name]):
                bare.setdefault(entry.plan.id, []).append(name)
    return (
        *(
            note("earlier-test-failed", test=test, specimens=", ".join(names))
            for test, names in failed.items()
        ),
        *(
            note("earlier-test-without-strain", test=test, specimens=", ".join(names))
            for test, names in bare.items()
        ),
    )


def _pooled(marks: SpliceMarks, surveys: Sequence[Survey], reading: MarkReading) -> Floats:
    """One tension per mark, in the order of the marks; NaN if its test could not be read."""
    tension = np.full(len(marks.test), np.nan)
    of_test = np.array(marks.test)
    for survey in surveys:
        values = survey.mark_tension.get(reading, {}).get(marks.specimen)
        if values is not None:
            tension[of_test == survey.plan.log] = values
    return tension


def _failed_logs(surveys: Sequence[Survey]) -> tuple[str, ...]:
    """Unreadable logs, whose marks have no tension."""
    sound = {
        survey.plan.log
        for survey in surveys
        if survey.error is None or any(survey.mark_tension.values())
    }
    return tuple(dict.fromkeys(s.plan.log for s in surveys if s.plan.log not in sound))


def _load_cells(campaign: Campaign, surveys: Sequence[Survey], specimen: str) -> dict[str, str]:
    """Load cell used for the marks of a specimen, by log."""
    return {
        survey.plan.log: campaign.uncertainty.load_cell_name(
            survey.plan.attributes.get("load_cell", ""),
            channel=survey.plan.specimens.index(specimen) + 1,
        )
        for survey in surveys
        if specimen in survey.plan.specimens
    }


def fit_strain_models(
    campaign: Campaign, surveys: Sequence[Survey]
) -> tuple[dict[tuple[str, str], StrainModel], dict[str, ReductionError]]:
    """Fit the strain model of each specimen in each test."""
    pooled = {
        reading: {name: _pooled(marks, surveys, reading) for name, marks in campaign.marks.items()}
        for reading in get_args(MarkReading)
    }
    averages = {
        name: _average(marks, pooled["end"][name], pooled["start"][name])
        for name, marks in campaign.marks.items()
    }
    cells = {name: _load_cells(campaign, surveys, name) for name in campaign.specimens}
    failed = _failed_logs(surveys)
    contradicted = _contradicted(surveys)
    across = {name: _across_slip(marks, surveys) for name, marks in campaign.marks.items()}
    models: dict[tuple[str, str], StrainModel] = {}
    errors: dict[str, ReductionError] = {}
    for survey in surveys:
        if survey.error is not None or survey.plan.kind == "stepwise":
            continue
        for name in survey.plan.specimens:
            try:
                _refuse_contradicted(survey, name, contradicted)
                zero = survey.zero_strain.get(name, ZeroStrain())
                model = fit_strain_model(
                    campaign.specimens[name],
                    test_id=survey.plan.log,
                    marks=campaign.marks.get(name),
                    mark_tension=pooled["end"].get(name),
                    mark_tension_at_start=pooled["start"].get(name),
                    mark_tension_on_arrival=pooled["arrival"].get(name),
                    settings=survey.plan.settings.strain,
                    has_extensometer=survey.extremes.has_extensometer,
                    zero=_with_error_of_load(zero, campaign),
                    reference_length=survey.reference_length,
                    failed_tests=failed,
                    average=averages.get(name),
                )
                read_by = tuple(cells[name].get(test, "") for test in model.mark_test)
                of_strain = judge_strain(
                    survey.extremes,
                    model,
                    test_id=survey.plan.id,
                    can_push=campaign.specimens[name].can_push,
                )
                is_pooled = model.method in ("mixed", "tension-driven") and not model.splice_slip
                of_slip = across.get(name, ()) if is_pooled else ()
                models[survey.plan.id, name] = replace(
                    model, mark_load_cell=read_by, notes=(*of_strain, *of_slip, *model.notes)
                )
            except Exception as error:
                # fails only this test, even for a defect of this program
                errors.setdefault(survey.plan.id, as_reduction_error(error))
    return models, errors


def _across_slip(marks: SpliceMarks, surveys: Sequence[Survey]) -> tuple[Note, ...]:
    """Note splice slips between marks that are used together.

    Marks of a test are read before its cycles.
    """
    order = {one.plan.log: one.plan.order for one in surveys if one.plan.order is not None}
    loaded = [
        order[test]
        for test, is_slack in zip(marks.test, marks.is_slack, strict=True)
        if test in order and not is_slack
    ]
    for survey in surveys:
        place = order.get(survey.plan.log)
        if (
            place is not None
            and survey.slips.get(marks.specimen)
            and min(loaded, default=place + 1) <= place < max(loaded, default=place)
        ):
            return (note("marks-across-slip", marks.specimen, test=survey.plan.id),)
    return ()


def _contradicted(surveys: Sequence[Survey]) -> dict[str, DataError]:
    """First mark row of each specimen that the crosshead of its test contradicts."""
    found: dict[str, DataError] = {}
    for survey in surveys:
        for name, error in survey.mark_errors.items():
            found.setdefault(name, error)
    return found


def _refuse_contradicted(survey: Survey, name: str, contradicted: Mapping[str, DataError]) -> None:
    """Refuse a test whose strain depends on marks of another specimen.

    Marks of a specimen are pooled: a wrong row in one test affects the strain in all.
    """
    method = survey.plan.settings.strain.method
    if method in ("extensometer", "gauge-length"):
        return
    error = survey.mark_errors.get(name) or contradicted.get(name)
    if error is not None:
        raise error


def _with_error_of_load(zero: ZeroStrain, campaign: Campaign) -> ZeroStrain:
    """Add the position error at the reference tension from the stated load-cell errors."""
    stated = campaign.uncertainty
    load = np.hypot(stated.tension_offset, stated.tension_gain * zero.reference_tension)
    spread = float(np.hypot(zero.standard_uncertainty, zero.compliance * load))
    return replace(zero, standard_uncertainty=spread)


def _average(marks: SpliceMarks, tension: Floats, at_start: Floats) -> SpliceAverage | None:
    """Average of the splice laws of a specimen, common to its tests; None if each has its own.

    The latter applies without tensions, or without a law, which each test then reports.
    """
    readings = PooledMarks(marks, tension, np.zeros(tension.size, dtype=bool), at_start)
    if not readings.knows_tension:
        return None
    try:
        return average_over_laws(readings)
    except ReductionError:
        return None


def instruments_of(
    campaign: Campaign, survey: Survey, models: Sequence[StrainModel]
) -> tuple[InstrumentErrors, ...]:
    """Stated errors of each specimen, with the names under which tests share them."""
    plan = survey.plan
    # machine deflection follows the sum of the tensions, assumed equal
    stated = replace(
        campaign.uncertainty,
        machine_compliance=campaign.uncertainty.machine_compliance * len(models),
    )
    of_channels = (
        _with_friction(stated, model).of_channel(
            model.specimen,
            channel=number,
            test=plan.log,
            load_cell=plan.attributes.get("load_cell", ""),
            machine=plan.attributes.get("machine", ""),
            strain_model=_name_of(model, plan.log),
        )
        for number, model in enumerate(models, start=1)
    )
    return tuple(
        _with_readings(
            replace(
                errors,
                splice_slip=(model.by_marks or model).splice_slip,
                position_of_scale_zero=survey.reference_length or 0.0,
            ),
            campaign.specimens[model.specimen],
        )
        for errors, model in zip(of_channels, models, strict=True)
    )


def _with_friction(stated: StatedErrors, model: StrainModel) -> StatedErrors:
    """Add the friction found from marks on the way down, if any; 0 without splices."""
    fitted = model.by_marks or model
    if "relaxed_splice_length" not in fitted.coefficients:
        return replace(stated, splice_friction=0.0)
    found = fitted.splice_friction
    if not np.isfinite(found):
        return stated
    return replace(stated, splice_friction=found, is_splice_friction_known=True)


def stepwise_instruments(campaign: Campaign, survey: Survey) -> tuple[InstrumentErrors, ...]:
    """Stated errors of a test with weights, which has no channels and no strain model."""
    return tuple(
        _with_readings(
            campaign.uncertainty.of_channel(
                name,
                channel=number,
                test=survey.plan.log,
                load_cell=survey.plan.attributes.get("load_cell", "weights"),
            ),
            campaign.specimens[name],
        )
        for number, name in enumerate(survey.plan.specimens, start=1)
    )


def _name_of(model: StrainModel, log: str) -> str:
    """Name of a strain model; models with different coefficients have different names."""
    # constant-fraction uses the relaxed length in its own slack row, whatever the source of its
    # share
    has_own_length = model.method == "constant-fraction" and log in model.mark_test
    is_own = model.marks_from.startswith("this test") or has_own_length
    return f"{model.specimen}, {model.method}" + (f", marks of {log}" if is_own else "")


def _with_readings(errors: InstrumentErrors, specimen: Specimen) -> InstrumentErrors:
    """Give a diameter without a stated error the uncertainty of the mean of its readings.

    A stated area gets the error of the circle of the same area. A stated error of diameters is not
    one of a specimen without a diameter.
    """
    if not specimen.has_area:
        return replace(errors, diameter=0.0)
    if specimen.cross_section:
        readings = 0 if errors.area else len(specimen.cross_section)
        share = errors.area or specimen.area_scatter / specimen.area
        across = float(np.sqrt(4 * specimen.area / np.pi)) * share / 2
        return replace(
            errors, diameter=across if np.isfinite(across) else 0.0, diameter_readings=readings
        )
    scatter = specimen.diameter_scatter
    if errors.diameter or not np.isfinite(scatter) or scatter == 0:
        return errors
    return replace(errors, diameter=scatter, diameter_readings=len(specimen.diameter))

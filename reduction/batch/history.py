"""What each specimen had seen before a test, from the order of its tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.batch.survey import Survey
from reduction.campaign.plan import Campaign
from reduction.pipeline.extremes import greatest_strain, growth_of_slack_length
from reduction.product import History
from reduction.strain.model import StrainModel

__all__ = ["history_of", "history_remarks"]

Models = Mapping[tuple[str, str], StrainModel]


def _greatest_strain(survey: Survey, name: str, models: Models) -> float:
    """Greatest strain of a specimen in a test; NaN where it failed, or has no number of it."""
    return greatest_strain(survey.extremes, name, models.get((survey.plan.id, name)))


def _set_after_rest(
    survey: Survey, earlier: Sequence[Survey], name: str, free_length: float
) -> tuple[float, float, float]:
    """Growth of the length at which the specimen becomes taut, since its first test. [1]."""
    if not earlier:
        return float("nan"), float("nan"), float("nan")
    return growth_of_slack_length(
        earlier[0].extremes, survey.extremes, name, free_length=free_length
    )


def _whole(survey: Survey, surveys: Sequence[Survey]) -> Survey:
    """The test itself, or that of which it repeats a part."""
    for entry in surveys:
        if entry.plan.log == survey.plan.part_of:
            return entry
    return survey


def _place(survey: Survey, surveys: Sequence[Survey]) -> tuple[int, int] | None:
    """Place in the order of tests; a test that is a part of another has the place of that one."""
    order = _whole(survey, surveys).plan.order
    return None if order is None else (order, survey.plan.step_place)


def _earlier(survey: Survey, surveys: Sequence[Survey], name: str) -> list[Survey]:
    """Tests of a specimen before a test, oldest first."""
    place = _place(survey, surveys)
    before = [
        ((entry.plan.order, entry.plan.step_place), entry)
        for entry in surveys
        if entry.plan.order is not None
        and entry.plan.part_of is None
        and name in entry.plan.specimens
    ]
    return [
        entry
        for at, entry in sorted(before, key=lambda pair: pair[0])
        if place is not None and at < place
    ]


def _earlier_cycles(earlier: Sequence[Survey], own: Survey, before: int | None) -> float:
    """Cycles of tension before a test, logged or not; NaN where an earlier test failed."""
    if any(entry.error is not None for entry in earlier):
        return float("nan")
    return float(_unlogged_cycles(earlier, own, before) + sum(one.n_cycles for one in earlier))


def _unlogged_cycles(earlier: Sequence[Survey], own: Survey, before: int | None) -> int:
    """Cycles of tension before a test of which the campaign has the number alone."""
    # the steps of a log share what came before it
    between = {entry.plan.log: entry.plan.unlogged_cycles or 0 for entry in (*earlier, own)}
    return (before or 0) + sum(between.values())


def _earlier_flex_cycles(
    earlier: Sequence[Survey], survey: Survey, before: int | None, surveys: Sequence[Survey]
) -> float:
    """Cycles of flexing before a test.

    NaN where the campaign says nothing of flexing of the specimen, or the test is a later step
    of a log in which it was flexed: how much of it came before is not known.
    """
    is_counted = any(entry.plan.n_flex_cycles is not None for entry in surveys)
    flexed = {entry.plan.log: entry.plan.n_flex_cycles or 0 for entry in earlier}
    if (before is None and not is_counted) or flexed.get(survey.plan.log):
        return float("nan")
    return float((before or 0) + sum(flexed.values()))


def history_of(
    survey: Survey, surveys: Sequence[Survey], models: Models, campaign: Campaign
) -> History | None:
    """Earlier maximum strain and tension and cumulative cycles of each specimen.

    Parameters
    ----------
    survey : Survey
        The test; one that is a part of another has the history of that one.
    surveys : sequence of Survey
        All tests of the campaign.
    models : mapping of (test, specimen) to StrainModel
        How position becomes strain.
    campaign : Campaign
        What its specimens had seen before.

    Returns
    -------
    history : History or None
        None where the test has no place in the order.  A number is NaN where an earlier test
        failed or has none of it: a part of a sum, or of a maximum, would pass for the whole.
    """
    if _place(survey, surveys) is None:
        return None
    nothing = float("nan")
    tests: list[tuple[str, ...]] = []
    strain, tension, cycles, flex, left = [], [], [], [], []
    own = _whole(survey, surveys)
    for name in survey.plan.specimens:
        earlier = _earlier(survey, surveys, name)
        tests.append(tuple(entry.plan.id for entry in earlier))
        strain.append(_greatest([_greatest_strain(entry, name, models) for entry in earlier]))
        tension.append(
            _greatest([entry.extremes.greatest_tension.get(name, nothing) for entry in earlier])
        )
        specimen = campaign.specimens[name]
        cycles.append(_earlier_cycles(earlier, own, specimen.earlier_cycles))
        of_name = [entry for entry in surveys if name in entry.plan.specimens]
        flex.append(_earlier_flex_cycles(earlier, survey, specimen.earlier_flex_cycles, of_name))
        model = models.get((survey.plan.id, name))
        free = nothing if model is None else model.relaxed_length
        left.append(_set_after_rest(survey, earlier, name, free))
    return History(
        earlier_tests=tuple(tests),
        earlier_maximum_strain=np.array(strain),
        earlier_maximum_tension=np.array(tension),
        earlier_cycles=np.array(cycles),
        permanent_set=np.array([value for value, _, _ in left]),
        permanent_set_standard_uncertainty=np.array([spread for _, spread, _ in left]),
        permanent_set_by_tension=np.array([slope for _, _, slope in left]),
        earlier_flex_cycles=None if np.isnan(flex).all() else np.array(flex),
    )


def _greatest(values: Sequence[float]) -> float:
    """The greatest; NaN where one of them is not known, or there is none."""
    return float(np.max(values)) if values else float("nan")


def history_remarks(
    survey: Survey, surveys: Sequence[Survey], models: Models, campaign: Campaign
) -> tuple[str, ...]:
    """What the campaign leaves open about the place of a test in its specimens' history.

    Parameters
    ----------
    survey : Survey
        The test.
    surveys : sequence of Survey
        All tests of the campaign.
    models : mapping of (test, specimen) to StrainModel
        How position becomes strain.
    campaign : Campaign
        What its specimens had seen before.

    Returns
    -------
    remarks : tuple of str
        Sentences for a reader of the product; empty where nothing is open.
    """
    plan = survey.plan
    remarks = (*_unknown(survey, surveys, models), *_unlogged(survey, surveys, campaign))
    if plan.part_of is not None:
        return (
            f"a part of {plan.part_of}: its history is that of the whole; cycles of the whole "
            "before this part are not counted",
            *remarks,
        )
    shared = [
        name
        for name in plan.specimens
        if any(name in other.plan.specimens for other in surveys if other.plan.log != plan.log)
    ]
    if plan.order is None and shared:
        return (
            f"no place in the order of tests is given for {', '.join(shared)}: what earlier tests "
            "did to them is not known here; set order",
        )
    return remarks


def _unlogged(survey: Survey, surveys: Sequence[Survey], campaign: Campaign) -> tuple[str, ...]:
    """Earlier cycles of which the campaign has the number alone."""
    if _place(survey, surveys) is None:
        return ()
    remarks = []
    own = _whole(survey, surveys)
    for name in survey.plan.specimens:
        before = campaign.specimens[name].earlier_cycles
        count = _unlogged_cycles(_earlier(survey, surveys, name), own, before)
        if count:
            remarks.append(
                f"{name}: {count} earlier cycles are in no log: earlier_maximum_strain and "
                "earlier_maximum_tension are of the logged tests alone"
            )
    return tuple(remarks)


def _unknown(survey: Survey, surveys: Sequence[Survey], models: Models) -> tuple[str, ...]:
    """Earlier tests of which a number is lacking, and what has none for it here."""
    failed: dict[str, list[str]] = {}
    bare: dict[str, list[str]] = {}
    for name in survey.plan.specimens:
        for entry in _earlier(survey, surveys, name):
            if entry.error is not None:
                failed.setdefault(entry.plan.id, []).append(name)
            elif np.isnan(_greatest_strain(entry, name, models)):
                bare.setdefault(entry.plan.id, []).append(name)
    return (
        *(
            f"earlier test {test} failed: what it did to {', '.join(names)} is not known, and "
            "earlier_cycles, earlier_maximum_strain and earlier_maximum_tension have no number"
            for test, names in failed.items()
        ),
        *(
            f"earlier test {test} has no strain of {', '.join(names)}: earlier_maximum_strain "
            "has no number"
            for test, names in bare.items()
        ),
    )

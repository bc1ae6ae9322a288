"""Checks the statements of a campaign against its logs: units, sizes, levels, plans.

Each test is compared with bands for its kind of specimen, with the statements about it, and with
the other tests of its specimens.  A mismatch gives a warning that names the reading that would fit;
docs/plausibility.md lists them all.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, repeat
from typing import NamedTuple

import numpy as np

from reduction.batch.survey import Survey
from reduction.batch.test_history import Models
from reduction.campaign.plan import Campaign, ExperimentPlan, TestPlan
from reduction.experiments.designs import engineering_levels
from reduction.experiments.run_sheet import NOT_OF_PLAN
from reduction.pipeline.extremes import greatest_strain
from reduction.prediction.hose_comparison import loading_of
from reduction.prediction.hose_prediction import doubts_of_design
from reduction.prediction.hose_product import HoseDesign
from reduction.prediction.hose_tension import predict_hose
from reduction.quantities.units import Dimension, scale_to_si
from reduction.readers.layout import CLOCK, Layout
from reduction.record.arrays import MAD_TO_DEVIATION
from reduction.record.errors import ReductionError, SettingsError
from reduction.record.measurement import Bools, Floats, Integers, Specimen, SpliceMarks
from reduction.record.notes import Note, note
from reduction.stages.plausible_bands import Bands, bands_of, readings_that_fit, words_of_ratio
from reduction.stages.strain.strain_model import StrainModel, strain_by_model
from reduction.stages.strain.stress import constant_volume_diameter

_STRENGTH_REACHED = 1.02  # of the rated break strength, reached by a test that did not fail

_LITTLE_OF_STRENGTH = 0.004

_RATE = 1.3  # ratio of found to stated rate, or its inverse

_TARGET = 1.17

# s; a machine for low-frequency tests of ropes takes minutes. Ropes at 0.1 Hz in ms take 2.8 h
_SLOWEST = 1800.0

_FASTEST = 10.0  # m/s, from valley to peak: dampers are cycled at up to 6

_LONGER = 1.05  # ratio of gauge length to length at slack

_OF_HOSE = 0.75  # ratio of a hose's gauge length to the length between its flanges

_AT_SLACK = 0.03  # strain from the extensometer

_STROKE = 1.5  # ratio of extensometer strain to strain from the stroke

# the same ratio in the tests of one specimen: how much they differ, and a test from the others
_ONE_RATIO, _OTHER_RATIO = 1.1, 1.15

_JUMP = 1.85  # ratio of peak tension over peak strain, between similar tests of one specimen

_JUMP_OF_KINDS = 2.5  # the same between a slow pull and cycles

_LIKE_STRAIN, _LIKE_RATE = 1.3, 2.2

_FEWEST_ON_CURVE = 3  # tests, including the one compared with the others

_OFF_CURVE = 1.7  # ratio of peak tension to that of the others at the same strain

# in the scatter of others, with so many more of the usual scatter: of peaks about their curve, and
# of the ratio of two specimens; exponent of a rope and its scatter
_OFF_SCATTER, _AS_IF = 4.0, 2
_OF_PEAKS, _OF_RATIOS, _OF_SLOPES = 0.1, 0.05, (1.7, 0.4)

_SOFTENED = 3.0  # softening of rubber after a larger stretch: half in WHOI-2005-10, more in others

_GREATER = 1.05  # ratio of stretch before a test to that in the test

_MOST_COMPARED = 40  # tests of one specimen

_FEWEST_LIKE = 3  # other specimens of the same kind

# a batch: so many others at one strain or load, after as many tests; how far one may lie off their
# median, in their scatter and at least. Of sound ones at most 0.3 % do at a scatter of 10 %
_FEWEST_OF_BATCH, _ONE_LEVEL, _OF_SCATTER, _LEAST_OFF = 7, 1.05, 8.0, 1.25

_LEAST_OFF_OWN, _MOST_OWN = 1.1, 5  # the same beside other tests of its own; how many of these

_FEWEST_COPIED = 3  # rows of marks: fewer can be equal by chance

_FALLEN = 0.5  # of the maximum tension, at the end

_EARLY = 0.09  # of a cycle: no line lets tension lead by more

_EARLY_ELASTOMER = 0.125  # the same for a damping polymer: a loss factor of 1

_LATE = 0.01

_BACKWARD = 0.25

_COVERED = 2.0  # standard uncertainties of the stated lag

_COARSE = 0.015  # step of a load relative to its maximum

_DRIFT = 0.05  # of the mean tension

_RAMP = 0.1  # of the mean tension

_STEADY = 0.7  # drop in the second half of the cycles relative to that in the first half

_WITHOUT_CYCLES = ("tensile", "quasi-static", "relaxation", "creep")

_MOST_STROKES = 5  # in a pull or a hold, including its set-up

# ratio of measured hose tension to the design value: cords are 1.4 times as stiff at 0.1 Hz
_AS_PREDICTED = {"static": 1.2, "dynamic": 1.45}

_NOT_STATIC = 0.03  # Hz, between the 0.01 of slow cycles and the 0.1 of the dynamic tests

_BY_LENGTH = 2.0  # ratio of hose length to that of the tested one

_LBF, _PSI = 4.4482216, 6.8947573  # N, kPa

# ratio of largest to smallest unstretched diameter, by constant volume: twice caliper squeeze
_ONE_VOLUME = 1.1

_BY_DESIGN = 1.25  # ratio of the tested hose's size to that of its design


def implausible(
    campaign: Campaign, surveys: Sequence[Survey], models: Models
) -> dict[str, tuple[Note, ...]]:
    """Inconsistencies of each test, by its id.

    Warnings; empty for a consistent test.
    """
    read = [one for one in surveys if one.error is None]
    found: dict[str, list[Note]] = {one.plan.id: [] for one in read}
    copied = _copied_marks(campaign)
    for survey in read:
        notes = found[survey.plan.id]
        for name in survey.plan.specimens:
            model = models.get((survey.plan.id, name))
            notes += _of_specimen(campaign, survey, campaign.specimens[name], model)
            if model is not None and model.mark_test and name in copied:
                notes.append(copied[name])
        notes += _of_statements(campaign, survey, models)
        notes += _of_columns(campaign, survey)
        notes += _of_absent(campaign, survey)
    for test, one in (
        *_of_pairs(campaign, read, models), *_of_swapped(read), *_of_dates(read),
        *_of_extensometers(read, models),
    ):  # fmt: skip
        found[test].append(one)
    for plan in campaign.experiments.values():
        for test, one in _off_plan(campaign, plan, read):
            found[test].append(one)
    for test, one in (*_of_hoses(campaign), *_of_predictions(campaign, read, models)):
        if test in found:
            found[test].append(one)
    return {test: tuple(notes) for test, notes in found.items()}


def _of_specimen(
    campaign: Campaign, survey: Survey, specimen: Specimen, model: StrainModel | None
) -> Iterator[Note]:
    """Compare the sizes of a specimen, and its strain and tension, with bands for its kind."""
    name = specimen.name
    words = " ".join((specimen.material, specimen.construction, specimen.condition))
    bands = bands_of(specimen.kind, words)
    tension = survey.extremes.greatest_tension.get(name, np.nan)
    strength = specimen.rated_break_strength or np.nan
    yield from _of_sizes(specimen, bands)
    if tension > _STRENGTH_REACHED * strength and name not in survey.broken:
        yield note("tension-above-strength", name, share=tension / strength)
    if tension < _LITTLE_OF_STRENGTH * strength and survey.levels is not None:
        yield note("tension-far-below-strength", name, share=tension / strength)
    strain = greatest_strain(survey.extremes, name, model)
    if bands is None or not strain > 0:
        return
    if strain > bands.greatest_strain:
        yield note(
            "strain-above-band", name, strain=strain, limit=bands.greatest_strain, of=bands.of
        )
    if not specimen.has_area or survey.plan.kind in ("relaxation", "creep"):
        return
    modulus = tension / specimen.area / strain
    low, high = bands.modulus
    if modulus > 0 and not low <= modulus <= high:
        yield note(
            "modulus-outside-band", name, modulus=modulus, low=low, high=high, of=bands.of,
            readings=readings_that_fit(
                modulus, bands.modulus, load_unit=_load_unit(campaign, survey, name),
                strength=strength,
            ),
        )  # fmt: skip


def _copied_marks(campaign: Campaign) -> dict[str, Note]:
    """Find marks that were read on another specimen, and copied."""
    found: dict[str, Note] = {}
    if campaign.uncertainty.strain_gain:  # what the specimens differ by is in the intervals
        return found
    earlier: dict[str, set[tuple[str, float, float, float]]] = {}
    for name, marks in campaign.marks.items():
        own = _readings(marks)
        # slack rows may have been read on each specimen
        stretched = {one for one in own if one[0] != "slack"}
        for other, readings in earlier.items():
            shared = own & readings
            if len(shared) >= _FEWEST_COPIED and shared >= stretched:
                found[name] = note("marks-of-another", name, other=other, n_marks=len(shared))
                break
        earlier[name] = own
    return found


def _of_absent(campaign: Campaign, survey: Survey) -> Iterator[Note]:
    """Find marks that were read in this test on a specimen that it lacks."""
    present = survey.plan.specimens
    for name, marks in campaign.marks.items():
        n_marks = marks.test.count(survey.plan.log)
        if n_marks and name not in present:
            yield note("marks-of-absent", name, n_marks=n_marks, present=" and ".join(present))


def _readings(marks: SpliceMarks) -> set[tuple[str, float, float, float]]:
    """Hold and tape readings of each row, without the test."""
    columns = (marks.near_toe.tolist(), marks.far_toe.tolist(), marks.far_thimble.tolist())
    return set(zip(marks.hold, *columns, strict=True))


def _of_stretched(specimen: Specimen) -> Iterator[Note]:
    """Check whether diameters at several stretches agree with constant rubber volume."""
    groups: dict[float, list[float]] = {}
    for stretch, reading in sorted(specimen.stretched_diameters):
        groups.setdefault(stretch, []).append(reading)
    stretches = np.array(list(groups))
    means = np.array([np.mean(group) for group in groups.values()])

    def apart(order: Sequence[int]) -> float:
        relaxed = constant_volume_diameter(stretches, means[list(order)])
        return float(relaxed.max() / relaxed.min())

    as_stated = range(means.size)
    if means.size < 2 or apart(as_stated) < _ONE_VOLUME:
        return
    relaxed = constant_volume_diameter(stretches, means)
    pairs = [
        (one, other) for one, other in combinations(as_stated, 2)
        if apart([{one: other, other: one}.get(place, place) for place in as_stated]) < _ONE_VOLUME
    ]  # fmt: skip
    yield note(
        "stretched-diameters-apart", specimen.name, least=float(relaxed.min()),
        greatest=float(relaxed.max()),
        swapped=" and ".join(f"{100 * stretches[one]:g} %" for one in (*pairs, ())[0]),
    )  # fmt: skip


def _of_sizes(specimen: Specimen, bands: Bands | None) -> Iterator[Note]:
    """Check diameter, strength and mass of a specimen against each other."""
    if not specimen.has_area:
        return
    yield from _of_stretched(specimen)
    readings = specimen.diameter
    if readings and max(readings) > 1.3 * min(readings):
        yield note("diameter-readings-apart", specimen.name, least=min(readings),
                   greatest=max(readings))  # fmt: skip
    if bands is None:
        return
    for code, value, (low, high) in (
        ("strength-outside-band", specimen.rated_break_strength, bands.strength),
        ("density-outside-band", specimen.linear_density, bands.density),
    ):
        if not value:
            continue
        found = value / specimen.area
        if not low <= found <= high:
            yield note(
                code, specimen.name, found=found, low=low, high=high, of=bands.of,
                readings=readings_that_fit(found, (low, high), of_strength=True),
            )  # fmt: skip


def _load_unit(campaign: Campaign, survey: Survey, name: str) -> str:
    """Declared load unit of a specimen."""
    layout = campaign.layouts[survey.plan.files[0][1]]
    number = str(survey.plan.specimens.index(name) + 1)
    channel = layout.channels.get(f"tension.{number}")
    return "" if channel is None else channel.unit


def _of_statements(campaign: Campaign, survey: Survey, models: Models) -> Iterator[Note]:
    """Compare the statements about a test with its log."""
    levels, plan = survey.levels, survey.plan
    if levels is None:
        return
    if survey.n_cycles and levels.speed > _FASTEST:
        yield note("faster-than-machines", speed=levels.speed)
    rates = (plan.attributes.get(key, "") for key in ("frequency", "rate"))
    time = campaign.layouts[plan.files[0][1]].channels.get("time")
    has_unit = time is None or time.unit != CLOCK  # dates and times of day have none to mistake
    if has_unit and plan.kind not in _WITHOUT_CYCLES and not any(map(_NUMBER.match, rates)):
        if levels.frequency < 1 / _SLOWEST:
            yield note("slower-than-machines", period=1 / levels.frequency)
    yield from _of_rate(survey)
    yield from _of_stated_levels(campaign, survey)
    # a break test may start with the bedding-in of a new rope
    is_set_up = plan.kind == "tensile" and levels.ends_in_pull
    if plan.kind in _WITHOUT_CYCLES and (levels.n_strokes > _MOST_STROKES and not is_set_up):
        yield note("cycles-in-other-kind", n_cycles=levels.n_strokes // 2, kind=plan.kind)
    at_stop, held = levels.stood_tension
    if np.isfinite(held):
        yield note("hold-of-position", at_stop=at_stop, held=held, kind=plan.kind)
    break_in = plan.settings.cycles.break_in_cycles
    if 0 < survey.n_cycles <= break_in:
        yield note("break-in-is-all", n_cycles=survey.n_cycles, break_in=break_in)
    # as reduced: bedding-in by a machine that makes sines afterwards counts as "other"
    used = plan.settings.cycles.waveform
    if levels.waveform and used in ("triangular", "sinusoidal"):
        if levels.waveform != used and plan.kind != "snap":
            yield note("waveform-not-as-stated", stated=used, found=levels.waveform)
    for index, name in enumerate(plan.specimens):
        model = models.get((plan.id, name))
        strain = greatest_strain(survey.extremes, name, model)
        target = max(plan.target_strain, default=0.0) or np.nan
        if not 1 / _TARGET <= strain / target <= _TARGET and np.isfinite(strain / target):
            yield note(
                "target-strain-missed", name, reached=strain, target=target,
                ratio=strain / target, like=words_of_ratio(strain / target, "length"),
                method=model.method if model is not None else "",
            )  # fmt: skip
        else:
            yield from _of_lower_target(plan, survey, index, model)
        yield from _of_length(campaign, survey, index, model)
        share = float(levels.final_share[index])
        is_unsaid = name not in survey.broken and plan.kind in ("tensile", "quasi-static")
        if share < _FALLEN and is_unsaid:
            yield note("load-falls-for-good", name, share=share)
        lead = float(levels.lead[index]) * levels.frequency
        # beyond a quarter cycle the channel is reversed, which its sign shows
        # a damper leads by up to a quarter of a cycle, as no line does
        specimen = campaign.specimens[name]
        early = _EARLY_ELASTOMER if specimen.kind == "elastomer" else _EARLY
        early = _BACKWARD if specimen.can_push else early
        stated = _COVERED * (campaign.uncertainty.lag or 0.0) * levels.frequency
        if -_BACKWARD < lead < -max(_LATE, stated) or max(early, stated) < lead < _BACKWARD:
            yield note(
                "tension-behind-position" if lead < 0 else "position-behind-tension", name,
                delay=abs(float(levels.lead[index])),
            )  # fmt: skip
        step = float(levels.load_step[index])
        greatest = survey.extremes.greatest_tension.get(name, np.nan)
        if step > _COARSE * greatest:
            yield note("load-in-steps", name, step=step, share=step / greatest)
        yield from _of_mean(name, levels.like_means[index])
        first, last, grows = levels.mean_ramps[index]
        if abs(last - first) > _RAMP * abs(first):
            yield note(
                "mean-tension-ramps", name, first=first, last=last,
                is_of_load=plan.control == "load",
                grows=grows if abs(grows) > _OF_GROWTH * abs(last - first) else 0.0,
            )  # fmt: skip
        if levels.is_copy[index]:
            yield note("channels-alike", name, others=", ".join(plan.specimens[:index]))


# of the change in mean: for cycles growing from a fixed valley, half the range grows by as much
_OF_GROWTH = 0.5


def _of_mean(name: str, means: Floats) -> Iterator[Note]:
    """Check for a mean tension that changes like a drifting zero, or possibly like the specimen.

    Relaxation slows down; an undiminished fall is a drift, or relaxation slower than the test.
    """
    first, middle, last = means
    steady = last > first or last - middle < _STEADY * (middle - first)
    if steady and abs(last - first) > _DRIFT * abs(first):
        yield note("zero-or-relaxation", name, earlier=first, later=last)


def _of_lower_target(
    plan: TestPlan, survey: Survey, index: int, model: StrainModel | None
) -> Iterator[Note]:
    """Compare the lower of two target strains with the strain at the valleys of the cycles."""
    levels, name = survey.levels, plan.specimens[index]
    if levels is None or model is None or len(plan.target_strain) < 2:
        return
    if model.method == "extensometer":
        strain = float(levels.valley_strain[index])
    else:
        position, load = (
            np.array([one]) for one in (levels.valley_position, levels.valley_tension[index])
        )
        strain = float(strain_by_model(model, position=position, tension=load)[0])
    low, high = min(plan.target_strain), max(plan.target_strain)
    # a slack valley has no strain, whatever its position
    away = max(strain, 0.0) - low
    if abs(away) > (_TARGET - 1) * max(high - low, low):
        yield note("lower-target-missed", name, reached=strain, target=low)


_STATED: tuple[tuple[str, Dimension], ...] = (
    ("frequency", "frequency"), ("mean_tension", "force"),
)  # fmt: skip


def _of_stated_levels(campaign: Campaign, survey: Survey) -> Iterator[Note]:
    """Compare the stated frequency and mean tension of a test with its log."""
    levels = survey.levels
    for key, dimension in _STATED:
        text = survey.plan.attributes.get(key, "")
        match = _NUMBER.match(text)
        if match is None or levels is None:
            continue
        strengths = [
            campaign.specimens[name].rated_break_strength for name in survey.plan.specimens
        ]
        found = [levels.frequency] if key == "frequency" else levels.mean_tension.tolist()
        for value, strength in zip(found, strengths, strict=False):
            stated = _stated_level(float(match[1]), match[2], dimension, strength)
            ratio = value / stated if stated else np.nan
            if np.isfinite(ratio) and not 1 / _TARGET <= ratio <= _TARGET:
                yield note(
                    "level-not-as-stated", level=key, stated=text, found=value,
                    unit="Hz" if key == "frequency" else "N", ratio=ratio,
                    like=words_of_ratio(ratio, "time" if key == "frequency" else "force"),
                )  # fmt: skip


def _stated_level(number: float, unit: str, dimension: Dimension, strength: float | None) -> float:
    """A level stated in words, in SI; NaN if its unit does not apply."""
    if dimension == "force" and unit in ("%RBS", "%MBL", "% RBS", "% MBL"):
        return number / 100 * strength if strength else np.nan
    try:
        return number * scale_to_si(_as_pint(unit), dimension)[0]
    except SettingsError:
        return np.nan


def _as_pint(unit: str) -> str:
    return unit.replace(" per ", "/").replace("cycles", "cycle")


_NUMBER = re.compile(r"^\s*([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)\s*(.+?)\s*$")


def _of_rate(survey: Survey) -> Iterator[Note]:
    """Compare the stated rate with the speed or the frequency of the log."""
    levels = survey.levels
    match = _NUMBER.match(survey.plan.attributes.get("rate", ""))
    if match is None or levels is None or "%" in match[2]:  # a strain rate is neither
        return
    shown: tuple[tuple[Dimension, float, str, tuple[str, ...]], ...] = (
        ("velocity", levels.speed, "m/s", ("time", "length")),
        ("frequency", levels.frequency, "Hz", ("time",)),
    )
    for dimension, found, unit, made_of in shown:
        stated = _stated_level(float(match[1]), match[2], dimension, None)
        ratio = found / stated if stated else np.nan
        if np.isfinite(ratio) and not 1 / _RATE <= ratio <= _RATE:
            yield note(
                "rate-not-as-stated", stated=survey.plan.attributes["rate"], found=found,
                unit=unit, ratio=ratio, like=words_of_ratio(ratio, *made_of),
            )  # fmt: skip


def _of_length(
    campaign: Campaign, survey: Survey, index: int, model: StrainModel | None
) -> Iterator[Note]:
    """Compare gauge length and extensometer with the pin-to-pin length."""
    levels = survey.levels
    if levels is None or model is None:
        return
    name = survey.plan.specimens[index]
    length = levels.slack_position
    slope = float(levels.strain_per_length[index])
    if not survey.extremes.position_is_length:
        length = survey.reference_length or np.nan
    gauge = model.coefficients.get("gauge_length", np.nan)
    zero = survey.zero_strain.get(name)
    is_bent = zero is not None and zero.bent_at is not None
    if model.method == "gauge-length" and survey.extremes.position_is_length and not is_bent:
        is_hose = campaign.specimens[name].kind == "stretch hose"  # measured from flange to flange
        least, most = _OF_HOSE if is_hose else 1 / 3, _LONGER
        if np.isnan(length):  # no rest: displacement zero, where a specimen may hang bent
            length, least, most = survey.reference_length or np.nan, 0.1, 3.0
        if gauge > most * length or gauge < least * length:
            yield note("gauge-against-length", name, gauge=gauge, length=length,
                       like=words_of_ratio(gauge / length, "length"))  # fmt: skip
    at_slack = float(levels.slack_strain[index])
    if model.method == "extensometer" and abs(at_slack) > _AT_SLACK:
        yield note("extensometer-off-at-slack", name, strain=at_slack)
    if model.method == "extensometer" and np.isfinite(slope * length):
        ratio = slope * length
        if not 1 / _STROKE <= ratio <= _STROKE:
            yield note("extensometer-against-stroke", name, ratio=ratio,
                       like=words_of_ratio(abs(ratio), "length"))  # fmt: skip


def _of_extensometers(surveys: Sequence[Survey], models: Models) -> Iterator[tuple[str, Note]]:
    """Find tests whose extensometer goes with the stroke as in no other test of the specimen."""
    slopes: dict[tuple[str, str], list[tuple[str, float]]] = {}
    for survey in surveys:
        for index, name in enumerate(survey.plan.specimens):
            model = models.get((survey.plan.id, name))
            if survey.levels is None or model is None or model.method != "extensometer":
                continue
            slope = float(survey.levels.strain_per_length[index])
            if slope > 0:
                slopes.setdefault((name, survey.plan.kind), []).append((survey.plan.id, slope))
    for (name, _), rows in slopes.items():
        of_tests = np.array([slope for _, slope in rows])
        for place, (test, slope) in enumerate(rows):
            others = np.delete(of_tests, place)
            if others.size < _FEWEST_LIKE or others.max() > _ONE_RATIO * others.min():
                continue
            ratio = slope / float(np.median(others))
            if not 1 / _OTHER_RATIO <= ratio <= _OTHER_RATIO:
                yield test, note("extensometer-unlike-others", name, ratio=ratio,
                                 n_others=others.size,
                                 like=words_of_ratio(ratio, "length"))  # fmt: skip


def _of_columns(campaign: Campaign, survey: Survey) -> Iterator[Note]:
    """Find columns that are named after another specimen."""
    plan = survey.plan
    layout = campaign.layouts[plan.files[0][1]]
    for number, name in enumerate(plan.specimens, start=1):
        channel = layout.channels.get(f"tension.{number}")
        column = str(channel.column).lower() if channel is not None else ""
        words = set(re.split(r"[\W_]+", column))
        for key, beside in layout.channels.items():  # a prefix common to all columns is not a name
            if not key.startswith("tension"):
                words -= set(re.split(r"[\W_]+", str(beside.column).lower()))
        others = [
            one for one in campaign.specimens
            if one != name and one.lower() in words and name.lower() not in words
        ]  # fmt: skip
        if others:
            yield note("column-of-another", name, column=column, other=others[0])


def load_columns(layout: Layout) -> tuple[str, ...]:
    """Location of the loads in a log: sheet, group or matrix, and columns."""
    columns = (
        str(channel.column) for key, channel in layout.channels.items() if key.startswith("tension")
    )
    return (str(layout.sheet), str(layout.group), str(layout.matrix), *columns)


def _read_the_same(one: TestPlan, other: TestPlan) -> bool:
    """Whether two tests use the same rows of a log, or of a copy of it.

    Steps of one file may be separate tests if the machine changes from position to load control.
    """
    if one.log == other.log:
        return False
    if one.files != other.files or one.step_range is None or other.step_range is None:
        return True
    low, high = np.transpose([one.step_range, other.step_range])
    return bool(low.max() < high.min())


def _each_way(one: TestPlan, other: TestPlan, code: str) -> Iterator[tuple[str, Note]]:
    yield one.id, note(code, other=other.log)
    yield other.id, note(code, other=one.log)


def _of_pairs(
    campaign: Campaign, surveys: Sequence[Survey], models: Models
) -> Iterator[tuple[str, Note]]:
    """Find tests with the same load, and tests of one specimen with different stiffness.

    Both tests of a pair, unless other specimens tell which of them is wrong.
    """
    read: dict[tuple[tuple[str, ...], ...], list[TestPlan]] = {}
    by_readings: dict[tuple[bytes, ...], list[TestPlan]] = {}
    for survey in surveys:
        # one file may contain several tests side by side
        logs = tuple(
            (source.sha256, *load_columns(campaign.layouts[layout]))
            for source, (_, layout) in zip(survey.sources, survey.plan.files, strict=False)
        )
        before = read.setdefault(logs, [])
        twice = [one for one in before if _read_the_same(one, survey.plan)]
        before.append(survey.plan)
        if twice:
            yield from _each_way(survey.plan, twice[0], "log-used-twice")
            continue
        some = survey.extremes.all_over.values()  # at the same places of logs of the same length
        readings = tuple(one.position.tobytes() + one.tension.tobytes() for one in some)
        if readings and survey.plan.step_range is None:
            again = by_readings.setdefault(readings, [])
            if again:
                yield from _each_way(survey.plan, again[0], "readings-used-twice")
            again.append(survey.plan)
    by_specimen: dict[str, list[Survey]] = {}
    for survey in surveys:
        if survey.levels is not None and not survey.plan.failed and not survey.plan.step_place:
            for name in survey.plan.specimens:
                by_specimen.setdefault(name, []).append(survey)
    odd = list(_off_other_specimens(campaign, by_specimen, models))
    yield from odd
    for name, several in by_specimen.items():
        # a test that others show to be wrong would make those beside it look wrong
        known = {test for test, one in odd if one.subject == name}
        compared = [one for one in several if one.plan.id not in known][:_MOST_COMPARED]
        if not compared:
            continue
        softens = campaign.specimens[name].kind in ("rubber tether", "elastomer")
        unlike = list(_of_stiffness(name, compared, models, softens=softens))
        yield from unlike
        if not unlike:
            yield from _off_the_others(name, compared, models, softens=softens)


class _OfBatch(NamedTuple):
    """A test of one of several specimens of a kind: peak strain [1] and stress [Pa], and past."""

    survey: Survey
    specimen: str
    strain: float
    stress: float
    past: str


def _off_other_specimens(
    campaign: Campaign, by_specimen: Mapping[str, Sequence[Survey]], models: Models
) -> Iterator[tuple[str, Note]]:
    """Find tests whose modulus differs from that of most other specimens of the same kind."""
    groups: dict[tuple[str, ...], list[_OfBatch]] = {}
    for name, several in by_specimen.items():
        made = campaign.specimens[name]
        # a hose is as stiff as its cords and their angle make it
        if not made.has_area or made.kind in ("other", "stretch hose"):
            continue
        make = made.kind, made.material, made.construction, made.condition
        rows = groups.setdefault(make, [])
        strain, before = _strains(name, several, models)
        stress = _greatest_tension(name, several) / made.area
        # what was stretched further before may be softer
        is_first = before <= _GREATER * strain
        is_first |= _loads_set(several) & (_before(several, stress) <= _GREATER * stress)
        past = _past_and_conditions(several, made.earlier_cycles)
        every = map(_OfBatch, several, repeat(name), strain, stress, past)
        is_kept = is_first & (strain > 0) & (stress > 0)
        rows += [row for row, is_one in zip(every, is_kept, strict=True) if is_one]
    for rows in groups.values():
        names = np.array([row.specimen for row in rows])
        known, specimen = np.unique(names, return_inverse=True)
        if known.size < 2:
            continue
        kind = np.array([row.survey.plan.kind for row in rows])
        rate = np.array([
            np.nan if row.survey.levels is None else row.survey.levels.frequency for row in rows
        ])  # fmt: skip
        strain, stress = np.array([(row.strain, row.stress) for row in rows]).T
        pasts = np.array([row.past for row in rows])
        modulus = stress / strain
        load_set = _loads_set([row.survey for row in rows])
        size = np.log(modulus)
        of_others, at_place = np.full((2, len(rows), known.size), np.nan)
        told: set[int] = set()
        for place, (survey, name) in enumerate(row[:2] for row in rows):
            apart, of_stress, of_rate = (
                np.abs(np.log(values / values[place])) for values in (strain, stress, rate)
            )
            by_load = load_set & load_set[place]
            apart[by_load] = np.minimum(apart, of_stress)[by_load]
            ones = (names != name) & (kind == kind[place])
            like = ones & (apart < np.log(_LIKE_STRAIN)) & (of_rate < np.log(_LIKE_RATE))
            batch = ones & (np.maximum(apart, of_rate) < np.log(_ONE_LEVEL))
            batch &= pasts == pasts[place]
            at_place[place], _ = _means(size, specimen, like & (pasts == pasts[place]), known.size)
            of_others[place], count = _means(size, specimen, batch, known.size)
            limit = _JUMP
            if np.count_nonzero(count) >= _FEWEST_OF_BATCH:
                limit = min(np.exp(_most_off(size[batch], _LEAST_OFF)), _JUMP)
                like = batch
            others = np.unique(names[like])
            ratio = modulus[place] / modulus[like]
            for far in (ratio > limit, ratio < 1 / limit):
                unlike = np.setdiff1d(others, names[like][~far])
                if others.size >= _FEWEST_LIKE and 3 * unlike.size > 2 * others.size:
                    told.add(place)
                    seen = dict.fromkeys(words_of_ratio(one) for one in np.sort(ratio[far]))
                    words = [one for one in seen if one and "second" not in one]  # not of time
                    yield survey.plan.id, note(
                        "stiffness-off-others", name, ratio=float(np.median(ratio[far])),
                        n_others=int(unlike.size), n_like=int(others.size),
                        like=", ".join(words),
                    )  # fmt: skip
        for place, ratio, n_others in _off_own_tests(specimen, size, of_others, at_place, told):
            name = rows[place].specimen
            off = note("stiffness-off-own-tests", name, ratio=ratio, n_others=n_others)
            yield rows[place].survey.plan.id, off


def _means(size: Floats, specimen: Integers, chosen: Bools, n: int) -> tuple[Floats, Integers]:
    """Mean of each of n specimens over the chosen tests, NaN without one, and their number."""
    count = np.bincount(specimen[chosen], minlength=n)
    total = np.bincount(specimen[chosen], size[chosen], minlength=n)
    return np.divide(total, count, out=np.full(n, np.nan), where=count > 0), count


def _past_and_conditions(several: Sequence[Survey], earlier_cycles: int | None) -> list[str]:
    """What tests of a batch have in common beside their level, for each test of a specimen.

    Number of tests before it (without a known order, of those above it in the campaign), cycles
    before all of them, medium and temperature: ropes stiffen with cycles, nylon softens in water.
    """
    n_before = _are_before(several).sum(axis=1).tolist()
    plans = [one.plan for one in several]
    return [
        repr((
            place if plan.order is None else n_before[place], earlier_cycles or 0,
            *(plan.attributes.get(one) for one in ("medium", "temperature")),
        ))
        for place, plan in enumerate(plans)
    ]  # fmt: skip


def _off_own_tests(
    specimen: Integers, size: Floats, of_others: Floats, at_place: Floats, told: set[int]
) -> Iterator[tuple[int, float, int]]:
    """Find tests whose ratio to the other tests of the specimen is not that of the others.

    Specimens of a batch scatter more than the ratio of one specimen at two levels does.
    ``of_others`` has, for each test, the mean of each other specimen at its level, or NaN;
    ``at_place`` that of each at its place in the programme, where levels may differ by a gain.
    """
    for place in sorted(set(range(size.size)) - told):
        own = set(np.flatnonzero(specimen == specimen[place]).tolist()) - told - {place}
        away: list[float] = []
        n_others = 0
        for one in sorted(own)[:_MOST_OWN]:
            usual = of_others[place] - of_others[one]
            usual = usual[np.isfinite(usual)]
            if usual.size >= _FEWEST_OF_BATCH:
                off = float(size[place] - size[one] - np.median(usual))
                away.append(off if abs(off) > _most_off(usual, _LEAST_OFF_OWN) else 0.0)
                n_others = usual.size
        if not away:
            away = list(_off_its_ratio(size - at_place.T, place, sorted(own)))
            n_others = len(away)
        far = [one for one in away if one]
        if 2 * len(far) > len(away):
            yield place, float(np.exp(np.median(far))), n_others


def _off_its_ratio(ratios: Floats, place: int, own: Sequence[int]) -> Iterator[float]:
    """How far a test is off the ratio to each other specimen that its own other tests have.

    For few specimens, whose scatter is not known: that of the tests counts.  ``ratios``: by other
    specimen and test, NaN without one of the other specimen at this place.
    """
    for at_levels in ratios:
        others = at_levels[list(own)]
        others = others[np.isfinite(others)]
        if others.size < _FEWEST_OF_PAIR - 1 or not np.isfinite(at_levels[place]):
            continue
        off = float(at_levels[place] - others.mean())
        most = _most_beside(others - others.mean(), 1, 1 / others.size, usual=_OF_RATIOS)
        yield off if abs(off) > max(most, np.log(_LEAST_OFF_OWN)) else 0.0


def _most_beside(left: Floats, n_fitted: int, leverage: float, *, usual: float) -> float:
    """How far a sound value may lie off what is fitted to a few others, by what these leave.

    The ``usual`` scatter counts as two more of them.
    """
    scatter = (left @ left + _AS_IF * usual**2) / (left.size - n_fitted + _AS_IF)
    return _OFF_SCATTER * float(np.sqrt(scatter * (1 + leverage)))


def _most_off(size: Floats, least: float) -> float:
    """How far a logarithm may lie off the median of others."""
    scatter = MAD_TO_DEVIATION * np.median(np.abs(size - np.median(size)))
    return float(max(_OF_SCATTER * scatter, np.log(least)))


def _strains(name: str, several: Sequence[Survey], models: Models) -> tuple[Floats, Floats]:
    """Peak strain of each test, and of the tests before it (0 without a known order)."""
    strain = np.array([
        greatest_strain(one.extremes, name, models.get((one.plan.id, name))) for one in several
    ])  # fmt: skip
    return strain, _before(several, strain)


def _before(several: Sequence[Survey], values: Floats) -> Floats:
    """Greatest value of the tests before each (0 without a known order)."""
    return np.asarray(np.where(_are_before(several), np.nan_to_num(values), 0.0).max(axis=1))


def _are_before(several: Sequence[Survey]) -> Bools:
    """Whether a test (column) was made before another (row)."""
    order = np.array([np.nan if one.plan.order is None else one.plan.order for one in several])
    return order < order[:, None]


def _greatest_tension(name: str, several: Sequence[Survey]) -> Floats:
    return np.array([one.extremes.greatest_tension.get(name, np.nan) for one in several])


def _loads_set(several: Sequence[Survey]) -> Bools:
    """Whether the machine went to set loads, so that the strain is what the specimen gave."""
    return np.array([one.plan.control == "load" for one in several])


def _of_stiffness(
    name: str, several: Sequence[Survey], models: Models, *, softens: bool
) -> Iterator[tuple[str, Note]]:
    """Find tests that differ from most similar tests of the specimen."""
    others: list[list[tuple[str, float, bool]]] = [[] for _ in several]
    strain, before = _strains(name, several, models)
    reached = np.fmax(strain, before)
    for one, other in combinations(range(len(several)), 2):
        ratio, limit = _stiffness_ratio(several[one], several[other], name, models)
        if np.isfinite(ratio):
            low, high = 1 / limit, limit
            if softens and before[other] > _GREATER * reached[one]:
                low = min(low, 1 / _SOFTENED)
            if softens and before[one] > _GREATER * reached[other]:
                high = max(high, _SOFTENED)
            is_far = not low <= ratio <= high
            others[other].append((several[one].plan.id, ratio, is_far))
            others[one].append((several[other].plan.id, 1 / ratio, is_far))
    for place, survey in enumerate(several):
        far = [(test, ratio) for test, ratio, is_far in others[place] if is_far]
        if 2 * len(far) > len(others[place]):
            test, ratio = far[0]
            yield (
                survey.plan.id,
                note("stiffness-jumps", name, other=test, ratio=ratio, like=words_of_ratio(ratio)),
            )


def _of_dates(surveys: Sequence[Survey]) -> Iterator[tuple[str, Note]]:
    """Find tests whose date is not that of their place in the history of a specimen."""
    told: set[str] = set()
    by_specimen: dict[str, list[tuple[int, str, str]]] = {}
    for survey in surveys:
        date = survey.plan.attributes.get("date", "")
        if survey.plan.order is not None and _DAY.fullmatch(date):
            for name in survey.plan.specimens:
                dated = by_specimen.setdefault(name, [])
                dated.append((survey.plan.order, date, survey.plan.id))
    for dated in by_specimen.values():
        # those that contradict most others first: without them the others may be in order
        left = sorted(dated)
        while left:
            wrong = [sum(_is_late(one, other) for other in left) for one in left]
            if not max(wrong):
                break
            odd = left.pop(int(np.argmax(wrong)))
            _, date, test = next(other for other in left if _is_late(odd, other))
            if odd[2] not in told:
                told.add(odd[2])
                yield odd[2], note("date-against-order", date=odd[1], other=test, of_other=date)


_DAY = re.compile(r"\d{4}-\d{2}-\d{2}")


def _is_late(one: tuple[int, str, str], other: tuple[int, str, str]) -> bool:
    """Whether two tests have different orders, and dates the other way round."""
    return (one[0] < other[0] and one[1] > other[1]) or (one[0] > other[0] and one[1] < other[1])


# logarithm of the ratio of two peaks: of a pair that is too alike, and how far off the others of
# the pair, in their spread, a test is whose specimens are swapped
_TOO_ALIKE = 0.04
_SWAPPED = 3.0
_FEWEST_OF_PAIR = 4  # tests of a pair


def _of_swapped(surveys: Sequence[Survey]) -> Iterator[tuple[str, Note]]:
    """Find tests of two specimens on one crosshead whose peaks have the inverse of their ratio.

    Both specimens have the same history, so that the ratio of their peaks is nearly that of their
    other tests.
    """
    pairs: dict[tuple[str, str], list[tuple[str, float]]] = {}
    for survey in surveys:
        peaks = survey.extremes.greatest_tension
        names = sorted(survey.plan.specimens)
        if len(names) == 2 and all(peaks.get(name, np.nan) > 0 for name in names):
            ratio = float(np.log(peaks[names[1]] / peaks[names[0]]))
            pairs.setdefault((names[0], names[1]), []).append((survey.plan.id, ratio))
    for (first, second), tests in pairs.items():
        ratios = np.array([ratio for _, ratio in tests])
        if ratios.size < _FEWEST_OF_PAIR:
            continue
        for place, (test, ratio) in enumerate(tests):
            others = np.delete(ratios, place)
            usual = float(np.median(others))
            apart = abs(ratio - usual)
            if abs(usual) > _TOO_ALIKE and apart > _SWAPPED * max(
                float(np.abs(others - usual).max()), abs(ratio + usual)
            ):
                yield test, note(
                    "specimens-swapped", second, other=first, ratio=float(np.exp(ratio)),
                    usual=float(np.exp(usual)), n_others=others.size,
                )  # fmt: skip


def _off_the_others(
    name: str, several: Sequence[Survey], models: Models, *, softens: bool
) -> Iterator[tuple[str, Note]]:
    """Find the test whose peak lies far off the curve through the other peaks of the specimen.

    The curve is a least-squares power law of tension against strain: runs at several means follow
    one such curve, although none resembles another.  Rubber stretched further before follows a
    different curve: such tests are compared with each other, and a single one may lie below the
    rest by the softening of rubber.
    """
    rows = [
        (survey.plan.id, strain, tension, softens and before > _GREATER * strain)
        for survey, strain, before in zip(
            several, *_strains(name, several, models), strict=True)
        if survey.plan.kind == "cyclic"
        for tension in [survey.extremes.greatest_tension.get(name, np.nan)]
        if strain > 0 and tension > 0
    ]  # fmt: skip
    if len(rows) < _FEWEST_ON_CURVE:
        return
    strain, tension = np.log([row[1:3] for row in rows]).T
    softened = np.array([row[3] for row in rows])
    found: list[tuple[float, float, str]] = []  # distance over the limit, distance, test
    for place, (test, *_) in enumerate(rows):
        of_others = np.arange(len(rows)) != place
        alike = of_others & (softened == softened[place])
        is_alone = alike.sum() < _FEWEST_ON_CURVE - 1
        near = of_others if is_alone else alike
        away, limit = _off_power_law(strain[near], tension[near], strain[place], tension[place])
        if not abs(away) > limit:
            continue
        if is_alone and softened[place] and -np.log(_SOFTENED) < away < 0:
            yield test, note("softer-by-stretch", name, ratio=float(np.exp(away)))
        else:
            found.append((abs(away) / limit, away, test))
    if found:
        _, away, test = max(found)
        ratio = float(np.exp(away))
        yield test, note("peak-off-others", name, ratio=ratio, like=words_of_ratio(ratio))


def _off_power_law(x: Floats, y: Floats, at: float, value: float) -> tuple[float, float]:
    """Distance of a value from a line through others, and how far a sound one may lie off.

    Logarithms of strain and tension: a few tests that are close together do not give the slope, so
    that of ropes counts with its own scatter.  Beyond the others a rope may follow another slope.

    Examples
    --------
    Three on a line of slope 2, and a value that is a factor of two above it:

    >>> x = np.log([1.0, 1.2, 1.4])
    >>> away, limit = _off_power_law(x, 2 * x, np.log(1.3), np.log(2 * 1.3**2))
    >>> print(round(np.exp(away), 2), round(np.exp(limit), 2))
    2.03 1.7
    """
    from_middle = x - x.mean()
    usual, scatter = _OF_SLOPES
    weight = (_OF_PEAKS / scatter) ** 2
    reach = from_middle @ from_middle + weight
    slope = (from_middle @ y + weight * usual) / reach
    left = y - y.mean() - slope * from_middle
    beyond = at - x.mean()
    within = _most_beside(left, 2, 1 / x.size + beyond**2 / reach, usual=_OF_PEAKS)
    # what the others tell of the slope holds between them; what they do not tell is in `within`
    outside = max(x.min() - at, at - x.max(), 0.0) * np.sqrt(1 - weight / reach)
    limit = float(np.hypot(within, _OFF_SCATTER * scatter * outside))
    return float(value - y.mean() - slope * beyond), max(limit, float(np.log(_OFF_CURVE)))


def _stiffness_ratio(one: Survey, other: Survey, name: str, models: Models) -> tuple[float, float]:
    """Ratio of peak tension over peak strain, other test to one, and the limit for it.

    Rubber softens with previous stretch, and ropes stiffen with load and rate: the ratio is NaN for
    tests of different stretch and set load, or of different frequency.  The limit is wider for a
    slow pull and cycles, and at a like load: bedding-in shortens the way to it.
    """
    values = []
    for survey in (one, other):
        strain = greatest_strain(survey.extremes, name, models.get((survey.plan.id, name)))
        tension = survey.extremes.greatest_tension.get(name, np.nan)
        frequency = np.nan if survey.levels is None else survey.levels.frequency
        values.append((tension / strain if strain > 0 else np.nan, strain, frequency))
    (first, strain, rate), (later, other_strain, other_rate) = values
    nothing = np.nan, _JUMP
    if not (first > 0 and later > 0):
        return nothing
    is_at_strain = max(strain, other_strain) < _LIKE_STRAIN * min(strain, other_strain)
    kinds = {one.plan.kind, other.plan.kind}
    if is_at_strain and kinds == {"cyclic", "quasi-static"}:
        return later / first, _JUMP_OF_KINDS
    if len(kinds) > 1 or not max(rate, other_rate) < _LIKE_RATE * min(rate, other_rate):
        return nothing
    if is_at_strain:
        return later / first, _JUMP
    loads = _greatest_tension(name, (one, other))
    if not _loads_set((one, other)).all() or loads.max() > _LIKE_STRAIN * loads.min():
        return nothing
    return later / first, _JUMP_OF_KINDS


def _off_plan(
    campaign: Campaign, plan: ExperimentPlan, surveys: Sequence[Survey]
) -> Iterator[tuple[str, Note]]:
    """Find runs of an experiment whose levels differ from the plan."""
    names = [factor.name for factor in plan.factors]
    yield from _short_pulls(plan, surveys)
    read = {one.plan.id: one for one in surveys if one.levels is not None}
    rows = [(run, name) for run in plan.runs if run in read for name in read[run].plan.specimens]
    if not rows:
        return
    coded = np.array([plan.runs[run][: len(names)] for run, _ in rows])
    strength = np.array(
        [campaign.specimens[name].rated_break_strength or np.nan for _, name in rows]
    )
    is_share = any(factor.basis == "rated_break_strength" for factor in plan.factors)
    planned, high, low = (
        engineering_levels(
            levels, plan.factors, rated_break_strength=strength if is_share else None
        )
        for levels in (coded, np.ones_like(coded), -np.ones_like(coded))
    )
    reached = np.full(planned.shape, np.nan)
    for place, (run, name) in enumerate(rows):
        levels = read[run].levels
        if levels is None:
            continue
        index = read[run].plan.specimens.index(name)
        known = {
            "frequency": levels.frequency, "mean_tension": levels.mean_tension[index],
            "tension_amplitude": levels.tension_amplitude[index],
        }  # fmt: skip
        reached[place] = [known.get(one, np.nan) for one in names]
    off = (reached - planned) / ((high - low) / 2)
    far = np.abs(off) > NOT_OF_PLAN
    if not far.any():
        return
    with np.errstate(divide="ignore", invalid="ignore"):
        why = _pattern(names, coded, planned, reached)
    for place in np.flatnonzero(far.any(axis=1)).tolist():
        run, name = rows[place]
        is_of = np.all(
            np.isnan(off[place])
            | (np.abs(reached[place] - planned) < NOT_OF_PLAN * (high - low) / 2),
            axis=1,
        )
        like = [
            other for (other, _), fits in zip(rows, is_of, strict=True) if fits and other != run
        ]
        yield run, note(
            "run-off-plan", name, experiment=plan.name,
            levels="; ".join(
                f"{names[column].replace('_', ' ')} {reached[place, column]:.4g}, planned "
                f"{planned[place, column]:.4g}"
                for column in np.flatnonzero(far[place])
            ),
            why=why, like=", ".join(dict.fromkeys(like)),
        )  # fmt: skip


def _short_pulls(plan: ExperimentPlan, surveys: Sequence[Survey]) -> Iterator[tuple[str, Note]]:
    """Find slow pulls that end below the mean tension of all runs."""
    read = {one.plan.id: one for one in surveys}
    for specimen, test in plan.quasi_static.items():
        pull = read.get(test)
        means = []
        for run in plan.runs:
            one = read.get(run)
            if one is not None and one.levels is not None and specimen in one.plan.specimens:
                means.append(float(one.levels.mean_tension[one.plan.specimens.index(specimen)]))
        if pull is None or not means:
            continue
        reached = pull.extremes.greatest_tension.get(specimen, np.nan)
        if reached < min(means):
            yield test, note("pull-below-runs", specimen, reached=reached, least=min(means))


def _pattern(names: list[str], coded: Floats, planned: Floats, reached: Floats) -> str:
    """Common pattern in the deviations of all runs from the plan, in words."""
    found = []
    ratio = reached / planned
    for column, name in enumerate(names):
        own = ratio[:, column]
        own = own[np.isfinite(own)]
        if own.size < 2 or np.ptp(own) > 0.1 * abs(np.median(own)):
            continue
        middle = float(np.median(own))
        if abs(middle - 1) > 0.1:
            like = words_of_ratio(middle)
            found.append(
                f"{name.replace('_', ' ')} is {middle:.3g} times the plan in all runs"
                + (f" ({like})" if like else "")
            )
    if {"mean_tension", "tension_amplitude"} <= set(names):
        mean, swing = names.index("mean_tension"), names.index("tension_amplitude")
        if len(found) == 2 and all("tension" in one for one in found):
            found.append("unit of load, gain, or rated_break_strength is wrong by that")
        peak = planned[:, mean] - planned[:, swing]
        is_peak = np.abs(reached[:, mean] / peak - 1) < 0.03
        if np.isfinite(reached[:, mean]).any() and is_peak.all():
            found.append("the mean tensions of the plan are the peaks: mean and amplitude together")
        if np.ptp(coded[:, mean] - coded[:, swing]) > 0:
            span = [np.ptp(planned[:, one]) / 2 for one in (mean, swing)]
            centres = [(planned[:, one].max() + planned[:, one].min()) / 2 for one in (mean, swing)]
            got = [
                (reached[:, one] - centres[place]) / span[place]
                for place, one in enumerate((mean, swing))
            ]
            if np.all(np.abs(got[0] - coded[:, swing]) < 0.2) and np.all(
                np.abs(got[1] - coded[:, mean]) < 0.2
            ):
                found.append("mean and amplitude are swapped in the plan")
    if "frequency" in names:
        at = names.index("frequency")
        centre = (planned[:, at].max() + planned[:, at].min()) / 2
        if np.ptp(planned[:, at]) > 0 and np.allclose(
            reached[:, at] - centre, centre - planned[:, at], rtol=0.1,
            atol=0.05 * np.ptp(planned[:, at]),
        ):  # fmt: skip
            found.append("the coded frequency has the wrong sign in every run")
        if np.allclose(reached[:, at] * planned[:, at], 1.0, rtol=0.1):
            found.append("the frequencies of the plan are periods")
    return "; ".join(found)


def _of_hoses(campaign: Campaign) -> Iterator[tuple[str, Note]]:
    """Find unrealistic hose designs, reported with the tests compared with them."""
    designs: dict[str, dict[str, set[str]]] = {}
    for plan in campaign.comparisons.values():
        of_test = designs.setdefault(plan.specimen, {}).setdefault(plan.measured, set())
        of_test.add(plan.predicted)
    for plan in campaign.comparisons.values():
        hose = campaign.hoses.get(plan.predicted)
        if hose is None:
            continue
        of_tests = designs[plan.specimen].values()
        others = sorted(set.union(*of_tests) - designs[plan.specimen][plan.measured])
        # a test may have several designs; tests without a common one are of different hoses
        if others and not set.intersection(*of_tests):
            yield plan.measured, note("two-designs-of-one", plan.specimen, hose=plan.predicted,
                                      other=" and ".join(others))  # fmt: skip
        yield from ((plan.measured, one) for one in doubts_of_design(hose))
        specimen = campaign.specimens[plan.specimen]
        if specimen.diameter:
            ratio = specimen.mean_diameter / float(np.mean(hose.design.outer_diameter))
            if not 1 / _BY_DESIGN <= ratio <= _BY_DESIGN:
                yield plan.measured, note("hose-not-of-design", plan.specimen, hose=plan.predicted,
                                          ratio=ratio, like=words_of_ratio(ratio))  # fmt: skip


def _of_predictions(
    campaign: Campaign, surveys: Sequence[Survey], models: Models
) -> Iterator[tuple[str, Note]]:
    """Find hoses that differ from their design by a factor more likely due to an input error."""
    read = {one.plan.id: one for one in surveys}
    for plan in campaign.comparisons.values():
        survey, hose = read.get(plan.measured), campaign.hoses.get(plan.predicted)
        if survey is None or hose is None:
            continue
        loading = plan.loading or loading_of(survey.plan.kind)
        frequency = np.nan if survey.levels is None else survey.levels.frequency
        if loading == "static" and frequency > _NOT_STATIC:
            yield plan.measured, note("static-at-frequency", plan.name, frequency=frequency)
        gauge = campaign.specimens[plan.specimen].gauge_length
        if gauge is None:
            continue
        length = hose.length / gauge
        if np.isfinite(length) and not 1 / _BY_LENGTH <= length <= _BY_LENGTH:
            like = words_of_ratio(length, "length")
            yield plan.measured, note("hose-length-not-tested", plan.specimen, hose=hose.name,
                                      ratio=length, like=like)  # fmt: skip
        samples = survey.extremes.all_over.get(plan.specimen)
        model = models.get((plan.measured, plan.specimen))
        if samples is None or model is None or model.method == "extensometer":
            continue
        # the pins may be farther apart than the hose is long
        strain = strain_by_model(model, position=samples.position, tension=samples.tension)
        nodes, tension = _curve_at_nodes(strain, samples.tension)
        off = _misfit(hose.design, nodes, tension)
        if not off.size or not np.isfinite(off).all():
            continue  # faults of the design are reported by its prediction
        far = float(np.sqrt(np.mean(off**2)))
        if far > np.log(_AS_PREDICTED[loading]):
            ratio = float(np.exp(np.mean(off)))
            yield plan.measured, note(
                "hose-unlike-design", plan.specimen, hose=plan.predicted, ratio=ratio,
                low=float(nodes[0]), high=float(nodes[-1]), like=words_of_ratio(ratio),
                readings=_slips_that_fit(hose.design, nodes, tension, far),
            )  # fmt: skip


def _curve_at_nodes(strain: Floats, tension: Floats) -> tuple[Floats, Floats]:
    """Mean tension over loading and unloading at some strains, where it is positive."""
    top = float(np.nanmax(strain, initial=0.0))
    nodes, found = [], []
    for node in np.array(_NODES) * top:
        near = (np.abs(strain - node) < 0.05 * top) & np.isfinite(tension)
        level = float(np.median(tension[near])) if near.any() else np.nan
        if level > 0:
            nodes.append(node)
            found.append(level)
    return np.array(nodes), np.array(found)


def _misfit(design: HoseDesign, strain: Floats, tension: Floats) -> Floats:
    """Logarithm of measured over predicted tension; empty without a prediction."""
    if not strain.size:
        return np.empty(0)
    try:
        predicted = np.asarray(predict_hose(design, strain).tension)
    except ReductionError:
        return np.empty(0)
    return np.log(tension / predicted) if (predicted > 0).all() else np.empty(0)


def _slips_that_fit(design: HoseDesign, strain: Floats, tension: Floats, far: float) -> str:
    """Errors in one hose input that would make the design match the test."""
    fits = {}
    for (key, factor), words in _SLIPS.items():
        try:
            other = replace(design, **{key: getattr(design, key) * factor})
        except ReductionError:
            continue
        off = _misfit(other, strain, tension)
        if off.size and (left := float(np.sqrt(np.mean(off**2)))) < min(0.5 * far, _FITS):
            fits[words] = left
    return "; ".join(sorted(fits, key=lambda words: fits[words])[:_NAMED])


_NODES = (0.4, 0.6, 0.8, 0.95)  # of the maximum strain

_FITS = 0.15  # tolerance on the logarithm of measured over predicted tension

_NAMED = 3

_SLIPS = {
    ("cords_per_length", 2.0): "twice the cords_per_length (was one of two layers counted?)",
    ("cords_per_length", 0.5): "half the cords_per_length (were the layers counted twice?)",
    ("cords_per_length", 12.0): "cords_per_length per inch, not per foot",
    ("cords_per_length", 2.54): "cords_per_length per cm, not per inch",
    ("cords_per_length", 1 / 2.54): "cords_per_length per inch, not per cm",
    ("cord_load_scale", 2.0): "twice the load of a cord",
    ("cord_load_scale", 0.5): "half the load of a cord",
    ("cord_load_scale", _LBF): "load of a cord in lbf, not N",
    ("cord_load_scale", 1 / _LBF): "load of a cord in N, not lbf",
    ("inner_diameter", 2.0): "twice the inner_diameter (is it the radius of the bore?)",
    ("inner_diameter", 0.5): "half the inner_diameter",
    ("rubber_modulus", 3.0): "three times the rubber_modulus (is it a shear modulus?)",
    ("rubber_modulus", 1 / 3): "a third of the rubber_modulus",
    ("rubber_modulus", _PSI): "rubber_modulus in psi, not kPa",
    ("rubber_modulus", 1 / _PSI): "rubber_modulus in kPa, not psi",
}
"""Common errors in hose inputs, by the factor they apply to the input."""

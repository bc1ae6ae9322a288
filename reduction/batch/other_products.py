"""Change-in-length properties and outcomes of a campaign."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reduction import __version__
from reduction.archive.campaign_products import outcomes_to_dataset
from reduction.archive.open import Opener, reading
from reduction.archive.rope_properties import CHANGES_LENGTH, properties_to_dataset, step_of_archive
from reduction.archive.write import write_archive
from reduction.batch.reuse import NOT_REDUCED
from reduction.batch.survey import Survey
from reduction.batch.test_history import instruments_of
from reduction.campaign.plan import Campaign
from reduction.readers.raw_log import hash_source
from reduction.record.contributions import Component, InstrumentErrors
from reduction.record.measurement import Origin, Source, Specimen, Step
from reduction.stages.line.change_in_length import ChangeInLength, StepOfProgramme, change_in_length
from reduction.stages.strain.strain_model import StrainModel

_Models = Callable[[Survey], Sequence[StrainModel]]


@dataclass(frozen=True)
class _Found:
    """What the archives of the tests of one rope give."""

    steps: tuple[StepOfProgramme, ...]
    sources: tuple[Source, ...]
    missing: tuple[str, ...]
    is_programme: bool
    component: dict[str, tuple[Component, ...]]


def tests_of_ropes(campaign: Campaign, surveys: Sequence[Survey]) -> set[str]:
    """Tests that may be steps of the programme of a rope."""
    return {
        entry.plan.id
        for entry in surveys
        if entry.plan.part_of is None
        and any(campaign.specimens[name].is_rope for name in entry.plan.specimens)
    }


def write_change_in_length(
    campaign: Campaign,
    folder: Path,
    surveys: Sequence[Survey],
    *,
    models: _Models,
    failed: Collection[str],
    waiting: Collection[str],
    command: str,
    opener: Opener = reading,
) -> Path | None:
    """Write the change-in-length properties of the ropes of a campaign."""
    found: dict[str, tuple[ChangeInLength, ...]] = {}
    sources: dict[str, Source] = {}
    used: dict[str, list[str]] = {}
    component: dict[tuple[str, str], tuple[Component, ...]] = {}
    for name, specimen in campaign.specimens.items():
        if not specimen.is_rope:
            continue
        own, is_ordered = _in_order(surveys, name)
        known = {
            entry.plan.id: _instruments(campaign, entry, name, models(entry))
            for entry in own
            if entry.plan.id not in failed and entry.plan.id not in waiting
        }
        given = _read(folder, own, name, known, failed=failed, waiting=waiting, opener=opener)
        if not given.is_programme:
            continue
        found[name] = change_in_length(
            given.steps,
            loaded_before=_loaded_before(specimen, own, given.steps),
            is_ordered=is_ordered,
            missing="; ".join(given.missing),
            rated_break_strength=specimen.rated_break_strength or float("nan"),
        )
        sources |= {source.name: source for source in given.sources}
        used[name] = [one.name for one in given.steps]
        component |= {(name, step): own for step, own in given.component.items()}
    if not found:
        return None
    settings = {
        "tests": used,
        "specimens": {name: asdict(campaign.specimens[name]) for name in found},
    }
    origin = Origin(
        campaign_id=campaign.id,
        attributes=campaign.attributes,
        sources=tuple(sources.values()),
        steps=[
            Step("change in length", _properties_in_one_line(name, own))
            for name, own in found.items()
        ],
        settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False, allow_nan=False),
        version=__version__,
        command=command,
    )
    path = folder / "change_in_length.nc"
    write_archive(properties_to_dataset(found, component, origin=origin), path)
    return path


def _in_order(surveys: Sequence[Survey], name: str) -> tuple[list[Survey], bool]:
    """Tests of a specimen, oldest first, and whether that order is known."""
    own = [
        entry for entry in surveys if name in entry.plan.specimens and entry.plan.part_of is None
    ]
    is_ordered = (
        len({entry.plan.log for entry in own}) < 2
        or not any(entry.plan.order is None for entry in own)
    )  # fmt: skip
    if is_ordered:
        own.sort(key=lambda entry: (entry.plan.order or 0, entry.plan.step_place))
    return own, is_ordered


def _loaded_before(
    specimen: Specimen, own: Sequence[Survey], steps: Sequence[StepOfProgramme]
) -> str:
    """What a rope carried before the first step of which there are numbers; empty of a new one."""
    first = own[0].plan
    count = (specimen.earlier_cycles or 0) + (first.unlogged_cycles or 0)
    if count:
        return f"it had carried {count} cycles before the first test"
    if not steps or steps[0].name != first.id:
        return f"{first.id} came first, and gave no product"
    return ""


def _read(
    folder: Path,
    own: Sequence[Survey],
    specimen: str,
    known: Mapping[str, tuple[InstrumentErrors, StrainModel] | tuple[None, None]],
    *,
    failed: Collection[str],
    waiting: Collection[str],
    opener: Opener,
) -> _Found:
    steps, sources, missing, is_programme = [], [], [], False
    component = {}
    for entry in own:
        test = entry.plan.id
        if test in failed or test in waiting:
            missing.append(f"{test} {'failed' if test in failed else NOT_REDUCED}")
            continue
        path = folder / f"{test}.nc"
        # a test that neither failed nor waits has an archive of this run or as good as one
        with opener(path) as archive:
            found = step_of_archive(archive, specimen, *known[test])
            steps.append(found.step)
            component[found.step.name] = found.component
            kind = (
                str(archive.variables["programme_step"].values)
                if "programme_step" in archive
                else ""
            )
            is_programme |= kind in CHANGES_LENGTH
        sources.append(hash_source(path, path.name))
    return _Found(tuple(steps), tuple(sources), tuple(missing), is_programme, component)


def _instruments(
    campaign: Campaign, survey: Survey, specimen: str, models: Sequence[StrainModel]
) -> tuple[InstrumentErrors, StrainModel] | tuple[None, None]:
    """What is stated of the instruments of a specimen, and its strain; of weights neither."""
    errors = instruments_of(campaign, survey, models)
    pairs = zip(errors, models, strict=True)
    return next((pair for pair in pairs if pair[1].specimen == specimen), (None, None))


def _properties_in_one_line(name: str, own: Sequence[ChangeInLength]) -> str:
    known = sum(bool(np.isfinite(one.value)) for one in own)
    return f"{name}: {known} of {len(own)} properties have a number"


def results_found(campaign: Campaign) -> dict[str, Any] | None:
    """What the table of results holds, as `check` prints it."""
    if campaign.results is None:
        return None
    uses: dict[str, Counter[str]] = {}
    for outcome in campaign.outcomes:
        uses.setdefault(outcome.quantity, Counter())[outcome.use] += 1
    return {
        "file": campaign.results.name,
        "sha256": campaign.results.sha256,
        "outcomes": len(campaign.outcomes),
        "quantities": {
            quantity: {use: count[use] for use in ("value", "lower_bound", "excluded")}
            for quantity, count in uses.items()
        },
    }


def write_outcomes(campaign: Campaign, folder: Path, *, command: str) -> Path | None:
    """Write the outcomes of a campaign."""
    if campaign.results is None:
        return None
    path = folder / "outcomes.nc"
    named = {outcome.specimen for outcome in campaign.outcomes}
    sheets = {name: asdict(sheet) for name, sheet in campaign.specimens.items() if name in named}
    settings = {"results": campaign.results.name, "specimens": sheets}
    dataset = outcomes_to_dataset(
        campaign.outcomes,
        origin=Origin(
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            sources=(campaign.results,),
            steps=(Step("outcomes", _outcomes_in_one_line(campaign)),),
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False, allow_nan=False),
            version=__version__,
            command=command,
        ),
    )
    write_archive(dataset, path)
    return path


def _outcomes_in_one_line(campaign: Campaign) -> str:
    counts = Counter(outcome.quantity for outcome in campaign.outcomes)
    listed = ", ".join(f"{number} {quantity}" for quantity, number in counts.items())
    completed = sum(bool(outcome.specimen) for outcome in campaign.outcomes)
    sheets = f"; {completed} rows completed from sheets of specimens" if completed else ""
    return f"read {listed}{sheets}"

"""The way of the data in one test: from a located record to strain, cycles, moduli, holds.

Before it, for every test of a campaign: `reduction.pipeline.locate` finds where the crosshead
stands still and where it cycles, `reduction.batch.survey` measures the tension at the splice
marks there, and `reduction.batch.models` pools the marks of a specimen into strain models.
`reduce_test` does the rest; what the cycles give is in `reduction.pipeline.cyclic`, what the
first rise gives in `reduction.pipeline.loading`.  `reduce_stepwise_test` is for tests read by
a person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from reduction.cycles.label import label_phases
from reduction.errors import DataError
from reduction.holds.reduce import reduce_holds
from reduction.line.product import SlowPull
from reduction.moduli.slack import slack_strain_at_unloading
from reduction.moduli.stepwise import reduce_stepwise
from reduction.phases.standstill import Standstills
from reduction.pipeline.cyclic import parts_of_cycles
from reduction.pipeline.loading import parts_of_first_loading
from reduction.pipeline.locate import HELD, PULLED, Located
from reduction.pipeline.plausibility import plausibility_notes
from reduction.pipeline.programme import rope_step
from reduction.pipeline.rope import PullConditions, parts_of_line, pull_specimens
from reduction.pipeline.shared.contributions import (
    contributions_of_test,
    shared_uncertainty_of_cycles,
)
from reduction.pipeline.shared.lag import lag_of_test
from reduction.pipeline.shared.montecarlo import with_line_spread
from reduction.pipeline.shared.pulls import PullOrigin
from reduction.pipeline.shared.ratio import with_shared_ratios
from reduction.pipeline.shared.weights import with_shared_steps
from reduction.pipeline.spread import strain_spread, with_stated_channels
from reduction.product import History, ReducedTest, TestDescription
from reduction.provenance import Source, Step
from reduction.record import Floats, Quality, Record, Specimen, StepReadings, areas_of
from reduction.settings import ReductionSettings
from reduction.strain.evaluate import extrapolated, strain_by_model
from reduction.strain.model import StrainModel
from reduction.strain.stress import check_constant_volume, nominal_stress
from reduction.uncertainty.product import InstrumentErrors
from reduction.workers import run_blocks

__all__ = ["reduce_stepwise_test", "reduce_test", "strain_of_record"]

_BLOCK = 1 << 16  # samples that stay in the cache


def reduce_test(
    located: Located,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    models: Sequence[StrainModel],
    history: History | None,
    sources: tuple[Source, ...],
    settings: ReductionSettings,
    settings_json: str,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
    pull_conditions: PullConditions | None = None,
    instruments: Sequence[InstrumentErrors] = (),
) -> ReducedTest:
    """Reduce one located test.

    Parameters
    ----------
    located : Located
        From `locate`.
    description : TestDescription
        What the laboratory kept.
    specimens : tuple of Specimen, length n_specimens
        In the order of the record.
    models : sequence of StrainModel, length n_specimens
        How position becomes strain.
    history : History or None
        What the specimens had seen before.
    sources : tuple of Source
        Raw files.
    settings : ReductionSettings
        In force.
    settings_json : str
        The same with everything else that was in force, for the product.
    pulls : sequence of SlowPull or None, length n_specimens, optional
        Slow pull of each specimen; with it the loops give a three-parameter line.
    pull_origins : sequence of PullOrigin or None, length n_specimens, optional
        With what each pull was read, where that was not the instruments of this test.
    pull_conditions : PullConditions, optional
        What a slow pull cannot tell of itself.
    instruments : sequence of InstrumentErrors, length n_specimens, optional
        What is known of the errors that all samples share; nothing where it is left out.

    Returns
    -------
    test : ReducedTest
        Ready for the archive.

    Raises
    ------
    DataError
        If the record cannot support a stage that its kind needs.
    """
    record, standstills, cycles = located.record, located.standstills, located.cycles
    position, tension = located.position, located.tension
    phase = label_phases(record.n_samples, standstills=standstills, cycles=cycles)
    strain = strain_of_record(record, position, tension, models)
    parts = parts_of_cycles(
        located, strain, tension, specimens=specimens, history=history, settings=settings
    )
    parts |= parts_of_first_loading(
        located, strain, tension, specimens, settings, history, kind=description.kind
    )
    spread = strain_spread(located, models, phase=phase, instruments=instruments)
    located = with_stated_channels(located, instruments, phase=phase)
    parts |= _stress(located.record, tension, specimens, instruments)
    if pulls is not None and "loops" in parts:
        parts |= parts_of_line(parts["loops"], pulls, settings.cycles)
    if description.kind in PULLED:
        parts["pulls"], refused = pull_specimens(
            located, strain, tension, pull_conditions or PullConditions(),
            specimens=specimens, models=models,
        )  # fmt: skip
        parts["notes"] = [*parts.get("notes", []), *refused]
    holds = reduce_holds(
        record.time, position, tension, strain, standstills,
        specimens=record.specimens, settings=settings.holds,
        kind="relaxation" if standstills.tension_tolerance is None else "creep",
    )  # fmt: skip
    slack, slack_uncertainty, remarks = slack_strain_at_unloading(
        position,
        tension,
        slack_tension=standstills.slack_tension,
        relaxed_free_length=np.array([model.relaxed_length for model in models]),
    )
    notes = [note for specimen in specimens for note in check_constant_volume(specimen)]
    notes += parts.pop("notes", [])
    notes += [
        f"{specimen.name}: no diameter is stated: spring constants, but no stress and no modulus"
        for specimen in specimens
        if not specimen.diameter
    ]
    if description.kind in HELD and not holds:
        notes.append(_no_hold(standstills, settings))
    notes += plausibility_notes(
        strain, specimens=record.specimens, slack_tension=standstills.slack_tension,
        waveform=settings.cycles.waveform, control=settings.cycles.control, cycles=cycles,
        loops=parts.get("loops"), curves=parts.get("curves"),
        is_snap=description.kind == "snap",
    )  # fmt: skip
    notes += [
        f"{name}: {text}" for name, text in zip(record.specimens, remarks, strict=True) if text
    ]
    if cycles is not None:
        parts["channel_lag"], told = lag_of_test(
            record, position, tension, cycles, stated=[one.lag for one in instruments]
        )
        notes += told
    test = ReducedTest(
        description=description,
        specimens=specimens,
        record=_flag(located, models),
        sources=sources,
        stage_lines=_stage_lines(located, models),
        settings_json=settings_json,
        notes=tuple(dict.fromkeys(notes)),
        history=history,
        standstills=standstills,
        phase=phase,
        strain=strain,
        strain_standard_uncertainty=spread,
        strain_models=tuple(models),
        cycles=cycles,
        holds=holds,
        slack_strain_at_unloading=slack,
        slack_strain_at_unloading_standard_uncertainty=slack_uncertainty,
        rope_step=rope_step(
            located,
            strain,
            tension,
            kind=description.kind,
            specimens=specimens,
            loops=parts.get("loops"),
            holds=holds,
            failed=description.failed,
            settings=settings.rope,
        ),
        **parts,
    )
    if instruments:
        test = replace(
            test,
            contributions=contributions_of_test(
                test,
                instruments,
                cycles=settings.cycles,
                pulls=pulls,
                pull_origins=pull_origins,
            ),
            shared_uncertainty_of_cycles=shared_uncertainty_of_cycles(
                test, instruments, cycles=settings.cycles
            ),
        )
    return with_line_spread(with_shared_ratios(test), settings.cycles)


def reduce_stepwise_test(
    readings: StepReadings,
    *,
    description: TestDescription,
    specimens: tuple[Specimen, ...],
    history: History | None,
    sources: tuple[Source, ...],
    settings_json: str,
    instruments: Sequence[InstrumentErrors] = (),
) -> ReducedTest:
    """Reduce a stepwise test of one specimen; parameters as in `reduce_test`."""
    if len(specimens) != 1:
        raise DataError(
            f"stepwise test '{description.test_id}' has several specimens",
            found=str(len(specimens)),
            needed="one",
        )
    specimen = specimens[0]
    stepwise = reduce_stepwise(
        readings, area=specimen.area, stated_gauge_length=specimen.gauge_length
    )
    test = ReducedTest(
        description=description,
        specimens=specimens,
        record=None,
        sources=sources,
        stage_lines=(
            Step("ingest", f"{readings.tension.size} readings"),
            Step("moduli", "gauge length recovered, slopes between readings"),
        ),
        settings_json=settings_json,
        notes=check_constant_volume(specimen),
        history=history,
        stepwise=stepwise,
    )
    return with_shared_steps(test, instruments)


def _flag(located: Located, models: Sequence[StrainModel]) -> Record:
    """The record with the flags that only cycles and strain models can set."""
    record, cycles = located.record, located.cycles
    flags = record.quality_flag.copy()
    of_position = record.crosshead_position_quality_flag
    for index, model in enumerate(models):
        outside = extrapolated(model, record.crosshead_position, record.tension[index])
        flags[index][outside] |= np.uint16(Quality.EXTRAPOLATED)
    if cycles is not None:
        uneven = (cycles.cycle_number > 0) & ~cycles.is_constant_rate
        flags[:, uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
        of_position = of_position.copy()
        of_position[uneven] |= np.uint16(Quality.NOT_CONSTANT_RATE)
    return replace(record, quality_flag=flags, crosshead_position_quality_flag=of_position)


def strain_of_record(
    record: Record, position: Floats, tension: Floats, models: Sequence[StrainModel]
) -> Floats:
    """Strain of each specimen; NaN where position, or a tension that it needs, is not usable."""
    strain = np.empty_like(tension)
    measured = record.measured_strain

    def fill(place: tuple[int, slice]) -> None:
        index, part = place
        strain[place] = strain_by_model(
            models[index],
            position=position[part],
            tension=tension[place],
            measured_strain=None if measured is None else measured[place],
        )

    starts = range(0, record.n_samples, _BLOCK)
    run_blocks(
        fill, [(row, slice(low, low + _BLOCK)) for row in range(len(models)) for low in starts]
    )
    return strain


def _stress(
    record: Record,
    tension: Floats,
    specimens: tuple[Specimen, ...],
    instruments: Sequence[InstrumentErrors],
) -> dict[str, Any]:
    """Nominal stress, where a diameter is known; NaN where tension is not usable."""
    if not any(specimen.diameter for specimen in specimens):
        return {}
    stress = np.full_like(tension, np.nan)
    for row, specimen in enumerate(specimens):
        if specimen.diameter:
            stress[row] = nominal_stress(tension[row], area=specimen.area)
    spread = record.tension_standard_uncertainty
    if not spread:
        return {"nominal_stress": stress}
    of_stress = np.array(spread) / areas_of(specimens)
    for row, errors in enumerate(instruments):
        if errors.diameter and specimens[row].diameter:
            level = np.sqrt(np.nanmean(stress[row] ** 2))
            share = 2 * errors.diameter / specimens[row].mean_diameter
            of_stress[row] = np.hypot(of_stress[row], level * share)
    return {"nominal_stress": stress, "nominal_stress_standard_uncertainty": of_stress}


def _no_hold(standstills: Standstills, settings: ReductionSettings) -> str:
    """Why a test that was to be held has no number of a hold."""
    if standstills.tension_tolerance is None:
        channel, tolerance, key = (
            "the crosshead", f"{standstills.position_tolerance:.3g} m", "position_tolerance",
        )  # fmt: skip
    else:
        channel, tolerance, key = (
            "the tension", f"{standstills.tension_tolerance:.3g} N", "tension_tolerance",
        )  # fmt: skip
    return (
        f"refused: everything about holds: none is found; above the slack tension of "
        f"{standstills.slack_tension:.3g} N {channel} nowhere keeps within {tolerance} for "
        f"{settings.phases.minimum_duration:g} s (kind and control right? else state "
        f"phases.{key})"
    )


def _stage_lines(located: Located, models: Sequence[StrainModel]) -> tuple[Step, ...]:
    """One line a stage, with the numbers it found."""
    record, standstills, cycles = located.record, located.standstills, located.cycles
    lines = [
        Step("ingest", f"{record.n_rows_read} rows read, {record.n_samples} kept"),
        Step(
            "phases",
            f"{standstills.n_standstills} standstills within "
            f"{standstills.position_tolerance:.4g} m"
            + (
                ""
                if standstills.tension_tolerance is None
                else f", holds on tension within {standstills.tension_tolerance:.4g} N"
            )
            + f", slack at {standstills.slack_tension:.4g} N",
        ),
    ]
    for model in models:
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in model.coefficients.items())
        lines.append(Step("strain", f"{model.specimen} by {model.method}: {numbers}"))
    if cycles is not None:
        lines.append(
            Step("cycles", f"{cycles.n_cycles} by {cycles.counted_by}, band {cycles.band:.4g}")
        )
        lines.append(Step("moduli", "regression in a moving window on a strain grid, SI"))
    return tuple(lines)

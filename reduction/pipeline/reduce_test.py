"""The way of one test: from its located record to strain, cycles, moduli and holds.

Before it, for every test of a campaign: `reduction.pipeline.located_test` finds where the crosshead
stands still and where it cycles, `reduction.pipeline.located_test` measures the tension at the
splice marks there, and `reduction.batch.test_history` pools the marks of a specimen into strain
models.
`reduce_test` does the rest; what the cycles give is in `reduction.pipeline.cyclic_test`, what the
first rise gives in `reduction.pipeline.cyclic_test`.  `reduce_stepwise_test` is for tests read by
a person.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reduction.pipeline.cyclic_test import parts_of_cycles, parts_of_first_loading
from reduction.pipeline.located_test import (
    PULLED,
    Located,
    flagged_record,
    parts_of_stress,
    strain_of_record,
)
from reduction.pipeline.plausibility import (
    channel_contributions,
    reading_spread,
    readings_of,
    with_readings,
)
from reduction.pipeline.rope_test import PullConditions, parts_of_line, pull_specimens, rope_step
from reduction.pipeline.test_notes import notes_of_test, stage_lines
from reduction.record.contributions import Contributions, InstrumentErrors, merged
from reduction.record.errors import DataError
from reduction.record.measurement import Source, Specimen, Step, StepReadings
from reduction.record.settings import CycleSettings, ReductionSettings
from reduction.stages.cycles.cycle_search import label_phases
from reduction.stages.holds.reduce_holds import reduce_holds
from reduction.stages.line.line_product import SlowPull
from reduction.stages.moduli.slack_length import slack_strain_at_unloading
from reduction.stages.moduli.stepwise_test import reduce_stepwise
from reduction.stages.reduced_test import History, ReducedTest, TestDescription
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.strain.stress import check_constant_volume
from reduction.uncertainty.monte_carlo import with_line_spread
from reduction.uncertainty.shared_contributions import (
    PullOrigin,
    contributions_of_test,
    lag_of_test,
    shared_uncertainty_of_cycles,
    with_shared_steps,
)
from reduction.uncertainty.shared_curves import with_shared_ratios


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
    phase = label_phases(record.time, standstills=standstills, cycles=cycles)
    strain = strain_of_record(record, position, tension, models)
    readings = readings_of(record, instruments)
    stated = replace(located, record=with_readings(record, readings))
    of_cycles = parts_of_cycles(
        located, strain, tension, specimens=specimens, history=history, settings=settings,
    )  # fmt: skip
    of_first_rise, first_rise_notes = parts_of_first_loading(
        located, strain, tension, specimens, settings, history, kind=description.kind,
    )  # fmt: skip
    of_line = (
        parts_of_line(of_cycles["loops"], pulls, settings.cycles)
        if pulls is not None and "loops" in of_cycles
        else {}
    )
    of_pulls, refused_pulls = (
        pull_specimens(
            located, strain, tension, pull_conditions or PullConditions(),
            specimens=specimens, models=models,
        )
        if description.kind in PULLED
        else ((), ())
    )  # fmt: skip
    holds = reduce_holds(
        record.time, position, tension, strain, standstills,
        specimens=record.specimens, settings=settings.holds,
        kind="relaxation" if standstills.tension_tolerance is None else "creep",
    )  # fmt: skip
    slack_strain = slack_strain_at_unloading(
        position,
        tension,
        slack_tension=standstills.slack_tension,
        relaxed_free_length=np.array([model.relaxed_length for model in models]),
        time=record.time,
    )
    lag, lag_notes = (
        (None, ())
        if cycles is None
        else lag_of_test(record, position, tension, cycles, stated=[one.lag for one in instruments])
    )
    notes = notes_of_test(
        located, strain, kind=description.kind, specimens=specimens, settings=settings, holds=holds,
        parts=of_cycles, of_stages=(*first_rise_notes, *refused_pulls),
        slack_remarks=slack_strain.remarks,
    )  # fmt: skip
    reduced = ReducedTest(
        description=description,
        specimens=specimens,
        record=flagged_record(stated, models),
        sources=sources,
        stage_lines=stage_lines(located, models),
        settings_json=settings_json,
        notes=(*notes, *lag_notes),
        history=history,
        standstills=standstills,
        phase=phase,
        strain=strain,
        strain_standard_uncertainty=reading_spread(located, models, readings, phase=phase),
        strain_models=tuple(models),
        cycles=cycles,
        holds=holds,
        pulls=of_pulls,
        channel_lag=lag,
        slack_strain=slack_strain,
        rope_step=rope_step(
            located, strain, tension, kind=description.kind, specimens=specimens,
            loops=of_cycles.get("loops"), holds=holds, failed=description.failed,
            settings=settings.rope,
        ),
        **of_cycles,
        **of_first_rise,
        **of_line,
        **parts_of_stress(stated.record, specimens),
    )  # fmt: skip
    shared = _with_shared_errors(
        reduced,
        instruments,
        settings=settings.cycles,
        pulls=pulls,
        pull_origins=pull_origins,
        of_channels=channel_contributions(
            located, strain, models, specimens, instruments, phase=phase
        ),
    )
    return with_line_spread(with_shared_ratios(shared), settings.cycles)


def _with_shared_errors(
    test: ReducedTest,
    instruments: Sequence[InstrumentErrors],
    *,
    settings: CycleSettings,
    pulls: Sequence[SlowPull | None] | None,
    pull_origins: Sequence[PullOrigin | None],
    of_channels: Contributions,
) -> ReducedTest:
    """The test with what errors that all its samples share do to its numbers, where stated."""
    if not instruments:
        return test
    of_numbers = contributions_of_test(
        test, instruments, cycles=settings, pulls=pulls, pull_origins=pull_origins
    )
    whole = merged([of_channels] if of_numbers is None else [of_numbers, of_channels])
    return replace(
        test,
        contributions=whole if whole.component else None,
        shared_uncertainty_of_cycles=shared_uncertainty_of_cycles(
            test, instruments, cycles=settings, pulls=pulls, pull_origins=pull_origins
        ),
    )


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

"""A reduced test: everything that one log gave, ready for the archive.

`reduction.pipeline` makes it and `reduction.archive` stores it; neither knows the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from reduction.record.contributions import Contributions, LineSpread
from reduction.record.measurement import Floats, Integers, Record, Source, Specimen, Step
from reduction.record.notes import Note, by_severity, note
from reduction.stages.channel_lag import LagEstimate
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.holds.hold_product import HoldResult, hold_numbers
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    CycleIdentity,
    ElastomerFit,
    EndModuli,
    ModulusCurves,
    PeakTrend,
    Ratio,
    Segments,
    Slips,
)
from reduction.stages.moduli.slack_length import SlackStrain
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.standstills import Standstills
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.line_product import LineParameters, SlowPull
from reduction.stages.three_parameter_line.rope_programme import RopeStep


@dataclass(frozen=True)
class TestDescription:
    """What the laboratory recorded about a test; text as given, empty where not given.

    ``attributes`` holds campaign-level attributes (title, institution, source,
    references, license, and ``synthetic = "yes"`` where the data are synthetic) and
    test-level ones (machine, load_cell, calibration_due, medium, temperature, ...).
    ``failed`` is whether the specimens broke, in the laboratory's word; None where not stated.
    """

    __test__ = False  # a test of a tether, not of this software

    campaign_id: str
    test_id: str
    kind: str
    control: str
    waveform: str
    order: int | None
    attributes: dict[str, str]
    failed: bool | None = None


@dataclass(frozen=True)
class History:
    """What each specimen had undergone before this test, shape (n_specimens,) each.

    ``permanent_set`` is how much longer it is when it first becomes taut than at the
    start of its first test, over the free length: what remains of the earlier tests after
    rest. NaN where one of the two records does not begin slack. [1]
    ``permanent_set_by_tension`` is its change with the tension that counts as
    slack. [N-1]
    ``splices_slipped_by`` is the least length by which the splices slipped since the marks that its
    strain rests on were read. [m]
    ``earlier_flex_cycles`` is None where nothing is known about flexing.
    """

    earlier_tests: tuple[tuple[str, ...], ...]
    earlier_maximum_strain: Floats
    earlier_maximum_tension: Floats
    earlier_cycles: Floats
    permanent_set: Floats
    permanent_set_standard_uncertainty: Floats
    permanent_set_by_tension: Floats
    splices_slipped_by: Floats
    earlier_flex_cycles: Floats | None = None


@dataclass(frozen=True)
class ReducedTest:
    """One reduced test with all its specimens.

    ``record`` is None for a stepwise test, which has readings (`stepwise`) and no log.
    ``strain`` [1] has shape (n_specimens, n_samples); its standard uncertainty and that of
    nominal stress [Pa] have one value per specimen.  It is NaN where a sample is not usable,
    while ``record`` keeps what was logged.  Nominal stress is tension over an area, and is
    computed where it is stored.  Parts that this kind of test does not give are
    None (or empty); `notes` are the quality notes a reader must see,
    `stage_lines` the lines of the history, `settings_json` every setting in force.
    ``line`` has one entry per cycle and ``line_of_test`` one per specimen, from the means over the
    cycles, with ``quasi_static_standard_uncertainty`` [N] of the K_0 that both used and, in
    ``line_spread``, their uncertainty from random and shared errors together; ``pulls``
    is the result of a slow pull, None for a specimen without one; ``rope_step`` is
    the test as a step of a rope laboratory's programme.  Uncertainties of loops, curves,
    segments, holds and trends are random (type A); those of strain, of stress and in
    ``line_spread`` include the shared part.  ``contributions`` holds what errors that samples
    share add to curves, segments and means of the test, by archive name, and
    ``shared_uncertainty_of_cycles`` [unit of each] the same for each cycle, all sources together;
    ``channel_lag`` is what the turns of the wave say about one of them; nothing is corrected by it.
    """

    description: TestDescription
    specimens: tuple[Specimen, ...]
    record: Record | None
    sources: tuple[Source, ...]
    stage_lines: tuple[Step, ...]
    settings_json: str
    notes: tuple[Note, ...]
    history: History | None = None
    standstills: Standstills | None = None
    phase: Integers | None = None
    strain: Floats | None = None
    strain_standard_uncertainty: Floats | None = None
    nominal_stress_standard_uncertainty: Floats | None = None
    strain_models: tuple[StrainModel, ...] = ()
    cycles: Cycles | None = None
    loops: Loops | None = None
    curves: ModulusCurves | None = None
    first_loading: ModulusCurves | None = None
    segments: Segments | None = None
    end_moduli: EndModuli | None = None
    identity: CycleIdentity | None = None
    amplitude: AmplitudeSummary | None = None
    trend: PeakTrend | None = None
    slips: Slips | None = None
    ratios: tuple[Ratio, ...] = ()
    elastomers: tuple[ElastomerFit, ...] = ()
    holds: tuple[HoldResult, ...] = ()
    stress_at_strain: Floats | None = None
    stress_at_strain_standard_uncertainty: Floats | None = None
    stress_at_strain_levels: tuple[float, ...] = ()
    slack_strain: SlackStrain | None = None
    stepwise: StepwiseResult | None = None
    loop_notes: tuple[Note, ...] = ()
    line: LineParameters | None = None
    line_of_test: LineParameters | None = None
    quasi_static_standard_uncertainty: Floats | None = None
    line_notes: tuple[Note, ...] = ()
    line_spread: LineSpread | None = None
    pulls: tuple[SlowPull | None, ...] = ()
    rope_step: RopeStep | None = None
    contributions: Contributions | None = None
    shared_uncertainty_of_cycles: dict[str, Floats] = field(default_factory=dict)
    channel_lag: LagEstimate | None = None

    def all_notes(self) -> tuple[Note, ...]:
        """Every note with its stage, most serious first, none twice.

        Notes equal in that are in the order of the stages.
        A note of the test that a stage also gave is listed under the stage alone.
        """
        given = [
            replace(one, stage=stage) for stage, notes, _ in self._of_stages() for one in notes
        ]
        said = {str(one) for one in given}
        own = [one for one in self.notes if str(one) not in said]
        given += [replace(one, stage=one.stage or "test") for one in own]
        return by_severity({(one.stage, str(one)): one for one in given}.values())

    def all_steps(self) -> tuple[Step, ...]:
        """Every line of the history: one per stage, then how individual numbers were made."""
        made = ((stage, line) for stage, _, lines in self._of_stages() for line in lines)
        return (*self.stage_lines, *(Step(stage, line) for stage, line in made))

    def _of_stages(self) -> Iterator[tuple[str, Sequence[Note], Sequence[str]]]:
        """Each stage by name, with its notes and how its numbers were made."""
        yield "loops", self.loop_notes, ()  # first: a reversed channel makes the others void
        if self.record is not None:
            yield "ingest", self.record.notes, ()
        for specimen in self.specimens:
            said = [note("laboratory", text=text) for text in specimen.notes]
            yield f"specimen {specimen.name}", said, ()
        for model in self.strain_models:
            yield f"strain {model.specimen}", model.notes, model.made
        stages = (
            ("cycles", self.cycles),
            ("moduli", self.curves),
            ("identity", self.identity),
            ("first loading", self.first_loading),
            ("slips", self.slips),
            ("stepwise", self.stepwise),
        )
        for stage, product in stages:
            if product is not None:
                yield stage, product.notes, getattr(product, "made", ())
        yield "line", self.line_notes, ()
        if self.rope_step is not None:
            yield self.rope_step.name, self.rope_step.notes, ()
        for ratio in self.ratios:
            yield "comparison", ratio.notes, ()
        for fit in self.elastomers:
            yield f"{fit.law} {fit.specimen}", fit.notes, ()
        for number, hold in zip(hold_numbers(self.holds), self.holds, strict=True):
            yield f"hold {number} {hold.specimen}", (*hold.notes, *hold.refusals), hold.made

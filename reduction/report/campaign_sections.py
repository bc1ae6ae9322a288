"""Sections of experiments, hoses, comparisons, outcomes and ropes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np
import xarray as xr

from reduction.archive.open import Opener, reading
from reduction.experiments.fit_results import FIT_REASONS, ResponseSurfaces
from reduction.experiments.outcome_groups import odd_outcomes
from reduction.quantities.digits import fixed_number, places_of
from reduction.quantities.units import UnitSystem
from reduction.record.errors import ArchiveError
from reduction.record.note_sentences import CAUSES
from reduction.record.notes import Note, urgency
from reduction.report.campaign_summary import SummaryFinding, Tile
from reduction.report.experiment_tables import (
    anova_table,
    answer_table,
    block_words,
    caution_table,
    coefficient_budget_table,
    coefficient_budgets,
    confounding_words,
    effect_table,
    experiment_findings,
    form_quality_table,
    form_table,
    form_words,
    line_of_runs_table,
    negative_inside,
    negative_words,
    quality_table,
    quality_words,
    run_table,
    single_time_words,
    stationary_words,
    surface_coefficient_table,
)
from reduction.report.figures.budget_figures import draw_coefficient_budgets
from reduction.report.figures.experiment_figures import (
    draw_checks,
    draw_contours,
    draw_effects,
    draw_forms,
    draw_single_time,
    draw_surface,
    make_planes,
)
from reduction.report.figures.hold_figures import draw_creep, draw_held_pairs, draw_stiffness
from reduction.report.figures.hose_figures import (
    draw_all_comparisons,
    draw_all_hoses,
    draw_budget,
    draw_chart,
    draw_compared_pressure,
    draw_comparison,
    draw_cycle_bias,
    draw_error,
    draw_limits,
    draw_pressure,
    draw_tension,
)
from reduction.report.outcome_tables import (
    answer_of_ropes,
    bedding_table,
    creep_table,
    draw_exposure,
    draw_lives,
    exposure_table,
    fatigue_table,
    level_table,
    load_life_table,
    pair_table,
    property_table,
    rope_notes,
    snap_sentences,
    snap_table,
    strength_table,
)
from reduction.report.prediction_tables import (
    answer_of_hoses,
    calibration_table,
    compared_curve_table,
    compared_event_table,
    cord_table,
    correlation_table,
    energy_table,
    hose_curve_table,
    hose_design_table,
    hose_event_table,
    layer_table,
    verdict_table,
)
from reduction.report.product_views import (
    ComparisonView,
    ExperimentView,
    HoseView,
    OutcomeView,
    RopeView,
    in_words,
    view_outcomes,
    view_ropes,
)
from reduction.report.test_section import Part, TestSection, make_part, provenance_of
from reduction.report.test_view import RowView, TestView
from reduction.report.text_style import DEGREES, PageTable, number_text, shown


def _make_experiment_section(view: ExperimentView, tests: Mapping[str, TestView]) -> TestSection:
    """Return the section of one experiment."""
    surfaces = view.surfaces
    parts = [
        make_part("What was run", (), [run_table(view, tests), caution_table(view)]),
        *(_surface_parts(view, surfaces, tests) if surfaces is not None else []),
        *_effect_parts(view),
        make_part(
            "The three-parameter line",
            draw_single_time(view, tests),
            [line_of_runs_table(view, tests)],
            single_time_words(view),
        ),
        make_part(
            "Stiffness as mooring codes ask for it", draw_forms(view),
            [form_table(view), form_quality_table(view)], form_words(view),
        ),
    ]  # fmt: skip
    kind = view.text("experiment_kind").replace("box-behnken", "Box-Behnken")
    kind = kind.replace("plackett-burman", "Plackett-Burman")
    of = ", ".join(in_words(name) for name in view.factors)
    return _section_of(
        view,
        title=f"Experiment {view.name}",
        subtitle=f"{kind} design over {of}; {len(view.runs)} runs",
        parts=parts,
    )


def _section_of(view: RowView, *, title: str, subtitle: str, parts: Sequence[Part]) -> TestSection:
    """Section of one row of a product of the campaign; parts without content are left out."""
    notes = list(map(str, view.notes))
    provenance, documents = provenance_of(view.data.attrs)
    return TestSection(
        key=view.key,
        title=title,
        subtitle=subtitle,
        parts=tuple(part for part in parts if part.figures or part.tables or part.sentences),
        notes=(("Notes on these numbers", notes),) if notes else (),
        provenance=provenance,
        documents=documents,
        noun=view.KIND,
    )


def _surface_parts(
    view: ExperimentView, surfaces: ResponseSurfaces, tests: Mapping[str, TestView]
) -> list[Part]:
    order = {
        name: int(test.attribute("test_order"))
        for name, test in tests.items()
        if test.attribute("test_order").isdigit()
    }
    planes = make_planes(view, surfaces)
    negative = negative_inside(surfaces)
    parts = [make_part("Quality of the surfaces", (), [quality_table(view, surfaces)])]
    for index, name in enumerate(surfaces.response_names):
        heading = in_words(name)
        if surfaces.reason[index] in _NO_SURFACE:
            reason = FIT_REASONS[int(surfaces.reason[index])]
            parts.append(make_part(_capital(heading), (), (), [f"No surface: {reason}."]))
            continue
        on_planes = []
        if planes is not None:
            on_planes = [
                *draw_surface(view, surfaces, index, planes),
                *draw_contours(view, surfaces, index, planes),
            ]
        budgets = coefficient_budgets(view, surfaces, index)
        shares = f"{heading}, shares of the variance"
        parts.append(
            make_part(
                _capital(heading),
                on_planes,
                (),
                [
                    quality_words(view, surfaces, index),
                    stationary_words(view, surfaces, index),
                    *block_words(view, surfaces, index),
                ],
                folded=make_part(
                    f"{_capital(heading)}: coefficients, analysis of variance, residuals",
                    [
                        *draw_coefficient_budgets(view, f"budget-{index}", shares, budgets),
                        *draw_checks(view, surfaces, index, order),
                    ],
                    [
                        surface_coefficient_table(view, surfaces, index),
                        coefficient_budget_table(name, budgets),
                        anova_table(view, surfaces, index),
                    ],
                ),
                warnings=negative_words(view, surfaces, name, negative),
            )
        )
    return parts


_NO_SURFACE = (1, 2, 6)


def _effect_parts(view: ExperimentView) -> list[Part]:
    if not view.is_screening:
        return []
    words = confounding_words(view)
    parts = []
    for name in view.responses:
        reason = view.text(f"{name}_effect_refusal")
        parts.append(
            make_part(
                f"Effects on the {in_words(name)}", draw_effects(view, name),
                [effect_table(view, name)], [f"No effects: {reason}."] if reason else words,
            )
        )  # fmt: skip
        words = []
    return parts


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


_HOLDS = (
    "Predicted from the construction alone, without any test of the hose. Valid for a slow pull on"
    " a long, straight, closed, water-filled hose, with the static curve of one cord. Not valid in"
    " compression, where a hose buckles; for cycles or fast pulls, where cords and rubber are"
    " stiffer; or at the ends, which often fail first in a real hose."
)


def _make_hose_section(view: HoseView) -> TestSection:
    """Return the section of one hose; empty parts are left out."""
    parts = [
        make_part(
            "Tension and fill pressure",
            [*draw_tension(view), *draw_pressure(view), *draw_budget(view)],
            [hose_event_table(view)], [_story(view), _HOLDS],
            folded=make_part("The curve as numbers", (), [hose_curve_table(view)]),
            warnings=[str(one) for one in view.notes if one.severity == "warning"],
        ),
        make_part("Strain of the cords", [*draw_chart(view), *draw_limits(view)]),
        make_part("Layers that carry no load", (), [layer_table(view)]),
        make_part("Construction", (), [hose_design_table(view), cord_table(view)]),
    ]  # fmt: skip
    return _section_of(
        view,
        title=f"Predicted hose {view.name}",
        subtitle=(
            f"wrap angle {DEGREES.factor * view.wrap_angle:.4g} deg from the axis;"
            f" {view.scalar('number_of_cords'):.0f} cords in two layers; {view.text('rubber_law')}"
            " rubber"
        ),
        parts=parts,
    )


def _hose_findings(view: HoseView) -> list[SummaryFinding]:
    """Return what a reader must know about a hose before its numbers."""
    return [
        SummaryFinding(one.severity, (f"hose {view.name}",), str(one), urgency(one))
        for one in view.notes
    ]


def _hose_tiles(views: Sequence[HoseView]) -> list[Tile]:
    """Return the number of predicted hoses; for a single one its loads, too."""
    if not views:
        return []
    noun = "predicted hose" if len(views) == 1 else "predicted hoses"
    found = [Tile(f"{len(views):,}", noun, views[0].key)]
    if len(views) == 1:
        force = shown("tension", views[0].units)
        load = number_text(force.factor * views[0].events["working"].tension)
        found.append(Tile(f"{load} {force.unit}", "safe working load", views[0].key))
    return found


def _story(view: HoseView) -> str:
    """Return the events as a sentence."""
    force = shown("tension", view.units)
    events = view.events

    def at(name: str) -> str:
        tension = force.factor * events[name].tension
        load = fixed_number(tension, places_of(tension, 3))
        return f"{100 * events[name].strain:.1f}\N{NO-BREAK SPACE}% ({load} {force.unit})"

    start = (
        f"The rubber carries all load up to {at('pick_up')}, where the cords pick up; before that"
        f" the cords are slack by up to {-100 * events['deepest_slack'].cord_strain:.1f} % of their"
        " length."
        if view.is_slack_at_first
        else "The cords carry load from the start: there is no slack zone at this angle."
    )
    return (
        f"{start} The working load is reached at {at('working')}; the cords break at"
        f" {at('cord_break')}."
    )


_TAKE_NONE = (
    ". Other values fit as well, and the intervals of the fitted values do not apply. Fit fewer"
)


def _make_comparison_section(view: ComparisonView) -> TestSection:
    """Return the section of one comparison; empty parts are left out."""
    parts = [
        make_part(
            "Measured and predicted tension", draw_comparison(view),
            [compared_curve_table(view), compared_event_table(view)], [f"Verdict: {view.verdict}."],
            warnings=[str(one) for one in _other_notes(view) if one.severity == "warning"],
        ),
        make_part("Comparison error", draw_error(view), (), [_shape(view)]),
        make_part(
            "Fill pressure", draw_compared_pressure(view), (),
            [f"Verdict: {view.text('fill_pressure_verdict')}."]
            if "fill_pressure_verdict" in view.data else [],
        ),
        make_part("Cycle by cycle", draw_cycle_bias(view)),
        make_part("Energy", (), [energy_table(view)]),
        make_part(
            "Calibration", (), [calibration_table(view), correlation_table(view)],
            _identified(view) if view.is_identified else [],
            warnings=[] if view.is_identified else _identified(view),
        ),
    ]  # fmt: skip
    return _section_of(
        view,
        title=f"Comparison {view.name}",
        subtitle=(
            f"test {view.test} ({view.loading}), specimen {view.specimen}, against hose {view.hose}"
        ),
        parts=[part for part in parts if part.figures or part.tables],
    )


def _comparison_findings(view: ComparisonView) -> list[SummaryFinding]:
    """Return what a reader must know about a comparison before its numbers."""
    of = (f"comparison {view.name}",)
    found = []
    if view.short_verdict == "differs":
        share = float(np.nan_to_num(view.judged_scalar("tension_relative_rms")))
        place = (len(CAUSES), -share)
        found.append(SummaryFinding("warning", of, f"The prediction {view.verdict}.", place))
    elif view.short_verdict != "agrees":
        found.append(SummaryFinding("note", of, f"{view.verdict[:1].upper()}{view.verdict[1:]}."))
    if view.is_identified is False:
        found += [SummaryFinding("warning", of, sentence) for sentence in _identified(view)]
    return found + [
        SummaryFinding(one.severity, of, str(one), urgency(one)) for one in _other_notes(view)
    ]


def _comparison_tiles(views: Sequence[ComparisonView]) -> list[Tile]:
    """Return the number of comparisons, and of those that differ."""
    if not views:
        return []
    noun = "comparison" if len(views) == 1 else "comparisons"
    found = [Tile(f"{len(views):,}", noun, views[0].key)]
    differing = [view for view in views if view.short_verdict == "differs"]
    if differing:
        words = "differs" if len(differing) == 1 else "differ"
        found.append(Tile(f"{len(differing):,}", words, differing[0].key, is_bad=True))
    return found


def _other_notes(view: ComparisonView) -> list[Note]:
    """Notes other than the one shown with the fitted parameters."""
    said = view.text("identifiability")
    return [one for one in view.notes if not (said and said in str(one))]


def _shape(view: ComparisonView) -> str:
    """Describe the result of chi square, which detects a wrong shape inside the band."""
    probability = view.scalar("chi_square_probability")
    if not np.isfinite(probability):
        return "No uncertainty is stated, so the shape of the difference cannot be judged."
    chance = "less than 0.01 %" if probability < 1e-4 else f"{100 * probability:.2g} %"
    return (
        f"Chi-square over all strains is {view.scalar('chi_square'):.4g} with"
        f" {view.scalar('chi_square_freedom'):.0f} degrees of freedom; the stated errors alone"
        f" exceed that in {chance} of cases. It detects a wrong shape within the band, and is"
        " given in addition to the verdict."
    )


def _identified(view: ComparisonView) -> list[str]:
    """Say whether the curve identifies the fitted parameters; empty without a calibration."""
    if view.is_identified is None:
        return []
    needed = 100 * view.scalar("needed_change")
    if view.is_identified:
        return [
            "The curve determines these numbers: in the direction to which it is least sensitive,"
            f" one plausible error changes it by {100 * view.scalar('least_change'):.2g} %;"
            f" {needed:.2g} % is needed."
        ]
    return [
        f"The curve does not determine the fitted numbers: {view.text('identifiability')};"
        f" at least {needed:.2g} % is needed to determine them{_TAKE_NONE}."
    ]


def _make_outcome_section(view: OutcomeView) -> TestSection:
    """Return the section; empty parts are left out."""
    parts = [
        make_part(
            "Strength", (),
            [strength_table(view, name) for name in ("tensile_strength", "strain_at_failure")],
        ),
        make_part("Strength against exposure", draw_exposure(view), [exposure_table(view)]),
        make_part(
            "Cycles to failure", draw_lives(view),
            [load_life_table(view), fatigue_table(view, "cycles_to_failure")],
        ),
        make_part(
            "Lines that go slack", (), [snap_table(view)], snap_sentences(view),
        ),
        make_part("Abrasion", (), [fatigue_table(view, "abrasion_cycles")]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.attributes)
    return TestSection(
        key="outcomes",
        title="Strength and life",
        subtitle=view.summary,
        parts=tuple(part for part in parts if part.figures or part.tables),
        notes=(),
        provenance=provenance,
        documents=documents,
    )


def _make_rope_section(view: RopeView) -> TestSection:
    """Return the section of one rope; empty parts are left out."""
    parts = [
        make_part(
            "Change in length", draw_stiffness(view), [property_table(view)],
            refusals=rope_notes(view, known=False),
        ),
        make_part("Bedding-in", (), [bedding_table(view)]),
        make_part("Dynamic stiffness", (), [level_table(view)]),
        make_part("Static stiffness", draw_held_pairs(view), [pair_table(view)]),
        make_part("Creep", draw_creep(view), [creep_table(view)]),
    ]  # fmt: skip
    provenance, documents = provenance_of(view.data.attrs)
    return TestSection(
        key=view.key,
        title=f"Programme of rope {view.specimen}",
        subtitle=f"steps in order: {', '.join(test.id for test in view.tests)}",
        parts=tuple(part for part in parts if part.figures or part.tables),
        notes=(),
        provenance=provenance,
        documents=documents,
        noun="rope",
    )


def _rope_tiles(views: Sequence[RopeView]) -> list[Tile]:
    """Return the number of ropes with a programme."""
    if not views:
        return []
    noun = "rope with a programme" if len(views) == 1 else "ropes with a programme"
    return [Tile(f"{len(views):,}", noun, views[0].key)]


_SHOWN = ("outcomes", "surfaces", "predictions", "comparisons", "change_in_length")

_STRAY = "The campaign no longer makes this archive; its contents are from an earlier run."

_Read = TypeVar("_Read")


ALL_COMPARISONS = "All comparisons in one figure"


@dataclass(frozen=True)
class CampaignView:
    """Views of the archives that belong to no single test, each with its section."""

    outcomes: tuple[tuple[OutcomeView, TestSection], ...]
    experiments: tuple[tuple[ExperimentView, TestSection], ...]
    hoses: tuple[tuple[HoseView, TestSection], ...]
    compared: tuple[tuple[ComparisonView, TestSection], ...]
    ropes: tuple[tuple[RopeView, TestSection], ...]
    stray: tuple[str, ...] = ()

    @property
    def views(self) -> list[OutcomeView | ExperimentView | HoseView | ComparisonView | RopeView]:
        """All views; the first represents the campaign where there is no test."""
        return [
            *(view for view, _ in self.experiments),
            *(view for view, _ in self.outcomes),
            *(view for view, _ in self.hoses),
            *(view for view, _ in self.compared),
            *(view for view, _ in self.ropes),
        ]

    @property
    def chapters(self) -> list[TestSection]:
        """Sections placed before those of the tests."""
        pairs = (*self.experiments, *self.ropes, *self.hoses, *self.compared)
        return [section for _, section in pairs]

    @property
    def is_synthetic(self) -> bool:
        """True where any of the views is synthetic."""
        return any(view.is_synthetic for view in self.views)

    @property
    def summary(self) -> str:
        """Summarise the content where there is no test."""
        if self.outcomes:
            return f"{self.outcomes[0][0].summary}."
        if self.hoses and not self.experiments:
            return self.hoses[0][0].attribute("summary")
        return ""

    @property
    def findings(self) -> list[SummaryFinding]:
        """Findings that a reader must know first."""
        found = [SummaryFinding("warning", (name,), _STRAY) for name in self.stray]
        found += [one for view, _ in self.experiments for one in experiment_findings(view)]
        found += [
            SummaryFinding(one.severity, ("outcomes",), str(one), urgency(one))
            for view, _ in self.outcomes
            for one in odd_outcomes(view.outcomes)
        ]
        found += [one for view, _ in self.compared for one in _comparison_findings(view)]
        return found + [one for view, _ in self.hoses for one in _hose_findings(view)]

    @property
    def answers(self) -> list[PageTable]:
        """Tables of answers on the first screen."""
        found = [
            answer_table(view, view.surfaces)
            for view, _ in self.experiments
            if view.surfaces is not None
        ]
        found.append(answer_of_ropes([view for view, _ in self.ropes]))
        found.append(answer_of_hoses([view for view, _ in self.hoses]))
        found.append(verdict_table([view for view, _ in self.compared]))
        return [table for table in found if table is not None]

    @property
    def comparisons(self) -> list[Part]:
        """Figures over several items of a kind."""
        hoses = draw_all_hoses([view for view, _ in self.hoses])
        compared = draw_all_comparisons([view for view, _ in self.compared])
        return [
            make_part("All predicted hoses in one figure", hoses),
            make_part(ALL_COMPARISONS, compared),
        ]

    def with_tiles(self, of_tests: list[Tile]) -> list[Tile]:
        """Numbers at the top, before and among those of the tests."""
        found = []
        for outcomes, _ in self.outcomes:
            size = len(outcomes.outcomes)
            noun = "outcome" if size == 1 else "outcomes"
            found.append(Tile(f"{size:,}", f"{noun} without a log", "outcomes"))
        if self.experiments:
            size = len(self.experiments)
            noun = "experiment" if size == 1 else "experiments"
            found.append(Tile(f"{size:,}", noun, self.experiments[0][0].key))
        found += _rope_tiles([view for view, _ in self.ropes])
        found += _hose_tiles([view for view, _ in self.hoses])
        return [*found, *_comparison_tiles([view for view, _ in self.compared]), *of_tests]


def is_there(processed: Path) -> bool:
    """Return whether a folder has an archive of a whole campaign that the page can show."""
    return any((processed / f"{name}.nc").is_file() for name in _SHOWN)


def read_campaign(
    processed: Path,
    tests: Mapping[str, TestView],
    units: UnitSystem,
    unreadable: dict[str, str],
    stray: Collection[str] = (),
    opener: Opener = reading,
) -> CampaignView:
    """Read the existing archives; unreadable files are listed in ``unreadable``."""

    def read(name: str, views: Callable[[xr.Dataset], list[_Read]]) -> tuple[_Read, ...]:
        path = processed / f"{name}.nc"
        if not path.is_file():
            return ()
        try:
            with opener(path) as data:
                return tuple(views(data))
        except ArchiveError as error:
            unreadable[path.name] = str(error).replace(str(path), path.name)
            return ()

    def outcomes(data: xr.Dataset) -> list[tuple[OutcomeView, TestSection]]:
        view = view_outcomes(data, units)
        return [(view, _make_outcome_section(view))]

    def experiments(data: xr.Dataset) -> list[tuple[ExperimentView, TestSection]]:
        views = ExperimentView.rows_of(data, units)
        return [(view, _make_experiment_section(view, tests)) for view in views]

    def hoses(data: xr.Dataset) -> list[tuple[HoseView, TestSection]]:
        return [(view, _make_hose_section(view)) for view in HoseView.rows_of(data, units)]

    def compared(data: xr.Dataset) -> list[tuple[ComparisonView, TestSection]]:
        return [
            (view, _make_comparison_section(view)) for view in ComparisonView.rows_of(data, units)
        ]

    def ropes(data: xr.Dataset) -> list[tuple[RopeView, TestSection]]:
        return [(view, _make_rope_section(view)) for view in view_ropes(data, tests, units)]

    return CampaignView(
        outcomes=read("outcomes", outcomes),
        experiments=read("surfaces", experiments),
        hoses=read("predictions", hoses),
        compared=read("comparisons", compared),
        ropes=read("change_in_length", ropes),
        stray=tuple(f"{name}.nc" for name in _SHOWN if f"{name}.nc" in stray),
    )

"""What the page shows of a whole campaign besides its tests: experiments, hoses and the like."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import xarray as xr

from reduction.archive.open import Opener, reading
from reduction.errors import ArchiveError
from reduction.report.comparisonsection import (
    comparison_findings,
    comparison_tiles,
    make_comparison_section,
)
from reduction.report.comparisonview import ComparisonView, view_comparisons
from reduction.report.experimentsection import make_experiment_section
from reduction.report.experimenttables import answer_table
from reduction.report.experimentview import ExperimentView
from reduction.report.experimentwords import experiment_findings
from reduction.report.figures.comparisons import draw_all_comparisons
from reduction.report.figures.hoses import draw_all_hoses
from reduction.report.hosesection import hose_findings, hose_tiles, make_hose_section
from reduction.report.hoseview import HoseView, view_hoses
from reduction.report.htmltable import Table
from reduction.report.outcomesection import make_outcome_section
from reduction.report.outcomeview import OutcomeView, view_outcomes
from reduction.report.predictiontables import answer_of_hoses, verdict_table
from reduction.report.ropesection import make_rope_section, rope_tiles
from reduction.report.ropetables import answer_of_ropes
from reduction.report.ropeview import RopeView, view_ropes
from reduction.report.section import Part, Section, make_part
from reduction.report.summary import Finding, Tile
from reduction.report.view import TestView
from reduction.units import UnitSystem

_SHOWN = ("outcomes", "surfaces", "predictions", "comparisons", "change_in_length")
_STRAY = (
    "Nothing in the campaign stands for this archive now: what is shown of it is of an earlier run."
)
_Read = TypeVar("_Read")


@dataclass(frozen=True)
class WholeCampaign:
    """Views of the archives that belong to no single test, each with its section."""

    outcomes: tuple[tuple[OutcomeView, Section], ...]
    experiments: tuple[tuple[ExperimentView, Section], ...]
    hoses: tuple[tuple[HoseView, Section], ...]
    compared: tuple[tuple[ComparisonView, Section], ...]
    ropes: tuple[tuple[RopeView, Section], ...]
    stray: tuple[str, ...] = ()

    @property
    def views(self) -> list[OutcomeView | ExperimentView | HoseView | ComparisonView | RopeView]:
        """All of them; the first speaks for the campaign where there is no test."""
        return [
            *(view for view, _ in self.experiments),
            *(view for view, _ in self.outcomes),
            *(view for view, _ in self.hoses),
            *(view for view, _ in self.compared),
            *(view for view, _ in self.ropes),
        ]

    @property
    def chapters(self) -> list[Section]:
        """Sections that stand before those of the tests."""
        pairs = (*self.experiments, *self.ropes, *self.hoses, *self.compared)
        return [section for _, section in pairs]

    @property
    def is_synthetic(self) -> bool:
        """True where any of them says so."""
        return any(view.is_synthetic for view in self.views)

    @property
    def summary(self) -> str:
        """Say what there is, where no test does."""
        if self.outcomes:
            return f"{self.outcomes[0][0].summary}."
        if self.hoses and not self.experiments:
            return self.hoses[0][0].attribute("summary")
        return ""

    @property
    def findings(self) -> list[Finding]:
        """What a reader must know first."""
        found = [Finding("warning", (name,), _STRAY) for name in self.stray]
        found += [one for view, _ in self.experiments for one in experiment_findings(view)]
        found += [one for view, _ in self.compared for one in comparison_findings(view)]
        return found + [one for view, _ in self.hoses for one in hose_findings(view)]

    @property
    def answers(self) -> list[Table]:
        """Tables that answer on the first screen."""
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
        """Figures over several of a kind."""
        hoses = draw_all_hoses([view for view, _ in self.hoses])
        compared = draw_all_comparisons([view for view, _ in self.compared])
        return [
            make_part("All predicted hoses in one figure", hoses),
            make_part("All comparisons in one figure", compared),
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
        found += rope_tiles([view for view, _ in self.ropes])
        found += hose_tiles([view for view, _ in self.hoses])
        return [*found, *comparison_tiles([view for view, _ in self.compared]), *of_tests]


def is_there(processed: Path) -> bool:
    """Return whether a folder holds an archive of a whole campaign that the page can show."""
    return any((processed / f"{name}.nc").is_file() for name in _SHOWN)


def read_whole(
    processed: Path,
    tests: Mapping[str, TestView],
    units: UnitSystem,
    unreadable: dict[str, str],
    stray: Collection[str] = (),
    opener: Opener = reading,
) -> WholeCampaign:
    """Read what there is; a file that cannot be read is told in ``unreadable``.

    Parameters
    ----------
    processed : pathlib.Path
        Folder of the archives.
    tests : mapping of str to TestView
        The tests of the campaign, by name.
    units : UnitSystem
        What a reader is shown.
    unreadable : dict of str to str
        File name to message; added to.
    stray : collection of str
        Names of archives that nothing in the campaign stands for now.
    opener : Opener
        How archives are opened.
    """

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

    def outcomes(data: xr.Dataset) -> list[tuple[OutcomeView, Section]]:
        view = view_outcomes(data, units)
        return [(view, make_outcome_section(view))]

    def experiments(data: xr.Dataset) -> list[tuple[ExperimentView, Section]]:
        loaded = data.load()
        views = [
            ExperimentView(f"experiment-{index}", loaded, index, units)
            for index in range(loaded.sizes["experiment"])
        ]
        return [(view, make_experiment_section(view, tests)) for view in views]

    def hoses(data: xr.Dataset) -> list[tuple[HoseView, Section]]:
        return [(view, make_hose_section(view)) for view in view_hoses(data, units)]

    def compared(data: xr.Dataset) -> list[tuple[ComparisonView, Section]]:
        return [(view, make_comparison_section(view)) for view in view_comparisons(data, units)]

    def ropes(data: xr.Dataset) -> list[tuple[RopeView, Section]]:
        return [(view, make_rope_section(view)) for view in view_ropes(data, tests, units)]

    return WholeCampaign(
        outcomes=read("outcomes", outcomes),
        experiments=read("surfaces", experiments),
        hoses=read("predictions", hoses),
        compared=read("comparisons", compared),
        ropes=read("change_in_length", ropes),
        stray=tuple(f"{name}.nc" for name in _SHOWN if f"{name}.nc" in stray),
    )

"""The command surface: response surfaces, or effects of a screening, of a table of runs."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import numpy as np

from reduction.campaign.runtable import RunSeries, read_runs
from reduction.campaign.spec import ExperimentSpec, load_spec
from reduction.cli.commandoutput import CommandOutput
from reduction.cli.surfaceanswers import effects_document, frame, surface_document
from reduction.cli.surfacetables import show_effects, show_surfaces
from reduction.errors import DataError, FitError
from reduction.surface.designs import Design
from reduction.surface.doubts import drifting_responses, negative_surfaces
from reduction.surface.drift import drift_over_order
from reduction.surface.product import ResponseSurfaces
from reduction.surface.screening import ScreeningEffects, screening_effects, screening_remarks
from reduction.surface.surfaces import fit_surfaces
from reduction.units import UnitSystem

_NEAR_A_LEVEL = 0.1
"""Coded distance from -1 or 1 at which a level of a screening is still that level."""


def fit_runs(path: Path, spec_path: Path | None, *, output: CommandOutput) -> None:
    """Fit what SPEC.toml asks for to a table of runs, and print it."""
    spec = None if spec_path is None else load_spec(spec_path)
    runs = read_runs(path, spec)
    units = cast("UnitSystem", output.units)
    try:
        if spec is not None and spec.kind == "plackett-burman":
            effects, notes = _screen(runs)
            show_effects(effects, runs, notes, output, units)
            output.answer(frame(runs, notes) | effects_document(effects, runs))
            return
        surfaces = _fit(runs, spec)
        drift = drift_over_order(surfaces, runs.run_order)
    except (DataError, FitError) as error:
        raise type(error)(
            f"{path}: {error.problem}", found=error.found, needed=error.needed, hint=error.hint
        ) from error
    notes = (
        *runs.notes,
        *surfaces.notes,
        *_unstated(runs),
        *negative_surfaces(surfaces),
        *drifting_responses(surfaces, drift),
    )
    show_surfaces(surfaces, runs, notes, output, units)
    documents = {
        name: surface_document(surfaces, index, runs, drift)
        for index, name in enumerate(surfaces.response_names)
    }
    output.answer(frame(runs, notes) | {"fit": "quadratic", "responses": documents})


def _fit(runs: RunSeries, spec: ExperimentSpec | None) -> ResponseSurfaces:
    levels = [np.unique(column[np.isfinite(column)].round(6)).size for column in runs.coded.T]
    if set(levels) == {2}:
        raise FitError(
            "two levels a factor carry no square",
            needed="three levels, or a screening",
            hint='kind = "plackett-burman" under [experiment] of a SPEC.toml gives the effects.',
        )
    declared = () if spec is None else spec.responses
    return fit_surfaces(
        runs.coded,
        runs.responses,
        factor_names=runs.factor_names,
        response_names=runs.response_names,
        low=runs.low,
        high=runs.high,
        units="coded",
        run_names=runs.run_names,
        blocks=runs.blocks,
        block_treatment="random" if spec and spec.specimens_as == "random" else "fixed",
        transforms=[entry.transform for entry in declared] or "none",
    )


def _screen(runs: RunSeries) -> tuple[ScreeningEffects, tuple[str, ...]]:
    notes = [*runs.notes, *_unstated(runs)]
    near = np.where(runs.coded < 0, -1.0, 1.0)
    away = np.abs(runs.coded - near)
    if not (away <= _NEAR_A_LEVEL).all():
        run, factor = np.argwhere(~(away <= _NEAR_A_LEVEL))[0].tolist()
        raise DataError(
            f"row {runs.row[run]}: a level of {runs.factor_names[factor]} is neither low nor high",
            found=f"{runs.coded[run, factor]:.4g} coded",
            needed="-1 or 1, as a screening of two levels has them",
        )
    if away.any():
        notes.append(f"levels up to {away.max():.2g} coded off the plan count as those of the plan")
    notes += screening_remarks(runs.dummy.shape[1], runs.blocks is not None)
    design = Design("plackett-burman", near, runs.dummy)
    return screening_effects(design, runs.responses, names=runs.factor_names), tuple(notes)


def _unstated(runs: RunSeries) -> list[str]:
    bare = [
        name
        for name, unit in zip(runs.response_names, runs.response_units, strict=True)
        if not unit
    ]
    return [f"without a unit, numbers as in the table: {', '.join(bare)}"] if bare else []

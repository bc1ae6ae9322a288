"""Archives and processed campaigns as sources of design values.

A reduced test gives curves, moduli and tensions over strain and slow pulls; an experiment gives
surfaces.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.open import Opener, ReadOnce, reading
from reduction.archive.product_files import archives_of_tests, earlier_run_words
from reduction.archive.shared_errors import components_of, shared_contributions
from reduction.archive.surfaces_dataset import is_share_of_mean, surface_names, surfaces_of
from reduction.archive.uncertainty_budget import break_in_cycles, random_freedom
from reduction.archive.variables import settings_of, stored
from reduction.experiments.fit_results import FIT_REASONS, ResponseSurfaces
from reduction.experiments.surface_discrepancy import discrepancy_of
from reduction.experiments.surface_points import greatest_leverage
from reduction.lines.archive_pieces import alignment_words, check_words
from reduction.lines.bent_loops import (
    RunOfLine,
    constant_of_level,
    with_bend_of_levels,
    with_bend_of_runs,
)
from reduction.lines.line_lookup import Branch
from reduction.lines.line_search import joined_conditions
from reduction.lines.lookup_product import OF_MEAN, LineCurve, LineLevels, LineSource, LineSurface
from reduction.quantities.digits import plain_number
from reduction.quantities.names import RESPONSES, SCALES, quantity
from reduction.record.contributions import Component, Contributions, stacked
from reduction.record.errors import ArchiveError, DataError
from reduction.record.measurement import Bools, Floats
from reduction.stages.moduli.secant_modulus import late_change
from reduction.stages.three_parameter_line.loop_midline import tension_above_midline

_OVER_STRAIN = ("tangent_modulus", "branch_tension")

_K_0 = "quasi_static_spring_constant"

_OVER_TENSION = {
    _K_0: (_K_0, "mean_tension"),
    "quasi_static_strain": ("strain", "tension"),
}

CYCLE = ("frequency", "mean_tension", "tension_amplitude")
"""Levels of a cyclic test in load."""

_AT_LEVELS = (
    "apparent_spring_constant", "hysteresis_energy", "loss_factor", "storage_spring_constant",
    "loss_spring_constant",
)  # fmt: skip

_ROPES = ("rope", "wire")

_CONDITIONS = ("medium", "soak", "temperature", "date", "rest")

_Parts = dict[str, Any]  # fields of `LineCurve` that give its uncertainty

CURVES = (*_OVER_STRAIN, *_OVER_TENSION)
"""Variables of a reduced test that are looked up as curves."""


def _curves_of_specimen(dataset: xr.Dataset, place: int) -> tuple[LineCurve, ...]:
    """Curves of one specimen of a reduced test."""
    return (
        *(
            curve
            for name in _OVER_STRAIN
            if name in dataset
            for curve in _branches(dataset, name, place)
        ),
        *_of_pull(dataset, place),
    )


def _branches(dataset: xr.Dataset, name: str, place: int) -> list[LineCurve]:
    strain = dataset.variables["strain_bin"].values
    curves = []
    branches: tuple[Branch, Branch] = ("ascending", "descending")
    for index, branch in enumerate(branches):
        value = dataset.variables[name].values[place, index]
        seen = np.isfinite(value)
        if seen.sum() < 2:
            continue
        at = strain[seen]
        # bins without a cycle between two that have one stay unknown
        missing = np.flatnonzero(np.diff(np.flatnonzero(seen)) > 1)
        curves.append(
            LineCurve(
                quantity=name,
                variable="strain",
                low=float(at[0]),
                high=float(at[-1]),
                at=np.array(at),
                value=np.array(value[seen]),
                **_uncertainty(dataset, name, (place, index), seen),
                spread_of="the mean over the cycles of this one test",
                gaps=np.stack([at[missing], at[missing + 1]], axis=1),
                branch=branch,
                notes=(
                    *(
                        [f"gaps between bins, where nothing was measured: {missing.size}"]
                        if missing.size
                        else []
                    ),
                    *alignment_words(dataset, place),
                ),
                warnings=_checks(dataset, place),
            )
        )
    return curves


def _checks(dataset: xr.Dataset, place: int) -> tuple[str, ...]:
    return check_words(dataset, str(dataset.variables["specimen"].values[place]))


def _uncertainty(dataset: xr.Dataset, name: str, place: tuple[int, ...], seen: Bools) -> _Parts:
    """Uncertainty of a curve where it was measured, by its parts; empty without an uncertainty."""
    if f"{name}_standard_uncertainty" not in dataset:
        return {}
    spread = np.asarray(
        dataset.variables[f"{name}_standard_uncertainty"].values[place], dtype=np.float64
    )
    freedom = np.broadcast_to(random_freedom(dataset, name), dataset.variables[name].shape)[place]
    found: _Parts = {
        "standard_uncertainty": spread[seen],
        "degrees_of_freedom": np.array(freedom[seen]),
    }
    own_rows = stored(dataset, f"{name}_uncertainty_contribution")
    if own_rows is None:
        return found
    rows = np.nan_to_num(np.moveaxis(own_rows.values, 0, -1)[place].T)[:, seen]
    touched = np.flatnonzero(rows.any(axis=1))
    component = components_of(dataset)
    return found | {
        "component": tuple(component[row] for row in touched),
        "contribution": rows[touched],
    }


def _of_pull(dataset: xr.Dataset, place: int) -> list[LineCurve]:
    """K_0 and strain of a slow pull at its tensions, over its range of use."""
    if "pull_strain_coefficient" not in dataset:
        return []
    if not np.isfinite(dataset.variables["pull_strain_coefficient"].values[place]).all():
        return []
    everywhere = np.ones(dataset.sizes["tension_grid"], dtype=bool)
    return [
        LineCurve(
            quantity=name,
            variable=variable,
            low=float(dataset.variables["pull_tension_low"].values[place]),
            high=float(dataset.variables["pull_tension_high"].values[place]),
            value=np.array(dataset.variables[stored].values[place]),
            at=np.array(dataset.variables["tension_grid"].values),
            **_uncertainty(dataset, stored, (place,), everywhere),
            spread_of="the curve of this one pull",
            warnings=_checks(dataset, place),
        )
        for stored, (name, variable) in _OVER_TENSION.items()
    ]


_SCALES = (*SCALES, "")
"""A surface on the requested scale is preferred to that of the quantity itself."""

_TEXTS = {
    "kind": "specimen_kind",
    "material": "specimen_material",
    "construction": "specimen_construction",
    "condition": "specimen_condition",
}

_NUMBERS = ("diameter", "linear_density", "wet_linear_density")

Facts = Mapping[str, str | float]
"""Fields of `LineSource` that a specimen states, by name."""


def _line_source_of_experiment(
    dataset: xr.Dataset, experiment: str, *, specimens: Mapping[str, Facts] | None = None
) -> LineSource:
    """Surfaces of an experiment as a source of design values."""
    names = surface_names(dataset, experiment)
    if not names:
        raise DataError(f"experiment '{experiment}' has no surface", needed="a Box-Behnken one")
    row = dataset.variables["experiment"].values.astype(str).tolist().index(experiment)
    fitted = surfaces_of(dataset, experiment)
    factors = tuple(
        OF_MEAN if _is_of_mean(dataset, row, place, name) else name
        for place, name in enumerate(fitted.factor_names)
    )
    units = dataset.variables["factor_unit"].values[row].astype(str)[: len(factors)]
    strength = _one_strength(dataset, row)
    scale = np.array(
        [
            _scale(name, unit, strength, experiment)
            for name, unit in zip(factors, units, strict=True)
        ]
    )
    runs = _runs_of(dataset, experiment)
    tested = tuple(sorted({specimen for _, specimen in runs}))
    surfaces = {}
    for response in RESPONSES:
        name = looked_up_surface(response, names)
        if name:
            shared = _shared(dataset, row, name, len(fitted.exponents))
            plan = dataset["run_plan"].values[row, :, : len(factors)]
            surfaces[response] = _surface(
                fitted, names.index(name), response, name, scale, shared, plan
            )
    return LineSource(
        name=experiment,
        source=f"{dataset.attrs.get('id', 'surfaces')}, experiment {experiment}",
        rated_break_strength=strength,
        factor_names=factors,
        surfaces=surfaces,
        runs=runs,
        specimens=tested,
        notes=_synthetic(dataset),
        campaign=str(dataset.attrs.get("campaign", "")),
        **_agreed([(specimens or {}).get(one, {}) for one in tested]),
    )


def looked_up_surface(response: str, names: Sequence[str]) -> str:
    """Name of the fitted surface from which the look-up takes a response; empty if none.

    Examples
    --------
    >>> looked_up_surface("hysteresis_energy", ["hysteresis_energy", "log_hysteresis_energy"])
    'log_hysteresis_energy'
    """
    return next((f"{one}{response}" for one in _SCALES if f"{one}{response}" in names), "")


def _facts_of_specimens(dataset: xr.Dataset) -> dict[str, Facts]:
    """Properties of each specimen that the archive of a reduced test states, by name."""
    if "specimen" not in dataset:
        return {}
    names = dataset.variables["specimen"].values.astype(str).tolist()
    return {name: _facts(dataset, place) for place, name in enumerate(names)}


def _facts(dataset: xr.Dataset, place: int) -> dict[str, Any]:
    return {
        name: str(dataset[stored].values[place]) if stored in dataset else ""
        for name, stored in _TEXTS.items()
    } | {
        name: float(dataset.variables[name].values[place]) if name in dataset else float("nan")
        for name in _NUMBERS
    }


def _agreed(facts: Sequence[Facts]) -> dict[str, Any]:
    """Properties that all specimens have in common; those that differ are left out."""
    agreed: dict[str, Any] = dict.fromkeys(_TEXTS, "") | dict.fromkeys(_NUMBERS, float("nan"))
    for name, nothing in agreed.items():
        found = {one.get(name, nothing) for one in facts}
        if len(found) == 1:
            agreed[name] = found.pop()
    return agreed


def _shared(
    dataset: xr.Dataset, row: int, name: str, n_terms: int
) -> tuple[tuple[Component, ...], Floats]:
    """Errors that the runs share, and the contribution of each to the coefficients of a surface.

    NaN where the contribution is not stored for every run.
    """
    rows = stored(dataset, f"{name}_coefficient_uncertainty_contribution")
    if rows is None:
        return (), np.empty((0, n_terms))
    own = rows.values[row, :, :n_terms]
    component = components_of(dataset, row)
    # an experiment with fewer errors than another in the archive is padded
    is_one = np.array([bool(one.source) for one in component], dtype=bool)
    known = np.flatnonzero(is_one & own.any(axis=1))
    return tuple(component[place] for place in known), own[known]


def _surface(
    fitted: ResponseSurfaces,
    index: int,
    response: str,
    name: str,
    scale: Floats,
    shared: tuple[tuple[Component, ...], Floats],
    plan: Floats,
) -> LineSurface:
    covariance = fitted.covariance_factor[fitted.pattern[index]]
    n_terms = len(fitted.exponents)
    notes = [] if name == response else [f"transformed back from the surface of {name}"]
    component, rows = shared
    sigma = float(fitted.sigma[index])
    missed = discrepancy_of(fitted)
    if np.isfinite(fitted.coefficient[index]).all() and np.isnan(rows).any():
        component, rows, sigma = (), rows[:0], float("nan")
        notes.append(
            "no interval is given: some runs do not store the errors that they share with the"
            " others"
        )
    elif not rows.size:
        notes.append(
            "the intervals contain the scatter of the runs alone: errors common to all runs, such"
            " as the load cell, are not stated"
        )
    if not np.isfinite(fitted.coefficient[index]).all():
        notes.append(f"no surface: {FIT_REASONS[int(fitted.reason[index])]}")
    return LineSurface(
        quantity=response,
        coefficient=np.array(fitted.coefficient[index]),
        exponents=np.array(fitted.exponents),
        low=scale * fitted.low,
        high=scale * fitted.high,
        covariance_factor=np.array(covariance[:n_terms, :n_terms]),
        sigma=sigma,
        degrees_of_freedom=float(fitted.degrees_of_freedom[index]),
        greatest_leverage=float(greatest_leverage(fitted, plan)[index]),
        exponent=float(fitted.transform_exponent[index]),
        frequency_column=fitted.factor_names.index("frequency")
        if fitted.transform[index] == "log-times-frequency"
        else None,
        discrepancy=np.array(missed.moment[index]),
        discrepancy_exponents=np.array(missed.exponents),
        discrepancy_degrees_of_freedom=float(missed.degrees_of_freedom[index]),
        component=component,
        contribution=rows,
        notes=tuple(notes),
    )


def _one_strength(dataset: xr.Dataset, row: int) -> float:
    """Break strength of the runs; NaN where unknown or different."""
    if "run_rated_break_strength" not in dataset:
        return float("nan")
    found = dataset.variables["run_rated_break_strength"].values[row]
    known = np.unique(found[np.isfinite(found)])
    return float(known[0]) if known.size == 1 else float("nan")


def _is_of_mean(dataset: xr.Dataset, row: int, place: int, name: str) -> bool:
    """Whether the levels of a factor are shares of the mean tension, by those of the runs."""
    needed = ("run_level", "run_mean_tension", "run_tension_amplitude")
    if name != "tension_amplitude" or any(one not in dataset for one in needed):
        return False
    mean, amplitude = (dataset[one].values[row] for one in needed[1:])
    return is_share_of_mean(dataset["run_level"].values[row, :, place], mean, amplitude)


def _scale(name: str, unit: str, strength: float, experiment: str) -> float:
    """Factor from the unit of the levels to SI: a share of a break strength becomes a tension."""
    try:
        own = quantity(name).unit
    except KeyError:
        return 1.0
    if unit == own:
        return 1.0
    if own == "N" and unit == "1" and np.isfinite(strength):
        return strength
    raise ArchiveError(
        f"levels of {name} of experiment '{experiment}' are no {own}",
        found=f"unit {unit}", needed="one rated_break_strength of all its specimens",
    )  # fmt: skip


def _line_source_of_test(dataset: xr.Dataset, specimen: str) -> LineSource:
    """Curves of one specimen of a reduced test as a source of design values."""
    known = (
        []
        if "specimen" not in dataset
        else dataset.variables["specimen"].values.astype(str).tolist()
    )
    if specimen not in known:
        raise ArchiveError(
            "the archive has no such specimen", found=specimen, needed=", ".join(known) or "none"
        )
    place = known.index(specimen)
    return _line_of_curves(dataset, place, specimen, _curves_of_specimen(dataset, place))


def _levels_of_specimen(dataset: xr.Dataset, place: int) -> tuple[LineLevels, ...]:
    """Quantities of a cyclic test at its own level; none for bedding in."""
    names = [f"test_{one}" for one in CYCLE]
    is_level = (
        dataset.attrs.get("test_kind") == "cyclic" and "bedding_first_stiffness" not in dataset
    )
    if not (is_level and all(one in dataset for one in names)):
        return ()
    at = np.array([[float(dataset.variables[one].values[place]) for one in names]])
    if not np.isfinite(at).all():
        return ()
    return tuple(
        _one_level(dataset, place, name, at)
        for name in _AT_LEVELS
        if np.isfinite(dataset.variables[f"test_{name}"].values[place])
    )


def _one_level(dataset: xr.Dataset, place: int, name: str, at: Floats) -> LineLevels:
    stored_as = f"test_{name}"
    known = shared_contributions(dataset, stored_as, place)
    random = f"{stored_as}_random_standard_uncertainty"
    random = random if random in dataset else f"{stored_as}_standard_uncertainty"
    freedom = np.broadcast_to(
        random_freedom(dataset, stored_as), dataset.variables[stored_as].shape
    )
    return LineLevels(
        quantity=name,
        variables=CYCLE,
        at=at,
        value=np.array([float(dataset.variables[stored_as].values[place])]),
        random_standard_uncertainty=np.array([float(dataset.variables[random].values[place])]),
        degrees_of_freedom=np.array([float(freedom[place])]),
        tests=(str(dataset.attrs.get("test", "")),),
        component=tuple(known),
        contribution=np.array(list(known.values()), dtype=np.float64).reshape(len(known), 1),
        conditions=(_conditions(dataset),),
        warnings=(_checks(dataset, place),),
        late_change=np.array([_late_change(dataset, place, name)]),
    )


def _late_change(dataset: xr.Dataset, place: int, name: str) -> float:
    """`late_change` over the mean; NaN where the cycles are not stored."""
    of_cycles, mean = stored(dataset, name), float(dataset.variables[f"test_{name}"].values[place])
    if of_cycles is None or of_cycles.ndim != 2 or not mean:
        return np.nan
    return late_change(of_cycles.values[place, break_in_cycles(dataset) :]) / mean


def _conditions(dataset: xr.Dataset) -> dict[str, str]:
    """Conditions of a test, as far as the campaign states them."""
    return {one: str(dataset.attrs[one]) for one in _CONDITIONS if dataset.attrs.get(one)}


def _joined(parts: Sequence[LineLevels]) -> LineLevels:
    """Levels of one quantity from several tests."""
    shared = stacked(
        [Contributions(one.component, {"value": np.array(one.contribution)}) for one in parts]
    )

    def rows(name: str) -> Floats:
        return np.concatenate([getattr(one, name) for one in parts])

    return replace(
        parts[0],
        at=rows("at"),
        value=rows("value"),
        random_standard_uncertainty=rows("random_standard_uncertainty"),
        degrees_of_freedom=rows("degrees_of_freedom"),
        tests=tuple(test for one in parts for test in one.tests),
        component=shared.component,
        contribution=shared.values["value"].reshape(len(shared.component), rows("value").size),
        conditions=tuple(own for one in parts for own in one.conditions),
        warnings=tuple(own for one in parts for own in one.warnings),
        late_change=rows("late_change"),
        notes=tuple(dict.fromkeys(text for one in parts for text in one.notes)),
    )


def _line_of_curves(
    dataset: xr.Dataset, place: int, specimen: str, curves: tuple[LineCurve, ...]
) -> LineSource:
    strength = "rated_break_strength"
    return LineSource(
        name=specimen,
        source=f"{dataset.attrs.get('id', '')}, specimen {specimen}",
        rated_break_strength=float(dataset[strength].values[place])
        if strength in dataset
        else float("nan"),
        curves=curves,
        levels=_levels_of_specimen(dataset, place),
        conditions=_conditions(dataset),
        specimens=(specimen,),
        notes=_synthetic(dataset),
        campaign=str(dataset.attrs.get("campaign", "")),
        **_facts(dataset, place),
    )


def _synthetic(dataset: xr.Dataset) -> tuple[str, ...]:
    return ("synthetic data",) if dataset.attrs.get("synthetic") == "yes" else ()


CHANGE_IN_LENGTH = "change_in_length.nc"
"""File of the change-in-length properties of a campaign."""

SURFACES = "surfaces.nc"
"""File of the surfaces of a campaign, beside the archives of its tests."""


def archives_of_lines(folder: Path) -> list[Path]:
    """Archives in a campaign's folder that may contain design values, surfaces last."""
    surfaces = folder / SURFACES
    return [*archives_of_tests(folder), *([surfaces] if surfaces.is_file() else [])]


def lines_of_archive(path: Path) -> list[LineSource]:
    """Every line of one archive that has design values.

    Surfaces are given with the conditions and checks of the tests in the same folder.
    """
    opener = ReadOnce()
    lines = _lines_at(path, opener)
    if not any(line.surfaces for line in lines):
        return lines
    tests = [line for one in archives_of_tests(path.parent) for line in _lines_at(one, opener)]
    return [with_runs(line, tests) if line.surfaces else line for line in lines]


def _lines_at(path: Path, opener: Opener) -> list[LineSource]:
    with opener(path) as archive:
        lines = lines_of_open_archive(archive, path, opener)
    told = earlier_run_words(path)
    return [_with_warnings(one, told) for one in lines] if told else lines


def _with_warnings(line: LineSource, told: tuple[str, ...]) -> LineSource:
    """A line that also warns of its archive, at each test for when it is pooled with others."""
    return replace(
        line,
        warnings=(*told, *line.warnings) if line.surfaces else line.warnings,
        curves=tuple(replace(one, warnings=(*told, *one.warnings)) for one in line.curves),
        levels=tuple(
            replace(one, warnings=tuple((*told, *own) for own in one.warnings))
            for one in line.levels
        ),
    )


def lines_of_open_archive(
    archive: xr.Dataset, path: Path, opener: Opener = reading
) -> list[LineSource]:
    """Every line of one open archive, as `lines_of_archive`."""
    if "experiment" in archive.sizes:
        names = archive.variables["experiment"].values.astype(str).tolist()
        kinds = archive.variables["experiment_kind"].values.astype(str).tolist()
        wanted = {specimen for name in names for _, specimen in _runs_of(archive, name)}
        known = _specimens(path, wanted, opener)
        made = [
            _line_source_of_experiment(archive, name, specimens=known)
            for name, kind in zip(names, kinds, strict=True)
            if kind == "box-behnken" and surface_names(archive, name)
        ]
        settings = settings_of(archive)
        return [
            _with_slow_pulls(one, path, settings.get(one.name, {}), opener)
            if set(one.factor_names) == _OF_A_CYCLE
            else one
            for one in made
        ]
    # a rope without a diameter has levels but no curve
    if not any(name in archive for name in (*CURVES, *(f"test_{one}" for one in _AT_LEVELS))):
        return []
    names = archive.variables["specimen"].values.astype(str).tolist()
    found = [
        _line_of_curves(archive, place, name, _curves_of_specimen(archive, place))
        for place, name in enumerate(names)
    ]
    # where the curves of a specimen were refused, the notes of its test say why: it is no line
    return [line for line in found if line.curves or line.levels]


_OF_A_CYCLE = {"frequency", "mean_tension", "tension_amplitude"}


def _with_slow_pulls(
    line: LineSource, path: Path, settings: Mapping[str, Any], opener: Opener
) -> LineSource:
    """Surfaces over the cycles of a rope, with K_0 and how its K_1 and tau were read."""
    pulls = _slow_pulls(path, settings, opener, line.runs)
    return replace(
        line,
        slow_pulls=pulls,
        by_fundamental=bool(pulls) and _are_other_waves(path.parent, line.runs, opener),
    )


def _are_other_waves(folder: Path, runs: Sequence[tuple[str, str]], opener: Opener) -> bool:
    """Whether a run of an experiment was reduced as a non-sinusoidal wave."""
    tests = {test for test, _ in runs}
    for path in archives_of_tests(folder):
        if path.stem in tests:
            # an unreadable archive is reported elsewhere
            with suppress(ArchiveError), opener(path) as archive:
                if _cycle_settings(archive).get("waveform", "sinusoidal") != "sinusoidal":
                    return True
    return False


def _slow_pulls(
    path: Path, settings: Mapping[str, Any], opener: Opener, runs: Sequence[tuple[str, str]]
) -> dict[str, LineCurve]:
    """K_0 by the slow pull of each specimen of an experiment, where its archive exists."""
    pulls = settings.get("quasi_static", {})
    found = {}
    for specimen, test in pulls.items():
        try:
            pulled = _pull_of(path.parent, test, specimen, opener)
        except ArchiveError:
            continue
        label = f"slow pull {test}" + (f" of {specimen}" if len(pulls) > 1 else "")
        curves = _with_bend(path.parent, specimen, pulled.curves, opener, runs)
        found[label] = next(one for one in curves if one.quantity == _K_0)
    return found


def _runs_of(dataset: xr.Dataset, experiment: str) -> tuple[tuple[str, str], ...]:
    """Test and specimen of each run of an experiment."""
    row = dataset.variables["experiment"].values.astype(str).tolist().index(experiment)
    tests, specimens = (
        dataset.variables[name].values[row].astype(str).tolist()
        for name in ("run_name", "run_specimen")
    )
    # an experiment with fewer runs than another ends with empty names
    return tuple(one for one in zip(tests, specimens, strict=True) if one[1])


def _with_bend(
    folder: Path,
    specimen: str,
    curves: tuple[LineCurve, ...],
    opener: Opener,
    runs: Sequence[tuple[str, str]],
) -> tuple[LineCurve, ...]:
    """Curves of a slow pull, K_0 with the bend of the loops of its runs."""
    tests = {test for test, own in runs if own == specimen}
    found = []
    for path in archives_of_tests(folder):
        if path.stem not in tests:
            continue
        # an unreadable archive is reported elsewhere
        with suppress(ArchiveError), opener(path) as archive:
            names = [f"test_{one}" for one in RunOfLine._fields]
            if all(one in archive for one in names):
                place = archive.variables["specimen"].values.astype(str).tolist().index(specimen)
                found.append(
                    RunOfLine(*(float(archive.variables[one].values[place]) for one in names))
                )
    return tuple(with_bend_of_runs(one, found) if one.quantity == _K_0 else one for one in curves)


def lines_of_folder(folder: Path) -> list[LineSource]:
    """Every line of a processed campaign that has design values.

    A rope that is in several tests, but in no experiment with surfaces, is one more line: K_ap,
    H and loss factor at the level of each test, original and static stiffness, and K_0 and strain
    of its slow pull.  It has the name of the specimen, and its tests are called TEST SPECIMEN.  The
    same holds for a rope whose only test has holds, if these have a static stiffness.
    """
    opener = ReadOnce()  # surfaces also take K_0 of their runs and pulls
    found = [(path.stem, _lines_at(path, opener)) for path in archives_of_lines(folder)]
    named = _with_unique_names(found)
    fitted = {one for line in named if line.surfaces for one in line.specimens}
    tests: dict[str, list[LineSource]] = {}
    for line in named:
        if not line.surfaces and not fitted & set(line.specimens):
            tests.setdefault(line.specimens[0], []).append(line)
    ropes = [
        _rope(folder, name, own)
        for name, own in tests.items()
        if own[0].kind in _ROPES
        and ((len(own) > 1 and any(line.levels for line in own)) or _changes(folder, name))
    ]
    pooled = {line.name for line in ropes}
    lines = []
    for line in named:
        if line.surfaces:
            lines.append(with_runs(line, named))
        else:
            is_pooled = line.specimens[0] in pooled
            lines.append(_without_pooled(line, ropes) if is_pooled else line)
    return [*ropes, *(line for line in lines if line.surfaces or line.curves or line.levels)]


def with_runs(line: LineSource, tests: Sequence[LineSource]) -> LineSource:
    """Surfaces with the conditions of their runs, and why runs have the status `check`."""
    runs = [
        one
        for one in tests
        if one.levels and (one.levels[0].tests[0], one.specimens[0]) in line.runs
    ]
    return replace(
        line,
        conditions=joined_conditions(one.conditions for one in runs),
        warnings=(*line.warnings, *_checks_of_runs(runs)),
    )


def _checks_of_runs(runs: Sequence[LineSource]) -> tuple[str, ...]:
    """Number of runs of an experiment with the status `check`, and the reason of the first."""
    doubted = [texts for line in runs if (texts := line.levels[0].warnings[0])]
    if not doubted:
        return ()
    check = " has the status check"
    what = "the status check" if all(check in texts[0] for texts in doubted) else "a warning"
    first = doubted[0][0].replace(check, "", 1)
    has = "has" if len(doubted) == 1 else "have"
    return (f"{len(doubted)} of {len(runs)} runs {has} {what}; {first}",)


def ropes_with_pulls(folder: Path) -> list[LineSource]:
    """Ropes of a processed campaign that have levels and a slow pull."""
    lines = [line for line in lines_of_folder(folder) if line.levels and line.kind in _ROPES]
    found = [line for line in lines if line.curves and not line.surfaces]
    if not found:
        why = (text for line in lines for text in line.absent.values())
        raise DataError(
            "no rope of the campaign has both load levels and one slow pull (for K_0)",
            found=", ".join(line.name for line in lines) or "no rope with levels",
            needed="cyclic tests in load and a quasi-static test of the same specimen",
            hint=next(why, ""),
        )
    return [_with_bend_of_levels(folder, one) for one in found]


def _with_bend_of_levels(folder: Path, line: LineSource) -> LineSource:
    """A rope with the parameters of a three-parameter line from the loops of its levels.

    K_0 of its slow pull has the bend of these loops; K_ap and H of a non-sinusoidal wave are those
    of its fundamental, as are K_1 and tau of a run.
    """
    curve = next((one for one in line.curves if one.quantity == _K_0), None)
    tests = {test for one in line.levels if one.variables == CYCLE for test in one.tests}
    if curve is None:
        return line
    cycles = []
    of_sine: dict[str, dict[str, float]] = {}
    for path in archives_of_tests(folder):
        with reading(path) as archive:
            test = str(archive.attrs.get("test", ""))
            if test in tests:
                names = archive.variables["specimen"].values.astype(str).tolist()
                place = names.index(line.specimens[0])
                cycles.append(_cycle_of_level(archive, place, curve))
                of_sine[test] = _sine_over_wave(archive, place)
    bent = with_bend_of_levels(curve, cycles)
    return replace(
        line,
        curves=tuple(bent if one is curve else one for one in line.curves),
        levels=tuple(_as_sine(one, of_sine) for one in line.levels),
    )


_WAVE = ("apparent_spring_constant", "hysteresis_energy")


def _as_sine(levels: LineLevels, of_sine: Mapping[str, Mapping[str, float]]) -> LineLevels:
    """K_ap and H of tests by their fundamentals, with the same relative uncertainties."""
    if levels.quantity not in _WAVE:
        return levels
    share = np.array([of_sine.get(test, {}).get(levels.quantity, 1.0) for test in levels.tests])
    if np.all(share == 1):
        return levels
    said = (
        "a wave that is no sine: K_ap and H are those of its fundamental, which a three-parameter"
        " line has in a sine; the look-up has those of the wave"
    )
    return replace(
        levels,
        value=share * levels.value,
        random_standard_uncertainty=share * levels.random_standard_uncertainty,
        contribution=share * levels.contribution if levels.component else levels.contribution,
        notes=(*levels.notes, said),
    )


def _sine_over_wave(archive: xr.Dataset, place: int) -> dict[str, float]:
    """Ratio of K_ap and H of the fundamental to those of the wave; empty for a sinusoid."""
    cycles = _cycle_settings(archive)
    if cycles.get("waveform") == "sinusoidal" or "storage_over_time" not in archive:
        return {}
    storage, loss = (
        float(np.nanmean(archive.variables[name].values[place, break_in_cycles(archive) :]))
        for name in ("storage_over_time", "loss_over_time")
    )
    load, apparent, energy = (
        float(archive.variables[f"test_{name}"].values[place])
        for name in ("tension_amplitude", *_WAVE)
    )
    square = storage**2 + loss**2
    found = (square**0.5 / apparent, np.pi * load**2 * loss / square / energy)
    return dict(zip(_WAVE, found, strict=True)) if min(found) > 0 else {}


def _cycle_settings(archive: xr.Dataset) -> dict[str, Any]:
    return dict(settings_of(archive).get("reduction", {}).get("cycles", {}))


def _cycle_of_level(archive: xr.Dataset, place: int, curve: LineCurve) -> RunOfLine:
    """A cyclic test of a rope at its level, with K_0 by the bend of its loops."""

    def values(name: str) -> Any:
        return archive.variables[name].values

    settings = _cycle_settings(archive)
    kept = break_in_cycles(archive)
    first, turn, last = (
        ends[kept:]
        for ends in (
            values("cycle_first_sample"),
            values("branch_first_sample")[:, 1],
            values("cycle_last_sample"),
        )
    )
    if "sample_index" in archive:  # only some cycles of a long record are stored
        index = values("sample_index")
        at = [np.searchsorted(index, one) for one in (first, turn, last)]
        whole = at[2] - at[0] == last - first
        first, turn, last = (one[whole] for one in at)
    above = tension_above_midline(
        values("strain")[place], values("tension")[place], first=first, turn=turn, last=last
    )
    mean, load, apparent, energy = (
        float(values(f"test_{one}")[place]) for one in RunOfLine._fields[:-1]
    )
    cycle = RunOfLine(mean, load, apparent, energy, np.nan)
    return constant_of_level(
        curve, cycle, *above, waveform=settings["waveform"], control=settings["control"]
    )


def _rope(folder: Path, name: str, tests: Sequence[LineSource]) -> LineSource:
    """Combined values of all tests of one rope."""
    by_quantity: dict[str, list[LineLevels]] = {}
    for line in tests:
        for one in line.levels:
            by_quantity.setdefault(one.quantity, []).append(one)
    pulls = [line for line in tests if any(one.quantity == _K_0 for one in line.curves)]
    absent = {}
    if len(pulls) > 1:
        why = "several slow pulls; each is a line of its own: " + ", ".join(
            line.name for line in pulls
        )
        absent = {one.quantity: why for one in pulls[0].curves}
    n_tests = sum(bool(line.levels) for line in tests)
    return replace(
        tests[0],
        name=name,
        source=f"{folder.name}, specimen {name}: "
        + ", ".join(
            [
                *([f"levels of {n_tests} tests"] if n_tests else []),
                *([f"slow pull {pulls[0].source}"] if len(pulls) == 1 else []),
            ]
        ),
        curves=pulls[0].curves if len(pulls) == 1 else (),
        levels=(*(_joined(parts) for parts in by_quantity.values()), *_changes(folder, name)),
        conditions=pulls[0].conditions if len(pulls) == 1 else {},
        absent=absent,
        notes=tuple(dict.fromkeys(text for line in tests for text in line.notes)),
    )


def _without_pooled(line: LineSource, ropes: Sequence[LineSource]) -> LineSource:
    """A test of a rope without the values that the line of the rope has."""
    own = next(one for one in ropes if one.name == line.specimens[0])
    kept = tuple(one for one in line.curves if not any(one is taken for taken in own.curves))
    return replace(line, levels=(), curves=kept)


_CHANGES = {
    "original stiffness": "original_stiffness",
    "static stiffness": "static_stiffness",
}


def _changes(folder: Path, specimen: str) -> list[LineLevels]:
    """Original and static stiffness of a rope, each a chord between two tensions."""
    path = folder / CHANGE_IN_LENGTH
    if not path.is_file():
        return []
    with reading(path) as archive:
        names = archive.variables["property_name"].values.astype(str)
        value = archive.variables["property_stiffness"].values
        is_own = archive.variables["property_specimen"].values.astype(str) == specimen
        found: dict[str, list[LineLevels]] = {}
        for place in np.flatnonzero(is_own & np.isfinite(value) & np.isin(names, list(_CHANGES))):
            one = _one_change(archive, int(place), _CHANGES[str(names[place])])
            found.setdefault(one.quantity, []).append(one)
        return [_joined(parts) for parts in found.values()]


def _one_change(archive: xr.Dataset, place: int, name: str) -> LineLevels:
    def number(what: str) -> float:
        return float(archive.variables[f"property_{what}"].values[place])

    ends = np.array([number("low_tension"), number("high_tension")])
    known = shared_contributions(archive, "property_stiffness", place)
    whole = "stiffness_standard_uncertainty"
    random = "stiffness_random_standard_uncertainty"
    remark = str(archive.variables["property_remark"].values[place])
    return LineLevels(
        quantity=name,
        variables=CYCLE[1:],
        at=np.array([[ends.mean(), np.ptp(ends) / 2]]),
        value=np.array([number("stiffness")]),
        random_standard_uncertainty=np.array(
            [number(random if f"property_{random}" in archive else whole)]
        ),
        degrees_of_freedom=np.array([number("stiffness_degrees_of_freedom")]),
        tests=(str(archive.variables["property_test"].values[place]),),
        component=tuple(known),
        contribution=np.array(list(known.values()), dtype=np.float64).reshape(len(known), 1),
        conditions=({},),
        warnings=((),),
        notes=(
            f"a chord between {plain_number(ends[0], 4)} and {plain_number(ends[1], 4)} N",
            *((remark,) if remark else ()),
        ),
    )


def experiments_with_pulls(path: Path) -> list[LineSource]:
    """Experiments of an archive of surfaces, one per specimen and slow pull.

    Surfaces of K_ap and H, with K_0 and the strain of the pull that the campaign names for the
    specimen; called EXPERIMENT SPECIMEN where an experiment has several.
    """
    opener = ReadOnce()
    with opener(path) as archive:
        found = lines_of_open_archive(archive, path, opener)
        settings = settings_of(archive)
    made = []
    for line in found:
        pulls = settings.get(line.name, {}).get("quasi_static", {})
        for specimen, test in pulls.items():
            pulled = _pull_of(path.parent, test, specimen, opener)
            made.append(
                replace(
                    line,
                    name=line.name if len(pulls) == 1 else f"{line.name} {specimen}",
                    source=f"{line.source}; slow pull {pulled.source}",
                    curves=_with_bend(path.parent, specimen, pulled.curves, opener, line.runs),
                    notes=tuple(dict.fromkeys((*line.notes, *pulled.notes))),
                )
            )
    if not made:
        raise DataError(
            "no specimen of the experiment has a slow pull (for K_0)",
            found=", ".join(line.name for line in found) or "no experiment with surfaces",
            needed="quasi_static = { SPECIMEN = TEST } of the experiment in campaign.toml",
        )
    return made


def _pull_of(folder: Path, test: str, specimen: str, opener: Opener = reading) -> LineSource:
    """K_0 and strain of one slow pull over tension."""
    # most archives have the name of their test
    for path in sorted(archives_of_tests(folder), key=lambda one: one.stem != test):
        with opener(path) as archive:
            if archive.attrs.get("test") == test:
                found = _line_source_of_test(archive, specimen)
                curves = tuple(one for one in found.curves if one.quantity not in _OVER_STRAIN)
                if curves:
                    return replace(found, curves=curves)
                raise ArchiveError(
                    f"the slow pull {test} of {specimen} has no load-strain curve",
                    found=str(path), needed="a pull with K_0",
                    hint="The notes of the test say why it has none.",
                )  # fmt: skip
    raise ArchiveError(
        f"the slow pull of {specimen} has no archive", found=f"no test {test} in {folder}",
        needed="the archives of the whole campaign in one folder",
    )  # fmt: skip


def _with_unique_names(found: Sequence[tuple[str, Sequence[LineSource]]]) -> list[LineSource]:
    """Lines of a campaign by file; a specimen that is in several files is called TEST SPECIMEN.

    Examples
    --------
    >>> line = LineSource("new", "", "rubber", "", "", 0.025, 3e3)
    >>> [one.name for one in _with_unique_names([("T-1", [line]), ("T-2", [line])])]
    ['T-1 new', 'T-2 new']
    """
    lines = [line for _, own in found for line in own]
    names = unique_names([(test, line.name) for test, own in found for line in own])
    return [replace(line, name=name) for line, name in zip(lines, names, strict=True)]


def unique_names(named: Sequence[tuple[str, str]]) -> list[str]:
    """Names of lines by test and specimen, as given by `_with_unique_names`."""
    count = Counter(name for _, name in named)
    return [f"{test} {name}" if count[name] > 1 else name for test, name in named]


def _specimens(path: Path, names: set[str], opener: Opener) -> dict[str, Facts]:
    """Properties that the archives of tests beside an archive of experiments state by specimen."""
    known: dict[str, Facts] = {}
    for one in archives_of_tests(path.parent):
        if names <= known.keys():
            break
        with opener(one) as archive:
            known |= _facts_of_specimens(archive)
    return known

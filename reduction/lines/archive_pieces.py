"""Archives of one specimen, including stepwise tests, as pieces of a tension-strain curve."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.shared_errors import components_of
from reduction.archive.test_dataset import strain_model_of
from reduction.archive.variables import read_notes, stored
from reduction.lines.composite import (
    CurvePiece,
    MeasuredLoop,
    PieceBranch,
    PieceSource,
    mean_piece,
    piece_of_pull,
    piece_of_steps,
    pieces_of_branches,
)
from reduction.quantities.flags import STEP_MASKS
from reduction.quantities.row import CONTRIBUTION
from reduction.record.contributions import Contributions
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Floats
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.strain.strain_model import StrainModel


def alignment_words(dataset: xr.Dataset, place: int) -> tuple[str, ...]:
    """Reference of the curves of one specimen whose cycles drift; empty if they do not."""
    laid_on = stored(dataset, "alignment_strain")
    if laid_on is None or np.isnan(laid_on.values[place]):
        return ()
    drift = float(dataset.variables["mean_strain_drift"].values[place])
    at = float(laid_on.values[place])
    return (
        f"the cycles are shifted to a mean strain of {100 * at:.3f} %, and theirs drifts by"
        f" {100 * drift:+.3f} % from the first to the last: a cycle differs from this curve by"
        " that much strain",
    )


def check_words(dataset: xr.Dataset, specimen: str) -> tuple[str, ...]:
    """Why a test has the status `check`, for a specimen or the whole test; else empty."""
    others = [name for name in specimens_of(dataset) if name != specimen]
    return tuple(
        f"{dataset.attrs.get('test', 'the test')} has the status check: {one}"
        for one in read_notes(dataset)
        if one.severity == "warning"
        and not any(
            str(one).startswith(f"{name}: ") or one.stage.endswith(f" {name}") for name in others
        )
    )


def parts_of(
    dataset: xr.Dataset, name: str, specimen: int | None = None, *, of: str
) -> tuple[Floats, Contributions | None]:
    """Both parts of the uncertainty of one curve in an archive."""
    rows = stored(dataset, f"{name}{CONTRIBUTION}")
    whole = f"{name}_standard_uncertainty"
    own = np.asarray(
        dataset[whole if rows is None else f"{name}_random_standard_uncertainty"].values
    )
    random = own if specimen is None else own[specimen]
    if rows is None:
        return random, None
    table = np.array(rows.values if specimen is None else rows.values[:, specimen])
    # an archive names the errors of all its specimens and quantities
    touched = np.nan_to_num(table).any(axis=tuple(range(1, table.ndim)))
    component = tuple(
        one for one, kept in zip(components_of(dataset), touched, strict=True) if kept
    )
    return random, Contributions(component, {of: table[touched]})


def _pieces_of_weights(
    dataset: xr.Dataset, branch: PieceBranch, name: str
) -> tuple[CurvePiece, ...]:
    """One branch of a stepwise test, or the mean of both."""
    random, shared = parts_of(dataset, "secant_modulus", of="secant_modulus")
    steps = _steps(dataset, random)
    if branch != "mean":
        return (piece_of_steps(steps, name=name, branch=branch, shared=shared),)
    up = piece_of_steps(steps, name=name, shared=shared)
    try:
        down = piece_of_steps(steps, name=name, branch="descending", shared=shared)
        return (mean_piece(up, down),)
    except DataError:
        # weights were never removed: the ascending branch replaces the mean, and keeps its name
        return (up,)


def _steps(dataset: xr.Dataset, random: Floats) -> StepwiseResult:
    flags = dataset.variables["step_flag"].values

    def number(name: str) -> float:
        return float(dataset.variables[name].values)

    def series(name: str) -> Any:
        return np.array(dataset.variables[name].values)

    return StepwiseResult(
        clock=tuple(dataset.variables["clock"].values.astype(str).tolist()),
        time=series("time"),
        tension=series("tension"),
        length=series("gauge_length"),
        eye_to_eye_length=series("eye_to_eye_length"),
        printed_strain=series("printed_strain"),
        strain=series("strain"),
        branch=series("branch"),
        gauge_length=number("relaxed_gauge_length"),
        gauge_length_standard_uncertainty=number("relaxed_gauge_length_standard_uncertainty"),
        is_inconsistent=(flags & STEP_MASKS["length_and_elongation_disagree"]) > 0,
        is_creep=(flags & STEP_MASKS["creep"]) > 0,
        is_odd=(flags & STEP_MASKS["off_its_neighbours"]) > 0,
        interval_strain=series("interval_strain"),
        interval_modulus=series("interval_modulus"),
        interval_modulus_standard_uncertainty=series("interval_modulus_standard_uncertainty"),
        interval_branch=series("interval_branch"),
        secant_modulus=series("secant_modulus"),
        secant_modulus_standard_uncertainty=np.array(random),
    )


def number_of(archive: xr.Dataset, name: str, place: int) -> float:
    """Value of one specimen or hose; NaN where the archive has none."""
    return float(archive.variables[name].values[place]) if name in archive else math.nan


@dataclass(frozen=True)
class Turns:
    """Turning points of the mean cycle; NaN where not known."""

    strain: tuple[float, float]
    tension: tuple[float, float]


def turns_of(archive: xr.Dataset, place: int) -> Turns:
    """Turns of the mean cycle: K_ap over its strain range, about the middle of peaks and valleys.

    Noise biases a measured peak, but not K_ap.
    """
    middle = number_of(archive, "alignment_strain", place)
    if math.isnan(middle):
        middle = number_of(archive, "test_mean_strain", place)
    half = number_of(archive, "test_strain_amplitude", place)
    level = math.nan
    if "peak_tension" in archive:
        ends = archive["peak_tension"].values[place] + archive["valley_tension"].values[place]
        level = float(np.mean(ends[np.isfinite(ends)]) / 2) if np.isfinite(ends).any() else math.nan
    pull = half * number_of(archive, "test_apparent_spring_constant", place)
    return Turns((middle - half, middle + half), (level - pull, level + pull))


_SAME = 1e-6
"""Relative difference within which two diameters are equal."""


def specimens_of(dataset: xr.Dataset) -> tuple[str, ...]:
    """Names of the specimens in the archive of a test; none for other archives."""
    if "specimen" not in dataset:
        return ()
    return tuple(dataset.variables["specimen"].values.astype(str).tolist())


def _pieces_of_test(
    dataset: xr.Dataset, specimen: str, *, branch: PieceBranch, name: str
) -> tuple[CurvePiece, ...]:
    """Pieces from one test: its cycles, its first loading, its weights, or its slow pull."""
    place = specimens_of(dataset).index(specimen)
    if "secant_modulus" in dataset and "step" in dataset.sizes:
        return _pieces_of_weights(dataset, branch, name)
    pieces: tuple[CurvePiece, ...] = ()
    if "branch_tension" in dataset:
        random, shared = parts_of(dataset, "branch_tension", place, of="tension")
        pieces += pieces_of_branches(
            dataset.variables["strain_bin"].values,
            dataset.variables["branch_tension"].values[place],
            random,
            name=name,
            branch=branch,
            shared=shared,
        )
    if branch == "descending":
        return pieces
    if "quasi_static_strain" in dataset and "tension_grid" in dataset:
        strain = dataset.variables["quasi_static_strain"].values[place]
        if np.count_nonzero(np.isfinite(strain)) > 1:
            # the first loading of a slow pull is the pull
            random, shared = parts_of(dataset, "quasi_static_strain", place, of="strain")
            grid = dataset.variables["tension_grid"].values
            return (*pieces, piece_of_pull(strain, grid, random, name=name, shared=shared))
    if "branch_tension_first_loading" in dataset:
        random, shared = parts_of(dataset, "branch_tension_first_loading", place, of="tension")
        pieces += pieces_of_branches(
            dataset.variables["first_loading_strain_bin"].values,
            dataset.variables["branch_tension_first_loading"].values[place],
            random,
            name=name,
            branch="ascending",
            kind="first-loading",
            shared=shared,
        )
    return pieces


_BUILT = 0.1
"""Share of the stroke over which a loop widens whose branches are not in the archive. [1]"""


def loop_of_test(dataset: xr.Dataset, specimen: str, name: str) -> MeasuredLoop | None:
    """Mean loop of a cyclic test; None where its stiffness or its width is not known."""
    place = specimens_of(dataset).index(specimen)
    turns = turns_of(dataset, place)
    stiffness, error, energy = (
        number_of(dataset, f"test_{quantity}", place)
        for quantity in (
            "apparent_spring_constant", "apparent_spring_constant_standard_uncertainty",
            "hysteresis_energy",
        )
    )  # fmt: skip
    strain, tension = np.array(turns.strain), np.array(turns.tension)
    stroke = float(strain[1] - strain[0])
    # a specimen that goes slack has another stiffness in a smaller cycle
    if not (np.isfinite(tension).all() and tension[0] > 0 and strain[0] > 0 and stroke > 0):
        return None
    if "branch_tension" in dataset:
        at = np.asarray(dataset["strain_bin"].values)
        up, down = dataset["branch_tension"].values[place]
        known = np.isfinite(up + down) & (at > strain[0]) & (at < strain[1])
        if not known.any():
            return None
        distance = np.concatenate([at[known] - strain[0], strain[1] - at[known]])
        width = np.tile((up - down)[known], 2)
    elif energy >= 0:
        # a loop of straight branches, of this energy
        distance = np.array([_BUILT * stroke])
        width = np.array([energy / stroke / (1 - _BUILT)])
    else:
        return None
    order = np.argsort(distance)
    distance, at_first = np.unique(distance[order], return_index=True)
    width = np.maximum.reduceat(width[order], at_first)
    return MeasuredLoop(
        name=name,
        strain=strain,
        tension=tension,
        distance=np.concatenate([[0.0], distance]),
        width=np.concatenate([[0.0], np.maximum.accumulate(np.maximum(width, 0.0))]),
        relative_uncertainty=error / stiffness if error > 0 else 0.0,
    )


def source_of_tests(
    datasets: Sequence[xr.Dataset], specimen: str, *, branch: PieceBranch
) -> PieceSource:
    """Pieces of one specimen from all of its tests."""
    own = [one for one in datasets if specimen in specimens_of(one)]
    others = sorted(_id(one) for one in datasets if specimen not in specimens_of(one))
    own.sort(key=lambda one: (_order(one), _id(one)))
    ids = [_id(one) for one in own]
    twice = next((one for one in ids if ids.count(one) > 1), None)
    if twice is not None:
        raise SettingsError(f"test {twice} is listed twice", needed="each archive once")
    wholes = {str(one.attrs.get("test", "")) for one in own}
    one_campaign = len({str(one.attrs.get("campaign", "")) for one in own}) == 1
    pieces: list[CurvePiece] = []
    loops: list[MeasuredLoop] = []
    piece_sources: list[str] = []
    notes = [f"of other specimens: {', '.join(others)}"] if others else []
    for one in own:
        test = str(one.attrs.get("test", "")) if one_campaign else _id(one)
        whole = str(one.attrs.get("part_of", ""))
        if whole in wholes:
            notes.append(f"{test} is left out: it is a part of {whole}")
            continue
        found = _pieces_of_test(one, specimen, branch=branch, name=test)
        loop = loop_of_test(one, specimen, test) if branch == "mean" else None
        if loop is not None:
            loops.append(loop)
        if not found:
            notes.append(f"{test} ({one.attrs.get('test_kind', 'unknown')}) has no {branch} curve")
            continue
        pieces += found
        piece_sources += [_said(one)] * len(found)
        notes += [f"DOUBTFUL: {text}" for text in check_words(one, specimen)]
        place = specimens_of(one).index(specimen)
        slips = int(one["n_slips"].values[place]) if "n_slips" in one else 0
        if slips > 0:
            notes.append(
                f"{test}: the splices slipped {slips} times, and the strain includes the slip"
            )
    if not pieces:
        has_cycles = any("cycle" in one.sizes for one in own)
        has_area = np.isfinite(_one_number(own, specimen, "area"))
        raise DataError(
            f"no test of '{specimen}' gives a {branch} curve of tension over strain",
            found=", ".join(f"{_id(one)} ({one.attrs.get('test_kind', '')})" for one in own),
            needed="a first rise, weights or a slow pull, or cycles of a specimen whose diameter"
            " or area is stated",
            hint=f"The branches of cycles are curves of stress: state the diameter of '{specimen}'"
            " in campaign.toml and run again."
            if has_cycles and not has_area
            else None,
        )
    for name in ("material", "construction"):
        stated = _words_of(own, specimen, name)
        if len(stated) > 1:
            raise SettingsError(
                f"the archives state another {name} of '{specimen}'",
                found=_stated_where(stated),
                needed="one specimen",
            )
    stated = _words_of(own, specimen, "condition")
    if len(stated) > 1:
        told = f"the archives state another condition of '{specimen}', {_stated_where(stated)}"
        notes.insert(0, f"DOUBTFUL: {told}: their tests belong together if this is one specimen")
    notes[:0] = [
        f"DOUBTFUL: {first} and {second} come from the same log: if they are the same cycles, they"
        " count twice; name one of them"
        for first, second in _same_logs(own)
    ]
    models = [strain_model_of(one, specimens_of(one).index(specimen)) for one in own]
    known = [model for model in models if model is not None]
    if any(_differ(known[0], other) for other in known[1:]):
        notes.append(
            f"the tests have different strain models; lengths follow that of "
            f"{next(_id(one) for one, model in zip(own, models, strict=True) if model is known[0])}"
        )
    return PieceSource(
        name=specimen,
        branch=branch,
        pieces=tuple(pieces),
        model=known[0] if known else None,
        diameter=_one_number(own, specimen, "diameter"),
        rated_break_strength=_one_number(own, specimen, "rated_break_strength"),
        linear_density=_one_number(own, specimen, "linear_density"),
        wet_linear_density=_one_number(own, specimen, "wet_linear_density"),
        sources=tuple(dict.fromkeys(piece_sources)),
        piece_sources=tuple(piece_sources),
        notes=tuple(notes),
        is_synthetic=any(one.attrs.get("synthetic") == "yes" for one in own),
        loops=tuple(loops),
    )


def _same_logs(datasets: Sequence[xr.Dataset]) -> list[tuple[str, str]]:
    """Ids of archives of different campaigns that were made from one log."""
    by_log: dict[str, dict[str, str]] = {}
    for one in datasets:
        digest = str(one.attrs.get("raw_file_sha256", ""))
        by_log.setdefault(digest, {}).setdefault(str(one.attrs.get("campaign", "")), _id(one))
    return [
        (first, other)
        for digest, (first, *others) in ((key, [*ids.values()]) for key, ids in by_log.items())
        if digest
        for other in others
    ]


def _id(dataset: xr.Dataset) -> str:
    return str(dataset.attrs.get("id", dataset.attrs.get("test", "")))


def _order(dataset: xr.Dataset) -> float:
    text = str(dataset.attrs.get("test_order", ""))
    return float(text) if text.isdigit() else float("inf")


def _said(dataset: xr.Dataset) -> str:
    about = dataset.attrs
    digest = f", raw file sha256 {about['raw_file_sha256']}" if about.get("raw_file_sha256") else ""
    origin = f", {about['source']}" if about.get("source") else ""
    return f"archive {_id(dataset)}{origin}{digest}"


def _differ(one: StrainModel, other: StrainModel) -> bool:
    """Whether two strain models have different laws; the range of the marks does not matter."""
    if one.method != other.method or one.coefficients.keys() != other.coefficients.keys():
        return True
    values = [np.array(list(model.coefficients.values())) for model in (one, other)]
    return not np.allclose(values[0], values[1], rtol=_SAME, atol=0)


def _words_of(datasets: Sequence[xr.Dataset], specimen: str, name: str) -> dict[str, str]:
    """First archive for each text that is stated of the specimen."""
    found: dict[str, str] = {}
    for one in datasets:
        if f"specimen_{name}" in one:
            text = str(one[f"specimen_{name}"].values[specimens_of(one).index(specimen)])
            if text:
                found.setdefault(text, _id(one))
    return found


def _stated_where(stated: dict[str, str]) -> str:
    return ", ".join(f"{text} in {where}" for text, where in stated.items())


def _one_number(datasets: Sequence[xr.Dataset], specimen: str, name: str) -> float:
    """Value stated for the specimen; NaN where none is."""
    found = [
        (float(one[name].values[specimens_of(one).index(specimen)]), _id(one))
        for one in datasets
        if name in one
    ]
    known = [(value, where) for value, where in found if np.isfinite(value)]
    if not known:
        return float("nan")
    value, where = known[0]
    for other, there in known[1:]:
        if abs(other - value) > _SAME * abs(value):
            raise SettingsError(
                f"the archives state another {name.replace('_', ' ')} of '{specimen}'",
                found=f"{value:.6g} in {where}, {other:.6g} in {there}",
                needed="one specimen",
            )
    return value

"""Archives of one specimen as pieces of a tension-strain curve."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from reduction.archive.pieceparts import parts_of
from reduction.archive.steppieces import pieces_of_weights
from reduction.archive.strainmodel import strain_model_of
from reduction.errors import DataError, SettingsError
from reduction.lookup.pieces import CurvePiece, PieceBranch, pieces_of_branches
from reduction.lookup.source import PieceSource
from reduction.lookup.staticpiece import piece_of_pull
from reduction.strain.model import StrainModel

_SAME = 1e-6
"""Relative difference of two diameters that are one."""


def specimens_of(dataset: xr.Dataset) -> tuple[str, ...]:
    """Names of the specimens of an archive of a test; none of another archive."""
    if "specimen" not in dataset:
        return ()
    return tuple(dataset.variables["specimen"].values.astype(str).tolist())


def pieces_of_test(
    dataset: xr.Dataset, specimen: str, *, branch: PieceBranch, name: str
) -> tuple[CurvePiece, ...]:
    """Pieces that one test gives: its cycles, its first rise, its weights, or its slow pull.

    Parameters
    ----------
    dataset : xarray.Dataset
        An archive of a reduced test.
    specimen : str
        One of its specimens.
    branch : {"ascending", "descending", "mean"}
        Of cycles and weights; a first rise and a slow pull only rise, and stand in for the mean.
    name : str
        Of the pieces.

    Returns
    -------
    pieces : tuple of CurvePiece
        None where the test has no curve of the branch.
    """
    place = specimens_of(dataset).index(specimen)
    if "secant_modulus" in dataset and "step" in dataset.sizes:
        return pieces_of_weights(dataset, branch, name)
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
            # the first rise of a slow pull is the pull
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


def source_of_tests(
    datasets: Sequence[xr.Dataset], specimen: str, *, branch: PieceBranch
) -> PieceSource:
    """Pieces of one specimen from all of its tests.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        Archives of reduced tests.
    specimen : str
        Its name, the same in all of them; archives without it are told in a note.
    branch : {"ascending", "descending", "mean"}
        As `pieces_of_test`.

    Returns
    -------
    source : PieceSource
        With the strain model of the first test that has one.

    Raises
    ------
    SettingsError
        If one test stands there twice, or diameters differ.
    DataError
        If no test gives a piece.
    """
    own = [one for one in datasets if specimen in specimens_of(one)]
    others = sorted(_id(one) for one in datasets if specimen not in specimens_of(one))
    own.sort(key=lambda one: (_order(one), _id(one)))
    ids = [_id(one) for one in own]
    twice = next((one for one in ids if ids.count(one) > 1), None)
    if twice is not None:
        raise SettingsError(f"test {twice} stands there twice", needed="each archive once")
    wholes = {str(one.attrs.get("test", "")) for one in own}
    one_campaign = len({str(one.attrs.get("campaign", "")) for one in own}) == 1
    pieces: list[CurvePiece] = []
    piece_sources: list[str] = []
    notes = [f"of other specimens: {', '.join(others)}"] if others else []
    for one in own:
        test = str(one.attrs.get("test", "")) if one_campaign else _id(one)
        whole = str(one.attrs.get("part_of", ""))
        if whole in wholes:
            notes.append(f"{test} is left out: it is a part of {whole}")
            continue
        found = pieces_of_test(one, specimen, branch=branch, name=test)
        if not found:
            notes.append(f"{test} ({one.attrs.get('test_kind', 'unknown')}) has no {branch} curve")
            continue
        pieces += found
        piece_sources += [_said(one)] * len(found)
        place = specimens_of(one).index(specimen)
        slips = int(one["n_slips"].values[place]) if "n_slips" in one else 0
        if slips > 0:
            notes.append(f"{test}: a splice slipped {slips} times, and its strains hold the slip")
    if not pieces:
        raise DataError(
            f"no test of '{specimen}' gives a {branch} curve of tension over strain",
            found=", ".join(f"{_id(one)} ({one.attrs.get('test_kind', '')})" for one in own),
            needed="cycles, a first rise, weights or a slow pull",
        )
    models = [strain_model_of(one, specimens_of(one).index(specimen)) for one in own]
    known = [model for model in models if model is not None]
    if any(_differ(known[0], other) for other in known[1:]):
        notes.append(
            f"tests have strain models of their own; lengths are by that of "
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
    )


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
    """Whether two strain models are of two laws; the range of the marks does not matter."""
    if one.method != other.method or one.coefficients.keys() != other.coefficients.keys():
        return True
    values = [np.array(list(model.coefficients.values())) for model in (one, other)]
    return not np.allclose(values[0], values[1], rtol=_SAME, atol=0)


def _one_number(datasets: Sequence[xr.Dataset], specimen: str, name: str) -> float:
    """What is stated of the specimen; NaN where nothing is."""
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

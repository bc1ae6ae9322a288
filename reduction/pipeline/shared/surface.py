"""Errors that the runs of an experiment share, in the coefficients of its surfaces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reduction.experiment import ExperimentResult, SharedSurfaces
from reduction.record import Bools, Floats
from reduction.surface.product import ResponseSurfaces
from reduction.uncertainty.surface import coefficient_contributions

_TRANSFORMED = ("log_", "box_cox_")


def with_shared_surfaces(result: ExperimentResult) -> ExperimentResult:
    """Carry what the runs share to the coefficients of every surface.

    Parameters
    ----------
    result : ExperimentResult
        As fitted; its runs know what they share.

    Returns
    -------
    result : ExperimentResult
        With ``shared``; as it was where there are no surfaces or nothing is shared.
    """
    surfaces, shared = result.surfaces, result.runs.shared
    if surfaces is None or shared is None or not shared.component:
        return result
    n_components, n_runs = len(shared.component), len(result.runs.run)
    half = (result.high - result.low) / 2
    level = np.zeros((n_components, n_runs, len(result.factor_names)))
    for place, name in enumerate(result.factor_names):
        if name in shared.values:
            level[..., place] = shared.values[name] / half[place]
    blocks = result.runs.specimen if len(set(result.runs.specimen)) > 1 else None
    names = None if blocks is None else np.unique(blocks, return_inverse=True)[1]
    rows = []
    for index, name in enumerate(surfaces.response_names):
        of = _measured(name)
        own = shared.values[of] * _slope_of_scale(result, surfaces, index, of)
        several = _of_several_runs(own, level)
        rows.append(
            coefficient_contributions(
                surfaces.coded, surfaces.exponents, surfaces.coefficient[index],
                response=own * several[:, None], level=level * several[:, None, None],
                blocks=names,
            )
            if np.isfinite(surfaces.coefficient[index]).all()
            else np.full((n_components, surfaces.coefficient.shape[1]), np.nan)
        )  # fmt: skip
    coded = np.stack(rows, axis=1)
    return replace(
        result,
        shared=SharedSurfaces(
            component=shared.component,
            coefficient=coded,
            coefficient_engineering=coded @ surfaces.engineering_matrix.T,
        ),
    )


def _of_several_runs(response: Floats, level: Floats) -> Bools:
    """Errors of more than one run: that of one (its temperature) is in the scatter already."""
    moves = (np.nan_to_num(response) != 0) | (np.nan_to_num(level) != 0).any(axis=2)
    return np.asarray(moves.sum(axis=1) > 1)


def _measured(name: str) -> str:
    """The response that a surface is of, whatever its scale."""
    for prefix in _TRANSFORMED:
        name = name.removeprefix(prefix)
    return name


def _slope_of_scale(
    result: ExperimentResult, surfaces: ResponseSurfaces, index: int, name: str
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Derivative of the scale of a surface over its response, at each run."""
    values = result.runs.response[result.response_names.index(name)]
    exponent = surfaces.transform_exponent[index]
    if surfaces.transform[index] == "none":
        return np.where(np.isfinite(values), 1.0, np.nan)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(values > 0, values ** (exponent - 1), np.nan))

"""A stepwise test out of its archive as pieces of a tension-strain curve."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from reduction.archive.pieceparts import parts_of
from reduction.archive.stepwise import STEP_MASKS
from reduction.errors import DataError
from reduction.lookup.pieces import CurvePiece, PieceBranch
from reduction.lookup.staticpiece import mean_piece, piece_of_steps
from reduction.moduli.stepwise import StepwiseResult
from reduction.record import Floats


def pieces_of_weights(
    dataset: xr.Dataset, branch: PieceBranch, name: str
) -> tuple[CurvePiece, ...]:
    """One branch of a stepwise test, or the mean of both.

    Parameters
    ----------
    dataset : xarray.Dataset
        Its archive.
    branch : {"ascending", "descending", "mean"}
        Which way; where weights were never taken off the way up stands for the mean.
    name : str
        Of the piece.

    Returns
    -------
    pieces : tuple of CurvePiece
        One.
    """
    random, shared = parts_of(dataset, "secant_modulus", of="secant_modulus")
    steps = _steps(dataset, random)
    if branch != "mean":
        return (piece_of_steps(steps, name=name, branch=branch, shared=shared),)
    up = piece_of_steps(steps, name=name, shared=shared)
    try:
        down = piece_of_steps(steps, name=name, branch="descending", shared=shared)
        return (mean_piece(up, down),)
    except DataError:
        # weights were never taken off: the way up stands for the mean, and says so by its branch
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
        interval_strain=series("interval_strain"),
        interval_modulus=series("interval_modulus"),
        interval_modulus_standard_uncertainty=series("interval_modulus_standard_uncertainty"),
        interval_branch=series("interval_branch"),
        secant_modulus=series("secant_modulus"),
        secant_modulus_standard_uncertainty=np.array(random),
    )

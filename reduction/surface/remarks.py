"""What a reader of response surfaces has to know: runs that miss, repeat, stray or stand alone."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from reduction.record import Bools, Floats
from reduction.surface.leastsquares import FIT_REASONS, LeastSquares
from reduction.surface.parts import BlockEffects, LackOfFit

_STRAY = 0.1
"""Coded distance beyond the levels of the plan, or short of them, that is worth a word."""
_ALONE = 0.99
"""Leverage from which a run has hardly a residual."""
_ILL = 30.0
"""Condition number of columns of the model matrix above which terms lean on each other."""


def remarks(
    *,
    coded: Floats,
    responses: Floats,
    fit: LeastSquares,
    lack: LackOfFit,
    blocks: BlockEffects | None,
    factor_names: Sequence[str],
    run_names: Sequence[str],
    response_names: Sequence[str],
    condition: float,
) -> tuple[str, ...]:
    """Notes of the surfaces, shortest list that leaves nothing out."""
    used = np.asarray(np.isfinite(responses).any(axis=0))
    notes = [
        *_missing(responses, used, run_names, response_names),
        *_reasons(fit, response_names),
        *_repeats(coded, responses, used, lack, run_names),
        *_levels(coded[used], factor_names),
        *_alone(fit, run_names),
    ]
    if condition > _ILL:
        notes.append(
            f"terms lean on each other: condition number {condition:.0f}, that of fifteen "
            "Box-Behnken runs met exactly is 4.24"
        )
    if blocks is not None:
        notes.append(_error_terms(blocks))
    return tuple(notes)


def _listed(names: Sequence[str], chosen: Bools) -> str:
    found = [name for name, taken in zip(names, chosen, strict=True) if taken]
    return ", ".join(found[:5]) + (f" and {len(found) - 5} more" if len(found) > 5 else "")


def _missing(
    responses: Floats, used: Bools, run_names: Sequence[str], response_names: Sequence[str]
) -> list[str]:
    notes = []
    if not used.all():
        notes.append(f"runs without any value: {_listed(run_names, ~used)}")
    short = np.asarray(np.isnan(responses[:, used]).any(axis=1))
    if short.any():
        notes.append(f"responses that miss further runs: {_listed(response_names, short)}")
    return notes


def _reasons(fit: LeastSquares, response_names: Sequence[str]) -> list[str]:
    return [
        f"{_listed(response_names, fit.reason == code)}: {text}"
        for code, text in FIT_REASONS.items()
        if code and (fit.reason == code).any()
    ]


def _repeats(
    coded: Floats, responses: Floats, used: Bools, lack: LackOfFit, run_names: Sequence[str]
) -> list[str]:
    notes = []
    # a run typed in twice looks like this, and makes pure error too small
    twins = [
        (first, second)
        for first, second in combinations(np.flatnonzero(used).tolist(), 2)
        if (coded[first] == coded[second]).all()
        and np.array_equal(responses[:, first], responses[:, second], equal_nan=True)
    ]
    if twins:
        first, second = twins[0]
        notes.append(
            f"runs {run_names[first]} and {run_names[second]} agree in every level and "
            f"response ({len(twins)} such pairs): repeats, or one run twice?"
        )
    spread = max(
        (np.ptp(coded[lack.cell == cell], axis=0).max() for cell in np.unique(lack.cell[used])),
        default=0.0,
    )
    if spread > 1e-9:
        notes.append(
            f"repeated runs differ by up to {spread:.2g} in coded levels (tolerance "
            f"{lack.tolerance:g}): pure error is taken after the surface has moved them together"
        )
    return notes


def _levels(coded: Floats, factor_names: Sequence[str]) -> list[str]:
    notes = []
    bounds = zip(factor_names, coded.min(axis=0), coded.max(axis=0), strict=True)
    for name, low, high in bounds:
        beyond = max(-1 - low, high - 1)
        short = max(low + 1, 1 - high)
        if beyond > _STRAY or short > _STRAY:
            what = "go beyond" if beyond > _STRAY else "fall short of"
            notes.append(f"levels of {name} {what} the plan: {low:.2f} to {high:.2f} coded")
    return notes


def _alone(fit: LeastSquares, run_names: Sequence[str]) -> list[str]:
    alone = np.any(np.nan_to_num(fit.leverage) > _ALONE, axis=0)
    # without degrees of freedom every run is, and the reason says so
    alone &= bool((fit.degrees_of_freedom > 0).any())
    if not alone.any():
        return []
    return [
        f"runs that fix a term alone and have no residual to check: {_listed(run_names, alone)}"
    ]


def _error_terms(blocks: BlockEffects) -> str:
    count = len(blocks.names)
    if blocks.treatment == "fixed":
        return (
            f"{count} specimens as fixed blocks: every term is judged by the residuals, which "
            "hold each specimen's own answer to the factors; the mean is of these specimens"
        )
    return (
        f"{count} specimens as random draws (REML): the mean is judged by the scatter between "
        f"specimens ({count - 1} degrees of freedom), the other terms by the residuals within; "
        "r2, analysis of variance, lack of fit and residuals are those of fixed blocks"
    )

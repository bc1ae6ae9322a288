"""Levels of the factors of a table of runs: coded, or in units that the plan knows."""

from __future__ import annotations

import re
from typing import NoReturn

import numpy as np

from reduction.campaign.cells import CODED, CellColumn, CellSheet
from reduction.campaign.spec import ExperimentSpec, FactorSpec
from reduction.errors import DataError, SettingsError
from reduction.record import Floats
from reduction.units import scale_of_unit

_SHARE = re.compile(r"%\s*(RBS|MBS|MBL|of mean)")
_OFF_PLAN = 1.0
"""Coded distance of the mean of all runs from the centre of the plan, beyond which the
levels are in another unit than the plan."""


def levels_of_factor(
    sheet: CellSheet, factor: FactorSpec, spec: ExperimentSpec | None, mean: Floats | None
) -> tuple[CellColumn, Floats]:
    """Column and coded levels of a factor."""
    column = sheet.one(factor.name, "factor")
    values = sheet.numbers(column)
    is_coded = factor.levels is None or (spec is not None and spec.levels == CODED)
    unit = column.unit or (CODED if is_coded else factor.unit)
    if unit == CODED:
        return column, values

    def refuse(problem: str, needed: str) -> NoReturn:
        raise SettingsError(
            f"{sheet.path}:{sheet.first} [{column.header}]: {problem}", found=f"'{unit}'",
            needed=needed,
        )  # fmt: skip

    if factor.levels is None:
        refuse("a unit without the levels that are -1 and 1", "[factors] in a SPEC.toml")
    axis, low, high = factor.axis(None if spec is None else spec.rated_break_strength)
    basis = factor.levels.basis
    share = _SHARE.fullmatch(unit)
    if share is not None:
        if basis != ("mean_tension" if share[1] == "of mean" else "rated_break_strength"):
            refuse(f"{factor.name} is no such share in the plan", f"a unit as {factor.unit}")
        strength = spec.rated_break_strength if spec is not None and axis == "N" else None
        found = values / 100 * (1.0 if strength is None else strength)
    else:
        try:
            si_unit, by, offset = scale_of_unit(unit)
        except SettingsError as error:
            refuse(error.problem, error.needed or "")
        found = by * values + offset
        if basis == "mean_tension" and si_unit == "N" and mean is not None:
            found = found / mean
        elif si_unit != axis:
            beside = "" if basis == "absolute" else ", or rated_break_strength in [experiment]"
            refuse(f"unit '{unit}' does not fit {factor.name}", f"such as {factor.unit}{beside}")
    coded: Floats = (found - (low + high) / 2) / ((high - low) / 2)
    return column, coded


def is_of_mean(factor: FactorSpec) -> bool:
    """Return whether the levels of a factor are shares of the mean tension."""
    return factor.levels is not None and factor.levels.basis == "mean_tension"


def check_levels(
    sheet: CellSheet, column: CellColumn, name: str, coded: Floats, *, stated: bool
) -> None:
    """Refuse levels that lie beside the plan: those of another unit."""
    known = coded[np.isfinite(coded)]
    if known.size and abs(known.mean()) > _OFF_PLAN:
        raise DataError(
            f"{sheet.path}:{sheet.row[0]} [{column.header}]: the levels of {name} lie beside the "
            "plan",
            found=f"{known.min():.4g} to {known.max():.4g} coded",
            needed="about -1 to 1",
            hint='Coded levels under [factors] in units need levels = "coded" in [experiment].'
            if stated
            else "Levels in units need a SPEC.toml with [factors].",
        )

"""What the runs of an experiment say before any fit: refusals, levels off the plan, cautions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from reduction.errors import DataError
from reduction.experiment import RunTable
from reduction.record import Bools, Floats, Integers
from reduction.surface.cautions import Caution, find_cautions
from reduction.surface.leastsquares import FIT_REASONS
from reduction.surface.levels import FactorLevels
from reduction.surface.product import ResponseSurfaces
from reduction.surface.reached import ON_PLAN, levels_off_plan
from reduction.surface.runsheet import RunSheet

_OFF_SCREENING = 0.1
_WRONG_HALF = 0.5
"""Coded distance from which a level of a screening is no more that of its column."""
_OF_ORDER = ("pure-error-excludes-drift", "order-confounded")
_NO_SURFACE = (1, 2, 6)


def listed(words: Sequence[str], *, most: int = 5, between: str = ", ") -> str:
    """The first of several, and how many more."""
    more = f" and {len(words) - most} more" if len(words) > most else ""
    return between.join(words[:most]) + more


def remarks_of_runs(runs: RunTable) -> list[str]:
    """One note a remark, with the runs that have it."""
    of_remark: dict[str, list[str]] = {}
    for run, remark in zip(runs.names, runs.remark, strict=True):
        for part in remark.split("; ") if remark else ():
            of_remark.setdefault(part, []).append(run)
    return [f"{listed(names)}: {remark}" for remark, names in of_remark.items()]


def surface_levels_off_plan(runs: RunTable, coded: Floats, names: Sequence[str]) -> list[str]:
    """A note where runs of a surface were not run where the plan has them."""
    words = levels_off_plan(
        coded, runs.coded_plan[:, : len(names)], beyond=ON_PLAN,
        run_names=runs.names, factor_names=names,
    )  # fmt: skip
    if not words:
        return []
    return [
        f"levels reached disagree with the plan by more than {ON_PLAN:g} coded: "
        f"{listed(words, between='; ')}; the surfaces are of the levels reached"
    ]


def require_screening_levels(runs: RunTable, coded: Floats, names: Sequence[str]) -> list[str]:
    """A note where runs of a screening strayed; `DataError` where they left their half."""
    given = {"run_names": runs.names, "factor_names": names}
    plan = runs.coded_plan[:, : len(names)]
    wrong = levels_off_plan(coded, plan, beyond=_WRONG_HALF, **given)
    if wrong:
        raise DataError(
            "levels reached are not those of the plan, on which the effects rest",
            found=listed(wrong, between="; "),
            needed=f"levels within {_WRONG_HALF:g} coded of the plan",
            hint="Look whether runs or logs are swapped; correct runs of the experiment.",
        )
    words = levels_off_plan(coded, plan, beyond=_OFF_SCREENING, **given)
    if not words:
        return []
    return [
        f"levels reached disagree with the plan by more than {_OFF_SCREENING:g} coded: "
        f"{listed(words, between='; ')}; they count as those of the plan"
    ]


def missing_surfaces(
    runs: RunTable, surfaces: ResponseSurfaces, response_names: Sequence[str]
) -> list[str]:
    """What has no surface, with what the runs say of it; one note where runs miss alike."""
    alike: dict[tuple[int, bytes], list[int]] = {}
    for row in range(len(response_names)):
        reason = int(surfaces.reason[row])
        if reason in _NO_SURFACE:
            key = (reason, np.isfinite(runs.response[row]).tobytes())
            alike.setdefault(key, []).append(row)
    notes = []
    for (reason, _), rows in alike.items():
        has = np.isfinite(runs.response[rows[0]])
        notes.append(
            f"refused: surface of {', '.join(response_names[row] for row in rows)}: "
            f"{FIT_REASONS[reason]} ({int(has.sum())} runs of {has.size}, "
            f"{len(surfaces.term_names)} terms){_causes(runs, ~has)}"
        )
    return notes


def _causes(runs: RunTable, chosen: Bools) -> str:
    """Reasons of the runs that are chosen, which stand first in their remarks, by frequency."""
    reasons = [runs.remark[row].split("; ")[0] for row in np.flatnonzero(chosen)]
    often = sorted(set(filter(None, reasons)), key=lambda text: (-reasons.count(text), text))
    said = [f"{text} ({reasons.count(text)} of them)" for text in often[:2]]
    return f": {'; '.join(said)}" if said else ""


def places_in_order(runs: RunTable, run_order: ArrayLike | None) -> Floats:
    """Place of each run among those of its specimen, from 1; NaN where no order is stated."""
    order = np.full(len(runs.run), np.nan)
    stated = order if run_order is None else np.asarray(run_order, dtype=np.float64)
    for specimen in set(runs.specimen):
        rows = np.flatnonzero([one == specimen for one in runs.specimen])
        rows = rows[np.isfinite(stated[rows])]
        order[rows] = np.unique(stated[rows], return_inverse=True)[1].ravel() + 1
    return order


def cautions_of_runs(
    runs: RunTable, factors: tuple[FactorLevels, ...], run_order: ArrayLike | None
) -> tuple[Caution, ...]:
    """What a run sheet of the runs as they were reached would warn of, specimen by specimen.

    Specimens that are pulled in one run are one line of the sheet, by the worst of them.
    """
    known = np.isfinite(runs.level).all(axis=1) & np.isfinite(runs.peak_tension)
    rows_of: dict[str, list[int]] = {}
    for row in np.flatnonzero(known).tolist():
        rows_of.setdefault(runs.run[row], []).append(row)
    sheets: dict[tuple[str, ...], list[str]] = {}
    for run, rows in rows_of.items():
        sheets.setdefault(tuple(runs.specimen[row] for row in rows), []).append(run)
    stated = np.full(len(runs.run), np.nan) if run_order is None else np.asarray(run_order)
    found: list[Caution] = []
    for specimens, names in sheets.items():
        order = stated[[rows_of[run][0] for run in names]]
        is_ordered = bool(np.isfinite(order).all())
        if is_ordered:
            names = [names[place] for place in np.argsort(order, kind="stable")]
        sheet = _sheet(runs, factors, [rows_of[run] for run in names])
        for caution in find_cautions(sheet, run_names=names, is_measured=True):
            message = caution.message
            if len(sheets) > 1 and caution.kind == "no-repeats":
                continue  # another specimen may hold the repeats
            if len(sheets) > 1 and not caution.runs:
                message = f"{', '.join(specimens)}: {message}"
            if caution.kind in _OF_ORDER and not is_ordered:
                message += " (runs as the campaign lists them: it states no order)"
            found.append(replace(caution, message=message))
    return tuple(found)


def _sheet(
    runs: RunTable, factors: tuple[FactorLevels, ...], rows: Sequence[list[int]]
) -> RunSheet:
    """One line a run, numbered by its first row from 1."""
    first: Integers = np.array([group[0] for group in rows])

    def each(values: Floats, how: np.ufunc | None = None) -> Floats:
        parts = [values[group] for group in rows]
        return np.array([part.mean(axis=0) if how is None else how.reduce(part) for part in parts])

    return RunSheet(
        factors=factors,
        run=first + 1,
        coded=runs.coded_plan[first, : len(factors)],
        engineering=each(runs.level),
        load_block=np.zeros(first.size, dtype=np.intp),
        mean_tension=each(runs.mean_tension),
        tension_amplitude=each(runs.tension_amplitude),
        peak_tension=each(runs.peak_tension, np.maximum),
        minimum_tension=each(runs.minimum_tension, np.minimum),
        peak_share=each(runs.peak_tension / runs.rated_break_strength, np.maximum),
        minimum_share=each(runs.minimum_tension / runs.rated_break_strength, np.minimum),
    )

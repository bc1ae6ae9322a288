"""The answers of a test as it is on the disk and as a change would make it, side by side."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite, nan

import numpy as np

from reduction.record import Floats
from reduction.report.htmltable import (
    NOT_GIVEN,
    Cell,
    Table,
    count,
    factors_of,
    make_table,
    measured,
    number,
    words,
)
from reduction.report.style import Kind, Shown, shown
from reduction.report.uncertainty import expanded_of, factor_words
from reduction.report.view import TestView

__all__ = ["answer_table"]

_QUANTITIES: tuple[tuple[str, str, Kind], ...] = (
    ("segment_modulus", "segment", "stress"),
    ("stress_at_strain", "stress of the first loading at", "stress"),
    ("test_apparent_spring_constant", "apparent spring constant", "tension"),
    ("test_hysteresis_energy", "hysteresis energy of a cycle", "energy"),
    ("test_loss_factor", "loss factor", "number"),
    ("test_quasi_static_spring_constant", "quasi-static spring constant", "tension"),
    ("test_dissipation_spring_constant", "dissipation spring constant", "tension"),
    ("test_relaxation_time", "relaxation time", "time"),
    ("dynamic_stiffness", "dynamic stiffness", "tension"),
    ("tensile_strength", "tensile strength", "tension"),
    ("strain_at_failure", "strain at failure", "strain"),
    ("pull_peak_tension", "greatest tension of the pull", "tension"),
    ("interval_modulus", "modulus between readings", "stress"),
    ("relaxation_drop", "tension lost in", "strain"),
    ("relaxation_rate_per_decade", "tension lost per decade of time in", "strain"),
    ("creep_rate_per_decade", "strain gained per decade of time in", "strain"),
    ("long_time_tension", "tension that is tended to in", "tension"),
    ("slack_strain_at_unloading", "strain where it goes slack", "strain"),
    ("permanent_set", "growth of the slack length", "strain"),
)
_CURVES: tuple[tuple[str, str, str, Kind, Kind], ...] = (
    ("tangent_modulus", "strain_bin", "modulus", "stress", "strain"),
    (
        "quasi_static_spring_constant", "tension_grid", "quasi-static spring constant", "tension",
        "tension",
    ),
    (
        "tangent_modulus_first_loading", "first_loading_strain_bin", "modulus of the first loading",
        "stress", "strain",
    ),
    (
        "branch_tension_first_loading", "first_loading_strain_bin",
        "tension of the first loading", "tension", "strain",
    ),
)  # fmt: skip
_PLACES = (0.1, 0.5, 0.9)
Key = tuple[str, ...]


@dataclass(frozen=True)
class _Answer:
    """One number: what it is, its unit, value and expanded uncertainty in SI.

    ``range`` is what it was taken over, where that may move with a setting.
    """

    words: str
    unit: Shown
    value: float
    half: float = nan
    factor: float = nan
    range: tuple[float, float] | None = None

    @property
    def cell(self) -> Cell:
        if self.unit.unit == "":
            return count(self.value)
        return measured(self.value, self.half, self.unit, factor=self.factor)


def answer_table(before: TestView | None, after: TestView | None) -> Table | None:
    """Return the answers before and after a change, with the difference.

    Parameters
    ----------
    before, after : TestView or None
        None where the test cannot be reduced so.

    Returns
    -------
    table : Table or None
        None where there is no number in either.
    """
    view = after or before
    if view is None:
        return None
    places = _common_places([one for one in (before, after) if one is not None])
    old = {} if before is None else dict(_answers(before, places))
    new = {} if after is None else dict(_answers(after, places))
    rows = [_row(old.get(key), new.get(key)) for key in dict.fromkeys([*old, *new])]
    if not rows:
        return None
    factors = factor_words(factors_of(rows))
    return make_table(
        "Answers as campaign.toml is, and as it would be.",
        ("number", "as it is", "changed", "unit", "difference", "difference [%]", "over U [1]"),
        rows, synthetic=view.is_synthetic, is_compact=True,
        remarks=[
            f"±: expanded uncertainty U, 95 %{f' ({factors})' if factors else ''}. Both columns"
            " are of one log and share its errors: a difference beyond a part of U is the choice"
            " of settings, not chance. Numbers of a curve are read between its points."
        ],
    )  # fmt: skip


def _row(old: _Answer | None, new: _Answer | None) -> list[Cell]:
    one = new or old
    if one is None:
        return []
    missing = Cell(NOT_GIVEN, is_number=True)
    head = [
        words(one.words),
        missing if old is None else old.cell,
        missing if new is None else new.cell,
        words(one.unit.unit or "1"),
    ]
    if old is None or new is None or not isfinite(new.value - old.value):
        return [*head, missing, missing, missing]
    if not _is_same_range(old, new):
        return [*head, words("another range"), missing, missing]
    moved = new.value - old.value
    share = 100 * moved / abs(old.value) if old.value else nan
    over = abs(moved) / old.half if isfinite(old.half) and old.half > 0 else nan
    return [
        *head,
        _signed(moved, one.unit.factor),
        _signed(share, 1.0),
        number(over, digits=2),
    ]


def _is_same_range(old: _Answer, new: _Answer) -> bool:
    """Whether both are of one range, to a tenth of it."""
    if old.range is None or new.range is None:
        return True
    width = old.range[1] - old.range[0]
    moved = max(abs(a - b) for a, b in zip(old.range, new.range, strict=True))
    return moved <= 0.1 * width


def _signed(value: float, factor: float) -> Cell:
    cell = number(value * factor, digits=3)
    sign = "+" if isfinite(value) and value > 0 else ""
    return Cell(f"{sign}{cell.text}", repr(float(value)) if isfinite(value) else "", True)


def _common_places(views: list[TestView]) -> dict[Key, list[float]]:
    """Places at which every view has a number of a curve: the middle of its range, near its ends.

    In SI, by quantity, specimen and branch.
    """
    ranges: dict[Key, list[tuple[float, float]]] = {}
    for view in views:
        for name, along, *_ in _CURVES:
            axis, curves = view.array(along), _rows_of(view, name)
            for key, row in curves.items():
                known = np.isfinite(row)
                if axis is not None and known.sum() > 1:
                    ends = (float(axis[known][0]), float(axis[known][-1]))
                    ranges.setdefault((name, *key), []).append(ends)
    found = {}
    for key, known_ends in ranges.items():
        low, high = max(one for one, _ in known_ends), min(one for _, one in known_ends)
        if len(known_ends) == len(views) and low < high:
            # as few digits as tell the places apart
            digits = 1 - int(np.floor(np.log10(high - low)))
            rounded = [round(low + place * (high - low), digits) for place in _PLACES]
            found[key] = [one for one in rounded if low <= one <= high]
    return found


def _rows_of(view: TestView, name: str, values: Floats | None = None) -> dict[Key, Floats]:
    """Curves of a quantity by specimen and, where it has them, branch."""
    values = view.array(name) if values is None else values
    if values is None:
        return {}
    branches = view.texts("branch_name") if values.ndim > 2 else ("",)
    rows = values.reshape(len(view.specimens), len(branches), -1)
    return {
        (specimen, branch): rows[index, place]
        for index, specimen in enumerate(view.specimens)
        for place, branch in enumerate(branches)
    }


def _answers(view: TestView, places: dict[Key, list[float]]) -> Iterator[tuple[Key, _Answer]]:
    if "cycle" in view.data.sizes:
        yield ("cycles",), _Answer("whole cycles", Shown("", 1.0), view.n_cycles)
    yield from _on_curves(view, places)
    for name, said, kind in _QUANTITIES:
        values = view.array(name)
        if values is None:
            continue
        spread = expanded_of(view, name, values)
        unit = shown(kind, view.units)
        dims = [str(dim) for dim in view.data[name].dims]
        for place in np.argwhere(np.isfinite(values)):
            at = dict(zip(dims, map(int, place), strict=True))
            own = tuple(place)
            over = _range(view, own) if name == "segment_modulus" else None
            words_of_one = _words_of(view, said, at, over)
            answer = _Answer(
                words_of_one, unit, float(values[own]), float(spread.half[own]),
                float(spread.factor[own]), over,
            )  # fmt: skip
            yield (name, *(f"{dim}={index}" for dim, index in at.items())), answer


def _on_curves(view: TestView, places: dict[Key, list[float]]) -> Iterator[tuple[Key, _Answer]]:
    """Numbers of curves at some places, between the points by a straight line."""
    for name, along, said, kind, of_axis in _CURVES:
        axis, values = view.array(along), view.array(name)
        if axis is None or values is None:
            continue
        spread = expanded_of(view, name, values)
        halves, factors = _rows_of(view, name, spread.half), _rows_of(view, name, spread.factor)
        unit, place_unit = shown(kind, view.units), shown(of_axis, view.units)
        for key, row in _rows_of(view, name).items():
            known = np.isfinite(row)
            for one in places.get((name, *key), ()):
                value, half, factor = (
                    float(np.interp(one, axis[known], of[known]))
                    for of in (row, halves[key], factors[key])
                )
                at = f"{said} at {one * place_unit.factor:.4g} {place_unit.unit}"
                text = ", ".join(filter(None, (at, key[1], key[0])))
                yield (name, *key, repr(one)), _Answer(text, unit, value, half, factor)


def _range(view: TestView, place: tuple[int, ...]) -> tuple[float, float] | None:
    """Strains that a segment is over."""
    low, high = view.array("segment_strain_low"), view.array("segment_strain_high")
    return None if low is None or high is None else (float(low[place]), float(high[place]))


def _words_of(
    view: TestView, said: str, at: dict[str, int], over: tuple[float, float] | None
) -> str:
    """What a number is: of which specimen, branch, elongation or hold."""
    if "hold" in at:
        hold = at["hold"]
        return f"{said} hold {view.hold_numbers[hold]}, {view.texts('hold_specimen')[hold]}"
    parts = [said]
    if "segment" in at and over is not None:
        parts = [f"{said} {at['segment'] + 1} ({100 * over[0]:.4g} to {100 * over[1]:.4g} %)"]
        parts.append(view.texts("branch_name")[at["branch_name"]])
    levels = view.array("strain_level")
    if "strain_level" in at and levels is not None:
        parts = [f"{said} {100 * levels[at['strain_level']]:g} %"]
    if "specimen" in at:
        parts.append(view.specimens[at["specimen"]])
    return ", ".join(parts)

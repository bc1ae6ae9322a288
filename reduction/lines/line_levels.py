"""Design values from tests at single levels of a cycle: at a tested level, or between two.

Nothing is fitted and nothing is extrapolated.  Tests whose levels agree are one level: its value is
their mean, and with several tests the interval includes the scatter between them.  On the straight
line between two tested levels the value is interpolated, and the interval spans the intervals of
both: this requires only that the quantity is monotone between them.  A frequency is interpolated by
its logarithm, since periods are tested in decades.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from reduction.lines.line_curve import half_width_of_parts
from reduction.lines.lookup_product import LineLevels
from reduction.quantities.digits import plain_number
from reduction.quantities.names import quantity as quantity_of
from reduction.record.errors import DataError, SettingsError
from reduction.record.measurement import Bools, Floats, read_only_arrays

SAME_LEVEL = 0.02
"""Relative difference within which a machine reaches a set level, and two levels are equal. [1]"""


INTERPOLATED = "not tested, interpolated between"
"""Beginning of a note on a value between two tested levels."""

TESTED_IN = ("medium", "soak", "temperature")
"""Conditions that change a value."""


@dataclass(frozen=True)
@read_only_arrays
class _LevelPoints:
    """Results at points; arrays have the shape (n_points,), contributions one row per error.

    ``low`` and ``high`` are for one more test, NaN where a level has a single one; ``notes`` name
    the tests that were used, ``warnings`` are those of these tests.
    """

    value: Floats
    random: Floats
    freedom: Floats
    run_random: Floats
    contribution: Floats
    test_low: Floats
    test_high: Floats
    low: Floats
    high: Floats
    notes: tuple[str, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class _Level:
    """Tests at one level, combined."""

    at: Floats
    value: float
    random: float
    freedom: float
    run_random: float
    contribution: Floats
    interval: tuple[float, float]
    run_interval: tuple[float, float]
    words: str
    warnings: tuple[str, ...]
    unsettled: tuple[str, ...]


def _is_same(a: Floats, b: Floats) -> Bools:
    """Whether levels agree in every variable; the last axis is of variables."""
    return np.asarray(
        np.all(np.abs(a - b) <= SAME_LEVEL * np.maximum(np.abs(a), np.abs(b)), axis=-1)
    )


def levels_of_tests(levels: LineLevels) -> list[tuple[Floats, tuple[int, ...]]]:
    """Different levels, in the order of the tests, with the tests at each.

    Examples
    --------
    >>> at, ones = np.array([[100.0], [200.0], [101.0]]), np.ones(3)
    >>> of = LineLevels(
    ...     "apparent_spring_constant", ("mean_tension",), at, ones, ones, ones, tuple("abc")
    ... )
    >>> [(at.tolist(), tests) for at, tests in levels_of_tests(of)]
    [([100.5], (0, 2)), ([200.0], (1,))]
    """
    groups: list[list[int]] = []
    for row, at in enumerate(levels.at):
        own = next((one for one in groups if _is_same(levels.at[one[0]], at)), None)
        if own is None:
            groups.append([row])
        else:
            own.append(row)
    return [(levels.at[one].mean(axis=0), tuple(one)) for one in groups]


def completed_levels(
    levels: LineLevels, given: Mapping[str, Floats], name: str
) -> dict[str, Floats]:
    """Requested levels, completed with each missing level that is equal in all tests."""
    unknown = sorted(set(given) - set(levels.variables))
    if unknown:
        raise SettingsError(
            f"{levels.quantity} of {name} does not vary with {', '.join(unknown)}",
            needed="levels of " + ", ".join(levels.variables),
        )
    found = dict(given)
    for place, variable in enumerate(levels.variables):
        if variable in given:
            continue
        own = levels.at[:, place]
        if not _is_same(own[:, None], own[:1, None]).all():
            raise SettingsError(
                f"{levels.quantity} of {name} was tested at several levels of {variable}",
                found=", ".join(given) or "no level",
                needed=f"--{variable.replace('_', '-')} with one of "
                + ", ".join(_words(variable, one) for one in _distinct(own)),
            )
        found[variable] = np.asarray(own.mean())
    return {variable: found[variable] for variable in levels.variables}


def refuse_mixed_conditions(levels: LineLevels, name: str) -> None:
    """Refuse to combine tests made wet and dry, or at several temperatures, as one line."""
    seen = {
        tuple((key, one[key]) for key in TESTED_IN if one.get(key)) for one in levels.conditions
    }
    if len(seen) > 1:
        said = sorted(", ".join(f"{key} {value}" for key, value in one) or "none" for one in seen)
        raise SettingsError(
            f"{levels.quantity} of {name} was tested in several conditions",
            found="; ".join(said),
            needed="--medium or --temperature that leaves one",
        )


def _distinct(values: Floats) -> list[float]:
    """Distinct values, increasing."""
    found: list[float] = []
    for one in np.sort(values).tolist():
        if not found or one - found[-1] > SAME_LEVEL * one:
            found.append(one)
    return found


def _words(variable: str, value: float) -> str:
    unit = quantity_of(variable).unit
    return f"{plain_number(value, 4)} {unit}"


def _level_words(levels: LineLevels, at: Sequence[float]) -> str:
    return ", ".join(
        f"{variable.replace('_', ' ')} {_words(variable, float(value))}"
        for variable, value in zip(levels.variables, at, strict=True)
    )


def _together(levels: LineLevels, at: Floats, tests: tuple[int, ...]) -> _Level:
    """Mean of the tests at one level; with several, their scatter is in the interval."""
    rows, n = list(tests), len(tests)
    value = float(levels.value[rows].mean())
    own = levels.random_standard_uncertainty[rows]
    random, freedom = float(own[0]), float(levels.degrees_of_freedom[rows[0]])
    run_random = np.nan
    if n > 1:
        scatter = float(levels.value[rows].std(ddof=1))
        # two tests may agree by chance: never better than the uncertainty of each
        within = float(np.sqrt(np.sum(own**2)) / n)
        random, freedom = max(scatter / np.sqrt(n), within), float(n - 1)
        run_random = float(np.hypot(max(scatter, within * np.sqrt(n)), random))
    shared = levels.contribution[:, rows].mean(axis=1) if levels.component else np.empty(0)
    few = [one.degrees_of_freedom for one in levels.component]

    def ends(spread: float) -> tuple[float, float]:
        if not np.isfinite(spread):
            return np.nan, np.nan
        half = float(half_width_of_parts([spread], [freedom], shared, few))
        return value - half, value + half

    names = ", ".join(levels.tests[row] for row in rows)
    return _Level(
        at, value, random, freedom, run_random, shared, ends(random), ends(run_random),
        f"{names} ({_level_words(levels, at.tolist())})",
        tuple(text for row in rows if levels.warnings for text in levels.warnings[row]),
        tuple(_unsettled(levels, rows, half=value - ends(random)[0])),
    )  # fmt: skip


def _unsettled(levels: LineLevels, rows: Sequence[int], *, half: float) -> Iterator[str]:
    """Tests whose value went on changing over their cycles, by more than its interval."""
    for row in rows if levels.late_change.size else ():
        off = float(levels.late_change[row])
        if abs(off * levels.value[row]) > half:
            yield (
                f"{levels.tests[row]} had not settled: the mean over the last half of its cycles is"
                f" {100 * abs(off):.1f} % {'higher' if off > 0 else 'lower'}"
            )


def _is_log(levels: LineLevels) -> Bools:
    """Whether each variable is interpolated by its logarithm."""
    return np.array([variable == "frequency" for variable in levels.variables])


def _scaled(levels: LineLevels, at: Floats) -> Floats:
    """Levels on the scales of interpolation."""
    return np.where(_is_log(levels), np.log(np.where(_is_log(levels), at, 1.0)), at)


def evaluate_levels(levels: LineLevels, at: Floats, name: str) -> _LevelPoints:
    """Value at points, at a tested level or between two.

    Parameters
    ----------
    levels : LineLevels
        Tests of one line.
    at : ndarray, shape (n_points, n_variables)
        Columns in the order of its variables. [SI]
    name : str
        Name of the line, for messages.

    Returns
    -------
    points : _LevelPoints
        [unit of the quantity]

    Raises
    ------
    DataError
        If a point is not a tested level and not on the straight line between two of them.

    Notes
    -----
    See the module docstring.  A level is tested where every variable is within `SAME_LEVEL` of it;
    of the pairs of levels with a point between them, the closest pair is used.

    Examples
    --------
    A quarter of the way from 100 to 200 N; the interval spans both:

    >>> two = LineLevels(
    ...     "apparent_spring_constant", ("mean_tension",), np.array([[100.0], [200.0]]),
    ...     np.array([1000.0, 1400.0]), np.array([10.0, 20.0]), np.full(2, np.inf), ("a", "b"),
    ... )
    >>> found = evaluate_levels(two, np.array([[100.0], [125.0]]), "rope")
    >>> print(found.value, found.test_low.round(1), found.test_high.round(1))
    [1000. 1100.] [980.4 980.4] [1019.6 1439.2]
    """
    known = [_together(levels, place, tests) for place, tests in levels_of_tests(levels)]
    size = len(at)
    names = ("value", "random", "freedom", "run_random", "test_low", "test_high", "low", "high")
    out = {one: np.full(size, np.nan) for one in names}
    rows = np.zeros((len(levels.component), size))
    is_found = np.zeros(size, dtype=bool)
    said: list[str] = []
    used: list[_Level] = []
    for one in known:
        here = _is_same(at, one.at) & ~is_found
        if not here.any():
            continue
        values = (one.value, one.random, one.freedom, one.run_random, *one.interval,
                  *one.run_interval)  # fmt: skip
        for column, value in zip(names, values, strict=True):
            out[column][here] = value
        rows[:, here] = one.contribution[:, None]
        is_found |= here
        said.append(f"tested: {one.words}")
        used.append(one)
    if not is_found.all():
        between, ends = _fill_between(levels, known, at, out, rows, is_found)
        said, used = said + between, used + ends
    if not is_found.all():
        first = at[np.flatnonzero(~is_found)[0]]
        near = min(known, key=lambda one: _distance(levels, one.at, first))
        raise DataError(
            f"{int((~is_found).sum())} of {size} points are neither a level at which"
            f" {levels.quantity} of {name} was tested nor between two tested levels",
            found=_level_words(levels, first.tolist()),
            needed=f"one of the {len(known)} tested levels; the nearest is {near.words}",
            hint="`--list` shows every level; nothing is extrapolated, not even flagged.",
        )
    told = dict.fromkeys(text for one in used for text in one.warnings)
    said += [text for one in used for text in one.unsettled]
    return _LevelPoints(
        **out, contribution=rows, notes=tuple(dict.fromkeys(said)), warnings=tuple(told)
    )


def _distance(levels: LineLevels, a: Floats, b: Floats) -> float:
    """Distance of two levels, each variable as a share of the greatest tested one."""
    scale = np.ptp(_scaled(levels, levels.at), axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    return float(np.linalg.norm((_scaled(levels, a) - _scaled(levels, b)) / scale))


def _fill_between(
    levels: LineLevels,
    known: Sequence[_Level],
    at: Floats,
    out: Mapping[str, Floats],
    rows: Floats,
    is_found: Bools,
) -> tuple[list[str], list[_Level]]:
    """Interpolate at points between two levels, closest pairs first; give notes and warnings."""
    scaled = _scaled(levels, at)
    pairs = sorted(combinations(known, 2), key=lambda two: _distance(levels, two[0].at, two[1].at))
    said: list[str] = []
    used: list[_Level] = []
    for one, other in pairs:
        start, way = _scaled(levels, one.at), _scaled(levels, other.at) - _scaled(levels, one.at)
        # a variable that is equal in both does not locate a point between them
        moves = ~_is_same(one.at[:, None], other.at[:, None])
        way = np.where(moves, way, 0.0)
        # mean of the relative positions in the variables that differ
        steps = np.where(moves, (scaled - start) / np.where(moves, way, 1.0), 0.0)
        along = steps.sum(axis=1) / moves.sum()
        on_line = start + along[:, None] * way
        is_log = _is_log(levels)
        back = np.where(is_log, np.exp(np.where(is_log, on_line, 0.0)), on_line)
        here = ~is_found & (along > 0) & (along < 1) & _is_same(at, back)
        if not here.any():
            continue
        share = along[here]
        out["value"][here] = (1 - share) * one.value + share * other.value
        out["test_low"][here] = min(one.interval[0], other.interval[0])
        out["test_high"][here] = max(one.interval[1], other.interval[1])
        rows[:, here] = np.outer(one.contribution, 1 - share) + np.outer(other.contribution, share)
        is_found |= here
        said.append(
            f"{INTERPOLATED} {one.words} and {other.words}: the interval spans"
            f" both, and holds where {levels.quantity} is monotonic between them"
        )
        used += [one, other]
    return said, used

"""Which of many numbers changed, by how much of their uncertainty, and which row goes with which.

Nothing is read here: what is compared comes as arrays, whatever it was stored in.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

MOVED = 0.5
"""Shift above which an answer has moved, in standard uncertainties."""
RELATIVE = 1e-9
"""Relative change above which a number has changed; below it is the rounding of another sum."""
_OF_LARGEST = 1e-12
"""The same over the largest number of a variable, for those that are nothing beside it."""
_UNCERTAINTY, _RANDOM = "_standard_uncertainty", "_random_standard_uncertainty"
_PARTS = (_RANDOM, "_uncertainty_contribution")

Kind = Literal["answer", "uncertainty", "number", "text"]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Change:
    """How much of one variable of a file, or column of a table, changed, and the worst of it.

    Parameters
    ----------
    file, variable : str
        Where it stands; the file below the folder that was compared.
    kind : {"answer", "uncertainty", "number", "text"}
        An answer has a standard uncertainty beside it; a number has none.
    change : {"none", "changed", "came", "went", "shape"}
        What the worst is; "came" and "went" where nothing else did worse, "shape" where rows
        could not be matched.
    n, n_changed, n_moved, n_came, n_went : int
        Values that were compared, that differ, that moved, and of these those that are on one
        side only. A series that shares one uncertainty is one value.
    where : dict of str to str
        Labels of the worst, by dimension.
    before, after : float, int, str or None
        None where there is no number; lengths in words where the shape differs.
    unit : str
        Of both.
    standard_uncertainty, shift, relative : float or None
        Of the worst: its change over the uncertainty, and over the number before.
    """

    file: str
    variable: str
    kind: Kind
    change: Literal["none", "changed", "came", "went", "shape"] = "none"
    n: int = 0
    n_changed: int = 0
    n_moved: int = 0
    n_came: int = 0
    n_went: int = 0
    where: dict[str, str] = field(default_factory=dict)
    before: float | int | str | None = None
    after: float | int | str | None = None
    unit: str = ""
    standard_uncertainty: float | None = None
    shift: float | None = None
    relative: float | None = None


def uncertainty_name(name: str) -> str:
    """Name under which the standard uncertainty of a quantity stands; its own, where it is one.

    Examples
    --------
    >>> uncertainty_name("frequency"), uncertainty_name("frequency_standard_uncertainty")
    ('frequency_standard_uncertainty', 'frequency_standard_uncertainty')
    """
    return name if is_uncertainty(name) else name + _UNCERTAINTY


def is_uncertainty(name: str) -> bool:
    """Whether a name is that of a whole standard uncertainty, and not of a part of one."""
    return name.endswith(_UNCERTAINTY) and not name.endswith(_RANDOM)


def kind_of(name: str, *, has_uncertainty: bool) -> Kind:
    """What numbers of a name are."""
    if is_uncertainty(name):
        return "uncertainty"
    return "answer" if has_uncertainty and not name.endswith(_PARTS) else "number"


def shifts_between(
    before: NDArray[Any],
    after: NDArray[Any],
    uncertainty: NDArray[np.float64] | None,
    *,
    is_exact: bool = False,
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.float64]]:
    """Which numbers changed, which moved, and how far.

    Parameters
    ----------
    before, after : ndarray
        Numbers of one shape; NaN where there is none. [any]
    uncertainty : ndarray or None
        Standard uncertainty, of a shape that broadcasts; zero or NaN where it is not known, and
        None where a number has none. [as before]
    is_exact : bool
        Whether the last bit counts.

    Returns
    -------
    changed, moved : ndarray of bool
        A number has changed by more than 1e-9 of itself, and moved by more than half its
        uncertainty; where that is not known any change is a move. What came or went did both.
    shift : ndarray
        Change over uncertainty; NaN where there is none. [1]

    Examples
    --------
    >>> shifts_between(np.array([1.0, 2.0]), np.array([1.1, 2.4]), np.array([0.5, 0.5]))
    (array([ True,  True]), array([False,  True]), array([0.2, 0.8]))
    """
    left, right = before.astype(float), after.astype(float)
    is_missing = np.isnan(left), np.isnan(right)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        difference = right - left
        shift = np.full(left.shape, np.nan)
        if uncertainty is not None:
            shift = np.where(uncertainty > 0, difference / uncertainty, np.nan)
        if is_exact:
            changed = (before != after) & ~(is_missing[0] & is_missing[1])
            return changed, changed, shift
        sizes = np.fmax(np.abs(left), np.abs(right))
        largest = np.max(sizes, initial=0.0, where=np.isfinite(sizes))
        is_far = np.abs(difference) > RELATIVE * sizes + _OF_LARGEST * largest
    changed = is_far | (is_missing[0] != is_missing[1]) | ((left != right) & np.isinf(sizes))
    return changed, changed & ~(np.abs(shift) <= MOVED), shift


def worst_change(
    unchanged: Change,
    before: NDArray[Any],
    after: NDArray[Any],
    uncertainty: NDArray[np.float64] | None,
    where: Callable[[tuple[int, ...]], dict[str, str]],
    *,
    is_exact: bool,
    is_read: bool,
) -> Change:
    """Count what changed of a variable, and keep the worst.

    Parameters
    ----------
    unchanged : Change
        File, variable, kind and unit.
    before, after : ndarray
        Of one shape: numbers, or texts where the kind is "text".
    uncertainty : ndarray or None
        As `shifts_between` takes it; along a dimension that it does not have it has the length 1.
    where : callable
        Labels of a place.
    is_exact : bool
        Whether the last bit counts.
    is_read : bool
        Whether a person reads these numbers, so that one without uncertainty is an answer too.
    """
    shared: tuple[int, ...] = ()
    if unchanged.kind == "text":
        changed = np.asarray(before.astype(str) != after.astype(str))
        is_there, moved = np.ones_like(changed), np.zeros_like(changed)
        came = went = moved
        shift = relative = np.full(changed.shape, np.nan)
    else:
        changed, moved, shift = shifts_between(before, after, uncertainty, is_exact=is_exact)
        if unchanged.kind == "number" and not is_exact:
            moved = changed & (is_read and not unchanged.variable.endswith(_PARTS))
        left, right = before.astype(float), after.astype(float)
        is_there = ~(np.isnan(left) & np.isnan(right))
        came, went = is_there & np.isnan(left), is_there & np.isnan(right)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            relative = np.where(left != 0, (right - left) / np.abs(left), np.nan)
        if uncertainty is not None and uncertainty.ndim == left.ndim:
            sizes = zip(left.shape, uncertainty.shape, strict=True)
            shared = tuple(axis for axis, (size, own) in enumerate(sizes) if own < size)
    n, n_changed, n_moved, n_came, n_went = (
        int(np.sum(np.any(one, axis=shared) if shared else one))
        for one in (is_there, changed, moved, came, went)
    )
    if not n_changed:
        return replace(unchanged, n=n)
    score = np.abs(np.where(np.isfinite(shift), shift, relative))
    # what was zero, or is on one side alone, is no worse than what can be told in numbers
    score = np.where(np.isfinite(score), score, 0.0)
    score = np.where(moved if n_moved else changed, score, -1.0)
    at = tuple(int(place) for place in np.unravel_index(np.argmax(score), score.shape))
    own = None if uncertainty is None else np.broadcast_to(uncertainty, before.shape)[at]
    return replace(
        unchanged,
        change="came" if came[at] else "went" if went[at] else "changed",
        n=n,
        n_changed=n_changed,
        n_moved=n_moved,
        n_came=n_came,
        n_went=n_went,
        where=where(at),
        before=finite_or_none(before[at]),
        after=finite_or_none(after[at]),
        standard_uncertainty=finite_or_none(own),
        shift=finite_or_none(shift[at]),
        relative=finite_or_none(relative[at]),
    )


def finite_or_none(value: Any) -> Any:
    """A value as JSON has it: None where there is no finite number."""
    one = value.item() if hasattr(value, "item") else value
    return None if isinstance(one, float) and not np.isfinite(one) else one


def pair_by_name(before: Iterable[str], after: Iterable[str]) -> dict[str, str]:
    """Pair paths of variables by their last part, in whatever group they stand.

    Where a name stands in several groups, those paths go together that agree most from their ends.

    Examples
    --------
    >>> pair_by_name(["/frequency", "/a/x", "/b/x"], ["/b/x", "/cycles/frequency", "/new/a/x"])
    {'/frequency': '/cycles/frequency', '/a/x': '/new/a/x', '/b/x': '/b/x'}
    """
    before = list(before)
    of_name: dict[str, list[str]] = {}
    for path in after:
        of_name.setdefault(path.rpartition("/")[2], []).append(path)
    trials = sorted(
        (-_common_end(left, right), right.count("/"), place, right)
        for place, left in enumerate(before)
        for right in of_name.get(left.rpartition("/")[2], ())
    )
    pairs: dict[str, str] = {}
    taken = set()
    for _, _, place, right in trials:
        if before[place] not in pairs and right not in taken:
            pairs[before[place]] = right
            taken.add(right)
    return {left: pairs[left] for left in before if left in pairs}


def _common_end(left: str, right: str) -> int:
    """How many parts of two paths agree, from their ends."""
    if left == right:
        return left.count("/") + 2
    parts = zip(reversed(left.split("/")), reversed(right.split("/")), strict=False)
    return next((n for n, (one, other) in enumerate(parts) if one != other), left.count("/") + 1)


@dataclass(frozen=True)
class Rows:
    """How the rows of one side go with those of the other.

    Parameters
    ----------
    places : tuple of ndarray or None
        Of the rows that go together, on each side; None for all of them in their order.
    labels : list of ndarray
        Of the rows before, which are their last dimension; empty where there is none.
    removed, added : list of str
        Labels of the other rows.
    """

    places: tuple[Index | None, Index | None]
    labels: list[NDArray[Any]]
    removed: list[str] = field(default_factory=list)
    added: list[str] = field(default_factory=list)

    def words(self, matched: int) -> list[str]:
        """Labels of a matched row; its number where it has none."""
        place = matched if self.places[0] is None else int(self.places[0][matched])
        return [_words([one], place) for one in self.labels] or [str(place + 1)]


def rows_by_labels(before: list[NDArray[Any]], after: list[NDArray[Any]]) -> Rows:
    """Match rows by labels; of one that occurs again the first goes with the first.

    Examples
    --------
    >>> rows = rows_by_labels([np.array(["new", "used"])], [np.array(["old", "new"])])
    >>> rows.places, rows.removed, rows.added
    ((array([0]), array([1])), ['used'], ['old'])
    """
    if all(
        one.shape == other.shape and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
        for one, other in zip(before, after, strict=True)
    ):
        return Rows((None, None), before)
    left, right = (
        [_words(side, place) for place in range(side[0].shape[-1])] for side in (before, after)
    )
    places = {one: place for place, one in enumerate(_counted(right))}
    pairs = [(n, places[one]) for n, one in enumerate(_counted(left)) if one in places]
    both = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return Rows(
        (both[:, 0], both[:, 1]),
        before,
        [left[n] for n in sorted(set(range(len(left))) - set(both[:, 0].tolist()))],
        [right[n] for n in sorted(set(range(len(right))) - set(both[:, 1].tolist()))],
    )


def have_own_labels(sides: Iterable[Sequence[NDArray[Any]]]) -> bool:
    """Whether no two rows of a side have one label."""
    return all(
        len({_words(side, place) for place in range(side[0].shape[-1])}) == side[0].shape[-1]
        for side in sides
    )


def _words(labels: Sequence[NDArray[Any]], place: int) -> str:
    """Labels of a row in words; twelve digits, so that the last bit of a bin makes no other bin."""
    return ", ".join(
        f"{one:.12g}" if isinstance(one, float) else str(one)
        for label in labels
        for one in np.atleast_1d(label[..., place]).tolist()
    )


def _counted(labels: Iterable[str]) -> list[tuple[str, int]]:
    seen: Counter[str] = Counter()
    counted = []
    for label in labels:
        counted.append((label, seen[label]))
        seen[label] += 1
    return counted

"""Compares two products: numbers, names, attributes, tables and tests.

Files are read with the netCDF library directly, and variables are found by name in any group: a
comparison depends neither on the layout of an archive nor on the code that reads it.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import netCDF4
import numpy as np
import pandas as pd
from numpy.typing import NDArray

from reduction.archive.open import refuse_no_file
from reduction.archive.product_files import archives_in
from reduction.record.errors import ArchiveError, DataError, SettingsError

MOVED = 0.5
"""Shift above which an answer has moved, in standard uncertainties."""

RELATIVE = 1e-9
"""Relative change above which a number has changed; smaller ones are rounding in sums."""

_OF_LARGEST = 1e-12
"""The same relative to the largest number of a variable, for negligible values."""

_UNCERTAINTY, _RANDOM = "_standard_uncertainty", "_random_standard_uncertainty"

_PARTS = (_RANDOM, "_uncertainty_contribution")

Kind = Literal["answer", "uncertainty", "number", "text"]

Index = NDArray[np.intp]


@dataclass(frozen=True)
class Change:
    """Extent of changes in one variable of a file, or column of a table, and the worst one.

    Parameters
    ----------
    file, variable : str
        Location; the file is below the compared folder.
    kind : {"answer", "uncertainty", "number", "text"}
        An answer has a standard uncertainty; a number has none.
    change : {"none", "changed", "came", "went", "shape"}
        Worst kind of change; "came" and "went" if nothing is worse, "shape" if rows could not be
        matched.
    n, n_changed, n_moved, n_came, n_went : int
        Numbers of values compared, different and moved, and of those on one side only. A series
        with one common uncertainty is one value.
    where : dict of str to str
        Labels of the worst change, by dimension.
    before, after : float, int, str or None
        None if there is no number; lengths in words if the shape differs.
    unit : str
        Unit of both values.
    standard_uncertainty, shift, relative : float or None
        Of the worst change: relative to the uncertainty, and to the number before.
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


def _uncertainty_name(name: str) -> str:
    """Name of the standard uncertainty of a quantity; of an uncertainty, its own name.

    Examples
    --------
    >>> _uncertainty_name("frequency"), _uncertainty_name("frequency_standard_uncertainty")
    ('frequency_standard_uncertainty', 'frequency_standard_uncertainty')
    """
    return name if _is_uncertainty(name) else name + _UNCERTAINTY


def _is_uncertainty(name: str) -> bool:
    """Whether a name is that of a total standard uncertainty, not of a part."""
    return name.endswith(_UNCERTAINTY) and not name.endswith(_RANDOM)


def _kind_of(name: str, *, has_uncertainty: bool) -> Kind:
    """Kind of the numbers with a name."""
    if _is_uncertainty(name):
        return "uncertainty"
    return "answer" if has_uncertainty and not name.endswith(_PARTS) else "number"


def _shifts_between(
    before: NDArray[Any],
    after: NDArray[Any],
    uncertainty: NDArray[np.float64] | None,
    *,
    is_exact: bool = False,
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.float64]]:
    """Flags of the numbers that changed and moved, and their shifts.

    Examples
    --------
    >>> _shifts_between(np.array([1.0, 2.0]), np.array([1.1, 2.4]), np.array([0.5, 0.5]))
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


def _worst_change(
    unchanged: Change,
    before: NDArray[Any],
    after: NDArray[Any],
    uncertainty: NDArray[np.float64] | None,
    where: Callable[[tuple[int, ...]], dict[str, str]],
    *,
    is_exact: bool,
    is_read: bool,
) -> Change:
    """Count the changes of a variable, and keep the worst."""
    shared: tuple[int, ...] = ()
    if unchanged.kind == "text":
        changed = np.asarray(before.astype(str) != after.astype(str))
        is_there, moved = np.ones_like(changed), np.zeros_like(changed)
        came = went = moved
        shift = relative = np.full(changed.shape, np.nan)
    else:
        changed, moved, shift = _shifts_between(before, after, uncertainty, is_exact=is_exact)
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
    # changes from zero, or values on one side only, rank below numeric changes
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
        before=_finite_or_none(before[at]),
        after=_finite_or_none(after[at]),
        standard_uncertainty=_finite_or_none(own),
        shift=_finite_or_none(shift[at]),
        relative=_finite_or_none(relative[at]),
    )


def _finite_or_none(value: Any) -> Any:
    """A value for JSON: None unless it is a finite number."""
    one = value.item() if hasattr(value, "item") else value
    return None if isinstance(one, float) and not np.isfinite(one) else one


def _pair_by_name(before: Iterable[str], after: Iterable[str]) -> dict[str, str]:
    """Pair paths of variables by their last part, in any group.

    Examples
    --------
    >>> _pair_by_name(["/frequency", "/a/x", "/b/x"], ["/b/x", "/cycles/frequency", "/new/a/x"])
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
    """Number of parts that agree at the ends of two paths."""
    if left == right:
        return left.count("/") + 2
    parts = zip(reversed(left.split("/")), reversed(right.split("/")), strict=False)
    return next((n for n, (one, other) in enumerate(parts) if one != other), left.count("/") + 1)


@dataclass(frozen=True)
class _Rows:
    """Assignment of rows between the two sides."""

    places: tuple[Index | None, Index | None]
    labels: list[NDArray[Any]]
    removed: list[str] = field(default_factory=list)
    added: list[str] = field(default_factory=list)

    def words(self, matched: int) -> list[str]:
        """Labels of a matched row; its number if it has none."""
        place = matched if self.places[0] is None else int(self.places[0][matched])
        return [_words([one], place) for one in self.labels] or [str(place + 1)]


def _rows_by_labels(before: list[NDArray[Any]], after: list[NDArray[Any]]) -> _Rows:
    """Match rows by labels; repeated labels are matched in order.

    Examples
    --------
    >>> rows = _rows_by_labels([np.array(["new", "used"])], [np.array(["old", "new"])])
    >>> rows.places, rows.removed, rows.added
    ((array([0]), array([1])), ['used'], ['old'])
    """
    if all(
        one.shape == other.shape and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
        for one, other in zip(before, after, strict=True)
    ):
        return _Rows((None, None), before)
    left, right = (
        [_words(side, place) for place in range(side[0].shape[-1])] for side in (before, after)
    )
    places = {one: place for place, one in enumerate(_counted(right))}
    pairs = [(n, places[one]) for n, one in enumerate(_counted(left)) if one in places]
    both = np.array(pairs, dtype=np.intp).reshape(-1, 2)
    return _Rows(
        (both[:, 0], both[:, 1]),
        before,
        [left[n] for n in sorted(set(range(len(left))) - set(both[:, 0].tolist()))],
        [right[n] for n in sorted(set(range(len(right))) - set(both[:, 1].tolist()))],
    )


def _have_own_labels(sides: Iterable[Sequence[NDArray[Any]]]) -> bool:
    """Whether all rows on each side have different labels."""
    return all(
        len({_words(side, place) for place in range(side[0].shape[-1])}) == side[0].shape[-1]
        for side in sides
    )


def _words(labels: Sequence[NDArray[Any]], place: int) -> str:
    """Labels of a row in words; twelve digits, so that the last bit does not distinguish bins."""
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


_LABELS = frozenset(
    "specimen test name law hold number numerator denominator source of cycle clock run".split()
)
"""Last words of variables that identify a row if no coordinate of a dimension does."""

_GRIDS = frozenset("bin grid level time radius".split())
"""Last words of columns with chosen rather than measured numbers."""

_RUNNING = frozenset(["hold", "uncertainty_component"])
"""Columns that number the rows of a file, and shift if a specimen is added."""

_APART = ("history", "software_version")


@dataclass
class Differences:
    """Changes between two products, in lists of plain objects.

    Parameters
    ----------
    is_exact : bool
        Whether a difference in the last bit counts.
    archived, tabled : list of Change
        One per variable of an archive and per column of a table, changed or not.
    added, removed : list of dict
        ``kind`` (campaign, archive, table, variable, column, rows), ``file`` and ``name``.
    regrouped : list of dict
        Variables now in another group, which is not a change.
    attributes, history : list of dict
        Records of ``file``, ``of`` (a variable or group), ``attribute``, ``before`` and ``after``;
        settings by key. History and software version are separate.
    tests : list of dict
        Rows of status.csv that differ in more than run time.
    """

    is_exact: bool
    archived: list[Change] = field(default_factory=list)
    tabled: list[Change] = field(default_factory=list)
    added: list[dict[str, Any]] = field(default_factory=list)
    removed: list[dict[str, Any]] = field(default_factory=list)
    regrouped: list[dict[str, str]] = field(default_factory=list)
    attributes: list[dict[str, Any]] = field(default_factory=list)
    history: list[dict[str, Any]] = field(default_factory=list)
    tests: list[dict[str, Any]] = field(default_factory=list)

    @property
    def changes(self) -> list[Change]:
        """Every quantity once: those of the archives, and those only in tables."""
        stored = {one.variable for one in self.archived}
        told = {one.variable for one in self.archived if one.n_changed}
        return self.archived + [
            one
            for one in self.tabled
            if one.variable not in stored
            or (one.n_changed and (one.variable not in told or one.kind == "number"))
        ]

    @property
    def is_moved(self) -> bool:
        """Whether an answer moved, or a test reduced before now fails."""
        return any(one.n_moved for one in self.archived + self.tabled) or any(
            one["fails_now"] for one in self.tests
        )

    def tell_names(
        self, kind: str, file: str, before: Iterable[str], after: Iterable[str]
    ) -> list[str]:
        """Names on both sides, in the order of the first; record others as added or removed."""
        sides = list(before), list(after)
        for told, here, there in ((self.removed, *sides), (self.added, *sides[::-1])):
            others = set(there)
            told += [{"kind": kind, "file": file, "name": one} for one in here if one not in others]
        common = set(sides[1])
        return [name for name in sides[0] if name in common]

    def tell_rows(self, file: str, name: str, rows: _Rows | None) -> None:
        """Record the rows of a dimension or table on one side only, ten of them by their labels."""
        if rows is not None:
            for told, labels in ((self.removed, rows.removed), (self.added, rows.added)):
                if labels:
                    one = {"kind": "rows", "file": file, "name": name}
                    told.append(one | {"n": len(labels), "rows": labels[:10]})


def differences_between(before: Path, after: Path, *, is_exact: bool = False) -> Differences:
    """Compare two archives, two tables, or two folders of products."""
    for path in (before, after):
        if not path.exists():
            raise ArchiveError(f"there is no file or folder {path}", needed="one that exists")
    found = Differences(is_exact)
    kinds = {path.suffix.lower() if path.is_file() else "folder" for path in (before, after)}
    if kinds == {"folder"}:
        _compare_processed(found, before, after)
    elif kinds == {".nc"}:
        _compare_archives(found, before.name, before, after)
    elif kinds == {".csv"}:
        _compare_tables(found, before.name, before, after)
    else:
        raise SettingsError(
            "these two cannot be compared",
            found=f"{before} and {after}",
            needed="two .nc, two .csv, two folders of archives, or two campaign.toml",
        )
    if not found.archived and not found.tabled:
        raise DataError(
            f"{before} and {after} have nothing in common",
            needed="archives or tables of one name, with variables or columns of one name",
        )
    return found


# folders


def _compare_processed(found: Differences, before: Path, after: Path) -> None:
    """Compare the only campaign on each side, or campaigns of the same name."""
    sides = _campaigns(before), _campaigns(after)
    if all(len(side) == 1 for side in sides):
        (one,), (other,) = (side.values() for side in sides)
        _compare_folders(found, "", one, other)
        return
    for name in found.tell_names("campaign", "", *sides):
        _compare_folders(found, f"{name}/", sides[0][name], sides[1][name])


def _campaigns(folder: Path) -> dict[str, Path]:
    inside = [folder] if archives_in(folder) else sorted(folder.iterdir())
    campaigns = {one.resolve().name: one for one in inside if archives_in(one)}
    if not campaigns:
        raise ArchiveError(
            f"{folder}: no archive was found",
            needed="a folder processed/CAMPAIGN with *.nc in it",
            hint="`reduction run CAMPAIGN.toml` makes one.",
        )
    return campaigns


def _compare_folders(found: Differences, place: str, before: Path, after: Path) -> None:
    archives, tables = (
        [
            {path.relative_to(side).as_posix(): path for path in listed(side)}
            for side in (before, after)
        ]
        for listed in (archives_in, lambda side: sorted(side.glob("tables/*.csv")))
    )
    for name in found.tell_names("archive", place, *archives):
        _compare_archives(found, place + name, archives[0][name], archives[1][name])
    for name in found.tell_names("table", place, *tables):
        _compare_tables(found, place + name, tables[0][name], tables[1][name])
    stated = [side / "status.csv" for side in (before, after)]
    if all(path.is_file() for path in stated):
        _compare_status(found, place, *(_read_table(path) for path in stated))


def _compare_status(
    found: Differences, place: str, before: pd.DataFrame, after: pd.DataFrame
) -> None:
    """Compare the status of each test, ignoring run time."""
    left, right = (
        {row.pop("test", ""): row for row in side.to_dict("records")}
        for side in (one.drop(columns="seconds", errors="ignore") for one in (before, after))
    )
    for test in [*left, *(test for test in right if test not in left)]:
        one, other = left.get(test), right.get(test)
        if one != other:
            ends = [None if row is None else row.get("exit_status") for row in (one, other)]
            found.tests.append(
                {
                    "test": place + test,
                    "change": "added" if one is None else "removed" if other is None else "changed",
                    "fails_now": ends[0] == "0" and ends[1] not in (None, "0"),
                    "before": one,
                    "after": other,
                }
            )


# archives


class _Archive:
    """An open file: groups, variables and dimensions by path, whatever its layout."""

    def __init__(self, path: Path, dataset: netCDF4.Dataset) -> None:
        self.path = path
        self.groups = dict(_walk(dataset))
        self.variables: dict[str, netCDF4.Variable[Any]] = {}
        self.dims: dict[str, list[str]] = {}
        self._of_name: dict[str, list[str]] = {}
        for place, group in self.groups.items():
            for name, variable in group.variables.items():
                key = f"{place}/{name}"
                self.variables[key] = variable
                dims = [f"{one.group().path.rstrip('/')}/{one.name}" for one in variable.get_dims()]
                # the last dimension of a text counts its characters
                self.dims[key] = dims[:-1] if variable.dtype == "S1" else dims
                self._of_name.setdefault(name, []).append(key)

    def read(self, key: str) -> NDArray[Any]:
        """Values as numbers or text; numbers never written are NaN."""
        variable = self.variables[key]
        with _unreadable(self.path, "netCDF"):
            variable.set_auto_maskandscale(False)
            variable.set_auto_chartostring(False)
            values = np.asarray(variable[...])
        if values.dtype.kind == "f":
            fill = getattr(variable, "_FillValue", netCDF4.default_fillvals[values.dtype.str[1:]])
            return np.where(values == fill, np.nan, values)
        if values.dtype.kind in "iub":
            return values
        if values.dtype == "S1" and values.ndim:
            size = max(values.shape[-1], 1)
            letters = np.zeros((*values.shape[:-1], size), "S1")
            letters[..., : values.shape[-1]] = values
            return np.char.decode(letters.view(f"S{size}")[..., 0], "utf-8", "replace")
        texts = [str(one) for one in values.ravel().tolist()]
        return np.array(texts, dtype=str).reshape(values.shape)

    def is_of(self, key: str, kinds: str) -> bool:
        """Whether values are of these numpy kinds; text and unknown types are "O"."""
        return getattr(self.variables[key].dtype, "kind", "O") in kinds

    def uncertainty_of(self, key: str) -> str | None:
        """Path of the standard uncertainty of a variable, preferably in the same group."""
        place, _, name = key.rpartition("/")
        stated = str(getattr(self.variables[key], "ancillary_variables", "")).split()
        for one in (_uncertainty_name(name), *filter(_is_uncertainty, stated)):
            paths = self._of_name.get(one, [])
            if paths:
                return f"{place}/{one}" if f"{place}/{one}" in paths else paths[0]
        return None

    @cached_property
    def labels(self) -> dict[str, dict[str, dict[str, str]]]:
        """Paths of row labels: by dimension, by rank, by name."""
        auxiliary = {
            name
            for variable in self.variables.values()
            for name in str(getattr(variable, "coordinates", "")).split()
        }
        found: dict[str, dict[str, dict[str, str]]] = {}
        for key, dims in self.dims.items():
            name = _name(key)
            is_text, is_single = not self.is_of(key, "fiub"), len(dims) == 1
            if is_single and name == _name(dims[0]):
                # the dimension may have another name on the other side
                rank, name = "number" if self.is_of(key, "iub") else "coordinate", ""
            elif is_single and name in auxiliary:
                rank = "auxiliary"
            elif (
                name.rpartition("_")[2] in _LABELS
                and dims
                and (is_text or (is_single and self.is_of(key, "iu")))
            ):
                rank = "named"
            else:
                continue
            found.setdefault(dims[-1], {}).setdefault(rank, {}).setdefault(name, key)
        return found

    def size(self, dim: str) -> int:
        """Number of rows of a dimension."""
        place, _, name = dim.rpartition("/")
        return int(self.groups[place].dimensions[name].size)


@contextmanager
def _unreadable(path: Path, kind: str) -> Iterator[None]:
    """Add the file name to library errors."""
    try:
        yield
    except (AttributeError, OSError, RuntimeError, ValueError) as error:
        said = str(error).splitlines() or [type(error).__name__]
        raise ArchiveError(f"{path} cannot be read as {kind}", found=said[0]) from error


@contextmanager
def _opened(path: Path) -> Iterator[_Archive]:
    refuse_no_file(path)
    with _unreadable(path, "netCDF"):
        dataset = netCDF4.Dataset(path)
    with dataset:
        yield _Archive(path, dataset)


def _walk(group: netCDF4.Dataset) -> Iterator[tuple[str, netCDF4.Dataset]]:
    yield str(group.path).rstrip("/"), group
    for inner in group.groups.values():
        yield from _walk(inner)


def _name(path: str) -> str:
    return path.rpartition("/")[2]


def _compare_archives(found: Differences, file: str, before: Path, after: Path) -> None:
    """Compare variables and attributes of two files."""
    with _opened(before) as left, _opened(after) as right:
        pairs = _pair_by_name(left.variables, right.variables)
        others = {other: key for key, other in pairs.items()}
        found.tell_names(
            "variable", file, (key.lstrip("/") for key in left.variables if key not in pairs), ()
        )
        found.tell_names(
            "variable", file, (), (key.lstrip("/") for key in right.variables if key not in others)
        )
        found.regrouped += [
            {"file": file, "variable": _name(key), "before": key, "after": other}
            for key, other in pairs.items()
            if key != other
        ]
        rows: dict[tuple[str, str], _Rows | None] = {}
        for key, other in pairs.items():
            dims = list(zip(left.dims[key], right.dims[other], strict=False))
            for pair in dims:
                if pair not in rows:
                    rows[pair] = _match_dimensions(left, right, pair)
                    found.tell_rows(file, _name(pair[0]), rows[pair])
            found.archived.append(
                _compare_variables(
                    file, (left, key), (right, other), [rows[pair] for pair in dims], found.is_exact
                )
            )
        _compare_attributes(found, file, left, right, pairs)


def _match_dimensions(before: _Archive, after: _Archive, pair: tuple[str, str]) -> _Rows | None:
    """Match rows of a dimension by labels, else by position; None if neither is possible."""
    ranks = before.labels.get(pair[0], {}), after.labels.get(pair[1], {})
    words: list[NDArray[Any]] = []
    for rank in ("coordinate", "auxiliary", "named", "number"):
        here, there = (side.get(rank, {}) for side in ranks)
        names = [name for name in here if name in there]
        is_text = any(not before.is_of(here[name], "fiub") for name in names)
        if not names or (rank == "named" and not is_text):
            continue
        sides = [before.read(here[one]) for one in names], [after.read(there[one]) for one in names]
        words = words or sides[0]
        rows = _rows_by_labels(*sides)
        if rows.places[0] is None:
            return rows
        if rows.places[0].size and ((rank == "coordinate" and is_text) or _have_own_labels(sides)):
            return rows
    is_as_long = before.size(pair[0]) == after.size(pair[1])
    return _Rows((None, None), words) if is_as_long else None


def _compare_variables(
    file: str,
    before: tuple[_Archive, str],
    after: tuple[_Archive, str],
    rows: Sequence[_Rows | None],
    is_exact: bool,
) -> Change:
    """Compare two variables along their matched rows."""
    sides, name = (before, after), _name(before[1])
    stated = [archive.uncertainty_of(key) for archive, key in sides]
    one = Change(
        file, name, _kind_of(name, has_uncertainty=any(stated)),
        unit=str(getattr(before[0].variables[before[1]], "units", "")),
    )  # fmt: skip
    if not all(archive.is_of(key, "fiub") for archive, key in sides):
        one = replace(one, kind="text")
    dims = [archive.dims[key] for archive, key in sides]
    known = [row for row in rows if row is not None]
    if len(dims[0]) != len(dims[1]) or len(known) < len(dims[0]):
        return _other_shape(one, [archive.variables[key].shape for archive, key in sides], is_exact)
    values = [
        _taken(archive.read(key), [row.places[side] for row in known])
        for side, (archive, key) in enumerate(sides)
    ]
    uncertainty = None
    if one.kind in ("answer", "uncertainty"):
        uncertainty = np.array(np.nan)
        for side, (archive, _) in enumerate(sides):
            own = stated[side]
            if own is not None and set(archive.dims[own]) <= set(dims[side]):
                has = [dim in archive.dims[own] for dim in dims[side]]
                places = [row.places[side] for row, is_in in zip(known, has, strict=True) if is_in]
                lengths = zip(values[0].shape, has, strict=True)
                shape = [size if is_in else 1 for size, is_in in lengths]
                read = _taken(archive.read(own), places).astype(float).reshape(shape)
                uncertainty = np.where(uncertainty > 0, uncertainty, read)
    return _worst_change(
        one, values[0], values[1], uncertainty,
        lambda at: {
            _name(dim): ", ".join(row.words(place))
            for dim, row, place in zip(dims[0], known, at, strict=True)
        },
        is_exact=is_exact, is_read=False,
    )  # fmt: skip


def _other_shape(one: Change, shapes: Sequence[tuple[int, ...]], is_exact: bool) -> Change:
    """An answer that cannot be compared counts as moved."""
    told = [" x ".join(map(str, shape)) or "one value" for shape in shapes]
    is_moved = one.kind != "text" and (is_exact or one.kind != "number")
    return replace(
        one, change="shape", n=1, n_changed=1, n_moved=int(is_moved), before=told[0], after=told[1]
    )


def _taken(values: NDArray[Any], places: Sequence[Index | None]) -> NDArray[Any]:
    """Matched rows along each dimension."""
    for axis, one in enumerate(places):
        if one is not None:
            values = np.take(values, one, axis=axis)
    return values


def _compare_attributes(
    found: Differences, file: str, before: _Archive, after: _Archive, pairs: Mapping[str, str]
) -> None:
    objects: list[tuple[str, Any, Any]] = [
        (place or "/", group, after.groups[place])
        for place, group in before.groups.items()
        if place in after.groups
    ]
    objects += [
        (_name(key), before.variables[key], after.variables[other]) for key, other in pairs.items()
    ]
    for name, one, another in objects:
        left, right = _attributes(one), _attributes(another)
        for key in [*left, *(key for key in right if key not in left)]:
            one_side, other_side = left.get(key), right.get(key)
            if repr(one_side) == repr(other_side):
                continue
            if key == "values_sha256":  # compared through the values themselves
                continue
            if key == "history":
                one_side, other_side = (
                    str(side or "").splitlines() for side in (one_side, other_side)
                )
                common = {*one_side} & {*other_side}
                one_side, other_side = (
                    [line for line in side if line not in common] for side in (one_side, other_side)
                )
            told: dict[str, Any] = {"file": file, "of": name, "attribute": key}
            told |= {"before": one_side, "after": other_side}
            (found.history if key in _APART else found.attributes).append(told)


def _attributes(one: netCDF4.Dataset | netCDF4.Variable[Any]) -> dict[str, Any]:
    """Attributes by name with the type of a variable; JSON objects key by key."""
    found = {"type": str(one.dtype)} if isinstance(one, netCDF4.Variable) else {}
    for name in one.ncattrs():
        value = one.getncattr(name)
        found |= _by_key(name, value.tolist() if hasattr(value, "tolist") else value)
    return found


def _by_key(name: str, value: Any) -> dict[str, Any]:
    if isinstance(value, str) and value.startswith("{"):
        try:
            value = json.loads(value)
        except ValueError:
            return {name: value}
    if isinstance(value, dict) and value:
        inner = (_by_key(f"{name}.{key}", one) for key, one in value.items())
        return {key: one for part in inner for key, one in part.items()}
    return {name: str(value) if isinstance(value, float) and np.isnan(value) else value}


# tables


def _read_table(path: Path) -> pd.DataFrame:
    with _unreadable(path, "a table"):
        return pd.read_csv(path, dtype=object, keep_default_na=False, encoding="utf-8")


def _compare_tables(found: Differences, file: str, before: Path, after: Path) -> None:
    """Compare rows by their first columns, and numbers by their uncertainty column."""
    frames = [_read_table(path) for path in (before, after)]
    columns = found.tell_names("column", file, *(frame.columns for frame in frames))
    if not columns:
        return
    sides = [{column: _cells(frame[column]) for column in columns} for frame in frames]
    keys = _key_columns(columns, frames, sides)
    rows = _match_tables(keys, [len(frame) for frame in frames], sides)
    if rows is None:
        told = [f"{len(frame)} row{'' if len(frame) == 1 else 's'}" for frame in frames]
        found.tabled.append(
            Change(file, "every column", "number", "shape", 1, 1, 1, before=told[0], after=told[1])
        )
        return
    found.tell_rows(file, "row", rows)
    sides = [
        {column: _taken(cells, [rows.places[n]]) for column, cells in side.items()}
        for n, side in enumerate(sides)
    ]
    names = {column.partition(" [")[0]: column for column in columns}
    labels = [key.partition(" [")[0] for key in keys] if rows.labels else ["row"]
    for name, column in names.items():
        values = [side[column] for side in sides]
        own = names.get(_uncertainty_name(name))
        kind = _kind_of(name, has_uncertainty=own is not None)
        if any(cells.dtype.kind == "U" for cells in values):
            kind = "text"
        uncertainty = None
        if own is not None and kind in ("answer", "uncertainty"):
            stated = [side[own] for side in sides if side[own].dtype.kind == "f"]
            if stated:
                uncertainty = np.where(stated[0] > 0, stated[0], stated[-1])
        found.tabled.append(
            _worst_change(
                Change(file, name, kind, unit=column.partition(" [")[2].rstrip("]")),
                values[0], values[1], uncertainty,
                lambda at: dict(zip(labels, rows.words(at[0]), strict=True)),
                is_exact=found.is_exact, is_read=True,
            )
        )  # fmt: skip


def _cells(column: pd.Series[Any]) -> NDArray[Any]:
    """Numbers, exactly, if all non-empty cells are numeric; otherwise text."""
    texts = column.tolist()
    try:
        return np.array([float(one) if one else np.nan for one in texts], dtype=float)
    except ValueError:
        return np.array(texts, dtype=str)


def _key_columns(
    columns: Sequence[str],
    frames: Sequence[pd.DataFrame],
    sides: Sequence[Mapping[str, NDArray[Any]]],
) -> list[str]:
    """The fewest first columns that identify a row; empty if there are none."""
    for skipped in (_RUNNING, frozenset[str]()):
        keys: list[str] = []
        for column in columns:
            name = column.partition(" [")[0]
            if name in skipped:
                continue
            is_grid = name.rpartition("_")[2] in _GRIDS
            if not is_grid and any(_is_measured(side[column]) for side in sides):
                break
            keys.append(column)
            if not any(frame.duplicated(keys).any() for frame in frames):
                return keys
    return []


def _is_measured(cells: NDArray[Any]) -> bool:
    """Whether a column has non-integer numbers."""
    return cells.dtype.kind == "f" and bool(np.any(cells[np.isfinite(cells)] % 1))


def _match_tables(
    keys: Sequence[str], lengths: Sequence[int], sides: Sequence[Mapping[str, NDArray[Any]]]
) -> _Rows | None:
    """Match rows by keys, else by position; None if neither is possible."""
    is_as_long = lengths[0] == lengths[1]
    by_place = _Rows((None, None), []) if is_as_long else None
    if not keys:
        return by_place
    labels = [[side[key] for key in keys] for side in sides]
    rows = _rows_by_labels(*labels)
    if rows.places[0] is None:
        return rows
    # integer keys alone may be answers, which would be taken for different rows
    is_sure = not is_as_long or any(cells.dtype.kind == "U" for cells in labels[0])
    return rows if rows.places[0].size and is_sure else by_place

"""Which rows of a table of outcomes belong together, and against which they are held.

References
----------
.. [1] CG-D-39-80, Tables 10 and 20: a group is a line (material, construction, diameter) in one
   condition.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isnan

import numpy as np

from reduction.errors import DataError
from reduction.outcomes.product import Outcome, OutcomeQuantity
from reduction.outcomes.strength import EXCLUDED, LOWER_BOUND, VALUE
from reduction.record import Floats, Integers, Specimen

_USE = {"value": VALUE, "lower_bound": LOWER_BOUND, "excluded": EXCLUDED}


@dataclass(frozen=True)
class Group:
    """One line in one condition; ``diameter`` [m] and ``exposure`` [year] None where not given."""

    line: str
    material: str
    construction: str
    diameter: float | None
    condition: str
    exposure: float | None

    @property
    def product(self) -> tuple[str, str, str, float | None]:
        """What stays the same when the line wears."""
        return self.line, self.material, self.construction, self.diameter


@dataclass(frozen=True)
class Grouped:
    """Rows of one quantity: its groups in order of appearance, and the group of each row."""

    groups: tuple[Group, ...]
    outcomes: tuple[Outcome, ...]
    group: Integers
    value: Floats
    use: Integers


def group_outcomes(outcomes: Iterable[Outcome], quantity: OutcomeQuantity) -> Grouped:
    """Rows of one quantity by group.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows of every quantity.
    quantity : str
        Which to take.

    Returns
    -------
    grouped : Grouped
        Every row of the quantity; an invalid test without a value has 1 for it, and is not used.

    Raises
    ------
    DataError
        If a value that is to be used is not above zero.

    Examples
    --------
    >>> words = ("new", "worn", "new")
    >>> rows = [Outcome("tensile_strength", 29e3, condition=word) for word in words]
    >>> grouped = group_outcomes(rows, "tensile_strength")
    >>> print([group.condition for group in grouped.groups], grouped.group)
    ['new', 'worn'] [0 1 0]
    """
    rows = tuple(row for row in outcomes if row.quantity == quantity)
    for row in rows:
        if row.use != "excluded" and not 0 < row.value < float("inf"):
            raise DataError(
                f"row {row.row} has no {quantity} to be used", found=f"{row.value:g}",
                needed="a value above zero",
            )  # fmt: skip
    keys = [
        Group(
            row.line, row.material, row.construction,
            None if isnan(row.diameter) else row.diameter,
            row.condition,
            None if isnan(row.exposure) else row.exposure,
        )
        for row in rows
    ]  # fmt: skip
    place = {key: number for number, key in enumerate(dict.fromkeys(keys))}
    return Grouped(
        groups=tuple(place),
        outcomes=rows,
        group=np.array([place[key] for key in keys], dtype=np.intp),
        value=np.array([row.value if row.value > 0 else 1.0 for row in rows]),
        use=np.array([_USE[row.use] for row in rows], dtype=np.intp),
    )


def reference_of(groups: Sequence[Group], *, reference_condition: str = "new") -> Integers:
    """Against which group each one is held.

    Parameters
    ----------
    groups : sequence of Group
        Of one quantity.
    reference_condition : str
        Word in ``condition`` that names a reference.

    Returns
    -------
    reference : ndarray of int, shape (n_groups,)
        Place of the group of the same line with that condition; -1 where there is none,
        where there are several, and for the reference itself. [1]

    Raises
    ------
    DataError
        If no condition is named.

    Examples
    --------
    >>> line = ("", "nylon", "plaited", None)
    >>> print(reference_of([Group(*line, "new", None), Group(*line, "5 years", 5.0)]))
    [-1  0]
    """
    if not reference_condition:
        raise DataError("no reference is named", needed="a word of the column condition")
    places: dict[tuple[str, str, str, float | None], list[int]] = {}
    for number, group in enumerate(groups):
        if group.condition == reference_condition:
            places.setdefault(group.product, []).append(number)
    found = [places.get(group.product, []) for group in groups]
    return np.array(
        [
            one[0] if len(one) == 1 and groups[one[0]] != group else -1
            for one, group in zip(found, groups, strict=True)
        ],
        dtype=np.intp,
    )


def _ratio(force: float, ratio: float, strength: float | None) -> tuple[float, float]:
    """A load and its share of the break strength, each from the other."""
    if strength is None:
        return force, ratio
    return (
        ratio * strength if isnan(force) else force,
        force / strength if isnan(ratio) else ratio,
    )


def complete_from_specimens(
    outcomes: Iterable[Outcome], specimens: Mapping[str, Specimen]
) -> tuple[Outcome, ...]:
    """Rows with what the sheets of their specimens say: what the row says itself stands.

    Parameters
    ----------
    outcomes : iterable of Outcome
        Rows as read.
    specimens : mapping of str to Specimen
        Of the campaign; a row of another specimen is left as it is.

    Returns
    -------
    outcomes : tuple of Outcome
        With material, construction, condition, diameter, and each load both in newton
        and over the rated break strength.

    Raises
    ------
    DataError
        Never for rows as read.

    Examples
    --------
    >>> sheet = Specimen("N-1", material="nylon", rated_break_strength=25e3)
    >>> row = Outcome("cycles_to_failure", 9e4, specimen="N-1", peak_load=10e3)
    >>> full, = complete_from_specimens([row], {"N-1": sheet})
    >>> print(full.material, full.peak_load_ratio)
    nylon 0.4
    """
    completed = []
    for row in outcomes:
        sheet = specimens.get(row.specimen)
        if sheet is None:
            completed.append(row)
            continue
        words = {
            name: getattr(row, name) or getattr(sheet, name)
            for name in ("material", "construction", "condition")
        }
        has_diameter = not isnan(row.diameter) or not sheet.diameter
        strength = sheet.rated_break_strength
        minimum, minimum_ratio = _ratio(row.minimum_load, row.minimum_load_ratio, strength)
        peak, peak_ratio = _ratio(row.peak_load, row.peak_load_ratio, strength)
        completed.append(
            replace(
                row,
                **words,
                diameter=row.diameter if has_diameter else sheet.mean_diameter,
                minimum_load=minimum,
                minimum_load_ratio=minimum_ratio,
                peak_load=peak,
                peak_load_ratio=peak_ratio,
            )
        )
    return tuple(completed)

"""The uncertainty budget of one number, and conformity with a limit.

References
----------
.. [1] JCGM 106:2012, "Evaluation of measurement data - The role of measurement uncertainty in
   conformity assessment," 8.2 (simple acceptance), 8.3 (decision rules based on guard bands).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from reduction.record.contributions import (
    Component,
    combined_standard_uncertainty,
    coverage_factor,
    effective_degrees_of_freedom,
)

_ROUNDING = 1e-9

RANDOM = "random"
"""Source of what is not shared: scatter, noise, regression."""


@dataclass(frozen=True)
class BudgetRow:
    """One source of the uncertainty of a number.

    ``contribution`` is signed where the source is one error, [unit of the number]; ``share`` is
    its share of the variance.
    """

    source: str
    of: str
    contribution: float
    share: float


@dataclass(frozen=True)
class Budget:
    """The uncertainty of one number.

    Parameters
    ----------
    quantity, unit : str
        What it is.
    place : dict of str to str
        Which number of its kind: specimen, branch, strain ...
    value, standard_uncertainty, expanded_uncertainty : float
        [unit]
    coverage_factor : float
        k of the expanded uncertainty, for 95 %. [1]
    degrees_of_freedom, effective_degrees_of_freedom : float
        Of the random part and of all parts together; k follows from the latter. [1]
    rows : tuple of BudgetRow
        Largest first; the shares add up to 1.
    words : dict of str to str
        What a place is, where its label alone does not say.
    """

    quantity: str
    unit: str
    place: dict[str, str]
    value: float
    standard_uncertainty: float
    expanded_uncertainty: float
    coverage_factor: float
    degrees_of_freedom: float
    effective_degrees_of_freedom: float
    rows: tuple[BudgetRow, ...]
    words: dict[str, str] = field(default_factory=dict)


def budget_of(
    quantity: str,
    unit: str,
    value: float,
    contributions: Mapping[Component, float],
    *,
    random: float,
    degrees_of_freedom: float,
    place: Mapping[str, str],
    words: Mapping[str, str],
) -> Budget:
    """Put the sources of one number in order.

    Notes
    -----
    Contributions from one source to one owner come from independent errors (the coefficients of
    a fit) and add as squares; a single one keeps its sign.  Anything below a billionth of the
    largest is the rounding of an error that cancels, not a source.

    Examples
    --------
    >>> cell = Component("tension_gain", "load cell")
    >>> budget = budget_of("segment_modulus", "Pa", 1e6, {cell: 3e3}, random=4e3,
    ...     degrees_of_freedom=9.0,
    ...     place={}, words={})
    >>> print([(row.source, round(row.share, 2)) for row in budget.rows])
    [('random', 0.64), ('tension_gain', 0.36)]
    >>> print(budget.standard_uncertainty, round(budget.coverage_factor, 2))
    5000.0 2.07
    """
    groups: dict[tuple[str, str], list[float]] = {}
    for one, amount in contributions.items():
        groups.setdefault((one.source, one.of), []).append(float(amount))
    amounts = {
        key: own[0] if len(own) == 1 else float(np.sqrt(np.sum(np.square(own))))
        for key, own in groups.items()
    }
    amounts[RANDOM, ""] = float(random)
    greatest = max(amount**2 for amount in amounts.values())
    total = float(combined_standard_uncertainty(list(amounts.values()), 0.0))
    rows = [
        BudgetRow(source, of, amount, (amount / total) ** 2 if total > 0 else 0.0)
        for (source, of), amount in amounts.items()
        if source == RANDOM or amount**2 > _ROUNDING * greatest
    ]
    effective = effective_degrees_of_freedom(
        random,
        degrees_of_freedom,
        contribution=np.array([*contributions.values()], dtype=np.float64),
        of_contribution=np.array([one.degrees_of_freedom for one in contributions]),
    )
    factor = float(coverage_factor(effective))
    return Budget(
        quantity=quantity,
        unit=unit,
        place=dict(place),
        value=value,
        standard_uncertainty=total,
        expanded_uncertainty=factor * total,
        coverage_factor=factor,
        degrees_of_freedom=degrees_of_freedom,
        effective_degrees_of_freedom=float(effective),
        words=dict(words),
        rows=tuple(sorted(rows, key=lambda row: (-row.share, row.source, row.of))),
    )


DecisionRule = Literal["simple acceptance", "guard band"]

Verdict = Literal["conforms", "does not conform", "no statement"]


def conformity(
    value: float,
    interval: tuple[float, float],
    *,
    lower: float | None,
    upper: float | None,
    rule: DecisionRule,
) -> Verdict:
    """Return the verdict of a rule on a number and its limits.

    Notes
    -----
    Simple acceptance: [1]_, 8.2; a value on a limit is then misjudged with a probability of up
    to 50 %.  A guard band as wide as the expanded uncertainty on either side of a limit: [2]_,
    8.3.2 and 8.3.3; at most 2.5 % on each side.

    Examples
    --------
    >>> for rule in ("simple acceptance", "guard band"):
    ...     print(conformity(1.02, (0.97, 1.07), lower=1.0, upper=None, rule=rule))
    conforms
    no statement
    """
    low, high = (value, value) if rule == "simple acceptance" else interval
    if math.isnan(low) or math.isnan(high):
        return "no statement"
    bottom = -math.inf if lower is None else lower
    top = math.inf if upper is None else upper
    if bottom <= low and high <= top:
        return "conforms"
    if high < bottom or low > top:
        return "does not conform"
    return "no statement"

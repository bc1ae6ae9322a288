"""What shared errors add to the ratios of moduli of a test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reduction.product import ReducedTest
from reduction.record import Floats
from reduction.uncertainty.product import Contributions
from reduction.uncertainty.ratio import ratio_contributions, with_shared_interval


def of_ratios(test: ReducedTest, found: Contributions) -> list[Contributions]:
    """Every ratio, along one axis; ``found`` holds the contributions to the moduli.

    Two sets of cycles of one specimen share every error of its instruments, its section and its
    splices in equal shares: they cancel.
    """
    rows = found.values.get("tangent_modulus")
    if not test.ratios or test.curves is None or rows is None:
        return []
    names = [one.name for one in test.specimens]
    moduli = test.curves.tangent_modulus
    tables: list[Floats] = []
    for ratio in test.ratios:
        if ratio.numerator not in names or ratio.denominator not in names:
            tables.append(np.zeros((len(found.component), *ratio.ratio.shape)))
            continue
        above, below = names.index(ratio.numerator), names.index(ratio.denominator)
        tables.append(
            ratio_contributions(
                ratio.ratio,
                numerator=moduli[above],
                of_numerator=rows[:, above],
                denominator=moduli[below],
                of_denominator=rows[:, below],
            )
        )
    return [Contributions(found.component, {"modulus_ratio": np.stack(tables, axis=1)})]


def with_shared_ratios(test: ReducedTest) -> ReducedTest:
    """Ratios with the interval of all errors; as they are where none is shared."""
    shared = test.contributions
    rows = None if shared is None else shared.values.get("modulus_ratio")
    if shared is None or rows is None:
        return test
    names = {one.name for one in test.specimens}
    wider = [
        with_shared_interval(ratio, rows[:, place], of_contribution=shared.degrees_of_freedom)
        if ratio.numerator in names
        else ratio
        for place, ratio in enumerate(test.ratios)
    ]
    return replace(test, ratios=tuple(wider))

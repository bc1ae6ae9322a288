"""The names: one row a quantity, the same in code, netCDF, tables and documents.

A name that is not here may not be a variable of a product or a column of a
table (a test reads this package).  Symbols stand only beside their source.

References
----------
.. [1] WHOI-2005-10 (tethers), [2] CG-D-39-80 (line), [3] WHOI-2004-06 (hoses); CF standard
   names are given only where the CF table has them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from reduction.vocabulary.catalogue import OF_CATALOGUE
from reduction.vocabulary.comparisons import OF_COMPARISONS
from reduction.vocabulary.experiments import OF_EXPERIMENTS
from reduction.vocabulary.line import OF_LINE
from reduction.vocabulary.outcomes import OF_OUTCOMES
from reduction.vocabulary.predictions import OF_PREDICTIONS
from reduction.vocabulary.reduced import OF_REDUCED
from reduction.vocabulary.responses import RESPONSE_PATTERNS, RESPONSES, SCALES, SURFACE_NAMES
from reduction.vocabulary.row import Quantity
from reduction.vocabulary.specimens import OF_SPECIMENS

__all__ = [
    "BRANCH_NAMES",
    "BRANCH_VALUES",
    "PHASE_VALUES",
    "QUANTITIES",
    "RESPONSES",
    "RESPONSE_PATTERNS",
    "SINGLE_QUANTITIES",
    "SURFACE_NAMES",
    "Quantity",
    "quantity",
]

PHASE_VALUES = {"rest": 0, "approach": 1, "hold": 2, "cycling": 3}
BRANCH_VALUES = {"none": 0, "ascending": 1, "descending": 2}
BRANCH_NAMES = ("ascending", "descending")

SINGLE_QUANTITIES = {
    row.name: row
    for row in (
        *OF_REDUCED, *OF_LINE, *OF_SPECIMENS, *OF_OUTCOMES, *OF_EXPERIMENTS, *OF_PREDICTIONS,
        *OF_COMPARISONS, *OF_CATALOGUE,
    )
}  # fmt: skip
"""Names that stand for themselves."""


def _squared(unit: str) -> str:
    """Unit of a square: ``J m-1`` to ``J2 m-2``."""
    return re.sub(r"([A-Za-z]+)(-?\d+)?", lambda found: f"{found[1]}{2 * int(found[2] or 1)}", unit)


def _of_responses() -> Iterator[Quantity]:
    """Every pattern for every surface and for a column of several."""
    for name in (*SURFACE_NAMES, "response"):
        base = next((name.removeprefix(one) for one in SCALES if name.startswith(one)), "")
        # a surface of a transform is evaluated in the unit of the response itself
        own = "response_unit" if name == "response" else SINGLE_QUANTITIES[base or name].unit
        unit = "1" if base else "unit" if name == "response" else own
        words = own_words = (base or name).replace("_", " ")
        if base:
            words = SCALES[name.removesuffix(base)].format(own_words)
            own_words = f"{own_words}, by the {words}"
        units = {"<unit>": unit, "<unit squared>": _squared(unit), "<response unit>": own}
        for pattern in RESPONSE_PATTERNS:
            of = own_words if pattern.unit == "<response unit>" else words
            yield Quantity(
                pattern.name.replace("<response>", name),
                units.get(pattern.unit, pattern.unit),
                f"{of}: {pattern.long_name}",
            )


QUANTITIES = SINGLE_QUANTITIES | {row.name: row for row in _of_responses()}
"""Every name that may stand in a product or a table."""


def quantity(name: str) -> Quantity:
    """Return the row of a name; `KeyError` where the vocabulary lacks it."""
    return QUANTITIES[name]

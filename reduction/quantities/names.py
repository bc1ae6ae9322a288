"""All names: one row per quantity, the same in code, netCDF, tables and documents.

Any variable of a product or column of a table must be listed here.  Symbols are given only with
their source.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from reduction.quantities.axes import AXES
from reduction.quantities.hoses import OF_COMPARISONS, OF_PREDICTIONS
from reduction.quantities.line_and_ropes import OF_LINE, OF_PROGRAMME, OF_PROPERTIES
from reduction.quantities.moduli import OF_MODULI
from reduction.quantities.outcomes_and_weights import IN_PLACE_OF_RECORD, OF_OUTCOMES, OF_STEPS
from reduction.quantities.row import Quantity, schema_from
from reduction.quantities.samples_and_cycles import OF_RECORD
from reduction.quantities.surfaces import OF_EVERY_SURFACE, OF_EXPERIMENTS, OF_RESPONSES
from reduction.quantities.table_columns import OF_CATALOGUE, OF_LOOK_UP, OF_TABLES

BRANCH_NAMES = ("ascending", "descending")

RESPONSES = (
    "apparent_spring_constant",
    "hysteresis_energy",
    "dissipation_spring_constant",
    "relaxation_time",
    "storage_spring_constant",
    "loss_spring_constant",
    "loss_factor",
    "dashpot_coefficient",
)
"""Possible responses of a surface."""

SCALES = {
    "log_frequency_times_": "logarithm of frequency times {}",
    "log_": "logarithm of {}",
    "box_cox_": "Box-Cox transform of {}",
}
"""Prefixes of a transformed response in the name of its surface, longest first."""

SURFACE_NAMES = (*RESPONSES, *(f"{scale}{name}" for scale in SCALES for name in RESPONSES))
"""Names of surfaces: a response, or its transform, which has no unit."""

RESPONSE_PATTERNS = (*OF_EVERY_SURFACE, *OF_RESPONSES)
"""Quantities of a response; its name, unit and unit squared are in angle brackets."""

OF_TEST = (*OF_RECORD, *OF_MODULI, *OF_LINE, *OF_PROGRAMME, *OF_STEPS)

_NOTES = tuple(row for row in AXES if row.group == "notes")

_SHARED_ERRORS = tuple(row for row in AXES if row.group != "notes")

SINGLE_QUANTITIES: dict[str, Quantity] = {
    row.name: row
    for row in (
        *OF_CATALOGUE, *OF_LOOK_UP, *OF_TABLES, *OF_EXPERIMENTS, *OF_OUTCOMES, *OF_COMPARISONS,
        *OF_PREDICTIONS, *OF_PROPERTIES, *AXES, *OF_TEST,
    )
}  # fmt: skip
"""Fixed names; for a name in several products, the row of a test."""


def _squared(unit: str) -> str:
    """Square of a unit: ``J m-1`` to ``J2 m-2``."""
    return re.sub(r"([A-Za-z]+)(-?\d+)?", lambda found: f"{found[1]}{2 * int(found[2] or 1)}", unit)


def response_of_surface(name: str) -> str:
    """The response of a surface, whatever its scale.

    Examples
    --------
    >>> response_of_surface("log_frequency_times_relaxation_time")
    'relaxation_time'
    """
    return name.removeprefix(next((one for one in SCALES if name.startswith(one)), ""))


def rows_of_response(name: str) -> Iterator[Quantity]:
    """Yield the quantities of one surface (of a response or its transform), or of several."""
    of = response_of_surface(name)
    scale = name.removesuffix(of)
    # a surface of a transform is evaluated in the unit of the response
    own = "response_unit" if name == "response" else SINGLE_QUANTITIES[of].unit
    unit = "1" if scale else "unit" if name == "response" else own
    own_words = of.replace("_", " ")
    words = SCALES[scale].format(own_words) if scale else own_words
    if scale:
        own_words = f"{own_words}, by the {words}"
    units = {"<unit>": unit, "<unit squared>": _squared(unit), "<response unit>": own}
    # measured quantities are not transformed
    for row in OF_EVERY_SURFACE if scale else RESPONSE_PATTERNS:
        said = own_words if row.unit == "<response unit>" else words
        yield row._replace(
            name=row.name.replace("<response>", name),
            unit=units.get(row.unit, row.unit),
            long_name=f"{said}: {row.long_name}",
            uncertainty_is=f"{said}: {row.uncertainty_is}" if row.uncertainty_is else "",
            group=row.group or ("coefficients" if scale else ""),
            # a table has one response below another
            tables=row.tables if name == "response" else (),
        )


_OF_SURFACES = tuple(row for name in SURFACE_NAMES for row in rows_of_response(name))

QUANTITIES: dict[str, Quantity] = SINGLE_QUANTITIES | {
    row.name: row for row in (*_OF_SURFACES, *rows_of_response("response"))
}
"""All names allowed in a product or a table, without their companions."""


_OF_CYCLES = (
    "apparent_spring_constant", "hysteresis_energy", "quasi_static_spring_constant",
    "dissipation_spring_constant", "relaxation_time", "dashpot_coefficient",
)  # fmt: skip

# the tension curve over strain is stored under the name of its branches; the results of a run call
# K_ap EA. Not here: the dynamic stiffness of a rope programme, K_ap over the last cycles of a step
_BY_WORDS = {
    "tension": "branch_tension",
    "EA": "apparent_spring_constant",
}


def name_of_quantity(text: str) -> str:
    """Name of a quantity requested by its symbol in the source, or as ``tension``.

    Examples
    --------
    >>> [name_of_quantity(text) for text in ("K_ap", "tension", "EA", "loss_factor")]
    ['apparent_spring_constant', 'branch_tension', 'apparent_spring_constant', 'loss_factor']
    """
    symbols = {
        SINGLE_QUANTITIES[name].source.split(",")[0].split()[-1].replace("_", ""): name
        for name in _OF_CYCLES
    } | _BY_WORDS
    return symbols.get(text.replace("_", ""), text)


def quantity(name: str) -> Quantity:
    """Return the row of a name; `KeyError` if unknown."""
    return QUANTITIES[name]


TEST_SCHEMA = schema_from(OF_TEST, AXES)
"""All possible variables of a reduced test."""

STEPWISE_SCHEMA = TEST_SCHEMA | schema_from(IN_PLACE_OF_RECORD)
"""The same for a test with weights; some names have the axis ``step`` there."""

SURFACE_SCHEMA = schema_from(_SHARED_ERRORS[:1], OF_EXPERIMENTS, _OF_SURFACES, _NOTES)
"""All possible variables of an archive of experiments."""

PREDICTION_SCHEMA = schema_from(OF_PREDICTIONS, _NOTES)

COMPARISON_SCHEMA = schema_from(OF_COMPARISONS, AXES)

PROPERTY_SCHEMA = schema_from(OF_PROPERTIES, _SHARED_ERRORS)
"""All possible variables of an archive of change-in-length properties."""

OUTCOME_SCHEMA = schema_from(OF_OUTCOMES)

_SHOWN = tuple(row for row in (*OF_TEST, *OF_PREDICTIONS, *OF_COMPARISONS) if row.page[0])

ON_PAGE: dict[str, list[Quantity]] = {
    table: [row for row in _SHOWN if row.page[0] == table]
    for table in dict.fromkeys(row.page[0] for row in _SHOWN)
}
"""Rows by the table of the page that names them."""

"""Implements the command budget."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import xarray as xr
from rich.markup import escape

from reduction.archive.open import reading
from reduction.archive.uncertainty_budget import (
    budget_from_archive,
    parse_place,
    place_name,
    quantities_with_budget,
)
from reduction.archive.variables import stored
from reduction.cli.output import CommandOutput
from reduction.cli.printed_numbers import plain, short, table_of
from reduction.quantities.flags import LINE_METHODS
from reduction.quantities.names import name_of_quantity
from reduction.record.errors import SettingsError
from reduction.stages.three_parameter_line.line_product import LINE_PARAMETERS
from reduction.uncertainty.budget import Budget

# name of a slow-pull curve in a look-up
_OVER_TENSION = {"strain": "quasi_static_strain"}


def list_budgets(path: Path, *, output: CommandOutput) -> None:
    """Print the quantities in PRODUCT that have a budget."""
    with reading(path) as archive:
        names = {name: list(archive[name].dims) for name in quantities_with_budget(archive)}
    if names:
        table = table_of("quantity", "--at", texts=2)
        for name, dims in names.items():
            table.add_row(name, ", ".join(place_name(str(dim)) for dim in dims))
        output.show(table)
    else:
        output.say(
            f"{path.name} has no shared errors, and so no budgets: its uncertainties are of "
            "scatter alone"
        )
    output.answer(
        {"quantities": {name: [str(dim) for dim in dims] for name, dims in names.items()}}
    )


def show_budget(path: Path, quantity: str, places: Sequence[str], *, output: CommandOutput) -> None:
    """Print the budget of one number, largest source first."""
    with reading(path) as archive:
        budget = budget_from_archive(archive, _name_in(archive, quantity), _places(places))
        synthetic = archive.attrs.get("synthetic", "no") == "yes"
        drawn = _drawn_uncertainty(archive, budget)
    unit, scale = output.unit(budget.unit)
    where = ", ".join(
        f"{place_name(dim)} {label}" + _in_brackets(label, budget.words.get(dim, ""))
        for dim, label in budget.place.items()
    )
    table = table_of(
        "source", "item", f"contribution [{unit}]", "share of variance", texts=2,
        title=f"{budget.quantity}, {where}" + (" (synthetic data)" if synthetic else ""),
    )  # fmt: skip
    for row in budget.rows:
        table.add_row(
            row.source, escape(row.of), short(row.contribution * scale, 3), f"{row.share:.1%}"
        )
    output.show(table)
    output.say(
        f"value {short(budget.value * scale)} {unit}, standard uncertainty"
        f" {short(budget.standard_uncertainty * scale, 3)} {unit}"
    )
    output.say(
        f"expanded uncertainty {short(budget.expanded_uncertainty * scale, 3)} {unit} "
        f"(95 %, k = {budget.coverage_factor:.2f})"
    )
    if drawn is not None:
        output.say(
            f"the archive states {short(drawn * scale, 3)} {unit}, by Monte Carlo: this budget is "
            "of first order, which is not accurate here"
        )
    output.answer(_document(budget, synthetic))


def _name_in(archive: xr.Dataset, quantity: str) -> str:
    """Name of a quantity by the rules of a look-up; unchanged if unknown."""
    known = quantities_with_budget(archive)
    over = _OVER_TENSION.get(quantity, quantity)
    return next((one for one in (quantity, over) if one in known), name_of_quantity(quantity))


def _in_brackets(label: str, words: str) -> str:
    if words.startswith(label):
        # the same text with its unit
        return words.removeprefix(label)
    return f" ({words})" if words else ""


def _drawn_uncertainty(archive: xr.Dataset, budget: Budget) -> float | None:
    """Standard uncertainty stored in an archive where linear propagation is inaccurate."""
    method = stored(archive, "test_line_uncertainty_method")
    if method is None or budget.quantity.removeprefix("test_") not in LINE_PARAMETERS:
        return None
    place = archive["specimen"].values.tolist().index(budget.place["specimen"])
    if int(method.values[place]) != LINE_METHODS["monte_carlo"]:
        return None
    return float(archive[f"{budget.quantity}_standard_uncertainty"].values[place])


def _places(texts: Sequence[str]) -> dict[str, str]:
    """``dimension=label`` from each option; strains may have a percent sign, tensions a unit."""
    found = {}
    for text in texts:
        name, sign, label = text.partition("=")
        if not (sign and label.strip()):
            raise SettingsError(
                "--at is not understood", found=repr(text), needed='such as "branch=ascending"'
            )
        found[name.strip()] = parse_place(name, label)
    return found


def _document(budget: Budget, synthetic: bool) -> dict[str, object]:
    return {
        "quantity": budget.quantity,
        "unit": budget.unit,
        "at": budget.place,
        "at_words": {dim: words for dim, words in budget.words.items() if words},
        "value": plain(budget.value),
        "standard_uncertainty": plain(budget.standard_uncertainty),
        "expanded_uncertainty": plain(budget.expanded_uncertainty),
        "coverage_factor": plain(budget.coverage_factor),
        "confidence": 0.95,
        "degrees_of_freedom": plain(budget.degrees_of_freedom),
        "effective_degrees_of_freedom": plain(budget.effective_degrees_of_freedom),
        "sources": [
            {
                "source": row.source,
                "of": row.of,
                "contribution": plain(row.contribution),
                "share": plain(row.share),
            }
            for row in budget.rows
        ],
        "synthetic": synthetic,
    }

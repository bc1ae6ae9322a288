"""Outcomes without a log as the page reads them, and the names of their groups."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from reduction.archive.outcomes import outcomes_of_dataset
from reduction.outcomes.groups import Group
from reduction.outcomes.product import Outcome
from reduction.report.style import shown
from reduction.units import UnitSystem


@dataclass(frozen=True)
class OutcomeView:
    """Outcomes of a campaign, the attributes of their archive, and the units of the page."""

    outcomes: tuple[Outcome, ...]
    attributes: dict[str, str]
    units: UnitSystem = "si"

    @property
    def is_synthetic(self) -> bool:
        """True where no specimen was ever pulled."""
        return self.attribute("synthetic").lower() == "yes"

    @property
    def summary(self) -> str:
        """How many outcomes there are, and what was made of them."""
        uses = Counter[str](one.use for one in self.outcomes)
        listed = [
            f"{uses[use]:,} {words}"
            for use, words in (
                ("value", "used as values"), ("lower_bound", "as lower bounds"),
                ("excluded", "invalid and not used"),
            )
            if uses[use]
        ]  # fmt: skip
        number = len(self.outcomes)
        noun = "outcome" if number == 1 else "outcomes"
        return f"{number:,} {noun} without a log: {', '.join(listed)}"

    def attribute(self, name: str) -> str:
        """Global attribute; empty where there is none."""
        return self.attributes.get(name, "")


def view_outcomes(archive: xr.Dataset, units: UnitSystem) -> OutcomeView:
    """Return what the page needs of an archive of outcomes, which may then be closed."""
    attributes = {str(name): str(value) for name, value in archive.attrs.items()}
    return OutcomeView(outcomes_of_dataset(archive), attributes, units)


def line_of(group: Group) -> Group:
    """Return the line of a group, without condition and exposure."""
    return replace(group, condition="", exposure=None)


def group_names(groups: Sequence[Group], units: UnitSystem) -> list[str]:
    """Return a name of each group: what it is called, and in what it differs from the others.

    Examples
    --------
    >>> new = Group("PD", "polyester", "double braid", 0.0127, "new", 0.0)
    >>> group_names([new, replace(new, condition="worn", exposure=2.0)], "si")
    ['PD, new, 0 years', 'PD, worn, 2 years']
    """
    parts = [_parts(group, units) for group in groups]
    differ = {name for name in parts[0] if len({one[name] for one in parts}) > 1} if parts else ()
    names = []
    for one in parts:
        first = next((name for name in one if one[name]), "")
        names.append(
            ", ".join(text for name, text in one.items() if text and name in {first, *differ})
        )
    return [name or "not named" for name in names]


def _parts(group: Group, units: UnitSystem) -> dict[str, str]:
    small = shown("small length", units)
    diameter, years = group.diameter, group.exposure
    return {
        "line": group.line,
        "material": group.material,
        "construction": group.construction,
        "diameter": "" if diameter is None else f"{diameter * small.factor:.4g} {small.unit}",
        "condition": group.condition,
        "exposure": "" if years is None else f"{years:.4g} year{'' if years == 1 else 's'}",
    }

"""One predicted hose as the page reads it: a row of the archive of predictions, cut to length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import xarray as xr

from reduction.notes import Severity
from reduction.predict.helix import NEUTRAL_ANGLE
from reduction.record import Floats
from reduction.report.rowview import RowView
from reduction.report.style import Shown, shown
from reduction.units import UnitSystem

EVENT_WORDS = {
    "deepest_slack": "cords slackest",
    "pick_up": "cords pick up",
    "working": "working load",
    "cord_break": "cords break",
}
SOURCE_WORDS = {
    "layer_diameter": "diameters of the cord layers",
    "cord_load_scale": "load of the cord curve",
    "cord_strain_scale": "strain of the cord curve",
    "dead_length_share": "share of dead length",
}
"""What a number of a design is called where its name does not say it."""


@dataclass(frozen=True)
class OneEvent:
    """Something that happens to the cords; SI, NaN where an uncertainty is not known."""

    name: str
    strain: float
    tension: float
    fill_pressure: float
    cord_tension: float
    cord_strain: float
    strain_standard_uncertainty: float
    tension_standard_uncertainty: float
    fill_pressure_standard_uncertainty: float

    @property
    def words(self) -> str:
        """What a reader calls it."""
        return EVENT_WORDS.get(self.name, self.name.replace("_", " "))


@dataclass(frozen=True)
class HoseView(RowView):
    """One hose on the page: a row of the archive of predictions."""

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "hose_point": "strain",
        "cord_point": "cord_curve_strain",
        "hose_layer": "hose_layer_name",
    }

    @property
    def name(self) -> str:
        """Name of the hose."""
        return self.text("hose")

    @property
    def wrap_angle(self) -> float:
        """Of the cords at rest, from the axis. [rad]."""
        return self.scalar("wrap_angle")

    @property
    def is_slack_at_first(self) -> bool:
        """True where the cords have to be stretched to length before they carry."""
        return self.wrap_angle > NEUTRAL_ANGLE

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable of this hose, without those of longer hoses."""
        if name not in self.data:
            return ()
        size = self.sizes.get(str(self.data.variables[name].dims[-1]))
        return tuple(str(text) for text in self.data.variables[name].values[self.index][:size])

    @cached_property
    def sources(self) -> tuple[str, ...]:
        """Numbers of this hose of which an uncertainty is stated."""
        if "uncertainty_source" not in self.data:
            return ()
        return tuple(
            name
            for name in self.data.variables["uncertainty_source"].values.astype(str)
            if np.isfinite(self.array(f"{name}_standard_uncertainty")).any()
        )

    def contribution(self, source: str) -> Floats:
        """Change of tension for one standard uncertainty of a source, at each strain. [N]."""
        names = self.data.variables["uncertainty_source"].values.astype(str).tolist()
        return np.asarray(self.array("tension_contribution")[names.index(source)])

    def event_place(self, name: str) -> int:
        """Place of an event in the archive."""
        return int(self.data.variables["hose_event"].values.astype(str).tolist().index(name))

    @cached_property
    def events(self) -> dict[str, OneEvent]:
        """What happens to the cords, by name; the slackest point only where there is one."""
        quantities = [name for name in OneEvent.__dataclass_fields__ if name != "name"]
        strain = self.array("event_strain")
        table = [self.array_like(f"event_{name}", strain) for name in quantities]
        found = {
            name: OneEvent(name, *(float(row[place]) for row in table))
            for place, name in enumerate(self.data.variables["hose_event"].values.astype(str))
        }
        if not self.is_slack_at_first:
            found.pop("deepest_slack")
        return found

    @cached_property
    def notes(self) -> dict[str, Severity]:
        """What is to be said of the hose, with how serious it is."""
        return self.notes_of("note_hose", self.name, stage="predict")

    @property
    def per_length(self) -> Shown:
        """How a number a length is shown."""
        small = shown("small length", self.units)
        return Shown(f"1/{small.unit}", 1 / small.factor)


def view_hoses(archive: xr.Dataset, units: UnitSystem) -> list[HoseView]:
    """Return each hose of an archive of predictions, which may then be closed."""
    data = archive.load()
    return [HoseView(f"hose-{k}", data, k, units) for k in range(data.sizes["hose"])]

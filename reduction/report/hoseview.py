"""One predicted hose as the page reads it: a row of the archive of predictions, cut to length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from reduction.notes import Severity, severity_of
from reduction.predict.cord import NEUTRAL_ANGLE
from reduction.record import Bools, Floats
from reduction.report.style import Shown, shown
from reduction.units import UnitSystem

__all__ = ["DEGREES", "EVENT_WORDS", "SOURCE_WORDS", "HoseView", "OneEvent", "view_hoses"]

DEGREES = Shown("deg", 180 / np.pi)
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
_ENDS_AT = {
    "hose_point": "strain",
    "cord_point": "cord_curve_strain",
    "hose_layer": "hose_layer_name",
}


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
class HoseView:
    """One hose on the page.

    Parameters
    ----------
    key : str
        Prefix of every anchor; made by the page, not from a name.
    data : xarray.Dataset
        The archive of predictions, in memory, strings decoded.
    index : int
        Which hose of it.
    units : UnitSystem
        What a reader is shown.
    """

    key: str
    data: xr.Dataset
    index: int
    units: UnitSystem = "si"

    @property
    def name(self) -> str:
        """Name of the hose."""
        return self.text("hose")

    @property
    def is_synthetic(self) -> bool:
        """True where the campaign says that its numbers are made up."""
        return self.attribute("synthetic").lower() == "yes"

    @property
    def wrap_angle(self) -> float:
        """Of the cords at rest, from the axis. [rad]."""
        return self.scalar("wrap_angle")

    @property
    def is_slack_at_first(self) -> bool:
        """True where the cords have to be stretched to length before they carry."""
        return self.wrap_angle > NEUTRAL_ANGLE

    def attribute(self, name: str) -> str:
        """Global attribute as text; empty where there is none."""
        return str(self.data.attrs.get(name, ""))

    @cached_property
    def sizes(self) -> dict[str, int]:
        """Own length of the dimensions that hoses share."""
        found = {}
        for dim, name in _ENDS_AT.items():
            if name in self.data:
                values = self.data[name].values[self.index]
                is_own = np.isfinite(values) if values.dtype.kind == "f" else values.astype(bool)
                found[dim] = int(np.count_nonzero(is_own))
        return found

    def array(self, name: str) -> Floats:
        """Values of a variable of this hose; of no length where there is none."""
        if name not in self.data:
            return np.full(0, np.nan)
        variable = self.data[name]
        cut = tuple(slice(self.sizes.get(str(dim))) for dim in variable.dims[1:])
        return np.asarray(variable.values[self.index], dtype=np.float64)[cut]

    def array_like(self, name: str, other: Floats) -> Floats:
        """Values of a variable, or NaN in the shape of another."""
        found = self.array(name)
        return found if found.shape == other.shape else np.full(other.shape, np.nan)

    def scalar(self, name: str) -> float:
        """A number of this hose; NaN where there is none."""
        found = self.array(name)
        return float(found) if found.ndim == 0 else float("nan")

    def text(self, name: str) -> str:
        """Value of a text variable without further dimensions; "" where there is none."""
        return str(self.data[name].values[self.index]) if name in self.data else ""

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable of this hose, without those of longer hoses."""
        if name not in self.data:
            return ()
        size = self.sizes.get(str(self.data[name].dims[-1]))
        return tuple(str(text) for text in self.data[name].values[self.index][:size])

    def is_in_state(self, name: str) -> Bools:
        """Return where the hose is slack, broken, jammed or has too small a bore."""
        attributes = self.data["hose_state"].attrs
        masks = np.ravel(attributes["flag_masks"])
        place = str(attributes["flag_meanings"]).split().index(name)
        return np.asarray((self.array("hose_state").astype(np.int64) & int(masks[place])) > 0)

    @cached_property
    def sources(self) -> tuple[str, ...]:
        """Numbers of this hose of which an uncertainty is stated."""
        if "uncertainty_source" not in self.data:
            return ()
        return tuple(
            name
            for name in self.data["uncertainty_source"].values.astype(str)
            if np.isfinite(self.array(f"{name}_standard_uncertainty")).any()
        )

    def contribution(self, source: str) -> Floats:
        """Change of tension for one standard uncertainty of a source, at each strain. [N]."""
        names = self.data["uncertainty_source"].values.astype(str).tolist()
        return np.asarray(self.array("tension_contribution")[names.index(source)])

    @cached_property
    def events(self) -> dict[str, OneEvent]:
        """What happens to the cords, by name; the slackest point only where there is one."""
        quantities = [name for name in OneEvent.__dataclass_fields__ if name != "name"]
        strain = self.array("event_strain")
        table = [self.array_like(f"event_{name}", strain) for name in quantities]
        found = {
            name: OneEvent(name, *(float(row[place]) for row in table))
            for place, name in enumerate(self.data["hose_event"].values.astype(str))
        }
        if not self.is_slack_at_first:
            found.pop("deepest_slack")
        return found

    @cached_property
    def notes(self) -> dict[str, Severity]:
        """What is to be said of the hose, with how serious it is."""
        if "note" not in self.data:
            return {}
        pairs = zip(
            self.data["note_hose"].values.astype(str),
            self.data["note"].values.astype(str),
            strict=True,
        )
        return {
            str(note): severity_of("predict", note) for hose, note in pairs if hose == self.name
        }

    @property
    def per_length(self) -> Shown:
        """How a number a length is shown."""
        small = shown("small length", self.units)
        return Shown(f"1/{small.unit}", 1 / small.factor)


def view_hoses(archive: xr.Dataset, units: UnitSystem) -> list[HoseView]:
    """Return each hose of an archive of predictions, which may then be closed."""
    data = archive.load()
    return [HoseView(f"hose-{k}", data, k, units) for k in range(data.sizes["hose"])]

"""One comparison of a test with a predicted hose as the page reads it, cut to its length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
import xarray as xr

from reduction.archive.stored import stored
from reduction.notes import Severity
from reduction.record import Floats
from reduction.report.hoseview import EVENT_WORDS
from reduction.report.rowview import RowView
from reduction.report.sources import in_order
from reduction.report.style import DEGREES, Shown, shown
from reduction.units import UnitSystem

ShortVerdict = Literal["agrees", "says little", "differs", "not judged"]
_EVENT_WORDS = {**EVENT_WORDS, "break": EVENT_WORDS["cord_break"]}
_NUMBER_WORDS = {
    "cord_load_scale": "scale of the cords' load",
    "cord_strain_scale": "scale of the cords' strain",
}
_IDENTIFIED = {0: False, 1: True}


@dataclass(frozen=True)
class MetEvent:
    """What happens to the cords, on both sides; SI, NaN where the test did not go there."""

    name: str
    strain: float
    tension: float
    measured_tension: float
    tension_difference: float
    tension_difference_standard_uncertainty: float
    measured_strain: float
    strain_difference: float
    strain_difference_standard_uncertainty: float

    @property
    def words(self) -> str:
        """What a reader calls it."""
        return _EVENT_WORDS.get(self.name, self.name.replace("_", " "))


@dataclass(frozen=True)
class FittedNumber:
    """A number of the hose that was fitted, in SI."""

    name: str
    unit: str
    start: float
    value: float
    value_standard_uncertainty: float
    low: float
    high: float
    lower_bound: float
    upper_bound: float
    is_at_bound: bool

    @property
    def words(self) -> str:
        """What a reader calls it."""
        return _NUMBER_WORDS.get(self.name, self.name.replace("_", " "))

    def shown(self, units: UnitSystem) -> Shown:
        """Unit in which it is shown: an angle in degrees, a share in percent."""
        if self.unit == "rad":
            return DEGREES
        if self.unit == "Pa":
            return shown("stress", units)
        return shown("strain", units) if self.name.endswith("_share") else Shown(self.unit, 1.0)


@dataclass(frozen=True)
class ComparisonView(RowView):
    """One comparison on the page: a row of the archive of comparisons."""

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "comparison_point": "strain",
        "comparison_cycle": "comparison_cycle_number",
        "parameter": "parameter_name",
        "parameter_other": "parameter_name",
    }

    @property
    def name(self) -> str:
        """Name of the comparison."""
        return self.text("comparison")

    @property
    def test(self) -> str:
        """Test that is compared."""
        return self.text("comparison_test")

    @property
    def specimen(self) -> str:
        """Specimen of the test."""
        return self.text("comparison_specimen")

    @property
    def hose(self) -> str:
        """Hose that is predicted."""
        return self.text("comparison_hose")

    @property
    def loading(self) -> str:
        """How the test was pulled: static or dynamic."""
        return self.text("comparison_loading")

    @property
    def judged(self) -> str:
        """Curve that the prediction is judged by."""
        return self.text("judged_curve")

    @property
    def verdict(self) -> str:
        """What the comparison says, in words."""
        return self.text("verdict")

    @property
    def short_verdict(self) -> ShortVerdict:
        """The verdict in a word: agreement within a wide band says little."""
        if not np.isfinite(self.scalar("largest_ratio")):
            return "not judged"
        if not self.is_flag("agrees"):
            return "differs"
        return "agrees" if self.is_flag("is_informative") else "says little"

    @property
    def is_identified(self) -> bool | None:
        """Whether the curve tells the fitted numbers apart; None where none was to be fitted."""
        if "is_identified" not in self.data:
            return None
        return _IDENTIFIED.get(int(self.data.variables["is_identified"].values[self.index]))

    def curve_place(self, curve: str) -> int:
        """Place of a curve of the test in the archive."""
        return int(self.data.variables["curve"].values.astype(str).tolist().index(curve))

    def of_curve(self, name: str, curve: str) -> Floats:
        """Values of a variable for one curve of the test: a number, or along the strains."""
        return np.asarray(self.array(name)[self.curve_place(curve)])

    def judged_scalar(self, name: str) -> float:
        """A number of the judged curve."""
        return float(self.of_curve(name, self.judged))

    def is_flag(self, name: str) -> bool:
        """Return whether a flag of no and yes says yes."""
        return self.scalar(name) == 1

    @property
    def curves(self) -> tuple[str, ...]:
        """Curves of the test that are there."""
        return tuple(
            name
            for name in self.data.variables["curve"].values.astype(str).tolist()
            if np.isfinite(self.of_curve("measured_tension", name)).any()
        )

    @property
    def difference(self) -> Floats:
        """Predicted less measured tension at the judged curve. [N]."""
        return self.of_curve("tension_difference", self.judged)

    @property
    def shared_sources(self) -> list[str]:
        """Sources of what all samples of the test share, in fixed order."""
        rows = stored(self.data, "measured_tension_uncertainty_contribution")
        if rows is None:
            return []
        own = np.nan_to_num(rows.values[:, self.index]).reshape(rows.shape[0], -1)
        names = self.data.variables["uncertainty_source"].values.astype(str)
        return in_order(set(names[(own != 0).any(axis=1)].tolist()))

    @property
    def allowed(self) -> Floats:
        """What the difference may be at each strain: U, to both sides. [N]."""
        return np.asarray(self.scalar("coverage_factor") * self.array("validation_uncertainty"))

    @property
    def calibrated_difference(self) -> Floats:
        """Calibrated less measured tension at the judged curve; NaN without a calibration. [N]."""
        measured = self.of_curve("measured_tension", self.judged)
        return np.asarray(self.array_like("calibrated_tension", measured) - measured)

    @cached_property
    def events(self) -> tuple[MetEvent, ...]:
        """What happens to the cords, in the order of strain."""
        names = self.data.variables["hose_event"].values.astype(str)
        fields = [name for name in MetEvent.__dataclass_fields__ if name != "name"]
        table = [self.array_like(f"event_{name}", np.zeros(names.size)) for name in fields]
        return tuple(
            MetEvent(str(name), *(float(row[place]) for row in table))
            for place, name in enumerate(names)
        )

    @cached_property
    def fitted(self) -> tuple[FittedNumber, ...]:
        """Numbers of the hose that were fitted; none without a calibration."""
        if "parameter_name" not in self.data:
            return ()
        names, units = (
            self.data.variables[f"parameter_{one}"].values[self.index].astype(str)
            for one in ("name", "unit")
        )
        fields = (
            "start", "value", "value_standard_uncertainty", "low", "high", "lower_bound",
            "upper_bound",
        )  # fmt: skip
        table = {name: self.array(f"parameter_{name}") for name in fields}
        is_at_bound = self.array("parameter_is_at_bound")
        return tuple(
            FittedNumber(
                name=str(names[place]),
                unit=str(units[place]),
                is_at_bound=bool(is_at_bound[place] == 1),
                **{name: float(row[place]) for name, row in table.items()},
            )
            for place in range(self.sizes["parameter"])
        )

    @cached_property
    def notes(self) -> dict[str, Severity]:
        """What is to be said of the comparison, with how serious it is."""
        return self.notes_of("note_comparison", self.name, stage="compare")


def view_comparisons(archive: xr.Dataset, units: UnitSystem) -> list[ComparisonView]:
    """Return each comparison of an archive of them, which may then be closed."""
    data = archive.load()
    return [
        ComparisonView(f"comparison-{k}", data, k, units) for k in range(data.sizes["comparison"])
    ]

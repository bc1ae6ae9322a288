"""One reduced test as the page reads it: an archive, and what status.csv says about it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from reduction.archive.kept import stored_cycles
from reduction.record import Floats, Integers
from reduction.units import UnitSystem

OF_NO_TEST = "of_no_test"
"""Status of an archive that status.csv has no row for: the campaign has no such test now."""
_REACHED = ("mean_tension", "tension_amplitude", "mean_strain", "strain_amplitude")


@dataclass(frozen=True)
class Status:
    """One row of status.csv."""

    test: str
    status: str
    message: str = ""
    exit_status: str = ""
    raw_sha256: str = ""
    seconds: str = ""


@dataclass(frozen=True)
class TestView:
    """One test on the page; a variable that the archive lacks is None.

    Parameters
    ----------
    key : str
        Prefix of every anchor of the test; made by the page, not from a name.
    data : xarray.Dataset
        The archive, strings decoded.
    units : UnitSystem
        What a reader is shown.
    status : Status or None
        Row of status.csv, where there is one.
    """

    __test__ = False  # a test of a tether, not of this software

    key: str
    data: xr.Dataset
    units: UnitSystem = "si"
    status: Status | None = None

    @property
    def id(self) -> str:
        """Name of the test."""
        return self.attribute("test")

    @property
    def is_of_earlier_run(self) -> bool:
        """True where the last run of the campaign did not make this archive or let it stand."""
        return self.status is not None and self.status.status in ("failed", OF_NO_TEST)

    @property
    def kind(self) -> str:
        """Kind of the test: cyclic, fatigue, relaxation, stepwise, ..."""
        return self.attribute("test_kind")

    @property
    def is_synthetic(self) -> bool:
        """True where no specimen was ever pulled."""
        return self.attribute("synthetic").lower() == "yes"

    @property
    def is_stepwise(self) -> bool:
        """True for weights hung one after another; there is no record then."""
        return "step" in self.data.sizes

    @property
    def specimens(self) -> tuple[str, ...]:
        """Names of the specimens."""
        return self.texts("specimen")

    @property
    def is_rope(self) -> bool:
        """True where every specimen is a rope or a wire."""
        kinds = self.texts("specimen_kind")
        return bool(kinds) and set(kinds) <= {"rope", "wire"}

    @property
    def is_rubber(self) -> bool:
        """False where cords, fibres or wires carry in every specimen."""
        kinds = self.texts("specimen_kind")
        return not kinds or not set(kinds) <= {"rope", "wire", "stretch hose"}

    @property
    def n_cycles(self) -> int:
        """Number of whole cycles."""
        return int(self.data.sizes.get("cycle", 0))

    @property
    def start_time(self) -> float:
        """First time of the record in seconds; infinite where there is none."""
        time = self.array("time")
        known = np.zeros(0) if time is None else time[np.isfinite(time)]
        return float(known[0]) if known.size else float("inf")

    @property
    def is_whole(self) -> bool:
        """False where samples of some cycles alone are stored."""
        return "sample_index" not in self.data

    @property
    def pieces(self) -> Integers:
        """Piece of the record that each stored sample is in: between two, cycles are left out."""
        index, first = self.array("sample_index"), self.array("cycle_first_sample")
        last = self.array("cycle_last_sample")
        if index is None or first is None or last is None:
            return np.zeros(int(self.data.sizes.get("sample", 0)), dtype=np.int64)
        # cycles from one sample to the next: neighbours share the sample at which one turns
        begun = np.searchsorted(first, index[:-1], side="left")
        ended = np.searchsorted(last, index[1:], side="right")
        return np.concatenate([[0], np.cumsum(ended > begun)])

    def stored_near(self, cycles: Floats) -> Floats:
        """Numbers of cycles, each once; where samples of some alone are stored, the nearest."""
        stored = np.zeros(0) if self.is_whole else stored_cycles(self.data)
        if not stored.size:
            return np.unique(cycles)
        return np.unique(stored[np.abs(stored[:, None] - cycles).argmin(axis=0)])

    def attribute(self, name: str) -> str:
        """Global attribute as text; empty where there is none."""
        return str(self.data.attrs.get(name, ""))

    def array(self, name: str) -> Floats | None:
        """Values of a variable; missing flags and counts keep their numbers."""
        if name not in self.data:
            return None
        return np.asarray(self.data.variables[name].values, dtype=np.float64)

    def array_like(self, name: str, other: Floats) -> Floats:
        """Values of a variable, or NaN in the shape of another."""
        found = self.array(name)
        return np.full(other.shape, np.nan) if found is None else found

    def scalar(self, name: str) -> float:
        """Value of a variable without dimensions; NaN where there is none."""
        found = self.array(name)
        return float("nan") if found is None else float(found)

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable; empty where there is none."""
        if name not in self.data:
            return ()
        return tuple(str(value) for value in np.ravel(self.data.variables[name].values))

    @property
    def hold_numbers(self) -> tuple[int, ...]:
        """Number of each hold in time, from 1: specimens that stand still together share one."""
        number = self.array("hold_number")
        return () if number is None else tuple(int(value) for value in number)

    def text(self, name: str) -> str:
        """Value of a text variable without dimensions."""
        return " ".join(self.texts(name))

    def flag_meanings(self, name: str) -> dict[str, int]:
        """Meaning to mask or value of a flag variable, as the archive declares them."""
        attributes = self.data.variables[name].attrs
        numbers = attributes.get("flag_masks", attributes.get("flag_values", ()))
        words = str(attributes.get("flag_meanings", "")).split()
        return {word: int(number) for word, number in zip(words, np.ravel(numbers), strict=True)}

    def without_samples(self) -> TestView:
        """Return the same test without its record, all in memory: what campaign figures use.

        Of single cycles only what the cycles of a test reach together is found from is left.
        """
        data = self.data.drop_dims("sample", errors="ignore")
        single = [
            name
            for name in data.data_vars
            if "cycle" in data.variables[name].dims and name not in _REACHED
        ]
        return replace(self, data=data.drop_vars(single).load())

    def at_cycles(self, places: Integers) -> TestView:
        """Return the same test with some of its cycles, counted from 0 and in order."""
        if len(places) == self.data.sizes["cycle"]:
            return self
        return replace(self, data=self.data.isel(cycle=places))


def all_specimens(tests: Sequence[TestView]) -> list[str]:
    """Return the specimens of several tests, each once, in the order they first appear."""
    return list(dict.fromkeys(name for view in tests for name in view.specimens))


def any_synthetic(tests: Sequence[TestView]) -> bool:
    """Return whether a figure or table of these tests has to say that data are synthetic."""
    return any(view.is_synthetic for view in tests)


def natural_order(name: str) -> tuple[tuple[int, int, str], ...]:
    """Sort key that puts T-10 after T-2.

    Examples
    --------
    >>> sorted(["T-10", "T-2", "hold"], key=natural_order)
    ['hold', 'T-2', 'T-10']
    """
    return tuple(
        (0, int(part), "") if part.isdigit() else (1, 0, part.lower())
        for part in re.split(r"(\d+)", name)
        if part
    )

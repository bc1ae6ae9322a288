"""What a variable of an archive is: name, dimensions, type, flags, uncertainty."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from reduction.quantities.names import QUANTITIES
from reduction.record.errors import ArchiveError
from reduction.record.measurement import Floats
from reduction.record.note_sentences import Severity
from reduction.record.notes import Note

READING = "a reading: its uncertainty is that of the channel"

CLOCK = "a reading of the clock"

BOUND = "bound"

SETTING = "setting"

STATED = "stated by the laboratory"

STRENGTH = "as stated; what is stated of its error is in the numbers that are shares of it"

AXIS = "axis of the curve"

CHECK = "residual of a check"

CRITERION = "criterion of a fit"

STATISTIC = "a statistic of a test"

SPREAD = "is itself a measure of spread"

OF_UNCERTAINTY = "degrees of freedom of an uncertainty"

PART = "is part of an uncertainty"

MOVEMENT = "what the machine did; no number is made from it"

OF_MARKS = "a reading at the marks: what they are known to is in the coefficients fitted to them"

WHERE_IT_STOOD = "tells standstills apart; what a hold gives has its uncertainty with the hold"

TWO_METHODS = "two methods on the same marks: what they get wrong they share"

SEE_PER_DECADE = "from a part of the cycles; peak_tension_per_decade has one, from all of them"

NO_YES = {"no": 0, "yes": 1}
"""Meanings of a flag that answers a question."""

Values = dict[str, NDArray[Any]]
"""Name of the schema to array; dimensions and attributes are the schema's business."""


def texts(items: Sequence[str]) -> NDArray[np.str_]:
    """Return labels as an array; an empty sequence stays an array of text."""
    return np.array(list(items), dtype=np.str_)


def numbers(items: Sequence[float | None]) -> Floats:
    """Return numbers as float64, NaN for None."""
    return np.array([np.nan if item is None else item for item in items], dtype=np.float64)


def pad(rows: Sequence[ArrayLike]) -> Floats:
    """Put ragged rows under each other, NaN where a row is shorter."""
    arrays = [np.atleast_1d(np.asarray(row, dtype=np.float64)) for row in rows]
    table = np.full((len(arrays), max((row.size for row in arrays), default=0)), np.nan)
    for line, row in zip(table, arrays, strict=True):
        line[: row.size] = row
    return table


def pad_texts(rows: Sequence[Sequence[str]]) -> NDArray[np.str_]:
    """Put ragged rows of labels under each other, "" where a row is shorter."""
    length = max((len(row) for row in rows), default=0)
    return np.array([[*row, *[""] * (length - len(row))] for row in rows], dtype=np.str_)


TEXT = "U"

SUFFIXES = {
    "_random_standard_uncertainty": (
        "random part (k=1) of the standard uncertainty of {}",
        "f8",
        "is an uncertainty",
    ),
    "_uncertainty_contribution": (
        "signed contribution of one standard uncertainty of each shared error to {}",
        "f8",
        "is part of an uncertainty",
    ),
    "_standard_uncertainty": ("standard uncertainty (k=1) of {}", "f8", "is an uncertainty"),
    "_count": ("number of cycles in the mean: {}", "i4", "count"),
    "_minimum": ("least over the cycles: {}", "f8", "bound: least value seen"),
    "_maximum": ("greatest over the cycles: {}", "f8", "bound: greatest value seen"),
    "_scatter": ("standard deviation over the cycles: {}", "f8", "is itself a measure of spread"),
}
"""Suffix: its long name, type, and why it has no uncertainty of its own."""


GROUPS = {
    "specimens": "specimens: readings of the diameter, and what they went through before",
    "record": "rows of the log, the lag between its channels, and where the test stood still",
    "splice": "how position became strain: method, coefficients, tape readings",
    "cycles": "cycles one by one, means over them, trends and slips",
    "curves": "tangent modulus of each cycle, and with the ends of the branches",
    "first_loading": "tangent modulus and tension of the first loading",
    "segments": "piecewise-linear moduli",
    "rubber": "stress at stated strains, slack strain, hyperelastic laws",
    "line": "the three-parameter line, and slow pulls",
    "programme": "steps of a rope laboratory's programme",
    "holds": "relaxation and creep",
    "comparisons": "specimens of the test against each other",
    "coefficients": "coefficients in other units, with their tests; subsets of terms",
    "quality": "how well each surface fits",
    "anova": "analysis of variance",
    "stationary_point": "stationary point and principal directions of each surface",
    "runs": "runs: levels, measured, fitted, residuals",
    "points": "values of the surfaces at points and along ridges",
    "blocks": "effects of blocks",
    "screening": "effects of a screening, and what they are confounded with",
    "stiffness": "dynamic stiffness in the forms of mooring codes",
    "single_time": "whether one relaxation time holds over frequency",
    "design": "the hose: angles, diameters, cords, rubber",
    "cords": "cords: load against strain, angle and spacing along the curve",
    "layers": "helical layers that go along with the hose",
    "events": "slack, pick-up, working load and break",
    "energy": "energies of the measured and the predicted curve",
    "statistics": "statistics behind the verdict",
    "fit": "numbers that were fitted to the measured curve",
    "uncertainty": "random parts of uncertainties, and contributions of errors that numbers share",
    "notes": "what to know before the numbers are used",
}
"""Groups of archives and what they hold; the root holds what somebody looks for."""

_PARTS = ("_random_standard_uncertainty", "_uncertainty_contribution")


@dataclass(frozen=True)
class Variable:
    """One variable of an archive.

    Parameters
    ----------
    name : str
        A name of the vocabulary, with or without one of `SUFFIXES`.
    dims : tuple of str
        In order; empty for a scalar.
    dtype : str
        ``f8``, ``i4``, ``i1``, ``u2`` or `TEXT`.
    no_uncertainty : str
        Why there is no standard uncertainty; empty where there is one.
    ancillary : tuple of str
        Names of the variables that qualify this one, where they are present.
    flags : dict of str to int
        Meaning to value, or to mask where ``is_mask``.
    bounds : str
        Name of the variable with the edges of the cells.
    group : str
        One of `GROUPS`; empty in the root.
    """

    name: str
    dims: tuple[str, ...]
    dtype: str
    no_uncertainty: str = ""
    ancillary: tuple[str, ...] = ()
    flags: dict[str, int] = field(default_factory=dict)
    is_mask: bool = False
    bounds: str = ""
    group: str = ""

    def __post_init__(self) -> None:
        """Refuse a name that the vocabulary lacks."""
        if self._base not in QUANTITIES:
            raise ArchiveError(
                f"'{self.name}' has no row in the vocabulary",
                needed="a quantity of reduction.quantities.names",
                hint="Add its row there, with unit and meaning.",
            )

    @property
    def _suffix(self) -> str:
        if self.name in QUANTITIES:
            return ""
        return next((suffix for suffix in SUFFIXES if self.name.endswith(suffix)), "")

    @property
    def _base(self) -> str:
        return self.name.removesuffix(self._suffix)

    @property
    def is_text(self) -> bool:
        """True for labels."""
        return self.dtype == TEXT

    @property
    def is_bounds(self) -> bool:
        """True for the edges of cells, which take their attributes from the centres."""
        return "bound" in self.dims

    @property
    def has_uncertainty(self) -> bool:
        """True where a standard uncertainty belongs to the variable."""
        return f"{self.name}_standard_uncertainty" in self.ancillary

    @property
    def unit(self) -> str:
        """CF unit; empty for labels."""
        return "1" if self._suffix == "_count" else QUANTITIES[self._base].unit

    @property
    def long_name(self) -> str:
        """What it means, in words."""
        words = QUANTITIES[self._base].long_name
        return SUFFIXES[self._suffix][0].format(words) if self._suffix else words

    @property
    def standard_name(self) -> str | None:
        """CF standard name, where the table has one."""
        return None if self._suffix else QUANTITIES[self._base].standard_name


def in_group(group: str, *rows: Variable | Iterable[Variable]) -> Iterator[Variable]:
    """Put variables into a group of the archive."""
    for one in rows:
        for row in [one] if isinstance(one, Variable) else one:
            yield replace(row, group=group)


def schema_from(rows: Iterable[Variable]) -> dict[str, Variable]:
    """Return variables by name; parts of uncertainties stand in a group of their own."""
    return {
        row.name: replace(row, group="uncertainty") if row.name.endswith(_PARTS) else row
        for row in rows
    }


def measured(
    name: str,
    dims: tuple[str, ...],
    *suffixes: str,
    uncertainty_dims: tuple[str, ...] | None = None,
    ancillary: tuple[str, ...] = (),
) -> list[Variable]:
    """Return a real with its standard uncertainty and other companions."""
    companions = ["_standard_uncertainty", *suffixes]
    rows = [
        Variable(
            name,
            dims,
            "f8",
            ancillary=(*(f"{name}{suffix}" for suffix in companions), *ancillary),
        )
    ]
    for suffix in companions:
        own_dims = dims
        if suffix == "_standard_uncertainty" and uncertainty_dims is not None:
            own_dims = uncertainty_dims
        rows.append(companion(name, suffix, own_dims))
    return rows


def companion(name: str, suffix: str, dims: tuple[str, ...]) -> Variable:
    """Return what qualifies a quantity: one of `SUFFIXES`."""
    return Variable(f"{name}{suffix}", dims, SUFFIXES[suffix][1], SUFFIXES[suffix][2])


def stated(
    name: str,
    dims: tuple[str, ...],
    no_uncertainty: str,
    *,
    ancillary: tuple[str, ...] = (),
    bounds: str = "",
) -> list[Variable]:
    """Return a real without a standard uncertainty, and the reason."""
    return [Variable(name, dims, "f8", no_uncertainty, ancillary=ancillary, bounds=bounds)]


def count(name: str, dims: tuple[str, ...]) -> list[Variable]:
    """Return a number that is counted."""
    return [Variable(name, dims, "i4", "count")]


def label(name: str, dims: tuple[str, ...] = ()) -> list[Variable]:
    """Return a text."""
    return [Variable(name, dims, TEXT, "label")]


def flag(name: str, dims: tuple[str, ...], values: dict[str, int]) -> list[Variable]:
    """Return a flag with one meaning a value."""
    return [Variable(name, dims, "i1", "flag", flags=values)]


def mask(name: str, dims: tuple[str, ...], masks: dict[str, int]) -> list[Variable]:
    """Return a flag in which each bit has a meaning."""
    return [Variable(name, dims, "u2", "flag", flags=masks, is_mask=True)]


def stored(dataset: xr.Dataset, name: str) -> xr.Variable | None:
    """Give a variable of an archive, or nothing.

    Examples
    --------
    >>> stored(xr.Dataset({"strain": 1.5}), "tension") is None
    True
    """
    return dataset.variables[name] if name in dataset else None


NOTE_ROWS: tuple[Variable, ...] = tuple(
    in_group(
        "notes",
        *(label(name, ("note",)) for name in ("note", "note_stage", "note_code", "note_severity")),
    )
)
"""What each note says, which stage gave it, its code, and how serious it is."""


def note_values(notes: Sequence[Note]) -> Values:
    """Return notes as variables, in their order."""
    return {
        "note": texts([str(one) for one in notes]),
        "note_stage": texts([one.stage for one in notes]),
        "note_code": texts([one.code for one in notes]),
        "note_severity": texts([one.severity for one in notes]),
    }


def read_notes(archive: xr.Dataset, *, of: tuple[str, str] | None = None) -> tuple[Note, ...]:
    """Return the notes of an archive, or those where a variable has one value; none twice."""
    if "note" not in archive:
        return ()
    columns = [archive.variables[row.name].values.astype(str).tolist() for row in NOTE_ROWS]
    rows = zip(*columns, strict=True)
    owners = archive.variables[of[0]].values.astype(str) if of else columns[0]
    found = (
        Note(code, cast("Severity", severity), stage=stage, text=text)
        for (text, stage, code, severity), owner in zip(rows, owners, strict=True)
        if of is None or owner == of[1]
    )
    return tuple(dict.fromkeys(found))

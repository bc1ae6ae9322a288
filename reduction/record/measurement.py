"""Specimens, splice marks, records with quality flags, and where they came from.

This module uses no clock and no files: `reduction.readers` computes the hashes, and the command
line supplies times.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntFlag
from math import pi
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from reduction.record.errors import DataError
from reduction.record.notes import Note

_T = TypeVar("_T")

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall. [m s-2]"""

Floats = NDArray[np.float64]

Integers = NDArray[np.integer[Any]]

Bools = NDArray[np.bool_]


class Quality(IntFlag):
    """Masks of `quality_flag`: defects of a sample.  Nothing is deleted.

    The order is that of the contract; the values are powers of two and never change.
    """

    MISSING = 1
    GAP = 2
    REPEATED_OR_BACKWARD_TIME = 4
    SATURATED = 8
    STUCK = 16
    SPIKE = 32
    OUTSIDE_VERIFIED_RANGE = 64
    NOT_CONSTANT_RATE = 128
    RESAMPLED = 256
    EXTRAPOLATED = 512


# same width as the flags, so that expressions with them are not widened
UNUSABLE = np.uint16(Quality.MISSING | Quality.SATURATED | Quality.STUCK | Quality.SPIKE)
"""Flags of samples that no result may use."""


def read_only_arrays(cls: type[_T]) -> type[_T]:
    """Make every array of an instance read-only on creation, before its own checks."""
    check: Callable[[Any], None] | None = cls.__dict__.get("__post_init__")

    def freeze_and_check(self: Any) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
        if check is not None:
            check(self)

    cls.__post_init__ = freeze_and_check  # type: ignore[attr-defined]
    return cls


def require_shapes(product: object, shapes: Mapping[str, tuple[int, ...]], *, of: str) -> None:
    """Raise `DataError` if an array of a product does not have the required shape."""
    for name, shape in shapes.items():
        found = getattr(product, name).shape
        if found != shape:
            raise DataError(f"{name} does not fit the {of}", found=str(found), needed=str(shape))


@dataclass(frozen=True)
class Specimen:
    """One tether, hose or rope in its state before the test.

    Parameters
    ----------
    name : str
        Key of the specimen in the campaign.
    kind : str
        ``rubber tether``, ``stretch hose``, ``rope``, ``wire``, ``elastomer`` or ``other``.
    diameter : tuple of float
        Readings before stretch; the nominal area uses their mean. Empty if no diameter is known.
        [m]
    cross_section : tuple of float
        Readings of the area before stretch, for specimens without a diameter. [m2]
    stretched_diameters : tuple of (float, float)
        Pairs (strain, diameter) read on the stretched specimen, for the
        constant-volume check. [1], [m]
    rated_break_strength : float or None
        Stated strength of the specimen. [N]
    linear_density, wet_linear_density : float or None
        Mass per length in air, and minus the displaced water, if stated; the wet one is negative
        for a floating specimen. [kg m-1]
    gauge_length : float or None
        Distance between gauge marks at zero strain, if marked. [m]
    gauge_length_standard_uncertainty : float or None
        Standard uncertainty of the gauge length, if stated. [m]
    reference_tension : float or None
        Tension at which the gauge length was read, if not slack. [N]
    earlier_cycles, earlier_flex_cycles : int or None
        Tension cycles and flexing cycles before the first test of the campaign. [1]
    material, condition, construction : str
        Wording of the laboratory; empty if not given.
    """

    name: str
    kind: str = "rubber tether"
    material: str = ""
    condition: str = ""
    diameter: tuple[float, ...] = ()
    stretched_diameters: tuple[tuple[float, float], ...] = ()
    rated_break_strength: float | None = None
    rated_break_strength_source: str = ""
    gauge_length: float | None = None
    notes: tuple[str, ...] = ()
    construction: str = ""
    gauge_length_standard_uncertainty: float | None = None
    earlier_cycles: int | None = None
    earlier_flex_cycles: int | None = None
    reference_tension: float | None = None
    linear_density: float | None = None
    wet_linear_density: float | None = None
    cross_section: tuple[float, ...] = ()

    @property
    def has_area(self) -> bool:
        """Whether an area before stretch is known."""
        return bool(self.diameter or self.cross_section)

    @property
    def mean_diameter(self) -> float:
        """Mean of the diameter readings before stretch. [m]."""
        if not self.diameter:
            raise DataError(
                f"specimen '{self.name}' has no diameter",
                needed="at least one diameter reading before stretch",
                hint=f"Give specimens.{self.name}.diameter in campaign.toml, or its area, or width "
                "and thickness, or linear_density and density.",
            )
        return float(np.mean(self.diameter))

    @property
    def diameter_scatter(self) -> float:
        """Standard uncertainty of the mean diameter from its readings; NaN for one reading. [m]."""
        return _scatter_of_mean(self.diameter)

    @property
    def area(self) -> float:
        """Cross-sectional area at zero tension (from a diameter by WHOI-2005-10, eq. 2). [m2]."""
        if self.cross_section:
            return float(np.mean(self.cross_section))
        return pi * self.mean_diameter**2 / 4

    @property
    def area_scatter(self) -> float:
        """Standard uncertainty of the area from its readings; NaN for a single one. [m2]."""
        if self.cross_section:
            return _scatter_of_mean(self.cross_section)
        return 2 * self.area * self.diameter_scatter / self.mean_diameter

    @property
    def is_rubber(self) -> bool:
        """Whether rubber laws apply: not if cords, fibres or wires carry the load."""
        return self.kind in ("rubber tether", "elastomer")

    @property
    def can_push(self) -> bool:
        """Whether it may be in compression, which no line can be; it is then never slack."""
        return self.kind == "other"

    @property
    def is_rope(self) -> bool:
        """Whether a rope test programme applies."""
        return self.kind in ("rope", "wire")


def _scatter_of_mean(readings: tuple[float, ...]) -> float:
    if len(readings) < 2:
        return float("nan")
    return float(np.std(readings, ddof=1) / np.sqrt(len(readings)))


def areas_of(specimens: tuple[Specimen, ...]) -> Floats:
    """Cross-sectional area of each specimen, NaN if unknown; an error for rubber. [m2].

    A rope or a hose is described by spring constants, which need no area; rubber without an area is
    refused.
    """
    return np.array([one.area if one.has_area or one.is_rubber else np.nan for one in specimens])


@dataclass(frozen=True)
class MarkPlace:
    """Source of the far-thimble reading of a mark: file, row from 1, and column by its header."""

    file: str
    row: int
    column: str


@dataclass(frozen=True)
@read_only_arrays
class SpliceMarks:
    """Tape readings at the splice toes of one specimen, one row per reading.

    ``near_toe``, ``far_toe`` and ``far_thimble`` are read from the near thimble.

    Parameters
    ----------
    specimen : str
        Name of the specimen.
    test : tuple of str, length n_marks
        Test in which each row was read.
    hold : tuple of str, length n_marks
        ``slack``, ``min``, ``centre``, ``max`` or a strain as text, followed by `` down`` if the
        hold was approached from above.
    near_toe, far_toe, far_thimble : ndarray, shape (n_marks,)
        Positions of the toes and of the far thimble. [m]
    reading_uncertainty : float
        Standard uncertainty of one tape reading. [m]
    is_reading_stated : bool
        Whether the campaign states it; otherwise it is that of the last digit.
    splice_creep : float
        Creep of the splices from the time of a cycle to that of a mark, relative to their
        extension; a standard uncertainty. The default is a judgement: no measurement is known. [1]
    is_creep_stated : bool
        Whether the campaign states it.
    place : tuple of MarkPlace, length n_marks or 0
        Source of each row; empty if the rows come from no file.
    """

    specimen: str
    test: tuple[str, ...]
    hold: tuple[str, ...]
    near_toe: Floats
    far_toe: Floats
    far_thimble: Floats
    reading_uncertainty: float = 0.0
    is_reading_stated: bool = False
    splice_creep: float = 0.02
    is_creep_stated: bool = False
    place: tuple[MarkPlace, ...] = ()

    def __post_init__(self) -> None:
        """Check that each row has 0 < near toe < far toe < far thimble."""
        ordered = (
            (self.near_toe > 0) & (self.near_toe < self.far_toe) & (self.far_toe < self.far_thimble)
        )
        if not np.all(ordered):
            bad = int(np.flatnonzero(~ordered)[0])
            raise DataError(
                f"{int(np.sum(~ordered))} of {ordered.size} mark rows of '{self.specimen}' "
                f"contradict themselves, first test {self.test[bad]}, hold {self.hold[bad]}",
                found=f"near toe {self.near_toe[bad]:g} m, far toe {self.far_toe[bad]:g} m, "
                f"far thimble {self.far_thimble[bad]:g} m",
                needed="0 < near toe < far toe < far thimble",
                hint="Correct the row in the marks file.",
            )

    @property
    def free_length(self) -> Floats:
        """Length between the splice toes, shape (n_marks,). [m]."""
        return self.far_toe - self.near_toe

    @property
    def splice_length(self) -> Floats:
        """Total length of both splices, shape (n_marks,). [m]."""
        return self.far_thimble - self.free_length

    @property
    def is_slack(self) -> Bools:
        """Rows read on the slack specimen, shape (n_marks,)."""
        return np.array([hold == "slack" for hold in self.hold], dtype=bool)

    @property
    def is_unloading(self) -> Bools:
        """Rows read on the way down, shape (n_marks,)."""
        return np.array([hold.endswith(" down") for hold in self.hold], dtype=bool)


@dataclass(frozen=True)
class LoadTrain:
    """Parts between a specimen, the load cell and the crosshead's scale; None if not stated.

    Parameters
    ----------
    load_cell_at : {"fixed", "moving"} or None
        End of the specimen with the load cell.
    attached_mass : float or None
        Mass between the specimen and a load cell at its moving end. [kg]
    machine_compliance : float or None
        Compliance of frame, load cell and grips, not seen by the crosshead's scale. [m N-1]
    vertical : bool
        Whether the specimen hangs, and does not sag.
    end_mass : tuple of float, length n_specimens
        Mass whose inertia has been removed from the tension; empty if none has been. [kg]
    end_mass_by_density : tuple of float, length n_specimens
        Length by which the linear density contributes to that mass. [m]
    force_left_at_turns : tuple of float, length n_specimens
        Inertia at the turns lost by the smoothing window of the acceleration. [N]
    """

    load_cell_at: Literal["fixed", "moving"] | None = None
    attached_mass: float | None = None
    machine_compliance: float | None = None
    vertical: bool = False
    end_mass: tuple[float, ...] = ()
    end_mass_by_density: tuple[float, ...] = ()
    force_left_at_turns: tuple[float, ...] = ()


@dataclass(frozen=True)
@read_only_arrays
class Record:
    """One test in SI, with every row of the log kept.

    A missing sample is NaN and carries a flag.  Position and tension are as logged: a flagged
    sample (a spike, a stuck or saturated channel) keeps its value here, and
    `reduction.pipeline.located_test` passes on a copy without the unusable samples.

    Parameters
    ----------
    test_id : str
        Key of the test in the campaign.
    specimens : tuple of str, length n_specimens
        Names, in the order of the first axis of ``tension``.
    time : ndarray, shape (n_samples,)
        Elapsed time as logged. [s]
    crosshead_position : ndarray, shape (n_samples,)
        Thimble-to-thimble length, or a displacement if ``position_is_length`` is false; as logged,
        including flagged samples. [m]
    tension : ndarray, shape (n_specimens, n_samples)
        Values as logged, including flagged samples, with sign and zero applied. [N]
    quality_flag : ndarray of uint16, shape (n_specimens, n_samples)
        Masks of `Quality` for tension.
    crosshead_position_quality_flag : ndarray of uint16, shape (n_samples,)
        Masks of `Quality` for time and position.
    measured_strain : ndarray, shape (n_specimens, n_samples), optional
        Strain from an extensometer, if there is one. [1]
    fill_pressure : ndarray, shape (n_specimens, n_samples), optional
        Pressure in the bore of a hose above the pressure outside, if logged. [Pa]
    cycle_counter : ndarray of int, shape (n_samples,), optional
        Cycle count of the machine.
    n_rows_read : int
        Data rows in the file or files.
    tension_standard_uncertainty : tuple of float, length n_specimens
        Value declared in the layout; NaN if not declared. [N]
    position_standard_uncertainty : float
        Value declared in the layout; NaN if not declared. [m]
    fill_pressure_standard_uncertainty : tuple of float, length n_specimens or 0
        Value declared in the layout; NaN if not declared. [Pa]
    metadata : dict of str to str
        Preamble rows of the file, unchanged.
    notes : tuple of Note
        Notes for the user of the product.
    load_train : LoadTrain
        Load train stated by the layout.
    """

    test_id: str
    specimens: tuple[str, ...]
    time: Floats
    crosshead_position: Floats
    tension: Floats
    quality_flag: NDArray[np.uint16]
    crosshead_position_quality_flag: NDArray[np.uint16]
    measured_strain: Floats | None = None
    fill_pressure: Floats | None = None
    cycle_counter: Integers | None = None
    position_is_length: bool = True
    n_rows_read: int = 0
    tension_standard_uncertainty: tuple[float, ...] = ()
    position_standard_uncertainty: float = float("nan")
    fill_pressure_standard_uncertainty: tuple[float, ...] = ()
    metadata: dict[str, str] = field(default_factory=dict)
    notes: tuple[Note, ...] = ()
    load_train: LoadTrain = LoadTrain()

    def __post_init__(self) -> None:
        """Check shapes and make the arrays read-only."""
        n_samples = self.time.shape[0]
        shapes = {
            "crosshead_position": (n_samples,),
            "crosshead_position_quality_flag": (n_samples,),
            "tension": (len(self.specimens), n_samples),
            "quality_flag": (len(self.specimens), n_samples),
        }
        require_shapes(self, shapes, of="record")

    @property
    def n_samples(self) -> int:
        """Number of rows kept."""
        return int(self.time.shape[0])


@dataclass(frozen=True)
@read_only_arrays
class StepReadings:
    """Readings of a stepwise test in SI, one row per weight; arrays have shape (n_steps,).

    ``clock`` is the text of the log and ``printed_strain`` the recorded elongation; the latter and
    ``eye_to_eye_length`` are NaN if the log lacks them.
    """

    clock: tuple[str, ...]
    time: Floats
    tension: Floats
    length: Floats
    eye_to_eye_length: Floats
    printed_strain: Floats
    length_standard_uncertainty: float = float("nan")
    tension_standard_uncertainty: float = float("nan")
    metadata: dict[str, str] = field(default_factory=dict)
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class Source:
    """One raw file.

    Parameters
    ----------
    name : str
        File name relative to the campaign folder.
    sha256 : str
        Hash of its bytes, hexadecimal.
    size : int
        Number of bytes.
    """

    name: str
    sha256: str
    size: int


@dataclass(frozen=True)
class Step:
    """One completed stage, with the inputs that it used.

    Parameters
    ----------
    name : str
        Name of the stage.
    text : str
        Description of the stage, with the numbers found or given.
    """

    name: str
    text: str

    def line(self, version: str) -> str:
        """One line of the netCDF ``history`` attribute, without a time."""
        return f"reduction {version} {self.name}: {self.text}"


@dataclass(frozen=True)
class Origin:
    """Origin of an archive made from several tests or files.

    Parameters
    ----------
    campaign_id : str
        Name of the campaign.
    attributes : mapping of str to str
        Statements of the laboratory on the campaign.
    sources : sequence of Source
        Files it was made from.
    steps : sequence of Step
        History lines.
    settings_json : str
        All settings in force, and all numbers given.
    version : str
        Version of this software.
    command : str
        Command of the user, without paths, jobs and scheduler.
    """

    campaign_id: str
    attributes: Mapping[str, str]
    sources: Sequence[Source]
    steps: Sequence[Step]
    settings_json: str
    version: str
    command: str

"""Declared layouts of logs, and their limits."""

from __future__ import annotations

import stat
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from reduction.quantities.units import Dimension, parse_quantity, scale_to_si
from reduction.record.errors import LogError, SettingsError
from reduction.record.measurement import LoadTrain
from reduction.record.notes import Note, note
from reduction.record.samples import scratch_folder
from reduction.record.settings import Limits

UNKNOWN = "?"
"""Placeholder to be replaced by the user in a file written by `reduction init`."""

CLOCK = "clock"

Format = Literal["delimited", "blocks", "spreadsheet", "tdms", "matlab", "hdf5", "parquet", "json"]

DateOrder = Literal["day first", "month first"]

_CHANNEL_DIMENSION: dict[str, Dimension] = {
    "time": "time",
    "crosshead_position": "length",
    "tension": "force",
    "strain": "strain",
    "fill_pressure": "stress",
    "cycle_counter": "number",
    "gauge_length": "length",
    "eye_to_eye_length": "length",
    "temperature": "temperature",
}


class Channel(BaseModel):
    """One column of a log.

    ``column`` is its name in the file, or its number from 1 where columns have no
    name.  ``factor`` turns a voltage or count into ``unit`` and is 1 otherwise.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    column: str | int
    unit: str = "1"
    """Time also accepts ``clock``: text such as 0945 or 09:45:30, converted to elapsed seconds."""
    factor: float = Field(default=1.0, gt=0, allow_inf_nan=False)
    unit_key: str = ""
    """Text key that states this channel's unit in JSON, checked against ``unit``."""
    sign: Literal[1, -1] = 1
    zero: str | None = None
    """Reading at zero load, subtracted before the sign is applied, with its unit."""
    datum: Literal["pin-to-pin", "displacement"] | None = None
    reference_length: str | None = None
    """Thimble-to-thimble length at displacement zero, with its unit."""
    reference_tension: str | None = None
    """Tension at which ``reference_length`` was read; slack if not given."""
    standard_uncertainty: str | None = None
    verified_range: tuple[str, str] | None = None
    date_order: DateOrder | None = None
    """For a clock with dates such as 05/06/2005: which of the two numbers is the day."""
    time_column: str | int | None = None
    """Column of the channel's own time stamps, if it has them."""
    time_unit: str = "s"


def _check_keys(name: str, channel: Channel) -> None:
    """Refuse declared keys that nothing would read."""
    keys: tuple[str, ...] = ()
    if name != "crosshead_position":
        keys = ("datum", "reference_length", "reference_tension")
    if name == "time":
        keys += ("sign", "zero")
        keys += ("factor",) if channel.unit == CLOCK else ()
    if name != "time" or channel.unit != CLOCK:
        keys += ("date_order",)
    for key in keys:
        if getattr(channel, key) != Channel.model_fields[key].default:
            raise SettingsError(
                f"channel {name} has no {key}", found=f"{key} = {getattr(channel, key)!r}",
                needed=f"a channel without {key}",
            )  # fmt: skip
    if channel.datum == "pin-to-pin" and channel.reference_length is not None:
        raise SettingsError(
            "a length from pin to pin has no reference_length",
            found=f"reference_length = {channel.reference_length!r}",
            needed='datum = "displacement", or no reference_length',
        )


def _check_units(name: str, channel: Channel, dimension: Dimension) -> None:
    """Refuse a unit that does not match the channel's dimension."""
    if channel.unit != CLOCK or name != "time":
        scale_to_si(channel.unit, dimension)
    scale_to_si(channel.time_unit, "time")
    for text in (channel.zero, channel.standard_uncertainty, *(channel.verified_range or ())):
        if text is not None:
            parse_quantity(text, dimension)
    if channel.reference_length is not None:
        parse_quantity(channel.reference_length, "length")
    if channel.reference_tension is not None:
        parse_quantity(channel.reference_tension, "force")


def _are_signs(text: str) -> bool:
    """Whether every character can separate fields in a line parser."""
    return text.isascii() and not set(text) & set("\0\n\r")


class Layout(BaseModel):
    """Form of a log file.  Rows count from 1, as in an editor."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    format: Format
    # text
    delimiter: str = ","
    """One character; a blank stands for any run of blanks and tabs."""
    decimal: Literal[".", ","] = "."
    thousands: Literal["", ",", ".", " ", "'", "\u00a0", "\u202f", "\u2019"] = ""
    encoding: str = "utf-8"
    """A byte-order mark at the start of a file is always accepted."""
    comment: str = ""
    """Lines that begin with this are kept as metadata; empty if there are none."""
    quote: str = '"'
    missing: tuple[str, ...] = ("", "NaN", "nan")
    preamble_rows: int = Field(default=0, ge=0)
    """Lines before the name row, comment lines included; kept as metadata."""
    ends_at: str = ""
    """Text at the start of the first line below the table; such lines are metadata."""
    has_name_row: bool = True
    has_unit_row: bool = False
    """A unit row is checked against the units declared here."""
    # blocks
    block_marker: str = ""
    """Blocks: text at the start of the line that opens a block of data."""
    # spreadsheets
    sheet: str | int = 1
    """Spreadsheets: sheet by name, or by number from 1."""
    # TDMS, MATLAB, HDF5
    group: str = ""
    """TDMS group, HDF5 group path, or MATLAB struct that holds the columns."""
    matrix: str = ""
    """MATLAB variable, HDF5 data set or JSON key of a matrix; columns are then numbers,
    or names where ``matrix_names`` gives them."""
    matrix_names: str = ""
    """JSON key, MATLAB variable or HDF5 data set with the column names of ``matrix``."""
    matrix_units: str = ""
    """JSON key, MATLAB variable or HDF5 data set with the units of its columns."""
    sample_interval: str | None = None
    """Time between rows, with its unit, of a log that has no time column."""
    # load train
    load_cell_at: Literal["fixed", "moving"] | None = None
    """At which end of the specimen its load cell is."""
    attached_mass: str | None = None
    """Between the specimen and a load cell at its moving end, with its unit."""
    machine_compliance: str | None = None
    """Of frame, load cell and grips, with its unit: ``"2e-7 m/N"``."""
    vertical: bool = False
    """Whether the specimen hangs, so that it does not sag between its ends."""
    channels: dict[str, Channel]

    @field_validator("channels", mode="before")
    @classmethod
    def _flatten(cls, value: object) -> object:
        """TOML's ``tension.1 = {...}`` arrives nested; the key here is ``tension.1``."""
        if not isinstance(value, dict):
            return value
        flat: dict[str, object] = {}
        for name, entry in value.items():
            if isinstance(entry, dict) and entry and all(str(k).isdigit() for k in entry):
                flat.update({f"{name}.{k}": v for k, v in entry.items()})
            else:
                flat[str(name)] = entry
        return flat

    @model_validator(mode="after")
    def _channels_make_sense(self) -> Layout:
        for name, channel in self.channels.items():
            dimension = self.dimension(name)
            _check_keys(name, channel)
            try:
                _check_units(name, channel, dimension)
            except SettingsError as error:
                raise SettingsError(
                    f"channel {name}: {error.problem}", found=error.found, needed=error.needed,
                    hint=error.hint,
                ) from error  # fmt: skip
        if self.sample_interval is not None:
            parse_quantity(self.sample_interval, "time")
            if "time" in self.channels:
                raise SettingsError(
                    "a layout has both a time channel and a sample_interval",
                    found=f"sample_interval {self.sample_interval}",
                    needed="one of the two",
                )
        self._check_load_train()
        if self.ends_at and self.format not in ("delimited", "spreadsheet"):
            raise SettingsError(
                f"ends_at does not apply to format {self.format}",
                found=f"ends_at = {self.ends_at!r}",
                needed="delimited or spreadsheet, or no ends_at",
            )
        # an MTS file of blocks states its decimal mark itself
        decimal = "" if self.format == "blocks" else self.decimal
        # quoted fields may contain the separator itself: "11,044.03516", "0,05"
        is_quoted = bool(self.quote) and self.delimiter != " "
        thousands = "" if is_quoted and self.thousands == self.delimiter else self.thousands
        decimal = "" if is_quoted and self.decimal == self.delimiter else decimal
        marks = [mark for mark in (self.delimiter, decimal, thousands) if mark]
        if len(self.delimiter) != 1 or len(set(marks)) < len(marks):
            raise SettingsError(
                "the separators of a layout cannot be told apart",
                found=f"delimiter {self.delimiter!r}, decimal {self.decimal!r}, "
                f"thousands {self.thousands!r}",
                needed="one character each, all different; decimal or thousands may be the "
                "delimiter where fields are quoted",
            )
        quote = self.quote
        if len(quote) > 1 or quote in marks or not _are_signs(self.delimiter + quote):
            raise SettingsError(
                "the quote of a layout cannot be told from its text",
                found=f"quote {quote!r}, delimiter {self.delimiter!r}, decimal {decimal!r}",
                needed="one ASCII character each, no line end, all different; or no quote at all",
            )
        position = self.channels.get("crosshead_position")
        if position is not None and position.datum is None:
            raise SettingsError(
                "the position channel has no datum",
                found="crosshead_position without datum",
                needed='datum = "pin-to-pin" (a length) or datum = "displacement"',
                hint="A displacement also needs reference_length, read at slack or at a "
                "stated reference_tension.",
            )
        return self

    def _check_load_train(self) -> None:
        """Refuse a mass without a stated place, and values that are not a mass or compliance."""
        if self.attached_mass is not None and self.load_cell_at is None:
            raise SettingsError(
                "a layout has an attached_mass, and does not say where the load cell is",
                found=f"attached_mass = {self.attached_mass!r} without load_cell_at",
                needed='load_cell_at = "moving" or "fixed"',
                hint="A load cell on the fixed frame does not feel a mass at the moving end.",
            )
        train = self.load_train
        for key, value in (
            ("attached_mass", train.attached_mass),
            ("machine_compliance", train.machine_compliance),
        ):
            if value is not None and value < 0:
                raise SettingsError(
                    f"{key} of a layout is negative", found=f"{value:g} in SI",
                    needed="zero or more",
                )  # fmt: skip

    @property
    def load_train(self) -> LoadTrain:
        """Load train stated by the layout, in SI."""
        mass, compliance = self.attached_mass, self.machine_compliance
        return LoadTrain(
            load_cell_at=self.load_cell_at,
            attached_mass=None if mass is None else parse_quantity(mass, "mass"),
            machine_compliance=(
                None if compliance is None else parse_quantity(compliance, "compliance")
            ),
            vertical=self.vertical,
        )

    @staticmethod
    def dimension(name: str) -> Dimension:
        """Dimension required of a channel, from its name; `SettingsError` if unknown."""
        dimension = _CHANNEL_DIMENSION.get(name.split(".")[0])
        if dimension is None:
            raise SettingsError(
                f"channel '{name}' is not known",
                found=f"'{name}'",
                needed="one of " + ", ".join(sorted(_CHANNEL_DIMENSION)),
            )
        return dimension


_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
}

_DAMAGED = "It may be damaged: save it again with the program that wrote it. "

_Limit = Literal["file_size", "unpacked_size", "line_length", "columns", "time"]


def check_regular(path: Path, mode: int) -> None:
    """Raise `LogError` if a path is not a regular file: a pipe or device may never end."""
    if not stat.S_ISREG(mode):
        raise LogError(
            path,
            "this is not a readable file",
            found=_KINDS.get(stat.S_IFMT(mode), "something else"),
            needed="a regular file",
        )


class Watch:
    """Check one log against the limits while it is read.

    Parameters
    ----------
    path : pathlib.Path
        The log.
    limits : Limits, optional
        Limits of the log; defaults if omitted.

    Examples
    --------
    >>> Watch(Path("log.csv"), Limits(columns=100)).check_columns(101, row=1)
    Traceback (most recent call last):
    reduction.record.errors.LogError: log.csv:1: the file has too many columns; found 101; needed
    100 at \
most. If that is what was logged, raise columns under [limits] of campaign.toml.
    """

    def __init__(self, path: Path, limits: Limits | None = None) -> None:
        """Start the timer."""
        self.path = path
        self.limits = limits or Limits()
        self._begin = time.monotonic()

    def check_size(self, n_bytes: int) -> None:
        """Raise `LogError` if the file has more bytes than ``file_size``."""
        if n_bytes > self.limits.file_size:
            raise self._beyond(
                "file_size", "the file is too large", f"{n_bytes:,} bytes",
                f"{self.limits.file_size:,} bytes at most",
            )  # fmt: skip

    def check_unpacked(self, n_bytes: int, what: str = "the file") -> None:
        """Raise `LogError` if the file unpacks to more than ``unpacked_size``."""
        if n_bytes > self.limits.unpacked_size:
            raise self._beyond(
                "unpacked_size", f"{what} unpacks to more memory than is allowed",
                f"{n_bytes:,} bytes", f"{self.limits.unpacked_size:,} bytes at most",
            )  # fmt: skip

    def check_columns(self, n_columns: int, *, row: int | None = None) -> None:
        """Raise `LogError` if there are more columns than ``columns``."""
        if n_columns > self.limits.columns:
            raise self._beyond(
                "columns", "the file has too many columns", f"{n_columns:,}",
                f"{self.limits.columns:,} at most", row=row,
            )  # fmt: skip

    def check_time(self) -> None:
        """Raise `LogError` if reading has taken longer than ``time``; call it between blocks."""
        seconds = time.monotonic() - self._begin
        if seconds > self.limits.time:
            raise self.too_slow(seconds)

    def too_slow(self, seconds: float) -> LogError:
        """Error for a file that took too long and was not read."""
        return self._beyond(
            "time", "the file takes too long to read", f"{seconds:.3g} s so far",
            f"{self.limits.time:g} s at most",
        )  # fmt: skip

    def too_much_memory(self) -> LogError:
        """Error for a file whose reader was refused more memory."""
        return self._beyond(
            "unpacked_size", "the file takes more memory than is allowed", "more while it was read",
            f"{self.limits.unpacked_size:,} bytes at most", before=_DAMAGED,
        )  # fmt: skip

    def broken(self, found: str) -> LogError:
        """Error for a file that terminated the reader process."""
        return self._beyond(
            "unpacked_size", "the library that reads this format crashed on the file", found,
            f"an intact file that takes {self.limits.unpacked_size:,} bytes of memory at most",
            before=_DAMAGED,
        )  # fmt: skip

    def long_line(self, row: int) -> LogError:
        """Error for a line longer than ``line_length``."""
        return self._beyond(
            "line_length", "a line is too long to be a row of a log",
            f"more than {self.limits.line_length:,} bytes without a line end", "one line a row",
            row=row, before="Check the format and the encoding of the layout. ",
        )  # fmt: skip

    def _beyond(
        self,
        limit: _Limit,
        problem: str,
        found: str,
        needed: str,
        *,
        row: int | None = None,
        before: str = "",
    ) -> LogError:
        return LogError(
            self.path,
            problem,
            row=row,
            found=found,
            needed=needed,
            hint=f"{before}If that is what was logged, raise {limit} under [limits] of "
            "campaign.toml.",
        )


@dataclass(frozen=True)
class LogParts:
    """Division of a raw file into parts; it does not affect any number.

    Parameters
    ----------
    in_memory : int
        Bytes of a text file, or of the columns of a binary one, up to which its columns stay in
        memory. [1]
    n_bytes : int
        Bytes of a part, of text or of columns; a shorter file is one part. [1]
    folder : pathlib.Path
        Folder of the scratch files of its columns.
    """

    in_memory: int = 32 << 20
    n_bytes: int = 16 << 20
    folder: Path = field(default_factory=scratch_folder)

    def folder_of(self, n_bytes: int) -> Path | None:
        """Folder for the columns of a file of that length; None for memory."""
        return self.folder if n_bytes > self.in_memory else None

    def length_of(self, n_bytes: int) -> int:
        """Bytes per part of a file of that length."""
        return max(min(self.n_bytes, n_bytes), 1)


_LONGEST = 100_000


def short_metadata(found: Mapping[str, str]) -> tuple[dict[str, str], tuple[Note, ...]]:
    """Return the texts short enough to keep, and a note on each of the others.

    ``notes``: one for each text left out.

    Examples
    --------
    >>> kept, notes = short_metadata({"operator": "KH", "picture": "x" * 200_000})
    >>> print(kept, *notes)
    {'operator': 'KH'} file attribute 'picture' is not stored: it has 200,000 characters
    """
    metadata, notes = {}, []
    for key, text in found.items():
        if len(key) + len(text) <= _LONGEST:
            metadata[key] = text
        else:
            notes.append(note("metadata-left-out", key=key[:40], n_characters=len(text)))
    return metadata, tuple(notes)

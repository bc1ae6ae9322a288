"""Declared layouts: what a log file looks like, said by a person, never guessed.

A layout names positions (``tension.1``), not specimens; a test says which specimen
hangs at which position.
"""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from reduction.errors import SettingsError
from reduction.units import Dimension, parse_quantity, scale_to_si

CLOCK = "clock"

Format = Literal["delimited", "blocks", "spreadsheet", "tdms", "matlab", "hdf5", "parquet", "json"]

_CHANNEL_DIMENSION: dict[str, Dimension] = {
    "time": "time",
    "crosshead_position": "length",
    "tension": "force",
    "strain": "strain",
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

    model_config = ConfigDict(extra="forbid", frozen=True)

    column: str | int
    unit: str = "1"
    """Of time also ``clock``: text such as 0945 or 09:45:30, made elapsed seconds."""
    factor: float = Field(default=1.0, gt=0, allow_inf_nan=False)
    unit_key: str = ""
    """JSON: key of the text that states this channel's unit, checked against ``unit``."""
    sign: Literal[1, -1] = 1
    zero: str | None = None
    """Reading at zero load, subtracted before the sign is applied, with its unit."""
    datum: Literal["pin-to-pin", "displacement"] | None = None
    reference_length: str | None = None
    """Thimble-to-thimble length at displacement zero, with its unit."""
    reference_tension: str | None = None
    """Tension at which ``reference_length`` was read; slack where not given."""
    standard_uncertainty: str | None = None
    verified_range: tuple[str, str] | None = None
    time_column: str | int | None = None
    """The channel's own time stamps, where it has them."""
    time_unit: str = "s"


def _check_keys(name: str, channel: Channel) -> None:
    """Refuse what a channel declares and nothing would look at."""
    keys: tuple[str, ...] = ()
    if name != "crosshead_position":
        keys = ("datum", "reference_length", "reference_tension")
    if name == "time":
        keys += ("sign", "zero")
        keys += ("factor",) if channel.unit == CLOCK else ()
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
    """Refuse a unit that is not one of the channel's dimension."""
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
    """Whether every character is one that a parser of lines can part fields by."""
    return text.isascii() and not set(text) & set("\0\n\r")


class Layout(BaseModel):
    """What a log file looks like.  Rows count from 1, as an editor counts them."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    format: Format
    # text
    delimiter: str = ","
    """One character; a blank stands for any run of blanks and tabs."""
    decimal: Literal[".", ","] = "."
    thousands: Literal["", ",", ".", " ", "'"] = ""
    encoding: str = "utf-8"
    """A byte-order mark at the start of a file is always accepted."""
    comment: str = ""
    """Lines that begin with this are kept as metadata; empty: there are none."""
    quote: str = '"'
    missing: tuple[str, ...] = ("", "NaN", "nan")
    preamble_rows: int = Field(default=0, ge=0)
    """Lines before the name row, comment lines included; kept as metadata."""
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
        # an MTS file of blocks states its decimal mark itself
        decimal = "" if self.format == "blocks" else self.decimal
        marks = [mark for mark in (self.delimiter, decimal, self.thousands) if mark]
        if len(self.delimiter) != 1 or len(set(marks)) < len(marks):
            raise SettingsError(
                "the separators of a layout cannot be told apart",
                found=f"delimiter {self.delimiter!r}, decimal {self.decimal!r}, "
                f"thousands {self.thousands!r}",
                needed="one character each, all different",
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

    @staticmethod
    def dimension(name: str) -> Dimension:
        """What a channel has to be, from its name; `SettingsError` where it is not known."""
        dimension = _CHANNEL_DIMENSION.get(name.split(".")[0])
        if dimension is None:
            raise SettingsError(
                f"channel '{name}' is not known",
                found=f"'{name}'",
                needed="one of " + ", ".join(sorted(_CHANNEL_DIMENSION)),
            )
        return dimension

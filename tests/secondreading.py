"""What a campaign folder says, read a second time by nothing of the package.

Plain and slow: a person's reading of docs/layouts.md with the standard library, and for binary
formats with the library of the format.  `read_again` gives what one test holds, in SI.
"""

import csv
import io
import json
import math
import re
import tempfile
import tomllib
import zipfile
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import h5py
import nptdms
import numpy as np
import pyarrow.parquet as pq
import scipy.io

__all__ = ["Reading", "UnreadableError", "in_si", "read_again"]

BASES = {
    "m": 1.0, "meter": 1.0, "metre": 1.0, "ft": 0.3048, "foot": 0.3048, "feet": 0.3048,
    "in": 0.0254, "inch": 0.0254, "yd": 0.9144, "furlong": 660 * 1200 / 3937,
    "N": 1.0, "newton": 1.0, "lbf": 4.4482216152605, "lb": 4.4482216152605,
    "kgf": 9.80665, "dyn": 1e-5, "dyne": 1e-5,
    "s": 1.0, "sec": 1.0, "Sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0, "hour": 3600.0,
    "hr": 3600.0, "d": 86400.0, "day": 86400.0,
}  # fmt: skip
PREFIXES = {
    "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9, "c": 1e-2, "m": 1e-3, "u": 1e-6, "µ": 1e-6, "n": 1e-9,
    "d": 1e-1, "h": 1e2, "da": 1e1, "p": 1e-12, "f": 1e-15, "a": 1e-18, "T": 1e12,
}  # fmt: skip
_PLAIN = ("min", "in", "ft", "h", "d", "yd", "lb", "hr")


class UnreadableError(Exception):
    """The folder does not say one thing."""


@dataclass(frozen=True)
class Reading:
    """One test: series of shape (n_rows,) in SI, NaN where missing, and its specimen."""

    time: np.ndarray
    position: np.ndarray
    tension: np.ndarray
    area: float
    gauge_length: float | None
    marks: tuple[tuple[str, float, float, float], ...] = ()
    results: tuple[float, ...] = ()

    def in_order(self):
        """Rows by their time, each that stands there twice once."""
        rows = np.array([self.time, self.position, self.tension]).T
        rows = rows[np.argsort(rows[:, 0], kind="stable")]
        is_new = np.append(True, np.any(rows[1:] != rows[:-1], axis=1))
        time, position, tension = rows[is_new].T
        return replace(self, time=time, position=position, tension=tension)


def factor_of(unit):
    """Size of a unit in SI; a prefix stands before one that takes it."""
    unit = unit.strip()
    for base, size in BASES.items():
        for prefix, scale in PREFIXES.items():
            if unit == prefix + base and (not prefix or base not in _PLAIN):
                return scale * size
    raise UnreadableError(f"unit {unit!r}")


def in_si(text):
    """``"2 m"`` in SI."""
    match = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*([^\d\s].*)", str(text))
    if match is None:
        raise UnreadableError(f"quantity {text!r}")
    return float(match[1]) * factor_of(match[2])


def number(text, decimal=".", thousands="", missing=("", "NaN", "nan")):
    text = text.strip(" \t")
    if text in missing:
        return math.nan
    whole = r"\d+" if not thousands else rf"(?:\d{{1,3}}(?:{re.escape(thousands)}\d{{3}})+|\d+)"
    point = re.escape(decimal)
    if not re.fullmatch(
        rf"[-+]?(?:{whole}(?:{point}\d*)?|{point}\d+)(?:[eE][-+]?\d+)?", text, re.ASCII
    ):
        raise UnreadableError(f"number {text!r}")
    if thousands:
        text = text.replace(thousands, "")
    return float(text.replace(decimal, "."))


def lines_of(data, layout):
    text = data.decode(layout.get("encoding", "utf-8")).rstrip("\n\r\x1a")
    return re.split(r"\r\n|\n|\r", text.removeprefix("\ufeff"))


def fields_of(line, layout):
    delimiter = layout.get("delimiter", ",")
    return [f.strip() for f in next(csv.reader([line], delimiter=delimiter), [])]


def _table_of_rows(rows, names, layout):
    """Columns by name and by number, as text made numbers when they are asked for."""
    width = len(rows[0])

    def column(key):
        place = key - 1 if isinstance(key, int) else names.index(key)
        if isinstance(key, str) and names.count(key) != 1:
            raise UnreadableError(f"column {key!r}")
        values = []
        for row in rows:
            if len(row) != width:
                raise UnreadableError("a row of another length")
            values.append(
                number(
                    row[place], layout.get("decimal", "."), layout.get("thousands", ""),
                    layout.get("missing", ("", "NaN", "nan")),
                )
            )  # fmt: skip
        return np.array(values)

    return column


def _says(layout, key, default):
    """A setting that is true or false; words for them are taken, as in campaign.toml."""
    value = layout.get(key, default)
    return (
        value.lower() in ("true", "t", "yes", "y", "on", "1") if isinstance(value, str) else value
    )


def _delimited(data, layout):
    comment = layout.get("comment", "")
    lines = lines_of(data, layout)[layout.get("preamble_rows", 0) :]
    kept = [one for one in lines if one.strip() and not (comment and one.startswith(comment))]
    n_head = _says(layout, "has_name_row", True) + _says(layout, "has_unit_row", False)
    names = fields_of(kept[0], layout) if _says(layout, "has_name_row", True) else []
    return _table_of_rows([fields_of(line, layout) for line in kept[n_head:]], names, layout)


def _blocks(data, layout):
    """Rows of the blocks whose header is that of the first with the declared columns."""
    wanted = {channel["column"] for channel in _flat(layout["channels"])}
    n_head = 1 + _says(layout, "has_unit_row", False)
    lines = lines_of(data, layout)
    if lines[0].startswith("MTS793|"):
        layout = layout | {"decimal": lines[0].split("|")[5]}
    chosen, header, rows = None, None, []
    for line in lines:
        if line.startswith(layout["block_marker"]):
            header = []
        elif header is not None and len(header) < n_head:
            header.append(line)
            if (
                chosen is None
                and len(header) == n_head
                and wanted <= set(fields_of(header[0], layout))
            ):
                chosen = header
        elif header is not None and header == chosen:
            fields = fields_of(line, layout)
            if len(fields) == len(fields_of(chosen[0], layout)):
                rows.append(fields)
    return _table_of_rows(rows, fields_of(chosen[0], layout), layout)


def _flat(channels):
    """Channels one by one; ``tension.1`` arrives nested."""
    for channel in channels.values():
        yield from [channel] if "column" in channel else channel.values()


def _once(pairs):
    if len({key for key, _ in pairs}) < len(pairs):
        raise UnreadableError("a key stands twice")
    return dict(pairs)


def _json(data, layout):
    content = json.loads(data.decode(layout.get("encoding", "utf-8-sig")), object_pairs_hook=_once)
    names, rows = content[layout["matrix_names"]], content[layout["matrix"]]

    def column(key):
        if names.count(key) != 1 or any(len(row) != len(names) for row in rows):
            raise UnreadableError("rows of another length")
        values = [row[names.index(key)] for row in rows]
        return np.array([math.nan if v in (None, "", "NaN", "nan") else float(v) for v in values])

    return column


def _spreadsheet(data, layout):
    # the elements are those, whatever their namespace is called
    archive = zipfile.ZipFile(io.BytesIO(data))
    sheet = ElementTree.fromstring(archive.read("xl/worksheets/sheet1.xml"))  # noqa: S314  # refused before
    places, number_of_row = {}, 0
    for row in sheet.iterfind(".//{*}row"):
        # what does not say where it stands follows the one before
        number_of_row = int(row.get("r", number_of_row + 1))
        cells = places.setdefault(number_of_row, {})
        at = -1
        for cell in row.iterfind(".//{*}c"):
            place = re.fullmatch(r"([A-Z])(\d+)", cell.get("r", ""))
            at = at + 1 if place is None else ord(place[1]) - 65
            parts = [*cell.iterfind(".//{*}v"), *cell.iterfind(".//{*}t")]
            cells[at] = "".join(parts[-1].itertext()) if parts else ""
    rows = [
        [places.get(r, {}).get(c, "") for c in range(max(places.get(r, {}), default=0) + 1)]
        for r in range(1, max(places) + 1)
    ]
    width = len(rows[0])
    rows = [row + [""] * (width - len(row)) for row in rows]
    n_head = 1 + _says(layout, "has_unit_row", False)
    body = rows[n_head:]
    while body and not any(body[-1]):
        body.pop()
    return _table_of_rows(body, rows[0], layout)


def _hdf5(data, layout):
    # from a name: of a file object the library asks for what it passes over on a disk
    with tempfile.NamedTemporaryFile(suffix=".h5") as named:
        named.write(data)
        named.flush()
        file = h5py.File(named.name, locking=False)
    group = file[layout["group"]] if layout.get("group") else file
    if "matrix" not in layout:
        return lambda key: np.asarray(group[key][()], dtype=float).ravel()
    names = [name.decode() for name in group[layout["matrix_names"]][()]]
    return lambda key: np.asarray(group[layout["matrix"]][()])[:, names.index(key)]


def _matlab(data, layout):
    held = scipy.io.loadmat(io.BytesIO(data))
    held = held[layout["group"]][0, 0] if layout.get("group") else held
    # as of other formats, blanks around a name are none of it
    found = (
        {name.strip(): values for name, values in held.items()} if isinstance(held, dict) else held
    )
    return lambda key: np.asarray(found[key], dtype=float).ravel()


def _tdms(data, layout):
    file = nptdms.TdmsFile.read(io.BytesIO(data))
    return lambda key: np.asarray(file[layout["group"]][key][:], dtype=float)


def _parquet(data, layout):
    table = pq.ParquetFile(io.BytesIO(data)).read()
    return lambda key: table.column(key).to_numpy().astype(float)


_READERS = {
    "delimited": _delimited, "blocks": _blocks, "json": _json, "spreadsheet": _spreadsheet,
    "hdf5": _hdf5, "matlab": _matlab, "tdms": _tdms, "parquet": _parquet,
}  # fmt: skip


def _series(column, channel):
    """A channel in SI: sign * (reading * factor - zero)."""
    values = column(channel["column"]) * channel.get("factor", 1.0) * factor_of(channel["unit"])
    zero = in_si(channel["zero"]) if "zero" in channel else 0.0
    values = channel.get("sign", 1) * (values - zero)
    if "reference_length" in channel and channel.get("datum") == "displacement":
        values = values + in_si(channel["reference_length"])
    return values


def _csv(data):
    lines = csv.reader(data.decode("utf-8-sig").splitlines())
    rows = [[cell.strip() for cell in row] for row in lines if any(cell.strip() for cell in row)]
    if any(len(row) != len(rows[0]) for row in rows) or len(set(rows[0])) < len(rows[0]):
        raise UnreadableError("a table with rows of another length, or two columns of a name")
    return [dict(zip(rows[0], row, strict=True)) for row in rows[1:]]


def _marks(data, specimen):
    rows = []
    for row in _csv(data):
        lengths = {}
        for name, cell in row.items():
            stem, _, unit = name.rpartition("_")
            if stem in ("near_toe", "far_toe", "far_thimble"):
                lengths[stem] = number(cell, missing=()) * factor_of(unit)
        if row["specimen"] == specimen:
            rows.append(
                (row["hold"], *(lengths[n] for n in ("near_toe", "far_toe", "far_thimble")))
            )
    return tuple(rows)


def _results(data):
    """Values of the outcomes; NaN of a row that is not valid and has none."""
    return tuple(number(row["value"]) * factor_of(row["unit"]) for row in _csv(data))


def read_again(files, test="A"):
    """Read a test of a campaign folder, given as bytes by name.

    Raises `UnreadableError`, or whatever the libraries raise, where it says nothing or two things.
    """
    campaign = tomllib.loads(files["campaign.toml"].decode("utf-8-sig"))
    section = dict(campaign.get("defaults", {}))
    above = campaign.get("tests", {})
    if name := above if isinstance(above, str) else campaign["campaign"].get("tests"):
        section |= next(
            {k: v for k, v in r.items() if v} for r in _csv(files[name]) if r["id"] == test
        )
    section |= {} if isinstance(above, str) else above.get(test, {})
    layout = campaign["layouts"][section["layout"]]
    specimens = section["specimens"]
    name = specimens if isinstance(specimens, str) else specimens[0]
    specimen = campaign["specimens"][name]
    column = _READERS[layout["format"]](files[section["file"]], layout)
    channels = layout["channels"]
    (tension,) = _flat({"tension": channels["tension"]})
    diameters = specimen.get("diameter", [])
    diameters = [diameters] if isinstance(diameters, str) else diameters
    diameter = np.mean([in_si(one) for one in diameters]) if diameters else math.nan
    length = specimen.get("gauge_length")
    marks = section.get("strain", {}).get("marks")
    results = campaign.get("results") or campaign["campaign"].get("results")
    return Reading(
        time=_series(column, channels["time"]),
        position=_series(column, channels["crosshead_position"]),
        tension=_series(column, tension),
        area=math.pi * float(diameter) ** 2 / 4,
        gauge_length=None if length is None or marks else in_si(length),
        marks=_marks(files[marks], name) if marks else (),
        results=_results(files[results]) if results else (),
    )

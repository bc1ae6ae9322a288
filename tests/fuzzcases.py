"""Small good campaigns, one for each format of a log, from which mutations start.

A case is the files of a campaign folder as bytes.  All hold the same synthetic test: a rope at
rest, six triangular cycles of position, and back to rest, 420 rows.
"""

import io
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
import nptdms
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.io
from workbook import write_xlsx

STEP = 0.1  # s
GAUGE_LENGTH = 2.0  # m
N_CYCLES, PER_CYCLE = 6, 48
KNOTS = np.cumsum([0, 36, 24, *[PER_CYCLE // 2] * (2 * N_CYCLES), 24, 48])
LEVELS = [0.0, 0.0, *[0.5, 0.9] * N_CYCLES, 0.5, 0.0, 0.0]
N_ROWS = int(KNOTS[-1])

CAMPAIGN = """\
[campaign]
id = "fuzz"
title = "One short test (synthetic)"
source = "synthetic"
[specimens.one]
kind = "rope"
diameter = ["20 mm"]
gauge_length = "2 m"
gauge_length_standard_uncertainty = "2 mm"
[layouts.logger]
{layout}
[layouts.logger.channels]
{channels}
[tests.A]
file = "{file}"
layout = "logger"
specimens = ["one"]
strain = {{ method = "gauge-length" }}
"""
CHANNELS = """\
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "mm", datum = "pin-to-pin" }
tension.1 = { column = "F", unit = "N" }
"""


def course():
    """Time [s], length [mm] and tension [N] of the test, shape (3, N_ROWS), as printed."""
    rng = np.random.default_rng(20261122)
    samples = np.arange(N_ROWS)
    strain = np.interp(samples, KNOTS, LEVELS)
    tension = 800 * strain + 300 * strain**2 + 25 * np.sign(np.gradient(strain)) * strain
    position = 1000 * GAUGE_LENGTH * (1 + strain) + rng.normal(0, 0.4, N_ROWS)
    # a load cell that is never quite at zero: unlike values, so that a row is told from its neighbour
    return np.round([STEP * samples, position, tension + 3 + rng.normal(0, 0.6, N_ROWS)], 2)


COURSE = course()


@dataclass(frozen=True)
class Table:
    """What a log holds: names, units and values of its columns, shape (n_columns, n_rows)."""

    values: np.ndarray
    names: tuple[str, ...] = ("t", "x", "F")
    units: tuple[str, ...] = ("s", "mm", "N")

    def columns(self):
        return zip(self.names, self.units, self.values, strict=True)


GOOD = Table(COURSE)


@dataclass(frozen=True)
class Case:
    """A campaign folder: its files by name, which of them is the log, and how that is made."""

    name: str
    files: dict[str, bytes]
    log: str
    make_log: Callable[[Table], bytes]

    @property
    def is_text(self):
        return self.log.endswith((".csv", ".txt", ".json"))

    def write(self, folder, files=None):
        """Put the files, or others in their place, into a folder; the campaign."""
        for name, data in (files or self.files).items():
            (folder / name).write_bytes(data)
        return folder / "campaign.toml"


def _case(name, log, make_log, layout, channels=CHANNELS):
    text = CAMPAIGN.format(layout=layout, channels=channels, file=log)
    return Case(name, {"campaign.toml": text.encode(), log: make_log(GOOD)}, log, make_log)


def _number(value):
    return "NaN" if np.isnan(value) else f"{value:.2f}"


def _lines(table, delimiter):
    return [delimiter.join(map(_number, row)) for row in table.values.T]


def _delimited_log(table):
    lines = ["# tether 7 (synthetic)", ",".join(table.names), ",".join(table.units)]
    return ("\n".join([*lines, *_lines(table, ",")]) + "\n").encode()


def delimited():
    layout = 'format = "delimited"\ncomment = "#"\nhas_unit_row = true'
    return _case("delimited", "A.csv", _delimited_log, layout)


_COMMAS = str.maketrans(",.", ".,")


def _continental_log(table):
    lines = ["Prüfung: 7 (synthetic)"]
    lines += [";".join([*(f"{n} [{u}]" for n, u, _ in table.columns()), "note"])]
    for row in table.values.T:
        fields = [_number(v) if np.isnan(v) else f"{v:,.2f}".translate(_COMMAS) for v in row]
        lines.append(";".join([*fields, "ok"]))
    return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def continental():
    """Semicolons, decimal commas, thousands, units in the names, Latin-1, lines of CR LF."""
    layout = (
        'format = "delimited"\ndelimiter = ";"\ndecimal = ","\nthousands = "."\n'
        'encoding = "latin-1"\npreamble_rows = 1'
    )
    channels = (
        CHANNELS.replace('"t"', '"t [s]"').replace('"x"', '"x [mm]"').replace('"F"', '"F [N]"')
    )
    return _case("continental", "A.csv", _continental_log, layout, channels)


def _blocks_log(table):
    lines, rows = ["MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A", ""], _lines(table, "\t")
    for first in range(0, len(rows), 100):
        lines += [f"Data Acquisition\tTime:\t{first / 10}\tSec"]
        lines += ["\t".join(table.names), "\t".join(table.units), *rows[first : first + 100], ""]
    return ("\n".join(lines) + "\n").encode()


def blocks():
    layout = (
        'format = "blocks"\ndelimiter = "\\t"\nblock_marker = "Data Acquisition"\n'
        "has_unit_row = true"
    )
    return _case("blocks", "A.txt", _blocks_log, layout)


def _json_log(table):
    rows = [[None if np.isnan(v) else v for v in row] for row in table.values.T.tolist()]
    content = {"columns": table.names, "units": table.units, "rows": rows}
    return json.dumps(content).encode()


def json_rows():
    layout = 'format = "json"\nmatrix = "rows"\nmatrix_names = "columns"\nmatrix_units = "units"'
    return _case("json", "A.json", _json_log, layout)


def _written(suffix, write):
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"A.{suffix}"
        write(path)
        return path.read_bytes()


def _spreadsheet_log(table):
    rows = [[None if np.isnan(v) else v for v in row] for row in table.values.T.tolist()]
    sheets = {"log": [table.names, table.units, *rows]}
    return _written("xlsx", lambda path: write_xlsx(path, sheets))


def spreadsheet():
    layout = 'format = "spreadsheet"\nhas_unit_row = true'
    return _case("spreadsheet", "A.xlsx", _spreadsheet_log, layout)


def _hdf5_log(table):
    def write(path):
        with h5py.File(path, "w") as file:
            for name, unit, values in table.columns():
                file.create_dataset(f"run/{name}", data=values).attrs["units"] = unit

    return _written("h5", write)


def hdf5():
    return _case("hdf5", "A.h5", _hdf5_log, 'format = "hdf5"\ngroup = "run"')


def _hdf5_matrix_log(table):
    def write(path):
        with h5py.File(path, "w") as file:
            file.create_dataset("table", data=table.values.T, chunks=(64, 1), compression="gzip")
            file["names"], file["units"] = table.names, table.units

    return _written("h5", write)


def hdf5_matrix():
    """One compressed data set of all columns, in chunks."""
    layout = 'format = "hdf5"\nmatrix = "table"\nmatrix_names = "names"\nmatrix_units = "units"'
    return _case("hdf5-matrix", "A.h5", _hdf5_matrix_log, layout)


def _matlab_log(table, **options):
    stream = io.BytesIO()
    variables = {name: values[:, None] for name, _, values in table.columns()}
    if options.pop("as_struct", False):
        variables = {"run": variables}
    scipy.io.savemat(stream, variables, **options)
    return stream.getvalue()


def matlab():
    return _case("matlab", "A.mat", _matlab_log, 'format = "matlab"')


def matlab_packed():
    """A struct that is packed by zlib."""
    make = partial(_matlab_log, as_struct=True, do_compression=True)
    return _case("matlab-packed", "A.mat", make, 'format = "matlab"\ngroup = "run"')


def matlab_4():
    return _case("matlab-4", "A.mat", partial(_matlab_log, format="4"), 'format = "matlab"')


def _tdms_log(table):
    def write(path):
        with nptdms.TdmsWriter(path) as writer:
            for first in range(0, table.values.shape[1], 140):
                rows = slice(first, first + 140)
                writer.write_segment(
                    [
                        nptdms.ChannelObject("log", name, values[rows], {"unit_string": unit})
                        for name, unit, values in table.columns()
                    ]
                )

    return _written("tdms", write)


def tdms():
    return _case("tdms", "A.tdms", _tdms_log, 'format = "tdms"\ngroup = "log"')


def _parquet_log(table, **options):
    fields = [pa.field(n, pa.float64(), metadata={"unit": u}) for n, u, _ in table.columns()]
    made = pa.table([pa.array(v) for v in table.values], schema=pa.schema(fields))
    return _written("parquet", lambda path: pq.write_table(made, path, **options))


def parquet():
    return _case("parquet", "A.parquet", _parquet_log, 'format = "parquet"')


def parquet_plain():
    """Neither packed nor in a dictionary."""
    make = partial(_parquet_log, compression="none", use_dictionary=False, row_group_size=150)
    return _case("parquet-plain", "A.parquet", make, 'format = "parquet"')


MARKS = """\
test,specimen,hold,near_toe_mm,far_toe_mm,far_thimble_mm
A,one,slack,400.0,1600.0,2000.0
A,one,min,520.0,2480.0,3000.0
A,one,max,610.0,3190.0,3800.0
"""
RESULTS = """\
test,specimen,quantity,value,unit,mode,place,valid
B-1,one,tensile_strength,41.2,kN,rope,free,yes
B-2,one,tensile_strength,39.8,kN,splice,splice,no
B-3,one,tensile_strength,40.5,kN,rope,free,yes
"""


def marked():
    """Strain by marks, tests in a table: the tables that a person keeps beside the campaign."""
    good = delimited()
    text = good.files["campaign.toml"].decode()
    head, _, _ = text.partition("[tests.A]")
    head = head.replace(
        "[campaign]\n", '[campaign]\ntests = "tests.csv"\nresults = "results.csv"\n'
    )
    head += '[defaults]\nlayout = "logger"\nspecimens = ["one"]\n'
    head += 'strain = { method = "marks", marks = "marks.csv" }\n'
    tests = "id,file,order,n_cycles,target_strain\nA,A.csv,1,6,0.5;0.9\n"
    texts = {"campaign.toml": head, "marks.csv": MARKS, "tests.csv": tests, "results.csv": RESULTS}
    files = {name: text.encode() for name, text in texts.items()}
    return Case("marked", good.files | files, good.log, good.make_log)


TEXTS = (delimited, continental, blocks, json_rows)
BINARIES = (
    spreadsheet, hdf5, hdf5_matrix, matlab, matlab_packed, matlab_4, tdms, parquet,
    parquet_plain,
)  # fmt: skip
CASES = {case.name: case for case in (make() for make in (*TEXTS, *BINARIES, marked))}

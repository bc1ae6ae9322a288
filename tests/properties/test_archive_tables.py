"""What goes into an archive or a table comes out of it."""

import csv
import io
import tempfile
from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr
from examples import examples
from hypothesis import example, given, settings
from hypothesis import strategies as st
from table_cells import text_of_columns

from reduction.archive.csv_columns import csv_text
from reduction.archive.csv_tables import _Curve, _envelope_rows
from reduction.archive.test_dataset import _row_counts
from reduction.archive.variables import pad
from reduction.record.measurement import Record

TEXT = st.text(st.characters(codec="utf-8", exclude_characters="\x00"), max_size=20)


@given(st.lists(st.floats(allow_nan=False), min_size=1))
def test_every_float_comes_back_from_a_table(numbers):
    text = text_of_columns(np.array(numbers), np.array(numbers))
    rows = csv.reader(io.StringIO(text, newline=""))
    assert [float(row[0]) for row in rows] == numbers


@given(st.lists(st.floats(allow_nan=False), min_size=1))
def test_a_number_is_written_as_python_writes_it(numbers):
    text = text_of_columns(np.array(numbers))
    assert text.split("\r\n")[:-1] == [repr(number) for number in numbers]


@given(st.lists(TEXT, min_size=1, max_size=5))
@example(["-"])
def test_every_text_comes_back_from_a_table_but_for_the_apostrophe(labels):
    # a second column, since a row of one empty cell is an empty line to every reader
    text = csv_text(["x", "y"], [[label, 1] for label in labels])
    back = [row[0] for row in csv.reader(io.StringIO(text, newline=""))][1:]
    for label, cell in zip(labels, back, strict=True):
        assert cell == label or (label[0] in "=+-@\t\r" and cell == f"'{label}")
        # a minus alone stands for no value, and is text to every spreadsheet program
        assert cell == "-" or not cell.startswith(("=", "+", "-", "@"))


@settings(max_examples=examples(30), deadline=None)
@given(st.lists(TEXT.map(lambda text: text.rstrip("\x00")), min_size=1, max_size=4))
def test_every_text_comes_back_from_a_file(labels):
    variable = xr.Variable(
        ("note",), np.array(labels), encoding={"dtype": "S1", "char_dim_name": "note_strlen"}
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.nc"
        xr.Dataset({"hold_refusal": variable}).to_netcdf(path, engine="netcdf4")
        with netCDF4.Dataset(path) as file:
            assert file["hold_refusal"].dtype == np.dtype("S1")
        with xr.open_dataset(path, engine="netcdf4") as back:
            assert back["hold_refusal"].to_numpy().tolist() == labels


@given(st.lists(st.lists(st.floats(allow_nan=False), max_size=4), min_size=1, max_size=4))
def test_ragged_rows_keep_their_numbers_and_gain_only_gaps(rows):
    table = pad(rows)
    for line, row in zip(table, rows, strict=True):
        assert line[: len(row)].tolist() == row
        assert np.isnan(line[len(row) :]).all()


@given(st.lists(st.integers(0, 1023), min_size=1, max_size=30))
def test_the_account_counts_every_flag_of_every_row(flags):
    n_samples = len(flags)
    record = Record(
        test_id="t",
        specimens=("s",),
        time=np.arange(float(n_samples)),
        crosshead_position=np.zeros(n_samples),
        tension=np.zeros((1, n_samples)),
        quality_flag=np.array([flags], dtype=np.uint16),
        crosshead_position_quality_flag=np.zeros(n_samples, dtype=np.uint16),
    )
    counts = _row_counts(record)["n_flagged"]
    assert counts[0].sum() == 0
    assert counts[1].sum() == sum(flag.bit_count() for flag in flags)


@given(
    st.lists(
        st.tuples(st.integers(0, 5), st.lists(st.floats(1, 1e3), min_size=2, max_size=6)),
        min_size=1,
        max_size=5,
    )
)
def test_no_test_of_equal_bins_lies_outside_the_envelope(tests):
    curves = [
        _Curve(
            test=f"T-{number}",
            specimen="new",
            branch="ascending",
            synthetic="no",
            strain=0.05 + 0.1 * (start + np.arange(len(moduli))),
            width=0.1,
            modulus=np.array(moduli),
            uncertainty=np.ones(len(moduli)),
        )
        for number, (start, moduli) in enumerate(tests)
    ]
    rows = {round(row[2], 6): row for row in _envelope_rows(curves)}
    for curve in curves:
        for strain, modulus in zip(curve.strain, curve.modulus, strict=True):
            row = rows[round(strain, 6)]
            # strains of two grids differ by a last digit, and so does what is read between them
            assert row[3] - 1e-9 <= modulus <= row[6] + 1e-9
    seen = np.array(sorted({modulus for _, moduli in tests for modulus in moduli}))
    ends = np.array([end for row in rows.values() for end in (row[3], row[6])])
    assert np.isclose(ends[:, None], seen, rtol=0, atol=1e-9).any(axis=1).all()

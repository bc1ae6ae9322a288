import csv
import io
import json

import numpy as np
import pytest
import xarray as xr
from export_lines import line

from reduction.lines.export_tables import (
    TableColumn,
    ValueTable,
    curve_table,
    table_text_of,
    write_netcdf,
)
from reduction.record.errors import ArchiveError, SettingsError

TABLE = ValueTable(
    "K_ap of 1/2 in line & more",
    (
        TableColumn("tension", "N", "tension", np.array([0.0, 4.4482216152605])),
        TableColumn("apparent_spring_constant", "N", "K_ap", np.array([1.0, np.nan])),
        TableColumn("is_tested", "", "tested", np.array([False, True])),
    ),
    sources=("CG-D-39-80, Table 3",),
    notes=("B_7 is open",),
    is_synthetic=True,
)


def test_csv_has_units_sources_and_empty_cells():
    rows = table_text_of(TABLE, "csv").split("\r\n")
    assert rows[0] == "tension [N],apparent_spring_constant [N],is_tested,what,source"
    assert rows[2] == "4.4482216152605,,yes,,"
    assert rows[1].startswith("0,1,no,K_ap of 1/2 in line & more,")
    assert "Synthetic" in rows[1]
    assert "CG-D-39-80, Table 3" in rows[1]


def test_us_units_are_for_reading():
    rows = table_text_of(TABLE, "csv", units="us").split("\r\n")
    assert rows[0].startswith("tension [lbf]")
    assert float(rows[2].split(",")[0]) == pytest.approx(1)


def test_json_has_null_for_what_is_not_known():
    document = json.loads(table_text_of(TABLE, "json"))
    assert document["values"]["apparent_spring_constant"] == [1.0, None]
    assert document["values"]["is_tested"] == [False, True]
    assert document["units"]["tension"] == "N"
    assert document["synthetic"] is True


def test_latex_escapes_and_markdown_has_a_row_a_point():
    text = table_text_of(TABLE, "latex")
    assert r"line \& more" in text
    assert r"B\_7 is open" in text
    assert r"4.4482216152605 &  & yes \\" in text
    rows = table_text_of(TABLE, "markdown").split("\n")
    assert "| 0 | 1 | no |" in rows
    assert "- Source: CG-D-39-80, Table 3" in rows


def test_markdown_lets_no_markup_through():
    hostile = "<img src=x onerror=alert(1)> a|b [go](javascript:1)"
    column = TableColumn("name", "", "name", np.array([hostile]))
    table = ValueTable(hostile, (column,), sources=(hostile,), notes=("two\n<b>lines",))
    text = table_text_of(table, "markdown")
    assert "<" not in text and "go](" not in text
    assert r"| &lt;img src=x onerror=alert(1)&gt; a\|b [go\](javascript:1) |" in text


def test_netcdf_keeps_values_units_and_sources(tmp_path):
    write_netcdf(TABLE, tmp_path / "t.nc")
    with xr.open_dataset(tmp_path / "t.nc") as found:
        np.testing.assert_array_equal(found["tension"], TABLE.columns[0].values)
        assert found["tension"].attrs["units"] == "N"
        assert found["is_tested"].attrs["flag_meanings"] == "no yes"
        assert found.attrs["source"] == "CG-D-39-80, Table 3"
        assert found.attrs["synthetic"] == "yes"


def test_a_curve_says_which_points_were_tested():
    one = line(
        strain=np.array([0.2, 0.3, 0.6]), tension=np.array([1.0, 2.0, 3.0]), tested=(0.2, 0.3)
    )
    table = curve_table(one)
    assert table.columns[2].values.tolist() == [False, True, True, False]
    assert "straight line from zero" in table.notes[-1]


def test_faults_are_named(tmp_path):
    short = TableColumn("strain", "1", "strain", np.array([0.0]))
    with pytest.raises(SettingsError, match="differ in length"):
        ValueTable("t", (*TABLE.columns, short), ("s",))
    (tmp_path / "folder.nc").mkdir()
    with pytest.raises(ArchiveError, match="cannot be written"):
        write_netcdf(TABLE, tmp_path / "folder.nc")


def test_what_a_table_is_stands_once_in_the_first_row():
    text = table_text_of(TABLE, "csv")
    first, second = csv.DictReader(io.StringIO(text, newline=""))
    assert (first["tension [N]"], second["tension [N]"]) == ("0", "4.4482216152605")
    assert "B_7 is open" in first["source"] and (second["what"], second["source"]) == ("", "")
    assert text.count("B_7 is open") == 1


def test_a_column_of_words_is_words_everywhere(tmp_path):
    words = TableColumn("piece", "", "which test", np.array(["", "T-6 cycles"]))
    load = TableColumn("tension", "N", "tension", np.array([0.0, 1.0]))
    table = ValueTable("t", (load, words), sources=("s",))
    assert table_text_of(table, "csv").split("\r\n")[2] == "1,T-6 cycles,,"
    assert json.loads(table_text_of(table, "json"))["values"]["piece"] == [None, "T-6 cycles"]
    assert "| 1 | T-6 cycles |" in table_text_of(table, "markdown")
    assert r"1 & T-6 cycles \\" in table_text_of(table, "latex")
    write_netcdf(table, tmp_path / "t.nc")
    with xr.open_dataset(tmp_path / "t.nc") as found:
        assert found["piece"].values.tolist() == ["", "T-6 cycles"]
        assert "units" not in found["piece"].attrs

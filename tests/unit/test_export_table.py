"""None"""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from export_lines import line

from reduction.lines.deck_formats import export_table
from reduction.lines.export_tables import (
    TableColumn,
    ValueTable,
    curve_table,
    format_of_file,
    table_of_difference,
    table_of_values,
    table_text_of,
    write_netcdf,
)
from reduction.lines.line_lookup import look_up
from reduction.lines.line_search import compare_values
from reduction.lines.lookup_product import LineCurve, LineSource
from reduction.lines.published_source import published_sources
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


# tables of design values: what stands in them, and that each format gives it back

LBF = 4.4482216152605
NAME = "polyester-double-braid-0.5in"
LEVELS = {
    "frequency": np.array([0.1, 0.3, 0.5]),
    "mean_tension": np.array([4000.0, 6000.0, 8400.0]),
    "tension_amplitude": np.array([2000.0, 2500.0, 3400.0]),
}


@pytest.fixture(scope="module")
def line_of_tables():
    return published_sources()[f"{NAME}-new"]


@pytest.fixture(scope="module")
def found(line_of_tables):
    return look_up(line_of_tables, "hysteresis_energy", **LEVELS)


@pytest.fixture(scope="module")
def table(line_of_tables, found):
    return table_of_values(line_of_tables, found, LEVELS)


def column(table, name):
    (one,) = (one for one in table.columns if one.name == name)
    return one


def test_levels_stand_in_si_and_in_percent_of_the_break_strength(table, line_of_tables):
    mean = column(table, "mean_tension")
    assert mean.unit == "N"
    assert mean.values.tolist() == [4000.0, 6000.0, 8400.0]
    # 6,400 lb: Table 2
    share = column(table, "mean_tension_percent_of_break_strength")
    assert share.unit == "%"
    assert share.values == pytest.approx(100 * mean.values / (6400 * LBF))
    peak = column(table, "peak_percent_of_break_strength").values
    assert peak == pytest.approx(100 * np.array([6000, 8500, 11800]) / (6400 * LBF))


def test_value_intervals_flags_and_errata_are_those_of_the_look_up(table, found):
    assert column(table, "hysteresis_energy").unit == "J m-1"
    for name, expected in (
        ("hysteresis_energy", found.value), ("interval_low", found.low),
        ("surface_interval_high", found.surface_high), ("is_untested", found.is_untested),
        ("is_inside", found.is_inside),
        ("is_slack", found.is_slack), ("is_below_zero", found.is_below_zero),
        ("peak_percent_of_break_strength_in_its_condition", 100 * found.own_peak_share),
        ("minimum_tension", found.minimum_tension),
    ):  # fmt: skip
        np.testing.assert_array_equal(column(table, name).values, expected)
    assert column(table, "interval_low").meaning.endswith("one more run of the same specimens")
    # Table 11 prints the column of another quantity: CG-5
    assert "errata that apply: CG-5" in table.sources[0]
    assert any(note.startswith("rule: peak at most 60 %") for note in table.notes)
    assert not table.is_synthetic


def test_what_is_known_of_other_lines_stands_where_it_is_known(line_of_tables, table):
    stiff = look_up(line_of_tables, "apparent_spring_constant", **LEVELS)
    known = table_of_values(line_of_tables, stiff, LEVELS)
    for name, expected in (
        ("line_interval_low", stiff.line_low), ("kind_interval_high", stiff.kind_high),
    ):  # fmt: skip
        np.testing.assert_array_equal(column(known, name).values, expected)
    # of hysteresis no report says how lines differ
    assert "line_interval_low" not in {one.name for one in table.columns}


def read_text(path, form):
    """Cells of a table, by heading."""
    text = path.read_text(encoding="utf-8")
    if form == "csv":
        rows = list(csv.reader(io.StringIO(text)))
        return rows[0][:-2], [row[:-2] for row in rows[1:]]
    if form == "markdown":
        rows = [row.strip("| ").split(" | ") for row in text.split("\n") if row.startswith("|")]
        return rows[0], rows[2:]
    rows = [row.removesuffix(r" \\").split(" & ") for row in text.split("\n") if " & " in row]
    return [head.replace("\\", "") for head in rows[0]], rows[1:]


@pytest.mark.parametrize("suffix", [".csv", ".tex", ".md"])
def test_a_text_gives_back_what_was_looked_up(table, tmp_path, suffix):
    path = tmp_path / f"values{suffix}"
    export_table(table, format_of_file(path), path)
    heads, rows = read_text(path, format_of_file(path))
    assert heads == [f"{one.name} [{one.unit}]" if one.unit else one.name for one in table.columns]
    assert len(rows) == 3
    for place, one in enumerate(table.columns):
        cells = [row[place] for row in rows]
        if one.values.dtype == np.bool_:
            assert cells == ["yes" if value else "no" for value in one.values]
        else:
            # 15 digits
            assert np.array(cells, dtype=float) == pytest.approx(one.values, rel=1e-14)
    assert "CG-5" in path.read_text(encoding="utf-8").replace("\\", "")


def test_json_gives_back_what_was_looked_up(table, tmp_path):
    path = tmp_path / "values.json"
    export_table(table, format_of_file(path), path)
    document = json.loads(path.read_text(encoding="utf-8"))
    for one in table.columns:
        assert document["values"][one.name] == one.values.tolist()
        assert document["units"].get(one.name, "") == one.unit
    assert "CG-5" in document["sources"][0]


def test_netcdf_gives_back_what_was_looked_up(table, tmp_path):
    path = tmp_path / "values.nc"
    export_table(table, format_of_file(path), path)
    with xr.open_dataset(path) as read:
        for one in table.columns:
            np.testing.assert_array_equal(read[one.name].to_numpy(), one.values)
            assert read[one.name].attrs.get("units", "") == one.unit
            assert read[one.name].attrs["long_name"]
        assert "CG-5" in read.attrs["source"]


def test_us_units_change_what_is_read_and_not_shares(table, tmp_path):
    export_table(table, "json", tmp_path / "us.json", units="us")
    document = json.loads((tmp_path / "us.json").read_text(encoding="utf-8"))
    assert document["units"]["hysteresis_energy"] == "ft lbf / ft"
    assert document["values"]["mean_tension"] == pytest.approx(
        np.array([4000, 6000, 8400]) / LBF, rel=1e-12
    )
    assert document["units"]["peak_percent_of_break_strength"] == "%"


def test_two_lines_stand_beside_each_other(line_of_tables, tmp_path):
    other = published_sources()[f"{NAME}-5-years"]
    levels = LEVELS | {"frequency": np.array(0.3)}
    values = [look_up(one, "apparent_spring_constant", **levels) for one in (line_of_tables, other)]
    difference = compare_values(*values)
    table = table_of_difference(line_of_tables, other, difference, levels, levels)
    assert column(table, "ratio").values == pytest.approx(values[1].value / values[0].value)
    assert column(table, "other_apparent_spring_constant").values.tolist() == (
        values[1].value.tolist()
    )
    for side, one in (("", values[0]), ("other_", values[1])):
        for flag in ("is_untested", "is_inside"):
            np.testing.assert_array_equal(column(table, f"{side}{flag}").values, getattr(one, flag))
    # one mean tension, of two break strengths: 6,400 and 7,000 lb
    share, other_share = (
        column(table, f"{which}mean_tension_percent_of_break_strength").values
        for which in ("", "other_")
    )
    assert share / other_share == pytest.approx(np.full(3, 7000 / 6400))
    assert column(table, "frequency").values.tolist() == [0.3] * 3
    assert len(table.sources) == 2
    assert all(note.startswith((line_of_tables.name, other.name)) for note in table.notes)
    export_table(table, "csv", tmp_path / "both.csv")
    assert (tmp_path / "both.csv").read_text().startswith("frequency [Hz],mean_tension [N],")


def test_what_is_made_says_so_and_shares_without_a_strength_are_left_out():
    curve = LineCurve("strain", "tension", 0.0, 100.0, coefficient=np.array([0.0, 0.01]))
    made = LineSource(
        "a", "b", "nylon", "", "", 0.012, float("nan"), curves=(curve,), linear_density=0.1,
        wet_linear_density=0.02, notes=("synthetic data",),
    )  # fmt: skip
    levels = {"tension": np.array([10.0, 20.0])}
    table = table_of_values(made, look_up(made, "strain", **levels), levels)
    assert table.is_synthetic
    assert "tension_percent_of_break_strength" not in [one.name for one in table.columns]
    assert "linear density in air 0.1 kg/m" in table.notes
    assert "linear density in water 0.02 kg/m" in table.notes


def test_a_table_says_of_which_branch_it_is():
    tether = published_sources()["rubber-tether-new-T-2"]
    found = look_up(tether, "tangent_modulus", strain=[0.7], branch="ascending")
    table = table_of_values(tether, found, {"strain": np.array([0.7])})
    assert table.title == "tangent_modulus of rubber-tether-new-T-2, ascending branch"


def test_faults_are_named_in_tables(line_of_tables, found):
    with pytest.raises(SettingsError, match=r"names no format; found values.xls; needed .csv, "):
        format_of_file(Path("values.xls"))
    with pytest.raises(SettingsError, match="levels of frequency are not those of the values"):
        table_of_values(line_of_tables, found, {"frequency": np.zeros(2)})

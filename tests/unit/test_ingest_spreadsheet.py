"""Sheets are written here cell by cell, so that what a cell holds is known."""

import datetime
import math
import zipfile
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
import pytest
import python_calamine
from measured_logs import LOGS, needs_measured_logs
from workbook import SheetError, write_xlsx

from reduction.readers.layout import Layout
from reduction.readers.spreadsheet import read_spreadsheet
from reduction.record.errors import LogError

RAW = Path(__file__).parents[2] / "raw"
TIME = {"column": "time", "unit": "s"}
LOAD = {"column": "load", "unit": "kN"}


def write_ods(path, rows):
    office = "urn:oasis:names:tc:opendocument:xmlns"
    cells = {
        str: lambda v: (
            f'<table:table-cell office:value-type="string"><text:p>{escape(v)}</text:p></table:table-cell>'
        ),
        float: lambda v: f'<table:table-cell office:value-type="float" office:value="{v!r}"/>',
    }
    body = "".join(
        f"<table:table-row>{''.join(cells[type(v)](v) for v in row)}</table:table-row>"
        for row in rows
    )
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        archive.writestr(
            "META-INF/manifest.xml",
            f'<manifest:manifest xmlns:manifest="{office}:manifest:1.0"></manifest:manifest>',
        )
        archive.writestr(
            "content.xml",
            f'<?xml version="1.0" encoding="UTF-8"?><office:document-content '
            f'xmlns:office="{office}:office:1.0" xmlns:table="{office}:table:1.0" '
            f'xmlns:text="{office}:text:1.0"><office:body><office:spreadsheet>'
            f'<table:table table:name="log">{body}</table:table></office:spreadsheet>'
            "</office:body></office:document-content>",
        )
    return path


def layout(**settings):
    channels = settings.pop("channels", {"time": TIME, "tension": {"1": LOAD}})
    return Layout.model_validate({"format": "spreadsheet", "channels": channels, **settings})


def read(tmp_path, rows, name="log.xlsx", **settings):
    path = write_xlsx(tmp_path / name, {"log": rows})
    return read_spreadsheet(path, layout(**settings), name=name)


HEAD = [["time", "load"]]
ROWS = [[0.0, 1.25], [0.5, 2.5], [1.0, 3.75]]


def test_columns_are_read_with_the_rows_of_the_sheet(tmp_path):
    log = read(tmp_path, HEAD + ROWS)
    np.testing.assert_array_equal(log.columns["time"], [0, 0.5, 1])
    np.testing.assert_array_equal(log.columns["tension.1"], [1.25, 2.5, 3.75])
    assert (log.first_row, log.n_rows_read, log.row) == (2, 3, None)
    assert log.source.name == "log.xlsx"
    assert log.metadata["sheet"] == "log"


def test_order_of_columns_does_not_matter(tmp_path):
    rows = [["load", "remark", "time"]] + [[b, "x", a] for a, b in ROWS]
    np.testing.assert_array_equal(read(tmp_path, rows).columns["time"], [0, 0.5, 1])


def test_preamble_is_kept_and_rows_count_from_the_top(tmp_path):
    rows = [["Operator:", "KH"], ["free text"], [None], ["time", "load"], ["(sec)", "kN"], *ROWS]
    log = read(tmp_path, rows, preamble_rows=3, has_unit_row=True)
    assert log.metadata == {"sheet": "log", "Operator": "KH", "row 2": "free text"}
    assert log.first_row == 6
    assert log.n_rows_read == 3


def test_the_table_of_a_sheet_ends_where_it_is_said_to(tmp_path):
    below = [[None, None], ["Maximum load", 3.75], [None, 7.0], ["Operator: KH", None]]
    log = read(tmp_path, [*HEAD, *ROWS, *below], ends_at="Maximum")
    assert log.columns["tension.1"].tolist() == [1.25, 2.5, 3.75]
    assert log.metadata == {
        "sheet": "log", "Maximum load": "3.75", "row 7": "7.0", "row 8": "Operator: KH",
    }  # fmt: skip
    with pytest.raises(LogError, match=r":6 \[time\].*found the text 'Maximum load'.*ends_at"):
        read(tmp_path, [*HEAD, *ROWS, *below])


def test_preamble_keys_that_come_twice_keep_their_rows(tmp_path):
    rows = [["Note", "a"], ["Note", "b"], *HEAD, *ROWS]
    log = read(tmp_path, rows, preamble_rows=2)
    assert log.metadata["Note (row 2)"] == "b"


def test_columns_may_be_numbers_where_there_are_no_names(tmp_path):
    channels = {"time": {"column": 1, "unit": "s"}, "tension": {"1": {"column": 2, "unit": "kN"}}}
    log = read(tmp_path, ROWS, channels=channels, has_name_row=False)
    np.testing.assert_array_equal(log.columns["tension.1"], [1.25, 2.5, 3.75])
    assert log.first_row == 1


def test_a_table_that_starts_below_and_right_of_a1_is_found(tmp_path):
    rows = [[None], [None], [None, None, "time", "load"]] + [[None, None, *row] for row in ROWS]
    log = read(tmp_path, rows, preamble_rows=2)
    np.testing.assert_array_equal(log.columns["time"], [0, 0.5, 1])
    assert log.first_row == 4


def test_whole_numbers_and_small_numbers_come_back_exactly(tmp_path):
    log = read(tmp_path, [*HEAD, [0, 1.2345678901234e-7], [1, 3], [2, -1e300]])
    assert log.columns["tension.1"].tolist() == [1.2345678901234e-7, 3.0, -1e300]
    assert log.columns["tension.1"].dtype == np.float64


def test_blank_cells_inside_are_missing_and_at_the_end_are_left_out_with_a_note(tmp_path):
    rows = [*HEAD, [0.0, 1.0], [0.5, None], [1.0, 2.0], [None, None, "end of log"]]
    log = read(tmp_path, rows)
    assert log.n_rows_read == 3
    assert log.missing("tension.1").tolist() == [False, True, False]
    assert tuple(map(str, log.notes)) == ("1 blank rows at the end of the sheet are ignored",)


def test_a_blank_cell_is_an_error_where_it_is_no_missing_mark(tmp_path):
    with pytest.raises(LogError, match=r"log\.xlsx:3 \[load\]: 1 cells are blank"):
        read(tmp_path, [*HEAD, [0.0, 1.0], [0.5, None], [1.0, 2.0]], missing=["NaN"])


def test_declared_missing_marks_are_missing(tmp_path):
    rows = [*HEAD, [0.0, "ovrflw"], [0.5, SheetError("#N/A")], [1.0, -9999.0], [1.5, " "], [2, 4]]
    log = read(tmp_path, rows, missing=["", "ovrflw", "#N/A", "-9999"])
    assert log.columns["tension.1"].tolist()[-1] == 4.0
    assert log.missing("tension.1").tolist() == [True, True, True, True, False]


@pytest.mark.parametrize(
    ("cell", "found"),
    [
        ("ovrflw", "found the text 'ovrflw'"),
        ("12.5", "found the text '12.5'"),
        (True, "found bool True"),
        (datetime.date(2020, 1, 2), "found date 2020-01-02"),
        (SheetError("#DIV/0!"), "found the text '#DIV/0!'"),
    ],
)
def test_what_is_no_number_is_an_error_with_its_row(tmp_path, cell, found):
    with pytest.raises(LogError) as caught:
        read(tmp_path, [*HEAD, [0.0, 1.0], [0.5, cell], [1.0, 2.0]])
    assert found in str(caught.value)
    assert "a cell does not hold a number" in str(caught.value)
    assert (caught.value.row, caught.value.channel) == (3, "load")


def test_text_in_a_column_that_is_not_declared_does_not_matter(tmp_path):
    rows = [["time", "load", "remark"], [0.0, 1.0, None], [0.5, 2.0, "slip"], [1.0, 3.0, True]]
    assert read(tmp_path, rows).n_rows_read == 3


def test_numbers_beside_an_odd_cell_are_exact(tmp_path):
    rows = [*HEAD, [0.1, 1.2345678901234567], ["x", 2.0], [0.3, 3.0]]
    log = read(tmp_path, rows, missing=["x"])
    assert log.columns["tension.1"][0] == 1.2345678901234567
    assert math.isnan(log.columns["time"][1])


def test_a_clock_becomes_elapsed_time(tmp_path):
    rows = [["time", "load"], [datetime.time(9, 45), 1.0], [datetime.time(10, 0), 2.0]]
    channels = {"time": {"column": "time", "unit": "clock"}, "tension": {"1": LOAD}}
    log = read(tmp_path, rows, channels=channels)
    assert log.columns["time"].tolist() == [0.0, 900.0]
    assert log.text["time"] == ("09:45:00", "10:00:00")


def test_a_clock_of_four_digits_becomes_elapsed_time(tmp_path):
    channels = {"time": {"column": "time", "unit": "clock"}, "tension": {"1": LOAD}}
    log = read(tmp_path, [["time", "load"], [945, 1.0], [1000, 2.0]], channels=channels)
    assert log.columns["time"].tolist() == [0.0, 900.0]


def test_dates_of_a_sheet_are_read_in_the_order_of_the_layout(tmp_path):
    time = {"column": "time", "unit": "clock", "date_order": "day first"}
    rows = [["time", "load"], ["30/09/05 23:59", 1.0], ["01/10/05 00:00", 2.0]]
    log = read(tmp_path, rows, channels={"time": time, "tension": {"1": LOAD}})
    assert log.columns["time"].tolist() == [0.0, 60.0]


def test_sheets_are_given_by_name_or_number(tmp_path):
    path = write_xlsx(tmp_path / "b.xlsx", {"notes": [["x"]], "T-1": HEAD + ROWS})
    for sheet in ("T-1", 2):
        assert read_spreadsheet(path, layout(sheet=sheet), name="b").n_rows_read == 3


@pytest.mark.parametrize("sheet", ["T-2", 3, 0])
def test_a_sheet_that_is_not_there_lists_those_that_are(tmp_path, sheet):
    path = write_xlsx(tmp_path / "b.xlsx", {"notes": [["x"]], "T-1": HEAD + ROWS})
    with pytest.raises(LogError, match=r"there is no sheet .*'notes', 'T-1'.*from 1 to 2"):
        read_spreadsheet(path, layout(sheet=sheet), name="b")


def test_a_missing_column_lists_what_there_is(tmp_path):
    with pytest.raises(LogError, match=r":1 \[tension\.1\].*'load' is not in sheet 'log'.*'force'"):
        read(tmp_path, [["time", "force"], *ROWS])


def test_a_unit_row_that_disagrees_is_an_error(tmp_path):
    with pytest.raises(LogError, match=r":2 \[load\]: the unit in the file is not.*'N'.*'kN'"):
        read(tmp_path, [*HEAD, ["s", "N"], *ROWS], has_unit_row=True)


def test_a_unit_in_a_name_that_disagrees_is_an_error(tmp_path):
    channels = {"time": TIME, "tension": {"1": {"column": "load (N)", "unit": "kN"}}}
    with pytest.raises(LogError, match="the unit in the column's name is not the declared one"):
        read(tmp_path, [["time", "load (N)"], *ROWS], channels=channels)


@pytest.mark.parametrize("rows", [HEAD, [], [["time", "load"], [None, None, "remark"]]])
def test_a_sheet_without_data_is_an_error(tmp_path, rows):
    with pytest.raises(LogError, match="no data rows"):
        read(tmp_path, rows)


@pytest.mark.parametrize("content", [b"garbage" * 100, b"PK\x03\x04" + b"x" * 500])
def test_a_file_that_is_no_workbook_is_an_error(tmp_path, content):
    path = tmp_path / "log.xlsx"
    path.write_bytes(content)
    with pytest.raises(LogError, match="not a spreadsheet that can be read"):
        read_spreadsheet(path, layout(), name="log.xlsx")


def test_a_truncated_workbook_is_an_error(tmp_path):
    path = write_xlsx(tmp_path / "log.xlsx", {"log": HEAD + ROWS})
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(LogError, match="not a spreadsheet that can be read"):
        read_spreadsheet(path, layout(), name="log.xlsx")


def test_a_workbook_whose_checksums_disagree_is_an_error(tmp_path):
    path = write_xlsx(tmp_path / "log.xlsx", {"log": HEAD + ROWS})
    path.write_bytes(path.read_bytes().replace(b"<v>1.25</v>", b"<v>7.25</v>"))
    with pytest.raises(
        LogError, match=r"the workbook is damaged; found .*xl/worksheets/sheet1\.xml"
    ):
        read_spreadsheet(path, layout(), name="log.xlsx")


def rewritten(tmp_path, old, new):
    write_xlsx(tmp_path / "whole.xlsx", {"log": HEAD + ROWS})
    path = tmp_path / "log.xlsx"
    with zipfile.ZipFile(tmp_path / "whole.xlsx") as whole, zipfile.ZipFile(path, "w") as other:
        for name in whole.namelist():
            other.writestr(name, whole.read(name).replace(old, new))
    return path


@pytest.mark.parametrize("cell", [b'<c r="A2"', b'<c r="B4"'])
def test_a_cell_of_a_text_that_is_not_there_is_an_error(tmp_path, cell):
    path = rewritten(tmp_path, cell, cell + b' t="s"')
    with pytest.raises(LogError, match="sheet 1 cannot be read"):
        read_spreadsheet(path, layout(), name="log.xlsx")


@pytest.mark.parametrize("new", [b"<v>1.25<v>", b"<v>1.25</v", b"<v>1.25</row>"])
def test_markup_that_lost_a_letter_is_an_error_and_no_blank(tmp_path, new):
    path = rewritten(tmp_path, b"<v>1.25</v>", new)
    with pytest.raises(
        LogError, match=r"the workbook is damaged; found xl/worksheets/sheet1\.xml: "
    ):
        read_spreadsheet(path, layout(), name="log.xlsx")


def test_an_infinite_number_is_refused_with_its_row(tmp_path):
    path = rewritten(tmp_path, b"<v>2.5</v>", b"<v>inf</v>")
    with pytest.raises(LogError, match=r"log\.xlsx:3 \[load\]: a cell does not hold a number"):
        read_spreadsheet(path, layout(), name="log.xlsx")


def test_a_sheet_that_cannot_be_read_cell_by_cell_is_an_error(tmp_path, monkeypatch):
    def fail(path):
        raise python_calamine.CalamineError("no such cell")

    monkeypatch.setattr("python_calamine.CalamineWorkbook.from_filelike", fail)
    with pytest.raises(LogError, match="sheet 1 cannot be read; found no such cell"):
        read(tmp_path, [*HEAD, [0.0, "x"]], missing=["x"])


def test_an_empty_file_is_an_error(tmp_path):
    (tmp_path / "log.xlsx").touch()
    with pytest.raises(LogError, match="empty"):
        read_spreadsheet(tmp_path / "log.xlsx", layout(), name="log.xlsx")


def test_open_document_sheets_are_read(tmp_path):
    path = write_ods(tmp_path / "log.ods", HEAD + ROWS)
    log = read_spreadsheet(path, layout(), name="log.ods")
    np.testing.assert_array_equal(log.columns["tension.1"], [1.25, 2.5, 3.75])


@needs_measured_logs
def test_the_zwick_workbook_is_read_sheet_by_sheet():
    channels = {
        "time": {"column": "Test time", "unit": "s"},
        "crosshead_position": {"column": "Tool separation", "unit": "mm", "datum": "pin-to-pin"},
        "tension": {"1": {"column": "Standard force", "unit": "mN"}},
    }
    path = LOGS / "knit-yarn" / "compressionTests.xls"
    last = {}
    for number, rows in enumerate((872, 484, 398, 347, 645, 598, 822), start=2):
        made = layout(sheet=number, preamble_rows=1, has_unit_row=True, channels=channels)
        log = read_spreadsheet(path, made, name=path.name)
        assert log.n_rows_read == rows
        assert log.first_row == 4
        last[log.metadata["sheet"]] = log.columns["tension.1"][-1]
    # the machine stopped each test at a force of 3 N
    assert {name: round(force, -1) for name, force in last.items()} == dict.fromkeys(last, 3000)
    assert next(iter(last)) == "cotton-1"


def test_a_workbook_is_known_by_its_contents(tmp_path):
    rows = [["time", "load"], *([i / 10, 2.0 * i] for i in range(5))]
    assert read(tmp_path, rows, name="log.xls").n_rows_read == 5


@needs_measured_logs
def test_the_zwick_unit_row_is_checked():
    channels = {"tension": {"1": {"column": "Standard force", "unit": "N"}}}
    made = layout(sheet="cotton-1", preamble_rows=1, has_unit_row=True, channels=channels)
    with pytest.raises(LogError, match=r"xls:3 \[Standard force\].*'mN'"):
        read_spreadsheet(LOGS / "knit-yarn" / "compressionTests.xls", made, name="x")


def test_a_workbook_and_the_text_of_one_test_agree(tmp_path):
    channels = {
        "time": {"column": "time_s", "unit": "s"},
        "tension": {"1": {"column": "load_new_lb", "unit": "lbf"}},
    }
    text = np.loadtxt(RAW / "tmt-synthetic" / "T-6.csv", delimiter=",", skiprows=3)
    names = ["time_s", "crosshead_ft", "load_new_lb", "load_used_lb"]
    path = write_xlsx(tmp_path / "logs.xlsx", {"empty": [], "T-6": [names, *text.tolist()]})
    log = read_spreadsheet(path, layout(sheet="T-6", channels=channels), name="logs.xlsx")
    np.testing.assert_array_equal(log.columns["time"], text[:, 0])
    np.testing.assert_array_equal(log.columns["tension.1"], text[:, 2])

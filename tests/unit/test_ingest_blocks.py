import pytest

from reduction.readers.blocks import read_blocks
from reduction.readers.layout import Layout
from reduction.record.errors import LogError

CHANNELS = {
    "time": {"column": "Time", "unit": "s"},
    "crosshead_position": {"column": "Axial Displacement", "unit": "mm", "datum": "displacement"},
    "tension.1": {"column": "Axial Force", "unit": "kN", "sign": -1},
    "cycle_counter": {"column": "Axial Count"},
}
US = "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A"
GERMAN = "MTS793|MPT|DEU|1|2|,|.|:|49|1|1|A"
NAMES = "Time\tAxial Count\tAxial Displacement\tAxial Force"
UNITS = "Sec\tcycles\tmm\tkN"
OPENER = "Data Acquisition\t\t\t\tTime:\t10.0\tSec\t11/21/2026 7:28:27 AM"


def layout(**settings):
    settings = {"delimiter": "\t", "has_unit_row": True, "block_marker": "Data Acq"} | settings
    return Layout(format="blocks", channels=CHANNELS, **settings)


@pytest.fixture
def read(tmp_path):
    def read_lines(*lines, end="\n", **settings):
        path = tmp_path / "specimen.dat"
        path.write_bytes(end.join(lines).encode())
        return read_blocks(path, layout(**settings), name="specimen.dat")

    return read_lines


def block(*rows, opener=OPENER, names=NAMES, units=UNITS):
    return [opener, names, units, *rows, ""]


def test_ragged_blocks_become_one_log(read):
    log = read(US, "", *block("0.1\t1\t2\t-3", "0.2\t1\t2.5\t-4"), *block("0.3\t2\t2\t-3"))
    assert log.columns["time"].tolist() == [0.1, 0.2, 0.3]
    assert log.columns["tension.1"].tolist() == [-3.0, -4.0, -3.0]
    assert log.columns["cycle_counter"].tolist() == [1.0, 1.0, 2.0]
    assert log.row.tolist() == [6, 7, 12]
    assert (log.n_rows_read, log.first_row) == (3, 6)
    assert tuple(map(str, log.notes)) == ("2 blocks of data read",)


def test_the_decimal_mark_is_the_one_of_the_first_line(read):
    log = read(GERMAN, *block("0,1\t1\t1.234,5\t-3"), thousands=".")
    assert log.columns["crosshead_position"].tolist() == [1234.5]


def test_crlf_and_a_missing_last_line_end_are_read(read):
    log = read(US, *block("0.1\t1\t2\t-3")[:-1], end="\r\n")
    assert log.columns["tension.1"].tolist() == [-3.0]


def test_lines_between_the_blocks_are_metadata(read):
    log = read(
        US, "Operator\tKh", "", *block("0.1\t1\t2\t-3"), "Paused at 12:00", *block("0.2\t1\t2\t-3")
    )
    assert log.metadata["Operator"] == "Kh"
    assert log.metadata["row 9"] == "Paused at 12:00"
    assert log.metadata["row 1"] == US
    assert log.metadata["Data Acquisition"].startswith("Time: 10.0 Sec")


def test_more_than_two_hundred_loose_lines_are_counted_not_kept(read):
    log = read(US, *(f"line {i}" for i in range(250)), *block("0.1\t1\t2\t-3"))
    assert "51 further lines between the blocks are not stored" in tuple(map(str, log.notes))


def test_blocks_of_another_kind_are_counted_in_a_note(read):
    peaks = block("1\t2", "3\t4", names="Count\tPeak", units="cycles\tkN")
    log = read(US, *peaks, *block("0.1\t1\t2\t-3"), *peaks)
    assert log.n_rows_read == 1
    assert tuple(map(str, log.notes)) == (
        "1 blocks of data read",
        "2 blocks of another kind with 4 rows are not read, the first at row 2",
    )


def test_text_in_a_number_names_the_row_of_the_file(read):
    with pytest.raises(LogError, match=r"specimen\.dat:11 \[Axial Force\]: .*found 'ovrflw'"):
        read(US, "", *block("0.1\t1\t2\t-3"), *block("0.2\t1\t2\tovrflw"))


def test_a_missing_mark_at_the_start_of_a_row_does_not_hide_it(read):
    log = read(US, *block("NaN\t1\t2\t-3", "0.1\t1\t2\t-3"))
    assert log.n_rows_read == 2


def test_a_row_that_is_cut_off_is_refused(read):
    with pytest.raises(LogError, match=r":6: a row has 2 fields where the first has 4"):
        read(US, *block("0.1\t1\t2\t-3", "0.2\t1")[:-1])


def test_a_first_line_without_decimal_mark_is_refused(read):
    with pytest.raises(LogError, match=r"specimen\.dat:1: the first line does not state a decimal"):
        read("MTS793|MPT|ENU", *block("0.1\t1\t2\t-3"))


def test_a_decimal_mark_that_contradicts_the_layout_is_refused(read):
    with pytest.raises(
        LogError, match="the file states another decimal mark.*found ','; needed '.'"
    ):
        read(GERMAN, *block("0,1\t1\t2\t-3"), decimal=".")


def test_blocks_without_an_mts_line_use_the_declared_decimal_mark(read):
    log = read("Logger 7", *block("0,1\t1\t2\t-3"), decimal=",")
    assert log.columns["time"].tolist() == [0.1]


@pytest.mark.parametrize("marker", ["Datenerfassung", ""])
def test_a_file_without_blocks_is_refused(read, marker):
    with pytest.raises(LogError, match="there is no block of data.*Set block_marker"):
        read(US, *block("0.1\t1\t2\t-3"), block_marker=marker)


def test_headers_without_rows_are_refused(read):
    with pytest.raises(LogError, match="there are no data rows; found headers only"):
        read(US, *block())


def test_a_missing_column_names_the_header_of_the_first_block(read):
    with pytest.raises(
        LogError, match=r":3 \[tension\.1\]: column 'Axial Force' is not in the block"
    ):
        read(US, *block("0.1\t1\t2\t-3", names=NAMES.replace("Force", "Load")))


def test_a_unit_row_that_contradicts_the_layout_is_refused(read):
    with pytest.raises(LogError, match=r":4 \[Axial Force\]: the unit in the file.*found 'N'"):
        read(US, *block("0.1\t1\t2\t-3", units="Sec\tcycles\tmm\tN"))


def test_four_thousand_ragged_blocks_keep_every_row_in_order(tmp_path):
    counts = [49 + number % 3 for number in range(4000)]
    lines = [US, ""]
    for number, count in enumerate(counts):
        lines += block(*(f"{number + i / 100:.3f}\t{number}\t{i}.5\t-1.25" for i in range(count)))
    path = tmp_path / "specimen.dat"
    path.write_text("\n".join(lines))
    log = read_blocks(path, layout(), name="x")
    assert log.columns["cycle_counter"].tolist() == [
        number for number, count in enumerate(counts) for _ in range(count)
    ]
    assert log.row[-1] == len(lines) - 1

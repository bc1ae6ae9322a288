import tracemalloc

import numpy as np
import pytest

from reduction.readers.layout import Layout, LogParts
from reduction.readers.read_log import read_log
from reduction.readers.text_rows import open_text
from reduction.record import samples as scratch
from reduction.record.errors import DataError, LogError

CHANNELS = {
    "time": {"column": "t", "unit": "s"},
    "tension.1": {"column": "F", "unit": "N"},
}
LENGTHS = [1, 5, 7, 100, 1 << 20]


def read(path, content, n_bytes=16, in_memory=0, **settings):
    path = path / "log.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    layout = Layout(format="delimited", channels=CHANNELS, **settings)
    parts = LogParts(in_memory=in_memory, n_bytes=n_bytes, folder=path.parent)
    return read_log(path, layout, name="log.csv", parts=parts)


def lines_of(path, content, n_bytes, encoding="utf-8"):
    path = path / "log.csv"
    path.write_bytes(content)
    with open_text(path, encoding, LogParts(n_bytes=n_bytes)) as file:
        return [(bytes(part.text), part.first_row, part.n_lines, part.is_open) for part in file]


def test_parts_are_whole_lines_and_blank_ones_go_over_to_the_next(tmp_path):
    assert lines_of(tmp_path, b"ab\ncd\n\n\nef\ngh", 8) == [
        (b"ab\ncd", 1, 2, False),
        (b"\n\nef\ngh", 3, 4, True),
    ]


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_a_line_feed_is_never_parted_from_its_carriage_return(tmp_path, n_bytes):
    found = lines_of(tmp_path, b"ab\r\ncd\r\nef\r\n", n_bytes)
    assert sum(n_lines for _, _, n_lines, _ in found) == 3
    assert b"\n".join(text for text, *_ in found).replace(b"\r", b"") == b"ab\ncd\nef"


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_the_end_mark_of_dos_is_text_where_more_follows(tmp_path, n_bytes):
    parts = lines_of(tmp_path, b"ab\n\x1a\ncd\n\x1a\n\n\x1a", n_bytes)
    assert b"\n".join(text for text, *_ in parts) == b"ab\n\x1a\ncd"


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_characters_of_many_bytes_straddle_parts(tmp_path, n_bytes):
    for encoding in ("utf-8", "utf-16", "shift_jis", "gb18030"):
        parts = lines_of(tmp_path, "時間\n張力\n".encode(encoding), n_bytes, encoding)
        assert b"\n".join(text for text, *_ in parts).decode() == "時間\n張力"


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_a_preamble_may_be_longer_than_a_part(tmp_path, n_bytes):
    preamble = "".join(f"Setting {number}: on\n" for number in range(40))
    log = read(tmp_path, f"{preamble}t,F\n0,1\n1,2\n", n_bytes, preamble_rows=40)
    assert log.metadata["Setting 39"] == "on"
    assert (log.first_row, log.columns["tension.1"].tolist()) == (42, [1.0, 2.0])


@pytest.mark.parametrize("n_bytes", LENGTHS)
@pytest.mark.parametrize(
    "below", ["Maximum,2\nat,1\n", "Maximum\n2\n", '\n"Maximum of F",2,N,kept\n\nat,1', "Maximum,2"]
)
def test_the_table_ends_where_it_is_said_to_whatever_stands_below(tmp_path, n_bytes, below):
    content = f"Maximum: of what\nt,F\n0,1\n1,2\n2,3\n{below}"
    log = read(tmp_path, content, n_bytes, preamble_rows=1, ends_at="Maximum")
    assert (log.n_rows_read, log.columns["tension.1"].tolist()) == (3, [1.0, 2.0, 3.0])
    assert len(log.metadata) == 1 + len(list(filter(None, below.split("\n"))))


@pytest.mark.parametrize(
    ("row", "name"), [("Maximum,2", "Maximum"), ("End of test", "End of test")]
)
def test_words_below_the_table_are_refused_with_what_to_set(tmp_path, row, name):
    with pytest.raises(LogError, match=rf'^.*log.csv:4.* above this line, set ends_at = "{name}"'):
        read(tmp_path, f"t,F\n0,1\n1,2\n{row}\n")


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_rows_are_counted_from_the_first_part_in_which_they_are_not_consecutive(tmp_path, n_bytes):
    log = read(tmp_path, "t,F\n0,1\n1,2\n# pause\n2,3\n\n3,4\n", n_bytes, comment="#")
    assert log.row.tolist() == [2, 3, 5, 7]
    assert log.metadata == {"row 4": "pause"}


@pytest.mark.parametrize("n_bytes", LENGTHS)
@pytest.mark.parametrize("last", ["", "\n  ", "\r\n \t\r\n", "\n#\n "])
def test_lines_of_blanks_are_no_rows_where_blanks_part_the_fields(tmp_path, n_bytes, last):
    content = "t F\n0 1\n  \n \n1  2\n\t\n 2 3" + last
    log = read(tmp_path, content, n_bytes=n_bytes, delimiter=" ", comment="#")
    np.testing.assert_array_equal(log.columns["tension.1"], [1, 2, 3])
    assert log.row.tolist() == [2, 5, 7]


def test_a_row_that_is_cut_off_is_told_as_such_only_where_it_is_the_last_line(tmp_path):
    with pytest.raises(LogError, match="a row has 1 fields") as found:
        read(tmp_path, "t F\n0 1\n1\n  ", delimiter=" ")
    assert "cut off" not in str(found.value)


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_a_byte_order_mark_within_a_file_is_part_of_its_field_wherever_parts_begin(
    tmp_path, n_bytes
):
    with pytest.raises(LogError, match=r":4 \[t\]: a value is not a number; found .*feff2"):
        read(tmp_path, "t,F\n0,1\n1,2\n\ufeff2,3\n3,4\n", n_bytes=n_bytes)


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_an_odd_field_is_told_with_the_row_of_the_file(tmp_path, n_bytes):
    rows = [f"{number},{number}" for number in range(300)]
    rows[250] = "250,ovrflw"
    with pytest.raises(LogError, match=r"log\.csv:252 \[F\]: a value is not a number; found 'ovr"):
        read(tmp_path, "t,F\n" + "\n".join(rows), n_bytes)


@pytest.mark.parametrize("n_bytes", LENGTHS)
def test_the_first_of_many_faults_is_told(tmp_path, n_bytes):
    content = b"t,F\n0,1\n1,x\n2\ny,3\n\xff,4\n5,\0\n"
    rows = content.split(b"\n")
    for row, what in [
        (3, "not a number; found 'x'"), (4, "a row has 1 fields"), (5, "not a number; found 'y'"),
        (6, "not in the declared encoding"),
    ]:  # fmt: skip
        with pytest.raises(LogError, match=rf"log\.csv:{row}.*{what}"):
            # NUL bytes at the beginning of a file say that it is binary, whatever else is wrong
            read(tmp_path, b"\n".join(rows[:-2]) + b"\n" * 70_000 + b"5,\0\n", max(n_bytes, 5))
        rows[row - 1] = b"7,7"


def test_a_nul_far_down_is_told_with_its_row(tmp_path):
    rows = b"0,1\n" * 20_000
    for n_bytes in (1000, 1 << 20):
        with pytest.raises(LogError, match=r"log\.csv:20002: the file is binary, not text"):
            read(tmp_path, b"t,F\n" + rows + b"0,\0\n" + rows, n_bytes)


@pytest.mark.parametrize("n_bytes", [100_000, 8 << 20])
@pytest.mark.parametrize("end", [b"", b"\n1,2\n"])
def test_a_line_of_more_than_a_million_bytes_is_refused(tmp_path, n_bytes, end):
    content = b"t,F\n0,1\n" + b"0" * 4_000_000 + end
    with pytest.raises(LogError, match=r"log\.csv:3: a line is too long to be a row of a log; fou"):
        read(tmp_path, content, n_bytes)


def test_a_file_that_grows_while_it_is_read_in_parts_is_refused(tmp_path, monkeypatch):
    from reduction.readers import delimited

    whole = delimited.read_fields

    def growing(*arguments):
        with (tmp_path / "log.csv").open("ab") as stream:
            stream.write(b"5,6\n")
        return whole(*arguments)

    monkeypatch.setattr(delimited, "read_fields", growing)
    with pytest.raises(LogError, match=r"the file grew while it was read; found 16 bytes, then"):
        read(tmp_path, "t,F\n0,1\n1,2\n2,3\n", 5)


def test_a_file_that_shrinks_is_told_before_the_row_that_it_cut_off(tmp_path, monkeypatch):
    from reduction.readers import delimited

    content = b"t,F\n" + b"0,1\n" * 60_000
    whole = delimited.read_fields

    def shrinking(*arguments):
        with (tmp_path / "log.csv").open("rb+") as stream:
            stream.truncate(150_001)
        return whole(*arguments)

    monkeypatch.setattr(delimited, "read_fields", shrinking)
    with pytest.raises(LogError, match=r"the file shrank while it was read; found 240004 bytes"):
        read(tmp_path, content, 10_000)


def test_columns_of_a_long_log_lie_on_disk_and_those_of_a_short_one_do_not(tmp_path):
    content = "t,F\n" + "0,1\n" * 1000
    for in_memory, on_disk in ((0, True), (1 << 20, False)):
        log = read(tmp_path, content, 512, in_memory)
        assert [scratch._is_on_disk(values) for values in log.columns.values()] == [on_disk] * 2


@pytest.mark.parametrize("content", ["t,F\n" + "0,1\n" * 200, "t,F\n" + "0,1\n\n" * 200])
def test_a_disk_that_fills_while_a_log_is_read_is_told(tmp_path, monkeypatch, content):
    def full(writer, values):
        raise DataError("the scratch files of a long log do not fit on the disk")

    monkeypatch.setattr(scratch.ColumnWriter, "append", full)
    with pytest.raises(DataError, match="do not fit on the disk"):
        read(tmp_path, content)


def test_a_log_four_times_as_long_takes_no_more_memory(tmp_path):
    rng = np.random.default_rng(1)

    def peak(n_rows):
        rows = np.column_stack([np.arange(n_rows), rng.normal(size=n_rows)])
        path = tmp_path / f"{n_rows}.csv"
        np.savetxt(path, rows, "%.4f", ",", header="t,F", comments="")
        layout = Layout(format="delimited", channels=CHANNELS)
        parts = LogParts(in_memory=0, n_bytes=1 << 16, folder=tmp_path)
        tracemalloc.start()
        log = read_log(path, layout, name="x", parts=parts)
        found = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert log.n_rows_read == n_rows
        return found

    peak(1000)  # what is made once
    # 0.7 MB, 2.8 MB of text; what other threads take meanwhile is not of the log, and is a quarter
    # of what a log that is held whole would take more
    short, long = (min(peak(n_rows) for _ in range(3)) for n_rows in (40_000, 160_000))
    assert long < short + 500_000

import numpy as np
import pytest

from reduction.readers.delimited import read_delimited
from reduction.readers.layout import Layout
from reduction.readers.read_log import read_log
from reduction.record.errors import LogError

CHANNELS = {
    "time": {"column": "t", "unit": "s"},
    "crosshead_position": {"column": "x", "unit": "mm", "datum": "pin-to-pin"},
    "tension.1": {"column": "F", "unit": "N"},
}


def layout(channels=None, **settings):
    return Layout(format="delimited", channels=channels or CHANNELS, **settings)


@pytest.fixture
def read(tmp_path):
    def read_text(text, channels=None, **settings):
        path = tmp_path / "log.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_delimited(path, layout(channels, **settings), name="log.csv")

    return read_text


def test_declared_columns_are_read_by_name_whatever_their_order(read):
    log = read("F,unused,t,x\n1,a,0,10\n2,b,0.1,11\n")
    assert {key: column.tolist() for key, column in log.columns.items()} == {
        "time": [0.0, 0.1],
        "crosshead_position": [10.0, 11.0],
        "tension.1": [1.0, 2.0],
    }
    assert (log.n_rows_read, log.first_row, log.row) == (2, 2, None)


def test_columns_are_read_by_number_where_they_have_no_name(read):
    channels = {
        "crosshead_position": {"column": 2, "unit": "mm", "datum": "displacement"},
        "tension.1": {"column": 1, "unit": "N"},
    }
    log = read("1;2\n3;4\n", channels, delimiter=";", has_name_row=False, sample_interval="1 s")
    assert log.columns["crosshead_position"].tolist() == [2.0, 4.0]
    assert log.first_row == 1


def test_decimal_comma_thousands_and_semicolons(read):
    log = read(
        "t;x;F\n0,5;1.234,5;-12.345.678\n1,5;10;+1,5e3\n", delimiter=";", decimal=",", thousands="."
    )
    assert log.columns["crosshead_position"].tolist() == [1234.5, 10.0]
    assert log.columns["tension.1"].tolist() == [-12345678.0, 1500.0]


def test_a_thousands_mark_that_is_a_decimal_point_is_refused(read):
    with pytest.raises(LogError, match=r"log\.csv:3 \[F\]: a value is not a number; found '1\.5'"):
        read("t;x;F\n0;1;1.500\n1;1;1.5\n", delimiter=";", decimal=",", thousands=".")


def test_crlf_cr_and_a_missing_last_line_end_read_alike(read):
    for end in ("\n", "\r\n", "\r"):
        for last in (end, ""):
            log = read(end.join(["t,x,F", "0,1,2", "1,2,3"]) + last)
            assert log.columns["tension.1"].tolist() == [2.0, 3.0]
            assert log.row is None


def test_blanks_and_tabs_part_fields_where_the_delimiter_is_a_blank(read):
    log = read("  t    x\tF  \n 0.0   1.0  2.0\n 1.0\t 2.0   3.0 \n", delimiter=" ")
    assert log.columns["tension.1"].tolist() == [2.0, 3.0]


def test_tab_and_quotes(read):
    log = read('"t"\t"x"\t"F"\n"0"\t1\t"2.5"\n', delimiter="\t")
    assert log.columns["tension.1"].tolist() == [2.5]


def test_trailing_delimiters_of_header_or_rows_are_no_fields(read):
    for header, row in [("t,x,F,", "0,1,2,"), ("t,x,F", "0,1,2,"), ("t,x,F,", "0,1,2")]:
        assert read(f"{header}\n{row}\n").columns["tension.1"].tolist() == [2.0]


def test_a_byte_order_mark_is_no_part_of_the_first_name(read):
    assert read("\ufefft,x,F\n0,1,2\n").columns["time"].tolist() == [0.0]


def test_latin1_names_are_found_and_kept(read):
    channels = CHANNELS | {"time": {"column": "Prüfzeit", "unit": "s"}}
    text = "Prüfer,Käthe\nPrüfzeit,x,F\n0,1,2\n".encode("latin-1")
    log = read(text, channels, encoding="latin-1", preamble_rows=1)
    assert log.metadata == {"Prüfer": "Käthe"}


def test_preamble_and_comments_are_kept_as_metadata(read):
    log = read(
        'Specimen,"22L.3"\nSpeed: 1 ft/s\n\nfree text\nSpecimen,again\n# logger 7\nt,x,F\n'
        "0,1,2\n# paused\n1,2,3\n",
        preamble_rows=5,
        comment="#",
    )
    assert log.metadata == {
        "Specimen": "22L.3",
        "Speed": "1 ft/s",
        "row 4": "free text",
        "Specimen (row 5)": "again",
        "row 6": "logger 7",
        "row 9": "paused",
    }
    assert log.columns["time"].tolist() == [0.0, 1.0]
    assert log.row.tolist() == [8, 10]


def test_missing_marks_are_nan_however_they_are_padded_or_written(read):
    log = read(
        "t,x,F\n0,ovrflw,\n1, ovrflw ,-9999.00\n2,3,-9999\n", missing=("", "ovrflw", "-9999")
    )
    np.testing.assert_equal(log.columns["crosshead_position"], [np.nan, np.nan, 3.0])
    assert np.isnan(log.columns["tension.1"]).all()
    assert log.missing("tension.1").all()


def test_blank_lines_are_no_rows_but_count_as_lines(read):
    log = read("t,x,F\n0,1,2\n\n   \n1,2,3\n\n\n")
    assert log.n_rows_read == 2
    assert log.row.tolist() == [2, 5]


def test_blanks_after_the_last_row_are_no_row(read):
    log = read("t,x,F\n0,1,2\n1,2,3\n   \n ")
    assert log.columns["time"].tolist() == [0.0, 1.0]
    assert log.row is None


def test_a_row_after_blank_lines_is_named_as_an_editor_counts(read):
    with pytest.raises(LogError, match=r"log\.csv:5 \[F\]: .*found 'x'"):
        read("t,x,F\n0,1,2\n\n\n1,2,x\n")


def test_a_row_after_comments_is_named_as_an_editor_counts(read):
    with pytest.raises(LogError, match=r"log\.csv:5 \[F\]: .*found 'x'"):
        read("t,x,F\n0,1,2\n# a\n# b\n1,2,x\n", comment="#")


@pytest.mark.parametrize("text", ["ovrflw", "0x10", "1d3", "nan", "inf", "--", "1 2", "1e999"])
def test_text_in_a_number_names_file_row_and_channel(read, text):
    with pytest.raises(LogError) as caught:
        read(f"t;x;F\n0;1;2\n1;2;{text}\n2;3;4\n", delimiter=";", missing=("",))
    assert str(caught.value).split("log.csv", 1)[1] == (
        f":3 [F]: a value is not a number; found '{text}'; needed a decimal number such as 12.5 in "
        "N, or a declared missing mark. Add it to the missing marks of the layout if it means "
        "missing."
    )


def test_an_empty_field_that_is_no_missing_mark_is_refused(read):
    with pytest.raises(LogError, match=r":2 \[x\]: a value is not a number; found an empty field"):
        read("t,x,F\n0,,2\n", missing=("NaN",))


def test_the_first_bad_row_of_many_is_found(read):
    rows = [f"{i},{i},{i}" for i in range(50_000)]
    rows[43_210] = "1,2,3?"
    with pytest.raises(LogError, match=r":43212 \[F\]: .*found '3\?'"):
        read("t,x,F\n" + "\n".join(rows))


def test_a_row_with_a_field_too_few_or_too_many_is_refused(read):
    with pytest.raises(
        LogError,
        match=r":3: a row has 2 fields where the first has 3; found '1,2'; needed 3 fields$",
    ):
        read("t,x,F\n0,1,2\n1,2\n2,3,4\n")
    with pytest.raises(LogError, match=r":3: a row has 4 fields"):
        read("t,x,F\n0,1,2\n1,2,3,4\n")


def test_a_log_cut_off_in_its_last_line_says_so(read):
    with pytest.raises(LogError, match=r":3: .*The log was cut off; remove its last line\."):
        read("t,x,F\n0,1,2\n1,2")


@pytest.mark.parametrize("mark", [", ", ",   ", "\t ", "; "])
def test_blanks_before_a_quoted_field_are_left_out(read, mark):
    rows = [["t", "x", "F, left"], ["0.0", "1.5", "2"], ["1", "2", "3"]]
    quoted = "\n".join(mark.join(f'"{one}"' for one in row) for row in rows)
    channels = {**CHANNELS, "tension.1": {"column": "F, left", "unit": "N"}}
    log = read(quoted, channels, delimiter=mark[0])
    assert log.columns["crosshead_position"].tolist() == [1.5, 2.0]
    assert log.columns["tension.1"].tolist() == [2.0, 3.0]


def test_a_quoted_line_end_is_refused(read):
    with pytest.raises(
        LogError,
        match=r"log\.csv:3: a quoted field continues beyond its line; found '0,1,2,\"a'; "
        r"needed one line a row\. Close the quote",
    ):
        read('t,x,F,note\n0,1,2,c\n0,1,2,"a\nb"\n1,2,3,c\n')


def test_a_quote_that_is_not_closed_in_the_last_row_is_no_number(read):
    with pytest.raises(
        LogError, match=r"log\.csv:3: a quoted field continues beyond .*found '1,2,\"3'"
    ):
        read('t,x,F\n0,1,2\n1,2,"3')


def test_a_quote_that_is_not_closed_is_told_before_the_fields_that_it_takes(read):
    with pytest.raises(
        LogError, match=r"log\.csv:3: a quoted field continues beyond .*found '0,\"1,2'"
    ):
        read('t,x,F\n0,1,2\n0,"1,2\n1,2,3\n')


def test_a_quote_that_is_never_closed_names_its_row(read):
    with pytest.raises(LogError, match=r"log\.csv:3: a quoted field continues beyond its line"):
        read('t,x,F\n0,1,2\n1,2,"3\n2,3,4\n')


def test_without_a_quote_character_a_quote_is_text(read):
    with pytest.raises(LogError, match=r"log\.csv:3 \[F\]: a value is not a number; found '\"3'"):
        read('t,x,F\n0,1,2\n1,2,"3\n2,3,4\n', quote="")


def test_mixed_line_ends_are_all_line_ends(read):
    log = read(b"t,x,F\n0,1,2\r1,2,3\r\n2,3,4\r")
    assert log.columns["tension.1"].tolist() == [2.0, 3.0, 4.0]
    assert log.row is None


def test_the_mark_that_dos_ends_a_file_with_is_no_field(read):
    assert read(b"t,x,F\r\n0,1,2\r\n\x1a").columns["tension.1"].tolist() == [2.0]


def test_a_line_too_long_to_be_parsed_is_refused(read):
    with pytest.raises(
        LogError, match=r"log\.csv:3: a line is too long to be a row of a log; found"
    ):
        read("t,x,F,note\n0,1,2,y\n0,1,2," + "x" * 3_000_000 + "\n1,2,3,y\n")


def test_header_only_is_refused(read):
    for text in ("t,x,F\n", "t,x,F", "t,x,F\n\n\n"):
        with pytest.raises(LogError, match="there are no data rows"):
            read(text)
    with pytest.raises(LogError, match=r"there are no data rows.*Check preamble_rows"):
        read("t,x,F\n0,1,2\n", preamble_rows=5)


def test_a_missing_column_lists_what_is_there(read):
    with pytest.raises(
        LogError,
        match=r"log\.csv:1 \[tension\.1\]: column 'F' is not in the file; found 't', 'x', 'G'",
    ):
        read("t,x,G\n0,1,2\n")


def test_a_wrong_delimiter_shows_in_the_message(read):
    with pytest.raises(LogError, match="column 't' is not in the file; found 't;x;F'"):
        read("t;x;F\n0;1;2\n")


def test_a_column_number_beyond_the_row_is_refused(read):
    channels = CHANNELS | {"tension.1": {"column": 7, "unit": "N"}}
    with pytest.raises(
        LogError, match=r"column 7 is not in the file; .*needed a number from 1 to 3"
    ):
        read("t,x,F\n0,1,2\n", channels)


def test_a_declared_name_that_is_there_twice_is_refused(read):
    with pytest.raises(
        LogError, match=r"column 'F' appears 2 times in the file; found numbers 3, 4"
    ):
        read("t,x,F,F\n0,1,2,3\n")


def test_rows_wider_than_the_name_row_are_refused(read):
    with pytest.raises(
        LogError,
        match=r":2: the first data row has 6 fields, the name row has 3; .*Check delimiter",
    ):
        read("t,x,F\n0,5,1,5,2,5\n")


def test_a_unit_row_that_agrees_in_other_words_is_accepted(read):
    for units in ("(s),[mm],(N)", "sec,mm,N", "Sec,millimeter,newton", "s,,"):
        assert read(f"t,x,F\n{units}\n0,1,2\n", has_unit_row=True).first_row == 3


def test_a_unit_row_that_contradicts_the_layout_is_refused(read):
    with pytest.raises(
        LogError,
        match=r"log\.csv:2 \[F\]: the unit in the file is not the declared one; found '\(kN\)'; "
        r"needed 'N', as the layout declares",
    ):
        read("t,x,F\n(s),(mm),(kN)\n0,1,2\n", has_unit_row=True)
    with pytest.raises(LogError, match="unit 'mm' is not a unit of force"):
        read("t,x,F\ns,mm,mm\n0,1,2\n", has_unit_row=True)


def test_a_unit_in_the_name_that_contradicts_the_layout_is_refused(read):
    channels = CHANNELS | {"tension.1": {"column": "Force (kN)", "unit": "N"}}
    with pytest.raises(LogError, match=r"the unit in the column's name is not the declared one"):
        read("t,x,Force (kN)\n0,1,2\n", channels)
    right = CHANNELS | {"tension.1": {"column": "Force (kN)", "unit": "kN"}}
    assert read("t,x,Force (kN)\n0,1,2\n", right).n_rows_read == 1


def test_a_clock_is_kept_as_text_and_made_elapsed_seconds(read):
    channels = CHANNELS | {"time": {"column": "t", "unit": "clock"}}
    log = read("t,x,F\n0945,1,2\n10:09,2,3\n", channels)
    assert log.text == {"time": ("0945", "10:09")}
    assert log.columns["time"].tolist() == [0.0, 1440.0]


def test_dates_of_a_clock_are_read_in_the_order_of_the_layout(read):
    channels = CHANNELS | {"time": {"column": "t", "unit": "clock", "date_order": "month first"}}
    log = read("t,x,F\n05/31/2005 23:59,1,2\n06/01/2005 0:00,2,3\n", channels)
    assert log.columns["time"].tolist() == [0.0, 60.0]


def test_own_time_stamps_are_read_beside_their_channel(read):
    channels = CHANNELS | {
        "tension.1": {"column": "F", "unit": "N", "time_column": "tF", "time_unit": "ms"}
    }
    log = read("t,x,tF,F\n0,1,5,2\n1,2,,\n", channels)
    np.testing.assert_equal(log.columns["tension.1.time"], [5.0, np.nan])


def test_empty_and_binary_files_are_refused(read):
    with pytest.raises(LogError, match="the file is empty"):
        read("")
    with pytest.raises(LogError, match="the file is binary"):
        read(b"\x89HDF\r\n\x1a\n\0\0\0")


def test_a_file_of_bad_encoding_is_refused(read):
    with pytest.raises(LogError, match=r"log\.csv:2: the file is not in the declared encoding"):
        read(b"t,x,F\n0,1,\xb5\n")


def test_a_file_that_shrinks_while_it_is_parsed_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "log.csv"
    path.write_text("t,x,F\n0,1,2\n1,2,3\n")
    from reduction.readers import delimited

    whole = delimited.read_fields

    def shrinking(*arguments):
        path.write_text("t,x,F\n")
        return whole(*arguments)

    monkeypatch.setattr(delimited, "read_fields", shrinking)
    with pytest.raises(LogError, match=r"shrank while it was read; found 18 bytes, then 6 bytes"):
        read_log(path, layout(), name="log.csv")


def test_quoted_fields_may_hold_the_mark_that_parts_them(read):
    text = 't,x,F\n0,1,"998.2"\n1,2,"1,004.80328"\n2,3,"-11,044.03516"\n'
    log = read(text, delimiter=",", thousands=",")
    np.testing.assert_array_equal(log.columns["tension.1"], [998.2, 1004.80328, -11044.03516])


@pytest.mark.parametrize(("mark", "found"), [(",", "1,000,292"), (".", "1.000.292")])
def test_a_decimal_mark_taken_for_one_of_thousands_is_told(read, mark, found):
    text = f"t;x;F\n0;99{mark}98;1\n1;{found};1\n"
    with pytest.raises(
        LogError, match=r"log\.csv:3 \[x\]: .*two decimal marks.*export the log again"
    ):
        read(text, delimiter=";", decimal=mark)


ROWS = ['t,"x",F', "0,10,1", '"0.1",11,"2"', "0.2,12,3"]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_rows_that_a_spreadsheet_saved_as_one_quoted_field_each_are_read(read, end):
    saved = ['"' + row.replace('"', '""') + '"' for row in ROWS]
    log = read(end.join(["a preamble", *saved]) + end, preamble_rows=1)
    assert log.columns["crosshead_position"].tolist() == [10.0, 11.0, 12.0]
    assert log.columns["tension.1"].tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(LogError, match=r"log\.csv:4 \[F\]: a value is not a number; found 'x'"):
        read(end.join(["a preamble", *saved[:2], '"0.1,11,x"', saved[3]]), preamble_rows=1)


@pytest.mark.parametrize(
    ("found", "more", "advice"),
    [
        ("0,244", {"thousands": ","}, 'Set decimal = "," and thousands = ""'),
        ("00,244", {"thousands": ","}, 'Set decimal = "," and thousands = ""'),
        ("1234,567", {"thousands": ","}, 'Set decimal = "," and thousands = ""'),
        ("1,24", {"thousands": ","}, 'Set decimal = "," and thousands = ""'),
        ("0,244", {}, 'Set decimal = ","'),
        ("1,244", {}, 'Set thousands = "," if the comma separates groups, or decimal = ","'),
        ("1,004.80328", {}, 'Set thousands = "," if it separates groups of three digits'),
        ("1.004,80328", {"decimal": ","}, 'Set thousands = "." if it separates groups'),
    ],
)
def test_marks_in_a_number_that_the_layout_does_not_state_are_told(read, found, more, advice):
    with pytest.raises(LogError) as caught:
        read(f"t;x;F\n0;1;2\n1;2;{found}\n", delimiter=";", **more)
    assert f":3 [F]: a value is not a number; found '{found}'" in str(caught.value)
    assert advice in caught.value.hint


def test_a_second_row_of_the_header_and_a_date_are_told_for_what_they_are(read):
    with pytest.raises(LogError, match="Set has_unit_row = true if this is a row of units"):
        read("t;x;F\n(s);(m);(N)\n0;1;2\n1;2;3\n", delimiter=";")
    with pytest.raises(LogError, match='Set unit = "clock" if it is a time of day'):
        read("t;x;F\n13.11.2018 17:14;1;2\n13.11.2018 17:15;2;3\n", delimiter=";")

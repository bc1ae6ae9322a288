"""A proposal is right when, its ``?`` filled in by hand, it reads the log it was made from."""

import tomllib
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from measured_logs import LOGS, needs_measured_logs
from nptdms import ChannelObject, TdmsWriter
from pydantic import ValidationError
from workbook import write_xlsx

from reduction.readers.layout import Layout
from reduction.readers.read_log import read_log
from reduction.readers.sniff import format_of, sniff_layout
from reduction.record.errors import LogError

RAW = Path(__file__).parents[2] / "raw"


def proposed(path, **kwargs):
    return tomllib.loads(sniff_layout(path, **kwargs).toml)["layouts"]["log"]


def filled(settings, **channels):
    """The proposal with a person's answers: channels as given, datum always pin-to-pin."""
    made = {**settings, "channels": {**settings["channels"], **channels}}
    made["channels"] = {key: entry for key, entry in made["channels"].items() if entry is not None}
    if "crosshead_position" in made["channels"]:
        position = made["channels"]["crosshead_position"]
        made["channels"]["crosshead_position"] = {
            "column": position["column"],
            "unit": position["unit"],
            "datum": "pin-to-pin",
        }
    for load in made["channels"].get("tension", {}).values():
        if load.get("zero") == "?":
            del load["zero"]
    if made.get("sample_interval") == "?":
        made["sample_interval"] = "0.1 s"
    return Layout.model_validate(made)


def columns(settings):
    """Column and unit by channel."""
    flat = {}
    for key, entry in settings["channels"].items():
        many = entry if "column" not in entry else {"": entry}
        for place, one in many.items():
            flat[f"{key}.{place}".rstrip(".")] = (one["column"], one["unit"])
    return flat


def write(tmp_path, text, name="log.csv", encoding="utf-8"):
    (tmp_path / name).write_bytes(text.encode(encoding))
    return tmp_path / name


TETHER_LOG = (
    "tmt-synthetic/T-1.csv",
    {"delimiter": ",", "decimal": ".", "comment": "#", "has_unit_row": False},
    {
        "time": ("time_s", "s"),
        "crosshead_position": ("crosshead_ft", "ft"),
        "tension.1": ("load_new_lb", "lbf"),
        "tension.2": ("load_used_lb", "lbf"),
    },
    7632,
)
TEXT_LOGS = [
    (
        "machine-exports/example.csv",
        {"delimiter": "\t", "decimal": ".", "encoding": "latin-1", "preamble_rows": 16, "has_unit_row": True},
        {
            "time": ("Prüfzeit", "s"),
            "crosshead_position": ("Traverse abs.", "mm"),
            "tension.1": ("Standardkraft", "N"),
            "strain.1": ("Dehnung", "%"),
        },
        18876,
    ),
    (
        "machine-exports/example2.csv",
        {"delimiter": "\t", "decimal": ".", "encoding": "utf-8", "preamble_rows": 1, "has_unit_row": False},
        {
            "time": ("Zeit [s]", "s"),
            "crosshead_position": ("Maschine [mm]", "mm"),
            "tension.1": ("Kraft [kN]", "kN"),
        },
        712,
    ),
    (
        "machine-exports/example4.csv",
        {"delimiter": "\t", "format": "blocks", "block_marker": "Datenerfassung", "has_unit_row": True},
        {
            "time": ("Laufzeit", "s"),
            "crosshead_position": ("Ch 1 Weg", "mm"),
            "tension.1": ("Ch 1 Kraft", "kN"),
        },
        931,
    ),
    (
        "bluehill-compression/Specimen_RawData_6.csv",
        {"delimiter": ",", "decimal": ".", "preamble_rows": 3, "has_name_row": True, "has_unit_row": True},
        {
            "time": ("Time", "sec"),
            "crosshead_position": ("Extension", "mm"),
            "tension.1": ("Load", "N"),
            "cycle_counter": ("Total Cycle Count", "1"),
        },
        18011,
    ),
    (
        "damper-hysteresis/clt_SPC1/SPC1.csv",
        {"delimiter": ",", "decimal": ".", "has_unit_row": True, "sample_interval": "?"},
        {
            "crosshead_position": ("Lead Actuator Displacment", "mm"),
            "tension.1": ("Lead Actuator Force", "kN"),
        },
        33028,
    ),
    *(
        (
            f"instron-elastomer/{name}",
            {"delimiter": ",", "decimal": ".", "encoding": "utf-8", "has_unit_row": False},
            {
                "time": ("Total Time (s)", "s"),
                "crosshead_position": ("Position (mm)", "mm"),
                "tension.1": ("Force (kN)", "kN"),
                "cycle_counter": ("Total Cycles", "1"),
            },
            rows,
        )
        for name, rows in [
            ("latex_glove/Test6.steps.tracking.csv", 1650),
            ("latex_glove/Test6.Stop.csv", 1430),
            ("silicone_10a/Test7.steps.tracking.csv", 1941),
            ("silicone_10a/Test7.Stop.csv", 1495),
        ]
    ),
]  # fmt: skip


@pytest.mark.parametrize(
    ("folder", "name", "settings", "channels", "n_rows"),
    [
        (RAW, *TETHER_LOG),
        *(pytest.param(LOGS, *log, marks=needs_measured_logs) for log in TEXT_LOGS),
    ],
)
def test_the_proposal_for_a_text_log_reads_it(folder, name, settings, channels, n_rows):
    found = proposed(folder / name)
    assert settings.items() <= found.items()
    assert columns(found) == channels
    assert "preamble_rows" in settings or "preamble_rows" not in found
    log = read_log(folder / name, filled(found), name=name)
    assert abs(log.n_rows_read - n_rows) <= 1  # the last line may lack its end


@needs_measured_logs
@pytest.mark.parametrize(
    "name",
    [
        "Dragon Skin 20",
        "Dragon Skin 30",
        "Ecoflex 00-35 FAST",
        "Mold Star 20T",
        "PlatSil Gel 10",
        "WAGNERSIL 20 NF",
    ],
)
def test_a_log_with_stresses_has_no_load(name):
    path = LOGS / "soft-silicones" / f"{name}.csv"
    found = proposed(path)
    assert {"delimiter": ";", "decimal": ".", "preamble_rows": 17}.items() <= found.items()
    assert columns(found) == {"time": ("Time (s)", "s"), "strain.1": ("Engineering Strain", "?")}
    strain = {"1": {"column": "Engineering Strain", "unit": "1"}}
    log = read_log(path, filled(found, strain=strain), name=path.name)
    assert log.n_rows_read > 250


@needs_measured_logs
def test_columns_without_names_are_listed_by_number():
    path = LOGS / "damper-hysteresis" / "ganey_damper" / "xyTestData.csv"
    sniffed = sniff_layout(path)
    found = proposed(path)
    assert found["has_name_row"] is False
    assert "# not used: column 1, -2.87" in sniffed.toml
    position = {"column": 1, "unit": "mm"}
    tension = {"1": {"column": 2, "unit": "kN"}}
    log = read_log(path, filled(found, crosshead_position=position, tension=tension), name="x")
    assert log.n_rows_read == 308


@needs_measured_logs
def test_the_proposal_for_json_names_the_matrix_and_the_units():
    path = LOGS / "friction-damper" / "0.5Hz30lbtension1.5amplitude.json"
    found = proposed(path)
    assert (found["format"], found["matrix"]) == ("json", "data")
    assert columns(found)["time"] == (1, "s")
    remarks = " ".join(sniff_layout(path).remarks)
    assert "'actuator force units' as 'lb'" in remarks
    made = filled(found, crosshead_position=None, tension={"1": {"column": 6, "unit": "lb"}})
    assert read_log(path, made, name="x").n_rows_read == 14 * 1024 + 1


@needs_measured_logs
def test_the_proposal_for_a_workbook_names_the_sheet_and_the_others():
    path = LOGS / "knit-yarn" / "compressionTests.xls"
    found = proposed(path)
    assert {"sheet": "cotton-1", "preamble_rows": 1, "has_unit_row": True}.items() <= found.items()
    assert columns(found) == {
        "time": ("Test time", "s"),
        "crosshead_position": ("Tool separation", "mm"),
        "tension.1": ("Standard force", "mN"),
    }
    assert any("'acrylic-3'" in remark for remark in sniff_layout(path).remarks)
    assert read_log(path, filled(found), name="x").n_rows_read == 872
    assert proposed(path, sheet="cotton-3")["sheet"] == "cotton-3"
    with pytest.raises(LogError, match="no sheet holds a table of numbers"):
        sniff_layout(path, sheet="cotton-9")


@needs_measured_logs
@pytest.mark.parametrize("name", ["machine-exports/example3.csv", "instron-elastomer/LICENSE"])
def test_a_file_without_a_table_is_refused(name):
    with pytest.raises(LogError, match="no table of numbers at the start of the file"):
        sniff_layout(LOGS / name)


def test_a_proposal_with_question_marks_does_not_load(tmp_path):
    for header in (
        "time_s,crosshead_ft,load_lb",
        "time,crosshead_ft,load_lb",
        "time_s,load_lb,load",
    ):
        found = proposed(write(tmp_path, f"{header}\n0,1,2\n1,2,3\n2,3,4\n"))
        with pytest.raises((ValidationError, LogError, ValueError), match=r"\?|datum"):
            Layout.model_validate(found)


def test_decimal_commas_and_thousands_are_seen(tmp_path):
    text = "Zeit;Kraft;Weg\ns;N;mm\n" + "".join(f"0,{i};1.{i:03},5;{i},25\n" for i in range(1, 9))
    found = proposed(write(tmp_path, text))
    assert (found["delimiter"], found["decimal"], found["thousands"]) == (";", ",", ".")
    assert found["has_unit_row"] is True
    log = read_log(tmp_path / "log.csv", filled(found), name="x")
    assert log.columns["tension.1"].tolist() == [1000.5 + i for i in range(1, 9)]


def test_the_proposal_for_quoted_thousands_loads(tmp_path):
    text = "Time,Extension,Load\n(s),(mm),(N)\n"
    text += "".join(f'0.{i},0.{i},"{10 + i},044.03516"\n' for i in range(1, 9))
    found = proposed(write(tmp_path, text))
    assert (found["delimiter"], found["decimal"], found["thousands"]) == (",", ".", ",")
    log = read_log(tmp_path / "log.csv", filled(found), name="x")
    assert log.columns["tension.1"].tolist() == [1e3 * (10 + i) + 44.03516 for i in range(1, 9)]


def test_an_elongation_in_millimetres_is_a_position_and_one_in_percent_a_strain(tmp_path):
    rows = "".join(f"{i},{i},{i}\n" for i in range(5))
    for unit, key in (("mm", "crosshead_position"), ("%", "strain")):
        text = f"Time (s),Load (N),Elongation ({unit})\n{rows}"
        assert key in proposed(write(tmp_path, text))["channels"]


def test_tests_side_by_side_are_not_the_specimens_of_one(tmp_path):
    rows = "".join(f"{i},{2 * i},{i / 9}" + (f",{i},{3 * i},{i / 8}\n" if i < 6 else ",,,\n")
                   for i in range(9))  # fmt: skip
    names = "Time (s),Force (N),Stroke (mm)"
    path = write(tmp_path, f"{names},{names}\n{rows}")
    assert columns(proposed(path)) == {
        "time": (1, "s"), "tension.1": (2, "N"), "crosshead_position": (3, "mm"),
    }  # fmt: skip
    assert any(
        one.startswith("guess: 2 tests are side by side") for one in sniff_layout(path).remarks
    )


@pytest.mark.parametrize("name", ["Grip to grip separation", "Standard travel"])
def test_a_distance_of_grips_or_a_travel_is_the_position(tmp_path, name):
    rows = "".join(f"{i},{50 + i},{i}\n" for i in range(9))
    path = write(tmp_path, f"Time (s),{name} (mm),Standard force (N)\n{rows}")
    assert columns(proposed(path))["crosshead_position"] == (f"{name} (mm)", "mm")


def test_the_names_of_a_log_are_seen_beside_the_numbers_that_an_author_added(tmp_path):
    rows = [[0.1 * i, 5.0 * i, 20.0 + i, None, None, None] for i in range(30)]
    rows[0][4:], rows[1][4:] = [0.0, 22.0], [3.0, 24.5]
    head = [["Step time", "Axial force", "Gap"], ["s", "N", "mm"]]
    write_xlsx(tmp_path / "log.xlsx", {"Sheet1": [*head, *rows]})
    found = proposed(tmp_path / "log.xlsx")
    assert "preamble_rows" not in found and found["has_name_row"] and found["has_unit_row"]
    assert columns(found) == {
        "time": ("Step time", "s"),
        "tension.1": ("Axial force", "N"),
        "crosshead_position": ("Gap", "mm"),
    }


def test_a_table_of_results_above_the_log_is_not_taken_for_it(tmp_path):
    results = "".join(f"{i},{3000 + i},{20 + i},\n" for i in range(1, 6))
    rows = "".join(f",{i / 10},{50 + i},{i}\n" for i in range(60))
    path = write(
        tmp_path,
        f"Results Table 1,,,\n,Maximum Force,Width,Note\n,(N),(mm),\n{results},,,\n"
        f"1,Time,Displacement,Force\n,(s),(mm),(N)\n{rows}",
    )
    found = proposed(path)
    assert found["preamble_rows"] == 9 and found["has_unit_row"]
    assert columns(found) == {
        "time": ("Time", "s"),
        "crosshead_position": ("Displacement", "mm"),
        "tension.1": ("Force", "N"),
    }
    assert read_log(path, filled(found), name="x").n_rows_read == 60


def test_a_short_first_part_of_a_log_is_taken_for_its_beginning(tmp_path):
    rows = [f"{i / 10},{50 + i},{i}" for i in range(60)]
    path = write(tmp_path, "\n".join(["t [s],x [mm],F [N]", *rows[:4], "halt,,", *rows[4:]]))
    found = proposed(path)
    assert found["has_name_row"] and "preamble_rows" not in found


def test_a_header_of_labview_with_numbers_in_it_is_no_part_of_the_table(tmp_path):
    head = (
        "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t2\t\t\n"
        "Samples\t1000\t1000\t\nDate\t2023/10/19\t2023/10/19\t\nX_Dimension\tTime\tTime\t\n"
        "X0\t0.0E+0\t0.0E+0\t\nDelta_X\t1.0E-5\t1.0E-5\t\n***End_of_Header***\t\t\t\n"
        "X_Value\tStroke\tLoad\tComment\n0.0\t50.0\t0.0\tSpecimen 3, rate 100000\n"
    )
    rows = "".join(f"{i / 10}\t{50 + i}\t{i}\n" for i in range(1, 1000))
    found = proposed(write(tmp_path, head + rows))
    assert found["delimiter"] == "\t" and "missing" not in found
    assert columns(found)["time"] == ("X_Value", "s")


def test_rows_quoted_as_a_whole_are_drafted_and_read(tmp_path):
    rows = "".join(f'"{i / 10},{50 + i},{i}"\r\n' for i in range(9))
    path = write(tmp_path, f'"Time (s),Position (mm),Load (N)"\r\n{rows}')
    found = proposed(path)
    assert columns(found)["tension.1"] == ("Load (N)", "N")
    assert read_log(path, filled(found), name="x").n_rows_read == 9


def test_names_quoted_after_a_blank_have_their_units(tmp_path):
    rows = "\n".join(f"{k / 10}, {10 + k % 7}, {k}" for k in range(60))
    path = write(tmp_path, f'"Time (s)", "Position (mm)", "Load (N)"\n{rows}\n')
    settings = proposed(path)
    assert columns(settings) == {
        "time": ("Time (s)", "s"), "crosshead_position": ("Position (mm)", "mm"),
        "tension.1": ("Load (N)", "N"),
    }  # fmt: skip
    assert read_log(path, filled(settings), name="log.csv").n_rows_read == 60
    with pytest.raises(LogError, match="kN"):
        read_log(
            path, filled(settings, tension={"1": {"column": "Load (N)", "unit": "kN"}}),
            name="log.csv",
        )  # fmt: skip


def test_a_table_of_extremes_is_no_log_of_loops(tmp_path):
    rows = [f"{one},{900 + one},{300 - one},{20 + one / 9:.2f},{10:.2f}" for one in range(1, 30)]
    text = "Cycle,Max Load (N),Min Load (N),Max Position (mm),Min Position (mm)\n"
    path = tmp_path / "log.csv"
    path.write_text(text + "\n".join(rows) + "\n")
    said = '"Max Load (N)" and "Min Load (N)" are extremes of each cycle'
    assert said in " ".join(sniff_layout(path).remarks)
    path.write_text(text.replace("Max Load", "Load").replace("Max Pos", "Pos") + "\n".join(rows))
    assert "extremes of each cycle" not in " ".join(sniff_layout(path).remarks)


@pytest.mark.parametrize(
    "names", [("Storage modulus", "Loss modulus"), ("E'", 'E""'), ("Phase", "tan_delta")]
)
def test_a_table_of_results_at_each_frequency_is_no_log_of_loops(tmp_path, names):
    rows = [f"{10 * i},{1 + i / 9:.3f},{2 + i / 50:.3f},{3 + i},{i / 5}" for i in range(40)]
    head = f'Time (s),x (mm),F (N),"{names[0]}","{names[1]}"'
    path = write(tmp_path, "\n".join([head, *rows]))
    found = sniff_layout(path)
    assert "are results of each frequency or temperature" in " ".join(found.remarks)
    assert found.kind == ""


@pytest.mark.parametrize(("unit", "datum"), [("mm", "displacement"), ("cm", "pin-to-pin")])
def test_a_length_of_less_than_five_millimetres_is_no_specimen(tmp_path, unit, datum):
    rows = [f"{i / 10},{1 + abs(i % 40 - 20) / 10:.2f},{abs(i % 40 - 20)}" for i in range(200)]
    path = write(tmp_path, f"Time (s),Crosshead ({unit}),Load (N)\n" + "\n".join(rows) + "\n")
    assert f'datum = "{datum}"' in sniff_layout(path).toml


@pytest.mark.parametrize("name", ["Machine_N_cycles", "No. of cycles", "Cycle No.", "cycle index"])
def test_a_count_of_cycles_is_known_by_its_name(tmp_path, name):
    rows = [f"{i / 10},{i // 20},{i % 20},{i % 20 / 3:.3f}" for i in range(100)]
    path = write(tmp_path, f"Time (s),{name},Position (mm),Load (N)\n" + "\n".join(rows) + "\n")
    assert f'cycle_counter = {{ column = "{name}"' in sniff_layout(path).toml


def test_a_decimal_comma_that_may_part_thousands_is_a_guess(tmp_path):
    path = write(tmp_path, "a;b\n" + "".join(f"1,{i:03};2,{i:03}\n" for i in range(9)))
    assert any(
        "could also have it for thousands" in remark for remark in sniff_layout(path).remarks
    )


def test_whole_numbers_leave_the_decimal_mark_a_guess(tmp_path):
    path = write(tmp_path, "a;b\n1;2\n3;4\n5;6\n")
    assert "guess: decimal mark '.', because no number has one" in sniff_layout(path).remarks


def test_missing_marks_are_proposed(tmp_path):
    rows = [f"{i / 10},{i}" for i in range(20)]
    rows[7] = "0.7,ovrflw"
    found = proposed(write(tmp_path, "time_s,load_kN\n" + "\n".join(rows) + "\n"))
    assert found["missing"] == ["", "NaN", "nan", "ovrflw"]
    log = read_log(tmp_path / "log.csv", filled(found), name="x")
    assert int(log.missing("tension.1").sum()) == 1


def test_blanks_that_part_fields_are_seen(tmp_path):
    path = write(tmp_path, "time_s load_kN\n" + "".join(f"{i}.0   {i}.5\n" for i in range(5)))
    found = proposed(path)
    assert found["delimiter"] == " "
    assert read_log(path, filled(found), name="x").n_rows_read == 5


def test_a_trailing_delimiter_is_no_column(tmp_path):
    path = write(tmp_path, "time_s,load_kN,\n0,1,\n1,2,\n2,3,\n")
    sniffed = sniff_layout(path)
    assert "sure: each row ends with a delimiter ','" in sniffed.remarks
    assert "not used" not in sniffed.toml


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_settles_the_encoding(tmp_path, encoding):
    path = write(tmp_path, "Prüfzeit [s];Kraft [N]\n0;1\n1;2\n2;3\n", encoding=encoding)
    found = proposed(path)
    assert found["encoding"] == encoding.removesuffix("-sig")
    assert read_log(path, filled(found), name="x").n_rows_read == 3


def test_names_behind_a_comment_mark_name_numbered_columns(tmp_path):
    path = write(tmp_path, "# time_s load_kN\n0.0 1.0\n0.1 2.0\n0.2 3.0\n")
    found = proposed(path)
    assert columns(found) == {"time": (1, "s"), "tension.1": (2, "kN")}
    assert read_log(path, filled(found), name="x").n_rows_read == 3


def test_a_comment_line_that_is_no_list_of_names_is_only_a_comment(tmp_path):
    found = proposed(write(tmp_path, "# a remark\n0.0,1.0\n0.1,2.0\n0.2,3.0\n"))
    assert columns(found)["time"] == (1, "?")


def test_a_clock_is_seen(tmp_path):
    for times in (["0945", "0955", "1009"], ["9:45", "9:55", "10:09"]):
        body = "".join(f"{time},{i},1\n" for i, time in enumerate(times))
        found = proposed(write(tmp_path, "time_est,load_lb,x\n" + body))
        assert columns(found)["time"] == ("time_est", "clock")


@pytest.mark.parametrize("date", ["2026-03-05", "05.03.2026", "13/3/2026"])
def test_the_blank_between_date_and_time_parts_no_columns_of_a_log_with_tabs(tmp_path, date):
    rows = "".join(f"{date} 13:20:{i / 10:06.3f}\t{i / 8}\t{i / 4}\n" for i in range(200))
    found = proposed(write(tmp_path, "Time\tCrosshead [mm]\tLoad [kN]\n" + rows))
    assert found["delimiter"] == "\t"
    assert columns(found) == {
        "time": ("Time", "clock"),
        "crosshead_position": ("Crosshead [mm]", "mm"),
        "tension.1": ("Load [kN]", "kN"),
    }


@pytest.mark.parametrize(
    ("last", "order"), [("05/31/2005 9:45:02 AM", "month first"), ("05/06/2005 9:45:02 AM", "?")]
)
def test_the_order_of_dates_is_drafted_where_a_number_above_12_decides_it(tmp_path, last, order):
    times = ["05/06/2005 9:45:00 AM", "05/06/2005 9:45:01 AM", last]
    path = write(tmp_path, "Time,load_lb\n" + "".join(f"{time},1\n" for time in times))
    channel = next(line for line in sniff_layout(path).toml.split("\n") if "clock" in line)
    assert f'date_order = "{order}"' in channel


def test_time_that_goes_back_is_said(tmp_path):
    rows = list(range(30))
    rows[20] = 5
    path = write(tmp_path, "time_s,load_N\n" + "".join(f"{t},1.5\n" for t in rows))
    assert "sure: time goes back at least once" in sniff_layout(path).remarks


def test_a_name_that_stands_twice_is_given_by_number(tmp_path):
    path = write(tmp_path, "time_s,load_N,load_N\n0,1,2\n1,2,3\n2,3,4\n")
    assert columns(proposed(path)) == {
        "time": ("time_s", "s"), "tension.1": (2, "N"), "tension.2": (3, "N"),
    }  # fmt: skip


def test_commanded_channels_and_extremes_are_no_measured_ones(tmp_path):
    header = "time_s,load setpoint (N),Kraft Sollwert [N],Force:Maximum (N),target position (mm)"
    found = proposed(write(tmp_path, header + "\n" + "".join(f"{i},1,2,3,4\n" for i in range(5))))
    assert set(columns(found)) == {"time", "crosshead_position", "tension.1"}
    assert columns(found)["tension.1"] == ("?", "?")


def test_a_column_in_a_unit_of_another_kind_is_not_proposed(tmp_path):
    path = write(tmp_path, "time_s,load (mm),strain\ns,,MPa\n0,1,2\n1,2,3\n2,3,4\n")
    assert columns(proposed(path))["tension.1"] == ("?", "?")


def test_times_of_day_and_loads_in_tonnes_are_known(tmp_path):
    rows = "".join(f"03.11.2026 23:59:{50 + i};{i},5;{i}\n" for i in range(9))
    found = columns(proposed(write(tmp_path, "Date Time;Load;Elongation\n;t;mm\n" + rows)))
    assert found["time"] == ("Date Time", "clock")
    assert found["tension.1"] == ("Load", "tf")


def test_an_unknown_unit_is_a_question(tmp_path):
    path = write(tmp_path, "time,load,temperature,strain\n0,1,2,3\n1,2,3,4\n2,3,4,5\n")
    assert {unit for _, unit in columns(proposed(path)).values()} == {"?"}


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "the file is empty"),
        (b"\x00\x01\x02" * 99, "of no known format"),
        (b"just words\n" * 9, "no table of numbers"),
        (b"{ not json", "the file is not JSON"),
        (b'{"a": 1}', "no key holds a matrix"),
        (b"time_s,load_N\n", "no table of numbers"),
        (b"1," * 99999 + b"\n1,2\n", "no table of numbers"),
    ],
)
def test_what_is_no_log_is_refused(tmp_path, content, problem):
    (tmp_path / "log").write_bytes(content)
    with pytest.raises(LogError, match=problem):
        sniff_layout(tmp_path / "log")


TIME = np.arange(5) * 0.5


def tdms(path):
    with TdmsWriter(path) as writer:
        writer.write_segment([
            ChannelObject("other", "x", np.arange(2.0)),
            ChannelObject("log", "time", TIME, {"unit_string": "s"}),
            ChannelObject("log", "Load", TIME, {"unit_string": "kN"}),
        ])  # fmt: skip


def waveform(path):
    properties = {"unit_string": "kN", "wf_increment": 0.1, "wf_start_offset": 0.0}
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("log", "Load", TIME, properties)])


def hdf5(path):
    with h5py.File(path, "w") as file:
        file["notes"] = ["a"]
        file["run/time"], file["run/Load"] = TIME, TIME
        file["run/time"].attrs["units"], file["run/Load"].attrs["units"] = "s", "kN"


def hdf5_matrix(path):
    with h5py.File(path, "w") as file:
        file["run/M"] = np.column_stack([TIME, TIME])
        file["run/names"], file["run/units"] = ["time", "Load"], ["s", "kN"]


def matlab(path):
    scipy.io.savemat(path, {"run": {"log": {"time_s": TIME, "Load_kN": TIME, "id": "x"}}})


def matlab_matrix(path):
    names = np.array(["time", "Load"], dtype=object)
    units = np.array(["s", "kN"], dtype=object)
    scipy.io.savemat(path, {"M": np.column_stack([TIME, TIME]), "n": names, "u": units})


def parquet(path):
    pq.write_table(pa.table({"time_s": TIME, "Load (kN)": TIME, "remark": ["x"] * 5}), path)


@pytest.mark.parametrize(
    ("make", "kind"),
    [
        (tdms, "tdms"),
        (waveform, "tdms"),
        (hdf5, "hdf5"),
        (hdf5_matrix, "hdf5"),
        (matlab, "matlab"),
        (matlab_matrix, "matlab"),
        (parquet, "parquet"),
    ],
)
def test_the_proposal_for_a_binary_log_reads_it(tmp_path, make, kind):
    make(tmp_path / "log")
    assert format_of(tmp_path / "log") == kind
    found = proposed(tmp_path / "log")
    log = read_log(tmp_path / "log", filled(found), name="log")
    np.testing.assert_array_equal(log.columns["tension.1"], TIME)
    assert {key: unit for key, (_, unit) in columns(found).items()} == {
        "time": "s",
        "tension.1": "kN",
    }


def test_a_binary_file_without_columns_is_refused(tmp_path):
    with h5py.File(tmp_path / "log", "w") as file:
        file["notes"] = ["a"]
    with pytest.raises(LogError, match="no columns of numbers are found"):
        sniff_layout(tmp_path / "log")


def test_the_rows_of_a_wide_matrix_are_proposed_as_columns(tmp_path):
    path = tmp_path / "log.mat"
    names = np.array(["t", "x", "F"], dtype=object)
    rows = np.stack([np.arange(40.0)] * 3)
    scipy.io.savemat(path, {"train": rows, "names": names})
    assert "guess: the rows of the matrix are the columns" in " ".join(sniff_layout(path).remarks)
    assert proposed(path)["channels"]["time"]["column"] == "t"


def test_what_objects_of_matlab_keep_in_a_file_is_no_column(tmp_path):
    path = tmp_path / "log.mat"
    scipy.io.savemat(path, {"x": np.arange(300) % 256})
    named, nameless = b"\x01\x00\x01\x00x\x00\x00\x00", b"\x01" + bytes(7)
    path.write_bytes(path.read_bytes().replace(named, nameless))
    with pytest.raises(LogError, match="no columns of numbers are found; .*table2struct"):
        sniff_layout(path)


@pytest.mark.parametrize("name", ["Disp (mm)", "disp_mm", "Axial Disp (mm)", "Displacement (mm)"])
def test_a_short_word_for_displacement_is_a_position(tmp_path, name):
    path = write(tmp_path, f"Time (s),{name},Load (N)\n0,1,2\n1,2,3\n2,3,4\n")
    assert columns(proposed(path))["crosshead_position"] == (name, "mm")


@pytest.mark.parametrize(
    ("names", "units", "position"),
    [
        # the machine's own coordinate is some 0.8 m from any specimen
        ("Temps,Traverse absolue,Force standard,Course standard", "s,mm,N,mm", "Course standard"),
        ("Time,Crosshead absolute,Standard force,Standard travel", "s,mm,N,mm", "Standard travel"),
        # an elongation in a unit of length, not a strain
        ("Prüfzeit,Standardkraft,Dehnung", "s,N,mm", "Dehnung"),
    ],
)
def test_the_travel_of_the_test_is_the_position(tmp_path, names, units, position):
    # synthetic: a pull of 3 mm
    travel = np.linspace(0, 3, 60)
    own = {"mm": travel, "s": 10 * travel, "N": 5 * travel}
    columns = [
        own[unit] - (794.864 if "absol" in name else 0)
        for name, unit in zip(names.split(","), units.split(","), strict=True)
    ]
    path = tmp_path / "log.csv"
    rows = "\n".join(
        ",".join(f"{value:.3f}" for value in row) for row in zip(*columns, strict=True)
    )
    path.write_text(f"{names}\n{units}\n{rows}\n", encoding="utf-8")
    found = proposed(path)["channels"]
    assert found["crosshead_position"]["column"] == position
    assert "strain.1" not in found and found["tension"]["1"]["unit"] == "N"


def test_what_a_preamble_says_of_the_rate_is_quoted_where_no_column_is_time(tmp_path):
    head = "DMC Data File\nSample Frequency (Hz): 10000\nUnits\tmm\tmN\n\nSample\tAI0\tAI1\n"
    rows = "".join(f"{row}\t{row / 7:.4f}\t{row / 3:.4f}\n" for row in range(40))
    (tmp_path / "a.ddf").write_text(head + rows)
    said = [one for one in sniff_layout(tmp_path / "a.ddf").remarks if "the log says about" in one]
    assert said == ["unknown: the log says about it: Sample Frequency (Hz): 10000"]


def test_some_blanks_hide_neither_datum_nor_zero(tmp_path):
    time = np.arange(400) / 10
    stroke = np.where(time < 5, 0.0, 20 - 20 * np.cos(time - 5)) + 1e-3 * np.sin(700 * time)
    rows = [f"{t:.1f},{x:.3f},{9 * x - 14:.2f}" for t, x in zip(time, stroke, strict=True)]
    for k in (7, 30, 90, 170):
        rows[k] = f"{rows[k].rsplit(',', 1)[0]},n/a"
    channels = proposed(write(tmp_path, "Time (s),Stroke (mm),Load (N)\n" + "\n".join(rows)))
    position = channels["channels"]["crosshead_position"]
    assert (position["datum"], position["reference_length"]) == ("displacement", "?")
    assert channels["channels"]["tension"]["1"]["zero"].split()[0][:3] == "-14"


def test_two_columns_of_one_signal_that_disagree_are_told_apart_by_how_much(tmp_path):
    load = 500 + 400 * np.sin(np.arange(200) / 9)
    rows = [f"{k / 10:.1f},{k % 70},{f:.2f},{1.12 * f + 60:.2f}" for k, f in enumerate(load)]
    path = write(tmp_path, "Time (s),Stroke (mm),Load A (N),Load B (N)\n" + "\n".join(rows))
    said = " ".join(sniff_layout(path).remarks)
    assert '"Load B (N)" repeats column "Load A (N)", and is not used: it is 1.12 times' in said
    assert "reads 60 N where that reads 0" in said


@pytest.mark.parametrize("mark", [" ", "'", "\u00a0", "\u202f"])
def test_blanks_and_apostrophes_that_part_thousands_are_drafted_and_read(tmp_path, mark):
    rows = [f"{k / 10:.1f};{k % 70};{k % 70 * 50:,}".replace(",", mark) for k in range(200)]
    path = write(tmp_path, "Time (s);Stroke (mm);Load (N)\n" + "\n".join(rows))
    settings = proposed(path)
    assert settings["thousands"] == mark
    log = read_log(path, filled(settings), name="x")
    assert log.columns["tension.1"].max() == 3450
    with pytest.raises(LogError, match=r"Set thousands = "):
        read_log(path, filled({**settings, "thousands": ""}), name="x")


def test_a_table_with_more_labels_than_numbers_is_found(tmp_path):
    path = tmp_path / "fatigue.csv"
    rows = [
        f'"Cycle {i // 40 + 1}","CapPass",{i / 20:.2f},"Qualified",{np.sin(i / 6):.5f},'
        f'{150 * np.sin(i / 6 + 0.1):.2f},"43-13","Alloy 617"'
        for i in range(120)
    ]  # synthetic
    names = '"Cycle Label","State","Time Sec","Quality","Strain","Load kN","Sample","Alloy"'
    path.write_text("\n".join([names, *rows]) + "\n", encoding="utf-8")
    seen = columns(proposed(path))
    assert seen["time"] == ("Time Sec", "s")
    assert seen["tension.1"] == ("Load kN", "kN")
    path.write_text("\n".join([names, *rows[:20]]) + "\n", encoding="utf-8")
    with pytest.raises(LogError, match="no table of numbers"):  # a list of specimens
        sniff_layout(path)


def test_lines_above_the_table_of_a_workbook_are_quoted(tmp_path):
    rows = [["Report"], ["Width (mm)", 5.96], ["Test Speed (mm/min)", 10.0], []]
    rows += [["Extension (mm)", "Force (N)"], *([i / 10, 2.0 * i] for i in range(30))]  # synthetic
    path = write_xlsx(tmp_path / "log.xlsx", {"data": rows})
    assert sniff_layout(path).preamble == ("Report", "Width (mm) 5.96", "Test Speed (mm/min) 10")

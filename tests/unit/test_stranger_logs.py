"""Logs as machines of other makers and countries write them, made here from one synthetic test.

Only the form of each is a machine's; the numbers are one generated pull, so that what is read
can be held against it.
"""

import json
import re
import tomllib

import numpy as np
import pytest

from reduction.quantities.units import scale_to_si
from reduction.readers.layout import Layout
from reduction.readers.read_log import read_log
from reduction.readers.starter_campaign import starter_campaign

N = 241
TIME = np.arange(N) / 20
# at rest for two seconds, then cycles of 20 mm in 4 s
TRAVEL = np.where(TIME < 2, 0, 10 * (1 - np.cos((TIME - 2) * np.pi / 2)))  # mm
LOAD = 3.5 + 12 * TRAVEL + 0.05 * np.cos(37 * TIME)  # N, with what hangs on the cell


def table(columns, separator=",", decimal=".", digits=4, quote="", end="\n"):
    """Rows of a table as text; a column of texts stands as it is."""

    def written(value):
        text = value if isinstance(value, str) else f"{value:.{digits}f}".replace(".", decimal)
        return f"{quote}{text}{quote}"

    return "".join(separator.join(map(written, row)) + end for row in zip(*columns, strict=True))


def clock(seconds):
    return [
        f"{10 + int(t) // 3600:02d}:{int(t) // 60 % 60 + 58:02d}:{t % 60:06.3f}" for t in seconds
    ]


PREAMBLE = "".join(f"Parameter {i}\tWert {i * 1.5:.1f}\n" for i in range(30))

LVM = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
    "Decimal_Separator\t.\nMulti_Headings\tNo\nX_Columns\tOne\nTime_Pref\tAbsolute\n"
    "Date\t2024/05/03\nTime\t10:00:00.123\n***End_of_Header***\t\n\t\n"
    "Channels\t2\t\t\nSamples\t241\t241\t\nDate\t2024/05/03\t2024/05/03\t\n"
    "Time\t10:00:00.1\t10:00:00.1\t\nY_Unit_Label\tmm\tN\t\nX_Dimension\tTime\tTime\t\n"
    "X0\t0.0\t0.0\t\nDelta_X\t0.05\t0.05\t\n***End_of_Header***\t\t\t\n"
    "X_Value\tDisplacement\tForce\tComment\n"
)

TEXTS = {
    "MTS TestSuite": (
        "MTS TestSuite TW\nTest Run Name:,tether 7\n\n"
        '"Crosshead ","Load ","Time "\n"(mm)","(N)","(s)"\n' + table([TRAVEL, LOAD, TIME]),
        "utf-8",
    ),
    "testXpert, German": (
        "Prüfnorm;ohne\nPrüfer;AB\nVorkraft;0,5;N\n\n"
        "Prüfzeit;Standardweg;Standardkraft\ns;mm;N\n" + table([TIME, TRAVEL, LOAD], ";", ","),
        "latin-1",
    ),
    "TRAPEZIUM, Japanese": (
        '"試験名","引張"\n"時間","試験力","ストローク"\n"sec","N","mm"\n'
        + table([TIME, LOAD, TRAVEL], quote='"', end="\r\n"),
        "cp932",
    ),
    "Japanese, 荷重 and 変位": (
        "時間(秒),荷重(N),変位(mm)\n" + table([TIME, LOAD, TRAVEL]), "cp932",
    ),
    "Chinese, GB18030": (
        "试验编号 7\n时间(s)\t位移(mm)\t力(N)\n" + table([TIME, TRAVEL, LOAD], "\t"), "gb18030",
    ),
    "Chinese, UTF-8, 载荷": (
        "时间/s,位移/mm,载荷/kN\n" + table([TIME, TRAVEL, LOAD / 1e3], digits=7), "utf-8-sig",
    ),
    "Korean": ("시간(s),변위(mm),하중(N)\n" + table([TIME, TRAVEL, LOAD]), "euc_kr"),
    "Russian": (
        "Время, с;Перемещение, мм;Нагрузка, Н\n" + table([TIME, TRAVEL, LOAD], ";", ","), "cp1251",  # noqa: RUF001
    ),
    "Bluehill, Polish": (
        'Właściwości próbki : Długość;"25,00000";mm\n\n'
        "Godzina;Przemieszczenie;Obciążenie;Odkształcenie 1\n(s);(mm);(N);(mm/mm)\n"
        + table([TIME, TRAVEL, LOAD, TRAVEL / 25], ";", ",", quote='"', digits=5),
        "cp1250",
    ),
    "WaveMatrix": (
        '"Total Time (s)","Cycle Elapsed Time (s)","Total Cycles","Position(Linear:Position) (mm)",'
        '"Position(Linear:Digital Position) (mm)","Load(Linear:Load) (kN)",\n'
        + table([TIME, TIME, np.ones(N), TRAVEL, TRAVEL, LOAD / 1e3], digits=7, end=",\n"),
        "utf-8-sig",
    ),
    "WaveMatrix, digital position alone": (
        '"Total Time (s)","Cycle Elapsed Time (s)","Total Cycles",'
        '"Position(Linear:Digital Position) (mm)","Load(Linear:Load) (kN)",\n'
        + table([TIME, TIME, np.ones(N), TRAVEL, LOAD / 1e3], digits=7, end=",\n"),
        "utf-8-sig",
    ),
    "WaveMatrix, German": (
        '"Gesamtzeit (s)";"Verstrichene Zykluszeit (s)";"Gesamtzyklen";"Position des Aktuators (mm)"'
        ';"Kraft (N)";"Spannung (MPa)";"Digitale Position (mm)";"Temperatur (\u02daC)";\n'
        + table([TIME, TIME, np.ones(N), TRAVEL, LOAD, LOAD / 20, TRAVEL, 21 + TIME / 60], ";", ",",
                digits=7, end=";\n"),
        "utf-8-sig",
    ),
    "TracerDAQ": (
        "Header Size:  7\nVersion:  2\nSampling Interval:  0.05\nSampling Rate:  20\n"
        "Sample Count:  241\nDevice Serial Number:  0\n"
        "Sample Number, Date/Time, Stroke (mm), Load (N), Events\n"
        + re.sub(
            r"(?m)^(1|100|241)(,.*)$",
            r"\1\2, DAQ Pause",
            table([[str(i + 1) for i in range(N)], [f"05/13/2022 {one}" for one in clock(TIME)],
                   TRAVEL, LOAD], ",  "),
        ),
        "utf-8",
    ),
    "LabVIEW LVM": (LVM + table([TIME, TRAVEL, LOAD], "\t"), "utf-8"),
    "LabVIEW LVM, comments": (
        LVM
        + re.sub(
            r"(?m)^(0|5)(\.0*)?(\t.*)$",
            r"\1\3\tstart of part \1: 50.0 N/V",
            table([TIME, TRAVEL, LOAD], "\t"),
        ),
        "utf-8",
    ),
    "DewesoftX": (
        "Data info\nFile name:\tTest_0001.dxd\nStart time:\t5/3/2024 10:00:00.000\n"
        "Sample rate:\t20\tHz\nNumber of channels:\t2\n\nTime (s)\tAI 1/Force (N)\t"
        "AI 2/Stroke (mm)\n" + table([TIME, LOAD, TRAVEL], "\t"),
        "utf-8",
    ),
    "catman": (
        PREAMBLE + "Zeit  1 - Standardmessrate [s]\tKraft [N]\tWeg [mm]\n"
        + table([TIME, LOAD, TRAVEL], "\t", ","),
        "cp1252",
    ),
    "UTF-16 with tabs": ("Time [s]\tExtension [mm]\tForce [N]\n" + table([TIME, TRAVEL, LOAD], "\t"), "utf-16"),
    "UTF-16 without mark": (
        "Time [s]\tExtension [mm]\tForce [N]\n" + table([TIME, TRAVEL, LOAD], "\t"), "utf-16-le",
    ),
    "French": (
        "Essai;traction\nTemps;Déplacement;Effort\ns;mm;N\n" + table([TIME, TRAVEL, LOAD], ";", ","),
        "cp1252",
    ),
    "French, Chemin": ("Temps (s);Chemin (mm);Force (N)\n" + table([TIME, TRAVEL, LOAD], ";", ","), "utf-8"),
    "Spanish": ("Tiempo (s);Carrera (mm);Fuerza (N)\n" + table([TIME, TRAVEL, LOAD], ";", ","), "cp1252"),
    "Italian": ("Tempo [s];Corsa [mm];Carico [N]\n" + table([TIME, TRAVEL, LOAD], ";", ","), "utf-8"),
    "clock times": (
        "Time,Crosshead (mm),Load (N)\n" + table([clock(TIME), TRAVEL, LOAD]), "utf-8",
    ),
    "date and clock in one column": (
        "Timestamp,Position_mm,Force_N\n"
        + table([[f"2024-05-03T{one}" for one in clock(TIME)], TRAVEL, LOAD]),
        "utf-8",
    ),
    "date beside clock": (
        "Datum;Uhrzeit;Weg [mm];Kraft [N]\n"
        + table([["03.05.2024"] * N, clock(TIME), TRAVEL, LOAD], ";", ","),
        "utf-8",
    ),
    "counter of milliseconds": (
        "Zeit [ms];Weg [mm];Kraft [N]\n"
        + table([[f"{1000 * t:.0f}" for t in TIME], TRAVEL, LOAD], ";", ","),
        "utf-8",
    ),
    "names that say nothing, a row of units": (
        "CH1;CH2;CH3\ns;mm;N\n" + table([TIME, TRAVEL, LOAD], ";", ","), "utf-8",
    ),
    "names that say nothing, units in brackets": (
        "K0 [s],K1 [N],K2 [mm]\n" + table([TIME, LOAD, TRAVEL]), "utf-8",
    ),
    "Load Cell 1, in N and in %MBL": (
        "Time (s),Actuator (mm),Load Cell 1 (N),Load Cell 1 (%MBL)\n"
        + table([TIME, TRAVEL, LOAD, LOAD / 50]),
        "utf-8",
    ),
    "one load in two units": (
        "Time (s),Stroke (mm),Load (N),Load (kN)\n"
        + table([TIME, TRAVEL, LOAD, LOAD / 1e3], digits=6),
        "utf-8",
    ),
    "Bluehill Universal, results above the data": (
        "Results Table 1\n,Maximum Load [N],Modulus [MPa]\n1,243.5,1.25\n2,243.7,1.26\n\n\n"
        "Raw Data\n"
        '"Time","Extension","Load","Tensile strain","Tensile stress"\n"(s)","(mm)","(N)","(%)","(MPa)"\n'
        + table([TIME, TRAVEL, LOAD, TRAVEL / 2, LOAD / 20], quote='"'),
        "utf-8",
    ),
    "blanks and units in a row": (
        "   Time     Disp     Force\n   sec      mm       N\n"
        + "".join(f"{t:10.3f}{x:10.4f}{f:10.4f}\n" for t, x, f in zip(TIME, TRAVEL, LOAD, strict=True)),
        "utf-8",
    ),
    "units behind a slash and a comma": (
        "time/s;displacement/mm;Load, N\n" + table([TIME, TRAVEL, LOAD], ";", ","), "utf-8",
    ),
    "names over two rows": (
        "Running,Axial,Axial\nTime,Displacement,Force\n(s),(mm),(N)\n" + table([TIME, TRAVEL, LOAD]),
        "utf-8",
    ),
    "a number of the row in front": (
        "No.,Time (s),Extension (mm),Load (N)\n"
        + table([[str(i + 1) for i in range(N)], TIME, TRAVEL, LOAD]),
        "utf-8",
    ),
    "command beside feedback": (
        "Time (s),Axial Displacement Command (mm),Axial Displacement (mm),Axial Force (N)\n"
        + table([TIME, TRAVEL + 1, TRAVEL, LOAD]),
        "utf-8",
    ),
    "quoted decimal commas parted by commas": (
        '"Zeit [s]","Weg [mm]","Kraft [N]"\n' + table([TIME, TRAVEL, LOAD], ",", ",", quote='"'),
        "utf-8",
    ),
}  # fmt: skip

JSON = {
    "an object of columns": {"Time (s)": [*TIME], "Stroke (mm)": [*TRAVEL], "Force (N)": [*LOAD]},
    "columns in a place": {
        "test": {"id": "T-7", "data": {"Time (s)": [*TIME], "Stroke (mm)": [*TRAVEL], "Force (N)": [*LOAD]}},
        "rates": [20, 20],
    },
    "records": [
        {"Time (s)": t, "Stroke (mm)": x, "Force (N)": f}
        for t, x, f in zip(TIME.tolist(), TRAVEL.tolist(), LOAD.tolist(), strict=True)
    ],
    "records in a place": {
        "meta": {"operator": "AG"},
        "result": {"rows": [
            {"Time (s)": t, "Stroke (mm)": x, "Force (N)": f}
            for t, x, f in zip(TIME.tolist(), TRAVEL.tolist(), LOAD.tolist(), strict=True)
        ]},
    },
}  # fmt: skip


def draft(folder, name, content):
    """What `init` writes for a folder with one log: the campaign, and the layout of the log."""
    (folder / name).write_bytes(content)
    files = starter_campaign(folder)
    document = tomllib.loads(files["campaign.toml"])
    (layout,) = document["layouts"].values()
    return files["campaign.toml"], layout


def answered(layout):
    """A layout of which a person has answered what is asked of the position alone."""
    position = layout["channels"]["crosshead_position"]
    assert position["datum"] == "displacement"  # which begins at zero
    assert position["reference_length"] == "?"
    position["reference_length"] = "2.5 m"
    if (zero := layout["channels"]["tension"]["1"].get("zero")) is not None:
        assert zero == "?"  # 3.5 N may be a preload: a person has to say
        layout["channels"]["tension"]["1"]["zero"] = "0 N"
    return Layout.model_validate(layout)


def check_channels(log, layout):
    units = {key: channel.unit for key, channel in layout.channels.items()}
    factor = {
        key: 1.0 if unit == "clock" else scale_to_si(unit, layout.dimension(key))[0]
        for key, unit in units.items()
    }
    assert set(log.columns) >= {"time", "crosshead_position", "tension.1"}
    assert "tension.2" not in log.columns
    got = {key: factor[key] * log.columns[key] for key in units}
    np.testing.assert_allclose(got["time"] - got["time"][0], TIME, atol=1e-9)
    np.testing.assert_allclose(got["crosshead_position"], TRAVEL / 1e3, atol=1e-7)
    np.testing.assert_allclose(got["tension.1"], LOAD, atol=1e-3)


@pytest.mark.parametrize("name", TEXTS)
def test_the_draft_for_a_stranger_reads_it(tmp_path, name):
    text, encoding = TEXTS[name]
    _, layout = draft(tmp_path, "log.txt", text.encode(encoding))
    layout = answered(layout)
    check_channels(read_log(tmp_path / "log.txt", layout, name="log.txt"), layout)


@pytest.mark.parametrize("name", JSON)
def test_the_draft_for_json_reads_it(tmp_path, name):
    _, layout = draft(tmp_path, "log.json", json.dumps(JSON[name]).encode())
    layout = answered(layout)
    check_channels(read_log(tmp_path / "log.json", layout, name="log.json"), layout)


def test_the_draft_for_json_lines_reads_it(tmp_path):
    lines = "\n".join(map(json.dumps, JSON["records"])) + "\n"
    _, layout = draft(tmp_path, "log.jsonl", lines.encode())
    layout = answered(layout)
    check_channels(read_log(tmp_path / "log.jsonl", layout, name="log.jsonl"), layout)


def text_log(load, travel=TRAVEL):
    return ("Time (s),Stroke (mm),Load (N)\n" + table([TIME, travel, load])).encode()


def test_a_load_below_zero_at_rest_is_proposed_as_the_zero(tmp_path):
    text, layout = draft(tmp_path, "log.csv", text_log(LOAD - 20))
    number, unit = layout["channels"]["tension"]["1"]["zero"].split()
    # 3.5 - 20, to a two-thousandth of what the load travels
    assert float(number) == pytest.approx(-16.5, abs=0.1) and unit == "N"
    assert "guess: zero" in text and "a slack line cannot push" in text


@pytest.mark.parametrize(("resting", "noise"), [(5, 5.0), (30, 20.0), (200, 2.0)])
def test_a_zero_is_proposed_only_where_the_rest_shows_it_to_a_fraction_of_the_load(
    tmp_path, resting, noise
):
    """Synthetic: 3 kN of range, a zero of -60 N; five readings of 5 N gave zeros 5 N off."""
    time = np.arange(resting + 400) / 10
    travel = 100 * (1 - np.cos(np.clip(time - resting / 10, 0, None) / 2))
    zeros = []
    for seed in range(8):
        load = 15 * travel - 60 + np.random.default_rng(seed).normal(0, noise, time.size)
        log = "Time (s),Stroke (mm),Load (N)\n" + table([time, travel, load])
        text, layout = draft(tmp_path, "log.csv", log.encode())
        zeros.append(layout["channels"]["tension"]["1"].get("zero"))
        assert zeros[-1] != "?" or "[uncertainty.tension]" in text
    stated = [float(zero.split()[0]) for zero in zeros if zero not in (None, "?")]
    assert len(stated) == (8 if resting == 200 else 0)
    assert np.abs(np.array(stated) + 60).max(initial=0.0) < 1


def test_a_load_that_is_next_to_nothing_at_rest_needs_no_zero(tmp_path):
    text, layout = draft(tmp_path, "log.csv", text_log(LOAD - 3.5))
    assert "zero" not in layout["channels"]["tension"]["1"]
    assert "guess: no zero is needed" in text


@pytest.mark.parametrize(
    ("load", "travel", "turned"),
    [(-LOAD, TRAVEL, "tension"), (LOAD, -TRAVEL, "crosshead_position"), (LOAD, TRAVEL, None)],
)
def test_the_channel_that_runs_backward_gets_a_sign(tmp_path, load, travel, turned):
    _, layout = draft(tmp_path, "log.csv", text_log(load, travel))
    channels = {**layout["channels"], "tension": layout["channels"]["tension"]["1"]}
    assert {key for key, one in channels.items() if one.get("sign") == -1} == {turned} - {None}


def test_a_strain_that_is_counted_in_compression_follows_the_sign_of_the_gap(tmp_path):
    # a rheometer in compression: the gap falls, strain goes below zero, the load is positive
    names = "Step time,Axial force,Gap,Strain\ns,N,mm,%\n"
    log = names + table([TIME, LOAD, 80 - TRAVEL, -TRAVEL / 25])
    _, layout = draft(tmp_path, "log.csv", log.encode())
    assert layout["channels"]["crosshead_position"]["sign"] == -1
    assert layout["channels"]["strain"]["1"]["sign"] == -1


def test_a_clip_gauge_that_is_taken_off_in_a_pull_keeps_its_sign(tmp_path):
    travel = np.linspace(0, 5, 400)  # synthetic
    gauge = np.where(travel < 3, travel / 100, -0.15)
    text = "Time (s),Extension (mm),Load (N),Strain 1 (mm/mm)\n"
    rows = table([np.arange(400) / 10, travel, 50 * travel, gauge])
    _, layout = draft(tmp_path, "log.csv", (text + rows).encode())
    assert "sign" not in layout["channels"]["strain"]["1"]


def test_a_polish_log_keeps_its_letters_and_its_strain(tmp_path):
    text, encoding = TEXTS["Bluehill, Polish"]
    _, layout = draft(tmp_path, "log.csv", text.encode(encoding))
    assert layout["encoding"] == "cp1250"
    assert layout["channels"]["tension"]["1"]["column"] == "Obciążenie"
    assert layout["channels"]["strain"]["1"]["column"] == "Odkształcenie 1"


def test_a_position_far_above_its_travel_is_a_length(tmp_path):
    _, layout = draft(tmp_path, "log.csv", text_log(LOAD, 2500 + TRAVEL))
    assert layout["channels"]["crosshead_position"]["datum"] == "pin-to-pin"


def test_of_a_log_that_only_rests_nothing_is_guessed(tmp_path):
    noise = 0.01 * np.sin(17.0 * np.arange(N) ** 2)
    _, layout = draft(tmp_path, "log.csv", text_log(3.5 + noise, 0.02 + noise))
    assert layout["channels"]["crosshead_position"]["datum"] == "?"
    assert "zero" not in layout["channels"]["tension"]["1"]


def test_a_ramp_from_the_first_sample_on_has_no_rest(tmp_path):
    _, layout = draft(tmp_path, "log.csv", text_log(5 + 12 * TIME, 10 * TIME))
    assert "zero" not in layout["channels"]["tension"]["1"]


def test_logs_that_begin_unlike_share_a_layout_with_a_question(tmp_path):
    (tmp_path / "T-1.csv").write_bytes(text_log(LOAD - 20))
    (tmp_path / "T-2.csv").write_bytes(text_log(LOAD - 30))
    files = starter_campaign(tmp_path)
    (layout,) = tomllib.loads(files["campaign.toml"])["layouts"].values()
    assert layout["channels"]["tension"]["1"]["zero"] == "?"
    assert "differ in how they begin (T-2.csv unlike T-1.csv)" in files["campaign.toml"]


@pytest.mark.parametrize("content", [b"just words\n" * 9, "荷重なし\n".encode("cp932")])
def test_a_file_without_a_table_has_a_draft_of_questions(tmp_path, content):
    text, layout = draft(tmp_path, "log.txt", content)
    assert layout["format"] == "?"
    assert "#   log.txt: no table of numbers" in text


def test_comments_of_labview_are_kept_and_are_no_fields(tmp_path):
    text, encoding = TEXTS["LabVIEW LVM, comments"]
    assert text.count("start of part") == 2
    _, layout = draft(tmp_path, "log.lvm", text.encode(encoding))
    log = read_log(tmp_path / "log.lvm", answered(layout), name="log.lvm")
    said = {key: text for key, text in log.metadata.items() if key.startswith("start of")}
    assert said == {"start of part 0": "50.0 N/V", "start of part 5": "50.0 N/V"}


@pytest.mark.parametrize(
    "name",
    ["Tensile strain (Extension)", "压缩应变 (位移)", "Deformación por tracción (Extensión)"],
)
def test_a_strain_that_the_machine_calculates_from_its_travel_is_no_extensometer(tmp_path, name):
    def log(*names):
        rows = table([TIME, TRAVEL, LOAD, TRAVEL / 100, TRAVEL / 120][: len(names)])
        units = ["s", "mm", "N", "mm/mm", "mm/mm"][: len(names)]
        return f"{','.join(names)}\n({'),('.join(units)})\n{rows}".encode()

    _, layout = draft(tmp_path, "log.csv", log("Time", "Extension", "Load", name))
    assert "strain" not in layout["channels"]
    _, layout = draft(tmp_path, "log.csv", log("Time", "Extension", "Load", name, "Strain 1"))
    assert layout["channels"]["strain"]["1"]["column"] == "Strain 1"


def test_a_gauge_length_is_asked_for_where_any_log_has_no_strain(tmp_path):
    names, columns = "Time (s),Extension (mm),Load (N)", [TIME, TRAVEL, LOAD]
    with_strain = f"{names},Strain 1 (mm/mm)\n" + table([*columns, TRAVEL / 100])
    (tmp_path / "a.csv").write_text(with_strain, "utf-8")
    assert 'gauge_length = "?"' not in starter_campaign(tmp_path)["campaign.toml"]
    (tmp_path / "b.csv").write_text(f"{names}\n" + table(columns), "utf-8")
    assert 'gauge_length = "?"' in starter_campaign(tmp_path)["campaign.toml"]


def test_thousands_marks_are_found_at_the_end_of_a_long_log(tmp_path):
    time = np.arange(0, 1100, 0.1)  # synthetic; more than the part that the draft reads
    times = [f"{one:,.5f}" for one in time]
    text = '"Time (s)","Extension (mm)","Load (N)"\n' + table(
        [times, 5 * np.sin(time / 30), 60 * np.sin(time / 30)], quote='"', digits=5
    )
    _, layout = draft(tmp_path, "log.csv", text.encode())
    assert layout["thousands"] == ","
    _, layout = draft(tmp_path, "log.csv", text.replace('"1,', '"1').encode())
    assert "thousands" not in layout


def test_columns_without_names_that_rise_may_be_times_of_channels(tmp_path):
    t = np.cumsum(np.full(40, 0.1))
    wave, load = np.sin(t), np.cos(t)
    text, _ = draft(tmp_path, "log.csv", table([wave, t, load, t + 0.05]).encode())
    assert "# unknown: columns 2, 4 rise all the time" in text
    text, layout = draft(tmp_path, "log.csv", table([wave, t, load]).encode())
    assert layout["channels"]["time"]["column"] == 2


def test_a_time_without_a_name_may_be_set_back_once(tmp_path):
    place = np.arange(2001)
    set_back = 0.1 * place + np.where(place < 900, 0.95, 0.0)  # synthetic
    travel = 10 - 10 * np.cos(place / 20)
    _, layout = draft(tmp_path, "log.csv", table([set_back, travel, 12 * travel]).encode())
    assert layout["channels"]["time"]["column"] == 1


@pytest.mark.parametrize("names", ["t,x,F", "Time,L,F", "tout,dist,forc", "Time,Distance,Force"])
def test_short_names_without_units_are_read(tmp_path, names):
    log = f"{names}\n{table([TIME, TRAVEL, LOAD])}"
    _, layout = draft(tmp_path, "log.csv", log.encode())
    channels = layout["channels"]
    found = [channels["time"], channels["crosshead_position"], channels["tension"]["1"]]
    assert [channel["column"] for channel in found] == names.split(",")


def test_lines_of_a_preamble_that_state_section_gauge_and_height_are_quoted(tmp_path):
    said = ['"Section",5.9,"mm2"', '"L0",25,"mm"', '"Anvil height",6.0,"mm"']
    head = "\n".join([*said, '"Operator","AB"', "", ""])
    text, _ = draft(tmp_path, "log.csv", head.encode() + text_log(LOAD))
    assert text.count("# from the log: ") == 3


def test_a_specimen_of_a_single_log_is_named_and_its_sizes_are_quoted(tmp_path):
    preamble = b"Specimen width (mm);6\nOperator;AB\n\n"
    text, _ = draft(tmp_path, "log.csv", preamble + text_log(LOAD).replace(b",", b";"))
    assert set(tomllib.loads(text)["specimens"]) == {"specimen-1"}
    assert "# from the log: Specimen width (mm) 6\n" in text and "Operator" not in text

import csv
import io
import tomllib
from pathlib import Path

import numpy as np
import pytest
from workbook import write_xlsx

from reduction.campaign.load import load_campaign
from reduction.readers.starter_campaign import starter_campaign
from reduction.record.errors import LogError, SettingsError

RAW = Path(__file__).parents[2] / "raw" / "tmt-synthetic"
LOG = "time_s,crosshead_ft,load_new_lb,load_used_lb\n0,12,1,2\n1,13,2,3\n2,14,3,4\n"
ONE = "Zeit;Kraft\ns;kN\n0;1,5\n1;2,5\n2;3,5\n"


def rows(files):
    return list(csv.DictReader(io.StringIO(files["tests.csv"])))


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "summer tests"
    folder.mkdir()
    for name in ("T-2.csv", "T-10.csv", "T-1.csv"):
        (folder / name).write_text(LOG)
    (folder / "über 5.txt").write_text(ONE, encoding="latin-1")
    (folder / "notes.md").write_text("just words\n")
    (folder / ".hidden.csv").write_text(LOG)
    (folder / "campaign.toml").write_text("")
    (folder / "marks.csv").write_text("test,specimen,hold,near_toe_ft,far_toe_ft,far_thimble_ft\n")
    (folder / "deeper").mkdir()
    return folder


def test_each_log_has_a_row_in_natural_order(folder):
    table = rows(starter_campaign(folder))
    assert [row["file"] for row in table] == ["T-1.csv", "T-2.csv", "T-10.csv", "über 5.txt"]
    assert [row["id"] for row in table] == ["T-1", "T-2", "T-10", "ber-5"]
    assert list(table[0]) == ["id", "kind", "file", "layout", "order", "specimens"]
    assert {row["order"] for row in table} == {""}


def test_logs_that_look_alike_share_a_layout(folder):
    files = starter_campaign(folder)
    assert [row["layout"] for row in rows(files)] == ["log", "log", "log", "log-2"]
    assert set(tomllib.loads(files["campaign.toml"])["layouts"]) == {"log", "log-2"}


def test_logs_whose_units_stand_above_the_table_share_a_layout_only_with_their_like(tmp_path):
    log = LOG.replace("time_s,crosshead_ft,load_new_lb,load_used_lb", "time,crosshead,one,two")
    for name, above in (("A", "[ft]; loads [lbf]"), ("B", "[ft]; loads [N]"), ("C", "[ft] [lbf]")):
        (tmp_path / f"{name}.csv").write_text(f"# crosshead {above}\n{log}")
    files = starter_campaign(tmp_path)
    assert [row["layout"] for row in rows(files)] == ["log", "log-2", "log"]
    assert "# from the log: units ft, N\n[layouts.log-2]" in files["campaign.toml"]


def test_each_load_of_a_log_asks_for_its_specimen(folder):
    files = starter_campaign(folder)
    assert [row["specimens"] for row in rows(files)] == ["?;?", "?;?", "?;?", "?"]
    draft = tomllib.loads(files["campaign.toml"])
    assert set(draft["specimens"]) == {"?"}
    assert "specimens" not in draft["defaults"]
    assert draft["campaign"]["title"] == "summer tests"


def test_marks_are_used_and_what_is_no_log_is_listed(folder):
    (folder / "marks-2.csv").write_text((folder / "marks.csv").read_text())
    text = starter_campaign(folder)["campaign.toml"]
    assert tomllib.loads(text)["defaults"]["strain"] == {"marks": "marks-2.csv"}
    assert "#   notes.md: no table of numbers" in text
    assert "#   marks.csv: another table of marks" in text
    assert "#   deeper/: a folder; move its logs up" in text
    assert ".hidden" not in text


def test_the_draft_says_how_position_becomes_strain_where_no_marks_lie(folder):
    assert "# strain" not in starter_campaign(folder)["campaign.toml"]
    (folder / "marks.csv").unlink()
    text = starter_campaign(folder)["campaign.toml"]
    assert '# strain = { marks = "marks.csv" }\n' in text and "gauge_length = " in text
    assert "strain" not in tomllib.loads(text)["defaults"]


def test_the_draft_has_room_for_the_settings_of_one_test(folder):
    text = starter_campaign(folder)["campaign.toml"]
    document = tomllib.loads(text + "[tests.T-1]\nreduction.modulus.window = 0.1\n")
    assert document["campaign"]["tests"] == "tests.csv" and "T-1" in document["tests"]


def test_the_draft_names_the_waveform_that_is_taken_where_none_is_stated(folder):
    assert (
        '# waveform = "sinusoidal"  # or other; triangular if'
        in starter_campaign(folder)["campaign.toml"]
    )


def test_two_files_of_one_name_have_two_ids(folder):
    (folder / "T-1.txt").write_text(LOG)
    names = [row["id"] for row in rows(starter_campaign(folder))]
    assert names[:2] == ["T-1", "T-1-2"]


def test_a_file_without_position_or_load_is_no_log(tmp_path):
    (tmp_path / "T-1.csv").write_text(LOG)
    (tmp_path / "diameters.csv").write_text("a,b\n1,2\n2,3\n3,4\n")
    text = starter_campaign(tmp_path)["campaign.toml"]
    assert "#   diameters.csv: no column looks like a position or a load" in text


def test_units_above_a_table_in_volts_are_not_those_of_its_readings(tmp_path):
    """As a muscle lever writes it: the units and the scale of each channel, then volts."""
    table = "".join(f"{i}\t{i % 40 / 10:.4f}\t{i % 40 / 90:.4f}\n" for i in range(400))
    (tmp_path / "log.ddf").write_text(
        "Sample Frequency (Hz): 1000\nChannel\tAI0\tAI1\nUnits\tmm\tmN\n"
        "Scale (units/V)\t1.0\t500.0\n\nTest Data in Volts:\n\nSample\tAI0\tAI1\n" + table
    )
    text = starter_campaign(tmp_path)["campaign.toml"]
    assert '"AI1", 0 to 0.4333' in text and '"AI1" in mN' not in text
    assert "# from the log: Scale (units/V) 1.0 500.0" in text
    assert "# from the log: Test Data in Volts:" in text
    assert "# from the log: Units mm mN" in text and "# from the log: units Hz" not in text


def test_a_folder_without_logs_is_refused(tmp_path):
    with pytest.raises(LogError, match="the folder holds no log; found no files"):
        starter_campaign(tmp_path)
    (tmp_path / "notes.md").write_text("words\n")
    with pytest.raises(LogError, match=r"found notes\.md: no table of numbers"):
        starter_campaign(tmp_path)


def test_the_draft_loads_once_every_question_is_answered(folder):
    (folder / "marks.csv").unlink()
    (folder / "campaign.toml").unlink()
    for name, text in starter_campaign(folder).items():
        (folder / name).write_text(text, encoding="utf-8")
    with pytest.raises(SettingsError) as raised:
        load_campaign(folder / "campaign.toml")
    asked = [line.strip() for line in str(raised.value).splitlines()]
    assert asked[0].endswith("campaign.toml: 9 values are still '?'")
    assert asked[1:] == [
        *("specimens.?", "specimens.?.kind", "specimens.?.diameter", "specimens.?.gauge_length"),
        "layouts.log.channels.crosshead_position.datum",  # three rows do not show a movement
        *(f"tests.csv:{row} [specimens]" for row in (2, 3, 4, 5)),
    ]
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    section = text[text.index('[specimens."?"]') : text.index("[defaults]")]
    answered = (
        text.replace(section, section.replace('"?"]\nkind', '"used"]\nkind') + section)
        .replace('[specimens."?"]', "[specimens.new]")
        .replace('datum = "?"', 'datum = "pin-to-pin"')
        .replace('kind = "?"', 'kind = "rope"')
        .replace('diameter = ["?"]', 'diameter = ["1 in"]')
        .replace('gauge_length = "?"', 'gauge_length = "2 m"')
        .replace('"?"', '"told"')
    )
    (folder / "campaign.toml").write_text(answered, encoding="utf-8")
    table = (folder / "tests.csv").read_text(encoding="utf-8")
    (folder / "tests.csv").write_text(
        table.replace("?;?", "new;used").replace("?", "used"), encoding="utf-8"
    )
    campaign = load_campaign(folder / "campaign.toml")
    assert campaign.id == "summer-tests"
    assert set(campaign.specimens) == {"new", "used"}
    specimens = {name: plan.specimens for name, plan in campaign.tests.items()}
    assert list(specimens) == ["T-1", "T-2", "T-10", "ber-5"]
    assert specimens["T-1"] == ("new", "used") and specimens["ber-5"] == ("used",)


@pytest.mark.parametrize(
    ("knots", "kind"),
    [
        ([(0, 0), (100, 10)], "tensile"),
        ([(0, 0), (15, 0), (90, 10), (100, 10)], "tensile"),
        ([(0, 0), (10, 10), (100, 10)], "relaxation"),
        ([(0, 0), (10, 10), (90, 10), (100, 0)], "relaxation"),
        ([(0, 0), (10, 5), (45, 5), (55, 8), (70, 8), (80, 10), (100, 10)], ""),
        ([(0, 0), (50, 10), (100, 0)], ""),
        ([(time, 10 * (time % 20 > 0)) for time in range(0, 110, 10)], ""),
    ],
)
@pytest.mark.parametrize("n_rows", [60, 3000])
def test_the_kind_of_a_test_that_does_not_cycle_is_drafted(tmp_path, knots, kind, n_rows):
    time = np.linspace(0, 100, n_rows)
    position = np.interp(time, *zip(*knots, strict=True))
    position += np.random.default_rng(1).normal(0, 0.002, n_rows)
    lines = [f"{t:.3f},{x:.4f},{3 * x:.3f}\n" for t, x in zip(time, position, strict=True)]
    (tmp_path / "T-1.csv").write_text("".join(["Time (s),Position (mm),Load (N)\n", *lines]))
    files = starter_campaign(tmp_path)
    assert [row["kind"] for row in rows(files)] == [kind]
    assert ("# guess: the kinds in tests.csv" in files["campaign.toml"]) is bool(kind)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_pull_that_breaks_slowly_keeps_its_sign(tmp_path, sign):
    """A connection that is torn apart: its load falls over nine tenths of the travel; synthetic."""
    travel = np.linspace(0, 30, 300)
    load = 2700 * np.interp(travel, [0, 3, 30], [0, 1, 0.2])
    rows = zip(np.arange(300) / 10, sign * travel, load, strict=True)
    lines = [f"{t:.1f},{x:.3f},{f:.1f}" for t, x, f in rows]
    (tmp_path / "T-1.csv").write_text("\n".join(["Time (s),Travel (mm),Load (N)", *lines, ""]))
    layout = tomllib.loads(starter_campaign(tmp_path)["campaign.toml"])["layouts"]["log"]
    assert layout["channels"]["crosshead_position"].get("sign", 1) == sign


def test_a_sheet_of_means_beside_the_logs_is_no_log(tmp_path):
    """As in an export of testXpert with its statistics; synthetic."""
    log = [["Time [s]", "Travel [mm]", "Force [N]"], *([i, i, 2.0 * i] for i in range(20))]
    means = [["", "Fmax [N]", "dL [mm]"], ["x", 38.0, 19.0], ["s", 1.0, 0.5], ["n [%]", 2.6, 2.6]]
    write_xlsx(tmp_path / "pulls.xlsx", {"Statistics": means, "T 1": log})
    files = starter_campaign(tmp_path)
    assert [row["layout"] for row in rows(files)] == ["xlsx-T-1"]
    assert "pulls.xlsx, sheet 'Statistics': 3 rows" in files["campaign.toml"]


def test_a_workbook_without_a_table_is_named(tmp_path):
    write_xlsx(tmp_path / "form.xlsx", {"Form": [["Operator", "KH"], ["Rope", "R-7"]]})
    with pytest.raises(LogError, match=r"form\.xlsx: no sheet holds a table of numbers"):
        starter_campaign(tmp_path)


def test_each_sheet_of_a_workbook_that_holds_a_table_is_a_log(tmp_path):
    table = [line.split(",") for line in LOG.splitlines()]
    sheet = [table[0], *([float(cell) for cell in row] for row in table[1:])]
    write_xlsx(tmp_path / "logs.xlsx", {"Readme": [["words"]], "T 1": sheet, "T 2": sheet})
    files = starter_campaign(tmp_path)
    assert [row["id"] for row in rows(files)] == ["logs-T-1", "logs-T-2"]
    assert [row["layout"] for row in rows(files)] == ["xlsx-T-1", "xlsx-T-2"]
    layouts = tomllib.loads(files["campaign.toml"])["layouts"]
    assert layouts["xlsx-T-2"]["sheet"] == "T 2"


def test_the_draft_for_the_tether_tests_has_every_log():
    files = starter_campaign(RAW)
    names = [f"T-{n}" for n in range(1, 7)] + ["overnight_hold"]
    names += ["T-4_extended", "T-4_extended_end_5Hz", "T-4_extended_start_5Hz"]
    assert {row["file"] for row in rows(files)} == {f"{name}.csv" for name in names}
    assert {row["layout"] for row in rows(files)} == {"log"}
    assert {row["specimens"] for row in rows(files)} == {"?;?"}
    assert tomllib.loads(files["campaign.toml"])["defaults"]["strain"] == {"marks": "marks.csv"}


def test_tables_whose_columns_nobody_knows_are_logs_where_there_are_no_others(tmp_path):
    ddf = "Sample\tAI0\tAI1\n" + "".join(f"{i}\t{i / 7:.3f}\t{i / 3:.3f}\n" for i in range(9))
    (tmp_path / "run.ddf").write_text(ddf)
    (tmp_path / "notes.md").write_text("just words\n")
    files = starter_campaign(tmp_path)
    assert [row["file"] for row in rows(files)] == ["run.ddf"]
    assert 'column = "?"' in files["campaign.toml"]
    (tmp_path / "T-1.csv").write_text(LOG)
    files = starter_campaign(tmp_path)
    assert [row["file"] for row in rows(files)] == ["T-1.csv"]
    assert "run.ddf: no column looks like a position or a load" in files["campaign.toml"]

"""`reduction predict hose`: what is printed, the keys of --json, the files, and refusals."""

import json

import numpy as np
import pytest
from commandruns import answered
from csvrows import csv_rows

from reduction.archive.open import open_archive

SPEC = """
[hose]
wrap_angle = "68 deg"
wrap_diameter = "3.5 in"
inner_diameter = "2.5 in"
outer_diameter = "5 in"
cords_per_length = "34 1/in"
cord_diameter = "0.022 in"
rubber_modulus = "200 psi"
rubber_law = "neo-hookean"
[[hose.layers]]
name = "Kevlar"
wrap_angle = "66 deg"
strain_limit = "2 %"
[hose.standard_uncertainty]
wrap_angle = "0.5 deg"
[cord]
strain = [0.0, 0.02, 0.06, 0.10, 0.15, 0.22]
load = ["0 lbf", "1.6 lbf", "5 lbf", "10 lbf", "18 lbf", "30 lbf"]
"""
BARE = SPEC.replace('[hose.standard_uncertainty]\nwrap_angle = "0.5 deg"\n', "")
LBF, INCH, PSI = 4.4482216152605, 0.0254, 6894.757293168
# WHOI-2004-06, eq. (8): a cord has its length again at (sqrt(1 + 4 tan2) - 3)/2
PICK_UP = (np.sqrt(1 + 4 * np.tan(np.radians(68)) ** 2) - 3) / 2
LISTS = (
    "strain", "tension", "fill_pressure", "cord_tension", "cord_strain", "cord_share",
    "rubber_share",
)  # fmt: skip


@pytest.fixture
def predict(tmp_path, command):
    """The command on a SPEC.toml."""

    def run(*options, spec=SPEC):
        (tmp_path / "gumby.toml").write_text(spec)
        return command("predict", "hose", "gumby.toml", *options, cwd=tmp_path)

    return run


def rows(text):
    """Words of each line of the printed tables."""
    return [line.split() for line in text.splitlines()]


def test_the_keys_that_are_fixed_are_there_as_lists_of_one_length(predict):
    answer = answered(predict("--json"))
    assert {len(answer[name]) for name in LISTS} == {len(answer["strain"])}
    assert {"pick_up", "working", "break"} <= answer["events"].keys()
    for event in answer["events"].values():
        assert {"strain", "tension"} <= event.keys()
    assert {answer["units"][name] for name in ("strain", "cord_strain", "cord_share")} == {"1"}
    assert answer["units"]["tension"] == answer["units"]["cord_tension"] == "N"
    assert answer["units"]["fill_pressure"] == "Pa"
    assert answer["hose"] == "gumby" and answer["out"] is None


def test_events_have_the_numbers_of_the_closed_forms(predict):
    events = answered(predict("--json"))["events"]
    assert events["pick_up"]["strain"] == pytest.approx(PICK_UP, rel=1e-9)
    area = np.pi / 4 * (5**2 - 2.5**2) * INCH**2
    rubber = area * 200 * PSI / 3 * (1 + PICK_UP - (1 + PICK_UP) ** -2)
    assert events["pick_up"]["tension"] == pytest.approx(rubber, rel=1e-9)
    assert events["working"]["cord_tension"] == pytest.approx(10 * LBF)
    assert events["break"]["cord_strain"] == pytest.approx(0.22)
    # WHOI-2004-06 warns of the angle; its sensitivity at pick-up is 12.2 points a degree
    assert events["pick_up"]["strain_standard_uncertainty"] == pytest.approx(0.061, abs=5e-4)
    # held by draws in tests/unit/test_predict_uncertainty.py; it lies before the pick-up and moves less
    slack = events["deepest_slack"]
    assert slack["strain"] < events["pick_up"]["strain"]
    assert 0 < slack["strain_standard_uncertainty"] < 0.061


def test_shares_are_of_the_whole_and_the_slack_zone_is_the_rubbers(predict):
    answer = answered(predict("--json"))
    shares = np.array(answer["cord_share"]) + np.array(answer["rubber_share"])
    assert shares == pytest.approx(1)
    is_slack = np.array(answer["strain"]) <= PICK_UP
    assert answer["is_slack"] == is_slack.tolist()
    assert not np.array(answer["fill_pressure"])[is_slack].any()


def test_without_a_stated_uncertainty_there_is_none_in_the_answer(predict):
    answer = answered(predict("--json", spec=BARE))
    assert answer["tension_standard_uncertainty"] is None
    assert answer["fill_pressure_standard_uncertainty"] is None
    assert answer["uncertainty_sources"] == {}
    assert answer["events"]["working"]["tension_standard_uncertainty"] is None
    assert any("no uncertainty is stated for the hose" in one for one in answer["notes"])


def test_beyond_the_break_the_answer_has_no_load(predict):
    spec = SPEC.replace("[hose]", '[hose]\nstrain_step = "50 %"\ngreatest_strain = "250 %"')
    answer = answered(predict("--json", spec=spec))
    assert answer["strain"] == [0, 0.5, 1, 1.5, 2, 2.5]
    assert answer["tension"][-2:] == [None, None]
    assert answer["is_broken"] == [False] * 4 + [True] * 2


def test_a_person_reads_table_events_layers_and_notes(predict):
    done = predict()
    assert done.returncode == 0, done.stderr
    assert "hose gumby: 68 degrees from the axis, 280.1 cords" in done.stdout
    assert "[N]" in done.stdout and "[Pa]" in done.stdout
    (pick_up,) = [row for row in rows(done.stdout) if row[:3] == ["cords", "pick", "up"]]
    assert float(pick_up[3]) == pytest.approx(100 * PICK_UP, abs=0.01)
    assert "layer Kevlar at 66 degrees" in done.stdout
    # a layer that tears at the working load is the first line
    assert done.stdout.startswith("warning: layer Kevlar is stretched by")
    assert "NaN" not in done.stdout.replace("nan", "NaN")


def test_a_layer_without_a_limit_and_a_hose_without_uncertainty_are_printed(predict):
    done = predict(spec=BARE.replace('strain_limit = "2 %"\n', ""))
    assert done.returncode == 0, done.stderr
    assert "keep it within its limit" not in done.stdout
    assert "nan" not in done.stdout


def test_pounds_and_pounds_per_square_inch_where_asked_for(predict):
    done = predict("--units", "us")
    assert "[lbf]" in done.stdout and "[psi]" in done.stdout and "[N]" not in done.stdout
    working = answered(predict("--json", "--units", "us"))["events"]["working"]
    (row,) = [row for row in rows(done.stdout) if row[:2] == ["working", "load"]]
    # strain, u, tension, u, fill pressure, cord: the answer of --json stays SI
    assert float(row[4]) == pytest.approx(working["tension"] / LBF, rel=1e-3)
    assert float(row[6]) == pytest.approx(working["fill_pressure"] / PSI, rel=1e-3)
    assert float(row[7]) == pytest.approx(10)
    assert " mm wide" not in done.stdout and "4.119 and 4.119 in wide" in done.stdout


def test_out_has_archive_tables_and_a_page_with_the_same_numbers(predict, tmp_path):
    answer = answered(predict("--json", "--out", "made"))
    assert answer["out"] == "made"
    with open_archive(tmp_path / "made" / "predictions.nc") as archive:
        assert archive["tension"].values[0].tolist() == answer["tension"]
        assert archive.attrs["raw_file"] == "gumby.toml"
        assert "--out" not in archive.attrs["command"]
    assert [
        float(row["tension [N]"])
        for row in csv_rows(tmp_path / "made" / "tables" / "predictions.csv")
    ] == answer["tension"]
    page = (tmp_path / "made" / "index.html").read_text(encoding="utf-8")
    assert f'data-value="{answer["events"]["working"]["tension"]!r}"' in page
    assert "Prediction of hose gumby" in page and "SYNTHETIC DATA" not in page


def test_out_is_told_and_the_page_is_in_the_units_asked_for(predict, tmp_path):
    done = predict("--out", "made", "--units", "us")
    assert "archive: made/predictions.nc" in done.stdout
    assert "tables: " in done.stdout and "figures: made/index.html" in done.stdout
    assert "safe working load [lbf]" in (tmp_path / "made" / "index.html").read_text()


def test_the_report_is_made_again_from_the_archive_alone(predict, command, tmp_path):
    assert not predict("--out", "made", "--quiet").stdout
    done = command("report", "made", "--reports", "again", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (page,) = (tmp_path / "again").rglob("index.html")
    assert 'id="hose-0-tension-data"' in page.read_text(encoding="utf-8")


def test_quiet_says_nothing(predict):
    done = predict("--quiet")
    assert done.returncode == 0 and not done.stdout and not done.stderr


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"68 deg"', '"98 deg"', "wrap_angle is not that of a hose"),
        ('"68 deg"', '"?"', "gumby.toml"),
        ('"2.5 in"', '"3.6 in"', "above inner_diameter"),
        ('"5 in"', '"-5 in"', "outer_diameter is not that of a hose"),
        ('"10 lbf", "18 lbf"', '"18 lbf", "10 lbf"', "cord.load does not rise at point 5"),
        ('"neo-hookean"', '"ogden"', "rubber_law"),
        ("[hose]", '[hose]\nstrain_step = "0.0001 %"', "has no end of strains"),
        ("[hose]", "[hose]\nwrap = 1", "wrap"),
    ],
)
def test_a_hose_that_cannot_be_ends_with_status_2_and_no_traceback(
    predict, tmp_path, old, new, told
):
    done = predict("--out", "made", spec=SPEC.replace(old, new, 1))
    assert done.returncode == 2, done.stdout + done.stderr
    assert told in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr and not done.stdout
    assert not (tmp_path / "made").exists()


def test_a_file_that_is_not_there_and_units_that_are_not_known_are_settings(command, tmp_path):
    done = command("predict", "hose", "none.toml", cwd=tmp_path)
    assert done.returncode == 2 and "none.toml" in done.stderr
    (tmp_path / "gumby.toml").write_text(SPEC)
    done = command("predict", "hose", "gumby.toml", "--units", "cgs", cwd=tmp_path)
    assert done.returncode == 2 and "--units is not known" in done.stderr


def test_an_error_with_json_is_one_object(predict):
    done = predict("--json", spec=SPEC.replace('"68 deg"', '"98 deg"'))
    assert done.returncode == 2
    assert json.loads(done.stdout)["exit_status"] == 2


def test_a_target_is_answered_with_hoses_that_reach_it(predict):
    spec = SPEC + '[target]\nstrain = "130 %"\ntension = "4000 lbf"\n'
    done = predict("--json", spec=spec)
    designs = json.loads(done.stdout)["designs"]
    assert [one["varied"] for one in designs] == [
        "wrap angle", "wrap angle and fabric", "wrap angle and diameters",
    ]  # fmt: skip
    for one in designs[1:]:
        assert one["events"]["working"]["strain"] == pytest.approx(1.3)
        assert one["events"]["working"]["tension"] == pytest.approx(4000 * 4.4482216152605)
    assert "Hoses for 130 % and 4000 lbf" in predict("--units", "us", spec=spec).stdout


def test_a_target_that_no_hose_reaches_ends_with_status_2(predict):
    done = predict(spec=SPEC + '[target]\nstrain = "0.1 %"\n')
    assert done.returncode == 2
    assert "target: no hose of this design reaches it" in done.stderr
    assert "no hose by wrap angle" in done.stdout


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"200 psi"', '"200 MPa"', "its rubber_modulus is 200 MPa"),
        ('wrap_angle = "68 deg"', 'wrap_angle = "22 deg"', "its wrap_angle is 22 degrees"),
        ('"0.022 in"', '"0.022 mm"', "its cords break at 351 GPa on their section"),
    ],
)
def test_a_number_that_no_hose_has_is_the_first_line(predict, old, new, said):
    done = predict(spec=SPEC.replace(old, new, 1))
    assert done.returncode == 0 and done.stdout.startswith(f"warning: gumby: {said}")


def test_a_target_in_percent_without_the_sign_is_refused(predict):
    done = predict(spec=SPEC + "[target]\nstrain = 130\n")
    assert (
        done.returncode == 2 and 'A bare number is a share: 130 % is 1.3 or "130 %"' in done.stderr
    )

"""The command composite, and the composite as it is exported."""

import csv
import json
import re

import numpy as np
import pytest
import xarray as xr
from commandruns import answered
from csvrows import csv_rows

from reduction.archive.dataset_builder import SCHEMA_VERSION
from reduction.archive.open import open_archive
from reduction.archive.test_dataset import strain_model_of
from reduction.stages.strain.strain_model import position_by_model

LBF = 4.4482216152605


def composite(command, *arguments):
    done = command("composite", *arguments, "--json")
    assert done.returncode in (0, 4), done.stderr
    found = json.loads(done.stdout)
    assert (done.returncode == 4) == bool(found["doubt"])
    return found


def test_a_campaign_gives_one_rising_curve_of_all_its_tests(command, synthetic):
    found = composite(command, synthetic.processed, "--specimen", "new")
    strain, tension = np.array(found["strain"]), np.array(found["tension"])
    assert (strain[0], tension[0]) == (0, 0)
    assert (np.diff(strain) > 0).all() and (np.diff(tension) > 0).all()
    assert found["branch"] == "mean" and found["synthetic"] is True
    kinds = {(one["name"], one["kind"]) for one in found["pieces"]}
    assert {(f"T-{number}", "cyclic") for number in range(1, 7)} < kinds
    assert ("T-1", "first-loading") in kinds
    assert any("T-4-extended-end is left out" in note for note in found["notes"])
    assert any("the splices slipped 2 times" in note for note in found["notes"])
    assert len(found["piece"]) == len(strain) == len(found["tension_standard_uncertainty"])


@pytest.mark.nightly
def test_the_windows_are_inside_its_uncertainty(command, synthetic):
    found = composite(command, synthetic.processed, "--specimen", "used", "--branch", "ascending")
    for test in ("T-1", "T-2", "T-4", "T-6"):
        with xr.open_dataset(synthetic.processed / f"{test}.nc", decode_timedelta=False) as archive:
            at = archive["strain_bin"].values
            load = archive["branch_tension"].values[1, 0]
        inner = (at > at[0] + 0.1) & (at < at[-1] - 0.1) & np.isfinite(load)
        level, spread = (
            np.interp(at[inner], found["strain"], found[name])
            for name in ("tension", "tension_standard_uncertainty")
        )
        assert (np.abs(load[inner] - level) < 3 * spread).all()


@pytest.mark.parametrize("specimen", [0, 1])
def test_the_strain_model_of_an_archive_gives_its_crosshead_back(synthetic, specimen):
    with open_archive(synthetic.processed / "T-4.nc") as archive:
        model = strain_model_of(archive, specimen)
        strain, tension = (archive[name].values[specimen] for name in ("strain", "tension"))
        crosshead = archive["crosshead_position"].values
    found = position_by_model(model, strain=strain, tension=tension)
    known = np.isfinite(found)
    assert known.mean() > 0.99
    assert found[known] == pytest.approx(crosshead[known], abs=1e-9)


def test_one_window_comes_back_as_it_is(command, synthetic):
    found = composite(
        command, synthetic.processed / "T-5.nc", "--specimen", "new", "--precedence", "cyclic"
    )
    with xr.open_dataset(synthetic.processed / "T-5.nc", decode_timedelta=False) as archive:
        at = archive["strain_bin"].values
        load = archive["branch_tension"].values[0].mean(axis=0)
    known = np.isfinite(load)
    assert np.interp(at[known], found["strain"], found["tension"]) == pytest.approx(
        load[known], rel=2e-3
    )
    assert found["gaps"] == [[0, pytest.approx(at[known][0])]]
    assert found["joins"] == [] and found["moved"] == []
    assert [one["used"] for one in found["pieces"] if one["kind"] != "cyclic"] != []


def test_the_static_test_gives_85_pounds_at_100_percent_within_3_percent(command, static):
    """WHOI-2005-10, section 2.3.3, of which Table 4 is the test."""
    found = composite(command, static.processed, "--branch", "ascending")
    assert np.interp(1.0, found["strain"], found["tension"]) / LBF == pytest.approx(85, rel=0.03)
    down = composite(command, static.processed, "--branch", "descending")
    mean = composite(command, static.processed)
    levels = [np.interp(1.5, one["strain"], one["tension"]) for one in (down, mean, found)]
    assert levels == sorted(levels)
    assert levels[1] == pytest.approx((levels[0] + levels[2]) / 2, rel=0.01)


def test_a_published_tether_is_named_without_the_test(command):
    found = composite(command, "rubber-tether-used")
    assert found["branch"] == "ascending"
    names = [one["name"] for one in found["pieces"]]
    assert names[:6] == [f"T-{number}" for number in range(1, 7)]
    assert names[6:] == ["T-4-after-3000-cycles"]
    at, level = found["strain"], found["tension"]
    spread = np.interp(1.0, at, found["tension_standard_uncertainty"]) / LBF
    assert abs(np.interp(1.0, at, level) / LBF - 85) < spread
    assert any("WH5-34" in source for source in found["sources"])


def test_text_flags_joins_and_gaps_in_the_units_that_were_asked_for(command):
    done = command("composite", "rubber-tether-used", "--units", "us")
    assert "tension [lbf]" in done.stdout
    assert "gap" in done.stdout and "join, moved" in done.stdout
    assert re.search(r"cyclic pieces differ by 1[4-9]\.\d % of tension", done.stdout)
    assert command("composite", "rubber-tether-used", "--quiet").stdout == ""


@pytest.mark.parametrize("suffix", ["csv", "json", "nc", "md", "tex", "html"])
def test_every_node_is_written_by_the_name_of_the_file(command, tmp_path, suffix):
    path = tmp_path / f"c.{suffix}"
    done = command("composite", "rubber-tether-new", "--out", path, "--json")
    answer = json.loads(done.stdout)
    assert answer["out"] == str(path)
    if suffix == "csv":
        with path.open(newline="", encoding="utf-8") as lines:
            rows = list(csv.reader(lines))
        assert rows[0][:3] == ["strain [1]", "tension [N]", "tension_standard_uncertainty [N]"]
        assert [float(row[1]) for row in rows[1:]] == pytest.approx(answer["tension"], rel=1e-12)
        gap = rows[0].index("is_gap")
        assert rows[1][gap] == "no" and rows[2][gap] == "yes"  # below the second node
    elif suffix == "json":
        values = json.loads(path.read_text())["values"]
        assert values["tension"] == pytest.approx(answer["tension"])
    elif suffix == "nc":
        with xr.open_dataset(path) as found:
            assert found["tension"].values == pytest.approx(answer["tension"])
            assert found["is_gap"].attrs["flag_meanings"] == "no yes"
    else:
        assert "rubber-tether-new" in path.read_text()


@pytest.mark.parametrize(
    ("arguments", "status", "told"),
    [
        (["no-such-tether"], 2, "unknown source 'no-such-tether'"),
        (["rubber-tether-new-T-5"], 2, "needed rubber-tether-new"),
        (["nylon-double-braid-0.5in-new"], 2, "is a single published curve"),
        (["rubber-tether-new", "rubber-tether-used"], 2, "cannot be combined"),
        (["rubber-tether-new", "--branch", "mean"], 2, "only its ascending branch"),
        (["rubber-tether-new", "--specimen", "new"], 2, "is one tether"),
        (["rubber-tether-new", "--precedence", "cyclic,slow"], 2, "--precedence: the precedence"
                                                                  " names"),
        (["rubber-tether-new", "--precedence", "cyclic,cyclic"], 2, "names a kind twice"),
        (["rubber-tether-new", "--precedence", "static"], 4, "rubber-tether-new: no piece is of a"
                                                             " kind"),
        (["rubber-tether-new", "--out", "c.xls"], 2, "ends in .csv"),
        (["rubber-tether-new", "--branch", "loop"], 2, "'loop' is not one of"),
        ([], 2, "SOURCE"),
    ],
)  # fmt: skip
def test_bad_input_is_named(command, tmp_path, arguments, status, told):
    done = command("composite", *arguments, cwd=tmp_path)
    assert done.returncode == status
    assert told in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.nightly
def test_bad_archives_are_named(command, synthetic, static, tmp_path):
    folder, surfaces = synthetic.processed, tmp_path / "surfaces.nc"
    xr.Dataset(attrs={"schema_version": SCHEMA_VERSION}).to_netcdf(surfaces)
    for arguments, status, told in (
        ([folder], 2, "several specimens; found new, used"),
        ([folder, "--specimen", "old"], 2, "no specimen 'old'"),
        ([folder / "T-1.nc", folder / "T-1.nc", "--specimen", "new"], 2, "is listed twice"),
        ([folder / "overnight-hold.nc", "--specimen", "new"], 4, "no test of 'new' gives a mean"),
        ([folder / "status.csv"], 6, "cannot be read as a netCDF file"),
        ([tmp_path], 2, "contains no archive of a test"),
        ([surfaces], 2, "surfaces.nc: no archive of a test; needed archives of reduced tests"),
        (
            [folder / "T-1.nc", static.processed / "static.nc", "--specimen", "new"],
            2,
            "static.nc has no specimen 'new'; found short-tether",
        ),
    ):
        done = command("composite", *arguments)
        assert done.returncode == status, done.stderr
        assert told in done.stderr


def test_export_of_a_campaign_is_the_composite_and_its_header_says_so(command, synthetic, tmp_path):
    out = tmp_path / "new.json"
    done = command(
        "export", synthetic.processed, "--specimen", "new", "--to", "json", "--out", out, "--json"
    )
    answer, written = answered(done), json.loads(out.read_text())
    whole = composite(command, synthetic.processed, "--specimen", "new")
    assert written["values"]["tension"] == pytest.approx(whole["tension"])
    assert answer["curve"] == "composite of 7 tests, mean of both branches; one curve, no loop"
    assert answer["tested"]["strain"] == pytest.approx([whole["gaps"][0][1], whole["strain"][-1]])
    notes = " ".join(answer["notes"])
    for words in ("order of precedence cyclic, static, first-loading", "a straight line from zero",
                  "no piece between", "several pieces contribute", "T-4 (cyclic, mean)"):  # fmt: skip
        assert words in notes
    assert answer["synthetic"] is True


def test_export_of_several_archives_and_of_a_published_tether(command, synthetic, tmp_path):
    files = [synthetic.processed / f"T-{number}.nc" for number in (1, 2)]
    done = command(
        "export", *files, "--specimen", "used", "--curve", "ascending", "--precedence", "cyclic",
        "--to", "csv", "--out", tmp_path / "u.csv",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "composite of 2 tests, ascending branch" in done.stdout
    done = command(
        "export", "rubber-tether-new", "--to", "moordyn", "--out", tmp_path / "n.dat",
        "--linear-density", "0.6 kg/m",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "composite of 7 tests" in (tmp_path / "n.dat").read_text()
    one = command("export", "rubber-tether-new-T-5", "--to", "csv", "--out", tmp_path / "t.csv")
    assert one.returncode == 0 and "composite" not in (tmp_path / "t.csv").read_text()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["rubber-tether-new", "--frequency", "0.1 Hz"], "have no effect for several tests"),
        (["rubber-tether-new", "--curve", "mean"], "only its ascending branch"),
        (["rubber-tether-new-T-5", "--precedence", "cyclic"], "precedence has no effect"),
        (["rubber-tether-new", "no-such"], "cannot be combined"),
    ],
)
def test_what_a_composite_cannot_be_asked_at_the_export(command, tmp_path, arguments, told):
    done = command("export", *arguments, "--to", "csv", "--out", tmp_path / "x")
    assert done.returncode == 2
    assert told in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.nightly
def test_loops_begin_at_their_own_tension_but_for_what_the_rule_of_rising_moved(command, synthetic):
    """T-6 is the only window above 2.4: what its first node is off by is told, and is all of it."""
    with xr.open_dataset(synthetic.processed / "T-6.nc", decode_timedelta=False) as archive:
        load = archive["branch_tension"].values[0].mean(axis=0)
        place = int(np.flatnonzero(np.isfinite(load))[0])
        at, load = float(archive["strain_bin"].values[place]), float(load[place])
    found = composite(command, synthetic.processed, "--specimen", "new", "--precedence", "cyclic")
    node = int(np.argmin(np.abs(np.array(found["strain"]) - at)))
    assert found["piece"][node] == "T-6 cycles"
    change = found["tension"][node] - load
    assert found["monotone_change"][node] == pytest.approx(change, abs=1e-6)
    assert found["tension_standard_uncertainty"][node] >= abs(change)
    said = command("composite", synthetic.processed, "--specimen", "new", "--precedence", "cyclic")
    row = next(line for line in said.stdout.splitlines() if line.split()[0] == f"{100 * at:.4g}")
    assert "T-6 cycles" in row and f"moved {change:+.3g} to keep the curve rising" in row


@pytest.mark.nightly
def test_the_first_loading_of_a_test_is_no_certain_neighbour_of_its_loops(command, synthetic):
    """It has about twice the tension of the loops that begin there, and says so."""
    found = composite(command, synthetic.processed, "--specimen", "new")
    strain, tension, spread = (
        np.array(found[name]) for name in ("strain", "tension", "tension_standard_uncertainty")
    )
    words = np.array([one or "" for one in found["piece"]])
    begin = next(one["strain"][0] for one in found["pieces"]
                 if (one["name"], one["kind"]) == ("T-6", "cyclic"))  # fmt: skip
    near = (words == "T-6 first loading") & (strain > begin - 0.1)
    assert near.any() and (spread[near] > 0.3 * tension[near]).all()
    assert set(words[strain >= begin]) == {"T-6 cycles"}


def test_a_curve_far_from_a_piece_says_so_in_the_first_line(command):
    first = command("composite", "rubber-tether-used").stdout.splitlines()[0]
    doubt = composite(command, "rubber-tether-used")["doubt"]
    assert first.endswith(f"; DOUBTFUL: {doubt}")
    assert float(re.match(r"the curve is up to ([\d.]+) standard uncertainties", doubt)[1]) > 2


def test_a_table_names_pieces_in_words_and_its_notes_once(command, tmp_path):
    path = tmp_path / "u.csv"
    # far from a test, which the file says too
    assert command("composite", "rubber-tether-used", "--out", path).returncode == 4
    first, *others = csv_rows(path)
    assert {"T-1 cycles", "T-6 cycles"} < {row["piece"] for row in others}
    assert "a straight line from zero" in first["source"]
    assert {row["source"] for row in others} == {""}

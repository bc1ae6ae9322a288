"""None"""

import json
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from commandruns import answered
from csvrows import csv_rows

from reduction.archive.open import reading
from reduction.batch import campaign_status
from reduction.cli.lookup import one_line_of
from reduction.lines.line_rank import rank_lines
from reduction.lines.lookup_product import LineLevels
from reduction.lines.published_source import published_sources
from reduction.record.errors import DataError, SettingsError

LBF = 4.4482216152605
NYLON = "nylon-double-braid-0.5in-new"
PLAIT, BRAID = "polyester-8-strand-plaited-0.5in", "polyester-double-braid-0.5in"
TETHER = "rubber-tether-new-T-2"
LEVELS = (
    "--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS",
)  # fmt: skip


def test_one_value_with_interval_range_and_source(command):
    done = command("lookup", NYLON, "--quantity", "apparent_spring_constant", *LEVELS, "--json")
    answer = answered(done)
    assert {"value", "unit", "interval", "inside", "source", "errata"} <= answer.keys()
    assert answer["value"] == pytest.approx(3.451e4 * LBF)
    assert answer["unit"] == "N"
    assert answer["interval"][0] < answer["value"] < answer["interval"][1]
    assert answer["inside"] is True
    assert answer["source"] == "CG-D-39-80"
    assert answer["peak_share"] == pytest.approx(0.295)


def test_a_grid_is_a_table(command):
    done = command(
        "lookup", NYLON, "--quantity", "apparent_spring_constant", "--table", "--json",
        "--frequency", "0.1 Hz,0.5 Hz", "--mean-tension", "21 %RBS",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert len(answer["value"]) == 6
    assert answer["levels"]["frequency"] == [0.1] * 3 + [0.5] * 3
    text = command("lookup", NYLON, "--quantity", "relaxation_time", "--table", "--units", "us")
    assert "untested corner" in text.stdout


def test_a_grid_fills_what_is_not_given_of_a_curve_too(command):
    done = command(
        "lookup", NYLON, "--quantity", "quasi_static_spring_constant", "--table", "--json"
    )
    answer = json.loads(done.stdout)
    # Table 6: used up to 1,920 lb, which is 30 % of 6,400
    assert answer["levels"]["mean_tension"] == pytest.approx([0, 960 * LBF, 1920 * LBF])
    assert answer["peak_share"] == pytest.approx([0, 0.15, 0.3])
    tether = command("lookup", TETHER, "--quantity", "tangent_modulus", "--branch", "ascending",
                     "--table", "--json")  # fmt: skip
    assert json.loads(tether.stdout)["levels"]["strain"] == pytest.approx([0.6, 1.015, 1.43])
    damping = command("lookup", NYLON, "--quantity", "dashpot_coefficient", "--table", "--json")
    assert len(json.loads(damping.stdout)["value"]) == 27


def test_ends_of_the_tension_and_the_rule_are_in_every_answer(command):
    text = command("lookup", NYLON, "--quantity", "relaxation_time", *LEVELS).stdout
    assert "29.5" in text
    assert "rule: peak at most 60 % of the break strength where the minimum stays at 3 % or" in text
    text = command(
        "lookup", TETHER, "--quantity", "tangent_modulus", "--strain", "60 %", "--branch",
        "ascending",
    ).stdout  # fmt: skip
    assert "of rubber-tether-new-T-2, ascending branch; WHOI-2005-10" in text
    # 62 lb (Table 6, T-2) of 800 lb
    assert "7.75" in text
    assert "rule: a rubber tether must not go slack" in text


def test_a_line_of_which_nothing_is_printed_is_listed(command):
    for listed in ((), ("--list",)):
        done = command("lookup", "nylon-8-strand-plaited-0.8125in-new", *listed)
        assert done.returncode == 0
        assert "none is printed" in done.stdout


def test_a_search_leaves_the_lines_that_are_so(command):
    words = ("--material", "nylon", "--construction", "double braid", "--condition", "new")
    done = command("lookup", "published", "--list", *words, "--diameter", "0.5 in", "--json")
    assert [one["name"] for one in json.loads(done.stdout)["lines"]] == [NYLON]
    wide = command("lookup", "published", *words, "--diameter", "18 mm", "--tolerance", "10 %",
                   "--json")  # fmt: skip
    (found,) = json.loads(wide.stdout)["lines"]
    assert found["diameter"] == pytest.approx(0.75 * 0.0254)
    assert found["linear_density"] is None
    value = command(
        "lookup", "published", *words, "--diameter", "13 mm", "--quantity", "relaxation_time",
        *LEVELS, "--json",
    )  # fmt: skip
    assert json.loads(value.stdout)["line"] == NYLON


@pytest.fixture(scope="module")
def two_tests(synthetic, tmp_path_factory):
    """Two archives of the synthetic campaign, since each one is opened by every question."""
    folder = tmp_path_factory.mktemp("two") / "tmt-synthetic"
    folder.mkdir()
    for name in ("T-1.nc", "T-2.nc"):
        (folder / name).symlink_to(synthetic.processed / name)
    return folder


def test_a_search_in_a_campaign(command, two_tests):
    done = command("lookup", two_tests, "--material", "RUBBER", "--condition", "used",
                   "--json")  # fmt: skip
    lines = json.loads(done.stdout)["lines"]
    # both tests have the specimen: a name that can be copied is that of both
    assert {"T-1 used", "T-2 used"} <= {one["name"] for one in lines}
    assert all(one["name"].endswith(" used") for one in lines)
    assert {one["kind"] for one in lines} == {"rubber tether"}
    none = command("lookup", two_tests, "--list", "--material", "nylon")
    assert none.returncode == 2
    assert "no line matches; found material 'nylon'; needed material Natsyn rubber" in none.stderr
    assert "condition new or used" in none.stderr


def test_what_the_last_run_could_not_reduce_is_answered_with_a_warning(
    command, synthetic, tmp_path
):
    (tmp_path / "T-1.nc").symlink_to(synthetic.processed / "T-1.nc")
    ask = ("lookup", tmp_path, "--line", "new", "--quantity", "tangent_modulus", "--strain",
           "100 %", "--branch", "ascending")  # fmt: skip
    told = "warning: T-1 could not be reduced in the last run"
    for status, n_told in (("unchanged", 0), ("failed", 1)):
        row = campaign_status.TestStatus("T-1", status, 4, "the marks differ", 0, 0, "", 0.0)
        (tmp_path / "status.csv").write_text(campaign_status.status_csv([row]), newline="")
        assert command(*ask).stdout.count(told) == n_told
    exported = command("export", tmp_path / "T-1.nc", "--specimen", "new", "--to", "csv",
                       "--out", tmp_path / "line.csv")  # fmt: skip
    assert "DOUBTFUL: T-1 could not be reduced in the last run" in exported.stdout
    joined = command("composite", tmp_path, "--specimen", "new")
    doubt = "note: DOUBTFUL: T-1 could not be reduced in the last run"
    assert any(one.startswith(doubt) for one in joined.stdout.splitlines()[:3])


def test_an_archive_that_the_last_run_did_not_make_is_answered_with_a_warning(
    command, two_tests, tmp_path
):
    """Copied back, from another campaign, or moved aside by the run that replaced it."""
    shutil.copytree(two_tests, tmp_path, symlinks=True, dirs_exist_ok=True)
    row = campaign_status.TestStatus("T-1", "reduced", 0, "", 0, 0, "", 0.0)
    (tmp_path / "status.csv").write_text(campaign_status.status_csv([row]), newline="")
    (tmp_path / "superseded").mkdir()
    (tmp_path / "superseded" / "T-1.nc").symlink_to((tmp_path / "T-1.nc").resolve())
    told = "warning: T-2 has no row in status.csv"
    for line, n_told in (("T-1 new", 0), ("T-2 new", 1)):
        for quantity in (("K_ap",), ("tension", "--strain", "1", "--branch", "ascending")):
            done = command("lookup", tmp_path, "--line", line, "--quantity", *quantity)
            assert done.stdout.startswith(told) == n_told
            assert done.stdout.count(told) == n_told
    done = command("lookup", tmp_path / "superseded", "--line", "new", "--quantity", "K_ap")
    assert done.stdout.startswith("warning: T-1 is from an earlier run: the campaign no longer")
    joined = command("composite", tmp_path, "--specimen", "new")
    assert "note: DOUBTFUL: T-2 has no row in status.csv" in joined.stdout


def test_a_tether_has_its_stiffness_at_the_level_of_each_test(command, two_tests):
    done = command("lookup", two_tests, "--line", "T-1 new", "--quantity", "K_ap", "--json")
    answer = answered(done)
    with reading(two_tests / "T-1.nc") as archive:
        place = archive["specimen"].to_numpy().astype(str).tolist().index("new")
        cycles = archive["apparent_spring_constant"].to_numpy()[place]
        mean = archive["mean_tension"].to_numpy()[place].mean()
    assert answer["value"] == pytest.approx(np.nanmean(cycles), rel=1e-3)
    # the used tether and the other test are lines of their own, and nothing lies between
    other = command("lookup", two_tests, "--line", "T-1 new", "--quantity", "K_ap",
                    "--mean-tension", f"{1.2 * mean:.1f} N")  # fmt: skip
    assert other.returncode == 4 and "the nearest is T-1 (frequency" in other.stderr
    several = command("lookup", two_tests, "--quantity", "K_ap")
    assert several.returncode == 2
    assert {"T-1 new", "T-1 used", "T-2 new", "T-2 used"} <= set(
        re.findall(r"T-\d (?:new|used)", several.stderr)
    )


def test_old_line_stands_against_new(command):
    done = command(
        "lookup", f"{PLAIT}-new", "--quantity", "apparent_spring_constant", "--against",
        f"{PLAIT}-4-years", *LEVELS, "--json",
    )  # fmt: skip
    answer = answered(done)
    # B1 of Table 5; the text of sec. 4.4.1 says 30 %
    assert answer["ratio"] == pytest.approx(8.252 / 6.317)
    assert answer["difference"] == pytest.approx((8.252 - 6.317) * 1e4 * LBF)
    assert answer["known"] is True
    assert answer["different"] is (answer["surface_interval"][0] > 0)
    assert answer["test_different"] is False
    assert any("scatter by about 50 %" in note for note in answer["second"]["notes"])


def test_shares_are_of_each_lines_own_strength_and_tensions_are_one(command):
    pair = ("lookup", f"{BRAID}-new", "--quantity", "apparent_spring_constant", "--against",
            f"{BRAID}-4-years")  # fmt: skip
    text = command(*pair, *LEVELS, "--units", "us").stdout
    assert "of each line's own break strength: 6400 lbf and 7000 lbf" in text
    shares = json.loads(command(*pair, *LEVELS, "--json").stdout)
    assert shares["ratio"] == pytest.approx(11.55 / 9.457)  # B1 of Table 5
    # %MBL is the same word, in each of several values
    words = ("--frequency", "0.3 Hz", "--mean-tension", "21 %MBL,1400 lbf", "--tension-amplitude",
             "8.5 %MBS")  # fmt: skip
    mixed = json.loads(command(*pair, *words, "--table", "--json").stdout)
    first, second = (mixed[side]["levels"]["mean_tension"] for side in ("first", "second"))
    assert first == pytest.approx([1344 * LBF, 1400 * LBF])
    assert second == pytest.approx([1470 * LBF, 1400 * LBF])
    forces = (
        "--frequency", "0.3 Hz", "--mean-tension", "1344 lbf", "--tension-amplitude", "544 lbf",
    )  # fmt: skip
    one = json.loads(command(*pair, *forces, "--json").stdout)
    assert one["first"]["levels"] == one["second"]["levels"]
    assert one["first"]["value"] == pytest.approx(9.457e4 * LBF)


def test_a_grid_of_two_lines_is_over_what_both_boxes_have(command, tmp_path):
    done = command(
        "lookup", f"{BRAID}-new", "--quantity", "apparent_spring_constant", "--against",
        f"{BRAID}-4-years", "--table", "--json", "--out", tmp_path / "both.csv",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert len(answer["ratio"]) == 27
    assert all(answer["inside"])
    mean = answer["first"]["levels"]["mean_tension"]
    # 12 % of 7,000 lb to 30 % of 6,400 lb
    assert (min(mean), max(mean)) == pytest.approx((840 * LBF, 1920 * LBF))
    assert answer["files"] == [str(tmp_path / "both.csv")]
    rows = csv_rows(tmp_path / "both.csv")
    assert [float(row["ratio [1]"]) for row in rows] == pytest.approx(answer["ratio"])
    assert {row["is_different"] for row in rows} == {"yes", "no"}


def test_outside_one_of_two_boxes_is_refused_and_flagged(command):
    pair = ("lookup", f"{BRAID}-new", "--quantity", "apparent_spring_constant", "--against",
            f"{BRAID}-4-years", "--frequency", "0.3 Hz", "--mean-tension", "800 lbf",
            "--tension-amplitude", "400 lbf")  # fmt: skip
    done = command(*pair)
    assert done.returncode == 4
    assert f"of {BRAID}-4-years" in done.stderr
    flagged = command(*pair, "--extrapolate", "flag")
    assert "second: OUTSIDE" in flagged.stdout
    assert "first: OUTSIDE" not in flagged.stdout
    # a number that lacks its last digits is another number
    assert "\N{HORIZONTAL ELLIPSIS}" not in flagged.stdout


def test_two_lines_of_one_source_stand_against_each_other(command, synthetic):
    archive = synthetic.processed / "T-1.nc"
    ask = ("lookup", archive, "--line", "new", "--quantity", "tangent_modulus", "--strain", "100 %",
           "--branch", "descending")  # fmt: skip
    done = command(*ask, "--against", "used", "--json")
    answer = answered(done)
    sides = [
        json.loads(command(*ask[:3], name, *ask[4:], "--json").stdout)["value"]
        for name in ("new", "used")
    ]
    assert answer["ratio"] == pytest.approx(sides[1] / sides[0])
    assert answer["branch"] == "descending"
    assert "synthetic data" in answer["first"]["notes"]


def test_the_line_that_was_said_is_that_of_both_tests_and_another_has_to_be_named(
    command, synthetic
):
    ask = ("lookup", synthetic.processed / "T-1.nc", "--quantity", "branch_tension", "--strain",
           "100 %", "--branch", "ascending", "--against", synthetic.processed / "T-2.nc")  # fmt: skip
    done = command(*ask, "--line", "new", "--json")
    answer = answered(done)
    for side, test in (("first", "T-1"), ("second", "T-2")):
        assert f"{test}, specimen new" in answer[side]["source"]
    said = command(*ask, "--line", "new").stdout
    assert "T-2, specimen new (second)" in " ".join(said.split())
    other = command("lookup", "rubber-tether-used-T-1", *ask[2:])
    assert other.returncode == 2
    words = " ".join(other.stderr.split())
    assert "matches several lines with branch_tension" in words
    assert '--line "T-1 new" --against "T-2 used"' in words


def test_boxes_without_anything_in_common_make_no_grid(command):
    done = command(
        "lookup", NYLON, "--quantity", "apparent_spring_constant", "--table", "--against",
        "nylon-double-braid-1.25in-new",
    )  # fmt: skip
    assert done.returncode == 4
    assert "has no mean tension in common" in done.stderr


@pytest.mark.parametrize("suffix", ["csv", "json", "tex", "md", "nc"])
def test_values_are_written_in_every_format_of_a_table(command, tmp_path, suffix):
    path = tmp_path / f"values.{suffix}"
    done = command(
        "lookup", NYLON, "--quantity", "apparent_spring_constant", "--table", "--out", path,
        "--json",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert answer["files"] == [str(path)]
    if suffix == "nc":
        with xr.open_dataset(path) as read:
            assert read["apparent_spring_constant"].to_numpy().tolist() == answer["value"]
            assert "CG-D-39-80" in read.attrs["source"]
    else:
        text = path.read_text(encoding="utf-8")
        assert f"{answer['value'][0]:.15g}" in text or suffix == "json"
        assert "CG-D-39-80" in text
        if suffix == "json":
            values = json.loads(text)["values"]
            assert values["apparent_spring_constant"] == answer["value"]


def test_what_there_is(command):
    done = command("lookup", "published", "--list", "--json")
    names = [one["name"] for one in json.loads(done.stdout)["lines"]]
    assert NYLON in names
    assert "rubber-tether-used-T-6" in names
    assert "tangent_modulus" in command("lookup", "rubber-tether-used-T-6").stdout


@pytest.mark.parametrize(
    ("arguments", "status", "told"),
    [
        (("nylon-braid", "--quantity", "loss_factor"), 2, "nylon-double-braid-0.75in-new"),
        ((NYLON, "--quantity", "loss_factor", *LEVELS), 2, "has no loss_factor"),
        ((NYLON, "--quantity", "relaxation_time"), 2, "needs another variable"),
        (
            (NYLON, "--quantity", "relaxation_time", "--frequency", "3 lbf"), 2,
            "--frequency: unit 'lbf'",
        ),
        (
            (NYLON, "--quantity", "quasi_static_spring_constant", "--mean-tension", "0.6 tonnes"), 2,
            'in tonnes in "tf"',
        ),
        (
            (
                NYLON, "--quantity", "relaxation_time", "--frequency", "2 Hz", "--mean-tension",
                "21 %RBS", "--tension-amplitude", "8.5 %RBS",
            ),
            4,
            "frequency 2 Hz, tested 0.1 to 0.5 Hz",
        ),
        (
            (
                NYLON, "--quantity", "relaxation_time", "--frequency", "0.3 Hz",
                "--mean-tension", "8 %RBS", "--tension-amplitude", "9 %RBS", "--extrapolate",
                "flag",
            ),
            4,
            "goes slack",
        ),
        (
            (NYLON, "--quantity", "relaxation_time", *LEVELS[:1], "0.1 Hz,0.2 Hz", *LEVELS[2:]),
            2,
            "several values of a level need a table",
        ),
        (
            ("nylon-8-strand-plaited-0.8125in-new", "--quantity", "K_ap", *LEVELS), 2,
            "not printed for this line. No quantity is printed for this line.",
        ),
        (("published", "--list", "--material", "steel"), 2, "no line matches; found material 'steel'"),
        (("published", "--tolerance", "3 %"), 2, "a tolerance needs a diameter"),
        (("published", "--quantity", "relaxation_time", *LEVELS), 2, "a search that matches one"),
        ((NYLON, "--quantity", "relaxation_time", *LEVELS, "--out", "a.xls"), 2, "names no format"),
        (
            (NYLON, "--quantity", "relaxation_time", "--against", "nylon-braid", *LEVELS), 2,
            "no line is called 'nylon-braid'",
        ),
        ((NYLON, "--quantity", "strain", "--tension", "9 kN"), 4, "outside the tested range"),
        (
            ("published", "--material", "nylon", "--quantity", "loss_factor"), 2,
            "none of 9 lines has loss_factor; needed one of apparent_spring_constant",
        ),
        ((NYLON, "--quantity", "strain", "--line", "x", "--tension", "1 kN"), 2, "no line 'x'"),
        (
            (
                NYLON, "--quantity", "relaxation_time", "--frequency", "-0.3 Hz", *LEVELS[2:],
                "--extrapolate", "flag",
            ),
            2,
            "a frequency is not positive; found -0.3 Hz",
        ),
        (
            (NYLON, "--quantity", "relaxation_time", *LEVELS, "--branch", "ascending"), 2,
            "does not differ by branch",
        ),
        (
            (NYLON, "--quantity", "quasi_static_spring_constant", "--mean-tension", "1344 lbf",
             "--frequency", "3 Hz"),
            2,
            "does not vary with frequency",
        ),
        (
            (NYLON, "--quantity", "relaxation_time", "--table", "--tension-amplitude", "2000 lbf",
             "--mean-tension", "1344 lbf"),
            4,
            "every combination has an amplitude above",
        ),
    ],
)  # fmt: skip
def test_what_cannot_be_looked_up_ends_with_its_status(command, arguments, status, told):
    done = command("lookup", *arguments)
    assert done.returncode == status, done.stdout + done.stderr
    assert told in done.stderr
    assert "Traceback" not in done.stderr


def test_an_archive_with_nothing_to_look_up_is_refused(command, tmp_path):
    xr.Dataset(attrs={"title": "nothing"}).to_netcdf(tmp_path / "empty.nc")
    done = command("lookup", tmp_path / "empty.nc")
    assert done.returncode == 6
    assert "empty.nc" in done.stderr


def test_json_says_of_what_each_number_is(command):
    done = command(
        "lookup", f"{BRAID}-5-years", "--quantity", "apparent_spring_constant", "--frequency",
        "0.3 Hz", "--mean-tension", "30 %RBS", "--tension-amplitude", "12 %RBS", "--json",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert answer["level_units"] == {
        "frequency": "Hz", "mean_tension": "N", "tension_amplitude": "N",
    }  # fmt: skip
    assert answer["tension_unit"] == "N"
    assert answer["interval_of"] == "one more run of the same specimens"
    assert answer["line_interval"][1] > answer["interval"][1]
    assert answer["below_zero"] is False
    # 42 % of 7,000 lb is 2,940 lb; Table 10: 3,241 lb
    assert answer["peak_share"] == pytest.approx(0.42)
    assert answer["own_peak_share"] == pytest.approx(2940 / 3241)
    assert answer["above_rule"] is True
    assert answer["tensile_strength"] == pytest.approx(3241 * LBF)
    text = command(
        "lookup", f"{BRAID}-5-years", "--quantity", "apparent_spring_constant", "--frequency",
        "0.3 Hz", "--mean-tension", "30 %RBS", "--tension-amplitude", "12 %RBS",
    ).stdout  # fmt: skip
    assert "90.71" in text
    assert "peak above the rule" in text
    assert "another specimen" in text


def test_a_list_says_whose_strength_it_is_and_in_which_units(command):
    largest = "nylon-double-braid-1.25in-new"
    (line,) = json.loads(command("lookup", largest, "--list", "--json").stdout)["lines"]
    assert line["rated_break_strength_of"] == "the 1 in line"
    assert line["range_units"]["mean_tension"] == "N"
    old = "nylon-double-braid-0.5in-5-years"
    (line,) = json.loads(command("lookup", old, "--list", "--json").stdout)["lines"]
    strain = next(one for one in line["curves"] if one["quantity"] == "strain")
    assert strain["range"][1] == pytest.approx(2596.5 * LBF, rel=1e-3)
    assert "falls under more load" in strain["range_note"]
    assert "(the 1 in line)" in command("lookup", largest, "--list").stdout


def test_a_value_below_zero_has_a_field_of_its_own(command):
    # K_0 of plaited nylon is below zero to some 153 lb: Table 6
    done = command(
        "lookup", "nylon-8-strand-plaited-0.5in-new", "--quantity", "quasi_static_spring_constant",
        "--mean-tension", "100 lbf", "--extrapolate", "flag", "--json",
    )  # fmt: skip
    answer = json.loads(done.stdout)
    assert answer["below_zero"] is True
    assert answer["inside"] is False


@pytest.mark.parametrize("level", ["2000 lbf", "1e6 lbf"])
def test_no_number_of_a_table_is_cut(command, level):
    asked = ("lookup", "nylon-double-braid-1in-new", "--quantity", "apparent_spring_constant",
             "--table", "--extrapolate", "flag", "--mean-tension", level)  # fmt: skip
    text = command(*asked).stdout
    assert "\N{HORIZONTAL ELLIPSIS}" not in text
    answer = json.loads(command(*asked, "--json").stdout)
    lines = [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()]
    (heads,) = [line for line in lines if "value [N]" in line]
    place, below = heads.index("value [N]"), lines.index(heads) + 1
    rows = lines[below : below + len(answer["value"])]
    shares = heads.index("value [MBL]"), answer["value_over_strength"]
    assert [float(row[shares[0]]) for row in rows] == pytest.approx(shares[1], rel=5e-3)
    for row, value, low, high in zip(
        rows, answer["value"], *answer["surface_interval"], strict=True
    ):
        # no power of ten, and two digits of half the interval: within a twentieth of it
        assert abs(value) > 1e7 or re.fullmatch(r"-?\d+", row[place])
        assert float(row[place]) == pytest.approx(value, abs=(high - low) / 40)


def test_kinds_are_told_apart_with_the_scatter_between_lines_alone(command):
    pair = ("lookup", f"{BRAID}-new", "--quantity", "apparent_spring_constant", "--against",
            f"{BRAID}-4-years", *LEVELS)  # fmt: skip
    answer = json.loads(command(*pair, "--json").stdout)
    assert answer["different"] is True
    assert answer["kind_known"] is True
    assert answer["kind_different"] is False
    assert answer["kind_interval"][0] < 0 < answer["kind_interval"][1]
    text = command(*pair).stdout
    assert "no difference shown" in text
    assert "specimens of this kind scatter by about 50 %" in text


def test_one_line_of_a_campaign_is_named_by_its_test_and_specimen(command, two_tests):
    ask = ("--quantity", "tangent_modulus", "--branch", "ascending", "--strain", "100 %", "--line")
    whole = command("lookup", two_tests, *ask, "T-1 new", "--json")
    assert whole.returncode == 0, whole.stderr
    alone = command("lookup", two_tests / "T-1.nc", *ask, "new", "--json")
    assert json.loads(whole.stdout)["value"] == json.loads(alone.stdout)["value"]
    for several in ("T-1", "new"):
        done = command("lookup", two_tests, *ask, several)
        assert done.returncode == 2
        assert 'Example: `--line "T-1 new"`.' in done.stderr
    none = command("lookup", two_tests, *ask, "T-99")
    assert "there is no line 'T-99'" in none.stderr
    assert '--line "T-1 new"' in none.stderr


def test_of_an_experiment_and_its_runs_the_experiment_answers():
    fitted = replace(published_sources()[f"{BRAID}-new"], name="nylon", specimens=("line-1",))
    level = LineLevels(
        "apparent_spring_constant", ("frequency",), np.ones((1, 1)), *np.ones((3, 1)), ("R01",)
    )
    run = replace(fitted, name="R01 line-1", surfaces={}, curves=(), levels=(level,))
    of = "apparent_spring_constant"
    assert one_line_of([run, fitted], of, None) is fitted
    assert one_line_of([run, fitted], of, "R01 line-1") is run
    # another rope, and a line of which nothing says what it was
    for other in (
        replace(run, name="R01 line-2", specimens=("line-2",)),
        replace(run, specimens=()),
    ):
        with pytest.raises(SettingsError, match="several lines have"):
            one_line_of([other, fitted], of, None)


def test_products_that_are_not_made_yet_are_told_with_the_command_that_makes_them(
    command, tmp_path
):
    done = command("lookup", "processed/nylon-synthetic", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("there is no such folder or archive; found processed/nylon-syn")
    assert "`reduction run raw/nylon-synthetic/campaign.toml` makes" in done.stderr
    assert "polyester" not in done.stderr
    empty = command("lookup", tmp_path)
    assert "the folder holds no archive of a campaign" in empty.stderr


@pytest.mark.parametrize(
    ("symbol", "name"),
    [("K_ap", "apparent_spring_constant"), ("H", "hysteresis_energy"), ("tau", "relaxation_time"),
     ("K_1", "dissipation_spring_constant"), ("N", "dashpot_coefficient")],
)  # fmt: skip
def test_a_quantity_can_be_asked_for_by_its_symbol(command, symbol, name):
    answer = json.loads(command("lookup", NYLON, "--quantity", symbol, *LEVELS, "--json").stdout)
    assert answer["quantity"] == name


def test_tension_over_strain_is_asked_for_as_tension(command):
    at = ("lookup", "rubber-tether-new-T-1", "--strain", "100 %", "--json", "--quantity")
    short, whole = (json.loads(command(*at, name).stdout) for name in ("tension", "branch_tension"))
    assert short == whole
    assert short["quantity"] == "branch_tension"


def test_no_name_is_broken_in_a_pipe(command):
    words = set(command("lookup", "published", "--list").stdout.split())
    lines = json.loads(command("lookup", "published", "--list", "--json").stdout)["lines"]
    for line in lines:
        assert {line["name"], *line["quantities"]} <= {word.rstrip(",") for word in words}


def test_a_curve_without_an_interval_says_why(command):
    text = command("lookup", "rubber-tether-new-T-5", "--quantity", "tangent_modulus", "--strain",
                   "200 %").stdout  # fmt: skip
    assert "no interval is given: the source does not state the scatter of this curve" in text


def test_a_difference_says_of_which_lines_its_interval_is(command):
    text = command("lookup", f"{PLAIT}-new", "--against", f"{PLAIT}-4-years", "--quantity", "K_ap",
                   *LEVELS).stdout  # fmt: skip
    assert "the 95 % interval of the difference is for the specimens that were tested" in text


def test_an_interval_that_reaches_below_zero_is_not_told_from_zero(command):
    ask = ("lookup", NYLON, "--quantity", "relaxation_time", "--table")
    answer = json.loads(command(*ask, "--json").stdout)
    vague = [
        low < 0 <= value
        for (low, value) in zip(
            np.minimum(answer["interval"][0], answer["surface_interval"][0]), answer["value"],
            strict=True,
        )
    ]  # fmt: skip
    assert any(vague)
    assert command(*ask).stdout.count("interval includes zero") == sum(vague)


PLAITED = (
    "nylon-8-strand-plaited-0.5in-new", "--mean-tension", "30 %RBS", "--units", "us",
)  # fmt: skip
CYCLE = ("--frequency", "0.3 Hz", "--tension-amplitude", "8.5 %RBS")


def test_impossible_numbers_of_a_page_are_the_first_line(command):
    lines = command("lookup", *PLAITED, *CYCLE, "--quantity", "K_ap").stdout.splitlines()
    assert lines[0].startswith("warning: the printed numbers are inconsistent")
    solved = [
        line for line in lines if "cubic of K_0, Tables 6 and 7" in line and "printed" in line
    ]
    # K_ap 45,109 of the page; 15,592 + 25,029 is less, 15,592 + 29,840 is not
    assert ["45109", "15592", "25029", "29840"] == solved[-1].split()[12:16]


def test_k_0_is_shown_by_both_ways_to_it(command):
    text = command("lookup", *PLAITED, "--quantity", "K_0").stdout
    assert "15592" in text
    assert "16616" in text
    found = json.loads(command("lookup", *PLAITED, "--quantity", "K_0", "--json").stdout)
    assert found["slow_pulls"].keys() == {
        "cubic of K_0, Tables 6 and 7",
        "slope of load on strain, Tables 8 and 9",
    }


def test_tethers_are_compared_within_one_table(command):
    asked = ("--against", "rubber-tether-used-T-1", "--quantity", "tangent_modulus")
    named = ("lookup", "rubber-tether-new-T-1", *asked, "--strain", "100 %")
    found = json.loads(command(*named, "--json").stdout)
    # (148 / 1.1632) / (137 / 1.1455)
    assert found["ratio"] == pytest.approx(1.064, abs=1e-3)
    assert "Table 5" in found["first"]["source"]
    assert "Table 5" in found["second"]["source"]
    assert command(*named).stdout.startswith(
        "both moduli are from Table 5 of WHOI-2005-10; strain is"
    )


# lines in order at one load: the choice of sec. 3.2 and Figure 4 of CG-D-39-80

ASKED = (
    "lookup", "published", "--rank", "--material", "nylon", "--construction", "double braid",
    "--condition", "new", "--quantity", "K_ap", "--mean-tension", "4000 lbf",
    "--tension-amplitude", "1600 lbf",
)  # fmt: skip


def name(size):
    return f"nylon-double-braid-{size}in-new"


def test_the_diameters_of_figure_4_with_ties_and_the_erratum(command):
    done = command(*ASKED, "--frequency", "0.3 Hz", "--json")
    answer = answered(done)
    ranked = answer["ranked"]
    assert [one["line"] for one in ranked] == [name(size) for size in ("1", "0.75", "1.25")]
    # Table 3 by hand, 1e4 lbf: reference audit of the report
    found = [one["value"] / LBF / 1e4 for one in ranked]
    assert found == pytest.approx([11.4, 11.9, 17.7], abs=0.05)
    assert [one["ties"] for one in ranked] == [[name("0.75")], [name("1")], []]
    for one in ranked:
        for other in ranked:
            if one is not other:
                overlap = (
                    one["interval"][0] <= other["interval"][1]
                    and other["interval"][0] <= one["interval"][1]
                )
                assert overlap == (other["line"] in one["ties"])
    assert answer["errata"] == ["CG-62"]
    assert [one["inside"] for one in ranked] == [False, True, False]
    # 88 % of 6,400 lb: the half-inch line is no choice
    assert answer["left_out"].keys() == {name("0.5")}
    assert "88 % of its break strength" in answer["left_out"][name("0.5")]


def test_what_has_to_be_read_before_a_value_stands_above_the_ranks(command):
    """K_ap of the 1 1/4 in line is printed above K_0 + K_1: the look-up of the line warns of it."""
    load = (
        "--frequency",
        "0.3 Hz",
        "--mean-tension",
        "4000 lbf",
        "--tension-amplitude",
        "1600 lbf",
    )
    kind = ("--material", "nylon", "--construction", "double braid", "--condition", "new")
    done = command("lookup", "published", *kind, "--quantity", "K_ap", "--rank", *load)
    first = done.stdout.split("\n")[0]
    assert first.startswith("warning of nylon-double-braid-1.25in-new: the printed numbers are")


def test_the_screen_says_what_is_below_the_tested_amplitudes(command):
    done = command(*ASKED, "--frequency", "0.1 Hz", "--units", "us")
    assert done.returncode == 0, done.stderr
    rows = {
        size: next(row for row in done.stdout.splitlines() if f" {name(size)}" in row)
        for size in ("1", "0.75", "1.25")
    }
    for size in ("1", "1.25"):
        assert (
            "tension amplitude 1,600 lbf, below 1,680 lbf, the lowest that was tested" in rows[size]
        )
    assert "tested from" not in rows["0.75"]
    assert rows["1"].startswith("1=") and rows["1.25"].startswith("3 ")
    assert "erratum CG-62" in done.stdout


def test_a_line_that_is_far_outside_has_no_place_unless_it_is_asked_for():
    lines = [published_sources()[name(size)] for size in ("0.75", "1", "1.25")]
    at = {"frequency": 0.3, "mean_tension": 4000 * LBF, "tension_amplitude": 1200 * LBF}
    with pytest.raises(DataError, match="fewer than two lines"):
        rank_lines(lines, "apparent_spring_constant", [at] * 3)
    found = rank_lines(lines, "apparent_spring_constant", [at] * 3, extrapolate="flag")
    assert len(found.ranked) == 3
    # the text orders diameters by K_ap alone
    energy = rank_lines(lines, "hysteresis_energy", [at] * 3, extrapolate="flag")
    assert energy.errata == ()


def test_one_way_to_put_lines_together(command):
    done = command(*ASKED, "--frequency", "0.3 Hz", "--against", name("1"))
    assert done.returncode == 2
    assert "only one option" in done.stderr

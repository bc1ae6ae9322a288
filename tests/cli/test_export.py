"""The command export: what it writes of an archive and of a published line, and how it refuses."""

import json
from pathlib import Path

import numpy as np
import pytest
from commandruns import answered
from csvrows import csv_rows
from export_readers import moordyn_sections, moordyn_table, orcaflex

from reduction.archive.open import reading

ROOT = Path(__file__).parents[2]


def test_a_reduced_test_becomes_a_deck_and_its_table(command, synthetic, tmp_path):
    archive = synthetic.processed / "T-1.nc"
    done = command(
        "export", archive, "--specimen", "new", "--to", "moordyn", "--out", tmp_path / "t.dat",
        "--linear-density", "0.6 kg/m", "--json",
    )  # fmt: skip
    answer = answered(done)
    assert answer["files"] == [str(tmp_path / "t_table.txt"), str(tmp_path / "t.dat")]
    assert answer["synthetic"] is True
    assert answer["curve"].startswith("mean of the ascending and descending branches")
    assert answer["linear_density"] == {"value": 0.6, "unit": "kg m-1"}
    assert answer["rated_break_strength"]["value"] == pytest.approx(800 * 4.4482216152605)
    deck = (tmp_path / "t.dat").read_text()
    assert "SYNTHETIC" in deck
    assert moordyn_sections(deck)["LINE TYPES"][0][3] == "t_table.txt"
    strain, tension = moordyn_table((tmp_path / "t_table.txt").read_text())
    low, high = answer["tested"]["strain"]
    assert strain[1] < low < high < strain[-2]
    with reading(archive) as dataset:
        middle, half, stiffness = (
            float(dataset[f"test_{name}"].values[0])
            for name in ("mean_strain", "strain_amplitude", "apparent_spring_constant")
        )
    # the turns of the mean cycle, which no trimmed branch reaches
    assert [strain[1], strain[-2]] == pytest.approx([middle - half, middle + half])
    # the header gives the range and K_ap of the table: those of the archive, not of a damped form
    head = " ".join(deck.split())
    assert f"tested from strain {strain[1]:.6g} to {strain[-2]:.6g} (both branches from" in head
    assert f"K_ap of the curve over that cycle is {stiffness:.6g} N" in head
    assert np.ptp(tension[[1, -2]]) / np.ptp(strain[[1, -2]]) == pytest.approx(stiffness, rel=1e-6)
    # and one row straight on, since MoorDyn keeps the last tension
    assert strain[-1] == pytest.approx(1.3 * strain[-2])
    slopes = np.diff(tension)[-2:] / np.diff(strain)[-2:]
    assert slopes[1] == pytest.approx(slopes[0], rel=0.01)
    assert "a straight line goes on to the turning points" in " ".join(answer["notes"])


def test_branches_differ_and_their_mean_lies_between(command, synthetic, tmp_path):
    found = {}
    for curve in ("ascending", "mean", "descending"):
        done = command(
            "export", synthetic.processed / "T-1.nc", "--specimen", "new", "--curve", curve,
            "--to", "json", "--out", tmp_path / f"{curve}.json", "--quiet",
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert done.stdout == ""
        values = json.loads((tmp_path / f"{curve}.json").read_text())["values"]
        found[curve] = np.interp(1.0, values["strain"], values["tension"])
    assert found["ascending"] > found["mean"] > found["descending"]


def test_a_published_line_has_its_stiffness_at_levels_and_its_errata(command, tmp_path):
    done = command(
        "export", "polyester-double-braid-0.5in-new", "--to", "moordyn", "--form",
        "static-dynamic", "--frequency", "0.3 Hz", "--mean-tension", "21 %RBS",
        "--tension-amplitude", "8.5 %RBS", "--linear-density", "0.1 kg/m", "--out",
        tmp_path / "p.dat",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "errata CG-15" in done.stdout
    (row,) = moordyn_sections((tmp_path / "p.dat").read_text())["LINE TYPES"]
    slow, fast = (float(value) for value in row[3].split("|"))
    assert fast > slow > 0


def test_units_are_for_tables_and_never_for_a_code(command, tmp_path):
    name = "polyester-double-braid-0.5in-new"
    command("export", name, "--to", "csv", "--out", tmp_path / "p.csv", "--units", "us")
    assert (tmp_path / "p.csv").read_text().startswith("strain [1],tension [lbf],is_tested")
    command(
        "export", name, "--to", "orcaflex", "--out", tmp_path / "p.yml", "--units", "us",
        "--linear-density", "0.1 kg/m",
    )  # fmt: skip
    _, _, tension = orcaflex((tmp_path / "p.yml").read_text())
    last = (tmp_path / "p.csv").read_text().strip().split("\n")[-1].split(",")[1]
    assert tension[-1] == pytest.approx(float(last) * 4.4482216152605)


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["no-such-line", "--to", "csv"], 2, "unknown source to export"),
        (["nylon-double", "--to", "csv"], 2, "nylon-double-braid-0.75in-new"),
        (["polyester-double-braid-0.5in-new", "--to", "moordyn"], 2, "--linear-density"),
        (["polyester-double-braid-0.5in-new", "--to", "ansys"], 2, "format is not known"),
        (["polyester-double-braid-0.5in-new", "--to", "csv", "--curve", "loop"], 2, "--curve"),
        (["polyester-double-braid-0.5in-new", "--to", "csv", "--curve", "mean"], 2, "no mean"),
        (["polyester-double-braid-0.5in-new", "--to", "csv", "--extrapolate", "yes"], 2, "refuse"),
        (
            ["polyester-double-braid-0.5in-new", "--to", "csv", "--mean-tension", "90 %RBS",
             "--frequency", "0.3 Hz", "--tension-amplitude", "8 %RBS"],
            4, "outside the tested range",
        ),
        (["polyester-double-braid-0.5in-new", "--to", "csv", "--mean-tension", "3 ft"], 2,
         "--mean-tension: unit 'ft' is not a unit of force"),
        (["polyester-double-braid-0.5in-new", "--to", "moordyn", "--linear-density", "0.11"], 2,
         "--linear-density: a value has no unit"),
        (["nylon-8-strand-plaited-0.5in-5-years", "--to", "csv", "--mean-tension", "20 %RBS"], 2,
         "needed --frequency and --tension-amplitude too"),
    ],
)  # fmt: skip
def test_bad_input_is_named(command, tmp_path, arguments, status, message):
    done = command("export", *arguments, "--out", tmp_path / "x")
    assert done.returncode == status
    assert message in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_levels_choose_nothing_in_an_archive(command, synthetic, tmp_path):
    done = command(
        "export", synthetic.processed / "T-1.nc", "--to", "csv", "--out", tmp_path / "x",
        "--frequency", "0.1 Hz",
    )  # fmt: skip
    assert done.returncode == 2
    assert "have no effect for an archive" in done.stderr


def test_a_test_without_cycles_is_exported_by_its_rise(command, nylon_campaign, tmp_path):
    """Of a slow pull the curve of tension over strain, with K_0 as its slope."""
    archive, out = nylon_campaign.processed / "Q01.nc", tmp_path / "pull.csv"
    done = command("export", archive, "--to", "csv", "--out", out)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("line-1: composite of 1 test, ascending branch")
    rows = csv_rows(out)
    strain, tension = (
        np.array([float(row[name]) for row in rows]) for name in ("strain [1]", "tension [N]")
    )
    with reading(archive) as pull:
        at = pull["tension_grid"].values[20:-20:20]
        slope = pull["quasi_static_spring_constant"].values[0, 20:-20:20]
    step = 0.01 * at
    ends = np.interp(at - step, tension, strain), np.interp(at + step, tension, strain)
    assert 2 * step / (ends[1] - ends[0]) == pytest.approx(slope, rel=0.02)


def test_an_archive_that_is_not_there_is_named_alone(command, tmp_path):
    done = command("export", tmp_path / "T-9.nc", "--to", "csv", "--out", tmp_path / "x.csv")
    assert done.returncode == 2
    assert "there is no such archive" in done.stderr and "polyester" not in done.stderr


NYLON = "nylon-double-braid-0.5in-new"
LEVELS = ("--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS")


def test_percent_of_the_break_strength_means_what_it_means_at_the_look_up(command, tmp_path):
    """6,400 lbf is the strength of the source; 30 kN is what the rope of the user has."""
    out = tmp_path / "p.csv"
    done = command(
        "export", NYLON, "--to", "csv", "--out", out, *LEVELS, "--rated-break-strength", "30 kN"
    )
    assert done.returncode == 0, done.stderr
    assert "of 28468.6 N, that of the source" in done.stdout
    # 21 % of 6,400 lbf at K_0 of the look-up
    wanted = command(
        "lookup", NYLON, "--quantity", "quasi_static_spring_constant", "--mean-tension",
        "1344 lbf", "--json",
    )  # fmt: skip
    (value,) = np.ravel(json.loads(wanted.stdout)["value"])
    assert f"quasi_static_spring_constant {value:.6g} N" in done.stdout


def test_what_is_doubtful_is_on_the_screen_and_a_file_that_was_there_is_named(command, tmp_path):
    out = tmp_path / "t.dat"
    arguments = (
        "export", "rubber-tether-new-T-5", "--to", "moordyn", "--out", out, "--linear-density",
        "0.3 kg/m",
    )  # fmt: skip
    done = command(*arguments)
    assert done.returncode == 0, done.stderr
    assert "was NOT measured on this curve" in done.stdout
    assert "DOUBTFUL: the line floats" in done.stdout
    assert f"written: {out}" in done.stdout
    assert f"written over: {out}" in command(*arguments).stdout


def test_a_wet_mass_above_the_dry_one_and_an_empty_path_are_refused(command, tmp_path):
    done = command(
        "export", NYLON, "--to", "csv", "--out", tmp_path / "x.csv", "--linear-density",
        "0.1 kg/m", "--wet-linear-density", "0.5 kg/m",
    )  # fmt: skip
    assert done.returncode == 2
    assert "not lighter in water than in air" in done.stderr
    for to in ("csv", "netcdf", "moordyn"):
        done = command("export", NYLON, "--to", to, "--out", "", "--linear-density", "0.1 kg/m")
        assert done.returncode == 2
        assert "--out is not a file name" in done.stderr


@pytest.mark.parametrize(
    "source", ["rubber-tether-new", ROOT / "docs/assemblies/new-hampshire.toml"]
)
def test_composites_and_assemblies_pass_the_same_guards(command, tmp_path, source):
    """26 mm displace 0.54 kg/m, more than the 0.3 kg/m that are stated."""
    done = command(
        "export", source, "--to", "moordyn", "--out", tmp_path / "c.dat", "--diameter", "26 mm",
        "--linear-density", "0.3 kg/m",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "was NOT measured on this curve" in done.stdout
    assert "DOUBTFUL: the line floats: 0.3 kg/m displaces 0.5442 kg/m" in done.stdout
    assert "DOUBTFUL: the line floats" in (tmp_path / "c.dat").read_text()


def test_the_screen_has_k_ap_of_the_look_up_and_what_the_printed_parameters_would_give(
    command, tmp_path
):
    levels = [*LEVELS]
    levels[1] = "0.5 Hz"
    done = command(
        "export", NYLON, "--to", "moordyn", "--form", "static-dynamic", "--linear-density",
        "0.0967 kg/m", "--out", tmp_path / "d.dat", *levels,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    wanted = command("lookup", NYLON, "--quantity", "apparent_spring_constant", "--json", *levels)
    (value,) = np.ravel(json.loads(wanted.stdout)["value"])
    assert f"gives back K_ap {round(value, -1):.0f} N" in done.stdout
    # the printed 0.16 s at 0.5 Hz, beside K_0 82,930 N and K_1 83,582 N, by eq. 1 of the report
    turned = 2j * np.pi * 0.5 * 0.16
    off = abs(82929.8 + 83582.1 * turned / (1 + turned)) / value - 1
    assert f"{100 * off:+.1f} percent; H" in done.stdout


def test_a_syrope_of_a_published_line(command, tmp_path):
    arguments = (
        "export", "polyester-double-braid-0.5in-new", "--to", "moordyn", "--form", "syrope",
        "--linear-density", "0.12 kg/m", "--out", tmp_path / "s.dat", *LEVELS,
    )  # fmt: skip
    done = command(*arguments)
    assert done.returncode == 2
    assert "--working-curve, --greatest-mean-tension" in done.stderr
    done = command(*arguments, "--working-curve", "LINEAR, 0.1", "--greatest-mean-tension", "8 kN")
    assert done.returncode == 0, done.stderr
    assert moordyn_sections((tmp_path / "s.dat").read_text())["SYROPE IC"][-1][1] == "8000"
    assert (tmp_path / "s_syrope.dat").read_text().split("\n")[1] == "LINEAR WCType"


SYROPE = (
    "--to", "moordyn", "--form", "syrope", "--frequency", "0.3 Hz", "--mean-tension", "21 %RBS",
    "--tension-amplitude", "8.5 %RBS", "--working-curve", "LINEAR, 0.1", "--linear-density",
    "0.11 kg/m",
)  # fmt: skip


def test_a_share_of_the_break_strength_is_one_tension_for_every_option(command, tmp_path):
    line = "polyester-double-braid-0.5in-new"
    told = []
    # 6,400 lbf is the rated strength of Table 10
    for number, greatest in enumerate(("30 %RBS", "1920 lbf")):
        path = tmp_path / f"leg{number}.dat"
        done = command("export", line, *SYROPE, "--greatest-mean-tension", greatest, "--out", path,
                       "--json")  # fmt: skip
        told.append(answered(done)["sources"][-1])
    assert "greatest mean tension" in " ".join(told)
    assert told[0] == told[1]


@pytest.mark.parametrize(
    ("options"),
    [("--to", "moordyn", "--form", "static-dynamic"), ("--to", "moorpy", "--form", "library")],
)
def test_dynamics_without_levels_name_the_options_that_are_missing(command, tmp_path, options):
    done = command("export", "polyester-double-braid-0.5in-new", *options, "--linear-density",
                   "0.11 kg/m", "--out", tmp_path / "x")  # fmt: skip
    assert done.returncode == 2
    for name in ("State the three levels", "--frequency", "--mean-tension", "--tension-amplitude"):
        assert name in done.stderr


def test_a_deck_is_called_after_the_program_that_reads_it(command, tmp_path):
    for program, name in (("moordyn", "MoorDyn"), ("moorpy", "MoorPy")):
        path = tmp_path / f"{program}.dat"
        command("export", "polyester-double-braid-0.5in-new", "--to", program, "--linear-density",
                "0.11 kg/m", "--out", path)  # fmt: skip
        text = path.read_text(encoding="utf-8")
        assert text.startswith(f"{name} input file")
        if program == "moordyn":
            assert "MoorDyn reads a negative number as a share of the critical" in " ".join(
                text.replace("\n", " ").split()
            )

"""Export of surfaces, experiments, damped tables; hydrodynamics; the check in the client."""

import csv
import importlib
import importlib.util
import json
import math
import re
import shutil
import sys
import zipfile
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from commandruns import answered
from export_readers import cable_material, moordyn_sections
from moordyn_runs import last_cycles, run
from python_calamine import CalamineWorkbook

from reduction.archive.open import open_archive
from reduction.archive.workbook import sheets_of_tables, write_workbook
from reduction.lines.archive_source import lines_of_archive
from reduction.lines.client_runs import LIMITS
from reduction.lines.line_lookup import look_up
from reduction.lines.lookup_product import LineSource
from reduction.record.errors import SettingsError

NEWTON = 4.4482216152605  # in a pound
FORMATS = ("csv", "json", "latex", "markdown", "netcdf", "xlsx")


def read_back(path, to):
    """Columns by name, written from the grammars."""
    if to == "netcdf":
        with netCDF4.Dataset(path) as file:
            return {name: np.array(one[:]).astype(str) for name, one in file.variables.items()}
    if to == "xlsx":
        heads, *rows = CalamineWorkbook.from_path(path).get_sheet_by_name("values").to_python()
        return dict(zip(heads, np.array(rows).astype(str).T, strict=True))
    text = path.read_text(encoding="utf-8")
    if to == "json":
        return {name: np.array(one).astype(str) for name, one in json.loads(text)["values"].items()}
    if to == "csv":
        rows = list(csv.reader(text.splitlines()))
    elif to == "latex":
        rows = [
            [cell.strip().replace("\\_", "_").replace("\\textasciicircum{}", "^") for cell in
             line.strip().removesuffix("\\\\").split(" & ")]
            for line in text.split("\n") if " & " in line
        ]  # fmt: skip
    else:
        rows = [
            [cell.strip().replace("\\", "") for cell in line.strip("| ").split(" | ")]
            for line in text.split("\n") if line.startswith("|") and "---" not in line
        ]  # fmt: skip
    return dict(zip(rows[0], np.array([row[: len(rows[0])] for row in rows[1:]]).T, strict=True))


@pytest.fixture(scope="module")
def archive(nylon_campaign):
    return nylon_campaign.processed / "surfaces.nc"


def exported(command, archive, out, to, *more):
    done = command("export", archive, "--to", to, "--out", out, *more)
    assert done.returncode == 0, done.stderr
    return read_back(out, to)


@pytest.fixture(scope="module")
def in_si(command, archive, tmp_path_factory):
    """The columns of the csv, exported once."""
    return exported(command, archive, tmp_path_factory.mktemp("si") / "s.csv", "csv")


@pytest.fixture(scope="module")
def in_us(command, archive, tmp_path_factory):
    out = tmp_path_factory.mktemp("us") / "s.csv"
    return exported(command, archive, out, "csv", "--units", "us")


@pytest.fixture(scope="module")
def line(archive):
    (found,) = lines_of_archive(archive)
    return found


@pytest.mark.parametrize("to", FORMATS)
def test_every_format_gives_the_coefficients_of_the_archive_back(
    command, archive, tmp_path, in_si, to
):
    found = in_si if to == "csv" else exported(command, archive, tmp_path / "s.out", to)
    at = np.flatnonzero(found["response"] == "apparent_spring_constant")
    assert found["term"][at].tolist() == [f"B{one}" for one in range(1, 11)]
    with open_archive(archive) as file:
        for column, name in (
            ("coefficient", "coefficient"),
            ("coefficient_standard_uncertainty", "coefficient_standard_uncertainty"),
            ("coefficient_engineering", "coefficient_engineering"),
        ):
            wanted = file[f"apparent_spring_constant_{name}"].to_numpy()[0]
            np.testing.assert_allclose(found[column][at].astype(float), wanted, rtol=1e-12)


def test_the_diagonal_of_the_covariance_is_the_square_of_the_uncertainties(in_si):
    found = in_si
    for response in np.unique(found["response"]):
        at = np.flatnonzero(found["response"] == response)
        covariance = np.array(
            [found[f"covariance_B{place + 1}"][at] for place in range(at.size)]
        ).astype(float)
        spread = found["coefficient_standard_uncertainty"][at].astype(float)
        np.testing.assert_allclose(np.sqrt(np.diag(covariance)), spread, rtol=1e-9)
        np.testing.assert_allclose(covariance, covariance.T, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("unit", "newton"), [("N", 1.0), ("lbf", NEWTON)])
def test_the_polynomial_of_levels_is_the_look_up(in_si, in_us, line, unit, newton):
    found = in_si if unit == "N" else in_us
    at = found["response"] == "apparent_spring_constant"
    surface = line.surfaces["apparent_spring_constant"]
    share = np.random.default_rng(1).uniform(0.3, 0.7, 3)
    levels = dict(
        zip(line.factor_names, surface.low + share * (surface.high - surface.low), strict=True)
    )
    shown = {
        name: value / (1.0 if name == "frequency" else newton) for name, value in levels.items()
    }
    value = 0.0
    for coefficient, term in zip(
        found["coefficient_engineering"][at].astype(float), found["term_name"][at], strict=True
    ):
        factors = [one.partition("^") for one in term.split("*")] if term != "mean" else []
        value += coefficient * np.prod(
            [shown[name] ** int(power or 1) for name, _, power in factors]
        )
    answer = look_up(line, "apparent_spring_constant", **levels)
    assert value * newton == pytest.approx(float(answer.value), rel=1e-9)
    assert set(found["unit"][at]) == {unit}


@pytest.mark.parametrize("form", [(), ("--form", "printed")])
def test_coefficients_bring_along_why_runs_have_the_status_check(command, archive, tmp_path, form):
    """R05 of the synthetic campaign goes slack in every cycle."""
    out = tmp_path / "s.md"
    done = command("export", archive, "--to", "markdown", "--out", out, *form)
    said = "DOUBTFUL: 1 of 15 runs has the status check; R05: the spring-dashpot model does not"
    assert done.stdout.split("\n")[1].startswith(f"  note: {said}")
    assert said in out.read_text(encoding="utf-8")


def test_a_logarithm_stays_in_si(in_si, in_us):
    at = in_si["response"] == "log_hysteresis_energy"
    assert at.any()
    assert in_si["coefficient"][at].tolist() == in_us["coefficient"][at].tolist()


def test_the_surfaces_that_are_looked_up_are_named_and_give_the_look_up(in_si, line):
    found = in_si
    low, high = np.array([[0.1, 768 * NEWTON, 320 * NEWTON], [0.5, 1920 * NEWTON, 768 * NEWTON]])
    coded = np.array([0.5, -0.3, 0.2])
    levels = dict(zip(line.factor_names, (low + high) / 2 + coded * (high - low) / 2, strict=True))
    terms = np.array([1, *coded**2, *coded, *(coded[[0, 0, 1]] * coded[[1, 2, 2]])])
    chosen = np.unique(found["response"][found["looked_up"] == "yes"]).tolist()
    assert len(chosen) == 4
    for name in chosen:
        at = found["response"] == name
        (read_as,) = set(found["response_is"][at])
        total = float(found["coefficient"][at].astype(float) @ terms)
        response = next(one for one in line.surfaces if name.endswith(one))
        value = total if read_as.startswith("sum") else np.exp(total)
        value /= levels["frequency"] if "/ frequency in Hz" in read_as else 1.0
        assert value == pytest.approx(float(look_up(line, response, **levels).value), rel=1e-6)
    assert "log_hysteresis_energy" in chosen


def test_an_experiment_that_is_not_there_is_named(command, archive, tmp_path):
    done = command(
        "export", archive, "--to", "csv", "--out", tmp_path / "s.csv", "--specimen", "hemp"
    )
    assert done.returncode != 0
    assert "no surface of 'hemp'" in done.stderr
    assert "nylon" in done.stderr


@pytest.mark.parametrize("to", ["csv", "xlsx"])
def test_the_printed_form_has_the_columns_of_the_report_and_its_digits(
    command, archive, tmp_path, to
):
    found = exported(command, archive, tmp_path / "s.out", to, "--form", "printed")
    at = np.flatnonzero(found["RESPONSE"] == "apparent_spring_constant (lb/in/in x 10^4)")
    assert found["FACTOR"][at][[0, 2, 9, 10]].tolist() == ["MEAN", "T_m^2", "T_m, dT", "r^2"]
    printed = found["nylon"][at]
    with open_archive(archive) as file:
        wanted = file["apparent_spring_constant_coefficient"].to_numpy()[0]
    own = [float(text) for text in printed[:10]]
    np.testing.assert_allclose(own, wanted / NEWTON / 1e4, atol=5.01e-4)
    # levels of 12 to 30 and 5 to 12 % of 6,400 lb, as Table 3 has them
    assert printed[-3:].tolist() == ["0.1 - 0.5", "768 - 1920", "±320 - ±768"]
    assert not any("log_" in one for one in found["RESPONSE"])


def test_a_workbook_has_every_table_with_units_and_numbers_as_numbers(command, archive, tmp_path):
    out = tmp_path / "all.xlsx"
    done = command("export", archive.parent, "--to", "xlsx", "--out", out)
    assert done.returncode == 0, done.stderr
    book = CalamineWorkbook.from_path(out)
    tables = archive.parent / "tables"
    names = {path.stem for path in tables.glob("*.csv")} - {"columns"}
    _, *contents = book.get_sheet_by_name("contents").to_python()
    assert {row[0] for row in contents} == {f"{name}.csv" for name in names}
    (name,) = (row[1] for row in contents if row[0] == "cycles.csv")
    heads, *rows = book.get_sheet_by_name(name).to_python()
    with (tables / "cycles.csv").open(newline="", encoding="utf-8") as file:
        own, *wanted = csv.reader(file)
    assert heads == own and len(rows) == len(wanted)
    for column in ("test", next(one for one in own if one.startswith("cycle")), "apparent_spring_constant [N]",
                   "apparent_spring_constant_standard_uncertainty [N]"):  # fmt: skip
        place = own.index(column)
        for row, as_text in zip(rows, wanted, strict=True):
            if isinstance(row[place], float):
                assert row[place] == pytest.approx(float(as_text[place]), rel=1e-14)
            else:
                assert row[place] == as_text[place]
        assert isinstance(rows[0][place], str if column == "test" else float)


def test_no_text_of_a_workbook_is_a_formula(tmp_path):
    texts = ["=1+1", "+2", "-x", "@a", "=HYPERLINK(1)", "https://a.example"]
    tables = tmp_path / "tables"
    tables.mkdir()
    (tables / "columns.csv").write_text(
        "table,column,unit,meaning,no_uncertainty\nodd.csv,name,,a name,label\n"
    )
    (tables / "odd.csv").write_text("name,number [N]\n" + "".join(f"{t},007\n" for t in texts))
    write_workbook(tmp_path / "odd.xlsx", sheets_of_tables(tables))
    write_workbook(tmp_path / "again.xlsx", sheets_of_tables(tables))
    assert (tmp_path / "again.xlsx").read_bytes() == (tmp_path / "odd.xlsx").read_bytes()
    with zipfile.ZipFile(tmp_path / "odd.xlsx") as book:
        pages = [book.read(one).decode() for one in book.namelist() if "worksheets/sheet" in one]
    assert pages and not any("<f>" in one or "hyperlink" in one for one in pages)
    rows = CalamineWorkbook.from_path(tmp_path / "odd.xlsx").get_sheet_by_name("odd").to_python()
    assert rows[1:] == [[text, 7.0] for text in texts]


def test_a_missing_library_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "xlsxwriter", None)
    with pytest.raises(SettingsError, match=r"pip install \"mooring-reduction\[xlsx\]\""):
        write_workbook(tmp_path / "a.xlsx", [])


# A rope of one's own, from its experiment to the dynamic stiffness that a mooring code runs with

export = importlib.import_module("reduction.cli.export")
LBF = 4.4482216152605
STRENGTH = 6400 * LBF
CENTRE = ("--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS")
MASS = ("--linear-density", "0.2 kg/m")


def truth(frequency, mean, amplitude):
    """K_ap and H of the line that raw/nylon-synthetic/generate.py states, at the centre of its plan.

    K_0 is the inverse slope of the cubic of CG-D-39-80, Table 8, nylon double braid 1/2 in (strain,
    load in lbf), K_1 17,000 lbf and tau 5.0 s.
    """
    load = mean / LBF
    rest = LBF / (1.389e-4 - 2 * 3.906e-8 * load + 3 * 3.795e-12 * load**2)
    turned = 2j * np.pi * frequency * 5.0
    complex_stiffness = rest + 17_000 * LBF * turned / (1 + turned)
    stiffness = abs(complex_stiffness)
    return stiffness, np.pi * (amplitude / stiffness) ** 2 * complex_stiffness.imag


def exported_of_experiment(command, folder, out, *levels, form="static-dynamic", also=()):
    return command(
        "export", folder, "--to", "moordyn", "--form", form, *MASS, *levels, "--out", out, *also
    )


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
def test_a_rope_of_ones_own_runs_in_moordyn_with_the_stiffness_of_its_law(
    nylon_campaign, command, tmp_path
):
    done = exported_of_experiment(command, nylon_campaign.processed, tmp_path / "deck.dat", *CENTRE)
    assert done.returncode == 0, done.stderr
    assert "SYNTHETIC" in (tmp_path / "deck.dat").read_text()
    frequency, mean, amplitude = 0.3, 0.21 * STRENGTH, 0.085 * STRENGTH
    stiffness, energy = truth(frequency, mean, amplitude)
    stretch = amplitude / stiffness
    ended, tension = run(tmp_path, mean=0.1, amplitude=stretch, frequency=frequency, cycles=40)
    assert ended.returncode == 0, ended.stdout[-800:]
    sine, cosine = last_cycles(tension)
    # the tension of a step is that at its end, a phase of a two-hundredth cycle later
    found = complex(sine, cosine) * np.exp(-2j * np.pi / 200)
    assert abs(found) / stretch == pytest.approx(stiffness, rel=0.02)
    assert np.pi * stretch * found.imag == pytest.approx(energy, rel=0.05)
    # beside what the campaign itself has there, which is what the deck promises
    for name, value in (
        ("K_ap", abs(found) / stretch), ("H", np.pi * stretch * found.imag),
    ):  # fmt: skip
        asked = command(
            "lookup",
            nylon_campaign.processed / "surfaces.nc",
            "--quantity",
            name,
            *CENTRE,
            "--json",
        )
        assert value == pytest.approx(json.loads(asked.stdout)["value"], rel=0.02)


def test_the_archive_of_surfaces_is_the_same_line_as_its_folder(nylon_campaign, command, tmp_path):
    folder = nylon_campaign.processed
    for name, source in (("a", folder), ("b", folder / "surfaces.nc")):
        assert (
            exported_of_experiment(command, source, tmp_path / f"{name}.dat", *CENTRE).returncode
            == 0
        )
    assert (tmp_path / "a.dat").read_text() == (tmp_path / "b.dat").read_text()


@pytest.mark.parametrize(
    ("levels", "also", "said", "status"),
    [
        (CENTRE[:4], (), "--tension-amplitude", 2),
        (CENTRE, ("--curve", "mean"), "slow pull", 2),
        (CENTRE, ("--specimen", "line-9"), "there is no 'line-9'", 2),
        ((*CENTRE[:3], "60 %RBS", *CENTRE[4:]), (), "outside the tested range", 4),
    ],
)
def test_what_an_experiment_cannot_answer_is_refused(
    nylon_campaign, command, tmp_path, levels, also, said, status
):
    out = tmp_path / "deck.dat"
    done = exported_of_experiment(command, nylon_campaign.processed, out, *levels, also=also)
    assert done.returncode == status
    assert said in done.stderr
    assert not out.exists()


@pytest.mark.nightly
@pytest.mark.parametrize("lost", ["archive", "statement"])
def test_an_experiment_without_its_slow_pull_is_refused(nylon_campaign, command, tmp_path, lost):
    folder = tmp_path / "nylon"
    folder.mkdir()
    for path in nylon_campaign.processed.glob("*.nc"):
        shutil.copy(path, folder)
    if lost == "archive":
        (folder / "Q01.nc").unlink()
    else:
        with netCDF4.Dataset(folder / "surfaces.nc", "a") as archive:
            settings = json.loads(archive.settings)
            settings["nylon"]["quasi_static"] = {}
            archive.settings = json.dumps(settings)
    done = exported_of_experiment(command, folder, tmp_path / "deck.dat", *CENTRE)
    assert done.returncode != 0
    assert ("no test Q01" if lost == "archive" else "quasi_static") in done.stderr


def test_surfaces_over_strain_are_told_from_a_level_that_is_missing(monkeypatch):
    line = LineSource(
        "main", "", "", "", "", 0.025, 2500.0, surfaces={"apparent_spring_constant": None},
        factor_names=("frequency", "mean_strain", "strain_amplitude"),
    )  # fmt: skip
    monkeypatch.setattr(export, "experiments_with_pulls", lambda path: [line])
    levels = {"frequency": "0.1 Hz", "mean_tension": "180 N", "tension_amplitude": "50 N"}
    with pytest.raises(SettingsError, match=r"those of main, over .*mean_strain.*damped-table"):
        export._of_levels(Path("surfaces.nc"), {}, None, levels, "refuse", {})


# A tether of one's own, with the loop of its test, in MoorDyn

MASS_OF_DAMPED_TABLE = ("--linear-density", "0.55 kg/m")


def exported_of_damped_table(command, source, out, *options):
    return command(
        "export",
        source,
        "--to",
        "moordyn",
        "--form",
        "damped-table",
        *MASS_OF_DAMPED_TABLE,
        *options,
        "--out",
        out,
    )


def of_test(path, specimen):
    """What the archive of a test says of its cycles."""
    with netCDF4.Dataset(path) as archive:
        names = [str(name) for name in archive["specimen"][:]]
        place = names.index(specimen)
        cycles = archive["cycles"]
        return {
            name: float(cycles[f"test_{name}"][place])
            for name in (
                "apparent_spring_constant", "hysteresis_energy", "strain_amplitude", "mean_strain",
                "frequency",
            )
        }  # fmt: skip


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
@pytest.mark.parametrize(("test", "specimen"), [("T-2", "new"), ("T-3", "used")])
def test_a_tether_gives_back_the_cycle_of_its_test(synthetic, command, tmp_path, test, specimen):
    """K_ap and H of the campaign within 2 %, in a sine of the test's own levels."""
    archive = synthetic.processed / f"{test}.nc"
    done = exported_of_damped_table(command, archive, tmp_path / "deck.dat", "--specimen", specimen)
    assert done.returncode == 0, done.stderr
    wanted = of_test(archive, specimen)
    amplitude, frequency = wanted["strain_amplitude"], wanted["frequency"]
    ended, tension = run(
        tmp_path, mean=wanted["mean_strain"], amplitude=amplitude, frequency=frequency, cycles=4
    )
    assert ended.returncode == 0, ended.stdout[-800:]
    last = tension[-200:]
    assert np.ptp(last) / 2 / amplitude == pytest.approx(
        wanted["apparent_spring_constant"], rel=0.02
    )
    # the tension of a step is that at its end; the rate of strain there times it is the power
    phase = 2 * np.pi * (np.arange(200) + 1) / 200
    energy = 2 * np.pi / 200 * np.sum(last * amplitude * np.cos(phase))
    assert energy == pytest.approx(wanted["hysteresis_energy"], rel=0.02)


def test_an_energy_that_may_be_none_is_doubtful_on_the_screen(synthetic, command, tmp_path):
    archive, out = synthetic.processed / "T-5.nc", tmp_path / "deck.dat"
    with netCDF4.Dataset(archive) as file:
        energy, spread = (
            float(file["cycles"][name][0])
            for name in (
                "test_hysteresis_energy", "test_hysteresis_energy_standard_uncertainty",
            )
        )  # fmt: skip
    assert 1.96 * spread > energy
    done = exported_of_damped_table(command, archive, out, "--specimen", "new")
    assert "DOUBTFUL, the interval includes zero" in done.stdout
    assert "DOUBTFUL, the interval includes zero" in out.read_text()


@pytest.mark.parametrize("options", [("--curve", "ascending"), ()])
def test_a_line_without_a_loop_is_refused(synthetic, command, tmp_path, options):
    source = synthetic.processed / "T-2.nc" if options else "polyester-double-braid-0.5in-new"
    also = ("--specimen", "new") if options else ()
    done = exported_of_damped_table(command, source, tmp_path / "deck.dat", *options, *also)
    assert done.returncode == 2
    assert "hysteresis energy of the cycles" in done.stderr
    assert not (tmp_path / "deck.dat").exists()


# options --drag and --added-mass of the export, as each format writes them

NAME = "polyester-double-braid-0.5in-new"
WATER = ("--drag", "1.6, 0.02", "--added-mass", "0.9, 0.1", "--hydrodynamics-source", "towed 2019")
SAID = "stated at the export, towed 2019"


@pytest.fixture
def export_of_hydrodynamics(command, tmp_path):
    def write(to, *more):
        path = tmp_path / f"line.{to}"
        done = command(
            "export", NAME, "--to", to, "--out", path, "--linear-density", "0.11 kg/m", *more
        )
        assert done.returncode == 0, done.stderr
        return path.read_text(encoding="utf-8")

    return write


def whole(text):
    """A header without its broken lines."""
    return " ".join(re.sub(r"[#*/]", " ", text).split())


@pytest.mark.parametrize("to", ["moordyn", "openfast", "moorpy"])
def test_a_deck_has_the_coefficients_and_their_source(export_of_hydrodynamics, to):
    text = export_of_hydrodynamics(to, *WATER)
    (row,) = moordyn_sections(text)["LINE TYPES"]
    # Cd Ca CdAx CaAx
    assert [float(value) for value in row[-4:]] == [1.6, 0.9, 0.02, 0.1]
    assert SAID in whole(text)
    assert "assumed" not in text


def test_orcaflex_and_cable_have_them_as_their_grammar_is(export_of_hydrodynamics):
    text = export_of_hydrodynamics("orcaflex", *WATER)
    # nominal 1/2 in; volume of 0.11 kg/m of polyester, 1380 kg/m3: Cd times diameter stays
    volume, nominal = math.sqrt(4 * 0.11 / 1380 / math.pi), 0.0127
    across, along = (float(value) for value in re.search(r"Cd: \[(\S+), ~, (\S+)\]", text).groups())
    assert (across * nominal, along * nominal) == pytest.approx((1.6 * volume, 0.02 * volume))
    for way in ("Normal", "Axial"):
        (found,) = re.findall(rf"{way}DragLiftDiameter: (\S+)", text)
        assert float(found) == pytest.approx(nominal)
    assert float(re.search(r" OD: (\S+)", text)[1]) == pytest.approx(volume)
    assert "Ca: [0.9, ~, 0.1]" in text
    assert f"is times {volume / nominal:.4g} here" in whole(text)
    assert SAID in whole(text)
    text = export_of_hydrodynamics("whoi-cable", *WATER)
    _, rows = cable_material(text)
    assert (float(rows["Cdn"]), float(rows["Cdt"])) == (1.6, 0.02)
    # added mass of 0.9 times the displaced polyester, 1380 kg/m3
    assert float(rows["am"]) == pytest.approx(0.9 * 1025 * 0.11 / 1380)
    assert "added mass along the line, 0.1, left out: Cable has none" in whole(text)


def test_without_them_the_cylinder_is_assumed(export_of_hydrodynamics):
    text = whole(export_of_hydrodynamics("moordyn"))
    assert "assumed, not measured: a smooth cylinder" in text
    assert "left out" not in whole(export_of_hydrodynamics("whoi-cable"))
    half = whole(export_of_hydrodynamics("moordyn", *WATER[:2]))
    assert "drag stated at the export, without a source; added mass assumed" in half


def test_the_answer_has_them(command, tmp_path):
    done = command("export", NAME, "--to", "csv", "--out", tmp_path / "a.csv", *WATER, "--json")
    assert json.loads(done.stdout)["hydrodynamics"] == {
        "normal_drag": 1.6, "axial_drag": 0.02, "normal_added_mass": 0.9, "axial_added_mass": 0.1,
        "source": SAID,
    }  # fmt: skip
    refused = command("export", NAME, "--to", "csv", "--out", tmp_path / "a.csv", "--drag", "1.6")
    assert refused.returncode == 2
    assert "--drag is not a pair of coefficients" in refused.stderr


# `export --verify` on the screen, in the header and in the status


@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
def test_the_command_prints_what_the_program_gave_and_the_header_has_it(command, tmp_path):
    done = command(
        "export", "polyester-double-braid-0.5in-new", "--to", "moordyn", "--form",
        "static-dynamic", "--linear-density", "0.11 kg/m", "--frequency", "0.3 Hz",
        "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS", "--verify", "--json",
        "--out", tmp_path / "leg.dat",
    )  # fmt: skip
    checks = answered(done)["checks"]
    assert {one["quantity"] for one in checks} == {"tension", "K_ap", "H"}
    assert all(abs(one["error"]) <= LIMITS[one["quantity"]] and one["kept"] for one in checks)
    head = " ".join((tmp_path / "leg.dat").read_text().split())
    assert "run in MoorDyn 2.7" in head
    assert "H within 0." in head

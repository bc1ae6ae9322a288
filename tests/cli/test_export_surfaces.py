"""`export surfaces.nc`: what every format says, read back, beside the archive and the look-up."""

import csv
import json
import sys
import zipfile

import netCDF4
import numpy as np
import pytest
from python_calamine import CalamineWorkbook

from reduction.archive.open import open_archive
from reduction.archive.workbook import sheets_of_tables, write_workbook
from reduction.lines.archive_source import lines_of_archive
from reduction.lines.line_lookup import look_up
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

"""`export surfaces.nc`: what every format says, read back, beside the archive and the look-up."""

import csv
import json

import netCDF4
import numpy as np
import pytest

from reduction.archive.open import open_archive
from reduction.lines.archive_source import lines_of_archive
from reduction.lines.line_lookup import look_up

NEWTON = 4.4482216152605  # in a pound
FORMATS = ("csv", "json", "latex", "markdown", "netcdf")


def read_back(path, to):
    """Columns by name, written from the grammars."""
    if to == "netcdf":
        with netCDF4.Dataset(path) as file:
            return {name: np.array(one[:]).astype(str) for name, one in file.variables.items()}
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


@pytest.mark.parametrize("to", FORMATS)
def test_every_format_gives_the_coefficients_of_the_archive_back(command, archive, tmp_path, to):
    found = exported(command, archive, tmp_path / "s.out", to)
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


def test_the_diagonal_of_the_covariance_is_the_square_of_the_uncertainties(
    command, archive, tmp_path
):
    found = exported(command, archive, tmp_path / "s.csv", "csv")
    for response in np.unique(found["response"]):
        at = np.flatnonzero(found["response"] == response)
        covariance = np.array(
            [found[f"covariance_B{place + 1}"][at] for place in range(at.size)]
        ).astype(float)
        spread = found["coefficient_standard_uncertainty"][at].astype(float)
        np.testing.assert_allclose(np.sqrt(np.diag(covariance)), spread, rtol=1e-9)
        np.testing.assert_allclose(covariance, covariance.T, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(("units", "newton"), [("si", 1.0), ("us", NEWTON)])
def test_the_polynomial_of_levels_is_the_look_up(command, archive, tmp_path, units, newton):
    found = exported(command, archive, tmp_path / "s.csv", "csv", "--units", units)
    at = found["response"] == "apparent_spring_constant"
    (line,) = lines_of_archive(archive)
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
    assert set(found["unit"][at]) == {"N" if units == "si" else "lbf"}


def test_a_logarithm_stays_in_si(command, archive, tmp_path):
    si = exported(command, archive, tmp_path / "a.csv", "csv")
    us = exported(command, archive, tmp_path / "b.csv", "csv", "--units", "us")
    at = si["response"] == "log_hysteresis_energy"
    assert at.any()
    assert si["coefficient"][at].tolist() == us["coefficient"][at].tolist()


def test_an_experiment_that_is_not_there_is_named(command, archive, tmp_path):
    done = command(
        "export", archive, "--to", "csv", "--out", tmp_path / "s.csv", "--specimen", "hemp"
    )
    assert done.returncode != 0
    assert "no surface of 'hemp'" in done.stderr
    assert "nylon" in done.stderr

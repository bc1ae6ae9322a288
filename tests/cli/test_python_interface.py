"""The Python interface gives what the commands give."""

import contextlib
import doctest
import json
import re
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest
import xarray as xr

import reduction
from reduction.quantities.units import parse_quantity
from reduction.record.errors import DataError, SettingsError

plt = pytest.importorskip("matplotlib.pyplot")
ROOT = Path(__file__).parents[2]
LINE = "nylon-8-strand-plaited-0.5in-new"
LEVELS = {"frequency": "0.3 Hz", "mean_tension": "20 %RBS", "tension_amplitude": "8 %RBS"}


def of_command(*arguments):
    done = subprocess.run(
        [sys.executable, "-m", "reduction", "lookup", *arguments, "--json"],
        capture_output=True, text=True, check=True, cwd=ROOT,
    )  # fmt: skip
    return json.loads(done.stdout)


def test_the_package_shows_its_public_names_alone():
    names = dir(reduction)
    assert len(names) <= 30 and all(hasattr(reduction, name) for name in names)
    shown = {name for name in names if not name.startswith("__")}
    assert shown == {
        "export", "fit_surface", "look_up", "open_archive", "open_campaign", "predict_hose", "run"
    }  # fmt: skip


def test_a_look_up_is_that_of_the_command():
    options = [
        part for key, text in LEVELS.items() for part in (f"--{key.replace('_', '-')}", text)
    ]
    said = of_command(LINE, "--quantity", "K_ap", *options)
    found = reduction.look_up(LINE, "K_ap", **LEVELS)
    assert float(found.apparent_spring_constant) == pytest.approx(said["value"])
    ends = [float(found[f"apparent_spring_constant_{end}"]) for end in ("low", "high")]
    assert said["interval"] == pytest.approx(ends)
    assert found.apparent_spring_constant.attrs["units"] == said["unit"]
    assert bool(found.is_inside) is said["inside"]


def test_a_ranking_is_that_of_the_command():
    search = {"material": "nylon", "construction": "double braid", "condition": "new"}
    load = {"frequency": "0.3 Hz", "mean_tension": "4000 lbf", "tension_amplitude": "1600 lbf"}
    options = [
        part
        for key, text in (search | load).items()
        for part in (f"--{key.replace('_', '-')}", text)
    ]
    said = of_command("published", "--rank", "--quantity", "K_ap", *options)
    found = reduction.look_up("published", "K_ap", rank=True, **search, **load)
    assert found.line.values.tolist() == [one["line"] for one in said["ranked"]]
    for place, one in enumerate(said["ranked"]):
        row = found.isel(line=place)
        assert float(row.apparent_spring_constant) == pytest.approx(one["value"])
        assert row.ties.item() == ", ".join(one["ties"])
        assert float(row.apparent_spring_constant_line_low) == pytest.approx(
            one["line_interval"][0]
        )
        assert bool(row.is_inside) is one["inside"]
    assert found.attrs["errata"].startswith("CG-62")
    (name,) = said["left_out"]
    assert found.attrs["left_out"].startswith(f"{name}: ")
    # one of 0.75 in alone is no ranking
    with pytest.raises(DataError):
        reduction.look_up("published", "K_ap", rank=True, diameter="0.75 in", **search, **load)


def test_levels_are_texts_numbers_quantities_rows_and_named_arrays():
    plain = reduction.look_up(LINE, "K_ap", **LEVELS).apparent_spring_constant
    tension = float(reduction.look_up(LINE, "K_ap", **LEVELS).mean_tension)
    in_pounds = tension / parse_quantity("1 lbf", "force") * pint.UnitRegistry().lbf
    for level in (tension, [tension, tension], in_pounds):
        found = reduction.look_up(LINE, "K_ap", **LEVELS | {"mean_tension": level})
        np.testing.assert_allclose(found.apparent_spring_constant, float(plain), rtol=1e-12)
    axes = {
        "mean_tension": xr.DataArray([tension, 1.1 * tension], dims="mean_tension"),
        "frequency": xr.DataArray([0.1, 0.3, 0.5], dims="frequency"),
    }
    grid = reduction.look_up(LINE, "K_ap", **LEVELS | axes).apparent_spring_constant
    np.testing.assert_allclose(grid.frequency, [0.1, 0.3, 0.5])
    assert grid.sizes == {"mean_tension": 2, "frequency": 3}
    assert float(grid.isel(mean_tension=0, frequency=1)) == pytest.approx(float(plain))


def test_the_example_of_the_documentation_runs():
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    names = {}
    exec(code, names)  # noqa: S102 - the documentation's own example
    assert names["low"] < names["value"] < names["high"]
    assert float(names["curve"].sel(frequency=0.3)) == pytest.approx(names["value"])


def test_what_is_not_known_is_refused():
    with pytest.raises(DataError):
        reduction.look_up(LINE, "K_ap", **LEVELS | {"frequency": "5 Hz"})
    with pytest.raises(SettingsError, match="heading is not a level"):
        reduction.look_up(LINE, "K_ap", **LEVELS, heading=20.0)
    with pytest.raises(SettingsError, match="several dimensions"):
        reduction.look_up(LINE, "K_ap", **LEVELS | {"frequency": np.full((2, 2), 0.3)})


def test_a_run_gives_the_campaign_that_it_made(tmp_path):
    campaign = ROOT / "raw" / "buoy-technology-1997" / "campaign.toml"
    made = reduction.run(campaign, processed=tmp_path / "p", reports=tmp_path / "r")
    with made, reduction.open_campaign(tmp_path / "p" / "buoy-technology-1997") as opened:
        assert set(made.children) == set(opened.children) == {"static"}
    assert (tmp_path / "r" / "buoy-technology-1997" / "index.html").is_file()


def test_an_export_is_that_of_the_command(tmp_path):
    stated = {"linear_density": "0.1 kg/m", "wet_linear_density": "0.01 kg/m"}
    options = {"form": "static-dynamic", **stated, **LEVELS}
    given = options | {"linear_density": pint.UnitRegistry().Quantity(0.1, "kg/m")}
    done = reduction.export(LINE, "moordyn", tmp_path / "python.dat", **given)
    said = [part for key, text in options.items() for part in (f"--{key.replace('_', '-')}", text)]
    subprocess.run(
        [sys.executable, "-m", "reduction", "export", LINE, "--to", "moordyn",
         "--out", str(tmp_path / "command.dat"), *said],
        capture_output=True, check=True, cwd=ROOT,
    )  # fmt: skip
    assert done.paths[0] == tmp_path / "python.dat" and not done.checks
    assert done.paths[0].read_bytes() == (tmp_path / "command.dat").read_bytes()
    assert f"<li>wrote {tmp_path / 'python.dat'}</li>" in done._repr_html_()
    (drawn,) = done.plot()
    np.testing.assert_array_equal(drawn.get_xydata()[:, 1], done.exported.tension)
    plt.close("all")
    with pytest.raises(SettingsError, match="no option diametre"):
        reduction.export(LINE, "csv", tmp_path / "x.csv", diametre="26 mm")


def test_a_surface_of_runs_is_the_polynomial_that_made_them(tmp_path):
    levels = np.array(
        [
            [a, b, 0] for a in (-1, 1) for b in (-1, 1)
        ] + [[a, 0, b] for a in (-1, 1) for b in (-1, 1)]
        + [[0, a, b] for a in (-1, 1) for b in (-1, 1)] + [[0, 0, 0]] * 3
    )  # fmt: skip
    one, two, three = levels.T
    value = 5 + 0.5 * one**2 - 0.2 * two**2 + 2 * one - three + 0.3 * one * two
    scatter = 1e-3 * np.array([*[0.0] * 12, -1, 0, 1])
    rows = zip(one, two, three, 1000 * (value + scatter), strict=True)
    runs = tmp_path / "runs.csv"
    heads = "frequency,mean_tension,tension_amplitude,apparent_spring_constant [N]"
    body = "".join(",".join(f"{float(cell)!r}" for cell in row) + "\n" for row in rows)
    runs.write_text(heads + "\n" + body, encoding="utf-8")
    found = reduction.fit_surface(runs)
    (surface,) = found.coefficient.transpose("response", "term").values
    terms = [str(name) for name in found.term.values]
    wanted = dict.fromkeys(terms, 0.0)
    first, second, third = (str(name) for name in found.factor.values)
    wanted |= {terms[0]: 5.0, first: 2.0, third: -1.0}
    wanted |= {f"{first}^2": 0.5, f"{second}^2": -0.2, f"{first}*{second}": 0.3}
    assert set(wanted) == set(terms)
    np.testing.assert_allclose(surface, [1000 * wanted[name] for name in terms], atol=1e-9)
    np.testing.assert_allclose(
        np.sqrt(np.diagonal(found.covariance.values[0])),
        found.coefficient_standard_uncertainty.values[0],
    )
    levels = {"frequency": one, "mean_tension": two, "tension_amplitude": three}
    newton = pint.UnitRegistry().newton
    of_frame = pd.read_csv(runs)
    of_dataset = xr.Dataset({name: ("run", column) for name, column in levels.items()})
    of_dataset["apparent_spring_constant"] = (
        "run", 1000 * (value + scatter), {"units": "N"}
    )  # fmt: skip
    of_mapping = levels | {"apparent_spring_constant": 1000 * (value + scatter) * newton}
    for table in (of_frame, of_dataset, of_mapping):
        same = reduction.fit_surface(table)
        np.testing.assert_allclose(same.coefficient, found.coefficient, rtol=1e-12, atol=1e-9)
        assert same.response_unit.item() == "N"
    # two degrees of freedom are those of three centre runs, three those of the balance
    assert float(found.sigma[0]) == pytest.approx(np.sqrt(2 / 5))


@pytest.mark.nightly
def test_a_predicted_hose_is_that_of_the_command(tmp_path):
    text = (ROOT / "docs" / "predictions.md").read_text(encoding="utf-8")
    spec = tmp_path / "hose.toml"
    spec.write_text(re.findall(r"```toml\n(.*?)```", text, re.DOTALL)[0], encoding="utf-8")
    subprocess.run(
        [sys.executable, "-m", "reduction", "predict", "hose", str(spec), "--out", str(tmp_path)],
        capture_output=True, check=True, cwd=ROOT,
    )  # fmt: skip
    with reduction.open_archive(tmp_path / "predictions.nc") as said:
        found = reduction.predict_hose(spec)
        assert set(said.data_vars) == set(found.data_vars)
        stated = tomllib.loads(spec.read_text(encoding="utf-8"))
        units = pint.UnitRegistry()
        stated["hose"]["wrap_diameter"] = 3.5 * units.inch
        stated["cord"]["load"] = np.array([0, 1.6, 5, 10, 18, 30]) * units.pound_force
        same = reduction.predict_hose(stated)
        for name in ("tension", "fill_pressure"):
            np.testing.assert_array_equal(found[name], said[name])
            np.testing.assert_allclose(same[name], said[name], rtol=1e-12)


# what docs/archive.md shows of the synthetic campaign is what a reader of its products gets

PAGE = Path(__file__).parents[2] / "docs" / "archive.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S)


def test_the_examples_of_the_page_give_what_it_shows(synthetic):
    shown = "\n".join(block for block in BLOCKS if block.startswith(">>>"))
    example = doctest.DocTestParser().get_doctest(shown, {}, PAGE.name, str(PAGE), 0)
    with contextlib.chdir(synthetic.processed.parents[1]):
        failed, tried = doctest.DocTestRunner().run(example)
    assert tried == shown.count(">>>")
    assert failed == 0


@pytest.mark.nightly
@pytest.mark.skipif(find_spec("dask") is None, reason="Dask is not installed")
def test_the_dask_example_gives_the_highest_stress(synthetic):
    (block,) = (block for block in BLOCKS if not block.startswith(">>>"))
    names = {"reduction": reduction}
    with contextlib.chdir(synthetic.processed.parents[1]):
        exec(block, names)  # noqa: S102  # the page's own example
    with reduction.open_campaign(synthetic.processed / "T-4-extended.nc") as test:
        expected = np.nanmax(test["nominal_stress"].values, axis=1)
    np.testing.assert_array_equal(names["highest"].values, expected)


def test_every_archive_of_the_campaign_is_a_node(synthetic):
    with reduction.open_campaign(synthetic.processed) as campaign:
        assert set(campaign.children) == {one.stem for one in synthetic.processed.glob("*.nc")}
        assert campaign.attrs["synthetic"] == "yes"

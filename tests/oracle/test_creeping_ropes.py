"""A creeping rope at three mean loads, from its log to a line in MoorDyn, against its law."""

import importlib.util
import json

import numpy as np
import pytest
from moordyn_runs import run
from strangers import make
from typer.testing import CliRunner

from reduction.archive.open import reading
from reduction.cli.main import app
from reduction.lines.archive_source import lines_of_folder
from reduction.lines.line_lookup import look_up

STIFFNESS = 0.03  # of the secant stiffness of each level
NAMES = ("level-1", "level-2", "level-3")


def command(*arguments):
    done = CliRunner().invoke(app, [str(one) for one in arguments], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


@pytest.fixture(scope="module", params=["rope-creep-levels", "rope-creep-levels-steps"])
def rope(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    truth = make(request.param, 5, folder / "raw")
    command(
        "run", folder / "raw" / "campaign.toml", "--processed", folder / "p", "--reports",
        folder / "r", "--quiet",
    )  # fmt: skip
    return request.param, truth, folder / "p" / f"{request.param}-5"


def levels_of(rope):
    _, truth, folder = rope
    found = sorted(path.stem for path in folder.glob("R-1*.nc"))
    assert found == [f"R-1.{name}" for name in NAMES]
    for name, (label, values) in zip(NAMES, truth.tests["R-1"].items(), strict=True):
        yield label, values, folder / f"R-1.{name}.nc"


def test_every_number_of_a_level_is_that_of_its_law(rope):
    law, truth, _ = rope
    for label, values, path in levels_of(rope):
        secant = values["secant_spring_constant"]
        with reading(path) as archive:
            area, bins = float(archive["area"][0]), archive["strain_bin"].values
            middle = float(archive["alignment_strain"][0])
            assert float(archive["test_apparent_spring_constant"][0]) == pytest.approx(
                secant, rel=STIFFNESS
            )
            codes = [str(one) for one in archive["note_code"].values]
            assert ("levels-found" in codes) == (law == "rope-creep-levels")
            assert "cycles-aligned" in codes
            relative = truth.arrays[f"R-1/{label}/relative_strain"]
            for place, branch in enumerate(("ascending", "descending")):
                tension = archive["branch_tension"].values[0, place]
                known = np.isfinite(tension)
                rise = (tension[known][-1] - tension[known][0]) / np.ptp(bins[known])
                assert rise == pytest.approx(secant, rel=STIFFNESS)
                own = truth.arrays[f"R-1/{label}/{branch}/branch_tension"]
                inside = known & (np.abs(bins - middle) < relative[-1])
                at_bins = np.interp(bins[inside] - middle, relative, own)
                assert np.abs(tension[inside] / at_bins - 1).max() < STIFFNESS
                slope = area * archive["tangent_modulus"].values[0, place]
                assert np.nanmean(slope) == pytest.approx(secant, rel=STIFFNESS)
                of_segments = [
                    archive[f"segment_{one}"].values[0, place]
                    for one in ("modulus", "strain_low", "strain_high")
                ]
                for modulus, low, high in zip(*of_segments, strict=True):
                    if np.isfinite(modulus):
                        ends = np.interp(np.array([low, high]) - middle, relative, own)
                        chord = np.diff(ends)[0] / (high - low)
                        assert modulus * area == pytest.approx(chord, rel=STIFFNESS)
            creep = float(archive["mean_strain_per_decade"][0])
            assert creep == pytest.approx(values["creep_per_decade_record_from_3"], rel=0.05)


def test_the_levels_of_one_rope_are_one_line_with_the_stiffness_of_the_law(rope):
    _, truth, folder = rope
    line = lines_of_folder(folder)[0]
    assert line.name == "line"
    for values in truth.tests["R-1"].values():
        at = {name: values[name] for name in ("frequency", "mean_tension", "tension_amplitude")}
        for quantity in ("apparent_spring_constant", "hysteresis_energy"):
            found = look_up(line, quantity, **at)
            assert found.surface_low < values[quantity] < found.surface_high
    # the frequency and the amplitude that all levels have alike need not be said
    alone = look_up(line, "apparent_spring_constant", mean_tension=at["mean_tension"])
    assert alone.value == look_up(line, "apparent_spring_constant", **at).value


def test_looked_up_tensions_rise_as_the_law_does(rope):
    for _, values, path in levels_of(rope):
        half = 0.5 * values["strain_amplitude"]
        with reading(path) as archive:
            middle = float(archive["alignment_strain"][0])
        found = []
        for strain in (middle - half, middle + half):
            answer = command(
                "lookup", path, "--quantity", "tension", "--branch", "ascending", "--strain",
                f"{100 * strain} %", "--json",
            )  # fmt: skip
            found.append(json.loads(answer)["value"])
            assert "drifts by" in " ".join(json.loads(answer)["notes"])
        rise = (found[1] - found[0]) / (2 * half)
        assert rise == pytest.approx(values["secant_spring_constant"], rel=STIFFNESS)


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
def test_moordyn_runs_with_the_stiffness_of_each_level(rope, tmp_path):
    for _, values, path in levels_of(rope):
        command(
            "export", path, "--to", "moordyn", "--linear-density", "5 kg/m", "--out",
            tmp_path / "deck.dat",
        )  # fmt: skip
        amplitude = values["strain_amplitude"]
        with reading(path) as archive:
            middle = float(archive["alignment_strain"][0])
        done, tension = run(tmp_path, mean=middle, amplitude=amplitude, frequency=0.1, cycles=5)
        assert done.returncode == 0, done.stdout[-800:]
        found = np.ptp(tension[-200:]) / (2 * amplitude)
        assert found == pytest.approx(values["secant_spring_constant"], rel=STIFFNESS)

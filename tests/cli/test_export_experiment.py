"""A rope of one's own, from its experiment to the dynamic stiffness that a mooring code runs with."""

import importlib
import importlib.util
import json
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from moordyn_runs import run

from reduction.lines.lookup_product import LineSource
from reduction.record.errors import SettingsError

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


def exported(command, folder, out, *levels, form="static-dynamic", also=()):
    return command(
        "export", folder, "--to", "moordyn", "--form", form, *MASS, *levels, "--out", out, *also
    )


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
def test_a_rope_of_ones_own_runs_in_moordyn_with_the_stiffness_of_its_law(
    nylon_campaign, command, tmp_path
):
    done = exported(command, nylon_campaign.processed, tmp_path / "deck.dat", *CENTRE)
    assert done.returncode == 0, done.stderr
    assert "SYNTHETIC" in (tmp_path / "deck.dat").read_text()
    frequency, mean, amplitude = 0.3, 0.21 * STRENGTH, 0.085 * STRENGTH
    stiffness, energy = truth(frequency, mean, amplitude)
    stretch = amplitude / stiffness
    ended, tension = run(tmp_path, mean=0.1, amplitude=stretch, frequency=frequency, cycles=40)
    assert ended.returncode == 0, ended.stdout[-800:]
    phase = 2 * np.pi * np.arange(400) / 200
    waves = np.stack([np.ones(400), np.sin(phase), np.cos(phase)], axis=1)
    _, sine, cosine = np.linalg.lstsq(waves, tension[-400:], rcond=None)[0]
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
        assert exported(command, source, tmp_path / f"{name}.dat", *CENTRE).returncode == 0
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
    done = exported(command, nylon_campaign.processed, out, *levels, also=also)
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
    done = exported(command, folder, tmp_path / "deck.dat", *CENTRE)
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

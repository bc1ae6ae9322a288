"""Mass and give of the load train against laws that know them, end to end."""

import re

import numpy as np
import pytest
import xarray as xr
from strangers import make
from typer.testing import CliRunner

from reduction.cli.main import app

K_AP = "test_apparent_spring_constant"
STATED = ("train-mass", "train-compliance", "train-both")
USUAL_MASS = 1.2  # kg: a grip for 5,000 lb has 2.60 lb
UNSTATED = tuple(f"{law}-unstated" for law in STATED)


def reduced(law, seed, folder):
    truth = make(law, seed, folder)
    found = CliRunner().invoke(
        app, ["run", str(folder / "campaign.toml"), "--processed", str(folder / "p"), "--reports",
              str(folder / "r"), "--quiet"],
    )  # fmt: skip
    assert found.exit_code == 0, found.output
    archives = {}
    for path in sorted((folder / "p").rglob("L-*.nc")):
        with xr.open_datatree(path) as tree:
            archives[path.stem] = {
                str(name): variable.values
                for node in tree.subtree
                for name, variable in node.variables.items()
            }
    assert list(archives) == ["L-1", "L-2", "L-3"]
    return truth, archives


def one(archive, name):
    return float(np.ravel(archive[name])[0])


@pytest.mark.parametrize("law", STATED)
def test_what_is_stated_of_the_load_train_is_taken_off_with_its_uncertainty(law, tmp_path):
    truth, archives = reduced(law, 3, tmp_path)
    known = truth.constants
    for test, archive in archives.items():
        want = truth.tests[test]["piece"]
        constant = want["apparent_spring_constant"]
        found, spread = one(archive, K_AP), one(archive, f"{K_AP}_standard_uncertainty")
        assert abs(found - constant) < 2.58 * spread
        of_mass = (2 * np.pi * want["frequency"]) ** 2 * known["reference_length_m"]
        # what was drawn for the errors of both statements is no fault of the correction
        drawn = 0.0
        if "attached_mass" in truth.errors:
            drawn += truth.errors["attached_mass"]["drawn"] * of_mass
            least = truth.errors["attached_mass"]["stated_standard"] * of_mass
            assert 0.99 * least < spread < 1.2 * least + 0.01 * constant
        if "machine_compliance" in truth.errors:
            drawn += (
                truth.errors["machine_compliance"]["drawn"]
                * constant**2 / known["reference_length_m"]
            )  # fmt: skip
        felt = constant + known["attached_mass_kg"] * of_mass
        assert abs(found - drawn - constant) < 0.006 * felt
        assert abs(one(archive, "test_hysteresis_energy") - want["hysteresis_energy"]) < 2.58 * one(
            archive, "test_hysteresis_energy_standard_uncertainty"
        )


@pytest.mark.parametrize("law", UNSTATED)
def test_what_is_not_stated_is_told_with_the_size_that_matters(law, tmp_path):
    truth, archives = reduced(law, 3, tmp_path)
    length = truth.constants["reference_length_m"]
    for archive in archives.values():
        spread = one(archive, f"{K_AP}_standard_uncertainty")
        if np.isnan(spread):
            # inertia turned the loop over: no stiffness is given, and the first warning says why
            told = list(zip(archive["note"], archive["note_severity"], strict=True))
            assert any("inertia" in text and rank == "warning" for text, rank in told)
            continue
        # as found: what is left of a tension that inertia cancels has a phase of its own
        frequency = one(archive, "test_frequency")
        mass = spread / (2 * np.pi * frequency) ** 2 / length
        give = spread * length / one(archive, K_AP) ** 2
        severity = dict(zip(archive["note"], archive["note_severity"], strict=True))
        found = [(text, re.search(r"([0-9.e+-]+) (kg at a moving|m/N would)", text))
                 for text in severity]  # fmt: skip
        told = {match[2]: (float(match[1]), severity[text]) for text, match in found if match}
        assert told["kg at a moving"][0] == pytest.approx(mass, rel=0.02)
        assert told["m/N would"][0] == pytest.approx(give, rel=0.02)
        is_moved = mass < USUAL_MASS
        assert told["kg at a moving"][1] == ("warning" if is_moved else "note")
        # a frame of 3.8e-9 m/N gives nothing that a rubber tether would show
        assert told["m/N would"][1] == "note"

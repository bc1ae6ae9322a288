"""The synthetic rope logs are what their generator says, and obey the three-parameter line."""

import runpy
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "raw" / "nylon-synthetic"


@pytest.fixture(scope="module")
def again(tmp_path_factory):
    folder = tmp_path_factory.mktemp("nylon")
    runpy.run_path(str(FOLDER / "generate.py"))["main"](folder)
    return folder


def numbers(path):
    return np.loadtxt(path, delimiter=",", comments="#", skiprows=2)


@pytest.mark.parametrize("name", [*(f"R{number:02d}.csv" for number in range(1, 16)), "Q01.csv"])
def test_the_generator_writes_the_logs_again(again, name):
    # one unit of the last digit is left to other processors' sines
    last_digit = np.array([1e-4, 1e-4, 0.01, 1e-4])
    assert np.max(np.abs(numbers(again / name) - numbers(FOLDER / name)) / last_digit) < 1.1
    assert (FOLDER / name).read_text(encoding="utf-8").startswith("# synthetic")


def test_a_log_shows_the_amplitudes_and_the_lag_of_its_truth():
    # the last ten cycles of R12, by a fit of sine, cosine, mean and drift
    header, *rows = (FOLDER / "truth" / "runs.csv").read_text(encoding="utf-8").splitlines()[1:]
    truth = dict(zip(header.split(","), rows[11].split(","), strict=True))
    assert truth["run"] == "R12"
    time, _, load, strain = numbers(FOLDER / "R12.csv").T
    kept = (time > 80) & (time < 170)
    angle = 2 * np.pi * float(truth["frequency_hz"]) * time[kept]
    basis = np.column_stack([np.cos(angle), np.sin(angle), np.ones(angle.size), time[kept]])
    force = np.linalg.lstsq(basis, load[kept], rcond=None)[0]
    stretch = np.linalg.lstsq(basis, strain[kept] / 100, rcond=None)[0]
    stiffness = complex(force[0], -force[1]) / complex(stretch[0], -stretch[1])
    assert stiffness.real == pytest.approx(float(truth["storage_spring_constant_lbf"]), rel=2e-3)
    assert stiffness.imag == pytest.approx(float(truth["loss_spring_constant_lbf"]), rel=5e-3)
    assert np.hypot(*force[:2]) == pytest.approx(float(truth["tension_amplitude_lbf"]), rel=1e-3)

"""A tether of one's own, with the loop of its test, in MoorDyn."""

import importlib.util

import netCDF4
import numpy as np
import pytest
from moordyn_runs import run

MASS = ("--linear-density", "0.55 kg/m")


def exported(command, source, out, *options):
    return command(
        "export", source, "--to", "moordyn", "--form", "damped-table", *MASS, *options, "--out", out
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
    done = exported(command, archive, tmp_path / "deck.dat", "--specimen", specimen)
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
    done = exported(command, archive, out, "--specimen", "new")
    assert "DOUBTFUL, the interval includes zero" in done.stdout
    assert "DOUBTFUL, the interval includes zero" in out.read_text()


@pytest.mark.parametrize("options", [("--curve", "ascending"), ()])
def test_a_line_without_a_loop_is_refused(synthetic, command, tmp_path, options):
    source = synthetic.processed / "T-2.nc" if options else "polyester-double-braid-0.5in-new"
    also = ("--specimen", "new") if options else ()
    done = exported(command, source, tmp_path / "deck.dat", *options, *also)
    assert done.returncode == 2
    assert "hysteresis energy of the cycles" in done.stderr
    assert not (tmp_path / "deck.dat").exists()

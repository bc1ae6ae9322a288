from pathlib import Path

import numpy as np
import pytest

from reduction.archive.linesource import line_of_experiment, line_of_test
from reduction.archive.open import open_archive
from reduction.archive.surface_read import surfaces_of
from reduction.batch.run import run_campaign
from reduction.campaign.load import load_campaign
from reduction.errors import ArchiveError
from reduction.lookup.line import look_up
from reduction.surface.bands import evaluate_surfaces

RAW = Path(__file__).parents[2] / "raw" / "nylon-synthetic"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("line")
    run = run_campaign(
        load_campaign(RAW / "campaign.toml"), processed=folder / "p", reports=folder / "r",
        clock=lambda: 0.0,
    )  # fmt: skip
    return run.processed


@pytest.fixture(scope="module")
def surfaces(folder):
    with open_archive(folder / "surfaces.nc") as archive:
        yield archive.load()


def test_a_surface_is_looked_up_as_it_was_fitted(surfaces):
    line = line_of_experiment(surfaces, "nylon")
    fitted = surfaces_of(surfaces, "nylon", ["apparent_spring_constant"])
    centre, half = (fitted.low + fitted.high) / 2, (fitted.high - fitted.low) / 2
    points = centre + half * np.array([[0, 0, 0], [1, 0, -1], [-1, 1, 0.5]])
    expected = evaluate_surfaces(fitted, points)
    found = look_up(
        line, "apparent_spring_constant", **dict(zip(line.factor_names, points.T, strict=True))
    )
    assert found.value == pytest.approx(expected.value[0], rel=1e-12)
    interval = np.stack([found.low, found.high], axis=-1)
    assert interval == pytest.approx(expected.prediction_interval[0], rel=1e-9)
    assert found.is_untested.tolist() == expected.above_leverage.ravel().tolist()


def test_a_response_that_was_asked_for_on_a_scale_is_read_from_that_scale(surfaces):
    line = line_of_experiment(surfaces, "nylon")
    energy = line.surfaces["hysteresis_energy"]
    assert energy.exponent == 0
    assert any("log_hysteresis_energy" in note for note in energy.notes)
    assert "synthetic data" in line.notes


def test_tensions_come_as_shares_of_the_break_strength(surfaces):
    line = line_of_experiment(surfaces, "nylon")
    found = look_up(
        line, "relaxation_time", frequency=0.3,
        mean_tension=0.21 * line.rated_break_strength,
        tension_amplitude=0.085 * line.rated_break_strength,
    )  # fmt: skip
    assert found.peak_share == pytest.approx(0.295)
    assert found.minimum_share == pytest.approx(0.125)


def test_curves_of_a_test_are_by_branch(folder):
    path = sorted(folder.glob("R*.nc"))[0]
    with open_archive(path) as archive:
        name = str(archive["specimen"].to_numpy()[0])
        line = line_of_test(archive, name)
        at = archive["strain_bin"].to_numpy()
        moduli = archive["branch_tension"].to_numpy()[0]
    seen = np.isfinite(moduli[1])
    middle = np.flatnonzero(seen)[seen.sum() // 2]
    found = look_up(line, "branch_tension", strain=at[middle], branch="descending")
    assert found.value == pytest.approx(moduli[1, middle])
    with (
        pytest.raises(ArchiveError, match="has no such specimen; found other"),
        open_archive(path) as archive,
    ):
        line_of_test(archive, "other")


def test_what_has_no_surface_is_refused(surfaces):
    with pytest.raises(ArchiveError, match="no such experiment"):
        line_of_experiment(surfaces, "polyester")
    shares = surfaces.copy()
    shares["factor_unit"] = (shares["factor_unit"].dims, np.array([["Hz", "1", "1"]]))
    strengths = shares["run_rated_break_strength"].to_numpy().copy()
    strengths[0, 0] *= 2
    shares["run_rated_break_strength"] = (shares["run_rated_break_strength"].dims, strengths)
    with pytest.raises(ArchiveError, match="levels of mean_tension .* are no N"):
        line_of_experiment(shares, "nylon")

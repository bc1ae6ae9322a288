import shutil

import numpy as np
import pytest
from commandruns import run_once, shared_by_processes
from scipy import stats

from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import surfaces_of
from reduction.cli.lookup import lines_of_source
from reduction.experiments.designs import box_behnken
from reduction.experiments.surface_discrepancy import discrepancy_of
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.lines.archive_source import (
    CURVES,
    _line_source_of_experiment,
    _line_source_of_test,
    experiments_with_pulls,
)
from reduction.lines.line_lookup import look_up
from reduction.record.errors import ArchiveError, DataError

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return run_once("nylon-synthetic", shared_by_processes(tmp_path_factory)).processed


@pytest.fixture(scope="module")
def surfaces(folder):
    with open_archive(folder / "surfaces.nc") as archive:
        yield archive.load()


def test_a_surface_is_looked_up_as_it_was_fitted(surfaces):
    line = _line_source_of_experiment(surfaces, "nylon")
    fitted = surfaces_of(surfaces, "nylon")
    assert fitted.response_names[0] == "apparent_spring_constant"
    centre, half = (fitted.low + fitted.high) / 2, (fitted.high - fitted.low) / 2
    points = centre + half * np.array([[0, 0, 0], [1, 0, -1], [-1, 1, 0.5]])
    expected = evaluate_surfaces(fitted, points)
    found = look_up(
        line, "apparent_spring_constant", **dict(zip(line.factor_names, points.T, strict=True))
    )
    assert found.value == pytest.approx(expected.value[0], rel=1e-12)
    # scatter of the runs, what a quadratic may miss at the last point, and what the load cell and the extensometer do to all of them
    missed = discrepancy_of(fitted).at((points - centre) / half)[0]
    assert missed[0] < 1e-3 * missed[2]
    own, of_missed = expected.run_standard_uncertainty[0], 2 * 3  # two for each factor
    scatter = np.hypot(own, missed)
    freedom = scatter**4 / (own**4 / expected.degrees_of_freedom[0] + missed**4 / of_missed)
    coded = (points - centre) / half
    terms = np.prod(coded[:, None, :] ** fitted.exponents, axis=-1)
    rows = surfaces["apparent_spring_constant_coefficient_uncertainty_contribution"].to_numpy()[0]
    assert (np.abs(rows).max(axis=1) > 0).sum() == 3
    shared = np.sqrt(((terms @ rows.T) ** 2).sum(axis=1))
    assert shared.min() > scatter.max()
    u = np.hypot(scatter, shared)
    # Welch and Satterthwaite: the instruments are stated
    t = stats.t.ppf(0.975, freedom * (u / scatter) ** 4)
    assert found.high - found.value == pytest.approx(t * u, rel=1e-9)
    assert found.value - found.low == pytest.approx(t * u, rel=1e-9)
    # [1, 0, -1] is the plan of R07, which missed it by a ten-thousandth: it was tested
    assert found.is_untested.tolist() == [False, False, True]


def test_every_level_of_the_plan_is_tested_and_a_corner_is_not(surfaces):
    line = _line_source_of_experiment(surfaces, "nylon")
    (surface,) = (one for name, one in line.surfaces.items() if name == "relaxation_time")
    centre, half = (surface.high + surface.low) / 2, (surface.high - surface.low) / 2
    edges = centre + half * box_behnken(3).coded
    corners = centre + half * np.array([[-1, 1, 1], [1, 1, -1], [1, -1, -1]])
    for points, is_untested in ((edges, False), (corners, True)):
        at = dict(zip(line.factor_names, points.T, strict=True))
        found = look_up(line, "relaxation_time", **at)
        assert set(found.is_untested.tolist()) == {is_untested}


def test_a_response_that_was_asked_for_on_a_scale_is_read_from_that_scale(surfaces):
    line = _line_source_of_experiment(surfaces, "nylon")
    energy = line.surfaces["hysteresis_energy"]
    assert energy.exponent == 0
    assert any("log_hysteresis_energy" in note for note in energy.notes)
    assert "synthetic data" in line.notes


def test_tensions_come_as_shares_of_the_break_strength(surfaces):
    line = _line_source_of_experiment(surfaces, "nylon")
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
        line = _line_source_of_test(archive, name)
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
        _line_source_of_test(archive, "other")


def test_a_slow_pull_gives_rest_stiffness_and_strain_over_tension(folder):
    (line,) = lines_of_source(str(folder / "Q01.nc"))
    assert line.quantities == ("quasi_static_spring_constant", "strain")
    with open_archive(folder / "Q01.nc") as archive:
        grid = archive["tension_grid"].to_numpy()
        expected = {
            name: archive[name].to_numpy()[0]
            for name in (
                "quasi_static_spring_constant", "quasi_static_strain",
                "quasi_static_spring_constant_standard_uncertainty",
            )
        }  # fmt: skip
    rest = look_up(line, "quasi_static_spring_constant", mean_tension=grid)
    assert rest.value == pytest.approx(expected["quasi_static_spring_constant"], rel=1e-9)
    half = 1.96 * expected["quasi_static_spring_constant_standard_uncertainty"]
    # 1.95996 times the standard uncertainty; one pull says nothing of another one
    assert rest.surface_high - rest.value == pytest.approx(half, rel=1e-4)
    assert np.isnan(rest.high).all()
    assert rest.surface_interval_of == "the curve of this one pull"
    strain = look_up(line, "strain", tension=grid)
    assert strain.value == pytest.approx(expected["quasi_static_strain"], rel=1e-9)
    assert strain.peak_tension == pytest.approx(grid)
    # K_0 is the slope of tension over strain, on straight lines between the nodes
    middle = (grid[1:] + grid[:-1]) / 2
    step = 0.1
    ends = [look_up(line, "strain", tension=middle + half).value for half in (-step, step)]
    slope = 2 * step / (ends[1] - ends[0])
    between = look_up(line, "quasi_static_spring_constant", mean_tension=middle).value
    assert between == pytest.approx(slope, rel=1e-3)
    with pytest.raises(DataError, match="outside the tested range of strain of line-1"):
        look_up(line, "strain", tension=1.01 * grid[-1])


def test_the_line_of_an_experiment_is_of_its_specimens(folder):
    line = lines_of_source(str(folder / "surfaces.nc"))[0]
    assert (line.kind, line.material) == ("rope", "nylon (synthetic)")
    assert (line.construction, line.condition) == ("double braid", "new, wet")
    assert line.diameter == pytest.approx(0.0127)
    assert line.rule.startswith("peak at most 60 %")


def test_nothing_is_said_of_what_specimens_differ_in(surfaces):
    (name,) = _line_source_of_experiment(surfaces, "nylon").specimens
    several = surfaces.copy(deep=True)
    several["run_specimen"][0, :3] = "other"
    known = {
        name: {"material": "nylon", "condition": "new", "diameter": 0.0127},
        "other": {"material": "nylon", "condition": "used", "diameter": 0.0130},
    }
    line = _line_source_of_experiment(several, "nylon", specimens=known)
    assert (line.material, line.condition, line.construction) == ("nylon", "", "")
    assert np.isnan(line.diameter)
    # of one specimen nothing is known
    alone = _line_source_of_experiment(several, "nylon", specimens={name: known[name]})
    assert alone.material == ""


@pytest.mark.nightly
def test_specimens_of_an_experiment_are_sought_in_the_archives_of_all_tests(
    folder, surfaces, tmp_path
):
    several = surfaces.copy(deep=True)
    several["run_specimen"][0, :3] = "other"
    several.to_netcdf(tmp_path / "surfaces.nc", engine="netcdf4")
    for place, (name, condition) in enumerate([("line-1", "new, wet"), ("other", "used")]):
        with open_archive(folder / "R01.nc") as archive:
            test = archive.load()
        test = test.assign_coords(specimen=[name])
        test["specimen_condition"] = ("specimen", [condition])
        test.to_netcdf(tmp_path / f"R0{place + 1}.nc", engine="netcdf4")
    (line,) = lines_of_source(str(tmp_path / "surfaces.nc"))
    assert line.material == "nylon (synthetic)"
    assert line.condition == ""


@pytest.mark.nightly
def test_surfaces_of_tethers_refuse_zero_tension(folder, tmp_path):
    """A synthetic campaign, whose specimen is called a tether."""
    rope = lines_of_source(str(folder / "surfaces.nc"))[0]
    shutil.copy(folder / "surfaces.nc", tmp_path)
    with open_archive(folder / "R01.nc") as archive:
        tests = archive.load()
    tests["specimen_kind"] = ("specimen", ["rubber tether"])
    tests.to_netcdf(tmp_path / "R01.nc", engine="netcdf4")
    tether = lines_of_source(str(tmp_path / "surfaces.nc"))[0]
    assert tether.is_tether
    lowest = 0.12 * rope.rated_break_strength
    at_zero = {"frequency": 0.3, "mean_tension": lowest, "tension_amplitude": lowest}
    found = look_up(rope, "apparent_spring_constant", **at_zero)
    assert found.minimum_tension == 0
    assert found.is_inside
    with pytest.raises(
        DataError, match="nylon goes slack at 1 of 1 points, which a tether must not"
    ):
        look_up(tether, "apparent_spring_constant", **at_zero)
    above = look_up(
        tether, "apparent_spring_constant", **(at_zero | {"tension_amplitude": 0.99 * lowest})
    )
    assert above.minimum_share == pytest.approx(0.0012)
    assert above.rule.startswith("a rubber tether must not go slack")


def test_what_has_no_surface_is_refused(surfaces):
    with pytest.raises(ArchiveError, match="no such experiment"):
        _line_source_of_experiment(surfaces, "polyester")
    shares = surfaces.copy()
    shares["factor_unit"] = (shares["factor_unit"].dims, np.array([["Hz", "1", "1"]]))
    strengths = shares["run_rated_break_strength"].to_numpy().copy()
    strengths[0, 0] *= 2
    shares["run_rated_break_strength"] = (shares["run_rated_break_strength"].dims, strengths)
    with pytest.raises(ArchiveError, match="levels of mean_tension .* are no N"):
        _line_source_of_experiment(shares, "nylon")


def test_surfaces_beside_a_pull_that_was_refused_are_looked_up_without_k_0(folder, tmp_path):
    shutil.copy(folder / "surfaces.nc", tmp_path)
    shutil.copy(folder / "R01.nc", tmp_path)
    with open_archive(folder / "Q01.nc") as archive:
        pull = archive.load().copy(deep=True)
    pull["pull_strain_coefficient"][0, 2] = np.nan
    pull.to_netcdf(tmp_path / "Q01.nc", engine="netcdf4")
    (line,) = lines_of_source(str(tmp_path / "surfaces.nc"))
    assert line.slow_pulls == {}
    at = {"frequency": 0.3, "mean_tension": 6000.0, "tension_amplitude": 2000.0}
    assert np.isfinite(look_up(line, "apparent_spring_constant", **at).value)
    with pytest.raises(ArchiveError, match=r"the slow pull Q01 of line-1 has no load-strain curve"):
        experiments_with_pulls(tmp_path / "surfaces.nc")


def test_an_archive_without_a_curve_or_a_level_is_refused_by_its_name(folder, tmp_path):
    with open_archive(folder / "R01.nc") as archive:
        levels = [name for name in archive.variables if str(name).startswith("test_")]
        bare = archive.load().drop_vars([*CURVES, *levels], errors="ignore")
    path = tmp_path / "bare.nc"
    bare.to_netcdf(path, engine="netcdf4")
    with pytest.raises(ArchiveError, match=r"nothing to look up; found .*bare\.nc"):
        lines_of_source(str(path))


def test_bins_without_a_cycle_between_others_are_no_part_of_the_range(folder):
    with open_archive(folder / "R01.nc") as archive:
        test = archive.load().copy(deep=True)
    name = str(test["specimen"].to_numpy()[0])
    at = test["strain_bin"].to_numpy()
    seen = np.flatnonzero(np.isfinite(test["tangent_modulus"].to_numpy()[0, 0]))
    test["tangent_modulus"][0, 0, seen[2:5]] = np.nan
    line = _line_source_of_test(test, name)
    with pytest.raises(DataError, match="nothing between"):
        look_up(line, "tangent_modulus", strain=at[seen[3]], branch="ascending")
    ends = at[seen[[1, 5]]]
    assert look_up(line, "tangent_modulus", strain=ends, branch="ascending").is_inside.all()
    flagged = look_up(
        line, "tangent_modulus", strain=at[seen[3]], branch="ascending", extrapolate="flag"
    )
    assert not flagged.is_inside
    assert "gaps between bins, where nothing was measured: 1" in flagged.notes


def test_the_interval_of_a_curve_is_students_over_its_cycles(folder):
    with open_archive(folder / "R01.nc") as archive:
        test = archive.load()
    line = _line_source_of_test(test, str(test["specimen"].to_numpy()[0]))
    place = np.flatnonzero(np.isfinite(test["tangent_modulus"].to_numpy()[0, 0]))[3]
    count = int(test["tangent_modulus_count"].to_numpy()[0, 0, place])
    spread = float(test["tangent_modulus_standard_uncertainty"].to_numpy()[0, 0, place])
    at = float(test["strain_bin"].to_numpy()[place])
    found = look_up(line, "tangent_modulus", strain=at, branch="ascending")
    random = test["tangent_modulus_random_standard_uncertainty"].to_numpy()[0, 0, place]
    # Welch and Satterthwaite: the load cell does not scatter
    half = stats.t.ppf(0.975, (count - 1) * (spread / random) ** 4) * spread
    assert found.surface_high - found.value == pytest.approx(half, rel=1e-9)
    assert np.isnan(found.high)
    assert found.surface_interval_of == "the mean over the cycles of this one test"

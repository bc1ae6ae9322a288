"""The synthetic nylon line, from its logs to the three-parameter line of each run."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rulesofcf import held_against_cf

from reduction.archive.open import in_memory, open_archive, reading
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.slow

RAW = Path(__file__).parents[2] / "raw" / "nylon-synthetic"
LBF = 4.4482216152605


@pytest.fixture(scope="module")
def run(nylon_campaign):
    return nylon_campaign


@pytest.fixture(scope="module")
def truth():
    table = pd.read_csv(RAW / "truth" / "runs.csv", comment="#").set_index("run")
    return table.rename(columns=lambda name: name.removesuffix("_lbf").removesuffix("_s"))


@pytest.fixture(scope="module")
def archives(run, truth):
    """The archive of each run, read once."""
    found = {}
    for name in truth.index:
        with reading(run.processed / f"{name}.nc") as archive:
            found[name] = in_memory(archive)
    return found


def of_test(archive, quantity):
    return float(archive[f"test_{quantity}"].to_numpy()[0])


def test_every_test_is_reduced(run):
    assert run.done.returncode == 0
    tests = run.said["tests"]
    assert len(tests) == 16
    assert {test["status"] for test in tests} <= {"reduced", "check"}
    assert {test["n_cycles"] for test in tests} == {13, 0}


@pytest.mark.parametrize(
    ("quantity", "tolerance"),
    [
        ("mean_tension", 5e-4),
        ("tension_amplitude", 2e-3),
        ("apparent_spring_constant", 5e-3),
        ("hysteresis_energy", 1e-2),
        ("quasi_static_spring_constant", 1e-3),
        ("dissipation_spring_constant", 2e-2),
        ("relaxation_time", 3e-2),
    ],
)
def test_runs_give_back_the_line_that_made_them(archives, truth, quantity, tolerance):
    unit = 1.0 if quantity == "relaxation_time" else LBF
    for name, row in truth.iterrows():
        expected = pytest.approx(row[quantity] * unit, rel=tolerance)
        assert of_test(archives[name], quantity) == expected, name


def own_uncertainty(archive, quantity):
    """Without the instruments: generated channels have no error of gain, zero or lag."""
    name = f"test_{quantity}"
    random = archive[f"{name}_random_standard_uncertainty"].to_numpy()[0]
    fit = np.flatnonzero(archive["uncertainty_source"].to_numpy() == "quasi_static_fit")
    shared = archive[f"{name}_uncertainty_contribution"].to_numpy()[fit, 0]
    return np.hypot(random, np.linalg.norm(shared))


def test_stated_uncertainties_cover_the_errors(archives, truth):
    # 60 errors over their standard uncertainties: extremes of a noisy log read high, which
    # is no scatter, so K_ap is left out
    names = ("hysteresis_energy", "relaxation_time", "quasi_static_spring_constant")
    units = (LBF, 1.0, LBF)
    ratios = [
        (of_test(archives[name], quantity) / (row[quantity] * unit) - 1)
        * of_test(archives[name], quantity)
        / own_uncertainty(archives[name], quantity)
        for name, row in truth.iterrows()
        for quantity, unit in zip(names, units, strict=True)
    ]
    assert 0.5 < np.sqrt(np.mean(np.square(ratios))) < 2.0


def test_the_slow_pull_gives_the_cubic_of_the_report(run):
    # CG-D-39-80 Table 8: strain = 1.389e-4 T - 3.906e-8 T^2 + 3.795e-12 T^3, T in lbf
    with open_archive(run.processed / "Q01.nc") as archive:
        found = archive["pull_strain_coefficient"].to_numpy()[0] * LBF ** np.arange(4)
        spread = archive["pull_strain_coefficient_standard_uncertainty"].to_numpy()[0]
        assert archive["pull_waiting_time"].to_numpy() == pytest.approx(86400.0)
        # 10 inches a minute on 72 in, of which the gauge takes 0.92
        assert archive["pull_strain_rate"].to_numpy() == pytest.approx(10 / 60 / 66.24, rel=0.01)
        shares = archive["break_share"].to_numpy()
        strain = archive["strain_at_break_share"].to_numpy()[0]
    assert found[1:] == pytest.approx([1.389e-4, -3.906e-8, 3.795e-12], rel=0.01)
    assert (spread > 0).all()
    load = shares[shares <= 0.35] * 6400
    expected = 1.389e-4 * load - 3.906e-8 * load**2 + 3.795e-12 * load**3
    assert strain[: load.size] == pytest.approx(expected, abs=2e-5)
    assert np.isnan(strain[shares > 0.36]).all()


def test_tables_hold_the_line_and_the_pull(run):
    tables = run.processed / "tables"
    line = pd.read_csv(tables / "line.csv")
    assert line["test_line_refusal"].tolist() == ["given"] * 15
    cycles = pd.read_csv(tables / "cycles.csv")
    assert cycles["dissipation_spring_constant [N]"].notna().all()
    assert (line["synthetic"] == "yes").all()
    assert pd.read_csv(tables / "slow_pull.csv")["tension_grid [N]"].is_monotonic_increasing


@pytest.mark.nightly
def test_the_compliance_checker_finds_nothing(run):
    products = [run.processed / "R01.nc", run.processed / "Q01.nc"]
    done = held_against_cf(*products)
    assert done.returncode == 0, done.stdout


@pytest.fixture(scope="module")
def surfaces(run):
    with open_archive(run.processed / "surfaces.nc") as archive:
        yield archive.load()


def test_the_experiment_is_fitted(run):
    (fitted,) = run.said["experiments"]
    assert (fitted["id"], fitted["exit_status"]) == ("nylon", 0)
    assert fitted["message"].startswith("nylon: 15 of 15 runs of a box-behnken design")


@pytest.mark.parametrize(
    ("response", "surface", "unit", "tolerance"),
    [
        ("apparent_spring_constant", "apparent_spring_constant", LBF, 5e-3),
        ("hysteresis_energy", "log_hysteresis_energy", LBF, 1e-2),
        ("dissipation_spring_constant", "dissipation_spring_constant", LBF, 2e-2),
        ("relaxation_time", "relaxation_time", 1.0, 3e-2),
    ],
)
def test_surfaces_give_back_the_line_at_the_centre_and_the_edges(
    surfaces, truth, response, surface, unit, tolerance
):
    # the quadratic by hand, in the printed order, at the planned levels
    x, y, z = (truth[f"x_{name}"] for name in ("frequency", "mean_tension", "tension_amplitude"))
    terms = [1 + 0 * x, x * x, y * y, z * z, x, y, z, x * y, x * z, y * z]
    coefficient = surfaces[f"{surface}_coefficient"].to_numpy()[0]
    value = sum(b * term for b, term in zip(coefficient, terms, strict=True))
    value = np.exp(value) if surface.startswith("log_") else value
    expected = truth[response] * unit
    assert len(set(zip(x, y, z, strict=True))) == 13
    assert value.to_numpy() == pytest.approx(expected.to_numpy(), rel=tolerance)


@pytest.mark.nightly
def test_own_surfaces_stand_beside_the_k_1_and_tau_of_their_k_ap_and_h(run, truth, command):
    levels = ("--frequency", "0.3 Hz", "--mean-tension", "21 %RBS", "--tension-amplitude")
    ask = ("lookup", run.processed, "--line", "nylon", "--quantity", "K_1", *levels, "8.5 %RBS")
    found = json.loads(command(*ask, "--json").stdout)
    # R05 goes to zero tension in each cycle, as the README of the campaign says
    (warning,) = found["warnings"]
    assert "R05: the spring-dashpot model does not apply to 13 of 13 loops" in warning
    (one,) = found["consistent"]
    centre = truth.loc[(truth.filter(like="x_") == 0).all(axis=1)].iloc[0]
    for name, unit in (("dissipation_spring_constant", LBF), ("relaxation_time", 1.0)):
        assert one[name] == pytest.approx(centre[name] * unit, rel=0.03)
        assert one["of_surfaces"][name] == pytest.approx(centre[name] * unit, rel=0.03)
        assert one["apart"][name] is False
    shown = " ".join(command(*ask).stdout.split())
    assert "K_1 and tau of their own surfaces, and solved from K_ap, H and K_0" in shown
    assert one["slow_pull"] in shown


def test_engineering_coefficients_are_the_same_surface(surfaces):
    coded = surfaces["apparent_spring_constant_coefficient"].to_numpy()[0]
    engineering = surfaces["apparent_spring_constant_coefficient_engineering"].to_numpy()[0]
    # half way from the centre to (+, -, +) on each factor
    point = np.array([0.5, -0.5, 0.5])
    low, high = (surfaces[f"factor_{end}"].to_numpy()[0] for end in ("low", "high"))
    level = (low + high) / 2 + point * (high - low) / 2

    def quadratic(b, v):
        squares, pairs = v**2, np.array([v[0] * v[1], v[0] * v[2], v[1] * v[2]])
        return b[0] + b[1:4] @ squares + b[4:7] @ v + b[7:] @ pairs

    assert quadratic(engineering, level) == pytest.approx(quadratic(coded, point), rel=1e-9)


def test_levels_are_those_reached(surfaces, truth):
    reached = surfaces["run_level"].to_numpy()[0]
    planned = truth[["frequency_hz", "mean_tension", "tension_amplitude"]].to_numpy()
    assert reached == pytest.approx(planned * [1, LBF, LBF], rel=2e-3)
    assert not np.array_equal(reached, planned * [1, LBF, LBF])


@pytest.mark.nightly
def test_a_failed_run_leaves_fourteen_and_says_so(run, tmp_path):
    folder = tmp_path / "raw"
    shutil.copytree(RAW, folder)
    (folder / "R04.csv").write_text("time_s,stroke_in,load_lbf,extensometer_pct\n")
    shutil.copytree(run.processed, tmp_path / "p" / "nylon-synthetic")
    again = run_campaign(
        load_campaign(folder / "campaign.toml"), processed=tmp_path / "p",
        reports=tmp_path / "r", clock=lambda: 0.0,
    )  # fmt: skip
    assert again.exit_status == 3
    assert again.parts["experiments"][0].message.startswith("nylon: 14 of 15 runs")
    with open_archive(again.processed / "surfaces.nc") as archive:
        assert "R04: its test failed" in archive["note"].to_numpy().tolist()
    assert (again.processed / "R04.nc").exists()


def test_without_a_slow_pull_k_1_and_tau_are_refused_and_the_rest_stands(tmp_path):
    # three runs and no pull: a design that carries no surface
    whole = load_campaign(RAW / "campaign.toml")
    kept = ("R01", "R02", "R03")
    plan = whole.experiments["nylon"]
    bare = replace(plan, quasi_static={}, runs={name: plan.runs[name] for name in kept})
    tests = {name: whole.tests[name] for name in kept}
    few = replace(whole, tests=tests, experiments={"nylon": bare})
    again = run_campaign(few, processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0)
    with open_archive(again.processed / "R01.nc") as archive:
        assert archive["test_line_refusal"].to_numpy().tolist() == [1]
        notes = archive["note"].to_numpy().tolist()
        assert np.isfinite(archive["test_apparent_spring_constant"].to_numpy()).all()
    assert any("no slow pull" in note for note in notes)
    assert again.exit_status == 5
    assert "response surfaces not given" in again.parts["experiments"][0].message


def test_an_experiment_none_of_whose_runs_gave_a_product_has_nothing_to_fit(tmp_path):
    folder = tmp_path / "raw"
    shutil.copytree(RAW, folder)
    whole = load_campaign(folder / "campaign.toml")
    kept = ("R01", "R02")
    for name in kept:
        (folder / f"{name}.csv").write_text("time_s,stroke_in,load_lbf,extensometer_pct\n")
    plan = whole.experiments["nylon"]
    bare = replace(plan, quasi_static={}, runs={name: plan.runs[name] for name in kept})
    few = replace(
        whole, tests={name: whole.tests[name] for name in kept}, experiments={"nylon": bare}
    )
    found = run_campaign(few, processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0)
    (one,) = found.parts["experiments"]
    assert (one.status, one.exit_status) == ("failed", 5)
    assert one.message.startswith("there is nothing to fit; found no archive of any of its 2 runs")
    assert not (found.processed / "surfaces.nc").exists()


def test_an_experiment_waits_for_runs_that_were_not_asked_for(tmp_path):
    campaign = load_campaign(RAW / "campaign.toml")
    part = run_campaign(
        campaign, processed=tmp_path / "p", reports=tmp_path / "r", clock=lambda: 0.0,
        tests=["R01", "Q01"],
    )  # fmt: skip
    assert part.exit_status == 0
    assert part.parts["experiments"][0].message == (
        "not fitted: 14 of its runs not reduced yet from logs and settings as they stand now (R02,"
        " R03, R04, R05, ..)"
    )
    assert not (part.processed / "surfaces.nc").exists()


@pytest.mark.parametrize("source", ["tension_gain", "tension_offset"])
def test_a_load_cell_of_runs_and_pull_scales_the_line_and_leaves_its_time(run, source):
    # both logs a quarter of a per cent high: the cubic, the mean tension at which it is read and
    # the loops scale together; both shifted: the same tangent of the same curve
    expected = 0.0025 if source == "tension_gain" else 0.0
    with open_archive(run.processed / "R11.nc") as archive:
        (row,) = np.flatnonzero(archive["uncertainty_source"].to_numpy() == source)
        for name, wanted in (
            ("quasi_static_spring_constant", expected),
            ("dissipation_spring_constant", expected),
            ("relaxation_time", 0.0),
        ):
            value = float(archive[f"test_{name}"].to_numpy()[0])
            found = archive[f"test_{name}_uncertainty_contribution"].to_numpy()[row, 0]
            assert found / value == pytest.approx(wanted, abs=1e-5), name


def test_a_run_has_one_uncertainty_in_its_archive_and_in_the_table_of_runs(archives, run):
    table = pd.read_csv(run.processed / "tables" / "run_responses.csv")
    drawn = 0
    of_runs = ~table["response"].str.startswith("log_")
    for row in table[of_runs].to_dict("records"):
        archive = archives[row["run_name"]]
        stated = archive[f"test_{row['response']}_standard_uncertainty"].to_numpy()[0]
        # nine digits are written
        assert row["response_measured_standard_uncertainty [unit]"] == pytest.approx(stated), row
        drawn += archive["test_line_uncertainty_method"].to_numpy()[0] == 2
    # of some runs K_1 and tau are not linear in their errors, and the interval is drawn
    assert drawn > 0

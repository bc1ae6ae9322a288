"""Experiments of a campaign: what may be written, and what is refused in which words."""

from pathlib import Path

import numpy as np
import pytest

from reduction.campaign.experiment_plans import (
    _parse_factor,
    _read_cells,
    _response_unit,
    agree_on_pulls,
    load_spec,
    plan_experiment,
    read_runs,
)
from reduction.campaign.load import load_campaign
from reduction.campaign.model import ExperimentSection
from reduction.campaign.plan import StepPlan, TestPlan
from reduction.record.errors import DataError, LogError, SettingsError
from reduction.record.measurement import Specimen
from reduction.record.settings import ReductionSettings

CAMPAIGN = Path(__file__).parents[2] / "raw" / "nylon-synthetic" / "campaign.toml"
LOADS = {"mean_tension": ("12 %RBS", "30 %RBS"), "tension_amplitude": ("5 %RBS", "12 %RBS")}


def plan_of(name, kind="cyclic", specimens=("line",), steps=()):
    return TestPlan(
        id=name, kind=kind, files=(), specimens=specimens, order=None, control="load",
        waveform="sinusoidal", target_strain=(), attributes={}, settings=ReductionSettings(),
        steps=steps,
    )  # fmt: skip


STEPS = (
    StepPlan("dynamic 1", "cyclic", (0.0, 1.0), None, None),
    StepPlan("pull", "quasi-static", (1.0, 2.0), None, None),
)
TESTS = {
    "R1": plan_of("R1"),
    "R2": plan_of("R2"),
    "Q": plan_of("Q", "quasi-static"),
    "P-7": plan_of("P-7", steps=STEPS),
    "H": plan_of("H", "relaxation"),
}
SPECIMENS = {
    "line": Specimen("line", kind="rope", rated_break_strength=1000.0),
    "bare": Specimen("bare", kind="rope"),
}


def plan(**changed):
    section = {
        "kind": "box-behnken",
        "factors": LOADS,
        "runs": {"R1": (-1, 0), "P-7/dynamic 1": (0, 1)},
    }
    return plan_experiment(
        Path("campaign.toml"), "nylon", ExperimentSection(**(section | changed)),
        tests=TESTS, specimens=SPECIMENS,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("name", "levels", "low", "high", "basis"),
    [
        ("frequency", ("0.1 Hz", "0.5 Hz"), 0.1, 0.5, "absolute"),
        ("mean_tension", ("100 lbf", "1 kN"), 444.822, 1000.0, "absolute"),
        ("mean_tension", ("12 %MBL", "30%RBS"), 0.12, 0.30, "rated_break_strength"),
        ("tension_amplitude", ("20 % of mean", "45 %of mean"), 0.20, 0.45, "mean_tension"),
        ("moisture", ("1", "2.5"), 1.0, 2.5, "absolute"),
    ],
)
def test_levels_are_read_with_their_units(name, levels, low, high, basis):
    found = _parse_factor(name, levels)
    assert (found.low, found.high) == pytest.approx((low, high), rel=1e-6)
    assert (found.name, found.basis) == (name, basis)


@pytest.mark.parametrize(
    ("name", "levels", "message"),
    [
        ("frequency", ("0.1", "0.5"), "a value has no unit"),
        ("mean_tension", ("0.1 m", "0.5 m"), "'m' is not a unit of force"),
        ("mean_tension", ("12 %RBS", "500 N"), "given in different forms; found 12 %RBS and 500 N"),
        ("mean_tension", ("30 %RBS", "12 %RBS"), "levels of mean_tension do not rise"),
    ],
)
def test_levels_that_cannot_be_are_refused(name, levels, message):
    with pytest.raises(SettingsError, match=message):
        _parse_factor(name, levels)


def test_runs_and_pulls_are_named_as_their_products_are():
    found = plan(quasi_static={"line": "P-7/pull"}, transform={"relaxation_time": "log"})
    assert found.runs == {"R1": (-1.0, 0.0), "P-7.dynamic-1": (0.0, 1.0)}
    assert found.quasi_static == {"line": "P-7.pull"}
    assert found.transform == {"relaxation_time": "log"}


def test_the_responses_are_those_of_the_report_where_none_is_said():
    assert plan().responses == (
        "apparent_spring_constant", "hysteresis_energy", "dissipation_spring_constant",
        "relaxation_time",
    )  # fmt: skip


def test_dummy_columns_are_for_screening_alone():
    runs = {"R1": (-1, 0, 1), "R2": (1, 1, -1)}
    assert plan(kind="plackett-burman", runs=runs).runs["R1"] == (-1.0, 0.0, 1.0)
    with pytest.raises(
        SettingsError, match="run 'R1' has 3 coded levels; needed 2, one per factor"
    ):
        plan(runs=runs)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"runs": {"R9": (0, 0)}}, "a run is not a test of the campaign; found R9; needed"),
        ({"runs": {"P-7": (0, 0)}}, "a run is not a test of the campaign; found P-7"),
        ({"runs": {"P-7/x": (0, 0)}}, "a run is not a test of the campaign; found P-7/x"),
        ({"runs": {"H": (0, 0)}}, "run 'H' has no cycles; found relaxation"),
        ({"runs": {"R1": (0,)}}, "run 'R1' has 1 coded levels; needed 2"),
        (
            {"kind": "plackett-burman", "runs": {"R1": (0, 0), "R2": (1, 1, 1)}},
            "the runs differ in the number",
        ),
        ({"quasi_static": {"line": "Q9"}}, "slow pull of 'line' is not a test of the campaign"),
        ({"quasi_static": {"line": "R1"}}, "'R1' is not a slow pull; found cyclic"),
        ({"quasi_static": {"other": "Q"}}, "the slow pull 'Q' does not pull 'other'"),
        (
            {"runs": {"R1": (0, -7)}},
            "run 'R1' is planned outside the levels.*; found coded -7; needed",
        ),
        (
            {"responses": ("hysteresis_energy", "loss_factor", "hysteresis_energy")},
            "a response is listed twice; found hysteresis_energy, loss_factor, hysteresis_energy",
        ),
        (
            {"responses": ("loss_factor",), "transform": {"relaxation_time": "log"}},
            "a transform is stated for a response that is not requested; found relaxation_time; needed",
        ),
        ({"factors": {"frequency": ("1 Hz", "x")}}, "experiment 'nylon': a value is not a number"),
    ],
)
def test_what_does_not_fit_the_campaign_is_refused(changed, message):
    with pytest.raises(SettingsError, match=message):
        plan(**changed)


def test_a_share_of_a_break_strength_that_is_not_stated_is_refused():
    tests = TESTS | {"R1": plan_of("R1", specimens=("line", "bare"))}
    section = ExperimentSection(kind="box-behnken", factors=LOADS, runs={"R1": (0, 0)})
    with pytest.raises(SettingsError, match="found no rated_break_strength of bare; needed"):
        plan_experiment(Path("campaign.toml"), "nylon", section, tests=tests, specimens=SPECIMENS)


def test_the_campaign_of_the_synthetic_line_is_the_design_that_it_says():
    found = load_campaign(CAMPAIGN).experiments["nylon"]
    edges = {run for run in found.runs.values() if any(run)}
    assert len(found.runs) == 15
    assert len(edges) == 12
    assert all(sorted(map(abs, run)) == [0, 1, 1] for run in edges)


def agree(first, second):
    tests = TESTS | {"Q2": plan_of("Q2", "quasi-static")}
    both = {
        name: plan_experiment(
            Path("campaign.toml"), name,
            ExperimentSection(**({"kind": "box-behnken", "factors": LOADS} | section)),
            tests=tests, specimens=SPECIMENS,
        )
        for name, section in (("one", first), ("two", second))
    }  # fmt: skip
    agree_on_pulls(Path("campaign.toml"), both, tests)


def test_a_run_of_two_experiments_has_one_slow_pull():
    of_q = {"runs": {"R1": (0, 0), "R2": (1, 0)}, "quasi_static": {"line": "Q"}}
    of_q2 = {"runs": {"R1": (0, 0), "P-7/dynamic 1": (1, 0)}, "quasi_static": {"line": "Q2"}}
    with pytest.raises(SettingsError, match="run 'R1' is in two.*; found Q in 'one', Q2 in 'two'"):
        agree(of_q, of_q2)
    with pytest.raises(SettingsError, match="found Q in 'one', none in 'two'; needed the same"):
        agree(of_q, of_q2 | {"quasi_static": {}})
    agree(of_q, of_q2 | {"quasi_static": {"line": "Q"}})
    # a pull for each experiment, where they share no run
    agree(of_q, of_q2 | {"runs": {"P-7/dynamic 1": (0, 0)}})


def test_an_experiment_that_needs_no_pull_shares_runs_with_one_that_does():
    of_q = {"runs": {"R1": (0, 0)}, "quasi_static": {"line": "Q"}}
    agree({"runs": {"R1": (0, 0)}, "responses": ("hysteresis_energy",)}, of_q)


# SPEC.toml of an experiment: levels and limits in SI, or as shares; refusals are CLI tests

LBF = 4.4482216152605


@pytest.fixture
def load(tmp_path):
    def load_text(text):
        (tmp_path / "SPEC.toml").write_text(text)
        return load_spec(tmp_path / "SPEC.toml")

    return load_text


def test_an_empty_spec_declares_nothing(load):
    spec = load("")
    assert spec.keys.kind is None and spec.factors == () and spec.responses == ()
    assert (
        spec.keys.levels == "engineering"
        and spec.keys.sigma == (None, "1")
        and spec.keys.repeats == "together"
    )


def test_any_factor_has_the_dimension_of_its_unit(load):
    spec = load('[factors]\nT = ["5 degC", "25 degC"]\nx = [1, 2]\ndepth = ["1 ft", "2 ft"]\n')
    axes = [factor.axis(None) for factor in spec.factors]
    assert [unit for unit, _, _ in axes] == ["K", "1", "m"]
    assert axes[0][1:] == pytest.approx((278.15, 298.15))
    assert axes[2][1:] == pytest.approx((0.3048, 0.6096))


def test_a_share_becomes_a_force_where_the_strength_is_known(load):
    spec = load('[factors]\nmean_tension = ["12 %RBS", "30 %RBS"]\n')
    assert spec.factors[0].axis(None) == ("1", 0.12, 0.3)
    assert spec.factors[0].axis(1000.0) == ("N", 120.0, 300.0)


@pytest.mark.parametrize(
    ("written", "limits"),
    [("40 %RBS", (None, 0.4)), ("100 lbf", (100 * LBF, None)), ("2 kN", (2000.0, None))],
)
def test_a_load_limit_is_a_force_or_a_share(load, written, limits):
    spec = load(f'[experiment]\nload_limit = "{written}"\n')
    assert spec.keys.load_limit == pytest.approx(limits)


@pytest.mark.parametrize(
    ("written", "sigma"),
    [
        ("2 %", (0.02, "1")),
        ("0.02", (0.02, "1")),
        ("5 lbf", (5 * LBF, "N")),
        ("3 J/m", (3.0, "J m-1")),
    ],
)
def test_sigma_is_a_share_or_in_a_unit(load, written, sigma):
    spec = load(f'[experiment]\nsigma = "{written}"\n')
    assert spec.keys.sigma == (pytest.approx(sigma[0]), sigma[1])


def test_units_of_quantities_are_spelt_as_in_products():
    assert _response_unit("hysteresis_energy", "lbf") == ("J m-1", pytest.approx(LBF), 0.0)
    assert _response_unit("loop energy", "lbf ft / ft") == ("J m-1", pytest.approx(LBF), 0.0)
    assert _response_unit("stiffness", "kN") == ("N", pytest.approx(1000), 0.0)
    assert _response_unit("life", "") == ("", 1.0, 0.0)
    with pytest.raises(SettingsError, match="unit 'lbf' is not a unit of relaxation_time"):
        _response_unit("relaxation_time", "lbf")


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('[factors]\nx = ["1 m", "2 ft"]', "factors.x: the two levels of x are given in different"),
        ('[factors]\nmean_tension = ["12 %RBS", "30 % of mean"]', "factors.mean_tension: the two"),
        ('[factors]\nx = ["one", "two"]', "factors.x: a value is not a number; found 'one'"),
        ('[factors]\n"x*y" = [1, 2]', "factors"),
        ("[responses]\ny = { unit = 3 }", "responses.y.unit"),
        ('[experiment]\nkind = "latin-square"', "experiment.kind"),
        ("[experiment]\nn_centre = -1", "experiment.n_centre"),
        ('[experiment]\nload_limit = "10 s"', "experiment.load_limit: unit 's' is not"),
        ("[experiments]\n", "experiments"),
    ],
)
def test_a_value_that_cannot_be_used_is_told_by_its_key(load, text, place):
    with pytest.raises(SettingsError) as refused:
        load(text)
    assert "SPEC.toml: " in str(refused.value) and place in str(refused.value)


# tables of runs: levels on the scale of the plan, responses in SI, blocks, and refusals

FACTORS = """
[factors]
frequency = ["0.1 Hz", "0.5 Hz"]
mean_tension = ["12 %RBS", "30 %RBS"]
tension_amplitude = ["20 % of mean", "60 % of mean"]
[responses]
hysteresis_energy = { unit = "lbf" }
"""
STRENGTH = '[experiment]\nrated_break_strength = "1000 lbf"\n'


@pytest.fixture
def read(tmp_path):
    def read_text(table, spec=None):
        (tmp_path / "runs.csv").write_text(table)
        if spec is not None:
            (tmp_path / "SPEC.toml").write_text(spec)
            spec = load_spec(tmp_path / "SPEC.toml")
        return read_runs(tmp_path / "runs.csv", spec)

    return read_text


def rows(header, *lines):
    return "\n".join([header, *lines]) + "\n"


def test_without_a_spec_the_last_column_is_the_response_and_the_others_are_coded(read):
    runs = read(rows("run,x1,frequency,block,y", "a,-1,1,one,5", "b,1,-1,one,6"))
    assert runs.factor_names == ("x1", "frequency") and runs.response_names == ("y",)
    assert runs.factor_units == ("1", "1") and runs.response_units == ("",)
    assert runs.run_names == ("a", "b") and runs.blocks is None and runs.notes == ()
    np.testing.assert_array_equal(runs.coded, [[-1, 1], [1, -1]])
    np.testing.assert_array_equal(runs.low, [-1, -1])


@pytest.mark.parametrize(
    "header", ["mean_tension [lbf],tension_amplitude [lbf]", "mean_tension [lbf],tension_amplitude"]
)
def test_an_amplitude_is_a_share_of_the_mean_of_its_run(read, header):
    amplitude = ("60", "84") if header.endswith("]") else ("50", "40")
    runs = read(
        rows(
            f"frequency [Hz],{header},hysteresis_energy",
            f"0.1,120,{amplitude[0]},2",
            f"0.5,210,{amplitude[1]},4",
        ),
        STRENGTH + FACTORS,
    )
    np.testing.assert_allclose(runs.coded, [[-1, -1, 0.5], [1, 0, 0]], atol=1e-12)
    assert runs.factor_units == ("Hz", "N", "1")
    np.testing.assert_allclose(runs.low, [0.1, 120 * LBF, 0.2])
    assert runs.response_units == ("J m-1",)
    np.testing.assert_allclose(runs.responses, [[2 * LBF, 4 * LBF]])


def test_without_a_break_strength_shares_stay_shares(read):
    header = "frequency,mean_tension,tension_amplitude,hysteresis_energy [N]"
    runs = read(rows(header, "0.1,12,20,3", "0.5,30,60,4"), FACTORS)
    assert runs.factor_units == ("Hz", "1", "1")
    np.testing.assert_allclose(runs.coded, [[-1, -1, -1], [1, 1, 1]])
    np.testing.assert_allclose(runs.responses, [[3, 4]])
    told = rows("frequency,mean_tension [N],tension_amplitude,hysteresis_energy", "0.1,12,20,3")
    with pytest.raises(SettingsError, match="does not fit mean_tension") as refused:
        read(told, FACTORS)
    assert "rated_break_strength" in str(refused.value)


def test_temperatures_have_an_offset(read):
    spec = '[factors]\nT = ["5 degC", "25 degC"]\n[responses]\ny = {}\n'
    runs = read(rows("T [K],y", "278.15,1", "298.15,2"), spec)
    np.testing.assert_allclose(runs.coded, [[-1], [1]])
    np.testing.assert_allclose(read(rows("T,y", "15,1"), spec).coded, [[0]], atol=1e-12)


def test_specimens_make_blocks_and_the_column_block_goes_before_them(read):
    lines = ("-1,1,R1,a,u", "0,2,R2,a,v", "1,3,R1,b,u", "0,4,R2,b,v")
    spec = "[responses]\ny = {}\n"
    runs = read(rows("x,y,run,specimen,note", *lines), spec + "[factors]\nx = [-1, 1]\n")
    assert runs.blocks == ("a", "a", "b", "b")
    assert runs.run_names == ("R1 a", "R2 a", "R1 b", "R2 b")
    assert runs.notes == ("columns that are not used: note",)
    runs = read(rows("x,y,run,specimen,block", *lines), spec)
    assert runs.blocks == ("u", "v", "u", "v")
    assert runs.notes[0].startswith("blocks are those of the column block")


def test_dummies_are_kept_apart(read):
    runs = read(rows("A,dummy_1,dummy_2,y", "-1,1,-1,3", "1,-1,1,4"))
    assert runs.factor_names == ("A",)
    np.testing.assert_array_equal(runs.dummy, [[1, -1], [-1, 1]])


@pytest.mark.parametrize(
    ("table", "error", "problem"),
    [
        (rows("x,y,block", "1,2,a"), LogError, "the last column is not a response"),
        (rows("y", "2"), LogError, "the table has no factor"),
        (rows("x [Hz],y", "0.1,2"), SettingsError, "the levels for -1 and .1 are not stated"),
        (rows("x,y [furlongs_x]", "1,2"), SettingsError, r"runs.csv:1 \[y \[furlongs_x\]\]: unit"),
        (rows("x,block,y", "1,a,2", "0,,2", "0,b,2"), LogError, "a run has no block"),
        (rows("x,run,y", "1,a,2", "0,,2"), LogError, "a run has no name"),
        (rows("x,run,y", "1,a,2", "0,a,2"), DataError, r":3 \[run\]: a run is listed twice"),
        (
            rows("x,run_order,y", "1,4,2", "0,4,2"),
            DataError,
            r":3 \[run_order\]: a run is listed twice",
        ),
        (rows("x,y", "1,2", ",2"), DataError, r":3 \[x\]: a run has a value but no level"),
        (rows("x,y", "5,2", "6,2"), DataError, r"\[x\]: the levels of x are far off the plan"),
    ],
)
def test_what_cannot_be_used_is_refused_with_its_place(read, table, error, problem):
    with pytest.raises(error, match=problem):
        read(table)


def test_a_share_that_the_plan_does_not_have_is_refused(read):
    table = rows(
        "frequency,mean_tension [% of mean],tension_amplitude,hysteresis_energy", "0.1,12,20,3"
    )
    with pytest.raises(SettingsError, match="mean_tension is no such share in the plan"):
        read(table, STRENGTH + FACTORS)


def test_a_run_of_two_specimens_may_share_its_place_in_the_order(read):
    runs = read(rows("x,run_order,specimen,y", "1,1,a,2", "0,2,a,3", "1,1,b,2", "0,2,b,3"))
    np.testing.assert_array_equal(runs.run_order, [1, 2, 1, 2])


# cells of a table that a person wrote: what is read, and what is refused with its place


@pytest.fixture
def read_of_cells(tmp_path):
    def read_text(text):
        path = tmp_path / "runs.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return _read_cells(path)

    return read_text


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_names_units_rows_and_numbers_with_any_delimiter(read_of_cells, delimiter):
    text = "\ufeff# of the laboratory\n\nx [Hz],y\n0.1,1e3\n# again\n,\n-.5,\n".replace(
        ",", delimiter
    )
    sheet = read_of_cells(text)
    assert [(column.name, column.unit) for column in sheet.columns] == [("x", "Hz"), ("y", "")]
    assert sheet.first == 3 and sheet.row == (4, 7)
    np.testing.assert_array_equal(sheet.numbers(sheet.columns[0]), [0.1, -0.5])
    np.testing.assert_array_equal(sheet.numbers(sheet.columns[1]), [1e3, np.nan])


def test_a_reached_level_goes_before_a_coded_one(read_of_cells):
    sheet = read_of_cells("x [coded],x [Hz]\n1,0.5\n")
    assert sheet.one("x", "factor").unit == "Hz"
    assert read_of_cells("x [coded]\n1\n").one("x", "factor").unit == "coded"


@pytest.mark.parametrize(
    ("text", "place", "problem"),
    [
        (b"x,y\n\xb5,1\n", "runs.csv", "the table of runs is not UTF-8 text"),
        ("\n# nothing\n", "runs.csv", "the table of runs is empty"),
        ("x,x\n1,2\n", "runs.csv:1", "the header of the runs cannot be used"),
        ("x,,y\n1,2,3\n", "runs.csv:1", "the header of the runs cannot be used"),
        ("1,2\n3,4\n", "runs.csv:1", "the table of runs has no header"),
        ("x,y\n1\n", "runs.csv:2", "the number of cells in a row differs from the header"),
        ("x,y\n", "runs.csv", "the table of runs has no rows"),
    ],
)
def test_a_table_that_cannot_be_read_is_refused(read_of_cells, text, place, problem):
    with pytest.raises(LogError, match=problem) as refused:
        read_of_cells(text)
    assert refused.value.where().endswith(place)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(LogError, match="the table of runs cannot be read"):
        _read_cells(tmp_path / "no.csv")


def test_open_values_are_named_together(read_of_cells):
    with pytest.raises(SettingsError, match=r"2 values are still '\?'") as refused:
        read_of_cells("x,y\n?,1\n1, ? \n")
    assert "runs.csv:2 [x]" in str(refused.value) and "runs.csv:3 [y]" in str(refused.value)


@pytest.mark.parametrize("cell", ["1,5", "0x10", "1 lbf", "inf", "--1", "1_000"])
def test_what_is_no_number_is_refused_with_row_and_column(read_of_cells, cell):
    sheet = read_of_cells(f'x;y\n1;2\n1;"{cell}"\n')
    with pytest.raises(LogError, match="a value is not a number") as refused:
        sheet.numbers(sheet.columns[1])
    assert refused.value.where().endswith("runs.csv:3 [y]")


def test_a_column_that_is_missing_or_there_twice_is_refused(read_of_cells):
    sheet = read_of_cells("x [Hz],x [1/s],frequenzy\n1,2,3\n")
    with pytest.raises(LogError, match="two columns contain x"):
        sheet.one("x", "factor")
    with pytest.raises(LogError, match="factor 'frequency' has no column") as refused:
        sheet.one("frequency", "factor")
    assert "is it frequenzy?" in str(refused.value)

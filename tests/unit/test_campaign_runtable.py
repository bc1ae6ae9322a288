"""Tables of runs: levels on the scale of the plan, responses in SI, blocks, and refusals."""

import numpy as np
import pytest

from reduction.campaign.experiment_plans import load_spec, read_runs
from reduction.record.errors import DataError, LogError, SettingsError

LBF = 4.4482216152605
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

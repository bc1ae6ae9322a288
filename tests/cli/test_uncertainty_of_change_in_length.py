"""Each property moves as its contributions say when the logs of the programme are made wrong."""

import json
import re

import numpy as np
import programme as made
import pytest
from typer.testing import CliRunner

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign
from reduction.cli.main import app

pytestmark = pytest.mark.slow

GAUGE = 10.0
GAIN, ZERO, POSITION_GAIN, POSITION_ZERO, STRENGTH = 0.01, 200.0, 0.005, 0.01, 0.05
STIFFER = 0.005
STATED = f"""
[uncertainty]
rated_break_strength = "{100 * STRENGTH:g} %"
[uncertainty.tension]
gain = "{100 * GAIN:g} %"
offset = "{ZERO:g} N"
[uncertainty.crosshead_position]
gain = "{100 * POSITION_GAIN:g} %"
offset = "{POSITION_ZERO:g} m"
[uncertainty.temperature]
value = "2 K"
stiffness_per_kelvin = "{50 * STIFFER:g} %"
"""
CAMPAIGN = f"""
[campaign]
id = "rope-programme"
title = "A rope programme in one log"
source = "synthetic, from known stiffness and creep"
synthetic = true
[specimens.R-1]
kind = "rope"
rated_break_strength = "100 kN"
gauge_length = "{GAUGE:g} m"
[layouts.logger]
format = "delimited"
delimiter = ","
[layouts.logger.channels]
time = {{ column = "t_s", unit = "s" }}
crosshead_position = {{ column = "x_m", unit = "m", datum = "displacement" }}
tension.1 = {{ column = "F_N", unit = "N" }}
[defaults]
layout = "logger"
control = "load"
strain = {{ method = "gauge-length" }}
"""
MEAN_STRAIN = 0.04
NAMES = ("property_stiffness", "property_stiffness_over_strength", "property_strain")


def programme():
    """Bedding-in from slack without a halt on the first rise, a pair of holds, one level."""
    log = made.Log()
    log.go(30, lambda since: 0.0, lambda since: 0.0)
    begin = log.now
    valley, peak = 0.05 * made.STRENGTH, 0.30 * made.STRENGTH
    # straight to the mean tension, and to the valley from there
    mean = (valley + peak) / 2
    log.ramp(60, mean, MEAN_STRAIN)
    log.go(20, lambda since: mean, lambda since: MEAN_STRAIN)
    log.ramp(10, valley, 0.01 + made.bedding_foot(1))
    for number in range(1, made.N_BEDDING + 1):
        log.cycle(
            valley, peak, made.bedding_stiffness(number), 0.01 + made.bedding_foot(number + 1)
        )
    log.step("bedding-in", begin)
    begin = log.now
    low, high = 0.10 * made.STRENGTH, 0.30 * made.STRENGTH
    log.ramp(20, low, 0.04)
    log.go(600, lambda since: low, lambda since: 0.04)
    log.ramp(20, high, 0.04 + (high - low) / made.static_stiffness(10.0))
    log.go(
        3600,
        lambda since: high,
        lambda since: 0.04 + (high - low) / made.static_stiffness(since + 10),
    )
    log.step("quasi-static", begin)
    begin = log.now
    valley, peak = 0.05 * made.STRENGTH, 0.15 * made.STRENGTH
    log.ramp(20, valley, 0.03)
    for number in range(1, made.N_LEVEL + 1):
        log.cycle(valley, peak, made.level_stiffness(0, number), 0.03)
    log.go(10, lambda since: valley, lambda since: 0.03)
    log.step("dynamic 1", begin)
    return log


def reduced(
    folder, *, gain=0.0, zero=0.0, position_gain=0.0, position_zero=0.0, stiffer=0.0, stated=STATED
):
    """The archive of properties of logs that are wrong by so much, or of a stiffer rope."""
    folder.mkdir()
    log = programme()
    noise = np.random.default_rng(3)
    time, tension, strain = (np.concatenate(one) for one in (log.time, log.tension, log.strain))
    # the machine keeps the tension: what is stiffer stretches less
    position = GAUGE * strain / (1 + stiffer) + noise.normal(0, 2e-5, time.size)
    force = tension + noise.normal(0, made.NOISE, time.size)
    columns = [
        time, position * (1 + position_gain) + position_zero, force * (1 + gain) + zero,
    ]  # fmt: skip
    np.savetxt(
        folder / "P-7.csv", np.column_stack(columns), delimiter=",", header="t_s,x_m,F_N",
        comments="", fmt=["%.2f", "%.9f", "%.6f"],
    )  # fmt: skip
    path = folder / "campaign.toml"
    path.write_text("\n".join([CAMPAIGN, made.ONE_LOG, made.steps_of(log), stated]) + "\n")
    run_campaign(
        load_campaign(path), processed=folder / "p", reports=folder / "r", clock=lambda: 0.0
    )
    product = folder / "p" / "rope-programme" / "change_in_length.nc"
    with open_archive(product) as archive:
        return archive.load()


@pytest.fixture(scope="module")
def base(tmp_path_factory):
    return reduced(tmp_path_factory.mktemp("properties") / "base")


def contribution(archive, name, source):
    sources = archive["uncertainty_source"].values.tolist()
    return archive[f"{name}_uncertainty_contribution"].values[sources.index(source)]


@pytest.mark.parametrize(
    ("source", "wrong"),
    [
        ("tension_gain", {"gain": GAIN}),
        *(
            pytest.param(source, wrong, marks=pytest.mark.nightly)
            for source, wrong in (
                ("tension_offset", {"zero": ZERO}),
                ("position_gain", {"position_gain": POSITION_GAIN}),
                ("position_offset", {"position_zero": POSITION_ZERO}),
                ("temperature", {"stiffer": STIFFER}),
            )
        ),
    ],
)
def test_logs_that_are_wrong_move_each_property_as_its_contribution_says(
    base, tmp_path, source, wrong
):
    moved = reduced(tmp_path / "wrong", **wrong)
    assert moved["property_name"].values.tolist() == base["property_name"].values.tolist()
    for name in NAMES:
        value = base[name].values
        known = np.isfinite(value)
        change = (moved[name].values - value)[known]
        told = contribution(base, name, source)[known]
        # the ends of the first rise are bins, which another scale of strain moves; the rest is
        # linear to its own square
        assert change == pytest.approx(told, rel=0.06, abs=1e-5 * np.abs(value[known]).max()), name


def test_every_property_of_this_programme_has_a_number_and_a_first_rise(base):
    names = base["property_name"].values.tolist()
    assert list(dict.fromkeys(names)) == [
        "original stiffness", "static stiffness", "dynamic stiffness", "construction strain",
        "polymer strain", "working strain",
    ]  # fmt: skip
    assert not any(base["property_remark"].values)
    # the foot of the last cycle, and where the straight first rise had its tension
    truth = 0.01 + made.bedding_foot(made.N_BEDDING) - 5 / 17.5 * MEAN_STRAIN
    place = names.index("construction strain")
    spread = float(base["property_strain_standard_uncertainty"].values[place])
    assert base["property_strain"].values[place] == pytest.approx(truth, abs=3 * spread, rel=0.01)


def test_both_parts_are_in_the_uncertainty(base):
    for name in NAMES:
        rows = base[f"{name}_uncertainty_contribution"].values
        random = base[f"{name}_random_standard_uncertainty"].values
        whole = base[f"{name}_standard_uncertainty"].values
        known = np.isfinite(base[name].values)
        assert np.isnan(rows[:, ~known]).all()
        assert np.isnan(whole[~known]).all()
        together = np.sqrt((rows**2).sum(axis=0) + random**2)
        assert whole[known] == pytest.approx(together[known])


def test_the_strength_is_in_what_is_a_share_of_it_alone(base):
    over = base["property_stiffness_over_strength"].values
    told = contribution(base, "property_stiffness_over_strength", "rated_break_strength")
    known = np.isfinite(over)
    assert told[known] == pytest.approx(-STRENGTH * over[known])
    for name in ("property_stiffness", "property_strain"):
        rows = contribution(base, name, "rated_break_strength")
        assert not np.nan_to_num(rows).any()


def test_the_budget_of_a_property_adds_up(base, tmp_path):
    path = tmp_path / "change_in_length.nc"
    base.to_netcdf(path)
    answer = CliRunner().invoke(
        app,
        ["budget", str(path), "--quantity", "property_stiffness", "--at", "property=1", "--json"],
    )
    assert answer.exit_code == 0, answer.output
    found = json.loads(answer.output)
    assert found["sources"][0]["source"] == "tension_gain"
    assert sum(one["share"] for one in found["sources"]) == pytest.approx(1.0)
    assert found["standard_uncertainty"] == pytest.approx(
        float(base["property_stiffness_standard_uncertainty"].values[0])
    )
    # a chord of a regression on many samples
    assert found["coverage_factor"] == pytest.approx(1.96, abs=0.01)


def test_the_page_and_the_table_show_what_is_shared(tmp_path):
    reduced(tmp_path / "base")
    html = (tmp_path / "base" / "r" / "rope-programme" / "index.html").read_text(encoding="utf-8")
    section = html[html.index("Programme of rope R-1") :]
    told = re.search(r"errors common to all samples: ([^<]*)", section)
    assert told is not None
    assert "tension gain" in told[1]
    assert "position offset" not in told[1]
    table = tmp_path / "base" / "p" / "rope-programme" / "tables"
    head, *rows = (table / "shared_errors_change_in_length.csv").read_text().splitlines()
    assert "property_strain_uncertainty_contribution [1]" in head
    assert any("working strain" in row and "position_gain" in row for row in rows)


def test_without_stated_instruments_the_zero_of_strain_alone_is_shared(tmp_path):
    found = reduced(tmp_path / "bare", stated="")
    # the part of a cycle in which the rope drifts is shared by its tests, and changes none of these
    assert set(found["uncertainty_source"].values.tolist()) == {"strain_calibration"}
    assert np.isfinite(found["property_stiffness_standard_uncertainty"].values).any()

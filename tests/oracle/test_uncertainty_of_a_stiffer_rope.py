"""Logs of a rope that is stiffer by a share, reduced again: what temperature does to each number.

A machine that holds the tension to its set values sees a shorter stretch, one that holds the
position a higher tension.  Position gain is proved on the same programme: the reference time of a
pair of holds is not their mean time.
"""

import numpy as np
import programme as made
import pytest

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

pytestmark = pytest.mark.slow

GAUGE, SHARE, POSITION_GAIN, GAIN = 10.0, 0.01, 0.005, 0.004
CAMPAIGN = f"""
[campaign]
id = "rope-programme"
title = "A rope programme in one log"
source = "synthetic, from known stiffness and creep"
synthetic = true
[uncertainty.temperature]
value = "2 K"
stiffness_per_kelvin = "0.5 %"
[uncertainty.tension]
gain = "{100 * GAIN:g} %"
[uncertainty.crosshead_position]
gain = "{100 * POSITION_GAIN:g} %"
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
strain = {{ method = "gauge-length" }}
"""
PAIR = (
    "held_pair_low_tension", "held_pair_high_tension", "static_stiffness",
    "static_stiffness_over_strength", "static_stiffness_per_decade",
)  # fmt: skip
HOLD = ("hold_strain", "hold_initial_tension", "hold_final_tension")
CREEP = (
    *HOLD, "creep_rate_per_decade", "strain_at_time", "tension_at_time",
    "creep_tension_over_strength", "creep_compliance_per_decade",
)  # fmt: skip
DYNAMIC = (
    "dynamic_stiffness", "dynamic_mean_tension", "dynamic_tension_amplitude",
    "dynamic_stiffness_over_strength", "dynamic_mean_tension_over_strength",
)  # fmt: skip
BEDDING = (
    "bedding_first_stiffness", "bedding_last_stiffness", "bedding_stiffening",
    "bedding_permanent_strain", *DYNAMIC,
)  # fmt: skip
OF_STEP = {
    "P-7.bedding-in": BEDDING,
    "P-7.quasi-static": (*PAIR, *CREEP),
    "P-7.dynamic-1": DYNAMIC,
    "P-7.creep": CREEP,
}
OF_RELAXATION = (
    *PAIR, *HOLD, "relaxation_drop", "relaxation_rate_per_decade", "tension_at_time",
    "strain_at_time",
)  # fmt: skip
OF_PULL = ("pull_peak_tension", "pull_peak_strain", "pull_peak_tension_over_strength")


def relaxing():
    """Two lengths, the higher one held while the tension falls with the logarithm of time."""
    log = made.Log()
    log.go(30, lambda since: 0.0, lambda since: 0.0)
    begin = log.now
    log.ramp(20, 1e4, 0.03)
    log.go(600, lambda since: 1e4, lambda since: 0.03)
    log.ramp(20, 3e4, 0.07)
    log.go(3600, lambda since: 3e4 - 1200.0 * np.log10(1 + since / 10), lambda since: 0.07)
    log.step("quasi-static", begin)
    return log


def controlled():
    """Bedding-in, a pair of holds, a level and creep, in which the machine keeps the tension."""
    log = made.Log()
    log.go(30, lambda since: 0.0, lambda since: 0.0)
    begin = log.now
    low, high = 0.05 * made.STRENGTH, 0.30 * made.STRENGTH
    log.ramp(20, low, 0.01 + made.bedding_foot(1))
    log.go(10, lambda since: low, lambda since: 0.01 + made.bedding_foot(1))
    for number in range(1, made.N_BEDDING + 1):
        log.cycle(low, high, made.bedding_stiffness(number), 0.01 + made.bedding_foot(number + 1))
    log.step("bedding-in", begin)
    begin = log.now
    low = 0.10 * made.STRENGTH
    log.ramp(20, low, 0.04)
    log.go(600, lambda since: low, lambda since: 0.04 + 1e-3 * np.log10(1 + since / 10))
    foot = log.state[1]
    log.ramp(20, high, foot + (high - low) / made.static_stiffness(10.0))
    log.go(
        3600, lambda since: high,
        lambda since: foot + (high - low) / made.static_stiffness(since + 10),
    )  # fmt: skip
    log.step("quasi-static", begin)
    begin = log.now
    log.ramp(20, 0.05 * made.STRENGTH, 0.03)
    for number in range(1, made.N_LEVEL + 1):
        log.cycle(0.05 * made.STRENGTH, 0.15 * made.STRENGTH, made.level_stiffness(0, number), 0.03)
    log.go(10, lambda since: 0.05 * made.STRENGTH, lambda since: 0.03)
    log.step("dynamic 1", begin)
    begin = log.now
    log.ramp(20, 0.4 * made.STRENGTH, 0.06)
    log.go(
        7200, lambda since: 0.4 * made.STRENGTH,
        lambda since: 0.06 + made.CREEP * np.log10(since / 10 + 1),
    )  # fmt: skip
    log.step("creep", begin)
    return log


def archives(folder, log, control, *, stiffer=0.0, position_gain=0.0, gain=0.0, single=None):
    """Every step of a log, reduced; the rope is stiffer by a share, or a channel is wrong."""
    folder.mkdir(parents=True)
    noise = np.random.default_rng(3)
    time, tension, strain = (np.concatenate(one) for one in (log.time, log.tension, log.strain))
    if control == "load":
        strain = strain / (1 + stiffer)
    else:
        tension = tension * (1 + stiffer)
    position = GAUGE * strain + noise.normal(0, 2e-6, time.size)
    force = tension + noise.normal(0, 1.0, time.size)
    np.savetxt(
        folder / ("P-7.csv" if single is None else "B-1.csv"),
        np.column_stack([time, position * (1 + position_gain), force * (1 + gain)]),
        delimiter=",", header="t_s,x_m,F_N", comments="", fmt=["%.2f", "%.9f", "%.6f"],
    )  # fmt: skip
    tests = (made.ONE_LOG, made.steps_of(log)) if single is None else (single,)
    path = folder / "campaign.toml"
    path.write_text("\n".join([f'{CAMPAIGN}control = "{control}"', *tests]) + "\n")
    result = run_campaign(
        load_campaign(path), processed=folder / "p", reports=folder / "r", clock=lambda: 0.0
    )
    assert result.exit_status == 0
    found = {}
    for product in sorted(result.processed.glob("*-*.nc")):
        with open_archive(product) as archive:
            found[product.stem] = archive.load()
    return found


WRONG = {
    "temperature": {"stiffer": SHARE},
    "position_gain": {"position_gain": POSITION_GAIN},
    "tension_gain": {"gain": GAIN},
}
PROGRAMMES = {"load": controlled, "position": relaxing}
NAMES = {"load": OF_STEP, "position": {"P-7.quasi-static": OF_RELAXATION}}


@pytest.fixture(
    scope="module", params=["position", pytest.param("load", marks=pytest.mark.nightly)]
)
def programme(request, tmp_path_factory):
    """The log under one control, as it is and wrong by each error either way."""
    folder, log = tmp_path_factory.mktemp("stiffer"), PROGRAMMES[request.param]()
    found = {"": archives(folder / "base", log, request.param)}
    for source, wrong in WRONG.items():
        for way in (1, -1):
            one = {name: way * size for name, size in wrong.items()}
            found[source, way] = archives(folder / f"{source}{way}", log, request.param, **one)
    return request.param, found


def compared(base, above, below, source, names):
    """Each contribution against half the difference of the two reductions."""
    place = base["uncertainty_source"].to_numpy().astype(str).tolist().index(source)
    for name in names:
        value = base[name].to_numpy()
        wanted = (above[name].to_numpy() - below[name].to_numpy()) / 2
        found = base[f"{name}_uncertainty_contribution"].to_numpy()[place]
        known = np.isfinite(wanted)
        assert known.any(), name
        scale = np.max(np.abs(value[known]))
        assert found[known] == pytest.approx(wanted[known], rel=0.01, abs=5e-5 * scale), name


@pytest.mark.nightly
@pytest.mark.parametrize("source", WRONG)
def test_each_number_of_a_programme_moves_as_its_contribution_says(programme, source):
    control, found = programme
    for test, names in NAMES[control].items():
        compared(found[""][test], found[source, 1][test], found[source, -1][test], source, names)


@pytest.mark.parametrize("control", ["load", pytest.param("position", marks=pytest.mark.nightly)])
def test_a_pull_that_is_stopped_moves_by_what_the_machine_does_not_set(tmp_path, control):
    single = made.single("B-1", "tensile", f'control = "{control}"')
    (base,), (above,), (below,) = (
        archives(tmp_path / name, made.stopped_log(), control, stiffer=size, single=single).values()
        for name, size in (("base", 0.0), ("above", SHARE), ("below", -SHARE))
    )
    compared(base, above, below, "temperature", OF_PULL)

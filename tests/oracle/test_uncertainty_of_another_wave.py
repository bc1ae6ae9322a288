"""Lag in the tangent modulus of a wave that is neither ramps nor a sine (synthetic log)."""

import numpy as np
import pytest

from reduction.archive.open import open_archive
from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign

LENGTH, STIFFNESS, LAG, FREQUENCY = 5.0, 2e5, 0.004, 0.5
MEAN, ORDERS = 0.05, np.array([1, 3, 5])  # a triangle of 4 % without its higher harmonics
AMPLITUDES = 0.04 * 8 / np.pi**2 / ORDERS**2

CAMPAIGN = """
[campaign]
id = "wave"
title = "synthetic"
synthetic = true
[specimens.S]
kind = "rope"
diameter = ["20 mm"]
gauge_length = "5 m"
[layouts.log]
format = "delimited"
[layouts.log.channels]
time = { column = "t", unit = "s" }
crosshead_position = { column = "x", unit = "m", datum = "displacement", reference_length = "5 m" }
tension.1 = { column = "F", unit = "N" }
[uncertainty]
lag = "4 ms"
[tests.A]
file = "A.csv"
layout = "log"
specimens = ["S"]
waveform = "other"
"""


def test_a_lag_counts_by_the_speed_that_the_log_has(tmp_path):
    time = np.arange(0, 30, 0.004)
    turn = 2 * np.pi * FREQUENCY * ORDERS
    cycling = np.clip(time - 9, 0, 20)[:, None]
    wave = MEAN - (AMPLITUDES * np.cos(turn * cycling)).sum(axis=1)
    ramp = np.interp(time, [5, 9], [0, MEAN - AMPLITUDES.sum()])
    strain = np.where(time < 9, ramp, wave)
    table = np.column_stack([time, LENGTH * strain, STIFFNESS * strain])
    np.savetxt(tmp_path / "A.csv", table, delimiter=",", header="t,x,F", comments="", fmt="%.9f")
    (tmp_path / "campaign.toml").write_text(CAMPAIGN)
    run_campaign(
        load_campaign(tmp_path / "campaign.toml"), processed=tmp_path / "p", reports=tmp_path / "r",
        clock=lambda: 0.0,
    )  # fmt: skip
    with open_archive(tmp_path / "p" / "wave" / "A.nc") as archive:
        of_lag = archive["uncertainty_source"].to_numpy().astype(str) == "lag"
        found = archive["tangent_modulus_uncertainty_contribution"].to_numpy()[of_lag][0, 0]
        at, modulus = archive["strain_bin"].to_numpy(), archive["tangent_modulus"].to_numpy()[0]
    # an elastic line: dT/dx falls by the lag times the slope of the speed over the strain
    phase = np.linspace(0, 0.5, 4001)[:, None] / FREQUENCY
    reached = MEAN - (AMPLITUDES * np.cos(turn * phase)).sum(axis=1)
    speed = (AMPLITUDES * turn * np.sin(turn * phase)).sum(axis=1)
    wanted = -np.nanmean(modulus) * LAG * np.interp(at, reached, np.gradient(speed, reached))
    inside = np.abs(at - MEAN) < 0.75 * AMPLITUDES.sum()
    for branch, sign in ((found[0], 1), (found[1], -1)):
        assert branch[inside] == pytest.approx(
            sign * wanted[inside], abs=0.2 * wanted[inside].max()
        )

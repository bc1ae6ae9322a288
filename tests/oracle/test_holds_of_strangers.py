"""Holds whose crosshead settles, from laws of their own, end to end against their truth."""

import csv

import numpy as np
import pytest
from commandruns import reduction
from strangers import make

LAWS = ("hold-settling", "hold-overshoot", "hold-tether")


def rows(path):
    with path.open(encoding="utf-8") as file:
        return [
            {name.split(" [")[0]: text for name, text in row.items()}
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
        ]


def check(law, seed, folder):
    """Start, drop, and the series at the end of the ramp, as long as they are given."""
    truth = make(law, seed, folder)
    assert reduction("run", folder / "campaign.toml", cwd=folder).returncode == 0
    (table,) = folder.glob("processed/*/tables/relaxation.csv")
    found = {row["test"]: row for row in rows(table)}
    assert found.keys() == truth.tests.keys()
    n_series = 0
    for test, row in found.items():
        true = truth.tests[test]["piece"]
        step = 1 / truth.constants["sampling_Hz"]
        allowed = max(0.5, step, 0.02 * true["ramp_duration"])
        assert abs(float(row["hold_start_time"]) - true["hold_start"]) <= allowed
        assert abs(float(row["hold_ramp_end_time"]) - true["hold_start"]) <= allowed
        assert float(row["relaxation_drop"]) == pytest.approx(true["drop_to_end"], abs=0.01)
        if row["hold_ramp_end_tension"]:
            n_series += 1
            modelled = float(row["hold_ramp_end_tension"])
            assert modelled == pytest.approx(true["prony_sum_at_ramp_end"], rel=0.02)
            assert modelled == pytest.approx(float(row["hold_logged_peak_tension"]), rel=0.02)
        else:
            assert "Prony series" in row["hold_refusal"]
    return n_series


@pytest.mark.parametrize("law", LAWS)
def test_a_hold_begins_where_its_ramp_ends(law, tmp_path):
    assert check(law, 1, tmp_path) >= 2


def test_a_line_through_few_readings_leads_no_higher_than_the_ramp(tmp_path):
    """Five readings a second of what relaxes in seconds: the ramp says more than the hold."""
    assert check("hold-tether", 116, tmp_path) >= 2


@pytest.mark.nightly
@pytest.mark.parametrize("law", LAWS)
def test_holds_of_many_realisations(law, tmp_path):
    n_series = [check(law, seed, tmp_path / str(seed)) for seed in range(100, 124)]
    assert np.mean(n_series) >= 2

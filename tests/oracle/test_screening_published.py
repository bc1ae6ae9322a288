"""Published Plackett-Burman data of others: a design of twelve runs, and effects from R."""

import csv
from itertools import combinations

import numpy as np
from measured_logs import LOGS, needs_measured_logs

from reduction.experiments.designs import Design, plackett_burman
from reduction.experiments.screening import screening_effects


def pairings(columns):
    """Inner products of three columns: what no order or sign of rows and columns changes."""
    return sorted(
        abs(int((columns[:, i] * columns[:, j] * columns[:, k]).sum()))
        for i, j, k in combinations(range(columns.shape[1]), 3)
    )


@needs_measured_logs
def test_twelve_runs_are_a_published_design_up_to_order_and_sign():
    with (LOGS / "plackett-burman" / "PB12Des.csv").open() as file:
        published = np.array(list(csv.reader(file))[1:], dtype=float)
    ours = plackett_burman(11, n_runs=12).coded
    assert pairings(ours) == pairings(published)
    # and in fact: that file runs through the columns the other way round
    rows = {tuple(row) for row in published}
    found = [
        (step, start)
        for step in range(1, 11)
        for start in range(11)
        if {tuple(row) for row in ours[:, (start + step * np.arange(11)) % 11]} == rows
    ]
    assert found


@needs_measured_logs
def test_cast_fatigue_effects_to_the_printed_digit():
    with (LOGS / "plackett-burman" / "BM93.e2.data.csv").open() as file:
        table = np.array(list(csv.reader(file))[1:], dtype=float)
    design = Design("plackett-burman", table[:, :7], np.empty((12, 0)))
    found = screening_effects(design, table[:, 7], names="ABCDEFG")
    printed = [0.32583, 0.29383, -0.24583, -0.51617, 0.14983, 0.91517, 0.18317]
    np.testing.assert_allclose(found.effect, printed, atol=5e-6)

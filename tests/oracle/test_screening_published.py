"""A published Plackett-Burman design of others, of twelve runs."""

import csv
from itertools import combinations

import numpy as np
from measured_logs import LOGS, needs_measured_logs

from reduction.experiments.designs import plackett_burman


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

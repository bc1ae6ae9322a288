"""Tests that stand side by side in one table, each with columns of its own."""

import re

import numpy as np
import pytest

CAMPAIGN = """
[campaign]
id = "side"
title = "side by side"
[defaults]
kind = "tensile"
control = "position"
"""

TEST = """
[specimens.s{k}]
kind = "other"
diameter = ["2 mm"]
gauge_length = "20 mm"
[layouts.l{k}]
format = "delimited"
delimiter = ","
has_name_row = true
has_unit_row = false
[layouts.l{k}.channels]
time = {{ column = {time}, unit = "s" }}
tension.1 = {{ column = {force}, unit = "N" }}
crosshead_position.column = {stroke}
crosshead_position.unit = "mm"
crosshead_position.datum = "displacement"
crosshead_position.reference_length = "20 mm"
[tests.t{k}]
file = "log.csv"
layout = "l{k}"
specimens = ["s{k}"]
order = 1
"""


def test_the_shorter_one_ends_where_its_columns_end(tmp_path, command):
    rng = np.random.default_rng(0)
    rows = [["time", "force", "stroke"] * 2]
    for i in range(900):
        row = [f"{i / 10:.1f}", f"{i + rng.normal(0, 0.3):.4f}", f"{i / 300:.5f}"]
        other = [f"{i / 10:.1f}", f"{3 * i + rng.normal(0, 0.3):.4f}", f"{i / 300:.5f}"]
        rows.append([*row, *(other if i < 600 else ["", "", ""])])
    (tmp_path / "log.csv").write_text("\n".join(",".join(row) for row in rows) + "\n")
    tests = [TEST.format(k=k + 1, time=3 * k + 1, force=3 * k + 2, stroke=3 * k + 3)
             for k in range(2)]  # fmt: skip
    (tmp_path / "campaign.toml").write_text(CAMPAIGN + "".join(tests))
    done = command("run", "campaign.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count(" reduced") == 2, done.stdout
    # 300 readings a millimetre, 20 mm of gauge length, 1 and 3 N a reading
    for name, slope in (("s1", 6000), ("s2", 18000)):
        row = next(line for line in done.stdout.splitlines() if line.startswith(f"{name} "))
        stiffness = re.findall(r"([\d.,]+) ±", row)[2]
        assert float(stiffness.replace(",", "")) == pytest.approx(slope, rel=0.02)

"""MoorPy itself reads what is exported for it, in the folder where its table is."""

import importlib.util
import json
import subprocess
import sys

import numpy as np
import pytest
import yaml
from export_lines import growing, line
from export_readers import moorpy_table

from reduction.lines.deck_formats import export_line

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        importlib.util.find_spec("moorpy") is None, reason="MoorPy is not installed"
    ),
]
# matplotlib comes with MoorPy: a process of its own keeps its warnings out of the tests
DRIVER = """
import json, sys
import moorpy
system = moorpy.System(sys.argv[1])
(one,) = system.lineList
assert "EA" not in one.type, one.type
out = []
system.pointList[0].setPosition([0.0, 0.0, -100.0])
for strain in json.loads(sys.argv[2]):
    system.pointList[1].setPosition([0.0, 0.0, -100.0 + 10.0 * (1 + strain)])
    one.staticSolve()
    out.append([float(one.TA), float(one.TB)])
print(json.dumps(out))
"""
LIBRARY = """
import json, sys
from moorpy.helpers import getLineProps
found = getLineProps(26.0, sys.argv[2], source=sys.argv[1])
print(json.dumps({name: float(found[name]) for name in
    ("d_vol", "m", "EA", "MBL", "EAd", "EAd_Lm", "Cd", "CdAx", "Ca", "CaAx")}))
"""


def run(driver, *arguments, cwd):
    done = subprocess.run(
        [sys.executable, "-c", driver, *arguments],
        cwd=cwd, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-800:]
    assert "placeholder" not in done.stdout
    return json.loads(done.stdout.strip().split("\n")[-1])


def test_a_table_gives_its_tension_between_its_nodes(tmp_path):
    export_line(line(), "moorpy", tmp_path / "deck.dat")
    table = moorpy_table((tmp_path / "deck_moorpy.txt").read_text())
    middle = (table[0, 1:-1] + table[0, 2:]) / 2
    ends = run(DRIVER, "deck.dat", json.dumps(middle.tolist()), cwd=tmp_path)
    # the deck has no gravity: both ends have the tension of the table
    expected = np.interp(middle, *table)
    np.testing.assert_allclose(ends, np.stack([expected, expected], axis=1), rtol=1e-6)


def test_the_library_gives_stiffness_and_mass(tmp_path):
    one = line(viscoelasticity=growing(), rated_break_strength=5e4)
    export_line(one, "moorpy", tmp_path / "props.yaml", form="library")
    assert yaml.safe_load((tmp_path / "props.yaml").read_text())["lineProps"].keys() == {
        "new_tether"
    }
    found = run(LIBRARY, "props.yaml", "new_tether", cwd=tmp_path)
    expected = {
        "d_vol": 0.026, "m": 0.6, "EA": 2e4, "MBL": 5e4, "EAd": 3e4, "EAd_Lm": 10.0, "Cd": 1.2,
        "CdAx": 0.0, "Ca": 1.0, "CaAx": 0.0,
    }  # fmt: skip
    assert found == pytest.approx(expected)

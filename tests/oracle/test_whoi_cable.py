"""WHOI Cable itself, where a program of that name is on the path; it is not part of this package."""

import re
import shutil
import subprocess

import numpy as np
import pytest
from export_lines import line, rubber

from reduction.lines.deck_formats import _whoicable_text

CABLE = shutil.which("cable")
PROBLEM = """
Problem Description
    title = "a line under an end force"
    type = general
Analysis Parameters
    static-relaxation = 0.1
    static-iterations = 5000
    static-tolerance = 1e-6
Environment
    rho = 1025.0
    gravity = 9.81
    depth = 100.0
Buoys
    ball type = sphere d = 0.5 m = 1.0
Anchors
    clump
Layout
    terminal = {{ anchor = clump }}
    segment = {{ length = 10.0 material = "{name}" nodes = (101, 1.0) }}
    terminal = {{ buoy = ball x-force = 1.0 z-force = {force} }}
{material}
"""


@pytest.mark.skipif(CABLE is None, reason="there is no program `cable` on the path")
@pytest.mark.parametrize("form", ["expression", "table"])
def test_the_length_under_a_force_is_that_of_the_curve(tmp_path, form):
    one = line()
    force = 400.0
    text = PROBLEM.format(
        name=one.identifier, force=force, material=_whoicable_text(one, form=form)
    )
    (tmp_path / "x.cbl").write_text(text)
    done = subprocess.run(
        [CABLE, "-in", "x.cbl", "-out", "x.crs", "-static", "-nocpp", "-quit"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "Static solution complete" in done.stdout + done.stderr
    strain = np.linspace(0, 1.5, 2001)
    expected = 10 * (1 + np.interp(force, rubber(strain), strain))
    depth = float(re.search(r"buoy depth\D*([\d.]+)", done.stdout + done.stderr, re.I)[1])
    assert 100 - depth == pytest.approx(expected, rel=0.01)

"""WHOI Cable itself, where a program of that name is on the path; it is not part of this package."""

import shutil
import subprocess

import numpy as np
import pytest

from reduction.lines.client_runs import _CABLE
from reduction.lines.composite import CompositeRule, compose
from reduction.lines.deck_formats import _whoicable_text
from reduction.lines.export_line import SEA_WATER
from reduction.lines.export_sources import line_from_composite, line_from_lookup
from reduction.lines.published_source import published_piece_sources, published_sources

CABLE, RES2ASC = shutil.which("cable"), shutil.which("res2asc")


ENDS = 0.3  # of the strain of a curve, by which its straight end is looked at


def a_line(name):
    """Lines that neither float nor sink, so that the tension is that of the end force."""
    if name == "tethers":
        source = published_piece_sources()["rubber-tether-used"]
        mass = SEA_WATER * np.pi / 4 * 0.06**2 * 1.0001
        rule = CompositeRule()
        return line_from_composite(
            source, compose(source, rule), diameter=0.06, linear_density=mass
        )
    return line_from_lookup(published_sources()[name], linear_density=0.11, wet_linear_density=1e-5)


@pytest.mark.skipif(
    CABLE is None or RES2ASC is None, reason="no programs `cable` and `res2asc` on the path"
)
@pytest.mark.parametrize("form", ["expression", "table"])
@pytest.mark.parametrize(
    "name", ["polyester-double-braid-0.5in-new", "nylon-8-strand-plaited-0.5in-new", "tethers"]
)
@pytest.mark.parametrize("share", [0.05, 0.2, 0.5, 0.8, 1.0, 1.2])
def test_the_length_under_a_force_is_that_of_the_curve(tmp_path, form, name, share):
    one = a_line(name)
    force = share * float(one.tension[-1])
    text = _CABLE.format(name=one.identifier, force=force, material=_whoicable_text(one, form=form))
    (tmp_path / "x.cbl").write_text(text)
    done = subprocess.run(
        [CABLE, "-in", "x.cbl", "-out", "x.crs", "-static", "-nocpp", "-quit"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "Static solution complete" in done.stdout + done.stderr
    subprocess.run(
        [RES2ASC, "-in", "x.crs", "-variables", "z", "x", "T", "-static", "s.txt"],
        cwd=tmp_path, capture_output=True, check=True,
    )  # fmt: skip
    depth, aside, tension = np.loadtxt(tmp_path / "s.txt", skiprows=2).T
    found = np.hypot(np.ptp(depth), np.ptp(aside)) / 10 - 1
    strain, load = np.append(0.0, one.strain), np.append(0.0, one.tension)
    slope = (load[-1] - load[-2]) / (strain[-1] - strain[-2])
    further = ENDS * strain[-1]
    expected = np.interp(
        force,
        np.append(load, load[-1] + slope * further),
        np.append(strain, strain[-1] + further),
    )
    assert tension[-1] == pytest.approx(force, rel=0.001)
    assert found == pytest.approx(expected, rel=0.01)

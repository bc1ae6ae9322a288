"""`export --verify` on the screen, in the header and in the status."""

import importlib.util
import json

import pytest

from reduction.lines.client_runs import LIMITS


@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="moordyn is not installed")
def test_the_command_prints_what_the_program_gave_and_the_header_has_it(command, tmp_path):
    done = command(
        "export", "polyester-double-braid-0.5in-new", "--to", "moordyn", "--form",
        "static-dynamic", "--linear-density", "0.11 kg/m", "--frequency", "0.3 Hz",
        "--mean-tension", "21 %RBS", "--tension-amplitude", "8.5 %RBS", "--verify", "--json",
        "--out", tmp_path / "leg.dat",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    checks = json.loads(done.stdout)["checks"]
    assert {one["quantity"] for one in checks} == {"tension", "K_ap", "H"}
    assert all(abs(one["error"]) <= LIMITS[one["quantity"]] and one["kept"] for one in checks)
    head = " ".join((tmp_path / "leg.dat").read_text().split())
    assert "run in MoorDyn 2.7" in head
    assert "H within 0." in head

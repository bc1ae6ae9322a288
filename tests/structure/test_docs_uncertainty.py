"""What docs/uncertainty.md says of 137 psi follows from the page, and its budget is the command's."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from reduction.cli.main import app
from reduction.published.printed_cells import cells_of

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "uncertainty.md").read_text(encoding="utf-8")
ROW = "T-1 rubber tether new, raw data, ascending, segment 1"


def rows(head):
    """Cells of the table under a heading row."""
    part = PAGE[PAGE.index(head) :].partition("\n\n")[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines()[2:]]


def test_what_the_page_says_of_137_psi_follows_from_the_printed_digits():
    cells = {cell.column: cell for cell in cells_of("WHOI-2005-10") if cell.row == ROW}
    load = cells["segment_tension_high"].value - cells["segment_tension_low"].value
    strain = cells["segment_strain_high"].value - cells["segment_strain_low"].value
    diameter = 1.04
    modulus = load / (strain * np.pi * diameter**2 / 4)
    assert round(modulus) == cells["segment_modulus"].value == 137
    step = 1 / np.sqrt(12)
    # two loads to 1 lb, two strains to .005, a diameter to .01 in that enters twice
    relative = [
        np.sqrt(2) * 1.0 * step / load, np.sqrt(2) * 0.005 * step / strain,
        2 * 0.01 * step / diameter,
    ]  # fmt: skip
    relative.append(np.sqrt(np.sum(np.square(relative))))
    told = rows("| source | known |")
    assert [row[2] for row in told] == [f"{100 * one:.2f} %" for one in relative]
    assert [row[3] for row in told] == [f"{one * modulus:.2f}" for one in relative]
    assert f"{1.96 * relative[-1] * modulus:.1f} psi (k = 1.96)" in PAGE


def test_the_budget_of_the_synthetic_test_is_that_of_the_command(tmp_path):
    def run(*arguments):
        found = CliRunner().invoke(app, [str(one) for one in arguments])
        assert found.exit_code == 0, found.output
        return found.output

    run(
        "run", ROOT / "raw" / "tmt-synthetic" / "campaign.toml", "--test", "T-1", "--processed",
        tmp_path, "--reports", tmp_path / "r", "--quiet",
    )  # fmt: skip
    answer = json.loads(
        run(
            "budget", tmp_path / "tmt-synthetic" / "T-1.nc", "--quantity", "segment_modulus",
            "--at", "specimen=new", "--at", "branch=ascending", "--at", "segment=1", "--json",
        )
    )  # fmt: skip
    psi = 4.4482216152605 / 0.0254**2
    found = {one["source"]: one for one in answer["sources"]}
    zeros = [found[name] for name in ("tension_offset", "position_offset")]
    found["zeros"] = {
        "contribution": np.sqrt(sum(one["contribution"] ** 2 for one in zeros)),
        "share": sum(one["share"] for one in zeros),
    }
    names = {
        "diameter": "diameter", "gain of the load": "tension_gain",
        "gain of the crosshead": "position_gain", "scatter": "random", "lag": "lag",
        "tape": "strain_calibration", "which law": "splice_law", "friction": "splice_friction", "zeros": "zeros",
    }  # fmt: skip
    for label, psi_told, share in rows("| source | psi |"):
        one = found[next(name for start, name in names.items() if label.startswith(start))]
        assert float(psi_told) == pytest.approx(one["contribution"] / psi, abs=0.0051), label
        assert float(share.strip(" %")) == pytest.approx(100 * one["share"], abs=0.06), label
    (told,) = re.findall(r"(\d\.\d\d) psi of standard uncertainty", PAGE)
    assert float(told) == pytest.approx(answer["standard_uncertainty"] / psi, abs=0.0051)

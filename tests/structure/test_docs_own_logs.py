"""What docs/own-logs.md makes of certificates is arithmetic, and its budget is the command's."""

import json
import re
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from reduction.cli.main import app

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "own-logs.md").read_text(encoding="utf-8")
BLOCK = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)[-1]


def test_the_certificates_give_the_standard_uncertainties_of_the_page():
    stated = tomllib.loads(BLOCK)["uncertainty"]
    rectangular = 1 / np.sqrt(3)
    readings = [26.41, 26.44, 26.38]
    diameter = np.linalg.norm([np.std(readings, ddof=1) / np.sqrt(3), 0.02 / 2, 0.01 / np.sqrt(12)])
    gain = np.hypot(0.21 * rectangular, 0.12 / 2)
    of_position = np.hypot(0.08 * rectangular, 0.10 / 2)
    assert stated["diameter"] == f"{diameter:.4f} mm"
    assert stated["tension"]["gain"] == f"{gain:.3f} %"
    assert stated["crosshead_position"]["gain"] == f"{of_position:.3f} %"
    assert stated["tension"]["offset"] == {"half_width": f"{5000 * 0.0005:g} N"}
    for text in (f"= {gain:.3f} %", f"= {of_position:.3f} %", f"{2.5 * rectangular:.2f} N",
                 f"{1.5 * rectangular:.2f} mm", f"= {diameter:.4f} mm"):  # fmt: skip
        assert text in PAGE


def test_the_budget_of_the_page_is_that_of_the_command(tmp_path):
    campaign = tmp_path / "raw" / "campaign.toml"
    shutil.copytree(ROOT / "raw" / "tmt-synthetic", campaign.parent)
    text = (ROOT / "raw" / "tmt-synthetic" / "campaign.toml").read_text(encoding="utf-8")
    start, end = text.index("[uncertainty]"), text.index("# Fictitious throughout")
    text = text[:start] + BLOCK[BLOCK.index("[uncertainty]") :] + "\n" + text[end:]
    campaign.write_text(text, encoding="utf-8")

    def run(*arguments):
        found = CliRunner().invoke(app, [str(one) for one in arguments])
        assert found.exit_code == 0, found.output
        return found.output

    run(
        "run",
        campaign,
        "--test",
        "T-1",
        "--processed",
        tmp_path,
        "--reports",
        tmp_path / "r",
        "--quiet",
    )
    answer = json.loads(
        run(
            "budget", tmp_path / "tmt-synthetic" / "T-1.nc", "--quantity", "test_dynamic_modulus",
            "--at", "specimen=new", "--json",
        )
    )  # fmt: skip
    value, spread = map(
        float, re.search(r"value (\d+) Pa, standard uncertainty (\d+) Pa", PAGE).groups()
    )
    assert answer["value"] == pytest.approx(value, abs=51)
    assert answer["standard_uncertainty"] == pytest.approx(spread, abs=11)
    told = dict(re.findall(r"(?m)^(\w+) +\S.*? +(\d+\.\d)%$", PAGE))
    found = {one["source"]: 100 * one["share"] for one in answer["sources"]}
    assert set(told) == {name for name, share in found.items() if share >= 0.05}
    for name, share in told.items():
        assert found[name] == pytest.approx(float(share), abs=0.3), name


def test_the_edits_of_the_example_make_the_draft_ready_for_a_run(tmp_path):
    made = tmp_path / "my-logs"
    made.mkdir()
    for name in ("T-1.csv", "T-2.csv"):
        shutil.copy(ROOT / "raw" / "tmt-synthetic" / name, made)
    assert CliRunner().invoke(app, ["init", str(made)]).exit_code == 0
    text = (made / "campaign.toml").read_text(encoding="utf-8")
    start, end = text.index('[specimens."?"]'), text.index("[defaults]")
    section = re.sub(r"(?m)^gauge_length = .*\n", "", text[start:end])
    section = section.replace('kind = "?"', 'kind = "rubber tether"')
    pairs = (("new", "1.04 in"), ("used", "0.94 in"))
    specimens = "".join(
        section.replace('[specimens."?"]', f"[specimens.{name}]").replace('["?"]', f'["{size}"]')
        for name, size in pairs
    )
    assert all(f'`["{size}"]`' in PAGE or f'= ["{size}"]`' in PAGE for _, size in pairs)
    end_of_file = text[end:].replace("# strain = {", "strain = {")
    (made / "campaign.toml").write_text(text[:start] + specimens + end_of_file, encoding="utf-8")
    tests = (made / "tests.csv").read_text(encoding="utf-8")
    for row, edited in (("T-1,,T-1.csv,log,,?;?", "T-1,,T-1.csv,log,1,new;used"),
                        ("T-2,,T-2.csv,log,,?;?", "T-2,,T-2.csv,log,2,new;used")):  # fmt: skip
        assert row in tests
        tests = tests.replace(row, edited)
    (made / "tests.csv").write_text(tests, encoding="utf-8")
    marks = (ROOT / "raw" / "tmt-synthetic" / "marks.csv").read_text(encoding="utf-8")
    kept = [row for row in marks.splitlines() if row.startswith(("test,", "T-1,", "T-2,"))]
    (made / "marks.csv").write_text("\n".join(kept) + "\n", encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(made / "campaign.toml")])
    assert told.exit_code == 0 and told.output.count("ready for a run") == 2, told.output
    taut = [row for row in kept if ",slack," not in row]
    (made / "marks.csv").write_text("\n".join(taut) + "\n", encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(made / "campaign.toml")])
    assert told.exit_code == 4 and "the marks have no slack row" in told.output, told.output

"""Examples of the documentation are read, and their numbers are those of the program."""

import contextlib
import json
import re
import shlex
import tomllib
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from reduction.archive import report_details as laboratory
from reduction.campaign import hose_spec as hosemodel
from reduction.campaign.assembly_spec import (
    _AssemblyKeys,
    _CurveKeys,
    _PartKeys,
    _SpliceKeys,
    _WorkingKeys,
    load_assembly_case,
)
from reduction.campaign.experiment_plans import _ExperimentKeys, _ResponseKeys, _SpecFile
from reduction.campaign.hose_spec import load_hose
from reduction.campaign.model import _ReportSection
from reduction.campaign.prediction_specs import (
    _ArmourKeys,
    _ArmourLayerKeys,
    _WaveLoadKeys,
    load_armour_case,
    load_wave_case,
)
from reduction.cli.curves import deployed_line
from reduction.cli.main import app
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources
from reduction.published.printed_cells import cells_of
from reduction.readers.remote_files import PACKAGES

PAGE = (Path(__file__).parents[2] / "docs" / "client-report.md").read_text(encoding="utf-8")
SCHEMA = _ReportSection.model_json_schema()
SECTIONS = [SCHEMA, *SCHEMA["$defs"].values()]


def test_the_example_can_be_read():
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, re.S)
    found = _ReportSection.model_validate(tomllib.loads(example)["report"])
    assert found.issued == "2026-03-05" and found.limits[0].upper == "1.2 MPa"


def test_every_key_is_explained():
    assert len(SECTIONS) == 7
    keys = {name for section in SECTIONS for name in section["properties"]}
    assert not {key for key in keys if f"`{key}`" not in PAGE}


def test_both_rules_are_explained_as_they_are_written():
    assert set(re.findall(r'^- `"([\w ]+)"`:', PAGE, re.M)) == set(laboratory.DecisionRule.__args__)


# what docs/deployed.md shows can be read, no key is left out, and its figures are the answers

DOCS = Path(__file__).parents[2] / "docs"
PAGE_OF_DEPLOYED = (DOCS / "deployed.md").read_text(encoding="utf-8")
LBF = 4.4482216152605


def test_every_key_is_explained_in_deployed():
    models = (_AssemblyKeys, _CurveKeys, _PartKeys, _SpliceKeys, _WorkingKeys)
    named = {name for one in models for name in one.model_fields}
    assert not {name for name in named if f"`{name}`" not in PAGE_OF_DEPLOYED} - {
        "curve",
        "splices",
        "parts",
        "working",
    }
    for table in (
        "[assembly.curve]",
        "[assembly.splices]",
        "[[assembly.parts]]",
        "[[assembly.working]]",
    ):
        assert f"`{table}`" in PAGE_OF_DEPLOYED


def test_the_assembly_that_is_shown_is_the_one_beside_the_page(tmp_path):
    (block,) = re.findall(r"^```toml\n(.*?)^```$", PAGE_OF_DEPLOYED, re.M | re.S)
    shown = tmp_path / "new-hampshire.toml"
    shown.write_text(block, encoding="utf-8")
    beside = load_assembly_case(DOCS / "assemblies" / "new-hampshire.toml")
    assert repr(load_assembly_case(shown)) == repr(beside)  # a NaN is not equal to itself


@pytest.mark.parametrize(("name", "place"), [("new-hampshire", 0), ("globec", 1)])
def test_the_tensions_on_the_page_are_those_of_the_files(name, place):
    told = re.findall(r"(\d+) \+-\s(\d+) lbf", PAGE_OF_DEPLOYED)[place]
    state = deployed_line(DOCS / "assemblies" / f"{name}.toml").deployed.working[0]
    assert float(state.point.mean_tension) / LBF == pytest.approx(float(told[0]), abs=0.6)
    assert 1.96 * state.standard_uncertainty / LBF == pytest.approx(float(told[1]), abs=0.6)


# the worked example of docs/experiments.md: what it shows is what the commands say

PAGE_OF_EXPERIMENTS = (Path(__file__).parents[2] / "docs" / "experiments.md").read_text(
    encoding="utf-8"
)
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"^`([\w.]+)`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def run(line, folder):
    """What a line of the page prints, without the blanks at the ends of its lines."""
    program, *arguments = shlex.split(line)
    assert program == "reduction"
    with contextlib.chdir(folder):
        done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output
    return "\n".join(text.rstrip() for text in done.stdout.splitlines())


@pytest.fixture
def folder(tmp_path):
    for name, body in NAMED.findall(PAGE_OF_EXPERIMENTS):
        (tmp_path / name).write_text(body, encoding="utf-8")
    return tmp_path


def test_every_line_prints_what_stands_below_it(folder):
    printed, shown = "", 0
    for language, body in FENCE.findall(PAGE_OF_EXPERIMENTS):
        if language == "sh":
            printed = run(body, folder)
        elif language == "text":
            assert body.rstrip("\n") in printed, body
            shown += 1
    assert shown == 4


def test_the_form_has_the_columns_that_a_surface_reads(folder):
    run("reduction experiment box-behnken SPEC.toml --out sheet.csv", folder)
    header, *rows = (folder / "sheet.csv").read_text().splitlines()
    filled = [f"{row}{5e4 + 100 * place**2}" for place, row in enumerate(rows)]
    (folder / "sheet.csv").write_text("\n".join([header, *filled]))
    answer = json.loads(run("reduction surface sheet.csv SPEC.toml --json", folder))
    assert answer["n_runs"] == 15 and [one["unit"] for one in answer["factors"]] == ["Hz", "N", "N"]


def test_the_screening_plans_twelve_runs_with_six_dummies(folder):
    (screening,) = [
        body for _, body in FENCE.findall(PAGE_OF_EXPERIMENTS) if "plackett-burman" in body
    ]
    (folder / "SPEC.toml").write_text(screening)
    answer = json.loads(run("reduction experiment plackett-burman SPEC.toml --json", folder))
    assert len(answer["runs"]) == 12 and len(answer["runs"][0]["dummy"]) == 6


def test_every_key_is_explained_in_experiments():
    known = {*_ExperimentKeys.model_fields, *_ResponseKeys.model_fields}
    assert not {key for key in known if f"| `{key}` |" not in PAGE_OF_EXPERIMENTS}
    assert not {key for key in _SpecFile.model_fields if f"[{key}]" not in PAGE_OF_EXPERIMENTS}


# what docs/lookup.md shows works, and the numbers in its sentences are those of the command

TEXT = (Path(__file__).parents[2] / "docs" / "lookup.md").read_text(encoding="utf-8")


def blocks(kind):
    return re.findall(rf"^```{kind}\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)


def commands():
    (body,) = blocks("bash")
    lines = body.replace("\\\n", " ").strip().split("\n")
    # a processed campaign has to be made first
    return [shlex.split(line)[1:] for line in lines if "processed/" not in line]


@pytest.mark.parametrize("arguments", commands(), ids=lambda parts: " ".join(parts[1:4]))
def test_commands_end_well(arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0, done.output


def test_the_python_works():
    (body,) = blocks("python")
    found = {}
    exec(body, found)  # noqa: S102 - the page is ours
    assert found["values"].value.shape == (2,)
    assert found["old"].name == "nylon-8-strand-plaited-0.5in-5-years"


def test_the_share_in_the_text_is_that_of_the_look_up():
    found = []
    for age in ("new", "4-years"):
        line = published_sources()[f"polyester-8-strand-plaited-0.5in-{age}"]
        strength = line.rated_break_strength
        at = {"mean_tension": 0.21 * strength, "tension_amplitude": 0.085 * strength}
        found.append(look_up(line, "apparent_spring_constant", frequency=0.3, **at).value)
    stiffer = f"{100 * float(found[1] / found[0]) - 100:.1f} % stiffer"
    assert stiffer in " ".join(TEXT.split())


# docs/remote.md names the commands that have the option, the packages, and messages that there
# are

ROOT = Path(__file__).parents[2]
PAGE_OF_REMOTE = (ROOT / "docs" / "remote.md").read_text(encoding="utf-8")


def test_the_commands_with_the_option_are_named_and_so_are_those_without():
    commands = typer.main.get_command(app).commands
    having = {
        name
        for name, command in commands.items()
        if any("--allow-remote" in one.opts for one in command.params)
    }
    part = PAGE_OF_REMOTE.partition("## Where URLs are accepted")[2].partition("\n## ")[0]
    table, _, below = part.partition("\ncampaign.toml, ")
    assert {name for name in commands if f"`{name}`" in table} == having
    without = {name for name in commands if f"`{name}`" in below}
    # these take no file, or none that is a product or a log
    assert without | having | {"demo", "reproduce", "schema"} == set(commands)
    assert not without & having


def test_the_packages_are_those_that_messages_name():
    told = {}
    for names, package in re.findall(r"^\| (`.*://`) \| (\w+)", PAGE_OF_REMOTE, re.M):
        told |= dict.fromkeys(re.findall(r"`(\w+)://`", names), package)
    assert told == PACKAGES


def test_the_messages_are_those_of_the_program():
    source = (ROOT / "reduction" / "readers" / "remote_files.py").read_text(encoding="utf-8")
    part = PAGE_OF_REMOTE.partition("## When it fails")[2]
    messages = re.findall(r"^\| `(?:\.\. )?(.*?)` \|", part, re.M)
    assert len(messages) == 8
    for message in messages:
        assert message.replace("gs://", "{protocol}://") in source, message


# what docs/uncertainty.md says of 137 psi follows from the page, and its budget is the command's

PAGE_OF_UNCERTAINTY = (ROOT / "docs" / "uncertainty.md").read_text(encoding="utf-8")
ROW = "T-1 rubber tether new, raw data, ascending, segment 1"


def rows(head):
    """Cells of the table under a heading row."""
    part = PAGE_OF_UNCERTAINTY[PAGE_OF_UNCERTAINTY.index(head) :].partition("\n\n")[0]
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
    assert f"{1.96 * relative[-1] * modulus:.1f} psi (k = 1.96)" in PAGE_OF_UNCERTAINTY


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
    (told,) = re.findall(r"(\d\.\d\d) psi of standard uncertainty", PAGE_OF_UNCERTAINTY)
    assert float(told) == pytest.approx(answer["standard_uncertainty"] / psi, abs=0.0051)


# what docs/predictions.md shows can be read, and no key is left out

PAGE_OF_PREDICTIONS = (Path(__file__).parents[2] / "docs" / "predictions.md").read_text(
    encoding="utf-8"
)
BLOCKS = [
    body for _, body in re.findall(r"^```(toml)\n(.*?)^```$", PAGE_OF_PREDICTIONS, re.M | re.S)
]


def test_the_hose_that_is_shown_can_be_predicted(tmp_path):
    path = tmp_path / "hose.toml"
    path.write_text(next(body for body in BLOCKS if "[cord]" in body), encoding="utf-8")
    plan, file = load_hose(path)
    assert plan.design.dead_length_share == pytest.approx(4 / 96)
    assert plan.standard_uncertainty["rubber_modulus"] == pytest.approx(10 * 6894.757, rel=1e-6)
    assert [layer.name for layer in plan.layers] == ["Kevlar"]
    assert file.comparison.calibrate == ("wrap_angle", "rubber_modulus")


def written(tmp_path, table):
    path = tmp_path / "spec.toml"
    path.write_text(next(body for body in BLOCKS if f"[{table}]" in body), encoding="utf-8")
    return path


def test_the_wave_load_that_is_shown_can_be_predicted(tmp_path):
    case = load_wave_case(written(tmp_path, "wave_load"))
    assert (case["outer_diameter"], case["content_density"]) == pytest.approx((0.114, 830))
    assert case["wave_length"] is None and case["wave_theory"] == "auto"


def test_the_armour_that_is_shown_can_be_predicted(tmp_path):
    case = load_armour_case(written(tmp_path, "armour"))
    assert case.layer_names == ("inner", "outer")
    assert case.layers.design.core_radius == pytest.approx([0.025, 0.030])
    assert case.tolerance == pytest.approx(0.01)


@pytest.mark.parametrize("section", ["wave_load", "armour"])
def test_defaults_are_told_where_they_are_explained(section):
    """Each value that stands for a missing one is on the page; 0 and none are told in words."""
    models = {"wave_load": (_WaveLoadKeys,), "armour": (_ArmourKeys, _ArmourLayerKeys)}[section]
    rows = [line for line in PAGE_OF_PREDICTIONS.splitlines() if line.startswith("| `")]
    for one in models:
        for name, field in one.model_fields.items():
            if field.default in (None, "") or field.is_required():
                continue
            (row,) = [line for line in rows if f"`{name}`" in line.split("|")[1]][-1:]
            assert str(field.default).split(" ")[0] in row, name


def test_the_comparison_that_is_shown_is_valid():
    (table,) = (tomllib.loads(body) for body in BLOCKS if "[comparisons." in body)
    for section in table["comparisons"].values():
        hosemodel.ComparisonSection.model_validate(section)


def test_every_key_is_explained_in_predictions():
    models = (
        hosemodel.HoseSection, hosemodel.LayerSection, hosemodel.CordSection,
        hosemodel.ComparisonSection, hosemodel._TargetSection, _WaveLoadKeys, _ArmourKeys,
        _ArmourLayerKeys,
    )  # fmt: skip
    named = {name for one in models for name in one.model_fields} - {"cord"}
    assert not {name for name in named if f"`{name}`" not in PAGE_OF_PREDICTIONS}

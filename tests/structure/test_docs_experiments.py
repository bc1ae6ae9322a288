"""The worked example of docs/experiments.md: what it shows is what the commands say."""

import contextlib
import json
import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reduction.campaign.experiment_plans import _ExperimentKeys, _ResponseKeys, _SpecFile
from reduction.cli.main import app

PAGE = (Path(__file__).parents[2] / "docs" / "experiments.md").read_text(encoding="utf-8")
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
    for name, body in NAMED.findall(PAGE):
        (tmp_path / name).write_text(body, encoding="utf-8")
    return tmp_path


def test_every_line_prints_what_stands_below_it(folder):
    printed, shown = "", 0
    for language, body in FENCE.findall(PAGE):
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
    (screening,) = [body for _, body in FENCE.findall(PAGE) if "plackett-burman" in body]
    (folder / "SPEC.toml").write_text(screening)
    answer = json.loads(run("reduction experiment plackett-burman SPEC.toml --json", folder))
    assert len(answer["runs"]) == 12 and len(answer["runs"][0]["dummy"]) == 6


def test_every_key_is_explained():
    known = {*_ExperimentKeys.model_fields, *_ResponseKeys.model_fields}
    assert not {key for key in known if f"| `{key}` |" not in PAGE}
    assert not {key for key in _SpecFile.model_fields if f"[{key}]" not in PAGE}

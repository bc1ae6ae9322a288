"""What docs/lookup.md shows works, and the numbers in its sentences are those of the command."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from reduction.cli.main import app
from reduction.lines.line_lookup import look_up
from reduction.lines.published_source import published_sources

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

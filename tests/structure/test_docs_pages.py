"""No page is left out of the documentation, and pages that a script writes are what it writes."""

import ast
import re
import runpy
from pathlib import Path

import pytest
from typer.testing import CliRunner

import reduction
from reduction.campaign.model import CampaignFile
from reduction.cli.main import app

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOKS = ("01_tether_test", "02_rope_design_values", "03_hose_against_its_test")


def test_every_page_stands_in_the_index():
    lists = re.findall(
        r"^```\{toctree\}\n(.*?)^```$", (DOCS / "index.md").read_text(encoding="utf-8"), re.M | re.S
    )
    listed = {
        line for one in lists for line in one.splitlines() if line and not line.startswith(":")
    }
    pages = {path.stem for path in DOCS.glob("*.md")} - {"index"}
    assert not pages - listed, "put them into a toctree of docs/index.md"


def test_the_errata_are_what_their_script_writes():
    errata = runpy.run_path(str(DOCS / "make_errata.py"))["errata"]
    written = (DOCS / "errata.md").read_text(encoding="utf-8")
    assert written == errata(), "run: python docs/make_errata.py"


def test_every_key_of_the_schema_is_on_its_page(monkeypatch):
    schema = CampaignFile.model_json_schema()
    monkeypatch.syspath_prepend(DOCS / "_ext")
    page = runpy.run_path(str(DOCS / "_ext" / "campaignkeys.py"))["pages"]()["campaign-keys.md"]
    for one in (schema, *schema["$defs"].values()):
        for key in one.get("properties", {}):
            assert f"| `{key}` |" in page, key
    assert page.count("(key-") == len(
        [one for one in schema["$defs"].values() if "properties" in one]
    )


def test_every_command_and_option_is_on_its_page(monkeypatch):
    monkeypatch.syspath_prepend(DOCS / "_ext")
    page = runpy.run_path(str(DOCS / "_ext" / "commandpages.py"))["pages"]()["commands.md"]
    help_ = CliRunner().invoke(app, ["--help"], env={"COLUMNS": "200"}).stdout
    names = {one.name or one.callback.__name__.replace("_", "-") for one in app.registered_commands}
    assert all(name in help_ for name in names)
    for name in names:
        part = page.partition(f"## reduction {name}\n")[2].partition("\n## ")[0]
        text = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "200"}).stdout
        options = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", text)) - {"--help"}
        assert not {one for one in options if f"`{one}`" not in part}, name


def test_the_page_of_the_interface_lists_the_public_names_and_few_others(monkeypatch):
    monkeypatch.syspath_prepend(DOCS / "_ext")
    page = runpy.run_path(str(DOCS / "_ext" / "apipages.py"))["pages"]()["api/index.rst"]
    listed = set(re.findall(r"^\.\. auto\w+:: reduction\.(.+)$", page, re.M))
    assert {name for name in reduction.__all__ if not name.startswith("_")} <= listed
    assert len(listed) <= 30


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_uses_the_public_names_alone(name):
    tree = ast.parse((DOCS / "examples" / f"plot_{name}.py").read_text(encoding="utf-8"))
    imported, used = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imported |= {one.name for one in node.names}
        elif isinstance(node, ast.ImportFrom):
            imported.add(node.module)
        elif isinstance(node, ast.Attribute) and getattr(node.value, "id", "") == "reduction":
            used.add(node.attr)
    assert {one for one in imported if one.startswith("reduction")} == {"reduction"}
    assert used and used <= set(reduction.__all__)

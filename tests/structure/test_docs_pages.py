"""No page is left out of the documentation, and pages that a script writes are what it writes."""

import re
import runpy
from pathlib import Path

from typer.testing import CliRunner

from reduction.campaign.model import CampaignFile
from reduction.cli.main import app

DOCS = Path(__file__).parents[2] / "docs"


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

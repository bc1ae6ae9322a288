"""No page is left out of the documentation, and pages that a script writes are what it writes."""

import re
import runpy
from pathlib import Path

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

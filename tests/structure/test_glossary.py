"""docs/glossary.md says what the vocabulary says."""

import runpy
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"


def test_the_glossary_is_what_its_script_writes():
    glossary = runpy.run_path(str(DOCS / "make_glossary.py"))["glossary"]
    written = (DOCS / "glossary.md").read_text(encoding="utf-8")
    assert written == glossary(), "run: python docs/make_glossary.py"

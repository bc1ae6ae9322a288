"""Pages made from the package itself when the documentation is built, in ``reference/``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import apipages
import campaignkeys
import commandpages
import quantitypages
import variablepages
from sphinx.application import Sphinx

__all__ = ["setup"]


def _write(app: Sphinx) -> None:
    folder = Path(app.srcdir) / "reference"
    pages = {
        **apipages.pages(), **commandpages.pages(), **campaignkeys.pages(), **variablepages.pages(),
        **quantitypages.pages(),
    }  # fmt: skip
    for name, text in pages.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8", newline="\n")
    for path in folder.rglob("*.*"):
        if str(path.relative_to(folder).as_posix()) not in pages:
            path.unlink()


def setup(app: Sphinx) -> dict[str, Any]:
    """Write them before anything is read."""
    app.connect("builder-inited", _write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""What a page lacks for people who do not see it: the level of the headings above the lists."""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

__all__ = ["setup"]

_LAST = 900
_HEADING = 'role="heading"'


def _with_levels(
    app: Sphinx, pagename: str, templatename: str, context: dict[str, Any], doctree: object
) -> None:
    for name in ("body", "furo_navigation_tree"):
        if isinstance(context.get(name), str):
            context[name] = context[name].replace(_HEADING, f'{_HEADING} aria-level="2"')


def setup(app: Sphinx) -> dict[str, Any]:
    """After the theme has made its lists."""
    app.connect("html-page-context", _with_levels, priority=_LAST)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

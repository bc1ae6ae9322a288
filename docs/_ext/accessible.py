"""What pages lack for people who do not see them, or use no mouse.

The headings above the lists get their level, and what is scrolled sideways can be reached by key.
"""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

__all__ = ["setup"]

_LAST = 900
_INSTEAD = {
    'role="heading"': 'role="heading" aria-level="2"',
    '<div class="highlight"><pre>': '<div class="highlight"><pre tabindex="0">',
}


def _improve(
    app: Sphinx, pagename: str, templatename: str, context: dict[str, Any], doctree: object
) -> None:
    for name in ("body", "furo_navigation_tree"):
        if isinstance(context.get(name), str):
            for text, better in _INSTEAD.items():
                context[name] = context[name].replace(text, better)


def setup(app: Sphinx) -> dict[str, Any]:
    """After the theme has made its lists."""
    app.connect("html-page-context", _improve, priority=_LAST)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

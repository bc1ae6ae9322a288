"""References that a module lists once and its functions cite: ``[1]_`` leads there from each.

numpydoc knows only the references of one docstring. Here those of a module become targets of their
own; a docstring with references of its own is left to numpydoc.
"""

from __future__ import annotations

import re
from importlib import import_module
from types import GenericAlias
from typing import Any

from sphinx.application import Sphinx

__all__ = ["setup"]

_CITED = re.compile(r"\[(\d+)\]_")
_LISTED = re.compile(r"^(\s*)\.\. \[(\d+)\] ", re.MULTILINE)


def _label(module: str, number: str) -> str:
    return f"{module}-source-{number}"


def _linked(module: str, text: str) -> str:
    listed = {number for _, number in _LISTED.findall(import_module(module).__doc__ or "")}

    def link(found: re.Match[str]) -> str:
        number = found[1]
        return f":ref:`[{number}] <{_label(module, number)}>`" if number in listed else found[0]

    return _CITED.sub(link, text)


def _module_of(name: str) -> str:
    """The longest beginning of a name that is a module."""
    while name:
        try:
            return import_module(name).__name__
        except ImportError:
            name = name.rpartition(".")[0]
    return name


def _rewrite(_: Sphinx, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    text = "\n".join(lines)
    if what != "module" and _LISTED.search(text):
        return
    module = name if what == "module" else _module_of(name)
    if what == "module":
        text = _LISTED.sub(
            lambda found: f"\n{found[1]}.. _{_label(module, found[2])}:\n\n{found[1]}[{found[2]}] ",
            text,
        )
        # what follows the first line of a reference is indented below it
        text = re.sub(
            r"(?m)^(\[\d+\] .*(?:\n[ ]+\S.*)*)", lambda one: re.sub(r"\n[ ]+", " ", one[0]), text
        )
    lines[:] = _linked(module, text).split("\n")


def _no_signature(_: Sphinx, what: str, name: str, obj: Any, *__: Any) -> tuple[None, str] | None:
    """An alias as ``dict[str, int]`` has none; numpydoc would read the text of dict."""
    return (None, "") if isinstance(obj, GenericAlias) else None


def setup(app: Sphinx) -> dict[str, Any]:
    """Run before numpydoc does."""
    app.connect("autodoc-process-docstring", _rewrite, priority=400)
    app.connect("autodoc-process-signature", _no_signature, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

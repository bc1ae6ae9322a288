"""Links that work on the page of a repository and here.

In Markdown ``[words](../reduction/stages/cycles/cycle_search.py)`` leads to the file where the
repository is read,
and here to the page of the module; words that are the name of something in that module lead to it.
In a docstring a name alone is found wherever it is the only one of its name.
"""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms.post_transforms import SphinxPostTransform

__all__ = ["setup"]


class ModuleLinks(SphinxPostTransform):
    """Downloads of modules of the package, made links to their documentation."""

    default_priority = 5

    def run(self, **_: Any) -> None:
        """Replace each in the document at hand."""
        for node in list(self.document.findall(addnodes.download_reference)):
            target = PurePosixPath(node.get("reftarget", ""))
            parts = target.parts
            if target.suffix != ".py" or "reduction" not in parts:
                continue
            module = ".".join(target.with_suffix("").parts[parts.index("reduction") :])
            domain = self.env.domains.python_domain
            name = f"{module}.{node.astext()}"
            name = name if name in domain.objects else module
            found = domain.resolve_xref(
                self.env, self.env.docname, self.app.builder, "obj", name,
                addnodes.pending_xref(refspecific=False), nodes.literal(text=node.astext()),
            )  # fmt: skip
            if found is not None:
                node.replace_self(found)


class BareNames:
    """Links of names without their module, where only one thing is called so."""

    def __init__(self) -> None:
        self._full: dict[str, list[str]] = {}

    def collect(self, _: Sphinx, env: BuildEnvironment) -> None:
        """Sort the full names of all objects by their last part, when everything has been read."""
        self._full = {}
        for full in env.domains.python_domain.objects:
            self._full.setdefault(full.rpartition(".")[2], []).append(full)

    def resolve(
        self,
        app: Sphinx,
        env: BuildEnvironment,
        node: addnodes.pending_xref,
        words: nodes.TextElement,
    ) -> nodes.reference | None:
        """Link of one name; None where there are none or several."""
        found = self._full.get(node.get("reftarget", ""), [])
        if node.get("reftype") != "obj" or len(found) != 1:
            return None
        link = env.domains.python_domain.resolve_xref(
            env, node["refdoc"], app.builder, "obj", found[0], addnodes.pending_xref(), words
        )
        return link if isinstance(link, nodes.reference) else None


def setup(app: Sphinx) -> dict[str, Any]:
    """Register both kinds."""
    app.add_post_transform(ModuleLinks)
    names = BareNames()
    app.connect("env-check-consistency", names.collect)
    app.connect("missing-reference", names.resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

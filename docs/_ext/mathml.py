"""Formulas as MathML, by the converter of docutils: no script, no font, nothing from the network.

A formula that the converter cannot read is a warning, and so an error of the build.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging

__all__ = ["setup"]

# words of TeX for the size of a sign alone, which the converter lacks
_SIZES = re.compile(r"\\(?:textstyle|displaystyle|[Bb]igg?[lr]?)(?![A-Za-z]) ?")
_LOG = logging.getLogger(__name__)


def _mathml(node: Any, *, as_block: bool) -> str:
    formula = _SIZES.sub("", node.astext()).replace(r"\tfrac12", r"\frac{1}{2}")
    if as_block and (r"\\" in formula or "&" in formula) and r"\begin" not in formula:
        formula = rf"\begin{{aligned}}{formula}\end{{aligned}}"
    try:
        return str(tex2mathml(formula, as_block=as_block))
    except MathError as error:
        _LOG.warning("formula cannot be set: %s: %s", error, formula, location=node)
        return f"<code>{formula}</code>"


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(_mathml(node, as_block=False))
    raise nodes.SkipNode


def _block(writer: Any, node: nodes.math_block) -> None:
    # one that is wider than the page is scrolled, by the keyboard too
    writer.body.append(writer.starttag(node, "div", CLASS="math", TABINDEX="0"))
    writer.body.append(_mathml(node, as_block=True))
    writer.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer."""
    app.add_html_math_renderer(
        "mathml", inline_renderers=(_inline, None), block_renderers=(_block, None)
    )
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""Settings of Sphinx: ``python -m sphinx -W -n -b html docs OUT``.

Nothing of the pages comes from the network.
"""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "_ext"))

from campaigns import GALLERIES, work_folder
from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

import reduction

project = "mooring-reduction"
author = "The mooring-reduction developers"
copyright = author
version = release = reduction.__version__

extensions = [
    "campaigns",
    "sphinx_gallery.gen_gallery",
    "myst_parser",
    "sphinx.ext.autodoc",
    "numpydoc",
    "sharedreferences",
    "mathml",
    "sourcelinks",
    "accessible",
    "madepages",
]
exclude_patterns = ["_build", "_ext", "examples", "tutorials"]
nitpicky = True

# Markdown as GitHub reads it: the same anchors, and formulas between dollars
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
math_number_all = False
html_math_renderer = "mathml"

# docstrings are numpydoc; types and shapes stand in their text
autodoc_typehints = "none"
add_module_names = False
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
autodoc_default_options = {"no-value": True}
toc_object_entries = False
numpydoc_show_class_members = False
numpydoc_xref_param_type = False
# what stands in single backquotes is a name: a link where it is one of this package, else plain
default_role = "py:obj"
nitpick_ignore_regex = [
    # parameters and fields
    (r"py:obj", r".*"),
    # other packages, whose pages are on the network
    (r"py:class", r"(collections|contextlib|enum|numpy|pandas|pathlib|pydantic|xarray)\..*"),
]

# scripts are run where the products of the campaigns are
_WORK = work_folder(HERE)
sphinx_gallery_conf = {
    "examples_dirs": [str(_WORK / name) for name in GALLERIES],
    "gallery_dirs": list(GALLERIES.values()),
    "filename_pattern": r"plot_",
    "within_subsection_order": "FileNameSortKey",
    "reset_modules": ("matplotlib", "gallerystyle.set_style"),
    "capture_repr": (),
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,
    "min_reported_time": 1e6,
    "matplotlib_animations": False,
    "backreferences_dir": None,
}

html_theme = "furo"
html_title = f"mooring-reduction {release}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_sphinx = False


def setup(app: Sphinx) -> None:
    """Give Pygments a name that it lacks."""
    app.add_lexer("csv", TextLexer)

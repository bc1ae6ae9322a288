"""One style for every figure of the gallery."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
from cycler import cycler

__all__ = ["set_style"]

# Okabe and Ito, Color Universal Design: told apart by people who do not see all colours
_COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]


def set_style(gallery: dict[str, Any], script: str) -> None:
    """Set it before a script; figures keep nothing of the script before."""
    mpl.rcdefaults()
    mpl.use("agg")
    mpl.rcParams.update(
        {
            "axes.prop_cycle": cycler(color=_COLOURS),
            "axes.grid": True,
            "axes.spines.right": False,
            "axes.spines.top": False,
            "axes.titlesize": "medium",
            "figure.constrained_layout.use": True,
            "figure.figsize": (7.0, 4.2),
            "grid.color": "#dddddd",
            "savefig.dpi": 110,
        }
    )
    # what an earlier build wrote there is not read
    for path in Path(script).parent.glob("*.dat"):
        path.unlink()

"""Reduction of cyclic tension tests on compliant mooring elements."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from reduction.archive.campaign_tree import open_campaign
    from reduction.archive.open import open_archive
    from reduction.python_interface import export, fit_surface, look_up, predict_hose, run
else:
    _PLACES = {
        "export": "python_interface",
        "fit_surface": "python_interface",
        "look_up": "python_interface",
        "open_archive": "archive.open",
        "open_campaign": "archive.campaign_tree",
        "predict_hose": "python_interface",
        "run": "python_interface",
    }

    def __getattr__(name: str) -> Any:
        """Load what needs xarray at its first use: the package itself imports in milliseconds."""
        if name in _PLACES:
            return getattr(import_module(f"reduction.{_PLACES[name]}"), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "__version__",
    "export",
    "fit_surface",
    "look_up",
    "open_archive",
    "open_campaign",
    "predict_hose",
    "run",
]

__version__ = "1.0.0"


def __dir__() -> list[str]:
    """Public names, and what every module has."""
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})

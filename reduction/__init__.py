"""Reduction of cyclic tension tests on compliant mooring elements."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from reduction.archive.campaign_tree import open_campaign
    from reduction.archive.open import open_archive
else:
    _ROOMS = {"open_campaign": "campaign_tree", "open_archive": "open"}

    def __getattr__(name: str) -> Any:
        """Load what needs xarray at its first use: the package itself imports in milliseconds."""
        if name in _ROOMS:
            return getattr(import_module(f"reduction.archive.{_ROOMS[name]}"), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = ["__version__", "open_archive", "open_campaign"]

__version__ = "0.1.0"

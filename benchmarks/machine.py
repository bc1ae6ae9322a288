"""The machine on which benchmarks run, in words."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

__all__ = ["described", "load", "processors"]

PACKAGES = ("numpy", "scipy", "pandas", "pyarrow", "xarray")


def processors() -> int:
    """How many may be used."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def load() -> str:
    """Mean number of programs that ran or waited in the last minute."""
    return f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"


def _model() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text(encoding="utf-8").splitlines() if info.exists() else []
    named = {
        key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)
    }
    if "model name" not in named:
        return platform.processor() or platform.machine()
    family = f" (family {named['cpu family']})" if "cpu family" in named else ""
    return f"{named['model name']}{family}"


def _memory() -> str:
    if not hasattr(os, "sysconf"):
        return "memory unknown"
    return f"{os.sysconf('SC_PHYS_PAGES') * os.sysconf('SC_PAGE_SIZE') / 2**30:.0f} GiB"


def _package() -> str:
    """Version of this package, and the commit where it is a checkout."""
    found = f"reduction {version('mooring-reduction')}"
    if not (Path(__file__).parents[1] / ".git").exists():
        return found
    done = subprocess.run(
        ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    return f"{found} ({done.stdout.strip()})" if done.returncode == 0 else found


def described() -> str:
    """Processor, memory, system and versions."""
    packages = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    return (
        f"{_model()}, {processors()} of {os.cpu_count()} processors usable, {_memory()}, "
        f"{platform.system()} {platform.release()}; Python {platform.python_version()}, "
        f"{packages}; {_package()}"
    )

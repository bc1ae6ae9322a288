"""Products of the synthetic campaigns, beside which the scripts of the gallery run.

They are made by ``reduction run``, as a reader makes them, in the folder that the environment
variable REDUCTION_DOCS_WORK names, or in ``_build/work``; what is there already stays.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

__all__ = ["GALLERIES", "setup", "work_folder"]

GALLERIES = {"tutorials": "tutorial", "examples": "gallery"}
"""Folder of the scripts: folder of their pages."""

_CAMPAIGNS = {"tmt-synthetic": ("T-1", "T-2", "T-4-extended"), "hose-synthetic": ("L-64",)}
"""With the tests that the scripts read: the others are made by the same rules."""

_BEFORE_THE_GALLERY = 100


def work_folder(docs: Path) -> Path:
    """Where the scripts run."""
    return Path(os.environ.get("REDUCTION_DOCS_WORK", docs / "_build" / "work"))


def _prepare(app: Sphinx) -> None:
    docs = Path(app.srcdir)
    work = work_folder(docs)
    work.mkdir(parents=True, exist_ok=True)
    for name, tests in _CAMPAIGNS.items():
        if not (work / "processed" / name / "status.csv").exists():
            campaign = docs.parent / "raw" / name / "campaign.toml"
            command = [sys.executable, "-m", "reduction", "run", str(campaign), "--quiet"]
            command += [word for test in tests for word in ("--test", test)]
            subprocess.run(command, cwd=work, check=True)  # noqa: S603 - our own command
    for name in GALLERIES:
        shutil.copytree(docs / name, work / name, dirs_exist_ok=True)
        for path in (work / name).glob("plot_*.py"):
            if not (docs / name / path.name).exists():
                path.unlink()
        # a script is run where it stands; a folder of it with a README would be taken for a gallery
        (work / name / "raw").mkdir(exist_ok=True)
        places = {one: work / one for one in ("processed", "reports")}
        places |= {f"raw/{one}": docs.parent / "raw" / one for one in _CAMPAIGNS}
        for place, there in places.items():
            if not (work / name / place).exists():
                (work / name / place).symlink_to(there.resolve(), target_is_directory=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Make them before the gallery runs its scripts."""
    app.connect("builder-inited", _prepare, priority=_BEFORE_THE_GALLERY)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
